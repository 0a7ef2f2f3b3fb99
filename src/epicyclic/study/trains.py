"""Trains: losses summed by kind and stage, and the kinematics of every state."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from epicyclic.case.case import TrainCase
from epicyclic.case.tables.elements import ElementTables
from epicyclic.case.train_tables import StateTable
from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.gear import HOUSING
from epicyclic.machine.balance import freedom, speeds_of

LOSS_KINDS = ("given", "sliding", "rolling", "pocketing", "bearings", "seals", "drag")
"""In the order of their columns; ``"given"`` are those of meshes of given efficiency."""
_OF_PARTS = {"bearings": "bearings", "seals": "seals"}  # Losses of all other parts are drag.


def loss_sums(
    # Losses of a train, ``"planets.sun_mesh_sliding"``; without those that are left out.
    losses: Mapping[str, float],
    inputs: Mapping[str, Any],  # The case, as a file has it.
) -> dict[str, dict[str, float]]:
    """Sums by set or part, and in each by kind. [W]

    Returns dict of str to dict of str to float: of `LOSS_KINDS` those that the set or part has.
    """
    kinds = {
        name: _OF_PARTS.get(table, "drag")
        for table in ElementTables.model_fields
        for name in inputs.get(table, {})
    }
    sums: dict[str, dict[str, float]] = {}
    for key, watts in losses.items():
        stage, _, term = key.partition(".")
        kind = kinds.get(stage) or _kind_of(term)
        own = sums.setdefault(stage, {})
        own[kind] = own.get(kind, 0.0) + watts
    return sums


def _kind_of(term: str) -> str:
    last = term.rpartition("_")[2]
    if "bearing" in term:
        return "bearings"
    return last if last in LOSS_KINDS else "given"


AT_REST = 1e-10  # Speed, relative to that of the input, of a shaft that stands still. [1]


@dataclass(frozen=True, slots=True)
class StateKinematics:
    """One state of a train."""

    name: str  # Empty if the train has no states.
    held: tuple[str, ...]  # As the case names them.
    joined: tuple[tuple[str, ...], ...]  # Groups of shafts that clutches join.
    # Speed of the input over that of the output, signed; None if there is none. [1]
    ratio: float | None
    # Speed of every shaft over that of the input; NaN where it is open, empty if the state is
    # blocked. [1]
    speeds: dict[str, float]
    remark: str = ""  # Why there is no ratio, or what is open.


def train_states(case: TrainCase) -> tuple[StateKinematics, ...]:
    """The kinematics of every state of a train, with the further speeds of its operation."""
    states = case.states or {"": StateTable()}
    return tuple(_state(case, name, state) for name, state in states.items())


def _state(case: TrainCase, name: str, state: StateTable) -> StateKinematics:
    shape, operation = case.shape, case.operation
    driven, output = (shape.shaft_of(end) or "" for end in (operation.input, operation.output))
    machine = shape.machine(state)
    held = shape.held(state)
    drawn = StateKinematics(name, state.fixed, state.joined, None, {})
    if driven in held:
        return replace(drawn, remark=f"blocked: {operation.input} is held")
    unit = operation.speed or 1.0
    further = {shape.shaft_of(key) or "": value for key, value in operation.speeds.items()}
    given = dict.fromkeys(held, 0.0) | {
        shaft: speed / unit for shaft, speed in further.items() if shaft not in held
    }
    found = freedom(machine, driven, list(given))
    if found.blocked:
        return replace(drawn, remark=f"blocked: {operation.input} cannot turn")
    speeds = speeds_of(machine, {driven: 1.0} | given)
    shafts = {
        shaft: math.nan if shaft in found.loose else speeds[shaft]
        for shaft in shape.shafts
        if shaft != HOUSING
    }
    if output in found.loose:
        remark = f"neutral: {operation.output} is free to turn"
        return replace(drawn, remark=remark, speeds=shafts)
    if abs(speeds[output]) < AT_REST:
        return replace(drawn, remark=f"{operation.output} stands still", speeds=shafts)
    loose = [shaft for shaft in shafts if shaft in found.loose]
    remark = f"free to turn: {', '.join(loose)}" if loose else ""
    return replace(drawn, ratio=1 / speeds[output], speeds=shafts, remark=remark)
