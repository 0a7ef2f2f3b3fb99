"""The one decorator for compiled kernels: compiled apart, kept on disk, and reported."""

from __future__ import annotations

import gc
import hashlib
import os
import pickle
import signal
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, partial
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn, ParamSpec, TypeVar, cast

import llvmlite.binding as llvm
import numba
from numba.core import caching, event
from numba.core.runtime.nrt import rtsys
from numba.extending import overload, register_jitable

from epicyclic.cache_folder import is_private, private_folder
from epicyclic.kernels import ahead, listeners

# Kernels compiled in a process of their own, which takes the memory of the compiler with it.
#
# The compiler keeps what it made on the way to the machine code of a kernel and of all kernels that
# it calls: half a gigabyte for those of one planetary set. A copy of this process keeps that
# instead, puts the machine code on the disk, and ends; this process reads it from there. Meanwhile
# another copy does the work that is to come, for its kernels. Of processes that start together one
# compiles a kernel, and the others wait for what it puts on the disk.


if sys.platform == "linux":
    import fcntl

_can_be_copied = sys.platform == "linux"  # elsewhere a copy is not safe, or there is none
_copy_tells = -1  # Where a copy of a process writes the names of kernels; -1 if this is none.
_told: set[bytes] = set()  # Kernels that listeners know of: copies may compile one each for itself.
_telling = threading.Lock()


def done_apart(compile_kernel: Callable[[], bool]) -> bool:
    """Compile in a copy of this process, where `compile_kernel` says whether the disk has it then.

    Listeners are told of each kernel here. After a failure nothing is compiled apart any more,
    because it would fail again: this process meets the error itself then, and can tell of it.
    """
    global _can_be_copied
    if not _can_be_copied:
        return False
    while ahead:
        copy = _start_copy(ahead.pop())
        threading.Thread(target=_follow, args=copy, daemon=True).start()
    _can_be_copied = _follow(*_start_copy(compile_kernel))
    return _can_be_copied


def _start_copy(work: Callable[[], object]) -> tuple[int, int]:
    """Number of a copy that does the work, and the end of the pipe in which it tells of kernels."""
    reader, writer = os.pipe()
    with warnings.catch_warnings():
        # the copy has no other threads, and needs nothing that they may have held
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        _work_and_end(work, reader, writer)
    os.close(writer)
    return child, reader


def _follow(child: int, reader: int) -> bool:
    """Tell of the kernels of a copy until it ends; whether it has done its work."""
    try:
        with os.fdopen(reader, "rb") as names:
            for name in names:
                _tell(name)
    except BaseException:
        os.kill(child, signal.SIGKILL)
        raise
    finally:
        _, status = os.waitpid(child, 0)
    return status == 0


def _work_and_end(work: Callable[[], object], reader: int, writer: int) -> NoReturn:
    """What the copy does. It never returns into what the original was doing."""
    global _can_be_copied, _copy_tells
    code = 1
    try:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.close(reader)
        _can_be_copied, _copy_tells = False, writer
        ahead.clear()
        gc.disable()  # a fifteenth of the time: a copy ends before it needs the memory
        warnings.simplefilter("ignore")  # the original meets the same
        code = 0 if work() else 1
    finally:
        os._exit(code)


def _tell(name: bytes) -> None:
    """Tell listeners of a kernel, once."""
    if _copy_tells >= 0:
        os.write(_copy_tells, name)
        return
    with _telling:
        if name not in _told:
            _told.add(name)
            for tell in listeners:
                tell()


# The one decorator for compiled kernels, and where their machine code is kept.
#
# numba's own cache looks at the file that defines a kernel, not at the kernels it calls, so an
# edited callee in another file would leave stale physics in its callers. The cache folder is
# therefore named after the content of every kernel file, wherever that is: all copies of a version
# share it. Machine code that was damaged on the disk is compiled again, and what cannot be kept is
# compiled at every start; `cache_notes` tells.

P = ParamSpec("P")
R = TypeVar("R")

_notes: dict[str, None] = {}


def cache_notes() -> list[str]:
    """What to know about the machine code that is kept, each once."""
    return list(_notes)


def cache_name(package: Path) -> str:
    """Name of the folder for the machine code of the kernels now in a package."""
    digest = hashlib.sha256(numba.__version__.encode())
    for pattern in ("kernels/*.py", "plugins/*/kernels_*.py"):
        for source in sorted(package.glob(pattern)):
            digest.update(source.read_bytes())
    return f"kernels-{digest.hexdigest()[:16]}"


def _chosen_directory() -> Path | None:
    """A folder in that of NUMBA_CACHE_DIR, or in one of our own; None if there is none."""
    given, name = os.environ.get("NUMBA_CACHE_DIR"), cache_name(Path(__file__).parents[1])
    if given is None:
        return private_folder(name)
    folder = Path(given)
    if folder.exists() and not is_private(folder):
        _notes[f"NUMBA_CACHE_DIR is not used, because others may write to {folder}."] = None
        return None
    return folder / name  # versions that share the folder do not call each other's code


_CACHE_DIR = _chosen_directory()
FIRST_RUN = _CACHE_DIR is None or not any(_CACHE_DIR.glob("*.nbi"))  # No machine code was kept.


class _CheckedFile(caching.IndexDataCacheFile):  # type: ignore[misc]  # numba has no types
    """Machine code of one kernel with a checksum: what is damaged counts as absent."""

    def _load_index(self) -> Any:
        try:
            return super()._load_index()
        except Exception as error:  # whatever unpickling raises
            self._note_damage(error)
            return {}

    def _load_data(self, name: str) -> Any:
        try:
            digest, data = super()._load_data(name)
            if digest == hashlib.sha256(data).digest():
                with _unasked():
                    return pickle.loads(data)
            reason: Exception = ValueError("wrong checksum")
        except Exception as error:
            reason = error
        self._note_damage(reason)
        raise OSError("damaged")  # as for a file that is not there

    def _save_data(self, name: str, data: Any) -> None:
        dumped = self._dump(data)
        super()._save_data(name, (hashlib.sha256(dumped).digest(), dumped))

    def _note_damage(self, error: Exception) -> None:
        if not isinstance(error, FileNotFoundError):
            text = f"Compiled code in {self._cache_path} was damaged; it is compiled again."
            _notes[text] = None


@cache
def _content(file: str) -> str:
    return hashlib.sha256(Path(file).read_bytes()).hexdigest()


class _Kept(caching.CompileResultCacheImpl):  # type: ignore[misc]  # numba has no types
    """Machine code, and beside it what a kernel that calls this one is compiled with.

    The latter is read when there is one: with that of all kernels a tenth of a `run` went by.
    """

    def reduce(self, result: Any) -> Any:
        (name, kind, (code, whole)), *others = super().reduce(result)
        functions = result.library._get_module_for_linking().functions
        names = [it.name for it in functions if not it.is_declaration]
        text = "\n".join(f'define void @"{it}"() {{ ret void }}' for it in names)
        return (name, kind, (code, llvm.parse_assembly(text).as_bitcode())), *others, whole

    def rebuild(self, target_context: Any, payload: Any) -> Any:
        *own, whole = payload
        found = super().rebuild(target_context, own)
        found.library._get_module_for_linking = cache(partial(llvm.parse_bitcode, whole))
        return found


class _KernelCache(caching.FunctionCache):  # type: ignore[misc]  # numba has no types
    """The cache of one kernel, without which the kernel runs as well."""

    _impl_class = _Kept

    def __init__(self, compiled: Any) -> None:
        super().__init__(compiled.py_func)
        self._compiled = compiled
        self._locked: int | None = None
        self._cache_path = self._impl.locator._cache_path = str(_CACHE_DIR)
        self._cache_file = _CheckedFile(
            cache_path=self._cache_path,
            filename_base=self._impl.filename_base,
            source_stamp=_content(compiled.py_func.__code__.co_filename),
        )

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        rtsys.initialize(target_context)  # all that machine code needs to run
        load = partial(self._load_overload, sig, target_context)

        def is_kept() -> bool:
            self._compiled.compile(sig)
            return load() is not None

        found = load()
        if found is None:
            with _unasked():  # what compiling needs, once for all copies
                target_context.refresh()
        if found is None and _copy_tells >= 0 and self._locked is None:  # it is, after a failure
            self._lock()
            found = load()
            if found is not None:
                self._unlock()
        is_new = found is None and done_apart(is_kept)
        return load() if is_new else found

    def _lock(self) -> None:
        """Wait for who else compiles this kernel, then let others wait until it is kept.

        Who compiles a kernel waits for kernels that it calls only, so that nobody waits for ever.
        """
        with suppress(OSError):  # where nothing can be locked, each process compiles for itself
            path = Path(self._cache_path) / f"{self._impl.filename_base}.lock"
            self._locked = os.open(path, os.O_CREAT | os.O_RDWR, 0o600)
            fcntl.flock(self._locked, fcntl.LOCK_EX)

    def _unlock(self) -> None:
        if self._locked is not None:
            os.close(self._locked)
            self._locked = None

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _note_lost(error)
        finally:
            self._unlock()


def _note_lost(error: Exception) -> None:
    reason = getattr(error, "strerror", None) or error
    text = (
        f"Compiled code cannot be kept in {_CACHE_DIR}: {reason}. It is compiled again at "
        "every start."
    )
    _notes[text] = None


@contextmanager
def _unasked() -> Iterator[None]:
    """Let numba load sums and products of arrays without asking whether scipy.linalg is there.

    It would import it, a tenth of a `run`, for kernels that do not call it. One that does imports
    it all the same. A numba that asks by another name goes on asking.
    """
    linalg: Any = import_module("numba.np.linalg")
    ask = getattr(linalg, "ensure_blas", None)
    linalg.ensure_blas = lambda: None
    try:
        yield
    finally:
        linalg.ensure_blas = ask


class _Listener(event.Listener):
    """Tells of kernels of this package that are compiled, not of what numba compiles for them."""

    def on_start(self, event: Any) -> None:
        function = event.data["dispatcher"].py_func
        if function.__module__.startswith("epicyclic."):
            _tell(f"{function.__module__}.{function.__qualname__}\n".encode())

    def on_end(self, event: Any) -> None:
        """Ignored."""


event.register("numba:compile", _Listener())


_PLAIN: Any = {"error_model": "numpy", "nogil": True}
_INLINED: Any = cast(Any, {**_PLAIN, "fastmath": {"contract"}, "forceinline": True})


def formula(function: Callable[P, R]) -> Callable[P, R]:
    """A function of numbers and arrays that kernels may call with numbers, inlined."""
    register_jitable(**_INLINED)(function)
    return function


def in_kernels(function: Callable[..., Any], own: Callable[..., Any]) -> None:
    """Have kernels call `own` in place of a `function` of numbers and arrays, inlined."""
    overload(function, jit_options=_INLINED, strict=False)(lambda *_, **__: own)


def kernel(function: Callable[P, R], *, inlined: bool = False) -> Callable[P, R]:
    """Compile `function` at first call and keep the machine code on disk.

    ``fastmath`` stays off, because it makes NaN checks vanish; division by zero gives inf, and
    callers check that results are finite. What is `inlined` leaves loops over it vector code, in
    which products may be added without rounding them first.
    """
    compiled: Any = numba.njit(**(_INLINED if inlined else _PLAIN))(function)
    if _CACHE_DIR is not None:
        config: Any = numba.config
        previous = config.CACHE_DIR
        config.CACHE_DIR = str(_CACHE_DIR)
        try:
            compiled._cache = _KernelCache(compiled)
        except Exception as error:  # numba finds no place that it can write to
            _note_lost(error)
        finally:
            config.CACHE_DIR = previous
    return cast("Callable[P, R]", compiled)
