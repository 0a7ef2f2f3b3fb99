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
    from epicyclic.analysis.heat import heat_balance as heat_balance
    from epicyclic.analysis.heat import solve_for as solve_for
    from epicyclic.analysis.mesh_details import mesh_details as mesh_details
    from epicyclic.analysis.pocket_details import pocket_details as pocket_details
    from epicyclic.analysis.solve import loaded_meshes as loaded_meshes
    from epicyclic.analysis.solve import mesh_contacts as mesh_contacts
    from epicyclic.analysis.solve import solve as solve
    from epicyclic.bands.pairs import compare_cases as compare_cases
    from epicyclic.bands.run import uncertainty as uncertainty
    from epicyclic.campaigns.fit import characterise_oil as characterise_oil
    from epicyclic.case.case import GearPairCase as GearPairCase
    from epicyclic.case.case import PlanetaryCase as PlanetaryCase
    from epicyclic.case.case import case_schema as case_schema
    from epicyclic.errors import ConvergenceError as ConvergenceError
    from epicyclic.errors import EpicyclicError as EpicyclicError
    from epicyclic.errors import InputError as InputError
    from epicyclic.errors import Problem as Problem
    from epicyclic.exchange.load import load_case as load_case
    from epicyclic.exchange.rexs.exporting import write_rexs as write_rexs
    from epicyclic.exchange.rexs.importing import RexsImport as RexsImport
    from epicyclic.exchange.rexs.importing import read_rexs as read_rexs
    from epicyclic.maps.compute import loss_map as loss_map
    from epicyclic.maps.duty import duty_cycle as duty_cycle
    from epicyclic.maps.formats import write_map as write_map
    from epicyclic.maps.lumped import with_temperature_state as with_temperature_state
    from epicyclic.maps.warm_up import warm_up as warm_up
    from epicyclic.measurement.compare import compare_measured as compare_measured
    from epicyclic.measurement.comparison import MeasuredComparison as MeasuredComparison
    from epicyclic.records.files import open_result as open_result
    from epicyclic.records.files import save_result as save_result
    from epicyclic.records.record import ResultRecord as ResultRecord
    from epicyclic.records.record import record as record
    from epicyclic.report.html import report_html as report_html
    from epicyclic.results.result import Result as Result
    from epicyclic.sweeps.pocketing_study import pocketing_study as pocketing_study
    from epicyclic.sweeps.pocketing_table import pocketing_table as pocketing_table
    from epicyclic.sweeps.run import sweep as sweep

_HOME = {
    "ConvergenceError": "epicyclic.errors",
    "EpicyclicError": "epicyclic.errors",
    "GearPairCase": "epicyclic.case.case",
    "InputError": "epicyclic.errors",
    "MeasuredComparison": "epicyclic.measurement.comparison",
    "PlanetaryCase": "epicyclic.case.case",
    "Problem": "epicyclic.errors",
    "Result": "epicyclic.results.result",
    "ResultRecord": "epicyclic.records.record",
    "RexsImport": "epicyclic.exchange.rexs.importing",
    "case_schema": "epicyclic.case.case",
    "characterise_oil": "epicyclic.campaigns.fit",
    "compare_cases": "epicyclic.bands.pairs",
    "compare_measured": "epicyclic.measurement.compare",
    "duty_cycle": "epicyclic.maps.duty",
    "heat_balance": "epicyclic.analysis.heat",
    "load_case": "epicyclic.exchange.load",
    "loaded_meshes": "epicyclic.analysis.solve",
    "loss_map": "epicyclic.maps.compute",
    "mesh_contacts": "epicyclic.analysis.solve",
    "mesh_details": "epicyclic.analysis.mesh_details",
    "open_result": "epicyclic.records.files",
    "pocket_details": "epicyclic.analysis.pocket_details",
    "pocketing_study": "epicyclic.sweeps.pocketing_study",
    "pocketing_table": "epicyclic.sweeps.pocketing_table",
    "read_rexs": "epicyclic.exchange.rexs.importing",
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

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(importlib.import_module(_HOME[name]), name)
    raise AttributeError(f"module 'epicyclic' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
