"""Speeds, torques and power flow."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from epicyclic.kinematics import (
    MEMBERS,
    lossless_torques,
    pair_power_flow,
    planet_speed,
    planetary_power_flow,
    planetary_speeds,
)
from epicyclic.reference.planetary import planetary_efficiency

ROUNDING = 1e-12  # relative; a few roundings of doubles
RPM = math.pi / 30

SETS = [(73, 125), (20, 82), (60, 61), (99, 201)]
CHOICES = list(itertools.permutations(MEMBERS, 2))


def output_of(driver, held):
    (name,) = set(MEMBERS) - {driver, held}
    return name


@pytest.mark.parametrize(("z_s", "z_r"), SETS)
@pytest.mark.parametrize(("driver", "held"), CHOICES)
def test_ratio_is_that_of_the_textbook(z_s, z_r, driver, held):
    speeds = planetary_speeds(z_s, z_r, {driver: 100.0, held: 0.0})
    # Mueller, Epicyclic Drive Trains: speed ratio driver/output with one member held
    ratios = {
        ("sun", "ring"): 1 + z_r / z_s,
        ("sun", "carrier"): -z_r / z_s,
        ("ring", "sun"): 1 + z_s / z_r,
        ("ring", "carrier"): -z_s / z_r,
        ("carrier", "ring"): z_s / (z_s + z_r),
        ("carrier", "sun"): z_r / (z_s + z_r),
    }
    output = speeds[output_of(driver, held)]
    assert 100.0 / output == pytest.approx(ratios[driver, held], rel=ROUNDING)
    assert speeds[held] == 0.0
    assert list(speeds) == list(MEMBERS)


def test_speeds_of_the_test_article():
    speeds = planetary_speeds(73, 125, {"sun": 4000 * RPM, "ring": 0.0})
    # Talbot (2012) omega_c = omega_s 73/198
    assert speeds["carrier"] / RPM == pytest.approx(4000 * 73 / 198, rel=ROUNDING)
    # worked out separately: the planet bearing turns at 7090 rpm, planets at 5615 rpm absolute
    relative = planet_speed(73, 26, speeds)
    assert abs(relative) / RPM == pytest.approx(7090, abs=0.5)
    assert abs(relative + speeds["carrier"]) / RPM == pytest.approx(5615, abs=0.5)
    assert relative < 0 < speeds["carrier"]


@pytest.mark.parametrize(("z_s", "z_r"), SETS)
def test_willis_holds_relative_to_the_carrier(z_s, z_r):
    speeds = planetary_speeds(z_s, z_r, {"sun": 313.0, "ring": -47.0})
    ratio = (speeds["sun"] - speeds["carrier"]) / (speeds["ring"] - speeds["carrier"])
    assert ratio == pytest.approx(-z_r / z_s, rel=1e-11)
    # the planet rolls in the ring: z_p omega_p' = z_r omega_r'
    z_p = (z_r - z_s) // 2 or 1
    own = planet_speed(z_s, z_p, speeds)
    ring = (speeds["ring"] - speeds["carrier"]) * z_r / z_p
    assert own == pytest.approx(ring, rel=1e-11)


@pytest.mark.parametrize(("z_s", "z_r"), SETS)
def test_any_two_speeds_give_the_third(z_s, z_r):
    speeds = planetary_speeds(z_s, z_r, {"sun": 200.0, "carrier": -30.0})
    for two in itertools.combinations(MEMBERS, 2):
        again = planetary_speeds(z_s, z_r, {name: speeds[name] for name in two})
        assert again == pytest.approx(speeds, rel=1e-11)


@pytest.mark.parametrize(("z_s", "z_r"), SETS)
@pytest.mark.parametrize("member", MEMBERS)
def test_lossless_torques_balance_and_pass_power_on(z_s, z_r, member):
    torques = lossless_torques(z_s, z_r, member, 500.0)
    assert torques[member] == 500.0
    assert sum(torques.values()) == pytest.approx(0.0, abs=1e-10)
    assert torques["ring"] / torques["sun"] == pytest.approx(z_r / z_s, rel=ROUNDING)
    for two in ({"sun": 100.0, "ring": 0.0}, {"sun": -20.0, "carrier": 90.0}):
        speeds = planetary_speeds(z_s, z_r, two)
        power = sum(torques[name] * speeds[name] for name in MEMBERS)
        assert power == pytest.approx(0.0, abs=1e-8)


def flow_of(driver, held, torque, speed, loss, held_speed=0.0, z_s=73, z_r=125):
    speeds = planetary_speeds(z_s, z_r, {driver: speed, held: held_speed})
    return planetary_power_flow(z_s, z_r, speeds, driver, held, torque, loss)


def assert_balanced(flow, loss):
    powers = [member.power for member in flow.members.values()]
    torques = [member.torque for member in flow.members.values()]
    assert sum(powers) == pytest.approx(loss, abs=1e-10 * max(1.0, *map(abs, powers)))
    assert sum(torques) == pytest.approx(0.0, abs=1e-10 * max(1.0, *map(abs, torques)))


@pytest.mark.parametrize(("driver", "held"), CHOICES)
@pytest.mark.parametrize("torque", [1000.0, -1000.0])
@pytest.mark.parametrize("speed", [400.0, -400.0])
def test_power_balance_closes_with_one_member_held(driver, held, torque, speed):
    flow = flow_of(driver, held, torque, speed, 3000.0)
    assert_balanced(flow, 3000.0)
    assert flow.members[driver].torque == torque
    assert flow.members[held].power == 0.0
    output = flow.members[output_of(driver, held)]
    if torque * speed > 0:  # drives
        assert flow.input_power == pytest.approx(400e3, rel=ROUNDING)
        assert output.power == pytest.approx(-397e3, rel=ROUNDING)
        assert flow.efficiency == pytest.approx(397 / 400, rel=ROUNDING)
    else:  # coasts: 400 kW leave through the member of given torque
        assert output.power == pytest.approx(403e3, rel=ROUNDING)
        assert flow.input_power == pytest.approx(403e3, rel=ROUNDING)
        assert flow.efficiency == pytest.approx(400 / 403, rel=ROUNDING)


@pytest.mark.parametrize(("driver", "held"), CHOICES)
@pytest.mark.parametrize("second", [150.0, -150.0, 800.0])
@pytest.mark.parametrize("torque", [1000.0, -1000.0])
def test_power_balance_closes_with_two_driven_members(driver, held, second, torque):
    flow = flow_of(driver, held, torque, 400.0, 2500.0, held_speed=second)
    assert_balanced(flow, 2500.0)
    assert flow.members[held].speed == second
    lossless = lossless_torques(73, 125, driver, torque)
    # small losses turn no power round: what enters and what leaves is seen at the members
    for name, member in flow.members.items():
        assert lossless[name] * member.speed * member.power > 0
    entering = sum(max(0.0, member.power) for member in flow.members.values())
    leaving = -sum(min(0.0, member.power) for member in flow.members.values())
    assert flow.input_power == pytest.approx(entering, rel=ROUNDING)
    assert flow.efficiency == pytest.approx(leaving / entering, rel=1e-10)


@pytest.mark.parametrize(("driver", "held"), CHOICES)
def test_losses_load_the_output_as_the_efficiency_of_the_set_says(driver, held):
    """Loss of the meshes relative to the carrier, put in by hand: closed form of Mueller."""
    z_s, z_r, mesh_loss = 73, 125, 0.01
    speeds = planetary_speeds(z_s, z_r, {driver: 400.0, held: 0.0})
    lossless = lossless_torques(z_s, z_r, driver, 1000.0)
    through_meshes = abs(lossless["sun"] * (speeds["sun"] - speeds["carrier"]))
    flow = flow_of(driver, held, 1000.0, 400.0, mesh_loss * through_meshes)
    expected = planetary_efficiency(z_s, z_r, mesh_loss, held)
    assert flow.efficiency == pytest.approx(expected, rel=ROUNDING)


def test_zero_speed_and_zero_torque():
    at_rest = flow_of("sun", "ring", 1000.0, 0.0, 0.0)
    assert at_rest.input_power == 0.0
    assert at_rest.efficiency is None
    # at rest the torques are those of the lever
    assert at_rest.members["carrier"].torque == pytest.approx(-1000 * 198 / 73, rel=ROUNDING)
    assert at_rest.members["ring"].torque == pytest.approx(1000 * 125 / 73, rel=ROUNDING)
    idle = flow_of("sun", "ring", 0.0, 400.0, 100.0)
    assert idle.efficiency is None
    # 0 N m on the sun: the carrier has to be driven with the whole loss
    assert idle.members["carrier"].power == pytest.approx(100.0, rel=ROUNDING)
    assert_balanced(idle, 100.0)


def test_locked_up_set_turns_as_one_body():
    flow = flow_of("sun", "ring", 1000.0, 400.0, 0.0, held_speed=400.0)
    assert flow.members["carrier"].speed == pytest.approx(400.0, rel=ROUNDING)
    assert_balanced(flow, 0.0)
    assert flow.members["carrier"].torque == pytest.approx(-1000 * 198 / 73, rel=ROUNDING)
    assert flow.efficiency == 1.0


@given(
    speed=st.floats(-3000.0, 3000.0),
    difference=st.floats(-1.0, 1.0),
    torque=st.floats(-1e4, 1e4),
    friction=st.floats(0.0, 0.05),
    choice=st.sampled_from(CHOICES),
)
def test_torques_near_lock_up_are_those_of_the_lever(speed, difference, torque, friction, choice):
    """The loss falls with the relative speed: the torques keep within friction of the lever's."""
    driver, held = choice
    speeds = planetary_speeds(73, 125, {driver: speed, held: speed + difference})
    assert max(speeds.values()) - min(speeds.values()) <= 2.8 * abs(difference)
    relative = abs(speeds["sun"] - speeds["carrier"])
    lossless = lossless_torques(73, 125, driver, torque)
    loss = friction * abs(lossless["sun"]) * relative
    flow = planetary_power_flow(73, 125, speeds, driver, held, torque, loss)
    for name, member in flow.members.items():
        # 198/73: greatest ratio of the relative speed to that of output and held member
        bound = friction * abs(lossless["sun"]) * 198 / 73
        assert abs(member.torque - lossless[name]) <= bound * (1 + 1e-6) + 1e-9 * abs(torque)


def test_loss_above_the_power_passed_on_gives_efficiency_zero():
    flow = flow_of("sun", "ring", 1.0, 100.0, 250.0)
    assert flow.efficiency == 0.0
    assert flow.members["carrier"].power == pytest.approx(150.0, rel=ROUNDING)
    assert_balanced(flow, 250.0)


@pytest.mark.parametrize("internal", [False, True])
@pytest.mark.parametrize("torque", [200.0, -200.0])
@pytest.mark.parametrize("speed", [300.0, -300.0])
def test_pair_balances_its_power(internal, torque, speed):
    flow = pair_power_flow(2.5, internal, torque, speed, 600.0)
    pinion, gear = flow.members["pinion"], flow.members["gear"]
    assert pinion.power + gear.power == pytest.approx(600.0, rel=1e-10)
    # rings turn with their pinion, external gears against it
    assert gear.speed == pytest.approx(speed / (2.5 if internal else -2.5), rel=ROUNDING)
    entering = 60e3 if torque * speed > 0 else 60.6e3
    assert flow.input_power == pytest.approx(entering, rel=ROUNDING)
    assert flow.efficiency == pytest.approx(1 - 600 / entering, rel=ROUNDING)


@pytest.mark.parametrize("internal", [False, True])
def test_pair_at_rest_has_the_torques_of_the_lever(internal):
    flow = pair_power_flow(2.5, internal, 200.0, 0.0, 0.0)
    moving = pair_power_flow(2.5, internal, 200.0, 300.0, 0.0)
    assert flow.members["gear"].torque == pytest.approx(moving.members["gear"].torque, rel=ROUNDING)
    assert abs(flow.members["gear"].torque) == pytest.approx(500.0, rel=ROUNDING)
    assert flow.efficiency is None


DRAGS = {"sun": 60.0, "ring": 0.0, "carrier": 40.0}


def flow_with_drag(driver, held, torque, speed, loss, drags, held_speed=0.0):
    speeds = planetary_speeds(73, 125, {driver: speed, held: held_speed})
    return planetary_power_flow(73, 125, speeds, driver, held, torque, loss, drags)


@pytest.mark.parametrize(("driver", "held"), CHOICES)
@pytest.mark.parametrize("torque", [1000.0, -1000.0])
def test_drag_acts_on_its_own_shaft(driver, held, torque):
    drags = {name: 0.0 if name == held else 10.0 * k for k, name in enumerate(MEMBERS, start=1)}
    flow = flow_with_drag(driver, held, torque, 400.0, 2000.0, drags)
    powers = sum(member.power for member in flow.members.values())
    assert powers == pytest.approx(2000.0 + sum(drags.values()), rel=1e-9)
    assert flow.members[driver].torque == pytest.approx(torque, rel=ROUNDING)
    # what is left of each torque without its own drag balances
    passed = [
        member.torque - (drags[name] / member.speed if member.speed else 0.0)
        for name, member in flow.members.items()
    ]
    assert sum(passed) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("held_speed", [400.0, 400.001, 399.0])
def test_lock_up_with_drag(held_speed):
    """100 W of drag at 400 rad/s are 0.25 N m, in lock-up and next to it."""
    flow = flow_with_drag("sun", "ring", 1000.0, 400.0, 0.0, DRAGS, held_speed)
    assert flow.members["carrier"].torque == pytest.approx(-1000 * 198 / 73, abs=1.0)
    powers = sum(member.power for member in flow.members.values())
    assert powers == pytest.approx(100.0, rel=1e-6)
