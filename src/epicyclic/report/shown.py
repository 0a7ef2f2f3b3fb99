"""Numbers and units as tables show them."""

from __future__ import annotations

import math

from epicyclic.units import format_number

__all__ = ["MISSING", "shown"]

MISSING = "-"
"""Stands where there is no number."""

_ROUNDING_NOISE = 1e-9
"""What is smaller, in any unit that tables use, is left over from rounding and shown as 0."""


def shown(value: float, digits: int = 4) -> str:
    """`value` with up to `digits` significant digits."""
    if math.isnan(value):
        return MISSING
    return format_number(0.0 if abs(value) < _ROUNDING_NOISE else value, digits)
