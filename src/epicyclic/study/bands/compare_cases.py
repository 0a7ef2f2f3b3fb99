"""Whether one case loses less than another, given what is uncertain in both."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.case.case import Case
from epicyclic.case.tables.uncertainty import UncertainValue
from epicyclic.errors import ConvergenceError, one_problem
from epicyclic.result.result import Result, versions
from epicyclic.study.bands.plan import (
    Outputs,
    Point,
    SamplePlan,
    check_samples,
    factors_of,
    outputs_of,
    values_at,
    without_table,
)
from epicyclic.study.bands.samples import probabilities, quantiles, sample_summary
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.runner import Progress, Runner

if TYPE_CHECKING:
    import xarray as xr

OWN = "B: "  # Before the key of a value of the second case that the first does not share.
PAIRS = 256


def compare_cases(
    first: CaseSource,
    second: CaseSource,
    *,
    samples: int = PAIRS,
    seed: int = 1,
    points: Sequence[tuple[float, Point]] = ((1.0, {}),),
    jobs: int | None = None,
    dask: str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Difference of the losses of two cases, with the inputs that both share drawn once.

    Two cases share an input whose key, value and distribution are equal in both, and the errors of
    models if both use the same models. All other inputs are drawn separately for each case.

    Parameters
    ----------
    first, second : PlanetaryCase, GearPairCase or TrainCase
    samples : int, optional
        Pairs of points, a power of 2.
    points : sequence of (float, mapping), optional
        Operating points of a cycle: the time spent there, in any unit, and the keys of the cases
        that change. Results are then means over time; the efficiency is that of the energies. A
        draw is the same at all points. Default: the cases as they are.
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
    weights = np.array([time for time, _ in points], dtype=float)
    if not ((weights >= 0).all() and 0 < weights.sum() < np.inf):
        raise one_problem("points", "", "must have times of 0 or more, not all 0.", "Correct them.")
    cases, changes = (as_case(first), as_case(second)), [dict(change) for _, change in points]
    results = [[solve(case.updated(it) if it else case) for it in changes] for case in cases]
    values = [values_at(case, own[0], changes) for case, own in zip(cases, results, strict=True)]
    at_points = zip(*values, *results, strict=True)
    shared = set.intersection(*(_shared(own[:2], own[2:]) for own in at_points))
    others = [it for it in values[1][0] if it.key not in shared]
    drawn = probabilities([*values[0][0], *_renamed(others, shared)], samples, seed)
    keys = [it.key for it in values[0][0]] + [f"{OWN}{it.key}" for it in others]
    rows = dict(zip(keys, drawn, strict=True))
    runner, weights = Runner(jobs, dask, None, None, progress), weights / weights.sum()
    evaluated, nominal = [], []
    for case, own, known, mark in zip(cases, results, values, ("", OWN), strict=True):
        found = [
            [quantiles(it, rows[it.key if it.key in shared else f"{mark}{it.key}"]) for it in at]
            for at in known
        ]
        taken = np.array(found).reshape(len(changes), len(known[0]), samples)  # also of no values
        evaluated.append(_evaluate(case, own[0], known, taken, changes, weights, runner))
        nominal.append(_nominal(own, evaluated[-1][0].names, weights))
    return _dataset(cases, nominal, evaluated, sorted(shared))


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
    case: Case,
    result: Result,
    values: Sequence[Sequence[UncertainValue]],  # At each operating point.
    drawn: FloatArray,  # Of these values, operating points first.
    changes: Sequence[Point],
    weights: FloatArray,
    runner: Runner,
) -> tuple[Outputs, FloatArray]:
    inputs = [number for number, it in enumerate(values[0]) if not it.is_model_form]
    outputs = outputs_of(case, result)
    plan = SamplePlan(
        without_table(case),
        outputs,
        inputs=tuple(values[0][number] for number in inputs),
        count=drawn.shape[-1],
        drawn=tuple(own[inputs] for own in drawn),
        points=tuple(changes),
    )
    losses, powers = plan.found(runner.run(plan))
    # factors of models are those of a kind, whatever the operating point
    results = outputs.of(losses, powers, factors_of(values[0], np.moveaxis(drawn, 1, 0)))
    return outputs, _over_time(np.moveaxis(results, 1, 0), powers.with_loss(results[-2]), weights)


def _over_time(results: FloatArray, entering: FloatArray, weights: FloatArray) -> FloatArray:
    """Means over operating points, which come first; the efficiency is that of the energies."""
    mean: FloatArray = np.tensordot(weights, results, 1)
    if len(weights) > 1:
        with np.errstate(divide="ignore", invalid="ignore"):
            mean[-1] = np.maximum(0.0, 1 - mean[-2] / (weights @ entering))
    return mean


def _dataset(
    cases: Sequence[Case],
    nominal: Sequence[FloatArray],  # In the order of the outputs.
    evaluated: Sequence[tuple[Outputs, FloatArray]],
    shared: Sequence[str],
) -> xr.Dataset:
    import xarray as xr

    names = [name for name in evaluated[0][0].names if name in evaluated[1][0].names]
    places = [[outputs.names.index(name) for name in names] for outputs, _ in evaluated]
    one, two = (found[own] for own, (_, found) in zip(places, evaluated, strict=True))
    total = names.index("total")
    sound = np.isfinite(one[total]) & np.isfinite(two[total])
    if sound.sum() < 2:
        raise ConvergenceError("no pair of samples has a result in both cases.")
    keys = ("difference", "standard_uncertainty", "low", "high", "unpaired_uncertainty",
            "probability")  # fmt: skip
    table = np.full((len(names), len(keys)), np.nan)
    for row in range(len(names)):
        left, right = one[row, sound], two[row, sound]
        known = np.isfinite(left) & np.isfinite(right)
        apart = right[known] - left[known]
        if apart.size > 1:
            whole = sample_summary(apart)
            unpaired = np.hypot(left[known].std(ddof=1), right[known].std(ddof=1))
            table[row] = (
                whole.mean, whole.standard_uncertainty, whole.low, whole.high, unpaired,
                (apart < 0).mean(),
            )  # fmt: skip
    stated = [found[own] for found, own in zip(nominal, places, strict=True)]
    columns = zip(keys, table.T, strict=True)
    variables: dict[str, Any] = {key: ("result", values) for key, values in columns}
    variables |= {"first": ("result", stated[0]), "second": ("result", stated[1])}
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


def _nominal(results: Sequence[Result], names: Sequence[str], weights: FloatArray) -> FloatArray:
    """Losses and sums of the case as it is, in the order of `names`."""
    found = [
        [it.losses[name] if name in it.losses else getattr(it, name) for name in names]
        for it in results
    ]
    entering = np.array([it.input_power for it in results])
    return _over_time(np.array(found, dtype=float), entering, weights)
