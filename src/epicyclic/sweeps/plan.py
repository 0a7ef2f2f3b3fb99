"""What a sweep varies: keys, their values, and the cases of the full product."""

from __future__ import annotations

import hashlib
import math
import re
from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from itertools import islice
from numbers import Integral, Real
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.analysis.solve import solve
from epicyclic.case.case import Case, TrainCase, build_case
from epicyclic.case.fields import (
    all_keys,
    is_array,
    is_named,
    is_text,
    is_whole_number,
    quantity_of,
    table_of,
)
from epicyclic.case.keys import field_at, known_keys
from epicyclic.case.nearest import did_you_mean
from epicyclic.case.plain import plain
from epicyclic.case.values import parse_value
from epicyclic.case.wording import sentence, written
from epicyclic.errors import InputError, Problem
from epicyclic.pocketing.table import FlowTables
from epicyclic.status import Status
from epicyclic.sweeps.journal import Row
from epicyclic.sweeps.pockets import flow_tables
from epicyclic.sweeps.runner import Plan, guarded
from epicyclic.units import Quantity, format_number

__all__ = ["Axis", "CasePlan", "PointList", "SweepPlan", "make_plan", "parse_vary"]

_RANGE = re.compile(
    r"\s*(?P<start>[^:,]+?)\s*:\s*(?P<stop>[^:,]+?)\s*:\s*(?P<count>\d+)\s*(?P<unit>[^:,\d][^:,]*)?"
)
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*")

_MOST_POINTS = 1_000_000
"""Rows of more points do not fit into memory."""
_LARGEST_WHOLE = 2**53
"""Larger whole numbers are no exact coordinates."""

# Tables whose keys leave geometry alone: varied innermost, so that geometry is built once.
_OPERATING_TABLES = (
    "operation",
    "lubricant",
    "surroundings",
    "models",
    "contact_solver",
    "losses",
    "thermal",
)


@dataclass(frozen=True, slots=True)
class Axis:
    """One swept key.

    Attributes
    ----------
    key : str
        Dotted key of the case.
    values : tuple
        As a case file has them.
    coordinate : tuple of float or str
        The same as numbers in `unit`, or as names.
    unit : str
        Display unit; ``"1"`` for pure numbers, empty for names.
    """

    key: str
    values: tuple[Any, ...]
    coordinate: tuple[float | str, ...]
    unit: str


@dataclass(frozen=True, slots=True)
class CasePlan(Plan):
    """Cases to be solved: one case, and what each point changes in it.

    Attributes
    ----------
    case : Case
    flow_tables : mapping
        Of flows through pockets that points share, see `prepared`.
    """

    case: Case
    flow_tables: FlowTables = field(default_factory=dict, kw_only=True, repr=False)

    @property
    def source(self) -> str:
        """The file of the case."""
        return str(Path(self.case.source).absolute())

    @abstractmethod
    def changes(self, index: int) -> dict[str, Any]:
        """The keys that point number `index` changes."""

    def solve(self, index: int) -> Row:
        """One case as a flat record."""
        return guarded(lambda: self._solve(index))

    def prepared(self, indices: Sequence[int], jobs: int | None) -> Self:
        """With the tables of flows that the points `indices` read."""
        return replace(self, flow_tables=flow_tables(self, indices, jobs))

    def describe(self) -> dict[str, Any]:
        """The case, and what is in the files that it names: it may change, their names do not."""
        contents = [(self.case.folder / file).read_bytes() for file in _files(self.case)]
        return {
            "case": self.case.given(),
            "files": [hashlib.sha256(content).hexdigest() for content in contents],
        }

    def _solve(self, index: int) -> Row:
        case = self.case.updated(self.changes(index))
        result = solve(case, flow_tables=self.flow_tables)
        if result.status is not Status.CONVERGED:
            return Row(str(result.status), message=result.notes[0])
        return Row(
            status=str(result.status),
            warnings=" | ".join(result.warnings),
            numbers={item.key: item.value for item in result.numbers()},
        )


def _files(case: Case) -> Iterator[str]:
    """The files that a case names."""
    tables: list[Any] = [case.models]
    if isinstance(case, TrainCase):
        tables += [table.models for table in case.sets.values() if hasattr(table, "models")]
        tables += [table for _, _, table in case.elements]
    for table in tables:
        for key in ("oil_model", "pocketing_table", "file"):
            file = getattr(table, key, None)
            if file is not None:
                yield file


@dataclass(frozen=True, slots=True)
class SweepPlan(CasePlan):
    """A sweep: a case and its axes."""

    kind: ClassVar[str] = "sweep"
    axes: tuple[Axis, ...] = ()

    @classmethod
    def again(cls, content: Mapping[str, Any], source: str) -> Self:
        """The plan that `describe` described."""
        axes = [
            Axis(axis["key"], tuple(axis["values"]), tuple(axis["coordinate"]), axis["unit"])
            for axis in content["axes"]
        ]
        return cls(build_case(content["case"], {}, source), tuple(axes))

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each axis."""
        return tuple(len(axis.values) for axis in self.axes)

    @property
    def size(self) -> int:
        """Number of cases."""
        return int(np.prod(self.shape, dtype=int))

    def changes(self, index: int) -> dict[str, Any]:
        """The keys that case number `index`, counted with the last axis fastest, changes."""
        position = np.unravel_index(index, self.shape)
        return {axis.key: axis.values[i] for axis, i in zip(self.axes, position, strict=True)}

    def order(self) -> list[int]:
        """Indices of all cases, those that share geometry next to each other."""
        inner = [axis.key.split(".")[0] in _OPERATING_TABLES for axis in self.axes]
        by_cost = sorted(range(len(self.axes)), key=lambda i: inner[i])
        numbers = np.arange(self.size).reshape(self.shape)
        return [int(index) for index in numbers.transpose(by_cost).ravel()]

    def describe(self) -> dict[str, Any]:
        """The case and the axes."""
        return {**CasePlan.describe(self), "axes": [asdict(axis) for axis in self.axes]}


@dataclass(frozen=True, slots=True)
class PointList(CasePlan):
    """Single points: a case and the keys that each point changes."""

    kind: ClassVar[str] = "points"
    points: tuple[Mapping[str, Any], ...] = ()

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.points)

    def changes(self, index: int) -> dict[str, Any]:
        """The keys that point number `index` changes."""
        return dict(self.points[index])

    def order(self) -> list[int]:
        """Indices of all points, by geometry, then operation, then torque, as in a loss map."""
        return sorted(range(self.size), key=self._place)

    def describe(self) -> dict[str, Any]:
        """The case and the points."""
        return {**CasePlan.describe(self), "points": plain(self.points)}

    def _place(self, index: int) -> tuple[list[str], list[str], str]:
        torque = "operation.torque"
        changes = {key: str(value) for key, value in sorted(self.points[index].items())}
        inner = [key for key in changes if key.split(".")[0] in _OPERATING_TABLES]
        return (
            [f"{key}={text}" for key, text in changes.items() if key not in inner],
            [f"{key}={changes[key]}" for key in inner if key != torque],
            changes.get(torque, ""),
        )


def make_plan(case: Case, vary: Mapping[str, Iterable[Any]]) -> SweepPlan:
    """Check what is to be varied.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
    vary : mapping of str to iterable
        Dotted keys to their values, as a case file has them.

    Raises
    ------
    InputError
        For unknown or unsuitable keys, no values, values that cannot be read, or repeated ones.
    """
    problems: list[Problem] = []
    axes = []
    if not vary:
        problems.append(Problem("vary", "", "is empty.", "Give at least one key and its values."))
    listed = {str(key): _listed(values) for key, values in vary.items()}
    size = math.prod(len(values) for values in listed.values())
    if size > _MOST_POINTS:  # not worth reading them
        raise InputError([_too_many("vary", size)], "the sweep")
    for key, values in listed.items():
        axis, found = _make_axis(case, key, values)
        problems += found
        if axis is not None:
            axes.append(axis)
    if problems:
        raise InputError(problems, "the sweep")
    return SweepPlan(case, tuple(axes))


def _listed(values: Any) -> list[Any]:
    """`values` as a list; anything that is one value by itself as a list of it."""
    if isinstance(values, str | Mapping):
        return [values]
    try:
        return list(islice(values, _MOST_POINTS + 1))
    except TypeError:
        return [values]


def _too_many(key: str, count: int) -> Problem:
    allowed = f"must have {_MOST_POINTS} points or fewer, not {count}."
    return Problem(key, "", allowed, "Give fewer values.")


def _make_axis(case: Case, key: str, values: list[Any]) -> tuple[Axis | None, list[Problem]]:
    field = field_at(case, key)
    if field is None:
        remedy = did_you_mean(key, known_keys(case)) or "See 'epicyclic init' for the keys."
        return None, [Problem(key, "", "is not a known key.", remedy)]
    unsuitable = _unsuitable(key, *field)
    if unsuitable is not None:
        return None, [unsuitable]
    if not values:
        return None, [Problem(key, "", "has no values.", "Give at least one.")]
    quantity = quantity_of(*field)
    if is_text(field[0]):  # a name may be a bare number
        values = [str(value) if isinstance(value, Integral) else value for value in values]
    coordinate: list[float | str] = []
    problems = []
    for value in values:
        try:
            coordinate.append(_coordinate(value, quantity))
        except PydanticCustomError as error:
            remedy = str((error.context or {}).get("remedy", ""))
            problems.append(
                Problem(
                    key, written(value), sentence(error.message(), capital=False), sentence(remedy)
                )
            )
    if not problems and len(set(coordinate)) < len(coordinate):
        problems.append(Problem(key, "", "has the same value twice.", "Give each value once."))
    if problems:
        return None, _one_for_alike(problems)
    if any(isinstance(item, str) for item in coordinate):
        coordinate = [str(item) for item in coordinate]
        unit = ""
    else:
        unit = "1" if quantity is None else quantity.display
    return Axis(key, tuple(map(plain, values)), tuple(coordinate), unit), []


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


def _coordinate(value: Any, quantity: Quantity | None) -> float | str:
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
        "axis", "is no value of one key", {"remedy": "give numbers, text or names"}
    )


def parse_vary(
    case: Case, options: Sequence[str], name: str = "--vary", example: str = "operation.speed"
) -> dict[str, list[Any]]:
    """The options ``key=a,b,c`` and ``key=start:stop:count`` of a command line.

    `name` is that of the options, `example` one of their keys that holds a speed.

    A unit after the last value, or after the count, holds for all values without one.

    Raises
    ------
    InputError
        If an option is not of that form.
    """
    problems = []
    vary: dict[str, list[Any]] = {}
    for option in options:
        key, equals, text = option.partition("=")
        key = key.strip()
        if not equals or not text.strip():
            problems.append(
                Problem(
                    name,
                    f'"{option}"',
                    "must be key=a,b,c or key=start:stop:count.",
                    f'For example {name} "{example}=1000:4000:4 rpm".',
                )
            )
            continue
        if key in vary:
            problems.append(
                Problem(name, f'"{option}"', f"varies {key} again.", "Name a key once.")
            )
            continue
        try:
            vary[key] = list(_values(case, key, text))
        except ValueError as error:
            problems.append(
                Problem(key, f'"{text}"', f"{error}.", "Write start:stop:count in one unit.")
            )
        size = math.prod(map(len, vary.values()))
        if size > _MOST_POINTS:
            problems.append(_too_many(name, size))
            break
    if problems:
        raise InputError(problems, "the command")
    return vary


def _values(case: Case, key: str, text: str) -> Iterator[Any]:
    match = _RANGE.fullmatch(text)
    if match is not None:
        yield from _range(case, key, match)
        return
    items = [item.strip() for item in text.split(",") if item.strip()]
    shared = _unit_of(items[-1]) if items else ""
    for item in items:
        yield parse_value(f"{item} {shared}" if shared and _is_bare(item) else item)


def _range(case: Case, key: str, match: re.Match[str]) -> Iterator[Any]:
    start, stop = _NUMBER.fullmatch(match["start"]), _NUMBER.fullmatch(match["stop"])
    if start is None or stop is None:
        raise ValueError("start and stop must be numbers")
    count = int(match["count"])
    if count < 1:
        raise ValueError("the count must be 1 or more")
    if count > _MOST_POINTS:
        raise ValueError(f"the count must be {_MOST_POINTS} or less")
    units = {unit for unit in (start[2], stop[2], (match["unit"] or "").strip()) if unit}
    if len(units) > 1:
        raise ValueError(f"the units {' and '.join(sorted(units))} differ")
    unit = units.pop() if units else ""
    field = field_at(case, key)
    whole = field is not None and is_whole_number(field[0])
    for number in np.linspace(float(start[1]), float(stop[1]), count):
        if unit:
            yield f"{format_number(float(number), 12)} {unit}"
        elif whole and float(number).is_integer():
            yield int(number)
        else:
            yield float(number)


def _is_bare(item: str) -> bool:
    match = _NUMBER.fullmatch(item)
    return match is not None and not match[2]


def _unit_of(item: str) -> str:
    match = _NUMBER.fullmatch(item)
    return match[2] if match is not None else ""
