"""The progress bar, on standard error and only on a terminal."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

__all__ = ["progress_bar", "tell", "working"]

LONG_SECONDS = 2.0
"""After which a command that tells nothing of itself says that it works."""


def tell(text: str) -> None:
    """Say on standard error how a long command gets on; ``EPICYCLIC_PROGRESS=0`` turns it off."""
    if not _is_off():
        sys.stderr.write(f"{text}\n")


def _is_off() -> bool:
    return os.environ.get("EPICYCLIC_PROGRESS") == "0"


@contextmanager
def progress_bar(noun: str) -> Iterator[Callable[..., None]]:
    """A callback ``(done, total, failed=0)`` that draws a bar with the time left.

    ``EPICYCLIC_PROGRESS=0`` turns it off.
    """
    console = Console(stderr=True)
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
        disable=not console.is_terminal or _is_off(),
    )
    with bar:
        task = bar.add_task(noun, total=None, failures="")

        def update(done: int, total: int, failed: int = 0) -> None:
            failures = f"{failed} not converged" if failed else ""
            bar.update(task, completed=done, total=total, failures=failures)

        yield update


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
