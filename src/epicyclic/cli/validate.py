"""The command validate: published figures beside computed ones."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.options import output_option
from epicyclic.cli.output import check_page, write_page
from epicyclic.errors import InputError, Problem

if TYPE_CHECKING:
    from rich.console import RenderableType

    from epicyclic.validation.closures import ClosureFigure
    from epicyclic.validation.compare import Comparison


@click.command()
@click.option(
    "--temperatures",
    is_flag=True,
    help="The loaded tests only, with temperatures that follow from the losses: minutes.",
)
@click.option(
    "--bands",
    is_flag=True,
    help="The measured figures only, with the 95 % bands of the computed ones: a minute.",
)
@output_option("A page with pictures and tables in place of the table: .html, or .pdf.", "FILE")
def validate(temperatures: bool, bands: bool, output: Path | None) -> None:
    """Compare with published figures: published, computed, difference, verdict."""
    from epicyclic.report.tables import terminal

    chosen = [
        name for name, is_on in (("--temperatures", temperatures), ("--bands", bands)) if is_on
    ]
    others = [*chosen[1:], *(["-o"] if output is not None else [])]
    if chosen and others:
        problems = [
            Problem(name, "", f"does not go with {chosen[0]}.", "Leave one of them out.")
            for name in others
        ]
        raise InputError(problems, "the command")
    if temperatures:
        terminal().print(_settled())
    elif bands:
        terminal().print(_banded())
    elif output is None:
        from epicyclic.report.tables import as_on_page
        from epicyclic.report.validation_table import closure_table, validation_table

        rows, closures = _compared(), _closures()
        terminal().print(as_on_page(closure_table(closures)))
        terminal().print(validation_table(rows, closures))
    else:
        _write(output)


def _write(output: Path) -> None:
    """The page of all figures, and what it comes to."""
    check_page(output)
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.validation_page import validation_html
    from epicyclic.validation.compare import summary

    rows = _compared()
    closures = _closures()
    with progress_bar("pictures") as progress:
        page = validation_html(rows, closures, progress)
    write_page(output, page)
    click.echo(summary(rows, closures))


def _compared() -> tuple[Comparison, ...]:
    from epicyclic.cli.progress import progress_bar
    from epicyclic.validation.compare import compare_published

    with progress_bar("figures") as progress:
        return compare_published(progress)


def _closures() -> tuple[ClosureFigure, ...]:
    from epicyclic.cli.progress import progress_bar
    from epicyclic.validation.closures import closure_figures

    with progress_bar("closures of the flow through pockets") as progress:
        return closure_figures(progress)


def _settled() -> RenderableType:
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.validation_table import settled_table
    from epicyclic.sweeps.runner import Runner
    from epicyclic.validation.settled import estimates, settled_figures

    with progress_bar("tests") as progress:
        return settled_table(settled_figures(Runner(progress=progress)), estimates())


def _banded() -> RenderableType:
    from epicyclic.bands.published import measured_figures
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.validation_table import bands_table
    from epicyclic.sweeps.runner import Runner

    with progress_bar("tests") as progress:
        return bands_table(measured_figures(Runner(progress=progress)))
