"""Figures of the chapters of Talbot (2012) and of the comparison with published figures."""

from __future__ import annotations

import itertools
import json
import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from epicyclic.dataclass import dataclass
from epicyclic.show.page import shown
from epicyclic.show.plots.style import (
    COLOUR_MAP,
    COLOURS,
    LINE_STYLES,
    MARKERS,
    label_logarithms,
    label_of,
    legend_of_figure,
    place_text,
    styled_figure,
    write_beside,
)
from epicyclic.study.sweeps.runner import HERE, Runner
from epicyclic.units import percent, unit_text
from epicyclic.validation import chapters
from epicyclic.validation.chapters import Family, Mark
from epicyclic.validation.compare import Comparison, Published
from epicyclic.validation.pocketing import PublishedStudy, published_study, study_again
from epicyclic.validation.scoreboard import DEFAULTS, Score

STARS = ("*", "P", "X", "D", "h")  # Markers of published numbers.
SOURCE = "Talbot (2012)"
MOST_COLUMNS = 3
PANEL, ALONE = (4.3, 3.1), (6.4, 4.2)
"""Width and height of one of several panels, and of a single one. [inch]"""
SAME = 0.5  # Values of panels that differ less are the same, in their unit.


def family_figure(family: Family) -> Figure:
    """A panel for each variable and value of its first parameter, a curve for each second one."""
    places = [
        (array.isel({array.dims[0]: index}) if array.ndim > 2 else array)
        for array in family.data.data_vars.values()
        for index in range(array.shape[0] if array.ndim > 2 else 1)
    ]
    count = len(places)
    panel = PANEL if count > 1 else ALONE
    with styled_figure(*_grid(count), _title(family), panel=panel, count=count) as (figure, axes):
        for ax, part in zip(axes.flat, places, strict=False):
            curves, over = map(str, part.dims)
            for index, curve in enumerate(part):
                if np.isnan(curve).all():
                    continue
                colour = COLOURS[index % len(COLOURS)]
                style = LINE_STYLES[index % len(LINE_STYLES)]
                _plot_curve(ax, curve, index, place_text(curve[curves], 5), color=colour, ls=style)
            held = [part[name] for name in part.coords if part[name].ndim == 0]
            _mark(family.marks, part, held, ax)
            title = ", ".join(map(_described, held)) or str(part.attrs["long_name"])
            ax.set(title=title, xlabel=label_of(part[over]), ylabel=label_of(part))
            ax.margins(0.06)
            ax.set_xlim(left=0)
            if part.attrs["units"] not in ("%", "degC"):
                ax.set_ylim(bottom=0)
        title = str(places[0][places[0].dims[0]].attrs.get("long_name", ""))
        legend_of_figure(figure, figure.axes, title)
    return figure


def branch_figure(family: Family) -> Figure:
    """Loss of a branch over its power in all tests, by speed, its lines and the published ones."""
    data = family.data
    with styled_figure(1, 1, _title(family), panel=ALONE) as (figure, axes):
        ax = axes[0, 0]
        over, loss = data["over"], data["branch_loss"]
        for index, speed in enumerate(data["speed"]):
            part = data.sel(speed=speed)
            ax.plot(
                part["over"].values.ravel(),
                part["branch_loss"].values.ravel(),
                ls="none",
                marker=MARKERS[index],
                color=COLOURS[index],
                mfc="none",
                ms=4,
                label=place_text(speed, 5),
            )
        ends = np.array([0.0, float(over.max())])
        middle = float(over.mean()), float(loss.mean())
        for (name, slope), style in zip(data.attrs.items(), ("-", "-."), strict=False):
            through = middle if name == "with intercept" else (0.0, 0.0)
            line = through[1] + slope / 100 * (ends - through[0])
            ax.plot(ends, line, color="black", ls=style, label=f"line {name}, {slope:.4f} %")
        for mark, style in zip(family.marks, ("--", ":"), strict=False):
            line = middle[1] + mark.value / 100 * (ends - middle[0])
            ax.plot(ends, line, color=COLOURS[1], ls=style, label=f"{SOURCE}: {mark.label}")
        ax.set(xlabel=label_of(over), ylabel=label_of(loss))
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
    with styled_figure(*_grid(len(cases)), title, panel=(3.6, 3.2)) as (figure, axes):
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


def _plot_curve(ax: Axes, curve: xr.DataArray, number: int, label: str, **style: Any) -> None:
    marker = MARKERS[number % len(MARKERS)]
    ax.plot(curve[curve.dims[0]], curve, marker=marker, ms=4, label=label, **style)


def _grid(panels: int) -> tuple[int, int]:
    """Rows and columns of a figure of some panels."""
    columns = panels if panels <= MOST_COLUMNS else 2
    return math.ceil(panels / columns), columns


def _title(family: Family) -> str:
    return f"{SOURCE}, Fig. {family.figure}: {family.title}"


def _mark(
    marks: Sequence[Mark], part: xr.DataArray, held: Sequence[xr.DataArray], ax: Axes
) -> None:
    """The published numbers of a panel."""
    labels = list(dict.fromkeys(mark.label for mark in marks))
    for mark in marks:
        panel = mark.panel is None or any(_is_same(mark.panel, own) for own in held)
        if mark.variable != part.name or not panel:
            continue
        number = labels.index(mark.label)
        style: dict[str, Any] = {"color": COLOURS[-1], "label": f"{SOURCE}: {mark.label}"}
        if mark.over is None:
            ax.axhline(mark.value, ls=LINE_STYLES[number % len(LINE_STYLES)], **style)
            continue
        ax.plot(
            mark.over,
            mark.value,
            ls="none",
            marker=STARS[number % len(STARS)],
            mfc="none",
            ms=9,
            zorder=3,
            **style,
        )


def _is_same(value: float | str, panel: xr.DataArray) -> bool:
    found = panel.item()
    if isinstance(value, str) or isinstance(found, str):
        return bool(found == value)
    return bool(abs(found - value) < SAME)


def _described(coordinate: xr.DataArray) -> str:
    """``"speed of the sun 4000 rpm"``, ``"3 shaved planets"``"""
    words = [str(coordinate.attrs.get("long_name", "")), place_text(coordinate, 5)]
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
    # what all points have in common beside the gears
    oil = json.loads(study.attrs["case"])["operation"]["oil_inlet_temperature"]
    held = unit_text(f"pocketing {study.attrs['model']}, oil at {oil}")
    title = str(study.attrs["title"])
    with styled_figure(*_grid(count), title, caption=held, count=count) as (figure, axes):
        flat = axes.ravel()
        for ax, place in zip(flat, places, strict=False):
            _plot_loss(study.isel(dict(zip(panels, place, strict=True))), ax, published)
        if exponents:
            _plot_exponents(study, flat[1], published)
        curves = study[study["pocketing_loss"].dims[-2]]
        legend_of_figure(figure, flat[: len(places)], str(curves.attrs["long_name"]))
    return figure


def _plot_loss(study: xr.Dataset, ax: Axes, published: PublishedStudy | None) -> None:
    """One panel: all other parameters of `study` but the last two have one value."""
    loss = study["pocketing_loss"]
    curves, over = map(str, loss.dims)
    for number, curve in enumerate(loss):
        _plot_curve(ax, curve, number, place_text(curve[curves], 5))
    own = {} if published is None else published.own
    for mark in () if published is None else published.marks:
        if not all(_has(loss, place, own) for place in (mark.place, mark.base) if place):
            continue
        of = 1.0 if mark.base is None else _at(loss, mark.base)
        low, high = (of * end for end in mark.ends)
        how = "" if mark.base is None else ", printed ratio, over the computed loss"
        how = how if low == high else ", read between ticks of its axes"
        ax.errorbar(
            mark.place[over],
            (low + high) / 2,
            yerr=(high - low) / 2 or None,
            ls="none",
            marker=None if low < high else "*" if mark.base is None else "P",
            mfc="none",
            ms=9,
            color=COLOURS[-1],
            capsize=4,
            lw=1.2,
            zorder=3,
            label=f"{SOURCE}, {mark.place['speed']:g} rpm{how}",
        )
    held = [_described(study[name]) for name in study.coords if study[name].ndim == 0]
    ax.set(title=", ".join(held) or "Loss", xlabel=label_of(loss[over]), ylabel="pocketing loss, W")
    ax.set_ylim(bottom=0)


def _plot_exponents(study: xr.Dataset, ax: Axes, published: PublishedStudy | None) -> None:
    """Loss over speed in logarithms, with the slope of each curve."""
    loss = study["pocketing_loss"]
    curves = str(loss.dims[0])
    ax.set(xscale="log", yscale="log")
    for number, curve in enumerate(loss):
        slope = float(study["speed_exponent"][number])
        _plot_curve(ax, curve, number, f"{place_text(curve[curves], 5)}: {slope:.2f}")
    known = published.exponents if published is not None and curves == "helix_angle" else {}
    for (angle, exponent), style in zip(known.items(), ("--", ":"), strict=False):
        if angle not in loss[curves]:
            continue
        curve, speed = loss.sel({curves: angle}), loss["speed"].to_numpy()
        # through the middle of the curve in logarithms, where lines of all slopes cross
        scale = np.exp(np.log(curve).mean() - exponent * np.log(speed).mean())
        label = f"{SOURCE}, {angle:g} deg: {exponent:.2f}"
        ax.plot(speed, float(scale) * speed**exponent, color="black", ls=style, label=label)
    label_logarithms(ax.xaxis, ax.yaxis)
    ax.set(title="Exponent of the speed", xlabel=label_of(loss["speed"]))
    ax.set_ylabel("pocketing loss, W")
    ax.legend(title=f"{loss[curves].attrs['long_name']}: exponent", loc="upper left")


def _has(loss: xr.DataArray, place: Mapping[str, float], own: Mapping[str, float]) -> bool:
    """Whether a panel has a curve and a point of these values; `own` are those of the case."""
    values = {name: loss[name].to_numpy() for name in map(str, loss.coords)}
    return values.keys() <= place.keys() and all(
        np.isclose(np.atleast_1d(values.get(name, own[name])), value, rtol=SAME_LINE).any()
        for name, value in place.items()
    )


def _at(loss: xr.DataArray, place: Mapping[str, float]) -> float:
    wanted = {name: place[str(name)] for name in loss.dims}
    return float(loss.sel(wanted, method="nearest"))


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
    for family in (*chapters.set_families(figures, runner), *chapters.warm_up_families(figures)):
        draw = branch_figure if "branch_loss" in family.data else family_figure
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
        published = f"{published_text(row)} {unit_text(row.unit)}".rstrip()
        text = f"{published}, {percent(row.difference, signed=True)}"
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


def published_text(row: Published) -> str:
    """The published value, or the ends of its range."""
    low, high = shown(row.low), shown(row.high)
    return low if low == high else f"{low} to {high}"


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
            known = score.speeds is not None
            places: tuple[Any, Any] = (score.speeds, 100 * score.errors) if known else ([], [])
            right.plot(*places, label=own.name, **style)
        ends = np.array([0.2, 5.0])
        for share in (-NEAR, 0, NEAR):
            style = {"color": "0.5", "lw": 0.8, "ls": "--" if share else "-"}
            left.plot(ends, ends * (1 + share / 100), **style)
            right.axhline(share, **style)
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
