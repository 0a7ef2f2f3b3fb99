"""Tables as users keep them (CSV, Excel, Parquet) as rows of plain cells."""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.case.wording import one_line
from epicyclic.errors import InputError, first_of
from epicyclic.text_file import check_archive, csv_rows, decode, read_bytes, refuse

if TYPE_CHECKING:
    import pandas as pd

_NOUN = "measurement"
_LARGEST_FILE = 10_000_000
"""Largest file, also of what a compressed file holds. [bytes]"""
MOST_ROWS = 10_000
"""Every row is a computation; tables of more rows are recordings, to be averaged first."""
_MOST_COLUMNS = 200
_SHOWN_LINES = 5


@dataclass(frozen=True, slots=True)
class Grid:
    """Cells of a table."""

    header: tuple[str, ...]
    # Line in the file, or row of the sheet, and its cells; as many as the header has.
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    source: str  # Where it comes from.


def read_grid(path: Path) -> Grid:
    """The cells of a CSV, Excel (first sheet) or Parquet file.

    Raises
    ------
    InputError
        If it cannot be read as such, is empty, or has more than `MOST_ROWS` rows.
    """
    readers = {".xlsx": _excel_rows, ".parquet": _parquet_rows}
    reader = readers.get(path.suffix.lower(), _csv_rows)
    source = one_line(str(path), 500)
    try:
        return _checked(reader(read_bytes(path, _NOUN, _LARGEST_FILE)), source)
    except InputError as error:
        raise InputError(error.problems, source) from None


def read_frame(table: pd.DataFrame) -> Grid:
    """The cells of a table in memory; its rows are counted from 1. Errors as for `read_grid`."""
    return _checked(_frame_rows(table), "the table")


def _checked(rows: Iterator[tuple[int, list[str]]], source: str) -> Grid:
    """The grid of `rows`, the first of which is the header; raises `InputError`."""
    _, header = next(rows, (0, []))
    header = _without_end(header, 0)
    if not header:
        refuse("has no columns.", "Give a header such as: speed [rpm],torque [N*m],...")
    if len(header) > _MOST_COLUMNS:
        refuse(f"has more than {_MOST_COLUMNS} columns.", "Keep those that are compared.")
    kept = []
    for line, cells in rows:
        if any(cells):
            kept.append((line, tuple(_without_end(cells, len(header)))))
        if len(kept) > MOST_ROWS:
            refuse(f"has more than {MOST_ROWS} rows.", "Average what was recorded at one point.")
    if not kept:
        refuse("has no rows below its header.", "Give one row for each measurement.")
    ragged = [(line, len(cells)) for line, cells in kept if len(cells) != len(header)]
    if ragged:
        shown = first_of([f"line {line} has {count}" for line, count in ragged], _SHOWN_LINES)
        allowed = f"has {len(header)} columns, but {shown}."
        refuse(allowed, "Give every row as many cells; quote cells that contain the separator.")
    return Grid(tuple(header), tuple(kept), source)


def _without_end(cells: list[str], least: int) -> list[str]:
    """`cells` without the empty ones at the end, as spreadsheets leave them, but `least`."""
    count = len(cells)
    while count > least and not cells[count - 1]:
        count -= 1
    return cells[:count]


def _csv_rows(content: bytes) -> Iterator[tuple[int, list[str]]]:
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        refuse("is UTF-16 text.", "Save it as CSV in UTF-8.")
    return csv_rows(decode(content, _NOUN))


def _excel_rows(content: bytes) -> Iterator[tuple[int, list[str]]]:
    """Rows of the first sheet, with the values that formulas had when the file was saved."""
    import openpyxl

    remedy = "Save one small sheet as .xlsx, or as CSV."
    check_archive(content, "an Excel workbook", _LARGEST_FILE, remedy)
    try:
        book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
        rows = iter(book.worksheets[0].iter_rows(values_only=True))
        for number, row in enumerate(rows, 1):
            yield number, [_text(cell) for cell in row]
    except InputError:
        raise
    except Exception as error:  # the reader raises whatever its parsers do
        refuse(f"is no sound workbook: {one_line(str(error))}.", "Save it again, or as CSV.")


def _parquet_rows(content: bytes) -> Iterator[tuple[int, list[str]]]:
    import pyarrow.parquet as parquet

    try:
        file = parquet.ParquetFile(io.BytesIO(content))
        about = file.metadata
        groups = [about.row_group(number) for number in range(about.num_row_groups)]
        if about.num_rows > MOST_ROWS or sum(g.total_byte_size for g in groups) > _LARGEST_FILE:
            refuse(f"has more than {MOST_ROWS} rows or 10 MB.", "Average what was recorded.")
        table = file.read().to_pandas()
    except InputError:
        raise
    except Exception as error:  # the reader raises whatever its parsers do
        refuse(f"is no sound Parquet file: {one_line(str(error))}.", "Write it again, or as CSV.")
    yield from _frame_rows(table)


def _frame_rows(table: pd.DataFrame) -> Iterator[tuple[int, list[str]]]:
    yield 0, [str(name).strip() for name in table.columns]
    rows: Iterable[tuple[Any, ...]] = table.itertuples(index=False, name=None)
    for number, row in enumerate(rows, 1):
        yield number, [_text(cell) for cell in row]


def _text(cell: object) -> str:
    """A cell as text, numbers with all their digits."""
    return "" if cell is None else str(cell).strip()
