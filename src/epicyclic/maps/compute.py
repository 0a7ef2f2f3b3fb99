"""Loss maps: losses, torque loss and efficiency over speed, torque and oil temperature.

A train has its states of brakes and clutches as a further dimension; one whose losses are all given
has no oil, and no temperature.

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
from epicyclic.case.nearest import did_you_mean
from epicyclic.case.operating import AXES, STATE, STATE_KEY, axis_name
from epicyclic.case.train import TrainCase
from epicyclic.case.wording import written
from epicyclic.elements.base import HOUSING
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.maps.interpolation_error import written_values
from epicyclic.maps.near_zero import resolving_texts, torque_interpolation
from epicyclic.maps.tables import check_map, map_case
from epicyclic.results.result import Layout, number_fields
from epicyclic.sweeps.axes import Axis
from epicyclic.sweeps.dataset import by_keys, to_dataset
from epicyclic.sweeps.journal import Rows
from epicyclic.sweeps.plan import SweepPlan, make_plan
from epicyclic.sweeps.runner import Progress, Runner
from epicyclic.units import NEWTON_METRE, RPM, WATT

if TYPE_CHECKING:
    import xarray as xr

_OWN_AXES = {**AXES, STATE: STATE_KEY}
_SHAFT_KEYS = (
    "operation.input",
    "operation.output",
    "operation.fixed",
    "operation.second_input",
)
"""Keys that decide which shaft is the reference, and which the output."""
_SUMS = (
    "load_dependent",
    "load_independent",
    "total",
    "input_power",
    "efficiency",
    "ratio",
    "power_ratio",
)
_TEMPERATURES = {
    "inlet": "everything is at the temperature of the oil inlet",
    "flank": "temperature is that of the oil; flanks are as hot as their own losses make them",
    "network": "temperature is that of the oil inlet; the oil in the gearbox and all parts are as "
    "hot as the losses make them in the long run",
}
"""What the axis of temperatures means, by ``models.temperatures``."""
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
    states: Iterable[Any] | None = None,
    resolve_zero: bool = False,
    jobs: int | None = None,
    dask: str | None = None,
    shard: tuple[int, int] | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Losses over speed, torque and oil temperature.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
    speed, torque : iterable
        Speeds and torques of the input member (the pinion of a pair, the input shaft of a train),
        as text with units.
        A torque against the speed is coasting.
    temperature : iterable, optional
        Oil inlet temperatures. Default: that of the case.
    vary : mapping of str to iterable, optional
        Further keys and their values, as for `sweep`.
    states : iterable, optional
        States of a train. Default: all in which it can run; the attribute ``states_left_out``
        names the others.
    resolve_zero : bool
        True to add torques that crowd at zero, where losses rise steeply, if zero is among the
        torques or between them.
    jobs, dask, shard, journal, progress
        As for `sweep`.

    Returns
    -------
    xarray.Dataset
        Dimensions ``speed`` [rpm], ``torque`` [N m], ``temperature`` [degC], rising, ``state`` of
        a train with states, and one for each further key, its dots replaced by underscores. A train
        whose losses are all given has no temperature. ``torque_loss`` [N m] is the power loss
        over the magnitude of the input speed; the losses of the components and their sums [W],
        ``efficiency`` [1], and speeds and torques of all members stand beside it; of a train also
        ``power_ratio`` and, over the state, ``ratio``. At zero speed
        powers are zero, and torques, torque loss and efficiency are the limits of slow motion in
        positive direction; but the torque loss is NaN there if a second member is driven. The
        efficiency is NaN where nothing is lost. Points that failed are NaN, with status
        ``"failed"``. The attributes state the reference shaft, the signs, and how far linear
        interpolation between the torques is off.

    Raises
    ------
    InputError
        As for `sweep`, for keys that decide which shaft is which, and for states that are not there
        or in which the train cannot run.
    """
    runner = Runner(jobs, dask, shard, journal, progress)
    torques = resolving_texts(torque) if resolve_zero else torque
    plan = map_plan(case, speed, torques, temperature, vary, states)
    return checked_map(plan, runner.run(plan))


def checked_map(plan: MapPlan, rows: Rows) -> xr.Dataset:
    """The map of `plan`, with what it states about interpolation between its torques."""
    data = to_map(plan, rows)
    return data.assign_attrs(torque_interpolation(data, plan.case))


def map_plan(
    case: Case,
    speed: Iterable[Any],
    torque: Iterable[Any],
    temperature: Iterable[Any] | None = None,
    vary: Mapping[str, Iterable[Any]] | None = None,
    states: Iterable[Any] | None = None,
) -> MapPlan:
    """The points of a map. Parameters as for `loss_map`."""
    further = dict(vary or {})
    problems = [_own_option(key) for key in further if key in _OWN_AXES.values()]
    problems += [_shaft_key(key) for key in further if key in _SHAFT_KEYS]
    chosen, found = _states(case, states)
    problems += found
    if temperature is not None and not case.computed:
        allowed = "has no effect: every loss of the train is given."
        problems.append(Problem("temperature", "", allowed, "Leave it out."))
    raise_any(problems, "the map")
    given: dict[str, Iterable[Any]] = {}
    if chosen:
        given[STATE_KEY] = chosen
    if case.computed:
        if temperature is None:
            temperature = [case.inputs()["operation"]["oil_inlet_temperature"]]
        given[AXES["temperature"]] = temperature
    # torque innermost: flows through pockets, which cost most, do not depend on its magnitude
    given |= {AXES["speed"]: speed, AXES["torque"]: torque}
    plan = make_plan(case, {**further, **given})
    turns_alone = not _drives_others(case)
    return MapPlan(case, tuple(_prepared(axis, turns_alone) for axis in plan.axes))


def stored_plan(data: xr.Dataset) -> MapPlan:
    """The plan by which a map was computed.

    Raises
    ------
    InputError
        If `data` is no map, or its case is none of this version.
    """
    check_map(data)
    case = map_case(data)
    if case is None:
        allowed = "is none of this version of the program."
        problem = Problem("case", "", allowed, "Compute the map again.")
        raise InputError([problem], "the map")
    values = {str(name): written_values(data[name]) for name in data["torque_loss"].dims}
    own = {name: values.pop(name, None) for name in (*AXES, STATE)}
    further = {str(data[name].attrs["case_key"]): texts for name, texts in values.items()}
    speed, torque, temperature, states = own.values()
    return map_plan(case, speed or (), torque or (), temperature, further, states)


def _own_option(key: str) -> Problem:
    (name,) = (name for name, own in _OWN_AXES.items() if own == key)
    option = "states" if name == STATE else name
    return Problem(key, "", f"is varied by {option}.", f"Give its values there, as --{option}.")


def _shaft_key(key: str) -> Problem:
    allowed = "decides which shaft is which, and stays the same in a map."
    return Problem(key, "", allowed, "Make a map of each.")


def _states(case: Case, chosen: Iterable[Any] | None) -> tuple[list[str], list[Problem]]:
    """The states of a map, and what is wrong with those that were chosen."""
    known = list(case.states)
    if not known:
        if chosen is None:
            return [], []
        allowed = "cannot be chosen: the case has none."
        return [], [Problem("states", "", allowed, "Leave them out.")]
    if chosen is None:
        left_out = states_left_out(case)
        able = [name for name in known if name not in left_out]
        return able, [] if able else [_unable(*item) for item in left_out.items()]
    names = [str(name) for name in ([chosen] if isinstance(chosen, str) else chosen)]
    problems = [
        Problem(
            "states",
            written(name),
            "is no state of the train.",
            did_you_mean(name, known) or f"Known are: {', '.join(known)}.",
        )
        for name in dict.fromkeys(names)
        if name not in known
    ]
    left_out = states_left_out(case, [name for name in names if name in known])
    problems += [_unable(*item) for item in left_out.items()]
    return names, problems


def _unable(name: str, reason: str) -> Problem:
    return Problem("states", written(name), reason, "Leave this state out.")


def states_left_out(case: Case, names: Iterable[str] | None = None) -> dict[str, str]:
    """Those of the states `names`, by default all, in which a train cannot run, and why."""
    left_out = {}
    for name in case.states if names is None else names:
        try:
            case.updated({STATE_KEY: name})
        except InputError as error:
            left_out[name] = error.problems[0].allowed
    return left_out


def held_shaft(case: Case) -> str:
    """What takes up the difference of the torques of input and output.

    The member that stands still, or the housing of a pair or train; empty if a further shaft is
    driven.
    """
    if isinstance(case, PlanetaryCase):
        return case.operation.fixed or ""
    if isinstance(case, TrainCase) and (case.operation.speeds or case.operation.torques):
        return ""
    return HOUSING


def _drives_others(case: Case) -> bool:
    """True if a further shaft turns while the reference shaft stands still."""
    if isinstance(case, TrainCase):
        return bool(case.operation.speeds)
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


def to_map(plan: MapPlan, rows: Rows) -> xr.Dataset:
    """The map of `plan` from the rows of all its points."""
    layout = layout_of(plan.case)
    data = by_keys(to_dataset(plan, rows))[
        [*_kept_variables(layout), "status", "message", "warnings"]
    ]
    data = data.rename({axis.key: axis_name(axis.key) for axis in plan.axes})
    data = data.transpose(*(name for name in (*AXES, STATE) if name in data.dims), ...)
    to_rpm, _ = RPM.scale_and_offset()
    torque_loss = data["total"] / (abs(data["speed"]) / to_rpm).where(data["speed"] != 0)
    torque_loss.attrs = {
        "long_name": f"torque loss at the {_ends(plan.case)[0]}",
        "units": NEWTON_METRE.display,
    }
    data = data.assign(torque_loss=torque_loss.transpose(*data["total"].dims))
    data = _at_rest(data)
    if "ratio" in data and not _drives_others(plan.case):
        data["ratio"] = _one_ratio(data["ratio"])
    for axis in plan.axes:
        data[axis_name(axis.key)].attrs["case_key"] = axis.key
    data.attrs = _attributes(plan, data.attrs)
    return data[["torque_loss", *(name for name in data.data_vars if name != "torque_loss")]]


def _one_ratio(ratio: xr.DataArray) -> xr.DataArray:
    """The ratio without the axes that it does not depend on."""
    operating = [name for name in AXES if name in ratio.dims]
    points = ratio.stack(point=operating).transpose("point", ...)
    known = points.notnull().argmax("point")  # the first point that did not fail
    found = points.isel(point=known).drop_vars(["point", *operating], errors="ignore")
    return found.assign_attrs(ratio.attrs)


def _kept_variables(layout: Layout) -> list[str]:
    """Losses, their sums, efficiency, ratios, speeds and torques of members, temperatures."""
    kept = {*layout.losses, *_SUMS}
    kept |= {f"{name}_{what}" for name in layout.members for what in ("speed", "torque")}
    kept |= {f"{node}_temperature" for node in layout.nodes}
    return [item.key for item in number_fields(layout) if item.key in kept]


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


def _ends(case: Case) -> tuple[str, str]:
    """The reference shaft and the output shaft."""
    if isinstance(case, TrainCase):
        ends = (case.operation.input, case.operation.output)
        reference, output = (case.shape.shaft_of(name) or "" for name in ends)
        return reference, output
    if not isinstance(case, PlanetaryCase):
        return "pinion", "gear"
    operation = case.operation
    (output,) = set(layout_of(case).members) - {
        operation.input,
        operation.fixed or operation.second_input,
    }
    return operation.input, output


def _attributes(plan: MapPlan, given: Mapping[str, str]) -> dict[str, str]:
    reference, output = _ends(plan.case)
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
        "zero_torque": "efficiency is 0, there and wherever the loss takes all of the power; the "
        "torque loss is that of drag and of teeth that drive it",
        "temperatures": _TEMPERATURES[plan.case.models.temperatures],
        "conventions": "losses in W of the whole gear set, summed over planets; efficiency: power "
        "that leaves over power that enters, 0 if the loss takes all of it",
        "pocketing": given["pocketing"],
        "versions": given["versions"],
        "case": given["case"],
    }
    if _drives_others(plan.case):
        text["zero_speed"] = f"no torque loss: a second member is driven while the {reference} "
        text["zero_speed"] += "stands still"
    chosen = {axis_name(axis.key): axis.coordinate for axis in plan.axes}.get(STATE, ())
    left_out = states_left_out(plan.case).items()
    reasons = [f"{name}: {reason}" for name, reason in left_out if name not in chosen]
    if reasons:
        text["states_left_out"] = " ".join(reasons)
    return text
