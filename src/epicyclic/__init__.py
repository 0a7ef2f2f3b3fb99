"""Epicyclic: power losses of planetary gear sets.

>>> import epicyclic as ep
>>> case = ep.load_case("talbot-2012")
>>> result = ep.solve(case)
>>> result.total > 0
True

Public names are imported when first used, so that ``import epicyclic`` is quick.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from epicyclic.analysis.mesh_details import mesh_details
    from epicyclic.analysis.result import Result
    from epicyclic.analysis.solve import loaded_meshes, mesh_contacts, solve
    from epicyclic.case.case import GearPairCase, PlanetaryCase, case_schema, load_case
    from epicyclic.errors import ConvergenceError, EpicyclicError, InputError, Problem
    from epicyclic.maps.compute import loss_map
    from epicyclic.maps.duty import duty_cycle
    from epicyclic.maps.formats import write_map
    from epicyclic.sweeps.run import sweep

_HOME = {
    "ConvergenceError": "epicyclic.errors",
    "EpicyclicError": "epicyclic.errors",
    "GearPairCase": "epicyclic.case.case",
    "InputError": "epicyclic.errors",
    "PlanetaryCase": "epicyclic.case.case",
    "Problem": "epicyclic.errors",
    "Result": "epicyclic.analysis.result",
    "case_schema": "epicyclic.case.case",
    "duty_cycle": "epicyclic.maps.duty",
    "load_case": "epicyclic.case.case",
    "loaded_meshes": "epicyclic.analysis.solve",
    "loss_map": "epicyclic.maps.compute",
    "mesh_contacts": "epicyclic.analysis.solve",
    "mesh_details": "epicyclic.analysis.mesh_details",
    "solve": "epicyclic.analysis.solve",
    "sweep": "epicyclic.sweeps.run",
    "write_map": "epicyclic.maps.formats",
}

__all__ = [
    "ConvergenceError",
    "EpicyclicError",
    "GearPairCase",
    "InputError",
    "PlanetaryCase",
    "Problem",
    "Result",
    "case_schema",
    "duty_cycle",
    "load_case",
    "loaded_meshes",
    "loss_map",
    "mesh_contacts",
    "mesh_details",
    "solve",
    "sweep",
    "write_map",
]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(importlib.import_module(_HOME[name]), name)
    raise AttributeError(f"module 'epicyclic' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
