"""Losses of one result: how large each component is, and how they add up."""

from __future__ import annotations

from collections.abc import Iterable

from matplotlib.axes import Axes
from matplotlib.patches import Patch

from epicyclic.plots.style import COLOURS, legend_below, write_beside
from epicyclic.records.contents import ResultContents
from epicyclic.results.result import in_words
from epicyclic.units import decimals_of, percent, power_unit

GROUP_COLOURS = {"load-dependent": COLOURS[0], "load-independent": COLOURS[4]}
SUM_COLOUR = "0.45"
ROOM = 1.32
"""Length of the axis over that of the longest bar, for the numbers beside the bars. [1]"""
MOST_BARS = 16


def plot_losses(result: ResultContents, ax: Axes) -> Axes:
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


def plot_loss_sum(result: ResultContents, ax: Axes) -> Axes:
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


def _rows(result: ResultContents, scale: float) -> list[tuple[str, str, float]]:
    """Label, group and power of every bar: of every set, or what a single one loses by component.

    Where these are too many, all losses of a mesh, bearing or body are one.
    """
    sums: dict[tuple[str, str], float] = {}
    for name, label in _labels(result).items():
        key = in_words(label), result.groups[name]
        sums[key] = sums.get(key, 0.0) + result.losses[name] / scale
    return [(label, group, power) for (label, group), power in sums.items()]


def _labels(result: ResultContents) -> dict[str, str]:
    """The bar to which each loss belongs."""
    shown = [name for name in result.losses if name not in result.not_included]
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
