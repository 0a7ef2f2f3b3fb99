"""What elements have answered so far, and what they would answer to loads next to those.

Losses and torques agree after some passes, each with a little other loads. A loss over the load
that it follows is there so nearly a straight line that most passes need not ask its element again.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from epicyclic.elements.base import ElementResult, Loss

CAUTION = 2.0
"""How much larger the error of foretold losses is taken to be than its estimate. [1]"""
STEEPEST = 3.0
"""Power above which no loss rises with its load. [1]"""
BENT = 0.25
"""Change of the power with which a loss rises, over the relative change of its load. [1]"""
NEAR = 3e-5
"""Change of a load over which the figures of an answer serve. [1]"""
ROUNDING = 1e-14
"""Change, relative to the largest load, that is rounding. [1]"""


@dataclass(frozen=True, slots=True)
class Answer:
    """The last answer of an element, and the one before."""

    loads: Mapping[str, float]  # As from `Element.loads`.
    result: ElementResult
    # None if there is none, or none that the same losses at the same places belong to.
    before: Answer | None = None

    def followed_by(self, loads: Mapping[str, float], result: ElementResult) -> Answer:
        """The next answer."""
        before = replace(self, before=None) if self._alike(loads, result) else None
        return Answer(loads, result, before)

    def foretold(
        self,
        loads: Mapping[str, float],
        allowed: float,  # Error of all losses together, relative. [1]
    ) -> ElementResult | None:
        """What the element would answer; None if that may be off by more than `allowed`.

        Losses only: figures and flags are those of the last answer, to loads no farther off than
        `NEAR`.
        """
        if self.before is None or not self._alike(loads, self.result):
            return None
        losses, off = {}, 0.0
        steps: dict[tuple[str, ...], _Step] = {}
        for name, loss in self.result.losses.items():
            older = self.before.result.losses[name].watts
            if loss.follows not in steps:
                steps[loss.follows] = self._step(loads, loss)
            step = steps[loss.follows]
            if step.size > NEAR:
                return None
            off += step.error(loss.watts, older) * loss.watts
            told = loss.watts + step.part * (loss.watts - older)
            watts = max(
                min(0.0, loss.watts), told
            )  # nothing loses less than nothing by foretelling
            losses[name] = loss._replace(watts=watts) if watts != loss.watts else loss
        if not CAUTION * off <= allowed * sum(loss.watts for loss in losses.values()):
            return None
        return replace(self.result, losses=losses)

    def _alike(self, loads: Mapping[str, float], result: ElementResult) -> bool:
        """True if loads have the same signs, and losses act at the same places."""
        return all(
            load * self.loads[key] > 0 or load == self.loads[key] for key, load in loads.items()
        ) and all(
            (loss.mesh, loss.brakes)
            == (self.result.losses[name].mesh, self.result.losses[name].brakes)
            for name, loss in result.losses.items()
        )

    def _step(self, loads: Mapping[str, float], loss: Loss) -> _Step:
        """From the last loads that a loss follows to these, along the line from those before."""
        assert self.before is not None
        keys = loss.follows or tuple(loads)
        new, last, old = (
            [those[key] for key in keys] for those in (loads, self.loads, self.before.loads)
        )
        largest = max(map(abs, new), default=0.0)
        ways = [one - two for one, two in zip(last, old, strict=True)]
        length = sum(way**2 for way in ways)
        if not length > (ROUNDING * largest) ** 2:
            return _Step(0.0, 0.0, _apart(last, new), 0.0)
        ahead = sum((one - two) * way for one, two, way in zip(new, last, ways, strict=True))
        part = ahead / length
        on_line = [two + part * way for two, way in zip(last, ways, strict=True)]
        aside = _apart(on_line, new)
        return _Step(part, _apart(old, last), _apart(last, new), aside if aside > ROUNDING else 0.0)


@dataclass(frozen=True, slots=True)
class _Step:
    """A step of the loads along the line through the last two of them, and beside it."""

    part: float  # How far it goes, over the step before. [1]
    before: float  # Size of the step before and of this one, relative to the largest load. [1]
    size: float  # Size of the step before and of this one, relative to the largest load. [1]
    aside: float  # How far it ends beside the line, relative. [1]

    def error(self, watts: float, older: float) -> float:
        """Estimate of the error of a loss on the line from `older` to `watts`, relative.

        The loss goes with some power of its load, the slope of which bends the line, and which
        changes a little itself. What changed more than any power would, because it scatters or
        follows something else too, may change by as much again.
        """
        if not self.before:
            return STEEPEST * self.size
        if watts == older:
            return 0.0
        if not watts:
            return math.inf
        change = abs(watts - older) / watts
        power = change / self.before
        if power > STEEPEST:
            return change + STEEPEST * self.size
        bend = power * abs(power - 1) / 2 + BENT
        return bend * self.size * (self.before + self.size) + STEEPEST * self.aside


def distance(old: Mapping[str, float], new: Mapping[str, float]) -> float:
    """Largest change of a load, relative to the largest load. [1]"""
    return _apart([old[key] for key in new], list(new.values()))


def _apart(old: list[float], new: list[float]) -> float:
    largest = max(map(abs, new), default=0.0)
    if not largest:
        return 0.0
    return max(abs(two - one) for one, two in zip(old, new, strict=True)) / largest
