"""Many independent points: in this process while that is quick, else in workers or on a cluster.

Finished points are kept in a journal at once, and rows do not depend on order, workers, shards or
interruptions as long as `Plan.solve` is a function of the number of the point.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import sys
import threading
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import metadata
from itertools import groupby
from pathlib import Path
from typing import Any, ClassVar, Self

from epicyclic.errors import EpicyclicError, InputError, Problem, is_interrupt
from epicyclic.garbage import look_seldom
from epicyclic.status import Status
from epicyclic.sweeps.journal import Journal, Row, Rows
from epicyclic.whole_file import make_folder

Progress = Callable[..., None]
Batch = list[tuple[int, Row]]

BATCHES_PER_WORKER = 4
"""Fewer would leave workers idle at the end."""
WORKER_START_SECONDS = 4.0
"""Work left, in seconds on one core, below which starting worker processes does not pay."""
PARENT_SECONDS = 0.5
"""Between two looks of a worker at whether its parent is alive."""
_ABOUT_LOCKS = "ignore:resource_tracker:UserWarning"
TRIAL_POINTS, TRIAL_SECONDS = 16, 2.0
"""Points computed, or time spent on them, before the work left is estimated."""


class Plan(ABC):
    """The points of a study, handed to every worker: small, and picklable."""

    kind: ClassVar[str]
    """Kind of the study: ``"sweep"``, ``"map"``."""
    may_fail: ClassVar[bool] = False
    """Whether points without a solution are to be expected."""

    @property
    def batch(self) -> int:
        """Largest number of points that a worker is given at once."""
        return 16

    @property
    def source(self) -> str:
        """The file whose folder holds the files that a case names; empty if there is none."""
        return ""

    @property
    @abstractmethod
    def size(self) -> int:
        """Number of points."""

    @abstractmethod
    def order(self) -> Sequence[int]:
        """Numbers of all points, those next to each other that share most."""

    def solve(self, index: int) -> Row:
        """Row of one point, with the reason if it fails; raises nothing but an interruption."""
        try:
            return self._solve(index)
        except InputError as error:
            return failed_row(_told(error))
        except EpicyclicError as error:
            return failed_row(str(error))
        except Exception as error:  # whatever it is, the other points do not suffer
            if is_interrupt(error):
                raise KeyboardInterrupt from error
            return failed_row(f"{type(error).__name__}: {error}")

    @abstractmethod
    def _solve(self, index: int) -> Row:
        """Row of one point."""

    @abstractmethod
    def describe(self) -> dict[str, Any]:
        """All that the rows follow, as JSON holds it."""

    def prepared(self, indices: Sequence[int], jobs: int | None) -> Self:
        """The plan with what the points `indices` share, made by up to `jobs` threads."""
        return self


def fingerprint(plan: Plan) -> str:
    """Follows the plan and the version: rows of equal ones are equal."""
    content = [plan.kind, metadata.version("epicyclic"), plan.describe()]
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:12]


@dataclass(frozen=True, slots=True)
class Runner:
    """How the points of a plan are computed: all with the same rows."""

    # Worker processes. Default: one for each core if the work is worth it, else none.
    jobs: int | None = None
    dask: str | None = None  # Address of the scheduler of a Dask cluster that takes their place.
    # Which share of the points, and of how many: (2, 8). Default: all.
    shard: tuple[int, int] | None = None
    journal: str | Path | None = None  # Keeps finished points.
    # Called with the number of finished points and of all, or of those of the share.
    progress: Progress | None = None
    tell_failures: bool = False  # Whether it is called with the number of failed points too.
    # How the rows are to be written, kept in the journal.
    output: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.shard is not None and not 1 <= self.shard[0] <= self.shard[1]:
            raise _no_shard("/".join(map(str, self.shard)))

    def check(self) -> None:
        """Raise `InputError` if there is no such cluster: before anything is written."""
        if self.dask is not None:
            _client(self.dask, trial=True).close()

    def run(self, plan: Plan) -> Rows:
        """All points of `plan`; those of other shards are not computed."""
        rows = Rows(plan.size)
        total, done, failed = len(share_of(plan, self.shard)), 0, 0
        for finished in self._finished(plan):
            for index, row in finished:
                rows.add(index, row)
                failed += row.status != Status.CONVERGED
            done += len(finished)
            if self.progress is not None:
                self.progress(done, total, *([failed] if self.tell_failures else []))
        return rows

    def _finished(self, plan: Plan) -> Iterator[Batch]:
        """Points with their numbers: those of the journal, then as they finish."""
        left = share_of(plan, self.shard)
        journal = None
        if self.journal is not None:
            # absolute, because workers may have been started in another folder
            journal = Journal(Path(self.journal).absolute(), fingerprint(plan))
            kept = journal.read()
            yield [(index, kept[index]) for index in left if index in kept]
            journal.begin(heading(plan, self.shard, self.output))
            left = [index for index in left if index not in kept]
        if not left:
            return
        plan = plan.prepared(left, self.jobs)
        if self.dask is not None:
            yield from _run_on_cluster(plan, left, self.dask, journal)
        else:
            yield from _run_here(plan, left, self.jobs, journal)

    def within(self, plan: Plan) -> Runner:
        """The same with a journal of its own for one of several plans, in the folder `journal`."""
        if self.journal is None:
            return self
        folder = Path(self.journal)
        make_folder(folder, "journal")
        return replace(self, journal=folder / f"{fingerprint(plan)}.partial")


HERE = Runner()
"""The points are computed here, or in workers if that pays, and not kept."""


def share_of(plan: Plan, shard: tuple[int, int] | None) -> list[int]:
    """Numbers of the points of a shard, which follow each other in the order of all."""
    order = list(plan.order())
    if shard is None:
        return order
    number, count = shard
    return order[len(order) * (number - 1) // count : len(order) * number // count]


def parse_shard(text: str | None) -> tuple[int, int] | None:
    """The option ``--shard 2/8``.

    Raises
    ------
    InputError
        If it is not of that form.
    """
    if text is None:
        return None
    match = re.fullmatch(r"\s*(\d{1,9})\s*/\s*(\d{1,9})\s*", text)
    if match is None:
        raise _no_shard(text)
    return Runner(shard=(int(match[1]), int(match[2]))).shard


def _no_shard(text: str) -> InputError:
    allowed = "must be I/N, with I from 1 to N."
    return InputError([Problem("--shard", text, allowed, "For example 2/8.")], "the command")


def heading(plan: Plan, shard: tuple[int, int] | None, output: Mapping[str, Any]) -> dict[str, Any]:
    """What a journal says of its study; the plan can be made of it again."""
    return {
        "kind": plan.kind,
        "version": metadata.version("epicyclic"),
        "source": plan.source,
        "shard": shard,
        "output": dict(output),
        "plan": plan.describe(),
    }


def _run_here(
    plan: Plan, indices: list[int], jobs: int | None, journal: Journal | None
) -> Iterator[Batch]:
    """Finished points, in any order: here as long as that pays, then in worker processes."""
    start = time.perf_counter()
    for done, index in enumerate(indices):
        if done == 1:  # the first point also pays for compilation
            start = time.perf_counter()
        workers_pay = jobs is None and _workers_pay(
            done - 1, time.perf_counter() - start, len(indices) - done
        )
        if workers_pay or jobs not in (None, 1):
            yield from _run_in_workers(plan, indices[done:], jobs or -1, journal)
            return
        yield _solve_batch(plan, [index], journal)


def _workers_pay(done: int, seconds: float, left: int) -> bool:
    """Whether to start workers for the points `left`, `done` having taken `seconds`."""
    if done < 1 or (done < TRIAL_POINTS and seconds < TRIAL_SECONDS):
        return False
    return left * seconds / done > WORKER_START_SECONDS


def _run_in_workers(
    plan: Plan, indices: list[int], jobs: int, journal: Journal | None
) -> Iterator[Batch]:
    from joblib import Parallel, delayed, effective_n_jobs

    batches = _batches(plan, indices, effective_n_jobs(jobs))
    workers = Parallel(n_jobs=jobs, return_as="generator_unordered", inner_max_num_threads=1)
    calls = (delayed(_solve_in_worker)(os.getpid(), plan, batch, journal) for batch in batches)
    with _leftovers_removed_quietly():
        yield from workers(calls)


@contextmanager
def _leftovers_removed_quietly() -> Iterator[None]:
    """Workers whose parent was killed leave locks; joblib removes them, and need not tell users.

    The process that does so takes over the options for warnings.
    """
    sys.warnoptions.append(_ABOUT_LOCKS)
    try:
        yield
    finally:
        sys.warnoptions.remove(_ABOUT_LOCKS)


def _solve_in_worker(
    parent: int, plan: Plan, indices: Sequence[int], journal: Journal | None
) -> Batch:
    _belong_to(parent)
    return _solve_batch(plan, indices, journal)


@cache
def _belong_to(parent: int) -> None:
    """Make this process, if it is a child of `parent`, one of the program.

    It ends soon after its parent, even in compiled code.
    """
    if os.getppid() != parent:
        return  # a thread, or a worker of another backend of joblib
    look_seldom()

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(PARENT_SECONDS)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _batches(plan: Plan, indices: list[int], workers: int) -> list[list[int]]:
    """`indices` cut at multiples of one size in the order of all points, whatever is done."""
    size = min(plan.batch, max(1, len(indices) // (BATCHES_PER_WORKER * workers)))
    place = {index: i for i, index in enumerate(plan.order())}
    return [list(batch) for _, batch in groupby(indices, lambda index: place[index] // size)]


def _run_on_cluster(
    plan: Plan, indices: list[int], address: str, journal: Journal | None
) -> Iterator[Batch]:
    """The same on a Dask cluster; this process keeps the journal, workers may not see its disk."""
    distributed = _distributed()
    with _client(address) as client:
        threads = sum(client.nthreads().values())
        # handed to the cluster once, which may have no workers yet
        shared = client.submit(_same, plan, pure=False)
        version = metadata.version("epicyclic")
        batches = _batches(plan, indices, max(1, threads))
        futures = client.map(_solve_there, batches, plan=shared, version=version, pure=False)
        try:
            for _, finished in distributed.as_completed(futures, with_results=True):
                for index, row in finished:
                    if journal is not None:
                        journal.append(index, row)
                yield finished
        except InputError:
            raise
        except Exception as error:
            raise _cluster_error(address, f"does not compute: {error}.") from error
        finally:  # above all when this is interrupted
            client.cancel(futures)


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


def _client(address: str, *, trial: bool = False) -> Any:
    """A connection to the scheduler at `address`.

    One on trial is not the default of Dask: a refused address would remain it for all that follows.
    """
    distributed = _distributed()
    try:
        distributed.comm.resolve_address(address)  # a client of a malformed one leaves threads
        return distributed.Client(address, timeout="10s", set_as_default=not trial)
    except (OSError, ValueError) as error:
        raise _cluster_error(address, f"cannot be reached: {error}.") from None


def _cluster_error(address: str, allowed: str) -> InputError:
    remedy = "Give the address of a running scheduler, as in tcp://host:8786."
    return InputError([Problem("--dask", f'"{address}"', allowed, remedy)], "the command")


def _same(plan: Plan) -> Plan:
    return plan


def _solve_there(indices: Sequence[int], plan: Plan, version: str) -> Batch:
    """Points in a worker of a cluster, which must have this version of the package."""
    own = metadata.version("epicyclic")
    if own != version:
        raise RuntimeError(f"its workers have version {own} of epicyclic, this is {version}")
    return _solve_batch(plan, indices, None)


def _solve_batch(plan: Plan, indices: Sequence[int], journal: Journal | None) -> Batch:
    rows = []
    for index in indices:
        row = plan.solve(index)
        if journal is not None:
            journal.append(index, row)
        rows.append((index, row))
    return rows


def _told(error: InputError) -> str:
    """The first problem of a point; most of the others follow from it."""
    first, *others = error.problems
    more = f" And {len(others)} more: 'epicyclic check' with these values shows all."
    return f"{first}{more if others else ''}"


def failed_row(message: str) -> Row:
    """The row of a point without numbers."""
    return Row(str(Status.FAILED), message)
