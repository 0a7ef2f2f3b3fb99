"""Friction and rolling loss of an oil that was characterised: fits to its simulated contacts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
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

__all__ = ["FittedFriction", "FittedRolling", "domain_ranges"]

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


@dataclass(frozen=True, slots=True)
class FittedFriction:
    """Coefficients fitted to the simulated contacts of one oil.

    Theory (O9).
    """

    name: ClassVar = "fitted"
    title: ClassVar = "fit to simulated contacts of the oil"
    made_for: ClassVar[RegressionFluid | None] = None
    takes_oil_temperature: ClassVar[bool] = False
    quantity: ClassVar = "friction"

    model: OilModel
    form: str

    @property
    def source(self) -> str:
        """What was simulated."""
        return _source(self.model)

    @property
    def ranges(self) -> tuple[Range, ...]:
        """The domain of the fit."""
        return tuple(domain_ranges(self.model, self.quantity))

    def coefficient(self, contact: LineContacts) -> FloatArray:
        """See the class. [1]"""
        return _fitted(self, contact)


@dataclass(frozen=True, slots=True)
class FittedRolling:
    """Rolling loss fitted to the simulated contacts of one oil.

    Theory (O9).

    Beyond the loads and speeds of the simulations the loss goes on as that of the regressions,
    Theory (R5).

    Attributes
    ----------
    model : OilModel
    form : str
    quantity : str
        ``"rolling_loss"`` of gear teeth or ``"bearing_rolling_loss"``.
    """

    name: ClassVar = "fitted"
    title: ClassVar = "fit to simulated contacts of the oil"
    made_for: ClassVar[RegressionFluid | None] = None

    model: OilModel
    form: str
    quantity: str = "rolling_loss"

    @property
    def source(self) -> str:
        """What was simulated."""
        return _source(self.model)

    @property
    def ranges(self) -> tuple[Range, ...]:
        """The domain of the fit."""
        return tuple(domain_ranges(self.model, self.quantity))

    def loss_density(self, contact: LineContacts) -> FloatArray:
        """See the class. [W/m]"""
        held = contact.held(self.model.fits[self.quantity].domain)
        return _fitted(self, contact) * beyond_data(contact, held)


def _fitted(fit: FittedFriction | FittedRolling, contact: LineContacts) -> FloatArray:
    """The quantity of a fit at every contact."""
    if isinstance(contact, MeshContact | RaceContacts):
        return tabulated(fit.model, fit.quantity, fit.form, contact)
    return fit.model.value(fit.quantity, contact, fit.form)


def _source(model: OilModel) -> str:
    return (
        f"{model.simulations.get('simulated', 0)} contacts of {model.oil.title} simulated with "
        f"epicyclic {model.version}"
    )


def domain_ranges(model: OilModel, quantity: str) -> Iterator[Range]:
    """The domain of a fit."""
    source = f"the simulations of {model.oil.name}"
    for name, (label, unit) in _LABELS.items():
        limits = model.fits[quantity].domain[name]
        shown = (unit.to_display(value) if unit.si else value for value in limits)
        low, high = (float(f"{value:.4g}") for value in shown)
        yield Range(name, label, low, high, unit, source)
