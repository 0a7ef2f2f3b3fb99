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

__all__ = ["FittedFriction", "FittedRolling", "contact_states"]

FloatArray = NDArray[np.float64]

_QUANTITIES: dict[str, tuple[str, str, Quantity]] = {
    "slide_to_roll_ratio": ("slide_to_roll_ratio", "slide-to-roll ratio", NUMBER),
    "rolling_speed": ("rolling_speed", "rolling speed", METRE_PER_SECOND),
    "radius": ("radius", "equivalent radius", MILLIMETRE),
    "hertz_pressure": ("hertz_pressure", "Hertz pressure", GIGAPASCAL),
    "roughness1": ("roughness", "rms roughness", MICROMETRE),
    "viscosity": ("dynamic_viscosity", "dynamic viscosity", MILLIPASCAL_SECOND),
    "pressure_viscosity": (
        "pressure_viscosity", "pressure-viscosity coefficient", PER_GIGAPASCAL,
    ),
}  # fmt: skip
"""Attribute of `MeshContact`, label and unit of each condition that spans a domain."""


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
        return tuple(_ranges(self.model, self.QUANTITY))

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        return self.model.value(self.QUANTITY, contact_states(contact), self.form)


@dataclass(frozen=True, slots=True)
class FittedRolling:
    """Rolling loss fitted to the simulated contacts of one oil.

    Theory (O9).

    Beyond the loads and speeds of the simulations the loss goes on as that of the regressions,
    Theory (R5).
    """

    name: ClassVar = "fitted"
    title: ClassVar = "fit to simulated contacts of the oil"
    made_for: ClassVar[RegressionFluid | None] = None
    QUANTITY: ClassVar = "rolling_loss"

    model: OilModel
    form: str

    @property
    def source(self) -> str:
        """What was simulated."""
        return _source(self.model)

    @property
    def ranges(self) -> tuple[Range, ...]:
        """The domain of the fit."""
        return tuple(_ranges(self.model, self.QUANTITY))

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """See the class. [W/m]"""
        states = contact_states(contact)
        held = states.held(self.model.fits[self.QUANTITY].domain)
        density: FloatArray = self.model.value(self.QUANTITY, states, self.form) * beyond_data(
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
        viscosity=contact.dynamic_viscosity * ones,
        pressure_viscosity=contact.pressure_viscosity * ones,
        equivalent_modulus=contact.flanks.equivalent_modulus,
    )


def _source(model: OilModel) -> str:
    return (
        f"{model.simulations.get('simulated', 0)} contacts of {model.oil.title} simulated with "
        f"epicyclic {model.version}"
    )


def _ranges(model: OilModel, quantity: str) -> Iterator[Range]:
    """The domain of a fit; both flanks share one range of roughness."""
    domain = dict(model.fits[quantity].domain)
    pairs = [domain["roughness1"], domain["roughness2"]]
    domain["roughness1"] = (min(low for low, _ in pairs), max(high for _, high in pairs))
    for name, (attribute, label, unit) in _QUANTITIES.items():
        low, high = (unit.to_display(value) if unit.si else value for value in domain[name])
        yield Range(attribute, label, low, high, unit, f"the simulations of {model.oil.name}")
