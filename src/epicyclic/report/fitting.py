"""Tables of a terminal that keep their numbers whole, however narrow it is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Column, Table
from rich.text import Text

GAP = 3
"""Between two columns, the spaces on both sides of a line that is not drawn."""
LONGEST_WORD = 24
"""Longest word that stays whole; what is longer is an address, or a key with its table."""
FIRST_SHARE = 0.5
"""Largest share of the width for the names in the first column."""


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
        first = min(needs[0].least, int(FIRST_SHARE * room))
        rest = room - first - 2 * GAP
        needs = [_Need(min(need.least, rest), need.most) for need in needs]
        needs[0] = _Need(first, needs[0].most)
        for number, block in enumerate(_blocks(needs, room)):
            widths = _widths([needs[place] for place in block], room)
            part = self._part(block, widths, bool(number))
            yield from Table.__rich_console__(part, console, options)

    def _part(self, block: Sequence[int], widths: Sequence[int], continued: bool) -> Table:
        """Some of the columns, in the style of the whole."""
        part = Table(
            title=None if continued else self.title,
            title_justify=self.title_justify,
            title_style=self.title_style,
            header_style=self.header_style,
            box=self.box,
            pad_edge=self.pad_edge,
            show_header=self.show_header,
        )
        chosen = [self.columns[place] for place in block]
        for column, width in zip(chosen, widths, strict=True):
            part.add_column(column.header, justify=column.justify, width=width, overflow="fold")
        cells = zip(*(column.cells for column in chosen), strict=True)
        for row, content in zip(self.rows, cells, strict=True):
            part.add_row(*content, style=row.style, end_section=row.end_section)
        return part


def _need_of(column: Column) -> _Need:
    """Room for the longest word and for the longest line of a column."""
    texts = [_plain(one) for one in (column.header, *column.cells)]
    words = [cell_len(word) for text in texts for word in text.split()]
    lines = [cell_len(line) for text in texts for line in text.splitlines()]
    most = max(lines, default=1)
    return _Need(min(most if column.no_wrap else max(words, default=1), LONGEST_WORD, most), most)


def _plain(cell: object) -> str:
    return cell.plain if isinstance(cell, Text) else str(cell)


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
        smallest = min(narrow, key=lambda n: widths[n])
        widths[smallest] += 1
        left -= 1
    return widths
