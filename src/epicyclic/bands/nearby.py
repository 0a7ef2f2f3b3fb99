"""A band from a few solutions: every input one standard deviation up and down."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.solve import solve
from epicyclic.bands.distributions import correlations
from epicyclic.bands.outputs import Outputs, factors_of, outputs_of
from epicyclic.case.case import Case
from epicyclic.case.uncertain_values import UncertainValue, uncertain_values
from epicyclic.errors import EpicyclicError, InputError
from epicyclic.results.result import Result

__all__ = [
    "Band",
    "Nearby",
    "known_values",
    "look_nearby",
    "nearby_of",
    "quick_band",
    "steps",
    "without_table",
]

FloatArray = NDArray[np.float64]

DRAWN = 4096
"""Points at which the quadratic curves of the inputs are put together."""
SEED = 1
TAIL = 0.025
"""Probability of values below, and above, the band. [1]"""
HALF_WIDTH = math.sqrt(3.0)
"""Half the width of a uniform distribution over its standard deviation. [1]"""


@dataclass(frozen=True, slots=True)
class Nearby:
    """Losses where one input is off by a standard deviation.

    Attributes
    ----------
    values : tuple of UncertainValue
    outputs : Outputs
    losses : ndarray of float, shape (t,)
        At the values of the case. [W]
    input_power : float
        [W]
    ends : ndarray of float, shape (d, 2, t)
        One standard deviation below and above the middle of each input; NaN where there is no
        result. [W]
    """

    values: tuple[UncertainValue, ...]
    outputs: Outputs
    losses: FloatArray
    input_power: float
    ends: FloatArray

    @property
    def active(self) -> tuple[bool, ...]:
        """Which values change any loss."""
        moved = np.abs(self.ends - self.losses).max(axis=(1, 2), initial=0.0)
        return tuple(
            value.is_model_form or change != 0.0
            for value, change in zip(self.values, moved, strict=True)
        )


@dataclass(frozen=True, slots=True)
class Band:
    """95 % of what a result may be, and what makes most of it.

    Attributes
    ----------
    low, high : mapping of str to float
        By result, `Outputs.names`, but for those that some draws do not have.
    drivers : tuple of (str, float)
        Keys of uncertain values with their shares of the variance of the total loss, the largest
        first.
    """

    low: dict[str, float]
    high: dict[str, float]
    drivers: tuple[tuple[str, float], ...]


def known_values(case: Case, result: Result) -> tuple[UncertainValue, ...]:
    """All that is uncertain in a case whose table [uncertainty] is sound."""
    kinds = tuple(dict.fromkeys(outputs_of(result).kinds))
    values, problems = uncertain_values(case, kinds)
    if problems:
        raise InputError(problems, case.source)
    return values


def without_table(case: Case) -> Case:
    """A case that is solved with given values, whatever its table [uncertainty] says of them."""
    return case.updated({"uncertainty": None}) if case.uncertainty else case


def look_nearby(case: Case, result: Result, solved: Callable[[Case], Result] = solve) -> Nearby:
    """Solve a case with each of its uncertain inputs changed."""
    values, outputs = known_values(case, result), outputs_of(result)
    plain = without_table(case)
    stepped = [_losses(plain, changes, outputs, solved) for changes in steps(values)]
    losses = np.array([result.losses[name] for name in outputs.losses])
    return nearby_of(values, outputs, losses, result.input_power, np.array(stepped))


def steps(values: Sequence[UncertainValue]) -> list[dict[str, Any]]:
    """What to change in a case: each input one standard deviation down, then up."""
    return [
        {value.key: value.stated(_at(value, end))}
        for value in values
        if not value.is_model_form
        for end in (-1.0, 1.0)
    ]


def nearby_of(
    values: tuple[UncertainValue, ...],
    outputs: Outputs,
    losses: FloatArray,
    input_power: float,
    stepped: FloatArray,
) -> Nearby:
    """What the losses of all `steps`, shape (2 d, t), say; models leave them as they are."""
    inputs = np.array([not value.is_model_form for value in values], dtype=bool)
    ends = np.tile(losses, (len(values), 2, 1))
    ends[inputs] = stepped.reshape(-1, 2, losses.size)
    return Nearby(values, outputs, losses, input_power, ends)


def _losses(
    case: Case, changes: Mapping[str, Any], outputs: Outputs, solved: Callable[[Case], Result]
) -> FloatArray:
    try:
        result = solved(case.updated(changes))
    except EpicyclicError:
        return np.full(len(outputs.losses), np.nan)
    return np.array([result.losses[name] for name in outputs.losses])


def _at(value: UncertainValue, deviations: float) -> float:
    """A value some standard deviations from the middle of its distribution."""
    if value.kind == "normal":
        found = value.value + deviations * value.spread[0]
    elif value.kind == "lognormal":
        found = value.value * value.spread[0] ** deviations
    else:
        low, high = value.spread
        found = (low + high) / 2 + deviations * (high - low) / 2 / HALF_WIDTH
    return min(max(found, value.low), value.high)


def quick_band(nearby: Nearby) -> Band:
    """The band from parabolas through three points of every input. Theory (U8)."""
    values, outputs = nearby.values, nearby.outputs
    rng = np.random.default_rng(SEED)
    drawn = _correlated(values, np.array([_drawn(value, rng) for value in values]))
    shifts = np.array([_parabola(nearby, number, row) for number, row in enumerate(drawn)])
    factors = factors_of(values, np.array([
        value.spread[0] ** row if value.is_model_form else row
        for value, row in zip(values, drawn, strict=True)
    ]))  # fmt: skip
    losses = np.maximum(nearby.losses[:, None] + shifts.sum(axis=0), 0.0)
    power = np.full(DRAWN, nearby.input_power)
    whole = outputs.of(losses, power, factors)
    ends = {
        name: np.quantile(row, [TAIL, 1 - TAIL]).tolist()
        for name, row in zip(outputs.names, whole, strict=True)
        if np.isfinite(row).all()
    }
    return Band(
        {name: low for name, (low, _) in ends.items()},
        {name: high for name, (_, high) in ends.items()},
        _drivers(nearby, shifts, factors),
    )


def _drawn(value: UncertainValue, rng: np.random.Generator) -> FloatArray:
    """Standard deviations from the middle."""
    if value.kind == "uniform":
        return rng.uniform(-HALF_WIDTH, HALF_WIDTH, DRAWN)
    return rng.standard_normal(DRAWN)


def _correlated(values: Sequence[UncertainValue], drawn: FloatArray) -> FloatArray:
    """Independent deviations turned into correlated ones, through normal ones."""
    from scipy import stats

    if not any(value.correlated for value in values):
        return drawn
    level = np.array([value.kind == "uniform" for value in values])
    scores = drawn.copy()
    scores[level] = stats.norm.ppf((drawn[level] / HALF_WIDTH + 1) / 2)
    scores = np.linalg.cholesky(correlations(values)) @ scores
    scores[level] = HALF_WIDTH * (2 * stats.norm.cdf(scores[level]) - 1)
    return scores


def _parabola(nearby: Nearby, number: int, deviations: FloatArray) -> FloatArray:
    """Changes of the losses, shape (t, n), of an input off by some standard deviations."""
    below, above = nearby.ends[number]
    value = nearby.values[number]
    # where the value of the case is not the middle of its distribution, a straight line serves
    middle = nearby.losses if value.kind != "uniform" else (below + above) / 2
    slope, bend = (above - below) / 2, (above + below) / 2 - middle
    found = (middle - nearby.losses)[:, None] + slope[:, None] * deviations
    found += bend[:, None] * deviations**2
    return np.where(np.isfinite(found), found, 0.0)


def _drivers(
    nearby: Nearby, shifts: FloatArray, factors: dict[str, FloatArray]
) -> tuple[tuple[str, float], ...]:
    """Shares of the variance of the total loss, each value alone."""
    kinds = np.array(nearby.outputs.kinds)
    variances = {}
    for value, shift in zip(nearby.values, shifts, strict=True):
        kind = value.key.partition(".")[2]
        if value.is_model_form:
            own = nearby.losses[kinds == kind].sum() * factors[kind]
        else:
            own = shift.sum(axis=0)
        variances[value.key] = float(own.var())
    whole = sum(variances.values())
    shares = {key: variance / whole for key, variance in variances.items()} if whole else {}
    return tuple(sorted(shares.items(), key=lambda item: -item[1]))
