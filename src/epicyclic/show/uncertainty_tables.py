"""How well a result is known, in sentences and tables."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import RenderableType

from epicyclic.messages import one_line
from epicyclic.result.result import Result, in_words
from epicyclic.show.page import MISSING, Cell, KeyFigure, Listing, Table, aligned, number, shown
from epicyclic.show.terminal import as_on_page, listed, titled
from epicyclic.study.bands.advice import (
    MOST_DRIVERS,
    Known,
    in_few_words,
    known_of,
    limits_of,
    main_causes,
    mean_shares,
    measurements_of,
    unit_of,
)
from epicyclic.units import (
    decimals_of,
    efficiency_text,
    format_number,
    known_text,
    percent,
    unit_text,
)

if TYPE_CHECKING:
    import xarray as xr

LIMITS = "Limits of confidence"
CAUSES = "Causes of the uncertainty of the total loss"
FEW = 2  # Limits that a short list names.
WORTH = 0.98  # Part of the band above which a measurement is not worth while. [1]


def band_texts(known: Known | None) -> list[str | Listing]:
    """How well a single result is known, and what limits that; nothing if all is exact."""
    if known is None:
        return []
    low, high = known.ends["total"]
    text = f"95 % band: total loss {known_text(low, high)}"
    ends = known.ends["efficiency"]
    if ends[1] > 0:  # neither unknown nor without any efficiency
        text += f", efficiency {efficiency_text(*ends, ends=ends)}"
    return [
        f"{text}, mainly from {main_causes(known)}. Inputs without an entry in [uncertainty] are "
        "estimated: 'epicyclic uncertainty' shows all.",
        Listing(tuple(advice_texts(known, brief=True)), LIMITS),
    ]


def advice_texts(known: Known, *, brief: bool = False) -> Iterator[str]:
    """Sentences on limits, on the measurement that helps most, and on models, in this order.

    With `brief` only the most important ones.
    """
    for limit in limits_of(known)[: FEW if brief else None]:
        width = known_text(limit.width, unit=known.unit, beside=known.width)
        yield f"{limit.name}: {width} of the band; {limit.advice}."
    yield from _measurements(known)
    yield from known.remarks


def _measurements(known: Known) -> Iterator[str]:
    """The part of the loss, and the input, whose measurement narrows the band most."""
    found = [it for it in measurements_of(known) if it.width < WORTH * known.width]
    best = [next((it for it in found if it.is_input is own), None) for own in (False, True)]
    parts = [
        f"{'the input ' if it.is_input else ''}{it.name}, to "
        f"{known_text(it.width, unit=known.unit, beside=known.width)}"
        for it in best
        if it is not None
    ]
    if parts:
        before = known_text(known.width, unit=known.unit)
        yield f"The band of {before} would narrow most by measuring {', or '.join(parts)}."


def result_json(result: Result, known: Known | None) -> str:
    """A result as JSON with its band and what limits the trust in it, unless all is exact."""
    content = result.to_dict() | ({} if known is None else _known(known))
    return json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False)


def _known(known: Known) -> dict[str, Any]:
    ends = {name: list(known.ends[name]) for name in ("total", "efficiency")}
    return {
        "band": {
            **{name: own if math.isfinite(own[0]) else None for name, own in ends.items()},
            "shares": dict(known.drivers),
        },
        "advice": {
            "limits": [
                {"name": it.name, "width": it.width, "advice": it.advice} for it in limits_of(known)
            ],
            "measurements": [{"name": it.name, "width": it.width} for it in measurements_of(known)],
            "remarks": list(known.remarks),
            "unit": known.unit,
        },
    }


def _names(data: xr.Dataset) -> dict[str, str]:
    """What uncertain values are called, by their keys."""
    names = map(in_few_words, map(str, data["input_name"].values))
    return dict(zip(map(str, data["input"].values), names, strict=True))


MOST_COLUMNS = 9
"""Most columns of a table of values; larger maps are shown at evenly spaced points."""


def grid_table(
    point: xr.Dataset,  # A map over speed and torque, as `map_at` makes it.
    title: str,
    cell: Callable[[int, int], Cell],  # Content for the number of a speed and of a torque.
) -> Table:
    """A table of what `cell` says of speeds and torques, by their numbers."""
    speeds, torques = (_some(point.sizes[axis]) for axis in ("speed", "torque"))
    rows = tuple(
        (Cell(format_number(float(point["speed"][i]))), *(cell(i, j) for j in torques))
        for i in speeds
    )
    unit = unit_text(str(point["torque"].attrs["units"]))
    heads = (f"{format_number(float(point['torque'][j]))} {unit}" for j in torques)
    if "temperature" in point.coords:
        title = f"{title}, at {format_number(float(point['temperature']))} °C"
    return Table((f"speed, {unit_text(str(point['speed'].attrs['units']))}", *heads), rows, title)


def _some(count: int) -> list[int]:
    """Numbers of some `MOST_COLUMNS` of `count` points, evenly spaced but for the last."""
    step = max(1, math.ceil((count - 1) / (MOST_COLUMNS - 1)))
    return sorted({*range(0, count, step), count - 1})


LEAST = 0.02  # Largest share in the variance at any point, from which an input is shown. [1]


def map_band_tables(data: xr.Dataset) -> Iterator[Table | Listing]:
    """The band of the total loss over speed and torque at each temperature, and what makes it."""
    from epicyclic.show.plots.loss_map import at_temperatures, first_values  # `run` loads none

    title = ", ".join(filter(None, ("95 % band of the total loss, W", first_values(data))))
    for point in at_temperatures(data).values():
        total = point.sel(result="total").transpose("speed", "torque", ...)
        yield grid_table(point, title, _band_of(total))
    few = _too_few(data)
    yield Listing(few, CAUSES) if few else _drivers(data)
    if not few:
        yield Listing(tuple(_limits(data)), LIMITS)


def _limits(data: xr.Dataset) -> Iterator[str]:
    """What to do about the drivers that matter over the whole map, in the order of `_drivers`."""
    total, mean = data.sel(result="total"), mean_shares(data)
    width = total["high"] - total["low"]
    for driver in mean["driver"].values[:MOST_DRIVERS]:
        if mean.sel(driver=driver) <= LEAST:
            return
        own = data.sel(input=str(driver).split(" + "))
        name = " + ".join(map(str, own["input_name"].values))
        advice = "; ".join(dict.fromkeys(map(str, own["input_advice"].values)))
        alone = width * np.sqrt(data["first_order"].sel(driver=driver).clip(0.0, 1.0))
        place = _place(data, alone.isel(alone.argmax(alone.dims)))
        yield (
            f"{name}: up to {format_number(float(alone.max()), 3)} W of the band, at {place}; "
            f"{advice}."
        )


def _place(data: xr.Dataset, point: xr.DataArray) -> str:
    """The operating point, by the axes of the map that have more than one value."""
    from epicyclic.show.plots.style import place_text  # which `run` need not load

    axes = [str(name) for name in data["total"].dims if data.sizes[name] > 1]
    return ", ".join(f"{name} {place_text(point[name])}" for name in axes)


def _band_of(total: xr.Dataset) -> Callable[[int, int], Cell]:
    low, high = total["low"].to_numpy(), total["high"].to_numpy()

    def cell(i: int, j: int) -> Cell:
        if not np.isfinite(low[i, j]):
            return Cell(MISSING)
        return aligned(f"{low[i, j]:.0f} to {high[i, j]:.0f}")

    return cell


def _drivers(data: xr.Dataset) -> Table | Listing:
    """Shares of the variance of the total loss: where the loss is, and where they are largest."""
    shares, mean, names = data["first_order"], mean_shares(data), _names(data)
    rows = []
    for driver in mean["driver"].values:
        own = shares.sel(driver=driver)
        if not (own > LEAST).any():
            continue
        largest = own.isel(own.argmax(own.dims))
        rows.append(
            (
                Cell(" + ".join(names[key] for key in str(driver).split(" + "))),
                aligned(percent(max(float(mean.sel(driver=driver)), 0.0))),
                aligned(percent(float(largest))),
                Cell(_place(data, largest)),
            )
        )
    known = float(data["explained"].min())
    note = (
        "Shares of its variance from each input alone, from curves through the samples; the mean "
        f"is weighted with the loss. The curves explain {percent(known)} or more of it at every "
        "point."
    )
    return _causes(("", "mean share", "largest", "at"), rows, note)


def _causes(head: tuple[str, ...], rows: Sequence[tuple[Cell, ...]], note: str) -> Table | Listing:
    return Table(head, tuple(rows), CAUSES, note=note) if rows else Listing((), CAUSES)


def _too_few(data: xr.Dataset) -> tuple[str, ...]:
    """What to do where there are too few samples for curves, which have up to 1 + 2 d columns."""
    explained = data.get("explained", data.get("curves_explain"))
    if explained is None or explained.notnull().any():
        return ()
    count = int(data.attrs["samples"])
    more = max(2 * count, 1 << data.sizes["input"].bit_length())
    return (f"{count} samples are too few to tell the causes. Take {more} or more.",)


NO_SHARE = 1e-3
"""Share in the variance of a loss up to which curves through samples show hardly an effect. [1]"""
SCATTER = 0.01  # Difference of shares that is worth a sentence. [1]
CUT_OFF = 1e-3  # Probability of impossible values that is worth a sentence. [1]


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
        cells = (
            _shown(one, key)
            for key in ("first", "second", "difference", "standard_uncertainty", "low", "high")
        )
        same = not one["difference"] and not one["standard_uncertainty"]
        chance = aligned(MISSING if same else percent(float(one["probability"])))
        rows.append((Cell(_label(name)), *cells, chance))
    strong = frozenset({names.index("total"), names.index("efficiency")})
    head = ("", "first", "second", "mean diff.", "u", "95 % from", "to", "P(2nd < 1st)")
    first, second = (one_line(data.attrs[f"{name}_title"]) for name in ("first", "second"))
    table = Table(head, tuple(rows), "Second minus first", strong, "Losses in W.")
    total = data.sel(result="total")
    notes = [
        f"Shared: {data.attrs['shared'] or 'nothing'}.",
        f"Total loss: u of the difference {known_text(float(total['standard_uncertainty']))}; "
        f"of two independent results {known_text(float(total['unpaired_uncertainty']))}.",
    ]
    if data.attrs["failed"]:
        notes.append(f"{data.attrs['failed']} of {data.attrs['pairs']} pairs have no result.")
    return titled(f"{second}\nless {first}", as_on_page(table), listed("Notes", notes))


def _label(name: str, grouping: str = "") -> str:
    """A result in words; `grouping` says what the two groups of losses are sums of."""
    if name in ("load_dependent", "load_independent"):
        return name.replace("_", "-") + grouping
    return in_words(name) + (", %" if name == "efficiency" else "")


def band_figures(data: xr.Dataset) -> list[KeyFigure]:
    """The ends of the band, for the head of a page."""
    found = []
    for name, label in (("total", "lost"), ("efficiency", "efficiency")):
        one, unit = data.sel(result=name), unit_of(data, name)
        for key, end in (("low", "from"), ("high", "to")):
            if np.isfinite(one[key]):
                shown_unit = "%" if unit == "1" else unit
                found.append(KeyFigure(f"{label} {end}", _shown(one, key), shown_unit))
    return found


def _results(data: xr.Dataset) -> Table:
    rows = []
    names = [str(name) for name in data["result"].values]
    total = float(data["nominal"].sel(result="total"))
    for name in names:
        one = data.sel(result=name)
        values = (
            _shown(one, key, total)
            for key in ("nominal", "mean", "standard_uncertainty", "expanded_uncertainty",
                        "low", "high", "shortest_low", "shortest_high")
        )  # fmt: skip
        rows.append((Cell(_label(name, data.attrs["grouping"])), *values))
    strong = frozenset({names.index("total"), names.index("efficiency")})
    head = ("", "case", "mean", "u_c", "U", "95 % from", "to", "shortest", "to")
    unit = unit_of(data)
    what = "Losses" if unit == "W" else "Energies"
    note = f"u_c: combined standard uncertainty; U = 2 u_c. {what} in {unit}."
    return Table(head, tuple(rows), "Results with their uncertainty", strong, note)


def _shown(one: xr.Dataset, name: str, total: float = 0.0) -> Cell:
    """A number of a result as precise as such numbers are, beside a `total` of losses."""
    value, unit = float(one[name]), str(one["unit"].values)
    if math.isnan(value):
        return Cell(MISSING)
    if unit == "W":
        return number(value, "", text=f"{value:z.{max(1, decimals_of(total))}f}")
    return number(value, "", text=f"{100 * value:z.3f}" if unit == "1" else shown(value, 5))


def _budget(data: xr.Dataset) -> Table | Listing:
    """What makes the variance of the total loss, the largest share first."""
    total = data.sel(result="total", sum="total")
    orders = [name for name in ("first_order", "total_order") if name in data]
    largest = total[orders[-1]]
    rows, names = [], _names(data)
    for driver in map(str, largest.sortby(-largest)["driver"].values):
        keys = driver.split(" + ")
        if not total["contribution"].sel(input=keys).any():
            continue
        one = total.sel(driver=driver)
        known = [float(one[name]) for name in orders]  # NaN with too few samples
        shares = [MISSING if math.isnan(it) else percent(max(it, 0.0)) for it in known]
        for place, key in enumerate(keys):
            own = total.sel(input=key)
            unit = unit_text(str(own["input_unit"].values)).removesuffix("1")
            rows.append(
                (
                    Cell(names[key]),
                    Cell(str(own["distribution"].values)),
                    aligned(f"{shown(float(own['input_value']))} {unit}".rstrip()),
                    _shown(own, "contribution", float(total["nominal"])),
                    *(aligned("" if place else text) for text in shares),
                )
            )
    heads = ("", "distribution", "value", f"per u_i, {unit_of(data)}", "share", "with others")
    note = (
        "per u_i: change of the total loss for one standard deviation. Shares of its variance, "
        "alone and with all interactions; correlated values share one share."
    )
    if len(orders) == 1:
        note = note.replace("alone and with all interactions; ", "each alone; ")
    elif (above := float((total[orders[0]] - total[orders[1]]).max())) > SCATTER:
        note += (
            f" They scatter: one share alone exceeds that with interactions by {percent(above)} of "
            "the variance, which is impossible. More samples reduce that."
        )
    return _causes(heads[: len(heads) + len(orders) - 2], rows, note)


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
            "Left out, because no solution exists one standard deviation away: "
            f"{data.attrs['left_out']}."
        )
    for key in map(str, data["input"].values):
        share = float(data["cut_off"].sel(input=key))
        if share > CUT_OFF:
            yield (
                f"{key}: {percent(share)} of its distribution lies outside its possible range and "
                "is cut off."
            )
    idle = [str(key) for key in data["input"].values if not _moves(data, str(key))]
    names = _names(data)
    if idle:
        at_most = f"At most {percent(NO_SHARE)} of the variance at any point"
        what = "Without effect here" if "contribution" in data else at_most
        yield f"{what}: {', '.join(names[key] for key in idle)}."
    yield from _of_points(data)
    sources: dict[str, list[str]] = {}
    for key in sorted(set(map(str, data["input"].values)) - set(idle)):
        source = str(data["distribution_source"].sel(input=key).values)
        sources.setdefault(source, []).append(f"{names[key]} ({key})")
    yield from (f"{', '.join(keys)}: {source}." for source, keys in sources.items())


def _moves(data: xr.Dataset, key: str) -> bool:
    """Whether an input changes any result."""
    if "contribution" in data:
        return bool(data["contribution"].sel(input=key).any())
    driver = next(name for name in map(str, data["driver"].values) if key in name.split(" + "))
    return not data["total_order"].sel(driver=driver).max() <= NO_SHARE  # also of NaN


def _of_points(data: xr.Dataset) -> Iterator[str]:
    """How well some points stand for a whole cycle."""
    if "point_error" not in data:
        return
    error = float(data["point_error"])
    spread = float(data["standard_uncertainty"].sel(result="total"))
    if not error:
        yield f"Cycle: {data.attrs['cycle']}, all solved for every sample."
    else:
        yield (
            f"Cycle: {data.attrs['cycle']}; {data.attrs['points']} points represent it, so u_c of "
            f"the total has a standard error of {percent(error / spread, 0)}."
        )
    known = f"which explain {percent(float(data['curves_explain']))} of the variance of the total"
    yield from _too_few(data) or (f"Shares from curves through the samples, {known}.",)
