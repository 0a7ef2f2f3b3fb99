"""Tooth thickness as measured and as toleranced: span, balls and pins, DIN 3967, ISO 1328-1."""

from __future__ import annotations

import math
import re
from bisect import bisect_left

from epicyclic.dataclass import dataclass
from epicyclic.gears.gear import BasicRack, Gear, inverse_involute, involute

# Span measurement and dimension over balls or pins, and the tooth thickness that they tell.
#
# ISO 21771 and DIN 3960. An internal gear is measured like the external one that would fill its
# spaces: the span goes over spaces, and balls touch their spaces from within.


PIN = 1.7
"""Usual diameter of a measuring ball or pin over the normal module, near 1.68 to 1.73. [1]"""
PIN_STEP = 0.05e-3  # To which it is rounded. [m]


def _pitch_and_base(rack: BasicRack, teeth: int) -> tuple[float, float]:
    """Normal base pitch, and the base diameter times cos(beta_b). [m]"""
    pitch = rack.transverse_base_pitch * math.cos(rack.base_helix_angle)
    return pitch, teeth * pitch / math.pi


def half_angle_from_span(
    rack: BasicRack, teeth: int, internal: bool, measured: float, count: int
) -> float:
    """Half angle at the reference circle with the span W_k over `count` teeth. Theory (G48)."""
    pitch, base = _pitch_and_base(rack, teeth)
    half = (measured - (count - 1) * pitch) / base - involute(rack.transverse_pressure_angle)
    return math.pi / teeth - half if internal else half


def span(gear: Gear, count: int) -> float:
    """W_k over `count` teeth, or spaces of a ring. ISO 21771. Theory (G48). [m]

    Examples
    --------
    >>> rack = BasicRack(1e-3, math.radians(20.0), 0.0)
    >>> gear = Gear("pinion", rack, 20, False, math.pi / 40, 11e-3, 8.75e-3, 10e-3)
    >>> round(1e3 * span(gear, 3), 3)
    7.66
    """
    pitch, base = _pitch_and_base(gear.rack, gear.teeth)
    half = gear.thickness_half_angle
    if gear.internal:
        half = math.pi / gear.teeth - half
    return (count - 1) * pitch + base * (half + involute(gear.rack.transverse_pressure_angle))


def span_contact_radius(gear: Gear, measured: float) -> float:
    """Radius at which a span touches the flanks. ISO 21771. Theory (G49). [m]"""
    return math.hypot(gear.base_radius, measured * math.cos(gear.rack.base_helix_angle) / 2)


def usual_span_teeth(gear: Gear) -> int:
    """The number of teeth whose span touches nearest to the middle of the teeth."""
    pitch, _ = _pitch_and_base(gear.rack, gear.teeth)
    shift = gear.profile_shift_coefficient * gear.rack.normal_module
    middle = gear.reference_radius + gear.side * shift
    wanted = 2 * gear.roll_length_at(middle) / math.cos(gear.rack.base_helix_angle)
    return max(2, 1 + round((wanted - span(gear, 1)) / pitch))


def usual_pin(rack: BasicRack) -> float:
    """Diameter of a ball or pin that touches near the middle of the teeth. [m]"""
    return max(1, round(PIN * rack.normal_module / PIN_STEP)) * PIN_STEP


def _spacing(teeth: int) -> float:
    """Distance of opposite balls over the diameter of their circle. [1]"""
    return math.cos(math.pi / (2 * teeth)) if teeth % 2 else 1.0


def half_angle_from_pins(
    rack: BasicRack, teeth: int, internal: bool, measured: float, pin: float
) -> float:
    """Half angle at the reference circle of a tooth with dimension M_d over balls. Theory (G50).

    Raises `ValueError` if the balls would have their middle inside the base circle.
    """
    _, base = _pitch_and_base(rack, teeth)
    side = -1 if internal else 1
    cosine = base / math.cos(rack.base_helix_angle) * _spacing(teeth) / (measured - side * pin)
    if not 0 < cosine <= 1:
        raise ValueError("inside the base circle")
    change = involute(math.acos(cosine)) - involute(rack.transverse_pressure_angle)
    return math.pi / teeth - pin / base + side * change


def _pin_angle(gear: Gear, pin: float) -> float:
    """Transverse pressure angle at the middle of a ball in a space. Theory (G50).

    Raises `ValueError` if the ball is too small to touch the flanks.
    """
    _, base = _pitch_and_base(gear.rack, gear.teeth)
    space = math.pi / gear.teeth - gear.thickness_half_angle
    value = involute(gear.rack.transverse_pressure_angle) + gear.side * (pin / base - space)
    if value <= 0:
        raise ValueError("the ball does not touch the flanks")
    return inverse_involute(value)


def dimension_over_pins(gear: Gear, pin: float) -> float:
    """M_d over two balls, or between them in a ring. ISO 21771. Theory (G50). [m]

    Raises `ValueError` if the balls are too small to touch the flanks.

    Examples
    --------
    >>> rack = BasicRack(1e-3, math.radians(20.0), 0.0)
    >>> gear = Gear("pinion", rack, 20, False, math.pi / 40, 11e-3, 8.75e-3, 10e-3)
    >>> round(1e3 * dimension_over_pins(gear, 1.7e-3), 4)
    22.2941
    """
    circle = 2 * gear.base_radius / math.cos(_pin_angle(gear, pin))
    return circle * _spacing(gear.teeth) + gear.side * pin


def pin_contact_radius(gear: Gear, pin: float) -> float:
    """Radius at which balls touch the flanks. ISO 21771. Theory (G51). [m]

    Raises `ValueError` if the balls are too small to touch the flanks.
    """
    curvature = gear.base_radius * math.tan(_pin_angle(gear, pin))
    inward = gear.side * pin * math.cos(gear.rack.base_helix_angle) / 2
    return math.hypot(gear.base_radius, curvature - inward)


# Allowances of the tooth thickness by DIN 3967, and tolerances of flanks by ISO 1328-1.
#
# The tables of DIN 3967:1978 are second hand: two independent open programs print the same values,
# and the example of the standard agrees, series 27cd at 100 mm. Lengths are in metres.

_MM, _UM = 1e-3, 1e-6
_DIAMETERS = (10, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6300, 10000)
"""Largest reference diameter of each row of both tables. [mm]"""
LARGEST_FIT = _DIAMETERS[-1] * _MM  # [m]
_SERIES = ("a", "ab", "b", "bc", "c", "cd", "d", "e", "f", "g", "h")
_UPPER = (
    (100, 85, 70, 58, 48, 40, 33, 22, 10, 5, 0),
    (135, 110, 95, 75, 65, 54, 44, 30, 14, 7, 0),
    (180, 150, 125, 105, 85, 70, 60, 40, 19, 9, 0),
    (250, 200, 170, 140, 115, 95, 80, 56, 26, 12, 0),
    (330, 280, 230, 190, 155, 130, 110, 75, 35, 17, 0),
    (450, 370, 310, 260, 210, 175, 145, 100, 48, 22, 0),
    (600, 500, 420, 340, 290, 240, 200, 135, 64, 30, 0),
    (820, 680, 560, 460, 390, 320, 270, 180, 85, 41, 0),
    (1100, 920, 760, 620, 520, 430, 360, 250, 115, 56, 0),
    (1500, 1250, 1020, 840, 700, 580, 480, 330, 155, 75, 0),
    (2000, 1650, 1350, 1150, 940, 780, 640, 450, 210, 100, 0),
)
"""-A_sne of each row and series; Table 1. [um]"""
_FINEST = 21
_WIDTHS = (
    (3, 5, 8, 12, 20, 30, 50, 80, 130, 200),
    (5, 8, 12, 20, 30, 50, 80, 130, 200, 300),
    (6, 10, 16, 25, 40, 60, 100, 160, 250, 400),
    (8, 12, 20, 30, 50, 80, 130, 200, 300, 500),
    (10, 16, 25, 40, 60, 100, 160, 250, 400, 600),
    (12, 20, 30, 50, 80, 130, 200, 300, 500, 800),
    (16, 25, 40, 60, 100, 160, 250, 400, 600, 1000),
    (20, 30, 50, 80, 130, 200, 300, 500, 800, 1300),
    (25, 40, 60, 100, 160, 250, 400, 600, 1000, 1600),
    (30, 50, 80, 130, 200, 300, 500, 800, 1300, 2000),
    (40, 60, 100, 160, 250, 400, 600, 1000, 1600, 2400),
)
"""T_sn of each row, series 21 to 30; Table 2. [um]"""
_NAME = re.compile(r"(\d\d)([a-z]{1,2})|([a-z]{1,2})(\d\d)")


def named_fit(name: str) -> str | None:
    """The series of allowances and tolerances as DIN 3967 writes them, ``"27cd"``; None if unknown.

    Examples
    --------
    >>> named_fit("C 25")
    '25c'
    """
    match = _NAME.fullmatch("".join(name.lower().split()))
    if match is None:
        return None
    number, letters = int(match[1] or match[4]), match[2] or match[3]
    known = letters in _SERIES and _FINEST <= number < _FINEST + len(_WIDTHS[0])
    return f"{number}{letters}" if known else None


def fit_allowances(
    fit: str,  # As `named_fit` returns it.
    reference_diameter: float,  # Up to 10 m. [m]
) -> tuple[float, float]:
    """Upper and lower allowance of the tooth thickness, A_sne and A_sni. [m]

    DIN 3967:1978, Tables 1 and 2, and 3.2 (second hand). Theory (G53).

    Examples
    --------
    >>> [round(1e6 * value) for value in fit_allowances("27cd", 0.1)]
    [-70, -170]
    """
    row = bisect_left(_DIAMETERS, reference_diameter / _MM)
    upper = _UPPER[row][_SERIES.index(fit[2:])]
    return -upper * _UM, -(upper + _WIDTHS[row][int(fit[:2]) - _FINEST]) * _UM


@dataclass(frozen=True, slots=True)
class FlankTolerances:
    """Tolerances of the flanks of one gear by its class."""

    single_pitch: float  # f_pT. [m]
    profile_slope: float  # f_HalphaT, f_falphaT. [m]
    profile_form: float  # f_HalphaT, f_falphaT. [m]
    helix_slope: float  # f_HbetaT, f_fbetaT. [m]
    helix_form: float  # f_HbetaT, f_fbetaT. [m]

    @property
    def profile(self) -> float:
        """F_alphaT. [m]"""
        return math.hypot(self.profile_slope, self.profile_form)

    @property
    def helix(self) -> float:
        """F_betaT. [m]"""
        return math.hypot(self.helix_slope, self.helix_form)


def flank_tolerances(
    accuracy_class: int,  # 1 to 11.
    normal_module: float,  # [m]
    reference_diameter: float,  # [m]
    face_width: float,  # [m]
) -> FlankTolerances:
    """Tolerances of ISO 1328-1:2013, Formulae 5 and 7 to 12 (second hand). Theory (G54).

    Not rounded as the standard rounds them, to 1, 0.5 or 0.1 um. It holds for m_n from 0.5 to
    70 mm, d from 5 mm to 15 m and b from 4 mm to 1.2 m.

    Examples
    --------
    >>> found = flank_tolerances(6, 3e-3, 0.12, 0.04)
    >>> [round(1e6 * value, 2) for value in (found.single_pitch, found.profile, found.helix)]
    [8.94, 12.04, 14.4]
    """
    module, diameter, width = (
        value / _MM for value in (normal_module, reference_diameter, face_width)
    )
    step = _UM * math.sqrt(2) ** (accuracy_class - 5)
    root_d, root_b = math.sqrt(diameter), math.sqrt(width)
    return FlankTolerances(
        step * (0.001 * diameter + 0.4 * module + 5),
        step * (0.4 * module + 0.001 * diameter + 4),
        step * (0.55 * module + 5),
        step * (0.05 * root_d + 0.35 * root_b + 4),
        step * (0.07 * root_d + 0.45 * root_b + 4),
    )
