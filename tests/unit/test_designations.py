"""Bearings by designation: sizes of the ISO plans, ratings from the elements that fit, the keys."""

from __future__ import annotations

import math

import pytest

import epicyclic as ep
from epicyclic.build.elements import catalogue_bearing
from epicyclic.case.tables.elements import ShaftBearingTable
from epicyclic.losses.designations import (
    RATING_BAND,
    ball_factor,
    designated,
    roller_factor,
    static_ball_factor,
)
from problems import only, problems_of

# As catalogues print them: d, D, B in mm, C and C0 in kN. Ratings of URB (2017) and, where that
# catalogue has none, of SKF: second hand or, the last five, Rolling bearings (2017).
PRINTED = {
    "6208": (40, 80, 18, 32.6, 20.0),
    "6308": (40, 90, 23, 41.0, 24.0),
    "NU 2210 E": (50, 90, 23, 78.0, 88.0),
    "32006 X": (30, 55, 17, 34.0, 45.5),
    "33010": (50, 80, 24, 75.0, 113.0),
    "30208": (40, 80, 18, 61.6, 68.0),
    "NKI 40/30": (40, 55, 30, 40.2, 93.0),
    "NA 4908": (40, 62, 22, 42.9, 71.0),
    "22220": (100, 180, 46, 425.0, 490.0),
    "24130 CC/W33": (150, 250, 100, 1020.0, 1530.0),
    "NCF 3010 CV": (50, 80, 23, 76.5, 98.0),
    "NKI 95/26": (95, 125, 26, 78.1, 166.0),
    "62/28": (28, 58, 16, 16.8, 9.5),
    "6202-2RS1": (15, 35, 11, 8.06, 3.75),
}


@pytest.mark.parametrize("name", PRINTED)
def test_sizes_and_ratings_of_catalogues(name):
    bore, outside, width, dynamic, static = PRINTED[name]
    found = designated(name)
    sizes = (found.bore, found.outside_diameter, found.width)
    assert [1e3 * size for size in sizes] == pytest.approx([bore, outside, width])
    assert found.dynamic_load_rating == pytest.approx(1e3 * dynamic, rel=RATING_BAND)
    assert found.static_load_rating == pytest.approx(1e3 * static, rel=RATING_BAND)


def test_factors_of_iso_281_and_76():
    # f_c of the tables of ISO 281, of which the closed forms are the origin, and f_0 of ISO 76
    balls = {0.05: 46.7, 0.1: 55.5, 0.2: 59.9, 0.3: 56.0, 0.4: 48.4}
    rollers = {0.02: 60.8, 0.1: 84.2, 0.2: 88.7, 0.3: 83.8}
    static = {0.0: 14.7, 0.06: 15.9, 0.15: 15.2, 0.25: 12.8, 0.35: 10.5}
    for gamma, factor in balls.items():
        assert ball_factor(gamma) == pytest.approx(factor, rel=0.015)
    for gamma, factor in rollers.items():
        assert roller_factor(gamma) == pytest.approx(factor, rel=0.005)
    for gamma, factor in static.items():
        assert static_ball_factor(gamma) == pytest.approx(factor, rel=0.01)


def test_contact_angles_of_iso_355_and_of_letters():
    # Y = 0.4 cot(alpha): 1.4 of 32006 X and 1.6 of 30208, as catalogues print
    assert 0.4 / math.tan(designated("32006").contact_angle) == pytest.approx(1.4, abs=0.05)
    assert 0.4 / math.tan(designated("30208").contact_angle) == pytest.approx(1.6, abs=0.05)
    degrees = [
        math.degrees(designated(name).contact_angle) for name in ("7208 BEP", "7209 AC", "7010C")
    ]
    assert degrees == pytest.approx([40.0, 25.0, 15.0])


def test_cages_thrust_bearings_and_full_complements():
    cage = designated("K 40x48x20")
    assert (cage.element_diameter, cage.pitch_diameter) == pytest.approx((4e-3, 44e-3))
    assert designated("K 8x11x10").bore == pytest.approx(8e-3)  # no suffix is cut off
    assert designated("6208-2RS1").bore == designated("6208 2Z").bore == pytest.approx(40e-3)
    assert designated("51108").width == pytest.approx(13e-3)
    assert (designated("51108").type, designated("81207").type) == ("thrust-ball", "thrust-roller")
    assert math.isnan(designated("51108").static_load_rating)
    full, caged = designated("SL18 5010"), designated("NU 2010")
    assert full.cage == "full-complement"
    assert full.rows == 2
    assert full.elements > caged.elements


@pytest.mark.parametrize(
    ("name", "near"), [("NU 2299", "NU 2209"), ("6298", "6"), ("62081", "62"), ("51199", "511")]
)
def test_unknown_designations_name_near_ones(name, near):
    with pytest.raises(KeyError) as error:
        designated(name)
    assert f"Did you mean '{near}" in error.value.args[0]


def _table(**keys):
    return ShaftBearingTable.model_validate({"shaft": "motor", **keys})


def test_values_of_the_user_go_before_those_of_the_designation():
    own = catalogue_bearing(_table(designation="6208", width="19 mm", static_load_rating="19 kN"))
    assert (own.type, own.bore, own.width) == ("deep-groove", 40e-3, 19e-3)
    assert own.static_load_rating == 19e3
    assert own.dynamic_load_rating == designated("6208").dynamic_load_rating
    assert own.estimated == "6208"
    both = _table(designation="6208", static_load_rating="19 kN", dynamic_load_rating="31 kN")
    assert not catalogue_bearing(both).estimated


def test_a_designation_of_digits_alone_needs_no_quotes():
    assert _table(designation=6210) == _table(designation="6210")
    assert _table(designation=6210).bore == 50e-3


def test_case_with_designations_states_the_estimate():
    keys = {
        "bearings.motor_front": {
            "shaft": "motor", "position": "0 mm", "designation": "6207", "locating": True,
            "model": "skf-2018"},
        "bearings.motor_rear": {"shaft": "motor", "position": "80 mm", "designation": "NU 207"},
    }  # fmt: skip
    case = ep.load_case("train-eaxle")
    result = ep.solve(case.updated(keys))
    estimated = [note for note in result.warnings if "are estimates after ISO 281" in note]
    assert len(estimated) == 2
    # the friction of balls takes C0, which is 15.3 kN in the case: its estimate is within the band
    change = (
        result.losses["motor_front.mechanical"] / ep.solve(case).losses["motor_front.mechanical"]
    )
    assert change == pytest.approx(1.0, abs=0.1)
    assert change != 1.0


@pytest.mark.parametrize(
    ("keys", "part"),
    [
        ({"designation": "6298"}, "designation"),
        ({"designation": "6208", "type": "tapered"}, "designation"),
        ({"designation": "22220", "type": "cylindrical"}, "designation"),
    ],
)
def test_wrong_designations_are_one_problem(keys, part):
    table = {"shaft": "motor", "position": "80 mm", **keys}
    case = ep.load_case("train-eaxle")
    problem = only(problems_of(case.updated, {"bearings.motor_rear": table}))
    assert problem.key == f"bearings.motor_rear.{part}"


def test_a_size_that_is_not_that_of_the_designation_is_named():
    case = ep.load_case("train-eaxle")
    front = "bearings.motor_front"
    assert case.updated({f"{front}.designation": "6207"}).bearings["motor_front"].bore == 35e-3
    found = problems_of(case.updated, {f"{front}.designation": "6208"})
    assert [(it.key, it.value) for it in found] == [
        (f"{front}.bore", "35 mm"), (f"{front}.outside_diameter", "72 mm")]  # fmt: skip
    assert [it.allowed for it in found] == ["is 40 mm for 6208.", "is 80 mm for 6208."]


@pytest.mark.parametrize(
    ("changes", "key", "allowed"),
    [
        ({"planet_bearing.designation": "22220"}, "planet_bearing.pin_diameter", "about 119"),
        ({"planet_bearing.designation": "NU 2205"}, "planet_bearing.roller_diameter", "about 7.4"),
        (
            {"thrust_bearing": {"designation": "51112", "mean_diameter": "300 mm"}},
            "thrust_bearing.mean_diameter",
            "is 72.5 mm for",
        ),
        (
            {"planet_bearing.designation": "NKI 17/16", "planet_bearing.type": "spherical"},
            "planet_bearing.designation",
            "is that of a needle bearing, and type is spherical.",
        ),
    ],
)
def test_so_is_one_of_a_planet_or_thrust_bearing(changes, key, allowed):
    problem = problems_of(ep.load_case("talbot-2012").updated, changes)[0]
    assert problem.key == key
    assert allowed in problem.allowed


def test_a_width_may_be_that_of_one_ring():
    front = "bearings.motor_front"
    case = ep.load_case("train-eaxle").updated({f"{front}.designation": "6207"})
    assert case.updated({f"{front}.width": "16 mm"}).bearings["motor_front"].width == 16e-3
    problem = only(problems_of(case.updated, {f"{front}.width": "61 mm"}))
    assert (problem.key, problem.allowed) == (f"{front}.width", "is about 17 mm for 6207.")


# --- planets --------------------------------------------------------------------------------------

TALBOT = "talbot-2012"


def _planets(**keys):
    case = ep.load_case(TALBOT).updated({"planet_bearing": None})
    return case.updated({"planet_bearing": keys})


def test_designation_of_digits_alone_needs_no_quotes():
    case = ep.load_case("train-eaxle", {"bearings.motor_front.designation": 6207})
    assert case.bearings["motor_front"].designation == "6207"


def test_planet_bearing_by_designation():
    case = _planets(designation="K 26x34x20", diametral_clearance="9 um")
    own = case.planet_bearing
    assert (own.type, own.roller_diameter, own.diametral_clearance) == ("needle", 4e-3, 9e-6)
    assert own.pin_diameter == pytest.approx(26e-3, abs=0.03e-3)
    assert ep.solve(case).losses["planet_bearing_mechanical"] > 0


def test_spherical_planet_bearing_aligns_itself():
    keys = _planets(designation="NU 1005").inputs()["planet_bearing"]
    keys |= {"designation": None, "rollers_per_row": 11, "rows": 2}
    cylindrical, spherical = (
        ep.solve(_planets(**keys | {"type": kind, "palmgren_coefficient": 0.0004})
                 .updated({
                     "models.bearing": "palmgren", "gears.helix_angle": "11 deg",
                     "planet.mass": "0 kg",  # unloaded rollers, which are others, lose nothing
                 }))
        for kind in ("cylindrical", "spherical")
    )  # fmt: skip
    # the couple of helical meshes loads other rollers, and Palmgren's loss is that of the force
    assert spherical.bearing.roller_load_max < cylindrical.bearing.roller_load_max
    assert spherical.losses["planet_bearing_mechanical"] == pytest.approx(
        cylindrical.losses["planet_bearing_mechanical"], rel=1e-9
    )


@pytest.mark.parametrize(
    ("keys", "changes", "key"),
    [
        ({"designation": "6205"}, {}, "planet_bearing.designation"),
        ({"designation": "NU 1099"}, {}, "planet_bearing.designation"),
        ({"designation": "22205", "pin_diameter": "27 mm"}, {"models.bearing": "mixed-ehl"},
         "models.bearing"),
    ],
)  # fmt: skip
def test_planet_bearings_of_wrong_types(keys, changes, key):
    case = ep.load_case(TALBOT).updated({"planet_bearing": None})
    problem = only(problems_of(case.updated, {"planet_bearing": keys, **changes}))
    assert problem.key == key
    if keys["designation"] == "6205":
        assert "needle, cylindrical or spherical" in problem.allowed


def test_centrifugal_force_on_a_roller():
    """A needle of 4 mm x 9.5 mm at 92 mm and 4000 rpm presses with 15.2 N (printed)."""
    force = 7850 * math.pi / 4 * 4e-3**2 * 9.5e-3 * 92e-3 * (4000 * math.pi / 30) ** 2
    assert force == pytest.approx(15.2, rel=0.01)
    fast = ep.load_case(TALBOT).updated(
        {"operation.speed": "60000 rpm", "operation.torque": "9 N*m", "planet.mass": "0.03 kg"}
    )
    notes = [note for note in ep.solve(fast).warnings if "presses each roller outward" in note]
    (note,) = notes
    # the carrier turns at 60,000 rpm over the ratio of the set
    own, gearbox = fast.planet_bearing, ep.solve(fast)
    speed = gearbox.flow.members["carrier"].speed
    radius = fast.gearings[""].pins["planet"].radius
    mass = own.material.density * math.pi / 4 * own.roller_diameter**2 * own.roller_length
    assert f"{mass * radius * speed**2:.3g} N" in note


def test_thrust_bearing_by_designation():
    case = ep.load_case(TALBOT).updated({"thrust_bearing": {"designation": "51108"}})
    assert case.thrust_bearing.mean_diameter == pytest.approx(50e-3)
    assert case.thrust_bearing.viscous_factor == 1.5
    rollers = case.updated({"thrust_bearing": {"designation": 81207}}).thrust_bearing
    assert (rollers.mean_diameter, rollers.viscous_factor) == (pytest.approx(48.5e-3), 3.5)
    for name in ("6208", "51199"):
        wrong = {"thrust_bearing": {"designation": name}}
        problem = only(problems_of(ep.load_case(TALBOT).updated, wrong))
        assert problem.key == "thrust_bearing.designation"


def test_a_needle_bearing_of_another_bore_is_answered_with_the_bores():
    with pytest.raises(KeyError, match="NKI has the bores 15, 17, 20,"):
        designated("NKI 12/16")
