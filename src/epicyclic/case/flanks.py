"""From the tables of a case to the deviations of its flanks."""

from __future__ import annotations

import math
from functools import lru_cache

from epicyclic.case.gear_tables import GearTable, MicroGeometryTable, Planet, TopographyTable
from epicyclic.gears.flanks import (
    FlankDeviations,
    MicroGeometry,
    Relief,
    Topography,
    active_profile,
)
from epicyclic.gears.gear import Gear
from epicyclic.gears.mesh import Mesh

Tables = tuple[GearTable, GearTable]


def micro_geometries(table: GearTable) -> tuple[MicroGeometryTable, ...]:
    """The tables of micro-geometry that a gear has."""
    ring_side = table.micro_geometry_ring_side if isinstance(table, Planet) else None
    return tuple(one for one in (table.micro_geometry, ring_side) if one is not None)


@lru_cache(maxsize=256)
def flank_deviations(mesh: Mesh, tables: Tables, misalignment: float) -> FlankDeviations:
    """The deviations of both working flanks of a mesh."""
    one, two = (_of_member(mesh, member, tables[member - 1]) for member in (1, 2))
    return FlankDeviations(one, two, misalignment)


def working_flank(member: int, table: GearTable) -> MicroGeometryTable | None:
    """The table of the flank of a member of a mesh that works in it.

    A planet's other flank works against the ring, where the planet is member 1.
    """
    if member == 1 and isinstance(table, Planet) and table.micro_geometry_ring_side is not None:
        return table.micro_geometry_ring_side
    return table.micro_geometry


def _of_member(mesh: Mesh, member: int, table: GearTable) -> MicroGeometry:
    flank = working_flank(member, table)
    if flank is None:
        return MicroGeometry()
    gear = (mesh.gear1, mesh.gear2)[member - 1]
    root, tip = active_profile(mesh, member)
    return MicroGeometry(
        tip_relief=_profile_relief(gear, tip, flank, "tip_relief"),
        root_relief=_profile_relief(gear, root, flank, "root_relief"),
        end_relief=None
        if flank.end_relief == 0 or flank.end_relief_length is None
        else Relief(flank.end_relief, flank.end_relief_length, flank.end_relief_shape),
        profile_crown=flank.profile_crown,
        profile_slope=flank.profile_slope,
        lead_crown=flank.lead_crown,
        lead_slope=flank.lead_slope,
        topography=None if flank.topography is None else _topography(gear, flank.topography),
    )


def _profile_relief(gear: Gear, end: float, flank: MicroGeometryTable, key: str) -> Relief | None:
    amount: float = getattr(flank, key)
    roll_length: float | None = getattr(flank, f"{key}_roll_length")
    diameter: float | None = getattr(flank, f"{key}_diameter")
    if diameter is not None:
        roll_length = abs(roll_length_at(gear, diameter / 2) - end)
    if amount == 0 or roll_length is None:
        return None
    return Relief(amount, roll_length, getattr(flank, f"{key}_shape"))


def roll_length_at(gear: Gear, radius: float) -> float:
    """Transverse radius of curvature of the involute at `radius`; 0 inside the base circle. [m]"""
    return math.sqrt(max(0.0, radius**2 - gear.base_radius**2))


def _topography(gear: Gear, table: TopographyTable) -> Topography:
    return Topography(
        tuple(roll_length_at(gear, diameter / 2) for diameter in table.diameter),
        table.face_position,
        table.deviation,
    )
