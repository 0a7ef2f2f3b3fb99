"""The command merge: shards put together."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from epicyclic.cli.common import output_option
from epicyclic.cli.compare import comparison_writer
from epicyclic.cli.duty import duty_writer
from epicyclic.cli.many import Write, finish, map_writer, sweep_writer
from epicyclic.cli.pockets import study_writer, table_writer
from epicyclic.plugins.contact_solver.commands import campaign_writer


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
    from epicyclic.plugins.contact_solver.campaign import Campaign
    from epicyclic.study.maps.compute import MapPlan
    from epicyclic.study.maps.duty import DutyPlan
    from epicyclic.study.measured.compare import ComparisonPlan
    from epicyclic.study.pocketing_table import TablePlan
    from epicyclic.study.sweeps.plan import SweepPlan
    from epicyclic.study.sweeps.runner import gather
    from epicyclic.validation.pocketing import StudyPlan

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
