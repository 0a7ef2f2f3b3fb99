"""The distribution of a result, from samples of all that is uncertain."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.errors import ConvergenceError
from epicyclic.result.result import origin
from epicyclic.study.bands.advice import model_remarks
from epicyclic.study.bands.inputs import remedy_for
from epicyclic.study.bands.nearby import SUMS, Nearby, Outputs, factors_of, look_nearby
from epicyclic.study.bands.plan import FEWEST, SampledCase, SamplePlan, check_samples, sampled_case
from epicyclic.study.bands.samples import (
    COVERAGE,
    Samples,
    Summary,
    cut_off,
    sample_summary,
    sobol_indices,
    standard_uncertainty,
)
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.runner import Rows

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]

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
"""Units of the fields of `Summary`."""
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
    check_samples(samples)
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

    (samples, *_), names = sampled.samples, sampled.outputs.names
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


def _sound(total: FloatArray, messages: Sequence[str]) -> NDArray[np.bool]:
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
    power = np.full(2, nearby.input_power)
    found = []
    for value, ends in zip(values, nearby.ends, strict=True):
        factor = np.array([1 / value.spread[0], value.spread[0]])
        factors = factors_of([value], factor[None]) if value.is_model_form else {}
        below, above = outputs.of(ends.T, power, factors).T
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
    chosen = np.resize(np.flatnonzero(sound), sound.size)
    kept = sets[:, :, chosen]
    found = sobol_indices(kept[0], kept[1], kept[2:][moving], seed)
    variables: dict[str, Any] = {"sum": list(SUMS[:-1])}
    for name, label, values, (low, high) in (
        ("first_order", "share of the variance alone", found.first, found.first_ends),
        ("total_order", "share with interactions", found.total, found.total_ends),
    ):
        for key, text, part in (
            (name, label, values),
            (f"{name}_low", "low end of its interval", low),
            (f"{name}_high", "high end of its interval", high),
        ):
            whole = np.zeros((sets.shape[1], len(samples.groups)))
            whole[:, moving] = part
            variables[key] = (("sum", "driver"), whole, {"long_name": text, "units": "1"})
    return variables


def about_inputs(values: Sequence[UncertainValue]) -> dict[str, Any]:
    """What is known of each input."""
    remedies = [remedy_for(value.key) for value in values]
    columns: dict[str, tuple[list[Any], str]] = {
        "input_value": ([value.value for value in values], "value of the input"),
        "input_unit": ([value.unit or "1" for value in values], "unit of the input"),
        "distribution": ([value.text for value in values], "distribution of the input"),
        "distribution_source": ([value.source for value in values], "where that is from"),
        "input_uncertainty": (
            [standard_uncertainty(value) for value in values],
            "standard uncertainty of the input",
        ),
        "input_name": ([name for name, _ in remedies], "what it is called"),
        "input_advice": ([advice for _, advice in remedies], "how to know it better"),
        "cut_off": ([cut_off(value) for value in values], "probability of what cannot be"),
    }
    return {
        name: ("input", np.array(column), {"long_name": label, "units": "see input_unit"})
        for name, (column, label) in columns.items()
    }
