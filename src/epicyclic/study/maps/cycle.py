"""Duty cycles: where their rows come from, and what their columns are."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.arrays import BoolArray, FloatArray, IntArray
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import Problem, first_of, raise_any
from epicyclic.messages import one_line
from epicyclic.study.operating import OPERATING, STATE
from epicyclic.study.table_file import (
    AS_IT_IS,
    COLUMNS,
    HEADER,
    Source,
    TableForm,
    missing_remedy,
    open_table,
    plain_numbers,
    unit_problem,
)
from epicyclic.study.table_file import Piece as TablePiece

# A cycle is a time series (a column of time) or a histogram (a column of durations or shares). It
# is read once to check it, which finds every problem, and once more for each use; it is never in
# memory as a whole.

TIME, DURATION, SHARE = "time", "duration", "share"
_WEIGHTINGS = (TIME, DURATION, SHARE)
_OPTIONAL = ("temperature", STATE)
_QUANTITIES = {name: COLUMNS[name][0] for name in (*OPERATING, STATE, *_WEIGHTINGS)}
_NUMBER = r"^[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$"
_WHOLE = re.compile(r"^(\d+)\.0+$")  # A number as spreadsheets write whole ones.
_SHOWN_HEADERS, _SHOWN_PARTS = 20, 6
_MOST_STATES = 1000  # A column of more different texts is another one by that name, and left alone.
_FINITE = "must be a finite number."
_EARLY = "must be later than in the row before."

SUMS_TO_ONE = 1e-6  # Shares that sum to one but for this do so: it is rounding. [1]
SHARE_DURATION = 3600.0  # What a cycle of shares lasts. [s]


def shares_text(whole: float) -> str:
    """What becomes of shares whose sum is not one."""
    return f"shares sum to {whole:.6g}, not to 1: multiplied by {1 / whole:.6g}"


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a cycle: its header, and what turns it into the display unit."""

    header: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Piece:
    """Some points of a cycle, with the time for which each stands."""

    speed: FloatArray  # In rpm, N m.
    torque: FloatArray  # In rpm, N m.
    temperature: FloatArray | None  # In degC; None if there is none.
    state: IntArray | None  # Numbers in `Cycle.states`; None if there is no such column.
    duration: FloatArray  # [s]


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

    def title(self, idle: Collection[str] = ()) -> str:
        """Its name, its rows, columns that count for nothing, the factor of shares to be scaled."""
        told = f"{self.source.name}, {self.rows} row{'' if self.rows == 1 else 's'}"
        used = {own.header for name, own in self.columns.items() if name not in idle}
        unused = [one_line(header) for header in self.source.headers if header not in used]
        told += f"; columns not used: {first_of(unused)}" if unused else ""
        if any(math.isclose(self.whole, whole, rel_tol=SUMS_TO_ONE) for whole in (1.0, 100.0)):
            return told
        return f"{told}; its {shares_text(self.whole)}"

    def pieces(self, celsius: float | None = None) -> Iterator[Piece]:
        """All points, at their own temperatures or at one.

        Of a time series each stands for half of the time to each neighbour, the trapezoidal rule.
        Rows at which two pieces meet are in both, each time with a part of their time.
        """
        last: dict[str, FloatArray] = {}
        for batch in self.source.batches([column.header for column in self.columns.values()]):
            rows = {
                name: column.factor * _numbers(self.source, column.header, batch) + column.offset
                for name, column in self.columns.items()
                if name != STATE
            }
            if self.states:
                rows[STATE] = self._state_numbers(batch.columns[self.columns[STATE].header])
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

    def _state_numbers(self, column: Any) -> FloatArray:
        place = {name: float(number) for number, name in enumerate(self.states)}
        codes, texts = _texts(column)
        return np.array([place.get(text, math.nan) for text in texts])[codes]


def open_cycle(
    # A file, or columns by name. Names carry units, ``"speed [rpm]"``.
    table: Any,
    # Called with the number of rows so far, and None for that of all rows.
    progress: Callable[[int, None], None] | None = None,
    form: TableForm = AS_IT_IS,
) -> Cycle:
    """Read a whole cycle once and check it; raises `InputError` with every problem found."""
    source = open_table(table, form)
    if not isinstance(table, str | Path):
        source = replace(source, name="the cycle")
    columns, problems = _find_columns(source.headers)
    checks = _Checks(source, columns)
    if columns:
        for batch in source.batches([column.header for column in columns.values()]):
            checks.add(batch)
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


def _find_columns(headers: tuple[str, ...]) -> tuple[dict[str, Column], list[Problem]]:
    """The columns that a cycle needs, in what there is; none of those that are not clear."""
    found: dict[str, list[tuple[str, str | None]]] = {name: [] for name in _QUANTITIES}
    for header in headers:
        match = HEADER.fullmatch(header.strip())
        if match is not None and match["name"].lower() in found:
            found[match["name"].lower()].append((header, match["unit"]))
    columns, problems = {}, []
    for name, candidates in found.items():
        if len(candidates) > 1:
            problems.append(_repeated(name, [header for header, _ in candidates]))
        elif candidates:
            try:
                # shares may have any unit: their sum is the whole
                quantity, (header, unit) = _QUANTITIES[name], candidates[0]
                how = () if quantity is None else quantity.scale_from(unit or "")
                columns[name] = Column(header, *how)
            except PydanticCustomError as error:
                problems.append(unit_problem(name, header, unit, quantity, error))
    return columns, problems + _missing(found, headers)


def _repeated(name: str, headers: list[str]) -> Problem:
    shown = ", ".join(f'"{one_line(header)}"' for header in headers)
    remedy = "Keep one."
    if len(set(headers)) == len(headers):  # else no option tells them apart
        remedy = f'Keep one, or choose it: --column "{name}=HEADER".'
    return Problem(name, shown, "appears more than once.", remedy)


def _missing(found: Mapping[str, list[Any]], headers: tuple[str, ...]) -> list[Problem]:
    """Columns that a cycle must have."""
    problems = []
    shown = ", ".join(f'"{one_line(header)}"' for header in headers[:_SHOWN_HEADERS])
    shown += ", ..." if len(headers) > _SHOWN_HEADERS else ""
    for name, quantity in _QUANTITIES.items():
        if name not in (*_WEIGHTINGS, *_OPTIONAL) and not found[name] and quantity is not None:
            remedy = missing_remedy("Name", name, quantity.display, headers)
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


def _numbers(source: Source, header: str, piece: TablePiece) -> FloatArray:
    """A column as numbers, NaN for what is not a finite number."""
    import pyarrow as pa
    import pyarrow.compute as pc

    column = piece.columns[header]
    if pa.types.is_dictionary(column.type):
        column = column.dictionary_decode()
    column = plain_numbers(source, header, column)
    kind = column.type
    if pa.types.is_string(kind) or pa.types.is_large_string(kind):
        column = pc.utf8_trim_whitespace(column)
        column = pc.if_else(pc.match_substring_regex(column, _NUMBER), column, None)
    elif not (pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_decimal(kind)):
        return np.full(len(column), np.nan)
    values = np.array(pc.cast(column, pa.float64(), safe=False), dtype=float)
    values[~np.isfinite(values)] = np.nan
    return values


def _texts(column: Any) -> tuple[IntArray, list[str]]:
    """A column of `pyarrow` as numbers of texts, and these; whole numbers without decimals."""
    import pyarrow as pa

    if not pa.types.is_dictionary(column.type):
        column = column.dictionary_encode(null_encoding="encode")
    texts = []
    for item in column.dictionary.to_pylist():
        whole = isinstance(item, float) and item.is_integer()
        text = "" if item is None else str(int(item) if whole else item).strip()
        texts.append(_WHOLE.sub(r"\1", text))
    codes = column.indices.fill_null(len(texts)).to_numpy(zero_copy_only=False).astype(np.intp)
    return codes, [*texts, ""]


_LEAST_SUM, _LARGEST_SUM = 1e-100, 1e100
"""Of shares or durations: numbers over these are finite, and energies too. [1], [s]"""


@dataclass(slots=True)
class _Fault:
    """Rows with one kind of mistake: how many, and the first."""

    name: str
    allowed: str
    remedy: str
    place: str  # What a row is called.
    count: int = 0
    line: int = 0
    value: str = ""

    def problem(self) -> Problem:
        more = f", and {self.count - 1} {self.place}s more" if self.count > 1 else ""
        given = f"{self.value} ({self.place} {self.line}{more})"
        return Problem(self.name, given, self.allowed, self.remedy)


@dataclass(slots=True)
class _Checks:
    """What is wrong with the rows of a cycle, and their ranges."""

    source: Source
    columns: Mapping[str, Column]
    rows: int = 0
    low: dict[str, float] = field(default_factory=dict)
    high: dict[str, float] = field(default_factory=dict)
    sums: dict[str, float] = field(default_factory=dict)
    states: dict[str, None] = field(default_factory=dict)
    _faults: dict[tuple[str, str], _Fault] = field(default_factory=dict)
    _last_time: float = -np.inf
    _last_line: int = 0
    _starts: list[int] = field(default_factory=list)  # Lines at which time starts again.
    _ends: list[int] = field(default_factory=list)  # Lines before these.

    def add(self, piece: TablePiece) -> None:
        """Take in a piece."""
        lines = piece.lines
        for name, own in self.columns.items():
            column = piece.columns[own.header]
            if name == STATE:
                codes, texts = _texts(column)
                if len(self.states) <= _MOST_STATES:
                    self.states |= {texts[code]: None for code in dict.fromkeys(codes.tolist())}
                continue
            values = _numbers(self.source, own.header, piece)
            bad = np.isnan(values)
            self._note(bad, column, lines, name, _FINITE, "Correct the row.")
            if name == TIME and values.size:
                before = np.append(self._last_time, values[:-1])
                lines_before = np.append(self._last_line, lines[:-1])
                same, early = values == before, values < before
                remedy = (
                    "Keep one of these rows; if the clock was set back, write times with their "
                    "distance from UTC."
                )
                self._note(same, column, lines, name, "must differ from the row before.", remedy)
                self._note(early, column, lines, name, _EARLY, "Sort the rows.")
                self._starts = self._starts or [int(lines[0])]
                if len(self._starts) <= _SHOWN_PARTS:
                    self._starts += lines[early].tolist()
                    self._ends += lines_before[early].tolist()
                self._last_time, self._last_line = values[-1], int(lines[-1])
            if name in (DURATION, SHARE):
                negative = "must not be negative."
                self._note(values < 0, column, lines, name, negative, "Correct the row.")
            sound = values[~bad]
            if sound.size:
                self.low[name] = min(self.low.get(name, np.inf), float(sound.min()))
                self.high[name] = max(self.high.get(name, -np.inf), float(sound.max()))
                with np.errstate(over="ignore"):  # `problems` tells of sums beyond all bounds
                    self.sums[name] = self.sums.get(name, 0.0) + float(sound.sum())
        self.rows += len(lines)

    def _note(
        self, bad: BoolArray, column: Any, lines: Any, name: str, allowed: str, remedy: str
    ) -> None:
        """Count rows with a mistake, and keep the first."""
        count = int(bad.sum())
        if not count:
            return
        first = int(bad.argmax())
        value = one_line(f'"{column[first].as_py()}"')
        if value == '""' and allowed == _FINITE:
            allowed, remedy = "is empty.", "Fill it, or delete the row."
        fault = self._faults.setdefault(
            (name, allowed),
            _Fault(name, allowed, remedy, self.source.place, 0, int(lines[first]), value),
        )
        fault.count += count

    def problems(self) -> list[Problem]:
        early = self._faults.get((TIME, _EARLY))
        parts = list(zip(self._starts, [*self._ends, self._last_line], strict=False))
        if early and len(parts) <= _SHOWN_PARTS and all(last > first for first, last in parts):
            split = first_of([f"--rows {first}-{last}" for first, last in parts], _SHOWN_PARTS)
            early.remedy = (
                f"If other recordings start there, run each by itself: {split}; else sort the rows."
            )
        found = [fault.problem() for fault in self._faults.values()]
        least = 2 if TIME in self.columns else 1
        if self.rows < least:
            there = "is 1 row" if self.rows == 1 else f"are {self.rows} rows"
            allowed = f"There {there}; a cycle needs {least} or more."
            found.append(Problem("", "", allowed, "Give more rows."))
        for name in (DURATION, SHARE):
            whole = self.sums.get(name, 0.0)
            if self.low.get(name, -1.0) < 0 or _LEAST_SUM <= whole <= _LARGEST_SUM:
                continue  # there is none, or its faults are told
            allowed, given = "is zero in all rows.", ""
            if whole:
                given, allowed = (
                    f"{whole:.3g} together",
                    "is next to nothing, or beyond all bounds.",
                )
            found.append(Problem(name, given, allowed, "Give positive values."))
        return found
