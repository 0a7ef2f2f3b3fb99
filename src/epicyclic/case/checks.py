"""Checks across keys and tables.

Every function returns the problems it finds; none stops at the first. A check runs only if the
tables that it needs are valid by themselves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from epicyclic.case.expand import gearing_of
from epicyclic.case.gear_rules import gears_by_name
from epicyclic.case.gearing import Gearing
from epicyclic.case.messages import millimetres
from epicyclic.case.set_rules import set_problems
from epicyclic.case.tables.base import Table
from epicyclic.case.tables.elements import PlanetBearing
from epicyclic.case.tables.models import (
    ContactSolver,
    FrictionTable,
    GearPairModels,
    LoadSharing,
    Numerics,
    PlanetaryModels,
    law_problems,
)
from epicyclic.case.tables.operation import (
    GearPairOperation,
    Lubricant,
    LubricationTable,
    PlanetaryOperation,
    Surroundings,
    ThermalTable,
    check_immersion,
    check_lubrication,
    check_outlet,
    check_sump,
    check_thermal,
    check_ways_out,
    check_wetting,
)
from epicyclic.case.train_tables import ListedSet
from epicyclic.errors import InputError, Problem, rising_problems
from epicyclic.gears.mesh import are_evenly_spaced
from epicyclic.losses.ranges import FITTED_QUANTITIES
from epicyclic.units import BAR

if TYPE_CHECKING:
    from epicyclic.contact.fitted_models import OilModel

MOST_COEFFICIENTS = 5_000_000
"""Largest number of influence coefficients for each contact line: 40 MB, for three lines 120 MB."""


def cross_check(
    sections: Mapping[str, Table],  # The tables that are valid by themselves.
    given: Collection[str],  # Names of the tables that the case has, valid or not.
    folder: Path,  # Where the files lie that the case names.
) -> list[Problem]:
    """Problems between keys and tables of a case."""
    problems: list[Problem] = []
    models = sections.get("models")
    if isinstance(models, GearPairModels):
        problems += _check_friction_model(models, {*given, *sections})
        if "lubricant" in sections or models.oil_model is not None:  # a train has that of its sets
            problems += check_oil_model(models, folder, sections.get("lubricant"))
        problems += _check_pocketing_table(models, folder)
    solver = sections.get("contact_solver")
    if isinstance(solver, ContactSolver):
        problems += law_problems("contact_solver", solver)
    thermal, oil = sections.get("thermal"), sections.get("lubrication")
    if isinstance(models, GearPairModels) and isinstance(thermal, ThermalTable):
        flow = oil.oil_flow if isinstance(oil, LubricationTable) else None
        problems += check_ways_out(thermal, models.temperatures, flow)
    if isinstance(models, PlanetaryModels):
        problems += _check_planet_tilt(models, {*given, *sections})
    gearing = gearing_of(sections)
    if gearing is not None and gearing.computed:
        problems += set_problems(gearing)
        bearing, sharing = sections.get("planet_bearing"), sections.get("load_sharing")
        if isinstance(bearing, PlanetBearing) and gearing.planets:
            problems += check_bores(gearing, {"planet_bearing": (bearing, gearing.planets)})
        if isinstance(sharing, LoadSharing) and gearing.count is not None:
            problems += _check_load_sharing(sharing, gearing)
    for check, needed in _CHECKS:
        if all(name in sections for name in needed):
            problems += check(*(sections[name] for name in needed))
    return problems


def _check_operation(operation: PlanetaryOperation | GearPairOperation) -> list[Problem]:
    if not isinstance(operation, PlanetaryOperation):
        return []
    allowed = f'must be another member than operation.input, "{operation.input}".'
    return [
        Problem(f"operation.{key}", operation.input, allowed, "Name one of the other two.")
        for key in ("fixed", "second_input")
        if getattr(operation, key) == operation.input
    ]


def check_rollers(bearing: PlanetBearing, key: str = "planet_bearing") -> list[Problem]:
    """The rollers of the bearing at `key` must fit around its pin."""
    pitch_diameter = bearing.pin_diameter + bearing.roller_diameter + bearing.diametral_clearance
    room = math.pi / math.asin(min(1.0, bearing.roller_diameter / pitch_diameter))
    if bearing.rollers_per_row <= room:
        return []
    allowed = f"only {math.floor(room)} rollers of {millimetres(bearing.roller_diameter)} fit "
    allowed += f"around the pin of {millimetres(bearing.pin_diameter)}."
    remedy = "Take fewer or thinner rollers."
    return [Problem(f"{key}.rollers_per_row", str(bearing.rollers_per_row), allowed, remedy)]


def check_bores(
    gearing: Gearing,
    # By the key of a bearing: its table, and the planets that it carries.
    bearings: Mapping[str, tuple[PlanetBearing, Sequence[str]]],
) -> list[Problem]:
    """Bearings must fit into the root circles of their planets."""
    sound, _ = gears_by_name(gearing)  # others are reported with the gears
    problems = []
    for key, (bearing, planets) in bearings.items():
        bore = bearing.pin_diameter + 2 * bearing.roller_diameter + bearing.diametral_clearance
        for body in planets:
            roots = [sound[it].root_radius for it in gearing.gears_of(body) if it in sound]
            if not roots or bore < 2 * min(roots):
                continue
            shown = millimetres(bearing.pin_diameter)
            allowed = f"the planet's bore of {millimetres(bore)} reaches its root circle of "
            allowed += f"{millimetres(2 * min(roots))}."
            remedy = "Take a thinner pin or thinner rollers."
            problems.append(Problem(f"{key}.pin_diameter", shown, allowed, remedy))
    return problems


def check_listed_bearings(table: ListedSet, gearing: Gearing) -> list[Problem]:
    """Problems of the bearings that a listed set has for each kind of planets."""
    own = table.planet_bearings
    problems = [
        problem
        for name, bearing in own.items()
        for problem in (
            *check_rollers(bearing, f"planet_bearings.{name}"),
            *check_cage(bearing, table.models),
        )
    ]
    found = {
        f"planet_bearings.{body}": (own[body], [body]) for body in gearing.planets if body in own
    }
    if table.planet_bearing is not None:
        others = [body for body in gearing.planets if body not in own]
        found["planet_bearing"] = table.planet_bearing, others
    return problems + check_bores(gearing, found)


def check_cage(bearing: PlanetBearing, models: PlanetaryModels) -> list[Problem]:
    """The model of the bearing loss must be for bearings of this kind."""
    if bearing.cage == "caged" or models.bearing != "mixed-ehl":
        return []
    allowed = "is for caged bearings: the rollers of a full-complement bearing rub on each other, "
    allowed += "which it leaves out."
    return [Problem("models.bearing", '"mixed-ehl"', allowed, 'Write bearing = "palmgren".')]


def _check_load_sharing(sharing: LoadSharing, gearing: Gearing) -> list[Problem]:
    problems, count = [], gearing.count or 1
    if sharing.mesh_load_factor > count:
        shown = f"{sharing.mesh_load_factor:g}"
        allowed = f"must be at most planet.count, {count}: then one planet has all the load."
        remedy = "Take a smaller factor."
        problems.append(Problem("load_sharing.mesh_load_factor", shown, allowed, remedy))
    if len(sharing.position_errors or ()) not in (0, count):
        shown = f"{len(sharing.position_errors or ())} values"
        allowed = f"must have one value for each of the {count} planets."
        remedy = "Give as many values as there are planets."
        problems.append(Problem("load_sharing.position_errors", shown, allowed, remedy))
    if sharing.method == "closed-form":
        problems += _check_closed_form(sharing, gearing)
    if sharing.method == "direct" and count == 1 and sharing.floating_member != "none":
        shown = f'"{sharing.floating_member}"'
        allowed = "must be supported: one planet cannot hold it in place."
        remedy = 'Write floating_member = "none".'
        problems.append(Problem("load_sharing.floating_member", shown, allowed, remedy))
    return problems


def _check_closed_form(sharing: LoadSharing, gearing: Gearing) -> list[Problem]:
    reasons = []
    if (gearing.count or 1) < 3:
        reasons.append("three or more planets")
    if not are_evenly_spaced(gearing.planet_angles):
        reasons.append("equally spaced planets")
    if sharing.floating_member != "none" and sharing.support_stiffness > 0:
        reasons.append("a member that floats freely or none")
    return [
        Problem(
            "load_sharing.method", '"closed-form"', f"needs {reason}.", 'Write method = "direct".'
        )
        for reason in reasons
    ]


def _check_planet_tilt(models: PlanetaryModels, given: Collection[str]) -> list[Problem]:
    if models.planet_tilt == "left-out":
        return []
    reasons = {
        "needs [planet_bearing], in which the planet tilts.": "planet_bearing" not in given,
        'needs load_distribution = "compliance".': models.load_distribution != "compliance",
    }
    return [
        Problem("models.planet_tilt", '"coupled"', reason, 'Or write planet_tilt = "left-out".')
        for reason, holds in reasons.items()
        if holds
    ]


def _check_friction_table(table: FrictionTable) -> list[Problem]:
    axes = table.axes()
    known = ", ".join(FrictionTable.AXES)
    if not 1 <= len(axes) <= 2:
        allowed = f"must have one or two of the axes {known}."
        remedy = "Give the values of the axes to which the coefficients belong."
        return [Problem("friction_table", f"{len(axes)} axes", allowed, remedy)]
    problems = rising_problems(axes, "friction_table.")
    wanted = " x ".join(f"{len(points)}" for points in axes.values())
    if table.shape() != tuple(len(points) for points in axes.values()):
        shown = f"{len(table.friction)} entries"
        allowed = f"must have {wanted} values, for the points of {' and '.join(axes)}."
        remedy = "Give one value, or one row, for each value of the first axis."
        problems.append(Problem("friction_table.friction", shown, allowed, remedy))
    return problems


def _check_friction_model(models: GearPairModels, given: Collection[str]) -> list[Problem]:
    if models.friction != "table" or "friction_table" in given:
        return []
    remedy = "Add [friction_table], or choose another model."
    return [Problem("models.friction", '"table"', "needs a table of coefficients.", remedy)]


def check_oil_model(models: GearPairModels, folder: Path, lubricant: Table | None) -> list[Problem]:
    """A fitted model needs its file or one built in for the oil, and in it what is asked of it."""
    asked = {
        key: quantity
        for key, quantity in FITTED_QUANTITIES.items()
        if getattr(models, key, "").startswith("fitted")
    }
    if not asked and models.oil_model is None:
        return []
    try:
        model = _oil_model(models, folder, lubricant)
    except InputError as error:
        return list(error.problems)
    if not asked:
        return []
    if model is None:
        remedy = "Give models.oil_model, a file of 'epicyclic oil characterise'."
        why = "needs a file of fitted models: none is built in for this oil."
        return [Problem(f"models.{key}", f'"{getattr(models, key)}"', why, remedy) for key in asked]
    problems = []
    for key, quantity in asked.items():
        forms = (
            [fitted.form for fitted in model.fits[quantity].forms] if quantity in model.fits else []
        )
        if models.fitted_form not in forms:
            given = models.oil_model or f"that of {model.oil.name}"
            allowed = f"has no {quantity.replace('_', ' ')} of the form {models.fitted_form}."
            remedy = f"Choose another models.{key} or models.fitted_form."
            problems.append(Problem("models.oil_model", given, allowed, remedy))
    return problems


def _oil_model(models: GearPairModels, folder: Path, lubricant: Table | None) -> OilModel | None:
    # cases without fitted models need no kernel
    from epicyclic.contact.fitted_models import builtin_model, read_oil_model

    if models.oil_model is not None:
        return read_oil_model(folder / models.oil_model)
    if not isinstance(lubricant, Lubricant):
        return None
    return builtin_model(lubricant.oil)


def _check_pocketing_table(models: GearPairModels, folder: Path) -> list[Problem]:
    """That the file is one; whether it is for these pockets shows when they are known."""
    if models.pocketing_table is not None:
        from epicyclic.losses.pocket_tables import read_stored  # needs kernels

        try:
            read_stored(folder / models.pocketing_table)
        except InputError as error:
            return list(error.problems)
    return []


def _check_void(models: GearPairModels, surroundings: Surroundings) -> list[Problem]:
    """A void has less pressure than the surroundings."""
    if models.pocket_void_pressure < surroundings.pressure:
        return []
    shown = BAR.text(models.pocket_void_pressure)
    allowed = f"must be less than surroundings.pressure, {BAR.text(surroundings.pressure)}."
    return [Problem("models.pocket_void_pressure", shown, allowed, "Take 0.01 bar.")]


def _check_resolution(models: GearPairModels, numerics: Numerics) -> list[Problem]:
    """Influence coefficients of all positions must fit into memory."""
    positions, segments = numerics.mesh_positions, numerics.contact_segments
    if models.load_distribution != "compliance" or positions * segments**2 <= MOST_COEFFICIENTS:
        return []
    fitting = max(2, math.isqrt(MOST_COEFFICIENTS // positions))
    return [
        Problem(
            "numerics.contact_segments",
            str(segments),
            f"with {positions} mesh positions the influence coefficients of "
            'models.load_distribution = "compliance" would not fit into memory.',
            f"Take {fitting} or fewer; 30 are enough for 0.1 %.",
        )
    ]


_CHECKS: tuple[tuple[Callable[..., list[Problem]], tuple[str, ...]], ...] = (
    (_check_operation, ("operation",)),
    (check_rollers, ("planet_bearing",)),
    (check_cage, ("planet_bearing", "models")),
    (_check_friction_table, ("friction_table",)),
    (_check_resolution, ("models", "numerics")),
    (_check_void, ("models", "surroundings")),
    (check_thermal, ("thermal",)),
    (lambda it, run: check_outlet(it, run.oil_inlet_temperature), ("thermal", "operation")),
    (check_lubrication, ("lubrication",)),
    (check_sump, ("lubrication", "thermal")),
    (check_wetting, ("lubrication", "thermal")),
    (lambda it, _: check_immersion(it, ("sun", "ring", "carrier")), ("lubrication", "sun")),
    (lambda it, _: check_immersion(it, ("pinion", "gear")), ("lubrication", "pinion")),
)
