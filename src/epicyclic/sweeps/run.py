"""Run a sweep: in this process while it is short, on all cores when it is long."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from epicyclic.analysis.solve import solve
from epicyclic.case.case import Case
from epicyclic.errors import EpicyclicError, InputError, is_interrupt
from epicyclic.status import Status
from epicyclic.sweeps.dataset import to_dataset
from epicyclic.sweeps.journal import Journal, Row
from epicyclic.sweeps.plan import Points, make_plan

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["run_plan", "sweep"]

Progress = Callable[[int, int], None]

BATCH = 16
"""Largest number of points that a worker is given at once, which share geometry where they can."""
BATCHES_PER_WORKER = 4
"""Fewer would leave workers idle at the end."""
WORKER_START_SECONDS = 4.0
"""Work left, in seconds on one core, below which starting worker processes does not pay."""
TRIAL_POINTS, TRIAL_SECONDS = 16, 2.0
"""Points computed, or time spent on them, before the work left is estimated."""


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
    rows = {} if journal is None else journal.read()
    left = [index for index in plan.order() if index not in rows]
    if progress is not None:
        progress(len(rows), plan.size)
    for finished in _run_batches(plan, left, jobs, journal, batch):
        rows.update(finished)
        if progress is not None:
            progress(len(rows), plan.size)
    return [rows[index] for index in range(plan.size)]


def _run_batches(
    plan: Points, indices: list[int], jobs: int | None, journal: Journal | None, batch: int
) -> Iterator[list[tuple[int, Row]]]:
    """Finished points, in any order: here as long as that pays, then in worker processes."""
    start = time.perf_counter()
    for done, index in enumerate(indices):
        if done == 1:  # the first point also pays for compilation
            start = time.perf_counter()
        workers_pay = jobs is None and _workers_pay(
            done - 1, time.perf_counter() - start, len(indices) - done
        )
        if workers_pay or jobs not in (None, 1):
            yield from _run_in_workers(plan, indices[done:], jobs or -1, journal, batch)
            return
        yield _solve_batch(plan, [index], journal)


def _workers_pay(done: int, seconds: float, left: int) -> bool:
    """Whether to start workers for the points `left`, `done` having taken `seconds`."""
    if done < 1 or (done < TRIAL_POINTS and seconds < TRIAL_SECONDS):
        return False
    return left * seconds / done > WORKER_START_SECONDS


def _run_in_workers(
    plan: Points, indices: list[int], jobs: int, journal: Journal | None, batch: int
) -> Iterator[list[tuple[int, Row]]]:
    from joblib import Parallel, delayed, effective_n_jobs

    share = len(indices) // (BATCHES_PER_WORKER * effective_n_jobs(jobs))
    size = min(batch, max(1, share))
    workers = Parallel(n_jobs=jobs, return_as="generator_unordered", inner_max_num_threads=1)
    yield from workers(
        delayed(_solve_batch)(plan, points, journal) for points in _batches(plan, indices, size)
    )


def _batches(plan: Points, indices: list[int], size: int) -> Iterator[list[int]]:
    """`indices` cut at multiples of `size` in the order of all points, whatever is done already."""
    place = {index: i for i, index in enumerate(plan.order())}
    for _, points in groupby(indices, key=lambda index: place[index] // size):
        yield list(points)


def _solve_batch(
    plan: Points, indices: Sequence[int], journal: Journal | None
) -> list[tuple[int, Row]]:
    rows = []
    for index in indices:
        row = _solve_point(plan, index)
        if journal is not None:
            journal.append(index, row)
        rows.append((index, row))
    return rows


def _solve_point(plan: Points, index: int) -> Row:
    """One point of `plan` as a flat record; one that fails becomes a row with its reason."""
    try:
        result = solve(plan.case.updated(plan.changes(index)))
    except InputError as error:
        return _failed("; ".join(str(problem) for problem in error.problems))
    except EpicyclicError as error:
        return _failed(str(error))
    except Exception as error:  # whatever it is, the other points do not suffer
        if is_interrupt(error):
            raise KeyboardInterrupt from error
        return _failed(f"{type(error).__name__}: {error}")
    return Row(
        status=str(result.status),
        warnings=" | ".join(result.warnings),
        numbers={item.key: item.value for item in result.numbers()},
    )


def _failed(message: str) -> Row:
    return Row(str(Status.FAILED), message)
