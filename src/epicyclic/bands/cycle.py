"""How well the energy that a duty cycle loses is known.

Some points of the cycle, drawn with a probability that grows with the energy lost there, stand for
all. Every sample of the inputs is solved at each of them: the inputs are the same throughout the
cycle, so that they do not average out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.solve import solve
from epicyclic.bands.curves import fit_curves
from epicyclic.bands.nearby import Nearby
from epicyclic.bands.outputs import Outputs, outputs_of
from epicyclic.bands.plan import SampledCase, SamplePlan, check_samples, nearby_at, sampled_case
from epicyclic.bands.sampling import make_samples
from epicyclic.bands.study import about_study, contributions, indices_of, sample_variables
from epicyclic.case.case import Case
from epicyclic.errors import ConvergenceError, InputError, Problem
from epicyclic.maps.cycle import Cycle
from epicyclic.maps.duty import Sums, add_up
from epicyclic.maps.interpolation_error import changes_at, further_values
from epicyclic.maps.lookup import loss_power
from epicyclic.maps.tables import map_case
from epicyclic.sweeps.journal import Rows
from epicyclic.sweeps.runner import HERE, Runner
from epicyclic.units import KILOJOULE

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]

SAMPLES = 64
"""Points in each of the two sets."""
POINTS = 16
"""Points of the cycle that every sample solves."""
DRAWN = 1024
"""Points in each set that indices are found by, from curves."""
EXPLAINED = "share of the variance of the total that curves through the samples explain"


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
        """Energies of the cycle, and its efficiency. Theory (U10).

        Returns
        -------
        ndarray of float, shape (s, n)
            [kJ], [1]
        """
        time = self.time.copy()
        if without is not None:
            time[without] = 0.0
        count = len(self.lost)
        found = np.einsum("ptn,p->tn", results[:, :count], time)
        by_map = self.interpolated @ time
        known = by_map > 0
        lost = self.lost[:, None] * np.where(
            known[:, None], found / np.where(known, by_map, 1.0)[:, None], 1.0
        )
        lost = np.where(np.isfinite(found), lost, np.nan)
        more = _entering(self.at_shaft[:, None], results[:, -2])
        more -= _entering(self.at_shaft, self.interpolated.sum(axis=0))[:, None]
        entering = self.entering + time @ more
        total = lost.sum(axis=0)
        if self.outputs.tested:
            alone, whole = (np.einsum("pn,p->n", results[:, row], time) for row in (-3, -2))
            independent = total * alone / whole
        else:
            independent = lost[~self.outputs.load_dependent].sum(axis=0)
        with np.errstate(divide="ignore", invalid="ignore"):
            efficiency = np.where(total < entering, 1 - total / entering, np.nan)
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


def _entering(at_shaft: FloatArray, loss: FloatArray) -> FloatArray:
    """Power that enters at either shaft."""
    found: FloatArray = np.maximum(at_shaft, 0.0) + np.maximum(loss - at_shaft, 0.0)
    return found


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
    count = SAMPLES if samples is None else samples
    check_samples(count)
    case = _case_of(data, celsius, points)
    result = solve(case)
    sums = add_up(data, cycle, celsius, samples=POINTS if points is None else points)
    energies = _energies(sums, outputs_of(case, result))
    nearby = nearby_at(case, result, energies.points, runner)
    sampled = sampled_case(case, result, count, seed, energies.points)
    return CycleStudy(case, cycle, energies, nearby, sampled, seed)


def _case_of(data: xr.Dataset, celsius: tuple[float, ...] | None, points: int | None) -> Case:
    problems = []
    if celsius is not None and len(celsius) > 1:
        allowed = "must be one for an uncertainty."
        problems.append(Problem("temperature", "", allowed, "Give the command for each."))
    if points is not None and points < 2:
        problems.append(Problem("points", str(points), "must be 2 or more.", f"Take {POINTS}."))
    case = map_case(data, further_values(data))
    if case is None:
        allowed = "is none of this version of the program."
        problems.append(Problem("case", "", allowed, "Compute the map again."))
    if problems or case is None:
        raise InputError(problems, "the command")
    return case


def _energies(sums: Sums, outputs: Outputs) -> Energies:
    lookup, (totals,), (sample,) = sums.lookup, sums.totals, sums.samples
    rows, chance = sample.drawn()
    if not len(rows):
        raise ConvergenceError("nothing is lost in the cycle, and nothing can be uncertain.")
    axes = [rows[:, number] for number in range(len(lookup.names))]
    nodes, weights = lookup.corners(*axes)
    speed, torque = axes[:2]
    by_name = dict(zip(lookup.components, lookup.torques, strict=True))
    nothing = np.zeros(lookup.size)
    torques = np.array([by_name.get(name, nothing).ravel() for name in outputs.losses])
    interpolated = loss_power((torques[:, nodes] * weights).sum(axis=1), speed)
    return Energies(
        outputs,
        tuple(changes_at(lookup, row) for row in rows.tolist()),
        loss_power(torque, speed) * np.sign(speed),
        rows[:, -1] / rows[:, -2] / chance,
        interpolated,
        torques @ totals.node_work.sum(axis=0),
        float(totals.energy_in.sum()),
        bool((chance == 1).all()),
    )


@dataclass(frozen=True, slots=True)
class CycleStudy:
    """The samples of the points that stand for a duty cycle."""

    case: Case
    cycle: Cycle
    energies: Energies
    nearby: tuple[Nearby, ...]  # At each point.
    sampled: SampledCase
    seed: int

    @property
    def plan(self) -> SamplePlan:
        """Samples A and B at every point."""
        return self.sampled.plan

    def dataset(self, rows: Rows) -> xr.Dataset:
        """The energies, and what the samples say of them; see `uncertainty`."""
        energies = self.energies
        results = self.sampled.results(rows, mixed=False)
        sets = np.array([energies.of(results[:, number]) for number in (0, 1)])
        both = np.moveaxis(results, 1, 2).reshape(len(results), results.shape[2], -1)
        nominal = np.array(
            [
                it.outputs.of(it.losses[:, None], np.array([it.input_power]), {})
                for it in self.nearby
            ]
        )
        data = sample_variables(
            sets, energies.of(nominal)[:, 0], self._contributions(nominal), self.sampled, rows, "kJ"
        )
        indices, explained = self._indices(np.concatenate([*sets], axis=1))
        error = {"long_name": "standard error of u_c by the choice of points", "units": "kJ"}
        return data.assign(
            **indices,
            curves_explain=((), explained, {"long_name": EXPLAINED, "units": "1"}),
            point_error=((), energies.point_error(both), error),
        ).assign_attrs(
            **about_study(
                self.case, energies.outputs, self.plan.count, self.seed, data.attrs["failed"]
            ),
            cycle=f"{self.cycle.source.name}, {self.cycle.rows} rows",
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
        drawn = make_samples(samples.values, DRAWN, self.seed)
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
        found: FloatArray = np.array([(above - below) / 2 for below, above in ends])
        return found
