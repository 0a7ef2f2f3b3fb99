"""How a case ends: in one of a few ways that can be, or as a fault of the program."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass

import epicyclic as ep
from epicyclic.case.case import Case
from epicyclic.errors import Status, is_interrupt
from epicyclic.result.result import Result
from limits import is_soon

__all__ = ["FAULTS", "LONGEST", "Outcome", "outcome_of"]

LONGEST = 45.0
"""Processor time of one case of any resolution drawn here, compiled code at hand. [s]"""
ENERGY = 1e-9
"""What powers of the shafts and losses may differ by, over the largest of them. [1]"""
UNSOLVED = {
    "the flow does not converge": "the flow through pockets is not found",
    "thermal runaway": "it runs away: no temperature at which its heat would leave",
    "temperatures and losses do not settle": "no temperatures agree with its losses",
    "more heat is removed": "it freezes: coolers take more heat than arises",
    "the planet loads have no equilibrium": "the floating member gives way",
    "do not agree after": "losses grow with the torques that they cause",
    "load distribution of the planet bearing": "the loads of the rollers are not found",
    "was not found at": "the loads of the teeth are not found",
    "did not give a finite number": "a loss is not a finite number",
}
"""What a `ConvergenceError` says, and the outcome that it is counted as."""
MAY_BE_MISSING = (
    "pocket_interpolation_error", "transmission_error_range", "mesh_stiffness", "efficiency",
    "ratio", "power_ratio",
)  # fmt: skip
"""Numbers that only some methods have, and ratios to nothing."""
FIGURES = {
    "_mesh_pocket_": "_mesh_pocketing",
    "mesh_pocket_": "mesh_pocketing",
    "_mesh_": "_mesh_sliding",
    "mesh_": "mesh_sliding",
    "planet_bearing_": "planet_bearing_mechanical",
}
"""Parts of the names of figures, and the loss without which there are none."""
BEYOND = "unphysical: contacts carry or resist with more than any can"
"""What is left of the status where no loss is below zero and energy balances."""
FAULTS = ("exception", "not finite", "negative", "energy", "too long")
"""Outcomes that may not be."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a case ended.

    Attributes
    ----------
    name : str
        One of `FAULTS`, ``"solved"``, ``"solved, self-locking"`` or why there is no solution.
    seconds : float
        Processor time. [s]
    energy : float
        What powers and losses differ by, over the largest of them; NaN without a result. [1]
    detail : str
        Of faults, and of errors that are not counted by their own name.
    """

    name: str
    seconds: float
    energy: float = math.nan
    detail: str = ""


def outcome_of(case: Case) -> Outcome:
    """Solve a case and judge its result."""
    start = time.process_time()
    try:
        result = ep.solve(case)
        name, energy, detail = _judged(result)
    except ep.ConvergenceError as error:
        name, energy, detail = _unsolved(str(error))
    except Exception as error:  # any other is a fault
        if is_interrupt(error):
            raise
        name, energy, detail = "exception", math.nan, f"{type(error).__name__}: {error}"
    seconds = time.process_time() - start
    if name not in FAULTS and not is_soon(seconds, LONGEST):
        name, detail = "too long", name
    return Outcome(name, seconds, energy, detail)


def _unsolved(message: str) -> tuple[str, float, str]:
    for part, name in UNSOLVED.items():
        if part in message:
            return name, math.nan, ""
    return "not solved for another reason", math.nan, message


def _judged(result: Result) -> tuple[str, float, str]:
    powers = [member.power for member in result.flow.members.values()]
    largest = max(map(abs, (*powers, result.total)))
    energy = abs(sum(powers) - result.total) / largest if largest else 0.0
    numbers = {item.key: item.value for item in result.numbers()}
    strange = [key for key, value in numbers.items() if not _can_be(key, value, numbers)]
    if strange:
        return "not finite", energy, ", ".join(strange)
    below = [f"{key} {watts}" for key, watts in result.losses.items() if watts < 0]
    if below:
        return "negative", energy, ", ".join(below)
    if energy > ENERGY:
        return "energy", energy, f"{energy:.1e}"
    if result.status is not Status.CONVERGED:
        return BEYOND, energy, ""
    if any("Self-locking" in warning for warning in result.warnings):
        return "solved, self-locking", energy, ""
    return "solved", energy, ""


def _can_be(key: str, value: float | None, numbers: Mapping[str, float | None]) -> bool:
    """Whether a number is finite, or missing for good: figures of what loses no power."""
    if value is not None and math.isfinite(value):
        return True
    if value is not None and math.isinf(value):
        return False
    if key.endswith(MAY_BE_MISSING):
        return True
    for part, loss in FIGURES.items():
        start, found, _ = key.rpartition(part)
        if found:
            return not numbers.get(f"{start}{loss}")
    return False
