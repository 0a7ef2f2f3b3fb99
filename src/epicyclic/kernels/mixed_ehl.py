"""Regressions of mixed-EHL simulations for one automatic transmission fluid.

Talbot (2012): sliding friction, Eq. 5.8 with Table 5.2(a); rolling loss of gear contacts, Eq. 5.10
with Table 5.2(b); rolling loss of needle contacts, Eq. 3.5 with Table 3.2. Arguments are the
dimensionless groups of the source: s = |u_s|/u_r, U, G, p = p_h/E_eq, R = R_eq/b_h, S_co and S_eq
over R_eq, film ratio L. The branches in L do not meet; each pair is blended here (`blend_weight`).

The formula of a branch takes its coefficients, in which it is linear, so that other simulations are
fitted with it too. It takes numbers and arrays; compiled, its name has an underscore.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.kernels.compiling import kernel

# Talbot (2012), limits of the branches of Eq. 5.8 and 5.10. [1]
FRICTION_BOUNDARY_LIMIT = 0.7
FRICTION_FULL_FILM_LIMIT = 3.0
ROLLING_LIMIT = 1.0
# Half-width of the blend between branches, in ln L. Not in the source: its branches jump.
BLEND_HALF_WIDTH = 0.2
# Tables 5.2(a), 5.2(b) and 3.2 of Talbot (2012).
FRICTION_BOUNDARY = (
    -0.92139, -0.00008711, -4400.2, -208.356, 0.00034889, 0.00000156, 18.9479,
    0.00201603, -0.0059483, -1.90169, -0.579273, -0.00711570,
)  # fmt: skip
FRICTION_MIXED = (
    -4.35656, -0.0060247, 0.00001033, -5940595.0, -0.00009197, -0.0251361, 0.0092455, -0.146072,
    -21.8661, 0.00007909, 0.00315987, -0.0584464,
)  # fmt: skip
FRICTION_FULL_FILM = (
    -54.986, -0.0058891, -0.041242, 0.00000905, 0.48686, -0.00022193, 21.533, 0.0074347, 6.8850,
    0.035346, -5.2323, -0.00073500, -0.052499,
)  # fmt: skip
ROLLING_MIXED = (
    -55.5228, -4049775804.0, 0.00036893, 91748360.0, 0.0035756, -2.81418, 0.79315, -1.57573,
    0.71772, -4.20259, -0.162010,
)  # fmt: skip
ROLLING_FILM = (
    -63.8414, -0.74816, 700205388.0, -4.85987, -0.287849, -0.43762, 2202.89, -0.183452, -0.123683,
    0.50128, -0.370511,
)  # fmt: skip
NEEDLE_FILM = (
    27.3758, 0.0169312, -0.00260401, 55.582, 0.179813, -0.097448, -1.33225, 0.272560, -15.4258,
    -0.102883, 0.233836,
)  # fmt: skip
# Smallest slide-to-roll ratio put into the powers: at the pitch point s = 0 and mu -> 0. [1]
SMALLEST_SLIDE_TO_ROLL = 1e-9


@kernel
def blend_weight(lam: float, limit: float) -> float:
    """Weight of the branch above `limit`: 0 to 1 with continuous slope in ln(lam). Theory (F4)."""
    t = (math.log(lam / limit) + BLEND_HALF_WIDTH) / (2.0 * BLEND_HALF_WIDTH)
    t = min(max(t, 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def log_mu_boundary(c: Any, groups: Any) -> Any:
    """ln(mu) of Eq. 5.8a, 0 < L <= 0.7. Theory (F1)."""
    a0, a1, a2, a3, a4, a5, a6, b1, b2, b3, b4, b5 = c
    s, u, g, p, r, s_co, s_eq, lam = groups
    exponent = a0 + s * (a1 * g + a2 * s_eq) + lam * (a3 * p + a4 * g) + r * (a5 * g + a6 * s_co)
    return (
        exponent
        + (b1 * r + b2 * np.log(s_co)) * np.log(s)
        + b3 * lam * np.log(r)
        + (b4 * lam + b5 * np.log(u)) * np.log(s_co)
    )


def log_mu_mixed(c: Any, groups: Any) -> Any:
    """ln(mu) of Eq. 5.8b, 0.7 < L <= 3. Theory (F2)."""
    a0, a1, a2, a3, b1, b2, b3, b4, b5, b6, b7, b8 = c
    s, u, g, p, r, s_co, _, lam = groups
    return (
        a0
        + r * (a1 * s + a2 * g + a3 * u)
        + (b1 * g + b2 * np.log(u) + b3 * r + b4 * np.log(r)) * np.log(s)
        + b5 * p * np.log(lam)
        + b6 * g * np.log(p)
        + (b7 * r + b8 * np.log(r)) * np.log(s_co)
    )


def log_mu_full_film(c: Any, groups: Any) -> Any:
    """ln(mu) of Eq. 5.8c, L > 3. Theory (F3)."""
    a0, a1, a2, a3, b1, b2, b3, b4, b5, b6, b7, b8, b9 = c
    s, u, g, p, r, _, _, _ = groups
    return (
        a0
        + a1 * s * r
        + g * (a2 * p + a3 * r)
        + (b1 + b2 * g + b3 * p + b4 * r) * np.log(s)
        + (b5 + b6 * r) * np.log(g)
        + b7 * p * np.log(u)
        + (b8 * g + b9 * r) * np.log(r)
    )


_log_mu_boundary = kernel(log_mu_boundary)
_log_mu_mixed = kernel(log_mu_mixed)
_log_mu_full_film = kernel(log_mu_full_film)


@kernel
def sliding_friction(
    s: float, u: float, g: float, p: float, r: float, s_co: float, s_eq: float, lam: float
) -> float:
    """Coefficient of sliding friction, Talbot (2012) Eq. 5.8, branches blended. Theory (F4). [1]"""
    groups = (max(s, SMALLEST_SLIDE_TO_ROLL), u, g, p, r, s_co, s_eq, lam)
    upper = blend_weight(lam, FRICTION_BOUNDARY_LIMIT)
    full = blend_weight(lam, FRICTION_FULL_FILM_LIMIT)
    log_mu = 0.0
    if upper < 1.0:
        log_mu += (1.0 - upper) * _log_mu_boundary(FRICTION_BOUNDARY, groups)
    if upper > 0.0 and full < 1.0:
        log_mu += upper * (1.0 - full) * _log_mu_mixed(FRICTION_MIXED, groups)
    if full > 0.0:
        log_mu += full * _log_mu_full_film(FRICTION_FULL_FILM, groups)
    return math.exp(log_mu)


def log_rolling_mixed(c: Any, groups: Any) -> Any:
    """ln of Eq. 5.10a without its prefactor, 0 < L <= 1. Theory (R1)."""
    a0, a1, a2, a3, b1, b2, b3, b4, b5, b6, b7 = c
    s, u, g, _, r, s_co, s_eq, lam = groups
    log_u = np.log(u)
    return (
        a0
        + s * (a1 * u + a2 * g)
        + a3 * s_co * s_eq
        + b1 * r * np.log(lam)
        + b2 * log_u
        + b3 * lam * np.log(g)
        + b4 * np.log(r)
        + b5 * lam * np.log(s_co)
        + (b6 + b7 * log_u) * np.log(s_eq)
    )


def log_rolling_film(c: Any, groups: Any) -> Any:
    """ln of Eq. 5.10b without its prefactor, L > 1. Theory (R2).

    The bases of b5 (G) and b6 (R_eq) are set the way in which the two branches meet at L = 1.
    """
    a0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10 = c
    s, u, g, p, r, s_co, s_eq, lam = groups
    log_u, log_g, log_p = np.log(u), np.log(g), np.log(p)
    return (
        a0
        + (b1 * s + b2 * u) * np.log(lam)
        + (b3 + b4 * log_p) * log_u
        + b5 * s * log_g
        + b6 * s_co * np.log(r)
        + (b7 * log_u + b8 * log_g + b9 * log_p) * np.log(s_co)
        + b10 * s * np.log(s_eq)
    )


_log_rolling_mixed = kernel(log_rolling_mixed)
_log_rolling_film = kernel(log_rolling_film)


@kernel
def rolling_loss_number(
    s: float, u: float, g: float, p: float, r: float, s_co: float, s_eq: float, lam: float
) -> float:
    """Dimensionless rolling loss of Talbot (2012) Eq. 5.10, branches blended. Theory (R3). [1]

    Without the prefactor printed in the source, 1e5 W/m: `fitted_models.rolling_scale`.
    """
    groups = (s, u, g, p, r, s_co, s_eq, lam)
    film = blend_weight(lam, ROLLING_LIMIT)
    log_loss = 0.0
    if film < 1.0:
        log_loss += (1.0 - film) * _log_rolling_mixed(ROLLING_MIXED, groups)
    if film > 0.0:
        log_loss += film * _log_rolling_film(ROLLING_FILM, groups)
    return math.exp(log_loss)


# Reference lengths of the groups of Eq. 3.5. [m]
NEEDLE_ROUGHNESS_REFERENCE = 1e-6
NEEDLE_RADIUS_REFERENCE = 5e-3
# Prefactor printed in Eq. 3.5. [W/m]
NEEDLE_LOSS_SCALE = 1e5


def log_needle_loss(c: Any, contact: Any) -> Any:
    """ln of Eq. 3.5 without its prefactor, of a contact as `needle_rolling_loss` takes it. [1]

    Theory (B14).
    """
    a0, a1, a2, b1, b2, b3, b4, b5, b6, b7, b8 = c
    p_h, u_r, mu_d, alpha_pv, r_eq, s_co, e_eq = contact
    theta = u_r * mu_d / (p_h * s_co)
    log_theta = np.log(theta)
    log_u = np.log(u_r * mu_d / (e_eq * NEEDLE_ROUGHNESS_REFERENCE))
    g = alpha_pv * e_eq
    p = p_h / e_eq
    rough = s_co / NEEDLE_ROUGHNESS_REFERENCE
    return (
        a0
        + g * (a1 * theta + a2 * rough)
        + (b1 * theta + b2 * log_theta + b3 * log_u + b4 * rough) * log_theta
        + (b5 * log_u + b6 * p) * np.log(g)
        + (b7 * np.log(r_eq / NEEDLE_RADIUS_REFERENCE) + b8 * np.log(rough)) * np.log(p)
    )


_log_needle_loss = kernel(log_needle_loss)


@kernel
def needle_rolling_loss(
    p_h: float,  # Hertz pressure. [Pa]
    u_r: float,  # Rolling speed. [m/s]
    mu_d: float,  # Dynamic viscosity at the inlet. [Pa s]
    alpha_pv: float,  # Pressure-viscosity coefficient. [1/Pa]
    r_eq: float,  # Equivalent radius. [m]
    s_co: float,  # Composite rms roughness. [m]
    e_eq: float,  # Equivalent modulus. [Pa]
) -> float:
    """Rolling loss of a needle contact per length, Talbot (2012) Eq. 3.5 and Table 3.2. [W/m]

    Theory (B14).
    """
    log_loss = _log_needle_loss(NEEDLE_FILM, (p_h, u_r, mu_d, alpha_pv, r_eq, s_co, e_eq))
    return NEEDLE_LOSS_SCALE * math.exp(log_loss)


@kernel
def sliding_friction_at(
    s: FloatArray, u: FloatArray, g: FloatArray, p: FloatArray,
    r: FloatArray, s_co: FloatArray, s_eq: FloatArray, lam: FloatArray,
) -> FloatArray:  # fmt: skip
    """`sliding_friction` at every contact point; arrays of shape (n,)."""
    mu = np.empty(s.size)
    for i in range(s.size):
        mu[i] = sliding_friction(s[i], u[i], g[i], p[i], r[i], s_co[i], s_eq[i], lam[i])
    return mu


@kernel
def rolling_loss_number_at(
    s: FloatArray, u: FloatArray, g: FloatArray, p: FloatArray,
    r: FloatArray, s_co: FloatArray, s_eq: FloatArray, lam: FloatArray,
) -> FloatArray:  # fmt: skip
    """`rolling_loss_number` at every contact point; arrays of shape (n,)."""
    loss = np.empty(s.size)
    for i in range(s.size):
        loss[i] = rolling_loss_number(s[i], u[i], g[i], p[i], r[i], s_co[i], s_eq[i], lam[i])
    return loss


@kernel
def needle_rolling_loss_at(p_h: FloatArray, numbers: FloatArray) -> FloatArray:
    """`needle_rolling_loss` of every slice at several points, (points, n). [W/m]

    Its other parameters are the rows of `numbers`.
    """
    loss = np.empty_like(p_h)
    for i in range(len(loss)):
        u_r, mu_d, alpha_pv, r_eq, s_co, e_eq = numbers[i]
        for k in range(loss.shape[1]):
            loss[i, k] = needle_rolling_loss(p_h[i, k], u_r, mu_d, alpha_pv, r_eq, s_co, e_eq)
    return loss
