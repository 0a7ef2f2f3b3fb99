"""A band from a few solutions: parabolas through three points of every input."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.result.result import Result
from epicyclic.study.bands.advice import Known, model_remarks
from epicyclic.study.bands.inputs import remedy_for
from epicyclic.study.bands.nearby import HALF_WIDTH, Nearby, factors_of, look_nearby
from epicyclic.study.bands.samples import correlations
from epicyclic.study.bands.study import (
    about_inputs,
    about_study,
    banded_variables,
    contributions,
    summaries,
)
from epicyclic.study.heat import takes_minutes

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]

DRAWN = 4096  # Points at which the parabolas of the inputs are put together.
KEPT = 1024  # How many of these a dataset keeps.
SEED = 1


@dataclass(frozen=True)
class Band:
    """What a result may be, drawn from parabolas, and what makes most of it."""

    nearby: Nearby
    results: FloatArray  # Draws, in the order of `Outputs.names`.
    parts: FloatArray  # What each uncertain value alone adds to the total loss in these draws. [W]

    @cached_property
    def drivers(self) -> tuple[tuple[str, float], ...]:
        """Keys of uncertain values with their shares of the variance, the largest first."""
        variances = self.parts.var(axis=1)
        whole = variances.sum() or 1.0
        keys = (value.key for value in self.nearby.values)
        shares = zip(keys, (variances / whole).tolist(), strict=True)
        return tuple(sorted(shares, key=lambda item: -item[1]))

    @cached_property
    def summaries(self) -> dict[str, FloatArray]:
        """The fields of `Summary` of each result; NaN where a draw has none."""
        known = np.isfinite(self.results).all(axis=1, keepdims=True)
        return summaries(np.where(known, self.results, np.nan))


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


def quick_known(case: Case, result: Result, *, brief: bool = False) -> Known | None:
    """What `quick_dataset` says of the total, without a dataset.

    None if a solution takes minutes, or nothing is uncertain. For `brief` see `model_remarks`.
    """
    band = _band(case, result)
    if band is None:
        return None
    outputs = band.nearby.outputs
    found = band.summaries
    ends = zip(found["low"].tolist(), found["high"].tolist(), strict=True)
    remedies = {value.key: remedy_for(value.key) for value in band.nearby.values}
    return Known(
        unit="W",
        nominal=dict(zip(outputs.names, band.nearby.nominal.tolist(), strict=True)),
        ends=dict(zip(outputs.names, ends, strict=True)),
        draws=dict(zip(outputs.names, band.results[:, :KEPT], strict=True)),
        shares=dict(band.drivers),
        names={key: name for key, (name, _) in remedies.items()},
        advice={key: advice for key, (_, advice) in remedies.items()},
        remarks=tuple(model_remarks(case, result, brief=brief)),
    )


def quick_dataset(case: Case, result: Result) -> xr.Dataset | None:
    """The band with the budget of the total loss, as `uncertainty` has them but without samples.

    None if a solution takes minutes, or nothing is uncertain.
    """
    import xarray as xr

    band = _band(case, result)
    if band is None:
        return None
    nearby, outputs, values = band.nearby, band.nearby.outputs, band.nearby.values
    shares = dict(band.drivers)
    keys = [value.key for value in values]
    lost = [it.key for it, ends in zip(values, nearby.ends, strict=True) if np.isnan(ends).any()]
    variables = banded_variables(
        nearby.nominal, band.summaries, contributions(nearby), band.results[:, :KEPT]
    )
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
    remarks = "\n".join(model_remarks(case, result))
    about = about_study(case, outputs, DRAWN, SEED) | {"left_out": ", ".join(lost)}
    about["remarks"] = remarks
    return xr.Dataset({**variables, **about_inputs(values)}, coords, about)


def _band(case: Case, result: Result) -> Band | None:
    nearby = None if takes_minutes(result) else look_nearby(case, result)
    return None if nearby is None or not any(nearby.active) else quick_band(nearby)


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
