"""Table of one line contact."""

from __future__ import annotations

from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic.analysis.contact import ContactFigure, ContactResult
from epicyclic.ehl.roughness import Profile
from epicyclic.report.shown import shown
from epicyclic.report.tables import number_table
from epicyclic.status import Status
from epicyclic.units import MICROMETRE, Quantity, unit_text


def contact_tables(result: ContactResult) -> RenderableType:
    """Figures of a contact and how its solution ended."""
    title = result.case.title or "Line contact"
    table = number_table(title, "", "", no_wrap=(True, False))
    table.add_column("")
    table.show_header = False
    for figure in result.figures:
        table.add_row(figure.name, shown(_displayed(figure)), unit_text(figure.display))
    parts: list[RenderableType] = [table] if result.figures else []
    if not result.model.smooth:
        parts += [Text(_surface(*item)) for item in enumerate(result.model.surfaces, 1)]
    warnings = [Text(f"Warning: {warning}") for warning in result.warnings]
    return Group(*parts, Text(_ending(result)), *warnings)


def _surface(number: int, surface: Profile) -> str:
    """Statistics of a surface, which a generated profile meets on the whole only."""
    if surface.rms == 0:
        return f"Surface {number}: smooth."
    rms, length = (
        f"{shown(MICROMETRE.to_display(value))} {unit_text(MICROMETRE.display)}"
        for value in (surface.rms, surface.correlation_length)
    )
    return (
        f"Surface {number}: Rq {rms}, correlation length {length}, "
        f"skewness {shown(surface.skewness, 2)}, kurtosis {shown(surface.kurtosis, 2)}."
    )


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
