"""How well a result is known, in tables: for terminals and pages."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from rich.console import RenderableType

from epicyclic.case.messages import one_line
from epicyclic.report.advice import LIMITS, advice_texts, driver_name
from epicyclic.report.map_band_tables import map_band_tables
from epicyclic.report.page import Cell, KeyFigure, Listing, Table, aligned, number, tenths
from epicyclic.report.shown import shown
from epicyclic.report.tables import as_on_page, titled
from epicyclic.results.result import in_words
from epicyclic.study.bands.advice import known_of
from epicyclic.units import known_text, percent, unit_text

if TYPE_CHECKING:
    import xarray as xr

LEAST = 0.005
"""Share in the variance from which an input or a model is named. [1]"""
NO_SHARE = 1e-3
"""Share in the variance of a loss below which curves through samples show no effect. [1]"""
CUT_OFF = 1e-3
"""Probability of impossible values that is worth a sentence. [1]"""


def uncertainty_tables(data: xr.Dataset) -> RenderableType:
    """All of a dataset of `epicyclic.uncertainty`, for a terminal."""
    return titled(one_line(data.attrs["title"]), *map(as_on_page, uncertainty_items(data)))


def uncertainty_items(data: xr.Dataset) -> Iterator[Table | Listing]:
    """Results with their bands, the budget of the total loss, and what to know of it."""
    if "explained" in data:
        yield from map_band_tables(data)
    else:
        yield _results(data)
        yield _budget(data)
        yield Listing(tuple(advice_texts(known_of(data))), LIMITS)
    yield Listing(tuple(_notes(data)), "Notes")


def pair_tables(data: xr.Dataset) -> RenderableType:
    """All of a dataset of `epicyclic.compare_cases`, for a terminal."""
    rows = []
    names = [str(name) for name in data["result"].values]
    for name in names:
        one = data.sel(result=name)
        unit = str(one["unit"].values)
        cells = (
            _shown(float(one[key]), unit)
            for key in ("first", "second", "difference", "standard_uncertainty", "low", "high")
        )
        chance = aligned(percent(float(one["probability"])))
        rows.append((Cell(in_words(name) + (", %" if unit == "1" else "")), *cells, chance))
    strong = frozenset({names.index("total"), names.index("efficiency")})
    head = ("", "first", "second", "mean difference", "u", "95 % from", "to", "second smaller")
    title = f"{data.attrs['second_title']} less {data.attrs['first_title']}"
    table = Table(head, tuple(rows), "Second less first", strong, "Losses in W.")
    total = data.sel(result="total")
    notes = [
        f"Shared: {data.attrs['shared'] or 'nothing'}.",
        f"Total loss: u of the difference {known_text(float(total['standard_uncertainty']))}; of "
        "two results that know nothing of each other "
        f"{known_text(float(total['unpaired_uncertainty']))}.",
    ]
    if data.attrs["failed"]:
        notes.append(f"{data.attrs['failed']} of {data.attrs['pairs']} pairs have no result.")
    return titled(one_line(title), as_on_page(table), as_on_page(Listing(tuple(notes), "Notes")))


def band_figures(data: xr.Dataset) -> list[KeyFigure]:
    """The ends of the band, for the head of a page."""
    found = []
    for name, label in (("total", "lost"), ("efficiency", "efficiency")):
        one = data.sel(result=name)
        unit = str(one["unit"].values)
        for key, end in (("low", "from"), ("high", "to")):
            value = float(one[key])
            if math.isfinite(value):
                shown_unit = "%" if unit == "1" else unit
                found.append(KeyFigure(f"{label} {end}", _shown(value, unit), shown_unit))
    return found


def _results(data: xr.Dataset) -> Table:
    rows = []
    names = [str(name) for name in data["result"].values]
    for name in names:
        one = data.sel(result=name)
        values = (
            _shown(float(one[key]), str(one["unit"].values))
            for key in ("nominal", "mean", "standard_uncertainty", "expanded_uncertainty",
                        "low", "high", "shortest_low", "shortest_high")
        )  # fmt: skip
        further = ", %" if name == "efficiency" else ""
        if name in ("load_dependent", "load_independent"):
            further = data.attrs["grouping"]
        rows.append((Cell(in_words(name) + further), *values))
    strong = frozenset({names.index("total"), names.index("efficiency")})
    head = ("", "case", "mean", "u_c", "U", "95 % from", "to", "shortest", "to")
    what = "Losses" if _unit(data) == "W" else "Energies"
    note = f"u_c: combined standard uncertainty; U = 2 u_c. {what} in {_unit(data)}."
    return Table(head, tuple(rows), "Results with their uncertainty", strong, note)


def _unit(data: xr.Dataset) -> str:
    """Unit of losses, or of energies lost."""
    return str(data["unit"].sel(result="total").values)


def _shown(value: float, unit: str) -> Cell:
    """A number as precise as such numbers are."""
    if math.isnan(value):
        return number(None, "")
    if unit == "W":
        return tenths(value)
    return number(value, "", text=f"{100 * value:z.3f}" if unit == "1" else shown(value, 5))


def _budget(data: xr.Dataset) -> Table:
    """What makes the variance of the total loss, the largest share first."""
    total = data.sel(result="total", sum="total")
    orders = [name for name in ("first_order", "total_order") if name in data]
    largest = total[orders[-1]]
    order = largest.sortby(-largest)["driver"].values
    rows = []
    for driver in map(str, order):
        keys = driver.split(" + ")
        if not total["contribution"].sel(input=keys).any():
            continue
        one = total.sel(driver=driver)
        shares = [percent(max(float(one[name]), 0.0)) for name in orders]
        for place, key in enumerate(keys):
            own = total.sel(input=key)
            rows.append(
                (
                    Cell(driver_name(key)),
                    Cell(str(own["distribution"].values)),
                    _value(own),
                    _shown(float(own["contribution"]), _unit(data)),
                    *(aligned("" if place else text) for text in shares),
                )
            )
    heads = ("", "distribution", "value", f"per u_i, {_unit(data)}", "share", "with others")
    note = (
        "per u_i: change of the total loss for one standard deviation. Shares of its variance, "
        "alone and with all interactions; values that are correlated share one."
    )
    if len(orders) == 1:
        note = note.replace("alone and with all interactions; ", "each alone; ")
    head = heads[: len(heads) + len(orders) - 2]
    return Table(head, tuple(rows), "What the uncertainty of the total loss is due to", note=note)


def _value(own: xr.Dataset) -> Cell:
    unit = unit_text(str(own["input_unit"].values)).removesuffix("1")
    return aligned(f"{shown(float(own['input_value']))} {unit}".rstrip())


def _notes(data: xr.Dataset) -> Iterator[str]:
    failed, count = int(data.attrs["failed"]), data.sizes["sample"]
    if failed and "failed_samples" in data:
        yield (
            f"{failed} samples at {int((data['failed_samples'] > 0).sum())} points have no result "
            "and are left out of their intervals."
        )
    elif failed:
        reason = next(str(text) for text in data["message"].values if text)
        yield (
            f"{failed} of {count} samples have no result and are left out of the intervals; for "
            f"example: {reason}"
        )
    if data.attrs.get("left_out"):
        yield (
            f"Left out, because one standard deviation away there is no solution: "
            f"{data.attrs['left_out']}."
        )
    for key in map(str, data["input"].values):
        share = float(data["cut_off"].sel(input=key))
        if share > CUT_OFF:
            beyond = percent(share)
            yield f"{key}: {beyond} of its distribution is beyond what it can be, and cut off."
    idle = [str(key) for key in data["input"].values if not _moves(data, str(key))]
    if idle:
        yield f"Without effect here: {', '.join(idle)}."
    yield from _of_points(data)
    sources: dict[str, list[str]] = {}
    for key in sorted(set(map(str, data["input"].values)) - set(idle)):
        source = str(data["distribution_source"].sel(input=key).values)
        sources.setdefault(source, []).append(driver_name(key))
    for source, keys in sources.items():
        yield f"{', '.join(keys)}: {source}."


def _moves(data: xr.Dataset, key: str) -> bool:
    """Whether an input changes any result."""
    if "contribution" in data:
        return bool(data["contribution"].sel(input=key).any())
    driver = next(name for name in map(str, data["driver"].values) if key in name.split(" + "))
    return bool((data["total_order"].sel(driver=driver) > NO_SHARE).any())


def _of_points(data: xr.Dataset) -> Iterator[str]:
    """How well some points stand for a whole cycle."""
    if "point_error" not in data:
        return
    error, spread = (
        float(data["point_error"]),
        float(data["standard_uncertainty"].sel(result="total")),
    )
    if not error:
        yield f"Cycle: {data.attrs['cycle']}, all solved with every sample."
    else:
        yield (
            f"Cycle: {data.attrs['cycle']}; {data.attrs['points']} points stand for it, by which "
            f"u_c of the total may be off by {percent(error / spread, 0)} (standard error)."
        )
    yield (
        "Shares by curves through the samples, which explain "
        f"{percent(float(data['curves_explain']))} of the variance of the total."
    )
