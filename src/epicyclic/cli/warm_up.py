"""The command warm-up: temperatures and losses over time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.options import (
    case_argument,
    load_with,
    output_option,
    plot_option,
    point_of,
    set_option,
)
from epicyclic.cli.output import check_ending, draw

if TYPE_CHECKING:
    import xarray as xr

OUTPUTS = (".nc", ".csv", ".parquet")


@click.command("warm-up")
@case_argument
@set_option
@click.option("--for", "duration", metavar="TIME", required=True, help='How long, as in "2 h".')
@click.option(
    "--from",
    "start",
    metavar="TEMPERATURE",
    help='Of all parts at the start, as in "20 degC"; default: thermal.ambient_temperature.',
)
@click.option(
    "--cycle",
    metavar="CYCLE",
    help="A .csv or .parquet file as for 'epicyclic duty', repeated; default: the operating point.",
)
@output_option("Write .nc, .csv or .parquet.", "FILE")
@plot_option("Draw temperatures and loss over time to a .png, .svg or .pdf file.")
def warm_up(
    case: str,
    changes: tuple[str, ...],
    duration: str,
    start: str | None,
    cycle: str | None,
    output: Path | None,
    plot: Path | None,
) -> None:
    """Let a gearbox warm up: temperatures and losses over time.

    Temperatures follow from the network of heat, which needs thermal.oil_volume and, of a housing,
    thermal.housing.mass.
    """
    from epicyclic.cli.progress import progress_bar
    from epicyclic.maps.warm_up import warm_up as compute
    from epicyclic.report.tables import terminal
    from epicyclic.report.warm_up_table import warm_up_tables
    from epicyclic.whole_file import check_place

    if output is not None:
        check_ending("-o", output, OUTPUTS)
    for path in (output, plot):
        if path is not None:
            check_place(path)
    loaded = load_with(case, changes)
    with progress_bar("warming up") as progress:
        data = compute(loaded, duration, start, cycle=cycle, progress=progress)
    if output is not None:
        _write(data, output)
    terminal().print(warm_up_tables(data))
    if plot is not None:
        from epicyclic.plots.warm_up import warm_up_figure

        draw(warm_up_figure(data), plot, f"cycle {cycle}" if cycle else point_of(loaded))


def _write(data: xr.Dataset, output: Path) -> None:
    from epicyclic.report.warm_up_table import warm_up_rows
    from epicyclic.sweeps.dataset import csv_safe, write_dataset
    from epicyclic.whole_file import whole_file

    if output.suffix == OUTPUTS[0]:
        write_dataset(data, output)
        return
    rows = warm_up_rows(data)
    with whole_file(output) as file:
        if output.suffix == OUTPUTS[1]:
            csv_safe(rows).to_csv(file, index=False)
        else:
            rows.to_parquet(file, index=False)
