"""Losses where each uncertain input is a little off, and samples of all of them."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from itertools import chain
from typing import Any, ClassVar

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.case.case import Case
from epicyclic.case.tables.models import AS_TESTED
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.dataclass import dataclass
from epicyclic.errors import EpicyclicError, Problem, Status, one_problem, raise_any
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.machine.balance import NO_POWER
from epicyclic.machine.element import LOAD_DEPENDENT
from epicyclic.machine.solve import LOSS_AGREEMENT
from epicyclic.result.result import LossTerm, Result
from epicyclic.schema.read import plain
from epicyclic.study.bands.inputs import model_form_of, uncertain_values
from epicyclic.study.bands.samples import Samples, groups_of, make_samples
from epicyclic.study.solve import flows_around, losses_and_powers, without_torque
from epicyclic.study.sweeps.run import CasePlan
from epicyclic.study.sweeps.runner import Row, Rows, Runner

# From losses and factors of models to the results that have a band.

SUMS = ("load_dependent", "load_independent", "total", "efficiency")
"""Results beside the single losses."""
UNLOADED = "unloaded."  # Before the name of a loss without torque.
INPUT_POWER, SHAFT_POWER = "input_power", "shaft_power"
OF_SHAFT_POWER = ("operation.torque", "operation.speed")


def entering(at_shaft: FloatArray, loss: FloatArray) -> FloatArray:
    """Power that enters at this shaft and the other one, of which this one's is stated. [W]"""
    return np.maximum(at_shaft, 0.0) + np.maximum(loss - at_shaft, 0.0)


@dataclass(frozen=True, slots=True)
class Powers:
    """Power that enters where the losses are as solved, and where they are not. [W]"""

    entering: FloatArray
    shaft: FloatArray  # Of the shaft whose torque is stated.
    loss: FloatArray

    def __getitem__(self, place: Any) -> Powers:
        return Powers(self.entering[place], self.shaft[place], self.loss[place])

    def with_loss(self, loss: FloatArray, shaft: FloatArray | None = None) -> FloatArray:
        """Power that enters with another loss, and another power of the shaft. Theory (U7)."""
        shaft = self.shaft if shaft is None else shaft
        return self.entering + entering(shaft, loss) - entering(self.shaft, self.loss)


@dataclass(frozen=True, slots=True)
class Outputs:
    """How results follow from the losses of one case."""

    losses: tuple[str, ...]  # Names of those that are included.
    load_dependent: BoolArray  # Which of them depend on the load.
    # Kinds of models of each with their shares, see `model_form_of`. [1]
    kinds: tuple[Mapping[str, float], ...]
    # True if they are grouped as a test rig does: what torque adds, and the rest.
    tested: bool = False

    @property
    def numbers(self) -> tuple[str, ...]:
        """What they follow from: losses, where they are grouped as tested also those unloaded."""
        return (*self.losses, *(f"{UNLOADED}{name}" for name in self.losses if self.tested))

    @property
    def names(self) -> tuple[str, ...]:
        """Losses, their sums, efficiency."""
        return (*self.losses, *SUMS)

    def of(
        self,
        losses: FloatArray,  # In the order of `numbers`. [W]
        powers: Powers,
        factors: Mapping[str, FloatArray],  # By kind; 1 for others. [1]
        shaft: FloatArray | None = None,  # Power of the shaft, if it is not that of `powers`. [W]
    ) -> FloatArray:
        """Results with the losses of each kind times the factor of its model. Theory (U7).

        In the order of `names`; efficiency NaN without power, 0 if losses take all of it.
        """
        kinds = self.kinds * (2 if self.tested else 1)
        every = np.array(
            [
                row * sum(share * factors.get(kind, 1.0) for kind, share in own.items())
                for row, own in zip(losses, kinds, strict=True)
            ]
        ).reshape(losses.shape)
        scaled, unloaded = every[: len(self.losses)], every[len(self.losses) :]
        independent = (unloaded if self.tested else scaled[~self.load_dependent]).sum(axis=0)
        total = scaled.sum(axis=0)
        power = powers.with_loss(total, shaft)
        with np.errstate(divide="ignore", invalid="ignore"):
            efficiency = np.where(power > 0, np.maximum(0.0, 1 - total / power), np.nan)
            efficiency[power - total <= NO_POWER * power] = 0.0
        return np.concatenate([scaled, [total - independent, independent, total, efficiency]])


def outputs_of(case: Case, result: Result) -> Outputs:
    """The results of a case, from one of it."""
    terms = [term for term in result.terms if not term.left_out]
    return Outputs(
        tuple(term.name for term in terms),
        np.array([term.group == LOAD_DEPENDENT for term in terms], dtype=bool),
        tuple(_kinds(term) for term in terms),
        case.models.load_dependent == AS_TESTED,
    )


def _kinds(term: LossTerm) -> dict[str, float]:
    """Kinds of the models of a loss, with their shares. [1]

    There are two where one gear of a pair dips: it churns, the other has the drag of the mixture.
    """
    found: dict[str, float] = {}
    for method, share in (term.shares or {term.method: 1.0}).items():
        kind = model_form_of(term.name, method)
        found[kind] = found.get(kind, 0.0) + share
    return found


def shaft_power(case: Case) -> float:
    """Power of the shaft whose torque and speed the case states. [W]"""
    return case.operation.torque * case.operation.speed


def loss_numbers(
    cases: Sequence[Case], outputs: Outputs, flow_tables: FlowTables
) -> list[dict[str, float] | Exception]:
    """`Outputs.numbers` of cases, their input powers, and those of the stated shaft. [W]

    Or what is wrong with a case.
    """
    changed = _computed if outputs.tested else None
    found: list[dict[str, float] | Exception] = [
        it
        if isinstance(it, Exception)
        else {**it[0], INPUT_POWER: it[1], SHAFT_POWER: shaft_power(case)}
        for case, it in zip(cases, losses_and_powers(cases, flow_tables, changed), strict=True)
    ]
    if not outputs.tested:
        return found
    unloaded = losses_and_powers(cases, flow_tables, without_torque)
    for number, (loaded, other) in enumerate(zip(found, unloaded, strict=True)):
        if isinstance(other, Exception):
            found[number] = other
        elif not isinstance(loaded, Exception):
            loaded |= {f"{UNLOADED}{name}": watts for name, watts in other[0].items()}
    return found


def factors_of(values: Sequence[UncertainValue], points: FloatArray) -> dict[str, FloatArray]:
    """Factors of the models at some points of all `values`, by kind."""
    return {
        value.kind_of_loss: row
        for value, row in zip(values, points, strict=True)
        if value.is_model_form
    }


HALF_WIDTH = math.sqrt(3.0)
"""Half the width of a uniform distribution over its standard deviation. [1]"""


def _computed(case: Case) -> Case:
    return case.updated({"models.load_dependent": "computed"})


SAME_FLOW = 0.005
"""Difference of the number of a flow through pockets below which its scaled figures stay, relative:
that of 10 K. [1]"""

STILL = 10 * LOSS_AGREEMENT
"""Change of a loss for a standard deviation of an input, over all losses, that is none. [1]"""


@dataclass(frozen=True, slots=True)
class Nearby:
    """Losses where one input is off by a standard deviation."""

    values: tuple[UncertainValue, ...]
    outputs: Outputs
    losses: FloatArray  # `Outputs.numbers`, at the values of the case. [W]
    powers: Powers  # Each of shape (1,).
    # One standard deviation below and above the middle of each input; NaN where there is no result.
    # [W]
    ends: FloatArray

    @property
    def nominal(self) -> FloatArray:
        """Results at the values of the case, in the order of `Outputs.names`."""
        return self.outputs.of(self.losses[:, None], self.powers, {})[:, 0]

    @property
    def active(self) -> tuple[bool, ...]:
        """Which values change any loss."""
        moved = np.abs(self.ends - self.losses).max(axis=(1, 2), initial=0.0)
        still = STILL * self.losses.sum()
        return tuple(
            value.is_model_form or not change <= still  # not a number where there is no result
            for value, change in zip(self.values, moved, strict=True)
        )


def known_values(case: Case, result: Result) -> tuple[UncertainValue, ...]:
    """All that is uncertain in a case whose table [uncertainty] is sound."""
    kinds = tuple(dict.fromkeys(chain(*outputs_of(case, result).kinds)))
    values, problems = uncertain_values(case, kinds)
    raise_any(problems, case.source)
    return values


def without_table(case: Case) -> Case:
    """A case that is solved with given values, whatever its table [uncertainty] says of them."""
    return case.updated({"uncertainty": None}) if case.uncertainty else case


def look_nearby(case: Case, result: Result) -> Nearby:
    """Solve a case with each of its uncertain inputs changed."""
    values, outputs = known_values(case, result), outputs_of(case, result)
    alone = without_table(case)
    flows = flows_around(alone, SAME_FLOW)
    losses = np.array([result.losses[name] for name in outputs.losses])
    if outputs.tested:
        (losses,) = _losses(alone, [{}], outputs, flows)
    changes = steps(values)
    # where all oil has the temperature of its inlet, no loss sees how heat goes
    cold = alone.models.temperatures == "inlet"
    of_heat = [cold and all(key.startswith("thermal.") for key in it) for it in changes]
    moved = np.flatnonzero(np.logical_not(of_heat)).tolist()
    stepped = np.tile(losses, (len(changes), 1))
    stepped[moved] = _losses(alone, [changes[number] for number in moved], outputs, flows)
    own = (result.input_power, shaft_power(case), losses[: len(outputs.losses)].sum())
    return nearby_of(values, outputs, losses, Powers(*map(np.atleast_1d, own)), stepped)


def steps(values: Sequence[UncertainValue]) -> list[dict[str, Any]]:
    """What to change in a case: each input one standard deviation down, then up."""
    return [
        {value.key: value.stated(float(at_deviations(value, end)))}
        for value in values
        if not value.is_model_form
        for end in (-1.0, 1.0)
    ]


def nearby_of(
    values: tuple[UncertainValue, ...],
    outputs: Outputs,
    losses: FloatArray,
    powers: Powers,
    stepped: FloatArray,
) -> Nearby:
    """What the losses of all `steps`, shape (2 d, t), say; models leave them as they are."""
    inputs = np.array([not value.is_model_form for value in values], dtype=bool)
    ends = np.tile(losses, (len(values), 2, 1))
    ends[inputs] = stepped.reshape(inputs.sum(), 2, losses.size)
    return Nearby(values, outputs, losses, powers, ends)


def _losses(
    case: Case, changes: Sequence[Mapping[str, Any]], outputs: Outputs, flows: FlowTables
) -> FloatArray:
    """Losses of a case with each of some changes; NaN where there is no result."""
    cases: dict[int, Case] = {}
    for number, change in enumerate(changes):
        with suppress(EpicyclicError):
            cases[number] = case.updated(change)
    losses = np.full((len(changes), len(outputs.numbers)), np.nan)
    for number, its in zip(cases, loss_numbers(list(cases.values()), outputs, flows), strict=True):
        if not isinstance(its, Exception):
            losses[number] = [its[name] for name in outputs.numbers]
        elif not isinstance(its, EpicyclicError):
            raise its
    return losses


def at_deviations(value: UncertainValue, deviations: Any) -> Any:
    """A value one or several standard deviations from the middle of its distribution."""
    if value.kind == "normal":
        found = value.value + deviations * value.spread[0]
    elif value.kind == "lognormal":
        found = value.value * value.spread[0] ** deviations
    else:
        low, high = value.spread
        found = (low + high) / 2 + deviations * (high - low) / 2 / HALF_WIDTH
    return np.clip(found, value.low, value.high)


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

    def found(self, rows: Rows) -> tuple[FloatArray, Powers]:
        """`Outputs.numbers`, shape (t, operating points, samples), and the powers."""
        power, shaft, *every = (
            rows.numbers(name).reshape(-1, self.samples)
            for name in (INPUT_POWER, SHAFT_POWER, *self.outputs.numbers)
        )
        losses = np.array(every).reshape(-1, *power.shape)
        return losses, Powers(power, shaft, losses[: len(self.outputs.losses)].sum(axis=0))

    def order(self) -> list[int]:
        """Indices of all cases: sets differ in one group of inputs, operating points in none."""
        numbers = np.arange(self.size).reshape(len(self.points), -1, self.count)
        return [int(index) for index in numbers.transpose(2, 1, 0).ravel()]

    def describe(self) -> dict[str, Any]:
        """The case, its operating points and a digest of the samples."""
        return {
            **CasePlan.describe(self),
            "inputs": [it.key for it in self.inputs],
            "count": self.count,
            "points": plain(self.points),
            "drawn": hashlib.sha256(b"".join(drawn.tobytes() for drawn in self.drawn)).hexdigest(),
        }

    @property
    def together(self) -> bool:
        """See `CasePlan`."""
        return True

    def _answers(self, cases: Sequence[Case]) -> Sequence[Any]:
        """What the results follow from; nothing else is read."""
        return loss_numbers(cases, self.outputs, self.flow_tables)

    def _row_of(self, answer: Any) -> Row:
        return Row(str(Status.CONVERGED), numbers=answer)


def check_samples(samples: int, seed: int = 0) -> None:
    """Raise `InputError` for a number that is no power of 2, too small or large, and for a seed."""
    if seed < 0:
        raise one_problem("seed", str(seed), "must be 0 or more.", "Take 1.", "the command")
    if FEWEST <= samples <= MOST and samples & (samples - 1) == 0:
        return
    nearest = 2 ** round(np.log2(min(max(samples, FEWEST), MOST)))
    allowed = f"must be a power of 2 from {FEWEST} to {MOST}."
    raise one_problem("samples", str(samples), allowed, f"Take {nearest}.", "the command")


@dataclass(frozen=True, slots=True)
class SampledCase:
    """Samples A and B of a case at operating points, and A with some groups of inputs from B."""

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
        """Results at all points in all sets of samples, in the order of `Outputs.names`."""
        losses, powers = self.plan.found(rows)
        return np.array(
            [
                [
                    self.plan.outputs.of(
                        losses[:, point, solved],
                        powers[point, solved],
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

    def _sets(self, own: Samples, mixed: bool) -> Iterator[tuple[slice, FloatArray]]:
        """The solved samples, and the values, of A, B and mixtures."""
        sets = [(0, own.a), (1, own.b)]
        for group in range(len(own.groups)) if mixed else ():
            solved = self.groups.index(group) + 2 if group in self.groups else 0
            sets.append((solved, own.mixed(group)))
        count = self.plan.count
        return ((slice(solved * count, (solved + 1) * count), drawn) for solved, drawn in sets)


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
    values = values_at(case, result, points)
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
        return found, np.concatenate([found.a, found.b, *map(found.mixed, groups)], axis=1)[inputs]

    samples, own = zip(*map(drawn, values), strict=True)
    plan = SamplePlan(
        without_table(case),
        outputs_of(case, result),
        inputs=tuple(first[number] for number in inputs),
        count=count,
        drawn=own,
        points=tuple(points),
    )
    return SampledCase(samples, groups, plan)


def nearby_at(
    case: Case,
    result: Result,  # Result of the case.
    points: Sequence[Point],  # What the operating points change.
    runner: Runner,
) -> tuple[Nearby, ...]:
    """Losses at operating points, at each with every input off by a standard deviation."""
    outputs = outputs_of(case, result)
    values = values_at(case, result, points)
    changes = [
        [{**point, **step} for step in ({}, *steps(own))]
        for point, own in zip(points, values, strict=True)
    ]
    every = tuple(it for own in changes for it in own)
    plan = SamplePlan(
        without_table(case), outputs, drawn=(np.empty((0, 1)),) * len(every), points=every
    )
    losses, powers = plan.found(runner.run(plan))
    found, first = [], 0
    for own, those in zip(values, changes, strict=True):
        stepped = losses[:, slice(first + 1, first + len(those)), 0].T
        found.append(nearby_of(own, outputs, losses[:, first, 0], powers[first], stepped))
        first += len(those)
    return tuple(found)


def values_at(
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
            f"has a distribution only at some operating points, and none at {dict(point)}.",
            "State it for all of them; use exact = true for an exact value.",
        )
        for key in sorted(frozenset.union(*keys) - everywhere)
        for point in [next(it for it, own in zip(points, keys, strict=True) if key not in own)]
    ]
    raise_any(problems, case.source)
    return found
