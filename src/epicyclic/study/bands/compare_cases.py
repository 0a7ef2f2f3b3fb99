"""Whether one case loses less than another, given what is uncertain in both."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.errors import ConvergenceError
from epicyclic.result.result import Result, versions
from epicyclic.study.bands.plan import (
    INPUT_POWER,
    SHAFT_POWER,
    Outputs,
    Powers,
    SamplePlan,
    check_samples,
    factors_of,
    known_values,
    outputs_of,
    without_table,
)
from epicyclic.study.bands.samples import probabilities, quantiles, sample_summary
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.runner import Progress, Runner

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]
OWN = "B: "  # Before the key of a value of the second case that the first does not share.
PAIRS = 256


def compare_cases(
    first: CaseSource,
    second: CaseSource,
    *,
    samples: int = PAIRS,
    seed: int = 1,
    jobs: int | None = None,
    dask: str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """How much more or less the second case loses, with the inputs that both share drawn once.

    Two cases share an input whose key, value and distribution are equal in both, and the errors of
    models if both use the same models. All else is drawn for each on its own.

    Parameters
    ----------
    first, second : PlanetaryCase, GearPairCase or TrainCase
    samples : int, optional
        Pairs of points, a power of 2.
    seed, jobs, dask, progress
        As for `uncertainty`.

    Returns
    -------
    xarray.Dataset
        Over ``result``, what both cases have of losses, sums and efficiency: ``first`` and
        ``second``, the values of the cases; ``difference``, second less first, with
        ``standard_uncertainty``, ``low`` and ``high`` (95 %); ``unpaired_uncertainty``, that of two
        results that know nothing of each other; ``probability`` that the second is smaller.

    Raises
    ------
    InputError
        If a table [uncertainty] has problems.
    ConvergenceError
        If a case, or hardly any pair of samples, can be solved.
    """
    check_samples(samples, seed)
    cases = as_case(first), as_case(second)
    results = [solve(case) for case in cases]
    values = [known_values(case, result) for case, result in zip(cases, results, strict=True)]
    shared = _shared(values, results)
    others = [it for it in values[1] if it.key not in shared]
    drawn = probabilities([*values[0], *_renamed(others, shared)], samples, seed)
    keys = [it.key for it in values[0]] + [f"{OWN}{it.key}" for it in others]
    rows = dict(zip(keys, drawn, strict=True))
    runner = Runner(jobs, dask, None, None, progress)
    evaluated = []
    for case, result, own, mark in zip(cases, results, values, ("", OWN), strict=True):
        points = np.array(
            [quantiles(it, rows[it.key if it.key in shared else f"{mark}{it.key}"]) for it in own]
        )
        evaluated.append(_evaluate(case, result, own, points, runner))
    return _dataset(cases, results, evaluated, sorted(shared))


def _shared(values: Sequence[Sequence[UncertainValue]], results: Sequence[Result]) -> set[str]:
    """Keys of what is the same unknown in both cases."""
    alike = dict(results[0].models) == dict(results[1].models)
    one, two = ({it.key: it for it in own} for own in values)
    return {
        key for key in one.keys() & two.keys() if one[key] == two[key]
        and (alike or not one[key].is_model_form)
    }  # fmt: skip


def _renamed(values: Sequence[UncertainValue], shared: set[str]) -> list[UncertainValue]:
    """Values of the second case under keys of their own, correlations between them as well."""
    return [
        replace(
            it,
            key=f"{OWN}{it.key}",
            correlated={
                key if key in shared else f"{OWN}{key}": coefficient
                for key, coefficient in it.correlated.items()
            },
        )
        for it in values
    ]


def _evaluate(
    case: Case, result: Result, values: Sequence[UncertainValue], points: FloatArray, runner: Runner
) -> tuple[Outputs, FloatArray]:
    inputs = [number for number, it in enumerate(values) if not it.is_model_form]
    outputs = outputs_of(case, result)
    plan = SamplePlan(
        without_table(case),
        outputs,
        inputs=tuple(values[number] for number in inputs),
        count=points.shape[1],
        drawn=(points[inputs],),
    )
    rows = runner.run(plan)
    losses = np.array([rows.numbers(name) for name in outputs.numbers]).reshape(-1, len(rows))
    power, shaft = (rows.numbers(name) for name in (INPUT_POWER, SHAFT_POWER))
    powers = Powers(power, shaft, losses[: len(outputs.losses)].sum(axis=0))
    return outputs, outputs.of(losses, powers, factors_of(values, points))


def _dataset(
    cases: Sequence[Case],
    results: Sequence[Result],
    evaluated: Sequence[tuple[Outputs, FloatArray]],
    shared: Sequence[str],
) -> xr.Dataset:
    import xarray as xr

    names = [name for name in evaluated[0][0].names if name in evaluated[1][0].names]
    one, two = (
        np.array([found[outputs.names.index(name)] for name in names])
        for outputs, found in evaluated
    )
    total = names.index("total")
    sound = np.isfinite(one[total]) & np.isfinite(two[total])
    if sound.sum() < 2:
        raise ConvergenceError("no pair of samples has a result in both cases.")
    columns: dict[str, list[float]] = {
        key: []
        for key in (
            "difference", "standard_uncertainty", "low", "high", "unpaired_uncertainty",
            "probability",
        )
    }  # fmt: skip
    for row in range(len(names)):
        left, right = one[row, sound], two[row, sound]
        known = np.isfinite(left) & np.isfinite(right)
        apart = right[known] - left[known]
        if apart.size < 2:
            values = [np.nan] * len(columns)
        else:
            whole = sample_summary(apart)
            unpaired = float(np.hypot(left[known].std(ddof=1), right[known].std(ddof=1)))
            values = [
                whole.mean, whole.standard_uncertainty, whole.low, whole.high, unpaired,
                float((apart < 0).mean()),
            ]  # fmt: skip
        for key, value in zip(columns, values, strict=True):
            columns[key].append(value)
    nominal = [[_nominal(result, name) for name in names] for result in results]
    variables: dict[str, Any] = {key: ("result", values) for key, values in columns.items()}
    variables |= {"first": ("result", nominal[0]), "second": ("result", nominal[1])}
    units = ["1" if name == "efficiency" else "W" for name in names]
    used = versions()
    return xr.Dataset(
        variables,
        {"result": names, "unit": ("result", units)},
        {
            "first_title": cases[0].title,
            "second_title": cases[1].title,
            "source": f"epicyclic {used['epicyclic']}",
            "versions": json.dumps(used),
            "shared": ", ".join(shared),
            "pairs": int(sound.size),
            "failed": int((~sound).sum()),
        },
    )


def _nominal(result: Result, name: str) -> float:
    value = result.losses[name] if name in result.losses else getattr(result, name)
    return float("nan") if value is None else float(value)
