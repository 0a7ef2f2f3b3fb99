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

__all__ = ["Estimate", "Plan", "aided_mean", "next_plan"]

FloatArray = NDArray[np.float64]

GROWTH = (1.15, 1.5)
"""Least and largest growth of the number of blocks between looks at the error: each look may end on
a lucky one, and an early one tells little of how many it takes. [1]"""
MOST_AID = 32
"""Blocks on the coarse grid for each on the fine one at most. [1]"""


class Estimate(NamedTuple):
    """A mean, and where its error comes from. Theory (H34), (H35).

    Attributes
    ----------
    value : float
    own, aid : float
        Variances over a block of what the coarse grid does not explain, and of what it does.
    blocks, aid_blocks : int
        Numbers of blocks on the fine and on the coarse grid.
    """

    value: float
    own: float
    aid: float
    blocks: int
    aid_blocks: int

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


def aided_mean(fine: FloatArray, coarse: FloatArray) -> Estimate:
    """Mean of `fine`, from its blocks and the longer series of the coarse grid.

    Theory (H34), (H35).

    Parameters
    ----------
    fine : ndarray, shape (n,)
        Means over blocks.
    coarse : ndarray, shape (m,)
        Of the same blocks, and of those that follow; none if m < n.

    Examples
    --------
    >>> import numpy as np
    >>> fine, coarse = np.array([1.0, 3.0, 2.0]), np.array([1.5, 3.5, 2.5, 4.5, 4.5])
    >>> round(aided_mean(fine, coarse).value, 6)
    2.8
    """
    count, aid_count = fine.size, coarse.size
    value = float(fine.mean())
    same = coarse[:count] - coarse[:count].mean() if aid_count >= count else np.zeros(count)
    power = float(same @ same)
    if not (power > 0 and np.isfinite(coarse).all()):
        return Estimate(value, _variance(fine, 1), 0.0, count, 0)
    slope = float(fine @ same) / power
    value += slope * float(coarse.mean() - coarse[:count].mean())
    own = _variance(fine - slope * same, 2)
    return Estimate(value, own, slope**2 * _variance(coarse, 1), count, aid_count)


def _variance(blocks: FloatArray, fitted: int) -> float:
    """Of a block, with what it shares with the next: a ridge crosses the contact in two blocks.

    `fitted` numbers were found from the blocks.
    """
    rest = blocks - blocks.mean()
    following = max(0.0, float(rest[1:] @ rest[:-1]))
    return (float(rest @ rest) + 2 * following) / max(1, blocks.size - fitted)


def next_plan(estimate: Estimate, tolerance: float, cost: float, most: int) -> Plan:
    """How many blocks to have before the next look at the error. Theory (H36).

    Parameters
    ----------
    estimate : Estimate
        Of what has been simulated.
    tolerance : float
        Wanted error over the mean.
    cost : float
        Of a block on the coarse grid, over that of one on the fine grid. [1]
    most : int
        Blocks on the fine grid.
    """
    share = 1.0
    if estimate.aid > 0:
        best = math.sqrt(estimate.aid * (1 + cost) / (cost * max(estimate.own, 1e-300)))
        share = min(max(best, 1.0), MOST_AID)
    wanted = (tolerance * estimate.value) ** 2
    variance = estimate.own + estimate.aid / share
    needed = math.inf if wanted == 0 else variance / wanted
    low, high = (factor * estimate.blocks for factor in GROWTH)
    blocks = min(most, math.ceil(min(max(needed, low), high)))
    aided = math.ceil(share * blocks) if estimate.aid > 0 else 0
    return Plan(blocks, max(aided, estimate.aid_blocks))
