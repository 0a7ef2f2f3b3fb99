"""Numbers and units as tables show them."""

from __future__ import annotations

import math

import pytest

from epicyclic.report.shown import shown
from epicyclic.units import unit_text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1234.56, "1235"),
        (0.001234, "0.001234"),
        (-0.0, "0"),
        (3e-14, "0"),
        (-3e-14, "0"),
        (math.nan, "-"),
    ],
)
def test_rounding_noise_is_zero_and_nan_is_a_dash(value, text):
    assert shown(value) == text


@pytest.mark.parametrize(
    ("unit", "text"),
    [("1", ""), ("N*m", "N·m"), ("mm^2/s", "mm²/s"), ("kg/m^3", "kg/m³"), ("degC", "°C")],
)
def test_units_in_print(unit, text):
    assert unit_text(unit) == text
