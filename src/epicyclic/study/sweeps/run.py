"""`sweep`: the cases of the full product, and the dataset that their results make."""

from __future__ import annotations

import hashlib
import json
import math
import re
from abc import abstractmethod
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import closing, suppress
from functools import partial
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.arrays import FloatArray, IntArray
from epicyclic.build.machine import layout_of
from epicyclic.case.case import FILE_KEYS, Case, TrainCase, build_case
from epicyclic.case.keys import field_at
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import InputError, Problem, Status, one_problem, printable, raise_any
from epicyclic.files import check_place, whole_file
from epicyclic.losses.pocket_tables import FlowFamily, FlowTables, make_tables
from epicyclic.netcdf_file import texts_not_copied
from epicyclic.result.result import number_fields, origin
from epicyclic.schema.fields import entry_of, quantity_of
from epicyclic.schema.read import parse_value, plain, split_key, with_unit_of_key
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.operating import AXES, STATE_KEY, key_of
from epicyclic.study.solve import pocket_flow_numbers, solve_together
from epicyclic.study.sweeps.axes import (
    MOST_POINTS,
    ROW,
    Axis,
    Point,
    check_links,
    columns_of,
    keys_behind,
    listed,
    make_axis,
    make_group,
    make_rows,
    too_many,
    unit_of,
)
from epicyclic.study.sweeps.runner import TEXTS, Plan, Progress, Row, Rows, Runner
from epicyclic.units import NEWTON_METRE, RPM, Quantity, format_number, percent

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


# Tables of the flows through pockets that the points of a sweep have in common.


_LIKE_SPEED = (
    STATE_KEY,
    AXES["speed"],
    "operation.second_speed",
    AXES["temperature"],
    "surroundings.pressure",
)
"""Keys that change the number of a flow, but not its family."""
_FEWEST = 8  # Values of these keys for which a table is made: few flows are solved as soon.
_TORQUE = AXES["torque"]  # Only its sign matters to the pockets.
_NOT_OF_POCKETS = re.compile(
    r"(.*\.)?((planet_bearing|load_sharing|bearings|thrust_bearing)\..*|\w*roughness"
    r"|carrier\.(outer_diameter|(open_)?width|\w+_gap)"
    r"|(hurst_exponent|running_in_factor|boundary_friction|pressure_viscosity_factor))"
)
"""Keys that change neither a family nor a number: bands vary mostly these."""


def flow_tables(plan: CasePlan, indices: Sequence[int], threads: int | None = None) -> FlowTables:
    """Tables for the points `indices`; none where that does not pay.

    A table is made for all points of `plan` that read it, so that it is the same whichever of them
    are done, and where.
    """
    bound = plan.case.numerics.pocket_interpolation
    samples = flows_asked(plan, plan.order())
    alike = {tuple(changes.get(key) for key in _LIKE_SPEED) for changes in samples.values()}
    if bound == 0 or len(alike) < _FEWEST:
        return {}
    wanted = samples if len(indices) == plan.size else flows_asked(plan, indices)
    asked: dict[FlowFamily, set[float]] = defaultdict(set)
    read: set[FlowFamily] = set()
    for flow, family, number in _numbers(plan.case, samples):
        asked[family].add(number)
        if flow in wanted:
            read.add(family)
    many = {
        family: numbers
        for family, numbers in asked.items()
        if family in read and len(numbers) >= _FEWEST
    }
    return make_tables(many, bound, threads)


def flows_asked(plan: CasePlan, indices: Iterable[int]) -> dict[tuple[Any, ...], dict[str, Any]]:
    """What points change of the pockets, once for all that need the same flows."""
    asked = {}
    for index in indices:
        with suppress(InputError):  # the point reports it
            every = plan.changes(index).items()
            changes = {key: value for key, value in every if not _NOT_OF_POCKETS.fullmatch(key)}
            asked[_flow(changes)] = changes
    return asked


def _numbers(
    case: Case, samples: Mapping[tuple[Any, ...], Mapping[str, Any]]
) -> Iterator[tuple[tuple[Any, ...], FlowFamily, float]]:
    """Flows with the families and numbers that are asked for there; those that scale are left out.

    Of flows that differ in the speed only the slowest or the fastest has the largest number: where
    both scale, all do.
    """
    changed, alike = one_after_another(case), defaultdict[Any, list[Any]](list)
    for flow, changes in samples.items():
        alike[_flow(changes, AXES["speed"])].append((_number(changes, AXES["speed"], RPM), flow))
    for slowest, *others in map(sorted, alike.values()):
        scale = True
        for place, (_, flow) in enumerate((slowest, *reversed(others))):
            if place > 1 and scale:
                break
            try:
                numbers = pocket_flow_numbers(changed(samples[flow]))
            except InputError:  # the point reports it
                numbers, scale = (), False
            scale = scale and not numbers
            yield from ((flow, *its) for its in numbers)


def _flow(changes: Mapping[str, Any], but: str = "") -> tuple[Any, ...]:
    """Equal for points that differ in the magnitude of torque only, and in the key `but`."""
    coasting = str(changes.get(_TORQUE, "")).lstrip().startswith("-")
    own = (f"{key}={value}" for key, value in changes.items() if key not in (_TORQUE, but))
    return coasting, *own


def _number(changes: Mapping[str, Any], key: str, unit: Quantity) -> float:
    """Number that changes state of a key; 0 of none, or of what the point reports as wrong."""
    try:
        return unit.parse(changes.get(key, f"0 {unit.display}"))
    except PydanticCustomError:
        return 0.0


def one_after_another(case: Case) -> Callable[[Mapping[str, Any]], Case]:
    """Makes `case` with some changes of the nearest of those that it made before.

    What only depends on what both have is not checked again.
    """
    near: list[tuple[Case, Mapping[str, Any]]] = []

    def changed(changes: Mapping[str, Any]) -> Case:
        of, moved = case, changes
        for one, before in near:
            if before.keys() == changes.keys():
                new = {key: it for key, it in changes.items() if it != before[key]}
                of, moved = (one, new) if len(new) < len(moved) else (of, moved)
        made = of.updated(moved)
        # the last one, and the last two that changed most keys, from which mixtures of them start
        near[:] = [*(near if 2 * len(moved) > len(changes) else near[:-1])[-2:], (made, changes)]
        return made

    return changed


# What a sweep varies: keys, their values, and the cases of the full product.

_RANGE = re.compile(
    r"\s*(?P<start>[^:,]+?)\s*:\s*(?P<stop>[^:,]+?)\s*:\s*(?P<count>\d+)\s*(?P<unit>[^:,\d.][^:,]*)?"
)
_NUMBER = re.compile(r"\s*([+-]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|(?:nan|inf)\b))\s*(.*?)\s*")

_TRIED = 100  # Points at which links are tried before anything is computed.

# Tables whose keys leave geometry alone: varied innermost, so that geometry is built once.
_OPERATING_TABLES = (
    "operation",
    "lubricant",
    "surroundings",
    "models",
    "contact_solver",
    "losses",
    "thermal",
)


MESHES_TOGETHER = 324  # Of all points of a block, at most: more take memory and hardly less time.
FEWEST_TOGETHER = 8  # Points: with fewer there is little to gain, and each ends for itself.
SAME_LOSS = 1e-9  # Losses that differ by less, relatively, do so by rounding in their blocks. [1]
SURELY_LONG = 4000  # Meshes of all points: each takes half a millisecond or more.
MANY, SMALL_BLOCKS = 48, 3  # Points from which on blocks are full, and blocks of fewer, to share.


@dataclass(frozen=True, slots=True)
class CasePlan(Plan):
    """Cases to be solved: one case, and what each point changes in it."""

    case: Case
    # Tables of flows through pockets that points share, see `prepared`.
    flow_tables: FlowTables = field(default_factory=dict, kw_only=True, repr=False)

    @property
    def source(self) -> str:
        """The file of the case."""
        return str(Path(self.case.source).absolute())

    @abstractmethod
    def changes(self, index: int) -> dict[str, Any]:
        """The keys that point number `index` changes."""

    def prepared(self, indices: Sequence[int], jobs: int | None) -> Self:
        """With the tables of flows that the points `indices` read."""
        return replace(self, flow_tables=flow_tables(self, indices, jobs))

    def describe(self) -> dict[str, Any]:
        """The case, and what is in the files that it names: it may change, their names do not."""
        contents = [(self.case.folder / file).read_bytes() for file in _files(self.case)]
        return {
            "case": self.case.given(),
            "files": [hashlib.sha256(content).hexdigest() for content in contents],
        }

    @property
    def together(self) -> bool:
        """Whether points are solved together: some share their geometry."""
        return False

    @property
    def block(self) -> int:
        """See `Plan`: of as many points as are worth it, if there are enough."""
        most = max(FEWEST_TOGETHER, MESHES_TOGETHER // max(1, self._meshes))
        size = min(most, self.size if self.size >= MANY else self.size // SMALL_BLOCKS)
        return size if self.together and size >= FEWEST_TOGETHER else 1

    @property
    def _meshes(self) -> int:
        return sum(len(gearing.meshes) for gearing in self.case.gearings.values())

    def surely_long(self, count: int) -> bool:
        """See `Plan`."""
        return count * self._meshes >= SURELY_LONG

    def solve_all(self, indices: Sequence[int]) -> list[Row]:
        """Rows of the points of whole blocks; those of each are solved together."""
        if not self.together:
            return Plan.solve_all(self, indices)
        size = self.block
        blocks = (indices[first : first + size] for first in range(0, len(indices), size))
        return [row for block in blocks for row in self._solve_block(block)]

    def _solve_block(self, indices: Sequence[int]) -> list[Row]:
        cases: dict[int, Case] = {}
        changed = one_after_another(self.case)

        def failing(index: int) -> Row:
            cases[index] = changed(self.changes(index))
            return Row("")

        rows = {index: self._row(partial(failing, index)) for index in indices}
        for index, answer in zip(cases, self._answers(list(cases.values())), strict=True):
            rows[index] = self._row(partial(self._answered, answer))
        return list(rows.values())

    def _solve(self, index: int) -> Row:
        (answer,) = self._answers([self.case.updated(self.changes(index))])
        return self._answered(answer)

    def _answered(self, answer: Any) -> Row:
        if isinstance(answer, Exception):
            raise answer
        return self._row_of(answer)

    def _answers(self, cases: Sequence[Case]) -> Sequence[Any]:
        """What is found of cases, or what is wrong with each of them."""
        return solve_together(cases, self.flow_tables)

    def _row_of(self, answer: Any) -> Row:
        if answer.status is not Status.CONVERGED:
            return Row(str(answer.status), message=answer.notes[0])
        warnings = " | ".join(answer.warnings)
        return Row(str(answer.status), warnings=warnings, numbers=self._numbers_of(answer))

    def _numbers_of(self, answer: Any) -> dict[str, float]:
        found: dict[str, float] = answer.values()
        return found


def _files(case: Case) -> Iterator[str]:
    tables: list[Any] = [case.models]
    if isinstance(case, TrainCase):
        tables += [table.models for table in case.sets.values() if hasattr(table, "models")]
    tables += [table for _, _, table in case.elements]
    for table in tables:
        for key in FILE_KEYS:
            file = getattr(table, key, None)
            if file is not None:
                yield file


@dataclass(frozen=True, slots=True)
class SweepPlan(CasePlan):
    """A sweep: a case, its axes, and the keys that follow from others."""

    kind: ClassVar[str] = "sweep"
    axes: tuple[Axis, ...] = ()
    links: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def again(cls, content: Mapping[str, Any], source: str) -> Self:
        """The plan that `describe` described."""
        case = build_case(content["case"], {}, source)
        return cls(case, tuple(map(Axis.again, content["axes"])), content.get("links", {}))

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each axis."""
        return tuple(len(axis.values) for axis in self.axes)

    @property
    def size(self) -> int:
        """Number of cases."""
        return int(np.prod(self.shape, dtype=int))

    def point(self, index: int) -> Point:
        """Case number `index`, counted with the last axis fastest."""
        varied = {
            part.key: part.values[i]
            for axis, i in zip(self.axes, np.unravel_index(index, self.shape), strict=True)
            for part in axis.keys
        }
        return Point(self.case, varied, self.links)

    def changes(self, index: int) -> dict[str, Any]:
        """The keys that case number `index` changes; raises `InputError` if a link has no value."""
        return self.point(index).followed()

    @property
    def together(self) -> bool:
        """See `CasePlan`."""
        alike = [len(axis.values) for axis in self.axes if _is_of_operation(axis)]
        return math.prod(alike) > 1 and all(map(_is_operating, self.links))

    def axes_behind(self, key: str) -> list[int]:
        """Numbers of the axes that the linked `key` follows."""
        behind = keys_behind(key, self.links)
        return [
            number
            for number, axis in enumerate(self.axes)
            if behind.intersection(part.key for part in axis.keys)
        ]

    def order(self) -> list[int]:
        """Indices of all cases, those that share geometry next to each other.

        A block is of one state and model, then goes by torque, then speed: it takes as many passes
        as its points of least power.
        """
        outer = {
            number
            for key in self.links
            if not _is_operating(key)
            for number in self.axes_behind(key)
        }
        depth = [  # names are no numbers of one block
            (number not in outer and _is_of_operation(axis)) * (2 if axis.unit else 1)
            for number, axis in enumerate(self.axes)
        ]
        powers = [_TORQUE, AXES["speed"]] if self.together else []
        rank = [[*powers, axis.key].index(axis.key) for axis in self.axes]
        by_cost = sorted(range(len(self.axes)), key=lambda i: (depth[i], rank[i]))
        numbers = np.arange(self.size).reshape(self.shape)
        return [int(index) for index in numbers.transpose(by_cost).ravel()]

    def describe(self) -> dict[str, Any]:
        """The case, the axes and the links."""
        content = {**CasePlan.describe(self), "axes": [axis.describe() for axis in self.axes]}
        return content | ({"links": dict(self.links)} if self.links else {})


def _is_operating(key: str) -> bool:
    return key.split(".")[0] in _OPERATING_TABLES


def _is_of_operation(axis: Axis) -> bool:
    return all(_is_operating(part.key) for part in axis.keys)


@dataclass(frozen=True, slots=True)
class PointList(CasePlan):
    """Single points: a case and the keys that each point changes."""

    kind: ClassVar[str] = "points"
    points: tuple[Mapping[str, Any], ...] = ()

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.points)

    @property
    def together(self) -> bool:
        """See `CasePlan`."""
        return all(_is_operating(key) for point in self.points for key in point)

    def changes(self, index: int) -> dict[str, Any]:
        """The keys that point number `index` changes."""
        return dict(self.points[index])

    def order(self) -> list[int]:
        """Indices of all points, by geometry, then torque, then operation, as in a loss map."""
        return sorted(range(self.size), key=self._place)

    def describe(self) -> dict[str, Any]:
        """The case and the points."""
        return {**CasePlan.describe(self), "points": plain(self.points)}

    def _place(self, index: int) -> tuple[list[str], float, list[str]]:
        changes = {key: str(value) for key, value in sorted(self.points[index].items())}
        inner = [key for key in changes if _is_operating(key)]
        return (
            [f"{key}={text}" for key, text in changes.items() if key not in inner],
            _number(changes, _TORQUE, NEWTON_METRE),
            [f"{key}={changes[key]}" for key in inner if key != _TORQUE],
        )


def make_plan(
    case: Case,
    # Dotted keys to their values, as a case file has them.
    vary: Mapping[str, Iterable[Any]] | None = None,
    *,
    # Groups of keys whose values change together.
    together: Iterable[Mapping[str, Iterable[Any]]] = (),
    points: Mapping[str, Iterable[Any]] | None = None,  # The columns of a table of points.
    links: Mapping[str, str] | None = None,  # Keys to expressions of others.
) -> SweepPlan:
    """Check what is to be varied.

    Raises `InputError` for unknown or unsuitable keys, no values, values that cannot be read,
    repeated ones, or links that have no value.
    """
    given = [vary or {}, *together, *([] if points is None else [points])]
    single, *groups = [dict(_keyed(group)) for group in given]
    sizes = [*map(len, single.values()), *(max(map(len, it.values()), default=0) for it in groups)]
    if not sizes:
        remedy = "Give at least one key and its values; --vary KEY=VALUES on the command line."
        raise one_problem("vary", "", "is empty.", remedy, "the sweep")
    if math.prod(sizes) > MOST_POINTS:  # not worth reading them
        raise InputError([too_many("vary", math.prod(sizes))], "the sweep")
    made = [make_axis(case, key, values) for key, values in single.items()]
    rows = [] if points is None else [make_rows(case, groups.pop())]
    made += [*(make_group(case, group) for group in groups), *rows]
    axes = tuple(axis for axis, _ in made if axis is not None)
    problems = [problem for _, found in made for problem in found]
    problems += _repeated(split_key(str(key))[0] for group in given for key in group)
    linked = {str(key): str(text) for key, text in (links or {}).items()}
    problems += check_links(case, linked, {part.key for axis in axes for part in axis.keys})
    raise_any(problems, "the sweep")
    plan = SweepPlan(case, axes, linked)
    _check_first(plan)
    return plan


def _keyed(group: Mapping[str, Iterable[Any]]) -> Iterator[tuple[str, list[Any]]]:
    """Keys and their values, numbers with the unit that stands behind the key."""
    for name, values in group.items():
        key, unit = split_key(str(name))
        yield key, [with_unit_of_key(value, unit) for value in listed(values)]


def _repeated(keys: Iterable[str]) -> list[Problem]:
    again = (key for key, count in Counter(keys).items() if count > 1)
    return [Problem(key, "", "is varied twice.", "Give each key once.") for key in again]


def _check_first(plan: SweepPlan) -> None:
    """Raise `InputError` if links have no value at any of the first points."""
    first: InputError | None = None
    for index in range(min(plan.size, _TRIED) if plan.links else 0):
        try:
            plan.changes(index)
        except InputError as error:
            first = first or error
        else:
            return
    if first is not None:
        raise InputError(first.problems, "the sweep")


def parse_vary(
    case: Case, options: Sequence[str], name: str = "--vary", example: str = "operation.speed"
) -> dict[str, list[Any]]:
    """The options ``key=a,b,c`` and ``key=start:stop:count`` of a command line.

    `name` is that of the options, `example` one of their keys that holds a speed.

    A unit after the last value, or after the count, holds for all values without one. Raises
    `InputError` if an option is not of that form.
    """
    problems = []
    vary: dict[str, list[Any]] = {}
    for option in options:
        key, equals, text = option.partition("=")
        key, given = key.strip(), f'"{option}"'
        if not equals or not text.strip():
            allowed = "must be key=a,b,c or key=start:stop:count."
            remedy = f'For example {name} "{example}=1000:4000:4 rpm".'
            problems.append(Problem(name, given, allowed, remedy))
            continue
        if key in vary:
            problems.append(Problem(name, given, f"varies {key} again.", "Give each key once."))
            continue
        try:
            vary[key] = list(_values(case, key, text))
        except InputError:
            raise  # the key itself is none
        except ValueError as error:
            what, remedy = (*error.args, "Write start:stop:count in one unit.")[:2]
            problems.append(Problem(key, f'"{text}"', f"{what}.", remedy))
        size = math.prod(map(len, vary.values()))
        if size > MOST_POINTS:
            problems.append(too_many(name, size))
            break
    raise_any(problems, "the command")
    return vary


def parse_together(case: Case, options: Sequence[str]) -> list[dict[str, list[Any]]]:
    """The options ``key=a,b; key=c,d`` of a command line. Errors as for `parse_vary`."""
    example = "planet.count=3,4; operation.speed"
    groups = ([part for part in option.split(";") if part.strip()] for option in options)
    return [parse_vary(case, group, "--vary-together", example) for group in groups]


def parse_links(options: Sequence[str]) -> dict[str, str]:
    """The options ``key = expression`` of a command line.

    Raises `InputError` if an option is not of that form, or names a key again.
    """
    links: dict[str, str] = {}
    problems = []
    for option in options:
        key, equals, text = (part.strip() for part in option.partition("="))
        if not equals or not key or not text:
            example = 'For example --link "ring.teeth = sun.teeth + 2 * planet.teeth".'
            problems.append(Problem("--link", f'"{option}"', "must be key = expression.", example))
        elif key in links:
            problems.append(Problem("--link", f'"{option}"', f"links {key} again.", "Keep one."))
        links[key] = text
    raise_any(problems, "the command")
    return links


def _values(case: Case, key: str, text: str) -> Iterator[Any]:
    """Values of one option; a `ValueError` has what is wrong, and may have what to do."""
    match, field = _RANGE.fullmatch(text), field_at(case, key)
    quantity = None if field is None or entry_of(field[0]) else quantity_of(*field)
    lacking = ValueError("has no unit", f'Write "{text.strip()} {quantity and quantity.display}".')
    if match is not None:
        start, stop = _NUMBER.fullmatch(match["start"]), _NUMBER.fullmatch(match["stop"])
        if start is None or stop is None:
            raise ValueError("start and stop must be numbers")
        count = int(match["count"])
        if count < 1:
            raise ValueError("the count must be 1 or more")
        if count > MOST_POINTS:
            raise ValueError(f"the count must be {MOST_POINTS} or less")
        if count == 1 and start[1] != stop[1]:
            raise ValueError("a count of 1 leaves out the stop", "Give 2 or more, or one value.")
        units = {unit for unit in (start[2], stop[2], (match["unit"] or "").strip()) if unit}
        if len(units) > 1:
            raise ValueError(f"the units {' and '.join(sorted(units))} differ")
        unit = units.pop() if units else ""
        if not unit and quantity is not None and quantity.si:
            raise lacking
        whole = field is not None and field[0] is int
        for number in np.linspace(float(start[1]), float(stop[1]), count):
            if unit:
                yield f"{format_number(float(number), 12)} {unit}"
            elif whole and float(number).is_integer():
                yield int(number)
            else:
                yield float(number)
        return
    if ":" in text and quantity is not None:
        raise ValueError("must be a,b,c or start:stop:count", "Give all three, and a unit.")
    items = [item.strip() for item in text.split(",")]
    if not all(items):
        raise ValueError("has an empty value", "Fill it, or delete a comma.")
    if quantity is not None and quantity.si and all(map(_is_bare, items)):
        raise lacking
    shared = _unit_of(items[-1])
    for item in items:
        if _LEADING_ZERO.match(item):
            raise ValueError(f'"{item}" is no value: commas divide values, not digits of one')
        yield parse_value(f"{item} {shared}" if shared and _is_bare(item) else item)


_LEADING_ZERO = re.compile(r"0\d")


def _unit_of(item: str) -> str | None:
    """The unit of a number, empty if it has none; None for what is no number."""
    match = _NUMBER.fullmatch(item)
    return None if match is None else match[2]


def _is_bare(item: str) -> bool:
    return _unit_of(item) == ""


# Rows of a sweep as an `xarray.Dataset`, and the files it is kept in.

FORMATS = (".nc", ".csv", ".parquet")
_FORMULA = ("=", "+", "-", "@", "\t")  # What formulas of spreadsheets begin with.
_CONTROLS = re.compile(r"[^\t\n -\x7e\xa0-\U0010ffff]")
INTERPOLATION_ERROR = "pocket_interpolation_error"


def to_dataset(plan: SweepPlan, rows: Rows) -> xr.Dataset:
    """The rows of all points of `plan` over its axes."""
    import xarray as xr

    from epicyclic.study.sweeps.names import with_plain_names

    dims = tuple(axis.key for axis in plan.axes)
    coords = {}
    for key, over, points, unit in _coordinates(plan):
        about = _about("row of the table of points" if key == ROW else key, unit)
        coords[key] = (over, points, about)
    variables = {
        it.key: (dims, rows.numbers(it.key).reshape(plan.shape), _about(it.label, it.unit))
        for case in (plan.case, *_with_temperatures(plan))
        for it in number_fields(layout_of(case))
    }
    for key, label in TEXTS.items():
        column = np.array(getattr(rows, key), dtype=object).reshape(plan.shape)
        variables[key] = (dims, column, _about(label, ""))
    with texts_not_copied():
        return with_plain_names(xr.Dataset(variables, coords, _attributes(plan, rows)))


def _with_temperatures(plan: SweepPlan) -> Iterator[Case]:
    """The case with each model of temperatures that varies: only some have those of the parts."""
    for part in (part for axis in plan.axes for part in axis.keys):
        for value in dict.fromkeys(part.values if part.key == "models.temperatures" else ()):
            with suppress(InputError):  # the points report it
                yield plan.case.updated({part.key: value})


def idle_keys(plan: SweepPlan, rows: Rows) -> list[str]:
    """Axes along which no loss changes, because other keys of the case decide."""
    total = rows.numbers("total").reshape(plan.shape)
    return [
        axis.key
        for number, axis in enumerate(plan.axes)
        if len(axis.values) > 1 and np.allclose(total, total.take([0], number), SAME_LOSS, 0)
    ]


def write_netcdf(dataset: xr.Dataset, path: Path) -> None:
    """All variables, units and attributes."""
    from xarray.backends import NetCDF4DataStore

    # where dask is, `Dataset.to_netcdf` imports all of its clusters to choose a lock
    with texts_not_copied(), closing(NetCDF4DataStore.open(path, "w", lock=Lock())) as store:
        dataset.dump_to_store(store)


def _coordinates(plan: SweepPlan) -> Iterator[tuple[str, tuple[str, ...], Any, str]]:
    """Key, dimensions, values and unit of all that is varied, and of what follows from it."""
    for axis in plan.axes:
        for part in (replace(axis, together=()), *axis.together):
            yield part.key, (axis.key,), np.array(part.coordinate), part.unit
    for key in plan.links:
        behind = plan.axes_behind(key)
        shape = tuple(size if it in behind else 1 for it, size in enumerate(plan.shape))
        values = [
            plan.point(int(np.ravel_multi_index(place, plan.shape))).coordinate(key)
            for place in np.ndindex(shape)
        ]
        kept = [plan.shape[number] for number in behind]
        known = np.array([np.nan if value is None else value for value in values]).reshape(kept)
        yield key, tuple(plan.axes[number].key for number in behind), known, unit_of(plan.case, key)


def by_keys(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset of a sweep with its keys as the only names, a plain one; any other as it is."""
    import xarray as xr

    keys = {name: key_of(array) for name, array in dataset.coords.items()}
    beside = {name: key for name, key in keys.items() if key != name and key in dataset.coords}
    data = dataset.drop_vars(beside.values()).rename(beside)
    return xr.Dataset(data.variables, attrs=data.attrs).set_coords(list(data.coords))


def _about(label: str, unit: str) -> dict[str, str]:
    """Attributes of a variable; names and text have no unit."""
    return {"long_name": label} | ({"units": unit} if unit else {})


def _attributes(plan: SweepPlan, rows: Rows) -> dict[str, str]:
    # which keys changed together, and which followed from others
    groups = [[part.key for part in axis.keys] for axis in plan.axes if axis.together]
    told = {"together": groups, "links": dict(plan.links)}
    return {
        "title": plan.case.title,
        **origin(plan.case),
        "conventions": "losses in W of the whole gear set, summed over planets; "
        "torque and speed of the input member",
        "pocketing": _about_pocketing(rows),
        **{name: json.dumps(content) for name, content in told.items() if content},
    }


def _about_pocketing(rows: Rows) -> str:
    """Whether the pocketing losses of some points were interpolated, and how well."""
    errors = [rows.numbers(name) for name in rows.names if name.endswith(INTERPOLATION_ERROR)]
    if np.isnan(errors).all():
        return "flow solved at every point"
    return (
        "flow interpolated over speed * sqrt(density / ambient pressure); largest error of the "
        f"loss, measured at flows left out: {percent(np.nanmax(errors), 2)}"
    )


def check_output(path: Path) -> None:
    """Raise `InputError` unless a sweep can be written to `path`."""
    if path.suffix not in FORMATS:
        allowed, remedy = f"must end in {', '.join(FORMATS)}.", "Choose one of these formats."
        raise one_problem("-o", str(path), allowed, remedy, "the command")
    check_place(path)


def write_dataset(
    dataset: xr.Dataset, path: Path, rows: Callable[[xr.Dataset], pd.DataFrame] | None = None
) -> None:
    """Write to `path`, whole or not at all: all of it as .nc, or `rows` as .csv or .parquet."""
    with whole_file(path) as temporary:
        if path.suffix == ".nc":
            write_netcdf(dataset, temporary)
            return
        table = (rows or to_table)(dataset)
        if path.suffix == ".csv":
            csv_safe(table).to_csv(temporary, index=False)
        else:
            table.to_parquet(temporary, index=False)


def csv_safe(table: pd.DataFrame) -> pd.DataFrame:
    """A table whose texts no spreadsheet takes for formulas: those get an apostrophe in front.

    Control characters are written as escapes: a carriage return would end the row.
    """
    texts = table.select_dtypes(exclude="number").columns
    safe = table.assign(**{name: table[name].map(_csv_text) for name in texts})
    return safe.rename(columns=_csv_text)


def _csv_text(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    text = _CONTROLS.sub(lambda found: printable(found[0]), value)
    return f"'{text}" if text.startswith(_FORMULA) else text


def to_table(dataset: xr.Dataset) -> pd.DataFrame:
    """One row for each point, units in the column names; those of a sweep are its keys."""
    dataset = by_keys(dataset)
    table = dataset.to_dataframe().reset_index()
    columns = {**dataset.coords, **dataset.data_vars}
    units = {str(name): str(array.attrs.get("units", "")) for name, array in columns.items()}
    table = table.rename(
        columns={name: f"{name} [{unit}]" for name, unit in units.items() if unit not in ("", "1")}
    )
    table.attrs = dict(dataset.attrs)
    return table


# The load-dependent loss as a test rig forms it: the total loss less that without torque.
#
# Both are found at one speed and oil inlet temperature, each at the temperatures it settles at. The
# loaded oil is hotter and drags less, so that this is less than the loss that depends on the load.

Points = tuple[dict[str, Any], ...]


def with_unloaded(points: Sequence[Mapping[str, Any]]) -> tuple[Points, IntArray]:
    """Points, behind them the same without torque, each once; and the number of each's own."""
    added: dict[tuple[tuple[str, str], ...], tuple[int, dict[str, Any]]] = {}
    numbers = []
    for point in points:
        unloaded = {**point, AXES["torque"]: "0 N*m"}
        alike = tuple(sorted((key, str(value)) for key, value in unloaded.items()))
        number, _ = added.setdefault(alike, (len(points) + len(added), unloaded))
        numbers.append(number)
    behind = (unloaded for _, unloaded in added.values())
    return (*map(dict, points), *behind), np.array(numbers, dtype=np.intp)


def as_tested(rows: Rows, unloaded: IntArray) -> FloatArray:
    """Load-dependent losses of points from `with_unloaded`. Theory (P9).

    NaN where a point or its partner failed. [W]
    """
    total = rows.numbers("total")
    return total[: unloaded.size] - total[unloaded]


def sweep(
    case: CaseSource,
    vary: Mapping[str, Iterable[Any]] | None = None,
    *,
    together: Iterable[Mapping[str, Iterable[Any]]] = (),
    points: str | Path | Mapping[str, Iterable[Any]] | pd.DataFrame | None = None,
    links: Mapping[str, str] | None = None,
    jobs: int | None = None,
    dask: str | None = None,
    shard: tuple[int, int] | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Losses over the full product of the values of some keys, or groups of keys.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
        Keys that are not varied have their values from here.
    vary : mapping of str to iterable, optional
        Dotted keys to values, ``{"operation.speed": ["1000 rpm", "2000 rpm"]}``: numbers, text
        with units, choices, names. Numbers of an array have the unit behind the key,
        ``{"operation.torque [N*m]": np.linspace(0, 300, 7)}``.
    together : iterable of mapping, optional
        Groups of keys with as many values each, which change together. Each group is one
        dimension, named after its first key.
    points : str, Path, mapping or pandas.DataFrame, optional
        A table of points, one in each row, by its columns: a ``.csv`` file, or the same in memory.
        It is the dimension ``row``.
    links : mapping of str to str, optional
        Keys to expressions of others, ``{"ring.teeth": "sun.teeth + 2 * planet.teeth"}``. In that
        of a key, the key itself is its value in the case, as is ``case(KEY)`` of any.
    jobs : int, optional
        Processes that compute. Default: one for each core if the work is worth it, else this one.
    dask : str, optional
        Address of the scheduler of a Dask cluster that takes their place.
    shard : (int, int), optional
        Which share of the points to compute, and of how many: ``(2, 8)``. Points of other shards
        have NaN and the status ``"not computed"``; ``epicyclic merge`` makes one file of journals
        of all shards.
    journal : str or Path, optional
        File that keeps finished points, so that an interrupted sweep goes on where it stopped.
        It stays when the sweep is done, and is refused by another sweep.
    progress : callable, optional
        Called with the number of finished points and of all points, or of those of the shard.

    Returns
    -------
    xarray.Dataset
        One dimension for each key or group, ``torque`` for ``operation.torque``, ``planet_count``
        for ``planet.count``; the keys themselves are accepted in their place. Every number has its
        unit; points that failed have NaN, the status ``"failed"`` and the reason in ``message``.
        Which variables there are depends on the kind of the case only. Keys that change with others
        or follow from them are coordinates; the attributes ``together`` and ``links`` name them.

    Raises
    ------
    InputError
        If a key cannot be varied, a value cannot be read, a link has no value, or the journal is
        that of another sweep.
    """
    table = points if points is None or isinstance(points, Mapping) else columns_of(points)
    plan = make_plan(as_case(case), vary, together=together, points=table, links=links)
    return to_dataset(plan, Runner(jobs, dask, shard, journal, progress).run(plan))


def is_sweep(data: xr.Dataset) -> bool:
    """True for what a sweep makes, False for a loss map."""
    return "torque_loss" not in data and {"total", "status"} <= set(data.data_vars)
