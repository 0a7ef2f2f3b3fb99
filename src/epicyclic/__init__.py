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
    from epicyclic.case.case import GearPairCase as GearPairCase
    from epicyclic.case.case import PlanetaryCase as PlanetaryCase
    from epicyclic.case.case import case_schema as case_schema
    from epicyclic.errors import ConvergenceError as ConvergenceError
    from epicyclic.errors import EpicyclicError as EpicyclicError
    from epicyclic.errors import InputError as InputError
    from epicyclic.errors import Problem as Problem
    from epicyclic.plugins.contact_solver.fit import characterise_oil as characterise_oil
    from epicyclic.plugins.design.search import design as design
    from epicyclic.plugins.design.strength import strength as strength
    from epicyclic.plugins.rexs.exporting import write_rexs as write_rexs
    from epicyclic.plugins.rexs.importing import RexsImport as RexsImport
    from epicyclic.plugins.rexs.importing import read_rexs as read_rexs
    from epicyclic.show.html import report_html as report_html
    from epicyclic.show.record import ResultRecord as ResultRecord
    from epicyclic.show.record import open_result as open_result
    from epicyclic.show.record import record as record
    from epicyclic.show.record import save_result as save_result
    from epicyclic.show.views import Result as Result
    from epicyclic.show.views import solve as solve
    from epicyclic.show.views import solve_for as solve_for
    from epicyclic.study.bands.compare_cases import compare_cases as compare_cases
    from epicyclic.study.bands.points import uncertainty as uncertainty
    from epicyclic.study.heat import heat_balance as heat_balance
    from epicyclic.study.load import load_case as load_case
    from epicyclic.study.maps.compute import loss_map as loss_map
    from epicyclic.study.maps.compute import with_temperature_state as with_temperature_state
    from epicyclic.study.maps.duty import duty_cycle as duty_cycle
    from epicyclic.study.maps.formats import write_map as write_map
    from epicyclic.study.maps.warm_up import warm_up as warm_up
    from epicyclic.study.measured.compare import compare_measured as compare_measured
    from epicyclic.study.measured.comparison import MeasuredComparison as MeasuredComparison
    from epicyclic.study.meshes import mesh_details as mesh_details
    from epicyclic.study.physics import bearing_loss as bearing_loss
    from epicyclic.study.physics import friction as friction
    from epicyclic.study.physics import line_contact as line_contact
    from epicyclic.study.physics import oil_properties as oil_properties
    from epicyclic.study.physics import plain_pin as plain_pin
    from epicyclic.study.physics import rolling_loss as rolling_loss
    from epicyclic.study.physics import windage as windage
    from epicyclic.study.pocketing_table import pocketing_table as pocketing_table
    from epicyclic.study.pockets import pocket_details as pocket_details
    from epicyclic.study.solve import loaded_meshes as loaded_meshes
    from epicyclic.study.solve import mesh_contacts as mesh_contacts
    from epicyclic.study.sweeps.run import sweep as sweep
    from epicyclic.validation.pocketing import pocketing_study as pocketing_study

_HOME = {  # those of plug-ins are missing with them
    name: f"epicyclic.{module}"
    for module, names in {
        "case.case": "GearPairCase PlanetaryCase case_schema",
        "errors": "ConvergenceError EpicyclicError InputError Problem",
        "plugins.contact_solver.fit": "characterise_oil",
        "plugins.design.search": "design",
        "plugins.design.strength": "strength",
        "plugins.rexs.exporting": "write_rexs",
        "plugins.rexs.importing": "RexsImport read_rexs",
        "show.html": "report_html",
        "show.record": "ResultRecord open_result record save_result",
        "show.views": "Result solve solve_for",
        "study.bands.compare_cases": "compare_cases",
        "study.bands.points": "uncertainty",
        "study.heat": "heat_balance",
        "study.load": "load_case",
        "study.maps.compute": "loss_map with_temperature_state",
        "study.maps.duty": "duty_cycle",
        "study.maps.formats": "write_map",
        "study.maps.warm_up": "warm_up",
        "study.measured.compare": "compare_measured",
        "study.measured.comparison": "MeasuredComparison",
        "study.meshes": "mesh_details",
        "study.physics": "bearing_loss friction line_contact oil_properties plain_pin rolling_loss "
        "windage",
        "study.pocketing_table": "pocketing_table",
        "study.pockets": "pocket_details",
        "study.solve": "loaded_meshes mesh_contacts",
        "study.sweeps.run": "sweep",
        "validation.pocketing": "pocketing_study",
    }.items()
    for name in names.split()
}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    home = _HOME.get(name)
    if home is not None:
        return getattr(importlib.import_module(home), name)
    raise AttributeError(f"module 'epicyclic' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
