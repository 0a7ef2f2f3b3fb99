"""Mass and inertia of the parts of a case, and stiffness and transmission error of its meshes."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.build.models import set_cases
from epicyclic.case.case import Case
from epicyclic.contact.elastic_teeth import LoadedMesh
from epicyclic.dataclass import dataclass
from epicyclic.errors import one_problem
from epicyclic.gears.gear import CARRIER, Gear
from epicyclic.gears.gearing import outside_radius
from epicyclic.gears.stated import StatedGear
from epicyclic.machine.element import joined_key
from epicyclic.machine.gear_mesh import MeshDuty, elastic_loads
from epicyclic.study.solve import build_computed


@dataclass(frozen=True, slots=True)
class Part:
    """One kind of part of a gearbox."""

    name: str
    count: int
    mass: float  # Of one. [kg]
    inertia: float  # Of one about its own axis. [kg m^2]
    circle: float = 0.0  # Radius of the circle on which its axis turns with the carrier. [m]

    @property
    def carried_inertia(self) -> float:
        """What all of them add to the inertia of the carrier as point masses. [kg m^2]"""
        return self.count * self.mass * self.circle**2


def hollow_disc(radius: float, bore: float, width: float, density: float) -> tuple[float, float]:
    """Mass [kg] and inertia [kg m^2] of a disc with a bore, both as radii. [m]

    Examples
    --------
    The pinion of the third stage of the NREL, 200.47 kg and 3.877 kg m^2 in print:

    >>> mass, inertia = hollow_disc(0.3501850 / 2, 0.17910 / 2, 0.360, 7830.0)
    >>> round(mass, 1), round(inertia, 2)
    (200.5, 3.88)
    """
    mass = math.pi * (radius**2 - bore**2) * width * density
    return mass, mass * (radius**2 + bore**2) / 2


def gear_body(gear: Gear, table: StatedGear, bore: float = 0.0) -> tuple[float, float]:
    """Mass and inertia of a gear, its teeth as a disc to half their depth; a ring with its rim."""
    middle = (gear.tip_radius + gear.root_radius) / 2
    radius, inner = middle, bore
    if gear.internal:
        radius, inner = outside_radius(gear, table), middle
    return hollow_disc(radius, inner, gear.face_width, table.material.density)


def parts(case: Case) -> tuple[Part, ...]:
    """Every gear and carrier of a case whose sizes it knows.

    Central external gears are solid to their axis, planets to the bore of their bearing; a carrier
    is a disc without the room of its planets. Shafts, pins, rollers and housing are left out.

    Examples
    --------
    >>> from epicyclic import load_case
    >>> [(part.name, part.count) for part in parts(load_case("talbot-2012"))]
    [('sun', 1), ('planet', 3), ('ring', 1), ('carrier', 1)]
    """
    return tuple(_parts(case))


def _parts(case: Case) -> Iterator[Part]:
    for name, own in set_cases(case).items():
        gearing, planets, room = own.gearing, own.gearing.count or 1, 0.0
        pins = gearing.pins if gearing.planets else {}
        for key, table in gearing.tables.items():
            body, gear = gearing.bodies[key], gearing.gear(key)
            turning = body in gearing.planets
            bearing = own.bearings.get(body)
            bore = 0.0
            if turning and bearing is not None:
                rollers = 2 * getattr(bearing, "roller_diameter", 0.0)
                bore = (bearing.pin_diameter + rollers + bearing.diametral_clearance) / 2
            mass, inertia = gear_body(gear, table, bore)
            if turning:
                room += planets * math.pi * gear.tip_radius**2 * gear.face_width
            circle = pins[body].radius if turning else 0.0
            yield Part(joined_key(name, key), planets if turning else 1, mass, inertia, circle)
        if (carrier := own.carrier) is not None:
            radius, width = carrier.outer_diameter / 2, carrier.width
            disc, inertia = hollow_disc(radius, 0.0, width, 7850.0)
            solid = max(0.2, 1 - room / (math.pi * radius**2 * width))
            yield Part(joined_key(name, CARRIER), 1, solid * disc, solid * inertia)


def as_list(found: tuple[Part, ...]) -> list[dict[str, str | float]]:
    """Parts as JSON holds them, with units in the keys."""
    return [
        {
            "name": part.name,
            "count": part.count,
            "mass_kg": part.mass,
            "inertia_kg_m2": part.inertia,
            "carrier_circle_m": part.circle,
        }
        for part in found
    ]


# What a model of rotor dynamics takes of a case.

HARMONICS = 10  # Of the mesh frequency, at most.
POSITIONS = 4  # Mesh positions over one wave of the highest harmonic, at least.


def rotor_dynamics(case: Case) -> dict[str, Any]:
    """Inertias of all parts, and stiffness and transmission error of all loaded meshes.

    Along the transverse line of action, of one mesh of the most loaded planet, at the operating
    point. A quantity of a mesh is ``mean + sum of amplitude[k - 1] * cos(k * x + phase[k - 1])``;
    x grows by a full turn over one tooth pitch, from where the first pair of teeth comes into
    contact.
    """
    if case.operation.torque == 0:
        allowed = "leaves the meshes without load, and so without stiffness."
        remedy = "Give a torque other than zero."
        raise one_problem("operation.torque", "0 N*m", allowed, remedy, case.source)
    built = build_computed(case)
    duties = built.loaded_duties(built.loaded_state())
    return {
        "title": case.title,
        "parts": {str(part.pop("name")): part for part in as_list(parts(case))},
        "meshes": {
            key: _mesh(duty, case.gearings[key.rpartition(".")[0]].count or 1)
            for key, duty in duties.items()
            if duty.torque1 != 0
        },
    }


def _mesh(duty: MeshDuty, count: int) -> dict[str, Any]:
    mesh, loaded = duty.gears.mesh, elastic_loads(duty)
    return {
        "gears": [gear.name for gear in mesh.gears],
        "teeth": [gear.teeth for gear in mesh.gears],
        "base_radius_m": [gear.base_radius for gear in mesh.gears],
        "pressure_angle_deg": math.degrees(mesh.operating_pressure_angle),
        "base_helix_angle_deg": math.degrees(mesh.gear1.rack.base_helix_angle),
        "internal": mesh.internal,
        "count": count,
        "frequency_Hz": abs(duty.speed1) * mesh.gear1.teeth / (2 * math.pi),
        "force_N": duty.force,
        **_waves("stiffness", "N_per_m", loaded, loaded.tangent_stiffness),
        **_waves("transmission_error", "m", loaded, loaded.transmission_error),
    }


def _waves(name: str, unit: str, loaded: LoadedMesh, values: FloatArray) -> dict[str, Any]:
    """Mean, amplitudes and phases over the mesh period, whose positions are not quite even."""
    lines = loaded.compliance.lines
    orders = np.arange(1, min(HARMONICS, len(lines.position) // POSITIONS) + 1)
    waves = np.exp(-2j * math.pi * np.outer(orders, lines.position))
    found = 2 * waves @ (lines.weight * values)
    return {
        f"{name}_mean_{unit}": loaded.mean(values),
        f"{name}_amplitude_{unit}": np.abs(found).tolist(),
        f"{name}_phase_deg": np.degrees(np.angle(found)).tolist(),
    }


def rotor_text(found: dict[str, Any], ending: str) -> str:
    """As JSON, or as a table with a row for each number."""
    if ending == ".json":
        return json.dumps(found, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    file = io.StringIO()
    table = csv.writer(file, lineterminator="\n")
    table.writerow(("item", "quantity", "number", "value"))
    for item, own in {**found["parts"], **found["meshes"]}.items():
        for quantity, values in own.items():
            several = isinstance(values, list)
            for number, value in enumerate(values if several else [values], start=1):
                table.writerow((item, quantity, number if several else "", value))
    return file.getvalue()
