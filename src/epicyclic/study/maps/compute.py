"""Loss maps: computed over speed, torque and temperature, resolved near zero torque."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.arrays import FloatArray
from epicyclic.build.machine import build, layout_of, operation_of
from epicyclic.build.models import set_cases
from epicyclic.case.case import Case, TrainCase
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import InputError, Problem, Status, one_problem, raise_any
from epicyclic.gears.gear import HOUSING
from epicyclic.machine.element import OIL
from epicyclic.machine.heat import NetworkModel
from epicyclic.messages import did_you_mean, written
from epicyclic.result.result import Layout, number_fields
from epicyclic.study.heat import with_network
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.maps.tables import SUMS, Lookup, check_map, map_case, map_inputs
from epicyclic.study.operating import AXES, CASE_KEY, OPERATING, STATE, STATE_KEY, axis_name, key_of
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.axes import Axis
from epicyclic.study.sweeps.run import (
    INTERPOLATION_ERROR,
    PointList,
    SweepPlan,
    by_keys,
    make_plan,
    to_dataset,
)
from epicyclic.study.sweeps.runner import HERE, Progress, Row, Rows, Runner
from epicyclic.units import NEWTON_METRE, RPM, WATT, format_number, torque_text

if TYPE_CHECKING:
    import xarray as xr


# How far the energy lost over a duty cycle is off, because a map is interpolated.
#
# A sample of the points is solved directly. They are drawn with a probability that grows with the
# energy that they lose, in one pass over points of unknown number: a point of energy w gets the key
# E/w, E from the exponential distribution, and the smallest keys stay (Efraimidis and Spirakis,
# Information Processing Letters 97 (2006) 181). With tau the smallest key left out, such a point
# had the probability p = 1 - exp(-w tau) to stay, and the sum of x/p over the sample estimates the
# sum of x over all points, with the variance (1 - p) x^2/p^2 of each, uncorrelated (Cohen and
# Kaplan, PODC 2007, 225). A cycle of no more points than the sample is summed exactly.

_SEED = 0  # The same cycle and map give the same sample.


@dataclass(frozen=True, slots=True)
class Deviation:
    """What interpolation adds to the energy lost."""

    energy: float  # Estimate of the energy by interpolation less that by direct solution. [J]
    standard_error: float  # Standard error of the estimate, because only a sample is solved. [J]
    # Largest deviation of the loss of one point of the sample, relative to its direct solution.
    largest: float
    method: str  # How it was found.


class Sample:
    """A sample of the points of a cycle."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._random = np.random.default_rng(_SEED)
        self._keys = np.empty(0)
        self._rows = np.empty((0, 0))

    def add(self, point: Sequence[FloatArray], power: FloatArray, energy: FloatArray) -> None:
        """Offer points as the axes of the map, in their units; W and J."""
        rows = np.stack([*point, power, energy], axis=1)[energy > 0]
        self._keys = np.append(self._keys, self._random.exponential(size=len(rows)) / rows[:, -1])
        self._rows = np.concatenate([self._rows, rows]) if self._rows.size else rows
        stay = np.argsort(self._keys)[: self._size + 1]
        self._keys, self._rows = self._keys[stay], self._rows[stay]

    def drawn(self) -> tuple[FloatArray, FloatArray]:
        """Rows of the values of the axes, power, energy; and the probability of each."""
        rows = self._rows[: self._size]
        threshold = self._keys[self._size] if self._keys.size > self._size else math.inf
        return rows, -np.expm1(-rows[:, -1] * threshold)


def further_values(data: xr.Dataset) -> dict[str, Any]:
    """The keys of the axes of a map beyond its own, which have one value each, and these."""
    return {
        str(values.attrs[CASE_KEY]): written_values(values)[0]
        for name, values in data.coords.items()
        if CASE_KEY in values.attrs and name not in (*AXES, STATE)
    }


def written_values(axis: xr.DataArray) -> list[Any]:
    """The values of an axis as a case has them."""
    unit = axis.attrs.get("units", "1")
    return [
        number if isinstance(number, str) or unit == "1" else f"{number!r} {unit}"
        for number in axis.values.ravel().tolist()
    ]


def solve_sample(case: Case, lookup: Lookup, sample: Sample, runner: Runner = HERE) -> Deviation:
    """The deviation by direct solution of the points of `sample`."""
    rows, chance = sample.drawn()
    exact = case.updated({"numerics.pocket_interpolation": 0})
    plan = PointList(exact, tuple(changes_at(lookup, row) for row in rows.tolist()))
    direct = runner.within(plan).run(plan).numbers("total")
    found = np.isfinite(direct)
    method = f"{found.sum()} points of the cycle solved directly"
    if not found.all():
        method += f", {(~found).sum()} more without a solution"
    if not found.any():
        return Deviation(math.nan, math.nan, math.nan, method)
    power, energy = rows[found, -2], rows[found, -1]
    direct, chance = direct[found], chance[found]
    difference = energy * (power - direct) / power / chance
    return Deviation(
        float(difference.sum()),
        float(np.sqrt(np.sum((1 - chance) * difference**2))),
        float(np.abs(power / direct - 1).max()),
        method,
    )


def changes_at(lookup: Lookup, row: Sequence[float]) -> dict[str, str]:
    """The keys that make a case of a point of a cycle."""
    point = dict(zip(lookup.names, row, strict=False))
    changes = {
        part.key: part.text(point[name]) for name, part in OPERATING.items() if name in point
    }
    if STATE in point:
        changes[STATE_KEY] = lookup.states[round(point[STATE]) - 1]
    return changes


def leave_out(lookup: Lookup, node_work: FloatArray) -> Deviation:
    """The deviation of a map of every second node from the whole one: more than that of the latter.

    `node_work` is the angle turned through at each node. [rad]
    """
    thinned = lookup.thinned()
    difference = float(node_work @ (thinned.total - lookup.total))
    used = node_work > 0
    relative = np.abs(thinned.total - lookup.total)[used] / lookup.total[used]
    method = "map with every second node left out against the whole map; an upper estimate"
    return Deviation(difference, math.nan, float(relative.max(initial=0.0)), method)


# Torques that resolve zero, and how far a map is off between its torques.
#
# Near zero torque the rolling loss rises like a root, and at the torque that just drives the drag
# behind a mesh the loss has a kink. A map that is read linearly needs torques there that crowd.

RATIO = 2.0
"""Between torques that crowd at zero: a loss that rises like a root is then met to 2 % of the part
that rises. [1]"""
CROWD = 8
"""Torques between zero and the smallest of an even spacing, which is 250 times the least: more make
no map of the test article or of an eight-speed gearbox 2 % better anywhere. Fewer where the spacing
misses zero, so that the least is that part of it too."""
CHECKED_NEAR_ZERO, CHECKED_WHERE_BENT, CHECKED_BEYOND = 4, 4, 4
"""Intervals on each side of zero, where the loss bends most, and of all others, in whose middle a
map is checked."""
CLOSER_TO_ZERO = (1 / 8, 1 / 32)
"""Where it is checked too in the first interval on each side, from its end at zero. [1]"""


def resolving_zero(
    torques: Iterable[float],
    crowd: int = CROWD,  # How many on each side.
) -> list[float]:
    """`torques`, and on each side of zero that they reach more that crowd there, and zero.

    Returns list of float: rising. As given if zero is not among them or between them.

    Examples
    --------
    >>> resolving_zero([0.0, 40.0, 80.0], crowd=4)
    [0.0, 2.5, 5.0, 10.0, 20.0, 40.0, 80.0]
    >>> resolving_zero([-40.0, -5.0, 30.0], crowd=1)
    [-40.0, -20.0, -10.0, -5.0, 0.0, 15.0, 30.0]
    """
    given = np.unique(np.array(list(torques), dtype=float))
    if not given.size or given[0] > 0 or given[-1] < 0:
        return list(map(float, given))
    found = [*given, 0.0]
    for sign in (-1.0, 1.0):
        end, second = [*np.sort(sign * given[sign * given > 0])[:2], 0.0, 0.0][:2]
        # the first torque of an even spacing that misses zero is nearer to it
        spacing = end if 0.0 in given else max(end, second - end)
        nearer = round(math.log(spacing / end, RATIO)) if end else 0
        found += [sign * end * RATIO**-step for step in range(1, crowd - nearer + 1)]
        # and leaves a wide gap behind it
        steps = round(math.log(second / end, RATIO)) if second else 0
        found += [sign * second * RATIO**-step for step in range(1, steps)]
    return list(map(float, np.unique(found) + 0.0))  # no -0.0


def resolving_texts(torques: Iterable[Any]) -> list[Any]:
    """`torques` with units, and those that resolve zero; as given if one is no torque."""
    given = list(torques)
    try:
        values = [NEWTON_METRE.to_display(NEWTON_METRE.parse(torque)) for torque in given]
    except PydanticCustomError:
        return given
    return [f"{torque!r} {NEWTON_METRE.display}" for torque in resolving_zero(values)]


@dataclass(frozen=True, slots=True)
class _Totals(PointList):
    """Points of which nothing but the total loss is read."""

    def _row_of(self, answer: Any) -> Row:
        converged = answer.status is Status.CONVERGED
        return Row(str(answer.status), numbers={"total": answer.total} if converged else {})


def torque_interpolation(data: xr.Dataset, case: Case) -> dict[str, str | float]:
    """What a map says of the error of linear interpolation between its torques.

    Measured where it is largest, near zero torque, and at some torques beyond: between torques of
    the map, at the middle one of its speeds, the slowest one, where little is lost, and the first
    value of all other axes, the loss is solved directly.

    Returns dict: ``torque_interpolation_error`` at the middle speed, relative [1], and
    ``torque_interpolation`` in words; nothing if there is only one torque, no point can be solved,
    or one takes minutes.
    """
    torques = data["torque"].values.astype(float)
    speeds = data["speed"].values[data["speed"].values != 0]
    takes_minutes = any(own.models.friction == "ehl-direct" for own in set_cases(case).values())
    if torques.size < 2 or not speeds.size or takes_minutes:
        return {}
    first = {name: 0 for name in data["total"].dims if name not in ("speed", "torque")}
    ends = dict.fromkeys((float(speeds[speeds.size // 2]), float(min(speeds, key=abs))))
    lines = [data.sel(speed=speed).isel(first) for speed in ends]
    middles = [_checked(torques, line["total"].values) for line in lines]
    points, torque = list[dict[str, Any]](), OPERATING["torque"]
    for line, own in zip(lines, middles, strict=True):
        fixed = line.drop_vars("torque").coords.values()
        changes = {key_of(values): written_values(values)[0] for values in fixed}
        points += [changes | {torque.key: torque.text(middle)} for middle in own.tolist()]
    direct = Runner(jobs=1).run(_Totals(case, tuple(points))).numbers("total")
    found, texts = [], []
    for speed, line, own in zip(ends, lines, middles, strict=True):
        exact, direct = direct[: own.size], direct[own.size :]
        read = np.interp(own, torques, line["total"].values)
        with np.errstate(divide="ignore", invalid="ignore"):
            error = np.abs(read / exact - 1).round(12)  # less is rounding
            watts = np.where(exact > 0, error * exact, read)
        if not np.isnan(error).all():
            is_part = np.isfinite(error)  # of no loss there is no part
            worst = int(np.nanargmax(watts if np.isinf(error).any() else error))
            found.append(float(f"{error[is_part].max(initial=0.0):.2g}"))
            size = WATT.text(watts[worst], 2)
            size = f"{100 * error[worst]:.2g} % ({size})" if is_part[worst] else size
            at = f"{format_number(speed)} rpm and {torque_text(float(own[worst]), 3)}"
            texts.append(f"{size} at {at}")
    if not found:
        return {}
    return {
        "torque_interpolation_error": found[0],
        "torque_interpolation": "linearly in torque; the largest error of the total loss is "
        f"{', '.join(texts)}: {len(points)} points between torques solved directly",
    }


def _checked(torques: FloatArray, total: FloatArray) -> FloatArray:
    """Middles of the intervals next to zero, of those at whose ends the loss bends most, and of
    some others; and more of the first on each side.

    There the error is largest near the end at zero.
    """
    low, high = torques[:-1], torques[1:]
    middles = (low + high) / 2
    order = np.argsort(np.abs(middles), kind="stable")
    sides = [order[middles[order] < 0], order[middles[order] >= 0]]
    bends = np.abs(np.diff(np.diff(total) / (high - low), prepend=np.nan, append=np.nan))
    with np.errstate(divide="ignore", invalid="ignore"):
        off = (high - low) * np.fmax(bends[:-1], bends[1:]) / np.minimum(total[:-1], total[1:])
    bent = np.argsort(-np.nan_to_num(off))[:CHECKED_WHERE_BENT]
    near = np.concatenate([side[:CHECKED_NEAR_ZERO] for side in sides] + [bent])
    others = np.setdiff1d(np.arange(middles.size), near)
    places = np.linspace(0, others.size - 1, min(CHECKED_BEYOND, others.size)).astype(int)
    first = np.concatenate([side[:1] for side in sides])
    backwards = middles[first] < 0
    inner = np.where(backwards, high[first], low[first])
    outer = np.where(backwards, low[first], high[first])
    closer = [inner + part * (outer - inner) for part in CLOSER_TO_ZERO]
    return np.unique(np.concatenate([middles[near], middles[others[places]], *closer]))


# Loss maps: losses, torque loss and efficiency over speed, torque and oil temperature.
#
# A train has its states of brakes and clutches as a further dimension; one whose losses are all
# given has no oil, and no temperature.

_SHAFT_KEYS = ("operation.input", "operation.output", "operation.fixed", "operation.second_input")
"""Keys that decide which shaft is the reference, and which the output."""
_TEMPERATURES = {
    "inlet": "all parts are at the oil inlet temperature",
    "flank": "temperature is that of the oil; the flank temperatures follow from their own losses",
    "network": "temperature is that of the oil inlet; the temperatures of the oil in the gearbox "
    "and of all parts are those of the settled state",
}
"""What the axis of temperatures means, by ``models.temperatures``."""
_CREEP = 1e-9
"""Speed that stands for slow motion; losses over speed have reached their limit by then. [rpm]"""


@dataclass(frozen=True, slots=True)
class MapPlan(SweepPlan):
    """The points of a map, which has only some of their numbers."""

    def _numbers_of(self, answer: Any) -> dict[str, float]:
        found: dict[str, float] = answer.values(_kept_variables(answer.layout))
        for key, it in answer.extremes.items():
            if not math.isnan(it.flow_error):
                found[f"{key}_{INTERPOLATION_ERROR}"] = it.flow_error
        return found

    kind: ClassVar[str] = "map"


def loss_map(
    case: CaseSource,
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
        True to add torques close to zero, where losses rise steeply, if zero is among the torques
        or between them.
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
    torques = resolving_texts(torque) if resolve_zero else torque
    plan = map_plan(as_case(case), speed, torques, temperature, vary, states)
    return checked_map(plan, Runner(jobs, dask, shard, journal, progress).run(plan))


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
    problems = []
    for key in (it for it in further if it in (*AXES.values(), STATE_KEY)):
        option = "states" if key == STATE_KEY else axis_name(key)
        remedy = f"Give its values there, as --{option}."
        problems.append(Problem(key, "", f"is varied by {option}.", remedy))
    allowed = "defines the shafts and cannot vary within a map."
    remedy = "Compute one map for each value."
    problems += [Problem(key, "", allowed, remedy) for key in further if key in _SHAFT_KEYS]
    chosen, found = _states(case, states)
    problems += found
    if temperature is not None and not case.computed:
        allowed = "has no effect, because every loss of the train is given."
        problems.append(Problem("temperature", "", allowed, "Remove it."))
    raise_any(problems, "the map")
    given: dict[str, Iterable[Any]] = {STATE_KEY: chosen} if chosen else {}
    if case.computed:
        if temperature is None:
            temperature = [case.inputs()["operation"]["oil_inlet_temperature"]]
        given[AXES["temperature"]] = temperature
    # torque innermost: flows through pockets, which cost most, do not depend on its magnitude
    given |= {AXES["speed"]: speed, AXES["torque"]: torque}
    plan = make_plan(case, {**further, **given})
    turns_alone = not operation_of(case).driven
    return MapPlan(case, tuple(_prepared(axis, turns_alone) for axis in plan.axes))


def stored_plan(data: xr.Dataset) -> MapPlan:
    """The plan by which a map was computed.

    Raises `InputError` if `data` is no map, or its case is none of this version.
    """
    check_map(data)
    case = map_case(data)
    if case is None:
        allowed = "was not made by this version of the program."
        raise one_problem("case", "", allowed, "Compute the map again.", "the map")
    values = {str(name): written_values(data[name]) for name in data["torque_loss"].dims}
    own = {name: values.pop(name, None) for name in (*AXES, STATE)}
    further = {str(data[name].attrs[CASE_KEY]): texts for name, texts in values.items()}
    speed, torque, temperature, states = own.values()
    return map_plan(case, speed or (), torque or (), temperature, further, states)


def _states(case: Case, chosen: Iterable[Any] | None) -> tuple[list[str], list[Problem]]:
    """The states of a map, and what is wrong with those that were chosen."""
    known = list(case.states)
    if not known:
        if chosen is None:
            return [], []
        allowed = "cannot be chosen, because the case has none."
        return [], [Problem("states", "", allowed, "Remove them.")]
    given = known if chosen is None else [chosen] if isinstance(chosen, str) else chosen
    names = [str(name) for name in given]
    problems = []
    for name in (it for it in dict.fromkeys(names) if it not in known):
        remedy = did_you_mean(name, known) or f"Choose one of {', '.join(known)}."
        problems.append(Problem("states", written(name), "is not a state of the train.", remedy))
    left_out = states_left_out(case, [name for name in names if name in known])
    able = [name for name in names if name not in left_out]
    if chosen is None and able:
        return able, []
    remedy = "Leave this state out."
    problems += [Problem("states", written(it), why, remedy) for it, why in left_out.items()]
    return names, problems


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
    operation = operation_of(case)
    if operation.driven or operation.torques:
        return ""
    return HOUSING if isinstance(case, TrainCase) else next(iter(operation.held), HOUSING)


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
    data = by_keys(to_dataset(plan, rows))[
        [*_kept_variables(layout_of(plan.case)), "status", "message", "warnings"]
    ]
    data = data.rename({axis.key: axis_name(axis.key) for axis in plan.axes})
    data = data.transpose(*(name for name in (*AXES, STATE) if name in data.dims), ...)
    to_rpm, _ = RPM.scale_and_offset()
    torque_loss = data["total"] / (abs(data["speed"]) / to_rpm).where(data["speed"] != 0)
    torque_loss.attrs = {
        "long_name": f"torque loss at the {operation_of(plan.case).input}",
        "units": NEWTON_METRE.display,
    }
    data = data.assign(torque_loss=torque_loss.transpose(*data["total"].dims))
    data = _at_rest(data)
    if "ratio" in data and not operation_of(plan.case).driven:
        data["ratio"] = _one_ratio(data["ratio"])
    for axis in plan.axes:
        data[axis_name(axis.key)].attrs[CASE_KEY] = axis.key
    data.attrs = _attributes(plan, data.attrs)
    return data[["torque_loss", *(name for name in data.data_vars if name != "torque_loss")]]


def _one_ratio(ratio: xr.DataArray) -> xr.DataArray:
    """The ratio without the axes that it does not depend on."""
    operating = [name for name in AXES if name in ratio.dims]
    points = ratio.stack(point=operating).transpose("point", ...)
    known = points.notnull().argmax("point")  # the first point that did not fail
    found = points.isel(point=known).drop_vars(["point", *operating], errors="ignore")
    return found.assign_attrs(ratio.attrs)


@lru_cache(maxsize=16)
def _kept_variables(layout: Layout) -> dict[str, None]:
    """Losses, their sums, efficiency, ratios, speeds and torques of members, temperatures."""
    kept = {*layout.losses, *SUMS, "efficiency", "ratio", "power_ratio"}
    kept |= {f"{name}_{what}" for name in layout.members for what in ("speed", "torque")}
    kept |= {f"{node}_temperature" for node in layout.nodes}
    return {item.key: None for item in number_fields(layout) if item.key in kept}


def _at_rest(data: xr.Dataset) -> xr.Dataset:
    """The map with powers and speeds of slow motion replaced by zero."""
    creeps = data["speed"] == _CREEP
    if not creeps.any():
        return data
    still = {
        name: array.where(~creeps | array.isnull(), 0.0).transpose(*array.dims)
        for name, array in data.data_vars.items()
        if array.attrs.get("units") in (WATT.display, RPM.display)
    }
    return data.assign(still).assign_coords(speed=data["speed"].where(~creeps, 0.0))


def _attributes(plan: MapPlan, given: Mapping[str, str]) -> dict[str, str]:
    operation = operation_of(plan.case)
    reference = operation.input
    text = {
        "title": given["title"],
        "source": given["source"],
        "reference_shaft": reference,
        "output_shaft": operation.output,
        "held_shaft": held_shaft(plan.case),
        "sign_convention": f"speed and torque are those of the {reference}; speeds are positive in "
        "one common sense of rotation, torques act on the gear set from outside; torque times "
        "speed > 0: the shaft drives, < 0: it is driven (coasting); losses are never negative",
        "torque_loss_definition": "power loss over the magnitude of the speed of the "
        f"{reference}: the transmitted torque at the {reference} is torque - sign(speed) * "
        "torque_loss, in both directions of the power",
        "zero_speed": "powers are 0; torque loss, torques and efficiency are the limits of slow "
        "motion in positive direction, without friction of rest",
        "zero_torque": "efficiency is 0 there and wherever the loss consumes all of the power; "
        "the torque loss is that of drag and of teeth that drive it",
        "temperatures": _TEMPERATURES[plan.case.models.temperatures],
        "conventions": "losses in W of the whole gear set, summed over planets; efficiency: "
        "output power over input power, 0 if the loss consumes all of it",
        "pocketing": given["pocketing"],
        "versions": given["versions"],
        "case": given["case"],
    }
    if operation.driven:
        text["zero_speed"] = f"no torque loss: a second member is driven while the {reference} "
        text["zero_speed"] += "stands still"
    chosen = coordinates(plan).get(STATE, ())
    left_out = states_left_out(plan.case).items()
    reasons = [f"{name}: {reason}" for name, reason in left_out if name not in chosen]
    if reasons:
        text["states_left_out"] = " ".join(reasons)
    return text


# A gearbox of one temperature: what it stores, and what it gives to its surroundings.


CAPACITY, CONDUCTANCE = "lumped_heat_capacity", "lumped_conductance"
SURROUNDINGS = "surroundings_temperature"
"""Attributes of a map whose temperature follows from its losses, in J/K, W/K and K."""


def with_temperature_state(data: xr.Dataset, case: CaseSource) -> xr.Dataset:
    """Add the heat balance to a map, so that an FMU computes its temperature from the losses.

    Parameters
    ----------
    data : xarray.Dataset
        From `loss_map`, with all parts at the temperature of the oil, over two temperatures or
        more.
    case : PlanetaryCase, GearPairCase or TrainCase
        Its heat network, in the steady state at its operating point, gives the conductance.

    Raises
    ------
    InputError
        If the map has no temperature axis or has steady-state temperatures, or if the heat capacity
        of the case is unknown.
    """
    check_axis(data.sizes.get("temperature", 0))
    if map_inputs(data).get("models", {}).get("temperatures") == "network":
        allowed = "must be inlet, because the map has to give the losses at the oil temperature."
        key, remedy = "models.temperatures", "Compute the map again."
        raise one_problem(key, '"network"', allowed, remedy, "the map")
    return data.assign_attrs(lumped(as_case(case)))


def check_axis(count: int) -> None:
    """Raise `InputError` unless a map has several temperatures."""
    if count < 2:
        allowed = "must have two or more values."
        raise one_problem("temperature", "", allowed, 'Give more, as "20,60,100 degC".', "the map")


def lumped(case: Case) -> dict[str, float]:
    """Attributes of a map whose temperature follows from its losses. Theory (W39).

    Raises `InputError` if no temperatures follow from the losses, or what the case stores is not
    known.
    """
    warm = with_network(case)
    model = build(warm).thermal
    assert isinstance(model, NetworkModel)
    capacity = sum(model.capacities().values())
    heat = solve(warm).heat
    assert heat is not None
    leaving = [(heat.given[path.into], path.watts) for path in heat.ways if path.into in heat.given]
    whole = sum(watts for _, watts in leaving)
    if not whole > 0:
        allowed = "has no loss at its operating point, so the heat paths cannot be found."
        raise one_problem("operation", "", allowed, "Give a speed.")
    around = sum(kelvin * watts for kelvin, watts in leaving) / whole
    conductance = whole / (heat.temperatures[OIL] - around)
    return {CAPACITY: capacity, CONDUCTANCE: conductance, SURROUNDINGS: around}
