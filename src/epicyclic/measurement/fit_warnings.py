"""What to know before using calibrated values."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.parameters import Parameter
from epicyclic.measurement.fit_result import FittedParameter
from epicyclic.measurement.intervals import Linearised
from epicyclic.measurement.profile import PROFILED
from epicyclic.measurement.residuals import Residuals
from epicyclic.units import format_number

FloatArray = NDArray[np.float64]

CURVED = 2.0
"""Growth of the sum of squares over that of a linear model beyond which a warning says so. [1]"""
ALIKE = 0.95
"""Magnitude of a correlation from which a warning names it. [1]"""


def fit_warnings(
    residuals: Residuals, fitted: Sequence[FittedParameter], found: Linearised
) -> Iterator[str]:
    """What limits a fit, in sentences."""
    yield from _of_values(fitted, found)
    if not found.is_separable:
        yield "these points cannot tell the inputs apart: fix some of them."
    yield from _alike(fitted, found)
    if found.freedom == 0:
        yield "there are as many inputs as points: the fit cannot fail, and proves nothing."
    if found.weighted and found.spread > 1:
        yield (
            f"the points scatter {found.spread:.2f} times as much about the fit as their "
            "uncertainties allow; the intervals are widened by that factor."
        )
    if len(fitted) > PROFILED:
        yield from _curved(residuals, found)
    else:
        yield from _skewed(residuals, fitted, found)


def _of_values(fitted: Sequence[FittedParameter], found: Linearised) -> Iterator[str]:
    for item, is_idle in zip(fitted, found.is_idle, strict=True):
        if item.at_bound:
            beyond = "there is no interval" if math.isnan(item.low) else "its interval ends there"
            yield (
                f"{item.key} ended at the bound {format_number(item.value)} {item.unit}".rstrip()
                + f": the measurements ask for a value beyond it, and {beyond}."
            )
        elif is_idle:
            yield (
                f"{item.key} has no influence at its calibrated value, where the models hold it or "
                "what follows from it at the limit of their range: the value means nothing."
            )
        elif item.high - item.low > 2 * abs(item.value):
            yield f"{item.key} is hardly determined: its interval is wider than twice its value."


def _alike(fitted: Sequence[FittedParameter], found: Linearised) -> Iterator[str]:
    correlation = found.correlation()
    for i, j in itertools.combinations(range(len(fitted)), 2):
        if abs(correlation[i, j]) >= ALIKE:
            yield (
                f"{fitted[i].key} and {fitted[j].key} can hardly be told apart (correlation "
                f"{correlation[i, j]:.3f}): fix one of them."
            )


def _skewed(
    residuals: Residuals, fitted: Sequence[FittedParameter], found: Linearised
) -> Iterator[str]:
    """Where the profile of the likelihood says another thing than the linearised model."""
    for item, parameter in zip(fitted, residuals.parameters, strict=True):
        half = found.quantile * item.standard_error
        if math.isnan(half):
            continue
        if not item.profiled:
            yield f"no ends were found of the profile of {item.key}: take its interval as rough."
        ends = [end for end in (item.low, item.high) if end not in (parameter.low, parameter.high)]
        if all(1 / CURVED <= (abs(end - item.value) / half) ** 2 <= CURVED for end in ends):
            continue
        down, up, linear = (
            f"{format_number(one, 2)} {item.unit}".rstrip()
            for one in (item.value - item.low, item.high - item.value, half)
        )
        yield (
            f"the losses are far from linear within the interval of {item.key}: it reaches {down} "
            f"down and {up} up, where a linear model has {linear}. Bands take it as symmetric."
        )


def _curved(residuals: Residuals, found: Linearised) -> Iterator[str]:
    """What the sum of squares at the ends of the intervals says about the linearised model."""
    expected = (found.quantile * found.spread) ** 2
    if not (found.is_separable and expected > 0):
        return
    pairs = {int(parameter): found.ends(int(parameter)) for parameter in found.free}
    inside = {
        parameter: pair
        for parameter, pair in pairs.items()
        if all(_is_inside(residuals.parameters, end) for end in pair)
    }
    deviations = residuals.at([end for pair in inside.values() for end in pair])
    growth = [(float(one @ one) - found.sum_of_squares) / expected for one in deviations]
    for parameter, grown in zip(inside, zip(growth[::2], growth[1::2], strict=True), strict=True):
        if not all(1 / CURVED <= one <= CURVED for one in grown):
            yield (
                "the losses are far from linear within the interval of "
                f"{residuals.parameters[parameter].key}: at its ends the sum of squares grows "
                f"{grown[0]:.2g} and {grown[1]:.2g} times as much as it should. Take it as rough."
            )


def _is_inside(parameters: Sequence[Parameter], scaled: FloatArray) -> bool:
    """True if all of `scaled` are within the bounds."""
    return all(
        item.ends[0] <= z <= item.ends[1] for item, z in zip(parameters, scaled, strict=True)
    )
