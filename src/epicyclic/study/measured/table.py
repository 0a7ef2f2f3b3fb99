"""Measurements as tables of users state them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.arrays import FloatArray
from epicyclic.build.machine import build, layout_of
from epicyclic.case.case import Case
from epicyclic.case.keys import field_at, known_keys
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import InputError, Problem, first_of, raise_any
from epicyclic.messages import did_you_mean, misspelt, one_line, sentence
from epicyclic.schema.fields import entry_of, is_text, quantity_of
from epicyclic.schema.read import parse_value
from epicyclic.study.operating import AXES, NAMES, OPERATING, STATE, STATE_KEY, shaft_power
from epicyclic.study.sweeps.axes import known_field
from epicyclic.study.table_file import HEADER, Grid, missing_remedy, unit_problem
from epicyclic.units import NEWTON_METRE, NUMBER, RPM, WATT, Quantity, format_number

# Measurements as a table states them: conditions, loss, which loss it is, uncertainty.

LOAD_DEPENDENT = "load_dependent"  # Sum of the losses that depend on the load, as a component.

SENSOR = "torque_uncertainty"
"""Column of the standard uncertainty of each measured torque."""
_OWN = (*AXES, "loss", "torque_loss", "uncertainty", SENSOR, "component")
_EXAMPLES = {name: part.unit for name, part in OPERATING.items()} | {"loss": WATT.display}
_PERCENT, _UNIT_OF_PARTS = "%", "dimensionless"
_EFFICIENCY, _TORQUE_OUT, _SPEED_OUT = "efficiency", "output_torque", "output_speed"
_TORQUE_LOSS = "torque_loss"
"""Columns from which the total loss follows where it is no column itself."""
STATED_BY = ("loss", _TORQUE_LOSS, _EFFICIENCY, _TORQUE_OUT)  # Of these the first is read.
_NUMBER_WITH_UNIT = re.compile(r"[+-]?[\d.,]+(?:[eE][+-]?\d+)?\s*(?![eE][+-]?\d)[^\d\s.,].*")


@dataclass(frozen=True, slots=True, eq=False)
class Measurements:
    """Measured losses, one entry for each row of the table.

    Attributes
    ----------
    source : str
        Where they come from.
    lines : tuple of int
        Line of each in its file.
    changes : tuple of mapping
        The keys of the case that its row sets, as a case file has them.
    conditions : mapping of str to ndarray, shape (n,)
        ``speed`` [rpm], ``torque`` [N m], ``temperature`` [degC] if losses depend on it.
    component : tuple of str
        The loss that was measured: a term, a sum of terms joined by ``+``, ``load_dependent``,
        ``load_independent`` or ``total``.
    loss : ndarray, shape (n,)
        [W]
    uncertainty : ndarray, shape (n,), or None
        Standard uncertainty of the loss (coverage factor 1). [W]
    labels : mapping of str to tuple of str
        The columns by name, as text; units taken off the names, and the conditions as above.
    """

    source: str
    lines: tuple[int, ...]
    changes: tuple[Mapping[str, Any], ...]
    conditions: Mapping[str, FloatArray]
    component: tuple[str, ...]
    loss: FloatArray
    uncertainty: FloatArray | None
    labels: Mapping[str, tuple[str, ...]]

    def __len__(self) -> int:
        return len(self.lines)


def loss_names(case: Case) -> tuple[str, ...]:
    """Losses of a case that can be measured."""
    return (*layout_of(case).losses, LOAD_DEPENDENT, "load_independent", "total")


def parts_of(component: str) -> list[str]:
    """The losses whose sum was measured."""
    return [part.strip() for part in component.split("+")]


@dataclass(frozen=True, slots=True)
class _Column:
    header: str
    name: str
    unit: str
    cells: tuple[str, ...]


@dataclass(slots=True)
class _Problems:
    """Mistakes in cells; the same mistake in many cells of a column is one problem."""

    lines: tuple[int, ...]
    found: list[Problem] = field(default_factory=list)
    _cells: dict[tuple[str, str, str], list[str]] = field(default_factory=dict)

    def cell(self, column: _Column, row: int, allowed: str, remedy: str) -> None:
        given = f'"{one_line(column.cells[row])}" in line {self.lines[row]}'
        self._cells.setdefault((column.header, allowed, remedy), []).append(given)

    def all(self) -> list[Problem]:
        """Every problem, those of columns first."""
        cells = [
            Problem(one_line(header), first_of(given), allowed, remedy)
            for (header, allowed, remedy), given in self._cells.items()
        ]
        return [*self.found, *cells]


def parse_measurements(
    grid: Grid,
    case: Case,
    # The loss that was measured, where the table has no column ``component``.
    component: str = "total",
) -> Measurements:
    """What the cells of a table mean for a case. Raises `InputError` with every mistake."""
    problems = _Problems(tuple(line for line, _ in grid.rows))
    columns = _columns(grid, case, problems)
    conditions = {
        name: _numbers(columns.get(name), quantity_of(*known_field(case, key)), problems)
        for name, key in _conditions(case).items()
        if name != STATE
    }
    stated = _Stated(columns, conditions, case, problems)
    loss = stated.loss()
    uncertainty = stated.uncertainty(loss)
    components = _components(columns.get("component"), component, case, grid, problems)
    if stated.by_two_torques and set(components) != {"total"}:
        allowed = "is stated by an efficiency or two torques only if it is the total."
        problems.found.append(Problem("component", first_of(components), allowed, "Give losses."))
    own = _conditions(case)
    keys = {
        own.get(name, name): column
        for name, column in columns.items()
        if name in own or "." in name
    }
    values = {
        key: _values(column, *known_field(case, key), problems) for key, column in keys.items()
    }
    _check_repeats(grid, problems)
    changes = tuple(
        {key: column[row] for key, column in values.items()} for row in range(len(grid.rows))
    )
    raise_any(problems.all() or _refused(case, changes, problems.lines), grid.source)
    return Measurements(
        source=grid.source,
        lines=problems.lines,
        changes=changes,
        conditions=conditions,
        component=components,
        loss=loss,
        uncertainty=uncertainty,
        labels={name: column.cells for name, column in columns.items()}
        | {name: tuple(map(format_number, values)) for name, values in conditions.items()},
    )


def _conditions(case: Case) -> dict[str, str]:
    """The conditions that a table of a case must have and may have, and their keys."""
    found = {key: name for key, name in AXES.items() if case.computed or key != "temperature"}
    return found | ({STATE: STATE_KEY} if case.states else {})


def _columns(grid: Grid, case: Case, problems: _Problems) -> dict[str, _Column]:
    """The columns by name; the conditions under their short names."""
    own = _conditions(case)
    columns: dict[str, _Column] = {}
    for number, header in enumerate(grid.header):
        match = HEADER.fullmatch(header)
        if match is None:
            allowed, remedy = "is not a name with a unit.", "Write it as: speed [rpm]."
            place = f"column {number + 1}"
            problems.found.append(Problem(place, one_line(header), allowed, remedy))
            continue
        name = match["name"]
        name = name.lower() if name.lower() in (*_OWN, *own) else name
        name = NAMES[name] if NAMES.get(name) in own else name
        cells = tuple(row[number] for _, row in grid.rows)
        column = _Column(header, name, (match["unit"] or "").strip(), cells)
        if name in columns:
            allowed, remedy = f"is a second column of {one_line(name)}.", "Delete one."
            problems.found.append(Problem(one_line(header), "", allowed, remedy))
            continue
        problem = _name_problem(column, case)
        if problem is not None:
            problems.found.append(problem)
        else:
            columns[name] = column
    taken = {problem.key for problem in problems.found}
    problems.found += [
        Problem(name, "", "is missing among the columns.", remedy)
        for name, remedy in _examples(columns, grid.header)
        if name not in columns
        and (name in own or name not in AXES)
        and not any(misspelt(key, [name]) for key in taken)
    ]
    return columns


def _examples(columns: Collection[str], headers: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Columns that a table must have, and what to do without them."""
    for name, unit in _EXAMPLES.items():
        remedy = missing_remedy("Add", name, unit, headers)
        if name != "loss":
            yield name, remedy
        elif not {_EFFICIENCY, _TORQUE_OUT, _TORQUE_LOSS} & set(columns):
            others = f"{_TORQUE_LOSS} [N*m], {_EFFICIENCY} [%] or {_TORQUE_OUT} [N*m]"
            yield name, f"{remedy} Or add {others}."


def _name_problem(column: _Column, case: Case) -> Problem | None:
    """What is wrong with the name of a column; names without dots may be labels of the user."""
    name, shown = column.name, one_line(column.header)
    if "." not in name:
        own = (*_OWN, *_conditions(case))
        nearest = "" if name in own else misspelt(name, own)
        if nearest:
            return Problem(shown, "", "is not a known column.", f'Did you mean "{nearest}"?')
        return None
    known = field_at(case, name)
    if known is None:
        remedy = did_you_mean(name, known_keys(case)) or "Remove it, or drop its dots."
        return Problem(shown, "", "is not a key of the case.", remedy)
    if entry_of(known[0]):
        return Problem(shown, "", "is a list in the case.", "Compare one table for each list.")
    return None


def _numbers(column: _Column | None, quantity: Quantity | None, problems: _Problems) -> FloatArray:
    """The cells in the display unit of `quantity`; NaN where they cannot be read."""
    if column is None:
        return np.full(len(problems.lines), np.nan)
    assert quantity is not None
    kind: Quantity = quantity
    try:
        if column.unit:
            kind.scale_from(column.unit)
    except PydanticCustomError as error:
        problems.found.append(unit_problem(column.name, column.header, column.unit, kind, error))
        return np.full(len(problems.lines), np.nan)
    return _read(
        column, problems, lambda cell: kind.to_display(kind.parse(_with_unit(column, cell)))
    )


@dataclass(frozen=True, slots=True)
class _Stated:
    """What the columns of a table say of the loss and its uncertainty."""

    columns: Mapping[str, _Column]
    conditions: Mapping[str, FloatArray]
    case: Case
    problems: _Problems

    @property
    def by_two_torques(self) -> bool:
        """True if the loss is the difference of the powers at the two ends."""
        return bool({_EFFICIENCY, _TORQUE_OUT} & set(self.columns)) and not (
            {"loss", _TORQUE_LOSS} & set(self.columns)
        )

    def loss(self) -> FloatArray:
        """The measured loss, or that which an efficiency or a second torque implies. [W]"""
        if _TORQUE_LOSS in self.columns and "loss" not in self.columns:
            taken = _numbers(self.columns[_TORQUE_LOSS], NEWTON_METRE, self.problems)
            return shaft_power(taken, np.abs(self.conditions["speed"]))
        if not self.by_two_torques:
            return _numbers(self.columns.get("loss"), WATT, self.problems)
        power = shaft_power(self.conditions["torque"], self.conditions["speed"])
        if _EFFICIENCY in self.columns:
            column = self.columns[_EFFICIENCY]
            if not column.unit:
                cells = (
                    f"{cell} {_UNIT_OF_PARTS}" if cell[-1:].isdigit() else cell
                    for cell in column.cells
                )
                column = replace(column, cells=tuple(cells))
            share = _numbers(column, NUMBER, self.problems)
            for row in np.flatnonzero((share <= 0) | (share > 1)):
                remedy = "Give it as a share, or in per cent with [%] in the header."
                self.problems.cell(column, int(row), "must be > 0 and at most 1, or 100 %.", remedy)
            if column.unit == _PERCENT and share.max(initial=0) <= 1 / 100:  # NaN: told already
                allowed, remedy = "is below 1 % in every row.", f'Call it "{_EFFICIENCY} [1]".'
                self.problems.found.append(Problem(column.header, "", allowed, remedy))
            with np.errstate(divide="ignore", invalid="ignore"):
                return np.where(power > 0, power * (1 - share), -power * (1 / share - 1))
        torque = _numbers(self.columns[_TORQUE_OUT], NEWTON_METRE, self.problems)
        leaving = shaft_power(torque, self._speed_out())
        well = np.abs(power) > np.abs(power).max(initial=0.0) / 10  # rows under load
        senses = np.sign(leaving * power)[well & (np.abs(leaving) > np.abs(power) / 2)]
        # Signs that agree tell which way the power flows, also where both shafts drive.
        told = senses.size and np.all(senses == senses[0])
        leaving *= senses[0] if told else np.sign(leaving) * np.where(power > 0, 1, -1)
        return power - leaving

    def uncertainty(self, loss: FloatArray) -> FloatArray | None:
        """Standard uncertainties in W, from W or from per cent of the loss."""
        column = self.columns.get("uncertainty")
        if column is None:
            return self._of_torques(loss) if SENSOR in self.columns else None
        if SENSOR in self.columns:
            allowed = "is given together with uncertainty, which is that of the loss."
            self.problems.found.append(Problem(SENSOR, "", allowed, "Keep one of them."))
        if column.unit == _PERCENT:
            values = _read(column, self.problems, _finite) / 100 * np.abs(loss)
        else:
            values = _numbers(column, WATT, self.problems)
        for row in np.flatnonzero(values <= 0):
            remedy = "Give the standard uncertainty of every row, or leave the column out."
            self.problems.cell(column, int(row), "must be > 0.", remedy)
        return values

    def _of_torques(self, loss: FloatArray) -> FloatArray:
        """The same from the uncertainty of one torque, or of two independent ones. [W]"""
        column, two = self.columns[SENSOR], self.by_two_torques
        power = shaft_power(self.conditions["torque"], self.conditions["speed"])
        powers = [np.abs(power), np.abs(power - loss)] if two else [np.abs(loss)]
        if column.unit == _PERCENT:
            share = _read(column, self.problems, _finite) / 100
            parts = [share * power for power in powers]
        else:
            torque = _numbers(column, NEWTON_METRE, self.problems)
            speeds = [self.conditions["speed"]]
            speeds += [self._speed_out()] if two else []
            parts = [np.abs(shaft_power(torque, speed)) for speed in speeds]
        found = np.sqrt(sum(part**2 for part in parts))
        for row in np.flatnonzero(found <= 0):
            remedy = "Give the standard uncertainty of the torque as [N*m]."
            self.problems.cell(column, int(row), "leaves a loss without uncertainty.", remedy)
        return np.asarray(found)

    def _speed_out(self) -> FloatArray:
        """Of the output. [rpm]"""
        if _SPEED_OUT in self.columns:
            return _numbers(self.columns[_SPEED_OUT], RPM, self.problems)
        if STATE not in self.columns:
            return self.conditions["speed"] * _ratio(self.case)
        states = self.columns[STATE].cells
        known = {name: _ratio(self.case, name) for name in dict.fromkeys(states)}
        ratios: FloatArray = np.array([known[name] for name in states])
        return self.conditions["speed"] * ratios


def _ratio(case: Case, state: str = "") -> float:
    """Speed of the output over that of the input; NaN in a state that is none."""
    try:
        built = build(case.updated({STATE_KEY: state}) if state else case)
    except InputError:  # told where the state stands
        return math.nan
    speeds, ends = built.state().speeds, built.operation
    return speeds[ends.output] / speeds[ends.input]


def _with_unit(column: _Column, cell: str) -> str:
    return f"{cell} {column.unit}" if column.unit else cell


def _read(column: _Column, problems: _Problems, parse: Callable[[str], float]) -> FloatArray:
    numbers = np.full(len(column.cells), np.nan)
    for row, cell in enumerate(column.cells):
        if not cell:
            problems.cell(column, row, "is empty.", "Fill it, or delete the row.")
            continue
        if column.unit and _NUMBER_WITH_UNIT.fullmatch(cell):
            allowed = f"has a unit, but the header already has [{column.unit}]."
            problems.cell(column, row, allowed, "Give units in the header or in every cell.")
            continue
        try:
            numbers[row] = parse(cell)
        except PydanticCustomError as error:
            remedy = str((error.context or {}).get("remedy", ""))
            allowed = sentence(error.message(), capital=False)
            if not column.unit:
                remedy += f" in every cell, or put the unit into the header: {column.name} [...]"
            problems.cell(column, row, allowed, sentence(remedy))
        except ValueError:
            problems.cell(column, row, "is not a number.", "Write a number, or delete the row.")
    return numbers


def _finite(cell: str) -> float:
    number = float(cell)
    if not math.isfinite(number):
        raise ValueError(cell)
    return number


def _components(
    column: _Column | None, given: str, case: Case, grid: Grid, problems: _Problems
) -> tuple[str, ...]:
    wrong = _no_sum(given, case)
    if column is not None and given != "total":
        wrong = "is given together with a column of that name.", "Keep one of them."
    if wrong is not None:
        problems.found.append(Problem("component", one_line(given), *wrong))
    if column is None:
        return (given,) * len(grid.rows)
    of_cells = {text: _no_sum(text, case) for text in dict.fromkeys(column.cells)}
    for row, cell in enumerate(column.cells):
        if found := of_cells[cell]:
            problems.cell(column, row, *found)
    return column.cells


def _no_sum(text: str, case: Case) -> tuple[str, str] | None:
    """Why a component is no loss, nor a sum in which each loss counts once, and what to do."""
    names, parts = loss_names(case), parts_of(text)
    if not set(parts) <= set(names):
        return "is not a loss.", f"The losses are {', '.join(names)}; join several with +."
    if len(set(parts)) < len(parts) or ("total" in parts and len(parts) > 1):
        return "counts a loss twice.", "Name each once; total is the sum of all."
    return None


def _values(
    column: _Column, annotation: Any, metadata: tuple[Any, ...], problems: _Problems
) -> tuple[Any, ...]:
    """The cells as a case file has them."""
    if quantity_of(annotation, metadata) is not None:
        if column.name not in AXES:
            _numbers(column, quantity_of(annotation, metadata), problems)
        return tuple(_with_unit(column, cell) for cell in column.cells)
    if column.unit not in ("", "1"):
        allowed, remedy = "has no unit in the case.", f"Name the column {column.name}."
        problems.found.append(Problem(one_line(column.header), "", allowed, remedy))
    for row, cell in enumerate(column.cells):
        if not cell:
            problems.cell(column, row, "is empty.", "Fill it, or delete the row.")
    return column.cells if is_text(annotation) else tuple(map(parse_value, column.cells))


def _check_repeats(grid: Grid, problems: _Problems) -> None:
    """The same row twice is a slip; repeated measurements differ in loss or have a label."""
    seen: dict[tuple[str, ...], int] = {}
    repeats = []
    for line, cells in grid.rows:
        if cells in seen:
            repeats.append(f"line {line} repeats line {seen[cells]}")
        seen.setdefault(cells, line)
    if repeats:
        remedy = "Delete them; number repeated measurements in a column of their own, such as run."
        problems.found.append(Problem("rows", first_of(repeats), "appear twice.", remedy))


def beside_point(changes: Mapping[str, Any]) -> dict[str, Any]:
    """What a row sets of the case, apart from its operating point."""
    return {key: value for key, value in changes.items() if key not in AXES.values()}


def _refused(
    case: Case, changes: tuple[Mapping[str, Any], ...], lines: tuple[int, ...]
) -> list[Problem]:
    """What the case refuses of the keys that rows set, apart from its operating point."""
    first: dict[str, int] = {}
    for row, change in enumerate(changes):
        first.setdefault(repr(beside_point(change)), row)
    problems = []
    for row in first.values():
        try:
            case.updated(changes[row])
        except InputError as error:
            place = f"line {lines[row]}"
            problems += [replace(it, key=f"{place}: {it.key}") for it in error.problems]
    return problems
