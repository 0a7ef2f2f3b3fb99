"""The command merge: shards put together."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from epicyclic.cli.compare import comparison_writer
from epicyclic.cli.duty import duty_writer
from epicyclic.cli.many import Write, finish, map_writer, sweep_writer
from epicyclic.cli.oil import campaign_writer
from epicyclic.cli.options import output_option
from epicyclic.cli.pockets import study_writer
from epicyclic.cli.pockets_table import table_writer


@click.command()
@click.argument(
    "files", metavar="FILE...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@output_option("File, or folder of a study or campaign.", required=True)
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

    writers: dict[Any, Callable[..., Write]] = {
        SweepPlan: sweep_writer,
        MapPlan: map_writer,
        StudyPlan: study_writer,
        TablePlan: table_writer,
        Campaign: campaign_writer,
        ComparisonPlan: comparison_writer,
        DutyPlan: duty_writer,
    }
    plan, rows, how = gather(files, {kind.kind: kind for kind in writers})
    finish(plan, rows, writers[type(plan)](plan, output, **how))
