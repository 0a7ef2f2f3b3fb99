"""The open figures of the published study of pocketing losses, for each model of the flow."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from epicyclic.analysis.solve import solve
from epicyclic.case.case import read_case

STUDY = "Talbot (2012), section 4.4"
CLOSURES = ("incompressible", "isentropic", "mean-density", "talbot-2012")
"""Models that are compared; "central-differences" has no solution for some of the figures."""


@dataclass(frozen=True, slots=True)
class ClosureFigure:
    """One open figure of the study."""

    what: str
    unit: str
    source: str
    low: float  # What is published; equal for a value.
    high: float  # What is published; equal for a value.
    tolerance: float  # By how much a value may miss that and yet hold. [1]
    cause: str  # Why that tolerance.
    computed: dict[str, float]  # By model, as `CLOSURES`.

    def holds(self, model: str) -> bool:
        """Whether the value of a model is in the band, or within the tolerance of it."""
        low, high = self.low * (1 - self.tolerance), self.high * (1 + self.tolerance)
        return low <= self.computed[model] <= high


def closure_figures(
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> tuple[ClosureFigure, ...]:
    """All open figures, computed with every model."""
    content = _content()
    figures = []
    for number, figure in enumerate(content["figure"]):
        allowed = figure if "tolerance" in figure else content["default"]
        figures.append(
            ClosureFigure(
                what=figure["what"],
                unit=figure["unit"],
                source=figure["source"],
                low=figure["low"],
                high=figure["high"],
                tolerance=allowed["tolerance"],
                cause=allowed["cause"],
                computed={model: _computed(figure, model) for model in CLOSURES},
            )
        )
        progress(number + 1, len(content["figure"]))
    return tuple(figures)


def open_figures() -> list[dict[str, Any]]:
    """The entries of `pocketing.toml`."""
    found: list[dict[str, Any]] = _content()["figure"]
    return found


@cache
def _content() -> dict[str, Any]:
    file = resources.files("epicyclic.validation").joinpath("pocketing.toml")
    return tomllib.loads(file.read_text("utf-8"))


def _computed(figure: dict[str, Any], model: str) -> float:
    loss = _loss(figure["helix_angle"], figure["face_width"], model)
    if "over" in figure:
        return loss / _loss(figure["over"], figure["face_width"], model)
    return loss


@cache
def _loss(helix_angle: str, face_width: str, model: str) -> float:
    """Pocketing loss of the example pair at 10000 rpm. [W]"""
    case = read_case("talbot-2012-pair").updated(
        {
            "gears.helix_angle": helix_angle,
            "pinion.face_width": face_width,
            "gear.face_width": face_width,
            "models.pocketing": model,
        }
    )
    return solve(case).losses["mesh_pocketing"]
