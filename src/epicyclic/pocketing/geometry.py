"""Pockets of a mesh in the transverse section, as tables over the rotation angle.

A tooth of either gear in a space of the other encloses a pocket, between the narrowest gap on its
leading side and the one on its trailing side. Seen along the mesh, pockets of both kinds alternate,
and neighbours share a gap. A slice of a helical mesh is the same section at another angle, so one
table serves all slices and all times. Talbot (2012), section 4.2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.geometry.gear import Gear, involute
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.outline import tooth_outline
from epicyclic.geometry.tools import Tool
from epicyclic.kernels import pocket_geometry as kernels

Floats = NDArray[np.float64]

ANGLES = 769
"""Angles in each table: its cubics meet area and gap to a thousandth of a percent, about."""
MARGIN = 0.25
"""How far tables reach beyond the life of a pocket, because a cell lives while any part of it does:
more than a slice and a time step turn. [pitches]"""
OUTLINE_POINTS = 49
"""Points on each section of an outline."""


@dataclass(frozen=True, slots=True, eq=False)
class PocketGeometry:
    """Pockets of a mesh in the transverse section.

    The first index of `area`, `centroid` and `life` is the member whose tooth is in a space of the
    other, less one. Arrays are read-only.
    """

    mesh: Mesh
    # Angles of birth and death of a pocket: of the tooth of gear 1, or of the space of gear 1 in
    # which a tooth of gear 2 is, from the line of centres. [rad]
    life: Floats
    # Angles of `area` and `centroid`, evenly spaced, from a little before the life to a little
    # after it. [rad]
    angle: Floats
    area: Floats  # End area of the pocket. [m^2]
    centroid: Floats  # About the axis of gear 1, the line of centres along x. [m]
    gap_angle: Floats  # Angles of the gaps: of the tooth of gear 1 that they belong to. [rad]
    gap: Floats  # Narrowest gap at the leading and at the trailing flank of that tooth. [m]
    gap_middle: Floats  # As `centroid`. [m]

    @property
    def pitch(self) -> float:
        """Angle of gear 1 in which the mesh repeats. [rad]"""
        return 2 * math.pi / self.mesh.gear1.teeth


@lru_cache(maxsize=32)
def pocket_geometry(
    mesh: Mesh,
    # The tools that cut members 1 and 2, as for `tooth_outline`.
    tools: tuple[Tool | None, Tool | None],
    drives1: bool,  # True if member 1 drives, which puts the contact on its leading flanks.
    angles: int = ANGLES,  # Angles in each table.
) -> PocketGeometry:
    """Pockets of `mesh`.

    Returns
    -------
    PocketGeometry

    Raises
    ------
    ValueError
        If a tool cannot cut its gear.
    """
    gears, figures = _section(mesh, tools, drives1)
    life = _lives(mesh, contact_clearances(mesh, drives1))
    half_pitch = math.pi / mesh.gear1.teeth
    margin = 2 * half_pitch * MARGIN
    angle = np.linspace(life[:, 0] - margin, life[:, 1] + margin, angles, axis=1)
    tables = np.stack([kernels.pocket_table(angle[k], k + 1, gears, figures) for k in (0, 1)])
    first = min(life[0, 0], life[1, 0] - half_pitch) - margin
    last = max(life[0, 1], life[1, 1] + half_pitch) + margin
    gap_angle = np.linspace(first, last, angles)
    gaps = np.stack(
        [kernels.gap_table(gap_angle, leading, gears, figures) for leading in (1.0, -1.0)]
    )
    geometry = PocketGeometry(
        mesh=mesh,
        life=life,
        angle=angle,
        area=tables[..., 0],
        centroid=tables[..., 1:],
        gap_angle=gap_angle,
        gap=gaps[..., 0],
        gap_middle=gaps[..., 1:],
    )
    for array in (life, angle, tables, gap_angle, gaps):
        array.flags.writeable = False
    return geometry


def pocket_outlines(
    mesh: Mesh,  # As for `pocket_geometry`.
    tools: tuple[Tool | None, Tool | None],  # As for `pocket_geometry`.
    drives1: bool,  # As for `pocket_geometry`.
    member: int,  # 1 or 2: whose tooth is in the space of the other.
    # Angle of that tooth of gear 1, or of that space of gear 1, from the line of centres. [rad]
    angle: Floats,
) -> NDArray[np.complex128]:
    """Outlines of the pockets of `mesh`, for pictures.

    Returns
    -------
    ndarray of complex, shape (n, m)
        Points x + iy around the pocket, as many as it has, then NaN; axes as of `centroid`. [m]
    """
    gears, figures = _section(mesh, tools, drives1)
    outlines: NDArray[np.complex128] = kernels.pocket_outlines(angle, member, gears, figures)
    return outlines


def gap_feet(
    mesh: Mesh,  # As for `pocket_geometry`.
    tools: tuple[Tool | None, Tool | None],  # As for `pocket_geometry`.
    drives1: bool,  # As for `pocket_geometry`.
    leading: bool,  # True for the leading flank of the tooth of gear 1, False for the trailing one.
    angle: Floats,  # Angle of that tooth from the line of centres. [rad]
) -> NDArray[np.complex128]:
    """Points of both flanks where the gap between them is narrowest, for pictures.

    Returns
    -------
    ndarray of complex, shape (n, 2)
        On gear 1 and on gear 2, axes as of `pocket_outlines`. [m]
    """
    gears, figures = _section(mesh, tools, drives1)
    feet: NDArray[np.complex128] = kernels.gap_feet(angle, 1.0 if leading else -1.0, gears, figures)
    return feet


def _section(mesh: Mesh, tools: tuple[Tool | None, Tool | None], drives1: bool) -> tuple[Any, Any]:
    """Both gears and the figures of their mesh as the kernels take them."""
    clearances = contact_clearances(mesh, drives1)
    figures = np.array(
        [
            mesh.side * mesh.center_distance,
            mesh.gear1.teeth,
            mesh.gear2.teeth,
            mesh.side,
            mesh.operating_pressure_angle,
            mesh.line_of_action,
            *clearances,
        ]
    )
    return (*_flank(mesh.gear1, tools[0]), *_flank(mesh.gear2, tools[1])), figures


def contact_clearances(mesh: Mesh, drives1: bool) -> tuple[float, float]:
    """Clearances of the leading and of the trailing flanks along the line of action. [m]"""
    backlash = mesh.backlash * math.cos(mesh.operating_pressure_angle)
    return (0.0, backlash) if drives1 else (backlash, 0.0)


def _flank(gear: Gear, tool: Tool | None) -> tuple[NDArray[np.complex128], Floats, Floats]:
    """Flank, joints and figures of a gear as the kernels take them."""
    outline = tooth_outline(gear, tool, OUTLINE_POINTS)
    outward = -1.0 if gear.internal else 1.0
    root, fillet, involute_end, corner = outline.joints
    points = outline.radius[: corner + 1] * np.exp(1j * outline.half_angle[: corner + 1])
    base = gear.base_radius
    form = math.sqrt(max(0.0, outline.form_radius**2 - base**2))
    at_base = gear.thickness_half_angle + outward * involute(gear.rack.transverse_pressure_angle)
    figures = np.array([base, at_base, form, gear.tip_form_involute_length, outward])
    return points, np.array([root, fillet, involute_end], dtype=np.float64), figures


def _lives(mesh: Mesh, clearances: tuple[float, float]) -> Floats:
    """Angles at which the first corner of a tooth enters the tip circle of the mate, and the last
    one leaves it. Theory (Q6)."""
    gear1, gear2 = mesh.gear1, mesh.gear2
    crossing1 = _crossing(gear1.tip_radius, gear2.tip_radius, mesh.center_distance, mesh.internal)
    half1 = crossing1 + gear1.tip_half_angle
    # Seen from a ring, its own tip circle is the far one and that of the planet the near one.
    cosine = (gear2.tip_radius**2 + mesh.center_distance**2 - gear1.tip_radius**2) / (
        2 * gear2.tip_radius * mesh.center_distance
    )
    crossing2 = math.acos(min(1.0, max(-1.0, cosine)))
    half2 = (crossing2 + gear2.tip_half_angle) * mesh.ratio
    shift = (clearances[0] - clearances[1]) / 2 / gear1.base_radius
    return np.array([[-half1, half1], [-half2 - shift, half2 - shift]])


def _crossing(tip1: float, tip2: float, center_distance: float, internal: bool) -> float:
    """Angle about gear 1, from the line of centres, at which the tip circles cross. [rad]"""
    side = -1.0 if internal else 1.0
    cosine = side * (tip1**2 + center_distance**2 - tip2**2) / (2 * tip1 * center_distance)
    return math.acos(min(1.0, max(-1.0, cosine)))
