"""How well losses are known: of a case, over a map, over a duty cycle."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.case.case import Case
from epicyclic.study.bands.points import CycleStudy, MapStudy, cycle_study, map_study
from epicyclic.study.bands.study import UncertaintyStudy, uncertainty_study
from epicyclic.study.maps.cycle import open_cycle
from epicyclic.study.maps.duty import cycle_map, parse_temperatures
from epicyclic.study.sweeps.runner import Progress, Runner

if TYPE_CHECKING:
    import xarray as xr

Study = UncertaintyStudy | CycleStudy | MapStudy
"""What is to be solved, and what follows from it."""


def uncertainty(
    source: Case | xr.Dataset,
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
    """How well losses and efficiency are known, and what that depends on.

    Inputs and the errors of models, as [uncertainty] of the case states them or as is assumed,
    are drawn at scrambled Sobol points, twice, and of a single case with each of them exchanged
    between the two. Over a map and a cycle they are the same at all operating points.

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
    runner = Runner(jobs, dask, None, journal, progress)
    study: Study
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
