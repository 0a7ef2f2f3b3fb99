"""From any case to the machine that it describes."""

from __future__ import annotations

from dataclasses import replace

from epicyclic.builders.built import Built
from epicyclic.builders.pair import build_pair
from epicyclic.builders.planetary import build_planetary
from epicyclic.builders.temperatures import thermal_model
from epicyclic.builders.train import build_train, train_layout
from epicyclic.case.case import Case, PlanetaryCase
from epicyclic.case.train import TrainCase
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.result.result import Layout


def build(
    case: Case,
    # Tables of flows through pockets that the points of a sweep share.
    flow_tables: FlowTables | None = None,
) -> Built:
    """The machine of a case, driven as the case says."""
    built = _machine(case, flow_tables or {})
    model = thermal_model(case, built.machine)
    if model is None:
        return built
    layout = replace(built.layout, nodes=tuple(model.start))
    return replace(built, thermal=model, layout=layout)


def _machine(case: Case, tables: FlowTables) -> Built:
    if isinstance(case, PlanetaryCase):
        return build_planetary(case, tables)
    if isinstance(case, TrainCase):
        return build_train(case, tables)
    return build_pair(case, tables)


def layout_of(case: Case) -> Layout:
    """What the result of a case consists of."""
    if isinstance(case, TrainCase) and case.models.temperatures == "inlet":
        return train_layout(case)
    return build(case).layout
