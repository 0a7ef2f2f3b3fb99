"""Fitted models where their contacts were simulated, a general formula beyond: what `auto` takes.

Beyond the simulations the weight of the fit falls smoothly, so that losses over speed, load or
temperature have no step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact import CONDITIONS, LineContacts
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.fitted import FittedFriction, FittedRolling
from epicyclic.losses.friction.base import FrictionModel
from epicyclic.losses.friction.classical import Schlenk
from epicyclic.losses.rolling import ROLLING_MODELS, RollingModel
from epicyclic.losses.validity import ModelUse, Range, RegressionFluid, ValidityFlag, check_contacts
from epicyclic.oilmodel.model import OilModel

FloatArray = NDArray[np.float64]
Fit = TypeVar("Fit", FittedFriction, FittedRolling)

REACH = 1.5
"""Factor beyond a limit of the simulations at which a fit has no weight left. [1]"""
MODULUS_SLACK = 1.1
"""Factor by which the equivalent modulus may differ from the simulated one: that of steels does
not, that of other materials does. [1]"""


NO_LEAST = "slide_to_roll_ratio"
"""The condition without a lower limit: where little slides, little is lost, and fits go on."""


def weight_of_fit(
    model: OilModel,
    quantity: str,  # A key of its fits.
    contacts: LineContacts,  # n of them.
) -> FloatArray:
    """Weight of a fit at each contact: 1 within its simulations, 0 far beyond them. [1]

    Theory (O11).

    Returns
    -------
    ndarray, shape (n,)
    """
    domain = model.fits[quantity].domain
    modulus = contacts.flanks.equivalent_modulus / model.equivalent_modulus
    beyond: float | FloatArray = max(1.0, modulus, 1 / modulus) / MODULUS_SLACK
    for name in CONDITIONS:  # numbers first take less time than arrays of one number each
        value = getattr(contacts, name)
        low, high = domain[name]
        if high > 0:
            beyond = np.maximum(beyond, value / high)
        if low > 0 and name != NO_LEAST:
            beyond = np.maximum(beyond, low / value)
    t = np.clip(np.log(beyond) / math.log(REACH), 0.0, 1.0)
    weight: FloatArray = 1 - t * t * (3 - 2 * t)
    return weight


@dataclass(frozen=True, slots=True)
class _FittedOrFormula(Generic[Fit]):
    """A fit to the contacts of an oil, and a formula beyond them. Theory (O11)."""

    made_for: ClassVar[RegressionFluid | None] = None
    beyond: ClassVar[FrictionModel | RollingModel]

    fitted: Fit

    @property
    def title(self) -> str:
        """Both methods."""
        return f"{self.fitted.title}, beyond them {self.beyond.title}"

    @property
    def source(self) -> str:
        """Source of both."""
        return f"{self.fitted.source}; {self.beyond.source}"

    @property
    def ranges(self) -> tuple[Range, ...]:
        """Where the fit holds."""
        return tuple(
            replace(item, low=None) if item.name == NO_LEAST else item
            for item in self.fitted.ranges
        )

    def weight(self, contact: LineContacts) -> FloatArray:
        """Weight of the fit at each contact. [1]"""
        return weight_of_fit(self.fitted.model, self.fitted.quantity, contact)

    def beyond_flags(
        self, role: str, contact: MeshContact, loss: FloatArray
    ) -> tuple[ValidityFlag, ...]:
        """What leaves the range of the formula where the formula is used."""
        rest = (1 - self.weight(contact)) * loss
        if not rest.any():
            return ()
        use = ModelUse(role, self.beyond.name, contact.mesh.name)
        part = float(rest.sum() / loss.sum())
        return check_contacts(use, self.beyond.ranges, contact, rest, part)


@dataclass(frozen=True, slots=True)
class FittedOrSchlenk(_FittedOrFormula[FittedFriction]):
    """The fit to the contacts of an oil, and the mean friction of Schlenk beyond them.

    Theory (O11).
    """

    name: ClassVar = "fitted-or-schlenk"
    takes_oil_temperature: ClassVar[bool] = False
    beyond: ClassVar = Schlenk()

    def coefficient(self, contact: MeshContact) -> FloatArray:
        """See the class. [1]"""
        weight, fitted = self.weight(contact), self.fitted.coefficient(contact)
        if (weight == 1).all():
            return fitted
        formula = self.beyond.coefficient(contact.seen_by(self.beyond))
        coefficient: FloatArray = weight * fitted + (1 - weight) * formula
        return coefficient


@dataclass(frozen=True, slots=True)
class FittedOrGoksem(_FittedOrFormula[FittedRolling]):
    """The fit to the contacts of an oil, and the loss of Goksem and Hargreaves beyond them.

    Theory (O11).
    """

    name: ClassVar = "fitted-or-goksem-hargreaves"
    beyond: ClassVar = ROLLING_MODELS["goksem-hargreaves"]

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """See the class. [W/m]"""
        weight, fitted = self.weight(contact), self.fitted.loss_density(contact)
        if (weight == 1).all():
            return fitted
        density: FloatArray = weight * fitted + (1 - weight) * self.beyond.loss_density(contact)
        return density
