"""Pages on a terminal: tables that keep their numbers whole, however narrow it is."""

from __future__ import annotations

import os
import re
import sys
import textwrap
from collections.abc import Iterator, Sequence
from typing import TextIO, cast

from rich import box
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.padding import Padding
from rich.segment import Segment
from rich.table import Column, Table
from rich.text import Text

from epicyclic.dataclass import dataclass
from epicyclic.errors import printable_lines
from epicyclic.show import page

GAP = 3  # Between two columns, the spaces on both sides of a line that is not drawn.
LONGEST_WORD = 24
"""Longest word that stays whole; what is longer is an address, or a key with its table."""
SHORT_NAME = 12  # Longest name of a row that stays in one line, whatever its words.
FIRST_SHARE = 0.5  # Largest share of the width for the names in the first column.


@dataclass(frozen=True, slots=True)
class _Need:
    """Width that a column needs at least, for its longest word, and at most."""

    least: int
    most: int


class FittedTable(Table):
    """A table that a narrow terminal shows in parts, one below the other.

    Text wraps between words. Where that is not enough, the columns are shared out to several
    tables that all begin with the first column.
    """

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        needs = [_need_of(column) for column in self.columns]
        room = options.max_width + 1
        if sum(need.most + GAP for need in needs) <= room:
            yield from super().__rich_console__(console, options)
            return
        least, most = needs[0].least, needs[0].most
        first = min(most if most <= SHORT_NAME else least, int(FIRST_SHARE * room))
        rest = room - first - 2 * GAP
        needs = [_Need(min(need.least, rest), need.most) for need in needs]
        needs[0] = _Need(first, needs[0].most)
        for number, block in enumerate(_blocks(needs, room)):
            widths = _widths([needs[place] for place in block], room)
            part = self._part(block, widths, bool(number))
            yield from Table.__rich_console__(part, console, options)

    def _part(self, block: Sequence[int], widths: Sequence[int], continued: bool) -> Table:
        """Some of the columns, in the style of the whole."""
        part = plain_table("")
        part.title, part.show_header = None if continued else self.title, self.show_header
        chosen = [self.columns[place] for place in block]
        for column, width in zip(chosen, widths, strict=True):
            part.add_column(column.header, justify=column.justify, width=width, overflow="fold")
        cells = zip(*(column.cells for column in chosen), strict=True)
        for row, content in zip(self.rows, cells, strict=True):
            part.add_row(*content, style=row.style, end_section=row.end_section)
        return part


def _need_of(column: Column) -> _Need:
    """Room for the longest word and for the longest line of a column."""
    cells = (column.header, *column.cells)
    texts = [one.plain if isinstance(one, Text) else str(one) for one in cells]
    words = [cell_len(word) for text in texts for word in text.split()]
    lines = [cell_len(line) for text in texts for line in text.splitlines()]
    most = max(lines, default=1)
    return _Need(min(most if column.no_wrap else max(words, default=1), LONGEST_WORD, most), most)


def _blocks(needs: Sequence[_Need], room: int) -> Iterator[list[int]]:
    """Places of the columns of each part, the first one in all."""
    block, taken = [0], needs[0].least + GAP
    for place, need in enumerate(needs[1:], 1):
        if len(block) > 1 and taken + need.least + GAP > room:
            yield block
            block, taken = [0], needs[0].least + GAP
        block.append(place)
        taken += need.least + GAP
    yield block


def _widths(needs: Sequence[_Need], room: int) -> list[int]:
    """Widths of the columns of a part; what is left goes to those that want more."""
    widths = [need.least for need in needs]
    left = room - sum(widths) - GAP * len(needs)
    while left > 0 and any(width < need.most for width, need in zip(widths, needs, strict=True)):
        narrow = [n for n, need in enumerate(needs) if widths[n] < need.most]
        widths[min(narrow, key=lambda n: widths[n])] += 1
        left -= 1
    return widths


# Tables of results, libraries and comparisons for a terminal.

PIPE_WIDTH = 100
"""Width of tables that do not go to a terminal, unless COLUMNS says another. [characters]"""


class _Trimmed:
    """A file that gets every line without blanks at its end."""

    def __init__(self, file: TextIO) -> None:
        self._file = file

    def write(self, text: str) -> int:
        return self._file.write(_BLANKS.sub("", text))

    def flush(self) -> None:
        self._file.flush()


_BLANKS = re.compile("[ \t]+$", re.MULTILINE)


class _PlainConsole(Console):
    """A console that shows texts as they are: neither as markup nor as signs that control it."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None
    ) -> Iterator[Segment]:
        for segment in super().render(renderable, options):
            text = segment.text if segment.control else printable_lines(segment.text)
            yield segment._replace(text=text)


def terminal() -> Console:
    """The console for results, on standard output."""
    console = _PlainConsole(highlight=False, markup=False, emoji=False)
    if console.is_terminal:
        return console
    width = None if "COLUMNS" in os.environ else PIPE_WIDTH
    file = cast(TextIO, _Trimmed(sys.stdout))
    return _PlainConsole(highlight=False, markup=False, emoji=False, width=width, file=file)


def titled(title: str, *parts: RenderableType) -> RenderableType:
    """Parts with space between them, under a title."""
    return spaced(Text(title, style="bold"), *parts)


def spaced(*parts: RenderableType) -> RenderableType:
    """Parts with space between them."""
    texts = [Text(it) if isinstance(it, str) else it for it in parts]
    return Group(*(Padding(part, (0, 0, 1, 0)) for part in texts[:-1]), *texts[-1:])


def as_on_page(item: page.Table | page.Listing) -> RenderableType:
    """A table or list of a report, for a terminal."""
    if isinstance(item, page.Listing):
        return listed(item.title, item.items)
    columns = (
        Column(head, justify="right" if item.is_numeric(place) else "left")
        for place, head in enumerate(item.head)
    )
    table = plain_table("", *columns)
    for place, row in enumerate(item.rows):
        strong = place in item.strong
        table.add_row(
            *(cell.text for cell in row),
            style="bold" if strong else "",
            end_section=strong or item.strong == {place + 1},
        )
    title = [Text(item.title, style="bold")] if item.title else []
    return Group(*title, table, *([Text(item.note)] if item.note else []))


def listed(title: str, items: Sequence[str]) -> Group:
    """Sentences below a title."""
    if not items:
        return Group(Text(f"{title}: none"))
    head = [Text(title, style="bold")] if title else []
    return Group(*head, *map(Sentence, items))


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence of a list, with a bullet; numbers stay with their units."""

    text: str

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        lines = textwrap.wrap(
            _BEFORE_UNIT.sub(_NO_BREAK, self.text),
            options.max_width,
            initial_indent="• ",
            subsequent_indent="  ",
            break_long_words=False,
            break_on_hyphens=False,
        )
        yield Text("\n".join(lines).replace(_NO_BREAK, " "))


_NO_BREAK = "\N{NO-BREAK SPACE}"
_BEFORE_UNIT = re.compile(r"(?<=\d) (?=%|°|[kM]?W\b|N\b|[GM]?Pa\b|rpm\b|times\b|m/s)")


def plain_table(title: str, *columns: Column | str) -> FittedTable:
    """A table without rows in the style of the package."""
    return FittedTable(
        *columns,
        title=title,
        title_justify="left",
        title_style="bold",
        header_style="",
        box=box.SIMPLE_HEAD,
        pad_edge=False,
        show_edge=False,
    )


def number_table(
    title: str, first: str, *others: str, no_wrap: tuple[bool, bool] = (False, False)
) -> FittedTable:
    """A table for names, in its first column, and numbers; `no_wrap` of which of both."""
    numbers = (Column(head, justify="right", no_wrap=no_wrap[1]) for head in others)
    return plain_table(title, Column(first, no_wrap=no_wrap[0]), *numbers)
