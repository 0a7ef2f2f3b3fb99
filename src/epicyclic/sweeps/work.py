"""Many independent points: in this process while that is quick, else in workers or on a cluster.

Finished points are kept in a journal at once, and rows do not depend on order, workers or
interruptions as long as `Work.solve` is a function of the number of the point.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any, Protocol

from epicyclic.errors import EpicyclicError, InputError, Problem, is_interrupt
from epicyclic.status import Status
from epicyclic.sweeps.journal import Journal, Row

__all__ = ["Progress", "Work", "failed_row", "guarded", "run_work"]

Progress = Callable[[int, int], None]

BATCH = 16
"""Largest number of points that a worker is given at once, which share geometry where they can."""
BATCHES_PER_WORKER = 4
"""Fewer would leave workers idle at the end."""
WORKER_START_SECONDS = 4.0
"""Work left, in seconds on one core, below which starting worker processes does not pay."""
TRIAL_POINTS, TRIAL_SECONDS = 16, 2.0
"""Points computed, or time spent on them, before the work left is estimated."""


class Work(Protocol):
    """Points to compute, handed to every worker: small, and picklable."""

    def order(self) -> Sequence[int]:
        """Numbers of all points, those next to each other that share most."""
        ...

    def solve(self, index: int) -> Row:
        """Row of one point; raises nothing but an interruption."""
        ...


def run_work(
    work: Work,
    *,
    jobs: int | None = None,
    journal: Journal | None = None,
    batch: int = BATCH,
    cluster: str | None = None,
) -> Iterator[list[tuple[int, Row]]]:
    """Rows of all points of `work` with their numbers: those of the journal, then as they finish.

    Parameters
    ----------
    work : Work
    jobs : int, optional
        Worker processes. Default: one for each core if the work is worth it, else none.
    journal : Journal, optional
        Keeps finished points.
    batch : int
        Number of points that one worker should compute together.
    cluster : str, optional
        Address of a Dask scheduler that takes the place of worker processes.
    """
    rows = {} if journal is None else journal.read()
    left = [index for index in work.order() if index not in rows]
    yield list(rows.items())
    if cluster is not None:
        yield from _run_on_cluster(work, left, cluster, journal)
    else:
        yield from _run_batches(work, left, jobs, journal, batch)


def _run_batches(
    work: Work, indices: list[int], jobs: int | None, journal: Journal | None, batch: int
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
            yield from _run_in_workers(work, indices[done:], jobs or -1, journal, batch)
            return
        yield _solve_batch(work, [index], journal)


def _workers_pay(done: int, seconds: float, left: int) -> bool:
    """Whether to start workers for the points `left`, `done` having taken `seconds`."""
    if done < 1 or (done < TRIAL_POINTS and seconds < TRIAL_SECONDS):
        return False
    return left * seconds / done > WORKER_START_SECONDS


def _run_in_workers(
    work: Work, indices: list[int], jobs: int, journal: Journal | None, batch: int
) -> Iterator[list[tuple[int, Row]]]:
    from joblib import Parallel, delayed, effective_n_jobs

    share = len(indices) // (BATCHES_PER_WORKER * effective_n_jobs(jobs))
    size = min(batch, max(1, share))
    workers = Parallel(n_jobs=jobs, return_as="generator_unordered", inner_max_num_threads=1)
    if journal is not None:  # workers may have been started in another folder
        journal = replace(journal, path=journal.path.absolute())
    yield from workers(
        delayed(_solve_batch)(work, points, journal) for points in _batches(work, indices, size)
    )


def _batches(work: Work, indices: list[int], size: int) -> Iterator[list[int]]:
    """`indices` cut at multiples of `size` in the order of all points, whatever is done already."""
    place = {index: i for i, index in enumerate(work.order())}
    for _, points in groupby(indices, key=lambda index: place[index] // size):
        yield list(points)


def _run_on_cluster(
    work: Work, indices: list[int], address: str, journal: Journal | None
) -> Iterator[list[tuple[int, Row]]]:
    """The same on a Dask cluster; this process keeps the journal, workers may not see its disk."""
    distributed = _distributed()
    with _client(address) as client:
        futures = client.map(work.solve, indices, pure=False)
        numbers = dict(zip((future.key for future in futures), indices, strict=True))
        for future, row in distributed.as_completed(futures, with_results=True):
            index = numbers[future.key]
            if journal is not None:
                journal.append(index, row)
            yield [(index, row)]


def _distributed() -> Any:
    """The package of Dask clusters, which is no requirement."""
    try:
        import distributed
    except ImportError:
        problem = Problem(
            "--dask", "", "needs the package distributed.", 'Install "epicyclic[dask]".'
        )
        raise InputError([problem], "the command") from None
    return distributed


def _client(address: str) -> Any:
    """A connection to the scheduler at `address`."""
    try:
        return _distributed().Client(address, timeout="10s")
    except (OSError, ValueError) as error:
        problem = Problem(
            "--dask",
            f'"{address}"',
            f"cannot be reached: {error}.",
            "Give the address of a running scheduler, as in tcp://host:8786.",
        )
        raise InputError([problem], "the command") from None


def _solve_batch(
    work: Work, indices: Sequence[int], journal: Journal | None
) -> list[tuple[int, Row]]:
    rows = []
    for index in indices:
        row = work.solve(index)
        if journal is not None:
            journal.append(index, row)
        rows.append((index, row))
    return rows


def guarded(solve: Callable[[], Row]) -> Row:
    """The row of a point; one that fails becomes a row with its reason."""
    try:
        return solve()
    except InputError as error:
        return failed_row("; ".join(str(problem) for problem in error.problems))
    except EpicyclicError as error:
        return failed_row(str(error))
    except Exception as error:  # whatever it is, the other points do not suffer
        if is_interrupt(error):
            raise KeyboardInterrupt from error
        return failed_row(f"{type(error).__name__}: {error}")


def failed_row(message: str) -> Row:
    """The row of a point without numbers."""
    return Row(str(Status.FAILED), message)
