"""Plain tables of a case: read from a file or from given values, changed, and shown."""

from __future__ import annotations

import json
import numbers
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple
from unicodedata import category

import numpy as np
from pydantic import BaseModel

from epicyclic.errors import InputError, Problem, problems_in
from epicyclic.files import read_text, refuse
from epicyclic.messages import dotted, one_line, written
from epicyclic.schema.fields import to_inputs
from epicyclic.units import format_number, from_pint, plain_number

_DEEPEST = 20  # Tables of a case are nested a few levels deep; deeper ones are something else.

_CONTROLS = ("Cc", "Cs")  # Unicode categories of control characters and of halves of characters.
_LAYOUT = "\t\r\n"  # What texts of several lines may have.

_MOST_VALUES = 20_000  # A case has a hundred values, a large friction table some thousand.


def plain(value: Any) -> Any:
    """A copy of `value` with plain dicts, numbers and text, tuples for arrays, nothing for None.

    Raises `InputError` if it is too large or nested too deep to be part of a case.
    """
    return _plain(value, _DEEPEST, iter(range(_MOST_VALUES)))


_UNIT_IN_KEY = re.compile(r"(?P<key>.+?)\s+\[(?P<unit>[^\[\]]+)\]")


def split_key(key: str) -> tuple[str, str]:
    """A dotted key and the unit that may stand behind it: ``"operation.torque [N*m]"``."""
    match = _UNIT_IN_KEY.fullmatch(key)
    return (match["key"], match["unit"].strip()) if match else (key, "")


def with_unit_of_key(value: Any, unit: str) -> Any:
    """Numbers, also of an array, as a case file has them if their key has a unit."""
    if isinstance(value, np.ndarray) and not value.ndim:
        value = value.item()
    if isinstance(value, np.ndarray | list | tuple):
        return [with_unit_of_key(item, unit) for item in value]
    is_number = isinstance(value, numbers.Real) and not isinstance(value, bool | np.bool)
    if not is_number or unit in ("", "1"):
        return value
    try:
        return f"{float(value)!r} {unit}"
    except OverflowError:  # a whole number of hundreds of digits
        return f"inf {unit}"


def control_problems(tables: Any, path: tuple[str | int, ...] = ()) -> Iterator[Problem]:
    """Texts in plain values with signs that control a terminal, or are no characters."""
    if isinstance(tables, str) and not tables.isprintable():
        if any(category(char) in _CONTROLS and char not in _LAYOUT for char in tables):
            allowed = "contains control characters."
            yield Problem(dotted(path), written(tables), allowed, "Remove them.")
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
    return float(value) + 0.0 if isinstance(value, numbers.Real) else value  # no zero below zero


def _not_a_case(allowed: str) -> InputError:
    return InputError([Problem("", "", allowed, "Give the tables of a case.")])


def flattened(tables: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted keys and values of nested tables."""
    for key, value in tables.items():
        if isinstance(value, Mapping):
            yield from flattened(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def changed_at(tables: Any, path: Sequence[str | int], change: Callable[[Any], Any]) -> Any:
    """A copy of `tables` with the value at `path` replaced by what `change` makes of it.

    Only what lies on the path is copied.
    """
    if not path:
        return change(tables)
    head, *rest = path
    if isinstance(head, int):
        return (*tables[:head], changed_at(tables[head], rest, change), *tables[head + 1 :])
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


# From a case file to plain tables, with every line that is not TOML reported.

_LARGEST_FILE = 1_000_000
"""A case file is a page of text; anything larger than this is something else. [bytes]"""

_LONGEST_PATH = 500  # Paths in messages are cut to this many characters.

_MOST_BAD_LINES = 50  # A file with more lines that are not TOML is something else.

_DEEPEST_KEY = 50
"""Dots of one key; the TOML reader would need memory as the square of their number."""

_BETWEEN_KEYS = re.compile(r"[,={}\[\]\n]")
_KEY_DOT = re.compile(r"[\w\"'-]\s*\.")
_PLACE = re.compile(r" \(at line (?P<line>\d+), column \d+\)")
_KEY_LINE = re.compile(r"(?P<key>[\w.\"'-]+)\s*=(?P<value>[^#\[{]*)(#.*)?")
_INCHES = re.compile(r"[\d.,/\s]*\d\s*(\"|'')")
_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+")

_GIVES_AGAIN = "Cannot overwrite"  # How the reason of a key that is given twice begins.

_MARK = "\ue000"  # Encloses the number of the line before a mended value; a character of no script.


class _BadLine(NamedTuple):
    """A line that is not TOML, and why."""

    number: int
    text: str
    reason: str


def read_file(
    path: Path,
    start: str = "'epicyclic init' writes one to start from.",  # Where a whole file is found.
) -> tuple[dict[str, Any], list[Problem]]:
    """The tables of a TOML file, and the problems of its lines.

    A value that only lacks its quotes is read as if it had them, so that the rest of the file can
    be checked too. Raises `InputError` if it is not a file, not text, or not TOML that can be read
    around its mistakes.
    """
    with problems_in(one_line(str(path), _LONGEST_PATH)):
        tables, bad_lines = _parse(read_text(path, "case", _LARGEST_FILE), path.suffix.lower())
        if not tables and not bad_lines:
            refuse("is empty.", f"Fill it; {start}")
        return _take_marks(plain(tables), bad_lines)


def _parse(text: str, ending: str) -> tuple[dict[str, Any], list[_BadLine]]:
    """The tables of a text, its bad lines mended where that is possible."""
    if _is_deep(text):
        refuse("has tables that are nested too deeply.", "Give a case file.")
    lines = text.replace("\r\n", "\n").split("\n")
    bad_lines: list[_BadLine] = []
    while True:
        try:
            # with an empty line at the end every mistake lies in a line
            return tomllib.loads("\n".join([*lines, "", ""])), bad_lines
        except RecursionError:
            refuse("has tables that are nested too deeply.", "Give a case file.")
        except ValueError as error:
            line = _bad_line(error, lines)
        mended = None
        if all(line.number != other.number for other in bad_lines):
            bad_lines.append(line)
            mended = _mended(line)
        if mended is None and ending not in ("", ".toml"):
            refuse(f"ends with {ending} and holds no case.", "Give a .toml file.")
        if mended is None or len(bad_lines) > _MOST_BAD_LINES:
            raise InputError([_problem(bad, "") for bad in bad_lines])
        lines[line.number - 1] = mended


def _is_deep(text: str) -> bool:
    """Whether a key has more dots than the TOML reader should be given."""
    return any(len(_KEY_DOT.findall(part)) > _DEEPEST_KEY for part in _BETWEEN_KEYS.split(text))


def _bad_line(error: ValueError, lines: list[str]) -> _BadLine:
    place = _PLACE.search(str(error))
    if place is None:  # a whole number of thousands of digits
        refuse(f"is not TOML: {error}.", "Shorten that number.")
    number = min(int(place["line"]), len(lines))
    reason = str(error)[: place.start()]
    if reason == r"Illegal character '\n'":
        reason = "the quotes are not closed"
    return _BadLine(number, lines[number - 1].strip(), reason)


def _mended(line: _BadLine) -> str | None:
    """What to read in place of a bad line; None if nothing can be."""
    match = _KEY_LINE.fullmatch(line.text)
    if match is None:
        return None
    if line.reason.startswith(_GIVES_AGAIN):
        return ""
    value = f"{_MARK}{line.number}{_MARK}{_value(match)}"
    return f"{match['key']} = {json.dumps(value)}"


def _value(match: re.Match[str]) -> str:
    """The value of a key line, without the quotes that it may have on one side, inches but."""
    text = match["value"].strip()
    return text if _INCHES.fullmatch(text) else text.strip("\"'“”„‘’")


def _take_marks(
    tables: dict[str, Any], bad_lines: list[_BadLine]
) -> tuple[dict[str, Any], list[Problem]]:
    """The tables with mended values as plain text, and the problems of the bad lines."""
    keys: dict[int, str] = {}
    for number, path in list(_marked(tables, ())):
        tables = changed_at(tables, path, lambda text: text.rpartition(_MARK)[2])
        keys[number] = dotted(path)
    return tables, [_problem(line, keys.get(line.number, "")) for line in bad_lines]


def _marked(
    tables: Any, path: tuple[str | int, ...]
) -> Iterator[tuple[int, tuple[str | int, ...]]]:
    """Line number and path of each mended value."""
    if isinstance(tables, dict):
        for key, value in tables.items():
            yield from _marked(value, (*path, key))
    elif isinstance(tables, tuple):
        for number, value in enumerate(tables):
            yield from _marked(value, (*path, number))
    elif isinstance(tables, str) and tables.startswith(_MARK):
        yield int(tables.split(_MARK)[1]), path


def _problem(line: _BadLine, key: str) -> Problem:
    match = _KEY_LINE.fullmatch(line.text)
    if match is None or not key:
        given = f"line {line.number}: {one_line(line.text)}"
    else:
        given = one_line(match["value"].strip())
    if line.reason.startswith(_GIVES_AGAIN):
        return Problem(key, given, "gives a key a second time.", "Keep one of the two.")
    if line.reason.startswith("Cannot declare"):
        advice = "Put all its keys under one header; a dotted key, such as "
        advice += "micro_geometry.tip_relief under [sun], declares its table too."
        return Problem(key, given, f"declares a table twice (line {line.number}).", advice)
    remedy = "Correct this line." if match is None else _remedy(match["key"], _value(match))
    return Problem(key, given, f"is not TOML (line {line.number}): {line.reason}.", remedy)


def _remedy(key: str, value: str) -> str:
    if not value:
        return "Give a value."
    if value.casefold() in ("true", "false"):
        return f"Write {value.casefold()}."
    try:
        return f"Write {format_number(float(value), 12)}."
    except ValueError:
        plain = plain_number(value)
        if plain:
            return f"Write {plain}."
        if _DECIMAL_COMMA.fullmatch(value):
            return "Write it with a decimal point, and without marks of thousands."
        if _INCHES.fullmatch(value):
            return "Write the unit by its name, in, and the value in quotes."
        return f'Put the value in quotes: {key} = "{one_line(value)}".'


def parse_value(text: str) -> Any:
    """`text` as TOML would read it (numbers, true, lists), else as plain text."""
    if _is_deep(text):
        return text
    try:
        tables = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):  # no TOML, numbers or lists beyond all measure
        return text
    return tables["value"] if len(tables) == 1 else text
