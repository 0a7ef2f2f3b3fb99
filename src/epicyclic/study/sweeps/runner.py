"""Many independent points: run here, in workers or on a cluster; journal, resume and shards."""

from __future__ import annotations

import atexit
import errno
import hashlib
import json
import os
import pickle
import re
import signal
import sys
import threading
import time
import warnings
import zlib
from abc import ABC, abstractmethod
from collections import defaultdict, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from contextlib import contextmanager, suppress
from functools import cache, lru_cache, partial
from importlib import metadata
from itertools import groupby
from multiprocessing import current_process, resource_tracker
from pathlib import Path
from queue import SimpleQueue
from typing import Any, BinaryIO, ClassVar, Protocol, Self, TypeGuard

import numpy as np
from pydantic import ConfigDict, TypeAdapter, ValidationError

from epicyclic.arrays import FloatArray, give_memory_back, itself
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import (
    EpicyclicError,
    InputError,
    Problem,
    Status,
    is_interrupt,
    one_problem,
    raise_any,
)
from epicyclic.files import look_seldom, make_folder
from epicyclic.kernels.compiling import FIRST_RUN

# The journal of an unfinished study: one line for each finished point, written as it finishes.
#
# A study that is interrupted leaves its journal behind, and the same study goes on from there.
# Every line names the study it belongs to, one of them says what it is, and nothing is ever
# overwritten: a file that holds anything else is refused. Lines that cannot be read, such as one
# cut short, or that have been altered are computed again. The file of a shard is the journal of its
# points.


NOT_COMPUTED = "not computed"  # Status of the points of other shards.

_WITHOUT_NUMBERS = (Status.FAILED, Status.UNPHYSICAL)
_LONGEST_LINE = 50_000_000
"""A point takes some kilobytes, what a study is at most all values of a million points. [bytes]"""
_MOST_STRANGE_LINES, _LONG = 100, 500_000
"""A file that begins with more lines which are no points of the study is something else; one of
more bytes counts as several."""


TEXTS = {
    "status": "how the point ended",
    "message": "why the point failed",
    "warnings": "warnings of the point",
}
"""What a point says beside its numbers."""


@dataclass(frozen=True, slots=True)
class Row:
    """One finished point of a study, with its `TEXTS`."""

    status: str
    message: str = ""
    warnings: str = ""
    # As `Result.numbers` names them; empty if it failed.
    numbers: dict[str, float] = field(default_factory=dict)


class Rows:
    """All points of a study, by number: columns, which take a tenth of the memory of rows."""

    def __init__(self, size: int) -> None:
        self.status = [NOT_COMPUTED] * size
        self.message = [""] * size
        self.warnings = [""] * size
        self._numbers = defaultdict[str, FloatArray](partial(np.full, size, np.nan))

    def __len__(self) -> int:
        return len(self.status)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the numbers that any point has."""
        return tuple(self._numbers)

    @property
    def failures(self) -> list[str]:
        """Why points failed, one text for each."""
        pairs = zip(self.status, self.message, strict=True)
        return [message for status, message in pairs if status in _WITHOUT_NUMBERS]

    def add(self, point: int, row: Row) -> None:
        self.status[point] = sys.intern(row.status)
        self.message[point] = sys.intern(row.message)
        self.warnings[point] = sys.intern(row.warnings)  # neighbours often have the same
        for name, value in row.numbers.items():
            self._numbers[name][point] = value

    def numbers(self, name: str) -> FloatArray:
        """One number of all points; NaN where there is none."""
        return self._numbers.get(name, np.full(len(self), np.nan))


@dataclass(frozen=True, slots=True)
class _Record:
    __pydantic_config__ = ConfigDict(ser_json_inf_nan="constants", defer_build=True)

    sweep: str
    point: int
    row: Row


@dataclass(frozen=True, slots=True)
class _Heading:
    sweep: str
    study: dict[str, Any]


_RECORD, _HEADING = TypeAdapter(_Record), TypeAdapter(_Heading)


@dataclass(frozen=True, slots=True)
class Journal:
    """Finished points on disk."""

    path: Path
    fingerprint: str  # Fingerprint of the plan; a journal of another plan is not touched.

    def read(self) -> dict[int, Row]:
        """Finished points by number; none if there is no file.

        Raises `InputError` if the file cannot be read or holds something else than points of this
        study.
        """
        return dict(self.points())

    def points(self) -> Iterator[tuple[int, Row]]:
        """The same one by one, so that they need not all be held."""
        own = strange = 0
        start = b'{"sweep":"%s"' % self.fingerprint.encode()
        try:
            with _opened(self.path) as file:
                while line := file.readline(_LONGEST_LINE):
                    text = line.rstrip(b"\n")
                    record = _parsed(_RECORD, _record_in(text))
                    if record is not None and record.sweep == self.fingerprint:
                        own += 1
                        yield record.point, record.row
                    if not (text.startswith(start) or start.startswith(text)):  # or cut short
                        strange += 1 + len(line) // _LONG
                    if not own and strange > _MOST_STRANGE_LINES:
                        break
        except FileNotFoundError:
            return
        except OSError as error:
            raise _error(self.path, f"cannot be read: {error.strerror}.") from None
        if not own and strange:
            raise _error(self.path, "contains something other than points of this sweep.")

    def begin(self, content: Mapping[str, Any]) -> None:
        """Say in the file what the study is, unless it does."""
        heading = {"sweep": self.fingerprint, "study": content}
        line = _sealed(json.dumps(heading, separators=(",", ":")).encode())
        try:
            with _opened(self.path) as file:
                there = any(file.readline(_LONGEST_LINE).strip() == line for _ in range(2))
        except FileNotFoundError:
            there = False
        if not there:
            self._write(line)

    def append(self, point: int, row: Row) -> None:
        """Add a finished point; it outlives this process when this returns.

        Raises `InputError` if it cannot be written; what was written before stays.
        """
        self._write(_sealed(_RECORD.dump_json(_Record(self.fingerprint, point, row))))

    def remove(self) -> None:
        """Delete the journal of a finished study."""
        self.path.unlink(missing_ok=True)

    def _write(self, line: bytes) -> None:
        line = b"\n" + line  # first the end of a line that may have been cut short
        try:
            with self.path.open("ab", buffering=0) as file:  # one write: workers share the file
                whole = file.write(line) == len(line)
            full, reason = True, "the disk is full"
        except OSError as error:
            full = error.errno in (errno.ENOSPC, errno.EDQUOT)
            whole, reason = False, str(error.strerror)
        if not whole:
            first = "free some space" if full else "let it be written"
            remedy = f"Finished points are kept; {first} and give the same command again."
            allowed = f"cannot be written: {reason}."
            raise one_problem("journal", str(self.path), allowed, remedy, "the sweep")


def _opened(path: Path) -> BinaryIO:
    """The file to read, if it is one: a pipe could keep the program waiting for ever."""
    if path.exists() and not path.is_file():
        raise _error(path, "is not a regular file.")
    return path.open("rb")


def read_heading(path: Path) -> tuple[str, dict[str, Any]]:
    """Fingerprint and content of the study of which a file holds points.

    Raises `InputError` if it cannot be read, does not say of which study it is, or has been altered
    since this version wrote it.
    """
    try:
        with _opened(path) as file:
            strange = 0
            while strange <= _MOST_STRANGE_LINES:
                line = file.readline(_LONGEST_LINE)
                heading = _parsed(_HEADING, line)
                if heading is not None:
                    own = heading.study.get("version") == metadata.version("epicyclic")
                    if own and _record_in(line.rstrip(b"\n")) is None:
                        raise _error(path, "states a study that was altered.")
                    return heading.sweep, heading.study
                strange += 1 + len(line) // _LONG
    except OSError as error:
        raise _error(path, f"cannot be read: {error.strerror}.", _NAME_SHARDS) from None
    raise _error(path, "is no file of a shard, or of an interrupted study.", _NAME_SHARDS)


_CHECK = b',"check":"%08x"}'


def _sealed(line: bytes) -> bytes:
    """A line with the checksum of what comes before it."""
    return line[:-1] + _CHECK % zlib.crc32(line)


def _record_in(line: bytes) -> bytes | None:
    """What `_sealed` made a line of; None if it has been altered."""
    record = line[: -len(_CHECK % 0)] + b"}"
    return record if line == _sealed(record) else None


def _parsed(kind: TypeAdapter[Any], line: bytes | None) -> Any:
    """What a line says; None if it is of another kind."""
    try:
        return None if line is None else kind.validate_json(line)
    except ValidationError:
        return None


_NAME_SHARDS = "Name the files that the shards wrote, as those of s.nc.shard-*."
_ANEW = "Move or delete it, and give the command again."


def _error(path: Path, allowed: str, remedy: str = _ANEW) -> InputError:
    return one_problem("journal", str(path), allowed, remedy, "the sweep")


# Many independent points: in this process while that is quick, else in workers or on a cluster.
#
# Finished points are kept in a journal at once, and rows do not depend on order, workers, shards or
# interruptions as long as `Plan.solve_all` makes the same of the same block.

Progress = Callable[..., None]
Batch = list[tuple[int, Row]]

BATCHES_PER_WORKER = 4  # Fewer would leave workers idle at the end.
MOST_AT_ONCE = 16  # Points that a worker is given, or one block of them.
WORKER_START_SECONDS = 2.0
"""Work left, in seconds on one core, below which starting worker processes does not pay: they start
in one or two, while this process goes on."""
PARENT_SECONDS = 0.5  # Between two looks of a worker at whether its parent is alive.
_LIBRARIES = "OMP", "OPENBLAS", "MKL", "BLIS", "VECLIB_MAXIMUM", "NUMBA"
_ONE_THREAD = {f"{name}_NUM_THREADS": "1" for name in _LIBRARIES}  # Of a worker.
WORKER_IDLE_SECONDS = 30  # After which a worker ends; until then the next study finds it.
_ABOUT_LOCKS = "ignore:resource_tracker:UserWarning"
TRIAL_POINTS, TRIAL_SECONDS = 8, 2.0
"""Points computed, or time spent on them, before the work left is estimated."""


class Plan(ABC):
    """The points of a study, handed to every worker: small, and picklable."""

    kind: ClassVar[str]
    """Kind of the study: ``"sweep"``, ``"map"``."""
    may_fail: ClassVar[bool] = False
    """Whether points without a solution are to be expected."""

    @property
    def block(self) -> int:
        """Number of points, cut by their place in the order, that are always solved together.

        So no row depends on shards, workers or interruptions.
        """
        return 1

    @property
    def source(self) -> str:
        """The file whose folder holds the files that a case names; empty if there is none."""
        return ""

    @property
    @abstractmethod
    def size(self) -> int:
        """Number of points."""

    def order(self) -> Sequence[int]:
        """Numbers of all points; a plan may sort them, so that neighbours share most."""
        return range(self.size)

    def solve_all(self, indices: Sequence[int]) -> list[Row]:
        """Rows of the points of whole blocks, in their order, with the reason if one fails.

        Raises nothing but an interruption.
        """
        return [self._row(partial(self._solve, index)) for index in indices]

    def _row(self, find: Callable[[], Row]) -> Row:
        """What is found, or a row that says what is raised."""
        try:
            return find()
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

    def surely_long(self, count: int) -> bool:
        """Whether so many points pay for workers, before one has told how long it takes."""
        return False

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

    # Processes that compute, this among them. Default: one for each core if that pays, else one.
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
        if self.jobs is not None and self.jobs < 1:
            remedy = "Give more, or None."
            raise one_problem("jobs", str(self.jobs), "must be 1 or more.", remedy, "the command")

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
        if plan.surely_long(total):
            give_memory_back()
        return rows

    def _finished(self, plan: Plan) -> Iterator[Batch]:
        """Points with their numbers: those of the journal, then as they finish."""
        left = share_of(plan, self.shard)
        journal = None
        if self.journal is not None:
            # absolute, because workers may have been started in another folder
            journal = Journal(Path(self.journal).absolute(), fingerprint(plan))
            kept = journal.read()
            blocks = _cut(plan, left, plan.block)
            left = [index for block in blocks if not kept.keys() >= {*block} for index in block]
            whole = [block for block in blocks if kept.keys() >= {*block}]
            yield [(index, kept[index]) for block in whole for index in block]
            journal.begin(heading(plan, self.shard, self.output))
        if not left:
            return
        jobs = self.jobs
        if jobs is None and self.dask is None and plan.surely_long(len(left)):
            jobs = _cores()
        if self.dask is None and _has_workers(jobs) and not FIRST_RUN:  # both would compile
            _start_workers(plan, jobs)  # while this process prepares
        plan = plan.prepared(left, self.jobs)
        if self.dask is not None:
            yield from _run_on_cluster(plan, left, self.dask, journal)
        else:
            yield from _run_here(plan, left, jobs, journal)

    def within(self, plan: Plan) -> Runner:
        """The same with a journal of its own for one of several plans, in the folder `journal`."""
        if self.journal is None:
            return self
        folder = Path(self.journal)
        make_folder(folder, "journal")
        return replace(self, journal=folder / f"{fingerprint(plan)}.partial")


HERE = Runner()  # The points are computed here, or in workers if that pays, and not kept.


def share_of(plan: Plan, shard: tuple[int, int] | None) -> list[int]:
    """Numbers of the points of a shard, which follow each other in the order of all."""
    order = list(plan.order())
    if shard is None:
        return order
    number, count = shard
    blocks = -(-len(order) // plan.block)
    start, end = (blocks * part // count * plan.block for part in (number - 1, number))
    return order[start:end]


def parse_shard(text: str | None) -> tuple[int, int] | None:
    """The option ``--shard 2/8``; raises `InputError` if it is not of that form."""
    if text is None:
        return None
    match = re.fullmatch(r"\s*(\d{1,9})\s*/\s*(\d{1,9})\s*", text)
    if match is None:
        raise _no_shard(text)
    return Runner(shard=(int(match[1]), int(match[2]))).shard


def _no_shard(text: str) -> InputError:
    allowed = "must be I/N, with I from 1 to N."
    return one_problem("--shard", text, allowed, "For example 2/8.", "the command")


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
    start, done, untimed = time.perf_counter(), 0, 0
    blocks = _cut(plan, indices, plan.block)
    while blocks:
        spent = time.perf_counter() - start
        if done and not untimed and spent < TRIAL_SECONDS:  # most of it to load kernels
            start, spent, untimed = time.perf_counter(), 0.0, done
        if jobs is None and _workers_pay(done - untimed, spent, len(indices) - done):
            jobs = _cores()
        if _has_workers(jobs):
            yield from _run_in_workers(plan, indices[done:], jobs, journal)
            return
        yield _solve_batch(plan, blocks[0], journal)
        done += len(blocks.pop(0))


def _cores() -> int:
    from loky import cpu_count

    return int(cpu_count())


def _has_workers(jobs: int | None) -> TypeGuard[int]:
    """Whether other processes compute too."""
    return jobs is not None and jobs > 1 and not current_process().daemon  # which has no children


def _start_workers(
    plan: Plan, jobs: int
) -> tuple[Any, Callable[..., Future[Batch]], list[Future[Batch]]]:
    """Workers, what gives them points of `plan`, and an empty batch of it for each."""
    from cloudpickle import dumps  # models of friction hold functions
    from loky import get_reusable_executor

    # that loky replaces workers which have grown large, or adapts their number, is no news
    told = "A worker (stopped|was restarted) while|Trying to resize"
    warnings.filterwarnings("ignore", told, UserWarning)
    with _apart_from_here():
        workers = get_reusable_executor(jobs - 1, timeout=WORKER_IDLE_SECONDS, env=_ONE_THREAD)
        call = partial(workers.submit, _solve_in_worker, os.getpid(), dumps(plan))
        return workers, call, [call((), None) for _ in range(jobs - 1)]


def _workers_pay(done: int, seconds: float, left: int) -> bool:
    """Whether to start workers for the points `left`, `done` having taken `seconds`."""
    tried = done >= TRIAL_POINTS or seconds >= TRIAL_SECONDS
    return tried and left * seconds / done > WORKER_START_SECONDS


def _run_in_workers(
    plan: Plan, indices: list[int], jobs: int, journal: Journal | None
) -> Iterator[Batch]:
    """Finished points, in any order: of this process while others start, then of all `jobs`."""
    batches = deque(_batches(plan, indices, jobs))
    left, finished = len(batches), SimpleQueue[Future[Batch]]()
    workers, call, started = _start_workers(plan, jobs)

    def go_on(last: Future[Batch]) -> None:
        if last.exception() is not None:
            finished.put(last)
            return
        try:
            future = call(batches.popleft(), journal)
        except IndexError:  # none is left
            return
        except Exception as error:  # no process can start: told here, or all would wait for it
            future = Future[Batch]()
            future.set_exception(error)
        future.add_done_callback(finished.put)
        future.add_done_callback(go_on)

    try:
        for future in started:
            future.add_done_callback(go_on)
        while left:
            own = None
            with suppress(IndexError):
                own = batches.popleft() if finished.empty() else None
            found = finished.get().result() if own is None else _solve_batch(plan, own, journal)
            left -= 1
            yield found
    finally:
        batches.clear()
        if left:
            workers.shutdown(kill_workers=True)


@contextmanager
def _apart_from_here() -> Iterator[None]:
    """Worker processes that start in it leave interruptions to this one.

    Those whose parent was killed leave locks; loky removes them, and need not tell users. The
    process that does so takes over the options for warnings.
    """
    sys.warnoptions.append(_ABOUT_LOCKS)
    if hasattr(signal, "pthread_sigmask"):  # not on Windows
        resource_tracker.ensure_running()  # when it starts, signals are let through again
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        if hasattr(signal, "pthread_sigmask"):
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        sys.warnoptions.remove(_ABOUT_LOCKS)


def _solve_in_worker(
    parent: int, sent: bytes, indices: Sequence[int], journal: Journal | None
) -> Batch:
    _belong_to(parent)
    return _solve_batch(_received(sent), indices, journal)


@lru_cache(maxsize=1)  # what is built for a plan is kept for its next points
def _received(sent: bytes) -> Plan:
    plan: Plan = pickle.loads(sent)
    return plan


@cache
def _belong_to(parent: int) -> None:
    """Make this process, a child of `parent`, one of the program.

    It ends soon after its parent, even in compiled code, and at once when it is told to.
    """
    look_seldom()
    atexit.register(os._exit, 0)  # its parent waits, a fifth of a second, while memory is freed

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(PARENT_SECONDS)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _batches(plan: Plan, indices: list[int], workers: int) -> list[list[int]]:
    """`indices` cut at multiples of one size in the order of all points, whatever is done."""
    size = min(MOST_AT_ONCE, max(1, len(indices) // (BATCHES_PER_WORKER * workers)))
    return _cut(plan, indices, max(1, size // plan.block) * plan.block)


def _cut(plan: Plan, indices: list[int], size: int) -> list[list[int]]:
    """`indices` in blocks that end at multiples of `size` in the order of all points."""
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
        shared = client.submit(itself, plan, pure=False)
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
        allowed, remedy = "needs the package distributed.", 'Install "epicyclic[dask]".'
        raise one_problem("--dask", "", allowed, remedy, "the command") from None
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
    return one_problem("--dask", f'"{address}"', allowed, remedy, "the command")


def _solve_there(indices: Sequence[int], plan: Plan, version: str) -> Batch:
    """Points in a worker of a cluster, which must have this version of the package."""
    own = metadata.version("epicyclic")
    if own != version:
        raise RuntimeError(f"its workers have version {own} of epicyclic, but this is {version}")
    return _solve_batch(plan, indices, None)


def _solve_batch(plan: Plan, indices: Sequence[int], journal: Journal | None) -> Batch:
    rows = list(zip(indices, plan.solve_all(indices), strict=True))
    if journal is not None:
        for index, row in rows:
            journal.append(index, row)
    return rows


def _told(error: InputError) -> str:
    """The first problem of a point; most of the others follow from it."""
    first, *others = error.problems
    more = f" And {len(others)} more: 'epicyclic check' with these values shows all."
    return f"{first}{more if others else ''}"


def failed_row(message: str) -> Row:
    """The row of a point without numbers."""
    return Row(str(Status.FAILED), message)


# Shards put together.


class PlanKind(Protocol):
    """A class of plans."""

    def again(self, content: Mapping[str, Any], source: str) -> Plan:
        """The plan that `Plan.describe` described."""


def gather(
    files: Sequence[Path],  # Journals of all shards.
    kinds: Mapping[str, PlanKind],  # Classes of plans by `Plan.kind`.
) -> tuple[Plan, Rows, dict[str, Any]]:
    """The plan of which `files` hold shards, all its points, and how they are to be written.

    Raises `InputError` if a file is no journal, the files are of several plans, or points are
    missing.
    """
    (first, *_) = files
    mark, content = read_heading(first)
    plan, output = _plan_of(first, mark, content, kinds)
    rows = Rows(plan.size)
    shares = {}
    for file in files:
        own, said = read_heading(file)
        if own != mark:
            allowed = (
                f"holds points of a different study from {first}: another case or other values."
            )
            raise _shard_error(file, allowed, "Give the files of one study.")
        for point, row in Journal(file, mark).points():
            if not 0 <= point < plan.size:
                raise _shard_error(file, _DAMAGED, _COMPUTE_AGAIN)
            if rows.status[point] == NOT_COMPUTED:
                rows.add(point, row)
        shares[file] = share_of(plan, _shard_in(file, said))
    _check_whole(rows, shares)
    return plan, rows, output


def _plan_of(
    file: Path, mark: str, content: Mapping[str, Any], kinds: Mapping[str, PlanKind]
) -> tuple[Plan, dict[str, Any]]:
    """The plan in the heading of a file, which must be that of this version."""
    version = metadata.version("epicyclic")
    if content.get("version") != version:
        allowed = f"was made by version {content.get('version')}, but this is {version}."
        raise _shard_error(file, allowed, "Merge it with that version.")
    try:
        plan = kinds[content["kind"]].again(content["plan"], content["source"])
        output, found = dict(content["output"]), fingerprint(plan)
    except Exception:  # a heading that somebody else wrote may hold anything
        raise _shard_error(file, _DAMAGED, _COMPUTE_AGAIN) from None
    if found != mark:
        raise _shard_error(file, _DAMAGED, _COMPUTE_AGAIN)
    return plan, output


_DAMAGED = "is damaged, or a file that its case names has changed."
_COMPUTE_AGAIN = "Compute the shard again."
_SHARD = TypeAdapter(tuple[int, int] | None)


def _shard_in(file: Path, content: Mapping[str, Any]) -> tuple[int, int] | None:
    """Which share of the points the heading of a file states."""
    try:
        return Runner(shard=_SHARD.validate_python(content["shard"])).shard
    except (KeyError, ValueError):
        raise _shard_error(file, _DAMAGED, _COMPUTE_AGAIN) from None


def _check_whole(rows: Rows, shares: Mapping[Path, Sequence[int]]) -> None:
    """Raise `InputError` if points are missing."""
    missing = {point for point, status in enumerate(rows.status) if status == NOT_COMPUTED}
    problems = []
    for file, share in shares.items():
        lacks = len(missing.intersection(share))
        if lacks:
            allowed = f"lacks {lacks} of its {len(share)} points."
            problems.append(Problem("FILE", str(file), allowed, "Run its command again."))
    without = len(missing.difference(*shares.values()))
    if without:
        allowed = (
            f"{without} of {len(rows)} points belong to shards that are missing from the command."
        )
        problems.append(Problem("FILE", "", allowed, "Give the files of all shards."))
    raise_any(problems, "the command")


def _shard_error(file: Path, allowed: str, remedy: str) -> InputError:
    return one_problem("FILE", str(file), allowed, remedy, "the command")
