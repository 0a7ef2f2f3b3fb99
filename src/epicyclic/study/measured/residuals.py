"""The losses that the model gives at measured points, and their weighted deviations."""

from __future__ import annotations

import math
import os
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any, ClassVar, Self

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray, IntArray
from epicyclic.case.case import Case
from epicyclic.case.keys import Parameter
from epicyclic.case.tables.models import AS_TESTED, COMPUTED, LoadDependent
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import ConvergenceError, InputError
from epicyclic.losses.pocket_flow import NETWORK_MODELS
from epicyclic.losses.pocket_tables import FlowFamily, FlowTable, FlowTables
from epicyclic.study.measured.table import LOAD_DEPENDENT, Measurements, parts_of
from epicyclic.study.solve import pocket_flow_numbers
from epicyclic.study.sweeps.run import PointList, as_tested, flows_asked, with_unloaded
from epicyclic.study.sweeps.runner import HERE, Rows, Runner

# Flows through pockets for cases next to each other, read between flows at fixed numbers.
#
# A fit asks for hundreds of flows that hardly differ. Solved one by one they cost more than all
# other losses, and their own error of some 1e-3 hides how the loss depends on what is fitted. Read
# between numbers that do not depend on what was asked before they are a smooth function.

PER_OCTAVE = 16
"""Flows for each doubling of the number: between them the loss is found within 0.3 % to 0.6 % of
the pockets of an e-axle with voids."""


@dataclass(frozen=True, slots=True, eq=False)
class FlowLattice:
    """Scaled figures of flows by family and place, the number being 2^(place / PER_OCTAVE)."""

    _solved: dict[tuple[FlowFamily, int], FloatArray] = field(default_factory=dict)

    def tables(self, cases: Iterable[Case], threads: int | None = None) -> FlowTables:
        """Tables that hold the flows of some cases; those of models without similarity are not."""
        wanted: dict[FlowFamily, set[int]] = defaultdict(set)
        for case in cases:
            for family, number in pocket_flow_numbers(case):
                if family.model in NETWORK_MODELS:
                    below = math.floor(math.log2(number) * PER_OCTAVE)
                    wanted[family].update(range(below - 1, below + 3))
        self._solve([(family, i) for family, places in wanted.items() for i in places], threads)
        return {family: self._table(family, sorted(places)) for family, places in wanted.items()}

    def _solve(self, places: Sequence[tuple[FlowFamily, int]], threads: int | None) -> None:
        new = [place for place in places if place not in self._solved]
        for family in {family for family, _ in new}:
            _ = family.geometry  # once, before threads ask for it at the same time
        with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
            flows = pool.map(lambda place: place[0].scaled(_number(place[1])), new)
            self._solved.update(zip(new, flows, strict=True))

    def _table(self, family: FlowFamily, places: list[int]) -> FlowTable:
        scaled = np.array([self._solved[family, place] for place in places])
        sound = np.isfinite(scaled).all(axis=1)
        return FlowTable(
            number=np.array([_number(place) for place in places]),
            scaled=scaled,
            readable=(np.diff(places) == 1) & sound[:-1] & sound[1:],
            error=math.nan,
        )


def _number(place: int) -> float:
    return float(2.0 ** (place / PER_OCTAVE))


@dataclass(frozen=True, slots=True)
class NearbyPoints(PointList):
    """Single points whose flows through pockets are read from a lattice."""

    kind: ClassVar[str] = "nearby-points"
    lattice: FlowLattice = field(default_factory=FlowLattice, kw_only=True, repr=False)

    def prepared(self, indices: Sequence[int], jobs: int | None) -> Self:
        """With tables of the flows that the points `indices` read."""
        tables = self.lattice.tables(self._cases(indices), jobs)
        return replace(self, flow_tables=tables, lattice=FlowLattice())

    def _cases(self, indices: Sequence[int]) -> Iterable[Case]:
        for changes in flows_asked(self, indices).values():
            with suppress(InputError):  # the point reports it
                yield self.case.updated(changes)


_EXACT = {"numerics.pocket_interpolation": 0.0}
"""Flows through pockets are solved at every point: the derivatives of a fit would show the error of
tables."""


@dataclass(frozen=True, slots=True, eq=False)
class Computed:
    """Computed losses."""

    loss: FloatArray  # Computed loss where one was measured; NaN where the point failed. [W]
    messages: tuple[str, ...]  # Why a point failed.
    warnings: tuple[str, ...]  # What to know about it.


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

    def asked(self, *settings: Mapping[str, Any]) -> tuple[tuple[dict[str, Any], ...], IntArray]:
        """The keys that each point changes, and numbers of the points without torque, if asked."""
        changes = self.measured.changes
        points = tuple({**_EXACT, **change, **keys} for keys in settings for change in changes)
        if self.load_dependent == AS_TESTED:
            return with_unloaded(points)
        return points, np.arange(len(points))

    def losses(self, rows: Rows, unloaded: IntArray) -> list[Computed]:
        """The losses for each of the settings, of the rows of all points that were `asked` for."""
        parts = [parts_of(names) for names in self.measured.component]
        columns = {name: rows.numbers(name) for own in parts for name in own}
        if LOAD_DEPENDENT in columns and self.load_dependent == AS_TESTED:
            columns[LOAD_DEPENDENT] = as_tested(rows, unloaded)
        found = []
        for first in range(0, unloaded.size, len(parts)):
            losses = [
                sum(float(columns[name][point]) for name in own)
                for point, own in enumerate(parts, first)
            ]
            messages = (
                rows.message[point] or rows.message[unloaded[point]] * math.isnan(loss)
                for point, loss in enumerate(losses, first)
            )
            warnings = tuple(rows.warnings[first : first + len(parts)])
            found.append(Computed(np.array(losses), tuple(messages), warnings))
        return found


STEP = 1e-2
"""Step of the differences that give the derivatives, over the start value: flows through pockets
are found to 1e-3 of their power, which smaller steps would show. [1]"""


@dataclass(slots=True)
class Residuals:
    """Deviations over weights at the points of calibration, and their derivatives. Theory (X1)."""

    points: MeasuredPoints
    # Their values are given as ratios to the start values, "scaled".
    parameters: Sequence[Parameter]
    used: BoolArray  # Points of the table that the fit sees.
    # Scatter of the points, in place of that of the table; `known` in W, else over its mean.
    scatter: FloatArray | None = None
    known: bool = True
    _known: dict[tuple[float, ...], FloatArray] = field(default_factory=dict)
    _offset: FloatArray | float = 0.0

    def correct(self, exact: Residuals, scaled: FloatArray) -> None:
        """From now on, agree with others at one place."""
        self._offset = 0.0
        offset = exact(scaled) - self(scaled)
        if np.isfinite(offset).all():
            self._offset = offset

    @property
    def evaluations(self) -> int:
        """Computed points."""
        return len(self._known) * len(self.points.measured)

    @property
    def uncertainty(self) -> FloatArray | None:
        """Uncertainty of the losses at the points used; None if they have none. [W]"""
        if self.scatter is not None:
            return self.scatter if self.known else None
        whole = self.points.measured.uncertainty
        return None if whole is None else whole[self.used]

    @property
    def weight(self) -> FloatArray | float:
        """What deviations are multiplied by. [1/W], or 1"""
        scatter = self.uncertainty if self.scatter is None else self.scatter
        return 1.0 if scatter is None else 1 / scatter

    def losses(self, scaled: FloatArray) -> FloatArray:
        """Computed losses of the points used. [W]"""
        measured: FloatArray = self.points.measured.loss[self.used]
        return self(scaled) / self.weight + measured

    @property
    def bounds(self) -> FloatArray:
        """Bounds of the scaled parameters, shape (p, 2). [1]"""
        return np.array([item.ends for item in self.parameters])

    def settings(self, scaled: FloatArray) -> dict[str, Any]:
        """The values of the keys as a case file has them."""
        found: dict[str, Any] = {}
        for item, z in zip(self.parameters, scaled, strict=True):
            found |= item.settings(float(z))
        return found

    def __call__(self, scaled: FloatArray) -> FloatArray:
        return self.at([scaled])[0]

    def derivatives(self, scaled: FloatArray, *, central: bool = False) -> FloatArray:
        """d(residual)/d(scaled parameter), all from one batch of points, shape (n, p).

        By differences to one side, or to both, `central`, where bounds leave room for them.
        """
        low, high = self.bounds.T
        ahead = np.where(scaled + STEP > high, -STEP, STEP)
        both = central & (ahead > 0) & (scaled - STEP >= low)
        behind = np.where(both, -STEP, 0.0)
        steps = np.concatenate([np.diag(ahead), np.diag(behind)])
        moved = np.array(self.at([scaled + step for step in steps]))
        span = (ahead - behind)[:, None]
        table: FloatArray = (moved[: scaled.size] - moved[scaled.size :]) / span
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
        measured = self.points.measured.loss[self.used]
        settings = [self.settings(np.array(one)) for one in new]
        for one, computed in zip(new, self.points.compute(*settings) if new else [], strict=True):
            self._known[one] = computed.loss[self.used] - measured
        return [self._known[one] * self.weight + self._offset for one in sets]
