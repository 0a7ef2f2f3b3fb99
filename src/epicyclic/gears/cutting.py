"""Tools that generate gears, the tooth outlines that they leave, and the tool of a gear."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Literal

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.gear import Gear, half_angle_from_profile_shift, inverse_involute, involute


@dataclass(frozen=True, slots=True)
class RackTool:
    """A rack, the tool of external gears.

    The rounding is a circle in the normal section of the rack. The transverse section of the gear
    is generated exactly by the transverse section of the rack, where that circle is an ellipse,
    1/cos(beta) times as wide as high; the ellipse is used, not a circle in its place.

    The tip line of the rack touches the root circle of the gear, and its teeth fill the spaces of
    the gear on the reference circle: tool addendum and profile shift follow from the gear.
    """

    # rho_fP, rounding of the tool tip in the normal section; zero for a sharp corner. [m]
    tip_radius: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.tip_radius < math.inf:
            raise ValueError("the rounding of a tool tip must be zero or positive")


@dataclass(frozen=True, slots=True)
class ShaperTool:
    """A pinion-type cutter, the tool of internal gears.

    Its rounding is a circle in the transverse section, tangent to the tip circle and to the
    involute flank of the cutter. The generating centre distance is the one without backlash, where
    the cutter fills the spaces of the ring, and the tip radius of the cutter is the root radius of
    the ring less that distance. Infeed of the cutter is taken as axial.
    """

    teeth: int  # z_0.
    # Rounding of the tool tip in the transverse section; zero for a sharp corner. [m]
    tip_radius: float
    # x_0: new cutters have a positive one, reground ones a smaller. [1]
    profile_shift_coefficient: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.tip_radius < math.inf:
            raise ValueError("the rounding of a tool tip must be zero or positive")
        if self.teeth < 1:
            raise ValueError("a shaper cutter needs at least one tooth")


Tool = RackTool | ShaperTool


def zero_between(function: Callable[[float], float], low: float, high: float) -> float:
    """Zero of `function` between two arguments, by the Illinois variant of regula falsi.

    If rounding errors leave both ends with one sign, the end closer to zero is returned.
    """
    at_low, at_high = function(low), function(high)
    if at_low * at_high >= 0.0:
        return low if abs(at_low) < abs(at_high) else high
    for _ in range(100):
        middle = high - at_high * (high - low) / (at_high - at_low)
        at_middle = function(middle)
        if at_middle == 0.0 or abs(high - low) <= 1e-15 * abs(high) or middle in (low, high):
            return middle
        if at_middle * at_high < 0.0:
            low, at_low = high, at_high
        else:
            at_low /= 2
        high, at_high = middle, at_middle
    return high


# Gears as a tool generates them: the tool fitted to the gear, and the fillet that it leaves.
#
# External gears are cut by a rack (hob, grinding worm), internal ones by a pinion-type shaper
# cutter. Tooth thickness, tip and root radius are the gear's own and are met exactly: the tool is
# fitted to them. Fillets follow from the law of gearing: where tool and gear touch, the common
# normal passes through the pitch point of the generating motion (Litvin and Fuentes, Gear Geometry
# and Applied Theory, 2nd ed., chapter 6). Each fillet is therefore a closed form of one parameter,
# the angle of that normal from the line of centres: zero at the root circle, the complement of the
# generating pressure angle where the rounding of the tool goes over into its flank. Where no source
# is named, the formula was derived from this law. Symbols follow ISO 21771; angles in radians,
# lengths in metres.

RACK_ROUNDING = 0.38  # rho_fP / m_n of the default rack. ISO 53, profile A. [1]

SHAPER_ROUNDING = 0.2
"""Tip rounding of the default shaper cutter over m_n: a usual value, not a standardised one. [1]"""

SHAPER_TEETH_SHARE = 1 / 3  # Teeth of the default shaper cutter over those of the ring. [1]

SHAPER_TEETH_LEAST = 10  # Fewest teeth of the default shaper cutter. [1]

SHAPER_TEETH_SHARE_MOST = 2 / 3
"""Most teeth of the default shaper cutter over those of the ring. [1]"""

PATH_STEPS = 257
"""Positions of the cutter at which its way out of the ring is checked: cuts of a few thousandths of
a module may pass between two of them."""


@dataclass(frozen=True, slots=True)
class RackCut:
    """Generation of an external gear by a rack whose pitch line rolls on the reference circle."""

    tool_radius: float  # Rounding used, normal section. [m]
    # Angle of the contact normal from the line of centres where the rounding ends. [rad]
    last_normal: float
    # Radius of curvature of the involute there, negative beyond its start: undercut. [m]
    last_curvature: float
    pitch_radius: float  # r. [m]
    stretch: float  # Width of the rounding over its height in the transverse section. [1]
    # Centre of the rounding, below the pitch line and from the middle of the rack tooth. [m]
    center_depth: float
    center_offset: float
    root_angle: float  # Half the angle of the root arc. [rad]

    def fillet(self, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Radius, and angle from the middle of the space, where the contact normal has `normal`.

        Theory (G30).
        """
        sine, cosine, tangent = np.sin(normal), np.cos(normal), np.tan(normal)
        # The point of the ellipse, about its centre, where its outward normal has this angle.
        support = np.sqrt((self.stretch * sine) ** 2 + cosine**2)
        aside = self.tool_radius * self.stretch**2 * sine / support
        depth = self.center_depth + self.tool_radius * cosine / support
        # The normal through this point meets the pitch point when the rack has moved so far.
        x = depth * tangent
        travel = x - self.center_offset - aside
        y = self.pitch_radius - depth
        return np.hypot(x, y), np.arctan2(x, y) - travel / self.pitch_radius


@dataclass(frozen=True, slots=True)
class ShaperCut:
    """Generation of an internal gear by a pinion-type cutter."""

    tool_radius: float  # As for `RackCut`.
    last_normal: float  # As for `RackCut`.
    last_curvature: float  # As for `RackCut`.
    cutter_pitch_radius: float  # r_w of cutter and ring in the generating motion. [m]
    pitch_radius: float  # r_w of cutter and ring in the generating motion. [m]
    # Centre of the rounding about the cutter axis, from the middle of the cutter tooth. [m], [rad]
    center_radius: float
    center_angle: float
    ratio: float  # z_0/z: turn of the ring for one of the cutter. [1]
    root_angle: float  # Half the angle of the root arc. [rad]

    def fillet(self, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Radius, and angle from the middle of the space, where the contact normal has `normal`.

        Theory (G33).
        """
        sine, cosine = np.sin(normal), np.cos(normal)
        # Distance from the pitch point, along the normal, of the circle that the centre of the
        # rounding runs on; rounding errors may leave it a hair out of reach at the end.
        reach = np.maximum(0.0, self.center_radius**2 - (self.cutter_pitch_radius * sine) ** 2)
        distance = np.sqrt(reach) - self.cutter_pitch_radius * cosine
        cutter_turn = (
            np.arctan2(distance * sine, self.cutter_pitch_radius + distance * cosine)
            - self.center_angle
        )
        x = (distance + self.tool_radius) * sine
        y = self.pitch_radius + (distance + self.tool_radius) * cosine
        return np.hypot(x, y), np.arctan2(x, y) - cutter_turn * self.ratio


Cut = RackCut | ShaperCut


def default_tool(gear: Gear) -> Tool:
    """Tool assumed where none is given.

    External gears: a rack with rho_fP = 0.38 m_n, profile A of ISO 53. Internal gears: a shaper
    cutter without profile shift and with a tip rounding of 0.2 m_n; its tooth count is the one
    nearest to a third of the ring's that can generate the ring, between 10 and two thirds of it.
    Raises `ValueError` if no such shaper cutter generates the ring.
    """
    module = gear.rack.normal_module
    if not gear.internal:
        return RackTool(RACK_ROUNDING * module)
    _check_gear(gear)
    wanted = gear.teeth * SHAPER_TEETH_SHARE
    most = int(gear.teeth * SHAPER_TEETH_SHARE_MOST)
    reasons = []
    for teeth in sorted(range(SHAPER_TEETH_LEAST, most + 1), key=lambda z: abs(z - wanted)):
        tool = ShaperTool(teeth, SHAPER_ROUNDING * module)
        try:
            fit_tool(gear, tool)
        except ValueError as error:
            reasons.append(str(error))
        else:
            return tool
    if not reasons:
        raise ValueError(
            f"a shaper cutter of {SHAPER_TEETH_LEAST} teeth is too large for the {gear.name} of "
            f"{gear.teeth} teeth"
        )
    raise ValueError(
        f"no shaper cutter of {SHAPER_TEETH_LEAST} to {most} teeth without profile shift generates "
        f"the {gear.name}: {reasons[0]}"
    )


def fit_tool(gear: Gear, tool: Tool) -> Cut:
    """Fit the tool to the gear, and check that both can be.

    Raises `ValueError` if the tool cannot generate this gear.
    """
    _check_gear(gear)
    if gear.internal != isinstance(tool, ShaperTool):
        needed = (
            "internal gear needs a shaper cutter" if gear.internal else "external gear needs a rack"
        )
        raise ValueError(f"the {gear.name} cannot be cut with this tool: an {needed}")
    if isinstance(tool, RackTool):
        return _rack_cut(gear, tool)
    cut = _shaper_cut(gear, tool)
    _check_trimming(gear, cut)
    return cut


def _check_gear(gear: Gear) -> None:
    height = gear.tip_radius - gear.root_radius
    if gear.root_radius <= 0.0 or (height >= 0.0 if gear.internal else height <= 0.0):
        raise ValueError(f"root and tip circle of the {gear.name} leave no tooth height")
    if gear.tip_half_angle < 0.0:
        raise ValueError(f"the teeth of the {gear.name} become pointed below the tip")


def _rack_cut(gear: Gear, tool: RackTool) -> RackCut:
    """The rack that cuts `gear`, its rounding reduced to what fits its tip. Theory (G28), (G29)."""
    rack = gear.rack
    alpha_t, alpha_n = rack.transverse_pressure_angle, rack.normal_pressure_angle
    radius = gear.reference_radius
    addendum = radius - gear.root_radius
    # Half the width of the rack tooth on the pitch line: that of the space it fills.
    half_width = math.pi * rack.transverse_module / 2 - radius * gear.thickness_half_angle
    half_tip = half_width - addendum * math.tan(alpha_t)
    if half_tip < 0.0:
        raise ValueError(
            f"the root circle of the {gear.name} lies deeper than a pointed rack tooth reaches"
        )
    stretch = 1 / math.cos(rack.helix_angle)
    # How much of the tip land a rounding of unit radius takes on one side, transverse.
    land = stretch / math.cos(alpha_n) - math.tan(alpha_t)
    rounding = min(tool.tip_radius, half_tip / land)
    flank_depth = addendum - rounding * (1 - math.sin(alpha_n))
    offset = max(0.0, half_tip - rounding * land)
    return RackCut(
        tool_radius=rounding,
        last_normal=math.pi / 2 - alpha_t,
        last_curvature=radius * math.sin(alpha_t) - flank_depth / math.sin(alpha_t),
        pitch_radius=radius,
        stretch=stretch,
        center_depth=addendum - rounding,
        center_offset=offset,
        root_angle=offset / radius,
    )


def _shaper_cut(gear: Gear, tool: ShaperTool) -> ShaperCut:
    """The cutter that cuts `gear`, its rounding reduced to what fits its tip. Theory (G32)."""
    rack = gear.rack
    difference = gear.teeth - tool.teeth
    if difference <= 0:
        raise ValueError(
            f"a shaper cutter of {tool.teeth} teeth does not fit into the {gear.name} of "
            f"{gear.teeth} teeth"
        )
    half_angle = half_angle_from_profile_shift(rack, tool.teeth, tool.profile_shift_coefficient)
    alpha = _generating_pressure_angle(gear, tool.teeth, half_angle)
    base = tool.teeth * rack.transverse_module / 2 * math.cos(rack.transverse_pressure_angle)
    pitch = base / math.cos(alpha)
    center_distance = pitch * difference / tool.teeth
    action = center_distance * math.sin(alpha)
    tip = gear.root_radius - center_distance
    if tip <= base:
        raise ValueError(
            f"the root circle of the {gear.name} is not generated by a shaper cutter of "
            f"{tool.teeth} teeth, whose tip would lie inside its base circle"
        )
    if gear.tip_radius <= gear.base_radius or gear.roll_length_at(gear.tip_radius) < action:
        raise ValueError(
            f"the tip of the {gear.name} is not generated by a shaper cutter of {tool.teeth} "
            "teeth, whose involute would have to continue inside its base circle"
        )
    base_half_angle = half_angle + involute(rack.transverse_pressure_angle)

    def center_angle(rounding: float) -> float:
        curvature = math.sqrt(max(0.0, (tip - rounding) ** 2 - base**2))
        roll = (rounding + curvature) / base
        return base_half_angle - roll + math.atan(curvature / base)

    if center_angle(0.0) < 0.0:
        raise ValueError(
            f"the root circle of the {gear.name} lies deeper than a pointed shaper cutter of "
            f"{tool.teeth} teeth reaches"
        )
    # A rounding larger than this would touch the flank inside the base circle of the cutter.
    rounding = min(tool.tip_radius, tip - base)
    if center_angle(rounding) < 0.0:
        rounding = zero_between(center_angle, 0.0, rounding)
    flank_curvature = rounding + math.sqrt(max(0.0, (tip - rounding) ** 2 - base**2))
    angle, ratio = max(0.0, center_angle(rounding)), pitch / (center_distance + pitch)
    return ShaperCut(
        tool_radius=rounding,
        last_normal=math.pi / 2 - alpha,
        last_curvature=action + flank_curvature,
        cutter_pitch_radius=pitch,
        pitch_radius=center_distance + pitch,
        center_radius=tip - rounding,
        center_angle=angle,
        ratio=ratio,
        root_angle=angle * ratio,
    )


def _generating_pressure_angle(gear: Gear, cutter_teeth: int, cutter_half_angle: float) -> float:
    """Operating pressure angle of cutter and ring without backlash. Theory (G31). [rad]

    Both thicknesses on the pitch circles add up to the pitch there. ISO 21771 gives the same
    relation in terms of profile shifts: inv(alpha_w) = inv(alpha) + 2 tan(alpha) sum(x)/sum(z).
    """
    space = math.pi - gear.teeth * gear.thickness_half_angle - cutter_teeth * cutter_half_angle
    value = involute(gear.rack.transverse_pressure_angle) + space / (gear.teeth - cutter_teeth)
    if value <= 0.0:
        raise ValueError(
            f"the spaces of the {gear.name} are too narrow for a shaper cutter of {cutter_teeth} "
            f"teeth"
        )
    return inverse_involute(value)


def _check_trimming(gear: Gear, cut: ShaperCut) -> None:
    """Refuse a cutter whose tip cuts the flanks of the ring on its way out of the space.

    The rounding is a disc inside the cutter tooth, and nowhere on its path may the disc reach over
    flank or tip corner. The way in is the mirror image, with the other flank. Theory (G35).
    """
    # Beyond this angle the disc has left the tip circle of the ring.
    distance, center = cut.pitch_radius - cut.cutter_pitch_radius, cut.center_radius
    outside = gear.tip_radius - cut.tool_radius
    cosine = (outside**2 - distance**2 - center**2) / (2 * distance * center)
    greatest = math.acos(min(1.0, max(-1.0, cosine)))
    # Centre of the rounding as the ring sees it; angles from the middle of the space.
    turn = np.linspace(0.0, greatest, PATH_STEPS)
    x, y = center * np.sin(turn), distance + center * np.cos(turn)
    radius = np.hypot(x, y)
    angle = np.arctan2(x, y) - (turn - cut.center_angle) * cut.ratio
    # Involutes of one base circle are parallel: their distance, along the tangent of that circle,
    # is the arc between them on it.
    base = gear.base_radius
    curvature = np.sqrt(np.maximum(0.0, radius**2 - base**2))
    space = math.pi / gear.teeth - gear.half_angles_at(curvature)
    to_flank = base * (space - angle)
    on_flank = (radius >= base) & (curvature + to_flank >= gear.roll_length_at(gear.tip_radius))
    corner = math.pi / gear.teeth - gear.half_angle_at(gear.tip_radius)
    to_corner = np.abs(radius * np.exp(1j * (angle - corner)) - gear.tip_radius)
    closest = float(np.min(np.where(on_flank, to_flank, to_corner)))
    # At the end of the fillet the disc just touches; this much is rounding error.
    if closest < cut.tool_radius - 1e-9 * gear.reference_radius:
        raise ValueError(
            f"the shaper cutter cuts away the tips of the {gear.name}: it needs fewer teeth"
        )


# Transverse tooth outlines with the root fillet that a generating tool leaves.
#
# Angles in radians, lengths in metres.


POINTS_PER_SECTION = 32
"""Points on each section of an outline: chords leave the curve by 0.001 m_t at most, about."""


@dataclass(frozen=True, slots=True, eq=False)
class ToothOutline:
    """Right-hand half of one tooth, from the middle of the space to the middle of the tooth."""

    teeth: int  # Number of teeth of the gear.
    internal: bool  # True for a ring gear.
    # Radius of each point, from root to tip: rising for external gears, falling for internal ones.
    # Read-only. [m]
    radius: FloatArray
    # Angle of each point from the centre line of the tooth, from pi/z to zero. Read-only. [rad]
    half_angle: FloatArray
    # Indices of the four points that end the root arc, the fillet, the involute and the tip
    # chamfer. A section without length has no points of its own, so two joints may be equal.
    joints: tuple[int, int, int, int]
    form_radius: float  # r_Ff, where involute and fillet meet. [m]
    # True if the fillet cuts the involute off above its start; the outline then has a corner at the
    # form radius.
    undercut: bool
    # Rounding of the tool that cut the fillet. Smaller than the one asked for if that did not fit
    # into the tip of the tool, which is then fully round. [m]
    fillet_tool_radius: float

    def section(self, name: Literal["root", "fillet", "involute", "chamfer", "tip"]) -> slice:
        """Where in `radius` and `half_angle` a section lies, its two end points included."""
        ends = (0, *self.joints, self.radius.size - 1)
        first = ("root", "fillet", "involute", "chamfer", "tip").index(name)
        return slice(ends[first], ends[first + 1] + 1)

    def points(
        self,
        # How many teeth, each from the middle of one space to the middle of the next; all if not
        # given, and the last point is then the first again.
        teeth: int | None = None,
    ) -> FloatArray:
        """Outline of the whole gear, or of some teeth side by side.

        x and y about the gear axis, counter-clockwise. The first tooth points along y. [m]
        """
        count = self.teeth if teeth is None else teeth
        if not 1 <= count <= self.teeth:
            raise ValueError(
                f"an outline of {count} teeth was requested of a gear with {self.teeth} teeth"
            )
        # Left of the centre line the same points come in reverse order, the one on it only once.
        one_radius = np.concatenate([self.radius, self.radius[-2::-1]])
        one_angle = np.concatenate([-self.half_angle, self.half_angle[-2::-1]])
        pitch = 2 * math.pi / self.teeth
        angle = (one_angle[:-1] + pitch * np.arange(count)[:, np.newaxis]).ravel()
        angle = np.append(angle, one_angle[-1] + pitch * (count - 1)) + math.pi / 2
        radius = np.append(np.tile(one_radius[:-1], count), one_radius[-1])
        xy = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
        if count == self.teeth:
            xy[-1] = xy[0]
        return xy


def form_radius(
    gear: Gear,
    tool: Tool | None = None,  # `default_tool` if not given.
) -> float:
    """Root form radius r_Ff, where the involute meets the fillet. Theory (G34).

    Without undercut this is the point that the last point of the tool flank generates: on the line
    of action, in closed form. With undercut it is where fillet and involute intersect; whether the
    undercut leaves the tooth on its root is not checked here.

    [m] Raises `ValueError` if the tool cannot generate this gear.
    """
    return _involute_start(gear, fit_tool(gear, default_tool(gear) if tool is None else tool))[0]


def tooth_outline(
    gear: Gear,
    tool: Tool | None = None,  # `default_tool` if not given.
    # Points on each section, both ends counted: evenly spaced on the arcs and along the fillet, by
    # roll angle on the involute. The chamfer, which is straight, has its two ends only.
    points: int = POINTS_PER_SECTION,
) -> ToothOutline:
    """Outline of a tooth of `gear` as cut by `tool`.

    Raises `ValueError` if no such outline exists, with the reason.
    """
    if points < 2:
        raise ValueError("a section of an outline needs at least two points")
    cut = fit_tool(gear, default_tool(gear) if tool is None else tool)
    start_radius, last_normal = _involute_start(gear, cut)

    root_end = math.pi / gear.teeth - cut.root_angle
    root_angle = _steps(math.pi / gear.teeth, root_end, points)
    fillet_radius, fillet_angle = _fillet(gear, cut, (start_radius, last_normal), points)
    if np.any(fillet_angle <= 0.0):
        raise ValueError(f"undercut severs the teeth of the {gear.name} from their root")
    involute_radius, involute_angle = _involute(gear, start_radius, points)
    chamfer_angle = np.full(1 if gear.tip_chamfer > 0.0 else 0, gear.tip_half_angle)
    tip_angle = _steps(gear.tip_half_angle, 0.0, points)

    angles = (root_angle, fillet_angle, involute_angle, chamfer_angle, tip_angle)
    # Every section leaves out its first point, the last one of the section before.
    half_angle = np.concatenate([[math.pi / gear.teeth], *angles])
    radius = np.concatenate(
        [
            np.full(1 + root_angle.size, gear.root_radius),
            fillet_radius,
            involute_radius,
            np.full(chamfer_angle.size + tip_angle.size, gear.tip_radius),
        ]
    )
    radius.flags.writeable = False
    half_angle.flags.writeable = False
    first, second, third, fourth = np.cumsum([section.size for section in angles[:4]]).tolist()
    return ToothOutline(
        teeth=gear.teeth,
        internal=gear.internal,
        radius=radius,
        half_angle=half_angle,
        joints=(first, second, third, fourth),
        form_radius=start_radius,
        undercut=cut.last_curvature < 0.0,
        fillet_tool_radius=cut.tool_radius,
    )


def _involute_start(gear: Gear, cut: Cut) -> tuple[float, float]:
    """Root form radius, and angle of the contact normal where the fillet ends. Theory (G34)."""
    if cut.last_curvature >= 0.0:
        radius, normal = math.hypot(gear.base_radius, cut.last_curvature), cut.last_normal
    else:
        radius, normal = _undercut_start(gear, cut)
    tip = gear.tip_form_radius
    if not (tip < radius if gear.internal else radius < tip):
        end = "tip chamfer" if gear.tip_chamfer > 0.0 else "tip circle"
        raise ValueError(f"the fillet of the {gear.name} leaves no involute up to the {end}")
    return radius, normal


def _undercut_start(gear: Gear, cut: Cut) -> tuple[float, float]:
    """Where the fillet crosses the involute: radius and angle of the contact normal."""

    def radius_at(normal: float) -> float:
        return float(cut.fillet(np.array([normal]))[0][0])

    def material(normal: float) -> float:
        """Angle from the involute to the fillet: negative where the fillet cuts into the tooth."""
        radius, angle = cut.fillet(np.array([normal]))
        return math.pi / gear.teeth - float(angle[0]) - gear.half_angle_at(float(radius[0]))

    # An undercut root lies inside the base circle, and there is no involute below that. Beyond the
    # crossing the fillet runs in the space, towards the far branch of the involute.
    at_base = zero_between(
        lambda normal: radius_at(normal) - gear.base_radius, 0.0, cut.last_normal
    )
    normal = zero_between(material, at_base, cut.last_normal)
    return max(gear.base_radius, radius_at(normal)), normal


def _fillet(
    gear: Gear, cut: Cut, end: tuple[float, float], points: int
) -> tuple[FloatArray, FloatArray]:
    """Radii and half angles of the fillet up to `_involute_start`, its first point left out."""
    start_radius, last_normal = end
    # Equal steps of the normal would crowd the points at the root: a finer curve tells the steps
    # of equal length, and the points are then computed there.
    fine = np.linspace(0.0, last_normal, 8 * points)
    radius, angle = cut.fillet(fine)
    length = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(radius * np.exp(1j * angle))))])
    if length[-1] <= 1e-12 * gear.root_radius:
        return np.empty(0), np.empty(0)
    radius, angle = cut.fillet(np.interp(np.linspace(0.0, length[-1], points)[1:], length, fine))
    half_angle = math.pi / gear.teeth - angle
    radius[-1] = start_radius
    half_angle[-1] = gear.half_angle_at(start_radius)
    return radius, half_angle


def _involute(gear: Gear, start_radius: float, points: int) -> tuple[FloatArray, FloatArray]:
    """Radii and half angles of the involute by even steps of roll angle, the first left out."""
    start, end = map(gear.roll_length_at, (start_radius, gear.tip_form_radius))
    curvature = _steps(start, end, points)
    half_angle = gear.half_angles_at(curvature)
    radius = np.hypot(gear.base_radius, curvature)
    radius[-1] = gear.tip_form_radius
    half_angle[-1] = gear.half_angle_at(gear.tip_form_radius)
    return radius, half_angle


def _steps(first: float, last: float, points: int) -> FloatArray:
    """Even steps from `first`, itself left out; none if both are the same."""
    return np.linspace(first, last, points)[1:] if first != last else np.empty(0)


# The tool that cuts a gear: as stated, or one that leaves the involute that the mate needs.

TOOL_HALVINGS = 30  # Halvings of the rounding of a tool until it is known: to a billionth.


@lru_cache(maxsize=64)
def longest_involute(gear: Gear, rounding: float | None) -> float:
    """Radius at which the involute of `gear` ends towards its root, as long as a tool leaves it.

    That is the tool of the stated tip rounding, or else one with sharp corners. If these undercut
    the tooth, it is the rack with just the rounding that lets the involute begin at the base
    circle; if they cut away the tips of a ring, the default shaper cutter. Raises `ValueError` if
    no tool generates the tooth.
    """
    stated = None if rounding is None else replace(default_tool(gear), tip_radius=rounding)
    if not gear.internal:
        kindest = _kindest_rack(gear)
        tool = kindest if stated is None else stated
        if kindest.tip_radius > 0:
            tooth_outline(gear, tool, points=8)  # raises if undercut severs the teeth
        return form_radius(gear, tool)
    if stated is not None:
        return form_radius(gear, stated)
    shaper = default_tool(gear)
    try:
        return form_radius(gear, replace(shaper, tip_radius=0.0))
    except ValueError:
        return form_radius(gear, shaper)


@lru_cache(maxsize=64)
def cutting_tool(gear: Gear, rounding: float | None) -> Tool:
    """The tool that leaves the root fillet: as stated, or the default one if it cuts the tooth.

    If that one does not, it is the tool that leaves the longest involute. Raises `ValueError` if no
    tool generates the tooth.
    """
    tool = default_tool(gear)
    if rounding is not None:
        return replace(tool, tip_radius=rounding)
    try:
        tooth_outline(gear, tool)
    except ValueError:
        if gear.internal:
            raise
        return _kindest_rack(gear)
    return tool


def _kindest_rack(gear: Gear) -> RackTool:
    """With the rounding that keeps it from undercutting; with sharp corners if they do not."""
    cosine = math.cos(gear.rack.transverse_pressure_angle)
    # how far sharp corners reach beyond the start of the involute
    undercut = max(0.0, gear.reference_radius * cosine**2 - gear.root_radius)
    return RackTool(undercut / (1 - math.sin(gear.rack.normal_pressure_angle)))


@lru_cache(maxsize=256)
def fitted_tool(
    gear: Gear,
    rounding: float | None,  # Rounding of the tip of the tool, as stated; None if it is not. [m]
    needed: float,  # Radius to which the involute must reach towards the root. [m]
) -> Tool:
    """`cutting_tool`, its rounding reduced where it would take away involute that the mate needs.

    A stated rounding is kept. Raises `ValueError` if no tool generates the tooth.
    """
    usual = cutting_tool(gear, rounding)

    def suits(tip_radius: float) -> bool:
        try:
            reached = form_radius(gear, replace(usual, tip_radius=tip_radius))
        except ValueError:
            return False
        return gear.side * (reached - needed) <= 0

    low = 0.0 if gear.internal else _kindest_rack(gear).tip_radius
    high = usual.tip_radius
    if rounding is not None or suits(high) or not suits(low):
        return usual
    for _ in range(TOOL_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if suits(middle) else (low, middle)
    return replace(usual, tip_radius=low)
