"""Figures of the chapters of Talbot (2012) and of the comparison with published figures."""

from __future__ import annotations

import itertools
import json
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from epicyclic.show.plots.style import (
    COLOUR_MAP,
    COLOURS,
    LINE_STYLES,
    MARKERS,
    label_logarithms,
    label_of,
    legend_of_figure,
    styled_figure,
    write_beside,
)
from epicyclic.study.sweeps.runner import HERE, Runner
from epicyclic.units import format_number, percent, unit_text
from epicyclic.validation import chapters
from epicyclic.validation.chapters import Family, Mark
from epicyclic.validation.compare import Comparison
from epicyclic.validation.pocketing import PublishedStudy, published_study, study_again
from epicyclic.validation.scoreboard import DEFAULTS, Score

# The figures of the chapters of Talbot (2012), drawn from what was computed for them.


STARS = ("*", "P", "X")  # Markers of published numbers.
SOURCE = "Talbot (2012)"
MOST_COLUMNS = 3
PANEL, ALONE = (4.3, 3.1), (6.4, 4.2)
"""Width and height of one of several panels, and of a single one. [inch]"""
SAME = 0.5  # Values of panels that differ less are the same, in their unit.


def family_figure(family: Family) -> Figure:
    """A panel for each value of the first parameter, a curve for each of the second."""
    data = family.data[family.variable]
    panels, curves, over = map(str, data.dims)
    count = data.sizes[panels]
    columns = _columns(count)
    rows = -(-count // columns)
    panel = PANEL if count > 1 else ALONE
    with styled_figure(rows, columns, _title(family), panel=panel) as (figure, axes):
        for number, ax in enumerate(axes.ravel()):
            if number >= count:
                ax.remove()
                continue
            part = data.isel({panels: number})
            for index in range(part.sizes[curves]):
                ax.plot(
                    part[over],
                    part.isel({curves: index}),
                    marker=MARKERS[index % len(MARKERS)],
                    ls=LINE_STYLES[index % len(LINE_STYLES)],
                    ms=4,
                    label=_value(part[curves][index]),
                )
            _mark(family.marks, data[panels][number], ax)
            ax.set(
                title=_described(data[panels][number]),
                xlabel=label_of(part[over]),
                ylabel=label_of(data),
            )
            ax.margins(0.06)
            ax.set_xlim(left=0)
            ax.set_ylim(bottom=0)
        title = str(data[curves].attrs.get("long_name", curves))
        legend_of_figure(figure, figure.axes, title)
    return figure


def branch_figure(family: Family) -> Figure:
    """Loss of a branch over its power in all tests, with its line and the published ones."""
    data = family.data
    with styled_figure(1, 1, _title(family), panel=ALONE) as (figure, axes):
        ax = axes[0, 0]
        for index, name in enumerate(data["set"].values):
            part = data.isel(set=index)
            ax.plot(
                part["branch_power"].values.ravel(),
                part["branch_loss"].values.ravel(),
                ls="none",
                marker=MARKERS[index],
                mfc="none",
                ms=4,
                label=f"{name} planets",
            )
        power = data["branch_power"].values
        ends = np.array([0.0, float(power.max())])
        slope, intercept = data.attrs["slope"], data.attrs["intercept"]
        ax.plot(ends, intercept + slope * ends, color="black", label=f"line, {100 * slope:.4f} %")
        middle = float(power.mean()), float(data["branch_loss"].mean())
        for mark, style in zip(family.marks, ("--", ":"), strict=False):
            line = middle[1] + mark.value / 100 * (ends - middle[0])
            ax.plot(ends, line, color=COLOURS[1], ls=style, label=f"{SOURCE}: {mark.label}")
        ax.set(xlabel=label_of(data["branch_power"]), ylabel=label_of(data["branch_loss"]))
        ax.set_xlim(left=0)
        ax.set_ylim(bottom=0)
        ax.legend(fontsize="small", frameon=False)
        if family.marks:
            ax.set_title("published slopes, drawn through the mean of the computed tests")
    return figure


def roller_figure(figure_name: str, cases: Sequence[tuple[str, xr.Dataset]]) -> Figure:
    """Line load along every roller of both rows, a panel for each case."""
    highest = max(float(data["line_load"].max()) for _, data in cases)
    title = f"{SOURCE}, Fig. {figure_name}: loads on the rollers"
    columns = _columns(len(cases))
    rows = len(cases) // columns
    with styled_figure(rows, columns, title, panel=(3.6, 3.2)) as (figure, axes):
        for ax, (label, data) in zip(axes.ravel(), cases, strict=True):
            races, rollers, slices = data["line_load"].shape
            turned = (data["azimuth"].values + 180.0) % 360.0 - 180.0
            order = np.argsort(turned)
            load = data["line_load"].values[:, order].transpose(0, 2, 1)
            drawn = ax.pcolormesh(
                turned[order],
                data["axial_position"].values.reshape(races * slices),
                load.reshape(races * slices, rollers),
                cmap=COLOUR_MAP,
                vmin=0,
                vmax=highest,
                shading="nearest",
            )
            ax.set(title=label, xlabel="azimuth from the load, deg", ylabel="axial position, mm")
            ax.grid(visible=False)
        figure.colorbar(drawn, ax=axes.ravel().tolist(), label=label_of(cases[0][1]["line_load"]))
    return figure


def _columns(panels: int) -> int:
    return panels if panels <= MOST_COLUMNS else 2


def _title(family: Family) -> str:
    return f"{SOURCE}, Fig. {family.figure}: {family.title}"


def _mark(marks: Sequence[Mark], panel: xr.DataArray, ax: Axes) -> None:
    """The published numbers of a panel."""
    own = [mark for mark in marks if _is_same(mark.panel, panel)]
    for number, mark in enumerate(own):
        ax.plot(
            mark.over,
            mark.value,
            ls="none",
            marker=STARS[number % len(STARS)],
            color=COLOURS[-1],
            mfc="none",
            ms=9,
            zorder=3,
            label=f"{SOURCE}: {mark.label}",
        )


def _is_same(value: float | str, panel: xr.DataArray) -> bool:
    found = panel.item()
    if isinstance(value, str) or isinstance(found, str):
        return bool(found == value)
    return bool(abs(found - value) < SAME)


def _value(coordinate: xr.DataArray) -> str:
    """``"5000 rpm"``"""
    value = coordinate.item()
    if isinstance(value, str):
        return value
    unit = unit_text(str(coordinate.attrs.get("units", "")))
    return f"{format_number(float(value), 5)} {unit}".rstrip()


def _described(coordinate: xr.DataArray) -> str:
    """``"speed of the sun 4000 rpm"``, ``"3 shaved planets"``"""
    words = [str(coordinate.attrs.get("long_name", "")), _value(coordinate)]
    return " ".join(reversed(words) if isinstance(coordinate.item(), str) else words).strip()


# The figures of the parametric study of pocketing losses.

SAME_LINE = 1e-6  # Values that differ less than this are the same. [1]


def study_figure(
    study: xr.Dataset,  # As `epicyclic.pocketing_study` returns it.
    published: PublishedStudy | None = None,  # Marked where it lies.
) -> Figure:
    """Loss over one parameter, a panel and a curve for each value of the others."""
    *panels, _, _ = study["pocketing_loss"].dims
    places = list(itertools.product(*(range(study.sizes[panel]) for panel in panels)))
    exponents = "speed_exponent" in study
    count = len(places) + exponents
    columns = _columns(count)
    rows = -(-count // columns)
    # what all points have in common beside the gears
    oil = json.loads(study.attrs["case"])["operation"]["oil_inlet_temperature"]
    held = unit_text(f"pocketing {study.attrs['model']}, oil at {oil}")
    title = str(study.attrs["title"])
    with styled_figure(rows, columns, title, caption=held) as (figure, axes):
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
        values = {
            "helix_angle": published.helix_angle,
            "face_width": published.face_width,
            "speed": published.speed,
        }
        if _has(loss, values):
            label = f"{SOURCE}, {published.speed:g} rpm"
            ax.plot(
                values[over], published.loss, "*", color=COLOURS[-1], ms=12, label=label, zorder=3
            )
        # Between which losses the axes of the source enclose its curve of the highest speed.
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
                label=f"{SOURCE}, read between ticks of its axes, {published.speed:g} rpm",
            )
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
        label = f"{SOURCE}, 0 deg: {published.exponent:.2f}"
        ax.loglog(speed, line, color="black", ls="--", lw=1.0, label=label)
    label_logarithms(ax.xaxis, ax.yaxis)
    ax.set(title="Exponent of the speed", xlabel=label_of(loss["speed"]))
    ax.set_ylabel("pocketing loss, W")
    ax.legend(title=f"{loss[curves].attrs['long_name']}: exponent", loc="upper left")


def _has(loss: xr.DataArray, values: Mapping[str, float]) -> bool:
    """Whether a panel has a curve and a point of these values."""
    if not values.keys() >= set(loss.coords):
        return False
    return all(
        name in loss.coords
        and bool(np.isclose(np.atleast_1d(loss[name].to_numpy()), value, rtol=SAME_LINE).any())
        for name, value in values.items()
    )


# Every figure of a chapter of Talbot (2012) that is computed again, with its data.


@dataclass(frozen=True)
class Reproduced:
    """A figure of the source, computed again."""

    number: str  # In the source.
    data: xr.Dataset
    picture: Figure


def reproduce(figures: Sequence[str], runner: Runner = HERE) -> Iterator[Reproduced]:
    """Compute and draw figures, ``"3.4"``, published numbers marked on them.

    Raises `ConvergenceError` if a point of chapter 3 or 5 cannot be computed.
    """
    for name in figures:
        if name in chapters.ROLLER_FIGURES:
            cases = chapters.roller_loads_over(name)
            yield Reproduced(name, chapters.joined(cases), roller_figure(name, cases))
    for family in chapters.bearing_families(figures, runner):
        yield Reproduced(family.figure, family.data, family_figure(family))
    case, studies = study_again(figures, runner)
    for name, data in studies.items():
        title = f"{SOURCE}, Fig. {name}: pocketing loss of the mesh of Table 4.1"
        picture = study_figure(data.assign_attrs(title=title), published_study(case))
        yield Reproduced(name, data, picture)
    for family in chapters.set_families(figures, runner):
        draw = branch_figure if "branch_power" in family.data else family_figure
        yield Reproduced(family.figure, family.data, draw(family))


# Published figures beside computed ones: how far off each is, and how far off it may be.

SHOWN = 0.40  # Differences beyond it are drawn at the edge, with their number. [1]
WIDTH, ROW, REST = 8.2, 0.32, 1.0
"""Width of a picture, height of a row, and of what is not rows. [inch]"""
LETTERS = 62  # In one line of a label.
_BAND = "0.85"
_MARKS: dict[str, dict[str, Any]] = {
    "agrees": {"marker": "o", "mfc": COLOURS[0], "color": COLOURS[0]},
    "differs": {"marker": "X", "mfc": COLOURS[1], "color": COLOURS[1]},
    "calibrated": {"marker": "s", "mfc": "none", "color": "0.45"},
    "no verdict": {"marker": "o", "mfc": "none", "color": "0.45"},
}


def deviations_size(rows: Sequence[Comparison]) -> tuple[float, float]:
    """Width and height of the picture of some figures. [inch]"""
    return WIDTH, REST + ROW * len(rows)


def plot_deviations(rows: Sequence[Comparison], ax: Axes) -> Axes:
    """Computed over published less one for each figure, on the band in which it agrees."""
    for place, row in enumerate(rows):
        if row.role == "validation":
            tolerance = 100 * min(row.tolerance, SHOWN)
            ax.barh(place, 2 * tolerance, left=-tolerance, height=0.7, color=_BAND)
        value = 100 * min(max(row.difference, -SHOWN), SHOWN)
        ax.plot(value, place, ls="none", ms=6, **_MARKS[row.verdict])
        text = f"{_number(row)}, {percent(row.difference, signed=True)}"
        write_beside(ax, text, (100 * SHOWN, place), gap=6, annotation_clip=False)
    ax.axvline(0.0, color="black", lw=0.8)
    ax.set_yticks(range(len(rows)), ["\n".join(textwrap.wrap(row.what, LETTERS)) for row in rows])
    ax.tick_params(axis="y", labelsize="small")
    ax.set_xlim(-105 * SHOWN, 105 * SHOWN)
    ax.set_ylim(len(rows) - 0.4, -0.6)
    ax.grid(visible=False, axis="y")
    ax.set_xlabel("computed over published, difference in %")
    seen = dict.fromkeys(row.verdict for row in rows)
    handles: list[Line2D | Patch] = [
        Line2D([], [], ls="none", ms=6, label=verdict, **_MARKS[verdict]) for verdict in seen
    ]
    if any(row.role == "validation" and row.tolerance > 0 for row in rows):
        handles.append(Patch(facecolor=_BAND, label="tolerance"))
    ax.figure.legend(handles=handles, loc="outside lower center", ncols=5, frameon=False)
    return ax


def _number(row: Comparison) -> str:
    """The published value with its unit."""
    low, high = format_number(row.low, 4), format_number(row.high, 4)
    value = low if low == high else f"{low} to {high}"
    return f"{value} {unit_text(row.unit)}".rstrip()


# Measured sets: computed against measured, and the error over speed.

NEAR = 15  # Errors up to which a model is near, as the picture shows. [%]


def scores_figure(scores: Sequence[Score]) -> Figure:
    """Every set with the defaults: computed over measured values, and errors over speed."""
    drawn = [score for score in scores if score.run == DEFAULTS]
    with styled_figure(1, 2, "Measured by others, computed", panel=(5.6, 4.2)) as (figure, axes):
        left, right = axes[0]
        left.set(xscale="log", yscale="log")
        right.set(xscale="log")
        for number, score in enumerate(drawn):
            own, mean = score.set, float(score.set.measured.mean())
            row, place = divmod(number, len(COLOURS))
            style: dict[str, Any] = {
                "ls": "none",
                "ms": 5,
                "color": COLOURS[place],
                "marker": MARKERS[(place + row) % len(MARKERS)],
                "mfc": "none" if row else COLOURS[place],
            }
            spread = np.abs(score.band - score.computed) / mean
            across = np.abs(own.ends - own.measured) / mean
            left.errorbar(
                own.measured / mean, score.computed / mean, spread, across, elinewidth=0.5, **style
            )
            speeds = score.speeds
            if speeds is not None:
                right.plot(speeds, 100 * score.errors, label=own.name, **style)
            else:
                right.plot([], [], label=own.name, **style)
        ends = np.array([0.2, 5.0])
        for share in (-NEAR, 0, NEAR):
            left.plot(
                ends, ends * (1 + share / 100), color="0.5", lw=0.8, ls="--" if share else "-"
            )
            right.axhline(share, color="0.5", lw=0.8, ls="--" if share else "-")
        left.set(
            xlim=ends,
            ylim=ends,
            xlabel="measured, over the mean of its set",
            ylabel="computed with its 95 % band, over the same mean",
        )
        right.set(xlabel="speed, rpm", ylabel="error, % of the measured value")
        label_logarithms(left.xaxis, left.yaxis, right.xaxis)
        legend_of_figure(figure, [right], f"dashed: errors of {NEAR} %")
    return figure
