"""Tables of the flows through pockets that the points of a sweep have in common."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from epicyclic.analysis.solve import pocket_flow_numbers
from epicyclic.case.operating import AXES, STATE_KEY
from epicyclic.errors import InputError
from epicyclic.pocketing.similarity import FlowFamily
from epicyclic.pocketing.table import FlowTables, make_tables

if TYPE_CHECKING:
    from epicyclic.sweeps.plan import CasePlan

_LIKE_SPEED = (
    STATE_KEY,
    AXES["speed"],
    "operation.second_speed",
    AXES["temperature"],
    "surroundings.pressure",
)
"""Keys that change the number of a flow, but not its family."""
_FEWEST = 8
"""Values of these keys for which a table is made: few flows are solved as soon."""
_TORQUE = AXES["torque"]
"""Only its sign matters to the pockets."""


def flow_tables(plan: CasePlan, indices: Iterable[int], threads: int | None = None) -> FlowTables:
    """Tables for the points `indices`; none where that does not pay.

    A table is made for all points of `plan` that read it, so that it is the same whichever of them
    are done, and where.
    """
    bound = plan.case.numerics.pocket_interpolation
    samples = {_flow(changes): changes for changes in _changes(plan, range(plan.size))}
    alike = {tuple(changes.get(key) for key in _LIKE_SPEED) for changes in samples.values()}
    if bound == 0 or len(alike) < _FEWEST:
        return {}
    wanted = set(map(_flow, _changes(plan, indices)))
    asked: dict[FlowFamily, set[float]] = defaultdict(set)
    read: set[FlowFamily] = set()
    for flow, changes in samples.items():
        try:
            numbers = pocket_flow_numbers(plan.case.updated(changes))
        except InputError:
            continue  # the point reports it
        for family, number in numbers:
            asked[family].add(number)
            if flow in wanted:
                read.add(family)
    many = {
        family: numbers
        for family, numbers in asked.items()
        if family in read and len(numbers) >= _FEWEST
    }
    return make_tables(many, bound, threads)


def _changes(plan: CasePlan, indices: Iterable[int]) -> Iterator[dict[str, Any]]:
    """What the points change; those that cannot be made report it themselves."""
    for index in indices:
        with suppress(InputError):
            yield plan.changes(index)


def _flow(changes: Mapping[str, Any]) -> tuple[Any, ...]:
    """Equal for points that differ in the magnitude of torque only."""
    coasting = str(changes.get(_TORQUE, "")).lstrip().startswith("-")
    return (coasting, *(str(value) for key, value in changes.items() if key != _TORQUE))
