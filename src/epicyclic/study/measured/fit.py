"""Fit of uncertain inputs to measured losses: weighted least squares within bounds."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from statistics import NormalDist

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.case.keys import Parameter
from epicyclic.errors import ConvergenceError, Problem, one_problem, raise_any
from epicyclic.study.measured.intervals import (
    PROFILED,
    Combination,
    Fit,
    FittedParameter,
    Linearised,
    Noise,
    combinations,
    profile_ends,
)
from epicyclic.study.measured.residuals import MeasuredPoints, Residuals
from epicyclic.units import format_number

CURVED = 2.0
"""Growth of the sum of squares over that of a linear model beyond which a warning says so. [1]"""
ALIKE = 0.95  # Magnitude of a correlation from which a warning names it. [1]


def fit_warnings(
    residuals: Residuals, fitted: Sequence[FittedParameter], found: Linearised
) -> Iterator[str]:
    """What limits a fit, in sentences."""
    for item, is_idle in zip(fitted, found.is_idle, strict=True):
        if item.at_bound:
            beyond = "there is no interval" if math.isnan(item.low) else "its interval ends there"
            yield (
                f"{item.key} ended at the bound {format_number(item.value)} {item.unit}".rstrip()
                + f": the measurements require a value beyond it, and {beyond}."
            )
        elif is_idle:
            yield (
                f"{item.key} has no influence at its calibrated value, because the models hold "
                "it, or a quantity that depends on it, at the limit of their range; the value is "
                "meaningless."
            )
        elif item.high - item.low > 2 * abs(item.value):
            yield f"{item.key} is poorly determined: its interval is wider than twice its value."
    if not found.is_separable:
        yield "these points cannot separate the inputs: fix some of them."
    correlation = found.correlation()
    for i, j in itertools.combinations(range(len(fitted)), 2):
        if abs(correlation[i, j]) >= ALIKE:
            yield (
                f"{fitted[i].key} and {fitted[j].key} cannot be separated reliably (correlation "
                f"{correlation[i, j]:.3f}): fix one of them."
            )
    if found.freedom == 0:
        yield "there are as many inputs as points, so the fit cannot fail and proves nothing."
    if found.weighted and found.spread > 1:
        yield (
            f"the points scatter {found.spread:.2f} times as much about the fit as their "
            "uncertainties allow; the intervals are widened by that factor."
        )
    if len(fitted) > PROFILED:
        yield from _curved(residuals, found)
    else:
        yield from _skewed(residuals, fitted, found)


def _skewed(
    residuals: Residuals, fitted: Sequence[FittedParameter], found: Linearised
) -> Iterator[str]:
    """Where the profile of the likelihood says another thing than the linearised model."""
    for item, parameter in zip(fitted, residuals.parameters, strict=True):
        half = found.quantile * item.standard_error
        if math.isnan(half):
            continue
        if not item.profiled:
            yield (
                f"the ends of the profile of {item.key} were not found, so its interval is rough."
            )
        ends = [end for end in (item.low, item.high) if end not in (parameter.low, parameter.high)]
        if all(1 / CURVED <= (abs(end - item.value) / half) ** 2 <= CURVED for end in ends):
            continue
        down, up, linear = (
            f"{format_number(one, 2)} {item.unit}".rstrip()
            for one in (item.value - item.low, item.high - item.value, half)
        )
        yield (
            f"the losses are far from linear within the interval of {item.key}, which reaches "
            f"{down} down and {up} up, where a linear model gives {linear}. Bands assume it to be "
            "symmetric."
        )


def _curved(residuals: Residuals, found: Linearised) -> Iterator[str]:
    """What the sum of squares at the ends of the intervals says about the linearised model."""
    expected = (found.quantile * found.spread) ** 2
    if not (found.is_separable and expected > 0):
        return
    pairs = {int(parameter): found.ends(int(parameter)) for parameter in found.free}
    low, high = residuals.bounds.T
    inside = {
        parameter: pair
        for parameter, pair in pairs.items()
        if all(((low <= end) & (end <= high)).all() for end in pair)
    }
    deviations = residuals.at([end for pair in inside.values() for end in pair])
    growth = [(float(one @ one) - found.sum_of_squares) / expected for one in deviations]
    for parameter, grown in zip(inside, zip(growth[::2], growth[1::2], strict=True), strict=True):
        if not all(1 / CURVED <= one <= CURVED for one in grown):
            yield (
                "the losses are far from linear within the interval of "
                f"{residuals.parameters[parameter].key}: at its ends the sum of squares grows "
                f"{grown[0]:.2g} and {grown[1]:.2g} times as much as expected, so the interval is "
                "rough."
            )


# `scipy.optimize.least_squares` with its trust-region-reflective method, which keeps to bounds.
# Covariances are those of the linearised model at the solution, from its derivatives there;
# intervals of few parameters follow from profiles of the likelihood.

Tell = Callable[[str], None]  # Is told how a fit gets on, a sentence at a time.

MOST_ROUNDS = 200
"""Trial solutions after which the fit is given up; a curved valley takes some fifty."""
TOLERANCE = 1e-5  # Relative change of the parameters that ends the fit. [1]
SQUARES_TOLERANCE = 1e-5  # Relative change of the sum of squares that ends the fit. [1]
NO_INFLUENCE = 1e-9
"""Relative change of every loss, over that of a parameter, below which it has no influence. [1]"""
EVIDENCE = 4.0
"""Difference of Akaike's criterion from which a relative scatter is taken: a constant one has
considerably less support (K. P. Burnham, D. R. Anderson, Model Selection (2002) 70). [1]"""
REWEIGHTED = 2  # Fits with weights of the losses of the fit before, for a relative scatter.
SMALLEST = 1e-3  # Scatter of a point over the largest, at least. [1]
NEAR_BOUND = 1e-4  # Distance from a bound, over the start value, that counts as at the bound. [1]


def fit_parameters(
    points: MeasuredPoints,
    parameters: Sequence[Parameter],
    used: BoolArray,
    confidence: float,
    reach: FloatArray | None = None,
    tell: Tell = lambda text: None,
    *,
    relative: float | None = None,
) -> Fit:
    """Fit `parameters` to the measured losses of the points `used`. Theory (X4).

    `reach` is how far each may be off before the fit, over its start value; see `reaches`.
    `relative` is the standard uncertainty of all points over their losses, if that is known. Raises
    `InputError` if there are fewer points than parameters, or a parameter has no influence;
    `ConvergenceError` if the fit does not converge.
    """
    count, size = int(used.sum()), len(parameters)
    if count < size:
        allowed = f"{size} inputs cannot be fitted to {count} usable points."
        raise one_problem("fit", "", allowed, "Fit fewer keys, or give more points.", "the fit")
    residuals = Residuals(points.shared(), parameters, used)
    names = ", ".join(item.key for item in parameters)
    tell(f"fit: {count} points, {names}")
    slopes = residuals.derivatives(np.ones(size))
    _check_influence(residuals, slopes)
    known = combinations(
        parameters,
        residuals(np.ones(size)),
        slopes,
        np.ones(size) if reach is None else reach,
        weighted=residuals.uncertainty is not None,
    )
    for one in known:
        if not one.told_apart:
            tell(one.warning)
    exact = Residuals(points, parameters, used)
    noise: Noise = "stated"
    found = _solution(residuals, exact, confidence, tell)
    if relative is not None:
        residuals, found = _relative(residuals, exact, found, tell, relative)
    elif residuals.uncertainty is None:
        noise, other = "constant", _relative(residuals, exact, found, tell)
        if _is_likelier(*other, found):
            noise, (residuals, found) = "relative", other
    return replace(_described(residuals, found, known, tell), noise=noise)


def _relative(
    residuals: Residuals, exact: Residuals, found: Linearised, tell: Tell, size: float | None = None
) -> tuple[Residuals, Linearised]:
    """The fit with a scatter in proportion to the losses, of a `size` that may be unknown.

    Weights are those of computed losses: measured ones that are too small by chance would have the
    most. Theory (X9).
    """
    for _ in range(REWEIGHTED):
        losses = np.abs(residuals.losses(found.solution))
        if size is None:
            losses = losses / math.sqrt(float(np.mean(losses**2)))
        scatter = np.maximum(losses, SMALLEST * losses.max()) * (size or 1.0)
        known = size is not None
        residuals = replace(residuals, scatter=scatter, known=known, _offset=0.0)
        exact = replace(exact, scatter=scatter, known=known, _offset=0.0)
        found = _solution(residuals, exact, found.confidence, tell, found.solution)
    return residuals, found


def _is_likelier(residuals: Residuals, found: Linearised, constant: Linearised) -> bool:
    """Whether a relative scatter makes the residuals likelier than a constant one."""
    assert residuals.scatter is not None
    if found.freedom == 0 or min(found.sum_of_squares, constant.sum_of_squares) == 0:
        return False
    gain = math.log(constant.sum_of_squares / found.sum_of_squares)
    gain -= 2 * float(np.mean(np.log(residuals.scatter)))
    return found.deviations.size * gain > EVIDENCE


def _solution(
    residuals: Residuals,
    exact: Residuals,
    confidence: float,
    tell: Tell,
    begin: FloatArray | None = None,
) -> Linearised:
    """The solution, at last with exact flows through pockets and better derivatives."""
    from scipy.optimize import least_squares

    def told(scaled: FloatArray) -> FloatArray:
        deviations = residuals(scaled)
        values = ", ".join(
            f"{item.key} {format_number(float(z) * item.start, 4)} {item.unit}".rstrip()
            for item, z in zip(residuals.parameters, scaled, strict=True)
        )
        root = math.sqrt(float(np.mean(deviations**2)))
        unit = "W rms" if residuals.uncertainty is None else "of the uncertainties, rms"
        tell(f"fit: error of {format_number(root, 3)} {unit}, at {values}")
        return deviations

    ends = residuals.bounds
    found = least_squares(
        told,
        np.ones(len(ends)) if begin is None else _inside(begin, ends),
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
    nearest = ends[np.arange(len(ends)), distance.argmin(axis=1)]
    start = np.where(at_bound, nearest, found.x)  # the method itself stays off the bounds
    residuals.correct(exact, start)
    slopes = residuals.derivatives(start, central=True)
    solution = _last_step(residuals, start, slopes, at_bound)
    residuals.correct(exact, solution)
    weighted = residuals.uncertainty is not None
    return Linearised(solution, residuals(solution), slopes, at_bound, weighted, confidence)


def _inside(place: FloatArray, ends: FloatArray) -> FloatArray:
    """`place` off the bounds, where the method may begin."""
    room = NEAR_BOUND * np.maximum(1.0, np.abs(place))
    return np.clip(place, ends[:, 0] + room, ends[:, 1] - room)


def _last_step(
    residuals: Residuals, start: FloatArray, slopes: FloatArray, at_bound: BoolArray
) -> FloatArray:
    """To where a linear model puts the least squares."""
    deviations = residuals(start)
    ends = start.copy()
    ends[~at_bound] -= np.linalg.lstsq(slopes[:, ~at_bound], deviations)[0]
    ends = np.clip(ends, residuals.bounds[:, 0], residuals.bounds[:, 1])
    there = residuals(ends)
    return ends if there @ there < deviations @ deviations else start


def _check_influence(residuals: Residuals, slopes: FloatArray) -> None:
    scale = np.abs(residuals.points.measured.loss[residuals.used]) * residuals.weight
    problems = [
        Problem(item.key, "", "has no influence on the measured losses.", "Do not fit it.")
        for item, slope in zip(residuals.parameters, np.abs(slopes).max(axis=0), strict=True)
        if slope <= NO_INFLUENCE * scale.max()
    ]
    raise_any(problems, "the fit")


def _described(
    residuals: Residuals, found: Linearised, known: tuple[Combination, ...], tell: Tell
) -> Fit:
    """The fit with intervals and warnings."""
    errors = found.standard_errors()
    reach = found.quantile * errors
    ends = np.full((errors.size, 2), np.nan)
    if errors.size <= PROFILED:
        tell("fit: profiles of the likelihood")
        ends = profile_ends(residuals, found)
    profiled = np.isfinite(ends).all(axis=1)
    linear = np.stack([found.solution - reach, found.solution + reach], axis=1)
    ends = np.where(profiled[:, None], ends, linear)
    fitted = tuple(
        _fitted(item, found, number, ends[number], bool(profiled[number]))
        for number, item in enumerate(residuals.parameters)
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
        discrepancy=_discrepancy(residuals, found),
        combinations=known,
        warnings=(
            *(one.warning for one in known if not one.told_apart),
            *fit_warnings(residuals, fitted, found),
        ),
        evaluations=residuals.evaluations,
    )


def _discrepancy(residuals: Residuals, found: Linearised) -> float:
    """Error of the model as an extra variance, after Birge. Theory (X6). [W]"""
    if residuals.uncertainty is None:
        return found.spread
    return math.sqrt(float(np.mean(residuals.uncertainty**2)) * (found.spread**2 - 1))


def _fitted(
    item: Parameter, found: Linearised, number: int, ends: FloatArray, profiled: bool
) -> FittedParameter:
    """A parameter in its unit; `ends` are over its start value."""
    at_bound = bool(found.at_bound[number])
    error = float(found.standard_errors()[number]) * abs(item.start)
    value, *rising = (
        min(max(float(z) * item.start, item.low), item.high) if math.isfinite(z) else math.nan
        for z in (found.solution[number], *ends)
    )
    low, high = sorted(rising)
    # bands take a normal distribution that has the same interval, at a bound half of it
    reach = high - low if at_bound else (high - low) / 2
    if not at_bound and not item.low < low < high < item.high:
        reach = found.quantile * error
    return FittedParameter(
        key=item.key,
        unit=item.unit,
        start=item.start,
        value=value,
        standard_error=error,
        low=low,
        high=high,
        at_bound=at_bound,
        profiled=profiled,
        uncertainty=reach / NormalDist().inv_cdf((1 + found.confidence) / 2),
    )
