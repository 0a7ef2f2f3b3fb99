"""Combinations of inputs that measured points cannot tell apart, found before a fit.

How far each input may be off is known before, from [uncertainty] or by assumption. A combination of
inputs that may be off that far without moving the losses by their uncertainty cannot be fitted.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.case.parameters import Parameter
from epicyclic.case.uncertain_values import UncertainValue, uncertain_values
from epicyclic.measurement.intervals import SINGULAR
from epicyclic.units import format_number

FloatArray = NDArray[np.float64]

NAMED = 0.2
"""Component of a direction, over the largest, from which an input is named. [1]"""
TINY = 1e-300
"""In place of a scatter of nothing."""


@dataclass(frozen=True, slots=True)
class Combination:
    """Inputs moved together, as far as they were known before the fit."""

    keys: tuple[str, ...]  # The inputs that move most, the first of them upwards.
    units: tuple[str, ...]
    start: tuple[float, ...]  # Their values in the case and after the move.
    moved: tuple[float, ...]  # Their values in the case and after the move.
    # Root mean square change of the losses over their scatter: that which a linear model leaves,
    # and their uncertainty if that is more. [1]
    change: float
    told_apart: bool  # Whether the points know this combination better than it was known before.

    @property
    def text(self) -> str:
        """What moves, in words: ``"f0 up (1.1 to 1.6) with oil share down (0.05 to 0.03)"``."""
        parts = [
            f"{key} {'up' if moved > start else 'down'} "
            f"({format_number(start, 3)} to {format_number(moved, 3)} {unit}".rstrip()
            + ")"
            for key, unit, start, moved in zip(
                self.keys, self.units, self.start, self.moved, strict=True
            )
        ]
        return " with ".join(parts)

    @property
    def warning(self) -> str:
        """What this means for the fit, in words."""
        effect = f"changes the losses by {format_number(self.change, 2)} of their scatter"
        if len(self.keys) == 1:
            return (
                f"these points hardly see {self.text}, which {effect}: do not fit it, or add "
                "points at which it matters."
            )
        return (
            f"these points cannot tell apart: {self.text} {effect}. Fix all but one of them, or "
            "add points at which they act differently."
        )


def reaches(case: Case, parameters: Sequence[Parameter]) -> FloatArray:
    """How far inputs may be off before a fit: one standard deviation over the value. [1]

    From [uncertainty] or what is assumed; 1 where nothing is.
    """
    known = {value.key: _reach(value) for value in uncertain_values(case)[0]}
    return np.array([known.get(item.key, 1.0) for item in parameters])


def _reach(value: UncertainValue) -> float:
    if value.kind == "lognormal":
        return math.log(value.spread[0])
    if value.kind == "normal":
        return value.spread[0] / abs(value.value)
    low, high = value.spread
    return (high - low) / math.sqrt(12.0) / abs(value.value)


def combinations(
    parameters: Sequence[Parameter],
    deviations: FloatArray,  # At the start, over their uncertainty if `weighted`.
    derivatives: FloatArray,  # There, of the deviations over the scaled parameters.
    reach: FloatArray,  # See `reaches`.
    weighted: bool,
) -> tuple[Combination, ...]:
    """Directions in which the points see parameters least, first. Theory (X2), (X3)."""
    count = deviations.size
    outer, singular, directions = np.linalg.svd(derivatives * reach, full_matrices=False)
    left = deviations - outer @ (outer.T @ deviations)
    freedom = count - singular.size
    noise = float(np.linalg.norm(left)) / math.sqrt(freedom) if freedom else 0.0
    noise = max(noise, 1.0) if weighted else noise
    least = max(noise, SINGULAR * float(singular[0]))
    return tuple(
        _described(
            parameters,
            direction,
            reach,
            change=float(size) / max(noise, TINY) / math.sqrt(count),
            told_apart=bool(size > least),
        )
        for size, direction in zip(singular[::-1], directions[::-1], strict=True)
    )


def _described(
    parameters: Sequence[Parameter],
    direction: FloatArray,
    reach: FloatArray,
    change: float,
    told_apart: bool,
) -> Combination:
    """A direction with the values that it leads to."""
    order = np.argsort(-np.abs(direction))
    first = order[0]
    named = [int(i) for i in order if abs(direction[i]) >= NAMED * abs(direction[first])]
    upward = direction * reach * np.sign(direction[first] * parameters[first].start)
    items = [parameters[i] for i in named]
    moved = [item.start * (1 + upward[i]) for item, i in zip(items, named, strict=True)]
    return Combination(
        keys=tuple(item.key for item in items),
        units=tuple(item.unit for item in items),
        start=tuple(item.start for item in items),
        moved=tuple(
            min(max(float(value), item.low), item.high)
            for item, value in zip(items, moved, strict=True)
        ),
        change=change,
        told_apart=told_apart,
    )
