"""A set whose gears and meshes are listed, with computed losses."""

from __future__ import annotations

from epicyclic.case.train import TrainCase
from epicyclic.case.train_tables import ListedSet
from epicyclic.elements.gear_set import GearSet
from epicyclic.pocketing.table import FlowTables

__all__ = ["listed_element"]


def listed_element(key: str, table: ListedSet, case: TrainCase, flow_tables: FlowTables) -> GearSet:
    """The losses of a listed set."""
    raise AssertionError
