"""The arrangement of a train, to scale: its sets on their shafts, from two sides."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.patches import Rectangle

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass
from epicyclic.gears.gear import HOUSING
from epicyclic.result.result import in_words
from epicyclic.show.plots.drawing import fills_of, plot_gear_set, points_of
from epicyclic.show.plots.style import AROUND, PANEL, SMALL_CHARACTERS
from epicyclic.units import MILLIMETRE

SHAFT = 9.0  # Diameter of a shaft of which no bearing is known. [mm]
GAP = 0.15  # Between sets whose places are not given, over the width of the gears. [1]
FLAT = 0.3  # Width of a bearing of which it is not given, over the height of its section. [1]
ENDS = 0.06  # Length of a shaft beyond what is on it, over that of the train. [1]


@dataclass(frozen=True, slots=True)
class Arrangement:
    """Where the shafts and sets of a train are. Lengths in mm."""

    gears: Mapping[str, xr.Dataset]  # All gears about the axis of the input.
    axes: Mapping[str, FloatArray]  # Axis of each shaft, seen along them.
    middles: Mapping[str, float]  # Place of each set along the axes.
    starts: Mapping[str, float]  # Place along the axes from which those on a shaft are counted.
    widths: Mapping[str, float]  # Of the faces of the gears.
    widest: Mapping[str, float]  # Of the widest gear of each set.
    assumed: tuple[str, ...]  # Sets whose places along the axes are not given.


def arrangement_of(
    inputs: Mapping[str, Any], gears: Mapping[str, xr.Dataset]
) -> Arrangement | None:
    """The arrangement of a train; None if the dimensions of a set are not known."""
    shafts = {name: list(members) for name, members in inputs.get("shafts", {}).items()}
    sets = {name.partition(".")[0] for name in gears}
    if not sets or sets != set(inputs["sets"]):
        return None
    on = {member: shaft for shaft, members in shafts.items() for member in members}
    centers = _centers(inputs, gears, on)
    origins: dict[str, FloatArray] = {}
    axes = {inputs["operation"]["input"]: np.zeros(2)}
    while grown := list(_next_to(axes, origins, centers, on)):
        for name, shaft, place in grown:
            (axes if shaft else origins).setdefault(shaft or name, place)
    if sets - origins.keys():
        return None
    widths = {name: _millimetres(_table(inputs, name)["face_width"]) for name in gears}
    widest: dict[str, float] = {}
    for name, width in widths.items():
        own = name.partition(".")[0]
        widest[own] = max(width, widest.get(own, 0.0))
    middles, starts, assumed = _along(inputs, on, widest)
    moved = {
        name: gear.assign(
            center_x=gear["center_x"] + origins[own][0], center_y=gear["center_y"] + origins[own][1]
        )
        for name, gear in gears.items()
        for own in (name.partition(".")[0],)
    }
    return Arrangement(moved, axes, middles, starts, widths, widest, assumed)


def _table(inputs: Mapping[str, Any], gear: str) -> Mapping[str, Any]:
    name, _, own = gear.partition(".")
    table = inputs["sets"][name]
    found: Mapping[str, Any] = table.get(own) or table["gears"][own]
    return found


def _centers(
    inputs: Mapping[str, Any], gears: Mapping[str, xr.Dataset], on: Mapping[str, str]
) -> dict[str, FloatArray]:
    """Axis of each member of a set, by its name on shafts, about the origin of the set."""
    found = {member: np.zeros(2) for member in on}
    for name, gear in gears.items():
        body = _table(inputs, name).get("body") or name.partition(".")[2]
        member = f"{name.partition('.')[0]}.{body}"
        if gear.sizes["place"] == 1:
            found[member] = points_of(gear, "center")[0]
    return found


def _next_to(
    axes: Mapping[str, FloatArray],
    origins: Mapping[str, FloatArray],
    centers: Mapping[str, FloatArray],
    on: Mapping[str, str],
) -> Iterator[tuple[str, str, FloatArray]]:
    """Sets, and shafts, whose places follow from what is known."""
    for member, shaft in on.items():
        name = member.partition(".")[0]
        if shaft in axes and name not in origins:
            yield name, "", axes[shaft] - centers[member]
        elif name in origins and shaft not in axes:
            yield name, shaft, origins[name] + centers[member]


def _along(
    inputs: Mapping[str, Any], on: Mapping[str, str], widest: Mapping[str, float]
) -> tuple[dict[str, float], dict[str, float], tuple[str, ...]]:
    """Places of sets and shafts along the axes; the sets for which none is given, side by side."""
    given = {
        member: _millimetres(text)
        for member, text in inputs.get("positions", {}).items()
        if member in on
    }
    middles: dict[str, float] = {}
    starts: dict[str, float] = {}
    assumed: list[str] = []
    while left := [name for name in inputs["sets"] if name not in middles]:
        known = len(middles)
        for member, place in given.items():
            name, shaft = member.partition(".")[0], on[member]
            if not starts and not middles:
                starts[shaft] = 0.0
            if shaft in starts:
                middles.setdefault(name, starts[shaft] + place)
            elif name in middles:
                starts[shaft] = middles[name] - place
        if len(middles) == known:
            name, width = left[0], widest[left[0]]
            ends = [middle + widest[own] / 2 for own, middle in middles.items()]
            middles[name] = max(ends, default=-width / 2) + GAP * width + width / 2
            assumed.append(name)
    for member, place in given.items():
        starts.setdefault(on[member], middles[member.partition(".")[0]] - place)
    return middles, starts, tuple(assumed)


def plot_from_the_end(found: Arrangement, ax: Axes) -> Axes:
    """All gears at their places, seen along the axes."""
    plot_gear_set(found.gears, ax, hidden=False)
    ax.set_title("Arrangement, seen along the shafts")
    return ax


def plot_from_the_side(found: Arrangement, inputs: Mapping[str, Any], ax: Axes) -> Axes:
    """Gears, shafts and bearings at their places along the axes, seen across the widest side."""
    places = np.array(list(found.axes.values()))
    _, sizes, sides = np.linalg.svd(places - places.mean(axis=0))
    up = sides[0] if sizes[0] else np.array([0.0, 1.0])
    up = up * math.copysign(1.0, up[np.abs(up).argmax()])
    heights = {shaft: float(place @ up) for shaft, place in found.axes.items()}
    spans: dict[str, list[float]] = {}
    colours = fills_of(found.gears)
    for name, gear in sorted(found.gears.items(), key=lambda it: -float(it[1]["tip_diameter"])):
        middle, width = found.middles[name.partition(".")[0]], found.widths[name]
        tip, outside = float(gear["tip_diameter"]) / 2, float(gear["outside_diameter"]) / 2
        ends = ((-outside, -tip), (tip, outside)) if gear.attrs["internal"] else ((-tip, tip),)
        for height in (points_of(gear, "center") @ up).tolist():
            for low, high in ends:
                _rectangle(ax, (middle, height), (width, low, high), facecolor=colours[name])
    for shaft, members in inputs["shafts"].items():
        sets = {member.partition(".")[0] for member in members} & found.middles.keys()
        spans[shaft] = [
            found.middles[name] + sign * found.widest[name] / 2 for name in sets for sign in (-1, 1)
        ]
    bores: dict[str, float] = {}
    for table in inputs.get("bearings", {}).values():
        shaft = table["shaft"]
        if "position" not in table or shaft not in found.starts or shaft not in heights:
            continue
        middle = found.starts[shaft] + _millimetres(table["position"])
        bore, outer = (_millimetres(table[key]) / 2 for key in ("bore", "outside_diameter"))
        given = table.get("width")
        width = _millimetres(given) if given else 2 * FLAT * (outer - bore)
        for low, high in ((-outer, -bore), (bore, outer)):
            place = middle, heights[shaft]
            _rectangle(ax, place, (width, low, high), facecolor="white", hatch="xxxx", zorder=3)
        spans[shaft] += [middle - width / 2, middle + width / 2]
        bores[shaft] = min(2 * bore, bores.get(shaft, math.inf))
    ends_of_all = [end for own in spans.values() for end in own]
    length = max(ends_of_all) - min(ends_of_all)
    spans = {it: own for it, own in spans.items() if it in heights and own and it != HOUSING}
    for shaft, own in spans.items():
        low, high = min(own) - ENDS * length, max(own) + ENDS * length
        radius = bores.get(shaft, SHAFT) / 2
        style: dict[str, Any] = {"facecolor": "0.75", "zorder": 0.5}
        _rectangle(ax, ((low + high) / 2, heights[shaft]), (high - low, -radius, radius), **style)
        ax.plot((low, high), [heights[shaft]] * 2, color="black", lw=0.6, ls="-.")
    names = _write_names(ax, spans, heights, ENDS * length)
    ax.set_aspect("equal")
    ax.autoscale_view()
    ax.margins(0.05)
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    inch = max((right - left) / PANEL[0], (high - low) / (PANEL[1] - 2 * AROUND))
    room = [place + letters * inch / SMALL_CHARACTERS for place, letters in names]
    ax.set_xlim(min([left, *room]), max([right, *room]))
    ax.grid(visible=False)
    told = f"\n(position not given: {', '.join(map(in_words, found.assumed))})"
    ax.set(
        title="Arrangement, seen from the side",
        xlabel=f"along the shafts, mm{told if found.assumed else ''}",
        ylabel="across the shafts, mm",
    )
    return ax


def _millimetres(text: str) -> float:
    return MILLIMETRE.to_display(MILLIMETRE.parse(text))


def _rectangle(
    ax: Axes, place: tuple[float, float], size: tuple[float, float, float], **style: Any
) -> None:
    """Something about a place on an axis: its width, and its ends across the axis."""
    width, low, high = size
    corner = place[0] - width / 2, place[1] + low
    ax.add_patch(Rectangle(corner, width, high - low, edgecolor="black", linewidth=0.6, **style))


def _write_names(
    ax: Axes, spans: Mapping[str, list[float]], heights: Mapping[str, float], gap: float
) -> list[tuple[float, int]]:
    """Names at the ends of the shafts; of those on one axis left and right in turn.

    Returns where each begins, and its letters, negative towards the left.
    """
    taken: dict[float, int] = {}
    ends = []
    for shaft, own in spans.items():
        height = round(heights[shaft], 3)
        is_left = taken.get(height, 0) % 2 == 0
        taken[height] = taken.get(height, 0) + 1
        place = min(own) - 1.5 * gap if is_left else max(own) + 1.5 * gap
        side = "right" if is_left else "left"
        text = ax.text(place, height, in_words(shaft), ha=side, va="center", fontsize="small")
        text.set_bbox({"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5})
        letters = len(shaft) + 2  # with a gap to the axis
        ends.append((place, -letters if is_left else letters))
    return ends
