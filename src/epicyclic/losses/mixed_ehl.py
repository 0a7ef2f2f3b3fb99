"""The groups of Talbot's gear regressions, and flanks of unequal roughness in them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from epicyclic import library
from epicyclic.contact.fitted_models import OilModel, read_oil_model
from epicyclic.contact.line_contact import LineContacts
from epicyclic.losses.ranges import Range, RegressionFluid
from epicyclic.units import (
    CELSIUS,
    GIGAPASCAL,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    MILLIPASCAL_SECOND,
    NUMBER,
    PER_GIGAPASCAL,
)

# The dimensionless groups of Talbot's gear regressions, kept in the range they were made in.
#
# Powers and exponentials of a regression run away outside its data: at a fifth of the lowest
# simulated Hertz pressure Eq. 5.8 gives coefficients of friction above 1, and with pressure,
# radius, roughness and viscosity each a factor of two outside Table 5.1, Eq. 5.10 gives rolling
# losses a million times the power passed on. The conditions are therefore held at the limits of
# Table 5.1, and the pressure, along which the formulas go on smoothly, at half the lowest and twice
# the highest. Beyond a held load or speed, rolling losses go on as `beyond_data` says. Every use
# outside Table 5.1 is flagged.


FloatArray = NDArray[np.float64]

TALBOT_FLUID = RegressionFluid(
    "talbot-2012", "the automatic transmission fluid of Talbot (2012), atf-talbot-2012"
)

REGRESSION_SOURCE = "D. C. Talbot, PhD dissertation, Ohio State (2012)"
_SOURCE = "Talbot (2012), Table 5.1"
_FLUID_SOURCE = "the fluid of Talbot (2012) at 100 and 25 degC"
_PRESSURE = Range("hertz_pressure", "Hertz pressure", 0.5, 2.5, GIGAPASCAL, _SOURCE)
_HELD_PRESSURE = replace(_PRESSURE, low=0.25, high=5.0)
"""Where the pressure is held: lightly loaded teeth of the very tests lie below Table 5.1."""
_RADIUS = Range("radius", "equivalent radius", 5.0, 40.0, MILLIMETRE, _SOURCE)
_SPEED = Range("rolling_speed", "rolling speed", 1.0, 20.0, METRE_PER_SECOND, _SOURCE)
VISCOSITY_RANGE = Range(
    "dynamic_viscosity", "dynamic viscosity", 4.9, 48.0, MILLIPASCAL_SECOND, _FLUID_SOURCE
)
"""Viscosities of the simulations: the fluid is that of `atf-talbot-2012`, Tables 3.1 and 5.1."""
PRESSURE_VISCOSITY_RANGE = Range(
    "pressure_viscosity",
    "pressure-viscosity coefficient",
    10.6,
    16.5,
    PER_GIGAPASCAL,
    f"{_FLUID_SOURCE}, calibrated",
)
"""As calibrated for that fluid. The regressions contain exp(G) and are the most sensitive to it."""
_ROUGHNESS = Range("roughness", "rms roughness", 0.1, 0.7, MICROMETRE, _SOURCE)

TALBOT_GEAR_RANGES = (
    Range("temperature", "oil temperature", 25.0, 100.0, CELSIUS, _SOURCE),
    VISCOSITY_RANGE,
    PRESSURE_VISCOSITY_RANGE,
    _RADIUS,
    _ROUGHNESS,
    _PRESSURE,
    _SPEED,
    Range("slide_to_roll_ratio", "slide-to-roll ratio", 0.025, 1.0, NUMBER, _SOURCE),
)
"""Ranges of the 33,600 simulations behind Eq. 5.8 and 5.10."""


_HELD = {
    item.name: item.limits()
    for item in (
        _RADIUS,
        _HELD_PRESSURE,
        _SPEED,
        VISCOSITY_RANGE,
        PRESSURE_VISCOSITY_RANGE,
        replace(_ROUGHNESS, name="roughness1"),
        replace(_ROUGHNESS, name="roughness2"),
    )
}


Limits = Mapping[str, tuple[float | None, float | None]]
_OIL = (VISCOSITY_RANGE.name, PRESSURE_VISCOSITY_RANGE.name)


@lru_cache(maxsize=2)  # friction and rolling of a mesh ask for the same one
def held_in_table(contact: LineContacts, *, oil_held: bool = True) -> LineContacts:
    """The contacts with their conditions held in Table 5.1, but for the slip. Theory (F5).

    Without `oil_held` viscosity and pressure-viscosity stay as they are: the formula goes on.
    """
    return contact.held(_HELD if oil_held else without_oil(_HELD))


def without_oil(limits: Limits) -> Limits:
    """Limits of conditions but for those of the oil."""
    return {name: pair for name, pair in limits.items() if name not in _OIL}


def beyond_data(contact: LineContacts, held: LineContacts) -> FloatArray:
    """Rolling loss over that of the same contacts with conditions `held`. Theory (R5). [1]

    Below the held load the loss falls with the load, so that it vanishes with it; above, it is
    that of the held load. Beyond the held speed the rolling force is that of the held speed.
    """
    return np.minimum(1.0, contact.line_load / held.line_load) * (
        contact.rolling_speed / held.rolling_speed
    )


# The published regressions for flanks of unequal roughness.
#
# They know the composite roughness only, which hardly falls when one of two rough flanks is
# polished; but a polished flank keeps the ridges of the other from meeting any. The regression is
# therefore taken where both flanks are as rough as the rougher one, and from there the solver of
# this package tells what the smoother flank changes, by its fit to contacts of the same oil.

SIMULATED = "atf-talbot-2012"  # The oil of the regressions, whose contacts were simulated.


def equally_rough(contact: LineContacts) -> LineContacts:
    """The contacts with both surfaces as rough as the rougher one."""
    rougher = np.maximum(*contact.roughness) + np.zeros(contact.radius.shape)
    return contact.changed(roughness1=rougher, roughness2=rougher)


def pairing_ratio(
    quantity: str,  # ``"friction"`` or ``"rolling_loss"``.
    contact: LineContacts,  # n of them.
) -> FloatArray:
    """A quantity over what it is with both surfaces as rough as the rougher one. Theory (O13). [1]

    Examples
    --------
    >>> import numpy as np
    >>> from epicyclic.contact.line_contact import contacts_at
    >>> given = dict(
    ...     slide_to_roll_ratio=0.3, rolling_speed=10.0, radius=0.01, hertz_pressure=1e9,
    ...     roughness1=0.4e-6, roughness2=0.4e-6, dynamic_viscosity=6e-3, pressure_viscosity=11e-9,
    ... )
    >>> arrays = {name: np.array([value]) for name, value in given.items()}
    >>> pairing_ratio("friction", contacts_at(**arrays, equivalent_modulus=2.3e11))
    array([1.])
    """
    model = _simulated()
    return model.value(quantity, contact) / model.value(quantity, equally_rough(contact))


@lru_cache(maxsize=1)
def _simulated() -> OilModel:
    file = library.oil_model_file(SIMULATED)
    assert file is not None
    return read_oil_model(file)
