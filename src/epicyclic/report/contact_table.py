"""Table of one line contact."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic.analysis.contact import ContactFigure, ContactResult
from epicyclic.report.shown import shown
from epicyclic.report.tables import plain_table
from epicyclic.status import Status
from epicyclic.units import Quantity, unit_text

__all__ = ["contact_tables"]


def contact_tables(result: ContactResult) -> RenderableType:
    """Figures of a contact and how its solution ended."""
    table = plain_table(result.case.title or "Line contact")
    table.add_column("", no_wrap=True)
    table.add_column("", justify="right")
    table.add_column("")
    for figure in result.figures:
        table.add_row(figure.name, shown(_displayed(figure)), unit_text(figure.display))
    return Group(table, Text(_ending(result)))


def _displayed(figure: ContactFigure) -> float:
    if figure.display == figure.unit:
        return figure.value
    if figure.display == "%":
        return 100 * figure.value
    return Quantity(figure.name, figure.unit, figure.display).to_display(figure.value)


def _ending(result: ContactResult) -> str:
    if result.status is not Status.CONVERGED:
        return f"Not converged: {result.message}."
    if result.rough is None:
        return f"Converged in {result.smooth.iterations} Newton steps."
    rough = result.rough
    return f"Converged; {rough.steps} time steps, {rough.unsolved_steps} of them not solved."
