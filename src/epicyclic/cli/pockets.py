"""Commands on the pockets of meshes: pockets, study."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.exit_codes import EXIT_FAILED_POINTS
from epicyclic.cli.many import kept_in, open_journal, print_failures
from epicyclic.cli.options import case_argument, jobs_option, load_with, plot_option, set_option
from epicyclic.cli.output import PICTURES, beside, check_ending, draw, finishing, write_file
from epicyclic.errors import InputError, Problem
from epicyclic.status import Status

if TYPE_CHECKING:
    import xarray as xr

    from epicyclic.case.case import Case

__all__ = ["pockets", "study"]

ANIMATION = ".gif"


@click.command()
@case_argument
@set_option
@plot_option("Draw each mesh to FILE-MESH.png, .svg or .pdf, and its section to FILE-MESH-section.")
@click.option(
    "--animate",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Draw each mesh in motion to FILE-MESH.gif, pressure as colour.",
)
def pockets(case: str, changes: tuple[str, ...], plot: Path | None, animate: Path | None) -> None:
    """Show the pockets between the teeth: shape, pressure, speed of the flow, power."""
    from epicyclic.analysis.pocket_details import pocket_details
    from epicyclic.report.pocket_table import pocket_tables
    from epicyclic.report.tables import terminal

    if plot is not None:
        check_ending("--plot", plot)
    if animate is not None:
        check_ending("--animate", animate, (ANIMATION,))
    meshes = pocket_details(load_with(case, changes))
    terminal().print(pocket_tables(meshes))
    for key, mesh in meshes.items():
        if plot is not None:
            from epicyclic.plots.pocket_section import section_figure
            from epicyclic.plots.pockets import pocket_figure

            draw(pocket_figure(mesh), beside(plot, key))
            draw(section_figure(mesh), beside(plot, f"{key}-section"))
        if animate is not None:
            from epicyclic.cli.progress import progress_bar
            from epicyclic.plots.pocket_animation import pocket_animation

            with progress_bar("frames") as progress:
                moving = pocket_animation(mesh, progress)
            path = beside(animate, key)
            write_file(path, moving)
            click.echo(f"Wrote {path}.")


@click.command()
@case_argument
@set_option
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
    help='What a study goes over, as in "helix-angle=0:30:7 deg".',
)
@click.option(
    "--level",
    "levels",
    metavar="NAME=VALUES",
    multiple=True,
    help='Curves and panels of the other studies, as in "speed=2000,4000 rpm".',
)
@click.option("--mesh", metavar="MESH", help="sun_mesh (default) or ring_mesh of a planetary set.")
@click.option("--picture", type=click.Choice([kind[1:] for kind in PICTURES]), default="png")
@click.option(
    "-o", "--output", required=True, type=click.Path(path_type=Path), help="Folder of the results."
)
@jobs_option
def study(
    case: str,
    changes: tuple[str, ...],
    what: str | None,
    ranges: tuple[str, ...],
    levels: tuple[str, ...],
    mesh: str | None,
    picture: str,
    output: Path,
    jobs: int | None,
) -> None:
    """Study the pocketing loss of a mesh over its main parameters, and draw the figures.

    Each study NAME goes to NAME.nc, NAME.csv and a picture in the folder OUTPUT. An interrupted
    study goes on where it stopped, as a sweep does.
    """
    from epicyclic.cli.progress import progress_bar
    from epicyclic.sweeps.plan import parse_vary
    from epicyclic.sweeps.pocketing_plan import STUDIES, make_study
    from epicyclic.sweeps.pocketing_study import run_study, study_datasets

    loaded = load_with(case, changes)
    plan = make_study(
        loaded,
        STUDIES if what is None else [name.strip() for name in what.split(",") if name.strip()],
        mesh=mesh,
        ranges=parse_vary(loaded, ranges, "--range", "speed"),
        levels=parse_vary(loaded, levels, "--level", "speed"),
    )
    _make_folder(output)
    size = len(plan.points)
    journal = open_journal(plan.fingerprint(), size, output / "study")
    with kept_in(journal, size):
        with progress_bar("points") as progress:
            rows = run_study(plan, jobs=jobs, journal=journal, progress=progress)
        with finishing(f"Writing to {output}."):
            _write_study(loaded, study_datasets(plan, rows), output, f".{picture}")
            journal.remove()
    reasons = [row.message for row in rows if row.status == Status.FAILED]
    if reasons:
        print_failures(reasons)
        sys.exit(EXIT_FAILED_POINTS)


def _make_folder(path: Path) -> None:
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        allowed = f"is no place for a folder: {error.strerror}."
        problem = Problem("-o", str(path), allowed, "Name another folder.")
        raise InputError([problem], "the command") from None


def _write_study(case: Case, studies: dict[str, xr.Dataset], folder: Path, picture: str) -> None:
    from epicyclic.plots.pocketing_study import study_figure
    from epicyclic.sweeps.dataset import write_dataset
    from epicyclic.validation.pocketing import published_study

    published = published_study(case)
    for name, dataset in studies.items():
        for suffix in (".nc", ".csv"):
            write_dataset(dataset, folder / f"{name}{suffix}")
            click.echo(f"Wrote {folder / name}{suffix}.")
        draw(study_figure(dataset, published), folder / f"{name}{picture}")
