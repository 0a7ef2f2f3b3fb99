"""Intended and unintended deviations of flanks: what they leave open in the contact of a mesh.

Deviations are stated as a gear measuring machine shows them, in the transverse section tangent to
the base circle (ISO 21771, ISO 1328-1), and positive where material is missing. Profile positions
are roll lengths: transverse radii of curvature of the involute. Face positions count from the end
of the face where contact begins while member 1 drives.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from epicyclic.geometry.contact_lines import ContactLines
from epicyclic.geometry.gear import Gear
from epicyclic.geometry.mesh import Mesh

FloatArray = NDArray[np.float64]

_EXPONENTS = {"linear": 1, "parabolic": 2}


@dataclass(frozen=True, slots=True)
class Relief:
    """Material removed towards one end of a flank."""

    amount: float  # At the end. [m]
    length: float  # From the end to where the relief starts. [m]
    # ``"linear"`` or ``"parabolic"``, tangent to the flank where it starts.
    shape: Literal["linear", "parabolic"] = "linear"

    def at(self, distance: FloatArray) -> FloatArray:
        """Deviation at a `distance` from the end. Theory (G37). [m]"""
        share = np.clip(1 - distance / self.length, 0.0, 1.0)
        deviation: FloatArray = self.amount * share ** _EXPONENTS[self.shape]
        return deviation


@dataclass(frozen=True, slots=True)
class Topography:
    """Measured deviations of a flank: linear between the points, constant beyond them."""

    curvature: tuple[float, ...]  # Rising roll lengths. [m]
    face_position: tuple[float, ...]  # Rising positions across the face width of the gear. [m]
    deviation: tuple[tuple[float, ...], ...]  # One row for each roll length. [m]

    def at(self, curvature: FloatArray, face_position: FloatArray) -> FloatArray:
        """Deviation at points of the flank. [m]"""
        from scipy.interpolate import RegularGridInterpolator

        axes = (self.curvature, self.face_position)
        table = RegularGridInterpolator(axes, np.asarray(self.deviation))
        points = np.stack(
            [
                np.clip(curvature, axes[0][0], axes[0][-1]),
                np.clip(face_position, axes[1][0], axes[1][-1]),
            ],
            axis=-1,
        )
        deviation: FloatArray = table(points)
        return deviation


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
        """Material missing at points of the flank of `gear`.

        Theory (G38).
        """
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

    def separation(self, mesh: Mesh, lines: ContactLines) -> FloatArray:
        """Gap of the unloaded flanks along the common normal on all segments of `lines`.

        Theory (G39).

        Returns
        -------
        ndarray, shape (positions, lines, segments)
            [m]
        """
        # lines that are not in contact lie beyond the path of contact: any place on it serves
        rho1 = np.clip(lines.curvature1, mesh.path_start, mesh.path_end)
        rho2 = mesh.line_of_action - mesh.side * rho1
        gap = self.misalignment * lines.face_position / mesh.face_width
        for member, flank, gear, rho in (
            (1, self.member1, mesh.gear1, rho1),
            (2, self.member2, mesh.gear2, rho2),
        ):
            overhang = (gear.face_width - mesh.face_width) / 2
            gap = gap + flank.deviation(
                gear, active_profile(mesh, member), rho, lines.face_position + overhang
            )
        normal: FloatArray = gap * math.cos(mesh.gear1.rack.base_helix_angle)
        return normal


def active_profile(mesh: Mesh, member: int) -> tuple[float, float]:
    """Roll lengths at the root end and at the tip end of the active profile of a member. [m]

    Theory (G36).
    """
    if member == 1:
        return mesh.path_start, mesh.path_end
    return mesh.curvature2(mesh.path_end), mesh.curvature2(mesh.path_start)
