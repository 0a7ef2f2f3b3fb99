"""Samples of uncertain values: scrambled Sobol points, two sets of them and their mixtures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.bands.distributions import correlations, quantiles
from epicyclic.case.uncertain_values import UncertainValue

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Samples:
    """Values of all inputs in two independent sets of points, A and B, and their mixtures."""

    values: tuple[UncertainValue, ...]
    # Numbers of the values that are correlated with each other: they vary together.
    groups: tuple[tuple[int, ...], ...]
    a: FloatArray  # In the units of the values.
    b: FloatArray  # In the units of the values.

    def mixed(self, group: int) -> FloatArray:
        """Points of A with the values of one group from B, shape (d, n)."""
        found = self.a.copy()
        rows = list(self.groups[group])
        found[rows] = self.b[rows]
        return found


def groups_of(values: Sequence[UncertainValue]) -> tuple[tuple[int, ...], ...]:
    """Numbers of values that are correlated with each other, the others alone."""
    place = {value.key: index for index, value in enumerate(values)}
    owner = {index: {index} for index in place.values()}
    for value in values:
        for other in value.correlated:
            if other in place:
                both = owner[place[value.key]] | owner[place[other]]
                owner |= dict.fromkeys(both, both)
    return tuple(dict.fromkeys(tuple(sorted(group)) for group in owner.values()))


def make_samples(
    values: Sequence[UncertainValue],
    count: int,  # Number of points in each set.
    seed: int,  # Seed of the scrambling: equal ones give equal points.
) -> Samples:
    """Two sets of `count` points, a power of 2. Theory (U1), (U2)."""
    drawn = _sobol(2 * len(values), count, seed)
    one, two = (
        np.array(
            [
                quantiles(value, row)
                for value, row in zip(values, _correlated(half, values), strict=True)
            ]
        )
        for half in (drawn[: len(values)], drawn[len(values) :])
    )
    return Samples(tuple(values), groups_of(values), one, two)


def probabilities(values: Sequence[UncertainValue], count: int, seed: int) -> FloatArray:
    """Probabilities of `count` points of all values, shape (d, count), correlated as stated."""
    return _correlated(_sobol(len(values), count, seed), values)


def _sobol(size: int, count: int, seed: int) -> FloatArray:
    from scipy import stats

    points = stats.qmc.Sobol(size, rng=np.random.default_rng(seed), bits=64)
    drawn: FloatArray = points.random(count).T
    return drawn


def _correlated(probabilities: FloatArray, values: Sequence[UncertainValue]) -> FloatArray:
    """Independent probabilities turned into correlated ones, through normal ones."""
    from scipy import stats

    if not any(value.correlated for value in values):
        return probabilities
    lower = np.linalg.cholesky(correlations(values))
    found: FloatArray = stats.norm.cdf(lower @ stats.norm.ppf(probabilities))
    return found
