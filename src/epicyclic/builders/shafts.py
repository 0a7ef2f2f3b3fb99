"""Gears and bearings along the shafts of a train, for the forces on its bearings."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from epicyclic.case.tables.elements import ShaftBearingTable
from epicyclic.case.train import TrainCase
from epicyclic.case.train_rules import needs_force
from epicyclic.gears.gear import HOUSING
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.machine import GearSeat, ShaftLayout, Support


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
