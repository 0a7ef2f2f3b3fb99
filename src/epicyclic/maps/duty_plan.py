"""The map that a duty cycle needs, as a plan that knows its cycle: its points can be shared out."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, Self

from epicyclic.case.case import Case
from epicyclic.errors import InputError, Problem
from epicyclic.maps.compute import MapPlan
from epicyclic.maps.cycle import Cycle
from epicyclic.maps.duty import cycle_plan


@dataclass(frozen=True, slots=True)
class DutyPlan(MapPlan):
    """The points of the map of a duty cycle."""

    kind: ClassVar[str] = "duty"
    digest: str = field(kw_only=True)  # Of the file of the cycle.
    # Oil inlet temperatures that were asked for. [degC]
    celsius: tuple[float, ...] | None = field(kw_only=True)
    clamp: bool = field(kw_only=True)  # As for `duty_cycle`.

    @classmethod
    def of(
        cls,
        case: Case,
        cycle: Cycle,
        celsius: tuple[float, ...] | None,
        *,
        digest: str,
        clamp: bool,
    ) -> Self:
        """The map of a cycle; raises `InputError` as `cycle_plan`."""
        plan = cycle_plan(case, cycle, celsius)
        return cls(plan.case, plan.axes, digest=digest, celsius=celsius, clamp=clamp)

    @classmethod
    def again(cls, content: Mapping[str, Any], source: str) -> Self:
        """The plan that `describe` described."""
        plan, asked = MapPlan.again(content, source), content["duty"]
        celsius = None if asked["celsius"] is None else tuple(asked["celsius"])
        return cls(
            plan.case, plan.axes, digest=asked["cycle"], celsius=celsius, clamp=asked["clamp"]
        )

    def describe(self) -> dict[str, Any]:
        """The map, and what is asked of it."""
        celsius = None if self.celsius is None else list(self.celsius)
        duty = {"cycle": self.digest, "celsius": celsius, "clamp": self.clamp}
        return {**MapPlan.describe(self), "duty": duty}


def digest_of(cycle: Path) -> str:
    """What tells the content of a file that can be read from any other."""
    with cycle.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def check_same(plan: DutyPlan, cycle: Path) -> None:
    """Raise `InputError` if `cycle` is not the file of which shards were computed."""
    try:
        allowed = "" if digest_of(cycle) == plan.digest else "has changed since then."
    except OSError as error:
        allowed = f"cannot be read: {error.strerror}."
    if allowed:
        remedy = "Put back the cycle of which the shards were computed."
        raise InputError([Problem("CYCLE", str(cycle), allowed, remedy)], "the command")
