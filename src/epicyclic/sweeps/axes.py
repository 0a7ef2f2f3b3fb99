"""Axes of a sweep: keys and their values, alone or changing together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import islice
from numbers import Integral, Real
from typing import Any, Self

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.case.case import Case
from epicyclic.case.fields import all_keys, is_array, is_named, is_text, quantity_of, table_of
from epicyclic.case.keys import field_at, known_keys
from epicyclic.case.nearest import did_you_mean
from epicyclic.case.plain import plain
from epicyclic.case.wording import refused, written
from epicyclic.errors import Problem
from epicyclic.units import Quantity

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
