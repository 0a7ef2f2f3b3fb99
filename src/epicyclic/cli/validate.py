"""The command validate: published figures beside computed ones."""

from __future__ import annotations

import click

__all__ = ["validate"]


@click.command()
def validate() -> None:
    """Compare with published figures: published, computed, difference, verdict."""
    from epicyclic.cli.progress import progress_bar
    from epicyclic.report.tables import terminal
    from epicyclic.report.validation_table import validation_table
    from epicyclic.validation.compare import compare_published

    with progress_bar("figures") as progress:
        rows = compare_published(progress)
    terminal().print(validation_table(rows))
