"""The shape of a train: which bodies are one shaft; and whether it can move as stated."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

from epicyclic.dataclass import dataclass
from epicyclic.errors import Problem
from epicyclic.gears.gear import CARRIER, HOUSING
from epicyclic.gears.gearing import Gearing
from epicyclic.messages import NAME, did_you_mean, part_name_problems, written

if TYPE_CHECKING:  # cases that are only read need no machine
    from epicyclic.machine.machine import Coupling, Machine, MeshRow


class Joined(Protocol):
    """What brakes and clutches make of a train, by the names of its shafts."""

    @property
    def fixed(self) -> tuple[str, ...]: ...
    @property
    def joined(self) -> tuple[tuple[str, ...], ...]: ...


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

    def places(self, origin: str) -> dict[str, complex]:
        """Where the first body, or the axis, of each set lies from the shaft `origin`. [m]

        Sets that no shaft joins to it, or of given efficiency, are left out.
        """
        shafts, found = {origin: 0j}, dict[str, complex]()
        left = {name: gearing.centers for name, gearing in self.sets.items() if gearing.computed}
        while joined := [name for name in left if self._seats(name).keys() & shafts.keys()]:
            for name in joined:
                centers, seats = left.pop(name), self._seats(name)
                own = next(shaft for shaft in seats if shaft in shafts)
                found[name] = shafts[own] - centers.get(seats[own], (0j,))[0]
                for shaft, body in seats.items():
                    shafts.setdefault(shaft, found[name] + centers.get(body, (0j,))[0])
        return found

    def _seats(self, name: str) -> dict[str, str]:
        """The bodies of a set on each turning shaft."""
        planets = self.sets[name].planets
        bodies = self.bodies_of(name)
        return {bodies[own]: own for own in bodies if own not in planets and bodies[own] != HOUSING}

    def machine(self, state: Joined) -> Machine:
        """The constraints of all meshes and closed clutches, without anything that loses power."""
        from epicyclic.machine.machine import Machine

        rows = tuple(row for name in self.sets for row in self.rows(name))
        planets = [f"{name}.{body}" for name, shape in self.sets.items() for body in shape.planets]
        couplings = tuple(self._couplings(state))
        turning = self.turning(state)
        resting = tuple(shaft for shaft in self.shafts if shaft not in (*turning, HOUSING))
        return Machine((*turning, *planets), rows, (), couplings, resting=resting)

    def turning(self, state: Joined) -> tuple[str, ...]:
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

    def held(self, state: Joined) -> tuple[str, ...]:
        """Shafts that stand still, by brakes or by clutches to the housing."""
        names = [*state.fixed]
        for group in state.joined:
            if any(self.shaft_of(name) == HOUSING for name in group):
                names += group
        shafts = [self.shaft_of(name) for name in names]
        turning = self.turning(state)
        return tuple(dict.fromkeys(shaft for shaft in shafts if shaft in turning))

    def _couplings(self, state: Joined) -> Iterator[Coupling]:
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


def shape_of_train(
    sets: Mapping[str, Gearing], shafts: Mapping[str, Sequence[str]]
) -> tuple[TrainShape, list[Problem]]:
    """Which members turn together, and what cannot be about it."""
    members = [f"{name}.{member}" for name, shape in sets.items() for member in shape.members]
    aliases = {  # members by the names of their gears
        f"{name}.{gear}": f"{name}.{body}"
        for name, shape in sets.items()
        for gear, body in shape.bodies.items()
        if body not in shape.planets and gear != body
    }
    problems: list[Problem] = []
    owner: dict[str, str] = {}
    joined: dict[str, list[str]] = {}
    for shaft, names in shafts.items():
        key = f"shafts.{shaft}"
        joined[shaft] = []
        problems += part_name_problems(key, shaft, "shaft")
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


def _no_member(key: str, name: str, members: Sequence[str], sets: Mapping[str, Gearing]) -> Problem:
    owner, _, member = name.partition(".")
    if owner in sets and member in sets[owner].planets:
        allowed = "is a planet: it turns on the carrier and cannot be joined to a shaft."
        return Problem(key, written(name), allowed, f"Join {owner}.{CARRIER}, or another member.")
    remedy = did_you_mean(name, members) or f"The members are {', '.join(members)}."
    return Problem(key, written(name), "is not a member of a set.", remedy)


class StatedOperation(Protocol):
    """How a train runs, by the names of its shafts."""

    @property
    def state(self) -> str | None: ...
    @property
    def input(self) -> str: ...
    @property
    def output(self) -> str: ...
    @property
    def speeds(self) -> Mapping[str, float]: ...
    @property
    def torques(self) -> Mapping[str, float]: ...


class Train(Protocol):
    """A train with its states, one of which is chosen."""

    @property
    def shape(self) -> TrainShape: ...
    @property
    def operation(self) -> StatedOperation: ...
    @property
    def states(self) -> Mapping[str, Joined]: ...
    @property
    def state(self) -> Joined: ...


def named_problems(train: Train) -> list[Problem]:
    """States and shafts that are named and are not there."""
    operation, problems = train.operation, []
    for name, state in train.states.items():
        if not NAME.fullmatch(name):
            allowed = "is not a valid name for a state."
            problems.append(Problem(f"states.{name}", "", allowed, "Choose another name."))
        problems += state_problems(f"states.{name}", state, train.shape)
    problems += _state_choice(train)
    for key in ("input", "output"):
        problems += _shaft_problems(f"operation.{key}", getattr(operation, key), train.shape)
    for key in ("speeds", "torques"):
        for name in getattr(operation, key):
            problems += _shaft_problems(f"operation.{key}.{name}", name, train.shape)
    return problems


def motion_problems(train: Train, complete: bool) -> list[Problem]:
    """Why a train cannot move as stated, whose names are all known; `complete` as for cases."""
    return list(_ends_problems(train, complete)) or _freedom_problems(train, complete)


def state_problems(key: str, state: Joined, shape: TrainShape) -> Iterator[Problem]:
    """Brakes and clutches on shafts that are not there, or on one shaft."""
    for number, name in enumerate(state.fixed):
        yield from _shaft_problems(f"{key}.fixed[{number}]", name, shape)
    for number, group in enumerate(state.joined):
        where, shown = f"{key}.joined[{number}]", written(list(group))
        found = [problem for name in group for problem in _shaft_problems(where, name, shape)]
        yield from found
        shafts = [shape.shaft_of(name) for name in group]
        if len(group) < 2:
            allowed = "must name two or more shafts."
            yield Problem(where, shown, allowed, "Name the shafts that a clutch joins.")
        elif not found and len(set(shafts)) < len(shafts):
            twice = next(one for one in shafts if shafts.count(one) > 1)
            allowed = f"joins the shaft {twice} to itself."
            yield Problem(where, shown, allowed, "Name two different shafts.")


def _shaft_problems(key: str, name: str, shape: TrainShape) -> Iterator[Problem]:
    if shape.shaft_of(name) is None:
        known = [shaft for shaft in shape.shafts if shaft != HOUSING]
        members = [member for names in shape.shafts.values() for member in names]
        remedy = did_you_mean(name, dict.fromkeys([*known, *members]))
        remedy = remedy or f"Choose one of {', '.join(known)}."
        yield Problem(key, written(name), "is neither a shaft nor a member of a set.", remedy)


def _state_choice(train: Train) -> Iterator[Problem]:
    name, known = train.operation.state, list(train.states)
    key = "operation.state"
    if name is None and known:
        allowed = f"is missing; it must be one of {', '.join(known)}."
        yield Problem(key, "", allowed, f'Write state = "{known[0]}".')
    elif name is not None and not known:
        allowed = "is not a state: the train has no states."
        yield Problem(key, written(name), allowed, "Leave it out, or add [states.NAME].")
    elif name is not None and name not in known:
        remedy = did_you_mean(name, known) or f"Choose one of {', '.join(known)}."
        yield Problem(key, written(name), "is not a state of the train.", remedy)


def _ends_problems(train: Train, complete: bool) -> Iterator[Problem]:
    """Input and output must be two shafts that can turn."""
    shape = train.shape
    operation = train.operation
    ends = {key: shape.shaft_of(getattr(operation, key)) for key in ("input", "output")}
    groups = [{shape.shaft_of(name) for name in group} for group in train.state.joined]
    if ends["input"] == ends["output"]:
        allowed = "is also the input shaft."
        remedy = "Name another shaft; a train transmits power from one shaft to another."
        yield Problem("operation.output", written(operation.output), allowed, remedy)
    held = shape.held(train.state)
    turning = {*shape.turning(train.state), HOUSING}
    for key, shaft in ends.items():
        if complete and shaft not in turning:
            allowed = f"is not connected in {_state_words(train)}: it has no members, and no "
            allowed += "clutch on it is closed."
            shown = written(getattr(operation, key))
            yield Problem(f"operation.{key}", shown, allowed, "Close a clutch, or name another.")
            continue
        by_clutch = any(shaft in group and group & set(held) for group in groups)
        if shaft == HOUSING or shaft in held or by_clutch:
            allowed = "stands still with the housing."
            if shaft != HOUSING:
                allowed = f"is held by a brake in {_state_words(train)}."
            advice = "Name a shaft that turns, or release it."
            yield Problem(f"operation.{key}", written(getattr(operation, key)), allowed, advice)
    if complete:
        yield from _given_problems(train, ends)


def _given_problems(train: Train, ends: Mapping[str, str | None]) -> Iterator[Problem]:
    """Further speeds and torques: of shafts that turn, each once, and only one of the two."""
    shape = train.shape
    operation = train.operation
    turning = shape.turning(train.state)
    held: dict[str | None, str] = dict.fromkeys((*shape.held(train.state), HOUSING), "held")
    driven = {shape.shaft_of(name): "given a speed" for name in operation.speeds}
    inputs: dict[str | None, str] = {ends["input"]: "the input"}
    output: dict[str | None, str] = {ends["output"]: "the output"}
    kinds = {
        "speeds": (operation.speeds, held | inputs),
        "torques": (operation.torques, held | driven | output | inputs),
    }
    for key, (values, taken) in kinds.items():
        seen: dict[str | None, str] = {}
        for name in values:
            shaft, allowed = shape.shaft_of(name), ""
            if shaft in taken:
                allowed = f"cannot be given: this shaft is {taken[shaft]}."
            elif shaft not in turning:
                allowed = f"cannot be given: it is not connected in {_state_words(train)}."
            elif shaft in seen:
                allowed = f"is given twice: {seen[shaft]} is the same shaft."
            seen[shaft] = name
            if allowed:
                yield Problem(f"operation.{key}.{name}", "", allowed, "Leave it out.")


def _freedom_problems(train: Train, complete: bool) -> list[Problem]:
    """The given speeds must determine all others, and the input must be able to turn."""
    shape = train.shape
    from epicyclic.machine.balance import freedom, implied

    machine = shape.machine(train.state)
    driven = shape.shaft_of(train.operation.input) or ""
    held = shape.held(train.state)
    others = [*held, *(shape.shaft_of(name) or "" for name in train.operation.speeds)]
    if not complete:  # without its members a shaft is no body
        others = [shaft for shaft in others if shaft in machine.bodies]
        if driven not in machine.bodies:
            return []
    found = freedom(machine, driven, others)
    if (found.blocked or found.loose) and (slow := _far_apart(machine, driven, others)):
        return slow
    key = "operation.state" if train.states else "shafts"
    shown = written(train.operation.state) if train.states else ""
    problems = []
    if found.blocked:
        means = _means(train.state, held, train.operation.speeds)
        reason = f"blocks the train, so the input shaft {driven} cannot turn"
        reason += f" with {means}." if means else "."
        remedy = "Release one of these." if means else "Check the shafts."
        problems.append(Problem(key, shown, reason, remedy))
    if not complete:
        return problems
    if found.loose:
        names = ", ".join(body for body in found.loose if body in shape.shafts)
        word, plural = ("one", "") if found.freedoms == 1 else (str(found.freedoms), "s")
        allowed = f"leaves {word} degree{plural} of freedom open: the speed of {names} is not "
        allowed += "determined."
        remedy = f"Hold or join {word} more of these shafts (fixed, joined), or give the speed of "
        remedy += f"{word} of them in [operation.speeds]."
        problems.append(Problem(key, shown, allowed, remedy))
    further = {shape.shaft_of(name) or "": name for name in train.operation.speeds}
    if not found.loose:
        for shaft in implied(machine, [driven, *held], list(further)):
            allowed = "cannot be given: this speed follows from those of the other shafts."
            key = f"operation.speeds.{further[shaft]}"
            problems.append(Problem(key, "", allowed, "Leave it out."))
    if problems or shape.shaft_of(train.operation.output) in further:
        return problems
    return _standing_output(train, machine, driven, others)


def _standing_output(
    train: Train, machine: Machine, driven: str, others: Sequence[str]
) -> list[Problem]:
    """An output that the input does not turn can balance no torque of it."""
    shape = train.shape
    from epicyclic.machine.balance import speeds_of

    output = train.operation.output
    speeds = speeds_of(machine, dict.fromkeys(others, 0.0) | {driven: 1.0})
    if speeds[shape.shaft_of(output) or ""] != 0:
        return []
    if slow := _far_apart(machine, driven, others):
        return slow
    allowed = f"stands still at any speed of the input shaft {driven} in {_state_words(train)}, so "
    allowed += "no power reaches it."
    turning = [shaft for shaft in shape.shafts if speeds[shaft] != 0 and shaft != driven]
    remedy = f"Name a shaft that turns with the input: {', '.join(turning)}."
    remedy = remedy if turning else "Join it to the input."
    return [Problem("operation.output", written(output), allowed, remedy)]


FAR_APART = 1e8  # Ratio of two speeds from which singular values may be nothing but rounding. [1]


def _far_apart(machine: Machine, driven: str, others: Sequence[str]) -> list[Problem]:
    """Why shafts that turn look as if they stood still: the slowest is too slow beside others."""
    from epicyclic.machine.balance import exact_speeds

    exact = exact_speeds(machine, dict.fromkeys(others, 0) | {driven: 1})
    turning = sorted((abs(speed), body) for body, speed in (exact or {}).items() if speed)
    if not turning or turning[-1][0] < FAR_APART * turning[0][0]:
        return []
    (slowest, slow), (fastest, fast) = turning[0], turning[-1]
    allowed = f"turns {float(fastest / slowest):.2g} times as fast as shaft {slow}: "
    allowed += "speeds so far apart drown in rounding."
    remedy = f"Leave out sets between {fast} and {slow}, and compute them as a train of their own."
    return [Problem("shafts", fast, allowed, remedy)]


def _state_words(train: Train) -> str:
    name = train.operation.state
    return "this train" if name is None else f"state {name}"


def _means(state: Joined, held: Sequence[str], speeds: Mapping[str, float]) -> str:
    parts = []
    if held:
        parts.append(f"{', '.join(held)} held")
    if state.joined:
        parts.append(f"{', '.join('+'.join(group) for group in state.joined)} joined")
    if speeds:
        parts.append(f"the speed of {', '.join(speeds)} given")
    return " and ".join(parts)
