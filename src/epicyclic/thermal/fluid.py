"""How oil, air and their mixture conduct and store heat."""

from __future__ import annotations

import math
from dataclasses import dataclass

from epicyclic.lubricant.properties import AIR_GAS_CONSTANT, MixtureState, air_viscosity

AIR_HEAT_CAPACITY = 1004.7
"""3.5 R of dry air, ISO 2533. [J/(kg K)]"""
KELVIN = 273.15
"""0 degC in kelvin."""


@dataclass(frozen=True, slots=True)
class Fluid:
    """What heat transfer to a fluid depends on."""

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
    """Thermal conductivity of a petroleum oil. [W/(m K)]

    Theory (W22).

    C. S. Cragoe, Natl. Bur. Stand. Misc. Publ. 97 (1929), second hand; petroleum liquids from 0 to
    200 degC, of specific gravity 0.75 to 0.95. Within 10 %.

    Examples
    --------
    >>> round(oil_conductivity(333.15, 0.87), 4)
    0.1303
    """
    return 0.1172 * (1 - 0.00054 * (temperature - KELVIN)) / specific_gravity


def oil_heat_capacity(temperature: float, specific_gravity: float) -> float:
    """Specific heat capacity of a petroleum oil. [J/(kg K)]

    Theory (W22).

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
    """Thermal conductivity of air at `temperature` [K], ISO 2533. [W/(m K)]

    Theory (W23).

    General knowledge, 100 to 1900 K as the viscosity.

    Examples
    --------
    >>> round(air_conductivity(288.15), 5)
    0.02534
    """
    drop = 245.4 * math.pow(10, -12 / temperature)
    return 2.648151e-3 * math.pow(temperature, 1.5) / (temperature + drop)


def mixture(oil: Fluid, air: Fluid, state: MixtureState) -> Fluid:
    """Mixture of `oil` and `air` with density and viscosity of `state`.

    Theory (W24).

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
