"""Mean shear stress of an Eyring fluid under an elliptic pressure in an even film."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.compiling import kernel

FloatArray = NDArray[np.float64]

CUBIC_START, CUBIC_END = 0.7, 1.4
"""Where the cubic between the two slopes starts and ends, over the transition pressure."""
LARGEST_EXPONENT = 300.0
"""Largest exponent of the viscosity under pressure: what is larger is solid, and overflows."""
LEAST_LOGARITHM = 0.01
"""Stress from which its arsinh is a logarithm: 1 + x keeps 14 digits of x. [1]"""


@kernel
def two_slopes(
    pressure: float, first: float, second: float, transition: float
) -> tuple[float, float]:
    """Exponents of two slopes joined by a cubic: value and derivative. Theory (H7)."""
    start, end = CUBIC_START * transition, CUBIC_END * transition
    if pressure <= start:
        return first * pressure, first
    if pressure >= end:
        return first * transition + second * (pressure - transition), second
    width = end - start
    t = (pressure - start) / width
    low, high = first * start, first * transition + second * (end - transition)
    value = (
        low * (1.0 + 2.0 * t) * (1.0 - t) ** 2
        + first * width * t * (1.0 - t) ** 2
        + high * t * t * (3.0 - 2.0 * t)
        - second * width * t * t * (1.0 - t)
    )
    slope = (
        6.0 * (high - low) / width * t * (1.0 - t)
        + first * (1.0 - t) * (1.0 - 3.0 * t)
        + second * t * (3.0 * t - 2.0)
    )
    return value, slope


@kernel
def eyring_means(
    rate: FloatArray, highest: FloatArray, slope: FloatArray, slope_ratio: float,
    transition: float, cosines: FloatArray, weights: FloatArray,
) -> FloatArray:  # fmt: skip
    """Sum of the weighted arsinh(rate exp(ln mu)), shape (n,). Theory (O4). [1]

    Parameters
    ----------
    rate : ndarray, shape (n,)
        Newtonian stress at ambient viscosity over the Eyring stress. [1]
    highest, slope : ndarray, shape (n,)
        Highest pressure [Pa], slope of ln(mu) at ambient pressure [1/Pa].
    slope_ratio, transition : float
        For two slopes: high over low [1], pressure where they meet [Pa].
    cosines, weights : ndarray, shape (k,)
        Cosines and weights of the quadrature.
    """
    total = np.zeros(rate.size)
    for i in range(rate.size):
        for k in range(cosines.size):
            exponent = two_slopes(
                highest[i] * cosines[k], slope[i], slope_ratio * slope[i], transition
            )[0]
            stress = rate[i] * math.exp(min(exponent, LARGEST_EXPONENT))
            total[i] += weights[k] * cosines[k] * _arsinh(stress)
    return total


@kernel
def _arsinh(x: float) -> float:
    """Twice as quick as `math.asinh` where it does not cancel, and as exact there."""
    return math.log(x + math.sqrt(x * x + 1.0)) if x > LEAST_LOGARITHM else math.asinh(x)
