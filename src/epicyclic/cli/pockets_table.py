"""The command ``epicyclic pockets-table``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.many import Write, check_values, compute, parse_axes
from epicyclic.cli.options import (
    case_argument,
    load_with,
    output_option,
    runner_options,
    set_option,
    shard_option,
    temperature_option,
)
from epicyclic.cli.output import check_ending
from epicyclic.units import percent

if TYPE_CHECKING:
    from epicyclic.sweeps.journal import Rows
    from epicyclic.sweeps.pocketing_table import TablePlan
    from epicyclic.sweeps.runner import Runner

FORMATS = (".nc", ".csv")


@click.command("pockets-table")
@case_argument
@set_option
@click.option(
    "--speed", metavar="VALUES", required=True, help='Of the input member, as in "500:5000:10 rpm".'
)
@temperature_option
@output_option(".nc, to be used, or .csv", required=True)
@shard_option
@runner_options
def pockets_table(
    case: str, changes: tuple[str, ...], output: Path, runner: Runner, **values: str | None
) -> None:
    """Tabulate the pocketing loss of each mesh over speed and oil temperature.

    VALUES are a,b,c or start:stop:count with a unit. A case whose models.pocketing_table names the
    .nc file reads its pocketing losses from there.
    """
    from epicyclic.sweeps.pocketing_table import make_table_plan

    loaded = load_with(case, changes)
    check_ending("-o", output, FORMATS)
    check_values(values)
    given = parse_axes(loaded, values)
    plan = make_table_plan(loaded, given["speed"], given.get("temperature"))
    compute(plan, output, runner, table_writer(plan, output), "tables")


def table_writer(plan: TablePlan, output: Path) -> Write:
    """Writes tables; raises `InputError` if it cannot."""
    from epicyclic.sweeps.dataset import write_dataset
    from epicyclic.sweeps.pocketing_table import table_dataset
    from epicyclic.whole_file import check_place

    check_ending("-o", output, FORMATS)
    check_place(output)

    def write(rows: Rows) -> str:
        table = table_dataset(plan, rows)
        write_dataset(table, output)
        worst = float(table["interpolation_error"].max())
        return f"Wrote {output}, interpolated within {percent(worst, 2)} of the loss."

    return write
