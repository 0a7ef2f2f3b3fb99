"""One involute helical gear, external or internal, in its transverse section.

Symbols follow ISO 21771; angles in radians, lengths in metres. Tooth counts of internal gears are
positive here, and a positive profile shift thickens the tooth of every gear, internal ones too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field  # this module needs nothing else of the package
from typing import TYPE_CHECKING

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

    if TYPE_CHECKING:  # what follows from them; no fields, which files would hold
        normal_module: float = field(init=False)  # m_n. [m]
        normal_pressure_angle: float = field(init=False)  # alpha_n. [rad]
        base_helix_angle: float = field(init=False)  # beta_b. [rad]
        transverse_base_pitch: float = field(init=False)  # p_bt. [m]

    def __post_init__(self) -> None:
        """m_n, alpha_n, beta_b and p_bt. Theory (G1), (G2), (G3), (G4)."""
        m_t, beta = self.transverse_module, self.helix_angle
        alpha_t = self.transverse_pressure_angle
        vars(self).update(
            normal_module=m_t * math.cos(beta),  # (G1)
            normal_pressure_angle=math.atan(math.tan(alpha_t) * math.cos(beta)),  # (G2)
            base_helix_angle=math.atan(math.tan(beta) * math.cos(alpha_t)),  # (G3)
            transverse_base_pitch=math.pi * m_t * math.cos(alpha_t),  # (G4)
        )


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

    if TYPE_CHECKING:  # what follows from them; no fields, which files would hold
        side: int = field(init=False)  # Sign in sums with mates: -1 for a ring, else +1.
        reference_radius: float = field(init=False)  # r. [m]
        base_radius: float = field(init=False)  # r_b. [m]
        tip_form_radius: float = field(init=False)  # r_Fa, where the tip chamfer begins. [m]
        # x of the rack that cuts this tooth thickness. [1]
        profile_shift_coefficient: float = field(init=False)

    def __post_init__(self) -> None:
        """r, r_b, r_Fa and x. ISO 21771. Theory (G5), (G6), (G8), (G41)."""
        rack, radius = self.rack, self.teeth * self.rack.transverse_module / 2
        excess = 2 * radius * self.thickness_half_angle - math.pi * rack.transverse_module / 2
        slope = 2 * rack.normal_module * math.tan(rack.transverse_pressure_angle)
        side = -1 if self.internal else 1
        vars(self).update(
            side=side,
            reference_radius=radius,  # (G5)
            base_radius=radius * math.cos(rack.transverse_pressure_angle),  # (G6)
            tip_form_radius=self.tip_radius - side * self.tip_chamfer,  # (G41)
            profile_shift_coefficient=excess / slope,  # (G8)
        )

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
        """`half_angle_at` where the involute has these radii of curvature. Theory (G10)."""
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
    """Half angle at the reference circle, profile shift `coefficient`. ISO 21771. Theory (G8)."""
    shift = coefficient * rack.normal_module
    thickness = math.pi * rack.transverse_module / 2 + 2 * shift * math.tan(
        rack.transverse_pressure_angle
    )
    return thickness / (teeth * rack.transverse_module)
