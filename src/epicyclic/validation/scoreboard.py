"""Measurements that others published, computed: how far off, with which trend, inside which band.

Nothing is fitted to them. Each file of the folder ``measurements`` holds sets of one case; files of
the same form can be given in their place, `read_sets`.
"""

from __future__ import annotations

import itertools
import json
import math
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import Field
from pydantic_core import PydanticCustomError

from epicyclic.arrays import FloatArray
from epicyclic.case.case import Case, TrainCase, read_case
from epicyclic.case.keys import value_of
from epicyclic.case.tables.elements import ShaftBearingTable
from epicyclic.case.tables.models import AS_TESTED, COMPUTED, GearPairModels
from epicyclic.dataclass import dataclass, field
from epicyclic.errors import ConvergenceError, InputError, Problem, one_problem, raise_any
from epicyclic.files import read_text
from epicyclic.result.result import versions
from epicyclic.schema.fields import Table, choices_of
from epicyclic.schema.read import plain
from epicyclic.schema.validation import validate
from epicyclic.study.bands.plan import INPUT_POWER, nearby_at
from epicyclic.study.bands.samples import sample_summary
from epicyclic.study.bands.study import quick_band
from epicyclic.study.measured.table import LOAD_DEPENDENT, loss_names, parts_of
from epicyclic.study.operating import AXES
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.run import PointList, as_tested, with_unloaded
from epicyclic.study.sweeps.runner import HERE, Runner
from epicyclic.units import NEWTON_METRE, NUMBER, WATT, Quantity

Keys = dict[str, Any]
"""Keys of a case and their values, as a case file has them."""

GRADES = {
    "P": "printed",
    "D": "derived from printed errors by two routes that agree",
    "R": "regression that the testers fitted to their measurements",
    "F": "read from a figure, about 10 %",
}
DEFAULTS = "defaults"  # The run of a set in which nothing is changed.
_SHARE = Quantity("a share", NUMBER.si, "%")
_SLOPE = "branch_slope"
_QUANTITIES: Mapping[str, Quantity] = {
    "loss": WATT, "friction_torque": NEWTON_METRE, "loss_share": _SHARE, "efficiency": _SHARE,
    "mean_friction": NUMBER, _SLOPE: _SHARE,
}  # fmt: skip
"""What may have been measured: a loss, or what follows from it and the power or speed of the input.

``mean_friction`` is the loss over the input power and the loss factor that the set states,
``branch_slope`` the slope of the loss of a branch over its power, by a line through several tests.
"""
_ENDS = ("low", "high")  # Columns with the ends of what the measurement may be.
_ROLES = {"speed": ("speed",), "load": ("torque", "force"), "temperature": ("temperature",)}
"""Trends, and how the keys end over which they go."""
_LARGEST_FILE = 1_000_000  # [bytes]

# Files of measurements.


class _Common(Table):
    """What a file says of all its sets, and a set of itself, which then counts."""

    SHOWN_BY = "the page on validation"
    changes: Keys = Field(default={}, description="Keys of the case that are changed.")
    runs: dict[str, Keys] = Field(
        default={}, description="What else is computed, beside the defaults: name, changed keys."
    )
    guessed: str = Field(default="", description="What had to be guessed.")


class _SetTable(_Common):
    """One set: columns of conditions, the last one what was measured."""

    name: str
    component: str = "total"  # As in a table of `epicyclic.compare_measured`.
    columns: tuple[str, ...] = Field(min_length=2)  # ``"speed [rpm]"``, ``"planet.roughness"``.
    points: tuple[tuple[int | float | str, ...], ...] = Field(min_length=1)
    loss_factor: float | None = Field(default=None, gt=0)  # Of a mean friction.
    # The tests of a slope: all combinations of these values.
    over: dict[str, tuple[Any, ...]] = Field(default={})


class _FileTable(_Common):
    """A file: where its numbers are from, how they were read, the case, and its sets."""

    source: str
    grade: Literal["P", "D", "R", "F"]
    read: str
    case: str | dict[str, Any]  # A name, a file beside this one, or the tables of a case.
    set: tuple[_SetTable, ...] = Field(min_length=1)


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredSet:
    """Points that were measured under some conditions, and the case that is to meet them."""

    file: _FileTable
    table: _SetTable
    case: Case
    points: tuple[Keys, ...]  # Keys of the case that each point sets.
    measured: FloatArray  # In `unit`, as are its ends, which are NaN where they are unknown.
    ends: FloatArray

    @property
    def name(self) -> str:
        """What the set is called."""
        return self.table.name

    @property
    def guessed(self) -> str:
        """What had to be guessed of the case."""
        return "; ".join(filter(None, (self.file.guessed, self.table.guessed))) or "nothing"

    @property
    def runs(self) -> Mapping[str, Keys]:
        """What is computed beside the defaults."""
        return {**self.file.runs, **self.table.runs}

    @property
    def tests(self) -> tuple[Keys, ...]:
        """Those of each point of a slope."""
        values = itertools.product(*self.table.over.values()) if self.table.over else ()
        return tuple(dict(zip(self.table.over, it, strict=True)) for it in values)

    @property
    def quantity(self) -> tuple[str, str]:
        """What was measured, and its unit."""
        return _column(self.table.columns[-1])

    def convert(self, loss: FloatArray, power: FloatArray, speed: FloatArray) -> FloatArray:
        """The measured quantity that follows from losses and the input, in its unit."""
        quantity, unit = self.quantity
        found = {
            "loss": loss,
            "friction_torque": loss / speed,
            "loss_share": loss / power,
            "efficiency": 1 - loss / power,
            "mean_friction": loss / power / (self.table.loss_factor or math.nan),
        }[quantity]
        return found / _one(quantity, unit)

    def errors(self, computed: FloatArray) -> FloatArray:
        """(computed - measured)/measured, of an efficiency that of the loss. [1]"""
        quantity, unit = self.quantity
        whole = 1 / _one(quantity, unit) if quantity == "efficiency" else 0.0
        return (computed - self.measured) / np.abs(whole - self.measured) * (-1 if whole else 1)


def _one(quantity: str, unit: str) -> float:
    """One `unit` of a quantity in SI."""
    known = _QUANTITIES[quantity]
    return known.parse(f"1 {unit}") if unit or known.si else 1.0


def read_sets(path: Path | None = None) -> tuple[MeasuredSet, ...]:
    """The sets of a file of measurements, or of all files ``.toml`` in a folder.

    Default: those that come with the package. Raises `InputError` if a file cannot be read, or
    states something that cannot be.
    """
    if path is None:
        path = Path(str(resources.files("epicyclic.validation").joinpath("measurements")))
    files = sorted(path.glob("*.toml")) if path.is_dir() else [path]
    if not files:
        remedy = "Put files of measurements there; the manual, validation, shows one."
        raise one_problem("--measured", str(path), "has no file that ends in .toml.", remedy)
    found: list[MeasuredSet] = []
    for file in files:
        try:
            found += _sets_of(file)
        except InputError as error:
            raise InputError(error.problems, str(file)) from None
    return tuple(found)


def _sets_of(path: Path) -> Iterator[MeasuredSet]:
    try:
        tables = tomllib.loads(read_text(path, "file of measurements", _LARGEST_FILE))
    except tomllib.TOMLDecodeError as error:
        raise one_problem("", "", f"is not valid TOML: {error}.", "Correct it.") from None
    if "set" not in tables:
        remedy = "The manual, validation, shows such a file."
        raise one_problem("set", "", "is missing in a file of measurements.", remedy)
    read = validate(_FileTable, plain(tables))
    raise_any(read.problems)
    assert read.case is not None
    file, given = read.case, read.case.case
    beside = path.parent / given if isinstance(given, str) else path
    case = read_case(beside if isinstance(given, str) and beside.is_file() else given)
    for table in file.set:
        quantity, unit = _column(table.columns[-1])
        changes = {**file.changes, **table.changes}
        own = case.updated(changes) if changes else case
        raise_any(_problems(table, quantity, unit, own))
        heads = [_column(head) for head in table.columns[:-1]]
        ends = np.full((2, len(table.points)), math.nan)
        points = []
        for number, row in enumerate(table.points):
            cells = dict(zip(heads, row, strict=False))
            for side, name in enumerate(_ENDS):
                ends[side, number] = cells.pop((name, ""), math.nan)
            points.append({
                AXES.get(name, name): f"{cell} {by}" if by else cell
                for (name, by), cell in cells.items()
            })  # fmt: skip
            own.updated(points[-1])
        measured = np.array([row[-1] for row in table.points], dtype=float)
        yield MeasuredSet(file, table, own, tuple(points), measured, ends)


def _column(head: str) -> tuple[str, str]:
    """Name and unit of ``"speed [rpm]"``."""
    name, _, unit = head.partition("[")
    return name.strip(), unit.strip().removesuffix("]").strip()


def _problems(table: _SetTable, quantity: str, unit: str, case: Case) -> Iterator[Problem]:
    """What cannot be in a set, beside keys of its case."""
    key = f"set {table.name}"
    if quantity not in _QUANTITIES:
        allowed = "is the last column but cannot be compared."
        yield Problem(key, quantity, allowed, f"End with one of {', '.join(_QUANTITIES)}.")
        return
    try:
        _one(quantity, unit)
    except PydanticCustomError as error:
        yield Problem(f"{key}: columns", table.columns[-1], f"{error.message()}.", "")
    known = loss_names(case)
    for part in parts_of(table.component):
        if part not in known:
            allowed = f"is not a loss of the case; its losses are {', '.join(known)}."
            yield Problem(f"{key}: component", part, allowed, "Choose one of these.")
    heads = [_column(head)[0] for head in table.columns[:-1]]
    ends = [heads.index(name) for name in _ENDS if name in heads]
    for number, row in enumerate(table.points, 1):
        if len(row) != len(table.columns):
            allowed = f"has {len(row)} values for {len(table.columns)} columns."
            yield Problem(f"{key}: point {number}", "", allowed, "Give one for each column.")
        elif any(isinstance(row[place], str) for place in (*ends, -1)):
            allowed = "has text for what was measured."
            yield Problem(f"{key}: point {number}", "", allowed, "Give a number in the unit.")
        elif len(ends) == 2 and float(row[ends[0]]) > float(row[ends[1]]):
            allowed = "has a low limit above the high one."
            yield Problem(f"{key}: point {number}", "", allowed, "Exchange them.")
    if quantity == "mean_friction" and table.loss_factor is None:
        allowed = "is missing; losses follow from friction with it."
        yield Problem(f"{key}: loss_factor", "", allowed, "Give H_V as the source has it.")
    if (quantity == _SLOPE) != bool(table.over):
        allowed = f"belongs to {_SLOPE}, and is needed for it."
        yield Problem(f"{key}: over", "", allowed, "Give both or neither.")


# What is computed for a set.


@dataclass(frozen=True, slots=True, eq=False)
class Score:
    """How near a run comes to a set. Errors and trends are those of (computed - measured)/measured.

    A trend is the error at the highest less that at the lowest value, mean over the points that
    are alike otherwise; NaN where nothing varies.
    """

    set: MeasuredSet = field(repr=False)
    run: str  # `DEFAULTS`, or what is changed.
    computed: FloatArray  # In the unit of the set; NaN where there is no result.
    band: FloatArray  # Ends of the 95 % band, shape (2, n); NaN where none was asked for.

    @property
    def errors(self) -> FloatArray:
        """Of each point. [1]"""
        return self.set.errors(self.computed)

    @property
    def mean_error(self) -> float:
        """Mean of their magnitudes. [1]"""
        return float(np.nanmean(np.abs(self.errors)))

    @property
    def bias(self) -> float:
        """Mean of the errors. [1]"""
        return float(np.nanmean(self.errors))

    @property
    def inside(self) -> int | None:
        """How many measured values lie in the band of the computed ones."""
        if np.isnan(self.band).all():
            return None
        low, high = self.band
        return int(((low <= self.set.measured) & (self.set.measured <= high)).sum())

    @property
    def speeds(self) -> FloatArray | None:
        """Those of the input at all points; None if a point is formed of several. [rpm]"""
        if self.set.table.over:
            return None
        return np.array(_numbers(self.set.case, self.set.points, AXES["speed"])) * 30 / math.pi

    def trend(self, role: str) -> float:
        """Over ``"speed"``, ``"load"`` or ``"temperature"``. [1]"""
        points, found = self.set.points, []
        keys = [key for key in points[0] if key.endswith(_ROLES[role])]
        values = _numbers(self.set.case, points, keys[0]) if keys else []
        others = [tuple(it for key, it in point.items() if key not in keys) for point in points]
        for other in dict.fromkeys(others) if keys else ():
            alike = [number for number, it in enumerate(others) if it == other]
            low, high = (pick(alike, key=values.__getitem__) for pick in (min, max))
            if values[low] < values[high]:
                found.append(self.errors[high] - self.errors[low])
        return float(np.mean(found)) if found else math.nan

    def to_dict(self) -> Keys:
        """Everything as plain numbers and text; None stands for NaN."""
        own = self.set
        columns = {
            "measured": own.measured, "measured_low": own.ends[0], "measured_high": own.ends[1],
            "computed": self.computed, "error": self.errors,
            "band_low": self.band[0], "band_high": self.band[1],
        }  # fmt: skip
        figures = {"mean_error": self.mean_error, "bias": self.bias}
        figures |= {f"trend_over_{role}": self.trend(role) for role in _ROLES}
        return {
            "name": own.name,
            "source": own.file.source,
            "grade": own.file.grade,
            "read": own.file.read,
            "guessed": own.guessed,
            **dict(zip(("quantity", "unit"), own.quantity, strict=True)),
            "run": self.run,
            "count": len(own.points),
            **{name: _plain(value) for name, value in figures.items()},
            "inside": self.inside,
            "points": [
                {"conditions": point}
                | {name: _plain(column[number]) for name, column in columns.items()}
                for number, point in enumerate(own.points)
            ],
        }


def _plain(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _numbers(case: Case, points: Sequence[Keys], key: str) -> list[float]:
    """The values of a key at all points, in SI."""
    return [float(value_of(case.updated(point), key)) for point in points]


def scoreboard(
    sets: Sequence[MeasuredSet],
    runner: Runner = HERE,
    *,
    others: bool = False,  # Whether the runs of the files and each other model are computed too.
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> tuple[Score, ...]:
    """Every set with the defaults and, if wanted, otherwise; other models have no bands.

    Raises `ConvergenceError` if a point cannot be computed.
    """
    asked: list[tuple[MeasuredSet, str, Keys]] = [(own, DEFAULTS, {}) for own in sets]
    if others:
        asked += [(own, *run) for own in sets for run in own.runs.items()]
        points = [own for own in sets if not own.tests]  # slopes are formed of too many
        asked += [(own, *run) for own in points for run in model_runs(own.case).items()]
    found = []
    for number, (own, name, keys) in enumerate(asked):
        progress(number, len(asked))
        is_model = name not in (DEFAULTS, *own.runs)
        banded = name == DEFAULTS or not (is_model or own.tests)  # those of many tests take long
        try:
            found.append(scored(own, name, keys, runner, banded=banded))
        except InputError:
            if not is_model:
                raise  # else the model is not for this case
    progress(len(asked), len(asked))
    return tuple(sorted(found, key=lambda score: sets.index(score.set)))


def scored(
    own: MeasuredSet, run: str, keys: Keys, runner: Runner = HERE, *, banded: bool = False
) -> Score:
    """One set with changed keys; `run` is what that is called.

    The band of a slope is as wide as that of the last of its tests: what is uncertain is off by the
    same in all of them, and nothing averages out.
    """
    case = own.case.updated(keys) if keys else own.case
    parts, count = parts_of(own.table.component), max(1, len(own.tests))
    tests = [{**point, **test} for point in own.points for test in own.tests or ({},)]
    loss, power = _solved(case, tests, parts, runner)
    speed = np.abs(_numbers(case, tests, AXES["speed"]))
    if own.tests:
        sets = (getattr(case.updated(test), "planet", None) for test in tests)
        branches = [getattr(planet, "count", 1) for planet in sets]
        rows = zip(*((it / branches).reshape(-1, count) for it in (power, loss)), strict=True)
        slopes = [np.polyfit(across, up, 1)[0] for across, up in rows]
        computed = np.array(slopes) / _one(*own.quantity)
    else:
        computed = own.convert(loss, power, speed)
    band = np.full((2, computed.size), math.nan)
    if banded:
        last = tests[count - 1 :: count]
        nearby = nearby_at(case, solve(case.updated(last[0])), last, runner)
        for number, near in enumerate(nearby):
            places = [near.outputs.names.index(part) for part in parts]
            drawn = quick_band(near).results[places].sum(axis=0) / near.nominal[places].sum()
            factors = drawn[np.isfinite(drawn)]
            found = sample_summary(
                factors * computed[number]
                if own.tests
                else own.convert(factors * loss[number], power[number], speed[number])
            )
            band[:, number] = found.low, found.high
    return Score(own, run, computed, band)


def _solved(
    case: Case, points: Sequence[Keys], parts: Sequence[str], runner: Runner
) -> tuple[FloatArray, FloatArray]:
    """Losses and input powers of points. [W]"""
    tested = case.models.load_dependent == AS_TESTED and [*parts] == [LOAD_DEPENDENT]
    asked, unloaded = with_unloaded(points)  # points share their partners without torque
    if tested:
        case = case.updated({"models.load_dependent": COMPUTED})
    rows = runner.run(PointList(case, asked if tested else tuple(points)))
    if rows.failures:
        raise ConvergenceError(f"{len(rows.failures)} points fail, one with: {rows.failures[0]}")
    power = rows.numbers(INPUT_POWER)[: len(points)]
    if tested:
        return as_tested(rows, unloaded), power
    return np.sum([rows.numbers(part) for part in parts], axis=0), power


def model_runs(case: Case) -> dict[str, Keys]:
    """Changes of a case to each model of friction, or of its bearings if it has any.

    Left out are models that only state a number, and the contact solver, which takes minutes.
    """
    if isinstance(case, TrainCase):
        kinds = choices_of(ShaftBearingTable.model_fields["model"].annotation)
        return {
            kind: {f"bearings.{name}.model": kind for name in case.bearings}
            for kind in kinds
            if kind not in ("auto", "table") and case.bearings
        }
    names = choices_of(GearPairModels.model_fields["friction"].annotation)
    stated = ("auto", "constant", "table", "fitted", "ehl-direct")
    runs: dict[str, Keys] = {
        name: {"models.friction": name} for name in names if name not in stated
    }
    rolling = [term for term in type(case.losses).model_fields if term.endswith("_rolling")]
    without = {f"losses.{term}.include": False for term in rolling}
    return runs | {"schlenk, no rolling": {"models.friction": "schlenk", **without}}


def in_band(scores: Sequence[Score]) -> str:
    """How many measured values lie in the bands that the defaults give, as a sentence."""
    counted = [it for it in scores if it.run == DEFAULTS and it.inside is not None]
    inside = sum(it.inside or 0 for it in counted)
    count = sum(len(it.set.points) for it in counted)
    return f"{inside} of {count} measured values lie in the 95 % band that the defaults give."


def to_json(scores: Sequence[Score]) -> str:
    """All scores and their points as indented JSON text."""
    content = {"scores": [score.to_dict() for score in scores], "versions": versions()}
    return json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False)
