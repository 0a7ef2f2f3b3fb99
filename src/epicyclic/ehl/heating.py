"""Heat of sliding: thinner inlet film, warmer film. An estimate beside an isothermal solution."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.ehl.conditions import LineContact
from epicyclic.ehl.rheology import Roelands
from epicyclic.kernels.ehl_fluid import mean_shear
from epicyclic.lubricant.properties import ROELANDS_PRESSURE, OilState

FloatArray = NDArray[np.float64]

FILM_EXPONENT = 0.694
"""Exponent of the viscosity in the film of Pan and Hamrock (1989). [1]"""
SMALLEST_CHANGE = 1e-3
"""To which the temperature of a node is found. [K]"""


@dataclass(frozen=True, slots=True)
class Heating:
    """What carries the heat of sliding away."""

    thermoviscosity: float  # beta = -d(ln mu)/dT of the oil at the inlet. [1/K]
    oil_conductivity: float  # [W/(m K)]
    effusivity1: float  # sqrt(k rho c) of each solid. [W s^0.5/(m^2 K)]
    effusivity2: float  # sqrt(k rho c) of each solid. [W s^0.5/(m^2 K)]


def heating_of(oil: OilState, effusivity1: float, effusivity2: float) -> Heating:
    """Heat carried away by an oil at the temperature of the contact and two solids."""
    return Heating(oil.thermoviscosity, oil.thermal_conductivity, effusivity1, effusivity2)


def inlet_factor(contact: LineContact, heating: Heating) -> float:
    """Film over that without heat of shear in the inlet: Wilson and Sheu (1983). Theory (H29)."""
    speed = contact.rolling_speed
    load = (
        heating.thermoviscosity * contact.oil.viscosity * speed**2 / heating.oil_conductivity
    )  # L = beta mu_0 u_r^2/k
    slip = abs(contact.sliding_speed) / speed
    return 1 / (1 + 0.1 * (1 + 14.8 * math.pow(slip, 0.83)) * math.pow(load, 0.64))


def flow_easing(contact: LineContact, heating: Heating | None) -> float:
    """Factor on the flow under pressure by which the film falls by the inlet factor.

    Theory (H29).
    """
    if heating is None:
        return 1.0
    return math.pow(inlet_factor(contact, heating), -1 / FILM_EXPONENT)


def thinning(
    contact: LineContact, heating: Heating, pressure: FloatArray, rise: FloatArray
) -> FloatArray:
    """What a `rise` of the temperature [K] takes off ln(mu). Theory (H31)."""
    thinned = heating.thermoviscosity * rise
    if isinstance(contact.oil.pressure_law, Roelands):
        stiffer = 1 + np.maximum(pressure, 0) / ROELANDS_PRESSURE
        thinned = thinned * stiffer**contact.oil.roelands_index
    return thinned


def temperature_rise(
    contact: LineContact,
    heating: Heating,
    x: FloatArray,  # Nodes [m], pressure [Pa] and film [m] of a steady solution.
    pressure: FloatArray,  # Nodes [m], pressure [Pa] and film [m] of a steady solution.
    film: FloatArray,  # Nodes [m], pressure [Pa] and film [m] of a steady solution.
) -> FloatArray:
    """Mean over the film of the temperature above that of the inlet, shape (n,). [K]

    Theory (H30), (H31). Heat only acts downstream, so that node after node has one unknown.
    """
    from scipy.optimize import brentq

    fluid, slip = contact.scaled_fluid(), abs(contact.sliding_speed)
    conveyed = heating.effusivity1 * math.sqrt(abs(contact.speed1))
    conveyed += heating.effusivity2 * math.sqrt(abs(contact.speed2))
    surfaces = _moving_source(x) / (math.sqrt(math.pi) * conveyed)
    # by the heat of a node itself, half of which is that of the cell before it
    own = film / (12 * heating.oil_conductivity)
    own[1:] += np.diagonal(surfaces, -1)[: x.size - 1] / 2
    per_kelvin = thinning(contact, heating, pressure, np.ones_like(x))
    rise, heat = np.zeros_like(x), np.zeros_like(x)

    def source(warmer: float, i: int) -> float:
        scaled = pressure[i] / contact.hertz_pressure, film[i] / contact.film_scale
        stress = mean_shear(*scaled, per_kelvin[i] * warmer, fluid)
        return float(stress * contact.hertz_pressure * slip)

    def excess(warmer: float, i: int, before: float) -> float:
        return warmer - before - float(own[i]) * source(warmer, i)

    for i in range(x.size):
        before = float(surfaces[i, :i] @ (heat[1 : i + 1] + heat[:i])) / 2
        rise[i] = before
        if pressure[i] > 0:
            # the warmer the film the less heat: one answer, and no warmer than this
            most = before + own[i] * source(before, i)
            if excess(most, i, before) > SMALLEST_CHANGE:
                most = brentq(excess, before, most, args=(i, before), xtol=SMALLEST_CHANGE)
            rise[i] = most
            heat[i] = source(rise[i], i)
    return rise


def _moving_source(x: FloatArray) -> FloatArray:
    """Integral over each cell upstream of (x - s)^-1/2 ds, shape (n, n - 1). [m^0.5]"""
    root = np.sqrt(np.maximum(np.subtract.outer(x, x), 0))
    integral: FloatArray = 2 * (root[:, :-1] - root[:, 1:])
    return integral
