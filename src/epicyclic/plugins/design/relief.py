"""Micro-geometry over ranges: loss against transmission error, pressure and flash, with a band."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass, field
from epicyclic.errors import Problem, one_problem, raise_any
from epicyclic.machine.element import joined_key
from epicyclic.machine.gear_mesh import MeshFigures
from epicyclic.plugins.design.search import dominated
from epicyclic.study.sweeps.run import PointList
from epicyclic.study.sweeps.runner import Runner

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
    if not relief.loads:
        yield Problem("loads", "none", "must hold one load at least.", "For example loads=[{}].")
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
    shifted = [key for key in relief.vary if relief.tolerance and key.split(".")[-1] in TOLERATED]
    points = tuple(_points(relief, variants, shifted))
    rows = (runner or Runner()).run(PointList(relief.case, points=points))
    over_loads = []  # Of each objective: variants, as they are and then with one amount off.
    for name in relief.objectives:
        figure = OBJECTIVES[name]
        key = figure if name == "loss" else f"{relief.mesh}_{figure}"
        values = rows.numbers(key).reshape(len(variants), len(relief.loads), 1 + len(shifted))
        over_loads.append(values.mean(axis=1) if name == "loss" else values.max(axis=1))
    found = np.array(over_loads)
    nominal = found[..., 0]
    half = np.sqrt(((found[..., 1:] - found[..., :1]) ** 2).sum(axis=2))
    solved = np.isfinite(nominal).all(axis=0)
    if not solved.any():
        first = next(iter(rows.failures), "the mesh carries no load.")
        raise one_problem("--vary", "", f"leads to no result: {first}", "Narrow it, or load it.")
    front = np.zeros(len(variants), dtype=bool)
    front[solved] = ~dominated(nominal.T[solved], nominal.T[solved])
    data: dict[str, Any] = {
        key: ("variant", [variant[key] for variant in variants]) for key in relief.vary
    }
    for place, name in enumerate(relief.objectives):
        about = {"units": DISPLAY[name]}
        data[name] = ("variant", nominal[place], about)
        if relief.tolerance:
            data[f"{name}_low"] = ("variant", nominal[place] - half[place], about)
            data[f"{name}_high"] = ("variant", nominal[place] + half[place], about)
    data["front"] = ("variant", front)
    data["status"] = ("variant", np.where(solved, "converged", "failed"))
    attributes = {
        "title": relief.case.title,
        "mesh": relief.mesh,
        "tolerance_um": relief.tolerance * 1e6,
        "loads": len(relief.loads),
    }
    return xr.Dataset(data, attrs=attributes)


def _points(
    relief: Relief, variants: Sequence[Mapping[str, str]], shifted: Sequence[str]
) -> Iterator[dict[str, Any]]:
    """Points to solve, by variant and load: as it is, then with one of `shifted` off."""
    for variant in variants:
        case = relief.case.updated(dict(variant)) if shifted else relief.case
        for load in relief.loads:
            yield {**variant, **load}
            for key in shifted:
                off = f"{(case[key] + relief.tolerance) * 1e6:.9g} um"
                yield {**variant, **load, key: off}
