"""A set whose gears and meshes are listed, with computed losses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from epicyclic.builders.gears import gear_mesh, planet_mass
from epicyclic.builders.models import loss_choices, mesh_models
from epicyclic.builders.planetary import planet_bearing
from epicyclic.builders.wetting import carrier_disc, gear_disc
from epicyclic.case.listed_set import (
    ListedCase,
    arrangement_of,
    bearing_of,
    gear_of,
    hands_of,
    meshes_of,
    outward_of,
    pins_of,
    positions_of,
)
from epicyclic.case.train_shape import CARRIER
from epicyclic.gears.cutting import fitted_tool
from epicyclic.gears.gear import HOUSING
from epicyclic.gears.generation import Tool
from epicyclic.gears.mesh import Mesh
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.machine.disc import Disc
from epicyclic.machine.element import joined_key
from epicyclic.machine.gear_mesh import GearMesh
from epicyclic.machine.gear_set import GearSet, Planet, PlanetMesh
from epicyclic.machine.planets import LoadSharing


def listed_element(
    key: str,  # First part of the keys of its losses.
    case: ListedCase,
    # The body in the machine of every body of the set, and of its carrier.
    bodies: Mapping[str, str],
    flow_tables: FlowTables,  # Tables of flows through pockets.
) -> GearSet:
    """The losses of a listed set.

    Each of its meshes carries what the losses leave, which a set of several ways of power cannot
    state from one of its torques.
    """
    planets = bool(case.shape.planets)
    missing = (
        {} if case.table.carrier or not planets else {"carrier_drag": "the case has no [carrier]"}
    )
    return GearSet(
        key=key,
        carrier=bodies[CARRIER] if planets else HOUSING,
        meshes=tuple(_meshes(key, case, bodies, flow_tables)),
        planets=tuple(_planets(key, case, bodies)),
        sharing=_sharing(case),
        discs=dict(_discs(case, bodies)),
        missing=missing,
        thrust=None,
        choices=loss_choices(case),
    )


def _meshes(
    key: str, case: ListedCase, bodies: Mapping[str, str], flow_tables: FlowTables
) -> Iterator[GearMesh]:
    shape, tables = case.shape, case.table.members
    models = mesh_models(case, flow_tables)
    found = list(meshes_of(case.table, shape))
    tools = _tools(case, [mesh for _, mesh, _ in found])
    for drawn, mesh, table in found:
        gears = (drawn.first, drawn.second)
        one, two = gears
        yield gear_mesh(
            drawn.key,
            mesh,
            (tables[one], tables[two]),
            bodies=(bodies[shape.bodies[one]], bodies[shape.bodies[two]]),
            nodes=(joined_key(key, shape.bodies[one]), joined_key(key, shape.bodies[two])),
            tools=(tools[one], tools[two]),
            misalignment=table.misalignment,
            models=models[drawn.key],
            planets=case.table.planets or 1,
        )


def _tools(case: ListedCase, meshes: list[Mesh]) -> dict[str, Tool]:
    """The tool of each gear, which serves the mate that reaches deepest."""
    needed: dict[str, float] = {}
    for mesh in meshes:
        ends = ((mesh.gear1, mesh.radius1_at_start), (mesh.gear2, mesh.radius2_at_end))
        for gear, radius in ends:
            deeper = max if gear.internal else min
            needed[gear.name] = deeper(radius, needed.get(gear.name, radius))
    return {
        name: fitted_tool(gear_of(case.table, name), table.tool_tip_radius, needed[name])
        for name, table in case.table.members.items()
    }


def _planets(key: str, case: ListedCase, bodies: Mapping[str, str]) -> Iterator[Planet]:
    table, shape = case.table, case.shape
    pins = pins_of(table, shape)
    for body in shape.planets:
        masses = [
            gear.mass
            for name, gear in table.members.items()
            if shape.bodies[name] == body and gear.mass is not None
        ]
        bearing = bearing_of(table, body)
        gears = [
            (gear_of(table, name), gear)
            for name, gear in table.members.items()
            if shape.bodies[name] == body
        ]
        yield Planet(
            key=f"{body}_bearing",
            body=bodies[body],
            pin_radius=pins[body].radius,
            meshes=tuple(_planet_meshes(case, body)),
            mass=sum(masses) if masses else planet_mass(gears, bearing),
            mass_estimated=not masses,
            bearing=planet_bearing(case, bearing),
            no_bearing=f"the case has no bearing of {body}",
            tilts=case.models.planet_tilt == "coupled",
            nodes=(joined_key(key, body), joined_key(key, f"{body}_pin")),
        )


def _planet_meshes(case: ListedCase, body: str) -> Iterator[PlanetMesh]:
    """How the meshes of a planet stand to it: their directions, hands and places on its axis."""
    table, shape = case.table, case.shape
    pins, hands, places = (
        pins_of(table, shape),
        hands_of(table, shape),
        positions_of(table, shape),
    )
    for mesh in shape.meshes:
        for member, (gear, mate) in enumerate(
            ((mesh.first, mesh.second), (mesh.second, mesh.first)), start=1
        ):
            if shape.bodies[gear] != body:
                continue
            other = shape.bodies[mate]
            outward = outward_of(pins, body, other if other in shape.planets else None)
            yield PlanetMesh(
                mesh=mesh.key,
                member=member,
                outward=(0.0, -1.0) if mesh.internal else outward,
                # a torque from t to r pushes a right-handed gear against y
                hand=-hands[gear],
                position=places[gear],
            )


def _sharing(case: ListedCase) -> LoadSharing | None:
    if not case.shape.planets:
        return None
    assert case.table.planets is not None
    table = case.table.load_sharing
    return LoadSharing(
        method=table.method,
        mesh_load_factor=table.mesh_load_factor,
        angles=arrangement_of(case.shape, case.table.planets).angles,
        position_errors=(),
        floating_member="none",
        support_stiffness=0.0,
        pin_stiffness=None,
    )


def _discs(case: ListedCase, bodies: Mapping[str, str]) -> Iterator[tuple[str, tuple[Disc, ...]]]:
    """Every central gear turns in the mixture or a sump, and the carrier."""
    gears = []
    for name, table in case.table.members.items():
        body = case.shape.bodies[name]
        if body not in case.shape.planets:
            gears.append(gear_of(case.table, name))
            yield f"{name}_drag", (gear_disc(case, bodies[body], gears[-1], table),)
    carrier = case.table.carrier
    if carrier is not None:
        size = (carrier.outer_diameter, carrier.width)
        yield "carrier_drag", (carrier_disc(case, bodies[CARRIER], *size, gears[0]),)
