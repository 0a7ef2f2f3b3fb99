"""Where the rows of a duty cycle come from: CSV, Parquet, or a table in memory."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.case.wording import one_line, sentence
from epicyclic.errors import InputError, Problem
from epicyclic.maps.parquet_pages import largest_page

if TYPE_CHECKING:
    import pyarrow as pa

SUFFIXES = (".csv", ".parquet")
_BLOCK_BYTES = 1 << 22
_BATCH_ROWS, _PAGE_BYTES = 1 << 16, 1 << 20
LARGEST_PAGE = 16 * 10**6
"""Largest page of a Parquet file, unpacked: one of each column is in memory as a whole. [bytes]"""
_LONGEST_HEAD = 1 << 18
"""Bytes within which the header of a CSV file must end."""


@dataclass(frozen=True, slots=True)
class Source:
    """Rows in pieces that fit into memory."""

    name: str  # For messages.
    headers: tuple[str, ...]
    # Pieces of the columns of some headers, each an array of `pyarrow` by header.
    batches: Callable[[Sequence[str]], Iterator[Mapping[str, pa.Array]]]


def open_source(table: Any) -> Source:
    """The rows of a file, or of columns by name such as a `pandas.DataFrame`.

    Raises
    ------
    InputError
        If there is no such file, or nothing that can be read as a table.
    """
    if not isinstance(table, str | Path):
        return _from_memory(table)
    path = Path(table)
    if path.suffix.lower() not in SUFFIXES:
        allowed = f"must end in {' or '.join(SUFFIXES)}."
        raise _unreadable(str(path), allowed, "Choose one of these formats.")
    if not path.is_file():
        raise _unreadable(str(path), "is not a file.", "Check the name.")
    with _readable(str(path)):
        return _from_csv(path) if path.suffix.lower() == ".csv" else _from_parquet(path)


def _unreadable(name: str, allowed: str, remedy: str) -> InputError:
    return InputError([Problem("CYCLE", name, allowed, remedy)], "the command")


@contextmanager
def _readable(name: str) -> Iterator[None]:
    """What libraries raise for a file that they cannot read, as `InputError`."""
    import pyarrow as pa

    try:
        yield
    except (pa.ArrowException, OSError, UnicodeDecodeError, csv.Error) as error:
        reason = sentence(f"cannot be read: {one_line(str(error), 200)}", capital=False)
        raise _unreadable(name, reason, "Write it anew, as UTF-8 if it is text.") from None


def _from_memory(table: Any) -> Source:
    import pandas as pd
    import pyarrow as pa

    name = "the cycle"
    try:
        frame = table if isinstance(table, pd.DataFrame) else pd.DataFrame(table)
    except (TypeError, ValueError) as error:
        raise _unreadable("", f"is not a table: {one_line(str(error))}.", "Give a file.") from None
    columns = {}
    for position in range(frame.shape[1]):
        values = frame.iloc[:, position]
        try:
            columns[position] = pa.array(values, from_pandas=True)
        except pa.ArrowException:  # values of several kinds
            columns[position] = pa.array(values.astype(str))
    headers = tuple(str(header) for header in frame.columns)

    def batches(chosen: Sequence[str]) -> Iterator[Mapping[str, pa.Array]]:
        for start in range(0, len(frame), _BATCH_ROWS):
            yield {
                header: columns[headers.index(header)].slice(start, _BATCH_ROWS)
                for header in chosen
            }

    return Source(name, headers, batches)


def _from_parquet(path: Path) -> Source:
    import pyarrow.parquet as pq

    with pq.ParquetFile(path) as file:
        headers = tuple(file.schema_arrow.names)

    def batches(chosen: Sequence[str]) -> Iterator[Mapping[str, pa.Array]]:
        # a row group may hold all rows: it is read as its pages are needed, not as a whole
        with (
            _readable(str(path)),
            pq.ParquetFile(path, pre_buffer=False, buffer_size=_PAGE_BYTES) as file,
        ):
            largest = largest_page(path, file, chosen, LARGEST_PAGE)
            if largest > LARGEST_PAGE:
                raise _unreadable(str(path), *_too_large(largest))
            for batch in file.iter_batches(_BATCH_ROWS, columns=list(chosen)):
                yield {header: batch.column(header) for header in chosen}

    return Source(str(path), headers, batches)


def _too_large(page: int) -> tuple[str, str]:
    """What is allowed, and what to change."""
    allowed = (
        f"has a page of {page / 1e6:.0f} MB; pages of up to {LARGEST_PAGE / 1e6:.0f} MB are read."
    )
    return allowed, "Write it anew with pages of 1 MB, as most programs do by default."


def _from_csv(path: Path) -> Source:
    headers, lines = _csv_head(path)

    def batches(chosen: Sequence[str]) -> Iterator[Mapping[str, pa.Array]]:
        import pyarrow as pa
        from pyarrow import csv as arrow_csv

        # as text, so that what is not a number can be told from what is missing
        convert = arrow_csv.ConvertOptions(
            include_columns=list(chosen), column_types=dict.fromkeys(chosen, pa.string())
        )
        read = arrow_csv.ReadOptions(
            block_size=_BLOCK_BYTES, skip_rows=lines, column_names=list(headers)
        )
        with _readable(str(path)):
            if _is_at_end(path, lines):
                return
            with arrow_csv.open_csv(path, read_options=read, convert_options=convert) as reader:
                for batch in reader:
                    yield {header: batch.column(header) for header in chosen}

    return Source(str(path), headers, batches)


def _csv_head(path: Path) -> tuple[tuple[str, ...], int]:
    """The names of the columns, and the number of lines down to them."""
    with path.open("rb") as file:
        start = file.read(_LONGEST_HEAD)
    if b"\0" in start:
        allowed = "is not UTF-8 text; it holds zero bytes."
        raise _unreadable(str(path), allowed, "Save it as CSV in UTF-8.")
    head = start if len(start) < _LONGEST_HEAD else start[: start.rfind(b"\n")]
    lines = head.decode("utf-8-sig").splitlines()
    comments = 0
    while comments < len(lines) and lines[comments].startswith("#"):
        comments += 1
    if comments == len(lines):
        allowed = "has no line with the names of the columns."
        raise _unreadable(str(path), allowed, 'Begin it with "time [s],speed [rpm],torque [N*m]".')
    names = next(csv.reader([lines[comments]]))
    if len(names) == 1 and ";" in names[0]:
        allowed = "has columns that are separated by semicolons."
        raise _unreadable(str(path), allowed, "Separate them by commas, with decimal points.")
    return tuple(name.strip() for name in names), comments + 1


def _is_at_end(path: Path, lines: int) -> bool:
    """True if nothing follows the first `lines` lines."""
    with path.open("rb") as file:
        for _ in range(lines):
            file.readline()
        return not file.read(1)
