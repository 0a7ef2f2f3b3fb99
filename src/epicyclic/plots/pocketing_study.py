"""The figures of the parametric study of pocketing losses."""

from __future__ import annotations

import itertools
import json
from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from epicyclic.plots.style import (
    COLOURS,
    MARKERS,
    label_logarithms,
    label_of,
    legend_of_figure,
    styled_figure,
)
from epicyclic.units import format_number, unit_text
from epicyclic.validation.pocketing import PublishedStudy

PUBLISHED = "Talbot (2012)"
MOST_COLUMNS = 3
SAME = 1e-6
"""Values that differ less than this are the same. [1]"""


def study_figure(
    study: xr.Dataset,  # As `epicyclic.pocketing_study` returns it.
    published: PublishedStudy | None = None,  # Marked where it lies.
) -> Figure:
    """Loss over one parameter, a panel and a curve for each value of the others."""
    *panels, _, _ = study["pocketing_loss"].dims
    places = list(itertools.product(*(range(study.sizes[panel]) for panel in panels)))
    exponents = "speed_exponent" in study
    count = len(places) + exponents
    columns = count if count <= MOST_COLUMNS else 2
    rows = -(-count // columns)
    title = str(study.attrs["title"])
    with styled_figure(rows, columns, title, caption=_held(study)) as (figure, axes):
        flat = axes.ravel()
        for ax, place in zip(flat, places, strict=False):
            _plot_loss(study.isel(dict(zip(panels, place, strict=True))), ax, published)
        if exponents:
            _plot_exponents(study, flat[1], published)
        for ax in flat[count:]:
            ax.remove()
        curves = study[study["pocketing_loss"].dims[-2]]
        legend_of_figure(figure, flat[: len(places)], str(curves.attrs["long_name"]))
    return figure


def _held(study: xr.Dataset) -> str:
    """What all points of a study have in common beside the gears."""
    oil = json.loads(study.attrs["case"])["operation"]["oil_inlet_temperature"]
    return unit_text(f"pocketing {study.attrs['model']}, oil at {oil}")


def _plot_loss(study: xr.Dataset, ax: Axes, published: PublishedStudy | None) -> None:
    """One panel: all other parameters of `study` but the last two have one value."""
    loss = study["pocketing_loss"]
    curves, over = map(str, loss.dims)
    for number in range(loss.sizes[curves]):
        curve = loss.isel({curves: number})
        ax.plot(
            loss[over],
            curve,
            marker=MARKERS[number % len(MARKERS)],
            ms=4,
            label=_value(loss[curves][number]),
        )
    if published is not None:
        _mark(loss, over, ax, published)
        _mark_bands(loss, over, ax, published)
    held = [_described(study[name]) for name in study.coords if study[name].ndim == 0]
    ax.set(title=", ".join(held) or "Loss", xlabel=label_of(loss[over]), ylabel="pocketing loss, W")
    ax.set_ylim(bottom=0)


def _plot_exponents(study: xr.Dataset, ax: Axes, published: PublishedStudy | None) -> None:
    """Loss over speed in logarithms, with the slope of each curve."""
    loss = study["pocketing_loss"]
    curves = str(loss.dims[0])
    for number in range(loss.sizes[curves]):
        slope = float(study["speed_exponent"][number])
        ax.loglog(
            loss["speed"],
            loss[number],
            marker=MARKERS[number % len(MARKERS)],
            ms=4,
            label=f"{_value(loss[curves][number])}: {slope:.2f}",
        )
    if published is not None and float(loss[curves][0]) == 0.0:
        speed = loss["speed"].to_numpy()
        # through the middle of the curve in logarithms, where lines of all slopes cross
        scale = np.exp(np.log(loss[0]).mean() - published.exponent * np.log(speed).mean())
        line = float(scale) * speed**published.exponent
        label = f"{PUBLISHED}, 0 deg: {published.exponent:.2f}"
        ax.loglog(speed, line, color="black", ls="--", lw=1.0, label=label)
    label_logarithms(ax.xaxis, ax.yaxis)
    ax.set(title="Exponent of the speed", xlabel=label_of(loss["speed"]))
    ax.set_ylabel("pocketing loss, W")
    ax.legend(title=f"{loss[curves].attrs['long_name']}: exponent", loc="upper left")


def _mark(loss: xr.DataArray, over: str, ax: Axes, published: PublishedStudy) -> None:
    """The published loss, if it belongs to this panel and one of its curves."""
    values = {
        "helix_angle": published.helix_angle,
        "face_width": published.face_width,
        "speed": published.speed,
    }
    if not _has(loss, values):
        return
    ax.plot(
        values[over],
        published.loss,
        "*",
        color=COLOURS[-1],
        ms=12,
        label=f"{PUBLISHED}, {published.speed:g} rpm",
        zorder=3,
    )


def _mark_bands(loss: xr.DataArray, over: str, ax: Axes, published: PublishedStudy) -> None:
    """Between which losses the axes of the source enclose its curve of the highest speed."""
    for helix, width, low, high in published.bands:
        values = {"helix_angle": helix, "face_width": width, "speed": published.speed}
        if not _has(loss, values):
            continue
        ax.errorbar(
            values[over],
            (low + high) / 2,
            yerr=(high - low) / 2,
            ls="none",
            color=COLOURS[-1],
            capsize=4,
            lw=1.2,
            zorder=3,
            label=f"{PUBLISHED}, between ticks of its axes, {published.speed:g} rpm",
        )


def _has(loss: xr.DataArray, values: Mapping[str, float]) -> bool:
    """Whether a panel has a curve and a point of these values."""
    if not values.keys() >= set(loss.coords):
        return False
    return all(
        name in loss.coords
        and bool(np.isclose(np.atleast_1d(loss[name].to_numpy()), value, rtol=SAME).any())
        for name, value in values.items()
    )


def _value(coordinate: xr.DataArray) -> str:
    """``"5000 rpm"``"""
    number = format_number(float(coordinate), 5)
    return f"{number} {unit_text(str(coordinate.attrs['units']))}".rstrip()


def _described(coordinate: xr.DataArray) -> str:
    return f"{coordinate.attrs['long_name']} {_value(coordinate)}"
