"""From the tables of gears to meshes with their tools, flanks and elastic bodies."""

from __future__ import annotations

import math
from collections.abc import Iterable

from epicyclic.case import flanks
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.tables.base import Material
from epicyclic.case.tables.elements import PlanetBearing
from epicyclic.contact.line_contact import Flanks
from epicyclic.contact.temperatures import Solid
from epicyclic.gears.gear import Gear
from epicyclic.gears.generation import Tool
from epicyclic.gears.mesh import Mesh
from epicyclic.kernels.line_contact import equivalent_modulus
from epicyclic.machine.gear_mesh import GearMesh, MeshModels


def gear_mesh(
    key: str,
    mesh: Mesh,
    tables: tuple[GearTable, GearTable],
    *,
    bodies: tuple[str, str],
    nodes: tuple[str, str],
    tools: tuple[Tool, Tool],
    misalignment: float,
    models: MeshModels,
    planets: int = 1,
) -> GearMesh:
    """The mesh of two gears, one of `planets` alike, as an element sees it."""
    return GearMesh(
        key=key,
        mesh=mesh,
        bodies=bodies,
        tools=tools,
        roundings=(tables[0].tool_tip_radius, tables[1].tool_tip_radius),
        flanks=_flanks(tables),
        solids=flanks.gear_bodies(mesh, tables, planets),
        deviations=flanks.flank_deviations(mesh, tables, misalignment),
        models=models,
        materials=(solid_of(tables[0].material), solid_of(tables[1].material)),
        nodes=nodes,
    )


def planet_mass(gears: Iterable[tuple[Gear, GearTable]], bearing: PlanetBearing | None) -> float:
    """Mass of a planet with its rollers, from its sizes: discs to the reference circles. [kg]

    Theory (B19).
    """
    bore = rollers = 0.0
    if bearing is not None:
        bore = bearing.pin_diameter + 2 * bearing.roller_diameter + bearing.diametral_clearance
        volume = math.pi / 4 * bearing.roller_diameter**2 * bearing.roller_length
        rollers = bearing.rows * bearing.rollers_per_row * volume * bearing.material.density
    return rollers + sum(
        math.pi
        * (gear.reference_radius**2 - (bore / 2) ** 2)
        * gear.face_width
        * table.material.density
        for gear, table in gears
    )


def _flanks(tables: tuple[GearTable, GearTable]) -> Flanks[float]:
    """Roughness of both flanks and their equivalent modulus."""
    one, two = tables
    modulus = contact_modulus(one.material, two.material)
    return Flanks(modulus, one.roughness, two.roughness)


def contact_modulus(one: Material, other: Material) -> float:
    """Equivalent modulus E_eq of a contact of two materials. [Pa]"""
    return equivalent_modulus(
        one.elastic_modulus, one.poisson_ratio, other.elastic_modulus, other.poisson_ratio
    )


def solid_of(
    material: Material,
    conductivity: float | None = None,  # Instead of its own. [W/(m K)]
    heat_capacity: float | None = None,  # Instead of its own. [J/(kg K)]
) -> Solid:
    """What heat sees of a material."""
    return Solid(
        material.thermal_conductivity if conductivity is None else conductivity,
        material.heat_capacity if heat_capacity is None else heat_capacity,
        material.density,
    )
