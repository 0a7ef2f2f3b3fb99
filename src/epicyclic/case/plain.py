"""The tables of a case as plain values, such as TOML can hold."""

from __future__ import annotations

import numbers
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any
from unicodedata import category

import numpy as np
from pydantic import BaseModel

from epicyclic.case.fields import to_inputs
from epicyclic.case.wording import dotted, written
from epicyclic.errors import InputError, Problem
from epicyclic.units import from_pint

_DEEPEST = 20
"""Tables of a case are nested a few levels deep; deeper ones are something else."""

_CONTROLS = ("Cc", "Cs")
"""Unicode categories of control characters and of halves of characters."""
_LAYOUT = "\t\r\n"
"""What texts of several lines may have."""

_MOST_VALUES = 20_000
"""A case has a hundred values, a large friction table some thousand."""


def plain(value: Any) -> Any:
    """A copy of `value` with plain dicts, numbers and text, tuples for arrays, nothing for None.

    Raises
    ------
    InputError
        If it is too large or nested too deep to be part of a case.
    """
    budget = iter(range(_MOST_VALUES))
    return _plain(value, _DEEPEST, budget)


def control_problems(tables: Any, path: tuple[str | int, ...] = ()) -> Iterator[Problem]:
    """Texts in plain values with signs that control a terminal, or are no characters."""
    if isinstance(tables, str) and not tables.isprintable():
        if any(category(char) in _CONTROLS and char not in _LAYOUT for char in tables):
            allowed = "has control characters."
            yield Problem(dotted(path), written(tables), allowed, "Leave them out.")
    elif isinstance(tables, Mapping):
        for key, item in tables.items():
            yield from control_problems(item, (*path, key))
    elif isinstance(tables, tuple):
        for number, item in enumerate(tables):
            yield from control_problems(item, (*path, number))


def _plain(value: Any, depth: int, budget: Iterator[int]) -> Any:
    if next(budget, None) is None:
        raise _not_a_case(f"there are more than {_MOST_VALUES} values, too many for a case.")
    if depth == 0:
        raise _not_a_case(f"the tables are nested more than {_DEEPEST} levels deep.")
    if isinstance(value, BaseModel):
        value = to_inputs(value)
    elif isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    elif (quantity := from_pint(value)) is not None:
        number, unit = quantity
        value = number if unit == "dimensionless" else f"{number!r} {unit}"
    if isinstance(value, Mapping):
        return {
            str(key): _plain(item, depth - 1, budget)
            for key, item in value.items()
            if item is not None
        }
    if isinstance(value, list | tuple):
        return tuple(_plain(item, depth - 1, budget) for item in value)
    if isinstance(value, bool):
        return value
    if isinstance(value, numbers.Integral):
        return int(value)
    return float(value) if isinstance(value, numbers.Real) else value


def _not_a_case(allowed: str) -> InputError:
    return InputError([Problem("", "", allowed, "Give the tables of a case.")])


def flattened(tables: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted keys and values of nested tables."""
    for key, value in tables.items():
        if isinstance(value, Mapping):
            yield from flattened(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def value_at(tables: Any, path: Sequence[str | int]) -> Any:
    """The value at `path` below `tables`; None if there is none."""
    for part in path:
        if isinstance(tables, Mapping):
            tables = tables.get(part)
        elif isinstance(tables, tuple) and isinstance(part, int) and part < len(tables):
            tables = tables[part]
        else:
            return None
    return tables


def changed_at(tables: Any, path: Sequence[str | int], change: Callable[[Any], Any]) -> Any:
    """A copy of `tables` with the value at `path` replaced by what `change` makes of it.

    Only what lies on the path is copied.
    """
    if not path:
        return change(tables)
    head, *rest = path
    if isinstance(head, int):
        entry = changed_at(tables[head], rest, change)
        return (*tables[:head], entry, *tables[head + 1 :])
    return tables | {head: changed_at(tables[head], rest, change)}


def with_value(tables: dict[str, Any], path: Sequence[str], value: Any) -> dict[str, Any]:
    """A copy of `tables` with `value` at `path`, in new tables where there are none."""
    name, *rest = path
    return tables | {name: with_value(tables.get(name, {}), rest, value) if rest else value}


def without(tables: dict[str, Any], path: Sequence[str]) -> dict[str, Any]:
    """A copy of `tables` without the key at `path`, which is there."""
    name, *rest = path
    if rest:
        return tables | {name: without(tables[name], rest)}
    return {key: value for key, value in tables.items() if key != name}
