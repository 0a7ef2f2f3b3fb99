"""Means over time of a rough contact, aided by the same contact on a coarse grid.

Which ridges happen to meet makes most of the scatter of a rough contact, and a coarse grid sees the
same ridges at a tenth of the cost. So a short simulation tells how the fine grid differs from the
coarse one, and a long one on the coarse grid alone averages over the roughness: a regression
estimator, as in multilevel Monte Carlo methods. The mean is that of the fine grid whatever the
coarse one is worth; only the error depends on it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

GROWTH = 1.5
"""Largest growth of the number of fine blocks between looks at the error: an early look tells
little of how many it takes. [1]"""
SOME_MORE = 1.05
"""Growth of both numbers where the error is hardly larger than wanted. [1]"""
LAGS = 2
"""Blocks that follow one another and are alike: a ridge stays for that long. [1]"""
RUN, FEWEST_RUNS = 8, 16
"""Blocks of a run, which shares little with the next, and runs from which a variance is found."""
STUDENT = 0.6
"""Student's t at one standard error is 1 + 0.6/nu of the normal one with nu degrees of freedom,
within 2 % from two of them on. [1]"""
ROUNDING = 1e-20
"""Variation over the sum of squares of a coarse series that is nothing but rounding. [1]"""
MOST_AID = 32
"""Blocks on the coarse grid for each on the fine one at most. [1]"""


class Estimate(NamedTuple):
    """A mean, and where its error comes from. Theory (H34), (H35)."""

    value: float
    # Variances over a block of what the coarse grid does not explain, widened for a small sample,
    # and of what it does.
    own: float
    aid: float
    blocks: int  # Numbers of blocks on the fine and on the coarse grid.
    aid_blocks: int  # Numbers of blocks on the fine and on the coarse grid.

    @property
    def error(self) -> float:
        """Standard error of the mean."""
        explained = self.aid / self.aid_blocks if self.aid_blocks else 0.0
        return math.sqrt(self.own / self.blocks + explained)

    def within(self, tolerance: float) -> bool:
        """The error is at most `tolerance` times the mean."""
        return self.error <= tolerance * self.value


class Plan(NamedTuple):
    """Numbers of blocks on the fine and on the coarse grid."""

    blocks: int
    aid_blocks: int


def aided_mean(
    fine: FloatArray,  # Means over blocks.
    # Means of the same blocks on the coarse grid, and of those that follow; none if m < n.
    coarse: FloatArray,
) -> Estimate:
    """Mean of `fine`, from its blocks and the longer series of the coarse grid.

    Theory (H34), (H35).

    Examples
    --------
    >>> import numpy as np
    >>> fine, coarse = np.array([1.0, 3.0, 2.0]), np.array([1.5, 3.5, 2.5, 4.5, 4.5])
    >>> round(aided_mean(fine, coarse).value, 6)
    2.8
    """
    count, aid_count = fine.size, coarse.size
    if not np.isfinite(fine).all():
        return Estimate(math.nan, math.nan, 0.0, count, 0)
    value, same, power, steady = float(fine.mean()), np.zeros(count), 0.0, True
    if aid_count >= count and np.isfinite(coarse).all():
        same = coarse[:count] - coarse[:count].mean()
        power = float(same @ same)
        steady = power <= ROUNDING * float(coarse @ coarse)
    if steady:
        return Estimate(value, _variance(fine, 1) * _widening(count - 1), 0.0, count, 0)
    slope = float(fine @ same) / power
    away = float(coarse.mean() - coarse[:count].mean())
    value += slope * away
    by_slope = 1 + count * away**2 / power
    own = _variance(fine - slope * same, 2) * _widening(count - 2) * by_slope
    return Estimate(value, own, slope**2 * _variance(coarse, 1), count, aid_count)


def _variance(blocks: FloatArray, fitted: int) -> float:
    """Variance of a block, with what it shares with the next: a ridge crosses the contact in four.

    `fitted` numbers were found from the blocks. Many of them tell what neighbours share also where
    it is less than nothing, which a few would only seem to tell.
    """
    if blocks.size < FEWEST_RUNS * RUN:
        rest = blocks - blocks.mean()
        shared = sum(max(0.0, float(rest[lag:] @ rest[:-lag])) for lag in range(1, LAGS + 1))
        return (float(rest @ rest) + 2 * shared) / max(1, blocks.size - fitted)
    runs: FloatArray = blocks[blocks.size % RUN :].reshape(-1, RUN).mean(axis=1)
    rest = runs - runs.mean()
    own, next_ = float(rest @ rest), float(rest[1:] @ rest[:-1])
    return RUN * (own + 2 * max(next_, -own / 8)) / (runs.size - fitted)


def _widening(freedom: int) -> float:
    """Factor on the variance of a mean, because the scatter is known from a few blocks only.

    Neighbours are alike: two blocks tell of it as much as one.
    """
    return (1 + STUDENT / max(freedom / 2, 1)) ** 2


def next_plan(
    estimate: Estimate,  # Estimate of what has been simulated.
    tolerance: float,  # Wanted error over the mean.
    cost: float,  # Cost of a block on the coarse grid, over that of one on the fine grid. [1]
    most: int,  # Blocks on the fine grid.
) -> Plan:
    """How many blocks to have before the next look at the error. Theory (H36).

    Examples
    --------
    >>> next_plan(Estimate(1.0, own=0.01, aid=0.04, blocks=8, aid_blocks=8), 0.05, 0.1, 64)
    Plan(blocks=8, aid_blocks=32)
    """
    _, own, aid, blocks, aid_blocks = estimate
    wanted = (tolerance * estimate.value) ** 2
    if wanted == 0:
        return Plan(min(most, math.ceil(GROWTH * blocks)), aid_blocks)
    cheapest = math.sqrt(own) * (math.sqrt(own) + math.sqrt(cost * aid)) / wanted
    more = min(most, math.ceil(min(max(cheapest, blocks), GROWTH * blocks)))
    if aid == 0:
        return Plan(more, 0)
    left = wanted - own / more
    if blocks == most and left <= 0:  # no series on the coarse grid is long enough
        return Plan(blocks, aid_blocks)
    # towards numbers not reached yet both grow in the cheapest proportion
    needed = more * math.sqrt(aid / (cost * own)) if more < cheapest else aid / left
    highest = MOST_AID * more
    aided = math.ceil(min(max(needed, more, aid_blocks), highest))
    if more == blocks and aided == aid_blocks:  # the scatter of a small sample stands in the way
        longer, aided = (math.ceil(SOME_MORE * number) for number in (blocks, aid_blocks))
        return Plan(min(most, longer), min(aided, highest))
    return Plan(more, aided)
