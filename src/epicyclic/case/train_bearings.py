"""Can the forces on the shaft bearings of a train be found from what is given?"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from epicyclic.case.messages import millimetres
from epicyclic.case.tables.elements import ShaftBearingTable
from epicyclic.errors import Problem
from epicyclic.gears.gear import HOUSING

if TYPE_CHECKING:
    from epicyclic.case.train import TrainCase

GIVE_FORCE = "Or give radial_force (and axial_force) of the bearings of this shaft."


def needs_force(table: ShaftBearingTable) -> bool:
    """True if the force on a bearing is to be found from those of the gears."""
    by_load = table.table is None or table.table.radial_force is not None
    return table.radial_force is None and (table.model != "table" or by_load)


def bearing_force_problems(train: TrainCase, complete: bool) -> Iterator[Problem]:
    """What is missing for the forces on shaft bearings, shaft by shaft.

    Nothing is said of the gears on shafts whose members are not `complete`.
    """
    bearings: dict[str, dict[str, ShaftBearingTable]] = {}
    for kind, name, table in train.elements:
        if kind == "bearings" and isinstance(table, ShaftBearingTable) and needs_force(table):
            shaft = train.shape.names.get(table.shaft)
            if shaft is not None:
                bearings.setdefault(shaft, {})[name] = table
    for shaft, own in bearings.items():
        yield from _of_bearings(shaft, own)
        if complete:
            yield from _of_gears(train, shaft, own)


def _of_bearings(shaft: str, own: dict[str, ShaftBearingTable]) -> Iterator[Problem]:
    """Two bearings at two known places carry a shaft."""
    for name, table in own.items():
        if table.position is None:
            allowed = f"is missing: the force on the bearing follows from its place along {shaft}."
            remedy = f'Add position = "... mm". {GIVE_FORCE}'
            yield Problem(f"bearings.{name}.position", "", allowed, remedy)
    names = ", ".join(own)
    if len(own) > 2:
        allowed = f"are {len(own)} bearings on {shaft}; statics gives the forces of two."
        yield Problem("bearings", names, allowed, "Give radial_force of all but two.")
    places = [table.position for table in own.values() if table.position is not None]
    if len(own) == 2 and len(places) == 2 and places[0] == places[1]:
        key = f"bearings.{next(iter(own))}.position"
        allowed = f"is that of the other bearing of {shaft} too."
        yield Problem(key, millimetres(places[0]), allowed, "Give both their own positions.")


def _of_gears(train: TrainCase, shaft: str, own: dict[str, ShaftBearingTable]) -> Iterator[Problem]:
    """The forces of gears, and where they act."""
    names = ", ".join(own)
    if len(own) == 1 and any(True for _ in _gears(train, shaft)):
        allowed = f"is the only bearing of {shaft}, whose gears would tilt it."
        yield Problem(f"bearings.{names}", "", allowed, f"Add a second bearing. {GIVE_FORCE}")
    for gear in _gears(train, shaft):
        if train.position_of(gear) is None:
            allowed = f"is missing: the forces on the bearings {names} follow from it."
            remedy = f'Add "{gear}" = "... mm" to [positions]. {GIVE_FORCE}'
            yield Problem(f'positions."{gear}"', "", allowed, remedy)
    for name, gearing in train.shape.sets.items():
        if gearing.computed:
            continue
        if shaft in train.shape.bodies_of(name).values():
            allowed = f"is missing: the forces of {name}, whose efficiency is given, are not known."
            remedy = f"Give it for {names}."
            yield Problem(f"bearings.{next(iter(own))}.radial_force", "", allowed, remedy)


def _gears(train: TrainCase, shaft: str) -> Iterator[str]:
    """The gears on a shaft that push it aside: without planets all around them."""
    for name, gearing in train.shape.sets.items():
        if not gearing.computed or (gearing.planets and (gearing.count or 1) > 1):
            continue
        bodies = train.shape.bodies_of(name)
        for gear, body in gearing.bodies.items():
            if body not in gearing.planets and bodies[body] == shaft and shaft != HOUSING:
                yield f"{name}.{gear}"
