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
from epicyclic.measurement.residuals import Residuals

__all__ = ["PROFILED", "profile_ends"]

FloatArray = NDArray[np.float64]

PROFILED = 3
"""Parameters up to which profiles are made."""
MOST_PLACES, MOST_ROUNDS = 12, 5
"""Places tried for one end, and fits of the other parameters at each."""
CLOSE = 0.02
"""Root of the growth of the sum of squares over that wanted, less 1, that is met. [1]"""
GAIN = 1e-2
"""Gain over the growth wanted below which the others are not fitted any further. [1]"""
FARTHER = 3.0
"""Largest factor between places while the end is not passed, and largest step of the other
parameters over half their intervals. [1]"""

Walk = Generator[FloatArray, FloatArray, float]


def profile_ends(residuals: Residuals, found: Linearised) -> FloatArray:
    """Both ends of the interval of every parameter, from its profile. Theory (X6).

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
    """The neighbourhood of a solution.

    Attributes
    ----------
    found : Linearised
    deviations : ndarray, shape (n,)
        At the solution.
    bounds : ndarray, shape (p, 2)
    growth : float
        Of the sum of squares at the ends.
    """

    found: Linearised
    deviations: FloatArray
    bounds: FloatArray
    growth: float

    def walk(self, parameter: int, side: int) -> Walk:
        """Where the sum of squares has grown enough on one side of a parameter."""
        start = self.found.solution[parameter]
        room = abs(float(self.bounds[parameter, side] - start))
        if room == 0:
            return float(start)
        sign = 2.0 * side - 1.0
        inner, outer = (0.0, -1.0), (math.inf, math.nan)
        distance = self._guess(parameter, sign)
        for _ in range(MOST_PLACES):
            distance = min(distance, room)
            squares = yield from self._lowest(parameter, sign * distance)
            grown = (squares - float(self.deviations @ self.deviations)) / self.growth
            excess = math.sqrt(max(grown, 0.0)) - 1
            if math.isnan(excess):
                return math.nan
            if abs(excess) <= CLOSE or (excess < 0 and distance == room):
                return float(start + sign * distance)
            if excess < 0:
                inner = (distance, excess)
            else:
                outer = (distance, excess)
            distance = _between(inner, outer)
        return math.nan

    def _others(self, parameter: int) -> NDArray[np.intp]:
        """Free parameters beside one."""
        free = self.found.free
        others: NDArray[np.intp] = free[free != parameter]
        return others

    def _guess(self, parameter: int, sign: float) -> float:
        """Distance of the end if the model were linear."""
        column = self.found.derivatives[:, parameter]
        others = self.found.derivatives[:, self._others(parameter)]
        alone = column - others @ np.linalg.lstsq(others, column)[0]
        curvature = float(alone @ alone)
        slope = max(0.0, sign * float(column @ self.deviations))  # not 0 at a bound
        return float((math.sqrt(slope**2 + curvature * self.growth) - slope) / curvature)

    def _lowest(self, parameter: int, offset: float) -> Walk:
        """Sum of squares with one parameter held at an offset, the others fitted.

        By Gauss and Newton with the derivatives of the solution, kept up to date after Broyden.
        """
        others = self._others(parameter)
        derivatives = self.found.derivatives.copy()
        here = self.found.solution.copy()
        here[parameter] += offset
        here[others] += self._step(derivatives, others, derivatives[:, parameter] * offset)
        here = np.clip(here, self.bounds[:, 0], self.bounds[:, 1])
        deviations = yield here
        for _ in range(MOST_ROUNDS if others.size else 0):
            if not np.isfinite(deviations).all():
                break
            there = here.copy()
            there[others] += self._step(derivatives, others, deviations)
            there = np.clip(there, self.bounds[:, 0], self.bounds[:, 1])
            step = there - here
            if float(np.sum((derivatives @ step) ** 2)) <= GAIN * self.growth:
                break
            changed = yield there
            if not np.isfinite(changed).all():
                break
            derivatives += np.outer(changed - deviations - derivatives @ step, step) / (step @ step)
            if changed @ changed < deviations @ deviations:
                here, deviations = there, changed
        return float(deviations @ deviations)

    def _step(
        self, derivatives: FloatArray, others: NDArray[np.intp], deviations: FloatArray
    ) -> FloatArray:
        """Of the other parameters, to where deviations are least; not much past their intervals."""
        variance = np.diag(self.found.covariance)[np.searchsorted(self.found.free, others)]
        most = FARTHER * np.sqrt(self.growth * variance)
        step = -np.linalg.lstsq(derivatives[:, others], deviations)[0]
        limited: FloatArray = np.clip(step, -most, most)
        return limited


def _between(inner: tuple[float, float], outer: tuple[float, float]) -> float:
    """The next place: by a straight line, kept off the ends of what is left."""
    (near, below), (far, above) = inner, outer
    if math.isinf(far):
        return near * (FARTHER if below <= 1 / FARTHER - 1 else 1 / (1 + below))
    part = -below / (above - below)
    return near + (far - near) * min(max(part, 0.1), 0.9)
