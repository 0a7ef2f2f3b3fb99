"""Compare the published figures with what is computed."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from importlib import resources
from typing import Any, Literal

from epicyclic.validation.compute import FIGURES

__all__ = ["Comparison", "compare_published", "published_figures"]

Verdict = Literal["agrees", "differs", "calibrated", "no verdict"]


@dataclass(frozen=True, slots=True)
class Comparison:
    """One published figure and the computed one.

    Attributes
    ----------
    what, unit, source : str
    low, high : float
        The published value, twice, or the published range.
    computed : float
    tolerance : float
        Relative to the published value. [1]
    cause : str
        Why that tolerance.
    role : str
        ``"validation"``, ``"calibration"`` or ``"context"``.
    """

    what: str
    unit: str
    source: str
    low: float
    high: float
    computed: float
    tolerance: float
    cause: str
    role: str

    @property
    def difference(self) -> float:
        """(computed - published)/published; 0 within a published range. [1]"""
        nearest = min(max(self.computed, self.low), self.high)
        return (self.computed - nearest) / nearest

    @property
    def verdict(self) -> Verdict:
        """Agreement within the tolerance; calibration and context get none."""
        if self.role == "calibration":
            return "calibrated"
        if self.role == "context":
            return "no verdict"
        return "agrees" if abs(self.difference) <= self.tolerance else "differs"


def compare_published(
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> tuple[Comparison, ...]:
    """Every published figure whose model exists, compared."""
    figures = published_figures()
    rows = []
    for number, figure in enumerate(figures):
        rows.append(_compare(figure))
        progress(number + 1, len(figures))
    return tuple(rows)


def published_figures() -> list[dict[str, Any]]:
    """The entries of `published.toml`."""
    file = resources.files("epicyclic.validation").joinpath("published.toml")
    figures: list[dict[str, Any]] = tomllib.loads(file.read_text(encoding="utf-8"))["figure"]
    return figures


def _compare(figure: dict[str, Any]) -> Comparison:
    return Comparison(
        what=figure["what"],
        unit=figure["unit"],
        source=figure["source"],
        low=figure["low"] if "low" in figure else figure["value"],
        high=figure["high"] if "high" in figure else figure["value"],
        computed=FIGURES[figure["compute"]](**figure["with"]),
        tolerance=figure.get("tolerance", 0.0),
        cause=figure.get("cause", ""),
        role=figure["role"],
    )
