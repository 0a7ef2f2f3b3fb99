"""The app as a person sees it, in headless Chromium: pytest -m slow. Needs playwright, chromium."""

from __future__ import annotations

import itertools
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

import epicyclic as ep
from epicyclic.plugins.design.search import case_text

pytest.importorskip("nicegui", reason="optional")
playwright = pytest.importorskip("playwright.sync_api", reason="optional")
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium"),
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
]

SOLVED = 180_000
"""Longest time of a solve that may have to compile first. [ms]"""
PAGE_SECONDS, TURN_MS, SOLVE_MS = 3.0, 100.0, 300.0
"""What a person is to wait at most for: the page, gears that turn, losses that follow."""


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as play:
        chromium = play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield chromium
        chromium.close()


@pytest.fixture
def open_app(browser, tmp_path):
    """Start the app with a case and open its page."""
    started = []

    def start(case: str):
        command = [sys.executable, "-m", "epicyclic", "app", case, "--no-browser"]
        process = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True)
        page = browser.new_context(viewport={"width": 1500, "height": 1000}).new_page()
        page.asked, page.wrong, page.process = [], [], process.pid
        page.on("request", lambda request: page.asked.append(request.url))
        page.on("websocket", lambda socket: page.asked.append(socket.url))
        page.on("pageerror", lambda error: page.wrong.append(str(error)))
        page.on("console", lambda said: said.type == "error" and page.wrong.append(said.text))
        started.append((process, page))
        page.address = re.search(r"http\S+", process.stdout.readline())[0]
        return page

    yield start
    for process, page in started:
        page.context.close()
        process.send_signal(signal.SIGTERM)
        process.wait(60)  # beside other tests
        process.stdout.close()


def _solved(page) -> None:
    page.goto(page.address)
    page.wait_for_selector(".key-figure", timeout=SOLVED)


def _busy() -> float:
    """How much longer work takes because others have their share of the cores."""
    return max(1.0, os.getloadavg()[0] / os.cpu_count())


GROUPS = {"Gears": "Parts", "Planet bearing": "Parts", "Map": "Studies", "Compare": "Studies",
          "Designs": "Studies"}  # fmt: skip


def _tab(page, name: str) -> None:
    """Open a chapter: its group, then its tab."""
    page.get_by_role("tab", name=GROUPS.get(name, "Trust"), exact=True).click(timeout=SOLVED)
    page.get_by_role("tab", name=name, exact=True).click(timeout=SOLVED)


def _watts(page) -> float:
    figure = page.locator(".results > div > .key-figures .key-figure", has_text="total loss")
    return float(figure.locator(".value > *").first.inner_text())


def _until(holds) -> None:
    """Wait for what follows from a solve."""
    end = time.monotonic() + SOLVED / 1000
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_nothing_comes_from_elsewhere_and_the_page_is_soon_there(open_app):
    page = open_app("talbot-2012")
    _solved(page)
    before = time.perf_counter()
    page.goto(page.address)
    page.wait_for_selector("aside .group")
    seconds = time.perf_counter() - before
    print(f"first page: {seconds:.2f} s, {_busy():.1f} times as much work as cores")
    assert seconds < PAGE_SECONDS * _busy()
    page.wait_for_selector("figure svg", timeout=SOLVED)
    own = page.address.split("//")[1].split("/")[0]
    assert any(url.startswith("ws://") for url in page.asked)
    assert {url.split("//")[1].split("/")[0] for url in page.asked if "//" in url} == {own}
    assert "token" not in page.url
    assert not page.wrong


def test_a_chart_that_is_gone_need_not_be_resized(open_app):
    page = open_app("talbot-2012")
    page.goto(page.address)
    page.wait_for_selector("aside .group")
    resize = "({Plotly}) => { Plotly.Plots.resize(document.createElement('div')); }"
    page.evaluate(f"import('nicegui-plotly').then({resize})")
    page.wait_for_timeout(500)
    assert not page.wrong


def test_a_stranger_gets_no_page(open_app, browser):
    page = open_app("talbot-2012-pair")
    stranger = browser.new_context().new_page()
    answer = stranger.goto(page.address.split("?")[0])
    assert answer.status == 403
    assert "token" in answer.text()
    stranger.close()


def test_a_wrong_value_has_its_message_beside_it(open_app):
    page = open_app("talbot-2012")
    _solved(page)
    field = page.get_by_label("torque", exact=True)
    field.fill("3 kg")
    field.press("Enter")
    shown = page.locator(".field", has=field).get_by_role("alert")
    shown.wait_for()
    assert "measures something else" in shown.inner_text()
    assert page.locator(".stale").count() == 1
    before = _watts(page)
    field.fill("500")
    field.press("Enter")
    page.wait_for_function("!document.querySelector('.stale')")
    _until(lambda: 0 < _watts(page) < before)
    page.get_by_role("button", name="Command").click()
    page.locator(".command", has_text="operation.torque=500 N*m").wait_for()
    assert not page.wrong


@pytest.mark.parametrize("case", ["talbot-2012", "train-eaxle"])
def test_gears_turn_in_mesh_with_a_slider(open_app, case):
    page = open_app(case)
    _solved(page)
    _tab(page, "Gears")
    page.wait_for_function(
        "turning.drawings.size > 1 && "
        "turning.drawings.size == document.querySelectorAll('.turned figure').length",
        timeout=SOLVED,
    )
    drawn = page.evaluate("[...turning.drawings.values()].map((one) => one.layers.length)")
    assert min(drawn) == 2
    slider = page.locator(".turner .q-slider").bounding_box()
    page.mouse.click(slider["x"] + 0.4 * slider["width"], slider["y"] + slider["height"] / 2)
    turned = page.evaluate(
        """() => [...turning.drawings.values()].map((one) => [
            one.layers.map((layer) => layer.element.getAttribute("transform")),
            one.positions.map((parts) => [...parts].some((part) => part.style.display != "none")),
        ])"""
    )
    for transforms, shown in turned:
        assert all(re.match(r"rotate\(-?\d", text) for text in transforms)
        assert sum(shown) == bool(shown)
    median = page.evaluate(
        """async () => {
            const times = [];
            for (let number = 0; number < 31; number++) {
                const start = performance.now();
                turning.turn(0.137 * number);
                await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
                times.push(performance.now() - start);
            }
            return times.sort((one, other) => one - other)[15];
        }"""
    )
    print(f"slider to gears: {median:.0f} ms")
    assert median < TURN_MS
    assert not page.wrong


def test_losses_follow_the_slider_of_an_input(open_app):
    page = open_app("talbot-2012")
    _solved(page)
    page.wait_for_selector("figure svg", timeout=SOLVED)
    before = _watts(page)
    times = []
    with _moving(page, "torque") as move:
        for step in range(12):
            watts = _watts(page)
            start = time.perf_counter()
            move(0.5 + 0.03 * (step + 1))
            _until(lambda watts=watts: _watts(page) != watts)
            times.append(1e3 * (time.perf_counter() - start))
            time.sleep(0.5)
    assert _watts(page) > before
    median = sorted(times)[len(times) // 2]
    print(f"slider to losses: {median:.0f} ms, {_busy():.1f} times as much work as cores")
    assert median < SOLVE_MS * _busy()
    assert not page.wrong


@contextmanager
def _moving(page, key: str):
    """The slider of an input, which is let go at the end; call it with a share of its length."""
    holder = page.locator(".holder", has=page.get_by_label(key, exact=True))
    holder.get_by_role("button").click()
    holder.locator(".q-slider").wait_for()
    box = holder.locator(".q-slider").bounding_box()
    y = box["y"] + box["height"] / 2

    def move(share: float) -> None:
        page.mouse.move(box["x"] + share * box["width"], y)

    move(0.5)
    page.mouse.down()
    yield move
    page.mouse.up()


@pytest.mark.parametrize(
    ("chapter", "panels"), [("Planet bearing", 2), ("Uncertainty of this result", 3)]
)
def test_every_picture_follows_a_slider_that_never_stands_still(open_app, chapter, panels):
    page = open_app("talbot-2012")
    _solved(page)
    _tab(page, chapter)
    pictures = page.locator(".chapter figure .still")
    page.wait_for_function(
        f"document.querySelectorAll('.chapter figure .still:has(svg)').length == {panels}",
        timeout=SOLVED,
    )
    before = [pictures.nth(number).inner_html() for number in range(panels)]
    seen = [{text} for text in before]
    was_behind = False
    end = time.monotonic() + SOLVED / 1000
    with _moving(page, "torque") as move:
        for step in itertools.count():
            move(0.5 + 0.3 * abs(step % 60 - 30) / 30)
            time.sleep(0.05)
            was_behind = was_behind or page.locator("figure.behind .computing").count() > 0
            if step % 10 == 0:
                for number, known in enumerate(seen):
                    known.add(pictures.nth(number).inner_html())
            if min(map(len, seen)) >= 3:
                break
            assert time.monotonic() < end
    assert was_behind
    page.wait_for_function(
        "!document.querySelector('.behind') && document.querySelector('.state.idle')",
        timeout=SOLVED,
    )
    at_rest = f"{float(page.get_by_label('torque', exact=True).input_value()):g} N"
    assert at_rest in page.locator(".chapter").inner_html()
    assert not page.wrong


def test_tabs_have_cases_of_their_own_and_the_work_of_a_closed_one_ends(open_app):
    page = open_app("talbot-2012-pair")
    _solved(page)
    alone = _processes(page)
    other = page.context.new_page()
    other.goto(page.address)
    other.wait_for_selector(".key-figure", timeout=SOLVED)
    field = other.get_by_label("torque", exact=True)
    field.fill("137")
    field.press("Enter")
    other.get_by_role("button", name="Command").click()
    other.locator(".command", has_text="operation.torque=137 N*m").wait_for()
    assert page.get_by_label("torque", exact=True).input_value() != "137"
    other.reload()
    other.wait_for_selector(".key-figure", timeout=SOLVED)
    assert other.get_by_label("torque", exact=True).input_value() == "137"
    _until(lambda: _processes(page) == 2 * alone)
    other.close()
    _until(lambda: _processes(page) == alone)
    assert not page.wrong


def _processes(page) -> int:
    """Processes that work for the app."""
    found = Path(f"/proc/{page.process}/task/{page.process}/children").read_text().split()
    told = [Path(f"/proc/{child}/cmdline").read_text() for child in found]
    return sum("spawn_main" in text for text in told)


def test_names_are_added_renamed_and_removed_in_the_form(open_app):
    page = open_app("train-eaxle")
    _solved(page)
    page.locator("aside").get_by_text("Bearings", exact=True).click()
    page.get_by_role("button", name="Add to bearings").click()
    page.locator(".q-dialog").get_by_label("name").fill("N1")
    page.locator(".q-dialog").get_by_role("button", name="OK").click()
    page.locator(".problems", has_text="bearings.N1.type").wait_for()
    shown = page.locator(".field", has=page.get_by_label("bore", exact=True)).last
    assert "is missing" in shown.get_by_role("alert").inner_text()
    page.get_by_role("button", name="Rename").last.click()
    name = page.locator(".q-dialog").get_by_label("name")
    name.fill('N"2')
    page.locator(".q-dialog").get_by_role("button", name="OK").click()
    page.locator(".q-dialog", has_text="no quotation marks").wait_for()
    name.fill("N2")
    page.locator(".q-dialog").get_by_role("button", name="OK").click()
    page.locator(".problems", has_text="bearings.N2.type").wait_for()
    page.get_by_role("button", name="Remove").last.click()
    page.wait_for_function("!document.querySelector('.problems .problem')")
    page.wait_for_function("!document.querySelector('.stale')")
    assert not page.wrong


def test_a_map_is_computed_cancelled_and_saved(open_app):
    page = open_app("talbot-2012")
    _solved(page)
    _tab(page, "Map")
    page.locator(".values").get_by_label("speed").fill("0:8000:3 rpm")
    torque = page.locator(".values").get_by_label("torque")
    torque.fill("0:2000:900 N*m")
    page.get_by_role("button", name="Compute").click()
    page.get_by_text(re.compile(r"points of the map: \d+ of \d\d\d\d")).wait_for(timeout=SOLVED)
    page.locator(".results .chapter").get_by_role("button", name="Cancel").click()
    page.get_by_text("Stopped before it was finished.").wait_for()
    torque.fill("100:2000:3 N*m")
    page.get_by_role("button", name="Compute").click()
    page.locator(".chapter figure svg").first.wait_for(timeout=SOLVED)
    assert "--speed '0:8000:3 rpm'" in page.locator(".chapter code").first.inner_text()
    with page.expect_download(timeout=SOLVED) as loaded:
        page.locator(".chapter .formats").first.get_by_text("pdf").click()
    assert loaded.value.path().read_bytes().startswith(b"%PDF")
    temperature = page.get_by_label("oil inlet temperature", exact=True)
    temperature.fill("60")
    temperature.press("Enter")  # the map follows the case
    page.locator(".chapter code", has_text="oil_inlet_temperature").wait_for(timeout=SOLVED)
    assert not page.wrong


def test_a_case_goes_out_and_comes_back(open_app, tmp_path):
    page = open_app("talbot-2012")
    _solved(page)
    field = page.get_by_label("speed", exact=True)
    field.fill("3100")
    field.press("Enter")
    page.get_by_role("button", name="Save").click()
    with page.expect_download() as loaded:
        page.locator(".q-menu").get_by_text("Case file").click()
    file = tmp_path / "mine.toml"
    loaded.value.save_as(file)
    assert 'speed = "3100 rpm"' in file.read_text()
    page.get_by_role("button", name="Open").click()
    page.locator("input[type=file]").set_input_files(file)
    page.wait_for_selector(".q-dialog", state="detached")
    assert page.get_by_label("speed", exact=True).input_value() == "3100"
    page.get_by_role("button", name="Command").click()
    page.locator(".command", has_text="epicyclic run mine.toml").wait_for()
    assert not page.wrong


def test_two_cases_stand_side_by_side(open_app):
    page = open_app("talbot-2012")
    _solved(page)
    _tab(page, "Compare")
    page.get_by_role("button", name="Keep the current case").click()
    field = page.get_by_label("speed", exact=True)
    field.fill("5000")
    field.press("Enter")
    row = page.locator("tr", has_text="operation.speed")
    row.wait_for(timeout=SOLVED)
    assert row.inner_text().split("\t") == ["operation.speed", "4000 rpm", "5000 rpm"]
    page.locator(".chapter figure .chart svg").first.wait_for(timeout=SOLVED)
    assert page.locator(".chapter figure .chart").count() == 1
    assert not page.wrong


def test_on_a_phone_results_come_first_and_the_form_takes_their_place(open_app):
    page = open_app("talbot-2012-pair")
    page.set_viewport_size({"width": 390, "height": 844})
    _solved(page)
    page.locator(".chapter table").first.wait_for(timeout=SOLVED)
    page.locator(".chapter figure .chart svg").first.wait_for(timeout=SOLVED)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert not page.locator("aside").is_visible()
    page.get_by_role("button", name="Inputs").click()
    page.get_by_label("torque", exact=True).wait_for()
    assert not page.locator(".results").is_visible()
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert not page.wrong


@pytest.mark.parametrize("width", [1440, 1024, 390])
def test_the_page_is_no_wider_than_its_window(open_app, width):
    page = open_app("train-eaxle")
    page.set_viewport_size({"width": width, "height": 900})
    _solved(page)
    page.locator(".key-figure .unit", has_text="times the input power").wait_for(timeout=SOLVED)
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_values_are_told_where_the_pointer_is_and_bands_stand_on_the_cards(open_app):
    page = open_app("talbot-2012-pair")
    _solved(page)
    page.locator(".key-figure .band", has_text="95 %").first.wait_for(timeout=SOLVED)
    bar = page.locator(".chapter figure .chart .bars path").first
    bar.wait_for(timeout=SOLVED)
    bar.hover(force=True)
    told = page.locator(".hoverlayer .hovertext").first
    told.wait_for()
    assert re.search(r"[a-z ]+: [\d.]+ W", told.text_content())
    assert not page.wrong


def test_what_is_shown_at_the_end_belongs_to_the_last_of_many_quick_inputs(open_app):
    page = open_app("talbot-2012")
    _solved(page)
    page.wait_for_selector(".state.idle", state="attached", timeout=SOLVED)
    field = page.get_by_label("torque", exact=True)
    cancel = page.locator(".results .state", has_text="Cancel").get_by_role("button").first

    def type_quickly(*values):
        for value in values:
            field.fill("")
            field.press_sequentially(str(value), delay=2)
            field.press("Enter")

    def at_rest():
        return (
            page.locator(".results > div > .state.idle").count() == 1
            and page.locator(".behind").count() == 0
            and abs(_watts(page) / wanted - 1) < 5e-3  # three digits are shown
        )

    def told():
        return page.locator(".results > .problem").locator("visible=true")

    case = ep.load_case("talbot-2012")
    for values in ((311, 977, 613), (431,)):
        type_quickly(*values, 1009)
        cancel.click(timeout=SOLVED)  # one is being solved, and others wait
        type_quickly(271, values[0])
        wanted = ep.solve(case.updated({"operation.torque": f"{values[0]} N*m"})).total
        _until(at_rest)
        page.wait_for_timeout(500)
        assert at_rest()
        assert told().count() == 0
    # also if nothing is typed after the cancel: what waits is solved, and nothing is said of it
    type_quickly(523, 1033, 719)
    cancel.click(timeout=SOLVED)
    wanted = ep.solve(case.updated({"operation.torque": "719 N*m"})).total
    _until(lambda: abs(_watts(page) / wanted - 1) < 5e-3)
    page.wait_for_selector(".results > div > .state.idle", state="attached", timeout=SOLVED)
    assert (page.locator(".behind").count() > 0) == (told().count() > 0)
    assert not page.wrong


def test_a_click_on_the_front_opens_the_design(open_app, tmp_path):
    """The search runs in the app; its chart is there again in the tab it was in."""
    task = {
        "title": "a small task",
        "ratio": 2.3,
        "operation": {"torque": "37 N*m", "speed": "1900 rpm", "oil_inlet_temperature": "61 degC"},
        "choices": {
            "arrangements": ["pair"],
            "module": ["1.5 mm", "1.75 mm"],
            "pinion_teeth": [21, 23],
            "profile_shift": [0.2],
            "width_ratio": [0.7],
        },
        "limits": {"pitting": 0.3, "bending": 0.4},
        "search": {"solved": 6, "polished": 0},
        "case": {
            "lubricant": {"oil": "iso-vg-100-mineral"},
            "numerics": {"mesh_positions": 6, "contact_segments": 6},
        },
    }
    (tmp_path / "task.toml").write_text(case_text(task))
    page = open_app("talbot-2012")
    _solved(page)
    _tab(page, "Designs")
    page.locator(".results input[type=file]").set_input_files(tmp_path / "task.toml")
    points = page.locator(".results .js-plotly-plot .points path.point")
    points.last.wait_for(timeout=SOLVED)
    box = points.last.bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.wait_for_function(
        "document.querySelector('.bar .title').textContent.startsWith('a small task: pair ')"
    )
    page.get_by_label("torque", exact=True).wait_for()
    assert page.get_by_label("torque", exact=True).input_value() == "37"
    _tab(page, "Designs")
    points.last.wait_for(timeout=SOLVED)


def test_a_task_of_designs_that_names_files_is_refused(open_app, tmp_path):
    page = open_app("talbot-2012")
    _solved(page)
    _tab(page, "Designs")
    text = 'ratio = 3\n[case.models]\noil_model = "measured.toml"\n'
    (tmp_path / "task.toml").write_text(text)
    page.locator(".results input[type=file]").set_input_files(tmp_path / "task.toml")
    page.get_by_text("names a file, which the app does not open").wait_for()
