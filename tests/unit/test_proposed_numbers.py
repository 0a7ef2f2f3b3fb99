"""A number that a message proposes is the number that was meant, or there is none."""

from __future__ import annotations

import re

import numpy as np
import pytest

import epicyclic as ep
from epicyclic.case.keys import field_at
from epicyclic.cli.common import parse_changes
from epicyclic.losses.loss_table import read_loss_table
from epicyclic.schema.fields import quantity_of
from epicyclic.study.maps.cycle import open_cycle
from epicyclic.study.measured.table import parse_measurements
from epicyclic.study.sweeps.run import parse_vary
from epicyclic.study.table_file import read_grid
from epicyclic.units import registry
from rexs_files import pair

TORQUE, SPEED = "operation.torque", "operation.speed"
WIDTH, OIL = "pinion.face_width", "operation.oil_inlet_temperature"

SPELLINGS = {  # key, text, what is meant in the unit; None if it may be two
    "foot pounds": (TORQUE, "110.6 lb-ft", (110.6 * 1.3558179483314004, "N*m")),
    "pound feet": (TORQUE, "37 ft-lbs", (37 * 1.3558179483314004, "N*m")),
    "inch pounds": (TORQUE, "82.3 in-lb", (82.3 * 0.1129848290276167, "N*m")),
    "metre kiloponds": (TORQUE, "12.5 kpm", (12.5 * 9.80665, "N*m")),
    "a hyphen": (TORQUE, "23.7 N-m", (23.7, "N*m")),
    "a point in the unit": (TORQUE, "4.25 kN.m", (4250, "N*m")),
    "pounds and feet": (TORQUE, "110.6 lb*ft", (110.6 * 1.3558179483314004, "N*m")),
    "Fahrenheit": (OIL, "158 F", (70, "degC")),
    "Fahrenheit in words": (OIL, "149 deg F", (65, "degC")),
    "Celsius": (OIL, "61 C", (61, "degC")),
    "inches": (WIDTH, '2.95"', (74.93, "mm")),
    "inches in words": (WIDTH, "1.5 Zoll", (38.1, "mm")),
    "two kinds of fractions": (WIDTH, "2 1/2 in", (63.5, "mm")),
    "a comma for either": (SPEED, "3,000 rpm", None),
    "a comma for decimals": (SPEED, "1480,5 rpm", (1480.5, "rpm")),
    "a comma after zero": (SPEED, "0,125 rpm", (0.125, "rpm")),
    "a point for thousands": (SPEED, "1.000,0", (1000, "rpm")),
    "thousands and a unit": (SPEED, "1.234,5 rpm", (1234.5, "rpm")),
    "English thousands": (SPEED, "1,234.5 rpm", (1234.5, "rpm")),
    "thousands twice": (SPEED, "1.234.000 rpm", (1234000, "rpm")),
    "blanks for thousands": (SPEED, "1 250 rpm", (1250, "rpm")),
    "apostrophes": (SPEED, "1'250 rpm", (1250, "rpm")),
    "a comma in a power": (SPEED, "1e3,5 rpm", None),
    "German turns": (SPEED, "2950 U/min", (2950, "rpm")),
    "hertz": (SPEED, "49.3333333 Hz", (2959.999998, "rpm")),
    "a span": (SPEED, "900-1100 rpm", None),
    "another quantity": (WIDTH, "17 kg", None),
    "no unit of any kind": (WIDTH, "17 xyz", None),
    "about": (WIDTH, "~17 mm", (17, "mm")),
    "a fraction of words": (WIDTH, "17 or 18 mm", None),
}  # fmt: skip
NUMBER = re.compile(r"(?<![\w.])([+-]?\d[\d.]*(?:e[+-]?\d+)?)(?: ([^\s\",.]+)(?=\"))?")


def check(problems, key, text, meant):
    """Every number in what problems say to write is the one that was meant."""
    assert problems
    case = ep.load_case("talbot-2012-pair")
    quantity = quantity_of(*field_at(case, key))
    for problem in problems:
        remedy = problem.remedy.replace(text, "").removesuffix(".")
        for number, unit in NUMBER.findall(remedy):
            assert meant is not None, f"{text}: {problem}"
            try:
                found = quantity.to_display(quantity.parse(f"{number} {unit}"))
            except Exception:  # a number alone: with the unit of the text
                found = float(number)
            np.testing.assert_allclose(found, meant[0], rtol=1e-9, err_msg=str(problem))
            assert not unit or registry()(unit).check(registry()(meant[1]).dimensionality)


def refused(call):
    with pytest.raises(ep.InputError) as error:
        call()
    return error.value.problems


@pytest.mark.parametrize("name", SPELLINGS)
def test_in_a_case(tmp_path, name):
    key, text, meant = SPELLINGS[name]
    name = "talbot-2012-pair"
    check(refused(lambda: ep.load_case(name, parse_changes([f"{key}={text}"]))), key, text, meant)
    table, _, own = key.partition(".")
    for quoted in (f"'{text}'", text):  # in a file, with its quotes and without
        path = tmp_path / "case.toml"
        quoted = f"'''{text}'''" if quoted != text else text
        path.write_text(f'kind = "pair"\n[{table}]\n{own} = {quoted}\n')
        with pytest.raises(ep.InputError) as error:
            ep.load_case(path)
        check([p for p in error.value.problems if p.key == key], key, text, meant)


@pytest.mark.parametrize("name", SPELLINGS)
def test_in_an_axis_of_a_sweep(name):
    key, text, meant = SPELLINGS[name]
    if "," in text:  # divides values there
        return
    case = ep.load_case("talbot-2012-pair")

    def sweep():
        return ep.sweep(case, parse_vary(case, [f"{key}={text}"]))

    check(refused(sweep), key, text, meant)


def test_commas_of_thousands_in_an_axis_are_refused():
    case = ep.load_case("talbot-2012-pair")
    (problem,) = refused(lambda: parse_vary(case, ["operation.speed=3,000 rpm"]))
    assert "commas divide values" in problem.allowed
    assert parse_vary(case, ["operation.speed=3,0.5,0 rpm"])["operation.speed"][2] == "0 rpm"


HEADS = {TORQUE: "torque", SPEED: "speed", OIL: "temperature"}


@pytest.mark.parametrize("name", SPELLINGS)
def test_in_tables(tmp_path, name):
    key, text, meant = SPELLINGS[name]
    if key not in HEADS or "," in text:  # those are read: test_table_files.py
        return
    case, own = ep.load_case("talbot-2012-pair"), HEADS[key]
    cells = {"speed [rpm]": "700", "torque [N*m]": "30", "temperature [degC]": "50"}
    headers = [own if header.startswith(own) else header for header in cells]
    row = [text if header == own else cells[header] for header in headers]
    path = tmp_path / "measured.csv"
    path.write_text(";".join([*headers, "loss [W]"]) + "\n" + ";".join([*row, "9.5"]) + "\n")
    check(refused(lambda: parse_measurements(read_grid(path), case)), key, text, meant)
    cycle = tmp_path / "cycle.csv"
    cycle.write_text(";".join([*headers, "time [s]"]) + "\n" + ";".join([*row, "9.5"]) + "\n")
    check(refused(lambda: open_cycle(cycle)), key, text, meant)


@pytest.mark.parametrize(
    ("unit", "remedy"),
    [
        ("lb-ft", 'Call it "torque [lbf*ft]"'),
        ("kgm", 'Call it "torque [kgf*m]"'),
        ("bar", "Convert"),
    ],
)
def test_a_unit_of_a_head_is_the_one_that_was_meant(tmp_path, unit, remedy):
    case = ep.load_case("talbot-2012-pair")
    text = f"speed [rpm],torque [{unit}],temperature [degC],loss [W],time [s]\n700,30,50,9,1\n"
    path = tmp_path / "table.csv"
    path.write_text(text)
    for read in (lambda: parse_measurements(read_grid(path), case), lambda: open_cycle(path)):
        (problem,) = (p for p in refused(read) if p.key == "torque")
        assert remedy in problem.remedy
    path.write_text(f"speed [rpm],torque [{unit}]\n700,30\n900,40\n")
    (problem,) = refused(lambda: read_loss_table(path))
    assert ("Convert" in problem.remedy) == (unit == "bar")
    assert "N*m" not in problem.remedy


def test_fields_of_the_app_say_the_same():
    pytest.importorskip("nicegui")
    from epicyclic.plugins.app.case_form import built_in

    for key, text, meant in SPELLINGS.values():
        desk = built_in("talbot-2012-pair")
        desk.change(key, text)
        check(desk.problems_of(key), key, text, meant)


def test_rexs_proposes_no_number(tmp_path):
    for text in ("1.000,0", "3,000", '2.95"', "1 000"):
        parts = pair()
        number = next(n for n, one in parts.components.items() if "face_width" in one["attributes"])
        parts.set(number, face_width=(text, "mm"))
        path = parts.write(tmp_path / "pair.rexs")
        for problem in refused(lambda path=path: ep.load_case(path)):
            assert not re.search(r"\d", problem.remedy), problem
