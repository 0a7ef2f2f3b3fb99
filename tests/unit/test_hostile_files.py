"""Files that are not what they should be: a clear error, soon, and in little memory."""

from __future__ import annotations

import os
import pathlib
import time
import zipfile

import numpy as np
import pandas as pd
import pytest

import epicyclic as ep
from epicyclic.contact.fitted_models import read_oil_model
from epicyclic.losses.loss_table import read_loss_table
from epicyclic.losses.pocket_tables import read_stored
from epicyclic.plugins.contact_solver.campaign import open_folder
from epicyclic.plugins.contact_solver.contact import contact_model, load_contact_case
from epicyclic.plugins.contact_solver.surfaces import read_profile
from epicyclic.plugins.rexs.importing import read_rexs
from epicyclic.show.record import open_map
from epicyclic.study.maps.cycle import open_cycle
from epicyclic.study.measured.table import parse_measurements
from epicyclic.study.sweeps.runner import Journal, Runner, read_heading
from epicyclic.study.table_file import read_grid
from limits import MOST_MEMORY, is_soon, peak_memory


def read_measurements(path):
    return parse_measurements(read_grid(path), ep.load_case("talbot-2012"))


def read_contact(path):
    return contact_model(load_contact_case(path))


def read_campaign(path):
    return open_folder(path.parent)


def read_journal(path):
    return Journal(path, "0123456789ab").read()


def sweep_points(path):
    return ep.sweep(ep.load_case("talbot-2012"), points=path)


READERS = {
    "case.toml": ep.load_case,
    "contact.toml": read_contact,
    "profile.csv": read_profile,
    "profile.x3p": read_profile,
    "measured.csv": read_measurements,
    "measured.xlsx": read_measurements,
    "measured.parquet": read_measurements,
    "cycle.csv": open_cycle,
    "cycle.parquet": open_cycle,
    "gears.rexs": read_rexs,
    "gears.rexsj": read_rexs,
    "gears.rexsz": read_rexs,
    "drag.csv": read_loss_table,
    "points.csv": sweep_points,
    "map.nc": open_map,
    "result.nc": ep.open_result,
    "model.json": read_oil_model,
    "pockets.nc": read_stored,
    "campaign.json": read_campaign,
    "sweep.nc.0123456789ab.partial": read_journal,
    "sweep.nc.shard-1-of-2": read_heading,
}


def refusal(read, path):
    """The message of `read` for a file that it must refuse, in bounded time and memory."""
    before, start = peak_memory(), time.process_time()
    with pytest.raises(ep.InputError) as error:
        read(path)
    assert is_soon(time.process_time() - start)
    assert peak_memory() - before < MOST_MEMORY
    message = str(error.value)
    assert len(message) < 5000
    return message


HOSTILE = {
    "empty": b"",
    "blank lines": b"\n\n  \n",
    "binary": np.random.default_rng(1).bytes(300_000),
    "zero bytes": bytes(1000),
    "latin-1": "temperature [°C]\n12\n# Öl".encode("latin-1"),
    "utf-16": "speed [rpm],torque [N*m]\n1,2\n".encode("utf-16"),
    "prose": b"Dear colleague,\nplease find the losses attached.\nBest regards\n",
    "one long line": b"1," * 4_000_000,
    "many short lines": b"1\n" * 4_000_000,
    "open quote": b'a = "' + b"x\n" * 100_000,
    "brackets": b"a = " + b"[" * 400_000,
    "braces": b"a = " + b"{a=" * 300_000,
    "dotted key": b".".join([b"a"] * 400_000) + b" = 1",
    "many tables": b"".join(b"[t%d]\n" % number for number in range(60_000)),
    "long number": b"a = " + b"9" * 900_000,
}
LONG = ("many tables",)
CONTENTS = [pytest.param(it, marks=pytest.mark.slow if it in LONG else ()) for it in HOSTILE]


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("content", CONTENTS)
def test_what_is_no_such_file_is_refused(tmp_path, name, content):
    if name.endswith(".partial") and content in ("empty", "blank lines"):
        pytest.skip("an unfinished journal may be empty")
    if name == "points.csv" and content in ("latin-1", "utf-16"):
        pytest.skip("these are points")
    path = tmp_path / name
    path.write_bytes(HOSTILE[content])
    refusal(READERS[name], path)


def workbook(path, sheet):
    """A workbook with `sheet` as the XML of its only sheet."""
    from openpyxl import Workbook

    whole = path.with_name("whole.xlsx")
    Workbook().save(whole)
    with zipfile.ZipFile(whole) as source, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as to:
        for name in source.namelist():
            is_sheet = name.startswith("xl/worksheets/sheet")
            to.writestr(name, sheet if is_sheet else source.read(name))


def test_a_zip_bomb_is_refused(tmp_path):
    workbook(tmp_path / "bomb.xlsx", b"<worksheet>" + b" " * 20_000_000 + b"</worksheet>")
    assert (tmp_path / "bomb.xlsx").stat().st_size < 1e6
    assert "expands to more" in refusal(read_measurements, tmp_path / "bomb.xlsx")


def test_an_entity_bomb_is_refused(tmp_path):
    entities = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10 if n else "lol"}">' for n in range(12))
    sheet = (
        f"<!DOCTYPE worksheet [{entities}]>"
        '<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>'
        '<row r="1"><c r="A1" t="inlineStr"><is><t>&e11;</t></is></c></row></sheetData></worksheet>'
    )
    workbook(tmp_path / "bomb.xlsx", sheet.encode())
    refusal(read_measurements, tmp_path / "bomb.xlsx")


def test_a_table_of_too_many_rows_is_refused(tmp_path):
    path = tmp_path / "recording.parquet"
    pd.DataFrame({"loss [W]": np.zeros(5_000_000)}).to_parquet(path)
    assert path.stat().st_size < 1e6
    assert "10000 rows" in refusal(read_measurements, path)


@pytest.mark.parametrize("name", ["measured.xlsx", "measured.parquet"])
def test_a_truncated_table_is_refused(tmp_path, name):
    table = pd.DataFrame({"loss [W]": [1.0, 2.0]})
    path = tmp_path / name
    (table.to_excel if name.endswith("xlsx") else table.to_parquet)(path)
    path.write_bytes(path.read_bytes()[:-200])
    refusal(read_measurements, path)


@pytest.mark.parametrize("name", READERS)
def test_a_huge_file_is_refused(tmp_path, name):
    path = tmp_path / name
    with path.open("wb") as file:
        file.truncate(2_000_000_000)  # takes no room on the disk
    refusal(READERS[name], path)


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("kind", ["missing", "folder", "pipe"])
def test_what_is_no_file_is_refused(tmp_path, name, kind):
    if name.endswith(".partial") and kind == "missing":
        pytest.skip("a journal begins with its first point")
    path = tmp_path / name
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    refusal(READERS[name], path)


def test_a_file_whose_content_is_to_come_is_refused(tmp_path, monkeypatch):
    """As some of the system, which look like files and keep a reader waiting."""
    path = tmp_path / "case.toml"
    os.mkfifo(path)
    writer = os.open(path, os.O_RDWR)
    monkeypatch.setattr(pathlib.Path, "is_file", lambda self: True)
    with pytest.raises(ep.InputError, match="no content now"):
        ep.load_case(path)
    os.close(writer)


UPLOADS = [name for name in READERS if name.endswith((".toml", ".rexs", ".rexsj", ".rexsz"))]


@pytest.mark.parametrize("name", UPLOADS)
@pytest.mark.parametrize("content", CONTENTS)
def test_the_app_refuses_such_an_upload(tmp_path, name, content):
    desk = pytest.importorskip("epicyclic.plugins.app.case_form")
    path = tmp_path / "app"
    path.mkdir()
    refusal(lambda folder: desk.received([(name, HOSTILE[content])], folder), path)


@pytest.mark.parametrize(
    "address",
    [
        "", " ", "a", "tcp:/", "tcp://", "tcp://h:x", "http://h", "9" * 400,
        pytest.param("tcp://127.0.0.1:1", marks=pytest.mark.slow),  # ten seconds of attempts
    ],
)  # fmt: skip
def test_no_address_of_a_cluster_is_refused(address):
    pytest.importorskip("distributed")
    refusal(lambda text: Runner(dask=text).check(), address)
