"""The mesh of two gears: printed values, textbook identities, interference seen on the outlines."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from epicyclic.gears.cutting import tooth_outline
from epicyclic.gears.gear import Gear
from epicyclic.gears.mesh import Mesh

ROUNDING = 1e-12  # relative; a few roundings of doubles

PAIRS = [
    pytest.param({"teeth1": 20, "teeth2": 41}, id="spur"),
    pytest.param({"teeth1": 25, "teeth2": 25, "beta": 20.0}, id="helical, unity ratio"),
    pytest.param({"teeth1": 18, "teeth2": 57, "x1": 0.4, "x2": -0.1, "beta": 10.0}, id="shifted"),
    pytest.param({"teeth1": 24, "teeth2": 90, "internal": True}, id="internal"),
    pytest.param(
        {"teeth1": 30, "teeth2": 85, "internal": True, "x1": 0.3, "x2": -0.3, "beta": 15.0},
        id="internal, helical, shifted",
    ),
]


@pytest.fixture(params=PAIRS)
def mesh(request, make_mesh):
    return make_mesh(**request.param)


def test_meshes_of_the_test_article(talbot_meshes):
    # worked out separately (own computation from the printed dimensions), to half a unit of the
    # last digit given.
    for item in talbot_meshes:
        assert math.degrees(item.operating_pressure_angle) == pytest.approx(23.011, abs=0.5e-3)
        assert item.overlap_ratio == pytest.approx(0.973, abs=0.5e-3)
        assert item.face_width * 1e3 == pytest.approx(24.4, rel=ROUNDING)
    sun_mesh, ring_mesh = talbot_meshes
    assert sun_mesh.tip_contact_ratios[0] == pytest.approx(0.7515, abs=0.5e-4)
    assert sun_mesh.tip_contact_ratios[1] == pytest.approx(0.6127, abs=0.5e-4)
    assert sun_mesh.transverse_contact_ratio == pytest.approx(1.3643, abs=0.5e-4)
    assert ring_mesh.tip_contact_ratios[0] == pytest.approx(0.6127, abs=0.5e-4)
    assert ring_mesh.tip_contact_ratios[1] == pytest.approx(0.7541, abs=0.5e-4)
    assert ring_mesh.transverse_contact_ratio == pytest.approx(1.3669, abs=0.5e-4)


def test_fzg_gears_of_type_c(make_gear):
    # FZG test gears, type C (ISO 14635): m 4.5 mm, z 16/24, x 0.1817/0.1715, a 91.5 mm, free of
    # backlash by calculation; tip diameters 82.46 and 118.36 mm.
    def gear(teeth, x, diameter):
        return replace(make_gear(teeth, x, module=4.5e-3), tip_radius=diameter / 2e3)

    mesh = Mesh("mesh", gear(16, 0.1817, 82.46), gear(24, 0.1715, 118.36), 91.5e-3)
    assert math.degrees(mesh.operating_pressure_angle) == pytest.approx(22.44, abs=0.5e-2)
    # x is rounded to 4 decimals: 0.5e-4 on each moves both flanks by 2 x m tan(alpha) in all
    assert mesh.backlash == pytest.approx(0.0, abs=2 * 1e-4 * 4.5e-3 * math.tan(math.radians(20)))
    assert mesh.operating_radius1 == pytest.approx(36.6e-3, rel=ROUNDING)
    assert mesh.operating_radius2 == pytest.approx(54.9e-3, rel=ROUNDING)


def test_contact_ratio_is_that_of_the_textbook(mesh):
    one, two = mesh.gear1, mesh.gear2
    sign = -1 if two.internal else 1
    # ISO 21771: length of the path of contact from the tip circles and the centre distance
    path = (
        math.sqrt(one.tip_radius**2 - one.base_radius**2)
        + sign * math.sqrt(two.tip_radius**2 - two.base_radius**2)
        - sign * mesh.center_distance * math.sin(mesh.operating_pressure_angle)
    )
    ratio = path / one.rack.transverse_base_pitch
    assert mesh.transverse_contact_ratio == pytest.approx(ratio, rel=1e-10)
    assert mesh.path_end - mesh.path_start == pytest.approx(path, rel=1e-10)


def test_normals_meet_at_the_pitch_point(mesh):
    # There both members have the same speed: curvatures in the ratio of the base radii.
    curvature2 = mesh.curvature2(mesh.pitch_point)
    assert curvature2 / mesh.pitch_point == pytest.approx(mesh.ratio, rel=1e-11)
    radius1 = math.hypot(mesh.gear1.base_radius, mesh.pitch_point)
    assert radius1 == pytest.approx(mesh.operating_radius1, rel=ROUNDING)
    sign = -1 if mesh.internal else 1
    together = mesh.operating_radius2 + sign * mesh.operating_radius1
    assert together == pytest.approx(mesh.center_distance, rel=ROUNDING)


def test_every_point_of_the_path_lies_on_both_flanks(mesh):
    """Point by point in the plane: gear 1 at the origin, the pitch point above it."""
    alpha = mesh.operating_pressure_angle
    second = -mesh.center_distance if mesh.internal else mesh.center_distance
    for share in (0.0, 0.3, 1.0):
        curvature = mesh.path_start + share * (mesh.path_end - mesh.path_start)
        # the line of action touches base circle 1 at the angle alpha_wt from the line of centres
        foot = np.array([-math.sin(alpha), math.cos(alpha)]) * mesh.gear1.base_radius
        point = foot + curvature * np.array([math.cos(alpha), math.sin(alpha)])
        from_second = math.hypot(point[0], point[1] - second)
        expected = math.hypot(mesh.gear2.base_radius, mesh.curvature2(curvature))
        assert from_second == pytest.approx(expected, rel=ROUNDING)
    start = math.hypot(mesh.gear2.base_radius, mesh.curvature2(mesh.path_start))
    assert start == pytest.approx(mesh.gear2.tip_radius, rel=ROUNDING)
    assert mesh.inner_radii[0] == pytest.approx(
        math.hypot(mesh.gear1.base_radius, mesh.path_start), rel=ROUNDING
    )
    assert mesh.inner_radii[1] == pytest.approx(
        math.hypot(mesh.gear2.base_radius, mesh.curvature2(mesh.path_end)), rel=ROUNDING
    )


@pytest.mark.parametrize("internal", [False, True])
@pytest.mark.parametrize(("x1", "x2"), [(0.0, 0.0), (0.5, 0.2), (0.3, -0.3), (-0.2, 0.1)])
@pytest.mark.parametrize("beta", [0.0, 20.0])
def test_profile_shifts_close_the_backlash_at_the_standard_centre_distance(
    make_mesh, internal, x1, x2, beta
):
    z1, z2 = 25, 80
    at_reference = make_mesh(z1, z2, internal=internal, x1=x1, x2=x2, beta=beta)
    rack = at_reference.gear1.rack
    alpha_n, alpha_t = rack.normal_pressure_angle, rack.transverse_pressure_angle
    # ISO 21771: inv(alpha_wt) = inv(alpha_t) + 2 tan(alpha_n) (x1 + x2)/(z1 + z2), z2 < 0 if
    # internal: a ring of thicker teeth comes nearer, an external gear goes away.
    teeth = z1 - z2 if internal else z1 + z2
    target = math.tan(alpha_t) - alpha_t + 2 * math.tan(alpha_n) * (x1 + x2) / teeth
    alpha_w = brentq(lambda angle: math.tan(angle) - angle - target, 0.05, 1.2, xtol=1e-15)
    distance = at_reference.center_distance * math.cos(alpha_t) / math.cos(alpha_w)
    tight = replace(at_reference, center_distance=distance)
    assert tight.operating_pressure_angle == pytest.approx(alpha_w, rel=1e-10)
    # acos() of the base radii over the centre distance loses a few digits
    assert tight.backlash == pytest.approx(0.0, abs=1e-10 * distance)


def test_pulling_external_gears_apart_and_rings_together_opens_the_backlash(make_mesh):
    # to first order, both flanks of a wedge of pressure angle alpha: dj = 2 tan(alpha_w) da
    for internal, step in ((False, 1e-6), (True, -1e-6)):
        mesh = make_mesh(30, 90, internal=internal)
        moved = replace(mesh, center_distance=mesh.center_distance + step)
        expected = 2 * math.tan(mesh.operating_pressure_angle) * abs(step)
        assert moved.backlash - mesh.backlash == pytest.approx(expected, rel=1e-3)


def test_swapping_an_external_pair_swaps_the_figures(make_mesh):
    mesh = make_mesh(19, 43, x1=0.3, x2=0.1, beta=12.0, center_distance=64.5e-3)
    swapped = replace(mesh, gear1=mesh.gear2, gear2=mesh.gear1)
    assert swapped.ratio == pytest.approx(1 / mesh.ratio, rel=ROUNDING)
    assert swapped.tip_contact_ratios[0] == pytest.approx(mesh.tip_contact_ratios[1], rel=1e-10)
    assert swapped.tip_clearances[0] == pytest.approx(mesh.tip_clearances[1], rel=1e-10)
    assert swapped.backlash == pytest.approx(mesh.backlash, rel=1e-10)
    assert swapped.operating_helix_tangent == pytest.approx(
        mesh.operating_helix_tangent, rel=ROUNDING
    )


def test_clearances_of_standard_gears_are_a_quarter_module(make_mesh):
    for internal in (False, True):
        mesh = make_mesh(30, 90, internal=internal, module=2e-3)  # dedendum 1.25, addendum 1
        assert mesh.tip_clearances[0] == pytest.approx(0.5e-3, rel=1e-10)
        assert mesh.tip_clearances[1] == pytest.approx(0.5e-3, rel=1e-10)


def test_helix_at_the_operating_circles_keeps_the_lead(mesh):
    lead = 2 * math.pi * mesh.gear1.reference_radius
    if mesh.gear1.rack.helix_angle == 0.0:
        assert mesh.operating_helix_tangent == 0.0
        return
    lead /= math.tan(mesh.gear1.rack.helix_angle)
    expected = 2 * math.pi * mesh.operating_radius1 / lead
    assert mesh.operating_helix_tangent == pytest.approx(expected, rel=ROUNDING)


def test_axial_pitches_in_the_face_are_the_overlap_ratio(make_mesh):
    mesh = make_mesh(30, 50, beta=25.0, width=40e-3)
    axial_pitch = math.pi * 2e-3 / math.sin(math.radians(25))  # pi m_n/sin(beta)
    assert mesh.overlap_ratio == pytest.approx(40e-3 / axial_pitch, rel=ROUNDING)


# --- tip interference, on the outlines of the teeth -----------------------------------------------


def tooth_in_ring(mesh: Mesh, turn: float, radius, angle):
    """Points of the pinion tooth that stood on the line of centres, in polar coordinates of the
    ring, after the pinion has turned by `turn`. Angles from the line of centres at the start."""
    x = radius * np.sin(angle + turn)
    y = radius * np.cos(angle + turn) + mesh.center_distance
    return np.hypot(x, y), np.arctan2(x, y) - turn / mesh.ratio


def deepest_overlap(mesh: Mesh) -> float:
    """How deep a tooth of the pinion enters teeth of the ring over a whole passage. [m]

    Both gears are free of backlash, so that the teeth that mesh touch: an overlap of zero.
    """
    pinion, ring = tooth_outline(mesh.gear1, points=150), tooth_outline(mesh.gear2, points=150)
    radius = np.concatenate([pinion.radius, pinion.radius])
    angle = np.concatenate([pinion.half_angle, -pinion.half_angle])
    turn = np.linspace(0.0, 0.8 * math.pi, 800)[:, np.newaxis]
    at, around = tooth_in_ring(mesh, turn, radius, angle)
    pitch = 2 * math.pi / mesh.gear2.teeth
    from_tooth = np.abs(around % pitch - pitch / 2)  # a space of the ring stood at angle zero
    width = np.interp(at, ring.radius[::-1], ring.half_angle[::-1])
    gap = np.where(at > mesh.gear2.tip_radius, at * (from_tooth - width), math.inf)
    return float(-gap.min())


# Tooth numbers around the limit; short teeth, so that only the tips can collide.
NEAR_LIMIT = [
    (60, 65, 0.8, 20.0, True),
    (60, 66, 0.8, 20.0, True),
    (60, 67, 0.8, 20.0, False),
    (60, 68, 0.8, 20.0, False),
    (34, 37, 0.7, 25.0, True),
    (34, 38, 0.7, 25.0, False),
    (34, 39, 0.7, 25.0, False),
]


@pytest.mark.parametrize(("z1", "z2", "addendum", "alpha", "collide"), NEAR_LIMIT)
def test_tip_interference_is_where_outlines_overlap(make_mesh, z1, z2, addendum, alpha, collide):
    mesh = make_mesh(z1, z2, internal=True, addendum=addendum, alpha=alpha)
    # Chords of the outlines cut into the curves by less than 1e-8 m; collisions here are 40 um deep
    # or more.
    overlap = deepest_overlap(mesh)
    assert overlap > 30e-6 if collide else overlap < 0.1e-6
    assert bool(mesh.tip_passage < 0) is collide


@pytest.mark.parametrize(("z1", "z2", "addendum", "alpha", "collide"), NEAR_LIMIT)
def test_tip_passage_is_the_gap_between_the_tip_corners(
    make_mesh, z1, z2, addendum, alpha, collide
):
    mesh = make_mesh(z1, z2, internal=True, addendum=addendum, alpha=alpha)
    corner = mesh.gear1.half_angle_at(mesh.gear1.tip_radius)
    tip1, tip2 = mesh.gear1.tip_radius, mesh.gear2.tip_radius
    leaving = brentq(
        lambda turn: tooth_in_ring(mesh, turn, tip1, corner)[0] - tip2, 0.0, math.pi - corner
    )
    _, around = tooth_in_ring(mesh, leaving, tip1, corner)
    tooth = math.pi / z2  # the ring tooth beside the space where the pinion tooth stood
    gap = tooth - mesh.gear2.half_angle_at(tip2) - around
    # brentq() stops within 1e-12 rad
    assert mesh.tip_passage == pytest.approx(gap, abs=1e-10)
    assert bool(gap < 0) is collide


def test_tips_of_the_test_article_clear(talbot_meshes):
    sun_mesh, ring_mesh = talbot_meshes
    assert sun_mesh.tip_passage == math.inf
    assert 0 < ring_mesh.tip_passage < math.pi / 125


def test_tips_that_never_meet_have_infinite_clearance(make_mesh):
    mesh = make_mesh(20, 200, internal=True)
    inside = replace(
        mesh, gear1=replace(mesh.gear1, tip_radius=mesh.gear2.tip_radius - mesh.center_distance)
    )
    assert isinstance(inside.gear1, Gear)
    assert inside.tip_passage == math.inf
