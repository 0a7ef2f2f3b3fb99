"""From files, names and tables to a case, or to every problem at once."""

from __future__ import annotations

import os
import stat
import threading
import time
from pathlib import Path

import pytest

import epicyclic as ep
from epicyclic.case.case import GearPairCase, PlanetaryCase, load_case
from epicyclic.errors import InputError
from epicyclic.library import builtin_case

FOLDER = Path(ep.__file__).with_name("library") / "cases"
TALBOT = (FOLDER / "talbot-2012.toml").read_text(encoding="utf-8")
PAIR = (FOLDER / "talbot-2012-pair.toml").read_text(encoding="utf-8")


def problems_of(action, *args):
    """The problems that `action` raises, by key; they must come within a second."""
    start = time.thread_time()
    with pytest.raises(InputError) as caught:
        action(*args)
    assert time.thread_time() - start < 1.0
    for problem in caught.value.problems:
        assert problem.allowed.endswith(".")
        assert problem.remedy.endswith((".", "?"))
    return caught.value


def only(error):
    """The one problem of an error."""
    (problem,) = error.problems
    return problem


@pytest.fixture
def write(tmp_path):
    """Writes a case file and returns its path."""

    def write(content, name="case.toml"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


def test_files_names_and_tables_make_the_same_case(write):
    by_name = load_case("talbot-2012")
    by_file = load_case(write(TALBOT))
    by_text = load_case(str(write(TALBOT)))
    by_tables = load_case(builtin_case("talbot-2012"))
    assert by_name == by_file == by_text == by_tables
    assert isinstance(by_name, PlanetaryCase)
    assert isinstance(load_case("talbot-2012-pair"), GearPairCase)


def test_a_case_knows_where_it_came_from(write):
    path = write(TALBOT)
    assert load_case(path).source == str(path)
    assert load_case("talbot-2012-n6").source == "talbot-2012-n6"
    assert load_case(builtin_case("talbot-2012")).source == "the given tables"


@pytest.mark.parametrize("change", ["\ufeff{}", "{}\r\n", "# only a comment first\n{}", "{}"])
def test_files_of_every_editor_are_read(write, change):
    text = change.format(TALBOT)
    if "\r" in change:
        text = text.replace("\n", "\r\n").replace("\r\r", "\r")
    assert load_case(write(text)) == load_case("talbot-2012")


def test_a_file_needs_no_suffix_and_goes_before_a_built_in_case(write, monkeypatch):
    path = write(PAIR, "talbot-2012")
    monkeypatch.chdir(path.parent)
    assert load_case("talbot-2012").kind == "gear_pair"
    path.unlink()
    path.mkdir()
    assert load_case("talbot-2012").kind == "planetary"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("talbot", "Did you mean 'talbot-2012'?"),
        ("talbot-2012-n7", "n3 or n4 or n5 or n6"),
        ("xyz", "'epicyclic cases'"),
        ("a\0b", "epicyclic cases"),
        ("x" * 5000, "epicyclic cases"),
        (None, "Give one of these."),
        (5, "Give one of these."),
        (b"talbot-2012", "Give one of these."),
    ],
)
def test_names_of_nothing(name, words):
    problem = only(problems_of(load_case, name))
    assert problem.key == "CASE"
    assert problem.value
    assert words in problem.remedy


@pytest.mark.parametrize("name", ["missing.toml", "no/such/case.toml", "no/such/case", "a\0b.toml"])
def test_missing_files(name):
    assert "cannot be read" in only(problems_of(load_case, name)).allowed


def test_folders_pipes_and_devices_are_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    assert "a folder" in only(problems_of(load_case, tmp_path)).allowed
    assert "a folder" in only(problems_of(load_case, "")).allowed
    for path in (tmp_path / "pipe.toml", "/dev/zero", "/dev/null"):
        assert "not a regular file" in only(problems_of(load_case, path)).allowed


def test_a_pipe_nobody_writes_to_does_not_block(tmp_path):
    path = tmp_path / "pipe.toml"
    os.mkfifo(path)
    done = threading.Event()

    def read():
        with pytest.raises(InputError):
            load_case(path)
        done.set()

    threading.Thread(target=read, daemon=True).start()
    assert done.wait(10)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_files_without_permission(write):
    path = write(TALBOT)
    path.chmod(stat.S_IWUSR)
    assert "Permission denied" in only(problems_of(load_case, path)).allowed


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is empty"),
        (b"# nothing\n\n", "is empty"),
        (b"\xef\xbb\xbf", "is empty"),
        (b"\x7fELF\x00\x01", "is not text"),
        ("kind = 'planetary'".encode("utf-16"), "is not text"),
        (TALBOT.replace("Talbot", "T\u00e4lbot").encode("latin-1"), "byte 0xe4 in line"),
        (b"a" * 1_000_001, "too large"),
        (b"x = " + b"[" * 100_000, "nested"),
        (b"x = " + b"[" * 100 + b"]" * 100, "nested"),
        (b".".join([b"a"] * 100_000) + b" = 1", "nested"),
        (b"x = [" + b"1," * 400_000 + b"]", "too many"),
        (b"teeth = " + b"9" * 5000, "5000 digits"),
        (b"[sun\nteeth = 3", "is not TOML"),
        (b"[sun]\nteeth = 3\n[sun]\nteeth = 4", "declares a table twice (line 3)"),
        (b"just some words", "is not TOML"),
        (b"\x1b[31m", "is not TOML"),
        (b"<html></html>", "is not TOML"),
        (b"PK\x03\x04\x05", "is not TOML"),
    ],
    ids=lambda value: repr(value)[:24],
)
def test_files_that_are_no_case(write, content, words):
    error = problems_of(load_case, write(content))
    assert words in only(error).allowed
    assert all(line.isprintable() for line in str(error).splitlines())
    assert error.source.endswith("case.toml")


def test_a_line_that_is_not_toml_is_shown(write):
    problem = only(problems_of(load_case, write(TALBOT.replace("[sun]", "[sun"))))
    assert problem.value.startswith("line ")
    assert problem.value.endswith(": [sun")
    assert problem.remedy == "Mend this line."


@pytest.mark.parametrize(
    ("line", "remedy"),
    [
        ("torque = 1000 N*m", 'Put the value in quotes: torque = "1000 N*m".'),
        ("torque = 1000 N*m   # on the sun", 'Put the value in quotes: torque = "1000 N*m".'),
        ('torque = "1000 N*m', 'Put the value in quotes: torque = "1000 N*m".'),
        ("torque =", "Give a value."),
    ],
)
def test_missing_quotes_are_mended_and_told(write, line, remedy):
    text = TALBOT.replace('torque = "1000 N*m"', line, 1)
    problem = only(problems_of(load_case, write(text)))
    assert problem.key == "operation.torque"
    number = 1 + next(i for i, row in enumerate(text.splitlines()) if row.startswith("torque"))
    assert f"is not TOML (line {number})" in problem.allowed
    assert problem.remedy == remedy


@pytest.mark.parametrize(
    ("line", "remedy"),
    [
        ("oil_air_ratio = 0,05", "Write 0.05."),
        ("oil_air_ratio = .05", "Write 0.05."),
        ("oil_air_ratio = True", "Write true."),
    ],
)
def test_numbers_that_are_not_toml(write, line, remedy):
    text = TALBOT.replace("oil_air_ratio = 0.05", line, 1)
    problem = only(problems_of(load_case, write(text)))
    assert problem.key == "surroundings.oil_air_ratio"
    assert problem.remedy == remedy


def test_a_line_that_quotes_do_not_mend_is_told_once(write):
    text = TALBOT.replace("face_width", '"face_width', 1)
    problem = only(problems_of(load_case, write(text)))
    assert '"face_width = "30.9 mm"' in problem.value


def test_a_table_that_a_dotted_key_has_made_already_is_explained(write):
    text = b"[sun]\nmicro_geometry.tip_relief = '5 um'\n[sun.micro_geometry]"
    problem = only(problems_of(load_case, write(text)))
    assert problem.allowed == "declares a table twice (line 3)."
    assert "a dotted key, such as micro_geometry.tip_relief" in problem.remedy


def test_a_key_given_twice_is_told(write):
    text = TALBOT.replace("count = 3", "count = 3\ncount = 4")
    problem = only(problems_of(load_case, write(text)))
    assert "count = 4" in problem.value
    assert "given before" in problem.allowed


def test_bad_lines_do_not_hide_each_other_nor_the_rest(write):
    text = TALBOT.replace('"1000 N*m"', "1000 N*m").replace('"4000 rpm"', "4000 rpm")
    text = text.replace("teeth = 73", "teeth = 3").replace("[carrier]", "[carriar]")
    error = problems_of(load_case, write(text))
    assert [problem.key for problem in error.problems] == [
        "operation.torque",
        "operation.speed",
        "sun.teeth",
        "carriar",
    ]


def test_too_many_bad_lines_are_no_case(write):
    error = problems_of(load_case, write("\n".join(f"a{i} = b c" for i in range(1000))))
    assert len(error.problems) < 100


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
    "kind": "planetary or gear_pair",
    "title": "text",
    "operation.torque": "is not TOML",
    "operation.speed": "turns or radians",
    "operation.oil_inlet_temperature": "measures something else",
    "operation.fixed": "another member",
    "gears.transverse_module": "conflicts with normal_module",
    "gears.normal_pressure_angle": "has no unit",
    "gears.helix_angle": "out of range",
    "gears.center_distance": "is missing",
    "sun.teeth": "a whole number >= 5 and <= 2000",
    "sun.tip_diamter": "is not a known key",
    "sun.thickness_diameter": "belongs to tooth_thickness",
    "sun.face_width": "is missing",
    "sun.roughness": "no such finish",
    "planet.count": "a whole number >= 1 and <= 24",
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


def test_one_of_each_kind_of_problem_all_together(write):
    error = problems_of(load_case, write(EVERY_KIND))
    found = {problem.key: problem for problem in error.problems}
    assert found.keys() == EVERY_PROBLEM.keys()
    assert len(error.problems) == len(found)
    for key, words in EVERY_PROBLEM.items():
        assert words in found[key].allowed, key


def test_problems_come_in_the_order_of_the_tables(write):
    error = problems_of(load_case, write(EVERY_KIND))
    tables = [problem.key.split(".")[0] for problem in error.problems if "." in problem.key]
    order = list(PlanetaryCase.model_fields)
    assert tables == sorted(tables, key=order.index)


def test_values_are_shown_as_they_were_written(write):
    error = problems_of(load_case, write(EVERY_KIND))
    given = {problem.key: problem.value for problem in error.problems}
    assert given["operation.torque"] == "1000 N*m"
    assert given["operation.speed"] == '"4000 1/min"'
    assert given["planet.count"] == "true"
    assert given["planet.teeth"] == "26.5"
    assert given["losses.sun_drag.factor"] == "nan"
    assert given["gears.center_distance"] == ""
    assert given["ring"] == "[{teeth = 125}]"


@pytest.mark.parametrize(
    ("table", "key", "value", "place", "words"),
    [
        ("sun", "teeth", "73", "sun.teeth", "Write 73, without quotes."),
        ("sun", "teeth", 73.0, "sun.teeth", "Write 73."),
        ("sun", "teeth", True, "sun.teeth", "Write a number."),
        ("sun", "teeth", 10**400, "sun.teeth", "Reduce it to 2000 or less."),
        ("sun", "teeth", -(10**30), "sun.teeth", "Increase it to 5 or more."),
        ("sun", "teeth", float("inf"), "sun.teeth", "Round it."),
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
        ("lubricant", "oil", 5, "lubricant.oil", "[lubricant.oil]"),
        ("models", "friction", "schlenck", "models.friction", "Did you mean 'schlenk'?"),
        ("losses", "sun_drag", True, "losses.sun_drag", "[losses.sun_drag]"),
        ("losses", "sun_drag", {"include": "false"}, "losses.sun_drag.include", "Write true or"),
        ("lubricant", "oil", None, "lubricant.oil", 'Add oil = "75w-90-gear-oil"'),
        ("models", "drag", "seetharaman", "models.drag", "seetharaman-kahraman"),
        ("models", "drag", "none", "models.drag", 'Write "seetharaman-kahraman".'),
        ("losses", "drag", {}, "losses.drag", "Did you mean"),
        ("sun", "torque", "5 N*m", "sun.torque", "It belongs to operation."),
        ("sun", "sun.teeth", 73, 'sun."sun.teeth"', "Did you mean 'teeth'?"),
        ("sun", 'a "b"', 73, 'sun."a "b""', "Known are: teeth"),
        ("sun", "", 73, 'sun.""', "Known are: teeth"),
    ],
)
def test_one_problem_for_one_mistake(table, key, value, place, words):
    tables = builtin_case("talbot-2012")
    tables.setdefault(table, {})[key] = value
    problem = only(problems_of(load_case, tables))
    assert problem.key == place
    assert words in problem.remedy
    assert len(problem.value) < 80


def test_an_unknown_oil_is_not_told_with_all_others():
    tables = builtin_case("talbot-2012")
    tables["lubricant"]["oil"] = "iso-vg-100-mneral"
    problem = only(problems_of(load_case, tables))
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
    error = problems_of(load_case, tables)
    assert {problem.key for problem in error.problems} == {
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
    ],
)
def test_problems_of_a_law(law, key, words):
    oil = builtin_case("talbot-2012")["lubricant"]["oil"]
    tables = load_case("talbot-2012").inputs()
    assert tables["lubricant"]["oil"]["name"] == oil
    tables["lubricant"]["oil"]["pressure_viscosity"] = law
    problem = only(problems_of(load_case, tables))
    assert problem.key == f"lubricant.oil.pressure_viscosity.{key}"
    assert words in problem.allowed
    assert problem.remedy


def test_data_of_an_oil_that_cannot_be():
    tables = load_case("talbot-2012").inputs()
    oil = tables["lubricant"]["oil"]
    points = oil["kinematic_viscosity"]  # 40, 60, 90 degC
    points[0]["value"], points[1]["value"] = points[1]["value"], points[0]["value"]
    points[2]["value"] = "40 mm^2/s"
    oil["density"][1]["temperature"] = oil["density"][0]["temperature"]
    oil["density"][2]["value"] = "900 kg/m^3"
    oil["temperature_range"] = ["50 degC", "20 degC"]
    found = {problem.key: problem for problem in problems_of(load_case, tables).problems}
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
    tables = load_case("talbot-2012").inputs()
    tables["lubricant"]["oil"][key] = value
    problems = problems_of(load_case, tables).problems
    assert problems
    assert all(problem.key.startswith(f"lubricant.oil.{key}") for problem in problems)


@pytest.mark.parametrize(
    ("tables", "key", "words"),
    [
        ({}, "kind", "is missing"),
        ({"kind": None}, "kind", "is missing"),
        ({"kind": "planetery"}, "kind", "must be planetary or gear_pair"),
        ({"kind": 5}, "kind", "must be planetary or gear_pair"),
        ({"kind": ["planetary"]}, "kind", "must be planetary or gear_pair"),
        ({"kind": "gear_pair"}, "pinion", "the table [pinion] is missing"),
        ({"pinion": {}, "gear": {}}, "pinion.teeth", "is missing; it must be a whole number"),
    ],
)
def test_incomplete_tables(tables, key, words):
    found = {problem.key: problem for problem in problems_of(load_case, tables).problems}
    assert words in found[key].allowed


def test_a_wrong_kind_does_not_hide_the_rest():
    tables = builtin_case("talbot-2012-pair") | {"kind": "pair"}
    tables["pinion"]["teeth"] = 3
    keys = [problem.key for problem in problems_of(load_case, tables).problems]
    assert keys == ["kind", "pinion.teeth"]


@pytest.mark.parametrize("name", list(PlanetaryCase.model_fields))
@pytest.mark.parametrize("value", [5, "text", True, [], [{}], 1.5])
def test_every_table_may_be_something_else(name, value):
    if name in ("kind", "title"):
        return
    tables = builtin_case("talbot-2012") | {name: value}
    error = problems_of(load_case, tables)
    problem = next(problem for problem in error.problems if problem.key == name)
    assert problem.allowed == "must be a table of keys."
    assert f"[{name}]" in problem.remedy


def test_a_misspelt_key_counts_as_the_one_that_was_meant():
    tables = builtin_case("talbot-2012")
    tables["sun"]["teth"] = tables["sun"].pop("teeth")
    tables["gaers"] = tables.pop("gears")
    keys = [problem.key for problem in problems_of(load_case, tables).problems]
    assert sorted(keys) == ["gaers", "sun.teth"]


def test_misspelt_tables_do_not_hide_what_is_wrong_in_them():
    tables = builtin_case("talbot-2012")
    tables["gaers"] = tables.pop("gears") | {"helix_angel": "13 deg", "helix_angle": None}
    del tables["lubricant"]
    tables["lubricnt"] = {"oill": "water"}
    keys = [problem.key for problem in problems_of(load_case, tables).problems]
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
    error = problems_of(load_case, tables)
    assert {problem.key for problem in error.problems} == {"sun.teeth", "sun.number_of_something"}


@pytest.mark.parametrize(
    ("table", "give", "take", "key", "words"),
    [
        ("sun", {"profile_shift_coefficient": 0.1}, (), "profile_shift_coefficient", "conflicts"),
        ("sun", {}, ("tooth_thickness",), "tooth_thickness", "belongs to thickness_diameter"),
        ("sun", {}, ("tooth_thickness", "thickness_diameter"), "tooth_thickness", "needed is"),
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
    problem = only(problems_of(load_case, tables))
    assert problem.key == f"{table}.{key}"
    assert words in problem.allowed
    assert problem.remedy


def test_nothing_is_a_case_that_is_too_large_or_too_deep():
    deep = {}
    deep["deeper"] = deep
    for tables in (deep, {"x": list(range(30_000))}):
        assert only(problems_of(load_case, tables)).remedy


def test_many_problems_take_no_long():
    tables = builtin_case("talbot-2012")
    tables["sun"] |= {f"key{number}": number for number in range(5_000)}
    assert len(problems_of(load_case, tables).problems) == 5_000
