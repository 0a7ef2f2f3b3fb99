"""Energies of a duty cycle as tables, for a terminal and for files."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from epicyclic.case.messages import one_line
from epicyclic.report.shown import shown
from epicyclic.report.tables import number_table
from epicyclic.units import percent

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


def duty_tables(data: xr.Dataset) -> RenderableType:
    """Energy in, out and lost by component, for each temperature that was asked for."""
    parts: list[RenderableType] = [Text(one_line(data.attrs["title"]), style="bold")]
    if "temperature" in data.dims:
        for value in data["temperature"].values:
            title = f"Oil at {shown(float(value))} °C"
            parts += _tables(data.sel(temperature=value), title)
    else:
        parts += _tables(data, "Duty cycle")
    stated = [
        f"{name.replace('_', ' ')}: {data.attrs[name]}"
        for name in ("cycle", "basis", "reference_shaft", "modes")
    ]
    parts.append(Text("\n".join(stated)))
    return Group(*(Padding(part, (0, 0, 1, 0)) for part in parts))


def _tables(data: xr.Dataset, title: str) -> list[RenderableType]:
    modes = [str(name) for name in data["mode"].values]
    heads = ("", *modes, "total", "of lost")
    table = number_table(f"{title}: energy in kJ", *heads, no_wrap=(True, False))
    _add_row(table, "entering", data["energy_in"])
    _add_row(table, "leaving", data["energy_out"], end_section=True)
    lost = data["energy_lost"]
    whole = float(lost.sum())
    for name in lost["component"].values:
        row = lost.sel(component=name)
        share = percent(float(row.sum()) / whole) if whole else ""
        _add_row(table, str(name).replace("_", " "), row, share)
    _add_row(table, "lost", lost.sum("component"), style="bold", end_section=True)
    _add_row(table, "duration s", data["duration"])
    efficiencies = [*data["efficiency"].values, data["total_efficiency"].item()]
    table.add_row("efficiency", *("" if math.isnan(it) else percent(it, 3) for it in efficiencies))
    states = [_states_table(data)] if "state" in data.dims else []
    return [table, *states, Text(_error_text(data, whole))]


def _states_table(data: xr.Dataset) -> Table:
    """Energy of each state."""
    heads = ("", "entering", "leaving", "lost", "duration s", "efficiency")
    table = number_table("States: energy in kJ", *heads)
    for name in data["state"].values:
        own = data.sel(state=name)
        values = [own["state_energy_in"], own["state_energy_out"]]
        values += [own["state_energy_lost"].sum(), own["state_duration"]]
        efficiency = float(own["state_efficiency"])
        shown_efficiency = "" if math.isnan(efficiency) else percent(efficiency, 3)
        table.add_row(str(name), *(shown(float(it), 6) for it in values), shown_efficiency)
    return table


def _add_row(table: Table, name: str, values: xr.DataArray, share: str = "", **style: Any) -> None:
    cells = [shown(float(value), 6) for value in values.values]
    table.add_row(name, *cells, shown(float(values.sum()), 6), share, **style)


def _error_text(data: xr.Dataset, lost: float) -> str:
    """How far the energy lost is off, and what lies outside."""
    error, spread = (
        float(data[name]) for name in ("interpolation_error", "interpolation_standard_error")
    )
    scatter = "" if math.isnan(spread) else f" ± {shown(spread, 2)}"
    part = f" ({percent(error / lost, 2, signed=True)} of the energy lost)" if lost else ""
    largest = float(data["largest_deviation"])
    return (
        f"Interpolation adds {shown(error, 3)}{scatter} kJ{part}; largest deviation of a point "
        f"{'-' if math.isnan(largest) else percent(largest, 2)}. "
        f"By: {data.attrs['interpolation_error_method']}.\n"
        f"Outside of the map: {float(data['share_outside']):.3g} of the duration, "
        f"{data.attrs['points_outside']}."
    )


def duty_rows(data: xr.Dataset) -> pd.DataFrame:
    """One row for each number: quantity, unit, mode, component, temperature, value."""
    import pandas as pd

    tables = []
    for name, array in data.data_vars.items():
        table = (
            array.to_dataframe(name="value").reset_index()
            if array.ndim
            else pd.DataFrame({"value": [array.item()]})
        )
        tables.append(table.assign(quantity=str(name), unit=array.attrs["units"]))
    columns = ["quantity", "unit", *data.dims, "value"]
    return pd.concat(tables, ignore_index=True)[[str(name) for name in columns]]


def duty_json(data: xr.Dataset) -> str:
    """Attributes and rows as JSON; what does not exist is null."""
    rows = duty_rows(data).astype(object)
    content = {"attributes": data.attrs, "rows": rows.where(rows.notna(), None).to_dict("records")}
    return json.dumps(content, indent=2, allow_nan=False)
