"""Paths of heat between gears, planets, carriers, bearings and oil, and what stores heat."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from epicyclic.arrays import larger
from epicyclic.contact.temperatures import Solid
from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.gear import HOUSING, Gear
from epicyclic.losses.planet_bearing import RollerBearing
from epicyclic.machine.convection import SPLASHED_WALL, Fluid, dipped_disc, disc_coefficient
from epicyclic.machine.disc import Disc
from epicyclic.machine.element import OIL, joined_key
from epicyclic.machine.gear_set import GearSet, Planet
from epicyclic.machine.heat_flow import Link
from epicyclic.machine.shaft_parts import ShaftBearing

INLET = "oil_inlet"  # The oil before it meets anything.
WIDTH_OF_HEIGHT = 1.2
"""Width of a bearing over the height of its section, if it is not given: an estimate. [1]"""
SEAT_LENGTH = 1.0  # Length of a pin in both of its seats over its diameter: an estimate. [1]
FACES = "rotating faces"
BATH = "gear in an oil bath"
JET = "oil from a jet"
SEAT = "press fit"
ROLLERS = "loaded rollers"
DISC_SOURCE = "Levich; Gregory and Riddiford (1956); Dorfman (1963), second hand"
BATH_SOURCE = "R. F. Handschuh (NASA), second hand"
HERE = "derived here"
ESTIMATE = "estimate"


@dataclass(frozen=True, slots=True)
class Wetting:
    """What meets the surfaces of the gears, and how well solids that touch pass heat on."""

    around: Fluid  # The mixture of oil and air, or the oil that gears dip into.
    bath: float  # Share of the surfaces that dips into an oil bath; 0 in a spray. [1]
    jet: float  # Heat capacity of the oil flow times the effectiveness of the jets. [W/K]
    jet_shares: Mapping[str, float]  # Shares of the flow that meet each node. [1]
    press_fit: float  # Contact conductance of a press fit, by area. [W/(m^2 K)]


class Seen(NamedTuple):
    """What of a solution the paths of heat depend on."""

    speeds: Mapping[str, float]  # Of every body. [rad/s]
    heat: Mapping[str, float]  # That losses bring to each node, less that of a cooler. [W]
    rollers: Mapping[str, float]  # Conductance of each planet bearing, by its key. [W/K]


@dataclass(frozen=True, slots=True)
class OneGear:
    """A gear of a set as heat sees it."""

    node: str
    body: str
    gear: Gear
    material: Solid
    count: int


def gear_set_links(own: GearSet, seen: Seen, wetting: Wetting) -> Iterator[Link]:
    """Paths of the heat of a set. Theory (W29), (W30), (W31)."""
    planets = {planet.nodes[0]: planet for planet in own.planets}
    on: dict[str, list[OneGear]] = {}  # the gears of each node, which oil meets as one
    for one in gears_of(own):
        on.setdefault(one.node, []).append(one)
    for node, gears in on.items():
        planet = planets.get(node)
        reference = own.carrier if planet else HOUSING
        speed = abs(seen.speeds[gears[0].body] - seen.speeds[reference])
        yield from _jet(node, wetting)
        faces = [link for one in gears for link in _gear_to_oil(one, speed, planet, wetting)]
        if faces:
            yield replace(faces[0], conductance=sum(link.conductance for link in faces))
        if planet is None and any(one.gear.internal for one in gears) and not speed:
            yield from _ring_to_housing(own, gears[0], wetting)
    for planet in own.planets:
        yield from _planet_to_carrier(own, planet, seen, wetting)
    yield from _carrier_to_oil(own, seen, wetting)


def gears_of(own: GearSet) -> Iterator[OneGear]:
    """Every gear once, though it may have several mates."""
    planets = {planet.nodes[0] for planet in own.planets}
    seen: set[tuple[str, str]] = set()
    for mesh in own.meshes:
        for node, body, gear, material in zip(
            mesh.nodes, mesh.bodies, (mesh.mesh.gear1, mesh.mesh.gear2), mesh.materials, strict=True
        ):
            if (node, gear.name) not in seen:
                seen.add((node, gear.name))
                yield OneGear(node, body, gear, material, own.count if node in planets else 1)


def _gear_to_oil(
    one: OneGear, speed: float, planet: Planet | None, wetting: Wetting
) -> Iterator[Link]:
    gear = one.gear
    outer = max(gear.tip_radius, gear.root_radius)
    inner = gear.tip_radius if gear.internal else 0.0
    if planet is not None and planet.bearing is not None:
        inner = planet.bearing.bearing.outer_diameter / 2
    if wetting.bath:
        conductance, how = _in_bath(gear, speed, inner, wetting), (BATH, BATH_SOURCE)
    elif speed and outer > inner:
        coefficient = disc_coefficient(wetting.around, speed, outer, inner)
        conductance, how = coefficient * _faces(outer, inner), (FACES, DISC_SOURCE)
    else:
        return
    yield Link(f"{one.node}-oil", one.node, OIL, one.count * conductance, *how)


def _in_bath(gear: Gear, speed: float, inner: float, wetting: Wetting) -> float:
    """Conductance of faces and flanks that dip; at rest they are splashed like walls. [W/K]"""
    outer = max(gear.tip_radius, gear.root_radius)
    flanks = 2 * gear.teeth * abs(gear.tip_radius - gear.root_radius) * gear.face_width
    coefficient = larger(dipped_disc(wetting.around, speed, 2 * outer), SPLASHED_WALL)
    return wetting.bath * coefficient * (_faces(outer, min(inner, outer)) + flanks)


def _faces(outer: float, inner: float) -> float:
    """Both faces of a ring. [m^2]"""
    return 2 * math.pi * (outer**2 - inner**2)


def _jet(node: str, wetting: Wetting) -> Iterator[Link]:
    """Oil that comes from the inlet and takes heat of a part along."""
    share = wetting.jet_shares.get(node, 0.0)
    if share and wetting.jet:
        yield Link(f"{node}-jet", node, INLET, share * wetting.jet, JET, ESTIMATE, OIL)


def _discs(own: GearSet) -> list[Disc]:
    return [disc for discs in own.discs.values() for disc in discs]


def _ring_to_housing(own: GearSet, one: OneGear, wetting: Wetting) -> Iterator[Link]:
    """A ring gear that stands still is pressed into the housing."""
    outsides = [disc.turning for disc in _discs(own) if disc.body == one.body]
    area = 2 * math.pi * sum(disc.radius * disc.width for disc in outsides)
    yield Link(f"{one.node}-housing", one.node, HOUSING, wetting.press_fit * area, SEAT, ESTIMATE)


def _planet_to_carrier(
    own: GearSet, planet: Planet, seen: Seen, wetting: Wetting
) -> Iterator[Link]:
    if planet.bearing is None:
        return
    node, pin = planet.nodes
    rollers = own.count * seen.rollers[joined_key(own.key, planet.key)]
    yield Link(f"{node}-{pin}", node, pin, rollers, ROLLERS, HERE)
    seat = math.pi * SEAT_LENGTH * planet.bearing.bearing.inner_diameter**2
    carrier = carrier_node(own)
    yield from _jet(pin, wetting)
    pins = own.count * wetting.press_fit * seat
    yield Link(f"{pin}-{carrier}", pin, carrier, pins, SEAT, ESTIMATE)


def carrier_node(own: GearSet) -> str:
    """The thermal node of the carrier of a set."""
    return joined_key(own.key, "carrier")


def _carrier_to_oil(own: GearSet, seen: Seen, wetting: Wetting) -> Iterator[Link]:
    if not any(planet.bearing for planet in own.planets):
        return
    known = [disc for disc in _discs(own) if disc.where == "carrier"]
    radius = known[0].turning.radius if known else max(planet.pin_radius for planet in own.planets)
    speed = abs(seen.speeds[own.carrier])
    node = carrier_node(own)
    area = _faces(radius, 0.0)
    if wetting.bath:
        dipped = larger(dipped_disc(wetting.around, speed, 2 * radius), SPLASHED_WALL)
        coefficient, how = wetting.bath * dipped, (BATH, BATH_SOURCE)
    else:
        coefficient, how = disc_coefficient(wetting.around, speed, radius), (FACES, DISC_SOURCE)
    yield Link(f"{node}-oil", node, OIL, coefficient * area, *how)


def bearing_links(own: ShaftBearing, wetting: Wetting) -> Iterator[Link]:
    """A bearing gives its heat off through the seat of its outer ring."""
    if HOUSING in own.between:
        area = math.pi * own.bearing.outside_diameter * bearing_width(own)
        seat = wetting.press_fit * area
        yield Link(f"{own.key}-housing", own.key, HOUSING, seat, SEAT, ESTIMATE)
    yield from _jet(own.key, wetting)


def bearing_width(own: ShaftBearing) -> float:
    """As given, or estimated from the height of the section. [m]"""
    bearing = own.bearing
    if bearing.width > 0:
        return bearing.width
    return WIDTH_OF_HEIGHT * (bearing.outside_diameter - bearing.bore) / 2


STEEL = Solid(conductivity=46.0, heat_capacity=460.0, density=7850.0)
"""Material of parts for which no case states one: pins, carriers, shaft bearings."""
OF_SHAFT = 500.0
"""Heat capacity of a shaft between gears and bearings, about 1 kg of steel: an estimate. [J/K]"""
CARRIER_FILL = 0.5
"""Steel in the disc that a carrier describes; the rest is windows and planets: an estimate. [1]"""
BEARING_FILL = 0.7
"""Steel in the ring between bore and outside of a rolling bearing: an estimate. [1]"""


def gear_set_capacities(own: GearSet) -> dict[str, float]:
    """Heat capacities of gears, planets together, pins, carrier. Theory (W33), (W34). [J/K]"""
    bores = {
        planet.nodes[0]: planet.bearing.bearing.outer_diameter / 2
        for planet in own.planets
        if planet.bearing
    }
    found: dict[str, float] = {}
    for one in gears_of(own):
        radius = one.gear.reference_radius
        other = bores.get(one.node, 0.0)
        if one.gear.internal:  # the outside is that of its disc
            other = max(disc.turning.radius for disc in _discs(own) if disc.body == one.body)
        area = math.pi * abs(radius**2 - other**2)
        stored = one.count * _stored(one.material, area * one.gear.face_width)
        found[one.node] = found.get(one.node, 0.0) + stored
    for planet in own.planets:
        if planet.bearing is not None:
            bearing = planet.bearing.bearing
            diameter = bearing.inner_diameter
            length = SEAT_LENGTH * diameter
            if isinstance(bearing, RollerBearing):
                length += bearing.rows * bearing.roller_length
            else:
                length += bearing.length
            pin = _stored(STEEL, math.pi / 4 * diameter**2 * length)
            found[planet.nodes[1]] = own.count * pin
            found[carrier_node(own)] = _stored(STEEL, CARRIER_FILL * _carrier_volume(own))
    return found


def bearing_capacity(own: ShaftBearing) -> float:
    """Heat capacity of both rings and the rollers. Theory (W34). [J/K]"""
    bearing = own.bearing
    area = math.pi / 4 * (bearing.outside_diameter**2 - bearing.bore**2)
    return _stored(STEEL, BEARING_FILL * area * bearing_width(own))


def _stored(solid: Solid, volume: float) -> float:
    return solid.density * solid.heat_capacity * volume


def _carrier_volume(own: GearSet) -> float:
    """Volume of the disc of the carrier, or of one that reaches around the pins. [m^3]"""
    discs = [disc for disc in _discs(own) if disc.where == "carrier"]
    if discs:
        return math.pi * discs[0].turning.radius ** 2 * discs[0].turning.width
    pins = [planet.bearing.bearing.inner_diameter for planet in own.planets if planet.bearing]
    radius = max(planet.pin_radius for planet in own.planets) + max(pins)
    width = max(one.gear.face_width for one in gears_of(own)) + SEAT_LENGTH * max(pins)
    return math.pi * radius**2 * width
