"""Distributions of uncertain values, cut off where a case has no such values."""

from __future__ import annotations

import math
from statistics import NormalDist
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.uncertain_values import UncertainValue

if TYPE_CHECKING:
    from collections.abc import Sequence

FloatArray = NDArray[np.float64]


def _frozen(value: UncertainValue) -> Any:
    """The distribution as scipy has it, not cut off."""
    from scipy import stats

    if value.kind == "normal":
        return stats.norm(value.value, value.spread[0])
    if value.kind == "lognormal":
        return stats.lognorm(math.log(value.spread[0]), scale=value.value)
    low, high = value.spread
    return stats.uniform(low, high - low)


def quantiles(value: UncertainValue, probabilities: FloatArray) -> FloatArray:
    """Values that are undercut with some probabilities. Theory (U1)."""
    whole = _frozen(value)
    low, high = whole.cdf(value.low), whole.cdf(value.high)
    found: FloatArray = whole.ppf(low + probabilities * (high - low))
    return np.clip(found, value.low, value.high)


def cut_off(value: UncertainValue) -> float:
    """Probability of values that a case cannot have: negative clearances. [1]"""
    return _below(value, value.low) + 1 - _below(value, value.high)


def _below(value: UncertainValue, limit: float) -> float:
    """Probability of values under a limit; without scipy, whose import takes half a second."""
    if value.kind == "uniform":
        low, high = value.spread
        return min(max((limit - low) / (high - low), 0.0), 1.0)
    if value.kind == "normal":
        return NormalDist(value.value, value.spread[0]).cdf(limit)
    if limit <= 0:
        return 0.0
    return NormalDist(0.0, math.log(value.spread[0])).cdf(math.log(limit / value.value))


def standard_uncertainty(value: UncertainValue) -> float:
    """Standard deviation of the distribution, in the unit of the value."""
    if value.kind == "normal":
        return value.spread[0]
    if value.kind == "uniform":
        return (value.spread[1] - value.spread[0]) / math.sqrt(12)
    variance = math.log(value.spread[0]) ** 2
    return value.value * math.sqrt(math.expm1(variance) * math.exp(variance))


def correlations(values: Sequence[UncertainValue]) -> FloatArray:
    """Matrix of the stated coefficients of correlation.

    Raises
    ------
    LinAlgError
        If no distribution of several values has them all.
    """
    place = {value.key: index for index, value in enumerate(values)}
    matrix = np.eye(len(values))
    for value in values:
        for other, coefficient in value.correlated.items():
            if other in place:
                one, two = place[value.key], place[other]
                matrix[one, two] = matrix[two, one] = coefficient
    np.linalg.cholesky(matrix)
    return matrix
