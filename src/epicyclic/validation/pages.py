"""Published against computed: tables for a terminal, pages of a report."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic.machine.pocket_flow import STUDY_SOURCE
from epicyclic.result.result import versions
from epicyclic.show.html import page_html
from epicyclic.show.page import (
    MISSING,
    Cell,
    Drawing,
    Gallery,
    Item,
    KeyFigure,
    Listing,
    Section,
    Table,
    aligned,
    number,
    shown,
)
from epicyclic.show.plots.catalogue import explorable, svg_text
from epicyclic.show.plots.style import styled_figure
from epicyclic.show.terminal import number_table
from epicyclic.units import percent, unit_text
from epicyclic.validation.chapters import influences
from epicyclic.validation.compare import (
    CLOSURES,
    ClosureFigure,
    Comparison,
    Estimate,
    MeasuredFigure,
    SettledFigure,
    by_topic,
    summary,
)
from epicyclic.validation.plots import Reproduced, deviations_size, plot_deviations, published_text
from epicyclic.validation.scoreboard import DEFAULTS, GRADES, Score, in_band

_STYLES = {
    "agrees": "green",
    "differs": "bold red",
    "calibrated": "dim",
    "no verdict": "dim",
    "not computed": "dim",
}


def validation_table(
    rows: Sequence[Comparison], closures: Sequence[ClosureFigure] = ()
) -> RenderableType:
    """One row for each figure, and a count of the verdicts."""
    heads = ("figure, source", "published", "computed", "difference")
    table = number_table("Published against computed", *heads, no_wrap=(False, True))
    table.add_column("verdict", no_wrap=True)
    for row in rows:
        table.add_row(
            Text.assemble(row.what, ("\n" + "\n".join(remarks(row)), "dim")),
            f"{published_text(row)} {unit_text(row.unit)}".rstrip(),
            f"{shown(row.computed)} {unit_text(row.unit)}".rstrip(),
            _difference(row),
            Text(verdict_text(row), style=_STYLES[row.verdict]),
        )
    return Group(table, Text(summary(rows, closures)))


def closure_table(rows: Sequence[ClosureFigure]) -> Table:
    """One row for each open figure of the study of pocketing, one column for each closure."""
    causes = dict.fromkeys(f"{percent(row.tolerance, 0)}: {row.cause}" for row in rows)
    cells = [
        (
            Cell(f"{row.what}, {unit_text(row.unit)}".rstrip(", ")),
            aligned(published_text(row)),
            *(
                aligned(f"{shown(row.computed[name])} {'agrees' if row.holds(name) else 'differs'}")
                for name in CLOSURES
            ),
        )
        for row in rows
    ]
    held = (f"{sum(row.holds(name) for row in rows)} of {len(rows)}" for name in CLOSURES)
    cells.append((Cell("holds"), Cell(""), *map(aligned, held)))
    return Table(
        ("", "published", *CLOSURES),
        tuple(cells),
        f"Pocketing, open figures of {STUDY_SOURCE}, by models.pocketing",
        frozenset([len(rows)]),
        f"Sources: {'; '.join(dict.fromkeys(row.source for row in rows))}. Tolerances beyond the "
        f"band: {'; '.join(causes)}.",
    )


def settled_table(rows: Sequence[SettledFigure], estimates: Sequence[Estimate]) -> RenderableType:
    """One row for each figure of the loaded tests, one column for each model of temperatures."""
    heads = ("figure", "published", "inlet", "flank", "network", "network, range")
    title = "Loaded tests, load-dependent losses as tested"
    table = number_table(title, *heads, no_wrap=(False, True))
    for row in rows:
        table.add_row(
            f"{row.what}, {unit_text(row.unit)}",
            " to ".join(map(shown, row.published)) or MISSING,
            *map(shown, (row.inlet, row.flank, row.network)),
            f"{shown(row.low)} to {shown(row.high)}",
        )
    note = Text(
        "By models.temperatures; nothing was fitted to these tests, and no verdict is given. As "
        "tested: total loss less that without torque at the same speed and oil inlet "
        "temperature, each at its own temperatures. Range of the network:"
    )
    ranges = (
        Text(
            f"  {item.what}, {item.key}: {item.low} to {item.high}, {item.value} in the column "
            f"'network' ({item.origin})"
        )
        for item in estimates
    )
    return Group(table, note, *ranges)


def band_rows(rows: Sequence[MeasuredFigure]) -> list[tuple[str, ...]]:
    """Figure, measured, computed, its 95 % band, and whether the measurement lies inside."""
    return [
        (
            f"{row.what}, {unit_text(row.unit)}".rstrip(", "),
            shown(row.measured),
            shown(row.computed, 3),
            f"{shown(row.low, 3)} to {shown(row.high, 3)}",
            "inside" if row.is_inside else "outside",
        )
        for row in rows
    ]


def bands_table(rows: Sequence[MeasuredFigure]) -> RenderableType:
    """One row for each measured figure."""
    title = "Measured figures, and the 95 % band by the shipped distributions"
    heads = ("figure", "measured", "computed", "95 % band", "")
    table = number_table(title, *heads, no_wrap=(False, True))
    for cells in band_rows(rows):
        table.add_row(*cells)
    inside = sum(row.is_inside for row in rows)
    note = (
        f"{inside} of {len(rows)} measurements lie inside. Uncertainties of inputs and models are "
        "the defaults without [uncertainty], with the same errors in all tests. The band does "
        "not include the measurement error, and nothing was fitted."
    )
    return Group(table, Text(note))


SCORE_HEADS = ("", "grade", "n", "error", "bias", "speed", "load", "temp.", "inside")


def score_rows(scores: Sequence[Score]) -> Iterator[tuple[str, ...]]:
    """How near each run comes to its set; runs beside the defaults stand below these."""
    for score in scores:
        own, inside = score.set, score.inside
        trends = (score.trend(role) for role in ("speed", "load", "temperature"))
        yield (
            own.name if score.run == DEFAULTS else f"- {score.run}",
            own.file.grade if score.run == DEFAULTS else "",
            str(len(own.points)),
            percent(score.mean_error, 0),
            percent(score.bias, 0, signed=True),
            *(MISSING if math.isnan(trend) else f"{100 * trend:+z.0f}" for trend in trends),
            MISSING if inside is None else str(inside),
        )


def scores_table(scores: Sequence[Score]) -> RenderableType:
    """One row for each run of each set, what the columns are, and where the sets are from."""
    table = number_table("Measured by others, computed", *SCORE_HEADS, no_wrap=(True, True))
    for cells in score_rows(scores):
        table.add_row(*cells)
    grades = "; ".join(f"{grade}: {text}" for grade, text in GRADES.items())
    note = (
        f"{in_band(scores)} n: points. error: mean of |computed - measured|/measured, bias: the "
        "same with signs. speed, load, temp.: trend, the error at the highest less that at the "
        "lowest, in points. inside: values in the band of the shipped distributions. Nothing is "
        f"fitted. Grades: {grades}."
    )
    return Group(table, Text(note), *map(Text, source_lines(scores)))


def source_lines(scores: Sequence[Score]) -> Iterator[str]:
    """Where each set is from, how it was read, and what was guessed."""
    told: dict[str, list[str]] = {}
    for own in dict.fromkeys(score.set for score in scores):
        text = f"{own.file.source}: {own.file.read}. Guessed: {own.guessed}."
        told.setdefault(text, []).append(own.name)
    return (f"{'; '.join(names)}: {text}" for text, names in told.items())


def _difference(row: Comparison) -> str:
    return MISSING if math.isnan(row.computed) else percent(row.difference, signed=True)


def remarks(row: Comparison) -> list[str]:
    """Where a figure is printed, how it was inferred, why there is no verdict."""
    found = [row.source]
    if row.inferred:
        found.append(f"Inferred: {row.inferred}.")
    if row.reason:
        found.append(f"{_REASONS[row.role]}: {row.reason}.")
    if row.missed:
        found.append(f"Cause: {row.missed}.")
    return found


_REASONS = {"context": "No verdict", "calibration": "Calibrated"}


def verdict_text(row: Comparison) -> str:
    """The verdict with its tolerance, and a star if that was settled with the figure in view."""
    if row.role != "validation":
        return row.verdict
    seen = "*" if row.settled == "in view" else ""
    return f"{row.verdict} ({100 * row.tolerance:.2g} %{seen})"


MOST_ROWS = 8  # Most rows of one picture.
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
    verdicts: list[str] = [row.verdict for row in rows]
    closure_sections = [
        Section("closures", "Pocketing by every closure", (closure_table(closures),))
        for _ in closures[:1]
    ]
    return page_html(
        title="Published figures, computed",
        kind="Validation",
        operation=summary(rows, closures),
        source=f"Computed with epicyclic {versions()['epicyclic']}",
        key_figures=[
            KeyFigure(verdict, number(verdicts.count(verdict), "")) for verdict in _STYLES
        ],
        sections=[*comparison_sections(rows, progress), *closure_sections],
    )


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
        "* The tolerance was chosen with knowledge of the computed figure. Without a star it is "
        "the rounding of what is printed.",
        "Calibrated figures were used to find an unknown input; they and those without a verdict "
        "do not count.",
    )
    yield Section("signs", "Signs", (Listing(text),))


def _items(key: str, rows: Sequence[Comparison]) -> Iterator[Item]:
    """Pictures of like height, each below its table, which breaks and fills a printed page."""
    count = math.ceil(len(rows) / MOST_ROWS)
    height = math.ceil(len(rows) / count)
    for place in range(count):
        part = rows[place * height : (place + 1) * height]
        yield _table(part)
        name = f"{key}-{place + 1}" if count > 1 else key
        computed = [row for row in part if not math.isnan(row.computed)]
        if not computed:
            continue
        with styled_figure(1, 1, "", panel=deviations_size(computed)) as (figure, axes):
            ax = plot_deviations(computed, axes[0, 0])
        drawing = Drawing(name, "Computed over published", svg_text(figure, name), explorable(ax))
        yield Gallery((drawing,), is_wide=True)


def _table(rows: Sequence[Comparison]) -> Table:
    return Table(
        _HEAD,
        tuple(
            (
                Cell(f"{row.what}. {' '.join(remarks(row))}"),
                Cell(published_text(row), row.low),
                number(row.computed, ""),
                Cell(unit_text(row.unit), about="nowrap"),
                Cell(_difference(row), row.difference),
                Cell(verdict_text(row), about="nowrap"),
                Cell(row.cause),
            )
            for row in rows
        ),
        widths=_WIDTHS,
    )


# The report of a chapter of Talbot (2012), computed again: its figures, and what is published.


def influence_table(figures: Sequence[Reproduced]) -> Table:
    """What the source says of each parameter, beside the computed changes."""
    found = [it for item in figures for it in influences(item.number, item.data)]
    cells = [
        (
            Cell(f"{it.parameter} (Fig. {it.figure})"),
            Cell(f"{it.says} ({it.source})"),
            aligned(" to ".join(percent(end, 0, signed=True) for end in (it.least, it.most))),
            Cell(it.verdict),
        )
        for it in found
    ]
    note = (
        "Least and largest change of all that is drawn in a figure. The source classes no sizes: "
        "of its own numbers +40 % is modest (p. 78) and -19 % significant (p. 70)."
    )
    heads = ("from the first to the last value", "the source says", "computed change", "")
    return Table(heads, tuple(cells), "Influence of each parameter", note=note)


def chapter_html(chapter: str, figures: Sequence[Reproduced], rows: Sequence[Comparison]) -> str:
    """All figures of a chapter and its published numbers, as one page that needs nothing else."""
    drawings = tuple(
        Drawing(f"fig-{item.number}", f"Fig. {item.number}", svg_text(item.picture, key))
        for item in figures
        for key in (f"fig-{item.number.replace('.', '-')}",)
    )
    table = influence_table(figures)
    influence_sections = [Section("influences", "Parameters", (table,))] if table.rows else []
    return page_html(
        title=f"Talbot (2012), chapter {chapter}, computed again",
        kind="Reproduction",
        operation=summary(rows),
        source=f"Computed with epicyclic {versions()['epicyclic']}",
        key_figures=[KeyFigure("figures", number(len(drawings), ""))],
        sections=[
            Section("figures", "Figures", (Gallery(drawings, is_wide=True),), _LEAD),
            *influence_sections,
            *comparison_sections(rows),
        ],
    )


_LEAD = (
    "Curves are computed. Markers and lines show the numbers printed in the text of the source; "
    "its curves were not digitised. Numbers that cannot be marked are in the tables below."
)
