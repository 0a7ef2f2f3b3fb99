"""How well a result is known: its distribution, and what that is due to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from epicyclic.case.uncertain_values import MODEL_FORM
from epicyclic.plots.style import COLOURS, legend_below, styled_figure
from epicyclic.units import format_number, power_unit

if TYPE_CHECKING:
    import xarray as xr

MOST_DRIVERS = 12
TICKS = 6
"""Most ticks under a distribution: its values have many digits."""
WIDE = (7.2, 4.2)
"""Width and height of a picture with long names beside its bars. [inch]"""


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
    ax.hlines(range(len(drivers)), low, high, color="black", lw=1.2, label="least to most")
    ax.set_yticks(range(len(drivers)), [_name(key) for key in drivers])
    ax.set(
        title="What the uncertainty of the total loss is due to",
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
        title="What the uncertainty of the total loss is due to",
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
