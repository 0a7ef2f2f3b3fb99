"""Commands on the pockets of meshes: pockets."""

from __future__ import annotations

from pathlib import Path

import click

from epicyclic.cli.options import case_argument, load_with, set_option
from epicyclic.cli.output import check_picture, draw, write_file

__all__ = ["pockets"]

ANIMATION = ".gif"


@click.command()
@case_argument
@set_option
@click.option(
    "--plot",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Draw each mesh to FILE-MESH.png, .svg or .pdf, and its section to FILE-MESH-section.",
)
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
        check_picture("--plot", plot)
    if animate is not None:
        check_picture("--animate", animate, (ANIMATION,))
    meshes = pocket_details(load_with(case, changes))
    terminal().print(pocket_tables(meshes))
    for key, mesh in meshes.items():
        if plot is not None:
            from epicyclic.plots.pocket_section import section_figure
            from epicyclic.plots.pockets import pocket_figure

            draw(pocket_figure(mesh), _named(plot, key))
            draw(section_figure(mesh), _named(plot, f"{key}-section"))
        if animate is not None:
            from epicyclic.cli.progress import progress_bar
            from epicyclic.plots.pocket_animation import pocket_animation

            with progress_bar("frames") as progress:
                moving = pocket_animation(mesh, progress)
            path = _named(animate, key)
            write_file(path, moving)
            click.echo(f"Wrote {path}.")


def _named(path: Path, part: str) -> Path:
    """The file beside `path` for one part of what is drawn."""
    return path.with_name(f"{path.stem}-{part}{path.suffix}")
