"""Sweeps: a number over the keys that were varied, as lines, as a field, point by point."""

from __future__ import annotations

import json
import math
import textwrap
from bisect import bisect
from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.ticker import MaxNLocator

from epicyclic.arrays import FloatArray
from epicyclic.errors import first_of
from epicyclic.show.plots.loss_map import draw_field, draw_lines
from epicyclic.show.plots.style import (
    COLOUR_MAP,
    COLOURS,
    LINE_STYLES,
    TITLE_CHARACTERS,
    in_percent,
    label_of,
    labelled,
    legend_below,
    place_text,
    room_of,
    span_text,
    title_of,
    write_beside,
)
from epicyclic.study.bands.advice import in_few_words
from epicyclic.study.operating import CASE_KEY, key_of, operating_line
from epicyclic.study.sweeps.run import is_sweep
from epicyclic.units import format_number, unit_text

RESULTS = ("total", "efficiency")  # That pictures of a sweep show.
MOST_LINES = len(COLOURS)
LEVELS = 8
LABEL_WIDTH = 14  # Width of the labels of parallel axes. [characters]
MOST_TICKS = 4  # Most values of a parallel axis that has a tick at each of them.
_BACKGROUND = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.5}
"""Of the values beside such an axis."""
MOST_POINTS = 5000  # Drawn point by point, and in a report altogether.
LEFT_OUT = "points_left_out"
"""Attribute of a sweep that is thinned out: the number of its other points."""
MOST_NAMES = 8  # Of a key, in a line of text.


def varied(data: xr.Dataset) -> list[str]:
    """Dimensions with several values: numbers before names, those with most values first."""
    found = [str(name) for name in data["total"].dims if data.sizes[name] > 1]
    return sorted(found, key=lambda name: (not _is_number(data[name]), -data.sizes[name]))


def thinned(data: xr.Dataset) -> xr.Dataset:
    """At most `MOST_POINTS` of a sweep: evenly spaced values of each key, those of the least loss.

    The attribute `LEFT_OUT` says how many are left out. Keys of few values keep all of them as long
    as those of many can be thinned out.
    """
    total = data["total"]
    if total.size <= MOST_POINTS:
        return data
    losses = total.to_numpy()
    known = np.isfinite(losses).any()
    best = np.unravel_index(int(np.nanargmin(losses)) if known else 0, losses.shape)
    kept = {
        dim: _evenly(size, count, int(place))
        for dim, size, count, place in zip(
            total.dims, total.shape, _counts(total.shape), best, strict=True
        )
    }
    part = data.isel(kept)
    left_out = data.attrs.get(LEFT_OUT, 0) + total.size - part["total"].size
    return part.assign_attrs({LEFT_OUT: left_out})


def _counts(sizes: Sequence[int]) -> list[int]:
    """How many values of each key to keep: as many of all, and one more where there is room."""
    tops = range(1, MOST_POINTS + 1)
    top = bisect(tops, MOST_POINTS, key=lambda top: math.prod(min(n, top) for n in sizes))
    counts = [min(size, top) for size in sizes]
    for number, size in enumerate(sizes):
        more = [*counts[:number], counts[number] + 1, *counts[number + 1 :]]
        if more[number] <= size and math.prod(more) <= MOST_POINTS:
            counts = more
    return counts


def _evenly(size: int, count: int, place: int) -> list[int]:
    """Indices of `count` of `size` values, evenly spaced but for `place`, which is one of them."""
    chosen = np.linspace(0, size - 1, count).round().astype(int)
    inner = chosen[1:-1] if count > 2 and 0 < place < size - 1 else chosen  # both ends stay
    inner[np.abs(inner - place).argmin()] = place
    return [int(one) for one in chosen]


def shown_results(data: xr.Dataset) -> list[str]:
    """Results of which there is a number."""
    if not is_sweep(data):
        return []
    return [name for name in RESULTS if name in data and np.isfinite(data[name].values).any()]


def fields_of(data: xr.Dataset) -> list[str]:
    """The two dimensions of numbers over which a field is drawn; fewer if there are not two."""
    return [name for name in varied(data) if _is_number(data[name])][:2]


def sweep_line(data: xr.Dataset) -> str:
    """What was varied, and the operating point with the rest."""
    operation = dict(json.loads(data.attrs["case"])["operation"])
    spans = []
    for array in data.coords.values():
        key = key_of(array)
        if array.name not in data.dims and (key == array.name or key in data.dims):
            continue  # the key beside its dimension
        spans.append(f"{in_few_words(key)} {_span(array)}")
        table, _, name = key.partition(".")
        if table == "operation":
            operation.pop(name, None)
    return "; ".join(filter(None, [*spans, operating_line(operation)]))


def plot_sweep_lines(data: xr.Dataset, name: str, ax: Axes) -> Axes:
    """`name` over the dimension with most values, a line for each value of the next one."""
    over, *others = varied(data)
    between = others[:1]
    part = _at_first(data, [over, *between])
    values = in_percent(part[name])
    places = values[over].to_numpy()
    for number, index in enumerate(_some(data, between)):
        line = values.isel(index)
        ax.plot(
            places if _is_number(values[over]) else places.astype(str),
            line,
            color=COLOURS[number],
            ls=LINE_STYLES[number],
            marker=".",
            label=", ".join(place_text(line[dim], 4) for dim in index),
        )
    if between:
        title = in_few_words(key_of(data[between[0]]))  # the entries have units
        legend_below(ax, title=title, title_fontsize="small", ncols=4)
    ax.set(title=_titled(values, part, ax), xlabel=_axis_label(data, over), ylabel=label_of(values))
    if _is_count(values[over]):
        ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    return ax


def plot_sweep_field(data: xr.Dataset, name: str, ax: Axes) -> Axes:
    """`name` over two dimensions, with lines of equal value and the points that were computed."""
    across, up = fields_of(data)
    part = _at_first(data, [across, up])
    values = in_percent(part[name]).transpose(up, across).sortby([up, across])
    x, y, z = (array.to_numpy() for array in (values[across], values[up], values))
    if np.isfinite(z).any():
        field = draw_field(ax, x, y, z)
        ax.figure.colorbar(field, ax=ax, label=label_of(values))
        draw_lines(ax, (x, y, z), LEVELS)
    points = [grid.ravel() for grid in np.meshgrid(x, y)]
    ax.plot(*points, ls="", marker=".", ms=4, color="black", clip_on=False)
    for axis, dim in ((ax.xaxis, across), (ax.yaxis, up)):
        if _is_count(values[dim]):
            axis.set_major_locator(MaxNLocator(integer=True))
    ax.grid(visible=False)
    return labelled(ax, _axis_label(data, across), _axis_label(data, up), _titled(values, part, ax))


def plot_sweep_parallel(data: xr.Dataset, ax: Axes) -> Axes:
    """A line for each point through the values of all keys and results, coloured by its loss."""
    dims, results = varied(data), shown_results(data)
    part = thinned(_at_first(data, dims)[results])
    points = part.stack(point=dims).dropna("point", subset=["total"])
    shares = [in_percent(points[name]) for name in results]
    # without torque there is no efficiency
    arrays = [points[dim] for dim in dims] + [it for it in shares if np.isfinite(it).any()]
    columns = [_column(array) for array in arrays]
    places = np.arange(len(arrays), dtype=float)
    heights = np.column_stack([heights for heights, _ in columns])
    total = points["total"].to_numpy()
    lines = LineCollection(
        [np.column_stack([places, row]) for row in heights],
        cmap=mpl.colormaps[COLOUR_MAP],
        norm=Normalize(float(total.min()), float(total.max())),
        linewidths=0.9,
        alpha=0.8,
    )
    lines.set_array(total)
    ax.add_collection(lines)
    for place, (_, ticks) in zip(places, columns, strict=True):
        ax.axvline(place, color="black", lw=0.8)
        for height, text in ticks:
            write_beside(ax, text, (place, height), fontsize="small", bbox=_BACKGROUND)
    labels = [_axis_label(data, dim) for dim in dims]
    labels += [label_of(array) for array in arrays[len(dims) :]]
    ax.set_xticks(places, [textwrap.fill(it, LABEL_WIDTH) for it in labels], fontsize="small")
    ax.set_yticks([])
    ax.grid(visible=False)
    ax.spines["left"].set_visible(False)
    left_out = part.attrs.get(LEFT_OUT, 0)
    drawn = f"{part['total'].size} of {part['total'].size + left_out} points"
    title = f"{drawn if left_out else 'Every point'} of the sweep"
    ax.set(title=title, xlim=(-0.1, places[-1] + 0.3), ylim=(-0.05, 1.05))
    ax.figure.colorbar(lines, ax=ax, label=label_of(data["total"]))
    return ax


def _column(values: xr.DataArray) -> tuple[FloatArray, list[tuple[float, str]]]:
    """Heights from 0 to 1 of values, numbers in proportion and names in order, with its ticks."""
    if not _is_number(values):
        names, numbers = np.unique(values.to_numpy(), return_inverse=True)
        steps = max(1, len(names) - 1)
        return numbers / steps, [(place / steps, str(one)) for place, one in enumerate(names)]
    heights = values.to_numpy().astype(np.float64)
    low, high = float(np.nanmin(heights)), float(np.nanmax(heights))
    span = high - low if high > low else 1.0
    different = np.unique(heights[np.isfinite(heights)]).tolist()
    shown = different if len(different) <= MOST_TICKS else [low, (low + high) / 2, high]
    ticks = [((one - low) / span, format_number(one, 3)) for one in shown]
    return np.subtract(heights, low) / span, ticks


def _some(data: xr.Dataset, between: list[str]) -> list[dict[str, int]]:
    """Indices of the lines: all values, or some that are evenly spaced."""
    if not between:
        return [{}]
    (name,) = between
    size = data.sizes[name]
    chosen = np.linspace(0, size - 1, min(size, MOST_LINES)).round().astype(int)
    return [{name: int(index)} for index in chosen]


def _at_first(data: xr.Dataset, kept: list[str]) -> xr.Dataset:
    return data.isel({dim: 0 for dim in data["total"].dims if dim not in kept})


def _titled(values: xr.DataArray, part: xr.Dataset, ax: Axes) -> str:
    """What is shown, and the values of the dimensions that are not."""
    fixed = [array for array in part.coords.values() if array.ndim == 0 and CASE_KEY in array.attrs]
    held = [f"{in_few_words(key_of(array))} {place_text(array, 4)}" for array in fixed]
    width = int(TITLE_CHARACTERS * room_of(ax))
    return textwrap.fill(", ".join([title_of(values), *held]), width, break_long_words=False)


def _is_number(values: xr.DataArray) -> bool:
    return values.dtype.kind in "fiu"


def _is_count(values: xr.DataArray) -> bool:
    return values.dtype.kind in "iu"


def _axis_label(data: xr.Dataset, dim: str) -> str:
    """``"speed, rpm"``."""
    unit = unit_text(str(data[dim].attrs.get("units", "1")))
    name = in_few_words(key_of(data[dim]))
    return f"{name}, {unit}" if unit else name


def _span(values: xr.DataArray) -> str:
    if not _is_number(values):
        return first_of(list(dict.fromkeys(map(str, values.values))), MOST_NAMES)
    return span_text(values)
