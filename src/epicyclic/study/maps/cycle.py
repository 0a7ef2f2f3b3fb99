"""Duty cycles: where their rows come from, and what their columns are."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from epicyclic.case.messages import one_line, sentence
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.study.operating import OPERATING, STATE
from epicyclic.units import SECOND, Quantity

if TYPE_CHECKING:
    import pyarrow as pa
    import pyarrow.parquet as pq


# Sizes of the pages of a Parquet file: a page is read as a whole, however large it is.
#
# Readers offer the sizes of columns only. Those of pages stand in their headers, in the compact
# form of Apache Thrift: https://github.com/apache/parquet-format, parquet.thrift, ``struct
# PageHeader``.


LARGEST_HEADER = 1 << 16
"""Bytes within which the header of a page must end; most have some twenty."""
_STOP, _TRUE, _FALSE, _BYTE, _DOUBLE, _BINARY, _STRUCT = 0, 1, 2, 3, 7, 8, 12
_LISTS = (9, 10)
_DEEPEST = 20


def largest_page(
    path: Path,
    file: pq.ParquetFile,  # The same, open.
    columns: Iterable[str],
    enough: int,  # Size up to which it does not matter; columns of no more are not looked into.
) -> int:
    """Size of the largest page of some columns, unpacked, or of the first beyond `enough`. [bytes]

    Raises
    ------
    ArrowInvalid
        If the header of a page cannot be read.
    """
    wanted, largest = set(columns), 0
    with path.open("rb") as source:
        for group in range(file.metadata.num_row_groups):
            for number in range(file.metadata.num_columns):
                chunk = file.metadata.row_group(group).column(number)
                if chunk.path_in_schema.split(".")[0] not in wanted:
                    continue
                if max(chunk.total_uncompressed_size, chunk.total_compressed_size) <= enough:
                    continue
                largest = max(largest, _largest_of(source, chunk, enough))
                if largest > enough:
                    return largest
    return largest


def _largest_of(source: BinaryIO, chunk: pq.ColumnChunkMetaData, enough: int) -> int:
    """Size of the largest page of one column of a row group."""
    place = chunk.data_page_offset
    if chunk.has_dictionary_page and chunk.dictionary_page_offset:
        place = min(place, chunk.dictionary_page_offset)
    end, largest = place + chunk.total_compressed_size, 0
    while place < end:
        source.seek(place)
        header = _Compact(source.read(LARGEST_HEADER))
        unpacked, packed = header.sizes()
        largest = max(largest, unpacked, packed)
        if largest > enough:
            break
        place += header.place + packed
    return largest


def _invalid(what: str) -> Exception:
    import pyarrow as pa

    error: Exception = pa.ArrowInvalid(f"the header of a page {what}")
    return error


class _Compact:
    """The little of the compact form of Thrift that headers of pages need."""

    def __init__(self, content: bytes) -> None:
        self._content, self.place = content, 0

    def sizes(self) -> tuple[int, int]:
        """Unpacked and packed size of the page whose header this is: fields 2 and 3."""
        found = {}
        for field, kind in self._fields():
            if field in (2, 3):
                found[field] = self._number()
            else:
                self._skip(kind, 0)
        if min(found.get(2, -1), found.get(3, -1)) < 0:
            raise _invalid("has no sizes")
        return found[2], found[3]

    def _fields(self) -> Iterable[tuple[int, int]]:
        """Number and kind of each field of a struct; what follows it must be read in between."""
        field = 0
        while (head := self._byte()) & 0x0F != _STOP:
            field = field + (head >> 4) if head >> 4 else self._number()
            yield field, head & 0x0F

    def _byte(self) -> int:
        if self.place >= len(self._content):
            raise _invalid("does not end")
        self.place += 1
        return self._content[self.place - 1]

    def _varint(self) -> int:
        value = shift = 0
        while True:
            byte = self._byte()
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    def _number(self) -> int:
        """A signed whole number."""
        value = self._varint()
        return (value >> 1) ^ -(value & 1)

    def _skip(self, kind: int, depth: int) -> None:
        """Go past a value."""
        if depth > _DEEPEST:
            raise _invalid("is too deep")
        if kind in (_TRUE, _FALSE):
            return
        if kind == _BYTE:
            self.place += 1
        elif kind == _DOUBLE:
            self.place += 8
        elif kind == _BINARY:
            length = self._varint()
            self.place += length
        elif kind == _STRUCT:
            for _, inner in self._fields():
                self._skip(inner, depth + 1)
        elif kind in _LISTS:
            head = self._byte()
            for _ in range(self._varint() if head >> 4 == 15 else head >> 4):
                self._skip_entry(head & 0x0F, depth)
        elif kind in (4, 5, 6):
            self._varint()
        else:
            raise _invalid("holds something unknown")

    def _skip_entry(self, kind: int, depth: int) -> None:
        """Go past an entry of a list, where truths take a byte."""
        self._skip(_BYTE if kind in (_TRUE, _FALSE) else kind, depth + 1)


# Where the rows of a duty cycle come from: CSV, Parquet, or a table in memory.


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


# Duty cycles: what the columns of their tables are, and their points in pieces.
#
# A cycle is a time series (a column of time) or a histogram (a column of durations or shares). It
# is read once to check it, which finds every problem, and once more for each use; it is never in
# memory as a whole.


Array = NDArray[np.float64]

TIME, DURATION, SHARE = "time", "duration", "share"
_WEIGHTINGS = (TIME, DURATION, SHARE)
_OPTIONAL = ("temperature", STATE)
_QUANTITIES: dict[str, Quantity | None] = {
    **{name: part.quantity for name, part in OPERATING.items()},
    STATE: None,
    TIME: SECOND,
    DURATION: SECOND,
    SHARE: None,
}
_HEADER = re.compile(r"(?P<name>[^\[\]]+?)\s*(?:\[(?P<unit>[^\[\]]*)\])?")
_NUMBER = r"^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$"
_SHOWN_HEADERS = 20
_MOST_STATES = 1000
"""A column of more different texts is another one by that name, and left alone."""
SHARE_DURATION = 3600.0
"""What a cycle of shares lasts. [s]"""


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a cycle: its header, and what turns it into the display unit."""

    header: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Piece:
    """Some points of a cycle, with the time for which each stands."""

    speed: Array  # In rpm, N m.
    torque: Array  # In rpm, N m.
    temperature: Array | None  # In degC; None if there is none.
    state: NDArray[np.intp] | None  # Numbers in `Cycle.states`; None if there is no such column.
    duration: Array  # [s]


@dataclass(frozen=True, slots=True)
class Cycle:
    """A checked duty cycle."""

    source: Source
    columns: Mapping[str, Column]  # By quantity.
    weighting: str  # ``"time"``, ``"duration"`` or ``"share"``.
    rows: int
    # Smallest and largest value of every quantity, in display units.
    ranges: Mapping[str, tuple[float, float]]
    # What its column of states has, in the order in which it appears; none without the column.
    states: tuple[str, ...] = ()

    def pieces(self, celsius: float | None = None) -> Iterator[Piece]:
        """All points, at their own temperatures or at one.

        Of a time series each stands for half of the time to each neighbour, the trapezoidal rule.
        Rows at which two pieces meet are in both, each time with a part of their time.
        """
        last: dict[str, Array] = {}
        for batch in self.source.batches([column.header for column in self.columns.values()]):
            rows = {
                name: column.factor * _numbers(batch[column.header]) + column.offset
                for name, column in self.columns.items()
                if name != STATE
            }
            if self.states:
                rows[STATE] = self._state_numbers(batch[self.columns[STATE].header])
            if self.weighting == TIME:
                rows = {name: np.append(last.get(name, []), rows[name]) for name in rows}
                last = {name: values[-1:] for name, values in rows.items()}
                steps = np.diff(rows[TIME])
                duration = (np.append(steps, 0.0) + np.append(0.0, steps)) / 2
            else:
                duration = rows[self.weighting]
            speed, temperature = rows["speed"], rows.get("temperature")
            if celsius is not None:
                temperature = np.full_like(speed, celsius)
            state = rows[STATE].astype(np.intp) if self.states else None
            yield Piece(speed, rows["torque"], temperature, state, duration)

    def _state_numbers(self, column: Any) -> Array:
        """Numbers of the states in a column."""
        place = {name: float(number) for number, name in enumerate(self.states)}
        codes, texts = _texts(column)
        return np.array([place.get(text, math.nan) for text in texts])[codes]


def open_cycle(
    # A file that ends in .csv or .parquet, or columns by name. Names carry units, ``"speed
    # [rpm]"``.
    table: Any,
    # Called with the number of rows so far, and None for that of all rows.
    progress: Callable[[int, None], None] | None = None,
) -> Cycle:
    """Read a whole cycle once and check it.

    Raises
    ------
    InputError
        With every problem found.
    """
    source = open_source(table)
    columns, problems = _find_columns(source.headers)
    checks = _Checks(columns)
    if columns:
        for batch in source.batches([column.header for column in columns.values()]):
            checks.add({name: batch[column.header] for name, column in columns.items()})
            if progress is not None:
                progress(checks.rows, None)
        problems += checks.problems()
    raise_any(problems, source.name)
    (weighting,) = (name for name in _WEIGHTINGS if name in columns)
    if weighting == SHARE:
        columns[SHARE] = Column(columns[SHARE].header, SHARE_DURATION / checks.sums[SHARE])
    if len(checks.states) > _MOST_STATES:
        del columns[STATE]
    ranges = {
        name: (
            column.factor * checks.low[name] + column.offset,
            column.factor * checks.high[name] + column.offset,
        )
        for name, column in columns.items()
        if name != STATE
    }
    states = tuple(checks.states) if STATE in columns else ()
    return Cycle(source, columns, weighting, checks.rows, ranges, states)


# --- headers --------------------------------------------------------------------------------------


def _find_columns(headers: tuple[str, ...]) -> tuple[dict[str, Column], list[Problem]]:
    """The columns that a cycle needs, in what there is; none of those that are not clear."""
    found: dict[str, list[tuple[str, str | None]]] = {name: [] for name in _QUANTITIES}
    for header in headers:
        match = _HEADER.fullmatch(header.strip())
        if match is not None and match["name"].lower() in found:
            found[match["name"].lower()].append((header, match["unit"]))
    columns, problems = {}, []
    for name, candidates in found.items():
        if len(candidates) > 1:
            problems.append(_repeated(name, [header for header, _ in candidates]))
        elif candidates:
            try:
                columns[name] = _column(*candidates[0], _QUANTITIES[name])
            except PydanticCustomError as error:
                problems.append(_unit_problem(name, candidates[0][0], error))
    return columns, problems + _missing(found, headers)


def _column(header: str, unit: str | None, quantity: Quantity | None) -> Column:
    if quantity is None:
        return Column(header)  # shares of any unit: their sum is the whole
    return Column(header, *quantity.scale_from(unit or ""))


def _repeated(name: str, headers: list[str]) -> Problem:
    shown = ", ".join(f'"{one_line(header)}"' for header in headers)
    return Problem(name, shown, "is there more than once.", "Leave one.")


def _unit_problem(name: str, header: str, error: PydanticCustomError) -> Problem:
    quantity = _QUANTITIES[name]
    unit = quantity.display if quantity is not None else ""
    allowed = sentence(error.message(), capital=False)
    return Problem(name, f'"{one_line(header)}"', allowed, f'Call it "{name} [{unit}]".')


def _missing(found: Mapping[str, list[Any]], headers: tuple[str, ...]) -> list[Problem]:
    """Columns that a cycle must have."""
    problems = []
    shown = ", ".join(f'"{one_line(header)}"' for header in headers[:_SHOWN_HEADERS])
    shown += ", ..." if len(headers) > _SHOWN_HEADERS else ""
    for name, quantity in _QUANTITIES.items():
        if name not in (*_WEIGHTINGS, *_OPTIONAL) and not found[name] and quantity is not None:
            remedy = f'Name a column "{name} [{quantity.display}]".'
            problems.append(Problem(name, "", f"is not among the columns {shown}.", remedy))
    weightings = [name for name in _WEIGHTINGS if found[name]]
    if not weightings:
        allowed = "none of them is among the columns."
        remedy = 'Name a column "time [s]" in a time series; "duration [s]" or "share" otherwise.'
        problems.append(Problem("time, duration, share", "", allowed, remedy))
    if len(weightings) > 1:
        allowed = "are there together."
        problems.append(Problem(" and ".join(weightings), "", allowed, "Leave one of them."))
    return problems


# --- values ---------------------------------------------------------------------------------------


def _numbers(column: Any) -> Array:
    """A column of `pyarrow` as numbers, NaN for what is not a finite number."""
    import pyarrow as pa
    import pyarrow.compute as pc

    kind = column.type
    if pa.types.is_dictionary(kind):
        column, kind = column.dictionary_decode(), kind.value_type
    if pa.types.is_string(kind) or pa.types.is_large_string(kind):
        column = pc.utf8_trim_whitespace(column)
        column = pc.if_else(pc.match_substring_regex(column, _NUMBER), column, None)
    elif not (pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind)):
        return np.full(len(column), np.nan)
    values = np.array(pc.cast(column, pa.float64(), safe=False), dtype=float)
    values[~np.isfinite(values)] = np.nan
    return values


def _texts(column: Any) -> tuple[NDArray[np.intp], list[str]]:
    """A column of `pyarrow` as numbers of texts, and these; whole numbers without decimals."""
    import pyarrow as pa

    if not pa.types.is_dictionary(column.type):
        column = column.dictionary_encode(null_encoding="encode")
    texts = []
    for item in column.dictionary.to_pylist():
        whole = isinstance(item, float) and item.is_integer()
        texts.append("" if item is None else str(int(item) if whole else item).strip())
    codes = column.indices.fill_null(len(texts)).to_numpy(zero_copy_only=False).astype(np.intp)
    return codes, [*texts, ""]


@dataclass(slots=True)
class _Fault:
    """Rows with one kind of mistake: how many, and the first."""

    name: str
    allowed: str
    remedy: str
    count: int = 0
    row: int = 0
    value: str = ""

    def problem(self) -> Problem:
        more = f", and {self.count - 1} rows more" if self.count > 1 else ""
        return Problem(self.name, f"{self.value} (row {self.row}{more})", self.allowed, self.remedy)


class _Checks:
    """What is wrong with the rows of a cycle, and their ranges."""

    def __init__(self, columns: Mapping[str, Column]) -> None:
        self.columns = columns
        self.rows = 0
        self.low = dict.fromkeys(columns, np.inf)
        self.high = dict.fromkeys(columns, -np.inf)
        self.sums = dict.fromkeys(columns, 0.0)
        self.states: dict[str, None] = {}
        self._faults: dict[tuple[str, str], _Fault] = {}
        self._last_time = -np.inf

    def add(self, batch: Mapping[str, Any]) -> None:
        """Take in a piece; arrays of `pyarrow` by quantity."""
        for name, column in batch.items():
            if name == STATE:
                self._add_states(column)
                continue
            values = _numbers(column)
            bad = np.isnan(values)
            self._note(bad, column, _Fault(name, "must be a finite number.", "Correct the row."))
            if name == TIME:
                early = values <= np.append(self._last_time, values[:-1])
                allowed = "must be later than in the row before."
                remedy = "Sort the rows, and give each time once."
                self._note(early, column, _Fault(name, allowed, remedy))
                self._last_time = values[-1] if values.size else self._last_time
            if name in (DURATION, SHARE):
                fault = _Fault(name, "must not be negative.", "Correct the row.")
                self._note(values < 0, column, fault)
            sound = values[~bad]
            if sound.size:
                self.low[name] = min(self.low[name], float(sound.min()))
                self.high[name] = max(self.high[name], float(sound.max()))
                self.sums[name] += float(sound.sum())
        self.rows += len(column)

    def _add_states(self, column: Any) -> None:
        codes, texts = _texts(column)
        if len(self.states) <= _MOST_STATES:
            self.states |= {texts[code]: None for code in dict.fromkeys(codes.tolist())}

    def _note(self, bad: NDArray[np.bool_], column: Any, fault: _Fault) -> None:
        """Count rows with a mistake; `fault` is what to keep of the first."""
        count = int(bad.sum())
        if count:
            kept = self._faults.setdefault((fault.name, fault.allowed), fault)
            if kept is fault:
                first = int(bad.argmax())
                fault.row = self.rows + first + 1
                fault.value = one_line(f'"{column[first].as_py()}"')
            kept.count += count

    def problems(self) -> list[Problem]:
        found = [fault.problem() for fault in self._faults.values()]
        least = 2 if TIME in self.columns else 1
        if self.rows < least:
            allowed = f"There are {self.rows} rows; a cycle needs {least} or more."
            found.append(Problem("", "", allowed, "Give more rows."))
        for name in (DURATION, SHARE):
            if self.rows and name in self.columns and not self.sums[name] > 0:
                found.append(Problem(name, "", "is zero in all rows.", "Give positive values."))
        return found
