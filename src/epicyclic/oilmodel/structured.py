"""Forms with physical structure: smooth over all film ratios, and safe to continue beyond the data.

Friction is that of a sheared film and of the asperities that touch through it, rolling loss that
of a smooth contact times what the roughness adds. Both have few coefficients, each with a meaning,
and neither falls when the film becomes thinner than the roughness.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact import LineContacts
from epicyclic.kernels.line_contact import pan_hamrock_central_film
from epicyclic.lubricant.properties import ROELANDS_OFFSET, ROELANDS_PRESSURE

__all__ = [
    "EYRING_STRESS",
    "STRUCTURED_FRICTION",
    "STRUCTURED_ROLLING",
    "Structured",
    "eyring_friction",
]

FloatArray = NDArray[np.float64]

EYRING_STRESS = 5e6
"""Unit of the stress of the fit. [Pa]"""
EFFUSIVITY = 12.9e3
"""sqrt(k rho c) of steel, 46 W/(m K), 7865 kg/m^3, 460 J/(kg K). [W s^0.5/(m^2 K)]"""
FLASH = 100.0
"""Unit of the temperature rise. [K]"""
LARGEST_EXPONENT = 300.0
"""Of the viscosity under pressure: what is larger is solid, and overflows."""

FIT_TOLERANCE = 1e-5
"""Relative gain of a step in the sum of squares at which a fit ends: what the data do not tell
apart, such as size and exponent of a roughness that adds next to nothing, need not be found. [1]"""
SMALLEST_SLIP = 0.01
"""Added to the slide-to-roll ratio where it is raised to a power. [1]"""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_ANGLES = math.pi / 4 * (_NODES + 1)
"""Angles of the quadrature over half a contact, x = b sin(angle)."""


@dataclass(frozen=True)
class Structured:
    """A form that is not linear in its coefficients.

    Attributes
    ----------
    name, title : str
    labels : tuple of str
        What each coefficient is.
    start, low, high : tuple of float
        Where the fit begins, and its bounds, which keep the form monotone.
    function : callable
        From conditions and coefficients to the quantity.
    """

    name: str
    title: str
    labels: tuple[str, ...]
    start: tuple[float, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]
    function: Callable[[LineContacts, FloatArray], FloatArray]

    @property
    def size(self) -> int:
        """Number of coefficients."""
        return len(self.labels)

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


def eyring_friction(states: LineContacts, stress: float) -> FloatArray:
    """Friction of an Eyring fluid under the pressure of Hertz in an even film. Theory (O4). [1]"""
    film = states.radius * pan_hamrock_central_film(
        states.speed_number, states.material_number, states.load_number
    )
    limit = np.log(states.dynamic_viscosity) + ROELANDS_OFFSET
    index = states.pressure_viscosity * ROELANDS_PRESSURE / limit
    rate = states.dynamic_viscosity * np.abs(states.sliding_speed) / (film * stress)
    total = np.zeros(states.radius.shape)
    for angle, weight in zip(_ANGLES, _WEIGHTS, strict=True):
        pressure = states.hertz_pressure * math.cos(angle)
        exponent = limit * ((1 + pressure / ROELANDS_PRESSURE) ** index - 1)
        viscosity = np.exp(np.minimum(exponent, LARGEST_EXPONENT))
        total += weight * math.cos(angle) * np.arcsinh(rate * viscosity)
    friction: FloatArray = total * stress / states.hertz_pressure
    return friction


def _flash(states: LineContacts, friction: FloatArray) -> FloatArray:
    """Temperature rise of the surfaces, over `FLASH`. Theory (O6). [1]"""
    flux = friction * math.pi / 4 * states.hertz_pressure * np.abs(states.sliding_speed)
    time = 2 * states.hertz_half_width / states.rolling_speed
    rise: FloatArray = flux * np.sqrt(time) / (2 * EFFUSIVITY * FLASH)
    return rise


def _friction(states: LineContacts, c: FloatArray) -> FloatArray:
    """A sheared film and, the more the thinner it is, touching asperities. Theory (O5). [1]"""
    stress, factor, heat, asperities, ratio, steepness, slip, pressure = c
    film = eyring_friction(states, EYRING_STRESS * math.exp(stress))
    film = math.exp(factor) * film / (1 + heat * _flash(states, film))
    even = math.exp(ratio) * (states.slide_to_roll_ratio + SMALLEST_SLIP) ** slip
    share = 1 / (1 + (states.film_ratio / even) ** steepness)
    friction: FloatArray = film + asperities * share * (states.hertz_pressure / 1e9) ** pressure
    return friction


def _rolling(states: LineContacts, c: FloatArray) -> FloatArray:
    """A smooth contact, and what roughness adds. Theory (O7). [W/m]"""
    factor, speed, material, load, rough, thinness, slip = c
    smooth = (
        2 * states.rolling_speed * states.radius / states.pressure_viscosity
        * np.exp(factor)
        * (states.speed_number * 1e11) ** speed
        * (states.material_number / 3e3) ** material
        * (states.load_number * 1e4) ** load
    )  # fmt: skip
    added = math.exp(rough) * states.film_ratio**-thinness
    loss: FloatArray = smooth * (1 + added * (SMALLEST_SLIP + states.slide_to_roll_ratio) ** slip)
    return loss


STRUCTURED_FRICTION = Structured(
    name="structured",
    title="Eyring film, and asperities by the film ratio",
    labels=(
        "ln of the Eyring stress over 5 MPa", "ln of the film's factor", "softening by heat",
        "friction of asperities at 1 GPa", "ln of the film ratio of even shares",
        "steepness of the shares", "exponent of the slip in that ratio",
        "exponent of the pressure in the friction of asperities",
    ),
    start=(0.0, 0.0, 0.1, 0.1, -1.0, 1.5, 0.0, 0.0),
    low=(-4.0, -3.0, 0.0, 0.0, -8.0, 0.2, -1.0, -3.0),
    high=(4.0, 3.0, 50.0, 0.5, 3.0, 8.0, 1.0, 3.0),
    function=_friction,
)  # fmt: skip
STRUCTURED_ROLLING = Structured(
    name="structured",
    title="smooth contact and what roughness adds",
    labels=(
        "ln of the factor", "exponent of U", "exponent of G", "exponent of W",
        "ln of what roughness adds", "exponent of the thinness", "exponent of the slip",
    ),
    start=(-9.0, 0.66, 0.66, 0.01, -3.0, 1.0, 0.0),
    low=(-30.0, 0.2, -1.0, -1.0, -20.0, 0.0, 0.0),
    high=(10.0, 1.5, 3.0, 1.0, 8.0, 6.0, 2.0),
    function=_rolling,
)  # fmt: skip
