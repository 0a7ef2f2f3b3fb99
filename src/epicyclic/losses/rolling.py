"""Rolling loss per contact length of a mesh."""

from __future__ import annotations

from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.line_contact import goksem_hargreaves_force
from epicyclic.kernels.mixed_ehl import rolling_loss_number_at
from epicyclic.losses.contact import MeshContact
from epicyclic.losses.mixed_ehl_groups import (
    TALBOT_GEAR_RANGES,
    VISCOSITY_RANGE,
    held_in_range,
    light_load_share,
    regression_groups,
)
from epicyclic.losses.validity import Range

__all__ = ["ROLLING_MODELS", "RollingModel", "rolling_scale"]

FloatArray = NDArray[np.float64]


class RollingModel(Protocol):
    """A way to the rolling loss per contact length."""

    title: ClassVar[str]
    source: ClassVar[str]
    ranges: ClassVar[tuple[Range, ...]]

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """Rolling loss per contact length at each point, shape (n,). [W/m]"""
        ...


def rolling_scale(contact: MeshContact) -> FloatArray:
    """mu u_r^2: the power per length that turns the number of Eq. 5.10 into W/m.

    Theory (R4).

    A documented reconstruction. The source prints 1e5 W/m, with which the rolling loss exceeds the
    input power; mu u_r^2 is the only natural scale of the problem, reproduces the published
    totals, and agrees with smooth EHL solutions within about a factor of two.
    """
    viscosity = held_in_range(contact.dynamic_viscosity, VISCOSITY_RANGE)
    scale: FloatArray = viscosity * contact.rolling_speed**2
    return scale


class MixedEhlRolling:
    """Regression of 33,600 mixed-EHL simulations of an automatic transmission fluid.

    Theory (R5).

    Talbot (2012), Eq. 5.10 and Table 5.2(b), in the scale of `rolling_scale`.
    """

    title: ClassVar = "mixed-EHL rolling-loss regression"
    source: ClassVar = "D. C. Talbot, PhD dissertation, Ohio State (2012), Eq. 5.10"
    ranges: ClassVar[tuple[Range, ...]] = TALBOT_GEAR_RANGES

    def loss_density(self, contact: MeshContact) -> FloatArray:
        """See the class. [W/m]"""
        number = rolling_loss_number_at(*regression_groups(contact))
        density: FloatArray = (
            rolling_scale(contact) * number * light_load_share(contact.hertz_pressure)
        )
        return density


class GoksemHargreaves:
    """Rolling force of both surfaces of a smooth, fully flooded contact, times u_r. Theory (R7)."""

    title: ClassVar = "rolling loss of Goksem and Hargreaves"
    source: ClassVar = "Goksem and Hargreaves, J. Lubr. Technol. 100 (1978) 346"
    ranges: ClassVar[tuple[Range, ...]] = ()

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
        force = number * contact.radius / oil.pressure_viscosity
        density: FloatArray = 2 * force * contact.rolling_speed
        return density


ROLLING_MODELS: dict[str, RollingModel] = {
    "mixed-ehl": MixedEhlRolling(),
    "goksem-hargreaves": GoksemHargreaves(),
}
