"""Commands that show what is built in or stored: cases, oils, init, schema, report, plot."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.common import (
    PICTURES,
    check_ending,
    check_page,
    draw,
    echo,
    load_with,
    output_option,
    parse_size,
    print_tables,
    progress_bar,
    set_option,
    write_page,
)
from epicyclic.errors import one_problem
from epicyclic.files import write_file
from epicyclic.messages import did_you_mean

if TYPE_CHECKING:
    from epicyclic.show.plots.catalogue import Stored


@click.command()
def cases() -> None:
    """List the built-in cases and their variants."""
    from epicyclic.show.data_sheet import case_table

    print_tables(case_table())


@click.command()
@click.argument("name", required=False)
def oils(name: str | None) -> None:
    """List the built-in oils, or show one with the source of every value."""
    from epicyclic import library
    from epicyclic.show.data_sheet import oil_sheet, oil_table

    if name is None:
        print_tables(oil_table())
        return
    if name not in library.names("oils"):
        remedy = did_you_mean(name, library.names("oils")) or "See 'epicyclic oils'."
        raise one_problem("NAME", repr(name), "is not a built-in oil.", remedy)
    print_tables(oil_sheet(name))


@click.command()
@click.argument("file", type=click.Path(path_type=Path), default=Path("case.toml"))
@click.option("--kind", type=click.Choice(["planetary", "gear_pair", "train"]))
@click.option("--minimal", is_flag=True, help="A short file: required keys and a few others.")
@click.option("--like", metavar="CASE", help="Use the values of a built-in case or a file.")
def init(file: Path, kind: str | None, minimal: bool, like: str | None) -> None:
    """Write a commented case FILE (default case.toml) to start from."""
    from epicyclic import library
    from epicyclic.show.template import case_template, text_like

    if like is not None and (minimal or kind is not None):
        given = "--minimal" if minimal else "--kind"
        allowed = f"conflicts with {given}."
        raise one_problem("--like", like, allowed, "Give one of them.", "the command")
    allowed, remedy = "already exists.", "Name another file."
    if str(file) in library.names("cases"):  # it would stand in for that from then on
        allowed, remedy = "is a built-in case.", f"Name a file; --like {file} copies the case."
    if file.exists() or str(file) in library.names("cases"):
        raise one_problem("FILE", str(file), allowed, remedy, "the command")
    if like is not None:
        text = text_like(like)
    else:
        text = (library.minimal_case if minimal else case_template)(kind or "planetary")
    write_file(file, text)
    following = "check" if minimal else "run"
    echo(f"Wrote {file}. Next: epicyclic {following} {file}")


@click.command()
def schema() -> None:
    """Print the JSON Schema of case files."""
    from epicyclic.case.case import case_schema

    click.echo(json.dumps(case_schema(), indent=2))


stored_argument = click.argument("source", metavar="CASE|FILE.nc")


@click.command()
@stored_argument
@set_option
@output_option(".html, or .pdf.", required=True)
@click.option("--size", metavar="SIZE", help='Size of every figure, as in "160x90 mm".')
def report(source: str, changes: tuple[str, ...], output: Path, size: str | None) -> None:
    """Write a self-contained report: an HTML page or a PDF.

    FILE.nc is what run --save, map, sweep or uncertainty wrote; a CASE is solved first.
    """
    check_page(output)
    millimetres = None if size is None else parse_size(size)
    stored = _stored(source, changes)
    from epicyclic.show.html import report_html

    with progress_bar("figures") as progress:
        page = report_html(stored, progress, size=millimetres)
    write_page(output, page)


@click.command()
@stored_argument
@click.argument("what", required=False)
@set_option
@output_option(f"Image file, {', '.join(PICTURES)}; default: WHAT.png.")
@click.option("--size", metavar="SIZE", help='Size, as in "160x90 mm"; default: that of a slide.')
@click.option(
    "--dpi",
    type=click.IntRange(20, 1200),
    help="Pixels per inch of a .png; default: 1920 pixels over the width.",
)
@click.option(
    "--format",
    "ending",
    type=click.Choice([name[1:] for name in PICTURES]),
    help="Format of WHAT.FORMAT, if no output is given.",
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
    if what is None and (output or size or dpi or ending):
        remedy = "Give it, or leave out what belongs to a picture to see the list."
        raise one_problem("WHAT", "", "is missing.", remedy, "the command")
    if output is None:
        output = Path(f"{what}.{ending or 'png'}")
    check_ending("-o", output, PICTURES if ending is None else (f".{ending}",))
    millimetres = None if size is None else parse_size(size)
    from epicyclic.show.plots.catalogue import available, figure_of

    stored = _stored(source, changes)
    if what is None:
        found = available(stored)
        width = max(map(len, found))
        for name, entry in found.items():
            echo(f"{name:<{width}}  {entry.question}")
        return
    draw(figure_of(stored, what, size=millimetres, dpi=dpi), output)


def _stored(source: str, changes: Sequence[str]) -> Stored:
    """What a file holds, or the record of a case."""
    from epicyclic.show.record import is_stored, open_result, record

    if not is_stored(source):
        return record(load_with(source, changes))
    if changes:
        allowed = "changes a case and cannot be applied to a stored result."
        remedy = "Solve the case with it: epicyclic run CASE --set ... --save FILE.nc."
        raise one_problem("--set", f'"{changes[0]}"', allowed, remedy, "the command")
    return open_result(source)
