"""What the schema says about the keys of a case, and how messages show keys and values."""

from __future__ import annotations

import math
import re
import types
import typing
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from annotated_types import Ge, Gt, Le
from pydantic import BaseModel, GetJsonSchemaHandler, Tag
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticCustomError
from rapidfuzz import fuzz, process
from rapidfuzz.distance import OSA

from epicyclic.errors import InputError, Problem, printable
from epicyclic.units import Quantity, describe_range

# Texts of messages: keys and values as a case file has them, and names that were meant.


_LONGEST_SHOWN = 60  # Text that users wrote is cut to this many characters in messages.

_DEEPEST = 20  # Dots of a key; tables of a case are nested a few levels deep.


def dotted(path: Sequence[str | int]) -> str:
    """A path as users write it: ``lubricant.oil.density[1].value``."""
    text = ""
    for part in path:
        if isinstance(part, int):
            text += f"[{part}]"
        else:
            bare = part.isascii() and part.replace("-", "").replace("_", "").isalnum()
            text += ("." if text else "") + (part if bare else f'"{one_line(part)}"')
    return text


def path_of(key: str) -> tuple[str | int, ...]:
    """The path of a key as `dotted` writes it."""
    parts = re.findall(r'"[^"]*"|[^.\[\]]+', key)
    return tuple(int(part) if part.isdecimal() else part.strip('"') for part in parts)


def key_parts(key: str) -> list[str]:
    """The names of a dotted key; one in quotes may have dots: ``positions."S1.pinion"``.

    Raises `InputError` if it has more names than any key of a case.
    """
    if key.count(".") > _DEEPEST:
        allowed = f"is not a key: it has more than {_DEEPEST} dots."
        raise InputError([Problem(one_line(key), "", allowed, "Correct it.")])
    if '"' not in key:
        return key.split(".")
    return [part.strip('"') for part in re.findall(r'"[^"]*"|[^.]+', key)]


def written(value: Any) -> str:
    """`value` as a case file has it, cut to one short line."""
    text = _written(value)
    is_short = isinstance(value, str) or len(text) <= _LONGEST_SHOWN
    return text if is_short else f"{text[:_LONGEST_SHOWN]}..."


def one_line(text: str, longest: int = _LONGEST_SHOWN) -> str:
    """`text` on one line, without control characters, cut to the `longest` that is shown."""
    shown = printable(" ".join(text[: 2 * longest].split()))
    is_cut = len(shown) > longest or len(text) > 2 * longest
    return f"{shown[:longest]}..." if is_cut else shown


def _written(value: Any) -> str:
    if isinstance(value, str):
        return f'"{one_line(value)}"'
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int) and abs(value) >= 10**_LONGEST_SHOWN:
        return "a whole number of many digits"
    if isinstance(value, Mapping):
        return (
            f"{{{_joined(f'{one_line(key)} = {_written(item)}' for key, item in value.items())}}}"
        )
    if isinstance(value, tuple | list):
        return f"[{_joined(map(_written, value))}]"
    return one_line(str(value))


def _joined(parts: Iterator[str]) -> str:
    """The parts, as many as a message shows."""
    text = ""
    for part in parts:
        text += f", {part}" if text else part
        if len(text) > _LONGEST_SHOWN:
            break
    return text


def sentence(text: str, *, capital: bool = True) -> str:
    """`text` with a full stop, and with a capital letter at its start unless told otherwise."""
    start = text[:1].upper() if capital else text[:1]
    return f"{start}{text[1:]}" + ("" if text.endswith((".", "?")) else ".")


def refused(error: PydanticCustomError, key: str, given: str) -> Problem:
    """The problem of a value that its quantity refuses."""
    remedy = str((error.context or {}).get("remedy", ""))
    return Problem(key, given, sentence(error.message(), capital=False), sentence(remedy))


def millimetres(value: float) -> str:
    """A length in metres as text for a message."""
    return f"{value * 1e3:.5g} mm"


def micrometres(value: float) -> str:
    """A small length in metres as text for a message."""
    return f"{value * 1e6:.3g} um"


# Suggestions for misspelt names.

_LIKENESS = 60.0  # Smallest likeness, in percent, at which a name is worth suggesting.

_MOST_SLIPS = 2  # Letters left out, added, changed or swapped in a name that is still clear.

_LONGEST = 60  # No name is longer, and longer text is not compared. [characters]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """``"Did you mean 'sun'?"``, or nothing if no known name is near."""
    if len(name) > _LONGEST:
        return ""
    found = process.extractOne(name, list(known), scorer=_likeness, score_cutoff=_LIKENESS)
    return f"Did you mean {found[0]!r}?" if found else ""


def misspelt(name: str, known: Iterable[str]) -> str:
    """The known name that `name` can only be a misspelling of; empty if there is none."""
    slips = {
        other: OSA.distance(name.casefold(), other.casefold(), score_cutoff=_MOST_SLIPS)
        for other in known
        if len(name) <= _LONGEST
    }
    nearest = min(slips, key=slips.__getitem__, default="")
    clear = nearest and slips[nearest] <= min(_MOST_SLIPS, len(name) // 3)
    return nearest if clear else ""


def _likeness(name: str, known: str, *, score_cutoff: float | None = None) -> float:
    """In percent; a name that is part of another one is somewhat like it."""
    one, two = name.casefold(), known.casefold()
    score = fuzz.ratio(one, two, score_cutoff=score_cutoff)
    partly = min(len(one), len(two)) > 3 and (one in two or two in one)
    return max(score, _LIKENESS + 10) if partly else score


# What the schema says about a key: its unit, choices, range and place; the keys of one case.


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
    return (kind for kind, _ in _leaves(annotation) if _is_table(kind))


def dict_value(annotation: Any) -> Any:
    """Type of the values of a table whose keys are the user's names; None for others."""
    for member in map(_without_metadata, _members(annotation)):
        if typing.get_origin(member) is dict:
            return typing.get_args(member)[1]
    return None


def is_whole_number(annotation: Any) -> bool:
    """True for keys that count."""
    return annotation is int


def is_text(annotation: Any) -> bool:
    """True for keys that hold any text, such as a name that the user chose."""
    members = [_without_metadata(member) for member in _members(annotation)]
    return str in members and set(members) <= {str, type(None)}


def is_array(annotation: Any) -> bool:
    """True for keys that hold several values."""
    members = map(_without_metadata, _members(annotation))
    return any(typing.get_origin(member) is tuple for member in members)


def is_named(metadata: Sequence[Any]) -> bool:
    """True for tables that may also be given by name."""
    return any(isinstance(item, Named) for item in metadata)


def describe(annotation: Any, metadata: Sequence[Any] = ()) -> str:
    """What a key may hold, in words: ``"a whole number >= 5 and <= 2000"``."""
    for item in metadata:
        if isinstance(item, Named):
            return item.allowed()
    members = [member for member in _members(annotation) if member is not type(None)]
    member = _without_metadata(members[0]) if members else annotation
    if typing.get_origin(member) is tuple:
        first = typing.get_args(member)[0]
        return f"an array, each entry {describe(first)}"
    if dict_value(annotation) is not None:
        return "a table of names"
    if _is_table(member):
        return "a table of keys"
    quantity = quantity_of(annotation, metadata)
    if quantity is not None:
        return quantity.describe()
    choices = choices_of(annotation)
    if choices:
        quoted = [f'"{choice}"' for choice in choices]
        return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"
    if member in (int, float):
        low, high, is_open = bounds_of(annotation, metadata)
        noun = "a whole number" if member is int else "a number"
        return describe_range(noun, low, high, open_low=is_open)
    return {bool: "true or false", str: "text"}.get(member, "another kind of value")


def find_field(table: type[BaseModel], key: str) -> tuple[Any, tuple[Any, ...]] | None:
    """Annotation and metadata of the field at dotted `key`; None if there is no such key."""
    place = locate(table, key_parts(key))
    return None if place.annotation is None else (place.annotation, place.metadata)


def all_keys(table: type[BaseModel], prefix: str = "") -> Iterator[str]:
    """Every dotted key below `table` that holds a value, in the order of the schema."""
    return (f"{prefix}{key}" for key in _keys_below(table))


@cache
def _keys_below(table: type[BaseModel]) -> tuple[str, ...]:
    found: list[str] = []
    for name, field in table.model_fields.items():
        inner = table_of(field.annotation)
        named = "" if dict_value(field.annotation) is None else "NAME."
        found += [name] if inner is None else all_keys(inner, f"{name}.{named}")
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
    """The members of a union, or `annotation` itself."""
    if typing.get_origin(annotation) in (types.UnionType, typing.Union):
        yield from typing.get_args(annotation)
    else:
        yield annotation


def _without_metadata(annotation: Any) -> Any:
    return typing.get_args(annotation)[0] if _is_annotated(annotation) else annotation


def _is_annotated(annotation: Any) -> bool:
    return typing.get_origin(annotation) is typing.Annotated


def _is_table(annotation: Any) -> bool:
    return isinstance(annotation, type) and issubclass(annotation, BaseModel)


def entry_of(annotation: Any, number: int = 0) -> Any:
    """Type of one entry of an array; None if `annotation` is no array."""
    for member in map(_without_metadata, _members(annotation)):
        if typing.get_origin(member) is tuple:
            types_ = typing.get_args(member)
            return types_[0] if types_[-1] is Ellipsis else types_[min(number, len(types_) - 1)]
    return None


def _branch(annotation: Any, name: str | int) -> Any:
    """The member of a union that goes by `name` in an error's location; None if none does."""
    for member in _members(annotation):
        items = typing.get_args(member)[1:] if _is_annotated(member) else ()
        if any(isinstance(item, Tag) and item.tag == name for item in items):
            return _without_metadata(member)
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


# Keys of one case: those of its schema, with the names that the user chose in it.

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

    @property
    def ends(self) -> tuple[float, float]:
        """The bounds over the start value, rising. [1]"""
        one, other = sorted((self.low / self.start, self.high / self.start))
        return one, other

    def value(self, scaled: float) -> Any:
        """The value at `scaled`, the ratio to the start value, as a case file has it."""
        number = min(max(scaled * self.start, self.low), self.high)
        return f"{number!r} {self.unit}" if self.unit else number


def parameter_of(case: BaseModel, key: str, varied: Collection[str] = ()) -> Parameter | Problem:
    """A key that holds a number, or why it cannot be varied continuously."""
    field = field_at(case, key)
    if field is None:
        remedy = did_you_mean(key, known_keys(case)) or "See 'epicyclic init' for keys."
        return Problem(key, "", "is not a known key.", remedy)
    quantity = quantity_of(*field)
    if not is_continuous(field, quantity):
        return Problem(key, "", "is not a continuous number.", "Fit a key that is.")
    if key in varied:
        return Problem(key, "", "is given by a column of the table.", "Fit another key.")
    value = value_of(case, key)
    if value is None:
        return no_start(key, "has no value in the case")
    if quantity is None:
        start, unit = float(value), ""
        lowest, highest, is_open = bounds_of(*field)
    else:
        start, unit = quantity.to_display(value), quantity.display
        lowest, highest, is_open = quantity.low, quantity.high, quantity.open_low
    low = -math.inf if lowest is None else float(lowest)
    high = math.inf if highest is None else float(highest)
    if is_open:
        low += OFF_OPEN_BOUND * (start - low)
    return Parameter(key, unit, start, low, high)


def is_continuous(field: tuple[Any, tuple[Any, ...]], quantity: Quantity | None) -> bool:
    """True for keys that hold a number which does not count."""
    annotation = field[0]
    if is_array(annotation) or is_whole_number(annotation) or table_of(annotation) is not None:
        return False
    return quantity is not None or any(kind is float for kind, _ in _leaves(annotation))


def no_start(key: str, what: str) -> Problem:
    allowed = f"{what}; it needs one, about which it is varied."
    return Problem(key, "", allowed, f'Add --set "{key}=...".')
