"""Tables of results, libraries and comparisons for a terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rich.console import Console, Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from epicyclic.analysis.compare import FrictionComparison
from epicyclic.elements.base import LOAD_DEPENDENT, LOAD_INDEPENDENT
from epicyclic.elements.figures import figures
from epicyclic.report import page
from epicyclic.report.heat_tables import heat_items
from epicyclic.report.result_parts import (
    efficiency_text,
    figure_table,
    meshes_table,
    number_table,
    plain_table,
    share_cells,
)
from epicyclic.report.train_tables import train_tables, users_text
from epicyclic.results.result import LossTerm, Result
from epicyclic.units import DEGREE, NEWTON_METRE, RPM, unit_text

__all__ = [
    "as_on_page",
    "friction_table",
    "plain_table",
    "result_tables",
    "terminal",
    "titled",
]

PIPE_WIDTH = 100
"""Width of tables that do not go to a terminal. [characters]"""


def terminal() -> Console:
    """The console for results, on standard output."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=PIPE_WIDTH)


def result_tables(result: Result, remarks: Sequence[str] = ()) -> RenderableType:
    """Everything an engineer reads first: losses, figures, warnings, sources.

    Parameters
    ----------
    result : Result
    remarks : sequence of str
        On its temperatures.
    """
    parts = _of_set(result) if result.train is None else train_tables(result, result.train)
    if result.heat is not None:
        parts += map(as_on_page, heat_items(result.heat))
    parts += remarks
    if result.fluid is not None:
        parts.append(figure_table("Oil", figures(result.fluid)))
    if result.planet_angles:
        angles = ", ".join(f"{DEGREE.to_display(angle):z.4f}" for angle in result.planet_angles)
        parts.append(Text(f"Planets at {angles} {DEGREE.display}"))
    if len(set(result.planet_shares)) > 1:
        shares = ", ".join(f"{share:.2%}" for share in result.planet_shares)
        parts.append(Text(f"Their shares of the torque: {shares}"))
    parts.append(_methods(result))
    parts += [_list("Warnings", result.warnings), _list("Sources", result.sources)]
    return titled(result.title or result.kind, *parts)


def titled(title: str, *parts: RenderableType) -> RenderableType:
    """Parts with space between them, under a title."""
    whole = (Text(title, style="bold"), *(Text(it) if isinstance(it, str) else it for it in parts))
    return Group(*(Padding(part, (0, 0, 1, 0)) for part in whole))


def as_on_page(item: page.Table | page.Listing) -> RenderableType:
    """A table or list of a report, for a terminal."""
    if isinstance(item, page.Listing):
        return _list(item.title, item.items)
    table = plain_table(item.title)
    for column, head in enumerate(item.head):
        table.add_column(head, justify="right" if item.is_numeric(column) else "left")
    for place, row in enumerate(item.rows):
        strong = place in item.strong
        last = place + 1 in item.strong
        table.add_row(
            *(cell.text for cell in row), style="bold" if strong else "", end_section=last
        )
    return Group(table, Text(item.note)) if item.note else table


def _of_set(result: Result) -> list[RenderableType]:
    """What only a single set states."""
    parts: list[RenderableType] = [_losses(result), _members(result)]
    parts.append(meshes_table("Meshes", result.meshes))
    if result.bearing is not None:
        parts.append(figure_table("Planet bearing", figures(result.bearing)))
    return parts


def _losses(result: Result) -> Table:
    table = number_table("Losses of the gear set", "", "W", "of total", "of input")
    for group in (LOAD_DEPENDENT, LOAD_INDEPENDENT):
        for term in result.terms:
            if term.group == group:
                table.add_row(term.name.replace("_", " "), *_share_cells(result, term))
        watts = result.load_dependent if group == LOAD_DEPENDENT else result.load_independent
        table.add_row(group, *share_cells(result, watts), style="bold", end_section=True)
    table.add_row("total", *share_cells(result, result.total), style="bold", end_section=True)
    table.add_row("input power", f"{result.input_power:z.1f}", "", "")
    table.add_row("efficiency", efficiency_text(result), "", "")
    return table


def _share_cells(result: Result, term: LossTerm) -> tuple[str, str, str]:
    if term.left_out:
        return "not included", "", ""
    return share_cells(result, term.watts)


def _methods(result: Result) -> Group:
    """Which method computed which terms, each method once."""
    users: dict[str, list[str]] = {}
    for term in result.terms:
        if not term.left_out:
            users.setdefault(term.method, []).append(term.name)
    for what, method in result.load_methods.items():
        users.setdefault(method, []).append(what)
    return _list("Methods", [f"{users_text(names)}: {how}" for how, names in users.items()])


def _members(result: Result) -> Table:
    units = f"speed {unit_text(RPM.display)}", f"torque {unit_text(NEWTON_METRE.display)}"
    table = number_table("Power flow (into the gear set)", "", *units, "power W")
    for name, member in result.flow.members.items():
        table.add_row(
            name,
            f"{RPM.to_display(member.speed):z.1f}",
            f"{NEWTON_METRE.to_display(member.torque):z.2f}",
            f"{member.power:z.1f}",
        )
    return table


def _list(title: str, items: Sequence[str]) -> Group:
    if not items:
        return Group(Text(f"{title}: none"))
    lines = [Padding(Text(f"• {item}"), (0, 0, 0, 2)) for item in items]
    return Group(Text(title, style="bold"), *lines)


def friction_table(rows: Sequence[FrictionComparison]) -> RenderableType:
    """Friction models side by side, with the spread."""
    meshes = list(rows[0].mean_friction)
    if all(math.isnan(row.mean_friction[mesh]) for row in rows for mesh in meshes):
        return Text("There is no load or no motion: nothing slides, and no friction to compare.")
    columns = [f"μ {mesh.replace('_', ' ').replace('.', ': ')}" for mesh in meshes]
    table = number_table("Friction models", "", *columns, "sliding W", "quick W", "to chosen", "")
    table.columns[-1].justify = "left"
    chosen = next((row.sliding for row in rows if row.chosen), 0.0)
    for row in rows:
        marks = ", ".join(
            mark for mark, holds in (("chosen", row.chosen), ("out of range", row.flagged)) if holds
        )
        table.add_row(
            row.name,
            *(f"{row.mean_friction[mesh]:z.4f}" for mesh in meshes),
            f"{row.sliding:z.1f}",
            f"{row.quick:z.1f}",
            f"{row.sliding / chosen:.2f}" if chosen else "",
            marks,
            style="bold" if row.chosen else "",
        )
    low, high = min(row.sliding for row in rows), max(row.sliding for row in rows)
    quick = Text("sliding: local, along the contact lines; quick: mean friction times loss factor")
    spread = Text(
        f"Spread: {low:.1f} to {high:.1f} W" + (f", a factor of {high / low:.2f}." if low else ".")
    )
    sources = _list("Sources", [f"{row.name}: {row.title}, {row.source}" for row in rows])
    return Group(table, quick, spread, Text(), sources)
