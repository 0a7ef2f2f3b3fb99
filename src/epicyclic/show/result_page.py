"""The report of one result: its chapters."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import xarray as xr

from epicyclic.result.result import Result, Train, in_words
from epicyclic.show import result_tables as tables
from epicyclic.show.inputs import input_tables
from epicyclic.show.page import (
    Cell,
    Drawings,
    Gallery,
    Item,
    Listing,
    Row,
    Section,
    Table,
    aligned,
    gallery,
    number,
)
from epicyclic.show.record import ResultRecord, sets_of
from epicyclic.show.uncertainty_tables import uncertainty_items
from epicyclic.units import format_number, percent, unit_text


def result_sections(record: ResultRecord, drawings: Drawings) -> list[Section]:
    """All chapters for which the record has content."""
    sections = (result_section(record, drawings, name) for name in _CHAPTERS)
    return [section for section in sections if section.items]


def result_section(record: ResultRecord, drawings: Drawings, name: str) -> Section:
    """One chapter, without content if the record has none for it."""
    return _CHAPTERS[name](record, drawings)


_DIAMETERS = ("reference_diameter", "base_diameter", "tip_diameter", "root_diameter")
_MOST_BESIDE = 4  # Gears whose table has room beside a picture.
_POCKET_LEAD = (
    "A pocket is named after the member whose tooth is in a space of the other. Lines from dark "
    "to light are slices across the face."
)
_ASSUMPTIONS = (
    "Speed and torque are steady; dynamic loads are not modelled.",
    "Shafts, carrier and housing do not bend; misalignment is that of the case, and of the tilt of "
    "the planets if models.planet_tilt is coupled.",
    "Inputs in italics, in the tables below, were not given and have their default values.",
)
_OIL = {
    "inlet": "The oil has its inlet temperature at all contacts.",
    "flank": "The oil has its inlet temperature; in the meshes it is as warm as the gears.",
    "network": "Oil in contacts is as warm as the mean of the parts that touch, which are of one "
    "temperature each.",
}
"""What is assumed about temperatures."""
_OTHER_KEYS = {"lubrication": "lubrication.method", "churning": "lubrication.churning"}
"""Keys that choose a model elsewhere than in [models]."""
_OF_PLANETS = (
    "Figures of meshes and bearing are those of the most loaded planet; losses are those of all.",
)
_INPUT_LEAD = (
    "Values in italics were not given: they are defaults. Defaults that have no effect here are "
    "left out."
)


BAND_LEAD = (
    "95 % of what the result may be, given how well inputs and models are known, from each of them "
    "one standard deviation up and down. 'epicyclic uncertainty' finds it from samples."
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
    return (
        Row((tables.losses_table(result), *gallery(drawings, "losses"))),
        Row((tables.members_table(result), *gallery(drawings, "loss-sum"))),
        *gallery(drawings, "power-flow", wide=True),
    )


def _train_losses(result: Result, train: Train, drawings: Drawings) -> tuple[Item, ...]:
    """Power flow, sums, shafts, rolling powers, every single loss."""
    return (
        *gallery(drawings, "power-flow", wide=True),
        tables.sums_table(result, train),
        Row((*gallery(drawings, "losses"), *gallery(drawings, "loss-sum"))),
        tables.shafts_table(result),
        Row((tables.rolling_table(result, train), *tables.clutches_table(train))),
        *tables.terms_table(result, train),
    )


def _validity_lead(result: Result) -> str:
    if not result.flags:
        return "Every model was used within the range in which it was made."
    return (
        "Some models were used outside the range in which they were made. Their conditions are "
        "held at the limits of the range; the share of the loss concerned is stated."
    )


def _validity(result: Result) -> tuple[Table | Listing, ...]:
    items: list[Table | Listing] = []
    if result.flags:
        rows = tuple(
            (
                Cell(flag.quantity),
                Cell(f"{_number(flag.found_low)} to {_number(flag.found_high)}", about="nowrap"),
                Cell(_limits(flag.low, flag.high), about="nowrap"),
                Cell(unit_text(flag.unit), about="nowrap"),
                Cell(str(flag.use)),
                aligned("under 1 %" if flag.share < 0.01 else percent(flag.share, 0)),
                Cell(flag.source),
            )
            for flag in sorted(result.flags, key=lambda flag: -flag.share)
        )
        head = ("quantity", "found", "range", "unit", "model", "share", "source of the range")
        items.append(Table(head, rows))
    notes = tuple(text for text in result.warnings if not text.startswith("Out of range"))
    if notes:
        items.append(Listing(notes, "Notes"))
    return tuple(items) or (Listing(("There are no warnings.",)),)


def _limits(low: float | None, high: float | None) -> str:
    if low is None or high is None:
        return f"up to {_number(high)}" if low is None else f"from {_number(low)}"
    return f"{_number(low)} to {_number(high)}"


def _number(value: float | None) -> str:
    return "" if value is None else format_number(value, 3)


def _heat(result: Result, drawings: Drawings) -> tuple[Item, ...]:
    """Temperatures, and the ways of the heat."""
    if result.heat is None:
        return ()
    heat = result.heat
    picture = gallery(drawings, "heat-network", wide=True)
    ways = tables.ways_items(heat) if heat.ways else ()
    return (*picture, Row(tuple(tables.heat_items(heat))), *ways)


def _gears(record: ResultRecord, drawings: Drawings) -> Iterator[Item]:
    """Each set to scale beside the teeth and diameters of its gears, or above those of many."""
    drawn = drawings.get("gear-set", ())
    for number_of, (name, gears) in enumerate(sets_of(record.group("gears")).items()):
        picture = (Gallery((drawn[number_of],)),) if number_of < len(drawn) else ()
        title = f"Gears of {in_words(name)}" if name else "Gears"
        table = _gears_table(title, gears)
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
    names = (name.replace("_", " ") for name in gears)
    return Table(("", *names, "unit"), tuple(rows), title)


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
        key = method, citations.get(name, "")
        users.setdefault(key, []).append(name)
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


def _losses_chapter(record: ResultRecord, drawings: Drawings) -> Section:
    result = record.result
    train = result.train
    losses = _losses(result, drawings) if train is None else _train_losses(result, train, drawings)
    return Section("losses", "Losses", (*tables.standing_items(result), *losses))


def _load_chapter(record: ResultRecord, drawings: Drawings) -> Section:
    items: tuple[Item, ...] = (
        *tables.mesh_tables(record.result),
        *gallery(drawings, "line-load", "pressure", "pair-load", "transmission-error", "stiffness"),
    )
    return Section("load", "Load on the teeth", items)


_CHAPTERS: Mapping[str, Callable[[ResultRecord, Drawings], Section]] = {
    "losses": _losses_chapter,
    "uncertainty": lambda record, drawings: Section(
        "uncertainty", "How well this is known", _uncertainty(record, drawings), BAND_LEAD
    ),
    "validity": lambda record, drawings: Section(
        "validity", "Validity", _validity(record.result), _validity_lead(record.result)
    ),
    "temperatures": lambda record, drawings: Section(
        "temperatures", "Temperatures", _heat(record.result, drawings)
    ),
    "gears": lambda record, drawings: Section(
        "gears",
        "Gears",
        (
            *_gears(record, drawings),
            *gallery(drawings, "teeth"),
            *tables.planets_table(record.result),
        ),
    ),
    "load": _load_chapter,
    "friction": lambda record, drawings: Section(
        "friction",
        "Friction in the meshes",
        gallery(drawings, "friction", "sliding", "film", "friction-power"),
    ),
    "bearing": lambda record, drawings: Section("bearing", *_bearings(record, drawings)),
    "pockets": lambda record, drawings: Section(
        "pockets",
        "Pockets",
        gallery(drawings, "pocket-pressure", "pocket-volume", "pocket-power"),
        _POCKET_LEAD,
    ),
    "oil": lambda record, drawings: Section("oil", "Oil", tuple(tables.oil_table(record.result))),
    "methods": lambda record, drawings: Section(
        "methods", "Methods and assumptions", _methods(record.result)
    ),
    "inputs": lambda record, drawings: Section(
        "inputs",
        "Inputs",
        tuple(input_tables(record.result.inputs, record.given, record.result.models)),
        _INPUT_LEAD,
    ),
    "versions": lambda record, drawings: Section(
        "versions", "Versions", (versions_line(record.result.versions),)
    ),
}
"""By name; each computes nothing of a growing record that it does not show."""
