"""Where the gears of a set stand, and how they must be turned for their teeth to mesh."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from epicyclic.builders.gearing import SetCase
from epicyclic.case import build
from epicyclic.case.case import GearPairCase, PlanetaryCase
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.listed_set import ListedCase, arrangement_of, directions_of, pins_of
from epicyclic.geometry.mesh import Mesh

Point = tuple[float, float]
"""x and y of a centre. [m]"""
Place = tuple[float, float, float]
"""x and y of the centre [m], direction of the first tooth [rad]."""
UP = math.pi / 2
HALF = 0.5
"""Part of a pitch by which a tooth is away from the space beside it."""


@dataclass(frozen=True, slots=True)
class SetPlaces:
    """What is to be drawn of a set."""

    tables: Mapping[str, GearTable]  # Tables of its gears, by name.
    # Where each gear stands; several times on the planets. [m]
    centers: Mapping[str, tuple[Point, ...]]
    bodies: Mapping[str, str]  # The body of each gear: gears of one body turn together.

    def places(self, meshes: Sequence[Mesh]) -> dict[str, list[Place]]:
        """Centres with the directions of the first teeth, the first gear with a tooth upwards."""
        directions = tooth_directions(self.centers, self.bodies, meshes)
        return {
            name: [(*center, turn) for center, turn in zip(centers, directions[name], strict=True)]
            for name, centers in self.centers.items()
        }

    def relative_speeds(self, meshes: Sequence[Mesh]) -> dict[str, float]:
        """Speed of each gear over that of the first one, seen from the carrier; 0 if unrelated."""
        known = {next(iter(self.bodies.values())): 1.0}
        grows = True
        while grows:
            before = len(known)
            for mesh in meshes:
                one, two = self.bodies[mesh.gear1.name], self.bodies[mesh.gear2.name]
                ratio = -mesh.side * mesh.gear1.teeth / mesh.gear2.teeth
                if one in known:
                    known.setdefault(two, known[one] * ratio)
                elif two in known:
                    known[one] = known[two] / ratio
            grows = len(known) > before
        return {name: known.get(body, 0.0) for name, body in self.bodies.items()}


def places_of(
    case: SetCase,
    meshes: Mapping[str, Mesh],  # By their keys.
) -> SetPlaces | None:
    """Gears and centres of a set; None if the case does not tell where all of them stand."""
    if isinstance(case, PlanetaryCase):
        return _of_planetary(case)
    if isinstance(case, GearPairCase):
        return _of_pair(case, next(iter(meshes.values())))
    return _of_listed(case, meshes)


def _of_planetary(case: PlanetaryCase) -> SetPlaces:
    tables = {"sun": case.sun, "planet": case.planet, "ring": case.ring}
    angles = build.planet_angles(case.sun, case.planet, case.ring)
    middle = ((0.0, 0.0),)
    around = tuple(_polar(case.gears.distance, UP + angle) for angle in angles)
    centers = {"sun": middle, "planet": around, "ring": middle}
    return SetPlaces(tables, centers, {name: name for name in tables})


def _of_pair(case: GearPairCase, mesh: Mesh) -> SetPlaces:
    """The pinion at the origin, or inside an internal gear there."""
    tables = {"pinion": case.pinion, "gear": case.gear}
    ends = ((0.0, 0.0),), ((case.gears.distance, 0.0),)
    pinion, gear = reversed(ends) if mesh.gear2.internal else ends
    return SetPlaces(tables, {"pinion": pinion, "gear": gear}, {name: name for name in tables})


def _of_listed(case: ListedCase, meshes: Mapping[str, Mesh]) -> SetPlaces | None:
    shape, table = case.shape, case.table
    bodies = _on_carrier(case) if shape.planets else _on_fixed_axes(case, meshes)
    if not set(shape.bodies.values()) <= bodies.keys():
        return None
    centers = {name: bodies[body] for name, body in shape.bodies.items()}
    return SetPlaces(table.members, centers, shape.bodies)


def _on_carrier(case: ListedCase) -> dict[str, tuple[Point, ...]]:
    shape, table = case.shape, case.table
    arms = arrangement_of(shape, table.planets or 1).angles
    found: dict[str, tuple[Point, ...]] = {
        body: ((0.0, 0.0),) for body in shape.bodies.values() if body not in shape.planets
    }
    for body, pin in pins_of(table, shape).items():
        found[body] = tuple(_polar(pin.radius, UP + arm + pin.angle) for arm in arms)
    return found


def _on_fixed_axes(case: ListedCase, meshes: Mapping[str, Mesh]) -> dict[str, tuple[Point, ...]]:
    """Each body beside the one that it meshes with, from the first at the origin."""
    shape, directions = case.shape, directions_of(case.table, case.shape)
    found: dict[str, tuple[Point, ...]] = {shape.bodies[shape.meshes[0].first]: ((0.0, 0.0),)}
    grows = True
    while grows:
        before = len(found)
        for mesh in shape.meshes:
            one, two = shape.bodies[mesh.first], shape.bodies[mesh.second]
            angle, distance = directions[mesh.key], meshes[mesh.key].center_distance
            for known, other, way in ((one, two, angle), (two, one, angle + math.pi)):
                if known in found and other not in found:
                    (x, y), (dx, dy) = found[known][0], _polar(distance, way)
                    found[other] = ((x + dx, y + dy),)
        grows = len(found) > before
    return found


def _polar(radius: float, angle: float) -> Point:
    return radius * math.cos(angle), radius * math.sin(angle)


# --- how gears are turned -------------------------------------------------------------------------


def tooth_directions(
    centers: Mapping[str, Sequence[Point]],  # By gear. [m]
    # By gear: where no mesh decides, the gears of one body point the same way.
    bodies: Mapping[str, str],
    meshes: Sequence[Mesh],
) -> dict[str, list[float]]:
    """Direction of a tooth of every gear at every place, so that teeth stand in spaces.

    Nothing is checked: whether the set can be assembled so is a matter of the case.

    Returns
    -------
    dict of str to list of float
        By gear; the first one points upwards. [rad]
    """
    known: dict[_Stand, float] = {}
    stands = [(name, number) for name in centers for number in range(len(centers[name]))]
    while left := [stand for stand in stands if stand not in known]:
        found = next(_through_meshes(centers, meshes, known), None)
        if found is None:
            found = next(_on_known_bodies(left, bodies, known), (left[0], UP))
        stand, turn = found
        known[stand] = turn
    return {name: [known[name, number] for number in range(len(centers[name]))] for name in centers}


_Stand = tuple[str, int]
"""A gear and the number of its place."""


def _through_meshes(
    centers: Mapping[str, Sequence[Point]], meshes: Sequence[Mesh], known: Mapping[_Stand, float]
) -> Iterator[tuple[_Stand, float]]:
    """Gears whose mates are known, with their directions."""
    for mesh in meshes:
        one, two = mesh.gear1.name, mesh.gear2.name
        for own, other in ((one, two), (two, one)):
            for number in range(max(len(centers[own]), len(centers[other]))):
                ends = [(name, min(number, len(centers[name]) - 1)) for name in (own, other)]
                if ends[0] in known and ends[1] not in known:
                    (px, py), (x, y) = (centers[name][place] for name, place in ends)
                    angle = math.atan2(y - py, x - px)
                    yield ends[1], _meshing(mesh, own == one, known[ends[0]], angle)


def _on_known_bodies(
    left: Sequence[_Stand], bodies: Mapping[str, str], known: Mapping[_Stand, float]
) -> Iterator[tuple[_Stand, float]]:
    """Gears beside which another one of their body is known."""
    for name, number in left:
        for (other, place), turn in known.items():
            if (bodies[other], place) == (bodies[name], number):
                yield (name, number), turn


def _meshing(
    mesh: Mesh,
    forward: bool,  # True from gear 1 to gear 2.
    turn: float,  # [rad]
    angle: float,  # From the centre of the gear to that of its mate. [rad]
) -> float:
    """Direction of a tooth of the mate of a gear with a tooth at `turn`, its centre lies ahead."""
    one, two = mesh.gear1.teeth, mesh.gear2.teeth
    own, mate = (one, two) if forward else (two, one)
    if not mesh.gear2.internal:
        passed = (angle - turn) * own / (2 * math.pi)
        return angle + math.pi - (HALF - passed) * 2 * math.pi / mate
    # the pitch point lies beyond the pinion, seen from the centre of the internal gear
    outwards = angle + math.pi if forward else angle
    passed = (outwards - turn) * own / (2 * math.pi)
    return outwards - (passed + (HALF if forward else -HALF)) * 2 * math.pi / mate
