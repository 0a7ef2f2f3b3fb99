"""Reynolds' equation for a cylindrical journal bearing of finite width, with rupture of the film.

The angle runs in the sense of rotation from the widest film, h = 1 + eps cos(theta) over the radial
clearance; the pressure is over 6 eta omega (R/C)^2; half of the width is solved.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.compiling import kernel

FloatArray = NDArray[np.float64]


@kernel
def journal_pressure(
    eps: float,
    width: float,  # L/D
    around: int,  # points around the circumference
    across: int,  # intervals over half of the width
    grooves: FloatArray,  # angles of the middle of axial grooves
    half_groove: float,  # half of the angle that each of them takes
    tolerance: float,
    most: int,
) -> FloatArray:
    """Forces towards and across the narrowest film, the side flow, and the sweeps taken.

    Projected over-relaxation: the pressure is nowhere negative, which gives Reynolds' condition
    where the film ruptures. The sweeps are negative without convergence.
    """
    step = 2 * math.pi / around
    dz = 1.0 / across
    P = np.zeros((around, across + 1))
    ahead, behind, side, source = (
        np.empty(around),
        np.empty(around),
        np.empty(around),
        np.empty(around),
    )
    closed = np.zeros(around)
    for i in range(around):
        theta = i * step
        front = 1 + eps * math.cos(theta + step / 2)
        back = 1 + eps * math.cos(theta - step / 2)
        ahead[i] = front**3 / step**2
        behind[i] = back**3 / step**2
        side[i] = (1 + eps * math.cos(theta)) ** 3 / (width * dz) ** 2
        source[i] = (front - back) / step
        for groove in grooves:
            apart = (theta - groove + math.pi) % (2 * math.pi) - math.pi
            if abs(apart) <= half_groove:
                closed[i] = 1.0
    relaxed = 2 / (1 + math.pi / max(around / 4, 2 * across))
    sweeps = -most
    for sweep in range(1, most + 1):
        change = largest = 0.0
        for i in range(around):
            if closed[i]:
                continue
            following, before = (i + 1) % around, (i - 1) % around
            whole = ahead[i] + behind[i] + 2 * side[i]
            for j in range(across):
                inner = P[i, j - 1] if j else P[i, 1]
                wanted = (
                    ahead[i] * P[following, j]
                    + behind[i] * P[before, j]
                    + side[i] * (inner + P[i, j + 1])
                    - source[i]
                ) / whole
                new = max(0.0, P[i, j] + relaxed * (wanted - P[i, j]))
                change = max(change, abs(new - P[i, j]))
                largest = max(largest, new)
                P[i, j] = new
        if change <= tolerance * largest:
            sweeps = sweep
            break
    towards = across_it = flow = 0.0
    for i in range(around):
        theta = i * step
        mean = 0.5 * P[i, 0]
        for j in range(1, across):
            mean += P[i, j]
        mean *= dz
        towards -= mean * math.cos(theta) * step
        across_it += mean * math.sin(theta) * step
        slope = (4 * P[i, across - 1] - P[i, across - 2]) / (2 * dz)
        flow += (1 + eps * math.cos(theta)) ** 3 * slope * step
    return np.array([towards, across_it, flow / (2 * width**2), float(sweeps)])
