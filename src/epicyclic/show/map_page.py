"""The reports of a loss map and of a sweep: their chapters."""

from __future__ import annotations

import json
import re
from collections import Counter

import numpy as np
import xarray as xr

from epicyclic.errors import Status
from epicyclic.show.explorer import EXPLORER_LEAD, explorer_items
from epicyclic.show.inputs import input_tables
from epicyclic.show.page import (
    MISSING,
    Cell,
    Drawings,
    Item,
    KeyFigure,
    Listing,
    Section,
    Table,
    gallery,
    number,
)
from epicyclic.show.plots.loss_map import at_temperatures, left_out_line, map_at
from epicyclic.show.plots.sweep import LEFT_OUT, shown_results
from epicyclic.show.result_page import versions_line
from epicyclic.show.uncertainty_tables import grid_table, uncertainty_items
from epicyclic.study.friction import methods_of
from epicyclic.study.maps.tables import map_case, map_inputs, statements
from epicyclic.study.operating import AXES
from epicyclic.units import format_number, unit_text

# The report of a loss map: its chapters.


_WHITE = "White: no power is passed on, or the point failed."
_FOUND = re.compile(r"(Out of range: .*?) -?\d[^;]*;")
_SMALL = "Out of range, each"  # Begins the warning that puts together what matters little.
_QUANTITY = re.compile(r" -?\d.*")
_NUMBER = re.compile(r"-?\d[\d.]*(e[+-]?\d+)?")
GRIDS = {"efficiency": "Efficiency, %", "total": "Total loss, W"}
"""Variables of which there are tables of values."""


def _counts(data: xr.Dataset) -> list[KeyFigure]:
    """Points, and failed ones if there are any."""
    failed = int((data["status"] != Status.CONVERGED).sum())
    figures = [KeyFigure("points", number(data["total"].size, ""))]
    return figures + [KeyFigure("failed points", number(failed, ""))] * bool(failed)


def _best_efficiency(data: xr.Dataset) -> KeyFigure:
    best = float(data["efficiency"].max())
    return KeyFigure("best efficiency", number(best, "", text=f"{100 * best:.2f}"), "%")


def map_key_figures(data: xr.Dataset) -> list[KeyFigure]:
    """What a reader looks for first."""
    figures = _counts(data)
    if np.isfinite(data["efficiency"]).any():
        figures.append(_best_efficiency(data))
    for name, label in (("total", "largest loss"), ("torque_loss", "largest torque loss")):
        worst = float(data[name].max())
        if np.isfinite(worst):
            unit = unit_text(str(data[name].attrs["units"]))
            figures.append(KeyFigure(label, number(worst, ""), unit))
    return figures


def map_sections(data: xr.Dataset, drawings: Drawings) -> list[Section]:
    """All chapters of a map."""
    band: tuple[Item, ...] = ()
    if "explained" in data:
        band = (*gallery(drawings, "loss-band", "loss-band-lines"), *uncertainty_items(data))
    grids = at_temperatures(data).items()
    tables = tuple(_grid(point, name, place) for place, point in grids for name in GRIDS)
    stated = tuple((Cell(name), Cell(text)) for name, text in statements(data).items() if text)
    sections = [
        Section("explorer", "Explorer", explorer_items(data), EXPLORER_LEAD),
        Section("efficiency", "Efficiency", gallery(drawings, "efficiency-map"), _WHITE),
        Section("losses", "Losses", gallery(drawings, "loss-map", "torque-loss-map")),
        Section(
            "lines",
            "Over speed and torque",
            gallery(drawings, "loss-parts", "loss-over-speed", "loss-over-torque"),
        ),
        Section("band", "How well it is known", band, BAND_LEAD),
        Section("tables", "Values", tables, _further(data)),
        Section("validity", "Validity", validity_items(data)),
        Section("gears", "Gears", gallery(drawings, "gear-set")),
        Section("methods", "Methods", _methods(data)),
        Section("conventions", "Conventions", (Table(("", "statement"), stated),)),
        Section("inputs", "Inputs", tuple(input_tables(map_inputs(data), map_inputs(data)))),
        Section("versions", "Versions", (versions_of(data),)),
    ]
    return [section for section in sections if section.items]


BAND_LEAD = "Inputs and models are off by the same at all points; 95 % of the samples lie within."


def _further(data: xr.Dataset) -> str:
    """Which values of temperatures and further keys the tables and figures are for."""
    fewer = left_out_line(data)
    lead = f"Tables and figures are {fewer}." if fewer else ""
    point = map_at(data)
    further = [f"{name} = {point[name].item()}" for name in data["total"].dims if name not in AXES]
    more = f"Tables and figures are for {', '.join(further)}." if further else ""
    return " ".join(filter(None, (lead, more)))


def _grid(point: xr.Dataset, name: str, temperature: int) -> Table:
    values = point[name].transpose("speed", "torque").to_numpy()

    def cell(i: int, j: int) -> Cell:
        return _value(name, values[i, j], f"{name}[{i},{j},{temperature}]")

    return grid_table(point, GRIDS[name], cell)


def _value(name: str, value: float, key: str) -> Cell:
    if not np.isfinite(value):
        return Cell(MISSING)
    text = f"{100 * value:.2f}" if name == "efficiency" else f"{value:.1f}"
    return number(float(value), key, text=text)


def validity_items(data: xr.Dataset) -> tuple[Listing, ...]:
    """Warnings and failures, each kind once with the number of its points."""
    size = data["total"].size
    lines: list[Listing] = []
    for name, title in (("message", "Failed points"), ("warnings", "Warnings")):
        counts: Counter[str] = Counter()
        first: dict[str, str] = {}
        for text, points in Counter(map(str, data[name].values.ravel())).items():
            kinds = {
                _NUMBER.sub("#", one): one
                for line in filter(None, text.split(" | "))
                for one in _without_values(line)
            }
            first = kinds | first
            counts.update(dict.fromkeys(kinds, points))
        if counts:
            items = tuple(
                f"{first[kind]} ({count} of {size} points)" for kind, count in counts.most_common()
            )
            lines.append(Listing(items, title))
    return tuple(lines) or (Listing(("There are no warnings.",)),)


def _without_values(warning: str) -> list[str]:
    """A warning without what was found at its point, so that like ones are counted together."""
    if not warning.startswith(_SMALL):
        return [_FOUND.sub(r"\1;", warning).partition(" Share of the loss")[0]]
    parts = warning.partition(": ")[2].removesuffix(".").split("; ")
    return [
        f"Out of range with little loss: {_QUANTITY.sub('', found)}; {limits}."
        for found, limits in zip(parts[::2], parts[1::2], strict=False)
    ]


def _methods(data: xr.Dataset) -> tuple[Table | Listing, ...]:
    case = map_case(data)
    if case is None:
        return (Listing(("The case of this map is none of this version of the program.",)),)
    rows = tuple(
        (Cell(what), Cell(method), Cell(source))
        for what, (method, source) in methods_of(case).items()
    )
    return (Table(("what", "method", "source"), rows),)


def versions_of(data: xr.Dataset) -> Listing:
    """The program, and the libraries that it computed with."""
    return versions_line(json.loads(data.attrs["versions"]))


# The report of a sweep: its chapters.


MOST_ROWS = 12  # Most rows of the table of points.
_POINTS_LEAD = "The points with the least total loss, and the one with the largest."


def sweep_key_figures(data: xr.Dataset) -> list[KeyFigure]:
    """What a reader looks for first."""
    figures = _counts(data)
    total = data["total"]
    for label, value in (("least loss", total.min()), ("largest loss", total.max())):
        if np.isfinite(value):
            figures.append(KeyFigure(label, number(float(value), ""), "W"))
    if "efficiency" in shown_results(data):
        figures.append(_best_efficiency(data))
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
