"""The figures of the chapters of Talbot (2012), drawn from what was computed for them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from epicyclic.plots.style import (
    COLOUR_MAP,
    COLOURS,
    LINE_STYLES,
    MARKERS,
    label_of,
    legend_of_figure,
    styled_figure,
)
from epicyclic.units import format_number, unit_text
from epicyclic.validation.chapters import Family, Mark

STARS = ("*", "P", "X")
"""Markers of published numbers."""
SOURCE = "Talbot (2012)"
MOST_COLUMNS = 3
PANEL, ALONE = (4.3, 3.1), (6.4, 4.2)
"""Width and height of one of several panels, and of a single one. [inch]"""
SAME = 0.5
"""Values of panels that differ less are the same, in their unit."""


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
            ax.set_title("published slopes drawn through the mean of the computed tests")
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
