"""The command ``epicyclic``: parses, calls the library, prints.

Its exit codes are listed in docs/reference/errors.md; ``EPICYCLIC_TRACEBACK=1`` shows where in the
program an error arose.
"""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable
from contextlib import suppress

import click

from epicyclic.cli.app import app
from epicyclic.cli.compare import compare
from epicyclic.cli.contact import contact
from epicyclic.cli.duty import duty
from epicyclic.cli.exit_codes import (
    EXIT_BROKEN_PIPE,
    EXIT_DONE,
    EXIT_ERROR,
    EXIT_INPUT,
    EXIT_INTERRUPTED,
    EXIT_NO_SOLUTION,
)
from epicyclic.cli.heat import heat
from epicyclic.cli.interrupt import ending_soon, tell_once, was_interrupted
from epicyclic.cli.listing import cases, init, oils, schema
from epicyclic.cli.many import loss_map, sweep
from epicyclic.cli.merge import merge
from epicyclic.cli.oil import oil
from epicyclic.cli.pockets import pockets, study
from epicyclic.cli.pockets_table import pockets_table
from epicyclic.cli.progress import tell_compilation
from epicyclic.cli.reproduce import reproduce
from epicyclic.cli.rexs import rexs
from epicyclic.cli.show import plot, report
from epicyclic.cli.single import check, friction, mesh, run
from epicyclic.cli.uncertainty import compare_cases, uncertainty
from epicyclic.cli.validate import validate
from epicyclic.cli.warm_up import warm_up
from epicyclic.errors import ConvergenceError, InputError, is_interrupt, printable


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="epicyclic")
def cli() -> None:
    """Power losses of gear pairs, planetary sets and gearboxes: how much, where, and why.

    CASE is a TOML or REXS file or the name of a built-in case (epicyclic cases).

    \b
    epicyclic run talbot-2012
    epicyclic run talbot-2012 --set "operation.torque=500 N*m" --json -
    epicyclic sweep talbot-2012 --vary "operation.speed=1000:4000:4 rpm" -o speed.nc
    """


_LONGEST_NAME = 300
COMMANDS = (
    run,
    check,
    sweep,
    loss_map,
    merge,
    duty,
    uncertainty,
    compare_cases,
    heat,
    warm_up,
    mesh,
    pockets,
    pockets_table,
    study,
    contact,
    oil,
    friction,
    compare,
    validate,
    reproduce,
    cases,
    oils,
    init,
    app,
    report,
    plot,
    rexs,
    schema,
)
for command in COMMANDS:
    cli.add_command(command)


def main() -> None:
    """Entry point: errors become messages and exit codes, never tracebacks."""
    tell_compilation()
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
    if "epicyclic.kernels._jit" in sys.modules:
        from epicyclic.kernels._jit import cache_notes

        for note in cache_notes():
            click.echo(note, err=True)
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
            click.echo(str(error), err=True)
            return EXIT_INPUT
        case ConvergenceError():
            click.echo(f"No solution: {error}", err=True)
            return EXIT_NO_SOLUTION
        case BrokenPipeError():  # the reader of a pipe has seen enough
            _discard_output()
            return EXIT_BROKEN_PIPE
        case OSError() if os.environ.get("EPICYCLIC_TRACEBACK") != "1":
            _discard_output()
            place = printable(str(error.filename or "the output"))[:_LONGEST_NAME]
            click.echo(f"The system refuses {place}: {error.strerror or error}.", err=True)
            return EXIT_INPUT
    if os.environ.get("EPICYCLIC_TRACEBACK") == "1":
        raise error
    click.echo(
        f"Error of the program: {type(error).__name__}: {error}\n"
        "Set EPICYCLIC_TRACEBACK=1 to see where it arose.",
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
