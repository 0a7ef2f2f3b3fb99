"""Keys of a sweep that change together, stand in a table, or follow from others."""

from __future__ import annotations

import json
import math
import pickle

import numpy as np
import pandas as pd
import pytest

import epicyclic as ep
from epicyclic.cli.common import parse_changes
from epicyclic.cli.main import main
from epicyclic.study.sweeps.axes import columns_of, parse_expression
from epicyclic.study.sweeps.run import (
    SweepPlan,
    make_plan,
    parse_links,
    parse_together,
    to_dataset,
    to_table,
)
from epicyclic.study.sweeps.runner import Row, Rows, fingerprint
from epicyclic.units import with_unit

CONSTANT = {
    "sun.teeth": "round(sun.teeth * case(gears.normal_module) / gears.normal_module)",
    "ring.teeth": "planet.count * round(sun.teeth * (1 + case(ring.teeth) / case(sun.teeth))"
    " / planet.count) - sun.teeth",
    "planet.teeth": "floor((ring.teeth - sun.teeth) / 2)",
}
"""The ratio and the centre distance as near to those of the case as whole teeth allow."""
LEFT_OUT = {
    f"{gear}.{key}": None
    for gear in ("sun", "planet", "ring")
    for key in ("tip_diameter", "root_diameter", "tooth_thickness", "thickness_diameter")
} | {"sun.profile_shift_coefficient": -0.02}


@pytest.fixture(scope="module")
def case():
    return ep.load_case("talbot-2012")


@pytest.fixture(scope="module")
def plan(case):
    modules = ["2.2 mm", "1.813 mm", "1.5 mm"]
    vary = {"gears.normal_module": modules, "operation.torque": ["300 N*m", "700 N*m"]}
    return make_plan(case.updated(LEFT_OUT), vary, links=CONSTANT)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2 * 3 + 4 ** 2 / 8 - 1", 7.0),
        ("-round(2.6) + floor(2.6) + ceil(2.2)", 2.0),
        ("max(sun.teeth, 40, 35) - min(sun.teeth, 40)", 9.0),
        ("abs(-3) + sqrt(16)", 7.0),
        ("cos(60 * deg) + sin(30 * deg) + tan(atan(2))", 3.0),
        ("gears.normal_module / (1 * mm)", 2.5),
        ("case(sun.teeth) - 'sun.teeth'", -6.0),
        ("2 * pi", 2 * math.pi),
    ],
)
def test_value_of_an_expression(text, value):
    at_point = {"sun.teeth": 31.0, "gears.normal_module": with_unit(2.5, "mm")}
    result = parse_expression(text).value(at_point.__getitem__, {"sun.teeth": 25.0}.__getitem__)
    assert float(getattr(result, "magnitude", result)) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('true')",
        "(lambda: 1)()",
        "[1, 2]",
        "sun.teeth if 1 else 2",
        "sun.teeth.__class__()",
        "eval('1')",
        "case(1 + 2)",
        "round()",
        "True",
        "1j",
        "1 //",
        "unitless_word * 2",
        "(" * 400,
        "1 + " * 200 + "1",
        "",
    ],
)
def test_other_expressions_are_refused(text):
    with pytest.raises(ValueError, match=r"[a-z]"):
        parse_expression(text)


@pytest.mark.parametrize("text", ["9 ** 9 ** 9", "(-2) ** 0.5", "1e308 * 10", "10 * degC + 1 * mm"])
def test_expressions_without_a_value(text):
    with pytest.raises((ArithmeticError, TypeError, ValueError)):
        parse_expression(text).value({}.__getitem__, {}.__getitem__)


def test_module_at_constant_ratio_and_centre_distance(plan):
    for index in range(plan.size):
        made = plan.case.updated(plan.changes(index))
        sun, planet, ring = made.sun.teeth, made.planet.teeth, made.ring.teeth
        assert (sun + ring) % made.planet.count == 0
        assert ring / sun == pytest.approx(125 / 73, rel=0.02)
        assert made.gears.center_distance == plan.case.gears.center_distance
        shift = made.sun.profile_shift_coefficient + made.planet.profile_shift_coefficient
        assert abs(shift) < 1.2
        module = made.gears.normal_module / math.cos(made.gears.helix_angle)
        assert module * (sun + planet) / 2 == pytest.approx(made.gears.center_distance, rel=0.02)
    teeth = [plan.changes(index)["sun.teeth"] for index in range(0, plan.size, 2)]
    assert teeth == [60, 73, 88]


def test_linked_keys_are_coordinates_of_what_they_follow(plan):
    data = to_dataset(plan, Rows(plan.size))
    assert data["sun.teeth"].dims == data.sun_teeth.dims == ("gears_normal_module",)
    assert list(data.sun_teeth.values) == [60, 73, 88]
    assert data.sun_teeth.attrs["case_key"] == "sun.teeth"
    assert json.loads(data.attrs["links"]) == CONSTANT
    table = to_table(data)
    assert list(table["ring.teeth"]) == [102, 102, 125, 125, 152, 152]
    assert "ring_teeth" not in table


def test_texts_of_a_dataset_are_those_of_the_rows(plan):
    """A map of ten thousand points has tens of megabytes of warnings."""
    rows = Rows(plan.size)
    rows.add(1, Row("converged", warnings="of point 1"))
    data = to_dataset(plan, rows)
    assert data["warnings"].values.ravel()[1] is rows.warnings[1]


def test_the_plan_of_a_journal_is_the_same(case, plan):
    kept = json.loads(json.dumps(plan.describe()))
    again = SweepPlan.again(kept, plan.case.source)
    assert fingerprint(again) == fingerprint(plan) == fingerprint(pickle.loads(pickle.dumps(plan)))
    assert [again.changes(i) for i in range(6)] == [plan.changes(i) for i in range(6)]
    groups = [{"planet.count": [3, 4], "sun.teeth": [73, 74]}]
    grouped = make_plan(case, together=groups, points={"title": ["a", "a"], "ring.teeth": [125, 9]})
    kept = json.loads(json.dumps(grouped.describe()))
    assert SweepPlan.again(kept, "").changes(3) == grouped.changes(3)
    plain = make_plan(case, {"planet.count": [3, 4]})
    assert set(plain.describe()) == {"case", "files", "axes"}
    assert "together" not in plain.describe()["axes"][0]


def test_keys_that_change_together_are_one_dimension(case):
    options = ["planet.count=5,3; operation.speed=900,700 rpm;", "sun_mesh.misalignment=2,9 um"]
    plan = make_plan(case, {"title": ["a", "b", "c"]}, together=parse_together(case, options))
    assert plan.shape == (3, 2, 2)
    assert plan.changes(3) == {
        "title": "a",
        "planet.count": 3,
        "operation.speed": "700 rpm",
        "sun_mesh.misalignment": "9 um",
    }
    data = to_dataset(plan, Rows(plan.size))
    assert data["total"].dims == ("title", "planet_count", "sun_mesh_misalignment_given")
    assert list(data.speed.values) == [900.0, 700.0]
    assert data.speed.dims == ("planet_count",)
    assert json.loads(data.attrs["together"]) == [["planet.count", "operation.speed"]]


def test_geometry_is_outermost_also_where_it_follows(case):
    vary = {"operation.speed": ["1 rpm", "2 rpm"], "planet.count": [3, 4], "title": ["a", "b"]}
    plain = make_plan(case, {key: vary[key] for key in ("operation.speed", "planet.count")})
    counts = [plain.changes(index)["planet.count"] for index in plain.order()]
    assert counts == [3, 3, 4, 4]
    follows = {"planet.face_width": "operation.speed / (1 * rpm) * mm"}
    plan = make_plan(case, vary, links=follows)
    speeds = [plan.changes(index)["operation.speed"] for index in plan.order()]
    assert speeds == ["1 rpm"] * 4 + ["2 rpm"] * 4


def test_points_of_one_state_follow_each_other():
    vary = {
        "operation.speed": ["30 rpm", "20 rpm"],
        "operation.state": ["8", "1", "R"],
        "operation.torque": ["5 N*m", "7 N*m"],
    }
    plan = make_plan(ep.load_case("train-8hp70"), vary)
    points = [tuple(plan.changes(index)[key] for key in sorted(vary)) for index in plan.order()]
    states = [state for _, state, _ in points]
    assert states == ["8"] * 4 + ["1"] * 4 + ["R"] * 4
    assert [torque for *_, torque in points[:4]] == ["5 N*m", "5 N*m", "7 N*m", "7 N*m"]


def test_table_of_points(case, tmp_path):
    file = tmp_path / "points.csv"
    file.write_text(
        "# three designs\ngears.normal_module [mm]; sun.teeth; operation.torque; title\n"
        "1.8; 73; 500 N*m; one\n1.8; 72; 650 N*m; two\n\n1.7; 75; 500 N*m; three\n"
    )
    plan = make_plan(case, {"planet.count": [3, 4]}, points=columns_of(file))
    assert plan.changes(5) == {
        "planet.count": 4,
        "gears.normal_module": "1.7 mm",
        "sun.teeth": 75,
        "operation.torque": "500 N*m",
        "title": "three",
    }
    data = to_dataset(plan, Rows(plan.size))
    assert data["total"].dims == ("planet_count", "row")
    assert list(data.row.values) == [1, 2, 3]
    assert list(data.gears_normal_module.values) == [1.8, 1.8, 1.7]
    frame = pd.DataFrame({"sun.teeth": [73, 74], "operation.torque [N*m]": [1.5, 2.5]})
    assert columns_of(frame) == {"sun.teeth": [73, 74], "operation.torque": ["1.5 N*m", "2.5 N*m"]}
    frame = pd.DataFrame({"losses.sun_drag.include": [True, False], "sun.roughness": ["a", "3 um"]})
    assert columns_of(frame) == frame.to_dict("list")


def test_the_operating_point_has_the_short_names_of_other_tables(case, tmp_path):
    file = tmp_path / "points.csv"
    file.write_text("n [1/min],Torque [N*m],oil temperature [degC],planet.count\n1300,700,47,5\n")
    assert columns_of(file) == {
        "operation.speed": ["1300 rpm"],
        "operation.torque": ["700 N*m"],
        "operation.oil_inlet_temperature": ["47 degC"],
        "planet.count": [5],
    }


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("sun.teeth\n", "no rows"),
        ("sun.teeth,planet.count\n73,3\n74\n", "2 columns, but line 3 has 1"),
        ("sun.teeth,planet.count\n73,3,4,5\n74,3\n", "2 columns, but line 2 has 4"),
        ("sun.teeth,sun.teeth\n1,2\n", "two columns"),
        ("sun.teeth [1],sun.teeth\n1,2\n", "two columns"),
        ("# two\nsun.teeth,planet.count\n73,3\n74,\n", "planet.count: has no value in line 4"),
    ],
)
def test_a_bad_table_is_told(tmp_path, content, words):
    file = tmp_path / "points.csv"
    file.write_text(content)
    with pytest.raises(ep.InputError, match=words):
        columns_of(file)


def test_a_table_with_more_columns_than_keys_is_told_at_once(case):
    """Each of its keys would be looked for among all others: 20 s."""
    points = {f"a.b{number}": ["1", "2"] for number in range(3000)}
    with pytest.raises(ep.InputError, match="names 3000 keys; a case of this kind has") as caught:
        make_plan(case, points=points)
    assert len(caught.value.problems) == 1


LENGTH = {"gears.normal_module": ["1.8 mm", "1.9 mm"]}


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"links": {"sun.teeth": "74"}}, "is empty"),
        ({"vary": LENGTH, "links": {"sun.teth": "1"}}, "not a known key"),
        ({"vary": LENGTH, "links": {"sun.teeth": "sun.teth"}}, "in the link of sun.teeth"),
        ({"vary": LENGTH, "links": {"gears.normal_module": "2 * mm"}}, "varied and linked"),
        ({"vary": LENGTH, "links": {"sun.teeth": "gears.normal_module"}}, "Cannot convert"),
        ({"vary": LENGTH, "links": {"sun.teeth": "73.4"}}, "use round"),
        ({"vary": LENGTH, "links": {"sun.face_width": "30"}}, "Cannot convert"),
        ({"vary": LENGTH, "links": {"sun.face_width": "1 * kg"}}, "Cannot convert"),
        ({"vary": LENGTH, "links": {"sun.face_width": "-1 * mm"}}, "out of range"),
        ({"vary": LENGTH, "links": {"sun.face_width": "1 * mm / 0"}}, "divides by zero"),
        ({"vary": LENGTH, "links": {"sun.face_width": "sun.teeth + 1 * mm"}}, "Cannot convert"),
        ({"vary": LENGTH, "links": {"lubricant.oil": "1"}}, "is not a number"),
        ({"vary": LENGTH, "links": {"sun.teeth": "case(sun.teth)"}}, "not a known key"),
        (
            {"vary": LENGTH, "links": {"sun.teeth": "ring.teeth", "ring.teeth": "sun.teeth"}},
            "is circular",
        ),
        ({"vary": LENGTH, "together": [LENGTH]}, "varied twice"),
        ({"together": [{**LENGTH, "sun.teeth": [73]}]}, "vary together"),
        ({"together": [{"sun.teeth": [73, 73], **LENGTH}]}, "same value twice"),
        ({"together": [{}]}, "names no keys"),
        ({"points": {"sun.teeth": range(2000)}, "vary": {"planet.count": range(2000)}}, "fewer"),
    ],
)
def test_unsuitable_links(case, asked, words):
    with pytest.raises(ep.InputError, match=words) as caught:
        make_plan(case, **asked)
    assert all(problem.remedy for problem in caught.value.problems)


def test_a_key_that_follows_from_what_is_varied_is_not_taken_from_the_case(case):
    shifted = case.updated(LEFT_OUT | {"ring.profile_shift_coefficient": 0.02})
    solved = shifted.updated(
        {
            "gears.center_distance": None,
            "planet.tooth_thickness": None,
            "planet.profile_shift_coefficient": -0.03,
        }
    )
    link = {"carrier.outer_diameter": "2 * gears.center_distance"}
    with pytest.raises(ep.InputError, match="which the case leaves out"):
        make_plan(solved, LENGTH, links=link)
    fixed = {"carrier.outer_diameter": "3 * case(gears.center_distance)"}
    changed = solved.updated(make_plan(solved, LENGTH, links=fixed).changes(1))
    wanted = 3 * solved.gears.center_distance
    assert changed.carrier.outer_diameter == pytest.approx(wanted, rel=1e-12)


def test_a_point_without_a_value_is_a_row(case):
    vary = {"planet.count": [3, 4], "operation.speed": ["0 rpm", "100 rpm"]}
    constant_power = {"operation.torque": "25 * W * planet.count / operation.speed"}
    quick = case.updated({"numerics.mesh_positions": 8, "numerics.contact_segments": 6})
    plan = make_plan(quick, vary, links=constant_power)
    rows = plan.solve_all(range(plan.size))
    assert [row.status for row in rows] == ["failed", "converged"] * 2
    assert "divides by zero" in rows[0].message
    data = to_dataset(plan, Rows(plan.size))
    assert data.torque.dims == ("planet_count", "speed")
    torque = [75 / (100 * math.pi / 30), 100 / (100 * math.pi / 30)]
    assert data.torque.sel(speed=100.0).values == pytest.approx(torque, rel=1e-12)
    assert np.isnan(data.torque.sel(speed=0.0)).all()
    assert rows[1].numbers["input_power"] == pytest.approx(75.0, rel=1e-9)


def test_options_of_links():
    assert parse_links(["sun.teeth = 2 * 3"]) == {"sun.teeth": "2 * 3"}
    with pytest.raises(ep.InputError, match="must be key = expression") as caught:
        parse_links(["sun.teeth", "a.b=1", "a.b=2"])
    assert len(caught.value.problems) == 2


def test_braces_stand_for_several_keys():
    changes = parse_changes(["{sun,ring}.{a,b}=3", "planet.teeth=", "x.{y}.z=4 mm"])
    assert changes == dict.fromkeys(("sun.a", "sun.b", "ring.a", "ring.b"), 3) | {
        "planet.teeth": None,
        "x.y.z": "4 mm",
    }


def test_a_failed_point_tells_its_first_problem_only(case):
    (row,) = make_plan(case, {"planet.teeth": [27]}).solve_all([0])
    assert row.status == "failed"
    assert "too thick for the centre distance" in row.message
    assert " more: 'epicyclic check' with these values shows all." in row.message
    assert len(row.message) < 600


def test_gross_backlash_is_told_at_the_end(case, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = ["--vary", "gears.center_distance=50,50.9 mm", "-o", "s.csv"]
    monkeypatch.setattr("sys.argv", ["epicyclic", "sweep", "talbot-2012-pair", *words])
    main()
    told = capsys.readouterr().err
    assert "1 of 2 points: the teeth are far too thin for their centre distance." in told
