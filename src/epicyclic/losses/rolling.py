"""Rolling loss per contact length of a mesh: a new model is a function with an entry below."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact.fitted_models import regression_groups, rolling_scale
from epicyclic.contact.line_contact import LineContacts
from epicyclic.kernels.line_contact import goksem_hargreaves_force, martin_force
from epicyclic.kernels.mixed_ehl import rolling_loss_number_at
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.friction import (
    REGRESSION_SOURCE,
    TALBOT_FLUID,
    TALBOT_GEAR_RANGES,
    beyond_data,
    equally_rough,
    held_in_table,
    pairing_ratio,
)
from epicyclic.losses.ranges import Formula, LossModel, Range
from epicyclic.units import NUMBER

FloatArray = NDArray[np.float64]


class RollingModel(LossModel, Protocol):
    """A way to the rolling loss per contact length."""

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """Rolling loss per contact length at each point, shape (n,). [W/m]"""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class RollingFormula(Formula):
    """A formula for the rolling loss."""

    # From the contacts, and whether conditions of the oil are held where a regression was made.
    function: Callable[[Any, bool], FloatArray]
    oil_held: bool = True

    def loss_density(self, contact: LineContacts) -> FloatArray:
        """Rolling loss per contact length at each point, shape (n,). [W/m]"""
        return self.function(contact, self.oil_held)


def mixed_ehl_rolling(contact: LineContacts, oil_held: bool) -> FloatArray:
    """Regression of 33,600 mixed-EHL simulations of an automatic transmission fluid. [W/m]

    Theory (R5). Talbot (2012), Eq. 5.10 and Table 5.2(b), in the scale of `rolling_scale`.
    """
    held = held_in_table(contact, oil_held=oil_held)
    number = rolling_loss_number_at(*regression_groups(held))
    return number * rolling_scale(held) * beyond_data(contact, held)


def paired_rolling(contact: LineContacts, oil_held: bool) -> FloatArray:
    """`mixed_ehl_rolling` of two flanks as rough as the rougher one, times the effect of the other.

    Theory (O13).
    """
    published = mixed_ehl_rolling(equally_rough(contact), oil_held)
    return published * pairing_ratio("rolling_loss", contact)


def goksem_hargreaves(contact: MeshContact, oil_held: bool) -> FloatArray:
    """Rolling force of both surfaces of a smooth, fully flooded contact, times u_r. [W/m]

    Theory (R7), (R10). The formula belongs to elastic contacts, and its force does not vanish with
    the load. That of rigid cylinders and an oil of constant viscosity does; where it is smaller, it
    takes over.
    """
    oil = contact.oil
    heating = (
        oil.dynamic_viscosity
        * oil.thermoviscosity
        * contact.rolling_speed**2
        / oil.thermal_conductivity
    )
    number = goksem_hargreaves_force(
        contact.speed_number, contact.material_number, contact.load_number, heating
    )
    elastic = number * contact.radius / oil.pressure_viscosity
    rigid = martin_force(contact.line_load, contact.rolling_speed, oil.dynamic_viscosity)
    return 2 * np.minimum(elastic, rigid) * contact.rolling_speed


ROLLING_MODELS = {
    model.name: model
    for model in (
        RollingFormula(
            name="mixed-ehl",
            title="mixed-EHL rolling-loss regression",
            source=f"{REGRESSION_SOURCE}, Eq. 5.10",
            reliability="its scale is a reconstruction, right within a factor of about 2 against "
            "smooth contacts (R4)",
            function=mixed_ehl_rolling,
            ranges=TALBOT_GEAR_RANGES,
            made_for=TALBOT_FLUID,
        ),
        RollingFormula(
            name="mixed-ehl+pairing",
            title="mixed-EHL rolling-loss regression, pairing of unequal flanks from the solver",
            source=f"{REGRESSION_SOURCE}, Eq. 5.10; solver for line contacts of this package",
            reliability="as mixed-ehl where both flanks are equally rough, the effect of a "
            "smoother one from the solver of this package",
            function=paired_rolling,
            ranges=TALBOT_GEAR_RANGES,
            made_for=TALBOT_FLUID,
        ),
        RollingFormula(
            name="goksem-hargreaves",
            title="rolling loss of Goksem and Hargreaves",
            source="Goksem and Hargreaves, J. Lubr. Technol. 100 (1978) 346; light load: "
            "H. M. Martin, Engineering 102 (1916) 119",
            reliability="within some 15 % of solved smooth contacts without heating; rough "
            "contacts lose more",
            function=goksem_hargreaves,
            ranges=(
                Range(
                    "moes_load",
                    "load parameter M of Moes",
                    3.0,
                    200.0,
                    NUMBER,
                    "numerical solutions of the smooth line contact",
                ),
                Range(
                    "film_ratio", "film ratio", 1.0, None, NUMBER, "the formula is for full films"
                ),
            ),
        ),
    )
}
