"""Loss maps as tables of points, and interpolation in them."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray, IntArray
from epicyclic.case.case import Case, read_case
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.messages import one_line
from epicyclic.study.operating import AXES, OPERATING, PLANE, STATE
from epicyclic.study.sweeps.run import csv_safe, to_table
from epicyclic.units import NEWTON_METRE, WATT

if TYPE_CHECKING:
    import xarray as xr


# Maps as tables of points: NetCDF, CSV, Parquet; what makes a dataset a map.

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
_MAKE_AGAIN = "Give a map from 'epicyclic map' or loss_map."


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
    """The statements of a map, and the values of its axes beyond `axes`, which have one each.

    All on one line, as comments of any program are.
    """
    single = {
        one_line(str(name)): one_line(
            f"{data[name].values[0]} {data[name].attrs.get('units', '')}", _LONGEST_STATEMENT
        )
        for name in data["torque_loss"].dims
        if name not in axes
    }
    if "ratio" in data and data["ratio"].size == 1:
        single["ratio"] = f"{data['ratio'].item():.15g}, input speed over output speed"
    return statements(data) | single


def driven_problem(why: str) -> Problem:
    """A map of two driven shafts, for what takes one; `why` ends the sentence."""
    remedy = "Set operation.fixed instead; in a train omit operation.speeds and operation.torques."
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
        allowed = f"is not a loss map; it lacks {', '.join(lacks)}."
        remedy = "Give a map from 'epicyclic map' or loss_map with all its axes."
        raise one_problem("", "", f"This dataset {allowed}", remedy, source)
    raise_any([*_axis_problems(data), *_value_problems(data)], source)


def _axis_problems(data: xr.Dataset) -> Iterator[Problem]:
    """Axes that cannot be looked up: of another unit, not finite, not rising."""
    for name, part in OPERATING.items():
        if name not in data.coords:
            continue
        axis = data[name]
        unit = axis.attrs.get("units")
        if unit not in (None, part.unit):  # arithmetic drops it; files must have it
            yield Problem(name, one_line(str(unit)), f"must be in {part.unit}.", _MAKE_AGAIN)
        if axis.dtype.kind not in "fiu" or axis.ndim != 1 or not axis.size:
            yield Problem(name, "", "must be numbers along its own axis.", _MAKE_AGAIN)
        elif not np.isfinite(axis.values).all():
            yield Problem(name, "", "must have finite values.", _MAKE_AGAIN)
        elif (np.diff(axis.values) <= 0).any():
            yield Problem(name, "", "must be increasing.", "Sort the map, as with .sortby.")


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


def check_gaps(data: xr.Dataset) -> None:
    """Raise `InputError` if points of a map failed."""
    gaps = np.isnan(data["torque_loss"].values)
    if not gaps.any():
        return
    reasons = data["message"].values[gaps] if "message" in data else []
    reason = next((f" The first: {one_line(str(text), 300)}" for text in reasons if text), "")
    allowed = f"is missing at {int(gaps.sum())} points, but all are needed.{reason}"
    raise one_problem("torque_loss", "", allowed, "Leave such torques and speeds out.", "the map")


def write_csv(data: xr.Dataset, path: Path) -> None:
    """One row a point, after lines that begin with ``#``."""
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {name}: {text}\n" for name, text in statements(data).items())
        csv_safe(to_table(data)).to_csv(file, index=False, lineterminator="\n")


def write_parquet(data: xr.Dataset, path: Path) -> None:
    """One row a point; the attributes of the map are those of the table."""
    to_table(data).to_parquet(path, index=False)


# Interpolation in a loss map: linear in speed, torque and temperature, within each state.
#
# Interpolated is the loss of each component over the magnitude of the speed of the reference shaft,
# its share of the torque loss, and not the power. Over the speed it is nearer to a straight line,
# and its limit at rest is in the map.

SUMS = ("load_dependent", "load_independent", "total", "input_power")
"""Variables in W of a map that are no component."""
_ROUNDING = 1e-9  # Part of an axis by which a point may leave the map, from conversions of units.


@dataclass(frozen=True, slots=True)
class Lookup:
    """A loss map, ready for interpolation."""

    # Names of the axes: speed, torque, temperature if there is an oil, state if there are any.
    names: tuple[str, ...]
    # Rising values of speed [rpm], torque [N m], temperature [degC]; states are numbered from 1.
    axes: tuple[FloatArray, ...]
    states: tuple[str, ...]  # Names of the states, none if there are none.
    components: tuple[str, ...]  # Names of the losses.
    torques: FloatArray  # Loss of each component over the magnitude of the speed. [N m]

    @property
    def size(self) -> int:
        """Number of nodes."""
        return int(np.prod(self.torques.shape[1:]))

    @property
    def total(self) -> FloatArray:
        """Torque loss at all nodes, in one row. [N m]"""
        sums: FloatArray = self.torques.sum(axis=0).ravel()
        return sums

    def corners(
        self,
        *point: FloatArray,  # As the axes, in their units.
    ) -> tuple[IntArray, FloatArray]:
        """The nodes around points, counted as in `total`, and their weights, both (corners, n).

        A point outside is taken at the border.
        """
        brackets = [_bracket(axis, values) for axis, values in zip(self.axes, point, strict=True)]
        sides = [range(min(axis.size, 2)) for axis in self.axes]
        nodes, weights = [], []
        for corner in itertools.product(*sides):
            index = [low + side for (low, _), side in zip(brackets, corner, strict=True)]
            nodes.append(np.ravel_multi_index(index, self.torques.shape[1:]))
            parts = [
                part if side else 1 - part for (_, part), side in zip(brackets, corner, strict=True)
            ]
            weights.append(np.prod(parts, axis=0))
        return np.array(nodes), np.array(weights)

    def outside(self, *point: FloatArray) -> BoolArray:
        """Which points lie outside of the map. Parameters as for `corners`."""
        found = np.zeros(point[0].shape, dtype=bool)
        for axis, values in zip(self.axes, point, strict=True):
            found |= (values < axis[0] - slack(axis)) | (values > axis[-1] + slack(axis))
        return found

    def thinned(self) -> Lookup:
        """The same with every second node of each axis left out, interpolated at all nodes."""
        kept = [
            np.arange(axis.size)
            if name == STATE
            else np.unique(np.append(np.arange(0, axis.size, 2), axis.size - 1))
            for name, axis in zip(self.names, self.axes, strict=True)
        ]
        count = len(self.components)
        coarse = replace(
            self,
            axes=tuple(axis[chosen] for axis, chosen in zip(self.axes, kept, strict=True)),
            torques=self.torques[np.ix_(np.arange(count), *kept)],
        )
        grid = [values.ravel() for values in np.meshgrid(*self.axes, indexing="ij")]
        nodes, weights = coarse.corners(*grid)
        values = (coarse.torques.reshape(count, -1)[:, nodes] * weights).sum(axis=1)
        return replace(self, torques=values.reshape(self.torques.shape))


def _bracket(axis: FloatArray, values: FloatArray) -> tuple[IntArray, FloatArray]:
    """Number of the value of `axis` below each of `values`, and the part of the way to the next."""
    if axis.size == 1:
        return np.zeros(values.shape, dtype=np.intp), np.zeros(values.shape)
    low = np.clip(np.searchsorted(axis, values, side="right") - 1, 0, axis.size - 2)
    return low, np.clip((values - axis[low]) / np.diff(axis)[low], 0, 1)


def slack(axis: FloatArray) -> float:
    """By how much a point may leave an axis before it lies outside."""
    return _ROUNDING * max(float(np.ptp(axis)), float(np.abs(axis).max()))


def make_lookup(data: xr.Dataset, *, gaps: bool = False) -> Lookup:
    """A loss map for interpolation.

    At rest, where no power is lost, the torque loss is split between the components as at the
    slowest speed beside it. Raises `InputError` if `data` is no map, has `gaps` that it may not
    have, further axes, or two driven members.
    """
    check_map(data)
    _check_usable(data)
    if not gaps:
        check_gaps(data)
    names = tuple(name for name in (*AXES, STATE) if name in data["torque_loss"].dims)
    chosen = data.isel({name: 0 for name in data["torque_loss"].dims if name not in names})
    states = tuple(map(str, chosen[STATE].values)) if STATE in names else ()
    axes = tuple(
        np.arange(1.0, len(states) + 1) if name == STATE else chosen[name].values.astype(float)
        for name in names
    )
    components = [
        str(name)
        for name, array in chosen.data_vars.items()
        if array.attrs.get("units") == WATT.display and name not in SUMS
        if not array.isnull().all()  # left out of the case
    ]
    shape = [chosen.sizes[name] for name in names]
    watts = np.array([chosen[name].transpose(*names).fillna(0).values for name in components])
    watts = watts.reshape(len(components), *shape)
    moving = np.flatnonzero(axes[0])[::-1]  # rest takes the nearest of these, rather the positive
    watts = watts[:, moving[np.abs(moving[:, None] - np.arange(axes[0].size)).argmin(axis=0)]]
    total = watts.sum(axis=0)
    shares = watts / np.where(total > 0, total, 1.0)
    torque_loss = np.nan_to_num(chosen["torque_loss"].transpose(*names).values)
    return Lookup(names, axes, states, tuple(components), shares * torque_loss)


def _check_usable(data: xr.Dataset) -> None:
    problems = []
    for name in data["torque_loss"].dims:
        if name not in (*AXES, STATE) and data.sizes[name] > 1:
            allowed = f"has {data.sizes[name]} values, but only one can be used."
            remedy = f"Select one, as with .isel({name}=[0])."
            problems.append(Problem(str(name), "", allowed, remedy))
    if not data.attrs["held_shaft"]:
        problems.append(driven_problem("only one speed and one torque can be looked up"))
    if not data["speed"].values.any():
        remedy = "Compute a map with other speeds."
        problems.append(Problem("speed", "", "has only the value zero.", remedy))
    raise_any(problems, "the map")
