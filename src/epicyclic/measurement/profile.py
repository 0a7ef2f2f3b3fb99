"""Intervals from the profile of the likelihood: one parameter held, the others fitted again.

The sum of squares along that valley says how far a parameter may be off, also where the losses are
not linear in it or where it ended at a bound.
"""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.measurement.intervals import Linearised
from epicyclic.measurement.residuals import STEP, Residuals

FloatArray = NDArray[np.float64]

PROFILED = 3
"""Parameters up to which profiles are made."""
MOST_PLACES, MOST_ROUNDS = 12, 8
"""Places tried for one end, and fits of the other parameters at each."""
CLOSE = 0.02
"""Root of the growth of the sum of squares over that wanted, less 1, that is met. [1]"""
GAIN = 1e-2
"""Gain over the growth wanted below which the others are not fitted any further. [1]"""
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

    Returns
    -------
    ndarray, shape (p, 2)
        Scaled; NaN where there is none.
    """
    ends = np.full((found.solution.size, 2), np.nan)
    growth = (found.quantile * found.spread) ** 2
    if not (found.is_separable and growth > 0):
        return ends
    valley = _Valley(found, residuals(found.solution), residuals.bounds, growth)
    walks = {
        (parameter, side): valley.walk(parameter, side)
        for parameter in range(found.solution.size)
        for side in (0, 1)
        if not found.is_idle[parameter]
    }
    asked: dict[tuple[int, int], FloatArray] = {}
    for place, walk in walks.items():
        _ask(asked, ends, place, walk)
    while asked:  # all walks side by side: their points are computed in one go
        places = list(asked)
        for place, deviations in zip(places, residuals.at(list(asked.values())), strict=True):
            _ask(asked, ends, place, walks[place], deviations)
    return ends


def _ask(
    asked: dict[tuple[int, int], FloatArray],
    ends: FloatArray,
    place: tuple[int, int],
    walk: Walk,
    deviations: FloatArray | None = None,
) -> None:
    """The next parameters that a walk asks for, or the end that it came to."""
    try:
        asked[place] = next(walk) if deviations is None else walk.send(deviations)
    except StopIteration as done:
        asked.pop(place, None)
        ends[place] = done.value


@dataclass(frozen=True, slots=True, eq=False)
class _Valley:
    """The neighbourhood of a solution."""

    found: Linearised
    deviations: FloatArray  # At the solution.
    bounds: FloatArray
    growth: float  # Growth of the sum of squares at the ends.

    def walk(self, parameter: int, side: int) -> Walk:
        """Where the sum of squares has grown enough on one side of a parameter."""
        solution = self.found.solution
        room = abs(float(self.bounds[parameter, side] - solution[parameter]))
        sign = 2.0 * side - 1.0
        if room == 0:
            return float(solution[parameter])
        valley = _Way(
            self, parameter, self.found.derivatives.copy(), np.eye(solution.size)[parameter]
        )
        inner, outer = (0.0, -1.0), (math.inf, math.nan)
        distance = self._guess(parameter, sign)
        if math.isnan(distance):
            return math.nan
        for _ in range(MOST_PLACES):
            distance = min(distance, room)
            squares = yield from valley.lowest(sign * distance)
            grown = (squares - float(self.deviations @ self.deviations)) / self.growth
            excess = math.sqrt(max(grown, 0.0)) - 1
            if math.isnan(excess):
                return math.nan
            if abs(excess) <= CLOSE or (excess < 0 and distance == room):
                return float(solution[parameter] + sign * distance)
            if excess < 0:
                inner = (distance, excess)
            else:
                outer = (distance, excess)
            distance = _between(inner, outer)
        return math.nan

    def others(self, parameter: int) -> NDArray[np.intp]:
        """Free parameters beside one."""
        free = self.found.free
        others: NDArray[np.intp] = free[free != parameter]
        return others

    def _guess(self, parameter: int, sign: float) -> float:
        """Distance of the end if the model were linear; NaN without influence."""
        column = self.found.derivatives[:, parameter]
        others = self.found.derivatives[:, self.others(parameter)]
        alone = column - others @ np.linalg.lstsq(others, column)[0]
        curvature = float(alone @ alone)
        slope = max(0.0, sign * float(column @ self.deviations))  # not 0 at a bound
        if curvature == 0:
            return math.nan
        return float((math.sqrt(slope**2 + curvature * self.growth) - slope) / curvature)


@dataclass(slots=True, eq=False)
class _Way:
    """The bottom of a valley on one side of a parameter."""

    valley: _Valley
    parameter: int  # The one that is held.
    # Derivatives of the deviations; of the solution at first, then kept up to date after Broyden.
    derivatives: FloatArray
    # From the solution to the bottom at the last place, for each unit of the parameter.
    direction: FloatArray

    def lowest(self, offset: float) -> Walk:
        """Least sum of squares with the parameter held at an offset, after Gauss and Newton."""
        solution, others = self.valley.found.solution, self.valley.others(self.parameter)
        here = solution + offset * self.direction
        if self.direction[others].any():  # from where the last place led to
            here = np.clip(here, self.valley.bounds[:, 0], self.valley.bounds[:, 1])
        else:
            here = self._moved(here, self.valley.deviations + self.derivatives @ (here - solution))
        deviations = yield here
        linear = self.valley.deviations + self.valley.found.derivatives @ (here - solution)
        if float(np.sum((deviations - linear) ** 2)) > CURVED * self.valley.growth:
            yield from self._derive(here, deviations)
        for _ in range(MOST_ROUNDS if others.size else 0):
            if not np.isfinite(deviations).all():
                break
            there = self._moved(here, deviations)
            step = there - here
            expected = self.derivatives @ step
            if float(expected @ expected) <= GAIN * self.valley.growth:
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
        for other in self.valley.others(self.parameter):
            high = self.valley.bounds[other, 1]
            moved = here.copy()
            moved[other] += STEP if here[other] + STEP <= high else -STEP
            changed = yield moved
            if np.isfinite(changed).all():
                self.derivatives[:, other] = (changed - deviations) / (moved[other] - here[other])

    def _moved(self, here: FloatArray, deviations: FloatArray) -> FloatArray:
        """The other parameters where a linear model puts the least squares.

        At most as far from `here` as `FARTHER` times half their intervals, and within the bounds.
        """
        found, others = self.valley.found, self.valley.others(self.parameter)
        variance = np.diag(found.covariance)[np.searchsorted(found.free, others)]
        most = FARTHER * np.sqrt(self.valley.growth * variance)
        step = -np.linalg.lstsq(self.derivatives[:, others], deviations)[0]
        there = here.copy()
        there[others] += np.clip(step, -most, most)
        return np.clip(there, self.valley.bounds[:, 0], self.valley.bounds[:, 1])


def _between(inner: tuple[float, float], outer: tuple[float, float]) -> float:
    """The next place: by a straight line, kept off the ends of what is left."""
    (near, below), (far, above) = inner, outer
    if math.isinf(far):
        return near * (FARTHER if below <= 1 / FARTHER - 1 else 1 / (1 + below))
    part = -below / (above - below)
    return near + (far - near) * min(max(part, 0.1), 0.9)
