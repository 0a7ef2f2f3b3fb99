"""The report of a chapter of Talbot (2012), computed again: its figures, and what is published."""

from __future__ import annotations

from collections.abc import Sequence

from epicyclic.plots.reproduced import Reproduced
from epicyclic.report.drawings import svg_text
from epicyclic.report.html import page_html
from epicyclic.report.page import Drawing, Gallery, KeyFigure, Section, number
from epicyclic.report.validation_page import comparison_sections
from epicyclic.results.result import versions
from epicyclic.validation.compare import Comparison, summary


def chapter_html(chapter: str, figures: Sequence[Reproduced], rows: Sequence[Comparison]) -> str:
    """All figures of a chapter and its published numbers, as one page that needs nothing else."""
    drawings = tuple(
        Drawing(f"fig-{item.number}", f"Fig. {item.number}", svg_text(item.picture, key))
        for item in figures
        for key in (f"fig-{item.number.replace('.', '-')}",)
    )
    return page_html(
        title=f"Talbot (2012), chapter {chapter}, computed again",
        kind="Reproduction",
        operation=summary(rows),
        source=f"Computed with epicyclic {versions()['epicyclic']}",
        key_figures=[KeyFigure("figures", number(len(drawings), ""))],
        sections=[
            Section("figures", "Figures", (Gallery(drawings, is_wide=True),), _LEAD),
            *comparison_sections(rows),
        ],
    )


_LEAD = (
    "Curves are computed; marked are the numbers that the text of the source prints. Its curves "
    "were not read off."
)
