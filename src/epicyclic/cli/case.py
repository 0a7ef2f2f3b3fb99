"""Commands on one case: run, check, friction, mesh, heat, warm-up."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli import common
from epicyclic.errors import EXIT_NO_SOLUTION, ConvergenceError, Status, one_problem
from epicyclic.files import check_place
from epicyclic.messages import either

if TYPE_CHECKING:
    from rich.console import RenderableType

    from epicyclic.case.case import Case
    from epicyclic.result.result import Result
    from epicyclic.study.heat import Found


@click.command()
@common.case_options
@common.json_option
@common.file_option(
    "--save", help="Keep the result with all its fields in FILE.nc, for reports and plots."
)
@click.option("--details", is_flag=True, help="Print all figures, models, warnings and sources.")
def run(
    case: str, changes: tuple[str, ...], json_file: str | None, save: Path | None, details: bool
) -> None:
    """Compute the losses of a case and print them by component."""
    from epicyclic.show.details import result_tables
    from epicyclic.show.result_tables import adjusted, remarks
    from epicyclic.show.result_tables import details as more
    from epicyclic.show.summary import first_screen
    from epicyclic.show.uncertainty_tables import band_texts, result_json
    from epicyclic.study.bands.study import quick_known
    from epicyclic.study.solve import solve

    loaded = common.load_with(case, changes)
    if save is not None:
        from epicyclic.show.record import check_result_output, record, save_result

        check_result_output(save)
    with telling_contacts(loaded):
        result = solve(loaded)
    known = quick_known(loaded, result)
    if save is not None:
        save_result(record(loaded, result=result), save)

    def tables() -> RenderableType:
        if details:
            further = (*more(loaded, result), *adjusted(loaded))
            return result_tables(result, tuple(remarks(loaded, result)), band_texts(known), further)
        return first_screen(result, known)

    common.show(tables, lambda: result_json(result, known), json_file)
    if result.status is not Status.CONVERGED:
        common.echo(result.notes[0], err=True)
        sys.exit(EXIT_NO_SOLUTION)


@contextmanager
def telling_contacts(case: Case) -> Iterator[None]:
    """A progress bar: of the contacts of each mesh if they are solved, which takes minutes."""
    if case.models.friction == "ehl-direct":
        from epicyclic.losses.friction import contact_progress

        with common.progress_bar("contacts of the mesh") as progress, contact_progress(progress):
            yield
    else:
        with common.working():  # pockets may take minutes too
            yield


@click.command()
@common.case_options
def check(case: str, changes: tuple[str, ...]) -> None:
    """Check a case and show what follows from it, as a data sheet, without computing losses.

    For a train it also shows the ratio of every state; with [strength], the safety factors, which
    are computed.
    """
    from epicyclic.show.data_sheet import data_sheet, reservations, state_tables
    from epicyclic.show.result_tables import details
    from epicyclic.show.terminal import Sentence, as_on_page, spaced

    loaded = common.load_with(case, changes)
    found = list(reservations(loaded))
    kind = loaded.kind.replace("_", " ")
    points = "1 point" if len(found) == 1 else f"{len(found)} points"
    common.echo(f"{case}: a valid {kind} case{f'; {points} to check:' if found else '.'}")
    common.print_tables(*map(Sentence, found), end="")
    if loaded.lubrication is not None:
        from epicyclic.build.models import set_cases
        from epicyclic.build.result import oil_supplies

        for name, supply in oil_supplies(set_cases(loaded)):
            common.print_tables(f"Lubrication{f' of {name}' if name else ''}: {supply.text}.")
    states = [state_tables(loaded)] if loaded.kind == "train" else []
    common.print_tables(spaced(data_sheet(loaded), *states, *map(as_on_page, details(loaded))))


@click.command()
@common.case_options
@common.plot_option("Draw the sliding loss with every model to FILE (.png, .svg, .pdf).")
def friction(case: str, changes: tuple[str, ...], plot: Path | None) -> None:
    """Compare all friction models on a case, with their ranges and a recommendation."""
    from epicyclic.show.details import friction_table
    from epicyclic.study.friction import compare_friction

    loaded = common.load_with(case, changes)
    if common.tell_given(loaded, "compare") and plot is None:
        return
    with telling_contacts(loaded):
        rows = compare_friction(loaded)
    common.print_tables(friction_table(rows))
    if plot is not None:
        from epicyclic.show.plots.mesh import friction_figure

        common.draw(friction_figure(rows, loaded.title), plot, common.point_of(loaded))


@click.command()
@common.case_options
@common.plot_option("Draw each mesh to FILE-MESH.png, .svg or .pdf.")
def mesh(case: str, changes: tuple[str, ...], plot: Path | None) -> None:
    """Show the tooth contact: load, transmission error, stiffness, pressure, friction power."""
    from epicyclic.show.studies import mesh_tables
    from epicyclic.study.meshes import mesh_details

    loaded = common.load_with(case, changes)
    meshes = mesh_details(loaded)
    common.print_tables(mesh_tables(meshes))
    if plot is not None:
        from epicyclic.show.plots.mesh import mesh_figure

        for key, details in meshes.items():
            common.draw(mesh_figure(details), common.beside(plot, key), common.point_of(loaded))


AS_GIVEN = "oil_temperature"
QUANTITIES = (AS_GIVEN, "cooler_power", "oil_flow", "input_power")


@click.command()
@common.case_options
@click.option(
    "--solve",
    "quantity",
    type=click.Choice(QUANTITIES),
    default=AS_GIVEN,
    show_default=True,
    help="What to solve for: the oil temperature, or the quantity that gives the --target "
    "temperature.",
)
@click.option(
    "--target", metavar="TEMPERATURE", help='Oil temperature in the gearbox, as in "90 degC".'
)
@common.json_option
@common.plot_option("Draw parts, temperatures and heat flows (.png, .svg, .pdf).")
def heat(
    case: str,
    changes: tuple[str, ...],
    quantity: str,
    target: str | None,
    json_file: str | None,
    plot: Path | None,
) -> None:
    """Show the temperatures of all parts and the heat paths.

    Uses the heat network, whatever models.temperatures is. The heat needs a path out:
    thermal.oil_flow, [thermal.housing] or thermal.cooler_conductance.

    \b
    epicyclic heat talbot-2012 --set "thermal.oil_flow=4 l/min"
    epicyclic heat talbot-2012 --solve oil_flow --target "100 degC"
    """
    from epicyclic.study.heat import solve_for, with_network
    from epicyclic.study.solve import solve

    if quantity != AS_GIVEN and target is None:
        allowed = f"is needed with --solve {quantity}."
        raise one_problem("--target", "", allowed, 'For example "90 degC".', "the command")
    if quantity == AS_GIVEN and target is not None:
        given, remedy = f'"{target}"', f"Add --solve {either(QUANTITIES[1:])}."
        allowed = "needs a quantity to solve for."
        raise one_problem("--target", given, allowed, remedy, "the command")
    stated = common.load_with(case, changes)
    found = None
    if target is not None:
        with common.progress_bar("settled states") as progress:
            found = solve_for(stated, quantity, target, progress=progress)
    solved = with_network(stated) if found is None else found.case
    result = solve(solved) if found is None else found.result
    if stated.models.temperatures != "network":
        common.echo(
            f"Computed with models.temperatures = network instead of {stated.models.temperatures}.",
            err=True,
        )

    def as_json() -> str:
        contents = result.to_dict() | ({} if found is None else {"found": found.to_dict()})
        return json.dumps(contents, indent=2, allow_nan=False, ensure_ascii=False)

    common.show(lambda: _tables(solved, result, found), as_json, json_file)
    if plot is not None:
        from epicyclic.show.plots.catalogue import figure_of
        from epicyclic.show.record import record

        common.draw(figure_of(record(solved, result=result, groups=()), "heat-network"), plot)


def _tables(case: Case, result: Result, found: Found | None) -> RenderableType:
    from epicyclic.show.result_tables import found_text, heat_items, heat_path_items, remarks
    from epicyclic.show.summary import first_lists
    from epicyclic.show.terminal import as_on_page, titled

    assert result.heat is not None
    items = *heat_items(result.heat), *heat_path_items(result.heat), *first_lists(result, None)
    return titled(
        result.title or result.kind,
        *([] if found is None else [found_text(found)]),
        *map(as_on_page, items),
        *remarks(case, result),
    )


@click.command("warm-up")
@common.case_options
@click.option("--for", "duration", metavar="TIME", required=True, help='Duration, as in "2 h".')
@click.option(
    "--from",
    "start",
    metavar="TEMPERATURE",
    help='Start temperature of all parts, as in "20 degC"; default: thermal.ambient_temperature.',
)
@click.option(
    "--cycle",
    metavar="CYCLE",
    help="A .csv or .parquet file as for 'epicyclic duty', which is repeated; default: the "
    "operating point.",
)
@common.output_option("Write .nc, .csv or .parquet.", "FILE")
@common.plot_option("Draw temperatures and loss over time to a .png, .svg or .pdf file.")
def warm_up(
    case: str,
    changes: tuple[str, ...],
    duration: str,
    start: str | None,
    cycle: str | None,
    output: Path | None,
    plot: Path | None,
) -> None:
    """Compute the warm-up of a gearbox: temperatures and losses over time.

    Temperatures follow from the heat network, which needs thermal.oil_volume and, with a housing,
    thermal.housing.mass.
    """
    from epicyclic.cli.many import warn_at
    from epicyclic.show.studies import warm_up_rows, warm_up_tables
    from epicyclic.study.maps.warm_up import warm_up as compute
    from epicyclic.study.sweeps.run import FORMATS, write_dataset

    if output is not None:
        common.check_ending("-o", output, FORMATS)
    check_place(output, plot)
    loaded = common.load_with(case, changes)
    with common.progress_bar("warming up") as progress:
        data = compute(loaded, duration, start, cycle=cycle, progress=progress)
    if output is not None:
        write_dataset(data, output, warm_up_rows)
    common.print_tables(warm_up_tables(data))
    if cycle is None:
        begin = f"{float(data['temperature'].sel(node='oil')[0])!r} degC"
        cold = {"models.temperatures": "inlet", "operation.oil_inlet_temperature": begin}
        with suppress(ConvergenceError):
            warn_at(loaded.updated(cold), "at the start")
            warn_at(loaded.updated({"models.temperatures": "network"}), "in the settled state")
    if plot is not None:
        from epicyclic.show.plots.heat_network import warm_up_figure

        common.draw(
            warm_up_figure(data), plot, f"cycle {cycle}" if cycle else common.point_of(loaded)
        )
