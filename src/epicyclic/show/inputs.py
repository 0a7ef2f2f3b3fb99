"""Tables of the inputs of a case: given ones, defaults, and what a library filled in."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any

from epicyclic.build.models import ONLY_WITH
from epicyclic.case.case import KINDS
from epicyclic.case.tables.elements import ElementTables
from epicyclic.case.train_tables import form_of_set
from epicyclic.dataclass import dataclass
from epicyclic.schema.fields import Place, dict_value, locate, quantity_of
from epicyclic.show.page import Cell, Table
from epicyclic.units import format_number, unit_text

MEMBERS = ("sun", "planet", "ring", "pinion", "gear")
TITLES = {"gears": "All gears", "sun": "Gears", "pinion": "Gears"}
NOT_SHOWN = ("kind", "title")
DATUM = {"value", "temperature", "source"}  # Keys of a table that states one value.
MOST_VALUES = 12  # Most values of an array that are shown.
WORDS, VALUES = 18, 42  # Widths of the columns of keys and values, beside their meaning. [%]
MOST_BESIDE = 3  # Columns of values that have room in this: more parts follow in a table below.
_SHARED = ("models", "numerics", "lubrication")  # Tables that the sets of a train take from it.
_LISTED, _MEMBERS = "gears", "members"
"""Table of the gears of a listed set in a file, and in the schema."""
_OF_LOSSES = ("lubrication", "surroundings", "models", "contact_solver", "numerics")
_TITLES_OF_PARTS = {"bearings": "Shaft bearings", "drags": "Other drags"}
Path = tuple[str | int, ...]


def input_tables(
    inputs: Mapping[str, Any],  # The case with its defaults.
    given: Mapping[str, Any],  # The case as it was given; defaults are marked.
    # The models that were used. Defaults of keys that have no effect with them are left out.
    models: Mapping[str, str] = MappingProxyType({}),
) -> list[Table]:
    """The inputs, one table for each table of the case, gears side by side.

    Of a train the tables of each set, and bearings, seals and drags side by side. Tables without
    effect, because every loss is given, are left out.
    """
    source = _Source(KINDS[inputs["kind"]], given, _used(inputs, models))
    if inputs["kind"] != "train":
        return [table for table in _set_tables(source, inputs) if table.rows]
    tables = []
    computed = any("numerics" in own for own in inputs["sets"].values())
    for name, table in inputs.items():
        if name in NOT_SHOWN or not table or ("lubricant" not in inputs and name in _OF_LOSSES):
            continue
        if name == "numerics" and not computed:
            continue
        if name == "sets":
            for key, own in table.items():
                stated = given["sets"].get(key, {})
                kept = {k: v for k, v in own.items() if k not in _SHARED or k in stated}
                schema, _ = form_of_set(own)
                tables += _set_tables(_Source(schema, stated, source.used), kept, key)
        elif name in ElementTables.model_fields:
            title = _TITLES_OF_PARTS.get(name, _title(name))
            tables += _side_by_side(source, title, (name,), table)
        else:
            tables += _tables(source, (name,), table, _title(name))
    return [table for table in tables if table.rows]


@dataclass(frozen=True, slots=True)
class _Source:
    """What the schema says, and what was given."""

    schema: Any
    given: Mapping[str, Any]
    used: Mapping[str, str]

    def place(self, path: Path) -> Place:
        """Where the schema has what a file has at a path."""
        found = locate(self.schema, path)
        if found.annotation is None and path[0] == _LISTED:  # no key that the gears share
            return locate(self.schema, (_MEMBERS, *path[1:]))
        return found

    def is_named(self, path: Path) -> bool:
        """True for a table whose name the user chose."""
        holder = self.place(path[:-1]).annotation
        return dict_value(holder) is not None or self.place(path).path[0] == _MEMBERS

    def shows(self, path: Path) -> bool:
        """False for a default that has no effect with the models that were used."""
        tables = [(str(part), "") for part in path]
        keys = [(str(table), str(key)) for table, key in itertools.pairwise(path)]
        for place in (*tables, *keys):
            models, words = ONLY_WITH.get(place, ((), ()))
            used = [self.used[model] for model in models if model in self.used]
            if used and not any(word in names for word in words for names in used):
                return _is_given(path, self.given)
        return True


def _used(inputs: Mapping[str, Any], models: Mapping[str, str]) -> dict[str, str]:
    """All names that each model has, of whichever set; those of a case if none are known."""
    if not models:
        return {}
    used = {"temperatures": str(inputs.get("models", {}).get("temperatures", ""))}
    for key, name in models.items():
        model = key.rpartition(".")[2]
        used[model] = f"{used.get(model, '')} {name}"
    return used


def _title(name: str) -> str:
    return name.replace("_", " ").capitalize()


def _set_tables(source: _Source, inputs: Mapping[str, Any], name: str = "") -> list[Table]:
    """The tables of a single set, or of one of a train with its name."""
    members = [name for name in MEMBERS if name in inputs and isinstance(inputs[name], Mapping)]
    before = f"{name}: " if name else ""
    tables: list[Table] = []
    single = {}
    for key, table in inputs.items():
        if (key in NOT_SHOWN and not name) or key in members[1:]:
            continue
        title = before + TITLES.get(key, _title(key))
        if key in members:
            chosen = {member: inputs[member] for member in members}
            tables += _side_by_side(source, title, (), chosen)
        elif key == "losses":
            tables += _changed_losses(title, table)
        elif isinstance(table, Mapping) and not _is_datum(table):
            tables += _tables(source, (key,), table, title)
        else:
            single[key] = table
    if single and name:
        tables.insert(0, _plain_table(source, (), single, name))
    return tables


def _tables(source: _Source, place: Path, table: Any, title: str) -> list[Table]:
    """A table of the case, with the tables in it that have names of the user side by side."""
    named = {
        name: item
        for name, item in (table.items() if isinstance(table, Mapping) else ())
        if isinstance(item, Mapping) and source.is_named((*place, name))
    }
    own = {name: item for name, item in table.items() if name not in named} if named else table
    tables = [_plain_table(source, place, own, title)] if own else []
    return tables + _side_by_side(source, title.replace(TITLES[_LISTED], "Gears"), place, named)


def _plain_table(source: _Source, place: Path, table: Any, title: str) -> Table:
    rows = tuple(
        (Cell(_words(path[len(place) :])), _cell(source, path, value), _about(source, path))
        for path, value in _leaves(table, place)
        if source.shows(path)
    )
    return _with_meaning(("", "value"), rows, title)


def _side_by_side(
    source: _Source, title: str, place: Path, parts: Mapping[str, Mapping[str, Any]]
) -> list[Table]:
    """Parts with the same keys, as many beside each other as have room."""
    names = list(parts)
    count = math.ceil(len(names) / MOST_BESIDE)
    ends = [math.ceil(number * len(names) / count) for number in range(count + 1)] if names else []
    return [
        _beside(source, title, place, {name: parts[name] for name in names[start:end]})
        for start, end in itertools.pairwise(ends)
    ]


def _beside(
    source: _Source, title: str, place: Path, parts: Mapping[str, Mapping[str, Any]]
) -> Table:
    leaves = {part: dict(_leaves(table, ())) for part, table in parts.items()}
    rows = []
    for path in dict.fromkeys(path for values in leaves.values() for path in values):
        cells = [
            _cell(source, (*place, part, *path), values[path]) if path in values else Cell("")
            for part, values in leaves.items()
        ]
        first = next(part for part, values in leaves.items() if path in values)
        rows.append((Cell(_words(path)), *cells, _about(source, (*place, first, *path))))
    return _with_meaning(("", *(part.replace("_", " ") for part in parts)), tuple(rows), title)


def _with_meaning(head: tuple[str, ...], rows: tuple[tuple[Cell, ...], ...], title: str) -> Table:
    """A table whose last column, the meaning of its keys, is left out if no key has one."""
    if not any(row[-1].text for row in rows):
        return Table(head, tuple(row[:-1] for row in rows), title)
    values = len(head) - 1
    widths = (WORDS, *(VALUES // values for _ in range(values)), 100 - WORDS - VALUES)
    return Table((*head, "meaning"), rows, title, widths=widths)


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


def _cell(source: _Source, path: Path, value: Any) -> Cell:
    about = "" if _is_given(path, source.given) else "default"
    return Cell(_text(source, path, value), about=about)


def _text(source: _Source, path: Path, value: Any) -> str:
    if isinstance(value, list):
        between = "; " if value and isinstance(value[0], list) else ", "
        shown = between.join(_text(source, path, item) for item in value[:MOST_VALUES])
        return shown if len(value) <= MOST_VALUES else f"{shown}, ... ({len(value)} values)"
    if _is_datum(value):
        parts = [_text(source, (*path, "value"), value["value"])]
        if "temperature" in value:
            parts.append(f"at {_text(source, (*path, 'temperature'), value['temperature'])}")
        return " ".join(parts) + (f" ({value['source']})" if value.get("source") else "")
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return format_number(value)
    place = source.place(path)
    dimensional = quantity_of(place.annotation, place.metadata) is not None
    return unit_text(str(value)) if dimensional else str(value)


def _about(source: _Source, path: Path) -> Cell:
    """What the schema says about a key."""
    names = [part for part in path if isinstance(part, str)]
    owner = source.place(path).owner
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
