"""SKF's friction model of 2018 for deep groove, cylindrical and tapered roller bearings.

Forces, lengths and speeds are SI. The printed formulas take N, mm, mm^2/s, rpm and give N mm; the
conversion is done once, in `_printed`. The constants of the series are in the library,
``bearings/skf-2018.toml``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import ClassVar

from epicyclic.dataclass import dataclass, replace
from epicyclic.library import bearing_tables
from epicyclic.losses.drag import RPM
from epicyclic.losses.ranges import BearingType, Cage, ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.losses.shaft_bearing import (
    AXIAL_RATIO,
    BearingLoad,
    CatalogueBearing,
    FrictionPart,
    WithoutCoefficient,
    load_flags,
)
from epicyclic.oil.oil import OilState
from epicyclic.units import NUMBER

STARVATION: Mapping[str, float] = {"jet": 3e-8, "oil-bath": 3e-8, "grease": 6e-8, "oil-air": 6e-8}
"""K_rs by lubrication: oil jet, low oil bath, grease, oil and air (SKF 2018). [1]"""
LARGEST_DRAG_VARIABLE = 0.0012  # V_M of a ball bearing that is fully submerged (SKF 2018). [1]
SUBMERGED = 1.2
"""Oil level over pitch diameter at which a bearing is fully submerged (SKF 2018). [1]"""
BOUNDARY_FRICTION = 0.12
STARTING_FRICTION = 0.15  # mu_bl in motion and at the start (SKF 2018). [1]
VISCOSITY_POWER = 0.6  # With which viscosity and speed are in M_rr (SKF 2018). [1]
LEAST_SUPPLY = math.exp(-VISCOSITY_POWER)
"""phi_rs at which M_rr is largest; with less it falls in thicker oil. [1]"""

SKF_SOURCE = "SKF, Rolling bearings, catalogue (2018)"
SKF_AXIAL_RATIO = replace(
    AXIAL_RATIO, high=0.5, source="axial load of cylindrical roller bearings, SKF"
)

_SUPPLY = Range(
    "supply", "starvation factor of rolling", LEAST_SUPPLY, None, NUMBER,
    "below, it falls with viscosity",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class SkfConstants:
    """Constants of one series in SKF's model."""

    rolling_1: float  # R1 of G_rr.
    rolling_2: float  # R2 of G_rr.
    sliding_1: float  # S1 of G_sl.
    sliding_2: float  # S2 of G_sl.
    bearing_factor: float  # K_Z. [1]
    roller_length_factor: float  # K_L. [1]
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


@dataclass(frozen=True, slots=True)
class SkfModel(WithoutCoefficient):
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
    axial_range: ClassVar = SKF_AXIAL_RATIO

    def reduction_factors(
        self, bearing: CatalogueBearing, speed: float, viscosity: float
    ) -> tuple[float, float]:
        """phi_ish for the heat of the inlet shear, and phi_rs for replenishment and starvation. [1]

        Theory (J8). A bearing under oil does not starve.
        """
        rpm, pitch, nu = _printed(bearing, speed, viscosity)
        heating = math.pow(rpm * pitch, 1.28) * math.pow(nu, 0.64)
        hot = 1 / (1 + 1.84e-9 * heating)
        if self.oil_level >= SUBMERGED * bearing.pitch_diameter:
            return hot, 1.0
        section = 2e3 * (bearing.outside_diameter - bearing.bore)
        width = math.sqrt(self.constants.bearing_factor / section)
        return hot, math.exp(-self.starvation * nu * rpm * 2 * pitch * width)

    def supply(self, bearing: CatalogueBearing, speed: float, viscosity: float) -> float:
        """phi_rs as films have it: no less than where SKF's rolling is largest. Theory (J44). [1]

        A departure: neither films nor idle bearings, which lose more the thicker the oil is, give a
        reason for rolling that vanishes in thick oil.
        """
        _, starved = self.reduction_factors(bearing, speed, viscosity)
        return max(starved, LEAST_SUPPLY)

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
        moment, method = moments.rolling + moments.sliding, "rolling and sliding, SKF 2018"
        return film_parts(self, bearing, speed, oil, moment, method, self.source)

    def flags(
        self, where: str, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[ValidityFlag, ...]:
        """Flags on speed, forces, and oil so thick that rolling would fall with it."""
        use = ModelUse("bearing", self.name, where)
        _, starved = self.reduction_factors(bearing, speed, oil.kinematic_viscosity)
        flooded, *_ = replace(self, starvation=0.0).parts(bearing, load, speed, oil)
        found = check_ranges(use, (_SUPPLY,), {"supply": starved}, could_be=flooded.watts)
        return found + load_flags(use, self.axial_range, bearing, load, speed)


def film_parts(
    skf: SkfModel,
    bearing: CatalogueBearing,
    speed: float,
    oil: OilState,
    moment: float,  # By load. [N m]
    method: str,
    source: str,
) -> tuple[FrictionPart, ...]:
    """``mechanical``, of a moment, and ``drag``, with that of the seals, after SKF. [W]"""
    others = skf_drag_moment(skf, bearing, speed, oil.kinematic_viscosity) + skf.seal_moment
    dragged = "drag in the oil and seals, SKF 2018"
    return (
        FrictionPart("mechanical", True, moment * abs(speed), method, source),
        FrictionPart("drag", False, others * abs(speed), dragged, skf.source),
    )


def skf_series(kind: BearingType) -> tuple[str, ...]:
    """The series of a bearing type with a cage in SKF's table; empty for needle rollers."""
    return tuple(
        name
        for row in bearing_tables("skf-2018")["rows"]
        if row["type"] == kind
        for name in row["series"]
        if name != "full-complement"
    )


def skf_constants(kind: BearingType, series: str, cage: Cage = "caged") -> SkfConstants:
    """The constants of a series; those of full complement bearings are the same for all series.

    Raises `KeyError` if SKF's table has no such bearing.
    """
    wanted = series if cage == "caged" else cage
    tables = bearing_tables("skf-2018")
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


def skf_supply(kind: BearingType, cage: Cage = "caged") -> SkfConstants:
    """What SKF's starvation and drag take of a bearing whose series is not known."""
    geometry = bearing_tables("skf-2018")["types"][kind][cage]
    rows = int(not geometry["K_L"])  # of balls
    return SkfConstants(0.0, 0.0, 0.0, 0.0, geometry["K_Z"], geometry["K_L"], rows, is_read=False)


def full_film_friction(kind: BearingType, oil_kind: str) -> float:
    """mu_EHL of SKF's model. [1]

    0.02 for cylindrical and 0.002 for tapered rollers; for balls 0.05 with mineral oil, 0.10 with
    transmission fluid (``"atf"``), 0.04 with other synthetic oils.
    """
    tables = bearing_tables("skf-2018")
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
    if constants.ball_rows:
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
        rolling=1e-3 * hot * dry * rolling * math.pow(nu * rpm, VISCOSITY_POWER),
        sliding=1e-3 * sliding * mu_sl,
        seal=model.seal_moment,
        drag=skf_drag_moment(model, bearing, speed, viscosity),
    )
