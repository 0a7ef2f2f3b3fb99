"""The losses that the model gives at measured points, for any values of some keys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.measurement.table import Measurements
from epicyclic.sweeps.journal import Rows
from epicyclic.sweeps.plan import PointList
from epicyclic.sweeps.runner import HERE, Runner

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
    runner : Runner
        With a folder as its journal; its progress starts again with every round.
    """

    case: Case
    measured: Measurements
    runner: Runner = HERE

    def compute(self, *settings: Mapping[str, Any]) -> list[Computed]:
        """The losses for each of several `settings` of keys, all of them in one go."""
        changes = self.measured.changes
        points = tuple({**_EXACT, **change, **keys} for keys in settings for change in changes)
        plan = PointList(self.case, points)
        rows = self.runner.within(plan).run(plan)
        count = len(changes)
        return [self._computed(rows, i) for i in range(0, len(rows), count)]

    def _computed(self, rows: Rows, first: int) -> Computed:
        """The points of one of the settings, from number `first` on."""
        component = self.measured.component
        losses = [
            sum(float(rows.numbers(name.strip())[point]) for name in names.split("+"))
            for point, names in enumerate(component, first)
        ]
        own = slice(first, first + len(component))
        return Computed(np.array(losses), tuple(rows.message[own]), tuple(rows.warnings[own]))
