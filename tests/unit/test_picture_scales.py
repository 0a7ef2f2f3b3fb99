"""Scales, periods and digits of pictures."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.text import Text

import epicyclic as ep
import listed_trains
from epicyclic.cli.common import parse_size
from epicyclic.result.result import of_gear
from epicyclic.show.page import Cell, Table
from epicyclic.show.plots.arrangement import arrangement_of
from epicyclic.show.plots.catalogue import draw, explorable, figure_of
from epicyclic.show.plots.drawing import plot_gear_set
from epicyclic.show.plots.loss_map import (
    limits_of,
    limits_of_band,
    limits_of_half_width,
    map_line,
    plot_map,
)
from epicyclic.show.plots.losses import banded, plot_loss_sum, plot_losses
from epicyclic.show.plots.mesh import (
    mesh_figure,
    plot_along_path,
    plot_over_period,
    plot_plane_of_action,
    plot_roller_loads,
)
from epicyclic.show.plots.pockets import plot_power, pocket_figure
from epicyclic.show.plots.power_flow import SLIDE
from epicyclic.show.plots.style import styled_figure
from epicyclic.show.record import sets_of
from epicyclic.show.result_tables import key_figures, losses_table, members_table
from epicyclic.show.uncertainty_tables import _shown
from epicyclic.study.operating import operating_line
from epicyclic.study.shapes import gear_shapes
from epicyclic.units import decimals_of, known_text, power_unit
from epicyclic.validation.compare import compare_published
from epicyclic.validation.pages import MOST_ROWS, _items


def axes():
    return Figure().subplots()


@pytest.mark.parametrize("name", ["efficiency-map", "loss-map", "torque-loss-map"])
def test_panels_of_a_map_have_one_scale(pair_map, name):
    figure = figure_of(pair_map, name)
    panels = [ax for ax in figure.axes if ax.get_label() != "<colorbar>"]
    assert len(panels) == pair_map.sizes["temperature"] > 1
    scales = {(ax.collections[0].norm.vmin, ax.collections[0].norm.vmax) for ax in panels}
    assert len(scales) == 1
    if name == "loss-map":
        assert scales == {limits_of(pair_map, "total")}


def test_lines_of_all_panels_reach_the_same_height(pair_map):
    figure = figure_of(pair_map, "loss-over-speed")
    assert len({ax.get_ylim() for ax in figure.axes}) == 1
    assert figure.axes[0].get_ylim()[1] > float(pair_map["total"].max())


def test_a_map_says_at_which_values_of_further_keys_it_is_shown(pair_map):
    keys = {"planet_count": ("planet_count", [3, 5, 4], {"case_key": "planet.count"})}
    data = xr.concat([pair_map] * 3, "planet_count").assign_coords(keys)
    assert map_line(data) == f"{map_line(pair_map)}; number of planets 3, the first of 3"


def test_efficiencies_without_a_line_of_their_own_get_even_ones(pair_map):
    """99.31 to 99.49 %: between those that have lines."""
    data = pair_map.isel(temperature=0)
    share = np.linspace(0, 1, data["efficiency"].size).reshape(data["efficiency"].shape)
    data = data.assign(efficiency=data["efficiency"].copy(data=0.9931 + 0.0018 * share))
    ax = plot_map(data, "efficiency", axes())
    bar = ax.collections[0].colorbar.ax
    ticks = [float(tick.get_text()) for tick in bar.get_yticklabels()]
    assert len(ticks) > 3
    assert 99.31 <= min(ticks) < max(ticks) <= 99.49
    assert len(ax.collections) > 1  # lines, too


def test_bands_of_all_panels_have_one_scale():
    axes = ("result", "temperature", "speed", "torque")
    nominal = np.array([[[[97.0, 211.0]], [[83.0, 190.0]]]])
    bands = {"nominal": nominal, "low": 0.8 * nominal, "high": 1.45 * nominal}
    bands["high"][0, 1, 0, 1] = 301.0
    data = xr.Dataset({name: (axes, values) for name, values in bands.items()})
    data = data.assign_coords(result=["total"])
    assert limits_of_band(data) == pytest.approx((0.8 * 83.0, 1.45 * 211.0))
    assert limits_of_half_width(data) == (32, 40)  # from 32.5, and 50 (301 - 152)/190


def test_an_efficiency_map_tells_98_from_99_percent(pair_map):
    figure = figure_of(pair_map, "efficiency-map")
    norm = figure.axes[0].collections[0].norm
    high = norm.vmax
    near, far = norm(high) - norm(high - 1), norm(high - 10) - norm(high - 11)
    assert near > 2 * far > 0


def test_curves_over_a_mesh_period_are_closed(talbot_record):
    mesh = talbot_record.group("meshes")["sun_mesh"]
    angles, errors = plot_over_period(mesh, "transmission_error", axes()).lines[0].get_data()
    assert errors[0] == errors[-1] != errors[1]
    assert angles[-1] - angles[0] == pytest.approx(mesh.attrs["pitch_angle_deg"], rel=1e-12)
    assert len(errors) == mesh.sizes["mesh_position"] + 1
    pockets = talbot_record.group("pockets")["sun_mesh"]
    angles, powers = plot_power(pockets, axes()).lines[0].get_data()
    assert powers[0] == powers[-1]
    assert angles[-1] - angles[0] == pytest.approx(mesh.attrs["pitch_angle_deg"], rel=1e-9)


@pytest.mark.parametrize(
    ("model", "words"),
    [("schlenk", "one mean value for the whole mesh"), ("xu-2007", "mean across the face")],
)
def test_friction_says_when_the_model_is_a_mean(model, words):
    case = ep.load_case("talbot-2012-pair").updated(
        {"operation.torque": "413 N*m", "models.friction": model}
    )
    ax = plot_along_path(ep.mesh_details(case)["mesh"], "friction_coefficient", axes())
    assert any(words in text.get_text() for text in ax.get_legend().get_texts())


def test_a_peak_at_a_corner_has_its_colour_and_leaves_half_of_the_scale_to_the_rest(talbot_record):
    mesh = talbot_record.group("meshes")["ring_mesh"].copy()
    loads = mesh["line_load"].copy()
    most = float(loads.quantile(0.9))
    mesh["line_load"] = loads.where(loads < most, most)
    ax = plot_plane_of_action(mesh, "line_load", axes())
    assert ax.collections[0].norm.vmax == pytest.approx(most)
    corner = loads.where(loads < most, most)
    place = np.unravel_index(np.nanargmax(corner.values), corner.shape)
    corner.values[place] = 7 * most
    mesh["line_load"] = corner
    norm = plot_plane_of_action(mesh, "line_load", axes()).collections[0].norm
    assert norm.vmax == pytest.approx(7 * most)
    assert float(norm(most)) == pytest.approx(0.5, rel=1e-3)


@pytest.mark.parametrize(
    ("total", "decimals"), [(0.0, 0), (2602.0, 0), (867.3, 0), (86.7, 1), (8.67, 2), (0.0867, 3)]
)
def test_powers_have_three_digits_of_their_total(total, decimals):
    assert decimals_of(total) == decimals


@pytest.mark.parametrize(
    ("text", "size"),
    [("160x90 mm", (160.0, 90.0)), ("16.5 x 9cm", (165.0, 90.0)), ("10×4in", (254.0, 101.6))],
)
def test_sizes_of_pictures(text, size):
    assert parse_size(text) == pytest.approx(size)


@pytest.mark.parametrize("text", ["160x90", "160 mm", "1x90 mm", "160x9000 mm", "1.2.3x90 mm"])
def test_sizes_that_are_none_are_refused(text):
    with pytest.raises(ep.InputError, match="must be a width and a height of 30 to 2000 mm"):
        parse_size(text)


def terms_within(result, *sets):
    """The losses of a result as those of sets of a train."""
    return tuple(replace(term, name=f"{own}.{term.name}") for own in sets for term in result.terms)


def test_a_single_set_of_a_train_shows_its_components(talbot_record):
    contents = talbot_record.result
    inside = replace(contents, kind="train", terms=terms_within(contents, "S"))
    alone, within = (plot_losses(one, axes()) for one in (contents, inside))
    names = [[text.get_text() for text in ax.get_yticklabels()] for ax in (alone, within)]
    assert names[0] == names[1]
    assert len(names[0]) > 5


def test_several_sets_are_bars_of_their_own_however_many(talbot_record, monkeypatch):
    monkeypatch.setattr("epicyclic.show.plots.losses.MOST_BARS", 1)
    contents = talbot_record.result
    both = replace(contents, kind="train", terms=terms_within(contents, "P1", "P2"))
    ax = plot_losses(both, axes())
    assert [text.get_text() for text in ax.get_yticklabels()] == ["P1", "P2"]


def test_too_many_losses_are_summed_by_what_loses_them(talbot_record, monkeypatch):
    contents = talbot_record.result
    monkeypatch.setattr("epicyclic.show.plots.losses.MOST_BARS", 5)
    ax = plot_losses(contents, axes())
    names = [text.get_text() for text in ax.get_yticklabels()]
    assert {"sun mesh", "ring mesh", "planet bearing"} <= set(names)
    sum_of_mesh = sum(
        watts for name, watts in contents.losses.items() if name.startswith("sun_mesh")
    )
    row = names.index("sun mesh")
    bars = [bar for bar in ax.patches if round(bar.get_y() + bar.get_height() / 2) == row]
    assert sum(bar.get_width() for bar in bars) == pytest.approx(sum_of_mesh, rel=1e-12)


@pytest.mark.parametrize(("factor", "unit", "scale"), [(1.0, "W", 1.0), (7.3, "kW", 1e3)])
def test_large_losses_are_in_kilowatts(talbot_record, factor, unit, scale):
    contents = talbot_record.result
    larger = replace(
        contents, terms=tuple(replace(term, watts=factor * term.watts) for term in contents.terms)
    )
    ax = plot_loss_sum(larger, axes())
    assert ax.get_xlabel() == f"power loss, {unit}"
    total = ax.patches[-1].get_width()
    assert total == pytest.approx(factor * contents.total / scale)
    digits = ax.texts[-1].get_text().replace(".", "")
    assert len(digits) <= 4


def test_the_scale_of_roller_loads_is_apart_from_the_bars(talbot_record):
    bearing = next(iter(talbot_record.group("bearings").values()))
    ax = Figure().subplots(subplot_kw={"projection": "polar"})
    for turned in (0.0, 97.0):
        moved = bearing.assign(azimuth=(bearing["azimuth"] + turned) % 360)
        plot_roller_loads(moved, ax)
        load = moved["load"].max("row").to_numpy()
        carrying = moved["azimuth"].to_numpy()[load > 0.05 * load.max()]
        apart = (ax.get_rlabel_position() - carrying + 180) % 360 - 180
        assert abs(apart).min() >= 0.4 * 360 / moved.sizes["roller"]
    chart = explorable(ax)
    assert chart["layout"]["polar"]["domain"]["y"][1] < 0.95, "the label above the circle has room"


def test_long_labels_beside_low_axes_are_broken():
    with styled_figure(3, 1, "", size=(6.0, 5.4)) as (figure, panels):
        panels[0, 0].set_ylabel("mesh stiffness per face width, N/(mm·µm)")
        panels[1, 0].set_ylabel("power, W")
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert labels[1:] == ["power, W", ""]
    assert "\n" in labels[0]
    assert labels[0].replace("\n", " ") == "mesh stiffness per face width, N/(mm·µm)"


@pytest.mark.parametrize(
    ("power", "unit"),
    [(0.0, "W"), (9999.0, "W"), (10_007.0, "kW"), (9.9e6, "kW"), (1e7, "MW"), (3e10, "GW")],
)
def test_large_powers_are_in_kilowatts(power, unit):
    assert power_unit(power)[0] == power_unit(-power)[0] == unit


@pytest.mark.parametrize(("torque", "unit"), [("1e9 N*m", "MW"), ("20 kN*m", "kW")])
def test_labels_beside_bars_are_short_and_read_as_their_share(torque, unit):
    """A share of 0.1 % beside a loss of 0.0 says nothing, and 2068263 takes the picture's room."""
    result = ep.solve(ep.load_case("talbot-2012", {"operation.torque": torque}))
    for plot in (plot_losses, plot_loss_sum):
        ax = Figure().subplots()
        plot(result, ax)
        assert ax.get_xlabel() == f"power loss, {unit}"
        labels = [text.get_text() for text in ax.texts]
        assert max(len(text.partition(" ")[0]) for text in labels) <= 5
        assert not [text for text in labels if text.startswith("0.0 ") and "(0.0 %)" not in text]
    cells = [[cell.text for cell in row] for row in losses_table(result).rows]
    assert not [row for row in cells if row[1] == "0.0" and row[2] not in ("", "0.0 %")]


def test_losses_of_one_sentence_share_unit_and_decimals():
    assert known_text(8380.4, 15235.3, 25624.9) == "8.4 to 15.2 to 25.6 kW"
    assert known_text(96.24, 8380.4) == "96 to 8380 W"
    assert known_text(23450.6, unit="kJ") == "23451 kJ"
    assert known_text(8380.4, beside=10390.2) == "8.4 kW"
    assert known_text(math.nan) == "nan W"


def test_the_operating_point_is_written_like_the_power():
    point = {"speed": "13 rpm", "torque": "2000000 N*m"}
    assert operating_line(point) == "13 rpm, 2000 kN·m"
    assert operating_line(point | {"torque": "-0.75 MN*m"}) == "13 rpm, -750 kN·m"
    assert operating_line(point | {"torque": "9999.5 N*m"}) == "13 rpm, 9999.5 N·m"
    assert operating_line({"speed": "13 rpm"}) == "13 rpm"


def test_columns_of_torque_and_power_are_in_the_unit_of_their_largest(talbot_record):
    result = talbot_record.result
    members = result.flow.members
    large = replace(members["sun"], torque=-12345.6)
    flow = replace(result.flow, members=members | {"sun": large})
    table = members_table(replace(result, flow=flow))
    assert table.head[2] == "torque, kN·m"
    (row,) = (cells for cells in table.rows if cells[0].text == "sun")
    assert (row[2].text, row[2].value) == ("-12.3456", -12345.6)


def test_key_figures_have_no_false_digits(talbot_record):
    result = talbot_record.result

    def shown(load_dependent):
        watts = {"load-dependent": load_dependent, "load-independent": 96.23}
        terms = (replace(result.terms[0], group=group, watts=watts[group]) for group in watts)
        figures = key_figures(replace(result, terms=tuple(terms)))
        return {one.label: one for one in figures}

    found = shown(21928.87)
    texts = {name: (one.cell.text, one.unit) for name, one in found.items()}
    assert texts["total loss"] == ("22.0", "kW")
    assert texts["load-independent"] == ("96.2", "W")
    assert found["total loss"].cell.value == pytest.approx(22025.1)  # in watts, as in JSON
    small = shown(2568.4)["load-dependent"]
    assert (small.cell.text, small.unit) == ("2568", "W")


def test_gears_that_hide_others_are_named():
    gears = sets_of(gear_shapes(ep.load_case(listed_trains.plus())))["S"]
    labels = [text.get_text() for text in plot_gear_set(gears, axes()).get_legend().get_texts()]
    assert sorted(labels) == [
        "A, 40 teeth", "B, 41 teeth, behind A", "narrow, 41 teeth", "wide, 42 teeth, behind narrow",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("name", "words"),
    [("large_sun", "of the large sun"), ("planet", "of the planet"), ("A", "of gear A")],
)
def test_what_a_label_says_of_gears(name, words):
    assert of_gear(name) == words


def test_labels_of_figures_in_pages_are_broken_where_they_are_longer_than_the_axes(talbot_record):
    svg = draw(talbot_record, "pair-load", size=(100.0, 45.0))[0].svg
    assert "normal force" in svg
    assert "normal force on the tooth pair" not in svg


@pytest.mark.parametrize(
    ("sheet", "group"),
    [pytest.param(mesh_figure, "meshes", marks=pytest.mark.slow), (pocket_figure, "pockets")],
)
def test_letters_of_sheets_have_ten_points_on_a_slide(talbot_record, sheet, group):
    figure = sheet(talbot_record.group(group)["sun_mesh"])
    figure.draw_without_rendering()
    width = figure.get_size_inches()[0]
    smallest = min(text.get_fontsize() for text in figure.findobj(Text) if text.get_text())
    assert smallest * SLIDE[0] / width > 10.0
    assert smallest / 72 * figure.dpi > 20.0  # pixels, at 1920 over the width


def test_tables_with_long_texts_are_divided_between_pages():
    def table(text, rows):
        return Table(("figure", "unit"), ((Cell(text), Cell("W")),) * rows)

    assert table("ratio", 6).is_short
    assert not table("ratio", 7).is_short
    assert table("loss factor " * 7, 3).is_short
    assert not table("loss factor " * 7, 4).is_short


def test_pictures_of_published_figures_have_few_rows():
    row = compare_published(topic="Temperatures")[0]
    items = list(_items("trains", [row] * (2 * MOST_ROWS + 1)))
    assert [item.kind for item in items] == ["table", "gallery"] * 3
    assert [len(item.rows) for item in items[::2]] == [6, 6, 5]
    drawn = [item.drawings[0].name for item in items[1::2]]
    assert drawn == ["trains-1", "trains-2", "trains-3"]
    assert [one.drawings[0].name for one in [*_items("trains", [row])][1:]] == ["trains"]


def test_a_result_without_a_value_shows_none_in_the_table_of_bands():
    def text(value, unit):
        return _shown(xr.Dataset({"mean": value, "unit": unit}), "mean").text

    assert [text(np.nan, unit) for unit in ("1", "W", "kJ")] == ["-"] * 3
    assert text(0.98765, "1") == "98.765"


def test_sets_and_shafts_of_a_train_lie_where_the_case_has_them():
    case = ep.load_case("train-eaxle", {"sets.pair.direction": "90 deg"})
    inputs = case.given() | {"operation": {"input": "motor"}}
    found = arrangement_of(inputs, gear_shapes(case))
    assert found.axes["motor"] == pytest.approx([0.0, 0.0])
    assert found.axes["middle"] == pytest.approx([0.0, 90.0])
    assert found.axes["differential"] == pytest.approx(found.axes["middle"])
    assert float(found.gears["planets.sun"]["center_y"][0]) == pytest.approx(90.0)
    assert found.middles["pair"] == pytest.approx(40.0)
    assert found.starts["middle"] == pytest.approx(5.0)  # its gear stands at 35 mm
    assert found.middles["planets"] > 40.0 + (30.0 + 36.0) / 2
    assert found.assumed == ("planets",)


def test_losses_that_would_read_nothing_are_drawn_together(talbot_record):
    contents = talbot_record.result
    tiny = {"sun_drag": 0.13, "carrier_drag": 0.21}
    few = replace(
        contents,
        terms=tuple(replace(it, watts=tiny.get(it.name, it.watts)) for it in contents.terms),
    )
    ax = plot_loss_sum(few, axes())
    names = [text.get_text() for text in ax.get_yticklabels()]
    assert not {"sun drag", "carrier drag"} & set(names)
    assert names[-2:] == ["others", "total"]
    assert ax.texts[len(names) - 2].get_text() == "0"
    assert ax.patches[-1].get_width() == pytest.approx(few.total)


def test_an_efficiency_that_is_nothing_has_no_band(talbot_record):
    data = talbot_record.group("uncertainty")["result"]
    assert banded(data) == ("total", "efficiency")
    assert banded(data.assign({end: 0 * data[end] for end in ("low", "high")})) == ("total",)
