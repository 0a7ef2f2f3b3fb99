"""Formulas of the manual for what a case states as a number: fins, foundations, walls, shafts."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from epicyclic.machine.convection import SPLASHED_WALL


def cylinder_in_air(
    speed: float,  # Against the air, of either sign. [rad/s]
    radius: float,  # [m]
) -> float:
    """Heat transfer coefficient of a shaft turning in air. [W/(m^2 K)]

    Film law of the program Thermca, second hand.

    Examples
    --------
    >>> round(cylinder_in_air(314.16, 20e-3), 1)
    43.9
    """
    return 3.75 * math.pow(abs(speed), 0.7) * math.pow(radius, 0.4)


def room_convection(
    surface_temperature: float,  # [K]
    air_temperature: float,  # [K]
) -> float:
    """Heat transfer coefficient of a surface at rest in a room, without radiation. [W/(m^2 K)]

    Film law of the program Thermca, second hand.

    Examples
    --------
    >>> round(room_convection(333.0, 293.0), 1)
    7.5
    """
    return 1.7 * 1.3 * math.pow(abs(surface_temperature - air_temperature), 0.33)


OVERALL_COEFFICIENTS: Mapping[str, tuple[float, float]] = {
    "small-confined": (10.0, 14.0),
    "large-indoor": (17.0, 20.0),
    "outdoor": (19.0, 24.0),
}
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

    Examples
    --------
    >>> round(foundation_conductance(10.0, 0.5, 20e-3, 0.3, 50.0), 2)
    1.17
    """
    return fin_conductance(coefficient, width, width * thickness, length, conductivity)


def shaft_conductance(
    # From the shaft to the air, as `cylinder_in_air`. [W/(m^2 K)]
    coefficient: float,
    diameter: float,  # [m]
    length: float,  # [m]
    conductivity: float,  # [W/(m K)]
) -> float:
    """`fin_conductance` of a shaft end of circular cross-section. [W/K]

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


def bulk_rise_of_integral_flash(
    integral_flash: float,  # Mean flash temperature of the integral temperature method. [K]
    lubrication_factor: float,  # X_S, one of `LUBRICATION_FACTORS`. [1]
) -> float:
    """Bulk temperature above that of the oil, ISO/TS 6336-21, second hand. [K]

    Examples
    --------
    >>> round(bulk_rise_of_integral_flash(20.0, LUBRICATION_FACTORS["dip"]), 2)
    14.0
    """
    return 0.70 * lubrication_factor * integral_flash
