"""Published against computed, for a terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic.bands.published import MeasuredFigure
from epicyclic.report.page import Cell, Table, aligned
from epicyclic.report.shown import MISSING, shown
from epicyclic.report.tables import number_table
from epicyclic.units import percent
from epicyclic.validation.closures import CLOSURES, STUDY, ClosureFigure
from epicyclic.validation.compare import Comparison, summary
from epicyclic.validation.settled import Estimate, SettledFigure

_STYLES = {"agrees": "green", "differs": "bold red", "calibrated": "dim", "no verdict": "dim"}


def validation_table(
    rows: Sequence[Comparison], closures: Sequence[ClosureFigure] = ()
) -> RenderableType:
    """One row for each figure, and a count of the verdicts."""
    heads = ("figure, source", "published", "computed", "difference")
    table = number_table("Published against computed", *heads, no_wrap=(False, True))
    table.add_column("verdict", no_wrap=True)
    for row in rows:
        table.add_row(
            Text.assemble(row.what, ("\n" + "\n".join(remarks(row)), "dim")),
            f"{published_text(row)} {row.unit}".rstrip(),
            f"{shown(row.computed)} {row.unit}".rstrip(),
            percent(row.difference, signed=True),
            Text(verdict_text(row), style=_STYLES[row.verdict]),
        )
    return Group(table, Text(summary(rows, closures)))


def closure_table(rows: Sequence[ClosureFigure]) -> Table:
    """One row for each open figure of the study of pocketing, one column for each closure."""
    causes = dict.fromkeys(f"{percent(row.tolerance, 0)}: {row.cause}" for row in rows)
    cells = [
        (
            Cell(f"{row.what}, {row.unit}".rstrip(", ")),
            aligned(
                shown(row.low) if row.low == row.high else f"{shown(row.low)} to {shown(row.high)}"
            ),
            *(
                aligned(f"{shown(row.computed[name])} {'holds' if row.holds(name) else 'misses'}")
                for name in CLOSURES
            ),
        )
        for row in rows
    ]
    held = (f"{sum(row.holds(name) for row in rows)} of {len(rows)}" for name in CLOSURES)
    cells.append((Cell("holds"), Cell(""), *map(aligned, held)))
    return Table(
        ("", "published", *CLOSURES),
        tuple(cells),
        f"Pocketing, open figures of {STUDY}, by models.pocketing",
        frozenset([len(rows)]),
        f"Sources: {'; '.join(dict.fromkeys(row.source for row in rows))}. Tolerances beyond the "
        f"band: {'; '.join(causes)}.",
    )


def settled_table(rows: Sequence[SettledFigure], estimates: Sequence[Estimate]) -> RenderableType:
    """One row for each figure of the loaded tests, one column for each model of temperatures."""
    heads = ("figure", "published", "inlet", "flank", "network", "network, range")
    title = "Loaded tests, load-dependent losses as tested"
    table = number_table(title, *heads, no_wrap=(False, True))
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


def band_rows(rows: Sequence[MeasuredFigure]) -> list[tuple[str, ...]]:
    """Figure, measured, computed, its 95 % band, and whether the measurement lies inside."""
    return [
        (
            f"{row.what}, {row.unit}",
            shown(row.measured),
            shown(row.computed, 3),
            f"{shown(row.low, 3)} to {shown(row.high, 3)}",
            "inside" if row.is_inside else "outside",
        )
        for row in rows
    ]


def band_markdown(rows: Sequence[MeasuredFigure]) -> str:
    """`band_rows` as the manual shows them."""
    head = ("Measured figure", "Measured", "Computed", "95 % band", "")
    cells = [head, ("---",) * len(head), *band_rows(rows)]
    return "\n".join(f"| {' | '.join(row)} |".replace("|  |", "| |") for row in cells)


def bands_table(rows: Sequence[MeasuredFigure]) -> RenderableType:
    """One row for each measured figure."""
    title = "Measured figures, and the 95 % band by the shipped distributions"
    heads = ("figure", "measured", "computed", "95 % band", "")
    table = number_table(title, *heads, no_wrap=(False, True))
    for cells in band_rows(rows):
        table.add_row(*cells)
    inside = sum(row.is_inside for row in rows)
    note = (
        f"{inside} of {len(rows)} measurements lie inside. Inputs and errors of models as they are "
        "assumed where [uncertainty] says nothing, off by the same in all tests; the error of the "
        "measurement is not in the band, and nothing is fitted."
    )
    return Group(table, Text(note))


def remarks(row: Comparison) -> list[str]:
    """Where a figure is printed, how it was inferred, why there is no verdict."""
    found = [row.source]
    if row.inferred:
        found.append(f"Inferred: {row.inferred}.")
    if row.reason:
        found.append(f"{_REASONS[row.role]}: {row.reason}.")
    return found


_REASONS = {"context": "No verdict", "calibration": "Calibrated"}


def verdict_text(row: Comparison) -> str:
    """The verdict with its tolerance, and a star if that was settled with the figure in view."""
    if row.role != "validation":
        return row.verdict
    seen = "*" if row.settled == "in view" else ""
    return f"{row.verdict} ({100 * row.tolerance:.2g} %{seen})"


def published_text(row: Comparison) -> str:
    """The published value, or the ends of its range."""
    low, high = shown(row.low), shown(row.high)
    return low if low == high else f"{low} to {high}"
