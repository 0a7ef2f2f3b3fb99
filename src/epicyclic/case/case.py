"""A whole case, and how it is read, checked and changed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, Field, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema

from epicyclic import library
from epicyclic.case.base import CaseTable, with_changes
from epicyclic.case.expand import expand
from epicyclic.case.fields import to_inputs
from epicyclic.case.gear_tables import Gears, GearTable, PairGear, Planet, Ring, SetMesh
from epicyclic.case.gearing import Gearing
from epicyclic.case.messages import did_you_mean, misspelt, one_line, written
from epicyclic.case.read import plain, read_file
from epicyclic.case.tables.elements import Carrier, PlanetBearing, ThrustBearing
from epicyclic.case.tables.models import (
    ContactSolver,
    FrictionTable,
    GearPairLosses,
    GearPairModels,
    LoadSharing,
    Numerics,
    PlanetaryLosses,
    PlanetaryModels,
)
from epicyclic.case.tables.operation import (
    LUBRICATION,
    GearPairOperation,
    Lubricant,
    LubricationTable,
    PlanetaryOperation,
    Surroundings,
    ThermalTable,
)
from epicyclic.case.tables.uncertainty import UNCERTAINTY, DistributionTable
from epicyclic.case.train import TrainCase
from epicyclic.case.train_tables import StateTable
from epicyclic.case.validation import tables_of
from epicyclic.errors import InputError, Problem


class _SetTables(CaseTable):
    """What a set or pair has in common with a train, and with a set of a train."""

    @property
    def states(self) -> dict[str, StateTable]:
        """There is one only, without a name."""
        return {}

    @property
    def computed(self) -> bool:
        """No loss is given."""
        return True

    @property
    def gearings(self) -> dict[str, Gearing]:
        """Its gears and meshes; the only set has no name."""
        return {"": expand(dict(self))[0]}


class PlanetaryCase(_SetTables):
    """A planetary gear set with its oil, surroundings and operating point."""

    kind: Literal["planetary"]
    title: str = ""
    operation: PlanetaryOperation
    gears: Gears
    sun: GearTable
    planet: Planet
    ring: Ring
    sun_mesh: SetMesh = SetMesh()
    ring_mesh: SetMesh = SetMesh()
    planet_bearing: PlanetBearing | None = None
    load_sharing: LoadSharing = LoadSharing()
    carrier: Carrier | None = None
    thrust_bearing: ThrustBearing | None = None
    lubricant: Lubricant
    lubrication: LubricationTable | None = LUBRICATION
    surroundings: Surroundings = Surroundings()
    thermal: ThermalTable = ThermalTable()
    friction_table: FrictionTable | None = None
    models: PlanetaryModels = PlanetaryModels()
    contact_solver: ContactSolver = ContactSolver()
    numerics: Numerics = Numerics()
    losses: PlanetaryLosses = PlanetaryLosses()
    uncertainty: dict[str, DistributionTable] = UNCERTAINTY


class GearPairCase(_SetTables):
    """A pair of gears on parallel axes with its oil, surroundings and operating point."""

    kind: Literal["gear_pair"]
    title: str = ""
    operation: GearPairOperation
    gears: Gears
    pinion: GearTable
    gear: PairGear
    mesh: SetMesh = SetMesh()
    lubricant: Lubricant
    lubrication: LubricationTable | None = LUBRICATION
    surroundings: Surroundings = Surroundings()
    thermal: ThermalTable = ThermalTable()
    friction_table: FrictionTable | None = None
    models: GearPairModels = GearPairModels()
    contact_solver: ContactSolver = ContactSolver()
    numerics: Numerics = Numerics()
    losses: GearPairLosses = GearPairLosses()
    uncertainty: dict[str, DistributionTable] = UNCERTAINTY


Case = PlanetaryCase | GearPairCase | TrainCase
KINDS: Mapping[str, type[PlanetaryCase] | type[GearPairCase] | type[TrainCase]] = {
    "planetary": PlanetaryCase,
    "gear_pair": GearPairCase,
    "train": TrainCase,
}


def read_case(source: str | Path | Mapping[str, Any]) -> Case:
    """A case from a TOML file, the name of a built-in one or its tables, checked.

    Raises `InputError` with every problem found, not only the first.
    """
    if isinstance(source, Mapping):
        return _build_any(plain(source), "the given tables")
    if not isinstance(source, str | Path):
        raise InputError([_no_such_case(source)])
    name, path = str(source), Path(source)
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

    Raises `InputError` with every problem of the changed tables, as problems of `source`.
    """
    changed, problems = with_changes(KINDS[tables["kind"]], plain(tables), changes)
    return _build_any(changed, source, problems)


def changed_tables(tables: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`tables` of a known kind with the `changes`; those that cannot be are left out."""
    return with_changes(KINDS[tables["kind"]], plain(tables), changes)[0]


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
    name = given if isinstance(given, str) and given in KINDS else ""
    if not name:
        name = misspelt(str(given), KINDS) or max(
            KINDS, key=lambda kind: len(tables.keys() & tables_of(KINDS[kind]).keys())
        )
        allowed = f"must be {' or '.join(KINDS)}."
        if given is None:
            allowed = f"is missing; it {allowed}"
        shown = "" if given is None else written(given)
        problems = [*problems, Problem("kind", shown, allowed, f'Write kind = "{name}".')]
        tables = tables | {"kind": name}
    return KINDS[name].from_tables(tables, source, problems)
