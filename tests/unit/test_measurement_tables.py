"""Tables of measurements: how they are read, and that every mistake in them is told at once."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd
import pytest

import epicyclic as ep
from epicyclic.study.measured.table import parse_measurements
from epicyclic.study.table_file import read_grid

GOOD = """\
# test rig 3, gear set 12
speed [rpm],torque [N*m],temperature [degC],loss [W],run
1000,500,90,400,1
2000,500,90,800,2
"""


@pytest.fixture
def read(tmp_path, talbot):
    """Measurements in a CSV file of given text."""

    def from_text(text, component="total"):
        path = tmp_path / "measured.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return parse_measurements(read_grid(path), talbot, component)

    return from_text


def problems_of(read, text, **options):
    with pytest.raises(ep.InputError) as error:
        read(text, **options)
    return error.value.problems


def test_a_table_is_read_with_its_units(read):
    table = read(GOOD)
    assert list(table.conditions["speed"]) == [1000, 2000]
    assert list(table.loss) == [400, 800]
    assert table.lines == (3, 4)
    assert table.uncertainty is None
    assert table.labels["run"] == ("1", "2")
    assert table.changes[0] == {
        "operation.speed": "1000 rpm",
        "operation.torque": "500 N*m",
        "operation.oil_inlet_temperature": "90 degC",
    }


def test_an_efficiency_is_of_the_power_that_enters(read):
    """With negative torque it enters at the other shaft: more than at this one."""
    text = "speed [rpm],torque [N*m],temperature [degC],efficiency [%]\n"
    found = read(f"{text}1000,500,90,98.3\n1000,-300,90,97.1\n").loss
    powers = np.array([500, 300]) * 1000 * np.pi / 30
    assert found == pytest.approx(powers * [1 - 0.983, 1 / 0.971 - 1])


def test_shares_below_a_heading_of_per_cent_are_refused(read):
    text = "speed [rpm],torque [N*m],temperature [degC],efficiency [%]\n1000,500,90,"
    with pytest.raises(ep.InputError, match=re.escape('Call it "efficiency [1]"')):
        read(f"{text}0.983\n700,310,90,0.977\n")
    assert len(read(f"{text}0.983\n700,310,90,97.7\n")) == 2  # next to no torque it may be so


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_separators_and_line_ends_are_recognised(read, separator, newline):
    text = GOOD.replace(",", separator).replace("\n", newline)
    assert list(read(text.encode("utf-8-sig")).loss) == [400, 800]


@pytest.mark.parametrize("suffix", [".xlsx", ".parquet"])
def test_workbooks_and_parquet_hold_the_same(tmp_path, talbot, read, suffix):
    path = tmp_path / f"measured{suffix}"
    frame = pd.read_csv(tmp_path / "measured.csv", comment="#") if read(GOOD) else None
    if suffix == ".xlsx":
        frame.to_excel(path, index=False)
    else:
        frame.to_parquet(path)
    table = parse_measurements(read_grid(path), talbot)
    np.testing.assert_array_equal(table.loss, read(GOOD).loss)
    np.testing.assert_array_equal(table.conditions["speed"], [1000, 2000])


def test_any_key_of_the_case_can_be_a_column(read):
    text = """\
speed [rpm],torque [N*m],temperature [degC],loss [W],planet.count,sun.roughness [um],lubricant.oil
1000,500,90,400,4,0.1,iso-vg-100-pao
"""
    (changes,) = read(text).changes
    assert changes["planet.count"] == 4
    assert changes["sun.roughness"] == "0.1 um"
    assert changes["lubricant.oil"] == "iso-vg-100-pao"


def test_cells_may_carry_units_of_their_own(read):
    text = GOOD.replace("speed [rpm]", "speed").replace("1000,", "1000 rpm,", 1)
    text = text.replace("2000,", "209.43951 rad/s,")
    # eight digits
    assert list(read(text).conditions["speed"]) == pytest.approx([1000, 2000], rel=1e-8)


def test_every_mistake_is_told(read):
    text = """\
speed [rpm],torque [Nm],temprature [degC],loss,uncertainty [W],planet.cuont,component
nan,500,90,400 W,0,4,total
1000,abc,90,500,5,4,total
,500 N,90,600 W,5,4,totl
1e9,500,90,inf W,5,4,total
1000,abc,90,500,5,4,total
"""
    found = "\n".join(map(str, problems_of(read, text)))
    for words in (
        'Did you mean "temperature"?',
        "Did you mean 'planet.count'?",
        'speed [rpm] = "nan" in line 2: is not a number',
        'speed [rpm] = "" in line 4: is empty',
        'speed [rpm] = "1e9" in line 5: is out of range',
        '"abc" in line 3, "abc" in line 6',
        '"500 N" in line 4: has a unit, but the header already has [Nm]',
        'loss = "500" in line 3, "500" in line 6: has no unit',
        '"inf W" in line 5',
        '"0" in line 2: must be > 0',
        '"totl" in line 4: is not a loss',
        "line 6 repeats line 3",
    ):
        assert words in found, words


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("speed [rpm],torque [N*m]\n1,2\n", "temperature: is missing"),
        (GOOD.replace("run", "loss [W]"), "second column"),
        (
            GOOD.replace("run", "operation.speed [rpm]"),
            r"operation.speed \[rpm\]: is a second .* of speed",
        ),
        (GOOD.replace("run", "run [W"), "not a name with a unit"),
        (GOOD.replace("run", "planet.angles"), "a list"),
        (GOOD.replace("run", "planet.count [1/s]"), "no unit in the case"),
        (GOOD.replace(",1\n", "\n"), "has 5 columns, but line 3 has 4"),
        (GOOD.replace("400", "4,00"), "has 5 columns, but line 3 has 6"),
        (GOOD.replace(",", ";").replace("400", "4,500"), "may mean 4.500 or 4500"),
        (GOOD.replace("1000,", "1000 rpm,"), "the header already has .rpm."),
        (GOOD.replace("[degC]", "[bar]"), "measures something else"),
        (GOOD.replace("run", "planet.count").replace(",2\n", ",99\n"), "line 4: planet.count"),
        ("speed [rpm],torque [N*m]\n", "no rows"),
        (GOOD.replace("run", "gr\x81").encode("latin-1"), "not text in UTF-8, UTF-16 or Latin-1"),
    ],
)
def test_mistakes_name_the_place(read, text, words):
    found = "\n".join(map(str, problems_of(read, text)))
    assert re.search(words, found), found


@pytest.mark.parametrize("names", ["total+sun_drag", "sun_drag+sun_drag"])
def test_a_loss_counts_once(read, names):
    column = GOOD.replace("run", "component").replace(",1\n", f",{names}\n")
    text = column.replace(",2\n", ",load_dependent+sun_drag\n")
    (problem,) = problems_of(read, text)
    assert (problem.allowed, problem.value) == ("counts a loss twice.", f'"{names}" in line 3')
    (problem,) = problems_of(read, GOOD, component=names)
    assert problem.allowed == "counts a loss twice."
    told = [it.allowed for it in problems_of(read, text, component="sun_drag")]
    assert told == ["is given together with a column of that name.", "counts a loss twice."]


def test_a_mistake_in_every_row_is_one_problem(read):
    rows = "".join(f"{speed},500,90,x,1\n" for speed in range(1000, 6000))
    header = "\n".join(GOOD.splitlines()[:2])
    (problem,) = problems_of(read, f"{header}\n{rows}")
    assert "and 4997 more" in problem.value


def test_a_table_in_memory_is_read_alike(talbot, read):
    frame = pd.DataFrame({"speed [rpm]": [1000], "torque [N*m]": [500.0],
                          "temperature [degC]": [90], "loss [W]": [np.nan]})  # fmt: skip
    with pytest.raises(ep.InputError, match="the table"):
        parse_measurements(read_grid(frame), talbot)
    frame["loss [W]"] = 400.0
    assert list(parse_measurements(read_grid(frame), talbot).loss) == [400]
