"""Published against computed, for a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic.report.shown import MISSING, shown
from epicyclic.report.tables import plain_table
from epicyclic.validation.compare import Comparison
from epicyclic.validation.settled import Estimate, SettledFigure

__all__ = ["settled_table", "validation_table"]

_STYLES = {"agrees": "green", "differs": "bold red", "calibrated": "dim", "no verdict": "dim"}


def validation_table(rows: Sequence[Comparison]) -> RenderableType:
    """One row for each figure, and a count of the verdicts."""
    table = plain_table("Published against computed")
    table.add_column("figure, source")
    for column in ("published", "computed", "difference"):
        table.add_column(column, justify="right", no_wrap=True)
    table.add_column("verdict", no_wrap=True)
    for row in rows:
        table.add_row(
            Text.assemble(row.what, ("\n" + row.source, "dim")),
            f"{_published(row)} {row.unit}".rstrip(),
            f"{shown(row.computed)} {row.unit}".rstrip(),
            f"{row.difference:+z.1%}",
            Text(_verdict(row), style=_STYLES[row.verdict]),
        )
    counted = [row for row in rows if row.role == "validation"]
    agreeing = sum(row.verdict == "agrees" for row in counted)
    note = Text(
        f"{agreeing} of {len(counted)} figures agree within their tolerances. Figures marked "
        "'calibrated' fixed an unknown input and do not count; 'no verdict' stands for context."
    )
    return Group(table, note)


def settled_table(rows: Sequence[SettledFigure], estimates: Sequence[Estimate]) -> RenderableType:
    """One row for each figure of the loaded tests, one column for each model of temperatures."""
    table = plain_table("Loaded tests, load-dependent losses as tested")
    table.add_column("figure")
    for column in ("published", "inlet", "flank", "network", "network, range"):
        table.add_column(column, justify="right", no_wrap=True)
    for row in rows:
        table.add_row(
            f"{row.what}, {row.unit}",
            " to ".join(map(shown, row.published)) or MISSING,
            *map(shown, (row.inlet, row.flank, row.network)),
            f"{shown(row.low)} to {shown(row.high)}",
        )
    note = Text(
        "By models.temperatures, nothing fitted to these tests, no verdict. As tested: total loss "
        "less that without torque at the same speed and oil inlet temperature, each at its own "
        "temperatures. Range of the network:"
    )
    ranges = (
        Text(
            f"  {item.what}, {item.key}: {item.low} to {item.high}, {item.value} in the column "
            f"'network' ({item.origin})"
        )
        for item in estimates
    )
    return Group(table, note, *ranges)


def _verdict(row: Comparison) -> str:
    if row.role != "validation":
        return row.verdict
    return f"{row.verdict} ({100 * row.tolerance:.2g} %)"


def _published(row: Comparison) -> str:
    low, high = shown(row.low), shown(row.high)
    return low if low == high else f"{low} to {high}"
