"""Keys of one case, with the names that the user chose in it."""

from __future__ import annotations

import pytest

import epicyclic as ep
from epicyclic.case.keys import field_at, known_keys, value_of
from epicyclic.schema.fields import is_text
from problems import only, problems_of
from trains import stepped


@pytest.fixture(scope="module")
def gearbox():
    return ep.load_case("train-8hp70")


@pytest.fixture(scope="module")
def axle():
    return ep.load_case("train-eaxle")


def test_keys_of_a_set_are_those_of_its_form(gearbox, axle):
    assert field_at(gearbox, "sets.P1.efficiency") is not None
    assert field_at(gearbox, "sets.P1.sun.roughness") is None
    assert field_at(gearbox, "sets.P9.efficiency") is None
    assert field_at(axle, "sets.planets.efficiency") is None
    assert field_at(axle, "sets.planets.sun.roughness") is not None
    assert field_at(axle, "seals.motor_seal.diameter") is not None
    assert field_at(ep.load_case("talbot-2012"), "planet.count") is not None


def test_gears_of_a_listed_set_have_their_names():
    case = ep.load_case(stepped(20, 40, 20, 80, "ring", ("sun", "carrier")))
    assert field_at(case, "sets.S.gears.wide.teeth") is not None
    assert value_of(case, "sets.S.gears.wide.teeth") == 40
    assert "sets.S.gears.wide.teeth" in known_keys(case)


@pytest.mark.parametrize("name", ["train-8hp70", "train-eaxle", "talbot-2012", "talbot-2012-pair"])
def test_known_keys_are_keys(name):
    case = ep.load_case(name)
    keys = known_keys(case)
    assert len(set(keys)) == len(keys)
    assert [key for key in keys if "NAME" not in key and field_at(case, key) is None] == []


def test_values_of_keys(gearbox, axle):
    assert value_of(gearbox, "sets.P1.efficiency") == 0.98
    assert value_of(axle, "seals.motor_seal.diameter") == pytest.approx(0.035)
    assert value_of(gearbox, "sets.P9.efficiency") is None


@pytest.mark.parametrize(
    ("key", "wanted"),
    [("operation.state", True), ("operation.speed", False), ("models.friction", False)],
)
def test_names_are_text(gearbox, key, wanted):
    annotation, _ = field_at(gearbox, key)
    assert is_text(annotation) is wanted


@pytest.mark.parametrize(
    ("written", "advice"),
    [
        ('"planet.roughnes"', "Did you mean 'planet.roughness'?"),
        ("nosuch", "See 'epicyclic init' for keys."),
    ],
)
def test_an_unknown_name_in_uncertainty_does_not_propose_itself(talbot, written, advice):
    known = {'uncertainty."sun.roughness".normal': "0.03 um"}
    changes = known | {f"uncertainty.{written}.normal": "0.05 um"}
    problem = only(problems_of(talbot.updated, changes))
    assert problem.key == f"uncertainty.{written}"
    assert problem.remedy == advice
