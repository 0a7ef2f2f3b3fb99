"""The regressions of Talbot (2012) as forms: his groups and products, coefficients to be fitted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact import CONDITIONS, LineContacts, contacts_at
from epicyclic.kernels.mixed_ehl import (
    BLEND_HALF_WIDTH,
    FRICTION_BOUNDARY_LIMIT,
    FRICTION_FULL_FILM_LIMIT,
    NEEDLE_RADIUS_REFERENCE,
    NEEDLE_ROUGHNESS_REFERENCE,
    ROLLING_LIMIT,
)

FloatArray = NDArray[np.float64]
Columns = Callable[[LineContacts], Sequence[FloatArray | float]]

SMALLEST_SLIP = 1e-4
"""Slide-to-roll ratio put into the logarithms. [1]"""
SMALLEST_SINGULAR = 1e-10
"""Singular value over the largest one below which columns count as dependent. [1]"""


@dataclass(frozen=True)
class Regression:
    """Branches in the film ratio, each the exponential of a sum, blended where they meet.

    Theory (O3).
    """

    name: str
    title: str
    branches: tuple[Columns, ...]  # From conditions to the columns of each branch.
    limits: tuple[float, ...]  # Film ratios at which branches meet.
    # From conditions to the unit of the quantity.
    scale: Callable[[LineContacts], FloatArray | float]

    @property
    def size(self) -> int:
        """Number of coefficients of all branches."""
        return sum(self._sizes())

    def value(self, states: LineContacts, coefficients: FloatArray) -> FloatArray:
        """See the class."""
        value: FloatArray = np.exp(self._matrix(states) @ coefficients) * self.scale(states)
        return value

    def fit(self, states: LineContacts, target: FloatArray, weight: FloatArray) -> FloatArray:
        """Linear least squares of the logarithm, all branches at once.

        Raises
        ------
        ValueError
            If a branch has fewer contacts than coefficients.
        """
        shares, sizes = self._weights(states), self._sizes()
        if any(np.count_nonzero(s) <= size for s, size in zip(shares, sizes, strict=True)):
            raise ValueError("too few contacts in a range of film ratios")
        matrix = np.sqrt(weight)[:, None] * self._matrix(states)
        size = np.sqrt((matrix**2).mean(axis=0))
        logarithm = np.sqrt(weight) * np.log(target / self.scale(states))
        found, *_ = np.linalg.lstsq(matrix / size, logarithm, rcond=SMALLEST_SINGULAR)
        coefficients: FloatArray = found / size
        return coefficients

    def _matrix(self, states: LineContacts) -> FloatArray:
        """Columns of all branches, each times the share of its branch, shape (n, size)."""
        shape = states.radius.shape
        columns = [
            share * column
            for branch, share in zip(self.branches, self._weights(states), strict=True)
            for column in branch(states)
        ]
        return np.stack([np.broadcast_to(column, shape) for column in columns], axis=1)

    def _sizes(self) -> list[int]:
        one = contacts_at(**dict.fromkeys(CONDITIONS, np.ones(1)), equivalent_modulus=1.0)
        return [len(columns(one)) for columns in self.branches]

    def _weights(self, states: LineContacts) -> list[FloatArray]:
        """Share of each branch, blended as (F4)."""
        above = [_blend(states.film_ratio, limit) for limit in self.limits]
        edges = [np.ones(states.film_ratio.shape), *above, np.zeros(states.film_ratio.shape)]
        return [low * (1 - high) for low, high in pairwise(edges)]


def _blend(ratio: FloatArray, limit: float) -> FloatArray:
    """Weight of the branch above `limit`. Theory (F4)."""
    t = np.clip((np.log(ratio / limit) + BLEND_HALF_WIDTH) / (2 * BLEND_HALF_WIDTH), 0, 1)
    weight: FloatArray = t * t * (3 - 2 * t)
    return weight


class RegressionGroups(NamedTuple):
    """Groups of the source, in its letters, shape (n,)."""

    s: FloatArray
    u: FloatArray
    g: Any
    p: FloatArray
    r: FloatArray
    s_co: FloatArray
    s_eq: FloatArray
    lam: FloatArray


@lru_cache(maxsize=2)  # friction and rolling of a mesh ask for the same ones
def regression_groups(states: LineContacts) -> RegressionGroups:
    """The groups of every contact."""
    flanks = states.flanks
    return RegressionGroups(
        s=states.slide_to_roll_ratio,
        u=states.speed_number,
        g=states.material_number,
        p=states.hertz_pressure / flanks.equivalent_modulus,
        r=states.radius / states.hertz_half_width,
        s_co=flanks.composite_roughness / states.radius,
        s_eq=flanks.reduced_roughness / states.radius,
        lam=states.film_ratio,
    )


def _groups(states: LineContacts) -> RegressionGroups:
    """The groups with a slip that has a logarithm."""
    groups = regression_groups(states)
    return groups._replace(s=np.maximum(groups.s, SMALLEST_SLIP))


def _friction_boundary(states: LineContacts) -> Sequence[FloatArray | float]:
    """Columns of Talbot (2012), Eq. 5.8a. Theory (F1)."""
    q = _groups(states)
    log_s, log_co = np.log(q.s), np.log(q.s_co)
    return (
        1.0, q.s * q.g, q.s * q.s_eq, q.lam * q.p, q.lam * q.g, q.r * q.g, q.r * q.s_co,
        q.r * log_s, log_co * log_s, q.lam * np.log(q.r), q.lam * log_co, np.log(q.u) * log_co,
    )  # fmt: skip


def _friction_mixed(states: LineContacts) -> Sequence[FloatArray | float]:
    """Columns of Eq. 5.8b. Theory (F2)."""
    q = _groups(states)
    log_s, log_r, log_co = np.log(q.s), np.log(q.r), np.log(q.s_co)
    return (
        1.0, q.r * q.s, q.r * q.g, q.r * q.u, q.g * log_s, np.log(q.u) * log_s, q.r * log_s,
        log_r * log_s, q.p * np.log(q.lam), q.g * np.log(q.p), q.r * log_co, log_r * log_co,
    )  # fmt: skip


def _friction_film(states: LineContacts) -> Sequence[FloatArray | float]:
    """Columns of Eq. 5.8c. Theory (F3)."""
    q = _groups(states)
    log_s, log_g, log_r = np.log(q.s), np.log(q.g), np.log(q.r)
    return (
        1.0, q.s * q.r, q.g * q.p, q.g * q.r, log_s, q.g * log_s, q.p * log_s, q.r * log_s,
        log_g, q.r * log_g, q.p * np.log(q.u), q.g * log_r, q.r * log_r,
    )  # fmt: skip


def _rolling_mixed(states: LineContacts) -> Sequence[FloatArray | float]:
    """Columns of Eq. 5.10a. Theory (R1)."""
    q = _groups(states)
    log_u, log_eq = np.log(q.u), np.log(q.s_eq)
    return (
        1.0, q.s * q.u, q.s * q.g, q.s_co * q.s_eq, q.r * np.log(q.lam), log_u,
        q.lam * np.log(q.g), np.log(q.r), q.lam * np.log(q.s_co), log_eq, log_u * log_eq,
    )  # fmt: skip


def _rolling_film(states: LineContacts) -> Sequence[FloatArray | float]:
    """Columns of Eq. 5.10b. Theory (R2)."""
    q = _groups(states)
    log_lam, log_u, log_g = np.log(q.lam), np.log(q.u), np.log(q.g)
    log_p, log_co = np.log(q.p), np.log(q.s_co)
    return (
        1.0, q.s * log_lam, q.u * log_lam, log_u, log_p * log_u, q.s * log_g,
        q.s_co * np.log(q.r), log_u * log_co, log_g * log_co, log_p * log_co,
        q.s * np.log(q.s_eq),
    )  # fmt: skip


def rolling_scale(states: LineContacts) -> FloatArray:
    """mu u_r^2: the power per length that turns the number of Eq. 5.10 into W/m. Theory (R4).

    A documented reconstruction. The source prints 1e5 W/m, with which the rolling loss exceeds the
    input power; mu u_r^2 is the only natural scale of the problem, reproduces the published
    totals, and agrees with smooth EHL solutions within about a factor of two.
    """
    scale: FloatArray = states.dynamic_viscosity * states.rolling_speed**2
    return scale


def _needle_film(states: LineContacts) -> Sequence[FloatArray | float]:
    """Columns of Eq. 3.5. Theory (B14)."""
    q = _groups(states)
    flow = states.rolling_speed * states.dynamic_viscosity
    theta = flow / (states.hertz_pressure * states.composite_roughness)
    rough = states.composite_roughness / NEEDLE_ROUGHNESS_REFERENCE
    log_theta, log_p = np.log(theta), np.log(q.p)
    log_u = np.log(flow / (states.flanks.equivalent_modulus * NEEDLE_ROUGHNESS_REFERENCE))
    return (
        1.0, q.g * theta, q.g * rough, theta * log_theta, log_theta**2, log_u * log_theta,
        rough * log_theta, log_u * np.log(q.g), q.p * np.log(q.g),
        np.log(states.radius / NEEDLE_RADIUS_REFERENCE) * log_p, np.log(rough) * log_p,
    )  # fmt: skip


FRICTION_REGRESSION = Regression(
    "regression", "form of Talbot (2012), Eq. 5.8",
    (_friction_boundary, _friction_mixed, _friction_film),
    (FRICTION_BOUNDARY_LIMIT, FRICTION_FULL_FILM_LIMIT), lambda _: 1.0,
)  # fmt: skip
ROLLING_REGRESSION = Regression(
    "regression", "form of Talbot (2012), Eq. 5.10", (_rolling_mixed, _rolling_film),
    (ROLLING_LIMIT,), rolling_scale,
)  # fmt: skip
NEEDLE_REGRESSION = Regression(
    "regression", "form of Talbot (2012), Eq. 3.5", (_needle_film,), (), lambda _: 1.0
)
