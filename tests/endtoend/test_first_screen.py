"""What `run` prints first: short, narrow, with the loss, its band and what matters most."""

import re
from functools import cache

import pytest

from epicyclic.show.summary import WIDTH
from frozen.command import SETTINGS, run_command

SET, TRAIN = 40, 55  # Lines at most.


@pytest.fixture(scope="module")
def screen(tmp_path_factory):
    """What `run` prints, of each case once."""
    folder = tmp_path_factory.mktemp("screens")

    @cache
    def printed(*arguments):
        done = run_command(("run", *arguments), folder)
        assert done.code == 0, done.errors
        return done.output

    return printed


@pytest.mark.parametrize(
    ("case", "changes", "lines"),
    [
        ("talbot-2012", (), SET),
        ("talbot-2012", ("models.temperatures=network", "thermal.oil_flow=3 l/min"), SET),
        ("talbot-2012", ("models.friction=schlenk", "operation.torque=47 N*m"), SET),
        ("talbot-2012", ("lubrication.method=drained", "sun.roughness=Ra 0.7 um"), SET),
        ("talbot-2012-pair", (), SET),
        ("talbot-2012-pair", ("operation.torque=312 N*m",), SET),
        ("train-eaxle", (), TRAIN),
        ("train-8hp70", ("operation.state=R",), TRAIN),
    ],
)
def test_the_first_screen_is_short_and_narrow(screen, case, changes, lines):
    text = screen(case, *(part for change in changes for part in ("--set", change)))
    printed = text.splitlines()
    assert 15 < len(printed) <= lines
    assert max(map(len, printed)) <= WIDTH
    assert not [line for line in printed if line != line.rstrip()]
    assert printed[-1].startswith("More: run --details")
    assert re.search(r"^total loss +\d", text, re.MULTILINE)


def test_numbers_of_a_row_and_the_band_have_the_same_digits(screen):
    text = screen("talbot-2012")
    total = re.search(r"^total loss +(\S+) W +95 % band (\S+) to (\S+) W$", text, re.MULTILINE)
    share = re.search(r"^efficiency +(\S+) % +95 % band (\S+) to (\S+) %$", text, re.MULTILINE)
    for found in (total, share):
        assert found
        value, low, high = map(float, found.groups())
        assert low < value < high
        assert len({len(number.partition(".")[2]) for number in found.groups()}) == 1
    row = next(line.split() for line in text.splitlines() if line.startswith("total  "))
    assert row[1] == total[1]


def test_the_widest_output_follows_the_terminal(epicyclic, monkeypatch):
    widths = []
    for columns in (60, 132):
        monkeypatch.setitem(SETTINGS, "COLUMNS", str(columns))
        text = epicyclic("run", "talbot-2012-pair", "--details").stdout
        widths.append(max(map(len, text.splitlines())))
        assert widths[-1] <= columns
    assert widths[0] < widths[1]


def test_warnings_come_by_the_watts_that_they_concern(screen):
    text = screen("train-eaxle").partition("Warnings (3 of ")[2]
    watts = [float(found) for found in re.findall(r"([\d.]+) W\b", text)]
    assert len(watts) == 3
    assert watts == sorted(watts, reverse=True)


def test_details_have_what_the_first_screen_leaves_out(screen):
    first, details = screen("train-eaxle"), screen("train-eaxle", "--details")
    for words in ("Single losses", "Shafts", "Sources", "Methods", "Limits of confidence"):
        assert words not in first
        assert words in details
    assert len(details.splitlines()) > 2 * TRAIN
