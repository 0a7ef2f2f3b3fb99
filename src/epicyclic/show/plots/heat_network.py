"""The network of heat, and how a gearbox warms up."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.colors import Colormap
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

from epicyclic.dataclass import dataclass
from epicyclic.gears.gear import HOUSING
from epicyclic.machine.element import OIL
from epicyclic.result.result import HeatBalance, in_words
from epicyclic.show.plots.power_flow import INK, SLIDE, SOFT, Arrow, draw_box, fit
from epicyclic.show.plots.style import COLOURS, LINE_STYLES, styled_figure
from epicyclic.units import CELSIUS, format_number, unit_text

if TYPE_CHECKING:
    import xarray as xr

# The network of heat: parts in a row, shafts above, oil and housing as rails below, then outside.
#
# Every length is in inches on a slide of 16 to 9.

FLOW, PAPER = "#5b7fa6", "#ffffff"
HEAT_COLOURS = "YlOrRd"
DARKEST = 0.62  # Darkest shade of the colour scale on which words stay readable. [1]
LEFT, RIGHT = 0.15, SLIDE[0] - 0.15
SLOT, BROADEST = 1.45, 2.6  # Room for each path out of the oil; of a column at most.
BAY, ONLY_BAY = 1.2, 2.4
"""Room for the path from the oil to the housing; where that is the only one."""
SHAFTS, OUTSIDE = 6.1, 0.55  # Middles of the rows of shafts and of what is outside.
WITH_SHAFTS, WITHOUT = (4.5, 2.75, 1.65), (5.4, 3.3, 1.85)
"""Middles of the rows of parts, oil, and housing."""
TALL, FLAT = 0.58, 0.22  # Half the heights of a part, and of a rail.
NARROW = 1.2  # Width of a column up to which its words are small.
WIDEST, THINNEST = 0.5, 0.015  # Widths of arrows.
SMALLEST = 0.5  # Heat that is not drawn. [W]
SHAFT = "_shaft"  # Ends the names of shafts.
LETTER = 0.0082  # Mean width of a letter over its size. [inch/point]
_ARROW = Arrow(reach=(0.07, 0.8), length=(0.13, 0.6), share=0.45)
_fit = partial(fit, LETTER)


@dataclass(frozen=True, slots=True)
class _Flow:
    """Heat from one node to another."""

    start: str
    end: str
    watts: float

    @property
    def ends(self) -> tuple[str, str]:
        return self.start, self.end


@dataclass(frozen=True, slots=True)
class _Layout:
    """What is drawn where."""

    heat: HeatBalance
    flows: tuple[_Flow, ...]  # Between two nodes one, in its direction.
    columns: Mapping[str, float]  # x of each part.
    shafts: Mapping[str, tuple[str, ...]]  # Parts on each shaft.
    outlets: Mapping[str, float]  # x of what takes heat from the oil.
    edge: float  # Where the columns end at the right.
    rows: tuple[float, float, float]  # y of parts, oil, and housing.
    spacing: float  # Spacing of the columns.
    scale: float  # Width of an arrow over its heat. [inch/W]

    @property
    def width(self) -> float:
        """Half that of a part."""
        return (0.34 if self.spacing > NARROW else 0.4) * self.spacing

    @property
    def has_housing(self) -> bool:
        """True if heat leaves through the housing."""
        return HOUSING in self.heat.temperatures

    @property
    def shell(self) -> tuple[float, float]:
        """Ends of the housing."""
        return LEFT, RIGHT - SLOT * len(self.outlets) - (0.1 if self.outlets else 0.0)

    @property
    def letters(self) -> float:
        """Size of the font of all flows. [point]"""
        return 11.0 if self.spacing > NARROW else 8.5

    def broad(self, flow: _Flow) -> float:
        """Width of an arrow."""
        return max(THINNEST, flow.watts * self.scale)

    def temperature(self, node: str) -> float | None:
        """[degC]; None of what has none."""
        known = {**self.heat.temperatures, **self.heat.given}
        return CELSIUS.to_display(known[node]) if node in known else None

    def colour(self, node: str) -> tuple[float, ...] | str:
        """By the temperature."""
        value = self.temperature(node)
        if value is None:
            return PAPER
        low, high = self.limits()
        colours: Colormap = mpl.colormaps[HEAT_COLOURS]
        place = (value - low) / (high - low) if high > low else 0.0
        return colours(DARKEST * min(1.0, max(0.0, place)))

    def limits(self) -> tuple[float, float]:
        """The coldest and the hottest part. [degC]"""
        known = self.heat.temperatures.values()
        return CELSIUS.to_display(min(known)), CELSIUS.to_display(max(known))


def plot_heat_network(heat: HeatBalance, ax: Axes) -> Axes:
    """How warm every part is, and which heat flows from part to part and outside."""
    layout = _layout(heat)
    ax.set_axis_off()
    ax.set(xlim=(0, SLIDE[0]), ylim=(0, SLIDE[1]))
    whole = _power(sum(heat.sources.values()))
    oil = unit_text(f"{CELSIUS.to_display(heat.oil):.1f} {CELSIUS.display}")
    ax.set_title(f"Heat: oil in the gearbox {oil}, losses {whole}", fontsize=13, x=0.008)
    parts, rail, shell = layout.rows
    _rail(ax, layout, OIL, (LEFT, RIGHT), rail)
    if layout.has_housing:
        _rail(ax, layout, HOUSING, layout.shell, shell)
    for shaft, on in layout.shafts.items():
        across = [layout.columns[part] for part in on]
        ends = min(across) - layout.width, max(across) + layout.width
        _rail(ax, layout, shaft, ends, SHAFTS)
    for part, x in layout.columns.items():
        _box(ax, layout, part, (x, parts), (layout.width, TALL))
    for node, (x, y) in _outside(layout).items():
        _box(ax, layout, node, (x, y), (0.62, 0.36))
    for flow in layout.flows:
        _draw(ax, layout, flow)
    _legend(ax, layout)
    return ax


def _power(watts: float) -> str:
    large = abs(watts) >= 1e3
    return f"{format_number(watts / (1e3 if large else 1), 3)} {'kW' if large else 'W'}"


def _layout(heat: HeatBalance) -> _Layout:
    every = list(_all_flows(heat))
    flows = tuple(flow for flow in every if flow.watts >= SMALLEST)
    shafts: dict[str, tuple[str, ...]] = {
        node: tuple(other for flow in every if node in flow.ends for other in {*flow.ends} - {node})
        for node in heat.temperatures
        if node.endswith(SHAFT)
    }
    parts = [node for node in heat.temperatures if node not in (OIL, HOUSING, *shafts)]
    outlets = dict.fromkeys(path.into for path in heat.outlets if path.hot == OIL)
    slots = RIGHT - SLOT * len(outlets)
    bay = 0.0 if HOUSING not in heat.temperatures else BAY if outlets else ONLY_BAY
    edge, first = slots - bay, LEFT + 0.2
    spacing = min(BROADEST, (edge - first) / max(1, len(parts)))
    start = (first + edge - spacing * len(parts)) / 2
    most = max((flow.watts for flow in flows), default=0.0)
    return _Layout(
        heat=heat,
        flows=flows,
        columns={
            part: start + (place + 0.5) * spacing
            for place, part in enumerate(_ordered(parts, shafts, flows))
        },
        shafts=shafts,
        outlets={node: slots + (place + 0.5) * SLOT for place, node in enumerate(outlets)},
        edge=edge,
        rows=WITH_SHAFTS if shafts else WITHOUT,
        spacing=spacing,
        scale=min(WIDEST, 0.5 * spacing) / most if most else 0.0,
    )


def _all_flows(heat: HeatBalance) -> Iterator[_Flow]:
    """All paths between two nodes as one."""
    sums: dict[tuple[str, str], float] = {}
    for path in heat.ways:
        sums[path.hot, path.into] = sums.get((path.hot, path.into), 0.0) + path.watts
    for (hot, into), watts in sums.items():
        yield _Flow(hot, into, watts) if watts >= 0 else _Flow(into, hot, -watts)


def _ordered(
    parts: list[str], shafts: Mapping[str, tuple[str, ...]], flows: tuple[_Flow, ...]
) -> list[str]:
    """Parts on one shaft, and parts that pass heat to each other, side by side."""
    joined = {node for flow in flows if {*flow.ends} <= {*parts} for node in flow.ends}
    group = {part: part.rpartition(".")[0] for part in parts}
    group |= {part: shaft for shaft, on in shafts.items() for part in on}
    first = {name: place for place, name in reversed([*enumerate(group[part] for part in parts)])}
    on_shaft = {part for on in shafts.values() for part in on}
    return sorted(
        parts, key=lambda part: (first[group[part]], (part in joined) != (part in on_shaft))
    )


def _outside(layout: _Layout) -> dict[str, tuple[float, float]]:
    """Places of all that is not part of the gearbox."""
    places = {node: (x, OUTSIDE) for node, x in layout.outlets.items()}
    around = {path.into for path in layout.heat.outlets if path.hot == HOUSING}
    return places | dict.fromkeys(around, (sum(layout.shell) / 2, OUTSIDE - 0.1))


def _write(ax: Axes, x: float, y: float, text: str, size: float, **style: Any) -> None:
    ax.text(x, y, text, va="center", fontsize=size, color=INK, **style)


def _box(
    ax: Axes, layout: _Layout, node: str, middle: tuple[float, float], half: tuple[float, float]
) -> None:
    """A part with its name, temperature, and the heat of its losses."""
    (x, y), (width, height) = middle, half
    is_outside = node not in layout.heat.temperatures
    style = {"fc": layout.colour(node), "ls": "--" if is_outside else "-"}
    draw_box(ax, (x - width, y - height), (2 * width, 2 * height), **style)
    lines = list(_lines(layout, node))
    step = min(0.25, 2 * (height - 0.05) / len(lines))
    alike = layout.columns if node in layout.columns else (node,)
    for place, (text, size, weight) in enumerate(lines):
        size = min(
            _fit(other, 2 * width - 0.06, size)
            for each in alike
            for other, wanted, _ in _lines(layout, each)
            if wanted == size
        )
        at = y + (len(lines) / 2 - place - 0.5) * step
        _write(ax, x, at, text, size, ha="center", fontweight=weight, zorder=7)


def _lines(layout: _Layout, node: str) -> Iterator[tuple[str, float, str]]:
    """Texts of a box with their sizes and weights."""
    stage, _, name = node.rpartition(".")
    if stage:
        yield in_words(stage), 9, "normal"
    words = in_words(name).split(" ") if node in layout.columns else [in_words(name)]
    for word in words:
        yield word, 12.5, "bold"
    value = layout.temperature(node)
    if value is not None:
        yield f"{value:.1f} {unit_text(CELSIUS.display)}", 12, "normal"
    watts = layout.heat.sources.get(node, 0.0)
    if watts >= SMALLEST:
        yield f"+ {_power(watts)}", 9, "normal"


def _rail(ax: Axes, layout: _Layout, node: str, ends: tuple[float, float], y: float) -> None:
    """A node that many others meet, as a bar."""
    left, right = ends
    colour, sides = layout.colour(node), (right - left, 2 * FLAT)
    ax.add_patch(Rectangle((left, y - FLAT), *sides, fc=colour, ec=SOFT, lw=0.9, zorder=2))
    value = layout.temperature(node)
    watts = layout.heat.brought.get(node, 0.0)
    losses = f"   + {_power(watts)}" if watts >= SMALLEST else ""
    text = f"{in_words(node)}   {value:.1f} {unit_text(CELSIUS.display)}{losses}"
    # paths to the housing lead through the rail of the oil
    start = layout.edge if node == OIL and layout.has_housing else left
    size = _fit(text, right - start - 0.2, 12)
    _write(ax, start + 0.1, y, text, size, fontweight="bold", zorder=7)


def _draw(ax: Axes, layout: _Layout, flow: _Flow) -> None:
    """The arrow of a flow, by the rows of its ends."""
    nodes = {*flow.ends}
    part = next((node for node in flow.ends if node in layout.columns), None)
    shaft = next((node for node in flow.ends if node in layout.shafts), None)
    outlet = next((node for node in flow.ends if node in layout.outlets), None)
    parts, rail, shell = layout.rows
    if part is not None:
        x = layout.columns[part]
        if shaft is not None:
            _upright(ax, layout, flow, x, {part: parts + TALL, shaft: SHAFTS - FLAT})
        elif OIL in nodes:
            aside = 0.3 * layout.width if layout.has_housing else 0.0
            ends = {part: parts - TALL, OIL: rail + FLAT}
            _upright(ax, layout, flow, x - aside, ends, left=layout.has_housing)
        elif HOUSING in nodes:
            at = x + 0.4 * layout.width
            # a gap in the rail of the oil, through which heat reaches the housing
            half, low = layout.broad(flow) / 2 + 0.05, rail - FLAT - 0.02
            gap = Rectangle((at - half, low), 2 * half, 2 * FLAT + 0.04, color=PAPER, zorder=3)
            ax.add_patch(gap)
            ends = {part: parts - TALL, HOUSING: shell + FLAT}
            _upright(ax, layout, flow, at, ends, middle=(rail + shell) / 2)
        else:
            _across(ax, layout, flow)
    elif outlet is not None:
        x = layout.outlets[outlet]
        _upright(ax, layout, flow, x, {OIL: rail - FLAT, outlet: OUTSIDE + 0.36})
    elif OIL in nodes:
        x = layout.edge + 0.5
        _upright(ax, layout, flow, x, {OIL: rail - FLAT, HOUSING: shell + FLAT})
    else:
        air = next(node for node in flow.ends if node != HOUSING)
        x, y = _outside(layout)[air]
        _upright(ax, layout, flow, x, {HOUSING: shell - FLAT, air: y + 0.36})


def _upright(
    ax: Axes,
    layout: _Layout,
    flow: _Flow,
    x: float,
    ends: Mapping[str, float],
    *,
    left: bool = False,
    middle: float | None = None,
) -> None:
    """An upright arrow with its heat beside it, at the left or right, in a middle of its own."""
    start, tip = ends[flow.start], ends[flow.end]
    broad = layout.broad(flow)
    points = _ARROW.corners(start, tip, x, broad, upright=True)
    ax.add_patch(Polygon(points, closed=True, color=FLOW, lw=0, zorder=4))
    aside, side = (-1, "right") if left else (1, "left")
    at = x + aside * (broad / 2 + 0.06)
    y = max(start, tip) - 0.4 * abs(tip - start) if middle is None else middle
    _write(ax, at, y, _power(flow.watts), layout.letters, ha=side, zorder=6)


def _across(ax: Axes, layout: _Layout, flow: _Flow) -> None:
    """Heat between two parts: straight to a neighbour, else over those between."""
    start, end = layout.columns[flow.start], layout.columns[flow.end]
    sign = 1.0 if end > start else -1.0
    middle = layout.rows[0]
    broad = min(layout.broad(flow), TALL)
    if abs(end - start) < 1.5 * layout.spacing:
        ends = start + sign * layout.width, end - sign * layout.width
        shapes = [_ARROW.corners(*ends, middle, broad)]
        between, y = (start + end) / 2, middle + TALL + 0.1
    else:
        low, top = middle + TALL, middle + TALL + 0.25 + broad
        between = start + 0.5 * sign * layout.spacing
        start, end = start + 0.6 * sign * layout.width, end - 0.6 * sign * layout.width
        shapes = [
            _band((start - broad / 2, low), (start + broad / 2, top)),
            _band((start - sign * broad / 2, top - broad), (end, top)),
            _ARROW.corners(top, low, end, broad, upright=True),
        ]
        y = low + 0.12
    for corners in shapes:
        ax.add_patch(Polygon(corners, closed=True, color=FLOW, lw=0, zorder=4))
    _write(ax, between, y, _power(flow.watts), layout.letters, ha="center", zorder=6)


def _band(low: tuple[float, float], high: tuple[float, float]) -> list[tuple[float, float]]:
    """Corners of a rectangle."""
    return [low, (high[0], low[1]), high, (low[0], high[1])]


def _legend(ax: Axes, layout: _Layout) -> None:
    low, high = layout.limits()
    colours = mpl.colormaps[HEAT_COLOURS]
    unit = unit_text(CELSIUS.display)
    y = 7.2
    steps = 24
    for step in range(steps):
        corner, colour = (0.75 + 0.06 * step, y - 0.09), colours(DARKEST * step / (steps - 1))
        ax.add_patch(Rectangle(corner, 0.065, 0.18, color=colour, lw=0))
    write = partial(ax.text, y=y, va="center", fontsize=10, color=SOFT)
    write(x=0.68, s=f"{low:.0f}", ha="right")
    write(x=0.82 + 0.06 * steps, s=f"{high:.0f} {unit}")
    write(
        x=3.4,
        s="arrows: heat flow, width by power;  + W: heat of losses;  dashed: surroundings at "
        "given temperature",
    )


_MINUTE, _HOUR = 60.0, 3600.0
_PANEL = (7.0, 3.2)
_MOST_NODES = 7
"""With a line of their own; those whose temperature goes furthest from the others come first."""


def warm_up_figure(data: xr.Dataset) -> Figure:
    """Temperatures of the parts over the total power loss, over time."""
    seconds = data["time"].values
    size, unit = (_HOUR, "h") if seconds[-1] > 2 * _HOUR else (_MINUTE, "min")
    times = seconds / size
    with styled_figure(2, 1, data.attrs["title"], panel=_PANEL) as (figure, axes):
        above, below = axes[0, 0], axes[1, 0]
        for number, node in enumerate(_shown(data)):
            above.plot(
                times,
                data["temperature"].sel(node=node).values,
                label=in_words(node),
                color=COLOURS[number % len(COLOURS)],
                linestyle=LINE_STYLES[number % len(LINE_STYLES)],
            )
        above.set(title="Temperatures", ylabel="temperature, °C", xlim=(0, times[-1]))
        above.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize="small")
        below.plot(times, data["total_loss"].values, color=COLOURS[6])
        below.set(title="Loss", ylabel="power loss, W", xlabel=f"time, {unit}")
        below.set(xlim=(0, times[-1]), ylim=(0, None))
    return figure


def _shown(data: xr.Dataset) -> list[str]:
    """The nodes to draw, the hottest at the end first; of many the hottest, oil and housing."""
    last = data["temperature"].isel(time=-1)
    nodes = [str(node) for node in last.sortby(-last)["node"].values]
    if len(nodes) <= _MOST_NODES:
        return nodes
    kept = [node for node in ("oil", "housing") if node in nodes]
    others = [node for node in nodes if node not in kept]
    return [*others[: _MOST_NODES - len(kept)], *kept]
