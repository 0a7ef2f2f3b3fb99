"""Deviations of flanks and the gap they leave."""

from __future__ import annotations

import math

import numpy as np
import pytest

from epicyclic.gears.flanks import (
    FlankDeviations,
    MicroGeometry,
    Relief,
    Topography,
    active_profile,
    contact_lines,
)

UM = 1e-6
KINDS = [
    pytest.param({"teeth1": 20, "teeth2": 41}, id="spur"),
    pytest.param({"teeth1": 24, "teeth2": 90, "internal": True, "beta": 20.0}, id="internal"),
]


@pytest.fixture(params=KINDS)
def mesh(request, make_mesh):
    return make_mesh(**request.param)


def along(mesh, member, flank, shares, y=0.0):
    """Deviations at shares of the active profile, from root to tip."""
    root, tip = active_profile(mesh, member)
    gear = (mesh.gear1, mesh.gear2)[member - 1]
    curvature = root + np.asarray(shares) * (tip - root)
    return flank.deviation(gear, (root, tip), curvature, np.full(len(shares), y))


@pytest.mark.parametrize("member", [1, 2])
def test_active_profile_ends_at_the_own_tip_and_where_the_mate_s_tip_touches(mesh, member):
    root, tip = active_profile(mesh, member)
    gear = (mesh.gear1, mesh.gear2)[member - 1]
    assert tip == pytest.approx(gear.roll_length_at(gear.tip_radius), rel=1e-12)
    radius = mesh.inner_radii[member - 1]
    assert math.hypot(gear.base_radius, root) == pytest.approx(radius, rel=1e-12)


@pytest.mark.parametrize("member", [1, 2])
@pytest.mark.parametrize(("shape", "middle"), [("linear", 5.0), ("parabolic", 2.5)])
def test_tip_relief_is_its_amount_at_the_tip_and_nothing_where_it_starts(
    mesh, member, shape, middle
):
    root, tip = active_profile(mesh, member)
    length = 0.4 * abs(tip - root)
    flank = MicroGeometry(tip_relief=Relief(10 * UM, length, shape))
    found = along(mesh, member, flank, [0.0, 0.5, 0.6, 0.8, 1.0])
    assert found == pytest.approx(np.array([0, 0, 0, middle, 10]) * UM, abs=1e-15)
    flank = MicroGeometry(root_relief=Relief(10 * UM, length, shape))
    found = along(mesh, member, flank, [0.0, 0.2, 0.4, 0.5, 1.0])
    assert found == pytest.approx(np.array([10, middle, 0, 0, 0]) * UM, abs=1e-15)


@pytest.mark.parametrize("member", [1, 2])
def test_profile_slope_and_crown(mesh, member):
    shares = [0.0, 0.25, 0.5, 1.0]
    slope = along(mesh, member, MicroGeometry(profile_slope=8 * UM), shares)
    assert slope == pytest.approx(np.array([0, 2, 4, 8]) * UM, abs=1e-15)
    crown = along(mesh, member, MicroGeometry(profile_crown=8 * UM), shares)
    assert crown == pytest.approx(np.array([8, 2, 0, 8]) * UM, abs=1e-15)


def test_lead_deviations_count_over_the_face_of_the_gear(make_gear):
    gear = make_gear(30, width=20e-3)
    y = np.array([0.0, 2.0, 5.0, 10.0, 18.0, 20.0]) * 1e-3
    rho = np.full(6, 10e-3)

    def deviation(**flank):
        return MicroGeometry(**flank).deviation(gear, (5e-3, 15e-3), rho, y) / UM

    assert deviation(lead_slope=10 * UM) == pytest.approx([0, 1, 2.5, 5, 9, 10])
    assert deviation(lead_crown=10 * UM) == pytest.approx([10, 6.4, 2.5, 0, 6.4, 10])
    relief = deviation(end_relief=Relief(10 * UM, 4e-3))
    assert relief == pytest.approx([10, 5, 0, 0, 5, 10])


def test_topography_is_interpolated_and_held_beyond_its_points(make_gear):
    gear = make_gear(30)
    table = Topography((6e-3, 8e-3), (0.0, 10e-3), ((0.0, 2 * UM), (4 * UM, 10 * UM)))
    flank = MicroGeometry(topography=table)
    rho = np.array([6e-3, 7e-3, 8e-3, 1e-3, 20e-3])
    y = np.array([5e-3, 5e-3, 10e-3, 0.0, 19e-3])
    found = flank.deviation(gear, (5e-3, 15e-3), rho, y) / UM
    assert found == pytest.approx([1, 4, 10, 0, 10])


def test_the_same_deviation_as_table_and_as_slope_leaves_the_same_gap(mesh):
    root, tip = active_profile(mesh, 2)
    ends = sorted([root, tip])
    values = [8 * UM * (end - root) / (tip - root) for end in ends]
    table = Topography(tuple(ends), (0.0, 1.0), tuple((value, value) for value in values))
    lines = contact_lines(mesh, 12, 9)
    slope = FlankDeviations(member2=MicroGeometry(profile_slope=8 * UM)).separation(mesh, lines)
    measured = FlankDeviations(member2=MicroGeometry(topography=table)).separation(mesh, lines)
    np.testing.assert_allclose(measured, slope, atol=1e-18)


def test_gap_is_along_the_normal_and_both_members_add_up(make_mesh):
    mesh = make_mesh(30, 50, beta=15.0)
    lines = contact_lines(mesh, 12, 9)
    flank = MicroGeometry(lead_slope=6 * UM)
    one = FlankDeviations(member1=flank).separation(mesh, lines)
    both = FlankDeviations(flank, flank).separation(mesh, lines)
    tilted = FlankDeviations(misalignment=6 * UM).separation(mesh, lines)
    expected = 6 * UM * lines.face_position / mesh.face_width
    cosine = math.cos(mesh.gear1.rack.base_helix_angle)
    np.testing.assert_allclose(one, expected * cosine, atol=1e-18)
    np.testing.assert_allclose(tilted, one, atol=1e-18)  # equal face widths
    np.testing.assert_allclose(both, 2 * one, atol=1e-18)


def test_a_wider_gear_reaches_beyond_the_common_face(make_gear, make_mesh):
    from dataclasses import replace

    mesh = make_mesh(30, 50, width=20e-3)
    wide = replace(mesh, gear2=replace(mesh.gear2, face_width=40e-3))
    lines = contact_lines(wide, 8, 5)
    gap = FlankDeviations(member2=MicroGeometry(lead_slope=8 * UM)).separation(wide, lines)
    # the common face lies in the middle of the wide gear: from 2 to 6 um
    assert gap[lines.length > 0].min() == pytest.approx(2.4 * UM)
    assert gap[lines.length > 0].max() == pytest.approx(5.6 * UM)
