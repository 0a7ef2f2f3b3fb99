"""The command compare: measured losses beside computed ones."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click
from pydantic_core import PydanticCustomError

from epicyclic.cli import common
from epicyclic.cli.many import Write, compute
from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.files import check_place, write_file
from epicyclic.messages import refused
from epicyclic.units import NUMBER

if TYPE_CHECKING:
    from epicyclic.case.tables.models import LoadDependent
    from epicyclic.study.measured.compare import ComparisonPlan
    from epicyclic.study.measured.comparison import MeasuredComparison
    from epicyclic.study.sweeps.runner import Rows, Runner
    from epicyclic.study.table_file import TableForm


@click.command()
@common.case_options
@click.argument("measured", metavar="MEASURED", type=click.Path(path_type=Path))
@click.option(
    "--component",
    metavar="NAME",
    default="total",
    help="The loss that was measured, if no column says so: a term, load_dependent, "
    "load_independent, total (default), or several joined by +.",
)
@click.option(
    "--load-dependent",
    type=click.Choice(["computed", "as-tested"]),
    default="computed",
    help="Definition of load-dependent losses: the sum of their terms (default), or the total loss "
    "less the loss without torque, each at its own temperatures.",
)
@click.option(
    "--baseline",
    metavar="COLUMN=VALUE",
    default="",
    help="Rows of a back-to-back rig with two equal sets; half of their loss, that of the reaction "
    "set, is subtracted from the other rows.",
)
@click.option(
    "--unloaded",
    is_flag=True,
    help="Subtract the measured loss without torque, at the same speed and temperature, from each "
    "loss under load.",
)
@click.option(
    "--torque-uncertainty",
    metavar="TORQUE|PERCENT",
    default="",
    help="Standard uncertainty of each measured torque, 0.11 N*m or 0.05 % of it.",
)
@click.option(
    "--group",
    metavar="COLUMN",
    help="Column by whose values errors are grouped; default: temperature.",
)
@click.option(
    "--fit",
    metavar="KEY,...",
    help="Calibrate these keys of the case within the ranges that a case file allows.",
)
@click.option(
    "--hold-out",
    metavar="COLUMN=VALUE|SHARE",
    help="Points excluded from the fit: rows where a column has a value, or a random share.",
)
@click.option(
    "--relative",
    metavar="PERCENT",
    help="Standard uncertainty of each loss relative to it, as in 5%, if no column states it; "
    "default: estimated from the scatter about the fit.",
)
@click.option(
    "--seed", type=click.IntRange(0), default=0, help="Seed of the random share; default: 0."
)
@common.table_options
@common.output_option("Write the calibrated case (.toml).", "FILE", endings=(".toml",))
@common.plot_option("Draw parity and residuals to .png, .svg or .pdf.")
@common.json_option
@common.journal_option
@common.shard_option
@common.runner_options
def compare(
    case: str,
    measured: Path,
    changes: tuple[str, ...],
    component: str,
    load_dependent: LoadDependent,
    baseline: str,
    unloaded: bool,
    torque_uncertainty: str,
    group: str | None,
    fit: str | None,
    hold_out: str | None,
    relative: str | None,
    seed: int,
    form: TableForm,
    output: Path | None,
    plot: Path | None,
    json_file: str | None,
    journal: Path | None,
    runner: Runner,
) -> None:
    """Compare measured losses with computed ones; with --fit, calibrate inputs to them.

    MEASURED is a text, Excel or Parquet table with columns such as "speed [rpm]", "torque [N*m]",
    "temperature [degC]", and "loss [W]", "torque_loss [N*m]", "efficiency [%]" or
    "output_torque [N*m]"; optionally "uncertainty [W]" or [%], component, the state of a train, and
    any key of the case.

    A shard keeps its points beside the file of --json, which 'epicyclic merge' writes.
    """
    from epicyclic.show.studies import measured_tables
    from epicyclic.study.measured.compare import compare_measured
    from epicyclic.study.measured.rig import Rig

    rig = Rig(baseline, unloaded, torque_uncertainty)
    keys = [key.strip() for key in (fit or "").split(",") if key.strip()]
    if output is not None and not keys:
        allowed = "holds the calibrated case, but no keys are calibrated."
        raise one_problem("-o", str(output), allowed, "Name the keys with --fit.", "the command")
    if seed and "=" in (hold_out or "="):
        allowed = "draws the random share of --hold-out, which is not given."
        raise one_problem("--seed", str(seed), allowed, "Leave it out.", "the command")
    if runner.shard is not None:
        others = {"--relative": relative, "--hold-out": hold_out, "--journal": journal}
        _check_shard(json_file, {"--fit": fit, **others})
    loaded = common.load_with(case, changes)
    if runner.shard is not None:
        from epicyclic.study.measured.compare import ComparisonPlan, ask
        from epicyclic.study.table_file import read_grid

        question = ask(loaded, read_grid(measured, form), component, load_dependent, group, rig)
        plan, file = ComparisonPlan.of(question), Path(str(json_file))
        write = comparison_writer(plan, file)
        compute(plan, file, runner, write, plot=None if plot is None else str(plot))
        return
    with common.progress_bar("points") as progress:
        comparison = compare_measured(
            loaded,
            measured,
            component=component,
            load_dependent=load_dependent,
            group=group,
            fit=keys,
            hold_out=hold_out,
            seed=seed,
            relative=None if relative is None else _share(relative),
            rig=rig,
            form=form,
            jobs=runner.jobs,
            dask=runner.dask,
            journal=journal,
            progress=progress,
            tell=common.tell,
        )
    common.show(lambda: measured_tables(comparison), comparison.to_json, json_file)
    if output is not None:
        write_file(output, _calibrated_text(comparison))
    if plot is not None:
        _draw(comparison, plot)


def comparison_writer(plan: ComparisonPlan, output: Path, plot: str | None = None) -> Write:
    """Shows a comparison, writes it as JSON and draws it to the file `plot`.

    Raises `InputError` if it cannot.
    """
    check_place(output)

    def write(rows: Rows) -> str:
        from epicyclic.show.studies import measured_tables

        comparison = plan.comparison(rows)
        write_file(output, comparison.to_json() + "\n")
        common.print_tables(measured_tables(comparison))
        if plot is not None:
            _draw(comparison, Path(plot))
        return f"Wrote {output}."

    return write


def _draw(comparison: MeasuredComparison, plot: Path) -> None:
    from epicyclic.show.plots.measured import measured_figure

    common.draw(measured_figure(comparison), plot)


def _check_shard(json_file: str | None, others: Mapping[str, object]) -> None:
    """Raise `InputError` for options that do not go with a shard."""
    reasons = {
        "--fit": "is not possible with shards, because each round of a fit starts from the "
        "result of the previous one.",
        "--relative": "concerns a fit, which is not possible with shards.",
        "--hold-out": "requires --fit, which is not possible with shards.",
        "--journal": "is not possible with shards, whose points are kept beside the file of "
        "--json.",
    }
    problems = [
        Problem(name, "", reasons[name], "Remove one of them.")
        for name, value in others.items()
        if value is not None
    ]
    if json_file in (None, "-"):
        allowed = "must name the file beside which the points of a shard are kept."
        problems.append(Problem("--json", json_file or "", allowed, "For example --json c.json."))
    raise_any(problems, "the command")


def _share(text: str) -> float:
    """A share in per cent, or of one."""
    try:
        return float(NUMBER.parse(text if text.strip()[-1:] == "%" else f"{text} dimensionless"))
    except PydanticCustomError as error:
        raise InputError([refused(error, "--relative", f'"{text}"')], "the command") from None


def _calibrated_text(comparison: MeasuredComparison) -> str:
    """The calibrated case as a case file that says which values are fitted, and to what."""
    from epicyclic.case.tables.uncertainty import MODEL_FORM
    from epicyclic.show.studies import fitted_comment
    from epicyclic.show.template import case_text
    from epicyclic.study.bands.inputs import factors_of_kind
    from epicyclic.study.measured.comparison import CALIBRATED

    calibrated, fit = comparison.calibrated_case, comparison.fit
    assert calibrated is not None
    assert fit is not None
    heading = [
        f"{CALIBRATED}: the marked values were fitted to {fit.points} measured losses of",
        f"{comparison.measured.source}. Agreement with these is not validation.",
        *(f"Warning: {note}" for note in fit.warnings),
    ]
    about = {}
    for item in fit.parameters:
        comment = fitted_comment(item, fit)
        kind = item.key.removeprefix(MODEL_FORM)
        for key in [item.key] if kind == item.key else factors_of_kind(comparison.case, kind):
            about[key] = comment
            table, _, name = key.rpartition(".")
            if "." in table:  # a table within a table may stand on one line
                about[table] = f"{name}: {comment}"
    return case_text(calibrated.given(), heading, about)
