"""Tooth outlines against the tools that cut them, simulated here without the formulas tested."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from epicyclic.gears.cutting import (
    RackTool,
    ShaperTool,
    Tool,
    default_tool,
    form_radius,
    tooth_outline,
)
from epicyclic.gears.gear import (
    BasicRack,
    Gear,
    half_angle_from_profile_shift,
    half_angle_from_thickness,
    involute,
)
from simulated_tools import MODULE, distance_to, gaps, shaper_polygon, turned

ROUNDING_ERROR = 1e-12  # a few hundred roundings of doubles, relative


def basic_rack(module=MODULE, alpha=20.0, beta=0.0):
    helix = math.radians(beta)
    alpha_t = math.atan(math.tan(math.radians(alpha)) / math.cos(helix))
    return BasicRack(module / math.cos(helix), alpha_t, helix)


def standard_gear(z, x=0.0, alpha=20.0, beta=0.0, internal=False, addendum=1.0, dedendum=1.25):
    """Proportions of ISO 53; the addendum of thick teeth is cut back before they are pointed."""
    rack = basic_rack(alpha=alpha, beta=beta)
    reference = z * rack.transverse_module / 2
    half_angle = half_angle_from_profile_shift(rack, z, x)
    if internal:
        root = reference + (dedendum - x) * MODULE
        tip = reference - (addendum + x) * MODULE
        return Gear("ring", rack, z, True, half_angle, tip, root, 0.02)
    root = reference - (dedendum - x) * MODULE
    tip = reference + (addendum + x) * MODULE
    gear = Gear("gear", rack, z, False, half_angle, tip, root, 0.02)
    while gear.thickness_at(gear.tip_radius) < 0.1 * MODULE:
        tip -= 0.02 * MODULE
        gear = Gear("gear", rack, z, False, half_angle, tip, root, 0.02)
    return gear


def measured_gear(name, rack, z, internal, tip, root, thickness, at):
    """Gear from diameters and thickness in millimetres."""
    half_angle = half_angle_from_thickness(rack, z, internal, thickness * 1e-3, at / 2e3)
    return Gear(name, rack, z, internal, half_angle, tip / 2e3, root / 2e3, 0.02)


TALBOT = basic_rack(1.813e-3, 22.5, 13.124)
PAIR = BasicRack(2e-3, math.radians(20), math.radians(15))
SUN = measured_gear("sun", TALBOT, 73, False, 139.23, 131.03, 2.873, 135.86)
PLANET = measured_gear("planet", TALBOT, 26, False, 51.33, 43.04, 2.8732, 48.39)
RING = measured_gear("ring", TALBOT, 125, True, 229.60, 237.23, 2.932, 232.64)
PINION = measured_gear("pinion", PAIR, 25, False, 54.0, 44.6, 3.0916, 50.0)
WHEEL = measured_gear("wheel", PAIR, 25, False, 54.0, 46.0, 3.0916, 50.0)
ARTICLES = [SUN, PLANET, RING, PINION, WHEEL]

EXTERNAL = [
    pytest.param(SUN, None, id="sun, fully round tool"),
    pytest.param(PLANET, RackTool(0.2 * MODULE), id="planet"),
    pytest.param(PINION, None, id="helical pinion"),
    pytest.param(standard_gear(40, beta=30.0), None, id="steep helix"),
    pytest.param(standard_gear(12), None, id="undercut"),
    pytest.param(standard_gear(12, beta=25.0), RackTool(0.1 * MODULE), id="undercut, helical"),
    pytest.param(standard_gear(9, x=-0.2), RackTool(0.0), id="deep undercut, sharp tool"),
    pytest.param(standard_gear(25, x=0.3), RackTool(0.0), id="sharp tool"),
    pytest.param(standard_gear(20, x=1.0), None, id="rounding centred above the pitch line"),
    pytest.param(standard_gear(20, x=1.35), None, id="root outside the reference circle"),
    pytest.param(standard_gear(200, x=-0.5), None, id="200 teeth"),
]

INTERNAL = [
    pytest.param(RING, None, id="ring"),
    pytest.param(RING, ShaperTool(60, 0.0), id="sharp tool"),
    pytest.param(RING, ShaperTool(30, 1.0 * MODULE, 0.2), id="fully round tool, shifted"),
    pytest.param(standard_gear(45, x=-0.2, internal=True), None, id="45 teeth"),
    pytest.param(standard_gear(200, x=0.4, internal=True), None, id="200 teeth"),
]


@pytest.mark.parametrize(("gear", "tool"), EXTERNAL + INTERNAL)
def test_tool_touches_outline_without_cutting_into_it(gear: Gear, tool: Tool | None) -> None:
    tool = tool or default_tool(gear)
    outline = tooth_outline(gear, tool, points=20)
    gap = gaps(gear, outline, tool)
    # Chords of the polygon leave the rounding of the tool, 0.5 m at most, by 2e-6 m; a sharp corner
    # passes by up to half a fine step of 6 m/r/20 000, times its distance of up to 4 m from the
    # pitch point: up to 1e-4 m for a small pinion.
    tolerance = (2e-4 if outline.fillet_tool_radius == 0.0 else 1e-5) * MODULE
    assert np.min(gap) > -tolerance
    assert np.max(np.abs(gap[: outline.joints[2] + 1])) < tolerance


def cuts_tip(ring, tool):
    """Whether the simulated cutter, leaving the space, reaches over the tip corner of the ring."""
    polygon, center_distance = shaper_polygon(ring, tool, tool.tip_radius)
    turn = np.linspace(0.5, 2.0, 3001)
    angle = math.pi / ring.teeth - ring.half_angle_at(ring.tip_radius)
    angle = angle + turn * tool.teeth / ring.teeth
    x, y = ring.tip_radius * np.sin(angle), ring.tip_radius * np.cos(angle) - center_distance
    # Chords and steps err by less than 1e-4 m; the cases below differ by more than 1e-3 m.
    return bool(np.min(distance_to(polygon, *turned(x, y, turn))) < -1e-4 * MODULE)


def is_refused_for_trimming(ring, tool):
    try:
        form_radius(ring, tool)
    except ValueError as error:
        return "cuts away the tips" in str(error)
    return False


@pytest.mark.parametrize("rounding", [0.0, 0.1 * MODULE])
def test_cutter_is_refused_from_the_tooth_count_that_trims_the_tips(rounding: float) -> None:
    tools = [ShaperTool(teeth, rounding) for teeth in range(114, 122)]
    trimmed = [cuts_tip(RING, tool) for tool in tools]
    assert [is_refused_for_trimming(RING, tool) for tool in tools] == trimmed
    assert trimmed[0] is not trimmed[-1]


def test_cutter_is_refused_from_the_tip_height_that_it_trims() -> None:
    # With these tips only the corner is in the way, by hundredths of a module or by nothing.
    tool = ShaperTool(119, 0.2 * MODULE)
    rings = [
        replace(RING, tip_radius=RING.tip_radius + cut * MODULE)
        for cut in (0.05, 0.06, 0.07, 0.08, 0.1, 0.11)
    ]
    trimmed = [cuts_tip(ring, tool) for ring in rings]
    assert [is_refused_for_trimming(ring, tool) for ring in rings] == trimmed
    assert trimmed[0] is not trimmed[-1]


@pytest.mark.parametrize("gear", [*ARTICLES, standard_gear(12), standard_gear(60, internal=True)])
def test_thickness_tip_and_root_are_met(gear: Gear) -> None:
    outline = tooth_outline(gear)
    root, tip = outline.radius[outline.section("root")], outline.radius[outline.section("tip")]
    assert root == pytest.approx(gear.root_radius, rel=ROUNDING_ERROR)
    assert tip == pytest.approx(gear.tip_radius, rel=ROUNDING_ERROR)
    assert outline.half_angle[0] == math.pi / gear.teeth
    assert outline.half_angle[-1] == 0.0
    involute_part = outline.section("involute")
    # The involute equation, solved for the thickness at the reference circle.
    side = -1 if gear.internal else 1
    cosine = gear.base_radius / outline.radius[involute_part]
    roll = np.sqrt(1 / cosine**2 - 1)
    inv = roll - np.arccos(np.minimum(1.0, cosine))
    change = side * (inv - involute(gear.rack.transverse_pressure_angle))
    expected = np.full(inv.shape, gear.thickness_half_angle)
    # Next to the base circle acos() loses half the digits of its argument, inv() fewer.
    assert outline.half_angle[involute_part] + change == pytest.approx(expected, rel=1e-11)


@pytest.mark.parametrize(("gear", "tool"), EXTERNAL + INTERNAL)
def test_sections_are_continuous_and_smooth(gear: Gear, tool: Tool | None) -> None:
    outline = tooth_outline(gear, tool, points=400)
    points = outline.points(1)[: outline.radius.size]
    steps = np.hypot(*np.diff(points, axis=0).T)
    assert np.min(steps) > 0.0
    # A gap would be one step as long as many; steps of equal roll angle are uneven up to threefold.
    assert np.max(steps) < 3 * abs(gear.tip_radius - gear.root_radius) / 399
    fillet_start, fillet_end, involute_end, _ = outline.joints
    # Second-order differences over a 400th of a fillet, whose curvature changes along it, err by
    # up to 1e-5 rad.
    smooth = 5e-5
    assert fillet_start == 0 or corner(points, fillet_start) < smooth
    if outline.undercut:
        assert corner(points, fillet_end) > 0.02
    else:
        assert corner(points, fillet_end) < smooth
    # The involute leaves the ray through its point by the pressure angle.
    leaving = math.pi / 2 - gear.pressure_angle_at(gear.tip_radius)
    assert corner(points, involute_end) == pytest.approx(leaving, abs=smooth)


def corner(points, at):
    """Angle between the tangents on both sides of a point, each from the three nearest points."""
    tangents = []
    for side in (-1, 1):
        here, near, far = points[at], points[at + side], points[at + 2 * side]
        first, second = np.hypot(*(near - here)), np.hypot(*(far - near))
        slope = (near - here) / first
        slope = slope + first / (first + second) * (slope - (far - near) / second)
        tangents.append(side * slope)
    (x1, y1), (x2, y2) = tangents
    return abs(math.atan2(x1 * y2 - y1 * x2, x1 * x2 + y1 * y2))


@pytest.mark.parametrize("alpha", [14.5, 20.0, 25.0])
@pytest.mark.parametrize(("x", "rounding"), [(0.0, 0.0), (0.0, 0.3), (-0.4, 0.34), (0.3, 0.2)])
@pytest.mark.parametrize("beta", [0.0, 20.0])
def test_undercut_begins_below_the_textbook_tooth_count(
    alpha: float, x: float, rounding: float, beta: float
) -> None:
    rack = basic_rack(alpha=alpha, beta=beta)
    flank = 1.2 - rounding * (1 - math.sin(rack.normal_pressure_angle))
    sine = math.sin(rack.transverse_pressure_angle)
    limit = 2 * (flank - x) * math.cos(rack.helix_angle) / sine**2
    for z in (math.floor(limit), math.ceil(limit)):
        gear = standard_gear(z, x, alpha, beta, dedendum=1.2)
        outline = tooth_outline(gear, RackTool(rounding * MODULE))
        # The rounding fits for every case, or the limit would be another one.
        assert outline.fillet_tool_radius == pytest.approx(rounding * MODULE)
        assert outline.undercut is (z < limit)


def test_undercut_grows_continuously_from_none() -> None:
    radii = []
    for dedendum in np.linspace(1.2, 1.3, 201):
        gear = standard_gear(20, dedendum=dedendum)
        radii.append(form_radius(gear, RackTool(0.05 * MODULE)) / gear.base_radius - 1)
    # Undercut begins at 1.20 m, where the form radius has come down to the base circle, and moves
    # it out again from there: a wrong crossing would show as a jump.
    assert 0.0 <= np.min(radii) < 1e-7
    assert np.max(np.abs(np.diff(radii))) < 3e-6
    assert radii[-1] > 1e-4


@pytest.mark.parametrize("alpha", [17.5, 20.0, 25.0])
@pytest.mark.parametrize("dedendum", [1.0, 1.25, 1.4])
def test_rounding_is_reduced_to_that_of_a_fully_round_rack(alpha: float, dedendum: float) -> None:
    # Full radius of a basic rack: (pi/4 - h_fP tan(alpha)) tan(45 deg + alpha/2) modules.
    angle = math.radians(alpha)
    full = (math.pi / 4 - dedendum * math.tan(angle)) * math.tan(math.pi / 4 + angle / 2) * MODULE
    gear = standard_gear(60, alpha=alpha, dedendum=dedendum)
    outline = tooth_outline(gear, RackTool(2 * full))
    assert outline.fillet_tool_radius == pytest.approx(full, rel=ROUNDING_ERROR)
    assert outline.joints[0] == 0
    assert outline.form_radius == pytest.approx(form_radius(gear, RackTool(full)))
    smaller = tooth_outline(gear, RackTool(0.99 * full))
    assert smaller.fillet_tool_radius == 0.99 * full
    assert smaller.joints[0] > 0


def test_rounding_is_reduced_to_that_of_a_fully_round_shaper_cutter() -> None:
    outline = tooth_outline(RING, ShaperTool(42, 1e-3))
    full = outline.fillet_tool_radius
    assert full < 1e-3
    assert outline.joints[0] == 0
    just_fits = tooth_outline(RING, ShaperTool(42, full * (1 - 1e-6)))
    assert just_fits.fillet_tool_radius == full * (1 - 1e-6)
    assert just_fits.joints[0] > 0
    # The root arc shrinks to nothing as the rounding grows to the full one.
    assert math.pi / RING.teeth - just_fits.half_angle[just_fits.joints[0]] < 1e-8


# Where contact ends towards the root. The fillets should end short of it, but not by much.
@pytest.mark.parametrize(
    ("gear", "active_diameter"), [(SUN, 133.43e-3), (PLANET, 45.83e-3), (RING, 235.31e-3)]
)
def test_fillets_of_the_test_article_clear_the_contact(gear: Gear, active_diameter: float) -> None:
    spare = (active_diameter / 2 - form_radius(gear)) * (-1 if gear.internal else 1)
    assert 0.0 < spare < 1e-3


@pytest.mark.parametrize("gear", ARTICLES + [p.values[0] for p in EXTERNAL + INTERNAL])
def test_form_radius_is_that_of_the_outline(gear: Gear) -> None:
    outline = tooth_outline(gear)
    assert form_radius(gear) == outline.form_radius
    assert outline.radius[outline.joints[1]] == outline.form_radius


@pytest.mark.parametrize("internal", [False, True])
def test_standard_gears_have_outlines(internal: bool) -> None:
    shifts = (-0.3, 0.0, 0.2) if internal else (-0.5, 0.0, 0.5, 1.0)
    # Rings of fewer teeth, or of thicker ones, would reach into their base circle.
    for z in (60, 61, 90, 125, 200) if internal else (12, 13, 17, 18, 25, 60, 200):
        for x in shifts:
            gear = standard_gear(z, x, internal=internal)
            outline = tooth_outline(gear)
            rising = np.diff(outline.radius) * (-1 if internal else 1)
            assert np.all(rising >= 0.0)
            assert np.all(np.diff(outline.half_angle) <= 0.0) or outline.undercut
            least = 2 * (1 - x) / math.sin(gear.rack.transverse_pressure_angle) ** 2
            assert outline.undercut is (not internal and z < least)


def test_default_tools() -> None:
    assert default_tool(PINION) == RackTool(0.38 * PINION.rack.normal_module)
    assert default_tool(RING) == ShaperTool(42, 0.2 * RING.rack.normal_module)
    # A third would be 13 teeth, whose base circle is too large for the tip of the ring.
    few = standard_gear(40, -0.2, internal=True)
    tool = default_tool(few)
    assert isinstance(tool, ShaperTool)
    with pytest.raises(ValueError, match="inside its base circle"):
        form_radius(few, ShaperTool(tool.teeth - 1, tool.tip_radius))


def test_points_of_the_whole_gear() -> None:
    outline = tooth_outline(PLANET)
    xy = outline.points()
    size = outline.radius.size
    assert xy.shape == (26 * (2 * size - 2) + 1, 2)
    assert np.array_equal(xy[0], xy[-1])
    tip = xy[size - 1]
    assert tip == pytest.approx([0.0, PLANET.tip_radius], abs=ROUNDING_ERROR)
    # One pitch further is the next tooth, counter-clockwise; mirrored in y, the same tooth.
    one = xy[: 2 * size - 1]
    angle = 2 * math.pi / 26
    following = np.column_stack(turned(*one.T, angle))
    assert np.allclose(xy[2 * size - 2 :][: 2 * size - 1], following, rtol=0.0, atol=1e-14)
    assert np.allclose(one[::-1] * [-1.0, 1.0], one, rtol=0.0, atol=1e-16)
    assert np.array_equal(outline.points(1), one)
    area = sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in pairwise(xy)) / 2
    assert math.pi * PLANET.root_radius**2 < area < math.pi * PLANET.tip_radius**2


def test_outline_cannot_be_written_to() -> None:
    outline = tooth_outline(SUN)
    for array in (outline.radius, outline.half_angle):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0


def test_points_argument_sets_the_points_of_each_section() -> None:
    outline = tooth_outline(PINION, points=7)
    for name in ("root", "fillet", "involute", "tip"):
        assert outline.radius[outline.section(name)].size == 7


def test_sharp_rack_on_the_pitch_line_leaves_no_fillet() -> None:
    gear = replace(PINION, root_radius=PINION.reference_radius)
    outline = tooth_outline(gear, RackTool(0.0))
    assert outline.form_radius == pytest.approx(gear.root_radius, rel=ROUNDING_ERROR)
    assert outline.joints[0] == outline.joints[1]


@pytest.mark.parametrize(
    ("gear", "tool", "message"),
    [
        (replace(SUN, root_radius=64e-3), None, "deeper than a pointed rack tooth"),
        (replace(SUN, tip_radius=73e-3), None, "pointed below the tip"),
        (replace(SUN, tip_radius=SUN.root_radius), None, "no tooth height"),
        (replace(SUN, root_radius=-1e-3), None, "no tooth height"),
        (replace(SUN, tip_radius=66e-3), None, "leaves no involute"),
        (standard_gear(7, -0.8, dedendum=1.5), RackTool(0.0), "severs the teeth of the gear"),
        (SUN, ShaperTool(20, 0.0), "needs a rack"),
        (RING, RackTool(0.0), "needs a shaper cutter"),
        (replace(RING, root_radius=RING.tip_radius), None, "no tooth height"),
        (replace(RING, root_radius=121e-3), ShaperTool(42, 0.0), "deeper than a pointed shaper"),
        (replace(RING, root_radius=115e-3), ShaperTool(8, 0.0), "root circle .* not generated"),
        (RING, ShaperTool(10, 0.0), "tip of the ring is not generated"),
        (RING, ShaperTool(125, 0.0), "does not fit into the ring"),
        (standard_gear(30, 0.5, internal=True), ShaperTool(10, 0.0), "too narrow"),
        (standard_gear(30, 0.5, internal=True), None, "no shaper cutter of 10 to 20 teeth"),
        (standard_gear(12, -0.5, internal=True), None, "too large for the ring of 12 teeth"),
    ],
)
def test_impossible_outlines_are_refused(gear: Gear, tool: Tool | None, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        tooth_outline(gear, tool)


def test_senseless_arguments_are_refused() -> None:
    for value in (-1e-3, math.nan, math.inf):
        with pytest.raises(ValueError, match="rounding of a tool tip"):
            RackTool(value)
        with pytest.raises(ValueError, match="rounding of a tool tip"):
            ShaperTool(20, value)
    with pytest.raises(ValueError, match="at least one tooth"):
        ShaperTool(0, 0.0)
    with pytest.raises(ValueError, match="at least two points"):
        tooth_outline(SUN, points=1)
    outline = tooth_outline(SUN)
    for teeth in (0, 74):
        with pytest.raises(ValueError, match="an outline of"):
            outline.points(teeth)


@pytest.mark.parametrize("gear", [standard_gear(30), standard_gear(60, internal=True)])
def test_chamfer_ends_the_involute_and_leaves_the_rest(gear: Gear) -> None:
    height = 0.1 * MODULE
    sharp, broken = tooth_outline(gear), tooth_outline(replace(gear, tip_chamfer=height))
    assert sharp.joints[2] == sharp.joints[3]
    start, corner_at = broken.joints[2], broken.joints[3]
    assert corner_at == start + 1
    assert abs(broken.radius[start] - gear.tip_radius) == pytest.approx(height)
    assert broken.half_angle[start] == gear.half_angle_at(broken.radius[start])
    assert broken.radius[corner_at] == gear.tip_radius
    land = broken.half_angle[start] - height / gear.tip_radius
    assert broken.half_angle[corner_at] == pytest.approx(land, rel=ROUNDING_ERROR)
    # 45 degrees to the radius but for the turn of the radius along the chamfer
    points = broken.radius * np.exp(1j * (broken.half_angle - broken.half_angle[start]))
    chamfer = points[corner_at] - points[start]
    assert abs(chamfer.imag / chamfer.real) == pytest.approx(1.0, abs=height / gear.tip_radius)
    root_part = slice(0, broken.joints[1] + 1)
    assert np.array_equal(broken.radius[root_part], sharp.radius[root_part])
    assert np.array_equal(broken.half_angle[root_part], sharp.half_angle[root_part])
