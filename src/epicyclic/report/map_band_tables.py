"""How well the losses of a map are known, in tables."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from epicyclic.report.advice import LIMITS, MOST, driver_name
from epicyclic.report.grids import grid_table
from epicyclic.report.page import Cell, Listing, Table, aligned
from epicyclic.report.shown import MISSING
from epicyclic.show.plots.loss_map import at_temperatures
from epicyclic.show.plots.losses import mean_shares
from epicyclic.units import format_number, percent, unit_text

LEAST = 0.02
"""Largest share in the variance at any point, from which an input is shown. [1]"""


def map_band_tables(data: xr.Dataset) -> Iterator[Table | Listing]:
    """The band of the total loss over speed and torque at each temperature, and what makes it."""
    for point in at_temperatures(data).values():
        total = point.sel(result="total").transpose("speed", "torque", ...)
        yield grid_table(point, "95 % band of the total loss, W", _band_of(total))
    yield _drivers(data)
    yield Listing(tuple(_limits(data)), LIMITS)


def _limits(data: xr.Dataset) -> Iterator[str]:
    """What to do about the drivers that matter over the whole map, in the order of `_drivers`."""
    total, mean = data.sel(result="total"), _mean_shares(data)
    width = total["high"] - total["low"]
    for driver in mean["driver"].values[:MOST]:
        if mean.sel(driver=driver) <= LEAST:
            return
        keys = str(driver).split(" + ")
        own = data.sel(input=keys)
        name = " + ".join(map(str, own["input_name"].values))
        advice = "; ".join(dict.fromkeys(map(str, own["input_advice"].values)))
        alone = width * np.sqrt(data["first_order"].sel(driver=driver).clip(0.0, 1.0))
        place = _place(data, alone.isel(alone.argmax(alone.dims)))
        yield (
            f"{name}: up to {format_number(float(alone.max()), 3)} W of the band, at {place}; "
            f"{advice}."
        )


def _mean_shares(data: xr.Dataset) -> xr.DataArray:
    """`mean_shares`, the largest first."""
    mean = mean_shares(data)
    return mean.sortby(-mean)


def _place(data: xr.Dataset, point: xr.DataArray) -> str:
    """The operating point, by the axes of the map that have more than one value."""
    axes = [str(name) for name in data["total"].dims if data.sizes[name] > 1]
    return ", ".join(f"{name} {_value(point[name])}" for name in axes)


def _band_of(total: xr.Dataset) -> Callable[[int, int], Cell]:
    low, high = total["low"].to_numpy(), total["high"].to_numpy()

    def cell(i: int, j: int) -> Cell:
        if not np.isfinite(low[i, j]):
            return Cell(MISSING)
        return aligned(f"{low[i, j]:.0f} to {high[i, j]:.0f}")

    return cell


def _drivers(data: xr.Dataset) -> Table:
    """Shares of the variance of the total loss: where the loss is, and where they are largest."""
    shares, mean = data["first_order"], _mean_shares(data)
    rows = []
    for driver in mean["driver"].values:
        own = shares.sel(driver=driver)
        if not (own > LEAST).any():
            continue
        largest = own.isel(own.argmax(own.dims))
        name = " + ".join(map(driver_name, str(driver).split(" + ")))
        rows.append(
            (
                Cell(name),
                aligned(percent(max(float(mean.sel(driver=driver)), 0.0))),
                aligned(percent(float(largest))),
                Cell(_place(data, largest)),
            )
        )
    known = float(data["explained"].min())
    note = (
        "Shares of its variance, alone, by curves through the samples, the mean weighted with the "
        f"loss; the curves explain {percent(known)} or more of it at every point."
    )
    head = ("", "mean share", "largest", "at")
    return Table(head, tuple(rows), "What the uncertainty of the total loss is due to", note=note)


def _value(value: xr.DataArray) -> str:
    if value.dtype.kind not in "if":
        return str(value.item())
    return f"{format_number(value.item())} {unit_text(str(value.attrs.get('units', '')))}".rstrip()
