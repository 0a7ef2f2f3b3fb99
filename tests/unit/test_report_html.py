"""The report as one HTML file."""

from __future__ import annotations

import html
import json
import re
from functools import cache
from html.parser import HTMLParser

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.show.plots.catalogue import draw
from epicyclic.show.plots.loss_map import map_at
from epicyclic.show.summary import all_warnings

VOID = {"meta", "br", "link", "img", "col"}
"""Tags without an end."""


class Page(HTMLParser):
    """Numbers, links and ids of a page, and whether its tags are balanced."""

    def __init__(self, text):
        super().__init__()
        self.numbers, self.links, self.ids, self.open = {}, [], [], []
        self.sections = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        if tag not in VOID:
            self.open.append(tag)
        if tag == "data":
            self.numbers[attributes["data-key"]] = float(attributes["value"])
        if tag == "section":
            self.sections.append(attributes["id"])
        self.links += [
            value for key, value in attrs if key in ("src", "href", "xlink:href") and value
        ]
        if "id" in attributes:
            self.ids.append(attributes["id"])

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


parsed = cache(Page)
"""Each page is read once."""


@pytest.fixture(scope="module")
def page(talbot_record):
    return ep.report_html(talbot_record)


@pytest.fixture(scope="module")
def told():
    """What a report tells of its progress."""
    return []


@pytest.fixture(scope="module")
def map_page(pair_map, told):
    return ep.report_html(pair_map, lambda done, total: told.append((done, total)))


@pytest.fixture(params=["page", "map_page"])
def any_page(request):
    return request.getfixturevalue(request.param)


def test_every_tag_is_closed_and_every_id_is_unique(any_page):
    content = parsed(any_page)
    assert content.open == []
    assert len(set(content.ids)) == len(content.ids)


def test_nothing_is_loaded_from_elsewhere(any_page):
    for link in parsed(any_page).links:
        assert link.startswith(("#", "data:")), link[:80]
    assert "default-src 'none'" in any_page  # the browser enforces it too
    assert not re.search(r"@import|url\((?!#)", any_page)


def test_every_reference_within_the_page_has_its_target(any_page):
    content = parsed(any_page)
    targets = {link[1:] for link in content.links if link.startswith("#")}
    targets |= set(re.findall(r"url\(#([^)]+)\)", any_page))
    assert targets <= set(content.ids)


def test_the_chapters_hold_what_an_engineer_asks_for(page, map_page):
    assert parsed(page).sections == [
        "losses", "uncertainty", "validity", "gears", "load", "friction", "bearing", "pockets",
        "oil", "methods", "inputs", "versions",
    ]  # fmt: skip
    assert parsed(map_page).sections == [
        "explorer", "efficiency", "losses", "lines", "tables", "validity", "gears", "methods",
        "conventions", "inputs", "versions",
    ]  # fmt: skip


@pytest.mark.slow
def test_a_stored_file_gives_the_same_page(talbot_record, page, tmp_path):
    ep.save_result(talbot_record, tmp_path / "result.nc")
    assert ep.report_html(ep.open_result(tmp_path / "result.nc")) == page


@pytest.mark.slow
def test_a_stored_map_gives_the_same_page(pair_map, map_page, tmp_path):
    ep.write_map(pair_map, tmp_path / "map.nc")
    assert ep.report_html(ep.open_result(tmp_path / "map.nc")) == map_page


def value_in(result, key):
    """What the JSON form has at a dotted key."""
    for part in key.split("."):
        if isinstance(result, dict) and "value" in result:
            result = result["value"]
        result = result[int(part)] if isinstance(result, list) else result[part]
    return result["value"] if isinstance(result, dict) else result


def test_all_numbers_are_those_of_the_json(talbot, page):
    result = json.loads(ep.solve(talbot).to_json())
    shown = parsed(page).numbers
    for key, value in shown.items():
        assert value == value_in(result, key), key
    for part in ("losses", "members", "fluid", "planet_bearing"):
        missing = [
            key for key in result[part] if not any(f"{part}.{key}" in one for one in shown)
            and key not in result["not_included"]
        ]  # fmt: skip
        assert missing == []
    for mesh, figures in result["meshes"].items():
        known = {key for key, figure in figures.items() if figure["value"] is not None}
        assert known == {key.split(".")[2] for key in shown if key.startswith(f"meshes.{mesh}.")}


def test_all_numbers_of_a_map_are_those_of_the_map(pair_map, map_page):
    shown = parsed(map_page).numbers
    dims = ("speed", "torque", "temperature")
    for key, value in shown.items():
        name, place = key[:-1].split("[")
        at = dict(zip(dims, map(int, place.split(",")), strict=True))
        assert value == float(pair_map[name].isel(at)), key
    efficiencies = int(pair_map["efficiency"].notnull().sum())
    assert len(shown) == pair_map["total"].size + efficiencies


def test_warnings_sources_and_inputs_are_complete(talbot, page):
    solved = ep.solve(talbot)
    result = json.loads(solved.to_json())
    text = html.unescape(page)
    for flag in result["validity"]:
        assert flag["quantity"] in text
        assert flag["source"] in text
    for source in result["sources"]:
        assert source in text
    notes = [one for one in all_warnings(solved) if not one.startswith("Out of range")]
    assert all(note in text for note in notes)
    for value in ("139.23 mm", "13.124 deg", "90 °C", "0.4 µm", "29.77 mm²/s at 40 °C"):
        assert value in text, value
    # the given tip diameter and the default crown
    assert '<td class="default">3 µm</td>' in text
    assert "<td>139.23 mm</td>" in text


@pytest.mark.slow
def test_text_of_the_user_stays_text():
    title = "<script>alert(1)</script> $x_1^ & </title> {{ 7 * 7 }}"
    case = ep.load_case("talbot-2012-pair").updated(
        {"title": title, "losses.mesh_pocketing.include": False}
    )
    page = ep.report_html(ep.record(case))
    assert "<script>alert" not in page
    assert html.escape(title, quote=False) in page
    assert parsed(page).open == []


@pytest.mark.slow
def test_figures_to_explore_have_the_data_of_the_still_ones(talbot_record, pair_map, page):
    within = r"(?:(?!</figure>).)*?"  # a drawing, which has no plot, takes none of the next one
    plots = dict(
        re.findall(rf'<figure id="figure-([^"]+)">{within}class="plot">(.*?)</script>', page, re.S)
    )
    losses = json.loads(plots["losses-1"])["data"]
    shown = {
        label.replace(" ", "_"): watts
        for trace in losses
        for label, watts in zip(trace["customdata"], trace["x"], strict=True)
    }
    lost = {name: watts for name, watts in talbot_record.result.losses.items() if watts}
    assert shown == pytest.approx(lost, rel=1e-6)
    trace = json.loads(plots["line-load-1"])["data"][0]
    highest = float(talbot_record.group("meshes")["sun_mesh"]["line_load"].max())
    assert trace["zmax"] == pytest.approx(highest)
    assert "line load, N/mm: %{z" in trace["hovertemplate"]
    (drawing,) = draw(pair_map, "loss-map")[:1]
    field = drawing.plot["data"][0]
    point = map_at(pair_map, temperature=40.0)
    assert field["x"] == point["speed"].to_numpy().tolist()
    assert field["y"] == point["torque"].to_numpy().tolist()
    assert np.array(field["z"]) == pytest.approx(
        point["total"].transpose("torque", "speed").to_numpy(), rel=1e-6
    )
    assert draw(talbot_record, "gear-set")[0].plot is None  # a drawing


@pytest.mark.usefixtures("map_page")
def test_progress_is_told(told):
    assert told == [(number, 7) for number in range(7)]


@pytest.mark.slow
def test_figures_have_the_size_that_is_asked_for(pair_map, map_page):
    wide = ep.report_html(pair_map, size=(150, 50))
    boxes = [re.findall(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', page) for page in (map_page, wide)]
    assert len(boxes[0]) == len(boxes[1]) > 3
    proportions = {round(float(width) / float(height), 2) for width, height in boxes[1]}
    assert max(proportions) > 2.5
    assert all(float(w) / float(h) < 2 for w, h in boxes[0])


def test_a_report_prints_as_pdf(map_page):
    pytest.importorskip("weasyprint", reason="optional")
    from epicyclic.show.html import page_bytes

    pdf = page_bytes(map_page, ".pdf")
    assert pdf.startswith(b"%PDF")
    assert pdf.rstrip().endswith(b"%%EOF")


def keys_shown(page):
    """Keys in the tables of the inputs."""
    inputs = page.partition('<section id="inputs"')[2].partition("</section>")[0]
    return set(re.findall(r"<tr><td>([^<]+)</td>", inputs))


def test_defaults_without_effect_are_left_out(page):
    shown = keys_shown(page)
    assert {"oil beyond range", "pocket void pressure", "friction"} <= shown  # of mixed-ehl
    assert not {"constant friction", "fitted form", "asperity film", "bath share"} & shown


@pytest.mark.slow
def test_given_keys_are_shown_even_without_effect():
    case = ep.load_case("talbot-2012-pair").updated(
        {"losses.mesh_pocketing.include": False, "models.friction": "schlenk"}
    )
    given = case.updated({"models.fluid_friction": 0.013, "thermal.bath_share": 0.17})
    left_out = keys_shown(ep.report_html(ep.record(case)))
    shown = keys_shown(ep.report_html(ep.record(given)))
    assert shown - left_out == {"fluid friction", "bath share"}
