"""Samples of uncertain values and the statistics of what they give."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import NormalDist
from typing import Any

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.dataclass import dataclass
from epicyclic.errors import one_problem

# Distributions of uncertain values, cut off where a case has no such values.


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

    Raises `LinAlgError` if no distribution of several values has them all.
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


# Samples of uncertain values: scrambled Sobol points, two sets of them and their mixtures.


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

    if not size:
        raise one_problem("uncertainty", "", "leaves nothing uncertain.", "Run the case as it is.")
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


# What samples of a result say about it: uncertainty, intervals, and what drives them.

COVERAGE = 0.95  # Share of the values within an interval. [1]
COVERAGE_FACTOR = 2.0  # k of the expanded uncertainty U = k u_c; JCGM 100:2008, 6.3.3. [1]
RESAMPLES = 200  # Resamples for the confidence intervals of indices.


@dataclass(frozen=True, slots=True)
class Summary:
    """A result as a distribution."""

    mean: float
    standard_uncertainty: float
    expanded_uncertainty: float  # For k = 2.
    low: float  # Ends of the probabilistically symmetric interval.
    high: float  # Ends of the probabilistically symmetric interval.
    shortest_low: float  # Ends of the shortest one.
    shortest_high: float  # Ends of the shortest one.


def sample_summary(samples: FloatArray) -> Summary:
    """Mean, uncertainty and intervals of samples. Theory (U3), (U4).

    Examples
    --------
    >>> round(sample_summary(np.arange(1000.0)).low, 3)
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
    first = int((ordered[inside:] - ordered[: ordered.size - inside]).argmin())
    return float(ordered[first]), float(ordered[first + inside])


def sobol_indices(
    a: FloatArray,  # Results at the points of A and of B.
    b: FloatArray,  # Results at the points of A and of B.
    mixed: FloatArray,  # At those of A with a group from B.
    seed: int,  # Seed of the resampling of points that the intervals are found by.
) -> tuple[FloatArray, FloatArray]:
    """First and total indices, each with both ends of its interval. Theory (U5), (U6).

    Returns two ndarray, shape (3, s, g), of `s` results and `g` groups of inputs.
    """
    count = a.shape[1]
    found = index_values(a, b, mixed)
    rng = np.random.default_rng(seed)
    drawn = (rng.integers(count, size=count) for _ in range(RESAMPLES))
    others = [index_values(a[:, it], b[:, it], mixed[:, :, it]) for it in drawn]
    tail = (1 - COVERAGE) / 2
    first, total = (
        np.stack([found[i], *np.quantile([one[i] for one in others], [tail, 1 - tail], axis=0)])
        for i in (0, 1)
    )
    return first, total


def index_values(a: FloatArray, b: FloatArray, mixed: FloatArray) -> tuple[FloatArray, FloatArray]:
    """First and total indices, shape (s, g), after Saltelli and Jansen, by scipy; NaN of NaN."""
    from scipy import stats

    found = stats.sobol_indices(func={"f_A": a, "f_B": b, "f_AB": mixed}, n=a.shape[1])
    shape = (a.shape[0], mixed.shape[0])
    known = np.where(np.isnan(a).any(axis=1), np.nan, 1.0)[:, None]  # scipy makes 0 of NaN
    return known * found.first_order.reshape(shape), known * found.total_order.reshape(shape)


# Losses as curves of what is uncertain, fitted to samples: indices at no further solution.

ROUNDING = 1e-9  # Standard deviation over the largest value below which a loss does not vary. [1]


@dataclass(frozen=True, slots=True)
class Curves:
    """Every loss as a product of one curve for each input and model. Theory (U9)."""

    dependent: BoolArray  # Which of them depend on the load.
    values: tuple[UncertainValue, ...]
    slopes: FloatArray  # Slopes of the logarithm of each loss, over the columns of `_columns`.
    # Means of losses that do not vary, or are 0 in some samples; NaN for all others.
    means: FloatArray
    # Share of the variance of the total that the curves explain, less what they would by chance;
    # NaN with too few samples. [1]
    explained: float = math.nan

    def at(self, drawn: FloatArray) -> FloatArray:
        """Load-dependent, load-independent and total loss at some points, shape (3, n)."""
        found = np.exp(_columns(self.values, drawn) @ self.slopes).T
        losses = np.where(np.isnan(self.means)[:, None], found, self.means[:, None])
        parts = [losses[self.dependent].sum(axis=0), losses[~self.dependent].sum(axis=0)]
        return np.array([*parts, losses.sum(axis=0)])

    def sets(self, samples: Samples) -> FloatArray:
        """`at` A, B, and A with each group from B, shape (2 + g, 3, n)."""
        mixed = map(samples.mixed, range(len(samples.groups)))
        return np.array([self.at(drawn) for drawn in (samples.a, samples.b, *mixed)])


def fit_curves(dependent: BoolArray, samples: Samples, losses: FloatArray) -> Curves:
    """Curves through losses, shape (t, 2 n), at the points A, then B; NaN where there is none.

    `dependent`, shape (t,), tells which depend on the load.
    """
    sound = np.isfinite(losses).all(axis=0)
    drawn = np.concatenate([samples.a, samples.b], axis=1)[:, sound]
    known = losses[:, sound]
    columns = _columns(samples.values, drawn)
    count, size = columns.shape
    if count <= size:
        nothing = np.full((size, len(losses)), np.nan)
        return Curves(dependent, samples.values, nothing, nothing[0])
    varies = (known > 0).all(axis=1) & (known.std(axis=1) > ROUNDING * known.max(axis=1))
    slopes = np.zeros((size, len(losses)))
    slopes[:, varies], *_ = np.linalg.lstsq(columns, np.log(known[varies]).T)
    means = np.where(varies, np.nan, known.mean(axis=1))
    found = Curves(dependent, samples.values, slopes, means)
    total = known.sum(axis=0)
    variance = float(total.var(ddof=1))
    left = float(((total - found.at(drawn)[-1]) ** 2).sum()) / (count - size)
    explained = 1 - left / variance if variance > (ROUNDING * total.max()) ** 2 else 1.0
    return Curves(dependent, samples.values, slopes, means, explained)


def _columns(values: Sequence[UncertainValue], drawn: FloatArray) -> FloatArray:
    """1, deviations of all values, and their squares, but for models; shape (n, c)."""
    deviations = [_deviations(it, row) for it, row in zip(values, drawn, strict=True)]
    squares = [row**2 for it, row in zip(values, deviations, strict=True) if not it.is_model_form]
    return np.array([np.ones(drawn.shape[1]), *deviations, *squares]).T


def _deviations(value: UncertainValue, drawn: FloatArray) -> FloatArray:
    """Deviations from the value in standard uncertainties, or parts of the width."""
    if value.kind == "lognormal":
        return np.log(drawn / value.value) / math.log(value.spread[0])
    width = value.spread[0] if value.kind == "normal" else value.spread[1] - value.spread[0]
    return (drawn - value.value) / width
