"""The mixed-EHL regressions against a transcription made from the printed equations alone."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from epicyclic.kernels import mixed_ehl
from epicyclic.kernels.line_contact import (
    equivalent_modulus,
    hertz_half_width,
    line_load_at_pressure,
    pan_hamrock_minimum_film,
)

TRANSCRIPTION = 1e-12  # relative; sums of ten terms of up to 50 in the exponent, times rounding
STEEL = equivalent_modulus(207e9, 0.3, 207e9, 0.3)
BLEND = math.exp(0.2)  # branches are blended within this factor of their limits in Lambda

# --- transcription of the printed equations --------------------------------------------------


def mu_boundary(s, u, g, p, r, s_co, s_eq, lam):
    """(5.8a)"""
    a = [-0.92139, -0.00008711, -4400.2, -208.356, 0.00034889, 0.00000156, 18.9479]
    b = [None, 0.00201603, -0.0059483, -1.90169, -0.579273, -0.00711570]
    return (
        math.exp(
            a[0]
            + s * (a[1] * g + a[2] * s_eq)
            + lam * (a[3] * p + a[4] * g)
            + r * (a[5] * g + a[6] * s_co)
        )
        * s ** (b[1] * r + b[2] * math.log(s_co))
        * r ** (b[3] * lam)
        * s_co ** (b[4] * lam + b[5] * math.log(u))
    )


def mu_mixed(s, u, g, p, r, s_co, s_eq, lam):
    """(5.8b)"""
    a = [-4.35656, -0.0060247, 0.00001033, -5940595]
    b = [
        None, -0.00009197, -0.0251361, 0.0092455, -0.146072,
        -21.8661, 0.00007909, 0.00315987, -0.0584464,
    ]  # fmt: skip
    return (
        math.exp(a[0] + r * (a[1] * s + a[2] * g + a[3] * u))
        * s ** (b[1] * g + b[2] * math.log(u) + b[3] * r + b[4] * math.log(r))
        * lam ** (b[5] * p)
        * p ** (b[6] * g)
        * s_co ** (b[7] * r + b[8] * math.log(r))
    )


def mu_full_film(s, u, g, p, r, s_co, s_eq, lam):
    """(5.8c)"""
    a = [-54.986, -0.0058891, -0.041242, 0.00000905]
    b = [
        None, 0.48686, -0.00022193, 21.533, 0.0074347, 6.8850,
        0.035346, -5.2323, -0.00073500, -0.052499,
    ]  # fmt: skip
    return (
        math.exp(a[0] + a[1] * s * r + g * (a[2] * p + a[3] * r))
        * s ** (b[1] + b[2] * g + b[3] * p + b[4] * r)
        * g ** (b[5] + b[6] * r)
        * u ** (b[7] * p)
        * r ** (b[8] * g + b[9] * r)
    )


def rolling_mixed(s, u, g, p, r, s_co, s_eq, lam):
    """(5.10a), without its prefactor"""
    a = [-55.5228, -4049775804, 0.00036893, 91748360]
    b = [None, 0.0035756, -2.81418, 0.79315, -1.57573, 0.71772, -4.20259, -0.162010]
    return (
        math.exp(a[0] + s * (a[1] * u + a[2] * g) + a[3] * s_co * s_eq)
        * lam ** (b[1] * r)
        * u ** b[2]
        * g ** (b[3] * lam)
        * r ** b[4]
        * s_co ** (b[5] * lam)
        * s_eq ** (b[6] + b[7] * math.log(u))
    )


def rolling_film(s, u, g, p, r, s_co, s_eq, lam):
    """(5.10b), without its prefactor"""
    b = [
        None, -0.74816, 700205388, -4.85987, -0.287849, -0.43762,
        2202.89, -0.183452, -0.123683, 0.50128, -0.370511,
    ]  # fmt: skip
    return (
        math.exp(-63.8414)
        * lam ** (b[1] * s + b[2] * u)
        * u ** (b[3] + b[4] * math.log(p))
        * g ** (b[5] * s)
        * r ** (b[6] * s_co)
        * s_co ** (b[7] * math.log(u) + b[8] * math.log(g) + b[9] * math.log(p))
        * s_eq ** (b[10] * s)
    )


def needle_loss(p_h, u_r, mu_d, alpha, r_eq, s_co, e_eq):
    """(3.5), W/m"""
    a = [27.3758, 0.0169312, -0.00260401]
    b = [
        None, 55.582, 0.179813, -0.097448, -1.33225, 0.272560, -15.4258, -0.102883, 0.233836,
    ]  # fmt: skip
    theta = u_r * mu_d / (p_h * s_co)
    u = u_r * mu_d / (e_eq * 1e-6)
    g, p, r, s = alpha * e_eq, p_h / e_eq, r_eq / 5e-3, s_co / 1e-6
    return (
        1e5
        * math.exp(a[0] + g * (a[1] * theta + a[2] * s))
        * theta ** (b[1] * theta + b[2] * math.log(theta) + b[3] * math.log(u) + b[4] * s)
        * g ** (b[5] * math.log(u) + b[6] * p)
        * p ** (b[7] * math.log(r) + b[8] * math.log(s))
    )


# --- conditions -----------------------------------------------------------------------------------


def gear_groups(s, u_r, mu_d, alpha, radius, rough1, rough2, p_h):
    """The groups of (5.8) and (5.10) from a contact Talbot (2012)."""
    load = line_load_at_pressure(p_h, radius, STEEL)
    speed = u_r * mu_d / (STEEL * radius)
    composite = math.hypot(rough1, rough2) / radius
    film = pan_hamrock_minimum_film(speed, alpha * STEEL, load / (STEEL * radius))
    return (
        s,
        speed,
        alpha * STEEL,
        p_h / STEEL,
        radius / hertz_half_width(load, radius, STEEL),
        composite,
        rough1 * rough2 / (rough1 + rough2) / radius,
        film / composite,
    )


def random_conditions(count, seed):
    """Contacts over the ranges of Table 5.1."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield gear_groups(
            s=math.exp(rng.uniform(math.log(0.025), 0.0)),
            u_r=rng.uniform(1, 20),
            mu_d=math.exp(rng.uniform(math.log(0.004), math.log(0.05))),
            alpha=rng.uniform(10e-9, 19e-9),
            radius=rng.uniform(5e-3, 40e-3),
            rough1=math.exp(rng.uniform(math.log(0.03e-6), math.log(0.7e-6))),
            rough2=math.exp(rng.uniform(math.log(0.03e-6), math.log(0.7e-6))),
            p_h=rng.uniform(0.5e9, 2.5e9),
        )


@pytest.mark.parametrize(
    ("low", "high", "formula"),
    [
        (0.0, 0.7 / BLEND, mu_boundary),
        (0.7 * BLEND, 3.0 / BLEND, mu_mixed),
        (3.0 * BLEND, math.inf, mu_full_film),
    ],
)
def test_sliding_friction_inside_its_branches(low, high, formula):
    checked = 0
    for groups in random_conditions(3000, seed=1):
        if low < groups[-1] < high:
            checked += 1
            assert mixed_ehl.sliding_friction(*groups) == pytest.approx(
                formula(*groups), rel=TRANSCRIPTION
            )
    assert checked > 300


@pytest.mark.parametrize(
    ("low", "high", "formula"), [(0.0, 1 / BLEND, rolling_mixed), (BLEND, math.inf, rolling_film)]
)
def test_rolling_loss_number_inside_its_branches(low, high, formula):
    checked = 0
    for groups in random_conditions(3000, seed=2):
        if low < groups[-1] < high:
            checked += 1
            assert mixed_ehl.rolling_loss_number(*groups) == pytest.approx(
                formula(*groups), rel=TRANSCRIPTION
            )
    assert checked > 300


def test_needle_rolling_loss():
    rng = np.random.default_rng(3)
    for _ in range(1000):  # over the ranges of Table 3.1
        contact = (
            rng.uniform(0.25e9, 3e9),
            rng.uniform(1, 20),
            math.exp(rng.uniform(math.log(0.004), math.log(0.05))),
            rng.uniform(10e-9, 19e-9),
            rng.uniform(0.5e-3, 4e-3),
            rng.uniform(0.058e-6, 0.193e-6),
            STEEL,
        )
        assert mixed_ehl.needle_rolling_loss(*contact) == pytest.approx(
            needle_loss(*contact), rel=TRANSCRIPTION
        )


def test_all_points_at_once_give_the_same():
    points = np.array(list(random_conditions(50, seed=4)))
    arrays = [np.ascontiguousarray(column) for column in points.T]
    for at_all, at_one in (
        (mixed_ehl.sliding_friction_at, mixed_ehl.sliding_friction),
        (mixed_ehl.rolling_loss_number_at, mixed_ehl.rolling_loss_number),
    ):
        each = [at_one(*point) for point in points]
        assert at_all(*arrays) == pytest.approx(each, rel=TRANSCRIPTION)
    pressure = np.array([[0.3e9, 1e9, 2e9], [0.4e9, 0.7e9, 1.7e9]])
    rest = np.array(
        [
            [8.0, 6e-3, 12e-9, 2.3e-3, 0.14e-6, STEEL],
            [9.0, 5e-3, 14e-9, 2.6e-3, 0.13e-6, 0.9 * STEEL],
        ]
    )
    for found, its, own in zip(
        mixed_ehl.needle_rolling_loss_at(pressure, rest), pressure, rest, strict=True
    ):
        each = [mixed_ehl.needle_rolling_loss(p_h, *own) for p_h in its]
        assert found == pytest.approx(each, rel=TRANSCRIPTION)


# --- blends ---------------------------------------------------------------------------------------

FRICTION_LIMITS = [(0.7, mu_boundary, mu_mixed), (3.0, mu_mixed, mu_full_film)]


@pytest.mark.parametrize(("limit", "below", "above"), FRICTION_LIMITS)
def test_friction_blend_stays_between_its_branches(limit, below, above):
    for groups in random_conditions(300, seed=5):
        for lam in np.geomspace(limit / BLEND, limit * BLEND, 9):
            at = (*groups[:-1], lam)
            ends = sorted((below(*at), above(*at)))
            mu = mixed_ehl.sliding_friction(*at)
            assert ends[0] * (1 - 1e-9) <= mu <= ends[1] * (1 + 1e-9)


def test_rolling_blend_stays_between_its_branches():
    for groups in random_conditions(300, seed=6):
        for lam in np.geomspace(1 / BLEND, BLEND, 9):
            at = (*groups[:-1], lam)
            ends = sorted((rolling_mixed(*at), rolling_film(*at)))
            loss = mixed_ehl.rolling_loss_number(*at)
            assert ends[0] * (1 - 1e-9) <= loss <= ends[1] * (1 + 1e-9)


@pytest.mark.parametrize(
    ("function", "limits"),
    [(mixed_ehl.sliding_friction, (0.7, 3.0)), (mixed_ehl.rolling_loss_number, (1.0,))],
)
def test_no_jumps_and_no_kinks_over_the_film_ratio(function, limits):
    lam = np.geomspace(0.2, 8.0, 20001)
    step = math.log(8.0 / 0.2) / 20000
    for groups in random_conditions(20, seed=7):
        value = np.log([function(*groups[:-1], x) for x in lam])
        slope = np.diff(value) / step
        # Branches differ by less than a factor of 4.5 (1.5 in the logarithm); the blend has a slope
        # of at most 1.5/0.4 of that, branches themselves less than 10. A jump would be 1/step.
        assert np.abs(slope).max() < 20
        # a kink would show as a step of the slope of the size of the slope itself
        assert np.abs(np.diff(slope)).max() < 0.1
        assert all(lam[0] < limit < lam[-1] for limit in limits)


def test_blend_weight_runs_from_none_to_all():
    assert mixed_ehl.blend_weight(0.7 / BLEND, 0.7) == pytest.approx(0.0, abs=1e-12)
    assert mixed_ehl.blend_weight(0.7, 0.7) == 0.5
    assert mixed_ehl.blend_weight(0.7 * BLEND, 0.7) == pytest.approx(1.0, abs=1e-12)
    assert mixed_ehl.blend_weight(0.01, 0.7) == 0.0
    assert mixed_ehl.blend_weight(100.0, 0.7) == 1.0


def test_pure_rolling_has_a_finite_friction():
    for groups in random_conditions(100, seed=8):
        mu = mixed_ehl.sliding_friction(0.0, *groups[1:])
        assert 0 < mu < mixed_ehl.sliding_friction(0.05, *groups[1:]) * 1.5


# --- the tables of simulated conditions -----------------------------------------------------------

ROUGHNESS = (0.1e-6, 0.3e-6, 0.5e-6, 0.7e-6)


def gear_grid(atf, pressure_viscosity):
    """All 33,600 conditions of Table 5.1, as columns of groups."""
    columns = []
    for celsius in (25, 50, 75, 100):
        oil = atf(celsius)
        alpha = pressure_viscosity(oil)
        for radius, rough1, rough2, p_h, u_r in itertools.product(
            (5e-3, 20e-3, 40e-3),
            ROUGHNESS,
            ROUGHNESS,
            (0.5e9, 1e9, 1.5e9, 2e9, 2.5e9),
            (1.0, 5.0, 10.0, 15.0, 20.0),
        ):
            groups = gear_groups(
                0.0, u_r, oil.dynamic_viscosity, alpha, radius, rough1, rough2, p_h
            )
            columns += [(s, *groups[1:]) for s in (0.025, 0.05, 0.10, 0.25, 0.50, 0.75, 1.00)]
    assert len(columns) == 33600
    return columns


def literature_coefficient(oil):
    """alpha by Roelands' link with z = 0.548: worked out separately, used for its figures."""
    return 0.548 * (math.log(oil.dynamic_viscosity) + 9.67) / 1.96e8


@pytest.fixture(scope="module")
def grid(atf):
    return gear_grid(atf, literature_coefficient)


@pytest.fixture(scope="module")
def grid_friction(grid):
    return np.array([mixed_ehl.sliding_friction(*groups) for groups in grid])


def test_friction_over_the_whole_table_of_conditions(grid_friction):
    # worked out separately: 0.002 to 0.112, half a unit of the last digit
    assert grid_friction.min() == pytest.approx(0.002, abs=0.5e-3)
    assert grid_friction.max() == pytest.approx(0.112, abs=0.5e-3)


@pytest.mark.parametrize(
    ("low", "high", "median"),
    [
        (0.0, 0.1, 0.052),
        (0.1, 0.2, 0.046),
        (0.2, 0.4, 0.038),
        (0.4, 0.7, 0.029),
        (0.7, 1.0, 0.025),
        (1.0, 100.0, 0.023),
    ],
)
def test_friction_falls_along_a_stribeck_curve(grid, grid_friction, low, high, median):
    lam = np.array([groups[-1] for groups in grid])
    # worked out separately, medians without blends: these move the two bands next to 0.7 by up
    # to 0.001; half a unit of the last digit besides
    found = np.median(grid_friction[(lam > low) & (lam <= high)])
    assert found == pytest.approx(median, abs=1.5e-3)


@pytest.mark.parametrize(("limit", "below", "above"), FRICTION_LIMITS)
def test_friction_branches_nearly_meet(grid, limit, below, above):
    """A wrong column of a coefficient shows as a jump of several powers of ten."""
    near = [groups for groups in grid if abs(math.log(groups[-1] / limit)) < 0.02]
    assert len(near) > 100
    jumps = [math.log(above(*at[:-1], limit) / below(*at[:-1], limit)) for at in near]
    # worked out separately: rms of the logarithm 0.20 at 0.7 and 0.09-0.11 at 3; the points
    # near the limit differ from those there
    assert np.sqrt(np.mean(np.square(jumps))) < 0.30


def test_rolling_branches_nearly_meet(grid):
    near = [g for g in grid if abs(math.log(g[-1])) < 0.02 and g[0] <= 0.75]
    assert len(near) > 100
    jumps = [math.log(rolling_film(*at[:-1], 1.0) / rolling_mixed(*at[:-1], 1.0)) for at in near]
    # Talbot (2012) mean 0.17-0.27 with the bases as there, 0.5-1.9 with b5 and b6 exchanged
    assert abs(np.mean(jumps)) < 0.35


def test_friction_with_the_coefficients_of_the_package(atf):
    points = gear_grid(atf, lambda oil: oil.pressure_viscosity)
    mu = np.array([mixed_ehl.sliding_friction(*groups) for groups in points])
    assert mu.max() < 0.112
    # The calibrated alphas are 12 % below those of the earlier estimate. At 75 and 100 degC,
    # 0.5 GPa and s = 0.025 that takes the regression below the 0.002 found there, 0.0007 at
    # least, in 0.2 % of the conditions.
    assert mu.min() > 0.0005
    assert np.mean(mu < 0.002) < 0.002


# --- needles against smooth EHL -------------------------------------------------------------------


@pytest.mark.parametrize(
    ("celsius", "u_r", "p_h", "regression", "solved"),
    # worked out separately: R_eq 1.75 mm; (3.5) in the smooth limit against own full solutions
    [
        (90, 5.0, 1e9, 259, 232),
        (40, 5.0, 1e9, 626, 562),
        (90, 15.0, 1e9, 1303, 1416),
        (40, 15.0, 1e9, 2719, 3098),
        (40, 15.0, 0.5e9, 1560, 1330),
    ],
)
def test_needle_loss_is_that_of_smooth_ehl(atf, celsius, u_r, p_h, regression, solved):
    oil = atf(celsius)
    smoothest = math.hypot(0.02e-6, 0.055e-6)  # of Table 3.1
    loss = mixed_ehl.needle_rolling_loss(
        p_h, u_r, oil.dynamic_viscosity, literature_coefficient(oil), 1.75e-3, smoothest, STEEL
    )
    # alpha was stated to three digits, 0.4 %, which is 2 % of the loss; the roughness was not
    assert loss == pytest.approx(regression, rel=0.05)
    # smooth isothermal solutions: the regression has waviness, and a scatter of its own
    assert loss == pytest.approx(solved, rel=0.20)
