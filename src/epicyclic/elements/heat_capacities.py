"""Heat that gears, pins, carriers and bearings store, from their sizes."""

from __future__ import annotations

import math

from epicyclic.elements.gear_set import GearSet
from epicyclic.elements.heat_paths import (
    SEAT_LENGTH,
    OneGear,
    bearing_width,
    carrier_node,
    gears_of,
)
from epicyclic.elements.shaft_bearing import ShaftBearing
from epicyclic.thermal.solids import Solid

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
        other = _outside(own, one) if one.gear.internal else bores.get(one.node, 0.0)
        area = math.pi * abs(radius**2 - other**2)
        stored = one.count * _stored(one.material, area * one.gear.face_width)
        found[one.node] = found.get(one.node, 0.0) + stored
    for planet in own.planets:
        if planet.bearing is not None:
            bearing = planet.bearing.bearing
            diameter = bearing.inner_diameter
            length = bearing.rows * bearing.roller_length + SEAT_LENGTH * diameter
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


def _outside(own: GearSet, one: OneGear) -> float:
    """Radius of the outside of a ring gear, which its disc has. [m]"""
    return max(
        disc.radius for discs in own.discs.values() for disc in discs if disc.body == one.body
    )


def _carrier_volume(own: GearSet) -> float:
    """Volume of the disc of the carrier, or of one that reaches around the pins. [m^3]"""
    discs = [disc for discs in own.discs.values() for disc in discs if disc.where == "carrier"]
    if discs:
        return math.pi * discs[0].radius ** 2 * discs[0].width
    pins = [planet.bearing.bearing.inner_diameter for planet in own.planets if planet.bearing]
    radius = max(planet.pin_radius for planet in own.planets) + max(pins)
    width = max(one.gear.face_width for one in gears_of(own)) + SEAT_LENGTH * max(pins)
    return math.pi * radius**2 * width
