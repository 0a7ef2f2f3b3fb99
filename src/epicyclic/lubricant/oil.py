"""An oil as data: what a file of the oil library or a table in a case states about it."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Any, Literal, cast

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from epicyclic.units import Density, KinematicViscosity, PressureViscosity, Quantity, Temperature

__all__ = ["Oil"]


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
    value: Density
    source: str = ""


class PressureViscosityPoint(_Data):
    """Pressure-viscosity coefficient at one temperature."""

    temperature: Temperature
    value: PressureViscosity


class SourcedNumber(_Data):
    """A plain number with its source."""

    value: float
    source: str = ""


class GoldLaw(_Data):
    """alpha = s nu^t with nu in mm^2/s and alpha in 1/GPa (Gold et al. 2001). Theory (L4)."""

    law: Literal["gold"]
    s: float = Field(gt=0)
    t: float = Field(ge=0)
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
        default=cast("Any", ("0 degC", "120 degC")),
        description="Where the values are meant to hold.",
    )
    kinematic_viscosity: tuple[ViscosityPoint, ...] = Field(min_length=2)
    density: tuple[DensityPoint, ...] = Field(min_length=1)
    density_slope: SourcedNumber = Field(
        default=SourcedNumber(value=-0.65, source="typical of mineral oils and PAO"),
        description="d(density)/dT in kg/(m^3 K), used with a single density.",
    )
    pressure_viscosity: PressureViscosityLaw
    lubricant_factor: SourcedNumber = Field(
        default=SourcedNumber(value=1.0, source="X_L of ISO/TR 14179-2, mineral oil"),
        description="X_L of the friction model of ISO/TR 14179-2.",
    )
    friction_regression: Literal["talbot-2012"] | None = Field(
        default=None, description="The mixed-EHL regression that was made for this oil."
    )
    thermal_conductivity: SourcedConductivity | None = None
    specific_heat_capacity: SourcedHeatCapacity | None = None

    @model_validator(mode="after")
    def _check_points(self) -> Oil:
        viscosity = sorted(self.kinematic_viscosity, key=lambda point: point.temperature)
        for colder, warmer in pairwise(viscosity):
            if warmer.temperature == colder.temperature:
                raise PydanticCustomError(
                    "oil", "kinematic_viscosity has two values at one temperature"
                )
            if warmer.value >= colder.value:
                raise PydanticCustomError(
                    "oil", "kinematic_viscosity must fall with rising temperature"
                )
        if self.temperature_range[0] >= self.temperature_range[1]:
            raise PydanticCustomError("oil", "temperature_range must rise")
        return self
