"""Flanks in mesh: contact lines, deviations of micro geometry, parameters of roughness."""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import Literal

import numpy as np

from epicyclic.arrays import FloatArray, on_grid
from epicyclic.dataclass import dataclass
from epicyclic.gears.gear import Gear
from epicyclic.gears.mesh import Mesh

# Contact lines in the plane of action, at every mesh position of one base pitch.
#
# The plane of action is unrolled: `x` runs along the path of contact and is the transverse radius
# of curvature of member 1, `y` runs across the common face. A contact line leans by the base helix
# angle: x = x0 - y tan(beta_b). Lines follow each other at the transverse base pitch.

# A line leaning less than this over the whole face, in base pitches, counts as straight (spur).
_SPUR_OVERLAP = 1e-9

ReliefShape = Literal["linear", "parabolic"]


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
    # y at the middle of each segment, from the end of the face where contact begins if gear 1
    # drives. [m]
    face_position: FloatArray
    length: FloatArray  # Length of each segment along the contact line. [m]


@lru_cache(maxsize=64)
def contact_lines(
    mesh: Mesh,
    positions: int,  # Mesh positions over one base pitch, about: each interval gets at least one.
    segments: int,  # Segments on each contact line.
) -> ContactLines:
    """Contact lines of `mesh` over one base pitch. Theory (G25), (G26).

    Every line is cut into `segments` equal parts of its own length. The mesh positions are the
    middles of equal parts of the intervals between which lines enter and leave, so that averages
    over the mesh period converge with the second order for spur gears as well.
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
    arrays = (tau, weight, curvature1, mesh.curvature2(curvature1), y, np.array(length))
    for array in arrays:
        array.flags.writeable = False
    return ContactLines(*arrays)


def _positions(mesh: Mesh, count: int) -> tuple[FloatArray, FloatArray]:
    """Middles and widths of `count` parts of one base pitch, cut where lines enter and leave.

    Theory (G27).
    """
    transverse, overlap = mesh.transverse_contact_ratio, mesh.overlap_ratio
    corners = (transverse, overlap, transverse + overlap)
    breaks = np.unique([0.0, *(corner % 1.0 for corner in corners), 1.0])
    parts = [np.empty(0)]
    widths = [np.empty(0)]
    for start, end in pairwise(breaks):
        n = max(1, round(count * (end - start)))
        parts.append(start + (np.arange(n) + 0.5) * (end - start) / n)
        widths.append(np.full(n, (end - start) / n))
    return np.concatenate(parts), np.concatenate(widths)


# Intended and unintended deviations of flanks: what they leave open in the contact of a mesh.
#
# Deviations are stated as a gear measuring machine shows them, in the transverse section tangent to
# the base circle (ISO 21771, ISO 1328-1), and positive where material is missing. Profile positions
# are roll lengths: transverse radii of curvature of the involute. Face positions count from the end
# of the face where contact begins while member 1 drives.

_EXPONENTS = {"linear": 1, "parabolic": 2}


@dataclass(frozen=True, slots=True)
class Relief:
    """Material removed towards one end of a flank."""

    amount: float  # At the end. [m]
    length: float  # From the end to where the relief starts. [m]
    # ``"linear"`` or ``"parabolic"``, tangent to the flank where it starts.
    shape: ReliefShape = "linear"

    def at(self, distance: FloatArray) -> FloatArray:
        """Deviation at a `distance` from the end. Theory (G37). [m]"""
        return self.amount * np.clip(1 - distance / self.length, 0.0, 1.0) ** _EXPONENTS[self.shape]


@dataclass(frozen=True, slots=True)
class Topography:
    """Measured deviations of a flank: linear between the points, constant beyond them."""

    curvature: tuple[float, ...]  # Rising roll lengths. [m]
    face_position: tuple[float, ...]  # Rising positions across the face width of the gear. [m]
    deviation: tuple[tuple[float, ...], ...]  # One row for each roll length. [m]

    def at(self, curvature: FloatArray, face_position: FloatArray) -> FloatArray:
        """Deviation at points of the flank. [m]"""
        axes = (self.curvature, self.face_position)
        return on_grid(axes, self.deviation, (curvature, face_position))


@dataclass(frozen=True, slots=True)
class MicroGeometry:
    """Deviations of the flanks of one gear on the side that works in one mesh."""

    # From the tip, and from the end of the active profile at the root; lengths of roll.
    tip_relief: Relief | None = None
    root_relief: Relief | None = None
    end_relief: Relief | None = None  # From both ends of the face.
    # Over the active profile; the slope is positive if material is missing at the tip. [m]
    profile_crown: float = 0.0
    profile_slope: float = 0.0
    # Over the face width of the gear; the slope is positive if material is missing at the end where
    # contact ends. [m]
    lead_crown: float = 0.0
    lead_slope: float = 0.0
    topography: Topography | None = None  # Added to the rest.

    def deviation(
        self,
        gear: Gear,
        # Roll lengths at the root end and at the tip end of the active profile. [m]
        active: tuple[float, float],
        curvature: FloatArray,  # Roll lengths of the points. [m]
        face_position: FloatArray,  # From the end of the face of the gear where contact begins. [m]
    ) -> FloatArray:
        """Material missing at points of the flank of `gear`. Theory (G38)."""
        root, tip = active
        along = (curvature - root) / (tip - root)
        across = face_position / gear.face_width
        deviation: FloatArray = (
            self.profile_crown * (2 * along - 1) ** 2
            + self.profile_slope * along
            + self.lead_crown * (2 * across - 1) ** 2
            + self.lead_slope * across
        )
        if self.tip_relief is not None:
            deviation = deviation + self.tip_relief.at(np.abs(tip - curvature))
        if self.root_relief is not None:
            deviation = deviation + self.root_relief.at(np.abs(curvature - root))
        if self.end_relief is not None:
            nearer_end = np.minimum(face_position, gear.face_width - face_position)
            deviation = deviation + self.end_relief.at(nearer_end)
        if self.topography is not None:
            deviation = deviation + self.topography.at(curvature, face_position)
        return deviation


@dataclass(frozen=True, slots=True)
class FlankDeviations:
    """Everything that keeps the flanks of a mesh from touching along their whole contact lines."""

    member1: MicroGeometry = MicroGeometry()
    member2: MicroGeometry = MicroGeometry()
    # F_beta_x: how much further apart the flanks are at the end of the common face where contact
    # ends than where it begins, in the transverse plane of action. ISO 6336-1. [m]
    misalignment: float = 0.0
    # True if gear 2 drives: contact begins at the end of the path, and of the face, where it ends
    # if gear 1 drives.
    mirrored: bool = False

    @lru_cache(maxsize=64)  # noqa: B019 - the few deviations that it keeps are small
    def separation(self, mesh: Mesh, lines: ContactLines) -> FloatArray:
        """Gap of unloaded flanks along the common normal, on all segments. Theory (G39). [m]"""
        # lines that are not in contact lie beyond the path of contact: any place on it serves
        rho1 = np.clip(lines.curvature1, mesh.path_start, mesh.path_end)
        rho2 = mesh.curvature2(rho1)
        y = mesh.face_width - lines.face_position if self.mirrored else lines.face_position
        gap = self.misalignment * y / mesh.face_width
        for member, flank, gear, rho in (
            (1, self.member1, mesh.gear1, rho1),
            (2, self.member2, mesh.gear2, rho2),
        ):
            overhang = (gear.face_width - mesh.face_width) / 2
            gap = gap + flank.deviation(gear, active_profile(mesh, member), rho, y + overhang)
        gap *= math.cos(mesh.gear1.rack.base_helix_angle)
        gap.flags.writeable = False
        return gap


def active_profile(mesh: Mesh, member: int) -> tuple[float, float]:
    """Roll lengths at root end and tip end of the active profile of a member. Theory (G36). [m]"""
    if member == 1:
        return mesh.path_start, mesh.path_end
    return mesh.curvature2(mesh.path_end), mesh.curvature2(mesh.path_start)


# Parameters of rough profiles, and how they are converted into each other.

RUNNING_IN = 0.65
"""Roughness after running-in over that as made: 0.6 to 0.7 of it is left (estimate). [1]"""
PROFILE_CUTOFF = 0.8e-3  # l_c of profiles of Ra 0.1 to 2 um, ISO 21920-3, [m]
MIDDLE_OF_CLASS = 0.45e-6  # and the middle of that class, as a geometric mean. [m]
HURST_EXPONENT = 0.5
"""H of machined surfaces: variance of heights grows with length (Sayles, Thomas 1978). [1]"""
RA_OVER_RQ = math.sqrt(2 / math.pi)  # Ra/Rq of a Gaussian profile. [1]

RZ_OVER_RA = 6.0  # Rz/Ra, DIN 3991 approximation, as the FVA-Workbench uses it. [1]

RZ_BAND = (4.0, 7.0)  # Rz/Ra of real surfaces, a rule of thumb of the trade. [1]


def rq_of(
    parameter: str,  # ``"Rq"``, ``"Ra"`` (DIN EN ISO 4287) or ``"Rz"``.
    value: float,  # [m]
) -> float:
    """Rms roughness Rq of a surface of which another parameter is stated.

    [m]

    Examples
    --------
    >>> round(1e6 * rq_of("Rz", 3e-6), 3)
    0.627
    """
    return {"Rq": 1.0, "Ra": 1 / RA_OVER_RQ, "Rz": 1 / (RZ_OVER_RA * RA_OVER_RQ)}[parameter] * value
