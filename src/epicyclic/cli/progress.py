"""Progress on standard error: a bar on a terminal, a line now and then in a file or pipe.

``EPICYCLIC_PROGRESS=0`` turns both off.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from datetime import timedelta

import click
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from epicyclic.kernels.compiling import listeners

EVERY = 15.0
"""Between two lines, and before the first one. [s]"""
COMPILING_EVERY = 5.0
"""The same while kernels are compiled. [s]"""
COMPILED = 75
"""Kernels that a result needs, about."""
Update = Callable[..., None]
LONG_SECONDS = 2.0
"""After which a command that tells nothing of itself says that it works."""


def tell(text: str) -> None:
    """Say on standard error how a long command gets on; ``EPICYCLIC_PROGRESS=0`` turns it off."""
    if not _is_off():
        sys.stderr.write(f"{text}\n")


def _is_off() -> bool:
    return os.environ.get("EPICYCLIC_PROGRESS") == "0"


def progress_bar(noun: str) -> AbstractContextManager[Update]:
    """A callback ``(done, total, failed=0)`` that shows how far it is, with the time left."""
    console = Console(stderr=True)
    return _bar(noun, console) if console.is_terminal and not _is_off() else _lines(noun)


@contextmanager
def _bar(noun: str, console: Console) -> Iterator[Update]:
    bar = Progress(
        TextColumn(noun),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[failures]}"),
        console=console,
        transient=True,
    )
    with bar:
        task = bar.add_task(noun, total=None, failures="")

        def update(done: int, total: int, failed: int = 0) -> None:
            bar.update(task, completed=done, total=total, failures=_failures(failed))

        yield update


@contextmanager
def _lines(noun: str) -> Iterator[Update]:
    start = told = time.monotonic()
    first: tuple[float, int] | None = None  # of what is done; before it kernels are compiled

    def update(done: int, total: int, failed: int = 0) -> None:
        nonlocal told, first
        now = time.monotonic()
        if done and first is None:
            first = now, done
        if now - told < EVERY or _is_off():
            return
        told = now
        parts = [f"{noun}: {done} of {total} after {_seconds(now - start)}"]
        if first is not None and done > first[1]:
            left = (now - first[0]) * (total - done) / (done - first[1])
            parts.append(f"about {_seconds(left)} left")
        if failed:
            parts.append(_failures(failed))
        click.echo(", ".join(parts), err=True)

    yield update


def _failures(failed: int) -> str:
    return f"{failed} not converged" if failed else ""


def _seconds(duration: float) -> str:
    """``"0:01:05"``."""
    return str(timedelta(seconds=round(duration)))


def tell_compilation() -> None:
    """Say that kernels are compiled, and how far that is, should it take long."""
    first = told = 0.0
    count = 0

    def tell_of_kernel() -> None:
        nonlocal first, told, count
        now = time.monotonic()
        first, told, count = first or now, told or now, count + 1
        if now - told < COMPILING_EVERY or _is_off():
            return
        told = now
        click.echo(
            f"First run of this version: compiling the numerics, {count} of some {COMPILED} "
            f"functions after {_seconds(now - first)}.",
            err=True,
        )

    listeners.append(tell_of_kernel)


@contextmanager
def working(noun: str) -> Iterator[None]:
    """A bar without an end, and the time, for what takes long and tells nothing of itself."""
    console = Console(stderr=True)
    if not console.is_terminal or _is_off():
        yield
        return
    columns = (TextColumn(noun), BarColumn(), TimeElapsedColumn())
    bar = Progress(*columns, console=console, transient=True)
    bar.add_task(noun, total=None)
    begin = threading.Timer(LONG_SECONDS, bar.start)
    begin.daemon = True
    begin.start()
    try:
        yield
    finally:
        begin.cancel()
        begin.join()
        bar.stop()
