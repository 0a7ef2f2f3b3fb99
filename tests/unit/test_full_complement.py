"""Rollers of planet bearings without a cage."""

from __future__ import annotations

import math

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.losses.planet_bearing import RollerLoads, _pressed, roller_loads, rubbing
from epicyclic.machine.planets import planet_load
from epicyclic.validation.compute import planet_bearing

FULL = {
    "planet_bearing.cage": "full-complement",
    "planet_bearing.rollers_per_row": 23,
    "models.bearing": "full-complement",
    "losses.sun_mesh_pocketing.include": False,
    "losses.ring_mesh_pocketing.include": False,
}
SPEED, PULL = 700.0, 15.0  # [rad/s], [N]


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012").updated(FULL)


@pytest.fixture(scope="module")
def bearing(case):
    from epicyclic.build.machine import build

    return planet_bearing(build(case))


@pytest.fixture(scope="module")
def oil(case):
    from epicyclic.build.models import fluids_of

    return fluids_of(case).oil


def test_the_default_says_which_of_two_models_it_is():
    words = "models.bearing = auto is Palmgren's formula for rollers without a cage"
    case = ep.load_case("talbot-2012").updated({"planet_bearing.cage": "full-complement"})
    assert any(words in note for note in ep.solve(case).notes)
    stated = case.updated({"models.bearing": "palmgren"})
    assert not any(words in note for note in ep.solve(stated).notes)


def test_a_roller_weighs_on_the_next_one_until_a_loaded_one_holds_it():
    loaded = np.array([False, True, False, False, False, True])
    along = np.array([1.0, 9.0, 2.0, 4.0, -3.0, 9.0])
    # between rollers 1 and 5 from 1 on: 0, 2, 6, 3; beyond 5 only roller 0, pushed against 1
    assert sorted(_pressed(loaded, along, along)) == pytest.approx([0, 0, 1, 2, 3, 6])


def test_rollers_that_are_pulled_apart_do_not_touch():
    loaded = np.array([True, False, False, False, False])
    along = np.array([0.0, -1.5, -2.5, 1.25, 0.5])
    # two lean back on the loaded one, two lean forward on it, and the chain parts between them
    assert _pressed(loaded, along, along) == pytest.approx([4.0, 2.5, 0.0, 1.25, 1.75])


def test_loaded_rollers_stand_opposite_to_the_force_on_the_planet():
    """Centrifugal force alone pushes the bore of a planet against the inner side of its pin."""
    assert math.cos(planet_load((), 120.0).outward) == pytest.approx(-1)


def test_without_load_a_row_hangs_like_a_chain(bearing, oil):
    empty = RollerLoads(bearing.azimuth, np.zeros((2, 23, bearing.slices)), np.zeros(4))
    found = rubbing(bearing, empty, SPEED, oil, PULL, outward=0.0)
    half = PULL * sum(math.sin(k * 2 * math.pi / 23) for k in range(1, 12))
    assert found.force == pytest.approx(half)
    assert found.skewed == 0


def test_play_and_skew_follow_from_the_rollers_that_fit(bearing, oil):
    loads = roller_loads(bearing, 5100.0, 0.0, 0.0, 23.0)
    found = rubbing(bearing, loads, SPEED, oil, PULL, outward=1.3)
    free = math.pi - 23 * math.asin(4.015e-3 / bearing.pitch_diameter)
    assert found.play == pytest.approx(free * bearing.pitch_diameter)
    assert found.skew == pytest.approx(2 * found.play / (23 * 9.52e-3))
    assert found.between > 0
    assert found.skewed > 0
    surface = bearing.rolling_speed(SPEED)
    carried = 2 * loads.intensity.sum() * bearing.slice_width
    assert 0.001 < found.skewed / (carried * found.skew * surface) < 0.12


def test_nothing_rubs_at_rest_or_without_pull_and_play(bearing, oil):
    loads = roller_loads(bearing, 5100.0, 0.0, 0.0, 23.0)
    still = rubbing(bearing, loads, 0.0, oil, PULL, outward=1.3)
    assert (still.between, still.skewed) == (0, 0)
    alone = rubbing(bearing, loads, SPEED, oil, 0.0, outward=1.3)
    assert (alone.touching, alone.between) == (0, 0)
    twice = rubbing(bearing, loads, SPEED, oil, 2 * PULL, outward=1.3)
    assert twice.force == pytest.approx(
        2 * rubbing(bearing, loads, SPEED, oil, PULL, outward=1.3).force
    )


def test_it_loses_more_than_the_same_rollers_in_a_cage(case):
    caged = case.updated({"planet_bearing.cage": "caged", "models.bearing": "mixed-ehl"})
    full, without = ep.solve(case), ep.solve(caged)
    name = "planet_bearing_mechanical"
    assert 1 < full.losses[name] / without.losses[name] < 1.8 * 1.5
    (note,) = [note for note in full.notes if "without a cage" in note]
    assert "pairs of them touch" in note
    viscous = full.losses["planet_bearing_viscous"]
    assert viscous == pytest.approx(without.losses["planet_bearing_viscous"])


def test_it_needs_rollers_without_a_cage_that_fill_the_row(case):
    with pytest.raises(ep.InputError, match="without a cage"):
        case.updated({"planet_bearing.cage": "caged"})
    with pytest.raises(ep.InputError, match="23 fit"):
        case.updated({"planet_bearing.rollers_per_row": 21})


def test_ratios_to_rollers_in_a_cage_are_those_of_the_page(case):
    """As docs/theory/planet-bearing.md says after (B23)."""
    caged = {"planet_bearing.cage": "caged", "planet_bearing.rollers_per_row": 16}
    caged["models.bearing"] = "mixed-ehl"
    for torque, rpm, ratio, whole in (
        (1000, 4000, 2.36, 2.24), (1000, 1000, 1.80, 1.77), (250, 1000, 1.43, 1.39),
    ):  # fmt: skip
        at = {"operation.torque": f"{torque} N*m", "operation.speed": f"{rpm} rpm"}
        full, held = (ep.solve(case.updated(at | more)).losses for more in ({}, caged))
        load, viscous = (f"planet_bearing_{part}" for part in ("mechanical", "viscous"))
        assert round(full[load] / held[load], 2) == ratio
        assert round((full[load] + full[viscous]) / (held[load] + held[viscous]), 2) == whole
