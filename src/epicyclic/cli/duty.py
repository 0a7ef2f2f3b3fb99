"""The command duty: energy over a duty cycle."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from epicyclic.cli import common
from epicyclic.cli.many import Write, compute, warn_at
from epicyclic.errors import ConvergenceError, Problem, raise_any
from epicyclic.files import check_place, write_file

if TYPE_CHECKING:
    import xarray as xr

    from epicyclic.study.maps.cycle import Cycle
    from epicyclic.study.maps.duty import DutyPlan
    from epicyclic.study.sweeps.runner import Rows, Runner
    from epicyclic.study.table_file import TableForm

_MAP_SUFFIX = ".nc"
_OUTPUTS = (".nc", ".csv")
_JSON = ".json"


@click.command()
@click.argument("map_or_case", metavar="MAP|CASE")
@click.argument("cycle", metavar="CYCLE")
@common.set_option
@click.option(
    "--temperature",
    "temperatures",
    metavar="VALUE",
    multiple=True,
    help='Oil inlet temperature, as in "20 degC", if it is not a column of the cycle; repeatable.',
)
@click.option("--clamp", is_flag=True, help="Evaluate points outside the map at its boundary.")
@common.file_option("--map", "map_file", help="Keep the map computed for a CASE in a .nc file.")
@click.option("--distance", metavar="VALUE", help='Distance driven, as in "23.27 km"; adds Wh/km.')
@common.table_options
@common.output_option("Write .nc or .csv.", "FILE")
@common.json_option
@common.journal_option
@common.shard_option
@common.runner_options
def duty(
    map_or_case: str,
    cycle: str,
    changes: tuple[str, ...],
    temperatures: tuple[str, ...],
    clamp: bool,
    map_file: Path | None,
    distance: str | None,
    form: TableForm,
    output: Path | None,
    json_file: str | None,
    journal: Path | None,
    runner: Runner,
) -> None:
    """Compute input, output and lost energy of a duty cycle, by component.

    CYCLE is a text, Excel or Parquet table with the columns "speed [rpm]", "torque [N*m]",
    "temperature [degC]" if it varies, and "time [s]", "duration [s]" or "share"; any unit is
    accepted. MAP is a loss map in a .nc file; for a CASE one that covers the cycle is computed
    first.

    A shard computes its share of the points of that map and keeps them beside the file of -o or
    --json, which 'epicyclic merge' writes.
    """
    from epicyclic.study.maps.cycle import open_cycle
    from epicyclic.study.maps.duty import distance_of, parse_temperatures, with_distance

    _check_options(map_or_case, changes, map_file, output, runner)
    if runner.shard is not None:
        _check_shard(output, json_file, journal)
    runner, covered = replace(runner, journal=journal), distance_of(distance)
    with common.progress_bar("rows read") as progress:
        checked = open_cycle(cycle, progress, form)
    celsius = parse_temperatures(checked, temperatures or None)
    if runner.shard is not None:
        from epicyclic.study.maps.duty import DutyPlan, cycle_plan, digest_of

        case = common.load_with(map_or_case, changes)
        digest = digest_of(Path(cycle))
        points = cycle_plan(case, checked, celsius)
        plan = DutyPlan(points.case, points.axes, digest=digest, celsius=celsius, clamp=clamp)
        file = output or Path(str(json_file))
        how: dict[str, Any] = {"cycle": cycle, "folder": str(Path.cwd()), "distance": distance}
        how |= {"map_file": map_file and str(map_file), "form": asdict(form)}
        compute(plan, file, runner, duty_writer(plan, file, **how), **how)
        return
    data = _map(map_or_case, changes, checked, celsius, map_file, runner)
    result = with_distance(_result(data, checked, celsius, clamp, runner), covered)
    if output is not None:
        _write_table(result, output)
    _show(result, json_file)


def duty_writer(
    plan: DutyPlan,
    output: Path,
    cycle: str,
    folder: str,
    map_file: str | None = None,
    form: Mapping[str, Any] | None = None,
    distance: str | None = None,
) -> Write:
    """Shows a duty cycle and writes it; raises `InputError` if it cannot.

    The cycle is that of this name here, else that in `folder`.
    """
    from epicyclic.study.maps.duty import check_same, distance_of

    common.check_ending("-o", output, (*_OUTPUTS, _JSON))
    check_place(output)
    path = Path(cycle) if Path(cycle).is_file() else Path(folder, cycle)
    check_same(plan, path)
    covered = distance_of(distance)

    def write(rows: Rows) -> str:
        from epicyclic.show.studies import duty_json
        from epicyclic.study.maps.compute import to_map
        from epicyclic.study.maps.cycle import open_cycle
        from epicyclic.study.maps.duty import with_distance
        from epicyclic.study.sweeps.runner import HERE
        from epicyclic.study.table_file import TableForm

        read = open_cycle(path, form=TableForm(**(form or {})))
        named = replace(read, source=replace(read.source, name=cycle))
        data = to_map(plan, rows)
        result = with_distance(_result(data, named, plan.celsius, plan.clamp, HERE), covered)
        if map_file is not None:
            _write_map(data, Path(map_file))
        if output.suffix == _JSON:
            write_file(output, duty_json(result) + "\n")
        else:
            _write_table(result, output)
        _show(result, None)
        return f"Wrote {output}."

    return write


def _result(
    data: xr.Dataset, cycle: Cycle, celsius: tuple[float, ...] | None, clamp: bool, runner: Runner
) -> xr.Dataset:
    from epicyclic.study.maps.duty import add_up, costliest, make_duty

    with common.progress_bar("rows") as progress:
        sums = add_up(data, cycle, celsius, clamp=clamp, progress=progress)
    with suppress(ConvergenceError):  # the map was interpolated there
        if (case := costliest(data, sums)) is not None:
            warn_at(case)
    with common.progress_bar("checked points") as progress:
        return make_duty(data, cycle, sums, replace(runner, progress=progress))


def _check_options(
    map_or_case: str,
    changes: tuple[str, ...],
    map_file: Path | None,
    output: Path | None,
    runner: Runner,
) -> None:
    problems = []
    if Path(map_or_case).suffix == _MAP_SUFFIX:
        problems += [
            Problem(name, "", "applies to a case, not to a map.", "Leave it out.")
            for name, value in (("--set", changes), ("--map", map_file), ("--shard", runner.shard))
            if value
        ]
    for name, path, suffixes in (("--map", map_file, (_MAP_SUFFIX,)), ("-o", output, _OUTPUTS)):
        if path is not None:
            problems += common.wrong_ending(name, path, suffixes)
    raise_any(problems, "the command")
    check_place(map_file, output)


def _check_shard(output: Path | None, json_file: str | None, journal: Path | None) -> None:
    """Raise `InputError` unless there is one file beside which a shard can keep its points."""
    problems = []
    if journal is not None:
        allowed = (
            "is not possible with shards, whose points are kept beside the file of -o or --json."
        )
        problems.append(Problem("--journal", str(journal), allowed, "Leave it out."))
    if json_file is not None and (output is not None or json_file == "-"):
        allowed = "must be the only output file of a shard."
        remedy = "Give -o FILE or --json FILE; 'epicyclic merge' writes any of them."
        problems.append(Problem("--json", json_file, allowed, remedy))
    elif json_file is None and output is None:
        allowed = "must name the file beside which the points of a shard are kept."
        problems.append(Problem("-o", "", allowed, "For example -o duty.nc."))
    raise_any(problems, "the command")


def _map(
    map_or_case: str,
    changes: tuple[str, ...],
    cycle: Cycle,
    celsius: tuple[float, ...] | None,
    map_file: Path | None,
    runner: Runner,
) -> xr.Dataset:
    """The map that is named, or one of the case that is."""
    from epicyclic.show.record import open_map
    from epicyclic.study.maps.duty import cycle_map

    if Path(map_or_case).suffix == _MAP_SUFFIX:
        return open_map(map_or_case)
    case = common.load_with(map_or_case, changes)
    with common.progress_bar("points of the map") as progress:
        data = cycle_map(case, cycle, celsius, replace(runner, progress=progress))
    if map_file is not None:
        _write_map(data, map_file)
    return data


def _write_map(data: xr.Dataset, map_file: Path) -> None:
    from epicyclic.study.maps.formats import write_map

    write_map(data, map_file)
    common.echo(f"Wrote the map to {map_file}.", err=True)


def _write_table(result: xr.Dataset, output: Path) -> None:
    from epicyclic.show.studies import duty_rows
    from epicyclic.study.sweeps.run import write_dataset

    write_dataset(result, output, duty_rows)


def _show(result: xr.Dataset, json_file: str | None) -> None:
    from epicyclic.show.studies import duty_json, duty_tables

    common.show(lambda: duty_tables(result), lambda: duty_json(result), json_file)
