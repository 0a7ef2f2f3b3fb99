"""What a fit found, how well, and what measured points cannot tell apart."""

from __future__ import annotations

import math
from collections.abc import Generator, Mapping, Sequence
from functools import cached_property
from typing import Any, Literal

import numpy as np

from epicyclic.arrays import TINY, BoolArray, FloatArray, IntArray
from epicyclic.case.case import Case
from epicyclic.case.keys import Parameter
from epicyclic.case.tables.uncertainty import MODEL_FORM, UncertainValue
from epicyclic.dataclass import dataclass, field
from epicyclic.study.bands.inputs import uncertain_values
from epicyclic.study.bands.samples import standard_uncertainty
from epicyclic.study.measured.residuals import STEP, Residuals
from epicyclic.units import format_number

# What a least-squares solution says about its parameters, the model taken as linear there.

SINGULAR = 1e-7
"""Ratio of singular values of the derivatives below which parameters cannot be told apart. [1]"""


@dataclass(frozen=True, eq=False)
class Linearised:
    """A solution with its derivatives."""

    solution: FloatArray
    deviations: FloatArray  # Computed less measured, over the uncertainty if `weighted`.
    derivatives: FloatArray  # Derivatives of the deviations.
    at_bound: BoolArray  # Parameters that cannot move freely; they have no interval.
    weighted: bool
    confidence: float  # [1]

    @property
    def sum_of_squares(self) -> float:
        """Sum of the squared deviations."""
        return float(self.deviations @ self.deviations)

    @property
    def freedom(self) -> int:
        """Degrees of freedom."""
        return self.deviations.size - self.solution.size

    @cached_property
    def is_idle(self) -> BoolArray:
        """Parameters that change nothing at the solution."""
        lengths = np.linalg.norm(self.derivatives, axis=0)
        idle: BoolArray = ~self.at_bound & (lengths <= SINGULAR * lengths.max())
        return idle

    @cached_property
    def free(self) -> IntArray:
        """Parameters that have an interval, unless they cannot be told apart."""
        return np.flatnonzero(~self.at_bound & ~self.is_idle)

    @cached_property
    def covariance(self) -> FloatArray:
        """Inverse of J'J of the free parameters; NaN if they cannot be told apart."""
        derivatives = self.derivatives[:, self.free]
        size = derivatives.shape[1]
        if size == 0:
            return np.zeros((0, 0))
        lengths = np.linalg.norm(derivatives, axis=0)
        _, singular, directions = np.linalg.svd(derivatives / lengths, full_matrices=False)
        if singular[-1] < SINGULAR * singular[0]:
            return np.full((size, size), np.nan)
        scaled = directions.T / singular / lengths[:, None]
        inverse: FloatArray = scaled @ scaled.T
        return inverse

    @property
    def is_separable(self) -> bool:
        """True if the free parameters can be told apart."""
        return not np.isnan(self.covariance).any()

    @property
    def spread(self) -> float:
        """Standard deviation of the deviations. Theory (X5).

        With uncertainties it is 1, or what the scatter shows if that is more (R. T. Birge, Phys.
        Rev. 40 (1932) 207); without them the scatter.
        """
        if self.freedom == 0:
            return 1.0 if self.weighted else math.nan
        scatter = math.sqrt(self.sum_of_squares / self.freedom)
        return max(1.0, scatter) if self.weighted else scatter

    @cached_property
    def quantile(self) -> float:
        """Half the interval over the standard error: of the normal distribution with uncertainties,
        of Student's without."""
        from scipy import stats

        tail = (1 + self.confidence) / 2
        if self.weighted:
            return float(stats.norm.ppf(tail))
        return float(stats.t.ppf(tail, self.freedom)) if self.freedom > 0 else math.nan

    def standard_errors(self) -> FloatArray:
        """Standard errors of all parameters, shape (p,); NaN where there is none."""
        errors = np.full(self.solution.size, np.nan)
        errors[self.free] = np.sqrt(np.diag(self.covariance)) * self.spread
        return errors

    def correlation(self) -> FloatArray:
        """Correlation of all parameters, shape (p, p); NaN where there is none."""
        size = self.solution.size
        table = np.full((size, size), np.nan)
        deviation = np.sqrt(np.diag(self.covariance))
        table[np.ix_(self.free, self.free)] = self.covariance / np.outer(deviation, deviation)
        return table

    def ends(self, parameter: int) -> tuple[FloatArray, FloatArray]:
        """The solutions at both ends of the interval of a free `parameter`, the others following.

        There the sum of squares of a linear model has grown by (quantile spread)^2.
        """
        place = int(np.flatnonzero(self.free == parameter)[0])
        column = self.covariance[:, place]
        step = np.zeros(self.solution.size)
        step[self.free] = self.quantile * self.spread * column / math.sqrt(column[place])
        return self.solution - step, self.solution + step


# Intervals from the profile of the likelihood: one parameter held, the others fitted again.
#
# The sum of squares along that valley says how far a parameter may be off, also where the losses
# are not linear in it or where it ended at a bound.

PROFILED = 3  # Parameters up to which profiles are made.
MOST_PLACES, MOST_ROUNDS = 12, 8
"""Places tried for one end, and fits of the other parameters at each."""
CLOSE = 0.02  # Root of the growth of the sum of squares over that wanted, less 1, that is met. [1]
GAIN = 1e-2  # Gain over the growth wanted below which the others are not fitted any further. [1]
CURVED = 0.05
"""Square of what a linear model leaves over the growth wanted, beyond which derivatives over the
other parameters are found anew. [1]"""
FARTHER = 3.0
"""Largest factor between places while the end is not passed, and largest step of the other
parameters over half their intervals. [1]"""

Walk = Generator[FloatArray, FloatArray, float]


def profile_ends(residuals: Residuals, found: Linearised) -> FloatArray:
    """Both ends of the interval of every parameter, from its profile. Theory (X7).

    An end beyond a bound is the bound.

    Returns ndarray, shape (p, 2): scaled; NaN where there is none.
    """
    ends = np.full((found.solution.size, 2), np.nan)
    growth = (found.quantile * found.spread) ** 2
    if not (found.is_separable and growth > 0):
        return ends
    at_solution, bounds = residuals(found.solution), residuals.bounds
    walks = {
        (parameter, side): _Way(found, at_solution, bounds, growth, parameter).walk(side)
        for parameter in range(found.solution.size)
        for side in (0, 1)
        if not found.is_idle[parameter]
    }
    answers: dict[tuple[int, int], Any] = dict.fromkeys(walks)  # to the first step there is none
    while answers:  # all walks side by side: their points are computed in one go
        asked = {}
        for place, deviations in answers.items():
            try:
                asked[place] = walks[place].send(deviations)
            except StopIteration as done:
                ends[place] = done.value
        answers = dict(zip(asked, residuals.at(list(asked.values())), strict=True))
    return ends


@dataclass(slots=True, eq=False)
class _Way:
    """The bottom of the valley around a solution, from there to one side of a parameter."""

    found: Linearised
    at_solution: FloatArray  # Deviations there.
    bounds: FloatArray
    growth: float  # Growth of the sum of squares at the end.
    parameter: int  # The one that is held.
    others: IntArray = field(init=False)  # Free parameters beside it.
    # Derivatives of the deviations; of the solution at first, then kept up to date after Broyden.
    derivatives: FloatArray = field(init=False)
    # From the solution to the bottom at the last place, for each unit of the parameter.
    direction: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        self.others = self.found.free[self.found.free != self.parameter]
        self.derivatives = self.found.derivatives.copy()
        self.direction = np.eye(self.found.solution.size)[self.parameter]

    def walk(self, side: int) -> Walk:
        """Where the sum of squares has grown enough on one side."""
        start = float(self.found.solution[self.parameter])
        room = abs(float(self.bounds[self.parameter, side]) - start)
        sign = 2.0 * side - 1.0
        if room == 0:
            return start
        inner, outer = (0.0, -1.0), (math.inf, math.nan)
        distance = self._guess(sign)
        if math.isnan(distance):
            return math.nan
        for _ in range(MOST_PLACES):
            distance = min(distance, room)
            squares = yield from self._lowest(sign * distance)
            grown = (squares - float(self.at_solution @ self.at_solution)) / self.growth
            excess = math.sqrt(max(grown, 0.0)) - 1
            if math.isnan(excess):
                return math.nan
            if abs(excess) <= CLOSE or (excess < 0 and distance == room):
                return start + sign * distance
            if excess < 0:
                inner = (distance, excess)
            else:
                outer = (distance, excess)
            distance = _between(inner, outer)
        return math.nan

    def _guess(self, sign: float) -> float:
        """Distance of the end if the model were linear; NaN without influence."""
        column = self.found.derivatives[:, self.parameter]
        others = self.found.derivatives[:, self.others]
        alone = column - others @ np.linalg.lstsq(others, column)[0]
        curvature = float(alone @ alone)
        slope = max(0.0, sign * float(column @ self.at_solution))  # not 0 at a bound
        if curvature == 0:
            return math.nan
        return float((math.sqrt(slope**2 + curvature * self.growth) - slope) / curvature)

    def _lowest(self, offset: float) -> Walk:
        """Least sum of squares with the parameter held at an offset, after Gauss and Newton."""
        solution, others = self.found.solution, self.others
        here = solution + offset * self.direction
        if self.direction[others].any():  # from where the last place led to
            here = np.clip(here, self.bounds[:, 0], self.bounds[:, 1])
        else:
            here = self._moved(here, self.at_solution + self.derivatives @ (here - solution))
        deviations = yield here
        linear = self.at_solution + self.found.derivatives @ (here - solution)
        if float(np.sum((deviations - linear) ** 2)) > CURVED * self.growth:
            yield from self._derive(here, deviations)
        for _ in range(MOST_ROUNDS if others.size else 0):
            if not np.isfinite(deviations).all():
                break
            there = self._moved(here, deviations)
            step = there - here
            expected = self.derivatives @ step
            if float(expected @ expected) <= GAIN * self.growth:
                break
            changed = yield there
            if not np.isfinite(changed).all():
                break
            self.derivatives += np.outer(changed - deviations - expected, step) / (step @ step)
            if changed @ changed < deviations @ deviations:
                here, deviations = there, changed
        self.direction = (here - solution) / offset
        return float(deviations @ deviations)

    def _derive(
        self, here: FloatArray, deviations: FloatArray
    ) -> Generator[FloatArray, FloatArray, None]:
        """Derivatives over the other parameters by differences."""
        for other in self.others:
            moved = here.copy()
            moved[other] += STEP if here[other] + STEP <= self.bounds[other, 1] else -STEP
            changed = yield moved
            if np.isfinite(changed).all():
                self.derivatives[:, other] = (changed - deviations) / (moved[other] - here[other])

    def _moved(self, here: FloatArray, deviations: FloatArray) -> FloatArray:
        """The other parameters where a linear model puts the least squares.

        At most as far from `here` as `FARTHER` times half their intervals, and within the bounds.
        """
        places = np.searchsorted(self.found.free, self.others)
        most = FARTHER * np.sqrt(self.growth * np.diag(self.found.covariance)[places])
        step = -np.linalg.lstsq(self.derivatives[:, self.others], deviations)[0]
        there = here.copy()
        there[self.others] += np.clip(step, -most, most)
        return np.clip(there, self.bounds[:, 0], self.bounds[:, 1])


def _between(inner: tuple[float, float], outer: tuple[float, float]) -> float:
    """The next place: by a straight line, kept off the ends of what is left."""
    (near, below), (far, above) = inner, outer
    if math.isinf(far):
        return near * (FARTHER if below <= 1 / FARTHER - 1 else 1 / (1 + below))
    part = -below / (above - below)
    return near + (far - near) * min(max(part, 0.1), 0.9)


Noise = Literal["stated", "constant", "relative"]


@dataclass(frozen=True, slots=True)
class FittedParameter:
    """A calibrated value of a key, with its confidence interval.

    Attributes
    ----------
    key, unit : str
    start, value : float
        In the case, and calibrated; in `unit`.
    standard_error, low, high : float
        Standard error of the linearised model, and the confidence interval, in `unit`; NaN if they
        do not exist.
    at_bound : bool
        True if it ended at a bound of the schema.
    profiled : bool
        True if the interval follows from the profile of the likelihood.
    uncertainty : float
        Standard uncertainty of a normal distribution, cut off at the bounds, that has the interval;
        NaN if there is none. In `unit`.
    """

    key: str
    unit: str
    start: float
    value: float
    standard_error: float
    low: float
    high: float
    at_bound: bool
    profiled: bool
    uncertainty: float


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """What a calibration found.

    Attributes
    ----------
    parameters : tuple of FittedParameter
    settings : mapping of str to object
        The calibrated values as a case file has them.
    confidence : float
        Confidence of the intervals. [1]
    correlation : ndarray, shape (p, p)
        Correlation of the parameters; NaN where it does not exist.
    points, degrees_of_freedom : int
        Points used, and these less the parameters.
    chi_squared : float
        Sum of squared deviations over uncertainties; NaN without uncertainties. [1]
    widening : float
        Factor by which the intervals are wider than the uncertainties alone make them. [1]
    discrepancy : float
        Standard deviation of the error of the model at these points, beyond the uncertainties of
        the measurements, or with these where none are stated; root mean square. [W]
    combinations : tuple of Combination
        What the points know least about, first; as found before the fit.
    evaluations : int
        Computed points.
    noise : {"stated", "constant", "relative"}
        How the measurements scatter: as they state, or, of those without uncertainties, alike in W
        or in proportion to the loss, whichever fits the residuals better.
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
    discrepancy: float
    combinations: tuple[Combination, ...]
    evaluations: int
    warnings: tuple[str, ...]
    noise: Noise = "stated"


# Combinations of inputs that measured points cannot tell apart, found before a fit.
#
# How far each input may be off is known before, from [uncertainty] or by assumption. A combination
# of inputs that may be off that far without moving the losses by their uncertainty cannot be
# fitted.

NAMED = 0.2  # Component of a direction, over the largest, from which an input is named. [1]


@dataclass(frozen=True, slots=True)
class Combination:
    """Inputs moved together, as far as they were known before the fit."""

    keys: tuple[str, ...]  # The inputs that move most, the first of them upwards.
    units: tuple[str, ...]
    start: tuple[float, ...]  # Their values in the case and after the move.
    moved: tuple[float, ...]  # Their values in the case and after the move.
    # Root mean square change of the losses over their scatter: that which a linear model leaves,
    # and their uncertainty if that is more. [1]
    change: float
    told_apart: bool  # Whether the points know this combination better than it was known before.

    @property
    def text(self) -> str:
        """What moves, in words: ``"f0 up (1.1 to 1.6) with oil share down (0.05 to 0.03)"``."""
        parts = [
            f"{key} {'up' if moved > start else 'down'} "
            f"({format_number(start, 3)} to {format_number(moved, 3)} {unit}".rstrip()
            + ")"
            for key, unit, start, moved in zip(
                self.keys, self.units, self.start, self.moved, strict=True
            )
        ]
        return " with ".join(parts)

    @property
    def warning(self) -> str:
        """What this means for the fit, in words."""
        effect = f"changes the losses by {format_number(self.change, 2)} of their scatter"
        if len(self.keys) == 1:
            return (
                f"these points depend too little on one input: {self.text} {effect}. Do not fit "
                "it, or add points at which it matters."
            )
        return (
            f"these points cannot separate some inputs: {self.text} {effect}. Fix all but one of "
            "them, or add points at which their effects differ."
        )


def reaches(case: Case, parameters: Sequence[Parameter]) -> FloatArray:
    """How far inputs may be off before a fit: one standard deviation over the value. [1]

    From [uncertainty] or what is assumed; 1 where nothing is.
    """
    kinds = tuple(item.key.removeprefix(MODEL_FORM) for item in parameters if item.factors)
    known = {value.key: _reach(value) for value in uncertain_values(case, kinds)[0]}
    return np.array([known.get(item.key, 1.0) for item in parameters])


def _reach(value: UncertainValue) -> float:
    if value.kind == "lognormal":
        return math.log(value.spread[0])
    return standard_uncertainty(value) / abs(value.value)


def combinations(
    parameters: Sequence[Parameter],
    deviations: FloatArray,  # At the start, over their uncertainty if `weighted`.
    derivatives: FloatArray,  # There, of the deviations over the scaled parameters.
    reach: FloatArray,  # See `reaches`.
    weighted: bool,
) -> tuple[Combination, ...]:
    """Directions in which the points see parameters least, first. Theory (X2), (X3)."""
    count = deviations.size
    outer, singular, directions = np.linalg.svd(derivatives * reach, full_matrices=False)
    left = deviations - outer @ (outer.T @ deviations)
    freedom = count - singular.size
    noise = float(np.linalg.norm(left)) / math.sqrt(freedom) if freedom else 0.0
    noise = max(noise, 1.0) if weighted else noise
    least = max(noise, SINGULAR * float(singular[0]))
    found = []
    for size, direction in zip(singular[::-1], directions[::-1], strict=True):
        order = np.argsort(-np.abs(direction))
        first = order[0]
        upward = direction * reach * np.sign(direction[first] * parameters[first].start)
        named = [
            (parameters[i], float(parameters[i].start * (1 + upward[i])))
            for i in order
            if abs(direction[i]) >= NAMED * abs(direction[first])
        ]
        found.append(
            Combination(
                keys=tuple(item.key for item, _ in named),
                units=tuple(item.unit for item, _ in named),
                start=tuple(item.start for item, _ in named),
                moved=tuple(min(max(it, item.low), item.high) for item, it in named),
                change=float(size) / max(noise, TINY) / math.sqrt(count),
                told_apart=bool(size > least),
            )
        )
    return tuple(found)
