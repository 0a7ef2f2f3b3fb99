"""The command ``epicyclic``: parses, calls the library, prints.

Its exit codes are listed in docs/reference/errors.md; ``EPICYCLIC_TRACEBACK=1`` shows where in the
program an error arose.
"""

from __future__ import annotations

import os
import sys

import click

from epicyclic.cli.compare import compare
from epicyclic.cli.contact import contact
from epicyclic.cli.duty import duty
from epicyclic.cli.exit_codes import (
    EXIT_BROKEN_PIPE,
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
from epicyclic.cli.reproduce import reproduce
from epicyclic.cli.rexs import rexs
from epicyclic.cli.show import plot, report
from epicyclic.cli.single import check, friction, mesh, run
from epicyclic.cli.uncertainty import compare_cases, uncertainty
from epicyclic.cli.validate import validate
from epicyclic.cli.warm_up import warm_up
from epicyclic.errors import ConvergenceError, InputError, is_interrupt

__all__ = ["main"]


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="epicyclic")
def cli() -> None:
    """Power losses of planetary gear sets and gear pairs: how much, where, and why.

    CASE is a TOML or REXS file or the name of a built-in case (epicyclic cases).

    \b
    epicyclic run talbot-2012
    epicyclic run talbot-2012 --set "operation.torque=500 N*m" --json -
    epicyclic sweep talbot-2012 --vary "operation.speed=1000:4000:4 rpm" -o speed.nc
    """


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
    report,
    plot,
    rexs,
    schema,
)
for command in COMMANDS:
    cli.add_command(command)


def main() -> None:
    """Entry point: errors become messages and exit codes, never tracebacks."""
    with ending_soon():
        try:
            cli.main(standalone_mode=False)
        except KeyboardInterrupt:
            sys.exit(_ended_interrupted())
        except click.Abort as abort:  # click takes the end of a file for an interruption
            sys.exit(_told(abort.__cause__ if isinstance(abort.__cause__, EOFError) else abort))
        except Exception as error:
            sys.exit(_told(error))
        finally:
            _tell_of_cache()


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
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return EXIT_BROKEN_PIPE
    if os.environ.get("EPICYCLIC_TRACEBACK") == "1":
        raise error
    click.echo(
        f"Error of the program: {type(error).__name__}: {error}\n"
        "Set EPICYCLIC_TRACEBACK=1 to see where it arose.",
        err=True,
    )
    return EXIT_ERROR


def _tell_of_cache() -> None:
    """Say what is wrong with the compiled code that is kept, if any has been asked for."""
    if "epicyclic.kernels._jit" in sys.modules:
        from epicyclic.kernels._jit import cache_notes

        for note in cache_notes():
            click.echo(note, err=True)


def _ended_interrupted() -> int:
    tell_once()
    return EXIT_INTERRUPTED
