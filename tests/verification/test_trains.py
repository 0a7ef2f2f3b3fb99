"""Ratios, efficiencies and power flow of trains with given efficiency: closed forms, symmetries."""

from __future__ import annotations

import copy
import itertools

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.show.power_flow import power_flow
from trains import double_planet, one_set, plus, published, simple, stepped, turned_round, wolfrom

ROUNDING = 1e-11  # relative; a few roundings of a small linear system
PRINTED = 6e-6  # the reference values have five digits


def solved(train, **changes):
    return ep.solve(ep.load_case(train).updated(changes))


def balances(result, limit=1e-10):
    """The powers of all shafts sum to the loss."""
    powers = [member.power for member in result.flow.members.values()]
    return abs(sum(powers) - result.total) <= limit * max(map(abs, powers))


@pytest.mark.parametrize(("sun", "ring"), [(23, 85), (48, 96), (31, 101)])
def test_simple_sets_have_the_efficiencies_of_the_closed_forms(sun, ring):
    """H. W. Mueller, Epicyclic Drive Trains (1982): from that with the carrier at rest."""
    eta, ratio = 0.99**2, ring / sun
    cases = {
        ("ring", "sun", "carrier"): (1 + ratio, (1 + eta * ratio) / (1 + ratio)),
        ("sun", "ring", "carrier"): (1 + 1 / ratio, (1 + eta / ratio) / (1 + 1 / ratio)),
        ("ring", "carrier", "sun"): (1 / (1 + ratio), (1 + ratio) / (1 + ratio / eta)),
        ("carrier", "sun", "ring"): (-ratio, eta),
    }
    for (held, driven, output), (expected, efficiency) in cases.items():
        result = solved(simple(sun, ring, held, (driven, output)))
        assert result.train.ratio == pytest.approx(expected, rel=ROUNDING)
        assert result.efficiency == pytest.approx(efficiency, rel=ROUNDING)
        assert balances(result)


@pytest.mark.parametrize(
    ("train", "ratio", "efficiency"),
    [
        (stepped(20, 50, 22, 92, "ring", ("sun", "carrier")), 11.4545, 0.981837),
        (double_planet(40, 80, "ring", ("sun", "carrier")), -1.0, 0.940598),
        (double_planet(40, 80, "ring", ("carrier", "sun")), -1.0, 0.942311),
        (plus(99, 100, 101, 100, "B", ("carrier", "A")), -9999.0, 0.004901),
        (plus(40, 41, 42, 41, "B", ("carrier", "A")), -1680.0, 0.028465),
    ],
)
def test_sets_with_listed_meshes_have_those_of_theirs(train, ratio, efficiency):
    result = solved(train)
    assert result.train.ratio == pytest.approx(ratio, rel=PRINTED)
    # the last two are printed with six decimals, of which four or five are digits
    assert result.efficiency == pytest.approx(efficiency, rel=PRINTED, abs=6e-7)
    assert balances(result)


@pytest.mark.parametrize(
    ("teeth", "ratio", "efficiency"),
    [((99, 100, 101, 100), -9999.0, 0.004901), ((40, 41, 42, 41), -1680.0, 0.028465)],
)
def test_plus_sets_pass_little_forwards_and_lock_backwards(teeth, ratio, efficiency):
    """Two solutions agree with themselves near self-locking; that of the lossless signs counts."""
    working = solved(plus(*teeth, "B", ("carrier", "A")))
    locked = solved(plus(*teeth, "B", ("A", "carrier")))
    assert working.train.ratio == pytest.approx(ratio, rel=1e-9)
    assert locked.train.ratio == pytest.approx(1 / ratio, rel=1e-9)
    assert working.efficiency == pytest.approx(efficiency, abs=6e-7)
    assert not working.train.self_locking
    assert locked.train.self_locking
    assert locked.efficiency == 0.0
    assert any("Self-locking" in warning for warning in locked.warnings)
    # the output must be driven too: power enters there
    output = locked.flow.members[locked.train.output]
    assert output.power > 0
    assert balances(locked)
    assert balances(working)


WOLFROM = [
    ((12, 33, 78, 30, 75), 137.5, (0.7307, 0.6369, 26.9), (0.8452, 0.8182, 31.0)),
    ((14, 25, 64, 22, 61), 72.619, (0.7936, 0.7433, 20.6), (0.8855, 0.8715, 22.9)),
    ((21, 20, 61, 18, 59), 56.1905, (0.7779, 0.7173, 22.2), (0.8756, 0.8587, 24.9)),
]


@pytest.mark.parametrize(("teeth", "ratio", "at_99", "at_995"), WOLFROM)
def test_wolfrom_sets(teeth, ratio, at_99, at_995):
    """Found before with a nodal solver of its own, printed with four digits."""
    for eta, (forward, backward, power_ratio) in ((0.99, at_99), (0.995, at_995)):
        train = wolfrom(*teeth, efficiency=eta)
        result = solved(train)
        assert result.train.ratio == pytest.approx(ratio, rel=1e-6)
        assert result.efficiency == pytest.approx(forward, abs=6e-5)
        assert result.train.power_ratio == pytest.approx(power_ratio, abs=0.06)
        back = solved(turned_round(train))
        assert back.efficiency == pytest.approx(backward, abs=6e-5)
        assert back.train.ratio == pytest.approx(1 / ratio, rel=1e-6)
        assert balances(result)
        assert balances(back)


@pytest.mark.parametrize(
    ("name", "state", "efficiency"),
    [
        *zip(
            itertools.repeat("6hp26"),
            "123456R",
            (0.96368, 0.97694, 0.99318, 0.99397, 0.99553, 0.99377, 0.97342),
            strict=False,
        ),
        ("simpson", "1", 0.98026),
        ("simpson", "2", 0.99355),
        ("simpson", "R", 0.98010),
    ],
)
def test_efficiencies_of_transmissions(name, state, efficiency):
    """Found with a nodal solver of its own, 0.99 for every mesh, printed with five digits."""
    changes = {"operation.state": state}
    if (name, state) == ("simpson", "R"):
        changes["operation.input"] = "suns"
    result = solved(published(name), **changes)
    assert result.efficiency == pytest.approx(efficiency, abs=6e-6)
    assert balances(result)


def test_swapping_the_ends_is_solving_backwards():
    """What leaves at the output, put in there in the other sense, arrives at the input again."""
    for name, state in itertools.product(("6hp26",), "123456"):
        train = published(name)
        train["operation"]["state"] = state
        forward = solved(train)
        ends = forward.flow.members
        operation = train["operation"]
        output = ends[operation["output"]]
        stated_there = copy.deepcopy(train)
        stated_there["operation"] |= {
            "input": operation["output"],
            "output": operation["input"],
            "torque": f"{output.torque!r} N*m",
            "speed": f"{output.speed!r} rad/s",
        }
        again = solved(stated_there)
        assert again.total == pytest.approx(forward.total, rel=1e-9)
        assert again.flow.members[operation["input"]].torque == pytest.approx(
            ends[operation["input"]].torque, rel=1e-9
        )
        assert again.efficiency == pytest.approx(forward.efficiency, rel=1e-9)


def test_order_and_names_of_shafts_do_not_matter():
    train = published("6hp26")
    train["operation"]["state"] = "2"
    expected = solved(train)
    other = copy.deepcopy(train)
    other["shafts"] = {
        {"input": "z", "output": "a", "reduced": "m"}[name]: members
        for name, members in reversed(train["shafts"].items())
    }
    other["sets"] = dict(reversed(train["sets"].items()))
    other["sets"]["P2"]["meshes"] = [
        list(reversed(pair)) for pair in reversed(train["sets"]["P2"]["meshes"])
    ]
    other["operation"] |= {"input": "z", "output": "a"}
    for state in other["states"].values():
        state["joined"] = [
            [{"input": "z", "reduced": "m"}.get(name, name) for name in reversed(group)]
            for group in state.get("joined", [])
        ]
    found = solved(other)
    assert found.train.ratio == pytest.approx(expected.train.ratio, rel=ROUNDING)
    assert found.efficiency == pytest.approx(expected.efficiency, rel=ROUNDING)
    assert found.train.power_ratio == pytest.approx(expected.train.power_ratio, rel=ROUNDING)


def test_two_stages_in_series_have_the_product_of_their_efficiencies():
    one = {"sun": {"teeth": 23}, "ring": {"teeth": 85}, "efficiency": 0.97}
    train = {
        "kind": "train",
        "sets": {"first": one, "second": copy.deepcopy(one)},
        "shafts": {
            "in": ["first.sun"],
            "between": ["first.carrier", "second.sun"],
            "out": ["second.carrier"],
            "housing": ["first.ring", "second.ring"],
        },
        "operation": {"input": "in", "output": "out", "torque": "9 N*m", "speed": "700 rpm"},
    }
    alone = copy.deepcopy(train)
    del alone["sets"]["second"]
    alone["shafts"] = {"in": ["first.sun"], "out": ["first.carrier"], "housing": ["first.ring"]}
    single, both = solved(alone), solved(train)
    assert both.efficiency == pytest.approx(single.efficiency**2, rel=ROUNDING)
    assert both.train.ratio == pytest.approx(single.train.ratio**2, rel=ROUNDING)


def test_power_circulates_in_a_coupled_train_and_the_power_ratio_shows_it():
    result = solved(wolfrom(12, 33, 78, 30, 75))
    largest = max(map(abs, result.train.rolling.values()))
    assert largest > result.input_power
    total = sum(map(abs, result.train.rolling.values()))
    assert result.train.power_ratio == pytest.approx(total / result.input_power, rel=1e-12)


def test_clutch_torque_is_what_the_clutch_passes():
    """Gear 1 of the 8HP70: the input drives the sun of P4 through clutch C, nothing else."""
    result = solved({**ep.load_case("train-8hp70").given()})
    assert result.train.clutches["input+third"] == pytest.approx(300.0, rel=1e-9)


def test_torques_from_outside_on_further_shafts_take_part():
    """A power take-off on the middle shaft takes its torque before the second stage."""
    one = {"sun": {"teeth": 20}, "ring": {"teeth": 70}, "efficiency": 1.0}
    train = {
        "kind": "train",
        "sets": {"first": one, "second": one | {"ring": {"teeth": 82}}},
        "shafts": {
            "in": ["first.sun"],
            "between": ["first.carrier", "second.sun"],
            "out": ["second.carrier"],
            "housing": ["first.ring", "second.ring"],
        },
        "operation": {
            "input": "in",
            "output": "out",
            "torque": "10 N*m",
            "speed": "900 rpm",
            "torques": {"between": "-4 N*m"},
        },
    }
    result = solved(train)
    # 10 N m times 4.5, less 4 N m, times 5.1
    assert result.flow.members["out"].torque == pytest.approx(-(10 * 4.5 - 4) * 5.1, rel=1e-12)
    assert result.total == pytest.approx(0.0, abs=1e-9)
    assert power_flow(result).lines["between"].role == "loaded"
    driven = solved(train, **{"operation.torques": {"between": "3 N*m"}})
    assert power_flow(driven).lines["between"].role == "driven"


def test_an_input_shaft_that_only_clutches_join():
    """The Simpson set again, as a transmission has it: nothing is on its input shaft for good."""
    train = published("simpson")
    train["shafts"] |= {"turbine": [], "spare": []}
    train["operation"]["input"] = "turbine"
    train["states"] = {
        "1": {"fixed": ["rear.carrier"], "joined": [["turbine", "front.ring"]]},
        "3": {"joined": [["front.ring", "turbine", "suns"]], "fixed": ["spare"]},
        "R": {"fixed": ["rear.carrier"], "joined": [["suns", "turbine"]]},
    }
    for state, ratio in (("1", 2.479452), ("3", 1.0), ("R", -2.085714)):
        result = solved(train, **{"operation.state": state})
        assert result.train.ratio == pytest.approx(ratio, rel=1e-6)
        assert result.flow.members["spare"].speed == 0.0
        assert balances(result)
    assert solved(train).train.clutches["turbine+front.ring"] == pytest.approx(200.0)


def test_second_driven_shaft_of_a_set_with_two_freedoms():
    train = simple(30, 90, "ring", ("sun", "carrier"))
    train["shafts"] = {"in": ["S.sun"], "out": ["S.carrier"], "second": ["S.ring"]}
    train["operation"]["speeds"] = {"second": "-200 rpm"}
    result = solved(train)
    willis = (30 * 1300 + 90 * -200) / 120
    assert result.flow.members["out"].speed * 30 / np.pi == pytest.approx(willis, rel=1e-12)
    assert balances(result)


def test_fixed_axes_are_a_listed_set_without_planets():
    gears = {"a": {"teeth": 20}, "idler": {"teeth": 33}, "b": {"teeth": 50}}
    train = one_set(gears, [["a", "idler"], ["idler", "b"]], "none", ("a", "b"))
    del train["sets"]["S"]["planets"], train["shafts"]["housing"]
    result = solved(train)
    assert result.train.ratio == pytest.approx(2.5, rel=1e-12)
    assert result.efficiency == pytest.approx(0.99**2, rel=1e-12)


@pytest.mark.slow
def test_an_axle_loses_power_without_a_kink_up_to_25000_rpm():
    """Terms of drag grow with exponents from those of laminar discs to those of form drag."""
    speeds = np.geomspace(5000, 25000, 9)
    results = [solved("train-eaxle", **{"operation.speed": f"{rpm} rpm"}) for rpm in speeds]
    assert all(balances(result) for result in results)
    drags = [name for name, watts in results[0].losses.items() if "drag" in name and watts]
    assert {"pair.drag", "planets.planets_drag", "planets.carrier_drag"} <= set(drags)
    for name in drags:
        watts = [result.losses[name] for result in results]
        exponents = np.diff(np.log(watts)) / np.diff(np.log(speeds))
        assert np.all((exponents > 2.5) & (exponents < 3.0)), name
        assert np.all(np.abs(np.diff(exponents)) < 0.03), name
    for name, watts in results[0].losses.items():
        if watts and not name.endswith("_pocketing"):  # these choke at the speed of sound
            own = [result.losses[name] for result in results]
            exponents = np.diff(np.log(own)) / np.diff(np.log(speeds))
            assert np.all(np.abs(np.diff(exponents)) < 0.1), name
