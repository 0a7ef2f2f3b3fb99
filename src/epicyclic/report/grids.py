"""Tables over the speeds and torques of a map."""

from __future__ import annotations

import math
from collections.abc import Callable

import xarray as xr

from epicyclic.report.page import Cell, Table
from epicyclic.units import format_number, unit_text

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
