"""Shear stress of an oil film that its own heat and that of the flanks make thinner."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from epicyclic.arrays import FloatArray, Points

LARGE = 20.0  # From here on arsinh(exp(x)) is x + ln 2 to the last digit. [1]
OFFSET = 0.7  # Of ASTM D341. [mm^2/s]
LEAST_VISCOSITY = 0.01  # That no heat goes below: thinner than any oil. [mm^2/s]
START = 0.3  # Stress over its limit at unheated pressure with which Newton's method starts. [1]
QUICK_STEPS, STEPS = 3, 100  # Of Newton's method alone, and of all.
AT_ONCE = 4000  # Films whose stress is found together: arrays of more do not fit into fast memory.
LEFT = 1e-9  # Of the stress: what a step leaves is its cube over the square of the one before. [1]


def eyring_stress(
    temperature: FloatArray, pressure: FloatArray, log_rate: FloatArray, limit: float,
    oil: Sequence[float],
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """tau_E arsinh(eta rate/tau_E) with tau_E = Lambda/alpha, eta of Barus. Theory (Y6). [Pa]

    With its derivative to the temperature [Pa/K]. `pressure` [Pa]; `log_rate` of the shear rate
    times rho alpha/Lambda at T0 and 1 mm^2/s; `limit` Lambda [1]; `oil` holds, at its temperature
    T0 [K], ln(nu + 0.7) and ln(nu) with nu in mm^2/s, the slope of ASTM D341, density times
    1 mm^2/s [Pa s], alpha [1/Pa] and d(ln alpha)/d(ln nu).
    """
    log_shifted = oil[1] * np.exp(oil[3] * np.log(oil[0] / temperature))
    shifted = np.exp(log_shifted)
    viscosity = np.maximum(shifted - OFFSET, LEAST_VISCOSITY)
    log_viscosity = np.log(viscosity)
    fall = -oil[3] * shifted * log_shifted / (temperature * viscosity)  # d(ln nu)/dT
    exponent = oil[6]
    log_alpha = exponent * (log_viscosity - oil[2])  # over alpha at T0
    alpha = oil[5] * np.exp(log_alpha)
    squeezed = alpha * pressure
    x = log_viscosity + log_alpha + log_rate + squeezed
    ratio = np.exp(np.minimum(x, LARGE))
    arsinh = np.arcsinh(ratio) + np.maximum(x - LARGE, 0.0)
    share = ratio / np.sqrt(1.0 + ratio * ratio)
    rise = share * (1.0 + exponent + exponent * squeezed) - exponent * arsinh
    scale = limit / alpha
    return scale * arsinh, scale * fall * rise


def film_stress(
    pressure: FloatArray, rate: FloatArray, warm: FloatArray, heating: FloatArray,
    limit: float, oil: Sequence[float],
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
    rows = max(1, AT_ONCE * len(pressure) // max(1, pressure.size))
    if isinstance(pressure, Points) and len(pressure) > rows:
        each: list[Any] = [pressure, rate, warm, heating, limit, *oil]
        found = []
        for at in range(0, len(pressure), rows):
            part = slice(at, at + rows)
            own: list[Any] = [np.asarray(it)[part] if isinstance(it, Points) else it for it in each]
            found.append(film_stress(own[0], own[1], own[2], own[3], own[4], own[5:]))
        return np.concatenate(found).view(Points)
    sheared = rate > 0.0
    log_rate = np.log(np.where(sheared, rate, 1.0) * (oil[4] * oil[5] / limit))
    base, stress = oil[0] + warm, START * limit * pressure
    low, high = np.zeros_like(stress), np.full_like(stress, math.inf)
    moved = high
    for number in range(STEPS):
        hot, slope = eyring_stress(base + heating * stress, pressure, log_rate, limit, oil)
        step = (hot - stress) / (1.0 - heating * slope)
        last, stress, size = stress, stress + step, np.abs(step)
        if number and (size * size * size <= LEFT * stress * moved * moved).all():
            break
        if number < QUICK_STEPS and (stress > 0.0).all():
            moved = size
            continue
        # bisection where Newton's method leaves what is known or runs in circles
        above = hot > last
        low, high = np.where(above, last, low), np.where(above, high, last)
        left = (stress < low) | (stress > high) | (size > moved / 2.0)
        if left.any():
            stress = np.where(left, np.minimum((low + high) / 2.0, 2.0 * last), stress)
        moved = np.abs(stress - last)
    return np.where(sheared, stress, 0.0)
