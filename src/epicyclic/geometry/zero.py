"""Zero of a function of one argument."""

from __future__ import annotations

from collections.abc import Callable


def zero_between(function: Callable[[float], float], low: float, high: float) -> float:
    """Zero of `function` between two arguments, by the Illinois variant of regula falsi.

    If rounding errors leave both ends with one sign, the end closer to zero is returned.
    """
    at_low, at_high = function(low), function(high)
    if at_low * at_high >= 0.0:
        return low if abs(at_low) < abs(at_high) else high
    for _ in range(100):
        middle = high - at_high * (high - low) / (at_high - at_low)
        at_middle = function(middle)
        if at_middle == 0.0 or abs(high - low) <= 1e-15 * abs(high) or middle in (low, high):
            return middle
        if at_middle * at_high < 0.0:
            low, at_low = high, at_high
        else:
            at_low /= 2
        high, at_high = middle, at_middle
    return high
