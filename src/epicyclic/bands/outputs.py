"""From losses and factors of models to the results that have a band."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.uncertain_values import MODEL_FORM, UncertainValue, model_form_of
from epicyclic.elements.base import LOAD_DEPENDENT
from epicyclic.results.result import Result

__all__ = ["SUMS", "Outputs", "outputs_of"]

FloatArray = NDArray[np.float64]

SUMS = ("load_dependent", "load_independent", "total", "efficiency")
"""Results beside the single losses."""


@dataclass(frozen=True, slots=True)
class Outputs:
    """How results follow from the losses of one case.

    Attributes
    ----------
    losses : tuple of str
        Names of those that are included.
    load_dependent : ndarray of bool, shape (t,)
        Which of them depend on the load.
    kinds : tuple of str
        Kind of each, see `model_form_of`.
    """

    losses: tuple[str, ...]
    load_dependent: NDArray[np.bool]
    kinds: tuple[str, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Losses, their sums, efficiency."""
        return (*self.losses, *SUMS)

    def of(
        self, losses: FloatArray, input_power: FloatArray, factors: Mapping[str, FloatArray]
    ) -> FloatArray:
        """Results with the losses of each kind times the factor of its model. Theory (U7).

        Parameters
        ----------
        losses : ndarray of float, shape (t, n)
            [W]
        input_power : ndarray of float, shape (n,)
            [W]
        factors : mapping of str to ndarray of float, shape (n,)
            By kind; 1 for others. [1]

        Returns
        -------
        ndarray of float, shape (t + 4, n)
            In the order of `names`; efficiency NaN without power.
        """
        scaled = np.array(
            [row * factors.get(kind, 1.0) for row, kind in zip(losses, self.kinds, strict=True)]
        )
        dependent = scaled[self.load_dependent].sum(axis=0)
        independent = scaled[~self.load_dependent].sum(axis=0)
        total = dependent + independent
        with np.errstate(divide="ignore", invalid="ignore"):
            efficiency = np.where(total < input_power, 1 - total / input_power, np.nan)
        return np.vstack([scaled, dependent, independent, total, efficiency])


def outputs_of(result: Result) -> Outputs:
    """The results of a case, from one of it."""
    terms = [term for term in result.terms if not term.left_out]
    return Outputs(
        tuple(term.name for term in terms),
        np.array([term.group == LOAD_DEPENDENT for term in terms]),
        tuple(model_form_of(term.name, term.method) for term in terms),
    )


def factors_of(values: Sequence[UncertainValue], points: FloatArray) -> dict[str, FloatArray]:
    """Factors of the models at some points of all `values`, by kind."""
    return {
        value.key.removeprefix(MODEL_FORM): row
        for value, row in zip(values, points, strict=True)
        if value.is_model_form
    }
