"""Flows through pockets for cases next to each other, read between flows at fixed numbers.

A fit asks for hundreds of flows that hardly differ. Solved one by one they cost more than all other
losses, and their own error of some 1e-3 hides how the loss depends on what is fitted. Read between
numbers that do not depend on what was asked before they are a smooth function.
"""

from __future__ import annotations

import math
import os
from collections import defaultdict
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.solve import pocket_flow_numbers
from epicyclic.errors import InputError
from epicyclic.pocketing.fluid import NETWORK_MODELS
from epicyclic.pocketing.similarity import FlowFamily
from epicyclic.pocketing.table import FlowTable, FlowTables
from epicyclic.sweeps.plan import PointList

if TYPE_CHECKING:
    from epicyclic.case.case import Case

Floats = NDArray[np.float64]

PER_OCTAVE = 16
"""Flows for each doubling of the number: between them the loss is found within 0.3 % to 0.6 % of
the pockets of an e-axle with voids."""


@dataclass(frozen=True, slots=True, eq=False)
class FlowLattice:
    """Scaled figures of flows by family and place, the number being 2^(place / PER_OCTAVE)."""

    _solved: dict[tuple[FlowFamily, int], Floats] = field(default_factory=dict)

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
        tables = self.lattice.tables(self._cases(indices), jobs if jobs and jobs > 0 else None)
        return replace(self, flow_tables=tables, lattice=FlowLattice())

    def _cases(self, indices: Sequence[int]) -> Iterable[Case]:
        for index in indices:
            try:
                yield self.case.updated(self.changes(index))
            except InputError:
                continue  # the point reports it
