"""Problems of an oil that a case describes itself."""

from __future__ import annotations

import pytest

from epicyclic.case.case import read_case
from epicyclic.library import builtin_case
from problems import only, problems_of


def test_an_unknown_oil_is_not_told_with_all_others():
    tables = builtin_case("talbot-2012")
    tables["lubricant"]["oil"] = "iso-vg-100-mneral"
    problem = only(problems_of(read_case, tables))
    assert "epicyclic oils" in problem.allowed
    assert len(str(problem)) < 200


OIL = {
    "kind": "atff",
    "kinematic_viscosity": [
        {"temperature": "40 degC", "value": "29 cSt"},
        {"temperature": "90 degC", "value": "29 kg", "surce": "me"},
    ],
    "density": [],
    "pressure_viscosity": {"law": "gold", "s": "7", "t": -1},
    "temperature_range": ["0 degC"],
    "density_slope": {"value": True},
    "lubricant_factor": {"value": float("nan")},
    "specific_heat_capacity": {"value": "2 kJ"},
    "friction_regression": "talbot",
}


def test_problems_of_an_oil_have_their_exact_places():
    tables = builtin_case("talbot-2012")
    tables["lubricant"]["oil"] = OIL
    problems = problems_of(read_case, tables)
    assert {problem.key for problem in problems} == {
        "lubricant.oil.kind",
        "lubricant.oil.kinematic_viscosity[1].value",
        "lubricant.oil.kinematic_viscosity[1].surce",
        "lubricant.oil.density",
        "lubricant.oil.pressure_viscosity.s",
        "lubricant.oil.pressure_viscosity.t",
        "lubricant.oil.temperature_range[1]",
        "lubricant.oil.density_slope.value",
        "lubricant.oil.lubricant_factor.value",
        "lubricant.oil.specific_heat_capacity.value",
        "lubricant.oil.friction_regression",
    }


@pytest.mark.parametrize(
    ("law", "key", "words"),
    [
        ({}, "law", 'must be "gold" or "roelands"'),
        ({"law": "gould"}, "law", 'must be "gold" or "roelands"'),
        ({"law": 5}, "law", 'must be "gold" or "roelands"'),
        ({"law": "gold", "s": 1}, "t", "must be a number >= 0"),
        ({"law": "gold", "s": 0, "t": 1}, "s", "must be a number > 0"),
        ({"law": "roelands", "point": []}, "point", "at least 1"),
        (
            {"law": "roelands", "point": [{"temperature": "40 degC", "value": "90 1/GPa"}]},
            "point[0].value",
            "out of range",
        ),
        (
            {
                "law": "roelands",
                "point": [
                    {"temperature": "40 degC", "value": "18 1/GPa"},
                    {"temperature": "40 degC", "value": "17 1/GPa"},
                ],
            },
            "point[1].temperature",
            "repeats the temperature pressure_viscosity.point[0]",
        ),
    ],
)
def test_problems_of_a_law(law, key, words):
    oil = builtin_case("talbot-2012")["lubricant"]["oil"]
    tables = read_case("talbot-2012").inputs()
    assert tables["lubricant"]["oil"]["name"] == oil
    tables["lubricant"]["oil"]["pressure_viscosity"] = law
    problem = only(problems_of(read_case, tables))
    assert problem.key == f"lubricant.oil.pressure_viscosity.{key}"
    assert words in problem.allowed
    assert problem.remedy


def test_data_of_an_oil_that_cannot_be():
    tables = read_case("talbot-2012").inputs()
    oil = tables["lubricant"]["oil"]
    points = oil["kinematic_viscosity"]  # 40, 60, 90 degC
    points[0]["value"], points[1]["value"] = points[1]["value"], points[0]["value"]
    points[2]["value"] = "40 mm^2/s"
    oil["density"][1]["temperature"] = oil["density"][0]["temperature"]
    oil["density"][2]["value"] = "900 kg/m^3"
    oil["temperature_range"] = ["50 degC", "20 degC"]
    found = {problem.key: problem for problem in problems_of(read_case, tables)}
    assert set(found) == {
        "lubricant.oil.kinematic_viscosity[1].value",
        "lubricant.oil.kinematic_viscosity[2].value",
        "lubricant.oil.density[1].temperature",
        "lubricant.oil.density[2].value",
        "lubricant.oil.temperature_range",
    }
    falls = found["lubricant.oil.kinematic_viscosity[1].value"]
    assert "must fall with rising temperature" in falls.allowed
    assert "29.77" in falls.value
    assert all(problem.remedy for problem in found.values())


def test_viscosities_at_almost_the_same_temperature_tell_no_slope():
    tables = read_case("talbot-2012").inputs()
    points = tables["lubricant"]["oil"]["kinematic_viscosity"]
    points[1]["temperature"] = "40.001 degC"
    problem = only(problems_of(read_case, tables))
    assert problem.key == "lubricant.oil.kinematic_viscosity[1].value"
    assert "as that of an oil does" in problem.allowed


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("density_slope", {"value": 0.5}),
        ("density_slope", {"value": -5.0}),
        ("lubricant_factor", {"value": 0.0}),
        ("lubricant_factor", {"value": -1.0}),
        ("kinematic_viscosity", [{"temperature": "40 degC", "value": "0.2 mm^2/s"}] * 2),
        ("density", [{"temperature": "40 degC", "value": "5 kg/m^3"}]),
    ],
)
def test_numbers_of_an_oil_have_bounds(key, value):
    tables = read_case("talbot-2012").inputs()
    tables["lubricant"]["oil"][key] = value
    problems = problems_of(read_case, tables)
    assert problems
    assert all(problem.key.startswith(f"lubricant.oil.{key}") for problem in problems)
