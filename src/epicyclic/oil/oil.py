"""An oil as data, and its properties at a temperature."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Annotated, Any, Literal, TypeVar, cast

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from epicyclic.arrays import FloatArray, log, pow
from epicyclic.dataclass import dataclass
from epicyclic.units import (
    CELSIUS,
    SQUARE_MM_PER_SECOND,
    KinematicViscosity,
    Number,
    PressureViscosity,
    Quantity,
    Temperature,
)

# An oil as data: what a file of the oil library or a table in a case states about it.


STEEPEST_DENSITY = -2.0
"""Oils lose 0.6 to 0.8 kg/m^3 for each kelvin; steeper lines may end below zero. [kg/(m^3 K)]"""
STEEPEST_VISCOSITY = 15.0  # Slope of ASTM D341, three times that of any lubricant. [1]

OilDensity = Annotated[
    float, Quantity("a density of an oil", "kg/m^3", "kg/m^3", low=600.0, high=3000.0)
]


class _Data(BaseModel):
    model_config = ConfigDict(
        frozen=True, extra="forbid", validate_default=True, allow_inf_nan=False, defer_build=True
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


class Traction(_Data):
    """A coefficient of friction of an oil, with its source."""

    value: Number = Field(gt=0, le=0.2)
    source: str = ""


ARANA = "after Arana, Larranaga, Ulacia, Proc. IMechE J 233 (2019) 303"
LIMITING_TRACTION = {
    "mineral": Traction(value=0.047, source=f"paraffinic mineral oil, {ARANA}"),
    "atf": Traction(value=0.047, source=f"as paraffinic mineral oil, {ARANA}"),
    "pao": Traction(value=0.035, source=f"polyalphaolefin, {ARANA}"),
    "ester": Traction(value=0.035, source="estimate: as polyalphaolefin"),
    "pag": Traction(value=0.03, source="estimate: a little below polyalphaolefin"),
}
"""What an oil has that states none, by its kind."""
BOUNDARY_FRICTION = {
    "gear-oil": Traction(
        value=0.0675, source=f"middle of 0.065 to 0.07 of FZG gears in gear oils, {ARANA}"
    ),
    "none": Traction(value=0.08, source=f"Robbe-Valloire, {ARANA}"),
}
"""Friction of flanks that touch, by the level of additives. [1]"""


LUBRICANT_FACTORS = {
    kind: LubricantFactor(value=value, source=f"X_L of ISO/TR 14179-2 for {oils}, second hand")
    for kind, value, oils in (
        ("mineral", 1.0, "mineral oils"),
        ("pao", 0.8, "polyalphaolefins and esters"),
        ("ester", 0.8, "polyalphaolefins and esters"),
        ("pag", 0.75, "polyglycols"),
        ("atf", 1.0, "mineral oils, taken over for transmission fluids"),
    )
}
"""X_L by the kind of an oil that does not state it. Theory (F15). The standard has 1.3 for
phosphoric esters and 1.5 for traction fluids too, which are no kinds here."""


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
        default=cast("Any", ("0 degC", "120 degC")),  # read like any value
        description="Range in which the values are valid.",
    )
    kinematic_viscosity: tuple[ViscosityPoint, ...] = Field(min_length=2)
    density: tuple[DensityPoint, ...] = Field(min_length=1)
    density_slope: DensitySlope = Field(
        default=DensitySlope(value=-0.65, source="typical of mineral oils and PAO"),
        description="d(density)/dT in kg/(m^3 K), used with a single density.",
    )
    pressure_viscosity: PressureViscosityLaw
    lubricant_factor: LubricantFactor = Field(
        default=LUBRICANT_FACTORS["mineral"],
        description="X_L of the friction model of ISO/TR 14179-2. Default: by the kind.",
    )
    limiting_traction: Traction | None = Field(
        default=None,
        description="Shear stress over pressure that a film tends to. Default: by the kind.",
    )
    additives: Literal["gear-oil", "none"] = Field(
        default="gear-oil",
        description="Package against wear and scuffing, by which flanks that touch rub less.",
    )
    friction_regression: Literal["talbot-2012", "xu-2007"] | None = Field(
        default=None, description="Regressions that were made for this oil or for its grade."
    )
    thermal_conductivity: SourcedConductivity | None = None
    specific_heat_capacity: SourcedHeatCapacity | None = None

    @model_validator(mode="after")
    def _check_points(self) -> Oil:
        faults: list[InitErrorDetails] = []
        remedy, viscosities = "correct one of the two points", self.kinematic_viscosity
        for first, second in _neighbours(viscosities):
            colder, warmer = viscosities[first], viscosities[second]
            if warmer.temperature == colder.temperature:
                faults.append(_repeated("kinematic_viscosity", first, second, warmer.temperature))
                continue
            logs = [math.log(it.value / MM2_PER_S + D341_OFFSET) for it in (colder, warmer)]
            slope = math.log(logs[0] / logs[1]) / math.log(warmer.temperature / colder.temperature)
            if not 0 < slope <= STEEPEST_VISCOSITY:
                shown, other = map(SQUARE_MM_PER_SECOND.text, (warmer.value, colder.value))
                what = "must fall with rising temperature as that of an oil does, but at "
                what += f"{CELSIUS.text(colder.temperature)} it is {other}"
                faults.append(_fault(("kinematic_viscosity", second, "value"), shown, what, remedy))
        for first, second in _neighbours(self.density):
            cold, warm = self.density[first], self.density[second]
            if warm.temperature == cold.temperature:
                faults.append(_repeated("density", first, second, warm.temperature))
                continue
            slope = (warm.value - cold.value) / (warm.temperature - cold.temperature)
            if not STEEPEST_DENSITY <= slope <= 0:
                place, shown = ("density", second, "value"), f"{warm.value:g} kg/m^3"
                what = "must fall with rising temperature, by at most 2 kg/(m^3 K)"
                faults.append(_fault(place, shown, what, remedy))
        for first, second in _neighbours(points := getattr(self.pressure_viscosity, "point", ())):
            if (warmer := points[second].temperature) == points[first].temperature:
                faults.append(_repeated("pressure_viscosity.point", first, second, warmer))
        low, high = self.temperature_range
        if low >= high:
            shown = f"{CELSIUS.text(low)} to {CELSIUS.text(high)}"
            remedy = "give the lower temperature first"
            faults.append(_fault(("temperature_range",), shown, "must rise", remedy))
        if faults:
            raise ValidationError.from_exception_data(self.name, faults)
        if "lubricant_factor" not in self.model_fields_set:
            self.__dict__["lubricant_factor"] = LUBRICANT_FACTORS[self.kind]
        return self

    def __hash__(self) -> int:  # of what tells oils apart: it is asked for at each temperature
        return hash((self.name, *(point.value for point in self.kinematic_viscosity)))


def _neighbours(points: Sequence[Any]) -> Iterator[tuple[int, int]]:
    """Indices of points next to each other in temperature, the colder one first."""
    return pairwise(sorted(range(len(points)), key=lambda index: points[index].temperature))


def _repeated(name: str, first: int, second: int, kelvin: float) -> InitErrorDetails:
    what, remedy = f"repeats the temperature {name}[{first}]", "give one value for each temperature"
    return _fault((*name.split("."), second, "temperature"), CELSIUS.text(kelvin), what, remedy)


def _fault(place: tuple[str | int, ...], given: str, what: str, remedy: str) -> InitErrorDetails:
    error = PydanticCustomError("oil", "{what}", {"what": what, "remedy": remedy})
    return InitErrorDetails(type=error, loc=place, input=given)


# Properties of an oil at temperature, and of its mixture with air.
#
# ==================== =========================================================================
# property             source
# ==================== =========================================================================
# kinematic viscosity  ASTM D341: log log(nu + 0.7) linear in log T, nu in mm^2/s
# density              linear in temperature
# pressure-viscosity   Gold et al. (2001), or Roelands (1966): alpha = z (ln mu + 9.67)/1.96e8
# air                  ideal gas; Sutherland's law for its viscosity
# mixture density      by volume; mixture viscosity by mass (Cicchitti et al. 1960)
# ==================== =========================================================================


Real = TypeVar("Real", float, FloatArray)

ROELANDS_PRESSURE = 1.96e8  # Pole pressure of Roelands' viscosity law. [Pa]
ROELANDS_OFFSET = 9.67
"""ln of Roelands' limiting viscosity 6.31e-5 Pa s, with its sign changed. [1]"""
AIR_GAS_CONSTANT = 287.05  # Specific gas constant of dry air (ISO 2533). [J/(kg K)]
SUTHERLAND_CONSTANT = 1.458e-6  # beta_s in mu = beta_s T^1.5/(T + S) (ISO 2533). [kg/(m s K^0.5)]
SUTHERLAND_TEMPERATURE = 110.4  # S in Sutherland's law for air (ISO 2533). [K]
D341_OFFSET = 0.7
"""Constant added to the viscosity in mm^2/s; D341 adds further terms below 2 mm^2/s. [mm^2/s]"""
D341_HIGHEST = 2e7  # Largest viscosity of D341. Colder oil, which hardly flows, keeps it. [mm^2/s]
LARGEST_EXPONENT = 2.0
"""10^(10^2) mm^2/s: far beyond what is held, and still a number that can be written."""
MM2_PER_S = 1e-6  # 1 mm^2/s in m^2/s.
DEFAULT_CONDUCTIVITY = 0.14
"""Thermal conductivity of an oil that states none: typical of hydrocarbons. [W/(m K)]"""
SLOPE_STEP = 0.5  # Temperature step of the slope of the viscosity. [K]


@dataclass(frozen=True, slots=True)
class OilState:
    """Oil at one temperature and ambient pressure."""

    pointwise = True

    temperature: float  # [K]
    kinematic_viscosity: float  # [m^2/s]
    density: float  # [kg/m^3]
    dynamic_viscosity: float  # [Pa s]
    pressure_viscosity: float  # alpha of d(ln mu)/dp at ambient pressure. [1/Pa]
    thermoviscosity: float  # beta = -d(ln nu)/dT. [1/K]
    thermal_conductivity: float  # [W/(m K)]
    lubricant_factor: float  # X_L of ISO/TR 14179-2. [1]
    pressure_viscosity_exponent: float  # d(ln alpha)/d(ln nu). [1]
    limiting_traction: float  # Lambda, of the shear stress at high pressure. [1]
    boundary_friction: float  # mu_b, of asperities. [1]

    @property
    def d341_slope(self) -> float:
        """-d(log log(nu + 0.7))/d(log T) of the line of ASTM D341 that touches here. [1]"""
        nu = self.kinematic_viscosity / MM2_PER_S
        shifted = nu + D341_OFFSET
        return self.temperature * self.thermoviscosity * nu / (shifted * log(shifted))

    def thermal_load(self, speed: Real) -> Real:
        """mu beta u^2/k of an inlet with this rolling speed. Theory (R6). [1]"""
        return self.dynamic_viscosity * self.thermoviscosity * speed**2 / self.thermal_conductivity


@dataclass(frozen=True, slots=True)
class MixtureState:
    """Mixture of oil and air around the gears."""

    pointwise = True

    oil_fraction: float  # xi, by volume at ambient pressure. [1]
    density: float  # [kg/m^3]
    dynamic_viscosity: float  # [Pa s]

    @property
    def kinematic_viscosity(self) -> float:
        """mu/rho. Theory (L10). [m^2/s]"""
        return self.dynamic_viscosity / self.density


@lru_cache(maxsize=256)
def oil_state(oil: Oil, temperature: float) -> OilState:
    """Properties of `oil` at `temperature` in kelvin. Theory (L3), (L6)."""
    nu = _kinematic_viscosity(oil, temperature)
    rho = _density(oil, temperature)
    alpha, exponent = _pressure_viscosity(oil, temperature, nu, rho * nu)
    colder = _kinematic_viscosity(oil, temperature - SLOPE_STEP)
    warmer = _kinematic_viscosity(oil, temperature + SLOPE_STEP)
    conductivity = oil.thermal_conductivity
    return OilState(
        temperature=temperature,
        kinematic_viscosity=nu,
        density=rho,
        dynamic_viscosity=rho * nu,
        pressure_viscosity=alpha,
        thermoviscosity=math.log(colder / warmer) / (2 * SLOPE_STEP),  # (L6)
        thermal_conductivity=DEFAULT_CONDUCTIVITY if conductivity is None else conductivity.value,
        lubricant_factor=oil.lubricant_factor.value,
        pressure_viscosity_exponent=exponent,
        limiting_traction=(oil.limiting_traction or LIMITING_TRACTION[oil.kind]).value,
        boundary_friction=BOUNDARY_FRICTION[oil.additives].value,
    )


def mixture_state(oil: OilState, oil_fraction: float, pressure: float) -> MixtureState:
    """Oil at `oil_fraction` by volume, the rest air at the oil's temperature and `pressure`.

    Theory (L7), (L8). The rules reproduce the densities and viscosities printed in Talbot (2012),
    p. 139, to the last digit: density by volume, viscosity weighted by mass (Cicchitti et al.
    1960).
    """
    air_density = pressure / (AIR_GAS_CONSTANT * oil.temperature)
    density = oil_fraction * oil.density + (1 - oil_fraction) * air_density
    oil_mass = oil_fraction * oil.density / density
    viscosity = oil_mass * oil.dynamic_viscosity + (1 - oil_mass) * air_viscosity(oil.temperature)
    return MixtureState(oil_fraction, density, viscosity)


def air_viscosity(temperature: float) -> float:
    """Dynamic viscosity of air, Sutherland's law, 100 to 1900 K. ISO 2533. Theory (L9). [Pa s]"""
    return SUTHERLAND_CONSTANT * pow(temperature, 1.5) / (temperature + SUTHERLAND_TEMPERATURE)


def _kinematic_viscosity(oil: Oil, temperature: float) -> float:
    """`extrapolated_viscosity`, held at the largest one of D341. Theory (L1). [m^2/s]"""
    return min(extrapolated_viscosity(oil, temperature), D341_HIGHEST * MM2_PER_S)


def extrapolated_viscosity(oil: Oil, temperature: float) -> float:
    """ASTM D341 between neighbouring points, and beyond the outermost two. Theory (L1). [m^2/s]"""
    points = sorted(oil.kinematic_viscosity, key=lambda point: point.temperature)
    y = _piecewise_line(
        math.log10(temperature),
        [math.log10(point.temperature) for point in points],
        [math.log10(math.log10(point.value / MM2_PER_S + D341_OFFSET)) for point in points],
    )
    return float((10 ** (10 ** min(y, LARGEST_EXPONENT)) - D341_OFFSET) * MM2_PER_S)


def _density(oil: Oil, temperature: float) -> float:
    """Density. Theory (L2). [kg/m^3]"""
    points = sorted(oil.density, key=lambda point: point.temperature)
    if len(points) == 1:
        return points[0].value + oil.density_slope.value * (temperature - points[0].temperature)
    return _piecewise_line(
        temperature, [point.temperature for point in points], [point.value for point in points]
    )


def _pressure_viscosity(oil: Oil, temperature: float, nu: float, mu: float) -> tuple[float, float]:
    """Pressure-viscosity coefficient alpha and d(ln alpha)/d(ln nu), density and index z held.

    Theory (L4), (L5). [1/Pa], [1]
    """
    law = oil.pressure_viscosity
    if isinstance(law, GoldLaw):
        return law.s * math.pow(nu / MM2_PER_S, law.t) * 1e-9, law.t
    # z, linear between the points of the law and constant beyond them: (L5)
    index = float(np.interp(temperature, *_roelands_points(oil)))
    # alpha/z = (ln mu + 9.67)/1.96e8 with mu in Pa s
    slope = math.log(mu) + ROELANDS_OFFSET
    return index * (slope / ROELANDS_PRESSURE), 1 / slope


@lru_cache(maxsize=64)
def _roelands_points(oil: Oil) -> tuple[list[float], list[float]]:
    """Temperatures and indices z of the points of an oil. Theory (L5)."""
    law = cast(RoelandsLaw, oil.pressure_viscosity)
    points = sorted(law.point, key=lambda point: point.temperature)
    index = []
    for point in points:
        mu = _kinematic_viscosity(oil, point.temperature) * _density(oil, point.temperature)
        index.append(point.value / ((math.log(mu) + ROELANDS_OFFSET) / ROELANDS_PRESSURE))
    return [point.temperature for point in points], index


def _piecewise_line(x: float, xs: list[float], ys: list[float]) -> float:
    """Straight lines through the points, the outermost ones continued beyond them."""
    upper = min(max(1, bisect_left(xs, x)), len(xs) - 1)
    slope = (ys[upper] - ys[upper - 1]) / (xs[upper] - xs[upper - 1])
    return ys[upper] + slope * (x - xs[upper])
