"""The sets of a case whose losses are computed."""

from __future__ import annotations

from epicyclic.builders.build import build
from epicyclic.builders.built import Built
from epicyclic.case.case import Case
from epicyclic.errors import InputError, Problem


def build_computed(case: Case) -> Built:
    """The machine of a case with gears.

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
    return built
