"""From any case to the machine that it describes."""

from __future__ import annotations

from dataclasses import replace

from epicyclic.builders.built import Built
from epicyclic.builders.gear_sets import gear_set
from epicyclic.builders.models import fluids_of
from epicyclic.builders.set_case import set_cases
from epicyclic.builders.temperatures import thermal_model
from epicyclic.builders.train import build_train, train_layout
from epicyclic.case.case import Case, GearPairCase, PlanetaryCase
from epicyclic.case.tables.operation import PlanetaryOperation
from epicyclic.case.train import TrainCase
from epicyclic.case.train_shape import mesh_rows
from epicyclic.gears.gear import CARRIER
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.machine.machine import Machine, Operation
from epicyclic.result.result import Layout


def build(
    case: Case,
    # Tables of flows through pockets that the points of a sweep share.
    flow_tables: FlowTables | None = None,
) -> Built:
    """The machine of a case, driven as the case says."""
    built = _machine(case, flow_tables or {})
    model = thermal_model(case, built.machine)
    if model is None:
        return built
    layout = replace(built.layout, nodes=tuple(model.start))
    return replace(built, thermal=model, layout=layout)


def _machine(case: Case, tables: FlowTables) -> Built:
    return build_train(case, tables) if isinstance(case, TrainCase) else _single(case, tables)


def _single(case: PlanetaryCase | GearPairCase, tables: FlowTables) -> Built:
    """A set or pair by itself."""
    ((_, own),) = set_cases(case, [""])
    gearing = own.gearing
    operation = _operation(case)
    members = gearing.members
    others = [member for member in members if member not in (operation.input, operation.output)]
    bodies = {body: body for body in (*members, *gearing.planets)}
    element = gear_set("", own, bodies, (operation.input, operation.output, *others), tables)
    rows = tuple(mesh_rows("", gearing, bodies))
    return Built(
        machine=Machine(tuple(bodies), rows, (element,)),
        operation=operation,
        known_fluids=fluids_of(case),
        sets={"": element},
        layout=Layout(
            tuple(element.choices),
            members,
            tuple(mesh.key for mesh in gearing.meshes),
            tuple(f"{planet}_bearing" for planet in gearing.planets),
            shares=bool(gearing.planets),
        ),
    )


def _operation(case: PlanetaryCase | GearPairCase) -> Operation:
    table = case.operation
    if not isinstance(table, PlanetaryOperation):
        return Operation("pinion", "gear", table.torque, {"pinion": table.speed})
    held = table.fixed or table.second_input
    assert held is not None
    (output,) = {"sun", "ring", CARRIER} - {table.input, held}
    held_speed = 0.0 if table.second_speed is None else table.second_speed
    return Operation(
        table.input, output, table.torque, {table.input: table.speed, held: held_speed}
    )


def layout_of(case: Case) -> Layout:
    """What the result of a case consists of."""
    if isinstance(case, TrainCase) and case.models.temperatures == "inlet":
        return train_layout(case)
    return build(case).layout
