"""Keys of one case: those of its schema, with the names that the user chose in it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from epicyclic.case.fields import all_keys, dict_value, find_field
from epicyclic.case.wording import dotted, key_parts

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
    for name, field in type(table).model_fields.items():
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
        elif dict_value(field.annotation) is None:
            yield from (
                f"{prefix}{key}" for key in all_keys(type(table)) if key.partition(".")[0] == name
            )
