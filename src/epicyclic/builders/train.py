"""A train of gear sets as a machine."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import replace

from epicyclic.builders.built import Built
from epicyclic.builders.elements import build_element
from epicyclic.builders.gear_sets import gear_set
from epicyclic.builders.models import fluids_of
from epicyclic.builders.set_case import set_cases
from epicyclic.builders.shafts import shaft_layouts
from epicyclic.case.train import TrainCase
from epicyclic.gears.gear import HOUSING
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.machine.element import Element
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.machine import Operation
from epicyclic.result.result import Layout


def build_train(case: TrainCase, flow_tables: FlowTables) -> Built:
    """A train in the state and at the operating point of the case."""
    shape = case.shape
    elements = [*_sets(case, flow_tables), *_parts(case)]
    sets = {element.key: element for element in elements if isinstance(element, GearSet)}
    return Built(
        machine=replace(
            shape.machine(case.state),
            elements=tuple(elements),
            layouts=tuple(shaft_layouts(case, sets)),
        ),
        operation=_operation(case),
        known_fluids=fluids_of(case) if case.computed else None,
        sets=sets,
        layout=_layout(case, elements),
    )


def train_layout(case: TrainCase) -> Layout:
    """What the result of a train consists of."""
    return _layout(case, [*_sets(case, {}), *_parts(case)])


def _operation(case: TrainCase) -> Operation:
    shape, operation = case.shape, case.operation
    driven, output = (shape.shaft_of(name) or "" for name in (operation.input, operation.output))
    speeds = {driven: operation.speed}
    speeds |= dict.fromkeys(shape.held(case.state), 0.0)
    speeds |= {shape.shaft_of(name) or "": speed for name, speed in operation.speeds.items()}
    torques = {shape.shaft_of(name) or "": torque for name, torque in operation.torques.items()}
    return Operation(driven, output, operation.torque, speeds, torques)


def _sets(case: TrainCase, flow_tables: FlowTables) -> Iterator[GearSet]:
    """The sets whose losses are computed."""
    distance = _distances(case)
    for name, own in set_cases(case, dict(case.computed_sets)):
        bodies = case.shape.bodies_of(name)
        members = sorted(
            own.gearing.members, key=lambda member: distance.get(bodies[member], len(distance))
        )
        yield gear_set(name, own, bodies, members, flow_tables)


def _distances(case: TrainCase) -> dict[str, int]:
    """Number of sets and clutches between the input and each shaft that turns."""
    shape = case.shape
    groups = [set(shape.bodies_of(name).values()) for name in shape.sets]
    groups += [{shape.shaft_of(name) or "" for name in group} for group in case.state.joined]
    start = shape.shaft_of(case.operation.input) or ""
    still = {HOUSING, *shape.held(case.state)}
    found, left = {start: 0}, deque([start])
    while left:
        shaft = left.popleft()
        for group in groups:
            if shaft in group:
                for other in sorted(group - found.keys() - still):
                    found[other] = found[shaft] + 1
                    left.append(other)
    return found


def _parts(case: TrainCase) -> Iterator[Element]:
    """Bearings, seals and other drags."""
    for kind, name, table in case.elements:
        assert case.lubricant is not None
        yield build_element(
            kind, name, table, shafts=case.shape.names, oil=case.lubricant.oil, folder=case.folder
        )


def _layout(case: TrainCase, elements: list[Element]) -> Layout:
    shape = case.shape
    losses, meshes, bearings, parts = [], [], [], []
    by_key = {element.key: element for element in elements}
    rows = {name: tuple(shape.rows(name)) for name in shape.sets}
    for name in (*shape.sets, *(key for key in by_key if key not in shape.sets)):
        element = by_key.get(name)
        if element is None:
            losses += [row.key for row in rows[name] if row.efficiency < 1]
        elif isinstance(element, GearSet):
            losses += [f"{name}.{term}" for term in element.choices]
            meshes += [f"{name}.{mesh.key}" for mesh in element.meshes]
            bearings += [f"{name}.{planet.key}" for planet in element.planets if planet.bearing]
        else:
            losses += [f"{name}.{term}" for term in element.terms]
            parts += [(f"{name}.{item}", kind) for item, kind in element.figure_types]
    return Layout(
        losses=tuple(losses),
        members=tuple(shaft for shaft in shape.shafts if shaft != HOUSING),
        meshes=tuple(meshes),
        bearings=tuple(bearings),
        rolling=tuple(row.key for own in rows.values() for row in own),
        parts=tuple(parts),
        fluid=case.computed,
    )
