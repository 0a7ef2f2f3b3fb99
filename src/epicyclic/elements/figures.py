"""The figures of a result: what an engineer checks by eye on meshes, bearings and oil.

Figures are dataclass fields that carry their label and unit, so that tables, JSON and sweeps read
them from one place.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from epicyclic.losses.contact import MeshContact
from epicyclic.losses.planet_bearing import RollerLoads
from epicyclic.pocketing.similarity import FLOW_NUMBERS
from epicyclic.units import (
    CELSIUS,
    DEGREE,
    GIGAPASCAL,
    KELVIN,
    KILOGRAM_PER_CUBIC_METRE,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    MILLIPASCAL_SECOND,
    NEWTON,
    NEWTON_METRE,
    NEWTON_PER_MM,
    NEWTON_PER_UM,
    NUMBER,
    PER_GIGAPASCAL,
    RPM,
    SQUARE_MM_PER_SECOND,
    WATT_PER_KELVIN,
    Quantity,
)

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def figure(label: str, unit: Quantity) -> Any:
    """A field of a dataclass that carries its label and unit."""
    return dataclasses.field(metadata={"label": label, "unit": unit})


@dataclass(frozen=True, slots=True)
class Figure:
    """One number for the user, in its display unit; the unit of a pure number is ``"1"``."""

    key: str
    label: str
    value: float
    unit: str


class Figures(Mapping[str, "DataclassInstance"]):
    """Figures by what they describe, found when somebody reads them.

    Most answers of an element are steps on the way to the last one, of which alone anybody does.
    """

    __slots__ = ("_finds", "_found")

    def __init__(self, finds: Mapping[str, Callable[[], DataclassInstance]]) -> None:
        self._finds = finds
        self._found: dict[str, DataclassInstance] = {}

    def __getitem__(self, key: str) -> DataclassInstance:
        if key not in self._found:
            self._found[key] = self._finds[key]()
        return self._found[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._finds)

    def __len__(self) -> int:
        return len(self._finds)


def figures(source: DataclassInstance) -> Iterator[Figure]:
    """The labelled numbers of a dataclass."""
    for field in dataclasses.fields(source):
        if "label" in field.metadata:
            label, unit = field.metadata["label"], field.metadata["unit"]
            yield Figure(field.name, label, displayed(source, field), unit.display or "1")


def displayed(source: DataclassInstance, field: dataclasses.Field[Any]) -> float:
    """A labelled number of a dataclass in its display unit."""
    unit: Quantity = field.metadata["unit"]
    value: float = getattr(source, field.name)
    return unit.to_display(value) if unit.si else value


@dataclass(frozen=True, slots=True, eq=False)
class MeshFigures:
    """What an engineer checks by eye on a mesh; NaN where there is no load or no motion.

    The largest line load and pressure leave out the 1 % of the contact that carries most: in the
    corners of a helical face without end relief the load has no bound, and its largest value would
    be that of the resolution.

    Transmission error and stiffness, in the transverse plane of action, are those of elastic teeth
    and NaN with another load distribution.

    `flattening` is the half-width of the contact that is pressed with `hertz_pressure_max` over its
    radius, `resistance` the loss over what the load could resist with at the speeds of both flanks,
    a mean coefficient of friction: numbers above 1 cannot be.
    """

    contact: MeshContact | None
    flattening: float
    resistance: float
    pressure_angle: float = figure("operating pressure angle, transverse", DEGREE)
    transverse_contact_ratio: float = figure("transverse contact ratio", NUMBER)
    overlap_ratio: float = figure("overlap ratio", NUMBER)
    backlash: float = figure("circumferential backlash", MILLIMETRE)
    misalignment: float = figure("misalignment, with tilt of the planet if coupled", MICROMETRE)
    pitch_line_speed: float = figure("pitch-line speed, relative to carrier", METRE_PER_SECOND)
    sliding_speed_max: float = figure("largest sliding speed", METRE_PER_SECOND)
    line_load_max: float = figure("largest line load but for 1 % of the contact", NEWTON_PER_MM)
    hertz_pressure_max: float = figure(
        "largest Hertz pressure but for 1 % of the contact", GIGAPASCAL
    )
    contact_share: float = figure("share of the contact lines that carries", NUMBER)
    film_ratio_min: float = figure("film ratio, smallest", NUMBER)
    film_ratio_max: float = figure("film ratio, largest", NUMBER)
    friction_mean: float = figure("mean coefficient of friction", NUMBER)
    loss_factor: float = figure("loss factor H_V (Ohlendorf)", NUMBER)
    transmission_error_range: float = figure("loaded transmission error, peak to peak", MICROMETRE)
    mesh_stiffness: float = figure("mean mesh stiffness at this load", NEWTON_PER_UM)
    pocket_pressure_max: float = figure(*FLOW_NUMBERS["pressure_max"])
    pocket_pressure_min: float = figure(*FLOW_NUMBERS["pressure_min"])
    pocket_speed_max: float = figure(*FLOW_NUMBERS["speed_max"])
    pocket_power_difference: float = figure(*FLOW_NUMBERS["difference"])
    pocket_interpolation_error: float = figure(
        "pocketing loss: largest error of its interpolation", NUMBER
    )
    contact_temperature: float = figure("oil where it enters the contacts", CELSIUS)
    flash_temperature_mean: float = figure("flash temperature, mean over the load", KELVIN)
    flash_temperature_max: float = figure("flash temperature, largest", KELVIN)


@dataclass(frozen=True, slots=True, eq=False)
class BearingFigures:
    """What an engineer checks by eye on the planet bearing.

    `flattening` and `resistance` as of `MeshFigures`, the latter at the speed of the pitch circle.
    """

    loads: RollerLoads | None
    flattening: float
    resistance: float
    radial_force: float = figure("radial force", NEWTON)
    moment: float = figure("tilting moment", NEWTON_METRE)
    speed: float = figure("speed relative to carrier", RPM)
    rollers_loaded: float = figure("loaded rollers, all rows", NUMBER)
    roller_load_max: float = figure("most loaded roller", NEWTON)
    roller_azimuth: float = figure("azimuth of that roller from the load", DEGREE)
    hertz_pressure_max: float = figure("largest Hertz pressure, inner race", GIGAPASCAL)
    contact_temperature: float = figure("oil where it enters the contacts", CELSIUS)
    heat_conductance: float = figure("heat from race to race through the rollers", WATT_PER_KELVIN)


@dataclass(frozen=True, slots=True, eq=False)
class FluidFigures:
    """Properties of the oil at its inlet temperature, and of its mixture with air."""

    kinematic_viscosity: float = figure("kinematic viscosity of the oil", SQUARE_MM_PER_SECOND)
    dynamic_viscosity: float = figure("dynamic viscosity of the oil", MILLIPASCAL_SECOND)
    density: float = figure("density of the oil", KILOGRAM_PER_CUBIC_METRE)
    pressure_viscosity: float = figure("pressure-viscosity coefficient", PER_GIGAPASCAL)
    mixture_density: float = figure("density of the air-oil mixture", KILOGRAM_PER_CUBIC_METRE)
    mixture_viscosity: float = figure(
        "dynamic viscosity of the air-oil mixture", MILLIPASCAL_SECOND
    )
