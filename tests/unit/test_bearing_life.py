"""Lives of rolling bearings after ISO 281."""

from __future__ import annotations

import math

import pytest

import epicyclic as ep
import listed_trains
from epicyclic.losses.shaft_bearing import BearingLoad, CatalogueBearing
from epicyclic.plugins.design.bearing_life import bearing_rating, dynamic_load, life_modification
from epicyclic.plugins.design.strength import strength
from epicyclic.plugins.design.tables import tables_of

TEN_DEGREES = 1 / math.tan(math.radians(10))
KINDS = {
    # type, extra keys: e, X and Y above it, as catalogues print them
    "angular-contact": ({"axial_factor": 0.4 / math.tan(math.radians(40))}, (1.14, 0.35, 0.57)),
    "tapered": ({"axial_factor": 1.6}, (0.375, 0.4, 1.6)),
    "spherical": ({}, (0.2645, 0.67, 0.67 * TEN_DEGREES)),
}


@pytest.mark.parametrize("kind", ["angular-contact", "tapered", "spherical"])
def test_load_is_combined_above_the_ratio_and_goes_over_smoothly(kind):
    keys, (ratio, radial, axial) = KINDS[kind]
    bearing = CatalogueBearing(kind, 0.04, 0.08, **keys)
    heavy = BearingLoad(2100.0, 2100.0 * ratio * 1.7)
    expected = radial * heavy.radial + axial * heavy.axial
    assert dynamic_load(bearing, heavy) == pytest.approx(expected, rel=1e-9)
    below, above = (
        dynamic_load(bearing, BearingLoad(2100.0, 2100.0 * ratio * it)) for it in (0.999, 1.001)
    )
    assert above == pytest.approx(below, rel=6e-3)  # X and Y have two digits


@pytest.mark.parametrize(
    ("axial", "ratio", "factor"), [(233.43, 0.19, 2.30), (1872.86, 0.30, 1.45), (9350.7, 0.44, 1.0)]
)
def test_balls_in_deep_grooves_lean_with_the_axial_load(axial, ratio, factor):
    """f_0 F_a/C_0 of 0.172, 1.38 and 6.89 with f_0 = 14."""
    bearing = CatalogueBearing("deep-groove", 0.04, 0.08, static_load_rating=19e3)
    light = BearingLoad(axial / ratio * 1.05, axial)
    assert dynamic_load(bearing, light) == light.radial
    heavy = BearingLoad(axial / ratio / 1.3, axial)
    assert dynamic_load(bearing, heavy) == pytest.approx(
        0.56 * heavy.radial + factor * axial, rel=1e-4
    )


def test_spherical_rollers_feel_a_light_axial_load_and_thrust_bearings_nothing_else():
    load = BearingLoad(3100.0, 410.0)
    found = dynamic_load(CatalogueBearing("spherical", 0.05, 0.09), load)
    assert found == pytest.approx(3100 + 0.45 * TEN_DEGREES * 410)
    assert dynamic_load(CatalogueBearing("thrust-ball", 0.05, 0.07), load) == 410
    assert dynamic_load(CatalogueBearing("needle", 0.05, 0.07), load) == 3100


@pytest.mark.parametrize(
    ("keys", "thick", "thin", "bracket", "power", "outer", "relief"),
    [
        ({}, 1.3993, 1.2348, 1.0, 0.4, -9.185, 1.0),
        ({"thrust": True}, 1.3993, 1.2348, 1.0, 0.4, -9.185, 2.5),
        ({"balls": True}, 2.2649, 1.9987, 0.83, 1 / 3, -9.3, 1.0),
        ({"balls": True, "thrust": True}, 2.2649, 1.9987, 0.83, 1 / 3, -9.3, 3.0),
    ],
)
def test_life_factor_is_that_of_the_standard(keys, thick, thin, bracket, power, outer, relief):
    """ISO 281:2007, Eq. 31 to 42, written out; the branches meet at kappa 0.4 and 1."""
    first = 2.5671 if keys.get("balls") else 1.5859
    for kappa, scale, exponent in ((0.3, thick, 0.054381), (0.6, thin, 0.19087),
                                   (1.7, thin, 0.071739)):  # fmt: skip
        known = (first - scale / kappa**exponent) ** bracket
        expected = 0.1 * (1 - known * (0.11 / relief) ** power) ** outer
        assert life_modification(kappa, 0.11, **keys) == pytest.approx(expected, rel=1e-12)
    for corner in (0.4, 1.0):
        below, above = (life_modification(corner * it, 0.11, **keys) for it in (1 - 1e-9, 1.0))
        assert above == pytest.approx(below, rel=1e-3)
    assert life_modification(9.0, 0.11, **keys) == life_modification(4.0, 0.11, **keys)
    assert life_modification(4.0, 40.0, **keys) == 50


def test_life_of_a_ball_bearing():
    """10 kN on a bearing of 55.3 kN: 169 million revolutions, 940 h at 3000 rpm (SKF, 6309)."""
    ball = CatalogueBearing(
        "deep-groove", 0.045, 0.1, dynamic_load_rating=55.3e3, static_load_rating=31.5e3
    )
    found = bearing_rating("a", ball, 10e3, 100 * math.pi, 20e-6, 0.8)
    assert found.basic_life / 3600 == pytest.approx(940, rel=2e-3)
    needed = 4500 / math.sqrt(3000 * 72.5)
    assert found.viscosity_ratio == pytest.approx(20 / needed)
    factor = life_modification(20 / needed, 0.8 * 31.5 / 22 / 10, balls=True)
    assert found.modified_life == pytest.approx(factor * found.basic_life)
    roller = CatalogueBearing("cylindrical", 0.045, 0.1, dynamic_load_rating=55.3e3)
    unknown = bearing_rating("b", roller, 10e3, 100 * math.pi, 20e-6, 0.8)
    assert unknown.basic_life / found.basic_life == pytest.approx(5.53 ** (1 / 3))
    assert math.isnan(unknown.modified_life)


@pytest.fixture(scope="module")
def train():
    tables = listed_trains.train_of_pair()
    (first, second) = tables["shafts"]
    known = {"outside_diameter": "62 mm", "radial_force": "2.3 kN"}
    tables["bearings"] = {
        "A": known | {"shaft": first, "type": "cylindrical", "bore": "30 mm",
                      "dynamic_load_rating": "44 kN", "static_load_rating": "36.5 kN"},
        "B": known | {"shaft": second, "type": "deep-groove", "bore": "31 mm"},
        "C": {"shaft": second, "designation": "NU 206", "radial_force": "1.9 kN"},
    }  # fmt: skip
    tables["strength"] = {"application_factor": 1.4}
    return ep.load_case(tables)


def test_bearings_on_shafts_have_lives(train):
    found = strength(train)
    rated = {one.key: one for one in found.bearings}
    assert {"A", "C"} <= rated.keys()
    assert "B" not in rated
    assert rated["A"].load == pytest.approx(1.4 * 2300)
    assert rated["A"].basic_life * rated["A"].speed == pytest.approx(
        2e6 * math.pi * (44e3 / (1.4 * 2300)) ** (10 / 3)
    )
    no_life, no_modified, estimated = found.notes
    assert no_life.endswith("dynamic_load_rating: B")
    assert no_modified.endswith("static_load_rating: B")
    assert estimated.endswith("C^3: C")
    assert found.least()["bearing_life"] == pytest.approx(
        min(one.modified_life for one in found.bearings) / 3600
    )


def test_factors_of_one_mesh_go_before_those_of_all(train):
    key = strength(train).meshes[0].key
    stated = {"strength.dynamic_factor": 1.27, "strength.face_load_factor": 1.09}
    one = {f'strength.meshes."{key}".face_load_factor': 1.33}
    factors = [strength(train.updated(it)).meshes[0].factors for it in (stated, stated | one)]
    assert [(it.dynamic, it.face) for it in factors] == [(1.27, 1.09), (1.27, 1.33)]
    with pytest.raises(ep.InputError, match=f"Did you mean '{key}'"):
        strength(train.updated({f'strength.meshes."{key[:-1]}".face_load_factor': 1.33}))


def test_the_most_loaded_planet_loads_its_bearing_and_carries_all_at_most():
    case = ep.load_case("talbot-2012")
    (even,) = strength(case).bearings
    stated = {"strength.mesh_load_factor": 1.27}
    (uneven,) = strength(case.updated(stated)).bearings
    assert 1.19 < uneven.load / even.load < 1.27  # the centrifugal force is that of all planets
    one = stated | {"strength.meshes.ring_mesh.mesh_load_factor": 1.04}
    (between,) = strength(case.updated(one)).bearings
    assert even.load < between.load < uneven.load
    for where in ("", "meshes.sun_mesh."):
        key = f"strength.{where}mesh_load_factor"
        with pytest.raises(ep.InputError, match="must be at most 3") as error:
            strength(case.updated({key: 3.2}))
        assert [it.key for it in error.value.problems] == [key]


def test_what_a_run_says_of_its_loads_stands_beside_safeties():
    keys = {"tip_relief": "320 um", "tip_relief_roll_length": "2.1 mm"}
    changes = {f"sun.micro_geometry.{key}": value for key, value in keys.items()}
    notes = strength(ep.load_case("talbot-2012").updated(changes)).notes
    assert [it for it in notes if "of the contact lines of the sun mesh carry load" in it]
    assert not [it for it in notes if "Not included" in it]


def test_a_mesh_without_load_has_no_safety():
    idle = strength(ep.load_case("talbot-2012-pair"))
    assert idle.meshes == ()
    assert "no mesh carries a load" in idle.notes[0]
    assert idle.least() == {}
    assert [item.title for item in tables_of(idle)] == ["Safeties: methods and limits"]
