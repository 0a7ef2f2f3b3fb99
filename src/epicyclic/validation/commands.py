"""The commands validate, reproduce and study."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.common import (
    case_options,
    check_page,
    draw,
    echo,
    json_option,
    load_with,
    output_option,
    picture_option,
    plot_option,
    print_tables,
    progress_bar,
    runner_options,
    shard_option,
    show,
    write_page,
)
from epicyclic.cli.many import Write, compute
from epicyclic.errors import Problem, raise_any
from epicyclic.files import make_folder, write_file

if TYPE_CHECKING:
    from epicyclic.study.sweeps.runner import Rows, Runner
    from epicyclic.validation.pocketing import StudyPlan


@click.command()
@click.option(
    "--temperatures",
    is_flag=True,
    help="Only the loaded tests, with temperatures computed from the losses (minutes).",
)
@click.option(
    "--bands",
    is_flag=True,
    help="Only the measured figures, with the 95 % bands of the computed ones (a minute).",
)
@click.option(
    "--measured",
    metavar="[PATH]",
    is_flag=False,
    flag_value="",
    help="Losses that others measured, with mean error, bias, trends and bands: half a minute. "
    "PATH: a file of measurements, or a folder of them, in place of those of the package.",
)
@click.option(
    "--models",
    is_flag=True,
    help="With --measured: also with temperatures and with each other model: minutes.",
)
@json_option
@plot_option("With --measured: draw computed against measured values, and errors over speed.")
@output_option("Write a page with pictures and tables instead of the table: .html or .pdf.", "FILE")
def validate(
    temperatures: bool,
    bands: bool,
    measured: str | None,
    models: bool,
    json_file: str | None,
    plot: Path | None,
    output: Path | None,
) -> None:
    """Compare with published figures: published, computed, difference, verdict.

    \b
    epicyclic validate                       published figures
    epicyclic validate --measured            losses that others measured
    epicyclic validate reproduce CHAPTER     a chapter of the dissertation, computed again
    """
    # computing and drawing are loaded by those who ask for them: the command line starts quickly
    from epicyclic.show.terminal import as_on_page
    from epicyclic.study.sweeps.runner import Runner
    from epicyclic.validation import compare, pages

    options = {"--temperatures": temperatures, "--bands": bands, "--measured": measured is not None}
    chosen = [name for name, is_on in options.items() if is_on]
    others = [*chosen[1:], *(["-o"] if output is not None else [])]
    parts = {"--models": models, "--json": json_file is not None, "--plot": plot is not None}
    alone = [name for name, is_on in parts.items() if is_on and measured is None]
    remedy = "Give both, or leave it out."
    raise_any((Problem(it, "", "goes with --measured.", remedy) for it in alone), "the command")
    if chosen:
        told = f"conflicts with {chosen[0]}."
        raise_any((Problem(it, "", told, "Remove one of them.") for it in others), "the command")
    if measured is not None:
        scores(measured, plot, json_file, models=models)
        return
    if chosen:
        with progress_bar("tests") as progress:
            runner = Runner(progress=progress)
            if temperatures:
                settled = compare.settled_figures(runner)
                shown = pages.settled_table(settled, compare.estimates())
            else:
                shown = pages.bands_table(compare.measured_figures(runner))
        print_tables(shown)
        return
    if output is not None:
        check_page(output)
    with progress_bar("figures") as progress:
        rows = compare.compare_published(progress)
    with progress_bar("closures of the flow through pockets") as progress:
        closures = compare.closure_figures(progress)
    if output is None:
        print_tables(as_on_page(pages.closure_table(closures)))
        print_tables(pages.validation_table(rows, closures))
        return
    with progress_bar("pictures") as progress:
        page = pages.validation_html(rows, closures, progress)
    write_page(output, page)
    echo(compare.summary(rows, closures))


def scores(path: str, plot: Path | None, json_file: str | None, *, models: bool) -> None:
    """Measured sets, those of the package if `path` is empty, beside what is computed for them."""
    from epicyclic.study.sweeps.runner import HERE
    from epicyclic.validation import pages, plots, scoreboard

    sets = scoreboard.read_sets(Path(path) if path else None)
    with progress_bar("sets") as progress:
        found = scoreboard.scoreboard(sets, HERE, others=models, progress=progress)
    show(lambda: pages.scores_table(found), lambda: scoreboard.to_json(found), json_file)
    if plot is not None:
        draw(plots.scores_figure(found), plot)


PAGE = "index.html"


@click.command()
@click.argument("chapter", type=click.Choice(["2", "3", "4", "5"]))
@click.option(
    "--figure",
    "chosen",
    metavar="NUMBER",
    multiple=True,
    help="Only this figure, as in 3.5; repeatable. Default: all of the chapter.",
)
@picture_option
@output_option("Folder for the results.", required=True)
@runner_options
def reproduce(
    chapter: str, chosen: tuple[str, ...], picture: str, output: Path, runner: Runner
) -> None:
    """Compute a CHAPTER of Talbot (2012) again: 2 the tests as measured, 3 planet bearings, 4
    pockets, 5 the tests as predicted.

    Each figure N goes to fig-N.nc, fig-N.csv and a picture in the folder OUTPUT, with the numbers
    that the source prints marked on it; index.html shows all of them and compares.

    \b
    epicyclic reproduce 5 -o chapter-5
    epicyclic reproduce 3 --figure 3.4 --figure 3.5 -o bearings
    """
    from epicyclic.show.plots.style import figure_bytes
    from epicyclic.show.terminal import as_on_page
    from epicyclic.study.sweeps.run import write_dataset
    from epicyclic.validation.chapters import CHAPTERS, TOPICS
    from epicyclic.validation.compare import compare_published, summary
    from epicyclic.validation.pages import chapter_html, influence_table
    from epicyclic.validation.plots import reproduce as figures_of

    known = CHAPTERS[chapter]
    told = f"is not available; the figures are {', '.join(known)}."
    problems = [
        Problem("--figure", name, told, "Choose one of these.")
        for name in chosen
        if name not in known
    ]
    raise_any(problems, "the command")
    make_folder(output)
    found = []
    with progress_bar("points") as progress:
        for item in figures_of(chosen or known, replace(runner, progress=progress)):
            found.append(item)
            for suffix in (".nc", ".csv"):
                write_dataset(item.data, output / f"fig-{item.number}{suffix}")
            path = output / f"fig-{item.number}.{picture}"
            write_file(path, figure_bytes(item.picture, picture))
            echo(f"Wrote {path}, .nc and .csv.")
    with progress_bar("figures") as progress:
        rows = compare_published(progress, *TOPICS[chapter])
    found.sort(key=lambda item: known.index(item.number))
    write_page(output / PAGE, chapter_html(chapter, found, rows))
    if (table := influence_table(found)).rows:
        print_tables(as_on_page(table))
    echo(summary(rows))


STUDY = "study"  # With which files of unfinished studies begin in their folder.


@click.command()
@case_options
@click.option(
    "--what",
    metavar="NAMES",
    help="Of speed, helix-angle, face-width, oil-fraction, backlash, module, separated by commas; "
    "default: all.",
)
@click.option(
    "--range",
    "ranges",
    metavar="NAME=VALUES",
    multiple=True,
    help='Values of a study, as in "helix-angle=0:30:7 deg".',
)
@click.option(
    "--level",
    "levels",
    metavar="NAME=VALUES",
    multiple=True,
    help='Values for the curves and panels of the other studies, as in "speed=2000,4000 rpm".',
)
@click.option("--mesh", metavar="MESH", help="sun_mesh (default) or ring_mesh of a planetary set.")
@picture_option
@output_option("Folder for the results.", required=True)
@shard_option
@runner_options
def study(
    case: str,
    changes: tuple[str, ...],
    what: str | None,
    ranges: tuple[str, ...],
    levels: tuple[str, ...],
    mesh: str | None,
    picture: str,
    output: Path,
    runner: Runner,
) -> None:
    """Study the pocketing loss of a mesh over its main parameters, and draw the figures.

    Each study NAME goes to NAME.nc, NAME.csv and a picture in the folder OUTPUT. An interrupted
    study continues where it stopped, as a sweep does.
    """
    from epicyclic.study.sweeps.run import parse_vary
    from epicyclic.validation.pocketing import STUDIES, make_study

    loaded = load_with(case, changes)
    plan = make_study(
        loaded,
        STUDIES if what is None else [name.strip() for name in what.split(",") if name.strip()],
        mesh=mesh,
        ranges=parse_vary(loaded, ranges, "--range", "speed"),
        levels=parse_vary(loaded, levels, "--level", "speed"),
    )
    write = study_writer(plan, output, picture)
    compute(plan, output / STUDY, runner, write, picture=picture)


def study_writer(plan: StudyPlan, folder: Path, picture: str) -> Write:
    """Writes tables and figures to a folder; raises `InputError` if there can be none."""
    from epicyclic.show.plots.style import figure_bytes
    from epicyclic.study.sweeps.run import write_dataset
    from epicyclic.validation.plots import study_figure
    from epicyclic.validation.pocketing import published_study, study_datasets

    make_folder(folder)

    def write(rows: Rows) -> str:
        written = []
        published = published_study(plan.case)
        for name, dataset in study_datasets(plan, rows).items():
            for suffix in (".nc", ".csv"):
                written.append(folder / f"{name}{suffix}")
                write_dataset(dataset, written[-1])
            written.append(folder / f"{name}.{picture}")
            write_file(written[-1], figure_bytes(study_figure(dataset, published), picture))
        return "\n".join(f"Wrote {path}." for path in written)

    return write
