"""Friction and rolling loss of an oil that was characterised: fits to its simulated contacts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.losses.contact import MeshContact
from epicyclic.losses.mixed_ehl_groups import beyond_data
from epicyclic.losses.validity import Range, RegressionFluid
from epicyclic.oilmodel.model import OilModel
from epicyclic.oilmodel.states import ContactStates
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

__all__ = ["FittedFriction", "FittedRolling", "contact_states", "domain_ranges"]

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
_OF = {"roughness1": lambda of: of.roughness[0], "roughness2": lambda of: of.roughness[1]}
"""How to find conditions that the points of a mesh have under another name."""


@dataclass(frozen=True, slots=True)
class FittedFriction:
    """Coefficients fitted to the simulated contacts of one oil.

    Theory (O9).
    """

    name: ClassVar = "fitted"
    title: ClassVar = "fit to simulated contacts of the oil"
    made_for: ClassVar[RegressionFluid | None] = None
    QUANTITY: ClassVar = "friction"

    model: OilModel
    form: str

    @property
    def source(self) -> str:
        """What was simulated."""
        return _source(self.model)

    @property
    def ranges(self) -> tuple[Range, ...]:
        """The domain of the fit."""
        return tuple(domain_ranges(self.model, self.QUANTITY))

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        return self.model.value(self.QUANTITY, contact_states(contact), self.form)


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

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """See the class. [W/m]"""
        return self.density(contact_states(contact))

    def density(self, states: ContactStates) -> FloatArray:
        """See the class. [W/m]"""
        held = states.held(self.model.fits[self.quantity].domain)
        density: FloatArray = self.model.value(self.quantity, states, self.form) * beyond_data(
            states.line_load, held.line_load, states.rolling_speed, held.rolling_speed
        )
        return density


def contact_states(contact: MeshContact) -> ContactStates:
    """The points of a mesh as states of contacts."""
    ones = np.ones(contact.line_load.shape)
    return ContactStates(
        slide_to_roll_ratio=contact.slide_to_roll_ratio,
        rolling_speed=contact.rolling_speed,
        radius=contact.radius,
        hertz_pressure=contact.hertz_pressure,
        roughness1=contact.flanks.roughness1 * ones,
        roughness2=contact.flanks.roughness2 * ones,
        dynamic_viscosity=contact.dynamic_viscosity * ones,
        pressure_viscosity=contact.pressure_viscosity * ones,
        equivalent_modulus=contact.flanks.equivalent_modulus,
    )


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
        low, high = (unit.to_display(value) if unit.si else value for value in limits)
        yield Range(name, label, low, high, unit, source, _OF.get(name))
