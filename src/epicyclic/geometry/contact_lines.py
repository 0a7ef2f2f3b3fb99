"""Contact lines in the plane of action, at every mesh position of one base pitch.

The plane of action is unrolled: `x` runs along the path of contact and is the transverse radius of
curvature of member 1, `y` runs across the common face. A contact line leans by the base helix
angle: x = x0 - y tan(beta_b). Lines follow each other at the transverse base pitch.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from epicyclic.geometry.mesh import Mesh

FloatArray = NDArray[np.float64]

# A line leaning less than this over the whole face, in base pitches, counts as straight (spur).
_SPUR_OVERLAP = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class ContactLines:
    """All contact lines of all tooth pairs, cut into segments.

    Arrays of shape (positions, lines, segments) unless stated otherwise. A line that is not in
    contact has segments of zero length.
    """

    position: FloatArray  # Mesh position, 0 <= tau < 1, in base pitches. [1]
    weight: FloatArray  # Share of the mesh period that each position stands for; sums to 1. [1]
    # Transverse radii of curvature of the two members at the middle of each segment. [m]
    curvature1: FloatArray
    curvature2: FloatArray
    # y at the middle of each segment, from the end of the face where contact begins. [m]
    face_position: FloatArray
    length: FloatArray  # Length of each segment along the contact line. [m]

    @property
    def total_length(self) -> FloatArray:
        """Total length of the contact lines at each mesh position. [m]"""
        total: FloatArray = self.length.sum(axis=(1, 2))
        return total


@lru_cache(maxsize=64)
def contact_lines(
    mesh: Mesh,
    positions: int,  # Mesh positions over one base pitch, about: each interval gets at least one.
    segments: int,  # Segments on each contact line.
) -> ContactLines:
    """Contact lines of `mesh` over one base pitch.

    Theory (G25), (G26).

    Every line is cut into `segments` equal parts of its own length. The mesh positions are the
    middles of equal parts of the intervals between which lines enter and leave, so that averages
    over the mesh period converge with the second order for spur gears as well.

    Returns
    -------
    ContactLines
    """
    rack = mesh.gear1.rack
    pitch = rack.transverse_base_pitch
    lean = math.tan(rack.base_helix_angle)
    spur = mesh.overlap_ratio < _SPUR_OVERLAP
    tau, weight = _positions(mesh, positions)

    count = math.ceil(mesh.transverse_contact_ratio + mesh.overlap_ratio)
    x0 = mesh.path_start + (tau[:, None] + np.arange(count)) * pitch
    if spur:
        low = np.zeros_like(x0)
        high = np.where(x0 <= mesh.path_end, mesh.face_width, 0.0)
    else:
        low = np.clip((x0 - mesh.path_end) / lean, 0.0, mesh.face_width)
        high = np.clip((x0 - mesh.path_start) / lean, 0.0, mesh.face_width)
    fraction = (np.arange(segments) + 0.5) / segments
    y = low[..., None] + (high - low)[..., None] * fraction
    curvature1 = x0[..., None] - y * (0.0 if spur else lean)
    length = np.broadcast_to(
        ((high - low) / (segments * math.cos(rack.base_helix_angle)))[..., None], y.shape
    )
    arrays = (
        tau,
        weight,
        curvature1,
        mesh.line_of_action - mesh.side * curvature1,
        y,
        np.array(length),
    )
    for array in arrays:
        array.flags.writeable = False
    return ContactLines(*arrays)


def _positions(mesh: Mesh, count: int) -> tuple[FloatArray, FloatArray]:
    """Middles and widths of `count` parts of one base pitch, cut where lines enter and leave.

    Theory (G27).
    """
    corners = (
        mesh.transverse_contact_ratio,
        mesh.overlap_ratio,
        mesh.transverse_contact_ratio + mesh.overlap_ratio,
    )
    breaks = np.unique([0.0, *(corner % 1.0 for corner in corners), 1.0])
    parts = [np.empty(0)]
    widths = [np.empty(0)]
    for start, end in pairwise(breaks):
        n = max(1, round(count * (end - start)))
        parts.append(start + (np.arange(n) + 0.5) * (end - start) / n)
        widths.append(np.full(n, (end - start) / n))
    return np.concatenate(parts), np.concatenate(widths)
