"""Write the tables of bands and of missed figures into docs/validation.md, where they stand."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from epicyclic.show.page import shown
from epicyclic.units import unit_text
from epicyclic.validation.compare import (
    Comparison,
    MeasuredFigure,
    compare_published,
    measured_figures,
)
from epicyclic.validation.pages import band_rows
from epicyclic.validation.plots import published_text

PAGE = Path(__file__).parents[1] / "docs" / "validation.md"
TABLE = r"^\| {} \|.*?\n\n"


def missed_markdown(rows: Sequence[Comparison]) -> str:
    """What differs in the dissertation, and why, as the manual shows it."""
    head = ("Figure", "Printed", "Computed", "Cause")
    cells = [head, ("---",) * len(head)]
    cells += [
        (
            f"{row.what} ({row.source.partition(', ')[2]})",
            f"{published_text(row)} {unit_text(row.unit)}".rstrip(),
            f"{shown(row.computed, 3)} {unit_text(row.unit)}".rstrip(),
            row.missed,
        )
        for row in rows
        if row.verdict == "differs" and row.source.startswith("Talbot")
    ]
    return "\n".join(f"| {' | '.join(row)} |" for row in cells)


def band_markdown(rows: Sequence[MeasuredFigure]) -> str:
    """`band_rows` as the manual shows them."""
    head = ("Measured figure", "Measured", "Computed", "95 % band", "")
    cells = [head, ("---",) * len(head), *band_rows(rows)]
    return "\n".join(f"| {' | '.join(row)} |".replace("|  |", "| |") for row in cells)


def main() -> None:
    text = PAGE.read_text(encoding="utf-8")
    for head, table in (
        ("Figure", missed_markdown(compare_published())),
        ("Measured figure", band_markdown(measured_figures())),
    ):
        (old,) = re.findall(TABLE.format(head), text, re.DOTALL | re.MULTILINE)
        text = text.replace(old, f"{table}\n\n")
    PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
