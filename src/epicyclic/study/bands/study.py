"""The distribution of a result, from samples or from a few solutions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.case.case import Case
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.dataclass import astuple, dataclass, fields
from epicyclic.errors import ConvergenceError
from epicyclic.result.result import Result, origin
from epicyclic.study.bands.advice import Known, model_remarks
from epicyclic.study.bands.inputs import remedy_for
from epicyclic.study.bands.plan import (
    FEWEST,
    HALF_WIDTH,
    OF_SHAFT_POWER,
    SUMS,
    Nearby,
    Outputs,
    SampledCase,
    SamplePlan,
    at_deviations,
    check_samples,
    factors_of,
    look_nearby,
    sampled_case,
)
from epicyclic.study.bands.samples import (
    COVERAGE,
    Samples,
    Summary,
    correlations,
    cut_off,
    sample_summary,
    sobol_indices,
    standard_uncertainty,
)
from epicyclic.study.heat import takes_minutes
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.runner import Rows

if TYPE_CHECKING:
    import xarray as xr


SAMPLES = 256  # Points in each of the two sets.
UNIT_OF_RESULT = "see unit"  # Unit of what is stated for all results, which have different ones.
LABELS = {
    "mean": "mean",
    "standard_uncertainty": "combined standard uncertainty u_c",
    "expanded_uncertainty": "expanded uncertainty, k = 2",
    "low": "low end of the symmetric 95 % interval",
    "high": "high end of the symmetric 95 % interval",
    "shortest_low": "low end of the shortest 95 % interval",
    "shortest_high": "high end of the shortest 95 % interval",
}
"""What the fields of `Summary` are called."""
assert [one.name for one in fields(Summary)] == list(LABELS)


@dataclass(frozen=True, slots=True)
class Study(ABC):
    """The samples of what is uncertain in a case, to be solved, and what then follows."""

    case: Case
    sampled: SampledCase
    seed: int

    @property
    def plan(self) -> SamplePlan:
        """The points to be solved."""
        return self.sampled.plan

    @abstractmethod
    def dataset(self, rows: Rows) -> xr.Dataset:
        """What the solved points say; see `uncertainty`."""


@dataclass(frozen=True, slots=True)
class CaseStudy(Study):
    """Points of A, of B, and of A with each group of inputs that change losses from B."""

    nearby: Nearby

    def dataset(self, rows: Rows) -> xr.Dataset:
        """What the solved points say; see `uncertainty`."""
        nearby, outputs = self.nearby, self.nearby.outputs
        sets = self.sampled.results(rows)[0]
        data = sample_variables(sets[:2], nearby.nominal, contributions(nearby), self.sampled, rows)
        # efficiency has the shares of the total loss; those of single losses follow from samples
        sums = sets[:, -len(SUMS) : -1]
        data = data.assign(
            indices_of(sums, self.sampled.groups, self.sampled.samples[0], self.seed)
        )
        about = about_study(self.case, outputs, self.plan.count, self.seed, data.attrs["failed"])
        remarks = model_remarks(self.case, solve(self.case))
        return data.assign_attrs(about | {"remarks": "\n".join(remarks)})


def uncertainty_study(case: Case, samples: int | None = None, seed: int = 1) -> CaseStudy:
    """What has to be solved for the uncertainty of a case; see `uncertainty`."""
    samples = SAMPLES if samples is None else samples
    check_samples(samples, seed)
    result = solve(case)
    nearby = look_nearby(case, result)
    sampled = sampled_case(case, result, samples, seed, active=nearby.active)
    return CaseStudy(case, sampled, seed, nearby)


def sample_variables(
    sets: FloatArray,
    nominal: FloatArray,  # Without uncertainty.
    change: FloatArray,  # For one standard deviation of each input.
    sampled: SampledCase,
    rows: Rows,  # Rows of all samples.
    unit: str = "W",  # Unit of all results but the efficiency.
) -> xr.Dataset:
    """What the results of the samples A and B say."""
    import xarray as xr

    (samples, *_), names = sampled.samples, sampled.plan.outputs.names
    both = np.concatenate([sets[0], sets[1]], axis=1)
    status, message = sampled.ends(rows)
    sound = _sound(both[-2], message)
    variables: dict[str, Any] = {
        **banded_variables(nominal, summaries(both[:, sound]), change, both),
        **about_inputs(samples.values),
        "drawn": (
            ("input", "sample"),
            np.concatenate([samples.a, samples.b], axis=1),
            {"long_name": "value of the input", "units": "see input_unit"},
        ),
        "status": ("sample", np.array(status, dtype=object)),
        "message": ("sample", np.array(message, dtype=object)),
    }
    coords = {
        "result": list(names),
        "unit": ("result", ["1" if name == "efficiency" else unit for name in names]),
        "input": [value.key for value in samples.values],
        "driver": drivers_of(samples),
    }
    return xr.Dataset(variables, coords, {"failed": int((~sound).sum())})


def banded_variables(
    nominal: FloatArray, found: Mapping[str, FloatArray], change: FloatArray, value: FloatArray
) -> dict[str, Any]:
    """What every uncertainty states, however it was found: in the unit of each result."""
    columns: dict[str, tuple[Any, FloatArray, str]] = {
        "nominal": ("result", nominal, "result of the case"),
        **{name: ("result", column, LABELS[name]) for name, column in found.items()},
        "contribution": (
            ("input", "result"),
            change,
            "change for one standard deviation of the input",
        ),
        "value": (("result", "sample"), value, "result of the sample"),
    }
    return {
        name: (dims, values, {"long_name": label, "units": UNIT_OF_RESULT})
        for name, (dims, values, label) in columns.items()
    }


def drivers_of(samples: Samples) -> list[str]:
    """Names of the inputs, of those that are correlated together."""
    return [" + ".join(samples.values[i].key for i in group) for group in samples.groups]


def about_study(
    case: Case, outputs: Outputs, samples: int, seed: int, failed: int = 0
) -> dict[str, Any]:
    """The attributes of every study."""
    return {
        "title": case.title,
        **origin(case),
        "samples": samples,
        "seed": seed,
        "grouping": ", as tested" if outputs.tested else "",
        "coverage": COVERAGE,
        "failed": failed,
        "left_out": "",
        "remarks": "",
    }


def _sound(total: FloatArray, messages: Sequence[str]) -> BoolArray:
    """Which samples have a result; raises `ConvergenceError` if hardly any has."""
    sound = np.isfinite(total)
    if sound.sum() < FEWEST:
        reason = next((text for text in messages if text), "")
        raise ConvergenceError(f"{(~sound).sum()} of {sound.size} samples have no result: {reason}")
    return sound


def summaries(samples: FloatArray) -> dict[str, FloatArray]:
    """The fields of `Summary` of several results, shape (s, n), each of those that are known."""
    rows = []
    for row in samples:
        known = row[np.isfinite(row)]
        rows.append(astuple(sample_summary(known)) if known.size > 1 else (np.nan,) * len(LABELS))
    return dict(zip(LABELS, np.array(rows).T, strict=True))


def contributions(nearby: Nearby) -> FloatArray:
    """Half the change from one standard deviation below to one above, of every result."""
    outputs, values = nearby.outputs, nearby.values
    found = []
    for value, ends in zip(values, nearby.ends, strict=True):
        factor = np.array([1 / value.spread[0], value.spread[0]])
        factors = factors_of([value], factor[None]) if value.is_model_form else {}
        below, above = outputs.of(ends.T, nearby.powers, factors).T
        found.append((above - below) / 2)
    return np.array(found)


def indices_of(
    sets: FloatArray,  # These losses at A, B, and A with each group from B.
    # Numbers of the groups of inputs that change losses, beyond factors of models.
    groups: Sequence[int],
    samples: Samples,
    seed: int,
) -> dict[str, Any]:
    """Sobol indices of load-dependent, load-independent and total loss."""
    factors = [
        number
        for number, group in enumerate(samples.groups)
        if any(samples.values[i].is_model_form for i in group)
    ]
    moving = sorted({*groups, *factors})
    sound = np.isfinite(sets[:, -1]).all(axis=0)
    # scipy takes powers of 2 only: sound points stand in for those without a result
    kept = sets[:, :, np.resize(np.flatnonzero(sound), sound.size)]
    first, total = sobol_indices(kept[0], kept[1], kept[2:][moving], seed)
    variables: dict[str, Any] = {"sum": list(SUMS[:-1])}
    for name, label, found in (
        ("first_order", "share of the variance alone", first),
        ("total_order", "share with interactions", total),
    ):
        labels = (label, "low end of its interval", "high end of its interval")
        for end, text, part in zip(("", "_low", "_high"), labels, found, strict=True):
            whole = np.zeros((sets.shape[1], len(samples.groups)))
            whole[:, moving] = part
            about = {"long_name": text, "units": "1"}
            variables[f"{name}{end}"] = (("sum", "driver"), whole, about)
    return variables


def about_inputs(values: Sequence[UncertainValue]) -> dict[str, Any]:
    """What is known of each input."""
    remedies = [remedy_for(value.key) for value in values]
    columns: dict[str, tuple[list[Any], str]] = {
        "input_value": ([value.value for value in values], "value of the input"),
        "input_unit": ([value.unit or "1" for value in values], "unit of the input"),
        "distribution": ([value.text for value in values], "distribution of the input"),
        "distribution_source": (
            [f"{value.source}{value.remark and f'; {value.remark}'}" for value in values],
            "source of the distribution",
        ),
        "input_uncertainty": (
            [standard_uncertainty(value) for value in values],
            "standard uncertainty of the input",
        ),
        "input_name": ([name for name, _ in remedies], "name of the input"),
        "input_advice": ([advice for _, advice in remedies], "how to reduce its uncertainty"),
        "cut_off": ([cut_off(value) for value in values], "probability of impossible values"),
    }
    return {
        name: ("input", np.array(column), {"long_name": label, "units": "see input_unit"})
        for name, (column, label) in columns.items()
    }


# A band from a few solutions: parabolas through three points of every input.


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
    points = np.array([at_deviations(value, row) for value, row in zip(values, drawn, strict=True)])
    factors = factors_of(values, points)
    losses = np.maximum(nearby.losses[:, None] + shifts.sum(axis=0), 0.0)
    shaft = nearby.powers.shaft
    for value, row in zip(values, points, strict=True):
        if value.key in OF_SHAFT_POWER and value.value:
            shaft = shaft * row / value.value
    results = outputs.of(losses, nearby.powers, factors, shaft)
    return Band(nearby, results, _parts(nearby, shifts, factors))


def quick_known(case: Case, result: Result) -> Known | None:
    """What `quick_dataset` says of the total, without a dataset.

    None if a solution takes minutes, or nothing is uncertain; without remarks that take long.
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
        remarks=tuple(model_remarks(case, result, brief=True)),
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
    about = about_study(case, outputs, DRAWN, SEED)
    about |= {"left_out": ", ".join(lost), "remarks": "\n".join(model_remarks(case, result))}
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
    kinds = nearby.outputs.kinds
    losses = nearby.losses[: len(kinds)]
    return np.array(
        [
            losses
            @ [own.get(value.kind_of_loss, 0.0) for own in kinds]
            * (factors[value.kind_of_loss] - 1)
            if value.is_model_form
            else shift[: len(kinds)].sum(axis=0)
            for value, shift in zip(nearby.values, shifts, strict=True)
        ]
    )
