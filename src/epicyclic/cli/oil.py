"""Commands on oils to be characterised: characterise, fit, show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.many import Write, compute
from epicyclic.cli.options import (
    contact_set_option,
    output_option,
    parse_changes,
    plot_option,
    runner_options,
    shard_option,
)
from epicyclic.cli.output import draw

if TYPE_CHECKING:
    from epicyclic.campaigns.campaign import Campaign
    from epicyclic.campaigns.folder import CampaignFolder
    from epicyclic.sweeps.journal import Rows
    from epicyclic.sweeps.runner import Runner

plot_models = plot_option("Draw the models against the simulations (.png, .svg, .pdf).")


@click.group()
def oil() -> None:
    """Characterise an oil by simulated contacts, and fit friction and rolling loss to them."""


@oil.command(short_help="Simulate contacts of an OIL and fit models.")
@click.argument("source", metavar="OIL")
@output_option("Folder of simulations and models.", "DIR", required=True)
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
@click.option("--seed", type=click.IntRange(0), default=0, help="Of points and profiles.")
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

    Finished simulations are kept in DIR at once; the same command goes on where it stopped.

    \b
    epicyclic oil characterise atf-talbot-2012 --size 512 --seed 1 -o atf
    epicyclic run talbot-2012 --set models.friction=fitted --set models.oil_model=atf/model.json
    """
    from epicyclic.campaigns.campaign import make_campaign
    from epicyclic.campaigns.design import parse_ranges
    from epicyclic.campaigns.folder import SIMULATIONS, CampaignFolder
    from epicyclic.cli.progress import progress_bar

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
    click.echo(f"{campaign.size} contacts, {folder.finished} of them simulated before.", err=True)
    try:
        with progress_bar("contacts") as progress:
            folder.run(replace(runner, progress=progress))
    except (KeyboardInterrupt, Exception):
        click.echo(
            f"{folder.finished} of {campaign.size} simulations kept in {output}; give the same "
            "command again to go on.",
            err=True,
        )
        raise
    _fit([folder], folder.model, plot)


def campaign_writer(campaign: Campaign, output: Path) -> Write:
    """Writes and fits all simulations in a folder; raises `InputError` if it cannot."""
    from epicyclic.campaigns.folder import CampaignFolder

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
@output_option("The models; default: model.json in DIR; needed for more than one.", "FILE")
@plot_models
def fit(folders: tuple[Path, ...], output: Path | None, plot: Path | None) -> None:
    """Fit models again to the simulations in DIR, or to those in several folders together.

    Simulations in another folder widen the conditions for which the models hold.
    """
    from epicyclic.campaigns.folder import open_folder

    if output is None and len(folders) > 1:
        raise click.UsageError("For more than one DIR give the FILE of the models with -o.")
    campaigns = [open_folder(folder) for folder in folders]
    _fit(campaigns, output or campaigns[0].model, plot)


@oil.command()
@click.argument("model", metavar="MODEL", type=click.Path(path_type=Path))
def show(model: Path) -> None:
    """Show what a fitted MODEL file holds, and its errors."""
    from epicyclic.oilmodel.model import read_oil_model
    from epicyclic.report.oil_model_table import oil_model_tables
    from epicyclic.report.tables import terminal

    terminal().print(oil_model_tables(read_oil_model(model)))


def _fit(folders: Sequence[CampaignFolder], output: Path, plot: Path | None) -> None:
    """Fit, write and show the models."""
    from epicyclic.campaigns.fit import fit_and_write
    from epicyclic.report.oil_model_table import oil_model_tables
    from epicyclic.report.tables import terminal

    model = fit_and_write(folders, output)
    terminal().print(oil_model_tables(model))
    click.echo(f"Wrote {output}.")
    if plot is not None:
        from epicyclic.campaigns.fit import simulated_quantities
        from epicyclic.plots.oil_model import oil_model_figure

        simulated = {
            quantity: (states, target)
            for quantity, (states, target, _) in simulated_quantities(folders).items()
        }
        draw(oil_model_figure(model, simulated), plot)
