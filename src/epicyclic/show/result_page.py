"""The reports of one result and of a loss map: their chapters."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping

import numpy as np
import xarray as xr

from epicyclic.case.case import read_case
from epicyclic.errors import Status
from epicyclic.losses.ranges import share_text
from epicyclic.registry import offered
from epicyclic.result.result import Result, Train, in_words
from epicyclic.show import result_tables as tables
from epicyclic.show.explorer import EXPLORER_LEAD, explorer_items
from epicyclic.show.inputs import input_tables
from epicyclic.show.page import (
    MISSING,
    Cell,
    Drawings,
    Gallery,
    Item,
    KeyFigure,
    Listing,
    Row,
    Section,
    Table,
    aligned,
    gallery,
    number,
)
from epicyclic.show.plots.loss_map import at_temperatures, left_out_line, map_at
from epicyclic.show.plots.sweep import LEFT_OUT, shown_results
from epicyclic.show.record import ResultRecord, sets_of
from epicyclic.show.summary import all_warnings, first_lists
from epicyclic.show.uncertainty_tables import grid_table, uncertainty_items
from epicyclic.study.friction import methods_of
from epicyclic.study.maps.tables import map_case, map_inputs, statements
from epicyclic.study.operating import AXES
from epicyclic.units import format_number, unit_text


def result_sections(record: ResultRecord, drawings: Drawings) -> list[Section]:
    """All chapters for which the record has content."""
    sections = (result_section(record, drawings, name) for name in _CHAPTERS)
    return [section for section in sections if section.items]


def result_section(record: ResultRecord, drawings: Drawings, name: str) -> Section:
    """One chapter, without content if the record has none for it."""
    return Section(name, *_CHAPTERS[name](record, drawings))


_DIAMETERS = ("reference_diameter", "base_diameter", "tip_diameter", "root_diameter")
_MOST_BESIDE = 4  # Gears whose table has room beside a picture.
_POCKET_LEAD = (
    "A pocket is named after the gear whose tooth enters the tooth space of the other gear. "
    "Lines from dark to light are slices across the face."
)
_ASSUMPTIONS = (
    "Speed and torque are steady; dynamic loads are not modelled.",
    "Shafts, carrier and housing do not bend; misalignment comes from the case, and from the "
    "tilt of the planets if models.planet_tilt is coupled.",
    "Inputs in italics in the tables below were not given and have their default values.",
)
_OIL = {
    "inlet": "The oil is at its inlet temperature at all contacts.",
    "flank": "The oil is at its inlet temperature; in the meshes it is at the temperature of the "
    "gears.",
    "network": "Oil in contacts is at the mean temperature of the parts that touch; each part "
    "has one temperature.",
}
"""What is assumed about temperatures."""
_OTHER_KEYS = {"lubrication": "lubrication.method", "churning": "lubrication.churning"}
"""Keys that choose a model elsewhere than in [models]."""
_OF_PLANETS = (
    "Figures of meshes and bearing are for the most loaded planet; losses are for all planets.",
)
_INPUT_LEAD = (
    "Values in italics were not given; they are defaults. Defaults without effect here are left "
    "out."
)

BAND_LEAD = (
    "95 % interval of the result from the uncertainty of inputs and models, with each varied up "
    "and down by one standard deviation. 'epicyclic uncertainty' computes it from samples."
)


def _uncertainty(record: ResultRecord, drawings: Drawings) -> tuple[Item, ...]:
    """Bands, budget and tornado.

    A table stands before each figure: it breaks, and fills a page that has no room for the figure.
    """
    items: list[Item] = []
    for data in record.group("uncertainty").values():
        results, budget, *more = uncertainty_items(data)
        tornado = gallery(drawings, "drivers", wide=True)
        items += [results, *gallery(drawings, "band"), budget, *tornado, *more]
    return tuple(items)


def _losses(result: Result, drawings: Drawings) -> tuple[Item, ...]:
    if result.train is not None:
        return _train_losses(result, result.train, drawings)
    return (
        Row((tables.losses_table(result), *gallery(drawings, "losses"))),
        *first_lists(result, None),
        Row((tables.members_table(result), *gallery(drawings, "loss-sum"))),
        *gallery(drawings, "power-flow", wide=True),
        *tables.standing_items(result),
    )


def _train_losses(result: Result, train: Train, drawings: Drawings) -> tuple[Item, ...]:
    """Sums, what is missing, power flow, shafts, rolling powers, every single loss."""
    return (
        tables.sums_table(result, train),
        *first_lists(result, None),
        *gallery(drawings, "power-flow", wide=True),
        Row((*gallery(drawings, "losses"), *gallery(drawings, "loss-sum"))),
        tables.shafts_table(result),
        Row((tables.rolling_table(result, train), *tables.clutches_table(train))),
        *tables.terms_table(result, train),
        *tables.standing_items(result),
    )


VALID = "Every model was used within its range of validity."
PARTLY_VALID = (
    "Some models were used outside their range of validity. Their conditions are held at the "
    "limits of the range; the affected share of the loss is stated."
)


def _validity(result: Result) -> tuple[Table | Listing, ...]:
    items: list[Table | Listing] = []
    if result.flags:
        rows = tuple(
            (
                Cell(flag.quantity),
                Cell(_limits(flag.found_low, flag.found_high), about="nowrap"),
                Cell(_limits(flag.low, flag.high), about="nowrap"),
                Cell(unit_text(flag.unit), about="nowrap"),
                Cell(str(flag.use)),
                aligned(share_text(flag.share)),
                Cell(flag.source),
            )
            for flag in sorted(result.flags, key=lambda flag: -flag.share)
        )
        head = ("quantity", "found", "range", "unit", "model", "share", "source of the range")
        items.append(Table(head, rows))
    notes = tuple(it for it in all_warnings(result) if not it.startswith("Out of range"))
    if notes:
        items.append(Listing(notes, "Notes"))
    return tuple(items) or (Listing(("There are no warnings.",)),)


def _limits(low: float | None, high: float | None) -> str:
    texts = ["" if value is None else format_number(value, 3) for value in (low, high)]
    if low is None or high is None:
        return f"up to {texts[1]}" if low is None else f"from {texts[0]}"
    return " to ".join(dict.fromkeys(texts))


def _heat(result: Result, drawings: Drawings) -> tuple[Item, ...]:
    if result.heat is None:
        return ()
    heat = result.heat
    picture = gallery(drawings, "heat-network", wide=True)
    paths = tables.heat_path_items(heat) if heat.ways else ()
    return (*picture, Row(tuple(tables.heat_items(heat))), *paths)


def _gears(record: ResultRecord, drawings: Drawings) -> Iterator[Item]:
    """Each set to scale beside the teeth and diameters of its gears, or above those of many."""
    drawn = drawings.get("gear-set", ())
    for number_of, (name, gears) in enumerate(sets_of(record.group("gears")).items()):
        picture = (Gallery((drawn[number_of],)),) if number_of < len(drawn) else ()
        table = _gears_table(f"Gears of {in_words(name)}" if name else "Gears", gears)
        if len(gears) <= _MOST_BESIDE:
            yield Row((*picture, table))
        else:
            yield from (*picture, table)


def _gears_table(title: str, gears: Mapping[str, xr.Dataset]) -> Table:
    """Teeth and diameters of the gears side by side."""
    teeth = (number(int(gear.attrs["teeth"]), "") for gear in gears.values())
    rows = [(Cell("teeth"), *teeth, Cell(""))]
    for name in _DIAMETERS:
        shown_ones = (number(float(gear[name]), "", 6) for gear in gears.values())
        unit = unit_text(str(next(iter(gears.values()))[name].attrs["units"]))
        rows.append((Cell(name.replace("_", " ")), *shown_ones, Cell(unit)))
    return Table(("", *(name.replace("_", " ") for name in gears), "unit"), tuple(rows), title)


def _bearings(record: ResultRecord, drawings: Drawings) -> tuple[str, tuple[Item, ...]]:
    """Title and content of the chapter on bearings; of a train also those of shafts, and seals."""
    result = record.result
    parts: tuple[Item, ...] = (
        *gallery(drawings, "roller-loads", "roller-pressure"),
        *tables.bearing_tables(result),
        *tables.part_tables(result),
    )
    return "Bearings and seals" if result.kind == "train" else "Planet bearing", parts


def _methods(result: Result) -> tuple[Table | Listing, ...]:
    """Each method once with what it computes and where it is printed."""
    users: dict[tuple[str, str], list[str]] = {}
    citations = result.citations
    for name, method in result.methods.items():
        users.setdefault((method, citations.get(name, "")), []).append(name)
    rows = tuple(
        (Cell(tables.users_text(names)), Cell(method), Cell(source))
        for (method, source), names in users.items()
    )
    models = tuple((Cell(_model_key(key)), Cell(value)) for key, value in result.models.items())
    oil = _OIL["inlet" if result.heat is None else result.heat.model]
    assumptions = (*_ASSUMPTIONS[:-1], oil, _ASSUMPTIONS[-1]) + (
        () if result.kind == "gear_pair" else _OF_PLANETS
    )
    if not models:
        assumptions = (_ASSUMPTIONS[0], _ASSUMPTIONS[-1])
    return (
        Table(("what", "method", "source"), rows),
        *((Table(("key of the case", "model used"), models, "Models"),) if models else ()),
        Listing(assumptions, "Assumptions"),
    )


def _model_key(key: str) -> str:
    """The key of the case that chooses a model: ``"sets.P1.models.friction"``."""
    name, dot, model = key.rpartition(".")
    own = _OTHER_KEYS.get(model, f"models.{model}")
    return f"sets.{name}.{own}" if dot else own


def versions_line(versions: Mapping[str, str]) -> Listing:
    """The program, and the libraries that it computed with."""
    return Listing((", ".join(f"{name} {version}" for name, version in versions.items()),))


def _load(result: Result, drawings: Drawings) -> tuple[Item, ...]:
    return (
        *tables.mesh_tables(result),
        *gallery(drawings, "line-load", "pressure", "pair-load", "transmission-error", "stiffness"),
    )


def _details(record: ResultRecord) -> tuple[Item, ...]:
    """What plug-ins show of the case, whose tables the record holds."""
    if not offered("details").keys() & record.given.keys():
        return ()
    return tuple(tables.details(read_case(record.given), record.result))


_Chapter = tuple[str, tuple[Item, ...]] | tuple[str, tuple[Item, ...], str]
"""Title and content, and what stands before this."""
_CHAPTERS: Mapping[str, Callable[[ResultRecord, Drawings], _Chapter]] = {
    "losses": lambda record, drawings: ("Losses", _losses(record.result, drawings)),
    "uncertainty": lambda record, drawings: (
        "Uncertainty of this result",
        _uncertainty(record, drawings),
        BAND_LEAD,
    ),
    "validity": lambda record, drawings: (
        "Validity",
        _validity(record.result),
        PARTLY_VALID if record.result.flags else VALID,
    ),
    "temperatures": lambda record, drawings: ("Temperatures", _heat(record.result, drawings)),
    "gears": lambda record, drawings: (
        "Gears",
        (
            *gallery(drawings, "arrangement"),
            *_gears(record, drawings),
            *gallery(drawings, "teeth"),
            *tables.planets_table(record.result),
        ),
    ),
    "load": lambda record, drawings: ("Load on the teeth", _load(record.result, drawings)),
    "details": lambda record, drawings: ("Strength", _details(record)),
    "friction": lambda record, drawings: (
        "Friction in the meshes",
        gallery(drawings, "friction", "sliding", "film", "friction-power"),
    ),
    "bearing": _bearings,
    "pockets": lambda record, drawings: (
        "Pockets",
        gallery(drawings, "pocket-pressure", "pocket-volume", "pocket-power"),
        _POCKET_LEAD,
    ),
    "oil": lambda record, drawings: ("Oil", tuple(tables.oil_table(record.result))),
    "methods": lambda record, drawings: ("Methods and assumptions", _methods(record.result)),
    "inputs": lambda record, drawings: (
        "Inputs",
        (
            *input_tables(record.result.inputs, record.given, record.result.models),
            *tables.adjusted(read_case(record.given)),
        ),
        _INPUT_LEAD,
    ),
    "versions": lambda record, drawings: ("Versions", (versions_line(record.result.versions),)),
}
"""By name; each computes nothing of a growing record that it does not show."""

# The report of a loss map: its chapters.

_WHITE = "White: no power is transmitted, or the point failed."
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
        Section("band", "Uncertainty", band, MAP_BAND_LEAD),
        Section("tables", "Values", tables, _further(data)),
        Section("validity", "Validity", validity_items(data)),
        Section("gears", "Gears", gallery(drawings, "gear-set")),
        Section("methods", "Methods", _map_methods(data)),
        Section("conventions", "Conventions", (Table(("", "statement"), stated),)),
        Section("inputs", "Inputs", tuple(input_tables(map_inputs(data), map_inputs(data)))),
        Section("versions", "Versions", (versions_line(json.loads(data.attrs["versions"])),)),
    ]
    return [section for section in sections if section.items]


MAP_BAND_LEAD = (
    "Errors of inputs and models are the same at all points; 95 % of the samples lie within the "
    "band."
)


def _further(data: xr.Dataset) -> str:
    """Which values of temperatures and further keys the tables and figures are for."""
    fewer = left_out_line(data)
    lead = f"Tables and figures show {fewer}." if fewer else ""
    point = map_at(data)
    further = [f"{name} = {point[name].item()}" for name in data["total"].dims if name not in AXES]
    more = f"Tables and figures are for {', '.join(further)}." if further else ""
    return " ".join(filter(None, (lead, more)))


def _grid(point: xr.Dataset, name: str, temperature: int) -> Table:
    values = point[name].transpose("speed", "torque").to_numpy()

    def cell(i: int, j: int) -> Cell:
        value = float(values[i, j])
        if not np.isfinite(value):
            return Cell(MISSING)
        text = f"{100 * value:.2f}" if name == "efficiency" else f"{value:.1f}"
        return number(value, f"{name}[{i},{j},{temperature}]", text=text)

    return grid_table(point, GRIDS[name], cell)


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
        f"Out of range, with a small share of the loss: {_QUANTITY.sub('', found)}; {limits}."
        for found, limits in zip(parts[::2], parts[1::2], strict=False)
    ]


def _map_methods(data: xr.Dataset) -> tuple[Table | Listing, ...]:
    case = map_case(data)
    if case is None:
        return (Listing(("The case of this map was not made by this version of the program.",)),)
    rows = tuple(
        (Cell(what), Cell(method), Cell(source))
        for what, (method, source) in methods_of(case).items()
    )
    return (Table(("what", "method", "source"), rows),)


# The report of a sweep: its chapters.

MOST_ROWS = 12  # Most rows of the table of points.
_POINTS_LEAD = "The points with the least total loss and the one with the largest."


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
        Section("inputs", "Inputs", tuple(input_tables(inputs, inputs)), _MAP_INPUT_LEAD),
        Section("versions", "Versions", (versions_line(json.loads(data.attrs["versions"])),)),
    ]
    return [section for section in sections if section.items]


def _left_out(shown: xr.Dataset) -> str:
    """How many points pictures leave out, and where all are; nothing if there are none."""
    left_out = shown.attrs.get(LEFT_OUT, 0)
    if not left_out:
        return ""
    size = shown["total"].size
    return (
        f"Of {size + left_out} points {size} are shown, at evenly spaced values of each key, with "
        f"the points of least loss; {left_out} are left out. Key figures, least losses and "
        "validity cover all points, which are in the file of the sweep."
    )


_MAP_INPUT_LEAD = "The case before any variation."


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
    return number(value, key, text=f"{100 * value:.2f}" if array.name == "efficiency" else "")
