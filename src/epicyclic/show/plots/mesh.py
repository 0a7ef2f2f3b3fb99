"""A loaded mesh, a planet bearing, and friction models beside each other."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Normalize, TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from epicyclic.arrays import FloatArray
from epicyclic.show.plots.style import (
    COLOUR_MAP,
    COLOURS,
    LINE_STYLES,
    closed_period,
    label_of,
    labelled,
    legend_below,
    styled_figure,
    title_of,
    write_beside,
)
from epicyclic.study.friction import FrictionComparison, recommended
from epicyclic.units import decimals_of

CIRCLES = 4  # Most circles that the scale of loads has.
SEEN = 0.02  # Share of the highest load from which on a bar is seen. [1]
STEP = 7.5  # Between the directions that are tried for the scale of loads. [deg]
DOWN = 0.1
"""How much farther from all bars the scale must be for turning it away from straight down. [1]"""
HATCHES = ("", "///", "...", "xxx", "\\\\\\", "+++")


def plot_roller_loads(bearing: xr.Dataset, ax: Axes) -> Axes:
    """Load of every roller over its azimuth from the load, rows side by side, on polar Axes."""
    if not isinstance(ax, PolarAxes):
        raise TypeError("loads of rollers are drawn on polar Axes")
    rows, rollers = bearing.sizes["row"], bearing.sizes["roller"]
    room = 2 * math.pi / rollers
    width = 0.8 * room / rows
    azimuth = bearing["azimuth"].to_numpy() * math.pi / 180
    for number in range(rows):
        ax.bar(
            azimuth + (number - (rows - 1) / 2) * width,
            bearing["load"].to_numpy()[number],
            width=width,
            color=COLOURS[number % len(COLOURS)],
            edgecolor="black",
            linewidth=0.5,
            hatch=HATCHES[number % len(HATCHES)],
            label=f"row {bearing['row'].values[number]}",
        )
    ax.set_theta_zero_location("N")
    ax.set_rlabel_position(_emptiest(azimuth, bearing["load"].to_numpy()))
    ax.yaxis.set_major_locator(MaxNLocator(CIRCLES))
    ax.set_title(f"Load of each roller, {label_of(bearing['load']).rpartition(', ')[2]}")
    ax.set_xlabel("azimuth from the load on the planet, degrees")
    if rows > 1:
        ax.legend(loc="upper left", bbox_to_anchor=(1.05, 1.0), fontsize="small")
    return ax


def _emptiest(
    azimuth: FloatArray,  # [rad]
    load: FloatArray,  # [N]
) -> float:
    """The direction that is farthest from all rollers that carry, in doubt downwards. [deg]"""
    carrying = azimuth[(load > SEEN * load.max()).any(axis=0)]
    places = np.radians(np.arange(0.0, 360.0, STEP))
    apart = np.abs(np.angle(np.exp(1j * (places[:, None] - carrying))))
    free = apart.min(axis=1, initial=math.pi) - DOWN * np.abs(np.angle(-np.exp(1j * places)))
    return float(np.degrees(places[np.argmax(free)]))


def plot_roller_profile(bearing: xr.Dataset, ax: Axes) -> Axes:
    """Hertz pressure along the most loaded roller of every row."""
    for number in range(bearing.sizes["row"]):
        row = bearing.isel(row=number)
        most = int(np.argmax(row["load"].to_numpy()))
        ax.plot(
            row["axial_position"],
            row["pressure"].isel(roller=most),
            color=COLOURS[number % len(COLOURS)],
            ls=LINE_STYLES[number % len(LINE_STYLES)],
            marker=".",
            label=f"row {row['row'].item()}, roller {most + 1}",
        )
    ax.set_ylim(bottom=0.0)
    legend_below(ax, ncols=2)
    title = "Pressure along the most loaded rollers"
    return labelled(ax, bearing["axial_position"], bearing["pressure"], title)


# A loaded mesh: where the teeth carry, how they share, how they slide.
#
# All functions take one mesh as `epicyclic.mesh_details` returns it, draw on given Axes and return
# them.

FRICTION = "friction_coefficient"
MAPS = ("line_load", "hertz_pressure", "sliding_speed", "friction_power", "film_ratio")
"""Variables drawn over the plane of action."""
BOTH_WAYS = (FRICTION, "flash_temperature")  # Those drawn along the path of contact too.
SAME = 1e-9  # Relative difference of coefficients of friction that are one number.
NO_PEAK, PEAKED = 0.95, 1.15
"""Half of a scale of colours ends at this quantile where the highest value is more than so many
times it: peaks at corners would take the scale from all the rest."""
MARGIN = 0.06  # Above a curve, of the height of the Axes.
PATH_PLACES = 40  # Places on the path of contact at which values are taken together.


def mesh_figure(mesh: xr.Dataset) -> Figure:
    """Everything an engineer looks at on one mesh, in two columns: letters stay readable."""
    with styled_figure(6, 2, str(mesh.attrs["title"])) as (figure, axes):
        flat = axes.ravel()
        plot_pair_loads(mesh, flat[0])
        plot_over_period(mesh, "transmission_error", flat[1])
        plot_over_period(mesh, "mesh_stiffness", flat[2])
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
    ax.axvline(0.0, color="black", lw=0.8, ls="--")
    return labelled(ax, mesh["path_position"], mesh["face_position"], title_of(mesh[name]))


def _draw_map(ax: Axes, path: FloatArray, face: FloatArray, values: FloatArray, label: str) -> None:
    # triangles between the points, in coordinates of like size so that they are not slivers
    scale = np.ptp(path) / np.ptp(face)
    corners = Triangulation(path, face, Triangulation(path, face * scale).triangles)
    norm = scale_of(values, float(values.min()))
    drawn = ax.tripcolor(
        corners, values, shading="gouraud", cmap=COLOUR_MAP, rasterized=True, norm=norm
    )
    ax.figure.colorbar(drawn, ax=ax, label=label)


def scale_of(values: FloatArray, low: float) -> Normalize:
    """A scale of colours to the highest value; where that is a peak, it has half the colours."""
    highest, limit = float(values.max()), float(np.quantile(values, NO_PEAK))
    if highest > PEAKED * limit > PEAKED * max(0.0, low):
        return TwoSlopeNorm(limit, low, highest)
    return Normalize(low, highest)


def _say(ax: Axes, text: str) -> None:
    """Words instead of a drawing."""
    ax.text(0.5, 0.5, text, ha="center", transform=ax.transAxes)


def plot_pair_loads(mesh: xr.Dataset, ax: Axes) -> Axes:
    """Load of every tooth pair over the roll angle of member 1, through its whole engagement."""
    angle = mesh["roll_angle"] + mesh["contact_line"] * float(mesh.attrs["pitch_angle_deg"])
    order = ("contact_line", "mesh_position")
    angles, loads = (one.transpose(*order).to_numpy().ravel() for one in (angle, mesh["pair_load"]))
    carrying = np.flatnonzero(loads > 0)
    shown = slice(None) if not carrying.size else slice(max(0, carrying[0] - 1), carrying[-1] + 2)
    ax.plot(angles[shown], loads[shown], marker=".", ms=3)
    ax.set_ylim(bottom=0.0)
    title = "Load of one tooth pair through its engagement"
    return labelled(ax, mesh["roll_angle"], mesh["pair_load"], title)


def plot_over_period(mesh: xr.Dataset, name: str, ax: Axes) -> Axes:
    """Loaded transmission error or mesh stiffness, by its `name`, over one mesh period."""
    values = mesh[name].to_numpy()
    if np.isfinite(values).any():
        pitch = float(mesh.attrs["pitch_angle_deg"])
        ax.plot(*closed_period(mesh["roll_angle"].to_numpy(), values, pitch), marker=".", ms=3)
    else:
        _say(ax, "not available with this load distribution")
    return labelled(ax, mesh["roll_angle"], mesh[name])


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
            label = "one mean value for the whole mesh; the model gives no other"
            ax.plot(middle, mean, label=label)
        elif (high - low).max() <= 2 * np.ptp(mean) / len(mean):  # the same across the face
            ax.plot(middle, mean)
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
    title = f"{title_of(mesh[name])} along the path of contact"
    return labelled(ax, mesh["path_position"], mesh[name], title)


ROW_HEIGHT = 0.3  # Height of one bar. [inch]
ROOM = 1.45  # Length of the axis over that of the longest bar, for the words beside the bars. [1]
COLOUR, OTHER = COLOURS[0], "0.75"


def friction_figure(rows: Sequence[FrictionComparison], title: str) -> Figure:
    """The sliding loss with every friction model."""
    with styled_figure(1, 1, title, panel=(7.6, 1.6 + ROW_HEIGHT * len(rows))) as (figure, axes):
        plot_friction_models(rows, axes[0, 0])
    return figure


def plot_friction_models(rows: Sequence[FrictionComparison], ax: Axes) -> Axes:
    """A bar for each model; hatched as far as the loss is outside its range."""
    best, _ = recommended(rows)
    digits = decimals_of(max(row.sliding for row in rows))
    for place, row in enumerate(rows):
        colour = OTHER if row.other_oil else COLOUR
        inside = row.sliding * (1 - row.outside)
        ax.barh(place, inside, color=colour, edgecolor="black", linewidth=0.5)
        ax.barh(
            place,
            row.sliding - inside,
            left=inside,
            color="white",
            hatch="////",
            edgecolor=colour,
            linewidth=1.0,
        )
        marks = {
            "chosen": row.chosen,
            "recommended": row is best,
            "made for another oil": row.other_oil,
        }
        kept = (mark for mark, holds in marks.items() if holds)
        text = ", ".join([f"{row.sliding:.{digits}f} W", *kept])
        write_beside(ax, text, (row.sliding, place), fontweight="bold" if row.chosen else "normal")
    ax.set_yticks(range(len(rows)), [row.name for row in rows])
    ax.invert_yaxis()
    ax.grid(visible=False, axis="y")
    ax.set_xlim(0, ROOM * max(row.sliding for row in rows) or 1.0)
    ax.set(title="Sliding loss by friction model", xlabel="sliding loss of all meshes, W")
    handles = [
        Patch(facecolor=COLOUR, edgecolor="black", label="for this oil, or for any"),
        Patch(facecolor=OTHER, edgecolor="black", label="made for another oil"),
        Patch(facecolor="white", edgecolor=COLOUR, hatch="////", label="outside its range"),
    ]
    legend_below(ax, handles=handles, ncols=3)
    return ax
