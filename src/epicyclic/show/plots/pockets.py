"""The pockets of a mesh: over the roll angle, in section, and in motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure, FigureBase
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from epicyclic.arrays import FloatArray
from epicyclic.result.result import in_words, of_gear
from epicyclic.show.plots.style import (
    COLOUR_MAP,
    COLOURS,
    LINE_STYLES,
    closed_period,
    gif_bytes,
    label_of,
    labelled,
    legend_below,
    styled_figure,
)
from epicyclic.units import known_text

# The pockets of a mesh over the roll angle: shape, pressure, speed, power.
#
# All functions take one mesh as `epicyclic.pocket_details` returns it, draw on given Axes and
# return them.

OVER_LIFE = ("pressure", "axial_speed", "contact_gap_speed", "backlash_gap_speed")
"""Variables drawn over the life of a pocket."""
DRAWN_SLICES = 9  # Most slices that are drawn one by one.
GAP_HEIGHT = 8.0
GAP_SHARE = 0.05
"""Height of the axis of gaps, over the smallest and the largest gap of the backlash side. [1]"""


def pocket_figure(mesh: xr.Dataset) -> Figure:
    """Everything an engineer looks at on the pockets of one mesh, both kinds side by side."""
    with styled_figure(6, 2, str(mesh.attrs["title"])) as (figure, axes):
        _plot_kinds(mesh, mesh["end_area"].isel(station=0), axes[0, 0], "Area at the first end")
        plot_volumes(mesh, axes[0, 1])
        plot_gaps(mesh, axes[1, 0])
        plot_power(mesh, axes[1, 1])
        for row, name in zip(axes[2:], OVER_LIFE, strict=True):
            for kind, ax in enumerate(row):
                plot_over_life(mesh, name, kind, ax)
        _add_face_scale(mesh, figure, axes[2:], aspect=60)
    return figure


def plot_life_with_scale(mesh: xr.Dataset, name: str, kind: int, ax: Axes) -> Axes:
    """`plot_over_life` with a scale of the places across the face."""
    plot_over_life(mesh, name, kind, ax)
    _add_face_scale(mesh, ax.figure, ax)
    return ax


def _add_face_scale(mesh: xr.Dataset, figure: FigureBase, axes: Any, **options: Any) -> None:
    place = label_of(mesh["station_position"])
    figure.colorbar(_face_colours(mesh), ax=axes, label=place, **options)


def plot_volumes(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Volume of a pocket across the face."""
    return _plot_kinds(mesh, mesh["volume"], ax, "Volume of a pocket")


def _plot_kinds(mesh: xr.Dataset, values: xr.DataArray, ax: Axes, title: str) -> Axes:
    for kind in (0, 1):
        ax.plot(mesh["roll_angle"][kind], values[kind], LINE_STYLES[kind], label=_name(mesh, kind))
    ax.set_ylim(bottom=0)
    legend_below(ax, ncols=2)
    return _over_roll(mesh, values, ax, title)


def plot_gaps(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Gaps on both sides at the first end of the face."""
    first = mesh.isel(station=0)
    for kind in (0, 1):
        for side, style in (("contact", "-"), ("backlash", "--")):
            label = f"{side}, {in_words(mesh['tooth'].to_numpy()[kind])}"
            values = first[f"{side}_gap"][kind]
            ax.plot(mesh["roll_angle"][kind], values, style, color=COLOURS[kind], label=label)
    gap = first["backlash_gap"]
    ax.set_ylim(0, max(GAP_HEIGHT * float(gap.min()), GAP_SHARE * float(gap.max())))
    legend_below(ax, ncols=2)
    _over_roll(mesh, gap, ax, "Gaps at the first end")
    ax.set_ylabel("gap, µm")  # of both sides
    return ax


def plot_over_life(
    mesh: xr.Dataset,
    # ``"pressure"``, ``"axial_speed"``, ``"contact_gap_speed"`` or ``"backlash_gap_speed"``.
    name: str,
    kind: int,  # 0: a tooth of member 1 in a space of member 2; 1: the other way round.
    ax: Axes,
) -> Axes:
    """Pressure or a speed in some slices, or between them, through the life of a pocket.

    Dark lines are near the first end of the face, light ones near the last.
    """
    values = mesh[name][kind]
    across = str(values.dims[-1])
    place = mesh[f"{across}_position"]
    colours = _face_colours(mesh).to_rgba(place.to_numpy())
    for number in np.unique(np.linspace(0, place.size - 1, DRAWN_SLICES).round()).astype(int):
        ax.plot(mesh["roll_angle"][kind], values[:, number], color=colours[number], lw=1.0)
    return _over_roll(mesh, values, ax, _name(mesh, kind).capitalize())


def _face_colours(mesh: xr.Dataset) -> ScalarMappable:
    """Colours of the places across the face."""
    width = float(mesh["station_position"][-1])
    return ScalarMappable(Normalize(0.0, width), mpl.colormaps[COLOUR_MAP])


def plot_power(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Power of all pockets of the mesh over one mesh period, and its mean."""
    angles, powers = mesh["period_angle"].to_numpy(), mesh["instant_power"].to_numpy()
    ax.plot(*closed_period(angles, powers, angles.size * float(angles[1] - angles[0])))
    mean = float(mesh["power"])
    ax.axhline(mean, color="black", ls="--", lw=0.8, label=f"mean {known_text(mean)}")
    legend_below(ax)
    title = "Power of the pockets over one mesh period"
    return labelled(ax, mesh["period_angle"], mesh["instant_power"], title)


def _name(mesh: xr.Dataset, kind: int) -> str:
    return f"tooth {of_gear(mesh['tooth'].to_numpy()[kind])}"


def _over_roll(mesh: xr.Dataset, values: xr.DataArray, ax: Axes, title: str) -> Axes:
    angles = mesh["roll_angle"].where(mesh["live"].any("slice"))
    ax.set_xlim(float(angles.min()), float(angles.max()))
    return labelled(ax, mesh["roll_angle"], values, title)


# The transverse section through a mesh: teeth as they are cut, and the pockets between them.
#
# Member 1 is below and turns counter-clockwise, about an axis straight below the mesh.

PANELS, COLUMNS = 6, 3  # Moments in the life of a pocket that a figure shows.
PANEL_WIDTH = 4.2  # [inches]
BODY, EDGE = "#dcdcdc", "#5a5a5a"
KINDS = (COLOURS[5], COLOURS[4])
"""A tooth of member 1 in a space of member 2, and the other way round."""
FOLLOWED, CONTACT, BACKLASH = COLOURS[0], COLOURS[2], COLOURS[6]
MARGIN = 0.06  # Share of a picture left around the places where pockets begin and end. [1]
DEPTH = 4.0  # How far a body reaches beyond the roots of its teeth. [tooth heights]


def section_figure(
    mesh: xr.Dataset,  # As `epicyclic.pocket_details` returns it.
    end: str = "first",  # ``"first"`` or ``"last"`` end of the face.
) -> Figure:
    """One pocket through its life, between the teeth and the other pockets."""
    section = Section(mesh, end)
    title = f"{mesh.attrs['title']}, {end} end of the face"
    with styled_figure(PANELS // COLUMNS, COLUMNS, title) as (figure, axes):
        for ax, step in zip(axes.ravel(), section.moments(PANELS), strict=True):
            section.draw(ax, step % section.stride)
            section.follow(ax, step)
            ax.set_title(f"roll angle {section.roll[0, step]:.1f}°")
        names, ax = mesh["tooth"].to_numpy(), axes[0, 0]
        for name, height, place in zip(names, (0.03, 0.97), ("bottom", "top"), strict=True):
            ax.text(0.5, height, name, transform=ax.transAxes, ha="center", va=place, zorder=4)
        handles = _legend(mesh)
        figure.legend(handles=handles, loc="outside lower right", ncols=COLUMNS, frameon=False)
        row = PANEL_WIDTH * section.aspect + 0.3
        figure.set_size_inches(COLUMNS * PANEL_WIDTH, len(axes) * row + 0.9)
    return figure


def _legend(mesh: xr.Dataset) -> list[Patch | Line2D]:
    one, two = map(of_gear, mesh["tooth"].to_numpy())
    return [
        Patch(color=FOLLOWED, label="pocket followed over time"),
        Patch(color=KINDS[0], label=f"tooth {one} in a space {two}"),
        Patch(color=KINDS[1], label=f"tooth {two} in a space {one}"),
        Line2D([], [], color=CONTACT, marker=".", label="gap, contact side"),
        Line2D([], [], color=BACKLASH, marker=".", label="gap, backlash side"),
    ]


class Section:
    """Teeth and pockets at one end of the face, at any moment of the mesh period."""

    def __init__(self, mesh: xr.Dataset, end: str) -> None:
        self._mesh = mesh
        self._end = end
        twist = float(mesh["twist"]) if end == "last" else 0.0
        self.roll = mesh["roll_angle"].to_numpy() + twist  # Of the pockets: (2, steps). [deg]
        self.stride = mesh.sizes["mesh_position"]  # Steps between pockets that live together.
        self._outlines = _upright(mesh["outline"].sel(end=end).to_numpy())
        self._living = np.isfinite(self._outlines[:, :, 0, 0])
        points = self._outlines[self._living].reshape(-1, 2)
        low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
        margin = MARGIN * (high[0] - low[0])
        self._low, self._high = low - margin, high + margin
        self._teeth = [mesh[f"tooth{number}"].to_numpy() for number in (1, 2)]
        self._bodies: list[PolyCollection] = []
        self._pockets = PolyCollection([])

    @property
    def aspect(self) -> float:
        """Height of a picture over its width. [1]"""
        width, height = self._high - self._low
        return float(height / width)

    def moments(self, count: int) -> list[int]:
        """Steps in the life of a pocket of a tooth of member 1, from birth to death."""
        alive = np.flatnonzero(self._living[0])
        return [int(step) for step in np.linspace(alive[0], alive[-1], count).round()]

    def pockets(self, moment: int) -> tuple[list[int], list[int]]:
        """Kinds, and steps of their lives, of the pockets that live at a mesh position."""
        kinds, places = np.nonzero(self._living[:, moment :: self.stride])
        return list(kinds), list(moment + self.stride * places)

    def draw(self, ax: Axes, moment: int) -> None:
        """Draw teeth and pockets at a mesh position, pockets coloured by whose tooth it is."""
        self._bodies = [
            PolyCollection([body], facecolor=BODY, edgecolor=EDGE, linewidth=0.8, zorder=1)
            for body in self._rows_of_teeth(moment)
        ]
        kinds, _ = self.pockets(moment)
        self._pockets = PolyCollection(
            self._drawn(moment), facecolor=[KINDS[k] for k in kinds], edgecolor=EDGE, linewidth=0.4
        )
        self._pockets.set_zorder(2)
        for collection in (*self._bodies, self._pockets):
            ax.add_collection(collection)
        across, up = zip(self._low, self._high, strict=True)
        ax.set(xlim=across, ylim=up, aspect="equal", xticks=[], yticks=[])
        ax.grid(visible=False)
        ax.spines[["left", "bottom"]].set_visible(False)
        self._draw_scale(ax)

    def move(
        self,
        moment: int,
        colours: Any,  # Colours of the pockets, in the order of `pockets`.
    ) -> None:
        """Move what was drawn last to another mesh position."""
        for body, points in zip(self._bodies, self._rows_of_teeth(moment), strict=True):
            body.set_verts([points])
        self._pockets.set_verts(self._drawn(moment))
        self._pockets.set_facecolor(colours)

    def follow(self, ax: Axes, step: int) -> None:
        """Mark the gaps, and the pocket of a tooth of member 1 that is at `step` of its life."""
        points = self._outlines[0, step]
        points = points[np.isfinite(points[:, 0])]
        ax.add_collection(PolyCollection([points], facecolor=FOLLOWED, edgecolor="none", zorder=2))
        kinds, steps = self.pockets(step % self.stride)
        for side, colour in (("contact", CONTACT), ("backlash", BACKLASH)):
            feet = self._mesh[f"{side}_feet"].sel(end=self._end).to_numpy()
            lines = _upright(feet[kinds, steps])
            ax.add_collection(LineCollection(list(lines), colors=colour, linewidths=1.4, zorder=3))
            ax.plot(*lines.reshape(-1, 2).T, ".", color=colour, ms=3, zorder=3)

    def _drawn(self, moment: int) -> list[FloatArray]:
        outlines = self._outlines[self.pockets(moment)]
        return [points[np.isfinite(points[:, 0])] for points in outlines]

    def _rows_of_teeth(self, moment: int) -> Iterator[FloatArray]:
        """Some teeth of each member with the body that carries them."""
        mesh = self._mesh
        z1, z2 = mesh.attrs["teeth"]
        angle1 = math.radians(self.roll[0, moment])
        angle2 = angle1 * z1 / z2 + math.radians(float(mesh["space_shift"])) + math.pi / z2
        distance = float(mesh["center_distance"])
        span = float(self._high[0] - self._low[0])
        yield _upright(_row_of_teeth(self._teeth[0], z1, angle1, span))
        row = _row_of_teeth(self._teeth[1], z2, angle2, span)
        # a ring turns with its planet, its axis on the same side of the mesh; two external gears
        # turn against each other: the same picture, reflected across the line of centres
        if not mesh.attrs["internal"]:
            row, distance = row * [-1.0, 1.0], -distance
        yield _upright(row - [distance, 0.0])

    def _draw_scale(self, ax: Axes) -> None:
        """A bar of a round length in the lower right corner."""
        width = float(self._high[0] - self._low[0])
        power = 10.0 ** math.floor(math.log10(width / 4))
        length = power * max(step for step in (1, 2, 5) if step * power <= width / 4)
        end, height = self._high[0] - 0.02 * width, self._low[1] + 0.02 * width
        ax.plot([end - length, end], [height, height], color="black", lw=2, zorder=4)
        place = (end - length / 2, height)
        words = ax.annotate(f"{length:g} mm", place, (0, 2), textcoords="offset points", zorder=4)
        words.set(ha="center", fontsize=7)


def _upright(points: FloatArray) -> FloatArray:
    """Line of centres upright, member 1 below."""
    turned: FloatArray = points @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    return turned


def _row_of_teeth(tooth: FloatArray, teeth: int, one: float, span: float) -> FloatArray:
    """Teeth side by side around the x axis, closed by an arc inside the body.

    `one`: angle of any tooth; `span`: how long the row is at least.
    """
    pitch = 2 * math.pi / teeth
    root, tip = np.hypot(*tooth[[0, len(tooth) // 2]].T)
    beside = min((teeth - 1) // 2, math.ceil(span / min(root, tip) / pitch))
    numbers = np.arange(-beside, beside + 1)
    row = np.multiply.outer(np.exp(1j * pitch * numbers), tooth[:, 0] + 1j * tooth[:, 1]).ravel()
    half = (beside + 0.5) * pitch
    body = max(root + DEPTH * (root - tip), root / 3)
    arc = body * np.exp(1j * np.linspace(half, -half, 8 * numbers.size))
    nearest = one - pitch * round(one / pitch)
    points = np.concatenate([row, arc]) * np.exp(1j * nearest)
    return np.column_stack([points.real, points.imag])


# A mesh in motion, the pressure in its pockets as colour.

FRAMES = 32  # Frames of one mesh period, at most; the picture repeats after it.
FRAMES_PER_SECOND = 12
DPI = 90
WIDTH = 9.6  # [inches]
PRESSURE_MAP = "RdBu_r"  # Blue below ambient, red above.
NO_POCKET = "#ececec"
PRESSURE_UNITS = ((1.0, "bar", 0.1), (1e2, "kPa", 1e-3), (1e5, "Pa", 0.0))
"""Units over a bar, and the pressure in bar from which on they are read easily."""


def pocket_animation(
    mesh: xr.Dataset,  # As `epicyclic.pocket_details` returns it.
    # Called with the number of finished frames and of all frames.
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> bytes:
    """One mesh period as an animated GIF."""
    scene = MeshScene(mesh)
    positions = mesh.sizes["mesh_position"]
    moments = np.linspace(0, positions, min(FRAMES, positions), endpoint=False).astype(int)
    animation = FuncAnimation(
        scene.figure, lambda frame: scene.show(int(moments[frame])), frames=moments.size
    )
    return gif_bytes(
        animation, FRAMES_PER_SECOND, DPI, lambda done, total: progress(done + 1, total)
    )


class MeshScene:
    """Sections at both ends of the face, the pressure across it and the power, at one moment.

    Without a helix both ends are alike, and one is drawn.
    """

    figure: Figure

    def __init__(self, mesh: xr.Dataset) -> None:
        helical = float(mesh["twist"]) != 0.0
        ends = ("first", "last") if helical else ("first",)
        self._sections = [Section(mesh, end) for end in ends]
        pressure = mesh["pressure"].to_numpy()
        largest = float(np.nanmax(np.abs(pressure)))
        scale, unit, _ = next(it for it in PRESSURE_UNITS if largest >= it[2])
        self._pressure = scale * pressure
        shades = mpl.colormaps[PRESSURE_MAP].with_extremes(bad=NO_POCKET)
        self._colours = ScalarMappable(Normalize(-scale * largest, scale * largest), shades)
        self._stride = mesh.sizes["mesh_position"]
        with styled_figure(2, 2, str(mesh.attrs["title"])) as (figure, axes):
            self.figure = figure
            height = WIDTH / 2 * self._sections[0].aspect
            axes[0, 0].get_gridspec().set_height_ratios([height, 3.0])
            figure.set_size_inches(WIDTH, height + 4.0)
            for section, ax in zip(self._sections, axes[0], strict=False):
                section.draw(ax, 0)
            if helical:
                axes[0, 0].set_title("First end of the face")
                axes[0, 1].set_title("Last end of the face")
            else:
                axes[0, 1].remove()
            label = f"pressure above ambient, {unit}"
            bar = figure.colorbar(self._colours, ax=figure.axes, label=label)
            bar.ax.set_ylim(np.nanmin(self._pressure), np.nanmax(self._pressure))
            self._map = _PressureMap(mesh, axes[1, 0])
            self._dot = plot_power(mesh, axes[1, 1]).plot([], [], "o", color="black")[0]
        self._power = np.stack([mesh["period_angle"], mesh["instant_power"]])
        self.show(0)
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # laid out once: nothing may jump from frame to frame

    def show(self, moment: int) -> list[Any]:
        """Move everything to one position of the mesh period."""
        for section, place in zip(self._sections, (0, -1), strict=False):
            here = self._pressure[(*section.pockets(moment), place)]
            section.move(moment, self._colours.to_rgba(np.nan_to_num(here)))
        shades = self._colours.to_rgba(self._pressure[:, moment :: self._stride].ravel())
        self._map.move(moment, shades)
        self._dot.set_data(self._power[:, moment : moment + 1])
        return []


class _PressureMap:
    """All cells of the mesh unrolled: position across the face over the angle of the section."""

    def __init__(self, mesh: xr.Dataset, ax: Axes) -> None:
        self._stride = mesh.sizes["mesh_position"]
        self._roll = mesh["roll_angle"].to_numpy()
        self._face = mesh["station_position"].to_numpy()
        self._lean = float(mesh["twist"]) * self._face / self._face[-1]
        self._quarter = 90.0 / mesh.attrs["teeth"][0]
        self._cells = PolyCollection(self._corners(0), edgecolor="face", linewidth=0.2)
        ax.add_collection(self._cells)
        living = self._roll[mesh["live"].any("slice").to_numpy()]
        ax.axhline(0.0, color="black", lw=0.8, ls="--")
        ax.set(
            title="Pressure across the face, pockets side by side",
            xlabel=label_of(mesh["station_position"]),
            ylabel="angle from the line of centres, deg",
            xlim=(0.0, self._face[-1]),
            ylim=(living.min(), living.max() + self._lean[-1]),
        )
        ax.grid(visible=False)

    def move(self, moment: int, colours: Any) -> None:
        """Show another mesh position, `colours` by kind, pocket and slice."""
        self._cells.set_verts(self._corners(moment))
        self._cells.set_facecolor(colours)

    def _corners(self, moment: int) -> list[FloatArray]:
        """Corners of the cells of all pockets."""
        low = self._roll[:, moment :: self._stride].ravel()[:, None] + self._lean - self._quarter
        high = low + 2 * self._quarter
        face = np.broadcast_to(self._face, low.shape)
        before, after = slice(None, -1), slice(1, None)
        corners = [(low, before), (low, after), (high, after), (high, before)]
        points = [np.stack([face[:, k], edge[:, k]], axis=-1) for edge, k in corners]
        return list(np.stack(points, axis=-2).reshape(-1, 4, 2))
