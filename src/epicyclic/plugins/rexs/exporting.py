"""Results to REXS files: into a file that is there, or into a new one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from importlib.metadata import version
from itertools import pairwise
from pathlib import Path
from typing import Any

from epicyclic.build.machine import operation_of
from epicyclic.build.models import SetCase, set_cases
from epicyclic.case.case import Case, TrainCase, read_case
from epicyclic.case.tables.elements import Carrier, PlanetBearing, ShaftBearingTable
from epicyclic.errors import Problem, one_problem, problems_in, raise_any
from epicyclic.files import write_file
from epicyclic.gears.flanks import RA_OVER_RQ
from epicyclic.gears.gear import CARRIER, HOUSING
from epicyclic.gears.gearing import Gearing, GearPairing
from epicyclic.gears.stated import StatedMaterial
from epicyclic.machine.element import Figure
from epicyclic.machine.shaft_parts import ShaftBearingFigures
from epicyclic.messages import one_line
from epicyclic.oil.oil import Oil, oil_state
from epicyclic.plugins.rexs.draft import DIGITS
from epicyclic.plugins.rexs.files import Document, new_document, read_document
from epicyclic.plugins.rexs.gears import planet_bearings
from epicyclic.plugins.rexs.model import (
    CUSTOM,
    Attribute,
    Component,
    Model,
    Relation,
    build_model,
    id_in,
    rexs_unit,
    term,
    versions,
    written,
)
from epicyclic.plugins.rexs.sets import Mesh, SetParts, Train, choose, chosen_train
from epicyclic.plugins.rexs.train import BEARING_TYPES
from epicyclic.result.result import Result
from epicyclic.units import RPM, format_number

# A gear set as the parts of a new REXS file.
#
# Axes run along u. The helix of the sun, or of the pinion, is written right-handed unless the set
# of a train has another hand: the losses of a single set do not depend on it.


_CELSIUS = 273.15

_OIL_TYPES = {
    "mineral": "mineral_oil",
    "pao": "polyalfaolefin",
    "pag": "non_water_soluble_polyglycol",
}


class Builder:
    """Collects parts and numbers them."""

    def __init__(self) -> None:
        self.components: list[Component] = []
        self.relations: list[Relation] = []

    def add(self, kind: str, name: str, owner: int | None = None, /, **attributes: Any) -> int:
        """A component, of which `owner` is the assembly.

        Attributes are text, flags, numbers, or numbers with the unit they have; those that are
        None, with a unit or without, are left out.
        """
        number = len(self.components) + 1
        self.components.append(Component(number, kind, name, tuple(_made(attributes))))
        if owner is not None:
            self.part(owner, number)
        return number

    def extend(self, number: int, /, **attributes: Any) -> None:
        """Further attributes of a component."""
        own = self.components[number - 1]
        self.components[number - 1] = own.changed(_made(attributes))

    def relate(self, kind: str, order: int | None = None, **roles: int) -> None:
        """A relation of components by their roles."""
        number = len(self.relations) + 1
        self.relations.append(Relation(number, kind, tuple(roles.items()), order))

    def parts(self) -> list[Component | Relation]:
        """All that was added."""
        return [*self.components, *self.relations]

    def part(self, assembly: int, part: int) -> None:
        """A part of an assembly."""
        self.relate("assembly", assembly=assembly, part=part)


def _made(attributes: Mapping[str, Any]) -> Iterator[Attribute]:
    for key, value in attributes.items():
        known = term(key)
        if isinstance(value, tuple) and isinstance(value[-1], str):
            value = None if value[0] is None else written(value[0], value[1], known.unit)
        if isinstance(value, float):
            value = float(f"{value:.15g}")
        if value is not None:
            yield Attribute(known.id, known.unit, value)


def surroundings(builder: Builder, case: Case, **attributes: Any) -> tuple[int, int, int]:
    """Gear unit with `attributes`, casing and lubricant of a case with computed losses."""
    temperature, lubricant = case.operation.oil_inlet_temperature, case.lubricant
    assert temperature is not None
    assert lubricant is not None
    unit = builder.add("gear_unit", case.title or "gear unit", **attributes)
    casing = builder.add("gear_casing", "casing", unit, temperature_lubricant=(temperature, "K"))
    oil = _lubricant(builder, lubricant.oil)
    builder.relate("reference", origin=casing, referenced=oil)
    return unit, casing, oil


def _lubricant(builder: Builder, oil: Oil) -> int:
    at_40, at_100, at_15, at_38 = (oil_state(oil, _CELSIUS + t) for t in (40, 100, 15, 38))
    return builder.add(
        "lubricant",
        oil.title,
        name=oil.title,
        kind="oil",
        lubricant_type_iso_6336_2019=_OIL_TYPES.get(oil.kind),
        viscosity_at_40_degree_celsius=(at_40.kinematic_viscosity, "m^2/s"),
        viscosity_at_100_degree_celsius=(at_100.kinematic_viscosity, "m^2/s"),
        density_at_15_degree_celsius=(at_15.density, "kg/m^3"),
        pressure_viscosity_coefficient_at_38_degrees_celsius=(at_38.pressure_viscosity, "1/Pa"),
    )


def add_shaft(
    builder: Builder, unit: int, name: str, speed: float | None = None, **attributes: Any
) -> int:
    """A shaft of the gear unit."""
    return builder.add("shaft", name, unit, rotational_speed=(speed, "rad/s"), **attributes)


def _gear(builder: Builder, gearing: Gearing, gear: str, shaft: int, name: str) -> int:
    """A gear on its shaft, with its flanks and material."""
    table, made, hand = gearing.tables[gear], gearing.gear(gear), gearing.hands[gear]
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


def _material(builder: Builder, material: StatedMaterial) -> int:
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
    owners: tuple[int, int],
    gearing: Gearing,
    mesh: GearPairing,
    gears: Mapping[str, int],
    name: str = "mesh",
) -> None:
    """A mesh; `owners` are unit or planetary stage, and oil."""
    owner, oil = owners
    center = gearing.distances[mesh.key]
    stage = builder.add("cylindrical_stage", name, owner, center_distance=(center, "m"))
    builder.relate("stage", stage=stage, gear_1=gears[mesh.first], gear_2=gears[mesh.second])
    builder.relate("reference", origin=stage, referenced=oil)


def add_load(builder: Builder, shaft: int, torque: float) -> None:
    """A torque from outside."""
    builder.add(
        "external_load", "load", shaft, torque_around_u_axis=(torque, "N*m"), defines_torque=True
    )


def case_parts(case: Case) -> list[Component | Relation]:
    """Components and relations that describe a case of one gear set."""
    builder = Builder()
    unit, casing, oil = surroundings(builder, case)
    own = set_cases(case)[""]
    operation = operation_of(case)
    shafts = {}
    for name in own.gearing.members:
        speed = None if name in operation.held else operation.speeds.get(name)
        shafts[name] = add_shaft(builder, unit, f"{name} shaft", speed)
    for name in operation.held:
        hold(builder, shafts[name], casing, name)
    title = (case.title or "planetary stage") if own.gearing.planets else "mesh"
    add_set(builder, own, (unit, oil), shafts, title)
    add_load(builder, shafts[operation.input], operation.torque)
    return builder.parts()


def add_set(
    builder: Builder, case: SetCase, owners: tuple[int, int], shafts: Mapping[str, int], name: str
) -> dict[str, int]:
    """A set: its gears on their shafts and their stages; `owners` are unit and oil.

    Returns the gears that turn on shafts which others can join.
    """
    unit, oil = owners
    gearing = case.gearing
    owner = unit
    if gearing.planets:
        owner = _planetary_stage(builder, unit, case.carrier, shafts, name)
    central = {
        gear: _gear(builder, gearing, gear, shafts[body], gear)
        for gear, body in gearing.bodies.items()
        if body in shafts
    }
    if not gearing.planets:
        for mesh in gearing.meshes:
            _stage(builder, (owner, oil), gearing, mesh, central, name)
    for number in range(1, (gearing.count or 0) + 1):
        _planet(builder, case, (unit, owner, oil), central, number)
    return central


def _planetary_stage(
    builder: Builder, unit: int, size: Carrier | None, shafts: Mapping[str, int], name: str
) -> int:
    """A planetary stage with its central shafts and its carrier."""
    stage = builder.add("planetary_stage", name, unit)
    for member, shaft in shafts.items():
        if member != CARRIER:
            builder.relate("central_shaft", planetary_stage=stage, shaft=shaft)
    builder.relate("planet_carrier_shaft", planetary_stage=stage, shaft=shafts[CARRIER])
    carrier = builder.add("planet_carrier", "carrier", stage)
    builder.part(carrier, shafts[CARRIER])
    if size is not None:
        builder.add(
            "side_plate",
            "carrier as a disc",
            carrier,
            outer_diameter=(size.outer_diameter, "m"),
            length=(size.width, "m"),
        )
    return stage


def _planet(
    builder: Builder,
    case: SetCase,
    owners: tuple[int, int, int],
    central: Mapping[str, int],
    number: int,
) -> None:
    """A planet: its shaft, pin, bearing and meshes; `owners` are unit, stage and oil."""
    unit, stage, oil = owners
    (body,) = case.gearing.planets
    name = f"{body} {number}"
    shaft, pin = (add_shaft(builder, unit, f"{name}, {part}") for part in ("shaft", "pin"))
    builder.relate("planet_shaft", planetary_stage=stage, shaft=shaft)
    builder.relate("planet_pin", planetary_stage=stage, shaft=pin)
    gears = {**central, body: _gear(builder, case.gearing, body, shaft, name)}
    bearing = case.bearings[body]
    if isinstance(bearing, PlanetBearing):  # REXS has no plain pins
        _bearing(builder, bearing, pin, shaft, name)
    for mesh in case.gearing.meshes:
        _stage(builder, (stage, oil), case.gearing, mesh, gears)


def hold(builder: Builder, shaft: int, casing: int, name: str) -> None:
    """A shaft that stands still."""
    joint = builder.add("coupling", f"holds the {name}")
    builder.relate("side", assembly=joint, inner_part=shaft, outer_part=casing)


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


_TYPES = {kind: name for name, kind in BEARING_TYPES.items()}

Place = tuple[float, float]  # Where an axis lies across its direction. [m]


def train_parts(case: TrainCase) -> list[Component | Relation]:
    """Components and relations that describe a train of computed planetary sets and pairs.

    Raises `InputError` if another set is among them.
    """
    others = [name for name, it in case.gearings.items() if it.listed or not it.computed]
    allowed = "is neither a planetary set nor a pair with computed losses."
    remedy = "A new REXS file cannot describe it; write the results into the original file."
    raise_any(Problem(f"sets.{name}", "", allowed, remedy) for name in others)
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
    for name, gearing in case.gearings.items():
        first, *others = map(case.shape.bodies_of(name).__getitem__, gearing.members)
        if gearing.planets:
            steps += [(first, other, (0.0, 0.0)) for other in others]
            continue
        (mesh,) = gearing.meshes
        length, toward = gearing.distances[mesh.key] or 0.0, mesh.direction
        step = (length * math.cos(toward), length * math.sin(toward))
        steps += [(first, other, step) for other in others]
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
    for name, own in set_cases(case).items():
        joined = {member: shafts[f"{name}.{member}"] for member in own.gearing.members}
        for gear, number in add_set(builder, own, owners, joined, name).items():
            position = case.position_of(f"{name}.{gear}")
            shaft = case.shape.shaft_of(f"{name}.{gear}") or ""
            if position is not None and shaft in places and not own.gearing.planets:
                builder.extend(number, **_at(position, places[shaft]))


def _loads(builder: Builder, case: TrainCase, shafts: Mapping[str, int]) -> None:
    """Torque at the input, none at the output, and those of further shafts."""
    operation = case.operation
    add_load(builder, shafts[operation.input], operation.torque)
    builder.add("external_load", "driven", shafts[operation.output])
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
    builder: Builder, case: TrainCase, shafts: Mapping[str, int], places: Mapping[str, Place]
) -> None:
    for kind, name, table in case.elements:
        if kind != "bearings" or not isinstance(table, ShaftBearingTable):
            continue
        factor = table.axial_factor
        if factor is None and table.contact_angle is not None:
            factor = 0.4 / math.tan(table.contact_angle)
        place = places[case.shape.shaft_of(table.shaft) or ""]
        number = builder.add(
            "rolling_bearing_with_catalog_geometry",
            name,
            bearing_type=_TYPES.get(table.type),
            inner_diameter=(table.bore, "m"),
            outer_diameter=(table.outside_diameter, "m"),
            axial_force_absorption=_absorption(table),
            width=(table.width, "m"),
            radial_dynamic_load_rating=(table.dynamic_load_rating, "N"),
            radial_static_load_rating=(table.static_load_rating, "N"),
            axial_factor_y_2=factor,
            **({} if table.position is None else _at(table.position, place)),
        )
        ends = {"inner_part": shafts[table.shaft], "outer_part": shafts[table.against]}
        builder.relate("side", assembly=number, **ends)


def _absorption(table: ShaftBearingTable) -> str:
    if not table.locating:
        return "no_direction"
    return "both_directions" if table.axial_sense == "both" else table.axial_sense


# Results into a REXS file.
#
# Attributes of the standard are written where the file has no value of its own. Everything else
# goes under ids that begin with ``custom_epicyclic_``, which the standard leaves to programs; these
# are written anew each time.


def _mismatches(chosen: SetParts | Train, result: Result) -> Iterator[Problem]:
    """What tells that a result is not of the gears of a file: names of sets, numbers of teeth."""
    if not isinstance(chosen, Train):
        yield from _differences(chosen, result.inputs, "")
        return
    tables = result.inputs["sets"]
    for name in dict.fromkeys([*chosen.sets, *tables]):
        if name in chosen.sets and name in tables:
            yield from _differences(chosen.sets[name], tables[name], f"sets.{name}.")
            continue
        where = "the file" if name in tables else "the case"
        remedy = "Keep the names of the sets as they were imported."
        yield Problem(f"sets.{name}", "", f"is not in {where}.", remedy)


def _differences(chosen: SetParts, tables: Mapping[str, Any], place: str) -> Iterator[Problem]:
    """Numbers of teeth that are not those of the file."""
    for name, component in chosen.gears.items():
        stated = component.get("number_of_teeth")
        table = tables.get(name)
        here = table.get("teeth") if table else None
        there = None if stated is None else abs(stated.number())
        is_left_out = bool(table) and here is None  # planets of a set of given efficiency
        if here != there and not is_left_out:
            remedy = "Write the results of a gear set into its own file."
            yield Problem(f"{place}{name}.teeth", f"{here}", f"is {there} in {component}.", remedy)


def _of_set(
    model: Model, chosen: SetParts, result: Result
) -> Iterator[tuple[Component, Attribute]]:
    stage = chosen.component
    yield stage, Attribute(f"{CUSTOM}version", "none", version("epicyclic"))
    for figure in _known(result):
        yield stage, _custom(figure.key, figure.value, figure.unit)
    yield from _meshes(model, chosen, result, "")


def _of_train(model: Model, train: Train, result: Result) -> Iterator[tuple[Component, Attribute]]:
    """Figures of sets, shafts and bearings at their own components, all others at the unit."""
    yield train.unit, Attribute(f"{CUSTOM}version", "none", version("epicyclic"))
    owners = {name: one.component for name, one in train.sets.items()}
    owners |= {name: joint.component for name, joint in train.bearings.items()}
    of_shafts = {f"{name}_{what}" for name in result.flow.members for what in ("speed", "torque")}
    for figure in _known(result):
        name, dot, key = figure.key.partition(".")
        if dot and name in owners:
            yield owners[name], _custom(key, figure.value, figure.unit)
        elif not dot and figure.key not in of_shafts:
            yield train.unit, _custom(key or name, figure.value, figure.unit)
    for name, member in result.flow.members.items():
        for shaft in train.shafts[name].components if name in train.shafts else ():
            yield shaft, _custom("speed", RPM.to_display(member.speed), "rpm")
            yield shaft, _custom("torque", member.torque, "N*m")
    losses = result.stage_losses
    for name, one in train.sets.items():
        yield one.component, _custom("total", losses[name], "W")
        yield from _meshes(model, one, result, f"{name}.")
    for name, joint in train.bearings.items():
        figures = result.parts.get(f"{name}.bearing")
        if isinstance(figures, ShaftBearingFigures):
            yield from _bearing_result(
                model, joint.component, losses[name], figures.friction_torque
            )


def _known(result: Result) -> Iterator[Figure]:
    """The numbers of a result, without those of losses that are left out."""
    left_out = {term.name for term in result.terms if term.left_out}
    for figure in result.numbers():
        if figure.key not in left_out and not math.isnan(figure.value):
            yield figure


def _meshes(
    model: Model, chosen: SetParts, result: Result, place: str
) -> Iterator[tuple[Component, Attribute]]:
    """Results of the meshes and planet bearings of a set, whose figures begin with `place`."""
    for key, meshes in chosen.meshes_by_key.items():
        for mesh in meshes:
            yield from _mesh(model, mesh, result, f"{place}{key}", len(meshes))
    if not chosen.is_pair:
        yield from _bearing_results(model, chosen, result, f"{place}planet_bearing")


def _mesh(
    model: Model, mesh: Mesh, result: Result, name: str, count: int
) -> Iterator[tuple[Component, Attribute]]:
    """Results of one of `count` meshes: its loss, the mean of all, and its contact ratios."""
    terms = [watts for key, watts in result.losses.items() if key.startswith(f"{name}_")]
    yield mesh.stage, _custom("power_loss", sum(terms) / count, "W")
    figures = result.meshes.get(name)
    if figures is None or result.fluid is None:  # of a set whose efficiency is given
        return
    for attribute, value in (
        ("radial_contact_ratio", figures.transverse_contact_ratio),
        ("overlap_contact_ratio", figures.overlap_ratio),
        ("operating_viscosity", result.fluid.kinematic_viscosity * 1e6),
    ):
        yield from _standard(model, mesh.stage, attribute, value)


def _bearing_results(
    model: Model, chosen: SetParts, result: Result, name: str
) -> Iterator[tuple[Component, Attribute]]:
    """Results of each planet bearing: an equal part of the loss of all, and its torque."""
    bearings, figures = planet_bearings(model, chosen), result.bearings.get(name)
    terms = [term for term in result.terms if term.name.startswith(f"{name}_")]
    if not bearings or figures is None or all(item.left_out for item in terms):
        return
    loss = sum(item.watts for item in terms) / len(bearings)
    for bearing in bearings:
        torque = loss / figures.speed if figures.speed > 0 else math.nan
        yield from _bearing_result(model, bearing, loss, torque)


def _bearing_result(
    model: Model, bearing: Component, loss: float, torque: float
) -> Iterator[tuple[Component, Attribute]]:
    """Loss and friction torque of a bearing."""
    yield bearing, _custom("power_loss", loss, "W")
    if bearing.type.startswith("rolling_bearing"):
        yield from _standard(model, bearing, "total_frictional_power_loss", loss)
        yield from _standard(model, bearing, "total_frictional_torque", torque)


def _standard(
    model: Model, component: Component, name: str, value: float
) -> Iterator[tuple[Component, Attribute]]:
    """An attribute of the standard, in its unit, if the file has none and its version knows it."""
    known = id_in(name, model.version)
    if known is not None and component.get(name) is None and not math.isnan(value):
        yield component, Attribute(known, term(name).unit, _rounded(value))


def _custom(key: str, value: float, unit: str) -> Attribute:
    """An attribute of this package, in a unit of REXS."""
    name = rexs_unit(unit)
    number = value if unit == "1" else written(value, unit, name)
    return Attribute(f"{CUSTOM}{key}", name, _rounded(number))


def _rounded(value: float) -> float:
    """A computed number with the digits that it may have."""
    return float(format_number(value, DIGITS)) + 0.0


def write_rexs(
    path: str | Path,
    result: Result,
    original: str | Path | None = None,
    component: int | None = None,
) -> None:
    """Write results to a REXS file, completely or not at all.

    Parameters
    ----------
    path : str or Path
        The file to write, ``.rexs``, ``.rexsj`` or ``.rexsz``. With an `original` it has the form
        of that file.
    result : Result
        From `solve`.
    original : str or Path, optional
        The file that the gear set or train came from. Everything in it is kept, and results are
        added. Without it, a new file of version 2.0.0 describes the gears of the result.
    component : int, optional
        Id of the stage in the original, if it has several.

    Raises
    ------
    InputError
        If the original cannot be read, or holds another gear set.
    """
    write_file(Path(path), rexs_bytes(path, result, original, component))


def rexs_bytes(
    path: str | Path, result: Result, original: str | Path | None, component: int | None
) -> bytes:
    """What `write_rexs` writes."""
    if original is None:
        document = _described(path, result)
    else:
        document = read_document(Path(original), with_others=True)
    with problems_in(one_line(str(original), 500)):
        model = build_model(document.content)
        chosen = _chosen(model, result, component)
        raise_any(_mismatches(chosen, result))
    if isinstance(chosen, Train):
        figures = _of_train(model, chosen, result)
    else:
        figures = _of_set(model, chosen, result)
    for owner, attribute in figures:
        document.content.set_attribute(owner.id, attribute)
    return document.to_bytes()


def _chosen(model: Model, result: Result, component: int | None) -> SetParts | Train:
    """What a result belongs to in a file."""
    if result.train is None:
        return choose(model, component)
    train = chosen_train(model) if component is None else None
    if train is None:
        allowed = "the result is of a train, and the file has one stage."
        if component is not None:
            allowed = "names one stage, and the result is of a train."
        shown = "" if component is None else str(component)
        remedy = "Write it into the file of all its stages."
        raise one_problem("--component", shown, allowed, remedy)
    return train


def _described(path: str | Path, result: Result) -> Document:
    """A new file with the gear set of a result."""
    head = {
        "version": versions()[-1],
        "applicationId": "Epicyclic",
        "applicationVersion": version("epicyclic"),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }
    document = new_document(path, head)
    case = read_case(result.inputs)
    for part in train_parts(case) if isinstance(case, TrainCase) else case_parts(case):
        document.content.add(part)
    return document
