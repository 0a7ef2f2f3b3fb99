"""Measured losses beside computed ones, with or without a fit of uncertain inputs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from epicyclic.arrays import BoolArray
from epicyclic.case.case import Case, CaseTable, build_case
from epicyclic.case.keys import OFF_OPEN_BOUND, Parameter, no_start, parameter_of
from epicyclic.case.tables.models import AS_TESTED, COMPUTED, LoadDependent
from epicyclic.case.tables.uncertainty import MODEL_FORM, model_forms
from epicyclic.dataclass import asdict, dataclass, field, replace
from epicyclic.errors import Problem, one_problem, raise_any
from epicyclic.messages import did_you_mean
from epicyclic.study.bands.inputs import factors_of_kind
from epicyclic.study.bands.plan import without_table
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.measured.comparison import (
    AS_GIVEN,
    CALIBRATED,
    MeasuredComparison,
    all_errors,
    notes_on,
)
from epicyclic.study.measured.fit import Tell, fit_parameters
from epicyclic.study.measured.intervals import Fit, reaches
from epicyclic.study.measured.residuals import Computed, MeasuredPoints
from epicyclic.study.measured.rig import NO_RIG, Rig, rows_where
from epicyclic.study.measured.table import (
    LOAD_DEPENDENT,
    Measurements,
    parse_measurements,
    parts_of,
)
from epicyclic.study.sweeps.run import CasePlan, PointList
from epicyclic.study.sweeps.runner import HERE, Progress, Rows, Runner
from epicyclic.study.table_file import AS_IT_IS, Grid, TableForm, read_grid

if TYPE_CHECKING:
    import pandas as pd


# What a comparison asks: a case at measured points; also as a plan whose points shards share.

_GROUPS = ("temperature", "state", "speed")
_OUTLET = "thermal.oil_outlet_temperature"


@dataclass(frozen=True, slots=True)
class Question:
    """What is to be compared: a case, measurements, and what was measured."""

    case: Case
    grid: Grid  # The measurements as they are in their file.
    component: str  # As for `compare_measured`.
    load_dependent: LoadDependent  # As for `compare_measured`.
    group: str | None  # As for `compare_measured`.
    table: Measurements
    rig: Rig = NO_RIG

    def problems(self) -> Iterator[Problem]:
        """What is wrong with the question, beside mistakes in the table."""
        if self.group is not None and self.group not in self.table.labels:
            known = ", ".join(self.table.labels)
            yield Problem("group", self.group, "is not a column.", f"Columns are {known}.")
        yield from _tested_problems(self.case, self.table, self.load_dependent)

    def points(self, runner: Runner = HERE) -> MeasuredPoints:
        """The case at the measured points."""
        # what is uncertain changes no loss, and takes time to be checked at every point
        return MeasuredPoints(without_table(self.case), self.table, runner, self.load_dependent)

    def answer(
        self,
        given: Computed,
        held_out: BoolArray | None = None,
        calibrated: Computed | None = None,
        fit: Fit | None = None,
    ) -> MeasuredComparison:
        """The comparison, of what was computed with the case as given, and calibrated."""
        if held_out is None:
            held_out = np.zeros(len(self.table), dtype=bool)
        group = self.group or next(name for name in _GROUPS if name in self.table.labels)
        states = {AS_GIVEN: given.loss}
        if calibrated is not None:
            states[CALIBRATED] = calibrated.loss
        return MeasuredComparison(
            case=self.case,
            measured=self.table,
            computed=given.loss,
            calibrated=states.get(CALIBRATED),
            held_out=held_out,
            load_dependent=self.load_dependent,
            group=group,
            errors=tuple(all_errors(self.table, states, held_out, group)),
            fit=fit,
            notes=tuple(notes_on(self.table, given if calibrated is None else calibrated)),
        )


def ask(
    case: Case,
    grid: Grid,
    component: str = "total",
    load_dependent: LoadDependent = COMPUTED,
    group: str | None = None,
    rig: Rig = NO_RIG,
) -> Question:
    """The question with its measurements; raises `InputError` with every mistake in them."""
    grid = rig.grid(grid)
    table = rig.losses(parse_measurements(grid, case, component))
    if rig.unloaded and LOAD_DEPENDENT in table.component:  # what was measured is so computed
        load_dependent = AS_TESTED
    rig = replace(rig, torque_uncertainty="")  # the cells have it
    return Question(case, grid, component, load_dependent, group, table, rig)


def check_any(given: Computed) -> None:
    """Raise `InputError` if no point could be computed."""
    if not np.isfinite(given.loss).any():
        reason = next(message for message in given.messages if message)
        raise one_problem(
            "measurements", "", f"no point can be computed: {reason}", "", "the comparison"
        )


@dataclass(frozen=True, slots=True)
class ComparisonPlan(PointList):
    """The points of a question without a fit."""

    kind: ClassVar[str] = "comparison"
    may_fail: ClassVar[bool] = True
    question: Question = field(kw_only=True)

    @classmethod
    def of(cls, question: Question) -> Self:
        """The points of a question; raises `InputError` if something is wrong with it."""
        raise_any(question.problems(), "the comparison")
        points = question.points()
        asked, _ = points.asked({})
        return cls(points.case, asked, question=question)

    @classmethod
    def again(cls, content: Mapping[str, Any], source: str) -> Self:
        """The plan that `describe` described."""
        asked = content["question"]
        rows = ((line, tuple(cells)) for line, cells in asked["rows"])
        grid = Grid(tuple(asked["header"]), tuple(rows), asked["measured"])
        how = (asked["component"], asked["load_dependent"], asked["group"], Rig(**asked["rig"]))
        return cls.of(ask(build_case(content["case"], {}, source), grid, *how))

    def describe(self) -> dict[str, Any]:
        """The case, the measurements and what was measured: the points follow from them."""
        asked = self.question
        about = {
            "measured": asked.grid.source,
            "header": list(asked.grid.header),
            "rows": [[line, list(cells)] for line, cells in asked.grid.rows],
            "component": asked.component,
            "load_dependent": asked.load_dependent,
            "group": asked.group,
            "rig": asdict(asked.rig),
        }
        return {**CasePlan.describe(self), "case": asked.case.given(), "question": about}

    def comparison(self, rows: Rows) -> MeasuredComparison:
        """What `compare_measured` returns, of the rows of all points."""
        points = self.question.points()
        _, unloaded = points.asked({})
        (given,) = points.losses(rows, unloaded)
        check_any(given)
        return self.question.answer(given)


def _tested_problems(case: Case, table: Measurements, load_dependent: str) -> Iterator[Problem]:
    if load_dependent == COMPUTED:
        return
    key = "load_dependent"
    if load_dependent != AS_TESTED:
        allowed = f"must be {COMPUTED} or {AS_TESTED}."
        yield Problem(key, load_dependent, allowed, f"Give {AS_TESTED}.")
    if not any(LOAD_DEPENDENT in parts_of(component) for component in table.component):
        allowed = "concerns load-dependent losses, but none were measured."
        yield Problem(key, load_dependent, allowed, f"Name the component {LOAD_DEPENDENT}.")
    outlets = [case.thermal.oil_outlet_temperature, *(row.get(_OUTLET) for row in table.changes)]
    if any(outlet is not None for outlet in outlets):
        allowed = (
            "is unknown without torque: the same outlet temperature would imply a smaller oil flow."
        )
        yield Problem(_OUTLET, "", allowed, "Give thermal.oil_flow instead.")


def compare_measured(
    case: CaseSource,
    measured: str | Path | pd.DataFrame,
    *,
    component: str = "total",
    load_dependent: LoadDependent = COMPUTED,
    group: str | None = None,
    fit: Iterable[str] = (),
    hold_out: str | float | None = None,
    seed: int = 0,
    relative: float | None = None,
    confidence: float = 0.95,
    rig: Rig = NO_RIG,
    form: TableForm = AS_IT_IS,
    jobs: int | None = None,
    dask: str | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
    tell: Tell = lambda text: None,
) -> MeasuredComparison:
    """Compare measured losses with those of a case, and fit uncertain inputs if asked to.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
        Everything that the table does not state.
    measured : str, Path or pandas.DataFrame
        CSV, Excel or Parquet file, or a table: columns ``speed``, ``torque``, ``temperature`` and
        ``loss`` with units, ``"speed [rpm]"``; optionally ``uncertainty``, ``component``, of a
        train with states ``state``, any dotted key of the case, and labels. A train whose losses
        are all given needs no temperature.
    component : str, optional
        The loss that was measured, where no column says so: a term, terms joined by ``+``,
        ``"load_dependent"``, ``"load_independent"`` or ``"total"``.
    load_dependent : {"computed", "as-tested"}, optional
        What load-dependent losses are: the sum of those that depend on the load, or, as a test rig
        finds them, the total loss less that without torque at the same speed and oil inlet
        temperature, each at its own temperatures.
    group : str, optional
        Column by whose values the errors are given. Default: the temperature, else the state, else
        the speed.
    fit : iterable of str, optional
        Keys of the case to be fitted, from their values there and within the range of the schema.
    hold_out : str or float, optional
        Points that the fit must not see: ``"COLUMN=VALUE"``, or a share of all points, drawn with
        `seed`.
    seed : int, optional
    relative : float, optional
        Standard uncertainty of all losses over them, of a table without such a column. [1]
    confidence : float, optional
        Confidence of the intervals of fitted values. [1]
    rig : Rig, optional
        How the losses of the set under test follow from those of a whole rig.
    form : TableForm, optional
        How a file is to be read, where it does not say so itself.
    jobs, dask, progress
        As for `sweep`; the progress starts again with every round of a fit.
    journal : str or Path, optional
        Folder that keeps finished points, those of each round in a file.
    tell : callable, optional
        Called with a sentence on how the fit gets on, in every round.

    Raises
    ------
    InputError
        With every mistake in the table, or if the fit cannot be made.
    ConvergenceError
        If the fit does not converge.
    """
    runner = Runner(jobs, dask, journal=journal, progress=progress)
    case = as_case(case)
    question = ask(case, read_grid(measured, form), component, load_dependent, group, rig)
    table = question.table
    if relative is not None:
        raise_any(_relative_problems(table, relative), "the comparison")
        table = replace(table, uncertainty=relative * np.abs(table.loss))
        question = replace(question, table=table)
    keys = tuple(dict.fromkeys(fit))
    varied = {key for change in table.changes for key in change}
    problems = [*question.problems()]
    if hold_out is not None and not keys:
        allowed = "excludes points from a fit, but no keys are fitted."
        problems.append(Problem("hold_out", str(hold_out), allowed, "Name the keys to fit."))
    if not 0 < confidence < 1:
        allowed = "must be > 0 and < 1."
        problems.append(Problem("confidence", f"{confidence:g}", allowed, "Give 0.95."))
    raise_any(problems, "the comparison")
    parameters = make_parameters(case, keys, varied)
    held_out = _held_out(table, hold_out, seed)
    points = question.points(runner)
    (given,) = points.compute({})
    check_any(given)
    if not parameters:
        return question.answer(given, held_out)
    used = np.isfinite(given.loss) & ~held_out
    reach = reaches(case, parameters)
    found = fit_parameters(points, parameters, used, confidence, reach, tell, relative=relative)
    (calibrated,) = points.compute(found.settings)
    return question.answer(given, held_out, calibrated, found)


def _relative_problems(table: Measurements, relative: float) -> Iterator[Problem]:
    key, given = "relative", f"{100 * relative:g} %"
    if not 0 < relative < 1:
        yield Problem(key, given, "must be > 0 and < 100 %.", "Give the standard uncertainty.")
    if table.uncertainty is not None:
        allowed = "is also a column of the table, uncertainty."
        yield Problem(key, given, allowed, "Keep one of them.")
    if (table.loss == 0).any():
        allowed = "leaves a measured loss of 0 without uncertainty."
        yield Problem(key, given, allowed, "Add a column uncertainty [W].")


def _held_out(table: Measurements, hold_out: str | float | None, seed: int) -> BoolArray:
    """Which points the fit must not see."""
    count = len(table)
    chosen = np.zeros(count, dtype=bool)
    if hold_out is None:
        return chosen
    share = math.nan
    with suppress(ValueError):
        share = float(hold_out)
    if not 0 < share < 1:
        return rows_where(table, str(hold_out), "hold_out")
    chosen[np.random.default_rng(seed).permutation(count)[: round(share * count)]] = True
    return chosen


def make_parameters(
    case: CaseTable, keys: Iterable[str], varied: Iterable[str]
) -> tuple[Parameter, ...]:
    """The keys to be fitted, checked; `varied` are those that the table sets itself.

    Raises `InputError` for keys that are unknown, hold no number, or have no start value.
    """
    chosen, taken = list(keys), set(varied)
    found = []
    for key in chosen:
        if key.startswith(MODEL_FORM):
            item = _of_models(case, key, taken | set(chosen))
        else:
            item = parameter_of(case, key, taken)
            if isinstance(item, Parameter) and item.start == 0:  # nothing to scale it by
                item = no_start(item.key, "is 0 in the case")
        found.append(item)
    raise_any([item for item in found if isinstance(item, Problem)], "the fit")
    return tuple(item for item in found if isinstance(item, Parameter))


def _of_models(case: CaseTable, key: str, taken: set[str]) -> Parameter | Problem:
    """The factor on all losses of a kind, ``model_form.sliding``."""
    kind = key.removeprefix(MODEL_FORM)
    if kind not in model_forms():
        remedy = did_you_mean(kind, model_forms()) or f"There are {', '.join(model_forms())}."
        return Problem(key, "", "is not a kind of loss.", remedy)
    factors = factors_of_kind(case, kind)
    if not factors:
        return Problem(key, "", "has no factor in this case.", "Fit another key.")
    both = sorted(taken & factors.keys())
    if both:
        allowed = f"contains {both[0]}, which is fitted or varied too."
        return Problem(key, "", allowed, "Fit one of them.")
    return Parameter(key, "", 1.0, OFF_OPEN_BOUND, math.inf, factors)
