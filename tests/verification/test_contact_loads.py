"""The loads between elastic bodies that touch on lines: conditions of contact, closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from epicyclic.kernels.contact_load import (
    LEAST_SLOPE,
    LINEAR_SHARE,
    careful_solution,
    deflections,
    from_nearest,
    local_law,
    solve_contact_loads,
)
from reference.mesh_stiffness import face_load_factor


def solve(
    force, compliance, length, local_a, local_b, *, separation=None, coupling=None, start=None
):
    """The contact problem with the local law given by two numbers."""
    lines = len(length)
    teeth, nearest, whole = from_nearest(
        (
            compliance,
            np.zeros((lines, lines)) if coupling is None else coupling,
            np.zeros_like(length) if separation is None else separation,
            length,
            np.full_like(length, local_a),
            local_b,
        )
    )
    forces, approach, *found, _ = solve_contact_loads(
        force,
        teeth,
        LINEAR_SHARE * force / whole,
        length if start is None else start,
        np.nan,
        np.nan,
        np.zeros_like(length),
        1e-9,
        1000,
    )
    return forces, approach + nearest, *found


@pytest.mark.slow
def test_rigid_teeth_with_elastic_contact_load_all_lines_evenly():
    length = np.array([[1e-3] * 5, [2e-3] * 5, [0.0] * 5])
    forces, _, _, iterations = solve(9000.0, np.zeros((3, 5, 5)), length, 2e-11, 3e-12)
    assert iterations > 0
    np.testing.assert_allclose(forces[:2] / length[:2], 9000 / 15e-3, rtol=1e-9)
    assert not forces[2].any()


def test_contact_opens_where_teeth_cannot_follow():
    """A coupling that lifts the far segment: it carries nothing and does not interpenetrate."""
    coupling = 1e-8 * np.array([[4.0, -1.0, 8.0], [-1.0, 3.0, 0.0], [8.0, 0.0, 40.0]])
    forces, approach, _, iterations = solve(
        100.0, coupling[None], np.full((1, 3), 1e-3), 1e-12, 1e-15
    )
    assert iterations > 0
    assert forces[0, 2] == 0.0
    assert (coupling @ forces[0])[2] >= approach
    assert forces.sum() == pytest.approx(100.0, rel=1e-12)


def springs(force, wedge, segments=400):
    """One line of independent springs, 40 mm long, under a wedge-shaped gap."""
    length = np.full((1, segments), 40e-3 / segments)
    gap = wedge * (np.arange(segments) + 0.5)[None] / segments
    forces, approach, _, iterations = solve(
        force, np.zeros((1, segments, segments)), length, 2e-11, 1e-25, separation=gap
    )
    assert iterations > 0
    return forces[0] / length[0], approach


@pytest.mark.parametrize("wedge", [1e-6, 5e-6, 20e-6, 100e-6])
def test_misaligned_springs_have_the_load_factor_of_iso_6336(wedge):
    """K_Hbeta of independent springs, with contact over the whole face and over part of it."""
    stiffness, mean = 1 / 2e-11, 100e3
    load, approach = springs(mean * 40e-3, wedge)
    ratio = wedge * stiffness / mean
    expected = face_load_factor(wedge, stiffness, mean)
    # the first segment's middle is half a segment from the end; partial contact ends in a segment
    assert load.max() / mean == pytest.approx(expected, rel=1e-2)
    assert approach == pytest.approx(expected * mean / stiffness, rel=1e-2)
    assert (load > 0).mean() == pytest.approx(min(1.0, math.sqrt(2 / ratio)), abs=5e-3)


def random_problem(rng, kind):
    """Compliances of the size of gear teeth; loads over 11 and gaps over 6 orders of magnitude."""
    lines, n = 3, 20
    y = np.arange(n)
    compliance = np.empty((lines, n, n))
    for line in range(lines):
        shape = np.exp(-np.abs(y[:, None] - y) / rng.uniform(1, 15))
        compliance[line] = rng.uniform(0.3, 2) * 3e-9 * shape
    if kind % 3 == 0:  # coupling of either sign
        lever = rng.normal(size=(n, n))
        compliance += 3e-10 * lever @ lever.T / math.sqrt(n)
    rim = rng.normal(size=(lines, lines))
    length = np.full((lines, n), 1e-3)
    if kind % 5 == 0:
        length[2] = 0.0
    gap = 10 ** rng.uniform(-8, -2) * rng.uniform(-1, 1, size=(lines, n))
    if kind % 2:
        gap = np.cumsum(gap, axis=1) / 5
    return {
        "force": 10 ** rng.uniform(-3, 8),
        "compliance": compliance,
        "length": length,
        "local_a": rng.uniform(5e-11, 7e-11),
        "local_b": 5.6e-12,
        "separation": gap,
        "coupling": rim @ rim.T * 1e-10 * (kind % 4),
    }


def teeth(problem, separation):
    """The teeth of a problem with another gap of their unloaded flanks."""
    length, a, b = problem["length"], problem["local_a"], problem["local_b"]
    return (
        problem["compliance"], problem["coupling"], separation, length, np.full_like(length, a), b
    )  # fmt: skip


def test_any_load_and_any_gap_are_solved_and_the_solution_fulfils_the_conditions():
    rng = np.random.default_rng(3)
    for kind in range(200):
        problem = random_problem(rng, kind)
        forces, approach, stiffness, iterations = solve(**problem)
        assert iterations > 0
        length, force = problem["length"], problem["force"]
        closed, _ = deflections(
            forces, teeth(problem, problem["separation"]), LINEAR_SHARE * force / length.sum()
        )
        used = length > 0
        scale = approach - problem["separation"][used].min()
        gap = (closed - approach)[used] / scale
        carrying = forces[used] > 0
        assert np.abs(gap[carrying]).max() < 1e-8  # ten times the tolerance: other rounding
        assert gap.min() > -1e-8
        assert forces.min() >= 0
        assert not forces[~used].any()
        assert forces.sum() == pytest.approx(force, rel=1e-8)
        # of the force against the approach: positive, and below that of the local law alone
        assert 0 < stiffness < (length[used] / (LEAST_SLOPE * problem["local_b"])).sum()


def test_the_careful_method_finds_the_same_solution():
    rng = np.random.default_rng(4)
    for kind in range(40):
        problem = random_problem(rng, kind)
        forces, approach, _, _ = solve(**problem)
        length, gap = problem["length"], problem["separation"]
        nearest = gap[length > 0].min()
        careful, same_approach, _, iterations, _ = careful_solution(
            problem["force"],
            teeth(problem, gap - nearest),
            LINEAR_SHARE * problem["force"] / length.sum(),
            1e-9,
            1000,
        )
        assert iterations > 0
        # both are solutions to 1e-9 of the approach
        assert np.abs(careful - forces).max() < 1e-7 * problem["force"]
        assert same_approach + nearest == pytest.approx(approach, rel=1e-8)


def test_a_start_next_to_the_solution_saves_steps_and_changes_nothing():
    rng = np.random.default_rng(5)
    fewer = []
    for kind in range(60):
        problem = random_problem(rng, kind)
        near, *_ = solve(**(problem | {"force": 0.99 * problem["force"]}))
        forces, approach, stiffness, iterations = solve(**problem)
        again, same_approach, same_stiffness, steps = solve(**problem, start=near)
        assert np.abs(again - forces).max() < 1e-7 * problem["force"]
        assert same_approach == pytest.approx(approach, rel=1e-8)
        assert same_stiffness == pytest.approx(stiffness, rel=1e-3)  # of the step before the last
        assert steps > 0
        fewer.append(iterations - steps)
    assert min(fewer) >= 0
    assert np.median(fewer) >= 2


def test_any_start_leads_to_the_solution():
    rng = np.random.default_rng(6)
    for kind in range(60):
        problem = random_problem(rng, kind)
        forces, *_ = solve(**problem)
        start = np.zeros_like(forces)
        start[0, rng.integers(20)] = 7.0
        found, _, _, steps = solve(**problem, start=start)
        assert steps > 0
        assert np.abs(found - forces).max() < 1e-7 * problem["force"]


def test_the_local_law_rises_for_any_load_and_has_no_kink():
    a, b, floor = 6e-11, 5.6e-12, 1e2
    top = math.exp(2 * a / b - 2)
    q = np.concatenate([[-1e3, -1.0], np.geomspace(1e-3, 1e4 * top, 4000)])
    law = np.array([local_law(value, a, b, floor) for value in q])
    assert (np.diff(law[:, 0]) > 0).all()
    assert law[:, 1].min() == pytest.approx(LEAST_SLOPE * b, rel=1e-12)
    for joint in (0.0, floor, top):
        below, above = (
            local_law(joint * f - d, a, b, floor) for f, d in ((1 - 1e-9, 1e-9), (1 + 1e-9, -1e-9))
        )
        assert above == pytest.approx(below, rel=1e-6, abs=1e-17)
    slope = np.gradient(law[100:-100, 0], q[100:-100])
    np.testing.assert_allclose(slope, law[100:-100, 1], rtol=2e-2)  # differences, not the limit


def test_nan_is_no_solution():
    _, _, _, iterations = solve(
        100.0, np.full((1, 3, 3), np.nan), np.full((1, 3), 1e-3), 1e-11, 1e-12
    )
    assert iterations == -1
