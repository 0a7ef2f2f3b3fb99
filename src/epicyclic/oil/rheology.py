"""How an oil thickens under pressure and thins under shear: the laws to choose from."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal

from epicyclic.dataclass import dataclass


@dataclass(frozen=True, slots=True)
class Barus:
    """mu = mu_0 exp(alpha p). Theory (H5)."""

    alpha: float  # [1/Pa]


@dataclass(frozen=True, slots=True)
class Roelands:
    """Roelands' law with the slope `alpha` at ambient pressure. Theory (H6)."""

    alpha: float  # [1/Pa]


@dataclass(frozen=True, slots=True)
class TwoSlope:
    """Slopes of ln(mu) at low and at high pressure, joined by a cubic. Theory (H7)."""

    alpha: float  # [1/Pa]
    alpha_high: float  # [1/Pa]
    transition: float  # Pressure at which the two straight lines meet. [Pa]


PressureLaw = Barus | Roelands | TwoSlope
PRESSURE_LAWS: Mapping[str, type[PressureLaw]] = {
    "roelands": Roelands,
    "barus": Barus,
    "two-slope": TwoSlope,
}


@dataclass(frozen=True, slots=True)
class Newtonian:
    """Stress in proportion to the shear rate."""


@dataclass(frozen=True, slots=True)
class ReeEyring:
    """tau = tau_0 arsinh(mu gamma/tau_0), tau_0 = stress + slope p. Theory (H17)."""

    stress: float  # [Pa]
    slope: float = 0.0  # [1]


@dataclass(frozen=True, slots=True)
class LimitingStress:
    """tau = tau_L [1 - exp(-mu gamma/tau_L)], tau_L = stress + slope p. Theory (H27)."""

    stress: float  # [Pa]
    slope: float  # Limiting stress-pressure coefficient. [1]


@dataclass(frozen=True, slots=True)
class Carreau:
    """tau = mu gamma [1 + (mu gamma/G)^2]^((n - 1)/2), G = stress. Theory (H28)."""

    stress: float  # [Pa]
    exponent: float  # n, 1 for a Newtonian oil. [1]


ShearLaw = Newtonian | ReeEyring | LimitingStress | Carreau
SHEAR_LAWS: Mapping[str, type[ShearLaw]] = {
    "ree-eyring": ReeEyring,
    "newtonian": Newtonian,
    "limiting-stress": LimitingStress,
    "carreau": Carreau,
}


@dataclass(frozen=True, slots=True)
class OilLaws:
    """How an oil behaves in a contact, but for viscosity and slope at ambient pressure."""

    pressure_law: type[PressureLaw]  # Barus, Roelands or TwoSlope.
    shear: ShearLaw
    second_slope: float | None = None  # For two slopes: the one at high pressure. [1/Pa]
    # For two slopes, without `second_slope`: it over the one at ambient pressure. [1]
    slope_ratio: float = math.nan
    transition: float = math.nan  # For two slopes: where they meet. [Pa]

    def pressure(self, alpha: float) -> PressureLaw:
        """The law for an oil of slope `alpha` at ambient pressure."""
        if issubclass(self.pressure_law, TwoSlope):
            second = self.second_slope or self.slope_ratio * alpha
            return self.pressure_law(alpha, second, self.transition)
        return self.pressure_law(alpha)


def shear_problems(law: ShearLaw) -> list[tuple[str, float, str]]:
    """Name, value and what is allowed of every constant of `law` that is out of its range."""
    found = []
    stress, exponent = getattr(law, "stress", 1.0), getattr(law, "exponent", 1.0)
    if not 0.0 < stress < math.inf:
        found.append(("stress", stress, "must be a finite number above zero."))
    if not 0.0 < exponent <= 1.0:
        found.append(("exponent", exponent, "must be in (0, 1]."))
    slope = getattr(law, "slope", 0.0)
    if not 0.0 <= slope < math.inf:
        found.append(("slope", slope, "must be zero or more."))
    return found


# What contacts are taken to be like where nobody has measured it: sets of assumptions by name.

SLOPE_RATIO = 0.41  # Slope of ln(mu) at high pressure over that at low pressure. [1]
TRANSITION = 0.38e9  # Pressure at which the two slopes meet. [Pa]


@dataclass(frozen=True, slots=True)
class Assumptions:
    """Inputs of rough contacts that are rarely known. Theory (H7), (H17), (H23)."""

    pressure_law: type[PressureLaw]  # Viscosity under pressure.
    eyring_stress: float  # [Pa]
    film: float  # Below which surfaces touch. [m]
    friction: float  # Where they touch. [1]


DEFAULT: Literal["usual"] = "usual"
PRESETS: Mapping[str, Assumptions] = {
    DEFAULT: Assumptions(TwoSlope, eyring_stress=5e6, film=40e-9, friction=0.12),
    "as-published": Assumptions(Roelands, eyring_stress=5e6, film=20e-9, friction=0.10),
}
"""``usual``: chosen with a comparison in sight, see the manual; ``as-published``: what stood here
before it, next to which the dissertation of Talbot (2012) prints nothing that says otherwise."""
