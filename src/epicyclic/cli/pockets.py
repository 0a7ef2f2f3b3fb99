"""Commands on the pockets of meshes: pockets, pockets-table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli import common
from epicyclic.cli.many import Write, check_values, compute, parse_axes
from epicyclic.files import check_place, write_file
from epicyclic.units import percent

if TYPE_CHECKING:
    from epicyclic.study.pocketing_table import TablePlan
    from epicyclic.study.sweeps.runner import Rows, Runner


@click.command()
@common.case_options
@common.plot_option(
    "Draw each mesh to FILE-MESH.png, .svg or .pdf, and its section to FILE-MESH-section."
)
@common.file_option(
    "--animate",
    endings=(".gif",),
    help="Animate each mesh in FILE-MESH.gif, with the pressure as colour.",
)
def pockets(case: str, changes: tuple[str, ...], plot: Path | None, animate: Path | None) -> None:
    """Show the pockets between the teeth: shape, pressure, speed of the flow, power.

    \b
    epicyclic pockets CASE          one state in detail
    epicyclic pockets table CASE    pocketing loss over speed and temperature, to a file
    epicyclic pockets study CASE    pocketing loss over helix, width, backlash and module
    """
    from epicyclic.show.studies import pocket_tables
    from epicyclic.study.pockets import pocket_details

    loaded = common.load_with(case, changes)
    with common.working():
        meshes = pocket_details(loaded)
    common.print_tables(pocket_tables(meshes))
    for key, mesh in meshes.items():
        if plot is not None:
            from epicyclic.show.plots.pockets import pocket_figure, section_figure

            common.draw(pocket_figure(mesh), common.beside(plot, key), common.point_of(loaded))
            common.draw(
                section_figure(mesh), common.beside(plot, f"{key}-section"), common.point_of(loaded)
            )
        if animate is not None:
            from epicyclic.show.plots.pockets import pocket_animation

            with common.progress_bar("frames") as progress:
                moving = pocket_animation(mesh, progress)
            path = common.beside(animate, key)
            write_file(path, moving)
            common.echo(f"Wrote {path}.")


FORMATS = (".nc", ".csv")


@click.command("pockets-table")
@common.case_options
@click.option(
    "--speed",
    metavar="VALUES",
    required=True,
    help='Speed of the input member, as in "500:5000:10 rpm".',
)
@common.temperature_option
@common.output_option(".nc for use in a case, or .csv", required=True, endings=FORMATS)
@common.shard_option
@common.runner_options
def pockets_table(
    case: str, changes: tuple[str, ...], output: Path, runner: Runner, **values: str | None
) -> None:
    """Tabulate the pocketing loss of each mesh over speed and oil temperature.

    VALUES are a,b,c or start:stop:count with a unit. A case whose models.pocketing_table names the
    .nc file reads its pocketing losses from there.
    """
    from epicyclic.study.pocketing_table import make_table_plan

    loaded = common.load_with(case, changes)
    check_values(values)
    given = parse_axes(loaded, values)
    plan = make_table_plan(loaded, given["speed"], given.get("temperature"))
    compute(plan, output, runner, table_writer(plan, output), "tables")


def table_writer(plan: TablePlan, output: Path) -> Write:
    """Writes tables; raises `InputError` if it cannot."""
    from epicyclic.study.pocketing_table import table_dataset
    from epicyclic.study.sweeps.run import write_dataset

    common.check_ending("-o", output, FORMATS)
    check_place(output)

    def write(rows: Rows) -> str:
        table = table_dataset(plan, rows)
        write_dataset(table, output)
        worst = float(table["interpolation_error"].max())
        return f"Wrote {output}, interpolated within {percent(worst, 2)} of the loss."

    return write
