"""Run a sweep."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.case.case import Case
from epicyclic.sweeps.dataset import to_dataset
from epicyclic.sweeps.plan import make_plan
from epicyclic.sweeps.points import columns_of
from epicyclic.sweeps.runner import Progress, Runner

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


def sweep(
    case: Case,
    vary: Mapping[str, Iterable[Any]] | None = None,
    *,
    together: Iterable[Mapping[str, Iterable[Any]]] = (),
    points: str | Path | Mapping[str, Iterable[Any]] | pd.DataFrame | None = None,
    links: Mapping[str, str] | None = None,
    jobs: int | None = None,
    dask: str | None = None,
    shard: tuple[int, int] | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Losses over the full product of the values of some keys, or groups of keys.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
        Every key that is not varied stays as it is here.
    vary : mapping of str to iterable, optional
        Dotted keys to values, ``{"operation.speed": ["1000 rpm", "2000 rpm"]}``: numbers, text
        with units, choices, names.
    together : iterable of mapping, optional
        Groups of keys with as many values each, which change together. Each group is one
        dimension, named after its first key.
    points : str, Path, mapping or pandas.DataFrame, optional
        A table of points, one in each row, by its columns: a ``.csv`` file, or the same in memory.
        It is the dimension ``row``.
    links : mapping of str to str, optional
        Keys to expressions of others, ``{"ring.teeth": "sun.teeth + 2 * planet.teeth"}``. In that
        of a key, the key itself is its value in the case, as is ``case(KEY)`` of any.
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
        One dimension for each key or group, every number with its unit; points that failed have
        NaN, the status ``"failed"`` and the reason in ``message``. Which variables there are
        depends on the kind of the case only. Keys that change with others or follow from them are
        coordinates; the attributes ``together`` and ``links`` name them.

    Raises
    ------
    InputError
        If a key cannot be varied, a value cannot be read, a link has no value, or the journal is
        that of another sweep.
    """
    runner = Runner(jobs, dask, shard, journal, progress)
    table = points if points is None or isinstance(points, Mapping) else columns_of(points)
    plan = make_plan(case, vary, together=together, points=table, links=links)
    return to_dataset(plan, runner.run(plan))
