"""Losses of one result, and how well they are known."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.ticker import MaxNLocator

from epicyclic.arrays import FloatArray
from epicyclic.case.tables.uncertainty import MODEL_FORM
from epicyclic.result.result import Result, in_words
from epicyclic.show.plots.style import COLOURS, labelled, legend_below, write_beside
from epicyclic.study.bands.advice import in_few_words, mean_shares, unit_of
from epicyclic.units import decimals_of, format_number, part_text, percent, power_unit

if TYPE_CHECKING:
    import xarray as xr

GROUP_COLOURS = {"load-dependent": COLOURS[0], "load-independent": COLOURS[4]}
EDGE: Any = {"edgecolor": "black", "linewidth": 0.5}
SUM_COLOUR = "0.45"
ROOM = 1.32  # Length of the axis over that of the longest bar, for the numbers beside the bars. [1]
MOST_BARS = 16  # Losses of a set; of more, those of a mesh, bearing or body are one.
MOST_ROWS, OTHERS = 20, "others"  # Of a picture; smaller losses are put together.


def plot_losses(result: Result, ax: Axes) -> Axes:
    """Every component of the loss, its power and share; of several sets every set and part."""
    unit, scale = power_unit(result.total)
    total, parts = result.total / scale, _parts(result, scale)
    sums = [sum(own.values()) for own in parts.values()]
    _draw(ax, parts, np.zeros(len(parts)))
    for row, value in enumerate(sums):
        share = f" ({percent(value / total)})" if total else ""
        write_beside(ax, part_text(value, total, decimals_of(total)) + share, (value, row))
    return _finish(ax, [*parts], sums, "Losses by component", unit)


def plot_loss_sum(result: Result, ax: Axes) -> Axes:
    """How the components add up to the total loss, the largest first; nothing that reads 0."""
    unit, scale = power_unit(result.total)
    total, digits = result.total / scale, decimals_of(result.total / scale)
    parts = _parts(result, scale)
    least = 0.5 / 10**digits
    small = [it for it, own in parts.items() if it == OTHERS or sum(own.values()) < least]
    parts = _together(parts, small)
    parts = dict(sorted(parts.items(), key=lambda it: (it[0] == OTHERS, -sum(it[1].values()))))
    sums = np.array([sum(own.values()) for own in parts.values()])
    ends = sums.cumsum()
    _draw(ax, parts, ends - sums)
    ax.barh(len(parts), total, color=SUM_COLOUR, **EDGE)
    for row, (value, end) in enumerate(zip([*sums, total], [*ends, total], strict=True)):
        write_beside(ax, part_text(value, total, digits), (end, row))
    return _finish(ax, [*parts, "total"], [total], "How the losses add up", unit)


def plot_losses_beside(results: Mapping[str, Result], ax: Axes) -> Axes:
    """The components of two results by their names, a bar for each."""
    unit, scale = power_unit(max(result.total for result in results.values()))
    found = [
        {"total": result.total / scale}
        | {name: sum(own.values()) for name, own in _parts(result, scale).items()}
        for result in results.values()
    ]
    names = list(dict.fromkeys(itertools.chain.from_iterable(found)))
    height = 0.8 / len(found)
    for number, (name, own) in enumerate(zip(results, found, strict=True)):
        places = np.arange(len(names)) + (number - (len(found) - 1) / 2) * height
        watts = [own.get(label, 0.0) for label in names]
        colour = COLOURS[0] if number else _light(COLOURS[0])
        ax.barh(places, watts, height=height, color=colour, label=name, **EDGE)
    return _finish(ax, names, [own["total"] for own in found], "Losses by component", unit)


def _draw(ax: Axes, parts: Mapping[str, Mapping[str, float]], starts: FloatArray) -> None:
    """Bars from `starts` on, a colour for each group."""
    for group, colour in GROUP_COLOURS.items():
        watts = np.array([own.get(group, 0.0) for own in parts.values()])
        (rows,) = watts.nonzero()
        if rows.size:
            ax.barh(rows, watts[rows], left=starts[rows], color=colour, label=group, **EDGE)
        starts = starts + watts


def _finish(ax: Axes, names: Sequence[str], watts: Iterable[float], title: str, unit: str) -> Axes:
    """Names beside the bars, room for the longest of `watts`, legend and title."""
    ax.set_yticks(range(len(names)), names)
    ax.set_ylim(len(names) - 0.4, -0.6)  # with room for losses of nothing too
    ax.grid(visible=False, axis="y")
    ax.set_xlim(0, ROOM * max(watts, default=0.0) or 1.0)
    legend_below(ax, ncols=2)
    ax.set(title=title, xlabel=f"power loss, {unit}")
    return ax


def _parts(result: Result, scale: float) -> dict[str, dict[str, float]]:
    """Power of every bar by group: of every set, or what a single one loses by component.

    Where these are too many, all losses of a mesh, bearing or body are one, and the smallest
    are put together.
    """
    parts: dict[str, dict[str, float]] = {}
    labels = _labels(result)
    for term in result.terms:
        if term.name in labels:
            own = parts.setdefault(in_words(labels[term.name]), {})
            own[term.group] = own.get(term.group, 0.0) + term.watts / scale
    if len(parts) > MOST_ROWS:
        by_size = sorted(parts, key=lambda name: -sum(parts[name].values()))
        return _together(parts, by_size[MOST_ROWS - 1 :])
    return parts


def _together(
    parts: Mapping[str, Mapping[str, float]], small: Sequence[str]
) -> dict[str, dict[str, float]]:
    """Some parts as one, the last, unless all of these are nothing."""
    kept = {name: dict(own) for name, own in parts.items() if name not in small}
    sums = {it: sum(parts[name].get(it, 0.0) for name in small) for it in GROUP_COLOURS}
    return kept | ({OTHERS: sums} if any(sums.values()) else {})


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


# How well a result is known: its distribution, and what that is due to.

MOST_DRIVERS = 12
RARE = 0.003  # Share of samples beyond each end of a distribution, which it leaves out. [1]
TICKS = 6  # Most ticks under a distribution: its values have many digits.
WIDE = (8.8, 4.6)  # Width and height of a picture with long names beside its bars. [inch]


def banded(data: xr.Dataset) -> tuple[str, ...]:
    """Results whose bands are drawn: the efficiency if power is passed on."""
    low, high = (float(data[end].sel(result="efficiency")) for end in ("low", "high"))
    return ("total", "efficiency") if low < high else ("total",)


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
    ax.barh(range(len(drivers)), 100 * mean.to_numpy(), color=colours, **EDGE)
    ax.hlines(range(len(drivers)), low, high, color="black", lw=1.2, label="minimum to maximum")
    ax.set_yticks(range(len(drivers)), _names(data, drivers))
    ax.set(
        title="Causes of the uncertainty of the total loss",
        xlabel="share of its variance over the map, weighted with the loss, %",
    )
    for place, label in ((0, "inputs"), (4, "models")):
        ax.barh([0], [0], color=COLOURS[place], **EDGE, label=label)
    legend_below(ax, ncols=3)
    return ax


def _light(colour: str) -> tuple[float, ...]:
    """A colour with two parts of white."""
    return tuple((part + 2) / 3 for part in to_rgb(colour))


def _names(data: xr.Dataset, drivers: Iterable[str]) -> list[str]:
    """What inputs are called, or several that are correlated; with the set where two are alike."""
    keys, names = (map(str, data[name].values) for name in ("input", "input_name"))
    known = dict(zip(keys, names, strict=True))
    found = [{key: in_few_words(known[key]) for key in it.split(" + ")} for it in drivers]
    counts = Counter(name for own in found for name in own.values())
    return [
        " + ".join(
            f"{name}, {key.split('.')[1]}" if counts[name] > 1 and key.startswith("sets.") else name
            for key, name in own.items()
        )
        for own in found
    ]


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
    names = _names(data, keys)
    for wanted, label, colour in ((False, "inputs", COLOURS[0]), (True, "models", COLOURS[4])):
        rows = [row for row, model in enumerate(models) if model == wanted]
        watts = change.values[rows]
        ax.barh(rows, watts, color=colour, **EDGE, label=label)
        ax.barh(rows, -watts, color=_light(colour), **EDGE)
    ax.set_yticks(range(len(names)), names)
    ax.axvline(0.0, color="black", lw=0.8)
    ax.set(
        title="Causes of the uncertainty of the total loss",
        xlabel=f"change for one standard deviation up (dark) and down, {unit_of(data)}",
    )
    legend_below(ax, ncols=2)
    return ax


def plot_band(data: xr.Dataset, name: str, ax: Axes) -> Axes:
    """Distribution of a result with its 95 % interval and the value of the case."""
    one = data.sel(result=name)
    unit = unit_of(data, name)
    percent = unit == "1"
    scale = 100.0 if percent else 1.0
    if unit == "W":
        unit, size = power_unit(float(one["high"]))
        scale = 1 / size
    values = one["value"].values * scale
    low, high, nominal = (float(one[key]) * scale for key in ("low", "high", "nominal"))
    ax.axvspan(low, high, color=COLOURS[5], alpha=0.25, label="95 % interval")
    values = values[np.isfinite(values)]
    counts, edges = np.histogram(values, "auto", tuple(np.quantile(values, (RARE, 1 - RARE))))
    ax.stairs(counts, edges, fill=True, color=COLOURS[0])
    ax.axvline(nominal, color=COLOURS[1], lw=1.6, label="case")
    ax.axvline(float(one["mean"]) * scale, color="black", lw=1.2, ls="--", label="mean")
    low_text, high_text = (f"{it:.2f}" if percent else format_number(it, 3) for it in (low, high))
    what = "total loss" if unit.endswith("W") else "energy lost"
    what, unit = ("efficiency", "%") if percent else (what, unit)
    ax.xaxis.set_major_locator(MaxNLocator(TICKS))
    legend_below(ax, ncols=3)
    title = f"{what.capitalize()}: 95 % from {low_text} to {high_text} {unit}"
    return labelled(ax, f"{what}, {unit}", "samples", title)
