"""Tables as rigs and spreadsheets write them: read right, or refused with what to change."""

from __future__ import annotations

import io

import numpy as np
import openpyxl
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import epicyclic as ep
from epicyclic.study.maps.cycle import open_cycle
from epicyclic.study.measured.table import parse_measurements
from epicyclic.study.table_file import TableForm, parse_form, read_grid

SPEED, TORQUE, TIME = [420, 890], [310, 28.5], [0, 7]
GERMAN = "Zeit [s];Drehzahl [1/min];Drehmoment [Nm]\n0,0;420;310,0\n7,0;890;28,5\n"
PLAIN = "time [s],speed [rpm],torque [N*m]\n0,420,310\n7,890,28.5\n"


@pytest.fixture
def cycle(tmp_path):
    """A duty cycle of a text, or of the sheets of a workbook."""

    def read(content, name="cycle.csv", form=None):
        path = tmp_path / name
        if isinstance(content, dict):
            book = openpyxl.Workbook()
            book.remove(book.active)
            for sheet, rows in content.items():
                place = book.create_sheet(sheet)
                for row in rows:
                    place.append(row)
            book.save(path)
        else:
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return open_cycle(path, form=form or TableForm())

    return read


def values(cycle):
    """Times or durations, speeds and torques of all rows."""
    pieces = list(cycle.pieces())
    speed = np.concatenate([piece.speed for piece in pieces])
    torque = np.concatenate([piece.torque for piece in pieces])
    return speed, torque, sum(piece.duration.sum() for piece in pieces)


READ = {
    "plain": PLAIN,
    "German": GERMAN,
    "German of Excel": GERMAN.replace(".", "").encode("utf-8-sig"),
    "Latin-1": GERMAN.replace("Zeit", "# Prüfstand 3\nZeit").encode("cp1252"),
    "UTF-16": GERMAN.encode("utf-16"),
    "UTF-16 without a mark": GERMAN.encode("utf-16-le"),
    "UTF-16 of big ends": b"\xfe\xff" + GERMAN.encode("utf-16-be"),
    "tabs": PLAIN.replace(",", "\t"),
    "bars": PLAIN.replace(",", "|"),
    "spaces": PLAIN.replace(",", "   "),
    "Windows ends, separators at ends": PLAIN.replace("\n", ",,\r\n"),
    "a title": "Run 12 of 12.03.2021\n\n" + PLAIN,
    "blank cells below": GERMAN + ";;\n;;\n",
    "a title in cells": "Lastkollektiv;;\n" + GERMAN,
    "facts above the head": "Operator:,Meier,\nSample rate:,10 Hz,\n" + PLAIN,
    "a row of units": "time,speed,torque\ns,rpm,N*m\n0,420,310\n7,890,28.5\n",
    "a row of units in brackets": "time;n;M\n[s];[1/min];[kNm]\n0;420;0,31\n7;890;0,0285\n",
    "units in parentheses": PLAIN.replace("[", "(").replace("]", ")"),
    "units after a stroke": "t / s;n / min^-1;M / Nm\n0;420;310\n7;890;28.5\n",
    "units after in": "t in s;n in 1/min;M in Nm\n0;420;310\n7;890;28,5\n",
    "units after a bar": "time_s,speed_rpm,torque_Nm\n0,420,310\n7,890,28.5\n",
    "a head that is a comment": "# made by savetxt\n# " + PLAIN,
    "comments and blank lines": PLAIN.replace("\n7", '\n\n# a "pause\n7'),
    "quotes": '"time [s]","speed [rpm]","torque [N*m]"\n"0","420","310"\n"7","890","28,5"\n',
    "two lines of heads": ",Input,Input,Output\ntime [s],speed [rpm],torque [Nm],speed [rpm]\n"
    "0,420,310,1\n7,890,28.5,2\n",
    "a line break in a head": PLAIN.replace("time [s]", '"time\n[s]"'),
    "dates": "time,speed [rpm],torque [N*m]\n2021-03-12 23:59:57,420,310\n"
    "2021-03-13 00:00:04,890,28.5\n",
    "German dates": "Datum;n [1/min];M [Nm]\n12.03.2021 08:00:00,5;420;310,0\n"
    "12.03.2021 08:00:07,5;890;28,5\n".replace("0,5;", "0.5;").replace("7,5;", "7.5;"),
    "American dates": "time,speed [rpm],torque [N*m]\n3/14/2021 11:59:58 PM,420,310\n"
    "3/15/2021 12:00:05 AM,890,28.5\n",
    "times of day": "time,speed [rpm],torque [N*m]\n08:00:00,420,310\n08:00:07,890,28.5\n",
    "a clock that was set back": "time,speed [rpm],torque [N*m]\n"
    "2019-10-27 02:59:56+02:00,420,310\n2019-10-27 02:00:03+01:00,890,28.5\n",
    "minutes": PLAIN.replace("[s]", "[min]").replace("\n7", "\n0.1166666666666667"),
    "nearby columns": PLAIN.replace("torque [N*m]", "torque [N*m],n [Hz],T [bar]")
    .replace("310", "310,1,2").replace("28.5", "28.5,3,4"),
}  # fmt: skip


@pytest.mark.parametrize("name", READ)
def test_tables_of_all_kinds_are_the_same_cycle(cycle, name):
    speed, torque, duration = values(cycle(READ[name]))
    np.testing.assert_allclose(speed, SPEED)
    np.testing.assert_allclose(torque, TORQUE)
    assert duration == pytest.approx(7, rel=1e-6)


def test_a_text_file_has_no_sheets(cycle):
    with pytest.raises(ep.InputError, match='has no sheet "run 2", as it is no workbook'):
        cycle(PLAIN, form=parse_form([], sheet="run 2"))


HEAD = ["time [s]", "speed [rpm]", "torque [N*m]"]
ROWS = [[0, 420, 310], [7, 890, 28.5]]


@pytest.mark.parametrize(
    "sheets",
    [
        {"Sheet1": [HEAD, *ROWS]},
        {"Cover": [["see sheet 2"]], "data": [HEAD, *ROWS]},
        {"Sheet1": [["Test of 12.03.2021"], [], ["time", "speed", "torque"],
                    ["s", "rpm", "Nm"], *ROWS]},
        {"Sheet1": [["time", *HEAD[1:]], *([pd.Timestamp(2021, 3, 12, 8, 0, row[0]), *row[1:]]
                                           for row in ROWS)]},
    ],
)  # fmt: skip
def test_workbooks_are_the_same_cycle(cycle, sheets):
    speed, torque, duration = values(cycle(sheets, "cycle.xlsx"))
    np.testing.assert_allclose(speed, SPEED)
    np.testing.assert_allclose(torque, TORQUE)
    assert duration == pytest.approx(7)


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        (["1.234,5", "-0,25"], [1234.5, -0.25]),
        (["1,234.5", "12"], [1234.5, 12]),
        (["1.234.567", "12,5"], [1234567, 12.5]),
        (["1'234.5", "3"], [1234.5, 3]),
        (["1 234,5", "3"], [1234.5, 3]),
        (["1\u202f234,5", "3"], [1234.5, 3]),
        (["80.5", "1,400"], [80.5, 1400]),
        (["80,5", "1.400"], [80.5, 1400]),
        (["1,4e3", "2"], [1400, 2]),
        (["0.125", "3.000"], [0.125, 3]),
        (["3,50E-01", "7"], [0.35, 7]),
    ],
)
def test_numbers_are_those_that_were_meant(cycle, written, meant):
    rows = "".join(f"{i};420;{number}\n" for i, number in enumerate(written))
    _, torque, _ = values(cycle("time [s];speed [rpm];torque [N*m]\n" + rows))
    np.testing.assert_allclose(torque, meant)


@pytest.mark.parametrize(("decimal", "meant"), [("point", [3, 1.4]), ("comma", [3000, 1400])])
def test_what_is_open_is_asked_for(cycle, decimal, meant):
    text = "time [s];speed [rpm];torque [N*m]\n0;420;3.000\n1;890;1.400\n"
    with pytest.raises(ep.InputError) as error:
        cycle(text)
    message = str(error.value)
    assert '"3.000" in line 2, which may mean 3.000 or 3000' in message
    assert "--decimal point for 3.000, --decimal comma for 3000" in message
    _, torque, _ = values(cycle(text, form=parse_form([], decimal=decimal)))
    np.testing.assert_allclose(torque, meant)


REFUSED = {
    "both marks": (
        "time [s];speed [rpm];torque [N*m]\n0;420;31,5\n7;890;28.5\n",
        ['decimal points ("28.5" in line 3)', 'commas ("31,5" in line 2)', "--decimal"],
    ),
    "a comma too many": (
        PLAIN.replace("28.5", "1,400"),
        ["3 columns, but line 3 has 4", 'in quotes: "1,400"'],
    ),
    "an end mark": (PLAIN + "END\n", ["line 4 has 1", "--rows"]),
    "two sessions": (
        PLAIN + "0,100,1\n3,200,2\n",
        ["line 4", "--rows 2-3, --rows 4-5"],
    ),
    "a clock that stands": (
        "time,speed [rpm],torque [N*m]\n2019-10-27 02:00:00,1,2\n2019-10-27 02:00:00,3,4\n",
        ['"2019-10-27 02:00:00" (line 3)', "Keep one of these rows", "UTC"],
    ),
    "dates that may be two": (
        "time,speed [rpm],torque [N*m]\n03/04/2021 08:00:00,1,2\n03/05/2021 08:00:00,3,4\n",
        ["day and month are not clear", "2021-03-12 14:05:00"],
    ),
    "other names": (
        PLAIN.replace("speed", "Motor Speed").replace("torque [N*m]", "Motor Torque [kNm]"),
        ['--column "speed=Motor Speed [rpm]"', '--column "torque=Motor Torque [kNm]"'],
    ),
    "a column twice": (
        PLAIN.replace("time [s]", "speed [rpm],time [s]").replace("0,4", "0,0,4", 1)
        .replace("7,8", "0,7,8"),
        ["appears more than once", "Keep one"],
    ),
    "a gap": (PLAIN.replace("310", ""), ['torque = "" (line 2)', "is empty"]),
    "two sheets with tables": (
        {"run 1": [HEAD, *ROWS], "run 2": [HEAD, *ROWS]}, ['"run 1", "run 2"', "--sheet"],
    ),
    "an old workbook": ("x", ["Save it as .xlsx"]),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_read_is_refused_with_the_change(cycle, name):
    content, words = REFUSED[name]
    file = {"two sheets with tables": "c.xlsx", "an old workbook": "c.xls"}.get(name, "c.csv")
    with pytest.raises(ep.InputError) as error:
        cycle(content, file)
    for part in words:
        assert part in str(error.value), str(error.value)


def test_the_changes_that_messages_name_are_right(cycle):
    other = PLAIN.replace("speed [rpm]", "n_mot").replace("torque [N*m]", "M_mot [kNm]")
    named = parse_form(["speed [rpm]=n_mot", "torque=M_mot"])
    speed, torque, _ = values(cycle(other, form=named))
    np.testing.assert_allclose(speed, SPEED)
    np.testing.assert_allclose(torque, np.multiply(1e3, TORQUE))
    with pytest.raises(ep.InputError, match=r"has the unit .kNm. in the table, not .N\*m."):
        cycle(other, form=parse_form(["torque [N*m]=M_mot"]))
    with pytest.raises(ep.InputError, match='must name one of the columns "time'):
        cycle(other, form=parse_form(["torque=none"]))
    twice = PLAIN + "0,100,1\n3,200,2\nEND\n"
    speed, _, duration = values(cycle(twice, form=parse_form([], rows="4-5")))
    np.testing.assert_allclose(speed, [100, 200])
    assert duration == 3
    sheets = {"run 1": [HEAD, *ROWS], "run 2": [HEAD, [0, 1, 2], [5, 3, 4]]}
    assert values(cycle(sheets, "c.xlsx", parse_form([], sheet="run 2")))[2] == 5
    for options in ({"columns": ["x"]}, {"columns": [], "rows": "9-2"}):
        with pytest.raises(ep.InputError, match="must be"):
            parse_form(**options)


def test_states_are_the_names_that_were_meant(cycle):
    text = PLAIN.replace("*m]", "*m],gear").replace("310", "310,1.0").replace("28.5", "28.5,2.0")
    assert cycle(text).states == ("1", "2")


@pytest.mark.parametrize(
    ("column", "cells"),
    [
        ("eta [%]", ["98.5", "97"]),
        ("efficiency", ["0.985", "0.97"]),
        ("Wirkungsgrad", ["98.5 %", "97 %"]),
    ],
)
def test_a_loss_follows_from_an_efficiency(tmp_path, talbot, column, cells):
    path = tmp_path / "eta.csv"
    rows = [f"1000,50,60,{cells[0]}", f"2000,-40,60,{cells[1]}"]
    path.write_text("\n".join([f"n [1/min],M [Nm],T [°C],{column}", *rows]))
    table = parse_measurements(read_grid(path), talbot)
    power = np.array([1000 * 50, 2000 * 40]) * np.pi / 30
    np.testing.assert_allclose(table.loss, power * [0.015, 1 / 0.97 - 1])
    with pytest.raises(ep.InputError, match="only if it is the total"):
        parse_measurements(read_grid(path), talbot, "load_dependent")


def test_a_loss_follows_from_two_torques(talbot):
    pair = ep.load_case("talbot-2012-pair")
    ratio = pair.gear.teeth / pair.pinion.teeth
    frame = pd.DataFrame(
        {"speed [rpm]": [1000, 500], "torque [N*m]": [50.0, 70.0], "temperature [degC]": [60, 60],
         "output torque [Nm]": [-49.0 * ratio, -69.5 * ratio]}
    )  # fmt: skip
    table = parse_measurements(read_grid(frame), pair)
    np.testing.assert_allclose(table.loss, [1000 * np.pi / 30, 250 * np.pi / 30])
    frame["output speed [rpm]"] = [-900 / ratio, -500 / ratio]
    table = parse_measurements(read_grid(frame), pair)
    np.testing.assert_allclose(table.loss[0], (1000 * 50 - 900 * 49) * np.pi / 30)


@pytest.mark.parametrize("sign", [1, -1])
def test_signs_of_an_output_torque_tell_where_both_shafts_drive(sign):
    pair = ep.load_case("talbot-2012-pair")
    ratio = pair.gear.teeth / pair.pinion.teeth
    driving, idle, coasting = -49.0 * ratio, 0.3 * ratio, 21.0 * ratio  # as a rig or a motor has it
    frame = pd.DataFrame(
        {"speed [rpm]": [1000, 1000, 1000], "torque [N*m]": [50.0, 0.2, -20.0],
         "temperature [degC]": [60, 60, 60], "torque_uncertainty [%]": [0.1, 0.2, 0.3],
         "output torque [Nm]": np.array([driving, idle, coasting]) * sign}
    )  # fmt: skip
    table = parse_measurements(read_grid(frame), pair)
    shaft = 1000 * np.pi / 30
    np.testing.assert_allclose(table.loss, np.array([1.0, 0.5, 1.0]) * shaft)
    of_both = [np.hypot(50, 49), np.hypot(0.2, 0.3), np.hypot(20, 21)]
    np.testing.assert_allclose(table.uncertainty, np.array([1e-3, 2e-3, 3e-3]) * of_both * shaft)
    frame["output torque [Nm]"] = np.abs(frame["output torque [Nm]"])  # magnitudes tell nothing
    table = parse_measurements(read_grid(frame), pair)
    np.testing.assert_allclose(table.loss, np.array([1.0, -0.1, 1.0]) * shaft)


def test_a_table_may_be_long(tmp_path):
    rows = 70_000
    buffer = io.StringIO()
    frame = pd.DataFrame({"time [s]": np.arange(rows), "speed [rpm]": 7.5, "torque [N*m]": 3.5})
    frame.to_csv(buffer, index=False, sep=";", decimal=",")
    (tmp_path / "long.csv").write_text(buffer.getvalue())
    cycle = open_cycle(tmp_path / "long.csv")
    assert cycle.rows == rows
    assert values(cycle)[2] == rows - 1


def test_a_cycle_may_begin_behind_rows_that_are_read_together(tmp_path, monkeypatch):
    monkeypatch.setattr("epicyclic.study.table_file._BATCH_ROWS", 4)
    rows = [f"{second},100,5" for second in range(12)]
    path = tmp_path / "late.csv"
    path.write_text("\n".join(["time [s],speed [rpm],torque [N*m]", *rows]))
    cycle = open_cycle(path, form=TableForm(rows=(8, 12)))
    assert sum(piece.duration.sum() for piece in cycle.pieces()) == 4
    assert all(piece.duration.size == piece.speed.size for piece in cycle.pieces())


MOMENTS = pd.to_datetime(["2024-05-02 10:00:01.5", "2024-05-02 10:00:08.75"])
KINDS = {
    "ns": pa.array(MOMENTS, pa.timestamp("ns")),
    "far": pa.array([10**12, 10**12 + 7], pa.timestamp("s")),  # beyond the year 9999
    "span": pa.array([1500, 8750], pa.duration("ms")),
    "longest": pa.array([-(2**62), 2**62], pa.duration("us")),
    "day": pa.array([19_000, 19_001], pa.date32()),
    "of day": pa.array([1500, 8750], pa.time32("ms")),
    "lists": pa.array([[1], [2, 3]]),
    "tables": pa.array([{"a": 1}, {"a": 2}]),
}


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize("column", ["time [s]", "speed [rpm]", "state", "logger"])
def test_columns_of_any_kind_are_read_or_refused(tmp_path, name, column):
    """Loggers write moments in nanoseconds, more than a number holds; no speed is a date."""
    columns = {"time [s]": [0.0, 7.25], "speed [rpm]": [420, 890], "torque [N*m]": [310, 28.5]}
    path = tmp_path / "cycle.parquet"
    table = {key: pa.array(it) for key, it in columns.items()} | {column: KINDS[name]}
    try:
        pq.write_table(pa.table(table), path)
    except pa.ArrowInvalid:
        pytest.skip("a moment that Parquet cannot hold")
    of_time = name not in ("day", "lists", "tables")
    if column == "speed [rpm]" or (column == "time [s]" and not of_time):
        with pytest.raises(ep.InputError, match="must be a finite number"):
            open_cycle(path)
        return
    found = open_cycle(path)
    if column == "time [s]" and name in ("ns", "span", "of day"):
        assert values(found)[2] == pytest.approx(7.25, rel=1e-6)
