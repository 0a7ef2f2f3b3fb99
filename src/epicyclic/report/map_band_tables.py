"""How well the losses of a map are known, in tables."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import xarray as xr

from epicyclic.plots.loss_map import at_temperatures
from epicyclic.report.advice import driver_name
from epicyclic.report.grids import grid_table
from epicyclic.report.page import Cell, Table, aligned
from epicyclic.report.shown import MISSING
from epicyclic.units import format_number, unit_text

__all__ = ["map_band_tables"]

LEAST = 0.02
"""Largest share in the variance at any point, from which an input is shown. [1]"""


def map_band_tables(data: xr.Dataset) -> Iterator[Table]:
    """The band of the total loss over speed and torque at each temperature, and what makes it."""
    for point in at_temperatures(data):
        total = point.sel(result="total").transpose("speed", "torque", ...)
        yield grid_table(point, "95 % band of the total loss, W", _band_of(total))
    yield _drivers(data)


def _band_of(total: xr.Dataset) -> Callable[[int, int], Cell]:
    low, high = total["low"].to_numpy(), total["high"].to_numpy()

    def cell(i: int, j: int) -> Cell:
        if not np.isfinite(low[i, j]):
            return Cell(MISSING)
        return aligned(f"{low[i, j]:.0f} to {high[i, j]:.0f}")

    return cell


def _drivers(data: xr.Dataset) -> Table:
    """Shares of the variance of the total loss: where the loss is, and where they are largest."""
    shares, weights = data["first_order"], data["total"].fillna(0.0)
    axes = [name for name in weights.dims if weights.sizes[name] > 1]
    mean = (shares.fillna(0.0) * weights).sum(weights.dims) / weights.sum()
    rows = []
    for driver in mean.sortby(-mean)["driver"].values:
        own = shares.sel(driver=driver)
        if not (own > LEAST).any():
            continue
        largest = own.isel(own.argmax(own.dims))
        place = ", ".join(f"{name} {_value(largest[name])}" for name in map(str, axes))
        name = " + ".join(map(driver_name, str(driver).split(" + ")))
        rows.append(
            (
                Cell(name),
                aligned(f"{max(float(mean.sel(driver=driver)), 0.0):.1%}"),
                aligned(f"{float(largest):.1%}"),
                Cell(place),
            )
        )
    known = float(data["explained"].min())
    note = (
        "Shares of its variance, alone, by curves through the samples, the mean weighted with the "
        f"loss; the curves explain {known:.1%} or more of it at every point."
    )
    head = ("", "mean share", "largest", "at")
    return Table(head, tuple(rows), "What the uncertainty of the total loss is due to", note=note)


def _value(value: xr.DataArray) -> str:
    if value.dtype.kind not in "if":
        return str(value.item())
    return f"{format_number(value.item())} {unit_text(str(value.attrs.get('units', '')))}".rstrip()
