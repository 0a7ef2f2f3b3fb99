"""A whole case, and how it is read, checked and changed: a set, a pair or a train."""

from __future__ import annotations

import cmath
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cached_property, lru_cache
from html import escape
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple, Self, cast

from pydantic import BaseModel, Field, PrivateAttr, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import PydanticCustomError, ValidationError

from epicyclic import library
from epicyclic.case.expand import expand
from epicyclic.case.gear_tables import Gears, GearTable, PairGear, Planet, Ring, SetMesh
from epicyclic.case.keys import field_at, known_keys, value_of, with_changes
from epicyclic.case.rules import (
    bearing_force_problems,
    check_listed_bearings,
    cross_check,
    listed_problems,
    name_problems,
    operation_problems,
)
from epicyclic.case.tables.base import builtin_oil, roughness_told
from epicyclic.case.tables.elements import (
    Carrier,
    ElementTable,
    ElementTables,
    PlanetBearing,
    PlanetPin,
    Position,
    SealTable,
    ThrustBearing,
    between,
)
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
    HousingLevel,
    Lubricant,
    LubricationTable,
    PlanetaryOperation,
    Surroundings,
    ThermalTable,
    check_outlet,
    needs_level,
)
from epicyclic.case.tables.strength import STRENGTH, StrengthTable
from epicyclic.case.tables.uncertainty import UNCERTAINTY, DistributionTable, stated_values
from epicyclic.case.train_tables import (
    GIVEN,
    ComputedSet,
    GivenListedSet,
    ListedMesh,
    ListedSet,
    PairSet,
    SetTable,
    StateTable,
    TrainOperation,
    form_of_set,
)
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import InputError, Problem, one_problem
from epicyclic.gears.assembly import place_problems, rack_problems, set_problems
from epicyclic.gears.gearing import Gearing
from epicyclic.gears.sizing import Found, complete, places_told, problems_of_some
from epicyclic.machine.train_shape import TrainShape, shape_of_train
from epicyclic.messages import (
    did_you_mean,
    either,
    misspelt,
    one_line,
    part_name_problems,
    path_of,
    refused,
    value_at,
    written,
)
from epicyclic.oil.grades import short_oil_told
from epicyclic.schema.fields import Table, quantity_of, to_inputs
from epicyclic.schema.read import flattened, plain, read_file, split_key
from epicyclic.schema.validation import AnyCase, Validation, tables_of, validate
from epicyclic.units import unit_text

# What all kinds of cases share: how they are made from tables, changed and compared.

FILE_KEYS = ("oil_model", "pocketing_table", "file")  # Keys that name files, wherever they stand.
_DECIDED = ("surroundings", "oil_air_ratio"), ("thermal", "lubrication"), ("thermal", "bath_share")
"""Keys in place of whose defaults a value follows from [lubrication]."""
_BESIDE_GEARS = {
    *("kind", "title", "operation", "lubrication", "surroundings", "thermal", "models", "numerics"),
    *("losses", "friction_table", "contact_solver", "uncertainty", "carrier", "thrust_bearing"),
    *("planet_bearing", "planet_pin", "load_sharing"),
}
"""Tables on which gears do not depend."""
_MAGNITUDES = {"torque", "speed", "oil_inlet_temperature"}
"""Of [operation]: whatever they are, the case moves or stands as it was checked to."""


@dataclass(frozen=True, eq=False)
class Design:
    """What cases have in common that differ in [operation] only; it equals itself."""

    tables: Mapping[str, Any]  # Of the first of them.

    @cached_property
    def names_files(self) -> bool:
        """True if it is of one case only, because the content of files may change."""
        leaves = (key.rpartition(".")[2] for key, _ in flattened(self.tables))
        return not set(FILE_KEYS).isdisjoint(leaves)


class CaseTable(Table):
    if TYPE_CHECKING:  # every kind has them, each in its place
        operation: Any
        lubrication: LubricationTable | None
        surroundings: Surroundings
        thermal: ThermalTable
        uncertainty: dict[str, DistributionTable]

        @property
        def gearings(self) -> Mapping[str, Gearing]: ...

    _tables: dict[str, Any] = PrivateAttr(default_factory=dict)
    _source: str = PrivateAttr(default="")
    _found: tuple[Found, ...] = PrivateAttr(default=())
    _replaced: tuple[Found, ...] = PrivateAttr(default=())
    _gearings: dict[str, Gearing] = PrivateAttr(default_factory=dict)
    _sound: Mapping[str, Table] = PrivateAttr(default_factory=dict)
    """What became of each of `_tables` by itself: those that stay need not be read again."""
    _design: Design = PrivateAttr(default_factory=lambda: Design({}))

    @property
    def found(self) -> tuple[Found, ...]:
        """What the tables leave out and the other ones tell, and what changes replaced in them."""
        return (*self._found, *self._replaced)

    @property
    def elements(self) -> Iterator[tuple[str, str, ElementTable]]:
        """Kind, name and table of every bearing, seal and other drag."""
        for kind in ElementTables.model_fields:
            for name, table in getattr(self, kind, {}).items():
                yield kind, name, table

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
        # or a pint quantity for dimensional ones, or a number with the unit behind the key,
        # ``"operation.torque [N*m]"``. None removes a key. A key also removes those of which the
        # case may have only one, such as thermal.oil_flow for thermal.oil_outlet_temperature.
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
        changed = with_changes(type(self), self._tables or self.given(), changes)
        made = None if changed.problems else self._operated(changed.tables)
        if made is None:
            made = type(self).from_tables(changed.tables, self._source, changed.problems, self)
        stands = (one for one in self._replaced if value_at(changed.tables, path_of(one.key)))
        made._replaced = (*stands, *changed.replaced)
        return made

    @property
    def design(self) -> Design:
        """All that it states but [operation]."""
        return self._design

    def _operated(self, tables: dict[str, Any]) -> Self | None:
        """The case of `tables`, if they differ in [operation] only and nothing is wrong there."""
        own = self._tables
        old, new = (it.get("operation", {}) for it in (own, tables))
        others = (tables.keys() | own.keys()) - {"operation"}
        if not old or any(tables.get(key) is not own.get(key) for key in others):
            return None
        with suppress(ValidationError):
            operation = type(self.operation).model_validate(new, strict=True)
            made = self.model_copy(update={"operation": operation})
            made._tables, made._sound = tables, {**self._sound, "operation": operation}
            wrong = [*check_outlet(self.thermal, operation.oil_inlet_temperature)]
            wrong += stated_values(made)[1] if self.uncertainty else []
            if not wrong and old.keys() == new.keys() and not self._design.names_files:
                turned = any(new[key] is not old[key] for key in old.keys() - _MAGNITUDES)
                return made if not turned or made._operation_holds(self) else None
        return None

    def _operation_holds(self, before: Self) -> bool:
        """Whether [operation] is right, in which alone it differs from a sound case."""
        return not any(cross_check({"operation": self.operation}, (), Path()))

    def _unchanged(self, tables: Mapping[str, Any]) -> dict[str, Table]:
        """Those of its own tables that `tables`, made from them by changes, still have."""
        own = self._tables
        return {
            key: table
            for key, table in self._sound.items()
            if key in own and tables.get(key) is own[key]
        }

    @classmethod
    def from_tables(
        cls,
        tables: dict[str, Any],
        source: str,  # The file or built-in case that they come from.
        problems: Sequence[Problem] = (),  # Found before.
        # That of which some tables were changed; what only depends on others is as it was.
        before: CaseTable | None = None,
    ) -> Self:
        """The case of `tables`, plain values, checked by themselves and against each other.

        Raises `InputError` with `problems` and every other one.
        """
        same = {} if before is None else before._unchanged(tables)
        valid, kept = validate(cls, tables, same), None
        fresh = (tables.keys() | ({} if before is None else before._tables).keys()) - same.keys()
        if before is not None and before._gearings and fresh <= _BESIDE_GEARS:
            notes = (*before._found, *converted_roughness({key: tables.get(key) for key in fresh}))
            if all(path_of(it.key)[0] not in fresh for it in notes):  # else all is told anew
                kept = before._gearings[""], before._found  # gears that were found and checked
        validation, told, gearing = with_sizes(valid, tables, kept)
        folder = Path(source).parent
        crossed = cross_check(validation.sections, tables, folder, gearing, kept and fresh)
        found = _all_of(problems, validation, crossed, tables)
        if validation.case is not None and getattr(validation.case, "seals", None):
            validation.case._source = source
            found += _part_problems(validation.case, {name: name for name in _SHAFTS}, {})
        sound = None if validation.problems else validation.case
        made = cls._made(sound, tables, source, list(dict.fromkeys(found)))
        made._found, made._sound = told, valid.sections
        if gearing is not None:
            made._gearings = {"": gearing}
        return made

    @classmethod
    def _made(
        cls, case: Self | None, tables: dict[str, Any], source: str, problems: list[Problem]
    ) -> Self:
        """The case with what it was made from; an error with all problems, if there are any."""
        if case is not None:
            case._tables, case._source, case._design = tables, source, Design(tables)
            problems = [*problems, *(stated_values(case)[1] if case.uncertainty else ())]
        if case is None or problems:
            raise InputError(sorted(problems, key=lambda problem: _position(cls, problem)), source)
        return case

    def __getitem__(self, key: str) -> Any:
        """The value at a dotted key: in SI, or in the unit behind it, ``"operation.speed [rpm]"``.

        None where the case has no value. Raises `InputError` if there is no such key.
        """
        own, unit = split_key(key)
        known = field_at(self, own)
        if known is None:
            remedy = did_you_mean(own, known_keys(self)) or "See 'epicyclic init' for keys."
            raise InputError([Problem(own, "", "is not a known key.", remedy)], self._source)
        value, quantity = value_of(self, own), quantity_of(*known)
        if not unit or value is None or quantity is None:
            return value
        try:
            factor, zero = quantity.scale_from(unit)
        except PydanticCustomError as error:
            raise InputError([refused(error, own, f"[{unit}]")], self._source) from None
        return (quantity.to_display(value) - zero) / factor

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
        given = self.given()
        words = [f"title={given['title']!r}"] if given.get("title") else []
        words += [f"{key}={value!r}" for key, value in given.get("operation", {}).items()]
        return f"{type(self).__name__}({', '.join(words)})"

    __str__ = __repr__

    def _repr_html_(self) -> str:
        """The keys that were given, table by table, in the units of case files."""
        given = self.given()
        alone = {key: value for key, value in given.items() if not isinstance(value, Mapping)}
        tables = {"": alone} | {key: it for key, it in given.items() if isinstance(it, Mapping)}
        cell = '<td style="text-align: left">'
        rows = "".join(
            f"<tr>{cell}<strong>{escape(key if number == 0 else '')}</strong></td>"
            f"{cell}{escape(name)}</td>"
            f"{cell}{escape(unit_text(value) if isinstance(value, str) else str(value))}</td></tr>"
            for key, table in tables.items()
            for number, (name, value) in enumerate(flattened(table))
        )
        title = escape(str(given.get("title") or type(self).__name__))
        return f"<table><caption><strong>{title}</strong></caption><tbody>{rows}</tbody></table>"

    def __eq__(self, other: object) -> bool:
        """Equal if every key has the same value, wherever the cases were read."""
        return type(self) is type(other) and self.__dict__ == other.__dict__

    def __hash__(self) -> int:
        return hash(tuple(it for it in self.__dict__.values() if not isinstance(it, dict)))


def with_sizes(
    validation: Validation[AnyCase],
    raw: Mapping[str, Any],
    known: tuple[Gearing, tuple[Found, ...]] | None = None,  # If the gears were read before.
) -> tuple[Validation[AnyCase], tuple[Found, ...], Gearing | None]:
    """A validation with what its gears leave out; without [gears] if that cannot be found.

    Also what was found and how signs and roughness were understood, and the gears of a planetary
    set or a pair if nothing is wrong with their tables, whether they are complete or not.
    """
    told: tuple[Found, ...] = ()
    if validation.case is not None and known is None:
        told = (*negative_teeth(raw), *converted_roughness(raw), *told_oil(raw))
    sections = dict(validation.sections)
    gears = sections.get("gears")
    if not isinstance(gears, Gears):
        return validation, told, None
    planetary, pair = ("sun", "planet", "ring"), ("pinion", "gear")
    gearing = None if known is None else known[0]
    if known is None and any(sections.keys() >= set(names) for names in (planetary, pair)):
        gearing, _ = expand(sections)
    if gearing is None:
        # something follows from gears of which some are not valid
        tables = {key: it for key, it in sections.items() if isinstance(it, GearTable)}
        if gears.center_distance is None or not all(it.states_thickness for it in tables.values()):
            del sections["gears"]
        stand_in = SimpleNamespace(teeth=1, internal=False, count=1, angles=None)
        others = dict.fromkeys(planetary if raw.keys().isdisjoint(pair) else pair, stand_in)
        whole = expand({"gears": gears, **others, **tables})[0]
        some = (as_given(it, dict(raw)) for it in problems_of_some(whole, tables, raw))
        return Validation(None, sections, [*validation.problems, *some]), told, None
    whole, found, problems = complete(gearing, raw) if known is None else (*known, [])
    if problems:
        del sections["gears"]
        found_wrong = [*validation.problems, *problems]
        return Validation(validation.case, sections, found_wrong), told, gearing
    assert whole.shared is not None
    now: dict[str, Any] = {"gears": whole.shared, **whole.tables}
    changed = {key: table for key, table in now.items() if table is not sections[key]}
    case = validation.case
    if case is not None and changed:
        case = case.model_copy(update=changed)
    return Validation(case, sections | changed, validation.problems), told + found, whole


def negative_teeth(raw: Mapping[str, Any]) -> Iterator[Found]:
    """How negative numbers of teeth are understood."""
    tables = dict(raw)
    members = tables.pop("members", {})
    tables |= {f"gears.{name}": table for name, table in members.items()}
    for name, table in tables.items():
        teeth = table.get("teeth") if isinstance(table, dict) else None
        if isinstance(teeth, int) and teeth < 0:
            yield Found(
                f"{name}.teeth",
                str(-teeth),
                "a ring gear, because the number is negative; its profile shift is as in ISO "
                "21771 and DIN 3960, positive if it makes the teeth thicker.",
            )


def converted_roughness(raw: Mapping[str, Any]) -> Iterator[Found]:
    """How roughness that is stated as Ra or Rz is converted."""
    for key, value in flattened(raw):
        if key.endswith("roughness") and (told := roughness_told(value)) is not None:
            yield Found(key, f"{1e6 * told[0]:.4g} um", told[1])


def told_oil(raw: Mapping[str, Any]) -> Iterator[Found]:
    """What an oil stands for that is stated by its grade or two viscosities."""
    oil = value_at(dict(raw), ("lubricant", "oil"))
    told = short_oil_told(oil, builtin_oil(oil))
    if told is not None:
        yield Found("lubricant.oil", *told)


def _all_of(
    problems: Sequence[Problem], checked: Validation[Any], crossed: Iterable[Problem], tables: Any
) -> list[Problem]:
    """Problems found before, those of other keys, and those of keys against each other."""
    known = {problem.key for problem in problems}
    own = (problem for problem in checked.problems if problem.key not in known)
    return [*problems, *own, *(as_given(problem, tables) for problem in crossed)]


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


# A train: gear sets joined by shafts, with brakes, clutches, bearings, seals and other drags.


_SHARED = ("models", "numerics", "friction_table", "lubrication")
"""Tables of a train that its computed sets take over where they have none of their own."""


class _TrainTables(CaseTable):
    """What a train states beside its elements; its sets are read one by one."""

    kind: Literal["train"]
    title: str = ""
    operation: TrainOperation
    sets: Any = None
    shafts: dict[str, tuple[str, ...]] = Field(default={})
    states: dict[str, StateTable] = Field(default={})
    positions: dict[str, Position] = Field(default={})
    lubricant: Lubricant | None = None
    lubrication: LubricationTable | None = LUBRICATION
    housing: HousingLevel | None = None
    surroundings: Surroundings = Surroundings()
    thermal: ThermalTable = ThermalTable()
    friction_table: FrictionTable | None = None
    models: PlanetaryModels = PlanetaryModels()
    contact_solver: ContactSolver = ContactSolver()
    numerics: Numerics = Numerics()
    uncertainty: dict[str, DistributionTable] = UNCERTAINTY
    strength: StrengthTable | None = STRENGTH


MOST_SETS = 64
"""Of a train: what is checked grows with their cube, and gearboxes have ten at most."""


class _TrainHead(ElementTables, _TrainTables):
    """A train without its sets."""


class TrainCase(_TrainHead):
    """A train: gear sets joined by shafts."""

    sets: dict[str, SetTable]

    _shape: TrainShape = PrivateAttr()

    @property
    def shape(self) -> TrainShape:
        """Its bodies, meshes and shafts."""
        return self._shape

    @property
    def gearings(self) -> Mapping[str, Gearing]:
        """Gears and meshes of every set, by its name."""
        return self._shape.sets

    @property
    def state(self) -> StateTable:
        """The state in which it runs: what is braked and joined."""
        name = self.operation.state
        return StateTable() if name is None else self.states[name]

    @property
    def computed(self) -> bool:
        """False if every loss is given."""
        sets = any(gearing.computed for gearing in self.shape.sets.values())
        return sets or any(True for _ in self.elements)

    @property
    def computed_sets(self) -> Iterator[tuple[str, ComputedSet]]:
        """Sets whose losses are computed, by name."""
        for name, table in self.sets.items():
            if isinstance(table, ComputedSet):
                yield name, table

    @property
    def centers(self) -> dict[str, dict[str, tuple[complex, ...]]]:
        """Where the bodies of each set stand from the shaft of [housing], y upwards. [m]

        Sets that no shafts of known places join to it are left out.
        """
        own = self.housing or HousingLevel.model_construct(shaft=None, tilt=0.0)
        turn = cmath.exp(1j * own.tilt)
        places = self.shape.places(self.shape.shaft_of(own.shaft or self.operation.input) or "")
        return {
            name: {
                body: tuple(turn * (place + at) for at in centers)
                for body, centers in self.shape.sets[name].centers.items()
            }
            for name, place in places.items()
        }

    @property
    def oil_heights(self) -> dict[str, dict[str, float]]:
        """The oil of [housing] above the axis of each body, by the sets that dip into it. [m]

        Theory (N11).
        """
        if self.housing is None:
            return {}
        level, centers = self.housing.height, self.centers
        return {
            name: {body: level - at[0].imag for body, at in centers[name].items()}
            for name, table in self.computed_sets
            if table.lubrication and needs_level(table.lubrication) and name in centers
        }

    def position_of(self, gear: str) -> float | None:
        """Position of a gear along its shaft, by its name or that of its body. [m]"""
        name, _, member = gear.partition(".")
        body = self.shape.sets[name].bodies.get(member, member)
        return self.positions.get(gear, self.positions.get(f"{name}.{body}"))

    def inputs(self) -> dict[str, Any]:
        """The case as nested tables of text and numbers, defaults included, as a file has them."""
        inputs = super().inputs()
        for table in inputs["sets"].values():
            if "members" in table:
                table["gears"] = table.get("gears", {}) | table.pop("members")
        return inputs

    def __hash__(self) -> int:
        operation = self.operation
        return hash((self.title, *self.sets, operation.state, operation.torque, operation.speed))

    def __reduce__(self) -> tuple[Any, ...]:
        return TrainCase.from_tables, (self.given(), self.source)

    @classmethod
    def from_tables(
        cls,
        tables: dict[str, Any],
        source: str,
        problems: Sequence[Problem] = (),
        before: CaseTable | None = None,
    ) -> Self:
        """The train of `tables`; parameters and errors as of every case."""
        folder = Path(source).parent
        given = tables.get("sets")
        raw_sets: dict[str, Any] = given if isinstance(given, dict) else {}
        named = tuple(raw_sets)
        if len(named) > MOST_SETS:
            allowed = f"must be at most {MOST_SETS}."
            remedy = "Split the train at a shaft, and compute each part as a train of its own."
            raise one_problem("sets", f"{len(named)} sets", allowed, remedy, source)
        sound = {} if before is None else before._unchanged(tables)
        whole = validate(_TrainHead, {k: v for k, v in tables.items() if k != "sets"}, sound, named)
        own_tables = {k: v for k, v in whole.sections.items() if k != "operation"}
        # whether the sets have a bearing is checked with them
        crossed = cross_check(own_tables, {*tables, "planet_bearing"}, folder)
        found = _all_of(problems, whole, crossed, tables)
        if not named:
            shown, allowed = "" if given is None else written(given), "must hold at least one set."
            remedy = "Add [sets.NAME] and its gears."
            found.append(Problem("sets", shown, allowed, remedy))
        shared = {key: tables[key] for key in _SHARED if key in tables and key in whole.sections}
        sets: dict[str, SetTable] = {}
        shapes: dict[str, Gearing] = {}
        sizes: list[Found] = []
        complete = True
        joined = _joined_members(named, [tables.get(k) for k in ("shafts", "states", "operation")])
        for name in named:
            read = _read_set(raw_sets[name], shared, folder)
            found += [_below(f"sets.{name}", problem) for problem in read.problems]
            found += part_name_problems(f"sets.{name}", name, "set")
            sizes += [replace(one, key=f"sets.{name}.{one.key}") for one in read.found]
            if read.table is not None:
                sets[name] = read.table
                shapes[name], wrong = expand(dict(read.table), joined.get(name, ()))
                if isinstance(read.table, GivenListedSet):
                    wrong = [*wrong, *name_problems(shapes[name])]
                    wrong += [] if wrong else place_problems(shapes[name])
                complete = complete and not wrong
                found += [_below(f"sets.{name}", problem) for problem in wrong]
                if isinstance(read.table, ListedSet) and not wrong:
                    made, told, lacks = _complete(read.table, shapes[name], raw_sets[name])
                    sets[name], shapes[name] = made
                    sizes += [replace(one, key=f"sets.{name}.{one.key}") for one in told]
                    found += [as_given(_below(f"sets.{name}", lack), tables) for lack in lacks]
        case = whole.case
        if case is None or len(sets) < len(named) or not named:
            # what depends on shafts and their members is not known
            found += [] if case is None else _element_problems(case, named, None)
            return cls._made(None, tables, source, found)
        values = {key: getattr(case, key) for key in type(case).model_fields}
        train = cls.model_construct(**values | {"sets": sets})
        train._source, train._found = source, (*sizes, *told_oil(tables))
        train._sound = whole.sections
        train._shape, wrong = shape_of_train(shapes, train.shafts)
        complete = complete and not wrong
        found += wrong
        found += _element_problems(train, named, train)
        found += operation_problems(train, complete)
        found += bearing_force_problems(train, complete)
        return cls._made(cast(Self, train), tables, source, found)

    def _operation_holds(self, before: Self) -> bool:
        sets, tables = list(self.sets), [it._tables["operation"] for it in (before, self)]
        members = [_joined_members(sets, it) for it in tables]
        return members[0] == members[1] and not operation_problems(self, complete=True)


_OWN_TABLE = re.compile(r"\[(?=(carrier|gear|mesh|pinion|planet|ring|sun|thrust)\w*[].])")
"""Where a text names a table that only a set has."""


def _below(prefix: str, problem: Problem) -> Problem:
    """A problem of a set or part as one of the train."""
    keys = ", ".join(f"{prefix}.{key}" if key else prefix for key in problem.key.split(", "))
    told = (_OWN_TABLE.sub(f"[{prefix}.", it) for it in (problem.allowed, problem.remedy))
    return Problem(keys, problem.value, *told)


def _joined_members(sets: Sequence[str], places: Any) -> dict[str, set[str]]:
    """Members of each set that shafts, states and operation name."""
    found: dict[str, set[str]] = {}
    for name, _, member in (text.partition(".") for text in _texts(places)):
        if member and name in sets:  # or it is a number
            found.setdefault(name, set()).add(member)
    return found


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for key, item in value.items():
            yield str(key)
            yield from _texts(item)
    elif isinstance(value, list | tuple):
        for item in value:
            yield from _texts(item)


class _ReadSet(NamedTuple):
    table: SetTable | None  # None if a table of it is not valid by itself.
    problems: list[Problem]
    found: tuple[Found, ...] = ()


def _read_set(raw: Any, shared: Mapping[str, Any], folder: Path) -> _ReadSet:
    if not isinstance(raw, dict):
        remedy = "Write [sets.NAME] and its keys below it."
        return _ReadSet(None, [Problem("", written(raw), "must be a table of keys.", remedy)])
    return _read_set_cached(_Given(raw, dict(shared), folder, repr((raw, shared))))


@dataclass(frozen=True)
class _Given:
    """What a set is read from: equal if every value is the same and of the same type."""

    raw: dict[str, Any] = field(compare=False)
    shared: dict[str, Any] = field(compare=False)
    folder: Path
    key: str  # Both tables as text, in which 1, 1.0 and true are different.


@lru_cache(maxsize=64)
def _read_set_cached(given: _Given) -> _ReadSet:
    form, raw = form_of_set(given.raw)
    if form is None:
        names = ("sun", "ring", "planet", "pinion", "gear", "meshes", "gears")
        near = [text for key in raw if (text := did_you_mean(key, names))]
        remedy = "Give sun and ring, or pinion and gear, or gears and meshes."
        return _ReadSet(None, [Problem("", "", "has no gears.", (*near, remedy)[0])])
    if not any(key in raw for key in GIVEN):
        raw = {key: value for key, value in given.shared.items() if key in form.model_fields} | raw
    if "models" in raw and form is PairSet:
        own = GearPairModels.model_fields
        raw = raw | {"models": {k: v for k, v in raw["models"].items() if k in own}}
    read: Validation[Any]
    read, told, gearing = with_sizes(validate(form, raw), raw)
    problems = []
    for it in read.problems:  # with the keys of gears of a listed set that the user wrote
        key, remedy = (text.replace("members", "gears", 1) for text in (it.key, it.remedy))
        problems.append(replace(it, key=key, remedy=remedy))
    if form is ListedSet and read.case is None:
        bad = {str(path_of(it.key)[1]) for it in read.problems if it.key.startswith("members.")}
        part = validate(ListedSet, {key: _without(bad, item) for key, item in raw.items()}).case
        if part is not None and bad:
            whole = expand(dict(part))[0]
            some = problems_of_some(whole, whole.tables, given.raw)
            problems += [as_given(it, given.raw) for it in some]
    if issubclass(form, ComputedSet):
        tables = {*raw, *given.shared}
        checked = {k: v for k, v in read.sections.items() if k != "lubrication" or k in given.raw}
        if "planet_bearings" in raw:
            tables.add("planet_bearing")
        problems += [
            as_given(problem, raw)
            for problem in cross_check(checked, tables, given.folder, gearing)
        ]
    if all(key in raw for key in GIVEN):
        allowed = "conflicts with mesh_efficiency."
        remedy = "Give one of them: that of the set from sun to ring, or that of each mesh."
        problems.append(Problem("efficiency", written(raw["efficiency"]), allowed, remedy))
    return _ReadSet(read.case, list(dict.fromkeys(problems)), told)


def _without(gears: set[str], item: Any) -> Any:
    """Members, meshes or tables of meshes without those of some gears."""
    if isinstance(item, dict):
        return {key: value for key, value in item.items() if gears.isdisjoint(key.split("-"))}
    pairs = isinstance(item, tuple) and all(isinstance(it, tuple) for it in item)
    return tuple(it for it in item if gears.isdisjoint(it)) if pairs else item


def _complete(
    table: ListedSet, gearing: Gearing, raw: Mapping[str, Any]
) -> tuple[tuple[ListedSet, Gearing], tuple[Found, ...], list[Problem]]:
    """A listed set with what it leaves out, what was found, and its problems."""
    whole, told, problems = complete(gearing, raw)
    own = dict(table.mesh)
    for mesh in whole.meshes:
        name = mesh.table_key.removeprefix("mesh.")
        former = own.get(name, ListedMesh())
        if mesh.own_distance != former.center_distance:
            own[name] = former.model_copy(update={"center_distance": mesh.own_distance})
    changed = {"members": dict(whole.tables), "gears": whole.shared, "mesh": own}
    table = table.model_copy(update=changed)
    problems += [*listed_problems(table, whole), *set_problems(whole)]
    if not any(rack_problems(whole)):
        problems += check_listed_bearings(table, whole)
    if not problems and (table.planet_bearing or table.planet_bearings or table.planet_pin):
        told = (*told, *places_told(whole))
    return (table, whole), told, list(dict.fromkeys(problems))


_SHAFTS = ("sun", "ring", "carrier")
"""What may turn in a seal of a planetary set by itself."""


def _part_problems(
    case: CaseTable, shafts: Mapping[str, str] | None, taken: Mapping[str, str]
) -> Iterator[Problem]:
    """What is wrong with the names and tables of parts; `taken` has names and their tables.

    Without shafts only what needs none of them.
    """
    for kind, name, table in case.elements:
        key = f"{kind}.{name}"
        yield from part_name_problems(key, name, "part")
        if name in taken:
            allowed = f"has the same name as another part, {taken[name]}.{name}."
            yield Problem(key, "", allowed, "Choose another name.")
        taken = {**taken, name: kind}
        found = list(table.problems())
        if not found and shafts is not None and getattr(case, "lubricant", None) is not None:
            try:
                between(table, shafts)
                table.points(case.folder)
            except InputError as error:
                found = list(error.problems)
        yield from (_below(key, problem) for problem in found)


def _element_problems(
    head: _TrainHead, sets: Sequence[str], train: TrainCase | None
) -> Iterator[Problem]:
    """Problems of bearings, seals and drags; without a train only what needs no shafts."""
    shafts = None if train is None else train.shape.names
    yield from _part_problems(train or head, shafts, dict.fromkeys(sets, "sets"))
    if train is None or not train.computed:
        return
    if train.lubricant is None:
        allowed = "the table [lubricant] is missing, which computed losses need."
        yield Problem("lubricant", "", allowed, "Add it; 'epicyclic oils' lists the built-in ones.")
    if train.operation.oil_inlet_temperature is None:
        reason = "is missing, and computed losses need it."
        advice = 'Add oil_inlet_temperature = "... degC" to [operation].'
        yield Problem("operation.oil_inlet_temperature", "", reason, advice)


class _SetTables(CaseTable):
    """What a set or pair has in common with a train, and with a set of a train."""

    oil_heights: ClassVar[Mapping[str, Mapping[str, float]]] = {}
    """Of a train those of the oil in its housing; a set states its own."""

    @property
    def centers(self) -> Mapping[str, Mapping[str, tuple[complex, ...]]]:
        """Where its bodies stand. [m]"""
        return {"": self._gearings[""].centers}

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
        return self._gearings


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
    planet_pin: PlanetPin | None = None
    load_sharing: LoadSharing = LoadSharing()
    carrier: Carrier | None = None
    thrust_bearing: ThrustBearing | None = None
    seals: dict[str, SealTable] = Field(default={})
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
    strength: StrengthTable | None = STRENGTH


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
    strength: StrengthTable | None = STRENGTH


Case = PlanetaryCase | GearPairCase | TrainCase
KINDS: Mapping[str, type[PlanetaryCase] | type[GearPairCase] | type[TrainCase]] = {
    "planetary": PlanetaryCase,
    "gear_pair": GearPairCase,
    "train": TrainCase,
}


def read_case(
    source: str | Path | Mapping[str, Any], changes: Mapping[str, Any] | None = None
) -> Case:
    """A case from a TOML file, the name of a built-in one or its tables, with `changes`, checked.

    Raises `InputError` with every problem found, not only the first.
    """
    name = str(source)
    tables: dict[str, Any] | None = None
    problems: list[Problem] = []
    if isinstance(source, Mapping):
        tables, name = plain(source), "the given tables"
    elif not isinstance(source, str | Path):
        raise InputError([_no_such_case(source)])
    elif (path := Path(source)).suffix.lower() != ".toml" and not _holds(path.is_file):
        try:
            tables = plain(library.builtin_case(name))
        except KeyError:
            if len(path.parts) == 1 and not _holds(path.exists):
                raise InputError([_no_such_case(name)]) from None
    if tables is None:
        tables, problems = read_file(path)
    kind = tables.get("kind")
    if changes and isinstance(kind, str) and kind in KINDS:
        return build_case(tables, changes, name, problems)
    return _build_any(tables, name, problems)


def build_case(
    tables: Mapping[str, Any],
    changes: Mapping[str, Any],
    source: str,
    problems: Sequence[Problem] = (),  # Found before.
) -> Case:
    """The case of `tables` of a known kind, which may need the `changes` to be complete.

    Raises `InputError` with every problem of the changed tables, as problems of `source`.
    """
    changed = with_changes(KINDS[tables["kind"]], plain(tables), changes)
    made = _build_any(changed.tables, source, [*problems, *changed.problems])
    made._replaced = changed.replaced
    return made


def changed_tables(tables: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """`tables` of a known kind with the `changes`; those that cannot be are left out."""
    return with_changes(KINDS[tables["kind"]], plain(tables), changes).tables


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
    known = library.names("cases")
    allowed = f"is neither a file nor a built-in case (built in: {', '.join(known)} and variants)."
    base = max((file for file in known if name.startswith(f"{file}-")), key=len, default="")
    groups = library.case_variants().get(base, [])
    words = "; ".join(" or ".join(group["words"]) for group in groups)
    if words:
        remedy = f"The name of a variant is {base}- with at most one word of each group: {words}."
    else:
        remedy = did_you_mean(name, known) or "See 'epicyclic cases'."
    return Problem("CASE", written(name), allowed, remedy)


_OTHER_GEARS = ("bevel", "hypoid", "worm", "face", "crossed", "spiroid")
"""Words for gears whose axes are not parallel."""


def _build_any(tables: dict[str, Any], source: str, problems: Sequence[Problem] = ()) -> Case:
    """The case of `tables`; if they name no kind, every problem under the likeliest one."""
    given = tables.get("kind")
    name = given if isinstance(given, str) and given in KINDS else ""
    if not name and any(word in str(given).lower() for word in _OTHER_GEARS):
        allowed = "is not modelled: bevel, hypoid, worm and face gears have no parallel axes."
        remedy = "Enter their measured loss in a train: [drags.NAME], or efficiency of a set."
        raise InputError([Problem("kind", written(given), allowed, remedy)], source)
    if not name:
        name = misspelt(str(given), KINDS) or max(
            KINDS, key=lambda kind: len(tables.keys() & tables_of(KINDS[kind]).keys())
        )
        allowed = f"must be {either(list(KINDS))}."
        if given is None:
            allowed = f"is missing; it {allowed}"
        shown = "" if given is None else written(given)
        problems = [*problems, Problem("kind", shown, allowed, f'Write kind = "{name}".')]
        tables = tables | {"kind": name}
    return KINDS[name].from_tables(tables, source, problems)
