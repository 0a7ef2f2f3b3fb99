"""Tables of the result of a train, for pages and terminals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from epicyclic.records.contents import Measure, ResultContents
from epicyclic.records.power_flow import power_flow
from epicyclic.report.page import Cell, Table, aligned, number, tenths
from epicyclic.report.result_tables import Labels, flow_units, label_of, scaled, share_row
from epicyclic.report.shown import shown
from epicyclic.results.result import in_words
from epicyclic.study.trains import LOSS_KINDS, loss_sums
from epicyclic.units import percent, unit_text

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
    "seal": "Seals: loss after the chosen formula, and after every one",
    "drag": "Other drags",
}


def sums_table(result: ResultContents) -> Table:
    """Sets and parts below each other, kinds of losses side by side."""
    losses = {name: it for name, it in result.losses.items() if name not in result.not_included}
    sums = loss_sums(losses, result.inputs)
    kinds = [kind for kind in LOSS_KINDS if any(kind in own for own in sums.values())]
    columns = kinds if len(kinds) > 1 else []
    # the shares of the total also stand beside the single losses
    wide = len(columns) > MOST_KINDS

    def ending(watts: float, key: str) -> tuple[Cell, ...]:
        loss, of_total, of_input = share_row(result, watts, key)
        return (loss, of_input) if wide else (loss, of_total, of_input)

    rows = [
        (
            Cell(in_words(stage)),
            *(tenths(own[kind]) if kind in own else Cell("") for kind in columns),
            *ending(sum(own.values()), f"stages.{stage}"),
        )
        for stage, own in sums.items()
    ]
    totals = [sum(own.get(kind, 0.0) for own in sums.values()) for kind in columns]
    rows.append((Cell("total"), *map(tenths, totals), *ending(result.total, "total")))
    head = ("", *columns, "total", *(() if wide else ("of total",)), "of input")
    strong = frozenset([len(rows) - 1])
    return Table(head, tuple(rows), "Losses in W, by set and part", strong, locking_text(result))


def shafts_table(result: ResultContents) -> Table:
    """Speeds, torques and powers of all shafts, and what each passes on."""
    lines = power_flow(result).lines.values()
    speed, torque, power = flow_units(result)
    rows = []
    for name, member in result.members.items():
        line = next(line for line in lines if name in line.shafts)
        others = [shaft for shaft in line.shafts if shaft != name]
        role = line.role if member.torque.value or line.role in ("idle", "at rest") else ""
        joined = f"with {', '.join(others)}" if others else ""
        rows.append(
            (
                Cell(in_words(name)),
                number(member.speed.value, f"members.{name}.speed", 6),
                scaled(member.torque.value, f"members.{name}.torque", torque),
                scaled(member.power.value, f"members.{name}.power", power, 7),
                scaled(line.passed, "", torque),
                Cell(", ".join(filter(None, (role, joined)))),
            )
        )
    heads = (f"speed, {speed}", f"torque, {torque[0]}", f"power, {power[0]}")
    note = (
        "Speeds are positive in one common sense of rotation; torque and power are those from "
        "outside, positive power enters; what a shaft passes on comes from sets, clutches and "
        "outside."
    )
    head = ("", *heads, f"passes on, {torque[0]}", "")
    return Table(head, tuple(rows), "Shafts", note=note)


def rolling_table(result: ResultContents) -> Table:
    """What each mesh would pass with its carrier at rest."""
    entering = result.input_power
    losses = result.losses.keys() & result.rolling_power.keys()
    rows = []
    for key, power in result.rolling_power.items():
        share = percent(abs(power) / entering) if entering else ""
        cells = [
            Cell(in_words(key)),
            tenths(abs(power), f"rolling_power.{key}"),
            aligned(share),
        ]
        if losses:
            watts = result.losses.get(key)
            cells.append(Cell("") if watts is None else tenths(watts))
        rows.append(tuple(cells))
    head = ("", "W", "of input", *(("loss, W",) if losses else ()))
    note = _circulation_text(result.rolling_power, entering)
    return Table(head, tuple(rows), "Rolling power of the meshes", note=note)


def clutches_table(result: ResultContents) -> Iterator[Table]:
    """Torques through closed clutches; nothing if there are none."""
    if not result.clutches:
        return
    rows = tuple(
        (Cell(" + ".join(key.split("+"))), number(torque, f"clutches.{key}", 6))
        for key, torque in result.clutches.items()
    )
    yield Table(("", "torque, N·m"), rows, "Closed clutches")


def terms_table(result: ResultContents) -> Iterator[Table]:
    """Every single loss; nothing if the meshes have said all."""
    if all(name in result.rolling_power for name in result.losses):
        return
    rows = tuple(
        (
            Cell(in_words(name)),
            *share_row(result, watts, f"losses.{name}"),
            Cell(result.groups[name]),
        )
        for name, watts in result.losses.items()
        if name not in result.not_included
    )
    yield Table(("", "loss, W", "of total", "of input", ""), rows, "Single losses")


def part_tables(result: ResultContents, labels: Labels) -> Iterator[Table]:
    """Bearings of shafts, seals and drags: one table for each kind, a row for each part."""
    kinds: dict[tuple[str, tuple[str, ...]], dict[str, dict[str, Measure]]] = {}
    for key, part in result.parts.items():
        kinds.setdefault((key.rpartition(".")[2], tuple(part)), {})[key] = part
    for (kind, names), parts in kinds.items():
        first = next(iter(parts))
        heads = (
            _part_head(name, label_of(labels, first, name), parts[first][name].unit)
            for name in names
        )
        rows = tuple(
            (
                Cell(in_words(key.rpartition(".")[0])),
                _loss(result, key.rpartition(".")[0]),
                *(number(part[name].value, f"parts.{key}.{name}") for name in names),
            )
            for key, part in parts.items()
        )
        yield Table(("", "loss, W", *heads), rows, _TITLES.get(kind, in_words(kind)))


def _loss(result: ResultContents, stage: str) -> Cell:
    watts = result.stages.get(stage)
    return number(watts, f"stages.{stage}", text="" if watts is None else shown(watts))


def locking_text(result: ResultContents) -> str:
    """That no power arrives, in a sentence; empty where some does."""
    if result.jammed:
        return f"Self-locking: {result.input} cannot turn the train, which stands still."
    if result.self_locking:
        return (
            f"Self-locking: {result.input} cannot drive {result.output}; the losses take all "
            f"power, and {result.output} must be driven too."
        )
    return ""


def _circulation_text(rolling: Mapping[str, float], input_power: float) -> str:
    """Which meshes pass more than enters, in a sentence; empty if none does."""
    most = {key: abs(power) for key, power in rolling.items() if _circulates(power, input_power)}
    if not most or not input_power:
        return ""
    largest = max(most, key=lambda key: most[key])
    names, verb = ", ".join(map(in_words, most)), "pass" if len(most) > 1 else "passes"
    return (
        f"Power circulates: {names} {verb} more than enters, {in_words(largest)} "
        f"{shown(most[largest] / input_power, 3)} times as much."
    )


def _circulates(power: float, input_power: float) -> bool:
    # a first mesh at rest against its carrier passes the input power itself, up to rounding
    return abs(power) > (1 + 1e-9) * input_power


def _part_head(key: str, label: str, unit: str) -> str:
    """Head of the column of a figure, short where many stand side by side."""
    return f"{SHORT_HEADS.get(key, label)} {unit_text(unit)}".rstrip()
