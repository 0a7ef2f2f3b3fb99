"""The transverse section through a mesh: teeth as they are cut, and the pockets between them.

Member 1 is below and turns counter-clockwise, about an axis straight below the mesh.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from epicyclic.plots.style import COLOURS, styled_figure
from epicyclic.results.result import of_gear

FloatArray = NDArray[np.float64]

PANELS, COLUMNS = 6, 3
"""Moments in the life of a pocket that a figure shows."""
PANEL_WIDTH = 4.2
"""[inches]"""
BODY, EDGE = "#dcdcdc", "#5a5a5a"
KINDS = (COLOURS[5], COLOURS[4])
"""A tooth of member 1 in a space of member 2, and the other way round."""
FOLLOWED, CONTACT, BACKLASH = COLOURS[0], COLOURS[2], COLOURS[6]
MARGIN = 0.06
"""Share of a picture left around the places where pockets begin and end. [1]"""
DEPTH = 4.0
"""How far a body reaches beyond the roots of its teeth. [tooth heights]"""


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
        _name_members(mesh, axes[0, 0])
        figure.legend(
            handles=_legend(mesh), loc="outside lower right", ncols=COLUMNS, frameon=False
        )
        row = PANEL_WIDTH * section.aspect + 0.3
        figure.set_size_inches(COLUMNS * PANEL_WIDTH, len(axes) * row + 0.9)
    return figure


def _name_members(mesh: xr.Dataset, ax: Axes) -> None:
    for name, height, place in zip(
        mesh["tooth"].to_numpy(), (0.03, 0.97), ("bottom", "top"), strict=True
    ):
        ax.text(0.5, height, name, transform=ax.transAxes, ha="center", va=place, zorder=4)


def _legend(mesh: xr.Dataset) -> list[Patch | Line2D]:
    one, two = map(of_gear, mesh["tooth"].to_numpy())
    return [
        Patch(color=FOLLOWED, label="pocket that is followed"),
        Patch(color=KINDS[0], label=f"tooth {one} in a space {two}"),
        Patch(color=KINDS[1], label=f"tooth {two} in a space {one}"),
        Line2D([], [], color=CONTACT, marker=".", label="gap, contact side"),
        Line2D([], [], color=BACKLASH, marker=".", label="gap, backlash side"),
    ]


def roll_angles(mesh: xr.Dataset, end: str) -> FloatArray:
    """Roll angles of the pockets at one end of the face. [deg]"""
    twist = float(mesh["twist"]) if end == "last" else 0.0
    angles: FloatArray = mesh["roll_angle"].to_numpy() + twist
    return angles


class Section:
    """Teeth and pockets at one end of the face, at any moment of the mesh period.

    Parameters
    ----------
    mesh : Dataset
        As `epicyclic.pocket_details` returns it.
    end : str
        ``"first"`` or ``"last"``.

    Attributes
    ----------
    roll : ndarray, shape (2, steps)
        Roll angles of the pockets at this end of the face. [deg]
    stride : int
        Mesh positions in a period: steps between pockets that live at the same time.
    """

    def __init__(self, mesh: xr.Dataset, end: str) -> None:
        self._mesh = mesh
        self._end = end
        self.roll = roll_angles(mesh, end)
        self.stride = mesh.sizes["mesh_position"]
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
        limits = zip(self._low, self._high, strict=True)
        ax.set(**dict(zip(("xlim", "ylim"), limits, strict=True)), aspect="equal")
        ax.set(xticks=[], yticks=[])
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
