"""Tables, report, plots and files of trains."""

from __future__ import annotations

import io
import json
import math
import re
from itertools import combinations, product

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text
from rich.console import Console

import epicyclic as ep
import listed_trains
from epicyclic.errors import InputError
from epicyclic.show.data_sheet import state_tables
from epicyclic.show.details import friction_table, result_tables
from epicyclic.show.inputs import input_tables
from epicyclic.show.page import Row, Table
from epicyclic.show.plots.catalogue import available, figure_of
from epicyclic.show.plots.power_flow import SLIDE
from epicyclic.show.record import growing_record
from epicyclic.show.result_page import result_section
from epicyclic.show.template import case_template
from trains import one_set, plus, published, simple, small_axle, turned_round

GEARS = "235R"
"""One with brakes only, one with a locked set, one with all sets at work, one with a loop."""


@pytest.fixture(scope="module")
def axle():
    return ep.record(small_axle())


@pytest.fixture(scope="module")
def gearbox():
    return ep.record(ep.load_case("train-8hp70").updated({"operation.state": "R"}))


@pytest.fixture(scope="module")
def wolfrom():
    return ep.record(ep.load_case(published("wolfrom")))


def printed(renderable):
    console = Console(width=100, record=True, file=io.StringIO(), highlight=False)
    console.print(renderable)
    return console.export_text()


# --- tables ---------------------------------------------------------------------------------------


def test_tables_of_an_axle_tell_everything_and_fit():
    result = ep.solve(small_axle())
    text = printed(result_tables(result))
    assert "…" not in text
    assert "ratio -7.8996 " in text
    assert f"efficiency {100 * result.efficiency:.3f} %" in text
    for title in ("Losses in W", "Shafts", "Rolling power", "Meshes of pair", "Meshes of planets",
                  "Planet bearings", "Shaft bearings", "Seals", "Oil"):  # fmt: skip
        assert f"\n{title}" in text
    assert "radial, N" in text
    assert "lip, m/s" in text
    row = next(line.split() for line in text.splitlines() if line.startswith("total"))
    assert float(row[-5]) == pytest.approx(result.total, abs=0.06)
    assert "nan" not in text


def test_tables_of_given_efficiencies_have_no_blanks():
    result = ep.solve(ep.load_case("train-8hp70").updated({"operation.state": "R"}))
    text = printed(result_tables(result))
    for title in ("Meshes of", "Planet bearings", "Oil", "Single losses", "Shaft bearings"):
        assert title not in text
    assert "state R, input to output" in text
    assert "ratio -3.2968 " in text
    assert "efficiency 94.596 %" in text
    assert "Closed clutches" in text
    assert "P1: sun mesh, ring mesh" in text.split("Methods")[1]
    sentence = re.search(r"Power circulates: (.*?) as much", text, re.DOTALL)
    assert sentence
    assert "P3: sun mesh" in sentence[1]
    assert "1.19 times" in sentence[1]


def test_self_locking_is_said_at_the_top():
    train = turned_round(plus(99, 100, 101, 100, "B", ("carrier", "A"), 0.99))
    text = printed(result_tables(ep.solve(ep.load_case(train))))
    assert "Self-locking: out cannot drive in" in text.partition("Losses")[0]


def test_a_train_that_is_jammed_is_said_to_stand_still():
    gears = {
        "sun": {"teeth": 57},
        "ring": {"teeth": 78, "internal": True},
        "second_ring": {"teeth": 103, "internal": True},
        "wide": {"teeth": 23, "body": "planet"},
        "narrow": {"teeth": 38, "body": "planet"},
    }
    meshes = [["sun", "wide"], ["narrow", "ring"], ["wide", "second_ring"]]
    train = one_set(gears, meshes, "second_ring", ("carrier", "ring"), 0.46, planets=1)
    train["operation"]["torque"] = "-30 N*m"
    result = ep.solve(ep.load_case(train))
    told = result.to_dict()
    assert told["jammed"]
    assert told["self_locking"]
    text = printed(result_tables(result)).partition("Losses")[0]
    assert "cannot turn the train, which stands still" in text
    assert "must be driven too" not in text


def test_a_train_without_circulation_has_no_sentence_on_it():
    train = ep.load_case(simple(23, 85, "ring", ("sun", "carrier")))
    assert "circulates" not in printed(result_tables(ep.solve(train)))


def test_the_states_of_a_gearbox_are_a_table_of_ratios_and_steps():
    text = printed(state_tables(ep.load_case("train-8hp70")))
    rows = {line.split()[0]: line for line in text.split("Ratio:")[1].splitlines() if line.strip()}
    assert rows["1"].split()[:2] == ["1", "4.6957"]
    assert rows["2"].split()[:3] == ["2", "3.1304", "1.5"]
    assert rows["R"].split()[1:3] == ["-3.2968", "suns,"]  # no step to another sense of rotation
    assert "housing, at rest" in printed(state_tables(small_axle()))


@pytest.mark.slow
def test_friction_of_all_sets_is_compared():
    from epicyclic.study.friction import compare_friction

    rows = compare_friction(small_axle(**{"models.preset": "talbot-2012"}))
    assert [row.name for row in rows if row.chosen] == ["fitted-or-schlenk"]
    own = next(row for row in rows if row.chosen)
    assert set(own.mean_friction) == {"pair.mesh", "planets.sun_mesh", "planets.ring_mesh"}
    mixed = compare_friction(
        small_axle(
            **{
                "models.preset": "talbot-2012",
                "sets.pair.models.preset": "talbot-2012",
                "sets.pair.models.friction": "doleschel",
                "sets.pair.models.mesh": "local",
            }
        )
    )
    assert not any(row.chosen for row in mixed)
    fitted = next(row for row in mixed if row.name == "fitted-or-schlenk")
    assert fitted.sliding == pytest.approx(own.sliding)
    assert "planets" in printed(friction_table(mixed))


@pytest.mark.parametrize(
    "ask", [ep.mesh_details, ep.pocket_details, ep.loaded_meshes, ep.mesh_contacts]
)
def test_given_efficiencies_have_no_teeth_to_look_at(ask):
    with pytest.raises(InputError) as caught:
        ask(ep.load_case("train-8hp70"))
    (problem,) = caught.value.problems
    assert problem.key == "sets"
    assert "given efficiencies only" in str(problem)


def test_the_template_of_a_train_is_a_sound_case():
    import tomllib

    text = case_template("train")
    assert ep.load_case(tomllib.loads(text)).kind == "train"
    extra = text.partition("# [drags.pump]")[2].partition("# [housing]")[0]
    drag = "[drags.pump]" + extra.replace("\n# ", "\n")
    assert tomllib.loads(drag)["drags"]["pump"]["between"] == ["motor", "housing"]
    assert ep.load_case(tomllib.loads(text + "\n" + drag))


# --- records and pages ----------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("name", ["axle", "gearbox", "wolfrom"])
def test_a_stored_train_reads_back_as_it_was(name, request, tmp_path):
    stored = request.getfixturevalue(name)
    ep.save_result(stored, tmp_path / "train.nc")
    back = ep.open_result(tmp_path / "train.nc")
    assert back.result.to_json() == stored.result.to_json()
    assert back.fields.keys() == stored.fields.keys()
    if not stored.fields:  # that of others takes its time
        assert ep.report_html(back) == ep.report_html(stored)


def test_fields_of_a_train_are_named_with_their_set(axle, gearbox):
    assert set(axle.group("meshes")) == {"pair.mesh", "planets.sun_mesh", "planets.ring_mesh"}
    assert set(axle.group("bearings")) == {"planets.planet_bearing"}
    assert set(axle.group("gears")) == {
        "pair.pinion", "pair.gear", "planets.sun", "planets.planet", "planets.ring",
    }  # fmt: skip
    assert not axle.group("pockets")  # left out
    assert not gearbox.fields


def test_a_stored_train_with_unknown_shafts_is_refused(gearbox):
    from epicyclic.result.stored import read_result

    content = json.loads(gearbox.result.to_json())
    content["clutches"] = {"input+nowhere": 1.0}
    assert read_result(content)[1] == [("", "members lacks nowhere")]


def test_figures_of_a_part_of_no_known_kind_are_refused(axle):
    from epicyclic.result.stored import read_result

    content = json.loads(axle.result.to_json())
    (key, part), *_ = content["parts"].items()
    content["parts"][key] = {f"other_{name}": value for name, value in part.items()}
    assert read_result(content)[1] == [
        (f"parts.{key}", "has none of the figures that are known here")
    ]


@pytest.mark.slow
def test_the_page_of_a_train_has_its_chapters(axle, gearbox):
    page = ep.report_html(axle)
    for title in ("Shafts", "Meshes of planets", "Gears of pair", "Shaft bearings", "Seals",
                  "planets: Gears"):  # fmt: skip
        assert f"<caption>{title}</caption>" in page
    assert 'data-key="stages.planets"' in page
    assert "sets.planets.models.friction" in page
    assert page.count('id="figure-power-flow-1"') == 1
    given = ep.report_html(gearbox)
    for chapter in ("gears", "load", "friction", "bearing", "pockets", "oil"):
        assert f'<section id="{chapter}">' not in given
    assert "Power circulates" in given
    assert "<caption>Numerics</caption>" not in given  # of no effect


def test_only_plots_that_make_sense_are_offered(axle, gearbox):
    assert list(available(gearbox)) == ["losses", "loss-sum", "power-flow"]
    assert {"gear-set", "teeth", "roller-loads", "line-load"} <= set(available(axle))
    assert not {"pocket-pressure", "loss-map"} & set(available(axle))


# --- power flow -----------------------------------------------------------------------------------


def drawn(record):
    figure = figure_of(record, "power-flow")
    FigureCanvasAgg(figure).draw()
    return figure


def texts(figure):
    return [text for text in figure.axes[0].texts if text.get_text()]


def records_of_all_gears():
    for gear in GEARS:
        yield gear, ep.record(ep.load_case("train-8hp70").updated({"operation.state": gear}))


@pytest.mark.slow
def test_the_power_flow_is_a_slide_without_overlapping_words(axle, wolfrom):
    records = dict(records_of_all_gears()) | {"axle": axle, "wolfrom": wolfrom}
    for name, record in records.items():
        figure = drawn(record)
        assert tuple(figure.get_size_inches()) == SLIDE
        inside = figure.bbox
        boxes = [(text.get_text(), text.get_window_extent()) for text in texts(figure)]
        for words, box in boxes:
            assert inside.x0 <= box.x0, (name, words)
            assert box.x1 <= inside.x1, (name, words)
        for (one, first), (two, second) in combinations(boxes, 2):
            small = first.expanded(0.9, 0.8).overlaps(second.expanded(0.9, 0.8))
            assert not small, (name, one, two)


@pytest.mark.slow
def test_words_on_cards_stand_beside_the_bars(axle, wolfrom, gearbox):
    many = ep.record(ep.load_case(listed_trains.ravigneaux()), groups=())
    for record in (axle, wolfrom, gearbox, many):
        figure = drawn(record)
        bars = [patch for patch in figure.axes[0].patches if patch.get_alpha() is not None]
        assert bars
        assert all(text.get_fontsize() > 8 for text in texts(figure))  # to be read on a slide
        for text, bar in product(texts(figure), bars):
            assert not text.get_window_extent().overlaps(bar.get_window_extent()), text.get_text()


@pytest.mark.slow
def test_titles_end_before_the_labels_of_scales():
    record = ep.record(ep.load_case("train-eaxle"), groups=["pockets"])
    figure = figure_of(record, "pocket-pressure")
    figure.draw_without_rendering()
    titles = [
        text
        for ax in figure.axes
        for text in ax.get_children()
        if isinstance(text, Text) and text.get_text()
    ]
    assert len(titles) == 6
    for title, ax in product(titles, figure.axes):
        label = ax.yaxis.label.get_window_extent()
        assert not title.get_window_extent().overlaps(label), title.get_text()


def test_the_power_flow_shows_shafts_members_and_brakes(gearbox):
    words = [text.get_text() for text in texts(drawn(gearbox))]
    for expected in ("input", "output + P3.carrier", "clutch 511.8 N·m", "62.8 kW", "32.5 kW",
                     "sun, suns", "ring, first", "circulating power"):  # fmt: skip
        assert expected in words
    assert any("without power: P1" in text for text in words)
    assert any(text.startswith("-606.7 rpm, 1447") for text in words)


def test_arrows_are_as_wide_as_the_power(gearbox):
    from epicyclic.show.plots.power_flow import CIRCULATING, THROUGH

    patches = drawn(gearbox).axes[0].patches
    arrows = {}
    for colour in (THROUGH, CIRCULATING):
        arrows[colour] = sorted(
            abs(patch.get_xy()[0][1] - patch.get_xy()[-2][1])
            for patch in patches
            if type(patch).__name__ == "Polygon" and _hex(patch) == colour and _lies(patch)
        )
    # from narrow to wide: 59.4, 60.9, 62.4, 62.8 kW through; 32.5 kW twice around
    assert len(arrows[CIRCULATING]) == 2
    assert arrows[CIRCULATING][0] == pytest.approx(arrows[CIRCULATING][1])
    scale = arrows[THROUGH][-1] / gearbox.result.input_power
    assert arrows[CIRCULATING][0] == pytest.approx(32515 * scale, rel=1e-3)
    assert arrows[THROUGH][0] == pytest.approx(
        (gearbox.result.input_power - 3396) * scale, rel=1e-3
    )


def _hex(patch):
    from matplotlib.colors import to_hex

    return to_hex(patch.get_facecolor()).upper()


def _lies(patch):
    """True for arrows along shafts, whose tail is upright."""
    corners = patch.get_xy()
    return len(corners) == 8 and math.isclose(corners[0][0], corners[-2][0])


def test_a_single_set_has_a_power_flow_too():
    record = ep.record(
        ep.load_case("talbot-2012-pair").updated(
            {"operation.torque": "100 N*m", "losses.mesh_pocketing.include": False}
        )
    )
    words = [text.get_text() for text in texts(drawn(record))]
    assert {"gear pair", "pinion", "gear"} <= set(words)


def test_inputs_of_a_listed_set_stand_side_by_side_as_the_schema_has_them():
    case = ep.load_case(listed_trains.ravigneaux())
    inputs = ep.solve(case).inputs
    found = input_tables(inputs, case.given())
    tables = {(table.title, table.head[1:-1]): table for table in found}
    front, rear = ("small sun", "large sun", "short"), ("long front", "long rear", "ring")
    assert {("S: Gears", front), ("S: Gears", rear)} <= tables.keys()
    rows = {row[0].text: [cell.text for cell in row[1:-1]] for row in tables["S: Gears", rear].rows}
    assert rows["teeth"] == ["19", "19", "76"]
    assert rows["face width"] == ["25 mm", "22 mm", "27 mm"]
    assert rows["roughness"] == ["0.4 µm"] * 3  # its unit as units are written
    assert rows["body"] == ["long", "long", ""]
    assert all(cell.about == "" for cell in tables["S: Gears", rear].rows[0][1:-1])
    meanings = {row[0].text: row[-1].text for row in tables["S: Gears", rear].rows}
    assert meanings["body"].startswith("Gears with the same body")
    shared = {row[0].text for row in tables["S: All gears", ("value",)].rows}
    assert "helix angle" in shared
    assert not any("sun" in key for key in shared)
    meshes = next(table for (title, _), table in tables.items() if title == "S: Mesh")
    assert meshes.head[1:-1] == ("small sun-short", "short-long front", "large sun-long rear")
    pairs = next(row for row in tables["S", ("value",)].rows if row[0].text == "meshes")
    assert pairs[1].text.startswith("small_sun, short; short, long_front; ")


def test_the_table_of_many_gears_is_not_beside_a_picture():
    """Six columns in half a page left one letter a line for the words."""
    many = growing_record(ep.load_case(listed_trains.ravigneaux()))
    few = growing_record(ep.load_case("talbot-2012"))
    below, beside = (result_section(one, {}, "gears").items for one in (many, few))
    assert [type(item) for item in below] == [Table]
    assert below[0].head[1:-1] == (
        "small sun", "large sun", "short", "long front", "long rear", "ring"
    )  # fmt: skip
    assert type(beside[0]) is Row
