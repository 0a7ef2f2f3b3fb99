"""Can a train run as stated: shafts, states, freedom, oil around its sets, forces on bearings?

Every function returns the problems it finds; none stops at the first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from epicyclic.case.checks import check_oil_model
from epicyclic.case.messages import did_you_mean, millimetres, written
from epicyclic.case.tables.elements import ShaftBearingTable
from epicyclic.case.tables.operation import check_immersion, check_outlet, check_sump, check_wetting
from epicyclic.case.train_shape import TrainShape
from epicyclic.case.train_tables import StateTable
from epicyclic.errors import Problem
from epicyclic.gears.gear import HOUSING

if TYPE_CHECKING:
    from epicyclic.case.train import TrainCase
    from epicyclic.machine.machine import Machine


def lubrication_problems(train: TrainCase) -> list[Problem]:
    """What cannot be about the lubrication of the sets; a shared table is checked by itself."""
    problems: list[Problem] = []
    if train.lubrication is not None and train.lubrication.immersion:
        allowed = "is stated of each set, whose gears it names."
        remedy = "Write [sets.NAME.lubrication], or give oil_level."
        problems.append(Problem("lubrication.immersion", "", allowed, remedy))
    for name, table in train.computed_sets:
        own = table.lubrication
        if own is None or own == train.lubrication:
            continue
        if train.lubrication is None:
            # the oil around everything that is in no set follows from the train's own table
            allowed = "needs [lubrication] of the train, which it then replaces for this set."
            remedy = "Add it, for all other parts."
            problems.append(Problem(f"sets.{name}.lubrication", "", allowed, remedy))
        found = [*check_sump(own, train.thermal), *check_wetting(own, train.thermal)]
        if train.shape.sets[name].listed:
            found += check_immersion(own, train.shape.sets[name].members)
        problems += [replace(problem, key=_key(name, problem.key)) for problem in found]
    return problems


def _key(name: str, keys: str) -> str:
    """Keys of a set as those of the train."""
    return ", ".join(
        f"sets.{name}.{key}" if key.startswith("lubrication") else key for key in keys.split(", ")
    )


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


def operation_problems(train: TrainCase, shape: TrainShape, complete: bool) -> list[Problem]:
    """What cannot be about the states and the operation of a train.

    Of a `shape` that is not `complete`, because some members or meshes are wrong, only that is told
    which these cannot change: a train that is blocked without them is blocked with them.
    """
    named: list[Problem] = []
    for name, state in train.states.items():
        named += state_problems(f"states.{name}", state, shape)
    named += _state_choice(train)
    operation = train.operation
    for key in ("input", "output"):
        named += _shaft_problems(f"operation.{key}", getattr(operation, key), shape)
    for key in ("speeds", "torques"):
        for name in getattr(operation, key):
            named += _shaft_problems(f"operation.{key}.{name}", name, shape)
    problems = [
        *named,
        *check_outlet(train.thermal, operation.oil_inlet_temperature),
        *_temperature_problems(train),
        *_oil_model_problems(train),
    ]
    if complete:
        problems += [*_position_problems(train, shape), *lubrication_problems(train)]
    if named:
        return problems
    ends = list(_ends_problems(train, shape, complete))
    return [*problems, *(ends or _freedom_problems(train, shape, complete))]


def _temperature_problems(train: TrainCase) -> list[Problem]:
    """Temperatures follow from losses that are computed, of the whole train."""
    found = [
        Problem(
            f"sets.{name}.models.temperatures",
            written(table.models.temperatures),
            f"is a choice for the whole train, which has {written(train.models.temperatures)}.",
            "Leave it out here, and give models.temperatures of the train.",
        )
        for name, table in train.computed_sets
        if table.models.temperatures not in ("inlet", train.models.temperatures)
    ]
    if train.models.temperatures != "inlet" and not train.computed:
        shown = written(train.models.temperatures)
        allowed = "needs losses that are computed; all sets have given efficiencies."
        remedy = 'Take "inlet", or give sets their gears in place of efficiencies.'
        found.append(Problem("models.temperatures", shown, allowed, remedy))
    return found


def _oil_model_problems(train: TrainCase) -> list[Problem]:
    """Sets that ask for fitted models of an oil that has none; those with a file have told."""
    return [
        replace(problem, key=f"sets.{name}.{problem.key}")
        for name, table in train.computed_sets
        if table.models.oil_model is None
        for problem in check_oil_model(table.models, Path(), train.lubricant)
    ]


def state_problems(key: str, state: StateTable, shape: TrainShape) -> list[Problem]:
    """Brakes and clutches on shafts that are not there, or on one shaft."""
    problems = []
    for number, name in enumerate(state.fixed):
        problems += _shaft_problems(f"{key}.fixed[{number}]", name, shape)
    for number, group in enumerate(state.joined):
        where, shown = f"{key}.joined[{number}]", written(list(group))
        found = [problem for name in group for problem in _shaft_problems(where, name, shape)]
        problems += found
        if len(group) < 2:
            allowed = "must be two or more shafts."
            problems.append(Problem(where, shown, allowed, "Name the shafts that a clutch joins."))
        elif not found:
            shafts = [shape.shaft_of(name) for name in group]
            if len(set(shafts)) < len(shafts):
                twice = next(one for one in shafts if shafts.count(one) > 1)
                allowed = f"joins the shaft {twice} to itself."
                problems.append(Problem(where, shown, allowed, "Name two different shafts."))
    return problems


def _position_problems(train: TrainCase, shape: TrainShape) -> Iterator[Problem]:
    """Positions of gears that there are, and that stand on a shaft."""
    known = [
        f"{name}.{gear}"
        for name, own in shape.sets.items()
        for gear, body in own.bodies.items()
        if body not in own.planets
    ]
    members = [member for names in shape.shafts.values() for member in names]
    for gear in train.positions:
        if gear not in known and gear not in members:
            remedy = did_you_mean(gear, known) or f"Known are: {', '.join(known)}."
            yield Problem(f'positions."{gear}"', "", "is not a gear on a shaft.", remedy)


def _shaft_problems(key: str, name: str, shape: TrainShape) -> list[Problem]:
    if shape.shaft_of(name) is not None:
        return []
    known = [shaft for shaft in shape.shafts if shaft != HOUSING]
    members = [member for names in shape.shafts.values() for member in names]
    remedy = did_you_mean(name, dict.fromkeys([*known, *members]))
    remedy = remedy or f"Known are: {', '.join(known)}."
    return [Problem(key, written(name), "is no shaft and no member of a set.", remedy)]


def _state_choice(train: TrainCase) -> list[Problem]:
    name, known = train.operation.state, list(train.states)
    key = "operation.state"
    if name is None and known:
        allowed = f"is missing; it must be one of {', '.join(known)}."
        return [Problem(key, "", allowed, f'Write state = "{known[0]}".')]
    if name is not None and name not in known:
        if not known:
            allowed = "is no state: the train has none."
            return [Problem(key, written(name), allowed, "Leave it out, or add [states.NAME].")]
        remedy = did_you_mean(name, known) or f"Known are: {', '.join(known)}."
        return [Problem(key, written(name), "is no state of the train.", remedy)]
    return []


def _ends_problems(train: TrainCase, shape: TrainShape, complete: bool) -> Iterator[Problem]:
    """Input and output must be two shafts that can turn."""
    operation = train.operation
    ends = {key: shape.shaft_of(getattr(operation, key)) for key in ("input", "output")}
    groups = [{shape.shaft_of(name) for name in group} for group in train.state.joined]
    if ends["input"] == ends["output"]:
        allowed = "is the input shaft too."
        remedy = "Name another shaft; a train passes power from one shaft to another."
        yield Problem("operation.output", written(operation.output), allowed, remedy)
    held = shape.held(train.state)
    turning = {*shape.turning(train.state), HOUSING}
    for key, shaft in ends.items():
        if complete and shaft not in turning:
            allowed = f"is joined to nothing in {_state_words(train)}: it has no members, and no "
            allowed += "clutch that joins it is closed."
            shown = written(getattr(operation, key))
            yield Problem(f"operation.{key}", shown, allowed, "Close a clutch, or name another.")
            continue
        by_clutch = any(shaft in group and group & set(held) for group in groups)
        if shaft == HOUSING or shaft in held or by_clutch:
            allowed = "stands still, as the housing does."
            if shaft != HOUSING:
                allowed = f"is held by a brake in {_state_words(train)}."
            advice = "Name a shaft that turns, or release it."
            yield Problem(f"operation.{key}", written(getattr(operation, key)), allowed, advice)
    if complete:
        yield from _given_problems(train, shape, ends)


def _given_problems(
    train: TrainCase, shape: TrainShape, ends: Mapping[str, str | None]
) -> Iterator[Problem]:
    """Further speeds and torques: of shafts that turn, each once, and only one of the two."""
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
                allowed = f"cannot be given: nothing is joined to it in {_state_words(train)}."
            elif shaft in seen:
                allowed = f"is given twice: {seen[shaft]} is the same shaft."
            seen[shaft] = name
            if allowed:
                yield Problem(f"operation.{key}.{name}", "", allowed, "Leave it out.")


def _freedom_problems(train: TrainCase, shape: TrainShape, complete: bool) -> list[Problem]:
    """The given speeds must determine all others, and the input must be able to turn."""
    from epicyclic.machine.balance import freedom, implied  # only trains need a machine

    machine = shape.machine(train.state)
    driven = shape.shaft_of(train.operation.input) or ""
    held = shape.held(train.state)
    others = [*held, *(shape.shaft_of(name) or "" for name in train.operation.speeds)]
    if not complete:  # without its members a shaft is no body
        others = [shaft for shaft in others if shaft in machine.bodies]
        if driven not in machine.bodies:
            return []
    found = freedom(machine, driven, others)
    key = "operation.state" if train.states else "shafts"
    shown = written(train.operation.state) if train.states else ""
    problems = []
    if found.blocked:
        means = _means(train.state, held, train.operation.speeds)
        reason = f"blocks the train: the input shaft {driven} cannot turn" + (
            f" with {means}." if means else "."
        )
        remedy = "Release one of these." if means else "Check the shafts: they join too much."
        problems.append(Problem(key, shown, reason, remedy))
    if not complete:
        return problems
    if found.loose:
        names = ", ".join(body for body in found.loose if body in shape.shafts)
        freedoms = found.freedoms
        word = "one" if freedoms == 1 else str(freedoms)
        problems.append(
            Problem(
                key,
                shown,
                f"leaves {word} degree{'s' if freedoms > 1 else ''} of freedom open: the speed of "
                f"{names} is not determined.",
                f"Brake or couple {word} of these shafts more (fixed, joined), or give "
                f"{word} of them a speed in [operation.speeds].",
            )
        )
    further = {shape.shaft_of(name) or "": name for name in train.operation.speeds}
    if not found.loose:
        for shaft in implied(machine, [driven, *held], list(further)):
            allowed = "cannot be given: this speed follows from those of the other shafts."
            key = f"operation.speeds.{further[shaft]}"
            problems.append(Problem(key, "", allowed, "Leave it out."))
    if problems or shape.shaft_of(train.operation.output) in further:
        return problems
    return _standing_output(train, shape, machine, driven, others)


def _standing_output(
    train: TrainCase, shape: TrainShape, machine: Machine, driven: str, others: Sequence[str]
) -> list[Problem]:
    """An output that the input does not turn can balance no torque of it."""
    from epicyclic.machine.balance import speeds_of

    output = train.operation.output
    speeds = speeds_of(machine, dict.fromkeys(others, 0.0) | {driven: 1.0})
    if speeds[shape.shaft_of(output) or ""] != 0:
        return []
    allowed = f"stands still whatever the input shaft {driven} does in {_state_words(train)}, so "
    allowed += "that no power reaches it."
    turning = [shaft for shaft in shape.shafts if speeds[shaft] != 0 and shaft != driven]
    remedy = f"Name a shaft that turns with the input: {', '.join(turning)}."
    if not turning:
        remedy = "Join it to the input."
    return [Problem("operation.output", written(output), allowed, remedy)]


def _state_words(train: TrainCase) -> str:
    name = train.operation.state
    return "this train" if name is None else f"state {name}"


def _means(state: StateTable, held: Sequence[str], speeds: Mapping[str, float]) -> str:
    parts = []
    if held:
        parts.append(f"{', '.join(held)} held")
    if state.joined:
        parts.append(f"{', '.join('+'.join(group) for group in state.joined)} joined")
    if speeds:
        parts.append(f"the speed of {', '.join(speeds)} given")
    return " and ".join(parts)
