"""All figures of a result on the terminal, and friction models side by side."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence

from rich.columns import Columns
from rich.console import Group, RenderableType
from rich.text import Text

from epicyclic.losses.ranges import share_text
from epicyclic.messages import sentence
from epicyclic.result.result import Result, in_words
from epicyclic.show import page
from epicyclic.show import result_tables as tables
from epicyclic.show.summary import all_warnings
from epicyclic.show.terminal import as_on_page, listed, number_table, spaced, titled
from epicyclic.study.friction import FrictionComparison, recommended
from epicyclic.study.operating import operating_line


def result_tables(
    result: Result,
    remarks: Sequence[str] = (),  # On its temperatures.
    # How well the total loss and the efficiency are known.
    known: Sequence[str | page.Listing] = (),
    more: Iterable[page.Table | page.Listing] = (),  # Tables and lists of plug-ins.
) -> RenderableType:
    """Everything that is known of a result: losses, figures, warnings, sources."""
    parts: list[RenderableType] = [_headline(result)]
    parts += [it if isinstance(it, str) else as_on_page(it) for it in known]
    parts += map(as_on_page, tables.standing_items(result))
    parts += map(as_on_page, _tables(result))
    if result.heat is not None:
        parts += map(as_on_page, tables.heat_items(result.heat))
    parts += remarks
    parts += map(as_on_page, (*tables.oil_table(result), *tables.planets_table(result)))
    parts += map(as_on_page, more)
    parts += [as_on_page(_methods(result)), listed("Warnings", all_warnings(result))]
    return titled(result.title or result.kind, *parts, listed("Sources", result.sources))


def _headline(result: Result) -> Group:
    """Operating point and key figures."""
    lines: list[RenderableType] = [
        Text(operating_line(result.inputs["operation"])),
        Columns([f"{one.label} {one.text}" for one in tables.key_figures(result)], padding=(0, 3)),
    ]
    if result.train and (locking := tables.locking_text(result.train)):
        lines.append(Text(locking, style="bold"))
    return Group(*lines)


def _tables(result: Result) -> Iterator[page.Table]:
    """Losses and figures of a set or train."""
    if (train := result.train) is not None:
        yield from (
            tables.sums_table(result, train),
            tables.shafts_table(result),
            tables.rolling_table(result, train),
        )
        yield from tables.clutches_table(train)
        yield from tables.terms_table(result, train)
    else:
        yield from (tables.losses_table(result), tables.members_table(result))
    yield from tables.mesh_tables(result)
    yield from tables.bearing_tables(result)
    yield from tables.part_tables(result)


def _methods(result: Result) -> page.Listing:
    """Which method computed which terms, each method once."""
    users: dict[str, list[str]] = {}
    for name, method in result.methods.items():
        users.setdefault(method, []).append(name)
    items = tuple(f"{tables.users_text(names)}: {how}" for how, names in users.items())
    return page.Listing(items, "Methods")


def friction_table(rows: Sequence[FrictionComparison]) -> RenderableType:
    """Friction models side by side, with the spread, what they leave, and which one suits."""
    meshes = list(rows[0].mean_friction)
    if all(math.isnan(row.mean_friction[mesh]) for row in rows for mesh in meshes):
        return Text("Without load or motion nothing slides, so there is no friction to compare.")
    columns = [f"μ {in_words(mesh)}" for mesh in meshes]
    heads = ("sliding W", "quick W", "over chosen", "out of range")
    table = number_table("Friction models", "", *columns, *heads)
    chosen = next((row.sliding for row in rows if row.chosen), 0.0)
    for row in rows:
        outside = share_text(row.outside) if row.reasons else ""
        table.add_row(
            row.name,
            *(f"{row.mean_friction[mesh]:z.4f}" for mesh in meshes),
            f"{row.sliding:z.1f}",
            f"{row.quick:z.1f}",
            f"{row.sliding / chosen:.2f}" if chosen else "",
            f"{outside} *" if row.other_oil else outside,
            style="bold" if row.chosen else "",
        )
    low, high = min(row.sliding for row in rows), max(row.sliding for row in rows)
    quick = Text(
        "sliding: local, along the contact lines; quick: mean friction times loss factor; chosen: "
        f"{', '.join(row.name for row in rows if row.chosen) or 'several models'}; out of range: "
        "share of the sliding loss; *: made for another oil"
    )
    spread = Text(
        f"Spread: {low:.1f} to {high:.1f} W" + (f", a factor of {high / low:.2f}." if low else ".")
    )
    best, why = recommended(rows)
    return spaced(
        Group(table, quick, spread),
        Text.assemble(
            ("Recommended: ", "bold"), f"{best.name}, because {why}. {sentence(best.standing)}"
        ),
        listed("Out of range, and for another oil", [it for row in rows for it in _left(row)]),
        listed("Reliability of the models", [f"{row.name}: {row.standing}" for row in rows]),
        listed("Sources", [f"{row.name}: {row.title}, {row.source}" for row in rows]),
    )


def _left(row: FrictionComparison) -> list[str]:
    """Why a model does not suit, and by how much."""
    other = [f"{row.name}: made for {row.other_oil}"] if row.other_oil else []
    return [*other, *(f"{row.name}, {reason}" for reason in row.reasons)]
