"""Tables of the inputs of a case: given ones, defaults, and what a library filled in."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from epicyclic.case.case import GearPairCase, PlanetaryCase
from epicyclic.case.fields import locate, quantity_of
from epicyclic.report.page import Cell, Table
from epicyclic.units import format_number, unit_text

__all__ = ["input_tables"]

MEMBERS = ("sun", "planet", "ring", "pinion", "gear")
TITLES = {"gears": "All gears", "sun": "Gears", "pinion": "Gears"}
NOT_SHOWN = ("kind", "title")
DATUM = {"value", "temperature", "source"}
"""Keys of a table that states one value."""
MOST_VALUES = 12
"""Of an array that are shown."""
_SCHEMAS = {"planetary": PlanetaryCase, "gear_pair": GearPairCase}
Path = tuple[str | int, ...]


def input_tables(inputs: Mapping[str, Any], given: Mapping[str, Any]) -> list[Table]:
    """All inputs, one table for each table of the case, gears side by side.

    Parameters
    ----------
    inputs : mapping
        The case with its defaults.
    given : mapping
        The case as it was given; defaults are marked.
    """
    schema = _SCHEMAS[inputs["kind"]]
    members = [name for name in MEMBERS if name in inputs]
    tables = []
    for name, table in inputs.items():
        if name in NOT_SHOWN or name in members[1:]:
            continue
        title = TITLES.get(name, name.replace("_", " ").capitalize())
        if name in members:
            tables.append(_side_by_side(title, members, inputs, given))
        elif name == "losses":
            tables += _changed_losses(title, table)
        else:
            rows = tuple(
                (Cell(_words(path[1:])), _cell(schema, path, value, given), _about(schema, path))
                for path, value in _leaves(table, (name,))
            )
            tables.append(_with_meaning(("", "value"), rows, title))
    return tables


def _side_by_side(
    title: str, members: list[str], inputs: Mapping[str, Any], given: Mapping[str, Any]
) -> Table:
    leaves = {member: dict(_leaves(inputs[member], ())) for member in members}
    keys = dict.fromkeys(path for values in leaves.values() for path in values)
    schema = _SCHEMAS[inputs["kind"]]
    rows = []
    for path in keys:
        cells = [
            _cell(schema, (member, *path), leaves[member][path], given)
            if path in leaves[member]
            else Cell("")
            for member in members
        ]
        abouts = [_about(schema, (member, *path)) for member in members if path in leaves[member]]
        rows.append((Cell(_words(path)), *cells, abouts[0]))
    return _with_meaning(("", *members), tuple(rows), title)


def _with_meaning(head: tuple[str, ...], rows: tuple[tuple[Cell, ...], ...], title: str) -> Table:
    """A table whose last column, the meaning of its keys, is left out if no key has one."""
    if any(row[-1].text for row in rows):
        return Table((*head, "meaning"), rows, title)
    return Table(head, tuple(row[:-1] for row in rows), title)


def _changed_losses(title: str, losses: Mapping[str, Any]) -> list[Table]:
    """The losses that are left out or multiplied by a factor."""
    rows = tuple(
        (
            Cell(name.replace("_", " ")),
            Cell("included" if option["include"] else "left out"),
            Cell(format_number(option["factor"])),
        )
        for name, option in losses.items()
        if not option["include"] or option["factor"] != 1.0
    )
    return [Table(("", "", "factor"), rows, title)] if rows else []


def _leaves(value: Any, path: Path) -> Iterator[tuple[Path, Any]]:
    """Every value below a table with its path; entries of arrays of tables count from 0."""
    if isinstance(value, Mapping) and not _is_datum(value):
        for key, item in value.items():
            yield from _leaves(item, (*path, key))
    elif isinstance(value, list) and value and isinstance(value[0], Mapping):
        for number, item in enumerate(value):
            yield from _leaves(item, (*path, number))
    else:
        yield path, value


def _is_datum(value: Any) -> bool:
    """True for a table of one value, with its temperature and source."""
    return isinstance(value, Mapping) and "value" in value and value.keys() <= DATUM


def _is_given(path: Path, given: Any) -> bool:
    """True if `given` has the value at `path`, or a name in place of one of its tables."""
    for part in path:
        if isinstance(given, Mapping):
            if part not in given:
                return False
            given = given[part]
        elif isinstance(given, list) and isinstance(part, int) and part < len(given):
            given = given[part]
        else:
            return given is not None
    return True


def _cell(schema: Any, path: Path, value: Any, given: Mapping[str, Any]) -> Cell:
    about = "" if _is_given(path, given) else "default"
    return Cell(_text(schema, path, value), about=about)


def _text(schema: Any, path: Path, value: Any) -> str:
    if isinstance(value, list):
        shown = ", ".join(_text(schema, path, item) for item in value[:MOST_VALUES])
        return shown if len(value) <= MOST_VALUES else f"{shown}, ... ({len(value)} values)"
    if _is_datum(value):
        parts = [_text(schema, (*path, "value"), value["value"])]
        if "temperature" in value:
            parts.append(f"at {_text(schema, (*path, 'temperature'), value['temperature'])}")
        return " ".join(parts) + (f" ({value['source']})" if value.get("source") else "")
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return format_number(value)
    place = locate(schema, path)
    dimensional = quantity_of(place.annotation, place.metadata) is not None
    return unit_text(str(value)) if dimensional else str(value)


def _about(schema: Any, path: Path) -> Cell:
    """What the schema says about a key."""
    names = [part for part in path if isinstance(part, str)]
    owner = locate(schema, path).owner
    field = None if owner is None else owner.model_fields.get(names[-1])
    return Cell((field.description or "") if field is not None else "")


def _words(path: Path) -> str:
    """A path in words: ``"oil, kinematic viscosity 1, value"``."""
    words: list[str] = []
    for part in path:
        if isinstance(part, int):
            words[-1] += f" {part + 1}"
        else:
            words.append(part.replace("_", " "))
    return ", ".join(words)
