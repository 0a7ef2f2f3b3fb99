"""What an import from REXS took, and what the file lacks."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic.errors import Problem
from epicyclic.exchange.rexs.importing import RexsImport
from epicyclic.report.tables import plain_table


def import_tables(
    found: RexsImport,
    given: Collection[str],  # Keys that the user set.
    problems: Sequence[Problem],  # Problems of the case as it is.
    notes: Sequence[str],  # What is to be known beside the notes of the import itself.
) -> RenderableType:
    """Summary of an import."""
    head = Text(f"REXS {found.version}, {found.component}: {len(found.origins)} keys", "bold")
    parts: list[RenderableType] = [head]
    lacking = found.lacking(given)
    for title, needed in (("The case needs", True), ("Not in the file", False)):
        table = plain_table(title)
        table.add_column("key of the case", no_wrap=True)
        table.add_column("missing in the file", overflow="fold")
        for lack in lacking:
            if lack.needed == needed:
                table.add_row(Text(lack.key), Text(f"{lack.attribute}. {lack.instead}".rstrip()))
        if table.row_count:
            parts.append(table)
    needed_ones = [lack for lack in lacking if lack.needed]
    others = [item for item in problems if not any(lack.explains(item) for lack in needed_ones)]
    parts += [Text(f"Problem: {problem}") for problem in others]
    parts += [Text(f"Note: {note}") for note in (*found.notes, *notes)]
    return Group(*parts)
