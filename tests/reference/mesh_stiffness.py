"""Stiffness of standard steel gears after ISO 6336-1 (method B), and the face load factor.

Constants as public implementations quote them; the standard itself was not read. Valid for solid
external gears with the basic rack of ISO 53, x1 >= x2, -0.5 <= x1 + x2 <= 2, line loads from
100 N/mm on; internal gears with an infinite number of teeth in their place.
"""

from __future__ import annotations

import math

STIFFNESS_CORRECTION = 0.8
"""C_M: measured over theoretical stiffness of solid gears. ISO 6336-1. [1]"""


def theoretical_single_stiffness(
    teeth1: int,  # `teeth2` is infinite for an internal gear.
    teeth2: float,  # `teeth2` is infinite for an internal gear.
    helix_angle: float = 0.0,  # [rad]
    shift1: float = 0.0,  # Profile-shift coefficients.
    shift2: float = 0.0,  # Profile-shift coefficients.
    dedendum: float = 1.25,  # h_fP/m_n.
    normal_pressure_angle: float = math.radians(20.0),  # [rad]
) -> float:
    """c'_th C_B cos(beta): largest stiffness of one pair of teeth per face width, without C_M.

    Returns
    -------
    float
        [N/m^2]; 1e9 N/m^2 = 1 N/(mm um)
    """
    z1, z2 = (teeth / math.cos(helix_angle) ** 3 for teeth in (teeth1, teeth2))
    q = (
        0.04723
        + 0.15551 / z1
        + 0.25791 / z2
        - 0.00635 * shift1
        - 0.11654 * shift1 / z1
        - 0.00193 * shift2
        - 0.24188 * shift2 / z2
        + 0.00529 * shift1**2
        + 0.00182 * shift2**2
    )
    rack = 1 + 0.5 * (1.2 - dedendum)
    rack *= 1 - 0.02 * (20 - math.degrees(normal_pressure_angle))
    return 1e9 / q * rack * math.cos(helix_angle)


def mesh_stiffness(single: float, transverse_contact_ratio: float) -> float:
    """c_gamma,alpha = c' (0.75 epsilon_alpha + 0.25): mean over the mesh period. [N/m^2]"""
    return single * (0.75 * transverse_contact_ratio + 0.25)


def face_load_factor(
    misalignment: float,  # Gap at one end of the face. [m]
    stiffness: float,  # Per face width. [N/m^2]
    mean_load: float,  # Per face width. [N/m]
) -> float:
    """K_Hbeta of evenly spread springs under a wedge-shaped gap.

    1 + F c/(2 w) while the whole width is in contact, sqrt(2 F c/w) when it is not.
    """
    ratio = misalignment * stiffness / mean_load
    return 1 + ratio / 2 if ratio <= 2 else math.sqrt(2 * ratio)
