"""Load distribution of a radially loaded roller bearing whose races stay parallel."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq


def radial_load_integral(
    # epsilon = (1 - P_d/(2 delta_r))/2, with diametral clearance P_d and displacement delta_r: 0.5
    # without clearance. [1]
    load_zone: float,
    exponent: float,  # n of Q = K delta^n: 1.5 for balls, 1.11 for rollers. [1]
) -> float:
    """Sjoevall's integral J_r, for bearings with many rollers.

    J_r = 1/(2 pi) int [1 - (1 - cos psi)/(2 epsilon)]^n cos(psi) dpsi over the loaded arc. The most
    loaded of Z rollers carries F/(Z J_r).

    Returns
    -------
    float
        J_r: 0.2448 for rollers without clearance, so that Q_max = 4.08 F/Z. [1]

    References
    ----------
    T. A. Harris, Rolling Bearing Analysis, 3rd ed. (1991), after H. Sjoevall (1933).
    """
    end = math.acos(max(-1.0, 1 - 2 * load_zone))

    def integrand(psi: float) -> float:
        share = max(0.0, 1 - (1 - math.cos(psi)) / (2 * load_zone))
        return math.pow(share, exponent) * math.cos(psi)

    return float(quad(integrand, 0.0, end, epsabs=1e-13, epsrel=1e-12)[0] / math.pi)


def aligned_roller_loads(
    force: float,  # F, positive. [N]
    rollers: int,  # Number of rollers, evenly spaced.
    clearance: float,  # Diametral clearance P_d. [m]
    stiffness: float,  # K of both contacts of a roller in series. [N/m^n]
    exponent: float,  # n. [1]
) -> NDArray[np.float64]:
    """Load of every roller, the first one standing under the force.

    The displacement delta_r solves F = sum Q cos(psi), Q = K max(delta_r cos(psi) - P_d/2, 0)^n.

    Returns
    -------
    ndarray, shape (rollers,)
        Q. [N]

    References
    ----------
    T. A. Harris, Rolling Bearing Analysis, 3rd ed. (1991), after R. Stribeck (1901).
    """
    cosine = np.cos(np.arange(rollers) * 2 * math.pi / rollers)

    def loads(displacement: float) -> NDArray[np.float64]:
        approach = np.maximum(displacement * cosine - clearance / 2, 0.0)
        roller_loads: NDArray[np.float64] = stiffness * approach**exponent
        return roller_loads

    def excess(displacement: float) -> float:
        return float(loads(displacement) @ cosine) / force - 1

    low = clearance / 2
    high = low + 2 * (force / stiffness) ** (1 / exponent)  # the first roller carries more than F
    return loads(brentq(excess, low, high, xtol=1e-15 * high, rtol=1e-15))
