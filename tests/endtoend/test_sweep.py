"""Sweeps as a user runs them: values, files, failures, resuming."""

from __future__ import annotations

import signal
import subprocess
import sys
import time

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.sweeps import run as run_module


def names_in(folder):
    return [path.name for path in folder.iterdir()]


VARY = {
    "operation.speed": ["1000 rpm", "4000 rpm"],
    "planet.count": [3, 4],
    "operation.torque": ["0 N*m", "-500 N*m", "1000 N*m"],
}


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012")


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


def test_every_variable_has_its_unit(dataset):
    numeric = [array for array in dataset.data_vars.values() if array.dtype.kind == "f"]
    assert len(numeric) > 40
    assert all(array.attrs["units"] and array.attrs["long_name"] for array in numeric)
    assert dataset["operation.speed"].attrs["units"] == "rpm"


def test_processes_give_the_same_bits(case, dataset):
    assert ep.sweep(case, VARY, jobs=2).identical(dataset)


def test_failed_cases_are_rows_with_their_reason(case):
    result = ep.sweep(case, {"planet.count": [3, 12]})
    assert list(result["status"].values) == ["converged", "failed"]
    assert "overlap" in str(result["message"].values[1])
    assert np.isnan(result["total"].values[1])
    assert result["total"].values[0] > 0


def test_a_sweep_of_failures_only_is_still_a_dataset(case):
    result = ep.sweep(case, {"planet.count": [12, 13]})
    assert list(result["status"].values) == ["failed", "failed"]


def test_a_sweep_goes_on_where_it_stopped(case, dataset, tmp_path, monkeypatch):
    journal = tmp_path / "sweep.partial"
    monkeypatch.setattr(run_module, "BATCH", 1)
    solved: list[int] = []
    original = run_module.solve_row

    def interrupted(plan, index):
        if len(solved) == 5:
            raise KeyboardInterrupt
        solved.append(index)
        return original(plan, index)

    monkeypatch.setattr(run_module, "solve_row", interrupted)
    with pytest.raises(KeyboardInterrupt):
        ep.sweep(case, VARY, jobs=1, journal=journal)
    again: list[int] = []
    monkeypatch.setattr(
        run_module, "solve_row", lambda plan, index: again.append(index) or original(plan, index)
    )
    result = ep.sweep(case, VARY, jobs=1, journal=journal)
    assert result.identical(dataset)
    assert len(again) == 12 - 5
    assert not set(again) & set(solved)


@pytest.mark.parametrize("suffix", ["nc", "csv", "parquet"])
def test_files_hold_what_was_computed(dataset, tmp_path, epicyclic, suffix):
    output = tmp_path / f"sweep.{suffix}"
    done = epicyclic(
        "sweep", "talbot-2012", "--vary", "operation.speed=1000,4000 rpm",
        "--vary", "planet.count=3,4", "--vary", "operation.torque=0,-500,1000 N*m",
        "-o", str(output),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert names_in(tmp_path) == [output.name]
    if suffix == "nc":
        with xr.open_dataset(output) as stored:
            total = stored["total"].values
            assert stored["total"].attrs["units"] == "W"
            np.testing.assert_array_equal(
                stored["operation.speed"].values, dataset["operation.speed"].values
            )
    else:
        table = pd.read_csv(output) if suffix == "csv" else pd.read_parquet(output)
        total = table["total [W]"].to_numpy().reshape(2, 2, 3)
        assert list(table["operation.speed [rpm]"].unique()) == [1000.0, 4000.0]
    # CSV keeps 17 significant digits: exact as well
    np.testing.assert_array_equal(total, dataset["total"].values)


def test_command_reports_failed_cases(tmp_path, epicyclic):
    done = epicyclic(
        "sweep", "talbot-2012", "--vary", "planet.count=3,12", "-o", str(tmp_path / "s.csv")
    )
    assert done.returncode == 4
    assert "1 failed" in done.stderr
    assert "overlap" in done.stderr
    assert len(pd.read_csv(tmp_path / "s.csv")) == 2


@pytest.mark.parametrize(
    ("output", "words"),
    [("s.xls", ".parquet"), ("missing/s.csv", "no place for a file")],
)
def test_unusable_output_is_refused_before_computing(tmp_path, epicyclic, output, words):
    done = epicyclic(
        "sweep", "talbot-2012", "--vary", "planet.count=3,4", "-o", str(tmp_path / output)
    )
    assert done.returncode == 2
    assert words in done.stderr
    assert names_in(tmp_path) == []


@pytest.mark.skipif(sys.platform == "win32", reason="needs POSIX signals")
def test_interrupted_command_resumes(tmp_path):
    command = [
        sys.executable, "-m", "epicyclic", "sweep", "talbot-2012",
        "--vary", "operation.speed=1000:4000:60 rpm", "--vary", "operation.torque=1:1000:60 N*m",
        "--jobs", "1", "-o", str(tmp_path / "s.csv"),
    ]  # fmt: skip
    journal = tmp_path / "s.csv.partial"
    first = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120
    while time.monotonic() < deadline:
        if journal.exists() and len(journal.read_text().splitlines()) > 50:
            break
        time.sleep(0.02)
    first.send_signal(signal.SIGINT)
    _, errors = first.communicate(timeout=60)
    assert first.returncode == 130
    assert "Traceback" not in errors
    assert names_in(tmp_path) == [journal.name]
    kept = journal.read_text().splitlines()[1:]
    assert len(kept) >= 50
    second = subprocess.run(command, capture_output=True, text=True, check=False)
    assert second.returncode == 0, second.stderr
    assert names_in(tmp_path) == ["s.csv"]
    assert len(pd.read_csv(tmp_path / "s.csv")) == 3600
