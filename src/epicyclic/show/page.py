"""What pages and terminals show: numbers, tables, lists, figures, chapters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import chain
from typing import Any

from epicyclic.dataclass import dataclass
from epicyclic.units import format_number, percent

# Numbers and units as tables show them.

MISSING = "-"  # Stands where there is no number.

_ROUNDING_NOISE = 1e-9
"""What is smaller, in any unit that tables use, is left over from rounding and shown as 0."""
_SMALLEST_ERROR = 1e-4  # Of what is computed, that has digits. [1]


def shown(value: float, digits: int = 4) -> str:
    """`value` with up to `digits` significant digits."""
    if math.isnan(value):
        return MISSING
    return format_number(0.0 if abs(value) < _ROUNDING_NOISE else value, digits)


def error_text(share: float) -> str:
    """The error of a balance or an interpolation, as a share of one."""
    if math.isnan(share):
        return MISSING
    return percent(share, 2) if abs(share) >= _SMALLEST_ERROR else "under 0.01 %"


# What a page of a report consists of.

SHORT = 6  # Lines of a table that is not divided between pages.
LINE = 60  # Characters of a cell that stand in one line, about.


@dataclass(frozen=True, slots=True)
class Cell:
    """Text of a cell; a number has its exact value and its place in the JSON form beside it."""

    text: str
    value: float | None = None
    key: str = ""
    about: str = ""

    @property
    def is_number(self) -> bool:
        """True if it is aligned as numbers are."""
        return self.value is not None or self.text == MISSING

    @property
    def style(self) -> str:
        """Classes of the style sheet."""
        return " ".join(filter(None, ("number" if self.is_number else "", self.about)))


def number(value: float | None, key: str, digits: int = 4, text: str = "") -> Cell:
    """A cell that shows `value`, as `text` if that is given."""
    if value is None:
        return Cell(MISSING)
    return Cell(text or shown(value, digits), value + 0.0, key)  # no -0.0


def tenths(value: float | None, key: str = "") -> Cell:
    """A cell that shows `value` with one decimal, as that of watts."""
    return number(value, key, text="" if value is None else f"{value:z.1f}")


def aligned(text: str) -> Cell:
    """A cell of `text` that is aligned as numbers are."""
    return Cell(text, math.nan)


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of cells under a head; rows in `strong` are sums; `widths` of the columns in percent."""

    head: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    title: str = ""
    strong: frozenset[int] = frozenset()
    note: str = ""
    widths: tuple[int, ...] = ()
    kind: str = "table"

    @property
    def is_short(self) -> bool:
        """True if it stays on one page."""
        lines = (math.ceil(max(len(cell.text) for cell in row) / LINE) for row in self.rows)
        return sum(lines) <= SHORT

    def is_numeric(self, column: int) -> bool:
        """True for a column of numbers."""
        return any(row[column].value is not None for row in self.rows)


@dataclass(frozen=True, slots=True)
class Listing:
    """Sentences, one below the other."""

    items: tuple[str, ...]
    title: str = ""
    kind: str = "listing"


@dataclass(frozen=True, slots=True)
class Drawing:
    """A figure: a still one, the data of one to explore if there is such, and what it is of."""

    name: str
    title: str
    svg: str
    plot: dict[str, Any] | None = None
    point: str = ""


@dataclass(frozen=True, slots=True)
class Gallery:
    """Figures side by side, or wide ones below each other."""

    drawings: tuple[Drawing, ...]
    is_wide: bool = False
    kind: str = "gallery"


@dataclass(frozen=True, slots=True)
class Row:
    """A table and what stands beside it."""

    items: tuple[Table | Gallery, ...]
    kind: str = "row"


@dataclass(frozen=True, slots=True)
class KeyFigure:
    """A number at the head of the page."""

    label: str
    cell: Cell
    unit: str = ""
    band: str = ""  # Ends of its 95 % interval; empty if they are not known.

    @property
    def text(self) -> str:
        """The number with its unit."""
        return f"{self.cell.text} {self.unit}".rstrip()


@dataclass(frozen=True, slots=True)
class Explorer:
    """Sliders, table, curve and map, which the script of the page makes from `contents`."""

    contents: Mapping[str, Any]
    kind: str = "explorer"


Item = Table | Listing | Gallery | Row | Explorer


@dataclass(frozen=True, slots=True)
class Section:
    """A chapter of the page."""

    name: str
    title: str
    items: tuple[Item, ...]
    lead: str = ""

    @property
    def needs_script(self) -> bool:
        """True if there is nothing to see until the script of the page has run, as in print."""
        return any(isinstance(item, Explorer) for item in self.items)


Drawings = Mapping[str, Sequence[Drawing]]  # The figures of every plot, by its name.


def gallery(drawings: Drawings, *names: str, wide: bool = False) -> tuple[Gallery, ...]:
    """One gallery of all figures of the plots `names`; none if there are none."""
    found = tuple(chain.from_iterable(drawings.get(name, ()) for name in names))
    return (Gallery(found, wide),) if found else ()
