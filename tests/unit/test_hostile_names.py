"""Names of users that mean something to other programs: they stay names."""

from __future__ import annotations

import csv
import io
import re
import sys

import numpy as np
import openpyxl
import pytest
from rich.text import Text

import epicyclic as ep
from epicyclic.cli.main import main
from epicyclic.messages import dotted
from epicyclic.show.template import case_text, toml_keys
from epicyclic.show.terminal import plain_table, terminal
from trains import simple

HOSTILE = [
    "x\nsystem('id')",
    "'); system('id'); ('",
    "y\rmodel Other",
    "\x1b]0;owned\x07",
    "\x1b[2J*/ z",
    "\u2028rm \x85 \x9b31m",
    '"; end x; "',
    "$\\frac{$ [/b] :smile:",
]
SPEED, TORQUE = ["0 rpm", "700 rpm", "1300 rpm"], ["-70 N*m", "0 N*m", "130 N*m"]
STATES = ["1", "2", "3", "4", "5", "6", "7", "8"]
SHAFTS = ("reference_shaft", "output_shaft", "held_shaft")


@pytest.fixture(scope="module")
def data():
    """A map of eight states, as of a file that somebody else has written."""
    found = ep.loss_map(ep.load_case("train-8hp70"), SPEED, TORQUE, states=STATES, jobs=1)
    about = {name: f"{name}\n{HOSTILE[0]}\r{HOSTILE[4]}" for name in ("title", "source")}
    found = found.assign_coords(state=np.array(HOSTILE, dtype=object)).assign_attrs(about)
    shafts = {found.attrs[name]: f"{name}\nsystem('{name}')" for name in SHAFTS[:2]}
    renamed = {
        f"{old}_{what}": f"{new}_{what}"
        for old, new in shafts.items()
        for what in ("speed", "torque")
    }
    return found.rename(renamed).assign_attrs(
        {name: shafts[found.attrs[name]] for name in SHAFTS[:2]} | {"held_shaft": HOSTILE[0]}
    )


STARTS = {
    "modelica": r"// |record |  parameter |    [\d\"|]|end |  *-?[\d.]+",
    "simscape": r"% |\w+ = (\[|reshape|\{)|    [-\d]|\], \[",
    "vecto": r"Input Speed \[rpm\],Input Torque \[Nm\],Torque Loss \[Nm\] # |[-\d.,e+]+$",
    "gem": r"# |Input Speed|[-\d.,e+]+$",
}
"""How lines of a file may begin."""


@pytest.mark.parametrize("name", STARTS)
def test_names_end_no_line_of_another_program(data, tmp_path, name):
    path = tmp_path / "m.txt"
    ep.write_map(data.isel(torque=slice(1, None)) if name == "gem" else data, path, name)
    files = list(tmp_path.iterdir())
    assert len(files) == (1 if name == "simscape" else len(HOSTILE))
    for file in files:
        text = file.read_text(encoding="utf-8")
        assert all(char == "\n" or char.isprintable() for char in text)
        lines = text.splitlines()
        wrong = [line for line in lines if not re.match(STARTS[name], line)]
        assert not wrong
    if name == "simscape":
        (states,) = (line for line in lines if line.startswith("state_names"))
        quoted = re.fullmatch(r"state_names = \{('(?:[^']|'')*'(?:, '(?:[^']|'')*')*)\};", states)
        assert quoted
        assert len(re.findall(r"'(?:[^']|'')*'", quoted[1])) == len(HOSTILE)


def test_names_end_no_row_and_no_sheet(data, tmp_path):
    ep.write_map(data, tmp_path / "m.csv")
    text = (tmp_path / "m.csv").read_bytes().decode()
    assert "\r" not in text
    assert "\x1b" not in text
    *statements, table = re.split(r"(?m)^(?!# )", text, maxsplit=1)
    assert len(statements) == 1
    header, *rows = csv.reader(io.StringIO(table, newline=""))
    assert {len(row) for row in rows} == {len(header)}
    assert len(rows) == data["total"].size
    ep.write_map(data, tmp_path / "m.xlsx")
    book = openpyxl.load_workbook(tmp_path / "m.xlsx")
    assert len(book.sheetnames) == 2 * len(HOSTILE) + 3  # points and a matrix for each
    ep.write_map(data, tmp_path / "m.mat")


@pytest.mark.slow
def test_an_fmu_takes_any_name(data, tmp_path):
    fmpy = pytest.importorskip("fmpy")
    pytest.importorskip("ziglang")
    ep.write_map(data, tmp_path / "m.fmu")
    assert fmpy.read_model_description(tmp_path / "m.fmu").modelName == "loss_map"


@pytest.mark.parametrize("name", HOSTILE)
def test_a_terminal_shows_names_as_they_are(capsys, name):
    table = plain_table(name, name)
    table.add_row(name)
    terminal().print(Text(name), table, name)
    shown = capsys.readouterr().out
    assert all(char == "\n" or char.isprintable() for char in shown)
    if name.isprintable():
        assert shown.count(name) >= 3


def with_name(place, name):
    """A train with one of its names."""
    tables = simple(31, 77, "ring", ("sun", "carrier"))
    (gears,) = tables["sets"].values()
    if place == "state":
        tables["states"] = {name: {}}
        tables["operation"]["state"] = name
    elif place == "shaft":
        tables["shafts"][name] = tables["shafts"].pop("in")
        tables["operation"]["input"] = name
    elif place == "set":
        tables["sets"] = {name: gears}
        tables["shafts"] = {
            shaft: [member.replace("S.", f"{name}.") for member in members]
            for shaft, members in tables["shafts"].items()
        }
    elif place == "gear":
        gears["gears"][name] = gears["gears"].pop("planet")
        gears["meshes"] = [["sun", name], [name, "ring"]]
    elif place == "body":
        gears["gears"]["planet"]["body"] = name
    return ep.load_case(tables)


PLACES = ("state", "shaft", "set", "gear", "body")


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", ["x\nsystem('id')", "\x1b[31m", "a\rb", "", " "])
def test_names_with_control_characters_and_empty_ones_are_refused(place, name):
    if place == "body" and not name:
        pytest.skip("such a planet is a body of its own")
    with pytest.raises(ep.InputError) as error:
        with_name(place, name)
    assert "\x1b" not in str(error.value)


@pytest.mark.parametrize("place", [place for place in PLACES if place != "state"])
@pytest.mark.parametrize("name", ["a/b", "/", "$a", "a ", "(b"])
def test_names_that_no_result_file_can_hold_are_refused(place, name):
    with pytest.raises(ep.InputError, match="begin with a letter or digit, and use no dot or sla"):
        with_name(place, name)


@pytest.mark.parametrize("place", PLACES)
def test_unusual_names_are_kept_in_a_result_file(tmp_path, place):
    name = "é1 [/b] $x{$ ':smile:'" if place != "state" else "[/b] 1/2 $x{$ ':smile:'"
    case = with_name(place, name.replace("/", "") if place != "state" else name)
    ep.save_result(case, tmp_path / "r.nc")
    assert ep.open_result(tmp_path / "r.nc").result.to_dict() == ep.solve(case).to_dict()


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("name", ['a"b', "a\\b", 'a\\"]', "a  b", "ü" * 90, "a#b = [1]", "a'' 'b"])
def test_unusual_names_are_kept_in_a_case_file(tmp_path, place, name):
    case = with_name(place, name)
    path = tmp_path / "case.toml"
    path.write_text(case_text(case.given(), []), encoding="utf-8")
    assert ep.load_case(path).inputs() == case.inputs()


@pytest.mark.parametrize("written", [toml_keys, dotted])
@pytest.mark.parametrize("name", ['a"b', "a\\b", 'a\\"]', "a\\\\b", 'a"'])
def test_keys_with_unusual_names_are_read_as_they_are_written(name, written):
    key = written(["sets", name, "mesh_efficiency"])
    changed = with_name("set", name).updated({key: 0.93})
    assert changed.sets[name].mesh_efficiency == changed[key] == 0.93


def test_a_run_shows_a_name_that_looks_like_markup(tmp_path, monkeypatch, capsys):
    path = tmp_path / "case.toml"
    monkeypatch.setattr(sys, "argv", ["epicyclic", "check", str(path)])
    path.write_text(MARKED)
    main()
    assert "[/b] first" in capsys.readouterr().out


MARKED = """\
kind = "train"
title = "[/i] :smile:"
[sets.S]
planets = 3
mesh_efficiency = 0.98
meshes = [["sun", "planet"], ["planet", "ring"]]
[sets.S.gears]
sun = {teeth = 31}
planet = {teeth = 23}
ring = {teeth = 77, internal = true}
[shafts]
in = ["S.sun"]
out = ["S.carrier"]
[states]
"[/b] first" = {fixed = ["S.ring"]}
"[/b] direct" = {joined = [["S.sun", "S.ring"]]}
[operation]
input = "in"
output = "out"
torque = "7 N*m"
speed = "1300 rpm"
state = "[/b] first"
"""
