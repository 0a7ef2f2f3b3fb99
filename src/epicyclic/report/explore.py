"""Figures to explore: the lines, bars and fields of matplotlib Axes as data for plotly.js.

Every plot is thus written once. What has no counterpart (drawings, text) stays a still figure.
"""

from __future__ import annotations

import math
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_hex
from matplotlib.container import BarContainer
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.projections.polar import PolarAxes

DASHES = {"-": "solid", "--": "dash", "-.": "dashdot", ":": "dot"}
DIGITS = 7
"""Significant digits of values in the page."""
COLOUR_STEPS = 16


def explorable(ax: Axes) -> dict[str, Any] | None:
    """Data and layout for plotly.js, or None if nothing on the Axes can be explored."""
    if any(isinstance(patch, PathPatch) for patch in ax.patches):
        return None  # a drawing
    traces = [trace for line in ax.get_lines() if (trace := _line(ax, line))]
    bars = [bar for bar in ax.containers if isinstance(bar, BarContainer)]
    traces += [_polar_bars(bar) if isinstance(ax, PolarAxes) else _bars(bar) for bar in bars]
    traces += [_field(field) for field in ax.collections if isinstance(field, QuadMesh)]
    if not traces:
        return None
    layout = _polar_layout() if isinstance(ax, PolarAxes) else _layout(ax)
    names = {trace["name"] for trace in traces if trace.get("name")}
    layout |= {
        "title": {"text": _escaped(ax.get_title(loc="left") or ax.get_title())},
        "showlegend": len(names) > 1,
        "barmode": "overlay",
    }
    return {"data": traces, "layout": layout}


def _layout(ax: Axes) -> dict[str, Any]:
    layout: dict[str, Any] = {
        "xaxis": {"title": {"text": _escaped(ax.get_xlabel())}, "range": _list(ax.get_xlim())},
        "yaxis": {"title": {"text": _escaped(ax.get_ylabel())}, "range": _list(ax.get_ylim())},
    }
    labels = [label.get_text() for label in ax.get_yticklabels()]
    if any(isinstance(bar, BarContainer) for bar in ax.containers) and any(labels):
        ticks = {"tickvals": _list(ax.get_yticks()), "ticktext": [_escaped(one) for one in labels]}
        layout["yaxis"] |= ticks | {"tickmode": "array", "automargin": True}
    return layout


def _polar_layout() -> dict[str, Any]:
    angular = {"rotation": 90, "direction": "counterclockwise"}
    return {"polar": {"angularaxis": angular}}


def _line(ax: Axes, line: Line2D) -> dict[str, Any] | None:
    """A line in the coordinates of the Axes; not one drawn from edge to edge."""
    if line.get_transform() != ax.transData:
        return None
    label = str(line.get_label())
    style = line.get_linestyle()
    mode = "lines" if line.get_marker() in ("None", "", None) else "lines+markers"
    return {
        "type": "scatter",
        "mode": mode,
        "name": "" if label.startswith("_") else _escaped(label),
        "x": _list(line.get_xdata()),
        "y": _list(line.get_ydata()),
        "line": {"color": to_hex(line.get_color()), "dash": DASHES.get(str(style), "dash")},
        "marker": {"size": 4},
    }


def _bars(bars: BarContainer) -> dict[str, Any]:
    """Horizontal bars."""
    patches = bars.patches
    return {
        "type": "bar",
        "orientation": "h",
        "base": _list([bar.get_x() for bar in patches]),
        "x": _list([bar.get_width() for bar in patches]),
        "y": _list([bar.get_y() + bar.get_height() / 2 for bar in patches]),
        "marker": {"color": [to_hex(bar.get_facecolor()) for bar in patches]},
    }


def _polar_bars(bars: BarContainer) -> dict[str, Any]:
    patches = bars.patches
    middles = [math.degrees(bar.get_x() + bar.get_width() / 2) for bar in patches]
    return {
        "type": "barpolar",
        "name": _escaped(str(bars.get_label())),
        "theta": _list(middles),
        "width": _list([math.degrees(bar.get_width()) for bar in patches]),
        "r": _list([bar.get_height() for bar in patches]),
        "marker": {"color": to_hex(patches[0].get_facecolor())},
    }


def _field(field: QuadMesh) -> dict[str, Any]:
    """A field with its values at the corners (``shading="gouraud"``)."""
    corners = np.asarray(field.get_coordinates())
    masked: Any = np.ma.asarray(field.get_array())
    values = masked.filled(math.nan).reshape(corners.shape[:2])
    colours = mpl.colormaps[field.get_cmap().name]
    steps = np.linspace(0, 1, COLOUR_STEPS)
    return {
        "type": "heatmap",
        "x": _list(corners[0, :, 0]),
        "y": _list(corners[:, 0, 1]),
        "z": [_list(row) for row in values],
        "colorscale": [[float(step), to_hex(colours(step))] for step in steps],
    }


def _list(values: Any) -> list[float | None]:
    """Plain numbers of few digits, None for what is none."""
    numbers = np.asarray(values, dtype=float).ravel().tolist()
    return [float(f"{one:.{DIGITS}g}") if math.isfinite(one) else None for one in numbers]


def _escaped(text: str) -> str:
    """`text` as it is: plotly.js reads some tags."""
    return text.replace("&", "&amp;").replace("<", "&lt;")
