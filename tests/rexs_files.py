"""Small REXS files made to order: one planetary set, one pair, trains of both."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape, quoteattr

PLANETS = range(3)

SUN, RING, PLANET = 10, 11, 40
"""Ids of the sun, the ring and the first planet."""

STAGE, SUN_SHAFT, ROW, OIL, CASING = 4, 5, 80, 3, 2


class Parts:
    """Components and relations, to be changed by a test and written in either form."""

    def __init__(self, version: str) -> None:
        self.version = version
        self.components: dict[int, dict[str, Any]] = {}
        self.relations: list[tuple[str, dict[str, int], int | None]] = []
        self.load_cases: dict[int, dict[int, dict[str, tuple[Any, str]]]] = {}

    def add(self, number: int, kind: str, name: str = "", **attributes: tuple[Any, str]) -> None:
        self.components[number] = {"type": kind, "name": name, "attributes": attributes}

    def relate(self, kind: str, order: int | None = None, **roles: int) -> None:
        self.relations.append((kind, roles, order))

    def set(self, number: int, **attributes: Any) -> None:
        """Change attributes of a component; None takes one away."""
        own = self.components[number]["attributes"]
        for name, value in attributes.items():
            own.pop(name, None)
            if value is not None:
                own[name] = value

    def rename(self, old: str, new: str) -> None:
        """Another id for an attribute, wherever it stands."""
        for component in self.components.values():
            own = component["attributes"]
            if old in own:
                own[new] = own.pop(old)

    def xml(self) -> str:
        lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<!-- made by hand -->"]
        lines.append(
            f'<model version="{self.version}" applicationId="test" applicationVersion="1" '
            'date="2026-01-01T00:00:00Z" note="kept">'
        )
        lines.append("  <relations>")
        for number, (kind, roles, order) in enumerate(self.relations, start=1):
            ordered = "" if order is None else f' order="{order}"'
            lines.append(f'    <relation id="{number}" type="{kind}"{ordered}>')
            lines += [f'      <ref id="{ref}" role="{role}"/>' for role, ref in roles.items()]
            lines.append("    </relation>")
        lines += ["  </relations>", "  <components>"]
        for number, part in self.components.items():
            lines += _component_xml(number, part)
        lines.append("  </components>")
        if self.load_cases:
            lines.append('  <load_spectrum id="1">')
            for number, changed in self.load_cases.items():
                lines.append(f'    <load_case id="{number}">')
                for component, attributes in changed.items():
                    part = {**self.components[component], "attributes": attributes}
                    lines += _component_xml(component, part)
                lines.append("    </load_case>")
            lines.append("  </load_spectrum>")
        return "\n".join([*lines, "</model>", ""])

    def json(self) -> str:
        components = [
            {
                "id": number,
                "type": part["type"],
                "name": part["name"],
                "attributes": [
                    {"id": name, "unit": unit, _kind(value): value}
                    for name, (value, unit) in part["attributes"].items()
                ],
            }
            for number, part in self.components.items()
        ]
        relations = [
            {
                "id": number,
                "type": kind,
                "refs": [{"id": ref, "role": role} for role, ref in roles.items()],
                **({} if order is None else {"order": order}),
            }
            for number, (kind, roles, order) in enumerate(self.relations, start=1)
        ]
        head = {"version": self.version, "applicationId": "test", "note": {"kept": [1.5, None]}}
        return json.dumps({"model": {**head, "relations": relations, "components": components}})

    def write(self, path: Path) -> Path:
        """Write the file in the form its name stands for."""
        text = self.json() if path.suffix == ".rexsj" else self.xml()
        path.write_text(text, encoding="utf-8")
        return path


def _kind(value: Any) -> str:
    if isinstance(value, list):
        return f"{_kind(value[0]) if value else 'string'}_array"
    kinds = {bool: "boolean", int: "integer", float: "floating_point"}
    return kinds.get(type(value), "string")


def _component_xml(number: int, part: dict[str, Any]) -> list[str]:
    lines = [f'    <component id="{number}" type="{part["type"]}" name={quoteattr(part["name"])}>']
    for name, (value, unit) in part["attributes"].items():
        text = escape(str(value).lower() if isinstance(value, bool) else str(value))
        if isinstance(value, list):
            text = f"<array>{''.join(f'<c>{entry}</c>' for entry in value)}</array>"
        lines.append(f'      <attribute id="{name}" unit="{unit}">{text}</attribute>')
    return [*lines, "    </component>"]


def mm(value: float) -> tuple[float, str]:
    return (value, "mm")


def none(value: Any) -> tuple[Any, str]:
    return (value, "none")


def surroundings(parts: Parts) -> None:
    parts.add(1, "gear_unit", "unit")
    parts.add(CASING, "gear_casing", "casing", temperature_lubricant=(80.0, "C"))
    parts.add(
        OIL, "lubricant", "oil",
        lubricant_type_iso_6336_2019=none("mineral_oil"),
        viscosity_at_40_degree_celsius=(100.0, "mm^2 / s"),
        viscosity_at_100_degree_celsius=(11.0, "mm^2 / s"),
        density_at_15_degree_celsius=(0.88, "kg / dm^3"),
        pressure_viscosity_coefficient_at_38_degrees_celsius=(0.022, "mm^2 / N"),
    )  # fmt: skip
    parts.relate("reference", origin=CASING, referenced=OIL)


def _gear(parts: Parts, number: int, name: str, kind: str, shaft: int, hand: int = 1,
          **sizes: Any) -> None:  # fmt: skip
    parts.add(
        number, kind, name,
        normal_module=mm(2.0), face_width=mm(20.0),
        helix_angle_reference_diameter=(hand * 12.0, "deg"),
        arithmetic_mean_roughness_flank_iso_4287_1997=(0.4, "mum"),
        **sizes,
    )  # fmt: skip
    for side, flank in (("left", 100 + number), ("right", 200 + number)):
        parts.add(
            flank, "cylindrical_gear_flank", f"{name} {side}",
            normal_pressure_angle=(20.0, "deg"), addendum_modification_coefficient=none(0.0),
        )  # fmt: skip
    parts.relate("flank", gear=number, left=100 + number, right=200 + number)
    parts.relate("assembly", assembly=shaft, part=number)


def planetary(version: str = "2.0.0") -> Parts:
    """24, 18 and 60 teeth, three planets, ring held, sun driven with 100 N m at 1500 rpm."""
    parts = Parts(version)
    surroundings(parts)
    parts.add(STAGE, "planetary_stage", "stage A")
    parts.add(SUN_SHAFT, "shaft", "sun shaft", rotational_speed=(1500.0, "1 / min"))
    parts.add(6, "shaft", "ring shaft")
    parts.add(7, "shaft", "carrier shaft")
    parts.add(8, "external_load", "load", torque_around_u_axis=(100.0, "N m"))
    parts.add(9, "coupling", "to casing")
    parts.relate("assembly", assembly=SUN_SHAFT, part=8)
    parts.relate("side", assembly=9, inner_part=6, outer_part=CASING)
    for shaft in (SUN_SHAFT, 6):
        parts.relate("central_shaft", planetary_stage=STAGE, shaft=shaft)
    parts.relate("planet_carrier_shaft", planetary_stage=STAGE, shaft=7)
    _gear(parts, SUN, "sun", "cylindrical_gear", SUN_SHAFT,
          number_of_teeth=none(24), tip_diameter=mm(53.07), root_diameter=mm(44.07))  # fmt: skip
    _gear(parts, RING, "ring", "ring_gear", 6, -1,
          number_of_teeth=none(60), tip_diameter=mm(119.6), root_diameter=mm(127.68))  # fmt: skip
    for number in PLANETS:
        shaft, pin, gear = 20 + number, 30 + number, PLANET + number
        parts.add(shaft, "shaft", f"planet shaft {number}")
        parts.add(pin, "shaft", f"pin {number}")
        parts.relate("planet_shaft", planetary_stage=STAGE, shaft=shaft)
        parts.relate("planet_pin", planetary_stage=STAGE, shaft=pin)
        _gear(parts, gear, f"planet {number}", "cylindrical_gear", shaft, -1,
              number_of_teeth=none(18), tip_diameter=mm(40.8), root_diameter=mm(31.8))  # fmt: skip
        for stage, first, second in ((50 + number, SUN, gear), (60 + number, gear, RING)):
            parts.add(stage, "cylindrical_stage", f"mesh {stage}", center_distance=mm(42.94))
            parts.relate("assembly", assembly=STAGE, part=stage)
            parts.relate("stage", stage=stage, gear_1=first, gear_2=second)
        _bearing(parts, number, pin, shaft)
    return parts


def _bearing(parts: Parts, number: int, pin: int, shaft: int) -> None:
    bearing, row, roller = 70 + number, ROW + number, 90 + number
    parts.add(
        bearing, "rolling_bearing_with_detailed_geometry", f"bearing {number}",
        operating_radial_bearing_clearance=(10.0, "mum"),
    )  # fmt: skip
    parts.add(
        row, "rolling_bearing_row", f"row {number}",
        number_of_rolling_elements=none(14), reference_diameter_rolling_bearing=mm(17.0),
    )  # fmt: skip
    parts.add(
        roller, "rolling_element", f"roller {number}",
        diameter_of_rolling_element=mm(3.0), length_of_rolling_element=mm(15.0),
    )  # fmt: skip
    parts.relate("side", assembly=bearing, inner_part=pin, outer_part=shaft)
    parts.relate("ordered_assembly", 1, assembly=bearing, part=row)
    parts.relate("ordered_assembly", 1, assembly=row, part=roller)


def pair(version: str = "2.0.0") -> Parts:
    """24 and 36 teeth, pinion driven with 50 N m at 3000 rpm."""
    parts = Parts(version)
    surroundings(parts)
    parts.add(STAGE, "cylindrical_stage", "stage B", center_distance=mm(61.4))
    parts.add(SUN_SHAFT, "shaft", "pinion shaft", rotational_speed=(3000.0, "1 / min"))
    parts.add(6, "shaft", "gear shaft")
    parts.add(8, "external_load", "load", torque_around_u_axis=(50.0, "N m"))
    parts.relate("assembly", assembly=SUN_SHAFT, part=8)
    _gear(parts, RING, "gear", "cylindrical_gear", 6, -1, number_of_teeth=none(36))
    _gear(parts, SUN, "pinion", "cylindrical_gear", SUN_SHAFT, number_of_teeth=none(24))
    parts.relate("stage", stage=STAGE, gear_1=RING, gear_2=SUN)
    return parts


# --- trains ---------------------------------------------------------------------------------------

FIRST, SECOND, THIRD = 1000, 2000, 3000
"""Ids of the first, second and third stage; those of their gears follow."""

UNIT, LOAD, DRIVEN = 1, 60, 61


def shaft(parts: Parts, number: int, name: str, along: float = 0.0, up: float = 0.0) -> int:
    """A shaft of the gear unit that starts at `along` and lies `up` from its middle."""
    parts.add(number, "shaft", name, support_vector=([along, up, 0.0], "mm"),
              u_axis_vector=([1.0, 0.0, 0.0], "mm"))  # fmt: skip
    parts.relate("assembly", assembly=UNIT, part=number)
    return number


def _set_place(parts: Parts, number: int, along: float, up: float) -> None:
    parts.set(number, support_vector=([along, up, 0.0], "mm"), u_axis_vector=([1.0, 0, 0], "mm"))


def add_pair(parts: Parts, stage: int, name: str, shafts: tuple[int, int], along: float,
             up: tuple[float, float] = (0.0, 61.4), hand: int = 1) -> None:  # fmt: skip
    """24 and 36 teeth on two shafts; the gears are `stage` + 1 and + 2."""
    parts.add(stage, "cylindrical_stage", name, center_distance=mm(61.4))
    for member, teeth in enumerate((24, 36)):
        number = stage + 1 + member
        _gear(parts, number, f"{name} {teeth}", "cylindrical_gear", shafts[member],
              -hand if member else hand, number_of_teeth=none(teeth))  # fmt: skip
        _set_place(parts, number, along, up[member])
    parts.relate("stage", stage=stage, gear_1=stage + 1, gear_2=stage + 2)


def add_planetary(parts: Parts, stage: int, name: str, shafts: dict[str, int]) -> None:
    """24, 18 and 60 teeth, three planets without bearings; sun `stage` + 1, ring + 2."""
    parts.add(stage, "planetary_stage", name)
    for member in ("sun", "ring"):
        parts.relate("central_shaft", planetary_stage=stage, shaft=shafts[member])
    parts.relate("planet_carrier_shaft", planetary_stage=stage, shaft=shafts["carrier"])
    sun, ring = stage + 1, stage + 2
    _gear(parts, sun, f"{name} sun", "cylindrical_gear", shafts["sun"],
          number_of_teeth=none(24), tip_diameter=mm(53.07), root_diameter=mm(44.07))  # fmt: skip
    _gear(parts, ring, f"{name} ring", "ring_gear", shafts["ring"], -1,
          number_of_teeth=none(60), tip_diameter=mm(119.6), root_diameter=mm(127.68))  # fmt: skip
    for number in PLANETS:
        planet_shaft, planet = stage + 10 + number, stage + 20 + number
        parts.add(planet_shaft, "shaft", f"{name} planet shaft {number}")
        parts.relate("planet_shaft", planetary_stage=stage, shaft=planet_shaft)
        _gear(parts, planet, f"{name} planet {number}", "cylindrical_gear", planet_shaft, -1,
              number_of_teeth=none(18), tip_diameter=mm(40.8), root_diameter=mm(31.8))  # fmt: skip
        meshes = ((stage + 30 + number, sun, planet), (stage + 40 + number, planet, ring))
        for mesh, first, second in meshes:
            parts.add(mesh, "cylindrical_stage", f"{name} mesh", center_distance=mm(42.94))
            parts.relate("stage", stage=mesh, gear_1=first, gear_2=second)


def hold(parts: Parts, joint: int, held: int, **attributes: Any) -> None:
    """A shaft that a coupling, or a brake with its positions, joins to the casing."""
    kind = "switchable_coupling" if attributes else "coupling"
    parts.add(joint, kind, f"joint {joint}", **attributes)
    parts.relate("side", assembly=joint, inner_part=held, outer_part=CASING)


def run(parts: Parts, driven: int, output: int, torque: float, speed: float) -> None:
    """Torque and speed on a shaft, a load without a torque on another."""
    parts.add(LOAD, "external_load", "drives", torque_around_u_axis=(torque, "N m"))
    parts.add(DRIVEN, "external_load", "driven")
    parts.relate("assembly", assembly=driven, part=LOAD)
    parts.relate("assembly", assembly=output, part=DRIVEN)
    parts.set(driven, rotational_speed=(speed, "1 / min"))


def bearing(parts: Parts, number: int, name: str, on: int, along: float, up: float = 0.0,
            kind: str = "radial_grooved_ball_bearing", support: str = "both_directions",
            outer: int = CASING) -> None:  # fmt: skip
    """A rolling bearing between a shaft and the casing."""
    parts.add(
        number, "rolling_bearing_with_catalog_geometry", name, bearing_type=none(kind),
        inner_diameter=mm(30.0), outer_diameter=mm(62.0), width=mm(16.0),
        radial_dynamic_load_rating=(20.0, "kN"), radial_static_load_rating=(11.0, "kN"),
        axial_force_absorption=none(support),
    )  # fmt: skip
    _set_place(parts, number, along, up)
    parts.relate("side", assembly=number, inner_part=on, outer_part=outer)


def eaxle(version: str = "2.0.0") -> Parts:
    """A pair and a planetary set, its ring held: motor, mid, wheels; bearings of the motor shaft.

    The gear of the pair and the sun stand on two shafts that a coupling joins.
    """
    parts = Parts(version)
    surroundings(parts)
    motor, mid, sun = (shaft(parts, 20, "motor"), shaft(parts, 21, "mid", 5.0, 61.4),
                       shaft(parts, 22, "sun shaft", 60.0, 61.4))  # fmt: skip
    ring, wheels = shaft(parts, 23, "ring", 80.0, 61.4), shaft(parts, 24, "wheels", 90.0, 61.4)
    add_pair(parts, FIRST, "pair", (motor, mid), 40.0)
    add_planetary(parts, SECOND, "set", {"sun": sun, "ring": ring, "carrier": wheels})
    parts.add(70, "coupling", "spline")
    parts.relate("side", assembly=70, inner_part=mid, outer_part=sun)
    hold(parts, 71, ring)
    run(parts, motor, wheels, 100.0, 3000.0)
    bearing(parts, 80, "left", motor, 10.0)
    bearing(parts, 81, "right", motor, 75.0, kind="radial_roller_bearing", support="no_direction")
    return parts


def two_planetary(version: str = "2.0.0") -> Parts:
    """Two planetary sets one after the other, both rings held: carrier 1 drives sun 2."""
    parts = Parts(version)
    surroundings(parts)
    names = ("in", "between", "out", "ring 1", "ring 2")
    first, between, out, *rings = (shaft(parts, 20 + i, name) for i, name in enumerate(names))
    add_planetary(parts, FIRST, "stage", {"sun": first, "ring": rings[0], "carrier": between})
    add_planetary(parts, SECOND, "stage", {"sun": between, "ring": rings[1], "carrier": out})
    hold(parts, 70, rings[0])
    hold(parts, 71, rings[1])
    run(parts, first, out, 20.0, 3000.0)
    return parts


def wind(version: str = "2.0.0") -> Parts:
    """Two planetary sets driven at the carrier and a pair, speeding up."""
    parts = Parts(version)
    surroundings(parts)
    names = ("rotor", "slow", "wheel", "generator", "ring 1", "ring 2")
    rotor, slow, wheel, generator, *rings = (
        shaft(parts, 20 + i, name) for i, name in enumerate(names)
    )
    add_planetary(parts, FIRST, "low", {"sun": slow, "ring": rings[0], "carrier": rotor})
    add_planetary(parts, SECOND, "middle", {"sun": wheel, "ring": rings[1], "carrier": slow})
    add_pair(parts, THIRD, "high", (generator, wheel), 300.0)
    hold(parts, 70, rings[0])
    hold(parts, 71, rings[1])
    run(parts, rotor, generator, 500.0, 100.0)
    return parts
