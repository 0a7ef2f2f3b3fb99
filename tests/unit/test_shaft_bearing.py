"""Shaft bearings: Palmgren and Harris, loads, speeds, the element, and its table of keys."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import epicyclic as ep
from epicyclic import library
from epicyclic.build.elements import build_element, catalogue_bearing
from epicyclic.case.tables.elements import ShaftBearingTable
from epicyclic.gears.gear import HOUSING
from epicyclic.losses.drag import bearing_viscous_loss
from epicyclic.losses.loss_table import LossTable
from epicyclic.losses.shaft_bearing import (
    AxialSpring,
    BearingLoad,
    CatalogueBearing,
    PalmgrenModel,
    TableModel,
    friction_load,
    harris_coefficient,
    limiting_speed,
    load_moment,
    minimum_load,
    preload_of,
    static_load,
    thermal_speed_rating,
)
from epicyclic.losses.skf_2018 import SkfModel, seal_moment, skf_constants, skf_moments, skf_supply
from epicyclic.losses.zhou_hoeprich import RIB_ROUGHNESS, TaperedModel
from epicyclic.machine.element import LOAD_DEPENDENT, LOAD_INDEPENDENT, State, figures, fluids_at
from epicyclic.machine.shaft_parts import ShaftBearing
from epicyclic.oil.oil import Oil
from problems import only, problems_of
from shaft_bearings import BALL, NEEDLE, PRINTED, ROLLER, RPM, TAPER, skf

SPHERICAL = CatalogueBearing("spherical", 50e-3, 90e-3, 23e-3, static_load_rating=108e3)
THRUST = CatalogueBearing("thrust-ball", 35e-3, 52e-3, static_load_rating=51e3)


@pytest.fixture(scope="module")
def oil():
    return Oil.model_validate(library.oil_table("iso-vg-100-mineral"))


@pytest.fixture(scope="module")
def state(oil):
    fluids = fluids_at(oil, 333.15, oil_air_ratio=0.05, pressure=101325.0)

    def make(rpm, force=None, outer=0.0):
        forces = {} if force is None else {"input.front": force}
        return State({"input": rpm * RPM, "outer": outer * RPM, HOUSING: 0.0}, {}, forces, fluids)

    return make


# --- Palmgren and Harris --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bearing", "radial", "axial", "friction", "static"),
    [
        (BALL, 1000, 0, 1000, 1000),
        (BALL, 1000, 300, 1000, 1000),
        (BALL, 1000, 2000, 5900, 1600),
        (ROLLER, 1000, 400, 1000, 1000),
        (TAPER, 1000, 100, 1000, 1000),
        (TAPER, 1000, 1000, 3200, 1380),
        (NEEDLE, 1000, 0, 1000, 1000),
        (SPHERICAL, 1000, 100, 1000, 1000 + 44 / math.tan(math.radians(10))),
        (SPHERICAL, 1000, 500, 400 / math.tan(math.pi / 18), 1000 + 220 / math.tan(math.pi / 18)),
        (THRUST, 0, 7000, 7000, 7000),
    ],
)
def test_equivalent_loads(bearing, radial, axial, friction, static):
    load = BearingLoad(radial, axial)
    assert friction_load(bearing, load) == pytest.approx(friction, rel=1e-12)  # rounding
    assert static_load(bearing, load) == pytest.approx(static, rel=1e-12)


def test_coefficient_of_harris():
    load = BearingLoad(1900.0, 0.0)  # a tenth of the static rating
    assert harris_coefficient(BALL, load) == pytest.approx(2.5365446e-4, rel=PRINTED)
    thrust = harris_coefficient(THRUST, BearingLoad(0.0, 7000.0))
    assert thrust == pytest.approx(0.0008 * (7 / 51) ** 0.33, rel=1e-12)  # rounding
    assert harris_coefficient(SPHERICAL, load) == 0.00025
    full = replace(ROLLER, cage="full-complement")
    # the published ratio of full complement to caged rollers, 0.00055/0.0003
    ratio = harris_coefficient(full, load) / harris_coefficient(ROLLER, load)
    assert ratio == pytest.approx(1.8333, rel=1e-4)  # printed to five digits
    with pytest.raises(ValueError, match="needle"):
        harris_coefficient(NEEDLE, load)


def test_moment_of_palmgren_with_flange_friction():
    # f1 P1 d_m + f_f F_a d_m = (0.0003 5000 + 0.002 1000) 0.06; balls have no flange
    load = BearingLoad(5000.0, 1000.0)
    assert load_moment(ROLLER, load, 0.0003, 0.002) == pytest.approx(0.21, rel=1e-12)  # rounding
    assert load_moment(BALL, load, 0.0003, 0.002) == pytest.approx(0.09, rel=1e-12)


def test_palmgren_adds_the_viscous_loss(state):
    oil = state(0).fluids.oil
    model = PalmgrenModel(2.0, 0.0003)
    parts = {p.key: p for p in model.parts(BALL, BearingLoad(1000.0, 0.0), 3000 * RPM, oil)}
    assert parts["mechanical"].watts == pytest.approx(0.018 * 3000 * RPM, rel=1e-12)  # rounding
    viscous = bearing_viscous_loss(2.0, oil.kinematic_viscosity, 3000 * RPM, 60e-3)
    assert parts["viscous"].watts == viscous > 0
    assert parts["mechanical"].by_load
    assert not parts["viscous"].by_load


# --- minimum load ---------------------------------------------------------------------------------


def test_minimum_loads():
    # k_r (nu n/1000)^(2/3) (d_m/100)^2 and k_r (6 + 4 n/n_r) (d_m/100)^2 kN; 0.02 C
    ball = minimum_load(BALL, 3000 * RPM, 20e-6)
    assert ball == pytest.approx(137.93570, rel=PRINTED)
    roller = minimum_load(ROLLER, 3000 * RPM, 20e-6, reference_speed=9000 * RPM)
    assert roller == pytest.approx(396.0, rel=PRINTED)
    assert minimum_load(ROLLER, 3000 * RPM, 20e-6, 0.3) == pytest.approx(648.0, rel=PRINTED)
    assert minimum_load(NEEDLE, 3000 * RPM, 20e-6) == pytest.approx(600.0, rel=PRINTED)
    assert minimum_load(SPHERICAL, 3000 * RPM, 20e-6) == pytest.approx(1080.0, rel=PRINTED)
    assert math.isnan(minimum_load(TAPER, 3000 * RPM, 20e-6))
    assert math.isnan(minimum_load(THRUST, 3000 * RPM, 20e-6))


# --- the element ----------------------------------------------------------------------------------


MODELS = {
    "palmgren": PalmgrenModel(2.0, 0.0003),
    "harris": PalmgrenModel(2.0, None),
    "skf-2018": skf(BALL, oil_level=20e-3, seal_moment=seal_moment(45e-3, 0.028, 2.0, 2e-3)),
    "table": TableModel(
        LossTable("torque", {"speed": np.array([0.0, 1000.0])}, np.array([0.1, 0.3]))
    ),
}


@pytest.mark.parametrize("name", MODELS)
def test_a_bearing_loses_power_in_both_senses_and_none_at_rest(state, name):
    bearing = ShaftBearing("input.front", ("input", HOUSING), BALL, MODELS[name])
    force = BearingLoad(2000.0, 300.0)
    forward, backward, rest = (bearing.evaluate(state(n, force)) for n in (3000, -3000, 0))
    for key, loss in forward.losses.items():
        assert loss.watts > 0
        assert backward.losses[key].watts == loss.watts
        assert rest.losses[key].watts == 0
        assert loss.brakes == (("input", HOUSING, 1.0),)
        assert loss.method
        assert loss.source
    assert rest.flags == ()
    assert math.isnan(rest.figures["bearing"].friction_torque)
    total = sum(loss.watts for loss in forward.losses.values())
    torque = forward.figures["bearing"].friction_torque
    assert torque * 3000 * RPM == pytest.approx(total, rel=1e-12)  # rounding


@pytest.mark.parametrize("name", MODELS)
def test_losses_vanish_with_the_speed(state, name):
    bearing = ShaftBearing("input.front", ("input", HOUSING), BALL, MODELS[name])
    slow = bearing.evaluate(state(1e-9, BearingLoad(2000.0, 300.0)))
    # moments of some N m at most, at 1e-10 rad/s
    assert sum(loss.watts for loss in slow.losses.values()) < 1e-8


def test_the_rings_may_both_turn(state):
    bearing = ShaftBearing("input.front", ("input", "outer"), BALL, MODELS["skf-2018"])
    force = BearingLoad(2000.0, 0.0)
    together = bearing.evaluate(state(3000, force, outer=3000))
    apart = bearing.evaluate(state(2000, force, outer=-1000))
    alone = bearing.evaluate(state(3000, force))
    assert all(loss.watts == 0 for loss in together.losses.values())
    found = [sum(loss.watts for loss in result.losses.values()) for result in (apart, alone)]
    assert found[0] == pytest.approx(found[1], rel=1e-12)  # rounding of the speed difference


def test_groups_and_keys(state):
    found = {}
    for name, model in MODELS.items():
        bearing = ShaftBearing("input.front", ("input", HOUSING), BALL, model)
        losses = bearing.evaluate(state(3000, BearingLoad(2000.0, 0.0))).losses
        found[name] = {key: loss.group for key, loss in losses.items()}
    both = {"mechanical": LOAD_DEPENDENT, "viscous": LOAD_INDEPENDENT}
    assert found["palmgren"] == found["harris"] == both
    assert found["skf-2018"] == {"mechanical": LOAD_DEPENDENT, "drag": LOAD_INDEPENDENT}
    assert found["table"] == {"friction": LOAD_INDEPENDENT}


def test_the_force_comes_from_the_state_unless_it_is_given(state):
    bearing = ShaftBearing("input.front", ("input", HOUSING), BALL, MODELS["palmgren"])
    now = state(3000, BearingLoad(2000.0, 300.0))
    assert bearing.loads(now) == {"radial": 2000.0, "axial": 300.0}
    fixed = replace(bearing, force=BearingLoad(500.0, 0.0))
    assert fixed.loads(now) == {}
    assert fixed.evaluate(now).figures["bearing"].radial_force == 500.0
    assert bearing.evaluate(now).figures["bearing"].radial_force == 2000.0
    assert replace(bearing, model=MODELS["table"]).loads(now) == {}


def test_the_heat_arises_in_the_bearing(state):
    bearing = ShaftBearing("input.front", ("input", HOUSING), BALL, MODELS["palmgren"])
    now = state(3000, BearingLoad(2000.0, 0.0))
    heats = {loss.heat for loss in bearing.evaluate(now).losses.values()}
    assert heats == {(("input.front", 1.0),)}


def test_load_below_the_minimum_is_named(state):
    bearing = ShaftBearing("input.front", ("input", HOUSING), BALL, MODELS["palmgren"])
    low = bearing.evaluate(state(3000, BearingLoad(20.0, 0.0)))
    (note,) = low.notes
    least = low.figures["bearing"].minimum_load
    assert "20 N" in note
    assert f"{least:.3g} N" in note
    assert bearing.evaluate(state(3000, BearingLoad(2 * least, 0.0))).notes == ()
    # balls are held to their races by an axial force too, cylindrical rollers are not
    assert bearing.evaluate(state(3000, BearingLoad(0.0, 2 * least))).notes == ()
    rollers = replace(bearing, bearing=ROLLER)
    assert "0 N is below" in only(rollers.evaluate(state(3000, BearingLoad(0.0, 1e4))).notes)
    assert bearing.evaluate(state(0, BearingLoad(0.0, 0.0))).notes == ()


def test_speed_beyond_the_thermal_rating_is_named(state):
    """(J35) by hand for 6208: seat 6,786 mm2 takes 108.6 W; N mm, mm2/s, 1/min."""
    own = replace(BALL, bore=0.04, outside_diameter=0.08, width=0.018, static_load_rating=19e3)
    rating = thermal_speed_rating(own) / RPM
    moment = 2 * 1e-7 * (12 * rating) ** (2 / 3) * 60**3 + 0.0002 * 950 * 60
    assert 1e-3 * moment * rating * RPM == pytest.approx(0.016 * math.pi * 120 * 18, rel=1e-6)
    rollers = replace(own, type="spherical")
    rating_rollers = thermal_speed_rating(rollers) / RPM
    moment = 4 * 1e-7 * (12 * rating_rollers) ** (2 / 3) * 60**3 + 0.0002 * 950 * 60
    assert 1e-3 * moment * rating_rollers * RPM == pytest.approx(108.6, rel=1e-3)
    large = replace(own, bore=0.4, outside_diameter=0.6, width=0.09, static_load_rating=9e5)
    rating_large = thermal_speed_rating(large) / RPM
    moment = 2 * 1e-7 * (12 * rating_large) ** (2 / 3) * 500**3 + 0.0002 * 45000 * 500
    seat = math.pi * 1000 * 90
    heat = 0.016 * (seat / 5e4) ** -0.34 * seat
    assert 1e-3 * moment * rating_large * RPM == pytest.approx(heat, rel=1e-6)
    bearing = ShaftBearing("input.front", ("input", HOUSING), own, MODELS["palmgren"])
    load = BearingLoad(2000.0, 0.0)
    (note,) = bearing.evaluate(state(1.01 * rating, load)).notes
    assert "an estimate after ISO 15312" in note
    assert bearing.evaluate(state(0.99 * rating, load)).notes == ()
    stated = replace(bearing, reference_speed=1.5 * rating * RPM, limiting_speed=1e5)
    assert stated.evaluate(state(1.4 * rating, load)).notes == ()
    (note,) = stated.evaluate(state(1.6 * rating, load)).notes
    assert "estimate" not in note
    assert math.isnan(thermal_speed_rating(replace(own, width=math.nan)))
    tiny = replace(own, bore=1e-4, outside_diameter=2e-4, width=0.01, static_load_rating=1.0)
    assert thermal_speed_rating(tiny) > 1e5


def test_speed_beyond_the_limit_of_the_cage_is_named(state):
    """SKF's 32006 X, 30204, NU 205, K 40x45x17, NKI 40/30, NCF 3010, 22310 within 8 %."""
    for kind, bore, outside, printed in [
        ("tapered", 30, 55, 12000), ("tapered", 20, 47, 15000), ("cylindrical", 25, 52, 16000),
        ("needle", 40, 45, 12000), ("needle", 40, 55, 10000), ("full", 50, 80, 5000),
        ("spherical", 50, 110, 6300),
    ]:  # fmt: skip
        own = replace(BALL, type=kind, bore=1e-3 * bore, outside_diameter=1e-3 * outside)
        if kind == "full":
            own = replace(own, type="cylindrical", cage="full-complement")
        assert limiting_speed(own) / RPM == pytest.approx(printed, rel=0.08)
    bearing = ShaftBearing("input.front", ("input", HOUSING), BALL, MODELS["palmgren"])
    limit, load = 660e3 / (1e3 * BALL.pitch_diameter), BearingLoad(2000.0, 0.0)
    stated = replace(bearing, limiting_speed=0.7 * limit * RPM)
    for own, speed, said in (
        (bearing, 1.01, "SKF's tables). No"), (bearing, 0.99, None), (stated, 0.8, "rpm. No"),
        (stated, 0.6, None),
    ):  # fmt: skip
        notes = own.evaluate(state(speed * limit, load)).notes
        assert [said in note for note in notes if "limiting speed of" in note] == [True] * bool(
            said
        )
    angular = replace(BALL, type="angular-contact")
    assert limiting_speed(angular) / RPM == pytest.approx(610e3 / 60, rel=1e-12)
    assert math.isinf(limiting_speed(replace(BALL, type="thrust-ball")))


def test_estimated_drag_is_named(state):
    load = BearingLoad(2000.0, 0.0)
    bearing = ShaftBearing("input.front", ("input", HOUSING), BALL, MODELS["skf-2018"])
    assert "estimate" in only(bearing.evaluate(state(3000, load)).notes)
    known = replace(bearing, model=skf(BALL, oil_level=20e-3, drag_variable=4e-4))
    assert known.evaluate(state(3000, load)).notes == ()


def test_flags(state):
    def quantities(bearing, model, rpm, force):
        element = ShaftBearing("input.front", ("input", HOUSING), bearing, model)
        return [flag.quantity for flag in element.evaluate(state(rpm, force)).flags]

    assert quantities(BALL, MODELS["palmgren"], 3000, BearingLoad(2000.0, 0.0)) == []
    fast = quantities(BALL, MODELS["skf-2018"], 20_000, BearingLoad(2000.0, 0.0))
    assert fast == ["speed times pitch diameter, rpm mm"]
    heavy = quantities(BALL, MODELS["harris"], 3000, BearingLoad(20_000.0, 0.0))
    assert heavy == ["equivalent static load over static load rating"]
    for model in (MODELS["palmgren"], skf(ROLLER)):
        pushed = quantities(ROLLER, model, 3000, BearingLoad(1000.0, 600.0))
        assert pushed == ["axial over radial force of a cylindrical roller bearing"]
    assert quantities(ROLLER, skf(ROLLER), 3000, BearingLoad(0.0, 600.0)) != []
    assert quantities(BALL, MODELS["table"], 20_000, BearingLoad(0.0, 0.0)) == ["speed difference"]


def test_figures_are_labelled(state):
    bearing = ShaftBearing("input.front", ("input", HOUSING), BALL, MODELS["harris"])
    result = bearing.evaluate(state(3000, BearingLoad(1900.0, 0.0)))
    shown = {figure.key: figure for figure in figures(result.figures["bearing"])}
    assert shown["speed"].value == pytest.approx(3000)
    assert shown["speed"].unit == "rpm"
    assert shown["coefficient"].value == pytest.approx(2.5365446e-4, rel=PRINTED)


TAPER_MODEL = TaperedModel(
    18, 10.4e-3, 12.6e-3, 1.2e-3, RIB_ROUGHNESS, SkfModel(skf_supply("tapered"), 0.002)
)


def test_all_moments_become_losses(state):
    oil, load, speed = state(0).fluids.oil, BearingLoad(2000.0, 300.0), 3000 * RPM
    model = MODELS["skf-2018"]
    moments = skf_moments(model, BALL, load, speed, oil.kinematic_viscosity)
    assert min(moments.rolling, moments.sliding, moments.seal, moments.drag) > 0
    watts = {part.key: part.watts for part in model.parts(BALL, load, speed, oil)}
    by_load, others = moments.rolling + moments.sliding, moments.seal + moments.drag
    assert watts == pytest.approx({"mechanical": by_load * speed, "drag": others * speed})


def test_what_no_measured_tapered_bearing_had_is_flagged(state):
    bearing = ShaftBearing("input.front", ("input", HOUSING), TAPER, TAPER_MODEL)
    force = BearingLoad(2000.0, 1000.0)
    assert bearing.evaluate(state(3000, force)).flags == ()
    (flag,) = bearing.evaluate(state(9000, force)).flags
    assert flag.use.model == "zhou-hoeprich"
    other = replace(bearing, model=PalmgrenModel(6.0, 0.0004))
    result = other.evaluate(state(3000, force))
    watts = sum(loss.watts for loss in result.losses.values())
    assert f"{watts:.3g} W after palmgren" in only(result.notes)


# --- table of keys --------------------------------------------------------------------------------


KEYS = {
    "shaft": "input",
    "type": "deep-groove",
    "bore": "40 mm",
    "outside_diameter": "80 mm",
    "static_load_rating": "19000 N",
}


def bearing_table(**changes):
    given = {key: value for key, value in (KEYS | changes).items() if value is not None}
    return ShaftBearingTable.model_validate(given)


SHAFTS = {"input": "input", "output": "output"}


def build(table, oil, tmp_path, shafts=SHAFTS):
    assert list(table.problems()) == []
    return build_element("bearings", "input.front", table, shafts=shafts, oil=oil, folder=tmp_path)


def test_defaults_of_the_keys(oil, tmp_path):
    bearing = build(bearing_table(model="palmgren"), oil, tmp_path)
    assert bearing.key == "input.front"
    assert bearing.between == ("input", HOUSING)
    assert bearing.model == PalmgrenModel(2.0, 0.0003, 0.002)
    assert bearing.force is None
    for kind, axial, viscous, coefficient in (
        ("spherical", None, 4.0, 0.00025), ("thrust-ball", "2 kN", 1.5, 0.0004),
        ("thrust-roller", "2 kN", 3.5, 0.0015),
    ):  # fmt: skip
        table = bearing_table(type=kind, axial_force=axial, model="palmgren")
        found = build(table, oil, tmp_path).model
        assert (found.viscous_factor, found.constant) == (viscous, coefficient)


def test_keys_reach_the_element(oil, tmp_path):
    table = bearing_table(
        type="tapered",
        model="skf-2018",
        series="322",
        contact_angle="14 deg",
        width="23 mm",
        radial_force="3000 N",
        oil_level="5 mm",
        lubrication="oil-air",
        drag_variable=0.0003,
        sliding_friction=0.003,
        against="output",
        minimum_load_factor=0.2,
        reference_speed="9000 rpm",
        dynamic_load_rating="80000 N",
        seal={"counterface_diameter": "45 mm", "factor": 0.03, "exponent": 2.1},
    )
    bearing = build(table, oil, tmp_path)
    assert bearing.between == ("input", "output")
    assert bearing.force == BearingLoad(3000.0, 0.0)
    assert bearing.bearing == CatalogueBearing(
        "tapered", 0.04, 0.08, 0.023, "caged", 80e3, 19e3, 0.4 / math.tan(math.radians(14))
    )
    assert bearing.model == SkfModel(
        skf_constants("tapered", "322"),
        0.003,
        6e-8,
        0.005,
        0.0003,
        seal_moment(0.045, 0.03, 2.1, 0.0),
    )
    assert bearing.minimum_load_factor == 0.2
    assert bearing.reference_speed == pytest.approx(9000 * RPM)


def test_coefficients_of_the_user(oil, tmp_path):
    table = bearing_table(
        type="cylindrical",
        palmgren_coefficient=0.0002,
        viscous_factor=0.0,
        flange_coefficient=0.006,
        radial_force="10 N",
        axial_force="3 N",
    )
    bearing = build(table, oil, tmp_path)
    assert bearing.model == PalmgrenModel(0.0, 0.0002, 0.006)
    assert bearing.force == BearingLoad(10.0, 3.0)
    full = bearing_table(type="cylindrical", cage="full-complement", model="harris")
    assert build(full, oil, tmp_path).model == PalmgrenModel(7.5, None, 0.003)


def test_oil_sets_the_full_film_friction(oil, tmp_path):
    table = bearing_table(model="skf-2018", series="62")
    assert build(table, oil, tmp_path).model.full_film_friction == 0.05
    atf = Oil.model_validate(library.oil_table("atf-dexron-vi"))
    assert build(table, atf, tmp_path).model.full_film_friction == 0.10


def test_table_over_the_load(oil, tmp_path, state):
    given = {
        "radial_force": ["0 N", "1000 N"],
        "speed": ["0 rpm", "3000 rpm"],
        "torque": [["0.1 N*m", "0.3 N*m"], ["0.2 N*m", "0.5 N*m"]],
    }
    given["torque"] = [list(row) for row in zip(*given["torque"], strict=True)]  # rows: speeds
    bearing = build(bearing_table(model="table", table=given), oil, tmp_path)
    result = bearing.evaluate(state(3000, BearingLoad(500.0, 0.0)))
    # at the last speed, half way between 0.3 and 0.5 N m; rounding
    assert result.losses["friction"].watts == pytest.approx(0.4 * 3000 * RPM, rel=1e-12)
    assert result.losses["friction"].group == LOAD_DEPENDENT
    assert bearing.loads(state(3000, BearingLoad(500.0, 0.0))) != {}


PUSHED = {"radial_force": "3 N", "axial_force": "2 N"}


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"bore": "80 mm"}, "bore"),
        ({"cage": "full-complement"}, "cage"),
        ({"type": "needle", "model": "skf-2018", "series": "62"}, "model"),
        ({"type": "needle", "model": "harris"}, "model"),
        ({"type": "needle", "locating": True}, "locating"),
        ({"type": "cylindrical", "designation": "NU 208", "locating": True}, "locating"),
        ({"type": "cylindrical", "designation": "NU 208", **PUSHED}, "axial_force"),
        ({"type": "needle", "radial_force": "1 N", "axial_force": "1 N"}, "axial_force"),
        ({"model": "skf-2018"}, "series"),
        ({"model": "skf-2018", "series": "302"}, "series"),
        ({"model": "skf-2018", "series": "62", "static_load_rating": None}, "static_load_rating"),
        ({"model": "harris", "static_load_rating": None}, "static_load_rating"),
        ({"type": "cylindrical", "model": "skf-2018", "series": "2", "oil_level": "3 mm"}, "width"),
        ({"type": "cylindrical", "roller_length": "9 mm", "oil_level": "3 mm"}, "width"),
        ({"type": "cylindrical", "model": "zhou-hoeprich"}, "width"),
        ({"type": "cylindrical", "rib_height": "1 mm"}, "rib_height"),
        ({"type": "cylindrical", "roller_diameter": "20 mm"}, "roller_diameter"),
        ({"type": "cylindrical", "roller_diameter": "0.9 mm"}, "roller_diameter"),
        ({"type": "cylindrical", "roller_diameter": "7 mm", "rollers": 27}, "rollers"),
        ({"rollers": 83}, "rollers"),
        ({"type": "cylindrical", "width": "18 mm", "roller_length": "19 mm"}, "roller_length"),
        (
            {
                "type": "tapered",
                "axial_factor": 1.6,
                "radial_force": "1 kN",
                "axial_force": "0 N",
                "preload": "2 kN",
            },
            "preload",
        ),
        (
            {
                "type": "cylindrical",
                "model": "zhou-hoeprich",
                "width": "18 mm",
                "cage": "full-complement",
            },
            "cage",
        ),
        ({"type": "tapered"}, "axial_factor"),
        ({"type": "tapered", "axial_factor": 1.6, "contact_angle": "14 deg"}, "axial_factor"),
        ({"axial_factor": 1.6}, "axial_factor"),
        ({"axial_force": "100 N"}, "radial_force"),
        ({"against": "input"}, "against"),
        ({"type": "thrust-ball"}, "axial_force"),
        ({"type": "thrust-roller", "axial_force": "2 kN", "radial_force": "1 N"}, "radial_force"),
        ({"type": "thrust-roller", "axial_force": "2 kN", "locating": True}, "locating"),
        ({"type": "thrust-roller", "axial_force": "2 kN", "model": "skf-2018"}, "model"),
        ({"type": "spherical", "contact_angle": "9 deg"}, "contact_angle"),
        ({"model": "table"}, "model"),
        ({"table": {"file": "torque.csv"}}, "table"),
        ({"model": "table", "table": {"torque": ["1 N*m"]}}, "table.torque"),
    ],
)
def test_contradictions_are_found(changes, key):
    problem = only(tuple(bearing_table(**changes).problems()))
    assert problem.key == key
    assert problem.allowed.endswith(".")
    assert problem.remedy


def test_full_complement_rollers_need_no_series():
    table = bearing_table(type="cylindrical", cage="full-complement", model="skf-2018")
    assert list(table.problems()) == []


def test_a_thrust_bearing_carries_its_axial_force(oil, tmp_path, state):
    table = bearing_table(
        type="thrust-roller", bore="35 mm", outside_diameter="52 mm", axial_force="7 kN",
        model="palmgren",
    )  # fmt: skip
    bearing = build(table, oil, tmp_path)
    found = bearing.evaluate(state(600)).losses
    assert found["mechanical"].watts == pytest.approx(0.0015 * 7e3 * 43.5e-3 * 600 * RPM, rel=1e-12)
    assert found["viscous"].watts > 0


def test_unknown_shafts_are_found(oil, tmp_path):
    table = bearing_table(shaft="inptu", against="somewhere else")

    def action():
        build_element("bearings", "b", table, shafts=SHAFTS, oil=oil, folder=tmp_path)

    first, second = problems_of(action)
    assert first.key == "shaft"
    assert "'input'" in first.remedy
    assert second.key == "against"


def test_auto_takes_palmgren_for_what_rollers_are_not_known(oil, tmp_path):
    def model(**changes):
        table = bearing_table(type="cylindrical", **changes)
        element = build_element("bearings", "b", table, shafts=SHAFTS, oil=oil, folder=tmp_path)
        return element.model.name

    assert model(width="18 mm") == "zhou-hoeprich"
    assert model(roller_length="11 mm") == "zhou-hoeprich"
    assert model() == model(width="18 mm", cage="full-complement") == "palmgren"
    assert model(width="18 mm", palmgren_coefficient=0.0004) == "palmgren"


# --- angular contact bearings and pairs -----------------------------------------------------------


def test_loads_of_angular_contact_balls():
    # at 40 degrees 0.9 cot(alpha) = 1.073, Y0 = 0.26 and e = 1.14 of ISO 281 and 76
    bearing = CatalogueBearing(
        "angular-contact", 40e-3, 80e-3, axial_factor=0.4 / math.tan(math.radians(40)),
        static_load_rating=23e3,
    )  # fmt: skip
    load = BearingLoad(1000.0, 2500.0)
    assert friction_load(bearing, load) == pytest.approx(1.07257 * 2500 - 100, rel=1e-5)
    assert static_load(bearing, load) == pytest.approx(500 + 0.26 * 2500, rel=1e-9)
    assert bearing.thrust_ratio == pytest.approx(1.14)
    assert harris_coefficient(bearing, load) == pytest.approx(0.001 * 0.05**0.33, rel=1e-9)
    # a = B/2 + (d + D)/4 tan(alpha), as catalogues print: 34 mm for a 7208 B
    assert 9e-3 + bearing.centre_offset == pytest.approx(34e-3, abs=0.5e-3)


def test_pressure_centre_of_a_tapered_bearing():
    # 30208: a = 16 mm from the back face of T = 19.75 mm, e = 1.5 tan(alpha) = 0.37 (catalogue)
    taper = replace(TAPER, axial_factor=1.6)
    assert 19.75e-3 / 2 + taper.centre_offset == pytest.approx(17e-3, abs=1.1e-3)
    assert taper.thrust_ratio == pytest.approx(1 / 3.2)


def test_preload_by_displacement():
    springs = AxialSpring(15, 10.4e-3, 12.6e-3, 0.245), AxialSpring(17, 11e-3, 0.0, 0.7)
    force = preload_of(25e-6, springs)
    assert sum(spring.approach(force) for spring in springs) == pytest.approx(25e-6, rel=1e-9)
    # rollers nearly linear, balls with the power 2/3 (Palmgren)
    assert springs[0].approach(2 * force) == pytest.approx(2**0.9 * springs[0].approach(force))
    assert springs[1].approach(8 * force) == pytest.approx(4 * springs[1].approach(force))


TAPERED_PAIR = {
    "bearings.middle_front": {
        "shaft": "middle", "position": "-4 mm", "designation": "32009", "model": "palmgren"},
    "bearings.middle_rear": {
        "shaft": "middle", "position": "74 mm", "designation": "32008", "model": "palmgren"},
}  # fmt: skip


@pytest.fixture(scope="module")
def pair_case():
    none = dict.fromkeys(TAPERED_PAIR)
    return ep.load_case("train-eaxle").updated(none).updated(TAPERED_PAIR)


def _axial(case):
    figures = ep.solve(case).parts
    return {
        name: figures[f"{name}.bearing"].axial_force for name in ("middle_front", "middle_rear")
    }


def test_pair_in_a_case_induces_thrust_and_states_its_arrangement(pair_case):
    result = ep.solve(pair_case)
    assert sum("X is assumed" in note for note in result.warnings) == 2
    for name in ("middle_front", "middle_rear"):
        own = result.parts[f"{name}.bearing"]
        ratio = catalogue_bearing(pair_case.bearings[name]).thrust_ratio
        assert own.axial_force >= ratio * own.radial_force * (1 - 1e-9)
    named = pair_case.updated({"bearings.middle_front.arrangement": "X"})
    same = ep.solve(named)
    assert same.total == result.total
    assert not any("X is assumed" in note for note in same.warnings)
    other = ep.solve(pair_case.updated({"bearings.middle_rear.arrangement": "O"}))
    assert other.total != result.total


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("middle_rear.oil_level", "3 mm", "the model palmgren does not use oil_level."),
        ("middle_rear.palmgren_coefficient", 0.0007, ""),
        ("middle_front.viscous_factor", 2.3, "the model skf-2018 does not use viscous_factor."),
        ("middle_front.oil_level", "3 mm", ""),
        ("middle_front.drag_variable", 0.0007, "the model skf-2018 does not use drag_variable."),
        (
            "output_front.flange_coefficient",
            0.0031,
            "the model houpert does not use flange_coefficient.",
        ),
    ],
)
def test_keys_that_the_model_of_a_bearing_does_not_use_are_told(key, value, told):
    result = ep.solve(ep.load_case("train-eaxle").updated({f"bearings.{key}": value}))
    found = [note for note in result.warnings if "does not use" in note]
    assert found == [f"{key.partition('.')[0]}: {told}"] * bool(told)


def test_the_force_of_a_bearing_between_two_shafts_is_not_carried_on_and_told():
    case = ep.load_case("train-eaxle").updated(
        {
            "bearings.middle_rear.against": "differential",
            "bearings.output_front": {
                "shaft": "differential", "position": "3 mm", "designation": "6012"},
            "bearings.output_rear.radial_force": "410 N",
        }
    )  # fmt: skip
    assert "output_front: the force of middle_rear on differential is not included. " in (
        "".join(ep.solve(case).warnings)
    )


@pytest.mark.parametrize(
    ("keys", "part"),
    [
        ({"motor_front.locating": False}, "no bearing is locating on motor"),
        ({"motor_rear.locating": True}, "both bearings are locating on motor"),
        (
            {
                "motor_rear.locating": True,
                "motor_rear.axial_sense": "negative",
                "motor_front.axial_sense": "positive",
            },
            "",
        ),
        ({}, ""),
    ],
)
def test_who_takes_the_axial_force_is_told_where_nobody_states_it(keys, part):
    case = ep.load_case("train-eaxle").updated({f"bearings.{k}": it for k, it in keys.items()})
    found = [note for note in ep.solve(case).warnings if "locating on" in note]
    assert len(found) == bool(part)
    assert not part or found[0].startswith(f"motor_front: {part}; the first is taken")


@pytest.mark.parametrize(
    ("front", "rear", "taker", "told"),
    [
        ("NU 207", "6207-2RS1", "motor_rear", "seal friction of 6207-2RS1"),
        ("NJ 207", "NU 207", "motor_front", ""),
        ("NU 207", "N 207", "motor_front", "Use one that can."),
    ],
)
def test_a_bearing_that_floats_leaves_the_axial_force_to_the_other(front, rear, taker, told):
    places = (("motor_front", front, "0 mm"), ("motor_rear", rear, "80 mm"))
    tables = {
        f"bearings.{name}": {"shaft": "motor", "designation": designation, "position": place}
        for name, designation, place in places
    }
    result = ep.solve(ep.load_case("train-eaxle").updated(tables))
    figures = result.parts
    carried = {name: figures[f"{name}.bearing"].axial_force for name, _, _ in places}
    assert max(carried, key=carried.get) == taker
    assert min(carried.values()) == 0
    notes = [note for note in result.warnings if note.startswith("motor_")]
    assert any(told in note for note in notes)
    assert any("locating on motor" in note for note in notes) == (rear == "N 207")


def test_arrangements_mirrored_give_mirrored_results(pair_case):
    """In a mirror across the shafts all positions and hands turn round, and X stays X."""
    for arrangement in ("X", "O"):
        own = pair_case.updated({"bearings.middle_front.arrangement": arrangement})
        turned = own.updated(
            {
                **{
                    f'positions."{key}"': f"{-1e3 * place} mm"
                    for key, place in own.positions.items()
                },
                **{
                    f"bearings.{name}.position": f"{-1e3 * table.position} mm"
                    for name, table in own.bearings.items()
                    if table.position is not None
                },
                "sets.pair.hand": "right",
                "sets.planets.hand": "left",
            }
        )
        assert ep.solve(turned).total == pytest.approx(ep.solve(own).total, rel=1e-9)
        assert _axial(turned) == pytest.approx(_axial(own), rel=1e-9)


def test_preload_in_a_case(pair_case):
    least = min(_axial(pair_case).values())
    pressed = _axial(pair_case.updated({"bearings.middle_rear.preload": "90 kN"}))
    assert min(pressed.values()) > 60e3 > least
    near = _axial(pair_case.updated({"bearings.middle_rear.preload_displacement": "80 um"}))
    assert min(near.values()) > least


@pytest.mark.parametrize(
    ("keys", "key"),
    [
        ({"bearings.motor_rear.preload": "1 kN"}, "motor_rear.preload"),
        ({"bearings.motor_rear.arrangement": "O"}, "motor_rear.arrangement"),
        ({"bearings.middle_rear.arrangement": "O", "bearings.middle_front.arrangement": "X"},
         "middle_front.arrangement"),
        ({"bearings.middle_rear.preload": "2 kN",
          "bearings.middle_front.preload_displacement": "7 um"}, "middle_front.preload"),
        ({"bearings.middle_rear.arrangement": "O", "bearings.middle_rear.axial_sense": "positive"},
         "middle_rear.arrangement"),
        ({"bearings.middle_rear.type": "angular-contact", "bearings.middle_rear.designation": None,
          "bearings.middle_rear.bore": "40 mm", "bearings.middle_rear.outside_diameter": "80 mm"},
         "middle_rear.contact_angle"),
    ],
)  # fmt: skip
def test_pairs_that_contradict_themselves(pair_case, keys, key):
    assert only(problems_of(pair_case.updated, keys)).key == f"bearings.{key}"


@pytest.mark.parametrize(
    ("size", "where", "part"),
    [
        ("NU 207", {"radial_force": "1 kN"}, "viscous"),
        ("22210", {"radial_force": "1 kN"}, "viscous"),
        ("NKI 50/25", {"radial_force": "1 kN"}, "viscous"),
        ("81112", {"axial_force": "2 kN"}, "mechanical"),
    ],
)
def test_thick_oil_is_flagged_with_the_loss_that_it_makes_uncertain(size, where, part):
    """The viscous moment knows no heating: it made kilowatts of an axle in cold oil."""
    own = {"shaft": "motor", "designation": size, **where}
    case = ep.load_case("train-eaxle").updated(
        {"lubricant.oil": "iso-vg-220-mineral", "bearings.tried": own}
    )
    warm, cold = (
        ep.solve(case.updated({"operation.oil_inlet_temperature": f"{celsius} degC"}))
        for celsius in (90, 0)
    )
    quantity = "viscosity in the bearing"
    told = [
        [it.watts for it in result.flags if it.quantity == quantity and "tried" in it.use.where]
        for result in (warm, cold)
    ]
    assert told == [[], [pytest.approx(cold.losses[f"tried.{part}"])]]
    assert any(quantity in warning for warning in cold.warnings)
