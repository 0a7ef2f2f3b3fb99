"""A planetary set of sun, planets, ring and carrier as a machine."""

from __future__ import annotations

from collections.abc import Mapping

from epicyclic.builders.built import Built
from epicyclic.builders.gears import gear_mesh, planet_mass
from epicyclic.builders.models import (
    bearing_model,
    fitted_rolling,
    fluids_of,
    loss_choices,
    mesh_models,
)
from epicyclic.builders.wetting import carrier_disc, gear_disc
from epicyclic.case import build
from epicyclic.case.case import PlanetaryCase
from epicyclic.case.listed_set import ListedCase
from epicyclic.case.model_tables import Numerics
from epicyclic.case.part_tables import PlanetBearing as BearingTable
from epicyclic.gears.cutting import fitted_tool
from epicyclic.gears.generation import Tool
from epicyclic.gears.mesh import Mesh
from epicyclic.losses.fitted import FittedRolling
from epicyclic.losses.planet_bearing import FITTED_OR_PALMGREN, RollerBearing
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.machine.disc import Disc, ThrustBearing
from epicyclic.machine.element import HOUSING, joined_key
from epicyclic.machine.gear_mesh import GearMesh
from epicyclic.machine.gear_set import GearSet, Planet, PlanetMesh, Reference
from epicyclic.machine.machine import Machine, MeshRow, Operation
from epicyclic.machine.planets import LoadSharing, PlanetBearing
from epicyclic.result.result import Layout

MEMBERS = ("sun", "ring", "carrier")
CAGED_PALMGREN = 0.0003
"""f1 of a caged roller bearing, middle of 0.0002-0.0004. Talbot (2012), p. 56. [1]"""
FULL_COMPLEMENT_PALMGREN = 0.00055
"""f1 of a full-complement roller bearing. Talbot (2012), p. 56. [1]"""
VISCOUS_FACTOR_PER_ROW = 3.0
"""f0 of one row of caged cylindrical rollers, middle of 2.2-4.0. Talbot (2012), p. 130. [1]"""


def build_planetary(case: PlanetaryCase, flow_tables: FlowTables) -> Built:
    """A single planetary set, driven as the case says."""
    operation = case.operation
    bodies = {name: name for name in (*MEMBERS, "planet")}
    held = operation.fixed or operation.second_input
    assert held is not None
    (output,) = set(MEMBERS) - {operation.input, held}
    element = planetary_element("", case, bodies, (operation.input, output, held), flow_tables)
    held_speed = 0.0 if operation.second_speed is None else operation.second_speed
    return Built(
        machine=Machine(tuple(bodies), planetary_rows("", case, bodies), (element,)),
        operation=Operation(
            operation.input,
            output,
            operation.torque,
            {operation.input: operation.speed, held: held_speed},
        ),
        known_fluids=fluids_of(case),
        sets={"": element},
        layout=Layout(
            tuple(element.choices),
            MEMBERS,
            ("sun_mesh", "ring_mesh"),
            ("planet_bearing",),
            shares=True,
        ),
    )


def planetary_rows(key: str, case: PlanetaryCase, bodies: Mapping[str, str]) -> tuple[MeshRow, ...]:
    """The constraints of both meshes. Theory (K1), (K2)."""
    sun, planet, ring, carrier = (bodies[name] for name in ("sun", "planet", "ring", "carrier"))
    planet_teeth = case.planet.teeth
    return (
        MeshRow(f"{key}.sun_mesh", sun, planet, carrier, (case.sun.teeth, planet_teeth)),
        MeshRow(f"{key}.ring_mesh", planet, ring, carrier, (planet_teeth, case.ring.teeth), True),
    )


def planetary_element(
    key: str,  # First part of the keys of its losses.
    case: PlanetaryCase,
    bodies: Mapping[str, str],  # Bodies of ``"sun"``, ``"ring"``, ``"carrier"`` and ``"planet"``.
    # The member whose torque states the load, and the two between which the losses act.
    order: tuple[str, str, str],
    flow_tables: FlowTables,  # Tables of flows through pockets.
) -> GearSet:
    """The losses of a planetary set."""
    carrier = bodies["carrier"]
    return GearSet(
        key=key,
        carrier=carrier,
        meshes=_meshes(key, case, bodies, flow_tables),
        planets=(_planet(key, case, bodies["planet"]),),
        sharing=_sharing(case),
        discs=_discs(case, bodies),
        missing=_missing(case),
        thrust=_thrust_bearing(case, bodies),
        choices=loss_choices(case),
        reference=(
            None
            if case.models.mesh_loads == "with-losses"
            else Reference(
                bodies[order[0]], _levers(case, order[0]), (bodies[order[1]], bodies[order[2]])
            )
        ),
    )


def _levers(case: PlanetaryCase, member: str) -> dict[str, float]:
    """Torques at the first gears of both meshes over that of a member. Theory (K3), (K4)."""
    sun, ring = case.sun.teeth, case.ring.teeth
    factors = {"sun": sun, "ring": ring, "carrier": -(sun + ring)}
    lever = sun / factors[member]
    return {"sun_mesh": lever, "ring_mesh": -lever * case.planet.teeth / sun}


def _meshes(
    key: str, case: PlanetaryCase, bodies: Mapping[str, str], flow_tables: FlowTables
) -> tuple[GearMesh, GearMesh]:
    sun_mesh, ring_mesh = build.planetary_meshes(case.gears, case.sun, case.planet, case.ring)
    sun, planet, ring = _tools(case, sun_mesh, ring_mesh)
    models = mesh_models(case, flow_tables)
    return (
        gear_mesh(
            "sun_mesh",
            sun_mesh,
            (case.sun, case.planet),
            bodies=(bodies["sun"], bodies["planet"]),
            nodes=(joined_key(key, "sun"), joined_key(key, "planet")),
            tools=(sun, planet),
            misalignment=case.sun_mesh.misalignment,
            models=models["sun_mesh"],
        ),
        gear_mesh(
            "ring_mesh",
            ring_mesh,
            (case.planet, case.ring),
            bodies=(bodies["planet"], bodies["ring"]),
            nodes=(joined_key(key, "planet"), joined_key(key, "ring")),
            tools=(planet, ring),
            misalignment=case.ring_mesh.misalignment,
            models=models["ring_mesh"],
            planets=case.planet.count,
        ),
    )


def _tools(case: PlanetaryCase, sun_mesh: Mesh, ring_mesh: Mesh) -> tuple[Tool, Tool, Tool]:
    """The tools of sun, planet and ring; the planet serves the mate that reaches deeper."""
    planet = min(sun_mesh.radius2_at_end, ring_mesh.radius1_at_start)
    return (
        fitted_tool(sun_mesh.gear1, case.sun.tool_tip_radius, sun_mesh.radius1_at_start),
        fitted_tool(sun_mesh.gear2, case.planet.tool_tip_radius, planet),
        fitted_tool(ring_mesh.gear2, case.ring.tool_tip_radius, ring_mesh.radius2_at_end),
    )


def _planet(key: str, case: PlanetaryCase, body: str) -> Planet:
    mass, estimated = case.planet.mass, case.planet.mass is None
    if mass is None:
        gear = build.gear("planet", case.planet, case.gears)
        mass = planet_mass([(gear, case.planet)], case.planet_bearing)
    return Planet(
        key="planet_bearing",
        body=body,
        pin_radius=case.gears.distance,
        meshes=(
            PlanetMesh("sun_mesh", 2, (0.0, 1.0)),
            PlanetMesh("ring_mesh", 1, (0.0, -1.0)),
        ),
        mass=mass,
        mass_estimated=estimated,
        bearing=planet_bearing(case, case.planet_bearing),
        no_bearing="the case has no [planet_bearing]",
        tilts=case.models.planet_tilt == "coupled",
        nodes=(joined_key(key, "planet"), joined_key(key, "pin")),
    )


def _sharing(case: PlanetaryCase) -> LoadSharing:
    table = case.load_sharing
    return LoadSharing(
        method=table.method,
        mesh_load_factor=table.mesh_load_factor,
        angles=build.planet_angles(case.sun, case.planet, case.ring),
        position_errors=table.position_errors or (),
        floating_member=table.floating_member,
        support_stiffness=table.support_stiffness,
        pin_stiffness=table.pin_stiffness,
    )


def planet_bearing(
    case: PlanetaryCase | ListedCase, table: BearingTable | None
) -> PlanetBearing | None:
    """The planet bearing that `table` describes, with the models of the case."""
    if table is None:
        return None
    name = bearing_model(case, table)
    is_fitted = name in (FittedRolling.name, FITTED_OR_PALMGREN)
    factor = table.viscous_factor
    return PlanetBearing(
        bearing=roller_bearing(table, case.numerics),
        model=fitted_rolling(case, "bearing_rolling_loss") if is_fitted else name,
        palmgren_coefficient=palmgren_coefficient(table),
        viscous_factor=VISCOUS_FACTOR_PER_ROW * table.rows if factor is None else factor,
        conductivity=table.material.thermal_conductivity,
        oil_held=case.models.oil_beyond_range == "held",
        palmgren_beyond=name == FITTED_OR_PALMGREN,
    )


def palmgren_coefficient(table: BearingTable) -> float:
    """f1 of the case, or the published one of the bearing's kind. [1]"""
    if table.palmgren_coefficient is not None:
        return table.palmgren_coefficient
    return CAGED_PALMGREN if table.cage == "caged" else FULL_COMPLEMENT_PALMGREN


def roller_bearing(table: BearingTable, numerics: Numerics) -> RollerBearing:
    """The bearing that `table` describes."""
    return RollerBearing(
        rows=table.rows,
        rollers_per_row=table.rollers_per_row,
        roller_diameter=table.roller_diameter,
        roller_length=table.roller_length,
        inner_diameter=table.pin_diameter,
        diametral_clearance=table.diametral_clearance,
        crown_drop=table.crown_drop,
        crown_length_fraction=table.crown_length_fraction,
        row_gap=table.row_gap,
        roller_roughness=table.roller_roughness,
        race_roughness=table.race_roughness,
        equivalent_modulus=table.material.modulus_against(table.material),
        slices=numerics.bearing_slices,
    )


def _discs(case: PlanetaryCase, bodies: Mapping[str, str]) -> dict[str, tuple[Disc, ...]]:
    sun = build.gear("sun", case.sun, case.gears)
    ring = build.gear("ring", case.ring, case.gears)
    discs: dict[str, tuple[Disc, ...]] = {
        "sun_drag": (gear_disc(case, bodies["sun"], sun, case.sun),),
        "ring_drag": (gear_disc(case, bodies["ring"], ring, case.ring),),
    }
    if case.carrier is not None:
        size = (case.carrier.outer_diameter, case.carrier.width)
        discs["carrier_drag"] = (carrier_disc(case, bodies["carrier"], *size, sun),)
    return discs


def _missing(case: PlanetaryCase) -> dict[str, str]:
    missing = {}
    if case.carrier is None:
        missing["carrier_drag"] = "the case has no [carrier]"
    if case.thrust_bearing is None:
        missing["thrust_bearing_viscous"] = "the case has no [thrust_bearing]"
    return missing


def _thrust_bearing(case: PlanetaryCase, bodies: Mapping[str, str]) -> ThrustBearing | None:
    table = case.thrust_bearing
    if table is None:
        return None
    one, two = table.between.split("-")
    return ThrustBearing(
        between=(bodies[one], bodies.get(two, HOUSING)),
        mean_diameter=table.mean_diameter,
        viscous_factor=table.viscous_factor,
        count=table.count,
    )
