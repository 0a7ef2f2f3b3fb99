"""Friction of catalogue bearings on shafts after Palmgren, Harris, or a table of the user.

SKF's model is in `epicyclic.losses.skf_bearing`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Literal

from epicyclic.losses.loss_table import LossTable
from epicyclic.losses.validity import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.losses.viscous import (
    RPM,
    SPEED_PARAMETER,
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    bearing_viscous_loss,
    speed_parameter,
)
from epicyclic.lubricant.properties import OilState
from epicyclic.units import NUMBER

BearingType = Literal["deep-groove", "cylindrical", "tapered", "needle"]
Cage = Literal["caged", "full-complement"]

BEARING_TYPES: tuple[BearingType, ...] = ("deep-groove", "cylindrical", "tapered", "needle")
DEFAULT_VISCOUS_FACTORS: Mapping[tuple[BearingType, Cage], float] = {
    ("deep-groove", "caged"): 2.0,
    ("cylindrical", "caged"): 3.0,
    ("cylindrical", "full-complement"): 7.5,
    ("tapered", "caged"): 6.0,
    ("needle", "caged"): 12.0,
    ("needle", "full-complement"): 12.0,
}
"""f0 in an oil bath, Harris (1991); general knowledge. The keys are the bearings there are. [1]"""
DEFAULT_COEFFICIENTS: Mapping[tuple[BearingType, Cage], float] = {
    ("deep-groove", "caged"): 0.0003,
    ("cylindrical", "caged"): 0.0003,
    ("cylindrical", "full-complement"): 0.00055,
    ("tapered", "caged"): 0.0004,
    ("needle", "caged"): 0.0005,
    ("needle", "full-complement"): 0.00055,
}
"""f1, Harris (1991); second hand. Deep groove: at a seventh of the static rating. Caged needle
rollers: an estimate, printed values run up to 0.002. [1]"""
DEFAULT_FLANGE_COEFFICIENTS: Mapping[Cage, float] = {"caged": 0.002, "full-complement": 0.003}
"""f_f of cylindrical roller bearings with oil, Harris (1991); general knowledge. [1]"""
DEFAULT_MINIMUM_LOAD_FACTORS: Mapping[BearingType, float] = {
    "deep-groove": 0.025,
    "cylindrical": 0.15,
}
"""k_r in the middle of SKF's product tables; general knowledge. [1]"""
MINIMUM_LOAD_SHARE = 0.02
"""Least load of tapered and needle roller bearings over their dynamic load rating (SKF). [1]"""
PALMGREN_METHOD = "load-dependent moment after Palmgren"
HARRIS_METHOD = "load-dependent moment after Harris"
HARRIS_SOURCE = "T. A. Harris, Rolling Bearing Analysis, 3rd ed. (1991), second hand"

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
    bore: float  # d, D and B. [m]
    outside_diameter: float  # d, D and B. [m]
    width: float = math.nan  # d, D and B. [m]
    cage: Cage = "caged"  # ``"caged"`` or ``"full-complement"``.
    dynamic_load_rating: float = math.nan  # C and C0; NaN where they are unknown. [N]
    static_load_rating: float = math.nan  # C and C0; NaN where they are unknown. [N]
    # Y of a tapered roller bearing, 0.4 cot of its contact angle; NaN for other types. [1]
    axial_factor: float = math.nan

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
    """The bearing types of a model: ``"palmgren"``, ``"harris"``, ``"skf-2018"`` or ``"table"``.

    Neither Harris's table nor SKF's has needle roller bearings.
    """
    return BEARING_TYPES if model in ("palmgren", "table") else BEARING_TYPES[:3]


# --- Palmgren and Harris --------------------------------------------------------------------------


def friction_load(bearing: CatalogueBearing, load: BearingLoad) -> float:
    """Load P1 that sets the load-dependent friction of a bearing. [N]

    Theory (J1).

    Deep groove: the larger of F_r and 3 F_a - 0.1 F_r; tapered: of F_r and 2 Y F_a; cylindrical and
    needle: F_r. Harris (1991), second hand.
    """
    if bearing.type == "deep-groove":
        return max(load.radial, 3 * load.axial - 0.1 * load.radial)
    if bearing.type == "tapered" and load.axial > 0:
        return max(load.radial, 2 * bearing.axial_factor * load.axial)
    return load.radial


def static_load(bearing: CatalogueBearing, load: BearingLoad) -> float:
    """Equivalent static load P0 of ISO 76. [N]

    Theory (J2).

    Deep groove: the larger of F_r and 0.6 F_r + 0.5 F_a; tapered: of F_r and 0.5 F_r + 0.55 Y F_a;
    cylindrical and needle: F_r.
    """
    if bearing.type == "deep-groove":
        return max(load.radial, 0.6 * load.radial + 0.5 * load.axial)
    if bearing.type == "tapered" and load.axial > 0:
        return max(load.radial, 0.5 * load.radial + 0.55 * bearing.axial_factor * load.axial)
    return load.radial


def harris_coefficient(bearing: CatalogueBearing, load: BearingLoad) -> float:
    """Coefficient f1 after Harris. [1]

    Theory (J3).

    Deep groove: 0.0009 (P0/C0)^0.55; rollers: constant, 0.0003 caged cylindrical, 0.00055 full
    complement, 0.0004 tapered. Harris (1991), second hand.

    Raises
    ------
    ValueError
        For needle roller bearings, which Harris's table does not have.
    """
    if bearing.type not in bearing_types("harris"):
        raise ValueError(f"Harris gives no coefficient for {bearing.type} bearings")
    if bearing.type != "deep-groove":
        return DEFAULT_COEFFICIENTS[bearing.type, bearing.cage]
    ratio = static_load(bearing, load) / bearing.static_load_rating
    return 0.0009 * math.pow(ratio, 0.55)


def load_moment(
    bearing: CatalogueBearing, load: BearingLoad, coefficient: float, flange_coefficient: float
) -> float:
    """Load-dependent friction moment f1 P1 d_m, with flange friction f_f F_a d_m. [N m]

    Theory (J4).

    Palmgren; Harris (1991), second hand. Only the flanges of cylindrical roller bearings count.
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

    @property
    def name(self) -> str:
        """As a case has it."""
        return "harris" if self.constant is None else "palmgren"

    @property
    def depends_on_load(self) -> bool:
        """True."""
        return True

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
        self,
        where: str,
        bearing: CatalogueBearing,
        load: BearingLoad,
        speed: float,
        oil: OilState,
    ) -> tuple[ValidityFlag, ...]:
        """Flags on speed, static load and, of cylindrical rollers, axial force."""
        return load_flags(ModelUse("bearing", self.name, where), AXIAL_RATIO, bearing, load, speed)


# --- table of the user ----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class TableModel:
    """Friction of a bearing from a table over speed, temperature or radial force."""

    table: LossTable

    name: ClassVar = "table"
    terms: ClassVar = ("friction",)

    @property
    def depends_on_load(self) -> bool:
        """True if the table has the radial force as an axis."""
        return "radial_force" in self.table.names

    def coefficient(self, bearing: CatalogueBearing, load: BearingLoad) -> float:
        """NaN: a table has no f1."""
        return math.nan

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``friction``, all of it. [W]"""
        watts = self.table.loss(speed=speed, temperature=oil.temperature, radial_force=load.radial)
        return (
            FrictionPart("friction", self.depends_on_load, watts, "loss table", self.table.source),
        )

    def flags(
        self,
        where: str,
        bearing: CatalogueBearing,
        load: BearingLoad,
        speed: float,
        oil: OilState,
    ) -> tuple[ValidityFlag, ...]:
        """Flags on values beyond the table."""
        use = ModelUse("bearing", "table", where)
        return self.table.flags(
            use, speed=speed, temperature=oil.temperature, radial_force=load.radial
        )


# --- load and range -------------------------------------------------------------------------------


def minimum_load(
    bearing: CatalogueBearing,  # Tapered and needle rollers need its dynamic load rating.
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
    k_r = DEFAULT_MINIMUM_LOAD_FACTORS[bearing.type] if factor is None else factor
    size = 1e3 * k_r * (10 * bearing.pitch_diameter) ** 2
    if bearing.type == "deep-groove":
        return size * math.pow(1e3 * viscosity * abs(speed) / RPM, 2 / 3)
    return size * (6 + (4 * abs(speed) / reference_speed if reference_speed else 0.0))


def load_flags(
    use: ModelUse, axial: Range, bearing: CatalogueBearing, load: BearingLoad, speed: float
) -> tuple[ValidityFlag, ...]:
    """Flags on speed, static load and, of cylindrical rollers, the ratio `axial` of the forces."""
    if speed == 0:
        return ()
    ranges = [SPEED_PARAMETER]
    values = {"speed_parameter": speed_parameter(speed, bearing.pitch_diameter)}
    if not math.isnan(bearing.static_load_rating):
        ranges.append(_STATIC_RATIO)
        values["static_ratio"] = static_load(bearing, load) / bearing.static_load_rating
    if bearing.type == "cylindrical" and load.axial > 0:
        ranges.append(axial)
        values["axial_ratio"] = load.axial / load.radial if load.radial > 0 else math.inf
    return check_ranges(use, ranges, values)
