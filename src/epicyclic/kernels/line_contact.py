"""Line contacts: Hertz, films, rolling traction, flash; mean Eyring stress; powers in loops."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

import numpy as np

from epicyclic.arrays import TINY, FloatArray
from epicyclic.kernels.compiling import formula, in_kernels, kernel

# Hertz line contact, film thickness and rolling traction: closed forms for numbers and arrays.
#
# E_eq = 2/[(1 - nu1^2)/E1 + (1 - nu2^2)/E2] throughout (called E' in film-thickness literature;
# twice Johnson's E*). Speeds are mean surface speeds, (u1 + u2)/2.


Real = TypeVar("Real", float, FloatArray)


def equivalent_modulus(e1: float, nu1: float, e2: float, nu2: float) -> float:
    """E_eq = 2/[(1 - nu1^2)/E1 + (1 - nu2^2)/E2]. Talbot (2012), p. 63. Theory (C1). [Pa]"""
    return 2 / ((1 - nu1**2) / e1 + (1 - nu2**2) / e2)


@formula
def hertz_half_width(w: Real, r_eq: Real, e_eq: float) -> Real:
    """b_h = sqrt(8 W' R_eq/(pi E_eq)). Johnson, Contact Mechanics (1985), Eq. 4.43. [m]

    Theory (C5). `w` line load [N/m], `r_eq` equivalent radius [m], `e_eq` [Pa].
    """
    half_width: Real = (8 * w * r_eq / (math.pi * e_eq)) ** 0.5
    return half_width


@formula
def hertz_pressure(w: Real, r_eq: Real, e_eq: float) -> Real:
    """p_h = 2 W'/(pi b_h). Johnson (1985), Eq. 4.45. Theory (C6). [Pa]"""
    pressure: Real = (w * e_eq / (2 * math.pi * r_eq)) ** 0.5
    return pressure


def line_load_at_pressure(p_h: Real, r_eq: Real, e_eq: float) -> Real:
    """W' that gives the Hertz pressure `p_h`: inverse of `hertz_pressure`. Theory (C6). [N/m]"""
    return 2 * math.pi * r_eq * p_h**2 / e_eq


# Exponential and logarithm that the compiler works out for four or eight numbers at a time. numpy
# and numba call those of the C library, one number at a time unless the processor has AVX-512,
# which takes four times as long. These are right to two units in the last place, loops over them
# become vector code on any processor, and they have the same bits in arrays of any length.
#
# W. J. Cody, W. Waite, Software Manual for the Elementary Functions (1980), general knowledge: both
# reduce the argument by powers of 2, here with the bits of the number, and sum a series.

_LN2, _LN2_REST = 6.93147180369123816e-1, 1.90821492927058770e-10  # ln 2, the first in few bits.
_LOWEST, _HIGHEST = -708.0, 709.0  # Between them exponentials are normal numbers.
_WHOLE = 1.5 * 2.0**52  # Added to a number, it rounds it to a whole one, in the last bits.
_BIAS, _PLACES = np.uint64(1023), np.uint64(52)  # Of the exponent in the bits of a number.
_ROOT_HALF = np.uint64(0x3FE6A09E667F3BCD)  # The bits of sqrt(1/2), from which mantissas go on.
_UP = np.uint64(0x3FF0000000000000) - _ROOT_HALF
_MANTISSA, _TWO_52 = np.uint64(0x000FFFFFFFFFFFFF), np.uint64(0x4330000000000000)
_LEAST = 1e-300  # Of which a logarithm is taken.
_OF_EXPONENTIAL = tuple(1 / math.factorial(n) for n in range(13, -1, -1))
_OF_LOGARITHM = tuple(1 / n for n in range(23, 1, -2))


@partial(kernel, inlined=True)
def exponential(x: float) -> float:
    """exp(x); infinite above 709, 3e-308 below -708. [1]"""
    held = min(max(x, _LOWEST), _HIGHEST)
    rounded = held * 1.4426950408889634 + _WHOLE  # log2(e)
    twos = rounded - _WHOLE
    r = (held - twos * _LN2) - twos * _LN2_REST
    series = 0.0
    for coefficient in _OF_EXPONENTIAL:
        series = series * r + coefficient
    bits: Any = np.float64(rounded).view(np.uint64) + _BIAS
    power: Any = np.uint64(bits << _PLACES).view(np.float64)
    return series * power if x <= _HIGHEST else x * np.inf


@partial(kernel, inlined=True)
def logarithm(x: float) -> float:
    """ln(x), of 1e-300 at least. [1]"""
    bits: Any = np.float64(max(x, _LEAST)).view(np.uint64) + _UP
    exponent: Any = np.uint64((bits >> _PLACES) | _TWO_52).view(np.float64)
    mantissa: Any = np.uint64((bits & _MANTISSA) + _ROOT_HALF).view(np.float64)
    twos = exponent - (2.0**52 + 1023)
    f = mantissa - 1.0
    s = f / (2.0 + f)  # ln(1 + f) = 2 artanh(s)
    z = s * s
    series = 0.0
    for coefficient in _OF_LOGARITHM:
        series = (series + coefficient) * z
    half = 0.5 * f * f  # 2 s = f - s f, and s f = f^2/2 - s f^2/2
    rest = s * (half + 2 * series) + twos * _LN2_REST
    return twos * _LN2 + (f - (half - rest)) if x < np.inf else x


@kernel
def exponentials(values: FloatArray) -> FloatArray:
    """`exponential` of each of the numbers in a row."""
    found = np.empty_like(values)
    for i in range(values.size):
        found[i] = exponential(values[i])
    return found


@kernel
def logarithms(values: FloatArray) -> FloatArray:
    """`logarithm` of each of the numbers in a row."""
    found = np.empty_like(values)
    for i in range(values.size):
        found[i] = logarithm(values[i])
    return found


def of_each(function: Callable[[FloatArray], FloatArray], values: FloatArray) -> FloatArray:
    """`exponentials` or `logarithms` of an array of any shape and type."""
    return function(np.asarray(values).ravel()).reshape(values.shape).view(type(values))


def power(*bases_exponents: Any) -> Any:
    """Product of base^exponent, bases not negative; numpy's own takes four times as long."""
    bases, exponents = bases_exponents[::2], bases_exponents[1::2]
    first, *others = (
        it * (math.log(max(base, _LEAST)) if isinstance(base, float) else of_each(logarithms, base))
        for base, it in zip(bases, exponents, strict=True)
    )
    exponent = sum(others, first)
    return np.exp(exponent) if isinstance(exponent, float) else of_each(exponentials, exponent)


def _power(
    base: float, its: float, second: float = 1.0, its2: float = 0.0, third: float = 1.0,
    its3: float = 0.0,
) -> float:  # fmt: skip
    """`power` of up to three numbers."""
    exponent = its * logarithm(base) + its2 * logarithm(second) + its3 * logarithm(third)
    return exponential(exponent)


in_kernels(power, _power)


@formula
def asperity_share(film_ratio: Real) -> Real:
    """Share of the load on asperities, exp(-1.8 Lambda^1.2). Theory (Y5), (J25). [1]

    S. Aihara, J. Tribol. 109 (1987) 471, for roller ends on a rib; for flanks an assumption. Any
    film ratio from 0 on gives a share between 1 and 0.

    Examples
    --------
    >>> asperity_share(np.array([0.0, 0.5, 1.0, 3.0])).round(3)
    array([1.   , 0.457, 0.165, 0.001])
    """
    share: Real = power(math.e, -1.8 * power(film_ratio, 1.2))
    return share


def pan_hamrock_minimum_film(u: Real, g: Real | float, w: Real) -> Real:
    """h_min/R_eq = 1.714 U^0.694 G^0.568 W^-0.128. Theory (C10).

    Pan and Hamrock, J. Tribol. 111 (1989) 246; Talbot (2012), p. 135. Smooth, isothermal, fully
    flooded line contacts in the elastic-piezoviscous regime.
    """
    film: Real = 1.714 * power(u, 0.694, g, 0.568, w, -0.128)
    return film


@formula
def pan_hamrock_central_film(u: Real, g: Real | float, w: Real) -> Real:
    """h_c/R_eq = 2.922 U^0.692 G^0.470 W^-0.166. Pan and Hamrock (1989), as above. Theory (C11)."""
    film: Real = 2.922 * power(u, 0.692, g, 0.470, w, -0.166)
    return film


@formula
def goksem_hargreaves_force(u: Real, g: float, w: Real, thermal_load: Real) -> Real:
    """Rolling force of one surface: F_r alpha/R_eq = 4.318 (G U)^0.658 W^0.0126 phi_T. Theory (R6).

    Goksem and Hargreaves, J. Lubr. Technol. 100 (1978) 346, in the form of Zhou and Hoeprich,
    J. Tribol. 113 (1991) 590; phi_T = 1/(1 + 0.29 L^0.78), L = mu beta u^2/k. Smooth, fully
    flooded contacts. [1]
    """
    inlet_heating = 1 / (1 + 0.29 * power(thermal_load, 0.78))
    force: Real = 4.318 * power(g * u, 0.658, w, 0.0126) * inlet_heating
    return force


LEAST_FILM_SHARE = 0.1
"""Least numerator of `inlet_film_factor`, which heavy load and strong heat bring below zero. [1]"""


@formula
def inlet_film_factor(thermal_load: Real, pressure: Real, slip: Real) -> Real:
    """phi_T, film over that without heat at its inlet. Theory (Y1). [1]

    (1 - 13.2 (p_h/E_eq) L^0.42)/(1 + 0.213 (1 + 2.23 S^0.83) L^0.64), L = mu beta u^2/k, S sliding
    over rolling speed. Gupta, Cheng, Zhu, Forster, Schrand, J. Tribol. 114 (1992) 55, second hand;
    in Zhou and Hoeprich, J. Tribol. 113 (1991) 590, read, as that of Zhu and Cheng.

    Examples
    --------
    >>> round(float(inlet_film_factor(2.0, 0.005, 0.5)), 4)
    0.5215
    """
    numerator = np.maximum(1 - 13.2 * pressure * power(thermal_load, 0.42), LEAST_FILM_SHARE)
    slipping = 1 + 2.23 * power(slip, 0.83)
    factor: Real = numerator / (1 + 0.213 * slipping * power(thermal_load, 0.64))
    return factor


LEAST_SPEED = 1e-100  # With which quotients of speeds are formed, at least.


@formula
def slide_to_roll_ratio(sliding: Real, rolling: Real) -> Real:
    """abs(u_s)/u_r. Theory (C4). [1]"""
    ratio: Real = np.abs(sliding) / np.maximum(rolling, LEAST_SPEED)
    return ratio


LEAST_FILM = 1e-40  # Of flanks that stand. [m]
LEAST_LOAD = 1e-40  # Of flanks that carry nothing [N/m]; pressures likewise [Pa].
MARTIN_FILM = 4.895  # h_0 W'/(mu u R) of rigid cylinders at constant viscosity, Martin (1916). [1]
MARTIN_FORCE = 2.0796
"""F_r/sqrt(mu u W') of rigid cylinders, by quadrature of Martin's pressure. [1]"""


@formula
def central_film(
    w: Real, r_eq: Real, speed: Real, slip: Real, e_eq: float, viscosity: float, alpha: float,
    thermal_load: Real,
) -> Real:  # fmt: skip
    """Film of smooth flanks, thinned by heat at the inlet. Theory (Y2), (Y9). [m]

    Under light load flanks stay rigid: H. M. Martin, Engineering 102 (1916) 119, 4.895 mu u_r R/W'.
    `slip` sliding over rolling speed, `thermal_load` as for `inlet_film_factor`; the others as for
    `hertz_pressure` and `martin_force`, `alpha` [1/Pa].
    """
    stiffness = e_eq * r_eq
    smooth = pan_hamrock_central_film(viscosity * speed / stiffness, alpha * e_eq, w / stiffness)
    heating = inlet_film_factor(thermal_load, hertz_pressure(w, r_eq, e_eq) / e_eq, slip)
    rigid = MARTIN_FILM * viscosity * speed * r_eq / np.maximum(w, LEAST_LOAD)
    film: Real = np.maximum(np.maximum(r_eq * heating * smooth, rigid), LEAST_FILM)
    return film


@formula
def flash_temperature(
    friction: Real,  # Coefficient of friction mu. [1]
    line_load: Real,  # W'. [N/m]
    sliding_speed: Real,  # u_s, of either sign. [m/s]
    speed1: Real,  # Speeds of the surfaces across the contact line, of either sign. [m/s]
    speed2: Real,  # Speeds of the surfaces across the contact line, of either sign. [m/s]
    half_width: Real,  # b of Hertz. [m]
    effusivity1: float,  # [W s^0.5/(m^2 K)]
    effusivity2: float,  # [W s^0.5/(m^2 K)]
) -> Real:
    """Largest rise of the surface temperature in a line contact above that of the bodies. [K]

    Theory (W2). H. Blok (1937), as in ISO/TS 6336-22, second hand: the heat mu W' |u_s| spread
    evenly over the width of Hertz, shared so that both surfaces are equally hot. The bodies are
    half-spaces that move fast: u b/kappa above about 10 for each, kappa its thermal diffusivity.
    Arguments are numbers or arrays, point by point; 0 without load or speed.

    Examples
    --------
    >>> rise = flash_temperature(0.05, 200e3, 3.0, 8.0, 5.0, 0.2e-3, 12.4e3, 12.4e3)
    >>> round(float(rise), 1)
    27.0
    """
    carried = effusivity1 * np.sqrt(np.abs(speed1)) + effusivity2 * np.sqrt(np.abs(speed2))
    heat = friction * line_load * np.abs(sliding_speed)
    rise: Real = _OF_BLOK * heat / np.maximum(carried * np.sqrt(half_width), TINY)
    return rise


_OF_BLOK = math.sqrt(2 / math.pi)  # Heat of a band over its mean temperature. [1]


@formula
def martin_force(w: Real, speed: Real, viscosity: float) -> Real:
    """Rolling force per length of one surface of rigid cylinders at constant viscosity. [N/m]

    Theory (R9). F_r = 2.080 sqrt(mu u W'), from the pressure of H. M. Martin, Engineering 102
    (1916) 119, with the film h_0 = 4.895 mu u R/W'. `w` line load [N/m], `speed` mean surface speed
    [m/s], `viscosity` [Pa s].
    """
    force: Real = MARTIN_FORCE * (viscosity * speed * w) ** 0.5
    return force


@kernel
def goksem_hargreaves_losses(
    line_load: FloatArray, radius: FloatArray, rolling: FloatArray, numbers: FloatArray
) -> FloatArray:
    """Rolling loss per length, 2 u_r F_r with the smaller force. Theory (R7), (R10). [W/m]

    Shapes (points, n), that of `radius` also (1, n); `numbers` of each point: E_eq [Pa], viscosity
    [Pa s], alpha [1/Pa], thermal load over the square of the speed [s^2/m^2].
    """
    found = np.empty_like(line_load)
    for row in range(len(line_load)):
        w, u, loss, R = line_load[row], rolling[row], found[row], radius[row % len(radius)]
        E, viscosity, alpha, thermal = numbers[row]
        for i in range(len(w)):
            stiffness = E * R[i]
            U, W = viscosity * u[i] / stiffness, w[i] / stiffness
            number = goksem_hargreaves_force(U, alpha * E, W, thermal * u[i] * u[i])
            rigid = martin_force(w[i], u[i], viscosity)
            loss[i] = 2.0 * np.minimum(number * R[i] / alpha, rigid) * u[i]
    return found


# Mean shear stress of an Eyring fluid under an elliptic pressure in an even film.

CUBIC_START, CUBIC_END = 0.7, 1.4
"""Where the cubic between the two slopes starts and ends, over the transition pressure."""
LARGEST_EXPONENT = 300.0
"""Largest exponent of the viscosity under pressure: what is larger is solid, and overflows."""
LEAST_LOGARITHM = 0.01
"""Stress from which its arsinh is a logarithm: 1 + x keeps 14 digits of x. [1]"""


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
def eyring_means(
    rate: FloatArray,  # Newtonian stress at ambient viscosity over the Eyring stress, (n,). [1]
    highest: FloatArray,  # Highest pressure, shape (n,). [Pa]
    slope: FloatArray,  # Slope of ln(mu) at ambient pressure, shape (n,). [1/Pa]
    slope_ratio: float,  # For two slopes: high over low. [1]
    transition: float,  # For two slopes: the pressure where they meet. [Pa]
    cosines: FloatArray,  # Cosines of the quadrature, shape (k,).
    weights: FloatArray,  # Weights of the quadrature, shape (k,).
) -> FloatArray:
    """Sum of the weighted arsinh(rate exp(ln mu)), shape (n,). Theory (O4). [1]"""
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
