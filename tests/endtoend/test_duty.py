"""Duty cycles as a user runs them: energies, signs, errors of interpolation, bad files."""

from __future__ import annotations

import json
import re
import subprocess
import sys

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import xarray as xr
from click.testing import CliRunner

import epicyclic as ep
from epicyclic.cli.duty import duty
from epicyclic.machine.solve import LOSS_AGREEMENT
from epicyclic.study import table_file
from epicyclic.study.maps.compute import Sample
from epicyclic.study.maps.tables import make_lookup
from epicyclic.study.operating import shaft_power
from limits import is_soon

SPEEDS = (0.0, 500.0, 2000.0, 4000.0)
TORQUES = (-800.0, -100.0, 0.0, 100.0, 800.0)
TEMPERATURES = (40.0, 60.0, 90.0)
POCKETS = ("losses.sun_mesh_pocketing.include", "losses.ring_mesh_pocketing.include")


def texts(values, unit):
    return [f"{value} {unit}" for value in values]


@pytest.fixture(scope="module")
def case():
    """Without pockets, whose flow takes most of the time of a test."""
    return ep.load_case("talbot-2012").updated(dict.fromkeys(POCKETS, False))


@pytest.fixture(scope="module")
def data(case):
    return ep.loss_map(
        case, texts(SPEEDS, "rpm"), texts(TORQUES, "N*m"), texts(TEMPERATURES, "degC"), jobs=1
    )


@pytest.fixture(scope="module")
def map_file(data, tmp_path_factory):
    path = tmp_path_factory.mktemp("map") / "map.nc"
    ep.write_map(data, path)
    return path


def solved(case, speed, torque, celsius):
    return ep.solve(
        case.updated(
            {
                "operation.speed": f"{speed} rpm",
                "operation.torque": f"{torque} N*m",
                "operation.oil_inlet_temperature": f"{celsius} degC",
            }
        )
    )


def random_series(rows, seed=1):
    """A time series in units that are not those of the map."""
    random = np.random.default_rng(seed)
    return pd.DataFrame(
        {
            "Time [min]": np.cumsum(random.uniform(0.001, 0.01, rows)),
            "speed [rad/s]": random.uniform(0, 400, rows),
            "torque [kN*m]": random.uniform(-0.8, 0.8, rows),
            "temperature [K]": random.uniform(313.15, 363.15, rows),
            "gear": 3,
        }
    )


# --- interpolation --------------------------------------------------------------------------------


def test_nodes_of_the_map_come_back(data):
    lookup = make_lookup(data)
    speed, torque, celsius = (
        values.ravel() for values in np.meshgrid(SPEEDS, TORQUES, TEMPERATURES, indexing="ij")
    )
    nodes, weights = lookup.corners(speed, torque, celsius)
    found = (lookup.total[nodes] * weights).sum(axis=0)
    np.testing.assert_allclose(found, data["torque_loss"].values.ravel(), rtol=1e-12)
    for number, name in enumerate(lookup.components):
        parts = (lookup.torques[number].ravel()[nodes] * weights).sum(axis=0)
        power = shaft_power(parts, abs(speed))
        np.testing.assert_allclose(power, data[name].values.ravel(), rtol=1e-12, err_msg=name)


def test_between_nodes_it_is_linear_in_the_torque_loss(data):
    lookup = make_lookup(data)
    random = np.random.default_rng(2)
    point = [random.uniform(axis[0], axis[-1], 50) for axis in (SPEEDS, TORQUES, TEMPERATURES)]
    nodes, weights = lookup.corners(*point)
    wanted = data["torque_loss"].interp(
        dict(zip(("speed", "torque", "temperature"), (("p", it) for it in point), strict=True))
    )
    np.testing.assert_allclose((lookup.total[nodes] * weights).sum(axis=0), wanted, rtol=1e-12)


# --- energies -------------------------------------------------------------------------------------


TOGETHER = LOSS_AGREEMENT  # The points of the map were solved together, the result by itself.


@pytest.mark.parametrize(("torque", "mode"), [(800.0, "driving"), (-800.0, "coasting")])
def test_a_constant_point_gives_power_times_time(case, data, torque, mode):
    cycle = {
        "time [s]": [0, 1, 10], "speed [rpm]": [2000] * 3, "torque [Nm]": [torque] * 3,
        "temperature [°C]": [60] * 3,
    }  # fmt: skip
    found = ep.duty_cycle(data, cycle, samples=1).sel(mode=mode)
    result = solved(case, 2000, torque, 60)
    assert float(found["duration"]) == 10
    for name, watts in result.losses.items():
        if name in found["component"]:
            lost = float(found["energy_lost"].sel(component=name))
            assert lost == pytest.approx(watts * 10 / 1000, rel=TOGETHER)
    assert float(found["energy_lost"].sum()) == pytest.approx(result.total * 0.01, rel=TOGETHER)
    assert float(found["energy_in"]) == pytest.approx(result.input_power * 0.01, rel=TOGETHER)
    assert float(found["efficiency"]) == pytest.approx(result.efficiency, rel=TOGETHER)


def test_energies_balance_and_modes_add_up(data):
    result = ep.duty_cycle(data, random_series(5000), samples=2)
    lost = result["energy_lost"].sum("component")
    np.testing.assert_allclose(result["energy_in"] - result["energy_out"], lost, rtol=1e-9)
    assert (result["energy_lost"] >= 0).all()
    assert (result["energy_out"] >= 0).all()
    total = float(result["energy_out"].sum() / result["energy_in"].sum())
    assert float(result["total_efficiency"]) == pytest.approx(total, rel=1e-12)


def test_the_trapezoidal_rule_of_the_interpolated_power(data):
    table = random_series(200)
    rpm, nm = table["speed [rad/s]"] * 30 / np.pi, table["torque [kN*m]"] * 1000
    celsius, seconds = table["temperature [K]"] - 273.15, table["Time [min]"] * 60
    torque_loss = data["torque_loss"].interp(
        speed=("p", rpm), torque=("p", nm), temperature=("p", celsius)
    )
    power = torque_loss.values * table["speed [rad/s]"]
    lost = float(ep.duty_cycle(data, table, samples=1)["energy_lost"].sum())
    assert lost == pytest.approx(np.trapezoid(power, seconds) / 1000, rel=1e-9)


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_pieces_of_a_file_make_the_whole(data, tmp_path, monkeypatch, suffix):
    table = random_series(3000)
    whole = ep.duty_cycle(data, table, samples=1)
    path = tmp_path / f"cycle.{suffix}"
    if suffix == "csv":
        path.write_text("# a comment\n" + table.to_csv(index=False), encoding="utf-8-sig")
    else:
        table.astype({"gear": "category"}).to_parquet(path)
    monkeypatch.setattr(table_file, "_BATCH_ROWS", 70)
    found = ep.duty_cycle(data, path, samples=1)
    for name in ("duration", "energy_in", "energy_lost"):
        np.testing.assert_allclose(found[name], whole[name], rtol=1e-9)


def test_durations_and_shares(data):
    cycle = {
        "speed [rpm]": [4000, 1000, 2000], "torque [N*m]": [500, -50, 0],
        "temperature [degC]": [90, 40, 60], "duration [h]": [1, 2, 1],
    }  # fmt: skip
    hours = ep.duty_cycle(data, cycle, samples=3)
    np.testing.assert_allclose(hours["duration"], [3600, 7200, 3600])
    cycle["share [%]"] = [it * 25 for it in cycle.pop("duration [h]")]
    shares = ep.duty_cycle(data, cycle, samples=3)
    np.testing.assert_allclose(shares["energy_lost"] * 4, hours["energy_lost"], rtol=1e-12)
    assert "one hour" in shares.attrs["basis"]


def test_rest_and_no_torque_are_idling(data):
    cycle = {
        "speed [rpm]": [0, 2000, 0], "torque [N*m]": [800, 0, 0], "duration [s]": [5, 7, 1],
    }  # fmt: skip
    result = ep.duty_cycle(data, cycle, ["60 degC"], samples=3).isel(temperature=0)
    np.testing.assert_array_equal(result["duration"], [0, 0, 13])
    drag = float(data["total"].sel(speed=2000, torque=0, temperature=60))
    idling = result.sel(mode="idling")
    assert float(idling["energy_lost"].sum()) == pytest.approx(drag * 7 / 1000, rel=1e-12)
    assert float(idling["energy_in"]) == pytest.approx(drag * 7 / 1000, rel=1e-12)
    assert float(idling["efficiency"]) == 0
    assert np.isnan(result.sel(mode="driving")["efficiency"])


def test_power_below_the_loss_is_made_up_by_the_other_shaft(data):
    """Near zero torque the loss takes what the reference shaft brings, and more."""
    cycle = {"speed [rpm]": [4000], "torque [N*m]": [0.1], "duration [s]": [1]}
    result = ep.duty_cycle(data, cycle, ["40 degC"], samples=1).isel(temperature=0)
    driving = result.sel(mode="driving")
    assert float(driving["energy_lost"].sum()) > 0.1 * 4000 * np.pi / 30 / 1000
    assert float(driving["energy_in"]) == pytest.approx(float(driving["energy_lost"].sum()))
    assert float(driving["efficiency"]) == pytest.approx(0, abs=1e-12)


def test_cold_and_hot(data):
    cycle = {"speed [rpm]": [2000], "torque [N*m]": [100], "duration [s]": [1]}
    result = ep.duty_cycle(data, cycle, ["40 degC", "363.15 K"], samples=1)
    np.testing.assert_allclose(result["temperature"], [40, 90])
    for celsius in (40, 90):
        wanted = float(data["total"].sel(speed=2000, torque=100, temperature=celsius))
        lost = float(result["energy_lost"].sel(temperature=celsius, method="nearest").sum())
        assert lost == pytest.approx(wanted / 1000, rel=1e-9)


def test_points_outside_are_refused_or_taken_at_the_border(data):
    cycle = {"speed [rpm]": [5000, 4000], "torque [N*m]": [100, 100], "duration [s]": [1, 3]}
    with pytest.raises(ep.InputError, match="0 to 4000 rpm") as error:
        ep.duty_cycle(data, cycle, ["90 degC"])
    assert len(error.value.problems) == 1
    assert "25.0 % of the duration" in str(error.value)
    result = ep.duty_cycle(data, cycle, ["90 degC"], clamp=True, samples=1).isel(temperature=0)
    assert float(result["share_outside"]) == 0.25
    border = float(data["torque_loss"].sel(speed=4000, torque=100, temperature=90))
    wanted = border * (5000 + 3 * 4000) * np.pi / 30 / 1000
    assert float(result["energy_lost"].sum()) == pytest.approx(wanted, rel=1e-9)


# --- error of interpolation -----------------------------------------------------------------------


def test_a_small_cycle_is_checked_as_a_whole(case, data):
    points = [(1200, 300, 50, 10), (3000, -400, 70, 20), (300, 50, 45, 5)]
    speed, torque, celsius, seconds = zip(*points, strict=True)
    cycle = {
        "speed [rpm]": speed, "torque [N*m]": torque, "temperature [degC]": celsius,
        "duration [s]": seconds,
    }  # fmt: skip
    result = ep.duty_cycle(data, cycle, samples=5)
    direct = sum(solved(case, n, t, c).total * s for n, t, c, s in points) / 1000
    error = float(result["energy_lost"].sum()) - direct
    assert abs(error) > 1e-4 * direct  # or else this map would show nothing
    assert float(result["interpolation_error"]) == pytest.approx(error, rel=1e-6)
    assert float(result["interpolation_standard_error"]) == 0
    assert "3 points" in result.attrs["interpolation_error_method"]


def test_the_estimate_from_a_sample_has_no_bias():
    """Over many cycles the mean of the estimates is the sum itself, within its scatter."""
    random = np.random.default_rng(5)
    ratios = []
    energy = random.exponential(size=200) ** 2
    deviation = energy * random.normal(1, 0.3, 200)
    zero = np.zeros(200)
    for seed in range(400):
        sample = Sample(20)
        sample._random = np.random.default_rng(seed)
        for part in (slice(0, 70), slice(70, 200)):
            sample.add((deviation[part], zero[part], zero[part]), energy[part], energy[part])
        rows, chance = sample.drawn()
        assert len(rows) == 20
        ratios.append(np.sum(rows[:, 0] / chance) / deviation.sum())
    scatter = np.std(ratios) / np.sqrt(len(ratios))
    assert abs(np.mean(ratios) - 1) < 4 * scatter  # four standard errors
    assert scatter < 0.01


def test_without_its_case_a_map_is_thinned_out(data):
    bare = data.assign_attrs(case="")
    table = random_series(500)
    result = ep.duty_cycle(bare, table)
    assert "every second node" in result.attrs["interpolation_error_method"]
    coarse = data.isel(speed=[0, 2, 3], torque=[0, 2, 4], temperature=[0, 2])
    wanted = ep.duty_cycle(coarse, table, samples=1)["energy_lost"].sum()
    difference = float(wanted - result["energy_lost"].sum())
    assert float(result["interpolation_error"]) == pytest.approx(difference, rel=1e-6)


def test_single_further_axes_are_those_of_the_checked_case(case):
    data = ep.loss_map(
        case, ["1000 rpm", "2000 rpm"], ["100 N*m", "200 N*m"],
        vary={"planet.count": [4], "sun.roughness": ["0.2 um"]}, jobs=1,
    )  # fmt: skip
    cycle = {"speed [rpm]": [2000], "torque [N*m]": [200], "duration [s]": [1]}
    result = ep.duty_cycle(data, cycle)
    assert float(result["largest_deviation"]) < 1e-9  # a node of the map
    two = xr.concat([data, data.assign_coords(planet_count=[5])], "planet_count")
    with pytest.raises(ep.InputError, match="planet_count: has 2 values"):
        ep.duty_cycle(two, cycle)


# --- bad input ------------------------------------------------------------------------------------

GOOD = "time [s],speed [rpm],torque [N*m],temperature [degC]\n0,100,10,50\n1,200,20,60\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["no line with the column names"]),
        (GOOD.splitlines()[0], ["There are 0 rows"]),
        (GOOD + "1,300,5,60\n0.5,nan,5,60\n2,abc,,60\n", [
            'time = "1" (line 4): must differ', 'time = "0.5" (line 5): must be later',
            "--rows 2-4, --rows 5-6", 'speed = "nan" (line 5, and 1',
            'torque = "" (line 6): is empty']),
        (GOOD.replace("[rpm]", "[kW]"), ["measures something else"]),
        (GOOD.replace("[N*m]", ""), ["torque", "unit"]),
        (GOOD.replace("temperature [degC]", "speed [rad/s]"), ["more than once"]),
        (GOOD.replace("torque", "power"), ["torque: is not among the columns"]),
        (GOOD.replace("time [s]", "when"), ["none of them"]),
        (GOOD.replace("temperature [degC]", "share"), ["time and share"]),
        (GOOD + "2,300\n", ["4 columns, but line 4 has 2"]),
        (GOOD.replace("time [s]", "duration [s]").replace("0,100", "-1,100"), ["not be negative"]),
        (GOOD.replace("time [s]", "share").replace("1,200", "0,200"), ["zero in all rows"]),
        (GOOD.encode() + b"2,\xff,1,50\n", ['speed = "\xff" (line 4)']),
        (GOOD.encode() + b"2,\x81,1,50\n", ["not text in UTF-8"]),
        (GOOD + "2,1e999,1,50\n", ['speed = "1e999"']),
        (GOOD + '2,"1,5",1,50.5\n', ["decimal points", '"1,5" in line 4']),
        ("x" * 300_000, ["cannot be read"]),
    ],
)  # fmt: skip
def test_bad_csv_files_end_in_one_error(data, tmp_path, text, words):
    path = tmp_path / "cycle.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ep.InputError) as error:
        ep.duty_cycle(data, path)
    for word in words:
        assert word in str(error.value)


def test_durations_below_zero_are_all_that_is_wrong_where_they_sum_to_zero(data):
    cycle = {"speed [rpm]": [900, 1700], "torque [N*m]": [30, 70], "duration [s]": [-7, 7]}
    with pytest.raises(ep.InputError, match=r"1 problem.*\n.*must not be negative"):
        ep.duty_cycle(data, cycle, "50 degC")


def test_bad_parquet_files_end_in_one_error(data, tmp_path):
    path = tmp_path / "cycle.parquet"
    random_series(100).to_parquet(path)
    content = path.read_bytes()
    for bad in (content[:-100], content[:200] + b"\0" * 500 + content[700:], b"", b"PAR1"):
        path.write_bytes(bad)
        with pytest.raises(ep.InputError, match=r"cannot be read|not a valid Parquet|must be"):
            ep.duty_cycle(data, path)
    table = random_series(3).astype(object)
    table.iloc[1, 1] = None
    table["torque [kN*m]"] = [True, False, True]
    table.to_parquet(path)
    with pytest.raises(ep.InputError) as error:
        ep.duty_cycle(data, path)
    assert len(error.value.problems) == 2


BIG = """
import re, sys, time
from pathlib import Path
import epicyclic as ep
before = time.process_time()
try:
    ep.duty_cycle(None, sys.argv[1])
except ep.InputError as error:
    print(len(error.problems))
peak = re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())
print(time.process_time() - before, int(peak[1]) / 1024)
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "count"),
    [("1,abc,nan,\n" * 1_000_000, 4), ("1" * 50_000_000, 1), ('"' + "1,2,3,4\n" * 3_000_000, 1)],
)
def test_large_bad_files_end_soon_and_in_little_memory(tmp_path, body, count):
    path = tmp_path / "cycle.csv"
    path.write_text(GOOD.splitlines()[0] + "\n" + body)
    command = [sys.executable, "-c", BIG, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    problems, seconds, megabytes = (float(word) for word in done.stdout.split())
    assert problems == count
    assert is_soon(seconds)
    assert megabytes < 500


@pytest.mark.slow
def test_memory_does_not_grow_with_the_rows(tmp_path):
    """A Parquet file of zeros, a hundred times larger in memory than on the disk."""
    path = tmp_path / "cycle.parquet"
    names = ("time [s]", "speed [rpm]", "torque [N*m]", "temperature [degC]")
    zeros = pa.table(dict.fromkeys(names, pa.array(np.zeros(20_000_000))))
    pq.write_table(zeros, path, compression="zstd")
    command = [sys.executable, "-c", BIG, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert float(done.stdout.split()[2]) < 500  # the table itself takes 640


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"time [s]": [0, 1], "speed [rpm]": [1]}, "is not a table"),
        (5, "is not a table"),
        ("missing.csv", "cannot be read"),
        ("cycle.mat", "must end in .csv, "),
        ({"time [s]": [0, 1], "speed [rpm]": ["1", 2], "torque [N*m]": [1, "x"]}, '"x"'),
    ],
)
def test_what_is_no_table_is_refused(data, table, words):
    with pytest.raises(ep.InputError, match=words):
        ep.duty_cycle(data, table)


def test_temperatures_are_asked_for_once(data):
    cycle = {"speed [rpm]": [100], "torque [N*m]": [1], "duration [s]": [1]}
    with pytest.raises(ep.InputError, match="the map covers 40 to 90 °C"):
        ep.duty_cycle(data, cycle)
    with pytest.raises(ep.InputError, match="column of the cycle"):
        ep.duty_cycle(data, cycle | {"temperature [degC]": [50]}, ["40 degC"])
    with pytest.raises(ep.InputError, match="each value once"):
        ep.duty_cycle(data, cycle, ["40 degC", "40 degC"])
    with pytest.raises(ep.InputError, match="something else"):
        ep.duty_cycle(data, cycle, ["40 bar"])


def test_maps_that_cannot_be_used_are_refused(data):
    cycle = {"speed [rpm]": [100], "torque [N*m]": [1], "duration [s]": [1]}
    with pytest.raises(ep.InputError, match="is not a loss map"):
        ep.duty_cycle(xr.Dataset(), cycle)
    gap, near = data.copy(deep=True), {"speed": 100, "torque": 1, "temperature": 90}
    place = {name: int(np.abs(data[name].values - it).argmin()) for name, it in near.items()}
    gap["torque_loss"][place] = np.nan
    gap["message"][place] = "planets overlap"
    with pytest.raises(ep.InputError, match=r"missing at 1 points.*planets overlap"):
        ep.duty_cycle(gap, cycle, ["90 degC"])
    # a gap where the cycle does not go is none of its business
    place["speed"] = data.sizes["speed"] - 1
    elsewhere = data.copy(deep=True)
    elsewhere["torque_loss"][place] = np.nan
    found, whole = (ep.duty_cycle(it, cycle, ["90 degC"]) for it in (elsewhere, data))
    assert float(found["energy_lost"].sum()) == float(whole["energy_lost"].sum()) > 0
    with pytest.raises(ep.InputError, match="is driven"):
        ep.duty_cycle(data.assign_attrs(held_shaft=""), cycle, ["90 degC"])
    with pytest.raises(ep.InputError, match="has only the value zero"):
        ep.duty_cycle(data.isel(speed=[0]), cycle, ["90 degC"])


# --- the command ----------------------------------------------------------------------------------


def test_the_command_on_a_map(data, map_file, tmp_path, epicyclic):
    table = random_series(300)
    table.to_csv(tmp_path / "cycle.csv", index=False)
    done = epicyclic(
        "duty", str(map_file), str(tmp_path / "cycle.csv"), "-o", str(tmp_path / "duty.csv"),
        "--json", str(tmp_path / "duty.json"),
    )  # fmt: skip
    assert done.returncode == 0
    at = re.search(r"at the greatest loss: input sun, ([\d.]+) rpm, ([-\d.]+) N·m", done.stderr)
    off = (
        table["speed [rad/s]"] * 30 / np.pi - float(at[1]),
        1e3 * table["torque [kN*m]"] - float(at[2]),
    )
    assert np.hypot(*off).min() < 0.01  # a point of the cycle, not a corner of the map
    assert "Interpolation adds" in done.stdout
    assert "20 points of the cycle solved directly" in done.stdout
    wanted = ep.duty_cycle(data, table, samples=1)["energy_lost"]
    rows = pd.read_csv(tmp_path / "duty.csv")
    lost = rows[rows["quantity"] == "energy_lost"]
    assert set(lost["unit"]) == {"kJ"}
    assert lost["value"].sum() == pytest.approx(float(wanted.sum()), rel=1e-9)
    stored = json.loads((tmp_path / "duty.json").read_text())
    assert stored["attributes"]["reference_shaft"] == "sun"
    assert len(stored["rows"]) == len(rows)


@pytest.mark.slow
def test_the_command_on_a_case_keeps_its_map(tmp_path, epicyclic):
    (tmp_path / "cycle.csv").write_text("share,speed [rpm],torque [Nm]\n1,100,50\n2,3000,-200\n")
    changes = [word for key in POCKETS for word in ("--set", f"{key}=false")]
    done = epicyclic(
        "duty", "talbot-2012", str(tmp_path / "cycle.csv"), *changes,
        "--temperature", "40 degC", "--temperature", "90 degC",
        "--map", str(tmp_path / "map.nc"), "-o", str(tmp_path / "duty.nc"), "--json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    rows = pd.DataFrame(json.loads(done.stdout)["rows"])
    assert set(rows["temperature"]) == {40, 90}
    with xr.open_dataset(tmp_path / "map.nc") as kept, xr.open_dataset(tmp_path / "duty.nc") as out:
        assert list(kept["temperature"].values) == [40, 90]
        assert float(kept["torque"].min()) == -200
        assert float(kept["torque"].max()) == 50
        assert float(kept["speed"].max()) == 3000
        assert (abs(out["interpolation_error"]) < 0.01 * out["energy_lost"].sum()).all()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("map.nc", "cycle.csv", "--set", "a=b"), "--set: applies to a case"),
        (("missing.nc", "cycle.csv"), "does not exist"),
        (("talbot-2012", "cycle.csv", "--map", "map.mat"), "must end in .nc"),
        (("talbot-2012", "cycle.csv", "-o", "out.txt"), "must end in .nc or .csv"),
        (("talbot-2012", "missing.csv"), "cannot be read"),
        (("cycle.csv", "cycle.csv"), "cycle.csv"),
    ],
)
def test_bad_commands_are_refused(tmp_path, monkeypatch, arguments, words):
    (tmp_path / "cycle.csv").write_text(GOOD)
    monkeypatch.chdir(tmp_path)
    outcome = CliRunner().invoke(duty, arguments)
    assert isinstance(outcome.exception, ep.InputError)
    assert words in str(outcome.exception)
    assert [path.name for path in tmp_path.iterdir()] == ["cycle.csv"]
