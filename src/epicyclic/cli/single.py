"""Commands on one case: run, check, friction, mesh."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.exit_codes import EXIT_NO_SOLUTION
from epicyclic.cli.options import (
    case_argument,
    json_option,
    load_with,
    plot_option,
    point_of,
    set_option,
)
from epicyclic.cli.output import beside, draw, show
from epicyclic.status import Status

if TYPE_CHECKING:
    from epicyclic.case.case import Case


@click.command()
@case_argument
@set_option
@json_option
@click.option(
    "--save",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Keep the result with all its fields in FILE.nc, for reports and plots.",
)
def run(case: str, changes: tuple[str, ...], json_file: str | None, save: Path | None) -> None:
    """Compute the losses of a case and print them by component."""
    from epicyclic.analysis.solve import solve
    from epicyclic.bands.quick import quick_known
    from epicyclic.report.advice import band_texts, result_json
    from epicyclic.report.heat_tables import remarks
    from epicyclic.report.tables import result_tables

    loaded = load_with(case, changes)
    if save is not None:
        from epicyclic.records.files import check_result_output

        check_result_output(save)
    with telling_contacts(loaded):
        result = solve(loaded)
    known = quick_known(loaded, result, brief=True)
    if save is not None:
        from epicyclic.records.files import save_result
        from epicyclic.records.record import record

        save_result(record(loaded, result=result), save)
    show(
        lambda: result_tables(result, tuple(remarks(loaded, result)), band_texts(known)),
        lambda: result_json(result, known),
        json_file,
    )
    if result.status is not Status.CONVERGED:
        click.echo(result.notes[0], err=True)
        sys.exit(EXIT_NO_SOLUTION)


@contextmanager
def telling_contacts(case: Case) -> Iterator[None]:
    """A progress bar: of the contacts of each mesh if they are solved, which takes minutes."""
    from epicyclic.cli.progress import progress_bar, working

    if case.models.friction == "ehl-direct":
        from epicyclic.losses.direct import contacts_told

        with progress_bar("contacts of the mesh") as progress, contacts_told(progress):
            yield
    elif sys.stderr.isatty():
        with working("solving"):  # pockets may take minutes too
            yield
    else:
        yield


@click.command()
@case_argument
@set_option
def check(case: str, changes: tuple[str, ...]) -> None:
    """Check a case and show what follows from it, as a data sheet, without computing losses.

    Of a train also the ratio of every state.
    """
    from epicyclic.report.data_sheet import data_sheet
    from epicyclic.report.state_tables import state_tables
    from epicyclic.report.tables import terminal

    loaded = load_with(case, changes)
    click.echo(f"{case}: a sound {loaded.kind} case.")
    if loaded.lubrication is not None:
        from epicyclic.builders.supplies import stated_supplies

        for name, supply in stated_supplies(loaded):
            click.echo(f"Lubrication{f' of {name}' if name else ''}: {supply.text}.")
    terminal().print(data_sheet(loaded))
    if loaded.kind == "train":
        terminal().print(state_tables(loaded))


@click.command()
@case_argument
@set_option
@plot_option("Draw the sliding loss with every model to FILE (.png, .svg, .pdf).")
def friction(case: str, changes: tuple[str, ...], plot: Path | None) -> None:
    """Compare all friction models on a case: spread, ranges left, and which one suits."""
    from epicyclic.analysis.compare import compare_friction
    from epicyclic.report.tables import friction_table, terminal

    loaded = load_with(case, changes)
    with telling_contacts(loaded):
        rows = compare_friction(loaded)
    terminal().print(friction_table(rows))
    if plot is not None:
        from epicyclic.plots.friction import friction_figure

        draw(friction_figure(rows, loaded.title), plot, point_of(loaded))


@click.command()
@case_argument
@set_option
@plot_option("Draw each mesh to FILE-MESH.png, .svg or .pdf.")
def mesh(case: str, changes: tuple[str, ...], plot: Path | None) -> None:
    """Show how the teeth carry: load, transmission error, stiffness, pressure, friction power."""
    from epicyclic.analysis.mesh_details import mesh_details
    from epicyclic.report.mesh_table import mesh_tables
    from epicyclic.report.tables import terminal

    loaded = load_with(case, changes)
    meshes = mesh_details(loaded)
    terminal().print(mesh_tables(meshes))
    if plot is not None:
        from epicyclic.plots.mesh import mesh_figure

        for key, details in meshes.items():
            draw(mesh_figure(details), beside(plot, key), point_of(loaded))
