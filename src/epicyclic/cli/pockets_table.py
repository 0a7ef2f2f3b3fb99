"""The command ``epicyclic pockets-table``."""

from __future__ import annotations

from pathlib import Path

import click

from epicyclic.cli.many import check_values
from epicyclic.cli.options import case_argument, load_with, set_option, temperature_option
from epicyclic.cli.output import check_ending, finishing

__all__ = ["pockets_table"]

FORMATS = (".nc", ".csv")


@click.command("pockets-table")
@case_argument
@set_option
@click.option(
    "--speed", metavar="VALUES", required=True, help='Of the input member, as in "500:5000:10 rpm".'
)
@temperature_option
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(path_type=Path),
    help=".nc, to be used, or .csv",
)
def pockets_table(case: str, changes: tuple[str, ...], output: Path, **values: str | None) -> None:
    """Tabulate the pocketing loss of each mesh over speed and oil temperature.

    VALUES are a,b,c or start:stop:count with a unit. A case whose models.pocketing_table names the
    .nc file reads its pocketing losses from there.
    """
    from epicyclic.cli.progress import progress_bar
    from epicyclic.sweeps.dataset import check_place, write_dataset
    from epicyclic.sweeps.plan import parse_vary
    from epicyclic.sweeps.pocketing_table import SPEED, TEMPERATURE, pocketing_table

    loaded = load_with(case, changes)
    check_ending("-o", output, FORMATS)
    check_place(output)
    check_values(values)
    keys = {"speed": SPEED, "temperature": TEMPERATURE}
    axes = [f"{keys[name]}={text}" for name, text in values.items() if text is not None]
    given = parse_vary(loaded, axes)
    with progress_bar("tables") as progress:
        table = pocketing_table(loaded, given[SPEED], given.get(TEMPERATURE), progress=progress)
    with finishing(f"Writing {output}."):
        write_dataset(table, output)
    worst = float(table["interpolation_error"].max())
    click.echo(f"Wrote {output}, interpolated within {worst:.2%} of the loss.")
