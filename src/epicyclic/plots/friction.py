"""Friction models of a case side by side."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from epicyclic.analysis.compare import FrictionComparison, recommended
from epicyclic.plots.style import COLOURS, legend_below, styled_figure, write_beside
from epicyclic.units import decimals_of

ROW_HEIGHT = 0.3
"""Height of one bar. [inch]"""
ROOM = 1.45
"""Length of the axis over that of the longest bar, for the words beside the bars. [1]"""
COLOUR, OTHER = COLOURS[0], "0.75"


def friction_figure(rows: Sequence[FrictionComparison], title: str) -> Figure:
    """The sliding loss with every friction model."""
    panel = (7.6, 1.6 + ROW_HEIGHT * len(rows))
    with styled_figure(1, 1, title, panel=panel) as (figure, axes):
        plot_friction_models(rows, axes[0, 0])
    return figure


def plot_friction_models(rows: Sequence[FrictionComparison], ax: Axes) -> Axes:
    """A bar for each model; hatched as far as the loss is outside its range."""
    best, _ = recommended(rows)
    digits = decimals_of(max(row.sliding for row in rows))
    for place, row in enumerate(rows):
        colour = OTHER if row.other_oil else COLOUR
        inside = row.sliding * (1 - row.outside)
        ax.barh(place, inside, color=colour, edgecolor="black", linewidth=0.5)
        ax.barh(
            place,
            row.sliding - inside,
            left=inside,
            color="white",
            hatch="////",
            edgecolor=colour,
            linewidth=1.0,
        )
        marks = [
            mark
            for mark, holds in (
                ("chosen", row.chosen),
                ("recommended", row is best),
                ("made for another oil", row.other_oil),
            )
            if holds
        ]
        text = ", ".join([f"{row.sliding:.{digits}f} W", *marks])
        weight = "bold" if row.chosen else "normal"
        write_beside(ax, text, (row.sliding, place), fontweight=weight)
    ax.set_yticks(range(len(rows)), [row.name for row in rows])
    ax.invert_yaxis()
    ax.grid(visible=False, axis="y")
    ax.set_xlim(0, ROOM * max(row.sliding for row in rows) or 1.0)
    ax.set(title="Sliding loss by friction model", xlabel="sliding loss of all meshes, W")
    handles = [
        Patch(facecolor=COLOUR, edgecolor="black", label="for this oil, or for any"),
        Patch(facecolor=OTHER, edgecolor="black", label="made for another oil"),
        Patch(facecolor="white", edgecolor=COLOUR, hatch="////", label="outside its range"),
    ]
    legend_below(ax, handles=handles, ncols=3)
    return ax
