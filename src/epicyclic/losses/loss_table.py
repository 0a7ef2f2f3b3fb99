"""Losses that the user gives as a table: friction torque or power over one or two quantities."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Literal

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass
from epicyclic.errors import InputError, Problem, first_of, problems_in, raise_any, rising_problems
from epicyclic.files import csv_rows, read_text, refuse
from epicyclic.losses.ranges import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.units import CELSIUS, NEWTON, NEWTON_METRE, RPM, WATT, Quantity

LossQuantity = Literal["torque", "power"]

AXES: Mapping[str, tuple[str, Quantity]] = {
    "speed": ("speed difference", RPM),
    "temperature": ("oil temperature", CELSIUS),
    "radial_force": ("radial force", NEWTON),
}
"""Label and display unit of what a table may have as axes."""
QUANTITIES: Mapping[str, tuple[str, Quantity]] = {
    "torque": ("friction torque", NEWTON_METRE),
    "power": ("power loss", WATT),
}
"""Label and display unit of what a table may hold."""

_COLUMNS = {**AXES, **QUANTITIES}
_LARGEST_FILE = 1_000_000  # [bytes]
_MOST_ROWS = 10_000
_LONGEST_SHOWN = 60
_HEADER = re.compile(r"(?P<name>[^\[\]]+?)\s*\[(?P<unit>[^\[\]]*)\]")


@dataclass(frozen=True, slots=True, eq=False)
class LossTable:
    """Friction torque or power, linear between the points of a table. Theory (J17).

    Raises `ValueError` if `table_problems` finds any.
    """

    quantity: LossQuantity  # ``"torque"`` or ``"power"``.
    # One or two of `AXES`, each with two or more rising points. [SI]
    axes: Mapping[str, FloatArray]
    # Torque or power, never negative, one entry, or one row, for each point of the first axis. [N
    # m] or [W]
    values: FloatArray
    source: str = "table of the case"  # Where it comes from, for messages.

    def __post_init__(self) -> None:
        problems = table_problems(self.quantity, self.axes, self.values)
        if problems:
            raise ValueError("; ".join(map(str, problems)))

    @property
    def names(self) -> tuple[str, ...]:
        """The axes by name."""
        return tuple(self.axes)

    def value(self, **at: float) -> float:
        """What the table holds at values of its axes, held at its ends. [N m] or [W]"""
        first, *others = self.axes.items()
        values = self.values
        for name, points in others:
            values = np.array([np.interp(at[name], points, row) for row in values])
        return float(np.interp(at[first[0]], first[1], values))

    def loss(self, *, speed: float, temperature: float, radial_force: float = math.nan) -> float:
        """Power lost at a speed difference. [W]

        At a speed below the first one, a power falls to zero in proportion to the speed: its torque
        is held.
        """
        at = {"speed": abs(speed), "temperature": temperature, "radial_force": radial_force}
        if speed == 0:
            return 0.0
        if self.quantity == "torque":
            return self.value(**at) * abs(speed)
        lowest = float(self.axes["speed"][0])
        return self.value(**at) * min(1.0, abs(speed) / lowest if lowest > 0 else 1.0)

    def flags(
        self, use: ModelUse, *, speed: float, temperature: float, radial_force: float = math.nan
    ) -> tuple[ValidityFlag, ...]:
        """Flags for values beyond the ends of the table; none at rest."""
        if speed == 0:
            return ()
        at = {"speed": abs(speed), "temperature": temperature, "radial_force": radial_force}
        ranges = []
        for name, points in self.axes.items():
            label, unit = AXES[name]
            low, high = (unit.to_display(float(end)) for end in (points[0], points[-1]))
            ranges.append(Range(name, label, low, high, unit, self.source))
        return check_ranges(use, ranges, at)


def table_problems(
    quantity: LossQuantity,  # ``"torque"`` or ``"power"``.
    axes: Mapping[str, Sequence[float] | FloatArray],  # [SI]
    values: object,  # One entry, or one row, for each point of the first axis. [SI]
) -> list[Problem]:
    """What is wrong with the points and values of a table, by the names of its axes."""
    known = ", ".join(AXES)
    if not 1 <= len(axes) <= 2:
        allowed = f"must have one or two of the axes {known}."
        remedy = "Give the points of the axes to which the values belong."
        return [Problem(quantity, f"{len(axes)} axes", allowed, remedy)]
    problems = rising_problems(axes)
    if "speed" in axes and len(axes["speed"]) > 0 and axes["speed"][0] < 0:
        allowed = "must not be negative, because a loss is the same in both senses of rotation."
        remedy = "Give magnitudes of the speed difference."
        problems.append(Problem("speed", RPM.text(float(axes["speed"][0])), allowed, remedy))
    if quantity == "power" and "speed" not in axes:
        allowed = "needs the axis speed, because it is zero at rest."
        problems.append(Problem("power", "", allowed, "Add speed, or give torque."))
    return problems + _value_problems(quantity, axes, values)


def _value_problems(
    quantity: LossQuantity, axes: Mapping[str, Sequence[float] | FloatArray], values: object
) -> list[Problem]:
    wanted = tuple(len(points) for points in axes.values())
    try:
        array = np.asarray(values, dtype=float)
    except ValueError:  # rows of unequal length
        array = np.empty(0)
    if array.shape != wanted:
        size, names = " x ".join(map(str, wanted)), " and ".join(axes)
        allowed = f"must have {size} values, for the points of {names}."
        remedy = "Give one value, or one row, for each value of the first axis."
        return [Problem(quantity, "", allowed, remedy)]
    if not (np.isfinite(array) & (array >= 0)).all():
        allowed, remedy = "must be zero or more everywhere.", "Give losses as positive numbers."
        return [Problem(quantity, f"{array.min():.6g}", allowed, remedy)]
    if quantity == "power" and "speed" in axes and axes["speed"][0] == 0:
        at_rest = np.take(array, 0, axis=list(axes).index("speed"))
        if np.any(at_rest > 0):
            allowed = "must be zero at speed 0, because a part at rest loses no power."
            remedy = "Give 0 W there, or start at a higher speed."
            return [Problem("power", f"{at_rest.max():.6g} W", allowed, remedy)]
    return []


def read_loss_table(
    path: Path,  # At most 1 MB and 10,000 rows.
) -> LossTable:
    """A table from a CSV file, one row for each point.

    The header names one or two of the columns ``speed``, ``temperature`` and ``radial_force`` and
    either ``torque`` or ``power``, each with its unit: ``speed [rpm],torque [N*m]``. Of two axes,
    every point of one goes with every point of the other, in any order. Lines that begin with ``#``
    do not count; the separator is a comma, a semicolon or a tab. Raises `InputError` with every
    mistake in the file.
    """
    with problems_in(str(path)):
        return _parse(read_text(path, "loss table", _LARGEST_FILE), str(path))


def _parse(text: str, source: str) -> LossTable:
    rows = list(csv_rows(text))
    if not rows:
        refuse("is empty.", "Give a header such as: speed [rpm],torque [N*m].")
    (_, header), *body = rows
    columns, problems = _columns(header)
    if not body:
        problems.append(Problem("", "", "the file has no rows below its header.", "Add them."))
    if len(body) > _MOST_ROWS:
        refuse(f"has more than {_MOST_ROWS} rows.", "Keep the points that describe the curve.")
    ragged = [line for line, cells in body if len(cells) != len(header)]
    if ragged:
        allowed = f"must have {len(header)} cells, like the header."
        lines = f"line{'s' if len(ragged) > 1 else ''} {first_of([*map(str, ragged)])}"
        problems.append(Problem(lines, "", allowed, "Complete or delete these lines."))
        raise InputError(problems)
    data = {}
    for number, (name, unit) in columns.items():
        if any(problem.key == _shown(header[number]) for problem in problems):
            continue
        cells = [(line, row[number]) for line, row in body]
        data[name], found = _numbers(header[number], name, unit, cells)
        problems += found
    raise_any(problems)
    return _gridded(data, [line for line, _ in body], source)


def _columns(header: Sequence[str]) -> tuple[dict[int, tuple[str, str]], list[Problem]]:
    """Name and unit of each column by its number, and what is wrong with the header."""
    columns: dict[int, tuple[str, str]] = {}
    problems: list[Problem] = []
    known = list(_COLUMNS)
    for number, text in enumerate(header):
        match = _HEADER.fullmatch(text)
        name = match["name"].strip().lower() if match else text.lower()
        if name not in known:
            allowed = f"is not a known column; the columns are {', '.join(known)}."
            problems.append(Problem(_shown(text), "", allowed, "Rename or delete it."))
        elif match is None:
            unit = _COLUMNS[name][1].display
            allowed, remedy = "has no unit.", f"Write it as {name} [{unit}]."
            problems.append(Problem(_shown(text), "", allowed, remedy))
        elif name in (seen for seen, _ in columns.values()):
            allowed = "is a second column of the same name."
            problems.append(Problem(_shown(text), "", allowed, "Delete one."))
        else:
            unit, quantity = match["unit"].strip(), _COLUMNS[name][1]
            columns[number] = (name, unit)
            try:
                quantity.scale_from(unit)
            except PydanticCustomError as error:
                meant = quantity.meant_unit(unit)
                remedy = (
                    f"Write it as {name} [{meant}]." if meant else "Convert it to another unit."
                )
                problems.append(Problem(_shown(text), "", f"{error.message()}.", remedy))
    return columns, problems or list(_missing([name for name, _ in columns.values()]))


def _missing(names: Sequence[str]) -> Iterator[Problem]:
    quantities = [name for name in names if name in QUANTITIES]
    if len(quantities) != 1:
        allowed = "the header must have either torque or power."
        yield Problem("", "", allowed, "Add torque [N*m] or power [W], and delete the other.")
    if not 1 <= len(names) - len(quantities) <= 2:
        allowed = f"the header must have one or two of the columns {', '.join(AXES)}."
        yield Problem("", "", allowed, "Add a column such as speed [rpm].")


def _numbers(
    header: str, name: str, unit: str, cells: Sequence[tuple[int, str]]
) -> tuple[FloatArray, list[Problem]]:
    """The cells of a column in SI, and one problem for each mistake in them."""
    quantity = _COLUMNS[name][1]
    numbers = np.full(len(cells), np.nan)
    wrong: dict[tuple[str, str], list[str]] = {}
    for row, (line, cell) in enumerate(cells):
        try:
            numbers[row] = quantity.parse(f"{cell} {unit}")
        except PydanticCustomError as error:
            remedy = str((error.context or {}).get("remedy", ""))
            given = f'"{_shown(cell)}" in line {line}'
            wrong.setdefault((f"{error.message()}.", f"{remedy}."), []).append(given)
    return numbers, [
        Problem(_shown(header), first_of(given), allowed, remedy)
        for (allowed, remedy), given in wrong.items()
    ]


def _gridded(data: Mapping[str, FloatArray], lines: Sequence[int], source: str) -> LossTable:
    """The table whose rows, in any order, are `data`."""
    quantity: LossQuantity = "torque" if "torque" in data else "power"
    names = [name for name in AXES if name in data]
    axes = {name: np.unique(data[name]) for name in names}
    where = list(zip(*(np.searchsorted(axes[name], data[name]) for name in names), strict=True))
    seen: dict[tuple[int, ...], int] = {}
    problems = []
    for line, place in zip(lines, where, strict=True):
        if place in seen:
            allowed = f"repeats the point of line {seen[place]}."
            problems.append(Problem(f"line {line}", "", allowed, "Delete one."))
        seen.setdefault(place, line)
    shape = tuple(len(points) for points in axes.values())
    gaps = [place for place in product(*map(range, shape)) if place not in seen]
    if gaps:
        first = ", ".join(
            AXES[name][1].text(float(axes[name][index]))
            for name, index in zip(names, gaps[0], strict=True)
        )
        count = f"{len(gaps)} points, the first at" if len(gaps) > 1 else "the point"
        allowed = f"the file has no row for {count} {first}."
        remedy = f"Combine every value of {names[0]} with every value of {names[-1]}."
        problems.append(Problem("", "", allowed, remedy))
    raise_any(problems)
    values = np.zeros(shape)
    values[tuple(zip(*where, strict=True))] = data[quantity]
    raise_any(table_problems(quantity, axes, values))
    return LossTable(quantity, axes, values, source)


def _shown(text: str) -> str:
    """Text of the user on one line, cut to what a message shows."""
    plain = "".join(char if char.isprintable() else " " for char in text[: 2 * _LONGEST_SHOWN])
    return f"{plain[:_LONGEST_SHOWN]}..." if len(plain) > _LONGEST_SHOWN else plain
