"""Entry point of the command: ``epicyclic`` and ``python -m epicyclic``.

Imports take a second or two. Until `epicyclic.cli.main` watches, Ctrl-C ends the process at
once: nothing has been begun, and libraries may swallow or wrap an exception.
"""

from __future__ import annotations

import atexit
import gc
import os
import signal
from typing import NoReturn

from epicyclic.errors import EXIT_INTERRUPTED
from epicyclic.files import look_seldom


def main() -> None:
    """Run the command."""
    signal.signal(signal.SIGINT, _end)
    atexit.register(signal.signal, signal.SIGINT, signal.SIG_IGN)  # last: what is done stays done
    look_seldom()
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
