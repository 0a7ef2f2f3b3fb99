"""From the tables of a set to the element that loses its power."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import cast

from epicyclic.build.models import SetCase, contact_modulus, mesh_models, oil_share, solid_of
from epicyclic.case.tables.elements import PlanetBearing as BearingTable
from epicyclic.case.tables.elements import PlanetPin as PinTable
from epicyclic.case.tables.models import Numerics
from epicyclic.contact.elastic_teeth import GearBody, Rim
from epicyclic.contact.line_contact import Flanks
from epicyclic.gears import stated as flanks
from epicyclic.gears.cutting import cutting_tool, fitted_tool
from epicyclic.gears.gear import CARRIER, HOUSING, Gear
from epicyclic.gears.gearing import Gearing, outside_radius, outward_of, rim_thickness
from epicyclic.gears.mesh import Mesh
from epicyclic.gears.stated import StatedGear
from epicyclic.losses.drag import Dipped
from epicyclic.losses.journal_bearing import JournalBearing
from epicyclic.losses.planet_bearing import FITTED_OR_PALMGREN, RollerBearing
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.losses.rolling import FittedRolling
from epicyclic.losses.windage import LAMINAR_RIMS, DragModel, Teeth, Turning
from epicyclic.machine.convection import GRAVITY_TEMPERATURE, WATER
from epicyclic.machine.disc import Disc, Jets, Sump, ThrustBearing
from epicyclic.machine.element import joined_key
from epicyclic.machine.gear_mesh import GearMesh, MeshModels
from epicyclic.machine.gear_set import GearSet, LossChoice, Planet, PlanetMesh, Reference
from epicyclic.machine.planets import LoadSharing, PlanetBearing, PlanetPin
from epicyclic.oil.oil import oil_state

# How the oil of a case meets the bodies that turn in it.


def gear_disc(case: SetCase, name: str, bodies: Mapping[str, str]) -> Disc:
    """A gear as it turns in the mixture, dips or meets jets; `bodies` as for `gear_set`.

    A ring dips as a body without teeth: those of its inside are left out.
    """
    gearing = case.gearing
    gear, table, place = gearing.gear(name), gearing.tables[name], gearing.bodies[name]
    radius, oil = outside_radius(gear, table), case.lubrication
    part = Dipped(
        radius=radius if gear.internal else gear.reference_radius,
        tip_radius=radius,
        width=gear.face_width,
        depth=0.0,
        module=gear.rack.normal_module,
        teeth=0 if gear.internal else gear.teeth,
        tooth_height=abs(gear.tip_radius - gear.root_radius),
        pressure_angle=gear.rack.normal_pressure_angle,
        helix_angle=abs(gear.rack.helix_angle),
    )
    jets = None
    if oil is not None and oil.method == "jet" and oil.oil_flow:
        jets = Jets(oil.oil_flow, oil.jet_speed, oil.nozzle_side, gear.reference_radius)
    teeth = None
    if not gear.internal:
        space = 2 * (math.pi / gear.teeth - gear.half_angle_at(radius))
        teeth = Teeth(gear.teeth, gear.reference_radius, radius, gear.face_width, space)
    turning = Turning(radius, gear.face_width, teeth, table.shroud_gap, table.flange_gap)
    share, sump = oil_share(case).share, _sump(case, name, place, part)
    model = cast(DragModel, case.chosen["drag"])
    return Disc(name, bodies[place], turning, share, model, sump, jets)


def _sump(case: SetCase, name: str, body: str, part: Dipped) -> Sump | None:
    """What a part dips into, with the depth of its lowest point below the oil at rest."""
    table = case.lubrication
    if table is None or table.method != "dip":
        return None
    level = case.oil_heights.get(body) if table.oil_level is None else table.oil_level
    depth = table.immersion.get(name, 0.0) if level is None else max(part.tip_radius + level, 0.0)
    volume = case.thermal.oil_volume if table.oil_volume is None else table.oil_volume
    assert volume is not None
    smooth = case.chosen["drag"] != LAMINAR_RIMS
    return Sump(replace(part, depth=depth), volume, table.churning, smooth)


CAGED_PALMGREN = 0.0003
"""f1 of a caged roller bearing, middle of 0.0002-0.0004. Talbot (2012), p. 56. [1]"""
FULL_COMPLEMENT_PALMGREN = 0.00055
"""f1 of a full-complement roller bearing. Talbot (2012), p. 56. [1]"""
SPHERICAL_PALMGREN = 0.00025
"""f1 of spherical roller bearings, 0.0005 (P0/C0)^0.33 at a tenth of the static rating; catalogue
of FAG, second hand. [1]"""
VISCOUS_FACTOR_PER_ROW = 3.0
"""f0 of one row of caged cylindrical rollers, middle of 2.2-4.0. Talbot (2012), p. 130. [1]"""


def gear_set(
    key: str,  # First part of the keys of its losses.
    case: SetCase,
    # The body in the machine of every body of the set, and of its carrier.
    bodies: Mapping[str, str],
    # Its members: that whose torque states the load, then those between which the losses act.
    order: Sequence[str],
    flow_tables: FlowTables,  # Tables of flows through pockets.
) -> GearSet:
    """The losses of a set."""
    gearing = case.gearing
    discs = dict(_discs(case, bodies))
    choices = {
        name: LossChoice(option.include, option.factor)
        for name, option in case.losses.items()
        if name != "planets_drag" or name in discs  # which not every model of drag has
    }
    lacking = {
        "carrier_drag": (case.carrier, "[carrier]"),
        "thrust_bearing_viscous": (case.thrust_bearing, "[thrust_bearing]"),
    }
    table, sharing = case.sharing, None
    if table is not None:
        sharing = LoadSharing(
            method=table.method,
            mesh_load_factor=table.mesh_load_factor,
            angles=gearing.planet_angles,
            position_errors=table.position_errors or (),
            floating_member=table.floating_member,
            support_stiffness=table.support_stiffness,
            pin_stiffness=table.pin_stiffness,
        )
    beside, thrust = case.thrust_bearing, None
    if beside is not None:
        one, two = beside.between.split("-")
        thrust = ThrustBearing(
            between=(bodies[one], bodies.get(two, HOUSING)),
            mean_diameter=beside.mean_diameter,
            viscous_factor=beside.viscous_factor,
            count=beside.count,
        )
    return GearSet(
        key=key,
        carrier=bodies[CARRIER] if gearing.planets else HOUSING,
        meshes=tuple(_meshes(key, case, bodies, mesh_models(case, choices, flow_tables))),
        planets=tuple(_planet(key, case, body, bodies[body]) for body in gearing.planets),
        sharing=sharing,
        discs=discs,
        missing={
            name: f"the case has no {table}"
            for name, (part, table) in lacking.items()
            if part is None and name in choices
        },
        thrust=thrust,
        choices=choices,
        reference=None
        if case.models.mesh_loads == "with-losses"
        else _reference(case, bodies, order),
    )


def _reference(case: SetCase, bodies: Mapping[str, str], order: Sequence[str]) -> Reference | None:
    """Where the loads of meshes are those without losses; a set of several ways has none."""
    levers = case.gearing.levers
    if not levers:
        return None
    loaded, *others = order
    between = [bodies[member] for member in others]
    ends = (between[0], between[1] if len(between) > 1 else HOUSING)
    return Reference(bodies[loaded], levers[loaded], ends)


def _meshes(
    key: str, case: SetCase, bodies: Mapping[str, str], models: Mapping[str, MeshModels]
) -> Iterator[GearMesh]:
    gearing = case.gearing
    # the tool of each gear serves the mate that reaches deepest
    needed: dict[str, float] = {}
    for mesh in gearing.geometries:
        for gear, radius in ((mesh.gear1, mesh.inner_radii[0]), (mesh.gear2, mesh.inner_radii[1])):
            deeper = max if gear.internal else min
            needed[gear.name] = deeper(radius, needed.get(gear.name, radius))
    tools = {
        name: fitted_tool(gearing.gear(name), table.tool_tip_radius, needed[name])
        for name, table in gearing.tables.items()
    }
    for drawn, mesh in zip(gearing.meshes, gearing.geometries, strict=True):
        one, two = tables = gearing.tables[drawn.first], gearing.tables[drawn.second]
        own = [gearing.bodies[gear] for gear in (drawn.first, drawn.second)]
        yield GearMesh(
            key=drawn.key,
            mesh=mesh,
            bodies=(bodies[own[0]], bodies[own[1]]),
            tools=(tools[drawn.first], tools[drawn.second]),
            roundings=(one.tool_tip_radius, two.tool_tip_radius),
            flanks=Flanks(
                contact_modulus(one.material, two.material),
                one.roughness,
                two.roughness,
                (solid_of(one.material).effusivity, solid_of(two.material).effusivity),
            ),
            solids=gear_bodies(mesh, tables, gearing.count or 1),
            deviations=flanks.flank_deviations(mesh, tables, drawn.table.misalignment),
            models=models[drawn.key],
            materials=(solid_of(one.material), solid_of(two.material)),
            nodes=(joined_key(key, own[0]), joined_key(key, own[1])),
        )


@lru_cache(maxsize=256)
def gear_bodies(
    mesh: Mesh, tables: tuple[StatedGear, StatedGear], planets: int = 1
) -> tuple[GearBody, GearBody]:
    """Materials, root fillets and rims of both members of a mesh, `planets` of which are alike."""
    made = []
    for gear, table, loads in zip((mesh.gear1, mesh.gear2), tables, (1, planets), strict=True):
        thickness, material = rim_thickness(table), table.material
        tool = cutting_tool(gear, table.tool_tip_radius)
        rim = None if thickness is None else Rim(thickness, loads)
        made.append(GearBody(material.elastic_modulus, material.poisson_ratio, tool, rim))
    return made[0], made[1]


def _planet(key: str, case: SetCase, planet: str, body: str) -> Planet:
    gearing, bearing = case.gearing, case.bearings[planet]
    gears = {name: gearing.tables[name] for name in gearing.gears_of(planet)}
    stated = [
        mass for table in gears.values() if (mass := getattr(table, "mass", None)) is not None
    ]
    made = [(gearing.gear(name), table) for name, table in gears.items()]
    pin = f"{planet}_pin" if gearing.listed else "pin"
    own: PlanetBearing | PlanetPin | None = None
    if isinstance(bearing, PinTable):
        own = planet_pin(case, bearing, planet)
    elif bearing is not None:
        own = planet_bearing(case, bearing, planet)
        if stated and sum(stated) == 0:  # neither has it the mass of its rollers
            own = replace(own, roller_density=0.0)
    no_bearing = f"bearing of {planet}" if gearing.listed else "[planet_bearing]"
    return Planet(
        key=f"{planet}_bearing",
        body=body,
        pin_radius=gearing.pins[planet].radius,
        meshes=tuple(_planet_meshes(gearing, planet)),
        mass=sum(stated) if stated else planet_mass(made, bearing),
        mass_estimated=not stated,
        bearing=own,
        no_bearing=f"the case has no {no_bearing}",
        diameter=2 * max(gear.reference_radius for gear, _ in made),
        tilts=case.models.planet_tilt == "coupled",
        nodes=(joined_key(key, planet), joined_key(key, pin)),
    )


def _planet_meshes(gearing: Gearing, planet: str) -> Iterator[PlanetMesh]:
    """How the meshes of a planet stand to it: their directions, hands and places on its axis."""
    pins, hands, places = gearing.pins, gearing.hands, gearing.positions
    for mesh in gearing.meshes:
        ends = ((mesh.first, mesh.second), (mesh.second, mesh.first))
        for member, (gear, mate) in enumerate(ends, start=1):
            if gearing.bodies[gear] != planet:
                continue
            other = gearing.bodies[mate]
            outward = outward_of(pins, planet, other if other in gearing.planets else None)
            yield PlanetMesh(
                mesh=mesh.key,
                member=member,
                outward=(0.0, -1.0) if mesh.internal else outward,
                # a torque from t to r pushes a right-handed gear against y
                hand=-hands[gear],
                position=places[gear],
            )


def planet_mass(
    gears: Iterable[tuple[Gear, StatedGear]], bearing: BearingTable | PinTable | None
) -> float:
    """Mass of a planet with its rollers, from its sizes: discs to the reference circles. [kg]

    Theory (B19).
    """
    bore = rollers = 0.0
    if isinstance(bearing, PinTable):
        bore = bearing.pin_diameter + bearing.diametral_clearance
    elif bearing is not None:
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


def planet_bearing(case: SetCase, table: BearingTable, planet: str) -> PlanetBearing:
    """The bearing of a planet, with the models of the case."""
    name = case.bearing_model(planet)
    is_fitted = name in (FittedRolling.name, FITTED_OR_PALMGREN)
    factor, palmgren = table.viscous_factor, table.palmgren_coefficient
    if palmgren is None:
        palmgren = CAGED_PALMGREN if table.cage == "caged" else FULL_COMPLEMENT_PALMGREN
        if table.type == "spherical":
            palmgren = SPHERICAL_PALMGREN
    return PlanetBearing(
        bearing=roller_bearing(table, case.numerics),
        model=case.fitted_rolling("bearing_rolling_loss") if is_fitted else name,
        palmgren_coefficient=palmgren,
        viscous_factor=VISCOUS_FACTOR_PER_ROW * table.rows if factor is None else factor,
        conductivity=table.material.thermal_conductivity,
        oil_held=case.models.oil_beyond_range == "held",
        palmgren_beyond=name == FITTED_OR_PALMGREN,
        roller_density=table.material.density,
        aligns_itself=table.type == "spherical",
        cage=table.cage,
        limiting_speed=table.limiting_speed,
        viscous_added=case.models.preset != "general",
    )


def planet_pin(case: SetCase, table: PinTable, planet: str) -> PlanetPin:
    """The plain pin of a planet in the bore of its widest gear."""
    oil, own = case.lubricant.oil, case.gearing.gears_of(planet)
    material = case.gearing.tables[max(own, key=lambda name: case.gearing.gear(name).face_width)]
    friction, capacity = table.boundary_friction, oil.specific_heat_capacity
    stated = oil_state(oil, GRAVITY_TEMPERATURE)
    bearing = JournalBearing(
        inner_diameter=table.pin_diameter,
        length=table.length,
        diametral_clearance=table.diametral_clearance,
        roughness=math.hypot(table.pin_roughness, table.bore_roughness),
        # E' of asperities is half of E_eq
        contact_modulus=contact_modulus(table.material, material.material) / 2,
        boundary_friction=stated.boundary_friction if friction is None else friction,
        conductance=table.pin_diameter * table.material.thermal_conductivity,
        oil_flow=table.oil_flow,
    )
    return PlanetPin(bearing, stated.density / WATER, None if capacity is None else capacity.value)


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
        equivalent_modulus=contact_modulus(table.material, table.material),
        slices=numerics.bearing_slices,
    )


def _discs(case: SetCase, bodies: Mapping[str, str]) -> Iterator[tuple[str, tuple[Disc, ...]]]:
    """Every central gear turns in the mixture or a sump, and the carrier."""
    gearing = case.gearing
    for name, gears in gearing.drags.items():
        yield name, tuple(gear_disc(case, it, bodies) for it in gears)
    carried, table, across = [], case.carrier, 0.0
    number, moves_planets = gearing.count or 1, case.chosen["drag"] != LAMINAR_RIMS
    for planet in gearing.planets if moves_planets else ():
        for name in gearing.gears_of(planet):
            disc = gear_disc(case, name, bodies)
            # it turns in what the carrier takes along
            disc = replace(disc, sump=None, jets=None, against=bodies[CARRIER], count=number)
            carried.append(disc)
            if table is not None:
                open_width = min(table.open_width, disc.turning.width)
                distance = gearing.pins[planet].radius
                across += number * 2 * disc.turning.radius * open_width * distance**3
    if table is not None:  # its flow in a sump is told apart by a gear beside it
        radius, width = table.outer_diameter / 2, table.width
        mate = gearing.gear(next(gears[0] for gears in gearing.drags.values()))
        part = Dipped(radius, radius, width, 0.0, mate.rack.normal_module)
        gaps = table.shroud_gap, table.flange_gap
        turning = Turning(radius, max(width - table.open_width, 0.0), None, *gaps, across)
        share, sump = oil_share(case).share, _sump(case, CARRIER, CARRIER, part)
        model = cast(DragModel, case.chosen["drag"])
        yield "carrier_drag", (Disc("carrier", bodies[CARRIER], turning, share, model, sump),)
    if carried:
        yield "planets_drag", tuple(carried)
