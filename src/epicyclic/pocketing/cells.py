"""Geometry of the cells into which the pockets of a mesh are cut, over one mesh period."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.monotone_cubic import monotone_cubic
from epicyclic.kernels.pocket_flow import SDIRK
from epicyclic.pocketing.geometry import PocketGeometry

Floats = NDArray[np.float64]

SLICES_PER_PITCH = 10
"""Fewest slices for each pitch that the helix turns over the face."""
LARGEST_END = 0.25
"""Largest share of the face that either end slice takes. [1]"""


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """All cells at all times of a period, as the kernel takes them. Arrays are read-only.

    The times are the start of the period, and for each step its inner point and its end.
    """

    volume: Floats  # [m^3]
    # Growth of the volume in a stage of a step, at the rate of the end of the stage. [m^3]
    growth: Floats
    axial: Floats  # Areas of openings. [m^2]
    gap: Floats  # Areas of openings. [m^2]
    axial_reach: Floats  # Distances of openings from the cells before and behind. [m]
    gap_reach: Floats  # Distances of openings from the cells before and behind. [m]
    live: NDArray[np.bool_]  # Which cells are pockets.
    place: Floats  # As for `PocketFlow`.
    station: Floats  # As for `PocketFlow`.
    face: Floats  # As for `PocketFlow`.

    @property
    def shape(self) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """What the kernel takes beside `live`."""
        return (
            self.volume,
            self.growth,
            self.axial,
            self.gap,
            self.axial_reach,
            self.gap_reach,
        )


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
    areas = [_read(geometry.angle[k], geometry.area[k][:, None], spaces[k]) for k in (0, 1)]
    area, rate = (_along_mesh([pair[part][..., 0] for pair in areas]) for part in (0, 1))
    centroid, gap, middle = (
        _along_mesh([_read(angles[k], values[k], at[k])[0] for k in (0, 1)])
        for angles, values, at in (
            (geometry.angle, geometry.centroid, spaces),
            ((geometry.gap_angle,) * 2, geometry.gap[..., None], (angle,) * 2),
            ((geometry.gap_angle,) * 2, geometry.gap_middle, (angle,) * 2),
        )
    )
    gap, middle = (_mean_of_ends(array[:, :-1]) for array in (gap[..., 0], middle))
    volume = width * _mean_of_ends(area)
    growth = _growth(volume, width * _mean_of_ends(rate), pitch / steps)
    cells = Cells(
        volume,
        growth,
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
    """Growth of the volume in both stages of each step, together what it grows in the step.

    Theory (Q17).
    """
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
    count = max(slices, math.ceil(SLICES_PER_PITCH * _twist(geometry) / geometry.pitch))
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


def _read(angle: Floats, values: Floats, at: Floats) -> tuple[Floats, Floats]:
    """A table of shape (n, k) and its slope at angles of any shape, k last."""
    spacing = (angle[-1] - angle[0]) / (angle.size - 1)
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
    mean: Floats = (values[:, :, :-1] + values[:, :, 1:]) / 2
    return mean
