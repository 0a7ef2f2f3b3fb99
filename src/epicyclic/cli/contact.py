"""The command contact: one lubricated line contact."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import click

from epicyclic.cli.exit_codes import EXIT_NO_SOLUTION
from epicyclic.cli.options import contact_set_option, json_option, parse_changes, plot_option
from epicyclic.cli.output import PICTURES, picture_bytes, show
from epicyclic.status import Status
from epicyclic.whole_file import write_file

ANIMATION = ".gif"

CONTACT_OPTIONS = {
    "radius": ("contact.radius", "Equivalent radius, as in '10 mm'."),
    "load": ("contact.line_load", "Load per length, as in '500 N/mm'."),
    "pressure": ("contact.hertz_pressure", "Instead of the load: Hertz pressure, as in '1 GPa'."),
    "speed": ("contact.rolling_speed", "Mean surface speed, as in '10 m/s'."),
    "slip": ("contact.slide_to_roll_ratio", "Slide-to-roll ratio, 0 to 2."),
    "oil": ("lubricant.oil", "A name of 'epicyclic oils'."),
    "temperature": ("lubricant.temperature", "Of the oil at the inlet, as in '90 degC'."),
    "roughness1": ("surface1.roughness", "Rq, as in '0.4 um', or the name of a finish."),
    "roughness2": ("surface2.roughness", "Of the other surface."),
    "preset": ("preset", "Assumptions: usual, as-published."),
}


def contact_options(command: Any) -> Any:
    """An option for each of `CONTACT_OPTIONS`."""
    for name, (_, text) in reversed(CONTACT_OPTIONS.items()):
        command = click.option(f"--{name}", metavar="VALUE", help=text)(command)
    return command


@click.command()
@click.argument("file", type=click.Path(path_type=Path), required=False)
@contact_options
@contact_set_option
@json_option
@plot_option(
    "Draw pressure, film, shear stress (.png, .svg, .pdf); a rough contact moves in a .gif.",
    (*PICTURES, ANIMATION),
)
def contact(
    file: Path | None,
    changes: tuple[str, ...],
    json_file: str | None,
    plot: Path | None,
    **options: str | None,
) -> None:
    """Solve one lubricated line contact, given by FILE or by options.

    \b
    epicyclic contact --radius "10 mm" --pressure "1 GPa" --speed "10 m/s" --slip 0.2 \\
        --oil atf-talbot-2012 --temperature "90 degC" --roughness1 "0.1 um"

    FILE is TOML with the tables [contact], [lubricant], [surface1], [surface2], [asperities],
    [heating] and [numerics]; options and --set change its keys. A solution that did not converge
    ends with exit code 3.
    """
    from epicyclic.analysis.contact import solve_contact
    from epicyclic.case.contact import load_contact_case
    from epicyclic.case.values import parse_value
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.contact_table import contact_tables

    given = {
        CONTACT_OPTIONS[name][0]: parse_value(text)
        for name, text in options.items()
        if text is not None
    }
    case = load_contact_case(file or {}, given | parse_changes(changes))
    moments = plot is not None or json_file is not None
    with progress_bar("percent") as percent:  # of a number that changes
        result = solve_contact(case, moments, lambda done, all_: percent(100 * done // all_, 100))
    show(lambda: contact_tables(result), result.to_json, json_file)
    if plot is not None and result.smooth.status is Status.CONVERGED:
        from epicyclic.plots.contact import contact_animation, contact_figure

        if plot.suffix == ANIMATION and result.rough is not None:
            write_file(plot, contact_animation(result))
        else:
            write_file(plot, picture_bytes(contact_figure(result), plot))
        click.echo(f"Wrote {plot}.", err=json_file == "-")
    if result.status is not Status.CONVERGED:
        sys.exit(EXIT_NO_SOLUTION)
