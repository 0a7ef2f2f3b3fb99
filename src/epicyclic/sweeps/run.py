"""Run a sweep."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.analysis.solve import solve
from epicyclic.case.case import Case
from epicyclic.pocketing.table import FlowTables
from epicyclic.sweeps.dataset import to_dataset
from epicyclic.sweeps.journal import Journal, Row
from epicyclic.sweeps.plan import Points, make_plan
from epicyclic.sweeps.pockets import flow_tables
from epicyclic.sweeps.work import BATCH, Progress, guarded, run_work

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["run_plan", "sweep"]


def sweep(
    case: Case,
    vary: Mapping[str, Iterable[Any]],
    *,
    jobs: int | None = None,
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
    journal : str or Path, optional
        File that keeps finished points, so that an interrupted sweep goes on where it stopped.
        It stays when the sweep is done, and is refused by another sweep.
    progress : callable, optional
        Called with the number of finished points and of all points.

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
    plan = make_plan(case, vary)
    # absolute, because workers may have been started in another folder
    kept = None if journal is None else Journal(Path(journal).absolute(), plan.fingerprint())
    return to_dataset(plan, run_plan(plan, jobs=jobs, journal=kept, progress=progress))


@dataclass(frozen=True, slots=True)
class _Cases:
    """Cases as work, with what they share."""

    points: Points
    flow_tables: FlowTables

    def order(self) -> Sequence[int]:
        """Those that share geometry next to each other."""
        return self.points.order()

    def solve(self, index: int) -> Row:
        """One case as a flat record."""
        return guarded(lambda: _solve_point(self, index))


def run_plan(
    plan: Points,
    *,
    jobs: int | None = None,
    journal: Journal | None = None,
    progress: Progress | None = None,
    batch: int = BATCH,
) -> list[Row]:
    """Rows of all points of `plan`, in their order.

    Parameters as for `sweep`; `batch` is the number of points that one worker should compute
    together.
    """
    work = _Cases(plan, flow_tables(plan, jobs))
    rows: dict[int, Row] = {}
    for finished in run_work(work, jobs=jobs, journal=journal, batch=batch):
        rows.update(finished)
        if progress is not None:
            progress(len(rows), plan.size)
    return [rows[index] for index in range(plan.size)]


def _solve_point(work: _Cases, index: int) -> Row:
    case = work.points.case.updated(work.points.changes(index))
    result = solve(case, flow_tables=work.flow_tables)
    return Row(
        status=str(result.status),
        warnings=" | ".join(result.warnings),
        numbers={item.key: item.value for item in result.numbers()},
    )
