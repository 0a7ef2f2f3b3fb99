"""Friction formulas fitted to gear and disc tests, each held within the range of its tests."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.line_contact import hertz_pressure, line_load_at_pressure
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.friction.base import (
    mean_roughness_ra,
    pitch_point_pressure,
    pitch_point_radius,
    pitch_point_sum_speed,
    specific_load,
)
from epicyclic.losses.validity import OF_THIS_PACKAGE, Range, RegressionFluid, held_in_range
from epicyclic.units import GIGAPASCAL, METRE_PER_SECOND, MICROMETRE, NEWTON_PER_MM, NUMBER

FloatArray = NDArray[np.float64]

_NIEMANN = "Niemann and Winter, Maschinenelemente II"
_SPEED = Range("pitch_line_speed", "pitch-line speed", 1.0, 50.0, METRE_PER_SECOND, _NIEMANN)
_LOAD = Range(
    "specific_load", "load for each face width", 150.0, None, NEWTON_PER_MM, _NIEMANN, specific_load
)
_PRESSURE = Range(
    "pitch_point_pressure",
    "Hertz pressure at the pitch point",
    None,
    2.5,
    GIGAPASCAL,
    OF_THIS_PACKAGE,
    pitch_point_pressure,
)
_ROUGHNESS = Range(
    "mean_ra", "mean roughness Ra", None, 5.0, MICROMETRE, OF_THIS_PACKAGE, mean_roughness_ra
)
_GEAR_TESTS = (_SPEED, _LOAD, _PRESSURE)


def _mean_group(contact: MeshContact, load_factor: float = 1.0) -> float:
    """[K (F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 in N/mm, m/s, mm and mPa s, in its range.

    Theory (F19).
    """
    radius, e_eq = pitch_point_radius(contact), contact.flanks.equivalent_modulus
    load = held_in_range(load_factor * specific_load(contact), _LOAD)
    pressure = held_in_range(hertz_pressure(load, radius, e_eq), _PRESSURE)
    load = line_load_at_pressure(pressure, radius, e_eq)
    speed = contact.pitch_line_speed
    sum_speed = pitch_point_sum_speed(contact) * held_in_range(speed, _SPEED) / speed
    group = load * 1e-3 / (sum_speed * radius * 1e3)
    viscosity = contact.oil.dynamic_viscosity * 1e3
    return float(group**0.2 * viscosity**-0.05)


def _held_ra(contact: MeshContact) -> float:
    """Mean Ra of the flanks in its range. [um]"""
    return held_in_range(mean_roughness_ra(contact), _ROUGHNESS) * 1e6


def _relative_roughness(contact: MeshContact) -> float:
    """Ra/d1 in um/mm, as in the X_R of Niemann and Winter; d1 is that of the pinion."""
    pinion = min(contact.mesh.gear1.reference_radius, contact.mesh.gear2.reference_radius)
    return mean_roughness_ra(contact) * 1e6 / (2e3 * pinion)


def _mean_rms(contact: MeshContact) -> float:
    """Mean rms roughness of both flanks. [m]"""
    return (contact.flanks.roughness1 + contact.flanks.roughness2) / 2


class Schlenk:
    """mu = 0.048 [(F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 Ra^0.25 X_L, one value for the mesh.

    Theory (F15).

    N/mm, m/s, mm, mPa s, um; Ra the mean of both flanks. The standard's text was not read; the
    constants agree in several independent implementations.
    """

    name: ClassVar = "schlenk"
    title: ClassVar = "mean friction of ISO/TR 14179-2"
    source: ClassVar = "L. Schlenk, Diss. TU Muenchen (1994); ISO/TR 14179-2:2001"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = True
    ranges: ClassVar[tuple[Range, ...]] = (*_GEAR_TESTS, _ROUGHNESS)

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        rough = _held_ra(contact) ** 0.25
        mu = 0.048 * _mean_group(contact) * rough * contact.oil.lubricant_factor
        return np.full_like(contact.line_load, mu)


@dataclass(frozen=True, slots=True)
class NiemannWinter:
    """mu = 0.045 [K (F_bt/b)/(v_SigmaC rho_redC)]^0.2 eta^-0.05 X_R X_L, X_R = 3.8 (Ra/d1)^0.25.

    Theory (F16).

    N/mm, m/s, mm, mPa s, um; K = K_A K_gamma is `load_factor`. Standard formula from general
    knowledge, its text not read; X_R agrees with the form 2.2 (Ra/rho)^0.25 of DIN 3990-4.
    """

    name: ClassVar = "niemann-winter"
    title: ClassVar = "mean friction after Michaelis, Niemann and Winter"
    source: ClassVar = "K. Michaelis, Diss. TU Muenchen (1987); Niemann and Winter, vol. II"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = True
    RELATIVE_ROUGHNESS: ClassVar = Range(
        "relative_roughness",
        "Ra over reference diameter, um/mm",
        None,
        0.1,
        NUMBER,
        OF_THIS_PACKAGE,
        _relative_roughness,
    )

    load_factor: float = 1.0

    @property
    def ranges(self) -> tuple[Range, ...]:
        """Those of the tests, for the load with its factor."""
        factor = self.load_factor
        return (
            _SPEED,
            replace(_LOAD, of=lambda contact: factor * specific_load(contact)),
            replace(_PRESSURE, of=lambda contact: factor**0.5 * pitch_point_pressure(contact)),
            self.RELATIVE_ROUGHNESS,
        )

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        rough = held_in_range(_relative_roughness(contact), self.RELATIVE_ROUGHNESS)
        group = _mean_group(contact, self.load_factor)
        mu = 0.045 * group * 3.8 * rough**0.25 * contact.oil.lubricant_factor
        return np.full_like(contact.line_load, mu)


def _log_argument(contact: MeshContact) -> FloatArray:
    """29.66 w/(eta v_s v_r^2) of Benedict and Kelley, v_s at 1 % of v_r or above. [1]"""
    rolling = 2 * contact.rolling_speed
    sliding = np.maximum(np.abs(contact.sliding_speed), BenedictKelley.SMALLEST_SLIDING * rolling)
    viscosity = contact.oil.dynamic_viscosity * 1e3
    argument: FloatArray = 29.66 * contact.line_load / (viscosity * sliding * rolling**2)
    return argument


class BenedictKelley:
    """mu = 0.0127 [50/(50 - S)] log10[29.66 w/(eta v_s v_r^2)], local.

    Theory (F7).

    w in N/m, eta in mPa s, v_s and v_r = u1 + u2 in m/s, S rms roughness in microinches. The
    argument of the logarithm is held: below 10, with little load on much oil, it has no meaning;
    above 1e8 the friction of smooth flanks would exceed that of dry steel, 0.10. Near the pitch
    point v_s is kept at 1 % of v_r, because the formula grows without bound there.
    """

    name: ClassVar = "benedict-kelley"
    title: ClassVar = "local friction of Benedict and Kelley"
    source: ClassVar = "G. H. Benedict and B. W. Kelley, ASLE Trans. 4 (1961) 59"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = True

    SMALLEST_SLIDING: ClassVar = 0.01
    MICROINCH: ClassVar = 25.4e-9
    ARGUMENT: ClassVar = Range(
        "log_argument",
        "argument of the logarithm",
        10.0,
        1e8,
        NUMBER,
        OF_THIS_PACKAGE,
        _log_argument,
    )
    ROUGHNESS: ClassVar = Range(
        "mean_rms",
        "mean rms roughness",
        None,
        0.0254 * 100 / 3,
        MICROMETRE,
        "AGMA 925-A03: 50/(50 - S) at most 3",
        _mean_rms,
    )
    ranges: ClassVar[tuple[Range, ...]] = (ARGUMENT, ROUGHNESS)

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        rms = held_in_range(_mean_rms(contact), self.ROUGHNESS) / self.MICROINCH
        argument = held_in_range(_log_argument(contact), self.ARGUMENT)
        mu: FloatArray = 0.0127 * 50 / (50 - rms) * np.log10(argument)
        return mu
