"""An oil as data: what a file of the oil library or a table in a case states about it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from epicyclic.units import (
    CELSIUS,
    SQUARE_MM_PER_SECOND,
    KinematicViscosity,
    Number,
    PressureViscosity,
    Quantity,
    Temperature,
    as_stated,
)

STEEPEST_DENSITY = -2.0
"""Oils lose 0.6 to 0.8 kg/m^3 for each kelvin; steeper lines may end below zero. [kg/(m^3 K)]"""

OilDensity = Annotated[
    float, Quantity("a density of an oil", "kg/m^3", "kg/m^3", low=600.0, high=3000.0)
]


class _Data(BaseModel):
    model_config = ConfigDict(
        frozen=True, extra="forbid", validate_default=True, allow_inf_nan=False
    )


class ViscosityPoint(_Data):
    """Measured kinematic viscosity at one temperature."""

    temperature: Temperature
    value: KinematicViscosity
    source: str = ""


class DensityPoint(_Data):
    """Density at one temperature."""

    temperature: Temperature
    value: OilDensity
    source: str = ""


class PressureViscosityPoint(_Data):
    """Pressure-viscosity coefficient at one temperature."""

    temperature: Temperature
    value: PressureViscosity


class DensitySlope(_Data):
    """Change of the density with temperature, in kg/(m^3 K), with its source."""

    value: float = Field(ge=STEEPEST_DENSITY, le=0)
    source: str = ""


class LubricantFactor(_Data):
    """X_L of the mean friction of gear tests, with its source."""

    value: Number = Field(gt=0, le=2)
    source: str = ""


class GoldLaw(_Data):
    """alpha = s nu^t with nu in mm^2/s and alpha in 1/GPa (Gold et al. 2001). Theory (L4)."""

    law: Literal["gold"]
    s: float = Field(gt=0, le=60)
    t: float = Field(ge=0, le=1)
    calibrated: bool = False
    source: str = ""


class RoelandsLaw(_Data):
    """alpha = z (ln mu + 9.67)/1.96e8, the index z linear between the given points. Theory (L5)."""

    law: Literal["roelands"]
    point: tuple[PressureViscosityPoint, ...] = Field(min_length=1)
    calibrated: bool = False
    source: str = ""


PressureViscosityLaw = Annotated[GoldLaw | RoelandsLaw, Field(discriminator="law")]

Conductivity = Annotated[
    float, Quantity("a thermal conductivity", "W/(m*K)", "W/(m*K)", low=0.0, open_low=True)
]
HeatCapacity = Annotated[
    float, Quantity("a specific heat capacity", "J/(kg*K)", "J/(kg*K)", low=0.0, open_low=True)
]


class SourcedConductivity(_Data):
    """Thermal conductivity with its source."""

    value: Conductivity
    source: str = ""


class SourcedHeatCapacity(_Data):
    """Specific heat capacity with its source."""

    value: HeatCapacity
    source: str = ""


class Oil(_Data):
    """A lubricating oil.

    Two or more kinematic viscosities, one or more densities, a pressure-viscosity law. With one
    density, `density_slope` gives its change with temperature.
    """

    name: str = "custom"
    title: str = "oil of the case"
    kind: Literal["mineral", "pao", "ester", "pag", "atf"]
    description: str = ""
    temperature_range: tuple[Temperature, Temperature] = Field(
        default=as_stated(("0 degC", "120 degC")), description="Where the values are meant to hold."
    )
    kinematic_viscosity: tuple[ViscosityPoint, ...] = Field(min_length=2)
    density: tuple[DensityPoint, ...] = Field(min_length=1)
    density_slope: DensitySlope = Field(
        default=DensitySlope(value=-0.65, source="typical of mineral oils and PAO"),
        description="d(density)/dT in kg/(m^3 K), used with a single density.",
    )
    pressure_viscosity: PressureViscosityLaw
    lubricant_factor: LubricantFactor = Field(
        default=LubricantFactor(value=1.0, source="X_L of ISO/TR 14179-2, mineral oil"),
        description="X_L of the friction model of ISO/TR 14179-2.",
    )
    friction_regression: Literal["talbot-2012", "xu-2007"] | None = Field(
        default=None,
        description="The regressions that were made for this oil, or for one of its grade.",
    )
    thermal_conductivity: SourcedConductivity | None = None
    specific_heat_capacity: SourcedHeatCapacity | None = None

    @model_validator(mode="after")
    def _check_points(self) -> Oil:
        faults = [*self._viscosity_faults(), *self._density_faults(), *self._range_faults()]
        if faults:
            raise ValidationError.from_exception_data(self.name, faults)
        return self

    def _viscosity_faults(self) -> Iterator[InitErrorDetails]:
        for first, second in _neighbours(self.kinematic_viscosity):
            colder, warmer = self.kinematic_viscosity[first], self.kinematic_viscosity[second]
            if warmer.temperature == colder.temperature:
                yield _repeated("kinematic_viscosity", first, second, warmer.temperature)
            elif warmer.value >= colder.value:
                yield _fault(
                    ("kinematic_viscosity", second, "value"),
                    SQUARE_MM_PER_SECOND.text(warmer.value),
                    "must fall with rising temperature; at "
                    f"{CELSIUS.text(colder.temperature)} it is "
                    f"{SQUARE_MM_PER_SECOND.text(colder.value)}",
                    "correct one of the two points",
                )

    def _density_faults(self) -> Iterator[InitErrorDetails]:
        for first, second in _neighbours(self.density):
            colder, warmer = self.density[first], self.density[second]
            if warmer.temperature == colder.temperature:
                yield _repeated("density", first, second, warmer.temperature)
                continue
            slope = (warmer.value - colder.value) / (warmer.temperature - colder.temperature)
            if not STEEPEST_DENSITY <= slope <= 0:
                yield _fault(
                    ("density", second, "value"),
                    f"{warmer.value:g} kg/m^3",
                    "must fall with rising temperature, by 2 kg/(m^3 K) at most",
                    "correct one of the two points",
                )

    def _range_faults(self) -> Iterator[InitErrorDetails]:
        low, high = self.temperature_range
        if low >= high:
            yield _fault(
                ("temperature_range",),
                f"{CELSIUS.text(low)} to {CELSIUS.text(high)}",
                "must rise",
                "give the lower temperature first",
            )


def _neighbours(points: Sequence[ViscosityPoint | DensityPoint]) -> Iterator[tuple[int, int]]:
    """Indices of points next to each other in temperature, the colder one first."""
    return pairwise(sorted(range(len(points)), key=lambda index: points[index].temperature))


def _repeated(name: str, first: int, second: int, temperature: float) -> InitErrorDetails:
    return _fault(
        (name, second, "temperature"),
        CELSIUS.text(temperature),
        f"is that of {name}[{first}] too",
        "give one value for each temperature",
    )


def _fault(place: tuple[str | int, ...], given: str, what: str, remedy: str) -> InitErrorDetails:
    error = PydanticCustomError("oil", "{what}", {"what": what, "remedy": remedy})
    return InitErrorDetails(type=error, loc=place, input=given)
