"""The dimensionless groups of Talbot's gear regressions, kept near the range they were made in.

Powers and exponentials of a regression run away outside its data: at a fifth of the lowest
simulated Hertz pressure Eq. 5.8 gives coefficients of friction above 1. The conditions are
therefore held at the limits of Table 5.1 widened by `MARGIN`; below the load held there, rolling
losses fall in proportion to the load. Every use outside Table 5.1 itself is flagged.
"""

from __future__ import annotations

from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.line_contact import line_load_at_pressure, pan_hamrock_minimum_film
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.validity import (
    CELSIUS,
    GIGAPASCAL,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    MILLIPASCAL_SECOND,
    NUMBER,
    Range,
)

__all__ = [
    "MARGIN",
    "TALBOT_GEAR_RANGES",
    "VISCOSITY_RANGE",
    "RegressionGroups",
    "held_in_range",
    "light_load_share",
    "regression_groups",
]

FloatArray = NDArray[np.float64]
Real = TypeVar("Real", float, FloatArray)

MARGIN = 2.0
"""Factor by which the formulas are followed beyond the range of their simulations. [1]"""

_SOURCE = "Talbot (2012), Table 5.1"
_PRESSURE = Range("hertz_pressure", "Hertz pressure", 0.5, 2.5, GIGAPASCAL, _SOURCE)
_RADIUS = Range("radius", "equivalent radius", 5.0, 40.0, MILLIMETRE, _SOURCE)
_SPEED = Range("rolling_speed", "rolling speed", 1.0, 20.0, METRE_PER_SECOND, _SOURCE)
VISCOSITY_RANGE = Range(
    "dynamic_viscosity", "dynamic viscosity", 4.9, 48.0, MILLIPASCAL_SECOND,
    "the fluid of Talbot (2012) at 100 and 25 degC",
)  # fmt: skip
"""Viscosities of the simulations: the fluid is that of `atf-talbot-2012`, Tables 3.1 and 5.1."""
_ROUGHNESS = Range("roughness", "rms roughness", 0.1, 0.7, MICROMETRE, _SOURCE)

TALBOT_GEAR_RANGES = (
    Range("temperature", "oil temperature", 25.0, 100.0, CELSIUS, _SOURCE),
    VISCOSITY_RANGE,
    _RADIUS,
    _ROUGHNESS,
    _PRESSURE,
    _SPEED,
    Range("slide_to_roll_ratio", "slide-to-roll ratio", 0.025, 1.0, NUMBER, _SOURCE),
)
"""Ranges of the 33,600 simulations behind Eq. 5.8 and 5.10."""


class RegressionGroups(NamedTuple):
    """Arguments of the kernels, shape (n,) each but for the material number."""

    slide_to_roll_ratio: FloatArray
    speed: FloatArray
    material: float
    pressure: FloatArray
    radius: FloatArray
    composite_roughness: FloatArray
    reduced_roughness: FloatArray
    film_ratio: FloatArray


def regression_groups(contact: MeshContact) -> RegressionGroups:
    """Groups of Eq. 5.8 and 5.10 at every point of `contact`. Theory (F5)."""
    flanks = contact.flanks
    e_eq = flanks.equivalent_modulus
    radius = held_in_range(contact.radius, _RADIUS)
    speed = held_in_range(contact.rolling_speed, _SPEED)
    rough1 = held_in_range(flanks.roughness1, _ROUGHNESS)
    rough2 = held_in_range(flanks.roughness2, _ROUGHNESS)
    pressure = held_in_range(contact.hertz_pressure, _PRESSURE)

    load = line_load_at_pressure(pressure, radius, e_eq)
    half_width = 2 * load / (np.pi * pressure)
    viscosity = held_in_range(contact.dynamic_viscosity, VISCOSITY_RANGE)
    speed_number = speed * viscosity / (e_eq * radius)
    composite = np.hypot(rough1, rough2) / radius
    film = pan_hamrock_minimum_film(speed_number, contact.material_number, load / (e_eq * radius))
    return RegressionGroups(
        slide_to_roll_ratio=contact.slide_to_roll_ratio,
        speed=speed_number,
        material=contact.material_number,
        pressure=pressure / e_eq,
        radius=radius / half_width,
        composite_roughness=composite,
        reduced_roughness=rough1 * rough2 / (rough1 + rough2) / radius,
        film_ratio=film / composite,
    )


def light_load_share(pressure: FloatArray, item: Range = _PRESSURE) -> FloatArray:
    """Line load over the line load held for it: below 1 where the contact is held at its limit.

    Theory (R5).
    """
    lowest = item.low / item.unit.to_display(1.0) / MARGIN
    share: FloatArray = np.minimum(1.0, pressure / lowest) ** 2
    return share


def held_in_range(value: Real, item: Range) -> Real:
    """`value` within the range of `item`, widened by `MARGIN`. Theory (F5)."""
    scale = 1 / item.unit.to_display(1.0)
    held: Real = np.clip(value, item.low * scale / MARGIN, item.high * scale * MARGIN)
    return held
