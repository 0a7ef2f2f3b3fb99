"""Fit of uncertain inputs to measured losses: weighted least squares, bounded by the schema.

`scipy.optimize.least_squares` with its trust-region-reflective method, which keeps to bounds.
The intervals are those of the linearised model at the solution, from its derivatives there: losses
are nearly linear in these inputs, and a profile of the likelihood would take tens of fits.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.parameters import Parameter
from epicyclic.errors import ConvergenceError, InputError, Problem
from epicyclic.measurement.intervals import Linearised
from epicyclic.measurement.model import MeasuredPoints
from epicyclic.units import format_number

__all__ = ["Fit", "FittedParameter", "fit_parameters"]

FloatArray = NDArray[np.float64]

STEP = 1e-3
"""Of the differences that give the derivatives, over the start value. [1]"""
MOST_ROUNDS = 200
"""Trial solutions after which the fit is given up; a curved valley takes some fifty."""
TOLERANCE = 1e-6
"""Relative change of the parameters that ends the fit. [1]"""
SQUARES_TOLERANCE = 1e-7
"""Relative change of the sum of squares that ends the fit. [1]"""
NO_INFLUENCE = 1e-9
"""Relative change of every loss, over that of a parameter, below which it has no influence. [1]"""
CURVED = 2.0
"""Growth of the sum of squares over that of a linear model beyond which a warning says so. [1]"""
ALIKE = 0.95
"""Magnitude of a correlation from which a warning names it. [1]"""
NEAR_BOUND = 1e-4
"""Distance from a bound, over the start value, that counts as at the bound. [1]"""


@dataclass(frozen=True, slots=True)
class FittedParameter:
    """A calibrated value of a key, with its confidence interval.

    Attributes
    ----------
    key, unit : str
    start, value : float
        In the case, and calibrated; in `unit`.
    standard_error, low, high : float
        Of the value, and its confidence interval, in `unit`; NaN if they do not exist.
    at_bound : bool
        True if it ended at a bound of the schema.
    """

    key: str
    unit: str
    start: float
    value: float
    standard_error: float
    low: float
    high: float
    at_bound: bool


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """What a calibration found.

    Attributes
    ----------
    parameters : tuple of FittedParameter
    settings : mapping of str to object
        The calibrated values as a case file has them.
    confidence : float
        Of the intervals. [1]
    correlation : ndarray, shape (p, p)
        Of the parameters; NaN where it does not exist.
    points, degrees_of_freedom : int
        Points used, and these less the parameters.
    chi_squared : float
        Sum of squared deviations over uncertainties; NaN without uncertainties. [1]
    widening : float
        Factor by which the intervals are wider than the uncertainties alone make them. [1]
    evaluations : int
        Computed points.
    warnings : tuple of str
        What to know before using the values.
    """

    parameters: tuple[FittedParameter, ...]
    settings: Mapping[str, Any]
    confidence: float
    correlation: FloatArray
    points: int
    degrees_of_freedom: int
    chi_squared: float
    widening: float
    evaluations: int
    warnings: tuple[str, ...]


@dataclass(slots=True)
class _Residuals:
    """Deviations over weights at the points of calibration, and their derivatives."""

    points: MeasuredPoints
    parameters: Sequence[Parameter]
    used: NDArray[np.bool_]
    _known: dict[tuple[float, ...], FloatArray] = field(default_factory=dict)

    @property
    def evaluations(self) -> int:
        """Computed points."""
        return len(self._known) * len(self.points.measured)

    def settings(self, scaled: FloatArray) -> dict[str, Any]:
        return {
            item.key: item.value(float(z)) for item, z in zip(self.parameters, scaled, strict=True)
        }

    def __call__(self, scaled: FloatArray) -> FloatArray:
        return self.at([scaled])[0]

    def derivatives(self, scaled: FloatArray) -> FloatArray:
        """d(residual)/d(scaled parameter), all from one batch of points, shape (n, p)."""
        steps = [
            -STEP if z + STEP > item.ends[1] else STEP
            for item, z in zip(self.parameters, scaled, strict=True)
        ]
        moved = [
            scaled + step * unit for step, unit in zip(steps, np.eye(scaled.size), strict=True)
        ]
        base, *others = self.at([scaled, *moved])
        table = np.array([(other - base) / step for other, step in zip(others, steps, strict=True)])
        if not np.isfinite(table).all():
            raise ConvergenceError(
                f"near {self.settings(scaled)} points cannot be computed; fit fewer keys, or "
                "start from other values."
            )
        return table.T

    def at(self, scaled: Sequence[FloatArray]) -> list[FloatArray]:
        """Deviations for each of several parameter sets; those that are not known in one batch."""
        sets = [tuple(map(float, one)) for one in scaled]
        new = [one for one in dict.fromkeys(sets) if one not in self._known]
        measured = self.points.measured
        weight = 1.0 if measured.uncertainty is None else 1 / measured.uncertainty[self.used]
        settings = [self.settings(np.array(one)) for one in new]
        for one, computed in zip(new, self.points.compute(*settings) if new else [], strict=True):
            self._known[one] = (computed.loss[self.used] - measured.loss[self.used]) * weight
        return [self._known[one] for one in sets]


def fit_parameters(
    points: MeasuredPoints,
    parameters: Sequence[Parameter],
    used: NDArray[np.bool_],
    confidence: float,
) -> Fit:
    """Fit `parameters` to the measured losses of the points `used`.

    Raises
    ------
    InputError
        If there are fewer points than parameters, or a parameter has no influence.
    ConvergenceError
        If the fit does not converge.
    """
    from scipy.optimize import least_squares

    count, size = int(used.sum()), len(parameters)
    if count < size:
        allowed = f"{size} inputs cannot be fitted to {count} usable points."
        raise InputError(
            [Problem("fit", "", allowed, "Fit fewer, or give more points.")], "the fit"
        )
    residuals = _Residuals(points, parameters, used)
    start = np.ones(size)
    _check_influence(residuals, start)
    ends = np.array([item.ends for item in parameters])
    found = least_squares(
        residuals,
        start,
        residuals.derivatives,
        (ends[:, 0], ends[:, 1]),
        xtol=TOLERANCE,
        ftol=SQUARES_TOLERANCE,
        gtol=TOLERANCE**2,
        max_nfev=MOST_ROUNDS,
    )
    if found.status < 1:
        raise ConvergenceError(
            f"the fit did not converge in {MOST_ROUNDS} rounds; fit fewer keys, or start from "
            "other values with --set."
        )
    distance = np.abs(found.x[:, None] - ends)
    at_bound = (found.active_mask != 0) | (distance < NEAR_BOUND).any(axis=1)
    nearest = ends[np.arange(size), distance.argmin(axis=1)]
    solution = np.where(at_bound, nearest, found.x)  # the method itself stays off the bounds
    weighted = points.measured.uncertainty is not None
    found = Linearised(solution, found.fun, found.jac, at_bound, weighted, confidence)
    return _described(residuals, found)


def _check_influence(residuals: _Residuals, start: FloatArray) -> None:
    loss = residuals.points.measured.loss[residuals.used]
    sigma = residuals.points.measured.uncertainty
    scale = np.abs(loss) if sigma is None else np.abs(loss) / sigma[residuals.used]
    slopes = np.abs(residuals.derivatives(start)).max(axis=0)
    problems = [
        Problem(item.key, "", "has no influence on the measured losses.", "Do not fit it.")
        for item, slope in zip(residuals.parameters, slopes, strict=True)
        if slope <= NO_INFLUENCE * scale.max()
    ]
    if problems:
        raise InputError(problems, "the fit")


def _described(residuals: _Residuals, found: Linearised) -> Fit:
    """The fit with intervals and warnings."""
    fitted = tuple(
        _fitted(item, float(z), found.quantile * float(error), float(error), bool(bound))
        for item, z, error, bound in zip(
            residuals.parameters,
            found.solution,
            found.standard_errors(),
            found.at_bound,
            strict=True,
        )
    )
    return Fit(
        parameters=fitted,
        settings=residuals.settings(found.solution),
        confidence=found.confidence,
        correlation=found.correlation(),
        points=found.deviations.size,
        degrees_of_freedom=found.freedom,
        chi_squared=found.sum_of_squares if found.weighted else math.nan,
        widening=found.spread if found.weighted else math.nan,
        warnings=(*_warnings(fitted, found), *_curved(residuals, found)),
        evaluations=residuals.evaluations,
    )


def _fitted(
    item: Parameter, scaled: float, reach: float, error: float, at_bound: bool
) -> FittedParameter:
    """A parameter in its unit; `scaled`, `reach` and `error` are over its start value."""
    value = min(max(scaled * item.start, item.low), item.high)
    half = reach * abs(item.start)
    return FittedParameter(
        key=item.key,
        unit=item.unit,
        start=item.start,
        value=value,
        standard_error=error * abs(item.start),
        low=max(value - half, item.low) if math.isfinite(half) else math.nan,
        high=min(value + half, item.high) if math.isfinite(half) else math.nan,
        at_bound=at_bound,
    )


def _warnings(fitted: Sequence[FittedParameter], found: Linearised) -> Iterator[str]:
    for item, is_idle in zip(fitted, found.is_idle, strict=True):
        if item.at_bound:
            yield (
                f"{item.key} ended at the bound {format_number(item.value)} {item.unit}".rstrip()
                + ": the measurements ask for a value beyond it, and there is no interval."
            )
        elif is_idle:
            yield (
                f"{item.key} has no influence at its calibrated value, where the models hold it or "
                "what follows from it at the limit of their range: the value means nothing."
            )
        elif item.high - item.low > 2 * abs(item.value):
            yield f"{item.key} is hardly determined: its interval is wider than twice its value."
    if not found.is_separable:
        yield "these points cannot tell the inputs apart: fix some of them."
    correlation = found.correlation()
    for i, j in itertools.combinations(range(len(fitted)), 2):
        if abs(correlation[i, j]) >= ALIKE:
            yield (
                f"{fitted[i].key} and {fitted[j].key} can hardly be told apart (correlation "
                f"{correlation[i, j]:.3f}): fix one of them."
            )
    if found.freedom == 0:
        yield "there are as many inputs as points: the fit cannot fail, and proves nothing."
    if found.weighted and found.spread > 1:
        yield (
            f"the points scatter {found.spread:.2f} times as much about the fit as their "
            "uncertainties allow; the intervals are widened by that factor."
        )


def _curved(residuals: _Residuals, found: Linearised) -> Iterator[str]:
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
