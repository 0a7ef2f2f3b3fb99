"""Losses of the planet bearings, by the method of the case."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from epicyclic.analysis.figures import BearingFigures
from epicyclic.analysis.models import fitted_rolling, resolve_models
from epicyclic.analysis.parts import Part
from epicyclic.analysis.planet_load import PlanetLoad
from epicyclic.analysis.result import LOAD_DEPENDENT, LOAD_INDEPENDENT
from epicyclic.case.case import PlanetaryCase
from epicyclic.case.part_tables import PlanetBearing
from epicyclic.kernels.line_contact import equivalent_modulus, hertz_pressure
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
)
from epicyclic.losses.validity import ValidityFlag
from epicyclic.losses.viscous import (
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    bearing_viscous_loss,
    viscous_flags,
)
from epicyclic.lubricant.properties import OilState

__all__ = [
    "bearing_method",
    "palmgren_coefficient",
    "planet_bearing",
    "roller_bearing",
    "solve_bearing",
]

CAGED_PALMGREN = 0.0003
"""f1 of a caged roller bearing, middle of 0.0002-0.0004. Talbot (2012), p. 56. [1]"""
FULL_COMPLEMENT_PALMGREN = 0.00055
"""f1 of a full-complement roller bearing. Talbot (2012), p. 56. [1]"""
VISCOUS_FACTOR_PER_ROW = 3.0
"""f0 of one row of caged cylindrical rollers, middle of 2.2-4.0. Talbot (2012), p. 130. [1]"""
BEARING_METHOD = "mixed-EHL rolling-loss regression, slice by slice"
BEARING_SOURCE = "D. C. Talbot, PhD dissertation, Ohio State (2012), Eq. 3.2 to 3.6"
PALMGREN_METHOD = "friction coefficient f1 of Palmgren"
PALMGREN_SOURCE = "A. Palmgren, Ball and Roller Bearing Engineering (1959); Talbot (2012), Eq. 3.1"


@dataclass(frozen=True, slots=True)
class BearingOutcome:
    """Losses of the planet bearings, and the figures of one of them."""

    parts: dict[str, Part]
    figures: BearingFigures | None = None
    flags: tuple[ValidityFlag, ...] = ()


def solve_bearing(
    case: PlanetaryCase,
    load: PlanetLoad,
    count: int,
    oil: OilState,
    speed: float,
) -> BearingOutcome:
    """Losses of `count` planet bearings under the same load, at `speed` relative to the carrier."""
    table, bearing = case.planet_bearing, planet_bearing(case)
    mechanical, viscous = "planet_bearing_mechanical", "planet_bearing_viscous"
    if table is None or bearing is None:
        reason = "the case has no [planet_bearing]"
        return BearingOutcome(
            {
                mechanical: Part(LOAD_DEPENDENT, left_out=reason),
                viscous: Part(LOAD_INDEPENDENT, left_out=reason),
            }
        )
    loads = roller_loads(bearing, load.force, 0.0, load.moment_x, load.moment_y)
    name = resolve_models(case)["bearing"]
    if name == "mixed-ehl":
        loss = mixed_ehl_rolling_loss(bearing, loads, speed, oil)
    elif name == FittedRolling.name:
        model = fitted_rolling(case, "bearing_rolling_loss")
        loss = fitted_rolling_loss(bearing, loads, speed, oil, model)
    else:
        watts = palmgren_loss(
            palmgren_coefficient(table), load.force, bearing.pitch_diameter, speed
        )
        loss = BearingLoss(watts, palmgren_flags(bearing, loads, speed))
    method, source = bearing_method(case)
    viscous_loss = bearing_viscous_loss(
        viscous_factor(table), oil.kinematic_viscosity, speed, bearing.pitch_diameter
    )
    return BearingOutcome(
        {
            mechanical: Part(LOAD_DEPENDENT, count * loss.loss, method, source),
            viscous: Part(LOAD_INDEPENDENT, count * viscous_loss, VISCOUS_METHOD, VISCOUS_SOURCE),
        },
        _bearing_figures(bearing, loads, load, speed),
        loss.flags + viscous_flags("planet bearing", speed, bearing.pitch_diameter),
    )


def bearing_method(case: PlanetaryCase) -> tuple[str, str]:
    """How the load-dependent loss of the planet bearings is found, and where that is printed."""
    name = resolve_models(case)["bearing"]
    if name == "mixed-ehl":
        return BEARING_METHOD, BEARING_SOURCE
    if name == FittedRolling.name:
        model = fitted_rolling(case, "bearing_rolling_loss")
        return model.title, model.source
    return PALMGREN_METHOD, PALMGREN_SOURCE


def viscous_factor(table: PlanetBearing) -> float:
    """f0 of the case, or that of caged cylindrical rollers for each row. [1]"""
    if table.viscous_factor is not None:
        return table.viscous_factor
    return VISCOUS_FACTOR_PER_ROW * table.rows


def palmgren_coefficient(table: PlanetBearing) -> float:
    """f1 of the case, or the published one of the bearing's kind. [1]"""
    if table.palmgren_coefficient is not None:
        return table.palmgren_coefficient
    return CAGED_PALMGREN if table.cage == "caged" else FULL_COMPLEMENT_PALMGREN


def planet_bearing(case: PlanetaryCase) -> RollerBearing | None:
    """The bearing of the case, if it has one."""
    table = case.planet_bearing
    return None if table is None else roller_bearing(table, case.numerics.bearing_slices)


def roller_bearing(table: PlanetBearing, slices: int) -> RollerBearing:
    """The bearing that `table` describes, each roller cut into `slices`."""
    modulus, poisson = table.material.elastic_modulus, table.material.poisson_ratio
    return RollerBearing(
        rows=table.rows,
        rollers_per_row=table.rollers_per_row,
        roller_diameter=table.roller_diameter,
        roller_length=table.roller_length,
        inner_diameter=table.pin_diameter,
        diametral_clearance=table.diametral_clearance,
        crown_drop=table.crown_drop,
        crown_length_fraction=table.crown_length_fraction,
        row_gap=table.row_gap,
        roller_roughness=table.roller_roughness,
        race_roughness=table.race_roughness,
        equivalent_modulus=equivalent_modulus(modulus, poisson, modulus, poisson),
        slices=slices,
    )


def _bearing_figures(
    bearing: RollerBearing, loads: RollerLoads, load: PlanetLoad, speed: float
) -> BearingFigures:
    rollers = loads.intensity.sum(axis=2) * bearing.slice_width
    row, most = np.unravel_index(int(rollers.argmax()), rollers.shape)
    pressure = hertz_pressure(
        float(loads.intensity.max()), bearing.inner_radius, bearing.equivalent_modulus
    )
    return BearingFigures(
        radial_force=load.force,
        moment=math.hypot(load.moment_x, load.moment_y),
        speed=abs(speed),
        rollers_loaded=float(np.count_nonzero(rollers)),
        roller_load_max=float(rollers[row, most]),
        roller_azimuth=math.remainder(float(loads.azimuth[most]), 2 * math.pi),
        hertz_pressure_max=pressure,
        loads=loads,
    )
