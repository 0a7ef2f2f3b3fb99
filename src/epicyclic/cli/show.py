"""Commands that show a stored result or map, or a case solved afresh: report, plot."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.options import load_with, output_option, set_option
from epicyclic.cli.output import PICTURES, check_ending, check_page, draw, parse_size, write_page
from epicyclic.errors import InputError, Problem

if TYPE_CHECKING:
    from epicyclic.plots.catalogue import Stored

stored_argument = click.argument("source", metavar="CASE|FILE.nc")


@click.command()
@stored_argument
@set_option
@output_option(".html, or .pdf.", required=True)
@click.option("--size", metavar="SIZE", help='Of every figure, as in "160x90 mm".')
def report(source: str, changes: tuple[str, ...], output: Path, size: str | None) -> None:
    """Write a report as one file that needs nothing else: a page, or print.

    FILE.nc is what run --save, map, sweep or uncertainty wrote; a CASE is solved first.
    """
    from epicyclic.cli.progress import progress_bar

    check_page(output)
    millimetres = None if size is None else parse_size(size)
    stored = _stored(source, changes)
    from epicyclic.report.html import report_html

    with progress_bar("figures") as progress:
        page = report_html(stored, progress, size=millimetres)
    write_page(output, page)


@click.command()
@stored_argument
@click.argument("what", required=False)
@set_option
@output_option(f"The picture, {', '.join(PICTURES)}; default: WHAT.png.")
@click.option("--size", metavar="SIZE", help='As in "160x90 mm"; default: that of a slide.')
@click.option(
    "--dpi",
    type=click.IntRange(20, 1200),
    help="Pixels an inch of a .png; default: 1920 pixels over the width.",
)
@click.option(
    "--format",
    "ending",
    type=click.Choice([name[1:] for name in PICTURES]),
    help="Of WHAT.FORMAT, if no output is named.",
)
def plot(
    source: str,
    what: str | None,
    changes: tuple[str, ...],
    output: Path | None,
    size: str | None,
    dpi: int | None,
    ending: str | None,
) -> None:
    """Draw one plot of a result, map or sweep; without WHAT, list what can be drawn.

    FILE.nc is what run --save, map, sweep or uncertainty wrote; a CASE is solved first.
    """
    if output is None:
        output = Path(f"{what}.{ending or 'png'}")
    check_ending("-o", output, PICTURES if ending is None else (f".{ending}",))
    millimetres = None if size is None else parse_size(size)
    from epicyclic.plots.catalogue import available, figure_of

    stored = _stored(source, changes)
    if what is None:
        found = available(stored)
        width = max(map(len, found))
        for name, entry in found.items():
            click.echo(f"{name:<{width}}  {entry.question}")
        return
    draw(figure_of(stored, what, size=millimetres, dpi=dpi), output)


def _stored(source: str, changes: Sequence[str]) -> Stored:
    """What a file holds, or the record of a case."""
    from epicyclic.records.files import is_stored, open_result
    from epicyclic.records.record import record

    if not is_stored(source):
        return record(load_with(source, changes))
    if changes:
        problem = Problem(
            "--set",
            f'"{changes[0]}"',
            "changes a case, and a stored result is none.",
            "Solve the case with it: epicyclic run CASE --set ... --save FILE.nc.",
        )
        raise InputError([problem], "the command")
    return open_result(source)
