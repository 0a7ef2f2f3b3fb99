"""What elements have answered so far, and what they would answer to loads next to those.

Losses and torques agree after some passes, each with a little other loads. The losses of an element
over its loads follow a straight line there so nearly that most passes need not ask it again.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from epicyclic.elements.base import ElementResult

__all__ = ["Answer", "distance"]

CAUTION = 10.0
"""How much larger the error of a foretold loss is taken to be than its estimate. [1]"""
ROUNDING = 1e-14
"""Change, relative to the largest load, that is rounding. [1]"""


@dataclass(frozen=True, slots=True)
class Answer:
    """The last answer of an element, and the one before.

    Attributes
    ----------
    loads : mapping of str to float
        As from `Element.loads`.
    result : ElementResult
    before : Answer or None
        None if there is none, or none that the same losses at the same places belong to.
    slope_error : float
        Largest error of a foretold loss, relative, over the change of the loads, relative:
        measured where this answer was foretold, from the answer before. [1]
    """

    loads: Mapping[str, float]
    result: ElementResult
    before: Answer | None = None
    slope_error: float = math.inf

    def followed_by(self, loads: Mapping[str, float], result: ElementResult) -> Answer:
        """The next answer, compared with what this one foretold of it."""
        if not self._alike(loads, result):
            return Answer(loads, result)
        told = self._losses(loads)
        scale = sum(abs(loss.watts) for loss in result.losses.values())
        off = max(
            (
                abs(told[name] - loss.watts) / loss.watts
                for name, loss in result.losses.items()
                if loss.watts > ROUNDING * scale
            ),
            default=0.0,
        )
        moved = distance(self.loads, loads)
        return Answer(loads, result, replace(self, before=None), off / moved if moved else math.inf)

    def foretold(self, loads: Mapping[str, float], allowed: float) -> ElementResult | None:
        """What the element would answer; None if that may be off by more than `allowed`.

        Losses only: figures and flags are those of the last answer.
        """
        if self.before is None or not self._alike(loads, self.result):
            return None
        moved = distance(self.loads, loads)
        error = self.slope_error * moved + self._aside(loads)
        if not CAUTION * error <= allowed:
            return None
        told = self._losses(loads)
        losses = {
            name: replace(loss, watts=max(0.0, told[name]))
            for name, loss in self.result.losses.items()
        }
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

    def _losses(self, loads: Mapping[str, float]) -> dict[str, float]:
        """Losses on the line through the last two answers; as the last one if it is alone. [W]"""
        part = self._part(loads)
        own = {name: loss.watts for name, loss in self.result.losses.items()}
        if self.before is None:
            return own
        older = self.before.result.losses
        return {name: watts + part * (watts - older[name].watts) for name, watts in own.items()}

    def _part(self, loads: Mapping[str, float]) -> float:
        """How far loads lie beyond the last ones, over the distance of these from those before."""
        if self.before is None:
            return 0.0
        steps = {key: load - self.before.loads[key] for key, load in self.loads.items()}
        length = sum(step**2 for step in steps.values())
        if not length:
            return 0.0
        return sum((loads[key] - self.loads[key]) * step for key, step in steps.items()) / length

    def _aside(self, loads: Mapping[str, float]) -> float:
        """How far loads lie beside the line through the last two, relative. [1]"""
        assert self.before is not None
        part = self._part(loads)
        on_line = {
            key: load + part * (load - self.before.loads[key]) for key, load in self.loads.items()
        }
        aside = distance(on_line, loads)
        return aside if aside > ROUNDING else 0.0


def distance(old: Mapping[str, float], new: Mapping[str, float]) -> float:
    """Largest change of a load, relative to the largest load. [1]"""
    largest = max(map(abs, new.values()), default=0.0)
    if not largest:
        return 0.0
    return max(abs(load - old[key]) for key, load in new.items()) / largest
