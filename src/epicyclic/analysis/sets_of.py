"""The sets of a case whose losses are computed, each as a case of its own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from epicyclic.builders.build import build
from epicyclic.builders.built import Built
from epicyclic.builders.train import set_case
from epicyclic.case.case import Case, GearPairCase, PlanetaryCase, TrainCase
from epicyclic.case.listed_set import ListedCase
from epicyclic.elements.fluids import Fluids
from epicyclic.elements.gear_set import GearSet
from epicyclic.errors import InputError, Problem

__all__ = ["build_computed", "set_cases"]


def build_computed(case: Case) -> tuple[Built, Fluids]:
    """The machine of a case, and its oil.

    Raises
    ------
    InputError
        If it is a train in which every set has a given efficiency: there are no teeth to look at.
    """
    built = build(case)
    if not built.sets or built.known_fluids is None:
        problem = Problem(
            "sets",
            "",
            "have given efficiencies only: nothing is known of their teeth.",
            "Give a set its gears (module, face widths, roughness) in place of its efficiency.",
        )
        raise InputError([problem], case.source)
    return built, built.fluids


def set_cases(
    case: Case, sets: Mapping[str, GearSet]
) -> Iterator[tuple[str, PlanetaryCase | GearPairCase | ListedCase]]:
    """Name and case of every set of `sets`; a single set is its own, without a name."""
    if not isinstance(case, TrainCase):
        yield "", case
        return
    for name in sets:
        yield name, set_case(case, name)
