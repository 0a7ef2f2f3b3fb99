"""Measured losses beside computed ones, for a terminal."""

from __future__ import annotations

import math

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from epicyclic.report.shown import MISSING, shown
from epicyclic.report.tables import number_table, plain_table
from epicyclic.study.measured.comparison import CALIBRATED, ErrorFigures, MeasuredComparison
from epicyclic.study.measured.intervals import Fit, FittedParameter
from epicyclic.study.operating import OPERATING
from epicyclic.study.sweeps.run import AS_TESTED
from epicyclic.units import unit_text

MOST_POINTS = 40
"""Points that are shown; JSON and the table in Python have all."""


def measured_tables(comparison: MeasuredComparison) -> RenderableType:
    """Errors by set of points; with a fit, the calibrated values and what limits them."""
    parts: list[RenderableType] = [_error_table(comparison), Text(_legend(comparison)), Text()]
    parts.append(_point_table(comparison))
    if len(comparison.measured) > MOST_POINTS:
        parts.append(Text(f"The first {MOST_POINTS} of {len(comparison.measured)} points."))
    if comparison.fit is not None:
        parts += [Text(), _fit_table(comparison.fit)]
        if len(comparison.fit.parameters) > 1:
            parts.append(_correlation_table(comparison.fit))
        parts.append(Text(_fit_line(comparison.fit)))
        parts += [Text(f"Warning: {note}", style="bold") for note in comparison.fit.warnings]
    return Group(*parts, *(Text(f"Note: {note}") for note in comparison.notes))


def _error_table(comparison: MeasuredComparison) -> Table:
    names = ["n", "mean W", "mean %", "rms W", "size %", "most W", "most %", "line"]
    weighted = comparison.measured.uncertainty is not None
    heads = ["case, points", *names, *["χ²"] * weighted]
    table = number_table("Computed less measured loss", *heads, no_wrap=(True, True))
    for number, row in enumerate(comparison.errors):
        if number and not row.group:
            table.add_section()
        name = f"  {row.group}" if row.group else f"{row.state}: {row.points}"
        cells = _error_cells(row)[: len(names) + weighted]
        table.add_row(name, *cells, style="" if row.group else "bold")
    return table


def _point_table(comparison: MeasuredComparison) -> Table:
    """Every point: measured, computed before and after a fit, and what is left."""
    measured, states = comparison.measured, comparison.states
    last = list(states)[-1]
    weighted = measured.uncertainty is not None
    table = plain_table("Points")
    conditions = [
        (unit_text(OPERATING[name].unit), values) for name, values in measured.conditions.items()
    ]
    columns = [*conditions, ("measured W", measured.loss)]
    if measured.uncertainty is not None:
        columns.append(("u W", measured.uncertainty))
    columns += [(f"{name} W", values) for name, values in states.items()]
    columns.append(("residual W", comparison.residuals(last)))
    if weighted:
        columns.append(("over u", comparison.normalised(last)))
    for name in ("line", *(name for name, _ in columns)):
        table.add_column(name, justify="right")
    for row, line in enumerate(measured.lines[:MOST_POINTS]):
        mark = "*" if comparison.held_out[row] else ""
        table.add_row(f"{line}{mark}", *(shown(float(values[row])) for _, values in columns))
    return table


def _error_cells(row: ErrorFigures) -> list[str]:
    return [
        str(row.count),
        shown(row.bias, 3),
        _percent(row.relative_bias),
        shown(row.rms, 3),
        _percent(row.mean_percentage),
        shown(row.largest, 3),
        _percent(row.relative_largest),
        str(row.largest_line) if row.count else MISSING,
        shown(row.chi_squared, 3),
    ]


def _percent(value: float) -> str:
    return MISSING if math.isnan(value) else f"{100 * value:z.1f}"


def _legend(comparison: MeasuredComparison) -> str:
    text = (
        "mean: of the errors; size: mean of their magnitude; most: by magnitude, in W with its "
        "line; %: over the measured loss."
    )
    if comparison.load_dependent == AS_TESTED:
        text += (
            " Load-dependent losses as tested: total loss less that without torque at the same "
            "speed and oil inlet temperature, each at its own temperatures."
        )
    if comparison.held_out.any():
        text += " Lines with * were held out."
    if comparison.fit is not None:
        text += f" {CALIBRATED}: with values fitted to these measurements; that is no validation."
    return text


def _fit_table(fit: Fit) -> Table:
    interval = f"{100 * fit.confidence:.4g} % interval"
    heads = ("key", "start", CALIBRATED, "std. error", interval)
    table = number_table(f"{CALIBRATED} values", *heads, no_wrap=(True, True))
    table.add_column("unit")
    for item in fit.parameters:
        table.add_row(
            item.key,
            shown(item.start),
            shown(item.value),
            shown(item.standard_error, 2),
            _interval(item),
            unit_text(item.unit),
        )
    return table


def _interval(item: FittedParameter) -> str:
    if item.at_bound and math.isnan(item.low):
        return "at its bound"
    return MISSING if math.isnan(item.low) else f"{shown(item.low)} to {shown(item.high)}"


def _correlation_table(fit: Fit) -> Table:
    heads = (f"({number + 1})" for number in range(len(fit.parameters)))
    table = number_table("Correlations", "", *heads, no_wrap=(True, False))
    for number, (item, row) in enumerate(zip(fit.parameters, fit.correlation, strict=True)):
        table.add_row(f"({number + 1}) {item.key}", *(shown(value, 3) for value in row))
    return table


def _fit_line(fit: Fit) -> str:
    text = (
        f"Weighted least squares, {fit.points} points, {fit.degrees_of_freedom} degrees of freedom"
    )
    if math.isfinite(fit.chi_squared):
        text += f", χ² {shown(fit.chi_squared, 4)}"
    text += f"; {fit.evaluations} computed points. {_about_intervals(fit)}"
    if fit.discrepancy > 0 and fit.widening > 1:
        text += (
            f" Birge ratio {shown(fit.widening, 3)}: beyond the uncertainties of the measurements "
            f"the model is off by about {shown(fit.discrepancy, 2)} W at these points. That "
            "variance is in the intervals."
        )
    elif math.isfinite(fit.discrepancy) and math.isnan(fit.widening):
        text += (
            f" The points scatter by {shown(fit.discrepancy, 2)} W about the fit, measurements and "
            "model together."
        )
    return text


def _about_intervals(fit: Fit) -> str:
    if all(item.profiled for item in fit.parameters):
        return "Intervals follow from profiles of the likelihood."
    return "Intervals are those of the linearised model."


def fitted_comment(item: FittedParameter, fit: Fit) -> str:
    """What a case file says behind a calibrated value."""
    start = f"{shown(item.start)} {unit_text(item.unit)}".rstrip()
    return (
        f"{CALIBRATED}; {100 * fit.confidence:.4g} % interval: {_interval(item)}; before: {start}"
    )
