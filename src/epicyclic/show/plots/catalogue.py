"""What can be drawn from a stored result or a map, and figures as pages show them."""

from __future__ import annotations

import io
import itertools
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import FillBetweenPolyCollection, QuadMesh, TriMesh
from matplotlib.colors import to_hex, to_rgba
from matplotlib.container import BarContainer
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, StepPatch
from matplotlib.projections.polar import PolarAxes
from matplotlib.text import Annotation
from scipy.interpolate import LinearNDInterpolator

from epicyclic.dataclass import dataclass
from epicyclic.errors import one_problem
from epicyclic.result.result import in_words, set_of
from epicyclic.show.page import Drawing
from epicyclic.show.plots import loss_map, losses, mesh, sweep
from epicyclic.show.plots.arrangement import arrangement_of, plot_from_the_end, plot_from_the_side
from epicyclic.show.plots.drawing import plot_gear_set, plot_oil, plot_teeth
from epicyclic.show.plots.heat_network import plot_heat_network
from epicyclic.show.plots.pockets import plot_life_with_scale, plot_power, plot_volumes
from epicyclic.show.plots.power_flow import SLIDE, plot_power_flow
from epicyclic.show.plots.style import PANEL, STYLE, TITLE_CHARACTERS, WIDTH, room_of, styled_figure
from epicyclic.show.record import ResultRecord, sets_of
from epicyclic.study.maps.tables import map_case, map_inputs
from epicyclic.study.operating import operating_line
from epicyclic.study.shapes import gear_shapes
from epicyclic.study.sweeps.run import is_sweep

Stored = ResultRecord | xr.Dataset
MM_PER_INCH = 25.4
ROW = 3.4  # Height of a row of panels. [inch]


@dataclass(frozen=True, slots=True)
class Panel:
    """One Axes of a plot."""

    subject: str  # What it is of, ``"sun mesh"``; empty if it is of the whole.
    draw: Callable[[Axes], Axes]  # Draws on Axes.


Panels = Callable[[Stored], list[Panel]]  # The panels that a stored result or map has.


@dataclass(frozen=True, slots=True)
class Plot:
    """One plot."""

    question: str  # Which it answers.
    panels: Panels  # None if what is stored lacks what the plot shows.
    projection: str | None = None  # Projection of its Axes.
    size: tuple[float, float] = PANEL  # Width and height of one of its Axes. [inch]

    @property
    def is_wide(self) -> bool:
        """True if it takes the width of a page."""
        return self.size != PANEL


def _of_record(panels: Callable[[ResultRecord], Iterable[Panel]]) -> Panels:
    """The panels of a result; maps and the like have none."""
    return lambda stored: list(panels(stored)) if isinstance(stored, ResultRecord) else []


def _of_result(draw: Callable[..., Axes]) -> Panels:
    return _of_record(lambda record: [Panel("", partial(draw, record.result))])


def _of_group(group: str, draw: Callable[..., Axes], *more: object) -> Panels:
    """One panel for each field of a group."""

    @_of_record
    def panels(record: ResultRecord) -> Iterator[Panel]:
        for subject, _, data in _named(record.group(group)):
            yield Panel(subject, partial(draw, data, *more))

    return panels


def _named(fields: Mapping[str, xr.Dataset]) -> Iterator[tuple[str, str, xr.Dataset]]:
    """The subject of a panel for each field, none of an only one; its key and itself."""
    for key, data in fields.items():
        yield in_words(key) if len(fields) > 1 else "", key, data


def _gears_of(stored: Stored) -> Mapping[str, xr.Dataset]:
    """Shapes of the gears; those of a map follow from its case."""
    if isinstance(stored, ResultRecord):
        return stored.group("gears")
    case = None if is_sweep(stored) else map_case(stored)
    return {} if case is None else gear_shapes(case)


def _gear_set(stored: Stored) -> list[Panel]:
    """The gears of a set, or of every set of a train."""
    return [
        Panel(in_words(name), partial(plot_gear_set, gears))
        for name, gears in sets_of(_gears_of(stored)).items()
    ]


@_of_record
def _arrangement(record: ResultRecord) -> Iterator[Panel]:
    """A train from the end and from the side, if all dimensions are known."""
    inputs = record.result.inputs
    if record.result.train and (found := arrangement_of(inputs, record.group("gears"))):
        yield Panel("", partial(plot_from_the_end, found))
        yield Panel("", partial(plot_from_the_side, found, inputs))


def _oil(stored: Stored) -> list[Panel]:
    """All gears in the oil of the housing, if some dip."""
    gears = {name: gear for name, gear in _gears_of(stored).items() if "stands_x" in gear}
    return [Panel("", partial(plot_oil, gears))] if gears else []


@_of_record
def _teeth(record: ResultRecord) -> Iterator[Panel]:
    gears = sets_of(record.group("gears"))
    for subject, key, view in _named(record.group("views")):
        yield Panel(subject, partial(plot_teeth, view, gears[set_of(key)]))


def _of_map(draw: Callable[..., Axes], name: str, *more: object) -> Panels:
    """The panels of a map, all with one scale for `name`."""
    return _over_plane("torque_loss", partial(loss_map.limits_of, name=name), draw, name, *more)


def _over_plane(
    needed: str,  # What a map has, or only one with its uncertainty: ``"explained"``.
    limits: Callable[[xr.Dataset], loss_map.Limits],
    draw: Callable[..., Axes],
    *more: object,
) -> Panels:
    """One panel for each shown state and temperature, at the first value of further keys."""
    titles = {"state": "state {}", "temperature": "{:g} °C"}

    def panels(stored: Stored) -> list[Panel]:
        if isinstance(stored, ResultRecord) or needed not in stored:
            return []
        scale, shown = limits(stored), loss_map.shown_panels(stored)
        values = (stored[name].values[places].tolist() for name, places in shown.items())
        found = []
        for point in itertools.product(*values):
            at = dict(zip(shown, point, strict=True))
            subject = ", ".join(titles[name].format(value) for name, value in at.items())
            panel = partial(draw, loss_map.map_at(stored, **at), *more, limits=scale)
            found.append(Panel(subject, panel))
        return found

    return panels


def _uncertainty_of(stored: Stored) -> xr.Dataset | None:
    """How well a result is known, or the energy of a cycle."""
    if isinstance(stored, ResultRecord):
        return next(iter(stored.group("uncertainty").values()), None)
    return stored if "contribution" in stored else None


def _drivers(stored: Stored) -> list[Panel]:
    """Of a map the shares over all its points, else the change by each."""
    if not isinstance(stored, ResultRecord) and "explained" in stored:
        return [Panel("", partial(losses.plot_shares, stored))]
    data = _uncertainty_of(stored)
    return [] if data is None else [Panel("", partial(losses.plot_drivers, data))]


def _band(stored: Stored) -> list[Panel]:
    """Total loss, and efficiency if it is known."""
    data = _uncertainty_of(stored)
    if data is None:
        return []
    return [Panel("", partial(losses.plot_band, data, name)) for name in losses.banded(data)]


def _of_sweep(
    draw: Callable[..., Axes], dimensions: Callable[[xr.Dataset], list[str]], least: int
) -> Panels:
    """One panel for each result of a sweep that has enough dimensions."""

    def panels(stored: Stored) -> list[Panel]:
        if isinstance(stored, ResultRecord) or not is_sweep(stored):
            return []
        names = sweep.shown_results(stored) if len(dimensions(stored)) >= least else []
        return [Panel("", partial(draw, stored, name)) for name in names]

    return panels


def _sweep_points(stored: Stored) -> list[Panel]:
    if isinstance(stored, ResultRecord) or "total" not in sweep.shown_results(stored):
        return []
    enough = len(sweep.varied(stored)) > 1
    return [Panel("", partial(sweep.plot_sweep_parallel, stored))] if enough else []


@_of_record
def _pocket_pressure(record: ResultRecord) -> Iterator[Panel]:
    """Both kinds of pocket of each mesh."""
    for subject, _, data in _named(record.group("pockets")):
        for kind in range(data.sizes["tooth"]):
            yield Panel(subject, partial(plot_life_with_scale, data, "pressure", kind))


@_of_record
def _power_flow(record: ResultRecord) -> Iterator[Panel]:
    if record.result.input_power:
        yield Panel("", partial(plot_power_flow, record.result))


@_of_record
def _heat(record: ResultRecord) -> Iterator[Panel]:
    heat = record.result.heat
    if heat and heat.ways:
        yield Panel("", partial(plot_heat_network, heat))


_over_flanks = partial(_of_group, "meshes", mesh.plot_plane_of_action)
_over_period = partial(_of_group, "meshes", mesh.plot_over_period)
_along_path = partial(_of_group, "meshes", mesh.plot_along_path)
PLOTS: dict[str, Plot] = {
    "gear-set": Plot("What does the gear set look like, to scale?", _gear_set),
    "arrangement": Plot("Where do the sets and shafts of the train lie?", _arrangement),
    "oil": Plot("How deep do the gears dip into the oil?", _oil),
    "teeth": Plot("How do the teeth touch, and where is the path of contact?", _teeth),
    "losses": Plot("Where is the power lost?", _of_result(losses.plot_losses)),
    "loss-sum": Plot("How do the losses add up?", _of_result(losses.plot_loss_sum)),
    "power-flow": Plot(
        "Where does the power flow, circulate and get lost?", _power_flow, size=SLIDE
    ),
    "drivers": Plot("What causes the uncertainty of the total loss?", _drivers, size=losses.WIDE),
    "band": Plot("How uncertain are total loss and efficiency?", _band),
    "heat-network": Plot("How warm is each part, and where does its heat flow?", _heat, size=SLIDE),
    "line-load": Plot("How is the load distributed over the flanks?", _over_flanks("line_load")),
    "pressure": Plot(
        "How high is the contact pressure, and where?", _over_flanks("hertz_pressure")
    ),
    "pair-load": Plot(
        "How does the load of one tooth pair change through its engagement?",
        _of_group("meshes", mesh.plot_pair_loads),
    ),
    "transmission-error": Plot(
        "How large is the loaded transmission error?", _over_period("transmission_error")
    ),
    "stiffness": Plot("How stiff is the mesh?", _over_period("mesh_stiffness")),
    "friction": Plot(
        "How does friction change along the path of contact?", _along_path("friction_coefficient")
    ),
    "sliding": Plot("How fast do the flanks slide?", _along_path("sliding_speed")),
    "film": Plot("Does the oil film separate the flanks?", _along_path("film_ratio")),
    "friction-power": Plot("Where on the flanks is power lost?", _over_flanks("friction_power")),
    "roller-loads": Plot(
        "Which rollers of the planet bearing carry load?",
        _of_group("bearings", mesh.plot_roller_loads),
        projection="polar",
    ),
    "roller-pressure": Plot(
        "How is the load distributed along the rollers?",
        _of_group("bearings", mesh.plot_roller_profile),
    ),
    "pocket-pressure": Plot(
        "How does the pressure in a pocket change through its life?", _pocket_pressure
    ),
    "pocket-volume": Plot(
        "How does the volume of the pockets change?", _of_group("pockets", plot_volumes)
    ),
    "pocket-power": Plot(
        "How much power do the pockets absorb over a mesh period?", _of_group("pockets", plot_power)
    ),
    "efficiency-map": Plot(
        "How does the efficiency depend on speed and torque?",
        _of_map(loss_map.plot_map, "efficiency"),
    ),
    "loss-map": Plot(
        "How much power is lost over speed and torque?", _of_map(loss_map.plot_map, "total")
    ),
    "torque-loss-map": Plot(
        "How much torque is lost over speed and torque?", _of_map(loss_map.plot_map, "torque_loss")
    ),
    "loss-over-speed": Plot(
        "How does the loss grow with speed?", _of_map(loss_map.plot_map_lines, "total", "speed")
    ),
    "loss-over-torque": Plot(
        "How does the loss grow with torque?", _of_map(loss_map.plot_map_lines, "total", "torque")
    ),
    "loss-parts": Plot(
        "Which components make up the loss?", _of_map(loss_map.plot_map_parts, "total")
    ),
    "loss-band": Plot(
        "How uncertain is the loss over speed and torque?",
        _over_plane("explained", loss_map.limits_of_half_width, loss_map.plot_half_width),
    ),
    "loss-band-lines": Plot(
        "How uncertain is the loss along a line?",
        _over_plane("explained", loss_map.limits_of_band, loss_map.plot_band_lines, "torque"),
    ),
    "lines": Plot(
        "How do loss and efficiency depend on the varied keys?",
        _of_sweep(sweep.plot_sweep_lines, sweep.varied, 1),
    ),
    "contours": Plot(
        "Which values of two keys give the least loss?",
        _of_sweep(sweep.plot_sweep_field, sweep.fields_of, 2),
    ),
    "parallel": Plot(
        "Which values of all keys give a small loss?", _sweep_points, size=losses.WIDE
    ),
}
"""By the names that ``epicyclic plot`` takes."""


def available(stored: Stored) -> dict[str, Plot]:
    """The plots for which `stored` holds the data."""
    return {name: plot for name, plot in PLOTS.items() if plot.panels(stored)}


def panels_of(stored: Stored, name: str) -> list[Panel]:
    """The panels of a plot.

    Raises `InputError` if there is no such plot, or the file lacks what it shows.
    """
    panels = PLOTS[name].panels(stored) if name in PLOTS else []
    if panels:
        return panels
    found = available(stored)
    allowed = "cannot be drawn from this file" if name in PLOTS else "is not a plot"
    allowed = f"{allowed}; it has {', '.join(found)}."
    raise one_problem("WHAT", name, allowed, "Choose one of these.", "the command")


def in_inches(size: tuple[float, float]) -> tuple[float, float]:
    """Width and height in millimetres as Matplotlib has them."""
    return size[0] / MM_PER_INCH, size[1] / MM_PER_INCH


def figure_of(
    stored: Stored,  # As `epicyclic.open_result` returns it.
    name: str,  # One of `PLOTS`.
    *,
    # Width and height; default: in the proportion of a slide. [mm]
    size: tuple[float, float] | None = None,
    # Pixels an inch; default: such that a figure of that width has the pixels of a slide.
    dpi: float | None = None,
) -> Figure:
    """A plot as a figure, its panels side by side, the operating point below."""
    panels = panels_of(stored, name)
    columns = min(2, len(panels))
    rows = math.ceil(len(panels) / columns)
    title, point = about(stored)
    plot = PLOTS[name]
    inches = WIDTH, WIDTH * SLIDE[1] / SLIDE[0] if len(panels) == 1 else ROW * rows
    if plot.is_wide:
        inches = (plot.size[0] * columns, plot.size[1] * rows)
    letters = max(1.0, inches[0] / WIDTH)  # those of a wide drawing have the size that it needs
    if size is not None:
        inches = in_inches(size)
    with styled_figure(
        rows,
        columns,
        title,
        projection=plot.projection,
        size=inches,
        dpi=dpi,
        caption=point,
        letters=letters,
        count=len(panels),
    ) as (figure, axes):
        for panel, ax in zip(panels, axes.ravel(), strict=False):
            panel.draw(ax)
            if panel.subject:
                drawn = ax.get_title(loc="left")
                whole = f"{drawn}, {panel.subject}"
                has_room = len(whole) < TITLE_CHARACTERS * room_of(ax)
                ax.set_title(whole if has_room else f"{drawn},\n{panel.subject}")
    return figure


def about(stored: Stored) -> tuple[str, str]:
    """Title and operating point, or the points of a map, sweep or cycle."""
    if isinstance(stored, ResultRecord):
        return stored.title, operating_line(stored.result.inputs["operation"])
    title = str(stored.attrs.get("title", ""))
    if is_sweep(stored):
        return title, sweep.sweep_line(stored)
    if "torque_loss" in stored:
        return title, loss_map.map_line(stored)
    cycle = str(stored.attrs.get("cycle", ""))
    return title, cycle or operating_line(map_inputs(stored)["operation"])


# Figures to explore: lines, bars, areas and fields of matplotlib Axes as data for plotly.js.
#
# Every plot is thus written once. What has no counterpart (drawings) stays a still figure.

DASHES = {"-": "solid", "--": "dash", "-.": "dashdot", ":": "dot"}
DIGITS = 7  # Significant digits of values in the page.
COLOUR_STEPS = 32
GRID = 61  # Places along each side of a field whose values are known at scattered points.
FONT = {"size": 12}
AXIS = {
    "ticks": "outside",
    "tickcolor": "rgba(0,0,0,0)",
    "automargin": True,
    "exponentformat": "none",
    "separatethousands": False,
}


def explorable(ax: Axes) -> dict[str, Any] | None:
    """Data and layout for plotly.js, or None if nothing on the Axes can be explored."""
    bars = [bar for bar in ax.containers if isinstance(bar, BarContainer)]
    known = {patch for bar in bars for patch in bar.patches}
    others = [one for one in ax.patches if one not in known and not isinstance(one, StepPatch)]
    if any(_shape(ax, one) is None for one in others):
        return None  # a drawing
    labels = _of_axis(ax.get_xlabel()), _of_axis(ax.get_ylabel())
    traces: list[dict[str, Any]] = []
    for it in ax.collections:
        if isinstance(it, QuadMesh | TriMesh):
            traces.append(_field(it, labels))
        elif isinstance(it, ContourSet):
            traces += _levels(it, traces[0])
        elif isinstance(it, FillBetweenPolyCollection):
            traces.append(_area(it, is_band=bool(ax.get_lines())))
    traces += [trace for line in ax.get_lines() if (trace := _line(ax, line, labels))]
    is_polar = isinstance(ax, PolarAxes)
    traces += [_polar_bars(bar) if is_polar else _bars(ax, bar) for bar in bars]
    traces += [_steps(patch, labels) for patch in ax.patches if isinstance(patch, StepPatch)]
    if not traces:
        return None
    layout = _layout(ax)
    marks: list[Line2D | Patch] = [*ax.get_lines(), *others]
    for trace in traces:
        trace["showlegend"] = bool(trace.get("name"))
    shapes = [shape for mark in marks if (shape := _shape(ax, mark))]
    layout |= {
        "shapes": shapes,
        "title": {"text": _escaped(ax.get_title(loc="left") or ax.get_title())},
        "showlegend": len({one["name"] for one in (*traces, *shapes) if one.get("name")}) > 1,
        "barmode": "overlay",
        "hovermode": "closest",
        "annotations": [_annotation(it) for it in ax.texts if isinstance(it, Annotation)],
    }
    return {"data": traces, "layout": layout}


def _of_axis(label: str) -> str:
    """A label in one line."""
    return _escaped(" ".join(label.split()))


def _layout(ax: Axes) -> dict[str, Any]:
    if isinstance(ax, PolarAxes):
        angular = {"rotation": 90, "direction": "counterclockwise"}
        # room for the label above
        return {"polar": {"angularaxis": angular, "domain": {"y": [0.0, 0.92]}}}
    layout: dict[str, Any] = {}
    for name, axis in (("xaxis", ax.xaxis), ("yaxis", ax.yaxis)):
        ends, is_log = axis.get_view_interval(), axis.get_scale() == "log"
        layout[name] = AXIS | {
            "title": {"text": _escaped(axis.label.get_text()).replace("\n", "<br>")}
            | {"standoff": 8, "font": FONT},
            "type": "category" if axis.have_units() else "log" if is_log else "linear",
            "range": _list(np.log10(ends) if is_log else ends),
        }
    labels = _bar_labels(ax)
    if labels:
        ticks = {"tickvals": list(labels), "ticktext": list(labels.values())}
        layout["yaxis"] |= ticks | {"tickmode": "array"}
    return layout


def _bar_labels(ax: Axes) -> dict[float, str]:
    """What stands beside bars, by their place."""
    if not any(isinstance(bar, BarContainer) for bar in ax.containers):
        return {}
    texts = [_escaped(label.get_text()) for label in ax.get_yticklabels()]
    return dict(zip(ax.get_yticks().tolist(), texts, strict=True)) if any(texts) else {}


def _shape(ax: Axes, mark: Line2D | Patch) -> dict[str, Any] | None:
    """A line or band from edge to edge of the Axes; None of others."""
    across = ax.get_xaxis_transform("grid"), ax.get_yaxis_transform("grid")
    transform = Artist.get_transform(mark)
    if transform not in across:
        return None
    along, other = ("x", "y") if transform == across[0] else ("y", "x")
    label = _name(mark)
    shape: dict[str, Any] = {"name": label, "showlegend": bool(label)}
    if isinstance(mark, Line2D):
        low, *_ = _list(mark.get_xdata() if along == "x" else mark.get_ydata())
        high = low
        dash = DASHES.get(str(mark.get_linestyle()), "dash")
        line = {"color": to_hex(mark.get_color()), "dash": dash, "width": mark.get_linewidth()}
        shape |= {"type": "line", "line": line}
    else:
        box = mark.get_extents().transformed(ax.transData.inverted())
        low, high = _list(box.intervalx if along == "x" else box.intervaly)
        fill = {"fillcolor": _colour(mark.get_facecolor()), "line": {"width": 0}}
        shape |= fill | {"type": "rect", "layer": "below"}
    ends = {f"{along}0": low, f"{along}1": high, f"{other}0": 0, f"{other}1": 1}
    return shape | ends | {f"{other}ref": "paper"}


def _name(artist: Artist | BarContainer) -> str:
    """The entry of a legend, empty if it has none."""
    label = str(artist.get_label())
    return "" if label.startswith("_") else _escaped(label)


def _annotation(text: Annotation) -> dict[str, Any]:
    """Words at the right of a place."""
    (x, y), place = text.xy, {"showarrow": False, "xanchor": "left", "xshift": 3}
    words = {"text": _escaped(text.get_text()), "font": {"size": 11}}
    return place | words | {"x": float(x), "y": float(y)}


def _line(ax: Axes, line: Line2D, labels: tuple[str, str]) -> dict[str, Any] | None:
    """A line in the coordinates of the Axes; not one drawn from edge to edge."""
    if line.get_transform() != ax.transData:
        return None
    style, nothing = line.get_linestyle(), ("None", "", " ", None)
    parts = {"lines": style, "markers": line.get_marker()}
    return {
        "type": "scatter",
        "mode": "+".join(part for part, look in parts.items() if look not in nothing) or "none",
        "name": _name(line),
        "x": _list(line.get_xdata()),
        "y": _list(line.get_ydata()),
        "line": {"color": to_hex(line.get_color()), "dash": DASHES.get(str(style), "dash")},
        "marker": {"size": 4},
        "hovertemplate": _hover(*labels, named=ax.xaxis.have_units()),
    }


def _hover(*labels: str, named: bool = False) -> str:
    """What is told of a place: labels with values, and the name beside them; x may be names."""
    axes = zip(labels, ("x" if named else "x:.5~g", "y:.5~g", "z:.5~g"), strict=False)
    return "<br>".join(f"{label}: %{{{axis}}}" for label, axis in axes)


def _area(area: FillBetweenPolyCollection, *, is_band: bool) -> dict[str, Any]:
    """What lies between two curves: a band about lines, or one of several parts of a sum."""
    edge = np.asarray(area.get_paths()[0].vertices)
    half = len(edge) // 2 - 1
    low, high = edge[1 : half + 1, 1], edge[half + 2 : 2 * half + 2, 1][::-1]
    texts = [
        f"{bottom:.4g} to {top:.4g}" if is_band else f"{top - bottom:.4g}"
        for bottom, top in zip(low, high, strict=True)
    ]
    ends = (edge[1 : half + 1, 0], edge[half + 2 : 2 * half + 2, 0])
    return {
        "type": "scatter",
        "mode": "lines",
        "name": _name(area),
        "x": _list(np.concatenate(ends)),
        "y": _list(np.concatenate([low, high[::-1]])),
        "fill": "toself",
        "hoveron": "points",
        "line": {"width": 0},
        "fillcolor": _colour(area.get_facecolor()[0]),
        "text": texts + texts[::-1],
        "hovertemplate": "%{text}",
    }


def _colour(colour: Any) -> str:
    red, green, blue, alpha = (round(255 * part) for part in to_rgba(colour))
    return f"rgba({red},{green},{blue},{alpha / 255:.2f})"


def _bars(ax: Axes, bars: BarContainer) -> dict[str, Any]:
    """Horizontal bars."""
    patches, names = bars.patches, _bar_labels(ax)
    middles = [bar.get_y() + bar.get_height() / 2 for bar in patches]
    unit = ax.get_xlabel().rpartition(", ")[2]
    return {
        "type": "bar",
        "orientation": "h",
        "name": _name(bars),
        "base": _list([bar.get_x() for bar in patches]),
        "x": _list([bar.get_width() for bar in patches]),
        "y": _list(middles),
        "width": _list([bar.get_height() for bar in patches]),
        "marker": {"color": [_colour(bar.get_facecolor()) for bar in patches]},
        "customdata": [names.get(round(middle), "") for middle in middles],
        "text": [f"{bar.get_width():.4g} {_escaped(unit)}" for bar in patches],
        "textposition": "none",
        "hovertemplate": "%{customdata}: %{text}",
    }


def _steps(steps: StepPatch, labels: tuple[str, str]) -> dict[str, Any]:
    """A distribution."""
    values, edges, _ = steps.get_data()
    return {
        "type": "bar",
        "name": "",
        "x": _list((edges[1:] + edges[:-1]) / 2),
        "y": _list(values),
        "width": _list(np.diff(edges)),
        "marker": {"color": to_hex(steps.get_facecolor())},
        "hovertemplate": _hover(*labels),
    }


def _polar_bars(bars: BarContainer) -> dict[str, Any]:
    patches = bars.patches
    return {
        "type": "barpolar",
        "name": _escaped(str(bars.get_label())),
        "theta": _list([math.degrees(bar.get_x() + bar.get_width() / 2) for bar in patches]),
        "width": _list([math.degrees(bar.get_width()) for bar in patches]),
        "r": _list([bar.get_height() for bar in patches]),
        "marker": {"color": to_hex(patches[0].get_facecolor())},
        "hovertemplate": "%{r:.4~g} at %{theta:.1f}°",
    }


def _field(field: QuadMesh | TriMesh, labels: tuple[str, str]) -> dict[str, Any]:
    """A field with its values at corners or at scattered points (``shading="gouraud"``)."""
    masked: Any = np.ma.asarray(field.get_array())
    if isinstance(field, QuadMesh):
        whole, step = np.asarray(field.get_coordinates()), loss_map.FINER
        x, y = whole[0, ::step, 0], whole[::step, 0, 1]
        values = masked.filled(math.nan).reshape(whole.shape[:2])[::step, ::step]
    else:
        known = field._triangulation  # type: ignore[attr-defined]  # Matplotlib has no other access
        x, y = (np.linspace(one.min(), one.max(), GRID) for one in (known.x, known.y))
        points = np.column_stack([known.x, known.y])
        field_at = LinearNDInterpolator(points, masked.filled(math.nan), rescale=True)
        values = field_at(*np.meshgrid(x, y))
    steps, norm, cmap = np.linspace(0, 1, COLOUR_STEPS), field.norm, field.get_cmap()
    low, high = (float(np.asarray(end)) for end in (norm.vmin, norm.vmax))
    colours = cmap(norm(low + steps * (high - low)))
    bar = field.colorbar
    label = bar.ax.get_ylabel() if bar else ""
    return {
        "type": "heatmap",
        "x": _list(x),
        "y": _list(y),
        "z": [_list(row) for row in values],
        "zmin": low,
        "zmax": high,
        "zsmooth": "best",
        "hoverongaps": False,
        "colorscale": [
            [float(step), to_hex(one)] for step, one in zip(steps, colours, strict=True)
        ],
        "colorbar": {"title": {"text": _of_axis(label), "side": "right"}, "thickness": 14},
        "hovertemplate": f"{_hover(*labels, _of_axis(label))}<extra></extra>",
    }


def _levels(lines: ContourSet, field: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Lines of equal value on a field."""
    for level in np.asarray(lines.levels).tolist():
        yield {
            **{name: field[name] for name in "xyz"},
            "type": "contour",
            "showscale": False,
            "hoverinfo": "skip",
            "line": {"color": "white", "width": 1},
            "contours": {
                "start": level,
                "end": level,
                "size": 1,
                "coloring": "none",
                "showlabels": True,
                "labelfont": {"color": "white"},
            },
        }


def _list(values: Any) -> list[Any]:
    """Plain numbers of few digits, None for what is none; names as they are."""
    if (array := np.asarray(values)).dtype.kind == "U":
        return [*map(_escaped, array.tolist())]
    numbers = array.astype(float).ravel().tolist()
    return [float(f"{one:.{DIGITS}g}") if math.isfinite(one) else None for one in numbers]


def _escaped(text: str) -> str:
    """`text` as it is: plotly.js reads some tags."""
    return text.replace("&", "&amp;").replace("<", "&lt;")


# Figures of a page: still ones as SVG within the page, and their data to explore.

PAGE_PANEL = (4.3, 3.1)  # Width and height of a figure in a page. [inch]
_PROLOGUE = re.compile(r".*?(?=<svg)", re.DOTALL)
_METADATA = re.compile(r"\s*<metadata>.*?</metadata>", re.DOTALL)
_SIZE = re.compile(r' (?:width|height)="[^"]*"')
_COORDINATES = re.compile(r'(?<=\sd=")[^"]*')
_LONG_NUMBER = re.compile(r"(\.\d\d)\d+")  # What is more precise than a hundredth of a point.
_OWN_ID = re.compile(r'(?<=\sid=")|(?<=url\(#)|(?<=href="#)')


def draw(
    stored: Stored,
    name: str,
    size: tuple[float, float] | None = None,  # Default: that which suits. [mm]
    *,
    is_live: bool = False,  # Without still pictures of what can be explored.
) -> list[Drawing]:
    """Each panel of a plot as a figure of its own."""
    plot = PLOTS[name]
    suiting = plot.size if plot.is_wide else PAGE_PANEL
    point = ", ".join(filter(None, about(stored)))
    return [
        drawing(
            panel,
            f"{name}-{number + 1}",
            suiting if size is None else in_inches(size),
            projection=plot.projection,
            point=point,
            is_live=is_live,
        )
        for number, panel in enumerate(panels_of(stored, name))
    ]


def drawing(
    panel: Panel,
    key: str,
    size: tuple[float, float],  # [inch]
    *,
    projection: str | None = None,
    point: str = "",
    is_live: bool = False,
) -> Drawing:
    """A panel as a figure of its own; its title stands beside it."""
    with styled_figure(1, 1, "", panel=size, projection=projection) as (figure, axes):
        ax = panel.draw(axes[0, 0])
        title = ax.get_title(loc="left") or ax.get_title()
        caption = f"{title}, {panel.subject}" if panel.subject else title
        ax.set_title("", loc="left")
        ax.set_title("")
    plot = explorable(ax)
    return Drawing(key, caption, "" if is_live and plot else svg_text(figure, key), plot, point)


def svg_text(figure: Figure, key: str) -> str:
    """A figure as an ``svg`` element that fits any width, its ids beginning with `key`."""
    file = io.StringIO()
    with mpl.rc_context({**STYLE, "svg.hashsalt": key}):
        figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
    text = _METADATA.sub("", _PROLOGUE.sub("", file.getvalue(), count=1))
    text = _SIZE.sub("", text, count=2)  # those of the whole
    text = _COORDINATES.sub(lambda path: _LONG_NUMBER.sub(r"\1", path[0]), text)
    return _OWN_ID.sub(f"{key}-", text)
