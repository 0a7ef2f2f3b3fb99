"""The report of one result: its chapters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import xarray as xr

from epicyclic.records.contents import Measure, ResultContents
from epicyclic.records.record import ResultRecord, set_of, sets_of
from epicyclic.report.heat_tables import heat_items, ways_items
from epicyclic.report.inputs import input_tables
from epicyclic.report.page import (
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
from epicyclic.report.train_page import (
    label_of,
    model_key,
    part_tables,
    share_row,
    train_losses,
)
from epicyclic.report.train_tables import users_text
from epicyclic.results.result import in_words
from epicyclic.units import format_number, unit_text

__all__ = ["key_figures", "operation_line", "result_sections"]


def key_figures(result: ResultContents) -> list[KeyFigure]:
    """What a reader looks for first."""
    efficiency = result.efficiency
    text = "" if efficiency is None else f"{100 * efficiency:.3f}"
    ratio = [KeyFigure("ratio", number(result.ratio, "ratio", 5))]
    return [
        *(ratio if result.kind == "train" else ()),
        KeyFigure("efficiency", number(efficiency, "efficiency", text=text), "%" if text else ""),
        KeyFigure("total loss", _watts(result.total, "total"), "W"),
        KeyFigure("load-dependent", _watts(result.load_dependent, "load_dependent"), "W"),
        KeyFigure("load-independent", _watts(result.load_independent, "load_independent"), "W"),
        KeyFigure("input power", _watts(result.input_power / 1e3, "", 2), "kW"),
    ]


def operation_line(result: ResultContents) -> str:
    """The operating point in one line."""
    operation = result.inputs["operation"]
    words = [f"{operation['speed']}, {operation['torque']}"]
    if "output" in operation:
        words.insert(0, f"{operation['input']} to {operation['output']}")
    elif "input" in operation:
        words.insert(0, f"input {operation['input']}")
    if operation.get("state"):
        words.insert(0, f"state {operation['state']}")
    if operation.get("fixed"):
        words.append(f"{operation['fixed']} fixed")
    if "oil_inlet_temperature" in operation:
        words.append(f"oil at {operation['oil_inlet_temperature']}")
    return unit_text(", ".join(words))


def result_sections(record: ResultRecord, drawings: Drawings) -> list[Section]:
    """All chapters for which the record has content."""
    result = record.result
    own_losses: tuple[Item, ...] = (
        Row((_losses(result), *gallery(drawings, "losses"))),
        Row((_members(result), *gallery(drawings, "loss-sum"))),
        *gallery(drawings, "power-flow", wide=True),
    )
    sections = [
        Section(
            "losses",
            "Losses",
            train_losses(result, drawings) if result.kind == "train" else own_losses,
        ),
        Section("validity", "Validity", _validity(result), _validity_lead(result)),
        Section("temperatures", "Temperatures", _heat(result, drawings)),
        Section(
            "gears",
            "Gears",
            (
                *_gears(record, drawings),
                *gallery(drawings, "teeth"),
                *_planets(result),
            ),
        ),
        Section(
            "load",
            "Load on the teeth",
            (
                *_meshes(record),
                *gallery(drawings, "line-load", "pressure", "pair-load"),
                *gallery(drawings, "transmission-error", "stiffness"),
            ),
        ),
        Section(
            "friction",
            "Friction in the meshes",
            gallery(drawings, "friction", "sliding", "film", "friction-power"),
        ),
        Section("bearing", *_bearings(record, drawings)),
        Section(
            "pockets",
            "Pockets",
            gallery(drawings, "pocket-pressure", "pocket-volume", "pocket-power"),
            _POCKET_LEAD,
        ),
        Section(
            "oil",
            "Oil",
            () if result.fluid is None else (_measures(record, "fluid", "", result.fluid),),
        ),
        Section("methods", "Methods and assumptions", _methods(result)),
        Section("inputs", "Inputs", tuple(input_tables(result.inputs, record.given)), _INPUT_LEAD),
        Section("versions", "Versions", (_versions(result),)),
    ]
    return [section for section in sections if section.items]


_FLOW_NOTE = (
    "Speeds are positive in one common sense of rotation; torques act on the gear set from "
    "outside; positive power enters."
)
_DIAMETERS = ("reference_diameter", "base_diameter", "tip_diameter", "root_diameter")
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
_OF_PLANETS = (
    "Figures of meshes and bearing are those of the most loaded planet; losses are those of all.",
)
_INPUT_LEAD = "Values in italics were not given: they are defaults."


def _watts(value: float, key: str, digits: int = 1) -> Cell:
    return number(value, key, text=f"{value:z.{digits}f}")


def _losses(result: ResultContents) -> Table:
    rows: list[tuple[Cell, ...]] = []
    strong = []
    for group in dict.fromkeys(result.groups.values()):
        for name, watts in result.losses.items():
            if result.groups[name] != group:
                continue
            words = Cell(name.replace("_", " "))
            if name in result.not_included:
                rows.append((words, Cell("not included"), Cell(""), Cell("")))
            else:
                rows.append((words, *share_row(result, watts, f"losses.{name}")))
        key = group.replace("-", "_")
        strong.append(len(rows))
        rows.append((Cell(group), *share_row(result, getattr(result, key), key)))
    strong.append(len(rows))
    rows.append((Cell("total"), *share_row(result, result.total, "total")))
    return Table(("", "loss, W", "of total", "of input"), tuple(rows), strong=frozenset(strong))


def _validity_lead(result: ResultContents) -> str:
    if not result.validity:
        return "Every model was used within the range in which it was made."
    return (
        "Some models were used outside the range in which they were made. Their conditions are "
        "held at the limits of the range; the share of the loss concerned is stated."
    )


def _validity(result: ResultContents) -> tuple[Table | Listing, ...]:
    items: list[Table | Listing] = []
    if result.validity:
        rows = tuple(
            (
                Cell(flag.quantity),
                Cell(f"{_number(flag.found_low)} to {_number(flag.found_high)}", about="nowrap"),
                Cell(_limits(flag.low, flag.high), about="nowrap"),
                Cell(unit_text(flag.unit)),
                Cell(f"{flag.use.role.replace('_', ' ')} {flag.use.model}, {flag.use.where}"),
                aligned("under 1%" if flag.share < 0.01 else f"{flag.share:.0%}"),
                Cell(flag.source),
            )
            for flag in sorted(result.validity, key=lambda flag: -flag.share)
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


def _heat(result: ResultContents, drawings: Drawings) -> tuple[Item, ...]:
    """Temperatures, and the ways of the heat."""
    if result.heat is None:
        return ()
    heat = result.heat.balance
    picture = gallery(drawings, "heat-network", wide=True)
    ways = ways_items(heat) if heat.ways else ()
    return (*picture, Row(tuple(heat_items(heat))), *ways)


def _members(result: ResultContents) -> Table:
    rows = tuple(
        (
            Cell(name),
            number(member.speed.value, f"members.{name}.speed", 6),
            number(member.torque.value, f"members.{name}.torque", 6),
            number(member.power.value, f"members.{name}.power", 7),
        )
        for name, member in result.members.items()
    )
    first = next(iter(result.members.values()))
    units = (first.speed.unit, first.torque.unit, first.power.unit)
    heads = (
        f"{name}, {unit_text(unit)}"
        for name, unit in zip(("speed", "torque", "power"), units, strict=True)
    )
    return Table(("", *heads), rows, "Power flow", note=_FLOW_NOTE)


def _gears(record: ResultRecord, drawings: Drawings) -> Iterator[Row]:
    """Each set to scale beside the teeth and diameters of its gears."""
    drawn = drawings.get("gear-set", ())
    for number_of, (name, gears) in enumerate(sets_of(record.group("gears")).items()):
        picture = (Gallery((drawn[number_of],)),) if number_of < len(drawn) else ()
        title = f"Gears of {in_words(name)}" if name else "Gears"
        yield Row((*picture, _gears_table(title, gears)))


def _gears_table(title: str, gears: Mapping[str, xr.Dataset]) -> Table:
    """Teeth and diameters of the gears side by side."""
    teeth = (number(int(gear.attrs["teeth"]), "") for gear in gears.values())
    rows = [(Cell("teeth"), *teeth, Cell(""))]
    for name in _DIAMETERS:
        shown_ones = (number(float(gear[name]), "", 6) for gear in gears.values())
        unit = unit_text(str(next(iter(gears.values()))[name].attrs["units"]))
        rows.append((Cell(name.replace("_", " ")), *shown_ones, Cell(unit)))
    return Table(("", *gears, "unit"), tuple(rows), title)


def _planets(result: ResultContents) -> tuple[Table, ...]:
    if not result.planet_angles.value:
        return ()
    rows = tuple(
        (
            Cell(f"{place + 1}"),
            number(angle, f"planet_angles.{place}", 7),
            number(share, f"planet_shares.{place}", 4, f"{share:.2%}"),
        )
        for place, (angle, share) in enumerate(
            zip(result.planet_angles.value, result.planet_shares.value, strict=True)
        )
    )
    unit = unit_text(result.planet_angles.unit)
    return (Table(("planet", f"angle, {unit}", "share of the torque"), rows, "Planets"),)


def _meshes(record: ResultRecord) -> Iterator[Table]:
    """Figures of the meshes of each set side by side."""
    sets: dict[str, dict[str, dict[str, Measure]]] = {}
    for key, figures in record.result.meshes.items():
        sets.setdefault(set_of(key), {})[key] = figures
    for name, meshes in sets.items():
        title = f"Meshes of {in_words(name)}" if name else "Figures of the meshes"
        yield _figures_table(record, title, "meshes", meshes)


def _figures_table(
    record: ResultRecord, title: str, place: str, parts: Mapping[str, Mapping[str, Measure]]
) -> Table:
    """Figures of parts of one kind side by side."""
    keys = dict.fromkeys(key for figures in parts.values() for key in figures)
    rows = []
    for key in keys:
        found = {name: figures[key] for name, figures in parts.items() if key in figures}
        first = next(iter(found))
        cells = (
            number(found[name].value, f"{place}.{name}.{key}") if name in found else Cell("")
            for name in parts
        )
        unit = Cell(unit_text(found[first].unit))
        rows.append((Cell(label_of(record, first, key)), *cells, unit))
    heads = (name.rpartition(".")[2].replace("_", " ") for name in parts)
    if len(set(map(set_of, parts))) > 1:
        heads = (in_words(name) for name in parts)
    return Table(("", *heads, "unit"), tuple(rows), title)


def _bearings(record: ResultRecord, drawings: Drawings) -> tuple[str, tuple[Item, ...]]:
    """Title and content of the chapter on bearings; of a train also those of shafts, and seals."""
    result = record.result
    rollers = gallery(drawings, "roller-loads", "roller-pressure")
    if result.kind != "train":
        figures = result.planet_bearing
        if figures is None:
            return "Planet bearing", ()
        table = _measures(record, "planet_bearing", "planet_bearing", figures)
        return "Planet bearing", (*rollers, table)
    items: list[Item] = [*rollers]
    if result.bearings:
        items.append(_figures_table(record, "Planet bearings", "bearings", result.bearings))
    items += part_tables(record)
    return "Bearings and seals", tuple(items)


def _measures(record: ResultRecord, key: str, prefix: str, figures: Mapping[str, Measure]) -> Table:
    rows = tuple(
        (
            Cell(label_of(record, prefix or key, name)),
            number(measure.value, f"{key}.{name}"),
            Cell(unit_text(measure.unit)),
        )
        for name, measure in figures.items()
    )
    return Table(("", "value", "unit"), rows)


def _methods(result: ResultContents) -> tuple[Table | Listing, ...]:
    """Each method once with what it computes and where it is printed."""
    users: dict[tuple[str, str], list[str]] = {}
    for name, method in result.methods.items():
        key = method, result.citations.get(name, "")
        users.setdefault(key, []).append(name)
    rows = tuple(
        (Cell(users_text(names)), Cell(method), Cell(source))
        for (method, source), names in users.items()
    )
    models = tuple((Cell(model_key(key)), Cell(value)) for key, value in result.models.items())
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


def _versions(result: ResultContents) -> Table:
    rows = tuple((Cell(name), Cell(version)) for name, version in result.versions.items())
    return Table(("", "version"), rows)
