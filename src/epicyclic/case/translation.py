"""Errors of the schema, told in the user's terms: what is allowed and what to change."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any

from annotated_types import Gt
from pydantic import BaseModel
from pydantic_core import ErrorDetails

from epicyclic.case.fields import (
    Named,
    Place,
    bounds_of,
    choices_of,
    describe,
    locate,
    quantity_of,
    table_of,
    tables_in,
)
from epicyclic.case.nearest import did_you_mean
from epicyclic.case.wording import dotted, sentence, written
from epicyclic.errors import Problem
from epicyclic.units import format_number, range_remedy

_PLAIN_NUMBER = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(%?)\s*")

_OUT_OF_RANGE = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
_OWN = ("quantity", "preset", "oil")
_WRONG_TAG = ("union_tag_invalid", "union_tag_not_found")

_REMEDIES = {
    "bool_type": "write true or false, without quotes",
    "finite_number": "give a finite number",
    "string_type": "put it in quotes",
    "tuple_type": "write it in square brackets, with commas between the entries",
}


def translate(table: type[BaseModel], detail: ErrorDetails) -> Problem:
    """What pydantic found wrong in a case of kind `table`, as a problem of the user's.

    Unknown keys are left to `unknown_key`.
    """
    place = locate(table, detail["loc"])
    kind = detail["type"]
    if kind == "missing":
        return _missing(place)
    key, given = dotted(place.path), written(detail["input"])
    context = detail.get("ctx", {})
    if kind in _OWN:
        remedy = str(context.get("remedy", "correct these values"))
        return Problem(key, given, sentence(detail["msg"], capital=False), sentence(remedy))
    if kind in _WRONG_TAG:
        return _wrong_tag(place, detail)
    allowed = describe(place.annotation, place.metadata)
    if kind in ("too_short", "too_long"):
        limit = context.get("min_length", context.get("max_length"))
        bound = "at least" if kind == "too_short" else "at most"
        remedy = f"give {bound} {limit} {'entry' if limit == 1 else 'entries'}"
        allowed = f"{allowed}, {bound} {limit}"
    else:
        remedy = _remedy(place, kind, detail["input"])
    return Problem(key, given, f"must be {allowed}.", sentence(remedy))


def unknown_key(
    place: Place,  # Place of the key.
    value: Any,
    # Names and classes of the tables in which the key might belong.
    tables: Iterable[tuple[str, type[BaseModel]]],
) -> Problem:
    """The problem of a key that the schema does not have."""
    name = str(place.path[-1])
    known = () if place.owner is None else tuple(place.owner.model_fields)
    homes = [table for table, fields in tables if name in fields.model_fields]
    remedy = did_you_mean(name, known)
    if not remedy and homes:
        remedy = f"It belongs to {' or '.join(homes)}."
    if not remedy:
        remedy = f"Known are: {', '.join(known)}." if known else "Remove it."
    return Problem(dotted(place.path), written(value), "is not a known key.", remedy)


def _missing(place: Place) -> Problem:
    key, name = dotted(place.path), place.path[-1]
    if table_of(place.annotation) is not None and len(place.path) == 1:
        return Problem(
            key, "", f"the table [{key}] is missing.", "Add it; 'epicyclic init' shows its keys."
        )
    allowed = describe(place.annotation, place.metadata)
    owner = dotted(place.path[:-1])
    if isinstance(name, int):
        return Problem(key, "", f"is missing; it must be {allowed}.", f"Add it to {owner}.")
    where = f" to [{owner}]" if owner.isidentifier() else f" to {owner}"
    remedy = f"Add {name} = {_example(place)}{where if owner else ''}."
    return Problem(key, "", f"is missing; it must be {allowed}.", remedy)


def _example(place: Place) -> str:
    quantity = quantity_of(place.annotation, place.metadata)
    if quantity is not None:
        return f'"... {quantity.display}"'
    named = [item.names() for item in place.metadata if isinstance(item, Named)]
    choices = named[0] if named else choices_of(place.annotation)
    return f'"{choices[0]}"' if choices else "..."


def _wrong_tag(place: Place, detail: ErrorDetails) -> Problem:
    """A table that names none of the laws it may follow."""
    name = str(detail["ctx"]["discriminator"]).strip("'")
    given = detail["input"].get(name) if isinstance(detail["input"], dict) else None
    expected = [
        choice
        for law in tables_in(place.annotation)
        for choice in choices_of(law.model_fields[name].annotation)
    ]
    choices = " or ".join(f'"{choice}"' for choice in expected)
    key = dotted((*place.path, name))
    if given is None:
        return Problem(key, "", f"is missing; it must be {choices}.", f"Add {name}.")
    remedy = did_you_mean(str(given), expected) or "Choose one of them."
    return Problem(key, written(given), f"must be {choices}.", remedy)


def _remedy(place: Place, kind: str, value: Any) -> str:
    """What to change about a `value` that is not what `place` may hold."""
    if kind in _OUT_OF_RANGE:
        low, high = bounds_of(place.annotation, place.metadata)
        open_low = isinstance(low, Gt)
        lowest: Any = low.gt if isinstance(low, Gt) else low and low.ge
        highest: Any = high and high.le
        return range_remedy(value, lowest, highest, open_low=open_low)
    if kind == "literal_error":
        choices = choices_of(place.annotation)
        only = f'write "{choices[0]}"' if len(choices) == 1 else "choose one of them"
        return did_you_mean(str(value), choices) or only
    if kind in ("int_type", "float_type"):
        return _number_remedy(value)
    if table_of(place.annotation) is not None:
        return _table_remedy(place.path, value)
    return _REMEDIES.get(kind, "correct this value")


def _table_remedy(path: Sequence[str | int], value: Any) -> str:
    key = dotted(path)
    if isinstance(value, tuple) and len(path) == 1:
        return f"write [{key}] with single brackets, once"
    if any(isinstance(part, int) for part in path):
        return "write { key = value, ... }"
    return f"write [{key}] and its keys below it"


def _number_remedy(value: Any) -> str:
    if isinstance(value, float) and value.is_integer():
        return f"write {format_number(value, 15)}"
    if isinstance(value, float):
        return "round it"
    if isinstance(value, bool):
        return "write a number"
    match = _PLAIN_NUMBER.fullmatch(value[:100]) if isinstance(value, str) else None
    if match is None:
        return "write a plain number, without quotes and without unit"
    if match[2]:
        return f"write {format_number(float(match[1]) / 100)}"
    return f"write {match[1]}, without quotes"
