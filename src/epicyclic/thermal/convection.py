"""Heat transfer from what turns: discs, shafts, gears in an oil bath; through loaded rollers."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from epicyclic.thermal.fluid import Fluid

FloatArray = NDArray[np.float64]

TRANSITION_REYNOLDS = 2.4e5
"""omega r^2/nu at which the flow on a disc turns turbulent. [1]"""


def disc_coefficient(
    fluid: Fluid,
    speed: float,  # Against the fluid, of either sign. [rad/s]
    outer_radius: float,  # [m]
    inner_radius: float = 0.0,  # Inner radius of an annulus; 0 for a disc. [m]
) -> float:
    """Mean heat transfer coefficient of one face of a disc turning in a fluid at rest. [W/(m^2 K)]

    Theory (W17).

    Area mean of the laminar coefficient within the radius of transition and the turbulent one
    outside. The face is equally hot all over, the fluid around it free of walls.

    Examples
    --------
    A gear of 60 mm at 3000 rpm in air:

    >>> from epicyclic.thermal.fluid import air
    >>> round(disc_coefficient(air(333.15, 101325.0), 314.16, 30e-3), 1)
    38.0
    """
    omega = abs(speed)
    if omega == 0:
        return 0.0
    transition = math.sqrt(TRANSITION_REYNOLDS * fluid.kinematic_viscosity / omega)
    middle = min(max(transition, inner_radius), outer_radius)
    laminar = _laminar_disc(fluid, omega) * (middle**2 - inner_radius**2)
    # 2 int h r dr of h ~ r^0.6
    outside = math.pow(outer_radius, 2.6) - math.pow(middle, 2.6)
    turbulent = _turbulent_disc(fluid, omega) * 2 / 2.6 * outside
    return (laminar + turbulent) / (outer_radius**2 - inner_radius**2)


def _laminar_disc(fluid: Fluid, omega: float) -> float:
    """Coefficient in laminar flow, the same at every radius. Theory (W15). [W/(m^2 K)]

    Departure: the last term of the denominator is added here, fitted to the exact solution.
    """
    root = math.pow(fluid.prandtl, -1 / 3)
    nusselt = 0.62048 / root / (1 + 0.2980 * root + 0.14514 * root**2 + 0.125 * root**3)
    return nusselt * fluid.conductivity * math.sqrt(omega / fluid.kinematic_viscosity)


def _turbulent_disc(fluid: Fluid, omega: float) -> float:
    """Coefficient in turbulent flow over r^0.6. Theory (W16). [W/(m^2.6 K)]"""
    nusselt = 0.0238 * math.pow(fluid.prandtl, 0.6)
    return nusselt * fluid.conductivity * math.pow(omega / fluid.kinematic_viscosity, 0.8)


def dipped_disc(fluid: Fluid, speed: float, diameter: float) -> float:
    """Heat transfer coefficient of the faces of a gear in an oil bath, Handschuh. [W/(m^2 K)]

    Theory (W20).

    Second hand; the formula of a plate across a flow, made for Reynolds numbers of 4e3 to 1.5e4.
    Parameters and sense as for `disc_coefficient`.

    Examples
    --------
    >>> bath = Fluid(850.0, 20e-3, 0.13, 2000.0)
    >>> round(dipped_disc(bath, 100.0, 80e-3))
    2629
    """
    reynolds = abs(speed) * diameter**2 / (2 * fluid.kinematic_viscosity)
    nusselt = 0.228 * math.pow(reynolds, 0.731) * math.pow(fluid.prandtl, 1 / 3)
    return nusselt * fluid.conductivity / diameter


def cylinder_in_air(
    speed: float,  # Against the air, of either sign. [rad/s]
    radius: float,  # [m]
) -> float:
    """Heat transfer coefficient of a shaft turning in air. [W/(m^2 K)]

    Theory (W18).

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

    Theory (W19).

    Film law of the program Thermca, second hand.

    Examples
    --------
    >>> round(room_convection(333.0, 293.0), 1)
    7.5
    """
    return 1.7 * 1.3 * math.pow(abs(surface_temperature - air_temperature), 0.33)


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

    Theory (W21).

    Derived here: constriction of the heat in either race and in the roller, contacts at rest and
    dry. Rollers that touch one race only, with half-width 0, lead nothing.

    Examples
    --------
    Sixteen loaded needles of 2.5 mm by 20 mm:

    >>> width = np.full(16, 30e-6)
    >>> round(roller_conductance(width, width, 20e-3, 2.5e-3, 3e-3, 4e-3, 45.0), 2)
    2.59
    """
    loaded = (inner_half_width > 0) & (outer_half_width > 0)
    inner, outer = inner_half_width[loaded], outer_half_width[loaded]
    races = np.log(inner_pitch / (math.pi * inner)) + np.log(outer_pitch / (math.pi * outer))
    roller = np.log(2 * roller_diameter / inner) + np.log(2 * roller_diameter / outer)
    resistance = (races + roller) / (math.pi * conductivity)
    lengths = np.broadcast_to(length, loaded.shape)[loaded]
    return float((lengths / resistance).sum())
