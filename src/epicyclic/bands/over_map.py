"""How well the losses of a map are known: the same samples of all inputs at each of its points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.solve import solve
from epicyclic.bands.curves import fit_curves
from epicyclic.bands.plan import SampledCase, SamplePlan, check_samples, sampled_case
from epicyclic.bands.sampling import make_samples
from epicyclic.bands.statistics import COVERAGE, index_values
from epicyclic.bands.study import LABELS, UNIT_OF_RESULT, about_inputs, drivers_of, summaries
from epicyclic.case.operating import AXES, axis_name
from epicyclic.maps.compute import MapPlan, stored_plan
from epicyclic.sweeps.journal import Rows
from epicyclic.units import NEWTON_METRE, RPM

if TYPE_CHECKING:
    import xarray as xr

FloatArray = NDArray[np.float64]

SAMPLES = 32
"""Points in each of the two sets."""
TORQUE_LOSS = "torque_loss"
INDICES = {
    "first_order": "share of the variance of the total loss, alone",
    "total_order": "share of the variance of the total loss, with interactions",
}
EXPLAINED = "share of the variance of the total loss that curves through the samples explain"
DRAWN = 256
"""Points in each set that shares are found by, from curves."""
UNITS = {"efficiency": "1", TORQUE_LOSS: NEWTON_METRE.display}


def map_study(data: xr.Dataset, samples: int | None = None, seed: int = 1) -> MapStudy:
    """What has to be solved for the uncertainty of a loss map; see `uncertainty`."""
    count = SAMPLES if samples is None else samples
    check_samples(count)
    grid = stored_plan(data)
    points = [grid.changes(number) for number in range(grid.size)]
    sampled = sampled_case(grid.case, solve(grid.case), count, seed, points)
    return MapStudy(data, grid, sampled, seed)


@dataclass(frozen=True, slots=True)
class MapStudy:
    """The samples of all points of a map."""

    data: xr.Dataset  # The map.
    grid: MapPlan
    sampled: SampledCase
    seed: int

    @property
    def plan(self) -> SamplePlan:
        """Samples A and B at every point."""
        return self.sampled.plan

    def dataset(self, rows: Rows) -> xr.Dataset:
        """The map with what the samples say; see `uncertainty`."""
        import xarray as xr

        found = np.moveaxis(self.sampled.results(rows, mixed=False), 1, 2)
        points = found.reshape(*found.shape[:2], -1)
        indices, explained = self._indices(points)
        whole = self._with_torque_loss(points)
        total = whole[:, -3]
        values = self.sampled.samples[0].values
        names = (*self.sampled.outputs.names, TORQUE_LOSS)
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
        outputs, own = self.sampled.outputs, self.sampled.samples
        drawn = cache(lambda values: make_samples(values, DRAWN, self.seed))
        shares, explained = np.zeros((len(own), 2, len(own[0].groups))), np.zeros(len(own))
        for number, (samples, losses) in enumerate(zip(own, results, strict=True)):
            curves = fit_curves(outputs.load_dependent, samples, losses[: len(outputs.losses)])
            explained[number] = curves.explained
            sets = curves.sets(drawn(samples.values))[:, -1:]
            if not np.isfinite(curves.explained):
                shares[number] = np.nan
            elif np.ptp(sets) > 0:
                found = index_values(sets[0], sets[1], sets[2:])
                shares[number] = np.concatenate(found)
        return shares, explained

    def _with_torque_loss(self, results: FloatArray) -> FloatArray:
        """Results of all points, shape (p, s, m), and the torque loss; at rest without power."""
        (speeds,) = (axis for axis in self.grid.axes if axis.key == AXES["speed"])
        place = self.grid.axes.index(speeds)
        rpm = np.array(speeds.coordinate, float)
        to_rpm, _ = RPM.scale_and_offset()
        number = np.unravel_index(np.arange(self.grid.size), self.grid.shape)[place]
        own = np.abs(rpm[number])[:, None, None] / to_rpm
        with np.errstate(divide="ignore", invalid="ignore"):
            torque_loss = np.where(own > 0, results[:, -2:-1] / own, np.nan)
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
