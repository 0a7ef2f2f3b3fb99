"""Loss maps as a user makes them: values, signs, rest, files."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.machine.solve import LOSS_AGREEMENT
from epicyclic.units import RPM

SPEED = ["0 rpm", "500 rpm", "4000 rpm"]
TORQUE = ["-1000 N*m", "-5 N*m", "0 N*m", "5 N*m", "1000 N*m"]
TEMPERATURE = ["40 degC", "90 degC"]


@pytest.fixture(scope="module")
def case(coarse_talbot):
    return coarse_talbot


@pytest.fixture(scope="module")
def data(case):
    return ep.loss_map(case, SPEED, TORQUE, TEMPERATURE, jobs=1)


def watts(data):
    return [name for name, array in data.data_vars.items() if array.attrs.get("units") == "W"]


def names_in(folder):
    return [path.name for path in folder.iterdir()]


@pytest.mark.parametrize("torque", [-1000.0, 0.0, 1000.0])
def test_a_point_of_the_map_is_a_solution(case, data, torque):
    result = ep.solve(
        case.updated(
            {
                "operation.speed": "4000 rpm",
                "operation.torque": f"{torque} N*m",
                "operation.oil_inlet_temperature": "40 degC",
            }
        )
    )
    point = data.sel(speed=4000, torque=torque, temperature=40)
    # points of a block end a pass later, or in other passes
    total, within = float(point["total"]), LOSS_AGREEMENT * result.total
    assert total == pytest.approx(result.total, abs=within)
    losses = {name: float(point[name]) for name in result.losses}
    assert losses == pytest.approx(result.losses, abs=within)
    member = result.flow.members["sun"]
    assert float(point["torque_loss"]) == pytest.approx(total / member.speed, rel=1e-12)
    efficiency = math.nan if result.efficiency is None else result.efficiency
    assert float(point["efficiency"]) == pytest.approx(efficiency, nan_ok=True)


def test_no_loss_is_negative_and_powers_are_zero_at_rest(data):
    assert (data["status"] == "converged").all()
    assert (data["torque_loss"] > 0).all()
    for name in watts(data):
        assert (data[name].fillna(0) >= 0).all(), name
        assert (data[name].sel(speed=0).fillna(0) == 0).all(), name
    assert (data["total"].sel(speed=[500, 4000]) > 0).all()


def test_torque_loss_at_rest_is_the_limit_of_slow_motion(case, data):
    slow = ep.loss_map(case, ["1e-8 rpm"], TORQUE, TEMPERATURE, jobs=1)
    # the loss over the speed differs from its limit by the rolling loss, of the order of the speed
    # to the power of 0.66: 2e-5 at 1e-5 rpm
    for name in ("torque_loss", "efficiency", "carrier_torque"):
        np.testing.assert_allclose(
            data[name].sel(speed=0).values, slow[name].isel(speed=0).values, rtol=1e-6
        )


@pytest.mark.parametrize("speed", [0.0, 500.0, 4000.0])
def test_the_stated_balance_gives_the_torque_of_the_output(data, speed):
    """torque - sign(speed) * torque_loss, at the sun, times the ratio is the carrier's reaction."""
    point = data.sel(speed=speed)
    ratio = (73 + 125) / 73  # turns of the sun for one of the carrier, ring held
    passed = (data["torque"] - point["torque_loss"]) * ratio
    # drag on the input shaft and inside the gear set are counted in the loss alike: rounding only
    np.testing.assert_allclose(passed.values, -point["carrier_torque"].values, rtol=1e-9, atol=1e-9)


def test_both_directions_of_rotation_lose_the_same(case):
    data = ep.loss_map(case, ["-1000 rpm", "1000 rpm"], ["-500 N*m", "500 N*m"], jobs=1)
    there, back = data.sel(speed=1000), data.sel(speed=-1000)
    assert (data["torque_loss"] > 0).all()
    np.testing.assert_array_equal(there["torque_loss"], back["torque_loss"].values[::-1])


def test_axes_rise_and_the_case_gives_the_temperature(case):
    data = ep.loss_map(case, ["2000 rpm", "0 rpm", "100 rpm"], ["10 N*m", "-10 N*m"])
    assert list(data["speed"].values) == [0, 100, 2000]
    assert list(data["torque"].values) == [-10, 10]
    assert list(data["temperature"].values) == [90]
    assert data["torque_loss"].dims == ("speed", "torque", "temperature")


def test_a_second_driven_member_leaves_no_torque_loss_at_rest(case):
    driven = case.updated(
        {
            "operation.fixed": None,
            "operation.second_input": "ring",
            "operation.second_speed": "100 rpm",
        }
    )
    data = ep.loss_map(driven, ["0 rpm", "1000 rpm"], ["100 N*m"], jobs=1)
    assert np.isnan(data["torque_loss"].sel(speed=0)).all()
    assert (data["total"] > 0).all()
    assert "no torque loss" in data.attrs["zero_speed"]


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("operation.speed", "is varied by speed"),
        ("operation.input", "defines the shafts"),
        ("planet.cuont", "not a known key"),
    ],
)
def test_keys_that_cannot_be_varied_are_named(case, key, words):
    with pytest.raises(ep.InputError, match=words):
        ep.loss_map(case, ["1 rpm"], ["1 N*m"], vary={key: ["1 rpm"]})


def test_a_pair_is_referred_to_its_pinion():
    pair = ep.load_case("talbot-2012-pair")
    data = ep.loss_map(pair, ["0 rpm", "1000 rpm"], ["-50 N*m", "50 N*m"], jobs=1)
    assert data.attrs["reference_shaft"] == "pinion"
    assert "of the pinion" in data.attrs["sign_convention"]
    wanted = data["total"].sel(speed=1000) / RPM.parse("1000 rpm")
    np.testing.assert_allclose(data["torque_loss"].sel(speed=1000), wanted, rtol=1e-12)


COMMAND = (
    "map", "talbot-2012", "--speed", "0,500,4000 rpm", "--torque", "-1000,-5,0,5,1000 N*m",
    "--temperature", "40,90 degC",
)  # fmt: skip


def test_a_file_holds_the_map(data, tmp_path, epicyclic, coarse_options):
    output = tmp_path / "map.nc"
    done = epicyclic(*COMMAND, *coarse_options, "-o", str(output))
    assert done.returncode == 0
    assert done.stderr.startswith(
        "Interpolated linearly in torque; the largest error of the total loss is"
    )
    assert done.stdout == f"Wrote 30 points to {output}.\n"
    assert names_in(tmp_path) == [output.name]
    with xr.open_dataset(output) as stored:
        assert stored.identical(data)


def test_a_map_warns_as_run_does_where_most_is_lost(tmp_path, epicyclic, coarse_options):
    cold = (*coarse_options, "--set", "operation.oil_inlet_temperature=-40 degC")
    axes = "--speed", "1000,2000 rpm", "--torque", "300,700 N*m"
    done = epicyclic("map", "talbot-2012", *axes, *cold, "-o", str(tmp_path / "map.nc"))
    head, *rest = done.stderr[done.stderr.index("Warning") :].splitlines()
    assert head.endswith(
        "at the greatest loss: input sun, 2000 rpm, 700 N·m, ring fixed, oil at -40 °C"
    )
    at = "--set", "operation.speed=2000 rpm", "--set", "operation.torque=700 N*m"
    screen = " ".join(epicyclic("run", "talbot-2012", *at, *cold).stdout.split())
    assert len(rest) == 3
    assert all(text in screen for text in rest)
    assert "\n4 of 4 points use a model outside its range, most at " in done.stderr


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_tables_hold_the_map(data, tmp_path, suffix):
    output = tmp_path / f"map.{suffix}"
    ep.write_map(data, output)
    assert names_in(tmp_path) == [output.name]
    if suffix == "csv":
        table = pd.read_csv(output, comment="#")
        assert "# reference shaft: sun\n# output shaft: carrier\n# sign convention" in (
            output.read_text()
        )
    else:
        table = pd.read_parquet(output)
        assert table.attrs == data.attrs
    np.testing.assert_array_equal(table["torque_loss [N*m]"], data["torque_loss"].values.ravel())
    speeds = data["speed"].broadcast_like(data["torque_loss"]).values.ravel()
    np.testing.assert_array_equal(table["speed [rpm]"], speeds)
    np.testing.assert_array_equal(table["efficiency"], data["efficiency"].values.ravel())


def test_further_keys_are_axes(tmp_path, epicyclic):
    output = tmp_path / "map.nc"
    done = epicyclic(
        "map", "talbot-2012", "--speed", "100:400:2 rpm", "--torque", "10 N*m",
        "--vary", "planet.count=3,12", "--vary", "sun.roughness=ground,0.1 um", "-o", str(output),
    )  # fmt: skip
    assert done.returncode == 4, done.stderr
    assert "overlap" in done.stderr
    with xr.open_dataset(output) as stored:
        assert stored["torque_loss"].dims == (
            "speed", "torque", "temperature", "planet_count", "sun_roughness",
        )  # fmt: skip
        assert np.isnan(stored["torque_loss"].sel(planet_count=12)).all()
        assert (stored["torque_loss"].sel(planet_count=3) > 0).all()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("-o", "map.xyz"), "must end in .nc"),
        (("-o", "missing/map.nc"), "lies in a folder that does not exist"),
        (("-o", "map.nc", "--format", "wrong"), "must be one of netcdf"),
        (("-o", "map.nc", "--speed", " "), "--speed"),
        (("-o", "map.vtlm"), "temperature: has 2 values"),
        (("-o", "map.nc", "--vary", "planet.cuont=3,4"), "not a known key"),
        (("-o", "map.nc", "--torque", "1,2 rpm"), "operation.torque"),
    ],
)
def test_bad_commands_end_before_computing(tmp_path, epicyclic, options, words):
    done = epicyclic(*COMMAND, *options)
    assert done.returncode == 2
    assert words in done.stderr
    assert names_in(tmp_path) == []
