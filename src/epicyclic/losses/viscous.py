"""Load-independent losses of bearings and of bodies turning in the mixture of oil and air."""

from __future__ import annotations

import math
from dataclasses import dataclass

from epicyclic.losses.validity import OF_THIS_PACKAGE, ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.lubricant.properties import MixtureState
from epicyclic.units import NUMBER

VISCOUS_METHOD = "viscous moment after Palmgren and Harris"
VISCOUS_SOURCE = "T. A. Harris, Rolling Bearing Analysis, 3rd ed. (1991); Talbot (2012), Eq. 5.6"
DRAG_METHOD = "drag of a disc in the air-oil mixture"
DRAG_SOURCE = "Seetharaman and Kahraman, Tribol. Trans. 53 (2010) 473; Talbot (2012), Eq. 5.4, 5.5"

LOW_SPEED_LIMIT = 2000.0
"""nu n in mm^2/s times rpm below which the friction moment is constant (Palmgren)."""
TRANSITION_REYNOLDS = 5e5
"""omega r^2/nu at which the flow on the faces turns turbulent, Talbot (2012), Eq. 5.5. [1]"""
RPM = math.pi / 30
"""1 rpm in rad/s."""

SPEED_PARAMETER = Range(
    "speed_parameter", "speed times pitch diameter, rpm mm", None, 1e6, NUMBER, OF_THIS_PACKAGE
)
"""Range of the formulas of Palmgren and Harris, which come from tests at moderate speed."""
_FACES = Range(
    "reynolds_number",
    "Reynolds number of the faces",
    None,
    1e7,
    NUMBER,
    "one-seventh power law of the flat plate, Schlichting, Boundary-Layer Theory",
)
_CREEPING = Range(
    "reynolds_number",
    "Reynolds number of the faces",
    70.0,
    None,
    NUMBER,
    "below, a disc in creeping flow, 32/3 mu omega r^3, drags more: Lamb, Hydrodynamics",
)
_RIM = Range(
    "reynolds_number",
    "Reynolds number of the rim",
    None,
    60.0,
    NUMBER,
    "laminar flow around a cylinder, Theodorsen and Regier, NACA Report 793 (1944)",
)


def bearing_viscous_loss(
    factor: float,  # f0. [1]
    kinematic_viscosity: float,  # Viscosity of the oil, not of the mixture. [m^2/s]
    speed: float,  # Speed of one ring against the other. [rad/s]
    pitch_diameter: float,  # d_m. [m]
) -> float:
    """Viscous loss of a rolling bearing after Palmgren and Harris. [W]

    Theory (V1).

    M0 = 1e-7 f0 (nu n)^(2/3) d_m^3 for nu n >= 2000, else 160e-7 f0 d_m^3; N mm, mm^2/s, rpm, mm.
    Talbot (2012), Eq. 5.6 for the first branch; Harris, Rolling Bearing Analysis, 3rd ed. (1991)
    for both. They differ by 0.8 % where they meet.
    """
    rpm = abs(speed) / RPM
    product = kinematic_viscosity * 1e6 * rpm
    group = math.pow(product, 2 / 3) if product >= LOW_SPEED_LIMIT else 160.0
    moment = 1e-7 * factor * group * (pitch_diameter * 1e3) ** 3 * 1e-3
    return moment * abs(speed)


def viscous_flags(where: str, speed: float, pitch_diameter: float) -> tuple[ValidityFlag, ...]:
    """Flags of `bearing_viscous_loss` in the bearing called `where`."""
    values = {"speed_parameter": speed_parameter(speed, pitch_diameter)}
    return check_ranges(ModelUse("bearing_viscous", "harris", where), (SPEED_PARAMETER,), values)


def speed_parameter(speed: float, pitch_diameter: float) -> float:
    """n d_m of a bearing, in rpm mm."""
    return abs(speed) / RPM * pitch_diameter * 1e3


@dataclass(frozen=True, slots=True)
class DiscDrag:
    """Drag of a disc."""

    rim: float  # Losses at the rim and at both faces. [W]
    faces: float  # Losses at the rim and at both faces. [W]

    @property
    def total(self) -> float:
        """Loss of the whole disc. [W]"""
        return self.rim + self.faces


def disc_drag(
    radius: float,  # [m]
    width: float,  # [m]
    speed: float,  # Against the housing. [rad/s]
    mixture: MixtureState,
) -> DiscDrag:
    """Drag of a disc in the mixture: rim (Eq. 5.4) and both faces (Eq. 5.5).

    Theory (V3), (V6).

    Seetharaman and Kahraman (2010), Talbot (2012), p. 130. The branches of the face formula do not
    meet; here the flow is laminar within the radius at which it turns turbulent, and the turbulent
    branch counts outside that radius only, after Prandtl.
    """
    omega = abs(speed)
    rim = 4 * math.pi * mixture.dynamic_viscosity * width * radius**2 * omega**2
    if reynolds_number(radius, omega, mixture) <= TRANSITION_REYNOLDS:
        return DiscDrag(rim, _laminar_faces(radius, omega, mixture))
    laminar = math.sqrt(TRANSITION_REYNOLDS * mixture.kinematic_viscosity / omega)
    faces = (
        _laminar_faces(laminar, omega, mixture)
        + _turbulent_faces(radius, omega, mixture)
        - _turbulent_faces(laminar, omega, mixture)
    )
    return DiscDrag(rim, faces)


def _laminar_faces(radius: float, omega: float, mixture: MixtureState) -> float:
    """First branch of Talbot (2012), Eq. 5.5. Theory (V4). [W]"""
    group = math.sqrt(mixture.kinematic_viscosity) * math.pow(omega, 2.5)
    return 0.41 * math.pi * mixture.density * group * radius**4


def _turbulent_faces(radius: float, omega: float, mixture: MixtureState) -> float:
    """Second branch of Talbot (2012), Eq. 5.5. Theory (V4). [W]"""
    group = math.pow(mixture.kinematic_viscosity, 0.14) * math.pow(omega, 2.86)
    return 0.025 * math.pi * mixture.density * group * math.pow(radius, 4.72)


def disc_drag_flags(
    where: str, radius: float, drag: DiscDrag, speed: float, mixture: MixtureState
) -> tuple[ValidityFlag, ...]:
    """Flags of the `drag` of the body called `where`, each with the part of it that it concerns."""
    if drag.total == 0:
        return ()
    use = ModelUse("drag", "seetharaman-kahraman", where)
    values = {"reynolds_number": reynolds_number(radius, speed, mixture)}
    return check_ranges(use, (_RIM,), values, part=drag.rim / drag.total) + check_ranges(
        use, (_FACES, _CREEPING), values, part=drag.faces / drag.total
    )


def reynolds_number(radius: float, speed: float, mixture: MixtureState) -> float:
    """omega r^2/nu. Theory (V5). [1]"""
    return abs(speed) * radius**2 / mixture.kinematic_viscosity
