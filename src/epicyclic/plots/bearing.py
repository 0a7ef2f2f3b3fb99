"""Planet bearing: which rollers carry, and where along their length."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from epicyclic.plots.style import COLOURS, LINE_STYLES, label_of, legend_below

Floats = NDArray[np.float64]

CIRCLES = 4
"""Most circles that the scale of loads has."""
SEEN = 0.02
"""Share of the highest load from which on a bar is seen. [1]"""
STEP = 7.5
"""Between the directions that are tried for the scale of loads. [deg]"""
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
    azimuth: Floats,  # [rad]
    load: Floats,  # [N]
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
    ax.set(
        title="Pressure along the most loaded rollers",
        xlabel=label_of(bearing["axial_position"]),
        ylabel=label_of(bearing["pressure"]),
    )
    ax.set_ylim(bottom=0.0)
    legend_below(ax, ncols=2)
    return ax
