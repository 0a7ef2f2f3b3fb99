"""Run a sweep: in this process while it is short, on all cores when it is long."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.analysis.result import Figure
from epicyclic.analysis.solve import solve
from epicyclic.case.case import Case
from epicyclic.errors import EpicyclicError, InputError
from epicyclic.sweeps.dataset import to_dataset
from epicyclic.sweeps.journal import Journal, Row
from epicyclic.sweeps.plan import Plan, make_plan

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["run_plan", "sweep"]

Progress = Callable[[int, int], None]

BATCH = 16
"""Cases computed between two entries in the journal."""
WORKER_START_SECONDS = 4.0
"""Work left, in seconds on one core, below which starting worker processes does not pay."""


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
        File that keeps finished cases, so that an interrupted sweep goes on where it stopped.
    progress : callable, optional
        Called with the number of finished cases and of all cases.

    Returns
    -------
    xarray.Dataset
        One dimension for each key, every variable with its unit; cases that failed have NaN, the
        status ``"failed"`` and the reason in ``message``.

    Raises
    ------
    InputError
        If a key cannot be varied or a value cannot be read.
    """
    plan = make_plan(case, vary)
    kept = None if journal is None else Journal(Path(journal), plan.fingerprint())
    rows = run_plan(plan, jobs=jobs, journal=kept, progress=progress)
    return to_dataset(plan, rows, _describe(plan, rows))


def _describe(plan: Plan, rows: Sequence[Row]) -> list[Figure]:
    """Label and unit of every number of the rows: those of one case, computed once more."""
    for index, row in enumerate(rows):
        if row["numbers"]:
            return list(solve(plan.case.updated(plan.changes(index))).numbers())
    return []


def run_plan(
    plan: Plan,
    *,
    jobs: int | None = None,
    journal: Journal | None = None,
    progress: Progress | None = None,
) -> list[Row]:
    """Rows of all cases of `plan`, in their order. Parameters as for `sweep`."""
    rows = {} if journal is None else journal.read()
    left = [index for index in plan.order() if index not in rows]
    if progress is not None:
        progress(len(rows), plan.size)
    for batch in _run_batches(plan, left, jobs):
        if journal is not None:
            journal.append(batch)
        rows.update(batch)
        if progress is not None:
            progress(len(rows), plan.size)
    return [rows[index] for index in range(plan.size)]


def _run_batches(
    plan: Plan, indices: list[int], jobs: int | None
) -> Iterator[list[tuple[int, Row]]]:
    """Finished batches, in any order."""
    batches = [indices[i : i + BATCH] for i in range(0, len(indices), BATCH)]
    if jobs is None:
        start = time.perf_counter()
        timed = 0
        while batches and timed < 2:  # the first batch also pays for compilation and caches
            if timed == 1:
                start = time.perf_counter()
            yield _solve_batch(plan, batches.pop(0))
            timed += 1
        left = (time.perf_counter() - start) * len(batches)
        jobs = 1 if left < WORKER_START_SECONDS else -1
    if jobs == 1:
        for batch in batches:
            yield _solve_batch(plan, batch)
        return
    from joblib import Parallel, delayed

    workers = Parallel(n_jobs=jobs, return_as="generator_unordered", inner_max_num_threads=1)
    yield from workers(delayed(_solve_batch)(plan, batch) for batch in batches)


def _solve_batch(plan: Plan, indices: Sequence[int]) -> list[tuple[int, Row]]:
    return [(index, solve_row(plan, index)) for index in indices]


def solve_row(plan: Plan, index: int) -> Row:
    """One case of `plan` as a flat record; a case that fails becomes a row with its reason."""
    try:
        result = solve(plan.case.updated(plan.changes(index)))
    except InputError as error:
        return _failed("; ".join(str(problem) for problem in error.problems))
    except (EpicyclicError, ArithmeticError) as error:
        return _failed(str(error))
    return {
        "status": str(result.status),
        "message": "",
        "warnings": " | ".join(result.warnings),
        "numbers": {item.key: item.value for item in result.numbers()},
    }


def _failed(message: str) -> Row:
    return {"status": "failed", "message": message, "warnings": "", "numbers": {}}
