"""What the app hands out is what the commands that it shows write."""

from __future__ import annotations

import json
import re
import shlex

import pandas as pd
import pytest

pytest.importorskip("nicegui", reason="optional")

from openpyxl import load_workbook

import epicyclic as ep
from epicyclic.plugins.app import worker as tasks
from epicyclic.plugins.app.case_form import opened
from epicyclic.plugins.app.page import RESULTS
from epicyclic.plugins.app.views import MAP_FILES
from epicyclic.plugins.app.worker import Study
from epicyclic.study.maps.formats import formats

pytestmark = pytest.mark.slow

AXES = {"speed": "1300:4700:3 rpm", "torque": "-35:115:3 N*m", "temperature": "53,81 degC"}
WRITTEN = re.compile(rb"\d{4}-\d\d-\d\d[ T]\d\d:\d\d(:\d\d)?(\+00:00| UTC)?")


@pytest.fixture(scope="module")
def desk():
    changed = opened("talbot-2012-pair")
    for key, value in {
        "operation.speed": "3700 rpm",
        "operation.torque": "83 N*m",
        "losses.mesh_pocketing.include": False,
    }.items():
        changed.change(key, value)
    assert not changed.problems
    return changed


@pytest.fixture
def both(desk, epicyclic, tmp_path):
    """The file of the app and that of the command beside it, as paths."""

    def made(ending, verb, *more, study=None, name=""):
        study = study or Study(desk.case)
        suffix, content = tasks.saved(study, name or ending, None, lambda done, total: None)
        assert suffix == ending
        own, other = tmp_path / f"app{ending}", tmp_path / f"command{ending}"
        own.write_bytes(content)
        words = shlex.split(desk.command(verb, *more, str(other)))[1:]
        done = epicyclic(*words)
        assert done.returncode == 0, done.stderr
        return own, other

    return made


def undated(file):
    return WRITTEN.sub(b"", file.read_bytes())


def test_every_file_of_the_menu_is_compared():
    assert set(RESULTS) == {".toml", ".nc", ".json", ".html", ".pdf", ".rexs"}
    assert {"netcdf", "csv", "parquet", "excel", "matlab"} < set(MAP_FILES)


def test_the_case_file_gives_the_same_case(desk, tmp_path):
    file = tmp_path / "case.toml"
    file.write_text(desk.text(), encoding="utf-8")
    assert ep.load_case(file) == desk.case


def test_json_is_that_of_run(both):
    own, other = (json.loads(file.read_text("utf-8")) for file in both(".json", "run", "--json"))
    assert own == other
    low, high = own["band"]["total"]
    assert 0 < low < high


def test_a_stored_result_is_that_of_run(both):
    own, other = map(ep.open_result, both(".nc", "run", "--save"))
    assert own.result.to_dict() == other.result.to_dict()
    assert own.given == other.given
    assert list(own.fields) == list(other.fields)
    for path, data in own.fields.items():
        assert data.identical(other.fields[path]), path


def test_the_report_is_that_of_the_command(both):
    own, other = both(".html", "report", "-o")
    assert undated(own) == undated(other)


def test_the_report_in_pdf_has_as_many_pages(both):
    pytest.importorskip("weasyprint", reason="optional")
    own, other = both(".pdf", "report", "-o")
    assert own.read_bytes().count(b"/Type /Page") == other.read_bytes().count(b"/Type /Page") > 1


def test_the_rexs_file_is_that_of_export(desk, both, epicyclic, tmp_path):
    _, content = tasks.saved(Study(desk.case), ".rexs", None, lambda done, total: None)
    other = tmp_path / "command.rexs"
    words = shlex.split(desk.command("run"))[2:]
    assert epicyclic("rexs", "export", *words, "-o", str(other)).returncode == 0
    assert WRITTEN.sub(b"", content) == undated(other)


@pytest.fixture(scope="module")
def mapped(desk):
    return Study(desk.case, *AXES.values(), is_map=True)


@pytest.mark.parametrize("name", ["netcdf", "csv", "parquet", "excel", "matlab"])
def test_files_of_a_map_are_those_of_the_command(name, mapped, both):
    ending = formats()[name].suffix
    options = [word for axis, text in AXES.items() for word in (f"--{axis}", text)]
    own, other = both(ending, "map", *options, "-o", study=mapped, name=name)
    if ending == ".nc":
        assert ep.open_result(own).identical(ep.open_result(other))
    elif ending == ".xlsx":
        books = [load_workbook(file) for file in (own, other)]
        assert books[0].sheetnames == books[1].sheetnames
        for sheet in books[0].sheetnames:
            cells = [[[it.value for it in row] for row in book[sheet]] for book in books]
            assert cells[0] == cells[1]
    elif ending == ".parquet":
        assert pd.read_parquet(own).equals(pd.read_parquet(other))
    else:
        head = 128 if ending == ".mat" else 0  # holds the date
        assert own.read_bytes()[head:] == other.read_bytes()[head:]


def test_the_report_of_a_map_is_that_of_the_command(mapped, both, epicyclic, tmp_path):
    options = [word for axis, text in AXES.items() for word in (f"--{axis}", text)]
    _, other = both(".nc", "map", *options, "-o", study=mapped, name="netcdf")
    _, content = tasks.saved(mapped, ".html", None, lambda done, total: None)
    page = tmp_path / "map.html"
    assert epicyclic("report", str(other), "-o", str(page)).returncode == 0
    assert WRITTEN.sub(b"", content) == undated(page)
