"""What cannot be about a train is told all at once, each problem once, with what to change."""

from __future__ import annotations

import copy

import pytest

import epicyclic as ep
from problems import only, problems_of
from trains import one_set, published, simple, wolfrom


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
    assert "not a gear" in found["sets.P2.meshes[4]"]


def test_mistakes_of_all_kinds_are_told_at_once():
    """Wrong members and meshes hide neither a brake on the input nor a place that is missing."""
    tables = copy.deepcopy(dict(ep.load_case("train-eaxle").given()))
    rings = {name: {"teeth": teeth, "internal": True} for name, teeth in (("a", 61), ("b", 83))}
    tables["sets"]["spare"] = {"mesh_efficiency": 0.98, "meshes": [["a", "b"]], "gears": rings}
    tables["shafts"] |= {"differential": ["planets.carier"], "spare": ["spare.a", "spare.a"]}
    tables["states"] = {"1": {"fixed": ["motor"]}}
    tables["operation"]["state"] = "1"
    del tables["bearings"]["motor_rear"]["position"]
    found = told(tables)
    assert set(found) == {
        "operation.input",
        "sets.spare.meshes[0]",
        "shafts.differential",
        "shafts.spare",
        "bearings.motor_rear.position",
    }
    assert "held by a brake" in found["operation.input"]


def test_a_train_is_blocked_whatever_else_a_shaft_should_join():
    teeth = [{"sun": {"teeth": sun}, "ring": {"teeth": ring}} for sun, ring in ((30, 84), (33, 90))]
    tables = {
        "kind": "train",
        "sets": {"one": teeth[0] | {"efficiency": 0.98}, "two": teeth[1] | {"efficiency": 0.97}},
        "shafts": {
            "input": ["one.sun"],
            "middle": ["one.carrier", "two.sun"],
            "output": ["two.carrier"],
        },
        "states": {"low": {"fixed": ["one.ring", "middle", "two.ring"]}},
        "operation": {
            "state": "low",
            "input": "input",
            "output": "output",
            "speed": "1200 rpm",
            "torque": "70 N*m",
        },
    }
    assert "blocks the train" in told(tables)["operation.state"]
    tables["shafts"]["input"].append("two.rung")
    found = told(tables)
    assert "blocks the train" in found["operation.state"]
    assert "not a member" in found["shafts.input"]
    tables["states"]["low"]["fixed"].remove("middle")
    assert set(told(tables)) == {"shafts.input"}


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
    assert "not a member" in found["shafts.output", '"P2.rung"'].allowed
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
        (["wide", "fixed_ring"], "listed already"),
    ],
)
def test_gears_that_cannot_mesh(mesh, words):
    tables = wolfrom(12, 33, 78, 30, 75)
    tables["sets"]["W"]["meshes"].append(mesh)
    assert any(words in allowed for allowed in told(tables).values())


@pytest.mark.parametrize("teeth", [29, 30])
def test_a_ring_needs_more_teeth_than_the_gear_inside_it(teeth):
    tables = wolfrom(12, 33, 78, 30, 75)
    tables["sets"]["W"]["gears"]["output_ring"]["teeth"] = teeth
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
    assert "is not a state" in told(tables)["operation.state"]
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
    assert "has the same name as another part" in told(tables)["seals.motor_front"]


def test_computed_losses_need_an_oil_and_its_temperature():
    tables = copy.deepcopy(dict(ep.load_case("train-eaxle").given()))
    del tables["lubricant"]
    tables["operation"] = {
        key: value for key, value in tables["operation"].items() if key != "oil_inlet_temperature"
    }
    assert {"lubricant", "operation.oil_inlet_temperature"} <= told(tables).keys()


def with_clutch_to_a_take_off(**operation):
    """A set whose second state joins a shaft that has no members of its own."""
    tables = simple(30, 78, "ring", ("sun", "carrier"))
    tables["shafts"] = {"in": ["S.sun"], "out": ["S.carrier"], "held": ["S.ring"], "pto": []}
    tables["states"] = {
        "1": {"fixed": ["held"]},
        "2": {"fixed": ["held"], "joined": [["pto", "in"]]},
    }
    tables["operation"] |= {"state": "1"} | operation
    return tables


@pytest.mark.parametrize(
    ("key", "shaft", "words"),
    [
        ("torques", "pto", "it is not connected"),
        ("speeds", "pto", "it is not connected"),
        ("torques", "held", "is held"),
        ("torques", "housing", "is held"),
        ("torques", "out", "is the output"),
        ("speeds", "in", "is the input"),
    ],
)
def test_further_speeds_and_torques_of_shafts_that_have_none(key, shaft, words):
    unit = "rpm" if key == "speeds" else "N*m"
    tables = with_clutch_to_a_take_off(**{key: {shaft: f"5 {unit}"}})
    assert words in told(tables)[f"operation.{key}.{shaft}"]


def test_what_stands_on_a_shaft_that_is_joined_to_nothing_stands_still():
    tables = with_clutch_to_a_take_off(oil_inlet_temperature="60 degC")
    tables["lubricant"] = {"oil": "iso-vg-100-mineral"}
    tables["seals"] = {"seal": {"shaft": "pto", "diameter": "30 mm"}}
    assert ep.solve(ep.load_case(tables)).losses["seal.friction"] == 0.0
    tables["operation"]["state"] = "2"
    assert ep.solve(ep.load_case(tables)).losses["seal.friction"] > 0.0


def test_speeds_that_follow_from_others_cannot_be_given():
    tables = {
        "kind": "train",
        "sets": {
            "split": {"sun": {"teeth": 30}, "ring": {"teeth": 78}, "efficiency": 0.98},
            "pair": {"pinion": {"teeth": 23}, "gear": {"teeth": 53}, "efficiency": 0.985},
        },
        "shafts": {
            "engine": ["split.carrier"],
            "sun": ["split.sun"],
            "ring": ["split.ring", "pair.gear"],
            "motor": ["pair.pinion"],
        },
        "operation": {
            "input": "engine",
            "output": "sun",
            "torque": "100 N*m",
            "speed": "2000 rpm",
            "speeds": {"motor": "1000 rpm", "ring": "1000 rpm"},
        },
    }
    (key,) = told(tables)
    assert key in ("operation.speeds.ring", "operation.speeds.motor")
    tables["operation"]["speeds"] = {"motor": "1000 rpm", "pair.pinion": "900 rpm"}
    assert "is the same shaft" in told(tables)["operation.speeds.pair.pinion"]


def test_teeth_that_leave_no_room():
    tables = simple(30, 90, "ring", ("sun", "carrier"))
    tables["sets"] |= {
        "a": {"sun": {"teeth": 78}, "ring": {"teeth": 30}, "efficiency": 0.98},
        "b": {
            "sun": {"teeth": 30},
            "planet": {"teeth": 100},
            "ring": {"teeth": 78},
            "efficiency": 0.98,
        },
        "c": {"pinion": {"teeth": 20}, "gear": {"teeth": 15, "internal": True}, "efficiency": 1.0},
    }
    assert set(told(tables)) == {"sets.a.ring.teeth", "sets.b.planet.teeth", "sets.c.gear.teeth"}


@pytest.mark.parametrize(("ring", "fits"), [(60, True), (63, True), (65, False)])
def test_gears_of_given_efficiency_stand_at_one_distance(ring, fits):
    gears = {"sun": {"teeth": 19}, "planet": {"teeth": 20, "planet": True}}
    gears["ring"] = {"teeth": ring, "internal": True}
    meshes = [["sun", "planet"], ["planet", "ring"]]
    tables = one_set(gears, meshes, "ring", ("sun", "carrier"), 0.98)
    assert (told(tables) == {}) == fits
    if not fits:
        assert "39 with sun, 45 with ring" in told(tables)["sets.S.gears.planet.teeth"]
    del gears["ring"]["internal"]
    assert "internal = true" in only(problems_of(ep.load_case, tables)).remedy


def test_a_seal_is_on_a_shaft_that_turns():
    tables = copy.deepcopy(dict(ep.load_case("train-eaxle").given()))
    tables["seals"]["motor_seal"]["shaft"] = "housing"
    problem = only(problems_of(ep.load_case, tables))
    assert (problem.key, problem.remedy) == ("seals.motor_seal.shaft", "Name a shaft.")


def test_sizes_that_no_bearing_has():
    tables = copy.deepcopy(dict(ep.load_case("train-eaxle").given()))
    tables["bearings"]["motor_rear"] |= {"position": "0.06 mm", "outside_diameter": "710 mm"}
    found = told(tables)
    assert "0.06 mm from the other bearing of motor" in found["bearings.motor_front.position"]
    assert "1.03 to 6 times the bore" in found["bearings.motor_rear.outside_diameter"]
    assert len(found) == 2


def test_positions_are_those_of_gears_on_shafts():
    tables = copy.deepcopy(dict(ep.load_case("train-eaxle").given()))
    tables["positions"] = tables["positions"] | {"pair.pinon": "3 mm", "planets.planet": "4 mm"}
    found = told(tables)
    assert set(found) == {'positions."pair.pinon"', 'positions."planets.planet"'}


def test_names_are_not_empty():
    tables = simple(30, 90, "ring", ("sun", "carrier"))
    tables["sets"][" "] = tables["sets"]["S"]
    assert any("is not a valid name for a set" in allowed for allowed in told(tables).values())


@pytest.mark.parametrize(
    "name", ["\x1b[31m", "a\u2028b", "\x00", "\u202e", "tab\there", "two\nlines"]
)
def test_names_with_control_characters_are_told_in_one_printable_line(name):
    tables = eight_speed()
    tables["sets"][name] = tables["sets"].pop("P1")
    tables["states"][name] = {"fixed": [name]}
    tables["shafts"][name] = [f"{name}.sun", name]
    problems = problems_of(ep.load_case, tables)
    assert problems
    for problem in problems:
        assert str(problem).isprintable()


def test_a_key_that_is_no_text_is_a_problem():
    tables = eight_speed() | {"\ud800": {}}
    (problem,) = problems_of(ep.load_case, tables)
    assert str(problem).isprintable()
    assert "\\ud800" in str(problem)


@pytest.mark.parametrize(
    ("wrong", "others"),
    [
        ("sun.face_width", {"planet.tip_diameter"}),
        ("planet.count", {"sun.tip_diameter"}),
        ("ring.teeth", {"planet.tip_diameter", "sun.tip_diameter"}),
    ],
)
def test_a_gear_that_cannot_be_read_hides_no_mistake_of_the_others(wrong, others):
    case = ep.load_case("talbot-2012").given()
    case["sun"] |= {"tip_diameter": "120 mm", "root_diameter": "131 mm"}
    case["planet"] |= {"tip_diameter": "60 mm"}
    table, key = wrong.split(".")
    case[table] |= {key: "a lot"}
    keys = {key for together in told(case) for key in together.split(", ")}
    assert keys >= {wrong, *others}
    assert not any(key.startswith(f"{table}.") and key != wrong for key in keys)


def test_a_listed_gear_that_cannot_be_read_hides_no_mistake_of_the_others():
    gears = {
        "normal_module": "1 mm", "normal_pressure_angle": "20 deg", "helix_angle": "0 deg",
        "sun": {"teeth": 18, "face_width": "12 kg"},
        "wide": {"teeth": 36, "face_width": "11 mm", "body": "planet"},
        "still": {"teeth": 90, "face_width": "13 mm", "internal": True},
        "narrow": {"teeth": 33, "face_width": "14 mm", "body": "planet", "tip_diameter": "30 mm"},
        "turning": {"teeth": 87, "face_width": "15 mm", "internal": True},
    }  # fmt: skip
    for number, gear in enumerate(list(gears.values())[3:], 1):
        gear |= {"roughness": "0.4 um", "profile_shift_coefficient": number / 20}
    case = {
        "kind": "train",
        "sets": {"w": {"planets": 3, "gears": gears, "meshes": [
            ["sun", "wide"], ["wide", "still"], ["narrow", "turning"]]}},
        "shafts": {"in": ["w.sun"], "out": ["w.turning"], "housing": ["w.still"]},
        "lubricant": {"oil": "iso-vg-220-mineral"},
        "operation": {"input": "in", "output": "out", "torque": "40 N*m", "speed": "1500 rpm",
                      "oil_inlet_temperature": "60 degC"},
    }  # fmt: skip
    keys = {key for together in told(case) for key in together.split(", ")}
    assert keys >= {"sets.w.gears.sun.face_width", "sets.w.gears.narrow.tip_diameter"}
    assert not any(
        key.startswith("sets.w.gears.sun.") for key in keys - {"sets.w.gears.sun.face_width"}
    )


def test_a_set_without_its_table_is_told_where_the_sets_are():
    (problem,) = problems_of(ep.load_case, "train-8hp70", {"a.sun.teeth": 30})
    assert problem.remedy == "A set is sets.NAME, here sets.P1, sets.P2, sets.P3, sets.P4."
