"""Flash temperature along the contact lines of a mesh, and which gear the heat goes to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.losses.contact import MeshContact
from epicyclic.thermal.flash import flash_temperature, heat_share
from epicyclic.thermal.solids import Solid

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MeshWarmth:
    """Flash temperature of a mesh."""

    flash_mean: float  # Weighted with the load over the mesh period. [K]
    flash_max: float  # Largest one. [K]


def mesh_warmth(
    contact: MeshContact,
    friction: FloatArray,  # Coefficient of friction at every point. [1]
    materials: tuple[Solid, Solid],  # Materials of both gears.
) -> MeshWarmth:
    """Flash temperature of a mesh in contact. Theory (W1)."""
    flash = flash_temperatures(contact, friction, materials)
    load = contact.line_load * contact.weight
    return MeshWarmth(
        flash_mean=float((flash * load).sum() / load.sum()),
        flash_max=float(flash.max()),
    )


def heat_share1(
    contact: MeshContact,
    heat: FloatArray,  # Of sliding friction at every point. [W]
    materials: tuple[Solid, Solid],  # Materials of both gears.
) -> float:
    """Share of the heat of sliding that gear 1 takes up. Theory (W2). [1]"""
    total = float(heat.sum())
    if not total > 0:
        return 0.5
    share1 = heat_share(*contact.surface_speeds, *(solid.effusivity for solid in materials))
    return float((heat * share1).sum()) / total


def flash_temperatures(
    contact: MeshContact, friction: FloatArray, materials: tuple[Solid, Solid]
) -> FloatArray:
    """Flash temperature at every point of the contact lines, shape (n,). Theory (W1). [K]"""
    return flash_temperature(
        friction,
        contact.line_load,
        contact.sliding_speed,
        *contact.surface_speeds,
        contact.hertz_half_width,
        *(solid.effusivity for solid in materials),
    )
