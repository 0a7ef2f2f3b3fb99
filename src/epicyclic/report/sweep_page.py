"""The report of a sweep: its chapters."""

from __future__ import annotations

import numpy as np
import xarray as xr

from epicyclic.errors import Status
from epicyclic.report.explorer import EXPLORER_LEAD, explorer_items
from epicyclic.report.inputs import input_tables
from epicyclic.report.map_page import validity_items, versions_of
from epicyclic.report.page import Cell, Drawings, KeyFigure, Section, Table, gallery, number
from epicyclic.show.plots.sweep import LEFT_OUT, shown_results
from epicyclic.study.maps.tables import map_inputs
from epicyclic.units import format_number, unit_text

MOST_ROWS = 12
"""Most rows of the table of points."""
_POINTS_LEAD = "The points with the least total loss, and the one with the largest."


def sweep_key_figures(data: xr.Dataset) -> list[KeyFigure]:
    """What a reader looks for first."""
    failed = int((data["status"] != Status.CONVERGED).sum())
    figures = [KeyFigure("points", number(data["total"].size, ""))]
    if failed:
        figures.append(KeyFigure("failed points", number(failed, "")))
    for label, value in (
        ("least loss", data["total"].min()),
        ("largest loss", data["total"].max()),
    ):
        if np.isfinite(value):
            figures.append(KeyFigure(label, number(float(value), ""), "W"))
    if "efficiency" in shown_results(data):
        best = float(data["efficiency"].max())
        figures.append(
            KeyFigure("best efficiency", number(best, "", text=f"{100 * best:.2f}"), "%")
        )
    return figures


def sweep_sections(data: xr.Dataset, shown: xr.Dataset, drawings: Drawings) -> list[Section]:
    """All chapters of a sweep, of which `shown` are the points that the page has room for."""
    inputs = map_inputs(data)
    some = _left_out(shown)
    sections = [
        Section("explorer", "Explorer", explorer_items(shown), f"{EXPLORER_LEAD} {some}".strip()),
        Section("lines", "Over the varied keys", gallery(drawings, "lines", "contours"), some),
        Section("all", "Point by point", gallery(drawings, "parallel", wide=True), some),
        Section("points", "Least loss", _points(data), _POINTS_LEAD),
        Section("validity", "Validity", validity_items(data)),
        Section("inputs", "Inputs", tuple(input_tables(inputs, inputs)), _INPUT_LEAD),
        Section("versions", "Versions", (versions_of(data),)),
    ]
    return [section for section in sections if section.items]


def _left_out(shown: xr.Dataset) -> str:
    """How many points pictures leave out, and where all are; nothing if there are none."""
    left_out = shown.attrs.get(LEFT_OUT, 0)
    if not left_out:
        return ""
    size = shown["total"].size
    return (
        f"Of {size + left_out} points {size} are shown, at evenly spaced values of each key and "
        f"those of the least loss; {left_out} are left out. Key figures, least losses and validity "
        "are those of all points, which are in the file of the sweep."
    )


_INPUT_LEAD = "The case before anything was varied."


def _points(data: xr.Dataset) -> tuple[Table, ...]:
    """The points with the least loss, and the one with the largest."""
    total = data["total"].to_numpy()
    known = np.argsort(total, axis=None, kind="stable")[: int(np.isfinite(total).sum())]
    if not known.size:
        return ()
    chosen = known if known.size <= MOST_ROWS else [*known[: MOST_ROWS - 1], known[-1]]
    places = [np.unravel_index(one, total.shape) for one in chosen]
    dims = [str(dim) for dim in data["total"].dims]
    results = shown_results(data)
    head = (*(_head(data[name]) for name in dims), *(_head(data[name]) for name in results))
    rows = tuple(
        (
            *(_coordinate(data[name], at) for name, at in zip(dims, place, strict=True)),
            *(_result(data[name], place) for name in results),
        )
        for place in places
    )
    return (Table(head, rows),)


def _head(array: xr.DataArray) -> str:
    unit = "%" if array.name == "efficiency" else unit_text(str(array.attrs.get("units", "1")))
    label = str(array.attrs.get("long_name", array.name))
    return f"{label}, {unit}" if unit else label


def _coordinate(axis: xr.DataArray, at: int) -> Cell:
    value = axis.values[at]
    if axis.dtype.kind not in "fiu":
        return Cell(str(value))
    return number(float(value), "", text=format_number(float(value)))


def _result(array: xr.DataArray, place: tuple[int, ...]) -> Cell:
    value = float(array.values[place])
    key = f"{array.name}[{','.join(map(str, place))}]"
    text = f"{100 * value:.2f}" if array.name == "efficiency" else ""
    return number(value, key, text=text)
