"""The regressions of Talbot (2012) as forms: his groups and products, coefficients to be fitted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from epicyclic.kernels.mixed_ehl import (
    BLEND_HALF_WIDTH,
    FRICTION_BOUNDARY_LIMIT,
    FRICTION_FULL_FILM_LIMIT,
    NEEDLE_RADIUS_REFERENCE,
    NEEDLE_ROUGHNESS_REFERENCE,
    ROLLING_LIMIT,
)
from epicyclic.oilmodel.states import ContactStates

__all__ = ["FRICTION_REGRESSION", "NEEDLE_REGRESSION", "ROLLING_REGRESSION", "Regression"]

FloatArray = NDArray[np.float64]
Columns = Callable[[ContactStates], Sequence[FloatArray | float]]

SMALLEST_SLIP = 1e-4
"""Slide-to-roll ratio put into the logarithms. [1]"""
SMALLEST_SINGULAR = 1e-10
"""Singular value over the largest one below which columns count as dependent. [1]"""


@dataclass(frozen=True)
class Regression:
    """Branches in the film ratio, each the exponential of a sum, blended where they meet.

    Theory (O3).

    Attributes
    ----------
    name, title : str
    branches : tuple of callable
        From conditions to the columns of each branch.
    limits : tuple of float
        Film ratios at which branches meet.
    scale : callable
        From conditions to the unit of the quantity.
    """

    name: str
    title: str
    branches: tuple[Columns, ...]
    limits: tuple[float, ...]
    scale: Callable[[ContactStates], FloatArray | float]

    @property
    def size(self) -> int:
        """Number of coefficients of all branches."""
        return sum(self._sizes())

    def value(self, states: ContactStates, coefficients: FloatArray) -> FloatArray:
        """See the class."""
        value: FloatArray = np.exp(self._matrix(states) @ coefficients) * self.scale(states)
        return value

    def fit(self, states: ContactStates, target: FloatArray, weight: FloatArray) -> FloatArray:
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

    def _matrix(self, states: ContactStates) -> FloatArray:
        """Columns of all branches, each times the share of its branch, shape (n, size)."""
        shape = states.radius.shape
        columns = [
            share * column
            for branch, share in zip(self.branches, self._weights(states), strict=True)
            for column in branch(states)
        ]
        return np.stack([np.broadcast_to(column, shape) for column in columns], axis=1)

    def _sizes(self) -> list[int]:
        one = np.ones(1)
        state = ContactStates(0.1 * one, one, 0.01 * one, 1e9 * one, 1e-7 * one, 1e-7 * one,
                              0.01 * one, 1e-8 * one, 2e11)  # fmt: skip
        return [len(columns(state)) for columns in self.branches]

    def _weights(self, states: ContactStates) -> list[FloatArray]:
        """Share of each branch, blended as (F4)."""
        above = [_blend(states.film_ratio, limit) for limit in self.limits]
        edges = [np.ones(states.film_ratio.shape), *above, np.zeros(states.film_ratio.shape)]
        return [low * (1 - high) for low, high in pairwise(edges)]


def _blend(ratio: FloatArray, limit: float) -> FloatArray:
    """Weight of the branch above `limit`. Theory (F4)."""
    t = np.clip((np.log(ratio / limit) + BLEND_HALF_WIDTH) / (2 * BLEND_HALF_WIDTH), 0, 1)
    weight: FloatArray = t * t * (3 - 2 * t)
    return weight


@dataclass(frozen=True)
class _Groups:
    """Groups of the source, in its letters."""

    s: FloatArray
    u: FloatArray
    g: FloatArray
    p: FloatArray
    r: FloatArray
    s_co: FloatArray
    s_eq: FloatArray
    lam: FloatArray


def _groups(states: ContactStates) -> _Groups:
    return _Groups(
        np.maximum(states.slide_to_roll_ratio, SMALLEST_SLIP), states.speed_number,
        states.material_number, states.pressure_number, states.radius_number,
        states.composite_roughness / states.radius, states.reduced_roughness / states.radius,
        states.film_ratio,
    )  # fmt: skip


def _friction_boundary(states: ContactStates) -> Sequence[FloatArray | float]:
    """Columns of Talbot (2012), Eq. 5.8a. Theory (F1)."""
    q = _groups(states)
    log_s, log_co = np.log(q.s), np.log(q.s_co)
    return (
        1.0, q.s * q.g, q.s * q.s_eq, q.lam * q.p, q.lam * q.g, q.r * q.g, q.r * q.s_co,
        q.r * log_s, log_co * log_s, q.lam * np.log(q.r), q.lam * log_co, np.log(q.u) * log_co,
    )  # fmt: skip


def _friction_mixed(states: ContactStates) -> Sequence[FloatArray | float]:
    """Columns of Eq. 5.8b. Theory (F2)."""
    q = _groups(states)
    log_s, log_r, log_co = np.log(q.s), np.log(q.r), np.log(q.s_co)
    return (
        1.0, q.r * q.s, q.r * q.g, q.r * q.u, q.g * log_s, np.log(q.u) * log_s, q.r * log_s,
        log_r * log_s, q.p * np.log(q.lam), q.g * np.log(q.p), q.r * log_co, log_r * log_co,
    )  # fmt: skip


def _friction_film(states: ContactStates) -> Sequence[FloatArray | float]:
    """Columns of Eq. 5.8c. Theory (F3)."""
    q = _groups(states)
    log_s, log_g, log_r = np.log(q.s), np.log(q.g), np.log(q.r)
    return (
        1.0, q.s * q.r, q.g * q.p, q.g * q.r, log_s, q.g * log_s, q.p * log_s, q.r * log_s,
        log_g, q.r * log_g, q.p * np.log(q.u), q.g * log_r, q.r * log_r,
    )  # fmt: skip


def _rolling_mixed(states: ContactStates) -> Sequence[FloatArray | float]:
    """Columns of Eq. 5.10a. Theory (R1)."""
    q = _groups(states)
    log_u, log_eq = np.log(q.u), np.log(q.s_eq)
    return (
        1.0, q.s * q.u, q.s * q.g, q.s_co * q.s_eq, q.r * np.log(q.lam), log_u,
        q.lam * np.log(q.g), np.log(q.r), q.lam * np.log(q.s_co), log_eq, log_u * log_eq,
    )  # fmt: skip


def _rolling_film(states: ContactStates) -> Sequence[FloatArray | float]:
    """Columns of Eq. 5.10b. Theory (R2)."""
    q = _groups(states)
    log_lam, log_u, log_g = np.log(q.lam), np.log(q.u), np.log(q.g)
    log_p, log_co = np.log(q.p), np.log(q.s_co)
    return (
        1.0, q.s * log_lam, q.u * log_lam, log_u, log_p * log_u, q.s * log_g,
        q.s_co * np.log(q.r), log_u * log_co, log_g * log_co, log_p * log_co,
        q.s * np.log(q.s_eq),
    )  # fmt: skip


def _power_scale(states: ContactStates) -> FloatArray:
    """mu u_r^2. Theory (R4). [W/m]"""
    scale: FloatArray = states.dynamic_viscosity * states.rolling_speed**2
    return scale


def _needle_film(states: ContactStates) -> Sequence[FloatArray | float]:
    """Columns of Eq. 3.5. Theory (B14)."""
    q = _groups(states)
    flow = states.rolling_speed * states.dynamic_viscosity
    theta = flow / (states.hertz_pressure * states.composite_roughness)
    rough = states.composite_roughness / NEEDLE_ROUGHNESS_REFERENCE
    log_theta, log_p = np.log(theta), np.log(q.p)
    log_u = np.log(flow / (states.equivalent_modulus * NEEDLE_ROUGHNESS_REFERENCE))
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
    (ROLLING_LIMIT,), _power_scale,
)  # fmt: skip
NEEDLE_REGRESSION = Regression(
    "regression", "form of Talbot (2012), Eq. 3.5", (_needle_film,), (), lambda _: 1.0
)
