"""Checks of how oil gets to the gears of the sets of a train."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from epicyclic.case.tables.lubrication import check_immersion, check_sump, check_wetting
from epicyclic.errors import Problem

if TYPE_CHECKING:
    from epicyclic.case.train import TrainCase


def lubrication_problems(train: TrainCase) -> list[Problem]:
    """What cannot be about the lubrication of the sets; a shared table is checked by itself."""
    problems: list[Problem] = []
    if train.lubrication is not None:
        problems += _shared_immersion(train)
    for name, table in train.computed_sets:
        own = table.lubrication
        if own is None or own == train.lubrication:
            continue
        if train.lubrication is None:
            problems.append(_not_shared(name))
        found = [*check_sump(own, train.thermal), *check_wetting(own, train.thermal)]
        if train.shape.sets[name].listed:
            found += check_immersion(own, train.shape.sets[name].members)
        problems += [replace(problem, key=_key(name, problem.key)) for problem in found]
    return problems


def _shared_immersion(train: TrainCase) -> Iterator[Problem]:
    if train.lubrication is not None and train.lubrication.immersion:
        allowed = "is stated of each set, whose gears it names."
        remedy = "Write [sets.NAME.lubrication], or give oil_level."
        yield Problem("lubrication.immersion", "", allowed, remedy)


def _not_shared(name: str) -> Problem:
    """The oil around everything that is in no set follows from the train's own table."""
    allowed = "needs [lubrication] of the train, which it then replaces for this set."
    return Problem(f"sets.{name}.lubrication", "", allowed, "Add it, for all other parts.")


def _key(name: str, keys: str) -> str:
    """Keys of a set as those of the train."""
    return ", ".join(
        f"sets.{name}.{key}" if key.startswith("lubrication") else key for key in keys.split(", ")
    )
