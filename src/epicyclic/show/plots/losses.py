"""Losses of one result, and how well they are known."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from epicyclic.case.tables.uncertainty import MODEL_FORM
from epicyclic.result.result import Result, in_words
from epicyclic.show.plots.style import COLOURS, legend_below, styled_figure, write_beside
from epicyclic.units import decimals_of, format_number, percent, power_unit

if TYPE_CHECKING:
    import xarray as xr


# Losses of one result: how large each component is, and how they add up.


GROUP_COLOURS = {"load-dependent": COLOURS[0], "load-independent": COLOURS[4]}
SUM_COLOUR = "0.45"
ROOM = 1.32  # Length of the axis over that of the longest bar, for the numbers beside the bars. [1]
MOST_BARS = 16


def plot_losses(result: Result, ax: Axes) -> Axes:
    """Every component of the loss, its power and share; of several sets every set and part."""
    unit, scale = power_unit(result.total)
    total, rows = result.total / scale, _rows(result, scale)
    sums = dict.fromkeys((label for label, *_ in rows), 0.0)
    starts = []
    for label, _, watts in rows:
        starts.append(sums[label])
        sums[label] += watts
    ax.barh(
        [label for label, *_ in rows],
        [watts for *_, watts in rows],
        left=starts,
        color=[GROUP_COLOURS[group] for _, group, _ in rows],
        edgecolor="black",
        linewidth=0.5,
    )
    for row, value in enumerate(sums.values()):
        share = f" ({percent(value / total)})" if total else ""
        write_beside(ax, f"{value:.{decimals_of(total)}f}{share}", (value, row))
    _finish(ax, sums.values())
    ax.set(title="Losses by component", xlabel=f"power loss, {unit}")
    return ax


def plot_loss_sum(result: Result, ax: Axes) -> Axes:
    """How the components add up to the total loss, the largest of each group first."""
    start = 0.0
    labels: list[str] = []
    unit, scale = power_unit(result.total)
    total, rows = result.total / scale, _rows(result, scale)
    digits = decimals_of(total)
    for group, colour in GROUP_COLOURS.items():
        terms = [(watts, label) for label, own, watts in rows if own == group and watts]
        for watts, label in sorted(terms, reverse=True):
            _step(ax, len(labels), start, watts, colour, digits)
            labels.append(label)
            start += watts
    _step(ax, len(labels), 0.0, total, SUM_COLOUR, digits)
    ax.set_yticks(range(len(labels) + 1), [*labels, "total"])
    _finish(ax, [total])
    ax.set(title="How the losses add up", xlabel=f"power loss, {unit}")
    return ax


def _rows(result: Result, scale: float) -> list[tuple[str, str, float]]:
    """Label, group and power of every bar: of every set, or what a single one loses by component.

    Where these are too many, all losses of a mesh, bearing or body are one.
    """
    sums: dict[tuple[str, str], float] = {}
    labels = _labels(result)
    for term in result.terms:
        if term.name in labels:
            key = in_words(labels[term.name]), term.group
            sums[key] = sums.get(key, 0.0) + term.watts / scale
    return [(label, group, power) for (label, group), power in sums.items()]


def _labels(result: Result) -> dict[str, str]:
    """The bar to which each loss belongs."""
    shown = [term.name for term in result.terms if not term.left_out]
    if result.kind == "train":
        sets = {name: name.partition(".")[0] for name in shown}
        if len(set(sets.values())) > 1:
            return sets
    components = {name: name.rpartition(".")[2] for name in shown}
    if len(set(components.values())) <= MOST_BARS:
        return components
    return {name: component.rpartition("_")[0] for name, component in components.items()}


def _step(ax: Axes, row: int, start: float, watts: float, colour: str, digits: int) -> None:
    ax.barh(row, watts, left=start, color=colour, edgecolor="black", linewidth=0.5)
    write_beside(ax, f"{watts:.{digits}f}", (start + watts, row))


def _finish(ax: Axes, watts: Iterable[float]) -> None:
    ax.invert_yaxis()
    ax.grid(visible=False, axis="y")
    ax.set_xlim(0, ROOM * max(watts, default=0.0) or 1.0)
    handles = [Patch(facecolor=colour, label=group) for group, colour in GROUP_COLOURS.items()]
    legend_below(ax, handles=handles, ncols=2)


# How well a result is known: its distribution, and what that is due to.


MOST_DRIVERS = 12
TICKS = 6  # Most ticks under a distribution: its values have many digits.
WIDE = (7.2, 4.2)  # Width and height of a picture with long names beside its bars. [inch]


def drivers_figure(data: xr.Dataset) -> Figure:
    """`plot_drivers` as a figure."""
    with styled_figure(1, 1, data.attrs["title"], panel=WIDE) as (figure, axes):
        plot_drivers(data, axes[0, 0])
    return figure


def band_figure(data: xr.Dataset) -> Figure:
    """`plot_band` of the total loss and of the efficiency as a figure."""
    names = banded(data)
    with styled_figure(1, len(names), data.attrs["title"]) as (figure, axes):
        for name, ax in zip(names, axes[0], strict=True):
            plot_band(data, name, ax)
    return figure


def banded(data: xr.Dataset) -> tuple[str, ...]:
    """Results whose bands are drawn: the efficiency if power is passed on."""
    known = bool(np.isfinite(data["low"].sel(result="efficiency")))
    return ("total", "efficiency") if known else ("total",)


def shares_figure(data: xr.Dataset) -> Figure:
    """`plot_shares` as a figure."""
    with styled_figure(1, 1, data.attrs["title"], panel=WIDE) as (figure, axes):
        plot_shares(data, axes[0, 0])
    return figure


def mean_shares(data: xr.Dataset) -> xr.DataArray:
    """Shares of the variance of the total loss over a map, the mean where the loss is."""
    shares, weights = data["first_order"], data["total"].fillna(0.0)
    return (shares.fillna(0.0) * weights).sum(weights.dims) / weights.sum()


def plot_shares(
    data: xr.Dataset,  # A map with its uncertainty.
    ax: Axes,
) -> Axes:
    """Shares of inputs and models in the variance of the total loss over a map: mean and range."""
    mean = mean_shares(data)
    mean = mean.sortby(mean)[-MOST_DRIVERS:]
    drivers = [str(key) for key in mean["driver"].values]
    own, over = 100 * data["first_order"].sel(driver=drivers), data["total"].dims
    low, high = (end.to_numpy() for end in (own.min(over), own.max(over)))
    colours = [COLOURS[4 if key.startswith(MODEL_FORM) else 0] for key in drivers]
    middle = 100 * mean.to_numpy()
    ax.barh(range(len(drivers)), middle, color=colours, edgecolor="black", linewidth=0.5)
    ax.hlines(range(len(drivers)), low, high, color="black", lw=1.2, label="minimum to maximum")
    ax.set_yticks(range(len(drivers)), [_name(key) for key in drivers])
    ax.set(
        title="Causes of the uncertainty of the total loss",
        xlabel="share of its variance over the map, weighted with the loss, %",
    )
    for place, label in ((0, "inputs"), (4, "models")):
        ax.barh([0], [0], color=COLOURS[place], edgecolor="black", linewidth=0.5, label=label)
    legend_below(ax, ncols=3)
    return ax


def _light(colour: str) -> tuple[float, ...]:
    """A colour with two parts of white."""
    return tuple((part + 2) / 3 for part in to_rgb(colour))


def _name(key: str) -> str:
    """``"model: sliding"``, or the key of an input."""
    return f"model: {key.removeprefix(MODEL_FORM)}" if key.startswith(MODEL_FORM) else key


def plot_drivers(
    data: xr.Dataset,  # As `epicyclic.uncertainty` returns it.
    ax: Axes,
) -> Axes:
    """Change of the total loss for one standard deviation of each input and model, in order."""
    change = data["contribution"].sel(result="total")
    change = change[change != 0]
    change = change.sortby(abs(change))[-MOST_DRIVERS:]
    keys = [str(key) for key in change["input"].values]
    models = [key.startswith(MODEL_FORM) for key in keys]
    names = [_name(key) for key in keys]
    for wanted, label, colour in ((False, "inputs", COLOURS[0]), (True, "models", COLOURS[4])):
        rows = [row for row, model in enumerate(models) if model == wanted]
        watts = change.values[rows]
        ax.barh(rows, watts, color=colour, edgecolor="black", linewidth=0.5, label=label)
        ax.barh(rows, -watts, color=_light(colour), edgecolor="black", linewidth=0.5)
    ax.set_yticks(range(len(names)), names)
    ax.axvline(0.0, color="black", lw=0.8)
    ax.set(
        title="Causes of the uncertainty of the total loss",
        xlabel=f"change for one standard deviation up (dark) and down, {_unit(data, 'total')}",
    )
    legend_below(ax, ncols=2)
    return ax


def _unit(data: xr.Dataset, name: str) -> str:
    return str(data["unit"].sel(result=name).values)


def plot_band(data: xr.Dataset, name: str, ax: Axes) -> Axes:
    """Distribution of a result with its 95 % interval and the value of the case."""
    one = data.sel(result=name)
    unit = _unit(data, name)
    percent = unit == "1"
    scale = 100.0 if percent else 1.0
    if unit == "W":
        unit, size = power_unit(float(one["high"]))
        scale = 1 / size
    values = one["value"].values * scale
    low, high, nominal = (float(one[key]) * scale for key in ("low", "high", "nominal"))
    ax.axvspan(low, high, color=COLOURS[5], alpha=0.25, label="95 % interval")
    counts, edges = np.histogram(values[np.isfinite(values)], "auto")
    ax.stairs(counts, edges, fill=True, color=COLOURS[0])
    ax.axvline(nominal, color=COLOURS[1], lw=1.6, label="case")
    ax.axvline(float(one["mean"]) * scale, color="black", lw=1.2, ls="--", label="mean")
    low_text, high_text = (f"{it:.2f}" if percent else format_number(it, 3) for it in (low, high))
    what = "total loss" if unit in {"W", "kW"} else "energy lost"
    ax.set(
        title=f"95 %: {low_text} to {high_text} {'%' if percent else unit}",
        xlabel="efficiency, %" if percent else f"{what}, {unit}",
        ylabel="samples",
    )
    ax.xaxis.set_major_locator(MaxNLocator(TICKS))
    legend_below(ax, ncols=3)
    return ax
