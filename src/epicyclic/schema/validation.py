"""The tables of a case against the schema: what is sound, and every problem of the rest."""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence, Set
from functools import cache, partial
from types import MappingProxyType
from typing import Any, Generic, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from epicyclic.dataclass import dataclass
from epicyclic.errors import Problem
from epicyclic.messages import did_you_mean, dotted, either, misspelt, sentence, value_at, written
from epicyclic.schema.fields import (
    Named,
    Place,
    Table,
    bounds_of,
    choices_of,
    describe,
    dict_value,
    entry_of,
    locate,
    quantity_of,
    table_of,
    tables_in,
)
from epicyclic.schema.read import changed_at, control_problems
from epicyclic.units import format_number, range_remedy

_PLAIN_NUMBER = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(%?)\s*")

_OUT_OF_RANGE = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")
_OWN = ("quantity", "preset", "oil")
_OF_KEYS = "uncertainty"  # The table whose names are keys of others, in quotes.
_WRONG_TAG = ("union_tag_invalid", "union_tag_not_found")

_REMEDIES = {
    "bool_type": "write true or false, without quotes",
    "finite_number": "give a finite number",
    "string_type": "put it in quotes",
    "tuple_type": "write it in square brackets, with commas between the entries",
}


def translate(table: type[Table], detail: ErrorDetails) -> Problem:
    """What pydantic found wrong in a case of kind `table`, as a problem of the user's.

    Unknown keys are left to `unknown_key`.
    """
    place = locate(table, detail["loc"])
    kind = detail["type"]
    if kind == "missing":
        return _missing(place, table.SHOWN_BY)
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
    case: type[Table],  # In whose tables the key might belong.
    sets: Iterable[str] = (),  # Names of the sets of a train, of which one might be meant.
) -> Problem:
    """The problem of a key that the schema does not have."""
    name = str(place.path[-1])
    known = () if place.owner is None else tuple(place.owner.model_fields)
    remedy = did_you_mean(name, known)
    homes = [
        f"{table}.{'NAME.' if dict_value(case.model_fields[table].annotation) else ''}{name}"
        for table, it in tables_of(case).items()
        if name in it.model_fields
    ]
    if place.path[0] == _OF_KEYS and isinstance(value, dict):
        remedy = f'Write {_OF_KEYS}."{dotted(place.path[1:])}", with the key in quotes.'
    elif not remedy and homes:
        remedy = f"Write {either(homes)}."
    elif not remedy and len(place.path) == 1 and isinstance(value, dict) and sets:
        remedy = f"A set is sets.NAME, here {', '.join(dotted(('sets', it)) for it in sets)}."
    if not remedy:
        remedy = f"The keys are {', '.join(known)}." if known else "Remove it."
    return Problem(dotted(place.path), written(value), "is not a known key.", remedy)


def _missing(place: Place, shown_by: str) -> Problem:
    key, name = dotted(place.path), place.path[-1]
    if table_of(place.annotation) is not None and len(place.path) == 1:
        remedy = f"Add it; {shown_by} shows its keys."
        return Problem(key, "", f"the table [{key}] is missing.", remedy)
    allowed = describe(place.annotation, place.metadata)
    owner = dotted(place.path[:-1])
    if isinstance(name, int):
        return Problem(key, "", f"is missing; it must be {allowed}.", f"Add it to {owner}.")
    where = f" to {owner}" if "[" in owner else f" to [{owner}]"
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
    choices = either([f'"{choice}"' for choice in expected])
    key = dotted((*place.path, name))
    if given is None:
        return Problem(key, "", f"is missing; it must be {choices}.", f"Add {name}.")
    remedy = did_you_mean(str(given), expected) or "Choose one of them."
    return Problem(key, written(given), f"must be {choices}.", remedy)


def _remedy(place: Place, kind: str, value: Any) -> str:
    """What to change about a `value` that is not what `place` may hold."""
    low, high, is_open = bounds_of(place.annotation, place.metadata)
    if kind in _OUT_OF_RANGE:
        return range_remedy(value, low, high, open_low=is_open)
    if kind == "literal_error":
        choices = choices_of(place.annotation)
        only = f'write "{choices[0]}"' if len(choices) == 1 else "choose one of them"
        return did_you_mean(str(value), choices) or only
    if kind in ("int_type", "float_type"):
        match = _PLAIN_NUMBER.fullmatch(value[:100]) if isinstance(value, str) else None
        number = value if isinstance(value, float) and math.isfinite(value) else None
        number = number if match is None or match[2] else float(match[1])
        if number is not None and (remedy := range_remedy(number, low, high, open_low=is_open)):
            return remedy
        is_whole = kind == "int_type" and match is not None and not match[1].isdigit()
        return _number_remedy(number if is_whole and number is not None else value)
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
        return "round it" if math.isfinite(value) else _REMEDIES["finite_number"]
    if isinstance(value, bool):
        return "write a number"
    match = _PLAIN_NUMBER.fullmatch(value[:100]) if isinstance(value, str) else None
    if match is None:
        return "write a plain number, without quotes and without unit"
    if match[2]:
        return f"write {format_number(float(match[1]) / 100, 15)}"
    return f"write {match[1]}, without quotes"


AnyCase = TypeVar("AnyCase", bound=Table)


@dataclass(frozen=True, slots=True)
class Validation(Generic[AnyCase]):
    """What the schema makes of the tables of a case."""

    case: AnyCase | None  # The case; None if there are problems.
    sections: Mapping[str, Table]  # The tables that are sound enough for checks across tables.
    problems: list[Problem]


def validate(
    kind: type[AnyCase],
    raw: dict[str, Any],
    sound: Mapping[str, Table] = MappingProxyType({}),
    sets: Iterable[str] = (),
) -> Validation[AnyCase]:
    """Hold `raw`, plain values, against the schema of a `kind` of case.

    Of the tables that are `sound`, what became of them is known. Of `sets`, held elsewhere, the
    names are.

    A misspelt key counts as the key that was meant, and a key that cannot be used is replaced where
    no other check depends on it, so that one mistake hides no other.
    """
    case, details = _try(kind, raw | dict(sound))
    problems = list(control_problems({k: v for k, v in raw.items() if k not in sound}))
    while unknown := [locate(kind, it["loc"]) for it in details if it["type"] == "extra_forbidden"]:
        # repeated, as a table that was misspelt itself may have unknown keys of its own
        problems += [unknown_key(place, value_at(raw, place.path), kind, sets) for place in unknown]
        raw = _mend_names(raw, unknown)
        if isinstance(own := raw.get(_OF_KEYS), dict):  # those without quotes are told
            raw[_OF_KEYS] = {key: table for key, table in own.items() if table != {}}
        case, details = _try(kind, raw)
    alternatives = _check_alternatives(kind, {k: v for k, v in raw.items() if k not in sound})
    problems += alternatives + [translate(kind, detail) for detail in details]
    if case is not None and not problems:
        given = {name: getattr(case, name) for name in tables_of(kind)}
        return Validation(case, {k: table for k, table in given.items() if table is not None}, [])
    bad: defaultdict[str, set[str]] = defaultdict(set)
    for detail in details:
        # a name that is no Unicode has no place: it belongs to no section
        section, *keys = map(str, locate(kind, detail["loc"]).path or [""])
        bad[section].add(keys[0] if keys else "")
    for problem in alternatives:
        section, _, key = problem.key.partition(".")
        bad[section].add(key)
    return Validation(None, _sound_sections(kind, raw, bad), problems)


def _try(kind: type[AnyCase], raw: dict[str, Any]) -> tuple[AnyCase | None, list[ErrorDetails]]:
    try:
        return kind.model_validate(raw, strict=True), []
    except ValidationError as error:
        details = error.errors(include_url=False)
    # an array only counts as too short because some of its entries are wrong
    return None, [
        detail
        for detail in details
        if detail["type"] != "too_short"
        or len(detail["input"]) < detail.get("ctx", {}).get("min_length", 0)
    ]


@cache
def tables_of(kind: type[Table]) -> dict[str, type[Table]]:
    """Names and classes of the tables that a `kind` of case consists of."""
    tables = {name: table_of(field.annotation) for name, field in kind.model_fields.items()}
    return {
        name: table
        for name, table in tables.items()
        if table is not None and issubclass(table, Table)
    }


def _mend_names(raw: dict[str, Any], unknown: list[Place]) -> dict[str, Any]:
    """`raw` with the unknown keys renamed to the ones that were meant, or left out."""
    names: dict[tuple[str | int, ...], dict[str, str]] = {}
    free: dict[tuple[str | int, ...], list[str]] = {}
    for place in unknown:
        *path, name = place.path
        owner = tuple(path)
        if owner not in names:
            known = () if place.owner is None else place.owner.model_fields
            given = value_at(raw, owner)
            names[owner], free[owner] = {}, [key for key in known if key not in given]
        meant = names[owner][str(name)] = misspelt(str(name), free[owner])
        if meant:
            free[owner].remove(meant)
    for owner, new in names.items():
        raw = changed_at(raw, owner, partial(_rename, new))
    return raw


def _rename(new: Mapping[str, str], table: dict[str, Any]) -> dict[str, Any]:
    """`table` with `new` names for some keys; without those whose new name is empty."""
    return {new.get(key, key): value for key, value in table.items() if new.get(key, key)}


def _check_alternatives(kind: type[Table], raw: dict[str, Any]) -> list[Problem]:
    """One of each group of alternatives must be given, and that one whole."""
    problems = []
    for name, table in tables_of(kind).items():
        if name not in raw:
            continue
        given = {name: raw[name]}
        has_names = dict_value(kind.model_fields[name].annotation) is not None  # [states.NAME]
        if has_names and isinstance(raw[name], dict):
            given = {f"{name}.{dotted([key])}": item for key, item in raw[name].items()}
        for key, item in given.items():
            if isinstance(item, dict):
                for group in (*table.EXACTLY_ONE, *table.AT_MOST_ONE):
                    choices = [keys.split("+") for keys in group]
                    is_needed = group in table.EXACTLY_ONE
                    problems += _check_group(key, choices, item, is_needed=is_needed)
    return problems


def _check_group(
    name: str, alternatives: list[list[str]], given: Mapping[str, Any], *, is_needed: bool
) -> list[Problem]:
    started = [keys for keys in alternatives if any(key in given for key in keys)]
    choice = " or ".join(" with ".join(keys) for keys in alternatives)
    if not started and not is_needed:
        return []
    if not started:
        missing = alternatives[0][0]
        allowed = f"is missing; {choice} is needed."
        return [Problem(f"{name}.{missing}", "", allowed, f"Add {choice} to [{name}].")]
    if len(started) == 1:
        known = f"is missing; it belongs to {next(key for key in started[0] if key in given)}."
        return [
            Problem(f"{name}.{key}", "", known, f"Add {key} to [{name}].")
            for key in started[0]
            if key not in given
        ]
    both = [key for keys in started for key in keys if key in given]
    extra = next(key for key in started[1] if key in given)
    allowed = f"conflicts with {' and '.join(key for key in both if key != extra)}."
    remedy = f"Give exactly one: {choice}."
    return [Problem(f"{name}.{extra}", written(given[extra]), allowed, remedy)]


def _sound_sections(
    kind: type[Table], raw: dict[str, Any], bad: Mapping[str, Set[str]]
) -> dict[str, Table]:
    """The tables that are sound, or can be made so by stand-ins for their `bad` keys."""
    sound: dict[str, Table] = {}
    for name, table in tables_of(kind).items():
        annotation = kind.model_fields[name].annotation
        if dict_value(annotation) is not None or entry_of(annotation):
            continue
        if name not in raw:
            default = kind.model_fields[name].default
            if isinstance(default, Table):
                sound[name] = default
            continue
        keys = bad.get(name, set())
        if keys <= table.STAND_INS.keys():
            values = {key: value for key, value in raw[name].items() if key not in keys}
            stand_ins = {key: table.STAND_INS[key] for key in keys}
            values |= {key: value for key, value in stand_ins.items() if value is not None}
            sound[name] = table.model_validate(values, strict=True)
    return sound
