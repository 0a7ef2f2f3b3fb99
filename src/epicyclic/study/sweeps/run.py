"""`sweep`: rows of results as a dataset, and the files that keep it."""

from __future__ import annotations

import json
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from epicyclic.build.machine import layout_of
from epicyclic.case.case import Case
from epicyclic.errors import one_problem
from epicyclic.files import check_place, whole_file
from epicyclic.netcdf_file import texts_not_copied
from epicyclic.result.result import number_fields, origin
from epicyclic.study.operating import AXES, axis_name
from epicyclic.study.sweeps.axes import ROW, columns_of, unit_of
from epicyclic.study.sweeps.plan import SweepPlan, make_plan
from epicyclic.study.sweeps.runner import Progress, Rows, Runner
from epicyclic.units import percent

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


# Rows of a sweep as an `xarray.Dataset`, and the files it is kept in.

FORMATS = (".nc", ".csv", ".parquet")
_FORMULA = ("=", "+", "-", "@", "\t", "\r")  # What formulas of spreadsheets begin with.
_CASE_KEY = "case_key"  # Attribute of a coordinate: the key that it varies.
_INTERPOLATION_ERROR = "pocket_interpolation_error"


def to_dataset(plan: SweepPlan, rows: Rows) -> xr.Dataset:
    """The rows of all points of `plan` over its axes.

    Dimensions are called as the keys. Beside each stands a coordinate of the same values with a
    name without dots, for attributes and keywords. Keys that change with another one, or follow
    from others, are coordinates over those.
    """
    import xarray as xr

    numbers = {item.key: item for item in number_fields(layout_of(plan.case))}
    dims = tuple(axis.key for axis in plan.axes)
    coords = {}
    for key, over, points, unit in _coordinates(plan):
        about = _about("row of the table of points" if key == ROW else key, unit)
        coords[key] = (over, points, about)
        coords.setdefault(_plain_name(key, numbers), (over, points, about | {_CASE_KEY: key}))
    variables = {
        key: (dims, rows.numbers(key).reshape(plan.shape), _about(item.label, item.unit))
        for key, item in numbers.items()
    }
    texts = {
        "status": ("how the point ended", rows.status),
        "message": ("why the point failed", rows.message),
        "warnings": ("warnings of the point", rows.warnings),
    }
    for key, (label, values) in texts.items():
        column = np.array(values, dtype=object).reshape(plan.shape)
        variables[key] = (dims, column, _about(label, ""))
    with texts_not_copied():
        return xr.Dataset(variables, coords, _attributes(plan, rows))


def write_netcdf(dataset: xr.Dataset, path: Path) -> None:
    """All variables, units and attributes."""
    with texts_not_copied():
        dataset.to_netcdf(path, engine="netcdf4")


def _coordinates(plan: SweepPlan) -> Iterator[tuple[str, tuple[str, ...], Any, str]]:
    """Key, dimensions, values and unit of all that is varied, and of what follows from it."""
    for axis in plan.axes:
        for part in (replace(axis, together=()), *axis.together):
            yield part.key, (axis.key,), np.array(part.coordinate), part.unit
    for key in plan.links:
        behind = plan.axes_behind(key)
        shape = tuple(
            plan.shape[number] if number in behind else 1 for number in range(len(plan.shape))
        )
        values = [
            plan.point(int(np.ravel_multi_index(place, plan.shape))).coordinate(key)
            for place in np.ndindex(shape)
        ]
        kept = [plan.shape[number] for number in behind]
        known = np.array([np.nan if value is None else value for value in values]).reshape(kept)
        yield key, tuple(plan.axes[number].key for number in behind), known, unit_of(plan.case, key)


def _plain_name(key: str, numbers: Container[str]) -> str:
    """Name of a key without dots: ``"sun_mesh_misalignment_given"`` beside the computed one."""
    name = axis_name(key)
    return f"{name}_given" if name in numbers else name


def by_keys(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset of a sweep without the names beside its keys; any other as it is."""
    beside = [
        name
        for name, array in dataset.coords.items()
        if name not in dataset.dims and _CASE_KEY in array.attrs
    ]
    return dataset.drop_vars(beside)


def _about(label: str, unit: str) -> dict[str, str]:
    """Attributes of a variable; names and text have no unit."""
    return {"long_name": label} | ({"units": unit} if unit else {})


def _attributes(plan: SweepPlan, rows: Rows) -> dict[str, str]:
    return {
        "title": plan.case.title,
        **origin(plan.case),
        "conventions": "losses in W of the whole gear set, summed over planets; "
        "torque and speed of the input member",
        "pocketing": _about_pocketing(rows),
    } | _about_links(plan)


def _about_links(plan: SweepPlan) -> dict[str, str]:
    """Which keys changed together, and which followed from others."""
    groups = [[part.key for part in axis.keys] for axis in plan.axes if axis.together]
    told = {"together": groups, "links": dict(plan.links)}
    return {name: json.dumps(content) for name, content in told.items() if content}


def _about_pocketing(rows: Rows) -> str:
    """Whether the pocketing losses of some points were interpolated, and how well."""
    errors = [rows.numbers(name) for name in rows.names if name.endswith(_INTERPOLATION_ERROR)]
    if np.isnan(errors).all():
        return "flow solved at every point"
    return (
        "flow interpolated over speed * sqrt(density / ambient pressure); largest error of the "
        f"loss, measured at flows left out: {percent(np.nanmax(errors), 2)}"
    )


def check_output(path: Path) -> None:
    """Raise `InputError` unless a sweep can be written to `path`."""
    if path.suffix not in FORMATS:
        raise one_problem(
            "-o",
            str(path),
            f"must end in {', '.join(FORMATS)}.",
            "Choose one of these formats.",
            "the command",
        )
    check_place(path)


def write_dataset(dataset: xr.Dataset, path: Path) -> None:
    """Write `dataset` to `path` in the format its suffix names, whole or not at all."""
    with whole_file(path) as temporary:
        if path.suffix == ".nc":
            write_netcdf(dataset, temporary)
        elif path.suffix == ".csv":
            csv_safe(to_table(dataset)).to_csv(temporary, index=False)
        else:
            to_table(dataset).to_parquet(temporary, index=False)


def csv_safe(table: pd.DataFrame) -> pd.DataFrame:
    """A table whose texts no spreadsheet takes for formulas: those get an apostrophe in front."""
    texts = table.select_dtypes(exclude="number").columns
    safe = table.assign(**{name: table[name].map(_no_formula) for name in texts})
    return safe.rename(columns=_no_formula)


def _no_formula(value: Any) -> Any:
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


def to_table(dataset: xr.Dataset) -> pd.DataFrame:
    """One row for each point, units in the column names; those of a sweep are its keys."""
    dataset = by_keys(dataset)
    table = dataset.to_dataframe().reset_index()
    columns = {**dataset.coords, **dataset.data_vars}
    units = {str(name): str(array.attrs.get("units", "")) for name, array in columns.items()}
    table = table.rename(
        columns={name: f"{name} [{unit}]" for name, unit in units.items() if unit not in ("", "1")}
    )
    table.attrs = dict(dataset.attrs)
    return table


# The load-dependent loss as a test rig forms it: the total loss less that without torque.
#
# Both are found at one speed and oil inlet temperature, each at the temperatures it settles at. The
# loaded oil is hotter and drags less, so that this is less than the loss that depends on the load.

Points = tuple[dict[str, Any], ...]

LoadDependent = Literal["computed", "as-tested"]
"""What load-dependent losses are: the sum of the losses that depend on the load, or as above."""
COMPUTED: LoadDependent = "computed"
AS_TESTED: LoadDependent = "as-tested"


def with_unloaded(points: Sequence[Mapping[str, Any]]) -> tuple[Points, NDArray[np.intp]]:
    """Points, behind them the same without torque, each once.

    Returns
    -------
    tuple of mapping
        Keys that each point changes.
    ndarray of int, shape (n,)
        Number of the one without torque that belongs to each of the `points`.
    """
    added: dict[tuple[tuple[str, str], ...], tuple[int, dict[str, Any]]] = {}
    numbers = []
    for point in points:
        unloaded = {**point, AXES["torque"]: "0 N*m"}
        alike = tuple(sorted((key, str(value)) for key, value in unloaded.items()))
        number, _ = added.setdefault(alike, (len(points) + len(added), unloaded))
        numbers.append(number)
    behind = (unloaded for _, unloaded in added.values())
    return (*map(dict, points), *behind), np.array(numbers, dtype=np.intp)


def as_tested(rows: Rows, unloaded: NDArray[np.intp]) -> NDArray[np.float64]:
    """Load-dependent losses of points from `with_unloaded`. Theory (P9).

    NaN where a point or its partner failed. [W]
    """
    total = rows.numbers("total")
    return total[: unloaded.size] - total[unloaded]


# Run a sweep.


def sweep(
    case: Case,
    vary: Mapping[str, Iterable[Any]] | None = None,
    *,
    together: Iterable[Mapping[str, Iterable[Any]]] = (),
    points: str | Path | Mapping[str, Iterable[Any]] | pd.DataFrame | None = None,
    links: Mapping[str, str] | None = None,
    jobs: int | None = None,
    dask: str | None = None,
    shard: tuple[int, int] | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Losses over the full product of the values of some keys, or groups of keys.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
        Every key that is not varied stays as it is here.
    vary : mapping of str to iterable, optional
        Dotted keys to values, ``{"operation.speed": ["1000 rpm", "2000 rpm"]}``: numbers, text
        with units, choices, names.
    together : iterable of mapping, optional
        Groups of keys with as many values each, which change together. Each group is one
        dimension, named after its first key.
    points : str, Path, mapping or pandas.DataFrame, optional
        A table of points, one in each row, by its columns: a ``.csv`` file, or the same in memory.
        It is the dimension ``row``.
    links : mapping of str to str, optional
        Keys to expressions of others, ``{"ring.teeth": "sun.teeth + 2 * planet.teeth"}``. In that
        of a key, the key itself is its value in the case, as is ``case(KEY)`` of any.
    jobs : int, optional
        Worker processes. Default: one for each core if the work is worth it, else none.
    dask : str, optional
        Address of the scheduler of a Dask cluster that takes their place.
    shard : (int, int), optional
        Which share of the points to compute, and of how many: ``(2, 8)``. Points of other shards
        have NaN and the status ``"not computed"``; ``epicyclic merge`` makes one file of journals
        of all shards.
    journal : str or Path, optional
        File that keeps finished points, so that an interrupted sweep goes on where it stopped.
        It stays when the sweep is done, and is refused by another sweep.
    progress : callable, optional
        Called with the number of finished points and of all points, or of those of the shard.

    Returns
    -------
    xarray.Dataset
        One dimension for each key or group, every number with its unit; points that failed have
        NaN, the status ``"failed"`` and the reason in ``message``. Which variables there are
        depends on the kind of the case only. Keys that change with others or follow from them are
        coordinates; the attributes ``together`` and ``links`` name them.

    Raises
    ------
    InputError
        If a key cannot be varied, a value cannot be read, a link has no value, or the journal is
        that of another sweep.
    """
    runner = Runner(jobs, dask, shard, journal, progress)
    table = points if points is None or isinstance(points, Mapping) else columns_of(points)
    plan = make_plan(case, vary, together=together, points=table, links=links)
    return to_dataset(plan, runner.run(plan))
