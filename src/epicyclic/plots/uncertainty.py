"""How well a result is known: its distribution, and what that is due to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from epicyclic.case.uncertain_values import MODEL_FORM
from epicyclic.plots.style import COLOURS, legend_below, styled_figure

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["band_figure", "drivers_figure", "plot_band", "plot_drivers"]

MOST_DRIVERS = 12
_WIDE = (7.2, 4.2)


def drivers_figure(data: xr.Dataset) -> Figure:
    """`plot_drivers` as a figure."""
    with styled_figure(1, 1, data.attrs["title"], panel=_WIDE) as (figure, axes):
        plot_drivers(data, axes[0, 0])
    return figure


def band_figure(data: xr.Dataset) -> Figure:
    """`plot_band` of the total loss and of the efficiency as a figure."""
    known = bool(np.isfinite(data["nominal"].sel(result="efficiency")))
    names = ("total", "efficiency") if known else ("total",)
    with styled_figure(1, len(names), data.attrs["title"]) as (figure, axes):
        for name, ax in zip(names, axes[0], strict=True):
            plot_band(data, name, ax)
    return figure


def plot_drivers(data: xr.Dataset, ax: Axes) -> Axes:
    """Change of the total loss for one standard deviation of each input and model, largest first.

    Parameters
    ----------
    data : xarray.Dataset
        As `epicyclic.uncertainty` returns it.
    """
    change = data["contribution"].sel(result="total")
    change = change[change != 0]
    change = change.sortby(abs(change))[-MOST_DRIVERS:]
    keys = [str(key) for key in change["input"].values]
    models = [key.startswith(MODEL_FORM) for key in keys]
    names = [
        f"model: {key.removeprefix(MODEL_FORM)}" if model else key
        for key, model in zip(keys, models, strict=True)
    ]
    for wanted, label, colour in ((False, "inputs", COLOURS[0]), (True, "models", COLOURS[4])):
        rows = [row for row, model in enumerate(models) if model == wanted]
        watts = change.values[rows]
        ax.barh(rows, watts, color=colour, edgecolor="black", linewidth=0.5, label=label)
        ax.barh(rows, -watts, color=colour, edgecolor="black", linewidth=0.5, alpha=0.35)
    ax.set_yticks(range(len(names)), names)
    ax.axvline(0.0, color="black", lw=0.8)
    ax.set(
        title="What the uncertainty of the total loss is due to",
        xlabel="change for one standard deviation up (dark) and down, W",
    )
    legend_below(ax, ncols=2)
    return ax


def plot_band(data: xr.Dataset, name: str, ax: Axes) -> Axes:
    """Distribution of a result with its 95 % interval and the value of the case."""
    one = data.sel(result=name)
    percent = str(one["unit"].values) != "W"
    scale = 100.0 if percent else 1.0
    values = one["value"].values * scale
    low, high, nominal = (float(one[key]) * scale for key in ("low", "high", "nominal"))
    ax.axvspan(low, high, color=COLOURS[5], alpha=0.25, label="95 % interval")
    ax.hist(values[np.isfinite(values)], "auto", color=COLOURS[0], edgecolor="white", linewidth=0.3)
    ax.axvline(nominal, color=COLOURS[1], lw=1.6, label="case")
    ax.axvline(float(one["mean"]) * scale, color="black", lw=1.2, ls="--", label="mean")
    digits = 2 if percent else 0
    unit = "%" if percent else "W"
    ax.set(
        title=f"{low:.{digits}f} to {high:.{digits}f} {unit}",
        xlabel="efficiency, %" if percent else "total loss, W",
        ylabel="samples",
    )
    legend_below(ax, ncols=3)
    return ax
