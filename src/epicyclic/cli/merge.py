"""The command merge: shards put together."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import click

from epicyclic.cli.compare import comparison_writer
from epicyclic.cli.duty import duty_writer
from epicyclic.cli.many import Write, finish, map_writer, sweep_writer
from epicyclic.cli.oil import campaign_writer
from epicyclic.cli.pockets import study_writer
from epicyclic.cli.pockets_table import table_writer

__all__ = ["merge"]

WRITERS: dict[str, Callable[..., Write]] = {
    "sweep": sweep_writer,
    "map": map_writer,
    "study": study_writer,
    "pockets-table": table_writer,
    "oil": campaign_writer,
    "comparison": comparison_writer,
    "duty": duty_writer,
}
"""What writes the rows of each kind of plan."""


@click.command()
@click.argument(
    "files", metavar="FILE...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(path_type=Path),
    help="File, or folder of a study or campaign.",
)
def merge(files: tuple[Path, ...], output: Path) -> None:
    """Put shards together, as if one command had computed them.

    FILEs are those of all shards. They know what was computed; nothing else need be told.

    \b
    epicyclic sweep case.toml --vary "planet.count=3,4" -o s.nc --shard 1/2
    epicyclic sweep case.toml --vary "planet.count=3,4" -o s.nc --shard 2/2
    epicyclic merge s.nc.shard-* -o s.nc
    """
    from epicyclic.campaigns.campaign import Campaign
    from epicyclic.maps.compute import MapPlan
    from epicyclic.maps.duty_plan import DutyPlan
    from epicyclic.measurement.question import ComparisonPlan
    from epicyclic.sweeps.plan import SweepPlan
    from epicyclic.sweeps.pocketing_plan import StudyPlan
    from epicyclic.sweeps.pocketing_table import TablePlan
    from epicyclic.sweeps.shards import gather

    plans = (SweepPlan, MapPlan, StudyPlan, TablePlan, Campaign, ComparisonPlan, DutyPlan)
    plan, rows, how = gather(files, {plan.kind: plan for plan in plans})
    finish(plan, rows, WRITERS[plan.kind](plan, output, **how))
