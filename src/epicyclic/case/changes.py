"""Changes of single keys of a case, as `--set` and sweeps make them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple

from epicyclic.case.keys import owner_without_keys
from epicyclic.errors import InputError, Problem
from epicyclic.gears.sizing import Found
from epicyclic.messages import dotted, key_parts, value_at, written
from epicyclic.schema.fields import find_field, locate
from epicyclic.schema.read import flattened, plain, split_key, with_unit_of_key, with_value, without
from epicyclic.schema.table import Table
from epicyclic.schema.validation import tables_of, unknown_key


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
                shown = written(value_at(tables, path))
                replaced.append(Found(dotted(path), shown, former))
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
        raise InputError([unknown_key(locate(kind, path), None, tables_of(kind).items())])
    return tables
