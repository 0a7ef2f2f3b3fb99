"""From any case to the machine that it describes."""

from __future__ import annotations

from epicyclic.builders.built import Built
from epicyclic.builders.pair import build_pair
from epicyclic.builders.planetary import build_planetary
from epicyclic.builders.train import build_train, train_layout
from epicyclic.case.case import Case, PlanetaryCase
from epicyclic.case.train import TrainCase
from epicyclic.pocketing.table import FlowTables
from epicyclic.results.result import Layout

__all__ = ["build", "layout_of"]


def build(case: Case, flow_tables: FlowTables | None = None) -> Built:
    """The machine of a case, driven as the case says.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
    flow_tables : mapping, optional
        Tables of flows through pockets that the points of a sweep share.
    """
    tables = flow_tables or {}
    if isinstance(case, PlanetaryCase):
        return build_planetary(case, tables)
    if isinstance(case, TrainCase):
        return build_train(case, tables)
    return build_pair(case, tables)


def layout_of(case: Case) -> Layout:
    """What the result of a case consists of."""
    return train_layout(case) if isinstance(case, TrainCase) else build(case).layout
