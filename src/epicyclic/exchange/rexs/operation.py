"""The operating point of a REXS file: who drives, who is held, torque and speed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from epicyclic.exchange.rexs.draft import Draft, amount_text
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.sets import Pair, PlanetarySet, fixed_by, rigid_parts

__all__ = ["pair_operation", "planetary_operation"]

_WATTS = {"W": 1.0, "kW": 1e3}


def planetary_operation(draft: Draft, model: Model, planetary: PlanetarySet) -> None:
    """Input and fixed member, torque and speed of the input."""
    members = {
        name: rigid_parts(model, [*planetary.shafts[name], *own])
        for name, own in (
            ("sun", [planetary.sun]), ("ring", [planetary.ring]), ("carrier", []),
        )
    }  # fmt: skip
    shafts = {name: planetary.shafts[name] for name in members}
    fixed = None
    for name, parts in members.items():
        joint = fixed_by(model, parts)
        if joint is not None:
            fixed = name
            draft.give("operation.fixed", name, f"{joint} to the casing")
            break
    else:
        everything = [shaft for found in shafts.values() for shaft in found]
        draft.lack("operation.fixed", "coupling to a gear_casing", everything[:1])
    free = {name: parts for name, parts in members.items() if name != fixed}
    member = _driven_by_load(draft, free)
    if member is None:
        every = [shaft for name in free for shaft in shafts[name]]
        draft.lack("operation.input", "external_load with torque_around_u_axis or power", every)
        _speed_and_torque(draft, [], every)
        return
    _speed_and_torque(draft, members[member], shafts[member])


def pair_operation(draft: Draft, model: Model, pair: Pair) -> None:
    """Torque and speed of the pinion."""
    shafts = model.partners(pair.pinion.id, "assembly", "part", "assembly", "shaft")
    parts = rigid_parts(model, [pair.pinion, *shafts])
    gears = [part for part in parts if part.type in ("cylindrical_gear", "ring_gear")]
    loads = parts if len(gears) == 1 else [item for item in parts if item.type != "external_load"]
    _speed_and_torque(draft, loads, shafts)


def _driven_by_load(draft: Draft, members: Mapping[str, Sequence[Component]]) -> str | None:
    """The member with the load that states torque or power; sun before ring before carrier."""
    for name, parts in members.items():
        for load in parts:
            for attribute in ("torque_around_u_axis", "power"):
                stated = load.type == "external_load" and load.get(attribute)
                if stated and _nonzero(load, attribute):
                    draft.give("operation.input", name, f"{attribute} of {load}")
                    return name
    return None


def _nonzero(load: Component, attribute: str) -> bool:
    try:
        amount = load.amount(attribute)
    except ValueError:
        return True  # told when the value is read
    return amount is not None and amount[0] != 0.0


def _speed_and_torque(
    draft: Draft, parts: Sequence[Component], shafts: Sequence[Component]
) -> None:
    """Speed as a magnitude; torque positive if power flows in, as far as the file tells."""
    key = "operation.speed"
    turning = [part for part in parts if part.get("rotational_speed") is not None]
    speed = draft.read("rotational_speed", turning, key)
    if speed is None:
        draft.lack(key, "rotational_speed", shafts)
    else:
        draft.give(key, amount_text(abs(speed.number), speed.unit), speed.origin)
    loads = [part for part in parts if part.type == "external_load"]
    torque = draft.read("torque_around_u_axis", loads, "operation.torque")
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
            "operation.torque", amount_text(float(f"{torque_value:.12g}"), "N*m"),
            f"computed: {power.origin} over the speed",
        )  # fmt: skip
        return
    stated = f" ({power.origin} is {power.text})" if power is not None else ""
    draft.lack("operation.torque", f"torque_around_u_axis{stated}", loads or shafts)
