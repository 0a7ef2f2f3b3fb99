"""Reynolds' equation for a journal bearing of finite width, also tilted, with rupture of the film.

The angle runs in the sense of rotation; the film over the radial clearance is 1 less the part of
middle + tilt zeta along the angle, with zeta from -1 to 1 across the width, as complex numbers that
point to the narrowest film. The pressure is over 6 eta omega (R/C)^2.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.compiling import kernel

FloatArray = NDArray[np.float64]


@kernel
def journal_pressure(
    middle: complex,
    tilt: complex,
    width: float,  # L/D
    angles: FloatArray,  # of the points around the circumference, rising
    places: FloatArray,  # of the points across the width, from -1 to 1
    closed: NDArray[np.bool_],  # where around there is no pressure
    P: FloatArray,  # pressure at the points: to start from, and what is found
    tolerance: float,
    most: int,
) -> tuple[complex, complex, float, int]:
    """Force and moment of the pressure, the flow at both sides, and the sweeps taken.

    Finite volumes, and projected over-relaxation: the pressure is nowhere negative, which gives
    Reynolds' condition where the film ruptures. The sweeps are negative without convergence.
    """
    around, across = angles.size, places.size
    ahead = np.zeros((around, across))
    side = np.zeros((around, across))
    dragged = np.zeros((around, across))
    steps = np.empty(around)
    cells = np.empty(around)
    for i in range(around):
        steps[i] = angles[(i + 1) % around] - angles[i] + (2 * math.pi if i == around - 1 else 0.0)
    for i in range(around):
        cells[i] = (steps[i] + steps[i - 1]) / 2
        here = complex(math.cos(angles[i]), -math.sin(angles[i]))
        front = here * complex(math.cos(steps[i] / 2), -math.sin(steps[i] / 2))
        for j in range(across - 1):
            film = 1 - ((middle + tilt * (places[j] + places[j + 1]) / 2) * here).real
            side[i, j] = film**3 * cells[i] / ((places[j + 1] - places[j]) * width**2)
            if j:
                film = 1 - ((middle + tilt * places[j]) * front).real
                dragged[i, j] = film * (places[j + 1] - places[j - 1]) / 2
                ahead[i, j] = film**2 * dragged[i, j] / steps[i]
    source = np.zeros((around, across))
    share = np.zeros((around, across))
    for i in range(around):
        for j in range(1, across - 1):
            source[i, j] = dragged[i - 1, j] - dragged[i, j]
            share[i, j] = 1 / (ahead[i, j] + ahead[i - 1, j] + side[i, j] + side[i, j - 1])
    relaxed = 2 / (1 + math.pi / max(around / 2, across))
    sweeps = -most
    for sweep in range(1, most + 1):
        change = largest = 0.0
        # as on a chessboard, of which the points of one colour do not wait for each other
        for turn in range(2 * around):
            i, before, following = turn % around, (turn - 1) % around, (turn + 1) % around
            if closed[i]:
                continue
            for j in range(1 + (i + turn // around) % 2, across - 1, 2):
                wanted = share[i, j] * (
                    ahead[i, j] * P[following, j]
                    + ahead[before, j] * P[before, j]
                    + side[i, j] * P[i, j + 1]
                    + side[i, j - 1] * P[i, j - 1]
                    + source[i, j]
                )
                new = max(0.0, P[i, j] + relaxed * (wanted - P[i, j]))
                change = max(change, abs(new - P[i, j]))
                largest = max(largest, new)
                P[i, j] = new
        if change <= tolerance * largest:
            sweeps = sweep
            break
    force, moment, flow = 0j, 0j, 0.0
    for i in range(around):
        outward = complex(math.cos(angles[i]), math.sin(angles[i]))
        for j in range(1, across - 1):
            push = outward * P[i, j] * cells[i] * (places[j + 1] - places[j - 1]) / 4
            force += push
            moment += push * places[j]
        flow += side[i, 0] * P[i, 1] + side[i, across - 2] * P[i, across - 2]
    return force, moment, flow / 4, sweeps
