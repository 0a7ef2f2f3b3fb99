"""The pockets of a mesh over the roll angle: shape, pressure, speed, power.

All functions take one mesh as `epicyclic.pocket_details` returns it, draw on given Axes and return
them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure, FigureBase

from epicyclic.plots.style import (
    COLOUR_MAP,
    COLOURS,
    LINE_STYLES,
    closed_period,
    label_of,
    legend_below,
    styled_figure,
)
from epicyclic.results.result import in_words, of_gear
from epicyclic.units import known_text

OVER_LIFE = ("pressure", "axial_speed", "contact_gap_speed", "backlash_gap_speed")
"""Variables drawn over the life of a pocket."""
DRAWN_SLICES = 9
"""Most slices that are drawn one by one."""
GAP_HEIGHT = 8.0
GAP_SHARE = 0.05
"""Height of the axis of gaps, over the smallest and the largest gap of the backlash side. [1]"""


def pocket_figure(mesh: xr.Dataset) -> Figure:
    """Everything an engineer looks at on the pockets of one mesh, both kinds side by side."""
    with styled_figure(6, 2, str(mesh.attrs["title"])) as (figure, axes):
        plot_areas(mesh, axes[0, 0])
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


def plot_areas(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Area of the section at the first end of the face."""
    return _plot_kinds(mesh, mesh["end_area"].isel(station=0), ax, "Area at the first end")


def plot_volumes(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Volume of a pocket across the face."""
    return _plot_kinds(mesh, mesh["volume"], ax, "Volume of a pocket")


def _plot_kinds(mesh: xr.Dataset, values: xr.DataArray, ax: Axes, title: str) -> Axes:
    for kind in (0, 1):
        style = LINE_STYLES[kind]
        ax.plot(mesh["roll_angle"][kind], values[kind], style, label=_name(mesh, kind))
    ax.set_ylim(bottom=0)
    legend_below(ax, ncols=2)
    return _over_roll(mesh, ax, title, label_of(values))


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
    return _over_roll(mesh, ax, "Gaps at the first end", "gap, µm")


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
    for number in _spread(place.size):
        ax.plot(mesh["roll_angle"][kind], values[:, number], color=colours[number], lw=1.0)
    title = f"{str(mesh[name].attrs['long_name']).capitalize()}: {_name(mesh, kind)}"
    return _over_roll(mesh, ax, title, label_of(mesh[name]))


def _face_colours(mesh: xr.Dataset) -> ScalarMappable:
    """Colours of the places across the face."""
    width = float(mesh["station_position"][-1])
    return ScalarMappable(Normalize(0.0, width), mpl.colormaps[COLOUR_MAP])


def _spread(count: int) -> Sequence[int]:
    """Numbers of some of `count` lines, the outer ones among them."""
    return [int(n) for n in np.unique(np.linspace(0, count - 1, DRAWN_SLICES).round())]


def plot_power(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Power of all pockets of the mesh over one mesh period, and its mean."""
    angles, powers = mesh["period_angle"].to_numpy(), mesh["instant_power"].to_numpy()
    ax.plot(*closed_period(angles, powers, angles.size * float(angles[1] - angles[0])))
    mean = float(mesh["power"])
    ax.axhline(mean, color="black", ls="--", lw=0.8, label=f"mean {known_text(mean)}")
    legend_below(ax)
    ax.set(
        title="Power of the pockets over one mesh period",
        xlabel=label_of(mesh["period_angle"]),
        ylabel=label_of(mesh["instant_power"]),
    )
    return ax


def _name(mesh: xr.Dataset, kind: int) -> str:
    return f"tooth {of_gear(mesh['tooth'].to_numpy()[kind])}"


def _over_roll(mesh: xr.Dataset, ax: Axes, title: str, label: str) -> Axes:
    angles = mesh["roll_angle"].where(mesh["live"].any("slice"))
    ax.set(
        xlim=(float(angles.min()), float(angles.max())),
        title=title,
        xlabel=label_of(mesh["roll_angle"]),
        ylabel=label,
    )
    return ax
