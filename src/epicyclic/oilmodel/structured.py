"""Forms with physical structure: smooth over all film ratios, and safe to continue beyond the data.

Friction is that of a sheared film and of the asperities that touch through it, rolling loss that
of a smooth contact times what the roughness adds. Both have few coefficients, each with a meaning,
and neither falls when the film becomes thinner. Both see the roughness of each surface: a polished
one keeps the ridges of the other from meeting any, and a rough surface that moves slower than the
oil touches more than one that moves faster.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact import LineContacts
from epicyclic.kernels.eyring_friction import eyring_means
from epicyclic.kernels.line_contact import pan_hamrock_central_film

FloatArray = NDArray[np.float64]

EYRING_STRESS = 5e6
"""Unit of the stress of the fit. [Pa]"""
SLOPE_RATIO, TRANSITION = 0.41, 0.38e9
"""The two slopes of the closed form are those of the default of the solver: slope at high over that
at low pressure [1], and where they meet [Pa]."""
LIGHT_LOAD = 0.6
"""M of Moes at which the pressure is half that of Hertz, found for smooth contacts. [1]"""
HALF_WIDTH = 0.2e-3
"""Unit of the half-width. [m]"""
TOUCHING = 40e-9
"""Unit of the film at which surfaces touch: that of the default of the solver. [m]"""
CORRELATION_LENGTH = 20e-6
"""Length over which roughness is alike, that of the simulations. [m]"""
SAME_MOTION = 0.1
"""Slide-to-roll ratio at which half of the effect of which surface is faster is there. [1]"""

FIT_TOLERANCE = 1e-5
"""Relative gain of a step in the sum of squares at which a fit ends: what the data do not tell
apart, such as size and exponent of a roughness that adds next to nothing, need not be found. [1]"""
TINY = 1e-12
"""Roughness of a smooth surface, which has a logarithm. [m]"""
SMALLEST_SLIP = 0.01
"""Added to the slide-to-roll ratio where it is raised to a power or has a logarithm. [1]"""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_COSINES = np.cos(math.pi / 4 * (_NODES + 1))
"""Pressure over the highest at the points of the quadrature over half a contact. [1]"""


@dataclass(frozen=True)
class Structured:
    """A form that is not linear in its coefficients."""

    name: str
    title: str
    labels: tuple[str, ...]  # What each coefficient is.
    start: tuple[float, ...]  # Where the fit begins, and its bounds, which keep the form monotone.
    low: tuple[float, ...]  # Where the fit begins, and its bounds, which keep the form monotone.
    high: tuple[float, ...]  # Where the fit begins, and its bounds, which keep the form monotone.
    # From conditions and coefficients to the quantity.
    function: Callable[[LineContacts, FloatArray], FloatArray]

    @property
    def size(self) -> int:
        """Number of coefficients."""
        return len(self.labels)

    def allows(self, coefficients: Sequence[float]) -> bool:
        """Whether coefficients are within the bounds of the fit."""
        return all(
            low <= value <= high
            for low, value, high in zip(self.low, coefficients, self.high, strict=True)
        )

    def value(self, states: LineContacts, coefficients: FloatArray) -> FloatArray:
        """The quantity at every contact, shape (n,)."""
        return self.function(states, coefficients)

    def fit(self, states: LineContacts, target: FloatArray, weight: FloatArray) -> FloatArray:
        """Coefficients by least squares of the logarithm.

        Raises
        ------
        ValueError
            If there are fewer contacts than coefficients, or nothing is found.
        """
        from scipy.optimize import least_squares

        if target.size <= self.size:
            raise ValueError("too few contacts")
        logarithm, root = np.log(target), np.sqrt(weight)

        def lack(coefficients: FloatArray) -> FloatArray:
            value = np.maximum(self.function(states, coefficients), np.finfo(float).tiny)
            residual: FloatArray = root * (np.log(value) - logarithm)
            return residual

        found = least_squares(
            lack, self.start, bounds=(self.low, self.high), x_scale="jac", ftol=FIT_TOLERANCE,
            max_nfev=400,
        )  # fmt: skip
        if not found.success:
            raise ValueError(f"no least squares: {found.message}")
        coefficients: FloatArray = found.x
        return coefficients


def eyring_friction(
    states: LineContacts,  # n of them.
    stress: float,  # tau_0. [Pa]
    light_load: float = LIGHT_LOAD,  # M of Moes at which the pressure is half that of Hertz. [1]
) -> FloatArray:
    """Friction of an Eyring fluid under the pressure of Hertz in an even film. Theory (O4). [1]"""
    film = states.radius * pan_hamrock_central_film(
        states.speed_number, states.material_number, states.load_number
    )
    rate = states.dynamic_viscosity * np.abs(states.sliding_speed) / (film * stress)
    highest = states.hertz_pressure / (1 + light_load / states.moes_load)
    slope = states.pressure_viscosity * np.ones(rate.shape)
    mean = eyring_means(rate, highest, slope, SLOPE_RATIO, TRANSITION, _COSINES, _WEIGHTS)
    friction: FloatArray = mean * stress / highest
    return friction


def _pairing(states: LineContacts) -> FloatArray:
    """Roughness of the smoother over that of the rougher surface, 1 without any. [1]"""
    one, two = states.roughness
    ratio: FloatArray = np.minimum(one, two) / np.maximum(np.maximum(one, two), TINY)
    return np.where(np.maximum(one, two) > 0, ratio, 1.0) + np.zeros(states.radius.shape)


def _faster(states: LineContacts) -> FloatArray:
    """ln of the roughness of the faster over that of the slower surface, less with less slip. [1]

    Theory (O12).
    """
    one, two = (np.maximum(roughness, TINY) for roughness in states.roughness)
    slip = states.slide_to_roll_ratio
    sense = np.sign(states.sliding_speed) * slip / (slip + SAME_MOTION)
    difference: FloatArray = np.log(one / two) * sense
    return difference


def _flattened(states: LineContacts) -> FloatArray:
    """The group by which a contact flattens its roughness, nabla. Theory (O14). [1]"""
    shortest = CORRELATION_LENGTH / states.hertz_half_width
    viscosity = states.material_number * (2 * states.speed_number) ** 0.25
    group: FloatArray = shortest * np.sqrt(states.moes_load**1.5 / viscosity)
    return group


def _friction(states: LineContacts, c: FloatArray) -> FloatArray:
    """A sheared film and, the more the thinner it is, touching asperities. Theory (O5). [1]"""
    stress, light, factor, flat, pairing, faster, steep, wide_part, touching, level = c[:10]
    dry, wide, slip = c[10:]
    film = math.exp(factor) * eyring_friction(
        states, EYRING_STRESS * math.exp(stress), math.exp(light)
    )
    composite = np.maximum(states.composite_roughness, TINY)
    roughness = (
        composite
        * _flattened(states) ** -flat
        * _pairing(states) ** pairing
        * np.exp(faster * _faster(states))
    )
    gap = (states.film_ratio * states.composite_roughness - touching * TOUCHING) / roughness
    width = math.exp(wide_part)
    odds = level - math.exp(steep) * width * np.arcsinh(gap / width)
    half_width = states.hertz_half_width / HALF_WIDTH
    asperities = dry * half_width**wide * (states.slide_to_roll_ratio + SMALLEST_SLIP) ** slip
    share = (1 + np.tanh(odds / 2)) / 2
    friction: FloatArray = film + np.maximum(asperities - film, 0.0) * share
    return friction


def _rolling(states: LineContacts, c: FloatArray) -> FloatArray:
    """A smooth contact, and what roughness adds. Theory (O7). [W/m]"""
    factor, speed, material, load, light, pairing, rough, thinness, slip, width, most, held = c
    smooth = (
        2 * states.rolling_speed * states.radius / states.pressure_viscosity
        * np.exp(factor)
        * (states.speed_number * 1e11) ** speed
        * (states.material_number / 3e3) ** material
        * (states.load_number * 1e4) ** load
        / (1 + math.exp(light) / states.moes_load)
    )  # fmt: skip
    thickness = states.film_ratio * _pairing(states) ** -pairing
    added = (
        math.exp(rough)
        * thickness**-thinness
        * (SMALLEST_SLIP + states.slide_to_roll_ratio) ** slip
        * (states.hertz_half_width / HALF_WIDTH) ** width
        / (1 + (math.exp(most) * thickness) ** (-held * thinness))
    )
    loss: FloatArray = smooth * (1 + added)
    return loss


STRUCTURED_FRICTION = Structured(
    name="structured",
    title="Eyring film, and asperities by film and flattened roughness",
    labels=(
        "ln of the Eyring stress over 5 MPa", "ln of the load number at half the pressure",
        "ln of the film's factor", "exponent of the flattening", "exponent of the pairing",
        "exponent of the faster roughness", "ln of the steepness of the shares",
        "ln of the range of even steepness", "film at which surfaces touch, over 40 nm",
        "ln of the odds of touching there", "friction where all is dry, at a half-width of 0.2 mm",
        "exponent of the half-width in it", "exponent of the slip in it",
    ),
    start=(0.2, -0.8, -0.2, 0.4, 0.2, 0.0, 2.0, 1.0, 0.75, 0.0, 0.06, -0.2, -0.1),
    low=(-3.0, -3.0, -2.0, 0.0, 0.0, -1.0, -3.0, -2.0, 0.0, -6.0, 0.0, -2.0, -1.0),
    high=(3.0, 2.0, 2.0, 2.0, 3.0, 1.0, 5.0, 4.0, 4.0, 8.0, 1.0, 2.0, 1.0),
    function=_friction,
)  # fmt: skip
STRUCTURED_ROLLING = Structured(
    name="structured",
    title="smooth contact and what roughness adds, by film ratio and pairing",
    labels=(
        "ln of the factor", "exponent of U", "exponent of G", "exponent of W",
        "ln of the load number at half the loss", "exponent of the pairing",
        "ln of what roughness adds", "exponent of the thinness", "exponent of the slip",
        "exponent of the half-width", "ln of one over the film ratio of half of that",
        "share of the thinness that is lost in thinner films",
    ),
    start=(-10.0, 0.75, 1.2, 0.05, -1.0, 0.1, 1.0, 1.5, 0.8, 0.8, 1.5, 0.5),
    low=(-30.0, 0.2, -1.0, -1.0, -6.0, 0.0, -20.0, 0.0, 0.0, -3.0, -3.0, 0.0),
    high=(10.0, 1.5, 3.0, 1.0, 4.0, 3.0, 12.0, 6.0, 2.0, 3.0, 9.0, 1.0),
    function=_rolling,
)  # fmt: skip
