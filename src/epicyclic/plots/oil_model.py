"""A fitted oil model against the simulations behind it, and over the film ratio."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from epicyclic.contact import LineContacts, contacts_at
from epicyclic.oilmodel.model import REGIMES, OilModel
from epicyclic.plots.style import (
    COLOURS,
    LINE_STYLES,
    label_logarithms,
    legend_below,
    styled_figure,
)
from epicyclic.units import percent

FloatArray = NDArray[np.float64]
Simulated = Mapping[str, tuple[LineContacts, FloatArray]]

MARKERS = ("o", "^", "s")
LABELS = {
    "friction": "coefficient of friction",
    "rolling_loss": "rolling loss of teeth, W/m",
    "bearing_rolling_loss": "rolling loss of rollers, W/m",
}
BAND = 0.25
"""Half-width of the lines beside equality. [1]"""
CAPTION = (
    f"Lines: fitted as simulated, and {percent(BAND, 0)} more or less. "
    "The fit has seen these contacts; its errors at others are larger, and stand in the table."
)
PANEL = (4.0, 3.4)
"""Width and height of one of the Axes. [inch]"""
SLIPS = (0.05, 0.2, 0.8)
POINTS = 80


def oil_model_figure(model: OilModel, simulated: Simulated) -> Figure:
    """Every quantity computed against simulated, and friction over the film ratio."""
    count = len(model.fits) + ("friction" in model.fits)
    rows, columns = (2, 2) if count > 3 else (1, count)
    with styled_figure(rows, columns, model.oil.title, panel=PANEL, caption=CAPTION) as (
        figure,
        axes,
    ):
        for ax, quantity in zip(axes.flat, model.fits, strict=False):
            plot_against_simulations(model, quantity, *simulated[quantity], ax)
        if "friction" in model.fits:
            plot_over_film_ratio(model, axes.flat[len(model.fits)])
    return figure


def plot_against_simulations(
    model: OilModel, quantity: str, states: LineContacts, target: FloatArray, ax: Axes
) -> Axes:
    """The default form over the simulations, by film ratio."""
    value = model.value(quantity, states)
    regimes = list(REGIMES.items())[1:]
    for (name, (low, high)), colour, marker in zip(regimes, COLOURS, MARKERS, strict=False):
        here = (states.film_ratio > low) & (states.film_ratio <= high)
        if here.any():
            ax.plot(target[here], value[here], marker, color=colour, ms=3.5, alpha=0.7, label=name)
    ends = np.array([min(target.min(), value.min()), max(target.max(), value.max())])
    for factor, style in ((1.0, "-"), (1 + BAND, ":"), (1 / (1 + BAND), ":")):
        ax.plot(ends, factor * ends, style, color="0.4", lw=0.8)
    if quantity != "friction":
        ax.set_xscale("log")
        ax.set_yscale("log")
        label_logarithms(ax.xaxis, ax.yaxis)
    name, _, unit = LABELS[quantity].partition(", ")
    ax.set(
        title=f"{name[:1].upper()}{name[1:]}",
        xlabel=f"simulated, {unit}" if unit else "simulated",
        ylabel=f"fitted, {unit}" if unit else "fitted",
    )
    legend_below(ax, ncols=2)
    return ax


def plot_over_film_ratio(model: OilModel, ax: Axes) -> Axes:
    """Friction at middle conditions as the roughness changes, each form with a line of its own."""
    fit = model.fits["friction"]
    middle = _middle(fit.domain, model.equivalent_modulus)
    styles = itertools.cycle(LINE_STYLES)
    for slip, colour in zip(SLIPS, COLOURS, strict=False):
        states = middle.changed(slide_to_roll_ratio=np.full(POINTS, slip))
        for fitted in fit.forms:
            values = model.value("friction", states, fitted.form)
            form = f", {fitted.form}" if len(fit.forms) > 1 else ""
            style, label = next(styles), f"slip {slip:g}{form}"
            ax.plot(states.film_ratio, values, linestyle=style, color=colour, label=label)
    ax.set_xscale("log")
    label_logarithms(ax.xaxis)
    ax.set_ylim(bottom=0)
    ax.set_xlabel("film ratio, by roughness")
    ax.set_title("At the middle of the simulated conditions")
    ax.set_ylabel(LABELS["friction"])
    legend_below(ax, ncols=3)
    return ax


def _middle(domain: Mapping[str, tuple[float, float]], modulus: float) -> LineContacts:
    """Contacts in the middle of a domain but for their roughness, which runs through it."""
    middle = {
        name: np.full(POINTS, np.sqrt(max(low, 1e-30) * max(high, 1e-30)))
        for name, (low, high) in domain.items()
    }
    for name in ("roughness1", "roughness2"):
        middle[name] = np.geomspace(*domain[name], POINTS)
    return contacts_at(**middle, equivalent_modulus=modulus)
