"""Loss maps: one variable over speed and torque, as a field or as lines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import FuncNorm, Normalize
from matplotlib.patheffects import AbstractPathEffect, withStroke
from matplotlib.ticker import MaxNLocator
from scipy.interpolate import RegularGridInterpolator

from epicyclic.arrays import FloatArray
from epicyclic.result.result import in_words
from epicyclic.show.plots.style import (
    COLOUR_MAP,
    COLOURS,
    LINE_STYLES,
    in_percent,
    label_of,
    labelled,
    legend_below,
    place_text,
    span_text,
    title_of,
)
from epicyclic.study.bands.advice import in_few_words
from epicyclic.study.operating import AXES, PLANE, STATE, key_of
from epicyclic.units import format_number, unit_text

Limits = tuple[float, float] | None

HALF_WIDTH = "half_width"
LEVELS = 7
FINER = 8  # Parts of an interval between points of a field.
EFFICIENCIES = (50, 70, 80, 90, 95, 97, 98, 98.5, 99, 99.3, 99.5, 99.7, 99.9)
"""Efficiencies that get a line and a tick. [%]"""
LEAST_EFFICIENCY, BEST_EFFICIENCY = 50.0, 99.95
"""Between which colours of an efficiency differ, evenly in the logarithm of the loss. [%]"""
LEAST_LINE = 90  # Lines of lower efficiencies run into one another where the torque is zero. [%]
LABELS = 4  # Most labels that a line of equal value gets: more collide where lines are close.
EDGE = 0.04
"""Share of the width and height of the Axes, along its edges, in which no such label begins."""
APART = (0.09, 0.05)  # Of the width and height of the Axes, between labels. [1]
ROOM = 1.03  # Height of an axis over the greatest value that it has to show. [1]
MOST_PARTS, OTHERS = 6, "others"  # Of a stack of components; smaller ones are put together.
MOST_LINES = 5
MOST_PANELS = 12  # States and temperatures with a picture and tables of their own.
LOSS_SUMS = ("load_dependent", "load_independent", "total", "input_power")
"""Powers of a map that are no components."""


def map_at(data: xr.Dataset, **values: object) -> xr.Dataset:
    """The map over speed and torque at one value of every other dimension: the first, or `values`.

    The values chosen are left as scalar coordinates.
    """
    others = {dim: 0 for dim in data["total"].dims if dim not in (*PLANE, *values)}
    return data.sel(values).isel(others)


def shown_panels(data: xr.Dataset) -> dict[str, list[int]]:
    """Places of the states and temperatures that are shown: `MOST_PANELS` at most, evenly spaced.

    Of few states all are shown, and as many temperatures as there is room for.
    """
    room, shown = MOST_PANELS, {}
    for name in (STATE, "temperature"):
        if name in data.dims:
            size = data.sizes[name]
            count = min(size, room)
            shown[name] = [int(one) for one in np.linspace(0, size - 1, count).round()]
            room //= count
    return shown


def left_out_line(data: xr.Dataset) -> str:
    """How many states and temperatures are shown, if not all are; else empty."""
    parts = [
        f"{len(places)} of {data.sizes[name]} {name}s"
        for name, places in shown_panels(data).items()
        if len(places) < data.sizes[name]
    ]
    return f"shown at {' and '.join(parts)}" if parts else ""


def at_temperatures(data: xr.Dataset) -> dict[int, xr.Dataset]:
    """The map over speed and torque at the shown oil temperatures, each by its number.

    At the first value of further keys.
    """
    if "temperature" not in data.dims:
        return {0: map_at(data)}
    places = shown_panels(data)["temperature"]
    celsius = data["temperature"].to_numpy()
    return {place: map_at(data, temperature=float(celsius[place])) for place in places}


def map_line(data: xr.Dataset) -> str:
    """Which points the map has, in one line."""
    axes = [name for name in AXES if name in data.dims]
    spans = [f"{name} {span_text(data[name])}" for name in axes]
    line = f"at the {data.attrs['reference_shaft']}: {', '.join(spans)}"
    return "; ".join(filter(None, (line, left_out_line(data), first_values(data, STATE))))


def first_values(data: xr.Dataset, *panels: str) -> str:
    """The values at which a map is shown, beside those of its `AXES` and `panels`; else empty."""
    names = (dim for dim in data["total"].dims if dim not in (*AXES, *panels))
    several = (data[name] for name in names if data.sizes[name] > 1)
    first = "{} {}, the first of {}".format
    return ", ".join(first(in_few_words(key_of(it)), place_text(it[0]), it.size) for it in several)


def limits_of(data: xr.Dataset, name: str) -> Limits:
    """Least and greatest value in all panels: states and temperatures, at the first of other keys.

    An efficiency is in percent; None if there is no value.
    """
    values = in_percent(data[name])
    panels = (*AXES, STATE)
    found = values.isel({dim: 0 for dim in values.dims if dim not in panels}).to_numpy()
    known = found[np.isfinite(found)]
    return (float(known.min()), float(known.max())) if known.size else None


def plot_map(
    data: xr.Dataset,  # As `map_at` returns them.
    name: str,
    ax: Axes,
    # Limits of the scale of colours, from `limits_of`; default: those of `data`.
    limits: Limits = None,
) -> Axes:
    """`name` over speed and torque, with lines of equal value."""
    values = in_percent(data[name]).transpose("torque", "speed")
    if min(values.shape) < 2 or not np.isfinite(values).any():
        longest = "torque" if data.sizes["torque"] > data.sizes["speed"] else "speed"
        return plot_map_lines(data, name, longest, ax, limits)
    low, high = limits or limits_of(data, name) or (0.0, 1.0)
    speed, torque = (data[axis].to_numpy() for axis in PLANE)
    of_efficiency = name == "efficiency"
    norm = _efficiency_norm(low, high) if of_efficiency else Normalize(low, high)
    field = draw_field(ax, speed, torque, values.to_numpy(), norm=norm)
    below = of_efficiency and low < LEAST_EFFICIENCY
    bar = ax.figure.colorbar(
        field, ax=ax, label=label_of(values), extend="min" if below else "neither"
    )
    levels: list[float] | int = LEVELS
    if of_efficiency or name == HALF_WIDTH:
        even = MaxNLocator(LEVELS, integer=not of_efficiency).tick_values(low, high)
        known = [one for one in EFFICIENCIES if of_efficiency and low <= one <= high]
        levels = known or [float(f"{one:.9g}") for one in even if low <= one <= high]
        bar.set_ticks(levels, labels=[f"{one:g}" for one in levels])
        if of_efficiency:
            bar.ax.minorticks_off()
            levels = [one for one in levels if one >= LEAST_LINE] or levels
    draw_lines(ax, (speed, torque, values.to_numpy()), levels)
    ax.grid(visible=False)
    return labelled(ax, _axis_label(data, "speed"), _axis_label(data, "torque"), title_of(values))


def draw_field(ax: Axes, x: FloatArray, y: FloatArray, z: FloatArray, **how: Any) -> QuadMesh:
    """Colours of `z`, (y, x), linear between its points; shading alone would mix their colours."""
    places = [np.linspace(0, one.size - 1, FINER * (one.size - 1) + 1) for one in (x, y)]
    known = np.arange(y.size), np.arange(x.size)
    fine = RegularGridInterpolator(known, z)(tuple(np.meshgrid(*reversed(places), indexing="ij")))
    fine[::FINER, ::FINER] = z  # also beside points without a value
    ends = (np.interp(at, np.arange(it.size), it) for at, it in zip(places, (x, y), strict=True))
    return ax.pcolormesh(*ends, fine, shading="gouraud", cmap=COLOUR_MAP, rasterized=True, **how)


def draw_lines(
    ax: Axes,
    field: tuple[Any, Any, Any],  # Places across and up, values.
    # Values of the lines, of which the highest have labels; or about how many there are.
    levels: Sequence[float] | int,
) -> None:
    """Lines of equal value, some of them with it."""
    low, high = float(np.nanmin(field[2])), float(np.nanmax(field[2]))
    even = isinstance(levels, int)
    wanted = MaxNLocator(levels).tick_values(low, high) if isinstance(levels, int) else levels
    drawn = [float(one) for one in wanted if low < one < high]
    if not drawn:
        return
    lines = ax.contour(*field, levels=drawn, colors="white", linewidths=0.7)
    edge: list[AbstractPathEffect] = [withStroke(linewidth=2.0, foreground="0.25")]
    chosen = drawn[:: -(-len(drawn) // LABELS)] if even else drawn[-LABELS:]
    to_axes, kept = ax.transData - ax.transAxes, np.empty((0, 2))
    for text in reversed(ax.clabel(lines, chosen, fontsize="small", fmt="%g", inline=False)):
        text.set_path_effects(edge)
        place = to_axes.transform(text.get_position())
        is_cut = np.abs(place - 0.5).max() > 0.5 - EDGE
        if is_cut or (np.abs(kept - place) < APART).all(axis=1).any():
            text.remove()
        else:
            kept = np.vstack([kept, place])


def _efficiency_norm(low: float, high: float) -> FuncNorm:
    """Colours of efficiencies, for which 98 and 99 % differ as much as 80 and 90 %."""
    best = min(high, BEST_EFFICIENCY)
    least = min(max(low, LEAST_EFFICIENCY), best)
    if least == best:
        least -= 100 - BEST_EFFICIENCY  # of the best there is no better
    logarithm_and_back = (
        lambda efficiency: -np.log10(100 - np.minimum(efficiency, BEST_EFFICIENCY)),
        lambda logarithm: 100 - np.power(10.0, -logarithm),
    )
    return FuncNorm(logarithm_and_back, least, best)


def plot_map_lines(data: xr.Dataset, name: str, over: str, ax: Axes, limits: Limits = None) -> Axes:
    """`name` over speed or torque, one line for some values of the other that are not negative."""
    other = "torque" if over == "speed" else "speed"
    unit = unit_text(str(data[other].attrs["units"]))
    for number, index in enumerate(_some(data[other])):
        line = data.isel({other: index})
        ax.plot(
            line[over],
            in_percent(line[name]),
            color=COLOURS[number],
            ls=LINE_STYLES[number],
            marker=".",
            ms=3,
            label=f"{format_number(float(line[other]))} {unit}",
        )
    legend_below(ax, title=other, title_fontsize="small", ncols=3)
    if limits is not None and limits[1] > 0:
        ax.set_ylim(min(0.0, limits[0]), ROOM * limits[1])
    values = in_percent(data[name])
    return labelled(ax, _axis_label(data, over), values, f"{title_of(values)} over {over}")


def plot_map_parts(data: xr.Dataset, name: str, ax: Axes, limits: Limits = None) -> Axes:
    """Components of the loss `name` over speed, one above the other, at the highest torque."""
    highest = data.isel(torque=-1)
    unit = data[name].attrs["units"]
    sizes = {
        str(part): float(values.max())
        for part, values in highest.data_vars.items()
        if values.attrs.get("units") == unit and part not in LOSS_SUMS and float(values.max()) > 0
    }
    largest = sorted(sizes, key=sizes.__getitem__)[-MOST_PARTS:]
    parts = {part: highest[part] for part in sizes if part in largest}
    if len(parts) < len(sizes):
        others = [highest[part] for part in sizes if part not in largest]
        parts[OTHERS] = xr.concat(others, OTHERS).sum(OTHERS)
    parts = parts or {name: highest[name]}  # nothing is lost, as where a train turns as one body
    ax.stackplot(
        highest["speed"],
        list(parts.values()),
        labels=[in_words(part) for part in parts],
        colors=COLOURS,
        edgecolor="white",
        linewidth=0.6,
    )
    if limits is not None and limits[1] > 0:
        ax.set_ylim(0.0, ROOM * limits[1])
    torque = f"{float(highest['torque']):g} {unit_text(str(highest['torque'].attrs['units']))}"
    legend_below(ax, ncols=3)
    title = f"Components of the loss at {torque}"
    return labelled(ax, _axis_label(data, "speed"), data[name], title)


def plot_half_width(
    data: xr.Dataset,  # As `map_at` returns them, from a map with its uncertainty.
    ax: Axes,
    limits: Limits = None,  # Limits of the scale of colours, from `limits_of_half_width`.
) -> Axes:
    """Half the width of the 95 % band of the total loss, over the loss, over speed and torque."""
    share = _half_width(data)
    known = data.assign({HALF_WIDTH: share}).sel(
        speed=share.notnull().any([dim for dim in share.dims if dim != "speed"])
    )  # at rest nothing is lost
    return plot_map(known, HALF_WIDTH, ax, limits)


def limits_of_half_width(data: xr.Dataset) -> Limits:
    """Least and greatest half width in all panels, in whole percent: it is not known better."""
    found = limits_of(data.assign({HALF_WIDTH: _half_width(data)}), HALF_WIDTH)
    return found and (math.floor(found[0]), math.ceil(found[1]))


def _half_width(data: xr.Dataset) -> xr.DataArray:
    total = data.sel(result="total", drop=True)
    share = 50 * (total["high"] - total["low"]) / total["nominal"].where(total["nominal"] > 0)
    about = {"long_name": "half width of the 95 % band of the loss", "units": "%"}
    return share.assign_attrs(about)


def plot_band_lines(data: xr.Dataset, over: str, ax: Axes, limits: Limits = None) -> Axes:
    """The total loss with its 95 % band over speed or torque, for some values of the other."""
    plot_map_lines(data, "total", over, ax, limits)
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


def limits_of_band(data: xr.Dataset) -> Limits:
    """Lower end of the lowest and upper end of the highest band of the loss in all panels."""
    total = data.sel(result="total", drop=True)
    ends = [limits for end in ("low", "high") if (limits := limits_of(total, end)) is not None]
    return (min(low for low, _ in ends), max(high for _, high in ends)) if ends else None


def _some(axis: xr.DataArray) -> list[int]:
    """Places of values near to evenly spaced ones on an axis, of one sign if there are both."""
    values = axis.to_numpy()
    places = np.flatnonzero(values >= 0)
    if not places.size:
        places = np.arange(axis.size)
    wanted = np.linspace(values[places].min(), values[places].max(), MOST_LINES)
    nearest = np.abs(values[places] - wanted[:, None]).argmin(axis=1)
    return [int(one) for one in np.unique(places[nearest])]


def _axis_label(data: xr.Dataset, name: str) -> str:
    """``"speed of the sun, rpm"``."""
    unit = unit_text(str(data[name].attrs["units"]))
    preposition = "of" if name == "speed" else "on"
    return f"{name} {preposition} the {data.attrs['reference_shaft']}, {unit}"
