"""Torques of a map that resolve zero, and what a map says of its interpolation."""

from __future__ import annotations

import re

import numpy as np
import pytest
from click.testing import CliRunner

import epicyclic as ep
from epicyclic.cli.main import cli
from epicyclic.study.maps.compute import resolving_zero
from epicyclic.study.maps.tables import make_lookup
from epicyclic.units import WATT

COARSE = {"numerics.pocket_slices": 6, "numerics.pocket_steps": 10}


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012").updated(COARSE)


def test_losses_at_rest_are_shared_as_at_the_nearest_speed_rather_forward(case):
    data = ep.loss_map(case, ["-90 rpm", "0 rpm", "90 rpm"], ["170 N*m"], jobs=1)
    torques = make_lookup(data).torques.squeeze()
    back, rest, ahead = (torques / torques.sum(axis=0)).T
    assert rest == pytest.approx(ahead, rel=1e-12)
    assert rest != pytest.approx(back, rel=1e-4)


def test_torques_crowd_on_each_side_that_reaches_zero():
    found = resolving_zero([-80.0, -40.0, 0.0, 100.0], crowd=3)
    assert found == [-80.0, -40.0, -20.0, -10.0, -5.0, 0.0, 12.5, 25.0, 50.0, 100.0]
    assert resolving_zero([-7.0, 7.0], crowd=1) == [-7.0, -3.5, 0.0, 3.5, 7.0]
    assert resolving_zero([0.0, 6.0], crowd=1) == [0.0, 3.0, 6.0]
    # spacings of 36 that miss zero: both sides end near 36 / 8
    found = resolving_zero([-67.0, -31.0, 5.0, 41.0], crowd=3)
    assert found == [-67.0, -31.0, -15.5, -7.75, -3.875, 0.0, 5.0, 10.25, 20.5, 41.0]
    assert resolving_zero([300.0, 100.0]) == [100.0, 300.0]
    assert resolving_zero([0.0]) == [0.0]


@pytest.mark.parametrize(
    ("rpm", "most"), [(2300.0, 0.02), pytest.param(190.0, 0.07, marks=pytest.mark.slow)]
)
def test_interpolation_is_off_by_little_at_any_torque(case, rpm, most):
    """Even torques alone are off by more than twice as much.

    At a slow speed the kink between two torques weighs more: the drag is small there.
    """
    asked = {"speed": [f"{rpm} rpm"], "torque": [f"{t} N*m" for t in np.linspace(-900, 900, 13)]}
    even = ep.loss_map(case, **asked, jobs=1)
    dense = ep.loss_map(case, **asked, resolve_zero=True, jobs=1)
    torques = [-700.0, -260.0, -41.0, -9.0, -1.3, -0.2, 0.07, 0.5, 1.9, 14.0, 77.0, 380.0, 810.0]
    at = {"operation.speed": f"{rpm} rpm"}
    direct = np.array(
        [ep.solve(case.updated(at | {"operation.torque": f"{t} N*m"})).total for t in torques]
    )

    def off(data):
        total = data["total"].isel(temperature=0).sel(speed=rpm)
        return np.abs(np.interp(torques, data["torque"], total) / direct - 1).max()

    assert off(dense) < most
    assert off(even) > 2 * off(dense)
    told = dense.attrs["torque_interpolation_error"]
    assert 0 < told < most < even.attrs["torque_interpolation_error"]
    assert f"{100 * told:.2g} %" in dense.attrs["torque_interpolation"]


def test_a_map_states_its_error_at_the_middle_and_at_the_slowest_speed(case):
    speeds = ["-3100 rpm", "-130 rpm", "0 rpm", "1700 rpm", "2900 rpm"]
    data = ep.loss_map(case, speeds, ["-300 N*m", "0 N*m", "500 N*m"], jobs=1)
    words = data.attrs["torque_interpolation"]
    found = re.findall(r"([\d.]+) % \(([\d.]+) W\) at (-?\d+) rpm and (-?[\d.]+) N", words)
    assert [float(rpm) for _, _, rpm, _ in found] == [1700.0, -130.0]
    for share, watts, rpm, torque in found:
        total = data["total"].isel(temperature=0).sel(speed=float(rpm))
        at = {"operation.speed": f"{rpm} rpm", "operation.torque": f"{torque} N*m"}
        exact = ep.solve(case.updated(at)).total
        off = abs(float(np.interp(float(torque), data["torque"], total)) - exact)
        assert [off, 100 * off / exact] == pytest.approx([float(watts), float(share)], rel=0.05)
    assert data.attrs["torque_interpolation_error"] == pytest.approx(float(found[0][0]) / 100)


def test_a_loss_of_none_has_an_error_in_watts_alone():
    """Between -80 and 80 N m a train of given efficiencies loses nothing at no torque."""
    torques = ["-80 N*m", "80 N*m"]
    data = ep.loss_map("train-8hp70", ["1300 rpm"], torques, states=["1"], jobs=1)
    error = WATT.text(float(data["total"].mean()), 2)
    told = f"largest error of the total loss is {error} at 1300 rpm and 0 N·m: 3 points"
    assert told in data.attrs["torque_interpolation"]
    assert np.isfinite(data.attrs["torque_interpolation_error"])


@pytest.mark.parametrize(
    ("options", "count"),
    [
        (["--torque", "0:300:4 N*m"], 12),
        (["--torque", "0:300:4 N*m", "--even-torques"], 4),
        (["--torque", "0,100,300 N*m"], 3),
        (["--torque", "100:300:3 N*m"], 3),
    ],
)
def test_command_adds_torques_to_a_range_and_tells_the_error(tmp_path, options, count):
    file = tmp_path / "map.csv"
    changes = [part for key, value in COARSE.items() for part in ("--set", f"{key}={value}")]
    done = CliRunner().invoke(
        cli, ["map", "talbot-2012", *changes, "--speed", "1500 rpm", *options, "-o", str(file)]
    )
    assert done.exit_code == 0, done.output
    lines = file.read_text().splitlines()
    assert len([line for line in lines if not line.startswith("#")]) == count + 1
    assert "largest error of the total loss" in done.output
    assert any(line.startswith("# torque interpolation: ") for line in lines)


def test_no_zero_is_below_zero(case):
    """What a case, a point of a sweep or a function is given as -0 is 0 in every result."""
    still = {"losses.sun_mesh_sliding.factor": -0.0, "models.boundary_friction": -0.0}
    result = ep.solve(case.updated(still | {"operation.torque": "-0 N*m"}))
    found = [result.losses.values(), [result.total]]
    data = ep.sweep(case, {key: [value, 0.1] for key, value in still.items()})
    found += [v.values.ravel() for v in data.variables.values() if v.dtype.kind == "f"]
    share = {"oil_share": -0.0, "temperature": "-0 degC", "oil": "atf-dexron-vi"}
    found += [[ep.windage(diameter="1 m", width="9 mm", speed="-0 rpm", **share)]]
    zeros = [value for values in found for value in values if value == 0]
    assert zeros
    assert not np.signbit(zeros).any()
