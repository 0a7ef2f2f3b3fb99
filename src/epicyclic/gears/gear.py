"""One involute helical gear, external or internal, in its transverse section.

Symbols follow ISO 21771; angles in radians, lengths in metres. Tooth counts of internal gears are
positive here, and a positive profile shift thickens the tooth of every gear, internal ones too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray


def involute(angle: float) -> float:
    """Involute function inv(angle) = tan(angle) - angle. ISO 21771. Theory (G7)."""
    return math.tan(angle) - angle


def inverse_involute(value: float) -> float:
    """Angle whose involute function is `value`, positive, by Newton's method from above."""
    # tan(x) - x exceeds both x^3/3 and tan(x) - pi/2, so either start is too large; from there
    # Newton's method falls monotonically, the function being convex.
    angle = min(math.cbrt(3 * value), math.atan(value + math.pi / 2))
    for _ in range(50):
        change = (involute(angle) - value) / math.tan(angle) ** 2
        angle -= change
        if abs(change) <= 1e-15 * angle:
            break
    return angle


CARRIER, HOUSING = "carrier", "housing"
"""Bodies that gear sets and machines have beside those of gears and shafts."""


@dataclass(frozen=True)
class BasicRack:
    """What gears that mesh have in common. ISO 21771."""

    transverse_module: float  # m_t. [m]
    transverse_pressure_angle: float  # alpha_t at the reference circle. [rad]
    helix_angle: float  # beta at the reference circle, magnitude. [rad]

    @property
    def normal_module(self) -> float:
        """m_n = m_t cos(beta). Theory (G1). [m]"""
        return self.transverse_module * math.cos(self.helix_angle)

    @property
    def normal_pressure_angle(self) -> float:
        """alpha_n from tan(alpha_n) = tan(alpha_t) cos(beta). Theory (G2). [rad]"""
        return math.atan(math.tan(self.transverse_pressure_angle) * math.cos(self.helix_angle))

    @cached_property
    def base_helix_angle(self) -> float:
        """beta_b from tan(beta_b) = tan(beta) cos(alpha_t). Theory (G3). [rad]"""
        return math.atan(math.tan(self.helix_angle) * math.cos(self.transverse_pressure_angle))

    @property
    def transverse_base_pitch(self) -> float:
        """p_bt = pi m_t cos(alpha_t). Theory (G4). [m]"""
        return math.pi * self.transverse_module * math.cos(self.transverse_pressure_angle)


@dataclass(frozen=True)
class Gear:
    """One gear of a mesh."""

    name: str  # Its table in the case: ``"sun"``.
    rack: BasicRack  # Module, pressure angle and helix angle.
    teeth: int  # Number of teeth, positive.
    internal: bool  # True for a ring gear.
    # Half the angle that the transverse tooth thickness takes at the reference circle. [rad]
    thickness_half_angle: float
    tip_radius: float  # [m]
    root_radius: float  # [m]
    face_width: float  # [m]
    # h_K, radial height of the chamfers of the tip corners; zero for sharp corners. [m]
    tip_chamfer: float = 0.0

    @cached_property
    def reference_radius(self) -> float:
        """r = z m_t / 2. Theory (G5). [m]"""
        return self.teeth * self.rack.transverse_module / 2

    @cached_property
    def base_radius(self) -> float:
        """r_b = r cos(alpha_t). Theory (G6). [m]"""
        return self.reference_radius * math.cos(self.rack.transverse_pressure_angle)

    @property
    def profile_shift_coefficient(self) -> float:
        """x of the rack that cuts this tooth thickness. ISO 21771. Theory (G8). [1]"""
        rack = self.rack
        thickness = 2 * self.reference_radius * self.thickness_half_angle
        excess = thickness - math.pi * rack.transverse_module / 2
        return excess / (2 * rack.normal_module * math.tan(rack.transverse_pressure_angle))

    def pressure_angle_at(self, radius: float) -> float:
        """Transverse pressure angle of the involute at `radius` (zero below the base circle).

        Theory (G9).
        """
        return math.acos(min(1.0, self.base_radius / radius))

    def half_angle_at(self, radius: float) -> float:
        """Half the angle of the tooth thickness at `radius`, negative beyond a pointed tip.

        Theory (G10).
        """
        change = involute(self.pressure_angle_at(radius)) - involute(
            self.rack.transverse_pressure_angle
        )
        return self.thickness_half_angle + (change if self.internal else -change)

    def half_angles_at(self, curvature: NDArray[np.float64]) -> NDArray[np.float64]:
        """`half_angle_at` of the points where the involute has these radii of curvature.

        Theory (G10).
        """
        roll = curvature / self.base_radius
        change = roll - np.arctan(roll) - involute(self.rack.transverse_pressure_angle)
        return self.thickness_half_angle + (change if self.internal else -change)

    def thickness_at(self, radius: float) -> float:
        """Transverse tooth thickness, an arc, at `radius`. ISO 21771. Theory (G11). [m]"""
        return 2 * radius * self.half_angle_at(radius)

    def roll_length_at(self, radius: float) -> float:
        """Transverse radius of curvature of the involute at `radius`; 0 inside the base circle.

        Theory (G12), (G42). [m]
        """
        return math.sqrt(max(0.0, radius**2 - self.base_radius**2))

    @property
    def tip_form_radius(self) -> float:
        """r_Fa, where the involute ends and the tip chamfer begins. ISO 21771. Theory (G41). [m]"""
        return self.tip_radius + (self.tip_chamfer if self.internal else -self.tip_chamfer)

    @property
    def tip_half_angle(self) -> float:
        """Half the angle of the tip land that the chamfers leave. Theory (G43)."""
        return self.half_angle_at(self.tip_form_radius) - self.tip_chamfer / self.tip_radius


def half_angle_from_thickness(
    rack: BasicRack, teeth: int, internal: bool, thickness: float, radius: float
) -> float:
    """Half angle at the reference circle of a tooth `thickness` thick at `radius`. Theory (G10).

    Raises `ValueError` if `radius` is inside the base circle, where there is no involute.
    """
    reference = teeth * rack.transverse_module / 2
    cosine = reference * math.cos(rack.transverse_pressure_angle) / radius
    if cosine > 1.0:
        raise ValueError("inside the base circle")
    change = involute(math.acos(cosine)) - involute(rack.transverse_pressure_angle)
    return thickness / (2 * radius) + (-change if internal else change)


def half_angle_from_profile_shift(rack: BasicRack, teeth: int, coefficient: float) -> float:
    """Half angle at the reference circle for profile shift `coefficient`. ISO 21771.

    Theory (G8).
    """
    shift = coefficient * rack.normal_module
    thickness = math.pi * rack.transverse_module / 2 + 2 * shift * math.tan(
        rack.transverse_pressure_angle
    )
    return thickness / (teeth * rack.transverse_module)
