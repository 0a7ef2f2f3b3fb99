"""Rows of a sweep as an `xarray.Dataset`, and the files it is kept in."""

from __future__ import annotations

import json
from collections.abc import Container, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.builders.build import layout_of
from epicyclic.case.operating import axis_name
from epicyclic.errors import InputError, Problem
from epicyclic.netcdf_file import texts_not_copied
from epicyclic.results.result import number_fields, origin
from epicyclic.sweeps.axes import ROW, unit_of
from epicyclic.sweeps.journal import Rows
from epicyclic.sweeps.plan import SweepPlan
from epicyclic.units import percent
from epicyclic.whole_file import check_place, whole_file

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

FORMATS = (".nc", ".csv", ".parquet")
_FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""What formulas of spreadsheets begin with."""
_CASE_KEY = "case_key"
"""Attribute of a coordinate: the key that it varies."""
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
        problem = Problem(
            "-o", str(path), f"must end in {', '.join(FORMATS)}.", "Choose one of these formats."
        )
        raise InputError([problem], "the command")
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
