"""The command reproduce: a chapter of the dissertation computed again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.options import output_option, picture_option, runner_options
from epicyclic.cli.output import picture_bytes, write_page
from epicyclic.errors import InputError, Problem
from epicyclic.whole_file import make_folder, write_file

if TYPE_CHECKING:
    from epicyclic.sweeps.runner import Runner

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
    from epicyclic.cli.progress import progress_bar
    from epicyclic.plots.reproduced import reproduce as figures_of
    from epicyclic.report.chapter_page import chapter_html
    from epicyclic.sweeps.dataset import write_dataset
    from epicyclic.validation.chapters import CHAPTERS, TOPICS
    from epicyclic.validation.compare import compare_published, summary

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
