"""Parts that the tables of all results share."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from rich import box
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from epicyclic.elements.figures import Figure, MeshFigures, figures
from epicyclic.records.contents import ResultContents
from epicyclic.report.shown import MISSING, shown
from epicyclic.results.result import Result
from epicyclic.units import unit_text

__all__ = [
    "efficiency_text",
    "figure_table",
    "meshes_table",
    "number_table",
    "plain_table",
    "share_cells",
    "side_by_side",
]


MOST_BESIDE = 3
"""Parts beside each other that leave room for labels on one line."""


def plain_table(title: str) -> Table:
    """An empty table in the style of the package."""
    return Table(
        title=title,
        title_justify="left",
        title_style="bold",
        header_style="",
        box=box.SIMPLE_HEAD,
        pad_edge=False,
    )


def number_table(title: str, *columns: str) -> Table:
    """An empty table of names, in its first column, and numbers."""
    table = plain_table(title)
    for number, column in enumerate(columns):
        first = number == 0
        table.add_column(column, justify="left" if first else "right", no_wrap=first)
    return table


def share_cells(result: Result | ResultContents, watts: float) -> tuple[str, str, str]:
    """Power, share of the total loss, share of the input power."""
    of_total = f"{watts / result.total:z.1%}" if result.total else ""
    of_input = f"{watts / result.input_power:z.3%}" if result.input_power else ""
    return f"{watts:z.1f}", of_total, of_input


def efficiency_text(result: Result) -> str:
    """The efficiency in percent."""
    return "undefined" if result.efficiency is None else f"{result.efficiency:.3%}"


def meshes_table(title: str, meshes: Mapping[str, MeshFigures]) -> RenderableType:
    """Figures of meshes side by side."""
    table = side_by_side(title, {name: figures(mesh) for name, mesh in meshes.items()})
    if any(mesh.contact is None for mesh in meshes.values()):
        return Group(table, Text(f'"{MISSING}": no load or no motion in the mesh.'))
    return table


def side_by_side(title: str, parts: Mapping[str, Iterable[Figure]]) -> Table:
    """Figures of parts of one kind, a column for each part."""
    table = number_table(title, "", *(name.replace("_", " ") for name in parts), "unit")
    table.columns[-1].justify = "left"
    table.columns[0].no_wrap = len(parts) <= MOST_BESIDE
    columns: Sequence[Iterable[Figure]] = tuple(parts.values())
    for row in zip(*columns, strict=True):
        cells = (shown(item.value) for item in row)
        table.add_row(row[0].label, *cells, unit_text(row[0].unit))
    return table


def figure_table(title: str, items: Iterable[Figure]) -> Table:
    """Figures of one part."""
    return side_by_side(title, {"value": items})
