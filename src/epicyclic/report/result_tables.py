"""Tables of a result, for pages and terminals: losses, power flow, figures of all parts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from epicyclic.records.contents import Measure, ResultContents, set_of
from epicyclic.report.page import Cell, KeyFigure, Listing, Table, aligned, number, tenths
from epicyclic.report.shown import MISSING, error_text, shown
from epicyclic.results.result import in_words
from epicyclic.units import known_text, large_unit, percent, unit_text

Unit = tuple[str, float]
"""Its name in print and its size."""
Labels = Mapping[str, str]
"""What every number of a result is called, by its key."""
_FLOW_NOTE = (
    "Speeds are positive in one common sense of rotation; torques act on the gear set from "
    "outside; positive power enters."
)
_ROLES = {
    "lubrication": "lubrication",
    "churning": "churning",
    "friction": "friction",
    "rolling": "rolling loss",
    "bearing": "planet bearing",
    "shaft_bearing": "shaft bearing",
}
_ERRORS = ("pocket_power_difference", "pocket_interpolation_error")
"""Figures of meshes that tell how well others are computed; there are none of what is solved."""
_NO_CONTACT = f'"{MISSING}": no load or no motion in the mesh.'


def key_figures(result: ResultContents) -> list[KeyFigure]:
    """What a reader looks for first."""
    efficiency = result.efficiency
    text = "" if efficiency is None else f"{100 * efficiency:.3f}"
    ratio = [KeyFigure("ratio", number(result.ratio, "ratio", 5))]
    rolling = KeyFigure("power ratio", number(result.power_ratio, "power_ratio"))
    return [
        *(ratio if result.kind == "train" else ()),
        KeyFigure("efficiency", number(efficiency, "efficiency", text=text), "%" if text else ""),
        _power("total loss", result.total, "total"),
        _power("load-dependent", result.load_dependent, "load_dependent"),
        _power("load-independent", result.load_independent, "load_independent"),
        _power("input power", result.input_power, ""),
        *(() if result.power_ratio is None else (rolling,)),
    ]


def _power(label: str, watts: float, key: str) -> KeyFigure:
    """With three significant digits, four of watts: no more are known."""
    text, _, unit = known_text(watts).partition(" ")
    return KeyFigure(label, number(watts, key, text=text), unit)


def share_row(result: ResultContents, watts: float, key: str) -> tuple[Cell, Cell, Cell]:
    """Power, share of the total loss, share of the input power."""
    of_total = percent(watts / result.total) if result.total else ""
    of_input = percent(watts / result.input_power, 3) if result.input_power else ""
    return tenths(watts, key), aligned(of_total), aligned(of_input)


def losses_table(result: ResultContents) -> Table:
    """The losses of a single set, group by group."""
    rows: list[tuple[Cell, ...]] = []
    strong = []
    grouping = result.inputs["models"].get("load_dependent")
    tested = ", as tested" if grouping == "as-tested" else ""
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
        rows.append((Cell(f"{group}{tested}"), *share_row(result, getattr(result, key), key)))
    strong.append(len(rows))
    rows.append((Cell("total"), *share_row(result, result.total, "total")))
    head = ("", "loss, W", "of total", "of input")
    return Table(head, tuple(rows), "Losses", frozenset(strong))


def flow_units(result: ResultContents) -> tuple[str, Unit, Unit]:
    """The units of speeds, torques and powers of all members in print."""
    members = result.members.values()
    torque, power = (
        large_unit(max(abs(one.value or 0.0) for one in own), own[0].unit)
        for own in ([one.torque for one in members], [one.power for one in members])
    )
    return unit_text(next(iter(members)).speed.unit), torque, power


def scaled(value: float | None, key: str, unit: Unit, digits: int = 6) -> Cell:
    """A cell of a column in `unit`."""
    return number(value, key, text="" if value is None else shown(value / unit[1], digits))


def members_table(result: ResultContents) -> Table:
    """Speeds, torques and powers of the members of a single set."""
    speed, torque, power = flow_units(result)
    rows = tuple(
        (
            Cell(name),
            number(member.speed.value, f"members.{name}.speed", 6),
            scaled(member.torque.value, f"members.{name}.torque", torque),
            scaled(member.power.value, f"members.{name}.power", power, 7),
        )
        for name, member in result.members.items()
    )
    heads = (f"speed, {speed}", f"torque, {torque[0]}", f"power, {power[0]}")
    return Table(("", *heads), rows, "Power flow", note=_FLOW_NOTE)


def planets_table(result: ResultContents) -> tuple[Table, ...]:
    """Where the planets are and how much each carries; nothing without planets."""
    if not result.planet_angles.value:
        return ()
    rows = tuple(
        (
            Cell(f"{place + 1}"),
            number(angle, f"planet_angles.{place}", 7),
            number(share, f"planet_shares.{place}", 4, percent(share, 2)),
        )
        for place, (angle, share) in enumerate(
            zip(result.planet_angles.value, result.planet_shares.value, strict=True)
        )
    )
    unit = unit_text(result.planet_angles.unit)
    return (Table(("planet", f"angle, {unit}", "share of the torque"), rows, "Planets"),)


def mesh_tables(result: ResultContents, labels: Labels) -> Iterable[Table]:
    """Figures of the meshes of each set side by side."""
    sets: dict[str, dict[str, dict[str, Measure]]] = {}
    for key, figures in result.meshes.items():
        sets.setdefault(set_of(key), {})[key] = figures
    for name, meshes in sets.items():
        title = f"Meshes of {in_words(name)}" if name else "Meshes"
        idle = any(mesh["hertz_pressure_max"].value is None for mesh in meshes.values())
        yield _side_by_side(labels, title, "meshes", meshes, _NO_CONTACT if idle else "")


def bearing_tables(result: ResultContents, labels: Labels) -> Iterable[Table]:
    """Figures of planet bearings."""
    if result.planet_bearing is not None:
        part = "planet_bearing"
        yield _figure_table(labels, "Planet bearing", part, result.planet_bearing)
    if result.bearings:
        yield _side_by_side(labels, "Planet bearings", "bearings", result.bearings)


def oil_table(result: ResultContents, labels: Labels) -> Iterable[Table]:
    """Oil and mixture of a single set."""
    if result.fluid is not None:
        yield _figure_table(labels, "Oil", "fluid", result.fluid)


def _figure_table(labels: Labels, title: str, part: str, figures: Mapping[str, Measure]) -> Table:
    """Figures of one part."""
    rows = tuple(
        (
            Cell(label_of(labels, part, name)),
            number(measure.value, f"{part}.{name}"),
            Cell(unit_text(measure.unit)),
        )
        for name, measure in figures.items()
    )
    return Table(("", "value", "unit"), rows, title)


def _side_by_side(
    labels: Labels,
    title: str,
    place: str,
    parts: Mapping[str, Mapping[str, Measure]],
    note: str = "",
) -> Table:
    """Figures of parts of one kind."""
    keys = dict.fromkeys(key for figures in parts.values() for key in figures)
    rows = []
    for key in keys:
        found = {name: figures[key] for name, figures in parts.items() if key in figures}
        first = next(iter(found))
        if key in _ERRORS and all(item.value is None for item in found.values()):
            continue
        cells = (
            number(
                found[name].value,
                f"{place}.{name}.{key}",
                text=error_text(found[name].value or 0.0) if key in _ERRORS else "",
            )
            if name in found
            else Cell("")
            for name in parts
        )
        unit = Cell(unit_text(found[first].unit))
        rows.append((Cell(label_of(labels, first, key)), *cells, unit))
    heads = (name.rpartition(".")[2].replace("_", " ") for name in parts)
    if len(set(map(set_of, parts))) > 1:
        heads = (in_words(name) for name in parts)
    return Table(("", *heads, "unit"), tuple(rows), title, note=note)


def label_of(labels: Labels, part: str, key: str) -> str:
    """Label of a figure without the name of its part."""
    name = f"{part}_{key}"
    return labels[name].partition(": ")[2] if name in labels else key.replace("_", " ")


def users_text(names: Iterable[str]) -> str:
    """Losses that have one method, those of a set of a train together."""
    sets: dict[str, list[str]] = {}
    for name in names:
        owner, _, term = name.rpartition(".")
        sets.setdefault(owner, []).append(term.replace("_", " "))
    parts = (
        f"{in_words(owner)}: {', '.join(terms)}" if owner else ", ".join(terms)
        for owner, terms in sets.items()
    )
    return "; ".join(parts)


def standing_items(result: ResultContents) -> Iterator[Listing]:
    """Which models were used and how well each is known, those that sets share on one line."""
    users: dict[tuple[str, str], list[str]] = {}
    for key, phrase in result.standing.items():
        owner, _, role = key.rpartition(".")
        users.setdefault((role, phrase), []).append(owner)
    lines = []
    for (role, phrase), owners in users.items():
        whose = f" of {', '.join(owners)}" if any(owners) else ""
        lines.append(f"{_ROLES[role]}{whose}: {phrase}")
    if lines:
        yield Listing(tuple(lines), "Models, and how well they are known")
