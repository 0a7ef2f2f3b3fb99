"""The first screen of a result: what an engineer reads before anything else."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

from rich.console import RenderableType
from rich.constrain import Constrain

from epicyclic.build.result import NOT_INCLUDED, UNCOVERED
from epicyclic.losses.ranges import concern_text, found_text, limits_text, weight_of
from epicyclic.machine.element import note_watts
from epicyclic.machine.planets import MAY_LOSE
from epicyclic.messages import sentence
from epicyclic.result.result import Result, in_words
from epicyclic.show.page import Drawings, KeyFigure, Listing, Row, Section, Table, gallery
from epicyclic.show.result_tables import key_figures, locking_text, losses_table, sums_table
from epicyclic.show.terminal import as_on_page, spaced
from epicyclic.study.bands.advice import Known, is_on_first_screen, main_causes
from epicyclic.study.heat import hottest
from epicyclic.study.operating import operating_line
from epicyclic.units import celsius_text, efficiency_text, known_text, percent

MOST_WARNINGS = 3  # On the first screen.
CONCERNED = 0.01  # Part of the total loss from which a warning stands on the first screen. [1]
MOST_OF_SET = 10  # Losses of a single set; smaller ones are in the sums alone.
MOST_ROWS = 20  # Of the losses of a train; smaller ones are put together.
_BROAD = 0.5  # Part of the loss outside the ranges of its models from which that is said first. [1]
WIDTH = 80  # Characters of its lines at most.
_NEXT = "More: run --details (all figures and warnings), friction, uncertainty, report."
_LABEL, _VALUE = 14, 12  # Characters.
_ADJUSTED = re.compile(r"[\w.]+ = .+?: ")  # A value that a list of its own tells.
_END_OF_SENTENCE = re.compile(r"(?<=\w[\w)])\. (?=[A-Z])")


def first_screen(result: Result, known: Known | None) -> RenderableType:
    """What is read first, in at most 40 lines of 80 columns, of a train 55."""
    head = (result.title or result.kind, operating_line(result.inputs["operation"]))
    lines = "\n".join(headline(result, known))
    items: tuple[Table | Listing, ...] = (loss_summary(result), *first_lists(result, known))
    return Constrain(spaced("\n".join(head), lines, *map(as_on_page, items), _NEXT), WIDTH)


def head_figures(result: Result, known: Known | None) -> Iterator[KeyFigure]:
    """The numbers at the head of a result, with their bands and as many digits as these leave."""
    ends = {} if known is None else known.ends
    for it in key_figures(result):
        text, band = it.text, ""
        if it.cell.key == "efficiency" and ends.get("efficiency", (0.0, 0.0))[1] > 0:
            own = ends["efficiency"]
            text = efficiency_text(result.efficiency or 0.0, ends=own)
            band = efficiency_text(*own, ends=own)
        elif it.cell.key == "total" and "total" in ends:
            text = known_text(result.total, beside=ends["total"][1])
            band = known_text(*ends["total"], beside=result.total)
        number, _, unit = text.partition(" ")
        yield replace(it, cell=replace(it.cell, text=number), unit=unit, band=band)


def headline(result: Result, known: Known | None) -> Iterator[str]:
    """Ratio, efficiency and loss with their bands, power and hottest part, a line each."""
    limit = " of what the models cover" if any(UNCOVERED in note for note in result.notes) else ""
    for it in head_figures(result, known):
        if it.cell.key in ("load_dependent", "load_independent"):
            continue  # the table has them
        band = f"95 % band {it.band}{limit}" if it.band else ""
        yield f"{it.label:{_LABEL}}{it.text:{_VALUE}}{band}".rstrip()
    if result.heat is not None:
        node = hottest(result.heat)
        degrees = celsius_text(result.heat.temperatures[node], 3)
        yield f"{'hottest part':{_LABEL}}{degrees:{_VALUE}}{in_words(node)}"


def loss_summary(result: Result) -> Table:
    """What loses, by component; of a train by set and part, with small ones together."""
    if result.train is None:
        return losses_table(result, most=MOST_OF_SET)
    return sums_table(result, result.train, most=MOST_ROWS)


def first_lists(result: Result, known: Known | None) -> Iterator[Listing]:
    """What is missing or outside every model, and what weighs most; nothing if nothing is."""
    for found in (Listing(tuple(first_remarks(result, known))), first_warnings(result)):
        if found.items:
            yield found


def first_remarks(result: Result, known: Known | None) -> Iterator[str]:
    """What the loss is without, what its band is due to, and what the standard gives."""
    if result.train is not None and (locking := locking_text(result.train)):
        yield locking
    yield from _left_out(result)
    yield from (text for _, text in _notes(result) if MAY_LOSE in text)
    outside = _outside(result)
    if outside >= _BROAD:
        yield (
            f"{percent(min(outside, 1.0), 0)} of the loss is computed outside the ranges of its "
            "models and is only an estimate."
        )
    if known is None or not known.width:
        return
    yield f"Main causes of the band: {main_causes(known)}."
    yield from filter(is_on_first_screen, known.remarks)


def _left_out(result: Result) -> Iterator[str]:
    """Which sets are without which losses, and why."""
    own: dict[tuple[str, str], list[str]] = {}
    for term in result.terms:
        if term.left_out:
            owner, _, last = term.name.rpartition(".")
            own.setdefault((term.left_out, owner), []).append(in_words(last))
    found: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for (reason, owner), terms in own.items():
        found.setdefault((reason, tuple(terms)), []).append(owner)
    for (reason, names), owners in found.items():
        of = f" of {', '.join(owners)}" if any(owners) else ""
        yield f"{NOT_INCLUDED}: {', '.join(names)}{of} ({reason})."


def _outside(result: Result) -> float:
    """Largest part of the total loss that one quantity leaves outside the range of its models."""
    watts = (watts for watts, _ in result.flags_with_loss if math.isfinite(watts))
    return max(watts, default=0.0) / result.total if result.total else 0.0


def _notes(result: Result, *, whole: bool = False) -> Iterator[tuple[float, str]]:
    """Notes with the affected watts, in short or `whole`; those of several sets are one."""
    stages = {in_words(key.rpartition(".")[0]) for key in result.losses}
    owners: dict[str, list[str]] = {}
    watts: dict[str, float] = {}
    for note in result.notes:
        if note.startswith(NOT_INCLUDED) or _ADJUSTED.match(note):
            continue
        owner, colon, text = note.partition(": ")
        if not colon or owner.replace("_", " ") not in stages:
            owner, text = "", note
        if not whole:
            text = _END_OF_SENTENCE.split(text)[0].rstrip(".") + "."
        owners.setdefault(text, []).append(owner)
        watts[text] = watts.get(text, 0.0) + note_watts(note)
    for text, names in owners.items():
        yield watts[text], f"{', '.join(names)}: {text}" if any(names) else sentence(text)


def first_warnings(result: Result) -> Listing:
    """The warnings that concern most of the loss, in short; nothing if none matters."""
    found = [it for it in _notes(result) if MAY_LOSE not in it[1]]
    for watts, group in result.flags_with_loss:
        uses = [*dict.fromkeys(f"{in_words(flag.use.role)} {flag.use.model}" for flag in group)]
        names = " and ".join(filter(None, (", ".join(uses[:-1]), uses[-1])))
        first, only = group[0], limits_text(group[0])
        only = only if None in (first.low, first.high) else f"from {only}"
        size = "" if math.isnan(watts) else f"; this affects {concern_text(watts, group)}"
        text = (
            f"The {first.quantity} is {found_text(group)}, but {names} "
            f"{'are' if len(uses) > 1 else 'is'} valid only {only}{size}."
        )
        found.append((weight_of(watts, group), text))
    heavy = [pair for pair in found if pair[0] >= CONCERNED * result.total and pair[0] > 0]
    heavy.sort(key=lambda pair: -pair[0])
    shown = tuple(text for _, text in islice(heavy, MOST_WARNINGS))
    count, many = len(all_warnings(result)), len(shown) > 1
    counted = f" ({len(shown)} of {count}, most serious first)" if len(shown) < count else ""
    return Listing(shown, f"Warning{'s' * (many or bool(counted))}{counted}")


def all_warnings(result: Result) -> tuple[str, ...]:
    """Every warning in full, by the names of what it concerns."""
    notes = (text for _, text in _notes(result, whole=True))
    return (*_left_out(result), *notes, *result.warnings[len(result.notes) :])


def summary_section(result: Result, known: Known | None, drawings: Drawings) -> Section:
    """What is read first, as on the first screen of the command."""
    row = Row((loss_summary(result), *gallery(drawings, "losses")))
    return Section("summary", "Summary", (row, *first_lists(result, known)))
