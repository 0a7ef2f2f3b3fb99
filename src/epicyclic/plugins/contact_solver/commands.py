"""The commands contact and oil."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from epicyclic.cli.common import (
    PICTURES,
    contact_set_option,
    draw,
    echo,
    json_option,
    output_option,
    parse_changes,
    plot_option,
    print_tables,
    progress_bar,
    runner_options,
    shard_option,
    show,
)
from epicyclic.cli.many import Write, compute
from epicyclic.errors import EXIT_NO_SOLUTION, Status
from epicyclic.files import write_file

if TYPE_CHECKING:
    from epicyclic.plugins.contact_solver.campaign import Campaign, CampaignFolder
    from epicyclic.study.sweeps.runner import Rows, Runner


ANIMATION = ".gif"

CONTACT_OPTIONS = {
    "radius": ("contact.radius", "Equivalent radius, as in '10 mm'."),
    "load": ("contact.line_load", "Load per length, as in '500 N/mm'."),
    "pressure": ("contact.hertz_pressure", "Hertz pressure instead of the load, as in '1 GPa'."),
    "speed": ("contact.rolling_speed", "Mean surface speed, as in '10 m/s'."),
    "slip": ("contact.slide_to_roll_ratio", "Slide-to-roll ratio, 0 to 2."),
    "oil": ("lubricant.oil", "A name from 'epicyclic oils'."),
    "temperature": ("lubricant.temperature", "Oil inlet temperature, as in '90 degC'."),
    "roughness1": ("surface1.roughness", "Rq, as in '0.4 um', or the name of a finish."),
    "roughness2": ("surface2.roughness", "Roughness of the other surface."),
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
    "Draw pressure, film and shear stress (.png, .svg, .pdf), or animate a rough contact (.gif).",
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
    from epicyclic.plugins.contact_solver.contact import load_contact_case, solve_contact
    from epicyclic.plugins.contact_solver.show import (
        contact_animation,
        contact_figure,
        contact_tables,
    )
    from epicyclic.schema.read import parse_value
    from epicyclic.show.plots.style import figure_bytes

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
        if plot.suffix == ANIMATION and result.rough is not None:
            write_file(plot, contact_animation(result))
        else:
            write_file(plot, figure_bytes(contact_figure(result), plot.suffix[1:]))
        echo(f"Wrote {plot}.", err=json_file == "-")
    if result.status is not Status.CONVERGED:
        sys.exit(EXIT_NO_SOLUTION)


plot_models = plot_option("Draw the models against the simulations (.png, .svg, .pdf).")


@click.group()
def oil() -> None:
    """Characterise an oil by simulated contacts, and fit friction and rolling loss to them."""


@oil.command(short_help="Simulate contacts of an OIL and fit models.")
@click.argument("source", metavar="OIL")
@output_option("Folder for simulations and models.", "DIR", required=True)
@click.option(
    "--size",
    type=click.IntRange(1),
    help="Gear contacts in a space-filling design; default: the 33,600 of Talbot (2012).",
)
@click.option(
    "--bearing-size",
    type=click.IntRange(0),
    help="Bearing contacts likewise; default: his 2,880, or none with --size.",
)
@click.option("--seed", type=click.IntRange(0), default=0, help="Seed of points and profiles.")
@click.option(
    "--range",
    "ranges",
    metavar="NAME=LOW:HIGH",
    multiple=True,
    help='Limits of the gear contacts, as in "hertz_pressure=0.3:1.5 GPa"; with --size.',
)
@contact_set_option
@shard_option
@runner_options
@plot_models
def characterise(
    source: str,
    output: Path,
    size: int | None,
    bearing_size: int | None,
    seed: int,
    ranges: tuple[str, ...],
    changes: tuple[str, ...],
    runner: Runner,
    plot: Path | None,
) -> None:
    """Simulate contacts of OIL, a name of 'epicyclic oils' or a TOML file, and fit models.

    Finished simulations are kept in DIR at once; the same command continues where it stopped.

    \b
    epicyclic oil characterise atf-talbot-2012 --size 512 --seed 1 -o atf
    epicyclic run talbot-2012 --set models.friction=fitted --set models.oil_model=atf/model.json
    """
    from epicyclic.plugins.contact_solver.campaign import (
        SIMULATIONS,
        CampaignFolder,
        make_campaign,
        parse_ranges,
    )

    campaign = make_campaign(
        source,
        size=size,
        bearing_size=bearing_size,
        seed=seed,
        ranges=parse_ranges(ranges),
        changes=parse_changes(changes),
    )
    folder = CampaignFolder(output, campaign)
    folder.prepare()
    if runner.shard is not None:
        write = campaign_writer(campaign, output)
        compute(campaign, output / SIMULATIONS, runner, write, "contacts")
        return
    echo(f"{campaign.size} contacts, {folder.finished} of them already simulated.", err=True)
    try:
        with progress_bar("contacts") as progress:
            folder.run(replace(runner, progress=progress))
    except (KeyboardInterrupt, Exception):
        echo(
            f"{folder.finished} of {campaign.size} simulations kept in {output}; give the same "
            "command again to continue.",
            err=True,
        )
        raise
    _fit([folder], folder.model, plot)


def campaign_writer(campaign: Campaign, output: Path) -> Write:
    """Writes and fits all simulations in a folder; raises `InputError` if it cannot."""
    from epicyclic.plugins.contact_solver.campaign import CampaignFolder

    folder = CampaignFolder(output, campaign)
    folder.prepare()

    def write(rows: Rows) -> str:
        folder.write(rows)
        _fit([folder], folder.model, None)
        return f"Wrote {campaign.size} simulations to {folder.table}."

    return write


@oil.command()
@click.argument(
    "folders", metavar="DIR...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@output_option(
    "Output file of the models; default: model.json in DIR; required for more than one DIR.", "FILE"
)
@plot_models
def fit(folders: tuple[Path, ...], output: Path | None, plot: Path | None) -> None:
    """Fit models again to the simulations in DIR, or to those in several folders together.

    Simulations in another folder widen the conditions for which the models hold.
    """
    from epicyclic.plugins.contact_solver.campaign import open_folder

    if output is None and len(folders) > 1:
        raise click.UsageError("For more than one DIR, give the output FILE with -o.")
    campaigns = [open_folder(folder) for folder in folders]
    _fit(campaigns, output or campaigns[0].model, plot)


@oil.command("show")
@click.argument("model", metavar="MODEL", type=click.Path(path_type=Path))
def show_model(model: Path) -> None:
    """Show what a fitted MODEL file holds, and its errors."""
    from epicyclic.contact.fitted_models import read_oil_model
    from epicyclic.plugins.contact_solver.show import oil_model_tables

    print_tables(oil_model_tables(read_oil_model(model)))


def _fit(folders: Sequence[CampaignFolder], output: Path, plot: Path | None) -> None:
    """Fit, write and show the models."""
    from epicyclic.plugins.contact_solver.fit import fit_and_write, simulated_quantities
    from epicyclic.plugins.contact_solver.show import oil_model_figure, oil_model_tables

    model = fit_and_write(folders, output)
    print_tables(oil_model_tables(model))
    echo(f"Wrote {output}.")
    if plot is not None:
        draw(oil_model_figure(model, simulated_quantities(folders)), plot)
