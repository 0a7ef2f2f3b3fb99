"""Trains in sweeps, loss maps, duty cycles and comparisons, as a user runs them."""

from __future__ import annotations

import csv
import re

import numpy as np
import openpyxl
import pandas as pd
import pytest
import scipy.io
import xarray as xr

import epicyclic as ep
from epicyclic.plugins.simulators import fmu
from epicyclic.study.maps.compute import map_plan

SPEED = ["0 rpm", "1000 rpm", "3000 rpm"]
TORQUE = ["-200 N*m", "0 N*m", "200 N*m"]
STATES = ("1", "2", "3", "4", "5", "6", "7", "8", "R")
COMMAND = ("map", "train-8hp70", "--speed", "0,1000,3000 rpm", "--torque", "-200,0,200 N*m")
CYCLE = {
    "time [s]": [0, 5, 10, 15],
    "speed [rpm]": [0, 1200, 2500, 1500],
    "torque [N*m]": [40, 150, -60, 90],
    "state": ["1", "2", "R", "8"],
}


@pytest.fixture(scope="module")
def gearbox():
    return ep.load_case("train-8hp70")


@pytest.fixture(scope="module")
def data(gearbox):
    return ep.loss_map(gearbox, SPEED, TORQUE, jobs=1)


@pytest.fixture(scope="module")
def computed():
    """The planetary set of the e-axle with two speeds, its losses computed, without pockets."""
    tables = ep.load_case("train-eaxle").given()
    planets = tables["sets"]["planets"] | {
        "losses": {
            name: {"include": False} for name in ("sun_mesh_pocketing", "ring_mesh_pocketing")
        },
        "models": {"load_distribution": "uniform"},
    }
    return ep.load_case(
        {
            "kind": "train",
            "sets": {"P": planets},
            "lubricant": tables["lubricant"],
            "states": {
                "low": {"fixed": ["P.ring"]},
                "direct": {"joined": [["P.sun", "P.ring"]]},
                "neutral": {},
            },
            "operation": {
                "state": "low",
                "input": "P.sun",
                "output": "P.carrier",
                "torque": "100 N*m",
                "speed": "2000 rpm",
                "oil_inlet_temperature": "80 degC",
            },
        }
    )


# --- maps -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(("state", "torque"), [("1", 200.0), ("R", -200.0), ("6", 200.0)])
def test_a_point_of_a_map_is_a_solution(gearbox, data, state, torque):
    result = ep.solve(
        gearbox.updated(
            {
                "operation.state": state,
                "operation.speed": "3000 rpm",
                "operation.torque": f"{torque} N*m",
            }
        )
    )
    point = data.sel(state=state, speed=3000, torque=torque)
    assert {name: float(point[name]) for name in result.losses} == result.losses
    assert float(point["total"]) == result.total
    assert float(point["efficiency"]) == result.efficiency
    assert float(point["power_ratio"]) == result.train.power_ratio
    assert float(point["ratio"]) == pytest.approx(result.train.ratio, rel=1e-12)
    for name, shaft in result.flow.members.items():
        assert float(point[f"{name}_torque"]) == shaft.torque


def test_a_train_without_an_oil_has_no_temperature(data):
    assert data["torque_loss"].dims == ("speed", "torque", "state")
    assert "temperature" not in data.coords
    assert tuple(data["state"].values) == STATES
    assert data["ratio"].dims == ("state",)
    assert data["ratio"].attrs["units"] == "1"
    assert not [name for name in data.data_vars if "rolling" in name]
    assert (data["status"] == "converged").all()


def test_the_stated_balance_gives_the_torque_of_the_output(data):
    passed = (data["torque"] - data["torque_loss"]) * data["ratio"]
    wanted = -data["output_torque"].transpose(*passed.dims)
    np.testing.assert_allclose(passed.values, wanted.values, rtol=1e-9, atol=1e-9)
    assert data.attrs["reference_shaft"] == "input"
    assert data.attrs["output_shaft"] == "output"


def test_states_that_cannot_run_are_left_out_or_refused(computed, epicyclic, tmp_path):
    plan = map_plan(computed, ["1 rpm"], ["1 N*m"])
    assert plan.axes[0].values == ("low", "direct")
    with pytest.raises(ep.InputError, match='states = "neutral": leaves one degree of freedom'):
        ep.loss_map(computed, ["1 rpm"], ["1 N*m"], states=["low", "neutral"])
    with pytest.raises(ep.InputError, match="Did you mean 'direct'"):
        ep.loss_map(computed, ["1 rpm"], ["1 N*m"], states=["direkt"])
    with pytest.raises(ep.InputError, match="the case has none"):
        ep.loss_map(ep.load_case("talbot-2012"), ["1 rpm"], ["1 N*m"], states=["1"])


def test_a_map_of_computed_losses_has_temperatures_and_states(computed):
    data = ep.loss_map(
        computed, ["0 rpm", "2000 rpm"], ["-50 N*m", "50 N*m"], ["40 degC", "80 degC"], jobs=1
    )
    assert data["torque_loss"].dims == ("speed", "torque", "temperature", "state")
    assert (data["status"] == "converged").all()
    assert data.attrs["states_left_out"].startswith("neutral: leaves one degree of freedom")
    np.testing.assert_allclose(data["ratio"].values, [1 + 85 / 31, 1.0], rtol=1e-12)
    low = data.sel(state="low", speed=2000)
    direct = data.sel(state="direct", speed=2000)  # which turns as one and slides nowhere
    assert (low["load_dependent"] > direct["load_dependent"]).all()
    assert {"P.sun_mesh_sliding", "P.planet_bearing_viscous", "P.carrier_drag"} <= set(data)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--states", "1,N"), "is not a state of the train"),
        (("--temperature", "40,80 degC"), "every loss of the train is given"),
        (("--vary", "operation.state=1,2"), "is varied by states"),
        (("--vary", "operation.output=input"), "defines the shafts"),
        (("--vary", "sets.P1.eficiency=0.9"), "Did you mean 'sets.P1.efficiency'"),
    ],
)
def test_bad_commands_are_refused(tmp_path, epicyclic, options, words):
    done = epicyclic(*COMMAND, *options, "-o", str(tmp_path / "map.nc"))
    assert done.returncode == 2
    assert words in done.stderr


def test_one_chosen_state_keeps_its_dimension(gearbox):
    data = ep.loss_map(gearbox, SPEED, TORQUE, states="R", jobs=1)
    assert list(data["state"].values) == ["R"]
    assert data["ratio"].item() < 0


def test_keys_of_sets_are_axes_of_a_map(gearbox):
    data = ep.loss_map(
        gearbox, ["1000 rpm"], ["100 N*m"], vary={"sets.P4.efficiency": [0.9, 1.0]}, states=["1"]
    )
    assert data["sets_P4_efficiency"].attrs["case_key"] == "sets.P4.efficiency"
    assert (data["total"].diff("sets_P4_efficiency") < 0).all()


# --- files ----------------------------------------------------------------------------------------


def test_netcdf_and_tables_keep_the_states(data, tmp_path, epicyclic):
    done = epicyclic(*COMMAND, "-o", str(tmp_path / "map.nc"))
    assert done.returncode == 0, done.stderr
    assert done.stderr == "" or done.stderr.startswith("Interpolated linearly in torque; ")
    with xr.open_dataset(tmp_path / "map.nc") as stored:
        xr.testing.assert_identical(stored.drop_attrs(), data.drop_attrs())
    ep.write_map(data, tmp_path / "map.csv")
    ep.write_map(data, tmp_path / "map.parquet")
    for table in (
        pd.read_csv(tmp_path / "map.csv", comment="#", dtype={"state": str}),
        pd.read_parquet(tmp_path / "map.parquet"),
    ):
        own = table[(table["state"] == "3") & (table["speed [rpm]"] == 3000)]
        wanted = data.sel(state="3", speed=3000)
        np.testing.assert_allclose(own["torque_loss [N*m]"], wanted["torque_loss"], rtol=1e-12)
        np.testing.assert_allclose(own["ratio"], float(wanted["ratio"]), rtol=1e-12)


def test_a_workbook_has_a_sheet_for_each_state(data, tmp_path):
    ep.write_map(data, tmp_path / "map.xlsx")
    book = openpyxl.load_workbook(tmp_path / "map.xlsx")
    sheets = [title for name in STATES for title in (f"state {name}", f"{name}, speed by torque")]
    assert book.sheetnames == ["overview", *sheets, "inputs", "about"]
    heads, *rows = book["overview"].iter_rows(values_only=True)
    assert [row[0] for row in rows] == list(STATES)
    assert rows[0][heads.index("ratio")] == pytest.approx(float(data["ratio"][0]), rel=1e-14)
    assert rows[0][heads.index("fixed")] == "suns, P1.ring"
    assert rows[0][heads.index("joined")] == "input + third"
    names, _, *points = book["state R"].iter_rows(values_only=True)
    table = pd.DataFrame(points, columns=names)
    wanted = data["torque_loss"].sel(state="R").values.ravel()
    np.testing.assert_allclose(table["torque_loss"], wanted, rtol=1e-14)


@pytest.mark.parametrize(
    ("name", "format"), [("box.vtlm", None), ("box.mo", None), ("box.csv", "gem")]
)
def test_formats_of_one_table_have_a_file_for_each_state(data, tmp_path, name, format):
    chosen = data.sel(torque=[0, 200]) if format == "gem" else data
    ep.write_map(chosen, tmp_path / name, format)
    stem, _, suffix = name.partition(".")
    files = sorted(path.name for path in tmp_path.iterdir())
    assert files == sorted(f"{stem}-{state}.{suffix}" for state in STATES)
    text = (tmp_path / f"{stem}-R.{suffix}").read_text(encoding="utf-8")
    assert "state: R" in text
    assert "ratio: -3.2967" in text
    ep.write_map(chosen.sel(state=["R"]), tmp_path / name, format)
    assert (tmp_path / name).read_text(encoding="utf-8").replace("Box ", "Box_R ").replace(
        "Box;", "Box_R;"
    ) == text


def test_vecto_rows_are_those_of_the_state(data, tmp_path):
    ep.write_map(data, tmp_path / "box.vtlm")
    for state in ("1", "8"):
        lines = (tmp_path / f"box-{state}.vtlm").read_text(encoding="utf-8").splitlines()
        table = np.array(list(csv.reader(lines[1:])), dtype=float)
        wanted = data["torque_loss"].sel(state=state).values.ravel()
        np.testing.assert_allclose(table[:, 2], wanted, rtol=1e-9)


def test_states_whose_files_would_be_one_are_refused(data, tmp_path):
    twins = data.isel(state=[0, 1]).assign_coords(state=["a/b", "a b"])
    with pytest.raises(ep.InputError, match="lead to the same file"):
        ep.write_map(twins, tmp_path / "box.vtlm")


def test_matlab_and_simscape_have_the_dimension(data, tmp_path):
    ep.write_map(data, tmp_path / "box.mat")
    stored = scipy.io.loadmat(tmp_path / "box.mat", simplify_cells=True)["loss_map"]
    assert list(stored["dimensions"]) == ["speed", "torque", "state"]
    assert list(stored["state"]) == list(STATES)
    np.testing.assert_array_equal(stored["P4_sun_mesh"], data["P4.sun_mesh"].values)
    assert all(re.fullmatch(r"[A-Za-z]\w*", name) for name in stored)
    ep.write_map(data, tmp_path / "box.m")
    text = (tmp_path / "box.m").read_text(encoding="utf-8")
    assert "Temp_bpts" not in text
    assert "state_names = {'1', '2'," in text
    (body,) = re.findall(
        r"torque_loss_tbl = reshape\(\[ \.\.\.[^\n]*\n(.*?)\], \[3 3 9\]", text, re.S
    )
    numbers = np.array(body.replace("...", "").split(), float).reshape((3, 3, 9), order="F")
    wanted = data["torque_loss"].transpose("torque", "speed", "state").values
    np.testing.assert_allclose(numbers, wanted, rtol=1e-9)


def test_an_fmu_selects_the_map_by_the_number_of_the_state(data, tmp_path):
    if fmu.fmu_problems({"speed": [1]}):
        pytest.skip("a library of the FMU is not installed")
    import fmpy

    path = tmp_path / "box.fmu"
    ep.write_map(data, path)
    variables = {v.name: v for v in fmpy.read_model_description(path).modelVariables}
    assert "temperature" not in variables
    assert variables["state"].causality == "input"
    assert "9 = R (ratio -3.29" in variables["state"].description
    for number, inside in ((1, True), (9, True), (9.3, False), (12, False)):
        outputs = ["torque_loss", "efficiency", "inside_map"]
        values = {"speed": 100 * np.pi, "torque": 200.0, "state": float(number)}
        last = fmpy.simulate_fmu(path, start_values=values, stop_time=1, output=outputs)[-1]
        wanted = data.isel(state=min(int(number), 9) - 1).sel(speed=3000, torque=200)
        assert last["torque_loss"] == pytest.approx(float(wanted["torque_loss"]), rel=1e-12)
        assert last["efficiency"] == pytest.approx(float(wanted["efficiency"]), rel=1e-12)
        assert bool(last["inside_map"]) is inside


def test_reports_and_plots_take_the_map(data, tmp_path, epicyclic):
    ep.write_map(data.sel(state=["1", "R"]), tmp_path / "map.nc")
    done = epicyclic("report", str(tmp_path / "map.nc"), "-o", str(tmp_path / "map.html"))
    assert done.returncode == 0, done.stderr
    assert "state = 1" in (tmp_path / "map.html").read_text(encoding="utf-8")


# --- duty cycles ----------------------------------------------------------------------------------


def test_energies_of_states_add_up(gearbox, data):
    result = ep.duty_cycle(data, CYCLE)
    for name in ("energy_in", "energy_out", "duration"):
        whole = float(result[name].sum())
        assert float(result[f"state_{name}"].sum()) == pytest.approx(whole, rel=1e-12)
    lost = result["state_energy_lost"].sum("state")
    np.testing.assert_allclose(lost, result["energy_lost"].sum("mode"), rtol=1e-12, atol=1e-12)
    balance = result["state_energy_in"] - result["state_energy_out"]
    np.testing.assert_allclose(balance, result["state_energy_lost"].sum("component"), atol=1e-9)
    assert list(result["state"].values) == list(STATES)
    assert float(result["state_duration"].sel(state="2")) == 5.0
    assert float(result["state_duration"].sel(state="4")) == 0.0
    assert abs(float(result["interpolation_error"])) < 1e-9
    assert "solved directly" in result.attrs["interpolation_error_method"]


def test_each_point_takes_the_losses_of_its_state(gearbox):
    cycle = {
        "duration [s]": [10.0, 10.0],
        "speed [rpm]": [1000, 1000],
        "torque [N*m]": [100, 100],
        "state": [1, 8],
    }
    result = ep.duty_cycle(gearbox, cycle, jobs=1)
    assert list(result["state"].values) == ["1", "8"]
    for state in ("1", "8"):
        point = ep.solve(
            gearbox.updated(
                {
                    "operation.state": state,
                    "operation.speed": "1000 rpm",
                    "operation.torque": "100 N*m",
                }
            )
        )
        lost = float(result["state_energy_lost"].sel(state=state).sum())
        assert lost == pytest.approx(point.total * 10 / 1000, rel=1e-9)


def test_computed_losses_of_a_cycle_are_checked_by_solutions(computed):
    cycle = {
        "duration [s]": [10.0, 20.0],
        "speed [rpm]": [1000, 2000],
        "torque [N*m]": [50, 30],
        "state": ["low", "direct"],
    }
    data = ep.loss_map(
        computed, ["0 rpm", "1000 rpm", "2000 rpm"], ["0 N*m", "30 N*m", "50 N*m"], jobs=1
    )
    result = ep.duty_cycle(data, cycle, jobs=1)
    assert float(result["largest_deviation"]) < 1e-9
    assert float(result["total_efficiency"]) < 1


@pytest.mark.parametrize(
    ("states", "words"),
    [
        (None, "state: is not among the columns, but the map has several: 1, 2"),
        (["1", "2", "9", "8"], 'state = "9": must be one of 1, 2'),
        (["1", "", "2", "8"], 'state = "": must be one of 1, 2'),
    ],
)
@pytest.mark.parametrize("source", ["map", "case"])
def test_wrong_states_of_a_cycle_are_named(gearbox, data, source, states, words):
    cycle = {key: values for key, values in CYCLE.items() if key != "state"}
    if states is not None:
        cycle["state"] = states
    with pytest.raises(ep.InputError, match=re.escape(words)):
        ep.duty_cycle(data if source == "map" else gearbox, cycle)


def test_a_map_of_one_state_needs_no_column(data):
    cycle = {key: values for key, values in CYCLE.items() if key != "state"}
    result = ep.duty_cycle(data.sel(state=["4"]), cycle)
    assert float(result["state_duration"].sel(state="4")) == 15.0
    with pytest.raises(ep.InputError, match="every loss of the train is given"):
        ep.duty_cycle(data.sel(state=["4"]), cycle, ["40 degC"])


def test_a_column_of_states_means_nothing_to_a_single_set(pair_map):
    cycle = {"duration [s]": [1.0], "speed [rpm]": [2000], "torque [N*m]": [50], "state": ["on"]}
    result = ep.duty_cycle(pair_map, cycle, ["40 degC"], samples=1)
    assert "state" not in result.dims
    assert result.attrs["cycle"] == "the cycle, 1 row; columns not used: state"


def test_the_command_shows_the_energy_of_each_state(data, tmp_path, epicyclic):
    ep.write_map(data, tmp_path / "map.nc")
    pd.DataFrame(CYCLE).to_csv(tmp_path / "cycle.csv", index=False)
    pd.DataFrame(CYCLE).to_parquet(tmp_path / "cycle.parquet", index=False)
    shown = [
        epicyclic("duty", str(tmp_path / "map.nc"), str(tmp_path / f"cycle.{ending}")).stdout
        for ending in ("csv", "parquet")
    ]
    text, other = (output.partition("\ncycle: ")[0] for output in shown)
    assert text == other
    assert "States: energy in kJ" in text
    rows = [line.split() for line in text.partition("States:")[2].splitlines()]
    durations = {row[0]: row[4] for row in rows if row and row[0] in CYCLE["state"]}
    assert durations == {"1": "2.5", "2": "5.0", "R": "5.0", "8": "2.5"}


# --- sweeps and measurements ----------------------------------------------------------------------


def test_states_are_swept_as_names(tmp_path, epicyclic):
    output = tmp_path / "sweep.nc"
    done = epicyclic(
        "sweep", "train-8hp70", "--vary", "operation.state=1,2,3",
        "--vary", "sets.P1.efficiency=0.97,0.98", "-o", str(output),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stderr == "" or done.stderr.startswith("Interpolated linearly in torque; ")
    with xr.open_dataset(output) as stored:
        assert list(stored["operation.state"].values) == ["1", "2", "3"]
        assert list(stored["sets.P1.efficiency"].values) == [0.97, 0.98]
        assert (stored["ratio"].diff("state") < 0).all()
        worse = stored["total"].sel({"operation.state": "3"})
        assert float(worse[0]) > float(worse[1])


@pytest.mark.slow
def test_measurements_have_states_and_losses_of_sets(gearbox, tmp_path, epicyclic):
    rows = []
    for state, component in (
        ("1", "total"), ("4", "P1.sun_mesh+P1.ring_mesh"), ("3", "load_dependent"), ("R", "total")
    ):  # fmt: skip
        result = ep.solve(gearbox.updated({"operation.state": state, "sets.P1.efficiency": 0.97}))
        names = component.split("+")
        loss = sum(result.losses[name] for name in names) if "." in component else result.total
        rows.append((2000, 300, state, component, loss))
    heads = ["speed [rpm]", "torque [N*m]", "state", "component", "loss [W]"]
    table = pd.DataFrame(rows, columns=heads)
    found = ep.compare_measured(gearbox, table, fit=["sets.P1.efficiency"], jobs=1)
    assert found.group == "state"
    (fitted,) = found.fit.parameters
    assert fitted.value == pytest.approx(0.97, abs=1e-6)
    assert found.calibrated_case.sets["P1"].efficiency == pytest.approx(0.97, abs=1e-6)
    assert [row.count for row in found.errors][:5] == [4, 1, 1, 1, 1]
    table.to_csv(tmp_path / "measured.csv", index=False)
    output = tmp_path / "calibrated.toml"
    done = epicyclic(
        "compare", "train-8hp70", str(tmp_path / "measured.csv"), "--fit", "sets.P1.efficiency",
        "-o", str(output), "--plot", str(tmp_path / "measured.png"),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "CALIBRATED" in output.read_text(encoding="utf-8")
    assert ep.load_case(output).sets["P1"].efficiency == pytest.approx(0.97, abs=1e-6)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"state": ["1", "N"]}, 'operation.state = "N": is not a state'),
        ({"component": ["total", "P4.sun_mush"]}, "is not a loss. The losses are P1.sun_mesh"),
        ({"sets.P1.eficiency": [0.9, 0.9]}, "Did you mean 'sets.P1.efficiency'"),
    ],
)
def test_mistakes_in_measurements_are_named(gearbox, change, words):
    table = {
        "speed [rpm]": [2000, 1000],
        "torque [N*m]": [300, 300],
        "state": ["1", "2"],
        "loss [W]": [1000, 900],
    } | change
    with pytest.raises(ep.InputError, match=re.escape(words)):
        ep.compare_measured(gearbox, pd.DataFrame(table))
