"""The command uncertainty: how well a result is known, and what that depends on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.common import (
    beside,
    draw,
    load_with,
    output_option,
    plot_option,
    print_tables,
    progress_bar,
    runner_options,
    set_option,
    temperature_option,
)
from epicyclic.cli.many import check_values, compute, parse_axes
from epicyclic.errors import Problem, raise_any
from epicyclic.files import check_place

if TYPE_CHECKING:
    import xarray as xr

    from epicyclic.case.case import Case
    from epicyclic.study.bands.study import Study
    from epicyclic.study.sweeps.runner import Rows, Runner

MAP_SUFFIX = ".nc"
seed_option = click.option(
    "--seed", type=int, default=1, show_default=True, help="Seed of the samples."
)


@click.command()
@click.argument("source", metavar="CASE|MAP")
@click.argument("cycle", metavar="[CYCLE]", required=False)
@set_option
@click.option(
    "--speed", metavar="VALUES", help="Speeds of the map of a CASE, as for 'epicyclic map'."
)
@click.option("--torque", metavar="VALUES", help="Torques of the map, likewise.")
@temperature_option
@click.option(
    "--samples",
    metavar="N",
    type=int,
    help="Samples in each set, a power of 2; two sets, and one more "
    "for each uncertain input. Default: 256, for a map 32, for a cycle 64.",
)
@click.option(
    "--points", metavar="N", type=int, help="Points that represent the CYCLE; default: 16."
)
@seed_option
@output_option("Write a .nc file.", "FILE", endings=(MAP_SUFFIX,))
@plot_option("Draw the drivers and the band to FILE-drivers.png and FILE-band.png.")
@runner_options
def uncertainty(
    source: str,
    cycle: str | None,
    changes: tuple[str, ...],
    samples: int | None,
    points: int | None,
    seed: int,
    output: Path | None,
    plot: Path | None,
    runner: Runner,
    **values: str | None,
) -> None:
    """Show the uncertainty of losses and efficiency, and the inputs and models that cause it.

    Covers a CASE, a loss MAP in a .nc file, a map that is computed first (with --speed and
    --torque), or the energy lost over a duty CYCLE. The distributions of inputs are those of
    [uncertainty] in the case, or estimates; an input has the same error at all points of a map or
    cycle. With -o, an interrupted computation continues where it stopped.
    """
    from epicyclic.show.uncertainty_tables import uncertainty_tables

    check_place(output, plot)
    check_values(values)
    _check_use(source, cycle, changes, points, values)
    from epicyclic.show.record import open_map

    loaded = open_map(source) if Path(source).suffix == MAP_SUFFIX else load_with(source, changes)
    if cycle is not None:
        study = _cycle_study(loaded, cycle, values["temperature"], samples, points, seed, runner)
    else:
        study = _study(loaded, values, samples, seed, runner)
    data = _computed(study, output, runner)
    print_tables(uncertainty_tables(data))
    if plot is not None:
        _draw(data, plot)


def _check_use(
    source: str,
    cycle: str | None,
    changes: tuple[str, ...],
    points: int | None,
    values: Mapping[str, str | None],
) -> None:
    """Raise `InputError` for options that do not go together."""
    of_map = Path(source).suffix == MAP_SUFFIX
    plane = [name for name in ("speed", "torque") if values[name] is not None]
    wrong = []
    if of_map or cycle is not None:
        wrong += [(f"--{name}", "applies to a case alone.") for name in plane]
    elif len(plane) == 1:
        wrong.append((f"--{plane[0]}", "needs both --speed and --torque."))
    if values["temperature"] is not None and not (cycle or plane):
        wrong.append(("--temperature", "requires --speed and --torque, or a cycle."))
    if of_map and changes:
        wrong.append(("--set", "applies to a case, not to a map."))
    if points is not None and cycle is None:
        wrong.append(("--points", "requires a cycle."))
    other = {False: "Leave it out.", True: "Add it, or leave this out."}
    said = (Problem(name, "", text, other["needs" in text]) for name, text in wrong)
    raise_any(said, "the command")


def _study(
    source: Case | xr.Dataset,
    values: Mapping[str, str | None],
    samples: int | None,
    seed: int,
    runner: Runner,
) -> Study:
    """The study of a case, or of a map, which is computed first if it is not given."""
    from epicyclic.case.case import Case
    from epicyclic.study.bands.plan import check_samples
    from epicyclic.study.bands.points import map_study
    from epicyclic.study.bands.study import uncertainty_study
    from epicyclic.study.maps.compute import checked_map, map_plan

    if samples is not None:
        check_samples(samples)
    if not isinstance(source, Case):
        return map_study(source, samples, seed)
    if values["speed"] is None:
        return uncertainty_study(source, samples, seed)
    given = parse_axes(source, values)
    plan = map_plan(source, given["speed"], given["torque"], given.get("temperature"))
    with progress_bar("points of the map") as progress:
        data = checked_map(plan, replace(runner, progress=progress).run(plan))
    return map_study(data, samples, seed)


def _cycle_study(
    source: Case | xr.Dataset,
    cycle: str,
    temperature: str | None,
    samples: int | None,
    points: int | None,
    seed: int,
    runner: Runner,
) -> Study:
    from epicyclic.case.case import Case
    from epicyclic.study.bands.points import cycle_study
    from epicyclic.study.maps.cycle import open_cycle
    from epicyclic.study.maps.duty import cycle_map, parse_temperatures

    with progress_bar("rows read") as progress:
        checked = open_cycle(cycle, progress)
    celsius = parse_temperatures(checked, None if temperature is None else [temperature])
    if isinstance(source, Case):
        with progress_bar("points of the map") as progress:
            source = cycle_map(source, checked, celsius, replace(runner, progress=progress))
    with progress_bar("changed inputs") as progress:
        own = replace(runner, progress=progress)
        return cycle_study(source, checked, celsius, samples, points, seed, own)


def _draw(data: xr.Dataset, plot: Path) -> None:
    from epicyclic.show.plots.catalogue import figure_of

    names = {"drivers": "drivers", "band": "band"}
    if "explained" in data:
        names |= {"band": "loss-band", "lines": "loss-band-lines"}
    for ending, name in names.items():
        draw(figure_of(data, name), beside(plot, ending))


def _computed(study: Study, output: Path | None, runner: Runner) -> xr.Dataset:
    if output is None:
        with progress_bar("samples") as progress:
            return study.dataset(replace(runner, progress=progress).run(study.plan))
    found: list[xr.Dataset] = []

    def write(rows: Rows) -> str:
        from epicyclic.study.sweeps.run import write_dataset

        found.append(study.dataset(rows))
        write_dataset(found[0], output)
        return f"Wrote {output}."

    compute(study.plan, output, runner, write, "samples")
    return found[0]


@click.command("compare-cases")
@click.argument("first")
@click.argument("second")
@click.option(
    "--samples",
    metavar="N",
    type=int,
    default=256,
    show_default=True,
    help="Pairs of samples, a power of 2.",
)
@seed_option
@runner_options
def compare_cases(first: str, second: str, samples: int, seed: int, runner: Runner) -> None:
    """Show whether case SECOND loses less than case FIRST, given the uncertainties of both.

    Inputs that both cases share are drawn once for both.
    """
    from epicyclic.show.uncertainty_tables import pair_tables
    from epicyclic.study.bands.compare_cases import compare_cases as compare

    cases = [load_with(name, ()) for name in (first, second)]
    with progress_bar("samples") as progress:
        data = compare(
            *cases,
            samples=samples,
            seed=seed,
            jobs=runner.jobs,
            dask=runner.dask,
            progress=progress,
        )
    print_tables(pair_tables(data))
