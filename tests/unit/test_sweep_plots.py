"""Pictures of sweeps."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import LineCollection, QuadMesh
from matplotlib.figure import Figure

import epicyclic as ep
from epicyclic.show.plots.catalogue import available, explorable, figure_of
from epicyclic.show.plots.loss_map import FINER
from epicyclic.show.plots.sweep import plot_sweep_field, plot_sweep_lines, plot_sweep_parallel
from epicyclic.study.sweeps.run import write_dataset

VARY = {
    "models.friction": ["schlenk", "constant"],
    "operation.torque": ["37 N*m", "91 N*m"],
    "operation.speed": ["2000 rpm", "5000 rpm", "7000 rpm"],
}


def swept(vary):
    case = ep.load_case("talbot-2012-pair").updated(
        {
            "losses.mesh_pocketing.include": False,
            "models.load_distribution": "uniform",
            "models.constant_friction": 0.031,
        }
    )
    return ep.sweep(case, vary, jobs=1)


@pytest.fixture(scope="module")
def data():
    return swept(VARY)


def test_a_stored_sweep_has_its_own_plots(data, tmp_path):
    write_dataset(data, tmp_path / "sweep.nc")
    stored = ep.open_result(tmp_path / "sweep.nc")
    assert list(available(stored)) == ["lines", "contours", "parallel"]
    figure = figure_of(stored, "lines")
    assert [ax.get_ylabel() for ax in figure.axes] == ["total loss, W", "efficiency, %"]
    caption = " ".join(figure.get_supxlabel().split())
    assert "torque 37 to 91 N·m; speed 2000 to 7000 rpm" in caption
    assert "friction schlenk, constant; " in caption
    assert caption.endswith("; oil at 90 °C")


def test_lines_are_over_the_key_with_most_values(data):
    ax = plot_sweep_lines(data, "total", Figure().subplots())
    assert ax.get_xlabel() == "speed, rpm"
    assert ax.get_title(loc="center") == "Total loss, friction schlenk"
    first = data["total"].sel(models_friction="schlenk")
    for line, torque in zip(ax.lines, (37.0, 91.0), strict=True):
        np.testing.assert_array_equal(line.get_ydata(), first.sel(torque=torque))
        assert line.get_label() == f"{torque:g} N·m"


def test_a_field_is_over_two_keys_of_numbers(data):
    ax = plot_sweep_field(data, "efficiency", Figure().subplots())
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("speed, rpm", "torque, N·m")
    (field,) = (one for one in ax.collections if isinstance(one, QuadMesh))
    wanted = 100 * data["efficiency"].sel(models_friction="schlenk")
    wanted = wanted.transpose("torque", "speed")
    found = np.asarray(field.get_array()).reshape(field.get_coordinates().shape[:2])
    np.testing.assert_array_equal(found[::FINER, ::FINER], wanted.values)
    middle = wanted.values[:2, 1:3].mean()
    assert found[FINER // 2, 3 * FINER // 2] == pytest.approx(middle)  # no mixture of colours


def test_every_point_has_a_line_through_all_axes(data):
    failed = data.copy(deep=True)
    failed["total"][0, 0, 0] = np.nan
    for sweep, count in ((data, 12), (failed, 11)):
        ax = plot_sweep_parallel(sweep, Figure().subplots())
        (lines,) = (one for one in ax.collections if isinstance(one, LineCollection))
        assert len(lines.get_segments()) == count
        assert len(lines.get_segments()[0]) == len(VARY) + 2
    losses = sorted(np.asarray(lines.get_array()))
    total = failed["total"].values
    assert losses == sorted(total[np.isfinite(total)])


def test_one_key_gives_lines_only():
    data = swept({"models.friction": ["schlenk", "constant"]})
    assert list(available(data)) == ["lines"]
    figure_of(data, "lines")
    chart = explorable(plot_sweep_lines(data, "total", Figure().subplots()))
    (line,) = chart["data"]
    assert line["x"] == ["schlenk", "constant"]  # names, which no format of numbers fits
    assert "{x}" in line["hovertemplate"]
    assert (chart["layout"]["xaxis"]["type"], chart["layout"]["yaxis"]["type"]) == (
        "category", "linear",
    )  # fmt: skip


def test_a_damaged_sweep_is_refused(data, tmp_path):
    write_dataset(data, tmp_path / "sweep.nc")
    with xr.open_dataset(tmp_path / "sweep.nc") as stored:
        stored.load()
    stored["efficiency"] = stored["efficiency"].astype(str)
    stored.to_netcdf(tmp_path / "damaged.nc")
    with pytest.raises(ep.InputError, match="efficiency: must be numbers over"):
        ep.open_result(tmp_path / "damaged.nc")
