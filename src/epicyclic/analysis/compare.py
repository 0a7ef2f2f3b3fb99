"""Friction models side by side on one case."""

from __future__ import annotations

import math
from dataclasses import dataclass

from epicyclic.analysis.solve import solve
from epicyclic.builders.models import friction_of, friction_settings, resolve_models
from epicyclic.case.case import Case
from epicyclic.elements.base import LOAD_DEPENDENT
from epicyclic.losses.friction import FRICTION_MODELS
from epicyclic.results.result import Result

__all__ = ["FrictionComparison", "compare_friction"]


@dataclass(frozen=True, slots=True)
class FrictionComparison:
    """One friction model on one case.

    Attributes
    ----------
    name, title, source : str
        The model.
    chosen : bool
        True for the model of the case.
    mean_friction : dict of str to float
        For each mesh. [1]
    sliding : float
        Sliding loss of all meshes, local along the contact lines. [W]
    quick : float
        The same by mean friction times Ohlendorf's loss factor. [W]
    flagged : bool
        True if the model was used outside the range in which it was made.
    """

    name: str
    title: str
    source: str
    chosen: bool
    mean_friction: dict[str, float]
    sliding: float
    quick: float
    flagged: bool


def compare_friction(case: Case) -> tuple[FrictionComparison, ...]:
    """Every friction model on `case`, by the local and by the quick method.

    The model ``table`` takes part if the case has a friction table, ``fitted`` and ``ehl-direct``
    if the case chooses them.
    """
    chosen = resolve_models(case)["friction"]
    settings = friction_settings(case)
    rows = []
    for name in dict.fromkeys([*FRICTION_MODELS, chosen]):
        if name == "table" and settings.table is None:
            continue
        local = solve(case.updated({"models.friction": name, "models.mesh": "local"}))
        quick = solve(case.updated({"models.friction": name, "models.mesh": "loss-factor"}))
        model = friction_of(case.updated({"models.friction": name}))
        rows.append(
            FrictionComparison(
                name=name,
                title=model.title,
                source=model.source,
                chosen=name == chosen,
                mean_friction={key: mesh.friction_mean for key, mesh in local.meshes.items()},
                sliding=_sliding(local),
                quick=_sliding(quick),
                flagged=any(
                    (flag.use.role, flag.use.model) == ("friction", name) for flag in local.flags
                ),
            )
        )
    return tuple(rows)


def _sliding(result: Result) -> float:
    return math.fsum(
        term.watts
        for term in result.terms
        if term.group == LOAD_DEPENDENT and term.name.endswith("_sliding")
    )
