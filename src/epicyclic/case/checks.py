"""Checks across keys and tables: can these gears be made, assembled and run?

Every function returns the problems it finds; none stops at the first. A check runs only if the
tables that it needs are valid by themselves.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from epicyclic.case import build
from epicyclic.case.schema import (
    FrictionTable,
    Gears,
    GearTable,
    PairGear,
    Planet,
    PlanetaryModels,
    PlanetaryOperation,
    PlanetBearing,
    Ring,
    Table,
)
from epicyclic.errors import Problem
from epicyclic.geometry.assembly import nearest_admissible_angle, smallest_planet_gap
from epicyclic.geometry.gear import Gear
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.outline import form_radius

__all__ = ["cross_check"]

ANGLE_TOLERANCE = math.radians(0.01)
"""Given planet positions may differ by this from an admissible one: drawing precision. [rad]"""

ROUNDING = 1e-9
"""Clearances count as negative beyond this: drawings may state exactly zero. [m]"""

Sections = Mapping[str, Table]


def cross_check(sections: Sections) -> list[Problem]:
    """Problems between keys and tables of the valid `sections` of a case."""
    problems: list[Problem] = []
    for check, needed in _CHECKS:
        if all(name in sections for name in needed):
            problems += check(*(sections[name] for name in needed))
    models = sections.get("models")
    if getattr(models, "friction", "") == "table" and "friction_table" not in sections:
        problems.append(
            Problem(
                "models.friction", '"table"', "needs a table of coefficients.",
                "Add [friction_table], or choose another model.",
            )
        )  # fmt: skip
    return problems


def _mm(value: float) -> str:
    return f"{value * 1e3:.4g} mm"


def _check_operation(operation: PlanetaryOperation, _planet: Planet) -> list[Problem]:
    problems = []
    for key in ("fixed", "second_input"):
        if getattr(operation, key) == operation.input:
            problems.append(
                Problem(
                    f"operation.{key}",
                    operation.input,
                    "must be another member than operation.input.",
                    "Name one of the other two.",
                )
            )
    return problems


def _check_planetary(gears: Gears, sun: GearTable, planet: Planet, ring: Ring) -> list[Problem]:
    tables = {"sun": sun, "planet": planet, "ring": ring}
    built, problems = _build(gears, tables)
    for name, member in built.items():
        problems += _check_gear(name, member)
    if problems:
        return problems
    for mesh in build.planetary_meshes(gears, sun, planet, ring):
        problems += _check_mesh(mesh, tables)
    return problems + _check_planet_positions(gears, sun, planet, ring)


def _check_pair(gears: Gears, pinion: GearTable, gear: PairGear) -> list[Problem]:
    tables = {"pinion": pinion, "gear": gear}
    built, problems = _build(gears, tables)
    for name, member in built.items():
        problems += _check_gear(name, member)
    if not problems:
        problems += _check_mesh(build.pair_mesh(gears, pinion, gear), tables)
    return problems


def _build(
    gears: Gears, tables: Mapping[str, GearTable]
) -> tuple[dict[str, Gear], list[Problem]]:
    built: dict[str, Gear] = {}
    problems = []
    for name, table in tables.items():
        try:
            built[name] = build.gear(name, table, gears)
        except ValueError:
            problems.append(
                Problem(
                    f"{name}.thickness_diameter",
                    _mm(table.thickness_diameter or 0.0),
                    "lies inside the base circle, where there is no involute.",
                    "Give the tooth thickness at a larger diameter.",
                )
            )
    return built, problems


def _check_gear(name: str, gear: Gear) -> list[Problem]:
    problems = []
    inner, outer = (
        ("tip_diameter", "root_diameter") if gear.internal else ("root_diameter", "tip_diameter")
    )
    small, large = sorted((gear.tip_radius, gear.root_radius))
    if (small == gear.root_radius) == gear.internal or small == large:
        problems.append(
            Problem(
                f"{name}.tip_diameter",
                _mm(2 * gear.tip_radius),
                f"with root_diameter {_mm(2 * gear.root_radius)} leaves no tooth.",
                f"{inner} must be smaller than {outer} "
                f"({'an internal' if gear.internal else 'an external'} gear).",
            )
        )
        return problems
    if gear.tip_radius <= gear.base_radius:
        problems.append(
            Problem(
                f"{name}.tip_diameter",
                _mm(2 * gear.tip_radius),
                f"lies inside the base circle of {_mm(2 * gear.base_radius)}, so that the tooth "
                "has no involute at its tip.",
                "Increase it.",
            )
        )
    elif gear.thickness_at(gear.tip_radius) <= 0:
        problems.append(
            Problem(
                f"{name}.tip_diameter",
                _mm(2 * gear.tip_radius),
                "the teeth are pointed before the tip circle.",
                "Shorten the teeth or make them thicker (tooth_thickness, profile shift).",
            )
        )
    elif gear.half_angle_at(max(gear.root_radius, gear.base_radius)) >= math.pi / gear.teeth:
        problems.append(
            Problem(
                f"{name}.root_diameter",
                _mm(2 * gear.root_radius),
                "there is no space left between the teeth at the root.",
                "Make the teeth thinner or less deep.",
            )
        )
    return problems


def _check_mesh(mesh: Mesh, tables: Mapping[str, GearTable]) -> list[Problem]:
    one, two = mesh.gear1.name, mesh.gear2.name
    bases = mesh.gear2.base_radius + mesh.side * mesh.gear1.base_radius
    if bases <= 0 or bases >= mesh.center_distance:
        return [
            Problem(
                "gears.center_distance",
                _mm(mesh.center_distance),
                f"must exceed {_mm(bases)}, the {'difference' if mesh.internal else 'sum'} of the "
                f"base radii of {one} and {two}, and a ring needs more teeth than its planet.",
                "Check tooth numbers, module and centre distance.",
            )
        ]
    problems = _check_clearances(mesh)
    total = mesh.transverse_contact_ratio + mesh.overlap_ratio
    if mesh.transverse_contact_ratio <= 0 or total < 1:
        problems.append(
            Problem(
                f"{one}.tip_diameter, {two}.tip_diameter",
                "",
                f"the contact ratio of the {mesh.name} is {total:.3f}, below 1 (transverse "
                f"{mesh.transverse_contact_ratio:.3f}, overlap {mesh.overlap_ratio:.3f}): "
                "motion is not passed on.",
                "Lengthen the teeth or reduce the centre distance.",
            )
        )
    return problems + _check_interference(mesh, tables)


def _check_clearances(mesh: Mesh) -> list[Problem]:
    one, two = mesh.gear1.name, mesh.gear2.name
    problems = []
    if mesh.backlash < -ROUNDING:
        problems.append(
            Problem(
                f"{one}.tooth_thickness, {two}.tooth_thickness",
                "",
                f"the {mesh.name} has a negative backlash of {_mm(mesh.backlash)} at centre "
                f"distance {_mm(mesh.center_distance)}.",
                "Make the teeth thinner or change the centre distance.",
            )
        )
    for tip, root, clearance in (
        (one, two, mesh.tip_clearance1),
        (two, one, mesh.tip_clearance2),
    ):
        if clearance < -ROUNDING:
            problems.append(
                Problem(
                    f"{tip}.tip_diameter",
                    "",
                    f"the tip of the {tip} reaches {_mm(-clearance)} into the root of the {root}.",
                    f"Shorten the teeth of the {tip} or cut the {root} deeper.",
                )
            )
    return problems


def _check_interference(mesh: Mesh, tables: Mapping[str, GearTable]) -> list[Problem]:
    """Contact must stay on the involute of both teeth, and tips of internal meshes clear."""
    one, two = mesh.gear1, mesh.gear2
    problems = []
    ends = [(one, two, mesh.path_start, mesh.radius1_at_start)]
    end_curvature = mesh.curvature2(mesh.path_end)
    ends.append((two, one, end_curvature, mesh.radius2_at_end))
    for gear, mate, curvature, radius in ends:
        try:
            form = form_radius(gear, build.sharpest_tool(gear, tables[gear.name]))
        except ValueError as error:
            problems.append(
                Problem(
                    f"{gear.name}.root_diameter",
                    _mm(2 * gear.root_radius),
                    f"no tool cuts such a tooth: {error}.",
                    "Check tooth thickness, tip and root diameter.",
                )
            )
            continue
        beyond = radius > form if gear.internal else radius < form
        if curvature < 0 or beyond:
            problems.append(
                Problem(
                    f"{mate.name}.tip_diameter",
                    _mm(2 * mate.tip_radius),
                    f"the tip of the {mate.name} touches the {gear.name} at diameter "
                    f"{_mm(2 * radius)}, {'outside' if gear.internal else 'below'} its involute, "
                    f"which ends at {_mm(2 * form)} (fillet interference).",
                    f"Shorten the teeth of the {mate.name} or cut the {gear.name} deeper.",
                )
            )
    if mesh.internal and mesh.tip_passage < 0:
        problems.append(
            Problem(
                f"{one.name}.tip_diameter, {two.name}.tip_diameter",
                "",
                f"the tips of {one.name} and {two.name} collide beside the mesh "
                f"(tip interference, {abs(math.degrees(mesh.tip_passage)):.3g} deg).",
                f"Shorten the teeth or choose more teeth for the {two.name}.",
            )
        )
    return problems


def _check_planet_positions(
    gears: Gears, sun: GearTable, planet: Planet, ring: Ring
) -> list[Problem]:
    problems = []
    angles = build.planet_angles(sun, planet, ring)
    if planet.angles is not None and len(planet.angles) != planet.count:
        problems.append(
            Problem(
                "planet.angles",
                f"{len(planet.angles)} angles",
                f"must be planet.count = {planet.count} angles.",
                "Give one angle for each planet, or none for the nearest admissible positions.",
            )
        )
    for number, angle in enumerate(angles):
        relative = angle - angles[0]
        admissible = nearest_admissible_angle(relative, sun.teeth, ring.teeth)
        if abs(relative - admissible) > ANGLE_TOLERANCE:
            problems.append(
                Problem(
                    f"planet.angles[{number}]",
                    f"{math.degrees(angle):.6g} deg",
                    "a planet cannot be assembled there: positions differ by multiples of "
                    f"360/({sun.teeth} + {ring.teeth}) deg.",
                    f"The nearest is {math.degrees(angles[0] + admissible):.6f} deg.",
                )
            )
    gap = smallest_planet_gap(
        angles, gears.center_distance, build.gear("planet", planet, gears).tip_radius
    )
    if gap <= 0:
        problems.append(
            Problem(
                "planet.count",
                str(planet.count),
                f"neighbouring planets overlap by {_mm(-gap)}.",
                "Take fewer planets, or move them apart (planet.angles).",
            )
        )
    return problems


def _check_bearing(bearing: PlanetBearing) -> list[Problem]:
    pitch_diameter = bearing.pin_diameter + bearing.roller_diameter + bearing.diametral_clearance
    room = math.pi / math.asin(min(1.0, bearing.roller_diameter / pitch_diameter))
    if bearing.rollers_per_row <= room:
        return []
    return [
        Problem(
            "planet_bearing.rollers_per_row",
            str(bearing.rollers_per_row),
            f"only {math.floor(room)} rollers of {_mm(bearing.roller_diameter)} fit around the "
            f"pin of {_mm(bearing.pin_diameter)}.",
            "Take fewer or thinner rollers.",
        )
    ]


def _check_bearing_room(gears: Gears, planet: Planet, bearing: PlanetBearing) -> list[Problem]:
    try:
        root = build.gear("planet", planet, gears).root_radius
    except ValueError:
        return []  # reported with the gears
    bore = bearing.pin_diameter + 2 * bearing.roller_diameter + bearing.diametral_clearance
    if bore < 2 * root:
        return []
    return [
        Problem(
            "planet_bearing.pin_diameter",
            _mm(bearing.pin_diameter),
            f"the planet's bore of {_mm(bore)} reaches its root circle of {_mm(2 * root)}.",
            "Take a thinner pin or thinner rollers.",
        )
    ]


def _check_bearing_model(bearing: PlanetBearing, models: PlanetaryModels) -> list[Problem]:
    if bearing.cage == "caged" or models.bearing != "mixed-ehl":
        return []
    return [
        Problem(
            "models.bearing",
            '"mixed-ehl"',
            "is for caged bearings: the rollers of a full-complement bearing rub on each other, "
            "which it leaves out.",
            'Choose "palmgren".',
        )
    ]


def _check_friction_table(table: FrictionTable) -> list[Problem]:
    axes = table.axes()
    problems = []
    if not 1 <= len(axes) <= 2:
        problems.append(
            Problem(
                "friction_table",
                f"{len(axes)} axes",
                "must have one or two axes.",
                f"Give one or two of {', '.join(FrictionTable.AXES)}.",
            )
        )
    for name, points in axes.items():
        if len(points) < 2 or any(b <= a for a, b in zip(points, points[1:], strict=False)):
            problems.append(
                Problem(
                    f"friction_table.{name}",
                    f"{len(points)} values",
                    "must be two or more rising values.",
                    "Sort them.",
                )
            )
    shape = tuple(len(points) for points in axes.values())
    if table.shape() != shape:
        problems.append(
            Problem(
                "friction_table.friction",
                f"shape {table.shape()}",
                f"must have shape {shape}, one value for each point of the axes.",
                "Give one row for each value of the first axis.",
            )
        )
    return problems


Check = Callable[..., list[Problem]]

_CHECKS: tuple[tuple[Check, tuple[str, ...]], ...] = (
    (_check_operation, ("operation", "planet")),
    (_check_planetary, ("gears", "sun", "planet", "ring")),
    (_check_pair, ("gears", "pinion", "gear")),
    (_check_bearing, ("planet_bearing",)),
    (_check_bearing_room, ("gears", "planet", "planet_bearing")),
    (_check_bearing_model, ("planet_bearing", "models")),
    (_check_friction_table, ("friction_table",)),
)
