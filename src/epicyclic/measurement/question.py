"""What a comparison asks: a case at measured points; also as a plan whose points shards share."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case, build_case
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.measurement.comparison import MeasuredComparison, notes_on
from epicyclic.measurement.deviations import AS_GIVEN, CALIBRATED, all_errors
from epicyclic.measurement.files import Grid
from epicyclic.measurement.fit_result import Fit
from epicyclic.measurement.model import Computed, MeasuredPoints
from epicyclic.measurement.table import LOAD_DEPENDENT, Measurements, parse_measurements, parts_of
from epicyclic.sweeps.journal import Rows
from epicyclic.sweeps.plan import CasePlan, PointList
from epicyclic.sweeps.runner import HERE, Runner
from epicyclic.sweeps.unloaded import AS_TESTED, COMPUTED, LoadDependent

BoolArray = NDArray[np.bool_]

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

    def problems(self) -> Iterator[Problem]:
        """What is wrong with the question, beside mistakes in the table."""
        if self.group is not None and self.group not in self.table.labels:
            known = ", ".join(self.table.labels)
            yield Problem("group", self.group, "is not a column.", f"Columns are {known}.")
        yield from _tested_problems(self.case, self.table, self.load_dependent)

    def points(self, runner: Runner = HERE) -> MeasuredPoints:
        """The case at the measured points."""
        # what is uncertain changes no loss, and takes time to be checked at every point
        plain = self.case.updated({"uncertainty": None}) if self.case.uncertainty else self.case
        return MeasuredPoints(plain, self.table, runner, self.load_dependent)

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
            calibrated=None if calibrated is None else calibrated.loss,
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
) -> Question:
    """The question with its measurements; raises `InputError` with every mistake in them."""
    table = parse_measurements(grid, case, component)
    return Question(case, grid, component, load_dependent, group, table)


def check_any(given: Computed) -> None:
    """Raise `InputError` if no point could be computed."""
    if not np.isfinite(given.loss).any():
        reason = next(message for message in given.messages if message)
        problem = Problem("measurements", "", f"no point can be computed: {reason}", "")
        raise InputError([problem], "the comparison")


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
        how = (asked["component"], asked["load_dependent"], asked["group"])
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
        allowed = f"is neither {COMPUTED} nor {AS_TESTED}."
        yield Problem(key, load_dependent, allowed, f"Give {AS_TESTED}.")
    if not any(LOAD_DEPENDENT in parts_of(component) for component in table.component):
        allowed = "is about load-dependent losses, and none was measured."
        yield Problem(key, load_dependent, allowed, f"Name the component {LOAD_DEPENDENT}.")
    outlets = [case.thermal.oil_outlet_temperature, *(row.get(_OUTLET) for row in table.changes)]
    if any(outlet is not None for outlet in outlets):
        allowed = "is not known without torque, where less oil would follow from the same."
        yield Problem(_OUTLET, "", allowed, "Give thermal.oil_flow in its place.")
