"""The command ``epicyclic``: parses, calls the library, prints.

Exit codes: 0 done, 2 bad input, 3 no solution found, 4 a sweep with failed cases, 130 interrupted.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from epicyclic.errors import ConvergenceError, InputError, Problem

__all__ = ["main"]

EXIT_INPUT, EXIT_NO_SOLUTION, EXIT_FAILED_CASES = 2, 3, 4
EXIT_INTERRUPTED, EXIT_BROKEN_PIPE = 130, 141
SHOWN_FAILURES = 10

case_argument = click.argument("case", metavar="CASE")
set_option = click.option(
    "--set",
    "changes",
    metavar="KEY=VALUE",
    multiple=True,
    help='Change a key of the case, as in --set "operation.torque=500 N*m". An empty value '
    "removes the key.",
)


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="epicyclic")
def cli() -> None:
    """Power losses of planetary gear sets and gear pairs: how much, where, and why.

    CASE is a TOML file or the name of a built-in case (epicyclic cases).

    \b
    epicyclic run talbot-2012
    epicyclic run talbot-2012 --set "operation.torque=500 N*m" --json -
    epicyclic sweep talbot-2012 --vary "operation.speed=1000:4000:4 rpm" -o speed.nc
    """


@cli.command()
@case_argument
@set_option
@click.option("--json", "json_file", metavar="FILE", help="Write the result as JSON; - for stdout.")
def run(case: str, changes: tuple[str, ...], json_file: str | None) -> None:
    """Compute the losses of a case and print them by component."""
    from epicyclic.analysis.solve import solve

    result = solve(_load(case, changes))
    if json_file == "-":
        click.echo(result.to_json())
        return
    from epicyclic.report.tables import result_tables, terminal

    if json_file is not None:
        _write(Path(json_file), result.to_json() + "\n")
    terminal().print(result_tables(result))


@cli.command()
@case_argument
@set_option
def check(case: str, changes: tuple[str, ...]) -> None:
    """Check a case without computing anything."""
    loaded = _load(case, changes)
    click.echo(f"{case}: a sound {loaded.kind} case.")


@cli.command()
def cases() -> None:
    """List the built-in cases and their variants."""
    from epicyclic.report.library_tables import case_table
    from epicyclic.report.tables import terminal

    terminal().print(case_table())


@cli.command()
@click.argument("name", required=False)
def oils(name: str | None) -> None:
    """List the built-in oils, or show one with the source of every value."""
    from epicyclic import library
    from epicyclic.case.nearest import did_you_mean
    from epicyclic.report.library_tables import oil_sheet, oil_table
    from epicyclic.report.tables import terminal

    if name is None:
        terminal().print(oil_table())
        return
    if name not in library.oil_names():
        remedy = did_you_mean(name, library.oil_names()) or "See 'epicyclic oils'."
        raise InputError([Problem("NAME", repr(name), "is no built-in oil.", remedy)])
    terminal().print(oil_sheet(name))


@cli.command()
@click.argument("file", type=click.Path(path_type=Path), default=Path("case.toml"))
@click.option("--kind", type=click.Choice(["planetary", "gear_pair"]), default="planetary")
def init(file: Path, kind: str) -> None:
    """Write a commented case FILE (default case.toml) to start from."""
    from epicyclic.report.template import case_template

    if file.exists():
        problem = Problem("FILE", str(file), "exists already.", "Name another file.")
        raise InputError([problem], "the command")
    _write(file, case_template(kind))
    click.echo(f"Wrote {file}. Next: epicyclic run {file}")


@cli.command()
def schema() -> None:
    """Print the JSON Schema of case files."""
    import json

    from epicyclic.case.case import case_schema

    click.echo(json.dumps(case_schema(), indent=2))


@cli.command()
@case_argument
@set_option
def friction(case: str, changes: tuple[str, ...]) -> None:
    """Compare all friction models on a case, with the spread."""
    from epicyclic.analysis.compare import compare_friction
    from epicyclic.report.tables import friction_table, terminal

    terminal().print(friction_table(compare_friction(_load(case, changes))))


@cli.command()
@case_argument
@set_option
@click.option(
    "--vary",
    metavar="KEY=VALUES",
    multiple=True,
    required=True,
    help='a,b,c or start:stop:count, as in "operation.speed=1000:4000:4 rpm".',
)
@click.option(
    "-o", "--output", required=True, type=click.Path(path_type=Path), help=".nc, .csv or .parquet"
)
@click.option("--jobs", type=click.IntRange(1), help="Worker processes; default: as it pays.")
def sweep(
    case: str, changes: tuple[str, ...], vary: tuple[str, ...], output: Path, jobs: int | None
) -> None:
    """Compute the full product of the values of some keys.

    Finished cases are kept in OUTPUT.partial, so that an interrupted sweep goes on where it
    stopped when the same command is given again.
    """
    from epicyclic.cli.progress import progress_bar
    from epicyclic.sweeps.dataset import check_output, write_dataset
    from epicyclic.sweeps.plan import parse_vary
    from epicyclic.sweeps.run import sweep as run_sweep

    loaded = _load(case, changes)
    check_output(output)
    journal = output.with_name(f"{output.name}.partial")
    values = parse_vary(loaded, vary)
    with progress_bar("cases") as progress:
        dataset = run_sweep(loaded, values, jobs=jobs, journal=journal, progress=progress)
    write_dataset(dataset, output)
    journal.unlink(missing_ok=True)
    failed = _count_failures(dataset)
    count = dataset["status"].size
    outcome = f", {failed} of them failed." if failed else "."
    click.echo(f"Wrote {count} cases to {output}{outcome}")
    if failed:
        sys.exit(EXIT_FAILED_CASES)


@cli.command()
def validate() -> None:
    """Compare with published figures: published, computed, difference, verdict."""
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.tables import terminal
    from epicyclic.report.validation_table import validation_table
    from epicyclic.validation.compare import compare_published

    with progress_bar("figures") as progress:
        rows = compare_published(progress)
    terminal().print(validation_table(rows))


def _load(case: str, changes: Sequence[str]) -> Any:
    from epicyclic.case.case import load_case

    loaded = load_case(case)
    return loaded.updated(_parse_changes(changes)) if changes else loaded


def _parse_changes(options: Sequence[str]) -> dict[str, Any]:
    from epicyclic.case.values import parse_value

    changes: dict[str, Any] = {}
    problems = []
    for option in options:
        key, equals, text = option.partition("=")
        if not equals or not key.strip():
            problems.append(
                Problem(
                    "--set", f'"{option}"', "must be KEY=VALUE.",
                    'For example --set "operation.torque=500 N*m".',
                )
            )  # fmt: skip
        else:
            changes[key.strip()] = parse_value(text.strip()) if text.strip() else None
    if problems:
        raise InputError(problems, "the command")
    return changes


def _write(path: Path, text: str) -> None:
    """Write `text` whole or not at all."""
    temporary = path.with_name(f".{path.name}.tmp")
    try:
        temporary.write_text(text, encoding="utf-8")
        temporary.replace(path)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        problem = Problem("FILE", str(path), f"cannot be written: {error.strerror}.", "Move it.")
        raise InputError([problem], "the command") from None


def _count_failures(dataset: Any) -> int:
    """Number of failed cases; prints each reason once."""
    failed = dataset["status"].values.ravel() == "failed"
    reasons = dataset["message"].values.ravel()[failed]
    unique = dict.fromkeys(str(reason) for reason in reasons)
    for reason in list(unique)[:SHOWN_FAILURES]:
        click.echo(f"{int((reasons == reason).sum())} failed: {reason}", err=True)
    if len(unique) > SHOWN_FAILURES:
        click.echo(f"... and {len(unique) - SHOWN_FAILURES} other reasons.", err=True)
    return int(failed.sum())


def main() -> None:
    """Entry point: errors become messages and exit codes, never tracebacks."""
    try:
        cli.main(standalone_mode=False)
    except click.ClickException as error:
        error.show()
        sys.exit(EXIT_INPUT)
    except InputError as error:
        click.echo(str(error), err=True)
        sys.exit(EXIT_INPUT)
    except ConvergenceError as error:
        click.echo(f"No solution: {error}", err=True)
        sys.exit(EXIT_NO_SOLUTION)
    except BrokenPipeError:  # the reader of a pipe has seen enough
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123
        sys.exit(EXIT_BROKEN_PIPE)
    except (KeyboardInterrupt, click.Abort):
        click.echo("Interrupted.", err=True)
        sys.exit(EXIT_INTERRUPTED)
