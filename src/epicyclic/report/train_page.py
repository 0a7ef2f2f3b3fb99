"""The report of a train: what its chapters have beside those of a single set."""

from __future__ import annotations

from collections.abc import Iterator

from epicyclic.analysis.train_losses import LOSS_KINDS, loss_sums
from epicyclic.plots.power_flow import contents_flow
from epicyclic.records.contents import Measure, ResultContents
from epicyclic.records.record import ResultRecord
from epicyclic.report.page import (
    Cell,
    Drawings,
    Gallery,
    Item,
    Row,
    Table,
    aligned,
    gallery,
    number,
)
from epicyclic.report.result_parts import share_cells
from epicyclic.report.shown import shown
from epicyclic.report.train_tables import circulation_text, locking_text, part_head
from epicyclic.results.result import in_words
from epicyclic.units import unit_text

__all__ = ["label_of", "model_key", "part_tables", "share_row", "train_losses"]

_TITLES = {"bearing": "Shaft bearings", "seal": "Seals", "drag": "Other drags"}


def model_key(key: str) -> str:
    """The key of the case that chooses a model: ``"sets.P1.models.friction"``."""
    name, dot, model = key.rpartition(".")
    return f"sets.{name}.models.{model}" if dot else f"models.{key}"


def train_losses(result: ResultContents, drawings: Drawings) -> tuple[Item, ...]:
    """The chapter on losses: power flow, sums, shafts, rolling powers, every single loss."""
    items: list[Item] = [*gallery(drawings, "power-flow", wide=True), _sums(result)]
    items.append(Row((*gallery(drawings, "losses"), *gallery(drawings, "loss-sum"))))
    items.append(_shafts(result))
    side: list[Table | Gallery] = [_rolling(result)]
    if result.clutches:
        side.append(_clutches(result))
    items.append(Row(tuple(side)))
    if any(name not in result.rolling_power for name in result.losses):
        items.append(_terms(result))
    return tuple(items)


def share_row(result: ResultContents, watts: float, key: str) -> tuple[Cell, Cell, Cell]:
    """Power, share of the total loss, share of the input power."""
    text, *shares = share_cells(result, watts)
    of_total, of_input = map(aligned, shares)
    return number(watts, key, text=text), of_total, of_input


def _sums(result: ResultContents) -> Table:
    """Sets and parts below each other, kinds of losses side by side."""
    losses = {name: it for name, it in result.losses.items() if name not in result.not_included}
    sums = loss_sums(losses, result.inputs)
    kinds = [kind for kind in LOSS_KINDS if any(kind in own for own in sums.values())]
    columns = kinds if len(kinds) > 1 else []
    rows = [
        (
            Cell(in_words(stage)),
            *(
                number(own[kind], "", text=f"{own[kind]:z.1f}") if kind in own else Cell("")
                for kind in columns
            ),
            *share_row(result, sum(own.values()), f"stages.{stage}"),
        )
        for stage, own in sums.items()
    ]
    totals = [sum(own.get(kind, 0.0) for own in sums.values()) for kind in columns]
    whole = (number(watts, "", text=f"{watts:z.1f}") for watts in totals)
    rows.append((Cell("total"), *whole, *share_row(result, result.total, "total")))
    head = ("", *columns, "total", "of total", "of input")
    strong = frozenset([len(rows) - 1])
    note = locking_text(result.input, result.output) if result.self_locking else ""
    return Table(head, tuple(rows), "Losses in W, by set and part", strong, note)


def _shafts(result: ResultContents) -> Table:
    """Speeds, torques and powers of all shafts, and what each passes on."""
    lines = contents_flow(result).lines.values()
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
                number(member.torque.value, f"members.{name}.torque", 6),
                number(member.power.value, f"members.{name}.power", 7),
                number(line.passed, "", 6),
                Cell(", ".join(filter(None, (role, joined)))),
            )
        )
    first = next(iter(result.members.values()))
    units = [unit_text(one.unit) for one in (first.speed, first.torque, first.power)]
    heads = (f"speed, {units[0]}", f"torque, {units[1]}", f"power, {units[2]}")
    note = (
        "Speeds are positive in one common sense of rotation; torque and power are those from "
        "outside, positive power enters; what a shaft passes on comes from sets, clutches and "
        "outside."
    )
    head = ("", *heads, f"passes on, {units[1]}", "")
    return Table(head, tuple(rows), "Shafts", note=note)


def _rolling(result: ResultContents) -> Table:
    entering = result.input_power
    losses = result.losses.keys() & result.rolling_power.keys()
    rows = []
    for key, power in result.rolling_power.items():
        share = f"{abs(power) / entering:z.1%}" if entering else ""
        cells = [
            Cell(in_words(key)),
            number(abs(power), f"rolling_power.{key}", text=f"{abs(power):z.1f}"),
            aligned(share),
        ]
        if losses:
            watts = result.losses.get(key)
            loss = Cell("") if watts is None else number(watts, "", text=f"{watts:z.1f}")
            cells.append(loss)
        rows.append(tuple(cells))
    head = ("", "W", "of input", *(("loss, W",) if losses else ()))
    note = circulation_text(result.rolling_power, entering)
    return Table(head, tuple(rows), "Rolling power of the meshes", note=note)


def _clutches(result: ResultContents) -> Table:
    rows = tuple(
        (Cell(" + ".join(key.split("+"))), number(torque, f"clutches.{key}", 6))
        for key, torque in result.clutches.items()
    )
    return Table(("", "torque, N·m"), rows, "Closed clutches")


def _terms(result: ResultContents) -> Table:
    rows = tuple(
        (
            Cell(in_words(name)),
            *share_row(result, watts, f"losses.{name}"),
            Cell(result.groups[name]),
        )
        for name, watts in result.losses.items()
        if name not in result.not_included
    )
    return Table(("", "loss, W", "of total", "of input", ""), rows, "Single losses")


def part_tables(record: ResultRecord) -> Iterator[Table]:
    """Bearings of shafts, seals and drags: one table for each kind, a row for each part."""
    result = record.result
    kinds: dict[tuple[str, tuple[str, ...]], dict[str, dict[str, Measure]]] = {}
    for key, part in result.parts.items():
        kinds.setdefault((key.rpartition(".")[2], tuple(part)), {})[key] = part
    for (kind, names), parts in kinds.items():
        first = next(iter(parts))
        heads = (
            part_head(name, label_of(record, first, name), parts[first][name].unit)
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


def label_of(record: ResultRecord, part: str, key: str) -> str:
    """Label of a figure, as the numbers of the record have it."""
    name = f"{part}_{key}"
    if name not in record.numbers:
        return key.replace("_", " ")
    return str(record.numbers[name].attrs["long_name"]).partition(": ")[2]
