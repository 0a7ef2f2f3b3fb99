"""Maps as tables of points: NetCDF, CSV, Parquet; what makes a dataset a map."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.case.case import Case, read_case
from epicyclic.case.operating import OPERATING, PLANE, STATE
from epicyclic.case.wording import one_line
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.sweeps.dataset import csv_safe, to_table
from epicyclic.units import NEWTON_METRE, WATT

if TYPE_CHECKING:
    import xarray as xr

_STATED = (
    "title",
    "source",
    "reference_shaft",
    "output_shaft",
    "sign_convention",
    "torque_loss_definition",
    "zero_speed",
    "zero_torque",
    "torque_interpolation",
    "temperatures",
    "conventions",
)
_LONGEST_STATEMENT = 1000
_NEEDED = ("title", "reference_shaft", "output_shaft", "held_shaft", "case")
"""Attributes without which a dataset is no map."""
_OPERATING = {name: part.quantity for name, part in OPERATING.items()}
_MAKE_AGAIN = "Give what epicyclic map or loss_map made."


def statements(data: xr.Dataset) -> dict[str, str]:
    """What a reader of a map must know, each on one line."""
    return {
        name.replace("_", " "): one_line(str(data.attrs.get(name, "")), _LONGEST_STATEMENT)
        for name in _STATED
    }


def map_inputs(data: xr.Dataset) -> dict[str, Any]:
    """The inputs of a map, as a case file has them."""
    inputs: dict[str, Any] = json.loads(data.attrs["case"])
    return inputs


def map_case(data: xr.Dataset, changes: Mapping[str, Any] | None = None) -> Case | None:
    """The case of a map with `changes`; None if it is none of this version."""
    try:
        case = read_case(map_inputs(data))
        return case.updated(changes) if changes else case
    except (ValueError, TypeError, InputError):
        return None


def stated(data: xr.Dataset, axes: Sequence[str] = PLANE) -> dict[str, str]:
    """The statements of a map, and the values of its axes beyond `axes`, which have one each."""
    single = {
        str(name): f"{data[name].values[0]} {data[name].attrs.get('units', '')}".strip()
        for name in data["torque_loss"].dims
        if name not in axes
    }
    if "ratio" in data and data["ratio"].size == 1:
        single["ratio"] = f"{data['ratio'].item():.15g}, speed of the input over that of the output"
    return statements(data) | single


def driven_problem(why: str) -> Problem:
    """A map of two driven shafts, for what takes one; `why` ends the sentence."""
    remedy = (
        "Set operation.fixed instead; of a train leave out operation.speeds and operation.torques."
    )
    return Problem("operation.second_input", "", f"is driven; {why}.", remedy)


def check_map(data: xr.Dataset, source: str = "the map") -> None:
    """Raise `InputError` unless `data` is a loss map."""
    coords = getattr(data, "coords", ())
    # what a map needs not have it has as an axis, or not at all
    axes = [*PLANE, *(name for name in ("temperature", STATE) if name in coords)]
    lacks = [name for name in _NEEDED if name not in getattr(data, "attrs", ())]
    variables = getattr(data, "data_vars", ())
    lacks += [name for name in ("torque_loss", "total") if name not in variables]
    if "torque_loss" in variables:
        dims = data["torque_loss"].dims
        lacks += [f"axis {name}" for name in axes if name not in dims or name not in data.coords]
    if lacks:
        allowed = f"is no loss map; it lacks {', '.join(lacks)}."
        remedy = "Give what epicyclic map or loss_map made, all of its axes kept."
        raise InputError([Problem("", "", f"This dataset {allowed}", remedy)], source)
    raise_any([*_axis_problems(data), *_value_problems(data)], source)


def _axis_problems(data: xr.Dataset) -> Iterator[Problem]:
    """Axes that cannot be looked up: of another unit, not finite, not rising."""
    for name, quantity in _OPERATING.items():
        if name not in data.coords:
            continue
        axis = data[name]
        unit = axis.attrs.get("units")
        if unit not in (None, quantity.display):  # arithmetic drops it; files must have it
            allowed = f"must be in {quantity.display}."
            yield Problem(name, one_line(str(unit)), allowed, _MAKE_AGAIN)
        if axis.dtype.kind not in "fiu" or axis.ndim != 1 or not axis.size:
            yield Problem(name, "", "must be numbers along itself.", _MAKE_AGAIN)
        elif not np.isfinite(axis.values).all():
            yield Problem(name, "", "must have finite values.", _MAKE_AGAIN)
        elif (np.diff(axis.values) <= 0).any():
            yield Problem(name, "", "must rise.", "Sort the map, as with .sortby.")


def _value_problems(data: xr.Dataset) -> Iterator[Problem]:
    """Losses that are no numbers over all axes, or not finite where the point was solved."""
    dims = set(data["torque_loss"].dims)
    units = {"torque_loss": NEWTON_METRE.display, "total": WATT.display}
    for name, array in data.data_vars.items():
        unit = array.attrs.get("units")
        wanted = units.get(str(name))
        if wanted is not None and unit not in (None, wanted):
            yield Problem(str(name), one_line(str(unit)), f"must be in {wanted}.", _MAKE_AGAIN)
        if wanted is None and unit != WATT.display:
            continue
        if array.dtype.kind != "f" or set(array.dims) != dims:
            yield Problem(str(name), "", "must be numbers over all axes.", _MAKE_AGAIN)
        elif np.isinf(array.values).any():
            yield Problem(str(name), "", "must be finite.", _MAKE_AGAIN)


def bare_map(data: xr.Dataset) -> xr.Dataset:
    """A map without what stands beside it, over further dimensions: how well it is known."""
    beside = [name for name in data.dims if name not in data["torque_loss"].dims]
    return data.drop_dims(beside)


def check_gaps(data: xr.Dataset) -> None:
    """Raise `InputError` if points of a map failed."""
    gaps = np.isnan(data["torque_loss"].values)
    if not gaps.any():
        return
    reasons = data["message"].values[gaps] if "message" in data else []
    reason = next((f" The first: {one_line(str(text))}" for text in reasons if text), "")
    allowed = f"is missing at {int(gaps.sum())} points; all are needed.{reason}"
    problem = Problem("torque_loss", "", allowed, "Leave these points out.")
    raise InputError([problem], "the map")


def write_csv(data: xr.Dataset, path: Path) -> None:
    """One row a point, after lines that begin with ``#``."""
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {name}: {text}\n" for name, text in statements(data).items())
        csv_safe(to_table(data)).to_csv(file, index=False, lineterminator="\n")


def write_parquet(data: xr.Dataset, path: Path) -> None:
    """One row a point; the attributes of the map are those of the table."""
    to_table(data).to_parquet(path, index=False)
