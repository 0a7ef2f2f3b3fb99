"""Friction and rolling loss of an oil that was characterised: fits to its simulated contacts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact import LineContacts
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.fit_tables import RaceContacts, tabulated
from epicyclic.losses.mixed_ehl_groups import beyond_data
from epicyclic.losses.validity import Range, RegressionFluid
from epicyclic.oilmodel.model import OilModel
from epicyclic.units import (
    GIGAPASCAL,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    MILLIPASCAL_SECOND,
    NUMBER,
    PER_GIGAPASCAL,
    Quantity,
)

FloatArray = NDArray[np.float64]

_LABELS: dict[str, tuple[str, Quantity]] = {
    "slide_to_roll_ratio": ("slide-to-roll ratio", NUMBER),
    "rolling_speed": ("rolling speed", METRE_PER_SECOND),
    "radius": ("equivalent radius", MILLIMETRE),
    "hertz_pressure": ("Hertz pressure", GIGAPASCAL),
    "roughness1": ("rms roughness of surface 1", MICROMETRE),
    "roughness2": ("rms roughness of surface 2", MICROMETRE),
    "dynamic_viscosity": ("dynamic viscosity", MILLIPASCAL_SECOND),
    "pressure_viscosity": ("pressure-viscosity coefficient", PER_GIGAPASCAL),
}
"""Label and unit of each condition that spans a domain."""


@dataclass(frozen=True)
class _Fit:
    """What friction and rolling loss share that are fitted to the simulated contacts of one oil."""

    name: ClassVar = "fitted"
    title: ClassVar = "fit to simulated contacts of the oil"
    made_for: ClassVar[RegressionFluid | None] = None

    model: OilModel
    form: str
    quantity: str  # Which of the fits of the model.

    @property
    def source(self) -> str:
        """What was simulated."""
        simulated = self.model.simulations.get("simulated", 0)
        title, version = self.model.oil.title, self.model.version
        return f"{simulated} contacts of {title} simulated with epicyclic {version}"

    @cached_property
    def ranges(self) -> tuple[Range, ...]:
        """The domain of the fit."""
        return domain_ranges(self.model, self.quantity)

    def fitted(self, contact: LineContacts) -> FloatArray:
        """The quantity at every contact."""
        if isinstance(contact, MeshContact | RaceContacts):
            return tabulated(self.model, self.quantity, self.form, contact)
        return self.model.value(self.quantity, contact, self.form)


@dataclass(frozen=True)
class FittedFriction(_Fit):
    """Coefficients fitted to the simulated contacts of one oil.

    Theory (O9).
    """

    takes_oil_temperature: ClassVar[bool] = False

    quantity: str = "friction"

    def coefficient(self, contact: LineContacts) -> FloatArray:
        """See the class. [1]"""
        return self.fitted(contact)


@dataclass(frozen=True)
class FittedRolling(_Fit):
    """Rolling loss fitted to the simulated contacts of one oil.

    Theory (O9).

    Beyond the loads and speeds of the simulations the loss goes on as that of the regressions,
    Theory (R5).
    """

    # ``"rolling_loss"`` of gear teeth or ``"bearing_rolling_loss"``.
    quantity: str = "rolling_loss"

    def loss_density(self, contact: LineContacts) -> FloatArray:
        """See the class. [W/m]"""
        held = contact.held(self.model.fits[self.quantity].domain)
        return self.fitted(contact) * beyond_data(contact, held)


def domain_ranges(model: OilModel, quantity: str) -> tuple[Range, ...]:
    """The domain of a fit."""
    source = f"the simulations of {model.oil.name}"
    ranges = []
    for name, (label, unit) in _LABELS.items():
        limits = model.fits[quantity].domain[name]
        shown = (unit.to_display(value) if unit.si else value for value in limits)
        low, high = (float(f"{value:.4g}") for value in shown)
        ranges.append(Range(name, label, low, high, unit, source))
    return tuple(ranges)
