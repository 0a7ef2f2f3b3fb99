"""Tables of results, libraries and comparisons for a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from rich import box
from rich.columns import Columns
from rich.console import Console, Group, JustifyMethod, RenderableType
from rich.padding import Padding
from rich.text import Text

from epicyclic.case.messages import sentence
from epicyclic.losses.ranges import share_text
from epicyclic.records.contents import ResultContents, contents_of
from epicyclic.report import page
from epicyclic.report.fitting import FittedTable
from epicyclic.report.heat_tables import heat_items
from epicyclic.report.result_tables import (
    Labels,
    bearing_tables,
    key_figures,
    losses_table,
    members_table,
    mesh_tables,
    oil_table,
    planets_table,
    standing_items,
    users_text,
)
from epicyclic.report.train_tables import (
    clutches_table,
    locking_text,
    part_tables,
    rolling_table,
    shafts_table,
    sums_table,
    terms_table,
)
from epicyclic.results.result import Result, number_fields
from epicyclic.study.friction import FrictionComparison, recommended
from epicyclic.study.operating import operating_line

PIPE_WIDTH = 100
"""Width of tables that do not go to a terminal. [characters]"""


def terminal() -> Console:
    """The console for results, on standard output."""
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=PIPE_WIDTH)


def result_tables(
    result: Result,
    remarks: Sequence[str] = (),  # On its temperatures.
    # How well the total loss and the efficiency are known.
    known: Sequence[str | page.Listing] = (),
) -> RenderableType:
    """Everything an engineer reads first: losses, figures, warnings, sources."""
    contents = contents_of(result)
    labels = {field.key: field.label for field in number_fields(result.layout)}
    parts: list[RenderableType] = [_headline(contents)]
    parts += [it if isinstance(it, str) else as_on_page(it) for it in known]
    parts += map(as_on_page, standing_items(contents))
    parts += map(as_on_page, _tables(contents, labels))
    if result.heat is not None:
        parts += map(as_on_page, heat_items(result.heat))
    parts += remarks
    parts += map(as_on_page, (*oil_table(contents, labels), *planets_table(contents)))
    parts += [_methods(contents), _list("Warnings", contents.warnings)]
    return titled(result.title or result.kind, *parts, _list("Sources", contents.sources))


def _headline(contents: ResultContents) -> Group:
    """Operating point and key figures."""
    found = [f"{one.label} {one.cell.text} {one.unit}".rstrip() for one in key_figures(contents)]
    lines: list[RenderableType] = [
        Text(operating_line(contents.inputs["operation"])),
        Columns(found, padding=(0, 3)),
    ]
    if locking := locking_text(contents):
        lines.append(Text(locking, style="bold"))
    return Group(*lines)


def _tables(contents: ResultContents, labels: Labels) -> Iterator[page.Table]:
    """Losses and figures of a set or train."""
    if contents.kind == "train":
        yield from (sums_table(contents), shafts_table(contents), rolling_table(contents))
        yield from clutches_table(contents)
        yield from terms_table(contents)
    else:
        yield from (losses_table(contents), members_table(contents))
    yield from mesh_tables(contents, labels)
    yield from bearing_tables(contents, labels)
    yield from part_tables(contents, labels)


def titled(title: str, *parts: RenderableType) -> RenderableType:
    """Parts with space between them, under a title."""
    whole = (Text(title, style="bold"), *(Text(it) if isinstance(it, str) else it for it in parts))
    return Group(*(Padding(part, (0, 0, 1, 0)) for part in whole))


def as_on_page(item: page.Table | page.Listing) -> RenderableType:
    """A table or list of a report, for a terminal."""
    if isinstance(item, page.Listing):
        return _list(item.title, item.items)
    table = plain_table(item.title)
    for column, head in enumerate(item.head):
        table.add_column(head, justify="right" if item.is_numeric(column) else "left")
    for place, row in enumerate(item.rows):
        strong = place in item.strong
        table.add_row(
            *(cell.text for cell in row),
            style="bold" if strong else "",
            end_section=strong or item.strong == {place + 1},
        )
    return Group(table, Text(item.note)) if item.note else table


def _methods(contents: ResultContents) -> Group:
    """Which method computed which terms, each method once."""
    users: dict[str, list[str]] = {}
    for name, method in contents.methods.items():
        users.setdefault(method, []).append(name)
    return _list("Methods", [f"{users_text(names)}: {how}" for how, names in users.items()])


def _list(title: str, items: Sequence[str]) -> Group:
    if not items:
        return Group(Text(f"{title}: none"))
    lines = [Padding(Text(f"• {item}"), (0, 0, 0, 2)) for item in items]
    return Group(Text(title, style="bold"), *lines)


def plain_table(title: str) -> FittedTable:
    """An empty table in the style of the package."""
    return FittedTable(
        title=title,
        title_justify="left",
        title_style="bold",
        header_style="",
        box=box.SIMPLE_HEAD,
        pad_edge=False,
    )


def number_table(
    title: str, *columns: str, no_wrap: tuple[bool, bool] = (False, False)
) -> FittedTable:
    """An empty table of names, in its first column, and numbers; `no_wrap` of which of both."""
    table = plain_table(title)
    for place, column in enumerate(columns):
        is_number = place > 0
        justify: JustifyMethod = "right" if is_number else "left"
        table.add_column(column, justify=justify, no_wrap=no_wrap[is_number])
    return table


def friction_table(rows: Sequence[FrictionComparison]) -> RenderableType:
    """Friction models side by side, with the spread, what they leave, and which one suits."""
    meshes = list(rows[0].mean_friction)
    if all(math.isnan(row.mean_friction[mesh]) for row in rows for mesh in meshes):
        return Text("There is no load or no motion: nothing slides, and no friction to compare.")
    columns = [f"μ {mesh.replace('_', ' ').replace('.', ': ')}" for mesh in meshes]
    table = number_table("Friction models", "", *columns, "sliding W", "quick W", "to chosen", "")
    table.columns[-1].justify = "left"
    chosen = next((row.sliding for row in rows if row.chosen), 0.0)
    for row in rows:
        outside = f"out of range {share_text(row.outside)}"
        known = (("chosen", row.chosen), (outside, row.flagged), ("other oil", row.other_oil))
        table.add_row(
            row.name,
            *(f"{row.mean_friction[mesh]:z.4f}" for mesh in meshes),
            f"{row.sliding:z.1f}",
            f"{row.quick:z.1f}",
            f"{row.sliding / chosen:.2f}" if chosen else "",
            ", ".join(mark for mark, holds in known if holds),
            style="bold" if row.chosen else "",
        )
    low, high = min(row.sliding for row in rows), max(row.sliding for row in rows)
    quick = Text(
        "sliding: local, along the contact lines; quick: mean friction times loss factor; out of "
        "range: share of the sliding loss"
    )
    spread = Text(
        f"Spread: {low:.1f} to {high:.1f} W" + (f", a factor of {high / low:.2f}." if low else ".")
    )
    best, why = recommended(rows)
    advice = Text.assemble(
        ("Recommended: ", "bold"), f"{best.name}: {why}. {sentence(best.standing)}"
    )
    lists = [
        _list("Out of range, and for another oil", [it for row in rows for it in _left(row)]),
        _list("How well they are known", [f"{row.name}: {row.standing}" for row in rows]),
        _list("Sources", [f"{row.name}: {row.title}, {row.source}" for row in rows]),
    ]
    spaced = (part for item in lists for part in (Text(), item))
    return Group(table, quick, spread, Text(), advice, *spaced)


def _left(row: FrictionComparison) -> list[str]:
    """Why a model does not suit, and by how much."""
    other = [f"{row.name}: made for {row.other_oil}"] if row.other_oil else []
    return [*other, *(f"{row.name}, {reason}" for reason in row.reasons)]
