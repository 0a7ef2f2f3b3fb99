"""The command uncertainty: how well a result is known, and what that depends on."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from epicyclic.cli.many import compute
from epicyclic.cli.options import case_argument, load_with, plot_option, runner_options, set_option
from epicyclic.cli.output import beside, check_ending, draw

if TYPE_CHECKING:
    import xarray as xr

    from epicyclic.bands.study import UncertaintyStudy
    from epicyclic.sweeps.journal import Rows
    from epicyclic.sweeps.runner import Runner

__all__ = ["compare_cases", "uncertainty"]

samples_option = click.option(
    "--samples",
    metavar="N",
    type=int,
    default=256,
    show_default=True,
    help="Points in each set, a power of 2.",
)
seed_option = click.option(
    "--seed", type=int, default=1, show_default=True, help="Of the drawn points."
)


@click.command()
@case_argument
@set_option
@samples_option
@seed_option
@click.option(
    "-o", "--output", metavar="FILE", type=click.Path(path_type=Path), help="Write a .nc file."
)
@plot_option("Draw the drivers and the distribution to FILE-drivers.png and FILE-band.png.")
@runner_options
def uncertainty(
    case: str,
    changes: tuple[str, ...],
    samples: int,
    seed: int,
    output: Path | None,
    plot: Path | None,
    runner: Runner,
) -> None:
    """Show how well losses and efficiency are known, and which inputs and models that is due to.

    Distributions of inputs are those of [uncertainty] of the case, or assumed ones. With -o, an
    interrupted computation goes on where it stopped.
    """
    from epicyclic.bands.study import uncertainty_study
    from epicyclic.report.tables import terminal
    from epicyclic.report.uncertainty_tables import uncertainty_tables
    from epicyclic.sweeps.dataset import check_place

    for option, path, endings in (("-o", output, ((".nc",),)), ("--plot", plot, ())):
        if path is not None:
            check_ending(option, path, *endings)
            check_place(path)
    study = uncertainty_study(load_with(case, changes), samples, seed)
    data = _computed(study, output, runner)
    terminal().print(uncertainty_tables(data))
    if plot is not None:
        from epicyclic.plots.uncertainty import band_figure, drivers_figure

        draw(drivers_figure(data), beside(plot, "drivers"))
        draw(band_figure(data), beside(plot, "band"))


def _computed(study: UncertaintyStudy, output: Path | None, runner: Runner) -> xr.Dataset:
    from epicyclic.cli.progress import progress_bar

    if output is None:
        with progress_bar("samples") as progress:
            return study.dataset(replace(runner, progress=progress).run(study.plan))
    found: list[xr.Dataset] = []

    def write(rows: Rows) -> str:
        from epicyclic.sweeps.dataset import write_dataset

        found.append(study.dataset(rows))
        write_dataset(found[0], output)
        return f"Wrote {output}."

    compute(study.plan, output, runner, write, "samples")
    return found[0]


@click.command("compare-cases")
@click.argument("first")
@click.argument("second")
@samples_option
@seed_option
@runner_options
def compare_cases(first: str, second: str, samples: int, seed: int, runner: Runner) -> None:
    """Show whether case SECOND loses less than case FIRST, given what is uncertain in both.

    Inputs that both cases share are drawn once for both.
    """
    from epicyclic.bands.pairs import compare_cases as compare
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.tables import terminal
    from epicyclic.report.uncertainty_tables import pair_tables

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
    terminal().print(pair_tables(data))
