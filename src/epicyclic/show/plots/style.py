"""What all plots share: colours that colour-blind eyes tell apart, sizes, labels with units."""

from __future__ import annotations

import io
import math
import tempfile
import textwrap
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib import rcsetup
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from matplotlib.transforms import ScaledTranslation

from epicyclic.arrays import FloatArray
from epicyclic.units import format_number, unit_text

if TYPE_CHECKING:
    from matplotlib.animation import Animation

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""Colours of M. Okabe and K. Ito, Color Universal Design (2008)."""
COLOUR_MAP = "viridis"
LINE_STYLES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 3)), (0, (8, 2)))
MARKERS = ("o", "s", "^", "D", "v", "P", "X")  # Beside colours, for prints in grey.
PANEL = (4.8, 3.4)  # Width and height of one of the Axes of a figure. [inch]
BELOW = 0.42  # Room for the ticks and the label of an x axis. [inch]
WIDTH = 8.8  # Of a picture. [inch]
DPI = 1920 / WIDTH  # Letters have one size: a picture is as wide as a slide of 1920 pixels.
AROUND = 0.95  # Height that title, ticks and label of the x axis take from a row of Axes. [inch]
SMALL_CHARACTERS, CHARACTERS = 19, 16  # That fit into an inch of a legend, and of a label.
CHARACTER_POINTS = 132  # Characters in an inch of a line, times the size of its letters in points.
SMALL_POINTS, MEDIUM_POINTS, TITLE_POINTS = 7.5, 9.0, 11.0  # Sizes of letters.
TITLE_CHARACTERS = 11
"""Those of a title for an inch of the room of its Axes, which start beside their ticks. [1/inch]"""
SHORT_SPAN = 300
"""Largest over smallest value of an axis with logarithms on which 2 and 5 have labels too. [1]"""
SHORTEST = 12  # Characters of a line of a label, at least.
ENTRY = 0.45  # Room in a legend, beside the text of an entry. [inch]
LEGEND_ROW, LEGEND_REST = 0.2, 0.45
"""Height of a line of the legend of a figure, and of what is above it. [inch]"""

STYLE: Any = {
    "text.parse_math": False,  # names of users may have dollar signs
    "axes.prop_cycle": rcsetup.cycler("color", COLOURS),
    "axes.axisbelow": True,  # no lines across bars
    "axes.grid": True,
    "grid.alpha": 0.3,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": "medium",
    "axes.titlelocation": "left",
    "font.size": MEDIUM_POINTS,
    "axes.titleweight": "bold",
    "svg.fonttype": "none",
}


@contextmanager
def styled_figure(
    rows: int,
    columns: int,
    title: str,  # As it is, without mathematics; none if empty.
    *,
    panel: tuple[float, float] = PANEL,  # Width and height of one of the Axes. [inch]
    projection: str | None = None,  # ``"polar"``.
    # Width and height of the whole; default: that of all panels. [inch]
    size: tuple[float, float] | None = None,
    dpi: float | None = None,  # Pixels an inch; default: `DPI`.
    caption: str = "",  # Below all, as the operating point; none if empty.
    letters: float = 1.0,  # Size of title and caption over the usual one.
    count: int | None = None,  # Axes that stay, the first ones; default: all.
) -> Iterator[tuple[Figure, Any]]:
    """A figure and its array of Axes, drawn in the style of the package."""
    with mpl.rc_context(STYLE):
        size = size or (panel[0] * columns, panel[1] * rows)
        figure = Figure(figsize=size, dpi=dpi or DPI, layout="constrained")
        axes = figure.subplots(rows, columns, squeeze=False, subplot_kw={"projection": projection})
        for spare in axes.flat[count or axes.size :]:
            spare.remove()
        if title:
            points = letters * TITLE_POINTS
            figure.suptitle(title, x=0.01, ha="left", fontsize=points, fontweight="bold")
        if caption:
            caption_below(figure, caption, letters * SMALL_POINTS)
        yield figure, axes
        _break_labels(figure, rows)
        if any(ax.get_aspect() != "auto" for ax in figure.axes):
            figure.draw_without_rendering()  # their ticks, and the room these need, follow from it


def _break_labels(figure: Figure, rows: int) -> None:
    """Break labels beside Axes, and beside their scales of colours, that are longer than these."""
    room = float(figure.get_size_inches()[1]) / rows - AROUND
    for ax in figure.axes:
        label = ax.yaxis.label
        label.set_text(textwrap.fill(label.get_text(), max(SHORTEST, int(room * CHARACTERS))))


def caption_below(figure: Figure, caption: str, points: float = SMALL_POINTS) -> None:
    """What a figure is of, as the operating point, in small letters below all."""
    width = float(figure.get_size_inches()[0])
    figure.supxlabel(
        textwrap.fill(caption, max(1, int(width * CHARACTER_POINTS / points))),
        x=0.01,
        ha="left",
        fontsize=points,
        color="0.3",
    )


def legend_below(ax: Axes, **options: Any) -> None:
    """A legend under the label of the x axis, where it hides nothing, as wide as there is room."""
    figure = ax.get_figure()
    assert isinstance(figure, Figure)
    handles = options.get("handles") or ax.get_legend_handles_labels()[0]
    if not handles:  # no bar has a length
        return
    longest = max((len(str(handle.get_label())) for handle in handles), default=0)
    columns = int(room_of(ax) / (ENTRY + longest / SMALL_CHARACTERS))
    options["ncols"] = max(1, min(columns, options.get("ncols", 1)))
    ax.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, 0.0),
        bbox_transform=ax.transAxes + ScaledTranslation(0, -BELOW, figure.dpi_scale_trans),
        fontsize="small",
        frameon=False,
        **options,
    )


def legend_of_figure(figure: Figure, panels: Sequence[Axes], title: str) -> None:
    """One legend for all panels, below them; the figure grows by its height."""
    found: dict[str, Artist] = {}
    for ax in panels:
        handles, labels = ax.get_legend_handles_labels()
        found |= dict(zip(labels, handles, strict=True))
    width, height = figure.get_size_inches()
    entry = ENTRY + max(map(len, found)) / SMALL_CHARACTERS
    columns = max(1, min(len(found), int(width / entry)))
    lines = math.ceil(len(found) / columns)
    figure.set_size_inches(width, height + LEGEND_REST + LEGEND_ROW * lines)
    figure.legend(
        handles=list(found.values()),
        labels=list(found),
        title=title,
        loc="outside lower center",
        ncols=columns,
        fontsize="small",
        frameon=False,
    )


def room_of(ax: Axes) -> float:
    """Width of the figure that is left to Axes and what belongs to them. [inch]"""
    figure, place = ax.get_figure(), ax.get_subplotspec()
    assert isinstance(figure, Figure)
    return float(figure.get_size_inches()[0]) / (place.get_gridspec().ncols if place else 1)


def closed_period(
    places: FloatArray, values: FloatArray, period: float
) -> tuple[FloatArray, FloatArray]:
    """A curve over one period with its first point repeated at the end."""
    return np.append(places, places[0] + period), np.append(values, values[0])


def figure_bytes(figure: Figure, ending: str) -> bytes:
    """What a file of the type `ending`, ``"png"``, holds of a figure."""
    picture = io.BytesIO()
    figure.savefig(picture, format=ending)
    return picture.getvalue()


def gif_bytes(
    animation: Animation, fps: int, dpi: int, told: Callable[[int, int], object] | None = None
) -> bytes:
    """What a GIF file holds of an animation; `told` is called with the number of each frame."""
    with tempfile.TemporaryDirectory() as folder:  # the writer of frames takes a path only
        path = Path(folder) / "moving.gif"
        animation.save(path, "pillow", fps, dpi, progress_callback=told)
        return path.read_bytes()


def write_beside(
    ax: Axes, text: str, place: tuple[float, float], *, gap: int = 3, **style: Any
) -> None:
    """Small words at the right of a place of the data, with a `gap` of some points."""
    style = {"fontsize": "small", **style}
    ax.annotate(text, place, (gap, 0), textcoords="offset points", va="center", **style)


def label_logarithms(*axes: Axis) -> None:
    """Plain numbers along axes with logarithms: 1, 2, 5, 10 where there is room, else 1, 10."""
    for axis in axes:
        low, high = axis.get_view_interval()
        is_short = high < SHORT_SPAN * low
        axis.set_minor_locator(LogLocator(subs=(2, 5)))
        axis.set_major_formatter(FuncFormatter(_plain_number))
        axis.set_minor_formatter(FuncFormatter(_plain_number) if is_short else NullFormatter())


def _plain_number(value: float, place: int | None = None) -> str:
    """For a formatter of ticks: ``"1000000"``, not ``"1e+06"``."""
    return format_number(value)


def label_of(variable: xr.DataArray) -> str:
    """Name and unit of a variable, ``"line load, N/mm"``."""
    unit = unit_text(str(variable.attrs["units"]))
    name = str(variable.attrs["long_name"]).replace("_", " ")  # of gears
    return f"{name}, {unit}" if unit else name


def labelled(ax: Axes, x: xr.DataArray | str, y: xr.DataArray | str, title: str = "") -> Axes:
    """Axes with texts or names and units of variables, and a title: by default the name of `y`."""
    if not isinstance(y, str):
        title, y = title or title_of(y), label_of(y)
    ax.set(title=title, xlabel=x if isinstance(x, str) else label_of(x), ylabel=y)
    return ax


def place_text(value: xr.DataArray, digits: int = 6) -> str:
    """One value of an axis: a name, or a number with its unit, ``"4000 rpm"``."""
    if value.dtype.kind not in "fiu":
        return str(value.item())
    unit = unit_text(str(value.attrs.get("units", "1")))
    return f"{format_number(float(value), digits)} {unit}".rstrip()


def span_text(values: xr.DataArray) -> str:
    """Least and greatest of some numbers with their unit, ``"0 to 4000 rpm"``."""
    ends = dict.fromkeys((float(values.min()), float(values.max())))
    unit = unit_text(str(values.attrs.get("units", "1")))
    return f"{' to '.join(map(format_number, ends))} {unit}".rstrip()


def in_percent(values: xr.DataArray) -> xr.DataArray:
    """`values`, an efficiency in percent where anything comes out."""
    if values.name != "efficiency":
        return values
    return (100 * values.where(values > 0)).assign_attrs(values.attrs | {"units": "%"})


def title_of(variable: xr.DataArray) -> str:
    """Name of a variable with a capital."""
    text = str(variable.attrs["long_name"])
    return f"{text[:1].upper()}{text[1:]}"
