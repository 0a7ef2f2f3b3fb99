"""Finds what a listed set leaves out of its gears: centre distances, or profile shifts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import astuple
from typing import Any

import numpy as np

from epicyclic.case import build
from epicyclic.case.gear_sizes import named_rack, with_tool_tip
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.listed_checks import rack_problems, sound_gears
from epicyclic.case.listed_set import (
    central_gear,
    distance_key,
    distances_of,
    gears_table,
    own_mesh,
    pair_of,
    planet_of,
)
from epicyclic.case.size_solver import Found, SizedMesh, Solver
from epicyclic.case.train_shape import SetShape, ShapeMesh
from epicyclic.case.train_tables import ListedSet
from epicyclic.errors import InputError, Problem
from epicyclic.gears.gear import BasicRack

_GEARS = "gears."
_ALIKE = 1e-9
"""Modules and angles that differ by less are equal, relatively."""


def find_listed_sizes(
    table: ListedSet,
    shape: SetShape,
    raw: Mapping[str, Any],  # The set as the user wrote it, for the digits that are printed.
) -> tuple[ListedSet, tuple[Found, ...], list[Problem]]:
    """A listed set with what it leaves out, what was found, and why something cannot be."""
    if any(rack_problems(table)):  # told with the gears
        return table, (), []
    table, told = _with_named_rack(table)
    sound, problems = sound_gears(table)
    stated = [name for name, member in table.members.items() if member.states_thickness]
    if len(sound) < len(stated):
        return table, told, [] if len(stated) == len(table.members) else problems
    members: Mapping[str, GearTable] = table.members
    solver = Solver(sound, members, list(_sized(table, shape)), raw)
    try:
        solver.solve()
        _check_all_known(solver)
    except InputError as error:
        return table, told, list(error.problems)
    return _completed(table, shape, solver), (*told, *solver.found), []


def _with_named_rack(table: ListedSet) -> tuple[ListedSet, tuple[Found, ...]]:
    name = table.gears.basic_rack
    if name is None:
        return table, ()
    members = {
        gear: with_tool_tip(member, name, _rack(table, gear).normal_module)
        for gear, member in table.members.items()
    }
    coefficients, told = named_rack(name)
    gears = table.gears.model_copy(update=coefficients)
    return table.model_copy(update={"gears": gears, "members": members}), (told,)


def _rack(table: ListedSet, gear: str) -> BasicRack:
    return build.basic_rack(gears_table(table, gear))


def _sized(table: ListedSet, shape: SetShape) -> Iterator[SizedMesh]:
    """The meshes whose gears have one basic rack: profile shifts of others tell no distance."""
    distances = distances_of(table, shape)
    for mesh in shape.meshes:
        one, two = (_rack(table, gear) for gear in (mesh.first, mesh.second))
        if np.allclose(astuple(one), astuple(two), rtol=_ALIKE, atol=_ALIKE * one.normal_module):
            yield _mesh(table, shape, mesh, one, distances[mesh.key])


def _mesh(
    table: ListedSet, shape: SetShape, mesh: ShapeMesh, rack: BasicRack, distance: float | None
) -> SizedMesh:
    pair = pair_of(table, shape, mesh)
    name, own = own_mesh(table, pair)
    shared = distance_key(table, shape, mesh) == "gears.center_distance"
    teeth = [table.members[gear].teeth for gear in (mesh.first, mesh.second)]
    return SizedMesh(
        f"{'-'.join(pair)} mesh",
        f"mesh.{name}.normal_backlash",
        (mesh.first, mesh.second),
        teeth[0] + (-1 if mesh.internal else 1) * teeth[1],
        own.normal_backlash,
        rack,
        ("gears", "center_distance") if shared else ("mesh", name, "center_distance"),
        distance,
        gives_way=mesh.second if mesh.internal else central_gear(shape, mesh) or mesh.first,
        group=planet_of(shape, mesh) or mesh.key,
        prefix=_GEARS,
    )


def _check_all_known(solver: Solver) -> None:
    """Raise `InputError` for gears whose thickness no mesh tells."""
    unknown = [name for name, member in solver.tables.items() if not member.states_thickness]
    if unknown:
        keys = ", ".join(f"{_GEARS}{name}.profile_shift_coefficient" for name in unknown)
        allowed = "is missing, and no mesh with a gear of the same basic rack tells it."
        raise InputError([Problem(keys, "", allowed, "Add it.")])


def _completed(table: ListedSet, shape: SetShape, solver: Solver) -> ListedSet:
    """The set with what the solver found."""
    own = dict(table.mesh)
    stated = distances_of(table, shape)
    for mesh in shape.meshes:
        found = solver.distances.get(planet_of(shape, mesh) or mesh.key)
        if stated[mesh.key] is None and found is not None:
            name, former = own_mesh(table, pair_of(table, shape, mesh))
            own[name] = former.model_copy(update={"center_distance": found})
    return table.model_copy(update={"members": dict(solver.tables), "mesh": own})
