"""From the tables of a case to the gears and meshes they describe."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

from epicyclic.case.gear_tables import Gears, GearTable, PairGear, Planet, Ring
from epicyclic.geometry.assembly import admissible_angles
from epicyclic.geometry.gear import (
    BasicRack,
    Gear,
    half_angle_from_profile_shift,
    half_angle_from_thickness,
)
from epicyclic.geometry.generation import default_tool
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.outline import form_radius, tooth_outline
from epicyclic.geometry.tools import RackTool, ShaperTool, Tool

__all__ = [
    "basic_rack",
    "cutting_tool",
    "fitted_tool",
    "gear",
    "longest_involute",
    "outside_radius",
    "pair_mesh",
    "planet_angles",
    "planetary_meshes",
    "rim_thickness",
    "stated_tool",
]

DEFAULT_RIM_THICKNESS = 3.0
"""Rim of a ring gear from root to outside if the case states none (estimate). [normal modules]"""

TOOL_HALVINGS = 30
"""Halvings of the rounding of a tool until it is known: to a billionth."""


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


@lru_cache(maxsize=256)
def gear(name: str, table: GearTable, gears: Gears) -> Gear:
    """The gear that `table` describes.

    Raises
    ------
    ValueError
        If the tooth thickness is given inside the base circle.
    """
    rack = basic_rack(gears)
    internal = isinstance(table, Ring) or (isinstance(table, PairGear) and table.internal)
    if table.profile_shift_coefficient is not None:
        half_angle = half_angle_from_profile_shift(
            rack, table.teeth, table.profile_shift_coefficient
        )
    else:
        assert table.tooth_thickness is not None
        assert table.thickness_diameter is not None
        half_angle = half_angle_from_thickness(
            rack, table.teeth, internal, table.tooth_thickness, table.thickness_diameter / 2
        )
    # tip and root that the basic rack of ISO 53 would give (ISO 21771, Eq. 38 and 41)
    probe = Gear(name, rack, table.teeth, internal, half_angle, 0.0, 0.0, table.face_width)
    outward = -1 if internal else 1
    shift = probe.profile_shift_coefficient
    tip = probe.reference_radius + outward * rack.normal_module * (
        shift + gears.addendum_coefficient
    )
    root = probe.reference_radius + outward * rack.normal_module * (
        shift - gears.dedendum_coefficient
    )
    return Gear(
        name=name,
        rack=rack,
        teeth=table.teeth,
        internal=internal,
        thickness_half_angle=half_angle,
        tip_radius=tip if table.tip_diameter is None else table.tip_diameter / 2,
        root_radius=root if table.root_diameter is None else table.root_diameter / 2,
        face_width=table.face_width,
        tip_chamfer=table.tip_chamfer,
    )


@lru_cache(maxsize=256)
def planetary_meshes(gears: Gears, sun: GearTable, planet: Planet, ring: Ring) -> tuple[Mesh, Mesh]:
    """Sun-planet mesh (member 1 the sun) and planet-ring mesh (member 1 the planet)."""
    a = gears.center_distance
    planet_gear = gear("planet", planet, gears)
    return (
        Mesh("sun mesh", gear("sun", sun, gears), planet_gear, a),
        Mesh("ring mesh", planet_gear, gear("ring", ring, gears), a),
    )


@lru_cache(maxsize=256)
def pair_mesh(gears: Gears, pinion: GearTable, wheel: PairGear) -> Mesh:
    """The mesh of a gear pair, member 1 the pinion."""
    return Mesh(
        "mesh", gear("pinion", pinion, gears), gear("gear", wheel, gears), gears.center_distance
    )


def longest_involute(gear: Gear, table: GearTable) -> float:
    """Radius at which the involute of `gear` ends towards its root, as long as a tool leaves it.

    That is the tool of the case, or else one with sharp corners. If these undercut the tooth, it is
    the rack with just the rounding that lets the involute begin at the base circle; if they cut
    away the tips of a ring, the default shaper cutter.

    Raises
    ------
    ValueError
        If no tool generates the tooth.
    """
    stated = stated_tool(gear, table)
    if not gear.internal:
        tool = _kindest_rack(gear) if stated is None else stated
        if _sharp_undercut(gear) > 0:
            tooth_outline(gear, tool, points=8)  # raises if undercut severs the teeth
        return form_radius(gear, tool)
    if stated is not None:
        return form_radius(gear, stated)
    shaper = default_tool(gear)
    assert isinstance(shaper, ShaperTool)
    try:
        return form_radius(gear, ShaperTool(shaper.teeth, 0.0))
    except ValueError:
        return form_radius(gear, shaper)


def stated_tool(gear: Gear, table: GearTable) -> Tool | None:
    """The tool that cuts `gear` with the tip rounding of the case; None if the case has none.

    Raises
    ------
    ValueError
        If no default shaper cutter generates a ring.
    """
    if table.tool_tip_radius is None:
        return None
    if not gear.internal:
        return RackTool(table.tool_tip_radius)
    shaper = default_tool(gear)
    assert isinstance(shaper, ShaperTool)
    return ShaperTool(shaper.teeth, table.tool_tip_radius)


def cutting_tool(gear: Gear, table: GearTable) -> Tool:
    """The tool that leaves the root fillet: of the case, or the default one if it cuts the tooth.

    If that one does not, it is the tool that leaves the longest involute.

    Raises
    ------
    ValueError
        If no tool generates the tooth.
    """
    stated = stated_tool(gear, table)
    if stated is not None:
        return stated
    tool = default_tool(gear)
    try:
        tooth_outline(gear, tool)
    except ValueError:
        if gear.internal:
            raise
        return _kindest_rack(gear)
    return tool


def _kindest_rack(gear: Gear) -> RackTool:
    sine = math.sin(gear.rack.normal_pressure_angle)
    return RackTool(max(0.0, _sharp_undercut(gear)) / (1 - sine))


def _sharp_undercut(gear: Gear) -> float:
    """How far a rack with sharp corners reaches beyond the start of the involute. [m]

    Negative if it does not reach that far: no undercut.
    """
    cosine = math.cos(gear.rack.transverse_pressure_angle)
    return gear.reference_radius * cosine**2 - gear.root_radius


@lru_cache(maxsize=256)
def fitted_tool(gear: Gear, table: GearTable, needed: float) -> Tool:
    """`cutting_tool`, its rounding reduced where it would take away involute that the mate needs.

    A rounding that the case states is kept.

    Parameters
    ----------
    gear : Gear
    table : GearTable
    needed : float
        Radius to which the involute must reach towards the root. [m]

    Raises
    ------
    ValueError
        If no tool generates the tooth.
    """
    usual = cutting_tool(gear, table)
    outward = -1 if gear.internal else 1

    def suits(rounding: float) -> bool:
        try:
            reached = form_radius(gear, replace(usual, tip_radius=rounding))
        except ValueError:
            return False
        return outward * (reached - needed) <= 0

    low = 0.0 if gear.internal else _kindest_rack(gear).tip_radius
    high = usual.tip_radius
    if table.tool_tip_radius is not None or suits(high) or not suits(low):
        return usual
    for _ in range(TOOL_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if suits(middle) else (low, middle)
    return replace(usual, tip_radius=low)


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
