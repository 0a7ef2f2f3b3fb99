"""The tables of a case against the schema: what is sound, and every problem of the rest."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Set
from dataclasses import dataclass
from functools import cache, partial
from types import MappingProxyType
from typing import Any, Generic, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from epicyclic.case.fields import Place, dict_value, locate, table_of
from epicyclic.case.nearest import misspelt
from epicyclic.case.plain import changed_at, control_problems, value_at
from epicyclic.case.schema import Table
from epicyclic.case.translation import translate, unknown_key
from epicyclic.case.wording import dotted, written
from epicyclic.errors import Problem

AnyCase = TypeVar("AnyCase", bound=Table)


@dataclass(frozen=True, slots=True)
class Validation(Generic[AnyCase]):
    """What the schema makes of the tables of a case."""

    case: AnyCase | None  # The case; None if there are problems.
    sections: Mapping[str, Table]  # The tables that are sound enough for checks across tables.
    problems: list[Problem]


def validate(
    kind: type[AnyCase], raw: dict[str, Any], sound: Mapping[str, Table] = MappingProxyType({})
) -> Validation[AnyCase]:
    """Hold `raw`, plain values, against the schema of a `kind` of case.

    Of the tables that are `sound`, what became of them is known.

    A misspelt key counts as the key that was meant, and a key that cannot be used is replaced where
    no other check depends on it, so that one mistake hides no other.
    """
    case, details = _try(kind, raw | dict(sound))
    problems = list(control_problems(raw))
    while unknown := _unknown_keys(kind, details):
        # repeated, as a table that was misspelt itself may have unknown keys of its own
        tables = tables_of(kind).items()
        problems += [unknown_key(place, value_at(raw, place.path), tables) for place in unknown]
        raw = _mend_names(raw, unknown)
        case, details = _try(kind, raw)
    alternatives = _check_alternatives(kind, raw)
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
    return None, [detail for detail in details if not _is_echo(detail)]


def _is_echo(detail: ErrorDetails) -> bool:
    """True if an array only counts as too short because some of its entries are wrong."""
    needed = detail.get("ctx", {}).get("min_length", 0)
    return detail["type"] == "too_short" and len(detail["input"]) >= needed


@cache
def tables_of(kind: type[Table]) -> dict[str, type[Table]]:
    """Names and classes of the tables that a `kind` of case consists of."""
    tables = {name: table_of(field.annotation) for name, field in kind.model_fields.items()}
    return {
        name: table
        for name, table in tables.items()
        if table is not None and issubclass(table, Table)
    }


def _unknown_keys(kind: type[Table], details: list[ErrorDetails]) -> list[Place]:
    return [
        locate(kind, detail["loc"]) for detail in details if detail["type"] == "extra_forbidden"
    ]


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
    for name, table in _tables_of_choices(kind).items():
        given = {name: raw.get(name)}
        if _holds_names(kind, name) and isinstance(raw.get(name), dict):
            given = {f"{name}.{dotted([key])}": item for key, item in raw[name].items()}
        for key, item in given.items():
            if isinstance(item, dict):
                for group in (*table.EXACTLY_ONE, *table.AT_MOST_ONE):
                    choices = [keys.split("+") for keys in group]
                    is_needed = group in table.EXACTLY_ONE
                    problems += _check_group(key, choices, item, is_needed=is_needed)
    return problems


@cache
def _tables_of_choices(kind: type[Table]) -> dict[str, type[Table]]:
    """Those of the tables that have alternatives."""
    tables = tables_of(kind).items()
    return {name: table for name, table in tables if table.EXACTLY_ONE or table.AT_MOST_ONE}


@cache
def _holds_names(kind: type[Table], name: str) -> bool:
    """True if the tables stand below names of the user's, ``[states.NAME]``."""
    return dict_value(kind.model_fields[name].annotation) is not None


def _check_group(
    name: str, alternatives: list[list[str]], given: Mapping[str, Any], *, is_needed: bool
) -> list[Problem]:
    started = [keys for keys in alternatives if any(key in given for key in keys)]
    choice = " or ".join(" with ".join(keys) for keys in alternatives)
    if not started and not is_needed:
        return []
    if not started:
        missing = alternatives[0][0]
        return [
            Problem(
                f"{name}.{missing}",
                "",
                f"is missing; needed is {choice}.",
                f"Add {choice} to [{name}].",
            )
        ]
    if len(started) == 1:
        return [
            Problem(
                f"{name}.{key}",
                "",
                f"is missing; it belongs to {other}.",
                f"Add {key} to [{name}].",
            )
            for key in started[0]
            if key not in given
            for other in [next(other for other in started[0] if other in given)]
        ]
    both = [key for keys in started for key in keys if key in given]
    extra = next(key for key in started[1] if key in given)
    return [
        Problem(
            f"{name}.{extra}",
            written(given[extra]),
            f"conflicts with {' and '.join(key for key in both if key != extra)}.",
            f"Give exactly one: {choice}.",
        )
    ]


def _sound_sections(
    kind: type[Table], raw: dict[str, Any], bad: Mapping[str, Set[str]]
) -> dict[str, Table]:
    """The tables that are sound, or can be made so by stand-ins for their `bad` keys."""
    sound: dict[str, Table] = {}
    for name, table in tables_of(kind).items():
        if _holds_names(kind, name):
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
