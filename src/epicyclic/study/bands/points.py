"""How well losses are known: of a case, over a map, over a duty cycle."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.arrays import FloatArray
from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass
from epicyclic.errors import ConvergenceError, InputError, Problem
from epicyclic.study.bands.plan import (
    Nearby,
    Outputs,
    check_samples,
    entering,
    nearby_at,
    outputs_of,
    sampled_case,
)
from epicyclic.study.bands.samples import COVERAGE, fit_curves, index_values, make_samples
from epicyclic.study.bands.study import (
    LABELS,
    UNIT_OF_RESULT,
    Study,
    about_inputs,
    about_study,
    contributions,
    drivers_of,
    indices_of,
    sample_variables,
    summaries,
    uncertainty_study,
)
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.maps.compute import MapPlan, changes_at, further_values, stored_plan
from epicyclic.study.maps.cycle import Cycle, open_cycle
from epicyclic.study.maps.duty import Sums, add_up, cycle_map, parse_temperatures
from epicyclic.study.maps.tables import map_case
from epicyclic.study.operating import AXES, axis_name, shaft_power
from epicyclic.study.solve import solve
from epicyclic.study.sweeps.runner import HERE, Progress, Rows, Runner
from epicyclic.units import KILOJOULE, NEWTON_METRE, RPM

if TYPE_CHECKING:
    import xarray as xr


# How well the losses of a map are known: the same samples of all inputs at each of its points.

SAMPLES = 32  # Points in each of the two sets.
TORQUE_LOSS = "torque_loss"
INDICES = {
    "first_order": "share of the variance of the total loss, alone",
    "total_order": "share of the variance of the total loss, with interactions",
}
EXPLAINED = "share of the variance of the total loss that curves through the samples explain"
DRAWN = 256  # Points in each set that shares are found by, from curves.
UNITS = {"efficiency": "1", TORQUE_LOSS: NEWTON_METRE.display}


def map_study(data: xr.Dataset, samples: int | None = None, seed: int = 1) -> MapStudy:
    """What has to be solved for the uncertainty of a loss map; see `uncertainty`."""
    count = SAMPLES if samples is None else samples
    check_samples(count, seed)
    grid = stored_plan(data)
    points = [grid.changes(number) for number in range(grid.size)]
    sampled = sampled_case(grid.case, solve(grid.case), count, seed, points)
    return MapStudy(grid.case, sampled, seed, data, grid)


@dataclass(frozen=True, slots=True)
class MapStudy(Study):
    """Samples A and B at every point of a map."""

    data: xr.Dataset  # The map.
    grid: MapPlan

    def dataset(self, rows: Rows) -> xr.Dataset:
        """The map with what the samples say; see `uncertainty`."""
        import xarray as xr

        found = np.moveaxis(self.sampled.results(rows, mixed=False), 1, 2)
        points = found.reshape(*found.shape[:2], -1)
        indices, explained = self._indices(points)
        whole = self._with_torque_loss(points)
        total = whole[:, -3]
        values = self.sampled.samples[0].values
        names = (*self.plan.outputs.names, TORQUE_LOSS)
        parts = [summaries(own) for own in whole]
        variables = {
            name: self._over("result", np.array([part[name] for part in parts]), label)
            for name, label in LABELS.items()
        }
        for number, (name, label) in enumerate(INDICES.items()):
            variables[name] = self._over("driver", indices[:, number], label, "1")
        nominal = [self._nominal(name) for name in names]
        failed = (~np.isfinite(total)).sum(axis=1)
        return self.data.assign(
            nominal=xr.concat(nominal, "result", coords="minimal", compat="override"),
            **variables,
            explained=self._over(None, explained, EXPLAINED, "1"),
            # spelled out: what is in W is a loss of the map
            sampled_total=self._over("sample", total, "total loss of the sample", "watt"),
            failed_samples=self._over(None, failed, "samples without a result", "1"),
            **about_inputs(values),
        ).assign_coords(
            result=list(names),
            unit=("result", [UNITS.get(name, "W") for name in names]),
            input=[value.key for value in values],
            driver=drivers_of(self.sampled.samples[0]),
        ).assign_attrs(
            samples=str(self.plan.count), seed=str(self.seed), failed=str(failed.sum()),
            coverage=str(COVERAGE),
        )  # fmt: skip

    def _indices(self, results: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Indices of the total loss by curves, shape (p, 2, g), and the share they explain."""
        outputs, own = self.plan.outputs, self.sampled.samples
        drawn = cache(lambda values: make_samples(values, DRAWN, self.seed))
        shares, explained = np.zeros((len(own), 2, len(own[0].groups))), np.zeros(len(own))
        for number, (samples, losses) in enumerate(zip(own, results, strict=True)):
            curves = fit_curves(outputs.load_dependent, samples, losses[: len(outputs.losses)])
            explained[number] = curves.explained
            sets = curves.sets(drawn(samples.values))[:, -1:]
            if np.ptp(sets) != 0:  # NaN with too few samples
                shares[number] = np.concatenate(index_values(sets[0], sets[1], sets[2:]))
        return shares, explained

    def _with_torque_loss(self, results: FloatArray) -> FloatArray:
        """Results of all points, shape (p, s, m), and the torque loss; at rest without power."""
        place = [axis.key for axis in self.grid.axes].index(AXES["speed"])
        number = np.unravel_index(np.arange(self.grid.size), self.grid.shape)[place]
        rpm = np.array(self.grid.axes[place].coordinate, float)[number]
        to_rpm, _ = RPM.scale_and_offset()
        own = np.abs(rpm)[:, None, None] / to_rpm
        with np.errstate(divide="ignore", invalid="ignore"):
            torque_loss = np.where(own > 0, results[:, -2:-1] / own, np.nan)
        # the plan creeps where the map is at rest
        resting = self.data["speed"].values[number] == 0
        results[resting, :-1] *= 0.0  # all but the efficiency; failed samples stay so
        return np.concatenate([results, torque_loss], axis=1)

    def _over(
        self, first: str | None, values: NDArray[Any], label: str, unit: str = UNIT_OF_RESULT
    ) -> Any:
        """Values of all points, shape (p, ...), over the axes of the map behind `first`."""
        dims = [axis_name(axis.key) for axis in self.grid.axes]
        shaped = np.moveaxis(values, 0, -1).reshape(*values.shape[1:], *self.grid.shape)
        about = {"long_name": label, "units": unit}
        return ([*([] if first is None else [first]), *dims], shaped, about)

    def _nominal(self, name: str) -> xr.DataArray:
        """What the map itself has."""
        known = self.data.get(name, np.nan * self.data["total"])
        return known.assign_attrs(long_name="result of the map", units=UNIT_OF_RESULT).rename(
            "nominal"
        )


# How well the energy that a duty cycle loses is known.
#
# Some points of the cycle, drawn with a probability that grows with the energy lost there, stand
# for all. Every sample of the inputs is solved at each of them: the inputs are the same throughout
# the cycle, so that they do not average out.

CYCLE_SAMPLES = 64  # Points in each of the two sets.
POINTS = 16  # Points of the cycle that every sample solves.
CYCLE_DRAWN = 1024  # Points in each set that indices are found by, from curves.
CYCLE_EXPLAINED = "share of the variance of the total that curves through the samples explain"


@dataclass(frozen=True, slots=True)
class Energies:
    """How the energy of a cycle follows from the losses at some of its points."""

    outputs: Outputs
    points: tuple[dict[str, Any], ...]  # What they change in the case.
    at_shaft: FloatArray  # Power of the reference shaft. [W]
    # What each stands for: its own time over the probability that it was drawn with. [s]
    time: FloatArray
    interpolated: FloatArray  # Losses in the map of the cycle. [W]
    lost: FloatArray  # Energies of the whole cycle by the map. [J]
    entering: float  # Energy that enters, by the map. [J]
    whole: bool  # True if the points are all of the cycle.

    def of(
        self,
        results: FloatArray,  # At the points, as `Outputs.names` has them. [W]
        without: int | None = None,  # Number of a point to leave out.
    ) -> FloatArray:
        """Energies of the cycle, and its efficiency. Theory (U10). [kJ], [1]"""
        time = self.time.copy()
        if without is not None:
            time[without] = 0.0
        found = np.einsum("ptn,p->tn", results[:, : len(self.lost)], time)
        by_map = self.interpolated @ time
        known = by_map > 0
        lost = self.lost[:, None] * np.where(
            known[:, None], found / np.where(known, by_map, 1.0)[:, None], 1.0
        )
        lost = np.where(np.isfinite(found), lost, np.nan)
        more = entering(self.at_shaft[:, None], results[:, -2])
        more -= entering(self.at_shaft, self.interpolated.sum(axis=0))[:, None]
        power = self.entering + time @ more
        total = lost.sum(axis=0)
        if self.outputs.tested:
            alone, whole = (np.einsum("pn,p->n", results[:, row], time) for row in (-3, -2))
            independent = total * alone / whole
        else:
            independent = lost[~self.outputs.load_dependent].sum(axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            efficiency = np.where(power > 0, np.maximum(0.0, 1 - total / power), np.nan)
        kilo, _ = KILOJOULE.scale_and_offset()
        return np.vstack(
            [kilo * np.vstack([lost, total - independent, independent, total]), efficiency]
        )

    def point_error(self, results: FloatArray) -> float:
        """Standard error of u_c of the total, because some points stand for all. Theory (U11). [kJ]

        By leaving out each of them in turn; 0 if they are all of the cycle.
        """
        count = len(self.points)
        if self.whole or count < 2:
            return 0.0 if self.whole else math.nan
        spreads = [np.nanstd(self.of(results, number)[-2], ddof=1) for number in range(count)]
        return float(math.sqrt(count - 1) * np.std(spreads))


def cycle_study(
    data: xr.Dataset,  # A loss map.
    cycle: Cycle,
    celsius: tuple[float, ...] | None = None,  # As for `uncertainty`.
    samples: int | None = None,  # As for `uncertainty`.
    points: int | None = None,  # As for `uncertainty`.
    seed: int = 1,  # As for `uncertainty`.
    runner: Runner = HERE,  # Runner of the solutions with one input changed.
) -> CycleStudy:
    """What has to be solved for the uncertainty of the energy of a cycle; see `uncertainty`."""
    count = CYCLE_SAMPLES if samples is None else samples
    check_samples(count, seed)
    problems = []
    if celsius is not None and len(celsius) > 1:
        allowed = "must be a single value for an uncertainty analysis."
        problems.append(Problem("temperature", "", allowed, "Run the command for each value."))
    if points is not None and points < 2:
        problems.append(Problem("points", str(points), "must be 2 or more.", f"Take {POINTS}."))
    case = map_case(data, further_values(data))
    if case is None:
        allowed = "was not made by this version of the program."
        problems.append(Problem("case", "", allowed, "Compute the map again."))
    if problems or case is None:
        raise InputError(problems, "the command")
    result = solve(case)
    sums = add_up(data, cycle, celsius, samples=POINTS if points is None else points)
    energies = _energies(sums, outputs_of(case, result))
    nearby = nearby_at(case, result, energies.points, runner)
    sampled = sampled_case(case, result, count, seed, energies.points)
    return CycleStudy(case, sampled, seed, cycle, energies, nearby)


def _energies(sums: Sums, outputs: Outputs) -> Energies:
    lookup, (totals,) = sums.lookup, sums.totals
    rows, chance = totals.sample.drawn()
    if not len(rows):
        raise ConvergenceError("the cycle has no loss, so no uncertainty can be computed.")
    axes = [rows[:, number] for number in range(len(lookup.names))]
    nodes, weights = lookup.corners(*axes)
    speed, torque = axes[:2]
    by_name = dict(zip(lookup.components, lookup.torques, strict=True))
    nothing = np.zeros(lookup.size)
    torques = np.array([by_name.get(name, nothing).ravel() for name in outputs.losses])
    interpolated = shaft_power((torques[:, nodes] * weights).sum(axis=1), np.abs(speed))
    return Energies(
        outputs,
        tuple(changes_at(lookup, row) for row in rows.tolist()),
        shaft_power(torque, speed),
        rows[:, -1] / rows[:, -2] / chance,
        interpolated,
        torques @ totals.node_work.sum(axis=0),
        float(totals.energy_in.sum()),
        bool((chance == 1).all()),
    )


@dataclass(frozen=True, slots=True)
class CycleStudy(Study):
    """Samples A and B at every point that stands for a duty cycle."""

    cycle: Cycle
    energies: Energies
    nearby: tuple[Nearby, ...]  # At each point.

    def dataset(self, rows: Rows) -> xr.Dataset:
        """The energies, and what the samples say of them; see `uncertainty`."""
        energies = self.energies
        results = self.sampled.results(rows, mixed=False)
        sets = np.array([energies.of(results[:, number]) for number in (0, 1)])
        both = np.moveaxis(results, 1, 2).reshape(len(results), results.shape[2], -1)
        nominal = np.array([it.nominal for it in self.nearby])[:, :, None]
        data = sample_variables(
            sets, energies.of(nominal)[:, 0], self._contributions(nominal), self.sampled, rows, "kJ"
        )
        indices, explained = self._indices(np.concatenate([*sets], axis=1))
        error = {"long_name": "standard error of u_c due to the choice of points", "units": "kJ"}
        return data.assign(
            **indices,
            curves_explain=((), explained, {"long_name": CYCLE_EXPLAINED, "units": "1"}),
            point_error=((), energies.point_error(both), error),
        ).assign_attrs(
            **about_study(
                self.case, energies.outputs, self.plan.count, self.seed, data.attrs["failed"]
            ),
            cycle=self.cycle.title(),
            points=len(energies.points),
        )

    def _indices(self, energies: FloatArray) -> tuple[dict[str, Any], float]:
        """Sobol indices by curves through the energies of A and B, and what these explain."""
        samples, outputs = self.sampled.samples[0], self.energies.outputs
        if outputs.tested:
            mask, parts = np.array([True, False]), energies[-4:-2]
        else:
            mask, parts = outputs.load_dependent, energies[: len(outputs.losses)]
        curves = fit_curves(mask, samples, parts)
        drawn = make_samples(samples.values, CYCLE_DRAWN, self.seed)
        groups = range(len(samples.groups))
        return indices_of(curves.sets(drawn), groups, drawn, self.seed), curves.explained

    def _contributions(self, nominal: FloatArray) -> FloatArray:
        """Change of every energy for one standard deviation of each input."""
        changes = np.array([contributions(it) for it in self.nearby])
        ends = [
            [self.energies.of(nominal + sign * changes[:, number, :, None])[:, 0]
             for sign in (-1, 1)]
            for number in range(changes.shape[1])
        ]  # fmt: skip
        return np.array([(above - below) / 2 for below, above in ends])


def uncertainty(
    source: CaseSource | xr.Dataset,
    cycle: Any = None,
    temperature: Iterable[Any] | None = None,
    *,
    samples: int | None = None,
    points: int | None = None,
    seed: int = 1,
    jobs: int | None = None,
    dask: str | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Uncertainty of losses and efficiency, and its causes.

    Inputs and errors of models have the distributions of [uncertainty] in the case, or default
    ones. Two sets of scrambled Sobol points are drawn; for a single case each input is also
    exchanged between them. Over a map or a cycle the samples are the same at all points.

    Parameters
    ----------
    source : PlanetaryCase, GearPairCase, TrainCase or xarray.Dataset
        A dataset is a loss map.
    cycle : str, Path, pandas.DataFrame or mapping, optional
        A duty cycle, as for `duty_cycle`: the uncertainty is that of its energy lost.
    temperature : iterable, optional
        Oil inlet temperature of a cycle without a column of it: one.
    samples : int, optional
        Points in each of the two sets, a power of 2. Default: 256; 32 over a map, 64 over a cycle.
    points : int, optional
        Points of the cycle, that are solved with all samples. Default: 16.
    seed : int, optional
        Seed of the scrambling: equal ones give equal results, whatever computes them.
    jobs, dask, journal, progress
        As for `sweep`.

    Returns
    -------
    xarray.Dataset
        Over ``result``, every loss, their sums and the efficiency: ``nominal``, ``mean``,
        ``standard_uncertainty``, ``expanded_uncertainty`` (k = 2), ``low``, ``high`` (95 %,
        symmetric in probability), ``shortest_low``, ``shortest_high``. Over ``input`` and
        ``result``: ``contribution``, the change for one standard deviation. Over ``driver``, which
        is an input or several that are correlated: Sobol indices ``first_order`` and
        ``total_order`` with their 95 % intervals. Over ``sample``: ``drawn``, ``value``,
        ``status``, ``message``. Of a map the same over its axes, beside what the map has itself.
        There and of a cycle the indices follow from curves through the samples, and ``explained``,
        of a cycle ``curves_explain``, is the share of the variance that these explain. Of a cycle
        energies [kJ] take the place of losses, and ``point_error`` is the standard error
        of ``standard_uncertainty`` because some points stand for all.

    Raises
    ------
    InputError
        If the table [uncertainty] has problems; as for `duty_cycle`.
    ConvergenceError
        If the case itself, or hardly any sample of it, can be solved.
    """
    import xarray as xr

    runner = Runner(jobs, dask, None, journal, progress)
    study: Study
    source = source if isinstance(source, xr.Dataset) else as_case(source)
    if cycle is not None:
        checked = open_cycle(cycle)
        celsius = parse_temperatures(checked, temperature)
        within = Runner(jobs, dask, journal=None)
        data = cycle_map(source, checked, celsius, within) if isinstance(source, Case) else source
        study = cycle_study(data, checked, celsius, samples, points, seed, within)
    elif isinstance(source, Case):
        study = uncertainty_study(source, samples, seed)
    else:
        study = map_study(source, samples, seed)
    return study.dataset(runner.run(study.plan))
