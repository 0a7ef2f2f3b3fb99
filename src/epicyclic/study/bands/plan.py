"""Samples of what is uncertain in a case, solved at one operating point or at several."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.case.read import plain
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.errors import Problem, Status, one_problem, raise_any
from epicyclic.result.result import Result
from epicyclic.study.bands.nearby import (
    INPUT_POWER,
    Nearby,
    Outputs,
    factors_of,
    known_values,
    loss_numbers,
    nearby_of,
    outputs_of,
    steps,
    without_table,
)
from epicyclic.study.bands.samples import Samples, groups_of, make_samples
from epicyclic.study.sweeps.plan import CasePlan
from epicyclic.study.sweeps.runner import Row, Rows, Runner

FloatArray = NDArray[np.float64]
Point = Mapping[str, Any]

FEWEST, MOST = 16, 65536  # Points in a set.


@dataclass(frozen=True, slots=True)
class SamplePlan(CasePlan):
    """The same samples of the inputs of a case at each of its operating points.

    Some make no case, and are counted.
    """

    kind: ClassVar[str] = "uncertainty"
    may_fail: ClassVar[bool] = True
    outputs: Outputs
    inputs: tuple[UncertainValue, ...] = ()
    count: int = 1  # Points in each set of samples.
    # Values of the inputs in their units, of all sets one after another; of each operating point.
    drawn: tuple[FloatArray, ...] = ()
    points: tuple[Point, ...] = ({},)  # What the operating points change in the case.

    @property
    def samples(self) -> int:
        """Samples of each operating point, those of all sets."""
        count: int = self.drawn[0].shape[1]
        return count

    @property
    def size(self) -> int:
        """Number of cases."""
        return len(self.points) * self.samples

    def changes(self, index: int) -> dict[str, Any]:
        """The keys that case number `index`, counted with the samples fastest, changes."""
        point, sample = divmod(index, self.samples)
        column = self.drawn[point][:, sample].tolist()
        own = {it.key: it.stated(number) for it, number in zip(self.inputs, column, strict=True)}
        return {**self.points[point], **own}

    def order(self) -> list[int]:
        """Indices of all cases: sets differ in one group of inputs, operating points in none."""
        numbers = np.arange(self.size).reshape(len(self.points), -1, self.count)
        return [int(index) for index in numbers.transpose(2, 1, 0).ravel()]

    def describe(self) -> dict[str, Any]:
        """The case, its operating points and a digest of the samples."""
        digest = hashlib.sha256(b"".join(drawn.tobytes() for drawn in self.drawn))
        return {
            **CasePlan.describe(self),
            "inputs": [it.key for it in self.inputs],
            "count": self.count,
            "points": plain(self.points),
            "drawn": digest.hexdigest(),
        }

    def _solve(self, index: int) -> Row:
        """What the results follow from; nothing else is read."""
        case = self.case.updated(self.changes(index))
        numbers = loss_numbers(case, self.outputs, self.flow_tables)
        return Row(str(Status.CONVERGED), numbers=numbers)


def check_samples(samples: int) -> None:
    """Raise `InputError` for a number that is no power of 2, or too small or large."""
    if FEWEST <= samples <= MOST and samples & (samples - 1) == 0:
        return
    nearest = 2 ** round(np.log2(min(max(samples, FEWEST), MOST)))
    allowed = f"must be a power of 2 from {FEWEST} to {MOST}."
    raise one_problem("samples", str(samples), allowed, f"Take {nearest}.", "the command")


@dataclass(frozen=True, slots=True)
class SampledCase:
    """Samples A and B of a case at operating points, and A with some groups of inputs from B."""

    outputs: Outputs
    # Samples of each operating point: of equal probabilities, about the values of that point.
    samples: tuple[Samples, ...]
    groups: tuple[int, ...]  # Numbers of the groups that are solved for with values from B.
    plan: SamplePlan

    def results(
        self,
        rows: Rows,
        *,
        # Whether to go on behind A and B with A with each of all groups from B.
        mixed: bool = True,
    ) -> FloatArray:
        """Results at all operating points, in all sets of samples.

        In the order of `Outputs.names`.
        """
        losses = np.array([rows.numbers(name) for name in self.outputs.numbers])
        losses = losses.reshape(len(losses), len(self.samples), -1, self.plan.count)
        power = rows.numbers(INPUT_POWER).reshape(losses.shape[1:])
        return np.array(
            [
                [
                    self.outputs.of(
                        losses[:, point, solved],
                        power[point, solved],
                        factors_of(own.values, drawn),
                    )
                    for solved, drawn in self._sets(own, mixed)
                ]
                for point, own in enumerate(self.samples)
            ]
        )

    def ends(self, rows: Rows) -> tuple[list[str], list[str]]:
        """Status and message of all samples of A and B: of the first point that fails, if any."""
        size = self.plan.samples
        found = []
        for sample in range(2 * self.plan.count):
            numbers = range(sample, len(rows), size)
            failed = next((it for it in numbers if rows.message[it]), sample)
            found.append((rows.status[failed], rows.message[failed]))
        status, message = zip(*found, strict=True)
        return list(status), list(message)

    def _sets(self, own: Samples, mixed: bool) -> list[tuple[int, FloatArray]]:
        """Number of the solved set, and the values, of A, B and mixtures."""
        sets = [(0, own.a), (1, own.b)]
        for group in range(len(own.groups)) if mixed else ():
            solved = self.groups.index(group) + 2 if group in self.groups else 0
            sets.append((solved, own.mixed(group)))
        return sets


def sampled_case(
    case: Case,
    result: Result,  # Result of the case.
    count: int,  # As for `make_samples`.
    seed: int,  # As for `make_samples`.
    points: Sequence[Point] = ({},),  # What the operating points change.
    # Which values change any loss: only these are varied, and A is solved with each group of them
    # from B. Default: all are varied, in A and B alone.
    active: Sequence[bool] | None = None,
) -> SampledCase:
    """Samples of a case with the same probabilities of all inputs at each operating point."""
    values = _values_at(case, result, points)
    (first, *_) = values
    inputs = [
        number
        for number, value in enumerate(first)
        if not value.is_model_form and (active is None or active[number])
    ]
    groups = tuple(
        number
        for number, group in enumerate(groups_of(first))
        if active is not None and not set(group).isdisjoint(inputs)
    )

    @cache  # operating points that differ in speed and torque have equal values
    def drawn(own: tuple[UncertainValue, ...]) -> tuple[Samples, FloatArray]:
        found = make_samples(own, count, seed)
        sets = [found.a, found.b, *map(found.mixed, groups)]
        return found, np.concatenate(sets, axis=1)[inputs]

    samples, own = zip(*map(drawn, values), strict=True)
    outputs = outputs_of(case, result)
    plan = SamplePlan(
        without_table(case),
        outputs,
        inputs=tuple(first[number] for number in inputs),
        count=count,
        drawn=own,
        points=tuple(points),
    )
    return SampledCase(outputs, samples, groups, plan)


def nearby_at(
    case: Case,
    result: Result,  # Result of the case.
    points: Sequence[Point],  # What the operating points change.
    runner: Runner,
) -> tuple[Nearby, ...]:
    """Losses at operating points, at each with every input off by a standard deviation."""
    outputs = outputs_of(case, result)
    values = _values_at(case, result, points)
    changes = [
        [{**point, **step} for step in ({}, *steps(own))]
        for point, own in zip(points, values, strict=True)
    ]
    every = tuple(it for own in changes for it in own)
    plan = SamplePlan(
        without_table(case), outputs, drawn=(np.empty((0, 1)),) * len(every), points=every
    )
    rows = runner.run(plan)
    losses = np.array([rows.numbers(name) for name in outputs.numbers]).T
    power = rows.numbers(INPUT_POWER)
    found, first = [], 0
    for own, those in zip(values, changes, strict=True):
        part = slice(first + 1, first + len(those))
        found.append(nearby_of(own, outputs, losses[first], float(power[first]), losses[part]))
        first += len(those)
    return tuple(found)


def _values_at(
    case: Case, result: Result, points: Sequence[Point]
) -> list[tuple[UncertainValue, ...]]:
    """What is uncertain at each operating point: everywhere the same keys."""
    found = [known_values(case.updated(point) if point else case, result) for point in points]
    keys = [frozenset(it.key for it in values) for values in found]
    everywhere = frozenset.intersection(*keys)
    problems = [
        Problem(
            f"uncertainty.{key}",
            "",
            f"has a distribution at some operating points only, and none at {dict(point)}.",
            "State it for all of them, as exact = true if it is known.",
        )
        for key in sorted(frozenset.union(*keys) - everywhere)
        for point in [next(it for it, own in zip(points, keys, strict=True) if key not in own)]
    ]
    raise_any(problems, case.source)
    return found
