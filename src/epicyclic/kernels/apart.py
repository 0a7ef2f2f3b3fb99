"""Kernels compiled in a process of their own, which takes the memory of the compiler with it.

The compiler keeps what it made on the way to the machine code of a kernel and of all kernels that
it calls: half a gigabyte for those of one planetary set. A copy of this process keeps that instead,
puts the machine code on the disk, and ends; this process reads it from there. Of processes that
start together one compiles a kernel, and the others wait for what it puts on the disk.
"""

from __future__ import annotations

import os
import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NoReturn

from epicyclic.kernels.compiling import listeners

if sys.platform == "linux":
    import fcntl

_can_be_copied = sys.platform == "linux"  # elsewhere a copy is not safe, or there is none


def done_apart(compile_kernel: Callable[[], bool], folder: Path) -> bool:
    """Compile in a copy of this process, where `compile_kernel` says whether the disk has it then.

    Other processes that use the same folder for machine code wait meanwhile.

    Listeners are told of each kernel here. After a failure nothing is compiled apart any more,
    because it would fail again: this process meets the error itself then, and can tell of it.
    """
    if not _can_be_copied:
        return False
    with _alone(folder):  # a kernel that was waited for is read from the disk by the copy
        return _done_in_copy(compile_kernel)


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder, which ends with this process if not before."""
    handle = None
    try:
        with suppress(OSError):  # where nothing can be locked, each process compiles for itself
            handle = os.open(folder, os.O_RDONLY)
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        if handle is not None:
            os.close(handle)


def _done_in_copy(compile_kernel: Callable[[], bool]) -> bool:
    global _can_be_copied
    reader, writer = os.pipe()
    with warnings.catch_warnings():
        # the copy has no other threads, and needs nothing that they may have held
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child == 0:
        _compile_and_end(compile_kernel, reader, writer)
    os.close(writer)
    try:
        while os.read(reader, 1):
            for tell in listeners:
                tell()
    except BaseException:
        os.kill(child, signal.SIGKILL)
        raise
    finally:
        os.close(reader)
        _, status = os.waitpid(child, 0)
    _can_be_copied = status == 0
    return _can_be_copied


def _compile_and_end(compile_kernel: Callable[[], bool], reader: int, writer: int) -> NoReturn:
    """What the copy does. It never returns into what the original was doing."""
    global _can_be_copied
    code = 1
    try:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.close(reader)
        _can_be_copied = False
        listeners[:] = [lambda: _tell(writer)]
        code = 0 if compile_kernel() else 1
    finally:
        os._exit(code)


def _tell(writer: int) -> None:
    os.write(writer, b".")
