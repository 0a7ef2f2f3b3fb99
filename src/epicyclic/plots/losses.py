"""Losses of one result: how large each component is, and how they add up."""

from __future__ import annotations

from collections.abc import Iterable

from matplotlib.axes import Axes
from matplotlib.patches import Patch

from epicyclic.plots.style import COLOURS, legend_below
from epicyclic.records.contents import ResultContents

__all__ = ["plot_loss_sum", "plot_losses"]

GROUP_COLOURS = {"load-dependent": COLOURS[0], "load-independent": COLOURS[4]}
SUM_COLOUR = "0.45"
ROOM = 1.32
"""Length of the axis over that of the longest bar, for the numbers beside the bars. [1]"""


def plot_losses(result: ResultContents, ax: Axes) -> Axes:
    """Every component of the loss, its power and share."""
    names = [name for name in result.losses if name not in result.not_included]
    watts = [result.losses[name] for name in names]
    colours = [GROUP_COLOURS[result.groups[name]] for name in names]
    ax.barh(_words(names), watts, color=colours, edgecolor="black", linewidth=0.5)
    for row, value in enumerate(watts):
        share = f" ({value / result.total:.1%})" if result.total else ""
        ax.annotate(
            f"{value:.1f}{share}",
            (value, row),
            xytext=(3, 0),
            textcoords="offset points",
            va="center",
            fontsize="small",
        )
    _finish(ax, watts)
    ax.set(title="Losses by component", xlabel="power loss, W")
    return ax


def plot_loss_sum(result: ResultContents, ax: Axes) -> Axes:
    """How the components add up to the total loss, the largest of each group first."""
    start = 0.0
    labels: list[str] = []
    for group, colour in GROUP_COLOURS.items():
        terms = [
            (watts, name)
            for name, watts in result.losses.items()
            if result.groups[name] == group and name not in result.not_included and watts
        ]
        for watts, name in sorted(terms, reverse=True):
            _step(ax, len(labels), start, watts, colour)
            labels += _words([name])
            start += watts
    _step(ax, len(labels), 0.0, result.total, SUM_COLOUR)
    ax.set_yticks(range(len(labels) + 1), [*labels, "total"])
    _finish(ax, [result.total])
    ax.set(title="How the losses add up", xlabel="power loss, W")
    return ax


def _step(ax: Axes, row: int, start: float, watts: float, colour: str) -> None:
    ax.barh(row, watts, left=start, color=colour, edgecolor="black", linewidth=0.5)
    ax.annotate(
        f"{watts:.1f}",
        (start + watts, row),
        xytext=(3, 0),
        textcoords="offset points",
        va="center",
        fontsize="small",
    )


def _words(names: Iterable[str]) -> list[str]:
    return [name.replace("_", " ") for name in names]


def _finish(ax: Axes, watts: Iterable[float]) -> None:
    ax.invert_yaxis()
    ax.grid(visible=False, axis="y")
    ax.set_xlim(0, ROOM * max(watts, default=0.0) or 1.0)
    handles = [Patch(facecolor=colour, label=group) for group, colour in GROUP_COLOURS.items()]
    legend_below(ax, handles=handles, ncols=2)
