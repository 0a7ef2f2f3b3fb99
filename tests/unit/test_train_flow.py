"""Power flow, sums of losses and states of trains: the balances behind tables and pictures."""

from __future__ import annotations

import math

import pytest

import epicyclic as ep
from epicyclic.show.power_flow import power_flow
from epicyclic.study.trains import loss_sums, train_states
from trains import published, simple, small_axle

GEARS = "12345678R"


@pytest.fixture(scope="module")
def eight_speeds():
    case = ep.load_case("train-8hp70")
    return {gear: ep.solve(case.updated({"operation.state": gear})) for gear in GEARS}


@pytest.fixture(scope="module")
def axle():
    return ep.solve(small_axle())


def assert_balanced(result):
    flow = power_flow(result)
    scale = result.input_power
    for key, stage in flow.stages.items():
        assert sum(link.power for link in flow.of_stage(key)) == pytest.approx(
            stage.loss, abs=1e-9 * scale
        )
        assert sum(link.torque for link in flow.of_stage(key)) == pytest.approx(
            0.0, abs=1e-9 * max(abs(link.torque) for link in flow.links)
        )
    for key, line in flow.lines.items():
        taken = sum(link.power for link in flow.of_line(key))
        assert taken == pytest.approx(line.power, abs=1e-9 * scale)
        assert sum(link.torque for link in flow.of_line(key)) == pytest.approx(
            line.torque, abs=1e-9 * max(1.0, line.passed)
        )


@pytest.mark.parametrize("gear", GEARS)
def test_every_set_and_shaft_of_a_gearbox_is_balanced(eight_speeds, gear):
    assert_balanced(eight_speeds[gear])


def test_every_set_bearing_and_seal_of_an_axle_is_balanced(axle):
    assert_balanced(axle)


@pytest.mark.parametrize("torque", ["-40 N*m", "0 N*m"])
def test_a_coasting_and_an_unloaded_axle_are_balanced(torque):
    result = ep.solve(small_axle(**{"operation.torque": torque}))
    flow = power_flow(result)
    scale = max(abs(member.power) for member in result.flow.members.values())
    for key, stage in flow.stages.items():
        power = sum(link.power for link in flow.of_stage(key))
        assert power == pytest.approx(stage.loss, abs=1e-9 * scale)


def test_the_torques_of_a_wolfrom_set_hold_its_ring():
    result = ep.solve(ep.load_case(published("wolfrom")))
    assert_balanced(result)
    ring = next(link for link in power_flow(result).links if link.members == ("fixed_ring",))
    outside = sum(member.torque for member in result.flow.members.values())
    assert ring.torque == pytest.approx(-outside)
    assert ring.power == 0.0


def test_what_circulates_flows_in_loops(eight_speeds):
    flow = power_flow(eight_speeds["R"])
    assert flow.circulating == pytest.approx(
        32515, rel=1e-4
    )  # P4 returns it to P3 through the output
    for key in (*flow.lines, *flow.stages):
        loops = [link.circulating for link in flow.links if key in (link.line, link.stage)]
        assert sum(loops) == pytest.approx(0.0, abs=1e-6)
    assert all(power_flow(eight_speeds[gear]).circulating == 0 for gear in "1234567")


def test_closed_clutches_make_one_line_of_two_shafts(eight_speeds):
    lines = power_flow(eight_speeds["1"]).lines
    line = lines["input+third"]
    assert (line.shafts, line.role) == (("input", "third"), "input")
    assert line.clutches == {"input+third": pytest.approx(300.0)}
    assert (lines["suns"].role, lines["first"].role, lines["second"].role) == (
        "held", "at rest", "idle",
    )  # fmt: skip


def test_a_single_set_is_one_stage():
    result = ep.solve(ep.load_case("talbot-2012-pair").updated({"operation.torque": "100 N*m"}))
    (stage,) = power_flow(result).stages.values()
    assert stage.loss == pytest.approx(result.total)


def test_losses_are_summed_by_set_and_kind(axle):
    losses = {term.name: term.watts for term in axle.terms if not term.left_out}
    sums = loss_sums(losses, axle.inputs)
    assert {
        stage: pytest.approx(sum(own.values())) for stage, own in sums.items()
    } == axle.stage_losses
    assert set(sums["planets"]) == {"sliding", "rolling", "bearings", "drag"}
    assert set(sums["motor_rear"]) == {"bearings"}
    assert set(sums["motor_seal"]) == {"seals"}


def test_losses_of_given_efficiency_are_one_kind(eight_speeds):
    sums = loss_sums(eight_speeds["1"].losses, eight_speeds["1"].inputs)
    assert sums["P4"] == {"given": pytest.approx(eight_speeds["1"].total)}


def test_the_states_of_a_gearbox_have_their_published_ratios():
    states = {state.name: state for state in train_states(ep.load_case("train-8hp70"))}
    wanted = (4.696, 3.130, 2.104, 1.667, 1.285, 1.000, 0.839, 0.667, -3.297)
    for gear, ratio in zip(GEARS, wanted, strict=True):
        assert states[gear].ratio == pytest.approx(ratio, abs=1e-3)
    assert states["6"].speeds == {shaft: pytest.approx(1.0) for shaft in states["6"].speeds}


@pytest.mark.parametrize(
    ("changes", "remark"),
    [
        ({"states.8.fixed": ["suns", "input"]}, "blocked: input is held"),
        ({"states.8.fixed": ["suns", "P1.ring", "second"]}, "blocked: input cannot turn"),
        ({"states.8.fixed": ["suns"], "states.8.joined": []}, "neutral: output is free to turn"),
        (
            {"states.8.fixed": ["suns", "output", "P1.ring"], "states.8.joined": []},
            "output stands still",
        ),
    ],
)
def test_a_state_without_a_ratio_says_why(changes, remark):
    state = train_states(ep.load_case("train-8hp70").updated(changes))[-2]
    assert state.ratio is None
    assert state.remark.startswith(remark)


def test_shafts_that_a_state_leaves_free_are_named():
    case = ep.load_case("train-8hp70").updated(
        {"states.8.fixed": ["suns", "P1.ring"], "states.8.joined": [["input", "third"]]}
    )
    assert train_states(case)[-2].ratio == pytest.approx(4.6957, abs=1e-4)
    free = ep.load_case("train-8hp70").updated({"states.8.joined": [["input", "output"]]})
    state = train_states(free)[-2]
    assert (state.ratio, state.remark.partition(":")[0]) == (pytest.approx(1.0), "free to turn")
    assert any(math.isnan(speed) for speed in state.speeds.values())


def test_a_train_without_states_has_one():
    (state,) = train_states(ep.load_case(simple(23, 85, "ring", ("sun", "carrier"))))
    assert (state.name, state.ratio) == ("", pytest.approx(1 + 85 / 23))
