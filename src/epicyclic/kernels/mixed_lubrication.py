"""Shear stress of an oil film that its own heat and that of the flanks make thinner."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.compiling import kernel

FloatArray = NDArray[np.float64]

LARGE = 20.0  # From here on arsinh(exp(x)) is x + ln 2 to the last digit.
LEAST_VISCOSITY = 1e-8  # Kinematic viscosity that no heat goes below: thinner than any oil. [m^2/s]
STEPS = 100
CLOSE = 1e-12  # Relative width of the bracket at which the stress counts as found. [1]


@kernel
def eyring_stress(
    temperature: float, pressure: float, rate: float, limit: float, oil: FloatArray
) -> float:
    """tau_E arsinh(eta rate/tau_E) with tau_E = Lambda/alpha, eta of Barus. Theory (Y6). [Pa]

    `pressure` [Pa], shear `rate` [1/s], `limit` Lambda [1]; `oil` holds T0 [K], ordinate and slope
    of ASTM D341, density [kg/m^3], alpha at T0 [1/Pa], nu at T0 [m^2/s] and d(ln alpha)/d(ln nu).
    """
    ordinate = oil[1] - oil[2] * math.log10(temperature / oil[0])
    viscosity = max((10.0 ** (10.0**ordinate) - 0.7) * 1e-6, LEAST_VISCOSITY)
    alpha = oil[4] * (viscosity / oil[5]) ** oil[6]
    x = math.log(oil[3] * viscosity * rate * alpha / limit) + alpha * pressure
    stress: float = limit / alpha * (x + math.log(2.0) if x > LARGE else math.asinh(math.exp(x)))
    return stress


@kernel
def film_stress(
    pressure: FloatArray, rate: FloatArray, warm: FloatArray, flash: FloatArray,
    heating: FloatArray, limit: float, oil: FloatArray,
) -> FloatArray:  # fmt: skip
    """Stress tau of each film at the temperature T0 + warm + (flash + heating) tau. Theory (Y7).

    Parameters
    ----------
    pressure, rate : ndarray, shape (n,)
        Mean pressure [Pa], shear rate [1/s].
    warm, flash, heating : ndarray, shape (n,)
        Rise by the friction of asperities [K]; rises per stress of the film: of both flanks, and
        of the oil above them [K/Pa].
    limit, oil
        As for `eyring_stress`.
    """
    found = np.zeros(pressure.size)
    for i in range(pressure.size):
        if rate[i] <= 0.0:
            continue
        base, slope = oil[0] + warm[i], flash[i] + heating[i]
        low, high = 0.0, eyring_stress(base, pressure[i], rate[i], limit, oil)
        above, below = high, eyring_stress(base + slope * high, pressure[i], rate[i], limit, oil)
        below -= high
        side = 0
        for _ in range(STEPS):
            if high - low <= CLOSE * high:
                break
            # regula falsi, with half the weight of an end that stays (Illinois)
            middle = (low * below - high * above) / (below - above)
            left = eyring_stress(base + slope * middle, pressure[i], rate[i], limit, oil) - middle
            if left > 0.0:
                low, above = middle, left
                if side == 1:
                    below /= 2.0
                side = 1
            elif left < 0.0:
                high, below = middle, left
                if side == -1:
                    above /= 2.0
                side = -1
            else:
                low = high = middle
        found[i] = (low + high) / 2.0
    return found
