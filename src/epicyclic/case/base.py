"""What all kinds of cases share: how they are made from tables, changed and compared."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

from pydantic import PrivateAttr

from epicyclic.case.expand import gearing_of
from epicyclic.case.fields import find_field, key_parts, locate, path_of, to_inputs, written
from epicyclic.case.gear_tables import Gears, GearTable
from epicyclic.case.read import (
    case_html,
    case_line,
    owner_without_keys,
    plain,
    value_at,
    with_value,
    without,
)
from epicyclic.case.rules import cross_check
from epicyclic.case.sizing import Found, complete, converted_roughness, negative_teeth, told_oil
from epicyclic.case.tables.base import Table
from epicyclic.case.tables.uncertainty import check_uncertainty
from epicyclic.case.validation import AnyCase, Validation, tables_of, unknown_key, validate
from epicyclic.errors import InputError, Problem

if TYPE_CHECKING:
    from epicyclic.case.gearing import Gearing
    from epicyclic.case.tables.operation import LubricationTable, Surroundings

FILE_KEYS = ("oil_model", "pocketing_table", "file")  # Keys that name files, wherever they stand.
_DECIDED = (
    ("surroundings", "oil_air_ratio"),
    ("thermal", "lubrication"),
    ("thermal", "bath_share"),
)
"""Keys in place of whose defaults a value follows from [lubrication]."""


class CaseTable(Table):
    if TYPE_CHECKING:  # every kind has them, each in its place
        lubrication: LubricationTable | None
        surroundings: Surroundings

        @property
        def gearings(self) -> Mapping[str, Gearing]: ...

    _tables: dict[str, Any] = PrivateAttr(default_factory=dict)
    _source: str = PrivateAttr(default="")
    _found: tuple[Found, ...] = PrivateAttr(default=())
    _sound: Mapping[str, Table] = PrivateAttr(default_factory=dict)
    """What became of each of `_tables` by itself: those that stay need not be read again."""

    @property
    def found(self) -> tuple[Found, ...]:
        """What the tables leave out and the other ones tell, such as a profile shift."""
        return self._found

    @property
    def source(self) -> str:
        """The file or built-in case it was read from."""
        return self._source

    @property
    def folder(self) -> Path:
        """Where the files lie that it names: that of its file, or the current one."""
        return Path(self._source).parent

    def updated(
        self,
        # Dotted keys, ``"operation.torque"``, to values as a case file has them: text with a unit
        # or a pint quantity for dimensional ones. None removes a key.
        changes: Mapping[str, Any],
    ) -> Self:
        """A copy of the case with some keys changed, validated afresh.

        Returns
        -------
        Case
            Of the same kind.

        Raises
        ------
        InputError
            With every problem of the changed case.
        """
        own = self._tables or self.given()
        tables, problems = with_changes(type(self), own, changes)
        same = {
            key: table
            for key, table in self._sound.items()
            if key in own and tables.get(key) is own[key]
        }
        return type(self).from_tables(tables, self._source, problems, same)

    @classmethod
    def from_tables(
        cls,
        tables: dict[str, Any],
        source: str,  # The file or built-in case that they come from.
        problems: Sequence[Problem] = (),  # Found before.
        # Those of the tables that were read before.
        sound: Mapping[str, Table] = MappingProxyType({}),
    ) -> Self:
        """The case of `tables`, plain values, checked by themselves and against each other.

        Raises `InputError` with `problems` and every other one.
        """
        valid = validate(cls, tables, sound)
        validation, told = with_sizes(valid, tables)
        known = {problem.key for problem in problems}
        found = [
            *problems,
            *(problem for problem in validation.problems if problem.key not in known),
            *(
                as_given(problem, tables)
                for problem in cross_check(validation.sections, tables, Path(source).parent)
            ),
        ]
        made = cls._made(validation.case, tables, source, found)
        made._found, made._sound = told, valid.sections
        return made

    @classmethod
    def _made(
        cls, case: Self | None, tables: dict[str, Any], source: str, problems: list[Problem]
    ) -> Self:
        """The case with what it was made from; an error with all problems, if there are any."""
        if case is not None:
            case._tables, case._source = tables, source
        if case is not None and getattr(case, "uncertainty", {}):
            problems = [*problems, *check_uncertainty(case)]
        if case is None or problems:
            ordered = sorted(problems, key=lambda problem: _position(cls, problem))
            raise InputError(ordered, source)
        return case

    def given(self) -> dict[str, Any]:
        """The case as nested tables of the keys that were given, without defaults."""
        tables: dict[str, Any] = plain(self._tables or self.inputs())
        return tables

    def inputs(self) -> dict[str, Any]:
        """The case as nested tables of text and numbers, defaults included, as a file has them.

        Left out are defaults in place of which a value follows from [lubrication].
        """
        inputs = to_inputs(self)
        if self.lubrication is not None:
            for name, key in _DECIDED:
                if key not in getattr(self, name).model_fields_set:
                    del inputs[name][key]
        return inputs

    def __repr__(self) -> str:
        return case_line(type(self).__name__, self.given())

    __str__ = __repr__

    def _repr_html_(self) -> str:
        return case_html(type(self).__name__, self.given())

    def __eq__(self, other: object) -> bool:
        """Equal if every key has the same value, wherever the cases were read."""
        return type(self) is type(other) and self.__dict__ == other.__dict__

    def __hash__(self) -> int:
        return hash(tuple(it for it in self.__dict__.values() if not isinstance(it, dict)))


def with_sizes(
    validation: Validation[AnyCase], raw: Mapping[str, Any]
) -> tuple[Validation[AnyCase], tuple[Found, ...]]:
    """A validation with what its gears leave out; without [gears] if that cannot be found.

    Also what was found, and how signs and roughness were understood.
    """
    told: tuple[Found, ...] = ()
    if validation.case is not None:
        told = (*negative_teeth(raw), *converted_roughness(raw), *told_oil(raw))
    sections = dict(validation.sections)
    gears = sections.get("gears")
    if not isinstance(gears, Gears):
        return validation, told
    gearing = gearing_of(sections)
    if gearing is None:
        # something follows from gears of which some are not valid
        tables = [table for table in sections.values() if isinstance(table, GearTable)]
        if gears.center_distance is None or not all(table.states_thickness for table in tables):
            del sections["gears"]
            return Validation(None, sections, validation.problems), told
        return validation, told
    whole, found, problems = complete(gearing, raw)
    if problems:
        del sections["gears"]
        return Validation(None, sections, [*validation.problems, *problems]), told
    assert whole.shared is not None
    now: dict[str, Table] = {"gears": whole.shared, **whole.tables}
    changed = {key: table for key, table in now.items() if table is not sections[key]}
    case = validation.case
    if case is not None and changed:
        case = case.model_copy(update=changed)
    return Validation(case, sections | changed, validation.problems), told + found


def as_given(problem: Problem, tables: dict[str, Any]) -> Problem:
    """The problem with the values of its keys as the user wrote them."""
    values = [value_at(tables, path_of(key)) for key in problem.key.split(", ")]
    if any(value is None or isinstance(value, dict) for value in values):
        return problem
    return replace(problem, value=", ".join(map(written, values)))


def _position(kind: type[Table], problem: Problem) -> int:
    """Where the table of a problem stands in a case; problems of the file come first."""
    table = path_of(problem.key)[0] if problem.key else ""
    tables = ["", *kind.model_fields]
    return tables.index(table) if table in tables else len(tables)


def with_changes(
    kind: type[Table], tables: dict[str, Any], changes: Mapping[str, Any]
) -> tuple[dict[str, Any], list[Problem]]:
    """`tables` with some dotted keys changed, and the problems of those that cannot be."""
    problems: list[Problem] = []
    for key, value in changes.items():
        try:
            tables = _changed(kind, tables, str(key), plain(value))
        except InputError as error:
            problems += [replace(problem, key=str(key)) for problem in error.problems]
    return tables, problems


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
