"""The command warm-up."""

from __future__ import annotations

import re

import pandas as pd
import pytest
import xarray as xr

COLD = [
    "warm-up", "talbot-2012-pair", "--for", "30 min", "--set", "operation.torque=60 N*m",
    "--set", "losses.mesh_pocketing.include=false", "--set", "thermal.lubrication=dip",
    "--set", "thermal.oil_volume=1 l", "--set", "thermal.housing.area=0.3 m^2",
    "--set", "thermal.housing.mass=10 kg",
]  # fmt: skip


def test_it_prints_writes_and_draws(epicyclic, tmp_path):
    done = epicyclic(*COLD, "-o", f"{tmp_path}/warm.csv", "--plot", f"{tmp_path}/warm.png")
    assert done.returncode == 0, done.stderr
    for text in ("settled", "time constants", "energy lost", "housing"):
        assert text in done.stdout
    table = pd.read_csv(tmp_path / "warm.csv")
    assert table["oil_temperature [degC]"].iloc[0] == pytest.approx(20.0)
    assert table["time [s]"].iloc[-1] == 1800.0
    assert table["oil_temperature [degC]"].is_monotonic_increasing
    assert (tmp_path / "warm.png").stat().st_size > 10_000


def test_warnings_are_those_of_the_start_and_of_the_settled_state(epicyclic):
    hot = "--set", "operation.oil_inlet_temperature=110 degC", "--from", "15 degC"
    done = epicyclic(*COLD, "--set", "thermal.ambient_temperature=105 degC", *hot)
    assert done.returncode == 0, done.stderr
    start, settled = done.stderr.split(" in the settled state: ")
    assert "at the start: " in start
    assert "The temperature is 15 °C, but oil atf-talbot-2012 is valid only from 25" in start
    assert re.search(r"The temperature is 1\d\d to 1\d\d °C, but oil", settled)


@pytest.mark.slow
def test_a_cycle_and_another_start(epicyclic, tmp_path):
    rows = "time [s],speed [rpm],torque [N*m]\n0,0,0\n60,2000,60\n240,2000,60\n300,500,-30\n"
    (tmp_path / "cycle.csv").write_text(rows, encoding="utf-8")
    done = epicyclic(
        *COLD, "--from", "30 degC", "--cycle", f"{tmp_path}/cycle.csv", "-o", f"{tmp_path}/warm.nc"
    )
    assert done.returncode == 0, done.stderr
    with xr.open_dataset(tmp_path / "warm.nc") as data:
        assert data["temperature"].values[0] == pytest.approx(30.0)
        assert float(data["time"][-1]) == 1800.0


def test_what_is_missing_is_told(epicyclic):
    keys = ("thermal.housing.area=0.3 m^2", "thermal.oil_volume=")
    done = epicyclic(*COLD[:4], *(option for key in keys for option in ("--set", key)))
    assert done.returncode == 2
    assert "thermal.oil_volume" in done.stderr
    assert "thermal.housing.mass" in done.stderr
