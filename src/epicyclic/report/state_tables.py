"""Shafts of a train and the ratio of every state, for a terminal."""

from __future__ import annotations

from rich.console import Group, RenderableType

from epicyclic.case.train import TrainCase
from epicyclic.gears.gear import HOUSING
from epicyclic.report.shown import MISSING, shown
from epicyclic.report.tables import plain_table
from epicyclic.study.trains import StateKinematics, train_states
from epicyclic.units import format_number


def state_tables(case: TrainCase) -> RenderableType:
    """Shafts of a train with their members, and the ratio of every state."""
    states = train_states(case)
    shafts = plain_table("Shafts")
    shafts.add_column("", no_wrap=True)
    shafts.add_column("turns together")
    for name, members in case.shape.shafts.items():
        shafts.add_row("housing, stands still" if name == HOUSING else name, ", ".join(members))
    table = plain_table(
        f"Ratio: speed of {case.operation.input} over that of {case.operation.output}"
    )
    for head in ("state", "ratio", "step", "held", "joined", ""):
        numeric = head in ("ratio", "step")
        table.add_column(head, justify="right" if numeric else "left", no_wrap=numeric)
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
