"""What cannot be about a train is told all at once, each problem once, with what to change."""

from __future__ import annotations

import copy

import pytest

import epicyclic as ep
from problems import problems_of
from trains import published, simple, wolfrom


def told(tables):
    """Keys and first words of the problems of a train."""
    return {problem.key: problem.allowed for problem in problems_of(ep.load_case, tables)}


def eight_speed():
    return copy.deepcopy(dict(ep.load_case("train-8hp70").given()))


def test_many_mistakes_are_told_at_once():
    tables = published("6hp26")
    tables["operation"]["torque"] = "300"
    tables["sets"]["P1"]["mesh_efficiency"] = 1.2
    tables["sets"]["P1"]["ring"]["teeht"] = 5
    tables["sets"]["P2"]["meshes"].append(["narrow", "ring"])
    tables["shafts"]["odd"] = ["P1.suns", "P1.sun"]
    found = told(tables)
    assert set(found) == {
        "operation.torque",
        "sets.P1.mesh_efficiency",
        "sets.P1.ring.teeht",
        "sets.P2.meshes[4]",
    }
    assert "<= 1" in found["sets.P1.mesh_efficiency"]
    assert "no gear" in found["sets.P2.meshes[4]"]


def test_members_of_shafts():
    tables = published("6hp26")
    tables["shafts"] |= {
        "input": ["P1.ring", "P1.ring"],
        "output": ["P2.ring", "P2.rung"],
        "more": ["P2.ring"],
        "planets": ["P2.long_planet"],
    }
    found = {(one.key, one.value): one for one in problems_of(ep.load_case, tables)}
    assert "to itself" in found["shafts.input", '"P1.ring"'].allowed
    assert "no member" in found["shafts.output", '"P2.rung"'].allowed
    assert "P2.ring" in found["shafts.output", '"P2.rung"'].remedy
    assert "belongs to the shaft output" in found["shafts.more", '"P2.ring"'].allowed
    assert "is a planet" in found["shafts.planets", '"P2.long_planet"'].allowed
    assert len(found) == 4


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (["sun", "sun"], "with itself"),
        (["wide", "narrow"], "turn with the body planet"),
        (["fixed_ring", "output_ring"], "both are ring gears"),
        (["sun", "fixed_ring"], "both turn about the axis"),
        (["wide", "fixed_ring"], "listed before"),
    ],
)
def test_gears_that_cannot_mesh(mesh, words):
    tables = wolfrom(12, 33, 78, 30, 75)
    tables["sets"]["W"]["meshes"].append(mesh)
    assert any(words in allowed for allowed in told(tables).values())


def test_a_ring_needs_more_teeth_than_the_gear_inside_it():
    tables = wolfrom(12, 33, 78, 30, 75)
    tables["sets"]["W"]["gears"]["output_ring"]["teeth"] = 29
    (allowed,) = told(tables).values()
    assert "more than narrow with 30" in allowed


def test_a_clutch_joins_two_different_shafts():
    tables = eight_speed()
    tables["states"]["1"] = {"fixed": ("suns",), "joined": (("third", "third"), ("output",))}
    found = told(tables)
    assert "to itself" in found["states.1.joined[0]"]
    assert "two or more" in found["states.1.joined[1]"]


def test_brakes_hold_shafts_that_there_are():
    tables = eight_speed()
    tables["states"]["3"] = {"fixed": ("sun",)}
    (problem,) = problems_of(ep.load_case, tables)
    assert problem.key == "states.3.fixed[0]"
    assert "suns" in problem.remedy


@pytest.mark.parametrize("key", ["input", "output"])
def test_ends_must_be_able_to_turn(key):
    tables = eight_speed()
    tables["operation"][key] = "suns"
    found = told(tables)
    assert "held by a brake in state 1" in found[f"operation.{key}"]


def test_a_state_that_blocks_the_train_is_told_with_what_holds_it():
    """Both clutches of the Ravigneaux set and its brake: one too many."""
    tables = published("6hp26")
    tables["states"]["1"]["fixed"] = ["P1.sun", "P2.carrier", "P2.ring"]
    tables["operation"]["output"] = "P2.large_sun"
    (problem,) = problems_of(ep.load_case, tables)
    assert problem.key == "operation.state"
    assert "blocks the train" in problem.allowed
    assert "P1.sun, P2.carrier, output held" in problem.allowed


def test_too_much_freedom_is_told_by_the_shafts_that_are_loose():
    tables = eight_speed()
    tables["states"]["1"] = {"fixed": ("suns",)}
    (problem,) = problems_of(ep.load_case, tables)
    assert "2 degrees of freedom" in problem.allowed
    assert "P1.ring" in problem.allowed
    assert "planet" not in problem.allowed
    assert "[operation.speeds]" in problem.remedy


def test_an_output_that_the_input_does_not_turn():
    tables = simple(30, 90, "ring", ("sun", "carrier"))
    tables["sets"]["T"] = {"sun": {"teeth": 20}, "ring": {"teeth": 70}, "efficiency": 0.98}
    tables["shafts"]["housing"] += ["T.ring", "T.carrier"]
    tables["operation"]["output"] = "T.sun"
    (problem,) = problems_of(ep.load_case, tables)
    assert problem.key == "operation.output"
    assert "stands still" in problem.allowed
    assert "out" in problem.remedy


def test_states_are_named_when_one_is_missing_or_unknown():
    tables = eight_speed()
    tables["operation"]["state"] = "11"
    assert "is no state" in told(tables)["operation.state"]
    del tables["operation"]["state"]
    assert "must be one of 1, 2, 3" in told(tables)["operation.state"]


def test_set_needs_gears_and_an_efficiency_or_all_tables():
    tables = simple(30, 90, "ring", ("sun", "carrier"))
    tables["sets"]["empty"] = {"efficiency": 0.9}
    tables["sets"]["bare"] = {"sun": {"teeth": 30}, "ring": {"teeth": 90}}
    found = told(tables)
    assert "has no gears" in found["sets.empty"]
    assert "sets.bare.gears" in found
    assert "sets.bare.planet" in found


def test_positions_and_bearings_that_forces_need():
    tables = copy.deepcopy(dict(ep.load_case("train-eaxle").given()))
    tables["bearings"]["motor_rear"] = {
        key: value for key, value in tables["bearings"]["motor_rear"].items() if key != "position"
    }
    tables["positions"] = {"pair.gear": "35 mm"}
    tables["bearings"]["middle_front"] |= {"shaft": "midle"}
    found = told(tables)
    assert "bearings.motor_rear.position" in found
    assert 'positions."pair.pinion"' in found
    assert "is not a shaft" in found["bearings.middle_front.shaft"]


def test_names_of_parts_differ():
    tables = copy.deepcopy(dict(ep.load_case("train-eaxle").given()))
    tables["seals"]["motor_front"] = tables["seals"]["motor_seal"]
    assert "has the name of another part" in told(tables)["seals.motor_front"]


def test_computed_losses_need_an_oil_and_its_temperature():
    tables = copy.deepcopy(dict(ep.load_case("train-eaxle").given()))
    del tables["lubricant"]
    tables["operation"] = {
        key: value
        for key, value in tables["operation"].items()
        if key != "oil_inlet_temperature"
    }
    assert {"lubricant", "operation.oil_inlet_temperature"} <= told(tables).keys()
