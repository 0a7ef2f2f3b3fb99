"""Heat that a gearbox gives to the air and to what it stands on: ISO/TR 14179-2 and -1.

ISO/TR 14179-2 (after W. Funck, Diss. TU Muenchen, 1985) is second hand. Its coefficients are means
over the outside of a housing in air at about 100 kPa.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from epicyclic.thermal.fluid import air

OVERALL_COEFFICIENTS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"small-confined": (10.0, 14.0), "large-indoor": (17.0, 20.0), "outdoor": (19.0, 24.0)}
)
"""Overall coefficients of ISO/TR 14179-1 from oil to air, from and to. Large rooms: air above
1.4 m/s; outdoors: above 3.7 m/s. General knowledge; confirm before relying on them. [W/(m^2 K)]"""
FAN_COEFFICIENTS: tuple[tuple[float, float], ...] = (
    (2.5, 15.0),
    (5.0, 24.0),
    (10.0, 42.0),
    (15.0, 58.0),
)
"""Air speed [m/s] and overall coefficient [W/(m^2 K)] with a fan on a shaft, ISO/TR 14179-1;
general knowledge, as `OVERALL_COEFFICIENTS`."""
SPLASHED_WALL = 200.0
"""Coefficient between the oil and the wall that it splashes, ISO/TR 14179-2. [W/(m^2 K)]"""
STANDARD_PRESSURE = 101325.0
"""Standard pressure of the atmosphere. [Pa]"""
GRAVITY = 9.80665
"""Standard acceleration of free fall. [m/s^2]"""


def free_convection(
    height: float,  # Height of the housing. [m]
    housing_temperature: float,  # [K]
    air_temperature: float,  # [K]
) -> float:
    """Coefficient of free convection from a housing, ISO/TR 14179-2. [W/(m^2 K)]

    Theory (W9).

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

    Theory (W10).

    The buoyancy of the warm air enters through the Reynolds number. Air has the temperature midway
    between housing and surroundings.

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


def overall_coefficient(
    # From the wall to the air: convection, times the factor of its fins, plus radiation. [W/(m^2
    # K)]
    outside: float,
    inside: float = SPLASHED_WALL,  # From the oil to the wall. [W/(m^2 K)]
    area_ratio: float = 1.0,  # Outer over inner area of the housing. [1]
    wall_thickness: float = 0.0,  # [m]
    wall_conductivity: float = 50.0,  # [W/(m K)]
) -> float:
    """Coefficient from the oil to the air, for the outer area, ISO/TR 14179-2. [W/(m^2 K)]

    Theory (W12).

    Examples
    --------
    >>> round(overall_coefficient(17.0), 1)
    15.7
    """
    within = area_ratio / inside + wall_thickness / wall_conductivity
    return outside / (1 + outside * within)


def fin_factor(
    convection: float,  # Coefficient of convection without fins. [W/(m^2 K)]
    # Area of the housing as if it had no fins, for which the factor holds. [m^2]
    plain_area: float,
    fin_area: float,  # Area of both faces of all fins, less what they cover of the housing. [m^2]
    fin_height: float,  # [m]
    fin_thickness: float,  # [m]
    conductivity: float,  # Conductivity of the fins. [W/(m K)]
) -> float:
    """Factor on the convection of a housing that has fins; radiation gains nothing. [1]

    Theory (W13).

    The efficiency is that of a straight fin of constant thickness, general knowledge.

    Examples
    --------
    >>> round(fin_factor(10.0, 1.0, 1.5, 40e-3, 5e-3, 50.0), 2)
    2.44
    """
    slope = math.sqrt(2 * convection / (conductivity * fin_thickness)) * fin_height
    efficiency = math.tanh(slope) / slope if slope > 0 else 1.0
    return 1 + efficiency * fin_area / plain_area


def fin_conductance(
    coefficient: float,  # From the rod to the air. [W/(m^2 K)]
    perimeter: float,  # Through which the cross-section gives heat to the air. [m]
    area: float,  # Area of the cross-section. [m^2]
    length: float,  # [m]
    conductivity: float,  # [W/(m K)]
) -> float:
    """Heat that a rod leads from a housing to the air, by the temperature of its root. [W/K]

    Theory (W14).

    ISO/TR 14179-2 for foundations and shaft ends; the end of the rod is insulated.

    Examples
    --------
    >>> round(fin_conductance(20.0, 0.126, 1.26e-3, 0.2, 50.0), 3)
    0.34
    """
    slope = math.sqrt(coefficient * perimeter / (conductivity * area))
    return conductivity * area * slope * math.tanh(slope * length)


def foundation_conductance(
    coefficient: float,  # From the plate to the air. [W/(m^2 K)]
    width: float,  # Width of the joint to the housing. [m]
    thickness: float,  # [m]
    length: float,  # From the housing to the edge of the plate. [m]
    conductivity: float,  # [W/(m K)]
) -> float:
    """`fin_conductance` of a plate that gives heat to the air on one face. [W/K]

    Theory (W14).

    Examples
    --------
    >>> round(foundation_conductance(10.0, 0.5, 20e-3, 0.3, 50.0), 2)
    1.17
    """
    return fin_conductance(coefficient, width, width * thickness, length, conductivity)


def shaft_conductance(
    # From the shaft to the air, as `epicyclic.thermal.convection.cylinder_in_air`. [W/(m^2 K)]
    coefficient: float,
    diameter: float,  # [m]
    length: float,  # [m]
    conductivity: float,  # [W/(m K)]
) -> float:
    """`fin_conductance` of a shaft end of circular cross-section. [W/K]

    Theory (W14).

    Examples
    --------
    >>> round(shaft_conductance(20.0, 40e-3, 0.2, 50.0), 3)
    0.339
    """
    area = math.pi * diameter**2 / 4
    return fin_conductance(coefficient, math.pi * diameter, area, length, conductivity)


def fan_coefficient(
    air_speed: float,  # [m/s]
) -> float:
    """Overall coefficient with a fan on a shaft, ISO/TR 14179-1. [W/(m^2 K)]

    Linear between `FAN_COEFFICIENTS`, held at the first and the last.

    Examples
    --------
    >>> fan_coefficient(7.5)
    33.0
    """
    speeds, coefficients = zip(*FAN_COEFFICIENTS, strict=True)
    return float(np.interp(air_speed, speeds, coefficients))
