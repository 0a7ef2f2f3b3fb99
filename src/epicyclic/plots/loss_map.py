"""Loss maps: one variable over speed and torque, as a field or as lines."""

from __future__ import annotations

import warnings

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.ticker import NullLocator
from numpy.typing import NDArray

from epicyclic.case.operating import AXES, PLANE
from epicyclic.plots.style import COLOUR_MAP, COLOURS, LINE_STYLES, label_of
from epicyclic.units import format_number, unit_text

__all__ = [
    "at_temperatures",
    "map_at",
    "map_line",
    "plot_band_lines",
    "plot_half_width",
    "plot_map",
    "plot_map_lines",
    "plot_map_parts",
]

FloatArray = NDArray[np.float64]

LEVELS = 7
EFFICIENCIES = (0, 20, 40, 60, 70, 80, 85, 90, 92, 94, 95, 96, 97, 98, 99, 100)
"""Where the colours of an efficiency change: it bends most where it is lowest. [%]"""
LINED_EFFICIENCIES = (60, 80, 90, 94, 96, 97, 98, 99)
STRETCHED = 0.02
"""Part of the torque axis of an efficiency that is linear, over the largest torque. [1]"""
MOST_LINES = 5
LOSS_SUMS = ("load_dependent", "load_independent", "total", "input_power")
"""Powers of a map that are no components."""


def map_at(data: xr.Dataset, **values: object) -> xr.Dataset:
    """The map over speed and torque at one value of every other dimension: the first, or `values`.

    The values chosen are left as scalar coordinates.
    """
    others = {dim: 0 for dim in data["total"].dims if dim not in (*PLANE, *values)}
    return data.sel(values).isel(others)


def at_temperatures(data: xr.Dataset) -> list[xr.Dataset]:
    """The map over speed and torque at each oil temperature, at the first value of further keys."""
    if "temperature" not in data.dims:
        return [map_at(data)]
    return [map_at(data, temperature=float(celsius)) for celsius in data["temperature"]]


def map_line(data: xr.Dataset) -> str:
    """Which points the map has, in one line."""
    axes = [name for name in AXES if name in data.dims]
    spans = [f"{name} {_span(data[name])}" for name in axes]
    return f"at the {data.attrs['reference_shaft']}: {', '.join(spans)}"


def _span(axis: xr.DataArray) -> str:
    low, high = float(axis.min()), float(axis.max())
    unit = unit_text(str(axis.attrs["units"]))
    if low == high:
        return f"{format_number(low)} {unit}"
    return f"{format_number(low)} to {format_number(high)} {unit}"


def plot_map(data: xr.Dataset, name: str, ax: Axes) -> Axes:
    """`name` over speed and torque, with lines of equal value.

    Parameters
    ----------
    data : xarray.Dataset
        Of `map_at`.
    """
    values = _shown(data[name]).transpose("torque", "speed")
    if min(values.shape) < 2 or not np.isfinite(values).any():
        longest = "torque" if data.sizes["torque"] > data.sizes["speed"] else "speed"
        return plot_map_lines(data, name, longest, ax)
    speed, torque = (data[axis].to_numpy() for axis in PLANE)
    of_efficiency = name == "efficiency"
    norm = BoundaryNorm(EFFICIENCIES, 256) if of_efficiency else None
    field = ax.pcolormesh(
        speed, torque, values, shading="gouraud", cmap=COLOUR_MAP, norm=norm, rasterized=True
    )
    figure = ax.get_figure()
    assert figure is not None
    bar = figure.colorbar(field, ax=ax, label=label_of(values))
    if of_efficiency:
        bar.set_ticks(list(EFFICIENCIES))
    if float(values.max()) > float(values.min()):
        levels = LINED_EFFICIENCIES if of_efficiency else LEVELS
        with warnings.catch_warnings():  # a map need not reach any of them
            warnings.filterwarnings("ignore", message="No contour levels")
            lines = ax.contour(speed, torque, values, levels=levels, colors="white", linewidths=0.7)
        ax.clabel(lines, fontsize="x-small")
    if of_efficiency and torque.min() <= 0 <= torque.max():
        _stretch_zero(ax, torque)
    ax.grid(visible=False)
    ax.set(
        title=_title(values), xlabel=_axis_label(data, "speed"), ylabel=_axis_label(data, "torque")
    )
    return ax


def _stretch_zero(ax: Axes, torque: FloatArray) -> None:
    """A torque axis that is linear next to zero and logarithmic beyond."""
    full = float(np.abs(torque).max())
    ax.set_yscale("symlog", linthresh=full * STRETCHED, linscale=0.5)
    ticks = full * np.array([STRETCHED, 0.1, 0.3, 1.0])
    ticks = np.concatenate([-ticks[::-1], [0.0], ticks])
    ax.set_yticks(ticks[(ticks >= torque.min()) & (ticks <= torque.max())])
    ax.yaxis.set_major_formatter("{x:.3g}")
    ax.yaxis.set_minor_locator(NullLocator())


def plot_map_lines(data: xr.Dataset, name: str, over: str, ax: Axes) -> Axes:
    """`name` over speed or torque, one line for some values of the other that are not negative."""
    other = "torque" if over == "speed" else "speed"
    unit = unit_text(str(data[other].attrs["units"]))
    for number, index in enumerate(_some(data[other])):
        line = data.isel({other: index})
        ax.plot(
            line[over],
            _shown(line[name]),
            color=COLOURS[number],
            ls=LINE_STYLES[number],
            marker=".",
            ms=3,
            label=f"{float(line[other]):g} {unit}",
        )
    ax.legend(title=other, fontsize="small", title_fontsize="small")
    values = _shown(data[name])
    ax.set(
        title=f"{_title(values)} over {over}",
        xlabel=_axis_label(data, over),
        ylabel=label_of(values),
    )
    return ax


def plot_map_parts(data: xr.Dataset, ax: Axes) -> Axes:
    """Components of the loss over speed, one above the other, at the highest torque."""
    highest = data.isel(torque=-1)
    unit = data["total"].attrs["units"]
    parts = [
        name
        for name, values in highest.data_vars.items()
        if values.attrs.get("units") == unit and name not in LOSS_SUMS and float(values.max()) > 0
    ]
    parts = parts or ["total"]  # nothing is lost, as where a train turns as one body
    areas = ax.stackplot(
        highest["speed"],
        [highest[name] for name in parts],
        labels=[str(name).replace("_", " ") for name in parts],
        colors=COLOURS,
        edgecolor="white",
        linewidth=0.6,
    )
    for number, area in enumerate(areas):
        area.set_hatch("//" * (number // len(COLOURS)))
    torque = f"{float(highest['torque']):g} {unit_text(str(highest['torque'].attrs['units']))}"
    ax.set(
        title=f"Components of the loss at {torque}",
        xlabel=_axis_label(data, "speed"),
        ylabel=label_of(data["total"]),
    )
    handles, labels = ax.get_legend_handles_labels()
    ax.legend(handles[::-1], labels[::-1], fontsize="x-small", loc="upper left")
    return ax


def plot_half_width(data: xr.Dataset, ax: Axes) -> Axes:
    """Half the width of the 95 % band of the total loss, over the loss, over speed and torque.

    Parameters
    ----------
    data : xarray.Dataset
        Of `map_at`, from a map with its uncertainty.
    """
    total = data.sel(result="total", drop=True)
    share = 50 * (total["high"] - total["low"]) / total["nominal"].where(total["nominal"] > 0)
    about = {"long_name": "half width of the 95 % band of the total loss", "units": "%"}
    return plot_map(data.assign(half_width=share.assign_attrs(about)), "half_width", ax)


def plot_band_lines(data: xr.Dataset, over: str, ax: Axes) -> Axes:
    """The total loss with its 95 % band over speed or torque, for some values of the other."""
    plot_map_lines(data, "total", over, ax)
    other = "torque" if over == "speed" else "speed"
    total = data.sel(result="total")
    for number, index in enumerate(_some(data[other])):
        line = total.isel({other: index})
        for end in ("low", "high"):
            ax.plot(line[over], line[end], color=COLOURS[number], lw=0.6)
        ax.fill_between(
            line[over], line["low"], line["high"], color=COLOURS[number], alpha=0.2, linewidth=0
        )
    ax.set_title(f"{ax.get_title(loc='left')}, with its 95 % band")
    return ax


def _shown(values: xr.DataArray) -> xr.DataArray:
    """`values`, an efficiency in percent."""
    if values.name != "efficiency":
        return values
    return (100 * values).assign_attrs(values.attrs | {"units": "%"})


def _some(axis: xr.DataArray) -> list[int]:
    """Places of some values on an axis, evenly spaced, of one sign if there are both."""
    places = np.flatnonzero(axis.to_numpy() >= 0)
    if not places.size:
        places = np.arange(axis.size)
    chosen = np.linspace(0, places.size - 1, min(places.size, MOST_LINES)).round().astype(int)
    return [int(one) for one in places[chosen]]


def _title(values: xr.DataArray) -> str:
    text = str(values.attrs["long_name"])
    return f"{text[:1].upper()}{text[1:]}"


def _axis_label(data: xr.Dataset, name: str) -> str:
    """``"speed of the sun, rpm"``."""
    unit = unit_text(str(data[name].attrs["units"]))
    preposition = "of" if name == "speed" else "on"
    return f"{name} {preposition} the {data.attrs['reference_shaft']}, {unit}"
