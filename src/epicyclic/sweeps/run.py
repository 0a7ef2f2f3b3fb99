"""Run a sweep."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.case.case import Case
from epicyclic.sweeps.dataset import to_dataset
from epicyclic.sweeps.plan import make_plan
from epicyclic.sweeps.runner import Progress, Runner

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["sweep"]


def sweep(
    case: Case,
    vary: Mapping[str, Iterable[Any]],
    *,
    jobs: int | None = None,
    dask: str | None = None,
    shard: tuple[int, int] | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Losses over the full product of the values of some keys.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
        Every key that is not varied stays as it is here.
    vary : mapping of str to iterable
        Dotted keys to values, ``{"operation.speed": ["1000 rpm", "2000 rpm"]}``: numbers, text
        with units, choices, names.
    jobs : int, optional
        Worker processes. Default: one for each core if the work is worth it, else none.
    dask : str, optional
        Address of the scheduler of a Dask cluster that takes their place.
    shard : (int, int), optional
        Which share of the points to compute, and of how many: ``(2, 8)``. Points of other shards
        have NaN and the status ``"not computed"``; ``epicyclic merge`` makes one file of journals
        of all shards.
    journal : str or Path, optional
        File that keeps finished points, so that an interrupted sweep goes on where it stopped.
        It stays when the sweep is done, and is refused by another sweep.
    progress : callable, optional
        Called with the number of finished points and of all points, or of those of the shard.

    Returns
    -------
    xarray.Dataset
        One dimension for each key, every number with its unit; points that failed have NaN, the
        status ``"failed"`` and the reason in ``message``. Which variables there are depends on
        the kind of the case only.

    Raises
    ------
    InputError
        If a key cannot be varied, a value cannot be read, or the journal is that of another
        sweep.
    """
    runner = Runner(jobs, dask, shard, journal, progress)
    plan = make_plan(case, vary)
    return to_dataset(plan, runner.run(plan))
