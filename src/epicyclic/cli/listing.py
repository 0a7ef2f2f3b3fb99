"""Commands that show or write what is built in: cases, oils, init, schema."""

from __future__ import annotations

from pathlib import Path

import click

from epicyclic.errors import InputError, Problem
from epicyclic.whole_file import write_file


@click.command()
def cases() -> None:
    """List the built-in cases and their variants."""
    from epicyclic.report.library_tables import case_table
    from epicyclic.report.tables import terminal

    terminal().print(case_table())


@click.command()
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


@click.command()
@click.argument("file", type=click.Path(path_type=Path), default=Path("case.toml"))
@click.option("--kind", type=click.Choice(["planetary", "gear_pair", "train"]))
@click.option("--minimal", is_flag=True, help="Only what must be stated.")
@click.option("--like", metavar="CASE", help="With the values of a built-in case or a file.")
def init(file: Path, kind: str | None, minimal: bool, like: str | None) -> None:
    """Write a commented case FILE (default case.toml) to start from."""
    from epicyclic import library
    from epicyclic.case.template import case_template, text_like

    if like is not None and (minimal or kind is not None):
        given = "--minimal" if minimal else "--kind"
        problem = Problem("--like", like, f"conflicts with {given}.", "Give one of them.")
        raise InputError([problem], "the command")
    if file.exists():
        problem = Problem("FILE", str(file), "exists already.", "Name another file.")
        raise InputError([problem], "the command")
    if like is not None:
        text = text_like(like)
    else:
        text = (library.minimal_case if minimal else case_template)(kind or "planetary")
    write_file(file, text)
    following = "check" if minimal else "run"
    click.echo(f"Wrote {file}. Next: epicyclic {following} {file}")


@click.command()
def schema() -> None:
    """Print the JSON Schema of case files."""
    import json

    from epicyclic.case.case import case_schema

    click.echo(json.dumps(case_schema(), indent=2))
