"""Conditions of many line contacts, and the dimensionless groups of the fits."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.line_contact import line_load_at_pressure, pan_hamrock_minimum_film

__all__ = ["CONDITIONS", "ContactStates"]

FloatArray = NDArray[np.float64]

CONDITIONS = (
    "slide_to_roll_ratio",
    "rolling_speed",
    "radius",
    "hertz_pressure",
    "roughness1",
    "roughness2",
    "dynamic_viscosity",
    "pressure_viscosity",
)
"""Names of the arrays of `ContactStates`, which span the domain of a fit."""


@dataclass(frozen=True, eq=False)
class ContactStates:
    """Contacts, one for each entry of the arrays, all of shape (n,).

    Theory (O1).

    Attributes
    ----------
    slide_to_roll_ratio : ndarray
        |u_s|/u_r. [1]
    rolling_speed : ndarray
        u_r. [m/s]
    radius : ndarray
        R_eq. [m]
    hertz_pressure : ndarray
        p_h. [Pa]
    roughness1, roughness2 : ndarray
        Rq. [m]
    dynamic_viscosity : ndarray
        Of the oil at the inlet. [Pa s]
    pressure_viscosity : ndarray
        alpha. [1/Pa]
    equivalent_modulus : float
        E_eq. [Pa]
    """

    slide_to_roll_ratio: FloatArray
    rolling_speed: FloatArray
    radius: FloatArray
    hertz_pressure: FloatArray
    roughness1: FloatArray
    roughness2: FloatArray
    dynamic_viscosity: FloatArray
    pressure_viscosity: FloatArray
    equivalent_modulus: float

    def taken(self, index: Any) -> ContactStates:
        """Some of the contacts."""
        return replace(self, **{name: getattr(self, name)[index] for name in CONDITIONS})

    def held(self, limits: dict[str, tuple[float, float]]) -> ContactStates:
        """With every condition held within its limits. Theory (O2)."""
        return replace(
            self, **{name: np.clip(getattr(self, name), *pair) for name, pair in limits.items()}
        )

    @property
    def line_load(self) -> FloatArray:
        """W'. [N/m]"""
        return line_load_at_pressure(self.hertz_pressure, self.radius, self.equivalent_modulus)

    @property
    def sliding_speed(self) -> FloatArray:
        """|u_s|. [m/s]"""
        return self.slide_to_roll_ratio * self.rolling_speed

    @property
    def half_width(self) -> FloatArray:
        """b_h. [m]"""
        width: FloatArray = 2 * self.line_load / (math.pi * self.hertz_pressure)
        return width

    @cached_property
    def speed_number(self) -> FloatArray:
        """U. [1]"""
        number: FloatArray = (
            self.dynamic_viscosity * self.rolling_speed / (self.equivalent_modulus * self.radius)
        )
        return number

    @property
    def material_number(self) -> FloatArray:
        """G. [1]"""
        return self.pressure_viscosity * self.equivalent_modulus

    @property
    def load_number(self) -> FloatArray:
        """W. [1]"""
        number: FloatArray = self.line_load / (self.equivalent_modulus * self.radius)
        return number

    @property
    def pressure_number(self) -> FloatArray:
        """p = p_h/E_eq. [1]"""
        return self.hertz_pressure / self.equivalent_modulus

    @property
    def radius_number(self) -> FloatArray:
        """R = R_eq/b_h. [1]"""
        number: FloatArray = self.radius / self.half_width
        return number

    @property
    def composite_roughness(self) -> FloatArray:
        """sqrt(Rq1^2 + Rq2^2). [m]"""
        return np.hypot(self.roughness1, self.roughness2)

    @property
    def roughness(self) -> FloatArray:
        """Rq of both surfaces, shape (2, n). [m]"""
        return np.stack([self.roughness1, self.roughness2])

    @property
    def reduced_roughness(self) -> FloatArray:
        """Rq1 Rq2/(Rq1 + Rq2). [m]"""
        return self.roughness1 * self.roughness2 / (self.roughness1 + self.roughness2)

    @cached_property
    def film_ratio(self) -> FloatArray:
        """Lambda = h_min/sqrt(Rq1^2 + Rq2^2), h_min of Pan and Hamrock. [1]"""
        film = self.radius * pan_hamrock_minimum_film(
            self.speed_number, self.material_number, self.load_number
        )
        ratio: FloatArray = film / self.composite_roughness
        return ratio
