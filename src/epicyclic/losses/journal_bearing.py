"""Journal bearing of a planet on a plain pin: film, contact of asperities, loss, temperature."""

from __future__ import annotations

import cmath
import math
from bisect import bisect
from collections.abc import Callable, Mapping
from functools import cache, lru_cache

import numpy as np

from epicyclic.dataclass import dataclass, replace
from epicyclic.kernels.journal_bearing import FloatArray, journal_pressure
from epicyclic.losses.ranges import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.oil.oil import D341_OFFSET, MM2_PER_S, OilState
from epicyclic.units import CELSIUS, NUMBER

ECCENTRICITIES = (0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.86, 0.9, 0.94, 0.97, 0.985)
"""Eccentricities that are solved. [1]"""
COARSE, FINE = (24, 11), (48, 21)
"""Points around the circumference and across the width: of a first guess, and of a film."""
TOLERANCE, MOST_SWEEPS = 1e-9, 20_000
_CLUSTERED = 0.9  # Largest eccentricity to which the spacing of points is fitted. [1]
TOUCHING = 1e-3
"""Least film at an edge, over the clearance, down to which a bearing tilts under a moment. [1]"""
_BALANCED = 1e-7  # Imbalance of forces and heat at which a tilt counts as found. [1]
_ROUGHLY = 0.03  # The same of one that is only the start of the next. [1]
_COOLEST = 1e-3  # Rise of the temperature at least, of which a logarithm is taken. [K]
_REACH = 0.3  # Offset of a load over length times (1 - eps)^0.5, of which tilts are easily found.
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

    def rubbing(self, force: float, speed: float) -> float:
        """Boundary friction under a force. [W]"""
        return self.boundary_friction * force * abs(speed) * self.inner_diameter / 2

    @property
    def slenderness(self) -> float:
        """L/D. [1]"""
        return self.length / self.inner_diameter


@dataclass(frozen=True, slots=True)
class JournalState:
    """A journal bearing under load."""

    eccentricity: float  # eps. [1]
    attitude: float  # phi, from the load to the narrowest film. [rad]
    tilt: float  # Of planet and pin against each other. [rad]
    tilt_direction: float  # From the load to where the film at one edge is narrower by it. [rad]
    film: float  # Narrowest, h0; of a tilted bearing at an edge. [m]
    film_ratio: float  # The same over the roughness. [1]
    contact_force: float  # Of the asperities. [N]
    temperature: float  # Of the film. [K]
    petroff_watts: float  # Without load, at this temperature. [W]
    fluid_watts: float  # Of the film, with that. [W]
    contact_watts: float  # [W]
    side_flow: float  # [m^3/s]
    moment_share: float = 1.0  # Of a tilting moment, what film and asperities hold. [1]

    @property
    def watts(self) -> float:
        """The whole loss. [W]"""
        return self.fluid_watts + self.contact_watts


@dataclass(frozen=True, slots=True)
class _Curves:
    """Sommerfeld number, attitude and side flow over x = ln(eps/(1 - eps)).

    ln S and ln tan(phi) are nearly straight over x at both ends, where they go on so.
    """

    x: tuple[float, ...]  # Rising.
    log_sommerfeld: tuple[float, ...]
    log_attitude: tuple[float, ...]  # ln tan(phi)
    flow: tuple[float, ...]  # Q/(omega R C L eps)

    def at(self, x: float) -> tuple[float, float, float]:
        """S, phi and Q/(omega R C L)."""
        known = self.x
        i = min(max(bisect(known, x) - 1, 0), len(known) - 2)
        part = (x - known[i]) / (known[i + 1] - known[i])
        columns = self.log_sommerfeld, self.log_attitude, self.flow
        shares = part, part, min(max(part, 0.0), 1.0)
        ends = zip(columns, shares, strict=True)
        S, tangent, flow = (column[i] + by * (column[i + 1] - column[i]) for column, by in ends)
        return math.exp(S), math.atan(math.exp(tangent)), flow * _share(x)


@lru_cache(maxsize=64)
def journal_curves(slenderness: float) -> _Curves:
    """Solutions of Reynolds' equation for one L/D. Theory (Z1), (Z2)."""
    found = []
    for eps in ECCENTRICITIES:
        force, _, flow = film_force(eps, 0j, slenderness)
        S, x = 1 / (6 * math.pi * abs(force)), math.log(eps / (1 - eps))
        found.append((x, math.log(S), math.log(-force.imag / force.real), flow / eps))
    return _Curves(*zip(*found, strict=True))


def film_force(
    middle: complex, tilt: complex, slenderness: float, pressure: FloatArray | None = None
) -> tuple[complex, complex, float]:
    """Force and moment of a film, and Q/(omega R C L). Theory (Z1), (Z2), (Z7). [1]

    Of the clearance, `middle` is the way to the narrowest film in the middle of the length, and
    `tilt` what is added to it up to one edge; angles rise in the sense of rotation. The force is
    over 6 eta omega R L (R/C)^2, the moment over L/2 times that. A `pressure` of nearly this film
    saves work; it is overwritten.
    """
    # Sommerfeld's substitution: equal steps of it are short where the film is narrow
    eps, P = min(abs(middle), _CLUSTERED), np.zeros(FINE) if pressure is None else pressure
    halves = (np.arange(len(P)) + 0.5) * math.pi / len(P) - math.pi / 2
    angles = cmath.phase(middle) + 2 * np.arctan(math.sqrt((1 - eps) / (1 + eps)) * np.tan(halves))
    places = -np.cos(np.linspace(0, np.pi, P.shape[1]))
    film = complex(middle), tilt, slenderness, angles, places, np.zeros(len(P), dtype=bool), P
    force, moment, flow, sweeps = journal_pressure(*film, TOLERANCE, MOST_SWEEPS)
    assert sweeps > 0, "the relaxation converges for every film"
    return force, moment, flow


def sommerfeld_number(slenderness: float, eccentricity: float) -> tuple[float, float, float]:
    """S = eta N (R/C)^2 L D/W, the attitude in rad and Q/(omega R C L). Theory (Z1). [1]"""
    return journal_curves(slenderness).at(math.log(eccentricity / (1 - eccentricity)))


def asperity_force(bearing: JournalBearing, eccentricity: FloatArray) -> FloatArray:
    """Force of the asperities along the lines of centres, for each eccentricity. Theory (Z4). [N]

    As if they touched so over the whole length.
    """
    eps = np.asarray(eccentricity, dtype=np.float64)[..., None]
    # film less the narrowest one, over the clearance, up to where asperities touch
    room = _CONTACT_FROM * bearing.roughness * 2 / bearing.diametral_clearance - (1 - eps)
    if not (room > 0).any():
        return np.zeros(eps.shape[:-1])
    end = np.arccos(np.clip(1 - room / eps, -1.0, 1.0))
    theta = _POINTS * end
    touching = (room - eps * (1 - np.cos(theta))) * bearing.diametral_clearance / 2
    scale = _ASPERITIES * bearing.contact_modulus * _F52_FACTOR
    pressure = scale * (np.maximum(touching, 0.0) / bearing.roughness) ** _F52_EXPONENT
    area = bearing.length * bearing.inner_diameter / 2 * end
    force: FloatArray = (_WEIGHTS * pressure * np.cos(theta) * area).sum(axis=-1)
    return force


def film_viscosity(oil: OilState, temperature: float) -> float:
    """Dynamic viscosity near the state of an oil, on its line of ASTM D341. Theory (Z6). [Pa s]"""
    Z = oil.kinematic_viscosity / MM2_PER_S + D341_OFFSET
    log_Z = math.log(Z) * math.pow(oil.temperature / temperature, oil.d341_slope)
    return oil.density * MM2_PER_S * max(math.exp(log_Z) - D341_OFFSET, 0.0)


def loaded_journal(
    bearing: JournalBearing, force: float, speed: float, viscosity: float
) -> tuple[float, complex, float]:
    """ln(eps/(1 - eps)), force of the film and that of asperities under a load. Theory (Z4).

    The force has parts towards and across the narrowest film.

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
        return cmath.rect(scale / S, phi), float(asperity_force(bearing, np.array(_share(x))))

    x = _root(lambda x: abs(sum(carried(x))) - force, -STEEPEST, STEEPEST)
    film, contact = carried(x)
    if x == STEEPEST:
        contact += force - abs(film + contact)
    return x, film, contact


def _share(x: float) -> float:
    """Eccentricity at ln(eps/(1 - eps)). [1]"""
    return 1 / (1 + math.exp(-x))


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
    speed: float,  # Of the planet against its pin, from the force to what is across it. [rad/s]
    oil: OilState,  # As it enters.
    heat_capacity: float,  # Of the oil. [J/(kg K)]
    moment: complex = 0j,  # In the planes of the axis and the force, and across it. [N m]
    last: JournalState | None = None,  # Under nearly the same load, which saves work.
) -> JournalState:
    """Film, loss and temperature that agree. Theory (Z3), (Z5), (Z7).

    The loss warms the oil that leaves at the sides, and pin and planet; the film has the mean of
    its temperatures at inlet and outlet. A moment tilts the bearing.
    """

    def excess(found: JournalState) -> float:
        flow = oil.density * heat_capacity * (found.side_flow + bearing.oil_flow)
        rise = found.temperature - oil.temperature
        return rise * (2 * flow + bearing.conductance) - found.watts

    def at(rise: float) -> JournalState:
        """The bearing with a film so much warmer than its oil, without a moment."""
        temperature = oil.temperature + rise
        eta = film_viscosity(oil, temperature)
        x, film, contact = loaded_journal(bearing, force, speed, eta)
        middle = cmath.rect(_share(x), cmath.phase(film + contact))
        flow = journal_curves(bearing.slenderness).at(x)[2]
        across = abs(middle) * film.imag
        return _state(bearing, middle, 0j, across, contact, flow, speed, eta, temperature)

    aligned = at(_root(lambda rise: excess(at(rise)), 0.0, HOTTEST))
    if not (moment and force and speed):
        return aligned
    turned = moment if speed > 0 else moment.conjugate()
    if last is None:
        last = _tilted(bearing, force, turned, speed, oil, aligned, excess, None, COARSE)
    return _tilted(bearing, force, turned, speed, oil, aligned, excess, last, FINE)


def _tilted(
    bearing: JournalBearing,
    force: float,
    moment: complex,
    speed: float,
    oil: OilState,
    aligned: JournalState,
    excess: Callable[[JournalState], float],
    last: JournalState | None,
    points: tuple[int, int],
) -> JournalState:
    """The bearing under a moment, from its state without one.

    Film and asperities hold the share of the moment that brings one edge to `TOUCHING`, at most.
    """
    from scipy.optimize import root  # cases that are only read need no algebra

    clearance, radius = bearing.diametral_clearance / 2, bearing.inner_diameter / 2
    arm, warm = bearing.length / 2, max(aligned.temperature - oil.temperature, _COOLEST)
    # so that without a moment the film is that of the curves, which are interpolated
    S, phi, leaking = sommerfeld_number(bearing.slenderness, aligned.eccentricity)
    pressure = np.zeros(points)
    film_at = cache(lambda *at: film_force(at[0], at[1], bearing.slenderness, pressure))
    known, _, flowing = film_at(complex(aligned.eccentricity), 0j)
    fitted, leaked = cmath.rect(1 / (6 * math.pi * S), -phi) / known, leaking / flowing

    def at(unknown: FloatArray) -> tuple[JournalState, complex, complex]:
        """State, and force and moment of film and asperities.

        Eccentricities at the edges are unknown, over what they leave of the clearance there, and
        1 and the logarithm of the rise of the temperature.
        """
        x1, x2, y1, y2, rise, *_ = unknown.tolist()
        first, second = (odds / (1 + abs(odds)) for odds in (complex(x1, y1), complex(x2, y2)))
        middle, tilt = (first + second) / 2, (second - first) / 2
        temperature = oil.temperature + warm * math.exp(min(rise - 1, 10.0))
        eta = film_viscosity(oil, temperature)
        scale = 6 * eta * abs(speed) * bearing.length * radius * (radius / clearance) ** 2
        film, turning, flow = film_at(middle, tilt)
        film, turning = scale * fitted * film, scale * fitted * turning
        across = (middle * film.conjugate() + tilt * turning.conjugate()).imag
        slices = middle + tilt * _POINTS
        size = np.abs(slices)
        along = _WEIGHTS / 2 * asperity_force(bearing, size)
        contact, leak = float(along.sum()), flow * leaked
        state = _state(bearing, middle, tilt, across, contact, leak, speed, eta, temperature)
        rubbed = along * slices / size
        return state, film + complex(rubbed.sum()), turning + complex(rubbed @ _POINTS)

    def imbalance(unknown: FloatArray, given: float | None) -> FloatArray:
        """With a share of the moment; without one it is unknown too, and an edge at `TOUCHING`."""
        state, carried, turning = at(unknown)
        share = unknown[5] if given is None else given
        missing = np.array([carried - force, turning - share * moment / arm]) / force
        found = [*missing.real, *missing.imag, excess(state) / state.watts]
        return np.array(found if given else [*found, state.film / (TOUCHING * clearance) - 1])

    def balanced(start: FloatArray, share: float | None) -> FloatArray | None:
        enough = _ROUGHLY if points == COARSE or (share and share < 1) else _BALANCED

        def missing(unknown: FloatArray) -> FloatArray:
            found = imbalance(unknown, share)
            return found if np.abs(found).max() > enough else np.zeros(found.size)

        solved = root(missing, start, tol=enough / 10, options={"eps": 1e-8, "maxfev": 80})
        return None if solved.fun.any() else solved.x

    def from_state(state: JournalState) -> FloatArray:
        middle = cmath.rect(state.eccentricity, state.attitude)
        tilt = cmath.rect(state.tilt * arm / clearance, state.tilt_direction)
        odds = np.array([end / (1 - abs(end)) for end in (middle - tilt, middle + tilt)])
        rise = max(state.temperature - oil.temperature, _COOLEST)
        return np.array([*odds.real, *odds.imag, 1 + math.log(rise / warm)])

    none = replace(aligned, moment_share=0.0)
    if aligned.film <= TOUCHING * clearance:
        return none
    # states, and shares of the moment to go on to from there; the last are tried first
    reach = _REACH * math.sqrt(1 - aligned.eccentricity) * force * bearing.length / abs(moment)
    shares = sorted({min(1.0, part * reach) for part in (0.25, 0.5, 1.2)})
    tried = [(from_state(aligned), share) for share in shares]
    if last is not None and last.moment_share:
        tried.append((from_state(last), last.moment_share))
    while tried:
        start, share = tried.pop()
        at_limit = last is not None and share == last.moment_share < 1
        found = start if at_limit else balanced(start, share)
        if found is None:
            continue
        if share == 1 and (state := at(found)[0]).film >= TOUCHING * clearance:
            return state
        limit = balanced(np.append(found, share), None)
        if limit is not None and limit[5] <= 1:
            return replace(at(limit)[0], moment_share=float(limit[5]))
        if share < 1:  # the limit is far away, or the whole moment can be held
            tried.append((found, min(1.0, 2 * share) if limit is None else 1.0))
    return none


def _state(
    bearing: JournalBearing,
    middle: complex,
    tilt: complex,
    across: float,  # Force of the film across the line of centres, times the eccentricity. [N]
    contact: float,  # [N]
    flow: float,  # Q/(omega R C L)
    speed: float,
    eta: float,
    temperature: float,
) -> JournalState:
    """What follows from the place of a planet on its pin."""
    clearance, radius = bearing.diametral_clearance / 2, bearing.inner_diameter / 2
    omega = abs(speed)
    slices = np.abs(middle + tilt * _POINTS) ** 2
    thinner = float((_WEIGHTS / 2 / np.sqrt(1 - slices)).sum())
    petroff = 2 * math.pi * eta * omega**2 * radius**3 * bearing.length / clearance
    film = clearance * (1 - max(abs(middle + tilt), abs(middle - tilt)))
    return JournalState(
        eccentricity=abs(middle),
        attitude=cmath.phase(middle),
        tilt=abs(tilt) * clearance / (bearing.length / 2),
        tilt_direction=cmath.phase(tilt),
        film=film,
        film_ratio=film / bearing.roughness,
        contact_force=contact,
        temperature=temperature,
        petroff_watts=petroff,
        fluid_watts=petroff * thinner + omega * clearance * across / 2,
        contact_watts=bearing.rubbing(contact, speed),
        side_flow=flow * omega * radius * clearance * bearing.length,
    )


def journal_flags(where: str, state: JournalState, speed: float) -> tuple[ValidityFlag, ...]:
    """Flags on mixed friction and on the temperature of the film."""
    if speed == 0:
        return ()
    values: Mapping[str, float] = {"film_ratio": state.film_ratio, "film": state.temperature}
    return check_ranges(ModelUse("bearing", "reynolds", where), _RANGES, values)
