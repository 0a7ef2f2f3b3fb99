"""Trains as files: read, written, changed, copied, and what the JSON Schema says of them."""

from __future__ import annotations

import pickle
import tomllib

import jsonschema
import pytest

import epicyclic as ep
import listed_trains
from epicyclic.case.case import build_case, case_schema
from epicyclic.schema.fields import find_field, quantity_of
from epicyclic.show.template import case_text
from trains import published, wolfrom

SAME = 1e-12
"""Rounding of balances with bodies in another order."""
TRAINS = {
    "8hp70": "train-8hp70",
    "eaxle": "train-eaxle",
    "6hp26": published("6hp26"),
    "simpson": published("simpson"),
    "wolfrom": wolfrom(12, 33, 78, 30, 75),
}


@pytest.fixture(params=TRAINS)
def train(request):
    return ep.load_case(TRAINS[request.param])


def test_inputs_are_the_same_train_again(train):
    again = ep.load_case(train.inputs())
    assert again.inputs() == train.inputs()
    assert ep.load_case(again.given()) == again


def test_commented_files_hold_every_gear(train):
    again = build_case(tomllib.loads(case_text(train.given(), [], {})), {}, "")
    assert again == train


@pytest.mark.parametrize("name", listed_trains.__all__)
def test_commented_files_hold_every_listed_gear(name):
    tables = getattr(listed_trains, name)()
    again = build_case(tomllib.loads(case_text(tables, [], {})), {}, "")
    assert again == ep.load_case(tables)


def test_the_json_schema_accepts_trains(train):
    validator = jsonschema.Draft202012Validator(case_schema())
    assert list(validator.iter_errors(train.inputs())) == []
    wrong = train.inputs() | {"operation": {"input": "input"}}
    assert list(validator.iter_errors(wrong))


def test_trains_survive_pickling(train):
    again = pickle.loads(pickle.dumps(train))
    assert again == train
    assert hash(again) == hash(train)
    assert again.source == train.source


def test_keys_below_sets_are_found_with_their_units():
    kind = type(ep.load_case("train-eaxle"))
    field = find_field(kind, "sets.pair.pinion.roughness")
    assert quantity_of(*field).display == "um"
    assert find_field(kind, "sets.pair.pinion.ruffness") is None
    assert quantity_of(*find_field(kind, "bearings.motor_front.position")).display == "mm"


def test_updated_changes_single_keys():
    train = ep.load_case("train-8hp70")
    changed = train.updated({"sets.P1.efficiency": 0.9, "operation.state": 2})
    assert changed.sets["P1"].efficiency == 0.9
    assert changed.operation.state == "2"
    assert train.sets["P1"].efficiency == 0.98
    with pytest.raises(ep.InputError, match="not a known key"):
        train.updated({"sets.P1.efficency": 0.9})


def test_a_train_of_one_set_is_that_set():
    alone = ep.load_case("talbot-2012")
    tables = alone.given()
    own = (
        "gears",
        "sun",
        "planet",
        "ring",
        "planet_bearing",
        "carrier",
        "thrust_bearing",
        "models",
    )
    train = ep.load_case(
        {
            "kind": "train",
            "sets": {"S": {key: tables[key] for key in own if key in tables}},
            "shafts": {"in": ["S.sun"], "out": ["S.carrier"], "housing": ["S.ring"]},
            "operation": {
                "input": "in",
                "output": "out",
                "torque": tables["operation"]["torque"],
                "speed": tables["operation"]["speed"],
                "oil_inlet_temperature": tables["operation"]["oil_inlet_temperature"],
            },
            "lubricant": tables["lubricant"],
            "surroundings": tables.get("surroundings", {}),
        }
    )
    for torque in ("1000 N*m", "-340 N*m", "0 N*m"):
        one = ep.solve(alone.updated({"operation.torque": torque}))
        other = ep.solve(train.updated({"operation.torque": torque}))
        assert other.losses == pytest.approx(
            {f"S.{name}": loss for name, loss in one.losses.items()}, rel=SAME
        )
        assert other.efficiency == pytest.approx(one.efficiency, rel=SAME)
        assert other.flow.members["out"].torque == pytest.approx(
            one.flow.members["carrier"].torque, rel=SAME
        )
        assert other.meshes["S.sun_mesh"].film_ratio_min == pytest.approx(
            one.meshes["sun_mesh"].film_ratio_min, nan_ok=True, rel=SAME
        )
