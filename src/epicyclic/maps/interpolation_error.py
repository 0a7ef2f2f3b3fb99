"""How far the energy lost over a duty cycle is off, because a map is interpolated.

A sample of the points is solved directly. They are drawn with a probability that grows with the
energy that they lose, in one pass over points of unknown number: a point of energy w gets the key
E/w, E from the exponential distribution, and the smallest keys stay (Efraimidis and Spirakis,
Information Processing Letters 97 (2006) 181). With tau the smallest key left out, such a point had
the probability p = 1 - exp(-w tau) to stay, and the sum of x/p over the sample estimates the sum of
x over all points, with the variance (1 - p) x^2/p^2 of each, uncorrelated (Cohen and Kaplan,
PODC 2007, 225). A cycle of no more points than the sample is summed exactly.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.case.operating import AXES, OPERATING, STATE, STATE_KEY
from epicyclic.maps.lookup import Lookup
from epicyclic.sweeps.plan import PointList
from epicyclic.sweeps.runner import HERE, Runner

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]
_SEED = 0
"""The same cycle and map give the same sample."""


@dataclass(frozen=True, slots=True)
class Deviation:
    """What interpolation adds to the energy lost."""

    energy: float  # Estimate of the energy by interpolation less that by direct solution. [J]
    standard_error: float  # Standard error of the estimate, because only a sample is solved. [J]
    # Largest deviation of the loss of one point of the sample, relative to its direct solution.
    largest: float
    method: str  # How it was found.


class Sample:
    """A sample of the points of a cycle."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._random = np.random.default_rng(_SEED)
        self._keys = np.empty(0)
        self._rows = np.empty((0, 0))

    def add(self, point: Sequence[Array], power: Array, energy: Array) -> None:
        """Offer points as the axes of the map, in their units; W and J."""
        losing = energy > 0
        rows = np.stack([*point, power, energy], axis=1)[losing]
        keys = self._random.exponential(size=len(rows)) / rows[:, -1]
        self._keys = np.append(self._keys, keys)
        self._rows = np.concatenate([self._rows, rows]) if self._rows.size else rows
        stay = np.argsort(self._keys)[: self._size + 1]
        self._keys, self._rows = self._keys[stay], self._rows[stay]

    def drawn(self) -> tuple[Array, Array]:
        """Rows of the values of the axes, power, energy; and the probability of each."""
        rows = self._rows[: self._size]
        threshold = self._keys[self._size] if self._keys.size > self._size else math.inf
        return rows, -np.expm1(-rows[:, -1] * threshold)


def further_values(data: xr.Dataset) -> dict[str, Any]:
    """The keys of the axes of a map beyond its own, which have one value each, and these."""
    return {
        str(values.attrs["case_key"]): written_values(values)[0]
        for name, values in data.coords.items()
        if "case_key" in values.attrs and name not in (*AXES, STATE)
    }


def written_values(axis: xr.DataArray) -> list[Any]:
    """The values of an axis as a case has them."""
    unit = axis.attrs.get("units", "1")
    return [
        number if isinstance(number, str) or unit == "1" else f"{number!r} {unit}"
        for number in axis.values.ravel().tolist()
    ]


def solve_sample(case: Case, lookup: Lookup, sample: Sample, runner: Runner = HERE) -> Deviation:
    """The deviation by direct solution of the points of `sample`."""
    rows, chance = sample.drawn()
    points = tuple(changes_at(lookup, row) for row in rows.tolist())
    exact = case.updated({"numerics.pocket_interpolation": 0})
    plan = PointList(exact, points)
    direct = runner.within(plan).run(plan).numbers("total")
    found = np.isfinite(direct)
    method = f"{found.sum()} points of the cycle solved directly"
    if not found.all():
        method += f", {(~found).sum()} more without a solution"
    if not found.any():
        return Deviation(math.nan, math.nan, math.nan, method)
    power, energy = rows[found, -2], rows[found, -1]
    direct, chance = direct[found], chance[found]
    difference = energy * (power - direct) / power / chance
    return Deviation(
        float(difference.sum()),
        float(np.sqrt(np.sum((1 - chance) * difference**2))),
        float(np.abs(power / direct - 1).max()),
        method,
    )


def changes_at(lookup: Lookup, row: Sequence[float]) -> dict[str, str]:
    """The keys that make a case of a point of a cycle."""
    point = dict(zip(lookup.names, row, strict=False))
    changes = {
        part.key: part.text(point[name]) for name, part in OPERATING.items() if name in point
    }
    if STATE in point:
        changes[STATE_KEY] = lookup.states[round(point[STATE]) - 1]
    return changes


def leave_out(lookup: Lookup, node_work: Array) -> Deviation:
    """The deviation of a map of every second node from the whole one: more than that of the latter.

    `node_work` is the angle turned through at each node. [rad]
    """
    thinned = lookup.thinned()
    difference = float(node_work @ (thinned.total - lookup.total))
    used = node_work > 0
    relative = np.abs(thinned.total - lookup.total)[used] / lookup.total[used]
    method = "map with every second node left out against the whole map; an upper estimate"
    return Deviation(difference, math.nan, float(relative.max(initial=0.0)), method)
