"""The methods that a case asks for and where they are printed, without solving it."""

from __future__ import annotations

from epicyclic.builders.build import build
from epicyclic.builders.models import friction_of, pocketing_of, resolve_models, rolling_of
from epicyclic.builders.train import set_cases
from epicyclic.case.case import Case, GearPairCase, PlanetaryCase
from epicyclic.case.listed_set import ListedCase
from epicyclic.elements.gear_mesh import OHLENDORF_SOURCE
from epicyclic.elements.gear_set import GearSet
from epicyclic.elements.load_sharing import SHARING_METHODS
from epicyclic.elements.pocket_flow import POCKETING_SOURCE, pocketing_method
from epicyclic.losses.load_distribution import LOAD_DISTRIBUTIONS
from epicyclic.losses.viscous import DRAG_METHOD, DRAG_SOURCE, VISCOUS_METHOD, VISCOUS_SOURCE


def methods_of(case: Case) -> dict[str, tuple[str, str]]:
    """Title and source of the method for each role, ``"friction"``; of a train with the set."""
    built = build(case)
    methods: dict[str, tuple[str, str]] = {}
    for name, own in set_cases(case, built.sets):
        prefix = f"{name}: " if name else ""
        found = _methods_of_set(own, built.sets[name])
        methods |= {f"{prefix}{role}": method for role, method in found.items()}
    return methods


def _methods_of_set(
    case: PlanetaryCase | GearPairCase | ListedCase, own: GearSet
) -> dict[str, tuple[str, str]]:
    friction, rolling = friction_of(case), rolling_of(case)
    methods = {"friction": (friction.title, friction.source)}
    if resolve_models(case)["mesh"] == "loss-factor":
        methods["mesh loss"] = ("friction times the loss factor", OHLENDORF_SOURCE)
    else:
        methods["rolling"] = (rolling.title, rolling.source)
    distribution = LOAD_DISTRIBUTIONS[case.models.load_distribution]
    methods["load distribution"] = (distribution.title, distribution.source)
    methods["pocketing"] = (pocketing_method(pocketing_of(case), None), POCKETING_SOURCE)
    methods["drag"] = (DRAG_METHOD, DRAG_SOURCE)
    if own.sharing is not None:
        methods["load sharing"] = SHARING_METHODS[own.sharing.method]
    for planet in own.planets:
        if planet.bearing is not None:
            methods["planet bearing"] = planet.bearing.method
            methods["bearings, viscous"] = (VISCOUS_METHOD, VISCOUS_SOURCE)
    return methods
