"""Rules across keys and tables: of a set, and of a train with its shafts and states."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from epicyclic.case.expand import expand
from epicyclic.case.fields import did_you_mean, millimetres, written
from epicyclic.case.gear_rules import gears_by_name
from epicyclic.case.gearing import Gearing
from epicyclic.case.set_rules import set_problems
from epicyclic.case.tables.base import Table
from epicyclic.case.tables.elements import PlanetBearing, ShaftBearingTable
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
from epicyclic.case.train_shape import TrainShape
from epicyclic.case.train_tables import ListedSet, StateTable
from epicyclic.errors import InputError, Problem, rising_problems
from epicyclic.gears.gear import HOUSING
from epicyclic.gears.mesh import are_evenly_spaced
from epicyclic.losses.ranges import FITTED_QUANTITIES
from epicyclic.units import BAR

if TYPE_CHECKING:
    from epicyclic.case.case import TrainCase
    from epicyclic.contact.fitted_models import OilModel
    from epicyclic.machine.machine import Machine


# Checks across keys and tables.
#
# Every function returns the problems it finds; none stops at the first. A check runs only if the
# tables that it needs are valid by themselves.


MOST_COEFFICIENTS = 5_000_000
"""Largest number of influence coefficients for each contact line: 40 MB, for three lines 120 MB."""


def cross_check(
    sections: Mapping[str, Table],  # The tables that are valid by themselves.
    given: Collection[str],  # Names of the tables that the case has, valid or not.
    folder: Path,  # Where the files lie that the case names.
    gearing: Gearing | None = None,  # Of a planetary set or a pair whose gears are sound.
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
    if gearing is not None:
        problems += set_problems(gearing)
        bearing = sections.get("planet_bearing")
        if isinstance(bearing, PlanetBearing) and gearing.planets:
            problems += check_bores(gearing, {"planet_bearing": (bearing, gearing.planets)})
    sharing = sections.get("load_sharing")
    if isinstance(sharing, LoadSharing) and {"sun", "planet", "ring"} <= sections.keys():
        # tooth numbers are enough, whether the gears fit or not
        own = gearing or expand({"gears": None, **sections})[0]
        problems += _check_load_sharing(sharing, own)
    for check, needed in _CHECKS:
        if all(name in sections for name in needed):
            problems += check(*(sections[name] for name in needed))
    return problems


def _check_operation(operation: PlanetaryOperation | GearPairOperation) -> list[Problem]:
    if not isinstance(operation, PlanetaryOperation):
        return []
    allowed = f'must be a different member from operation.input, "{operation.input}".'
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
    remedy = "Use fewer or thinner rollers."
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
            remedy = "Use a thinner pin or thinner rollers."
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
    allowed = "applies to caged bearings; rollers of a full-complement bearing rub on each other, "
    allowed += "and this friction is not included."
    return [Problem("models.bearing", '"mixed-ehl"', allowed, 'Write bearing = "palmgren".')]


def _check_load_sharing(sharing: LoadSharing, gearing: Gearing) -> list[Problem]:
    problems, count = [], gearing.count or 1
    if sharing.mesh_load_factor > count:
        shown = f"{sharing.mesh_load_factor:g}"
        allowed = f"must be at most planet.count, {count}: one planet then carries all load."
        remedy = "Use a smaller factor."
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
        "needs [planet_bearing], because the planet tilts in it.": "planet_bearing" not in given,
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
        why = "needs a file of fitted models, because none is built in for this oil."
        return [Problem(f"models.{key}", f'"{getattr(models, key)}"', why, remedy) for key in asked]
    problems = []
    for key, quantity in asked.items():
        forms = (
            [fitted.form for fitted in model.fits[quantity].forms] if quantity in model.fits else []
        )
        if models.fitted_form not in forms:
            given = models.oil_model or f"the file for {model.oil.name}"
            allowed = f"has no {quantity.replace('_', ' ')} in the form {models.fitted_form}."
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
            f"Use {fitting} or fewer; 30 are enough for 0.1 %.",
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


# Can a train run as stated: shafts, states, freedom, oil around its sets, forces on bearings?
#
# Every function returns the problems it finds; none stops at the first.


def lubrication_problems(train: TrainCase) -> list[Problem]:
    """What cannot be about the lubrication of the sets; a shared table is checked by itself."""
    problems: list[Problem] = []
    if train.lubrication is not None and train.lubrication.immersion:
        allowed = "must be given for each set, because it names gears of the set."
        remedy = "Write [sets.NAME.lubrication], or give oil_level."
        problems.append(Problem("lubrication.immersion", "", allowed, remedy))
    for name, table in train.computed_sets:
        own = table.lubrication
        if own is None or own == train.lubrication:
            continue
        if train.lubrication is None:
            # the oil around everything that is in no set follows from the train's own table
            allowed = "needs [lubrication] of the train, which it then replaces for this set."
            remedy = "Add it for all other parts."
            problems.append(Problem(f"sets.{name}.lubrication", "", allowed, remedy))
        found = [*check_sump(own, train.thermal), *check_wetting(own, train.thermal)]
        if train.shape.sets[name].listed:
            found += check_immersion(own, train.shape.sets[name].members)
        problems += [replace(problem, key=_key(name, problem.key)) for problem in found]
    return problems


def _key(name: str, keys: str) -> str:
    """Keys of a set as those of the train."""
    return ", ".join(
        f"sets.{name}.{key}" if key.startswith("lubrication") else key for key in keys.split(", ")
    )


GIVE_FORCE = "Or give radial_force (and axial_force) of the bearings of this shaft."


def needs_force(table: ShaftBearingTable) -> bool:
    """True if the force on a bearing is to be found from those of the gears."""
    by_load = table.table is None or table.table.radial_force is not None
    return table.radial_force is None and (table.model != "table" or by_load)


def bearing_force_problems(train: TrainCase, complete: bool) -> Iterator[Problem]:
    """What is missing for the forces on shaft bearings, shaft by shaft.

    Nothing is said of the gears on shafts whose members are not `complete`.
    """
    bearings: dict[str, dict[str, ShaftBearingTable]] = {}
    for kind, name, table in train.elements:
        if kind == "bearings" and isinstance(table, ShaftBearingTable) and needs_force(table):
            shaft = train.shape.names.get(table.shaft)
            if shaft is not None:
                bearings.setdefault(shaft, {})[name] = table
    for shaft, own in bearings.items():
        yield from _of_bearings(shaft, own)
        if complete:
            yield from _of_gears(train, shaft, own)


def _of_bearings(shaft: str, own: dict[str, ShaftBearingTable]) -> Iterator[Problem]:
    """Two bearings at two known places carry a shaft."""
    for name, table in own.items():
        if table.position is None:
            allowed = f"is missing: the force on the bearing depends on its position along {shaft}."
            remedy = f'Add position = "... mm". {GIVE_FORCE}'
            yield Problem(f"bearings.{name}.position", "", allowed, remedy)
    names = ", ".join(own)
    if len(own) > 2:
        allowed = f"has {len(own)} bearings on {shaft}; statics gives the forces of only two."
        yield Problem("bearings", names, allowed, "Give radial_force of all but two.")
    places = [table.position for table in own.values() if table.position is not None]
    if len(own) == 2 and len(places) == 2 and places[0] == places[1]:
        key = f"bearings.{next(iter(own))}.position"
        allowed = f"is also that of the other bearing of {shaft}."
        yield Problem(key, millimetres(places[0]), allowed, "Give them different positions.")


def _of_gears(train: TrainCase, shaft: str, own: dict[str, ShaftBearingTable]) -> Iterator[Problem]:
    """The forces of gears, and where they act."""
    names = ", ".join(own)
    if len(own) == 1 and any(True for _ in _gears(train, shaft)):
        allowed = f"is the only bearing of {shaft}, so the gear forces would tilt the shaft."
        yield Problem(f"bearings.{names}", "", allowed, f"Add a second bearing. {GIVE_FORCE}")
    for gear in _gears(train, shaft):
        if train.position_of(gear) is None:
            allowed = f"is missing, and the forces on the bearings {names} depend on it."
            remedy = f'Add "{gear}" = "... mm" to [positions]. {GIVE_FORCE}'
            yield Problem(f'positions."{gear}"', "", allowed, remedy)
    for name, gearing in train.shape.sets.items():
        if gearing.computed:
            continue
        if shaft in train.shape.bodies_of(name).values():
            allowed = f"is missing: the efficiency of {name} is given, so its forces are unknown."
            remedy = f"Give it for {names}."
            yield Problem(f"bearings.{next(iter(own))}.radial_force", "", allowed, remedy)


def _gears(train: TrainCase, shaft: str) -> Iterator[str]:
    """The gears on a shaft that push it aside: without planets all around them."""
    for name, gearing in train.shape.sets.items():
        if not gearing.computed or (gearing.planets and (gearing.count or 1) > 1):
            continue
        bodies = train.shape.bodies_of(name)
        for gear, body in gearing.bodies.items():
            if body not in gearing.planets and bodies[body] == shaft and shaft != HOUSING:
                yield f"{name}.{gear}"


def operation_problems(train: TrainCase, shape: TrainShape, complete: bool) -> list[Problem]:
    """What cannot be about the states and the operation of a train.

    Of a `shape` that is not `complete`, because some members or meshes are wrong, only that is told
    which these cannot change: a train that is blocked without them is blocked with them.
    """
    named: list[Problem] = []
    for name, state in train.states.items():
        named += state_problems(f"states.{name}", state, shape)
    named += _state_choice(train)
    operation = train.operation
    for key in ("input", "output"):
        named += _shaft_problems(f"operation.{key}", getattr(operation, key), shape)
    for key in ("speeds", "torques"):
        for name in getattr(operation, key):
            named += _shaft_problems(f"operation.{key}.{name}", name, shape)
    problems = [
        *named,
        *check_outlet(train.thermal, operation.oil_inlet_temperature),
        *_temperature_problems(train),
        *_oil_model_problems(train),
    ]
    if complete:
        problems += [*_position_problems(train, shape), *lubrication_problems(train)]
    if named:
        return problems
    ends = list(_ends_problems(train, shape, complete))
    return [*problems, *(ends or _freedom_problems(train, shape, complete))]


def _temperature_problems(train: TrainCase) -> list[Problem]:
    """Temperatures follow from losses that are computed, of the whole train."""
    found = [
        Problem(
            f"sets.{name}.models.temperatures",
            written(table.models.temperatures),
            f"applies to the whole train, which has {written(train.models.temperatures)}.",
            "Leave it out here, and set models.temperatures of the train.",
        )
        for name, table in train.computed_sets
        if table.models.temperatures not in ("inlet", train.models.temperatures)
    ]
    if train.models.temperatures != "inlet" and not train.computed:
        shown = written(train.models.temperatures)
        allowed = "needs computed losses, but all sets have given efficiencies."
        remedy = 'Use "inlet", or give gears instead of efficiencies for the sets.'
        found.append(Problem("models.temperatures", shown, allowed, remedy))
    return found


def _oil_model_problems(train: TrainCase) -> list[Problem]:
    """Sets that ask for fitted models of an oil that has none; those with a file have told."""
    return [
        replace(problem, key=f"sets.{name}.{problem.key}")
        for name, table in train.computed_sets
        if table.models.oil_model is None
        for problem in check_oil_model(table.models, Path(), train.lubricant)
    ]


def state_problems(key: str, state: StateTable, shape: TrainShape) -> list[Problem]:
    """Brakes and clutches on shafts that are not there, or on one shaft."""
    problems = []
    for number, name in enumerate(state.fixed):
        problems += _shaft_problems(f"{key}.fixed[{number}]", name, shape)
    for number, group in enumerate(state.joined):
        where, shown = f"{key}.joined[{number}]", written(list(group))
        found = [problem for name in group for problem in _shaft_problems(where, name, shape)]
        problems += found
        if len(group) < 2:
            allowed = "must name two or more shafts."
            problems.append(Problem(where, shown, allowed, "Name the shafts that a clutch joins."))
        elif not found:
            shafts = [shape.shaft_of(name) for name in group]
            if len(set(shafts)) < len(shafts):
                twice = next(one for one in shafts if shafts.count(one) > 1)
                allowed = f"joins the shaft {twice} to itself."
                problems.append(Problem(where, shown, allowed, "Name two different shafts."))
    return problems


def _position_problems(train: TrainCase, shape: TrainShape) -> Iterator[Problem]:
    """Positions of gears that there are, and that stand on a shaft."""
    known = [
        f"{name}.{gear}"
        for name, own in shape.sets.items()
        for gear, body in own.bodies.items()
        if body not in own.planets
    ]
    members = [member for names in shape.shafts.values() for member in names]
    for gear in train.positions:
        if gear not in known and gear not in members:
            remedy = did_you_mean(gear, known) or f"Choose one of {', '.join(known)}."
            yield Problem(f'positions."{gear}"', "", "is not a gear on a shaft.", remedy)


def _shaft_problems(key: str, name: str, shape: TrainShape) -> list[Problem]:
    if shape.shaft_of(name) is not None:
        return []
    known = [shaft for shaft in shape.shafts if shaft != HOUSING]
    members = [member for names in shape.shafts.values() for member in names]
    remedy = did_you_mean(name, dict.fromkeys([*known, *members]))
    remedy = remedy or f"Choose one of {', '.join(known)}."
    return [Problem(key, written(name), "is neither a shaft nor a member of a set.", remedy)]


def _state_choice(train: TrainCase) -> list[Problem]:
    name, known = train.operation.state, list(train.states)
    key = "operation.state"
    if name is None and known:
        allowed = f"is missing; it must be one of {', '.join(known)}."
        return [Problem(key, "", allowed, f'Write state = "{known[0]}".')]
    if name is not None and name not in known:
        if not known:
            allowed = "is not a state: the train has no states."
            return [Problem(key, written(name), allowed, "Leave it out, or add [states.NAME].")]
        remedy = did_you_mean(name, known) or f"Choose one of {', '.join(known)}."
        return [Problem(key, written(name), "is not a state of the train.", remedy)]
    return []


def _ends_problems(train: TrainCase, shape: TrainShape, complete: bool) -> Iterator[Problem]:
    """Input and output must be two shafts that can turn."""
    operation = train.operation
    ends = {key: shape.shaft_of(getattr(operation, key)) for key in ("input", "output")}
    groups = [{shape.shaft_of(name) for name in group} for group in train.state.joined]
    if ends["input"] == ends["output"]:
        allowed = "is also the input shaft."
        remedy = "Name another shaft; a train transmits power from one shaft to another."
        yield Problem("operation.output", written(operation.output), allowed, remedy)
    held = shape.held(train.state)
    turning = {*shape.turning(train.state), HOUSING}
    for key, shaft in ends.items():
        if complete and shaft not in turning:
            allowed = f"is not connected in {_state_words(train)}: it has no members, and no "
            allowed += "clutch on it is closed."
            shown = written(getattr(operation, key))
            yield Problem(f"operation.{key}", shown, allowed, "Close a clutch, or name another.")
            continue
        by_clutch = any(shaft in group and group & set(held) for group in groups)
        if shaft == HOUSING or shaft in held or by_clutch:
            allowed = "stands still with the housing."
            if shaft != HOUSING:
                allowed = f"is held by a brake in {_state_words(train)}."
            advice = "Name a shaft that turns, or release it."
            yield Problem(f"operation.{key}", written(getattr(operation, key)), allowed, advice)
    if complete:
        yield from _given_problems(train, shape, ends)


def _given_problems(
    train: TrainCase, shape: TrainShape, ends: Mapping[str, str | None]
) -> Iterator[Problem]:
    """Further speeds and torques: of shafts that turn, each once, and only one of the two."""
    operation = train.operation
    turning = shape.turning(train.state)
    held: dict[str | None, str] = dict.fromkeys((*shape.held(train.state), HOUSING), "held")
    driven = {shape.shaft_of(name): "given a speed" for name in operation.speeds}
    inputs: dict[str | None, str] = {ends["input"]: "the input"}
    output: dict[str | None, str] = {ends["output"]: "the output"}
    kinds = {
        "speeds": (operation.speeds, held | inputs),
        "torques": (operation.torques, held | driven | output | inputs),
    }
    for key, (values, taken) in kinds.items():
        seen: dict[str | None, str] = {}
        for name in values:
            shaft, allowed = shape.shaft_of(name), ""
            if shaft in taken:
                allowed = f"cannot be given: this shaft is {taken[shaft]}."
            elif shaft not in turning:
                allowed = f"cannot be given: it is not connected in {_state_words(train)}."
            elif shaft in seen:
                allowed = f"is given twice: {seen[shaft]} is the same shaft."
            seen[shaft] = name
            if allowed:
                yield Problem(f"operation.{key}.{name}", "", allowed, "Leave it out.")


def _freedom_problems(train: TrainCase, shape: TrainShape, complete: bool) -> list[Problem]:
    """The given speeds must determine all others, and the input must be able to turn."""
    from epicyclic.machine.balance import freedom, implied  # only trains need a machine

    machine = shape.machine(train.state)
    driven = shape.shaft_of(train.operation.input) or ""
    held = shape.held(train.state)
    others = [*held, *(shape.shaft_of(name) or "" for name in train.operation.speeds)]
    if not complete:  # without its members a shaft is no body
        others = [shaft for shaft in others if shaft in machine.bodies]
        if driven not in machine.bodies:
            return []
    found = freedom(machine, driven, others)
    key = "operation.state" if train.states else "shafts"
    shown = written(train.operation.state) if train.states else ""
    problems = []
    if found.blocked:
        means = _means(train.state, held, train.operation.speeds)
        reason = f"blocks the train, so the input shaft {driven} cannot turn" + (
            f" with {means}." if means else "."
        )
        remedy = "Release one of these." if means else ("Check the shafts.")
        problems.append(Problem(key, shown, reason, remedy))
    if not complete:
        return problems
    if found.loose:
        names = ", ".join(body for body in found.loose if body in shape.shafts)
        freedoms = found.freedoms
        word = "one" if freedoms == 1 else str(freedoms)
        problems.append(
            Problem(
                key,
                shown,
                f"leaves {word} degree{'s' if freedoms > 1 else ''} of freedom open: the speed of "
                f"{names} is not determined.",
                f"Hold or join {word} more of these shafts (fixed, joined), or give the speed "
                f"of {word} of them in [operation.speeds].",
            )
        )
    further = {shape.shaft_of(name) or "": name for name in train.operation.speeds}
    if not found.loose:
        for shaft in implied(machine, [driven, *held], list(further)):
            allowed = "cannot be given: this speed follows from those of the other shafts."
            key = f"operation.speeds.{further[shaft]}"
            problems.append(Problem(key, "", allowed, "Leave it out."))
    if problems or shape.shaft_of(train.operation.output) in further:
        return problems
    return _standing_output(train, shape, machine, driven, others)


def _standing_output(
    train: TrainCase, shape: TrainShape, machine: Machine, driven: str, others: Sequence[str]
) -> list[Problem]:
    """An output that the input does not turn can balance no torque of it."""
    from epicyclic.machine.balance import speeds_of

    output = train.operation.output
    speeds = speeds_of(machine, dict.fromkeys(others, 0.0) | {driven: 1.0})
    if speeds[shape.shaft_of(output) or ""] != 0:
        return []
    allowed = f"stands still at any speed of the input shaft {driven} in {_state_words(train)}, so "
    allowed += "no power reaches it."
    turning = [shaft for shaft in shape.shafts if speeds[shaft] != 0 and shaft != driven]
    remedy = f"Name a shaft that turns with the input: {', '.join(turning)}."
    if not turning:
        remedy = "Join it to the input."
    return [Problem("operation.output", written(output), allowed, remedy)]


def _state_words(train: TrainCase) -> str:
    name = train.operation.state
    return "this train" if name is None else f"state {name}"


def _means(state: StateTable, held: Sequence[str], speeds: Mapping[str, float]) -> str:
    parts = []
    if held:
        parts.append(f"{', '.join(held)} held")
    if state.joined:
        parts.append(f"{', '.join('+'.join(group) for group in state.joined)} joined")
    if speeds:
        parts.append(f"the speed of {', '.join(speeds)} given")
    return " and ".join(parts)
