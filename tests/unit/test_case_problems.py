"""Tables of a case to every problem in them at once."""

from __future__ import annotations

import pytest

from epicyclic.case.case import PlanetaryCase, read_case
from epicyclic.library import builtin_case
from problems import only, problems_of

EVERY_KIND = """
kind = "planetery"
title = 5
colour = "red"

[operation]
input = "sun"
fixed = "sun"
torque = 1000 N*m
speed = "4000 1/min"
oil_inlet_temperature = "90 m"

[gears]
normal_module = "1.813 mm"
transverse_module = "1.9 mm"
normal_pressure_angle = 22.5
helix_angle = "50 deg"

[sun]
teeth = 3
tip_diamter = "139.23 mm"
root_diameter = "131.03 mm"
tooth_thickness = "2.873 mm"
roughness = "shavd"

[planet]
count = true
teeth = 26.5
face_width = "24,4 mm"
profile_shift_coefficient = "5 %"
roughness = "0.4 um"
angles = ["0 deg", 120]
material = "stele"

[[ring]]
teeth = 125

[planet_bearing]
rows = "2"
rollers_per_row = 32
roller_diameter = "4.015 mm"
roller_length = "9.52 mm"
pin_diameter = "25.991 mm"
diametral_clearance = "0.004 mm"
roller_roughness = "0.1 um"
race_roughness = "0.1 um"
cage = "cagd"

[lubricant]
oil = "atf-talbot-2021"

[surroundings]
oil_air_ratio = 1.5
pressure = "1e400 bar"

[models]
friction = "table"

[losses.sun_drag]
include = "no"
factor = nan
"""

EVERY_PROBLEM = {
    "kind": "planetary, gear_pair",
    "title": "text",
    "operation.torque": "is not TOML",
    "operation.speed": "turns or radians",
    "operation.oil_inlet_temperature": "measures something else",
    "operation.fixed": "a different member",
    "gears.transverse_module": "conflicts with normal_module",
    "gears.normal_pressure_angle": "has no unit",
    "gears.helix_angle": "out of range",
    "sun.teeth": "a whole number >= 5 and <= 2000",
    "sun.tip_diamter": "is not a known key",
    "sun.thickness_diameter": "belongs to tooth_thickness",
    "sun.face_width": "is missing",
    "sun.roughness": "no such finish",
    "planet.count": "a whole number >= 1 and <= 99",
    "planet.teeth": "a whole number",
    "planet.face_width": "decimal comma",
    "planet.profile_shift_coefficient": "a number >= -3 and <= 5",
    "planet.angles[1]": "has no unit",
    "planet.material": "no such material",
    "ring": "a table of keys",
    "planet_bearing.rows": "a whole number",
    "planet_bearing.rollers_per_row": "only 23 rollers",
    "planet_bearing.cage": '"caged" or "full-complement"',
    "lubricant.oil": "no such oil",
    "surroundings.oil_air_ratio": "a number >= 0 and <= 1",
    "surroundings.pressure": "out of range",
    "models.friction": "needs a table",
    "losses.sun_drag.include": "true or false",
    "losses.sun_drag.factor": "a number >= 0 and <= 100",
    "colour": "is not a known key",
}


@pytest.fixture
def every_kind(tmp_path):
    """The problems of a file with a mistake of every kind."""
    path = tmp_path / "case.toml"
    path.write_text(EVERY_KIND, encoding="utf-8")
    return problems_of(read_case, path)


def test_one_of_each_kind_of_problem_all_together(every_kind):
    found = {problem.key: problem for problem in every_kind}
    assert found.keys() == EVERY_PROBLEM.keys()
    assert len(every_kind) == len(found)
    for key, words in EVERY_PROBLEM.items():
        assert words in found[key].allowed, key


def test_problems_come_in_the_order_of_the_tables(every_kind):
    tables = [problem.key.split(".")[0] for problem in every_kind if "." in problem.key]
    order = list(PlanetaryCase.model_fields)
    assert tables == sorted(tables, key=order.index)


def test_values_are_shown_as_they_were_written(every_kind):
    given = {problem.key: problem.value for problem in every_kind}
    assert given["operation.torque"] == "1000 N*m"
    assert given["operation.speed"] == '"4000 1/min"'
    assert given["planet.count"] == "true"
    assert given["planet.teeth"] == "26.5"
    assert given["losses.sun_drag.factor"] == "nan"
    assert given["sun.face_width"] == ""
    assert given["ring"] == "[{teeth = 125}]"


@pytest.mark.parametrize(
    ("table", "key", "value", "place", "words"),
    [
        ("sun", "teeth", "73", "sun.teeth", "Write 73, without quotes."),
        ("sun", "teeth", 73.0, "sun.teeth", "Write 73."),
        ("sun", "teeth", True, "sun.teeth", "Write a number."),
        ("sun", "teeth", 10**400, "sun.teeth", "Reduce it to 2000 or less."),
        ("sun", "teeth", -(10**30), "sun.teeth", "Increase it to 5 or more."),
        ("sun", "teeth", float("inf"), "sun.teeth", "Give a finite number."),
        ("sun", "teeth", [73], "sun.teeth", "Write a plain number"),
        ("sun", "teeth", {"a": 73}, "sun.teeth", "Write a plain number"),
        ("sun", "face_width", True, "sun.face_width", "mm"),
        ("sun", "face_width", 10**400, "sun.face_width", "mm"),
        ("sun", "face_width", "x" * 10**6, "sun.face_width", "mm"),
        ("sun", "roughness", "x" * 10**6, "sun.roughness", "Check the name."),
        ("sun", "roughness", 0.4, "sun.roughness", '"0.4 um"'),
        ("sun", "material", 5, "sun.material", "[sun.material]"),
        ("sun", "material", "stele", "sun.material", "Did you mean 'steel'?"),
        ("sun", "material", {}, "sun.material.elastic_modulus", '"... GPa"'),
        (
            "sun",
            "material",
            {"elastic_modulus": "207 GPa", "poisson_ratio": 0.6},
            "sun.material.poisson_ratio",
            "Reduce it to 0.5 or less.",
        ),
        ("surroundings", "oil_air_ratio", float("nan"), "surroundings.oil_air_ratio", "finite"),
        ("surroundings", "oil_air_ratio", float("-inf"), "surroundings.oil_air_ratio", "finite"),
        ("surroundings", "oil_air_ratio", "5 %", "surroundings.oil_air_ratio", "Write 0.05."),
        ("surroundings", "oil_air_ratio", "0.05", "surroundings.oil_air_ratio", "without quotes"),
        ("surroundings", "oil_air_ratio", True, "surroundings.oil_air_ratio", "Write a number."),
        ("planet", "angles", "0 deg", "planet.angles", "square brackets"),
        ("planet", "angles", ["0 deg", "x", "240 deg"], "planet.angles[1]", "deg"),
        ("lubricant", "oil", "iso-vg-100-mneral", "lubricant.oil", "iso-vg-100-mineral"),
        ("lubricant", "oil", "water", "lubricant.oil", "Check the name."),
        ("lubricant", "oil", "75W90", "lubricant.oil", "Did you mean '75w-90-gear-oil'?"),
        (
            "uncertainty",
            "sun",
            {"roughness": {"normal": "9 %"}},
            "uncertainty.sun.roughness",
            'Write uncertainty."sun.roughness", with the key in quotes.',
        ),
        ("planet", "teeth", 400, "planet.teeth, planet.thickness_diameter", "about 26 teeth."),
        ("planet", "count", 40, "planet.count", "Use at most 11 planets, equally spaced."),
        (
            "planet",
            "angles",
            ["0 deg", "20 deg", "120 deg"],
            "planet.angles",
            "Use at most 11 planets, equally spaced.",
        ),
        ("lubricant", "oil", 5, "lubricant.oil", "[lubricant.oil]"),
        ("models", "friction", "schlenck", "models.friction", "Did you mean 'schlenk'?"),
        ("losses", "sun_drag", True, "losses.sun_drag", "[losses.sun_drag]"),
        ("losses", "sun_drag", {"include": "false"}, "losses.sun_drag.include", "Write true or"),
        ("lubricant", "oil", None, "lubricant.oil", 'Add oil = "75w-90-gear-oil"'),
        ("models", "drag", "seetharaman", "models.drag", "seetharaman-kahraman"),
        ("models", "drag", "none", "models.drag", "Choose one of them."),
        ("losses", "drag", {}, "losses.drag", "Did you mean"),
        ("sun", "torque", "5 N*m", "sun.torque", "Write operation.torque."),
        ("sun", "sun.teeth", 73, 'sun."sun.teeth"', "Did you mean 'teeth'?"),
        ("sun", 'a "b"', 73, r'sun."a \"b\""', "The keys are teeth"),
        ("sun", "", 73, 'sun.""', "The keys are teeth"),
    ],
)
def test_one_problem_for_one_mistake(table, key, value, place, words):
    tables = builtin_case("talbot-2012")
    tables.setdefault(table, {})[key] = value
    problem = only(problems_of(read_case, tables))
    assert problem.key == place
    assert words in problem.remedy
    assert len(problem.value) < 80


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("planet_bearing.roller_length", "41 mm", "is 82 mm in all, in planets 24.4 mm wide"),
        ("planet_bearing.row_gap", "57 mm", "is 76.04 mm in all"),
        ("carrier.outer_diameter", "184 mm", "must reach the circle of the pins, 184.26 mm"),
    ],
)
def test_parts_that_do_not_fit_the_set(key, value, words):
    table, name = key.split(".")
    tables = builtin_case("talbot-2012")
    tables[table][name] = value
    assert words in only(problems_of(read_case, tables)).allowed


def test_a_wrong_centre_distance_is_told_as_such():
    tables = builtin_case("talbot-2012")
    tables["gears"]["center_distance"] = "200 mm"
    tooth = [it for it in problems_of(read_case, tables) if "thickness" in it.key]
    (found,) = (it for it in problems_of(read_case, tables) if "ring mesh" in it.allowed)
    assert (found.key, tooth) == ("gears.center_distance", [])
    assert "Without profile shift it is 92.15 mm." in found.remedy


def test_a_centre_distance_too_small_for_both_meshes_is_told_once():
    tables = builtin_case("talbot-2012")
    tables["gears"]["center_distance"] = "70 mm"
    found = only(problems_of(read_case, tables))
    assert found.key == "gears.center_distance"
    assert "of the base radii of" in found.allowed


@pytest.mark.parametrize(
    ("tables", "key", "words"),
    [
        ({}, "kind", "is missing"),
        ({"kind": None}, "kind", "is missing"),
        ({"kind": "planetery"}, "kind", "must be planetary, gear_pair"),
        ({"kind": 5}, "kind", "must be planetary, gear_pair"),
        ({"kind": ["planetary"]}, "kind", "must be planetary, gear_pair"),
        ({"kind": "gear_pair"}, "pinion", "the table [pinion] is missing"),
        ({"pinion": {}, "gear": {}}, "pinion.teeth", "is missing; it must be a whole number"),
    ],
)
def test_incomplete_tables(tables, key, words):
    found = {problem.key: problem for problem in problems_of(read_case, tables)}
    assert words in found[key].allowed


def test_a_wrong_kind_does_not_hide_the_rest():
    tables = builtin_case("talbot-2012-pair") | {"kind": "pair"}
    tables["pinion"]["teeth"] = 3
    keys = [problem.key for problem in problems_of(read_case, tables)]
    assert keys == ["kind", "pinion.teeth"]


@pytest.mark.parametrize("name", list(PlanetaryCase.model_fields))
@pytest.mark.parametrize("value", [5, "text", True, [], [{}], 1.5])
def test_every_table_may_be_something_else(name, value):
    if name in ("kind", "title"):
        return
    tables = builtin_case("talbot-2012") | {name: value}
    problems = problems_of(read_case, tables)
    problem = next(problem for problem in problems if problem.key == name)
    what = "names" if name in ("uncertainty", "seals") else "keys"
    assert problem.allowed == f"must be a table of {what}."
    assert f"[{name}" in problem.remedy


def test_a_misspelt_key_counts_as_the_one_that_was_meant():
    tables = builtin_case("talbot-2012")
    tables["sun"]["teth"] = tables["sun"].pop("teeth")
    tables["gaers"] = tables.pop("gears")
    keys = [problem.key for problem in problems_of(read_case, tables)]
    assert sorted(keys) == ["gaers", "sun.teth"]


def test_misspelt_tables_do_not_hide_what_is_wrong_in_them():
    tables = builtin_case("talbot-2012")
    tables["gaers"] = tables.pop("gears") | {"helix_angel": "13 deg", "helix_angle": None}
    del tables["lubricant"]
    tables["lubricnt"] = {"oill": "water"}
    keys = [problem.key for problem in problems_of(read_case, tables)]
    assert sorted(keys) == [
        "gaers",
        "gears.helix_angel",
        "lubricant.oil",
        "lubricant.oill",
        "lubricnt",
    ]


def test_a_missing_key_is_told_beside_an_unknown_one():
    tables = builtin_case("talbot-2012")
    del tables["sun"]["teeth"]
    tables["sun"]["number_of_something"] = 3
    problems = problems_of(read_case, tables)
    assert {problem.key for problem in problems} == {"sun.teeth", "sun.number_of_something"}


@pytest.mark.parametrize(
    ("table", "give", "take", "key", "words"),
    [
        ("sun", {"profile_shift_coefficient": 0.1}, (), "profile_shift_coefficient", "conflicts"),
        ("sun", {}, ("tooth_thickness",), "tooth_thickness", "belongs to thickness_diameter"),
        ("gears", {}, ("normal_module",), "normal_module", "normal_module or transverse_module"),
        ("operation", {}, ("fixed",), "fixed", "second_input with second_speed"),
        ("operation", {"second_speed": "1 rpm"}, (), "second_speed", "conflicts with fixed"),
    ],
)
def test_exactly_one_of_the_alternatives(table, give, take, key, words):
    tables = builtin_case("talbot-2012")
    tables[table] |= give
    for name in take:
        del tables[table][name]
    problem = only(problems_of(read_case, tables))
    assert problem.key == f"{table}.{key}"
    assert words in problem.allowed
    assert problem.remedy


def test_nothing_is_a_case_that_is_too_large_or_too_deep():
    deep = {}
    deep["deeper"] = deep
    for tables in (deep, {"x": list(range(30_000))}):
        assert only(problems_of(read_case, tables)).remedy


def test_many_problems_take_no_long():
    tables = builtin_case("talbot-2012")
    tables["sun"] |= {f"key{number}": number for number in range(5_000)}
    assert len(problems_of(read_case, tables)) == 5_000


@pytest.mark.parametrize(
    ("key", "value", "remedy"),
    [
        ("planet.material", "bronze", "Did you mean 'CuSn12'?"),
        ("planet.material", "EN-GJS-700", "Did you mean 'nodular-iron'?"),
        ("planet.material", "100Cr6", "Did you mean 'bearing-steel'?"),
        ("planet.material", "42CrMo", "Did you mean '42CrMo4'?"),
        ("lubricant.oil", "lithium grease", 'write lubrication.method = "grease"'),
    ],
)
def test_near_names_follow_from_the_kind_of_a_material(talbot, key, value, remedy):
    (problem,) = problems_of(talbot.updated, {key: value})
    assert remedy in problem.remedy
