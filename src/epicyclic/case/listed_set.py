"""From the tables of a listed set to its gears, meshes and planets.

Its gears stand on bodies, of which those in `SetShape.planets` turn on pins of the carrier.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from epicyclic.case import build
from epicyclic.case.gear_tables import Gears
from epicyclic.case.tables.elements import PlanetBearing
from epicyclic.case.tables.lubrication import LubricationTable
from epicyclic.case.tables.models import (
    ContactSolver,
    FrictionTable,
    LossOption,
    Numerics,
    PlanetaryModels,
)
from epicyclic.case.tables.operation import Lubricant, Surroundings
from epicyclic.case.tables.thermal import ThermalTable
from epicyclic.case.train_shape import SetShape, ShapeMesh
from epicyclic.case.train_tables import ListedMesh, ListedSet
from epicyclic.gears.gear import Gear
from epicyclic.gears.mesh import Mesh, closing_number, nearest_places, pin_angle

RACK_KEYS = (
    ("normal_module", "transverse_module"),
    ("normal_pressure_angle", "transverse_pressure_angle"),
    ("helix_angle",),
)
"""Keys that a gear takes from what all gears share if it has none of them itself."""


@dataclass(frozen=True, slots=True)
class ListedCase:
    """A listed set of a train, with the oil and the surroundings of the train."""

    table: ListedSet
    shape: SetShape
    lubricant: Lubricant  # Tables of the train.
    surroundings: Surroundings  # Tables of the train.
    thermal: ThermalTable  # Tables of the train.
    friction_table: FrictionTable | None  # Tables of the train.
    contact_solver: ContactSolver  # Tables of the train.
    folder: Path  # Where the files lie that it names.

    @property
    def lubrication(self) -> LubricationTable | None:
        """Lubrication of the set."""
        return self.table.lubrication

    @property
    def models(self) -> PlanetaryModels:
        """Models of the set."""
        return self.table.models

    @property
    def numerics(self) -> Numerics:
        """Numerics of the set."""
        return self.table.numerics

    @property
    def planet_bearings(self) -> tuple[PlanetBearing | None, ...]:
        """The bearing of each kind of planets."""
        return tuple(bearing_of(self.table, body) for body in self.shape.planets)

    @property
    def loss_options(self) -> dict[str, LossOption]:
        """What becomes of each loss, in the order in which they are shown."""
        own, usual = self.table.losses, LossOption()
        return {name: own.get(name, usual) for name in terms_of(self.shape)}


@dataclass(frozen=True, slots=True)
class Pin:
    """Where the pin of a planet stands on its arm of the carrier."""

    radius: float  # From the axis of the set. [m]
    angle: float  # From the middle of the arm, positive in the sense of positive speeds. [rad]

    @property
    def place(self) -> tuple[float, float]:
        """x and y; the arm lies along x. [m]"""
        return self.radius * math.cos(self.angle), self.radius * math.sin(self.angle)


@dataclass(frozen=True, slots=True)
class Arrangement:
    """How the planets stand around the axis."""

    angles: tuple[float, ...]  # Angles of the arms of the carrier. [rad]
    number: int  # Alike planets fit at multiples of a turn over this number; 0: anywhere. [1]
    # True if the gears on one body must be turned against each other from planet to planet.
    individual: bool


def terms_of(shape: SetShape) -> tuple[str, ...]:
    """Names of the losses, in the order in which they are shown."""
    meshes = [mesh.key for mesh in shape.meshes]
    central = [gear for gear, body in shape.bodies.items() if body not in shape.planets]
    return (
        *(f"{key}_{kind}" for key in meshes for kind in ("sliding", "rolling")),
        *(f"{body}_bearing_{k}" for body in shape.planets for k in ("mechanical", "viscous")),
        *(f"{key}_pocketing" for key in meshes),
        *(f"{gear}_drag" for gear in central),
        *(("carrier_drag",) if shape.planets else ()),
    )


def bearing_of(table: ListedSet, body: str) -> PlanetBearing | None:
    """The bearing of the planets of a body."""
    return table.planet_bearings.get(body, table.planet_bearing)


# --- gears and meshes -----------------------------------------------------------------------------


def rack_keys(table: ListedSet, gear: str) -> dict[str, float]:
    """What is given of the basic rack of a gear: its own keys, else those that all gears share."""
    found: dict[str, float] = {}
    for group in RACK_KEYS:
        for owner in (table.members[gear], table.gears):
            own = {key: getattr(owner, key) for key in group if getattr(owner, key) is not None}
            if own:
                found |= own
                break
    return found


def gears_table(table: ListedSet, gear: str) -> Gears:
    """The basic rack of a gear in the form that gears are built from."""
    shared = table.gears
    values: dict[str, Any] = {
        "center_distance": shared.center_distance or 0.0,  # no gear depends on it
        "addendum_coefficient": shared.addendum_coefficient,
        "dedendum_coefficient": shared.dedendum_coefficient,
    }
    return Gears.model_construct(**(values | rack_keys(table, gear)))


def gear_of(table: ListedSet, gear: str) -> Gear:
    """A gear by its name.

    Raises
    ------
    ValueError
        If its tooth thickness is given inside the base circle.
    """
    return build.gear(gear, table.members[gear], gears_table(table, gear))


def pair_of(table: ListedSet, shape: SetShape, mesh: ShapeMesh) -> tuple[str, str]:
    """The gears of a mesh in the order in which the set lists them."""
    return table.meshes[shape.meshes.index(mesh)]


def own_mesh(table: ListedSet, pair: tuple[str, str]) -> tuple[str, ListedMesh]:
    """Name and table of a mesh."""
    one, two = pair
    names = (f"{one}-{two}", f"{two}-{one}")
    name = next((name for name in names if name in table.mesh), names[0])
    return name, table.mesh.get(name, ListedMesh())


def distance_key(table: ListedSet, shape: SetShape, mesh: ShapeMesh) -> str:
    """The key that states the centre distance of a mesh."""
    name, own = own_mesh(table, pair_of(table, shape, mesh))
    shared = own.center_distance is None and table.gears.center_distance is not None
    return "gears.center_distance" if shared else f"mesh.{name}.center_distance"


def distances_of(table: ListedSet, shape: SetShape) -> dict[str, float | None]:
    """Centre distance of each mesh by its key; None if nothing states it. [m]

    The central gears of a planet share its pin radius, so that one of its meshes tells it for all.
    """
    stated = {
        mesh.key: own_mesh(table, pair_of(table, shape, mesh))[1].center_distance
        or table.gears.center_distance
        for mesh in shape.meshes
    }
    radii: dict[str, float] = {}
    for mesh in shape.meshes:
        distance = stated[mesh.key]
        planet = planet_of(shape, mesh)
        if planet is not None and distance is not None:
            radii.setdefault(planet, distance)
    return {
        mesh.key: stated[mesh.key] or radii.get(planet_of(shape, mesh) or "")
        for mesh in shape.meshes
    }


def planet_of(shape: SetShape, mesh: ShapeMesh) -> str | None:
    """The planet of a mesh with a central gear; None for other meshes."""
    if central_gear(shape, mesh) is None:
        return None
    bodies = (shape.bodies[mesh.first], shape.bodies[mesh.second])
    return next(body for body in bodies if body in shape.planets)


def central_gear(shape: SetShape, mesh: ShapeMesh) -> str | None:
    """The gear of a mesh with a planet that turns about the axis of the set; None for others."""
    central = [
        gear for gear in (mesh.first, mesh.second) if shape.bodies[gear] not in shape.planets
    ]
    return central[0] if len(central) == 1 else None


def meshes_of(table: ListedSet, shape: SetShape) -> Iterator[tuple[ShapeMesh, Mesh, ListedMesh]]:
    """Every mesh, with its geometry and its table."""
    distances = distances_of(table, shape)
    for mesh in shape.meshes:
        pair = pair_of(table, shape, mesh)
        distance = distances[mesh.key]
        assert distance is not None
        gears = (gear_of(table, mesh.first), gear_of(table, mesh.second))
        yield mesh, Mesh(f"{'-'.join(pair)} mesh", *gears, distance), own_mesh(table, pair)[1]


def hands_of(table: ListedSet, shape: SetShape) -> dict[str, int]:
    """Hand of the helix of each gear, +1 right.

    As stated; mates demand the other of an external and the same of an internal mesh. What they
    leave open is as on the rest of the body, and of the first gear of the first mesh right.
    """
    gears = _in_order(table)
    hands = {
        gear: 1 if hand == "right" else -1
        for gear in gears
        if (hand := table.members[gear].hand) is not None
    }
    while len(hands) < len(gears):
        before = len(hands)
        for mesh in shape.meshes:
            for known, other in ((mesh.first, mesh.second), (mesh.second, mesh.first)):
                if known in hands and other not in hands:
                    hands[other] = hands[known] if mesh.internal else -hands[known]
        if len(hands) > before:
            continue
        of_body = {shape.bodies[gear]: hand for gear, hand in reversed(hands.items())}
        left = [gear for gear in gears if gear not in hands]
        nearest = next((gear for gear in left if shape.bodies[gear] in of_body), left[0])
        hands[nearest] = of_body.get(shape.bodies[nearest], 1)
    return hands


def _in_order(table: ListedSet) -> list[str]:
    """All gears in the order of the meshes; the order of tables in a file has no meaning."""
    return list(dict.fromkeys(gear for pair in table.meshes for gear in pair))


def positions_of(table: ListedSet, shape: SetShape) -> dict[str, float]:
    """Middle of the face of each gear on a planet from the middle of its bearing. [m]

    As stated; else the gears of a body stand side by side in the order of the meshes, the bearing
    in the middle of all.
    """
    positions = {}
    for body in shape.planets:
        gears = [gear for gear in _in_order(table) if shape.bodies[gear] == body]
        start = -sum(table.members[gear].face_width for gear in gears) / 2
        for gear in gears:
            width, stated = table.members[gear].face_width, table.members[gear].axial_position
            positions[gear] = start + width / 2 if stated is None else stated
            start += width
    return positions


# --- planets --------------------------------------------------------------------------------------


def pins_of(table: ListedSet, shape: SetShape) -> dict[str, Pin]:
    """Where the pins stand on an arm of the carrier, by the bodies of their planets. Theory (A4).

    The central gears of a planet give the radius of its pin; two planets that mesh with each other
    the angle between their pins: the second of a listed pair stands ahead of the first in the sense
    of positive speeds. A planet without a central gear has no place that this would determine, and
    is left out.

    Raises
    ------
    ValueError
        If two pins cannot stand at the distance of their planets.
    """
    distances = distances_of(table, shape)
    radii: dict[str, float] = {}
    for mesh in shape.meshes:
        planet, distance = planet_of(shape, mesh), distances[mesh.key]
        if planet is not None and distance is not None:
            radii.setdefault(planet, distance)
    between: dict[tuple[str, str], float] = {}
    for mesh in shape.meshes:
        one, two = (shape.bodies[gear] for gear in pair_of(table, shape, mesh))
        distance = distances[mesh.key]
        if one in radii and two in radii and distance is not None:
            angle = pin_angle(radii[one], radii[two], distance)
            between[one, two], between[two, one] = angle, -angle
    pins: dict[str, Pin] = {}
    for start in radii:
        found = [start] if start not in pins else []
        pins.setdefault(start, Pin(radii[start], 0.0))
        while found:
            known = found.pop(0)
            for (one, two), angle in between.items():
                if one == known and two not in pins:
                    pins[two] = Pin(radii[two], pins[known].angle + angle)
                    found.append(two)
    return pins


def outward_of(
    pins: Mapping[str, Pin],
    planet: str,
    mate: str | None,  # The body of another planet; None for a central gear.
) -> tuple[float, float]:
    """Unit vector along t and r from the pitch point with an external mate to a planet's axis.

    Theory (A5). For t and r see `epicyclic.machine.planets`.
    """
    if mate is None:
        return 0.0, 1.0
    own = pins[planet]
    x, y = (a - b for a, b in zip(own.place, pins[mate].place, strict=True))
    length = math.hypot(x, y)
    sine, cosine = math.sin(own.angle), math.cos(own.angle)
    return (x * sine - y * cosine) / length, (x * cosine + y * sine) / length


def directions_of(table: ListedSet, shape: SetShape) -> dict[str, float]:
    """Angle from the axis of the first to that of the second gear of each mesh, by its key. [rad]

    Of fixed axes as stated; of planets by the pins on the first arm.
    """
    pins = pins_of(table, shape)
    directions = {}
    for mesh in shape.meshes:
        one, two = pair_of(table, shape, mesh)
        angle = own_mesh(table, (one, two))[1].direction
        if shape.planets:
            places = [
                pins[body].place if body in pins else (0.0, 0.0)
                for body in (shape.bodies[one], shape.bodies[two])
            ]
            angle = math.atan2(places[1][1] - places[0][1], places[1][0] - places[0][0])
        directions[mesh.key] = angle if mesh.first == one else angle + math.pi
    return directions


def arrangement_of(shape: SetShape, planets: int) -> Arrangement:
    """The arms of the carrier: equally spaced if the planets can be assembled so. Theory (A7).

    Planets whose gears stand alike on their bodies are preferred to such that are made one by one,
    and these to unequal spacing.
    """
    number = closing_number(_closures(shape, shape.bodies))
    if number % planets == 0:
        return Arrangement(nearest_places(planets, number), number, individual=False)
    single = closing_number(_closures(shape, {gear: gear for gear in shape.bodies}))
    individual = single % planets == 0
    places = nearest_places(planets, single if individual else number)
    return Arrangement(places, number, individual)


def _closures(
    shape: SetShape, owners: Mapping[str, str]
) -> Sequence[tuple[Mapping[str, int], int]]:
    """Teeth on planets by `owners` of gears, and of the central gear, for `closing_number`."""
    closures = []
    for mesh in shape.meshes:
        central = central_gear(shape, mesh)
        teeth = dict(zip((mesh.first, mesh.second), map(int, mesh.teeth), strict=True))
        turned = 0 if central is None else teeth.pop(central)
        closures.append(
            (
                {owners[gear]: count for gear, count in teeth.items()},
                -turned if mesh.internal else turned,
            )
        )
    return closures
