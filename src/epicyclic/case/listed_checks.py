"""Can the gears of a listed set be cut, meshed and assembled around their carrier?

Every function returns the problems it finds; none stops at the first. A check runs only if what it
needs is sound, so that one mistake is told once.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import combinations, combinations_with_replacement, product

from epicyclic.case.checks import check_bore, check_cage, check_rollers
from epicyclic.case.gear_checks import check_gears, check_mesh
from epicyclic.case.listed_set import (
    RACK_KEYS,
    Arrangement,
    Pin,
    arrangement_of,
    bearing_of,
    central_gear,
    distance_key,
    distances_of,
    gear_of,
    gears_table,
    hands_of,
    meshes_of,
    pair_of,
    pins_of,
    positions_of,
    rack_keys,
    terms_of,
)
from epicyclic.case.messages import did_you_mean, millimetres
from epicyclic.case.train_shape import CARRIER, SetShape, ShapeMesh
from epicyclic.case.train_tables import ListedSet
from epicyclic.errors import Problem
from epicyclic.gears.gear import HOUSING, Gear, involute
from epicyclic.gears.mesh import Mesh, nearest_places

SAME_PITCH = 1e-6
"""Base pitches and helix angles that differ by less, relatively and in radians, are equal. [1]"""
SAME_PLACE = 1e-7
"""Pin radii and overlaps that differ by less are equal: rounding of drawings. [m]"""
MOST_PLANETS = 24


def listed_set_problems(table: ListedSet, shape: SetShape) -> list[Problem]:
    """Problems of a listed set with computed losses, its gears under ``gears.NAME``."""
    problems = [
        *_name_problems(shape),
        *_loss_problems(table, shape),
        *_planet_problems(table, shape),
        *_sharing_problems(table),
    ]
    racks = list(dict.fromkeys(rack_problems(table)))
    if racks:
        return problems + racks
    sound, found = sound_gears(table)
    problems += found
    problems += _hand_problems(table, shape, sound)
    problems += _bearing_problems(table, shape, sound)
    distances = list(_distance_problems(table, shape))
    problems += distances
    found = [] if distances else list(_mesh_problems(table, shape, sound))
    problems += found
    if shape.planets and table.planets is not None:
        arrangement = arrangement_of(shape, table.planets)
        crowded = list(_assembly_problems(table, shape, arrangement))
        if not crowded and not distances and len(sound) == len(table.members):
            crowded = list(_overlaps(table, shape, sound, arrangement))
        problems += crowded
    return list(dict.fromkeys(problems))


def _name_problems(shape: SetShape) -> Iterator[Problem]:
    """Names that would give two losses or members the same name."""
    for name in (CARRIER, HOUSING) if shape.planets else (HOUSING,):
        if name in shape.bodies or name in shape.bodies.values():
            allowed = f"cannot be the name of a gear or body: every set has a {name}."
            yield Problem(f"gears.{name}", "", allowed, "Choose another name.")
    for name in shape.bodies:
        if "." in name:
            allowed = "is not a valid name for a gear: a dot stands between set and gear."
            yield Problem(f'gears."{name}"', "", allowed, "Choose another name.")
    keys = [mesh.key for mesh in shape.meshes]
    for one, two in combinations(shape.meshes, 2):
        if one.key == two.key:
            pairs = [f'["{mesh.first}", "{mesh.second}"]' for mesh in (one, two)]
            allowed = f"have the same name, {one.key}."
            key = f"meshes[{keys.index(one.key)}], meshes[{shape.meshes.index(two)}]"
            yield Problem(key, ", ".join(pairs), allowed, "Rename one of the gears.")


def _loss_problems(table: ListedSet, shape: SetShape) -> Iterator[Problem]:
    known = terms_of(shape)
    for name in table.losses:
        if name not in known:
            remedy = did_you_mean(name, known) or f"Known are: {', '.join(known)}."
            yield Problem(f"losses.{name}", "", "is no loss of this set.", remedy)


def _planet_problems(table: ListedSet, shape: SetShape) -> Iterator[Problem]:
    """Planets without a number, and a carrier or bearings without planets."""
    if shape.planets and table.planets is None:
        names = ", ".join(shape.planets)
        allowed = f"is missing, and the set has planets ({names})."
        remedy = "Add planets = 3, or as many as there are."
        yield Problem("planets", "", allowed, remedy)
    if not shape.planets:
        remedy = "Leave it out, or write planet = true at the gears on a carrier."
        if table.planets is not None:
            allowed = "is given, but no gear stands on a carrier."
            yield Problem("planets", str(table.planets), allowed, remedy)
        for name in ("planet_bearing", "carrier"):
            if getattr(table, name) is not None:
                yield Problem(name, "", "belongs to planets, and the set has none.", remedy)
    for name in table.planet_bearings:
        if name not in shape.planets:
            remedy = did_you_mean(name, shape.planets)
            remedy = remedy or f"Known are: {', '.join(shape.planets) or 'none'}."
            key = f"planet_bearings.{name}"
            yield Problem(key, "", "is no body of a planet of this set.", remedy)
    for body in shape.planets:
        if not any(
            central_gear(shape, mesh) is not None
            and body in (shape.bodies[mesh.first], shape.bodies[mesh.second])
            for mesh in shape.meshes
        ):
            gear = next(gear for gear, own in shape.bodies.items() if own == body)
            allowed = "meshes with planets only, so that nothing determines where its pin stands."
            remedy = "Let it mesh with a central gear too."
            yield Problem(f"gears.{gear}", "", allowed, remedy)
    in_pairs = any(_planet_pair(shape, mesh) for mesh in shape.meshes)
    if table.models.planet_tilt == "coupled" and in_pairs:
        allowed = "is not for planets that mesh with each other."
        remedy = 'Write planet_tilt = "left-out".'
        yield Problem("models.planet_tilt", '"coupled"', allowed, remedy)


def _planet_pair(shape: SetShape, mesh: ShapeMesh) -> tuple[str, str] | None:
    """The bodies of two planets that mesh with each other; None for other meshes."""
    one, two = shape.bodies[mesh.first], shape.bodies[mesh.second]
    return (one, two) if one in shape.planets and two in shape.planets else None


def _sharing_problems(table: ListedSet) -> Iterator[Problem]:
    sharing, planets = table.load_sharing, table.planets or 1
    if sharing.method not in ("equal", "mesh-load-factor"):
        allowed = "is for one sun, one ring and planets between them."
        remedy = 'Write method = "equal" or "mesh-load-factor".'
        yield Problem("load_sharing.method", f'"{sharing.method}"', allowed, remedy)
    if sharing.mesh_load_factor > planets:
        yield Problem(
            "load_sharing.mesh_load_factor",
            f"{sharing.mesh_load_factor:g}",
            f"must be at most planets, {planets}: then one planet has all the load.",
            "Take a smaller factor.",
        )


# --- gears ----------------------------------------------------------------------------------------


def rack_problems(table: ListedSet) -> Iterator[Problem]:
    """What the basic racks of the gears lack, or have twice."""
    given = {gear: rack_keys(table, gear) for gear in table.members}
    for group in RACK_KEYS:
        names = " or ".join(group)
        without = [gear for gear, keys in given.items() if not keys.keys() & set(group)]
        if len(without) == len(given):
            remedy = f"Give {names}, there for all gears or at each of them."
            yield Problem(f"gears.{group[0]}", "", "is missing.", remedy)
            without = []
        for gear in without:
            remedy = f"Give {names} to this gear, or to all in gears."
            yield Problem(f"gears.{gear}.{group[0]}", "", "is missing.", remedy)
        for gear, keys in given.items():
            found = [key for key in group if key in keys]
            if len(found) > 1:
                own = getattr(table.members[gear], found[0]) is not None
                prefix = f"gears.{gear}" if own else "gears"
                both = ", ".join(f"{prefix}.{key}" for key in found)
                yield Problem(both, "", "state the same twice.", "Keep one of them.")


def sound_gears(table: ListedSet) -> tuple[dict[str, Gear], list[Problem]]:
    """The gears that can be cut, and the problems of the others that state their thickness."""
    sound: dict[str, Gear] = {}
    problems: list[Problem] = []
    for name, member in table.members.items():
        if not member.states_thickness:
            continue
        found, wrong = check_gears(gears_table(table, name), {name: member})
        sound |= found
        problems += [_below_gears(problem, table) for problem in wrong]
    return sound, problems


def _below_gears(problem: Problem, table: ListedSet) -> Problem:
    """A problem with the keys of gears as they stand in the set, below ``gears``."""
    names = "|".join(map(re.escape, table.members))
    key = re.compile(rf"(?<![\w.-])({names})\.(?=[a-z])")
    texts = (problem.key, problem.allowed, problem.remedy)
    where, allowed, remedy = (key.sub(r"gears.\1.", text) for text in texts)
    return replace(problem, key=where, allowed=allowed, remedy=remedy)


def _hand_problems(
    table: ListedSet, shape: SetShape, sound: Mapping[str, Gear]
) -> Iterator[Problem]:
    """Helical mates of the wrong hand."""
    hands = hands_of(table, shape)
    for mesh in shape.meshes:
        helical = any(
            gear in sound and sound[gear].rack.helix_angle > 0 for gear in (mesh.first, mesh.second)
        )
        alike = hands[mesh.first] == hands[mesh.second]
        if not helical or alike == mesh.internal:
            continue
        stated = [gear for gear in (mesh.first, mesh.second) if table.members[gear].hand]
        gears = stated or [mesh.first, mesh.second]
        words = "the same hand" if mesh.internal else "opposite hands"
        yield Problem(
            ", ".join(f"gears.{gear}.hand" for gear in gears),
            ", ".join(f'"{table.members[gear].hand}"' for gear in stated),
            f"{mesh.first} and {mesh.second} must have {words} of helix to mesh"
            + ("." if len(stated) == 2 else ", and the other hands given forbid it."),
            "Correct or leave out hand.",
        )


def _bearing_problems(
    table: ListedSet, shape: SetShape, sound: Mapping[str, Gear]
) -> Iterator[Problem]:
    for name, bearing in table.planet_bearings.items():
        yield from check_rollers(bearing, f"planet_bearings.{name}")
        yield from check_cage(bearing, table.models)
    for body in shape.planets:
        own = bearing_of(table, body)
        gears = [gear for gear in sound if shape.bodies[gear] == body]
        roots = [sound[gear].root_radius for gear in gears]
        if own is None or not roots:
            continue
        key = f"planet_bearings.{body}" if body in table.planet_bearings else "planet_bearing"
        yield from check_bore(own, min(roots), key)


# --- meshes ---------------------------------------------------------------------------------------


def _distance_problems(table: ListedSet, shape: SetShape) -> Iterator[Problem]:
    """Centre distances that are missing, or that put one pin at two places."""
    distances = distances_of(table, shape)
    for mesh in shape.meshes:
        if distances[mesh.key] is None:
            one, two = pair_of(table, shape, mesh)
            own = f"mesh.{one}-{two}.center_distance"
            remedy = f"Give gears.center_distance, or {own}."
            yield Problem(own, "", "is missing.", remedy)
    for body in shape.planets:
        yield from _pin_radius_problems(table, shape, body, distances)
    if None not in distances.values():
        yield from _triangle_problems(table, shape, distances)


def _pin_radius_problems(
    table: ListedSet, shape: SetShape, body: str, distances: Mapping[str, float | None]
) -> Iterator[Problem]:
    """All meshes of a planet with central gears must put its pin at one radius."""
    own = [
        (mesh, distance)
        for mesh in shape.meshes
        if central_gear(shape, mesh) is not None
        and body in (shape.bodies[mesh.first], shape.bodies[mesh.second])
        and (distance := distances[mesh.key]) is not None
    ]
    if not own or max(a for _, a in own) - min(a for _, a in own) <= SAME_PLACE:
        return
    shown = ", ".join(f"{_name(table, shape, mesh)} {millimetres(a)}" for mesh, a in own)
    keys = dict.fromkeys(distance_key(table, shape, mesh) for mesh, _ in own)
    first, wanted = own[0]
    others = [mesh for mesh, a in own if abs(a - wanted) > SAME_PLACE]
    fits = " ".join(_shifts_for(table, shape, mesh, wanted) for mesh in others)
    yield Problem(
        ", ".join(keys),
        "",
        f"the pin of {body} would stand at different radii: {shown}.",
        f"Give all the same; that of {_name(table, shape, first)} would do: {fits}",
    )


def _shifts_for(table: ListedSet, shape: SetShape, mesh: ShapeMesh, distance: float) -> str:
    """The profile shifts with which a mesh has no backlash at a centre distance."""
    try:
        one, two = gear_of(table, mesh.first), gear_of(table, mesh.second)
    except ValueError:
        return "its gears must be made to fit."
    side = -1 if mesh.internal else 1
    bases = two.base_radius + side * one.base_radius
    name = _name(table, shape, mesh)
    if not 0 < bases < distance:
        return f"{name} cannot work there."
    rack = one.rack
    difference = involute(math.acos(bases / distance)) - involute(rack.transverse_pressure_angle)
    teeth = one.teeth + side * two.teeth
    total = teeth * difference / (2 * math.tan(rack.normal_pressure_angle))
    return (
        f"{name} then has no backlash with profile shift coefficients of {total:.4f} in sum "
        f"(now {one.profile_shift_coefficient + two.profile_shift_coefficient:.4f})."
    )


def _triangle_problems(
    table: ListedSet, shape: SetShape, distances: Mapping[str, float | None]
) -> Iterator[Problem]:
    """Two planets that mesh must stand at their centre distance from each other."""
    radii: dict[str, float] = {}
    for mesh in shape.meshes:
        if central_gear(shape, mesh) is not None:
            planet = next(
                body
                for body in (shape.bodies[mesh.first], shape.bodies[mesh.second])
                if body in shape.planets
            )
            radii.setdefault(planet, distances[mesh.key] or 0.0)
    pairs = [(mesh, pair) for mesh in shape.meshes if (pair := _planet_pair(shape, mesh))]
    wide = False
    for mesh, (one, two) in pairs:
        distance = distances[mesh.key] or 0.0
        if one not in radii or two not in radii:
            continue
        low, high = abs(radii[one] - radii[two]), radii[one] + radii[two]
        if not low <= distance <= high:
            wide = True
            yield Problem(
                distance_key(table, shape, mesh),
                millimetres(distance),
                f"cannot be: the pins of {one} and {two} stand at {millimetres(radii[one])} and "
                f"{millimetres(radii[two])} from the axis.",
                f"It must be from {millimetres(low)} to {millimetres(high)}.",
            )
    if wide:
        return
    pins = pins_of(table, shape)
    for mesh, (one, two) in pairs:
        if one not in pins or two not in pins:
            continue
        apart, distance = math.dist(pins[one].place, pins[two].place), distances[mesh.key] or 0.0
        if abs(apart - distance) > SAME_PLACE:
            yield Problem(
                distance_key(table, shape, mesh),
                millimetres(distance),
                f"does not close the ring of planets: {one} and {two} stand "
                f"{millimetres(apart)} apart by their other meshes.",
                f"Give {millimetres(apart)}.",
            )


def _name(table: ListedSet, shape: SetShape, mesh: ShapeMesh) -> str:
    return "-".join(pair_of(table, shape, mesh))


def _mesh_problems(
    table: ListedSet, shape: SetShape, sound: Mapping[str, Gear]
) -> Iterator[Problem]:
    """Mates of different racks, and meshes that cannot work. Only of gears that can be cut."""
    if len(sound) < len(table.members):
        return
    for drawn, mesh, _ in meshes_of(table, shape):
        different = _rack_difference(mesh)
        if different:
            one, two = pair_of(table, shape, drawn)
            yield Problem(
                f"meshes[{shape.meshes.index(drawn)}]",
                f'["{one}", "{two}"]',
                f"cannot mesh: {different}.",
                "Give both the same normal module, pressure angle and helix angle.",
            )
            continue
        key = distance_key(table, shape, drawn)
        for problem in check_mesh(mesh, table.members, key):
            yield _below_gears(problem, table)


def _rack_difference(mesh: Mesh) -> str:
    """Why two gears have different base pitches or base helices; empty if they agree."""
    one, two = mesh.gear1.rack, mesh.gear2.rack
    pitches = one.transverse_base_pitch, two.transverse_base_pitch
    helices = one.base_helix_angle, two.base_helix_angle
    if (
        abs(pitches[0] - pitches[1]) <= SAME_PITCH * pitches[0]
        and abs(helices[0] - helices[1]) <= SAME_PITCH
    ):
        return ""
    names = f"{mesh.gear1.name} and {mesh.gear2.name}"
    values = {
        "normal modules": [millimetres(rack.normal_module) for rack in (one, two)],
        "normal pressure angles": [_degrees(rack.normal_pressure_angle) for rack in (one, two)],
        "helix angles": [_degrees(rack.helix_angle) for rack in (one, two)],
    }
    parts = [f"{name} {a} and {b}" for name, (a, b) in values.items() if a != b]
    return f"{names} have {', '.join(parts) or 'different base pitches'}"


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.6g} deg"


# --- assembly -------------------------------------------------------------------------------------


def _assembly_problems(
    table: ListedSet, shape: SetShape, arrangement: Arrangement
) -> Iterator[Problem]:
    """All planets must find a place of their own."""
    assert table.planets is not None
    places = {round(angle / (2 * math.pi), 9) % 1 for angle in arrangement.angles}
    if len(places) == table.planets:
        return
    number = arrangement.number
    fitting = [str(n) for n in range(1, MOST_PLANETS + 1) if number % n == 0]
    yield Problem(
        "planets",
        str(table.planets),
        f"cannot be assembled: by the numbers of teeth, a planet fits only at multiples of "
        f"360/{number} deg from another one.",
        f"Take {' or '.join(fitting)}, or other numbers of teeth.",
    )


def _overlaps(
    table: ListedSet, shape: SetShape, sound: Mapping[str, Gear], arrangement: Arrangement
) -> Iterator[Problem]:
    """Gears of one body must stand side by side, and planets must not touch each other."""
    positions = positions_of(table, shape)
    for body in shape.planets:
        gears = [gear for gear, own in shape.bodies.items() if own == body]
        for one, two in combinations(gears, 2):
            width = (sound[one].face_width + sound[two].face_width) / 2
            overlap = width - abs(positions[one] - positions[two])
            if overlap > SAME_PLACE:
                keys = ", ".join(f"gears.{gear}.axial_position" for gear in (one, two))
                shown = ", ".join(millimetres(positions[gear]) for gear in (one, two))
                allowed = f"{one} and {two} of {body} overlap by {millimetres(overlap)}."
                remedy = f"Put them at least {millimetres(width)} apart."
                yield Problem(keys, shown, allowed, remedy)
    pins = pins_of(table, shape)
    close = [
        (one, two)
        for one, two in combinations_with_replacement(
            [gear for gear in shape.bodies if shape.bodies[gear] in pins], 2
        )
        if _side_by_side(shape, sound, positions, one, two)
    ]
    seen: set[tuple[str, str]] = set()
    for one, two in close:
        bodies = (shape.bodies[one], shape.bodies[two])
        gap = _gap(shape, sound, pins, arrangement.angles, one, two)
        if gap > 0 or bodies in seen:
            continue
        seen.add(bodies)
        touching = f"neighbouring {one}" if one == two else f"{one} and {two}"
        yield Problem(
            "planets",
            str(table.planets),
            f"the planets overlap: {touching}, by {millimetres(-gap)}.",
            _fewer(shape, sound, pins, close),
        )


def _gap(
    shape: SetShape,
    sound: Mapping[str, Gear],
    pins: Mapping[str, Pin],
    angles: tuple[float, ...],
    one: str,
    two: str,
) -> float:
    """Smallest distance of the tip circles of two gears on any arms that do not mesh. [m]"""
    first, second = pins[shape.bodies[one]], pins[shape.bodies[two]]
    mates = any({mesh.first, mesh.second} == {one, two} for mesh in shape.meshes)
    tips = sound[one].tip_radius + sound[two].tip_radius
    gap = math.inf
    for here, there in product(range(len(angles)), repeat=2):
        if here == there and (mates or first is second):
            continue
        moved = Pin(second.radius, second.angle + angles[there] - angles[here])
        gap = min(gap, math.dist(first.place, moved.place) - tips)
    return gap


def _fewer(
    shape: SetShape,
    sound: Mapping[str, Gear],
    pins: Mapping[str, Pin],
    close: list[tuple[str, str]],
) -> str:
    """How many planets would not touch."""
    for count in range(MOST_PLANETS, 0, -1):
        places = nearest_places(count, 0)
        if all(_gap(shape, sound, pins, places, one, two) > 0 for one, two in close):
            return f"Take fewer planets (at most {count} fit equally spaced)."
    return "Shorten their teeth, or change the centre distances."


def _side_by_side(
    shape: SetShape,
    sound: Mapping[str, Gear],
    positions: Mapping[str, float],
    one: str,
    two: str,
) -> bool:
    """True if the faces of two gears on planets are known to overlap along the axis."""
    bodies = shape.bodies[one], shape.bodies[two]
    if bodies[0] == bodies[1]:
        return one == two
    offsets = _axial_offsets(shape, positions, bodies[0])
    if bodies[1] not in offsets:
        return False
    apart = abs(offsets[bodies[1]] + positions[two] - positions[one])
    return apart < (sound[one].face_width + sound[two].face_width) / 2 - SAME_PLACE


def _axial_offsets(shape: SetShape, positions: Mapping[str, float], start: str) -> dict[str, float]:
    """Middle of each planet from that of `start`, as far as meshes tell: mates share a plane."""
    # a central gear stands for itself: how far apart two of them are on a shaft is not known here
    owners = {gear: body if body in shape.planets else gear for gear, body in shape.bodies.items()}
    offsets = {start: 0.0}
    left = [start]
    while left:
        known = left.pop()
        for mesh in shape.meshes:
            for near, far in ((mesh.first, mesh.second), (mesh.second, mesh.first)):
                if owners[near] == known and owners[far] not in offsets:
                    plane = offsets[known] + positions.get(near, 0.0)
                    offsets[owners[far]] = plane - positions.get(far, 0.0)
                    left.append(owners[far])
    return offsets
