"""What a model of rotor dynamics takes of a case: inertias, mesh stiffness, transmission error."""

from __future__ import annotations

import csv
import io
import json
import math
from typing import Any

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.case.case import Case
from epicyclic.contact.elastic_teeth import LoadedMesh
from epicyclic.errors import one_problem
from epicyclic.machine.gear_mesh import MeshDuty, elastic_loads
from epicyclic.plugins.design.mass import as_list, parts
from epicyclic.study.solve import build_computed

HARMONICS = 10  # Of the mesh frequency, at most.
POSITIONS = 4  # Mesh positions over one wave of the highest harmonic, at least.
ENDINGS = (".json", ".csv")


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
    gears = mesh.gear1, mesh.gear2
    return {
        "gears": [gear.name for gear in gears],
        "teeth": [gear.teeth for gear in gears],
        "base_radius_m": [gear.base_radius for gear in gears],
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
