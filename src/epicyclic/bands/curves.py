"""Losses as curves of what is uncertain, fitted to samples: indices at no further solution."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.bands.sampling import Samples
from epicyclic.case.uncertain_values import UncertainValue

FloatArray = NDArray[np.float64]

ROUNDING = 1e-9
"""Standard deviation over the largest value below which a loss does not vary. [1]"""


@dataclass(frozen=True, slots=True)
class Curves:
    """Every loss as a product of one curve for each input and model. Theory (U9)."""

    dependent: NDArray[np.bool]  # Which of them depend on the load.
    values: tuple[UncertainValue, ...]
    slopes: FloatArray  # Slopes of the logarithm of each loss, over the columns of `_columns`.
    # Means of losses that do not vary, or are 0 in some samples; NaN for all others.
    means: FloatArray
    # Share of the variance of the total that the curves explain, less what they would by chance;
    # NaN with too few samples. [1]
    explained: float = math.nan

    def at(self, drawn: FloatArray) -> FloatArray:
        """Load-dependent, load-independent and total loss at some points, shape (3, n)."""
        losses = self._losses(drawn)
        parts = [losses[self.dependent].sum(axis=0), losses[~self.dependent].sum(axis=0)]
        return np.array([*parts, losses.sum(axis=0)])

    def sets(self, samples: Samples) -> FloatArray:
        """`at` A, B, and A with each group from B, shape (2 + g, 3, n)."""
        mixed = map(samples.mixed, range(len(samples.groups)))
        return np.array([self.at(drawn) for drawn in (samples.a, samples.b, *mixed)])

    def _losses(self, drawn: FloatArray) -> FloatArray:
        found = np.exp(_columns(self.values, drawn) @ self.slopes).T
        return np.where(np.isnan(self.means)[:, None], found, self.means[:, None])


def fit_curves(dependent: NDArray[np.bool], samples: Samples, losses: FloatArray) -> Curves:
    """Curves through losses, shape (t, 2 n), at the points A, then B; NaN where there is none.

    `dependent`, shape (t,), tells which depend on the load.
    """
    sound = np.isfinite(losses).all(axis=0)
    drawn = np.concatenate([samples.a, samples.b], axis=1)[:, sound]
    known = losses[:, sound]
    columns = _columns(samples.values, drawn)
    count, size = columns.shape
    if count <= size:
        return Curves(dependent, samples.values, np.zeros((size, len(losses))), losses.mean(axis=1))
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
