"""What a least-squares solution says about its parameters, the model taken as linear there."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

SINGULAR = 1e-7
"""Ratio of singular values of the derivatives below which parameters cannot be told apart. [1]"""


@dataclass(frozen=True, eq=False)
class Linearised:
    """A solution with its derivatives."""

    solution: FloatArray
    deviations: FloatArray  # Computed less measured, over the uncertainty if `weighted`.
    derivatives: FloatArray  # Derivatives of the deviations.
    at_bound: NDArray[np.bool_]  # Parameters that cannot move freely; they have no interval.
    weighted: bool
    confidence: float  # [1]

    @property
    def sum_of_squares(self) -> float:
        """Sum of the squared deviations."""
        return float(self.deviations @ self.deviations)

    @property
    def freedom(self) -> int:
        """Degrees of freedom."""
        return self.deviations.size - self.solution.size

    @cached_property
    def is_idle(self) -> NDArray[np.bool_]:
        """Parameters that change nothing at the solution."""
        lengths = np.linalg.norm(self.derivatives, axis=0)
        idle: NDArray[np.bool_] = ~self.at_bound & (lengths <= SINGULAR * lengths.max())
        return idle

    @cached_property
    def free(self) -> NDArray[np.intp]:
        """Parameters that have an interval, unless they cannot be told apart."""
        return np.flatnonzero(~self.at_bound & ~self.is_idle)

    @cached_property
    def covariance(self) -> FloatArray:
        """Inverse of J'J of the free parameters; NaN if they cannot be told apart."""
        derivatives = self.derivatives[:, self.free]
        size = derivatives.shape[1]
        if size == 0:
            return np.zeros((0, 0))
        lengths = np.linalg.norm(derivatives, axis=0)
        _, singular, directions = np.linalg.svd(derivatives / lengths, full_matrices=False)
        if singular[-1] < SINGULAR * singular[0]:
            return np.full((size, size), np.nan)
        scaled = directions.T / singular / lengths[:, None]
        inverse: FloatArray = scaled @ scaled.T
        return inverse

    @property
    def is_separable(self) -> bool:
        """True if the free parameters can be told apart."""
        return not np.isnan(self.covariance).any()

    @property
    def spread(self) -> float:
        """Standard deviation of the deviations. Theory (X5).

        With uncertainties it is 1, or what the scatter shows if that is more (R. T. Birge, Phys.
        Rev. 40 (1932) 207); without them the scatter.
        """
        if self.freedom == 0:
            return 1.0 if self.weighted else math.nan
        scatter = math.sqrt(self.sum_of_squares / self.freedom)
        return max(1.0, scatter) if self.weighted else scatter

    @cached_property
    def quantile(self) -> float:
        """Half the interval over the standard error: of the normal distribution with uncertainties,
        of Student's without."""
        from scipy import stats

        tail = (1 + self.confidence) / 2
        if self.weighted:
            return float(stats.norm.ppf(tail))
        return float(stats.t.ppf(tail, self.freedom)) if self.freedom > 0 else math.nan

    def standard_errors(self) -> FloatArray:
        """Standard errors of all parameters, shape (p,); NaN where there is none."""
        errors = np.full(self.solution.size, np.nan)
        errors[self.free] = np.sqrt(np.diag(self.covariance)) * self.spread
        return errors

    def correlation(self) -> FloatArray:
        """Correlation of all parameters, shape (p, p); NaN where there is none."""
        size = self.solution.size
        table = np.full((size, size), np.nan)
        deviation = np.sqrt(np.diag(self.covariance))
        table[np.ix_(self.free, self.free)] = self.covariance / np.outer(deviation, deviation)
        return table

    def ends(self, parameter: int) -> tuple[FloatArray, FloatArray]:
        """The solutions at both ends of the interval of a free `parameter`, the others following.

        There the sum of squares of a linear model has grown by (quantile spread)^2.
        """
        place = int(np.flatnonzero(self.free == parameter)[0])
        column = self.covariance[:, place]
        step = np.zeros(self.solution.size)
        step[self.free] = self.quantile * self.spread * column / math.sqrt(column[place])
        return self.solution - step, self.solution + step
