"""Oil under pressure and shear in scaled form, for the line-contact solvers.

Pressure P = p/p_h, film H = h R/b^2, X = x/b; viscosity and density over those at ambient pressure.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from epicyclic.kernels._jit import kernel

__all__ = [
    "BARUS",
    "ROELANDS",
    "TWO_SLOPE",
    "ScaledFluid",
    "density_ratio",
    "log_viscosity_ratio",
    "mean_fluidity",
    "mean_shear",
    "thinning_factor",
]

BARUS, ROELANDS, TWO_SLOPE = 0, 1, 2
"""Codes of the viscosity-pressure laws."""
LARGE_SHEAR = 1e9
"""Sigma beyond which cosh(tau/tau_0) is Sigma to the last digit. [1]"""
CUBIC_START, CUBIC_END = 0.7, 1.4
"""Where the cubic between the two slopes starts and ends, over the transition pressure."""


class ScaledFluid(NamedTuple):
    """An oil in one contact.

    Attributes
    ----------
    law : int
        `BARUS`, `ROELANDS` or `TWO_SLOPE`.
    slope : float
        d(ln mu)/dP at P = 0.
    second : float
        Roelands: p_h over his pole pressure. Two slopes: slope at high pressure.
    third : float
        Roelands: index z. Two slopes: transition pressure over p_h.
    stiffening, packing : float
        a and b of the density ratio (1 + a P)/(1 + b P).
    poiseuille : float
        1/lambda: factor of rho H^3/mu in the flow of the pressure gradient.
    sliding : float
        mu |u_s| R/(p_h b^2): Newtonian stress over p_h, times H over the viscosity ratio.
    eyring : float
        tau_0/p_h of the Ree-Eyring law; infinite for a Newtonian oil.
    """

    law: int
    slope: float
    second: float
    third: float
    stiffening: float
    packing: float
    poiseuille: float
    sliding: float
    eyring: float


@kernel
def log_viscosity_ratio(pressure: float, fluid: ScaledFluid) -> tuple[float, float]:
    """ln of the viscosity ratio and its derivative at P. Theory (H5), (H6), (H7)."""
    if fluid.law == BARUS:
        return fluid.slope * pressure, fluid.slope
    if fluid.law == ROELANDS:
        base = 1.0 + fluid.second * pressure
        power = base**fluid.third
        scale = fluid.slope / (fluid.second * fluid.third)
        return scale * (power - 1.0), fluid.slope * power / base
    return two_slopes(pressure, fluid.slope, fluid.second, fluid.third)


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
def density_ratio(pressure: float, fluid: ScaledFluid) -> tuple[float, float]:
    """Density ratio and its derivative at P: Dowson and Higginson. Theory (H8)."""
    below = 1.0 + fluid.packing * pressure
    ratio = (1.0 + fluid.stiffening * pressure) / below
    return ratio, (fluid.stiffening - fluid.packing) / (below * below)


@kernel
def mean_fluidity(
    log_left: float, log_right: float, root_left: float, root_right: float
) -> tuple[float, float, float]:
    """Mean of 1/mu between two nodes and its derivatives in ln(mu) of each. Theory (H13).

    The logarithmic mean: exact for a flow through a cell in which mu is exponential in p. `root_*`
    is mu^-1/2 of each node.
    """
    half = 0.5 * (log_right - log_left)
    level = root_left * root_right
    if abs(half) < 1e-3:  # series, where the closed form loses its digits
        ratio = 1.0 + half * half / 6.0
        slope = half / 3.0
    else:
        growth = root_left / root_right
        ratio = 0.5 * (growth - 1.0 / growth) / half
        slope = (0.5 * (growth + 1.0 / growth) - ratio) / half
    mean = level * ratio
    return mean, -0.5 * mean - 0.5 * level * slope, -0.5 * mean + 0.5 * level * slope


@kernel
def thinning_factor(viscosity: float, film: float, fluid: ScaledFluid) -> tuple[float, float]:
    """Factor by which sliding eases the pressure flow, and d(ln factor)/d(ln Sigma).

    Theory (H12).

    cosh(tau_m/tau_0) = sqrt(1 + Sigma^2) with tau_m/tau_0 = asinh(Sigma), Sigma = mu u_s/(tau_0 h).
    """
    sigma = viscosity * fluid.sliding / (film * fluid.eyring)
    if sigma > LARGE_SHEAR:  # sigma squared may overflow
        return sigma, 1.0
    return math.sqrt(1.0 + sigma * sigma), sigma * sigma / (1.0 + sigma * sigma)


@kernel
def mean_shear(pressure: float, film: float, fluid: ScaledFluid) -> float:
    """Mean shear stress tau_m/p_h over the film. Theory (H17)."""
    log_mu, _ = log_viscosity_ratio(pressure, fluid)
    newtonian = math.exp(log_mu) * fluid.sliding / film
    if math.isinf(fluid.eyring):
        return newtonian
    return fluid.eyring * math.asinh(newtonian / fluid.eyring)
