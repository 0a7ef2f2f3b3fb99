"""From any case to the machine that it describes, and the model of its temperatures."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from functools import lru_cache, partial
from types import MappingProxyType
from typing import Any

from epicyclic.build.elements import axial_preload, build_element, catalogue_bearing
from epicyclic.build.gear_sets import gear_set
from epicyclic.build.models import SetCase, fluids_of, oil_share, set_cases, with_lubrication
from epicyclic.case.case import Case, PlanetaryCase, TrainCase
from epicyclic.case.rules import borne_shafts
from epicyclic.case.tables.elements import ShaftBearingTable
from epicyclic.case.tables.operation import (
    HousingTable,
    LubricationTable,
    PlanetaryOperation,
    ThermalTable,
)
from epicyclic.contact.temperatures import LUBRICATION_FACTORS
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import ConvergenceError
from epicyclic.gears.gear import CARRIER, HOUSING
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.losses.ranges import Flags, ValidityFlag, takes_no_axial_force
from epicyclic.machine.convection import (
    GRAVITY_TEMPERATURE,
    WATER,
    Fluid,
    air,
    mixture,
    oil_conductivity,
    oil_heat_capacity,
)
from epicyclic.machine.element import OIL, Element, Fluids, State, joined_key, oil_at, oil_flags
from epicyclic.machine.gear_mesh import MeshDuty
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.heat import (
    Answer,
    Change,
    FlankModel,
    HeatSettings,
    Housing,
    NetworkModel,
    Settled,
    ThermalModel,
    Wet,
    settle,
)
from epicyclic.machine.machine import GearSeat, Machine, Operation, ShaftLayout, Support
from epicyclic.machine.planets import PinFigures, PlanetLoad, PlanetPin
from epicyclic.machine.shaft_parts import ShaftBearing
from epicyclic.machine.solve import Wanted, lossless_state, solve_machines
from epicyclic.machine.train_shape import mesh_rows
from epicyclic.oil.oil import Oil, mixture_state, oil_state
from epicyclic.result.result import Layout, in_words

IN_BATH = ("dip", "submerged")


def thermal_model(case: Case, sets: Mapping[str, SetCase], machine: Machine) -> ThermalModel | None:
    """How the temperatures of a case follow from its losses; None if all are the inlet's."""
    kind = case.models.temperatures
    if kind == "inlet" or case.lubricant is None:
        return None
    fluids = _fluids_at(case, contact_nodes(machine))
    inlet = fluids_of(case).oil.temperature
    tables = {key: own.lubrication for key, own in sets.items()}
    if kind == "flank":
        wetted = {key: with_lubrication(case.thermal, own, None) for key, own in tables.items()}
        factors = {key: LUBRICATION_FACTORS[own.lubrication] for key, own in wetted.items()}
        return FlankModel(machine, inlet, case.thermal.bulk, factors, fluids)
    flows = [table.oil_flow for table in tables.values() if table is not None and table.oil_flow]
    settings = _settings(case, machine, tables, sum(flows) if flows else None, inlet)
    media = partial(_media, case.lubricant.oil, case.surroundings.pressure, oil_share(case).share)
    return NetworkModel(machine, settings, fluids, media)


def contact_nodes(machine: Machine) -> dict[str, tuple[str, ...]]:
    """The thermal nodes on both sides of every contact, by the key of the contact."""
    found: dict[str, tuple[str, ...]] = {}
    for own in machine.elements:
        if isinstance(own, GearSet):
            found |= {joined_key(own.key, mesh.key): mesh.nodes for mesh in own.meshes}
            found |= {joined_key(own.key, planet.key): planet.nodes for planet in own.planets}
        elif isinstance(own, ShaftBearing):
            found[own.key] = (own.key,)
    return found


def term_nodes(machine: Machine) -> dict[tuple[str, str], tuple[str, ...]]:
    """The nodes at whose mean temperature a loss arises, where it is not that of the oil.

    By the keys of element and loss.
    """
    nodes = contact_nodes(machine)
    found: dict[tuple[str, str], tuple[str, ...]] = {}
    for own in machine.elements:
        if isinstance(own, GearSet):
            parts: list[tuple[str, tuple[str, ...]]] = [  # some frictions are those of the oil
                (it.key, ("sliding", "rolling")[it.models.friction.takes_oil_temperature :])
                for it in own.meshes
            ]
            parts += [(planet.key, ("mechanical", "viscous")) for planet in own.planets]
            found |= {
                (own.key, f"{key}_{name}"): nodes[joined_key(own.key, key)]
                for key, names in parts
                for name in names
            }
        elif isinstance(own, ShaftBearing):
            found |= {(own.key, name): nodes[own.key] for name in own.terms}
    return found


def _fluids_at(
    case: Case, contacts: Mapping[str, tuple[str, ...]]
) -> Callable[[Mapping[str, float]], Fluids]:
    """Oil and mixture of a case at the temperatures of its nodes; others are as warm as the oil."""
    assert case.lubricant is not None
    oil, factor = case.lubricant.oil, case.lubricant.pressure_viscosity_factor
    inlet = fluids_of(case).oil.temperature

    def at(temperatures: Mapping[str, float]) -> Fluids:
        around = temperatures.get(OIL, inlet)
        found = {
            key: sum(temperatures.get(node, around) for node in nodes) / len(nodes)
            for key, nodes in contacts.items()
        }
        fluids = fluids_of(case, around)
        return replace(
            fluids,
            flags=fluids.flags + Flags(partial(_flags, oil, found)),
            contacts={key: oil_at(oil, value, factor) for key, value in found.items()},
        )

    return at


def _flags(oil: Oil, contacts: Mapping[str, float]) -> tuple[ValidityFlag, ...]:
    """Contacts at which the oil leaves its data."""
    return tuple(
        replace(flag, use=replace(flag.use, where=in_words(key)))
        for key, temperature in contacts.items()
        for flag in oil_flags(oil, temperature)
    )


def _media(oil: Oil, pressure: float, share: float, temperature: float) -> tuple[Fluid, Fluid]:
    """The oil, and its mixture with air, as heat sees them at a temperature."""
    own = oil_medium(oil, temperature)
    state = mixture_state(oil_state(oil, temperature), share, pressure)
    return own, mixture(own, air(temperature, pressure), state)


def oil_medium(oil: Oil, temperature: float) -> Fluid:
    """How an oil conducts and stores heat: its own data, or Cragoe's. Theory (W22)."""
    state = oil_state(oil, temperature)
    gravity = oil_state(oil, GRAVITY_TEMPERATURE).density / WATER
    conductivity, capacity = oil.thermal_conductivity, oil.specific_heat_capacity
    return Fluid(
        density=state.density,
        dynamic_viscosity=state.dynamic_viscosity,
        conductivity=(
            oil_conductivity(temperature, gravity) if conductivity is None else conductivity.value
        ),
        heat_capacity=(
            oil_heat_capacity(temperature, gravity) if capacity is None else capacity.value
        ),
    )


def _settings(
    case: Case,
    machine: Machine,
    tables: Mapping[str, LubricationTable | None],
    to_gears: float | None,
    inlet: float,
) -> HeatSettings:
    table = with_lubrication(case.thermal, case.lubrication, to_gears)
    housing, steel = table.housing, None
    if housing is not None and housing.mass is not None:
        steel = housing.mass * housing.heat_capacity_ratio  # that stores as much heat
    gear_sets = [own for own in machine.elements if isinstance(own, GearSet)]
    return HeatSettings(
        inlet=inlet,
        outlet=table.oil_outlet_temperature,
        flow=table.oil_flow or 0.0,
        wet=_wet(table, gear_sets, to_gears),
        wet_sets={
            own.key: _wet(
                with_lubrication(case.thermal, tables[own.key], to_gears), [own], to_gears
            )
            for own in gear_sets
        },
        jet_shares=table.jet_shares,
        press_fit=table.press_fit,
        shaft=table.shaft_conductance,
        ambient=table.ambient_temperature,
        coolant=table.coolant_temperature,
        cooler_power=table.cooler_power,
        cooler=table.cooler_conductance,
        housing=None if housing is None else _housing(housing),
        changes={name: Change(it.value, it.scale) for name, it in table.conductances.items()},
        oil_volume=table.oil_volume,
        housing_mass=steel,
        capacity_changes={
            name: Change(it.value, it.scale) for name, it in table.capacities.items()
        },
    )


def _wet(table: ThermalTable, gear_sets: Sequence[GearSet], to_gears: float | None) -> Wet:
    """How oil gets to some sets."""
    dips = _bath_share(table, gear_sets)
    baths = {"dip": dips, "spray-and-dip": dips, "submerged": 1.0}
    # how far the flow reaches the temperature of the gears, what misses them included
    effectiveness = 0.0 if table.lubrication in IN_BATH else table.jet_effectiveness
    if to_gears is not None and table.oil_flow:
        effectiveness *= min(1.0, to_gears / table.oil_flow)
    return Wet(baths.get(table.lubrication, 0.0), effectiveness)


def _bath_share(table: ThermalTable, gear_sets: Sequence[GearSet]) -> float:
    """Share of gears that dips, as given or as the oil stands; mean of all. Theory (N10)."""
    parts = [
        disc.sump.part
        for own in gear_sets
        for discs in own.discs.values()
        for disc in discs
        if disc.sump is not None
    ]
    angles = [part.wetted_angle for part in parts if part.teeth]
    if "bath_share" in table.model_fields_set or not angles:
        return table.bath_share
    return sum(angles) / (math.pi * len(angles))


def _housing(table: HousingTable) -> Housing:
    height = math.sqrt(table.area / 6) if table.height is None else table.height
    return Housing(
        method=table.method,
        area=table.area,
        inner_area=table.area if table.inner_area is None else table.inner_area,
        height=height,
        length=height if table.length is None else table.length,
        air_speed=table.air_speed,
        emissivity=table.emissivity,
        fin_factor=table.fin_factor,
        inner_coefficient=table.inner_coefficient,
        coefficient=table.coefficient,
        foundation=table.foundation,
    )


# What the builders hand on: a machine, how it is driven, and the words about it.


@dataclass(frozen=True, slots=True)
class Built:
    """A machine that can be solved."""

    machine: Machine
    operation: Operation
    known_fluids: Fluids | None  # Oil and mixture; None if every loss is given.
    # Those whose losses are computed; the key of a single set is empty.
    sets: Mapping[str, GearSet]
    set_cases: Mapping[str, SetCase]  # Their tables and models, by the same keys.
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
        (found,) = solve_all([self])
        if isinstance(found, Exception):
            raise found
        return found

    def state(self) -> State:
        """Speeds, and torques as without losses."""
        return lossless_state(self.machine, self.operation, self.known_fluids)

    def loaded_state(self) -> State:
        """Speeds, torques and oil in balance with all losses."""
        return self.solve().solution.state

    def loaded_duties(self, state: State) -> dict[str, MeshDuty]:
        """The meshes of the planet that carries most, of every set, by their keys."""
        return {
            joined_key(name, duty.gears.key): duty
            for name, own in self.sets.items()
            for duty in own.loaded_duties(state)
        }

    def mean_duties(self) -> dict[str, MeshDuty]:
        """The meshes of a planet that carries its mean share, of every set, by their keys."""
        state = self.state()
        return {
            joined_key(name, duty.gears.key): duty
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


def solve_all(points: Sequence[Built], *, bare: bool = False) -> list[Settled | Exception]:
    """Torques, losses and temperatures that agree at several points of one kind of machine.

    Of each what is wrong where nothing agrees; `bare` as for `solve_machines`.
    """
    heated = [(it.machine, it.operation, it.thermal) for it in points if it.thermal is not None]
    if heated:
        found = settle(heated)
    else:
        wanted = [Wanted(it.machine, it.operation, it.known_fluids) for it in points]
        found = [
            it if isinstance(it, Exception) else Settled(it[0], Answer({}), 1)
            for it in solve_machines(wanted, bare=bare)
        ]
    for number, it in enumerate(found):
        losses = {} if isinstance(it, Exception) else it.solution.losses
        bad = [name for name, loss in losses.items() if not math.isfinite(loss.watts)]
        if bad:
            found[number] = ConvergenceError(
                f"{', '.join(bad)} did not give a finite number, because the case is far outside "
                "the range of the models. Choose others (models.friction, models.rolling, "
                "models.bearing)."
            )
    return found


# Gears and bearings along the shafts of a train, for the forces on its bearings.


Tables = Mapping[str, ShaftBearingTable]


def _support(tables: Tables, name: str) -> Support:
    """A bearing of a shaft as a support, at its pressure centre. Theory (J30)."""
    table = tables[name]
    bearing, place = catalogue_bearing(table), table.position or 0.0
    others = [other for key, other in tables.items() if key != name]
    free = [takes_no_axial_force(one.type, one.designation) for one in (table, *others)]
    sense, outer = table.axial_sense if table.locating or free == [False, True] else "none", 0.0
    if bearing.thrust_ratio and table.axial_sense != "both":
        sense = table.axial_sense
    elif bearing.thrust_ratio and len(others) == 1:
        (other,) = others
        arrangement = table.arrangement or other.arrangement
        if arrangement or other.is_angular or (other.locating and not table.locating):
            first = place < (other.position or 0.0)
            sense = "positive" if first == (arrangement == "O") else "negative"
    if bearing.thrust_ratio and sense in ("positive", "negative"):
        outer = -bearing.centre_offset if sense == "positive" else bearing.centre_offset
    preload = max((axial_preload(table, others[0]) for _ in others[:1]), default=0.0)
    return Support(place + outer, sense, bearing.thrust_ratio, preload)


def _remarks(case: TrainCase) -> Iterator[tuple[str, tuple[str, tuple[str, ...]]]]:
    """Of bearings, what is assumed of their axial force, and what their force leaves out."""
    borne = borne_shafts(case)
    for shaft, tables in borne.items():
        on_it = [
            name
            for own in borne.values()
            for name, table in own.items()
            if case.shape.names.get(table.against) == shaft
        ]
        lacks = f"the force of {', '.join(on_it)} on {shaft} is not included. Give radial_force."
        angular = [one for one in tables.values() if one.is_angular]
        senses = [one.axial_sense for one in tables.values() if one.locating]
        assumed = ""
        if len(angular) == 2 and not any(
            one.arrangement or one.axial_sense != "both" for one in angular
        ):
            assumed = "the bearing arrangement is not given; X is assumed, as is usual for gear "
            assumed += 'shafts. Write arrangement = "X" or "O".'
        free = [takes_no_axial_force(one.type, one.designation) for one in tables.values()]
        if len(tables) == 2 and not angular and senses[1:] == senses[:1] and free[0] == free[1]:
            who = "both bearings are" if senses else "no bearing is"
            advice = "Use one that can." if free[0] else "Write locating = true for one of them."
            assumed = f"{who} locating on {shaft}; the first is taken to carry all the axial "
            assumed += f"force. {advice}"
        for name in tables:
            yield name, (assumed, (lacks,) if on_it else ())


def _seats(case: TrainCase, shaft: str, sets: Mapping[str, GearSet]) -> Iterator[GearSeat]:
    """The gears on a shaft, once for each of their meshes."""
    for name, own in sets.items():
        shape = case.shape.sets[name]
        bodies, directions, hands = case.shape.bodies_of(name), shape.directions, shape.hands
        for drawn, mesh in zip(shape.meshes, own.meshes, strict=True):
            internal, side = mesh.mesh.internal, mesh.mesh.side
            toward = directions[drawn.key]
            hand = hands[drawn.first]
            radii = (mesh.mesh.operating_radius1, mesh.mesh.operating_radius2)
            lever = -side * drawn.teeth[1] / drawn.teeth[0]
            ends = (
                (drawn.first, -1.0, toward + math.pi if internal else toward, hand, False),
                (drawn.second, lever, toward + math.pi, -side * hand, internal),
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


MOST_DESIGNS = 8  # Of which the parts and fluids are kept for the next points of a sweep.
_Consists = tuple[Machine, Mapping[str, SetCase], Layout]


@dataclass(frozen=True)
class _Design:
    """A case in place of all that need the same parts, or the same fluids."""

    case: Case = field(compare=False)
    flow_tables: FlowTables = field(compare=False)
    key: tuple[Hashable, ...]  # Its design, and what else it depends on.


@lru_cache(maxsize=MOST_DESIGNS)
def _train_parts(design: _Design) -> _Consists:
    """What a train consists of in the state of the case."""
    case, flow_tables = design.case, design.flow_tables
    assert isinstance(case, TrainCase)
    cases = set_cases(case)
    elements = [*_sets(case, cases, flow_tables), *_parts(case, case.shape.names)]
    sets = {element.key: element for element in elements if isinstance(element, GearSet)}
    layouts = tuple(
        ShaftLayout({name: _support(own, name) for name in own}, tuple(_seats(case, shaft, sets)))
        for shaft, own in borne_shafts(case).items()
    )
    machine = replace(case.shape.machine(case.state), elements=tuple(elements), layouts=layouts)
    return machine, cases, _layout(case, elements)


def _train_operation(case: TrainCase) -> Operation:
    shape, operation = case.shape, case.operation
    held = shape.held(case.state)
    driven, output = (shape.shaft_of(name) or "" for name in (operation.input, operation.output))
    speeds = {driven: operation.speed}
    speeds |= dict.fromkeys(held, 0.0)
    speeds |= {shape.shaft_of(name) or "": speed for name, speed in operation.speeds.items()}
    torques = {shape.shaft_of(name) or "": torque for name, torque in operation.torques.items()}
    return Operation(driven, output, operation.torque, speeds, torques, held)


def _sets(
    case: TrainCase, cases: Mapping[str, SetCase], flow_tables: FlowTables
) -> Iterator[GearSet]:
    """The sets whose losses are computed."""
    distance = _distances(case)
    for name, own in cases.items():
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


def _parts(case: TrainCase | PlanetaryCase, shafts: Mapping[str, str]) -> Iterator[Element]:
    """Bearings, seals and other drags."""
    remarks = dict(_remarks(case)) if isinstance(case, TrainCase) else {}
    for kind, name, table in case.elements:
        assert case.lubricant is not None
        element = build_element(
            kind, name, table, shafts=shafts, oil=case.lubricant.oil, folder=case.folder
        )
        if name in remarks and isinstance(element, ShaftBearing):
            assumed, lacks = remarks[name]
            element = replace(element, assumed=assumed, lacks=(*element.lacks, *lacks))
        yield element


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
            parts += [(f"{name}.{key}", kind) for key, kind in pin_figures(element)]
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


def pin_figures(own: GearSet) -> list[tuple[str, type[Any]]]:
    """The figures of the films on plain pins, which other planets do not have."""
    return [(key, kind) for key, kind in own.figure_types if issubclass(kind, PinFigures)]


NO_TABLES: FlowTables = MappingProxyType({})


def build(
    case: Case,
    # Tables of flows through pockets that the points of a sweep share.
    flow_tables: FlowTables | None = None,
) -> Built:
    """The machine of a case, driven as the case says."""
    tables, operation = flow_tables or NO_TABLES, operation_of(case)
    ends = getattr(case.operation, "state", None), operation.input, operation.output
    key = (case.design, case.found, id(tables), *ends)
    parts = _train_parts if isinstance(case, TrainCase) else _single_parts
    machine, cases, layout = parts(_Design(case, tables, key))
    model = thermal_model(case, cases, machine)
    return Built(
        machine=machine,
        operation=operation,
        known_fluids=fluids_of(case) if case.computed else None,
        sets={element.key: element for element in machine.elements if isinstance(element, GearSet)},
        set_cases=cases,
        layout=layout if model is None else replace(layout, nodes=tuple(model.start)),
        thermal=model,
    )


@lru_cache(maxsize=MOST_DESIGNS)
def _single_parts(design: _Design) -> _Consists:
    """What a set or pair by itself consists of."""
    case, tables = design.case, design.flow_tables
    assert not isinstance(case, TrainCase)
    operation = operation_of(case)
    ends = operation.input, operation.output
    cases = set_cases(case)
    own = cases[""]
    gearing = own.gearing
    members = gearing.members
    others = [member for member in members if member not in ends]
    bodies = {body: body for body in (*members, *gearing.planets)}
    element = gear_set("", own, bodies, (*ends, *others), tables)
    parts: list[Element] = []
    if isinstance(case, PlanetaryCase) and case.seals:
        parts = list(_parts(case, {member: member for member in members}))
    rows = tuple(mesh_rows("", gearing, bodies))
    own_bearing = element.planets[0].bearing if element.planets else None
    layout = Layout(
        (*element.choices, *(f"{part.key}.{term}" for part in parts for term in part.terms)),
        members,
        tuple(mesh.key for mesh in gearing.meshes),
        tuple(f"{planet}_bearing" for planet in gearing.planets),
        parts=(
            *(pin_figures(element) if isinstance(own_bearing, PlanetPin) else ()),
            *((f"{part.key}.{item}", kind) for part in parts for item, kind in part.figure_types),
        ),
        shares=bool(gearing.planets),
    )
    return Machine(tuple(bodies), rows, (element, *parts)), cases, layout


def operation_of(case: Case) -> Operation:
    """How the machine of a case is driven."""
    if isinstance(case, TrainCase):
        return _train_operation(case)
    table = case.operation
    if not isinstance(table, PlanetaryOperation):
        return Operation("pinion", "gear", table.torque, {"pinion": table.speed})
    held = table.fixed or table.second_input
    assert held is not None
    (output,) = {"sun", "ring", CARRIER} - {table.input, held}
    speeds: dict[str, float] = {table.input: table.speed, held: table.second_speed or 0.0}
    still = () if table.fixed is None else (held,)
    return Operation(table.input, output, table.torque, speeds, held=still)


def layout_of(case: Case) -> Layout:
    """What the result of a case consists of."""
    if isinstance(case, TrainCase) and case.models.temperatures == "inlet":
        return _layout(case, [*_sets(case, set_cases(case), {}), *_parts(case, case.shape.names)])
    return build(case).layout
