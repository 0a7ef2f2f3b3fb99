"""Duty cycles: where their rows come from, and what their columns are."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import PydanticCustomError

from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.messages import one_line, sentence
from epicyclic.study.operating import OPERATING, STATE
from epicyclic.units import SECOND, Quantity

if TYPE_CHECKING:
    import pyarrow as pa


# Where the rows of a duty cycle come from: CSV, Parquet, or a table in memory.

SUFFIXES = (".csv", ".parquet")
_BLOCK_BYTES = 1 << 22
_BATCH_ROWS, _PAGE_BYTES = 1 << 16, 1 << 20
_LONGEST_HEAD = 1 << 18  # Bytes within which the header of a CSV file must end.


@dataclass(frozen=True, slots=True)
class Source:
    """Rows in pieces that fit into memory."""

    name: str  # For messages.
    headers: tuple[str, ...]
    # Pieces of the columns of some headers, each an array of `pyarrow` by header.
    batches: Callable[[Sequence[str]], Iterator[Mapping[str, pa.Array]]]


def open_source(table: Any) -> Source:
    """The rows of a file, or of columns by name such as a `pandas.DataFrame`.

    Raises `InputError` if there is no such file, or nothing that can be read as a table.
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
    return one_problem("CYCLE", name, allowed, remedy, "the command")


@contextmanager
def _readable(name: str) -> Iterator[None]:
    """What libraries raise for a file that they cannot read, as `InputError`."""
    import pyarrow as pa

    try:
        yield
    except (pa.ArrowException, OSError, UnicodeDecodeError, csv.Error) as error:
        reason = sentence(f"cannot be read: {one_line(str(error), 200)}", capital=False)
        raise _unreadable(name, reason, "Write it again, as UTF-8 if it is text.") from None


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
            for batch in file.iter_batches(_BATCH_ROWS, columns=list(chosen)):
                yield {header: batch.column(header) for header in chosen}

    return Source(str(path), headers, batches)


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
        allowed = "is not UTF-8 text; it contains zero bytes."
        raise _unreadable(str(path), allowed, "Save it as CSV in UTF-8.")
    head = start if len(start) < _LONGEST_HEAD else start[: start.rfind(b"\n")]
    lines = head.decode("utf-8-sig").splitlines()
    comments = 0
    while comments < len(lines) and lines[comments].startswith("#"):
        comments += 1
    if comments == len(lines):
        allowed = "has no line with the column names."
        raise _unreadable(str(path), allowed, 'Start it with "time [s],speed [rpm],torque [N*m]".')
    names = next(csv.reader([lines[comments]]))
    if len(names) == 1 and ";" in names[0]:
        allowed = "has columns separated by semicolons."
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
_MOST_STATES = 1000  # A column of more different texts is another one by that name, and left alone.
SUMS_TO_ONE = 1e-6  # Shares that sum to one but for this do so: it is rounding. [1]
SHARE_DURATION = 3600.0  # What a cycle of shares lasts. [s]


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
    whole: float = 1.0  # Sum of its shares, by which they are divided. [1]

    @property
    def title(self) -> str:
        """Its name, its rows, and the factor of shares whose sum is neither 1 nor 100 %."""
        told = f"{self.source.name}, {self.rows} rows"
        if any(math.isclose(self.whole, whole, rel_tol=SUMS_TO_ONE) for whole in (1.0, 100.0)):
            return told
        factor = 1 / self.whole
        return f"{told}; its shares sum to {self.whole:.6g}, not to 1: multiplied by {factor:.6g}"

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
    """Read a whole cycle once and check it; raises `InputError` with every problem found."""
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
    whole = checks.sums[SHARE] if weighting == SHARE else 1.0
    return Cycle(source, columns, weighting, checks.rows, ranges, states, whole)


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
    return Problem(name, shown, "appears more than once.", "Keep one.")


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
        allowed = "exclude each other."
        problems.append(Problem(" and ".join(weightings), "", allowed, "Keep one of them."))
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
                codes, texts = _texts(column)
                if len(self.states) <= _MOST_STATES:
                    self.states |= {texts[code]: None for code in dict.fromkeys(codes.tolist())}
                continue
            values = _numbers(column)
            bad = np.isnan(values)
            self._note(bad, column, _Fault(name, "must be a finite number.", "Correct the row."))
            if name == TIME:
                early = values <= np.append(self._last_time, values[:-1])
                allowed = "must be later than in the previous row."
                remedy = "Sort the rows and give each time once."
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
