"""Journal bearing of a planet on a plain pin: film, contact of asperities, loss, temperature."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from epicyclic.kernels.journal_bearing import FloatArray, journal_pressure
from epicyclic.losses.ranges import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.oil.oil import D341_OFFSET, MM2_PER_S, OilState
from epicyclic.units import CELSIUS, NUMBER

ECCENTRICITIES = (0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.86, 0.9, 0.94, 0.97, 0.985)
"""Eccentricities that are solved. [1]"""
AROUND, ACROSS = 240, 16
TOLERANCE, MOST_SWEEPS = 1e-7, 20_000
STEEPEST = 14.0  # Largest |ln(eps/(1 - eps))| that is tried: films of 1e-6 of the clearance. [1]
# Pressure of asperities over E' after J. A. Greenwood and J. H. Tripp (1971), second hand, for
# sigma beta eta = 0.05 and sigma/beta = 0.01, usual values of ground steel.
_ASPERITIES = 16 * math.sqrt(2) * math.pi / 15 * 0.05**2 * math.sqrt(0.01)
_F52_FACTOR, _F52_EXPONENT = 4.4086e-5, 6.804
"""F_5/2 of Greenwood and Tripp as a factor times a power of 4 - h/sigma: Y. Hu, H. S. Cheng et al.,
J. Tribol. 116 (1994) 470, second hand. [1]"""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(32)
_CONTACT_FROM = 4.0  # Film over the composite roughness from which asperities touch. [1]
HOTTEST = 150.0
"""Rise of the temperature of the film that is tried at most. [K]"""

_RANGES = (
    Range("film_ratio", "film over composite roughness", 3.0, None, NUMBER, "full fluid film"),
    Range("film", "temperature of the film", None, 130.0, CELSIUS, "usual limit of ISO 7902-3"),
)


@dataclass(frozen=True, slots=True)
class JournalBearing:
    """A plain pin in the bore of a planet."""

    inner_diameter: float  # Of the pin. [m]
    length: float  # [m]
    diametral_clearance: float  # [m]
    roughness: float  # rms, of both surfaces together. [m]
    contact_modulus: float  # E' = 1/((1 - nu1^2)/E1 + (1 - nu2^2)/E2). [Pa]
    boundary_friction: float  # mu_b. [1]
    conductance: float  # From the film to pin and planet. [W/K]
    oil_flow: float = 0.0  # Supplied under pressure, to one pin. [m^3/s]

    @property
    def outer_diameter(self) -> float:
        """Of the bore. [m]"""
        return self.inner_diameter + self.diametral_clearance

    @property
    def slenderness(self) -> float:
        """L/D. [1]"""
        return self.length / self.inner_diameter


@dataclass(frozen=True, slots=True)
class JournalState:
    """A journal bearing under load."""

    eccentricity: float  # eps. [1]
    attitude: float  # phi, from the load to the narrowest film. [rad]
    film: float  # Narrowest, h0. [m]
    film_ratio: float  # The same over the roughness. [1]
    contact_force: float  # Of the asperities. [N]
    temperature: float  # Of the film. [K]
    petroff_watts: float  # Without load, at this temperature. [W]
    fluid_watts: float  # Of the film, with that. [W]
    contact_watts: float  # [W]
    side_flow: float  # [m^3/s]

    @property
    def watts(self) -> float:
        """The whole loss. [W]"""
        return self.fluid_watts + self.contact_watts


@dataclass(frozen=True, slots=True)
class _Curves:
    """Sommerfeld number, attitude and side flow over x = ln(eps/(1 - eps)).

    ln S and ln tan(phi) are nearly straight over x at both ends, where they go on so.
    """

    x: FloatArray  # Rising.
    log_sommerfeld: FloatArray
    log_attitude: FloatArray  # ln tan(phi)
    flow: FloatArray  # Q/(omega R C L eps)

    def at(self, x: float) -> tuple[float, float, float]:
        """S, phi and Q/(omega R C L)."""
        flow = float(np.interp(x, self.x, self.flow)) / (1 + math.exp(-x))
        S, tangent = (self._straight(x, logs) for logs in (self.log_sommerfeld, self.log_attitude))
        return math.exp(S), math.atan(math.exp(tangent)), flow

    def _straight(self, x: float, logs: FloatArray) -> float:
        """Between the known values, and beyond them along the last two."""
        known, found = self.x, float(np.interp(x, self.x, logs))
        for end, inner in ((0, 1), (-1, -2)):
            beyond = x - known[end]
            if beyond * (known[end] - known[inner]) > 0:
                slope = (logs[end] - logs[inner]) / (known[end] - known[inner])
                found += float(slope * beyond)
        return found


@lru_cache(maxsize=64)
def journal_curves(slenderness: float) -> _Curves:
    """Solutions of Reynolds' equation for one L/D. Theory (Z1), (Z2)."""
    found = []
    for eps in ECCENTRICITIES:
        towards, across, flow, sweeps = journal_pressure(
            eps, slenderness, AROUND, ACROSS, np.zeros(0), 0.0, TOLERANCE, MOST_SWEEPS
        )
        assert sweeps > 0, "the relaxation converges for every eccentricity of the list"
        S = 1 / (6 * math.pi * math.hypot(towards, across))
        x = math.log(eps / (1 - eps))
        found.append((x, math.log(S), math.log(across / towards), flow / eps))
    return _Curves(*(np.array(column) for column in zip(*found, strict=True)))


def sommerfeld_number(slenderness: float, eccentricity: float) -> tuple[float, float, float]:
    """S = eta N (R/C)^2 L D/W, the attitude in rad and Q/(omega R C L). Theory (Z1). [1]"""
    return journal_curves(slenderness).at(math.log(eccentricity / (1 - eccentricity)))


def friction_variable(sommerfeld: float, eccentricity: float, attitude: float) -> float:
    """(R/C) f of the moving surface, with a full film all around. Theory (Z3). [1]

    Examples
    --------
    >>> round(friction_variable(0.6245, 0.2, math.radians(77.7)), 2)
    12.68
    """
    shear = 2 * math.pi**2 * sommerfeld / math.sqrt(1 - eccentricity**2)
    return shear + eccentricity * math.sin(attitude) / 2


def asperity_force(bearing: JournalBearing, x: float) -> float:
    """Force of the asperities along the line of centres, at ln(eps/(1 - eps)). Theory (Z4). [N]"""
    eps, narrowest = 1 / (1 + math.exp(-x)), 1 / (1 + math.exp(x))
    # film less the narrowest one, over the clearance, up to where asperities touch
    room = _CONTACT_FROM * bearing.roughness * 2 / bearing.diametral_clearance - narrowest
    if room <= 0:
        return 0.0
    end = math.acos(max(-1.0, 1 - room / eps))
    theta = _POINTS * end
    touching = (room - eps * (1 - np.cos(theta))) * bearing.diametral_clearance / 2
    scale = _ASPERITIES * bearing.contact_modulus * _F52_FACTOR
    pressure = scale * (np.maximum(touching, 0.0) / bearing.roughness) ** _F52_EXPONENT
    area = bearing.length * bearing.inner_diameter / 2 * end
    return float((_WEIGHTS * pressure * np.cos(theta)).sum() * area)


def film_viscosity(oil: OilState, temperature: float) -> float:
    """Dynamic viscosity near the state of an oil, on its line of ASTM D341. Theory (Z6). [Pa s]"""
    nu = oil.kinematic_viscosity / MM2_PER_S
    Z = nu + D341_OFFSET
    slope = oil.temperature * oil.thermoviscosity * nu / (Z * math.log(Z))
    log_Z = math.log(Z) * math.pow(oil.temperature / temperature, slope)
    return oil.density * MM2_PER_S * max(math.exp(log_Z) - D341_OFFSET, 0.0)


def loaded_journal(
    bearing: JournalBearing, force: float, speed: float, viscosity: float
) -> tuple[float, float, float]:
    """ln(eps/(1 - eps)), attitude and asperity force under a load. Theory (Z4).

    Film and asperities carry together; both rise with the eccentricity. Where neither can, at the
    narrowest film that is tried, the surfaces carry the rest.
    """
    curves = journal_curves(bearing.slenderness)
    clearance, radius = bearing.diametral_clearance / 2, bearing.inner_diameter / 2
    # S W, the load at a Sommerfeld number of one [N]
    scale = viscosity * abs(speed) / (2 * math.pi) * (radius / clearance) ** 2
    scale *= bearing.length * bearing.inner_diameter

    def carried(x: float) -> tuple[complex, float]:
        S, phi, _ = curves.at(x)
        contact = asperity_force(bearing, x)
        return complex(scale / S * math.cos(phi) + contact, scale / S * math.sin(phi)), contact

    x = _root(lambda x: abs(carried(x)[0]) - force, -STEEPEST, STEEPEST)
    whole, contact = carried(x)
    if x == STEEPEST:
        contact += force - abs(whole)
    return x, math.atan2(whole.imag, whole.real) if whole else math.pi / 2, contact


def _root(rising: Callable[[float], float], low: float, high: float) -> float:
    """Where a rising function is zero, or the end of the range towards which that lies."""
    from scipy.optimize import brentq  # cases that are only read need no algebra

    if rising(low) >= 0:
        return low
    if rising(high) <= 0:
        return high
    return float(brentq(rising, low, high, xtol=1e-11, rtol=1e-12))


def solve_journal(
    bearing: JournalBearing,
    force: float,  # [N]
    speed: float,  # Of the planet against its pin. [rad/s]
    oil: OilState,  # As it enters.
    heat_capacity: float,  # Of the oil. [J/(kg K)]
) -> JournalState:
    """Film, loss and temperature that agree. Theory (Z3), (Z5).

    The loss warms the oil that leaves at the sides, and pin and planet; the film has the mean of
    its temperatures at inlet and outlet.
    """

    def excess(rise: float) -> float:
        found = _at(bearing, force, speed, oil, oil.temperature + rise)
        flow = oil.density * heat_capacity * (found.side_flow + bearing.oil_flow)
        return rise * (2 * flow + bearing.conductance) - found.watts

    return _at(bearing, force, speed, oil, oil.temperature + _root(excess, 0.0, HOTTEST))


def _at(
    bearing: JournalBearing, force: float, speed: float, oil: OilState, temperature: float
) -> JournalState:
    """The bearing with a film of known temperature."""
    eta, omega = film_viscosity(oil, temperature), abs(speed)
    x, phi, contact = loaded_journal(bearing, force, speed, eta)
    eps = 1 / (1 + math.exp(-x))
    clearance, radius = bearing.diametral_clearance / 2, bearing.inner_diameter / 2
    petroff = 2 * math.pi * eta * omega**2 * radius**3 * bearing.length / clearance
    film_force = max(force - contact, 0.0)
    shear = petroff / math.sqrt(1 - eps**2)
    lifting = film_force * omega * clearance * eps * math.sin(phi) / 2
    _, _, flow = journal_curves(bearing.slenderness).at(x)
    return JournalState(
        eccentricity=eps,
        attitude=phi,
        film=clearance * (1 - eps),
        film_ratio=clearance * (1 - eps) / bearing.roughness,
        contact_force=contact,
        temperature=temperature,
        petroff_watts=petroff,
        fluid_watts=shear + lifting,
        contact_watts=bearing.boundary_friction * contact * omega * radius,
        side_flow=flow * omega * radius * clearance * bearing.length,
    )


def journal_flags(where: str, state: JournalState, speed: float) -> tuple[ValidityFlag, ...]:
    """Flags on mixed friction and on the temperature of the film."""
    if speed == 0:
        return ()
    values: Mapping[str, float] = {"film_ratio": state.film_ratio, "film": state.temperature}
    return check_ranges(ModelUse("bearing", "reynolds", where), _RANGES, values)
