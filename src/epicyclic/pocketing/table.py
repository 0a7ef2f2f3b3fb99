"""Tables of flows through pockets over the one number that they depend on.

A table is made for the numbers that are asked of it. It starts from few of them and adds the one
nearest to the middle of every interval until the flow there was foretold by the others well enough;
where that does not come to pass, all numbers asked for are solved.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.similarity import FlowFamily, FlowFigures, from_scaled

Floats = NDArray[np.float64]

WIDEST = math.log(2.0)
"""Largest distance of the first nodes, where the numbers asked for lie closer: an octave."""
SAME = 1e-9
"""Numbers that differ less, relatively, are one. [1]"""
KEPT_MOST = 10_000
"""Flows remembered for the next tables."""

_kept: dict[tuple[FlowFamily, float], Floats] = {}


@dataclass(frozen=True, slots=True, eq=False)
class FlowTable:
    """Scaled figures of a family of flows over its number."""

    number: Floats  # Rising. [1/m]
    scaled: Floats  # As from `scaled_figures`; NaN where the flow does not repeat.
    readable: NDArray[np.bool_]  # Whether the table may be read between two of its numbers.
    # Largest error of the power in what is readable, each measured at a number before that was
    # added to the table. [1]
    error: float
    file: str = ""  # Name of the file that it was read from; empty if from none.

    def figures(self, speed: float, mixture: MixtureState, pressure: float) -> FlowFigures | None:
        """Figures of a flow; None where the table has none. Parameters as for `pocket_flow`."""
        number = FlowFamily.number(speed, mixture, pressure)
        scaled = self._at(number)
        if scaled is None or not np.isfinite(scaled).all():
            return None
        figures = from_scaled(scaled, speed, mixture.density, self.number.size, self.error)
        return replace(figures, file=self.file)

    def _at(self, number: float) -> Floats | None:
        nearest = int(np.abs(self.number - number).argmin())
        if abs(self.number[nearest] / number - 1) <= SAME:
            node: Floats = self.scaled[nearest]
            return node
        interval = int(np.searchsorted(self.number, number)) - 1
        if not (0 <= interval < self.readable.size and self.readable[interval]):
            return None
        return interpolate(np.log(self.number), self.scaled, math.log(number))


FlowTables = Mapping[FlowFamily, FlowTable]


def table_around(number: float, scaled: Floats, reach: float) -> FlowTable:
    """One flow for all numbers that differ from its own by `reach` at most, relatively.

    The error is not known: scaled figures change about as much as their number.
    """
    numbers = number * np.array([1 - reach, 1.0, 1 + reach])
    return FlowTable(numbers, np.tile(scaled, (3, 1)), np.ones(2, dtype=np.bool_), math.nan)


def interpolate(place: Floats, values: Floats, at: float) -> Floats:
    """Cubic through the two nearest points on either side; at the ends the nearest four."""
    first = int(np.searchsorted(place, at)) - 2
    first = max(0, min(first, place.size - 4))
    near = place[first : first + 4]
    weights = np.ones(near.size)
    for i in range(near.size):
        others = np.delete(near, i)
        weights[i] = np.prod((at - others) / (near[i] - others))
    result: Floats = weights @ values[first : first + 4]
    return result


def make_tables(
    asked: Mapping[FlowFamily, Iterable[float]],  # [1/m]
    bound: float,  # Largest error of the power between the numbers of a table. [1]
    threads: int | None = None,  # Flows solved at once; default: one on each core.
) -> dict[FlowFamily, FlowTable]:
    """Tables for the numbers asked of each family."""
    growing = {family: _Growing(numbers, bound) for family, numbers in asked.items()}
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        while True:
            wanted = [(family, number) for family in growing for number in growing[family].wanted()]
            if not wanted:
                return {family: table.finished() for family, table in growing.items()}
            for family in {family for family, _ in wanted}:
                _ = family.geometry  # once, before threads ask for it at the same time
            solved = list(pool.map(_scaled, wanted))
            for family, table in growing.items():
                table.take(
                    {
                        n: flow
                        for (one, n), flow in zip(wanted, solved, strict=True)
                        if one == family
                    }
                )


def _scaled(place: tuple[FlowFamily, float]) -> Floats:
    if place not in _kept:
        family, number = place
        scaled = family.scaled(number)
        if len(_kept) >= KEPT_MOST:
            _kept.clear()
        _kept[place] = scaled
        return scaled
    return _kept[place]


class _Growing:
    """A table while it grows. Numbers asked for are known by their places in rising order."""

    def __init__(self, numbers: Iterable[float], bound: float) -> None:
        rising = sorted(numbers)
        distinct = [rising[0]]
        for number in rising:
            if number > distinct[-1] * (1 + SAME):
                distinct.append(number)
        self._number = np.array(distinct)
        self._place = np.log(self._number)
        self._bound = bound
        self._solved: dict[int, Floats] = {}
        self._open: list[tuple[int, int]] = []
        self._readable: set[tuple[int, int]] = set()
        self._error = 0.0

    def wanted(self) -> list[float]:
        """Numbers at which the flow is needed next; none when the table is finished."""
        if not self._solved:
            return [float(self._number[i]) for i in self._first()]
        return [float(self._number[self._middle(gap)]) for gap in self._open]

    def take(self, flows: Mapping[float, Floats]) -> None:
        """Scaled figures at the numbers that were wanted."""
        places = {
            int(np.searchsorted(self._number, number)): flow for number, flow in flows.items()
        }
        if not self._solved:
            self._open = _gaps(sorted(places))
        else:
            known = sorted(self._solved)
            scaled = np.array([self._solved[i] for i in known])
            checked, self._open = self._open, []
            for gap in checked:
                middle = self._middle(gap)
                told = interpolate(self._place[known], scaled, float(self._place[middle]))
                error = abs(float(told[0] / places[middle][0]) - 1)
                halves = ((gap[0], middle), (middle, gap[1]))
                if error <= self._bound:
                    self._error = max(self._error, error)
                    self._readable.update(halves)
                else:
                    self._open += halves
        self._solved |= places
        self._open = [gap for gap in self._open if gap[1] - gap[0] > 1]

    def finished(self) -> FlowTable:
        """The table."""
        known = sorted(self._solved)
        return FlowTable(
            number=self._number[known],
            scaled=np.array([self._solved[i] for i in known]),
            readable=np.array([gap in self._readable for gap in _gaps(known)], dtype=np.bool_),
            error=self._error,
        )

    def _first(self) -> list[int]:
        """Both ends, and numbers in between no more than an octave apart where there are such."""
        span = float(self._place[-1] - self._place[0])
        parts = max(1, math.ceil(span / WIDEST))
        aims = np.linspace(self._place[0], self._place[-1], parts + 1)
        return sorted({int(np.abs(self._place - aim).argmin()) for aim in aims})

    def _middle(self, gap: tuple[int, int]) -> int:
        """The place inside a gap that is nearest to its middle."""
        low, high = gap
        inside = self._place[low + 1 : high]
        middle = (self._place[low] + self._place[high]) / 2
        return low + 1 + int(np.abs(inside - middle).argmin())


def _gaps(places: list[int]) -> list[tuple[int, int]]:
    return list(pairwise(places))
