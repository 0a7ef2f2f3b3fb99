"""Friction of catalogue bearings on shafts: Zhou-Hoeprich, SKF, Palmgren, Harris, or a table."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from importlib import resources
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from epicyclic.kernels.line_contact import (
    asperity_share,
    equivalent_modulus,
    hertz_pressure,
    inlet_film_factor,
)
from epicyclic.losses.designations import SPHERICAL_ANGLE
from epicyclic.losses.drag import (
    RPM,
    SPEED_PARAMETER,
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    bearing_viscous_loss,
    speed_parameter,
)
from epicyclic.losses.loss_table import LossTable
from epicyclic.losses.ranges import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.oil.oil import OilState
from epicyclic.units import MILLIMETRE, MILLIPASCAL_SECOND, NUMBER

BearingType = Literal[
    "deep-groove",
    "cylindrical",
    "tapered",
    "needle",
    "angular-contact",
    "spherical",
    "thrust-ball",
    "thrust-roller",
]
Cage = Literal["caged", "full-complement"]

BEARING_TYPES: tuple[BearingType, ...] = get_args(BearingType)
THRUST_TYPES = ("thrust-ball", "thrust-roller")
"""Bearings that carry no radial force."""
DEFAULT_VISCOUS_FACTORS: Mapping[tuple[BearingType, Cage], float] = {
    ("deep-groove", "caged"): 2.0,
    ("cylindrical", "caged"): 3.0,
    ("cylindrical", "full-complement"): 7.5,
    ("tapered", "caged"): 6.0,
    ("needle", "caged"): 12.0,
    ("needle", "full-complement"): 12.0,
    ("angular-contact", "caged"): 3.3,
    ("spherical", "caged"): 4.0,
    ("thrust-ball", "caged"): 1.5,
    ("thrust-roller", "caged"): 3.5,
}
"""f0 in an oil bath, Harris (1991); general knowledge. The keys are the bearings there are. [1]"""
DEFAULT_COEFFICIENTS: Mapping[tuple[BearingType, Cage], float] = {
    ("deep-groove", "caged"): 0.0003,
    ("cylindrical", "caged"): 0.0003,
    ("cylindrical", "full-complement"): 0.00055,
    ("tapered", "caged"): 0.0004,
    ("needle", "caged"): 0.0005,
    ("needle", "full-complement"): 0.00055,
    ("angular-contact", "caged"): 0.0005,
    ("spherical", "caged"): 0.00025,
    ("thrust-ball", "caged"): 0.0004,
    ("thrust-roller", "caged"): 0.0015,
}
"""f1, Harris (1991); second hand. Balls: at a seventh of the static rating. Caged needle
rollers: an estimate, printed values run up to 0.002. [1]"""
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
_ANGLES = (15, 20, 25, 30, 35, 40, 45)
_STATIC_AXIAL = _ANGLES, (0.46, 0.42, 0.38, 0.33, 0.29, 0.26, 0.22)
"""Y0 of angular contact ball bearings by their angle in degrees, ISO 76. [1]"""
_THRUST_RATIOS = _ANGLES, (0.46, 0.57, 0.68, 0.8, 0.95, 1.14, 1.34)
"""e of angular contact ball bearings by their angle in degrees, ISO 281; at 15 degrees, where it
depends on the load, its middle. [1]"""
PALMGREN_METHOD = "load-dependent moment after Palmgren"
HARRIS_METHOD = "load-dependent moment after Harris"
HARRIS_SOURCE = "T. A. Harris, Rolling Bearing Analysis, 3rd ed. (1991), second hand"

_MEANS = "mean coefficients of a bearing type, whose scatter was not found in print"
SHAFT_BEARING_RELIABILITY = {
    "zhou-hoeprich": "mean error against three sets of measured tapered bearings 10, 14 and 9 %, "
    "against two of a cylindrical one 8 and 3 %",
    "skf-2018": "formulas of a catalogue that states no error",
    "palmgren": _MEANS,
    "harris": _MEANS,
    "table": "given by the case",
}
"""How well each model is known to be right, as a phrase."""

_STATIC_RATIO = Range(
    "static_ratio",
    "equivalent static load over static load rating",
    None,
    1.0,
    NUMBER,
    "static load rating of rolling bearings, ISO 76",
)
AXIAL_RATIO = Range(
    "axial_ratio",
    "axial over radial force of a cylindrical roller bearing",
    None,
    0.4,
    NUMBER,
    "flange friction, Harris (1991), second hand",
)


@dataclass(frozen=True, slots=True)
class BearingLoad:
    """Load on a bearing."""

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
    method: str  # The model and where it is printed.
    source: str  # The model and where it is printed.


def bearing_types(model: str) -> tuple[BearingType, ...]:
    """The bearing types of a model, as a case names it.

    Neither Harris's table nor SKF's here has needle roller bearings, SKF's here no angular contact,
    spherical and thrust ones.
    """
    if model == "zhou-hoeprich":
        return ("tapered", "cylindrical")
    if model == "skf-2018":
        return ("deep-groove", "cylindrical", "tapered")
    return tuple(kind for kind in BEARING_TYPES if model != "harris" or kind != "needle")


# --- Palmgren and Harris --------------------------------------------------------------------------


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
    0.0008 (P0/C0)^0.33; rollers: constant, `DEFAULT_COEFFICIENTS`. Harris (1991), second hand.
    Raises `ValueError` for needle roller bearings, which Harris's table does not have.
    """
    if bearing.type not in bearing_types("harris"):
        raise ValueError(f"Harris gives no coefficient for {bearing.type} bearings")
    if bearing.type not in _OF_BALLS:
        return DEFAULT_COEFFICIENTS[bearing.type, bearing.cage]
    factor, exponent = _OF_BALLS[bearing.type]
    ratio = static_load(bearing, load) / bearing.static_load_rating
    return factor * math.pow(ratio, exponent)


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


@dataclass(frozen=True, slots=True)
class PalmgrenModel:
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

    def flags(
        self, where: str, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[ValidityFlag, ...]:
        """Flags on speed, static load and, of cylindrical rollers, axial force."""
        return load_flags(ModelUse("bearing", self.name, where), AXIAL_RATIO, bearing, load, speed)


class _WithoutCoefficient:
    __slots__ = ()

    def coefficient(self, bearing: CatalogueBearing, load: BearingLoad) -> float:
        """NaN: the model has no f1."""
        return math.nan


# --- table of the user ----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class TableModel(_WithoutCoefficient):
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


# --- preload --------------------------------------------------------------------------------------


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
        7.2
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

    high = 1.0
    while sum(spring.approach(high) for spring in springs) < displacement:
        high *= 2
    return float(
        brentq(
            lambda force: sum(spring.approach(force) for spring in springs) - displacement, 0, high
        )
    )


# --- load and range -------------------------------------------------------------------------------


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


THERMAL_FACTORS: Mapping[tuple[BearingType, Cage], tuple[float, float]] = {
    ("deep-groove", "caged"): (2.0, 0.0002),
    ("cylindrical", "caged"): (2.5, 0.0003),
    ("cylindrical", "full-complement"): (5.0, 0.00055),
    ("tapered", "caged"): (3.0, 0.0004),
    ("needle", "caged"): (5.0, 0.0005),
    ("needle", "full-complement"): (5.0, 0.0005),
    ("angular-contact", "caged"): (2.0, 0.00025),
    ("spherical", "caged"): (4.0, 0.0002),
    ("thrust-ball", "caged"): (math.nan, math.nan),
    ("thrust-roller", "caged"): (math.nan, math.nan),
}
"""f0r and f1r of ISO 15312, of light and medium series; second hand, general knowledge. Seats of
thrust bearings have another area than that below. [1]"""
THERMAL_VISCOSITY = 12e-6  # Reference viscosity at 70 degC. [m^2/s]
THERMAL_LOAD = 0.05  # Reference load over the static load rating. [1]
THERMAL_DENSITY, THERMAL_AREA, THERMAL_EXPONENT = 0.016e6, 0.05, -0.34
"""Heat that a seat takes up for its area [W/m^2], and how that falls beyond an area [m^2]."""
LIMITING_SPEEDS: Mapping[tuple[BearingType, Cage], float] = {
    ("deep-groove", "caged"): 660e3,
    ("cylindrical", "caged"): 640e3,
    ("tapered", "caged"): 510e3,
    ("angular-contact", "caged"): 610e3,
}
"""n d_m of the limiting speed, in mm/min: the medians of 31, 9, 27 and 9 bearings with bores up to
20, 25, 32 and 25 mm as SKF's tables print them; they scatter by 20, 4, 8 and 7 %. Second hand."""
FASTEST = 1e12  # Beyond the rating of any bearing, however small. [rad/s]


def thermal_excess(bearing: CatalogueBearing, speed: float) -> float:
    """Own heat of a bearing in an oil bath less what its seats take up at 70 degC. [W]

    Theory (J35). NaN without width or static load rating.
    """
    diameter = bearing.pitch_diameter
    area = math.pi * 2 * diameter * bearing.width
    heat = THERMAL_DENSITY * area * max(1.0, area / THERMAL_AREA) ** THERMAL_EXPONENT
    viscous, mechanical = THERMAL_FACTORS[bearing.type, bearing.cage]
    own = bearing_viscous_loss(viscous, THERMAL_VISCOSITY, speed, diameter)
    load = THERMAL_LOAD * bearing.static_load_rating
    return float(own + mechanical * load * diameter * speed - heat)


def limiting_speed(bearing: CatalogueBearing) -> float:
    """Speed that its cage stands, as of small bearings of the type. Theory (J37). [rad/s]

    Infinite where nothing is known.

    Examples
    --------
    >>> round(limiting_speed(CatalogueBearing("tapered", 0.03, 0.055, 0.017)) / RPM)
    12000
    """
    known = LIMITING_SPEEDS.get((bearing.type, bearing.cage), math.inf)
    return 1e-3 * known * RPM / bearing.pitch_diameter


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
    from scipy.optimize import brentq

    if math.isnan(thermal_excess(bearing, 0.0)):
        return math.nan
    return float(brentq(lambda speed: thermal_excess(bearing, speed), 0.0, FASTEST))


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


# SKF's friction model of 2018 for deep groove, cylindrical and tapered roller bearings.
#
# Forces, lengths and speeds are SI. The printed formulas take N, mm, mm^2/s, rpm and give N mm; the
# conversion is done once, in `_printed`. The constants of the series are in the library,
# ``bearings/skf-2018.toml``.

STARVATION: Mapping[str, float] = {"jet": 3e-8, "oil-bath": 3e-8, "grease": 6e-8, "oil-air": 6e-8}
"""K_rs by lubrication: oil jet, low oil bath, grease, oil and air (SKF 2018). [1]"""
LARGEST_DRAG_VARIABLE = 0.0012  # V_M of a ball bearing that is fully submerged (SKF 2018). [1]
SUBMERGED = 1.2
"""Oil level over pitch diameter at which a bearing is fully submerged (SKF 2018). [1]"""
BOUNDARY_FRICTION = 0.12
STARTING_FRICTION = 0.15  # mu_bl in motion and at the start (SKF 2018). [1]

SKF_SOURCE = "SKF, Rolling bearings, catalogue (2018)"
_AXIAL_RATIO = replace(
    AXIAL_RATIO, high=0.5, source="axial load of cylindrical roller bearings, SKF"
)


@dataclass(frozen=True, slots=True)
class SkfConstants:
    """Constants of one series in SKF's model."""

    rolling_1: float  # R1 and R2 of G_rr.
    rolling_2: float  # R1 and R2 of G_rr.
    sliding_1: float  # S1 and S2 of G_sl.
    sliding_2: float  # S1 and S2 of G_sl.
    bearing_factor: float  # K_Z and K_L. [1]
    roller_length_factor: float  # K_Z and K_L. [1]
    ball_rows: int  # i_rw; 0 for rollers.
    # True if R and S were checked against a publication; False if they are second hand.
    is_read: bool


def seal_moment(
    diameter: float,  # d_s, of the counterface. [m]
    factor: float,  # K_S1, for d_s in mm and a moment in N mm.
    exponent: float,  # beta. [1]
    constant: float,  # K_S2. [N m]
) -> float:
    """M_seal of the contact seals of a bearing, both together. Theory (J12). [N m]"""
    return 1e-3 * factor * math.pow(diameter * 1e3, exponent) + constant


@dataclass(frozen=True, slots=True)
class SkfMoments:
    """Friction moments of SKF's model."""

    rolling: float  # M_rr. [N m]
    sliding: float  # M_sl. [N m]
    seal: float  # M_seal. [N m]
    drag: float  # M_drag. [N m]


class _SlidesAsSkf(_WithoutCoefficient):
    __slots__ = ()

    name: ClassVar[str]

    def flags(
        self, where: str, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[ValidityFlag, ...]:
        """Flags on speed, static load and, of cylindrical rollers, axial force."""
        return load_flags(ModelUse("bearing", self.name, where), _AXIAL_RATIO, bearing, load, speed)


@dataclass(frozen=True, slots=True)
class SkfModel(_SlidesAsSkf):
    """SKF's friction model of 2018."""

    constants: SkfConstants
    full_film_friction: float  # mu_EHL, `full_film_friction`. [1]
    starvation: float = STARVATION["jet"]  # K_rs, a value of `STARVATION`. [1]
    # H above the lowest point of the outer raceway; 0 without an oil bath. [m]
    oil_level: float = 0.0
    # V_M at this oil level; None for the estimate of `drag_variable`. [1]
    drag_variable: float | None = None
    seal_moment: float = 0.0  # M_seal, by `seal_moment`. [N m]

    name: ClassVar = "skf-2018"
    terms: ClassVar = ("mechanical", "drag")
    depends_on_load: ClassVar = True

    def reduction_factors(
        self, bearing: CatalogueBearing, speed: float, viscosity: float
    ) -> tuple[float, float]:
        """`skf_reduction_factors`; a bearing under oil does not starve."""
        hot, dry = skf_reduction_factors(bearing, self.constants, self.starvation, speed, viscosity)
        return hot, 1.0 if self.oil_level >= SUBMERGED * bearing.pitch_diameter else dry

    @property
    def drag_is_estimated(self) -> bool:
        """True if there is an oil bath and `drag_variable` is not given."""
        return self.oil_level > 0 and self.drag_variable is None

    @property
    def source(self) -> str:
        """Where the model is printed, and whether the constants are second hand."""
        return SKF_SOURCE if self.constants.is_read else f"{SKF_SOURCE}, constants second hand"

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``mechanical``, rolling and sliding, and ``drag``, with that of the seals. [W]"""
        moments = skf_moments(self, bearing, load, speed, oil.kinematic_viscosity)
        by_load = (moments.rolling + moments.sliding) * abs(speed)
        others = (moments.drag + moments.seal) * abs(speed)
        return (
            FrictionPart("mechanical", True, by_load, "rolling and sliding, SKF 2018", self.source),
            FrictionPart("drag", False, others, "drag in the oil and seals, SKF 2018", self.source),
        )


@cache
def _skf_tables() -> Mapping[str, Any]:
    file = resources.files("epicyclic.library").joinpath("bearings", "skf-2018.toml")
    return tomllib.loads(file.read_text(encoding="utf-8"))


def skf_series(kind: BearingType) -> tuple[str, ...]:
    """The series of a bearing type with a cage in SKF's table; empty for needle rollers."""
    return tuple(
        name
        for row in _skf_tables()["rows"]
        if row["type"] == kind
        for name in row["series"]
        if name != "full-complement"
    )


def skf_constants(kind: BearingType, series: str, cage: Cage = "caged") -> SkfConstants:
    """The constants of a series; those of full complement bearings are the same for all series.

    Raises `KeyError` if SKF's table has no such bearing.
    """
    wanted = series if cage == "caged" else cage
    tables = _skf_tables()
    rows = (row for row in tables["rows"] if row["type"] == kind and wanted in row["series"])
    row = next(rows, None)
    if row is None:
        raise KeyError((kind, series, cage))
    geometry = tables["types"][kind][cage]
    return SkfConstants(
        rolling_1=row["rolling_1"],
        rolling_2=row.get("rolling_2", 0.0),
        sliding_1=row["sliding_1"],
        sliding_2=row["sliding_2"],
        bearing_factor=geometry["K_Z"],
        roller_length_factor=geometry["K_L"],
        ball_rows=row.get("ball_rows", 1) if kind == "deep-groove" else 0,
        is_read=row["grade"] == "read",
    )


def full_film_friction(kind: BearingType, oil_kind: str) -> float:
    """mu_EHL of SKF's model. [1]

    0.02 for cylindrical and 0.002 for tapered rollers; for balls 0.05 with mineral oil, 0.10 with
    transmission fluid (``"atf"``), 0.04 with other synthetic oils.
    """
    tables = _skf_tables()
    given = tables["types"][kind].get("full_film")
    if given is not None:
        return float(given)
    name = {"mineral": "mineral", "atf": "transmission"}.get(oil_kind, "synthetic")
    return float(tables["full_film"][name])


def _printed(
    bearing: CatalogueBearing, speed: float, viscosity: float
) -> tuple[float, float, float]:
    """Speed, mean diameter and viscosity in the units of the printed formulas: rpm, mm, mm^2/s."""
    return abs(speed) / RPM, bearing.pitch_diameter * 1e3, viscosity * 1e6


def skf_load_variables(
    constants: SkfConstants, bearing: CatalogueBearing, load: BearingLoad
) -> tuple[float, float]:
    """G_rr and G_sl of SKF's model, in its units of N and mm. Theory (J5), (J6), (J7).

    Raises `ValueError` for needle roller bearings, which SKF's table does not have.
    """
    pitch, radial, axial = bearing.pitch_diameter * 1e3, load.radial, load.axial
    R1, R2 = constants.rolling_1, constants.rolling_2
    S1, S2 = constants.sliding_1, constants.sliding_2
    if bearing.type == "deep-groove" and axial == 0:
        rolling = R1 * math.pow(pitch, 1.96) * math.pow(radial, 0.54)
        return rolling, S1 * math.pow(pitch, -0.26) * math.pow(radial, 5 / 3)
    if bearing.type == "deep-groove":
        angle = math.radians(24.6 * math.pow(axial / bearing.static_load_rating, 0.24))
        sine = math.sin(min(angle, math.pi / 2))
        rolling = R1 * math.pow(pitch, 1.96) * math.pow(radial + R2 * axial / sine, 0.54)
        group = math.pow(radial, 5) + S2 * math.pow(pitch, 1.5) * math.pow(axial, 4) / sine
        return rolling, S1 * math.pow(pitch, -0.145) * math.cbrt(group)
    if bearing.type == "cylindrical":
        rolling = R1 * math.pow(pitch, 2.41) * math.pow(radial, 0.31)
        return rolling, S1 * math.pow(pitch, 0.9) * axial + S2 * pitch * radial
    if bearing.type == "tapered":
        thrust = bearing.axial_factor * axial if axial > 0 else 0.0
        rolling = R1 * math.pow(pitch, 2.38) * math.pow(radial + R2 * thrust, 0.31)
        return rolling, S1 * math.pow(pitch, 0.82) * (radial + S2 * thrust)
    raise ValueError(f"SKF gives no constants for {bearing.type} bearings")


def skf_reduction_factors(
    bearing: CatalogueBearing,
    constants: SkfConstants,
    starvation: float,
    speed: float,
    viscosity: float,
) -> tuple[float, float]:
    """phi_ish for the heat of the inlet shear, and phi_rs for replenishment and starvation. [1]

    Theory (J8).
    """
    rpm, pitch, nu = _printed(bearing, speed, viscosity)
    heating = math.pow(rpm * pitch, 1.28) * math.pow(nu, 0.64)
    width = math.sqrt(constants.bearing_factor / (2e3 * (bearing.outside_diameter - bearing.bore)))
    dry = starvation * nu * rpm * 2 * pitch * width
    return 1 / (1 + 1.84e-9 * heating), math.exp(-dry)


def drag_variable(bearing: CatalogueBearing, oil_level: float) -> float:
    """Estimate of V_M at an oil level, from none to full immersion. Theory (J11). [1]

    SKF gives V_M in a diagram, which was not at hand: 0.0012 for a fully submerged ball bearing,
    and 0 without a bath; between, here, in proportion to the area under the oil. Rollers: the same.
    """
    t = _immersion_angle(bearing, oil_level)
    return LARGEST_DRAG_VARIABLE * (t - math.sin(t)) / (2 * math.pi)


def _immersion_angle(bearing: CatalogueBearing, oil_level: float) -> float:
    """t, between 0 and 2 pi. [rad]"""
    level = oil_level / bearing.pitch_diameter
    return 2 * math.acos(max(-1.0, min(1.0, (SUBMERGED / 2 - level) / (SUBMERGED / 2))))


def skf_drag_moment(
    model: SkfModel, bearing: CatalogueBearing, speed: float, viscosity: float
) -> float:
    """M_drag in an oil bath. Theory (J10). [N m]"""
    if model.oil_level <= 0 or speed == 0:
        return 0.0
    (rpm, pitch, nu), constants = _printed(bearing, speed, viscosity), model.constants
    width = bearing.width * 1e3
    V_M = model.drag_variable
    if V_M is None:
        V_M = drag_variable(bearing, model.oil_level)
    slenderness = 2 * bearing.pitch_diameter / (bearing.outside_diameter - bearing.bore)
    K_Z, K_L = constants.bearing_factor, constants.roller_length_factor
    if bearing.type == "deep-groove":
        K_ball = constants.ball_rows * K_Z * slenderness * 1e-12
        elements = 0.4 * V_M * K_ball * math.pow(pitch, 5) * rpm**2
    else:
        K_roll = K_L * K_Z * slenderness * 1e-12
        length = 5 * K_L * width / pitch
        C_w = 2.789e-10 * length**3 - 2.786e-4 * length**2 + 0.0195 * length + 0.6439
        elements = 4 * V_M * K_roll * C_w * width * math.pow(pitch, 4) * rpm**2
    t = _immersion_angle(bearing, model.oil_level)
    f_t = math.sin(t / 2) if t <= math.pi else 1.0
    R_s = 0.36 * pitch**2 * (t - math.sin(t)) * 0.05 * K_Z * slenderness
    group = rpm * pitch**2 * f_t / nu
    shear = 1.093e-7 * rpm**2 * math.pow(pitch, 3) * math.pow(group, -1.379) * R_s
    return 1e-3 * (elements + shear)


def skf_moments(
    model: SkfModel,
    bearing: CatalogueBearing,
    load: BearingLoad,
    speed: float,  # Speed of one ring against the other. [rad/s]
    viscosity: float,  # Kinematic, of the oil at its temperature in the bearing. [m^2/s]
) -> SkfMoments:
    """Friction moments of SKF's model of 2018. Theory (J8), (J9)."""
    rolling, sliding = skf_load_variables(model.constants, bearing, load)
    rpm, pitch, nu = _printed(bearing, speed, viscosity)
    hot, dry = model.reduction_factors(bearing, speed, viscosity)
    # phi_bl, the share of boundary lubrication in the sliding friction: (J9)
    boundary = math.exp(-2.6e-8 * math.pow(rpm * nu, 1.4) * pitch)
    mu_bl = STARTING_FRICTION if speed == 0 else BOUNDARY_FRICTION
    mu_sl = boundary * mu_bl + (1 - boundary) * model.full_film_friction
    return SkfMoments(
        rolling=1e-3 * hot * dry * rolling * math.pow(nu * rpm, 0.6),
        sliding=1e-3 * sliding * mu_sl,
        seal=model.seal_moment,
        drag=skf_drag_moment(model, bearing, speed, viscosity),
    )


# Rolling of tapered and cylindrical roller bearings, and rib friction, after Zhou and Hoeprich.
#
# R. S. Zhou and M. R. Hoeprich, J. Tribol. 113 (1991) 590, read; the load of the asperities at the
# rib after Aihara (1987), read; film and roughness there after Wingertszahn et al., Lubricants 11
# (2023) 369, read; starvation, drag and seals are SKF's.

ZHOU_HOEPRICH_SOURCE = "R. S. Zhou and M. R. Hoeprich, J. Tribol. 113 (1991) 590"
_STEEL = equivalent_modulus(206e9, 0.3, 206e9, 0.3)  # [Pa]
RIB_FRICTION = 0.2
"""Dry friction of roller ends on the rib, S. Aihara, J. Tribol. 109 (1987) 471. [1]"""
RIB_ROUGHNESS = 0.24e-6
"""Rms of rib and roller ends together, bearing 32216, Wingertszahn et al. (2023). [m]"""
END_RADIUS = 0.90
"""Radius of the roller ends over the distance of the rib from the apex: 0.85 to 0.95 are usual,
Machines 13 (2025) 910. [1]"""
RIB_HEIGHT = 0.03
"""Height of the contact on the rib over D - d: with it `RIB_FRICTION` gives the starting friction
of SKF's series 302 to 323 within 12 %. [1]"""
ROLLER_SHARES: Mapping[BearingType, tuple[float, float, float]] = {
    "tapered": (0.26, 0.87, 0.7),
    "cylindrical": (0.275, 0.83, 0.65),
}
"""Roller diameter over D - d, share of the pitch circle that rollers fill, roller length over B;
estimates, those of bearings by designation. [1]"""
POSITIONS = 72
"""Azimuths at which rolling is summed: few rollers lose more or less by where they stand."""

_MEASURED = "measured tapered bearings: Aihara (1987), Zhou and Hoeprich (1991), Wingertszahn"
_TAPERED_RANGES = (
    Range("bore", "bore", 17.0, 120.0, MILLIMETRE, _MEASURED),
    Range("viscosity", "viscosity in the bearing", 4.5, 80.0, MILLIPASCAL_SECOND, _MEASURED),
    Range("rib_film", "film ratio at the rib", 0.4, None, NUMBER, _MEASURED),
)
_TAPERED_SPEED = replace(SPEED_PARAMETER, high=4.4e5, source=_MEASURED)
TAPERED_ERRORS = {"zhou-hoeprich": 0.14, "palmgren": 0.85, "harris": 0.85, "skf-2018": 1.80}
"""Largest mean error of a model on a set of tapered bearings of `validate --measured`. [1]"""


@dataclass(frozen=True, slots=True)
class TaperedMoments:
    """Friction moments of a tapered roller bearing, and the least film ratio at its rib."""

    rolling: float  # [N m]
    rib: float  # [N m]
    film_ratio: float  # [1]


@dataclass(frozen=True, slots=True)
class TaperedModel(_WithoutCoefficient):
    """Rolling and rib friction after Zhou and Hoeprich."""

    rollers: int
    roller_diameter: float  # D_w, mean. [m]
    roller_length: float  # l. [m]
    rib_height: float  # e, of the contact with the rib above the raceway. [m]
    rib_roughness: float  # sigma. [m]
    skf: SkfModel  # What starvation, drag, seals and full film friction are taken from.

    name: ClassVar = "zhou-hoeprich"
    terms: ClassVar = ("mechanical", "drag")
    depends_on_load: ClassVar = True

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``mechanical``, rolling and rib, and ``drag``, with that of the seals. [W]"""
        moments = tapered_moments(self, bearing, load, speed, oil)
        drag = skf_drag_moment(self.skf, bearing, speed, oil.kinematic_viscosity)
        by_load, others = moments.rolling + moments.rib, drag + self.skf.seal_moment
        method = "rolling and rib friction after Zhou and Hoeprich"
        skf = "drag in the oil and seals, SKF 2018"
        return (
            FrictionPart("mechanical", True, by_load * abs(speed), method, ZHOU_HOEPRICH_SOURCE),
            FrictionPart("drag", False, others * abs(speed), skf, self.skf.source),
        )

    def flags(
        self, where: str, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[ValidityFlag, ...]:
        """Flags on static load, and on what no measured bearing had."""
        use = ModelUse("bearing", self.name, where)
        film = tapered_moments(self, bearing, load, speed, oil).film_ratio
        values = {"bore": bearing.bore, "viscosity": oil.dynamic_viscosity, "rib_film": film}
        measured = check_ranges(use, _TAPERED_RANGES, values) if speed else ()
        return measured + load_flags(use, AXIAL_RATIO, bearing, load, speed, _TAPERED_SPEED)


@dataclass(frozen=True, slots=True)
class CylindricalModel(_SlidesAsSkf):
    """Rolling of cylindrical rollers after Zhou and Hoeprich, their sliding after SKF."""

    rollers: int
    roller_diameter: float  # D_w. [m]
    roller_length: float  # l. [m]
    viscous_factor: float  # f0 of the idle bearing. [1]
    skf: SkfModel  # What sliding, starvation, drag and seals are taken from.

    name: ClassVar = "zhou-hoeprich"
    terms: ClassVar = ("mechanical", "viscous")
    depends_on_load: ClassVar = True

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``viscous``, of the idle bearing, and ``mechanical``, what the load adds. [W]

        Theory (J36).
        """
        moments = skf_moments(self.skf, bearing, load, speed, oil.kinematic_viscosity)
        rolling = cylindrical_rolling(self, bearing, load.radial, speed, oil)
        idle = bearing_viscous_loss(
            self.viscous_factor, oil.kinematic_viscosity, speed, bearing.pitch_diameter
        )
        idle = max(idle, moments.drag * abs(speed))
        loaded = (rolling + moments.sliding + moments.drag) * abs(speed)
        method = "rolling after Zhou and Hoeprich, sliding after SKF 2018"
        return (
            FrictionPart("mechanical", True, max(0.0, loaded - idle), method, ZHOU_HOEPRICH_SOURCE),
            FrictionPart(
                "viscous", False, idle + moments.seal * abs(speed), VISCOUS_METHOD, VISCOUS_SOURCE
            ),
        )


BearingModel = PalmgrenModel | SkfModel | TaperedModel | CylindricalModel | TableModel
"""How the friction of a bearing is computed."""


def skf_supply(kind: BearingType, cage: Cage = "caged") -> SkfConstants:
    """What SKF's starvation and drag take of a bearing whose series is not known."""
    geometry = _skf_tables()["types"][kind][cage]
    return SkfConstants(0.0, 0.0, 0.0, 0.0, geometry["K_Z"], geometry["K_L"], 0, is_read=False)


@lru_cache(maxsize=256)
def roller_loads(slope: float, rollers: int) -> tuple[float, ...]:
    """Load of each roller over their mean, for F_r tan(alpha)/F_a. Theory (J22). [1]

    Examples
    --------
    >>> roller_loads(0.0, 3)
    (1.0, 1.0, 1.0)
    """
    cosines = [math.cos(2 * math.pi * roller / rollers) for roller in range(rollers)]
    low, high = 0.0, 1.0  # 1/(2 epsilon): 0 if all rollers carry the same, 1 if half of them carry
    while True:
        middle = (low + high) / 2 if slope else 0.0
        loads = [max(0.0, 1 - middle * (1 - cosine)) ** (10 / 9) for cosine in cosines]
        total = sum(loads)
        if not slope or high - low < 1e-12:
            return tuple(rollers * load / total for load in loads)
        found = sum(load * cosine for load, cosine in zip(loads, cosines, strict=True)) / total
        low, high = (middle, high) if found < slope else (low, middle)


def rolling_force(speed_number: float, material_number: float, load_number: float) -> float:
    """F alpha/(l R) on each surface of an isothermal contact: 29.2 (G U)^0.648 W^0.246.

    Theory (J23). Zhou and Hoeprich (1991), Eq. 17, a fit to numerical solutions. [1]
    """
    return 29.2 * math.pow(material_number * speed_number, 0.648) * math.pow(load_number, 0.246)


def raceways(
    model: TaperedModel | CylindricalModel, bearing: CatalogueBearing, axis: float
) -> tuple[float, float]:
    """Radii of both raceways at rollers whose axis has the angle `axis`. Theory (J21). [m]"""
    offset = model.roller_diameter / bearing.pitch_diameter * math.cos(axis)
    inner, outer = ((1 + side * offset) * bearing.pitch_diameter / 2 for side in (-1, 1))
    return inner, outer


def rolling_moment(
    model: TaperedModel | CylindricalModel,
    bearing: CatalogueBearing,
    axis: float,
    loads: Sequence[float],  # Of rollers evenly around the bearing, 0 of those that carry none. [N]
    speed: float,
    oil: OilState,
) -> float:
    """Moment by which rollers that carry such loads roll in the oil. Theory (J23), (J26). [N m]"""
    inner, outer = raceways(model, bearing, axis)
    reach = 2 * inner * outer / (inner + outer)
    u = abs(speed) * reach / 2
    thermal = oil.thermal_load(u)
    G = oil.pressure_viscosity * _STEEL
    rolling = 0.0
    for own in filter(None, loads):
        w = own / model.roller_length
        for radius in (inner, outer):
            R = model.roller_diameter * radius / bearing.pitch_diameter
            U, W = oil.dynamic_viscosity * u / (_STEEL * R), w / (_STEEL * R)
            heat = inlet_film_factor(thermal, hertz_pressure(w, R, _STEEL) / _STEEL, 0.0)
            force = rolling_force(U, G, W) * heat * R / oil.pressure_viscosity
            rolling += force * model.roller_length * reach
    _, starved = model.skf.reduction_factors(bearing, speed, oil.kinematic_viscosity)
    return rolling * starved * model.rollers / len(loads)


def cylindrical_rolling(
    model: CylindricalModel,
    bearing: CatalogueBearing,
    radial: float,
    speed: float,  # Speed of one ring against the other. [rad/s]
    oil: OilState,
) -> float:
    """Rolling moment of rollers, half of which carry, over all positions. Theory (J36). [N m]"""
    shares = roller_loads(math.inf, POSITIONS)
    held = sum(
        share * math.cos(2 * math.pi * place / POSITIONS) for place, share in enumerate(shares)
    )
    mean = radial * POSITIONS / (held * model.rollers)
    return rolling_moment(model, bearing, 0.0, [mean * share for share in shares], speed, oil)


def tapered_moments(
    model: TaperedModel,
    bearing: CatalogueBearing,
    load: BearingLoad,
    speed: float,  # Speed of one ring against the other. [rad/s]
    oil: OilState,  # In the bearing.
) -> TaperedMoments:
    """Friction moments of a tapered roller bearing. Theory (J21), (J24), (J26)."""
    thrust = max(load.axial, load.radial * bearing.thrust_ratio)
    if thrust == 0:
        return TaperedMoments(0.0, 0.0, math.inf)
    alpha = bearing.contact_angle
    size = model.roller_diameter / bearing.pitch_diameter
    half = math.atan(size * math.sin(alpha) / (1 + size * math.cos(alpha)))
    axis = alpha - half
    inner, outer = raceways(model, bearing, axis)
    u = abs(speed) * inner * outer / (inner + outer)
    G = oil.pressure_viscosity * _STEEL
    apex = bearing.pitch_diameter / (2 * math.sin(axis)) + model.roller_length / 2
    across = END_RADIUS * apex
    along = across / (1 - END_RADIUS)
    k = 1.0339 * math.pow(across / along, 0.636)
    slip = model.rib_height / (model.roller_diameter * inner / bearing.pitch_diameter)
    shape = 2.69 * along * (1 - 0.61 * math.exp(-0.73 * k))
    shape *= inlet_film_factor(oil.thermal_load(u), 0.0, slip)
    shape *= math.pow(oil.dynamic_viscosity * u / (_STEEL * along), 0.67) * math.pow(G, 0.53)
    rib = 0.0
    least = math.inf
    mean = thrust / (math.sin(alpha) * model.rollers)
    slope = load.radial * math.tan(alpha) / thrust
    loads = [mean * share for share in roller_loads(slope, model.rollers)]
    for own in filter(None, loads):
        pressed = own * math.sin(2 * half)
        film = shape * math.pow(pressed / (_STEEL * along**2), -0.067) / model.rib_roughness
        least = min(least, film)
        dry = asperity_share(film)
        friction = dry * RIB_FRICTION + (1 - dry) * model.skf.full_film_friction
        rib += friction * pressed * model.rib_height * outer / model.roller_diameter
    return TaperedMoments(rolling_moment(model, bearing, axis, loads, speed, oil), rib, least)
