"""Mass and inertia of the parts of a case, and stiffness and transmission error of its meshes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from epicyclic.build.models import set_cases
from epicyclic.case.case import Case
from epicyclic.gears.gear import CARRIER, Gear
from epicyclic.gears.gearing import outside_radius
from epicyclic.gears.stated import StatedGear
from epicyclic.machine.element import joined_key


@dataclass(frozen=True, slots=True)
class Part:
    """One kind of part of a gearbox."""

    name: str
    count: int
    mass: float  # Of one. [kg]
    inertia: float  # Of one about its own axis. [kg m^2]
    circle: float = 0.0  # Radius of the circle on which its axis turns with the carrier. [m]

    @property
    def carried_inertia(self) -> float:
        """What all of them add to the inertia of the carrier as point masses. [kg m^2]"""
        return self.count * self.mass * self.circle**2


def hollow_disc(radius: float, bore: float, width: float, density: float) -> tuple[float, float]:
    """Mass [kg] and inertia [kg m^2] of a disc with a bore, both as radii. [m]

    Examples
    --------
    The pinion of the third stage of the NREL, 200.47 kg and 3.877 kg m^2 in print:

    >>> mass, inertia = hollow_disc(0.3501850 / 2, 0.17910 / 2, 0.360, 7830.0)
    >>> round(mass, 1), round(inertia, 2)
    (200.5, 3.88)
    """
    mass = math.pi * (radius**2 - bore**2) * width * density
    return mass, mass * (radius**2 + bore**2) / 2


def gear_body(gear: Gear, table: StatedGear, bore: float = 0.0) -> tuple[float, float]:
    """Mass and inertia of a gear, its teeth as a disc to half their depth; a ring with its rim."""
    middle = (gear.tip_radius + gear.root_radius) / 2
    radius, inner = middle, bore
    if gear.internal:
        radius, inner = outside_radius(gear, table), middle
    return hollow_disc(radius, inner, gear.face_width, table.material.density)


def parts(case: Case) -> tuple[Part, ...]:
    """Every gear and carrier of a case whose sizes it knows.

    Central external gears are solid to their axis, planets to the bore of their bearing; a carrier
    is a disc without the room of its planets. Shafts, pins, rollers and housing are left out.

    Examples
    --------
    >>> from epicyclic import load_case
    >>> [(part.name, part.count) for part in parts(load_case("talbot-2012"))]
    [('sun', 1), ('planet', 3), ('ring', 1), ('carrier', 1)]
    """
    return tuple(_parts(case))


def _parts(case: Case) -> Iterator[Part]:
    for name, own in set_cases(case).items():
        gearing, planets, room = own.gearing, own.gearing.count or 1, 0.0
        pins = gearing.pins if gearing.planets else {}
        for key, table in gearing.tables.items():
            body, gear = gearing.bodies[key], gearing.gear(key)
            turning = body in gearing.planets
            bearing = own.bearings.get(body)
            bore = 0.0
            if turning and bearing is not None:
                rollers = 2 * getattr(bearing, "roller_diameter", 0.0)
                bore = (bearing.pin_diameter + rollers + bearing.diametral_clearance) / 2
            mass, inertia = gear_body(gear, table, bore)
            if turning:
                room += planets * math.pi * gear.tip_radius**2 * gear.face_width
            circle = pins[body].radius if turning else 0.0
            yield Part(joined_key(name, key), planets if turning else 1, mass, inertia, circle)
        table_of_carrier = getattr(own, "carrier", None)
        if table_of_carrier is not None:
            radius = table_of_carrier.outer_diameter / 2
            disc, inertia = hollow_disc(radius, 0.0, table_of_carrier.width, 7850.0)
            solid = max(0.2, 1 - room / (math.pi * radius**2 * table_of_carrier.width))
            yield Part(joined_key(name, CARRIER), 1, solid * disc, solid * inertia)


def as_list(found: tuple[Part, ...]) -> list[dict[str, str | float]]:
    """Parts as JSON holds them, with units in the keys."""
    return [
        {
            "name": part.name,
            "count": part.count,
            "mass_kg": part.mass,
            "inertia_kg_m2": part.inertia,
            "carrier_circle_m": part.circle,
        }
        for part in found
    ]
