"""Commands on many cases, resumed where they were interrupted: sweep, map."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.exit_codes import EXIT_FAILED_POINTS
from epicyclic.cli.options import (
    case_argument,
    jobs_option,
    load_with,
    set_option,
    temperature_option,
)
from epicyclic.cli.output import finishing
from epicyclic.errors import InputError, Problem
from epicyclic.status import Status

if TYPE_CHECKING:
    from epicyclic.sweeps.journal import Journal, Row
    from epicyclic.sweeps.plan import Plan

__all__ = ["check_values", "kept_in", "loss_map", "open_journal", "print_failures", "sweep"]

SHOWN_FAILURES = 10


@click.command()
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
@jobs_option
def sweep(
    case: str, changes: tuple[str, ...], vary: tuple[str, ...], output: Path, jobs: int | None
) -> None:
    """Compute the full product of the values of some keys.

    Finished points are kept in a file beside OUTPUT that ends in .partial, so that an interrupted
    sweep goes on where it stopped when the same command is given again.
    """
    from epicyclic.sweeps import dataset
    from epicyclic.sweeps.plan import make_plan, parse_vary

    loaded = load_with(case, changes)
    dataset.check_output(output)
    plan = make_plan(loaded, parse_vary(loaded, vary))
    compute_points(
        plan,
        output,
        jobs,
        lambda rows: dataset.write_dataset(dataset.to_dataset(plan, rows), output),
    )


@click.command("map")
@case_argument
@set_option
@click.option(
    "--speed", metavar="VALUES", required=True, help='Of the input member, as in "0:4000:41 rpm".'
)
@click.option(
    "--torque",
    metavar="VALUES",
    required=True,
    help='On the input member, as in "-1000:1000:41 N*m"; against the speed is coasting.',
)
@temperature_option
@click.option(
    "--vary", metavar="KEY=VALUES", multiple=True, help='Further keys, as in "planet.count=3,4".'
)
@click.option(
    "-o", "--output", required=True, type=click.Path(path_type=Path), help="File of the map."
)
@click.option("--format", "name", metavar="NAME", help="Default: by the ending of the file.")
@jobs_option
def loss_map(
    case: str,
    changes: tuple[str, ...],
    vary: tuple[str, ...],
    output: Path,
    name: str | None,
    jobs: int | None,
    **values: str | None,
) -> None:
    """Compute a loss map: torque loss, losses and efficiency over speed and torque.

    VALUES are a,b,c or start:stop:count with a unit. The torque loss is that at the input member;
    the file states the signs. An interrupted map goes on where it stopped, as a sweep does.
    """
    from epicyclic.maps.compute import AXES, coordinates, held_shaft, map_plan, row_length, to_map
    from epicyclic.maps.formats import check_map_output, write_map
    from epicyclic.sweeps.plan import parse_vary

    loaded = load_with(case, changes)
    check_values(values)
    axes = [f"{AXES[axis]}={text}" for axis, text in values.items() if text is not None]
    given, further = parse_vary(loaded, axes), parse_vary(loaded, vary)
    speed, torque = given[AXES["speed"]], given[AXES["torque"]]
    plan = map_plan(loaded, speed, torque, given.get(AXES["temperature"]), further)
    check_map_output(output, name, coordinates(plan), held_shaft(loaded))
    compute_points(
        plan,
        output,
        jobs,
        lambda rows: write_map(to_map(plan, rows), output, name),
        batch=row_length(plan),
    )


def check_values(values: Mapping[str, str | None]) -> None:
    """Raise `InputError` for options that name no values."""
    problems = [
        Problem(
            f"--{name}",
            f'"{text}"',
            "must be a,b,c or start:stop:count with a unit.",
            'For example "0:4000:41 rpm" for the speed.',
        )
        for name, text in values.items()
        if text is not None and not text.strip()
    ]
    if problems:
        raise InputError(problems, "the command")


def compute_points(
    plan: Plan,
    output: Path,
    jobs: int | None,
    write: Callable[[Sequence[Row]], None],
    **options: int,
) -> None:
    """Compute the points of `plan`, resumed and kept beside `output`, and `write` their rows."""
    from epicyclic.cli.progress import progress_bar
    from epicyclic.sweeps.run import run_plan

    journal = open_journal(plan.fingerprint(), plan.size, output)
    with kept_in(journal, plan.size):
        with progress_bar("points") as progress:
            rows = run_plan(plan, jobs=jobs, journal=journal, progress=progress, **options)
        reasons = [row.message for row in rows if row.status == Status.FAILED]
        print_failures(reasons)
        with finishing(f"Writing {output}."):
            write(rows)
            journal.remove()
    outcome = f", {len(reasons)} of them failed." if reasons else "."
    click.echo(f"Wrote {plan.size} point{'' if plan.size == 1 else 's'} to {output}{outcome}")
    if reasons:
        sys.exit(EXIT_FAILED_POINTS)


def open_journal(fingerprint: str, size: int, output: Path) -> Journal:
    """The journal of a sweep beside `output`; says what is there from interrupted sweeps.

    `fingerprint` is that of the sweep, `size` the number of its points.
    """
    from epicyclic.sweeps.journal import Journal

    journal = Journal(output.with_name(f"{output.name}.{fingerprint}.partial"), fingerprint)
    others = [
        path
        for path in output.parent.iterdir()
        if path.name.startswith(f"{output.name}.") and path.suffix == journal.path.suffix
        if path.name != journal.path.name
    ]
    for path in sorted(others):
        click.echo(
            f"{path} holds points of an interrupted sweep of another case or other values; it is "
            "kept. Delete it if you do not need it.",
            err=True,
        )
    kept = len(journal.read())
    if kept:
        click.echo(f"Going on from {kept} of {size} points in {journal.path}.", err=True)
    return journal


@contextmanager
def kept_in(journal: Journal, size: int) -> Iterator[None]:
    """Say what is left of a sweep that does not reach its end."""
    try:
        yield
    except (KeyboardInterrupt, Exception):
        kept = len(journal.read())
        if kept:
            click.echo(
                f"{kept} of {size} points kept in {journal.path}; give the same command again to "
                "go on.",
                err=True,
            )
        raise


def print_failures(reasons: Sequence[str]) -> None:
    """Each reason once, with the number of points that failed for it."""
    counts = Counter(reasons)
    for reason, count in list(counts.items())[:SHOWN_FAILURES]:
        click.echo(f"{count} failed: {reason}", err=True)
    if len(counts) > SHOWN_FAILURES:
        click.echo(f"... and {len(counts) - SHOWN_FAILURES} other reasons.", err=True)
