"""The roller bearing between a planet and its pin."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from epicyclic.elements.base import LOAD_DEPENDENT, LOAD_INDEPENDENT, Loss
from epicyclic.elements.figures import BearingFigures
from epicyclic.elements.planet_load import PlanetLoad
from epicyclic.kernels.line_contact import hertz_half_width, hertz_pressure
from epicyclic.losses.fitted import FittedRolling
from epicyclic.losses.planet_bearing import (
    BearingLoss,
    RollerBearing,
    RollerLoads,
    fitted_rolling_loss,
    mixed_ehl_rolling_loss,
    palmgren_flags,
    palmgren_loss,
    roller_loads,
    roller_loads_next_to,
)
from epicyclic.losses.validity import Flags, SomeFlags
from epicyclic.losses.viscous import (
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    bearing_viscous_loss,
    viscous_flags,
)
from epicyclic.lubricant.properties import OilState
from epicyclic.thermal.convection import roller_conductance

BEARING_METHOD = "mixed-EHL rolling-loss regression, slice by slice"
BEARING_SOURCE = "D. C. Talbot, PhD dissertation, Ohio State (2012), Eq. 3.2 to 3.6"
PALMGREN_METHOD = "friction coefficient f1 of Palmgren"
PALMGREN_SOURCE = "A. Palmgren, Ball and Roller Bearing Engineering (1959); Talbot (2012), Eq. 3.1"


@dataclass(frozen=True, slots=True)
class PlanetBearing:
    """A planet bearing and the models of its losses."""

    bearing: RollerBearing
    # ``"mixed-ehl"``, ``"palmgren"``, or a loss fitted to simulated contacts.
    model: str | FittedRolling
    palmgren_coefficient: float  # f1. [1]
    viscous_factor: float  # f0 of the whole bearing. [1]
    conductivity: float  # Thermal, of races and rollers. [W/(m K)]
    oil_held: bool = True  # False to continue the model mixed-ehl beyond its oil.
    # True if Palmgren's coefficient takes over where a fitted loss was not simulated.
    palmgren_beyond: bool = False

    @property
    def method(self) -> tuple[str, str]:
        """How the load-dependent loss is found, and where that is printed."""
        if isinstance(self.model, FittedRolling):
            if self.palmgren_beyond:
                return (
                    f"{self.model.title}, beyond them {PALMGREN_METHOD}",
                    f"{self.model.source}; {PALMGREN_SOURCE}",
                )
            return self.model.title, self.model.source
        if self.model == "mixed-ehl":
            return BEARING_METHOD, BEARING_SOURCE
        return PALMGREN_METHOD, PALMGREN_SOURCE


@dataclass(frozen=True, slots=True)
class BearingOutcome:
    """Losses of the planet bearings, and how the figures of one of them are found.

    `loads`, those on its rollers, is what the next pass goes on from.
    """

    losses: dict[str, Loss]
    figures: Callable[[], BearingFigures] | None = None
    flags: SomeFlags = ()
    loads: RollerLoads | None = None


def missing_bearing(key: str, reason: str) -> BearingOutcome:
    """The losses of a bearing that is not there."""
    return BearingOutcome(
        {
            f"{key}_mechanical": Loss(LOAD_DEPENDENT, left_out=reason),
            f"{key}_viscous": Loss(LOAD_INDEPENDENT, left_out=reason),
        }
    )


def solve_bearing(
    key: str,  # First word of the losses, ``"planet_bearing"``.
    own: PlanetBearing,
    load: PlanetLoad,  # Load of each of them.
    count: int,
    oil: OilState,
    speed: float,  # Speed of the planet against the carrier. [rad/s]
    last: RollerLoads | None = None,  # The rollers under nearly this load, which saves work.
) -> BearingOutcome:
    """Losses of `count` planet bearings under the same load."""
    bearing = own.bearing
    if last is None:
        loads = roller_loads(bearing, load.force, 0.0, load.moment_x, load.moment_y)
    else:
        loads = roller_loads_next_to(last, bearing, load.force, load.moment_x, load.moment_y)
    if isinstance(own.model, FittedRolling):
        beyond = _palmgren(own, loads, load, speed) if own.palmgren_beyond else None
        loss = fitted_rolling_loss(bearing, loads, speed, oil, own.model, beyond)
    elif own.model == "mixed-ehl":
        loss = mixed_ehl_rolling_loss(bearing, loads, speed, oil, oil_held=own.oil_held)
    else:
        loss = _palmgren(own, loads, load, speed)
    viscous_loss = bearing_viscous_loss(
        own.viscous_factor, oil.kinematic_viscosity, speed, bearing.pitch_diameter
    )
    return BearingOutcome(
        {
            f"{key}_mechanical": Loss(LOAD_DEPENDENT, count * loss.loss, *own.method),
            f"{key}_viscous": Loss(
                LOAD_INDEPENDENT, count * viscous_loss, VISCOUS_METHOD, VISCOUS_SOURCE
            ),
        },
        partial(_bearing_figures, own, loads, load, speed, oil, loss.loss),
        loss.flags + viscous_flags(key.replace("_", " "), speed, bearing.pitch_diameter),
        loads,
    )


def _palmgren(
    own: PlanetBearing, loads: RollerLoads, load: PlanetLoad, speed: float
) -> BearingLoss:
    bearing = own.bearing
    watts = palmgren_loss(own.palmgren_coefficient, load.force, bearing.pitch_diameter, speed)
    return BearingLoss(watts, Flags(partial(palmgren_flags, bearing, loads, speed)))


def _bearing_figures(
    own: PlanetBearing,
    loads: RollerLoads,
    load: PlanetLoad,
    speed: float,
    oil: OilState,
    loss: float,
) -> BearingFigures:
    bearing = own.bearing
    rollers = loads.intensity.sum(axis=2) * bearing.slice_width
    row, most = np.unravel_index(int(rollers.argmax()), rollers.shape)
    hardest = float(loads.intensity.max()), bearing.inner_radius, bearing.equivalent_modulus
    resisted = float(rollers.sum()) * bearing.pitch_diameter / 2 * abs(speed)
    return BearingFigures(
        radial_force=load.force,
        moment=math.hypot(load.moment_x, load.moment_y),
        speed=abs(speed),
        rollers_loaded=float(np.count_nonzero(rollers)),
        roller_load_max=float(rollers[row, most]),
        roller_azimuth=math.remainder(float(loads.azimuth[most]), 2 * math.pi),
        hertz_pressure_max=hertz_pressure(*hardest),
        flattening=hertz_half_width(*hardest) / bearing.inner_radius,
        resistance=loss / resisted if resisted else 0.0,
        contact_temperature=oil.temperature,
        heat_conductance=_heat_conductance(own, loads),
        loads=loads,
    )


def _heat_conductance(own: PlanetBearing, loads: RollerLoads) -> float:
    """Heat from race to race through the loaded rollers. [W/K]"""
    bearing = own.bearing
    inner, outer = (
        hertz_half_width(
            loads.intensity,
            np.full_like(loads.intensity, radius),
            bearing.equivalent_modulus,
        )
        for radius in (bearing.inner_radius, bearing.outer_radius)
    )
    return roller_conductance(
        inner,
        outer,
        bearing.slice_width,
        bearing.roller_diameter,
        math.pi * bearing.inner_diameter / bearing.rollers_per_row,
        math.pi * bearing.outer_diameter / bearing.rollers_per_row,
        own.conductivity,
    )
