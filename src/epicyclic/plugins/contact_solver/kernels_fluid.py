"""Oil under pressure and shear in scaled form, for the line-contact solvers.

Pressure P = p/p_h, film H = h R/b^2, X = x/b; viscosity and density over those at ambient pressure.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from epicyclic.kernels.compiling import kernel
from epicyclic.kernels.line_contact import two_slopes

BARUS, ROELANDS, TWO_SLOPE = 0, 1, 2  # Codes of the viscosity-pressure laws.
NEWTONIAN, EYRING, LIMITING, CARREAU = 0, 1, 2, 3  # Codes of the laws of shear.
LARGE_SHEAR = 1e9  # Sigma beyond which cosh(tau/tau_0) is Sigma to the last digit. [1]
PLUG_SHEAR = 5.0
"""What Sigma saturates at in the easing of the flow of an oil at its limiting stress. [1]"""
EVEN = 2e-3
"""Difference of ln(mu) between two nodes below which a series replaces the closed form of their
mean fluidity, which loses digits; the series is 1e-14 off. [1]"""


class ScaledFluid(NamedTuple):
    """An oil in one contact."""

    law: int  # `BARUS`, `ROELANDS` or `TWO_SLOPE`.
    slope: float  # d(ln mu)/dP at P = 0.
    second: float  # Roelands: p_h over his pole pressure. Two slopes: slope at high pressure.
    third: float  # Roelands: index z. Two slopes: transition pressure over p_h.
    stiffening: float  # a and b of the density ratio (1 + a P)/(1 + b P).
    packing: float  # a and b of the density ratio (1 + a P)/(1 + b P).
    poiseuille: float  # 1/lambda: factor of rho H^3/mu in the flow of the pressure gradient.
    # mu |u_s| R/(p_h b^2): Newtonian stress over p_h, times H over the viscosity ratio.
    sliding: float
    shear_law: int  # `NEWTONIAN`, `EYRING`, `LIMITING` or `CARREAU`.
    stress: float  # Stress of the law of shear over p_h at P = 0, and its derivative in P.
    stress_slope: float  # Stress of the law of shear over p_h at P = 0, and its derivative in P.
    exponent: float  # n of the Carreau law.


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
def density_ratio(pressure: float, fluid: ScaledFluid) -> tuple[float, float]:
    """Density ratio and its derivative at P: Dowson and Higginson. Theory (H8)."""
    part = 1.0 / (1.0 + fluid.packing * pressure)
    ratio = (1.0 + fluid.stiffening * pressure) * part
    return ratio, (fluid.stiffening - fluid.packing) * (part * part)


@kernel
def flow_work(pressure: float, fluid: ScaledFluid) -> float:
    """Integral of the pressure over the density ratio: work to press a unit of mass in.

    Theory (H33).
    """
    a, b = fluid.stiffening, fluid.packing
    if a == 0.0:
        return pressure
    return b / a * pressure + (1.0 - b / a) * math.log1p(a * pressure) / a


@kernel
def mean_fluidity(
    log_left: float, log_right: float, root_left: float, root_right: float
) -> tuple[float, float, float]:
    """Mean of 1/mu between two nodes, and derivatives of its ln in ln(mu) of each. Theory (H13).

    The logarithmic mean: exact for a flow through a cell in which mu is exponential in p. `root_*`
    is mu^-1/2 of each node.
    """
    rise = log_right - log_left
    if abs(rise) < EVEN:
        by_left = -0.5 - rise / 12.0
        return root_left * root_right * (1.0 + rise * rise / 24.0), by_left, -1.0 - by_left
    left, fall = root_left * root_left, root_left * root_left - root_right * root_right
    by_left = 1.0 / rise - left / fall
    return fall / rise, by_left, -1.0 - by_left


@kernel
def thinning_factor(
    viscosity: float, film: float, pressure: float, fluid: ScaledFluid
) -> tuple[float, float, float]:
    """Factor by which sliding eases the pressure flow, the viscosity over that of a small change.

    Behind the factor d(ln factor)/d(ln Sigma), Sigma = mu u_s/(tau_0 h), and d(ln Sigma)/dP by the
    stress of the law alone. Theory (H12), (H27), (H28).
    """
    if fluid.shear_law == NEWTONIAN:
        return 1.0, 0.0, 0.0
    part = 1.0 / (film * (fluid.stress + fluid.stress_slope * pressure))
    sigma = viscosity * fluid.sliding * part
    softening = -fluid.stress_slope * film * part
    if fluid.shear_law == LIMITING:
        held = 1.0 / (1.0 + sigma / PLUG_SHEAR)
        return math.exp(sigma * held), sigma * held * held, softening
    if fluid.shear_law == CARREAU:
        n = fluid.exponent
        square = min(sigma, LARGE_SHEAR) ** 2
        factor = (1.0 + square) ** (0.5 * (3.0 - n)) / (1.0 + n * square)
        exponent = (3.0 - n) * square / (1.0 + square) - 2.0 * n * square / (1.0 + n * square)
        return factor, exponent, softening
    if sigma > LARGE_SHEAR:  # sigma squared may overflow
        return sigma, 1.0, softening
    square = 1.0 + sigma * sigma
    return math.sqrt(square), 1.0 - 1.0 / square, softening


@kernel
def mean_shear(pressure: float, film: float, thinned: float, fluid: ScaledFluid) -> float:
    """Mean shear stress tau_m/p_h over the film. Theory (H17), (H27), (H28).

    `thinned` is what heat takes off ln(mu).
    """
    log_mu, _ = log_viscosity_ratio(pressure, fluid)
    newtonian = math.exp(log_mu - thinned) * fluid.sliding / film
    if fluid.shear_law == NEWTONIAN:
        return newtonian
    stress = fluid.stress + fluid.stress_slope * pressure
    sigma = newtonian / stress
    if fluid.shear_law == EYRING:
        return stress * math.asinh(sigma)
    if fluid.shear_law == LIMITING:
        return -stress * math.expm1(-sigma)
    eased: float = newtonian * (1.0 + sigma * sigma) ** (0.5 * (fluid.exponent - 1.0))
    return eased
