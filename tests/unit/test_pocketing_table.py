"""Tables of pocketing losses: made, written, and read by cases in place of the flow."""

from __future__ import annotations

import json
from importlib.resources import files

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.files import sealed
from epicyclic.losses.pocket_tables import FlowFamily, read_stored, stored_table
from epicyclic.machine.pocket_flow import flow_family
from epicyclic.study.pockets import mesh_duties
from epicyclic.study.sweeps.run import make_plan, write_dataset
from epicyclic.study.sweeps.runner import fingerprint

COARSE = {
    "numerics.pocket_slices": 4,
    "numerics.pocket_steps": 12,
    "models.load_distribution": "uniform",
    "models.pocketing": "mean-density",
}
SPEEDS = ["0 rpm", "6000 rpm", "12000 rpm"]
CLOSE = 0.005
"""The error is measured at some flows and bounded by 0.002 there; others may be somewhat worse."""


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012-pair").updated(COARSE)


@pytest.fixture(scope="module")
def table(case):
    return ep.pocketing_table(case, SPEEDS, ["40 degC", "90 degC"])


@pytest.fixture(scope="module")
def file(table, tmp_path_factory):
    path = tmp_path_factory.mktemp("table") / "pockets.nc"
    write_dataset(table, path)
    return path


@pytest.fixture
def reading(case, file):
    return case.updated({"models.pocketing_table": str(file)})


def pocketing(case):
    return next(term for term in ep.solve(case).terms if term.name == "mesh_pocketing")


@pytest.mark.parametrize(("driver", "torque"), [(1, "100 N*m"), (2, "-100 N*m")])
def test_power_is_that_of_the_flow_for_either_driving_member(case, table, driver, torque):
    there = {
        "operation.torque": torque,
        "operation.speed": "6000 rpm",
        "operation.oil_inlet_temperature": "40 degC",
    }
    told = table["power"].sel(mesh="mesh", driver=driver, speed=6000, temperature=40)
    assert float(told) == pytest.approx(pocketing(case.updated(there)).watts, rel=CLOSE)


def test_dataset_states_units_errors_and_rest(case, table):
    assert table["power"].dims == ("mesh", "driver", "speed", "temperature")
    assert (table["power"].sel(speed=0) == 0).all()
    assert table["power"].attrs["units"] == "W"
    assert table["speed"].attrs["units"] == "rpm"
    errors = table["interpolation_error"]
    assert 0 < errors.max() <= case.numerics.pocket_interpolation


def test_case_reads_the_table_at_other_states_of_the_same_number(case, reading, monkeypatch):
    """Speed, oil temperature and pressure are none of the table's."""
    other = {
        "operation.speed": "7300 rpm",
        "operation.oil_inlet_temperature": "65 degC",
        "surroundings.pressure": "0.9 bar",
    }
    solved = pocketing(case.updated(other))
    monkeypatch.setattr(FlowFamily, "flow", None)
    read = pocketing(reading.updated(other))
    assert read.watts == pytest.approx(solved.watts, rel=CLOSE)
    assert "table pockets.nc, interpolated within 0." in read.method


def test_flow_outside_the_table_is_solved_and_said_so(case, reading):
    fast = {"operation.speed": "15000 rpm"}
    result = ep.solve(reading.updated(fast))
    assert any("models.pocketing_table does not cover" in note for note in result.notes)
    assert pocketing(reading.updated(fast)).watts == pocketing(case.updated(fast)).watts


def test_sweep_reads_the_table_at_all_points(reading, monkeypatch):
    monkeypatch.setattr(FlowFamily, "flow", None)
    monkeypatch.setattr(FlowFamily, "scaled", None)
    speeds = [f"{speed} rpm" for speed in np.linspace(6500, 9500, 9)]
    swept = ep.sweep(reading, {"operation.speed": speeds}, jobs=1)
    assert (swept["status"] != "failed").all()
    assert (np.diff(swept["mesh_pocketing"]) > 0).all()


def test_all_that_differs_from_the_pockets_of_the_table_is_named(reading):
    changed = {"surroundings.oil_air_ratio": 0.06, "pinion.tip_diameter": "53.9 mm"}
    with pytest.raises(ep.InputError) as error:
        ep.solve(reading.updated(changed))
    tip, tool, oil = (problem.allowed for problem in error.value.problems)
    assert tip == "was made for a mesh with mesh.gear1.tip_radius = 0.027, not 0.02695."
    assert "tools.2.tip_radius" in tool  # the default rounding follows the clearance
    assert oil == "was made for a mesh with oil_fraction = 0.05, not 0.06."


def test_set_without_a_table_in_the_file_is_refused(file):
    with pytest.raises(ep.InputError, match="has no table for a sun mesh"):
        ep.solve(ep.load_case("talbot-2012", {"models.pocketing_table": str(file)}))


def test_table_comes_back_as_it_was_made(case, file):
    family = flow_family(mesh_duties(case)[0])
    stored = stored_table(file, family)
    assert stored.readable.any()
    middle = len(stored.number) // 2
    assert stored.scaled[middle] == pytest.approx(family.scaled(stored.number[middle]), rel=1e-9)


@pytest.mark.parametrize("content", [b"", b"speed,power\n", b"\x89HDF\r\n\x1a\n damaged"])
def test_other_files_are_refused_when_the_case_is_loaded(case, tmp_path, content):
    path = tmp_path / "other.nc"
    path.write_bytes(content)
    with pytest.raises(ep.InputError, match=r"is not a NetCDF 4 file|is damaged"):
        case.updated({"models.pocketing_table": str(path)})


def resealed(text):
    """Altered tables with the fingerprint of what they hold now."""
    content = json.loads(text)
    del content["fingerprint"]
    return sealed(content)


def test_altered_tables_are_refused(table, tmp_path):
    path = tmp_path / "changed.nc"
    flows = table.attrs["flows"]
    write_dataset(table.assign_attrs(flows=flows.replace('"scaled":[[', '"scaled":[[1')), path)
    with pytest.raises(ep.InputError, match="was altered"):
        read_stored(path)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"version":"', '"version":"9', "was made by version 9"),
        ('"readable":[', '"readable":[true,', "differ"),
        ('"number":[', '"number":[1e9,', "differ"),
        ('"error":', '"error":NaN,"was":', "is damaged"),
        ('"error":', '"error":-', "is damaged"),
        ('"scaled":[[', '"scaled":[[-', "a power is below zero"),
    ],
)
def test_damaged_and_other_tables_are_refused(table, tmp_path, old, new, said):
    path = tmp_path / "changed.nc"
    flows = table.attrs["flows"]
    assert old in flows
    write_dataset(table.assign_attrs(flows=resealed(flows.replace(old, new))), path)
    with pytest.raises(ep.InputError, match=said):
        read_stored(path)


def test_file_is_found_from_the_folder_of_the_case(file):
    path = file.with_name("case.toml")
    text = (files("epicyclic") / "library/cases/talbot-2012-pair.toml").read_text("utf-8")
    named = text.replace("[models]\n", '[models]\npocketing_table = "pockets.nc"\n')
    path.write_text(named, encoding="utf-8")
    assert "table pockets.nc" in pocketing(ep.load_case(path, COARSE)).method


def test_sweep_does_not_resume_with_another_table(case, table, tmp_path):
    path = tmp_path / "pockets.nc"
    prints = []
    for title in ("one", "two"):
        write_dataset(table.assign_attrs(title=title), path)
        reading = case.updated({"models.pocketing_table": str(path)})
        prints.append(fingerprint(make_plan(reading, {"operation.speed": ["1 rpm"]})))
    assert prints[0] != prints[1]


@pytest.mark.parametrize(
    ("changes", "speeds", "said"),
    [
        ({"numerics.pocket_interpolation": 0}, SPEEDS, "must be above 0, because"),
        ({}, ["0 rpm"], "stands still"),
        ({}, ["10 mm"], "operation.speed"),
    ],
)
def test_unsuitable_input_is_refused(case, changes, speeds, said):
    with pytest.raises(ep.InputError, match=said):
        ep.pocketing_table(case.updated(changes), speeds)
