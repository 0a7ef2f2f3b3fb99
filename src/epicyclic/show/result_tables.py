"""Tables of one result, and of two beside each other, for pages and terminals."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from epicyclic.case.case import Case
from epicyclic.case.tables.models import AS_TESTED
from epicyclic.errors import ConvergenceError
from epicyclic.machine.element import Figure, figures
from epicyclic.machine.gear_mesh import MeshFigures
from epicyclic.messages import sentence
from epicyclic.registry import load, offered
from epicyclic.result.result import HeatBalance, MemberState, Result, Train, in_words, set_of
from epicyclic.schema.read import flattened
from epicyclic.show.page import (
    MISSING,
    Cell,
    KeyFigure,
    Listing,
    Table,
    aligned,
    error_text,
    number,
    shown,
    tenths,
)
from epicyclic.show.power_flow import power_flow
from epicyclic.show.template import toml_value
from epicyclic.study.heat import BeyondRange, Found, beyond_range, hottest, takes_minutes
from epicyclic.study.solve import solve
from epicyclic.study.trains import LOSS_KINDS, loss_sums
from epicyclic.units import (
    CELSIUS,
    DEGREE,
    NEWTON_METRE,
    RPM,
    WATT,
    celsius_text,
    decimals_of,
    format_number,
    known_text,
    large_unit,
    part_text,
    percent,
    power_unit,
    unit_text,
)

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Unit = tuple[str, float]  # Its name in print and its size.
_FLOW_NOTE = (
    "All speeds are positive in the same sense of rotation. Torques act from outside; power is "
    "positive where it enters."
)
_ROLES = {
    "lubrication": "lubrication",
    "churning": "churning",
    "friction": "friction",
    "rolling": "rolling loss",
    "bearing": "planet bearing",
    "shaft_bearing": "shaft bearing",
    "drag": "drag",
}
_RATIO = "times the input power"
_ERRORS = ("pocket_power_difference", "pocket_interpolation_error")
"""Figures of meshes that tell how well others are computed; there are none of what is solved."""
_NO_CONTACT = f'"{MISSING}": no load or no motion in the mesh.'


def key_figures(result: Result) -> list[KeyFigure]:
    """What a reader looks for first."""
    efficiency = result.efficiency
    text = "" if efficiency is None else f"{100 * efficiency:.3f}"
    train = result.train
    return [
        *([KeyFigure("ratio", number(train.ratio, "ratio", 5))] if train else []),
        KeyFigure("efficiency", number(efficiency, "efficiency", text=text), "%" if text else ""),
        _power("total loss", result.total, "total"),
        _power("load-dependent", result.load_dependent, "load_dependent"),
        _power("load-independent", result.load_independent, "load_independent"),
        _power("input power", result.input_power, ""),
        *(
            [KeyFigure("rolling power", number(train.power_ratio, "power_ratio"), _RATIO)]
            if train and train.power_ratio is not None
            else []
        ),
    ]


def _power(label: str, watts: float, key: str) -> KeyFigure:
    """With three significant digits, four of watts: no more are known."""
    text, _, unit = known_text(watts).partition(" ")
    return KeyFigure(label, number(watts, key, text=text), unit)


def share_row(
    result: Result, watts: float, key: str, decimals: int = 1, size: float = 1.0
) -> tuple[Cell, Cell, Cell]:
    """Power, share of the total loss, share of the input power."""
    of_total = percent(watts / result.total) if result.total else ""
    of_input = percent(watts / result.input_power, 3) if result.input_power else ""
    loss = number(watts, key, text=part_text(watts / size, result.total / size, decimals))
    return loss, aligned(of_total), aligned(of_input)


def losses_table(result: Result, *, most: int | None = None) -> Table:
    """The losses of a single set, group by group.

    With `most`, the largest ones in so many rows with as many digits as are known: all drags
    together, and smaller losses as others.
    """
    unit, size, decimals = _known_unit(result, in_watts=most is None)
    losses, groups, left_out = result.losses, result.groups, result.not_included
    shown_from, least = -math.inf, 0.5 * size / 10**decimals
    if most is not None:
        drags = [name for name in losses if name.endswith("_drag")]
        if drags:
            kept = {name: watts for name, watts in losses.items() if name not in drags}
            losses = {**kept, "drag": sum(losses[name] for name in drags)}
            groups = {**groups, "drag": groups[drags[0]]}
        shown_from = max(sorted(losses.values(), reverse=True)[:most][-1], least)
    rows: list[tuple[Cell, ...]] = []
    strong = []
    tested = ", as tested" if result.inputs["models"].get("load_dependent") == AS_TESTED else ""
    for group in dict.fromkeys(groups.values()):
        key, rest = group.replace("-", "_"), 0.0
        for name, watts in losses.items():
            if groups[name] != group:
                continue
            if watts < shown_from:
                rest += watts
            elif name in left_out:
                rows.append((Cell(in_words(name)), Cell("not included"), Cell(""), Cell("")))
            else:
                cells = share_row(result, watts, f"losses.{name}", decimals, size)
                rows.append((Cell(in_words(name)), *cells))
        if rest >= least:
            rows.append((Cell("others"), *share_row(result, rest, "", decimals, size)))
        strong.append(len(rows))
        sums = share_row(result, getattr(result, key), key, decimals, size)
        rows.append((Cell(f"{group}{tested}"), *sums))
    strong.append(len(rows))
    rows.append((Cell("total"), *share_row(result, result.total, "total", decimals, size)))
    head = ("", f"loss, {unit}", "of total", "of input")
    return Table(head, tuple(rows), "Losses" if most is None else "", frozenset(strong))


def _known_unit(result: Result, *, in_watts: bool) -> tuple[str, float, int]:
    """Unit of losses in print, its size, and the decimals that are known of them.

    In watts, where all losses are listed, small ones have one decimal or more.
    """
    if in_watts:
        return WATT.display, 1.0, max(1, decimals_of(result.total))
    unit, size = power_unit(result.total)
    return unit, size, decimals_of(result.total / size)


def flow_units(result: Result) -> tuple[str, Unit, Unit]:
    """The units of speeds, torques and powers of all members in print."""
    members = result.flow.members.values()
    torque = large_unit(max(abs(one.torque) for one in members), NEWTON_METRE.display)
    power = large_unit(max(abs(one.power) for one in members), WATT.display)
    return unit_text(RPM.display), torque, power


def _flow_cells(name: str, member: MemberState, torque: Unit, power: Unit) -> tuple[Cell, ...]:
    place = f"members.{name}"
    return (
        number(RPM.to_display(member.speed), f"{place}.speed", 6),
        scaled(member.torque, f"{place}.torque", torque),
        scaled(member.power, f"{place}.power", power, 7),
    )


def scaled(value: float, key: str, unit: Unit, digits: int = 6) -> Cell:
    """A cell of a column in `unit`."""
    return number(value, key, text=shown(value / unit[1], digits))


def members_table(result: Result) -> Table:
    """Speeds, torques and powers of the members of a single set."""
    speed, torque, power = flow_units(result)
    rows = tuple(
        (Cell(name), *_flow_cells(name, member, torque, power))
        for name, member in result.flow.members.items()
    )
    heads = (f"speed, {speed}", f"torque, {torque[0]}", f"power, {power[0]}")
    return Table(("", *heads), rows, "Power flow", note=_FLOW_NOTE)


def planets_table(result: Result) -> tuple[Table, ...]:
    """Where the planets are and how much each carries; nothing without planets."""
    if not result.planet_angles:
        return ()
    rows = tuple(
        (
            Cell(f"{place + 1}"),
            number(DEGREE.to_display(angle), f"planet_angles.{place}", 7),
            number(share, f"planet_shares.{place}", 4, percent(share, 2)),
        )
        for place, (angle, share) in enumerate(
            zip(result.planet_angles, result.planet_shares, strict=True)
        )
    )
    unit = unit_text(DEGREE.display)
    return (Table(("planet", f"angle, {unit}", "share of the torque"), rows, "Planets"),)


def mesh_tables(result: Result) -> Iterable[Table]:
    """Figures of the meshes of each set side by side."""
    sets: dict[str, dict[str, MeshFigures]] = {}
    for key, mesh in result.meshes.items():
        sets.setdefault(set_of(key), {})[key] = mesh
    for name, meshes in sets.items():
        title = f"Meshes of {in_words(name)}" if name else "Meshes"
        idle = any(math.isnan(mesh.hertz_pressure_max) for mesh in meshes.values())
        yield _side_by_side(title, "meshes", meshes, _NO_CONTACT if idle else "")


def bearing_tables(result: Result) -> Iterable[Table]:
    """Figures of planet bearings."""
    if result.train is not None and result.bearings:
        yield _side_by_side("Planet bearings", "bearings", result.bearings)
    elif result.train is None and result.bearing is not None:
        yield _figure_table("Planet bearing", "planet_bearing", result.bearing)


def oil_table(result: Result) -> Iterable[Table]:
    """Oil and mixture of a single set."""
    if result.fluid is not None:
        yield _figure_table("Oil", "fluid", result.fluid)


def _figure_table(title: str, part: str, source: DataclassInstance) -> Table:
    rows = tuple(
        (Cell(it.label), _figure(it, f"{part}.{it.key}"), Cell(unit_text(it.unit)))
        for it in figures(source)
    )
    return Table(("", "value", "unit"), rows, title)


def _figure(it: Figure, place: str) -> Cell:
    if math.isnan(it.value):
        return Cell(MISSING)
    return number(it.value, place, text=error_text(it.value) if it.key in _ERRORS else "")


def _side_by_side(
    title: str, place: str, parts: Mapping[str, DataclassInstance], note: str = ""
) -> Table:
    """Figures of parts of one kind."""
    rows = []
    for row in zip(*map(figures, parts.values()), strict=True):
        first = row[0]
        if first.key in _ERRORS and all(math.isnan(it.value) for it in row):
            continue
        named = zip(parts, row, strict=True)
        cells = (_figure(it, f"{place}.{name}.{it.key}") for name, it in named)
        rows.append((Cell(first.label), *cells, Cell(unit_text(first.unit))))
    heads = (name.rpartition(".")[2].replace("_", " ") for name in parts)
    if len(set(map(set_of, parts))) > 1:
        heads = (in_words(name) for name in parts)
    return Table(("", *heads, "unit"), tuple(rows), title, note=note)


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


def standing_items(result: Result) -> Iterator[Listing]:
    """Which models were used and how well each is known, those that sets share on one line."""
    users: dict[tuple[str, str], list[str]] = {}
    included = result.losses.keys() - set(result.not_included)
    on_bearings = {set_of(name) for name in included if name.endswith("bearing_mechanical")}
    for key, phrase in result.standing.items():
        owner, _, role = key.rpartition(".")
        if role != "bearing" or owner in on_bearings:
            users.setdefault((role, phrase), []).append(owner)
    lines = []
    for (role, phrase), owners in users.items():
        whose = f" of {', '.join(owners)}" if any(owners) else ""
        lines.append(f"{_ROLES[role]}{whose}: {phrase}")
    if lines:
        yield Listing(tuple(lines), "Models and their reliability")


# Tables of the result of a train, for pages and terminals.

SHORT_HEADS = {
    "radial_force": "radial",
    "axial_force": "axial",
    "friction_load": "P1",
    "minimum_load": "minimum load",
    "speed": "speed",
    "lip_speed": "lip",
    "friction_torque": "torque",
    "coefficient": "f1",
    "iso_14179_1_viton": "14179-1 Viton",
    "iso_14179_1_buna_n": "14179-1 Buna N",
    "iso_14179_2": "14179-2",
    "linke": "Linke",
}
MOST_KINDS = 5
"""Kinds of losses beside each other in a table that also has room for shares of the total."""
_TITLES = {
    "bearing": "Shaft bearings",
    "seal": "Seals: loss by the chosen formula and by every formula",
    "drag": "Other drags",
}


def sums_table(result: Result, train: Train, *, most: int | None = None) -> Table:
    """Sets and parts below each other, kinds of losses side by side.

    With `most`, that many rows with as many digits as are known, smaller ones together.
    """
    losses = {name: it for name, it in result.losses.items() if name not in result.not_included}
    sums = loss_sums(losses, result.inputs)
    unit, size, decimals = _known_unit(result, in_watts=most is None)
    if most is not None:
        sums = _largest(sums, most)

    kinds = [kind for kind in LOSS_KINDS if any(kind in own for own in sums.values())]
    columns = kinds if len(kinds) > 1 else []
    # the shares of the total also stand beside the single losses
    wide = len(columns) > MOST_KINDS

    def ending(watts: float, key: str = "") -> tuple[Cell, ...]:
        loss, of_total, of_input = share_row(result, watts, key, decimals, size)
        if most is not None:
            return (loss,) if wide else (loss, of_total)
        return (loss, of_input) if wide else (loss, of_total, of_input)

    rows = [
        (
            Cell(in_words(stage)),
            *(ending(own[kind])[0] if kind in own else Cell("") for kind in columns),
            *ending(sum(own.values()), f"stages.{stage}"),
        )
        for stage, own in sums.items()
    ]
    totals = [ending(sum(own.get(kind, 0.0) for own in sums.values()))[0] for kind in columns]
    rows.append((Cell("total"), *totals, *ending(result.total, "total")))
    shares = () if wide else ("of total",)
    head = ("", *columns, "total", *shares, *(("of input",) if most is None else ()))
    strong = frozenset([len(rows) - 1])
    title, note = f"Losses in {unit}, by set and part", locking_text(train)
    return Table(head, tuple(rows), title, strong, note if most is None else "")


def _largest(sums: dict[str, dict[str, float]], most: int) -> dict[str, dict[str, float]]:
    """The sets and parts that lose most, in their order, and the others together."""
    small = sorted(sums, key=lambda stage: -sum(sums[stage].values()))[most - 1 :]
    if len(small) < 2:
        return sums
    others: Counter[str] = Counter()
    for stage in small:
        others.update(sums[stage])
    kept = {stage: own for stage, own in sums.items() if stage not in small}
    return {**kept, f"{len(small)} others": dict(others)}


def shafts_table(result: Result) -> Table:
    """Speeds, torques and powers of all shafts, and what each passes on."""
    lines = power_flow(result).lines.values()
    speed, torque, power = flow_units(result)
    rows = []
    for name, member in result.flow.members.items():
        line = next(line for line in lines if name in line.shafts)
        others = [shaft for shaft in line.shafts if shaft != name]
        role = line.role if member.torque or line.role in ("idle", "at rest") else ""
        joined = f"with {', '.join(others)}" if others else ""
        rows.append(
            (
                Cell(in_words(name)),
                *_flow_cells(name, member, torque, power),
                scaled(line.passed, "", torque),
                Cell(", ".join(filter(None, (role, joined)))),
            )
        )
    held = -sum(member.torque for member in result.flow.members.values())
    housing = scaled(held, "", torque)
    rows.append((Cell("housing"), number(0.0, ""), housing, Cell(""), Cell(""), Cell("at rest")))
    heads = (f"speed, {speed}", f"torque, {torque[0]}", f"power, {power[0]}")
    note = f"{_FLOW_NOTE} The transmitted torque includes those of sets and clutches."
    return Table(("", *heads, f"transmits, {torque[0]}", ""), tuple(rows), "Shafts", note=note)


def rolling_table(result: Result, train: Train) -> Table:
    """What each mesh would pass with its carrier at rest."""
    entering = result.input_power
    losses = result.losses.keys() & train.rolling.keys()
    rows = []
    for key, power in train.rolling.items():
        share = percent(abs(power) / entering) if entering else ""
        cells = [Cell(in_words(key)), tenths(abs(power), f"rolling_power.{key}"), aligned(share)]
        if losses:
            watts = result.losses.get(key)
            cells.append(Cell("") if watts is None else tenths(watts))
        rows.append(tuple(cells))
    head = ("", "W", "of input", *(("loss, W",) if losses else ()))
    note = _circulation_text(train.rolling, entering)
    return Table(head, tuple(rows), "Rolling power of the meshes", note=note)


def clutches_table(train: Train) -> Iterator[Table]:
    """Torques through closed clutches; nothing if there are none."""
    if not train.clutches:
        return
    rows = tuple(
        (Cell(" + ".join(key.split("+"))), number(torque, f"clutches.{key}", 6))
        for key, torque in train.clutches.items()
    )
    yield Table(("", "torque, N·m"), rows, "Closed clutches")


def terms_table(result: Result, train: Train) -> Iterator[Table]:
    """Every single loss; nothing if the meshes have said all."""
    if all(name in train.rolling for name in result.losses):
        return
    groups, (_, _, decimals) = result.groups, _known_unit(result, in_watts=True)
    rows = tuple(
        (
            Cell(in_words(name)),
            *share_row(result, watts, f"losses.{name}", decimals),
            Cell(groups[name]),
        )
        for name, watts in result.losses.items()
        if name not in result.not_included
    )
    yield Table(("", "loss, W", "of total", "of input", ""), rows, "Single losses")


def part_tables(result: Result) -> Iterator[Table]:
    """Bearings of shafts, seals and drags: one table for each kind, a row for each part."""
    kinds: dict[tuple[str, type], dict[str, DataclassInstance]] = {}
    for key, part in result.parts.items():
        kinds.setdefault((key.rpartition(".")[2], type(part)), {})[key] = part
    losses = result.stage_losses
    for (kind, _), parts in kinds.items():
        heads = (
            f"{SHORT_HEADS.get(it.key, it.label)}, {unit_text(it.unit)}".rstrip(", ")
            for it in figures(next(iter(parts.values())))
        )
        rows = tuple(
            (
                Cell(in_words(stage)),
                number(losses.get(stage), f"stages.{stage}"),
                *(_figure(it, f"parts.{key}.{it.key}") for it in figures(part)),
            )
            for key, part in parts.items()
            for stage in (key.rpartition(".")[0],)
        )
        yield Table(("", "loss, W", *heads), rows, _TITLES.get(kind, in_words(kind).capitalize()))


def locking_text(train: Train) -> str:
    """That no power arrives, in a sentence; empty where some does."""
    if train.jammed:
        return f"Self-locking: {train.input} cannot turn the train, which stands still."
    if train.self_locking:
        return (
            f"Self-locking: {train.input} cannot drive {train.output}; the losses consume all "
            f"power, so {train.output} must be driven too."
        )
    return ""


def _circulation_text(rolling: Mapping[str, float], input_power: float) -> str:
    """Which meshes pass more than enters, in a sentence; empty if none does."""
    # a first mesh at rest against its carrier passes the input power itself, up to rounding
    least = (1 + 1e-9) * input_power
    most = {key: abs(power) for key, power in rolling.items() if abs(power) > least}
    if not most or not input_power:
        return ""
    largest = max(most, key=lambda key: most[key])
    names, verb = ", ".join(map(in_words, most)), "pass" if len(most) > 1 else "passes"
    return (
        f"Power circulates: {names} {verb} more than the input power, {in_words(largest)} "
        f"{shown(most[largest] / input_power, 3)} times as much."
    )


# Temperatures and the heat balance, as tables of pages and terminals, and what they mean.

NOT_LOOKED_AT = (
    "The flank temperatures were not computed: with models.friction = ehl-direct that takes "
    "minutes. Set models.temperatures = flank to compute them."
)


def _temperatures(heat: HeatBalance) -> Table:
    """Temperatures of all parts, from the hottest, and the heat that losses bring to them."""
    brought = heat.brought
    places = dict.fromkeys(heat.temperatures, "temperatures") | dict.fromkeys(heat.given, "given")
    known = {**heat.temperatures, **heat.given}
    rows = []
    for node in sorted(known, key=lambda node: (node in heat.given, -known[node])):
        value = CELSIUS.to_display(known[node])
        rows.append(
            (
                Cell(in_words(node)),
                number(value, f"heat.{places[node]}.{node}.value", text=f"{value:.1f}"),
                tenths(known[node] - heat.oil),
                tenths(brought[node]) if node in brought else Cell(""),
            )
        )
    note = (
        "Gear temperatures are bulk temperatures. Parts that are not listed have the temperature "
        "of the oil, which absorbs their heat."
    )
    head = ("", unit_text(CELSIUS.display), "above the oil, K", "heat of losses, W")
    return Table(head, tuple(rows), "Temperatures", note=note)


def _balance(heat: HeatBalance) -> Table:
    """Where the heat leaves the gearbox."""
    whole = sum(path.watts for path in heat.outlets)
    rows = [
        (
            Cell(f"{in_words(path.hot)} to {in_words(path.into)}"),
            Cell(path.method),
            *_shared(path.watts, whole, f"heat.ways.{path.key}.heat"),
        )
        for path in heat.outlets
    ]
    rows.append((Cell("all losses"), Cell(""), *_shared(whole, whole, "")))
    strong = frozenset([len(rows) - 1])
    return Table(("", "", "W", "of all"), tuple(rows), "Where the heat leaves", strong)


def _shared(watts: float, whole: float, key: str) -> tuple[Cell, Cell]:
    return tenths(watts, key), aligned(percent(watts / whole) if whole else "")


def heat_path_items(heat: HeatBalance) -> tuple[Table | Listing, ...]:
    """Every path of the heat, and where its conductance is from."""
    rows = tuple(
        (
            Cell(path.key),
            tenths(path.watts, f"heat.ways.{path.key}.heat"),
            number(
                None if math.isnan(path.conductance) else path.conductance,
                f"heat.ways.{path.key}.conductance",
            ),
            Cell(path.method),
        )
        for path in heat.ways
    )
    methods: dict[str, set[str]] = {}
    for path in heat.ways:
        methods.setdefault(path.method, set()).add(path.source or "given")
    return (
        Table(("from-to", "W", "W/K", "method"), rows, "Heat paths", note=_SIGN),
        Listing(
            tuple(f"{method}: {'; '.join(sorted(found))}" for method, found in methods.items()),
            "Sources of the conductances",
        ),
    )


_SIGN = (
    "Negative heat flows in the other direction. thermal.conductances changes a path by its name "
    "in the first column."
)


def heat_items(heat: HeatBalance) -> Iterator[Table]:
    """What every result states about its heat."""
    yield _temperatures(heat)
    if heat.ways:
        yield _balance(heat)


def found_text(found: Found) -> str:
    """What leads to the temperature that was asked for."""
    text = f"{found.key} = {unit_text(found.unit.text(found.value))}"
    power = found.result.input_power
    also = f", input power {power:.6g} W," if found.key == "operation.torque" else ""
    return f"With {text}{also} the oil is at {celsius_text(found.temperature)}."


def remarks(case: Case, result: Result) -> Iterator[str]:
    """What other temperatures, and oil that is not held in a range, would change."""
    if takes_minutes(result):
        if result.heat is None:
            yield NOT_LOOKED_AT
        return
    if result.heat is None and any(mesh.contact is not None for mesh in result.meshes.values()):
        # at the bulk temperatures that its own meshes give to its gears
        yield _flank_text(result, _or_reason(case.updated({"models.temperatures": "flank"})))
    beyond = beyond_range(case, result)
    if beyond is not None:
        free = _or_reason(case.updated({"models.oil_beyond_range": "extrapolated"}))
        yield _beyond_text(beyond, free)


def _or_reason(case: Case) -> Result | str:
    """The result of a case, or why there is none."""
    try:
        return solve(case)
    except ConvergenceError as error:
        return sentence(str(error), capital=False)


def _flank_text(result: Result, warm: Result | str) -> str:
    if isinstance(warm, str):
        return f"With models.temperatures = flank there is no result: {warm}"
    assert warm.heat is not None
    node = hottest(warm.heat)
    kelvin = warm.heat.temperatures[node]
    return (
        f"With models.temperatures = flank the hottest gear, {in_words(node)}, would be at "
        f"{CELSIUS.to_display(kelvin):.0f} {unit_text(CELSIUS.display)}, "
        f"{kelvin - warm.heat.oil:.0f} K above the oil; the total loss would be "
        f"{known_text(warm.total)} ({percent(warm.total / result.total - 1, signed=True)})."
    )


def _beyond_text(beyond: BeyondRange, free: Result | str) -> str:
    low, high = (format_number(limit) for limit in (beyond.low, beyond.high))
    unit = unit_text(CELSIUS.display)
    text = (
        f"{100 * beyond.share:.0f} % of the load-dependent loss arises in contacts whose oil is "
        f"hotter than the range of its formula ({low} to {high} {unit}) and is held at {high} "
        f"{unit}; without this limit "
    )
    if isinstance(free, str):
        return f"{text}there is no result: {free}"
    return f"{text}the total would be {free.total:.0f} W."


def side_by_side(
    first: Result,
    second: Result,
    names: tuple[str, str],  # What they are called.
) -> Iterator[Table]:
    """Key figures, losses and inputs of two results."""
    figures = [
        {it.label: replace(it.cell, text=it.text) for it in key_figures(result)}
        for result in (first, second)
    ]
    rows = tuple(
        (Cell(label), *(one.get(label, Cell(MISSING)) for one in figures))
        for label in figures[0] | figures[1]
    )
    yield Table(("", *names), rows, "Key figures")
    yield _losses(first, second, names)
    inputs = [
        {
            key: value if isinstance(value, str) else toml_value(value)
            for key, value in flattened(result.inputs)
        }
        for result in (first, second)
    ]
    changed = [key for key in inputs[0] | inputs[1] if inputs[0].get(key) != inputs[1].get(key)]
    rows = tuple((Cell(key), *(Cell(one.get(key, MISSING)) for one in inputs)) for key in changed)
    if rows:
        yield Table(("key", *names), rows, "Inputs that differ")


def _losses(first: Result, second: Result, names: tuple[str, str]) -> Table:
    found = first.losses, second.losses
    digits = max(_known_unit(one, in_watts=True)[2] for one in (first, second))
    pairs = {name: (found[0].get(name), found[1].get(name)) for name in found[0] | found[1]}
    pairs["total"] = first.total, second.total
    rows = [_difference(in_words(name), *pair, digits) for name, pair in pairs.items()]
    strong = frozenset({len(rows) - 1})
    return Table(("", *names, "difference", ""), tuple(rows), "Losses in W", strong)


def _difference(
    label: str, first: float | None, second: float | None, digits: int
) -> tuple[Cell, ...]:
    values = tuple(
        number(it, "", text="" if it is None else f"{it:z.{digits}f}") for it in (first, second)
    )
    if first is None or second is None:
        return (Cell(label), *values, Cell(MISSING), Cell(MISSING))
    share = percent((second - first) / first, signed=True) if first else ""
    change = number(second - first, "", text=f"{second - first:+z.{digits}f}")
    return Cell(label), *values, change, aligned(share)


def adjusted(case: Case) -> Iterator[Listing]:
    """What was computed from other inputs, converted or adjusted; nothing if nothing was."""
    if case.found:
        yield Listing(tuple(map(str, case.found)), "Computed, converted or adjusted")


def details(case: Case, result: Result | None = None) -> Iterator[Table | Listing]:
    """What plug-ins show of a case that has their tables."""
    for name in offered("details"):
        if getattr(case, name, None) is not None:
            yield from load("details", name)(case, result)
