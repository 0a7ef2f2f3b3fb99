"""Figures of a page: still ones as SVG within the page, and their data to explore."""

from __future__ import annotations

import io
import re

import matplotlib as mpl
from matplotlib.figure import Figure

from epicyclic.report.explore import explorable
from epicyclic.report.page import Drawing
from epicyclic.show.plots.catalogue import PLOTS, Stored, about, in_inches, panels_of
from epicyclic.show.plots.style import STYLE, styled_figure

PANEL = (4.3, 3.1)
"""Width and height of a figure in a page. [inch]"""
_PROLOGUE = re.compile(r".*?(?=<svg)", re.DOTALL)
_METADATA = re.compile(r"\s*<metadata>.*?</metadata>", re.DOTALL)
_SIZE = re.compile(r'(<svg[^>]*?) width="[^"]*"', re.DOTALL)
_HEIGHT = re.compile(r'(<svg[^>]*?) height="[^"]*"', re.DOTALL)
_COORDINATES = re.compile(r'(?<=\sd=")[^"]*')
_LONG_NUMBER = re.compile(r"(\.\d\d)\d+")
"""What is more precise than a hundredth of a point."""
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
