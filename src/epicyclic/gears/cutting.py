"""Tooth outlines with the fillet that the generating tool leaves, and the tool of a gear."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from epicyclic.gears.gear import Gear
from epicyclic.gears.generation import (
    Cut,
    RackTool,
    ShaperTool,
    Tool,
    default_tool,
    fit_tool,
    zero_between,
)
from epicyclic.gears.mesh import Mesh

# Transverse tooth outlines with the root fillet that a generating tool leaves.
#
# Angles in radians, lengths in metres.


Floats = NDArray[np.float64]

POINTS_PER_SECTION = 32
"""Points on each section of an outline: chords leave the curve by 0.001 m_t at most, about."""


@dataclass(frozen=True, slots=True, eq=False)
class ToothOutline:
    """Right-hand half of one tooth, from the middle of the space to the middle of the tooth."""

    teeth: int  # Number of teeth of the gear.
    internal: bool  # True for a ring gear.
    # Radius of each point, from root to tip: rising for external gears, falling for internal ones.
    # Read-only. [m]
    radius: Floats
    # Angle of each point from the centre line of the tooth, from pi/z to zero. Read-only. [rad]
    half_angle: Floats
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
    ) -> Floats:
        """Outline of the whole gear, or of some teeth side by side.

        x and y about the gear axis, counter-clockwise. The first tooth points along y. [m]
        """
        count = self.teeth if teeth is None else teeth
        if not 1 <= count <= self.teeth:
            raise ValueError(f"an outline of {count} teeth of a gear with {self.teeth} teeth")
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
    cut = fit_tool(gear, default_tool(gear) if tool is None else tool)
    return _involute_start(gear, cut)[0]


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
    """Root form radius, and the angle of the contact normal where the fillet ends there.

    Theory (G34).
    """
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


def _fillet(gear: Gear, cut: Cut, end: tuple[float, float], points: int) -> tuple[Floats, Floats]:
    """Radii and half angles of the fillet up to `_involute_start`, its first point left out."""
    start_radius, last_normal = end
    # Equal steps of the normal would crowd the points at the root: a finer curve tells the steps
    # of equal length, and the points are then computed there.
    fine = np.linspace(0.0, last_normal, 8 * points)
    radius, angle = cut.fillet(fine)
    chords = np.abs(np.diff(radius * np.exp(1j * angle)))
    length = np.concatenate([[0.0], np.cumsum(chords)])
    if length[-1] <= 1e-12 * gear.root_radius:
        return np.empty(0), np.empty(0)
    normal = np.interp(np.linspace(0.0, length[-1], points)[1:], length, fine)
    radius, angle = cut.fillet(normal)
    half_angle = math.pi / gear.teeth - angle
    radius[-1] = start_radius
    half_angle[-1] = gear.half_angle_at(start_radius)
    return radius, half_angle


def _involute(gear: Gear, start_radius: float, points: int) -> tuple[Floats, Floats]:
    """Radii and half angles of the involute by even steps of roll angle, the first left out."""
    base = gear.base_radius
    start = math.sqrt(max(0.0, start_radius**2 - base**2))
    curvature = _steps(start, gear.tip_form_involute_length, points)
    half_angle = gear.half_angles_at(curvature)
    radius = np.hypot(base, curvature)
    radius[-1] = gear.tip_form_radius
    half_angle[-1] = gear.half_angle_at(gear.tip_form_radius)
    return radius, half_angle


def _steps(first: float, last: float, points: int) -> Floats:
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
    stated = stated_tool(gear, rounding)
    if not gear.internal:
        tool = _kindest_rack(gear) if stated is None else stated
        if _sharp_undercut(gear) > 0:
            tooth_outline(gear, tool, points=8)  # raises if undercut severs the teeth
        return form_radius(gear, tool)
    if stated is not None:
        return form_radius(gear, stated)
    shaper = default_tool(gear)
    assert isinstance(shaper, ShaperTool)
    try:
        return form_radius(gear, ShaperTool(shaper.teeth, 0.0))
    except ValueError:
        return form_radius(gear, shaper)


def stated_tool(gear: Gear, rounding: float | None) -> Tool | None:
    """The tool that cuts `gear` with a stated tip `rounding`; None if none is stated.

    Raises `ValueError` if no default shaper cutter generates a ring.
    """
    if rounding is None:
        return None
    if not gear.internal:
        return RackTool(rounding)
    shaper = default_tool(gear)
    assert isinstance(shaper, ShaperTool)
    return ShaperTool(shaper.teeth, rounding)


def cutting_tool(gear: Gear, rounding: float | None) -> Tool:
    """The tool that leaves the root fillet: as stated, or the default one if it cuts the tooth.

    If that one does not, it is the tool that leaves the longest involute. Raises `ValueError` if no
    tool generates the tooth.
    """
    stated = stated_tool(gear, rounding)
    if stated is not None:
        return stated
    tool = default_tool(gear)
    try:
        tooth_outline(gear, tool)
    except ValueError:
        if gear.internal:
            raise
        return _kindest_rack(gear)
    return tool


def _kindest_rack(gear: Gear) -> RackTool:
    sine = math.sin(gear.rack.normal_pressure_angle)
    return RackTool(max(0.0, _sharp_undercut(gear)) / (1 - sine))


def _sharp_undercut(gear: Gear) -> float:
    """How far a rack with sharp corners reaches beyond the start of the involute. [m]

    Negative if it does not reach that far: no undercut.
    """
    cosine = math.cos(gear.rack.transverse_pressure_angle)
    return gear.reference_radius * cosine**2 - gear.root_radius


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
    outward = -1 if gear.internal else 1

    def suits(tip_radius: float) -> bool:
        try:
            reached = form_radius(gear, replace(usual, tip_radius=tip_radius))
        except ValueError:
            return False
        return outward * (reached - needed) <= 0

    low = 0.0 if gear.internal else _kindest_rack(gear).tip_radius
    high = usual.tip_radius
    if rounding is not None or suits(high) or not suits(low):
        return usual
    for _ in range(TOOL_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if suits(middle) else (low, middle)
    return replace(usual, tip_radius=low)


def mated_tools(mesh: Mesh, roundings: tuple[float | None, float | None]) -> tuple[Tool, Tool]:
    """The tools that cut both gears of a mesh, each leaving the involute that the mate needs."""
    return (
        fitted_tool(mesh.gear1, roundings[0], mesh.radius1_at_start),
        fitted_tool(mesh.gear2, roundings[1], mesh.radius2_at_end),
    )
