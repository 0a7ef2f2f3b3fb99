"""Friction models side by side on one case, and the methods that a case asks for."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import cast

from epicyclic.build.machine import build
from epicyclic.build.models import SetCase, set_cases, standing_of
from epicyclic.case.case import Case, TrainCase
from epicyclic.dataclass import dataclass
from epicyclic.losses.contact import LOAD_DISTRIBUTIONS
from epicyclic.losses.drag import VISCOUS_METHOD, VISCOUS_SOURCE
from epicyclic.losses.friction import FRICTION_MODELS
from epicyclic.losses.ranges import ValidityFlag, range_left, share_text
from epicyclic.losses.rolling import FittedOrSchlenk
from epicyclic.losses.windage import DRAG_METHODS, DragModel
from epicyclic.machine.element import LOAD_DEPENDENT
from epicyclic.machine.gear_mesh import OHLENDORF_SOURCE
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.planets import SHARING_METHODS
from epicyclic.machine.pocket_flow import POCKETING_SOURCE, pocketing_method
from epicyclic.result.result import Result
from epicyclic.study.solve import build_computed, solve
from epicyclic.units import known_text, percent

MOSTLY = 0.5
"""Share of the loss outside its range up to which a model made for the oil is preferred. [1]"""
UNEQUAL = 0.01
"""Relative difference of sliding losses from which the pairing of the flanks matters. [1]"""
PAIRED = "mixed-ehl+pairing"
_REGRESSION = "mixed-ehl"
_ANY_OIL = "mixed-lubrication"
STANDARD = "ISO/TR 14179-2"  # Begins what is said of it beside a result.
_STANDARD = "schlenk"  # ISO/TR 14179-2.
PARTED = 1.25
"""Ratio of two losses from which a reason for their difference is given. [1]"""


@dataclass(frozen=True, slots=True)
class FrictionComparison:
    """One friction model on one case."""

    name: str  # Of the model.
    title: str  # Of the model.
    source: str  # Of the model.
    chosen: bool  # True for the model of the case.
    mean_friction: dict[str, float]  # For each mesh. [1]
    sliding: float  # Sliding loss of all meshes, local along the contact lines. [W]
    quick: float  # The same by mean friction times Ohlendorf's loss factor. [W]
    # Which ranges it leaves, by how much, and with what share of the loss; empty if none.
    reasons: tuple[str, ...]
    outside: float  # Share of the sliding loss outside its range. [1]
    # The fluid that it was made for, if that is not the oil of the case; else empty.
    other_oil: str
    own_oil: bool  # True if it was made for the oil of the case, and for no other.
    standing: str  # How well it is known to be right.


def compare_friction(case: Case, *, brief: bool = False) -> tuple[FrictionComparison, ...]:
    """Every friction model on `case`, by the local and by the quick method.

    In a train all sets get the same model; none is chosen if the case chooses several.

    The model ``table`` takes part if the case has a friction table, ``fitted-or-schlenk`` if there
    are fitted models of the oil, ``fitted`` and ``ehl-direct`` if the case chooses them. With
    `brief` only those that `recommended` and `standard_beside` look at, and the quick method, whose
    loss is NaN for the others, for ISO/TR 14179-2 alone.
    Raises `InputError` if the case is a train of given efficiencies.
    """
    owners = list(build_computed(case).set_cases.values())
    chosen = {own.chosen["friction"] for own in owners}
    suiting = {_STANDARD, _ANY_OIL} | (set() if chosen == {_ANY_OIL} else {_REGRESSION, PAIRED})
    rows = []
    for name in dict.fromkeys([*_models_for(owners), *sorted(chosen)]):
        if brief and name not in (*suiting, *chosen):
            continue
        local = solve(_with(case, {"friction": name, "mesh": "local"}))
        quick_case = _with(case, {"friction": name, "mesh": "loss-factor"})
        quick = math.nan if brief and name != _STANDARD else _sliding(solve(quick_case))
        own = next(iter(set_cases(quick_case).values()))
        model = own.friction
        flags = [flag for flag in local.flags if flag.use.role == "friction"]
        fluid = model.made_for
        same = fluid is not None and fluid.key == own.lubricant.oil.friction_regression
        rows.append(
            FrictionComparison(
                name=name,
                title=model.title,
                source=model.source,
                chosen=chosen == {name},
                mean_friction={key: mesh.friction_mean for key, mesh in local.meshes.items()},
                sliding=_sliding(local),
                quick=quick,
                reasons=tuple(_reason(flag) for flag in flags),
                outside=_outside(local, flags),
                other_oil="" if fluid is None or same else fluid.title,
                own_oil=same,
                standing=standing_of(own)["friction"].removeprefix(f"{name}: "),
            )
        )
    return tuple(rows)


def recommended(rows: Sequence[FrictionComparison]) -> tuple[FrictionComparison, str]:
    """The model that suits the oil and the conditions, and why.

    The one for any oil, which measured gears agree best with; where it is not chosen, the
    regression of the dissertation for its fluid, if most of the loss lies in its range.
    """
    by_name = {row.name: row for row in rows}
    any_oil = by_name[_ANY_OIL]
    own = any_oil if any_oil.chosen else by_name[_REGRESSION]
    if own.own_oil and own.outside <= MOSTLY:
        paired = by_name[PAIRED]
        if abs(paired.sliding - own.sliding) > UNEQUAL * own.sliding:
            why = "it was made for this oil and accounts for unequal roughness of the flanks"
            return paired, f"{why}; {_inside(paired)}"
        return own, f"it was made for this oil, and {_inside(own)}"
    why = "it holds for any oil and agrees best with measured gears"
    return any_oil, f"{why}; {_inside(any_oil)}"


def standard_beside(rows: Sequence[FrictionComparison], result: Result) -> str | None:
    """What ISO/TR 14179-2 gives for the meshes of a result, and what it leaves out if they differ.

    By its mean friction, which contains the rolling loss, and its loss factor. None if its friction
    was used itself, or the meshes lose nothing.
    """
    standard = next(row for row in rows if row.name == _STANDARD)
    own = _sliding(result) + math.fsum(result.losses[f"{key}_rolling"] for key in result.meshes)
    if standard.chosen or not own:
        return None
    ratio = standard.quick / own
    told = (
        f"{STANDARD} gives {known_text(standard.quick)} for the meshes under load, "
        f"{ratio:.2f} times their loss here"
    )
    if 1 / PARTED < ratio < PARTED:
        return f"{told}."
    if standard.outside > MOSTLY:
        left = standard.reasons[0].partition(" (")[0]
        return f"{told}; most of the loss is outside the range of its tests: {left}."
    low = min(mesh.film_ratio_min for mesh in result.meshes.values())
    high = max(mesh.film_ratio_max for mesh in result.meshes.values())
    return f"{told}; its friction does not follow the film ratio, {low:.2g} to {high:.2g} here."


def _inside(row: FrictionComparison) -> str:
    if not row.reasons:
        return "the whole loss is within its range"
    return f"{percent(1 - row.outside, 0)} of the loss is within its range"


def _models_for(owners: Sequence[SetCase]) -> Iterator[str]:
    """The models that can be used for every set."""
    for name in FRICTION_MODELS:
        if name != "table" or owners[0].friction_table is not None:
            yield name
    fitted = [own.oil_model for own in owners]
    if all(model is not None and "friction" in model.fits for model in fitted):
        yield FittedOrSchlenk.name


def _reason(flag: ValidityFlag) -> str:
    """``"sun mesh: Hertz pressure 0.1 to 0.4 GPa; range from 0.5 GPa (...), 20 % of the loss"``."""
    left = range_left([flag]).removeprefix("Out of range: ").removesuffix(".")
    instead = f", {flag.use.instead} is used instead" if flag.use.instead else ""
    return f"{flag.use.where}: {left}, {share_text(flag.share)} of the loss{instead}"


def _outside(result: Result, flags: Sequence[ValidityFlag]) -> float:
    """Share of the sliding loss of all meshes that is outside some range. [1]"""
    total, loss_of = _sliding(result), result.losses_of()
    outside: dict[str, float] = {}
    for flag in flags:
        watts = flag.share * loss_of(flag.use)
        outside[flag.use.where] = max(outside.get(flag.use.where, 0.0), watts)
    return math.fsum(outside.values()) / total if total else 0.0


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


def methods_of(case: Case) -> dict[str, tuple[str, str]]:
    """Title and source of the method for each role, ``"friction"``; of a train with the set."""
    built = build(case)
    methods: dict[str, tuple[str, str]] = {}
    for name, own in built.set_cases.items():
        prefix = f"{name}: " if name else ""
        found = _methods_of_set(own, built.sets[name])
        methods |= {f"{prefix}{role}": method for role, method in found.items()}
    return methods


def _methods_of_set(case: SetCase, own: GearSet) -> dict[str, tuple[str, str]]:
    friction, rolling = case.friction, case.rolling
    methods = {"friction": (friction.title, friction.source)}
    if case.chosen["mesh"] == "loss-factor":
        methods["mesh loss"] = ("friction times the loss factor", OHLENDORF_SOURCE)
    else:
        methods["rolling"] = (rolling.title, rolling.source)
    distribution = LOAD_DISTRIBUTIONS[case.models.load_distribution]
    methods["load distribution"] = (distribution.title, distribution.source)
    methods["pocketing"] = (pocketing_method(case.chosen["pocketing"], None), POCKETING_SOURCE)
    methods["drag"] = DRAG_METHODS[cast(DragModel, case.chosen["drag"])][:2]
    if own.sharing is not None:
        methods["load sharing"] = SHARING_METHODS[own.sharing.method]
    for planet in own.planets:
        if planet.bearing is not None:
            methods["planet bearing"] = planet.bearing.method
            methods["bearings, viscous"] = (VISCOUS_METHOD, VISCOUS_SOURCE)
    return methods
