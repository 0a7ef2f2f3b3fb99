"""Contact lines in the plane of action."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from contacts import MESHES, with_overlap_ratio
from epicyclic.gears.flanks import contact_lines

ROUNDING = 1e-12  # relative; sums of a few hundred doubles


@pytest.fixture(params=MESHES)
def mesh(request, make_mesh):
    return make_mesh(**request.param)


def base_helix(mesh):
    return mesh.gear1.rack.base_helix_angle


def plane_average(mesh, function):
    """Average over the mesh period of the integral of f(x) along all contact lines.

    The lines sweep the plane of action once in each period: the integral of f over its area, over
    pitch and cos(beta_b). f is x^k here, integrated by hand.
    """
    integral = function(mesh.path_end) - function(mesh.path_start)
    pitch = mesh.gear1.rack.transverse_base_pitch
    return mesh.face_width * integral / (pitch * math.cos(base_helix(mesh)))


@pytest.mark.parametrize(("positions", "segments"), [(4, 2), (20, 20), (37, 11)])
def test_mean_total_length_is_exact(mesh, positions, segments):
    lines = contact_lines(mesh, positions, segments)
    mean = float(lines.weight @ lines.length.sum(axis=(1, 2)))
    # eps_alpha b/cos(beta_b); between the positions where lines enter and leave the total length is
    # linear, so that the midpoint rule makes no error
    expected = mesh.transverse_contact_ratio * mesh.face_width / math.cos(base_helix(mesh))
    assert mean == pytest.approx(expected, rel=1e-11)
    assert lines.weight.sum() == pytest.approx(1.0, rel=ROUNDING)
    assert np.all(lines.weight > 0)
    assert np.all((lines.position > 0) & (lines.position < 1))


def test_lines_stay_in_the_plane_of_action(mesh):
    lines = contact_lines(mesh, 20, 20)
    loaded = lines.length > 0
    assert np.any(loaded)
    slack = 1e-12
    assert lines.curvature1[loaded].min() >= mesh.path_start - slack
    assert lines.curvature1[loaded].max() <= mesh.path_end + slack
    assert lines.face_position[loaded].min() > 0
    assert lines.face_position[loaded].max() < mesh.face_width
    # the two members' curvatures end on the line of action
    sign = -1 if mesh.internal else 1
    total = lines.curvature2[loaded] + sign * lines.curvature1[loaded]
    assert total == pytest.approx(np.full_like(total, mesh.line_of_action), rel=ROUNDING)


def test_lines_lean_by_the_base_helix_and_follow_at_the_base_pitch(mesh):
    lines = contact_lines(mesh, 20, 20)
    pitch = mesh.gear1.rack.transverse_base_pitch
    straight = lines.curvature1 + lines.face_position * math.tan(base_helix(mesh))
    start = mesh.path_start + lines.position * pitch
    for k in range(straight.shape[1]):
        expected = np.broadcast_to((start + k * pitch)[:, None], straight[:, k, :].shape)
        assert straight[:, k, :] == pytest.approx(expected, rel=1e-10)


def test_number_of_pairs_of_a_spur_mesh(make_mesh):
    mesh = make_mesh(20, 41)
    ratio = mesh.transverse_contact_ratio
    assert 1 < ratio < 2
    lines = contact_lines(mesh, 20, 4)
    pairs = lines.length.sum(axis=(1, 2)) / mesh.face_width
    assert set(np.round(pairs, 9)) == {1.0, 2.0}
    # two pairs for eps_alpha - 1 of the period
    assert lines.weight[pairs > 1.5].sum() == pytest.approx(ratio - 1, rel=1e-9)


@pytest.mark.parametrize("overlap", [1.0, 2.0])
@pytest.mark.parametrize("internal", [False, True])
def test_total_length_is_constant_for_integer_overlap_ratio(make_mesh, overlap, internal):
    mesh = with_overlap_ratio(make_mesh(30, 100, beta=20.0, internal=internal), overlap)
    assert mesh.overlap_ratio == pytest.approx(overlap, rel=ROUNDING)
    total = contact_lines(mesh, 30, 10).length.sum(axis=(1, 2))
    expected = mesh.transverse_contact_ratio * mesh.face_width / math.cos(base_helix(mesh))
    assert total == pytest.approx(np.full_like(total, expected), rel=1e-11)


def test_total_length_is_constant_for_integer_transverse_contact_ratio(make_mesh):
    mesh = make_mesh(60, 70, beta=12.0)
    # lengthen the path at the tip of member 1 until eps_alpha = 2
    path = 2 * mesh.gear1.rack.transverse_base_pitch + mesh.path_start
    tip = math.hypot(path, mesh.gear1.base_radius)
    mesh = replace(mesh, gear1=replace(mesh.gear1, tip_radius=tip))
    assert mesh.transverse_contact_ratio == pytest.approx(2.0, rel=1e-10)
    total = contact_lines(mesh, 30, 10).length.sum(axis=(1, 2))
    assert total == pytest.approx(np.full_like(total, total[0]), rel=1e-9)


def averages(mesh, sizes, power):
    """Errors of the average of x^power, x in base pitches from the start of the path."""
    pitch = mesh.gear1.rack.transverse_base_pitch
    exact = plane_average(mesh, lambda x: pitch / (power + 1) * (x / pitch) ** (power + 1))
    errors = []
    for positions, segments in sizes:
        lines = contact_lines(mesh, positions, segments)
        value = ((lines.curvature1 / pitch) ** power * lines.length).sum(axis=(1, 2))
        errors.append(abs(float(lines.weight @ value) / exact - 1))
    return errors


@pytest.mark.parametrize("power", [2, 5])
def test_averages_converge_with_second_order(mesh, power):
    sizes = (20, 40, 80, 160)
    errors = averages(mesh, [(n, n) for n in sizes], power)
    # On 20 positions the error of x^5 was 8e-4 or less; second order means that it stays below that
    # times (20/n)^2, here with a margin of 1.5.
    assert all(error < 1.2e-3 * (20 / n) ** 2 for error, n in zip(errors, sizes, strict=True))
    if 0 < mesh.overlap_ratio < 1 / sizes[-1] ** 0.5:
        return  # a part shorter than a position makes single orders erratic, around the same bound
    orders = [math.log2(a / b) for a, b in pairwise(errors)]
    # The parts between the corners are divided into whole numbers, so that halving is not exact:
    # single orders were 1.89 to 2.06, their mean over three halvings 1.97 to 2.02.
    assert np.mean(orders) == pytest.approx(2.0, abs=0.05)


def test_averages_of_a_spur_mesh_converge_with_second_order_in_the_positions_alone(make_mesh):
    mesh = make_mesh(20, 41)
    errors = averages(mesh, [(n, 2) for n in (20, 40, 80, 160)], 2)
    orders = [math.log2(a / b) for a, b in pairwise(errors)]
    assert np.mean(orders) == pytest.approx(2.0, abs=0.05)  # as above
    # and segments change nothing, for the lines lie across the path
    same = averages(mesh, [(40, 2), (40, 200)], 2)
    assert same[0] == pytest.approx(same[1], rel=1e-6)


def test_averages_converge_in_the_segments_alone(make_mesh):
    mesh = make_mesh(30, 50, beta=30.0, width=60e-3)
    pitch = mesh.gear1.rack.transverse_base_pitch

    def value(segments):
        lines = contact_lines(mesh, 20, segments)
        return float(
            lines.weight @ ((lines.curvature1 / pitch) ** 2 * lines.length).sum(axis=(1, 2))
        )

    fine = value(1000)
    errors = [abs(value(n) - fine) for n in (5, 10, 20)]
    # x^2 by the midpoint rule: the error is exactly h^2/12 of each line
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=1e-3)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=1e-2)


def test_swapped_members_see_the_mirrored_lines(make_mesh):
    mesh = make_mesh(20, 41, beta=18.0, x1=0.2, x2=-0.2)
    swapped = replace(mesh, gear1=mesh.gear2, gear2=mesh.gear1)
    one, two = contact_lines(mesh, 20, 20), contact_lines(swapped, 20, 20)

    def moments(lines, of, other):
        weight = lines.weight[:, None, None] * lines.length
        return [float((weight * of**a * other**b * 1e3 ** (a + b)).sum()) for a, b in POWERS]

    # the same points with the members exchanged, hence the same moments up to rounding
    assert moments(two, two.curvature2, two.curvature1) == pytest.approx(
        moments(one, one.curvature1, one.curvature2), rel=1e-10
    )


POWERS = [(0, 0), (1, 0), (0, 1), (3, 1), (2, 4)]


def test_more_lines_than_teeth_in_contact_have_no_length(make_mesh):
    lines = contact_lines(make_mesh(20, 41), 20, 4)
    empty = lines.length == 0
    assert np.any(empty)
    assert not np.any(empty.all(axis=(1, 2)))


def test_arrays_are_shared_and_read_only(make_mesh):
    mesh = make_mesh(20, 41)
    lines = contact_lines(mesh, 20, 4)
    assert contact_lines(mesh, 20, 4) is lines
    for array in (lines.length, lines.curvature1, lines.weight):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0
