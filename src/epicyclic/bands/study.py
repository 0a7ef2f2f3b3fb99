"""The distribution of a result, from samples of all that is uncertain."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.solve import solve
from epicyclic.bands.distributions import cut_off, standard_uncertainty
from epicyclic.bands.nearby import Nearby, look_nearby
from epicyclic.bands.outputs import SUMS, factors_of
from epicyclic.bands.sampling import Samples, make_samples
from epicyclic.bands.statistics import COVERAGE, Summary, sobol_indices, summary
from epicyclic.case.case import Case
from epicyclic.case.uncertain_values import UncertainValue
from epicyclic.errors import ConvergenceError, InputError, Problem
from epicyclic.results.result import versions
from epicyclic.sweeps.journal import Rows
from epicyclic.sweeps.plan import PointList
from epicyclic.sweeps.runner import Progress, Runner

if TYPE_CHECKING:
    import xarray as xr

__all__ = [
    "SAMPLES",
    "SamplePlan",
    "UncertaintyStudy",
    "check_samples",
    "uncertainty",
    "uncertainty_study",
]

FloatArray = NDArray[np.float64]

SAMPLES = 256
"""Points in each of the two sets."""
FEWEST, MOST = 16, 65536


@dataclass(frozen=True, slots=True)
class SamplePlan(PointList):
    """Samples of the inputs of a case; some make no case, and are counted."""

    kind: ClassVar[str] = "uncertainty"
    may_fail: ClassVar[bool] = True


def uncertainty(
    case: Case,
    *,
    samples: int = SAMPLES,
    seed: int = 1,
    jobs: int | None = None,
    dask: str | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """How well losses and efficiency of a case are known, and what that depends on.

    Inputs and the errors of models, as [uncertainty] of the case states them or as is assumed,
    are drawn at scrambled Sobol points, twice, and with each of them exchanged between the two.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
    samples : int, optional
        Points in each of the two sets, a power of 2.
    seed : int, optional
        Of the scrambling: equal ones give equal results, whatever computes them.
    jobs, dask, journal, progress
        As for `sweep`.

    Returns
    -------
    xarray.Dataset
        Over ``result``, every loss, their sums and the efficiency: ``nominal``, ``mean``,
        ``standard_uncertainty``, ``expanded_uncertainty`` (k = 2), ``low``, ``high`` (95 %,
        symmetric in probability), ``shortest_low``, ``shortest_high``. Over ``input`` and
        ``result``: ``contribution``, the change for one standard deviation. Over ``driver``, which
        is an input or several that are correlated: Sobol indices ``first_order`` and
        ``total_order`` with their 95 % intervals. Over ``sample``: ``drawn``, ``value``,
        ``status``, ``message``.

    Raises
    ------
    InputError
        If the table [uncertainty] has problems.
    ConvergenceError
        If the case itself, or hardly any sample of it, can be solved.
    """
    study = uncertainty_study(case, samples, seed)
    return study.dataset(Runner(jobs, dask, None, journal, progress).run(study.plan))


def uncertainty_study(case: Case, samples: int = SAMPLES, seed: int = 1) -> UncertaintyStudy:
    """What has to be solved for the uncertainty of a case; see `uncertainty`."""
    check_samples(samples)
    result = solve(case)
    nearby = look_nearby(case, result)
    drawn = make_samples(nearby.values, samples, seed)
    active = nearby.active
    inputs = [i for i, value in enumerate(drawn.values) if active[i] and not value.is_model_form]
    groups = tuple(
        number for number, group in enumerate(drawn.groups) if not set(group).isdisjoint(inputs)
    )
    sets = [drawn.a, drawn.b, *(drawn.mixed(number) for number in groups)]
    points = tuple(
        {drawn.values[i].key: drawn.values[i].stated(float(points[i, j])) for i in inputs}
        for points in sets
        for j in range(samples)
    )
    plain = case.updated({"uncertainty": None}) if case.uncertainty else case
    return UncertaintyStudy(case, nearby, drawn, groups, SamplePlan(plain, points=points), seed)


def check_samples(samples: int) -> None:
    """Raise `InputError` for a number that is no power of 2, or too small or large."""
    if FEWEST <= samples <= MOST and samples & (samples - 1) == 0:
        return
    nearest = 2 ** round(np.log2(min(max(samples, FEWEST), MOST)))
    allowed = f"must be a power of 2 from {FEWEST} to {MOST}."
    problem = Problem("samples", str(samples), allowed, f"Take {nearest}.")
    raise InputError([problem], "the command")


@dataclass(frozen=True, slots=True)
class UncertaintyStudy:
    """The samples of a case, and the points to be solved for them.

    Attributes
    ----------
    case : Case
    nearby : Nearby
    samples : Samples
    groups : tuple of int
        Numbers of the groups of inputs that change losses, beyond factors of models.
    plan : SamplePlan
        Points of A, of B, and of A with each of those groups from B.
    seed : int
    """

    case: Case
    nearby: Nearby
    samples: Samples
    groups: tuple[int, ...]
    plan: SamplePlan
    seed: int

    @property
    def moving(self) -> list[int]:
        """Numbers of the groups that change any result."""
        factors = [
            number
            for number, group in enumerate(self.samples.groups)
            if any(self.samples.values[i].is_model_form for i in group)
        ]
        return sorted({*self.groups, *factors})

    def dataset(self, rows: Rows) -> xr.Dataset:
        """What the solved points say; see `uncertainty`."""
        return _dataset(self, _evaluate(self, rows))


@dataclass(frozen=True, slots=True)
class _Evaluated:
    """Results at the points A and B, shape (s, n), and mixed ones, shape (g, s, n)."""

    a: FloatArray
    b: FloatArray
    mixed: FloatArray
    status: list[str]
    message: list[str]


def _evaluate(study: UncertaintyStudy, rows: Rows) -> _Evaluated:
    samples, outputs = study.samples, study.nearby.outputs
    count = samples.a.shape[1]
    losses = np.array([rows.numbers(name) for name in outputs.losses])
    power = rows.numbers("input_power")

    def of(number: int, points: FloatArray) -> FloatArray:
        part = slice(number * count, (number + 1) * count)
        return outputs.of(losses[:, part], power[part], factors_of(samples.values, points))

    mixed = []
    for number in range(len(samples.groups)):
        solved = study.groups.index(number) + 2 if number in study.groups else 0
        mixed.append(of(solved, samples.mixed(number)))
    return _Evaluated(
        of(0, samples.a),
        of(1, samples.b),
        np.array(mixed),
        rows.status[: 2 * count],
        rows.message[: 2 * count],
    )


def _dataset(study: UncertaintyStudy, found: _Evaluated) -> xr.Dataset:
    import xarray as xr

    case, nearby, samples = study.case, study.nearby, study.samples
    outputs, values = nearby.outputs, samples.values
    both = np.concatenate([found.a, found.b], axis=1)
    sound = np.isfinite(both[-2])  # the total
    if sound.sum() < FEWEST:
        raise ConvergenceError(
            f"{(~sound).sum()} of {sound.size} samples have no result: "
            f"{next(text for text in found.message if text)}"
        )
    nominal = outputs.of(nearby.losses[:, None], np.array([nearby.input_power]), {})[:, 0]
    units = ["1" if name == "efficiency" else "W" for name in outputs.names]
    variables: dict[str, Any] = {
        "nominal": ("result", nominal, {"long_name": "result of the case"}),
        **_summaries(both, sound),
        "contribution": (
            ("input", "result"),
            _contributions(nearby),
            {"long_name": "change for one standard deviation of the input"},
        ),
        **_indices(study, found),
        **_inputs(values),
        "drawn": (
            ("input", "sample"),
            np.concatenate([samples.a, samples.b], axis=1),
            {"long_name": "value of the input"},
        ),
        "value": (("result", "sample"), both, {"long_name": "result of the sample"}),
        "status": ("sample", np.array(found.status, dtype=object)),
        "message": ("sample", np.array(found.message, dtype=object)),
    }
    names = [" + ".join(values[i].key for i in group) for group in samples.groups]
    coords = {
        "result": list(outputs.names),
        "unit": ("result", units),
        "input": [value.key for value in values],
        "driver": names,
    }
    used = versions()
    attributes = {
        "title": case.title,
        "source": f"epicyclic {used['epicyclic']}",
        "versions": json.dumps(used),
        "case": json.dumps(case.inputs()),
        "samples": samples.a.shape[1],
        "seed": study.seed,
        "failed": int((~sound).sum()),
        "coverage": COVERAGE,
    }
    return xr.Dataset(variables, coords, attributes)


def _summaries(both: FloatArray, sound: NDArray[np.bool]) -> dict[str, Any]:
    labels = {
        "mean": "mean",
        "standard_uncertainty": "combined standard uncertainty u_c",
        "expanded_uncertainty": "expanded uncertainty, k = 2",
        "low": "low end of the symmetric 95 % interval",
        "high": "high end of the symmetric 95 % interval",
        "shortest_low": "low end of the shortest 95 % interval",
        "shortest_high": "high end of the shortest 95 % interval",
    }
    rows = []
    for row in both[:, sound]:
        known = row[np.isfinite(row)]
        rows.append(astuple(summary(known)) if known.size > 1 else (np.nan,) * len(labels))
    columns = np.array(rows).T
    assert [one.name for one in fields(Summary)] == list(labels)
    return {
        name: ("result", column, {"long_name": label})
        for (name, label), column in zip(labels.items(), columns, strict=True)
    }


def _contributions(nearby: Nearby) -> FloatArray:
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


def _indices(study: UncertaintyStudy, found: _Evaluated) -> dict[str, Any]:
    """Of the sums; those of single losses follow from the samples."""
    rows = slice(-len(SUMS), -1)  # efficiency has the shares of the total loss
    moving = study.moving
    sound = np.isfinite(found.a[-2]) & np.isfinite(found.b[-2])
    sound &= np.isfinite(found.mixed[:, -2]).all(axis=0)
    # scipy takes powers of 2 only: sound points stand in for those without a result
    chosen = np.resize(np.flatnonzero(sound), sound.size)
    indices = sobol_indices(
        found.a[rows][:, chosen],
        found.b[rows][:, chosen],
        found.mixed[moving][:, rows][:, :, chosen],
        study.seed,
    )
    dims = ("sum", "driver")
    labels = {"first_order": "share of the variance alone", "total_order": "with interactions"}
    variables: dict[str, Any] = {"sum": list(SUMS[:-1])}
    for name, values, ends in (
        ("first_order", indices.first, indices.first_ends),
        ("total_order", indices.total, indices.total_ends),
    ):
        low, high = ends
        about = {"long_name": labels[name], "units": "1"}
        for key, part, own in (
            (name, values, about),
            (f"{name}_low", low, {"long_name": "low end of its interval"}),
            (f"{name}_high", high, {"long_name": "high end of its interval"}),
        ):
            whole = np.zeros((len(SUMS) - 1, len(study.samples.groups)))
            whole[:, moving] = part
            variables[key] = (dims, whole, own)
    return variables


def _inputs(values: Sequence[UncertainValue]) -> dict[str, Any]:
    columns: dict[str, list[Any]] = {
        "input_value": [value.value for value in values],
        "input_unit": [value.unit or "1" for value in values],
        "distribution": [value.text for value in values],
        "distribution_source": [value.source for value in values],
        "input_uncertainty": [standard_uncertainty(value) for value in values],
        "cut_off": [cut_off(value) for value in values],
    }
    return {name: ("input", np.array(column)) for name, column in columns.items()}
