"""Shear stress of an oil film that its own heat and that of the flanks make thinner."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.kernels.compiling import kernel
from epicyclic.kernels.line_contact import exponential, logarithm

LARGE = 20.0  # From here on arsinh(exp(x)) is x + ln 2 to the last digit. [1]
OFFSET = 0.7  # Of ASTM D341. [mm^2/s]
LEAST_VISCOSITY = 0.01  # That no heat goes below: thinner than any oil. [mm^2/s]
START = 0.3  # Stress over its limit at unheated pressure with which Newton's method starts. [1]
QUICK_STEPS, STEPS = 4, 100  # Of Newton's method alone, and held between bounds.
LEFT = 1e-9  # Of the stress: what a step leaves is its cube over the square of the one before. [1]
CLOSE = 1e-4  # Size of that step over the stress, at most: a longer one may meet another bend. [1]


@partial(kernel, inlined=True)
def eyring_stress(
    temperature: float, pressure: float, log_rate: float, oil: tuple[float, ...]
) -> tuple[float, float]:
    """tau_E arsinh(eta rate/tau_E) with tau_E = Lambda/alpha, eta of Barus. Theory (Y6). [Pa]

    With its derivative to the temperature [Pa/K]. `pressure` [Pa]; `log_rate` of the shear rate
    times rho alpha/Lambda at T0 and 1 mm^2/s; `oil` holds, at its temperature T0 [K],
    ln(nu + 0.7) and ln(nu) with nu in mm^2/s, the slope of ASTM D341, density times 1 mm^2/s
    [Pa s], alpha [1/Pa], d(ln alpha)/d(ln nu), and the limit Lambda [1].
    """
    T0, log_shifted0, log_viscosity0, slope, _, alpha0, exponent, limit = oil
    log_shifted = log_shifted0 * exponential(slope * logarithm(T0 / temperature))
    shifted = exponential(log_shifted)
    viscosity = max(shifted - OFFSET, LEAST_VISCOSITY)
    log_viscosity = logarithm(viscosity)
    fall = -slope * shifted * log_shifted / (temperature * viscosity)  # d(ln nu)/dT
    log_alpha = exponent * (log_viscosity - log_viscosity0)  # over alpha at T0
    alpha = alpha0 * exponential(log_alpha)
    squeezed = alpha * pressure
    x = log_viscosity + log_alpha + log_rate + squeezed
    ratio = exponential(min(x, LARGE))
    root = math.sqrt(1.0 + ratio * ratio)
    # arsinh(ratio) = ln(1 + more), where what is lost of small ones is added
    more = ratio + ratio * ratio / (1.0 + root)
    rounded = 1.0 + more
    arsinh = logarithm(rounded) + (more - (rounded - 1.0)) / rounded + max(x - LARGE, 0.0)
    rise = ratio / root * (1.0 + exponent + exponent * squeezed) - exponent * arsinh
    scale = limit / alpha
    return scale * arsinh, scale * fall * rise


@kernel
def _bounded(
    pressure: float, log_rate: float, warm: float, heating: float, oil: tuple[float, ...]
) -> float:
    """`film_stress` where Newton's method runs in circles: bisection where it leaves bounds."""
    stress, low, high, moved = START * oil[7] * pressure, 0.0, math.inf, math.inf
    for _ in range(STEPS):
        hot, slope = eyring_stress(oil[0] + warm + heating * stress, pressure, log_rate, oil)
        step = (hot - stress) / (1.0 - heating * slope)
        last, stress, size = stress, stress + step, abs(step)
        close = size <= CLOSE * stress and moved < math.inf
        if close and size * size * size <= LEFT * stress * moved * moved:
            break
        if hot > last:
            low = last
        else:
            high = last
        if stress < low or stress > high or size > moved / 2.0:
            stress = min((low + high) / 2.0, 2.0 * last)
        moved = abs(stress - last)
    return stress


@kernel
def _film_stresses(
    pressure: FloatArray, rate: FloatArray, warm: FloatArray, heating: FloatArray, oil: FloatArray
) -> FloatArray:
    """`film_stress` of all points."""
    stresses, n = np.empty_like(pressure), pressure.shape[1]
    log_rate, moved, left = np.empty(n), np.empty(n), np.empty(n)
    for row in range(len(pressure)):
        p, slip, warmth, heat, stress = (
            pressure[row], rate[row], warm[row], heating[row], stresses[row],
        )  # fmt: skip
        its = oil[row]
        own = (its[0], its[1], its[2], its[3], its[4], its[5], its[6], its[7])
        for i in range(n):
            sheared = slip[i] if slip[i] > 0.0 else 1.0
            log_rate[i] = logarithm(sheared * (own[4] * own[5] / own[7]))
            stress[i], moved[i] = START * own[7] * p[i], math.inf
        for number in range(QUICK_STEPS):
            for i in range(n):
                hot, slope = eyring_stress(
                    own[0] + warmth[i] + heat[i] * stress[i], p[i], log_rate[i], own
                )
                step = (hot - stress[i]) / (1.0 - heat[i] * slope)
                stress[i] += step
                size = abs(step)
                bent = LEFT * stress[i] * moved[i] * moved[i] - size * size * size
                left[i] = min(bent, CLOSE * stress[i] - size)
                moved[i] = size
            found = 0
            for i in range(n):
                found += left[i] >= 0.0
            if number and found == n:
                break
        for i in range(n):
            if not left[i] >= 0.0:
                stress[i] = _bounded(p[i], log_rate[i], warmth[i], heat[i], own)
            if not slip[i] > 0.0:
                stress[i] = 0.0
    return stresses


def film_stress(
    pressure: FloatArray, rate: FloatArray, warm: FloatArray, heating: FloatArray, oil: FloatArray
) -> FloatArray:
    """Stress tau of each film at the temperature T0 + warm + heating tau. Theory (Y7). [Pa]

    Parameters
    ----------
    pressure, rate : ndarray, shape (n,) or (points, n)
        Mean pressure [Pa], shear rate [1/s].
    warm, heating : ndarray, of the same shape
        Rise by the friction of asperities [K]; rise per stress of the film [K/Pa].
    oil : ndarray, shape (8,) or (points, 8)
        As for `eyring_stress`.
    """
    shape = (-1, pressure.shape[-1])
    rows: list[Any] = [
        np.ascontiguousarray(it).reshape(shape) for it in (pressure, rate, warm, heating)
    ]
    rows.append(np.ascontiguousarray(np.broadcast_to(oil, (len(rows[0]), np.shape(oil)[-1]))))
    return _film_stresses(*rows).reshape(pressure.shape).view(type(pressure))
