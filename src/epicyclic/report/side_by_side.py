"""Two results beside each other: what differs in their inputs, and what that changes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from epicyclic.case.read import flattened
from epicyclic.case.template import toml_value
from epicyclic.records.contents import ResultContents
from epicyclic.report.page import Cell, KeyFigure, Table, aligned, number, tenths
from epicyclic.report.result_tables import key_figures
from epicyclic.report.shown import MISSING
from epicyclic.units import percent


def side_by_side(
    first: ResultContents,
    second: ResultContents,
    names: tuple[str, str],  # What they are called.
) -> Iterator[Table]:
    """Key figures, losses and inputs of two results."""
    figures = [
        {figure.label: _with_unit(figure) for figure in key_figures(result)}
        for result in (first, second)
    ]
    rows = tuple(
        (Cell(label), *(one.get(label, Cell(MISSING)) for one in figures))
        for label in figures[0] | figures[1]
    )
    yield Table(("", *names), rows, "Key figures")
    yield _losses(first, second, names)
    inputs = [
        {
            key: value if isinstance(value, str) else toml_value(value)
            for key, value in flattened(result.inputs)
        }
        for result in (first, second)
    ]
    changed = [key for key in inputs[0] | inputs[1] if inputs[0].get(key) != inputs[1].get(key)]
    rows = tuple((Cell(key), *(Cell(one.get(key, MISSING)) for one in inputs)) for key in changed)
    if rows:
        yield Table(("key", *names), rows, "Inputs that differ")


def _with_unit(figure: KeyFigure) -> Cell:
    return replace(figure.cell, text=f"{figure.cell.text} {figure.unit}".rstrip())


def _losses(first: ResultContents, second: ResultContents, names: tuple[str, str]) -> Table:
    found = first.losses, second.losses
    rows = [_difference(name, *(one.get(name) for one in found)) for name in found[0] | found[1]]
    rows.append(_difference("total", first.total, second.total))
    strong = frozenset({len(rows) - 1})
    return Table(("", *names, "difference", ""), tuple(rows), "Losses in W", strong)


def _difference(name: str, first: float | None, second: float | None) -> tuple[Cell, ...]:
    label = name.replace("_", " ")
    values = (tenths(first), tenths(second))
    if first is None or second is None:
        return (Cell(label), *values, Cell(MISSING), Cell(MISSING))
    share = percent((second - first) / first, signed=True) if first else ""
    return (
        Cell(label),
        *values,
        number(second - first, "", text=f"{second - first:+z.1f}"),
        aligned(share),
    )
