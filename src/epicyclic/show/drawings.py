"""Figures of a page: still ones as SVG, and their data to explore."""

from __future__ import annotations

import io
import math
import re
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_hex
from matplotlib.container import BarContainer
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.projections.polar import PolarAxes

from epicyclic.show.page import Drawing
from epicyclic.show.plots.catalogue import PLOTS, Stored, about, in_inches, panels_of
from epicyclic.show.plots.style import STYLE, styled_figure

# Figures to explore: the lines, bars and fields of matplotlib Axes as data for plotly.js.
#
# Every plot is thus written once. What has no counterpart (drawings, text) stays a still figure.


DASHES = {"-": "solid", "--": "dash", "-.": "dashdot", ":": "dot"}
DIGITS = 7  # Significant digits of values in the page.
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


# Figures of a page: still ones as SVG within the page, and their data to explore.


PANEL = (4.3, 3.1)  # Width and height of a figure in a page. [inch]
_PROLOGUE = re.compile(r".*?(?=<svg)", re.DOTALL)
_METADATA = re.compile(r"\s*<metadata>.*?</metadata>", re.DOTALL)
_SIZE = re.compile(r'(<svg[^>]*?) width="[^"]*"', re.DOTALL)
_HEIGHT = re.compile(r'(<svg[^>]*?) height="[^"]*"', re.DOTALL)
_COORDINATES = re.compile(r'(?<=\sd=")[^"]*')
_LONG_NUMBER = re.compile(r"(\.\d\d)\d+")  # What is more precise than a hundredth of a point.
_OWN_ID = re.compile(r'(?<=\sid=")|(?<=url\(#)|(?<=href="#)')


def draw(stored: Stored, name: str, size: tuple[float, float] | None = None) -> list[Drawing]:
    """Each panel of a plot as a figure of its own, of a size in millimetres or that which suits."""
    drawings = []
    plot = PLOTS[name]
    point = ", ".join(filter(None, about(stored)))
    for number, panel in enumerate(panels_of(stored, name)):
        key = f"{name}-{number + 1}"
        suiting = plot.size if plot.is_wide else PANEL
        inches = suiting if size is None else in_inches(size)
        with styled_figure(1, 1, "", panel=inches, projection=plot.projection) as (figure, axes):
            ax = panel.draw(axes[0, 0])
            title = ax.get_title(loc="left") or ax.get_title()
            caption = f"{title}, {panel.subject}" if panel.subject else title
            ax.set_title("", loc="left")
            ax.set_title("")
        drawings.append(Drawing(key, caption, svg_text(figure, key), explorable(ax), point))
    return drawings


def svg_text(figure: Figure, key: str) -> str:
    """A figure as an ``svg`` element that fits any width, its ids beginning with `key`."""
    file = io.StringIO()
    with mpl.rc_context({**STYLE, "svg.hashsalt": key}):
        figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
    text = _METADATA.sub("", _PROLOGUE.sub("", file.getvalue(), count=1))
    text = _HEIGHT.sub(r"\1", _SIZE.sub(r"\1", text, count=1), count=1)
    text = _COORDINATES.sub(lambda path: _LONG_NUMBER.sub(r"\1", path[0]), text)
    return _OWN_ID.sub(f"{key}-", text)
