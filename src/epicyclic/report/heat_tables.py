"""Temperatures and the heat balance, as tables of pages and terminals, and what they mean."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from epicyclic.case.case import Case
from epicyclic.case.messages import sentence
from epicyclic.errors import ConvergenceError
from epicyclic.report.page import Cell, Listing, Table, number, tenths
from epicyclic.results.heat import HeatBalance, HeatWay
from epicyclic.results.result import Result, in_words
from epicyclic.study.heat import (
    BeyondRange,
    Found,
    beyond_range,
    hottest,
    takes_minutes,
    with_warm_flanks,
    without_holding,
)
from epicyclic.units import CELSIUS, format_number, percent, unit_text

NOT_LOOKED_AT = (
    "How warm the flanks get was not looked at: with models.friction = ehl-direct that takes "
    "minutes. Ask with models.temperatures = flank."
)


def _temperatures(heat: HeatBalance) -> Table:
    """Temperatures of all parts, from the hottest, and the heat that losses bring to them."""
    brought = heat.brought
    places = dict.fromkeys(heat.temperatures, "temperatures") | dict.fromkeys(heat.given, "given")
    known = {**heat.temperatures, **heat.given}
    rows = []
    for node in sorted(known, key=lambda node: (node in heat.given, -known[node])):
        value = CELSIUS.to_display(known[node])
        rows.append(
            (
                Cell(in_words(node)),
                number(value, f"heat.{places[node]}.{node}.value", text=f"{value:.1f}"),
                tenths(known[node] - heat.oil),
                tenths(brought[node]) if node in brought else Cell(""),
            )
        )
    note = (
        "Temperatures of gears are those of their bodies; where a part is not listed, it is as "
        "warm as the oil, which takes its heat."
    )
    head = ("", unit_text(CELSIUS.display), "over the oil, K", "heat of losses, W")
    return Table(head, tuple(rows), "Temperatures", note=note)


def _balance(heat: HeatBalance) -> Table:
    """Where the heat leaves the gearbox."""
    whole = sum(way.watts for way in heat.outlets)
    rows = [
        (Cell(_end(way)), Cell(way.method), *_shared(way.watts, whole, f"heat.ways.{way.key}.heat"))
        for way in heat.outlets
    ]
    rows.append((Cell("all losses"), Cell(""), *_shared(whole, whole, "")))
    strong = frozenset([len(rows) - 1])
    return Table(("", "", "W", "of all"), tuple(rows), "Where the heat leaves", strong)


def _end(way: HeatWay) -> str:
    return f"{in_words(way.hot)} to {in_words(way.into)}"


def _shared(watts: float, whole: float, key: str) -> tuple[Cell, Cell]:
    share = percent(watts / whole) if whole else ""
    return tenths(watts, key), Cell(share, math.nan)


def ways_items(heat: HeatBalance) -> tuple[Table | Listing, ...]:
    """Every way of the heat, and where its conductance is from."""
    rows = tuple(
        (
            Cell(way.key),
            Cell(in_words(way.hot)),
            Cell(in_words(way.into)),
            tenths(way.watts, f"heat.ways.{way.key}.heat"),
            number(
                None if math.isnan(way.conductance) else way.conductance,
                f"heat.ways.{way.key}.conductance",
            ),
            Cell(way.method),
        )
        for way in heat.ways
    )
    methods: dict[str, set[str]] = {}
    for way in heat.ways:
        methods.setdefault(way.method, set()).add(way.source or "given")
    return (
        Table(("", "from", "to", "W", "W/K", "method"), rows, "Paths of the heat", note=_SIGN),
        Listing(
            tuple(f"{method}: {'; '.join(sorted(found))}" for method, found in methods.items()),
            "Sources of the conductances",
        ),
    )


_SIGN = (
    "Negative heat flows the other way. thermal.conductances changes a way by the name in the "
    "first column."
)


def heat_items(heat: HeatBalance) -> Iterator[Table]:
    """What every result states about its heat."""
    yield _temperatures(heat)
    if heat.ways:
        yield _balance(heat)


def found_text(found: Found) -> str:
    """What leads to the temperature that was asked for."""
    text = f"{found.key} = {unit_text(found.unit.text(found.value))}"
    power = found.result.input_power
    also = f", input power {power:.6g} W," if found.key == "operation.torque" else ""
    return f"With {text}{also} the oil is at {unit_text(CELSIUS.text(found.temperature))}."


def remarks(case: Case, result: Result) -> Iterator[str]:
    """What other temperatures, and oil that is not held in a range, would change."""
    if takes_minutes(result):
        if result.heat is None:
            yield NOT_LOOKED_AT
        return
    if result.heat is None and any(mesh.contact is not None for mesh in result.meshes.values()):
        yield _flank_text(result, _or_reason(with_warm_flanks, case))
    beyond = beyond_range(case, result)
    if beyond is not None:
        yield _beyond_text(beyond, _or_reason(without_holding, case))


def _or_reason(look: Callable[[Case], Result], case: Case) -> Result | str:
    """A further result of a case, or why there is none."""
    try:
        return look(case)
    except ConvergenceError as error:
        return sentence(str(error), capital=False)


def _flank_text(result: Result, warm: Result | str) -> str:
    if isinstance(warm, str):
        return f"With models.temperatures = flank there is no result: {warm}"
    assert warm.heat is not None
    node = hottest(warm.heat)
    kelvin = warm.heat.temperatures[node]
    return (
        f"With models.temperatures = flank the {in_words(node)} would be at "
        f"{CELSIUS.to_display(kelvin):.0f} {unit_text(CELSIUS.display)}, "
        f"{kelvin - warm.heat.oil:.0f} K above the oil; the total would be "
        f"{_total(warm.total, result.total)}."
    )


def _total(watts: float, before: float) -> str:
    return f"{watts:.0f} W ({percent(watts / before - 1, signed=True)})"


def _beyond_text(beyond: BeyondRange, free: Result | str) -> str:
    low, high = (format_number(limit) for limit in (beyond.low, beyond.high))
    unit = unit_text(CELSIUS.display)
    text = (
        f"{100 * beyond.share:.0f} % of the load-dependent loss arises in contacts whose oil is "
        f"hotter than the range of its formula ({low} to {high} {unit}), where it is held at "
        f"{high} {unit}; without holding "
    )
    if isinstance(free, str):
        return f"{text}there is no result: {free}"
    return f"{text}the total would be {free.total:.0f} W."
