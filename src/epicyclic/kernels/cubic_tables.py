"""Tables over the pressure, and over the place on a path of contact: cubics through four points."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels._jit import kernel

Floats = NDArray[np.float64]


@kernel
def _cubic(place: float, size: int, weights: Floats) -> int:
    """Write the weights of four points next to a place among `size` ones; their first one.

    Lagrange's; places count the points from 0 and are held among them.
    """
    first = min(max(int(place) - 1, 0), size - 4)
    x = min(max(place, 0.0), size - 1.0) - first
    weights[0] = -(x - 1) * (x - 2) * (x - 3) / 6
    weights[1] = x * (x - 2) * (x - 3) / 2
    weights[2] = -x * (x - 1) * (x - 3) / 2
    weights[3] = x * (x - 1) * (x - 2) / 6
    return first


@kernel
def _weighted(weights: Floats, row: Floats, k: int) -> float:
    """Sum of the four weighted values from the k-th one."""
    total = 0.0
    for a in range(4):
        total += weights[a] * row[k + a]
    return total


@kernel
def over_pressure(
    pressure: Floats,  # p_h, held within `pressures`. [Pa]
    # Lowest and highest one of the points, which are even in the logarithm. [Pa]
    pressures: Floats,
    values: Floats,
) -> Floats:
    """A quantity under a pressure, shape (n,).

    Theory (O16).
    """
    found, weights = np.empty(pressure.size), np.empty(4)
    low = math.log(pressures[0])
    level = (values.size - 1) / (math.log(pressures[1]) - low)
    for i in range(pressure.size):
        k = _cubic((math.log(pressure[i]) - low) * level, values.size, weights)
        found[i] = _weighted(weights, values, k)
    return found


@kernel
def along_path(
    path: Floats, pressure: Floats, ends: Floats, crowding: Floats, pressures: Floats,
    values: Floats,
) -> Floats:  # fmt: skip
    """A quantity at places on the path of contact under a pressure, shape (n,).

    Theory (O16).

    Parameters
    ----------
    path : ndarray, shape (n,)
        s, from the pitch point. [m]
    pressure : ndarray, shape (n,)
        p_h, held within `pressures`. [Pa]
    ends : ndarray, shape (2,)
        Ends of the path on the negative and on the positive side. [m]
    crowding : ndarray, shape (2,)
        k of both sides: how much points crowd at the pitch point. [1]
    pressures : ndarray, shape (2,)
        Lowest and highest one of the points, which are even in the logarithm. [Pa]
    values : ndarray, shape (2, m, k)
        At the points of both sides, from the pitch point outwards, and of the pressure.
    """
    found = np.empty(path.size)
    along, over = np.empty(4), np.empty(4)
    points, levels = values.shape[1:]
    low = math.log(pressures[0])
    level = (levels - 1) / (math.log(pressures[1]) - low)
    for i in range(path.size):
        side = 1 if path[i] >= 0 else 0
        share = path[i] / ends[side] if ends[side] != 0 else 0.0
        place = math.log1p(math.expm1(crowding[side]) * share) / crowding[side] * (points - 1)
        m = _cubic(place, points, along)
        k = _cubic((math.log(pressure[i]) - low) * level, levels, over)
        found[i] = 0.0
        for a in range(4):
            found[i] += along[a] * _weighted(over, values[side, m + a], k)
    return found
