"""Friction models side by side on one case."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from epicyclic.analysis.sets_of import build_computed
from epicyclic.analysis.solve import solve
from epicyclic.builders.models import friction_of, friction_settings, resolve_models
from epicyclic.builders.train import set_cases
from epicyclic.case.case import Case, TrainCase
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

    In a train all sets get the same model; none is chosen if the case chooses several.

    The model ``table`` takes part if the case has a friction table, ``fitted`` and ``ehl-direct``
    if the case chooses them.

    Raises
    ------
    InputError
        If the case is a train of given efficiencies.
    """
    built, _ = build_computed(case)
    owners = [own for _, own in set_cases(case, built.sets)]
    chosen = {resolve_models(own)["friction"] for own in owners}
    rows = []
    for name in dict.fromkeys([*FRICTION_MODELS, *sorted(chosen)]):
        if name == "table" and friction_settings(owners[0]).table is None:
            continue
        local = solve(_with(case, {"friction": name, "mesh": "local"}))
        quick_case = _with(case, {"friction": name, "mesh": "loss-factor"})
        quick = solve(quick_case)
        model = friction_of(next(own for _, own in set_cases(quick_case, built.sets)))
        rows.append(
            FrictionComparison(
                name=name,
                title=model.title,
                source=model.source,
                chosen=chosen == {name},
                mean_friction={key: mesh.friction_mean for key, mesh in local.meshes.items()},
                sliding=_sliding(local),
                quick=_sliding(quick),
                flagged=any(
                    (flag.use.role, flag.use.model) == ("friction", name) for flag in local.flags
                ),
            )
        )
    return tuple(rows)


def _with(case: Case, models: Mapping[str, str]) -> Case:
    """The case with other models, in a train also of the sets that choose their own."""
    changes = {f"models.{key}": model for key, model in models.items()}
    if isinstance(case, TrainCase):
        changes |= {
            f"sets.{name}.models.{key}": model
            for name, tables in case.given()["sets"].items()
            if "models" in tables
            for key, model in models.items()
        }
    return case.updated(changes)


def _sliding(result: Result) -> float:
    return math.fsum(
        term.watts
        for term in result.terms
        if term.group == LOAD_DEPENDENT and term.name.endswith("_sliding")
    )
