"""Load-independent losses of bearings and of bodies turning in the mixture of oil and air."""

from __future__ import annotations

import math

from epicyclic.lubricant.properties import MixtureState

__all__ = ["bearing_viscous_loss", "disc_drag_loss"]

LOW_SPEED_LIMIT = 2000.0
"""nu n in mm^2/s times rpm below which the friction moment is constant (Palmgren)."""
TRANSITION_REYNOLDS = 5e5
"""omega r^2/nu at which the flow on the faces turns turbulent, Talbot (2012), Eq. 5.5. [1]"""
RPM = math.pi / 30
"""1 rpm in rad/s."""


def bearing_viscous_loss(
    factor: float, kinematic_viscosity: float, speed: float, pitch_diameter: float
) -> float:
    """Viscous loss of a rolling bearing after Palmgren and Harris. [W]

    Theory (V1).

    M0 = 1e-7 f0 (nu n)^(2/3) d_m^3 for nu n >= 2000, else 160e-7 f0 d_m^3; N mm, mm^2/s, rpm, mm.
    Talbot (2012), Eq. 5.6 for the first branch; Harris, Rolling Bearing Analysis, 3rd ed. (1991)
    for both. They differ by 0.8 % where they meet.

    Parameters
    ----------
    factor : float
        f0. [1]
    kinematic_viscosity : float
        Of the oil, not of the mixture. [m^2/s]
    speed : float
        Of one ring against the other. [rad/s]
    pitch_diameter : float
        d_m. [m]
    """
    rpm = abs(speed) / RPM
    product = kinematic_viscosity * 1e6 * rpm
    group = math.pow(product, 2 / 3) if product >= LOW_SPEED_LIMIT else 160.0
    moment = 1e-7 * factor * group * (pitch_diameter * 1e3) ** 3 * 1e-3
    return moment * abs(speed)


def disc_drag_loss(radius: float, width: float, speed: float, mixture: MixtureState) -> float:
    """Drag of a disc in the mixture: rim (Eq. 5.4) and both faces (Eq. 5.5). [W]

    Theory (V3), (V4).

    Seetharaman and Kahraman (2010), Talbot (2012), p. 130. The face formula jumps at its
    transition, by about a factor of seven: that is the source's.

    Parameters
    ----------
    radius, width : float
        [m]
    speed : float
        Against the housing. [rad/s]
    mixture : MixtureState
    """
    omega = abs(speed)
    rim = 4 * math.pi * mixture.dynamic_viscosity * width * radius**2 * omega**2
    nu = mixture.kinematic_viscosity
    if reynolds_number(radius, omega, mixture) < TRANSITION_REYNOLDS:
        face = 0.41 * math.sqrt(nu) * math.pow(omega, 2.5) * radius**4
    else:
        face = 0.025 * math.pow(nu, 0.14) * math.pow(omega, 2.86) * math.pow(radius, 4.72)
    return rim + math.pi * mixture.density * face


def reynolds_number(radius: float, speed: float, mixture: MixtureState) -> float:
    """omega r^2/nu. Theory (V5). [1]"""
    return abs(speed) * radius**2 / mixture.kinematic_viscosity
