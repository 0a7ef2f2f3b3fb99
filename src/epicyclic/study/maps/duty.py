"""Energy that a duty cycle puts in, takes out and loses."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.arrays import FloatArray
from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.messages import did_you_mean, refused, written
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.maps.compute import (
    Deviation,
    MapPlan,
    Sample,
    changes_at,
    further_values,
    leave_out,
    map_plan,
    resolving_zero,
    solve_sample,
    to_map,
)
from epicyclic.study.maps.cycle import Cycle, Piece, open_cycle
from epicyclic.study.maps.tables import Lookup, check_gaps, make_lookup, map_case
from epicyclic.study.meshes import Variable, variable
from epicyclic.study.operating import STATE, shaft_power
from epicyclic.study.sweeps.runner import HERE, Progress, Runner
from epicyclic.study.table_file import AS_IT_IS, TableForm
from epicyclic.units import (
    CELSIUS,
    KILOJOULE,
    NEWTON_METRE,
    NUMBER,
    RPM,
    SECOND,
    Quantity,
    format_number,
    percent,
)

if TYPE_CHECKING:
    import xarray as xr


# Linear interpolation is a weighted sum of the values at the nodes of the map. The weights of all
# points are added up first, each times the angle turned through; multiplied by the torque losses at
# the nodes they give the energy of every component at once.

MODES = ("driving", "coasting", "idling")
"""The reference shaft drives, is driven, or passes no power: no torque or no speed."""

_SPEEDS, _TORQUES, _TEMPERATURES = 9, 9, 4  # Values of the axes of a map that is made for a cycle.
_DISTANCE = Quantity("a distance", "m", "km", low=0.0, high=1e7, open_low=True)
_KJ_PER_WH = 3.6
_CROWDING = 1.5  # Exponent by which its speeds and torques crowd at zero, where losses bend most.
_CROWD = 6  # Further torques next to zero, on each side. [1]
SAMPLES = 20  # Points that are solved to measure the error of the interpolation.


def duty_cycle(
    map_or_case: xr.Dataset | CaseSource,
    cycle: Any,
    temperature: Iterable[Any] | None = None,
    *,
    clamp: bool = False,
    samples: int = SAMPLES,
    form: TableForm = AS_IT_IS,
    distance: Any = None,
    jobs: int | None = None,
    dask: str | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Input, output and lost energy of a duty cycle, by component.

    Parameters
    ----------
    map_or_case : xarray.Dataset, PlanetaryCase, GearPairCase or TrainCase
        A loss map. For a case a map that covers the cycle is computed first.
    cycle : str, Path, pandas.DataFrame or mapping
        A text, Excel or Parquet file, or columns by name: ``"speed [rpm]"``,
        ``"torque [N*m]"`` of the input member, ``"temperature [degC]"`` if it varies, and
        ``"time [s]"`` of a time series, or ``"duration [s]"`` or ``"share"`` of a histogram.
        Any units; a train with states has a column ``"state"`` of their names. Other columns are
        left alone.
    temperature : iterable, optional
        Oil inlet temperatures as text with units, for a cycle without a column of them. Default:
        that of the case, or of a map that has one.
    clamp : bool
        True: points outside of the map have the torque loss of the nearest point on its
        boundary. False: they are refused.
    samples : int
        Points of the cycle that are solved directly to measure the error of the interpolation.
    form : TableForm
        How a file is to be read, where it does not say so itself.
    distance : str, optional
        What a vehicle covers in the cycle, ``"23.27 km"``: the loss for it follows.
    jobs, dask
        As for `sweep`.
    journal : str or Path, optional
        Folder that keeps finished points, those of the map and of the check.
    progress
        As for `sweep`, for the map of a case.

    Returns
    -------
    xarray.Dataset
        ``energy_in``, ``energy_out`` [kJ], ``duration`` [s] and ``efficiency`` over ``mode``;
        ``energy_lost`` [kJ] over ``mode`` and ``component``; ``total_efficiency``;
        ``share_outside`` of the duration; ``interpolation_error`` [kJ] of the energy lost, its
        ``interpolation_standard_error`` and the ``largest_deviation`` of a point, with the way they
        were found in the attributes. A train with states has ``state_energy_in``,
        ``state_energy_out``, ``state_energy_lost``, ``state_duration`` and ``state_efficiency``
        over ``state`` too. With a distance there are ``distance`` [km] and ``lost_per_distance``
        [Wh/km]. With `temperature` all have that dimension.

    Raises
    ------
    InputError
        With all problems of the cycle; for points outside of the map and states that it does not
        have; for a map with gaps, further axes of several values, or two driven members.
    """
    import xarray as xr

    runner, covered = Runner(jobs, dask, journal=journal), distance_of(distance)
    checked = open_cycle(cycle, form=form)
    celsius = parse_temperatures(checked, temperature)
    data = map_or_case
    if not isinstance(data, xr.Dataset):
        data = cycle_map(as_case(data), checked, celsius, replace(runner, progress=progress))
    sums = add_up(data, checked, celsius, clamp=clamp, samples=samples)
    return with_distance(make_duty(data, checked, sums, runner), covered)


def distance_of(text: Any) -> float | None:
    """The distance that was stated; None if none was. [km]"""
    try:
        return None if text is None else _DISTANCE.to_display(_DISTANCE.parse(text))
    except PydanticCustomError as error:
        raise InputError([refused(error, "distance", written(text))], "the command") from None


def with_distance(result: xr.Dataset, covered: float | None) -> xr.Dataset:
    """With the energy lost for each distance, if one was covered. [km]"""
    if covered is None:
        return result
    lost = result["energy_lost"].sum(("mode", "component")) / _KJ_PER_WH / covered
    return result.assign(
        distance=((), covered, {"long_name": "distance", "units": "km"}),
        lost_per_distance=lost.assign_attrs(long_name="energy lost by distance", units="Wh/km"),
    )


def parse_temperatures(cycle: Cycle, temperature: Iterable[Any] | None) -> tuple[float, ...] | None:
    """Temperatures that were asked for; None if none were. [degC]"""
    if temperature is None:
        return None
    texts = [temperature] if isinstance(temperature, str) else list(temperature)
    problems, values = [], []
    for text in texts:
        try:
            values.append(CELSIUS.to_display(CELSIUS.parse(text)))
        except PydanticCustomError as error:
            problems.append(refused(error, "temperature", written(text)))
    if "temperature" in cycle.ranges:
        allowed = "is also a column of the cycle."
        problems.append(Problem("temperature", "", allowed, "Keep one of them."))
    if not texts or len(set(values)) < len(values):
        allowed = "must give each value once."
        problems.append(Problem("temperature", "", allowed, "Give different values."))
    raise_any(problems, "the command")
    return tuple(values)


def cycle_map(
    case: Case, cycle: Cycle, celsius: tuple[float, ...] | None, runner: Runner = HERE
) -> xr.Dataset:
    """A map of `case` that covers a cycle."""
    plan = cycle_plan(case, cycle, celsius)
    return to_map(plan, runner.within(plan).run(plan))


def cycle_plan(case: Case, cycle: Cycle, celsius: tuple[float, ...] | None) -> MapPlan:
    """The points of that map."""
    if case.computed and "temperature" in cycle.ranges:  # it has no effect without an oil
        low, high = cycle.ranges["temperature"]
        celsius = tuple(np.unique(np.linspace(low, high, _TEMPERATURES)).tolist())
    texts = None if celsius is None else texts_of(celsius, CELSIUS)
    return grid_plan(case, cycle, (_SPEEDS, _TORQUES, _CROWD), texts)


def grid_plan(
    case: Case,
    cycle: Cycle,
    counts: tuple[int, int, int],  # Speeds, torques, and further torques next to zero.
    temperatures: list[str] | None = None,
) -> MapPlan:
    """A map over the speeds, torques and states of a cycle."""
    states = None
    if case.states:
        check_states(cycle, tuple(case.states))
        states = [name for name in case.states if name in cycle.states]
    speeds = crowded(*cycle.ranges["speed"], counts[0])
    torques = resolving_zero(crowded(*cycle.ranges["torque"], counts[1]), counts[2])
    plane = texts_of(speeds, RPM), texts_of(torques, NEWTON_METRE)
    return map_plan(case, *plane, temperatures, states=states)


def crowded(low: float, high: float, count: int) -> FloatArray:
    """About `count` values from `low` to `high`, and zero, where they crowd."""
    ends = [end for end in (min(low, 0.0), max(high, 0.0)) if end]
    steps = np.linspace(0, 1, (count - 1) // max(len(ends), 1) + 1) ** _CROWDING
    return np.unique(np.concatenate([[0.0], *(end * steps for end in ends)])) + 0.0  # no -0.0


def texts_of(values: Iterable[float], quantity: Quantity) -> list[str]:
    return [f"{float(value)!r} {quantity.display}" for value in values]


@dataclass(slots=True)
class Totals:
    """Sums over a cycle; arrays have a row for each of `MODES`, a column for each state or one."""

    sample: Sample  # Of its points.
    node_work: FloatArray  # Angle turned through at each node of the map. [rad]
    duration: FloatArray  # [s]
    energy_in: FloatArray  # [J]
    energy_out: FloatArray  # [J]
    outside: float = 0.0  # Duration outside of the map. [s]


@dataclass(frozen=True, slots=True)
class Sums:
    """A cycle added up: once for each oil temperature, or once at its own temperatures."""

    lookup: Lookup
    celsius: tuple[float, ...] | None  # Temperatures that were asked for.
    clamp: bool
    totals: tuple[Totals, ...]


def add_up(
    data: xr.Dataset,
    cycle: Cycle,
    celsius: tuple[float, ...] | None = None,
    *,
    clamp: bool = False,
    samples: int = SAMPLES,
    progress: Progress | None = None,
) -> Sums:
    """Go through a checked cycle; raises `InputError` if it leaves the map."""
    if samples < 0:
        raise one_problem("samples", str(samples), "must be 0 or more.", "Take 20.", "the command")
    lookup = make_lookup(data, gaps=True)
    lost = data["torque_loss"].transpose(*lookup.names, ...).values
    gaps = np.isnan(lost).reshape(lookup.size, -1)[:, 0]  # of the first of further keys
    if len(lookup.states) > 1 or (lookup.states and cycle.states):
        check_states(cycle, lookup.states)
    totals = []
    for value in _temperatures(lookup, cycle, celsius):
        found = _go_through(lookup, cycle, value, Sample(samples), progress)
        if found.outside and not clamp:
            raise _outside(lookup, cycle, value, found)
        if found.node_work[:, gaps].any():  # points that failed matter only where the cycle goes
            check_gaps(data)
        totals.append(found)
    return Sums(lookup, celsius, clamp, tuple(totals))


def costliest(data: xr.Dataset, sums: Sums) -> Case | None:
    """The case at the point of the cycle, of those drawn, where most is lost; None if unknown."""
    case, (rows, _) = map_case(data, further_values(data)), sums.totals[0].sample.drawn()
    if case is None or not rows.size:
        return None
    return case.updated(changes_at(sums.lookup, rows[rows[:, -1].argmax()].tolist()))


def make_duty(data: xr.Dataset, cycle: Cycle, sums: Sums, runner: Runner = HERE) -> xr.Dataset:
    """The result of `duty_cycle`, its error measured at the points that were drawn."""
    import xarray as xr

    case = map_case(data, further_values(data))
    results = []
    for totals in sums.totals:
        error = (
            leave_out(sums.lookup, totals.node_work.sum(axis=0))
            if case is None
            else solve_sample(case, sums.lookup, totals.sample, runner)
        )
        results.append(_to_dataset(sums.lookup, totals, error))
    (result, *_) = results
    if sums.celsius is not None:
        axis = xr.Variable("temperature", list(sums.celsius), {"units": CELSIUS.display})
        result = xr.concat(results, axis)
    method = {"interpolation_error_method": error.method}
    result.attrs = _attributes(data, cycle, sums.clamp) | method
    return result


def _temperatures(
    lookup: Lookup, cycle: Cycle, celsius: tuple[float, ...] | None
) -> tuple[float | None, ...]:
    """The oil temperatures at which to run a cycle; None stands for that of its column."""
    if "temperature" not in lookup.names:
        if celsius is not None:
            allowed = "has no effect, because every loss of the train is given."
            raise one_problem("temperature", "", allowed, "Remove it.", "the command")
        return (None,)
    if "temperature" in cycle.ranges:
        return (None,)
    if celsius is not None:
        return celsius
    axis = lookup.axes[lookup.names.index("temperature")]
    if axis.size > 1:
        low, high = (format_number(float(axis[place])) for place in (0, -1))
        allowed = f"is not a column of the cycle, and the map covers {low} to {high} °C."
        remedy = f'Choose one or more, as in --temperature "{high} degC".'
        raise one_problem("temperature", "", allowed, remedy, "the command")
    return (float(axis[0]),)


def check_states(cycle: Cycle, known: tuple[str, ...]) -> None:
    """Raise `InputError` unless a cycle has a column of states, all of them `known`."""
    text = ", ".join(known)
    if not cycle.states:
        allowed = f"is not among the columns, but the map has several: {text}."
        remedy = f"Name a column {STATE}, or compute a map of one state."
        raise one_problem(STATE, "", allowed, remedy, cycle.source.name)
    other = "Correct these rows, or include this state in the map."
    problems = (
        Problem(STATE, written(it), f"must be one of {text}.", did_you_mean(it, known) or other)
        for it in cycle.states
        if it not in known
    )
    raise_any(problems, cycle.source.name)


def point_of(lookup: Lookup, cycle: Cycle, piece: Piece) -> tuple[FloatArray, ...]:
    """The points of a piece as the axes of the map."""
    point = {"speed": piece.speed, "torque": piece.torque, "temperature": piece.temperature}
    if piece.state is not None and lookup.states:
        numbers = np.array([1.0 + lookup.states.index(name) for name in cycle.states])
        point[STATE] = numbers[piece.state]
    else:
        point[STATE] = np.ones_like(piece.speed)
    values = [point[name] for name in lookup.names]
    return tuple(array for array in values if array is not None)


def _go_through(
    lookup: Lookup, cycle: Cycle, celsius: float | None, sample: Sample, progress: Progress | None
) -> Totals:
    """All points of a cycle added up, at its own temperatures or at one."""
    modes, nodes, states = len(MODES), lookup.size, max(1, len(lookup.states))
    totals = Totals(sample, np.zeros((modes, nodes)), *np.zeros((3, modes, states)))
    torque_loss = lookup.total
    done = 0
    for piece in cycle.pieces(celsius):
        point = point_of(lookup, cycle, piece)
        corners, weights = lookup.corners(*point)
        loss = shaft_power((torque_loss[corners] * weights).sum(axis=0), np.abs(piece.speed))
        at_shaft = shaft_power(piece.torque, piece.speed)
        mode = np.select([at_shaft > 0, at_shaft < 0], [0, 1], 2)
        turned = shaft_power(piece.duration, np.abs(piece.speed))
        totals.node_work += np.bincount(
            (corners + nodes * mode).ravel(), (weights * turned).ravel(), modes * nodes
        ).reshape(modes, nodes)
        # power enters at either shaft: what the reference shaft does not bring comes from the other
        entering = np.maximum(at_shaft, 0) + np.maximum(loss - at_shaft, 0)
        leaving = np.maximum(-at_shaft, 0) + np.maximum(at_shaft - loss, 0)
        if lookup.states:
            mode = mode * states + point[-1].astype(np.intp) - 1
        for total, per_second in (
            (totals.duration, 1.0),
            (totals.energy_in, entering),
            (totals.energy_out, leaving),
        ):
            weights_now = per_second * piece.duration
            total += np.bincount(mode, weights_now, modes * states).reshape(modes, states)
        totals.outside += float(piece.duration[lookup.outside(*point)].sum())
        sample.add(point, loss, loss * piece.duration)
        done += piece.speed.size
        if progress is not None:
            progress(min(done, cycle.rows), cycle.rows)
    return totals


def _outside(lookup: Lookup, cycle: Cycle, celsius: float | None, totals: Totals) -> InputError:
    """What of a cycle is not in the map."""
    ranges = dict(cycle.ranges)
    if celsius is not None:
        ranges["temperature"] = (celsius, celsius)
    share = percent(totals.outside / totals.duration.sum())
    remedy = f"Compute a larger map, or use --clamp; {share} of the duration is outside."
    problems = []
    units = (RPM, NEWTON_METRE, CELSIUS)
    for name, axis, unit in zip(lookup.names, lookup.axes, units, strict=False):
        if name == STATE:
            continue
        low, high = (format_number(value) for value in ranges[name])
        first, last = (format_number(float(value)) for value in (axis[0], axis[-1]))
        if ranges[name][0] < axis[0] or ranges[name][1] > axis[-1]:
            allowed = f"lies outside the map, which covers {first} to {last} {unit.display}."
            problems.append(Problem(name, f"{low} to {high} {unit.display}", allowed, remedy))
    return InputError(problems, "the cycle")


def _to_dataset(lookup: Lookup, totals: Totals, error: Deviation) -> xr.Dataset:
    import xarray as xr

    components, states = len(lookup.components), len(lookup.states)
    entering, leaving = totals.energy_in.sum(axis=1), totals.energy_out.sum(axis=1)
    outside = totals.outside / totals.duration.sum(axis=1).sum()
    total = _ratio(leaving.sum(), entering.sum())
    lost = totals.node_work @ lookup.torques.reshape(components, lookup.size).T
    variables = _sums_over("mode", totals, lost) | {
        "total_efficiency": variable((), total, "efficiency over the cycle", NUMBER),
        "share_outside": variable((), outside, "share of the duration outside of the map", NUMBER),
        "interpolation_error": variable(
            (), error.energy, "energy lost added by interpolation, estimate", KILOJOULE
        ),
        "interpolation_standard_error": variable(
            (), error.standard_error, "standard error of the estimate", KILOJOULE
        ),
        "largest_deviation": variable(
            (), error.largest, "largest deviation of a checked point", NUMBER
        ),
    }
    coords = {"mode": list(MODES), "component": list(lookup.components)}
    if states:
        coords[STATE] = list(lookup.states)
        # states are the last axis of the map
        turned = totals.node_work.sum(axis=0).reshape(-1, states)
        torques = lookup.torques.reshape(components, -1, states)
        sums = _sums_over(STATE, totals, np.einsum("ns,cns->sc", turned, torques))
        variables |= {f"state_{name}": values for name, values in sums.items()}
    return xr.Dataset(variables, coords)


def _sums_over(dimension: str, totals: Totals, lost: FloatArray) -> dict[str, Variable]:
    """Duration and energies of the modes or states; `lost` is that by component. [J]"""
    axis = 0 if dimension == STATE else 1
    duration, entering, leaving = (
        sums.sum(axis=axis) for sums in (totals.duration, totals.energy_in, totals.energy_out)
    )
    return {
        "duration": variable(dimension, duration, "duration", SECOND),
        "energy_in": variable(dimension, entering, "energy input", KILOJOULE),
        "energy_out": variable(dimension, leaving, "energy output", KILOJOULE),
        "energy_lost": variable((dimension, "component"), lost, "energy lost", KILOJOULE),
        "efficiency": variable(dimension, _ratio(leaving, entering), "efficiency", NUMBER),
    }


def _ratio(part: Any, whole: Any) -> Any:
    """`part` over `whole`, NaN where there is nothing."""
    return np.divide(part, whole, out=np.full(np.shape(whole), np.nan), where=whole > 0)


def _attributes(data: xr.Dataset, cycle: Cycle, clamp: bool) -> dict[str, str]:
    shaft, output = data.attrs["reference_shaft"], data.attrs["output_shaft"]
    basis = {"time": "time series, trapezoidal rule over time", "duration": "histogram"}
    outside = "evaluated at its boundary" if clamp else "none; points outside are refused"
    idle = {"temperature", STATE} - set(map(str, data["torque_loss"].dims))
    return {
        "title": data.attrs["title"],
        "source": data.attrs.get("source", ""),
        "cycle": cycle.title(idle),
        "reference_shaft": shaft,
        "output_shaft": output,
        "sign_convention": data.attrs.get("sign_convention", ""),
        "modes": f"driving: power enters at the {shaft}; coasting: power leaves there; idling: no "
        "speed or no torque. Energy in and out is counted at both shafts, never negative",
        "basis": basis.get(cycle.weighting, "histogram of shares; energies are those of one hour"),
        "interpolation": "linear, of the loss over the speed",
        "points_outside": outside,
        "case": data.attrs["case"],
    }


# The map that a duty cycle needs, as a plan that knows its cycle: its points can be shared out.


@dataclass(frozen=True, slots=True)
class DutyPlan(MapPlan):
    """The points of the map of a duty cycle."""

    kind: ClassVar[str] = "duty"
    digest: str = field(kw_only=True)  # Of the file of the cycle.
    # Oil inlet temperatures that were asked for. [degC]
    celsius: tuple[float, ...] | None = field(kw_only=True)
    clamp: bool = field(kw_only=True)  # As for `duty_cycle`.

    @classmethod
    def again(cls, content: Mapping[str, Any], source: str) -> Self:
        """The plan that `describe` described."""
        plan, asked = MapPlan.again(content, source), content["duty"]
        celsius = None if asked["celsius"] is None else tuple(asked["celsius"])
        return cls(
            plan.case, plan.axes, digest=asked["cycle"], celsius=celsius, clamp=asked["clamp"]
        )

    def describe(self) -> dict[str, Any]:
        """The map, and what is asked of it."""
        duty = {"cycle": self.digest, "celsius": self.celsius, "clamp": self.clamp}
        return {**MapPlan.describe(self), "duty": duty}


def digest_of(cycle: Path) -> str:
    """What tells the content of a file that can be read from any other."""
    with cycle.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def check_same(plan: DutyPlan, cycle: Path) -> None:
    """Raise `InputError` if `cycle` is not the file of which shards were computed."""
    try:
        allowed = "" if digest_of(cycle) == plan.digest else "has changed since then."
    except OSError as error:
        allowed = f"cannot be read: {error.strerror}."
    if allowed:
        remedy = "Restore the cycle from which the shards were computed."
        raise one_problem("CYCLE", str(cycle), allowed, remedy, "the command")
