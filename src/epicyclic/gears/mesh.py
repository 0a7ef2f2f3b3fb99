"""The mesh of two gears, the profile shifts that close it, and how planets fit around it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, TypeVar

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.gears.gear import BasicRack, Gear, inverse_involute, involute

# The mesh of two gears: operating pressure angle, path of contact, contact ratios, clearances.
#
# Member 1 is always external: the sun of a sun-planet mesh, the planet of a planet-ring mesh, the
# pinion of a pair. The position on the path of contact is the transverse radius of curvature of
# member 1, measured on the line of action from its base circle. Symbols follow ISO 21771.


Real = TypeVar("Real", float, FloatArray)

TOUCHING = 0.5e-9
"""Flanks with less backlash, or thicker by less, touch: no drawing tells that from none. [m]"""


@dataclass(frozen=True)
class Mesh:
    """Two gears in mesh."""

    name: str  # ``"sun mesh"``, ``"ring mesh"`` or ``"mesh"``.
    gear1: Gear  # Member 1 is external; member 2 external or internal.
    gear2: Gear  # Member 1 is external; member 2 external or internal.
    center_distance: float  # [m]

    # What follows from them, NaN where such gears cannot mesh; no fields, which files would hold.
    if TYPE_CHECKING:
        gears: tuple[Gear, Gear] = field(init=False)  # Both.
        internal: bool = field(init=False)  # True if member 2 is a ring.
        ratio: float = field(init=False)  # u = z2/z1, positive. [1]
        side: int = field(init=False)  # Sign of member 2 in sums: -1 for an internal mesh, else +1.
        face_width: float = field(init=False)  # The smaller one; the other reaches beyond. [m]
        operating_pressure_angle: float = field(init=False)  # alpha_wt. [rad]
        operating_radius1: float = field(init=False)  # r_w1. [m]
        operating_radius2: float = field(init=False)  # r_w2. [m]
        operating_helix_tangent: float = field(init=False)  # tan(beta_w), of both members. [1]
        # Distance of the two points where the line of action touches the base circles. [m]
        line_of_action: float = field(init=False)
        # Radius of curvature of member 1 where the tip form circle of member 2 is in contact, at
        # its own tip form circle, and at the pitch point. [m]
        path_start: float = field(init=False)
        path_end: float = field(init=False)
        pitch_point: float = field(init=False)
        # epsilon_1 and epsilon_2, from the pitch point to both tips in base pitches. [1]
        tip_contact_ratios: tuple[float, float] = field(init=False)
        transverse_contact_ratio: float = field(init=False)  # epsilon_alpha, their sum. [1]
        overlap_ratio: float = field(init=False)  # epsilon_beta. [1]
        # Mean over the mesh period of the length of all contact lines. [m]
        mean_contact_length: float = field(init=False)
        backlash: float = field(init=False)  # j_wt, at the operating circles, transverse. [m]
        normal_backlash: float = field(init=False)  # j_bn, between flanks. [m]
        # Gaps between the tip of each member and the root of the other one. [m]
        tip_clearances: tuple[float, float] = field(init=False)
        # Radius on each member where contact with the tip of the other one ends. [m]
        inner_radii: tuple[float, float] = field(init=False)

    def __post_init__(self) -> None:
        """The figures of the mesh. ISO 21771.

        Theory (G13), (G14), (G15), (G16), (G17), (G18), (G19), (G20), (G21), (G22), (G23), (G40),
        (G47).
        """
        one, two, rack = self.gear1, self.gear2, self.gear1.rack
        side = two.side
        ratio, total = two.teeth / one.teeth, two.teeth + side * one.teeth
        bases = two.base_radius + side * one.base_radius
        can_mesh = total > 0 and abs(bases) <= self.center_distance
        distance = self.center_distance if can_mesh else math.nan
        angle = math.acos(bases / distance)  # (G13)
        radius1 = distance * one.teeth / (total or 1)  # (G14)
        action, point = distance * math.sin(angle), radius1 * math.sin(angle)  # (G16), (G18)
        start = side * (action - two.roll_length_at(two.tip_form_radius))  # (G17)
        end = one.roll_length_at(one.tip_form_radius)
        pitch, helix = rack.transverse_base_pitch, rack.base_helix_angle
        tips = ((end - point) / pitch, (point - start) / pitch)  # (G19)
        width = min(one.face_width, two.face_width)
        tooth1, tooth2 = one.thickness_at(radius1), two.thickness_at(radius1 * ratio)
        backlash = 2 * math.pi * radius1 / one.teeth - tooth1 - tooth2  # (G21)
        backlash = 0.0 if abs(backlash) < TOUCHING else backlash
        tangent = math.tan(rack.helix_angle) * radius1 / one.reference_radius  # (G15)
        vars(self).update(
            gears=(one, two),
            internal=two.internal,
            ratio=ratio,
            side=side,
            face_width=width,
            operating_pressure_angle=angle,
            operating_radius1=radius1,
            operating_radius2=radius1 * ratio,
            operating_helix_tangent=tangent,
            line_of_action=action,
            path_start=start,
            path_end=end,
            pitch_point=point,
            tip_contact_ratios=tips,
            transverse_contact_ratio=sum(tips),
            overlap_ratio=width * math.tan(helix) / pitch,  # (G20)
            mean_contact_length=width * sum(tips) / math.cos(helix),  # (G40)
            backlash=backlash,
            normal_backlash=backlash * math.cos(angle) * math.cos(helix),  # (G47)
            tip_clearances=(  # (G22)
                side * (self.center_distance - two.root_radius) - one.tip_radius,
                side * (self.center_distance - two.tip_radius) - one.root_radius,
            ),
            inner_radii=(  # (G23)
                math.hypot(one.base_radius, start),
                math.hypot(two.base_radius, action - side * end),
            ),
        )

    def curvature2(self, curvature1: Real) -> Real:
        """Transverse radius of curvature of member 2 where 1 has `curvature1`. Theory (G16). [m]"""
        return self.line_of_action - self.side * curvature1

    def equivalent_radius(self, curvature1: Real) -> Real:
        """Equivalent radius of curvature in the normal section. Theory (C3). [m]

        Litvin and Fuentes, Gear Geometry and Applied Theory: the curvature of an involute helicoid
        across its contact line is that of the transverse section times cos(beta_b).
        """
        curvature2 = self.curvature2(curvature1)
        transverse = curvature1 * curvature2 / (curvature2 + self.side * curvature1)
        return transverse / math.cos(self.gear1.rack.base_helix_angle)

    @property
    def tip_passage(self) -> float:
        """Clearance of the tips of an internal mesh where the tip circles cross, as an angle of
        member 2; infinite if they do not cross. Negative: tip interference. [rad]

        Theory (G24). Of tips without chamfers, which pass each other closer than chamfered ones.

        Polder (1991); Colbourne, The Geometry of Involute Gears (1987), section 8.
        """
        r1, r2, a = self.gear1.tip_radius, self.gear2.tip_radius, self.center_distance
        if not self.internal or r1 + a <= r2:
            return math.inf
        if r1 - a >= r2:  # the tips are in the teeth of the mate all around
            return -math.pi
        delta1 = math.acos((r2**2 - r1**2 - a**2) / (2 * a * r1))
        delta2 = math.acos((r2**2 - r1**2 + a**2) / (2 * a * r2))
        inv1 = involute(self.gear1.pressure_angle_at(r1))
        inv2 = involute(self.gear2.pressure_angle_at(r2))
        inv_w = involute(self.operating_pressure_angle)
        return (delta1 + inv1) / self.ratio - (delta2 + inv2) + (1 - 1 / self.ratio) * inv_w


@lru_cache(maxsize=256)
def with_faces(mesh: Mesh, width: float) -> Mesh:
    """The mesh of gears whose faces are both so wide. [m]"""
    one, two = (replace(gear, face_width=width) for gear in mesh.gears)
    return replace(mesh, gear1=one, gear2=two)


# Profile shifts, centre distance and backlash of a mesh: each from the other two.
#
# Tooth numbers are summed with the sign of ISO 21771, in which those of internal gears are
# negative; profile shifts are positive where they thicken the teeth.


def thinning(rack: BasicRack, normal_backlash: float) -> float:
    """Profile shift taken from a mesh that gives it a normal backlash j_bn [m]. Theory (G45). [1]

    ISO 21771:2007, Eq. 63.
    """
    return normal_backlash / (2 * rack.normal_module * math.sin(rack.normal_pressure_angle))


def profile_shift_sum(
    rack: BasicRack,
    teeth: int,  # z1 + z2, those of an internal gear negative.
    center_distance: float,  # [m]
    normal_backlash: float = 0.0,  # [m]
) -> float:
    """x1 + x2 at a centre distance. ISO 21771:2007, Eq. 62 and 63. Theory (G44), (G45). [1]

    Raises `ValueError` if the base circles do not let the gears come so close.

    Examples
    --------
    >>> rack = BasicRack(1.75e-3, math.radians(20.0), 0.0)
    >>> round(profile_shift_sum(rack, 21 + 43, 56.8e-3), 4)
    0.4806
    """
    cosine = abs(teeth) * rack.transverse_base_pitch / (2 * math.pi * center_distance)
    if cosine > 1 or teeth == 0:
        raise ValueError("the base circles do not allow so small a centre distance")
    change = involute(math.acos(cosine)) - involute(rack.transverse_pressure_angle)
    total = teeth * change / (2 * math.tan(rack.normal_pressure_angle))
    return total - thinning(rack, normal_backlash)


def closed_center_distance(
    rack: BasicRack,
    teeth: int,  # z1 + z2, those of an internal gear negative.
    shift_sum: float,  # x1 + x2. [1]
    normal_backlash: float = 0.0,  # j_bn. [m]
) -> float:
    """Centre distance a at which profile shifts leave this backlash. Theory (G44), (G45). [m]

    Raises `ValueError` if there is none.

    Examples
    --------
    >>> rack = BasicRack(1.75e-3, math.radians(20.0), 0.0)
    >>> round(1e3 * closed_center_distance(rack, 21 + 43, 0.4380 + 0.0426), 3)
    56.8
    """
    if teeth == 0:
        raise ValueError("a ring and its mate have equal numbers of teeth")
    value = involute(rack.transverse_pressure_angle)
    closed = shift_sum + thinning(rack, normal_backlash)
    value += closed * 2 * math.tan(rack.normal_pressure_angle) / teeth
    if value < 0:
        raise ValueError("the teeth are too thin for any centre distance")
    angle = inverse_involute(value)
    return abs(teeth) * rack.transverse_base_pitch / (2 * math.pi * math.cos(angle))


def tip_shortening(
    rack: BasicRack,
    teeth: int,  # z1 + z2, those of an internal gear negative.
    center_distance: float,  # [m]
    shift_sum: float,  # x1 + x2, without allowances. [1]
) -> float:
    """-k m_n, by which both tips keep the tip clearance of the rack. DIN 3960. Theory (G55). [m]

    Teeth that are too thick for their centre distance count as such that just fit. Zero in internal
    meshes: there the clearance is larger than that of the rack (k > 0), and no tip is lengthened.
    """
    if teeth <= 0:
        return 0.0
    try:
        distance = max(center_distance, closed_center_distance(rack, teeth, shift_sum))
    except ValueError:  # too thin to be too long
        return 0.0
    reference = teeth * rack.transverse_module / 2
    return max(0.0, reference + shift_sum * rack.normal_module - distance)


def recommended_backlash(rack: BasicRack, center_distance: float) -> float:
    """Least normal backlash recommended for industrial gears of steel. Theory (G46). [m]

    ISO/TR 10064-2:1996 (second hand), for pitch-line speeds up to 15 m/s.
    """
    return 2 / 3 * (0.06e-3 + 0.0005 * center_distance + 0.03 * rack.normal_module)


# Where planets can stand on their carrier, and how near they come to each other.
#
# A planet fits between sun and ring only at angles that are multiples of 2 pi/(z_s + z_r) from
# another one (Lynwander, Gear Drive Systems, 1983, chapter 8; Mueller, Epicyclic Drive Trains,
# 1982).


def are_evenly_spaced(angles: Sequence[float]) -> bool:
    """Planets at these angles [rad] divide the carrier into equal parts."""
    ordered = sorted(angle % (2 * math.pi) for angle in angles)
    step = 2 * math.pi / len(ordered)
    return all(
        math.isclose(angle - ordered[0], k * step, abs_tol=1e-9) for k, angle in enumerate(ordered)
    )


def nearest_admissible_angle(angle: float, teeth_sun: int, teeth_ring: int) -> float:
    """The angle nearest to `angle` at which a planet can be assembled. Theory (K7). [rad]"""
    step = 2 * math.pi / (teeth_sun + teeth_ring)
    return round(angle / step) * step


def closing_number(
    # For each mesh the teeth of its gears on planets, by their bodies, and those of its central
    # gear: negative for a ring gear, 0 between two planets.
    meshes: Sequence[tuple[Mapping[str, int], int]],
) -> int:
    """N: alike planets can stand at multiples of 1/N of a turn from another one. Theory (A6).

    0 if they can stand anywhere.
    """
    bodies = dict.fromkeys(body for teeth, _ in meshes for body in teeth)
    rows = [[*(teeth.get(body, 0) for body in bodies), central] for teeth, central in meshes]
    for column in range(len(bodies)):
        held = [row for row in rows if row[column]]
        rows = [row for row in rows if not row[column]]
        while len(held) > 1:
            # Euclid's algorithm with whole rows
            held.sort(key=lambda row: abs(row[column]))
            least = held[0]
            for row in held[1:]:
                times = row[column] // least[column]
                row[:] = [a - times * b for a, b in zip(row, least, strict=True)]
            rows += [row for row in held if not row[column]]
            held = [row for row in held if row[column]]
    return math.gcd(*(row[-1] for row in rows))


def nearest_places(count: int, number: int) -> tuple[float, ...]:
    """Angles of `count` planets, multiples of 1/`number` of a turn, nearest to equal spacing. [rad]

    Equally spaced if `number` is 0.
    """
    if number % count == 0:
        return tuple(2 * math.pi * planet / count for planet in range(count))
    step = 2 * math.pi / number
    return tuple(step * round(number * planet / count) for planet in range(count))


def pin_angle(radius1: float, radius2: float, distance: float) -> float:
    """Angle at the axis of the set between two pins at a distance from each other. Theory (A4).

    Raises `ValueError` if no triangle has these sides.
    """
    cosine = (radius1**2 + radius2**2 - distance**2) / (2 * radius1 * radius2)
    if abs(cosine) > 1:
        raise ValueError("these sides do not form a triangle")
    return math.acos(cosine)
