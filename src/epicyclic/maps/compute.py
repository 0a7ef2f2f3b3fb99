"""Loss maps: losses, torque loss and efficiency over speed, torque and oil temperature.

The torque loss refers to the input member, `reference_shaft` in the attributes: the power loss over
the magnitude of the speed of that shaft. With it the torque that the shaft passes on is the torque
on it less the torque loss times the sign of its speed, driving and coasting.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from epicyclic.builders.build import layout_of
from epicyclic.case.case import Case, PlanetaryCase
from epicyclic.errors import InputError, Problem
from epicyclic.results.result import number_fields
from epicyclic.sweeps.dataset import to_dataset
from epicyclic.sweeps.journal import Rows
from epicyclic.sweeps.plan import Axis, SweepPlan, make_plan
from epicyclic.sweeps.runner import Progress, Runner
from epicyclic.units import NEWTON_METRE, RPM, WATT

if TYPE_CHECKING:
    import xarray as xr

__all__ = [
    "AXES",
    "MapPlan",
    "axis_name",
    "coordinates",
    "held_shaft",
    "loss_map",
    "map_plan",
    "to_map",
]

AXES = {
    "speed": "operation.speed",
    "torque": "operation.torque",
    "temperature": "operation.oil_inlet_temperature",
}
"""Dimensions that every map has, and their keys."""
_SHAFT_KEYS = ("operation.input", "operation.fixed", "operation.second_input")
"""Keys that decide which shaft is the reference, and which the output."""
_CREEP = 1e-9
"""Speed that stands for slow motion; losses over speed have reached their limit by then. [rpm]"""


@dataclass(frozen=True, slots=True)
class MapPlan(SweepPlan):
    """The points of a map."""

    kind: ClassVar[str] = "map"

    @property
    def batch(self) -> int:
        """Points next to each other that differ in torque only."""
        return len(self.axes[-1].values)


def loss_map(
    case: Case,
    speed: Iterable[Any],
    torque: Iterable[Any],
    temperature: Iterable[Any] | None = None,
    vary: Mapping[str, Iterable[Any]] | None = None,
    *,
    jobs: int | None = None,
    dask: str | None = None,
    shard: tuple[int, int] | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Losses over speed, torque and oil temperature.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
    speed, torque : iterable
        Of the input member (the pinion of a pair), as text with units. A torque against the speed
        is coasting.
    temperature : iterable, optional
        Oil inlet temperatures. Default: that of the case.
    vary : mapping of str to iterable, optional
        Further keys and their values, as for `sweep`.
    jobs, dask, shard, journal, progress
        As for `sweep`.

    Returns
    -------
    xarray.Dataset
        Dimensions ``speed`` [rpm], ``torque`` [N m], ``temperature`` [degC], rising, and one for
        each further key, its dots replaced by underscores. ``torque_loss`` [N m] is the power loss
        over the magnitude of the input speed; the losses of the components and their sums [W],
        ``efficiency`` [1], and speeds and torques of all members stand beside it. At zero speed
        powers are zero, and torques, torque loss and efficiency are the limits of slow motion in
        positive direction; but the torque loss is NaN there if a second member is driven. The
        efficiency is NaN where no power is passed on. Points that failed are NaN, with status
        ``"failed"``. The attributes state the reference shaft and the signs.

    Raises
    ------
    InputError
        As for `sweep`, and for keys that decide which shaft is which.
    """
    runner = Runner(jobs, dask, shard, journal, progress)
    plan = map_plan(case, speed, torque, temperature, vary)
    return to_map(plan, runner.run(plan))


def map_plan(
    case: Case,
    speed: Iterable[Any],
    torque: Iterable[Any],
    temperature: Iterable[Any] | None = None,
    vary: Mapping[str, Iterable[Any]] | None = None,
) -> MapPlan:
    """The points of a map. Parameters as for `loss_map`."""
    further = dict(vary or {})
    problems = [_own_option(key) for key in further if key in AXES.values()]
    problems += [_shaft_key(key) for key in further if key in _SHAFT_KEYS]
    if problems:
        raise InputError(problems, "the map")
    if temperature is None:
        temperature = [case.inputs()["operation"]["oil_inlet_temperature"]]
    # torque innermost: flows through pockets, which cost most, do not depend on its magnitude
    given = {AXES["temperature"]: temperature, AXES["speed"]: speed, AXES["torque"]: torque}
    plan = make_plan(case, {**further, **given})
    turns_alone = not _has_second_input(case)
    return MapPlan(case, tuple(_prepared(axis, turns_alone) for axis in plan.axes))


def _own_option(key: str) -> Problem:
    (name,) = (name for name, own in AXES.items() if own == key)
    return Problem(key, "", f"is varied by {name}.", f"Give its values there, as --{name}.")


def _shaft_key(key: str) -> Problem:
    allowed = "decides which shaft is which, and stays the same in a map."
    return Problem(key, "", allowed, "Make a map of each.")


def held_shaft(case: Case) -> str:
    """The member that stands still, or the housing of a pair; empty if all shafts turn."""
    return (case.operation.fixed or "") if isinstance(case, PlanetaryCase) else "housing"


def _has_second_input(case: Case) -> bool:
    return isinstance(case, PlanetaryCase) and case.operation.second_input is not None


def _prepared(axis: Axis, turns_alone: bool) -> Axis:
    """Operating axes in rising order, zero speed replaced by slow motion."""
    if axis.key not in AXES.values():
        return axis
    order = np.argsort(np.array(axis.coordinate, float))
    points = [(axis.values[i], axis.coordinate[i]) for i in order]
    if axis.key == AXES["speed"] and turns_alone:
        creep = (f"{_CREEP} {RPM.display}", _CREEP)
        points = [creep if coordinate == 0 else (value, coordinate) for value, coordinate in points]
    values, coordinate = zip(*points, strict=True)
    return replace(axis, values=values, coordinate=coordinate)


def coordinates(plan: MapPlan) -> dict[str, tuple[float | str, ...]]:
    """Values of the axes of the map of `plan`, by their names in it."""
    values = {axis_name(axis.key): axis.coordinate for axis in plan.axes}
    values["speed"] = tuple(0.0 if value == _CREEP else value for value in values["speed"])
    return values


def axis_name(key: str) -> str:
    """Name of the dimension of a key: ``"planet_count"`` for ``"planet.count"``."""
    names = {own: name for name, own in AXES.items()}
    return names.get(key, key.replace(".", "_"))


def to_map(plan: MapPlan, rows: Rows) -> xr.Dataset:
    """The map of `plan` from the rows of all its points."""
    data = to_dataset(plan, rows)[[*_kept_variables(plan.case), "status", "message", "warnings"]]
    data = data.rename({axis.key: axis_name(axis.key) for axis in plan.axes})
    data = data.transpose(*AXES, ...)
    to_rpm, _ = RPM.scale_and_offset()
    torque_loss = data["total"] / (abs(data["speed"]) / to_rpm).where(data["speed"] != 0)
    torque_loss.attrs = {
        "long_name": f"torque loss at the {_members(plan.case)[0]}",
        "units": NEWTON_METRE.display,
    }
    data = data.assign(torque_loss=torque_loss.transpose(*data["total"].dims))
    data = _at_rest(data)
    for axis in plan.axes:
        data[axis_name(axis.key)].attrs["case_key"] = axis.key
    data.attrs = _attributes(plan, data.attrs)
    return data[["torque_loss", *(name for name in data.data_vars if name != "torque_loss")]]


def _kept_variables(case: Case) -> list[str]:
    """Losses, their sums, efficiency, and speeds and torques of the members."""
    shafts = [f"{name}_{what}" for name in _all_members(case) for what in ("speed", "torque")]
    return [
        item.key
        for item in number_fields(layout_of(case))
        if item.unit == WATT.display or item.key == "efficiency" or item.key in shafts
    ]


def _at_rest(data: xr.Dataset) -> xr.Dataset:
    """The map with powers and speeds of slow motion replaced by zero."""
    creeps = data["speed"] == _CREEP
    for name, array in data.data_vars.items():
        if array.attrs.get("units") in (WATT.display, RPM.display):
            data[name] = array.where(~creeps | array.isnull(), 0.0).transpose(*array.dims)
            data[name].attrs = array.attrs
    rest = data["speed"].where(~creeps, 0.0)
    rest.attrs = data["speed"].attrs
    return data.assign_coords(speed=rest)


def _all_members(case: Case) -> tuple[str, ...]:
    return layout_of(case).members


def _members(case: Case) -> tuple[str, str]:
    """The reference shaft and the output shaft."""
    if not isinstance(case, PlanetaryCase):
        return "pinion", "gear"
    operation = case.operation
    (output,) = set(layout_of(case).members) - {
        operation.input,
        operation.fixed or operation.second_input,
    }
    return operation.input, output


def _attributes(plan: MapPlan, given: Mapping[str, str]) -> dict[str, str]:
    reference, output = _members(plan.case)
    text = {
        "title": given["title"],
        "source": given["source"],
        "reference_shaft": reference,
        "output_shaft": output,
        "held_shaft": held_shaft(plan.case),
        "sign_convention": f"speed and torque are those of the {reference}; speeds are positive in "
        "one common sense of rotation, torques act on the gear set from outside; torque times "
        "speed > 0: the shaft drives, < 0: it is driven (coasting); losses are never negative",
        "torque_loss_definition": f"power loss over the magnitude of the speed of the {reference}: "
        f"the torque passed on, at the {reference}, is torque - sign(speed) * torque_loss, in both "
        "directions of the power",
        "zero_speed": "powers are 0; torque loss, torques and efficiency are the limits of slow "
        "motion in positive direction, without friction of rest",
        "zero_torque": "efficiency has no value; the torque loss is that of the drag",
        "conventions": "losses in W of the whole gear set, summed over planets; efficiency: power "
        "that leaves over power that enters, 0 if the loss takes all of it",
        "pocketing": given["pocketing"],
        "versions": given["versions"],
        "case": given["case"],
    }
    if _has_second_input(plan.case):
        text["zero_speed"] = f"no torque loss: a second member is driven while the {reference} "
        text["zero_speed"] += "stands still"
    return text
