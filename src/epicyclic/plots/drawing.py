"""Drawings to scale: the gear set in the transverse plane, and the teeth of a mesh in contact."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from epicyclic.plots.style import COLOURS, legend_below
from epicyclic.results.result import in_words

Floats = NDArray[np.float64]

FILLS = {
    "sun": ("#F6D58A", "#E3B24C", "#FBEBC8", "#C08F2F"),
    "planet": ("#BFD9EA", "#8DB7D5", "#DFECF5", "#6496BB"),
    "ring": ("0.85", "0.7", "0.93"),
}
"""Shades of gears that stand alone, several times, and around others."""
CIRCLE_POINTS = 181
SHOWN_MODULES = 5.0
"""Half the width of a drawing of teeth. [transverse modules]"""
SKIPPED_POINTS = 4
"""A whole gear is drawn with one point of so many: the others are too near to be seen."""
HEIGHT_SHARE = 0.5
"""Height of a drawing of teeth over its width, at least. [1]"""
MARGIN = 1.04


def plot_gear_set(
    gears: Mapping[str, xr.Dataset],  # As `epicyclic.analysis.shapes.gear_shapes` returns them.
    ax: Axes,
) -> Axes:
    """All gears at their places, to scale, seen along the axis."""
    low, high = np.full(2, math.inf), np.full(2, -math.inf)
    fills = _fills(gears)
    order = sorted(gears.items(), key=_is_behind)
    for row, (name, gear) in enumerate(order):
        label = f"{in_words(name)}, {int(gear.attrs['teeth'])} teeth"
        if hider := next((one for one, front in order[row + 1 :] if _hides(front, gear)), ""):
            label += f", behind {in_words(hider)}"
        outline = _whole_outline(gear, SKIPPED_POINTS)
        inside = bool(gear.attrs["internal"])
        for number in range(gear.sizes["place"]):
            center, turn = _place(gear, number)
            shape = _path(outline @ _rotation(turn) + center)
            if inside:
                rim = _circle(_scalar(gear, "outside_diameter") / 2) + center
                shape = Path.make_compound_path(_path(rim[::-1]), shape)
            ax.add_patch(
                PathPatch(
                    shape,
                    facecolor=fills[name],
                    edgecolor="black",
                    linewidth=0.5,
                    label=label if number == 0 else None,
                    gid=layer_of(name, number),
                )
            )
            ax.plot(*center, marker="+", color="black", ms=5, mew=0.6)
            radius = _scalar(gear, "outside_diameter") / 2
            low, high = np.minimum(low, center - radius), np.maximum(high, center + radius)
    _frame(ax, (low + high) / 2, MARGIN * (high - low) / 2)
    ax.set_adjustable("box")
    ax.set_anchor("N")
    legend_below(ax, ncols=3)
    ax.set_title("Gear pair to scale" if "pinion" in gears else "Gear set to scale")
    return ax


def plot_teeth(view: xr.Dataset, gears: Mapping[str, xr.Dataset], ax: Axes) -> Axes:
    """Teeth of a mesh touching at the pitch point, with line of action and path of contact."""
    names = [str(name) for name in view["gear"].values]
    module = max(
        _scalar(gears[name], "reference_diameter") / gears[name].attrs["teeth"] for name in names
    )
    half = SHOWN_MODULES * module
    fills = _fills(gears)
    for number, name in enumerate(names):
        gear, center = gears[name], np.array([view["center_x"][number], view["center_y"][number]])
        turn = math.radians(float(view["direction"][number])) - math.pi / 2
        ax.add_patch(
            PathPatch(
                _path(_some_teeth(gear, turn, half) + center),
                facecolor=fills[name],
                edgecolor="black",
                linewidth=0.8,
                label=in_words(name),
                gid=layer_of(name, 0),
            )
        )
        pitch = _circle(float(view["operating_radius"][number])) + center
        base = _circle(_scalar(gear, "base_diameter") / 2) + center
        label = number == 0
        ax.plot(*pitch.T, color="0.35", lw=0.8, ls="-.", label="operating pitch circles" * label)
        ax.plot(*base.T, color="0.35", lw=0.8, ls=":", label="base circles" * label)
    slope = math.tan(math.radians(float(view["pressure_angle"])))
    ax.axline((0.0, 0.0), slope=slope, color=COLOURS[0], lw=1.0, ls="--", label="line of action")
    ax.plot(view["path_x"], view["path_y"], color=COLOURS[1], lw=2.4, label="path of contact")
    ax.plot(0.0, 0.0, marker="o", color="black", ms=4, ls="", label="pitch point")
    _frame(ax, np.zeros(2), np.array([half, half * HEIGHT_SHARE]))
    legend_below(ax, ncols=3)
    ax.set_title("Teeth in contact")
    return ax


def layer_of(name: str, number: int) -> str:
    """What the layer of a gear is called in a picture, at one of its places."""
    return f"gear-{name}-{number}"


def _is_behind(item: tuple[str, xr.Dataset]) -> tuple[bool, float]:
    """Sorts gears from the last to the first that is seen: smaller ones stand before larger."""
    _, gear = item
    return not gear.attrs["internal"], -_scalar(gear, "tip_diameter")


def _hides(front: xr.Dataset, gear: xr.Dataset) -> bool:
    """True if a gear in front of another one leaves at most the teeth of this to be seen."""
    seen = _scalar(gear, "tip_diameter") - _scalar(front, "tip_diameter")
    height = _scalar(gear, "tip_diameter") - _scalar(gear, "root_diameter")
    return not gear.attrs["internal"] and seen < height and _centers(front) == _centers(gear)


def _fills(gears: Mapping[str, xr.Dataset]) -> dict[str, str]:
    """Colour of each gear: one for each kind, in several shades."""
    kinds: dict[str, list[str]] = {}
    for name, gear in gears.items():
        alone = "planet" if gear.sizes["place"] > 1 else "sun"
        around = gear.attrs["internal"] or name == "gear"
        kinds.setdefault("ring" if around else alone, []).append(name)
    return {
        name: shade
        for kind, names in kinds.items()
        for name, shade in zip(names, itertools.cycle(FILLS[kind]), strict=False)
    }


def _frame(ax: Axes, middle: Floats, half: Floats) -> None:
    """Millimetres of equal length on both axes; the wider side shows more."""
    ax.set(xlabel="x, mm", ylabel="y, mm")
    ax.set_xlim(middle[0] - half[0], middle[0] + half[0], auto=True)
    ax.set_ylim(middle[1] - half[1], middle[1] + half[1], auto=True)
    ax.set_aspect("equal", adjustable="datalim")
    ax.grid(visible=False)


def _scalar(gear: xr.Dataset, name: str) -> float:
    return float(gear[name])


def _centers(gear: xr.Dataset) -> list[list[float]]:
    centers: list[list[float]] = np.column_stack([gear["center_x"], gear["center_y"]]).tolist()
    return centers


def _place(gear: xr.Dataset, number: int) -> tuple[Floats, float]:
    """Centre of a gear, and by how much it is turned from a tooth that points along y. [rad]"""
    center = np.array([gear["center_x"][number], gear["center_y"][number]])
    return center, math.radians(float(gear["direction"][number])) - math.pi / 2


def _rotation(angle: float) -> Floats:
    """For points in rows."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, sine], [-sine, cosine]])


def _circle(radius: float) -> Floats:
    angle = np.linspace(0, 2 * math.pi, CIRCLE_POINTS)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def _path(points: Floats) -> Path:
    return Path(points, closed=False)


def _whole_outline(gear: xr.Dataset, step: int) -> Floats:
    """All teeth, of their points every `step`-th, or the tip circle if there is no outline."""
    if "x" not in gear:
        return _circle(_scalar(gear, "tip_diameter") / 2)
    thinned = gear.isel(point=slice(None, None, step))
    return _teeth(thinned, range(int(gear.attrs["teeth"])))


def _teeth(gear: xr.Dataset, numbers: range) -> Floats:
    """Outline of some teeth side by side; tooth 0 points along y."""
    tooth = np.column_stack([gear["x"], gear["y"]])
    pitch = 2 * math.pi / int(gear.attrs["teeth"])
    return np.concatenate([tooth @ _rotation(number * pitch) for number in numbers])


def _some_teeth(gear: xr.Dataset, turn: float, half: float) -> Floats:
    """The teeth within `half` of the origin, closed to a solid, turned by `turn`."""
    if "x" not in gear:
        return _circle(_scalar(gear, "tip_diameter") / 2)
    count = int(gear.attrs["teeth"])
    radius = _scalar(gear, "reference_diameter") / 2
    side = min(count // 2, math.ceil(2 * half / (2 * math.pi * radius / count)))
    outline = _teeth(gear, range(-side, side + 1))
    if gear.attrs["internal"]:
        first, last = np.arctan2(outline[[0, -1], 1], outline[[0, -1], 0]).tolist()
        angle = np.linspace(last, first, CIRCLE_POINTS)
        outside = _scalar(gear, "outside_diameter") / 2
        back = outside * np.column_stack([np.cos(angle), np.sin(angle)])
    else:
        back = np.zeros((1, 2))
    return np.concatenate([outline, back, outline[:1]]) @ _rotation(turn)
