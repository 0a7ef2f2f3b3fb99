"""Heat transfer from what turns, from oil to walls, and from the housing to its surroundings."""

from __future__ import annotations

import math

import numpy as np

from epicyclic.arrays import FloatArray, between, pow, sqrt, total
from epicyclic.dataclass import dataclass
from epicyclic.oil.oil import AIR_GAS_CONSTANT, MixtureState, air_viscosity

# How oil, air and their mixture conduct and store heat.


AIR_HEAT_CAPACITY = 1004.7  # 3.5 R of dry air, ISO 2533. [J/(kg K)]
KELVIN = 273.15  # 0 degC in kelvin.

GRAVITY_TEMPERATURE = 288.75  # 15.6 degC, at which the specific gravity of petroleum is stated. [K]
WATER = 999.0  # Density of water there. [kg/m^3]


@dataclass(frozen=True, slots=True)
class Fluid:
    """What heat transfer to a fluid depends on."""

    pointwise = True

    density: float  # [kg/m^3]
    dynamic_viscosity: float  # [Pa s]
    conductivity: float  # [W/(m K)]
    heat_capacity: float  # At constant pressure. [J/(kg K)]

    @property
    def kinematic_viscosity(self) -> float:
        """mu/rho. [m^2/s]"""
        return self.dynamic_viscosity / self.density

    @property
    def prandtl(self) -> float:
        """Pr = mu c_p/lambda. [1]"""
        return self.dynamic_viscosity * self.heat_capacity / self.conductivity


def oil_conductivity(
    temperature: float,  # [K]
    # Density at 15.6 degC over that of water at the same temperature, 999 kg/m^3. [1]
    specific_gravity: float,
) -> float:
    """Thermal conductivity of a petroleum oil. Theory (W22). [W/(m K)]

    C. S. Cragoe, Natl. Bur. Stand. Misc. Publ. 97 (1929), second hand; petroleum liquids from 0 to
    200 degC, of specific gravity 0.75 to 0.95. Within 10 %.

    Examples
    --------
    >>> round(oil_conductivity(333.15, 0.87), 4)
    0.1303
    """
    return 0.1172 * (1 - 0.00054 * (temperature - KELVIN)) / specific_gravity


def oil_heat_capacity(temperature: float, specific_gravity: float) -> float:
    """Specific heat capacity of a petroleum oil. Theory (W22). [J/(kg K)]

    Cragoe (1929), second hand; source, range and parameters as for `oil_conductivity`. Within 4 %.

    Examples
    --------
    >>> round(oil_heat_capacity(333.15, 0.87))
    2025
    """
    return (1685 + 3.4 * (temperature - KELVIN)) / math.sqrt(specific_gravity)


def air(temperature: float, pressure: float) -> Fluid:
    """Dry air at `temperature` [K] and `pressure` [Pa]. Theory (W23).

    Ideal gas, viscosity by Sutherland's law, ISO 2533.

    Examples
    --------
    >>> dry = air(293.15, 101325.0)
    >>> round(1e6 * dry.kinematic_viscosity, 2), round(dry.prandtl, 3)
    (15.06, 0.708)
    """
    return Fluid(
        density=pressure / (AIR_GAS_CONSTANT * temperature),
        dynamic_viscosity=air_viscosity(temperature),
        conductivity=air_conductivity(temperature),
        heat_capacity=AIR_HEAT_CAPACITY,
    )


def air_conductivity(temperature: float) -> float:
    """Thermal conductivity of air at `temperature` [K], ISO 2533. Theory (W23). [W/(m K)]

    General knowledge, 100 to 1900 K as the viscosity.

    Examples
    --------
    >>> round(air_conductivity(288.15), 5)
    0.02534
    """
    drop = 245.4 * math.pow(10, -12 / temperature)
    return 2.648151e-3 * math.pow(temperature, 1.5) / (temperature + drop)


def mixture(oil: Fluid, air: Fluid, state: MixtureState) -> Fluid:
    """Mixture of `oil` and `air` with density and viscosity of `state`. Theory (W24).

    Heat capacity by mass, which is exact; conductivity by volume, an upper bound.

    Examples
    --------
    >>> oil = Fluid(850.0, 10e-3, 0.13, 2000.0)
    >>> wet = mixture(oil, air(363.15, 101325.0), MixtureState(0.05, 43.4, 9.79e-3))
    >>> round(wet.conductivity, 4), round(wet.heat_capacity)
    (0.036, 1979)
    """
    volume = state.oil_fraction
    mass = volume * oil.density / state.density
    return Fluid(
        density=state.density,
        dynamic_viscosity=state.dynamic_viscosity,
        conductivity=volume * oil.conductivity + (1 - volume) * air.conductivity,
        heat_capacity=mass * oil.heat_capacity + (1 - mass) * air.heat_capacity,
    )


# Heat transfer from what turns: discs, shafts, gears in an oil bath; through loaded rollers.

TRANSITION_REYNOLDS = 2.4e5  # omega r^2/nu at which the flow on a disc turns turbulent. [1]


def disc_coefficient(
    fluid: Fluid,
    speed: float,  # Against the fluid, of either sign. [rad/s]
    outer_radius: float,  # [m]
    inner_radius: float = 0.0,  # Inner radius of an annulus; 0 for a disc. [m]
) -> float:
    """Mean heat transfer coefficient of one face of a disc turning in a fluid at rest. [W/(m^2 K)]

    Theory (W17). Area mean of the laminar coefficient within the radius of transition and the
    turbulent one outside. The face is equally hot all over, the fluid around it free of walls.

    Examples
    --------
    A gear of 60 mm at 3000 rpm in air:

    >>> round(disc_coefficient(air(333.15, 101325.0), 314.16, 30e-3), 1)
    38.0
    """
    omega = abs(speed)
    if omega == 0:
        return 0.0
    transition = sqrt(TRANSITION_REYNOLDS * fluid.kinematic_viscosity / omega)
    middle: float = between(transition, inner_radius, outer_radius)
    laminar = _laminar_disc(fluid, omega) * (middle**2 - inner_radius**2)
    # 2 int h r dr of h ~ r^0.6
    outside = pow(outer_radius, 2.6) - pow(middle, 2.6)
    turbulent = _turbulent_disc(fluid, omega) * 2 / 2.6 * outside
    return (laminar + turbulent) / (outer_radius**2 - inner_radius**2)


def _laminar_disc(fluid: Fluid, omega: float) -> float:
    """Coefficient in laminar flow, the same at every radius. Theory (W15). [W/(m^2 K)]

    Departure: the last term of the denominator is added here, fitted to the exact solution.
    """
    root = pow(fluid.prandtl, -1 / 3)
    nusselt = 0.62048 / root / (1 + 0.2980 * root + 0.14514 * root**2 + 0.125 * root**3)
    return nusselt * fluid.conductivity * sqrt(omega / fluid.kinematic_viscosity)


def _turbulent_disc(fluid: Fluid, omega: float) -> float:
    """Coefficient in turbulent flow over r^0.6. Theory (W16). [W/(m^2.6 K)]"""
    nusselt = 0.0238 * pow(fluid.prandtl, 0.6)
    return nusselt * fluid.conductivity * pow(omega / fluid.kinematic_viscosity, 0.8)


def dipped_disc(fluid: Fluid, speed: float, diameter: float) -> float:
    """Heat transfer coefficient of the faces of a gear in an oil bath, Handschuh. [W/(m^2 K)]

    Theory (W20). Second hand; the formula of a plate across a flow, made for Reynolds numbers of
    4e3 to 1.5e4. Parameters and sense as for `disc_coefficient`.

    Examples
    --------
    >>> bath = Fluid(850.0, 20e-3, 0.13, 2000.0)
    >>> round(dipped_disc(bath, 100.0, 80e-3))
    2629
    """
    reynolds = abs(speed) * diameter**2 / (2 * fluid.kinematic_viscosity)
    nusselt = 0.228 * pow(reynolds, 0.731) * pow(fluid.prandtl, 1 / 3)
    return nusselt * fluid.conductivity / diameter


def roller_conductance(
    # inner_half_width, outer_half_width: Half-width of the Hertz contacts of each roller, or slice
    # of a roller. [m]
    inner_half_width: FloatArray,
    outer_half_width: FloatArray,
    length: FloatArray | float,  # Length of the same. [m]
    roller_diameter: float,  # [m]
    inner_pitch: float,  # Distance of neighbouring contacts along each race. [m]
    outer_pitch: float,  # Distance of neighbouring contacts along each race. [m]
    conductivity: float,  # Conductivity of races and rollers. [W/(m K)]
) -> float:
    """Heat from race to race through loaded rollers, by the temperature difference. [W/K]

    Theory (W21). Derived here: constriction of the heat in either race and in the roller, contacts
    at rest and dry. Rollers that touch one race only, with half-width 0, lead nothing.

    Examples
    --------
    Sixteen loaded needles of 2.5 mm by 20 mm:

    >>> width = np.full(16, 30e-6)
    >>> round(roller_conductance(width, width, 20e-3, 2.5e-3, 3e-3, 4e-3, 45.0), 2)
    2.59
    """
    loaded = (inner_half_width > 0) & (outer_half_width > 0)
    inner, outer = inner_half_width + ~loaded, outer_half_width + ~loaded  # logarithms of all
    races = np.log(inner_pitch / (math.pi * inner)) + np.log(outer_pitch / (math.pi * outer))
    roller = np.log(2 * roller_diameter / inner) + np.log(2 * roller_diameter / outer)
    resistance = (races + roller) / (math.pi * conductivity)
    return total(loaded * length / resistance)


# Heat that a gearbox gives to the air and to what it stands on: ISO/TR 14179-2 and -1.
#
# ISO/TR 14179-2 (after W. Funck, Diss. TU Muenchen, 1985) is second hand. Its coefficients are
# means over the outside of a housing in air at about 100 kPa.

SPLASHED_WALL = 200.0
"""Coefficient between the oil and the wall that it splashes, ISO/TR 14179-2. [W/(m^2 K)]"""
STANDARD_PRESSURE = 101325.0  # Standard pressure of the atmosphere. [Pa]
GRAVITY = 9.80665  # Standard acceleration of free fall. [m/s^2]


def free_convection(
    height: float,  # Height of the housing. [m]
    housing_temperature: float,  # [K]
    air_temperature: float,  # [K]
) -> float:
    """Coefficient of free convection from a housing, ISO/TR 14179-2. Theory (W9). [W/(m^2 K)]

    Examples
    --------
    >>> round(free_convection(0.5, 333.0, 293.0), 1)
    10.6
    """
    rise = abs(housing_temperature - air_temperature) / air_temperature
    return 18 * math.pow(height, -0.1) * math.pow(rise, 0.3)


def forced_convection(
    air_speed: float,  # [m/s]
    length: float,  # Length of the housing along the flow. [m]
    height: float,  # Height of the housing. [m]
    housing_temperature: float,  # [K]
    air_temperature: float,  # [K]
    pressure: float = STANDARD_PRESSURE,  # Pressure of the air. [Pa]
) -> float:
    """Coefficient of convection from a housing in moving air, ISO/TR 14179-2. [W/(m^2 K)]

    Theory (W10). The buoyancy of the warm air enters through the Reynolds number. Air has the
    temperature midway between housing and surroundings.

    Examples
    --------
    >>> round(forced_convection(3.0, 0.5, 0.5, 333.0, 293.0), 1)
    25.5
    """
    viscosity = air((housing_temperature + air_temperature) / 2, pressure).kinematic_viscosity
    reynolds = air_speed * length / viscosity
    rise = abs(housing_temperature - air_temperature) / air_temperature
    grashof = GRAVITY * height**3 * rise / viscosity**2
    mixed = math.sqrt(reynolds**2 + grashof / 2.5)
    return 0.0086 * math.pow(mixed, 0.64) / length


def radiation(
    emissivity: float,  # 0.9 painted, 0.15 to 0.25 bare aluminium, second hand. [1]
    housing_temperature: float,  # [K]
    air_temperature: float,  # [K]
) -> float:
    """Coefficient of radiation to surroundings as warm as the air, ISO/TR 14179-2. [W/(m^2 K)]

    Theory (W11).

    Examples
    --------
    >>> round(radiation(0.9, 333.0, 293.0), 1)
    6.3
    """
    return 0.23e-6 * emissivity * ((housing_temperature + air_temperature) / 2) ** 3
