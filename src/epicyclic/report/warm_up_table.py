"""Warming up as tables, for a terminal and for files."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.text import Text

from epicyclic.case.messages import one_line
from epicyclic.report.shown import shown
from epicyclic.report.tables import number_table
from epicyclic.results.result import in_words
from epicyclic.units import percent

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

_UNITS = (("h", 3600.0), ("min", 60.0), ("s", 1.0))
_SHOWN_CONSTANTS = 4


def warm_up_tables(data: xr.Dataset) -> RenderableType:
    """Temperatures at the start, at the end and settled, time constants, and the energy lost."""
    title = f"Warming up for {duration_text(float(data['time'][-1]))}"
    heads = ("", "start °C", "end °C", "settled °C", "to 90 %", "capacity J/K")
    table = number_table(title, *heads, no_wrap=(True, True))
    for node in data["node"].values:
        one = data.sel(node=node)
        temperature = one["temperature"].values
        table.add_row(
            in_words(str(node)),
            f"{temperature[0]:.1f}",
            f"{temperature[-1]:.1f}",
            _number(float(one["settled_temperature"])),
            duration_text(float(one["time_to_90_percent"])),
            shown(float(one["heat_capacity"])),
        )
    losses = number_table("Power loss in W", "", "start", "end", no_wrap=(True, True))
    for component in data["component"].values:
        watts = data["loss"].sel(component=component).values
        if watts.any():
            losses.add_row(in_words(str(component)), f"{watts[0]:.1f}", f"{watts[-1]:.1f}")
    losses.add_section()
    total = data["total_loss"].values
    losses.add_row("total", f"{total[0]:.1f}", f"{total[-1]:.1f}", style="bold")
    return Group(*(Padding(part, (0, 0, 1, 0)) for part in (
        Text(one_line(data.attrs["title"]), style="bold"), table, losses, Text(_summary(data)),
    )))  # fmt: skip


def _summary(data: xr.Dataset) -> str:
    """Time constants and energies in words."""
    constants = data["time_constant"].values
    lost = float(data["energy_lost"][-1])
    settled = float(data["energy_lost_settled"])
    if math.isnan(settled):
        return f"It does not settle. Energy lost: {shown(lost)} kJ."
    texts = ", ".join(map(duration_text, constants[:_SHOWN_CONSTANTS]))
    lines = [
        f"time constants about the settled state: {texts}",
        f"energy lost: {shown(lost)} kJ; settled from the start it would be {shown(settled)} kJ"
        + (f" ({percent(lost / settled - 1, signed=True)} by warming up)" if settled else ""),
    ]
    return "\n".join(lines)


def duration_text(seconds: float) -> str:
    """A time in the unit that suits it, ``"1.5 h"``; a dash if there is none."""
    if math.isnan(seconds):
        return "-"
    unit, size = next(((unit, size) for unit, size in _UNITS if seconds >= 2 * size), _UNITS[-1])
    return f"{seconds / size:.3g} {unit}"


def _number(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.1f}"


def warm_up_rows(data: xr.Dataset) -> pd.DataFrame:
    """One row for each time: temperatures of all nodes, all losses, efficiency and energies."""
    import pandas as pd

    columns = {f"time [{data['time'].attrs['units']}]": data["time"].values}
    for name, over, ending in (("temperature", "node", ""), ("loss", "component", "_loss")):
        for one in data[over].values:
            header = f"{one}{ending or '_temperature'} [{data[name].attrs['units']}]"
            columns[header] = data[name].sel({over: one}).values
    for key, array in data.data_vars.items():
        if array.dims == ("time",):
            unit = str(array.attrs["units"])
            columns[str(key) if unit == "1" else f"{key} [{unit}]"] = array.values
    return pd.DataFrame(columns)
