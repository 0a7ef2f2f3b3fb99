"""Mean shear stress of an Eyring fluid under an elliptic pressure in an even film."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels._jit import kernel
from epicyclic.kernels.ehl_fluid import two_slopes

FloatArray = NDArray[np.float64]

LARGEST_EXPONENT = 300.0
"""Largest exponent of the viscosity under pressure: what is larger is solid, and overflows."""
LEAST_LOGARITHM = 0.01
"""Stress from which its arsinh is a logarithm: 1 + x keeps 14 digits of x. [1]"""


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
