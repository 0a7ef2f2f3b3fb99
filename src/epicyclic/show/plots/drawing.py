"""Drawings to scale of gear sets and meshes, still or turning."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass, replace
from epicyclic.result.result import in_words
from epicyclic.show.plots.mesh import scale_of
from epicyclic.show.plots.style import (
    COLOUR_MAP,
    COLOURS,
    label_of,
    labelled,
    legend_below,
    styled_figure,
)

FILLS = {
    "sun": ("#F6D58A", "#E3B24C", "#FBEBC8", "#C08F2F"),
    "planet": ("#BFD9EA", "#8DB7D5", "#DFECF5", "#6496BB"),
    "ring": ("0.85", "0.7", "0.93"),
}
"""Shades of gears that stand alone, several times, and around others."""
CIRCLE_POINTS = 181
SHOWN_MODULES = 5.0  # Half the width of a drawing of teeth. [transverse modules]
SKIPPED_POINTS = 4
"""A whole gear is drawn with one point of so many: the others are too near to be seen."""
HEIGHT_SHARE = 0.5  # Height of a drawing of teeth over its width, at least. [1]
MARGIN = 1.04
OIL_COLOUR, OIL_EDGE = (0.85, 0.65, 0.13, 0.35), "#8A6A10"
SAME_LEVEL = 3  # Digits of a millimetre to which levels are the same.


def plot_gear_set(
    gears: Mapping[str, xr.Dataset],  # As `epicyclic.study.shapes.gear_shapes` returns them.
    ax: Axes,
    *,
    hidden: bool = True,  # Whether to name the gears behind which others are hidden.
) -> Axes:
    """All gears at their places, to scale, seen along the axis."""
    low, high = np.full(2, math.inf), np.full(2, -math.inf)
    fills = fills_of(gears)
    order = sorted(gears.items(), key=_is_behind)
    for row, (name, gear) in enumerate(order):
        label = f"{in_words(name)}, {int(gear.attrs['teeth'])} teeth"
        front = order[row + 1 :] if hidden else ()
        if hider := next((one for one, it in front if _hides(it, gear)), ""):
            label += f", behind {in_words(hider)}"
        outline, radius = _whole_outline(gear), float(gear["outside_diameter"]) / 2
        for number in range(gear.sizes["place"]):
            center, turn = _place(gear, number)
            shape = Path(outline @ _rotation(turn) + center)
            if gear.attrs["internal"]:
                rim = _circle(radius) + center
                shape = Path.make_compound_path(Path(rim[::-1]), shape)
            style = {"fc": fills[name], "ec": "black", "lw": 0.5, "gid": layer_of(name, number)}
            ax.add_patch(PathPatch(shape, label=label if number == 0 else None, **style))
            ax.plot(*center, marker="+", color="black", ms=5, mew=0.6)
            low, high = np.minimum(low, center - radius), np.maximum(high, center + radius)
    title = "Gear pair to scale" if "pinion" in gears else "Gear set to scale"
    return _finish(ax, low, high, title)


def plot_teeth(view: xr.Dataset, gears: Mapping[str, xr.Dataset], ax: Axes) -> Axes:
    """Teeth of a mesh touching at the pitch point, with line of action and path of contact."""
    names = [str(name) for name in view["gear"].values]
    module = max(
        float(gears[name]["reference_diameter"]) / gears[name].attrs["teeth"] for name in names
    )
    half = SHOWN_MODULES * module
    fills = fills_of(gears)
    for number, name in enumerate(names):
        gear, (center, turn) = gears[name], _place(view, number)
        shape = Path(_some_teeth(gear, turn, half) + center)
        style = {"fc": fills[name], "ec": "black", "lw": 0.8, "gid": layer_of(name, 0)}
        ax.add_patch(PathPatch(shape, label=in_words(name), **style))
        pitch = _circle(float(view["operating_radius"][number])) + center
        base = _circle(float(gear["base_diameter"]) / 2) + center
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


def plot_oil(gears: Mapping[str, xr.Dataset], ax: Axes) -> Axes:
    """Tip circles of all gears in the housing, to scale, in the oil at rest."""
    fills = fills_of(gears)
    low, high = np.full(2, math.inf), np.full(2, -math.inf)
    levels: dict[str, float] = {}
    for name, gear in sorted(gears.items(), key=_is_behind):
        radius = float(gear["outside_diameter"]) / 2
        for number, stand in enumerate(points_of(gear, "stands")):
            shape = Path(_circle(radius) + stand)
            if gear.attrs["internal"]:
                inside = _circle(float(gear["tip_diameter"]) / 2)[::-1] + stand
                shape = Path.make_compound_path(shape, Path(inside))
            label = in_words(name) if number == 0 else None
            ax.add_patch(PathPatch(shape, facecolor=fills[name], edgecolor="black", label=label))
            low, high = np.minimum(low, stand - radius), np.maximum(high, stand + radius)
            if "oil_depth" in gear and float(gear["oil_depth"]) > 0:
                levels[name] = float(stand[1]) - radius + float(gear["oil_depth"])
    pools = []
    for name, level in levels.items():
        radius = float(gears[name]["outside_diameter"]) / 2
        x, y = points_of(gears[name], "stands")[0]
        pools.append((x - radius, x + radius, y - radius, level))
    # one level for all, unless depths were stated gear by gear
    if len({round(level, SAME_LEVEL) for level in levels.values()}) == 1:
        pools = [(low[0], high[0], low[1], pools[0][-1])]
    for number, (left, right, base, level) in enumerate(pools):
        label = "oil at rest" if number == 0 else None
        box = Rectangle((left, base), right - left, level - base, label=label, color=OIL_COLOUR)
        ax.add_patch(box)
        ax.plot([left, right], [level, level], color=OIL_EDGE, lw=1.2)
    return _finish(ax, low, high, "Gears in the oil")


def layer_of(name: str, number: int) -> str:
    """What the layer of a gear is called in a picture, at one of its places."""
    return f"gear-{name}-{number}"


def _is_behind(item: tuple[str, xr.Dataset]) -> tuple[bool, float]:
    """Sorts gears from the last to the first that is seen: smaller ones stand before larger."""
    _, gear = item
    return not gear.attrs["internal"], -float(gear["tip_diameter"])


def _hides(front: xr.Dataset, gear: xr.Dataset) -> bool:
    """True if a gear in front of another one leaves at most the teeth of this to be seen."""
    seen = float(gear["tip_diameter"]) - float(front["tip_diameter"])
    height = float(gear["tip_diameter"]) - float(gear["root_diameter"])
    behind = np.array_equal(points_of(front, "center"), points_of(gear, "center"))
    return not gear.attrs["internal"] and seen < height and behind


def fills_of(gears: Mapping[str, xr.Dataset]) -> dict[str, str]:
    """Colour of each gear: one for each kind, in several shades."""
    kinds: dict[str, list[str]] = {}
    for name, gear in gears.items():
        alone = "planet" if gear.sizes["place"] > 1 else "sun"
        around = gear.attrs["internal"] or gear.attrs["name"] == "gear"
        kinds.setdefault("ring" if around else alone, []).append(name)
    return {
        name: shade
        for kind, names in kinds.items()
        for name, shade in zip(names, itertools.cycle(FILLS[kind]), strict=False)
    }


def _finish(ax: Axes, low: FloatArray, high: FloatArray, title: str) -> Axes:
    """Whole gears between two corners, and their legend."""
    _frame(ax, (low + high) / 2, MARGIN * (high - low) / 2)
    ax.set(adjustable="box", anchor="N", title=title)
    legend_below(ax, ncols=3)
    return ax


def _frame(ax: Axes, middle: FloatArray, half: FloatArray) -> None:
    """Millimetres of equal length on both axes; the wider side shows more."""
    ax.set(xlabel="x, mm", ylabel="y, mm")
    ax.set_xlim(middle[0] - half[0], middle[0] + half[0], auto=True)
    ax.set_ylim(middle[1] - half[1], middle[1] + half[1], auto=True)
    ax.set_aspect("equal", adjustable="datalim")
    ax.grid(visible=False)


def points_of(gear: xr.Dataset, what: str) -> FloatArray:
    """Points in rows: ``"center"`` of each place, ``"stands"`` in the housing. [mm]"""
    return np.column_stack([gear[f"{what}_x"], gear[f"{what}_y"]])


def _place(gear: xr.Dataset, number: int) -> tuple[FloatArray, float]:
    """Centre of a gear, and by how much it is turned from a tooth that points along y. [rad]"""
    center = np.array([gear["center_x"][number], gear["center_y"][number]])
    return center, math.radians(float(gear["direction"][number])) - math.pi / 2


def _rotation(angle: float) -> FloatArray:
    """For points in rows."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, sine], [-sine, cosine]])


def _circle(radius: float, first: float = 0.0, last: float = 2 * math.pi) -> FloatArray:
    angle = np.linspace(first, last, CIRCLE_POINTS)
    return radius * np.column_stack([np.cos(angle), np.sin(angle)])


def _whole_outline(gear: xr.Dataset) -> FloatArray:
    """All teeth, of their points one of `SKIPPED_POINTS`; without an outline the tip circle."""
    if "x" not in gear:
        return _circle(float(gear["tip_diameter"]) / 2)
    thinned = gear.isel(point=slice(None, None, SKIPPED_POINTS))
    return _teeth(thinned, range(int(gear.attrs["teeth"])))


def _teeth(gear: xr.Dataset, numbers: range) -> FloatArray:
    """Outline of some teeth side by side; tooth 0 points along y."""
    tooth = np.column_stack([gear["x"], gear["y"]])
    pitch = 2 * math.pi / int(gear.attrs["teeth"])
    return np.concatenate([tooth @ _rotation(number * pitch) for number in numbers])


def _some_teeth(gear: xr.Dataset, turn: float, half: float) -> FloatArray:
    """The teeth within `half` of the origin, closed to a solid, turned by `turn`."""
    if "x" not in gear:
        return _circle(float(gear["tip_diameter"]) / 2)
    count = int(gear.attrs["teeth"])
    radius = float(gear["reference_diameter"]) / 2
    side = min(count // 2, math.ceil(2 * half / (2 * math.pi * radius / count)))
    outline = _teeth(gear, range(-side, side + 1))
    if gear.attrs["internal"]:
        first, last = np.arctan2(outline[[0, -1], 1], outline[[0, -1], 0]).tolist()
        back = _circle(float(gear["outside_diameter"]) / 2, last, first)
    else:
        back = np.zeros((1, 2))
    return np.concatenate([outline, back, outline[:1]]) @ _rotation(turn)


# Gears that turn: drawings in which each gear, and each position of a mesh, is a layer of its own.
#
# A page turns the layers of the gears and shows one position after the other; a file has one of
# them.

POSITION = "position"
"""Layers of a mesh position are called so, with its number and that of their Axes."""
POINTS_PER_INCH = 72
SET_SIZE, MESH_SIZE = (6.2, 5.6), (8.8, 4.2)  # Width and height of the drawings. [inch]
LARGEST_DOT = 260.0  # Area of the contact of a tooth pair that carries all. [point^2]
LINE_WIDTH = 4.0


@dataclass(frozen=True, slots=True)
class Layer:
    """A gear that turns on paper."""

    name: str  # Name of its layer in a picture.
    x: float  # Its centre, from the left of the picture. [point]
    y: float  # From its top. [point]
    # How far it is turned against the clock at phase 0 from how it is drawn, and for each mesh
    # period. [deg]
    start: float
    rate: float


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """A drawing with what turns in it."""

    figure: Figure
    ax: Axes  # On which the gears are.
    gears: list[Layer]  # With centres in the coordinates of `ax`.
    phases: tuple[float, ...]  # Phases of the positions that are layers, in mesh periods.

    def layers(self) -> list[Layer]:
        """The gears where they are on the picture, once that has been written."""
        height = self.figure.get_figheight()
        found = []
        for gear in self.gears:
            place = self.ax.transData.transform((gear.x, gear.y))
            across, up = (place / self.figure.dpi).tolist()
            x, y = POINTS_PER_INCH * across, POINTS_PER_INCH * (height - up)
            found.append(replace(gear, x=x, y=y))
        return found


def turning_set(
    # Gears of one set, as `epicyclic.study.shapes.gear_shapes` returns them.
    gears: Mapping[str, xr.Dataset],
    title: str,
    caption: str,
    phase: float = 0.0,  # At which it is drawn. [mesh periods of the first gear]
) -> Turning:
    """A set seen along its axis, from its carrier."""
    period = 360.0 / int(next(iter(gears.values())).attrs["teeth"])  # [deg]
    turns = {name: period * float(gear.attrs["relative_speed"]) for name, gear in gears.items()}
    turned = {
        name: gear.assign(direction=gear["direction"] + phase * turns[name])
        for name, gear in gears.items()
    }
    with styled_figure(1, 1, title, size=SET_SIZE, caption=caption) as (figure, axes):
        ax = plot_gear_set(turned, axes[0, 0])
        layers = [
            Layer(layer_of(name, number), x, y, -phase * turns[name], turns[name])
            for name, gear in gears.items()
            for number, (x, y) in enumerate(points_of(gear, "center").tolist())
        ]
    return Turning(figure, ax, layers, ())


def turning_mesh(
    view: xr.Dataset,  # As `epicyclic.study.shapes.mesh_views` returns it.
    gears: Mapping[str, xr.Dataset],  # Gears of its set.
    mesh: xr.Dataset,  # As `epicyclic.mesh_details` returns it.
    title: str,
    caption: str,
    # The only one that is drawn; default: all, in layers. [mesh periods]
    phase: float | None = None,
) -> Turning:
    """Teeth in mesh beside their contact lines on the plane of action."""
    phases = mesh["roll_angle"].to_numpy() / float(mesh.attrs["pitch_angle_deg"])
    shown = range(len(phases)) if phase is None else [_nearest(phases, phase % 1)]
    now = 0.0 if phase is None else phase % 1
    turns = _mesh_turns(view, gears, mesh, phases)
    drawn = [start + now * rate for start, rate in turns]
    turned = view.assign(direction=view["direction"] + xr.DataArray(drawn, dims="gear"))
    with styled_figure(1, 2, title, size=MESH_SIZE, caption=caption) as (figure, axes):
        teeth, plane = axes[0]
        plot_teeth(turned, gears, teeth)
        window = teeth.get_xlim(), teeth.get_ylim()
        _draw_plane(mesh, plane)
        for number in shown:
            _draw_points(mesh, view, number, teeth)
            _draw_lines(mesh, number, plane)
        teeth.set_xlim(window[0], auto=True)
        teeth.set_ylim(window[1], auto=True)
        centers = zip(view["gear"].values, points_of(view, "center").tolist(), strict=True)
        layers = [
            Layer(layer_of(str(name), 0), x, y, start - at, rate)
            for (name, (x, y)), (start, rate), at in zip(centers, turns, drawn, strict=True)
        ]
    figure.draw_without_rendering()  # labels of the ticks follow from the window, room from them
    return Turning(figure, teeth, layers, tuple(phases.tolist()))


def _nearest(phases: FloatArray, phase: float) -> int:
    """The number of the position nearest to a phase, round the period."""
    away = np.abs(phases - phase)
    return int(np.argmin(np.minimum(away, 1 - away)))


def _mesh_turns(
    view: xr.Dataset, gears: Mapping[str, xr.Dataset], mesh: xr.Dataset, phases: FloatArray
) -> list[tuple[float, float]]:
    """How far each gear is turned from touching at the pitch point: at phase 0, for each period."""
    number, path = next(
        (number, path) for number in range(len(phases)) for path, _ in _in_the_middle(mesh, number)
    )
    one, two = (str(name) for name in view["gear"].values)
    pitch = float(mesh.attrs["pitch_angle_deg"])
    # the flank of gear 1 moves along the line of action as its base circle unwinds
    base = float(gears[one]["base_diameter"]) / 2
    start = math.degrees(path / base) - phases[number] * pitch
    ratio = int(gears[one].attrs["teeth"]) / int(gears[two].attrs["teeth"])
    mate = -ratio if gears[two].attrs["internal"] else ratio
    return [(-start, -pitch), (start * mate, pitch * mate)]


def _in_the_middle(mesh: xr.Dataset, number: int) -> list[tuple[float, float]]:
    """Place on the path of contact, and load, of the pairs that touch amid the face.

    The drawing shows the section amid the face; pairs there carry the load of their whole line.
    """
    face, path = _values(mesh, "face_position", number), _values(mesh, "path_position", number)
    loads = mesh["pair_load"].isel(mesh_position=number).to_numpy()
    middle = sum(float(pick(mesh["face_position"])) for pick in (np.nanmin, np.nanmax)) / 2
    found = []
    for line in range(len(face)):
        order = np.argsort(face[line])
        if face[line][order[0]] <= middle <= face[line][order[-1]] and np.ptp(face[line]) > 0:
            place = float(np.interp(middle, face[line][order], path[line][order]))
            found.append((place, float(loads[line])))
    return found


def _values(mesh: xr.Dataset, name: str, number: int) -> FloatArray:
    """At one position, by line and segment."""
    at = mesh[name].isel(mesh_position=number).transpose("contact_line", "segment")
    return at.to_numpy().astype(float)


def _draw_points(mesh: xr.Dataset, view: xr.Dataset, number: int, ax: Axes) -> None:
    """Where pairs touch amid the face, larger with more load."""
    alpha = math.radians(float(view["pressure_angle"]))
    along, loads = np.reshape(_in_the_middle(mesh, number), (-1, 2)).T
    most = float(mesh["pair_load"].max())
    ax.scatter(
        along * math.cos(alpha),
        along * math.sin(alpha),
        s=LARGEST_DOT * loads / most if most else LARGEST_DOT,
        color=COLOURS[1],
        edgecolor="black",
        zorder=4,
        gid=f"{POSITION}-{number}-points",
    )


def _draw_plane(mesh: xr.Dataset, ax: Axes) -> None:
    """The plane of action without its lines, and their scale."""
    lows, sizes = [], []
    for name in ("path_position", "face_position"):
        values = mesh[name].where(mesh["line_load"].notnull())
        lows.append(float(values.min()))
        sizes.append(float(values.max()) - lows[-1])
    ax.add_patch(Rectangle((lows[0], lows[1]), *sizes, facecolor="0.96", edgecolor="0.6"))
    ax.axvline(0.0, color="black", lw=0.8, ls="--")
    ax.margins(0.04)
    ax.autoscale_view()
    ax.grid(visible=False)
    labelled(ax, mesh["path_position"], mesh["face_position"], "Contact lines and line load")
    colours = ScalarMappable(_scale(mesh), COLOUR_MAP)
    ax.figure.colorbar(colours, ax=ax, label=label_of(mesh["line_load"]))


def _scale(mesh: xr.Dataset) -> Normalize:
    loads = mesh["line_load"].to_numpy()
    return scale_of(np.append(loads[np.isfinite(loads)], 0.0), 0.0)


def _draw_lines(mesh: xr.Dataset, number: int, ax: Axes) -> None:
    """The contact lines at one position, coloured by their line load."""
    path, face, load = (
        _values(mesh, name, number) for name in ("path_position", "face_position", "line_load")
    )
    points = np.stack([path, face], axis=-1)
    pieces = np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 2)
    loads = ((load[:, :-1] + load[:, 1:]) / 2).ravel()
    known = np.isfinite(loads)
    drawn = LineCollection(
        list(pieces[known]),
        array=loads[known],
        cmap=COLOUR_MAP,
        norm=_scale(mesh),
        linewidths=LINE_WIDTH,
        capstyle="round",
        gid=f"{POSITION}-{number}-lines",
    )
    ax.add_collection(drawn, autolim=False)
