"""Teeth and bearings under the torques in balance with all losses, whichever shaft states them."""

from __future__ import annotations

import math

import pytest

import asymmetric
import epicyclic as ep

SAME = 1e-9
"""Relative, and of losses over the power: torques and losses of each result agree to 5e-10."""
MEMBERS = ("sun", "ring", "carrier")
TORQUES = (1000.0, -340.0, 7.0, 0.5, 0.02, 1e-3, 0.0, -1e-3, -0.3, -12.0)


@pytest.fixture(scope="module")
def talbot():
    return ep.load_case("talbot-2012").updated({"models.preset": "talbot-2012"})


def stated_at(case, member, result):
    """The operating point of a result, stated at another member."""
    found = result.flow.members[member]
    return case.updated(
        {
            "operation.input": member,
            "operation.torque": f"{found.torque!r} N*m",
            "operation.speed": f"{found.speed * 30 / math.pi!r} rpm",
        }
    )


@pytest.mark.parametrize("torque", TORQUES)
def test_an_operating_point_loses_the_same_stated_at_sun_or_carrier(talbot, torque):
    one = ep.solve(talbot.updated({"operation.torque": f"{torque} N*m"}))
    two = ep.solve(stated_at(talbot, "carrier", one))
    assert two.losses == pytest.approx(one.losses, abs=SAME * one.input_power)
    assert two.flow.members["sun"].torque == pytest.approx(torque, rel=SAME, abs=1e-9)
    assert two.input_power == pytest.approx(one.input_power, rel=SAME)
    assert two.efficiency == pytest.approx(one.efficiency, abs=SAME)


@pytest.mark.parametrize("member", ["ring", "carrier"])
def test_so_does_a_set_with_all_that_can_be_lost_and_two_driven_members(member):
    case = ep.load_case(asymmetric.planetary(between="sun-housing")).updated(
        {"models.planet_tilt": "left-out"}
    )
    one = ep.solve(case)
    other = next(name for name in MEMBERS[1:] if name != member)
    speed = one.flow.members[other].speed * 30 / math.pi
    changed = case.updated(
        {"operation.second_input": other, "operation.second_speed": f"{speed!r} rpm"}
    )
    two = ep.solve(stated_at(changed, member, one))
    assert two.losses == pytest.approx(one.losses, abs=SAME * one.input_power)


@pytest.mark.parametrize("torque", [300.0, -250.0])
@pytest.mark.parametrize(
    ("driver", "held"), [("sun", "ring"), ("ring", "sun"), ("carrier", "sun"), ("sun", "carrier")]
)
def test_each_mesh_keeps_its_share_of_the_power_that_reaches_it(talbot, driver, held, torque):
    """With constant friction and an even load the shares are those of the loss factors, and power
    that has passed one mesh is less by its loss in the other."""
    kept = ("sun_mesh_sliding", "ring_mesh_sliding")
    names = type(talbot.losses).model_fields
    result = ep.solve(
        talbot.updated(
            {
                "operation.input": driver,
                "operation.fixed": held,
                "operation.torque": f"{torque} N*m",
                "models.friction": "constant",
                "models.mesh": "loss-factor",
                "models.load_distribution": "uniform",
                **{f"losses.{name}.include": False for name in names if name not in kept},
            }
        )
    )
    member = result.flow.members
    powers = {
        name: member[name].torque * (member[name].speed - member["carrier"].speed)
        for name in ("sun", "ring")
    }
    losses = {name: result.losses[f"{name}_mesh_sliding"] for name in powers}
    first, second = sorted(powers, key=lambda name: -powers[name])
    # H_V of this set, worked out separately, times the friction of 0.04
    shares = {"sun": 0.04 * 0.096532, "ring": 0.04 * 0.056502}
    reaching = powers[first], powers[first] - losses[first]
    assert losses[first] == pytest.approx(shares[first] * reaching[0], rel=1e-4)
    assert losses[second] == pytest.approx(shares[second] * reaching[1], rel=1e-4)
    assert powers[second] == pytest.approx(losses[second] - reaching[1], rel=1e-9)


def test_losses_are_continuous_in_the_torque_but_for_the_flank(talbot):
    """Steps only where a mesh changes its flank, by the difference of its pocketing losses."""
    changes = {
        "losses.sun_mesh_pocketing.include": False,
        "losses.ring_mesh_pocketing.include": False,
    }
    case = talbot.updated(changes)
    torques = [-1e-3, -1e-6, 0.0, 1e-6, 1e-3]
    totals = [ep.solve(case.updated({"operation.torque": f"{t!r} N*m"})).total for t in torques]
    for torque, total in zip(torques, totals, strict=True):
        # a slope of less than 10 W for each N m
        assert total == pytest.approx(totals[2], abs=1e-6 + 10 * abs(torque))
    # the drag of the sun, 1.3 W, is what unloads its mesh
    sun = ep.solve(case).losses["sun_drag"]
    unloaded = sun / (4000 * math.pi / 30)
    near = [unloaded * (1 + side * 1e-9) for side in (-1, 1)]
    below, above = (
        ep.solve(case.updated({"operation.torque": f"{t!r} N*m"})).losses["sun_mesh_sliding"]
        for t in near
    )
    assert below < 1e-3
    assert above < 1e-3


def test_a_set_of_given_loads_does_not_react_on_its_own_losses(talbot):
    """As in Talbot (2012), Eq. 3.7: 3341 W stated at the sun, 3318 W at the carrier."""
    case = talbot.updated(
        {
            "models.mesh_loads": "without-losses",
            "models.pocketing": "mean-density",
            "planet.mass": "0 kg",
        }
    )
    one = ep.solve(case)
    two = ep.solve(stated_at(case, "carrier", one))
    assert one.total == pytest.approx(3341, abs=0.5)
    assert two.total == pytest.approx(3318, abs=0.5)
