"""The command duty: energy over a duty cycle."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.options import (
    journal_option,
    json_option,
    load_with,
    runner_options,
    set_option,
)
from epicyclic.cli.output import show, wrong_ending
from epicyclic.errors import InputError, Problem
from epicyclic.whole_file import write_file

if TYPE_CHECKING:
    import xarray as xr

    from epicyclic.maps.cycle import Cycle
    from epicyclic.sweeps.runner import Runner

__all__ = ["duty"]

_MAP_SUFFIX = ".nc"
_OUTPUTS = (".nc", ".csv")


@click.command()
@click.argument("map_or_case", metavar="MAP|CASE")
@click.argument("cycle", metavar="CYCLE")
@set_option
@click.option(
    "--temperature",
    "temperatures",
    metavar="VALUE",
    multiple=True,
    help='Oil inlet, as in "20 degC", for a cycle without a column of it; may be given again.',
)
@click.option("--clamp", is_flag=True, help="Take points outside of the map at its border.")
@click.option(
    "--map",
    "map_file",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Keep the map that is computed for a CASE, in a .nc file.",
)
@click.option(
    "-o", "--output", metavar="FILE", type=click.Path(path_type=Path), help="Write .nc or .csv."
)
@json_option
@journal_option
@runner_options
def duty(
    map_or_case: str,
    cycle: str,
    changes: tuple[str, ...],
    temperatures: tuple[str, ...],
    clamp: bool,
    map_file: Path | None,
    output: Path | None,
    json_file: str | None,
    journal: Path | None,
    runner: Runner,
) -> None:
    """Energy that a duty cycle puts in, takes out and loses, by component.

    CYCLE is a .csv or .parquet file with the columns "speed [rpm]", "torque [N*m]", if it varies
    "temperature [degC]", and "time [s]", "duration [s]" or "share"; any units. MAP is a loss map in
    a .nc file; for a CASE one that covers the cycle is computed first.
    """
    from epicyclic.cli.progress import progress_bar
    from epicyclic.maps.cycle import open_cycle
    from epicyclic.maps.duty import add_up, make_duty, parse_temperatures

    _check_options(map_or_case, changes, map_file, output)
    runner = replace(runner, journal=journal)
    with progress_bar("rows read") as progress:
        checked = open_cycle(cycle, progress)
    celsius = parse_temperatures(checked, temperatures or None)
    data = _map(map_or_case, changes, checked, celsius, map_file, runner)
    with progress_bar("rows") as progress:
        sums = add_up(data, checked, celsius, clamp=clamp, progress=progress)
    with progress_bar("checked points") as progress:
        result = make_duty(data, checked, sums, replace(runner, progress=progress))
    _write(result, output, json_file)


def _check_options(
    map_or_case: str, changes: tuple[str, ...], map_file: Path | None, output: Path | None
) -> None:
    from epicyclic.whole_file import check_place

    problems = []
    if Path(map_or_case).suffix == _MAP_SUFFIX:
        given = (("--set", changes), ("--map", map_file))
        problems += [
            Problem(name, "", "goes with a case, not with a map.", "Leave it out.")
            for name, value in given
            if value
        ]
    for name, path, suffixes in (("--map", map_file, (_MAP_SUFFIX,)), ("-o", output, _OUTPUTS)):
        if path is not None:
            problems += wrong_ending(name, path, suffixes)
    if problems:
        raise InputError(problems, "the command")
    for path in (map_file, output):
        if path is not None:
            check_place(path)


def _map(
    map_or_case: str,
    changes: tuple[str, ...],
    cycle: Cycle,
    celsius: tuple[float, ...] | None,
    map_file: Path | None,
    runner: Runner,
) -> xr.Dataset:
    """The map that is named, or one of the case that is."""
    from epicyclic.cli.progress import progress_bar
    from epicyclic.maps.duty import cycle_map
    from epicyclic.maps.formats import write_map
    from epicyclic.records.files import open_map

    if Path(map_or_case).suffix == _MAP_SUFFIX:
        return open_map(map_or_case)
    case = load_with(map_or_case, changes)
    with progress_bar("points of the map") as progress:
        data = cycle_map(case, cycle, celsius, replace(runner, progress=progress))
    if map_file is not None:
        write_map(data, map_file)
        click.echo(f"Wrote the map to {map_file}.", err=True)
    return data


def _write(result: xr.Dataset, output: Path | None, json_file: str | None) -> None:
    from epicyclic.report.duty_table import duty_json, duty_rows, duty_tables
    from epicyclic.sweeps.dataset import csv_safe, write_dataset

    if output is not None and output.suffix == _MAP_SUFFIX:
        write_dataset(result, output)
    elif output is not None:
        write_file(output, csv_safe(duty_rows(result)).to_csv(index=False))
    show(lambda: duty_tables(result), lambda: duty_json(result), json_file)
