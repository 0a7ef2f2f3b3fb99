"""Basic and modified life of rolling bearings after ISO 281, of planets and on shafts."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from epicyclic.dataclass import dataclass
from epicyclic.losses.designations import SPHERICAL_ANGLE
from epicyclic.losses.shaft_bearing import (
    CONTACT_ANGLES,
    THRUST_TYPES,
    BearingLoad,
    CatalogueBearing,
)
from epicyclic.plugins.design import iso_6336 as iso

BALLS = ("deep-groove", "angular-contact", "thrust-ball")
STATIC_FACTOR = 14.0  # f_0 of deep groove ball bearings, 12 to 16; estimate. [1]
_AXIAL = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)  # f_0 F_a/C_0.
_GROOVE_RATIO = (0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44)  # e.
_GROOVE_FACTOR = (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00)  # Y; X is 0.56.
_ANGULAR_RADIAL = CONTACT_ANGLES, (0.44, 0.43, 0.41, 0.39, 0.37, 0.35, 0.33)  # X.
_ANGULAR_AXIAL = CONTACT_ANGLES, (1.23, 1.00, 0.87, 0.76, 0.66, 0.57, 0.50)  # Y.


@dataclass(frozen=True, slots=True, kw_only=True)
class BearingRating:
    """Life of one bearing; NaN where a load rating is unknown."""

    key: str
    load: float  # P. [N]
    speed: float  # Of one ring against the other. [rad/s]
    dynamic_load_rating: float  # C. [N]
    viscosity_ratio: float  # kappa. [1]
    life_factor: float  # a_ISO. [1]
    basic_life: float  # L10. [s]
    modified_life: float  # L10m. [s]


def dynamic_load(bearing: CatalogueBearing, load: BearingLoad) -> float:
    """Equivalent dynamic load P = X F_r + Y F_a. ISO 281:2007, Tables 3, 7 and 10, second hand. [N]

    Thrust bearings F_a; cylindrical and needle rollers F_r; the others F_r up to F_a/F_r = e, of
    spherical rollers F_r + 0.45 cot(alpha) F_a. Angular contact balls of 15 degrees have the middle
    of the values that depend on the load.

    Examples
    --------
    >>> round(dynamic_load(CatalogueBearing("tapered", 0.03, 0.062, axial_factor=1.6),
    ...                    BearingLoad(2000.0, 1500.0)))
    3200
    """
    radial, axial, factor = load.radial, load.axial, bearing.axial_factor
    if bearing.type in THRUST_TYPES:
        return axial
    if not axial or bearing.type in ("cylindrical", "needle"):
        return radial
    match bearing.type:
        case "spherical":
            cotangent = 1 / math.tan(SPHERICAL_ANGLE)
            light = axial * cotangent <= 1.5 * radial
            return (1.0 if light else 0.67) * radial + (0.45 if light else 0.67) * cotangent * axial
        case "tapered":
            limit, X, Y = 0.6 / factor, 0.4, factor
        case "angular-contact":
            angle, limit = math.degrees(bearing.contact_angle), bearing.thrust_ratio
            X = float(np.interp(angle, *_ANGULAR_RADIAL))
            Y = float(np.interp(angle, *_ANGULAR_AXIAL))
        case _:  # balls in deep grooves
            share = STATIC_FACTOR * axial / bearing.static_load_rating
            limit = float(np.interp(share, _AXIAL, _GROOVE_RATIO))
            X, Y = 0.56, float(np.interp(share, _AXIAL, _GROOVE_FACTOR))
    return radial if axial <= limit * radial else X * radial + Y * axial


def bearing_rating(
    key: str,
    bearing: CatalogueBearing,
    load: float,  # P. [N]
    speed: float,  # [rad/s]
    viscosity: float,  # Kinematic, of the oil at the bearing. [m^2/s]
    contamination: float,  # e_C. [1]
) -> BearingRating:
    """L10 and L10m. ISO 281:2007, 6 to 9; C_u by its simple estimate, C0/22 or C0/8.2."""
    balls, pitch = bearing.type in BALLS, iso.MM * bearing.pitch_diameter
    size = max(1.0, pitch / 100) ** (-0.5 if balls else -0.3)
    fatigue = bearing.static_load_rating / (22 if balls else 8.2) * size
    rpm = speed * 30 / math.pi
    needed = 45_000 * math.pow(rpm, -0.83) if rpm < 1000 else 4500 * math.pow(rpm, -0.5)
    kappa = viscosity * 1e6 / (needed / math.sqrt(pitch))
    factor = life_modification(
        kappa, contamination * fatigue / load, balls, bearing.type in THRUST_TYPES
    )
    rating = bearing.dynamic_load_rating
    basic = math.pow(rating / load, 3 if balls else 10 / 3) * 1e6 * 2 * math.pi / speed
    return BearingRating(
        key=key,
        load=load,
        speed=speed,
        dynamic_load_rating=rating,
        viscosity_ratio=kappa,
        life_factor=factor,
        basic_life=basic,
        modified_life=factor * basic,
    )


@cache
def life_modification(
    kappa: float, load_ratio: float, balls: bool = False, thrust: bool = False
) -> float:
    """a_ISO with e_C C_u/P, at most 50. ISO 281:2007, Eq. 31 to 42. [1]

    Examples
    --------
    >>> round(life_modification(1.0, 0.2), 2), round(life_modification(1.0, 0.2, balls=True), 2)
    (0.65, 6.92)
    """
    held = min(max(kappa, 0.1), 4.0)
    scale, exponent = (1.3993, 0.054381) if held < 0.4 else (1.2348, 0.19087)
    if held >= 1:
        exponent = 0.071739
    first, power, outer = 1.5859, 0.4, -9.185
    if balls:
        first, power, outer = 2.5671, 1 / 3, -9.3
        scale = 2.2649 if held < 0.4 else 1.9987
    if thrust:
        load_ratio /= 3.0 if balls else 2.5
    bracket = first - scale / math.pow(held, exponent)
    inner = 1 - (bracket**0.83 if balls else bracket) * math.pow(load_ratio, power)
    if inner <= 0:
        return 50.0
    return min(0.1 * math.pow(inner, outer), 50.0)  # in this order NaN stays
