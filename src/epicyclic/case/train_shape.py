"""The shape of a train: which gears stand on which bodies, which bodies are one shaft."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from epicyclic.case.messages import did_you_mean, written
from epicyclic.case.train_tables import (
    GivenListedSet,
    GivenPair,
    GivenPlanetarySet,
    ListedSet,
    PairSet,
    PlanetarySet,
    SetTable,
    StateTable,
)
from epicyclic.errors import Problem
from epicyclic.gears.gear import HOUSING
from epicyclic.machine.machine import Coupling, Machine, MeshRow

CARRIER = "carrier"


@dataclass(frozen=True, slots=True)
class ShapeMesh:
    """Two gears in mesh."""

    key: str  # ``"sun_mesh"``.
    first: str  # Gears; the ring gear of an internal mesh is the second.
    second: str  # Gears; the ring gear of an internal mesh is the second.
    teeth: tuple[float, float]  # Numbers of teeth of both. [1]
    internal: bool
    efficiency: float = 1.0  # Given, or 1. [1]


@dataclass(frozen=True, slots=True)
class SetShape:
    """The bodies of a set and its meshes."""

    bodies: Mapping[str, str]  # The body of each gear.
    planets: tuple[str, ...]  # Bodies that stand on the carrier; empty for fixed axes.
    meshes: tuple[ShapeMesh, ...]

    @property
    def members(self) -> tuple[str, ...]:
        """Bodies that shafts can join, the carrier among them."""
        central = [body for body in dict.fromkeys(self.bodies.values()) if body not in self.planets]
        return (*central, CARRIER) if self.planets else tuple(central)


@dataclass(frozen=True, slots=True)
class TrainShape:
    """The sets of a train and the shafts that join them."""

    sets: Mapping[str, SetShape]
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
        shape, bodies = self.sets[name], self.bodies_of(name)
        for mesh in shape.meshes:
            yield MeshRow(
                f"{name}.{mesh.key}",
                bodies[shape.bodies[mesh.first]],
                bodies[shape.bodies[mesh.second]],
                bodies[CARRIER] if shape.planets else HOUSING,
                mesh.teeth,
                mesh.internal,
                mesh.efficiency,
            )

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
        for group in state.joined:
            shafts = [self.shaft_of(name) or "" for name in group]
            if HOUSING in shafts:
                continue
            for one, two in pairwise(shafts):
                yield Coupling(f"{one}+{two}", one, two)


# --- sets -----------------------------------------------------------------------------------------


def shape_of_set(
    table: SetTable,
    # Members of the set that shafts, states and the operation name: they are no planets.
    joined: Iterable[str] = (),
) -> tuple[SetShape, list[Problem]]:
    """The bodies and meshes of a set, and what cannot be about them."""
    if isinstance(table, PlanetarySet | GivenPlanetarySet):
        return _planetary(table), list(_planetary_problems(table))
    if isinstance(table, PairSet | GivenPair):
        return _pair(table), list(_pair_problems(table))
    return _listed(table, set(joined))


def _planetary_problems(table: PlanetarySet | GivenPlanetarySet) -> Iterator[Problem]:
    """Tooth numbers that leave no room for planets; those of computed sets are checked before."""
    if not isinstance(table, GivenPlanetarySet):
        return
    sun, ring, planet = table.sun.teeth, table.ring.teeth, table.planet.teeth
    if ring <= sun:
        allowed = f"must exceed the {sun} teeth of the sun, around which it stands."
        yield Problem("ring.teeth", str(ring), allowed, "Check both tooth numbers.")
    elif planet is not None and planet >= ring:
        allowed = f"must be less than the {ring} teeth of the ring, in which the planet turns."
        yield Problem("planet.teeth", str(planet), allowed, "Check it, or leave it out.")


def _pair_problems(table: PairSet | GivenPair) -> Iterator[Problem]:
    if isinstance(table, GivenPair) and table.gear.internal:
        pinion, gear = table.pinion.teeth, table.gear.teeth
        if gear <= pinion:
            allowed = f"must exceed the {pinion} teeth of the pinion, which turns inside it."
            yield Problem("gear.teeth", str(gear), allowed, "Check both tooth numbers.")


def _planetary(table: PlanetarySet | GivenPlanetarySet) -> SetShape:
    planet: float = table.planet.teeth or (table.ring.teeth - table.sun.teeth) / 2
    efficiency = 1.0
    if isinstance(table, GivenPlanetarySet):
        if table.mesh_efficiency is not None:
            efficiency = table.mesh_efficiency
        elif table.efficiency is not None:
            # both meshes alike, so that sun to ring has the efficiency of the set
            efficiency = math.sqrt(table.efficiency)
    return SetShape(
        {"sun": "sun", "planet": "planet", "ring": "ring"},
        ("planet",),
        (
            ShapeMesh("sun_mesh", "sun", "planet", (table.sun.teeth, planet), False, efficiency),
            ShapeMesh("ring_mesh", "planet", "ring", (planet, table.ring.teeth), True, efficiency),
        ),
    )


def _pair(table: PairSet | GivenPair) -> SetShape:
    efficiency = table.efficiency if isinstance(table, GivenPair) else 1.0
    teeth = (table.pinion.teeth, table.gear.teeth)
    mesh = ShapeMesh("mesh", "pinion", "gear", teeth, table.gear.internal, efficiency)
    return SetShape({"pinion": "pinion", "gear": "gear"}, (), (mesh,))


def _listed(table: ListedSet | GivenListedSet, joined: set[str]) -> tuple[SetShape, list[Problem]]:
    gears = table.members
    bodies = {name: gear.body or name for name, gear in gears.items()}
    problems = _name_problems(table, bodies)
    pairs = [
        pair
        for pair in table.meshes
        if all(gear in gears for gear in pair) and bodies[pair[0]] != bodies[pair[1]]
    ]
    planets = _planets(table, bodies, pairs, joined)
    meshes: list[ShapeMesh] = []
    for one, two in pairs:
        found = _mesh_problem(table, bodies, planets, one, two)
        if found is not None:
            problems.append(found)
            continue
        first, second = (two, one) if gears[one].internal else (one, two)
        if any(mesh.key == f"{one}_{two}_mesh" for mesh in meshes):
            key, allowed = f"meshes[{table.meshes.index((one, two))}]", "and another mesh have "
            allowed += f"the same name, {one}_{two}_mesh, in the results."
            problems.append(Problem(key, f'["{one}", "{two}"]', allowed, "Rename a gear."))
            continue
        meshes.append(
            ShapeMesh(
                f"{one}_{two}_mesh",
                first,
                second,
                (gears[first].teeth, gears[second].teeth),
                gears[second].internal,
                _efficiency(table, one, two),
            )
        )
    return SetShape(bodies, tuple(planets), tuple(meshes)), problems


def _efficiency(table: ListedSet | GivenListedSet, one: str, two: str) -> float:
    if isinstance(table, ListedSet):
        return 1.0
    own = table.mesh.get(f"{one}-{two}") or table.mesh.get(f"{two}-{one}")
    return table.mesh_efficiency if own is None else own.efficiency


def _name_problems(table: ListedSet | GivenListedSet, bodies: Mapping[str, str]) -> list[Problem]:
    """Meshes between gears that are not there, twice, or on one body; gears without a mesh."""
    problems = []
    seen: set[frozenset[str]] = set()
    for number, (one, two) in enumerate(table.meshes):
        key, shown = f"meshes[{number}]", f'["{one}", "{two}"]'
        for gear in dict.fromkeys((one, two)):
            if gear not in bodies:
                remedy = did_you_mean(gear, bodies) or f"Known are: {', '.join(bodies)}."
                problems.append(Problem(key, written(gear), "is not a gear of this set.", remedy))
        if one == two:
            problems.append(
                Problem(key, shown, "is a gear in mesh with itself.", "Name two gears.")
            )
        elif bodies.get(one, one) == bodies.get(two, two):
            allowed = f"cannot mesh: both gears turn with the body {bodies.get(one, one)}."
            problems.append(Problem(key, shown, allowed, "Give one of them another body."))
        if frozenset((one, two)) in seen:
            problems.append(Problem(key, shown, "is listed before.", "List each mesh once."))
        seen.add(frozenset((one, two)))
    used = {gear for pair in table.meshes for gear in pair}
    problems += [
        Problem(f"gears.{gear}", "", "is in no mesh.", "Add its mesh to meshes, or remove it.")
        for gear in bodies
        if gear not in used
    ]
    known = {f"{one}-{two}" for pair in table.meshes for one, two in (pair, pair[::-1])}
    both = [
        pair for pair in table.meshes if {"-".join(pair), "-".join(pair[::-1])} <= {*table.mesh}
    ]
    for one, two in both:
        allowed = f"is the mesh {one}-{two} again."
        problems.append(Problem(f"mesh.{two}-{one}", "", allowed, "Keep one of the two."))
    for name in table.mesh:
        if name not in known:
            remedy = f"Known are: {', '.join('-'.join(pair) for pair in table.meshes)}."
            problems.append(Problem(f"mesh.{name}", "", "is no mesh of this set.", remedy))
    return problems


def _mesh_problem(
    table: ListedSet | GivenListedSet,
    bodies: Mapping[str, str],
    planets: Sequence[str],
    one: str,
    two: str,
) -> Problem | None:
    """Why two gears on different bodies cannot mesh; None if they can."""
    gears = table.members
    key, shown = f"meshes[{table.meshes.index((one, two))}]", f'["{one}", "{two}"]'
    if gears[one].internal and gears[two].internal:
        allowed = "cannot mesh: both are ring gears."
        return Problem(key, shown, allowed, "Make one of them external.")
    if planets and bodies[one] not in planets and bodies[two] not in planets:
        allowed = "cannot mesh: both turn about the axis of the set."
        remedy = f"If one of them is a planet, write gears.{two}.planet = true."
        return Problem(key, shown, allowed, remedy)
    for ring, mate in ((one, two), (two, one)):
        if not gears[ring].internal:
            continue
        if bodies[ring] in planets:
            allowed = f"cannot mesh: the ring gear {ring} would be a planet."
            return Problem(key, shown, allowed, f"Leave out gears.{ring}.planet.")
        if gears[ring].teeth <= gears[mate].teeth:
            allowed = (
                f"cannot mesh: the ring gear {ring} with {gears[ring].teeth} teeth must have more "
                f"than {mate} with {gears[mate].teeth}."
            )
            return Problem(key, shown, allowed, "Check both tooth numbers.")
    return None


def _planets(
    table: ListedSet | GivenListedSet,
    bodies: Mapping[str, str],
    pairs: Sequence[tuple[str, str]],
    joined: set[str],
) -> list[str]:
    """Bodies that stand on the carrier: as stated, or as meshes and shafts suggest."""
    gears = table.members
    stated = {bodies[name]: gear.planet for name, gear in gears.items() if gear.planet is not None}
    rings = {bodies[name] for name, gear in gears.items() if gear.internal}
    mates: dict[str, set[str]] = defaultdict(set)
    for one, two in pairs:
        mates[bodies[one]].add(two)
        mates[bodies[two]].add(one)
    around = table.planets is not None or CARRIER in joined
    if not around and not any(stated.values()):
        around = any("planet" in name for name in (*bodies, *bodies.values()))
    planets = []
    for body in dict.fromkeys(bodies.values()):
        names = {body, *(name for name in bodies if bodies[name] == body)}
        named = bool(names & joined) and not any("planet" in name for name in names)
        if body in stated:
            on_carrier = bool(stated[body])
        elif body in rings or named or not around:
            on_carrier = False
        else:
            on_carrier = len(mates[body]) > 1 or "planet" in body
        if on_carrier:
            planets.append(body)
    return planets


# --- shafts ---------------------------------------------------------------------------------------


def shape_of_train(
    sets: Mapping[str, SetShape], shafts: Mapping[str, Sequence[str]]
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


def _aliases(sets: Mapping[str, SetShape]) -> dict[str, str]:
    """Members by the names of their gears."""
    return {
        f"{name}.{gear}": f"{name}.{body}"
        for name, shape in sets.items()
        for gear, body in shape.bodies.items()
        if body not in shape.planets and gear != body
    }


def _no_member(
    key: str, name: str, members: Sequence[str], sets: Mapping[str, SetShape]
) -> Problem:
    owner, _, member = name.partition(".")
    if owner in sets and member in sets[owner].planets:
        allowed = "is a planet: it turns on the carrier and cannot be joined to a shaft."
        return Problem(key, written(name), allowed, f"Join {owner}.{CARRIER}, or another member.")
    remedy = did_you_mean(name, members) or f"Known are: {', '.join(members)}."
    return Problem(key, written(name), "is not a member of a set.", remedy)
