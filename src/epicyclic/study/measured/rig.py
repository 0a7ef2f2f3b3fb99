"""Losses of the set under test, from what a back-to-back rig measures of all that turns in it."""

from __future__ import annotations

import re

import numpy as np

from epicyclic.arrays import BoolArray
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import first_of, one_problem
from epicyclic.messages import one_line
from epicyclic.study.measured.comparison import near_values
from epicyclic.study.measured.table import LOAD_DEPENDENT, SENSOR, Measurements, beside_point
from epicyclic.study.operating import AXES, STATE_KEY
from epicyclic.study.table_file import Grid

EQUAL = {"speed": (0.01, 0.0), "torque": (0.02, 0.1), "temperature": (0.0, 2.0)}
"""How much conditions that are meant to be equal differ at most: relatively, and absolutely in
rpm, N m, K."""
_EQUATION = re.compile(r"(?P<column>[^=]+)=(?P<value>.*)")
_WITH_UNIT = re.compile(r"\s*([0-9.,eE+-]+)\s*(\S.*)")
_PLACE = "the comparison"


@dataclass(frozen=True, slots=True)
class Rig:
    """How the rows of a table become losses of the set under test."""

    # ``"COLUMN=VALUE"``: the rows in which the reaction set was the same as the set under test, so
    # that each has half of the loss. The other half is taken off the other rows.
    baseline: str = ""
    unloaded: bool = False  # True to take the loss without torque off each loss under load.
    torque_uncertainty: str = ""  # ``"0.11 N*m"``, ``"0.05 %"``, where no column states it.

    def grid(self, grid: Grid) -> Grid:
        """The cells with the uncertainty of the torque as a column of its own."""
        if not self.torque_uncertainty:
            return grid
        found = _WITH_UNIT.fullmatch(self.torque_uncertainty)
        if found is None:
            reason = "must be a torque, or in per cent of the reading."
            key, given = "torque_uncertainty", one_line(self.torque_uncertainty)
            raise one_problem(key, given, reason, 'Give "0.11 N*m" or "0.05 %".', _PLACE)
        rows = tuple((line, (*cells, found[1])) for line, cells in grid.rows)
        return replace(grid, header=(*grid.header, f"{SENSOR} [{found[2]}]"), rows=rows)

    def losses(self, table: Measurements) -> Measurements:
        """Those of the set under test. Raises `InputError` if rows lack what belongs to them."""
        if not (self.baseline or self.unloaded):
            return table
        if set(table.component) != {"total"}:
            reason = "is not what a rig measures, which is the total loss."
            given = first_of(list(dict.fromkeys(table.component)))
            raise one_problem("component", given, reason, 'Give "total" in all rows.', _PLACE)
        if self.baseline:
            two = rows_where(table, self.baseline, "baseline")
            factor = np.where(two, 0.5, 1.0)
            known = None if table.uncertainty is None else factor * table.uncertainty
            half = replace(table, loss=factor * table.loss, uncertainty=known)
            table = _less(half, ~two, two, tuple(AXES), "in the baseline")
        if self.unloaded:
            idle = np.abs(table.conditions["torque"]) <= EQUAL["torque"][1]
            table = _less(
                table, ~idle, idle, ("speed", "temperature"), "without torque", alike=True
            )
            names = np.where(idle, "total", LOAD_DEPENDENT)
            table = replace(table, component=tuple(map(str, names)))
        return table


NO_RIG = Rig()


def rows_where(table: Measurements, text: str, key: str) -> BoolArray:
    """The rows in which a column has a value, ``"COLUMN=VALUE"``; raises `InputError` for none."""
    match = _EQUATION.fullmatch(text)
    column = match["column"].strip() if match else ""
    if match is None or column not in table.labels:
        share = ", or a share between 0 and 1" if key == "hold_out" else ""
        allowed = f"must be COLUMN=VALUE{share}."
        raise one_problem(key, text, allowed, f"Columns are {', '.join(table.labels)}.", _PLACE)
    wanted = match["value"].strip()
    cells = zip(table.labels[column], near_values(table.labels[column]), strict=True)
    chosen = np.array([_same(cell, wanted) or _same(near, wanted) for cell, near in cells])
    if not chosen.any():
        values = ", ".join(dict.fromkeys(table.labels[column]))
        allowed = f"matches no row; {column} has {values[:200]}."
        raise one_problem(key, text, allowed, "Give one of them.", _PLACE)
    return chosen


def _same(cell: str, wanted: str) -> bool:
    """Equal as text or as numbers."""
    try:
        return cell == wanted or float(cell) == float(wanted)
    except ValueError:
        return False


def _less(
    table: Measurements,
    rows: BoolArray,  # Those from which a loss is taken off.
    others: BoolArray,  # Those that have it.
    equal: tuple[str, ...],  # Conditions in which the two agree.
    where: str,  # What the latter are, for the message.
    *,
    alike: bool = False,  # True if they also agree in what the table sets of the case.
) -> Measurements:
    """The table with the mean loss of the rows that belong to each taken off.

    All agree in the state of a train.
    """
    loss, known = table.loss.copy(), table.uncertainty
    squares = None if known is None else known**2
    shown = [beside_point(it) if alike else it.get(STATE_KEY) for it in table.changes]
    lacking = []
    for row in map(int, np.flatnonzero(rows)):
        own = others & _agree(table, row, equal) & np.array([it == shown[row] for it in shown])
        if not own.any():
            lacking.append(f"line {table.lines[row]}")
            continue
        loss[row] -= table.loss[own].mean()
        if squares is not None and known is not None:
            squares[row] += (known[own] ** 2).sum() / own.sum() ** 2
    if lacking:
        reason = f"have no row {where} at their {' and '.join(equal)}."
        remedy = f"Measure {'them' if len(lacking) > 1 else 'it'}, or delete these rows."
        raise one_problem("rows", first_of(lacking), reason, remedy, table.source)
    return replace(table, loss=loss, uncertainty=None if squares is None else np.sqrt(squares))


def _agree(table: Measurements, row: int, equal: tuple[str, ...]) -> BoolArray:
    """Which rows have the conditions of one."""
    found = np.ones(len(table), dtype=bool)
    for name in equal:
        values = table.conditions.get(name)
        if values is not None:
            relative, absolute = EQUAL[name]
            found &= np.abs(values - values[row]) <= relative * abs(values[row]) + absolute
    return found
