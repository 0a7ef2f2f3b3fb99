"""Warming up: temperatures and losses over time."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic_core import PydanticCustomError
from scipy.interpolate import PchipInterpolator

from epicyclic.arrays import FloatArray
from epicyclic.build.machine import build, term_nodes
from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import ConvergenceError, InputError, Problem, raise_any
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.machine.element import OIL, joined_key
from epicyclic.machine.heat import AMBIENT, HOTTEST, NetworkModel
from epicyclic.machine.heat_flow import Course, Curves, Link, Source, Transient
from epicyclic.machine.machine import Machine
from epicyclic.machine.solve import Solution, Wanted, solve_machine
from epicyclic.messages import refused, written
from epicyclic.result.result import origin
from epicyclic.schema.fields import quantity_of
from epicyclic.study.heat import check_oil
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.maps.compute import held_shaft
from epicyclic.study.maps.cycle import TIME, Cycle, open_cycle
from epicyclic.study.maps.duty import grid_plan, point_of, texts_of
from epicyclic.study.maps.tables import Lookup, driven_problem
from epicyclic.study.meshes import variable
from epicyclic.study.operating import AXES, STATE, axis_name, shaft_power
from epicyclic.study.sweeps.run import SweepPlan, make_plan
from epicyclic.study.sweeps.runner import Progress
from epicyclic.units import (
    CELSIUS,
    JOULE_PER_KELVIN,
    KELVIN,
    KILOJOULE,
    NUMBER,
    SECOND,
    WATT,
    Quantity,
    Temperature,
    celsius_text,
)

if TYPE_CHECKING:
    import xarray as xr


# Losses and paths of the heat of some operating points over temperature, to integrate over time.
#
# The machine is solved with all of its parts equally hot, at a few temperatures. Over time each
# loss is then read at the temperature of its own parts.

SPACING = 10.0
"""Between the temperatures at which losses are solved: with 20 K a train ended 0.12 K from its
settled temperatures. [K]"""
WAYS = 4
"""Temperatures from one of these to the next at which conductances are computed: free convection
starts steeply, and they cost little."""


@dataclass(frozen=True, slots=True)
class HeatSample:
    """What one solution tells, with all parts equally hot."""

    heat: Mapping[Source, float]  # [W]
    # Paths of the heat by their keys, at temperatures from this one to the next.
    links: tuple[Mapping[str, Link], ...]
    given: Mapping[str, float]  # Temperatures that are given. [K]


def heat_samples(
    case: Case,  # Whose temperatures follow from a network.
    points: Sequence[Mapping[str, Any]],  # Keys of the case that each point changes.
    knots: Sequence[float],  # Temperatures. [K]
    flow_tables: FlowTables,  # Tables of flows through pockets.
    progress: Progress | None = None,
) -> list[list[HeatSample]]:
    """Samples of operating points at some temperatures.

    Returns list of list of HeatSample: for each temperature one of every point.
    """
    machines = [build(case.updated(changes), flow_tables) for changes in points]
    samples: list[list[HeatSample]] = [[] for _ in knots]
    last: dict[int, Solution] = {}  # by the number of the machine, at the knot before
    done = itertools.count(1)
    for row, knot in zip(samples, knots, strict=True):
        # next to each other if they differ in torque only
        for number, built in enumerate(machines):
            model = built.thermal
            assert isinstance(model, NetworkModel)
            fluids = model.fluids(dict.fromkeys(model.nodes, knot))
            wanted = Wanted(built.machine, built.operation, fluids, earlier=last.get(number))
            solution, _ = solve_machine(wanted)
            last[number] = solution
            networks = [model.network(value, solution) for value in _between([knot])]
            links = tuple({link.key: link for link in one.links} for one in networks)
            heat = _heat(built.machine, solution, model.nodes)
            row.append(HeatSample(heat, links, networks[0].given))
            if progress is not None:
                progress(next(done), len(knots) * len(points))
    return samples


def _between(knots: Sequence[float]) -> FloatArray:
    """Temperatures at which conductances are computed. [K]"""
    steps = SPACING / WAYS * np.arange(WAYS)
    return np.concatenate([knot + steps for knot in knots])


def _heat(machine: Machine, solution: Solution, nodes: Sequence[str]) -> dict[Source, float]:
    """Heat of every loss that is there, by what it heats."""
    own = [
        (key, name, loss)
        for key, result in solution.results.items()
        for name, loss in result.losses.items()
        if not loss.left_out
    ]
    given = [("", key, loss) for key, loss in solution.given.items()]
    at = term_nodes(machine)
    found: dict[Source, float] = {}
    for key, name, loss in (*given, *own):
        for node, share in loss.heat:
            into = node if node in nodes else OIL
            source = Source(joined_key(key, name), into, at.get((key, name), (OIL,)))
            found[source] = found.get(source, 0.0) + share * loss.watts
    return found


class HeatTables:
    """Curves over temperature of the heat and the paths of every operating point. Theory (W36)."""

    def __init__(
        self,
        model: NetworkModel,
        knots: Sequence[float],  # Temperatures, rising. [K]
        samples: Sequence[Sequence[HeatSample]],  # For each temperature one of every point.
    ) -> None:
        every = [sample for row in samples for sample in row]
        self.capacities = model.capacities()
        self.taken = {OIL: model.settings.cooler_power}
        self.given = {node: value for sample in every for node, value in sample.given.items()}
        self.knots = np.array(knots)
        self.sources = tuple(dict.fromkeys(source for sample in every for source in sample.heat))
        links = {key: it for sample in every for paths in sample.links for key, it in paths.items()}
        self.links = tuple(links.values())
        self.terms = tuple(dict.fromkeys(source.term for source in self.sources))
        heat = [[[one.heat.get(it, 0.0) for it in self.sources] for one in row] for row in samples]
        conductances = [
            [[it[key].conductance if key in it else 0.0 for key in links] for it in paths]
            for row in samples
            for paths in zip(*(one.links for one in row), strict=True)
        ]
        self._between = _between(knots)
        self._heat = _coefficients(self.knots, heat)
        self._conductances = _coefficients(self._between, conductances)
        self._heat_at = self._weights([source.at for source in self.sources])
        # what leaves the housing depends on its temperature, all other paths on the oil's
        own = [(link.hot,) if link.cold == AMBIENT else (OIL,) for link in self.links]
        self._conductances_at = self._weights(own)

    def transient(
        self,
        # With which the heat, and the conductances, of the points are added up.
        heating: FloatArray,
        flowing: FloatArray,
    ) -> Transient:
        """The gearbox at a mixture of the points."""
        return Transient(
            self.capacities, self.given, self.sources, self.heat(heating), self.links,
            Curves(self._between, self._conductances @ flowing, self._conductances_at), self.taken,
        )  # fmt: skip

    def heat(self, heating: FloatArray) -> Curves:
        """Curves of the heat of every source."""
        return Curves(self.knots, self._heat @ heating, self._heat_at)

    def losses(self, heat: FloatArray) -> FloatArray:
        """Every loss from the heat of every source. [W]"""
        place = {term: index for index, term in enumerate(self.terms)}
        into = [place[source.term] for source in self.sources]
        return np.array(np.bincount(into, heat, len(place)), float)

    def _weights(self, at: Sequence[Sequence[str]]) -> FloatArray:
        place = {node: index for index, node in enumerate(self.capacities)}
        found = np.zeros((len(at), len(place)))
        for row, nodes in enumerate(at):
            for node in nodes:
                found[row, place[node]] += 1 / len(nodes)
        return found


def _coefficients(knots: FloatArray, values: Sequence[Sequence[Sequence[float]]]) -> FloatArray:
    """Monotone cubic curves over the first axis of `values`; the second one comes last."""
    found: FloatArray = PchipInterpolator(knots, np.array(values)).c.swapaxes(2, 3)
    return found


START = quantity_of(Temperature) or CELSIUS
DURATION = Quantity("a time", "s", "s", low=0.0, high=1e9, open_low=True)
HEADROOM = 80.0
"""By which a gearbox is expected to warm up; and by how much more if it does not do. [K]"""
SPEEDS, TORQUES = 7, 7  # Values of the grid on which the losses of a cycle are solved.
CROWD = 4
"""Further torques next to zero, on each side; 10 change no digit of a cycle at light load. [1]"""
MOST_STEPS = 2000  # Into which the duration is divided, if a cycle has more rows.
TOLERANCE = 1e-3  # Largest error of the temperatures in each of these steps. [K]
TIMES = 241  # At which the course is told if the operating point is constant.
REACHED = 0.9  # Part of the way to the end whose time is told. [1]


def warm_up(
    case: CaseSource,
    duration: Any,
    start_temperature: Any = None,
    *,
    cycle: Any = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Temperatures and losses of a gearbox after a cold start.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
        Its temperatures follow from the heat network, whatever ``models.temperatures`` is. It
        must have ``thermal.oil_volume`` and, if it has a housing, ``thermal.housing.mass``.
    duration : str
        As ``"2 h"``.
    start_temperature : str, optional
        Start temperature of all parts, as ``"20 degC"``. Default: ``thermal.ambient_temperature``.
    cycle : str, Path, pandas.DataFrame or mapping, optional
        As for `duty_cycle`, repeated until the end; a column of temperatures is ignored.
        Default: the operating point of the case.
    progress : callable, optional
        As for `sweep`.

    Returns
    -------
    xarray.Dataset
        Over ``time`` [s]: ``temperature`` [degC] of every ``node``, ``loss`` [W] of every
        ``component``, ``total_loss`` [W], ``efficiency`` [1], and ``energy_lost``,
        ``energy_given_off`` to the surroundings and ``energy_stored`` [kJ] since the start. Over
        ``node``: ``heat_capacity`` [J/K], ``settled_temperature`` [degC], and
        ``time_to_90_percent`` [s] of the way there, NaN if that is not reached. The
        ``time_constant`` [s] of small changes about it, the slowest first, and the
        ``energy_lost_settled`` [kJ] of a gearbox that is so warm all the time. NaN if it does not
        settle.

    Raises
    ------
    InputError
        For a duration or temperature that cannot be read, for what is not known of the oil and the
        housing, and for a cycle as by `duty_cycle`.
    ConvergenceError
        If the gearbox gets so hot that nothing is left to compute.
    """
    case = as_case(case)
    seconds, start = _parsed(case, duration, start_temperature)
    warm = _with_fixed_jets(case.updated({"models.temperatures": "network"}))
    model = build(warm).thermal
    assert isinstance(model, NetworkModel)
    begin = np.full(len(model.capacities()), start)
    driven = None if cycle is None else open_cycle(cycle)
    drive = _constant(warm) if driven is None else _driven(warm, seconds, driven)
    own = model.settings
    low = min(start, own.inlet, own.ambient, own.coolant)
    knots = _knots(low, max(start, own.inlet, own.ambient, own.coolant) + HEADROOM)
    samples = _sampled(warm, drive, knots, progress)
    while True:
        tables = HeatTables(model, knots, samples)
        told = _run(tables, drive, begin, seconds, progress)
        course = told.course
        settled = tables.transient(*drive.mean).settled(course.temperatures[:, -1])
        if settled is not None and settled.max() > HOTTEST:
            settled = None
        hottest = float(np.max([course.temperatures.max(), *([] if settled is None else settled)]))
        if min(hottest, HOTTEST) <= knots[-1]:
            break
        new = _knots(knots[-1] + SPACING, min(hottest, HOTTEST))
        samples += _sampled(warm, drive, new, progress)
        knots += new
    if hottest > HOTTEST:
        raise _runaway(tables, course)
    found = _to_dataset(warm, tables, drive, told, seconds, settled)
    return found if driven is None else found.assign_attrs(cycle=driven.title())


def _with_fixed_jets(case: Case) -> Case:
    """The oil meets all parts as it does in the settled state of the case: nozzles do not move."""
    built = build(case)
    assert isinstance(built.thermal, NetworkModel)
    try:
        solution = built.solve().solution
    except ConvergenceError:  # it runs away: the oil goes where the heat arises
        return case
    heat = built.thermal.seen(solution, solution.losses.values()).heat
    return case.updated({"thermal.jet_shares": built.thermal.jet_shares(heat)})


def _knots(low: float, high: float) -> list[float]:
    """Temperatures at equal distances from `low` to `high` or beyond. [K]"""
    return [low + SPACING * number for number in range(1 + math.ceil((high - low) / SPACING))]


def _parsed(case: Case, duration: Any, start: Any) -> tuple[float, float]:
    """Duration [s] and temperature at the start [K]; raises `InputError` for all that is wrong."""
    check_oil(case)
    found, problems = [], []
    if start is None:
        start = CELSIUS.exact_text(case.thermal.ambient_temperature)
    for name, value, quantity in (
        ("duration", duration, DURATION),
        ("start temperature", start, START),
    ):
        try:
            found.append(quantity.parse(value))
        except PydanticCustomError as error:
            problems.append(refused(error, name, written(value)))
    if case.thermal.oil_outlet_temperature is not None:
        allowed = "determines the oil flow in a single steady state only."
        remedy = "Give thermal.oil_flow instead."
        problems.append(Problem("thermal.oil_outlet_temperature", "", allowed, remedy))
    raise_any(problems)
    seconds, kelvin = found
    return seconds, kelvin


@dataclass(frozen=True, slots=True)
class _Step:
    """A time in which the operation has one mean."""

    duration: float  # [s]
    # With which the losses, and the conductances, at the points of the grid add up to their means.
    # [1]
    heating: FloatArray
    # The part of `heating` for which power enters at the output, or nowhere. [1]
    coasting: FloatArray
    flowing: FloatArray
    # Mean power that enters and leaves at the reference shaft; NaN if two are driven. [W]
    entering: float
    leaving: float

    def efficiency(self, loss: float, coasting: float) -> float:
        """Power that leaves over power that enters, from the loss and its coasting part. [1]"""
        entering = self.entering + self.leaving + coasting
        return max(0.0, 1 - loss / entering) if entering else math.nan


@dataclass(frozen=True, slots=True)
class _Drive:
    """What a gearbox does, on a grid of operating points."""

    points: Sequence[Mapping[str, Any]]  # Keys of the case that each point of the grid changes.
    steps: tuple[_Step, ...]  # One after the other, repeated.
    plan: SweepPlan  # The grid.

    @property
    def mean(self) -> tuple[FloatArray, FloatArray]:
        """Weights of the heat and of the conductances over all steps."""
        durations = np.array([step.duration for step in self.steps])
        shares = durations / durations.sum()
        heating = shares @ np.array([step.heating for step in self.steps])
        return heating, shares @ np.array([step.flowing for step in self.steps])


def _constant(case: Case) -> _Drive:
    """The operating point of a case."""
    operation, one = build(case).operation, np.ones(1)
    power = operation.torque * operation.speeds[operation.input] if held_shaft(case) else math.nan
    coasting = one if power <= 0 else np.zeros(1)
    step = _Step(1.0, one, coasting, one, max(power, 0.0), max(-power, 0.0))
    return _Drive([{}], (step,), SweepPlan(case.updated({"models.temperatures": "inlet"})))


def _driven(case: Case, seconds: float, cycle: Cycle) -> _Drive:
    """A cycle: a time series in steps, a histogram as one step. Theory (W37)."""
    if not held_shaft(case):
        raise InputError([driven_problem("only one speed and one torque can be looked up")])
    # The points of the grid, at one temperature.
    even = case.updated({"models.temperatures": "inlet"})
    plan = grid_plan(even, cycle, (SPEEDS, TORQUES, CROWD))
    points = [plan.changes(index) for index in range(plan.size)]
    for changes in points:
        changes.pop(AXES["temperature"], None)  # a train of given losses has none
    sizes = {axis_name(axis.key): np.array(axis.coordinate) for axis in plan.axes}
    sizes.pop("temperature", None)
    states = tuple(map(str, sizes.get(STATE, ())))
    if states:
        sizes[STATE] = np.arange(1.0, len(states) + 1)
    shape = tuple(axis.size for axis in sizes.values())
    grid = Lookup(tuple(sizes), tuple(sizes.values()), states, (), np.zeros((0, *shape)))
    return _Drive(points, tuple(_steps(cycle, grid, seconds / MOST_STEPS)), plan)


def _steps(cycle: Cycle, grid: Lookup, width: float) -> Iterator[_Step]:
    """Rows of a time series together until they last `width`, those of a histogram all together."""
    count, nodes = MOST_STEPS + 1, grid.size  # what comes after the end goes into the last
    duration, entering, leaving = np.zeros((3, count))
    heating, coasting, flowing = np.zeros((3, count, nodes))
    begin = 0.0
    for piece in cycle.pieces():
        ends = begin + np.cumsum(piece.duration)
        begin = ends[-1]
        number = np.zeros(piece.speed.shape, np.intp)
        if cycle.weighting == TIME:
            number = np.minimum((ends - piece.duration) / width, MOST_STEPS).astype(np.intp)
        corners, weights = grid.corners(*point_of(grid, cycle, piece))
        power = shaft_power(piece.torque, piece.speed)
        turned = shaft_power(piece.duration, np.abs(piece.speed))
        for sums, amount in (
            (heating, turned),
            (coasting, turned * (power <= 0)),
            (flowing, piece.duration),
        ):
            place = (corners + nodes * number).ravel()
            sums += np.bincount(place, (weights * amount).ravel(), sums.size).reshape(sums.shape)
        for sums, amount in (
            (duration, piece.duration),
            (entering, np.maximum(power, 0) * piece.duration),
            (leaving, np.maximum(-power, 0) * piece.duration),
        ):
            sums += np.bincount(number, amount, count)
    # losses over the speed are nearer to straight lines than losses
    speeds = grid.axes[grid.names.index("speed")]
    per_speed = shaft_power(np.ones_like(speeds), speeds)
    speeds_of_nodes = np.broadcast_to(per_speed[:, None], grid.torques.shape[1:]).ravel()
    for row in np.flatnonzero(duration[:MOST_STEPS]):
        yield _Step(
            duration[row],
            heating[row] / duration[row] / speeds_of_nodes,
            coasting[row] / duration[row] / speeds_of_nodes,
            flowing[row] / duration[row],
            float(entering[row] / duration[row]),
            float(leaving[row] / duration[row]),
        )


def _sampled(
    case: Case, drive: _Drive, knots: list[float], progress: Progress | None
) -> list[list[HeatSample]]:
    """The grid solved at some temperatures."""
    key = AXES["temperature"]
    tables: FlowTables = {}
    stated = [knot for knot in knots if CELSIUS.to_display(knot) <= (START.high or math.inf)]
    if stated:  # no case has hotter oil
        (axis,) = make_plan(drive.plan.case, {key: texts_of(stated, KELVIN)}).axes
        others = tuple(other for other in drive.plan.axes if other.key != key)
        plan = replace(drive.plan, axes=(*others, axis))
        tables = plan.prepared(range(plan.size), None).flow_tables
    return heat_samples(case, drive.points, knots, tables, progress)


@dataclass(frozen=True, slots=True)
class _Told:
    """A course, with what is lost on it; arrays over time come last."""

    course: Course
    losses: FloatArray  # [W]
    efficiency: FloatArray  # [1]


def _run(
    tables: HeatTables, drive: _Drive, begin: FloatArray, seconds: float, progress: Progress | None
) -> _Told:
    """The steps of a drive, repeated until the end."""
    if len(drive.steps) == 1:
        (step,) = drive.steps
        times = seconds * np.linspace(0, 1, TIMES) ** 2  # it is fastest at the beginning
        course = tables.transient(step.heating, step.flowing).integrate(begin, times)
        rows = [_lost(tables, step, values) for values in course.temperatures.T]
    else:
        ends, temperatures, energies = [0.0], [begin], [np.zeros(2)]
        rows = [_lost(tables, drive.steps[0], begin)]
        for step in itertools.cycle(drive.steps):
            end = min(ends[-1] + step.duration, seconds)
            transient = tables.transient(step.heating, step.flowing)
            part = transient.integrate(temperatures[-1], np.array([ends[-1], end]), TOLERANCE)
            ends.append(end)
            temperatures.append(part.temperatures[:, -1])
            energies.append(energies[-1] + [part.gained[-1], part.given_off[-1]])
            rows.append(_lost(tables, step, temperatures[-1]))
            if progress is not None:
                progress(round(end), round(seconds))
            if end >= seconds:
                break
        gained, given_off = np.transpose(energies)
        course = Course(np.array(ends), np.transpose(temperatures), gained, given_off)
    losses, efficiencies = zip(*rows, strict=True)
    return _Told(course, np.transpose(losses), np.array(efficiencies))


def _lost(tables: HeatTables, step: _Step, temperatures: FloatArray) -> tuple[FloatArray, float]:
    """Every loss [W], and the efficiency."""
    heat, _ = tables.heat(step.heating).read(temperatures)
    coasting, _ = tables.heat(step.coasting).read(temperatures)
    return tables.losses(heat), step.efficiency(float(heat.sum()), float(coasting.sum()))


def _runaway(tables: HeatTables, course: Course) -> ConvergenceError:
    row = int(np.argmax(course.temperatures.max(axis=0) > HOTTEST))
    node = list(tables.capacities)[int(course.temperatures[:, row].argmax())]
    return ConvergenceError(
        f"thermal runaway: within {SECOND.text(course.times[row], 3)} {node} exceeds "
        f"{celsius_text(HOTTEST, 4)}. Remove more heat: thermal.oil_flow, "
        "thermal.cooler_conductance, a larger [thermal.housing]."
    )


def _to_dataset(
    case: Case,
    tables: HeatTables,
    drive: _Drive,
    told: _Told,
    seconds: float,
    settled: FloatArray | None,
) -> xr.Dataset:
    import xarray as xr

    course = told.course
    nodes = list(tables.capacities)
    heating, flowing = drive.mean
    ends = np.full(len(nodes), math.nan) if settled is None else settled
    constants = (
        ends if settled is None else tables.transient(heating, flowing).time_constants(settled)
    )
    settled_loss = tables.heat(heating).read(ends)[0].sum()
    capacities = np.array(list(tables.capacities.values()))
    stored = capacities @ (course.temperatures - course.temperatures[:, :1])
    over, each = ("time",), ("node",)
    table = (
        ("temperature", ("time", "node"), course.temperatures.T, "temperature", CELSIUS),
        ("loss", ("time", "component"), told.losses.T, "power loss", WATT),
        ("total_loss", over, told.losses.sum(axis=0), "power loss of all components", WATT),
        ("efficiency", over, told.efficiency, "efficiency", NUMBER),
        ("energy_lost", over, course.gained, "energy lost since the start", KILOJOULE),
        ("energy_given_off", over, course.given_off,
         "energy given off to oil inlet, coolant and air since the start", KILOJOULE),
        ("energy_stored", over, stored, "energy stored since the start", KILOJOULE),
        ("heat_capacity", each, capacities, "heat capacity", JOULE_PER_KELVIN),
        ("settled_temperature", each, ends, "temperature in the settled state", CELSIUS),
        ("time_to_90_percent", each, _times_reached(course, ends),
         "time to 90 % of the way to the settled state", SECOND),
        ("time_constant", ("order",), constants,
         "time constant of small changes about the settled state", SECOND),
        ("energy_lost_settled", (), settled_loss * seconds,
         "energy lost if the settled state held from the start", KILOJOULE),
    )  # fmt: skip
    return xr.Dataset(
        {name: variable(dims, it, label, unit) for name, dims, it, label, unit in table},
        {
            "time": variable("time", course.times, "time", SECOND),
            "node": nodes,
            "component": list(tables.terms),
        },
        {
            "title": case.title,
            **origin(case),
            "temperatures_of_the_tables": ", ".join(CELSIUS.text(it, 4) for it in tables.knots),
        },
    )


def _times_reached(course: Course, ends: FloatArray) -> FloatArray:
    """When each node has come `REACHED` of the way from its start to the end; NaN if never. [s]"""
    start = course.temperatures[:, 0]
    whole = np.where(ends == start, np.nan, ends - start)
    way = (course.temperatures - start[:, None]) / whole[:, None]
    first = [np.argmax(row >= REACHED) if (row >= REACHED).any() else 0 for row in way]
    found = [
        np.interp(REACHED, row[at - 1 : at + 1], course.times[at - 1 : at + 1]) if at else math.nan
        for row, at in zip(way, first, strict=True)
    ]
    return np.array(found)
