"""Tables that keep their numbers whole in narrow terminals."""

from __future__ import annotations

import re
from collections import Counter

import pytest
from rich.console import Console

from epicyclic.show.page import Cell as Text
from epicyclic.show.page import Listing, Table, number
from epicyclic.show.terminal import as_on_page

ROWS = tuple(
    (
        Text(f"planets, ring mesh sliding_{place}"),
        *(number(1234.567 * 1.7**power * (place + 1), "", 7) for power in range(7)),
        Text("Schlenk (1994), eq. 5.12 and Table 3.17"),
    )
    for place in range(4)
)
WIDE = Table(
    ("", *(f"share of loss {column}, W" for column in "ABCDEFG"), "source"),
    ROWS,
    "Losses of all parts",
    frozenset({3}),
)
NUMBER = re.compile(r"\d+(?:\.\d+)?")


def printed(item, width):
    console = Console(width=width, highlight=False)
    with console.capture() as capture:
        console.print(as_on_page(item))
    return capture.get()


@pytest.mark.parametrize("width", [40, 57, 80, 100])
def test_no_number_is_cut_or_left_out(width):
    text = printed(WIDE, width)
    assert all(len(line) <= width for line in text.splitlines())
    assert "…" not in text
    found, wanted = (Counter(NUMBER.findall(printed(WIDE, one))) for one in (width, 400))
    assert not {one: count for one, count in (wanted - found).items() if count}


def test_a_table_with_room_is_printed_as_a_whole():
    lines = printed(WIDE, 400).splitlines()
    assert sum("planets, ring mesh sliding_0" in line for line in lines) == 1
    assert len({len(line.rstrip()) for line in lines if "Schlenk" in line}) == 1


def test_every_part_begins_with_the_names():
    text = printed(WIDE, 57)
    parts = text.count("sliding_0")
    assert parts > 1
    assert parts == text.count("sliding_3")
    assert text.count("Losses of all parts") == 1


def test_lists_wrap_between_words():
    text = printed(Listing(("the bearing of the second planet carries 1234.567 N",), "Notes"), 40)
    assert "1234.567" in text
    assert all(len(line) <= 40 for line in text.splitlines())
