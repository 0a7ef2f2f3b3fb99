"""Flash temperature of sliding line contacts, and how its heat is shared, after Blok."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Numbers = FloatArray | float


def effusivity(
    conductivity: float,  # [W/(m K)]
    heat_capacity: float,  # [J/(kg K)]
    density: float,  # [kg/m^3]
) -> float:
    """Thermal effusivity e = sqrt(k c rho) of a solid. [W s^0.5/(m^2 K)]

    Theory (W1).

    The square root of the thermal contact coefficient B_M of ISO/TS 6336-20 to -22.

    Examples
    --------
    Case-hardened steel:

    >>> round(effusivity(45.0, 440.0, 7800.0))
    12427
    """
    return math.sqrt(conductivity * heat_capacity * density)


def flash_temperature(
    friction: Numbers,  # Coefficient of friction mu. [1]
    line_load: Numbers,  # W'. [N/m]
    sliding_speed: Numbers,  # u_s, of either sign. [m/s]
    speed1: Numbers,  # Speeds of the surfaces across the contact line, of either sign. [m/s]
    speed2: Numbers,  # Speeds of the surfaces across the contact line, of either sign. [m/s]
    half_width: Numbers,  # b of Hertz. [m]
    effusivity1: float,  # [W s^0.5/(m^2 K)]
    effusivity2: float,  # [W s^0.5/(m^2 K)]
) -> FloatArray:
    """Largest rise of the surface temperature in a line contact above that of the bodies. [K]

    Theory (W2).

    H. Blok (1937), as in ISO/TS 6336-22, second hand: the heat mu W' |u_s| spread evenly over the
    width of Hertz, shared so that both surfaces are equally hot. The bodies are half-spaces that
    move fast: u b/kappa above about 10 for each, kappa its thermal diffusivity. Arguments are
    numbers or arrays, point by point; 0 without load or speed.

    Examples
    --------
    >>> rise = flash_temperature(0.05, 200e3, 3.0, 8.0, 5.0, 0.2e-3, 12.4e3, 12.4e3)
    >>> round(float(rise), 1)
    27.0
    """
    carried = effusivity1 * np.sqrt(np.abs(speed1)) + effusivity2 * np.sqrt(np.abs(speed2))
    heat = friction * line_load * np.abs(sliding_speed)
    scale = carried * np.sqrt(half_width)
    out = np.zeros(np.broadcast(heat, scale).shape)
    rise: FloatArray = np.divide(heat, scale, out=out, where=scale > 0)
    return math.sqrt(2 / math.pi) * rise


def heat_share(
    speed1: Numbers,  # Speeds of the surfaces across the contact line, of either sign. [m/s]
    speed2: Numbers,  # Speeds of the surfaces across the contact line, of either sign. [m/s]
    effusivity1: float,  # [W s^0.5/(m^2 K)]
    effusivity2: float,  # [W s^0.5/(m^2 K)]
) -> FloatArray:
    """Share of the frictional heat that goes into body 1. [1]

    Theory (W3).

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
