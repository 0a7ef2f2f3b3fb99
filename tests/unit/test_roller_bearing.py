"""Load distribution of a roller bearing: equilibrium, closed forms, and robustness."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from epicyclic.arrays import of_points
from epicyclic.errors import ConvergenceError
from epicyclic.kernels.roller_bearing import solve_roller_loads
from epicyclic.losses import planet_bearing
from epicyclic.losses.planet_bearing import RollerBearing, roller_loads, roller_loads_next_to
from reference.roller_bearing import aligned_roller_loads, radial_load_integral

STEEL = 227.47e9
SOLVER = 1e-9  # residual force over load at which the iteration stops

# Table 3.3 of Talbot (2012), with the crown that the package assumes
TALBOT = RollerBearing(
    rows=2,
    rollers_per_row=16,
    roller_diameter=4.015e-3,
    roller_length=9.52e-3,
    inner_diameter=25.991e-3,
    diametral_clearance=4e-6,
    crown_drop=3e-6,
    crown_length_fraction=0.2,
    row_gap=0.0,
    roller_roughness=0.1e-6,
    race_roughness=0.1e-6,
    equivalent_modulus=STEEL,
    slices=20,
)
PLAIN = replace(TALBOT, rows=1, crown_drop=0.0)

BEARINGS = [
    pytest.param(TALBOT, id="test article"),
    pytest.param(replace(TALBOT, rows=1), id="single row"),
    pytest.param(replace(TALBOT, rollers_per_row=3), id="three rollers"),
    pytest.param(replace(TALBOT, rollers_per_row=4, rows=1), id="four rollers"),
    pytest.param(replace(TALBOT, diametral_clearance=0.0), id="no clearance"),
    pytest.param(replace(TALBOT, diametral_clearance=0.5e-3), id="huge clearance"),
    pytest.param(replace(TALBOT, crown_drop=0.0), id="no crown"),
    pytest.param(replace(TALBOT, crown_length_fraction=0.5, crown_drop=30e-6), id="barrel"),
    pytest.param(replace(TALBOT, row_gap=5e-3, rows=3), id="three rows, gaps"),
    pytest.param(replace(TALBOT, slices=3), id="three slices"),
]
LOADS = [
    pytest.param((9804.0, 0.0, 0.0, 55.3), id="as in the test article"),
    pytest.param((9804.0, 0.0, 0.0, 0.0), id="radial"),
    pytest.param((3000.0, -2000.0, 10.0, 25.0), id="oblique"),
    pytest.param((0.0, 0.0, 40.0, 0.0), id="moment only"),
    pytest.param((0.0, 0.0, -3.0, 4.0), id="oblique moment only"),
    pytest.param((1.0, 0.0, 0.0, 0.003), id="light"),
    pytest.param((1e7, 0.0, 0.0, 3e4), id="crushing"),
    pytest.param((500.0, 0.0, 0.0, 60.0), id="moment much larger than the force"),
]


def resultant(bearing, loads):
    """Forces and moments of all slices, summed here from their intensities. [N], [N m]"""
    force = loads.intensity * bearing.slice_width
    azimuth = np.arange(bearing.rollers_per_row) * 2 * math.pi / bearing.rollers_per_row
    width = bearing.roller_length / bearing.slices
    middle = [
        row * (bearing.roller_length + bearing.row_gap)
        - ((bearing.rows - 1) * (bearing.roller_length + bearing.row_gap)) / 2
        for row in range(bearing.rows)
    ]
    total = np.zeros(4)
    for row in range(bearing.rows):
        for roller in range(bearing.rollers_per_row):
            direction = np.array([math.cos(azimuth[roller]), math.sin(azimuth[roller])])
            for k in range(bearing.slices):
                y = middle[row] - bearing.roller_length / 2 + (k + 0.5) * width
                total[:2] += force[row, roller, k] * direction
                total[2:] += force[row, roller, k] * y * direction
    return total


@pytest.mark.parametrize("bearing", BEARINGS)
@pytest.mark.parametrize("load", LOADS)
def test_forces_and_moments_balance(bearing, load):
    loads = roller_loads(bearing, *load)
    found = resultant(bearing, loads)
    # moments count over the half-width of the bearing, as the solver's residual does
    scale = np.array([1.0, 1.0, bearing.half_width, bearing.half_width])
    largest = np.max(np.abs(np.array(load) / scale))
    assert found / scale == pytest.approx(np.array(load) / scale, abs=10 * SOLVER * largest)
    assert np.all(loads.intensity >= 0)
    assert np.all(np.isfinite(loads.intensity))


@pytest.mark.parametrize("bearing", BEARINGS)
@pytest.mark.parametrize("load", LOADS)
def test_every_slice_follows_the_load_law_at_its_deflection(bearing, load):
    """(3.3a) and the compatibility (3.2c) of Talbot (2012), from the displacement alone."""
    loads = roller_loads(bearing, *load)
    dx, dy, tx, ty = loads.displacement
    width = bearing.slice_width
    for row, y in enumerate(bearing.slice_positions):
        for z, psi in enumerate(loads.azimuth):
            radial = (dx + tx * y) * math.cos(psi) + (dy + ty * y) * math.sin(psi)
            delta = (radial - bearing.diametral_clearance / 2) / 2 - bearing.crown
            q = loads.intensity[row, z]
            loaded = delta > 0
            assert np.all(q[~loaded] == 0)
            if not loaded.any():
                continue
            # loaded length that this load law implies, mm: one for the whole roller
            length = (delta[loaded] * 1e3) ** 1.11 / (1.24e-5 * q[loaded] * 1e-3)
            length = length ** (1 / 0.11)
            # exponents of 1.11 and 1/0.11 enlarge rounding in a small difference of displacements
            size = abs(delta[loaded]) / max(abs(dx), abs(dy), bearing.diametral_clearance, 1e-9)
            clear = size > 1e-3
            if clear.any():
                mean = length[clear].mean()
                assert length[clear] == pytest.approx(np.full(clear.sum(), mean), rel=1e-6)
                # it ends between the slices where the load ends; one slice at least
                count = loaded.sum()
                assert (count - 1) * width * 1e3 * 0.999 <= mean <= (count + 1) * width * 1e3


# --- closed forms ---------------------------------------------------------------------------------


def aligned_reference(bearing, force):
    """Rollers of one row without crown: K = l^0.89/1.24e-5 (N, mm) at half the approach."""
    length_mm = bearing.roller_length * 1e3
    contact = length_mm**0.89 / 1.24e-5 * 1e3**1.11
    stiffness = contact / 2**1.11
    return aligned_roller_loads(
        force, bearing.rollers_per_row, bearing.diametral_clearance, stiffness, 1.11
    )


@pytest.mark.parametrize("rollers", [3, 4, 7, 16, 25])
@pytest.mark.parametrize("clearance", [0.0, 4e-6, 50e-6, 1e-3])
@pytest.mark.parametrize("force", [100.0, 5000.0, 2e5])
def test_aligned_bearing_is_that_of_stribeck(rollers, clearance, force):
    bearing = replace(PLAIN, rollers_per_row=rollers, diametral_clearance=clearance)
    loads = roller_loads(bearing, force, 0.0, 0.0, 0.0).intensity.sum(axis=2) * bearing.slice_width
    expected = aligned_reference(bearing, force)
    # both balance the force to 1e-9; single rollers next to the clearance are softer
    assert loads[0] == pytest.approx(expected, abs=1e-7 * force)


def test_rows_share_an_aligned_load():
    double = replace(PLAIN, rows=2)
    one = roller_loads(PLAIN, 4000.0, 0.0, 0.0, 0.0).intensity[0]
    two = roller_loads(double, 8000.0, 0.0, 0.0, 0.0).intensity
    assert two[0] == pytest.approx(one, rel=1e-6, abs=1e-3)
    assert two[1] == pytest.approx(one, rel=1e-6, abs=1e-3)


@pytest.mark.parametrize(
    ("load_zone", "ball", "roller"),
    # T. A. Harris, Rolling Bearing Analysis: table of J_r(epsilon), quoted from general knowledge.
    # Balls, n = 1.5: half a last digit. Rollers: up to 0.35 % from the integral for n = 1.11.
    [
        (0.1, 0.1156, 0.1268),
        (0.2, 0.1590, 0.1737),
        (0.3, 0.1892, 0.2055),
        (0.4, 0.2117, 0.2286),
        (0.5, 0.2288, 0.2453),
        (0.6, 0.2416, 0.2568),
        (0.7, 0.2505, 0.2636),
        (0.8, 0.2559, 0.2658),
        (0.9, 0.2576, 0.2628),
        (1.0, 0.2546, 0.2523),
    ],
)
def test_load_integral_is_that_of_the_tables(load_zone, ball, roller):
    assert radial_load_integral(load_zone, 1.5) == pytest.approx(ball, abs=0.5e-4)
    assert radial_load_integral(load_zone, 1.11) == pytest.approx(roller, rel=4e-3)


def test_most_loaded_of_many_rollers_without_clearance_carries_four_times_the_mean():
    bearing = replace(PLAIN, rollers_per_row=100, roller_diameter=0.6e-3, diametral_clearance=0.0)
    loads = roller_loads(bearing, 5000.0, 0.0, 0.0, 0.0).intensity.sum(axis=2) * bearing.slice_width
    # Stribeck's number for rollers, 4.08: three digits
    assert loads.max() * 100 / 5000 == pytest.approx(4.08, abs=0.005)
    # and the integral, to the error of a sum over 100 rollers for it: 7e-7
    assert loads.max() * 100 / 5000 == pytest.approx(1 / radial_load_integral(0.5, 1.11), rel=2e-6)


@pytest.mark.parametrize("clearance", [20e-6, 100e-6])
def test_clearance_narrows_the_load_zone_as_the_integral_says(clearance):
    bearing = replace(
        PLAIN, rollers_per_row=200, roller_diameter=0.3e-3, diametral_clearance=clearance
    )
    loads = roller_loads(bearing, 3000.0, 0.0, 0.0, 0.0)
    most = loads.intensity.sum(axis=2).max() * bearing.slice_width
    load_zone = (1 - clearance / (2 * loads.displacement[0])) / 2
    assert 0 < load_zone < 0.5
    # the sum over 200 rollers, of which 29 or 17 carry load, for an integral: 8e-4
    assert most * 200 / 3000 == pytest.approx(1 / radial_load_integral(load_zone, 1.11), rel=1.2e-3)


def test_a_roller_alone_carries_the_load_at_huge_clearance():
    bearing = replace(PLAIN, diametral_clearance=10e-3)
    loads = roller_loads(bearing, 1000.0, 0.0, 0.0, 0.0).intensity.sum(axis=(0, 2))
    assert loads[0] * bearing.slice_width == pytest.approx(1000.0, rel=1e-8)
    assert np.all(loads[1:] == 0)


def test_pure_moment_on_two_rows_is_a_couple():
    loads = roller_loads(TALBOT, 0.0, 0.0, 30.0, 0.0)
    rollers = loads.intensity.sum(axis=2)
    # x to the one side in one row, to the other in the other; zero displacement of the middle
    assert rollers[0] == pytest.approx(np.roll(rollers[1], 8), rel=1e-6, abs=1.0)
    assert rollers[0].argmax() == 8
    assert rollers[1].argmax() == 0
    assert loads.displacement[:2] == pytest.approx([0.0, 0.0], abs=1e-12)


def test_no_load_no_intensity():
    loads = roller_loads(TALBOT, 0.0, 0.0, 0.0, 0.0)
    assert np.all(loads.intensity == 0)


# --- symmetries -----------------------------------------------------------------------------------


def turned(load, angle):
    fx, fy, mx, my = load
    c, s = math.cos(angle), math.sin(angle)
    return (c * fx - s * fy, s * fx + c * fy, c * mx - s * my, s * mx + c * my)


@pytest.mark.parametrize("pitches", [1, 5, 8])
def test_turning_the_load_by_a_roller_pitch_turns_the_picture(pitches):
    load = (9804.0, 0.0, 5.0, 55.3)
    first = roller_loads(TALBOT, *load).intensity
    second = roller_loads(TALBOT, *turned(load, pitches * 2 * math.pi / 16)).intensity
    # two solutions, each within the solver's tolerance
    assert second == pytest.approx(np.roll(first, pitches, axis=1), abs=1e-6 * first.max())


def test_reversed_moment_swaps_the_ends():
    first = roller_loads(TALBOT, 9804.0, 0.0, 0.0, 55.3).intensity
    second = roller_loads(TALBOT, 9804.0, 0.0, 0.0, -55.3).intensity
    assert second == pytest.approx(first[::-1, :, ::-1], abs=1e-6 * first.max())
    # mirrored across the load
    mirrored = first[:, np.r_[0, 15:0:-1], :]
    assert second == pytest.approx(mirrored, abs=1e-6 * first.max())


def test_roller_under_the_load_is_not_skewed_by_the_mesh_moment():
    """Talbot (2012), p. 68: the moment of a helical mesh is orthogonal to the force."""
    loads = roller_loads(TALBOT, 9804.0, 0.0, 0.0, 55.3).intensity
    assert loads[0, 0] == pytest.approx(loads[0, 0, ::-1], rel=1e-6)
    assert loads[0, 0] == pytest.approx(loads[1, 0], rel=1e-6)
    # the others lean more, the farther from the load they stand
    lean = [loads[1, z, -6] / loads[1, z, 5] for z in range(4)]
    assert all(b > a + 0.05 for a, b in pairwise(lean))


# --- robustness -----------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("load", [(9804.0, 0.0, 0.0, 55.3), (3000.0, -2000.0, 10.0, 25.0)])
def test_solution_does_not_depend_on_the_start(load):
    half_width = TALBOT.half_width
    vector = np.array([load[0], load[1], load[2] / half_width, load[3] / half_width])
    azimuth = np.arange(16) * 2 * math.pi / 16
    expected = roller_loads(TALBOT, *load).intensity
    rng = np.random.default_rng(11)
    for _ in range(200):
        start = rng.uniform(-1, 1, 4) * 10 ** rng.uniform(-8, -2)
        (q,), _, (iterations,) = solve_roller_loads(
            vector[None],
            start[None],
            azimuth,
            TALBOT.slice_positions[None] / half_width,
            TALBOT.crown[None],
            np.array([[TALBOT.slice_width, TALBOT.diametral_clearance]]),
            SOLVER,
            100,
        )
        assert 0 < iterations < 100
        assert q == pytest.approx(expected, abs=1e-6 * expected.max())


def test_random_bearings_and_loads_are_solved():
    rng = np.random.default_rng(12)
    for _ in range(120):
        diameter = rng.uniform(1.5e-3, 8e-3)
        bearing = RollerBearing(
            rows=int(rng.integers(1, 4)),
            rollers_per_row=int(rng.integers(3, 40)),
            roller_diameter=diameter,
            roller_length=rng.uniform(2, 8) * diameter,
            inner_diameter=rng.uniform(3, 15) * diameter,
            diametral_clearance=float(rng.choice([0.0, rng.uniform(1e-6, 100e-6)])),
            crown_drop=rng.uniform(0, 20e-6),
            crown_length_fraction=rng.uniform(0, 0.5),
            row_gap=rng.uniform(0, 3e-3),
            roller_roughness=0.1e-6,
            race_roughness=0.1e-6,
            equivalent_modulus=STEEL,
            slices=int(rng.integers(3, 30)),
        )
        force = math.exp(rng.uniform(math.log(0.1), math.log(1e6)))
        angle = rng.uniform(0, 2 * math.pi, 2)
        moment = force * bearing.half_width * rng.uniform(0, 2)
        load = (
            force * math.cos(angle[0]),
            force * math.sin(angle[0]),
            moment * math.cos(angle[1]),
            moment * math.sin(angle[1]),
        )
        loads = roller_loads(bearing, *load)
        scale = np.array([1.0, 1.0, bearing.half_width, bearing.half_width])
        largest = max(force, moment / bearing.half_width)
        residual = resultant(bearing, loads) / scale - np.array(load) / scale
        assert np.abs(residual).max() < 10 * SOLVER * largest


@pytest.mark.parametrize("force", [1e-3, 1e-6, 1e-8, 1e-10])
@pytest.mark.parametrize("clearance", [4e-6, 1e-4])
def test_vanishing_loads_are_solved(force, clearance):
    bearing = replace(TALBOT, diametral_clearance=clearance)
    loads = roller_loads(bearing, force, 0.0, 0.0, 0.005 * force)
    # Displacements are as large as the clearance; their rounding, times the stiffness of some
    # 1e8 N/m, is a force that cannot be balanced.
    unbalanced = 100 * np.finfo(float).eps * clearance * 1e8
    assert resultant(bearing, loads)[0] == pytest.approx(force, abs=1e-8 * force + unbalanced)


@pytest.mark.parametrize(("rollers", "force", "arm"), [(3, 1.466, 5.64e-3), (4, 5.0, 20e-3)])
def test_a_tilt_without_stiffness_is_no_obstacle(rollers, force, arm):
    """A single row of few rollers and slices does not resist every tilt."""
    bearing = replace(TALBOT, rows=1, rollers_per_row=rollers, slices=3, diametral_clearance=0.0)
    loads = roller_loads(bearing, force, 0.0, 0.0, arm * force)
    found = resultant(bearing, loads)
    # the last lengths are kept when they have not settled: a hundredth of the solver's digits less
    assert found == pytest.approx([force, 0.0, 0.0, arm * force], abs=1e-6 * force)


def test_an_iteration_that_does_not_end_says_so(monkeypatch):
    monkeypatch.setattr(planet_bearing, "MAX_ITERATIONS", 1)
    bearing = replace(TALBOT, diametral_clearance=3.21e-5)  # in no cache yet
    with pytest.raises(ConvergenceError, match="planet bearing was not found under 1250 N"):
        roller_loads(bearing, 1250.0, 0.0, 0.0, 7.0)


# --- behaviour ------------------------------------------------------------------------------------


def test_load_distribution_is_continuous_in_the_load():
    forces = np.linspace(2000.0, 2100.0, 401)
    total = np.array(
        [
            roller_loads(TALBOT, force, 0.0, 0.0, 0.00564 * force).intensity.sum(axis=(0, 2))
            for force in forces
        ]
    )
    steps = np.diff(total, axis=0)
    # 0.25 N a step: 0.06 N on the most loaded roller, times 1.5; a jump of the loaded length by a
    # whole slice would be 0.5 % of some 300 N
    assert np.abs(steps).max() * TALBOT.slice_width < 0.09


def test_slices_converge():
    def most(slices):
        bearing = replace(TALBOT, slices=slices)
        loads = roller_loads(bearing, 9804.0, 0.0, 0.0, 55.3)
        return loads.intensity.sum(axis=2).max() * bearing.slice_width

    exact = most(480)
    errors = [abs(most(n) / exact - 1) for n in (15, 30, 60, 120)]
    # Load ends and crown begin within slices, so that the order is erratic: 1.5e-3 with 15 and 30
    # slices, 3e-5 with 120; times 1.5.
    assert max(errors[:2]) < 2.3e-3
    assert errors[3] < 5e-5


def test_geometry_of_the_test_article():
    # Table 3.3: planet bore 34.025 mm follows from pin, rollers and clearance
    assert TALBOT.outer_diameter * 1e3 == pytest.approx(34.025, rel=1e-12)
    # worked out separately
    assert TALBOT.pitch_diameter * 1e3 == pytest.approx(30.008, rel=1e-12)
    assert TALBOT.half_width == pytest.approx(9.52e-3, rel=1e-12)
    # 1/R = 1/R_roller + 1/R_pin inside, - 1/R_bore outside
    assert 1 / TALBOT.inner_radius == pytest.approx(2e3 / 4.015 + 2e3 / 25.991, rel=1e-12)
    assert 1 / TALBOT.outer_radius == pytest.approx(2e3 / 4.015 - 2e3 / 34.025, rel=1e-12)
    gaps = replace(TALBOT, rows=3, row_gap=2e-3)
    assert gaps.half_width == pytest.approx((3 * 9.52e-3 + 2 * 2e-3) / 2, rel=1e-12)
    assert gaps.slice_positions.mean() == pytest.approx(0.0, abs=1e-15)
    assert gaps.slice_positions.max() == pytest.approx(
        gaps.half_width - gaps.slice_width / 2, rel=1e-12
    )


def test_crown_is_a_parabola_over_its_ends():
    bearing = replace(TALBOT, slices=1000, crown_drop=5e-6, crown_length_fraction=0.25)
    crown = bearing.crown
    assert crown == pytest.approx(crown[::-1], rel=1e-12)
    assert np.all(crown[250:750] == 0)
    # the middle of the last slice stands 1/500 of the crowned quarter short of the end
    assert crown[0] == pytest.approx(5e-6 * (1 - 1 / 500) ** 2, rel=1e-9)
    # half-way in: a quarter of the drop
    assert crown[125] == pytest.approx(5e-6 / 4, rel=0.01)
    assert np.all(replace(TALBOT, crown_length_fraction=0.0).crown == 0)


def test_rolling_speed_is_that_of_the_source():
    # (3.4) with d_m 30.008 mm, d_r 4.015 mm at 7090 rpm; also half the speed of the races' surface
    # against the cage, u = omega_c' r of pin: omega d_m (1 - d_r^2/d_m^2)/4
    speed = 7090 * math.pi / 30
    expected = 0.030008 * speed * (1 - (4.015 / 30.008) ** 2) / 4
    assert TALBOT.rolling_speed(speed) == pytest.approx(expected, rel=1e-12)
    assert TALBOT.rolling_speed(-speed) == TALBOT.rolling_speed(speed)
    # cage at omega/2 (1 - d_r/d_m) against a fixed pin; roller and pin roll on each other there
    cage = speed / 2 * (1 - 4.015 / 30.008)
    assert TALBOT.rolling_speed(speed) == pytest.approx(cage * (30.008 + 4.015) / 2e3, rel=1e-12)


def test_points_that_are_solved_together_have_the_loads_of_each():
    loads = [(9804.0, 55.3), (9701.0, 54.7), (0.0, 0.0), (12.5, 0.02), (25000.0, -141.0)]
    force, moment = (of_points(column).reshape(-1, 1) for column in zip(*loads, strict=True))
    together = roller_loads.__wrapped__(TALBOT, force, 0.0, 0.0, moment)
    further = roller_loads_next_to(TALBOT, together, 1.001 * force, 0.0, 1.001 * moment)
    for place, (one, tilting) in enumerate(loads):
        for found, factor in ((together, 1.0), (further, 1.001)):
            alone = roller_loads(TALBOT, factor * one, 0.0, 0.0, factor * tilting)
            assert np.asarray(found.intensity)[place] == pytest.approx(
                alone.intensity, rel=1e-6, abs=1e-7 * alone.intensity.max()
            )
            assert np.asarray(found.displacement)[place] == pytest.approx(
                alone.displacement, rel=1e-6, abs=1e-12
            )


@pytest.mark.parametrize("slices", [5, pytest.param(20, marks=pytest.mark.slow)])
def test_of_two_solutions_every_start_leads_to_the_same(slices):
    """Where an end of a roller just touches, half a slice more or less carries the load too."""
    bearing, count = replace(TALBOT, slices=slices), 512
    rng = np.random.default_rng(7)
    force = np.sort(rng.uniform(50.0, 12000.0, count))
    moment = 4e-3 * force * rng.uniform(0.5, 1.1, count)
    block = [of_points(it[:, None]) for it in (force, 0 * force, moment, 0 * moment)]
    found = np.asarray(roller_loads(bearing, *block).intensity)
    for own, load, tilting in zip(found, force.tolist(), moment.tolist(), strict=True):
        alone = roller_loads(bearing, load, 0.0, tilting, 0.0).intensity
        assert np.abs(own - alone).max() < 1e-6 * alone.max()
