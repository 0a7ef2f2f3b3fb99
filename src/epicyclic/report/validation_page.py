"""The report of the comparison with published figures: one page for all of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

from epicyclic.plots.style import styled_figure
from epicyclic.plots.validation import deviations_size, plot_deviations
from epicyclic.report.drawings import svg_text
from epicyclic.report.explore import explorable
from epicyclic.report.html import page_html
from epicyclic.report.page import (
    Cell,
    Drawing,
    Gallery,
    Item,
    KeyFigure,
    Listing,
    Section,
    Table,
    number,
)
from epicyclic.report.validation_table import closure_table, published_text, remarks, verdict_text
from epicyclic.results.result import versions
from epicyclic.units import percent, unit_text
from epicyclic.validation.closures import ClosureFigure
from epicyclic.validation.compare import Comparison, by_topic, summary

MOST_ROWS = 8
"""Most rows of one picture."""
_HEAD = (
    "figure",
    "published",
    "computed",
    "unit",
    "difference",
    "verdict",
    "cause of the tolerance",
)
_WIDTHS = (32, 8, 8, 8, 8, 15, 21)


def validation_html(
    rows: Sequence[Comparison],
    closures: Sequence[ClosureFigure] = (),  # Open figures of pocketing losses.
    # Called with the numbers of pictures drawn and to draw.
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> str:
    """Every published figure, pictured and listed, as one page that needs nothing else."""
    return page_html(
        title="Published figures, computed",
        kind="Validation",
        operation=summary(rows, closures),
        source=f"Computed with epicyclic {versions()['epicyclic']}",
        key_figures=_key_figures(rows),
        sections=[*comparison_sections(rows, progress), *_closure_section(closures)],
    )


def _key_figures(rows: Sequence[Comparison]) -> list[KeyFigure]:
    verdicts = [row.verdict for row in rows]
    return [
        KeyFigure(verdict, number(verdicts.count(verdict), ""))
        for verdict in ("agrees", "differs", "calibrated", "no verdict")
    ]


def comparison_sections(
    rows: Sequence[Comparison], progress: Callable[[int, int], None] = lambda done, total: None
) -> Iterator[Section]:
    """The figures of each topic, pictures of them, and what the signs mean."""
    topics = by_topic(rows)
    for done, (topic, own) in enumerate(topics.items()):
        progress(done, len(topics))
        key = topic.lower().replace(" ", "-").replace(",", "")
        yield Section(key, topic, tuple(_items(key, own)))
    text = (
        "* The tolerance was settled with the computed figure in view. Without a star it is the "
        "rounding of what is printed.",
        "Calibrated figures fixed an unknown input; they, and those without a verdict, do not "
        "count.",
    )
    yield Section("signs", "Signs", (Listing(text),))


def _closure_section(rows: Sequence[ClosureFigure]) -> Iterator[Section]:
    if rows:
        yield Section("closures", "Pocketing by every closure", (closure_table(rows),))


def _items(key: str, rows: Sequence[Comparison]) -> Iterator[Item]:
    """Pictures of like height, each below its table, which breaks and fills a printed page."""
    count = math.ceil(len(rows) / MOST_ROWS)
    height = math.ceil(len(rows) / count)
    for place in range(count):
        part = rows[place * height : (place + 1) * height]
        yield _table(part)
        drawing = _drawing(f"{key}-{place + 1}" if count > 1 else key, part)
        yield Gallery((drawing,), is_wide=True)


def _drawing(key: str, rows: Sequence[Comparison]) -> Drawing:
    with styled_figure(1, 1, "", panel=deviations_size(rows)) as (figure, axes):
        ax = plot_deviations(rows, axes[0, 0])
    return Drawing(key, "Computed over published", svg_text(figure, key), explorable(ax))


def _table(rows: Sequence[Comparison]) -> Table:
    return Table(
        _HEAD,
        tuple(
            (
                Cell(f"{row.what}. {' '.join(remarks(row))}"),
                Cell(published_text(row), row.low),
                number(row.computed, ""),
                Cell(unit_text(row.unit), about="nowrap"),
                Cell(percent(row.difference, signed=True), row.difference),
                Cell(verdict_text(row), about="nowrap"),
                Cell(row.cause),
            )
            for row in rows
        ),
        widths=_WIDTHS,
    )
