"""The train of a REXS file: shafts, bearings, clutches, operation."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.gears.gear import HOUSING
from epicyclic.messages import one_line
from epicyclic.plugins.rexs.draft import (
    Amount,
    Draft,
    amount_text,
    at,
    lubricant_table,
    speed_and_torque,
    speed_of,
    stated_load,
    temperature,
)
from epicyclic.plugins.rexs.gears import file_notes, set_tables
from epicyclic.plugins.rexs.model import (
    IN_MILLIMETRES,
    ROUNDED,
    USUAL_AXIS,
    Component,
    Model,
    vector,
)
from epicyclic.plugins.rexs.sets import Joint, SetParts, Shaft, Train

# Where gears stand along the shafts of a train, and the rolling bearings of the shafts.


BEARING_TYPES = {
    "radial_grooved_ball_bearing": "deep-groove",
    "radial_roller_bearing": "cylindrical",
    "radial_needle_roller_bearing": "needle",
    "radial_tapered_roller_bearing": "tapered",
}
_OPPOSITE = {"positive": "negative", "negative": "positive"}
_ABOUT_FORCE = "Needed for the forces on the bearings; or give their radial_force."
_SUPPORTS = 2  # Bearings of a shaft whose forces statics gives.


def shaft_parts(draft: Draft, model: Model, train: Train) -> None:
    """Tables ``positions`` and ``bearings``, and the directions of pairs."""
    places = _Places(draft, model, train)
    borne = _bearings(draft, model, train, places)
    for name, one in train.sets.items():
        if one.is_pair:
            _pair(draft, train, places, (name, one), borne)


class _Places:
    """Places along the axis about which the input turns forward, however the gear unit stands."""

    def __init__(self, draft: Draft, model: Model, train: Train) -> None:
        self.model = model
        driven = train.shafts.get(str(draft.tables.get("operation", {}).get("input")))
        shafts = driven.components if driven is not None else ()
        every = [*([] if driven is None else [driven]), *train.shafts.values()]
        self.unit_axis = model.axis(
            [part for shaft in every for part in shaft.components],
            (way for shaft in every if (way := self._line(shaft)) is not None),
        )
        self.axis = self.unit_axis
        speed = speed_of(draft, list(driven.parts.values())) if driven is not None else None
        if speed is not None and shafts and speed.number * self.sense(shafts[0]) < 0:
            self.axis = -self.axis
        # y of a gear unit along x, turned with its axis the shortest way
        first = np.array([0.0, 1.0, 0.0])
        if (along := 1 + float(self.axis @ USUAL_AXIS)) > ROUNDED:
            first = first - float(first @ self.axis) / along * (self.axis + USUAL_AXIS)
        self.frame = np.array([first, np.cross(self.axis, first)])

    def _line(self, shaft: Shaft) -> FloatArray | None:
        """From the start of a shaft to the part that is farthest from it. [mm]"""
        parts = [*shaft.components, *shaft.parts.values()]
        points = [it for part in parts if (it := self._point(part)) is not None]
        ways = (point - points[0] for point in points)
        return max(ways, key=lambda way: float(np.linalg.norm(way)), default=None)

    def sense(self, part: Component) -> float:
        """+1 or -1 if a part lies along the axis or against it, 0 across it."""
        own = vector(part, "u_axis_vector")
        along = (self.unit_axis if own is None else own) @ self.axis
        return float(np.sign(np.round(along, 6)))

    def _point(self, part: Component) -> FloatArray | None:
        """Position in the axes of the gear unit. [mm]"""
        found = self.model.place(part)
        return found[1] if found is not None and found[0] is None else None

    def along(self, shaft: Shaft, part: Component) -> Amount | None:
        """Position of a gear or bearing along its shaft."""
        starts = [self._point(own) for own in shaft.components]
        point = self._point(part)
        if point is not None and all(start is not None for start in starts):
            return _amount(float(point @ self.axis), f"support_vector of {part}")
        if len(starts) != 1:
            return None
        on_shaft = self._on_shaft(part)
        if on_shaft is None:
            return None
        number, origin = on_shaft
        start = 0.0 if starts[0] is None else float(starts[0] @ self.axis)
        return _amount(start + self.sense(shaft.components[0]) * number, origin)

    def _on_shaft(self, part: Component) -> tuple[float, str] | None:
        """Position from the start of the shaft, of the middle of a part. [mm]"""
        is_gear = part.get("number_of_teeth") is not None
        name = "u_coordinate_on_shaft" if is_gear else "u_coordinate_on_shaft_inner_side"
        place, width = _millimetres(part, name), _millimetres(part, "face_width")
        if not is_gear or self.model.version != "1.0":
            return None if place is None else (place, f"{name} of {part}")
        if place is None or width is None:
            return None
        return place + width / 2, f"{name} of {part} plus half its face width"

    def direction(self, first: Iterable[Component], second: Iterable[Component]) -> float | None:
        """Angle from the axis of the first to that of the second, about the axis. [deg]"""
        starts = (self._first_point(first), self._first_point(second))
        if starts[0] is None or starts[1] is None:
            return None
        across = self.frame @ (starts[1] - starts[0])
        if float(np.hypot(*across)) < 1e-6:
            return None
        return math.degrees(math.atan2(across[1], across[0]))

    def _first_point(self, parts: Iterable[Component]) -> FloatArray | None:
        return next((point for part in parts if (point := self._point(part)) is not None), None)


def _millimetres(part: Component, name: str) -> float | None:
    """A length of a part; None if it has none that can be read."""
    try:
        found = part.amount(name)
        return None if found is None else found[0] * IN_MILLIMETRES[found[1]]
    except (KeyError, ValueError):
        return None


def _amount(number: float, origin: str) -> Amount:
    return Amount(round(number, 6), "mm", origin)


def _pair(
    draft: Draft, train: Train, places: _Places, named: tuple[str, SetParts], borne: set[str]
) -> None:
    """Positions of the gears of a pair, and where the gear lies from the pinion."""
    name, pair = named
    ends: list[list[Component]] = []
    is_borne = False
    for member, gear in pair.gears.items():
        shaft = next(it for it in train.shafts.values() if f"{name}.{member}" in it.members)
        key = f'positions."{name}.{member}"'
        place = places.along(shaft, gear)
        if place is not None:
            draft.give(key, place.text, place.origin)
        elif shaft.name in borne:
            draft.need(key, "support_vector or u_coordinate_on_shaft", [gear], _ABOUT_FORCE)
        ends.append([*shaft.components, gear])
        is_borne |= shaft.name in borne
    angle = places.direction(*ends)
    key = f"sets.{name}.direction"
    if angle is not None:
        origin = f"computed from support_vector of {ends[0][0]} and {ends[1][0]}"
        draft.give(key, f"{angle:z.6f} deg", origin)
    elif is_borne:
        draft.lack(key, "support_vector", [end[0] for end in ends], "Default: 0 deg.")


def _bearings(draft: Draft, model: Model, train: Train, places: _Places) -> set[str]:
    """The bearings of the shafts; the shafts whose bearings need forces."""
    by_shaft: dict[str, dict[str, str]] = {}
    still = draft.tables.get("shafts", {}).get(HOUSING, ())
    for name, joint in train.bearings.items():
        ends = _ends(draft, model, train, joint, still)
        if ends is not None:
            by_shaft.setdefault(ends[0], {})[name] = ends[1]
    borne: set[str] = set()
    for shaft, own in by_shaft.items():
        if any(_has_size(train.bearings[name].component) for name in own):
            for name, against in own.items():
                _bearing(draft, train, places, name, (shaft, against))
            _supports(draft, train, train.shafts[shaft], list(own))
            borne.add(shaft)
        else:
            for name in own:
                attribute = "bore and outside diameter (inner_diameter, outer_diameter)"
                bearing = train.bearings[name].component
                draft.lack(f"bearings.{name}", attribute, [bearing], "Its loss is left out.")
    return borne


def _ends(
    draft: Draft, model: Model, train: Train, joint: Joint, still: Sequence[str]
) -> tuple[str, str] | None:
    """The shaft in the bore and what holds the outer ring; None for bearings of no shaft here."""
    names = []
    for side in (joint.inner, joint.outer):
        shaft = train.shaft_of(side)
        is_casing = model.components[side].type == "gear_casing"
        if shaft is None and not is_casing:
            draft.notes.append(f"{joint.component} is not on a shaft of the train and is left out.")
            return None
        held = shaft is None or set(shaft.members) <= set(still)
        names.append(HOUSING if held else shaft.name if shaft is not None else "")
    inner, outer = names
    if inner == outer:
        return None
    return (outer, inner) if inner == HOUSING else (inner, outer)


def _has_size(bearing: Component) -> bool:
    sizes = ("inner_diameter", "outer_diameter")
    return bearing.type.startswith("rolling_bearing") and all(map(bearing.get, sizes))


def _bearing(
    draft: Draft, train: Train, places: _Places, name: str, between: tuple[str, str]
) -> None:
    bearing = train.bearings[name].component
    shaft, against = between
    key = f"bearings.{name}"
    draft.give(f"{key}.shaft", shaft, "relation side")
    if against != HOUSING:
        draft.give(f"{key}.against", against, "relation side")
    kind = _type(draft, key, bearing)
    draft.take(f"{key}.bore", "inner_diameter", [bearing])
    draft.take(f"{key}.outside_diameter", "outer_diameter", [bearing])
    for inner, attribute in (
        ("width", "width"),
        ("dynamic_load_rating", "radial_dynamic_load_rating"),
        ("static_load_rating", "radial_static_load_rating"),
    ):
        draft.take(f"{key}.{inner}", attribute, [bearing], None)
    if kind == "tapered":
        hint = "Or give contact_angle."
        if draft.take(f"{key}.axial_factor", "axial_factor_y_2", [bearing], None) is None:
            draft.need(f"{key}.axial_factor", "axial_factor_y_2", [bearing], hint)
    if kind != "needle":
        _locating(draft, key, bearing, places.sense(bearing))
    place = places.along(train.shafts[shaft], bearing)
    if place is None:
        attribute = "support_vector or u_coordinate_on_shaft_inner_side"
        draft.need(f"{key}.position", attribute, [bearing], _ABOUT_FORCE)
    else:
        draft.give(f"{key}.position", place.text, place.origin)


def _type(draft: Draft, key: str, bearing: Component) -> str | None:
    stated = bearing.get("bearing_type")
    kind = None if stated is None else BEARING_TYPES.get(stated.text())
    if stated is not None and kind is not None:
        draft.give(f"{key}.type", kind, f"bearing_type {stated.text()} of {bearing}")
    else:
        shown = "" if stated is None else f" that is covered ({stated.text()} is not)"
        hint = f"Choose a type, or remove the bearing: {key}=."
        draft.need(f"{key}.type", f"bearing_type{shown}", [bearing], hint)
    return kind


def _locating(draft: Draft, key: str, bearing: Component, sense: float) -> None:
    """Whether a bearing takes axial forces, and in which sense."""
    name = "axial_force_absorption"
    stated = bearing.get(name)
    text = "" if stated is None else stated.text()
    if stated is None or text not in ("no_direction", "both_directions", *_OPPOSITE):
        instead = (
            "Default: it takes no axial force, unless it is the first on a shaft without "
            "locating bearing."
        )
        draft.lack(f"{key}.locating", name, [bearing], instead)
        return
    origin = f"{name} {text} of {bearing}"
    draft.give(f"{key}.locating", text != "no_direction", origin)
    if text in _OPPOSITE:
        draft.give(f"{key}.axial_sense", text if sense >= 0 else _OPPOSITE[text], origin)


def _supports(draft: Draft, train: Train, shaft: Shaft, names: Sequence[str]) -> None:
    """Statics gives the forces of two bearings: the outermost ones, if there are more.

    A single one is enough for gears that planets stand around.
    """
    owners = [train.sets[member.partition(".")[0]] for member in shaft.members]
    is_pushed = any(one.is_pair for one in owners)
    tables = draft.tables["bearings"]

    def place(name: str) -> float:
        text = tables[name].get("position")
        return 0.0 if text is None else float(text.split()[0])

    ordered = sorted(names, key=place)
    alone = ordered if len(names) == 1 and is_pushed else []
    for name in ordered[1:-1] if len(names) > _SUPPORTS else alone:
        hint = f"Statics gives the forces of only two bearings; {shaft.name} has {len(names)}."
        draft.need(f"bearings.{name}.radial_force", "force that is read here", [], hint)


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
    hint = f"Nothing joins {apart}. Name the members that turn together in [shafts]."
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
        draft.notes.append(f"{driven} is used as the input; {others} also has a load.")
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
    return f"The shafts of a single set are {', '.join(ends)}." if ends else ""


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
    stated = [part for part in marked if part.is_true("defines_speed")]
    return stated if marked else shaft.components


_OTHER_STAGES = ("bevel_stage", "worm_stage")
_HELIX = "helix_angle_reference_diameter"


def train_draft(model: Model, train: Train) -> Draft:
    """What the file says of a train, and what it lacks."""
    draft = Draft({"kind": "train", "title": one_line(train.unit.name.strip())})
    train_operation(draft, model, train)
    for name, one in train.sets.items():
        own = Draft({})
        set_tables(own, model, one, f"sets.{name}.")
        _hand(own, one)
        own.notes += file_notes(one)
        draft.adopt(own, name)
    shaft_parts(draft, model, train)
    stages = [mesh.stage for mesh in train.meshes]
    _temperature(draft, model, stages)
    lubricant_table(draft, model, stages)
    draft.notes += _notes(model, train)
    return draft


def _hand(draft: Draft, one: SetParts) -> None:
    """Hand of the helix of the sun or pinion: positive angles are right-handed, ISO 21771."""
    gear = next(iter(one.gears.values()))
    helix = draft.read(_HELIX, [gear])
    if helix is not None and helix.number != 0:
        draft.give("hand", "right" if helix.number > 0 else "left", f"sign of {helix.origin}")


def _temperature(draft: Draft, model: Model, stages: Sequence[Component]) -> None:
    """Temperature of the oil: that of the first stage, if they differ."""
    name, key = "temperature_lubricant", "operation.oil_inlet_temperature"
    stated = [found for stage in stages if (found := draft.read(name, [stage], key)) is not None]
    if len({found.text for found in stated}) < 2:
        temperature(draft, model, stages)
        return
    draft.give(key, stated[0].text, stated[0].origin)
    draft.notes.append(f"The stages have different {name}; that of the first is used.")


def _notes(model: Model, train: Train) -> Iterator[str]:
    """Stages that are left out; gears that stand in two sets."""
    for kind in _OTHER_STAGES:
        for stage in model.of_type(kind)[:4]:
            yield f"{stage} is left out: cylindrical and planetary stages can be read."
    counts = Counter(
        gear.id
        for one in train.sets.values()
        for name, gear in one.gears.items()
        if name != "planet"
    )
    for number, count in counts.items():
        if count > 1:
            yield f"{model.components[number]} appears in {count} sets, with its drag in each."
