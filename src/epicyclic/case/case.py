"""A whole case, and how it is read, checked and changed."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

from pydantic import BaseModel, Field, PrivateAttr, TypeAdapter, ValidationError
from pydantic_core import ErrorDetails

from epicyclic import library
from epicyclic.case.checks import cross_check
from epicyclic.case.fields import find_field, quantity_of, table_of, to_inputs
from epicyclic.case.nearest import did_you_mean
from epicyclic.case.schema import (
    Carrier,
    FrictionTable,
    GearPairLosses,
    GearPairModels,
    GearPairOperation,
    Gears,
    GearTable,
    Lubricant,
    Numerics,
    PairGear,
    Planet,
    PlanetaryLosses,
    PlanetaryModels,
    PlanetaryOperation,
    PlanetBearing,
    Ring,
    Surroundings,
    Table,
    ThrustBearing,
)
from epicyclic.errors import InputError, Problem

__all__ = ["Case", "GearPairCase", "PlanetaryCase", "case_schema", "load_case"]

AnyCase = TypeVar("AnyCase", "PlanetaryCase", "GearPairCase")

LONGEST_SHOWN = 60
"""Values in messages are cut to this many characters."""
LARGEST_FILE = 1_000_000
"""A case file is a page of text; anything larger than this is something else. [bytes]"""


class _CaseTable(Table):
    _raw: dict[str, Any] = PrivateAttr(default_factory=dict)
    _source: str = PrivateAttr(default="")

    @property
    def source(self) -> str:
        """The file or built-in case it was read from."""
        return self._source

    def updated(self, changes: Mapping[str, Any]) -> Self:
        """A copy of the case with some keys changed, validated afresh.

        Parameters
        ----------
        changes : mapping of str to object
            Dotted keys, ``"operation.torque"``, to values as a case file has them: text with a
            unit or a pint quantity for dimensional ones. None removes a key.

        Returns
        -------
        Case
            Of the same kind.

        Raises
        ------
        InputError
            With every problem of the changed case.
        """
        raw = copy.deepcopy(self._raw)
        for key, value in changes.items():
            _set(raw, key, value)
        return _build(type(self), raw, self._source)

    def inputs(self) -> dict[str, Any]:
        """The case as nested tables of text and numbers, defaults included, as a file has them."""
        return to_inputs(self)


class PlanetaryCase(_CaseTable):
    """A planetary gear set with its oil, surroundings and operating point."""

    kind: Literal["planetary"]
    title: str = ""
    operation: PlanetaryOperation
    gears: Gears
    sun: GearTable
    planet: Planet
    ring: Ring
    planet_bearing: PlanetBearing | None = None
    carrier: Carrier | None = None
    thrust_bearing: ThrustBearing | None = None
    lubricant: Lubricant
    surroundings: Surroundings = Surroundings()
    friction_table: FrictionTable | None = None
    models: PlanetaryModels = PlanetaryModels()
    numerics: Numerics = Numerics()
    losses: PlanetaryLosses = PlanetaryLosses()


class GearPairCase(_CaseTable):
    """A pair of gears on parallel axes with its oil, surroundings and operating point."""

    kind: Literal["gear_pair"]
    title: str = ""
    operation: GearPairOperation
    gears: Gears
    pinion: GearTable
    gear: PairGear
    lubricant: Lubricant
    surroundings: Surroundings = Surroundings()
    friction_table: FrictionTable | None = None
    models: GearPairModels = GearPairModels()
    numerics: Numerics = Numerics()
    losses: GearPairLosses = GearPairLosses()


Case = PlanetaryCase | GearPairCase
_KINDS: dict[str, type[PlanetaryCase] | type[GearPairCase]] = {
    "planetary": PlanetaryCase,
    "gear_pair": GearPairCase,
}


def load_case(path_or_name: str | Path | Mapping[str, Any]) -> Case:
    """Read and check a case.

    Parameters
    ----------
    path_or_name : str, Path or mapping
        A TOML file, the name of a built-in case (``"talbot-2012"``, ``"talbot-2012-n6-40C"``), or
        the tables of a case.

    Returns
    -------
    PlanetaryCase or GearPairCase

    Raises
    ------
    InputError
        With every problem found, not only the first.
    """
    if isinstance(path_or_name, Mapping):
        return _build_any(dict(path_or_name), "the given tables")
    text = str(path_or_name)
    path = Path(text)
    if path.suffix == ".toml" or path.exists():
        return _build_any(_read_file(path), text)
    try:
        return _build_any(library.builtin_case(text), text)
    except KeyError:
        raise InputError([_no_such_case(text)]) from None


def case_schema() -> dict[str, Any]:
    """JSON Schema of a case file."""
    union = TypeAdapter(Annotated[Case, Field(discriminator="kind")])
    return union.json_schema()


def _no_such_case(name: str) -> Problem:
    known = library.case_files()
    nearest = did_you_mean(name, known)
    return Problem(
        "CASE",
        repr(name),
        f"is neither a file nor a built-in case (built in: {', '.join(known)} and variants).",
        nearest or "See 'epicyclic cases'.",
    )


def _read_file(path: Path) -> dict[str, Any]:
    def fail(allowed: str, remedy: str) -> InputError:
        return InputError([Problem("", "", allowed, remedy)], str(path))

    try:
        if path.is_file() and path.stat().st_size > LARGEST_FILE:
            raise fail("the file is too large to be a case.", "Give a case file.")
        content = path.read_bytes()
    except OSError as error:
        raise fail(f"the file cannot be read: {error.strerror}.", "Check the path.") from None
    try:
        return tomllib.loads(content.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise fail("this is not a text file in UTF-8.", "Save it as UTF-8 text.") from None
    except tomllib.TOMLDecodeError as error:
        raise fail(f"this is not TOML: {error}.", "Mend that line.") from None
    except RecursionError:
        raise fail("the tables are nested too deep.", "Give a case file.") from None


def _build_any(raw: dict[str, Any], source: str) -> Case:
    kind = raw.get("kind")
    table = _KINDS.get(kind) if isinstance(kind, str) else None
    if table is None:
        given = "" if kind is None else repr(kind)
        missing = "is missing; it" if kind is None else ""
        raise InputError(
            [
                Problem(
                    "kind",
                    given,
                    f"{missing} must be one of {', '.join(_KINDS)}.".lstrip(),
                    did_you_mean(str(kind or ""), _KINDS) or 'Write kind = "planetary".',
                )
            ],
            source,
        )
    if table is PlanetaryCase:
        return _build(PlanetaryCase, raw, source)
    return _build(GearPairCase, raw, source)


def _build(table: type[AnyCase], raw: dict[str, Any], source: str) -> AnyCase:
    """Validate every table of `raw` by itself, then across tables; raise all problems at once."""
    problems = [
        _unknown_key(key, value, table) for key, value in raw.items() if key not in table.model_fields
    ]
    values: dict[str, Any] = {}
    sections: dict[str, Table] = {}
    for name, field in table.model_fields.items():
        section = table_of(field.annotation)
        if name in raw and section is not None and issubclass(section, Table):
            sound, found = _read_section(name, section, raw[name])
            problems += found
            if sound is not None:
                sections[name] = sound
            values[name] = sound
        elif name in raw:
            values[name] = raw[name]
        elif field.is_required():
            problems.append(_missing_table(name))
        elif isinstance(field.default, Table):
            sections[name] = field.default
    if not isinstance(raw.get("title", ""), str):
        problems.append(Problem("title", _shown(raw["title"]), "must be text.", "Quote it."))
    problems += cross_check(sections)
    if problems:
        raise InputError(problems, source)
    case = table(**values)
    case._raw = copy.deepcopy(raw)
    case._source = source
    return case


def _read_section(
    name: str, table: type[Table], raw: object
) -> tuple[Table | None, list[Problem]]:
    """The table if it can be used for further checks, and its problems.

    A table with unknown keys, or with unusable optional keys, is read again without them, so that
    the checks across tables still find what else is wrong.
    """
    if not isinstance(raw, Mapping):
        problem = Problem(name, _shown(raw), "must be a table of keys.", f"Write [{name}].")
        return None, [problem]
    alternatives = _check_alternatives(name, table, raw)
    try:
        return (None if alternatives else table.model_validate(raw)), alternatives
    except ValidationError as error:
        details = error.errors()
    problems = alternatives + [_translate(name, table, detail) for detail in details]
    if alternatives:
        return None, problems
    bad = {detail["loc"][0] for detail in details if detail["loc"]}
    try:
        return table.model_validate({k: v for k, v in raw.items() if k not in bad}), problems
    except ValidationError:
        return None, problems


def _check_alternatives(
    name: str, table: type[Table], raw: Mapping[str, Any]
) -> list[Problem]:
    """Exactly one of each group of alternatives must be given, and that one whole."""
    problems = []
    for group in table.EXACTLY_ONE:
        alternatives = [alternative.split("+") for alternative in group]
        started = [keys for keys in alternatives if any(key in raw for key in keys)]
        choice = " or ".join(" with ".join(keys) for keys in alternatives)
        if not started:
            problems.append(
                Problem(f"{name}.{alternatives[0][0]}", "", "is missing.", f"Give {choice}.")
            )
        elif len(started) > 1:
            given = ", ".join(key for keys in started for key in keys if key in raw)
            problems.append(
                Problem(
                    f"{name}.{started[1][0]}",
                    "",
                    f"conflicts: {given} say the same thing.",
                    f"Give exactly one: {choice}.",
                )
            )
        problems += [
            Problem(f"{name}.{key}", "", "is missing.", f"It belongs to {keys[0]}.")
            for keys in started
            for key in keys
            if key not in raw and len(started) == 1
        ]
    return problems


def _translate(section: str, table: type[Table], detail: ErrorDetails) -> Problem:
    """A pydantic error as a problem in the user's terms."""
    context = detail.get("ctx", {})
    location = [str(part) for part in detail["loc"]]
    key = ".".join([section, *location])
    given = _shown(detail["input"])
    kind = detail["type"]
    if kind == "extra_forbidden":
        owner = find_table(table, location[:-1]) or table
        return _unknown_key(key, detail["input"], owner)
    if kind == "missing":
        example = _example(table, location)
        return Problem(key, "", "is missing.", f"Add {example}." if example else "Add it.")
    if kind in ("quantity", "preset"):
        remedy = str(context.get("remedy", ""))
        sentence = remedy[:1].upper() + remedy[1:]
        return Problem(key, given, f"{detail['msg']}.", sentence and f"{sentence.rstrip('.?')}{'?' if '?' in sentence else '.'}")
    if kind == "literal_error":
        expected = str(context["expected"])
        choices = [word.strip("' ") for word in expected.replace(" or ", ",").split(",")]
        return Problem(key, given, f"must be {expected}.", did_you_mean(str(detail["input"]), choices))
    return Problem(key, given, f"{detail['msg']}.", "")


def find_table(table: type[Table], location: list[str]) -> type[BaseModel] | None:
    """The table class at `location` below `table`."""
    found: type[BaseModel] | None = table
    for name in location:
        field = found.model_fields.get(name) if found is not None else None
        found = table_of(field.annotation) if field is not None else None
    return found


def _example(table: type[Table], location: list[str]) -> str:
    found = find_field(table, ".".join(location))
    quantity = quantity_of(*found) if found is not None else None
    return f'{location[-1]} = "... {quantity.display}"' if quantity else f"{location[-1]} = ..."


def _unknown_key(key: str, value: object, table: type[BaseModel]) -> Problem:
    name = key.rpartition(".")[2]
    nearest = did_you_mean(name, table.model_fields)
    known = ", ".join(table.model_fields)
    return Problem(key, _shown(value), "is not a known key.", nearest or f"Known are: {known}.")


def _missing_table(name: str) -> Problem:
    return Problem(f"[{name}]", "", "is missing.", "Add this table; see 'epicyclic init'.")


def _shown(value: object) -> str:
    """A value as the user wrote it, cut to one line."""
    text = f'"{value}"' if isinstance(value, str) else str(value)
    text = " ".join(text.split())
    return text if len(text) <= LONGEST_SHOWN else f"{text[:LONGEST_SHOWN]}..."


def _set(raw: dict[str, Any], key: str, value: object) -> None:
    """Set dotted `key` of nested tables, making tables on the way; None removes it."""
    *path, name = key.split(".")
    table = raw
    for depth, part in enumerate(path):
        inner = table.setdefault(part, {})
        if not isinstance(inner, dict):
            owner = ".".join(path[: depth + 1])
            raise InputError(
                [Problem(key, _shown(value), f"{owner} is not a table.", "Check the key.")]
            )
        table = inner
    if value is None:
        table.pop(name, None)
    else:
        table[name] = value
