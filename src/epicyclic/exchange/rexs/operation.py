"""The operating point of a REXS file: who drives, who is held, torque and speed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from epicyclic.exchange.rexs.draft import Amount, Draft, amount_text
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.sets import Pair, PlanetarySet, fixed_by, rigid_parts

_WATTS = {"W": 1.0, "kW": 1e3}


def planetary_operation(draft: Draft, model: Model, planetary: PlanetarySet) -> None:
    """Input and fixed member, or two members of given speed; torque and speed of the input."""
    members = {
        name: rigid_parts(model, [*planetary.shafts[name], *own])
        for name, own in (("sun", [planetary.sun]), ("ring", [planetary.ring]), ("carrier", []))
    }
    shafts = {name: planetary.shafts[name] for name in members}
    joints = {name: fixed_by(model, parts) for name, parts in members.items()}
    fixed = next((name for name, joint in joints.items() if joint is not None), None)
    if fixed is not None:
        draft.give("operation.fixed", fixed, f"{joints[fixed]} to the casing")
    free = {name: parts for name, parts in members.items() if name != fixed}
    member = _driven_by_load(draft, free)
    if member is None:
        every = [shaft for name in free for shaft in shafts[name]]
        draft.lack("operation.input", "external_load with torque_around_u_axis or power", every)
        speed_and_torque(draft, [], every)
    else:
        speed_and_torque(draft, members[member], shafts[member])
    if fixed is None and not _second_speed(draft, members, member):
        draft.lack("operation.fixed", "coupling to a gear_casing, or speed of a second member,", [])


def _second_speed(
    draft: Draft, members: Mapping[str, Sequence[Component]], member: str | None
) -> bool:
    """The speed of a member beside the input; one that stands still is the fixed one."""
    own = None if member is None else speed_of(draft, members[member])
    for name, parts in members.items():
        speed = None if name == member else speed_of(draft, parts)
        if own is None or speed is None:
            continue
        if speed.number == 0:
            draft.give("operation.fixed", name, speed.origin)
        else:
            sense = math.copysign(1.0, own.number)  # the speed of the input is its magnitude
            value = amount_text(sense * speed.number, speed.unit)
            draft.give("operation.second_input", name, speed.origin)
            draft.give("operation.second_speed", value, speed.origin)
        return True
    return False


def pair_operation(draft: Draft, model: Model, pair: Pair) -> None:
    """Torque and speed of the pinion."""
    shafts = model.partners(pair.pinion.id, "assembly", "part", "assembly", "shaft")
    parts = rigid_parts(model, [pair.pinion, *shafts])
    gears = [part for part in parts if part.type in ("cylindrical_gear", "ring_gear")]
    loads = parts if len(gears) == 1 else [item for item in parts if item.type != "external_load"]
    speed_and_torque(draft, loads, shafts)


def _driven_by_load(draft: Draft, members: Mapping[str, Sequence[Component]]) -> str | None:
    """The member with the load that states torque or power; sun before ring before carrier."""
    for name, parts in members.items():
        origin = stated_load(parts)
        if origin:
            draft.give("operation.input", name, origin)
            return name
    return None


def stated_load(parts: Sequence[Component]) -> str:
    """Which torque or power of a load on `parts` is stated and not zero; nothing if none is."""
    for load in parts:
        for attribute in ("torque_around_u_axis", "power"):
            stated = load.type == "external_load" and load.get(attribute)
            if stated and _nonzero(load, attribute):
                return f"{attribute} of {load}"
    return ""


def _nonzero(load: Component, attribute: str) -> bool:
    try:
        amount = load.amount(attribute)
    except ValueError:
        return True  # told when the value is read
    return amount is not None and amount[0] != 0.0


def speed_of(draft: Draft, parts: Sequence[Component]) -> Amount | None:
    """Speed of the first part that has one; all turn together."""
    turning = [part for part in parts if part.get("rotational_speed") is not None]
    return draft.read("rotational_speed", turning[:1], "operation.speed")


def _torque(draft: Draft, loads: Sequence[Component]) -> Amount | None:
    """Sum of the torques of all loads of a member."""
    name, key = "torque_around_u_axis", "operation.torque"
    found = [amount for load in loads if (amount := draft.read(name, [load], key)) is not None]
    if len({amount.unit for amount in found}) != 1:
        return None
    origin = " plus ".join(amount.origin for amount in found)
    return Amount(sum(amount.number for amount in found), found[0].unit, origin)


def speed_and_torque(draft: Draft, parts: Sequence[Component], shafts: Sequence[Component]) -> None:
    """Speed as a magnitude; torque positive if power flows in, as far as the file tells."""
    key = "operation.speed"
    speed = speed_of(draft, parts)
    if speed is None:
        draft.lack(key, "rotational_speed", shafts)
    else:
        draft.give(key, amount_text(abs(speed.number), speed.unit), speed.origin)
    loads = [part for part in parts if part.type == "external_load"]
    torque = _torque(draft, loads)
    if torque is not None:
        backward = speed is not None and torque.number * speed.number < 0
        sense = " (against the speed: power flows out here)" if backward else ""
        if speed is None:
            sense = " (its magnitude, as driving: without a speed the sign tells nothing)"
        sign = -1.0 if backward else 1.0
        draft.give(
            "operation.torque",
            amount_text(sign * abs(torque.number), torque.unit),
            torque.origin + sense,
        )
        return
    power = draft.read("power", loads, "operation.torque")
    if power and speed and speed.number and power.unit in _WATTS and speed.unit == "rpm":
        watts = power.number * _WATTS[power.unit]
        torque_value = watts / (abs(speed.number) * math.pi / 30)
        draft.give(
            "operation.torque",
            amount_text(float(f"{torque_value:.12g}"), "N*m"),
            f"computed: {power.origin} over the speed",
        )
        return
    stated = f" ({power.origin} is {power.text})" if power is not None else ""
    draft.lack("operation.torque", f"torque_around_u_axis{stated}", loads or shafts)
