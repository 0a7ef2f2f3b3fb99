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
    from epicyclic.analysis.heat import heat_balance, solve_for
    from epicyclic.analysis.mesh_details import mesh_details
    from epicyclic.analysis.pocket_details import pocket_details
    from epicyclic.analysis.solve import loaded_meshes, mesh_contacts, solve
    from epicyclic.bands.pairs import compare_cases
    from epicyclic.bands.run import uncertainty
    from epicyclic.campaigns.fit import characterise_oil
    from epicyclic.case.case import GearPairCase, PlanetaryCase, case_schema
    from epicyclic.errors import ConvergenceError, EpicyclicError, InputError, Problem
    from epicyclic.exchange.load import load_case
    from epicyclic.exchange.rexs.exporting import write_rexs
    from epicyclic.exchange.rexs.importing import RexsImport, read_rexs
    from epicyclic.maps.compute import loss_map
    from epicyclic.maps.duty import duty_cycle
    from epicyclic.maps.formats import write_map
    from epicyclic.maps.lumped import with_temperature_state
    from epicyclic.maps.warm_up import warm_up
    from epicyclic.measurement.compare import compare_measured
    from epicyclic.measurement.comparison import MeasuredComparison
    from epicyclic.records.files import open_result, save_result
    from epicyclic.records.record import ResultRecord, record
    from epicyclic.report.html import report_html
    from epicyclic.results.result import Result
    from epicyclic.sweeps.pocketing_study import pocketing_study
    from epicyclic.sweeps.pocketing_table import pocketing_table
    from epicyclic.sweeps.run import sweep

_HOME = {
    "ConvergenceError": "epicyclic.errors",
    "EpicyclicError": "epicyclic.errors",
    "GearPairCase": "epicyclic.case.case",
    "InputError": "epicyclic.errors",
    "MeasuredComparison": "epicyclic.measurement.comparison",
    "PlanetaryCase": "epicyclic.case.case",
    "Problem": "epicyclic.errors",
    "Result": "epicyclic.results.result",
    "RexsImport": "epicyclic.exchange.rexs.importing",
    "ResultRecord": "epicyclic.records.record",
    "case_schema": "epicyclic.case.case",
    "characterise_oil": "epicyclic.campaigns.fit",
    "heat_balance": "epicyclic.analysis.heat",
    "load_case": "epicyclic.exchange.load",
    "compare_cases": "epicyclic.bands.pairs",
    "compare_measured": "epicyclic.measurement.compare",
    "duty_cycle": "epicyclic.maps.duty",
    "loaded_meshes": "epicyclic.analysis.solve",
    "loss_map": "epicyclic.maps.compute",
    "mesh_contacts": "epicyclic.analysis.solve",
    "mesh_details": "epicyclic.analysis.mesh_details",
    "pocket_details": "epicyclic.analysis.pocket_details",
    "pocketing_study": "epicyclic.sweeps.pocketing_study",
    "pocketing_table": "epicyclic.sweeps.pocketing_table",
    "read_rexs": "epicyclic.exchange.rexs.importing",
    "open_result": "epicyclic.records.files",
    "record": "epicyclic.records.record",
    "report_html": "epicyclic.report.html",
    "save_result": "epicyclic.records.files",
    "solve": "epicyclic.analysis.solve",
    "solve_for": "epicyclic.analysis.heat",
    "sweep": "epicyclic.sweeps.run",
    "uncertainty": "epicyclic.bands.run",
    "warm_up": "epicyclic.maps.warm_up",
    "with_temperature_state": "epicyclic.maps.lumped",
    "write_map": "epicyclic.maps.formats",
    "write_rexs": "epicyclic.exchange.rexs.exporting",
}

__all__ = [
    "ConvergenceError",
    "EpicyclicError",
    "GearPairCase",
    "InputError",
    "MeasuredComparison",
    "PlanetaryCase",
    "Problem",
    "Result",
    "ResultRecord",
    "RexsImport",
    "case_schema",
    "characterise_oil",
    "compare_cases",
    "compare_measured",
    "duty_cycle",
    "heat_balance",
    "load_case",
    "loaded_meshes",
    "loss_map",
    "mesh_contacts",
    "mesh_details",
    "open_result",
    "pocket_details",
    "pocketing_study",
    "pocketing_table",
    "read_rexs",
    "record",
    "report_html",
    "save_result",
    "solve",
    "solve_for",
    "sweep",
    "uncertainty",
    "warm_up",
    "with_temperature_state",
    "write_map",
    "write_rexs",
]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(importlib.import_module(_HOME[name]), name)
    raise AttributeError(f"module 'epicyclic' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
