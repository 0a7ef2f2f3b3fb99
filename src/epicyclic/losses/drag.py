"""Losses without load: viscous drag of bearings and bodies, churning, oil jets."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Literal, NamedTuple

from epicyclic.arrays import between, larger, pow, sqrt
from epicyclic.dataclass import dataclass
from epicyclic.losses.ranges import OF_THIS_PACKAGE, ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.losses.windage import RIM_TRANSITION, rim_coefficient
from epicyclic.oil.oil import MixtureState
from epicyclic.units import METRE_PER_SECOND, MILLIMETRE, MILLIPASCAL_SECOND, NUMBER

# Load-independent losses of bearings and of bodies turning in the mixture of oil and air.


VISCOUS_METHOD = "viscous moment after Palmgren and Harris"
VISCOUS_SOURCE = "T. A. Harris, Rolling Bearing Analysis, 3rd ed. (1991); Talbot (2012), Eq. 5.6"

TRANSITION_REYNOLDS = 5e5
"""omega r^2/nu at which the flow on the faces turns turbulent, Talbot (2012), Eq. 5.5. [1]"""
RPM = math.pi / 30  # 1 rpm in rad/s.

SPEED_PARAMETER = Range(
    "speed_parameter", "speed times pitch diameter, rpm mm", None, 1e6, NUMBER, OF_THIS_PACKAGE
)
"""Range of the formulas of Palmgren and Harris, which come from tests at moderate speed."""
THICKEST = Range(
    "viscosity", "viscosity in the bearing", None, 80.0, MILLIPASCAL_SECOND,
    f"heating of the oil in the bearing is left out; {OF_THIS_PACKAGE}",
)  # fmt: skip
"""Range of the viscous moment: measured bearings whose heating is known had no thicker oil."""
_FACES_SOURCE = "one-seventh power law of the flat plate, Schlichting, Boundary-Layer Theory"
_FACES = Range("reynolds_number", "Reynolds number of the faces", None, 1e7, NUMBER, _FACES_SOURCE)
_CREEPING = Range(
    "reynolds_number", "Reynolds number of the faces", 70.0, None, NUMBER,
    "below it, the drag of a disc in creeping flow, 32/3 mu omega r^3, is larger: Lamb, "
    "Hydrodynamics",
)  # fmt: skip
_RIM_SOURCE = "laminar flow around a cylinder, Theodorsen and Regier, NACA Report 793 (1944)"
_RIM = Range(
    "reynolds_number", "Reynolds number of the rim", None, RIM_TRANSITION, NUMBER, _RIM_SOURCE
)


def bearing_viscous_loss(
    factor: float,  # f0. [1]
    kinematic_viscosity: float,  # Viscosity of the oil, not of the mixture. [m^2/s]
    speed: float,  # Speed of one ring against the other. [rad/s]
    pitch_diameter: float,  # d_m. [m]
) -> float:
    """Viscous loss of a rolling bearing after Palmgren and Harris. Theory (V1). [W]

    M0 = 1e-7 f0 (nu n)^(2/3) d_m^3 for nu n >= 2000, else 160e-7 f0 d_m^3; N mm, mm^2/s, rpm, mm.
    Talbot (2012), Eq. 5.6 for the first branch; Harris, Rolling Bearing Analysis, 3rd ed. (1991)
    for both. They differ by 0.8 % where they meet; here the larger one counts there.
    """
    rpm = abs(speed) / RPM
    product = kinematic_viscosity * 1e6 * rpm
    group = larger(160.0, pow(product, 2 / 3))
    moment = 1e-7 * factor * group * (pitch_diameter * 1e3) ** 3 * 1e-3
    return moment * abs(speed)


def viscous_flags(
    where: str, speed: float, pitch_diameter: float, viscosity: float
) -> tuple[ValidityFlag, ...]:
    """Flags of `bearing_viscous_loss` in the bearing called `where`; dynamic viscosity [Pa s]."""
    use = ModelUse("bearing_viscous", "harris", where)
    values = {"speed_parameter": speed_parameter(speed, pitch_diameter), "viscosity": viscosity}
    return check_ranges(use, (SPEED_PARAMETER, THICKEST) if speed else (), values)


def speed_parameter(speed: float, pitch_diameter: float) -> float:
    """n d_m of a bearing, in rpm mm."""
    return abs(speed) / RPM * pitch_diameter * 1e3


class DiscDrag(NamedTuple):
    """Drag of a disc, in two parts."""

    rim: float  # [W]
    faces: float  # Of both. [W]


def disc_drag(
    radius: float,  # [m]
    width: float,  # [m]
    speed: float,  # Against the housing. [rad/s]
    mixture: MixtureState,
) -> DiscDrag:
    """Drag of a disc in the mixture: rim (Eq. 5.4) and both faces (Eq. 5.5). Theory (V3), (V6).

    Seetharaman and Kahraman (2010), Talbot (2012), p. 130. The branches of the face formula do not
    meet; here the flow is laminar within the radius at which it turns turbulent, and the turbulent
    branch counts outside that radius only, after Prandtl.
    """
    omega = abs(speed)
    rim = 4 * math.pi * mixture.dynamic_viscosity * width * radius**2 * omega**2
    if reynolds_number(radius, omega, mixture) <= TRANSITION_REYNOLDS:
        return DiscDrag(rim, _laminar_faces(radius, omega, mixture))
    laminar = sqrt(TRANSITION_REYNOLDS * mixture.kinematic_viscosity / omega)
    faces = (
        _laminar_faces(laminar, omega, mixture)
        + _turbulent_faces(radius, omega, mixture)
        - _turbulent_faces(laminar, omega, mixture)
    )
    return DiscDrag(rim, faces)


def _laminar_faces(radius: float, omega: float, mixture: MixtureState) -> float:
    """First branch of Talbot (2012), Eq. 5.5. Theory (V4). [W]"""
    group = sqrt(mixture.kinematic_viscosity) * pow(omega, 2.5)
    return 0.41 * math.pi * mixture.density * group * radius**4


def _turbulent_faces(radius: float, omega: float, mixture: MixtureState) -> float:
    """Second branch of Talbot (2012), Eq. 5.5. Theory (V4). [W]"""
    group = pow(mixture.kinematic_viscosity, 0.14) * pow(omega, 2.86)
    return 0.025 * math.pi * mixture.density * group * pow(radius, 4.72)


def disc_drag_flags(
    where: str, radius: float, drag: DiscDrag, speed: float, mixture: MixtureState
) -> tuple[ValidityFlag, ...]:
    """Flags of the `drag` of the body called `where`, each with the part of it that it concerns."""
    total = sum(drag)
    if total == 0:
        return ()
    use = ModelUse("drag", "seetharaman-kahraman", where)
    reynolds = reynolds_number(radius, speed, mixture)
    values = {"reynolds_number": reynolds}
    rim, faces = drag
    law = rim * reynolds / 4 * rim_coefficient(reynolds)
    found = check_ranges(use, (_RIM,), values, part=rim / total, watts=rim, could_be=law)
    return found + check_ranges(use, (_FACES, _CREEPING), values, part=faces / total, watts=faces)


def reynolds_number(radius: float, speed: float, mixture: MixtureState) -> float:
    """omega r^2/nu. Theory (V5). [1]"""
    return abs(speed) * radius**2 / mixture.kinematic_viscosity


# Churning of parts that dip into an oil sump: Changenet and Velex, and ISO/TR 14179-1.

ChurningModel = Literal["changenet-velex", "iso-14179-1"]

GRAVITY = 9.80665  # [m/s^2]
SLOW, FAST = 750.0, 1250.0
"""Acceleration parameter up to which, and from which, flow is of one regime. [m/s^2]"""
ARRANGEMENT = 0.2  # A_g of ISO/TR 14179-1. [1]
LEAST_HELIX = math.radians(10.0)  # Smallest helix angle with which ISO/TR 14179-1 computes. [rad]
LEAST_MODULE = 0.7
"""Transverse module at which its roughness factor is held, before it reaches zero. [mm]"""


@dataclass(frozen=True, slots=True)
class Dipped:
    """A part that turns about a level axis and dips into oil."""

    radius: float  # Radius of the pitch circle, or of the outside of a part without teeth. [m]
    tip_radius: float  # [m]
    width: float  # [m]
    depth: float  # Depth of its lowest point below the oil at rest. [m]
    module: float  # Normal module; of a part without teeth, that of the gears beside it. [m]
    teeth: int = 0  # 0 for a part without teeth.
    tooth_height: float = 0.0  # [m]
    # Normal pressure angle and helix angle at the reference circle. [rad]
    pressure_angle: float = 0.0
    helix_angle: float = 0.0

    @property
    def immersed(self) -> float:
        """Depth over the diameter, 0 to 1. [1]"""
        return min(max(self.depth / (2 * self.tip_radius), 0.0), 1.0)

    @property
    def wetted_angle(self) -> float:
        """Half the angle below the oil, cos(theta) = 1 - 2 h/d_a. Theory (N4). [rad]"""
        return math.acos(1 - 2 * self.immersed)


@dataclass(frozen=True, slots=True)
class SumpOil:
    """The oil in a sump."""

    density: float  # [kg/m^3]
    kinematic_viscosity: float  # [m^2/s]
    volume: float  # [m^3]
    smooth: bool = False  # Whether regimes of flow pass into one another without a kink.


@dataclass(frozen=True, slots=True)
class Churning:
    """A model of churning."""

    title: str
    source: str
    reliability: str  # How well it is known to be right, as a phrase.
    # From a part, its speed in rad/s and the oil to the torque in N m.
    torque: Callable[[Dipped, float, SumpOil], float]


def wetted_area(part: Dipped) -> float:
    """Surface of a part below the oil at rest: faces, rim and flanks. Theory (N4). [m^2]

    Changenet et al. (2011), second hand: S_m = R^2 (2 theta - sin 2 theta) + 2 R b theta
    + 2 z theta H b/(pi cos(alpha) cos(beta)), cos(theta) = 1 - h/R.

    Examples
    --------
    A spur gear of 30 teeth, module 4 mm, dipped to its axis:

    >>> from math import radians
    >>> gear = Dipped(0.06, 0.064, 0.03, 0.064, 0.004, 30, 0.009, radians(20))
    >>> round(1e4 * wetted_area(gear), 1)  # cm^2
    255.8
    """
    theta = part.wetted_angle
    faces = part.radius**2 * (2 * theta - math.sin(2 * theta))
    rim = 2 * part.radius * part.width * theta
    angles = math.cos(part.pressure_angle) * math.cos(part.helix_angle)
    flanks = 2 * part.teeth * theta * part.tooth_height * part.width / (math.pi * angles)
    return faces + rim + flanks


def displaced(part: Dipped) -> float:
    """Volume of a part below the oil at rest, its teeth taken as full. [m^3]"""
    theta = part.wetted_angle
    return part.tip_radius**2 * (theta - math.sin(2 * theta) / 2) * part.width


def acceleration_parameter(part: Dipped, speed: float) -> float:
    """omega^2 (R b m)^(1/3), which tells the regimes of flow apart. Theory (N6). [m/s^2]

    Changenet et al. (2011), second hand.

    Examples
    --------
    >>> round(acceleration_parameter(Dipped(0.06, 0.064, 0.03, 0.02, 0.004), 200.0), 1)
    772.4
    """
    return speed**2 * math.cbrt(part.radius * part.width * part.module)


def changenet_velex(
    part: Dipped,
    speed: float,  # Against the housing. [rad/s]
    oil: SumpOil,
) -> float:
    """Churning torque after Changenet and Velex (2007), second hand. Theory (N3), (N5). [N m]

    C = rho omega^2 S_m R^3 C_m/2; C_m by the regime of flow, between the two regimes a smooth
    passage in the acceleration parameter.

    Examples
    --------
    >>> gear = Dipped(0.06, 0.064, 0.03, 0.032, 0.004, 30, 0.009, 0.349)
    >>> round(changenet_velex(gear, 150.0, SumpOil(850.0, 40e-6, 2e-3)), 3)
    0.175
    """
    omega = abs(speed)
    if not (omega**2) or not part.immersed:
        return 0.0
    parameter = acceleration_parameter(part, omega)
    slow: float = between((FAST - parameter) / (FAST - SLOW), 0.0, 1.0)
    if oil.smooth:
        slow = slow**2 * (3 - 2 * slow)
    coefficient = slow * _slow_coefficient(part, omega, oil)
    coefficient += (1 - slow) * _fast_coefficient(part, omega, oil)
    return oil.density * omega**2 * wetted_area(part) * part.radius**3 * coefficient / 2


def _slow_coefficient(part: Dipped, omega: float, oil: SumpOil) -> float:
    """C_m of the slow regime. Theory (N5). [1]"""
    reynolds = omega * part.radius * part.width / oil.kinematic_viscosity
    volume = oil.volume / (2 * part.radius) ** 3
    root_froude = omega * math.sqrt(part.radius / GRAVITY)  # whose square may be too small
    return (
        1.366
        * math.pow(part.immersed, 0.45)
        * math.pow(volume, 0.1)
        * pow(root_froude, 2 * -0.6)
        * pow(reynolds, -0.21)
    )


def _fast_coefficient(part: Dipped, omega: float, oil: SumpOil) -> float:
    """C_m of the fast regime, in which viscosity takes no part. Theory (N5). [1]"""
    volume = oil.volume / (2 * part.radius) ** 3
    root_froude = omega * math.sqrt(part.radius / GRAVITY)
    return (
        3.644
        * math.pow(part.immersed, 0.1)
        * math.pow(volume, -0.35)
        * pow(root_froude, 2 * -0.88)
        * math.pow(part.width / (2 * part.radius), 0.85)
    )


def iso_14179_1(part: Dipped, speed: float, oil: SumpOil) -> float:
    """Churning torque of ISO/TR 14179-1, second hand. Theory (N7). [N m]

    Faces 1.474 f_g nu n^3 D^5.7/(A_g 10^26), rim 7.37 f_g nu n^3 D^4.7 L/(A_g 10^26), for gears
    times R_f/sqrt(tan(beta)), R_f = 7.93 - 4.648/m_t; kW, mm^2/s, rpm, mm. Parameters as for
    `changenet_velex`.

    Examples
    --------
    >>> gear = Dipped(0.06, 0.064, 0.03, 0.032, 0.004, 30, 0.009, 0.349)
    >>> round(iso_14179_1(gear, 150.0, SumpOil(850.0, 40e-6, 2e-3)), 3)
    0.295
    """
    omega = abs(speed)
    if not omega:
        return 0.0
    diameter, width = 2e3 * part.tip_radius, 1e3 * part.width
    group = part.immersed * 1e6 * oil.kinematic_viscosity * (omega / RPM) ** 3
    group /= ARRANGEMENT * 1e26
    faces = 1.474 * group * math.pow(diameter, 5.7)
    rim = 7.37 * group * math.pow(diameter, 4.7) * width
    if part.teeth:
        module = max(1e3 * part.module / math.cos(part.helix_angle), LEAST_MODULE)
        rim *= (7.93 - 4.648 / module) / math.sqrt(math.tan(max(part.helix_angle, LEAST_HELIX)))
    return 1e3 * (faces + rim) / omega


CHURNING_MODELS: Mapping[ChurningModel, Churning] = {
    "changenet-velex": Churning(
        "churning after Changenet and Velex",
        "C. Changenet, P. Velex, J. Mech. Des. 129 (2007) 128; regimes: C. Changenet, G. Leprince, "
        "F. Ville, P. Velex, J. Mech. Des. 133 (2011) 121009; second hand",
        "fitted to tests of single gears, whose scatter was not found in print; other works give "
        "up to 40 % less in its slow regime",
        changenet_velex,
    ),
    "iso-14179-1": Churning(
        "churning of ISO/TR 14179-1",
        "ISO/TR 14179-1:2001, second hand",
        "coefficients of a standard that states no error",
        iso_14179_1,
    ),
}

_SINGLE_GEARS = (
    "single gears typical of automotive transmissions, Changenet and Velex, J. Mech. Des. 130 "
    "(2008) 062602, abstract; the limits are of this package"
)
_RANGES = {
    "changenet-velex": (
        Range("diameter", "immersed pitch diameter", 50.0, 300.0, MILLIMETRE, _SINGLE_GEARS),
        Range("immersed", "immersion depth over the diameter", None, 0.5, NUMBER, _SINGLE_GEARS),
    ),
    "iso-14179-1": (
        Range(
            "module", "transverse module", LEAST_MODULE, None, MILLIMETRE,
            "below it, the factor of the teeth approaches zero and is held: limit of this package",
        ),
    ),
}  # fmt: skip
_SPLASH_SOURCE = (
    "dip lubrication is recommended below it: P. Walter, after Forsch. Ingenieurwes. 84 (2020), "
    "doi 10.1007/s10010-020-00423-0"
)
_ANY_SUMP = (
    Range("tip_speed", "speed of the immersed rim", None, 20.0, METRE_PER_SECOND, _SPLASH_SOURCE),
    Range("oil", "oil volume over that of the immersed part", 1.0, None, NUMBER, OF_THIS_PACKAGE),
)


def churning_flags(
    model: ChurningModel, where: str, part: Dipped, speed: float, volume: float
) -> tuple[ValidityFlag, ...]:
    """Flags of the churning of the part called `where`."""
    if not speed or not part.immersed:
        return ()
    values = {
        "diameter": 2 * part.radius,
        "immersed": part.immersed,
        "module": part.module / math.cos(part.helix_angle) if part.teeth else math.inf,
        "tip_speed": abs(speed) * part.tip_radius,
        "oil": volume / displaced(part),
    }
    return check_ranges(ModelUse("drag", model, where), (*_RANGES[model], *_ANY_SUMP), values)


# Momentum that gears give to the oil of jets.

NozzleSide = Literal["in-mesh", "out-of-mesh", "radial"]
JET_METHOD = "momentum of the oil of jets"
JET_SOURCE = "Y. Ariura, T. Ueno, T. Sunaga, S. Sunamoto, Bull. JSME 16 (1973) 881, second hand"
_ALONG: Mapping[NozzleSide, float] = MappingProxyType(
    {"in-mesh": -1.0, "out-of-mesh": 1.0, "radial": 0.0}
)
"""Share of the jet's speed that adds to what the oil has to be brought to."""


def jet_loss(
    density: float,  # [kg/m^3]
    flow: float,  # [m^3/s]
    pitch_speed: float,  # [m/s]
    jet_speed: float,  # [m/s]
    side: NozzleSide,
) -> float:
    """Power that brings the oil of jets to the speed of the teeth. Theory (N8). [W]

    Ariura et al. (1973), second hand: P = rho Q v_t (v_t + v_jet) against the teeth, as they part;
    v_t - v_jet with them, as they mesh. Oil faster than the teeth is taken to drive nothing.

    Examples
    --------
    Two litres a minute at 30 m/s on teeth of 50 m/s:

    >>> [round(jet_loss(830.0, 2e-3 / 60, 50.0, 30.0, side), 2)
    ...  for side in ("in-mesh", "radial", "out-of-mesh")]
    [27.67, 69.17, 110.67]
    """
    return density * flow * pitch_speed * larger(pitch_speed + _ALONG[side] * jet_speed, 0.0)
