"""The command ``epicyclic``: parses, calls the library, prints, and ends soon on Ctrl-C."""

from __future__ import annotations

import atexit
import io
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NoReturn

import click

from epicyclic.cli import case, compare, duty, many, merge, pockets, show, uncertainty
from epicyclic.cli.common import echo, tell_compilation
from epicyclic.errors import (
    EXIT_BROKEN_PIPE,
    EXIT_DONE,
    EXIT_ERROR,
    EXIT_INPUT,
    EXIT_INTERRUPTED,
    EXIT_NO_SOLUTION,
    ConvergenceError,
    InputError,
    Problem,
    is_interrupt,
    printable,
    raise_any,
)
from epicyclic.registry import load, offered

# The exit codes are listed in docs/reference/errors.md; ``EPICYCLIC_TRACEBACK=1`` shows where in
# the program an error arose.

UNDER: Mapping[tuple[str, ...], str] = {
    ("pockets", "table"): "pockets-table",
    ("pockets", "study"): "study",
    ("validate", "reproduce"): "reproduce",
}
"""Commands that stand under another one, by both words, and their former names."""


WRITTEN = {"output", "plot", "json_file", "save", "map_file", "rotor", "animate"}
"""Arguments of commands that name files to write."""


def _check_files(context: click.Context) -> None:
    """Refuse to write over a file that the command reads, or twice to one place."""
    names = {
        it.name: it.human_readable_name if it.param_type_name == "argument" else it.opts[0]
        for it in context.command.params
    }
    places: dict[str, str] = {}
    wrong = []
    for name in sorted(context.params, key=WRITTEN.__contains__):  # first what is read
        value = context.params[name]
        for one in value if isinstance(value, tuple) else (value,):
            if not isinstance(one, str | Path) or str(one) == "-":
                continue
            if name not in WRITTEN and not os.path.isfile(one):  # noqa: PTH113 - texts may be too long
                continue
            other = places.setdefault(os.path.realpath(one), name)
            if other != name:
                allowed = f"is also the file of {names[other]}."
                wrong.append(Problem(names[name], str(one), allowed, "Name another one."))
    raise_any(wrong, "the command")


class _Context(click.Context):
    """That of a command, which checks its files before it begins."""

    def invoke(self, *given: Any, **options: Any) -> Any:
        _check_files(self)
        return super().invoke(*given, **options)


class _Commands(click.Group):
    """The commands of this package, and those of plug-ins, which are imported when called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return sorted({*self.commands, *offered("commands")} - {*UNDER.values()})

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if name := UNDER.get(tuple(args[:2])):
            args = [name, *args[2:]]
        return super().resolve_command(ctx, args)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        command = super().get_command(ctx, cmd_name)
        if command is None and cmd_name in offered("commands"):
            command = load("commands", cmd_name)
        if command is not None:
            command.context_class = _Context
        return command

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except BrokenPipeError as error:  # with its number click would make an exit of it
            raise BrokenPipeError from error


@click.group(cls=_Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="epicyclic")
def cli() -> None:
    """Power losses of gear pairs, planetary sets and gearboxes: how much, where, and why.

    CASE is a TOML or REXS file or the name of a built-in case (epicyclic cases).

    \b
    epicyclic run talbot-2012
    epicyclic run talbot-2012 --set "operation.torque=500 N*m" --json -
    epicyclic sweep talbot-2012 --vary "operation.speed=1000:4000:4 rpm" -o speed.nc
    """


for module in (case, compare, duty, many, merge, pockets, show, uncertainty):
    for command in vars(module).values():
        if isinstance(command, click.Command):
            cli.add_command(command)

_LONGEST_NAME = 300


def main() -> None:
    """Entry point: errors become messages and exit codes, never tracebacks."""
    tell_compilation()
    if sys.stdout is None:  # closed: what is printed must fail, and go into no file opened since
        sys.stdout = Path(os.devnull).open(encoding="utf-8")  # noqa: SIM115 - to the end
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # signs that a terminal does not know become ?
            stream.reconfigure(errors="replace")
    with ending_soon():
        code = _code_of(lambda: cli.main(standalone_mode=False))
        code = _code_of(_finish) or code
    if code:
        sys.exit(code)


def _code_of(call: Callable[[], object]) -> int:
    """The exit code of a call, its errors told."""
    try:
        call()
    except SystemExit as end:
        if isinstance(end.__context__, BrokenPipeError):  # of which rich makes an exit
            return _told(end.__context__)
        return int(end.code or EXIT_DONE)
    except KeyboardInterrupt:
        return _ended_interrupted()
    except click.Abort as abort:  # click takes the end of a file for an interruption
        return _told(abort.__cause__ if isinstance(abort.__cause__, EOFError) else abort)
    except Exception as error:
        return _told(error)
    return EXIT_DONE


def _finish() -> None:
    """What can still go wrong at the end."""
    if "epicyclic.kernels.compiling" in sys.modules:
        from epicyclic.kernels.compiling import cache_notes

        for note in cache_notes():
            echo(note, err=True)
    if sys.stdout is not None:
        sys.stdout.flush()


def _told(error: Exception) -> int:
    """Say what went wrong; the exit code."""
    if was_interrupted() or is_interrupt(error) or isinstance(error, click.Abort):
        return _ended_interrupted()
    match error:
        case click.ClickException():
            error.show()
            return EXIT_INPUT
        case InputError():
            echo(str(error), err=True)
            return EXIT_INPUT
        case ConvergenceError():
            echo(f"No solution: {error}", err=True)
            return EXIT_NO_SOLUTION
        case BrokenPipeError():  # the reader of a pipe has seen enough
            _discard_output()
            return EXIT_BROKEN_PIPE
        case OSError() if os.environ.get("EPICYCLIC_TRACEBACK") != "1":
            _discard_output()
            place = printable(str(error.filename or "the output"))[:_LONGEST_NAME]
            echo(f"The system refused access to {place}: {error.strerror or error}.", err=True)
            return EXIT_INPUT
    if os.environ.get("EPICYCLIC_TRACEBACK") == "1":
        raise error
    echo(
        f"Internal error: {type(error).__name__}: {error}\nSet EPICYCLIC_TRACEBACK=1 for the "
        "traceback.",
        err=True,
    )
    return EXIT_ERROR


def _discard_output() -> None:
    """What is left to be written goes nowhere: the interpreter would try it again at its end."""
    with suppress(OSError, ValueError, AttributeError):  # of streams that are closed or no files
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _ended_interrupted() -> int:
    tell_once()
    return EXIT_INTERRUPTED


# Ctrl-C ends a command soon, also while it is in compiled code, which never looks at signals.
#
# Python raises `KeyboardInterrupt` only between its own instructions, and a kernel may take
# minutes. But it writes every signal to a pipe at once, and kernels let other threads run: one that
# waits at the pipe ends the process if it has not ended by itself after a moment.


GRACE_SECONDS = 1.0  # For the command to end by itself, with its own last words.
CLEANING_SECONDS = 0.5  # For workers to be ended and temporary files to be removed after that.

_interrupted, _interrupt_seen = threading.Event(), threading.Event()


def was_interrupted() -> bool:
    """True after Ctrl-C, also if a library has swallowed the exception."""
    return _interrupted.is_set()


def tell_once() -> None:
    """Say that the command was interrupted, unless it has been said."""
    if not _interrupt_seen.is_set():
        _interrupt_seen.set()
        echo("Interrupted.", err=True)


@contextmanager
def ending_soon() -> Iterator[None]:
    """End the process soon after an interruption, whatever it does. For the main thread only."""
    _interrupted.clear()
    _interrupt_seen.clear()
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
        if "multiprocessing" in sys.modules:  # else none shares the work
            for worker in sys.modules["multiprocessing"].active_children():
                worker.terminate()  # those of loky have no `kill`
        tell_once()
        atexit.unregister(signal.signal)  # which only the main thread may call
        atexit._run_exitfuncs()
    os._exit(EXIT_INTERRUPTED)
