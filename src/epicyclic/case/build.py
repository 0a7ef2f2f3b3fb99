"""From the tables of a case to the gears and meshes they describe."""

from __future__ import annotations

import math
from functools import lru_cache

from epicyclic.case.gear_tables import Gears, GearTable, PairGear, Planet, Ring
from epicyclic.case.thickness import allowance_shift, half_angle
from epicyclic.gears.gear import BasicRack, Gear
from epicyclic.gears.mesh import Mesh, admissible_angles

DEFAULT_RIM_THICKNESS = 3.0
"""Rim of a ring gear from root to outside if the case states none (estimate). [normal modules]"""


@lru_cache(maxsize=256)
def basic_rack(gears: Gears) -> BasicRack:
    """Transverse module and pressure angle from whichever form the case gives."""
    cosine = math.cos(gears.helix_angle)
    if gears.transverse_module is not None:
        module = gears.transverse_module
    else:
        assert gears.normal_module is not None
        module = gears.normal_module / cosine
    if gears.transverse_pressure_angle is not None:
        angle = gears.transverse_pressure_angle
    else:
        assert gears.normal_pressure_angle is not None
        angle = math.atan(math.tan(gears.normal_pressure_angle) / cosine)
    return BasicRack(module, angle, gears.helix_angle)


def is_internal(table: GearTable) -> bool:
    """True for a ring gear."""
    return isinstance(table, Ring) or (isinstance(table, PairGear) and table.internal)


@lru_cache(maxsize=256)
def gear(name: str, table: GearTable, gears: Gears) -> Gear:
    """The gear that `table` describes.

    Raises
    ------
    ValueError
        If the tooth thickness is given, or the middle of measuring balls lies, inside the base
        circle.
    """
    rack = basic_rack(gears)
    internal = is_internal(table)
    half = half_angle(table, rack, internal=internal)
    # tip and root that the basic rack of ISO 53 would give (ISO 21771, Eq. 38 and 41)
    probe = Gear(name, rack, table.teeth, internal, half, 0.0, 0.0, table.face_width)
    outward = -1 if internal else 1
    shift = probe.profile_shift_coefficient
    nominal = shift - allowance_shift(table, rack)
    tip = probe.reference_radius + outward * rack.normal_module * (
        nominal + gears.addendum_coefficient
    )
    root = probe.reference_radius + outward * rack.normal_module * (
        shift - gears.dedendum_coefficient
    )
    return Gear(
        name=name,
        rack=rack,
        teeth=table.teeth,
        internal=internal,
        thickness_half_angle=half,
        tip_radius=tip if table.tip_diameter is None else table.tip_diameter / 2,
        root_radius=root if table.root_diameter is None else table.root_diameter / 2,
        face_width=table.face_width,
        tip_chamfer=table.tip_chamfer,
    )


@lru_cache(maxsize=256)
def planetary_meshes(gears: Gears, sun: GearTable, planet: Planet, ring: Ring) -> tuple[Mesh, Mesh]:
    """Sun-planet mesh (member 1 the sun) and planet-ring mesh (member 1 the planet)."""
    a = gears.distance
    planet_gear = gear("planet", planet, gears)
    return (
        Mesh("sun mesh", gear("sun", sun, gears), planet_gear, a),
        Mesh("ring mesh", planet_gear, gear("ring", ring, gears), a),
    )


@lru_cache(maxsize=256)
def pair_mesh(gears: Gears, pinion: GearTable, wheel: PairGear) -> Mesh:
    """The mesh of a gear pair, member 1 the pinion."""
    return Mesh("mesh", gear("pinion", pinion, gears), gear("gear", wheel, gears), gears.distance)


def planet_angles(sun: GearTable, planet: Planet, ring: Ring) -> tuple[float, ...]:
    """Positions of the planets: as given, or the admissible ones nearest to equal spacing."""
    if planet.angles is not None:
        return planet.angles
    return admissible_angles(planet.count, sun.teeth, ring.teeth)


def rim_thickness(table: GearTable) -> float | None:
    """Rim of a ring gear from root to outside; None if the case states none. [m]"""
    return table.rim_thickness if isinstance(table, Ring | PairGear) else None


def outside_radius(gear: Gear, table: GearTable) -> float:
    """Radius of the outside of a gear as a rotating body: tip circle, or back of the rim. [m]"""
    if not gear.internal:
        return gear.tip_radius
    rim = rim_thickness(table)
    return gear.root_radius + (
        DEFAULT_RIM_THICKNESS * gear.rack.normal_module if rim is None else rim
    )
