"""Shear stress of an oil film that its own heat and that of the flanks make thinner."""

from __future__ import annotations

import math

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.kernels.compiling import kernel

SMALL = 0.01  # From here on arsinh is a logarithm that keeps 14 digits. [1]
LARGE = 20.0  # From here on arsinh(exp(x)) is x + ln 2 to the last digit. [1]
OFFSET = 0.7  # Of ASTM D341. [mm^2/s]
LEAST_VISCOSITY = 0.01  # That no heat goes below: thinner than any oil. [mm^2/s]
STEPS = 100
SMALL_STEP = 1e-6  # Over the stress: what Newton's method leaves then is its square. [1]


@kernel
def eyring_stress(
    temperature: float, pressure: float, log_rate: float, limit: float, oil: FloatArray
) -> tuple[float, float]:
    """tau_E arsinh(eta rate/tau_E) with tau_E = Lambda/alpha, eta of Barus. Theory (Y6). [Pa]

    With its derivative to the temperature [Pa/K]. `pressure` [Pa]; `log_rate` of the shear rate
    times rho alpha/Lambda at T0 and 1 mm^2/s; `limit` Lambda [1]; `oil` holds, at its temperature
    T0 [K], ln(nu + 0.7) and ln(nu) with nu in mm^2/s, the slope of ASTM D341, density times
    1 mm^2/s [Pa s], alpha [1/Pa] and d(ln alpha)/d(ln nu).
    """
    log_shifted = oil[1] * math.exp(oil[3] * math.log(oil[0] / temperature))
    shifted = math.exp(log_shifted)
    viscosity = max(shifted - OFFSET, LEAST_VISCOSITY)
    log_viscosity = math.log(viscosity)
    fall = -oil[3] * shifted * log_shifted / (temperature * viscosity)  # d(ln nu)/dT
    exponent = oil[6]
    log_alpha = exponent * (log_viscosity - oil[2])  # over alpha at T0
    alpha = oil[5] * math.exp(log_alpha)
    x = log_viscosity + log_alpha + log_rate + alpha * pressure
    arsinh, share = x + math.log(2.0), 1.0
    if x < LARGE:
        ratio = math.exp(x)
        root = math.sqrt(1.0 + ratio * ratio)
        arsinh = math.log(ratio + root) if ratio > SMALL else math.asinh(ratio)
        share = ratio / root
    stress = limit / alpha * arsinh
    rise = share * (1.0 + exponent * (1.0 + alpha * pressure)) - exponent * arsinh
    return stress, limit / alpha * fall * rise


@kernel
def film_stress(
    pressure: FloatArray, rate: FloatArray, warm: FloatArray, heating: FloatArray,
    limit: float, oil: FloatArray,
) -> FloatArray:  # fmt: skip
    """Stress tau of each film at the temperature T0 + warm + heating tau. Theory (Y7). [Pa]

    Parameters
    ----------
    pressure, rate : ndarray, shape (n,)
        Mean pressure [Pa], shear rate [1/s].
    warm, heating : ndarray, shape (n,)
        Rise by the friction of asperities [K]; rise per stress of the film [K/Pa].
    limit, oil
        As for `eyring_stress`.
    """
    found = np.zeros(pressure.size)
    coefficient = limit  # stress over pressure at the last point, where the next begins
    for i in range(pressure.size):
        if rate[i] <= 0.0:
            continue
        base, p = oil[0] + warm[i], pressure[i]
        log_rate = math.log(rate[i] * oil[4] * oil[5] / limit)
        low, high, stress = 0.0, math.inf, coefficient * p
        for _ in range(STEPS):  # Newton, bisection where that leaves what is known
            hot, slope = eyring_stress(base + heating[i] * stress, p, log_rate, limit, oil)
            step = (hot - stress) / (1.0 - heating[i] * slope)
            if hot > stress:
                low = stress
            else:
                high = stress
            stress += step
            if abs(step) <= SMALL_STEP * stress:
                break
            if not low <= stress <= high:
                stress = (low + high) / 2.0
        found[i] = stress
        coefficient = stress / p
    return found
