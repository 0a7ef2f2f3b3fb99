"""Tables of a file, and what the schema says about a key: unit, choices, range, place.

Tables are frozen, without unknown keys, with values over axes.
"""

from __future__ import annotations

import types
import typing
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from typing import Annotated, Any, ClassVar, TypeVar

from annotated_types import Ge, Gt, Le
from pydantic import BaseModel, ConfigDict, Discriminator, Field, GetJsonSchemaHandler, Tag
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema

from epicyclic.dataclass import dataclass
from epicyclic.messages import either, key_parts
from epicyclic.units import Quantity, describe_range


@dataclass(frozen=True, slots=True)
class Named:
    """Marks a table that may also be given by name."""

    names: Callable[[], tuple[str, ...]]  # The names.
    allowed: Callable[[], str]  # What is allowed, in words.
    short: type[BaseModel] | None = None  # Another form of the table, of a few keys.

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        forms = [{"enum": list(self.names())}, handler(schema)]
        if self.short is not None:
            forms.append(self.short.model_json_schema())
        return {"anyOf": forms}


def _leaves(annotation: Any, metadata: Sequence[Any] = ()) -> Iterator[tuple[Any, Sequence[Any]]]:
    """The types within optional, union, array and annotated ones, each with its metadata."""
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is typing.Annotated:
        yield from _leaves(arguments[0], (*metadata, *arguments[1:]))
    elif origin in (types.UnionType, typing.Union, tuple):
        for argument in arguments:
            yield from _leaves(argument, metadata)
    elif origin is dict:
        yield from _leaves(arguments[1], metadata)
    else:
        yield annotation, metadata


def quantity_of(annotation: Any, metadata: Sequence[Any] = ()) -> Quantity | None:
    """The `Quantity` of an annotation, through optional and tuple types; None for plain types."""
    items = (item for _, items in _leaves(annotation, metadata) for item in items)
    return next((item for item in items if isinstance(item, Quantity)), None)


def choices_of(annotation: Any) -> tuple[str, ...]:
    """The values a choice key may take; empty for other keys."""
    literals = (it for it, _ in _leaves(annotation) if typing.get_origin(it) is typing.Literal)
    return tuple(str(value) for literal in literals for value in typing.get_args(literal))


def bounds_of(
    annotation: Any, metadata: Sequence[Any] = ()
) -> tuple[float | None, float | None, bool]:
    """Bounds of a number without dimension, and whether the lower one itself is left out."""
    kinds = [items for kind, items in _leaves(annotation, metadata) if kind is not type(None)]
    found: list[Any] = []
    for item in kinds[0] if len(kinds) == 1 else ():
        found += item.metadata if isinstance(item, FieldInfo) else [item]
    low = next((item for item in found if isinstance(item, Ge | Gt)), None)
    high: Any = next((item.le for item in found if isinstance(item, Le)), None)
    lowest: Any = low.gt if isinstance(low, Gt) else low and low.ge
    return lowest, high, isinstance(low, Gt)


def table_of(annotation: Any) -> type[BaseModel] | None:
    """The table class of an annotation, the first one of several; None if there is none."""
    return next(tables_in(annotation), None)


def tables_in(annotation: Any) -> Iterator[type[BaseModel]]:
    """The table classes of an annotation, through optional, union and array types."""
    leaves = (kind for kind, _ in _leaves(annotation))
    return (it for it in leaves if isinstance(it, type) and issubclass(it, BaseModel))


def dict_value(annotation: Any) -> Any:
    """Type of the values of a table whose keys are the user's names; None for others."""
    for member in _members(annotation):
        if typing.get_origin(member) is dict:
            return typing.get_args(member)[1]
    return None


def is_text(annotation: Any) -> bool:
    """True for keys that hold any text, such as a name that the user chose."""
    members = list(_members(annotation))
    return str in members and set(members) <= {str, type(None)}


def is_named(metadata: Sequence[Any]) -> bool:
    """True for tables that may also be given by name."""
    return any(isinstance(item, Named) for item in metadata)


def describe(annotation: Any, metadata: Sequence[Any] = ()) -> str:
    """What a key may hold, in words: ``"a whole number >= 5 and <= 2000"``."""
    for item in metadata:
        if isinstance(item, Named):
            return item.allowed()
    members = [member for member in _members(annotation) if member is not type(None)]
    member = members[0] if members else annotation
    if typing.get_origin(member) is tuple:
        first = typing.get_args(member)[0]
        return f"an array, each entry {describe(first)}"
    if dict_value(annotation) is not None:
        return "a table of names"
    if table_of(member) is not None:
        return "a table of keys"
    quantity = quantity_of(annotation, metadata)
    if quantity is not None:
        return quantity.describe()
    choices = choices_of(annotation)
    if choices:
        return either([f'"{choice}"' for choice in choices])
    if member in (int, float):
        low, high, is_open = bounds_of(annotation, metadata)
        noun = "a whole number" if member is int else "a number"
        return describe_range(noun, low, high, open_low=is_open)
    return {bool: "true or false", str: "text"}.get(member, "another kind of value")


def find_field(table: type[BaseModel], key: str) -> tuple[Any, tuple[Any, ...]] | None:
    """Annotation and metadata of the field at dotted `key`; None if there is no such key."""
    place = locate(table, key_parts(key))
    return None if place.annotation is None else (place.annotation, place.metadata)


@cache
def all_keys(table: type[BaseModel]) -> tuple[str, ...]:
    """Every dotted key below `table` that holds a value, in the order of the schema."""
    found: list[str] = []
    for name, field in table.model_fields.items():
        inner = table_of(field.annotation)
        named = "" if dict_value(field.annotation) is None else "NAME."
        found += [name] if inner is None else [f"{name}.{named}{key}" for key in all_keys(inner)]
    return tuple(found)


@dataclass(frozen=True, slots=True)
class Place:
    """Where a value stands in the schema."""

    path: tuple[str | int, ...]  # Keys and numbers of array entries that lead to it.
    annotation: Any  # Type of the value; None if the schema has no such key.
    metadata: tuple[Any, ...]  # Metadata of the value.
    # The table that holds the key, or should; None if there is no table there.
    owner: type[BaseModel] | None


def locate(table: type[BaseModel], location: Sequence[str | int]) -> Place:
    """The place at `location` below `table`, which may name the branches of unions on the way."""
    path: list[str | int] = []
    annotation: Any = table
    metadata: tuple[Any, ...] = ()
    owner: type[BaseModel] | None = table
    for part in location:
        named = dict_value(annotation)
        if named is not None:
            path.append(part)
            annotation, metadata, owner = named, (), None
            continue
        branch = _branch(annotation, part)
        if branch is not None:
            annotation, metadata = branch, ()
            continue
        path.append(part)
        if isinstance(part, int):
            annotation, metadata = entry_of(annotation, part), ()
            continue
        owners = list(tables_in(annotation))
        owners.sort(key=lambda one: part not in one.model_fields)
        owner = owners[0] if owners else None
        field = owner.model_fields.get(part) if owner is not None else None
        annotation = None if field is None else field.annotation
        metadata = () if field is None else tuple(field.metadata)
    return Place(tuple(path), annotation, metadata, owner)


def _members(annotation: Any) -> Iterator[Any]:
    """The members of a union, or `annotation` itself, without their metadata."""
    is_union = typing.get_origin(annotation) in (types.UnionType, typing.Union)
    for member in typing.get_args(annotation) if is_union else (annotation,):
        is_annotated = typing.get_origin(member) is typing.Annotated
        yield typing.get_args(member)[0] if is_annotated else member


def entry_of(annotation: Any, number: int = 0) -> Any:
    """Type of one entry of an array; None if `annotation` is no array."""
    for member in _members(annotation):
        if typing.get_origin(member) is tuple:
            types_ = typing.get_args(member)
            return types_[0] if types_[-1] is Ellipsis else types_[min(number, len(types_) - 1)]
    return None


def _branch(annotation: Any, name: str | int) -> Any:
    """The member of a union that goes by `name` in an error's location; None if none does."""
    for member in (annotation, *typing.get_args(annotation)):
        items = getattr(member, "__metadata__", ())  # of an annotated one
        if any(isinstance(item, Tag) and item.tag == name for item in items):
            return typing.get_args(member)[0]
    tables = list(tables_in(annotation))
    if len(tables) > 1:
        for table in tables:
            if any(name in choices_of(field.annotation) for field in table.model_fields.values()):
                return table
    return None


def to_inputs(table: BaseModel) -> dict[str, Any]:
    """`table` as the tables of a case file again, every dimensional value as text with its unit.

    Keys that were not given appear with their defaults; keys without a value are left out.
    """
    return {
        name: _to_input(value, quantity)
        for name, quantity in _quantities(type(table)).items()
        if (value := getattr(table, name)) is not None
    }


@cache
def _quantities(table: type[BaseModel]) -> dict[str, Quantity | None]:
    """The quantity of every field of a table."""
    return {
        name: quantity_of(field.annotation, tuple(field.metadata))
        for name, field in table.model_fields.items()
    }


def _to_input(value: Any, quantity: Quantity | None) -> Any:
    if isinstance(value, BaseModel):
        return to_inputs(value)
    if isinstance(value, dict):
        return {name: _to_input(item, quantity) for name, item in value.items()}
    if isinstance(value, tuple):
        return [_to_input(item, quantity) for item in value]
    if quantity is not None and isinstance(value, float):
        return quantity.exact_text(value)
    return value


def is_continuous(field: tuple[Any, tuple[Any, ...]], quantity: Quantity | None) -> bool:
    """True for keys that hold a number which does not count."""
    annotation = field[0]
    if entry_of(annotation) or annotation is int or table_of(annotation) is not None:
        return False
    return quantity is not None or any(kind is float for kind, _ in _leaves(annotation))


def option(description: str | None, default: Any = None, **limits: Any) -> Any:
    """The field of a key with a default, which is stated as a file has it, with its unit."""
    return Field(default=default, description=description, **limits)


class Table(BaseModel):
    """Base of all tables: immutable, no unknown keys.

    ``EXACTLY_ONE`` lists groups of alternatives of which a file gives exactly one; an alternative
    of several keys, joined by ``+``, needs all of them. Of the groups in ``AT_MOST_ONE`` a file may
    give none. A change of one key of a group replaces the others; so it does in the groups of
    ``REPLACING``, of which checks across keys tell what a file states twice.

    ``STAND_INS`` are keys on which no check across tables depends. If such a key cannot be used,
    the checks go on with the value given here (None: with the default).

    ``SHOWN_BY`` is the command that shows the keys of a whole file.
    """

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        validate_default=True,
        allow_inf_nan=False,
        defer_build=True,  # a case of one kind builds no tables of the others
    )
    EXACTLY_ONE: ClassVar[tuple[tuple[str, ...], ...]] = ()
    AT_MOST_ONE: ClassVar[tuple[tuple[str, ...], ...]] = ()
    REPLACING: ClassVar[tuple[tuple[str, ...], ...]] = ()
    STAND_INS: ClassVar[dict[str, object]] = {}
    SHOWN_BY: ClassVar[str] = "'epicyclic init'"

    def __repr_args__(self) -> Iterable[tuple[str, Any]]:
        """Keys with their values as a file has them, with units."""
        return to_inputs(self).items()

    def __dir__(self) -> list[str]:
        """Keys, and what this package adds to them: not what Pydantic does."""
        own = {name for name in super().__dir__() if not name.startswith("_") and name.islower()}
        return sorted(own - set(dir(BaseModel)) | set(type(self).model_fields))


class PointsTable(Table):
    """Base of tables with values over some of the ``AXES``."""

    AXES: ClassVar[tuple[str, ...]]

    def axes(self) -> dict[str, tuple[float, ...]]:
        """The axes given, by name."""
        given = {name: getattr(self, name) for name in self.AXES}
        return {name: points for name, points in given.items() if points is not None}


def _values_or_rows(value: object) -> str:
    """Which of its two forms a list of numbers has."""
    rows = isinstance(value, list | tuple) and any(isinstance(row, list | tuple) for row in value)
    return "rows" if rows else "values"


Item = TypeVar("Item")
ValuesOrRows = Annotated[
    Annotated[tuple[Item, ...], Tag("values")]
    | Annotated[tuple[tuple[Item, ...], ...], Tag("rows")],
    Discriminator(_values_or_rows),
]
"""A value, or a row of them, for each point of the first axis of a table."""
