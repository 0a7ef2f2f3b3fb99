"""The plain pin of a planet: a journal bearing with its losses and figures."""

from __future__ import annotations

import math
from dataclasses import dataclass

from epicyclic.losses.journal_bearing import (
    JournalBearing,
    JournalState,
    journal_flags,
    solve_journal,
)
from epicyclic.machine.convection import oil_heat_capacity
from epicyclic.machine.element import (
    LOAD_DEPENDENT,
    LOAD_INDEPENDENT,
    Loss,
    Note,
    PartFigures,
    figure,
)
from epicyclic.machine.planets import BearingFigures, BearingResult, PlanetLoad
from epicyclic.oil.oil import OilState
from epicyclic.units import CELSIUS, DEGREE, MICROMETRE, NUMBER, WATT, format_number, percent

METHOD = "Reynolds' equation of the film, with contact of asperities"
SOURCE = (
    "O. Reynolds, Phil. Trans. R. Soc. 177 (1886) 157; heat balance of ISO 7902-1, second hand; "
    "asperities J. A. Greenwood, J. H. Tripp (1971), second hand"
)
PETROFF = "film of a concentric pin after Petroff"
MIXED = 0.01
"""Share of the load on asperities from which a note says so. [1]"""
TILTED = 0.05
"""Offset of the load from the middle over the length from which a note says so. [1]"""


@dataclass(frozen=True, slots=True)
class PlanetPin:
    """A plain pin and what its film needs of the oil."""

    bearing: JournalBearing
    specific_gravity: float  # Of the oil, at 15.6 degC. [1]
    heat_capacity: float | None  # Of the oil; None for that of its density. [J/(kg K)]

    method = METHOD, SOURCE


@dataclass(frozen=True, eq=False)
class PinFigures(PartFigures):
    """The film on a plain pin."""

    eccentricity: float = figure("eccentricity over the clearance", NUMBER)
    attitude: float = figure("attitude angle", DEGREE)
    film: float = figure("narrowest film", MICROMETRE)
    film_ratio: float = figure("film over roughness", NUMBER)
    contact_share: float = figure("load on asperities", NUMBER)
    film_temperature: float = figure("temperature of the film", CELSIUS)
    friction_coefficient: float = figure("friction coefficient", NUMBER)


def solve_pin(
    key: str,  # First word of the losses.
    own: PlanetPin,
    load: PlanetLoad,
    count: int,
    oil: OilState,
    speed: float,  # Of the planet against the carrier. [rad/s]
) -> BearingResult:
    """Losses of `count` planets on plain pins under the same load."""
    capacity = own.heat_capacity
    if capacity is None:
        capacity = oil_heat_capacity(oil.temperature, own.specific_gravity)
    found = solve_journal(own.bearing, load.force, speed, oil, capacity)
    by_load = max(found.watts - found.petroff_watts, 0.0)
    losses = {
        f"{key}_mechanical": Loss(LOAD_DEPENDENT, count * by_load, METHOD, SOURCE),
        f"{key}_viscous": Loss(LOAD_INDEPENDENT, count * found.petroff_watts, PETROFF, SOURCE),
    }
    bearing = own.bearing
    moment = math.hypot(load.moment_x, load.moment_y)
    sliding = abs(speed) * bearing.inner_diameter / 2
    friction = found.watts / (load.force * sliding) if load.force * sliding else math.nan
    figures = BearingFigures(
        loads=None,
        flattening=0.0,
        resistance=0.0,
        radial_force=load.force,
        moment=moment,
        speed=abs(speed),
        rollers_loaded=math.nan,
        roller_load_max=math.nan,
        roller_azimuth=math.nan,
        hertz_pressure_max=math.nan,
        contact_temperature=oil.temperature,
        heat_conductance=oil.thermal_conductivity
        * math.pi
        * bearing.inner_diameter
        * bearing.length
        / (bearing.diametral_clearance / 2),
    )
    film = PinFigures(
        eccentricity=found.eccentricity,
        attitude=found.attitude,
        film=found.film,
        film_ratio=found.film_ratio,
        contact_share=found.contact_force / load.force if load.force else 0.0,
        film_temperature=found.temperature,
        friction_coefficient=friction,
    )
    where = key.replace("_", " ")
    return BearingResult(
        losses,
        {key: figures, f"{key}_film": film},
        journal_flags(where, found, speed),
        _notes(where, own, load, found, count * found.watts, speed),
    )


def _notes(
    where: str, own: PlanetPin, load: PlanetLoad, found: JournalState, watts: float, speed: float
) -> tuple[str, ...]:
    """Mixed friction, and the couple of helical meshes, which the film does not carry here."""
    notes, rubbing = [], watts * found.contact_watts / found.watts if found.watts else 0.0
    if speed and found.contact_force > MIXED * load.force:
        notes.append(
            Note(
                f"{where}: asperities carry {percent(found.contact_force / load.force, 0)} of the "
                f"load, because the film of {MICROMETRE.text(found.film, 3)} is "
                f"{format_number(found.film_ratio, 2)} times the roughness. Of "
                f"{WATT.text(watts, 3)} of the pins {WATT.text(rubbing, 3)} are due to "
                "boundary_friction, which is known within a factor of 2 at best.",
                rubbing,
            )
        )
    moment = math.hypot(load.moment_x, load.moment_y)
    offset = moment / (load.force * own.bearing.length) if load.force else 0.0
    if speed and offset > TILTED:
        notes.append(
            Note(
                f"{where}: the couple of the helical meshes tilts the planet on its pin, as if the "
                f"load stood {percent(offset, 0)} of the length "
                "beside the middle. The film is that of an aligned pin; a tilted one is narrower "
                "at the ends.",
                watts,
            )
        )
    return tuple(notes)
