"""Friction of films and asperities, the oil as hot as its shear and the flanks make it."""

from __future__ import annotations

import math

import numpy as np

from epicyclic.arrays import TINY, FloatArray
from epicyclic.kernels.compiling import formula, kernel
from epicyclic.kernels.line_contact import (
    LEAST_LOAD,
    Real,
    asperity_share,
    central_film,
    exponential,
    flash_temperature,
    hertz_half_width,
    hertz_pressure,
    logarithm,
    power,
    slide_to_roll_ratio,
)

MEAN_FLASH = 2 / 3
"""Mean over largest rise in an evenly heated, fast contact: the rise grows with sqrt(x). [1]"""
MEAN_PRESSURE = math.pi / 4  # Mean over largest pressure of Hertz. [1]

LARGE = 20.0  # From here on arsinh(exp(x)) is x + ln 2 to the last digit. [1]
OFFSET = 0.7  # Of ASTM D341. [mm^2/s]
LEAST_VISCOSITY = 0.01  # That no heat goes below: thinner than any oil. [mm^2/s]
START = 0.3  # Stress over its limit at unheated pressure with which bisection starts. [1]
QUICK_STEPS, STEPS = 4, 100  # Of Newton's method alone, and held between bounds.
LEFT = 1e-9  # Of the stress: what a step leaves is its cube over the square of the one before. [1]
CLOSE = 1e-4  # Size of that step over the stress, at most: a longer one may meet another bend. [1]


@kernel
def eyring_stress(
    temperature: FloatArray, pressure: FloatArray, log_rate: FloatArray, oil: tuple[float, ...]
) -> tuple[FloatArray, FloatArray]:
    """tau_E arsinh(eta rate/tau_E) with tau_E = Lambda/alpha, eta of Barus. Theory (Y6). [Pa]

    With its derivative to the temperature [Pa/K]. `pressure` [Pa]; `log_rate` of the shear rate
    times rho alpha/Lambda at T0 and 1 mm^2/s; `oil` holds, at its temperature T0 [K],
    ln(nu + 0.7) and ln(nu) with nu in mm^2/s, the slope of ASTM D341, density times 1 mm^2/s
    [Pa s], alpha [1/Pa], d(ln alpha)/d(ln nu), and the limit Lambda [1]. Loops are short: the
    processor works on the next turns while exponentials of one wait for each other.
    """
    T0, log_shifted0, _, slope, _, _, _, _ = oil
    log_shifted, log_viscosity = np.empty_like(pressure), np.empty_like(pressure)
    fall = np.empty_like(pressure)  # d(ln nu)/dT
    for i in range(len(pressure)):
        log_shifted[i] = log_shifted0 * exponential(slope * logarithm(T0 / temperature[i]))
    for i in range(len(pressure)):
        shifted = exponential(log_shifted[i])
        viscosity = max(shifted - OFFSET, LEAST_VISCOSITY)
        fall[i] = -slope * shifted * log_shifted[i] / (temperature[i] * viscosity)
        log_viscosity[i] = logarithm(viscosity)
    return _sheared(log_viscosity, fall, pressure, log_rate, oil)


@kernel
def _sheared(
    log_viscosity: FloatArray, fall: FloatArray, pressure: FloatArray, log_rate: FloatArray,
    oil: tuple[float, ...],
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """`eyring_stress` at a viscosity, the logarithm of which falls with the temperature [1/K]."""
    _, _, log_viscosity0, _, _, alpha0, exponent, limit = oil
    stress, slope = np.empty_like(pressure), np.empty_like(pressure)
    for i in range(len(pressure)):
        log_alpha = exponent * (log_viscosity[i] - log_viscosity0)  # over alpha at T0
        alpha = alpha0 * exponential(log_alpha)
        stress[i] = log_viscosity[i] + log_alpha + log_rate[i] + alpha * pressure[i]
        slope[i] = alpha
    for i in range(len(pressure)):
        x, alpha = stress[i], slope[i]
        ratio = exponential(min(x, LARGE))
        root = math.sqrt(1.0 + ratio * ratio)
        # arsinh(ratio) = ln(1 + more), where what is lost of small ones is added
        more = ratio + ratio * ratio / (1.0 + root)
        rounded = 1.0 + more
        arsinh = logarithm(rounded) + (more - (rounded - 1.0)) / rounded + max(x - LARGE, 0.0)
        rise = ratio / root * (1.0 + exponent + exponent * alpha * pressure[i])
        scale = limit / alpha
        stress[i] = scale * arsinh
        slope[i] = scale * fall[i] * (rise - exponent * arsinh)
    return stress, slope


@kernel
def _bounded(
    pressure: FloatArray, log_rate: FloatArray, warm: float, heating: float, oil: tuple[float, ...]
) -> float:
    """`film_stress` where Newton's method runs in circles: bisection where it leaves bounds."""
    stress: float = START * oil[7] * pressure[0]
    low, high, moved, temperature = 0.0, math.inf, math.inf, np.empty_like(pressure)
    for _ in range(STEPS):
        temperature[0] = oil[0] + warm + heating * stress
        hots, slopes = eyring_stress(temperature, pressure, log_rate, oil)
        hot, step = hots[0], (hots[0] - stress) / (1.0 - heating * slopes[0])
        last, stress, size = stress, stress + step, abs(step)
        close = size <= CLOSE * stress and moved < math.inf
        if close and size * size * size <= LEFT * stress * moved * moved:
            break
        if hot > last:
            low = last
        else:
            high = last
        if stress < low or stress > high or size > moved / 2.0:
            stress = min((low + high) / 2.0, 2.0 * last)
        moved = abs(stress - last)
    return stress


@kernel
def film_stress(
    pressure: FloatArray,  # Mean pressure, shape (n,). [Pa]
    rate: FloatArray,  # Shear rate, shape (n,). [1/s]
    warm: FloatArray,  # Rise by the friction of asperities, shape (n,). [K]
    heating: FloatArray,  # Rise per stress of the film, shape (n,). [K/Pa]
    oil: FloatArray,  # As for `eyring_stress`, shape (8,) or longer.
) -> FloatArray:
    """Stress tau of each film at the temperature T0 + warm + heating tau. Theory (Y7). [Pa]"""
    n, its = len(pressure), oil
    log_rate, cold, falls, temperature = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    moved, left = np.empty(n), np.empty(n)
    own = (its[0], its[1], its[2], its[3], its[4], its[5], its[6], its[7])
    fall = -own[3] * math.exp(own[1]) * own[1] / (own[0] * math.exp(own[2]))
    for i in range(n):
        sheared = rate[i] if rate[i] > 0.0 else 1.0
        log_rate[i] = logarithm(sheared * (own[4] * own[5] / own[7]))
        cold[i], falls[i], moved[i] = own[2], fall, math.inf
    # first as of an oil whose stress falls with the temperature as at T0
    stress, slope = _sheared(cold, falls, pressure, log_rate, own)
    for i in range(n):
        steep = slope[i] / (stress[i] + TINY)
        warmed = stress[i] * exponential(steep * warm[i])
        stress[i] = warmed / (1.0 - heating[i] * steep * warmed)
    for number in range(QUICK_STEPS):
        for i in range(n):
            temperature[i] = own[0] + warm[i] + heating[i] * stress[i]
        hot, slope = eyring_stress(temperature, pressure, log_rate, own)
        for i in range(n):
            step = (hot[i] - stress[i]) / (1.0 - heating[i] * slope[i])
            stress[i] += step
            size = abs(step)
            bent = LEFT * stress[i] * moved[i] * moved[i] - size * size * size
            left[i] = min(bent, CLOSE * stress[i] - size)
            moved[i] = size
        found = 0
        for i in range(n):
            found += left[i] >= 0.0
        if number and found == n:
            break
    for i in range(n):
        if not left[i] >= 0.0:
            alone = slice(i, i + 1)
            stress[i] = _bounded(pressure[alone], log_rate[alone], warm[i], heating[i], own)
        if not rate[i] > 0.0:
            stress[i] = 0.0
    return stress


@formula
def acting_roughness(grown: Real, one: float, cut1: float, two: float, cut2: float) -> Real:
    """sigma^2 = sum of (f Rq (2 b/l_c)^H)^2 of both flanks, 2 b/l_c at most 1. Theory (Y3). [m]

    `grown` (2 b)^H, `one` and `two` f Rq of both flanks [m], `cut1` and `cut2` l_c^H. A self-affine
    profile has an rms height that grows with the length L that is looked at as L^H; what is longer
    than the contact is wide leaves both flanks parallel and breaks no film.
    """
    height1, height2 = one * np.minimum(grown / cut1, 1.0), two * np.minimum(grown / cut2, 1.0)
    sigma: Real = np.sqrt(height1 * height1 + height2 * height2)
    return sigma


@kernel
def mixed_friction(
    line_load: FloatArray,  # W', shape (points, n). [N/m]
    radius: FloatArray,  # R_eq, shape (points, n) or (1, n). [m]
    rolling: FloatArray,  # u_r, shape (points, n). [m/s]
    sliding: FloatArray,  # u_s, shape (points, n). [m/s]
    film: FloatArray,  # Thickness, shape (points, n); (points, 0) for `central_film`. [m]
    # E_eq [Pa], effusivities of both bodies [W s^0.5/(m^2 K)], what `acting_roughness` takes of
    # both flanks, and H [1], shape (points, 8).
    flanks: FloatArray,
    # As for `eyring_stress`; behind it viscosity [Pa s], thermal load over the square of the speed
    # [s^2/m^2], conductivity [W/(m K)], and the friction mu_b of asperities [1], (points, 12).
    oil: FloatArray,
) -> FloatArray:
    """mu = xi mu_b + (1 - xi) tau/p, tau as hot as the film is. Theory (Y8). [1]"""
    friction, n = np.empty_like(line_load), line_load.shape[1]
    share, pressure, rate = np.empty(n), np.empty(n), np.empty(n)
    warm, heating, films = np.empty(n), np.empty(n), np.empty(n)
    for row in range(len(line_load)):
        w, u, u_s, mu = line_load[row], rolling[row], sliding[row], friction[row]
        R = radius[row % len(radius)]
        E, e1, e2, one, cut1, two, cut2, exponent = flanks[row]
        alpha = oil[row, 5]
        viscosity, thermal, conductivity, boundary = oil[row, 8:]
        if film.shape[1]:
            films[:] = film[row]
        else:
            for i in range(n):
                slip = slide_to_roll_ratio(u_s[i], u[i])
                films[i] = central_film(
                    w[i], R[i], u[i], slip, E, viscosity, alpha, thermal * u[i] * u[i]
                )
        for i in range(n):
            width = 2.0 * hertz_half_width(w[i], R[i], E)
            share[i] = films[i] / acting_roughness(power(width, exponent), one, cut1, two, cut2)
        for i in range(n):
            b, xi = hertz_half_width(w[i], R[i], E), asperity_share(share[i])
            p = np.maximum(MEAN_PRESSURE * hertz_pressure(w[i], R[i], E), LEAST_LOAD)
            half = u_s[i] / 2.0
            # of the flanks for a coefficient of friction of 1
            flash = MEAN_FLASH * flash_temperature(
                1.0, w[i], u_s[i], u[i] + half, u[i] - half, b, e1, e2
            )
            share[i], pressure[i], rate[i] = xi, p, abs(u_s[i]) / films[i]
            warm[i] = flash * xi * boundary
            # rises for each pascal of the film: of both flanks, and the mean across it
            heating[i] = flash * (1.0 - xi) / p + abs(u_s[i]) * films[i] / (12.0 * conductivity)
        stress = film_stress(pressure, rate, warm, heating, oil[row])
        for i in range(n):
            mu[i] = share[i] * boundary + (1.0 - share[i]) * stress[i] / pressure[i]
    return friction
