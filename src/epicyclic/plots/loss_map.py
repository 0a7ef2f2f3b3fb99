"""Loss maps: one variable over speed and torque, as a field or as lines."""

from __future__ import annotations

from collections.abc import Hashable

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from epicyclic.plots.style import COLOUR_MAP, COLOURS, LINE_STYLES, label_of

__all__ = ["map_at", "plot_map", "plot_map_lines"]

OPERATING = ("speed", "torque")
LEVELS = 12
MOST_LINES = 5


def map_at(data: xr.Dataset, **values: object) -> xr.Dataset:
    """The map over speed and torque at one value of every other dimension: the first, or `values`.

    The values chosen are left as scalar coordinates.
    """
    others = {dim: 0 for dim in data.dims if dim not in (*OPERATING, *values)}
    return data.sel(values).isel(others)


def plot_map(data: xr.Dataset, name: str, ax: Axes) -> Axes:
    """`name` over speed and torque, with lines of equal value.

    Parameters
    ----------
    data : xarray.Dataset
        Of `map_at`.
    """
    values = data[name].transpose("torque", "speed")
    if min(values.shape) < 2 or not np.isfinite(values).any():
        longest = "torque" if data.sizes["torque"] > data.sizes["speed"] else "speed"
        return plot_map_lines(data, name, longest, ax)
    field = ax.pcolormesh(
        data["speed"], data["torque"], values, shading="nearest", cmap=COLOUR_MAP, rasterized=True
    )
    figure = ax.get_figure()
    assert figure is not None
    figure.colorbar(field, ax=ax, label=label_of(data[name]))
    low, high = float(values.min()), float(values.max())
    if high > low:
        lines = ax.contour(
            data["speed"], data["torque"], values, levels=LEVELS, colors="white", linewidths=0.7
        )
        ax.clabel(lines, fontsize="x-small")
    return _label(ax, data, name, "speed", "torque")


def plot_map_lines(data: xr.Dataset, name: str, over: str, ax: Axes) -> Axes:
    """`name` over speed or torque, one line for some values of the other."""
    other = "torque" if over == "speed" else "speed"
    count = data.sizes[other]
    chosen = np.unique(np.linspace(0, count - 1, min(count, MOST_LINES)).round().astype(int))
    _, unit = label_of(data[other]).rsplit(", ", 1)
    for number, index in enumerate(chosen):
        line = data.isel({other: int(index)})
        ax.plot(
            line[over], line[name], color=COLOURS[number], ls=LINE_STYLES[number], marker=".", ms=3,
            label=f"{float(line[other]):g} {unit}",
        )  # fmt: skip
    ax.legend(title=other, fontsize="small", title_fontsize="small")
    _label(ax, data, name, over, None)
    ax.set_ylabel(label_of(data[name]))
    return ax


def _label(ax: Axes, data: xr.Dataset, name: str, x: Hashable, y: Hashable | None) -> Axes:
    ax.set_title(str(data[name].attrs["long_name"]).capitalize())
    ax.set_xlabel(label_of(data[x]))
    if y is not None:
        ax.set_ylabel(label_of(data[y]))
    return ax
