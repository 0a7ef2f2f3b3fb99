"""Positions of planets on the carrier."""

from __future__ import annotations

import math

import pytest

from epicyclic.gears.mesh import nearest_admissible_angle
from reference.planetary import admissible_angles, smallest_planet_gap


@pytest.mark.parametrize("count", [3, 6])
def test_planets_of_the_test_article_are_equally_spaced_where_198_teeth_divide(count):
    # Talbot (2012): (73 + 125)/n is an integer for n = 3 and 6 only
    for planet, angle in enumerate(admissible_angles(count, 73, 125)):
        assert angle == pytest.approx(2 * math.pi * planet / count, rel=1e-12)


@pytest.mark.parametrize("count", [4, 5])
def test_other_counts_stand_at_whole_steps_near_equal_spacing(count):
    step = 2 * math.pi / 198
    angles = admissible_angles(count, 73, 125)
    moved = 0
    for planet, angle in enumerate(angles):
        steps = angle / step
        assert steps == pytest.approx(round(steps), abs=1e-9)
        away = abs(angle - 2 * math.pi * planet / count)
        assert away <= step / 2 * (1 + 1e-12)
        moved += away > 1e-9
    assert moved >= 2


@pytest.mark.parametrize(("z_s", "z_p", "z_r"), [(73, 26, 125), (20, 31, 82), (31, 22, 75)])
def test_planet_meshes_at_every_admissible_position(z_s, z_p, z_r):
    """A tooth of the planet stands where sun and ring have their spaces, counted in pitches.

    The carrier turned by `angle` with the sun held: the ring has to turn on by whole pitches.
    """
    step = 2 * math.pi / (z_s + z_r)
    for k in (1, 7, 50):
        angle = nearest_admissible_angle(k * step * (1 + 1e-6), z_s, z_r)
        # Willis with the sun at rest: ring turns by angle (z_s + z_r)/z_r = k pitches of the ring
        ring_turn = angle * (z_s + z_r) / z_r
        pitches = ring_turn / (2 * math.pi / z_r)
        assert pitches == pytest.approx(k, rel=1e-12)
    assert nearest_admissible_angle(0.49 * step, z_s, z_r) == 0.0
    assert nearest_admissible_angle(0.51 * step, z_s, z_r) == pytest.approx(step, rel=1e-12)
    assert z_r - z_s == 2 * z_p


def test_gap_between_neighbours_is_a_chord():
    square = [0.0, math.pi / 2, math.pi, 3 * math.pi / 2]
    # corners of a square on a circle of radius 1: side sqrt(2)
    assert smallest_planet_gap(square, 1.0, 0.2) == pytest.approx(math.sqrt(2) - 0.4, rel=1e-12)
    # the order does not count, nor whole turns
    turned = [math.pi, 2 * math.pi, -math.pi / 2, math.pi / 2]
    assert smallest_planet_gap(turned, 1.0, 0.2) == pytest.approx(math.sqrt(2) - 0.4, rel=1e-12)
    closer = [0.0, 1.0, 3.0]
    expected = 2 * math.sin(0.5) - 2 * 0.6
    assert smallest_planet_gap(closer, 1.0, 0.6) == pytest.approx(expected, rel=1e-12)
    assert expected < 0  # overlap


def test_neighbours_across_the_start_count():
    # 20 degrees apart across zero, 170 elsewhere
    angles = [math.radians(10), math.radians(180), math.radians(350)]
    assert smallest_planet_gap(angles, 1.0, 0.0) == pytest.approx(
        2 * math.sin(math.radians(10)), rel=1e-12
    )


def test_a_single_planet_has_no_neighbour():
    assert smallest_planet_gap([0.3], 1.0, 0.5) == math.inf


def test_planets_of_the_test_article_have_room(talbot):
    # 92.13 mm, tip diameter 51.33 mm: six planets leave 2 a sin(30 deg) - d_a
    angles = admissible_angles(6, 73, 125)
    gap = smallest_planet_gap(angles, 92.13e-3, 51.33e-3 / 2)
    assert gap == pytest.approx(92.13e-3 - 51.33e-3, rel=1e-10)
