"""Gears that turn: drawings in which each gear, and each position of a mesh, is a layer of its own.

A page turns the layers of the gears and shows one position after the other; a file has one of them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from epicyclic.plots.drawing import layer_of, plot_gear_set, plot_teeth
from epicyclic.plots.mesh import top_of_scale
from epicyclic.plots.style import COLOUR_MAP, COLOURS, label_of, styled_figure

Floats = NDArray[np.float64]

POSITION = "position"
"""Layers of a mesh position are called so, with its number and that of their Axes."""
POINTS_PER_INCH = 72
SET_SIZE, MESH_SIZE = (7.2, 6.4), (12.8, 5.6)
"""Width and height of the drawings. [inch]"""
LARGEST_DOT = 260.0
"""Area of the contact of a tooth pair that carries all. [point^2]"""
LINE_WIDTH = 4.0


@dataclass(frozen=True, slots=True)
class Layer:
    """A gear that turns on paper."""

    name: str  # Name of its layer in a picture.
    x: float  # Its centre, from the left and the top of the picture. [point]
    y: float  # Its centre, from the left and the top of the picture. [point]
    # How far it is turned against the clock at phase 0 from how it is drawn, and for each mesh
    # period. [deg]
    start: float
    rate: float


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """A drawing with what turns in it."""

    figure: Figure
    ax: Axes  # On which the gears are.
    # By layer: centre in the coordinates of `ax`, start and rate as of `Layer`.
    gears: dict[str, tuple[float, float, float, float]]
    phases: tuple[float, ...]  # Phases of the positions that are layers, in mesh periods.

    def layers(self) -> list[Layer]:
        """The gears where they are on the picture, once that has been written."""
        height = self.figure.get_figheight()
        found = []
        for name, (x, y, start, rate) in self.gears.items():
            across, up = (self.ax.transData.transform((x, y)) / self.figure.dpi).tolist()
            place = POINTS_PER_INCH * across, POINTS_PER_INCH * (height - up)
            found.append(Layer(name, *place, start, rate))
        return found


def turning_set(
    # Gears of one set, as `epicyclic.analysis.shapes.gear_shapes` returns them.
    gears: Mapping[str, xr.Dataset],
    title: str,
    caption: str,
    phase: float = 0.0,  # At which it is drawn. [mesh periods of the first gear]
) -> Turning:
    """A set seen along its axis, from its carrier."""
    turns = {name: _degrees_per_period(gears, name) for name in gears}
    turned = {
        name: gear.assign(direction=gear["direction"] + phase * turns[name])
        for name, gear in gears.items()
    }
    with styled_figure(1, 1, title, size=SET_SIZE, caption=caption) as (figure, axes):
        ax = plot_gear_set(turned, axes[0, 0])
        layers = {
            layer_of(name, number): (
                float(gear["center_x"][number]),
                float(gear["center_y"][number]),
                -phase * turns[name],
                turns[name],
            )
            for name, gear in gears.items()
            for number in range(gear.sizes["place"])
        }
    return Turning(figure, ax, layers, ())


def _degrees_per_period(gears: Mapping[str, xr.Dataset], name: str) -> float:
    first = next(iter(gears.values()))
    return 360.0 / int(first.attrs["teeth"]) * float(gears[name].attrs["relative_speed"])


def turning_mesh(
    view: xr.Dataset,  # As `epicyclic.analysis.shapes.mesh_views` returns it.
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
        layers = {
            layer_of(str(name), 0): (
                float(view["center_x"][number]),
                float(view["center_y"][number]),
                turns[number][0] - drawn[number],
                turns[number][1],
            )
            for number, name in enumerate(view["gear"].values)
        }
    figure.draw_without_rendering()  # labels of the ticks follow from the window, room from them
    return Turning(figure, teeth, layers, tuple(phases.tolist()))


def _nearest(phases: Floats, phase: float) -> int:
    """The number of the position nearest to a phase, round the period."""
    away = np.abs(phases - phase)
    return int(np.argmin(np.minimum(away, 1 - away)))


def _mesh_turns(
    view: xr.Dataset, gears: Mapping[str, xr.Dataset], mesh: xr.Dataset, phases: Floats
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
    middle = _middle(mesh)
    found = []
    for line in range(len(face)):
        order = np.argsort(face[line])
        if face[line][order[0]] <= middle <= face[line][order[-1]] and np.ptp(face[line]) > 0:
            place = float(np.interp(middle, face[line][order], path[line][order]))
            found.append((place, float(loads[line])))
    return found


def _middle(mesh: xr.Dataset) -> float:
    low, high = (float(pick(mesh["face_position"])) for pick in (np.nanmin, np.nanmax))
    return (low + high) / 2


def _values(mesh: xr.Dataset, name: str, number: int) -> Floats:
    """At one position, by line and segment."""
    at = mesh[name].isel(mesh_position=number).transpose("contact_line", "segment")
    return at.to_numpy().astype(float)


def _draw_points(mesh: xr.Dataset, view: xr.Dataset, number: int, ax: Axes) -> None:
    """Where pairs touch amid the face, larger with more load."""
    alpha = math.radians(float(view["pressure_angle"]))
    found = _in_the_middle(mesh, number)
    most = float(mesh["pair_load"].max())
    along = np.array([place for place, _ in found])
    loads = np.array([load for _, load in found])
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
    ax.set(
        title="Contact lines and line load",
        xlabel=label_of(mesh["path_position"]),
        ylabel=label_of(mesh["face_position"]),
    )
    _, told = _top(mesh)
    ax.figure.colorbar(
        ScalarMappable(_scale(mesh), COLOUR_MAP),
        ax=ax,
        label=f"{label_of(mesh['line_load'])}{told}",
        extend="max" if told else "neither",
    )


def _scale(mesh: xr.Dataset) -> Normalize:
    return Normalize(0.0, _top(mesh)[0] or 1.0)


def _top(mesh: xr.Dataset) -> tuple[float, str]:
    loads = mesh["line_load"].to_numpy()
    return top_of_scale(loads[np.isfinite(loads)])


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
