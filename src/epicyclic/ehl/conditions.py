"""What a line contact and the oil in it are given by, and the scales that follow."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from epicyclic.contact import LineContacts
from epicyclic.ehl.rheology import (
    Carreau,
    LimitingStress,
    Newtonian,
    OilLaws,
    PressureLaw,
    ReeEyring,
    Roelands,
    ShearLaw,
    TwoSlope,
    shear_problems,
)
from epicyclic.errors import InputError, Problem
from epicyclic.kernels.ehl_fluid import (
    BARUS,
    CARREAU,
    EYRING,
    LIMITING,
    NEWTONIAN,
    ROELANDS,
    TWO_SLOPE,
    ScaledFluid,
)
from epicyclic.kernels.line_contact import hertz_half_width, hertz_pressure
from epicyclic.lubricant.properties import ROELANDS_OFFSET, ROELANDS_PRESSURE, OilState

STIFFENING, PACKING = 1.34 / 5.9e8, 1.0 / 5.9e8
"""Constants of Dowson and Higginson's density. [1/Pa]"""


SHEAR_CODES: dict[type[ShearLaw], int] = {
    Newtonian: NEWTONIAN,
    ReeEyring: EYRING,
    LimitingStress: LIMITING,
    Carreau: CARREAU,
}


@dataclass(frozen=True, slots=True)
class ContactOil:
    """Oil in a contact, at one temperature."""

    viscosity: float  # Dynamic viscosity at ambient pressure. [Pa s]
    pressure_law: PressureLaw
    # tau_0 of the Ree-Eyring law; infinite for a Newtonian oil. [Pa]
    eyring_stress: float = math.inf
    compressible: bool = True  # Density after Dowson and Higginson, or constant.
    shear_law: ShearLaw | None = None  # Instead of the Ree-Eyring law of `eyring_stress`.

    @property
    def shear(self) -> ShearLaw:
        """The law of shear that holds."""
        if self.shear_law is not None:
            return self.shear_law
        return Newtonian() if math.isinf(self.eyring_stress) else ReeEyring(self.eyring_stress)

    @property
    def roelands_index(self) -> float:
        """z = alpha 1.96e8/(ln mu_0 + 9.67). Theory (H6). [1]"""
        return (
            self.pressure_law.alpha
            * ROELANDS_PRESSURE
            / (math.log(self.viscosity) + ROELANDS_OFFSET)
        )


def contact_oil(oil: OilState, laws: OilLaws) -> ContactOil:
    """An oil at the temperature of a contact, and how it behaves there."""
    pressure_law = laws.pressure(oil.pressure_viscosity)
    return ContactOil(oil.dynamic_viscosity, pressure_law, shear_law=laws.shear)


@dataclass(frozen=True)
class LineContact:
    """Load, geometry and surface speeds of one line contact, as the solver wants them."""

    line_load: float  # W', per length. [N/m]
    radius: float  # R_eq. [m]
    equivalent_modulus: float  # E_eq. [Pa]
    speed1: float  # Speeds of the surfaces through the contact, both in the direction of x. [m/s]
    speed2: float  # Speeds of the surfaces through the contact, both in the direction of x. [m/s]
    oil: ContactOil

    def __post_init__(self) -> None:
        problems = [
            Problem(name, f"{value:g}", "must be a finite number above zero.", "Change it.")
            for name, value in (
                ("line_load", self.line_load),
                ("radius", self.radius),
                ("equivalent_modulus", self.equivalent_modulus),
                ("speed1 + speed2", self.speed1 + self.speed2),
                ("oil.viscosity", self.oil.viscosity),
                ("oil.pressure_law.alpha", self.oil.pressure_law.alpha),
            )
            if not (value > 0 and math.isfinite(value))
        ]
        if not self.oil.eyring_stress > 0:
            value = f"{self.oil.eyring_stress:g}"
            problems.append(
                Problem("oil.eyring_stress", value, "must be above zero.", "Use inf for none.")
            )
        problems += [
            Problem(f"oil.shear_law.{name}", f"{value:g}", allowed, "Change it.")
            for name, value, allowed in shear_problems(self.oil.shear)
            if self.oil.shear_law is not None
        ]
        if problems:
            raise InputError(problems, "the contact")

    @property
    def rolling_speed(self) -> float:
        """u_r, the mean of both. [m/s]"""
        return (self.speed1 + self.speed2) / 2

    @property
    def sliding_speed(self) -> float:
        """u_s = u_1 - u_2. [m/s]"""
        return self.speed1 - self.speed2

    @cached_property
    def half_width(self) -> float:
        """b_h of Hertz. [m]"""
        return hertz_half_width(self.line_load, self.radius, self.equivalent_modulus)

    @cached_property
    def hertz_pressure(self) -> float:
        """p_h. [Pa]"""
        return hertz_pressure(self.line_load, self.radius, self.equivalent_modulus)

    @property
    def film_scale(self) -> float:
        """b^2/R, the unit of H. Theory (H1). [m]"""
        return self.half_width**2 / self.radius

    @property
    def moes_load(self) -> float:
        """M = W (2U)^-1/2. Theory (H3). [1]"""
        return self._load_number / math.sqrt(2 * self._speed_number)

    @property
    def moes_material(self) -> float:
        """L = G (2U)^1/4. Theory (H3). [1]"""
        return (
            self.oil.pressure_law.alpha
            * self.equivalent_modulus
            * math.pow(2 * self._speed_number, 0.25)
        )

    @property
    def _load_number(self) -> float:
        return self.line_load / (self.equivalent_modulus * self.radius)

    @property
    def _speed_number(self) -> float:
        return self.oil.viscosity * self.rolling_speed / (self.equivalent_modulus * self.radius)

    def scaled_fluid(self, easing: float = 1.0) -> ScaledFluid:
        """The oil in the units of this contact, its flow under pressure eased. Theory (H2)."""
        oil, p_h = self.oil, self.hertz_pressure
        law = oil.pressure_law
        code, second, third = BARUS, 0.0, 0.0
        if isinstance(law, Roelands):
            code, second, third = ROELANDS, p_h / ROELANDS_PRESSURE, oil.roelands_index
        elif isinstance(law, TwoSlope):
            code, second, third = TWO_SLOPE, law.alpha_high * p_h, law.transition / p_h
        wedge = 12 * oil.viscosity * self.rolling_speed * self.radius**2
        return ScaledFluid(
            law=code,
            slope=law.alpha * p_h,
            second=second,
            third=third,
            stiffening=STIFFENING * p_h if oil.compressible else 0.0,
            packing=PACKING * p_h if oil.compressible else 0.0,
            poiseuille=easing * self.half_width**3 * p_h / wedge,
            sliding=oil.viscosity * abs(self.sliding_speed) / (p_h * self.film_scale),
            shear_law=SHEAR_CODES[type(oil.shear)],
            stress=getattr(oil.shear, "stress", math.inf) / p_h,
            stress_slope=getattr(oil.shear, "slope", 0.0),
            exponent=getattr(oil.shear, "exponent", 1.0),
        )


def line_contact(contacts: LineContacts, index: int, oil: ContactOil) -> LineContact:
    """One of many contacts."""
    rolling, sliding = (
        float(speed[index]) for speed in (contacts.rolling_speed, contacts.sliding_speed)
    )
    return LineContact(
        line_load=float(contacts.line_load[index]),
        radius=float(contacts.radius[index]),
        equivalent_modulus=contacts.flanks.equivalent_modulus,
        speed1=rolling + sliding / 2,
        speed2=rolling - sliding / 2,
        oil=oil,
    )
