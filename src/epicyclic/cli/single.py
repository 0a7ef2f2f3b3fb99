"""Commands on one case: run, check, friction, mesh."""

from __future__ import annotations

from pathlib import Path

import click

from epicyclic.cli.options import case_argument, load_with, set_option
from epicyclic.cli.output import check_picture, draw, write_file

__all__ = ["check", "friction", "mesh", "run"]


@click.command()
@case_argument
@set_option
@click.option(
    "--json",
    "json_file",
    metavar="[FILE]",
    is_flag=False,
    flag_value="-",
    help="Write the result as JSON, to standard output if no FILE or - is given.",
)
@click.option(
    "--save",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Keep the result with all its fields in FILE.nc, for reports and plots.",
)
def run(case: str, changes: tuple[str, ...], json_file: str | None, save: Path | None) -> None:
    """Compute the losses of a case and print them by component."""
    from epicyclic.analysis.solve import solve

    loaded = load_with(case, changes)
    if save is not None:
        from epicyclic.records.files import check_result_output, save_result

        check_result_output(save)
        save_result(loaded, save)
    result = solve(loaded)
    if json_file == "-":
        click.echo(result.to_json())
        return
    from epicyclic.report.tables import result_tables, terminal

    if json_file is not None:
        write_file(Path(json_file), result.to_json() + "\n")
    terminal().print(result_tables(result))


@click.command()
@case_argument
@set_option
def check(case: str, changes: tuple[str, ...]) -> None:
    """Check a case without computing anything."""
    loaded = load_with(case, changes)
    click.echo(f"{case}: a sound {loaded.kind} case.")


@click.command()
@case_argument
@set_option
def friction(case: str, changes: tuple[str, ...]) -> None:
    """Compare all friction models on a case, with the spread."""
    from epicyclic.analysis.compare import compare_friction
    from epicyclic.report.tables import friction_table, terminal

    terminal().print(friction_table(compare_friction(load_with(case, changes))))


@click.command()
@case_argument
@set_option
@click.option(
    "--plot",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Draw each mesh to FILE-MESH.png, .svg or .pdf.",
)
def mesh(case: str, changes: tuple[str, ...], plot: Path | None) -> None:
    """Show how the teeth carry: load, transmission error, stiffness, pressure, friction power."""
    from epicyclic.analysis.mesh_details import mesh_details
    from epicyclic.report.mesh_table import mesh_tables
    from epicyclic.report.tables import terminal

    if plot is not None:
        check_picture("--plot", plot)
    meshes = mesh_details(load_with(case, changes))
    terminal().print(mesh_tables(meshes))
    if plot is not None:
        from epicyclic.plots.mesh import mesh_figure

        for key, details in meshes.items():
            draw(mesh_figure(details), plot.with_name(f"{plot.stem}-{key}{plot.suffix}"))
