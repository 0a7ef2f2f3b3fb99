"""Entry point of the command: ``epicyclic`` and ``python -m epicyclic``.

Imports take a second or two. Until `epicyclic.cli.interrupt` watches, Ctrl-C ends the process at
once: nothing has been begun, and libraries may swallow or wrap an exception.
"""

from __future__ import annotations

import gc
import os
import signal
from typing import NoReturn

from epicyclic.cli.exit_codes import EXIT_INTERRUPTED

__all__ = ["main"]

NEW_OBJECTS = 100_000
"""So many make Python look for garbage. Imports make several times as many, all of them to stay."""


def main() -> None:
    """Run the command."""
    signal.signal(signal.SIGINT, _end)
    gc.set_threshold(NEW_OBJECTS)
    from epicyclic.cli.main import main as run

    try:
        run()
    finally:
        gc.freeze()  # the process ends: to look through its memory once more would free nothing


def _end(number: int, frame: object) -> NoReturn:
    os.write(2, b"Interrupted.\n")
    os._exit(EXIT_INTERRUPTED)


if __name__ == "__main__":
    main()
