"""Can these gears be cut, meshed and assembled?

Every function returns the problems it finds; none stops at the first. A mesh is looked at only if
both of its gears are sound, so that one mistake is told once.
"""

from __future__ import annotations

import math

from epicyclic.case import build
from epicyclic.case.backlash import ROUNDING, Tables, check_backlash
from epicyclic.case.flank_checks import check_flanks
from epicyclic.case.gear_tables import Gears, GearTable, PairGear, Planet, Ring
from epicyclic.case.messages import millimetres
from epicyclic.case.thickness import check_fit, check_measure, thickness_key
from epicyclic.errors import Problem
from epicyclic.gears.cutting import longest_involute
from epicyclic.gears.gear import Gear
from epicyclic.gears.mesh import Mesh, nearest_admissible_angle, smallest_planet_gap

ANGLE_TOLERANCE = math.radians(0.01)
"""Given planet positions may differ by this from an admissible one: drawing precision. [rad]"""

THINNEST_RIM = 0.25
"""A thinner rim is foil, and its teeth find no balance. [normal modules]"""

LARGEST_RIM_RATIO = 1000.0
"""Root radius over thickness of a rim, for the same reason. [1]"""


def check_planetary(gears: Gears, sun: GearTable, planet: Planet, ring: Ring) -> list[Problem]:
    """Problems of the gears of a planetary set, of its two meshes and of its assembly."""
    tables: Tables = {"sun": sun, "planet": planet, "ring": ring}
    sound, problems = check_gears(gears, tables)
    for name, one, two in (("sun mesh", "sun", "planet"), ("ring mesh", "planet", "ring")):
        if one in sound and two in sound:
            problems += check_mesh(Mesh(name, sound[one], sound[two], gears.distance), tables)
    if "planet" in sound:
        problems += _check_positions(gears, sun, planet, ring)
    return list(dict.fromkeys(problems))  # a planet that cannot be cut is found in both meshes


def check_pair(gears: Gears, pinion: GearTable, gear: PairGear) -> list[Problem]:
    """Problems of the gears of a pair and of their mesh."""
    tables: Tables = {"pinion": pinion, "gear": gear}
    sound, problems = check_gears(gears, tables)
    if len(sound) == 2:
        problems += check_mesh(build.pair_mesh(gears, pinion, gear), tables)
    return problems


def check_gears(gears: Gears, tables: Tables) -> tuple[dict[str, Gear], list[Problem]]:
    """The gears of `tables` that are sound, by name, and the problems of the others."""
    sound: dict[str, Gear] = {}
    problems = []
    for name, table in tables.items():
        try:
            gear = build.gear(name, table, gears)
        except ValueError:
            problems.append(_no_involute_for_thickness(name, table, gears))
            continue
        found = _check_tooth(gear, table) or check_measure(gear, table) or check_fit(gear, table)
        if found is None:
            sound[name] = gear
        else:
            problems.append(found)
        problems += _check_rim(gear, table)
    return sound, problems


def _check_rim(gear: Gear, table: GearTable) -> list[Problem]:
    thickness, key = build.rim_thickness(table), f"{gear.name}.rim_thickness"
    if thickness is None:
        return []
    if not gear.internal:
        return [
            Problem(
                key,
                millimetres(thickness),
                "belongs to a ring gear, and this gear is external.",
                f"Leave it out, or write {gear.name}.internal = true.",
            )
        ]
    least = max(THINNEST_RIM * gear.rack.normal_module, gear.root_radius / LARGEST_RIM_RATIO)
    if thickness >= least:
        return []
    return [
        Problem(
            key,
            millimetres(thickness),
            f"must be at least {millimetres(least)}: a quarter of the normal module, and a "
            "thousandth of the root radius.",
            "Correct it, or leave it out for a rim that does not bend.",
        )
    ]


def _no_involute_for_thickness(name: str, table: GearTable, gears: Gears) -> Problem:
    rack = build.basic_rack(gears)
    base = table.teeth * rack.transverse_module * math.cos(rack.transverse_pressure_angle)
    if table.dimension_over_pins is not None:
        return Problem(
            f"{name}.dimension_over_pins",
            millimetres(table.dimension_over_pins),
            f"puts the middle of the balls inside the base circle of {millimetres(base)}.",
            "Check it, measuring_pin_diameter, tooth number and module.",
        )
    return Problem(
        f"{name}.thickness_diameter",
        millimetres(table.thickness_diameter or 0.0),
        f"lies inside the base circle of {millimetres(base)}, where there is no involute.",
        "Give the tooth thickness at a larger diameter.",
    )


def _check_tooth(gear: Gear, table: GearTable) -> Problem | None:
    """The first reason why this tooth cannot be: each one makes the next meaningless."""
    tip, root = (f"{gear.name}.{which}_diameter" for which in ("tip", "root"))
    tip_shown = _diameter(gear.tip_radius, table.tip_diameter)
    root_shown = _diameter(gear.root_radius, table.root_diameter)
    if gear.root_radius <= 0:
        return Problem(
            root,
            root_shown,
            "must exceed zero.",
            f"Reduce gears.dedendum_coefficient, or give {root}.",
        )
    height = gear.tip_radius - gear.root_radius
    if (-height if gear.internal else height) <= 0:
        larger, smaller = (root, tip) if gear.internal else (tip, root)
        return Problem(
            f"{tip}, {root}",
            f"{tip_shown}, {root_shown}",
            f"leave no tooth: {larger} must exceed {smaller} on "
            f"{'a ring' if gear.internal else 'an external gear'}.",
            "Correct one of the two.",
        )
    thickness = thickness_key(gear.name, table)
    if gear.tip_radius <= gear.base_radius:
        return Problem(
            tip,
            tip_shown,
            f"lies inside the base circle of {millimetres(2 * gear.base_radius)}, so that the "
            "tooth has no involute at its tip.",
            f"Increase it beyond {millimetres(2 * gear.base_radius)}, or take more teeth.",
        )
    if gear.thickness_at(gear.tip_radius) <= 0:
        return Problem(
            tip,
            tip_shown,
            "the teeth are pointed before they reach the tip circle.",
            f"Shorten the teeth, or make them thicker with {thickness}.",
        )
    if gear.tip_form_radius <= gear.base_radius or gear.tip_half_angle <= 0:
        return _too_large_chamfer(gear)
    if gear.half_angle_at(max(gear.root_radius, gear.base_radius)) >= math.pi / gear.teeth:
        return Problem(
            root,
            root_shown,
            "there is no space left between the teeth at the root.",
            f"Make the teeth less deep, or thinner with {thickness}.",
        )
    return None


def _too_large_chamfer(gear: Gear) -> Problem:
    return Problem(
        f"{gear.name}.tip_chamfer",
        millimetres(gear.tip_chamfer),
        "leaves no tip land or no involute: the tooth is "
        f"{millimetres(gear.thickness_at(gear.tip_radius))} thick at the tip circle, and each of "
        "its two chamfers takes about its height of that.",
        "Reduce it.",
    )


def _diameter(radius: float, given: float | None) -> str:
    return f"{millimetres(2 * radius)}{' (the default)' if given is None else ''}"


def check_mesh(
    mesh: Mesh,
    tables: Tables,  # Tables of both gears, by their names.
    distance_key: str = "gears.center_distance",  # Where its centre distance is stated.
) -> list[Problem]:
    """Problems of a mesh of two sound gears."""
    one, two = mesh.gear1, mesh.gear2
    if mesh.internal and two.teeth <= one.teeth:
        return [
            Problem(
                f"{two.name}.teeth",
                str(two.teeth),
                f"must exceed the {one.teeth} teeth of the {one.name}, which turns inside it.",
                "Check both tooth numbers.",
            )
        ]
    bases = two.base_radius + mesh.side * one.base_radius
    if bases >= mesh.center_distance:
        return [
            Problem(
                distance_key,
                millimetres(mesh.center_distance),
                f"must exceed {millimetres(bases)}, the {'difference' if mesh.internal else 'sum'} "
                f"of the base radii of {one.name} and {two.name}.",
                f"{_reference_distance(mesh)} Check tooth numbers and module too.",
            )
        ]
    problems = check_backlash(mesh, tables, distance_key)
    ends: list[Problem] = []
    for tip, root, clearance in (
        (two, one, mesh.tip_clearance2),
        (one, two, mesh.tip_clearance1),
    ):
        if clearance < -ROUNDING:
            ends.append(_negative_clearance(mesh, tip, root, tables))
            continue
        try:
            ends += _check_end_of_contact(mesh, root, tip, tables)
        except ValueError as error:
            # rings whose tips reach too far for the planet are out of reach of cutters too
            if not (root.internal and ends):
                ends.append(_no_tool(root, tables[root.name], str(error)))
    problems += [
        *ends,
        *_check_contact_ratio(mesh, tables, distance_key),
        *_check_tip_passage(mesh, tables),
    ]
    # where the teeth do not mesh the limits of the active profile mean nothing
    return problems or check_flanks(mesh, (tables[one.name], tables[two.name]))


def _reference_distance(mesh: Mesh) -> str:
    distance = mesh.gear2.reference_radius + mesh.side * mesh.gear1.reference_radius
    return f"Without profile shift it is {millimetres(distance)}."


def _negative_clearance(mesh: Mesh, tip: Gear, root: Gear, tables: Tables) -> Problem:
    """The tip of one gear reaches into the root of the other."""
    clearance = mesh.tip_clearance1 if tip is mesh.gear1 else mesh.tip_clearance2
    limit = tip.tip_radius + (-clearance if tip.internal else clearance)
    try:
        end = longest_involute(root, tables[root.name].tool_tip_radius)
    except ValueError:
        pass
    else:
        stricter = max if tip.internal else min
        limit = stricter(limit, _tip_radius_for(mesh, tip, end))
    return Problem(
        f"{tip.name}.tip_diameter",
        _diameter(tip.tip_radius, tables[tip.name].tip_diameter),
        f"the tip of the {tip.name} reaches {millimetres(-clearance)} into the root of the "
        f"{root.name} (negative tip clearance).",
        f"{_tip_limit(tip, limit)}or cut the {root.name} deeper.",
    )


def _tip_limit(gear: Gear, limit: float) -> str:
    """Beginning of a remedy: how long the teeth may be."""
    if limit <= 0:
        return "Shorten the teeth, "
    step, bound = (math.ceil, "at least") if gear.internal else (math.floor, "at most")
    return f"Make {gear.name}.tip_diameter {bound} {step(2e6 * limit) / 1e3:.3f} mm, "


def _check_contact_ratio(mesh: Mesh, tables: Tables, distance_key: str) -> list[Problem]:
    one, two = mesh.gear1, mesh.gear2
    transverse, overlap = mesh.transverse_contact_ratio, mesh.overlap_ratio
    if transverse <= 0:
        fault = f"the teeth of the {mesh.name} do not reach each other"
    elif transverse + overlap < 1:
        fault = (
            f"the contact ratio of the {mesh.name} is {transverse + overlap:.3f}, below 1 "
            f"(transverse {transverse:.3f}, overlap {overlap:.3f})"
        )
    else:
        return []
    chamfers = ", reduce tip_chamfer" if one.tip_chamfer > 0 or two.tip_chamfer > 0 else ""
    return [
        Problem(
            f"{one.name}.tip_diameter, {two.name}.tip_diameter",
            _tip_diameters(mesh, tables),
            f"{fault}: motion is not passed on.",
            f"Lengthen the teeth{chamfers} or correct {distance_key}. {_reference_distance(mesh)}",
        )
    ]


def _tip_diameters(mesh: Mesh, tables: Tables) -> str:
    gears = (mesh.gear1, mesh.gear2)
    return ", ".join(_diameter(gear.tip_radius, tables[gear.name].tip_diameter) for gear in gears)


def _check_end_of_contact(mesh: Mesh, gear: Gear, mate: Gear, tables: Tables) -> list[Problem]:
    """Contact must stay on the involute of `gear` up to where the tip of `mate` leaves it.

    Raises
    ------
    ValueError
        If no tool generates `gear`.
    """
    if gear is mesh.gear1:
        curvature, radius = mesh.path_start, mesh.radius1_at_start
    else:
        curvature, radius = mesh.curvature2(mesh.path_end), mesh.radius2_at_end
    change = "change tooth numbers or profile shifts"
    if curvature < 0:
        end = gear.base_radius
        fault = (
            f"reaches inside the base circle of the {gear.name}, where there is no involute (tip "
            "interference)"
        )
    else:
        end = longest_involute(gear, tables[gear.name].tool_tip_radius)
        if (radius <= end + ROUNDING) if gear.internal else (radius >= end - ROUNDING):
            return []
        fault = (
            f"touches the {gear.name} at diameter {millimetres(2 * radius)}, "
            f"{'outside' if gear.internal else 'below'} its involute, which ends at "
            f"{millimetres(2 * end)} (fillet interference)"
        )
        if tables[gear.name].tool_tip_radius is not None:
            change = f"reduce {gear.name}.tool_tip_radius"
    return [
        Problem(
            f"{mate.name}.tip_diameter",
            _diameter(mate.tip_radius, tables[mate.name].tip_diameter),
            f"the tip of the {mate.name} {fault}.",
            f"{_tip_limit(mate, _tip_radius_for(mesh, mate, end))}or {change}.",
        )
    ]


def _tip_radius_for(mesh: Mesh, mate: Gear, radius: float) -> float:
    """Tip radius of `mate` whose contact with the other gear ends at `radius` there."""
    gear = mesh.gear2 if mate is mesh.gear1 else mesh.gear1
    curvature = math.sqrt(max(0.0, radius**2 - gear.base_radius**2))
    length = mesh.line_of_action - mesh.side * curvature
    if mate is mesh.gear1:
        length = mesh.side * (mesh.line_of_action - curvature)
    if length <= 0:
        return 0.0
    form = math.hypot(mate.base_radius, length)
    return form + (-mate.tip_chamfer if mate.internal else mate.tip_chamfer)


def _no_tool(gear: Gear, table: GearTable, reason: str) -> Problem:
    tip, root = (f"{gear.name}.{which}_diameter" for which in ("tip", "root"))
    return Problem(
        f"{tip}, {root}",
        f"{_diameter(gear.tip_radius, table.tip_diameter)}, "
        f"{_diameter(gear.root_radius, table.root_diameter)}",
        f"no tool cuts such a tooth: {reason}.",
        f"Change the tip or root diameter, or {thickness_key(gear.name, table)}.",
    )


def _check_tip_passage(mesh: Mesh, tables: Tables) -> list[Problem]:
    """The tips of an internal mesh must pass each other beside it."""
    one, two = mesh.gear1, mesh.gear2
    if not mesh.internal or mesh.tip_clearance2 < -ROUNDING or mesh.tip_passage >= 0:
        return []
    return [
        Problem(
            f"{one.name}.tip_diameter, {two.name}.tip_diameter",
            _tip_diameters(mesh, tables),
            f"the tips of {one.name} and {two.name} collide beside the mesh, by "
            f"{-math.degrees(mesh.tip_passage):.3g} deg of the {two.name} (tip interference).",
            f"Shorten the teeth or choose more teeth for the {two.name}.",
        )
    ]


def _check_positions(gears: Gears, sun: GearTable, planet: Planet, ring: Ring) -> list[Problem]:
    """Planets must stand where they can be assembled, one for each place, and not touch."""
    problems = []
    if planet.angles is not None and len(planet.angles) != planet.count:
        problems.append(
            Problem(
                "planet.angles",
                f"{len(planet.angles)} angles",
                f"must be one angle for each of the {planet.count} planets (planet.count).",
                f"Give {planet.count} angles, or none for the nearest admissible positions.",
            )
        )
    angles = build.planet_angles(sun, planet, ring)
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
    tip = build.gear("planet", planet, gears).tip_radius
    gap = smallest_planet_gap(angles, gears.distance, tip)
    if gap <= 0:
        most = math.floor(math.pi / math.asin(min(1.0, tip / gears.distance)))
        key = "count" if planet.angles is None else "angles"
        problems.append(
            Problem(
                f"planet.{key}",
                str(planet.count),
                f"neighbouring planets overlap by {millimetres(-gap)}.",
                f"Take fewer planets (at most {most} fit), or move them apart (planet.angles).",
            )
        )
    return problems
