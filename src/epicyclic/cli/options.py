"""Options that commands share, above all a case and changes of its keys."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from typing import Any

import click

from epicyclic.cli.output import PICTURES, check_ending
from epicyclic.errors import InputError, Problem

case_argument = click.argument("case", metavar="CASE")
json_option = click.option(
    "--json",
    "json_file",
    metavar="[FILE]",
    is_flag=False,
    flag_value="-",
    help="Write the result as JSON, to standard output if no FILE or - is given.",
)
temperature_option = click.option(
    "--temperature",
    metavar="VALUES",
    help='Of the oil at the inlet, as in "40,60,90 degC"; default: that of the case.',
)


def runner_options(command: Callable[..., None]) -> Callable[..., None]:
    """Where points are computed: --jobs and --dask, of which the command gets a `runner`."""

    @click.option(
        "--jobs", type=click.IntRange(1, 10_000), help="Worker processes; default: as it pays."
    )
    @click.option("--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster, tcp://host:8786.")
    @wraps(command)
    def call(
        *args: Any, jobs: int | None, dask: str | None, shard: str | None = None, **options: Any
    ) -> None:
        from epicyclic.sweeps.runner import Runner, parse_shard

        runner = Runner(jobs, dask, parse_shard(shard))
        runner.check()
        command(*args, runner=runner, **options)

    return call


journal_option = click.option(
    "--journal",
    metavar="DIR",
    type=click.Path(path_type=Path),
    help="Keep finished points there, so that the same command goes on after an interruption.",
)
shard_option = click.option(
    "--shard", metavar="I/N", help="Compute share I of N; 'epicyclic merge' puts all together."
)
"""To stand above `runner_options`."""


def set_option_for(what: str, example: str) -> Callable[[Any], Any]:
    """The option --set for the keys of `what`."""
    return click.option(
        "--set",
        "changes",
        metavar="KEY=VALUE",
        multiple=True,
        help=f'Change a key of {what}, as in --set "{example}". An empty value removes the key; '
        "{sun,ring}.teeth are two keys.",
    )


set_option = set_option_for("the case", "operation.torque=500 N*m")
contact_set_option = set_option_for("the contact", "lubricant.eyring_stress=8 MPa")


def plot_option(text: str, endings: Sequence[str] = PICTURES) -> Callable[[Any], Any]:
    """The option --plot, with its help, of a file that must end so."""

    def checked(context: click.Context, option: click.Parameter, path: Path | None) -> Path | None:
        if path is not None:
            check_ending("--plot", path, endings)
        return path

    kind = click.Path(path_type=Path)
    return click.option("--plot", metavar="FILE", type=kind, callback=checked, help=text)


def output_option(
    text: str, metavar: str | None = None, required: bool = False
) -> Callable[[Any], Any]:
    """The option -o, with its help."""
    kind = click.Path(path_type=Path)
    return click.option("-o", "--output", required=required, metavar=metavar, type=kind, help=text)


picture_option = click.option(
    "--picture", type=click.Choice([ending[1:] for ending in PICTURES]), default="png"
)


def point_of(case: Any) -> str:
    """The operating point of a case, for the captions of its pictures."""
    from epicyclic.case.operating import operating_line

    return operating_line(case.inputs()["operation"])


def load_with(case: str, changes: Sequence[str]) -> Any:
    from epicyclic.exchange.load import load_case
    from epicyclic.exchange.rexs.file import is_rexs

    parsed = parse_changes(changes)
    return from_rexs(case, parsed) if is_rexs(case) else load_case(case, parsed)


def from_rexs(file: str, changes: dict[str, Any], component: int | None = None) -> Any:
    """The case of a REXS file; what it lacks, and what differs, is told on standard error."""
    from epicyclic.exchange.rexs.importing import read_rexs

    found = read_rexs(file, component)
    loaded = found.case(changes)
    for lack in found.lacking(changes):
        click.echo(f"{lack.key}: {lack}", err=True)
    for note in (*found.notes, *found.geometry_notes(loaded)):
        click.echo(f"Note: {note}", err=True)
    return loaded


def parse_changes(options: Sequence[str]) -> dict[str, Any]:
    from epicyclic.case.values import parse_value

    changes: dict[str, Any] = {}
    problems = []
    for option in options:
        key, equals, text = option.partition("=")
        if not equals or not key.strip():
            problems.append(
                Problem(
                    "--set",
                    f'"{option}"',
                    "must be KEY=VALUE.",
                    'For example --set "operation.torque=500 N*m".',
                )
            )
        else:
            value = parse_value(text.strip()) if text.strip() else None
            changes |= dict.fromkeys(_alternatives(key.strip()), value)
    if problems:
        raise InputError(problems, "the command")
    return changes


def _alternatives(key: str) -> list[str]:
    """The keys that braces stand for: ``{sun,ring}.teeth``."""
    match = re.fullmatch(r"(.*?)\{([^{}]*)\}(.*)", key)
    if match is None:
        return [key]
    start, names, end = match.groups()
    return [
        f"{start}{name.strip()}{rest}" for name in names.split(",") for rest in _alternatives(end)
    ]
