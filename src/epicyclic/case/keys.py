"""Keys of one case: those of its schema, with the names that the user chose in it."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel

from epicyclic.errors import Problem
from epicyclic.messages import did_you_mean, dotted, key_parts, value_at, written
from epicyclic.schema.fields import (
    all_keys,
    bounds_of,
    dict_value,
    find_field,
    is_continuous,
    quantity_of,
)

_UNCERTAINTY = "uncertainty."
_GEARS, _MEMBERS = "gears", "members"
"""Key of the gears of a listed set in a file, and in its table, which has the shared keys apart."""


def field_at(case: BaseModel, key: str) -> tuple[Any, tuple[Any, ...]] | None:
    """Annotation and metadata of the field at dotted `key`; None if there is no such key.

    A key of a set of a train is one of the form that the set has: with computed losses or given
    ones, and with gears as they are.
    """
    parts = key_parts(key)
    sets = getattr(case, "sets", None)  # a train has them
    if sets is None or parts[0] != "sets" or len(parts) < 3:
        return find_field(type(case), key)
    table = sets.get(parts[1])
    if table is None:
        return None
    return find_field(type(table), ".".join(_in_table(table, parts[2:])))


def known_keys(case: BaseModel) -> list[str]:
    """Every dotted key that may hold a value of the case, to suggest one for a key that is none.

    Not those of [uncertainty], whose names are such keys themselves.
    """
    return [key for key in _keys(case, "") if not key.startswith(_UNCERTAINTY)]


def value_of(case: BaseModel, key: str) -> Any:
    """The value at dotted `key`; None if there is none."""
    value: Any = case
    parts = key_parts(key)
    while parts:
        if isinstance(value, BaseModel):
            parts = _in_table(value, parts)
            value = getattr(value, parts[0], None)
        else:
            value = value.get(parts[0]) if isinstance(value, dict) else None
        parts = parts[1:]
    return value


def _in_table(table: BaseModel, parts: list[str]) -> list[str]:
    """The parts of a key of a set as its table has them."""
    members = getattr(table, _MEMBERS, None)
    if members is None or len(parts) < 2 or parts[0] != _GEARS or parts[1] not in members:
        return parts
    return [_MEMBERS, *parts[1:]]


def _keys(table: BaseModel, prefix: str) -> Iterator[str]:
    for name, about in type(table).model_fields.items():
        value = getattr(table, name)
        shown = f"{prefix}{_GEARS if name == _MEMBERS else name}"
        if isinstance(value, BaseModel):
            yield from _keys(value, f"{shown}.")
        elif isinstance(value, dict):
            for item, inner in value.items():
                own = f"{shown}.{dotted([item])}"
                if isinstance(inner, BaseModel):
                    yield from _keys(inner, f"{own}.")
                else:
                    yield own
        elif dict_value(about.annotation) is None:
            yield from (
                f"{prefix}{key}" for key in all_keys(type(table)) if key.partition(".")[0] == name
            )


# Keys of one case that hold a continuous number: their values and bounds.

OFF_OPEN_BOUND = 1e-6
"""Distance kept from a bound that is no value itself, over that of the start value. [1]"""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A key of the case that is fitted."""

    key: str  # Dotted key of the case.
    unit: str  # Display unit; empty for pure numbers.
    start: float  # Value in the case, in `unit`.
    low: float  # Bounds of the schema, in `unit`.
    high: float
    # Keys that it multiplies, with their values in the case; empty if it is a key itself.
    factors: Mapping[str, float] = field(default_factory=dict)

    @property
    def ends(self) -> tuple[float, float]:
        """The bounds over the start value, rising. [1]"""
        one, other = sorted((self.low / self.start, self.high / self.start))
        return one, other

    def value(self, scaled: float) -> Any:
        """The value at `scaled`, the ratio to the start value, as a case file has it."""
        number = min(max(scaled * self.start, self.low), self.high)
        return f"{number!r} {self.unit}" if self.unit else number

    def settings(self, scaled: float) -> dict[str, Any]:
        """The keys that it sets at `scaled`."""
        if self.factors:
            return {key: scaled * self.start * start for key, start in self.factors.items()}
        return {self.key: self.value(scaled)}


def parameter_of(case: BaseModel, key: str, varied: Collection[str] = ()) -> Parameter | Problem:
    """A key that holds a number, or why it cannot be varied continuously."""
    found = field_at(case, key)
    if found is None:
        remedy = did_you_mean(key, known_keys(case)) or "See 'epicyclic init' for keys."
        return Problem(key, "", "is not a known key.", remedy)
    quantity = quantity_of(*found)
    if not is_continuous(found, quantity):
        return Problem(key, "", "is not a continuous number.", "Fit a key that is.")
    if key in varied:
        return Problem(key, "", "is given by a column of the table.", "Fit another key.")
    value = value_of(case, key)
    if value is None:
        return no_start(key, "has no value in the case")
    if quantity is None:
        start, unit = float(value), ""
        lowest, highest, is_open = bounds_of(*found)
    else:
        start, unit = quantity.to_display(value), quantity.display
        lowest, highest, is_open = quantity.low, quantity.high, quantity.open_low
    low = -math.inf if lowest is None else float(lowest)
    high = math.inf if highest is None else float(highest)
    if is_open:
        low += OFF_OPEN_BOUND * (start - low)
    return Parameter(key, unit, start, low, high)


def no_start(key: str, what: str) -> Problem:
    allowed = f"{what}; it needs one, about which it is varied."
    return Problem(key, "", allowed, f'Add --set "{key}=...".')


def owner_without_keys(tables: Mapping[str, Any], key: str) -> Problem | None:
    """Why `tables` have no place for a key: what should hold it is not a table, but a name."""
    path = key_parts(key)
    for depth in range(1, len(path)):
        owner = value_at(tables, path[:depth])
        if owner is not None and not isinstance(owner, dict):
            name = ".".join(path[:depth])
            allowed = f"{name} is {written(owner)}, which has no keys."
            return Problem(key, "", allowed, f"Change {name} to a table first.")
    return None
