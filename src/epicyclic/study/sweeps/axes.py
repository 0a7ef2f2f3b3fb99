"""What a sweep varies: axes of keys and values, and tables of points."""

from __future__ import annotations

import io
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import islice
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.case.case import Case
from epicyclic.case.fields import all_keys, is_array, is_named, is_text, quantity_of, table_of
from epicyclic.case.keys import field_at, known_keys
from epicyclic.case.nearest import did_you_mean
from epicyclic.case.plain import plain
from epicyclic.case.values import parse_value
from epicyclic.case.wording import one_line, refused, written
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.files import read_text, refuse
from epicyclic.units import Quantity

if TYPE_CHECKING:
    import pandas as pd


# Axes of a sweep: keys and their values, alone or changing together.

MOST_POINTS = 1_000_000
"""Rows of more points do not fit into memory."""
ROW = "row"
"""Dimension of a table of points, which counts its rows from 1."""
_LARGEST_WHOLE = 2**53
"""Larger whole numbers are no exact coordinates."""


@dataclass(frozen=True, slots=True)
class Axis:
    """One dimension of a sweep: a key and its values."""

    key: str  # Dotted key of the case, or `ROW`.
    values: tuple[Any, ...]  # As a case file has them.
    coordinate: tuple[float | str, ...]  # The same as numbers in `unit`, or as names.
    unit: str  # Display unit; ``"1"`` for pure numbers, empty for names.
    together: tuple[Axis, ...] = ()  # Other keys, whose values change with these.

    @property
    def keys(self) -> tuple[Axis, ...]:
        """All that changes along it, each by itself."""
        return self.together if self.key == ROW else (replace(self, together=()), *self.together)

    def describe(self) -> dict[str, Any]:
        """As JSON holds it."""
        content = asdict(self)
        together = [axis.describe() for axis in self.together]
        del content["together"]
        return content | ({"together": together} if together else {})

    @classmethod
    def again(cls, content: Mapping[str, Any]) -> Self:
        """The axis that `describe` described."""
        return cls(
            content["key"],
            tuple(content["values"]),
            tuple(content["coordinate"]),
            content["unit"],
            tuple(map(cls.again, content.get("together", ()))),
        )


def listed(values: Any) -> list[Any]:
    """`values` as a list; anything that is one value by itself as a list of it."""
    if isinstance(values, str | Mapping):
        return [values]
    try:
        return list(islice(values, MOST_POINTS + 1))
    except TypeError:
        return [values]


def too_many(key: str, count: int) -> Problem:
    """What is wrong with that many points."""
    allowed = f"must have {MOST_POINTS} points or fewer, not {count}."
    return Problem(key, "", allowed, "Give fewer values.")


def make_axis(
    case: Case, key: str, values: list[Any], *, repeated: bool = False
) -> tuple[Axis | None, list[Problem]]:
    """The axis of one key, and what is wrong with it; values may be `repeated` beside others."""
    field = field_at(case, key)
    unsuitable = field_problem(case, key)
    if field is None or unsuitable is not None:
        return None, [unsuitable] if unsuitable else []
    if not values:
        return None, [Problem(key, "", "has no values.", "Give at least one.")]
    quantity = quantity_of(*field)
    if is_text(field[0]):  # a name may be a bare number
        values = [str(value) if isinstance(value, Integral) else value for value in values]
    coordinate: list[float | str] = []
    problems = []
    for value in values:
        try:
            coordinate.append(coordinate_of(value, quantity))
        except PydanticCustomError as error:
            problems.append(refused(error, key, written(value)))
    if not problems and not repeated and len(set(coordinate)) < len(coordinate):
        problems.append(Problem(key, "", "has the same value twice.", "Give each value once."))
    if problems:
        return None, _one_for_alike(problems)
    if any(isinstance(item, str) for item in coordinate):
        coordinate = [str(item) for item in coordinate]
        unit = ""
    else:
        unit = unit_of(case, key)
    return Axis(key, tuple(map(plain, values)), tuple(coordinate), unit), []


def unit_of(case: Case, key: str) -> str:
    """Display unit of a key that holds a number."""
    field = field_at(case, key)
    quantity = None if field is None else quantity_of(*field)
    return "1" if quantity is None else quantity.display


def make_group(case: Case, group: Mapping[str, Iterable[Any]]) -> tuple[Axis | None, list[Problem]]:
    """The axis of keys whose values change together, named after the first; its problems."""
    columns = {str(key): listed(values) for key, values in group.items()}
    axes, problems = _columns(case, columns, first=True)
    if problems:
        return None, problems
    leading, *others = axes
    return replace(leading, together=tuple(others)), []


def make_rows(
    case: Case, columns: Mapping[str, Iterable[Any]]
) -> tuple[Axis | None, list[Problem]]:
    """The axis of a table of points, by its columns; its problems."""
    axes, problems = _columns(case, {str(key): listed(it) for key, it in columns.items()})
    if problems:
        return None, problems
    numbers = tuple(range(1, 1 + len(axes[0].values)))
    return Axis(ROW, numbers, numbers, "1", tuple(axes)), []


def _columns(
    case: Case, columns: Mapping[str, list[Any]], *, first: bool = False
) -> tuple[list[Axis], list[Problem]]:
    """Keys with as many values each; the `first` one has no value twice."""
    if not columns:
        return [], [Problem("", "", "names no keys.", "Give keys and their values.")]
    known = len(known_keys(case))
    if len(columns) > known:
        allowed = f"names {len(columns)} keys; such a case has {known}."
        return [], [Problem("", "", allowed, "Give a table with one column for each key.")]
    axes: list[Axis] = []
    problems: list[Problem] = []
    leading, *_ = columns
    for key, values in columns.items():
        axis, found = make_axis(case, key, values, repeated=not first or key != leading)
        problems += found
        axes += [axis] if axis is not None else []
    count = len(columns[leading])
    for key, values in columns.items():
        if values and len(values) != count:
            allowed = f"has {len(values)} values, and {leading} has {count}; they change together."
            problems.append(Problem(key, "", allowed, "Give each the same number of values."))
    return axes, problems


def field_problem(case: Case, key: str) -> Problem | None:
    """Why a key cannot be varied: there is none, or it holds several values."""
    field = field_at(case, key)
    if field is not None:
        return _unsuitable(key, *field)
    remedy = did_you_mean(key, known_keys(case)) or "See 'epicyclic init' for the keys."
    return Problem(key, "", "is not a known key.", remedy)


def _one_for_alike(problems: Sequence[Problem]) -> list[Problem]:
    """One problem for all values that have the same."""
    alike: dict[str, list[Problem]] = {}
    for problem in problems:
        alike.setdefault(problem.allowed, []).append(problem)
    return [
        replace(first, value=f"{first.value} and {len(others)} more") if others else first
        for first, *others in alike.values()
    ]


def _unsuitable(key: str, annotation: Any, metadata: tuple[Any, ...]) -> Problem | None:
    """Why a key cannot be an axis: it holds several values."""
    if is_array(annotation):
        allowed = "is a list; a sweep varies keys that hold one value."
        return Problem(key, "", allowed, "Set it in the case, and run a sweep for each list.")
    table = table_of(annotation)
    if table is None or is_named(metadata):
        return None
    allowed = "is a table; a sweep varies keys that hold one value."
    return Problem(
        key, "", allowed, f"Vary keys of it, such as {next(all_keys(table, f'{key}.'))}."
    )


def coordinate_of(value: Any, quantity: Quantity | None) -> float | str:
    """A value of a key as a number in its display unit, or as a name."""
    if quantity is not None:
        return quantity.to_display(quantity.parse(value))
    if isinstance(value, bool | np.bool):
        return str(bool(value)).lower()
    if isinstance(value, str):
        return value
    if isinstance(value, Integral):
        whole = int(value)
        if abs(whole) <= _LARGEST_WHOLE:
            return whole
    elif isinstance(value, Real):
        return float(value)
    raise PydanticCustomError(
        "axis", "is not a value of one key", {"remedy": "give numbers, text or names"}
    )


# Tables of points: a column for each key, a row for each point.

_LARGEST_FILE = 10_000_000
"""[bytes]"""
_HEADER = re.compile(r"(?P<key>[^\[\]]+?)\s*(\[(?P<unit>[^\[\]]*)\])?")


def columns_of(points: str | Path | pd.DataFrame) -> dict[str, list[Any]]:
    """Keys of a table of points with their values, as a case file has them.

    Units stand in the header, ``gears.normal_module [mm]``, or with the values.

    Raises
    ------
    InputError
        If the file cannot be read, a cell is empty, or a key has two columns.
    """
    if not isinstance(points, str | Path):
        return _point_columns({str(name): column.tolist() for name, column in points.items()})
    source = one_line(str(points), 500)
    try:
        return _point_columns(_read(Path(points)))
    except InputError as error:
        raise InputError(error.problems, source) from None


def _read(path: Path) -> dict[str, Sequence[Any]]:
    import pandas as pd

    text = read_text(path, "table", _LARGEST_FILE)
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if len(lines) < 2:
        refuse("has no rows below a header.", "Give a header of keys, and a row for each point.")
    if len(lines) > MOST_POINTS + 1:  # not worth reading them
        refuse(f"has more than {MOST_POINTS} rows.", "Give fewer points, or several tables.")
    separator = max(",;\t", key=lines[0].count)
    try:
        cells = pd.read_csv(
            io.StringIO("\n".join(lines)),
            sep=separator,
            header=None,
            dtype=str,
            keep_default_na=False,
            skipinitialspace=True,
        )
    except (pd.errors.ParserError, pd.errors.EmptyDataError) as error:
        refuse(f"is not a table: {str(error).strip()}.", "Give every row as many cells.")
    header = [str(name).strip() for name in cells.iloc[0]]
    repeated = {name for name in header if header.count(name) > 1}
    if repeated:
        refuse(f"has two columns {', '.join(sorted(repeated))}.", "Keep one of them.")
    values = cells.iloc[1:]
    return {
        name: [str(cell).strip() for cell in values[number]] for number, name in enumerate(header)
    }


def _point_columns(table: dict[str, Any]) -> dict[str, list[Any]]:
    columns: dict[str, list[Any]] = {}
    problems = []
    for header, cells in table.items():
        match = _HEADER.fullmatch(header)
        key, unit = (match["key"], match["unit"] or "") if match else (header, "")
        if key in columns:
            problems.append(Problem(key, "", "has two columns.", "Keep one of them."))
        empty = [str(number) for number, cell in enumerate(cells, 1) if _is_empty(cell)]
        if empty:
            allowed = f"has no value in row {', '.join(empty[:5])}{' ...' * (len(empty) > 5)}."
            problems.append(Problem(key, "", allowed, "Give every row a value."))
        columns[key] = [_value(cell, unit) for cell in cells]
    raise_any(problems, "the table of points")
    return columns


def _is_empty(cell: Any) -> bool:
    return cell is None or cell == "" or cell != cell  # NaN of a frame


def _value(cell: Any, unit: str) -> Any:
    """A cell as a case file has it, a bare number with the unit of its column."""
    value = parse_value(cell) if isinstance(cell, str) else cell
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return f"{value!r} {unit}" if unit not in ("", "1") and is_number else value
