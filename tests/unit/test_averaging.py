"""Means over time, aided by a coarse grid: unbiased, and with the error that is stated."""

from __future__ import annotations

import math

import numpy as np
import pytest

from epicyclic.plugins.contact_solver.rough import Estimate, Plan, aided_mean, next_plan

MEAN = 0.03


def series(rng, blocks, correlation=0.95, scatter=0.3):
    """Blocks on both grids; the coarse one has another mean and shares with two blocks before."""
    noise = rng.standard_normal(blocks + 2)
    coarse = (noise[2:] + 0.7 * noise[1:-1] + 0.3 * noise[:-2]) / math.sqrt(1.58)
    own = math.sqrt(1 - correlation**2) * rng.standard_normal(blocks)
    return MEAN * (1 + scatter * (correlation * coarse + own)), 0.04 + 0.011 * coarse


def simulated(rng, tolerance, correlation=0.95, scatter=0.3):
    """An estimate by as many blocks as it takes, and what they cost."""
    fine, coarse = series(rng, 6000, correlation, scatter)
    plan, before = Plan(8, 8), None
    while plan != before:
        estimate = aided_mean(fine[: plan.blocks], coarse[: plan.aid_blocks])
        if estimate.within(tolerance):
            break
        before, plan = plan, next_plan(estimate, tolerance, 0.07, 1024)
    return estimate


@pytest.mark.parametrize(("tolerance", "scatter"), [(0.02, 0.3), (0.05, 0.15)])
def test_the_error_is_the_one_stated(tolerance, scatter):
    rng = np.random.default_rng(4)
    found = [simulated(rng, tolerance, scatter=scatter) for _ in range(300)]
    off = np.array([item.value / MEAN - 1 for item in found])
    assert all(item.within(tolerance) for item in found)
    # 300 draws tell the mean to tolerance/17; stopping at a lucky look costs up to a fifth
    assert abs(off.mean()) < 0.2 * tolerance
    assert np.sqrt(np.mean(off**2)) < 1.3 * tolerance


def test_the_coarse_grid_saves_most_of_the_blocks():
    rng = np.random.default_rng(5)
    aided = np.mean([simulated(rng, 0.02).blocks for _ in range(50)])
    alone = (0.3 / 0.02) ** 2 * (1 + 0.7 + 0.3) ** 2 / 1.58
    assert aided < alone / 4


def test_a_slope_from_a_few_blocks_widens_the_error_where_it_reaches_far():
    fine, coarse = series(np.random.default_rng(8), 8, correlation=0.8)
    near = aided_mean(fine, np.append(coarse, np.full(40, coarse.mean())))
    far = aided_mean(fine, np.append(coarse, np.full(40, coarse.mean() + 3 * coarse.std())))
    reach = 40 / 48 * 3  # of the long mean, in standard deviations of the eight blocks
    assert far.own / near.own == pytest.approx(1 + reach**2)


def test_many_blocks_tell_of_neighbours_that_make_up_for_one_another():
    noise = np.random.default_rng(9).standard_normal(4001)
    alike, opposed = noise[1:] + 0.5 * noise[:-1], noise[1:] - 0.5 * noise[:-1]
    for blocks, expected in ((alike, 1.5**2), (opposed, 0.5**2)):
        assert aided_mean(3 + blocks, np.empty(0)).own == pytest.approx(expected, rel=0.25)


def test_a_coarse_grid_that_tells_nothing_or_broke_down_is_left_out():
    fine, coarse = series(np.random.default_rng(6), 20)
    plain = aided_mean(fine, np.empty(0))
    assert plain.value == pytest.approx(fine.mean())
    assert plain.aid_blocks == 0
    for useless in (np.full(20, 3.7), np.append(coarse, np.nan), coarse[:11]):
        assert aided_mean(fine, useless) == plain


def test_a_fine_grid_that_broke_down_gives_no_mean():
    assert math.isnan(aided_mean(np.array([1.0, np.nan, 2.0]), np.arange(5.0)).value)


def test_a_coarse_grid_that_tells_all_gives_its_long_mean():
    coarse = np.random.default_rng(7).random(40)
    estimate = aided_mean(3.1 * coarse[:9] + 0.7, coarse)
    assert estimate.value == pytest.approx(3.1 * coarse.mean() + 0.7)
    assert estimate.own == pytest.approx(0.0, abs=1e-25)


def test_a_plan_grows_until_no_more_is_allowed():
    estimate = Estimate(1.0, own=1.0, aid=0.0, blocks=60, aid_blocks=0)
    assert next_plan(estimate, 0.01, 0.1, 64) == Plan(64, 0)
    full = Estimate(1.0, own=1.0, aid=1.0, blocks=64, aid_blocks=64 * 32)
    assert next_plan(full, 0.01, 0.1, 64) == Plan(64, 64 * 32)
    nothing = Estimate(0.0, own=0.0, aid=0.0, blocks=6, aid_blocks=0)
    assert next_plan(nothing, 0.02, 0.1, 1024).blocks == 9


def test_an_average_beyond_the_most_blocks_is_given_up_at_once():
    """The fine grid alone scatters by 6 % after all its blocks, and looks cost more than blocks."""
    estimate = Estimate(1.0, own=1.7, aid=4.9, blocks=512, aid_blocks=5600)
    assert next_plan(estimate, 0.04, 0.023, 512) == Plan(512, 5600)


def test_looks_at_the_error_are_few():
    plan, looks = Plan(8, 8), 0
    while True:
        own = 0.3 * (1 + 0.2 / plan.blocks)  # of a scatter that is found to be less and less
        estimate = Estimate(1.0, own, 2.0, *plan)
        if estimate.within(0.02):
            break
        looks, plan = looks + 1, next_plan(estimate, 0.02, 0.05, 1024)
    assert looks < 60
