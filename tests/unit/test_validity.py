"""Flags for models used outside the ranges in which they were made."""

from __future__ import annotations

import math

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.losses.mixed_ehl_groups import TALBOT_GEAR_RANGES, held_in_range, light_load_share
from epicyclic.losses.planet_bearing import NEEDLE_RANGES
from epicyclic.losses.validity import (
    CELSIUS,
    GIGAPASCAL,
    MILLIMETRE,
    Range,
    check_ranges,
    describe_flags,
)

PRESSURE = Range("pressure", "Hertz pressure", 0.5, 2.5, GIGAPASCAL, "a table")
TEMPERATURE = Range("temperature", "oil temperature", 25.0, 100.0, CELSIUS, "a table")


def test_ranges_are_those_of_the_source():
    # Talbot (2012), Table 5.1; viscosities of its fluid over the temperatures of the table
    found = {item.name: (item.low, item.high, item.unit.display) for item in TALBOT_GEAR_RANGES}
    assert found == {
        "temperature": (25.0, 100.0, "degC"),
        "dynamic_viscosity": (4.9, 48.0, "mPa*s"),
        "radius": (5.0, 40.0, "mm"),
        "roughness": (0.1, 0.7, "um"),
        "hertz_pressure": (0.5, 2.5, "GPa"),
        "rolling_speed": (1.0, 20.0, "m/s"),
        "slide_to_roll_ratio": (0.025, 1.0, ""),
    }
    # Talbot (2012), Table 3.1
    found = {item.name: (item.low, item.high, item.unit.display) for item in NEEDLE_RANGES}
    assert found == {
        "temperature": (25.0, 100.0, "degC"),
        "dynamic_viscosity": (4.9, 48.0, "mPa*s"),
        "radius": (0.5, 4.0, "mm"),
        "race_roughness": (0.02, 0.10, "um"),
        "roller_roughness": (0.055, 0.165, "um"),
        "rolling_speed": (1.0, 20.0, "m/s"),
    }


def test_nothing_is_flagged_inside():
    values = {"pressure": np.array([0.5e9, 1e9, 2.5e9]), "temperature": 273.15 + 25}
    assert check_ranges("m", (PRESSURE, TEMPERATURE), values) == ()


def test_share_is_the_weight_outside():
    values = {"pressure": np.array([0.4e9, 1e9, 2e9, 3e9])}
    (flag,) = check_ranges("m", (PRESSURE,), values, np.array([1.0, 2.0, 3.0, 6.0]))
    assert flag.share == pytest.approx(7 / 12, rel=1e-12)
    assert (flag.found_low, flag.found_high) == pytest.approx((0.4, 3.0), rel=1e-12)
    assert (flag.low, flag.high, flag.unit) == (0.5, 2.5, "GPa")


def test_temperatures_have_an_offset():
    (flag,) = check_ranges("m", (TEMPERATURE,), {"temperature": 273.15 + 110.0})
    assert flag.found_low == pytest.approx(110.0, abs=1e-9)
    assert flag.share == 1.0


def test_no_loss_at_all_counts_as_outside():
    (flag,) = check_ranges("m", (PRESSURE,), {"pressure": np.array([0.1e9])}, np.array([0.0]))
    assert flag.share == 1.0


def test_sentence_names_every_model():
    one = check_ranges("model A", (PRESSURE,), {"pressure": np.array([0.1e9, 1e9])}, 1.0)
    two = check_ranges("model B", (PRESSURE,), {"pressure": np.array([4e9])}, 1.0)
    (sentence,) = describe_flags(one + two)
    for part in ("model A 50%", "model B 100%", "0.1 to 4 GPa", "range 0.5 to 2.5 GPa", "a table"):
        assert part in sentence


def test_values_are_held_within_twice_the_range():
    item = Range("radius", "radius", 5.0, 40.0, MILLIMETRE, "a table")
    values = np.array([1e-6, 2.4e-3, 2.6e-3, 30e-3, 79e-3, 81e-3, 10.0])
    held = held_in_range(values, item)
    assert held == pytest.approx([2.5e-3, 2.5e-3, 2.6e-3, 30e-3, 79e-3, 80e-3, 80e-3], rel=1e-12)


def test_share_of_a_light_load_is_its_line_load_over_the_held_one():
    pressure = np.array([0.0, 0.125e9, 0.25e9, 0.3e9, 3e9])
    assert light_load_share(pressure) == pytest.approx([0.0, 0.25, 1.0, 1.0, 1.0], rel=1e-12)


# --- through the case -----------------------------------------------------------------------------


def quantities(result):
    return {flag.quantity for flag in result.flags}


def test_test_article_hardly_leaves_the_ranges_made_for_it(talbot):
    result = ep.solve(talbot)
    # At the pitch point it slides less, under the ends of the rollers it is pressed less, and at
    # the root of the planet it is curved more than simulated: 14 % of one loss at most.
    assert quantities(result) == {"equivalent radius", "Hertz pressure", "slide-to-roll ratio"}
    for flag in result.flags:
        assert 0 <= flag.share < 0.15


@pytest.mark.parametrize(
    ("changes", "quantity"),
    [
        ({"operation.oil_inlet_temperature": "110 degC"}, "oil temperature"),
        ({"operation.oil_inlet_temperature": "110 degC"}, "temperature"),
        ({"planet.roughness": "0.8 um"}, "rms roughness"),
        ({"operation.torque": "20 N*m"}, "Hertz pressure"),
        ({"operation.torque": "20000 N*m"}, "Hertz pressure"),
        ({"operation.speed": "20000 rpm"}, "rolling speed"),
        ({"operation.speed": "100 rpm"}, "rolling speed"),
        ({"planet_bearing.race_roughness": "0.2 um"}, "rms roughness of the races"),
        ({"planet_bearing.roller_roughness": "0.02 um"}, "rms roughness of the rollers"),
        (
            {"models.friction": "niemann-winter", "operation.speed": "100 rpm"},
            "pitch-line speed",
        ),
        ({"models.friction": "schlenk", "operation.speed": "20000 rpm"}, "pitch-line speed"),
        (
            {"lubricant.oil": "atf-dexron-ulv", "operation.oil_inlet_temperature": "180 degC"},
            "kinematic viscosity",
        ),
    ],
)
def test_leaving_a_range_is_flagged_and_said(talbot, changes, quantity):
    assert quantity not in quantities(ep.solve(talbot)) - {"Hertz pressure"}
    result = ep.solve(talbot.updated(changes))
    assert quantity in quantities(result)
    assert any(quantity in warning and "Out of range" in warning for warning in result.warnings)
    for flag in result.flags:
        assert 0 <= flag.share <= 1
        assert math.isfinite(flag.found_low)


def test_own_oil_of_the_regression_is_told_apart(talbot):
    other = ep.solve(talbot.updated({"lubricant.oil": "iso-vg-100-mineral"}))
    assert other.models["friction"] == "schlenk"
    assert other.models["bearing"] == "palmgren"
    assert other.models["rolling"] == "goksem-hargreaves"
    own = ep.solve(talbot)
    assert own.models["friction"] == own.models["bearing"] == own.models["rolling"] == "mixed-ehl"
