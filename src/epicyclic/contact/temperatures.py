"""Temperatures of tooth contacts: shares of the heat after Blok, bulk after ISO/TS 6336; solids."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass

# Solids that store and conduct heat.


@dataclass(frozen=True, slots=True)
class Solid:
    """What a body is made of."""

    conductivity: float  # [W/(m K)]
    heat_capacity: float  # [J/(kg K)]
    density: float  # [kg/m^3]

    @property
    def effusivity(self) -> float:
        """e = sqrt(k c rho), as a surface takes up heat. Theory (W1). [W s^0.5/(m^2 K)]

        The square root of the thermal contact coefficient B_M of ISO/TS 6336-20 to -22.

        Examples
        --------
        Case-hardened steel:

        >>> round(Solid(45.0, 440.0, 7800.0).effusivity)
        12427
        """
        return math.sqrt(self.conductivity * self.heat_capacity * self.density)


# How bodies share the heat of a sliding line contact, after Blok.

Numbers = FloatArray | float


def heat_share(
    speed1: Numbers,  # Speeds of the surfaces across the contact line, of either sign. [m/s]
    speed2: Numbers,  # Speeds of the surfaces across the contact line, of either sign. [m/s]
    effusivity1: float,  # [W s^0.5/(m^2 K)]
    effusivity2: float,  # [W s^0.5/(m^2 K)]
) -> FloatArray:
    """Share of the frictional heat that goes into body 1. Theory (W3). [1]

    H. Blok (1937). With both surfaces at rest it is the limit of equal speeds.

    Examples
    --------
    >>> round(float(heat_share(8.0, 2.0, 12.4e3, 12.4e3)), 3)
    0.667
    """
    into1 = effusivity1 * np.sqrt(np.abs(speed1))
    total = into1 + effusivity2 * np.sqrt(np.abs(speed2))
    at_rest = np.full(np.shape(total), effusivity1 / (effusivity1 + effusivity2))
    share: FloatArray = np.divide(into1, total, out=at_rest, where=total > 0)
    return share


# Bulk temperature of gears above the oil after ISO/TS 6336-20, -21 and -22, second hand.
#
# The three rises are estimates of one quantity, made for pairs of gears. The loss factor of
# ISO/TS 6336-22 is that of Ohlendorf, `epicyclic.losses.mesh.ohlendorf_loss_factor`.

LUBRICATION_FACTORS: Mapping[str, float] = MappingProxyType(
    {"spray": 1.2, "dip": 1.0, "spray-and-dip": 1.0, "submerged": 0.2}
)
"""X_S of ISO/TS 6336-20 to -22, second hand; submerged with sufficient cooling. [1]"""

MM = 1e3  # Millimetres in a metre.
MICROMETRE = 1e6  # Micrometres in a metre.


def iso_mean_friction(
    # Transverse tangential force on the base circle over the face width, with the load factors.
    # [N/m]
    line_load: float,
    sum_speed: float,  # Sum of the surface speeds at the pitch point, 2 v_t sin(alpha_wt). [m/s]
    radius: float,  # Equivalent radius of curvature at the pitch point, normal section. [m]
    viscosity: float,  # Viscosity of the oil at its inlet temperature, dynamic. [Pa s]
    roughness_factor: float,  # X_R, from `roughness_factor`. [1]
    # X_L: mineral oil 1.0, PAO and ester 0.8, polyglycol 0.7. [1]
    lubricant_factor: float,
) -> float:
    """Mean coefficient of friction of ISO/TS 6336-22, second hand. Theory (W5). [1]

    Examples
    --------
    >>> rough = roughness_factor(0.5e-6, 8.38e-3)
    >>> round(iso_mean_friction(560e3, 6.58, 8.38e-3, 12e-3, rough, 1.0), 4)
    0.0687
    """
    group = line_load / MM / (sum_speed * radius * MM)  # N/mm, m/s, mm
    thin = math.pow(viscosity * 1e3, -0.05)  # mPa s
    return 0.045 * math.pow(group, 0.2) * thin * roughness_factor * lubricant_factor


def roughness_factor(
    roughness: float,  # Ra, mean of both flanks. [m]
    radius: float,  # Equivalent radius of curvature at the pitch point, normal section. [m]
) -> float:
    """X_R = 2.2 (Ra/rho)^0.25 of ISO/TS 6336-22, um and mm, second hand. Theory (W5). [1]

    Examples
    --------
    >>> round(roughness_factor(0.5e-6, 8.38e-3), 3)
    1.087
    """
    return 2.2 * math.pow(roughness * MICROMETRE / (radius * MM), 0.25)


def bulk_rise_of_loss(
    loss: float,  # Load-dependent loss of the mesh, P mu_m H_V. [W]
    center_distance: float,  # [m]
    face_width: float,  # [m]
    lubrication_factor: float,  # X_S, one of `LUBRICATION_FACTORS`. [1]
) -> float:
    """Bulk temperature above that of the oil, ISO/TS 6336-22, second hand. Theory (W4). [K]

    X_Ca is 1, as for flanks without adequate tip relief.

    Examples
    --------
    The gears C-GF of the FZG test rig at load stage 10, sprayed:

    >>> loss = 62.46e3 * 0.0687 * 0.19496
    >>> round(bulk_rise_of_loss(loss, 91.5e-3, 14e-3, LUBRICATION_FACTORS["spray"]), 1)
    37.7
    """
    density = loss / 1e3 / (center_distance * MM * face_width * MM)  # kW/mm^2
    return 7400 * math.pow(density, 0.72) * lubrication_factor / 1.2


def bulk_rise_of_flash(
    mean_flash: float,  # Flash temperature, mean along the path of contact. [K]
    lubrication_factor: float,  # X_S, one of `LUBRICATION_FACTORS`. [1]
    mates: int = 1,  # How many gears are in mesh with this one.
) -> float:
    """Bulk temperature above that of the oil, ISO/TS 6336-20, second hand. Theory (W7). [K]

    Examples
    --------
    A sun among three planets, sprayed:

    >>> round(bulk_rise_of_flash(20.0, LUBRICATION_FACTORS["spray"], mates=3), 2)
    22.56
    """
    return 0.47 * lubrication_factor * mates_factor(mates) * mean_flash


def mates_factor(mates: int) -> float:
    """X_mp = (1 + n_p)/2 of ISO/TS 6336-20 for a gear with n_p mates, second hand. Theory (W7). [1]

    Examples
    --------
    >>> mates_factor(3)
    2.0
    """
    return (1 + mates) / 2
