"""From the tables of a case to the model of its temperatures."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from epicyclic.build.models import fluids_of, oil_share, set_cases, with_lubrication
from epicyclic.case.case import Case
from epicyclic.case.tables.operation import HousingTable, LubricationTable, ThermalTable
from epicyclic.contact.temperatures import LUBRICATION_FACTORS
from epicyclic.losses.ranges import Flags, ValidityFlag
from epicyclic.machine.convection import Fluid, air, mixture, oil_conductivity, oil_heat_capacity
from epicyclic.machine.element import OIL, Fluids, fluids_at, joined_key, oil_at, oil_flags
from epicyclic.machine.gear_mesh import GearMesh
from epicyclic.machine.gear_set import GearSet
from epicyclic.machine.heat import (
    Change,
    FlankModel,
    HeatSettings,
    Housing,
    NetworkModel,
    ThermalModel,
    Wet,
)
from epicyclic.machine.machine import Machine
from epicyclic.machine.shaft_parts import ShaftBearing
from epicyclic.oil.oil import Oil
from epicyclic.oil.properties import mixture_state, oil_state
from epicyclic.result.result import in_words

GRAVITY_TEMPERATURE = 288.75  # 15.6 degC, at which the specific gravity of petroleum is stated. [K]
WATER = 999.0  # Density of water there. [kg/m^3]
IN_BATH = ("dip", "submerged")


def thermal_model(case: Case, machine: Machine) -> ThermalModel | None:
    """How the temperatures of a case follow from its losses; None if all are the inlet's."""
    kind = case.models.temperatures
    if kind == "inlet" or case.lubricant is None:
        return None
    fluids = _fluids_at(case, contact_nodes(machine))
    inlet = fluids_of(case).oil.temperature
    keys = [own.key for own in machine.elements if isinstance(own, GearSet)]
    tables = {key: own.lubrication for key, own in set_cases(case, keys)}
    if kind == "flank":
        factors = {key: _lubrication_factor(case.thermal, table) for key, table in tables.items()}
        return FlankModel(machine, inlet, case.thermal.bulk, factors, fluids)
    flows = [table.oil_flow for table in tables.values() if table is not None and table.oil_flow]
    settings = _settings(case, machine, tables, sum(flows) if flows else None, inlet)
    pressure, share = case.surroundings.pressure, oil_share(case).share
    return NetworkModel(machine, settings, fluids, _media(case.lubricant.oil, pressure, share))


def _lubrication_factor(thermal: ThermalTable, table: LubricationTable | None) -> float:
    """X_S of a set. [1]"""
    return LUBRICATION_FACTORS[with_lubrication(thermal, table, None).lubrication]


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
            parts = [(mesh.key, _at_flanks(mesh)) for mesh in own.meshes]
            parts += [(planet.key, ("mechanical", "viscous")) for planet in own.planets]
            found |= {
                (own.key, f"{key}_{name}"): nodes[joined_key(own.key, key)]
                for key, names in parts
                for name in names
            }
        elif isinstance(own, ShaftBearing):
            found |= {(own.key, name): nodes[own.key] for name in own.terms}
    return found


def _at_flanks(mesh: GearMesh) -> tuple[str, ...]:
    """Losses of a mesh that depend on the temperature of its flanks, and not on the oil's."""
    if mesh.models.friction.takes_oil_temperature:
        return ("rolling",)
    return ("sliding", "rolling")


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
        fluids = fluids_at(
            oil,
            around,
            oil_air_ratio=oil_share(case).share,
            pressure=case.surroundings.pressure,
            pressure_viscosity_factor=factor,
        )
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


def _media(oil: Oil, pressure: float, share: float) -> Callable[[float], tuple[Fluid, Fluid]]:
    """The oil, and its mixture with air, as heat sees them."""

    def at(temperature: float) -> tuple[Fluid, Fluid]:
        own = oil_medium(oil, temperature)
        state = mixture_state(oil_state(oil, temperature), share, pressure)
        return own, mixture(own, air(temperature, pressure), state)

    return at


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
        housing=None if table.housing is None else _housing(table.housing),
        changes={
            name: Change(change.value, change.scale) for name, change in table.conductances.items()
        },
        oil_volume=table.oil_volume,
        housing_mass=None if table.housing is None else _steel_mass(table.housing),
        capacity_changes={
            name: Change(change.value, change.scale) for name, change in table.capacities.items()
        },
    )


def _wet(table: ThermalTable, gear_sets: Sequence[GearSet], to_gears: float | None) -> Wet:
    """How oil gets to some sets."""
    baths = {"dip": _bath_share(table, gear_sets), "submerged": 1.0}
    return Wet(baths.get(table.lubrication, 0.0), _effectiveness(table, to_gears))


def _bath_share(table: ThermalTable, gear_sets: Sequence[GearSet]) -> float:
    """Share of the gears that dips, as given or as the oil stands; the mean of all gears.

    Theory (N10).
    """
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


def _effectiveness(table: ThermalTable, to_gears: float | None) -> float:
    """How far the flow of oil reaches the temperature of the gears, what misses them included."""
    if table.lubrication in IN_BATH:
        return 0.0
    if to_gears is None or not table.oil_flow or table.jet_shares:
        return table.jet_effectiveness
    return table.jet_effectiveness * min(1.0, to_gears / table.oil_flow)


def _steel_mass(table: HousingTable) -> float | None:
    """Steel that stores as much heat as the housing. [kg]"""
    return None if table.mass is None else table.mass * table.heat_capacity_ratio


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
