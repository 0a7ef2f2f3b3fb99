"""Can the gears of a set be assembled: racks, hands, centre distances, pins, places of planets?

Every function returns the problems it finds; none stops at the first. A check runs only if what it
needs is sound, so that one mistake is told once.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations, combinations_with_replacement, product

from epicyclic.errors import Problem
from epicyclic.gears.gear import Gear
from epicyclic.gears.gearing import RACK_KEYS, Gearing, GearPairing, Pin
from epicyclic.gears.mesh import are_evenly_spaced, nearest_admissible_angle, profile_shift_sum
from epicyclic.gears.rules import check_mesh, sound_gears
from epicyclic.messages import millimetres

SAME_PITCH = 1e-6
"""Base pitches and helix angles that differ by less, relatively and in radians, are equal. [1]"""
SAME_PLACE = 1e-7  # Pin radii and overlaps that differ by less are equal: rounding of drawings. [m]
MOST_SHIFTED = 4
"""Teeth by which profile shifts let sun and two planets differ from the ring; an estimate. [1]"""
MOST_PLANETS = 99
ANGLE_TOLERANCE = math.radians(0.01)
"""Given planet positions may differ by this from an admissible one: drawing precision. [rad]"""


def reach_problems(gearing: Gearing) -> Iterator[Problem]:
    """Gears of planets that cannot mesh with all their central gears from one place, by teeth."""
    reaches: dict[str, dict[str, float]] = {}
    for mesh in gearing.meshes:
        if (central := gearing.central_gear(mesh)) is not None:
            (planet,) = {mesh.first, mesh.second} - {central}
            one, two = mesh.teeth
            reaches.setdefault(planet, {})[central] = two - one if mesh.internal else one + two
    for planet, reach in reaches.items():
        if max(reach.values()) - min(reach.values()) > MOST_SHIFTED:
            told = ", ".join(f"{count:g} with {name}" for name, count in reach.items())
            allowed = (
                f"cannot be: sums of teeth, differences with rings, must be alike, and are {told}."
            )
            remedy = "Correct them, or write internal = true at ring gears."
            yield Problem(f"gears.{planet}.teeth", "", allowed, remedy)


def set_problems(gearing: Gearing) -> list[Problem]:
    """Problems of the gears of a set with computed losses, its meshes and its assembly."""
    problems = list(rack_problems(gearing))
    sound: dict[str, Gear] = {}
    placed = False
    if not problems:
        sound, problems = sound_gears(gearing)
        problems += _hand_problems(gearing, sound)
        problems += (distances := list(_distance_problems(gearing)))
        thick = all(table.states_thickness for table in gearing.tables.values())
        complete = thick and None not in gearing.distances.values()
        if complete and not distances:  # else what is wrong with sizes shows in every mesh
            problems += _mesh_problems(gearing, sound)
            placed = True
    if gearing.planets and gearing.count is not None:
        problems += _assembly_problems(gearing, sound, placed=placed)
    # a planet that cannot be cut is found in both meshes, and so is a wrong centre distance
    told = {("center_distance" in it.key and (it.key, it.remedy)) or it: it for it in problems}
    return list(told.values())


def rack_problems(gearing: Gearing) -> Iterator[Problem]:
    """What the basic racks of the gears lack, or have twice."""
    given = gearing.rack_keys
    for group in RACK_KEYS:
        names = " or ".join(group)
        without = [gear for gear, keys in given.items() if not keys.keys() & set(group)]
        if len(without) == len(given):
            remedy = f"Give {names} there for all gears, or for each gear."
            yield Problem(f"gears.{group[0]}", "", "is missing.", remedy)
            without = []
        for gear in without:
            remedy = f"Give {names} to this gear, or to all in gears."
            yield Problem(f"{gearing.key(gear)}.{group[0]}", "", "is missing.", remedy)
        for gear, keys in given.items():
            found = [key for key in group if key in keys]
            if len(found) > 1:
                own = getattr(gearing.tables[gear], found[0], None) is not None
                prefix = gearing.key(gear) if own else "gears"
                both = ", ".join(f"{prefix}.{key}" for key in found)
                yield Problem(both, "", "state the same quantity twice.", "Keep one of them.")


def _hand_problems(gearing: Gearing, sound: Mapping[str, Gear]) -> Iterator[Problem]:
    """Helical mates of the wrong hand."""
    hands = gearing.hands
    for mesh in gearing.meshes:
        helical = any(
            gear in sound and sound[gear].rack.helix_angle > 0 for gear in (mesh.first, mesh.second)
        )
        alike = hands[mesh.first] == hands[mesh.second]
        if not helical or alike == mesh.internal:
            continue
        own = {it: getattr(gearing.tables[it], "hand", None) for it in (mesh.first, mesh.second)}
        stated = [gear for gear, hand in own.items() if hand]
        words = "the same hand" if mesh.internal else "opposite hands"
        shown = ", ".join(f'"{own[gear]}"' for gear in stated)
        allowed = f"{mesh.first} and {mesh.second} must have {words} of helix to mesh"
        allowed += "." if len(stated) == 2 else ", which contradicts the other hands given."
        keys = ", ".join(f"gears.{gear}.hand" for gear in stated or own)
        yield Problem(keys, shown, allowed, "Correct or leave out hand.")


def _distance_problems(gearing: Gearing) -> Iterator[Problem]:
    """Centre distances that are missing, or that put one pin at two places."""
    distances = gearing.distances
    for mesh in gearing.meshes:
        # that of gears of one module is computed, or reported where it cannot be
        modules = (gearing.racks[it].normal_module for it in (mesh.first, mesh.second))
        if distances[mesh.key] is None and not math.isclose(*modules):
            one, two = mesh.pair
            own = f"mesh.{one}-{two}.center_distance"
            yield Problem(own, "", "is missing.", f"Give gears.center_distance, or {own}.")
    for body in gearing.planets:
        # all its meshes with central gears must put its pin at one radius
        found = [
            (mesh, distance)
            for mesh in gearing.meshes
            if gearing.planet_of(mesh) == body and (distance := distances[mesh.key]) is not None
        ]
        if not found or max(a for _, a in found) - min(a for _, a in found) <= SAME_PLACE:
            continue
        shown = ", ".join(f"{'-'.join(mesh.pair)} {millimetres(a)}" for mesh, a in found)
        keys = dict.fromkeys(gearing.distance_key(mesh) for mesh, _ in found)
        first, wanted = found[0]
        others = [mesh for mesh, a in found if abs(a - wanted) > SAME_PLACE]
        fits = " ".join(_shifts_for(gearing, mesh, wanted) for mesh in others)
        allowed = f"the pin of {body} would be at different radii: {shown}."
        remedy = f"Give them the same; that of {'-'.join(first.pair)} is possible: {fits}"
        yield Problem(", ".join(keys), "", allowed, remedy)
    if None not in distances.values():
        yield from _triangle_problems(gearing)


def _shifts_for(gearing: Gearing, mesh: GearPairing, distance: float) -> str:
    """The profile shifts with which a mesh has no backlash at a centre distance."""
    try:
        one, two = gearing.gear(mesh.first), gearing.gear(mesh.second)
    except ValueError:
        return "its gears must be adjusted to fit."
    side = -1 if mesh.internal else 1
    bases = two.base_radius + side * one.base_radius
    name = "-".join(mesh.pair)
    if not 0 < bases < distance:
        return f"{name} cannot work at that centre distance."
    total = profile_shift_sum(one.rack, one.teeth + side * two.teeth, distance)
    return (
        f"{name} then has no backlash if the profile shift coefficients add up to {total:.4f} "
        f"(now {one.profile_shift_coefficient + two.profile_shift_coefficient:.4f})."
    )


def _triangle_problems(gearing: Gearing) -> Iterator[Problem]:
    """Two planets that mesh must stand at their centre distance from each other."""
    distances = gearing.distances
    radii = gearing.pin_radii(distances)
    pairs = [(mesh, pair) for mesh in gearing.meshes if (pair := gearing.planet_pair(mesh))]
    wide = False
    for mesh, (one, two) in pairs:
        distance = distances[mesh.key] or 0.0
        if one not in radii or two not in radii:
            continue
        low, high = abs(radii[one] - radii[two]), radii[one] + radii[two]
        if not low <= distance <= high:
            wide = True
            allowed = f"is impossible: pins of {one} and {two} are at {millimetres(radii[one])} "
            allowed += f"and {millimetres(radii[two])} from the axis."
            remedy = f"It must be from {millimetres(low)} to {millimetres(high)}."
            yield Problem(gearing.distance_key(mesh), millimetres(distance), allowed, remedy)
    if wide:
        return
    pins = gearing.pins
    for mesh, (one, two) in pairs:
        if one not in pins or two not in pins:
            continue
        apart, distance = math.dist(pins[one].place, pins[two].place), distances[mesh.key] or 0.0
        if abs(apart - distance) > SAME_PLACE:
            allowed = f"does not close the ring of planets: the other meshes place {one} and {two} "
            allowed += f"{millimetres(apart)} apart."
            remedy = f"Give {millimetres(apart)}."
            yield Problem(gearing.distance_key(mesh), millimetres(distance), allowed, remedy)


def _mesh_problems(gearing: Gearing, sound: Mapping[str, Gear]) -> Iterator[Problem]:
    """Mates of different racks, and meshes that cannot work. Only of gears that can be cut."""
    for drawn in gearing.meshes:
        if drawn.first not in sound or drawn.second not in sound:
            continue
        mesh = gearing.geometry(drawn)
        racks = one, two = mesh.gear1.rack, mesh.gear2.rack
        pitch, helix = one.transverse_base_pitch, one.base_helix_angle
        if (
            abs(pitch - two.transverse_base_pitch) <= SAME_PITCH * pitch
            and abs(helix - two.base_helix_angle) <= SAME_PITCH
        ):
            yield from check_mesh(gearing, mesh, gearing.distance_key(drawn))
            continue
        values = {
            "normal modules": [millimetres(rack.normal_module) for rack in racks],
            "normal pressure angles": [_degrees(rack.normal_pressure_angle) for rack in racks],
            "helix angles": [_degrees(rack.helix_angle) for rack in racks],
        }
        parts = [f"{name} {a} and {b}" for name, (a, b) in values.items() if a != b]
        allowed = f"cannot mesh: {mesh.gear1.name} and {mesh.gear2.name} have "
        allowed += f"{', '.join(parts) or 'different base pitches'}."
        remedy = "Give both gears the same normal module, pressure angle and helix angle."
        shown = "[{}]".format(", ".join(f'"{gear}"' for gear in drawn.pair))
        yield Problem(f"meshes[{gearing.meshes.index(drawn)}]", shown, allowed, remedy)


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.6g} deg"


def _assembly_problems(
    gearing: Gearing, sound: Mapping[str, Gear], *, placed: bool
) -> Iterator[Problem]:
    """All planets must find places of their own, where they can be assembled and do not touch.

    They are `placed` if all centre distances are known.
    """
    found = list(place_problems(gearing))
    yield from found
    on_planets = [gear for body in gearing.planets for gear in gearing.gears_of(body)]
    if placed and all(gear in sound for gear in on_planets):
        if gearing.listed and found:
            return
        positions = gearing.positions
        for body in gearing.planets:  # its gears must stand side by side
            for one, two in combinations(gearing.gears_of(body), 2):
                width = (sound[one].face_width + sound[two].face_width) / 2
                overlap = width - abs(positions[one] - positions[two])
                if overlap > SAME_PLACE:
                    keys = ", ".join(f"gears.{gear}.axial_position" for gear in (one, two))
                    shown = ", ".join(millimetres(positions[gear]) for gear in (one, two))
                    allowed = f"{one} and {two} of {body} overlap by {millimetres(overlap)}."
                    remedy = f"Place them at least {millimetres(width)} apart."
                    yield Problem(keys, shown, allowed, remedy)
        yield from _overlaps(gearing, sound)


def place_problems(gearing: Gearing) -> Iterator[Problem]:
    """Planets must fit where the case says; if it does not, each needs a place of its own."""
    angles, count = gearing.stated_angles, gearing.count
    if count is None:
        return
    if angles is None:
        arrangement = gearing.arrangement
        places = {round(angle / (2 * math.pi), 9) % 1 for angle in arrangement.angles}
        if len(places) != count:
            number = arrangement.number
            fitting = [str(n) for n in range(1, MOST_PLANETS + 1) if number % n == 0]
            allowed = "cannot be assembled: with these tooth numbers, a planet fits only at "
            allowed += f"multiples of 360/{number} deg from another planet."
            remedy = f"Use {' or '.join(fitting)}, or other tooth numbers."
            yield Problem(gearing.count_key, str(count), allowed, remedy)
        return
    if len(angles) != count:
        allowed = f"must be one angle for each of the {count} planets (planet.count)."
        remedy = f"Give {count} angles, or none for the nearest admissible positions."
        yield Problem("planet.angles", f"{len(angles)} angles", allowed, remedy)
    sun, ring = gearing.tables["sun"].teeth, gearing.tables["ring"].teeth
    for number, angle in enumerate(angles):
        relative = angle - angles[0]
        admissible = nearest_admissible_angle(relative, sun, ring)
        if abs(relative - admissible) > ANGLE_TOLERANCE:
            shown = f"{math.degrees(angle):.6g} deg"
            allowed = "a planet cannot be assembled there: positions must differ by multiples of "
            allowed += f"360/({sun} + {ring}) deg."
            remedy = f"The nearest is {math.degrees(angles[0] + admissible):.6f} deg."
            yield Problem(f"planet.angles[{number}]", shown, allowed, remedy)


def _overlaps(gearing: Gearing, sound: Mapping[str, Gear]) -> Iterator[Problem]:
    """Planets must not touch each other."""
    angles = gearing.planet_angles
    placed = [gear for gear, body in gearing.bodies.items() if body in gearing.pins]
    pairs = combinations_with_replacement(placed, 2)
    close = [pair for pair in pairs if _side_by_side(gearing, sound, *pair)]
    seen: set[tuple[str, str]] = set()
    for one, two in close:
        bodies = (gearing.bodies[one], gearing.bodies[two])
        gap = _gap(gearing, sound, angles, one, two)
        if gap > 0 or bodies in seen:
            continue
        seen.add(bodies)
        which = "neighbouring planets overlap by"
        if gearing.listed:
            touching = f"neighbouring {one}" if one == two else f"{one} and {two}"
            which = f"the planets overlap: {touching}, by"
        key = gearing.count_key if gearing.stated_angles is None else "planet.angles"
        allowed = f"{which} {millimetres(-gap)}."
        yield Problem(key, str(gearing.count), allowed, _fewer(gearing, sound, close))


def _gap(
    gearing: Gearing, sound: Mapping[str, Gear], angles: tuple[float, ...], one: str, two: str
) -> float:
    """Smallest distance of the tip circles of two gears on arms without a mesh. Theory (K8). [m]"""
    first, second = (gearing.pins[gearing.bodies[gear]] for gear in (one, two))
    mates = any({mesh.first, mesh.second} == {one, two} for mesh in gearing.meshes)
    tips = sound[one].tip_radius + sound[two].tip_radius
    gap = math.inf
    for here, there in product(range(len(angles)), repeat=2):
        if here == there and (mates or first is second):
            continue
        moved = Pin(second.radius, second.angle + angles[there] - angles[here])
        gap = min(gap, math.dist(first.place, moved.place) - tips)
    return gap


def spacing_notes(gearing: Gearing) -> Iterator[str]:
    """What planets whose places are not stated need so that they can be assembled."""
    planets = gearing.count
    if planets is None or gearing.stated_angles is not None:
        return
    found = gearing.arrangement
    if found.individual:
        bodies = list(gearing.bodies.values())
        stepped = ", ".join(body for body in gearing.planets if bodies.count(body) > 1)
        fitting = [str(n) for n in range(1, planets + 1) if found.number % n == 0]
        yield (
            f"{planets} equally spaced planets cannot be identical: on each {stepped} the gears "
            f"need a different angle to each other, because {found.number}/{planets} is not an "
            "integer. Identical planets can be equally spaced if there are "
            f"{' or '.join(fitting)}."
        )
    elif not are_evenly_spaced(found.angles):
        number = str(found.number)
        if not gearing.listed:
            number = f"({gearing.tables['sun'].teeth} + {gearing.tables['ring'].teeth})"
        placed = ", ".join(f"{math.degrees(angle):.4f}" for angle in found.angles)
        yield (
            f"{planets} planets cannot be equally spaced, because {number}/{planets} is not an "
            f"integer; they stand at {placed} deg."
        )


def _fewer(gearing: Gearing, sound: Mapping[str, Gear], close: list[tuple[str, str]]) -> str:
    """How many planets would not touch."""
    for count in range(MOST_PLANETS, 0, -1):
        places = replace(gearing, count=count, stated_angles=None).planet_angles
        if all(_gap(gearing, sound, places, one, two) > 0 for one, two in close):
            return f"Use at most {count} planets, equally spaced."
    return "Shorten their teeth, or change the centre distances."


def _side_by_side(gearing: Gearing, sound: Mapping[str, Gear], one: str, two: str) -> bool:
    """True if the faces of two gears on planets are known to overlap along the axis."""
    bodies = gearing.bodies[one], gearing.bodies[two]
    if bodies[0] == bodies[1]:
        return one == two
    offsets = _axial_offsets(gearing, bodies[0])
    if bodies[1] not in offsets:
        return False
    positions = gearing.positions
    apart = abs(offsets[bodies[1]] + positions[two] - positions[one])
    return apart < (sound[one].face_width + sound[two].face_width) / 2 - SAME_PLACE


def _axial_offsets(gearing: Gearing, start: str) -> dict[str, float]:
    """Middle of each planet from that of `start`, as far as meshes tell: mates share a plane."""
    # a central gear stands for itself: how far apart two of them are on a shaft is not known here
    owners = {
        gear: body if body in gearing.planets else gear for gear, body in gearing.bodies.items()
    }
    offsets, left, positions = {start: 0.0}, [start], gearing.positions
    while left:
        known = left.pop()
        for mesh in gearing.meshes:
            for near, far in ((mesh.first, mesh.second), (mesh.second, mesh.first)):
                if owners[near] == known and owners[far] not in offsets:
                    plane = offsets[known] + positions.get(near, 0.0)
                    offsets[owners[far]] = plane - positions.get(far, 0.0)
                    left.append(owners[far])
    return offsets
