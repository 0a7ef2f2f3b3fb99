"""Rolling of roller bearings, and rib friction, after Zhou and Hoeprich.

R. S. Zhou and M. R. Hoeprich, J. Tribol. 113 (1991) 590, read; the load of the asperities at the
rib after Aihara (1987), read; film and roughness there after Wingertszahn et al., Lubricants 11
(2023) 369, read; starvation, drag and seals are SKF's.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.contact.line_contact import Flanks, LineContacts
from epicyclic.dataclass import dataclass, replace
from epicyclic.kernels.line_contact import (
    Real,
    asperity_share,
    equivalent_modulus,
    hertz_pressure,
    inlet_film_factor,
)
from epicyclic.losses.designations import ELEMENTS
from epicyclic.losses.drag import (
    SPEED_PARAMETER,
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    bearing_viscous_loss,
)
from epicyclic.losses.mixed_lubrication import Surfaces, mixed_friction
from epicyclic.losses.ranges import BearingType, ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.losses.shaft_bearing import (
    AXIAL_RATIO,
    BearingLoad,
    CatalogueBearing,
    FrictionPart,
    WithoutCoefficient,
    load_flags,
)
from epicyclic.losses.skf_2018 import SKF_AXIAL_RATIO, SkfModel, film_parts, skf_moments
from epicyclic.oil.oil import OilState
from epicyclic.units import MILLIMETRE, MILLIPASCAL_SECOND, NUMBER

ZHOU_HOEPRICH_SOURCE = "R. S. Zhou and M. R. Hoeprich, J. Tribol. 113 (1991) 590"
STEEL = equivalent_modulus(206e9, 0.3, 206e9, 0.3)  # [Pa]
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
    "tapered": ELEMENTS["tapered"],
    "cylindrical": ELEMENTS["cylindrical"],
    "thrust-roller": (0.29, 0.66, 0.29),
}
"""As `ELEMENTS`, the length of thrust rollers over D - d: these have with ISO 76 the static rating
of an 81107. [1]"""
THRUST_ROUGHNESS = (0.15e-6, 0.1e-6)
"""Rms of race and roller, estimates, those of planets by designation. [m]"""
AS_MADE = Surfaces(running_in=1.0)
"""Bearings are so fine that they hardly run in."""
POSITIONS = 72
"""Azimuths at which rolling is summed: few rollers lose more or less by where they stand."""
FINE = 720
"""Azimuths in tapered bearings, of which not always half carry: the first load of a roller makes it
lose much."""

_MEASURED = "measured tapered bearings: Aihara (1987), Zhou and Hoeprich (1991), Wingertszahn"
_VISCOSITY = Range(
    "viscosity", "viscosity in the bearing", 4.5, 80.0, MILLIPASCAL_SECOND, _MEASURED
)
_TAPERED_RANGES = (
    Range("bore", "bore", 17.0, 120.0, MILLIMETRE, _MEASURED),
    _VISCOSITY,
    Range("rib_film", "film ratio at the rib", 0.4, None, NUMBER, _MEASURED),
)
_TAPERED_SPEED = replace(SPEED_PARAMETER, high=4.4e5, source=_MEASURED)


@dataclass(frozen=True, slots=True)
class TaperedMoments:
    """Friction moments of a tapered roller bearing, and the least film ratio at its rib."""

    rolling: float  # [N m]
    rib: float  # [N m]
    film_ratio: float  # [1]


@dataclass(frozen=True, slots=True)
class Rollers(WithoutCoefficient):
    """What models after Zhou and Hoeprich have in common."""

    rollers: int
    roller_diameter: float  # D_w, mean. [m]
    roller_length: float  # l. [m]

    name: ClassVar = "zhou-hoeprich"
    depends_on_load: ClassVar = True


@dataclass(frozen=True, slots=True)
class TaperedModel(Rollers):
    """Rolling and rib friction after Zhou and Hoeprich."""

    rib_height: float  # e, of the contact with the rib above the raceway. [m]
    rib_roughness: float  # sigma. [m]
    skf: SkfModel  # What starvation, drag, seals and full film friction are taken from.

    terms: ClassVar = ("mechanical", "drag")

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``mechanical``, rolling and rib, and ``drag``, with that of the seals. [W]"""
        moments = tapered_moments(self, bearing, load, speed, oil)
        moment = moments.rolling + moments.rib
        method = "rolling and rib friction after Zhou and Hoeprich"
        return film_parts(self.skf, bearing, speed, oil, moment, method, ZHOU_HOEPRICH_SOURCE)

    def flags(
        self, where: str, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[ValidityFlag, ...]:
        """Flags on static load, and on what no measured bearing had."""
        use = ModelUse("bearing", self.name, where)
        # nobody measured how far thicker oil starves
        full = replace(self, skf=replace(self.skf, starvation=0.0))
        moments = tapered_moments(full, bearing, load, speed, oil)
        film, viscosity = moments.film_ratio, oil.dynamic_viscosity
        values = {"bore": bearing.bore, "viscosity": viscosity, "rib_film": film}
        thick = abs(speed) * (viscosity > _VISCOSITY.bounds[1])
        most = thick * (moments.rolling + moments.rib)
        measured = check_ranges(use, _TAPERED_RANGES, values, could_be=most) if speed else ()
        return measured + load_flags(use, AXIAL_RATIO, bearing, load, speed, _TAPERED_SPEED)


@dataclass(frozen=True, slots=True)
class CylindricalModel(Rollers):
    """Rolling of cylindrical rollers after Zhou and Hoeprich, their sliding after SKF."""

    viscous_factor: float  # f0 of the idle bearing. [1]
    skf: SkfModel  # What sliding, starvation, drag and seals are taken from.

    terms: ClassVar = ("mechanical", "viscous")
    axial_range: ClassVar = SKF_AXIAL_RATIO

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``viscous`` of the idle bearing, and ``mechanical``, what load adds. Theory (J36). [W]"""
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


@dataclass(frozen=True, slots=True)
class ThrustRollerModel(Rollers):
    """Rolling of straight rollers after Zhou and Hoeprich, sliding by mixed friction."""

    skf: SkfModel  # What starvation, drag and seals are taken from.

    terms: ClassVar = ("mechanical", "drag")
    thickest: ClassVar = ("mechanical", _VISCOSITY)

    def parts(
        self, bearing: CatalogueBearing, load: BearingLoad, speed: float, oil: OilState
    ) -> tuple[FrictionPart, ...]:
        """``mechanical``, rolling and sliding, and ``drag``, with that of the seals. [W]"""
        moment = 0.0
        if load.axial and speed:
            moment = thrust_sliding(self, bearing, load.axial, speed, oil)
            own = np.array([load.axial / self.rollers])
            moment += rolling_moment(self, bearing, math.pi / 2, own, speed, oil)
        method = "rolling after Zhou and Hoeprich, sliding by mixed friction"
        return film_parts(self.skf, bearing, speed, oil, moment, method, ZHOU_HOEPRICH_SOURCE)


RollerModel = TaperedModel | CylindricalModel | ThrustRollerModel


@lru_cache(maxsize=256)
def roller_loads(slope: float, rollers: int, exponent: float = 10 / 9) -> FloatArray:
    """Load of each roller over their mean, for F_r tan(alpha)/F_a. Theory (J22). [1]

    `exponent` of the load over the approach, 3/2 for balls.

    Examples
    --------
    >>> roller_loads(0.0, 3)
    array([1., 1., 1.])
    """
    cosines = np.cos(2 * math.pi * np.arange(rollers) / rollers)
    low, high = 0.0, 1.0  # 1/(2 epsilon): 0 if all rollers carry the same, 1 if half of them carry
    while True:
        middle = (low + high) / 2 if slope else 0.0
        loads = np.maximum(0, 1 - middle * (1 - cosines)) ** exponent
        if not slope or high - low < 1e-12:
            shares: FloatArray = loads / loads.mean()
            shares.flags.writeable = False  # kept
            return shares
        low, high = (middle, high) if loads @ cosines < slope * loads.sum() else (low, middle)


def rolling_force(speed_number: float, material_number: float, load_number: Real) -> Real:
    """F alpha/(l R) on each surface of an isothermal contact: 29.2 (G U)^0.648 W^0.246.

    Theory (J23). Zhou and Hoeprich (1991), Eq. 17, a fit to numerical solutions. [1]
    """
    force: Real = 29.2 * math.pow(material_number * speed_number, 0.648) * load_number**0.246
    return force


def raceways(model: RollerModel, bearing: CatalogueBearing, axis: float) -> tuple[float, float]:
    """Radii of both raceways at rollers whose axis has the angle `axis`. Theory (J21). [m]"""
    offset = model.roller_diameter / bearing.pitch_diameter * math.cos(axis)
    inner, outer = ((1 + side * offset) * bearing.pitch_diameter / 2 for side in (-1, 1))
    return inner, outer


def rolling_moment(
    model: RollerModel,
    bearing: CatalogueBearing,
    axis: float,
    loads: FloatArray,  # Of rollers evenly around the bearing, 0 of those that carry none. [N]
    speed: float,
    oil: OilState,
) -> float:
    """Moment by which rollers that carry such loads roll in the oil. Theory (J23), (J26). [N m]"""
    inner, outer = raceways(model, bearing, axis)
    reach = 2 * inner * outer / (inner + outer)
    u = abs(speed) * reach / 2
    thermal = oil.thermal_load(u)
    G = oil.pressure_viscosity * STEEL
    rolling = 0.0
    w: Any = loads[loads > 0] / model.roller_length
    for radius in (inner, outer):
        R = model.roller_diameter * radius / bearing.pitch_diameter
        U, W = oil.dynamic_viscosity * u / (STEEL * R), w / (STEEL * R)
        heat = inlet_film_factor(thermal, hertz_pressure(w, R, STEEL) / STEEL, 0.0)
        force = rolling_force(U, G, W) * heat * R / oil.pressure_viscosity
        rolling += float(force.sum()) * model.roller_length * reach
    starved = model.skf.supply(bearing, speed, oil.kinematic_viscosity)
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
    held = float(shares @ np.cos(2 * math.pi * np.arange(POSITIONS) / POSITIONS))
    mean = radial * POSITIONS / (held * model.rollers)
    return rolling_moment(model, bearing, 0.0, mean * shares, speed, oil)


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
    G = oil.pressure_viscosity * STEEL
    apex = bearing.pitch_diameter / (2 * math.sin(axis)) + model.roller_length / 2
    across = END_RADIUS * apex
    along = across / (1 - END_RADIUS)
    k = 1.0339 * math.pow(across / along, 0.636)
    slip = model.rib_height / (model.roller_diameter * inner / bearing.pitch_diameter)
    shape = 2.69 * along * (1 - 0.61 * math.exp(-0.73 * k))
    shape *= inlet_film_factor(oil.thermal_load(u), 0.0, slip)
    shape *= math.pow(oil.dynamic_viscosity * u / (STEEL * along), 0.67) * math.pow(G, 0.53)
    mean = thrust / (math.sin(alpha) * model.rollers)
    slope = load.radial * math.tan(alpha) / thrust
    loads = mean * roller_loads(slope, FINE if slope else 1)
    pressed = loads[loads > 0] * math.sin(2 * half)
    film = shape * (pressed / (STEEL * along**2)) ** -0.067 / model.rib_roughness
    dry = asperity_share(film)
    friction = dry * RIB_FRICTION + (1 - dry) * model.skf.full_film_friction
    rib = float((friction * pressed).sum()) * model.rib_height * outer / model.roller_diameter
    rolling = rolling_moment(model, bearing, axis, loads, speed, oil)
    return TaperedMoments(rolling, rib * model.rollers / len(loads), float(film.min()))


def thrust_sliding(
    model: ThrustRollerModel,
    bearing: CatalogueBearing,
    axial: float,
    speed: float,  # Speed of one washer against the other. [rad/s]
    oil: OilState,
) -> float:
    """Moment by which straight rollers slide on washers, mu F_a l/4. Theory (J43). [N m]

    The washers are faster outside and slower inside than the rollers, l/8 times the speed in the
    mean.
    """
    contact = LineContacts(
        line_load=np.array([axial / (model.rollers * model.roller_length)]),
        radius=np.array([model.roller_diameter / 2]),
        rolling_speed=np.array([abs(speed) * bearing.pitch_diameter / 4]),
        sliding_speed=np.array([abs(speed) * model.roller_length / 8]),
        flanks=Flanks(STEEL, *THRUST_ROUGHNESS),
        oil=oil,
    )
    mu = float(mixed_friction(contact, AS_MADE)[0])
    return mu * axial * model.roller_length / 4
