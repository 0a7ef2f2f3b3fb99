"""Keys of one case: those of its schema, with names that the user chose; changes of them."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from pydantic import BaseModel

from epicyclic.case.tables.models import has_rough_flanks
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import InputError, Problem
from epicyclic.gears.sizing import Found
from epicyclic.messages import did_you_mean, dotted, key_parts, value_at, written
from epicyclic.oil.oil import BOUNDARY_FRICTION
from epicyclic.schema.fields import (
    Table,
    all_keys,
    bounds_of,
    dict_value,
    find_field,
    is_continuous,
    locate,
    quantity_of,
)
from epicyclic.schema.read import flattened, plain, split_key, with_unit_of_key, with_value, without
from epicyclic.schema.validation import unknown_key

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
        return Problem(key, "", "is not a continuous number.", "Name a key that is.")
    if key in varied:
        return Problem(key, "", "is given by a column of the table.", "Fit another key.")
    stated = value_of(case, key)
    value = _of_oil(case, key) if stated is None else stated
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


def _of_oil(case: BaseModel, key: str) -> float | None:
    """The boundary friction that a case leaves to the additives of its oil."""
    models = value_of(case, key.rpartition(".")[0])
    own = key.endswith("models.boundary_friction") and has_rough_flanks(models)
    lubricant = getattr(case, "lubricant", None)
    return BOUNDARY_FRICTION[lubricant.oil.additives].value if own and lubricant else None


def no_start(key: str, what: str) -> Problem:
    allowed = f"{what}; varying it needs a value to start from."
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


# Changes of single keys, as `--set` and sweeps make them.


class Changes(NamedTuple):
    """Tables with some keys changed."""

    tables: dict[str, Any]
    problems: list[Problem]  # Of keys that cannot be changed.
    replaced: tuple[Found, ...]  # Keys that were removed, because a changed one excludes them.


def with_changes(kind: type[Table], tables: dict[str, Any], changes: Mapping[str, Any]) -> Changes:
    """`tables` with some dotted keys changed, and without those that these exclude."""
    problems: list[Problem] = []
    stated = []
    seen = set()
    for key, value in changes.items():
        own, unit = split_key(str(key))
        if own in seen:
            allowed = f"{own} is changed already, in another unit."
            problems.append(Problem(str(key), written(value), allowed, "Give it once."))
        seen.add(own)
        try:
            new = plain(with_unit_of_key(value, unit))
            tables = _changed(kind, tables, own, new)
        except InputError as error:
            problems += [replace(problem, key=str(key)) for problem in error.problems]
        else:
            leaves = flattened(new, f"{own}.") if isinstance(new, dict) else [(own, new)]
            stated += [tuple(key_parts(leaf)) for leaf, _ in leaves]
    replaced = []
    for path in stated:
        for other in [] if value_at(tables, path) is None else _excluded(kind, tables, path):
            if not any(one[: len(other)] == other for one in stated):
                former = f"replaces {dotted(other)} = {written(value_at(tables, other))}."
                replaced.append(Found(dotted(path), written(value_at(tables, path)), former))
                tables = without(tables, other)
    return Changes(tables, problems, tuple(replaced))


_SUMP = ("thermal", "oil_volume")
"""The same volume as lubrication.oil_volume."""


def _excluded(
    kind: type[Table], tables: dict[str, Any], path: Sequence[str]
) -> Iterator[tuple[str, ...]]:
    """Keys of `tables` that cannot stand beside the one at `path`, which is complete by itself."""
    for depth, name in enumerate(path):
        owner = _owner(kind, tuple(path[: depth + 1]))
        if owner is None:
            continue
        given = value_at(tables, path[:depth]) or {}
        for group in (*owner.EXACTLY_ONE, *owner.AT_MOST_ONE, *owner.REPLACING):
            choices = [keys.split("+") for keys in group]
            if any(name in keys and given.keys() >= set(keys) for keys in choices):
                others = (key for keys in choices if name not in keys for key in keys)
                yield from ((*path[:depth], key) for key in others if key in given)
    if tuple(path[-2:]) == ("lubrication", "oil_volume") and value_at(tables, _SUMP) is not None:
        yield _SUMP


@lru_cache(maxsize=256)
def _owner(kind: type[Table], path: tuple[str, ...]) -> type[Table] | None:
    """The table that holds a key."""
    owner = locate(kind, path).owner
    return owner if owner is not None and issubclass(owner, Table) else None


def _changed(kind: type[Table], tables: dict[str, Any], key: str, value: Any) -> dict[str, Any]:
    """`tables` with dotted `key` set to `value`, or removed if that is None."""
    path = key_parts(key)
    if problem := owner_without_keys(tables, key):
        raise InputError([replace(problem, value=written(value))])
    if value is not None:
        return with_value(tables, path, value)
    if value_at(tables, path) is not None:
        return without(tables, path)
    if find_field(kind, key) is None:
        raise InputError([unknown_key(locate(kind, path), None, kind)])
    return tables
