"""Tables of torque or power: interpolation, files, the element, and its table of keys."""

from __future__ import annotations

import math

import numpy as np
import pytest

from epicyclic import library
from epicyclic.build.elements import build_element
from epicyclic.case.tables.elements import DragTable
from epicyclic.gears.gear import HOUSING
from epicyclic.losses.loss_table import LossTable, read_loss_table, table_problems
from epicyclic.losses.ranges import ModelUse
from epicyclic.machine.element import LOAD_INDEPENDENT, State, fluids_at
from epicyclic.machine.shaft_parts import TableLoss
from epicyclic.oil.oil import Oil
from problems import only, problems_of

RPM = math.pi / 30
USE = ModelUse("drag", "table", "clutch")
CURVE = LossTable("torque", {"speed": np.array([0.0, 100.0, 300.0])}, np.array([0.0, 4.0, 1.0]))
SURFACE = LossTable(
    "torque",
    {"speed": np.array([0.0, 100.0]), "temperature": np.array([300.0, 340.0, 400.0])},
    np.array([[2.0, 1.0, 0.5], [6.0, 3.0, 1.5]]),
)
POWER = LossTable("power", {"speed": np.array([50.0, 100.0])}, np.array([30.0, 80.0]))


# --- interpolation --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("speed", "torque"), [(100.0, 4.0), (50.0, 2.0), (200.0, 2.5), (300.0, 1.0), (1000.0, 1.0)]
)
def test_torque_is_linear_between_points_and_held_beyond(speed, torque):
    # sums and products of few binary fractions are exact
    assert CURVE.loss(speed=speed, temperature=300.0) == torque * speed
    assert CURVE.loss(speed=-speed, temperature=300.0) == torque * speed


@pytest.mark.parametrize(
    ("speed", "kelvin", "torque"),
    [
        (100.0, 340.0, 3.0),
        (50.0, 340.0, 2.0),
        (50.0, 320.0, 3.0),  # the mean of all four corners
        (50.0, 250.0, 4.0),
        (200.0, 500.0, 1.5),
    ],
)
def test_two_axes(speed, kelvin, torque):
    assert SURFACE.loss(speed=speed, temperature=kelvin) == pytest.approx(torque * speed)
    swapped = LossTable("torque", dict(reversed(SURFACE.axes.items())), SURFACE.values.T)
    assert swapped.loss(speed=speed, temperature=kelvin) == pytest.approx(torque * speed)


def test_torque_over_temperature_alone():
    table = LossTable("torque", {"temperature": np.array([300.0, 400.0])}, np.array([3.0, 1.0]))
    assert table.loss(speed=10.0, temperature=350.0) == pytest.approx(20.0)


def test_power_falls_to_zero_below_the_first_speed():
    assert POWER.loss(speed=75.0, temperature=300.0) == pytest.approx(55.0)
    assert POWER.loss(speed=25.0, temperature=300.0) == pytest.approx(15.0)
    assert POWER.loss(speed=0.0, temperature=300.0) == 0.0
    assert POWER.loss(speed=500.0, temperature=300.0) == 80.0


@pytest.mark.parametrize("table", [CURVE, SURFACE, POWER])
def test_nothing_is_lost_or_flagged_at_rest(table):
    assert table.loss(speed=0.0, temperature=1000.0) == 0.0
    assert table.flags(USE, speed=0.0, temperature=1000.0) == ()


def test_values_beyond_the_ends_are_flagged():
    assert CURVE.flags(USE, speed=-300.0, temperature=1000.0) == ()
    flag = only(CURVE.flags(USE, speed=-301.0, temperature=300.0))
    assert (flag.quantity, flag.unit) == ("speed difference", "rpm")
    assert flag.high == pytest.approx(300.0 / RPM)
    found = SURFACE.flags(USE, speed=101.0, temperature=290.0)
    assert [flag.quantity for flag in found] == ["speed difference", "oil temperature"]
    assert only(POWER.flags(USE, speed=40.0, temperature=300.0)).low == pytest.approx(50.0 / RPM)


@pytest.mark.parametrize(
    ("quantity", "axes", "values", "key"),
    [
        ("torque", {}, [], "torque"),
        (
            "torque",
            {"speed": [0, 1], "temperature": [300, 400], "radial_force": [0, 1]},
            [[[1, 1], [1, 1]], [[1, 1], [1, 1]]],
            "torque",
        ),
        ("torque", {"speed": [0.0]}, [1.0], "speed"),
        ("torque", {"speed": [0.0, 0.0]}, [1.0, 1.0], "speed"),
        ("torque", {"speed": [0.0, math.nan]}, [1.0, 1.0], "speed"),
        ("torque", {"speed": [-1.0, 1.0]}, [1.0, 1.0], "speed"),
        ("torque", {"speed": [0.0, 1.0]}, [1.0, 1.0, 1.0], "torque"),
        ("torque", {"speed": [0.0, 1.0]}, [[1.0], [1.0, 1.0]], "torque"),
        ("torque", {"speed": [0.0, 1.0]}, [1.0, -1.0], "torque"),
        ("torque", {"speed": [0.0, 1.0]}, [1.0, math.nan], "torque"),
        ("power", {"temperature": [300.0, 400.0]}, [1.0, 1.0], "power"),
        ("power", {"speed": [0.0, 1.0]}, [1.0, 1.0], "power"),
    ],
)
def test_unsound_tables_are_refused(quantity, axes, values, key):
    assert only(tuple(table_problems(quantity, axes, values))).key == key
    if all(len(points) == 2 for points in axes.values()):
        arrays = {name: np.array(points) for name, points in axes.items()}
        with pytest.raises(ValueError, match=key):
            LossTable(quantity, arrays, values)


# --- files ----------------------------------------------------------------------------------------


@pytest.fixture
def read(tmp_path):
    def of(text):
        path = tmp_path / "loss.csv"
        path.write_text(text, encoding="utf-8")
        return read_loss_table(path)

    return of


def test_a_file_with_one_axis(read):
    table = read("# measured 2024\nspeed [rpm]; power [kW]\n3000; 0.5\n\n1000; 0.1\n")
    assert table.quantity == "power"
    assert table.axes["speed"] == pytest.approx([1000 * RPM, 3000 * RPM])
    assert table.values == pytest.approx([100.0, 500.0])
    assert table.source.endswith("loss.csv")


def test_a_file_with_two_axes_in_any_order(read):
    rows = ["3000,40,1.5", "0,40,0.5", "3000,90,1.0", "0,90,0.2"]
    found = [
        read("\n".join(["speed [rpm],temperature [degC],torque [N*m]", *order]))
        for order in (rows, rows[::-1])
    ]
    for table in found:
        assert table.names == ("speed", "temperature")
        assert table.axes["temperature"] == pytest.approx([313.15, 363.15])
        assert table.values == pytest.approx(np.array([[0.5, 0.2], [1.5, 1.0]]))


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("", ["empty"]),
        ("speed [rpm],torque [N*m]\n", ["no rows"]),
        ("speed,torque [N*m]\n0,1\n1,1\n", ["no unit"]),
        ("velocity [m/s],torque [N*m]\n0,1\n1,1\n", ["not a known column"]),
        ("speed [rpm]\n0\n1\n", ["either torque or power"]),
        ("torque [N*m]\n0\n1\n", ["one or two of the columns"]),
        ("speed [rpm],torque [N*m],power [W]\n0,1,1\n", ["either torque or power"]),
        ("speed [rpm],speed [rpm],torque [N*m]\n0,1,1\n", ["second column of the same name"]),
        ("speed [rpm],torque [N*m]\n0,1\n1\n", ["2 cells"]),
        ("speed [rpm],torque [N*m]\n0,1\none,1\nx,2\n", ["not a number"]),
        ("speed [rpm],torque [kg]\n0,1\n1,1\n", ["measures something else"]),
        ("speed [rpm],torque [N*m]\n0,1\n0,2\n5,2\n", ["the point of line 2"]),
        ("speed [rpm],torque [N*m]\n0,1\n5,-2\n", ["zero or more"]),
        ("speed [rpm],torque [N*m]\n0,1\n", ["two or more"]),
        (
            "speed [rpm],temperature [degC],torque [N*m]\n0,40,1\n5,40,1\n0,90,1\n",
            ["no row for the point 5 rpm, 90 degC"],
        ),
        ("speed [rpm],torque [kg]\none,1\ntwo,3\n", ["measures something else", "not a number"]),
        ("speed,temperature,torque [N*m]\n0,40,1\n", ["no unit", "no unit"]),
    ],
)
def test_each_mistake_in_a_file_is_one_problem(read, text, parts):
    problems = problems_of(read, text)
    assert len(problems) == len(parts)
    for problem, part in zip(problems, parts, strict=True):
        assert part in str(problem)


def test_files_are_bounded(tmp_path, read):
    large = "speed [rpm],torque [N*m]\n" + "\n".join(f"{n},1" for n in range(10_001))
    assert "10000 rows" in only(problems_of(read, large)).allowed
    huge = tmp_path / "huge.csv"
    huge.write_bytes(b"0" * 1_000_001)
    assert "too large" in only(problems_of(read_loss_table, huge)).allowed
    assert "folder" in only(problems_of(read_loss_table, tmp_path)).allowed
    assert "cannot be read" in only(problems_of(read_loss_table, tmp_path / "none.csv")).allowed


# --- the element ----------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def oil():
    return Oil.model_validate(library.oil_table("iso-vg-100-mineral"))


@pytest.fixture(scope="module")
def state(oil):
    def make(first, second, kelvin=340.0):
        fluids = fluids_at(oil, kelvin, oil_air_ratio=0.05, pressure=101325.0)
        return State({"a": first, "b": second, HOUSING: 0.0}, {}, {}, fluids)

    return make


def test_drag_brakes_the_speed_difference(state):
    clutch = TableLoss("clutch_c", ("a", "b"), SURFACE)
    slipping = clutch.evaluate(state(30.0, -70.0))
    loss = slipping.losses["drag"]
    assert loss.watts == pytest.approx(300.0)
    assert loss.group == LOAD_INDEPENDENT
    assert loss.brakes == (("a", "b", 1.0),)
    assert slipping.figures["drag"].friction_torque == pytest.approx(3.0)
    assert clutch.evaluate(state(-30.0, 70.0)).losses["drag"].watts == loss.watts
    closed = clutch.evaluate(state(50.0, 50.0))
    assert closed.losses["drag"].watts == 0.0
    assert closed.flags == ()
    assert math.isnan(closed.figures["drag"].friction_torque)
    assert clutch.loads(state(50.0, 50.0)) == {}
    assert loss.heat == (("oil", 1.0),)


def test_the_temperature_is_that_of_the_oil(state):
    brake = TableLoss("brake", ("a", HOUSING), SURFACE)
    cold, hot = (brake.evaluate(state(100.0, 0.0, kelvin)) for kelvin in (300.0, 400.0))
    assert cold.losses["drag"].watts == pytest.approx(600.0)
    assert hot.losses["drag"].watts == pytest.approx(150.0)
    assert only(brake.evaluate(state(101.0, 0.0)).flags).use == ModelUse("drag", "table", "brake")


# --- table of keys --------------------------------------------------------------------------------


def drag_table(**keys):
    return DragTable.model_validate({"between": ["a", "housing"]} | keys)


def test_keys_reach_the_element(oil, tmp_path, state):
    table = drag_table(
        speed=["0 rpm", "1000 rpm"],
        temperature=["40 degC", "90 degC"],
        torque=[["1 N*m", "0.5 N*m"], ["3 N*m", "1.5 N*m"]],
    )
    assert list(table.problems()) == []
    drag = build_element("drags", "brake_a", table, shafts={"a": "a"}, oil=oil, folder=tmp_path)
    assert drag.key == "brake_a"
    assert drag.between == ("a", HOUSING)
    result = drag.evaluate(state(500 * RPM, 0.0, 363.15))
    assert result.losses["drag"].watts == pytest.approx(1.0 * 500 * RPM)


def test_a_pump_over_its_speed(oil, tmp_path, state):
    table = drag_table(speed=["0 rpm", "2000 rpm"], power=["0 W", "400 W"])
    assert list(table.problems()) == []
    pump = build_element("drags", "pump", table, shafts={"a": "a"}, oil=oil, folder=tmp_path)
    assert pump.evaluate(state(-1000 * RPM, 0.0)).losses["drag"].watts == pytest.approx(200.0)


@pytest.mark.parametrize(
    ("keys", "key"),
    [
        ({}, ""),
        ({"torque": ["1 N*m"], "power": ["1 W"]}, "torque"),
        ({"file": "a.csv", "speed": ["0 rpm", "1 rpm"]}, "speed"),
        ({"torque": ["1 N*m", "1 N*m"], "radial_force": ["0 N", "1 N"]}, "radial_force"),
        ({"torque": ["1 N*m", "1 N*m"], "speed": ["1 rpm", "0 rpm"]}, "speed"),
        ({"torque": ["1 N*m"], "speed": ["0 rpm", "1 rpm"]}, "torque"),
        ({"between": ["a", "a"], "file": "a.csv"}, "between[1]"),
    ],
)
def test_contradictions_are_found(keys, key):
    assert only(tuple(drag_table(**keys).problems())).key == key


def test_files_with_a_load_are_refused(oil, tmp_path):
    (tmp_path / "a.csv").write_text("radial_force [N],torque [N*m]\n0,1\n1,2\n")

    def action(file):
        build_element(
            "drags", "drag", drag_table(file=file), shafts={"a": "a"}, oil=oil, folder=tmp_path
        )

    assert only(problems_of(action, "a.csv")).key == "file"
    (tmp_path / "b.csv").write_text("speed [rpm],torque [N*m]\n0,1\n1,x\n2,-1 N*m\n")
    found = problems_of(action, "b.csv")
    assert {problem.key for problem in found} == {"file"}
    assert "b.csv" in found[0].value
