"""Where gears stand along the shafts of a train, and the rolling bearings of the shafts."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from epicyclic.elements.base import HOUSING
from epicyclic.exchange.rexs.draft import Amount, Draft
from epicyclic.exchange.rexs.model import Component, Model
from epicyclic.exchange.rexs.operation import speed_of
from epicyclic.exchange.rexs.sets import Joint, Pair
from epicyclic.exchange.rexs.trains import Shaft, Train

FloatArray = NDArray[np.float64]

_TYPES = {
    "radial_grooved_ball_bearing": "deep-groove",
    "radial_roller_bearing": "cylindrical",
    "radial_needle_roller_bearing": "needle",
    "radial_tapered_roller_bearing": "tapered",
}
_SENSES = {"both_directions": "both", "positive": "positive", "negative": "negative"}
_OPPOSITE = {"both": "both", "positive": "negative", "negative": "positive"}
_ABOUT_FORCE = "Needed for the force on the bearings; or give their radial_force."
_SHORTEST, _FARTHEST = 1e-6, 1e8
"""Bounds of the length of an axis vector and of the coordinates of parts. [mm]"""

_SUPPORTS = 2
"""Bearings of a shaft whose forces statics gives."""


def shaft_parts(draft: Draft, model: Model, train: Train) -> None:
    """Tables ``positions`` and ``bearings``, and the directions of pairs."""
    places = _Places(draft, model, train)
    borne = _bearings(draft, model, train, places)
    for name, one in train.sets.items():
        if isinstance(one, Pair):
            _pair(draft, train, places, (name, one), borne)


# --- places ---------------------------------------------------------------------------------------


class _Places:
    """Places in the axes of the gear unit, along the axis about which the input turns forward."""

    def __init__(self, draft: Draft, model: Model, train: Train) -> None:
        self.model = model
        units = model.of_type("gear_unit")
        axis = _vector(units[0], "u_axis_vector") if units else None
        length = 0.0 if axis is None else float(np.linalg.norm(axis))
        usual = np.array([1.0, 0.0, 0.0])
        self.unit_axis = axis / length if axis is not None and length > _SHORTEST else usual
        self.axis = self.unit_axis
        driven = train.shafts.get(str(draft.tables.get("operation", {}).get("input")))
        speed = speed_of(draft, list(driven.parts.values())) if driven is not None else None
        shafts = driven.components if driven is not None else ()
        if speed is not None and shafts and speed.number * self.sense(shafts[0]) < 0:
            self.axis = -self.axis
        across = np.eye(3)[int(np.argmin(np.abs(self.axis)))]
        second = np.cross(self.axis, across)
        self.frame = np.array([np.cross(second, self.axis), second])

    def sense(self, part: Component) -> float:
        """+1 or -1 if a part lies along the axis or against it, 0 across it."""
        own = _vector(part, "u_axis_vector")
        along = (self.unit_axis if own is None else own) @ self.axis
        return float(np.sign(np.round(along, 6)))

    def _point(self, part: Component) -> FloatArray | None:
        """Position in the axes of the gear unit. [mm]"""
        reference = part.get("reference_component_for_position")
        try:
            number = None if reference is None else int(reference.number())
        except ValueError:
            return None
        owner = self.model.components.get(number) if number is not None else None
        in_unit = number is None or (owner is not None and owner.type == "gear_unit")
        return _vector(part, "support_vector") if in_unit else None

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
        try:
            found = part.amount(name)
            width = part.amount("face_width")
        except ValueError:
            return None
        if found is None or found[1] != "mm":
            return None
        if is_gear and self.model.version == "1.0":
            if width is None or width[1] != "mm":
                return None
            return found[0] + width[0] / 2, f"{name} of {part} plus half its face width"
        return found[0], f"{name} of {part}"

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


def _vector(part: Component, name: str) -> FloatArray | None:
    found = part.get(name)
    try:
        numbers = found.numbers() if found is not None else ()
    except ValueError:
        return None
    is_place = len(numbers) == 3 and max(map(abs, numbers)) < _FARTHEST
    return np.array(numbers) if is_place else None


def _amount(number: float, origin: str) -> Amount:
    return Amount(round(number, 6), "mm", origin)


def _pair(
    draft: Draft, train: Train, places: _Places, named: tuple[str, Pair], borne: set[str]
) -> None:
    """Positions of the gears of a pair, and where the gear lies from the pinion."""
    name, pair = named
    for member, gear in (("pinion", pair.pinion), ("gear", pair.gear)):
        shaft = train.shaft_of(gear.id)
        key = f'positions."{name}.{member}"'
        place = places.along(shaft, gear) if shaft is not None else None
        if place is not None:
            draft.give(key, place.text, place.origin)
        elif shaft is not None and shaft.name in borne:
            draft.need(key, "support_vector or u_coordinate_on_shaft", [gear], _ABOUT_FORCE)
    shafts = [train.shaft_of(gear.id) for gear in (pair.pinion, pair.gear)]
    ends = [
        [*(shaft.components if shaft is not None else ()), gear]
        for shaft, gear in zip(shafts, (pair.pinion, pair.gear), strict=True)
    ]
    angle = places.direction(*ends)
    key = f"sets.{name}.direction"
    if angle is not None:
        origin = f"computed from support_vector of {ends[0][0]} and {ends[1][0]}"
        draft.give(key, f"{angle:.6f} deg", origin)
    elif any(shaft is not None and shaft.name in borne for shaft in shafts):
        draft.lack(key, "support_vector", [end[0] for end in ends], "Default: 0 deg.")


# --- bearings -------------------------------------------------------------------------------------


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
            draft.notes.append(f"{joint.component} is on no shaft of the train and is left out.")
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
    """The table of one bearing."""
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
    kind = None if stated is None else _TYPES.get(stated.text())
    if stated is not None and kind is not None:
        draft.give(f"{key}.type", kind, f"bearing_type {stated.text()} of {bearing}")
    else:
        shown = "" if stated is None else f" that is covered ({stated.text()} is not)"
        hint = f"Choose a type, or take the bearing out: {key}=."
        draft.need(f"{key}.type", f"bearing_type{shown}", [bearing], hint)
    return kind


def _locating(draft: Draft, key: str, bearing: Component, sense: float) -> None:
    """Whether a bearing takes axial forces, and in which sense."""
    name = "axial_force_absorption"
    stated = bearing.get(name)
    text = "" if stated is None else stated.text()
    if stated is None or (text not in _SENSES and text != "no_direction"):
        instead = "Default: it takes no axial force unless it is the first of a shaft without."
        draft.lack(f"{key}.locating", name, [bearing], instead)
        return
    origin = f"{name} {text} of {bearing}"
    draft.give(f"{key}.locating", text in _SENSES, origin)
    if text in ("positive", "negative"):
        held = _SENSES[text] if sense >= 0 else _OPPOSITE[text]
        draft.give(f"{key}.axial_sense", held, origin)


def _supports(draft: Draft, train: Train, shaft: Shaft, names: Sequence[str]) -> None:
    """Statics gives the forces of two bearings: the outermost ones, if there are more.

    A single one is enough for gears that planets stand around.
    """
    owners = [train.sets[member.partition(".")[0]] for member in shaft.members]
    is_pushed = any(isinstance(one, Pair) for one in owners)
    tables = draft.tables["bearings"]

    def place(name: str) -> float:
        text = tables[name].get("position")
        return 0.0 if text is None else float(text.split()[0])

    ordered = sorted(names, key=place)
    alone = ordered if len(names) == 1 and is_pushed else []
    for name in ordered[1:-1] if len(names) > _SUPPORTS else alone:
        hint = f"Statics gives the forces of two bearings; {shaft.name} has {len(names)}."
        draft.need(f"bearings.{name}.radial_force", "force that is read here", [], hint)
