"""Interpolation that makes no new extremes: piecewise cubics over evenly spaced points.

Fritsch and Butland (1984): the slope at a point is the harmonic mean of those on both sides, zero
at an extreme.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels._jit import kernel

Floats = NDArray[np.float64]


@kernel
def _slope(values: Floats, n: int, column: int) -> float:
    """Slope at point `n`, in units of the spacing."""
    last = values.shape[0] - 1
    left = values[n, column] - values[n - 1, column] if n > 0 else 0.0
    right = values[n + 1, column] - values[n, column] if n < last else 0.0
    if n == 0:
        return right
    if n == last:
        return left
    return 2 * left * right / (left + right) if left * right > 0.0 else 0.0


@kernel
def monotone_cubic(
    first: float,  # Place of the first point, and spacing of all.
    spacing: float,  # Place of the first point, and spacing of all.
    values: Floats,
    at: Floats,
) -> tuple[Floats, Floats]:
    """Values and slopes at some places; beyond the points their last value, slope zero.

    Returns
    -------
    read, slope : ndarray, shape (m, k)
    """
    count, columns = values.shape
    read = np.empty((at.size, columns))
    slope = np.zeros((at.size, columns))
    for m in range(at.size):
        place = (at[m] - first) / spacing
        n = min(max(int(place), 0), count - 2)
        t = min(max(place - n, 0.0), 1.0)
        inside = t == place - n
        for k in range(columns):
            here, rise = values[n, k], values[n + 1, k] - values[n, k]
            one, two = _slope(values, n, k), _slope(values, n + 1, k)
            bend, twist = 3 * rise - 2 * one - two, one + two - 2 * rise
            read[m, k] = here + t * (one + t * (bend + t * twist))
            if inside:
                slope[m, k] = (one + t * (2 * bend + 3 * t * twist)) / spacing
    return read, slope
