"""One involute gear: printed dimensions, and identities that its formulas do not state."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from scipy.optimize import brentq

from epicyclic.gears.gear import (
    BasicRack,
    half_angle_from_profile_shift,
    half_angle_from_thickness,
    involute,
)

ROUNDING = 1e-12  # relative; a few roundings of doubles


@pytest.fixture(params=[(20.0, 0.0), (14.5, 0.0), (20.0, 25.0), (22.5, 13.124), (25.0, 40.0)])
def angles(request):
    """Normal pressure angle and helix angle in degrees."""
    return request.param


@pytest.mark.parametrize(
    ("degrees", "value"),
    # Tables of the involute function, as printed in every gear handbook; six decimals.
    [(14.5, 0.005545), (20.0, 0.014904), (22.5, 0.021514), (25.0, 0.029975), (30.0, 0.053751)],
)
def test_involute_function_is_that_of_the_tables(degrees, value):
    # half a unit of the last printed digit
    assert involute(math.radians(degrees)) == pytest.approx(value, abs=0.5e-6)


def test_base_circles_of_the_test_article(talbot_meshes):
    sun_mesh, ring_mesh = talbot_meshes
    gears = (sun_mesh.gear1, sun_mesh.gear2, ring_mesh.gear2)
    # worked out separately, computed there from the printed teeth, module and angles; all
    # comparisons to half a unit of the last digit given.
    for gear, radius in zip(gears, (62.529, 22.270, 107.069), strict=True):
        assert gear.base_radius * 1e3 == pytest.approx(radius, abs=0.5e-3)
    rack = sun_mesh.gear1.rack
    assert rack.transverse_module * 1e3 == pytest.approx(1.8616, abs=0.5e-4)
    assert math.degrees(rack.transverse_pressure_angle) == pytest.approx(23.041, abs=0.5e-3)
    assert math.degrees(rack.base_helix_angle) == pytest.approx(12.109, abs=0.5e-3)
    assert rack.transverse_base_pitch * 1e3 == pytest.approx(5.3819, abs=0.5e-4)


def test_normal_and_transverse_section_agree(make_gear, angles):
    alpha, beta = angles
    rack = make_gear(30, alpha=alpha, beta=beta, module=3e-3).rack
    assert rack.normal_module == pytest.approx(3e-3, rel=ROUNDING)
    assert math.degrees(rack.normal_pressure_angle) == pytest.approx(alpha, rel=ROUNDING)
    # Relations of the base helix angle that its own formula does not use (ISO 21771).
    sine_b = math.sin(math.radians(beta)) * math.cos(math.radians(alpha))
    assert math.sin(rack.base_helix_angle) == pytest.approx(sine_b, rel=ROUNDING)
    normal_base_pitch = math.pi * 3e-3 * math.cos(math.radians(alpha))
    base_pitch = normal_base_pitch / math.cos(rack.base_helix_angle)
    assert rack.transverse_base_pitch == pytest.approx(base_pitch, rel=ROUNDING)


def test_base_pitch_divides_the_base_circle(make_gear, angles):
    alpha, beta = angles
    for teeth in (7, 26, 125):
        gear = make_gear(teeth, alpha=alpha, beta=beta)
        circumference = 2 * math.pi * gear.base_radius
        assert teeth * gear.rack.transverse_base_pitch == pytest.approx(circumference, rel=ROUNDING)


def unwound_angle(base_radius, radius):
    """Polar angle of the end of a taut string unwound from the base circle, where it has `radius`.

    The string touches the circle at polar angle t and is as long as the arc unwound, r_b t.
    """
    roll = math.sqrt((radius / base_radius) ** 2 - 1)
    x = base_radius * (math.cos(roll) + roll * math.sin(roll))
    y = base_radius * (math.sin(roll) - roll * math.cos(roll))
    assert math.hypot(x, y) == pytest.approx(radius, rel=ROUNDING)
    return math.atan2(y, x)


@pytest.mark.parametrize("internal", [False, True])
def test_flank_is_the_path_of_an_unwound_string(make_gear, internal):
    gear = make_gear(40, 0.2, internal=internal)
    reference = unwound_angle(gear.base_radius, gear.reference_radius)
    for share in (1.001, 1.02, 1.05, 1.1):
        radius = gear.base_radius * share
        turned = unwound_angle(gear.base_radius, radius) - reference
        # teeth of external gears grow thinner outwards, those of rings thicker
        half_angle = gear.thickness_half_angle + (turned if internal else -turned)
        # acos() next to the base circle loses some digits of its argument
        assert gear.half_angle_at(radius) == pytest.approx(half_angle, rel=1e-10)


@pytest.mark.parametrize("internal", [False, True])
@pytest.mark.parametrize("share", [1.0, 1.03, 0.97])
def test_thickness_given_at_any_circle_is_met_there(make_gear, internal, share):
    gear = make_gear(60, 0.3, internal=internal)
    radius = share * gear.reference_radius
    thickness = gear.thickness_at(radius)
    half_angle = half_angle_from_thickness(gear.rack, 60, internal, thickness, radius)
    assert half_angle == pytest.approx(gear.thickness_half_angle, rel=ROUNDING)


def test_printed_thicknesses_of_the_test_article_are_met(talbot_meshes):
    sun_mesh, ring_mesh = talbot_meshes
    # Talbot (2012), Table 2.1: transverse tooth thickness at a diameter, mm; inputs of the case.
    for gear, thickness, diameter in (
        (sun_mesh.gear1, 2.873, 135.86),
        (sun_mesh.gear2, 2.8732, 48.39),
        (ring_mesh.gear2, 2.932, 232.64),
    ):
        assert gear.thickness_at(diameter / 2e3) == pytest.approx(thickness * 1e-3, rel=ROUNDING)


def test_external_tooth_fills_the_space_of_a_ring_of_the_same_involute(make_gear, angles):
    alpha, beta = angles
    external = make_gear(50, 0.4, alpha=alpha, beta=beta)
    ring = replace(
        external, internal=True, thickness_half_angle=math.pi / 50 - external.thickness_half_angle
    )
    for share in (0.98, 1.0, 1.04):
        radius = share * external.reference_radius
        pitch = 2 * math.pi * radius / 50
        together = external.thickness_at(radius) + ring.thickness_at(radius)
        assert together == pytest.approx(pitch, rel=ROUNDING)


@pytest.mark.parametrize("internal", [False, True])
def test_profile_shift_thickens_the_tooth_of_every_gear(make_gear, internal):
    pitch = math.pi * 2e-3
    for x in (-0.4, 0.0, 0.7):
        gear = make_gear(60, x, internal=internal, module=2e-3)
        # The rack reaches x m deeper or less deep; its flanks lean by alpha. Spur: s = m (pi/2 +
        # 2 x tan(alpha)), with the sign of x as in ISO 21771 for z2 < 0.
        expected = pitch / 2 + 2 * x * 2e-3 * math.tan(math.radians(20))
        assert gear.thickness_at(gear.reference_radius) == pytest.approx(expected, rel=ROUNDING)
        assert gear.profile_shift_coefficient == pytest.approx(x, abs=ROUNDING)


@pytest.mark.parametrize("x", [-0.3, 0.6])
def test_profile_shift_is_told_from_the_thickness(make_gear, angles, x):
    alpha, beta = angles
    for internal in (False, True):
        gear = make_gear(60, x, internal=internal, alpha=alpha, beta=beta)
        assert gear.profile_shift_coefficient == pytest.approx(x, rel=1e-11)


def test_profile_shift_of_helical_gears_counts_normal_modules():
    helix, alpha_n, module = math.radians(30), math.radians(20), 4e-3
    rack = BasicRack(
        module / math.cos(helix), math.atan(math.tan(alpha_n) / math.cos(helix)), helix
    )
    half_angle = half_angle_from_profile_shift(rack, 20, 0.5)
    # normal tooth thickness s_n = m_n (pi/2 + 2 x tan(alpha_n)), and s_t = s_n/cos(beta)
    normal_thickness = module * (math.pi / 2 + 2 * 0.5 * math.tan(alpha_n))
    diameter = 20 * module / math.cos(helix)
    assert diameter * half_angle == pytest.approx(normal_thickness / math.cos(helix), rel=ROUNDING)


def test_no_thickness_inside_the_base_circle(make_gear):
    gear = make_gear(30)
    with pytest.raises(ValueError, match="inside the base circle"):
        half_angle_from_thickness(gear.rack, 30, False, 3e-3, 0.999 * gear.base_radius)
    assert gear.pressure_angle_at(0.9 * gear.base_radius) == 0.0


def test_teeth_become_pointed_where_both_flanks_meet(make_gear):
    gear = make_gear(20)
    # Flanks meet where inv(alpha_a) = pi/(2 z) + inv(alpha), solved here for alpha_a.
    target = math.pi / 40 + involute(math.radians(20))
    angle = brentq(lambda value: math.tan(value) - value - target, 0.1, 1.0, xtol=1e-14)
    pointed = gear.base_radius / math.cos(angle)
    assert gear.thickness_at(pointed * (1 - 1e-9)) > 0 > gear.thickness_at(pointed * (1 + 1e-9))


def test_tip_curvature_is_the_tangent_from_the_tip_to_the_base_circle(make_gear):
    gear = make_gear(25, addendum=1.2)
    length = gear.roll_length_at(gear.tip_radius)
    assert math.hypot(length, gear.base_radius) == pytest.approx(gear.tip_radius, rel=ROUNDING)
    inside = replace(gear, tip_radius=0.9 * gear.base_radius)
    assert inside.roll_length_at(inside.tip_radius) == 0.0
