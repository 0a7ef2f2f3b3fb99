"""Line contacts of gear flanks and rollers, with the oil in them, for losses, fits and solver."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, Generic

import numpy as np

from epicyclic.arrays import FloatArray, between
from epicyclic.dataclass import dataclass, field
from epicyclic.kernels.line_contact import (
    LEAST_SPEED,
    Real,
    hertz_half_width,
    hertz_pressure,
    line_load_at_pressure,
    pan_hamrock_minimum_film,
    slide_to_roll_ratio,
)
from epicyclic.oil.oil import OilState

STEEL_EFFUSIVITY = 12.4e3
"""Of case-hardened steel, ISO/TS 6336-20: for contacts that do not say. [W s^0.5/(m^2 K)]"""
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
"""What a contact between given materials is determined by: the domain of a fit."""


@dataclass(frozen=True, slots=True)
class Flanks(Generic[Real]):
    """The two surfaces in contact: flanks of teeth, or race and roller."""

    pointwise = True

    equivalent_modulus: float  # E_eq. [Pa]
    roughness1: Real  # rms. [m]
    roughness2: Real  # rms. [m]
    # Of both bodies, which carry off the heat of sliding. [W s^0.5/(m^2 K)]
    effusivities: tuple[float, float] = (STEEL_EFFUSIVITY, STEEL_EFFUSIVITY)

    @property
    def reduced_roughness(self) -> Real:
        """Rq1 Rq2/(Rq1 + Rq2). Talbot (2012), p. 137. Theory (C13). [m]"""
        return self.roughness1 * self.roughness2 / (self.roughness1 + self.roughness2)


@dataclass(frozen=True, slots=True)
class InletOil:
    """As much of an `OilState` as contacts need, also with one value for each contact."""

    dynamic_viscosity: FloatArray  # [Pa s]
    pressure_viscosity: FloatArray  # alpha. [1/Pa]
    temperature: float = math.nan  # Not a number where it is not known. [K]


@dataclass(frozen=True, eq=False)
class LineContacts:
    """Line contacts, one for each entry of the arrays, all of shape (n,). Theory (O1)."""

    line_load: FloatArray  # W'. [N/m]
    radius: FloatArray  # Equivalent radius of curvature in the normal section. [m]
    rolling_speed: FloatArray  # u_r = (u1 + u2)/2. [m/s]
    sliding_speed: FloatArray  # u_s = u1 - u2. [m/s]
    flanks: Flanks[Any]  # The surfaces, alike for all contacts or with one roughness for each.
    oil: OilState | InletOil  # At the temperature of these contacts.

    if TYPE_CHECKING:  # what follows from them, by the names that ranges and fits have for it
        temperature: float = field(init=False)  # Of the oil at the contacts. [K]
        dynamic_viscosity: Any = field(init=False)  # Of the oil at the inlet. [Pa s]
        pressure_viscosity: Any = field(init=False)  # alpha. [1/Pa]
        material_number: Any = field(init=False)  # G = alpha E_eq. [1]
        roughness1: Any = field(init=False)  # rms. [m]
        roughness2: Any = field(init=False)  # rms. [m]
        roughness: tuple[Any, Any] = field(init=False)  # Both. [m]
        composite_roughness: Any = field(init=False)  # sqrt(Rq1^2 + Rq2^2). [m]

    def __post_init__(self) -> None:
        """Properties of oil and surfaces. Theory (C8), (C12)."""
        oil, flanks = self.oil, self.flanks
        vars(self).update(
            temperature=oil.temperature,
            dynamic_viscosity=oil.dynamic_viscosity,
            pressure_viscosity=oil.pressure_viscosity,
            material_number=oil.pressure_viscosity * flanks.equivalent_modulus,  # (C8)
            roughness1=flanks.roughness1,
            roughness2=flanks.roughness2,
            roughness=(flanks.roughness1, flanks.roughness2),
            composite_roughness=np.hypot(flanks.roughness1, flanks.roughness2),  # (C12)
        )

    @cached_property
    def hertz_pressure(self) -> FloatArray:
        """p_h. Theory (C6). [Pa]"""
        return hertz_pressure(self.line_load, self.radius, self.flanks.equivalent_modulus)

    @cached_property
    def hertz_half_width(self) -> FloatArray:
        """b_h. Theory (C5). [m]"""
        return hertz_half_width(self.line_load, self.radius, self.flanks.equivalent_modulus)

    @cached_property
    def speed_number(self) -> FloatArray:
        """U = u_r mu/(E_eq R_eq). Theory (C7). [1]"""
        stiffness = self.flanks.equivalent_modulus * self.radius
        number: FloatArray = self.rolling_speed * self.dynamic_viscosity / stiffness
        return number

    @cached_property
    def load_number(self) -> FloatArray:
        """W = W'/(E_eq R_eq). Theory (C9). [1]"""
        return self.line_load / (self.flanks.equivalent_modulus * self.radius)

    # Not kept: for all points of a block they would be a seventh of its memory.

    @property
    def slide_to_roll_ratio(self) -> FloatArray:
        """abs(u_s)/u_r. [1]"""
        return slide_to_roll_ratio(self.sliding_speed, self.rolling_speed)

    @property
    def surface_speeds(self) -> tuple[FloatArray, FloatArray]:
        """u_1 and u_2 across the contact. [m/s]"""
        half = self.sliding_speed / 2
        return self.rolling_speed + half, self.rolling_speed - half

    @property
    def moes_load(self) -> FloatArray:
        """M = W/sqrt(2 U), the load parameter of Moes. Theory (R8). [1]"""
        number: FloatArray = self.load_number / np.sqrt(
            2 * np.maximum(self.speed_number, LEAST_SPEED)
        )
        return number

    @cached_property
    def minimum_film(self) -> FloatArray:
        """h_min of the smooth contact (Pan and Hamrock). Theory (C10). [m]"""
        film: FloatArray = self.radius * pan_hamrock_minimum_film(
            self.speed_number, self.material_number, self.load_number
        )
        return film

    @cached_property
    def film_ratio(self) -> FloatArray:
        """Lambda = h_min/sqrt(Rq1^2 + Rq2^2). Theory (C14). [1]"""
        ratio: FloatArray = self.minimum_film / self.composite_roughness
        return ratio

    def conditions(self) -> dict[str, Any]:
        """The `CONDITIONS`, with the sign of the slip: which surface is faster."""
        values = {name: getattr(self, name) for name in CONDITIONS}
        ratio = np.copysign(self.slide_to_roll_ratio, self.sliding_speed)
        return values | {"slide_to_roll_ratio": ratio}

    def changed(self, **conditions: FloatArray) -> LineContacts:
        """The contacts with other values of some of the `CONDITIONS`, the others as they are."""
        values = self.conditions() | conditions
        return contacts_at(**values, equivalent_modulus=self.flanks.equivalent_modulus)

    def taken(self, index: Any) -> LineContacts:
        """Some of the contacts, each of which has a value of every condition."""
        return self.changed(**{name: value[index] for name, value in self.conditions().items()})

    def held(self, limits: Mapping[str, tuple[float | None, float | None]]) -> LineContacts:
        """With the conditions that have `limits` held within them. Theory (F5), (O2)."""
        held = {name: between(getattr(self, name), *pair) for name, pair in limits.items()}
        if "slide_to_roll_ratio" in held:
            held["slide_to_roll_ratio"] = np.copysign(
                held["slide_to_roll_ratio"], self.sliding_speed
            )
        return self.changed(**held)


def contacts_at(
    *,
    slide_to_roll_ratio: FloatArray,
    rolling_speed: FloatArray,
    radius: FloatArray,
    hertz_pressure: FloatArray,
    roughness1: FloatArray,
    roughness2: FloatArray,
    dynamic_viscosity: FloatArray,
    pressure_viscosity: FloatArray,
    equivalent_modulus: float,
) -> LineContacts:
    """Contacts under given `CONDITIONS`, SI. Theory (O1)."""
    return LineContacts(
        line_load=line_load_at_pressure(hertz_pressure, radius, equivalent_modulus),
        radius=radius,
        rolling_speed=rolling_speed,
        sliding_speed=slide_to_roll_ratio * np.maximum(rolling_speed, LEAST_SPEED),
        flanks=Flanks(equivalent_modulus, roughness1, roughness2),
        oil=InletOil(dynamic_viscosity, pressure_viscosity),
    )
