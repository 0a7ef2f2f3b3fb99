"""The shape of a train: which gears stand on which bodies, which bodies are one shaft."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from epicyclic.case.fields import did_you_mean, written
from epicyclic.case.gearing import Gearing
from epicyclic.case.train_tables import StateTable
from epicyclic.errors import Problem
from epicyclic.gears.gear import CARRIER, HOUSING

if TYPE_CHECKING:  # only trains need a machine
    from epicyclic.machine.machine import Coupling, Machine, MeshRow


@dataclass(frozen=True, slots=True)
class TrainShape:
    """The sets of a train and the shafts that join them."""

    sets: Mapping[str, Gearing]
    # Members of each shaft, ``"P1.sun"``; a member that no shaft names is a shaft of its own.
    shafts: Mapping[str, tuple[str, ...]]

    def shaft_of(self, name: str) -> str | None:
        """The shaft called `name`, or that of the member of this name; None if there is none."""
        if name in self.shafts or name == HOUSING:
            return name
        return next((shaft for shaft, members in self.shafts.items() if name in members), None)

    @property
    def names(self) -> dict[str, str]:
        """Every shaft by its name and by those of its members."""
        return {
            name: shaft
            for shaft, members in self.shafts.items()
            if shaft != HOUSING
            for name in (shaft, *members)
        }

    def bodies_of(self, name: str) -> dict[str, str]:
        """The body in the machine of every body of set `name`, and of its carrier."""
        shape = self.sets[name]
        found = {planet: f"{name}.{planet}" for planet in shape.planets}
        for member in shape.members:
            shaft = self.shaft_of(f"{name}.{member}")
            assert shaft is not None
            found[member] = shaft
        return found

    def machine(self, state: StateTable) -> Machine:
        """The constraints of all meshes and closed clutches, without anything that loses power."""
        from epicyclic.machine.machine import Machine

        rows = tuple(row for name in self.sets for row in self.rows(name))
        planets = [f"{name}.{body}" for name, shape in self.sets.items() for body in shape.planets]
        couplings = tuple(self._couplings(state))
        turning = self.turning(state)
        resting = tuple(shaft for shaft in self.shafts if shaft not in (*turning, HOUSING))
        return Machine((*turning, *planets), rows, (), couplings, resting=resting)

    def turning(self, state: StateTable) -> tuple[str, ...]:
        """Shafts of a state but the housing.

        A shaft that only clutches join to others is none while these are open.
        """
        coupled = {shaft for one in self._couplings(state) for shaft in (one.first, one.second)}
        return tuple(
            shaft
            for shaft, members in self.shafts.items()
            if shaft != HOUSING and (members or shaft in coupled)
        )

    def rows(self, name: str) -> Iterator[MeshRow]:
        """The constraints of the meshes of a set."""
        return mesh_rows(name, self.sets[name], self.bodies_of(name))

    def held(self, state: StateTable) -> tuple[str, ...]:
        """Shafts that stand still, by brakes or by clutches to the housing."""
        names = [*state.fixed]
        for group in state.joined:
            if any(self.shaft_of(name) == HOUSING for name in group):
                names += group
        shafts = [self.shaft_of(name) for name in names]
        turning = self.turning(state)
        return tuple(dict.fromkeys(shaft for shaft in shafts if shaft in turning))

    def _couplings(self, state: StateTable) -> Iterator[Coupling]:
        from epicyclic.machine.machine import Coupling

        for group in state.joined:
            shafts = [self.shaft_of(name) or "" for name in group]
            if HOUSING in shafts:
                continue
            for one, two in pairwise(shafts):
                yield Coupling(f"{one}+{two}", one, two)


def mesh_rows(key: str, gearing: Gearing, bodies: Mapping[str, str]) -> Iterator[MeshRow]:
    """The constraints of the meshes of a set. Theory (K1), (K2), (K6)."""
    from epicyclic.machine.machine import MeshRow

    for mesh in gearing.meshes:
        yield MeshRow(
            f"{key}.{mesh.key}",
            bodies[gearing.bodies[mesh.first]],
            bodies[gearing.bodies[mesh.second]],
            bodies[CARRIER] if gearing.planets else HOUSING,
            mesh.teeth,
            mesh.internal,
            mesh.efficiency,
        )


# --- shafts ---------------------------------------------------------------------------------------


def shape_of_train(
    sets: Mapping[str, Gearing], shafts: Mapping[str, Sequence[str]]
) -> tuple[TrainShape, list[Problem]]:
    """Which members turn together, and what cannot be about it."""
    members = [f"{name}.{member}" for name, shape in sets.items() for member in shape.members]
    aliases = _aliases(sets)
    problems: list[Problem] = []
    owner: dict[str, str] = {}
    joined: dict[str, list[str]] = {}
    for shaft, names in shafts.items():
        key = f"shafts.{shaft}"
        joined[shaft] = []
        if "." in shaft or not shaft.strip():
            allowed = "is not a valid name for a shaft: use letters, and no dot."
            problems.append(Problem(key, "", allowed, "Choose another name."))
        for name in names:
            member = aliases.get(name, name)
            if member not in members:
                problems.append(_no_member(key, name, members, sets))
            elif owner.get(member) == shaft:
                allowed = f"joins {name} to itself."
                problems.append(Problem(key, written(name), allowed, "Name each member once."))
            elif member in owner:
                allowed = f"belongs to the shaft {owner[member]} already."
                remedy = f"Name it in one of the two; if {owner[member]} and {shaft} are one "
                remedy += "shaft, put all members into one list."
                problems.append(Problem(key, written(name), allowed, remedy))
            else:
                owner[member] = shaft
                joined[shaft].append(member)
    alone = {member: (member,) for member in members if member not in owner}
    whole = {shaft: tuple(names) for shaft, names in joined.items()} | alone
    return TrainShape(sets, whole), problems


def _aliases(sets: Mapping[str, Gearing]) -> dict[str, str]:
    """Members by the names of their gears."""
    return {
        f"{name}.{gear}": f"{name}.{body}"
        for name, shape in sets.items()
        for gear, body in shape.bodies.items()
        if body not in shape.planets and gear != body
    }


def _no_member(key: str, name: str, members: Sequence[str], sets: Mapping[str, Gearing]) -> Problem:
    owner, _, member = name.partition(".")
    if owner in sets and member in sets[owner].planets:
        allowed = "is a planet: it turns on the carrier and cannot be joined to a shaft."
        return Problem(key, written(name), allowed, f"Join {owner}.{CARRIER}, or another member.")
    remedy = did_you_mean(name, members) or f"The members are {', '.join(members)}."
    return Problem(key, written(name), "is not a member of a set.", remedy)
