"""A band from a few solutions: parabolas through three points of every input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.heat import takes_minutes
from epicyclic.bands.advice import model_remarks
from epicyclic.bands.distributions import correlations
from epicyclic.bands.nearby import HALF_WIDTH, Nearby, look_nearby
from epicyclic.bands.outputs import factors_of
from epicyclic.bands.study import (
    about_inputs,
    about_study,
    banded_variables,
    contributions,
    summaries,
)
from epicyclic.case.case import Case
from epicyclic.case.uncertain_values import UncertainValue
from epicyclic.results.result import Result

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Band", "quick_band", "quick_dataset"]

FloatArray = NDArray[np.float64]

DRAWN = 4096
"""Points at which the parabolas of the inputs are put together."""
KEPT = 1024
"""Of these, how many a dataset keeps."""
SEED = 1


@dataclass(frozen=True)
class Band:
    """What a result may be, drawn from parabolas, and what makes most of it.

    Attributes
    ----------
    nearby : Nearby
    results : ndarray of float, shape (s, n)
        Draws, in the order of `Outputs.names`.
    parts : ndarray of float, shape (d, n)
        What each uncertain value alone adds to the total loss in these draws. [W]
    """

    nearby: Nearby
    results: FloatArray
    parts: FloatArray

    @cached_property
    def drivers(self) -> tuple[tuple[str, float], ...]:
        """Keys of uncertain values with their shares of the variance, the largest first."""
        variances = self.parts.var(axis=1)
        whole = variances.sum() or 1.0
        keys = (value.key for value in self.nearby.values)
        shares = zip(keys, (variances / whole).tolist(), strict=True)
        return tuple(sorted(shares, key=lambda item: -item[1]))


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
    return Band(nearby, outputs.of(losses, power, factors), _parts(nearby, shifts, factors))


def quick_dataset(case: Case, result: Result, *, brief: bool = False) -> xr.Dataset | None:
    """The band with the budget of the total loss, as `uncertainty` has them but without samples.

    None if a solution takes minutes, or nothing is uncertain. For `brief` see `model_remarks`.
    """
    import xarray as xr

    nearby = None if takes_minutes(result) else look_nearby(case, result)
    if nearby is None or not any(nearby.active):
        return None
    band, outputs, values = quick_band(nearby), nearby.outputs, nearby.values
    remarks = model_remarks(case, result, brief=brief)
    nominal = outputs.of(nearby.losses[:, None], np.array([nearby.input_power]), {})[:, 0]
    known = [np.isfinite(row).all() for row in band.results]
    found = summaries(np.where(np.array(known)[:, None], band.results, np.nan))
    shares = dict(band.drivers)
    keys = [value.key for value in values]
    lost = [it.key for it, ends in zip(values, nearby.ends, strict=True) if np.isnan(ends).any()]
    variables = banded_variables(nominal, found, contributions(nearby), band.results[:, :KEPT])
    first_order = np.array([[shares[key] for key in keys]])
    about_shares = {"long_name": "share of the variance alone", "units": "1"}
    variables["first_order"] = (("sum", "driver"), first_order, about_shares)
    coords = {
        "result": list(outputs.names),
        "unit": ("result", ["1" if name == "efficiency" else "W" for name in outputs.names]),
        "input": keys,
        "driver": keys,
        "sum": ["total"],
    }
    about = about_study(case, outputs, DRAWN, SEED)
    about |= {"left_out": ", ".join(lost), "remarks": "\n".join(remarks)}
    return xr.Dataset({**variables, **about_inputs(values)}, coords, about)


def _drawn(value: UncertainValue, rng: np.random.Generator) -> FloatArray:
    """Standard deviations from the middle."""
    if value.kind == "uniform":
        return rng.uniform(-HALF_WIDTH, HALF_WIDTH, DRAWN)
    return rng.standard_normal(DRAWN)


def _correlated(values: Sequence[UncertainValue], drawn: FloatArray) -> FloatArray:
    """Independent deviations turned into correlated ones, through normal ones."""
    if not any(value.correlated for value in values):
        return drawn
    from scipy import stats

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


def _parts(nearby: Nearby, shifts: FloatArray, factors: dict[str, FloatArray]) -> FloatArray:
    """What each value alone adds to the total loss, shape (d, n)."""
    kinds = np.array(nearby.outputs.kinds)
    losses = nearby.losses[: kinds.size]
    return np.array(
        [
            losses[kinds == value.kind_of_loss].sum() * (factors[value.kind_of_loss] - 1)
            if value.is_model_form
            else shift[: kinds.size].sum(axis=0)
            for value, shift in zip(nearby.values, shifts, strict=True)
        ]
    )
