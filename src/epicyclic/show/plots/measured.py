"""Measured losses beside computed ones: parity, and residuals over the conditions."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.show.plots.style import COLOURS, labelled, styled_figure
from epicyclic.study.measured.comparison import AS_GIVEN, CALIBRATED, MeasuredComparison
from epicyclic.study.operating import OPERATING
from epicyclic.units import format_number, percent, unit_text

PANEL = (3.8, 3.1)  # Width and height of one of the Axes. [inch]
COLUMNS = 4  # Most columns that the legend has.
BAND = 0.10  # Lines beside those of equal losses. [1]
SERIES_GAP = 0.012  # Distance between series of residuals, over the range of the axis. [1]
COVERED = 2.0  # Uncertainties that most residuals lie within. [1]
MOST_NUMBERS = 40  # Most points whose numbers stand below the residuals.
MARKERS = "osD^vP"  # One for each group, beside its colour; for print without colours.
_FADED = {"color": "0.6", "mfc": "none", "ls": "none", "ms": 5, "zorder": 1}


def measured_figure(comparison: MeasuredComparison) -> Figure:
    """Parity, residuals over speed, torque and temperature, and residuals point by point."""
    with styled_figure(2, 3, _title(comparison), panel=PANEL) as (figure, axes):
        plot_parity(comparison, axes[0, 0])
        for ax in axes[1, 1:]:  # one in their place
            ax.remove()
        plot_points(comparison, figure.add_subplot(axes[1, 1].get_gridspec()[1, 1:]))
        for name, ax in zip(OPERATING, axes.flat[1:4], strict=True):
            if name in comparison.measured.conditions:
                plot_residuals(comparison, name, ax)
            else:
                ax.set_axis_off()
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=COLUMNS, frameon=False)
    return figure


def plot_parity(comparison: MeasuredComparison, ax: Axes) -> Axes:
    """Computed over measured loss, with standard uncertainties and lines at ±10 %."""
    measured = comparison.measured
    for state, members, style in _series(comparison):
        computed, bars = comparison.states[state][members], _bars(comparison, state, members)
        ax.errorbar(measured.loss[members], computed, xerr=bars, **style)
    values = np.concatenate([measured.loss, *comparison.states.values()])
    top = 1.08 * float(np.nanmax(values))
    line = np.array([min(0.0, 1.08 * float(np.nanmin(values))), top])
    ax.plot(line, line, color="black", lw=0.9)
    for side in (1 - BAND, 1 + BAND):
        ax.plot(line, side * line, color="black", lw=0.8, ls="--")
    ax.plot([], [], color="black", lw=0.8, ls="--", label=f"±{percent(BAND, 0)}")
    ax.set(
        title="Computed against measured",
        xlabel="measured loss, W",
        ylabel="computed loss, W",
        xlim=line,
        ylim=line,
    )
    return ax


def plot_points(comparison: MeasuredComparison, ax: Axes) -> Axes:
    """Residual of each point, over its uncertainty if it has one, by the line of the table.

    A fit moves points along thin lines.
    """
    measured = comparison.measured
    weighted = measured.uncertainty is not None
    left = {
        state: comparison.normalised(state) if weighted else comparison.residuals(state)
        for state in comparison.states
    }
    place = np.arange(len(measured))
    if len(left) > 1:
        ax.vlines(place, left[AS_GIVEN], left[CALIBRATED], color="0.75", lw=0.9, zorder=0.5)
    for state, members, style in _series(comparison):
        ax.plot(place[members], left[state][members], **style)
    if weighted:
        ax.axhspan(-COVERED, COVERED, color="0.92", zorder=0)
    ax.axhline(0.0, color="black", lw=0.9)
    every = max(1, math.ceil(len(measured) / MOST_NUMBERS))
    ax.set_xticks(place[::every], [str(line) for line in measured.lines[::every]])
    of_what = f"residual over u (grey: ±{COVERED:g})" if weighted else "computed − measured, W"
    return labelled(ax, "line of the table", of_what, "Residuals by point")


def plot_residuals(comparison: MeasuredComparison, over: str, ax: Axes) -> Axes:
    """Computed less measured loss over ``"speed"``, ``"torque"`` or ``"temperature"``.

    Series stand a little beside each other, so that none hides another, unless they differ in it.
    """
    where = comparison.measured.conditions[over]
    series = list(_series(comparison))
    values = np.unique(where)
    gap = 0.0 if over == comparison.group else SERIES_GAP * float(np.ptp(where) or 1.0)
    for number, (state, members, style) in enumerate(series):
        error = comparison.residuals(state)[members]
        x = where[members] + gap * (number - (len(series) - 1) / 2)
        ax.errorbar(x, error, yerr=_bars(comparison, state, members), **style)
    ax.axhline(0.0, color="black", lw=0.9)
    part = OPERATING[over]
    label = f"{part.label}, {unit_text(part.unit)}"
    ax.set(title=f"Residuals over {over}", xlabel=label, ylabel="computed − measured, W")
    if values.size == 1:
        ax.set(xticks=values, xlim=(values[0] - 0.5, values[0] + 0.5))
    else:
        ax.margins(x=0.08)
    return ax


def _bars(comparison: MeasuredComparison, state: str, members: BoolArray) -> FloatArray | None:
    """Standard uncertainties of a series; drawn once, not at what stands below in grey."""
    sigma = comparison.measured.uncertainty
    hidden = comparison.fit is not None and state == AS_GIVEN
    return None if sigma is None or hidden else sigma[members]


def _series(comparison: MeasuredComparison) -> Iterator[tuple[str, BoolArray, dict[str, Any]]]:
    """State, points and style of each series: as given in grey below what is calibrated."""
    state = CALIBRATED if CALIBRATED in comparison.states else AS_GIVEN
    if state == CALIBRATED:
        everywhere = np.ones(len(comparison.measured), dtype=bool)
        yield AS_GIVEN, everywhere, _FADED | {"marker": "o", "label": AS_GIVEN}
    labels = np.array(comparison.measured.labels[comparison.group])
    for number, value in enumerate(dict.fromkeys(comparison.measured.labels[comparison.group])):
        for held_out in (False, True):
            members = (labels == value) & (comparison.held_out == held_out)
            if members.any():
                colour = COLOURS[number % len(COLOURS)]
                style = {
                    "color": colour,
                    "marker": MARKERS[number % len(MARKERS)],
                    "mfc": "white" if held_out else colour,
                    "ms": 5,
                    "ls": "none",
                    "label": _label(comparison, value, state, held_out),
                }
                yield state, members, style


def _label(comparison: MeasuredComparison, value: str, state: str, held_out: bool) -> str:
    unit = " °C" if comparison.group == "temperature" else ""
    parts = [f"{comparison.group} {value}{unit}"]
    if state == CALIBRATED:
        parts += [CALIBRATED] + ["held out"] * held_out
    return ", ".join(parts)


def _title(comparison: MeasuredComparison) -> str:
    title = comparison.case.title or "Measured and computed losses"
    if comparison.fit is None:
        return title
    values = "\n".join(
        f"{item.key} = {format_number(item.value, 4)} {unit_text(item.unit)}".rstrip()
        for item in comparison.fit.parameters
    )
    return f"{title}\n{CALIBRATED}: {values}"
