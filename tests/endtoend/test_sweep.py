"""Sweeps as a user runs them: values, files, failures, resuming."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.study.sweeps.names import with_plain_names
from epicyclic.study.sweeps.run import by_keys, write_netcdf

QUIET = os.environ | {"EPICYCLIC_PROGRESS": "0"}
"""However slow the machine is, nothing is said on the way."""


def names_in(folder):
    return [path.name for path in folder.iterdir()]


def stop_at(count):
    """A progress callback that interrupts the sweep when `count` points are done."""

    def progress(done, total):
        if done == count:
            raise KeyboardInterrupt

    return progress


VARY = {
    "operation.speed": ["1000 rpm", "4000 rpm"],
    "planet.count": [3, 4],
    "operation.torque": ["0 N*m", "-500 N*m", "1000 N*m"],
}


@pytest.fixture(scope="module")
def case(coarse_talbot):
    return coarse_talbot


@pytest.fixture(scope="module")
def dataset(case):
    return ep.sweep(case, VARY, jobs=1)


def test_sweep_equals_single_solutions(case, dataset):
    changes = {"operation.speed": "4000 rpm", "planet.count": 4, "operation.torque": "-500 N*m"}
    result = ep.solve(case.updated(changes))
    point = dataset.sel({"operation.speed": 4000.0, "planet.count": 4, "operation.torque": -500.0})
    for name, watts in result.losses.items():
        assert float(point[name]) == watts
    assert float(point["total"]) == result.total
    assert float(point["efficiency"]) == result.efficiency
    assert float(point["sun_mesh_film_ratio_min"]) == pytest.approx(
        result.meshes["sun_mesh"].film_ratio_min, rel=1e-12
    )


def test_dimensions_have_names_without_dots_beside_their_keys(dataset):
    assert dataset["total"].dims == ("speed", "planet_count", "torque")
    assert dataset.planet_count.attrs["case_key"] == "planet.count"
    chosen = dataset.sel(speed=4000.0, planet_count=3, torque=-500.0)
    by_key = dataset.sel({"operation.speed": 4000.0, "planet.count": 3, "operation.torque": -500.0})
    assert chosen["total"].item() == by_key["total"].item() > 0
    assert chosen["total"].item() != dataset.sel(speed=4000.0, planet_count=4)["total"][1].item()
    assert dataset["operation.torque"].dims == ("torque",)
    for one in (dataset, dataset["total"], dataset.sel(speed=4000.0).total):
        plain = one.isel(torque=1, planet_count=0)
        assert one.isel({"operation.torque": 1}, planet_count=0).identical(plain)


@pytest.mark.slow
def test_a_file_with_keys_as_dimensions_is_read(dataset, tmp_path):
    """As sweeps wrote them, first with keys only, then with names beside them."""
    beside = dataset.swap_dims(
        {
            name: array.attrs["case_key"]
            for name, array in dataset.coords.items()
            if name in dataset.dims
        }
    )
    for number, old in enumerate((beside, beside.drop_vars(dataset.dims))):
        assert old["total"].dims == ("operation.speed", "planet.count", "operation.torque")
        write_netcdf(old, tmp_path / f"{number}.nc")
        assert ep.open_result(tmp_path / f"{number}.nc").identical(dataset)


def test_keys_that_give_the_same_name_have_one_each():
    values = {"sets.a-b.teeth": 21, "sets.a_b.teeth": 34}
    data = xr.Dataset(
        {"total": (list(values), [[7.0]])}, {key: (key, [it]) for key, it in values.items()}
    )
    plain = with_plain_names(data)
    assert plain.sets_a_b_teeth.attrs["case_key"] == "sets.a-b.teeth"
    assert plain.sets_a_b_teeth_.item() == 34


def test_a_key_that_is_also_computed_has_a_dimension_of_its_own(case):
    given = {"sun_mesh.misalignment": ["3 um", "11 um"], "title": ["one", "another"]}
    dataset = ep.sweep(case, given, jobs=1)
    assert dataset["total"].dims == ("sun_mesh_misalignment_given", "title")
    assert list(dataset.sun_mesh_misalignment_given.values) == [3.0, 11.0]
    assert dataset["sun_mesh_misalignment"].dims == dataset["total"].dims


def test_every_number_has_its_unit(dataset):
    numeric = [array for array in dataset.variables.values() if array.dtype.kind in "fi"]
    assert len(numeric) > 40
    assert all(array.attrs["units"] and array.attrs["long_name"] for array in numeric)
    assert dataset["operation.speed"].attrs["units"] == "rpm"
    for key in ("planet.count", "efficiency", "sun_mesh_film_ratio_min"):
        assert dataset[key].attrs["units"] == "1"
    for key in ("status", "message", "warnings"):
        assert dataset[key].attrs["long_name"]
        assert "units" not in dataset[key].attrs


def test_failed_cases_are_rows_with_their_reason(case):
    result = ep.sweep(case, {"planet.count": [3, 12]})
    assert list(result["status"].values) == ["converged", "failed"]
    assert "overlap" in str(result["message"].values[1])
    assert np.isnan(result["total"].values[1])
    assert result["total"].values[0] > 0


def test_variables_do_not_depend_on_what_succeeds(case, dataset):
    failed = ep.sweep(case, {"planet.count": [12, 13]})
    assert list(failed["status"].values) == ["failed", "failed"]
    assert np.isnan(failed["total"].values).all()
    parts = case.updated({"planet_bearing": None, "carrier": None})
    bare = ep.sweep(parts, {"planet.count": [3, 12]})
    assert np.isnan(bare["planet_bearing_radial_force"].values).all()
    for other in (failed, bare):
        assert list(other.data_vars) == list(dataset.data_vars)
        for name, array in dataset.data_vars.items():
            assert other[name].attrs == array.attrs
            assert other[name].dtype == array.dtype


def test_a_pair_has_its_own_variables():
    pair = ep.load_case("talbot-2012-pair")
    data = ep.sweep(pair, {"operation.speed": ["0 rpm", "1000 rpm"]})
    assert {"mesh_sliding", "pinion_torque", "gear_speed", "mesh_backlash"} <= set(data.data_vars)
    assert not any(name.startswith(("sun", "planet")) for name in data.data_vars)


def test_any_error_of_one_point_is_a_row(case, monkeypatch):
    def solve_together(cases, _):
        return [
            RuntimeError("broken") if changed.planet.count == 4 else ep.solve(changed)
            for changed in cases
        ]

    monkeypatch.setattr("epicyclic.study.sweeps.run.solve_together", solve_together)
    result = ep.sweep(case, {"planet.count": [3, 4, 5]}, jobs=1)
    assert list(result["status"].values) == ["converged", "failed", "converged"]
    assert result["message"].values[1] == "RuntimeError: broken"


def test_an_interruption_in_compiled_code_ends_the_sweep(case, monkeypatch):
    def solve_machine(*_):
        raise SystemError("returned a result with an exception set") from KeyboardInterrupt()

    monkeypatch.setattr("epicyclic.machine.solve.solve_machine", solve_machine)
    with pytest.raises(KeyboardInterrupt):
        ep.sweep(case, {"planet.count": [3, 4]}, jobs=1)
    with pytest.raises(KeyboardInterrupt):  # that of a block
        ep.sweep(case, {"operation.torque": [f"{it} N*m" for it in range(400, 424)]}, jobs=1)


def test_a_sweep_goes_on_where_it_stopped(case, dataset, tmp_path):
    journal = tmp_path / "points"
    with pytest.raises(KeyboardInterrupt):
        ep.sweep(case, VARY, jobs=1, journal=journal, progress=stop_at(5))
    calls: list[tuple[int, int]] = []
    again = ep.sweep(case, VARY, jobs=1, journal=journal, progress=lambda *call: calls.append(call))
    assert again.identical(dataset)
    assert calls == [(done, 12) for done in range(5, 13)]


def test_workers_keep_their_points(case, dataset, tmp_path):
    journal = tmp_path / "points"
    ep.sweep(case, VARY, jobs=2, journal=journal)
    calls: list[tuple[int, int]] = []
    again = ep.sweep(case, VARY, journal=journal, progress=lambda *call: calls.append(call))
    assert calls == [(12, 12)]
    assert again.identical(dataset)


@pytest.mark.parametrize(
    ("damage", "left"),
    [
        (lambda data: data[:-20], 4),  # killed while it wrote
        (lambda data: data + b'\n{"sweep', 5),
        (lambda data: data + b"\n\x00\xff\xfe{}\n[]", 5),
        (lambda data: data.replace(b'"total":', b'"total":1'), 0),  # somebody altered all lines
        (lambda data: data[:10], 0),
        (lambda data: b"", 0),
    ],
)
def test_damaged_lines_are_computed_again(case, dataset, tmp_path, damage, left):
    journal = tmp_path / "points"
    with pytest.raises(KeyboardInterrupt):
        ep.sweep(case, VARY, jobs=1, journal=journal, progress=stop_at(5))
    journal.write_bytes(damage(journal.read_bytes()))
    calls: list[tuple[int, int]] = []
    for _ in range(2):
        again = ep.sweep(
            case, VARY, jobs=1, journal=journal, progress=lambda *call: calls.append(call)
        )
        assert again.identical(dataset)
    assert calls[0] == (left, 12)
    assert calls[-1] == (12, 12)


@pytest.mark.parametrize("content", [b"\x00\xff\n", b"my notes\n", b"{}", "another sweep"])
def test_a_file_of_something_else_is_refused(case, tmp_path, content):
    journal = tmp_path / "points"
    if isinstance(content, bytes):
        journal.write_bytes(content)
    else:
        ep.sweep(case, {"planet.count": [3, 4]}, journal=journal)
    before = journal.read_bytes()
    with pytest.raises(ep.InputError, match="something other than points of this sweep"):
        ep.sweep(case, {"planet.count": [3, 5]}, journal=journal)
    assert journal.read_bytes() == before


def test_a_folder_is_no_journal(case, tmp_path):
    with pytest.raises(ep.InputError, match="is not a regular file"):
        ep.sweep(case, {"planet.count": [3, 5]}, journal=tmp_path)


@pytest.fixture(scope="module")
def partly_failed(case):
    """Three axes, with points that fail."""
    return ep.sweep(case, VARY | {"planet.count": [3, 12]}, jobs=1)


@pytest.mark.parametrize("suffix", ["nc", "csv", "parquet"])
def test_files_hold_what_was_computed(partly_failed, tmp_path, epicyclic, coarse_options, suffix):
    output = tmp_path / f"sweep.{suffix}"
    done = epicyclic(
        "sweep", "talbot-2012", *coarse_options, "--vary", "operation.speed=1000,4000 rpm",
        "--vary", "planet.count=3,12", "--vary", "operation.torque=0,-500,1000 N*m",
        "-o", str(output), "--jobs", "2" if suffix == "nc" else "1",
    )  # fmt: skip
    assert done.returncode == 4, done.stderr
    assert names_in(tmp_path) == [output.name]
    assert (partly_failed["status"] == "failed").sum() == 6
    if suffix == "nc":
        with xr.open_dataset(output) as stored:
            assert stored.identical(partly_failed)
        return
    table = pd.read_csv(output) if suffix == "csv" else pd.read_parquet(output)
    assert len(table) == 12
    for name, array in by_keys(partly_failed).variables.items():
        unit = array.attrs.get("units", "1")
        column = table[name if unit == "1" else f"{name} [{unit}]"]
        if name in partly_failed.coords:  # a key, of which the file has one column
            wanted = partly_failed[name].broadcast_like(partly_failed["total"]).values
        else:
            wanted = array.values
        if array.dtype.kind == "O":  # CSV has no empty text
            assert list(column.fillna("")) == list(wanted.ravel())
        else:  # CSV keeps 17 significant digits: exact as well
            np.testing.assert_array_equal(column.to_numpy(), wanted.ravel())
    if suffix == "parquet":
        assert table.attrs == partly_failed.attrs


def test_a_file_says_where_it_comes_from(case, partly_failed):
    attributes = partly_failed.attrs
    again = ep.load_case(json.loads(attributes["case"]))
    assert again == case
    versions = json.loads(attributes["versions"])
    assert versions == ep.solve(case).to_dict()["versions"]
    assert versions["epicyclic"] in attributes["source"]


def test_command_reports_failed_points(tmp_path, epicyclic):
    done = epicyclic(
        "sweep", "talbot-2012", "--vary", "planet.count=3,12", "-o", str(tmp_path / "s.csv")
    )
    assert done.returncode == 4
    assert "1 failed" in done.stderr
    assert "overlap" in done.stderr
    assert len(pd.read_csv(tmp_path / "s.csv")) == 2


def test_a_key_that_changes_no_loss_is_told(tmp_path, epicyclic, coarse_options):
    done = epicyclic(
        *("sweep", "talbot-2012", *coarse_options, "--vary", "thermal.oil_volume=2,3 l"),
        *("--vary", "operation.torque=310,700 N*m", "-o", str(tmp_path / "s.csv")),
    )
    assert done.returncode == 0
    assert "Note: no loss changes with thermal.oil_volume.\n" in done.stderr
    assert "operation.torque." not in done.stderr


def test_points_outside_the_range_of_a_model_are_told(tmp_path, epicyclic, coarse_options):
    """At 200 degC the oil, its viscosity and what follows from it; at 40 degC less."""
    vary = "--vary", "operation.oil_inlet_temperature=40,200 degC"
    done = epicyclic("sweep", "talbot-2012", *coarse_options, *vary, "-o", str(tmp_path / "s.csv"))
    assert done.stderr == (
        "2 of 2 points use a model outside its range, most at operation.oil_inlet_temperature = "
        "200 degC; 'epicyclic run' there names them.\n"
    )


@pytest.mark.parametrize(
    ("output", "words"), [("s.xls", ".parquet"), ("missing/s.csv", "does not exist")]
)
def test_unusable_output_is_refused_before_computing(tmp_path, epicyclic, output, words):
    done = epicyclic(
        "sweep", "talbot-2012", "--vary", "planet.count=3,4", "-o", str(tmp_path / output)
    )
    assert done.returncode == 2
    assert words in done.stderr
    assert names_in(tmp_path) == []


def test_output_may_be_a_link(tmp_path, epicyclic):
    file, link = tmp_path / "s.csv", tmp_path / "link.csv"
    link.symlink_to(file)
    done = epicyclic("sweep", "talbot-2012", "--vary", "planet.count=3,4", "-o", str(link))
    assert done.returncode == 0
    assert link.is_symlink()
    assert len(pd.read_csv(file)) == 2


def test_an_interruption_while_the_file_is_written_keeps_the_points(tmp_path, monkeypatch):
    from epicyclic.cli.main import main
    from epicyclic.study.sweeps import run as dataset

    write = dataset.to_table

    def interrupted(data):
        raise KeyboardInterrupt

    monkeypatch.setattr(dataset, "to_table", interrupted)
    output = tmp_path / "s.csv"
    command = ["epicyclic", "sweep", "talbot-2012", "--vary", "planet.count=3,4", "-o", str(output)]
    monkeypatch.setattr("sys.argv", command)
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 130
    (left,) = names_in(tmp_path)
    assert left.endswith(".partial")
    monkeypatch.setattr(dataset, "to_table", write)
    main()
    assert names_in(tmp_path) == ["s.csv"]


def points_in(folder):
    return sum(path.read_bytes().count(b'"row":') for path in folder.iterdir())


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX signals")
def test_interrupted_command_resumes(tmp_path, coarse_options):
    def command(*vary):
        options = [option for value in vary for option in ("--vary", value)]
        return [
            sys.executable, "-m", "epicyclic", "sweep", "talbot-2012", *options,
            *coarse_options, "--jobs", "1", "-o", str(tmp_path / "s.csv"),
        ]  # fmt: skip

    def call(*vary):
        return subprocess.run(
            command(*vary), capture_output=True, text=True, check=False, env=QUIET
        )

    vary = ("operation.speed=1000:4000:10 rpm", "operation.torque=1:1000:30 N*m")
    running = subprocess.Popen(
        command(*vary), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=QUIET
    )
    deadline = time.monotonic() + 120
    while points_in(tmp_path) < 50:
        assert running.poll() is None, "it ended before it could be interrupted"
        assert time.monotonic() < deadline, "it kept no points"
        time.sleep(0.02)
    running.send_signal(signal.SIGINT)
    output, errors = running.communicate(timeout=60)
    assert running.returncode == 130
    assert output == ""
    said = re.fullmatch(
        r"(\d+) of 300 points kept in (.*); give the same command again to continue.\n"
        r"\n*Interrupted.\n",
        errors,
    )
    assert said is not None, errors
    assert 50 <= int(said[1]) < 300
    (left,) = names_in(tmp_path)
    assert said[2] == str(tmp_path / left)

    other = call("operation.speed=1000,2000 rpm")
    assert other.returncode == 0
    assert f"{said[2]} holds points of an interrupted sweep" in other.stderr
    assert sorted(names_in(tmp_path)) == ["s.csv", left]
    assert len(pd.read_csv(tmp_path / "s.csv")) == 2

    again = call(*vary)
    assert again.returncode == 0, again.stderr
    continued, outside = again.stderr.splitlines()
    assert continued == f"Continuing from {said[1]} of 300 points in {said[2]}."
    assert outside.startswith("300 of 300 points use a model outside its range")
    assert names_in(tmp_path) == ["s.csv"]
    assert len(pd.read_csv(tmp_path / "s.csv")) == 300
