"""A mesh in motion, the pressure in its pockets as colour."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.animation import FuncAnimation
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from epicyclic.plots.pocket_section import Section, roll_angles
from epicyclic.plots.pockets import plot_power
from epicyclic.plots.style import gif_bytes, label_of, styled_figure

FloatArray = NDArray[np.float64]
Progress = Callable[[int, int], None]

FRAMES = 32
"""Frames of one mesh period, at most; the picture repeats after it."""
FRAMES_PER_SECOND = 12
DPI = 90
WIDTH = 9.6
"""[inches]"""
PRESSURE_MAP = "RdBu_r"
"""Blue below ambient, red above."""
NO_POCKET = "#ececec"
PRESSURE_UNITS = ((1.0, "bar", 0.1), (1e2, "kPa", 1e-3), (1e5, "Pa", 0.0))
"""Units over a bar, and the pressure in bar from which on they are read easily."""


def pocket_animation(
    mesh: xr.Dataset,  # As `epicyclic.pocket_details` returns it.
    # Called with the number of finished frames and of all frames.
    progress: Progress = lambda done, total: None,
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

    Attributes
    ----------
    figure : Figure
    """

    figure: Figure

    def __init__(self, mesh: xr.Dataset) -> None:
        helical = float(mesh["twist"]) != 0.0
        self._sections = [
            Section(mesh, end) for end in (("first", "last") if helical else ("first",))
        ]
        pressure = mesh["pressure"].to_numpy()
        largest = float(np.nanmax(np.abs(pressure)))
        scale, unit = next(
            (scale, unit) for scale, unit, least in PRESSURE_UNITS if largest >= least
        )
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
            bar = figure.colorbar(
                self._colours, ax=figure.axes, label=f"pressure above ambient, {unit}"
            )
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
        self._roll = roll_angles(mesh, "first")
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
        roll = self._roll[:, moment :: self._stride].ravel()
        low = roll[:, None] + self._lean - self._quarter
        high = low + 2 * self._quarter
        face = np.broadcast_to(self._face, low.shape)
        before, after = slice(None, -1), slice(1, None)
        corners = [(low, before), (low, after), (high, after), (high, before)]
        points = [np.stack([face[:, k], edge[:, k]], axis=-1) for edge, k in corners]
        return list(np.stack(points, axis=-2).reshape(-1, 4, 2))
