"""Tables of the flows through pockets that the points of a sweep have in common."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

from epicyclic.analysis.solve import pocket_flow_numbers
from epicyclic.errors import InputError
from epicyclic.pocketing.similarity import FlowFamily
from epicyclic.pocketing.table import FlowTables, make_tables
from epicyclic.sweeps.plan import Points

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


def flow_tables(points: Points, jobs: int | None = None) -> FlowTables:
    """Tables for all of `points`, whichever of them are done; none where that does not pay."""
    bound = points.case.numerics.pocket_interpolation
    samples = _samples(points)
    alike = {tuple(changes.get(key) for key in _LIKE_SPEED) for changes in samples}
    if bound == 0 or len(alike) < _FEWEST:
        return {}
    asked: dict[FlowFamily, set[float]] = defaultdict(set)
    for changes in samples:
        try:
            for family, number in pocket_flow_numbers(points.case.updated(changes)):
                asked[family].add(number)
        except InputError:
            continue  # the point reports it
    many = {family: numbers for family, numbers in asked.items() if len(numbers) >= _FEWEST}
    return make_tables(many, bound, jobs)


def _samples(points: Points) -> list[dict[str, Any]]:
    """Changes of one point for each set of points that differ in the magnitude of torque only."""
    samples = {}
    for index in range(points.size):
        changes = points.changes(index)
        coasting = str(changes.get(_TORQUE, "")).lstrip().startswith("-")
        others = (str(value) for key, value in changes.items() if key != _TORQUE)
        samples[coasting, *others] = changes
    return list(samples.values())
