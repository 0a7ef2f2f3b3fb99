"""The losses that the model gives at measured points, for any values of some keys."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.measurement.table import Measurements
from epicyclic.status import Status
from epicyclic.sweeps.journal import Row
from epicyclic.sweeps.plan import PointList
from epicyclic.sweeps.run import run_plan
from epicyclic.sweeps.work import Progress

__all__ = ["Computed", "MeasuredPoints"]

FloatArray = NDArray[np.float64]

_EXACT = {"numerics.pocket_interpolation": 0.0}
"""Flows through pockets are solved at every point: the derivatives of a fit would show the error of
tables."""


@dataclass(frozen=True, slots=True, eq=False)
class Computed:
    """Computed losses.

    Attributes
    ----------
    loss : ndarray, shape (n,)
        Of what was measured; NaN where the point failed. [W]
    messages, warnings : tuple of str
        Why a point failed, and what to know about it.
    """

    loss: FloatArray
    messages: tuple[str, ...]
    warnings: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class MeasuredPoints:
    """A case at the points of a table of measurements.

    Attributes
    ----------
    case : PlanetaryCase or GearPairCase
    measured : Measurements
    jobs : int or None
        Worker processes, as for `sweep`.
    progress : callable or None
        Called with the number of finished points and of all points.
    """

    case: Case
    measured: Measurements
    jobs: int | None = None
    progress: Progress | None = None

    def compute(self, *settings: Mapping[str, Any]) -> list[Computed]:
        """The losses for each of several `settings` of keys, all of them in one go."""
        changes = self.measured.changes
        points = tuple({**_EXACT, **change, **keys} for keys in settings for change in changes)
        rows = run_plan(PointList(self.case, points), jobs=self.jobs, progress=self.progress)
        count = len(changes)
        return [self._computed(rows[i : i + count]) for i in range(0, len(rows), count)]

    def _computed(self, rows: Sequence[Row]) -> Computed:
        losses = [
            _sum(row, names) for row, names in zip(rows, self.measured.component, strict=True)
        ]
        return Computed(
            np.array(losses),
            tuple(row.message for row in rows),
            tuple(row.warnings for row in rows),
        )


def _sum(row: Row, names: str) -> float:
    if row.status == Status.FAILED:
        return math.nan
    return sum(row.numbers[name.strip()] for name in names.split("+"))
