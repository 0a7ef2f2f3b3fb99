"""Rules across keys and tables: of a set, and of a train with its shafts and states.

Every function returns the problems it finds; none stops at the first. A check runs only if the
tables that it needs are valid by themselves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from epicyclic.case.expand import expand
from epicyclic.case.tables.elements import Carrier, PlanetBearing, PlanetPin, ShaftBearingTable
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
    Lubricant,
    LubricationTable,
    PlanetaryOperation,
    Surroundings,
    ThermalTable,
    check_immersion,
    check_level,
    check_lubrication,
    check_outlet,
    check_sump,
    check_thermal,
    check_ways_out,
    check_wetting,
    needs_level,
)
from epicyclic.case.train_tables import ListedSet
from epicyclic.errors import InputError, Problem, rising_problems
from epicyclic.gears.assembly import set_problems
from epicyclic.gears.gear import CARRIER, HOUSING
from epicyclic.gears.gearing import Gearing
from epicyclic.gears.mesh import are_evenly_spaced
from epicyclic.gears.rules import gears_by_name
from epicyclic.losses.ranges import FITTED_QUANTITIES
from epicyclic.machine.train_shape import motion_problems, named_problems
from epicyclic.messages import did_you_mean, millimetres, part_name_problems, written
from epicyclic.oil.oil import Oil
from epicyclic.schema.fields import Table
from epicyclic.units import BAR

if TYPE_CHECKING:
    from epicyclic.case.case import TrainCase
    from epicyclic.contact.fitted_models import OilModel


MOST_COEFFICIENTS = 5_000_000
"""Largest number of influence coefficients for each contact line: 40 MB, for three lines 120 MB."""
MOST_LONGER = 3.0  # A bearing over the faces of its planet, which may have a hub; estimate. [1]


def cross_check(
    sections: Mapping[str, Table],  # The tables that are valid by themselves.
    given: Collection[str],  # Names of the tables that the case has, valid or not.
    folder: Path,  # Where the files lie that the case names.
    gearing: Gearing | None = None,  # Of a planetary set or a pair whose gears are sound.
    fresh: Collection[str] | None = None,  # Tables that changed since it was checked; None: all.
) -> Iterator[Problem]:
    """Problems between keys and tables of a case."""
    models = sections.get("models")
    if isinstance(models, GearPairModels):
        yield from _check_models(models, sections, {*given, *sections}, folder)
    operation = sections.get("operation")
    if isinstance(operation, PlanetaryOperation):
        allowed = f'must be a different member from operation.input, "{operation.input}".'
        for key in ("fixed", "second_input"):
            if getattr(operation, key) == operation.input:
                yield Problem(f"operation.{key}", "", allowed, "Name one of the other two.")
    solver = sections.get("contact_solver")
    if isinstance(solver, ContactSolver):
        yield from law_problems("contact_solver", solver)
    thermal, oil = sections.get("thermal"), sections.get("lubrication")
    if isinstance(models, GearPairModels) and isinstance(thermal, ThermalTable):
        own = oil if isinstance(oil, LubricationTable) else None
        yield from check_ways_out(thermal, models.temperatures, own)
    if gearing is not None:
        yield from set_problems(gearing) if fresh is None else ()
        carrier = sections.get("carrier") if fresh is None or "carrier" in fresh else None
        yield from _too_small(carrier, gearing) if isinstance(carrier, Carrier) else ()
        for key in ("planet_bearing", "planet_pin"):
            bearing = sections.get(key) if fresh is None or key in fresh else None
            if isinstance(bearing, PlanetBearing | PlanetPin) and gearing.planets:
                yield from check_bores(gearing, key, bearing, gearing.planets)
    sharing = sections.get("load_sharing")
    toothed = {"sun", "planet", "ring"} <= sections.keys()
    if isinstance(sharing, LoadSharing) and toothed and (fresh is None or "load_sharing" in fresh):
        # tooth numbers are enough, whether the gears fit or not
        yield from _check_load_sharing(sharing, gearing or expand({"gears": None, **sections})[0])
    for kind in ("planet", "thrust"):
        if getattr(bearing := sections.get(f"{kind}_bearing"), "designation", None):
            from epicyclic.losses.designations import unlike  # cases without one need it not

            yield from unlike(kind, bearing, f"{kind}_bearing.")
    for check, needed in _CHECKS:
        if all(name in sections for name in needed):
            yield from check(*(sections[name] for name in needed))


def check_rollers(bearing: PlanetBearing, key: str = "planet_bearing") -> Iterator[Problem]:
    """The rollers of the bearing at `key` must fit around its pin."""
    pitch_diameter = bearing.pin_diameter + bearing.roller_diameter + bearing.diametral_clearance
    room = math.pi / math.asin(min(1.0, bearing.roller_diameter / pitch_diameter))
    if bearing.rollers_per_row > room:
        allowed = f"only {math.floor(room)} rollers of {millimetres(bearing.roller_diameter)} fit "
        allowed += f"around the pin of {millimetres(bearing.pin_diameter)}."
        yield Problem(f"{key}.rollers_per_row", "", allowed, "Use fewer or thinner rollers.")


def _too_open(carrier: Carrier) -> list[Problem]:
    allowed = f"must be at most carrier.width, {millimetres(carrier.width)}."
    remedy = "Give the distance between its plates, or leave it out for a closed disc."
    return [Problem("carrier.open_width", millimetres(carrier.open_width), allowed, remedy)]


def _too_small(carrier: Carrier, gearing: Gearing) -> Iterator[Problem]:
    """A carrier must reach the pins of its planets."""
    circle = 2 * max(gearing.pin_radii(gearing.distances).values(), default=0.0)
    if carrier.outer_diameter < circle:
        allowed = f"must reach the circle of the pins, {millimetres(circle)}."
        shown = millimetres(carrier.outer_diameter)
        yield Problem("carrier.outer_diameter", shown, allowed, "Give its outside.")


def check_bores(
    gearing: Gearing,
    key: str,
    bearing: PlanetBearing | PlanetPin,  # The table at this key.
    planets: Iterable[str],  # That it carries.
) -> Iterator[Problem]:
    """A bearing must fit into the root circles of its planets."""
    sound, _ = gears_by_name(gearing)  # others are reported with the gears
    bore = bearing.pin_diameter + bearing.diametral_clearance
    longest, length = f"{key}.length", getattr(bearing, "length", 0.0)
    if isinstance(bearing, PlanetBearing):
        bore += 2 * bearing.roller_diameter
        longest = f"{key}.roller_length"
        length = bearing.rows * (bearing.roller_length + bearing.row_gap) - bearing.row_gap
    for body in planets:
        width = sum(sound[it].face_width for it in gearing.gears_of(body) if it in sound)
        if length > MOST_LONGER * width > 0:
            reason = f"is {millimetres(length)} in all, in planets {millimetres(width)} wide."
            yield Problem(longest, "", reason, "Correct the lengths, or the face width.")
        roots = [sound[it].root_radius for it in gearing.gears_of(body) if it in sound]
        if roots and bore >= 2 * min(roots):
            allowed = f"the planet's bore of {millimetres(bore)} reaches its root circle of "
            allowed += f"{millimetres(2 * min(roots))}."
            remedy = "Use a thinner pin or thinner rollers."
            yield Problem(f"{key}.pin_diameter", "", allowed, remedy)


def check_listed_bearings(table: ListedSet, gearing: Gearing) -> Iterator[Problem]:
    """Problems of the bearings that a listed set has for each kind of planets."""
    own = table.planet_bearings
    for name, bearing in own.items():
        from epicyclic.losses.designations import unlike  # sets without any need it not

        yield from check_rollers(bearing, f"planet_bearings.{name}")
        yield from unlike("planet", bearing, f"planet_bearings.{name}.")
        yield from check_cage(bearing, table.models)
    for body in gearing.planets:
        if body in own:
            yield from check_bores(gearing, f"planet_bearings.{body}", own[body], [body])
    others = [body for body in gearing.planets if body not in own]
    for key in ("planet_bearing", "planet_pin"):
        if (bearing := getattr(table, key)) is not None:
            yield from check_bores(gearing, key, bearing, others)


def _both_bearings(_: PlanetBearing, __: PlanetPin) -> Iterator[Problem]:
    allowed = "is given together with [planet_bearing]; a planet turns on one of them."
    yield Problem("planet_pin", "", allowed, "Delete one of the two tables.")


def listed_problems(table: ListedSet, gearing: Gearing) -> list[Problem]:
    """Problems of the tables that a listed set has beside its gears."""
    problems, known = list(name_problems(gearing)), gearing.terms
    for name in table.losses:
        if name not in known:
            remedy = did_you_mean(name, known) or f"The losses are {', '.join(known)}."
            problems.append(Problem(f"losses.{name}", "", "is not a loss of this set.", remedy))
    problems += _planet_problems(table, gearing)
    if table.carrier is not None:
        problems += _too_small(table.carrier, gearing)
        if table.carrier.open_width > table.carrier.width:
            problems += _too_open(table.carrier)
    return [*problems, *_sharing_problems(table)]


def name_problems(gearing: Gearing) -> Iterator[Problem]:
    """Names that would give two losses or members the same name."""
    for name in (CARRIER, HOUSING) if gearing.planets else (HOUSING,):
        if name in gearing.bodies or name in gearing.bodies.values():
            allowed = f"cannot be the name of a gear or body, because every set has a {name}."
            yield Problem(f"gears.{name}", "", allowed, "Choose another name.")
    for name in dict.fromkeys((*gearing.bodies, *gearing.bodies.values())):
        yield from part_name_problems(f'gears."{name}"', name, "gear")


def _planet_problems(table: ListedSet, gearing: Gearing) -> Iterator[Problem]:
    """Planets without a number, and a carrier or bearings without planets."""
    if gearing.planets and table.planets is None:
        names = ", ".join(gearing.planets)
        allowed = f"is missing, and the set has planets ({names})."
        remedy = "Add planets = 3, or the actual number."
        yield Problem("planets", "", allowed, remedy)
    if not gearing.planets:
        remedy = "Leave it out, or write planet = true at the gears on a carrier."
        if table.planets is not None:
            allowed = "is given, but no gear is on a carrier."
            yield Problem("planets", str(table.planets), allowed, remedy)
        for name in ("planet_bearing", "planet_pin", "carrier"):
            if getattr(table, name) is not None:
                yield Problem(name, "", "belongs to planets, and the set has none.", remedy)
    for name in table.planet_bearings:
        if name not in gearing.planets:
            remedy = did_you_mean(name, gearing.planets)
            remedy = remedy or f"The planet bodies are {', '.join(gearing.planets) or 'none'}."
            key = f"planet_bearings.{name}"
            yield Problem(key, "", "is not a planet body of this set.", remedy)
    placed = {gearing.planet_of(mesh) for mesh in gearing.meshes}
    for body in gearing.planets:
        if body not in placed:
            gear = gearing.gears_of(body)[0]
            allowed = "meshes with planets only, so its pin position is undetermined."
            remedy = "Add a mesh with a central gear."
            yield Problem(f"gears.{gear}", "", allowed, remedy)
    in_pairs = any(gearing.planet_pair(mesh) for mesh in gearing.meshes)
    if table.models.planet_tilt == "coupled" and in_pairs:
        allowed = "does not apply to planets that mesh with each other."
        remedy = 'Write planet_tilt = "left-out".'
        yield Problem("models.planet_tilt", '"coupled"', allowed, remedy)


def _sharing_problems(table: ListedSet) -> Iterator[Problem]:
    sharing, planets = table.load_sharing, table.planets or 1
    if sharing.method not in ("equal", "mesh-load-factor"):
        allowed = "applies only to sets with one sun, one ring and planets between them."
        remedy = 'Write method = "equal" or "mesh-load-factor".'
        yield Problem("load_sharing.method", f'"{sharing.method}"', allowed, remedy)
    if sharing.mesh_load_factor > planets:
        yield _most_loaded(sharing, "planets", planets)


def check_cage(bearing: PlanetBearing, models: PlanetaryModels) -> Iterator[Problem]:
    """The model of the bearing loss must be for bearings of this kind."""
    spherical, caged = bearing.type == "spherical", bearing.cage == "caged"
    if spherical and models.bearing not in ("auto", "palmgren"):
        allowed = "has no spherical rollers."
        remedy = 'Write bearing = "palmgren" or "auto".'
        yield Problem("models.bearing", f'"{models.bearing}"', allowed, remedy)
    elif spherical and models.planet_tilt == "coupled":
        allowed = "does not apply to spherical roller bearings, which align themselves."
        yield Problem("models.planet_tilt", '"coupled"', allowed, 'Write "left-out".')
    elif caged and models.bearing == "full-complement":
        allowed = "applies to rollers without a cage."
        yield Problem("models.bearing", '"full-complement"', allowed, 'Write "mixed-ehl".')
    elif models.bearing == "full-complement":
        given = full = bearing.rollers_per_row
        while not any(check_rollers(bearing.model_copy(update={"rollers_per_row": full + 1}))):
            full += 1
        if full > given:
            allowed, remedy = f"is not full; {full} fit.", f"Write rollers_per_row = {full}."
            yield Problem("planet_bearing.rollers_per_row", f"{given}", allowed, remedy)
    elif not caged and models.bearing == "mixed-ehl":
        allowed = "applies to caged bearings; rollers of a full-complement bearing rub on each "
        allowed += "other, and this friction is not included."
        remedy = 'Write bearing = "full-complement" or "palmgren".'
        yield Problem("models.bearing", '"mixed-ehl"', allowed, remedy)


def _check_load_sharing(sharing: LoadSharing, gearing: Gearing) -> Iterator[Problem]:
    count, key, method = gearing.count or 1, "load_sharing.method", sharing.method
    if sharing.mesh_load_factor > count:
        yield _most_loaded(sharing, gearing.count_key, count)
    if len(sharing.position_errors or ()) not in (0, count):
        allowed = f"must have one value for each of the {count} planets."
        remedy = "Give as many values as there are planets."
        yield Problem("load_sharing.position_errors", "", allowed, remedy)
    if method == "closed-form":
        floats = sharing.floating_member == "none" or sharing.support_stiffness == 0
        needs = {
            "three or more planets": count >= 3,
            "equally spaced planets": are_evenly_spaced(gearing.planet_angles),
            "a member that floats freely or none": floats,
        }
        for need, met in needs.items():
            if not met:
                yield Problem(key, "", f"needs {need}.", 'Write method = "direct".')
    if method == "direct" and count == 1 and sharing.floating_member != "none":
        shown = f'"{sharing.floating_member}"'
        allowed = "must be supported: one planet cannot hold it in place."
        remedy = 'Write floating_member = "none".'
        yield Problem("load_sharing.floating_member", shown, allowed, remedy)


def _most_loaded(sharing: LoadSharing, key: str, planets: int) -> Problem:
    """One planet cannot have more than all the load; `key` says how many there are."""
    shown = f"{sharing.mesh_load_factor:g}"
    allowed = f"must be at most {key}, {planets}: one planet then carries all load."
    return Problem("load_sharing.mesh_load_factor", shown, allowed, "Use a smaller factor.")


def _check_models(
    models: GearPairModels, sections: Mapping[str, Table], given: Collection[str], folder: Path
) -> Iterator[Problem]:
    """Models must have the tables and files that they need."""
    if models.friction == "table" and "friction_table" not in given:
        remedy = "Add [friction_table], or choose another model."
        yield Problem("models.friction", "", "needs a table of coefficients.", remedy)
    if "lubricant" in sections or models.oil_model is not None:  # a train has that of its sets
        yield from check_oil_model(models, folder, sections.get("lubricant"))
    if models.pocketing_table is not None:
        from epicyclic.losses.pocket_tables import read_stored  # needs kernels

        try:  # whether it is for these pockets shows when they are known
            read_stored(folder / models.pocketing_table)
        except InputError as error:
            yield from error.problems
    around, numerics = sections.get("surroundings"), sections.get("numerics")
    if isinstance(around, Surroundings) and models.pocket_void_pressure >= around.pressure:
        shown = BAR.text(models.pocket_void_pressure)  # a void has less
        allowed = f"must be less than surroundings.pressure, {BAR.text(around.pressure)}."
        usual = "0.01 bar" if around.pressure > BAR.parse("0.01 bar") else "0 bar"
        yield Problem("models.pocket_void_pressure", shown, allowed, f"Take {usual}.")
    if isinstance(numerics, Numerics) and models.load_distribution == "compliance":
        positions, segments = numerics.mesh_positions, numerics.contact_segments
        if positions * segments**2 > MOST_COEFFICIENTS:
            allowed = f"with {positions} mesh positions the influence coefficients of "
            allowed += 'models.load_distribution = "compliance" would not fit into memory.'
            fitting = max(2, math.isqrt(MOST_COEFFICIENTS // positions))
            remedy = f"Use {fitting} or fewer; 30 are enough for 0.1 %."
            yield Problem("numerics.contact_segments", "", allowed, remedy)
    if isinstance(models, PlanetaryModels) and models.planet_tilt == "coupled":
        key, remedy = "models.planet_tilt", 'Or write planet_tilt = "left-out".'
        if "planet_bearing" not in given:
            allowed = "needs [planet_bearing], because the planet tilts in it."
            yield Problem(key, "", allowed, remedy)
        if models.load_distribution != "compliance":
            yield Problem(key, "", 'needs load_distribution = "compliance".', remedy)


def _check_friction_table(table: FrictionTable) -> list[Problem]:
    axes = table.axes()
    known = ", ".join(FrictionTable.AXES)
    if not 1 <= len(axes) <= 2:
        allowed = f"must have one or two of the axes {known}."
        remedy = "Give the values of the axes to which the coefficients belong."
        return [Problem("friction_table", f"{len(axes)} axes", allowed, remedy)]
    problems = rising_problems(axes, "friction_table.")
    rows, *columns = (len(points) for points in axes.values())
    if [np.shape(row) for row in table.friction] != [tuple(columns)] * rows:
        shown = f"{len(table.friction)} entries"
        wanted = " x ".join(map(str, (rows, *columns)))
        allowed = f"must have {wanted} values, for the points of {' and '.join(axes)}."
        remedy = "Give one value, or one row, for each value of the first axis."
        problems.append(Problem("friction_table.friction", shown, allowed, remedy))
    return problems


def check_oil_model(
    models: GearPairModels, folder: Path, lubricant: Table | None
) -> Iterator[Problem]:
    """A fitted model needs its file or one built in for the oil, and in it what is asked of it."""
    asked = {
        key: quantity
        for key, quantity in FITTED_QUANTITIES.items()
        if getattr(models, key, "").startswith("fitted")
    }
    if not asked and models.oil_model is None:
        return
    try:
        oil = lubricant.oil if isinstance(lubricant, Lubricant) else None
        model = oil_model_of(models, folder, oil)
    except InputError as error:
        yield from error.problems
        return
    for key, quantity in asked.items():
        if model is None:
            remedy = "Give models.oil_model, a file of 'epicyclic oil characterise'."
            allowed = "needs a file of fitted models, because none is built in for this oil."
            yield Problem(f"models.{key}", f'"{getattr(models, key)}"', allowed, remedy)
            continue
        forms = model.fits[quantity].forms if quantity in model.fits else ()
        if models.fitted_form not in [fitted.form for fitted in forms]:
            given = models.oil_model or f"the file for {model.oil.name}"
            allowed = f"has no {quantity.replace('_', ' ')} in the form {models.fitted_form}."
            remedy = f"Choose another models.{key} or models.fitted_form."
            yield Problem("models.oil_model", given, allowed, remedy)


def oil_model_of(models: GearPairModels, folder: Path, oil: Oil | None) -> OilModel | None:
    """The fitted models of a file that a case names, or those built in for its oil, if any."""
    # cases without fitted models need no kernel
    from epicyclic.contact.fitted_models import builtin_model, read_oil_model

    if models.oil_model is not None:
        return read_oil_model(folder / models.oil_model)
    return None if oil is None else builtin_model(oil)


_CHECKS: tuple[tuple[Callable[..., Iterable[Problem]], tuple[str, ...]], ...] = (
    (check_rollers, ("planet_bearing",)),
    (lambda it: _too_open(it) if it.open_width > it.width else (), ("carrier",)),
    (check_cage, ("planet_bearing", "models")),
    (_both_bearings, ("planet_bearing", "planet_pin")),
    (_check_friction_table, ("friction_table",)),
    (check_thermal, ("thermal",)),
    (lambda it, run: check_outlet(it, run.oil_inlet_temperature), ("thermal", "operation")),
    (check_lubrication, ("lubrication",)),
    (lambda it, _: check_level(it), ("lubrication", "operation")),
    (check_sump, ("lubrication", "thermal")),
    (check_wetting, ("lubrication", "thermal")),
    (lambda it, _: check_immersion(it, ("sun", "ring", "carrier")), ("lubrication", "sun")),
    (lambda it, _: check_immersion(it, ("pinion", "gear")), ("lubrication", "pinion")),
)


# Can a train run as stated: shafts, states, freedom, oil around its sets, forces on bearings?


def lubrication_problems(train: TrainCase) -> Iterator[Problem]:
    """What cannot be about the lubrication of the sets; a shared table is checked by itself."""
    if train.lubrication is not None and train.lubrication.immersion:
        allowed = "must be given for each set, because it names gears of the set."
        remedy = "Write [sets.NAME.lubrication], or give oil_level."
        yield Problem("lubrication.immersion", "", allowed, remedy)
    yield from _level_problems(train)
    for name, table in train.computed_sets:
        own = table.lubrication
        if own is None or own == train.lubrication:
            continue
        if train.lubrication is None:
            # the oil around everything that is in no set follows from the train's own table
            allowed = "needs [lubrication] of the train, which it then replaces for this set."
            remedy = "Add it for all other parts."
            if own.method == "dip":
                remedy = "Add it for all other parts; they need no level if each set has its own."
            yield Problem(f"sets.{name}.lubrication", "", allowed, remedy)
        found = [*check_sump(own, train.thermal), *check_wetting(own, train.thermal)]
        if train.shape.sets[name].listed:
            found += check_immersion(own, train.shape.sets[name].members)
        yield from (replace(problem, key=_key(name, problem.key)) for problem in found)


def _level_problems(train: TrainCase) -> Iterator[Problem]:
    """What is wrong with the oil level of the housing, or missing from that of a set."""
    tables = {name: table.lubrication for name, table in train.computed_sets}
    dips = [name for name, table in tables.items() if table and needs_level(table)]
    own = train.housing
    if own is None and dips:
        keys = [f"sets.{name}.lubrication.oil_level" for name in dips]
        keys = ["lubrication.oil_level"] if len(set(tables.values())) == 1 else keys
        allowed = 'is missing, but method = "dip" needs it, or immersion.'
        remedy = 'Give one level for all sets: [housing] with oil_level = "-30 mm" above the axis '
        remedy += f"of {train.operation.input}; or the level or immersion of each set."
        yield Problem(", ".join(keys), "", allowed, remedy)
    if own is None:
        return
    if not dips:
        allowed = "has no effect: no set dips without stating its own level or immersion."
        remedy = 'Remove it, or give [lubrication] with method = "dip" and oil_volume alone.'
        yield Problem("housing", "", allowed, remedy)
    origin = own.shaft or train.operation.input
    if train.shape.shaft_of(origin) is None or origin == HOUSING:
        remedy = did_you_mean(origin, train.shape.names) or "Name a shaft."
        yield Problem("housing.shaft", written(origin), "is not a shaft that turns.", remedy)
        return
    places = train.oil_heights
    for name in dips:
        if name not in places:
            allowed = f"is missing: no gears of known places join {name} to {origin}."
            remedy = "Give it, or lubrication.immersion, for this set."
            yield Problem(f"sets.{name}.lubrication.oil_level", "", allowed, remedy)


def _key(name: str, keys: str) -> str:
    """Keys of a set as those of the train."""
    return ", ".join(
        f"sets.{name}.{key}" if key.startswith("lubrication") else key for key in keys.split(", ")
    )


_NARROWEST = 50.0  # Bore over width that no bearing has; thin sections reach 48 (catalogues). [1]
GIVE_FORCE = "Or give radial_force (and axial_force) of the bearings of this shaft."


def needs_force(table: ShaftBearingTable) -> bool:
    """True if the force on a bearing is to be found from those of the gears."""
    by_load = table.table is None or table.table.radial_force is not None
    stated = table.radial_force is not None or table.type.startswith("thrust")
    return not stated and (table.model != "table" or by_load)


def borne_shafts(train: TrainCase) -> dict[str, dict[str, ShaftBearingTable]]:
    """The bearings whose forces are computed, by the shafts that there are and their names."""
    bearings: dict[str, dict[str, ShaftBearingTable]] = {}
    for kind, name, table in train.elements:
        if kind == "bearings" and isinstance(table, ShaftBearingTable) and needs_force(table):
            shaft = train.shape.names.get(table.shaft)
            if shaft is not None:
                bearings.setdefault(shaft, {})[name] = table
    return bearings


def bearing_force_problems(train: TrainCase, complete: bool) -> Iterator[Problem]:
    """What is missing for the forces on shaft bearings, shaft by shaft.

    Nothing is said of the gears on shafts whose members are not `complete`.
    """
    for shaft, own in borne_shafts(train).items():
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
        allowed = f"has {len(own)} bearings on {shaft}; statics gives the forces on only two."
        yield Problem("bearings", names, allowed, "Give radial_force of all but two.")
    places = [table.position for table in own.values() if table.position is not None]
    pair = len(own) == 2 and all(table.is_angular for table in own.values())
    for name, table in own.items():
        for key in ("preload", "preload_displacement"):
            if table.is_angular and getattr(table, key) is not None and not pair:
                allowed = f"needs two tapered or angular contact bearings on {shaft}."
                yield Problem(f"bearings.{name}.{key}", "", allowed, "Delete it.")
    for keys in (("arrangement",), ("preload", "preload_displacement")):
        if len({getattr(table, key) for table in own.values() for key in keys} - {None}) > 1:
            allowed = f"is given in two ways for the bearings of {shaft}."
            yield Problem(f"bearings.{next(iter(own))}.{keys[0]}", "", allowed, "Give it once.")
    nearest = min(table.bore for table in own.values()) / _NARROWEST
    if len(own) == 2 and len(places) == 2 and abs(places[0] - places[1]) < nearest:
        key = f"bearings.{next(iter(own))}.position"
        allowed = f"is {millimetres(abs(places[0] - places[1]))} from the other bearing of {shaft}."
        yield Problem(key, millimetres(places[0]), allowed, "Correct one: bearings are wider.")


def _of_gears(train: TrainCase, shaft: str, own: dict[str, ShaftBearingTable]) -> Iterator[Problem]:
    """The forces of gears, and where they act."""
    names = ", ".join(own)
    if len(own) == 1 and any(True for _ in _gears(train, shaft)):
        allowed = f"is the only bearing of {shaft} without a given force, so gears would tilt it."
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


def operation_problems(train: TrainCase, complete: bool) -> list[Problem]:
    """What cannot be about the states and the operation of a train.

    Of a shape that is not `complete`, because some members or meshes are wrong, only that is told
    which these cannot change: a train that is blocked without them is blocked with them.
    """
    named = named_problems(train)
    problems = [
        *named,
        *check_outlet(train.thermal, train.operation.oil_inlet_temperature),
        *_temperature_problems(train),
        *(
            replace(problem, key=f"sets.{name}.{problem.key}")
            for name, table in train.computed_sets
            if table.models.oil_model is None  # those with a file have told
            for problem in check_oil_model(table.models, Path(), train.lubricant)
        ),
    ]
    if complete:
        problems += [*_position_problems(train), *lubrication_problems(train)]
    return problems if named else [*problems, *motion_problems(train, complete)]


def _temperature_problems(train: TrainCase) -> Iterator[Problem]:
    """Temperatures follow from losses that are computed, of the whole train."""
    kind, shown = train.models.temperatures, written(train.models.temperatures)
    for name, table in train.computed_sets:
        if (own := table.models.temperatures) not in ("inlet", kind):
            allowed = f"applies to the whole train, which has {shown}."
            remedy = "Leave it out here, and set models.temperatures of the train."
            yield Problem(f"sets.{name}.models.temperatures", written(own), allowed, remedy)
    oil = train.lubricant, train.operation.oil_inlet_temperature
    if kind == "flank" and not train.computed:
        allowed = "needs computed losses, but all sets have given efficiencies."
        remedy = 'Use "inlet" or "network", or give gears instead of efficiencies for the sets.'
        yield Problem("models.temperatures", shown, allowed, remedy)
    elif kind == "network" and not train.computed and None in oil:
        allowed = "needs [lubricant] and operation.oil_inlet_temperature."
        yield Problem("models.temperatures", shown, allowed, 'Give both, or use "inlet".')


def _position_problems(train: TrainCase) -> Iterator[Problem]:
    """Positions of gears that there are, and that stand on a shaft."""
    known = [
        f"{name}.{gear}"
        for name, own in train.shape.sets.items()
        for gear, body in own.bodies.items()
        if body not in own.planets
    ]
    members = [member for names in train.shape.shafts.values() for member in names]
    for gear in train.positions:
        if gear not in known and gear not in members:
            remedy = did_you_mean(gear, known) or f"Choose one of {', '.join(known)}."
            yield Problem(f'positions."{gear}"', "", "is not a gear on a shaft.", remedy)
