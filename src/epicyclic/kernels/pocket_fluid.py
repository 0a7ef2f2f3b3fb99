"""The mixture in pockets: its state, and its flow through openings.

Pressures are kept as q = p/p_a - 1, which stays exact at low speed. Symbols follow the theory
manual, page on pocketing.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels._jit import kernel

Floats = NDArray[np.float64]
Mixture = tuple[float, float, float, float, float]
"""As from `mixture`."""

GAMMA = 1.4
"""Ratio of the specific heats of air. [1]"""
CHOKE_STEP = 0.05
CHOKE_END = 16.0
"""Step and end of the table of throat pressures, in the logarithm of the pressure."""


@kernel
def mixture(q: float, xi: float) -> Mixture:
    """The mixture at a pressure. Theory (Q8), (Q9).

    Returns
    -------
    q, rho, slope, enthalpy, swelling : float
        The pressure; the density over rho_m, and its derivative by q; the integral of dp/rho from
        ambient pressure, over p_a/rho_m; rho_m/rho - 1.
    """
    log_p = math.log1p(q)
    swelling = (1 - xi) * math.expm1(-log_p / GAMMA)
    slope = (1 - xi) / GAMMA * math.exp(-log_p * (1 / GAMMA + 1))
    power = (GAMMA - 1) / GAMMA
    enthalpy = xi * q + (1 - xi) / power * math.expm1(power * log_p)
    return q, 1 / (1 + swelling), slope / (1 + swelling) ** 2, enthalpy, swelling


@kernel
def choking_table(xi: float) -> Floats:
    """Throat pressure over stagnation pressure where the throat runs at the speed of sound.

    Theory (Q13).

    On a grid of the logarithm of the stagnation pressure, ``CHOKE_STEP`` apart from ``-CHOKE_END``
    to ``CHOKE_END``.
    """
    count = round(2 * CHOKE_END / CHOKE_STEP) + 1
    ratio = np.zeros(count)
    guess = 0.53
    for n in range(count):
        p = math.exp(-CHOKE_END + n * CHOKE_STEP)
        total = mixture(p - 1, xi)[3]
        low, high = 0.0, 1.0
        for _ in range(60):
            guess = (low + high) / 2
            _, _, slope, enthalpy, _ = mixture(guess * p - 1, xi)
            if enthalpy + 0.5 / slope > total:
                high = guess
            else:
                low = guess
        ratio[n] = guess
    return ratio


@kernel
def _throat(q: float, choke: Floats) -> tuple[float, float]:
    """Throat pressure of a choked nozzle less ambient, and its derivative by q. Theory (Q13)."""
    place = (math.log1p(q) + CHOKE_END) / CHOKE_STEP
    if place <= 0.0:
        return choke[0] * (1 + q) - 1, choke[0]
    if place >= choke.size - 1:
        return choke[-1] * (1 + q) - 1, choke[-1]
    n = int(place)
    slope = choke[n + 1] - choke[n]
    ratio = choke[n] + (place - n) * slope
    return ratio * (1 + q) - 1, ratio + slope / CHOKE_STEP


@kernel
def nozzle(
    a: Mixture, b: Mixture, xi: float, choke: Floats
) -> tuple[float, float, float, float, float, float]:
    """Drop of enthalpy from a to b down to the throat, density there, and their derivatives.

    Theory (Q12), (Q13).

    Returns
    -------
    drop, drop_a, drop_b, rho, rho_a, rho_b : float
        Over p_a/rho_m, and over rho_m.
    """
    if choke.size == 0:
        return _mean_density(a, b)
    if a[0] < b[0]:
        drop, drop_b, drop_a, rho, rho_b, rho_a = _nozzle_down(b, a, xi, choke)
        return -drop, -drop_a, -drop_b, rho, rho_a, rho_b
    return _nozzle_down(a, b, xi, choke)


@kernel
def _mean_density(a: Mixture, b: Mixture) -> tuple[float, float, float, float, float, float]:
    """`nozzle` with the mean density of both sides and no choking. Theory (Q19)."""
    rho = (a[1] + b[1]) / 2
    drop = (a[0] - b[0]) / rho
    drop_a = (1 - drop * a[2] / 2) / rho
    drop_b = (-1 - drop * b[2] / 2) / rho
    return drop, drop_a, drop_b, rho, a[2] / 2, b[2] / 2


@kernel
def _nozzle_down(
    a: Mixture, b: Mixture, xi: float, choke: Floats
) -> tuple[float, float, float, float, float, float]:
    """`nozzle` for a pressure that is not lower at a."""
    _, rho_up, _, total, _ = a
    q, rho, rho_p, enthalpy, _ = b
    throat, slope = _throat(a[0], choke)
    if throat > q:
        _, rho, rho_p, enthalpy, _ = mixture(throat, xi)
        return total - enthalpy, 1 / rho_up - slope / rho, 0.0, rho, rho_p * slope, 0.0
    return total - enthalpy, 1 / rho_up, -1 / rho, rho, 0.0, rho_p


@kernel
def donor(u: float, a: Mixture, b: Mixture) -> tuple[float, float, float]:
    """Density on the side that the flow comes from, and its derivatives by both pressures."""
    if u > 0.0:
        return a[1], a[2], 0.0
    return b[1], 0.0, b[2]
