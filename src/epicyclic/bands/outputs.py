"""From losses and factors of models to the results that have a band."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.solve import solve, without_torque
from epicyclic.case.case import Case
from epicyclic.case.uncertain_values import MODEL_FORM, UncertainValue, model_form_of
from epicyclic.elements.base import LOAD_DEPENDENT
from epicyclic.pocketing.table import FlowTables
from epicyclic.results.result import Result
from epicyclic.sweeps.unloaded import AS_TESTED

FloatArray = NDArray[np.float64]

SUMS = ("load_dependent", "load_independent", "total", "efficiency")
"""Results beside the single losses."""
UNLOADED = "unloaded."
"""Before the name of a loss without torque."""
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

        Returns
        -------
        ndarray of float, shape (s, n)
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
