"""Ctrl-C ends a command soon, also while it is in compiled code, which never looks at signals.

Python raises `KeyboardInterrupt` only between its own instructions, and a kernel may take minutes.
But it writes every signal to a pipe at once, and kernels let other threads run: one that waits at
the pipe ends the process if it has not ended by itself after a moment.
"""

from __future__ import annotations

import atexit
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, NoReturn

import click

from epicyclic.cli.exit_codes import EXIT_INTERRUPTED

GRACE_SECONDS = 1.0
"""For the command to end by itself, with its own last words."""
CLEANING_SECONDS = 0.5
"""For workers to be ended and temporary files to be removed after that."""

_interrupted, _told = threading.Event(), threading.Event()


def was_interrupted() -> bool:
    """True after Ctrl-C, also if a library has swallowed the exception."""
    return _interrupted.is_set()


def tell_once() -> None:
    """Say that the command was interrupted, unless it has been said."""
    if not _told.is_set():
        _told.set()
        click.echo("Interrupted.", err=True)


@contextmanager
def ending_soon() -> Iterator[None]:
    """End the process soon after an interruption, whatever it does. For the main thread only."""
    _interrupted.clear()
    _told.clear()
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    handler, hook = signal.signal(signal.SIGINT, _interrupt), sys.unraisablehook
    sys.unraisablehook = lambda lost: None if was_interrupted() else hook(lost)
    before = signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    threading.Thread(target=_watch, args=(reader,), daemon=True).start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(before)
        os.close(writer)  # ends the thread, unless there was an interruption
        signal.signal(signal.SIGINT, handler)
        sys.unraisablehook = hook


def _interrupt(number: int, frame: object) -> NoReturn:
    _interrupted.set()
    raise KeyboardInterrupt


def _watch(reader: int) -> None:
    while signals := os.read(reader, 1):
        if signals[0] == signal.SIGINT:
            time.sleep(GRACE_SECONDS)
            _end()
    os.close(reader)


def _end() -> NoReturn:
    """End this process and its workers now; files that are being written are removed."""
    last = threading.Timer(CLEANING_SECONDS, os._exit, [EXIT_INTERRUPTED])
    last.daemon = True
    last.start()
    with suppress(Exception):
        for worker in _workers():
            worker.kill()
        tell_once()
        atexit._run_exitfuncs()
    os._exit(EXIT_INTERRUPTED)


def _workers() -> list[Any]:
    """Processes that this one has started to share its work."""
    if "multiprocessing" not in sys.modules:
        return []
    import multiprocessing

    return multiprocessing.active_children()
