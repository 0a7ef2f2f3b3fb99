"""A loaded mesh: where the teeth carry, how they share, how they slide.

All functions take one mesh as `epicyclic.mesh_details` returns it, draw on given Axes and return
them.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.tri import Triangulation
from numpy.typing import NDArray

from epicyclic.plots.style import COLOUR_MAP, closed_period, label_of, legend_below, styled_figure
from epicyclic.units import format_number

FloatArray = NDArray[np.float64]

FRICTION = "friction_coefficient"
MAPS = ("line_load", "hertz_pressure", "sliding_speed", "friction_power", "film_ratio")
"""Variables drawn over the plane of action."""
BOTH_WAYS = (FRICTION, "flash_temperature")
"""Those drawn along the path of contact too."""
SAME = 1e-9
"""Relative difference of coefficients of friction that are one number."""
NO_PEAK, PEAKED = 0.95, 1.15
"""A scale of colours ends at this quantile where the highest value is more than so many times it:
peaks at corners would take the scale from all the rest."""
MARGIN = 0.06
"""Above a curve, of the height of the Axes."""
PATH_PLACES = 40
"""Places on the path of contact at which values are taken together."""


def mesh_figure(mesh: xr.Dataset) -> Figure:
    """Everything an engineer looks at on one mesh, in two columns: letters stay readable."""
    with styled_figure(6, 2, str(mesh.attrs["title"])) as (figure, axes):
        flat = axes.ravel()
        plot_pair_loads(mesh, flat[0])
        plot_transmission_error(mesh, flat[1])
        plot_mesh_stiffness(mesh, flat[2])
        for ax, name in zip(flat[3:8], MAPS, strict=True):
            plot_plane_of_action(mesh, name, ax)
        for (over_plane, along_path), name in zip(axes[4:], BOTH_WAYS, strict=True):
            plot_plane_of_action(mesh, name, over_plane)
            plot_along_path(mesh, name, along_path)
    return figure


def plot_plane_of_action(mesh: xr.Dataset, name: str, ax: Axes) -> Axes:
    """Values of `name` over the plane of action, all mesh positions together."""
    shape = (mesh.sizes["mesh_position"] * mesh.sizes["contact_line"], mesh.sizes["segment"])
    order = ("contact_line", "mesh_position", "segment")
    path, face, values = (
        mesh[key].transpose(*order).to_numpy().reshape(shape)
        for key in ("path_position", "face_position", name)
    )
    known = np.isfinite(values)
    if known.any() and all(np.ptp(place[known]) > 0 for place in (path, face)):
        _draw_map(ax, path[known], face[known], values[known], label_of(mesh[name]))
    else:
        _say(ax, "no motion")
    ax.set(
        title=str(mesh[name].attrs["long_name"]).capitalize(),
        xlabel=label_of(mesh["path_position"]),
        ylabel=label_of(mesh["face_position"]),
    )
    ax.axvline(0.0, color="black", lw=0.8, ls="--")
    return ax


def _draw_map(ax: Axes, path: FloatArray, face: FloatArray, values: FloatArray, label: str) -> None:
    # triangles between the points, in coordinates of like size so that they are not slivers
    scale = np.ptp(path) / np.ptp(face)
    triangles = Triangulation(path, face * scale).triangles
    corners = Triangulation(path, face, triangles)
    top, told = top_of_scale(values)
    drawn = ax.tripcolor(
        corners,
        values,
        shading="gouraud",
        cmap=COLOUR_MAP,
        rasterized=True,
        vmax=top,
    )
    ax.figure.colorbar(drawn, ax=ax, label=f"{label}{told}", extend="max" if told else "neither")


def top_of_scale(values: FloatArray) -> tuple[float, str]:
    """Where a scale of colours ends, and what its label says of a peak beyond it."""
    highest, limit = float(values.max()), float(np.quantile(values, NO_PEAK))
    if highest > PEAKED * limit > 0:
        return limit, f"; highest {format_number(highest, 3)}"
    return highest, ""


def _say(ax: Axes, text: str) -> None:
    """Words instead of a drawing."""
    ax.text(0.5, 0.5, text, ha="center", transform=ax.transAxes)


def plot_pair_loads(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Load of every tooth pair over the roll angle of member 1, through its whole engagement."""
    angle = mesh["roll_angle"] + mesh["contact_line"] * float(mesh.attrs["pitch_angle_deg"])
    order = ("contact_line", "mesh_position")
    ax.plot(
        angle.transpose(*order).to_numpy().ravel(),
        mesh["pair_load"].transpose(*order).to_numpy().ravel(),
        marker=".",
        ms=3,
    )
    ax.set(
        title="Load of one tooth pair through its engagement",
        xlabel=label_of(mesh["roll_angle"]),
        ylabel=label_of(mesh["pair_load"]),
    )
    return ax


def plot_transmission_error(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Loaded transmission error over one mesh period."""
    return _plot_over_period(mesh, "transmission_error", ax)


def plot_mesh_stiffness(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Mesh stiffness over one mesh period."""
    return _plot_over_period(mesh, "mesh_stiffness", ax)


def _plot_over_period(mesh: xr.Dataset, name: str, ax: Axes) -> Axes:
    values = mesh[name].to_numpy()
    if np.isfinite(values).any():
        angles = mesh["roll_angle"].to_numpy()
        pitch = float(mesh.attrs["pitch_angle_deg"])
        ax.plot(*closed_period(angles, values, pitch), marker=".", ms=3)
    else:
        _say(ax, "not known with this load distribution")
    ax.set(
        title=str(mesh[name].attrs["long_name"]).capitalize(),
        xlabel=label_of(mesh["roll_angle"]),
        ylabel=label_of(mesh[name]),
    )
    return ax


def plot_along_path(mesh: xr.Dataset, name: str, ax: Axes) -> Axes:
    """Mean and extremes of `name` at each place on the path of contact, from root to tip."""
    path, values = (mesh[key].to_numpy().ravel() for key in ("path_position", name))
    known = np.isfinite(values)
    if known.any():
        path, values = path[known], values[known]
        edges = np.linspace(path.min(), path.max(), PATH_PLACES + 1)
        place = np.clip(np.searchsorted(edges, path, side="right") - 1, 0, PATH_PLACES - 1)
        found = np.unique(place)
        middle = ((edges[1:] + edges[:-1]) / 2)[found]
        low, mean, high = (
            np.array([pick(values[place == one]) for one in found])
            for pick in (np.min, np.mean, np.max)
        )
        if name == FRICTION and np.ptp(values) <= SAME * abs(values).max():
            ax.plot(middle, mean, label="one mean for the whole mesh: the model has no other")
        else:
            ax.fill_between(middle, low, high, alpha=0.25, lw=0, label="range across the face")
            ax.plot(middle, mean, label="mean across the face")
        ax.axvline(0.0, color="black", lw=0.8, ls="--", label="pitch point")
        legend_below(ax, ncols=3)
        bottom, top = min(0.0, float(low.min())), max(0.0, float(high.max()))
        margin = MARGIN * (top - bottom)
        ax.set_ylim(bottom and bottom - margin, top + margin)
    else:
        _say(ax, "no motion")
    ax.set(
        title=f"{str(mesh[name].attrs['long_name']).capitalize()} along the path of contact",
        xlabel=label_of(mesh["path_position"]),
        ylabel=label_of(mesh[name]),
    )
    return ax
