"""What the schema says about one key: its unit, its choices, its text form."""

from __future__ import annotations

import types
import typing
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from epicyclic.units import Quantity

__all__ = ["choices_of", "find_field", "quantity_of", "to_inputs"]


def quantity_of(annotation: Any, metadata: tuple[Any, ...] = ()) -> Quantity | None:
    """The `Quantity` of an annotation, through optional and tuple types; None for plain types."""
    for item in metadata:
        if isinstance(item, Quantity):
            return item
    if typing.get_origin(annotation) is typing.Annotated:
        inner, *items = typing.get_args(annotation)
        return quantity_of(inner, tuple(items))
    for argument in _arguments(annotation):
        found = quantity_of(argument)
        if found is not None:
            return found
    return None


def choices_of(annotation: Any) -> tuple[str, ...]:
    """The values a choice key may take; empty for other keys."""
    if typing.get_origin(annotation) is typing.Literal:
        return tuple(str(value) for value in typing.get_args(annotation))
    return tuple(name for argument in _arguments(annotation) for name in choices_of(argument))


def table_of(annotation: Any) -> type[BaseModel] | None:
    """The table class of an annotation, through optional and annotated types."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    if typing.get_origin(annotation) is typing.Annotated:
        return table_of(typing.get_args(annotation)[0])
    for argument in _arguments(annotation):
        found = table_of(argument)
        if found is not None:
            return found
    return None


def _arguments(annotation: Any) -> Iterator[Any]:
    if typing.get_origin(annotation) in (types.UnionType, typing.Union, tuple):
        yield from typing.get_args(annotation)


def find_field(table: type[BaseModel], key: str) -> tuple[Any, tuple[Any, ...]] | None:
    """Annotation and metadata of the field at dotted `key`; None if there is no such key."""
    name, _, rest = key.partition(".")
    field = table.model_fields.get(name)
    if field is None:
        return None
    if not rest:
        return field.annotation, tuple(field.metadata)
    inner = table_of(field.annotation)
    return find_field(inner, rest) if inner is not None else None


def to_inputs(table: BaseModel) -> dict[str, Any]:
    """`table` as the tables of a case file again, every dimensional value as text with its unit.

    Keys that were not given appear with their defaults; keys without a value are left out.
    """
    inputs: dict[str, Any] = {}
    for name, field in type(table).model_fields.items():
        value = getattr(table, name)
        if value is None:
            continue
        quantity = quantity_of(field.annotation, tuple(field.metadata))
        inputs[name] = _to_input(value, quantity)
    return inputs


def _to_input(value: Any, quantity: Quantity | None) -> Any:
    if isinstance(value, BaseModel):
        return to_inputs(value)
    if isinstance(value, tuple):
        return [_to_input(item, quantity) for item in value]
    if quantity is not None and isinstance(value, float):
        return quantity.text(value, digits=12)
    return value
