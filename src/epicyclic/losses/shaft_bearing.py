"""Catalogue bearings on shafts: friction after Palmgren and Harris or by a table, load, speed."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, ClassVar, NamedTuple, get_args

import numpy as np

from epicyclic.dataclass import dataclass
from epicyclic.losses.designations import SPHERICAL_ANGLE, THRUST_FACTORS
from epicyclic.losses.drag import (
    RPM,
    SPEED_PARAMETER,
    THICKEST,
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    bearing_viscous_loss,
    speed_parameter,
)
from epicyclic.losses.loss_table import LossTable
from epicyclic.losses.ranges import BearingType, Cage, ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.oil.oil import OilState
from epicyclic.units import NUMBER
from epicyclic.units import RPM as SPEED

BEARING_TYPES: tuple[BearingType, ...] = get_args(BearingType)
THRUST_TYPES = ("thrust-ball", "thrust-roller")
"""Bearings that carry no radial force."""


class TypeConstants(NamedTuple):
    """What formulas have of all bearings of a type."""

    viscous_factor: float  # f0 in an oil bath, Harris (1991); general knowledge. [1]
    # f1, Harris (1991); second hand. Balls: at a seventh of the static rating. Caged needle
    # rollers: an estimate, printed values run up to 0.002. [1]
    coefficient: float
    # f0r and f1r of ISO 15312, of light and medium series; second hand, general knowledge. Seats of
    # thrust bearings have another area than that of `thermal_excess`. [1]
    thermal: tuple[float, float] = (math.nan, math.nan)
    # n d_m of the limiting speed, in mm/min: medians of SKF's tables. Theory (J37).
    limit: float = math.inf


TYPE_CONSTANTS: Mapping[tuple[BearingType, Cage], TypeConstants] = {
    ("deep-groove", "caged"): TypeConstants(2.0, 0.0003, (2.0, 0.0002), 660e3),
    ("cylindrical", "caged"): TypeConstants(3.0, 0.0003, (2.5, 0.0003), 640e3),
    ("cylindrical", "full-complement"): TypeConstants(7.5, 0.00055, (5.0, 0.00055), 320e3),
    ("tapered", "caged"): TypeConstants(6.0, 0.0004, (3.0, 0.0004), 510e3),
    ("needle", "caged"): TypeConstants(12.0, 0.0005, (5.0, 0.0005), 490e3),
    ("needle", "full-complement"): TypeConstants(12.0, 0.00055, (5.0, 0.0005), 320e3),
    ("angular-contact", "caged"): TypeConstants(3.3, 0.0005, (2.0, 0.00025), 610e3),
    ("spherical", "caged"): TypeConstants(4.0, 0.00025, (4.0, 0.0002), 500e3),
    ("thrust-ball", "caged"): TypeConstants(THRUST_FACTORS["thrust-ball"], 0.0004),
    ("thrust-roller", "caged"): TypeConstants(THRUST_FACTORS["thrust-roller"], 0.0015),
}
"""By type and cage. The keys are the bearings there are."""
_OF_BALLS: Mapping[BearingType, tuple[float, float]] = {
    "deep-groove": (0.0009, 0.55),
    "angular-contact": (0.001, 0.33),
    "thrust-ball": (0.0008, 0.33),
}
"""z and y of Harris's f1 = z (P0/C0)^y; second hand. [1]"""
DEFAULT_FLANGE_COEFFICIENTS: Mapping[Cage, float] = {"caged": 0.002, "full-complement": 0.003}
"""f_f of cylindrical roller bearings with oil, Harris (1991); general knowledge. [1]"""
DEFAULT_MINIMUM_LOAD_FACTORS: Mapping[BearingType, float] = {
    "deep-groove": 0.025,
    "cylindrical": 0.15,
}
"""k_r in the middle of SKF's product tables; general knowledge. [1]"""
MINIMUM_LOAD_SHARE = 0.02
"""Least load of tapered and needle roller bearings over their dynamic load rating (SKF). [1]"""
MINIMUM_BALL_SHARE = 0.01
"""The same of angular contact ball bearings, SKF's rule of thumb for balls; second hand. Of
spherical roller bearings over their static load rating. [1]"""
CONTACT_ANGLES = (15, 20, 25, 30, 35, 40, 45)
_STATIC_AXIAL = CONTACT_ANGLES, (0.46, 0.42, 0.38, 0.33, 0.29, 0.26, 0.22)
"""Y0 of angular contact ball bearings by their angle in degrees, ISO 76. [1]"""
_THRUST_RATIOS = CONTACT_ANGLES, (0.46, 0.57, 0.68, 0.8, 0.95, 1.14, 1.34)
"""e of angular contact ball bearings by their angle in degrees, ISO 281; at 15 degrees, where it
depends on the load, its middle. [1]"""
PALMGREN_METHOD = "load-dependent moment after Palmgren"
HARRIS_METHOD = "load-dependent moment after Harris"
HARRIS_SOURCE = "T. A. Harris, Rolling Bearing Analysis, 3rd ed. (1991), second hand"

_MEANS = "mean coefficients of a bearing type, whose scatter was not found in print"
SHAFT_BEARING_RELIABILITY = {
    "houpert": "mean error against regressions of a four-point bearing 17 %, of a thrust one 24 %",
    "zhou-hoeprich": "mean error against three sets of measured tapered bearings 10, 14 and 9 %, "
    "against two of a cylindrical one 8 and 3 %, of a thrust one 10 and 7 %",
    "skf-2018": "formulas of a catalogue that states no error",
    "palmgren": _MEANS,
    "harris": _MEANS,
    "table": "given by the case",
}
"""How well each model is known to be right, as a phrase."""
TAPERED_ERRORS = {"zhou-hoeprich": 0.14, "palmgren": 0.85, "harris": 0.85, "skf-2018": 1.80}
"""Largest mean error of a model on a set of tapered bearings of `validate --measured`. [1]"""

_STATIC_RATIO = Range(
    "static_ratio", "equivalent static load over static load rating", None, 1.0, NUMBER,
    "static load rating of rolling bearings, ISO 76",
)  # fmt: skip
AXIAL_RATIO = Range(
    "axial_ratio", "axial over radial force of a cylindrical roller bearing", None, 0.4, NUMBER,
    "flange friction, Harris (1991), second hand",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class BearingLoad:
    """Load on a bearing."""

    pointwise = True

    radial: float  # Magnitudes. [N]
    axial: float  # Magnitudes. [N]


@dataclass(frozen=True, slots=True)
class CatalogueBearing:
    """A rolling bearing as a catalogue states it."""

    type: BearingType  # One of `BEARING_TYPES`.
    bore: float  # d. [m]
    outside_diameter: float  # D. [m]
    width: float = math.nan  # B. [m]
    cage: Cage = "caged"  # ``"caged"`` or ``"full-complement"``.
    dynamic_load_rating: float = math.nan  # C; NaN where it is unknown. [N]
    static_load_rating: float = math.nan  # C0; NaN where it is unknown. [N]
    # 0.4 cot of the contact angle, Y of a tapered roller bearing; NaN without such an angle. [1]
    axial_factor: float = math.nan
    # A designation whose load ratings here are estimates; empty if they are not.
    estimated: str = ""

    @property
    def contact_angle(self) -> float:
        """Of a tapered or angular contact bearing. [rad]"""
        return math.atan(0.4 / self.axial_factor)

    @property
    def thrust_ratio(self) -> float:
        """Axial force that a radial one induces, over it; 0 without an angle. Theory (J29). [1]"""
        if self.type == "tapered":
            return 1 / (2 * self.axial_factor)
        if self.type == "angular-contact":
            return float(np.interp(math.degrees(self.contact_angle), *_THRUST_RATIOS))
        return 0.0

    @property
    def centre_offset(self) -> float:
        """From the middle to where the lines of contact meet the axis. Theory (J30). [m]"""
        return self.pitch_diameter / 2 * math.tan(self.contact_angle) if self.thrust_ratio else 0.0

    @property
    def pitch_diameter(self) -> float:
        """d_m, the mean of bore and outside diameter. [m]"""
        return (self.bore + self.outside_diameter) / 2


@dataclass(frozen=True, slots=True)
class FrictionPart:
    """One part of the friction of a bearing."""

    key: str  # ``"mechanical"``, ``"viscous"``, ``"drag"`` or ``"friction"``.
    by_load: bool  # True if the part grows with the load.
    watts: float  # [W]
    method: str  # The model.
    source: str  # Where it is printed.


def bearing_types(model: str) -> tuple[BearingType, ...]:
    """The bearing types of a model, as a case names it.

    Neither Harris's table nor SKF's here has needle roller bearings, SKF's here no angular contact,
    spherical and thrust ones.
    """
    if model == "zhou-hoeprich":
        return ("tapered", "cylindrical", "thrust-roller")
    if model == "houpert":
        return tuple(_OF_BALLS)
    if model == "skf-2018":
        return ("deep-groove", "cylindrical", "tapered")
    return tuple(kind for kind in BEARING_TYPES if model != "harris" or kind != "needle")


def friction_load(bearing: CatalogueBearing, load: BearingLoad) -> float:
    """Load P1 that sets the load-dependent friction of a bearing. Theory (J1). [N]

    Deep groove: the larger of F_r and 3 F_a - 0.1 F_r; angular contact: of F_r and
    0.9 cot(alpha) F_a - 0.1 F_r; tapered: of F_r and 2 Y F_a; spherical: of F_r and
    0.8 cot(alpha) F_a; thrust: F_a; cylindrical and needle: F_r. Harris (1991), second hand.
    """
    if bearing.type in THRUST_TYPES:
        return load.axial
    if bearing.type == "spherical":
        return max(load.radial, 0.8 * load.axial / math.tan(SPHERICAL_ANGLE))
    if bearing.type == "angular-contact":
        return max(load.radial, 2.25 * bearing.axial_factor * load.axial - 0.1 * load.radial)
    if bearing.type == "deep-groove":
        return max(load.radial, 3 * load.axial - 0.1 * load.radial)
    if bearing.type == "tapered" and load.axial > 0:
        return max(load.radial, 2 * bearing.axial_factor * load.axial)
    return load.radial


def static_load(bearing: CatalogueBearing, load: BearingLoad) -> float:
    """Equivalent static load P0 of ISO 76. Theory (J2). [N]

    Deep groove: the larger of F_r and 0.6 F_r + 0.5 F_a; angular contact: of F_r and
    0.5 F_r + Y0 F_a; tapered: of F_r and 0.5 F_r + 0.55 Y F_a; spherical:
    F_r + 0.44 cot(alpha) F_a; thrust: F_a; cylindrical and needle: F_r.
    """
    if bearing.type in THRUST_TYPES:
        return load.axial
    if bearing.type == "spherical":
        return load.radial + 0.44 * load.axial / math.tan(SPHERICAL_ANGLE)
    if bearing.type == "angular-contact":
        Y0 = float(np.interp(math.degrees(bearing.contact_angle), *_STATIC_AXIAL))
        return max(load.radial, 0.5 * load.radial + Y0 * load.axial)
    if bearing.type == "deep-groove":
        return max(load.radial, 0.6 * load.radial + 0.5 * load.axial)
    if bearing.type == "tapered" and load.axial > 0:
        return max(load.radial, 0.5 * load.radial + 0.55 * bearing.axial_factor * load.axial)
    return load.radial


def harris_coefficient(bearing: CatalogueBearing, load: BearingLoad) -> float:
    """Coefficient f1 after Harris. Theory (J3). [1]

    Deep groove: 0.0009 (P0/C0)^0.55; angular contact: 0.001 (P0/C0)^0.33; thrust balls:
    0.0008 (P0/C0)^0.33; rollers: constant, `TYPE_CONSTANTS`. Harris (1991), second hand.
    Raises `ValueError` for needle roller bearings, which Harris's table does not have.
    """
    if bearing.type not in bearing_types("harris"):
        raise ValueError(f"Harris gives no coefficient for {bearing.type} bearings")
    if bearing.type not in _OF_BALLS:
        return TYPE_CONSTANTS[bearing.type, bearing.cage].coefficient
    factor, exponent = _OF_BALLS[bearing.type]
    return factor * math.pow(static_load(bearing, load) / bearing.static_load_rating, exponent)


def load_moment(
    bearing: CatalogueBearing, load: BearingLoad, coefficient: float, flange_coefficient: float
) -> float:
    """Load-dependent friction moment f1 P1 d_m, with flange friction f_f F_a d_m. [N m]

    Theory (J4). Palmgren; Harris (1991), second hand. Only the flanges of cylindrical roller
    bearings count.
    """
    moment = coefficient * friction_load(bearing, load)
    if bearing.type == "cylindrical":
        moment += flange_coefficient * load.axial
    return moment * bearing.pitch_diameter


class Flagged:
    """What flags of models of the moment have in common."""

    __slots__ = ()

    axial_range: ClassVar = AXIAL_RATIO  # Of the forces on a cylindrical roller bearing.
    # The part that thick oil makes uncertain, and its range of viscosities.
    thickest: ClassVar[tuple[str, Range]] = ("viscous", THICKEST)

    def flags(
        self: Any, where: str, bearing: CatalogueBearing, load: BearingLoad, speed: float,
        oil: OilState,
    ) -> tuple[ValidityFlag, ...]:  # fmt: skip
        """Flags on speed, static load, thick oil and, of cylindrical rollers, axial force."""
        use = ModelUse("bearing", self.name, where)
        found = load_flags(use, self.axial_range, bearing, load, speed)
        (key, limit), values = self.thickest, {"viscosity": oil.dynamic_viscosity}
        if not check_ranges(use, (limit,), values):
            return found
        watts = {part.key: part.watts for part in self.parts(bearing, load, speed, oil)}[key]
        return found + (check_ranges(use, (limit,), values, watts=watts) if watts else ())


@dataclass(frozen=True, slots=True)
class PalmgrenModel(Flagged):
    """Load-dependent moment after Palmgren or Harris, with the viscous moment of both."""

    viscous_factor: float  # f0. [1]
    # f1 after Palmgren; None to take that of Harris, `harris_coefficient`. [1]
    constant: float | None
    flange_coefficient: float = 0.0  # f_f of a cylindrical roller bearing under axial force. [1]

    terms: ClassVar = ("mechanical", "viscous")
    depends_on_load: ClassVar = True

    @property
    def name(self) -> str:
        """As a case has it."""
        return "harris" if self.constant is None else "palmgren"

    def coefficient(self, bearing: CatalogueBearing, load: BearingLoad) -> float:
        """f1. [1]"""
        return harris_coefficient(bearing, load) if self.constant is None else self.constant

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``mechanical`` and ``viscous``. [W]"""
        moment = load_moment(
            bearing, load, self.coefficient(bearing, load), self.flange_coefficient
        )
        viscous = bearing_viscous_loss(
            self.viscous_factor, oil.kinematic_viscosity, speed, bearing.pitch_diameter
        )
        method = HARRIS_METHOD if self.constant is None else PALMGREN_METHOD
        return (
            FrictionPart("mechanical", True, moment * abs(speed), method, HARRIS_SOURCE),
            FrictionPart("viscous", False, viscous, VISCOUS_METHOD, VISCOUS_SOURCE),
        )


class WithoutCoefficient(Flagged):
    """A model that does not scale the load by one coefficient."""

    __slots__ = ()

    name: ClassVar[str]

    def coefficient(self, bearing: CatalogueBearing, load: BearingLoad) -> float:
        """NaN: the model has no f1."""
        return math.nan


@dataclass(frozen=True, slots=True)
class TableModel(WithoutCoefficient):
    """Friction of a bearing from a table over speed, temperature or radial force."""

    table: LossTable

    name: ClassVar = "table"
    terms: ClassVar = ("friction",)

    @property
    def depends_on_load(self) -> bool:
        """True if the table has the radial force as an axis."""
        return "radial_force" in self.table.names

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``friction``, all of it. [W]"""
        watts = self.table.loss(speed=speed, temperature=oil.temperature, radial_force=load.radial)
        return (
            FrictionPart("friction", self.depends_on_load, watts, "loss table", self.table.source),
        )

    def flags(
        self, where: str, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[ValidityFlag, ...]:
        """Flags on values beyond the table."""
        use = ModelUse("bearing", "table", where)
        return self.table.flags(
            use, speed=speed, temperature=oil.temperature, radial_force=load.radial
        )


@dataclass(frozen=True, slots=True)
class AxialSpring:
    """How the rings of a tapered or angular contact bearing approach each other."""

    elements: int
    diameter: float  # D_w. [m]
    length: float  # Of a roller; 0 for balls. [m]
    contact_angle: float  # [rad]

    def approach(self, force: float) -> float:
        """Axial approach of the rings under an axial force, after Palmgren. Theory (J32). [m]

        Examples
        --------
        >>> round(1e6 * AxialSpring(14, 12e-3, 0.0, 0.7).approach(1000.0), 1)
        6.9
        """
        sine = math.sin(self.contact_angle)
        Q = force / (self.elements * sine)
        if not self.length:
            return 1e-3 * 4.4e-4 / sine * math.cbrt(Q**2 / (1e3 * self.diameter))
        return 1e-3 * 7.7e-5 / sine * math.pow(Q, 0.9) / math.pow(1e3 * self.length, 0.8)


def preload_of(displacement: float, springs: tuple[AxialSpring, AxialSpring]) -> float:
    """Force with which two bearings press each other if their rings approach so far. [N]

    `displacement` is that of both bearings together. [m]
    """
    from scipy.optimize import brentq

    def excess(force: float) -> float:
        return sum(spring.approach(force) for spring in springs) - displacement

    high = 1.0
    while excess(high) < 0:
        high *= 2
    return float(brentq(excess, 0, high))


def minimum_load(
    bearing: CatalogueBearing,  # All but deep groove and cylindrical need its dynamic load rating.
    speed: float,  # Speed of one ring against the other. [rad/s]
    viscosity: float,  # Kinematic, of the oil. [m^2/s]
    # k_r of the product table; by default 0.025 (deep groove) or 0.15 (cylindrical). [1]
    factor: float | None = None,
    # Reference speed of a cylindrical roller bearing. Without it the part that grows with the speed
    # is left out. [rad/s]
    reference_speed: float | None = None,
) -> float:
    """Load below which the rolling elements may slip, after SKF; NaN where it is unknown. [N]

    Theory (J13).
    """
    if bearing.type in ("tapered", "needle"):
        return MINIMUM_LOAD_SHARE * bearing.dynamic_load_rating
    if bearing.type == "angular-contact":
        return MINIMUM_BALL_SHARE * bearing.dynamic_load_rating
    if bearing.type == "spherical":
        return MINIMUM_BALL_SHARE * bearing.static_load_rating
    if bearing.type in THRUST_TYPES:
        return math.nan  # by a constant of the product table
    k_r = DEFAULT_MINIMUM_LOAD_FACTORS[bearing.type] if factor is None else factor
    size = 1e3 * k_r * (10 * bearing.pitch_diameter) ** 2
    if bearing.type == "deep-groove":
        return size * math.pow(1e3 * viscosity * abs(speed) / RPM, 2 / 3)
    return size * (6 + (4 * abs(speed) / reference_speed if reference_speed else 0.0))


THERMAL_VISCOSITY = 12e-6  # Reference viscosity at 70 degC. [m^2/s]
THERMAL_LOAD = 0.05  # Reference load over the static load rating. [1]
THERMAL_DENSITY, THERMAL_AREA, THERMAL_EXPONENT = 0.016e6, 0.05, -0.34
"""Heat that a seat takes up for its area [W/m^2], and how that falls beyond an area [m^2]."""
RATING_STEP = 1e-6  # To which the rating is found. [rad/s]
RATING_STEPS = 10**18  # Steps, beyond the rating of any bearing, however small.


def thermal_excess(bearing: CatalogueBearing, speed: float) -> float:
    """Own heat of a bearing in an oil bath less what its seats take up at 70 degC. [W]

    Theory (J35). NaN without width or static load rating.
    """
    diameter = bearing.pitch_diameter
    area = math.pi * 2 * diameter * bearing.width
    heat = THERMAL_DENSITY * area * max(1.0, area / THERMAL_AREA) ** THERMAL_EXPONENT
    viscous, mechanical = TYPE_CONSTANTS[bearing.type, bearing.cage].thermal
    own = bearing_viscous_loss(viscous, THERMAL_VISCOSITY, speed, diameter)
    load = THERMAL_LOAD * bearing.static_load_rating
    return float(own + mechanical * load * diameter * speed - heat)


def limiting_speed(bearing: CatalogueBearing) -> float:
    """Speed that cage and rolling elements stand, as of its type. Theory (J37). [rad/s]

    Infinite where nothing is known.

    Examples
    --------
    >>> round(limiting_speed(CatalogueBearing("tapered", 0.03, 0.055, 0.017)) / RPM)
    12000
    """
    return 1e-3 * TYPE_CONSTANTS[bearing.type, bearing.cage].limit * RPM / bearing.pitch_diameter


def limit_text(
    speed: float,  # [rad/s]
    limit: float,  # That it exceeds. [rad/s]
    stated: bool,  # True if the case gives it.
) -> str:
    """What to say of a speed beyond the limiting speed."""
    whose = "" if stated else " (estimated from SKF's tables)"
    return (
        f"{SPEED.text(abs(speed), 4)} exceed the limiting speed of cage and rolling elements, "
        f"{SPEED.text(limit, 2)}{whose}. No model covers the loss above it; give the "
        "limiting_speed of the catalogue, or choose another bearing."
    )


@lru_cache(maxsize=256)
def thermal_speed_rating(bearing: CatalogueBearing) -> float:
    """Speed at which a bearing in an oil bath heats itself from 20 to 70 degC. [rad/s]

    Theory (J35). NaN without width or static load rating.

    Examples
    --------
    >>> ball = CatalogueBearing("deep-groove", 0.04, 0.08, 0.018, static_load_rating=19e3)
    >>> round(thermal_speed_rating(ball) / RPM)
    9297
    """
    if math.isnan(thermal_excess(bearing, 0.0)):
        return math.nan
    # scipy.optimize would take a third of a second and 30 MB for this one root
    return RATING_STEP * bisect_left(
        range(RATING_STEPS), 0.0, key=lambda steps: thermal_excess(bearing, RATING_STEP * steps)
    )


def load_flags(
    use: ModelUse,
    axial: Range,
    bearing: CatalogueBearing,
    load: BearingLoad,
    speed: float,
    speeds: Range = SPEED_PARAMETER,
) -> tuple[ValidityFlag, ...]:
    """Flags on speed, static load and, of cylindrical rollers, the ratio `axial` of the forces."""
    if speed == 0:
        return ()
    ranges = [speeds]
    values = {"speed_parameter": speed_parameter(speed, bearing.pitch_diameter)}
    if not math.isnan(bearing.static_load_rating):
        ranges.append(_STATIC_RATIO)
        values["static_ratio"] = static_load(bearing, load) / bearing.static_load_rating
    if bearing.type == "cylindrical" and load.axial > 0:
        ranges.append(axial)
        values["axial_ratio"] = load.axial / load.radial if load.radial > 0 else math.inf
    return check_ranges(use, ranges, values)
