"""The command validate: published figures beside computed ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["validate"]


@click.command()
@click.option(
    "--temperatures",
    is_flag=True,
    help="The loaded tests only, with temperatures that follow from the losses: minutes.",
)
def validate(temperatures: bool) -> None:
    """Compare with published figures: published, computed, difference, verdict."""
    from epicyclic.report.tables import terminal

    terminal().print(_settled() if temperatures else _compared())


def _compared() -> RenderableType:
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.validation_table import validation_table
    from epicyclic.validation.compare import compare_published

    with progress_bar("figures") as progress:
        return validation_table(compare_published(progress))


def _settled() -> RenderableType:
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.validation_table import settled_table
    from epicyclic.sweeps.runner import Runner
    from epicyclic.validation.settled import estimates, settled_figures

    with progress_bar("tests") as progress:
        return settled_table(settled_figures(Runner(progress=progress)), estimates())
