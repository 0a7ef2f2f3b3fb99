"""Friction formulas fitted to EHL simulations of one fluid each."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.mixed_ehl import sliding_friction_at
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.mixed_ehl_groups import TALBOT_GEAR_RANGES, regression_groups
from epicyclic.losses.validity import MICROMETRE, Range

__all__ = ["MixedEhl", "Xu2007"]

FloatArray = NDArray[np.float64]


class MixedEhl:
    """Regression of 33,600 mixed-EHL simulations of an automatic transmission fluid.

    Talbot (2012), Eq. 5.8 and Table 5.2(a); branches in the film ratio blended, conditions far
    outside Table 5.1 held at its widened limits (`mixed_ehl_groups`).
    """

    title: ClassVar = "mixed-EHL friction regression"
    source: ClassVar = "D. C. Talbot, PhD dissertation, Ohio State (2012), Eq. 5.8"
    ranges: ClassVar[tuple[Range, ...]] = TALBOT_GEAR_RANGES

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        return sliding_friction_at(*regression_groups(contact))


class Xu2007:
    """Regression of EHL simulations of a 75W-90 gear oil, full film only.

    Theory (F6).

    Xu, Kahraman, Anderson and Maddock, J. Mech. Des. 129 (2007) 58: with p_h in GPa, u_r in m/s,
    dynamic viscosity in mPa s, composite rms roughness S in um, radius in m. The range of the
    regression was not found in print; exp(b9 exp(S)) runs away on rough flanks, so that S is held
    at `LARGEST_ROUGHNESS`, which is flagged.
    """

    title: ClassVar = "EHL friction regression of Xu et al."
    source: ClassVar = "Xu, Kahraman, Anderson, Maddock, J. Mech. Des. 129 (2007) 58"
    LARGEST_ROUGHNESS: ClassVar = 1e-6
    """Composite rms roughness up to which the formula is followed. [m]"""
    ranges: ClassVar[tuple[Range, ...]] = (
        Range(
            "composite_roughness",
            "composite rms roughness",
            0.0,
            LARGEST_ROUGHNESS * 1e6,
            MICROMETRE,
            "limit of this package; none is in print",
        ),
    )

    B: ClassVar = (
        -8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305,
    )  # fmt: skip
    SMALLEST_SLIDE_TO_ROLL: ClassVar = 1e-9

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        b1, b2, b3, b4, b5, b6, b7, b8, b9 = self.B
        pressure = contact.hertz_pressure * 1e-9
        slip = np.maximum(contact.slide_to_roll_ratio, self.SMALLEST_SLIDE_TO_ROLL)
        viscosity = contact.oil.dynamic_viscosity * 1e3
        roughness = min(contact.flanks.composite_roughness, self.LARGEST_ROUGHNESS) * 1e6
        group = slip * pressure * np.log10(viscosity)
        f = b1 + b4 * group + b5 * np.exp(-group) + b9 * np.exp(roughness)
        mu: FloatArray = (
            np.exp(f)
            * pressure**b2
            * slip**b3
            * contact.rolling_speed**b6
            * viscosity**b7
            * contact.radius**b8
        )
        return mu
