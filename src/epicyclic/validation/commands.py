"""The commands validate and reproduce."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.common import (
    check_page,
    output_option,
    picture_bytes,
    picture_option,
    progress_bar,
    runner_options,
    write_page,
)
from epicyclic.errors import InputError, Problem
from epicyclic.files import make_folder, write_file

if TYPE_CHECKING:
    from epicyclic.study.sweeps.runner import Runner


# The command validate: published figures beside computed ones.


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
    # computing and drawing are loaded by those who ask for them: the command line starts quickly
    from epicyclic.report.tables import as_on_page, terminal
    from epicyclic.study.sweeps.runner import Runner
    from epicyclic.validation import compare, pages

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
    if chosen:
        with progress_bar("tests") as progress:
            runner = Runner(progress=progress)
            if temperatures:
                settled = compare.settled_figures(runner)
                shown = pages.settled_table(settled, compare.estimates())
            else:
                shown = pages.bands_table(compare.measured_figures(runner))
        terminal().print(shown)
        return
    if output is not None:
        check_page(output)
    with progress_bar("figures") as progress:
        rows = compare.compare_published(progress)
    with progress_bar("closures of the flow through pockets") as progress:
        closures = compare.closure_figures(progress)
    if output is None:
        terminal().print(as_on_page(pages.closure_table(closures)))
        terminal().print(pages.validation_table(rows, closures))
        return
    with progress_bar("pictures") as progress:
        page = pages.validation_html(rows, closures, progress)
    write_page(output, page)
    click.echo(compare.summary(rows, closures))


# The command reproduce: a chapter of the dissertation computed again.

PAGE = "index.html"


@click.command()
@click.argument("chapter", type=click.Choice(["3", "4", "5"]))
@click.option(
    "--figure",
    "chosen",
    metavar="NUMBER",
    multiple=True,
    help="Only this figure, as in 3.5; may be given again. Default: all of the chapter.",
)
@picture_option
@output_option("Folder of the results.", required=True)
@runner_options
def reproduce(
    chapter: str, chosen: tuple[str, ...], picture: str, output: Path, runner: Runner
) -> None:
    """Compute a CHAPTER of Talbot (2012) again: 3 planet bearings, 4 pockets, 5 the tests.

    Each figure N goes to fig-N.nc, fig-N.csv and a picture in the folder OUTPUT, with the numbers
    that the source prints marked on it; index.html shows all of them and compares.

    \b
    epicyclic reproduce 5 -o chapter-5
    epicyclic reproduce 3 --figure 3.4 --figure 3.5 -o bearings
    """
    from epicyclic.study.sweeps.run import write_dataset
    from epicyclic.validation.chapters import CHAPTERS, TOPICS
    from epicyclic.validation.compare import compare_published, summary
    from epicyclic.validation.pages import chapter_html
    from epicyclic.validation.plots import reproduce as figures_of

    known = CHAPTERS[chapter]
    problems = [
        Problem("--figure", name, f"is not computed: {', '.join(known)} are.", "Choose of these.")
        for name in chosen
        if name not in known
    ]
    if problems:
        raise InputError(problems, "the command")
    make_folder(output)
    found = []
    with progress_bar("points") as progress:
        for item in figures_of(chosen or known, replace(runner, progress=progress)):
            found.append(item)
            for suffix in (".nc", ".csv"):
                write_dataset(item.data, output / f"fig-{item.number}{suffix}")
            path = output / f"fig-{item.number}.{picture}"
            write_file(path, picture_bytes(item.picture, path))
            click.echo(f"Wrote {path}, .nc and .csv.")
    with progress_bar("figures") as progress:
        rows = compare_published(progress, topic=TOPICS[chapter])
    found.sort(key=lambda item: known.index(item.number))
    write_page(output / PAGE, chapter_html(chapter, found, rows))
    click.echo(summary(rows))
