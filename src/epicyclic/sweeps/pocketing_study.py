"""The parametric study of pocketing losses of Talbot (2012), section 4.4, for any mesh."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.datasets import variable
from epicyclic.analysis.pocket_variants import solve_variant
from epicyclic.analysis.result import versions
from epicyclic.case.case import Case, PlanetaryCase
from epicyclic.pocketing.fluid import PocketFlow
from epicyclic.status import Status
from epicyclic.sweeps.journal import Journal, Row
from epicyclic.sweeps.pocketing_plan import (
    PARAMETERS,
    STUDIES,
    StudyAxis,
    StudyPlan,
    make_study,
)
from epicyclic.sweeps.work import Progress, guarded, run_work
from epicyclic.units import BAR, METRE_PER_SECOND, NUMBER, WATT, Quantity

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["pocketing_study", "run_study", "study_datasets"]

_NUMBERS: dict[str, tuple[str, Quantity, Callable[[PocketFlow], float]]] = {
    "pocketing_loss": ("pocketing loss of one mesh", WATT, lambda flow: flow.power),
    "power_difference": ("energy balance over work, less 1", NUMBER, lambda flow: flow.difference),
    "pressure_max": (
        "highest pressure above ambient",
        BAR,
        lambda flow: float(flow.pressure.max()),
    ),
    "pressure_min": ("lowest pressure above ambient", BAR, lambda flow: float(flow.pressure.min())),
    "speed_max": (
        "fastest flow through any opening",
        METRE_PER_SECOND,
        lambda flow: flow.speed_max,
    ),
}


def pocketing_study(
    case: Case,
    what: Iterable[str] = tuple(STUDIES),
    *,
    mesh: str | None = None,
    ranges: Mapping[str, Iterable[Any]] | None = None,
    levels: Mapping[str, Iterable[Any]] | None = None,
    jobs: int | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> dict[str, xr.Dataset]:
    """Pocketing loss of a mesh over its main parameters, as Talbot (2012), section 4.4.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
    what : iterable of str
        Of ``"speed"``, ``"helix-angle"``, ``"face-width"``, ``"oil-fraction"``, ``"backlash"``,
        ``"module"``; default: all.
    mesh : str, optional
        ``"sun_mesh"`` (default) or ``"ring_mesh"`` of a planetary set.
    ranges : mapping, optional
        Parameters to the values over which their study goes, as text with units; a share of oil
        is a number. A module becomes the nearest one with whole teeth.
    levels : mapping, optional
        Parameters to the values that have curves and panels of their own in the other studies.
    jobs : int, optional
        Worker processes. Default: one for each core if the work is worth it, else none.
    journal : str or Path, optional
        File that keeps finished points.
    progress : callable, optional
        Called with the number of finished points and of all points.

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
    plan = make_study(case, what, mesh=mesh, ranges=ranges or {}, levels=levels or {})
    kept = None if journal is None else Journal(Path(journal).absolute(), plan.fingerprint())
    return study_datasets(plan, run_study(plan, jobs=jobs, journal=kept, progress=progress))


@dataclass(frozen=True, slots=True)
class _Variants:
    """The points of a plan as work."""

    plan: StudyPlan

    def order(self) -> Sequence[int]:
        """Those of the same geometry next to each other."""
        return self.plan.order()

    def solve(self, index: int) -> Row:
        """One point as a flat record."""
        return guarded(lambda: _solve_point(self.plan, index))


def _solve_point(plan: StudyPlan, index: int) -> Row:
    flow = solve_variant(plan.case, plan.duty, plan.points[index])
    warning = "" if flow.periodic else "the flow does not repeat; the loss is a mean"
    numbers = {name: value(flow) for name, (_, _, value) in _NUMBERS.items()}
    return Row(str(Status.CONVERGED), warnings=warning, numbers=numbers)


def run_study(
    plan: StudyPlan,
    *,
    jobs: int | None = None,
    journal: Journal | None = None,
    progress: Progress | None = None,
) -> list[Row]:
    """Rows of all points of `plan`, in their order. Parameters as for `pocketing_study`."""
    rows: dict[int, Row] = {}
    for finished in run_work(_Variants(plan), jobs=jobs, journal=journal):
        rows.update(finished)
        if progress is not None:
            progress(len(rows), len(plan.points))
    return [rows[index] for index in range(len(plan.points))]


def study_datasets(plan: StudyPlan, rows: Sequence[Row]) -> dict[str, xr.Dataset]:
    """The rows of all points over the axes of each study."""
    found = dict(zip(plan.points, rows, strict=True))
    return {
        name: _dataset(plan, name, [found[point] for point in plan.variants(name)])
        for name in plan.axes
    }


def _dataset(plan: StudyPlan, name: str, rows: Sequence[Row]) -> xr.Dataset:
    import xarray as xr

    axes = plan.axes[name]
    dims = tuple(axis.dimension for axis in axes)
    shape = tuple(len(axis.values) for axis in axes)
    coordinates = {axis.dimension: _coordinate(axis) for axis in axes}
    if "speed" in coordinates:
        coordinates["speed"][-1]["long_name"] = f"speed of the {_member(plan)}"
    variables: dict[str, Any] = {}
    for key, (label, quantity, _) in _NUMBERS.items():
        values = np.array([row.numbers.get(key, math.nan) for row in rows]).reshape(shape)
        variables[key] = variable(dims, values, label, quantity)
    for key, label in (
        ("status", "how the point ended"),
        ("message", "why the point failed"),
        ("warnings", "warnings of the point"),
    ):
        texts = np.array([getattr(row, key) for row in rows], dtype=object).reshape(shape)
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
    used = versions()
    return {
        "title": f"Pocketing loss of the {mesh} of {plan.case.title or 'the case'}",
        "figure": STUDIES[name].figure,
        "mesh": plan.duty.key,
        "model": plan.case.models.pocketing,
        "source": f"epicyclic {used['epicyclic']}",
        "versions": json.dumps(used),
        "case": json.dumps(plan.case.inputs()),
    }


def _exponents(loss: xr.DataArray) -> xr.DataArray:
    """Slope of the logarithm of the loss over that of the speed."""
    speed = np.log(loss["speed"])
    away = speed - speed.mean()
    slope: xr.DataArray = (np.log(loss) * away).sum("speed", skipna=False) / (away**2).sum()
    slope.attrs = {"long_name": "exponent of the speed in the loss", "units": "1"}
    return slope
