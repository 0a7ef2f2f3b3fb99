"""From any case to the machine that it describes."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from epicyclic.build.elements import build_element
from epicyclic.build.gear_sets import gear_set
from epicyclic.build.models import fluids_of, set_cases
from epicyclic.build.temperatures import thermal_model
from epicyclic.case.case import Case, GearPairCase, PlanetaryCase
from epicyclic.case.tables.elements import ShaftBearingTable
from epicyclic.case.tables.operation import PlanetaryOperation
from epicyclic.case.train import TrainCase
from epicyclic.case.train_rules import needs_force
from epicyclic.case.train_shape import mesh_rows
from epicyclic.gears.gear import CARRIER, HOUSING
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.machine.element import Element, Fluids, State, joined_key
from epicyclic.machine.gear_mesh import MeshDuty
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.heat import Answer, Settled, ThermalModel, settle
from epicyclic.machine.machine import GearSeat, Machine, Operation, ShaftLayout, Support
from epicyclic.machine.planets import PlanetLoad
from epicyclic.machine.solve import lossless_state, solve_machine
from epicyclic.result.result import Layout

# What the builders hand on: a machine, how it is driven, and the words about it.


@dataclass(frozen=True, slots=True)
class Built:
    """A machine that can be solved."""

    machine: Machine
    operation: Operation
    known_fluids: Fluids | None  # Oil and mixture; None if every loss is given.
    # Those whose losses are computed; the key of a single set is empty.
    sets: Mapping[str, GearSet]
    layout: Layout  # What its result consists of.
    # How temperatures follow from losses; None if all are those of the oil inlet.
    thermal: ThermalModel | None = None

    @property
    def fluids(self) -> Fluids:
        """Oil and mixture of a machine that computes losses."""
        assert self.known_fluids is not None, "a machine of given efficiencies has no oil"
        return self.known_fluids

    def solve(self) -> Settled:
        """Torques, losses and temperatures that agree."""
        if self.thermal is None:
            solution = solve_machine(self.machine, self.operation, self.known_fluids)
            return Settled(solution, Answer({}), 1)
        return settle(self.machine, self.operation, self.thermal)

    def state(self) -> State:
        """Speeds, and torques as without losses."""
        return lossless_state(self.machine, self.operation, self.known_fluids)

    def loaded_state(self) -> State:
        """Speeds, torques and oil in balance with all losses."""
        return self.solve().solution.state

    def loaded_duties(self, state: State) -> dict[str, MeshDuty]:
        """The meshes of the planet that carries most, of every set, by their keys."""
        return {
            joined_key(name, duty.key): duty
            for name, own in self.sets.items()
            for duty in own.loaded_duties(state)
        }

    def mean_duties(self) -> dict[str, MeshDuty]:
        """The meshes of a planet that carries its mean share, of every set, by their keys."""
        state = self.state()
        return {
            joined_key(name, duty.key): duty
            for name, own in self.sets.items()
            for duty in own.mean_duties(state)
        }

    def planet_loads(self) -> dict[str, PlanetLoad]:
        """Load on the bearing of a planet that carries its mean share, of every set."""
        state = self.state()
        return {
            joined_key(name, key): load
            for name, own in self.sets.items()
            for key, load in own.mean_loads(state).items()
        }


# Gears and bearings along the shafts of a train, for the forces on its bearings.


def shaft_layouts(case: TrainCase, sets: Mapping[str, GearSet]) -> Iterator[ShaftLayout]:
    """What stands along each shaft with a bearing whose force is computed."""
    supports: dict[str, dict[str, Support]] = {}
    for kind, name, table in case.elements:
        if kind == "bearings" and isinstance(table, ShaftBearingTable) and needs_force(table):
            shaft = case.shape.names[table.shaft]
            supports.setdefault(shaft, {})[name] = Support(
                table.position or 0.0, table.axial_sense if table.locating else "none"
            )
    for shaft, own in supports.items():
        yield ShaftLayout(own, tuple(_seats(case, shaft, sets)))


def _seats(case: TrainCase, shaft: str, sets: Mapping[str, GearSet]) -> Iterator[GearSeat]:
    """The gears on a shaft, once for each of their meshes."""
    for name, own in sets.items():
        shape = case.shape.sets[name]
        bodies, directions, hands = case.shape.bodies_of(name), shape.directions, shape.hands
        for drawn, mesh in zip(shape.meshes, own.meshes, strict=True):
            internal = mesh.mesh.internal
            toward = directions[drawn.key]
            hand = hands[drawn.first]
            radii = (mesh.mesh.operating_radius1, mesh.mesh.operating_radius2)
            ratio = drawn.teeth[1] / drawn.teeth[0]
            ends = (
                (drawn.first, -1.0, toward + math.pi if internal else toward, hand, False),
                (
                    drawn.second,
                    ratio if internal else -ratio,
                    toward + math.pi,
                    hand if internal else -hand,
                    internal,
                ),
            )
            for (gear, lever, direction, own_hand, ring), radius in zip(ends, radii, strict=True):
                body = shape.bodies[gear]
                if body in shape.planets or bodies[body] != shaft or shaft == HOUSING:
                    continue
                yield GearSeat(
                    mesh=f"{name}.{drawn.key}",
                    lever=lever,
                    position=case.position_of(f"{name}.{gear}") or 0.0,
                    radius=radius,
                    pressure_angle=mesh.mesh.operating_pressure_angle,
                    helix_tangent=mesh.mesh.operating_helix_tangent,
                    hand=own_hand,
                    direction=direction,
                    internal=ring,
                    around=bool(shape.planets) and own.count > 1,
                )


# A train of gear sets as a machine.


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


# From any case to the machine that it describes.


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
    operation = _set_operation(case)
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


def _set_operation(case: PlanetaryCase | GearPairCase) -> Operation:
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
