"""What the schema says about its own keys."""

from __future__ import annotations

import typing
from typing import Literal

import pytest
from pydantic import BaseModel

from epicyclic.case.case import GearPairCase, PlanetaryCase, case_schema, read_case
from epicyclic.library import builtin_case
from epicyclic.messages import did_you_mean, dotted, misspelt, path_of, written
from epicyclic.oil.oil import DensitySlope, GoldLaw, RoelandsLaw
from epicyclic.schema.fields import (
    all_keys,
    choices_of,
    describe,
    find_field,
    locate,
    quantity_of,
    table_of,
    tables_in,
    to_inputs,
)
from epicyclic.schema.read import parse_value
from epicyclic.units import Number, Quantity

CASES = (PlanetaryCase, GearPairCase)

DIMENSIONLESS = Number.__metadata__[0]

UNMARKED = {
    (GoldLaw, "s"): "constant of a law between a viscosity and a pressure coefficient",
    (GoldLaw, "t"): "exponent",
    (DensitySlope, "value"): "its unit is a quotient of units, which the key states",
}
"""Plain numbers outside the tables of the case, and why they carry neither unit nor mark."""


def models_below(table, seen=None):
    """`table` and all tables below it, each once."""
    seen = set() if seen is None else seen
    if table not in seen:
        seen.add(table)
        for field in table.model_fields.values():
            for inner in tables_in(field.annotation):
                models_below(inner, seen)
    return seen


MODELS = sorted(set().union(*map(models_below, CASES)), key=lambda model: model.__name__)
TABLES = pytest.mark.parametrize("model", MODELS, ids=lambda model: model.__name__)


def holds_float(annotation) -> bool:
    if annotation is float:
        return True
    return any(map(holds_float, typing.get_args(annotation)))


def marks(annotation, metadata=()):
    """All metadata of an annotation, at any depth."""
    yield from metadata
    if typing.get_origin(annotation) is typing.Annotated:
        yield from annotation.__metadata__
    if typing.get_origin(annotation) is not Literal:
        for inner in typing.get_args(annotation):
            yield from marks(inner)


@TABLES
def test_every_number_has_a_unit_or_is_marked_as_having_none(model):
    for name, field in model.model_fields.items():
        if not holds_float(field.annotation):
            continue
        kinds = [
            item
            for item in marks(field.annotation, field.metadata)
            if isinstance(item, Quantity) or item is DIMENSIONLESS
        ]
        assert kinds or (model, name) in UNMARKED, name


@TABLES
def test_every_quantity_of_the_schema_reads_back_what_it_writes(model):
    for name, field in model.model_fields.items():
        kind = quantity_of(field.annotation, field.metadata)
        if kind is None:
            continue
        low = -1.0 if kind.low is None else kind.low
        high = low + 100 if kind.high is None else kind.high
        for share in (1e-6, 0.1, 0.7, 1.0):
            si = kind.parse(f"{low + share * (high - low)!r} {kind.display}")
            assert kind.parse(kind.exact_text(si)) == si, name


@TABLES
def test_every_key_can_be_described(model):
    for name, field in model.model_fields.items():
        words = describe(field.annotation, field.metadata)
        assert words, name
        assert words != "another kind of value", name
        for internal in ("None", "typing", "class", "Annotated", "int ", "float", "str "):
            assert internal not in words, name


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("sun.teeth", "a whole number >= 5 and <= 2000"),
        ("sun.face_width", "a length > 0 mm and <= 100000 mm"),
        ("sun.tip_diameter", "a length > 0 mm and <= 100000 mm"),
        ("sun.profile_shift_coefficient", "a number >= -3 and <= 5"),
        ("planet_bearing.palmgren_coefficient", "a number > 0 and <= 0.05"),
        ("planet_bearing.cage", '"caged" or "full-complement"'),
        ("operation.input", '"sun", "ring" or "carrier"'),
        ("operation.fixed", '"sun", "ring" or "carrier"'),
        ("planet.angles", "an array, each entry an angle"),
        ("losses.sun_drag.include", "true or false"),
        ("title", "text"),
        ("carrier", "a table of keys"),
        ("lubricant.oil", "a table of properties or a name of the oil library (epicyclic oils)"),
        ("friction_table.film_ratio", "an array, each entry a number"),
    ],
)
def test_descriptions(key, words):
    assert describe(*find_field(PlanetaryCase, key)) == words


def test_fields_are_found_by_dotted_key():
    kind = quantity_of(*find_field(PlanetaryCase, "operation.speed"))
    assert kind.display == "rpm"
    assert choices_of(find_field(PlanetaryCase, "planet_bearing.cage")[0])[0] == "caged"
    assert table_of(find_field(PlanetaryCase, "carrier")[0]).__name__ == "Carrier"
    assert find_field(PlanetaryCase, "lubricant.oil.pressure_viscosity.s") is not None
    assert find_field(PlanetaryCase, "lubricant.oil.pressure_viscosity.point") is not None


@pytest.mark.parametrize(
    "key", ["", ".", "sun.", "son", "sun.tooth", "sun.teeth.x", "sun.teeth[0]"]
)
def test_other_keys_are_not_found(key):
    assert find_field(PlanetaryCase, key) is None


@pytest.mark.parametrize("kind", CASES)
def test_all_keys_can_be_found(kind):
    keys = list(all_keys(kind))
    assert len(keys) == len(set(keys)) > 50
    for key in keys:
        assert find_field(kind, key) is not None, key


@pytest.mark.parametrize(
    ("location", "key", "owner"),
    [
        (("sun", "teeth"), "sun.teeth", "GearTable"),
        (("planet", "angles", 1), "planet.angles[1]", "Planet"),
        (
            ("lubricant", "oil", "pressure_viscosity", "gold", "s"),
            "lubricant.oil.pressure_viscosity.s",
            "GoldLaw",
        ),
        (
            ("lubricant", "oil", "pressure_viscosity", "roelands", "point", 2, "value"),
            "lubricant.oil.pressure_viscosity.point[2].value",
            "PressureViscosityPoint",
        ),
        (("friction_table", "friction", "rows", 0, 1), "friction_table.friction[0][1]", None),
        (("operation", "sun"), "operation.sun", "PlanetaryOperation"),
        (("sun", "a key", "b.c"), 'sun."a key"."b.c"', None),
    ],
)
def test_places_leave_out_the_names_of_branches(location, key, owner):
    place = locate(PlanetaryCase, location)
    assert dotted(place.path) == key
    if owner is not None:
        assert place.owner.__name__ == owner


def test_the_branch_of_a_law_is_its_own_class():
    place = locate(PlanetaryCase, ("lubricant", "oil", "pressure_viscosity", "roelands", "point"))
    assert place.owner is RoelandsLaw


def test_keys_become_paths_again():
    assert path_of("planet.angles[1]") == ("planet", "angles", 1)
    assert path_of("sun") == ("sun",)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (True, "true"),
        (5, "5"),
        (-0.0, "-0.0"),
        (float("nan"), "nan"),
        (10**400, "a whole number of many digits"),
        ("5 mm", '"5 mm"'),
        ("a\nb\x1b[31m\u202e", r'"a b\x1b[31m\u202e"'),
        ("\ud800", r'"\ud800"'),
        ((1, "a"), '[1, "a"]'),
        ({"a": True}, "{a = true}"),
        ("x" * 10**6, '"' + "x" * 60 + '..."'),
    ],
)
def test_values_are_shown_as_files_have_them(value, text):
    assert written(value) == text


def test_long_tables_are_cut():
    assert len(written(tuple(range(10**5)))) < 80


@pytest.mark.parametrize(
    ("name", "meant"),
    [("tooth", "teeth"), ("cuont", "count"), ("COUNT", "count"), ("facewidth", "face_width"),
     ("rougness", "roughness"), ("tip_diamter", "tip_diameter"), ("module", "normal_module")],
)  # fmt: skip
def test_near_names_are_suggested(name, meant):
    known = ["teeth", "count", "face_width", "roughness", "tip_diameter", "normal_module"]
    assert did_you_mean(name, known) == f"Did you mean {meant!r}?"


def test_names_that_are_near_by_letters_and_by_parts_are_both_suggested():
    known = ["teeth", "tooth_thickness", "tip_diameter"]
    assert did_you_mean("tooth", known) == "Did you mean 'teeth' or 'tooth_thickness'?"


@pytest.mark.parametrize("name", ["", "x", "colour", "zzzzzz", "t" * 10**6])
def test_far_names_are_not(name):
    assert did_you_mean(name, ["teeth", "count", "face_width"]) == ""


def test_only_a_likely_name_is_taken_for_another():
    assert misspelt("tip_diamter", ["tip_diameter", "root_diameter"]) == "tip_diameter"
    assert misspelt("diameter", ["tip_diameter", "root_diameter"]) == ""


def test_inputs_are_plain_and_complete():
    case = read_case("talbot-2012")
    inputs = to_inputs(case)
    assert inputs == case.inputs()
    assert inputs["sun"]["tip_diameter"] == "139.23 mm"
    assert inputs["sun"]["teeth"] == 73
    assert inputs["surroundings"]["pressure"] == "1.01325 bar"
    assert "angles" not in inputs["planet"]
    assert inputs["sun"]["material"]["elastic_modulus"] == "207 GPa"


def test_values_of_a_command_line():
    assert parse_value("5") == 5
    assert parse_value("true") is True
    assert parse_value("[1, 2]") == [1, 2]
    assert parse_value('"a"') == "a"
    for text in ("5 mm", "", "1\nb = 2", "9" * 5000, "[" * 5000, "\x00", "a = 1"):
        assert parse_value(text) == text


@pytest.mark.parametrize("name", ["talbot-2012", "talbot-2012-pair"])
def test_the_json_schema_accepts_what_is_accepted(name):
    jsonschema = pytest.importorskip("jsonschema")
    schema = case_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    tables = builtin_case(name)
    assert list(validator.iter_errors(tables)) == []
    assert list(validator.iter_errors(read_case(name).inputs())) == []
    for key, value in {"face_width": 5, "roughness": "rough", "teeth": "73", "tooth": 1}.items():
        gear = "sun" if "sun" in tables else "gear"
        wrong = tables | {gear: tables[gear] | {key: value}}
        assert list(validator.iter_errors(wrong)), key


def test_the_json_schema_names_units_choices_and_bounds():
    schema = case_schema()
    assert schema["$schema"].endswith("2020-12/schema")
    tables = schema["$defs"]
    assert {"PlanetaryCase", "GearPairCase", "Oil"} <= set(tables)
    gear = tables["GearTable"]["properties"]
    assert gear["face_width"]["x-unit"] == "mm"
    assert gear["teeth"]["minimum"] == 5
    assert {"enum": ["milled"]} not in gear["roughness"]["anyOf"]
    assert "shaved" in gear["roughness"]["anyOf"][1]["enum"]
    assert "steel" in gear["material"]["anyOf"][0]["enum"]
    assert "iso-vg-100-pao" in tables["Lubricant"]["properties"]["oil"]["anyOf"][0]["enum"]
    for table in tables.values():
        assert table["additionalProperties"] is False, table["title"]
    defaults = tables["PlanetaryCase"]["properties"]["surroundings"]["default"]
    assert defaults["pressure"] == "1.01325 bar"


def test_tables_are_frozen_and_closed():
    for model in MODELS:
        assert issubclass(model, BaseModel)
        assert model.model_config["frozen"], model
        assert model.model_config["extra"] == "forbid", model
