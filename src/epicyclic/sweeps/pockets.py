"""Tables of the flows through pockets that the points of a sweep have in common."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import Any

import numpy as np

from epicyclic.analysis.solve import pocket_flow_numbers
from epicyclic.errors import InputError
from epicyclic.pocketing.similarity import FlowFamily
from epicyclic.pocketing.table import FlowTables, make_tables
from epicyclic.sweeps.plan import Plan

__all__ = ["flow_tables"]

_LIKE_SPEED = (
    "operation.speed",
    "operation.second_speed",
    "operation.oil_inlet_temperature",
    "surroundings.pressure",
)
"""Keys that change the number of a flow, but not its family."""
_FEWEST = 8
"""Values of these keys for which a table is made: few flows are solved as soon."""
_TORQUE = "operation.torque"
"""Only its sign matters to the pockets."""


def flow_tables(plan: Plan, jobs: int | None = None) -> FlowTables:
    """Tables for all points of `plan`, whichever of them are done; none where that does not pay."""
    bound = plan.case.numerics.pocket_interpolation
    alike = [len(axis.values) for axis in plan.axes if axis.key in _LIKE_SPEED]
    if bound == 0 or np.prod(alike, dtype=int) < _FEWEST:
        return {}
    asked: dict[FlowFamily, set[float]] = defaultdict(set)
    for changes in _samples(plan):
        try:
            for family, number in pocket_flow_numbers(plan.case.updated(changes)):
                asked[family].add(number)
        except InputError:
            continue  # the point reports it
    many = {family: numbers for family, numbers in asked.items() if len(numbers) >= _FEWEST}
    return make_tables(many, bound, jobs)


def _samples(plan: Plan) -> Iterator[dict[str, Any]]:
    """Changes of one point for each set of points that differ in the magnitude of torque only."""
    seen = set()
    for index in range(plan.size):
        place = np.unravel_index(index, plan.shape)
        kind = tuple(
            np.sign(axis.coordinate[i]) if axis.key == _TORQUE else i
            for axis, i in zip(plan.axes, place, strict=True)
        )
        if kind not in seen:
            seen.add(kind)
            yield plan.changes(index)
