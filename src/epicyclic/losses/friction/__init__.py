"""Coefficients of sliding friction: one class a model, chosen by name.

=================  ============  ==================================================================
name               kind          source
=================  ============  ==================================================================
mixed-ehl          local         Talbot (2012), Eq. 5.8: regression of mixed-EHL simulations
mixed-ehl+pairing  local         as above, for flanks of unequal roughness: solver of this package
xu-2007            local         Xu, Kahraman, Anderson, Maddock (2007): regression, full film
benedict-kelley    local         Benedict and Kelley (1961)
matsumoto          local         Matsumoto and Morikawa (2014): film share
doleschel          local         Doleschel (2002): film share
schlenk            mean          Schlenk (1994), as in ISO/TR 14179-2
niemann-winter     mean          Michaelis (1987), as in Niemann and Winter
constant           mean          the case
table              local         the case
=================  ============  ==================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from epicyclic.losses.friction.base import FrictionModel
from epicyclic.losses.friction.classical import BenedictKelley, NiemannWinter, Schlenk
from epicyclic.losses.friction.film_share import Doleschel, Matsumoto
from epicyclic.losses.friction.regressions import MixedEhl, PairedFriction, Xu2007
from epicyclic.losses.friction.user import Constant, FrictionMap

__all__ = ["DRY_FRICTION", "FRICTION_MODELS", "FrictionModel", "FrictionSettings", "friction_model"]


DRY_FRICTION = 0.10
"""Coefficient of dry contact in the film-share models, unless the case has its own. [1]"""


@dataclass(frozen=True, slots=True)
class FrictionSettings:
    """Numbers that some models take from the case."""

    constant: float  # Coefficient of the model constant. [1]
    boundary: float  # Coefficients of dry and of separated contact in the film-share models. [1]
    fluid: float  # Coefficients of dry and of separated contact in the film-share models. [1]
    table: FrictionMap | None = None
    oil_held: bool = True  # False to continue the model mixed-ehl beyond its oil.
    load_factor: float = 1.0  # K_A K_gamma, for the model niemann-winter. [1]


def _table(settings: FrictionSettings) -> FrictionModel:
    if settings.table is None:
        raise ValueError("the friction model 'table' needs a friction_table")
    return settings.table


FRICTION_MODELS: dict[str, Callable[[FrictionSettings], FrictionModel]] = {
    MixedEhl.name: lambda settings: MixedEhl(settings.oil_held),
    PairedFriction.name: lambda settings: PairedFriction(settings.oil_held),
    Xu2007.name: lambda _: Xu2007(),
    BenedictKelley.name: lambda _: BenedictKelley(),
    Matsumoto.name: lambda settings: Matsumoto(settings.boundary, settings.fluid),
    Doleschel.name: lambda settings: Doleschel(settings.boundary, settings.fluid),
    Schlenk.name: lambda _: Schlenk(),
    NiemannWinter.name: lambda settings: NiemannWinter(settings.load_factor),
    Constant.name: lambda settings: Constant(settings.constant),
    FrictionMap.name: _table,
}


def friction_model(name: str, settings: FrictionSettings) -> FrictionModel:
    """The friction model called `name`."""
    return FRICTION_MODELS[name](settings)
