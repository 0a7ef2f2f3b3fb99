"""A whole case, and how it is read, checked and changed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

from pydantic import BaseModel, Field, PrivateAttr, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

from epicyclic import library
from epicyclic.case.checks import cross_check
from epicyclic.case.fields import find_field, locate, to_inputs
from epicyclic.case.gear_tables import Gears, GearTable, MeshTable, PairGear, Planet, Ring
from epicyclic.case.model_tables import (
    ContactSolver,
    FrictionTable,
    GearPairLosses,
    GearPairModels,
    LoadSharing,
    Numerics,
    PlanetaryLosses,
    PlanetaryModels,
)
from epicyclic.case.nearest import did_you_mean, misspelt
from epicyclic.case.operation_tables import (
    GearPairOperation,
    Lubricant,
    PlanetaryOperation,
    Surroundings,
)
from epicyclic.case.part_tables import Carrier, PlanetBearing, ThrustBearing
from epicyclic.case.plain import plain, value_at, with_value, without
from epicyclic.case.reading import read_file
from epicyclic.case.schema import Table
from epicyclic.case.translation import unknown_key
from epicyclic.case.validation import tables_of, validate
from epicyclic.case.wording import one_line, path_of, written
from epicyclic.errors import InputError, Problem

__all__ = [
    "Case",
    "GearPairCase",
    "PlanetaryCase",
    "build_case",
    "case_schema",
    "changed_tables",
    "load_case",
]

AnyCase = TypeVar("AnyCase", bound="_CaseTable")


class _CaseTable(Table):
    _tables: dict[str, Any] = PrivateAttr(default_factory=dict)
    _source: str = PrivateAttr(default="")

    @property
    def source(self) -> str:
        """The file or built-in case it was read from."""
        return self._source

    @property
    def folder(self) -> Path:
        """Where the files lie that it names: that of its file, or the current one."""
        return Path(self._source).parent

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
        tables, problems = _with_changes(type(self), self.given(), changes)
        return _build(type(self), tables, self._source, problems)

    def given(self) -> dict[str, Any]:
        """The case as nested tables of the keys that were given, without defaults."""
        return self._tables or plain(self.inputs())

    def inputs(self) -> dict[str, Any]:
        """The case as nested tables of text and numbers, defaults included, as a file has them."""
        return to_inputs(self)

    def __eq__(self, other: object) -> bool:
        """Equal if every key has the same value, wherever the cases were read."""
        return type(self) is type(other) and self.__dict__ == other.__dict__

    def __hash__(self) -> int:
        return hash(tuple(self.__dict__.values()))


class PlanetaryCase(_CaseTable):
    """A planetary gear set with its oil, surroundings and operating point."""

    kind: Literal["planetary"]
    title: str = ""
    operation: PlanetaryOperation
    gears: Gears
    sun: GearTable
    planet: Planet
    ring: Ring
    sun_mesh: MeshTable = MeshTable()
    ring_mesh: MeshTable = MeshTable()
    planet_bearing: PlanetBearing | None = None
    load_sharing: LoadSharing = LoadSharing()
    carrier: Carrier | None = None
    thrust_bearing: ThrustBearing | None = None
    lubricant: Lubricant
    surroundings: Surroundings = Surroundings()
    friction_table: FrictionTable | None = None
    models: PlanetaryModels = PlanetaryModels()
    contact_solver: ContactSolver = ContactSolver()
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
    mesh: MeshTable = MeshTable()
    lubricant: Lubricant
    surroundings: Surroundings = Surroundings()
    friction_table: FrictionTable | None = None
    models: GearPairModels = GearPairModels()
    contact_solver: ContactSolver = ContactSolver()
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
        return _build_any(plain(path_or_name), "the given tables")
    if not isinstance(path_or_name, str | Path):
        raise InputError([_no_such_case(path_or_name)])
    name, path = str(path_or_name), Path(path_or_name)
    if path.suffix.lower() != ".toml" and not _holds(path.is_file):
        try:
            return _build_any(plain(library.builtin_case(name)), name)
        except KeyError:
            if len(path.parts) == 1 and not _holds(path.exists):
                raise InputError([_no_such_case(name)]) from None
    tables, problems = read_file(path)
    return _build_any(tables, name, problems)


def build_case(tables: Mapping[str, Any], changes: Mapping[str, Any], source: str) -> Case:
    """The case of `tables` of a known kind, which may need the `changes` to be complete.

    Raises
    ------
    InputError
        With every problem of the changed tables, as problems of `source`.
    """
    changed, problems = _with_changes(_KINDS[tables["kind"]], plain(tables), changes)
    return _build_any(changed, source, problems)


def changed_tables(tables: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`tables` of a known kind with the `changes`; those that cannot be are left out."""
    return _with_changes(_KINDS[tables["kind"]], plain(tables), changes)[0]


def case_schema() -> dict[str, Any]:
    """JSON Schema of a case file."""
    union = TypeAdapter(Annotated[Case, Field(discriminator="kind")])
    return {
        "$schema": _FileSchema.schema_dialect,
        **union.json_schema(schema_generator=_FileSchema),
    }


class _FileSchema(GenerateJsonSchema):
    """Tables that are defaults appear as a file has them, with units."""

    def encode_default(self, dft: Any) -> Any:
        return to_inputs(dft) if isinstance(dft, BaseModel) else super().encode_default(dft)


def _holds(test: Callable[[], bool]) -> bool:
    """The result of a `test` of a path; False for a path too long to be one."""
    try:
        return test()
    except OSError:
        return False


def _no_such_case(name: object) -> Problem:
    if not isinstance(name, str):
        allowed = "must be a path, the name of a built-in case, or the tables of a case."
        return Problem("CASE", one_line(repr(name)), allowed, "Give one of these.")
    known = library.case_files()
    allowed = f"is neither a file nor a built-in case (built in: {', '.join(known)} and variants)."
    base = max((file for file in known if name.startswith(f"{file}-")), key=len, default="")
    groups = library.case_variants().get(base, [])
    words = "; ".join(" or ".join(group["words"]) for group in groups)
    if words:
        remedy = f"Variants are named {base}- and at most one word of each group: {words}."
    else:
        remedy = did_you_mean(name, known) or "See 'epicyclic cases'."
    return Problem("CASE", written(name), allowed, remedy)


def _build_any(tables: dict[str, Any], source: str, problems: Sequence[Problem] = ()) -> Case:
    """The case of `tables`; if they name no kind, every problem under the likeliest one."""
    given = tables.get("kind")
    name = given if isinstance(given, str) and given in _KINDS else ""
    if not name:
        name = misspelt(str(given), _KINDS) or max(
            _KINDS, key=lambda kind: len(tables.keys() & tables_of(_KINDS[kind]).keys())
        )
        allowed = f"must be {' or '.join(_KINDS)}."
        if given is None:
            allowed = f"is missing; it {allowed}"
        shown = "" if given is None else written(given)
        problems = [*problems, Problem("kind", shown, allowed, f'Write kind = "{name}".')]
        tables = tables | {"kind": name}
    if name == "planetary":
        return _build(PlanetaryCase, tables, source, problems)
    return _build(GearPairCase, tables, source, problems)


def _build(
    kind: type[AnyCase], tables: dict[str, Any], source: str, problems: Sequence[Problem] = ()
) -> AnyCase:
    """Validate `tables` by themselves and against each other; raise all problems at once."""
    validation = validate(kind, tables)
    known = {problem.key for problem in problems}
    found = [
        *problems,
        *(problem for problem in validation.problems if problem.key not in known),
        *(
            _as_given(problem, tables)
            for problem in cross_check(validation.sections, tables, Path(source).parent)
        ),
    ]
    case = validation.case
    if case is None or found:
        raise InputError(sorted(found, key=lambda problem: _position(kind, problem)), source)
    case._tables = tables
    case._source = source
    return case


def _as_given(problem: Problem, tables: dict[str, Any]) -> Problem:
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


def _with_changes(
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
    path = key.split(".")
    for depth in range(1, len(path)):
        owner = value_at(tables, path[:depth])
        if owner is not None and not isinstance(owner, dict):
            name = ".".join(path[:depth])
            allowed = f"{name} is {written(owner)}, which has no keys."
            remedy = f"Change {name} to a table first."
            raise InputError([Problem(key, written(value), allowed, remedy)])
    if value is not None:
        return with_value(tables, path, value)
    if value_at(tables, path) is not None:
        return without(tables, path)
    if find_field(kind, key) is None:
        raise InputError([unknown_key(locate(kind, path), None, tables_of(kind).items())])
    return tables
