"""The command merge: shards put together."""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature
from pathlib import Path
from typing import Any

import click

from epicyclic.cli.common import output_option
from epicyclic.cli.compare import comparison_writer
from epicyclic.cli.duty import duty_writer
from epicyclic.cli.many import Write, finish, map_writer, sweep_writer
from epicyclic.cli.pockets import table_writer
from epicyclic.errors import one_problem
from epicyclic.registry import load, offered


@click.command()
@click.argument(
    "files", metavar="FILE...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@output_option("Output file, or folder of a study or campaign.", required=True)
def merge(files: tuple[Path, ...], output: Path) -> None:
    """Combine shards, as if one command had computed them.

    FILEs are those of all shards. They state what was computed; no other option is needed.

    \b
    epicyclic sweep case.toml --vary "planet.count=3,4" -o s.nc --shard 1/2
    epicyclic sweep case.toml --vary "planet.count=3,4" -o s.nc --shard 2/2
    epicyclic merge s.nc.shard-* -o s.nc
    """
    from epicyclic.study.maps.compute import MapPlan
    from epicyclic.study.maps.duty import DutyPlan
    from epicyclic.study.measured.compare import ComparisonPlan
    from epicyclic.study.pocketing_table import TablePlan
    from epicyclic.study.sweeps.run import SweepPlan
    from epicyclic.study.sweeps.runner import gather

    own: dict[Any, Callable[..., Write]] = {
        SweepPlan: sweep_writer,
        MapPlan: map_writer,
        TablePlan: table_writer,
        ComparisonPlan: comparison_writer,
        DutyPlan: duty_writer,
    }
    plans = {plan.kind: plan for plan in own} | {
        kind: load("plans", kind) for kind in offered("plans")
    }
    plan, rows, how = gather(files, plans)
    writer = own.get(type(plan)) or load("plan_writers", plan.kind)
    try:
        signature(writer).bind(plan, output, **how)
    except TypeError:  # a head that somebody else wrote
        allowed = "does not state how its points are to be written."
        raise one_problem("FILE", str(files[0]), allowed, "Compute the shard again.") from None
    finish(plan, rows, writer(plan, output, **how))
