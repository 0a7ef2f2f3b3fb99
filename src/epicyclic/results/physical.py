"""Whether a result can be: no loss below zero, and as much power lost as the shafts bring."""

from __future__ import annotations

from dataclasses import replace

from epicyclic.results.result import Result, in_words
from epicyclic.status import Status
from epicyclic.units import WATT

__all__ = ["judged"]

NEGLIGIBLE = 1e-3
"""A loss that is below zero by a smaller share of the sum of all magnitudes is an error of the
numerics: the power of pockets is a small difference of large ones. [1]"""
UNBALANCED = 1e-8
"""Power, relative to the largest one, that torques and losses may differ by when they agree to
5e-10 of each load. [1]"""


def judged(result: Result) -> Result:
    """The result, or the same with the status `Status.UNPHYSICAL` and a note that says why."""
    reasons = [*_negative(result), *_unbalanced(result)]
    if not reasons:
        return result
    note = (
        f"No result: {' '.join(reasons)} Check the files and tables that the case names, or choose "
        "other models."
    )
    return replace(result, status=Status.UNPHYSICAL, notes=(note, *result.notes))


def _negative(result: Result) -> list[str]:
    limit = NEGLIGIBLE * sum(map(abs, result.losses.values()))
    below = [
        f"{in_words(name)} {WATT.text(watts, 3)}"
        for name, watts in result.losses.items()
        if watts < -limit
    ]
    return [f"Losses are below zero: {', '.join(below)}."] if below else []


def _unbalanced(result: Result) -> list[str]:
    powers = [member.power for member in result.flow.members.values()]
    left = sum(powers) - result.total
    if abs(left) <= UNBALANCED * max(map(abs, (*powers, result.total)), default=0.0):
        return []
    return [f"The shafts bring {WATT.text(left, 3)} more than is lost."]
