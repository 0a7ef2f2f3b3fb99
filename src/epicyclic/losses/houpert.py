"""Ball bearings by the film in their contacts: rolling, hysteresis, spin and curvature.

Rolling is L. Houpert's (1987), as N. Biboulet and L. Houpert, Proc. IMechE J 224 (2010) 777, print
it; hysteresis and the choice of both are those of M. Balan et al., Lubricants 3 (2015) 222; both
read. Sliding is Coulomb's with the mixed friction of flanks; starvation, drag, seals are SKF's.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import ClassVar

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.contact.line_contact import Flanks, LineContacts
from epicyclic.dataclass import dataclass, replace
from epicyclic.kernels.line_contact import inlet_film_factor, power
from epicyclic.losses.mixed_lubrication import mixed_friction
from epicyclic.losses.ranges import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.losses.shaft_bearing import (
    AXIAL_RATIO,
    BearingLoad,
    CatalogueBearing,
    FrictionPart,
    WithoutCoefficient,
    load_flags,
)
from epicyclic.losses.skf_2018 import LEAST_SUPPLY, SkfModel, film_parts
from epicyclic.losses.zhou_hoeprich import AS_MADE, POSITIONS, STEEL, roller_loads
from epicyclic.oil.oil import OilState
from epicyclic.units import NUMBER

HOUPERT_SOURCE = "N. Biboulet and L. Houpert, Proc. IMechE J 224 (2010) 777"
CONFORMITIES = (0.52, 0.53)
"""Radii of the grooves of inner and outer ring over D_w, ISO 281, second hand. [1]"""
THRUST_CONFORMITIES = (0.54, 0.54)  # The same of the washers of thrust ball bearings. [1]
BALL_ROUGHNESS = (0.06e-6, 0.03e-6)
"""Rms of race and ball of a bearing 51205, Balan et al. (2015). [m]"""
THRUST_SHARES = (0.37, 0.85)
"""D_w over D - d of thrust ball bearings, share of the pitch circle that balls fill: with ISO 76
C0 of 33 bearings 511 to 513 of a catalogue (ISB, thrust ball bearings, p. 211) within 18 %. [1]"""
TRANSITION = 6.6  # Of M between rigid and elastic contacts, Biboulet and Houpert, Eq. 32. [1]
CURVATURE = 0.0806
"""Half the mean of |y^2 - c| over the ellipse by pressure, c with no force in all; derived. [1]"""
_SPEED_NUMBER = Range(
    "speed_number", "dimensionless speed in the contacts of balls", None, 1.6e-10, NUMBER,
    f"solutions of {HOUPERT_SOURCE}",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class BallMoments:
    """Friction moments of a ball bearing, and what its ranges are of."""

    rolling: float  # With hysteresis. [N m]
    sliding: float  # By spin and curvature. [N m]
    speed_number: float  # U, at most. [1]


@dataclass(frozen=True, slots=True)
class BallModel(WithoutCoefficient):
    """Rolling after Houpert, sliding by mixed friction."""

    balls: int
    ball_diameter: float  # D_w. [m]
    conformities: tuple[float, float]  # Radii of the grooves over D_w, inner and outer. [1]
    static_load_rating: float  # C0, for the contact angle of a deep groove. [N]
    skf: SkfModel  # What starvation, drag and seals are taken from.

    name: ClassVar = "houpert"
    terms: ClassVar = ("mechanical", "drag")
    depends_on_load: ClassVar = True

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``mechanical``, rolling and sliding, and ``drag``, with that of the seals. [W]"""
        moments = ball_moments(self, bearing, load, speed, oil)
        method = "rolling after Houpert, sliding by mixed friction"
        moment = moments.rolling + moments.sliding
        return film_parts(self.skf, bearing, speed, oil, moment, method, HOUPERT_SOURCE)

    def flags(
        self, where: str, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[ValidityFlag, ...]:
        """Flags on static load, speed, and what the solutions of rolling contacts cover."""
        use = ModelUse("bearing", self.name, where)
        own = {"speed_number": ball_moments(self, bearing, load, speed, oil).speed_number}
        most = 0.0
        if self.skf.supply(bearing, speed, oil.kinematic_viscosity) <= LEAST_SUPPLY:
            # nobody measured how far thicker oil starves
            full = replace(self, skf=replace(self.skf, starvation=0.0))
            moments = ball_moments(full, bearing, load, speed, oil)
            most = (moments.rolling + moments.sliding) * abs(speed)
        found = check_ranges(use, (_SPEED_NUMBER,), own, could_be=most) if speed else ()
        return found + load_flags(use, AXIAL_RATIO, bearing, load, speed)


def contact_angle(model: BallModel, bearing: CatalogueBearing, axial: float) -> float:
    """Of the balls; in a deep groove by the axial force, as SKF has it. Theory (J38). [rad]"""
    if bearing.type == "thrust-ball":
        return math.pi / 2
    if bearing.type == "angular-contact":
        return bearing.contact_angle
    return math.radians(min(24.6 * math.pow(axial / model.static_load_rating, 0.24), 45.0))


def ball_loads(
    load: BearingLoad,
    alpha: float,  # Contact angle. [rad]
    balls: int,
) -> FloatArray:
    """Load of a ball at each of `POSITIONS` places around the bearing. Theory (J22), (J38). [N]

    Half of the balls carry where the axial force is less than that needs.
    """
    slope = load.radial * math.tan(alpha) / load.axial if load.axial else math.inf
    shares = roller_loads(slope if load.radial else 0.0, POSITIONS, 1.5)
    around = np.cos(2 * math.pi * np.arange(POSITIONS) / POSITIONS)
    held = float((shares * around).mean()) * math.cos(alpha)
    along = load.axial / math.sin(alpha) if load.axial else 0.0
    mean = max(along, load.radial / held if load.radial else 0.0) / balls
    return mean * shares


def point_rolling_force(
    speed: FloatArray,  # U = 2 mu u/(E R_x). [1]
    load: FloatArray,  # W = Q/(E R_x^2). [1]
    material: float,  # G. [1]
    flatness: FloatArray,  # R_z/R_x. [1]
) -> FloatArray:
    """F/(E R_x^2) on each surface of a rolling ball, moderately starved. Theory (J39). [1]

    Houpert (1987) as Biboulet and Houpert (2010) print it, Eqs. 28, 29, with their transition,
    Eq. 32, as Balan et al. (2015) found best for balls of bearings. For R_z/R_x above 10.
    """
    ellipticity = 1 / (1.0339 * power(flatness, 0.636))
    beta = 4 / math.pi * (1.0003 + 0.5968 / flatness) / (1 + 1 / flatness)
    rigid = 0.835 * power(flatness, 0.358, speed, 0.636, load, 0.364)
    elastic = 1.544 * power(beta, 1 / 3, ellipticity, -0.577, speed, 0.656, load, 0.466)
    elastic = elastic * math.pow(material, 0.022)
    moes = power(beta, 0.25, speed, -0.75) * ellipticity * load
    force: FloatArray = elastic + (rigid - elastic) / (1 + moes / TRANSITION)
    return force


@lru_cache(maxsize=256)
def ball_moments(
    model: BallModel,
    bearing: CatalogueBearing,
    load: BearingLoad,
    speed: float,  # Speed of one ring against the other. [rad/s]
    oil: OilState,  # In the bearing.
) -> BallMoments:
    """Friction moments of a ball bearing. Theory (J38), (J40), (J41), (J42)."""
    omega, D_w = abs(speed), model.ball_diameter
    if not omega or not (load.radial or load.axial):
        return BallMoments(0.0, 0.0, 0.0)
    alpha = contact_angle(model, bearing, load.axial)
    loads = ball_loads(load, alpha, model.balls)
    loads = loads[loads > 0]
    gamma = D_w * math.cos(alpha) / bearing.pitch_diameter
    f = np.repeat(model.conformities, loads.size)
    Q = np.tile(loads, 2)
    R_x = np.repeat((1 - gamma, 1 + gamma), loads.size) * D_w / 2
    flatness = f * D_w / (2 * f - 1) / R_x
    # ellipse of Hertz after Hamrock and Brewe (1983)
    k, elliptic = 1.0339 * power(flatness, 0.636), 1.0003 + 0.5968 / flatness
    b = np.cbrt(6 * elliptic * Q * R_x / (math.pi * k * STEEL * (1 + 1 / flatness)))
    a = k * b
    pressure = 1.5 * Q / (math.pi * a * b)
    u = omega * bearing.pitch_diameter / 4 * (1 - gamma**2)
    thermal = oil.thermal_load(u)
    U, W = oil.dynamic_viscosity * u / (STEEL * R_x), Q / (STEEL * R_x**2)
    G = oil.pressure_viscosity * STEEL
    heat = inlet_film_factor(thermal, pressure / STEEL, 0.0)
    force = STEEL * R_x**2 * point_rolling_force(2 * U, W, G, flatness) * heat
    starved = model.skf.supply(bearing, speed, oil.kinematic_viscosity)
    hysteresis = 7.48e-7 * power(D_w / 2, 0.33, Q, 1.33) * (1 - 3.519e-3 * (flatness - 1) ** 0.8063)
    rolling = 2 * force * u * starved + hysteresis * u / (D_w / 2)
    spin = 3 / 8 * a * elliptic * omega * math.sin(alpha) / 2
    groove = 2 * f * D_w / (2 * f + 1)
    slip = np.hypot(spin, CURVATURE * u * a**2 / (groove * R_x))
    film = (
        2.69 * R_x * power(U, 0.67, W, -0.067) * math.pow(G, 0.53) * (1 - 0.61 * np.exp(-0.73 * k))
    )
    film = film * inlet_film_factor(thermal, np.zeros_like(Q), slip / u)
    # as long a line contact as has the width b and, in the mean, the pressure of the ellipse
    line = 8 / (3 * math.pi) * pressure
    contact = LineContacts(
        line_load=math.pi / 2 * line * b,
        radius=STEEL * b / (4 * line),
        rolling_speed=np.full_like(Q, u),
        sliding_speed=slip,
        flanks=Flanks(STEEL, *BALL_ROUGHNESS),
        oil=oil,
    )
    mu = mixed_friction(contact, AS_MADE, film=film)
    of_all = model.balls / POSITIONS / omega
    return BallMoments(
        float(rolling.sum()) * of_all, float((mu * Q * slip).sum()) * of_all, float(2 * U.max())
    )
