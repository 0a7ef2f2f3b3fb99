"""The command heat: temperatures of all parts, and what leads to one of the oil."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.options import (
    case_argument,
    json_option,
    load_with,
    plot_option,
    point_of,
    set_option,
)
from epicyclic.cli.output import draw, show
from epicyclic.errors import InputError, Problem

if TYPE_CHECKING:
    from rich.console import RenderableType

    from epicyclic.analysis.heat import Found
    from epicyclic.case.case import Case
    from epicyclic.results.result import Result

AS_GIVEN = "oil_temperature"
QUANTITIES = (AS_GIVEN, "cooler_power", "oil_flow", "input_power")


@click.command()
@case_argument
@set_option
@click.option(
    "--solve",
    "quantity",
    type=click.Choice(QUANTITIES),
    default=AS_GIVEN,
    show_default=True,
    help="What to find: the temperature of the oil, or what leads to that of --target.",
)
@click.option("--target", metavar="TEMPERATURE", help='Of the oil in the gearbox, as in "90 degC".')
@json_option
@plot_option("Draw parts, temperatures and flows of heat (.png, .svg, .pdf).")
def heat(
    case: str,
    changes: tuple[str, ...],
    quantity: str,
    target: str | None,
    json_file: str | None,
    plot: Path | None,
) -> None:
    """Show how hot all parts get, and where their heat goes.

    Uses the network of all parts whatever models.temperatures is. The heat needs a way out:
    thermal.oil_flow, [thermal.housing] or thermal.cooler_conductance.

    \b
    epicyclic heat talbot-2012 --set "thermal.oil_flow=4 l/min"
    epicyclic heat talbot-2012 --solve oil_flow --target "100 degC"
    """
    from epicyclic.analysis.heat import solve_for, with_network
    from epicyclic.analysis.solve import solve
    from epicyclic.cli.progress import progress_bar

    _check_target(quantity, target)
    stated = load_with(case, changes)
    found = None
    if target is not None:
        with progress_bar("settled states") as progress:
            found = solve_for(stated, quantity, target, progress=progress)
    solved = with_network(stated) if found is None else found.case
    result = solve(solved) if found is None else found.result
    if stated.models.temperatures != "network":
        click.echo(
            f"With models.temperatures = network in place of {stated.models.temperatures}.",
            err=True,
        )
    show(lambda: _tables(solved, result, found), lambda: _json(result, found), json_file)
    if plot is not None:
        from epicyclic.plots.heat_network import heat_figure

        assert result.heat is not None
        draw(heat_figure(result.heat, result.title), plot, point_of(solved))


def _check_target(quantity: str, target: str | None) -> None:
    if (quantity == AS_GIVEN) == (target is None):
        return
    if target is None:
        problem = Problem("--target", "", f"is needed with --solve {quantity}.", 'As in "90 degC".')
    else:
        remedy = f"Name what leads to it: --solve {', '.join(QUANTITIES[1:])}."
        problem = Problem("--target", f'"{target}"', "is what would be solved for.", remedy)
    raise InputError([problem], "the command")


def _tables(case: Case, result: Result, found: Found | None) -> RenderableType:
    from epicyclic.report.heat_tables import found_text, heat_items, remarks, ways_items
    from epicyclic.report.tables import as_on_page, titled

    assert result.heat is not None
    return titled(
        result.title or result.kind,
        *([] if found is None else [found_text(found)]),
        *(as_on_page(item) for item in heat_items(result.heat)),
        *(as_on_page(item) for item in ways_items(result.heat)),
        *remarks(case, result),
    )


def _json(result: Result, found: Found | None) -> str:
    contents = result.to_dict()
    if found is not None:
        contents["found"] = found.to_dict()
    return json.dumps(contents, indent=2, allow_nan=False, ensure_ascii=False)
