"""A train as the parts of a new REXS file: sets, shafts, clutches, bearings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from epicyclic.case.element_tables import ShaftBearingTable
from epicyclic.case.train import TrainCase
from epicyclic.case.train_tables import PairSet, PlanetarySet
from epicyclic.elements.base import HOUSING
from epicyclic.errors import Problem, raise_any
from epicyclic.exchange.rexs.model import Component, Relation
from epicyclic.exchange.rexs.new_file import (
    Builder,
    add_load,
    add_pair,
    add_planetary,
    add_shaft,
    hold,
    surroundings,
)

_TYPES = {
    "deep-groove": "radial_grooved_ball_bearing",
    "cylindrical": "radial_roller_bearing",
    "needle": "radial_needle_roller_bearing",
    "tapered": "radial_tapered_roller_bearing",
}

Place = tuple[float, float]
"""Where an axis lies across its direction. [m]"""


def train_parts(case: TrainCase) -> Iterator[Component | Relation]:
    """Components and relations that describe a train of computed planetary sets and pairs.

    Raises
    ------
    InputError
        If another set is among them.
    """
    problems = [
        Problem(
            f"sets.{name}",
            "",
            "is neither a planetary set nor a pair with computed losses.",
            "A new REXS file cannot describe it; write the results into the original file.",
        )
        for name, table in case.sets.items()
        if not isinstance(table, PlanetarySet | PairSet)
    ]
    raise_any(problems)
    names = list(case.states)
    chosen = {}
    if case.operation.state is not None:
        index = names.index(case.operation.state) + 1
        chosen = {"number_of_gears": len(names), "gear_shift_index": index}
    builder = Builder()
    unit, casing, oil = surroundings(builder, case, **chosen)
    places = _places(case)
    shafts = _shafts(builder, case, (unit, casing), places)
    _sets(builder, case, (unit, oil), shafts, places)
    _loads(builder, case, shafts)
    _switches(builder, case, shafts | {HOUSING: casing})
    _bearings(builder, case, shafts | {HOUSING: casing}, places)
    return builder.parts()


def _places(case: TrainCase) -> dict[str, Place]:
    """Across the axes of the shafts, from centre distances and directions, the first at zero."""
    steps: list[tuple[str, str, Place]] = []
    for name, table in case.sets.items():
        bodies = case.shape.bodies_of(name)
        if isinstance(table, PairSet):
            length, toward = table.gears.distance, table.direction
            step = (length * math.cos(toward), length * math.sin(toward))
            steps.append((bodies["pinion"], bodies["gear"], step))
        else:
            steps += [(bodies["sun"], bodies[other], (0.0, 0.0)) for other in ("ring", "carrier")]
    found: dict[str, Place] = {}
    for start in case.shape.names.values():
        found.setdefault(start, (0.0, 0.0))
        for _ in steps:
            for one, two, (right, up) in steps:
                if one in found and HOUSING not in (one, two):
                    found.setdefault(two, (found[one][0] + right, found[one][1] + up))
                elif two in found and HOUSING not in (one, two):
                    found.setdefault(one, (found[two][0] - right, found[two][1] - up))
    return found


def _at(position: float, place: Place) -> dict[str, Any]:
    """Position and axis of a part."""
    return {
        "support_vector": tuple(round(1e3 * number, 9) for number in (position, *place)),
        "u_axis_vector": (1.0, 0.0, 0.0),
    }


def _shafts(
    builder: Builder, case: TrainCase, owners: tuple[int, int], places: Mapping[str, Place]
) -> dict[str, int]:
    """The shafts by their names and those of their members; what stands still, member by member."""
    unit, casing = owners
    operation, shape = case.operation, case.shape
    speeds = {shape.shaft_of(name): speed for name, speed in operation.speeds.items()}
    speeds[shape.shaft_of(operation.input)] = operation.speed
    found: dict[str, int] = {}
    for name, members in shape.shafts.items():
        if name == HOUSING:
            for member in members:
                found[member] = add_shaft(builder, unit, member)
                hold(builder, found[member], casing, member)
            continue
        found[name] = add_shaft(builder, unit, name, speeds.get(name), **_at(0.0, places[name]))
        found |= dict.fromkeys(members, found[name])
    return found


def _sets(
    builder: Builder,
    case: TrainCase,
    owners: tuple[int, int],
    shafts: Mapping[str, int],
    places: Mapping[str, Place],
) -> None:
    unit, oil = owners
    for name, table in case.sets.items():
        members = case.shape.sets[name].members
        own = {member: shafts[f"{name}.{member}"] for member in members}
        if isinstance(table, PlanetarySet):
            stage = builder.add("planetary_stage", name)
            builder.part(unit, stage)
            add_planetary(builder, table, (unit, stage, oil), own)
        elif isinstance(table, PairSet):
            gears = add_pair(builder, table, owners, own, name)
            for member, number in gears.items():
                position = case.position_of(f"{name}.{member}")
                shaft = case.shape.shaft_of(f"{name}.{member}") or ""
                if position is not None and shaft in places:
                    builder.extend(number, **_at(position, places[shaft]))


def _loads(builder: Builder, case: TrainCase, shafts: Mapping[str, int]) -> None:
    """Torque at the input, none at the output, and those of further shafts."""
    operation = case.operation
    add_load(builder, shafts[operation.input], operation.torque)
    builder.part(shafts[operation.output], builder.add("external_load", "driven"))
    for name, torque in operation.torques.items():
        add_load(builder, shafts[name], torque)


def _switches(builder: Builder, case: TrainCase, shafts: Mapping[str, int]) -> None:
    """Brakes and clutches with their positions, in the order of the states."""
    closed: dict[tuple[str, str], list[bool]] = {}
    for number, state in enumerate(case.states.values()):
        pairs = [(name, HOUSING) for name in state.fixed]
        pairs += [pair for group in state.joined for pair in pairwise(group)]
        for pair in pairs:
            closed.setdefault(pair, [False] * len(case.states))[number] = True
    for (one, two), engaged in closed.items():
        joint = builder.add("switchable_coupling", f"{one} and {two}", is_engaged=tuple(engaged))
        builder.relate("side", assembly=joint, inner_part=shafts[one], outer_part=shafts[two])


def _bearings(
    builder: Builder,
    case: TrainCase,
    shafts: Mapping[str, int],
    places: Mapping[str, Place],
) -> None:
    for kind, name, table in case.elements:
        if kind != "bearings" or not isinstance(table, ShaftBearingTable):
            continue
        known = {
            attribute: (value, unit)
            for attribute, value, unit in (
                ("width", table.width, "m"),
                ("radial_dynamic_load_rating", table.dynamic_load_rating, "N"),
                ("radial_static_load_rating", table.static_load_rating, "N"),
            )
            if value is not None
        }
        factor = table.axial_factor
        if factor is None and table.contact_angle is not None:
            factor = 0.4 / math.tan(table.contact_angle)
        place = places[case.shape.shaft_of(table.shaft) or ""]
        number = builder.add(
            "rolling_bearing_with_catalog_geometry",
            name,
            bearing_type=_TYPES[table.type],
            inner_diameter=(table.bore, "m"),
            outer_diameter=(table.outside_diameter, "m"),
            axial_force_absorption=_absorption(table),
            **known,
            **({} if factor is None else {"axial_factor_y_2": factor}),
            **({} if table.position is None else _at(table.position, place)),
        )
        ends = {"inner_part": shafts[table.shaft], "outer_part": shafts[table.against]}
        builder.relate("side", assembly=number, **ends)


def _absorption(table: ShaftBearingTable) -> str:
    if not table.locating:
        return "no_direction"
    return "both_directions" if table.axial_sense == "both" else table.axial_sense
