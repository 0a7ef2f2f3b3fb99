"""A gear set as the parts of a new REXS file.

Axes run along u. The helix of the sun, or of the pinion, is written right-handed unless the set of
a train has another hand: the losses of a single set do not depend on it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from epicyclic.case.build import gear
from epicyclic.case.case import Case, GearPairCase, PlanetaryCase
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.part_tables import PlanetBearing
from epicyclic.case.schema import Material
from epicyclic.case.train_tables import PairSet, PlanetarySet
from epicyclic.exchange.rexs.model import Attribute, Component, Relation
from epicyclic.exchange.rexs.vocabulary import term, written
from epicyclic.geometry.gear import Gear
from epicyclic.geometry.roughness import RA_OVER_RQ
from epicyclic.lubricant.oil import Oil
from epicyclic.lubricant.properties import oil_state

_CELSIUS = 273.15

_OIL_TYPES = {
    "mineral": "mineral_oil",
    "pao": "polyalfaolefin",
    "pag": "non_water_soluble_polyglycol",
}


def case_parts(case: PlanetaryCase | GearPairCase) -> Iterator[Component | Relation]:
    """Components and relations that describe the gear set of a case."""
    builder = Builder()
    if isinstance(case, PlanetaryCase):
        _planetary(builder, case)
    else:
        _pair(builder, case)
    return builder.parts()


class Builder:
    """Collects parts and numbers them."""

    def __init__(self) -> None:
        self.components: list[Component] = []
        self.relations: list[Relation] = []

    def add(self, kind: str, name: str, /, **attributes: Any) -> int:
        """A component; attributes as text, flags, numbers, or numbers with the unit they have."""
        number = len(self.components) + 1
        self.components.append(Component(number, kind, name, _made(attributes)))
        return number

    def extend(self, number: int, /, **attributes: Any) -> None:
        """Further attributes of a component."""
        own = self.components[number - 1]
        made = {**own.attributes, **_made(attributes)}
        self.components[number - 1] = replace(own, attributes=made)

    def relate(self, kind: str, order: int | None = None, **roles: int) -> None:
        """A relation of components by their roles."""
        number = len(self.relations) + 1
        self.relations.append(Relation(number, kind, tuple(roles.items()), order))

    def parts(self) -> Iterator[Component | Relation]:
        """All that was added."""
        yield from self.components
        yield from self.relations

    def part(self, assembly: int, *parts: int) -> None:
        """Parts of an assembly."""
        for part in parts:
            self.relate("assembly", assembly=assembly, part=part)


def _made(attributes: Mapping[str, Any]) -> dict[str, Attribute]:
    made = {}
    for key, value in attributes.items():
        known = term(key)
        if isinstance(value, tuple) and isinstance(value[-1], str):
            value = written(value[0], value[1], known.unit)
        if isinstance(value, float):
            value = float(f"{value:.15g}")
        made[known.id] = Attribute(known.id, known.unit, value)
    return made


def surroundings(builder: Builder, case: Case, **attributes: Any) -> tuple[int, int, int]:
    """Gear unit with `attributes`, casing and lubricant of a case with computed losses."""
    temperature, lubricant = case.operation.oil_inlet_temperature, case.lubricant
    assert temperature is not None
    assert lubricant is not None
    unit = builder.add("gear_unit", case.title or "gear unit", **attributes)
    casing = builder.add("gear_casing", "casing", temperature_lubricant=(temperature, "K"))
    oil = _lubricant(builder, lubricant.oil)
    builder.part(unit, casing)
    builder.relate("reference", origin=casing, referenced=oil)
    return unit, casing, oil


def _lubricant(builder: Builder, oil: Oil) -> int:
    at_40, at_100, at_15, at_38 = (oil_state(oil, _CELSIUS + t) for t in (40, 100, 15, 38))
    kind = {}
    if oil.kind in _OIL_TYPES:
        kind["lubricant_type_iso_6336_2019"] = _OIL_TYPES[oil.kind]
    return builder.add(
        "lubricant",
        oil.title,
        name=oil.title,
        kind="oil",
        **kind,
        viscosity_at_40_degree_celsius=(at_40.kinematic_viscosity, "m^2/s"),
        viscosity_at_100_degree_celsius=(at_100.kinematic_viscosity, "m^2/s"),
        density_at_15_degree_celsius=(at_15.density, "kg/m^3"),
        pressure_viscosity_coefficient_at_38_degrees_celsius=(at_38.pressure_viscosity, "1/Pa"),
    )


def add_shaft(
    builder: Builder, unit: int, name: str, speed: float | None = None, **attributes: Any
) -> int:
    """A shaft of the gear unit."""
    turning = {} if speed is None else {"rotational_speed": (speed, "rad/s")}
    shaft = builder.add("shaft", name, **turning, **attributes)
    builder.part(unit, shaft)
    return shaft


def _gear(builder: Builder, shaft: int, table: GearTable, made: Gear, hand: int, name: str) -> int:
    """A gear on its shaft, with its flanks and material."""
    number = builder.add(
        "ring_gear" if made.internal else "cylindrical_gear",
        name,
        number_of_teeth=made.teeth,
        normal_module=(made.rack.normal_module, "m"),
        helix_angle_reference_diameter=(hand * made.rack.helix_angle + 0.0, "rad"),
        face_width=(made.face_width, "m"),
        tip_diameter=(2 * made.tip_radius, "m"),
        root_diameter=(2 * made.root_radius, "m"),
        reference_diameter_cylindrical_gear=(2 * made.reference_radius, "m"),
        base_diameter=(2 * made.base_radius, "m"),
        arithmetic_mean_roughness_flank_iso_4287_1997=(RA_OVER_RQ * table.roughness, "m"),
    )
    left, right = (
        builder.add(
            "cylindrical_gear_flank",
            f"{name}, {side}",
            normal_pressure_angle=(made.rack.normal_pressure_angle, "rad"),
            addendum_modification_coefficient=made.profile_shift_coefficient,
        )
        for side in ("left", "right")
    )
    builder.relate("flank", gear=number, left=left, right=right)
    builder.relate("reference", origin=number, referenced=_material(builder, table.material))
    builder.part(shaft, number)
    return number


def _material(builder: Builder, material: Material) -> int:
    return builder.add(
        "material",
        material.title,
        material_designation=material.title,
        elastic_modulus=(material.elastic_modulus, "Pa"),
        poisson_ratio=material.poisson_ratio,
        density=(material.density, "kg/m^3"),
    )


def _stage(
    builder: Builder,
    owner: int,
    oil: int,
    gears: Sequence[int],
    center: float,
    name: str = "mesh",
) -> int:
    stage = builder.add("cylindrical_stage", name, center_distance=(center, "m"))
    builder.part(owner, stage)
    builder.relate("stage", stage=stage, gear_1=gears[0], gear_2=gears[1])
    builder.relate("reference", origin=stage, referenced=oil)
    return stage


def add_load(builder: Builder, shaft: int, torque: float) -> None:
    """A torque from outside."""
    load = builder.add(
        "external_load", "load", torque_around_u_axis=(torque, "N*m"), defines_torque=True
    )
    builder.part(shaft, load)


def _pair(builder: Builder, case: GearPairCase) -> None:
    unit, _, oil = surroundings(builder, case)
    shafts = {
        "pinion": add_shaft(builder, unit, "pinion shaft", case.operation.speed),
        "gear": add_shaft(builder, unit, "gear shaft"),
    }
    add_pair(builder, case, (unit, oil), shafts, "mesh")
    add_load(builder, shafts["pinion"], case.operation.torque)


def add_pair(
    builder: Builder,
    case: GearPairCase | PairSet,
    owners: tuple[int, int],
    shafts: Mapping[str, int],
    name: str,
) -> dict[str, int]:
    """Both gears on their shafts, and their stage; `owners` are unit and oil. Returns the gears."""
    unit, oil = owners
    hand = -1 if isinstance(case, PairSet) and case.hand == "left" else 1
    made = {"pinion": gear("pinion", case.pinion, case.gears)}
    made["gear"] = gear("gear", case.gear, case.gears)
    hands = {"pinion": hand, "gear": hand if made["gear"].internal else -hand}
    tables = {"pinion": case.pinion, "gear": case.gear}
    numbers = {
        member: _gear(builder, shafts[member], tables[member], one, hands[member], member)
        for member, one in made.items()
    }
    center = case.gears.distance
    _stage(builder, unit, oil, list(numbers.values()), center, name)
    return numbers


def _planetary(builder: Builder, case: PlanetaryCase) -> None:
    unit, casing, oil = surroundings(builder, case)
    operation = case.operation
    speeds = {operation.input: operation.speed}
    if operation.second_input is not None and operation.second_speed is not None:
        speeds[operation.second_input] = operation.second_speed
    title = case.title or "planetary stage"
    stage = builder.add("planetary_stage", title)
    builder.part(unit, stage)
    shafts = {
        name: add_shaft(builder, unit, f"{name} shaft", speeds.get(name))
        for name in ("sun", "ring", "carrier")
    }
    if operation.fixed is not None:
        hold(builder, shafts[operation.fixed], casing, operation.fixed)
    add_load(builder, shafts[operation.input], operation.torque)
    add_planetary(builder, case, (unit, stage, oil), shafts)


def hold(builder: Builder, shaft: int, casing: int, name: str) -> None:
    """A shaft that stands still."""
    joint = builder.add("coupling", f"holds the {name}")
    builder.relate("side", assembly=joint, inner_part=shaft, outer_part=casing)


def add_planetary(
    builder: Builder,
    case: PlanetaryCase | PlanetarySet,
    owners: tuple[int, int, int],
    shafts: Mapping[str, int],
) -> None:
    """The gears of a planetary set on their shafts; `owners` are unit, stage and oil."""
    _, stage, _ = owners
    for name in ("sun", "ring"):
        builder.relate("central_shaft", planetary_stage=stage, shaft=shafts[name])
    builder.relate("planet_carrier_shaft", planetary_stage=stage, shaft=shafts["carrier"])
    _carrier(builder, case, stage, shafts["carrier"])
    _planets(builder, case, owners, shafts)


def _carrier(builder: Builder, case: PlanetaryCase | PlanetarySet, stage: int, shaft: int) -> None:
    carrier = builder.add("planet_carrier", "carrier")
    builder.part(stage, carrier)
    builder.part(carrier, shaft)
    if case.carrier is not None:
        size = case.carrier
        plate = builder.add(
            "side_plate",
            "carrier as a disc",
            outer_diameter=(size.outer_diameter, "m"),
            length=(size.width, "m"),
        )
        builder.part(carrier, plate)


def _planets(
    builder: Builder,
    case: PlanetaryCase | PlanetarySet,
    owners: tuple[int, int, int],
    shafts: Mapping[str, int],
) -> None:
    """Sun, ring, and for each planet its shaft, pin, bearing and two meshes."""
    unit, stage, oil = owners
    tables = {"sun": case.sun, "planet": case.planet, "ring": case.ring}
    made = {name: gear(name, table, case.gears) for name, table in tables.items()}
    hand = -1 if isinstance(case, PlanetarySet) and case.hand == "left" else 1
    sun = _gear(builder, shafts["sun"], case.sun, made["sun"], hand, "sun")
    ring = _gear(builder, shafts["ring"], case.ring, made["ring"], -hand, "ring")
    center = case.gears.distance
    for number in range(1, case.planet.count + 1):
        name = f"planet {number}"
        shaft, pin = (add_shaft(builder, unit, f"{name}, {part}") for part in ("shaft", "pin"))
        builder.relate("planet_shaft", planetary_stage=stage, shaft=shaft)
        builder.relate("planet_pin", planetary_stage=stage, shaft=pin)
        planet = _gear(builder, shaft, case.planet, made["planet"], -hand, name)
        if case.planet_bearing is not None:
            _bearing(builder, case.planet_bearing, pin, shaft, name)
        for gears in ((sun, planet), (planet, ring)):
            _stage(builder, stage, oil, gears, center)


def _bearing(builder: Builder, bearing: PlanetBearing, pin: int, shaft: int, name: str) -> None:
    number = builder.add(
        "rolling_bearing_with_detailed_geometry",
        f"bearing of {name}",
        bearing_type="radial_roller_bearing",
        number_of_bearing_rows=bearing.rows,
        radial_bearing_clearance=(bearing.diametral_clearance, "m"),
    )
    builder.relate("side", assembly=number, inner_part=pin, outer_part=shaft)
    pitch = bearing.pin_diameter + bearing.roller_diameter
    for order in range(1, bearing.rows + 1):
        row = builder.add(
            "rolling_bearing_row",
            f"row {order}",
            number_of_rolling_elements=bearing.rollers_per_row,
            reference_diameter_rolling_bearing=(pitch, "m"),
            significant_contact_length_inner_ring=(bearing.roller_length, "m"),
        )
        builder.relate("ordered_assembly", order, assembly=number, part=row)
        roller = builder.add(
            "rolling_element",
            "roller",
            diameter_of_rolling_element=(bearing.roller_diameter, "m"),
            length_of_rolling_element=(bearing.roller_length, "m"),
        )
        builder.relate("ordered_assembly", 1, assembly=row, part=roller)
