"""Load sharing between planets: statics, the closed form, and the losses of a whole set."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import epicyclic as ep
from epicyclic.contact.planet_sharing import (
    Branches,
    branch_directions,
    closed_form_branch_forces,
    solve_branch_forces,
)
from epicyclic.losses.planet_bearing import RollerBearing, radial_stiffness

ALPHA = math.radians(23.0)
ROUNDING = 1e-8  # relative; least squares of a few unknowns


def branches(lead, angles=None, compliance=1e-8):
    lead = np.array(lead, dtype=float)
    if angles is None:
        angles = 2 * np.pi * np.arange(len(lead)) / len(lead)
    return Branches(np.asarray(angles), compliance, lead)


def direct(force, found, supports=None, ring_angle=ALPHA):
    return solve_branch_forces(
        force, found, branch_directions(found.angles, ALPHA, ring_angle), supports or {}
    )


@given(
    lead=st.lists(st.floats(-3e-6, 3e-6), min_size=3, max_size=8),
    member=st.sampled_from(["sun", "ring", "carrier", None]),
)
def test_direct_solution_is_the_closed_form_while_all_planets_carry(lead, member):
    found = branches(lead)
    expected = closed_form_branch_forces(2e4, found, floating=member is not None)
    assert expected.min() > 0  # 3 um over 1e-8 m/N are 300 N, the mean load is 2500 N at least
    forces = direct(2e4, found, {member: 0.0} if member else {})
    assert forces == pytest.approx(expected, rel=ROUNDING)


@given(
    lead=st.lists(st.floats(-1e-4, 1e-4), min_size=2, max_size=9),
    stiffness=st.sampled_from([0.0, 1e6, 1e9]),
    ring_angle=st.floats(0.2, 0.5),
)
def test_forces_balance_and_none_pulls(lead, stiffness, ring_angle):
    found = branches(lead)
    directions = branch_directions(found.angles, ALPHA, ring_angle)
    forces = solve_branch_forces(1e4, found, directions, {"sun": stiffness})
    assert forces.min() >= 0.0
    assert forces.sum() == pytest.approx(1e4, rel=ROUNDING)
    if stiffness == 0.0:
        assert np.abs(directions["sun"].T @ forces).max() < 1e-6 * 1e4


def test_three_planets_share_evenly_under_a_floating_sun():
    """Ligata, Kahraman and Singh (2009): whatever the errors."""
    forces = direct(9e3, branches([30e-6, -12e-6, 4e-6]), {"sun": 0.0})
    assert forces == pytest.approx(3e3, rel=ROUNDING)


@pytest.mark.parametrize(("count", "part"), [(3, 0), (4, 1 / 4), (5, 2 / 5), (6, 1 / 2)])
def test_part_of_a_single_error_that_loads_its_planet(count, part):
    error = 4e-6
    forces = direct(2e4, branches([error] + [0.0] * (count - 1)), {"sun": 0.0})
    assert forces[0] - 2e4 / count == pytest.approx(part * error / 1e-8, abs=1e-4)


def test_planet_with_a_large_error_carries_all_without_floating_members():
    forces = direct(1e3, branches([50e-6, 0.0, 0.0, 0.0]))
    assert forces == pytest.approx([1e3, 0.0, 0.0, 0.0])


@given(
    data=st.data(),
    count=st.integers(1, 8),
    spread=st.floats(-8, -3),
    load=st.floats(-8, 5),
    member=st.sampled_from(["sun", "ring", "carrier"]),
    stiffness=st.sampled_from([1e5, 1e7, 1e9]),
)
def test_a_supported_member_never_gives_way(data, count, spread, load, member, stiffness):
    """Forces, approach and displacement meet (S3) and (S4), whatever the load and the errors."""
    places = st.lists(st.floats(-1, 1), min_size=count, max_size=count)
    lead = 10**spread * np.array(data.draw(places))
    found, force = branches(lead), 10**load
    directions = branch_directions(found.angles, ALPHA, 0.31)
    forces = solve_branch_forces(force, found, directions, {member: stiffness})
    assert forces.sum() == pytest.approx(force, rel=1e-6)
    assert forces.min() >= 0.0
    moved = -directions[member].T @ forces / stiffness
    closing = found.compliance * forces - lead - directions[member] @ moved
    approach = closing[forces > 0].mean()
    slack = 1e-5 * max(np.ptp(lead), found.compliance * force)  # of the lightest loads
    assert np.abs(closing[forces > 0] - approach).max() < slack
    assert (closing[forces == 0] > approach - slack).all()


def test_support_goes_from_floating_to_rigid():
    found = branches([4e-6, 0.0, 0.0, 0.0])
    loads = [direct(2e4, found, {"sun": k})[0] for k in (0.0, 1e7, 1e8, 1e9, 1e14)]
    assert loads == sorted(loads)
    assert loads[-1] == pytest.approx(direct(2e4, found)[0], rel=1e-5)  # 1e8 over 1e14 N/m
    assert loads[1] > loads[0]


def test_one_planet_cannot_hold_a_floating_sun():
    with pytest.raises(ep.ConvergenceError, match="is not held"):
        direct(1e3, branches([0.0]), {"sun": 0.0})


def test_stiffness_of_rigid_bodies_on_soft_rollers_grows_with_the_load():
    bearing = RollerBearing(
        rows=1, rollers_per_row=16, roller_diameter=4e-3, roller_length=9.5e-3,
        inner_diameter=26e-3, diametral_clearance=0.0, crown_drop=0.0, crown_length_fraction=0.0,
        row_gap=0.0, roller_roughness=1e-7, race_roughness=1e-7, equivalent_modulus=2.27e11,
        slices=21,
    )  # fmt: skip
    # without clearance F ~ delta^1.11 as for each slice: k = 1.11 F/delta, k ~ F^(0.11/1.11)
    ratio = radial_stiffness(bearing, 8000.0) / radial_stiffness(bearing, 1000.0)
    assert ratio == pytest.approx(8 ** (0.11 / 1.11), rel=1e-6)


# --- whole gear sets ------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def four():
    return ep.load_case("talbot-2012").updated(
        {
            "models.mesh_loads": "without-losses",
            "planet.count": 4,
            "planet.angles": [
                "0 deg", "90.909090909090909 deg", "180 deg", "270.90909090909091 deg"
            ],
        }
    )  # fmt: skip


@pytest.fixture(scope="module")
def six():
    # loads that are proportional to the stated torque
    return ep.load_case("talbot-2012").updated(
        {"planet.count": 6, "models.mesh_loads": "without-losses"}
    )


ONE_LATE = ["10 um", "0 um", "0 um", "0 um", "0 um", "0 um"]


def shares(case, **keys):
    result = ep.solve(case.updated({f"load_sharing.{key}": value for key, value in keys.items()}))
    decimals = 0.5e-12 * len(result.planet_shares)  # each is rounded to 12
    assert sum(result.planet_shares) == pytest.approx(1.0, abs=decimals)
    return result


def test_equal_shares_by_default(six):
    result = ep.solve(six)
    assert result.planet_shares == (1 / 6,) * 6
    assert result.mesh_load_factor == pytest.approx(1.0)


def test_closed_form_and_direct_solution_agree_on_a_whole_set(six):
    one, other = (
        shares(six, method=method, position_errors=ONE_LATE) for method in ("closed-form", "direct")
    )
    assert one.planet_shares == pytest.approx(other.planet_shares, rel=1e-6)
    assert one.planet_shares[0] == max(one.planet_shares) > 1.1 / 6
    assert one.total == pytest.approx(other.total, rel=1e-6)
    stated = one.to_dict()["mesh_load_factor"]
    assert stated == {"value": pytest.approx(6 * max(one.planet_shares)), "unit": "1"}


def test_losses_sum_over_unequal_planets(six):
    """Every planet alone, solved in a set of six whose planets all carry that load."""
    result = shares(six, method="direct", position_errors=ONE_LATE)
    for term in ("sun_mesh_sliding", "ring_mesh_rolling", "planet_bearing_mechanical"):
        alone = sum(
            ep.solve(six.updated({"operation.torque": f"{1000 * 6 * share!r} N*m"})).losses[term]
            / 6
            for share in result.planet_shares
        )
        assert result.losses[term] == pytest.approx(alone, rel=1e-9)


def test_reversed_torque_loads_the_other_planets(six):
    forward = shares(six, method="direct", position_errors=ONE_LATE)
    back = shares(
        six.updated({"operation.torque": "-1000 N*m"}), method="direct", position_errors=ONE_LATE
    )
    mean = 1 / 6
    changed = [share - mean for share in forward.planet_shares]
    assert [mean - share for share in back.planet_shares] == pytest.approx(changed, rel=1e-6)


def test_mesh_load_factor_is_that_of_the_result(six):
    result = shares(six, method="mesh-load-factor", mesh_load_factor=1.3)
    assert result.mesh_load_factor == pytest.approx(1.3)
    assert len(set(result.planet_shares[1:])) == 1
    assert any("planet 1" in warning for warning in result.warnings)


def test_errors_matter_less_at_higher_load(six):
    factors = [
        shares(
            six.updated({"operation.torque": f"{torque} N*m"}),
            method="direct", position_errors=ONE_LATE,
        ).mesh_load_factor
        for torque in (50, 200, 1000, 4000)
    ]  # fmt: skip
    assert factors == sorted(factors, reverse=True)
    # while all planets carry, the surplus is that of the error: 1/4 of it at 4 times the torque,
    # and more by as much as all stiffness grows with the load
    assert 1 / 4 < (factors[3] - 1) / (factors[2] - 1) < 1 / 3


def test_soft_pins_share_better(six):
    stiff = shares(six, method="direct", position_errors=ONE_LATE)
    soft = shares(six, method="direct", position_errors=ONE_LATE, pin_stiffness="50 N/um")
    assert 1 < soft.mesh_load_factor < stiff.mesh_load_factor


def test_planet_without_load_loses_nothing_in_its_meshes(six):
    late = ["200 um", "0 um", "0 um", "0 um", "0 um", "0 um"]
    result = shares(six, method="direct", position_errors=late, floating_member="none")
    assert result.planet_shares == pytest.approx((1.0, 0, 0, 0, 0, 0), abs=1e-12)
    assert math.isfinite(result.total)


def test_no_load_no_errors(six):
    result = shares(
        six.updated({"operation.torque": "0 N*m"}), method="direct", position_errors=ONE_LATE
    )
    assert result.planet_shares == (1 / 6,) * 6


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"method": "mesh-load-factor", "mesh_load_factor": 7.0}, "at most planet.count"),
        ({"position_errors": ["1 um"]}, "one value for each of the 6 planets"),
        ({"method": "closed-form", "support_stiffness": "1 N/um"}, "floats freely"),
        ({"pin_stiffness": "0 N/um"}, "> 0"),
    ],
)
def test_bad_input(six, changes, words):
    with pytest.raises(ep.InputError, match=words):
        shares(six, **changes)


def test_closed_form_needs_even_spacing(four):
    with pytest.raises(ep.InputError, match="equally spaced"):
        shares(four, method="closed-form")


def test_closed_form_goes_on_where_planets_lose_contact(six):
    late = ["60 um", "1 um", "-3 um", "0 um", "2 um", "5 um"]
    found = {
        method: shares(six, method=method, position_errors=late, floating_member="ring")
        for method in ("closed-form", "direct")
    }
    assert found["closed-form"].planet_shares == found["direct"].planet_shares
    assert 0.0 in found["closed-form"].planet_shares
    assert any("is replaced by direct" in text for text in found["closed-form"].warnings)
    assert any("No load reaches planets" in text for text in found["direct"].warnings)


@pytest.mark.parametrize("method", ["closed-form", "direct"])
@pytest.mark.parametrize("torque", ["1e-9 N*m", "-0.002 N*m", "0.7 N*m"])
def test_the_lightest_loads_are_shared(six, method, torque):
    late = ["4 um", "1 um", "-3 um", "7 um", "2 um", "5 um"]
    result = shares(six.updated({"operation.torque": torque}), method=method, position_errors=late)
    assert min(result.planet_shares) == 0.0
