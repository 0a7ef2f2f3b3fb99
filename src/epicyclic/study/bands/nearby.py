"""Results that have a band, and their change with each uncertain input."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.case.tables.uncertainty import MODEL_FORM, UncertainValue
from epicyclic.errors import EpicyclicError, raise_any
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.machine.element import LOAD_DEPENDENT
from epicyclic.result.result import Result
from epicyclic.study.bands.inputs import model_form_of, uncertain_values
from epicyclic.study.solve import flows_around, solve, without_torque
from epicyclic.study.sweeps.run import AS_TESTED

# From losses and factors of models to the results that have a band.


FloatArray = NDArray[np.float64]

SUMS = ("load_dependent", "load_independent", "total", "efficiency")
"""Results beside the single losses."""
UNLOADED = "unloaded."  # Before the name of a loss without torque.
INPUT_POWER = "input_power"


@dataclass(frozen=True, slots=True)
class Outputs:
    """How results follow from the losses of one case."""

    losses: tuple[str, ...]  # Names of those that are included.
    load_dependent: NDArray[np.bool]  # Which of them depend on the load.
    kinds: tuple[str, ...]  # Kind of each, see `model_form_of`.
    # True if they are grouped as a test rig does: what torque adds, and the rest.
    tested: bool = False

    @property
    def numbers(self) -> tuple[str, ...]:
        """What they follow from: losses, where they are grouped as tested also those unloaded."""
        unloaded = (f"{UNLOADED}{name}" for name in self.losses if self.tested)
        return (*self.losses, *unloaded)

    @property
    def names(self) -> tuple[str, ...]:
        """Losses, their sums, efficiency."""
        return (*self.losses, *SUMS)

    def of(
        self,
        losses: FloatArray,  # In the order of `numbers`. [W]
        input_power: FloatArray,  # [W]
        factors: Mapping[str, FloatArray],  # By kind; 1 for others. [1]
    ) -> FloatArray:
        """Results with the losses of each kind times the factor of its model. Theory (U7).

        In the order of `names`; efficiency NaN without power.
        """
        kinds = self.kinds * (2 if self.tested else 1)
        every = np.array(
            [row * factors.get(kind, 1.0) for row, kind in zip(losses, kinds, strict=True)]
        )
        scaled, unloaded = every[: len(self.losses)], every[len(self.losses) :]
        independent = (unloaded if self.tested else scaled[~self.load_dependent]).sum(axis=0)
        total = scaled.sum(axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            efficiency = np.where(total < input_power, 1 - total / input_power, np.nan)
        return np.vstack([scaled, total - independent, independent, total, efficiency])


def outputs_of(case: Case, result: Result) -> Outputs:
    """The results of a case, from one of it."""
    terms = [term for term in result.terms if not term.left_out]
    return Outputs(
        tuple(term.name for term in terms),
        np.array([term.group == LOAD_DEPENDENT for term in terms]),
        tuple(model_form_of(term.name, term.method) for term in terms),
        case.models.load_dependent == AS_TESTED,
    )


def loss_numbers(
    case: Case, outputs: Outputs, flow_tables: FlowTables | None = None
) -> dict[str, float]:
    """`Outputs.numbers` of a case, and its input power. [W]"""
    plain = case.updated({"models.load_dependent": "computed"}) if outputs.tested else case
    result = solve(plain, flow_tables=flow_tables)
    found = {**result.losses, INPUT_POWER: result.input_power}
    if outputs.tested:
        unloaded = solve(without_torque(plain), flow_tables=flow_tables).losses
        found |= {f"{UNLOADED}{name}": watts for name, watts in unloaded.items()}
    return found


def factors_of(values: Sequence[UncertainValue], points: FloatArray) -> dict[str, FloatArray]:
    """Factors of the models at some points of all `values`, by kind."""
    return {
        value.key.removeprefix(MODEL_FORM): row
        for value, row in zip(values, points, strict=True)
        if value.is_model_form
    }


# Losses where each uncertain input is one standard deviation up and down.

HALF_WIDTH = math.sqrt(3.0)
"""Half the width of a uniform distribution over its standard deviation. [1]"""

SAME_FLOW = 0.005
"""Difference of the number of a flow through pockets below which its scaled figures stay, relative:
that of 10 K. [1]"""


@dataclass(frozen=True, slots=True)
class Nearby:
    """Losses where one input is off by a standard deviation."""

    values: tuple[UncertainValue, ...]
    outputs: Outputs
    losses: FloatArray  # `Outputs.numbers`, at the values of the case. [W]
    input_power: float  # [W]
    # One standard deviation below and above the middle of each input; NaN where there is no result.
    # [W]
    ends: FloatArray

    @property
    def nominal(self) -> FloatArray:
        """Results at the values of the case, in the order of `Outputs.names`."""
        return self.outputs.of(self.losses[:, None], np.array([self.input_power]), {})[:, 0]

    @property
    def active(self) -> tuple[bool, ...]:
        """Which values change any loss."""
        moved = np.abs(self.ends - self.losses).max(axis=(1, 2), initial=0.0)
        return tuple(
            value.is_model_form or change != 0.0
            for value, change in zip(self.values, moved, strict=True)
        )


def known_values(case: Case, result: Result) -> tuple[UncertainValue, ...]:
    """All that is uncertain in a case whose table [uncertainty] is sound."""
    kinds = tuple(dict.fromkeys(outputs_of(case, result).kinds))
    values, problems = uncertain_values(case, kinds)
    raise_any(problems, case.source)
    return values


def without_table(case: Case) -> Case:
    """A case that is solved with given values, whatever its table [uncertainty] says of them."""
    return case.updated({"uncertainty": None}) if case.uncertainty else case


def look_nearby(case: Case, result: Result) -> Nearby:
    """Solve a case with each of its uncertain inputs changed."""
    values, outputs = known_values(case, result), outputs_of(case, result)
    plain = without_table(case)
    flows = flows_around(plain, SAME_FLOW)
    losses = np.array([result.losses[name] for name in outputs.losses])
    if outputs.tested:
        losses = _losses(plain, {}, outputs, flows)
    stepped = [
        losses if _without_effect(plain, changes) else _losses(plain, changes, outputs, flows)
        for changes in steps(values)
    ]
    return nearby_of(values, outputs, losses, result.input_power, np.array(stepped))


def steps(values: Sequence[UncertainValue]) -> list[dict[str, Any]]:
    """What to change in a case: each input one standard deviation down, then up."""
    return [
        {value.key: value.stated(_at(value, end))}
        for value in values
        if not value.is_model_form
        for end in (-1.0, 1.0)
    ]


def nearby_of(
    values: tuple[UncertainValue, ...],
    outputs: Outputs,
    losses: FloatArray,
    input_power: float,
    stepped: FloatArray,
) -> Nearby:
    """What the losses of all `steps`, shape (2 d, t), say; models leave them as they are."""
    inputs = np.array([not value.is_model_form for value in values], dtype=bool)
    ends = np.tile(losses, (len(values), 2, 1))
    ends[inputs] = stepped.reshape(-1, 2, losses.size)
    return Nearby(values, outputs, losses, input_power, ends)


def _without_effect(case: Case, changes: Mapping[str, Any]) -> bool:
    """Where all oil has the temperature of its inlet, no loss sees how heat goes."""
    return case.models.temperatures == "inlet" and all(
        key.startswith("thermal.") for key in changes
    )


def _losses(
    case: Case, changes: Mapping[str, Any], outputs: Outputs, flows: FlowTables
) -> FloatArray:
    try:
        found = loss_numbers(case.updated(changes) if changes else case, outputs, flows)
    except EpicyclicError:
        return np.full(len(outputs.numbers), np.nan)
    return np.array([found[name] for name in outputs.numbers])


def _at(value: UncertainValue, deviations: float) -> float:
    """A value some standard deviations from the middle of its distribution."""
    if value.kind == "normal":
        found = value.value + deviations * value.spread[0]
    elif value.kind == "lognormal":
        found = value.value * value.spread[0] ** deviations
    else:
        low, high = value.spread
        found = (low + high) / 2 + deviations * (high - low) / 2 / HALF_WIDTH
    return min(max(found, value.low), value.high)
