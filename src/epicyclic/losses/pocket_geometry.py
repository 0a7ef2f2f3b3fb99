"""Pockets of a mesh in the transverse section, and the cells into which they are cut."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.cutting import Tool, tooth_outline
from epicyclic.gears.gear import Gear, involute
from epicyclic.gears.mesh import Mesh, with_faces
from epicyclic.kernels import pocket_geometry as kernels
from epicyclic.kernels.interpolation import monotone_cubic
from epicyclic.kernels.pocket_flow import SDIRK

# Pockets of a mesh in the transverse section, as tables over the rotation angle.
#
# A tooth of either gear in a space of the other encloses a pocket, between the narrowest gap on its
# leading side and the one on its trailing side. Seen along the mesh, pockets of both kinds
# alternate, and neighbours share a gap. A slice of a helical mesh is the same section at another
# angle, so one table serves all slices and all times. Talbot (2012), section 4.2.


Floats = NDArray[np.float64]

ANGLES = 769
"""Angles in each table: its cubics meet area and gap to a thousandth of a percent, about."""
MARGIN = 0.25
"""How far tables reach beyond the life of a pocket, because a cell lives while any part of it does:
more than a slice and a time step turn. [pitches]"""
OUTLINE_POINTS = 49  # Points on each section of an outline.


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
    pitch: float  # Angle of gear 1 in which the mesh repeats. [rad]


@lru_cache(maxsize=32)
def pocket_geometry(
    mesh: Mesh,
    # The tools that cut members 1 and 2, as for `tooth_outline`.
    tools: tuple[Tool | None, Tool | None],
    drives1: bool,  # True if member 1 drives, which puts the contact on its leading flanks.
    angles: int = ANGLES,  # Angles in each table.
) -> PocketGeometry:
    """Pockets of `mesh`. Raises `ValueError` if a tool cannot cut its gear."""
    return replace(_sections(with_faces(mesh, 1.0), tools, drives1, angles), mesh=mesh)


@lru_cache(maxsize=32)
def _sections(
    mesh: Mesh, tools: tuple[Tool | None, Tool | None], drives1: bool, angles: int
) -> PocketGeometry:
    """The same for all widths of the faces."""
    gears, figures = _section(mesh, tools, drives1)
    life = _lives(mesh, contact_clearances(mesh, drives1))
    half_pitch = math.pi / mesh.gear1.teeth
    margin = 2 * half_pitch * MARGIN
    angle = np.linspace(life[:, 0] - margin, life[:, 1] + margin, angles, axis=1)
    tables = np.stack([kernels.pocket_table(angle[k], k + 1, gears, figures) for k in (0, 1)])
    first = min(life[0, 0], life[1, 0] - half_pitch) - margin
    last = max(life[0, 1], life[1, 1] + half_pitch) + margin
    gap_angle = np.linspace(first, last, angles)
    gaps = [kernels.gap_table(gap_angle, leading, gears, figures) for leading in (1.0, -1.0)]
    width = np.stack([width for width, _ in gaps])
    middle = np.stack([(feet[:, 0] + feet[:, 1]) / 2 for _, feet in gaps])
    gap_middle = np.stack([middle.real, middle.imag], axis=-1)
    for array in (life, angle, tables, gap_angle, width, gap_middle):
        array.flags.writeable = False
    return PocketGeometry(
        mesh=mesh,
        life=life,
        angle=angle,
        area=tables[..., 0],
        centroid=tables[..., 1:],
        gap_angle=gap_angle,
        gap=width,
        gap_middle=gap_middle,
        pitch=2 * half_pitch,
    )


def pocket_outlines(
    mesh: Mesh,  # As for `pocket_geometry`.
    tools: tuple[Tool | None, Tool | None],  # As for `pocket_geometry`.
    drives1: bool,  # As for `pocket_geometry`.
    member: int,  # 1 or 2: whose tooth is in the space of the other.
    # Angle of that tooth of gear 1, or of that space of gear 1, from the line of centres. [rad]
    angle: Floats,
) -> NDArray[np.complex128]:
    """Outlines of the pockets of `mesh`, for pictures.

    Points x + iy around the pocket, as many as it has, then NaN; axes as of `centroid`. [m]
    """
    gears, figures = _section(mesh, tools, drives1)
    return kernels.pocket_outlines(angle, member, gears, figures)


def gap_feet(
    mesh: Mesh,  # As for `pocket_geometry`.
    tools: tuple[Tool | None, Tool | None],  # As for `pocket_geometry`.
    drives1: bool,  # As for `pocket_geometry`.
    leading: bool,  # True for the leading flank of the tooth of gear 1, False for the trailing one.
    angle: Floats,  # Angle of that tooth from the line of centres. [rad]
) -> NDArray[np.complex128]:
    """Points of both flanks where the gap between them is narrowest, for pictures.

    On gear 1 and on gear 2, axes as of `pocket_outlines`. [m]
    """
    gears, figures = _section(mesh, tools, drives1)
    return kernels.gap_table(angle, 1.0 if leading else -1.0, gears, figures)[1]


def _section(mesh: Mesh, tools: tuple[Tool | None, Tool | None], drives1: bool) -> tuple[Any, Any]:
    """Both gears and the figures of their mesh as the kernels take them."""
    figures = np.array(
        [
            mesh.side * mesh.center_distance,
            mesh.gear1.teeth,
            mesh.gear2.teeth,
            mesh.side,
            mesh.operating_pressure_angle,
            mesh.line_of_action,
            *contact_clearances(mesh, drives1),
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
    root, fillet, involute_end, corner = outline.joints
    points = outline.radius[: corner + 1] * np.exp(1j * outline.half_angle[: corner + 1])
    form, tip = map(gear.roll_length_at, (outline.form_radius, gear.tip_form_radius))
    at_base = gear.thickness_half_angle + gear.side * involute(gear.rack.transverse_pressure_angle)
    figures = np.array([gear.base_radius, at_base, form, tip, gear.side])
    return points, np.array([root, fillet, involute_end], dtype=np.float64), figures


def _lives(mesh: Mesh, clearances: tuple[float, float]) -> Floats:
    """Angles at which the first corner of a tooth enters the tip circle of the mate, and the last
    one leaves it. Theory (Q6)."""
    gear1, gear2 = mesh.gear1, mesh.gear2
    tip1, tip2, distance = gear1.tip_radius, gear2.tip_radius, mesh.center_distance
    # About each gear, where the tip circles cross. Seen from a ring, its own tip circle is the far
    # one and that of the planet the near one.
    cosine1 = mesh.side * (tip1**2 + distance**2 - tip2**2) / (2 * tip1 * distance)
    cosine2 = (tip2**2 + distance**2 - tip1**2) / (2 * tip2 * distance)
    crossing1, crossing2 = (math.acos(min(1.0, max(-1.0, it))) for it in (cosine1, cosine2))
    half1 = crossing1 + gear1.tip_half_angle
    half2 = (crossing2 + gear2.tip_half_angle) * mesh.ratio
    shift = (clearances[0] - clearances[1]) / 2 / gear1.base_radius
    return np.array([[-half1, half1], [-half2 - shift, half2 - shift]])


# Geometry of the cells into which the pockets of a mesh are cut, over one mesh period.

SLICES_PER_PITCH = 10  # Fewest slices for each pitch that the helix turns over the face.
LARGEST_END = 0.25  # Largest share of the face that either end slice takes. [1]


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """All cells at all times of a period, as the kernel takes them. Arrays are read-only.

    The times are the start of the period, and for each step its inner point and its end.
    """

    volume: Floats  # [m^3]
    # Growth of the volume in a stage of a step, at the rate of the end of the stage. [m^3]
    growth: Floats
    axial: Floats  # Areas of the openings between slices. [m^2]
    gap: Floats  # Areas of the openings between pockets. [m^2]
    axial_reach: Floats  # Distances of openings from the cells before and behind. [m]
    gap_reach: Floats  # Distances of openings from the cells before and behind. [m]
    live: NDArray[np.bool_]  # Which cells are pockets.
    place: Floats  # As for `PocketFlow`.
    station: Floats  # As for `PocketFlow`.
    face: Floats  # As for `PocketFlow`.

    @property
    def shape(self) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """What the kernel takes beside `live`."""
        return (self.volume, self.growth, self.axial, self.gap, self.axial_reach, self.gap_reach)


@lru_cache(maxsize=32)
def pocket_cells(
    geometry: PocketGeometry,
    slices: int,  # Across the face, at least; more where the helix turns far.
    steps: int,  # Time steps in one pitch.
    # Width of the first and of the last slice, if the face is wide enough; None for `slices` equal
    # ones, however far the helix turns. [m]
    end: float | None,
    inner: float = SDIRK,  # Where in a step its inner point lies. [1]
) -> Cells:
    """Cells of the pockets. Theory (Q7), (Q23)."""
    pitch = geometry.pitch
    face = _faces(geometry, slices, end)
    width = np.diff(face)
    start = np.arange(steps) / steps
    points = np.column_stack([start + inner / steps, start + 1 / steps]).ravel()
    times = np.concatenate([[0.0], points]) * pitch
    stations = _twist(geometry) * face / face[-1]
    teeth = _teeth(geometry, float(stations[-1]))
    # Every tooth of gear 1, and one more for the last gap: (times, teeth, stations).
    angle = times[:, None, None] + stations - (teeth * pitch)[:, None]
    spaces = [angle[:, :-1] - place * pitch / 2 for place in (0, 1)]
    inside = [
        _read(geometry.angle[k], (geometry.area[k], geometry.centroid[k]), spaces[k])
        for k in (0, 1)
    ]
    walls = [
        _read(geometry.gap_angle, (geometry.gap[k], geometry.gap_middle[k]), angle)[0]
        for k in (0, 1)
    ]
    area, rate = (_along_mesh([read[part][..., 0] for read in inside]) for part in (0, 1))
    centroid = _along_mesh([read[0][..., 1:] for read in inside])
    gap, middle = (_along_mesh([read[..., part] for read in walls]) for part in (0, np.s_[1:]))
    gap, middle = (_mean_of_ends(array[:, :-1]) for array in (gap, middle))
    volume = width * _mean_of_ends(area)
    cells = Cells(
        volume,
        _growth(volume, width * _mean_of_ends(rate), pitch / steps),
        area,
        width * gap,
        *_reaches(width, centroid, middle),
        live=_live(geometry, spaces),
        place=np.add.outer(-teeth[:-1], [0.0, -0.5]).ravel() * pitch,
        station=stations,
        face=face,
    )
    for array in (*cells.shape, cells.live, cells.place, cells.station, cells.face):
        array.flags.writeable = False
    return cells


def _reaches(
    width: Floats,  # [m]
    centroid: Floats,  # Centroids of the sections of the pockets. [m]
    middle: Floats,  # Middles of the gaps. [m]
) -> tuple[Floats, Floats]:
    """`Cells.axial_reach` and `Cells.gap_reach`."""
    cell = _mean_of_ends(centroid)
    axial = np.zeros((len(centroid), 2, *centroid.shape[1:3]))
    axial[:, 0, :, 1:] = np.hypot(width / 2, np.linalg.norm(centroid[:, :, 1:] - cell, axis=-1))
    axial[:, 1, :, :-1] = np.hypot(width / 2, np.linalg.norm(centroid[:, :, :-1] - cell, axis=-1))
    gap = np.zeros((len(middle), 2, *middle.shape[1:3]))
    gap[:, 0, 1:] = np.linalg.norm(middle[:, 1:] - cell, axis=-1)
    gap[:, 1, :-1] = np.linalg.norm(middle[:, :-1] - cell, axis=-1)
    return axial, gap


def _growth(volume: Floats, rate: Floats, step: float) -> Floats:
    """Growth of the volume in both stages of each step, together that in the step. Theory (Q17)."""
    growth = SDIRK * step * rate[1:]
    whole = volume[2::2] - volume[:-1:2]
    missing = whole - (1 - SDIRK) / SDIRK * growth[::2] - growth[1::2]
    growth += SDIRK * np.repeat(missing, 2, axis=0)
    return growth


def _live(geometry: PocketGeometry, spaces: list[Floats]) -> NDArray[np.bool_]:
    """Which cells are pockets: those whose middle is alive in the middle of a step."""
    alive = []
    for angle, life in zip(spaces, geometry.life, strict=True):
        middle = (angle[2::2, :, 1:] + angle[:-1:2, :, :-1]) / 2
        alive.append((middle > life[0]) & (middle < life[1]))
    flags: NDArray[np.bool_] = _along_mesh(alive)
    return flags


def _faces(geometry: PocketGeometry, slices: int, end: float | None) -> Floats:
    """Places of the faces between slices along the face width. Theory (Q23). [m]"""
    width = geometry.mesh.face_width
    if end is None:
        return np.linspace(0.0, width, slices + 1)
    # a whole number stays one whichever way it is rounded
    count = max(slices, math.ceil(SLICES_PER_PITCH * _twist(geometry) / geometry.pitch - 1e-9))
    end = min(end, LARGEST_END * width)
    return np.concatenate([[0.0], np.linspace(end, width - end, count - 1), [width]])


def _twist(geometry: PocketGeometry) -> float:
    """Angle of gear 1 that the helix turns over the common face width. Theory (Q7). [rad]"""
    gear = geometry.mesh.gear1
    return geometry.mesh.face_width * math.tan(gear.rack.helix_angle) / gear.reference_radius


def _teeth(geometry: PocketGeometry, twist: float) -> Floats:
    """Numbers of the teeth of gear 1 beside live pockets in a period, and of the one after."""
    pitch, life = geometry.pitch, geometry.life + np.array([[0.0], [geometry.pitch / 2]])
    first = math.floor(-life[:, 1].max() / pitch)
    last = math.ceil((pitch + twist - life[:, 0].min()) / pitch)
    return np.arange(first, last + 2, dtype=np.float64)


def _read(angle: Floats, columns: tuple[Floats, ...], at: Floats) -> tuple[Floats, Floats]:
    """Tables over n angles, together (n, k), and their slopes at angles of any shape, k last."""
    values, spacing = np.column_stack(columns), (angle[-1] - angle[0]) / (angle.size - 1)
    flat = np.ascontiguousarray(at).ravel()
    read, slope = monotone_cubic(float(angle[0]), float(spacing), values, flat)
    shape = (*at.shape, values.shape[1])
    return read.reshape(shape), slope.reshape(shape)


def _along_mesh(parts: list[Any]) -> Any:
    """Arrays of both kinds of pocket, teeth on the second axis, as one array of all pockets."""
    both = np.stack(parts, axis=2)
    return np.ascontiguousarray(both.reshape(both.shape[0], -1, *both.shape[3:]))


def _mean_of_ends(values: Floats) -> Floats:
    """Mean of the values at both ends of each slice, stations on the third axis."""
    return (values[:, :, :-1] + values[:, :, 1:]) / 2
