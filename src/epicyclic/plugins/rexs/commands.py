"""The commands rexs import and rexs export."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic.cli.common import (
    case_argument,
    case_with_remarks,
    echo,
    load_with,
    output_option,
    parse_changes,
    print_tables,
    set_option,
)
from epicyclic.errors import EXIT_INCOMPLETE, InputError, Problem, one_problem
from epicyclic.files import write_file
from epicyclic.show.terminal import plain_table

if TYPE_CHECKING:
    from epicyclic.plugins.rexs.importing import RexsImport


def import_tables(
    found: RexsImport,
    given: Mapping[str, Any],  # Keys that the user set.
    problems: Sequence[Problem],  # Problems of the case as it is.
    notes: Sequence[str],  # What is to be known beside the notes of the import itself.
) -> RenderableType:
    """Summary of an import."""
    head = Text(f"REXS {found.version}, {found.component}: {len(found.origins)} keys", "bold")
    parts: list[RenderableType] = [head]
    lacking = found.lacking(given)
    for title, needed in (("The case needs", True), ("Not in the file", False)):
        table = plain_table(title)
        table.add_column("key of the case", no_wrap=True)
        table.add_column("missing in the file", overflow="fold")
        for lack in lacking:
            if lack.needed == needed:
                table.add_row(Text(lack.key), Text(f"{lack.attribute}. {lack.instead}".rstrip()))
        if table.row_count:
            parts.append(table)
    needed_ones = [lack for lack in lacking if lack.needed]
    others = [item for item in problems if not any(lack.explains(item) for lack in needed_ones)]
    parts += [Text(f"Problem: {problem}") for problem in others]
    parts += [Text(f"Note: {note}") for note in (*found.notes, *notes)]
    return Group(*parts)


component_option = click.option(
    "--component", type=int, metavar="ID", help="One stage of several, by its id."
)


@click.group()
def rexs() -> None:
    """Import gears from REXS files, export results to them (.rexs, .rexsj, .rexsz)."""


@rexs.command("import")
@click.argument("file")
@output_option(
    "Output case file. Default: FILE with the ending .toml, in this folder.", "CASE.toml"
)
@component_option
@click.option("--load-case", type=int, metavar="ID", help="A load case of the load spectrum.")
@set_option
def import_(
    file: str,
    output: Path | None,
    component: int | None,
    load_case: int | None,
    changes: tuple[str, ...],
) -> None:
    """Write a commented case file from a REXS FILE, and say what the file lacks.

    Several stages become one train, unless --component names one of them.

    Every value is shown with the REXS attribute it comes from. If the case needs more than
    the file has, it is written anyway, with these keys marked NEEDED, and the command ends
    with exit code 5.
    """
    from epicyclic.case.case import KINDS
    from epicyclic.plugins.rexs.files import stem
    from epicyclic.plugins.rexs.importing import read_rexs
    from epicyclic.schema.fields import find_field

    target = output or Path(f"{stem(file)}.toml")
    if target.exists():
        remedy = "Name another file."
        raise one_problem("--output", str(target), "already exists.", remedy, "the command")
    parsed = parse_changes(changes)
    found = read_rexs(file, component, load_case)
    if any(find_field(KINDS[found.kind], key) is None for key in parsed):
        found.case(parsed)  # tells which keys it does not know
    write_file(target, found.text(parsed))
    problems: tuple[Problem, ...] = ()
    notes: tuple[str, ...] = ()
    try:
        notes = found.geometry_notes(found.case(parsed))
    except InputError as error:
        problems = error.problems
    print_tables(import_tables(found, parsed, problems, notes))
    echo(f"Wrote {target}.")
    if problems:
        echo(f"Set what is missing, then: epicyclic run {target}", err=True)
        sys.exit(EXIT_INCOMPLETE)
    echo(f"Next: epicyclic run {target}")


@rexs.command()
@case_argument
@click.argument("original", required=False)
@output_option("Output file: .rexs, .rexsj or .rexsz.", "FILE", required=True)
@component_option
@set_option
def export(
    case: str, original: str | None, output: Path, component: int | None, changes: tuple[str, ...]
) -> None:
    """Compute a CASE and write its results into a copy of the REXS file ORIGINAL.

    Everything else in ORIGINAL is unchanged. Without it a new file describes the gear set; if CASE
    is a REXS file, it is the original.
    """
    from epicyclic.plugins.rexs.exporting import rexs_bytes
    from epicyclic.plugins.rexs.files import is_rexs
    from epicyclic.plugins.rexs.importing import read_rexs
    from epicyclic.study.solve import solve

    if not is_rexs(output):
        allowed = "must end in .rexs, .rexsj or .rexsz."
        raise one_problem("--output", str(output), allowed, "Name such a file.")
    if is_rexs(case):
        original = original or case
        loaded = case_with_remarks(read_rexs(case, component), parse_changes(changes))
    else:
        loaded = load_with(case, changes)
    if original is None and component is not None:
        allowed = "names a stage of ORIGINAL, which is not given."
        raise one_problem("--component", str(component), allowed, "Add ORIGINAL.", "the command")
    write_file(output, rexs_bytes(output, solve(loaded), original, component))
    echo(f"Wrote {output}.")
