"""How the train of a REXS file runs: clutches and brakes, who drives, who is driven."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from epicyclic.elements.base import HOUSING
from epicyclic.exchange.rexs.draft import Amount, Draft, amount_text, at
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.operation import speed_and_torque, speed_of, stated_load
from epicyclic.exchange.rexs.trains import Shaft, Train

_LOAD = "external_load"


def train_operation(draft: Draft, model: Model, train: Train) -> None:
    """Tables ``shafts``, ``states`` and ``operation``, but for the temperature of the oil."""
    still = {name: at([shaft.held]) for name, shaft in train.shafts.items() if shaft.held}
    closed = _states(draft, model, train)
    braked = {name for pair in closed or () if HOUSING in pair for name in pair}
    free = {
        name: shaft
        for name, shaft in train.shafts.items()
        if name not in still and name not in braked
    }
    driven = _input(draft, free)
    _output(draft, train, free, driven)
    shafts = [part for shaft in free.values() for part in shaft.components]
    if driven is None:
        speed_and_torque(draft, [], shafts)
    else:
        own = free[driven]
        speed_and_torque(draft, list(own.parts.values()), own.components or shafts)
    if closed is not None:
        still |= _further_speeds(draft, train, free, driven, closed)
    _shafts(draft, train, still)
    _whole(draft, train)


def _shafts(draft: Draft, train: Train, still: Mapping[str, str]) -> None:
    """What turns together, and what stands still."""
    held = [member for name in still for member in train.shafts[name].members]
    for name, shaft in train.shafts.items():
        if shaft.is_listed and name not in still:
            parts = shaft.components or tuple(shaft.parts.values())
            draft.give(f"shafts.{name}", list(shaft.members), at(parts))
    if held:
        draft.give(f"shafts.{HOUSING}", held, ", ".join(dict.fromkeys(still.values())))


def _whole(draft: Draft, train: Train) -> None:
    """Note it if sets have no shaft in common with the others."""
    pieces = train.pieces()
    if len(pieces) < 2:
        return
    loose = [part for shaft in train.shafts.values() if not shaft.components
             for part in shaft.parts.values()]  # fmt: skip
    apart = " and ".join(", ".join(piece) for piece in pieces)
    hint = f"Nothing joins {apart}: name what turns together in [shafts]."
    draft.need("shafts", "relation assembly with a shaft, or coupling of shafts,", loose, hint)


def _states(draft: Draft, model: Model, train: Train) -> list[tuple[str, str]] | None:
    """What clutches and brakes join in each position.

    Returns the pairs of the position that is chosen, None if the file does not say which.
    """
    positions: list[tuple[bool, ...]] = []
    for switch in train.switches:
        engaged = switch.component.get("is_engaged")
        assert engaged is not None
        try:
            positions.append(engaged.flags())
        except ValueError as error:
            draft.wrong("states", engaged, switch.component, str(error))
            return None
    if not positions:
        return []
    count = max(map(len, positions))
    origin = f"is_engaged of {at([switch.component for switch in train.switches])}"
    states = [_closed(train, positions, number) for number in range(count)]
    for number, closed in enumerate(states, start=1):
        fixed = [one if two == HOUSING else two for one, two in closed if HOUSING in (one, two)]
        joined = [list(pair) for pair in closed if HOUSING not in pair]
        draft.give(f"states.{number}", {"fixed": fixed, "joined": joined}, origin)
    units = model.of_type("gear_unit")
    index = draft.read("gear_shift_index", units, "operation.state")
    chosen = index.number if index is not None else 1.0 if count == 1 else 0.0
    if not (1 <= chosen <= count and chosen.is_integer()):
        draft.lack("operation.state", f"gear_shift_index from 1 to {count}", units)
        return None
    draft.give("operation.state", f"{chosen:.0f}", index.origin if index else "the only one")
    return states[int(chosen) - 1]


def _closed(
    train: Train, positions: Sequence[tuple[bool, ...]], number: int
) -> list[tuple[str, str]]:
    """What is joined in a position, each pair of shafts once."""
    closed = (
        switch.shafts
        for switch, engaged in zip(train.switches, positions, strict=True)
        if number < len(engaged) and engaged[number]
    )
    return list(dict.fromkeys(closed))


def _input(draft: Draft, free: Mapping[str, Shaft]) -> str | None:
    """The shaft whose load states torque or power; of several one that power enters."""
    loaded = {name: origin for name in free if (origin := stated_load(free[name].loads))}
    if not loaded:
        shafts = [part for shaft in free.values() for part in shaft.components]
        attribute = f"{_LOAD} with torque_around_u_axis or power"
        draft.need("operation.input", attribute, shafts, _choices(free))
        return None
    driving = [name for name in loaded if _power_enters(draft, free[name])]
    known = [name for name in loaded if speed_of(draft, list(free[name].parts.values()))]
    driven = next(iter([*driving, *known, *loaded]))
    if len(loaded) > 1:
        others = ", ".join(origin for name, origin in loaded.items() if name != driven)
        draft.notes.append(f"{driven} is taken as the input; a load is stated by {others} too.")
    draft.give("operation.input", driven, loaded[driven])
    return driven


def _power_enters(draft: Draft, shaft: Shaft) -> bool:
    """True if speed and torque of a shaft have the same sense."""
    speed = speed_of(draft, list(shaft.parts.values()))
    torques = [draft.read("torque_around_u_axis", [load]) for load in shaft.loads]
    total = sum(torque.number for torque in torques if torque is not None)
    return speed is not None and speed.number * total > 0


def _output(draft: Draft, train: Train, free: Mapping[str, Shaft], driven: str | None) -> None:
    """The shaft whose torque balances: the other one with a load; torques of further ones."""
    others = {name: shaft for name, shaft in free.items() if name != driven and shaft.loads}
    open_ones = [name for name, shaft in others.items() if not stated_load(shaft.loads)]
    ends = list(others) if len(others) == 1 else open_ones
    if len(ends) != 1 or driven is None:
        left = {name: shaft for name, shaft in free.items() if name != driven}
        attribute = f"{_LOAD} on one shaft that is driven"
        draft.need("operation.output", attribute, [], _choices(left))
        return
    draft.give("operation.output", ends[0], at(others[ends[0]].loads))
    sense = _sense(draft, train.shafts[driven])
    torques: dict[str, Amount] = {}
    for name, shaft in others.items():
        if name != ends[0]:
            torque = draft.read("torque_around_u_axis", shaft.loads, "operation.torques")
            if torque is not None:
                torques[name] = torque
    _give_all(draft, "operation.torques", torques, sense)


def _choices(shafts: Mapping[str, Shaft]) -> str:
    """The shafts that could be meant; those with one gear first."""
    ends = [name for name, shaft in shafts.items() if len(shaft.members) == 1]
    return f"Shafts of one set only are {', '.join(ends)}." if ends else ""


def _sense(draft: Draft, shaft: Shaft) -> float:
    """Sense of rotation of the input in the file; in the case it is positive."""
    speed = speed_of(draft, list(shaft.parts.values()))
    return 1.0 if speed is None else math.copysign(1.0, speed.number)


def _further_speeds(
    draft: Draft,
    train: Train,
    free: Mapping[str, Shaft],
    driven: str | None,
    closed: Iterable[tuple[str, str]],
) -> dict[str, str]:
    """Speeds of further shafts if the input alone does not determine all.

    Returns the shafts that stand still, each with what says so.
    """
    joined = sum(1 for pair in closed if HOUSING not in pair)
    open_ones = len(free) - joined - len(train.sets) - 1
    if open_ones < 1:
        return {}
    stated = {
        name: speed
        for name, shaft in free.items()
        if name != driven and (speed := speed_of(draft, _definers(shaft))) is not None
    }
    sense = 1.0 if driven is None else _sense(draft, free[driven])
    taken = dict(list(stated.items())[:open_ones])
    still = {name: speed.origin for name, speed in taken.items() if speed.number == 0}
    turning = {name: speed for name, speed in taken.items() if name not in still}
    _give_all(draft, "operation.speeds", turning, sense)
    lacking = open_ones - len(stated)
    if lacking > 0 and len(train.pieces()) == 1:
        more = f"coupling to a gear_casing, or speed of {lacking} more shaft(s),"
        hint = f"Give a speed, or hold one: {', '.join(free)}."
        draft.need("operation.speeds", more, [], hint)
    return still


def _give_all(draft: Draft, key: str, amounts: Mapping[str, Amount], sense: float) -> None:
    """A table of amounts by shafts, if there are any."""
    if amounts:
        table = {name: amount_text(sense * one.number, one.unit) for name, one in amounts.items()}
        draft.give(key, table, ", ".join(one.origin for one in amounts.values()))


def _definers(shaft: Shaft) -> Sequence[Component]:
    """Parts of a shaft whose speed is one that the user set, if the file tells which are."""
    marked = [part for part in shaft.components if part.get("defines_speed") is not None]
    return [part for part in marked if _is_true(part)] if marked else shaft.components


def _is_true(part: Component) -> bool:
    defines = part.get("defines_speed")
    return defines is not None and defines.text().lower() == "true"
