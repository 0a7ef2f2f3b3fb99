"""A process beside the app that solves and draws: pages stay quick, and work can be ended."""

from __future__ import annotations

import asyncio
import itertools
import multiprocessing
import os
import signal
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from multiprocessing.connection import Connection
from typing import Any

from epicyclic.errors import EpicyclicError
from epicyclic.kernels.compiling import listeners

Progress = Callable[[int, int], None]
"""Called with what is done and what there is to do, and with 0 for this while code is compiled."""


class Ended(Exception):  # noqa: N818  no error: the user has asked for it
    """The work was ended before it was done."""

    def __str__(self) -> str:
        return "Ended before it was done."


class WorkError(EpicyclicError):
    """An error that was not foreseen, from the other process."""


class Worker:
    """Does one thing after the other, each in the same process as long as none is ended.

    Parameters
    ----------
    niceness : int
        How far its process stands back behind others, on systems that know this.
    """

    def __init__(self, niceness: int = 0) -> None:
        self._niceness = niceness
        self.is_closed = False
        self._waiting = ThreadPoolExecutor(1)  # threads shared by all workers could run out
        self._process: Any = None
        self._ours: Connection | None = None
        self._lock = asyncio.Lock()

    async def do(
        self,
        task: Callable[..., Any],  # Takes `arguments` and a function that it tells its progress.
        *arguments: Any,
        progress: Progress,  # Called in this process.
    ) -> Any:
        """What a function of a module returns, computed in the process.

        Raises
        ------
        Ended
            If `end` or `close` was called meanwhile, or `close` before.
        EpicyclicError
            As the task raises it.
        """
        loop = asyncio.get_running_loop()
        async with self._lock:
            if self.is_closed:
                raise Ended
            pipe = self._pipe()
            try:
                pipe.send((task, arguments))
                while True:
                    what, content = await loop.run_in_executor(self._waiting, pipe.recv)
                    if what == "done":
                        return content
                    if what == "failed":
                        raise content
                    progress(*content)
                    if self.is_closed:  # since then, and there is no thread to wait any more
                        raise Ended
            except (EOFError, OSError):
                self.end()
                raise Ended from None

    def end(self) -> None:
        """End what is being done; the next thing starts a new process."""
        if self._process is not None:
            _end_group(self._process)
            self._process = None
        if self._ours is not None:
            self._ours = None

    def close(self) -> None:
        """End what is being done, and begin nothing more."""
        self.is_closed = True
        self.end()
        self._waiting.shutdown(wait=False)

    def _pipe(self) -> Connection:
        if self._process is None or not self._process.is_alive():
            context = multiprocessing.get_context("spawn")
            self._ours, theirs = context.Pipe()
            self._process = context.Process(target=_serve, args=(theirs, self._niceness))
            self._process.start()
            theirs.close()
        assert self._ours is not None
        return self._ours


def _end_group(process: Any) -> None:
    """End a process and those that it has started for a map."""
    with suppress(OSError, AttributeError):  # it has no group yet, or the system has none
        os.killpg(process.pid, signal.SIGTERM)
    process.terminate()


def _serve(pipe: Connection, niceness: int) -> None:
    """What the process does: tasks until the pipe is closed."""
    if hasattr(os, "setsid"):
        os.setsid()  # a group of its own, see `_end_group`
        os.nice(niceness)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the app ends this process
    compiled = itertools.count(1)
    listeners.append(lambda: pipe.send(("progress", (next(compiled), 0))))
    with suppress(EOFError, OSError):
        while True:
            task, arguments = pipe.recv()
            try:
                pipe.send(("done", task(*arguments, lambda *count: pipe.send(("progress", count)))))
            except EpicyclicError as error:
                pipe.send(("failed", error))
            except Exception as error:
                pipe.send(("failed", WorkError(f"{type(error).__name__}: {error}")))
    if hasattr(os, "killpg"):  # workers of a map would be waited for
        os.killpg(0, signal.SIGTERM)
    os._exit(0)
