"""The explorer of maps and sweeps: what the page holds, and what a browser shows of it."""

from __future__ import annotations

import base64
import json
import math
import re
import shutil
import subprocess

import numpy as np
import pytest
import xarray as xr

import epicyclic as ep
from epicyclic.show import explorer
from epicyclic.show.explorer import explorer_items
from epicyclic.show.html import page_bytes
from epicyclic.show.page import Explorer, Listing
from epicyclic.show.plots.catalogue import panels_of
from epicyclic.show.plots.loss_map import map_line, shown_panels
from epicyclic.show.plots.sweep import LEFT_OUT, MOST_POINTS, thinned
from epicyclic.units import format_number

VARY = {
    "operation.speed": ["2000 rpm", "5000 rpm", "7000 rpm"],
    "models.friction": ["schlenk", "constant"],
    "operation.torque": ["37 N*m", "91 N*m"],
    "operation.oil_inlet_temperature": ["63 degC"],
}
QUICK = {
    "losses.mesh_pocketing.include": False,
    "models.load_distribution": "uniform",
    "models.constant_friction": 0.031,
}
BROWSER = shutil.which("chromium") or shutil.which("google-chrome")


@pytest.fixture(scope="module")
def data():
    return ep.sweep(ep.load_case("talbot-2012-pair").updated(QUICK), VARY, jobs=1)


@pytest.fixture(scope="module")
def page(data):
    return ep.report_html(data)


def contents_of(page):
    """What the page gives to its script, the values over results and axes."""
    (text,) = re.findall(r'<div class="explorer">\s*<script type="application/json">(.*?)<', page)
    contents = json.loads(text)
    shape = [len(contents["results"]), *(len(axis["values"]) for axis in contents["axes"])]
    packed = base64.b64decode(contents["values"])
    return contents, np.frombuffer(packed, "<f4").reshape(shape)


def test_the_page_holds_every_number_of_the_sweep(data, page):
    contents, values = contents_of(page)
    axes = contents["axes"]
    assert [axis["name"] for axis in axes] == [
        "speed", "models_friction", "torque",
    ]  # fmt: skip
    assert [axis["values"] for axis in axes] == [
        [2000.0, 5000.0, 7000.0], ["schlenk", "constant"], [37.0, 91.0],
    ]  # fmt: skip
    assert [axis["continuous"] for axis in axes] == [True, False, True]
    assert axes[2]["unit"] == "N·m"
    names = [result["name"] for result in contents["results"]]
    known = {name for name, array in data.items() if array.dtype.kind == "f" and array.count()}
    assert set(names) == known
    for name, held in zip(names, values, strict=True):
        expected = (
            data[name]
            .isel({"operation.oil_inlet_temperature": 0})
            .transpose(*(axis["name"] for axis in axes))
        )
        np.testing.assert_allclose(held, expected, rtol=1e-6, err_msg=name)


def test_losses_come_before_sums_and_these_before_figures(data, page):
    contents, values = contents_of(page)
    groups = [result["group"] for result in contents["results"]]
    assert groups == sorted(groups, key=["loss", "sum", "figure"].index)
    losses = values[[group == "loss" for group in groups]].sum(axis=0)
    names = [result["name"] for result in contents["results"]]
    np.testing.assert_allclose(losses, values[names.index("total")], rtol=1e-5)


def test_a_map_is_explored_over_all_axes(pair_map):
    (item,) = explorer_items(pair_map)
    axes = item.contents["axes"]
    assert [(axis["name"], axis["label"]) for axis in axes] == [
        ("speed", "speed of the pinion"),
        ("torque", "torque on the pinion"),
        ("temperature", "oil temperature"),
    ]
    assert item.contents["start"] == [2, 1, 1]  # next to 4500 rpm, 50 N*m, 77.5 degC


@pytest.mark.parametrize(
    ("most", "kept", "told"),
    [
        (200, "single losses", "further results are left out"),
        (36, "sums", "further results are left out"),
        (35, "nothing", "12 points are too many for an explorer within a page; the limit is 11"),
    ],
)
def test_what_does_not_fit_into_a_page_is_left_out_and_told(data, monkeypatch, most, kept, told):
    monkeypatch.setattr(explorer, "MOST_VALUES", most)
    items = explorer_items(data)
    (listing,) = (item for item in items if isinstance(item, Listing))
    assert told in listing.items[0]
    groups = [
        result["group"]
        for item in items
        if isinstance(item, Explorer)
        for result in item.contents["results"]
    ]
    assert ("loss" in groups, "sum" in groups) == (kept == "single losses", kept != "nothing")


def test_there_is_nothing_to_explore_without_a_varied_axis_or_a_solved_point(data):
    single = data.isel({dim: [0] for dim in data["total"].dims})
    assert explorer_items(single) == ()
    assert explorer_items(data.assign(total=data["total"] * np.nan)) == ()


@pytest.mark.slow
def test_labels_are_shown_as_they_are_and_are_no_code_or_formula(data):
    hostile = "</script><script>alert(1)</script> \u2028 <img src=x> $\\frac$ a $^$"
    named = data.copy()
    named["total"] = data["total"].assign_attrs(long_name=hostile)
    named["speed"] = data["speed"].assign_attrs(case_key=hostile)
    text = ep.report_html(named)
    assert "<script>alert" not in text
    assert "<img" not in text
    contents, _ = contents_of(text)
    assert hostile in [result["label"] for result in contents["results"]]
    assert contents["axes"][0]["key"] == hostile


def test_a_sweep_without_a_known_loss_is_reported_without_pictures_of_it(data):
    unknown = data.assign(total=data["total"] * np.nan)
    assert "<h1>" in ep.report_html(unknown)


def test_a_sweep_has_a_report_of_its_own(data, page):
    sections = re.findall(r'<section id="([^"]+)"', page)
    assert sections == ["explorer", "lines", "all", "points", "validity", "inputs", "versions"]
    assert '<section id="explorer" hidden>' in page  # until its script has run
    shown = [float(one) for one in re.findall(r'<data value="([^"]+)" data-key="total\[', page)]
    assert shown == sorted(data["total"].values.ravel())


def enlarged(data, speeds, torques):
    """A sweep of as many speeds and torques, made of a small one; no two numbers are equal."""
    sizes = {"speed": speeds, "torque": torques}
    repeated = {dim: np.arange(count) % data.sizes[dim] for dim, count in sizes.items()}
    large = data.isel(repeated)
    for dim, count in sizes.items():
        values = 1.5 * data[dim].values[0] + 0.37 * np.arange(count)
        large = large.assign_coords({dim: (dim, values, data[dim].attrs)})
    factor = 1 + 1e-7 * np.arange(large["total"].size).reshape(large["total"].shape)
    for name, array in large.data_vars.items():
        if array.dtype.kind == "f" and array.shape == factor.shape:
            large[name] = (array.dims, array.values * factor, array.attrs)
    return large


@pytest.mark.slow
def test_the_page_of_a_large_sweep_is_bounded_and_says_what_it_leaves_out(data):
    large, larger = enlarged(data, 70, 60), enlarged(data, 230, 110)
    pages = [ep.report_html(sweep) for sweep in (large, larger)]
    for sweep, page in zip((large, larger), pages, strict=True):
        size = sweep["total"].size
        contents, values = contents_of(page)
        shown = int(np.prod([len(axis["values"]) for axis in contents["axes"]]))
        assert 0.8 * MOST_POINTS < shown <= MOST_POINTS
        told = f"Of {size} points {shown} are shown"
        assert page.count(told) == 3
        assert page.count(f"{size - shown} are left out.") == 3
        assert f"{shown} of {size} points of the sweep" in page
        # what is shown is what was computed there, the least loss among it
        names = [result["name"] for result in contents["results"]]
        total = values[names.index("total")]
        at = {axis["name"]: axis["values"] for axis in contents["axes"]}
        np.testing.assert_array_equal(total, sweep["total"].squeeze().sel(at).astype("f4"))
        assert total.min() == np.float32(sweep["total"].min())
        for axis in ("speed", "torque"):
            assert {at[axis][0], at[axis][-1]} == {*sweep[axis].values[[0, -1]]}
        # tables and counts are of all points
        rows = [float(one) for one in re.findall(r'<data value="([^"]+)" data-key="total\[', page)]
        every = np.sort(sweep["total"].values, axis=None)
        assert rows == [*every[:11], every[-1]]
        counts = re.findall(rf"\((\d+) of {size} points\)", page)
        assert counts
        assert all(int(count) <= size for count in counts)
    assert len(pages[1]) < 1.1 * len(pages[0])


@pytest.mark.parametrize(
    "sizes", [(5001,), (1_000_000,), (1000, 1000), (2,) * 20, (3, 4999, 2), (71, 72), (7, 1, 20000)]
)
def test_thinned_sweeps_keep_their_least_loss_and_as_many_values_as_there_is_room(sizes):
    losses = np.random.default_rng(4).permutation(math.prod(sizes)) + 0.5
    dims = [f"key{number}" for number in range(len(sizes))]
    sweep = xr.Dataset({"total": (dims, losses.reshape(sizes))})
    part = thinned(sweep)
    kept = part["total"]
    assert 0.4 * MOST_POINTS < kept.size <= MOST_POINTS
    assert part.attrs[LEFT_OUT] == losses.size - kept.size
    assert kept.min() == 0.5
    assert len({*kept.values.ravel()}) == kept.size  # no point twice
    assert all(some <= every for some, every in zip(kept.shape, sizes, strict=True))
    assert thinned(part) is part


def test_a_sweep_of_as_many_points_as_a_page_has_room_for_is_whole():
    total = np.arange(MOST_POINTS) + 0.5
    sweep = xr.Dataset({"total": ("key", total)})
    assert thinned(sweep) is sweep
    unknown = xr.Dataset({"total": ("key", np.full(MOST_POINTS + 1, np.nan))})
    assert thinned(unknown).attrs[LEFT_OUT] == 1


def test_like_warnings_are_counted_together(data, page):
    text = page.partition('<section id="validity"')[2].partition("</section>")[0]
    warnings = re.findall(r"<li>(.*?)</li>", text)
    assert all(re.search(r"\(\d+ of 12 points\)", one) for one in warnings)
    distinct = {line for text in data["warnings"].values.ravel() for line in text.split(" | ")}
    assert len(warnings) < len(distinct)


def test_a_report_of_a_sweep_prints_as_pdf(page):
    pytest.importorskip("weasyprint", reason="optional")
    assert page_bytes(page, ".pdf").startswith(b"%PDF")


ASK = """<script>
const [speed, friction, torque] = document.querySelectorAll(".axes input");
const move = (slider, value) => {
  slider.value = value;
  slider.dispatchEvent(new Event("input"));
};
const say = () => ({
  where: document.querySelector(".where").textContent,
  at: [...document.querySelectorAll(".axes output")].map((it) => it.textContent),
  curve: document.querySelectorAll("svg.curve circle.computed").length,
  map: document.querySelector("svg.map image").getAttribute("href").length,
  rows: Object.fromEntries([...document.querySelectorAll(".explorer tbody tr")].map(
    (row) => [row.children[0].textContent, row.children[1].textContent])),
});
const said = { steps: speed.max };
move(speed, 20); move(friction, 1); move(torque, 20);
said.computed = say();
move(speed, 30);
said.between = say();
document.querySelector("input[type=checkbox]").click();
said.nearest = say();
document.body.innerHTML = "";
document.body.textContent = `SAID${btoa(encodeURIComponent(JSON.stringify(said)))}SAID`;
</script>"""


@pytest.mark.slow
@pytest.mark.skipif(BROWSER is None, reason="no browser")
def test_a_browser_shows_computed_and_interpolated_values(data, page, tmp_path):
    from urllib.parse import unquote

    file = tmp_path / "page.html"
    file.write_text(page.replace("</body>", f"{ASK}</body>"), encoding="utf-8")
    command = [BROWSER, "--headless", "--no-sandbox", "--dump-dom", f"--user-data-dir={tmp_path}"]
    done = subprocess.run(
        [*command, file.as_uri()], capture_output=True, text=True, timeout=120, check=True
    )
    said = json.loads(unquote(base64.b64decode(done.stdout.split("SAID")[1]).decode()))
    assert said["steps"] == "40"  # 20 from one computed point to the next
    at = {"models.friction": "constant", "operation.torque": 91.0}
    line = data.sel(at).isel({"operation.oil_inlet_temperature": 0}).set_index()
    totals = line["total"].to_numpy()
    powers = line["input_power"].to_numpy()
    computed, between, nearest = said["computed"], said["between"], said["nearest"]
    assert computed["at"] == ["5000 rpm", "constant", "91 N·m"]
    assert computed["where"] == "A computed point."
    assert float(computed["rows"]["total loss"]) == pytest.approx(totals[1], abs=0.5)
    assert between["at"][0] == "6000 rpm"
    assert between["where"] == "Between computed points, interpolated linearly."
    middle = (totals[1] + totals[2]) / 2
    assert float(between["rows"]["total loss"]) == pytest.approx(middle, abs=0.5)
    efficiency = 100 * (1 - middle / ((powers[1] + powers[2]) / 2))
    assert float(between["rows"]["efficiency"]) == pytest.approx(efficiency, abs=0.006)
    assert nearest["at"][0] in ("5000 rpm", "7000 rpm")
    assert nearest["where"] == "A computed point."
    assert computed["curve"] == 3  # the curve is over the speed
    assert computed["map"] > 100


@pytest.mark.slow
def test_a_map_of_many_temperatures_shows_some_of_them_and_says_so(pair_map):
    """Each has pictures and tables of its own: a hundred took minutes and megabytes."""
    celsius = np.linspace(-20.0, 130.0, 31)
    places = (celsius > 60).astype(int)
    many = pair_map.isel(temperature=places).assign_coords(
        temperature=("temperature", celsius, pair_map["temperature"].attrs)
    )
    shown = np.round(np.linspace(0, 30, 12)).astype(int)
    panels = panels_of(many, "loss-map")
    assert [panel.subject for panel in panels] == [f"{celsius[place]:g} °C" for place in shown]
    page = ep.report_html(many)
    assert page.count("shown at 12 of 31 temperatures") >= 2
    for place in range(31):
        heading = f"Total loss, W, at {format_number(celsius[place])} °C"
        assert (heading in page) == (place in shown)
    assert "shown at" not in map_line(pair_map)


def test_of_many_states_and_temperatures_a_page_shows_twelve_panels_at_most(pair_map):
    states = pair_map.expand_dims(state=[f"gear {number}" for number in range(5)])
    celsius = np.linspace(-20.0, 130.0, 7)
    many = states.isel(temperature=[0] * 7).assign_coords(temperature=celsius)
    assert shown_panels(many) == {"state": [0, 1, 2, 3, 4], "temperature": [0, 6]}
    assert shown_panels(pair_map) == {"temperature": [0, 1]}
