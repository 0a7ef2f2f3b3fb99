"""Rolling loss per contact length of a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact.fitted_models import regression_groups, rolling_scale
from epicyclic.contact.line_contact import LineContacts
from epicyclic.kernels.line_contact import goksem_hargreaves_force, martin_force
from epicyclic.kernels.mixed_ehl import rolling_loss_number_at
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.mixed_ehl import (
    TalbotRegression,
    beyond_data,
    equally_rough,
    held_in_table,
    pairing_ratio,
)
from epicyclic.losses.ranges import Range, RegressionFluid
from epicyclic.units import NUMBER

FloatArray = NDArray[np.float64]


class RollingModel(Protocol):
    """A way to the rolling loss per contact length; attributes as those of `FrictionModel`."""

    name: ClassVar[str]
    made_for: ClassVar[RegressionFluid | None]

    @property
    def title(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def ranges(self) -> tuple[Range, ...]: ...

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """Rolling loss per contact length at each point, shape (n,). [W/m]"""
        ...


@dataclass(frozen=True, slots=True)
class MixedEhlRolling(TalbotRegression):
    """Regression of 33,600 mixed-EHL simulations of an automatic transmission fluid.

    Theory (R5).

    Talbot (2012), Eq. 5.10 and Table 5.2(b), in the scale of `rolling_scale`.
    """

    name: ClassVar = "mixed-ehl"
    title: ClassVar = "mixed-EHL rolling-loss regression"
    source: ClassVar = "D. C. Talbot, PhD dissertation, Ohio State (2012), Eq. 5.10"

    def loss_density(self, contact: LineContacts) -> FloatArray:
        """See the class. [W/m]"""
        held = held_in_table(contact, oil_held=self.oil_held)
        number = rolling_loss_number_at(*regression_groups(held))
        density: FloatArray = number * rolling_scale(held) * beyond_data(contact, held)
        return density


@dataclass(frozen=True, slots=True)
class PairedRolling(TalbotRegression):
    """`MixedEhlRolling` of two flanks as rough as the rougher one, times what the smoother changes.

    Theory (O13).
    """

    name: ClassVar = "mixed-ehl+pairing"
    title: ClassVar = "mixed-EHL rolling-loss regression, pairing of unequal flanks from the solver"
    source: ClassVar = f"{MixedEhlRolling.source}; solver for line contacts of this package"

    def loss_density(self, contact: LineContacts) -> FloatArray:
        """See the class. [W/m]"""
        published = MixedEhlRolling(self.oil_held).loss_density(equally_rough(contact))
        density: FloatArray = published * pairing_ratio("rolling_loss", contact)
        return density


class GoksemHargreaves:
    """Rolling force of both surfaces of a smooth, fully flooded contact, times u_r.

    Theory (R7), (R10).

    The formula belongs to elastic contacts, and its force does not vanish with the load. That of
    rigid cylinders and an oil of constant viscosity does; where it is smaller, it takes over.
    """

    name: ClassVar = "goksem-hargreaves"
    title: ClassVar = "rolling loss of Goksem and Hargreaves"
    source: ClassVar = (
        "Goksem and Hargreaves, J. Lubr. Technol. 100 (1978) 346; light load: H. M. Martin, "
        "Engineering 102 (1916) 119"
    )
    made_for: ClassVar[RegressionFluid | None] = None
    ranges: ClassVar[tuple[Range, ...]] = (
        Range(
            "moes_load",
            "load parameter M of Moes",
            3.0,
            200.0,
            NUMBER,
            "numerical solutions of the smooth line contact",
        ),
        Range("film_ratio", "film ratio", 1.0, None, NUMBER, "the formula is for full films"),
    )

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """See the class. [W/m]"""
        oil = contact.oil
        heating = (
            oil.dynamic_viscosity
            * oil.thermoviscosity
            * contact.rolling_speed**2
            / oil.thermal_conductivity
        )
        number = goksem_hargreaves_force(
            contact.speed_number,
            contact.material_number,
            contact.load_number,
            heating,
        )
        elastic = number * contact.radius / oil.pressure_viscosity
        rigid = martin_force(contact.line_load, contact.rolling_speed, oil.dynamic_viscosity)
        density: FloatArray = 2 * np.minimum(elastic, rigid) * contact.rolling_speed
        return density


_MODELS: tuple[RollingModel, ...] = (MixedEhlRolling(), PairedRolling(), GoksemHargreaves())
ROLLING_MODELS = {model.name: model for model in _MODELS}
