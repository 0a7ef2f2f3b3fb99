"""Published figures beside computed ones: how far off each is, and how far off it may be."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from epicyclic.plots.style import COLOURS, write_beside
from epicyclic.units import format_number, percent, unit_text
from epicyclic.validation.compare import Comparison

SHOWN = 0.40
"""Differences beyond it are drawn at the edge, with their number. [1]"""
WIDTH, ROW, REST = 8.2, 0.32, 1.0
"""Width of a picture, height of a row, and of what is not rows. [inch]"""
LETTERS = 62
"""In one line of a label."""
_BAND = "0.85"
_MARKS: dict[str, dict[str, Any]] = {
    "agrees": {"marker": "o", "mfc": COLOURS[0], "color": COLOURS[0]},
    "differs": {"marker": "X", "mfc": COLOURS[1], "color": COLOURS[1]},
    "calibrated": {"marker": "s", "mfc": "none", "color": "0.45"},
    "no verdict": {"marker": "o", "mfc": "none", "color": "0.45"},
}


def deviations_size(rows: Sequence[Comparison]) -> tuple[float, float]:
    """Width and height of the picture of some figures. [inch]"""
    return WIDTH, REST + ROW * len(rows)


def plot_deviations(rows: Sequence[Comparison], ax: Axes) -> Axes:
    """Computed over published less one for each figure, on the band in which it agrees."""
    for place, row in enumerate(rows):
        if row.role == "validation":
            tolerance = 100 * min(row.tolerance, SHOWN)
            ax.barh(place, 2 * tolerance, left=-tolerance, height=0.7, color=_BAND)
        value = 100 * min(max(row.difference, -SHOWN), SHOWN)
        ax.plot(value, place, ls="none", ms=6, **_MARKS[row.verdict])
        text = f"{_number(row)}, {percent(row.difference, signed=True)}"
        write_beside(ax, text, (100 * SHOWN, place), gap=6, annotation_clip=False)
    ax.axvline(0.0, color="black", lw=0.8)
    ax.set_yticks(range(len(rows)), ["\n".join(textwrap.wrap(row.what, LETTERS)) for row in rows])
    ax.tick_params(axis="y", labelsize="small")
    ax.set_xlim(-105 * SHOWN, 105 * SHOWN)
    ax.set_ylim(len(rows) - 0.4, -0.6)
    ax.grid(visible=False, axis="y")
    ax.set_xlabel("computed over published, difference in %")
    seen = dict.fromkeys(row.verdict for row in rows)
    handles: list[Line2D | Patch] = [
        Line2D([], [], ls="none", ms=6, label=verdict, **_MARKS[verdict]) for verdict in seen
    ]
    if any(row.role == "validation" and row.tolerance > 0 for row in rows):
        handles.append(Patch(facecolor=_BAND, label="tolerance"))
    ax.figure.legend(handles=handles, loc="outside lower center", ncols=5, frameon=False)
    return ax


def _number(row: Comparison) -> str:
    """The published value with its unit."""
    low, high = format_number(row.low, 4), format_number(row.high, 4)
    value = low if low == high else f"{low} to {high}"
    return f"{value} {unit_text(row.unit)}".rstrip()
