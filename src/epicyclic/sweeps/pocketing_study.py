"""The parametric study of pocketing losses of Talbot (2012), section 4.4, for any mesh."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.datasets import variable
from epicyclic.case.case import Case, PlanetaryCase
from epicyclic.pocketing.similarity import FLOW_NUMBERS
from epicyclic.results.result import origin
from epicyclic.sweeps.journal import Rows
from epicyclic.sweeps.pocketing_plan import (
    NUMBERS,
    PARAMETERS,
    STUDIES,
    StudyAxis,
    StudyPlan,
    make_study,
)
from epicyclic.sweeps.runner import Progress, Runner

if TYPE_CHECKING:
    import xarray as xr


def pocketing_study(
    case: Case,
    what: Iterable[str] = tuple(STUDIES),
    *,
    mesh: str | None = None,
    ranges: Mapping[str, Iterable[Any]] | None = None,
    levels: Mapping[str, Iterable[Any]] | None = None,
    jobs: int | None = None,
    dask: str | None = None,
    shard: tuple[int, int] | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> dict[str, xr.Dataset]:
    """Pocketing loss of a mesh over its main parameters, as Talbot (2012), section 4.4.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
    what : iterable of str
        Some of ``"speed"``, ``"helix-angle"``, ``"face-width"``, ``"oil-fraction"``,
        ``"backlash"``, ``"module"``; default: all.
    mesh : str, optional
        ``"sun_mesh"`` (default) or ``"ring_mesh"`` of a planetary set.
    ranges : mapping, optional
        Parameters to the values over which their study goes, as text with units; a share of oil
        is a number. A module becomes the nearest one with whole teeth.
    levels : mapping, optional
        Parameters to the values that have curves and panels of their own in the other studies.
    jobs, dask, shard, journal, progress
        As for `sweep`.

    Returns
    -------
    dict of str to xarray.Dataset
        By study. What each parameter keeps constant is told in its how-to page. Points that
        failed have NaN, the status ``"failed"`` and the reason in ``message``.

    Raises
    ------
    InputError
        If a study, mesh or value cannot be, or the journal is that of another study.
    """
    runner = Runner(jobs, dask, shard, journal, progress)
    plan = make_study(case, what, mesh=mesh, ranges=ranges or {}, levels=levels or {})
    return study_datasets(plan, runner.run(plan))


def study_datasets(plan: StudyPlan, rows: Rows) -> dict[str, xr.Dataset]:
    """The rows of all points over the axes of each study."""
    place = {point: index for index, point in enumerate(plan.points)}
    return {
        name: _dataset(plan, name, rows, [place[point] for point in plan.variants(name)])
        for name in plan.axes
    }


def _dataset(plan: StudyPlan, name: str, rows: Rows, own: list[int]) -> xr.Dataset:
    import xarray as xr

    axes = plan.axes[name]
    dims = tuple(axis.dimension for axis in axes)
    shape = tuple(len(axis.values) for axis in axes)
    coordinates = {axis.dimension: _coordinate(axis) for axis in axes}
    if "speed" in coordinates:
        coordinates["speed"][-1]["long_name"] = f"speed of the {_member(plan)}"
    variables: dict[str, Any] = {}
    for key, figure in NUMBERS.items():
        values = rows.numbers(key)[own].reshape(shape)
        variables[key] = variable(dims, values, *FLOW_NUMBERS[figure])
    for key, label in (
        ("status", "how the point ended"),
        ("message", "why the point failed"),
        ("warnings", "warnings of the point"),
    ):
        texts = np.array(getattr(rows, key), dtype=object)[own].reshape(shape)
        variables[key] = (dims, texts, {"long_name": label})
    dataset = xr.Dataset(variables, coordinates, _attributes(plan, name))
    if name == "speed" and dataset.sizes["speed"] > 1:
        dataset["speed_exponent"] = _exponents(dataset["pocketing_loss"])
    return dataset


def _coordinate(axis: StudyAxis) -> tuple[str, NDArray[np.float64], dict[str, str]]:
    parameter = PARAMETERS[axis.name]
    scale, _ = parameter.quantity.scale_and_offset()
    attributes = {"long_name": parameter.label, "units": parameter.quantity.display or "1"}
    # rounded as everything that is shown: 15 mm and not 15.000000000000002
    values = [float(f"{scale * value:.12g}") for value in axis.values]
    return (axis.dimension, np.array(values), attributes)


def _member(plan: StudyPlan) -> str:
    """Whose speed it is, and against what."""
    name = plan.duty.mesh.gear1.name
    return f"{name} against the carrier" if isinstance(plan.case, PlanetaryCase) else name


def _attributes(plan: StudyPlan, name: str) -> dict[str, str]:
    mesh = plan.duty.key.replace("_", " ")
    return {
        "title": f"Pocketing loss of the {mesh} of {plan.case.title or 'the case'}",
        "figure": STUDIES[name].figure,
        "mesh": plan.duty.key,
        "model": plan.duty.models.pockets.model,
        **origin(plan.case),
    }


def _exponents(loss: xr.DataArray) -> xr.DataArray:
    """Slope of the logarithm of the loss over that of the speed."""
    speed = np.log(loss["speed"])
    away = speed - speed.mean()
    slope: xr.DataArray = (np.log(loss) * away).sum("speed", skipna=False) / (away**2).sum()
    slope.attrs = {"long_name": "exponent of the speed in the loss", "units": "1"}
    return slope
