"""Friction formulas fitted to EHL simulations of one fluid each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact import LineContacts
from epicyclic.kernels.mixed_ehl import sliding_friction_at
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.mixed_ehl_groups import TalbotRegression, held_in_table
from epicyclic.losses.pairing import equally_rough, pairing_ratio
from epicyclic.losses.validity import OF_THIS_PACKAGE, Range, RegressionFluid, held_in_range
from epicyclic.oilmodel.regressions import regression_groups
from epicyclic.units import (
    GIGAPASCAL,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    MILLIPASCAL_SECOND,
    NUMBER,
)

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MixedEhl(TalbotRegression):
    """Regression of 33,600 mixed-EHL simulations of an automatic transmission fluid.

    Talbot (2012), Eq. 5.8 and Table 5.2(a); branches in the film ratio blended, conditions
    outside Table 5.1 held at its limits (`mixed_ehl_groups`).
    """

    name: ClassVar = "mixed-ehl"
    title: ClassVar = "mixed-EHL friction regression"
    source: ClassVar = "D. C. Talbot, PhD dissertation, Ohio State (2012), Eq. 5.8"
    takes_oil_temperature: ClassVar[bool] = False

    def coefficient(self, contact: LineContacts) -> FloatArray:
        """See the class. [1]"""
        held = held_in_table(contact, oil_held=self.oil_held)
        return sliding_friction_at(*regression_groups(held))


@dataclass(frozen=True, slots=True)
class PairedFriction(TalbotRegression):
    """`MixedEhl` of two flanks as rough as the rougher one, times the effect of the smoother one.

    Theory (O13).
    """

    name: ClassVar = "mixed-ehl+pairing"
    title: ClassVar = "mixed-EHL friction regression, pairing of unequal flanks from the solver"
    source: ClassVar = f"{MixedEhl.source}; solver for line contacts of this package"
    takes_oil_temperature: ClassVar[bool] = False

    def coefficient(self, contact: LineContacts) -> FloatArray:
        """See the class. [1]"""
        published = MixedEhl(self.oil_held).coefficient(equally_rough(contact))
        coefficient: FloatArray = published * pairing_ratio("friction", contact)
        return coefficient


_SUCCESSOR = "none is in print; that of the later regression, Talbot (2012), Table 5.1"
_PRESSURE = Range("hertz_pressure", "Hertz pressure", 0.5, 2.5, GIGAPASCAL, _SUCCESSOR)
_SPEED = Range("rolling_speed", "rolling speed", 1.0, 20.0, METRE_PER_SECOND, _SUCCESSOR)
_RADIUS = Range("radius", "equivalent radius", 5.0, 40.0, MILLIMETRE, _SUCCESSOR)
_VISCOSITY = Range(
    "dynamic_viscosity",
    "dynamic viscosity",
    5.0,
    180.0,
    MILLIPASCAL_SECOND,
    "none is in print; a 75W-90 gear oil from 150 to 25 degC",
)
_ROUGHNESS = Range(
    "composite_roughness", "composite rms roughness", None, 1.0, MICROMETRE, OF_THIS_PACKAGE
)


class Xu2007:
    """Regression of EHL simulations of a 75W-90 gear oil, full film only.

    Theory (F6).

    Xu, Kahraman, Anderson and Maddock, J. Mech. Des. 129 (2007) 58: with p_h in GPa, u_r in m/s,
    dynamic viscosity in mPa s, composite rms roughness S in um, radius in m. The range of the
    regression was not found in print; conditions are held in the ranges assumed here, because
    exp(b9 exp(S)) and the powers run away.
    """

    name: ClassVar = "xu-2007"
    title: ClassVar = "EHL friction regression of Xu et al."
    source: ClassVar = "Xu, Kahraman, Anderson, Maddock, J. Mech. Des. 129 (2007) 58"
    made_for: ClassVar[RegressionFluid | None] = RegressionFluid("xu-2007", "a 75W-90 gear oil")
    takes_oil_temperature: ClassVar[bool] = False
    ranges: ClassVar[tuple[Range, ...]] = (
        _PRESSURE,
        _SPEED,
        _RADIUS,
        _VISCOSITY,
        _ROUGHNESS,
        Range("film_ratio", "film ratio", 1.0, None, NUMBER, "the regression is for full films"),
    )

    B: ClassVar = (
        -8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305,
    )  # fmt: skip
    SMALLEST_SLIDE_TO_ROLL: ClassVar = 1e-9

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        b1, b2, b3, b4, b5, b6, b7, b8, b9 = self.B
        pressure = held_in_range(contact.hertz_pressure, _PRESSURE) * 1e-9
        slip = np.maximum(contact.slide_to_roll_ratio, self.SMALLEST_SLIDE_TO_ROLL)
        viscosity = held_in_range(contact.dynamic_viscosity, _VISCOSITY) * 1e3
        roughness = held_in_range(contact.composite_roughness, _ROUGHNESS) * 1e6
        group = slip * pressure * np.log10(viscosity)
        f = b1 + b4 * group + b5 * np.exp(-group) + b9 * np.exp(roughness)
        mu: FloatArray = (
            np.exp(f)
            * pressure**b2
            * slip**b3
            * held_in_range(contact.rolling_speed, _SPEED) ** b6
            * viscosity**b7
            * held_in_range(contact.radius, _RADIUS) ** b8
        )
        return mu
