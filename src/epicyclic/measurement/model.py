"""The losses that the model gives at measured points, for any values of some keys."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.measurement.table import LOAD_DEPENDENT, Measurements, parts_of
from epicyclic.sweeps.flow_lattice import FlowLattice, NearbyPoints
from epicyclic.sweeps.journal import Rows
from epicyclic.sweeps.plan import PointList
from epicyclic.sweeps.runner import HERE, Runner
from epicyclic.sweeps.unloaded import AS_TESTED, COMPUTED, LoadDependent, as_tested, with_unloaded

FloatArray = NDArray[np.float64]

_EXACT = {"numerics.pocket_interpolation": 0.0}
"""Flows through pockets are solved at every point: the derivatives of a fit would show the error of
tables."""


@dataclass(frozen=True, slots=True, eq=False)
class Computed:
    """Computed losses."""

    loss: FloatArray  # Computed loss where one was measured; NaN where the point failed. [W]
    messages: tuple[str, ...]  # Why a point failed, and what to know about it.
    warnings: tuple[str, ...]  # Why a point failed, and what to know about it.


@dataclass(frozen=True, slots=True)
class MeasuredPoints:
    """A case at the points of a table of measurements."""

    case: Case
    measured: Measurements
    # With a folder as its journal; its progress starts again with every round.
    runner: Runner = HERE
    load_dependent: LoadDependent = COMPUTED  # What load-dependent losses are.
    # Flows through pockets are read from it. Default: each is solved.
    lattice: FlowLattice | None = None

    def shared(self) -> MeasuredPoints:
        """The same points for many values of keys next to each other, as a fit asks for them."""
        return replace(self, lattice=FlowLattice())

    def compute(self, *settings: Mapping[str, Any]) -> list[Computed]:
        """The losses for each of several `settings` of keys, all of them in one go."""
        points, unloaded = self.asked(*settings)
        plan = (
            PointList(self.case, points)
            if self.lattice is None
            else NearbyPoints(self.case, points, lattice=self.lattice)
        )
        return self.losses(self.runner.within(plan).run(plan), unloaded)

    def asked(
        self, *settings: Mapping[str, Any]
    ) -> tuple[tuple[dict[str, Any], ...], NDArray[np.intp]]:
        """The keys that each point changes, and numbers of the points without torque, if asked."""
        changes = self.measured.changes
        points = tuple({**_EXACT, **change, **keys} for keys in settings for change in changes)
        if self.load_dependent == AS_TESTED:
            return with_unloaded(points)
        return points, np.arange(len(points))

    def losses(self, rows: Rows, unloaded: NDArray[np.intp]) -> list[Computed]:
        """The losses for each of the settings, of the rows of all points that were `asked` for."""
        count = len(self.measured)
        return [self._computed(rows, unloaded, i) for i in range(0, unloaded.size, count)]

    def _computed(self, rows: Rows, unloaded: NDArray[np.intp], first: int) -> Computed:
        """The points of one of the settings, from number `first` on."""
        component = self.measured.component
        own = slice(first, first + len(component))
        losses = np.array(
            [
                sum(float(self._loss(rows, unloaded, name)[point]) for name in parts_of(names))
                for point, names in enumerate(component, first)
            ]
        )
        messages = (
            rows.message[point] or rows.message[unloaded[point]] * math.isnan(loss)
            for point, loss in enumerate(losses, first)
        )
        return Computed(losses, tuple(messages), tuple(rows.warnings[own]))

    def _loss(self, rows: Rows, unloaded: NDArray[np.intp], name: str) -> FloatArray:
        """A loss of all points."""
        if name == LOAD_DEPENDENT and self.load_dependent == AS_TESTED:
            return as_tested(rows, unloaded)
        return rows.numbers(name)
