"""What contacts are taken to be like where nobody has measured it: sets of assumptions by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from epicyclic.ehl.rheology import PressureLaw, Roelands, TwoSlope

SLOPE_RATIO = 0.41
"""Slope of ln(mu) at high pressure over that at low pressure. [1]"""
TRANSITION = 0.38e9
"""Pressure at which the two slopes meet. [Pa]"""


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
