"""Tables of the result of a train for a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from epicyclic.analysis.train_flow import train_flow
from epicyclic.analysis.train_losses import LOSS_KINDS, loss_sums
from epicyclic.analysis.train_states import StateKinematics, train_states
from epicyclic.case.train import TrainCase
from epicyclic.elements.base import HOUSING
from epicyclic.elements.figures import figures
from epicyclic.report.result_parts import (
    efficiency_text,
    meshes_table,
    number_table,
    plain_table,
    share_cells,
    side_by_side,
)
from epicyclic.report.shown import MISSING, shown
from epicyclic.results.result import Result, Train, in_words
from epicyclic.units import NEWTON_METRE, RPM, format_number, unit_text

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

__all__ = [
    "circulation_text",
    "headline",
    "locking_text",
    "part_head",
    "state_tables",
    "train_tables",
    "users_text",
]

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
    "ShaftBearingFigures": "Shaft bearings",
    "SealFigures": "Seals: loss after the chosen formula, and after every one",
    "TableLossFigures": "Drags",
}


def train_tables(result: Result, train: Train) -> list[RenderableType]:
    """What a train states: losses, shafts, meshes, bearings, seals."""
    head = [Text(headline(train, efficiency_text(result)))]
    if train.self_locking:
        head.append(Text(locking_text(train.input, train.output), style="bold"))
    parts: list[RenderableType] = [Group(*head), _losses(result), _shafts(result)]
    parts.append(_rolling(result, train))
    if train.clutches:
        parts.append(_clutches(train))
    if any(name not in train.rolling for name in result.losses):
        parts.append(_terms(result))
    for stage, meshes in _by_stage(result.meshes).items():
        parts.append(meshes_table(f"Meshes of {in_words(stage)}", meshes))
    if result.bearings:
        bearings = {in_words(key): figures(item) for key, item in result.bearings.items()}
        parts.append(side_by_side("Planet bearings", bearings))
    return parts + list(_parts(result))


def headline(train: Train, efficiency: str) -> str:
    """State, ratio, efficiency and power ratio in one line."""
    words = [f"State {train.state}"] if train.state else []
    ratio = "none, the output stands still" if train.ratio is None else shown(train.ratio, 5)
    words += [f"ratio {ratio}", f"efficiency {efficiency}"]
    if train.power_ratio is not None:
        words.append(f"rolling power {shown(train.power_ratio)} times the input power")
    text = ", ".join(words)
    return f"{text[0].upper()}{text[1:]}."


def locking_text(driven: str, output: str) -> str:
    """That no power arrives, in a sentence."""
    return (
        f"Self-locking: {driven} cannot drive {output}; the losses take all power, and {output} "
        "must be driven too."
    )


def circulation_text(rolling: Mapping[str, float], input_power: float) -> str:
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


def _losses(result: Result) -> Table:
    """Sets and parts below each other, kinds of losses side by side."""
    losses = {term.name: term.watts for term in result.terms if not term.left_out}
    sums = loss_sums(losses, result.inputs)
    kinds = [kind for kind in LOSS_KINDS if any(kind in own for own in sums.values())]
    columns = kinds if len(kinds) > 1 else []
    # a wide table leaves out the shares of the total, which stand beside the single losses too
    wide = len(columns) > MOST_KINDS
    heads = ["total", "of input"] if wide else ["total", "of total", "of input"]
    table = number_table("Losses in W", "", *columns, *heads)
    for column in table.columns:
        column.no_wrap = True

    def ending(watts: float) -> Iterator[str]:
        cells = share_cells(result, watts)
        yield from (cells[0], cells[2]) if wide else cells

    for stage, own in sums.items():
        cells = [f"{own[kind]:z.1f}" if kind in own else "" for kind in columns]
        table.add_row(in_words(stage), *cells, *ending(sum(own.values())))
    table.add_section()
    totals = [sum(own.get(kind, 0.0) for own in sums.values()) for kind in columns]
    cells = [f"{watts:z.1f}" for watts in totals]
    table.add_row("total", *cells, *ending(result.total), style="bold")
    return table


def _shafts(result: Result) -> Table:
    units = f"speed {unit_text(RPM.display)}", f"torque {unit_text(NEWTON_METRE.display)}"
    passed = f"passes {unit_text(NEWTON_METRE.display)}"
    table = number_table(
        "Shafts (torque and power from outside)", "", *units, "power W", passed, ""
    )
    table.columns[-1].justify = "left"
    lines = train_flow(result).lines.values()
    for name, member in result.flow.members.items():
        line = next(line for line in lines if name in line.shafts)
        others = [shaft for shaft in line.shafts if shaft != name]
        role = line.role
        if role in ("input", "output", "held", "driven", "loaded") and not member.torque:
            role = ""
        words = [role, *([f"with {', '.join(others)}"] if others else [])]
        table.add_row(
            name,
            f"{RPM.to_display(member.speed):z.1f}",
            f"{NEWTON_METRE.to_display(member.torque):z.2f}",
            f"{member.power:z.1f}",
            f"{NEWTON_METRE.to_display(line.passed):z.2f}",
            ", ".join(filter(None, words)),
        )
    return table


def _rolling(result: Result, train: Train) -> RenderableType:
    """What each mesh would pass with its carrier at rest."""
    losses = {term.name: term.watts for term in result.terms if term.name in train.rolling}
    entering = result.input_power
    columns = ("W", "of input", *(("loss W",) if losses else ()), "")
    table = number_table("Rolling power of the meshes", "", *columns)
    table.columns[-1].justify = "left"
    for key, power in train.rolling.items():
        share = f"{abs(power) / entering:z.1%}" if entering else ""
        loss = (f"{losses[key]:z.1f}" if key in losses else "",) if losses else ()
        mark = "circulates" if entering and _circulates(power, entering) else ""
        table.add_row(in_words(key), f"{abs(power):z.1f}", share, *loss, mark)
    sentence = circulation_text(train.rolling, entering)
    return Group(table, Text(sentence)) if sentence else table


def _clutches(train: Train) -> Table:
    table = number_table("Closed clutches", "", f"torque {unit_text(NEWTON_METRE.display)}")
    for key, torque in train.clutches.items():
        table.add_row(" + ".join(key.split("+")), f"{NEWTON_METRE.to_display(torque):z.2f}")
    return table


def _terms(result: Result) -> Table:
    """Every single loss, set by set."""
    table = number_table("Single losses", "", "W", "of total", "of input", "")
    table.columns[-1].justify = "left"
    last = ""
    for term in result.terms:
        stage = term.name.partition(".")[0]
        if last in result.inputs["sets"] and stage != last:
            table.add_section()
        last = stage
        if not term.left_out:
            table.add_row(in_words(term.name), *share_cells(result, term.watts), term.group)
    return table


def _by_stage(items: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    found: dict[str, dict[str, Any]] = {}
    for key, item in items.items():
        stage, _, name = key.partition(".")
        found.setdefault(stage, {})[name] = item
    return found


def part_head(key: str, label: str, unit: str) -> str:
    """Head of the column of a figure, short where many stand side by side."""
    return f"{SHORT_HEADS.get(key, label)} {unit_text(unit)}".rstrip()


def _parts(result: Result) -> Iterator[Table]:
    """Bearings of shafts, seals and drags: one table for each kind, a row for each part."""
    kinds: dict[type, dict[str, DataclassInstance]] = {}
    for key, item in result.parts.items():
        kinds.setdefault(type(item), {})[key.partition(".")[0]] = item
    stages = result.stage_losses
    for kind, parts in kinds.items():
        first = next(iter(parts.values()))
        heads = [part_head(one.key, one.label, one.unit) for one in figures(first)]
        table = number_table(_TITLES.get(kind.__name__, "Other parts"), "", "loss W", *heads)
        for name, part in parts.items():
            cells = (shown(one.value) for one in figures(part))
            table.add_row(in_words(name), f"{stages[name]:z.1f}", *cells)
        yield table


# --- kinematics -----------------------------------------------------------------------------------


def state_tables(case: TrainCase) -> RenderableType:
    """Shafts of a train with their members, and the ratio of every state."""
    states = train_states(case)
    shafts = plain_table("Shafts")
    shafts.add_column("", no_wrap=True)
    shafts.add_column("turns together")
    for name, members in case.shape.shafts.items():
        shafts.add_row("housing, stands still" if name == HOUSING else name, ", ".join(members))
    table = number_table(
        f"Ratio: speed of {case.operation.input} over that of {case.operation.output}",
        "state",
        "ratio",
        "step",
        "held",
        "joined",
        "",
    )
    for number in (3, 4, 5):
        table.columns[number].justify = "left"
    before: StateKinematics | None = None
    for state in states:
        table.add_row(
            state.name or "always",
            MISSING if state.ratio is None else shown(state.ratio, 5),
            _step(before, state),
            ", ".join(state.held),
            ", ".join(" + ".join(group) for group in state.joined),
            state.remark,
        )
        before = state
    return Group(shafts, table)


def _step(before: StateKinematics | None, state: StateKinematics) -> str:
    """Ratio of the state before over that of this one, where both turn the output one way."""
    if before is None or not before.ratio or not state.ratio or before.ratio * state.ratio < 0:
        return ""
    return format_number(before.ratio / state.ratio, 4)
