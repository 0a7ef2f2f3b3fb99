"""Every plot that can be asked for by name."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import epicyclic as ep
from epicyclic.errors import InputError
from epicyclic.show.plots.catalogue import PLOTS, available, figure_of, panels_of
from epicyclic.show.plots.heat_network import plot_heat_network
from epicyclic.show.plots.loss_map import map_at

OF_MAPS = [name for name in PLOTS if "map" in name or name.startswith("loss-over")] + ["loss-parts"]
OF_BANDS = ["loss-band", "loss-band-lines"]
OF_HEAT, OF_TRAINS = "heat-network", ("arrangement", "oil")
OF_SWEEPS = ["lines", "contours", "parallel"]
OTHERS = (*OF_MAPS, *OF_BANDS, *OF_SWEEPS, OF_HEAT, *OF_TRAINS)
OF_RESULTS = [name for name in PLOTS if name not in OTHERS]


def drawn_texts(figure):
    """Texts of a figure and their places on it. [px]"""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    shown = []
    for ax in figure.axes:
        for axis in (ax.xaxis, ax.yaxis):
            low, high = sorted(axis.get_view_interval())
            ticks = [tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
            shown += [axis.label, *(tick.label1 for tick in ticks)]
    return [
        (text.get_text(), text.get_window_extent(renderer)) for text in shown if text.get_text()
    ]


def check_figure(figure):
    """Axes have labels, within the picture, but for those without axes."""
    if not any(ax.axison for ax in figure.axes):
        return
    labelled = [ax for ax in figure.axes if ax.get_xlabel() or ax.get_ylabel()]
    assert labelled
    for ax in figure.axes:
        scale = ax.get_label() == "<colorbar>"
        assert ax.get_ylabel() or (not scale and ax.get_xlabel())
        assert ax.lines or ax.patches or ax.collections or ax.texts
    width, height = figure.canvas.get_width_height()
    for text, box in drawn_texts(figure):
        assert min(box.x0, box.y0) > -1, text
        assert box.x1 < width + 1, text
        assert box.y1 < height + 1, text


def test_a_result_and_a_map_have_all_plots_between_them(talbot_record, pair_map):
    assert list(available(talbot_record)) == OF_RESULTS
    assert set(available(pair_map)) == {"gear-set", *OF_MAPS}


@pytest.mark.parametrize("name", OF_RESULTS)
def test_every_plot_of_a_result_has_labels_within_the_picture(talbot_record, name):
    check_figure(figure_of(talbot_record, name))


@pytest.mark.slow
@pytest.mark.parametrize("name", OF_MAPS)
def test_every_plot_of_a_map_has_labels_within_the_picture(pair_map, name):
    figure = figure_of(pair_map, name)
    check_figure(figure)
    assert "40 °C" in figure.axes[0].get_title(loc="left")


@pytest.fixture(scope="module")
def banded(pair_map):
    few = pair_map.isel(temperature=[0], speed=[1, 2], torque=[0, 2])
    return ep.uncertainty(few, samples=16, jobs=1)


@pytest.mark.parametrize("name", OF_BANDS)
def test_every_plot_of_a_map_with_its_uncertainty_has_labels_within_the_picture(banded, name):
    check_figure(figure_of(banded, name))


def test_a_map_without_its_uncertainty_has_no_plots_of_it(pair_map):
    assert not set(available(pair_map.isel(temperature=[0]))).intersection(OF_BANDS)


def test_bars_are_the_losses_and_their_sum_is_the_total(talbot_record):
    result = talbot_record.result
    bars = figure_of(talbot_record, "losses").axes[0].patches
    assert [bar.get_width() for bar in bars] == [watts for watts in result.losses.values() if watts]
    *steps, total = figure_of(talbot_record, "loss-sum").axes[0].patches
    steps = sorted(steps, key=lambda bar: bar.get_x())
    ends = [bar.get_x() + bar.get_width() for bar in steps]
    assert [bar.get_x() for bar in steps[1:]] == pytest.approx(ends[:-1])
    assert total.get_width() == pytest.approx(ends[-1]) == pytest.approx(result.total)


def test_small_losses_are_put_together_and_each_part_has_one_bar(talbot_record, monkeypatch):
    monkeypatch.setattr("epicyclic.show.plots.losses.MOST_ROWS", 4)
    axes = [figure_of(talbot_record, name).axes[0] for name in ("losses", "loss-sum")]
    for ax in axes:
        names = [text.get_text() for text in ax.get_yticklabels()]
        assert len(names) == len(set(names))
        assert "others" in names
        ends = [bar.get_x() + bar.get_width() for bar in ax.patches]
        assert max(ends) <= talbot_record.result.total * (1 + 1e-12)
    widths = [bar.get_width() for bar in axes[0].patches]
    assert sum(widths) == pytest.approx(talbot_record.result.total, rel=1e-12)


def test_roller_bars_carry_the_radial_force(talbot_record):
    bars = figure_of(talbot_record, "roller-loads").axes[0].patches
    bearing = talbot_record.fields["bearings/planet_bearing"]
    loads = np.array([bar.get_height() for bar in bars]).reshape(bearing["load"].shape)
    azimuth = np.radians(bearing["azimuth"].to_numpy())
    force = talbot_record.result.bearing.radial_force
    assert (loads @ np.cos(azimuth)).sum() == pytest.approx(force, rel=1e-6)


def test_curves_along_the_path_average_the_points_of_the_mesh(talbot_record):
    mesh = talbot_record.fields["meshes/sun_mesh"]
    line = figure_of(talbot_record, "sliding").axes[0].lines[0]
    # sliding is proportional to the path from the pitch point
    path, speed = mesh["path_position"].to_numpy(), mesh["sliding_speed"].to_numpy()
    slope = np.nanmean(speed[np.abs(path) > 1] / path[np.abs(path) > 1])
    width = np.ptp(path[np.isfinite(speed)]) / 40
    assert np.abs(line.get_ydata() - slope * line.get_xdata()).max() < abs(slope) * width


def test_areas_of_a_map_add_up_to_the_total(pair_map):
    point = map_at(pair_map, temperature=90.0)
    ax = panels_of(pair_map, "loss-parts")[1].draw(_axes())
    top = max(path.vertices[:, 1].max() for area in ax.collections for path in area.get_paths())
    assert top == pytest.approx(float(point["total"].isel(torque=-1).max()))


def test_an_unknown_plot_names_those_that_there_are(talbot_record, pair_map):
    with pytest.raises(InputError, match="is not a plot; it has gear-set, teeth, losses"):
        figure_of(talbot_record, "wheel")
    with pytest.raises(
        InputError, match="cannot be drawn from this file; it has gear-set, efficiency-map"
    ):
        figure_of(pair_map, "losses")


@pytest.mark.parametrize(
    "changes",
    [
        pytest.param({"operation.torque": "0 N*m"}, marks=pytest.mark.slow),
        {"operation.speed": "0 rpm"},
        pytest.param(
            {"planet_bearing": None, "losses.sun_mesh_pocketing.include": False},
            marks=pytest.mark.slow,
        ),
    ],
    ids=["no-torque", "no-speed", "parts-left-out"],
)
def test_what_a_case_lacks_is_left_out_or_said(talbot, changes):
    record = ep.record(talbot.updated(changes))
    kept = available(record)
    assert ("roller-loads" in kept) == ("planet_bearing" not in changes)
    assert ("line-load" in kept) == ("operation.torque" not in changes)
    assert ("pocket-power" in kept) == ("operation.torque" in changes)
    for name in kept.keys() & {"losses", "loss-sum", "friction", "friction-power", "roller-loads"}:
        check_figure(figure_of(record, name))


def _axes():
    return Figure().subplots()


def test_the_picture_of_heat_has_every_part_with_its_temperature_and_all_the_heat():
    case = ep.load_case("talbot-2012").updated({"models.temperatures": "network"})
    result = ep.solve(case)
    assert result.heat is not None
    ax = plot_heat_network(result.heat, Figure(figsize=(7, 5)).subplots())
    texts = " ".join(text.get_text() for text in ax.texts)
    for node, kelvin in {**result.heat.temperatures, **result.heat.given}.items():
        assert node.replace("_", " ") in texts
        assert f"{kelvin - 273.15:.1f} °C" in texts
    assert f"{result.total / 1e3:.3g} kW" in texts
    check_figure(ax.figure)
