"""What samples of a result say about it: uncertainty, intervals, and what drives them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

COVERAGE = 0.95
"""Share of the values within an interval. [1]"""
COVERAGE_FACTOR = 2.0
"""k of the expanded uncertainty U = k u_c; JCGM 100:2008, 6.3.3. [1]"""
RESAMPLES = 200
"""Resamples for the confidence intervals of indices."""


@dataclass(frozen=True, slots=True)
class Summary:
    """A result as a distribution."""

    mean: float  # The last for k = 2.
    standard_uncertainty: float  # The last for k = 2.
    expanded_uncertainty: float  # The last for k = 2.
    low: float  # Ends of the probabilistically symmetric interval.
    high: float  # Ends of the probabilistically symmetric interval.
    shortest_low: float  # Ends of the shortest one.
    shortest_high: float  # Ends of the shortest one.


def summary(samples: FloatArray) -> Summary:
    """Mean, uncertainty and intervals of samples. Theory (U3), (U4).

    Examples
    --------
    >>> import numpy as np
    >>> round(summary(np.arange(1000.0)).low, 3)
    24.025
    """
    spread = float(samples.std(ddof=1))
    tail = (1 - COVERAGE) / 2
    # of one more sample, 95 % are expected between them
    low, high = np.quantile(samples, [tail, 1 - tail], method="weibull")
    shortest = shortest_interval(samples)
    return Summary(
        float(samples.mean()), spread, COVERAGE_FACTOR * spread, float(low), float(high), *shortest
    )


def shortest_interval(samples: FloatArray) -> tuple[float, float]:
    """The shortest interval that holds a share of the samples; JCGM 101:2008, 7.7. Theory (U4)."""
    ordered = np.sort(samples)
    inside = min(ordered.size - 1, math.ceil(COVERAGE * ordered.size))
    widths = ordered[inside:] - ordered[: ordered.size - inside]
    first = int(widths.argmin())
    return float(ordered[first]), float(ordered[first + inside])


@dataclass(frozen=True, slots=True)
class Indices:
    """Shares of the variance of results, of each group of inputs."""

    first: FloatArray  # Shares for `s` results: alone, and with all interactions.
    total: FloatArray  # Shares for `s` results: alone, and with all interactions.
    first_ends: FloatArray  # Ends of their 95 % intervals.
    total_ends: FloatArray  # Ends of their 95 % intervals.


def sobol_indices(
    a: FloatArray,  # Results at the points of A and of B.
    b: FloatArray,  # Results at the points of A and of B.
    mixed: FloatArray,  # At those of A with a group from B.
    seed: int,  # Seed of the resampling of points that the intervals are found by.
) -> Indices:
    """First and total indices with their intervals. Theory (U5), (U6)."""
    count = a.shape[1]
    found = index_values(a, b, mixed)
    rng = np.random.default_rng(seed)
    drawn = (rng.integers(count, size=count) for _ in range(RESAMPLES))
    others = [index_values(a[:, it], b[:, it], mixed[:, :, it]) for it in drawn]
    tail = (1 - COVERAGE) / 2
    first, total = (
        np.quantile([one[part] for one in others], [tail, 1 - tail], axis=0) for part in (0, 1)
    )
    return Indices(*found, first, total)


def index_values(a: FloatArray, b: FloatArray, mixed: FloatArray) -> tuple[FloatArray, FloatArray]:
    """First and total indices, shape (s, g), after Saltelli and Jansen, by scipy."""
    from scipy import stats

    found = stats.sobol_indices(func={"f_A": a, "f_B": b, "f_AB": mixed}, n=a.shape[1])
    shape = (a.shape[0], mixed.shape[0])
    return found.first_order.reshape(shape), found.total_order.reshape(shape)
