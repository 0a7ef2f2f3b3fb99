"""Micro-geometry over ranges: loss against transmission error, pressure and flash, with a band."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from epicyclic.arrays import FloatArray
from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass, field
from epicyclic.errors import Problem, one_problem, raise_any
from epicyclic.machine.element import joined_key
from epicyclic.machine.gear_mesh import MeshFigures
from epicyclic.plugins.design.search import dominated
from epicyclic.study.sweeps.run import PointList
from epicyclic.study.sweeps.runner import Rows, Runner

OBJECTIVES: Mapping[str, str] = {
    "loss": "total",
    "transmission_error": "transmission_error_range",
    "pressure": "hertz_pressure_max",
    "flash": "flash_temperature_max",
}
"""What is to be small: the loss, and figures of the mesh."""
DISPLAY = {"loss": "W", "transmission_error": "um", "pressure": "GPa", "flash": "K"}
TOLERATED = ("tip_relief", "root_relief", "profile_crown", "lead_crown", "lead_slope",
             "profile_slope", "end_relief")  # fmt: skip
assert set(OBJECTIVES.values()) - {"total"} <= set(MeshFigures.__dataclass_fields__)


@dataclass(frozen=True, slots=True)
class Relief:
    """What is varied, and over which loads."""

    case: Case
    mesh: str  # Whose figures count, ``"sun_mesh"``.
    vary: Mapping[str, Sequence[str]]  # Keys of micro-geometry to values.
    loads: Sequence[Mapping[str, str]] = field(default_factory=lambda: [{}])  # Operating points.
    tolerance: float = 0.0  # Of every amount that is varied, 95 %, either way. [m]
    objectives: Sequence[str] = ("loss", "transmission_error")


def mesh_keys(case: Case) -> list[str]:
    """Names of all meshes, the first one first."""
    sets = case.gearings.items()
    return [joined_key(name, mesh.key) for name, own in sets for mesh in own.meshes]


def _problems(relief: Relief) -> Iterator[Problem]:
    """Keys that are none of micro-geometry or misalignment, a mesh that is not there."""
    for key in relief.vary:
        if "micro_geometry" not in key and not key.endswith("misalignment"):
            allowed = "is no key of micro-geometry."
            remedy = 'For example "sun.micro_geometry.tip_relief=5:45:5 um".'
            yield Problem("--vary", key, allowed, remedy)
    keys = mesh_keys(relief.case)
    if relief.mesh not in keys:
        allowed = f"must be one of {', '.join(keys)}."
        yield Problem("--mesh", relief.mesh, allowed, f"Give --mesh {keys[0]}.")
    for name in relief.objectives:
        if name not in OBJECTIVES:
            allowed = f"must be one of {', '.join(OBJECTIVES)}."
            yield Problem("--objective", name, allowed, "Give --objective loss.")


def relief_front(relief: Relief, runner: Runner | None = None) -> xr.Dataset:
    """Every combination with its objectives, their band, and which are not dominated.

    Loss is the mean over the loads; the figures of the mesh are the largest of all loads. The band
    comes from every amount that is varied being off by the tolerance, one at a time, and is the
    root of the sum of squares.

    Returns xarray.Dataset: over ``variant``, the varied keys, the objectives with ``_low`` and
    ``_high`` where a tolerance is given, ``front``, ``status``.

    Raises `InputError` for keys that are none of micro-geometry, or if no variant is solved.
    """
    raise_any(_problems(relief), "the command")
    variants = [dict(zip(relief.vary, it, strict=True)) for it in product(*relief.vary.values())]
    points, owners = _points(relief, variants)
    rows = (runner or Runner()).run(PointList(relief.case, points=tuple(points)))
    values = _values(relief, rows)  # points by objectives
    nominal = np.full((len(variants), len(relief.objectives)), np.nan)
    spread = np.zeros_like(nominal)
    for variant in range(len(variants)):
        own = [place for place, (one, shift) in enumerate(owners) if one == variant and shift < 0]
        nominal[variant] = _over_loads(relief, values[own])
        for shift in range(len(_amounts(relief))):
            off = [place for place, it in enumerate(owners) if it == (variant, shift)]
            if off:
                spread[variant] += (_over_loads(relief, values[off]) - nominal[variant]) ** 2
    solved = np.isfinite(nominal).all(axis=1)
    if not solved.any():
        first = next(iter(rows.failures), "nothing was solved")
        raise one_problem("--vary", "", f"leads to no result: {first}", "Narrow it.")
    front = np.zeros(len(variants), dtype=bool)
    front[solved] = ~dominated(nominal[solved], nominal[solved])
    data: dict[str, Any] = {
        key: ("variant", [variant[key] for variant in variants]) for key in relief.vary
    }
    for place, name in enumerate(relief.objectives):
        about = {"units": DISPLAY[name]}
        data[name] = ("variant", nominal[:, place], about)
        if relief.tolerance:
            half = np.sqrt(spread[:, place])
            data[f"{name}_low"] = ("variant", nominal[:, place] - half, about)
            data[f"{name}_high"] = ("variant", nominal[:, place] + half, about)
    data["front"] = ("variant", front)
    data["status"] = ("variant", np.where(solved, "converged", "failed"))
    attributes = {
        "title": relief.case.title,
        "mesh": relief.mesh,
        "tolerance_um": relief.tolerance * 1e6,
        "loads": len(relief.loads),
    }
    return xr.Dataset(data, attrs=attributes)


def _amounts(relief: Relief) -> list[str]:
    """The varied keys that have an amount with a tolerance."""
    return [key for key in relief.vary if key.split(".")[-1] in TOLERATED]


def _points(
    relief: Relief, variants: Sequence[Mapping[str, str]]
) -> tuple[list[dict[str, Any]], list[tuple[int, int]]]:
    """Points to solve, and for each its variant and which amount is off; -1 for none."""
    points: list[dict[str, Any]] = []
    owners: list[tuple[int, int]] = []
    varied = _amounts(relief) if relief.tolerance else []
    for number, variant in enumerate(variants):
        case = relief.case.updated(dict(variant)) if varied else relief.case
        for load in relief.loads:
            points.append({**variant, **load})
            owners.append((number, -1))
            for place, key in enumerate(varied):
                off = f"{(case[key] + relief.tolerance) * 1e6:.9g} um"
                points.append({**variant, **load, key: off})
                owners.append((number, place))
    return points, owners


def _values(relief: Relief, rows: Rows) -> FloatArray:
    """Objectives of every point, in the units of `DISPLAY`."""
    columns = []
    for name in relief.objectives:
        figure = OBJECTIVES[name]
        key = figure if name == "loss" else f"{relief.mesh.replace('.', '_')}_{figure}"
        columns.append(rows.numbers(key))
    return np.array(columns).T


def _over_loads(relief: Relief, values: FloatArray) -> FloatArray:
    """The mean of losses and the largest of the others over the loads."""
    if not len(values):
        return np.full(len(relief.objectives), np.nan)
    found: FloatArray = values.max(axis=0)
    for place, name in enumerate(relief.objectives):
        if name == "loss":
            found[place] = values[:, place].mean()
    return found
