"""Tables of meshes, pockets, measurements, duty cycles and warming up, for a terminal."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from rich.console import Group, RenderableType
from rich.table import Column, Table
from rich.text import Text

from epicyclic.case.tables.models import AS_TESTED
from epicyclic.messages import one_line
from epicyclic.result.result import in_words, of_gear
from epicyclic.show.page import MISSING, error_text, shown
from epicyclic.show.terminal import Sentence, number_table, plain_table, spaced, titled
from epicyclic.study.measured.comparison import CALIBRATED, ErrorFigures, MeasuredComparison
from epicyclic.study.measured.intervals import Fit, FittedParameter
from epicyclic.study.operating import OPERATING
from epicyclic.units import decimals_of, format_number, percent, unit_text

if TYPE_CHECKING:
    import pandas as pd

# A loaded mesh in tables: position by position, and its extremes with where they occur.

_OVER_PERIOD = ("transmission_error", "mesh_stiffness")
_EXTREMES = (
    "line_load",
    "hertz_pressure",
    "sliding_speed",
    "film_ratio",
    "friction_power",
    "flash_temperature",
)
_SMALLEST = ("film_ratio",)  # Figures whose smallest value matters.


def mesh_tables(meshes: dict[str, xr.Dataset]) -> RenderableType:
    """All meshes, one after the other, as `epicyclic.mesh_details` returns them."""
    parts: list[RenderableType] = []
    for mesh in meshes.values():
        parts += [Text(str(mesh.attrs["title"]), style="bold"), _over_period(mesh), _figures(mesh)]
    parts += map(Sentence, _notes(meshes))
    if any(mesh["transmission_error"].isnull().all() for mesh in meshes.values()):
        told = f'"{MISSING}": this load distribution gives no deflection; compliance does.'
        parts.append(Text(told))
    if any(mesh["film_ratio"].isnull().all() for mesh in meshes.values()):
        parts.append(Text(f'"{MISSING}": without motion there is no film and no friction power.'))
    return spaced(*parts)


def _notes(meshes: dict[str, xr.Dataset]) -> dict[str, None]:
    """Each note once."""
    texts = (str(mesh.attrs["notes"]) for mesh in meshes.values())
    return dict.fromkeys(line for text in texts for line in text.splitlines())


def _over_period(mesh: xr.Dataset) -> Table:
    """Position by position: deflection, stiffness, the load of every tooth pair."""
    lines = mesh["contact_line"].to_numpy()
    names = ("roll_angle", *_OVER_PERIOD)
    heads = [
        *zip(("roll angle", "TE", "stiffness"), names, strict=True),
        *((f"pair {line + 1}", "pair_load") for line in lines),
        ("line load", "line_load"),
        ("pressure", "hertz_pressure"),
    ]
    columns = (Column(f"{head}\n{_unit(mesh, name)}", justify="right") for head, name in heads)
    table = plain_table("Over one base pitch", *columns)
    for position in range(mesh.sizes["mesh_position"]):
        here = mesh.isel(mesh_position=position)
        cells = [float(here[name]) for name in names]
        cells += [float(here["pair_load"].sel(contact_line=line)) for line in lines]
        cells += [float(here[name].max()) for name in ("line_load", "hertz_pressure")]
        table.add_row(*(shown(cell) for cell in cells))
    return table


def _figures(mesh: xr.Dataset) -> Table:
    """Means over the period, and extremes with the place where they occur."""
    table = _table("Figures", "at")
    for label, value, name in _means(mesh):
        table.add_row(label, shown(value), _unit(mesh, name), "")
    for name in _EXTREMES:
        value, place = _extreme(mesh, name)
        word = "smallest" if name in _SMALLEST else "largest"
        label = f"{word} {mesh[name].attrs['long_name']}"
        table.add_row(label, shown(value), _unit(mesh, name), place)
    return table


def _means(mesh: xr.Dataset) -> Iterator[tuple[str, float, str]]:
    error, stiffness = (mesh[name] for name in _OVER_PERIOD)
    weight = mesh["weight"]
    yield "mean transmission error", float((error * weight).sum(skipna=False)), _OVER_PERIOD[0]
    yield "transmission error, peak to peak", float(error.max() - error.min()), _OVER_PERIOD[0]
    yield "mean mesh stiffness", float((stiffness * weight).sum(skipna=False)), _OVER_PERIOD[1]


def _extreme(mesh: xr.Dataset, name: str) -> tuple[float, str]:
    """Extreme of `name` and its place in the plane of action."""
    values = np.abs(mesh[name].to_numpy())
    if np.isnan(values).all():
        return float("nan"), ""
    pick = np.nanargmin if name in _SMALLEST else np.nanargmax
    index = np.unravel_index(int(pick(values)), values.shape)
    path, face = (
        f"{shown(float(mesh[key].to_numpy()[index]), 3)} {_unit(mesh, key)}"
        for key in ("path_position", "face_position")
    )
    return float(values[index]), f"path {path}, face {face}"


def _unit(mesh: xr.Dataset, name: str) -> str:
    return unit_text(str(mesh[name].attrs["units"]))


# The pockets of the meshes in tables: power and its balance, extremes with their place.

_BALANCE = (
    "power",
    "power_from_flow",
    "power_other_end",
    "power_difference",
    "mass_error",
    "periods",
    "speed",
    "oil_fraction",
    "sound_speed",
)
_ERRORS = ("power_difference", "mass_error")
_EXTREMES_OF_POCKETS = (
    ("highest pressure", "pressure", np.nanargmax),
    ("lowest pressure", "pressure", np.nanargmin),
    ("highest speed, along the face", "axial_speed", None),
    ("highest speed, contact side", "contact_gap_speed", None),
    ("highest speed, backlash side", "backlash_gap_speed", None),
    ("smallest section", "end_area", np.nanargmin),
    ("smallest backlash-side gap", "backlash_gap", np.nanargmin),
)
"""What to call them, variables, what picks them; None: the largest without its sign."""


def pocket_tables(meshes: dict[str, xr.Dataset]) -> RenderableType:
    """All meshes, one after the other, as `epicyclic.pocket_details` returns them."""
    parts: list[RenderableType] = []
    for mesh in meshes.values():
        parts += [Text(str(mesh.attrs["title"]), style="bold"), _balance(mesh), _extremes(mesh)]
    models = dict.fromkeys(f"Model: {mesh.attrs['model']}." for mesh in meshes.values())
    parts.append(Group(*map(Sentence, (*models, *_notes(meshes)))))
    return spaced(*parts)


def _balance(mesh: xr.Dataset) -> Table:
    table = _table("Figures")
    for name in _BALANCE:
        value = float(mesh[name])
        text = error_text(value) if name in _ERRORS else shown(value, 5)
        table.add_row(str(mesh[name].attrs["long_name"]), text, _unit(mesh, name))
    count = mesh.attrs["meshes"]
    if count > 1:
        total = count * float(mesh["power"])
        table.add_row(f"power of all {count} such meshes", shown(total, 5), _unit(mesh, "power"))
    return table


def _extremes(mesh: xr.Dataset) -> Table:
    table = _table("Extremes", "pocket of", "roll angle", "across the face")
    for label, name, pick in _EXTREMES_OF_POCKETS:
        values = mesh[name].to_numpy()
        place = np.nanargmax(np.abs(values)) if pick is None else pick(values)
        index = tuple(map(int, np.unravel_index(int(place), values.shape)))
        table.add_row(label, *_at(mesh, name, index))
    return table


def _at(mesh: xr.Dataset, name: str, index: tuple[int, ...]) -> Iterator[str]:
    """Value, unit and place of one element."""
    kind, step, place = index
    position = f"{mesh[name].dims[-1]}_position"
    yield shown(float(mesh[name].to_numpy()[index]))
    yield _unit(mesh, name)
    yield f"tooth {of_gear(mesh['tooth'].to_numpy()[kind])}"
    yield f"{shown(float(mesh['roll_angle'][kind, step]), 3)} {_unit(mesh, 'roll_angle')}"
    yield f"{shown(float(mesh[position][place]), 3)} {_unit(mesh, position)}"


def _table(title: str, *more: str) -> Table:
    return plain_table(title, "", Column("value", justify="right"), "unit", *more)


# Measured losses beside computed ones, for a terminal.

MOST_POINTS = 40  # Points that are shown; JSON and the table in Python have all.


def measured_tables(comparison: MeasuredComparison) -> RenderableType:
    """Errors by set of points; with a fit, the calibrated values and what limits them."""
    parts: list[RenderableType] = [_error_table(comparison), Text(_legend(comparison)), Text()]
    parts.append(_point_table(comparison))
    if len(comparison.measured) > MOST_POINTS:
        parts.append(Text(f"The first {MOST_POINTS} of {len(comparison.measured)} points."))
    if comparison.fit is not None:
        parts += [Text(), _fit_table(comparison.fit)]
        if len(comparison.fit.parameters) > 1:
            parts.append(_correlation_table(comparison.fit))
        parts.append(Text(_fit_line(comparison.fit)))
        parts += [Text(f"Warning: {note}", style="bold") for note in comparison.fit.warnings]
    return Group(*parts, *(Text(f"Note: {note}") for note in comparison.notes))


def _error_table(comparison: MeasuredComparison) -> Table:
    names = ["n", "mean W", "mean %", "rms W", "size %", "most W", "most %", "line"]
    weighted = comparison.measured.uncertainty is not None
    heads = ["case, points", *names, *["χ²"] * weighted]
    table = number_table("Computed less measured loss", *heads, no_wrap=(True, True))
    for number, row in enumerate(comparison.errors):
        if number and not row.group:
            table.add_section()
        points = row.points.removesuffix(" points")
        name = f"  {row.group}" if row.group else f"{row.state}: {points}"
        cells = _error_cells(row)[: len(names) + weighted]
        table.add_row(name, *cells, style="" if row.group else "bold")
    return table


def _point_table(comparison: MeasuredComparison) -> Table:
    """Every point: measured, computed before and after a fit, and what is left."""
    measured, states = comparison.measured, comparison.states
    last = list(states)[-1]
    weighted = measured.uncertainty is not None
    conditions = [
        (unit_text(OPERATING[name].unit), values) for name, values in measured.conditions.items()
    ]
    columns = [*conditions, ("measured W", measured.loss)]
    if measured.uncertainty is not None:
        columns.append(("u W", measured.uncertainty))
    columns += [(f"{name} W", values) for name, values in states.items()]
    columns.append(("residual W", comparison.residuals(last)))
    if weighted:
        columns.append(("over u", comparison.normalised(last)))
    heads = ("line", *(name for name, _ in columns))
    table = plain_table("Points", *(Column(head, justify="right") for head in heads))
    for row, line in enumerate(measured.lines[:MOST_POINTS]):
        mark = "*" if comparison.held_out[row] else ""
        table.add_row(f"{line}{mark}", *(shown(float(values[row])) for _, values in columns))
    return table


def _error_cells(row: ErrorFigures) -> list[str]:
    return [
        str(row.count),
        shown(row.bias, 3),
        _tenths(100 * row.relative_bias),
        shown(row.rms, 3),
        _tenths(100 * row.mean_percentage),
        shown(row.largest, 3),
        _tenths(100 * row.relative_largest),
        str(row.largest_line) if row.count else MISSING,
        shown(row.chi_squared, 3),
    ]


def _legend(comparison: MeasuredComparison) -> str:
    text = (
        "mean: mean error; size: mean magnitude of the errors; most: largest magnitude, with "
        "the line of that in W; %: relative to the measured loss."
    )
    if comparison.load_dependent == AS_TESTED:
        text += (
            " Load-dependent losses as tested: total loss less that without torque at the same "
            "speed and oil inlet temperature, each at its own temperatures."
        )
    if comparison.held_out.any():
        text += " Lines with * were held out."
    if comparison.fit is not None:
        text += (
            f" {CALIBRATED}: with values fitted to these measurements, which is not a validation."
        )
    return text


def _fit_table(fit: Fit) -> Table:
    heads = ("key", "start", CALIBRATED, "std. error", f"{100 * fit.confidence:.4g} % interval")
    table = number_table(f"{CALIBRATED} values", *heads, no_wrap=(True, True))
    table.add_column("unit")
    for item in fit.parameters:
        table.add_row(
            item.key,
            shown(item.start),
            shown(item.value),
            shown(item.standard_error, 2),
            _interval(item),
            unit_text(item.unit),
        )
    return table


def _interval(item: FittedParameter) -> str:
    if item.at_bound and math.isnan(item.low):
        return "at its bound"
    return MISSING if math.isnan(item.low) else f"{shown(item.low)} to {shown(item.high)}"


def _correlation_table(fit: Fit) -> Table:
    heads = (f"({number + 1})" for number in range(len(fit.parameters)))
    table = number_table("Correlations", "", *heads, no_wrap=(True, False))
    for number, (item, row) in enumerate(zip(fit.parameters, fit.correlation, strict=True)):
        table.add_row(f"({number + 1}) {item.key}", *(shown(value, 3) for value in row))
    return table


def _fit_line(fit: Fit) -> str:
    free = fit.degrees_of_freedom
    text = f"Weighted least squares, {fit.points} points, {free} degrees of freedom"
    if math.isfinite(fit.chi_squared):
        text += f", χ² {shown(fit.chi_squared, 4)}"
    text += f"; {fit.evaluations} computed points. "
    if all(item.profiled for item in fit.parameters):
        text += "Intervals follow from profiles of the likelihood."
    else:
        text += "Intervals are those of the linearised model."
    if fit.discrepancy > 0 and fit.widening > 1:
        text += (
            f" Birge ratio {shown(fit.widening, 3)}: beyond the uncertainties of the "
            f"measurements, the model error is about {shown(fit.discrepancy, 2)} W at these "
            "points. The intervals include that variance."
        )
    elif math.isfinite(fit.discrepancy) and math.isnan(fit.widening):
        text += (
            f" The points scatter by {shown(fit.discrepancy, 2)} W about the fit, due to "
            "measurements and model together."
        )
        if fit.noise == "relative":
            text += " They scatter in proportion to the loss (rms), as the residuals show."
    return text


def fitted_comment(item: FittedParameter, fit: Fit) -> str:
    """What a case file says behind a calibrated value."""
    start = f"{shown(item.start)} {unit_text(item.unit)}".rstrip()
    share = f"{100 * fit.confidence:.4g} %"
    return f"{CALIBRATED}; {share} interval: {_interval(item)}; before: {start}"


# Energies of a duty cycle as tables, for a terminal and for files.

KILOJOULES_PER_KWH = 3600.0


def duty_tables(data: xr.Dataset) -> RenderableType:
    """Energy in, out and lost by component, for each temperature that was asked for."""
    parts: list[RenderableType] = []
    if "temperature" in data.dims:
        for value in data["temperature"].values:
            parts += _tables(data.sel(temperature=value), f"Oil at {shown(float(value))} °C")
    else:
        parts += _tables(data, "Duty cycle")
    stated = [
        f"{name.replace('_', ' ')}: {data.attrs[name]}"
        for name in ("cycle", "basis", "reference_shaft", "modes")
    ]
    return titled(one_line(data.attrs["title"]), *parts, Text("\n".join(stated)))


def _in_other_units(data: xr.Dataset) -> str:
    """What is lost in kWh, in W on average, and per distance if that is known."""
    lost, seconds = float(data["energy_lost"].sum()), float(data["duration"].sum())
    kwh, watts = shown(lost / KILOJOULES_PER_KWH, 4), shown(1e3 * lost / seconds, 4)
    text = f"Lost: {kwh} kWh, {watts} W on average over {duration_text(seconds)}"
    if "distance" not in data:
        return f"{text}."
    per_km, distance = float(data["lost_per_distance"]), float(data["distance"])
    return f"{text}; {shown(per_km, 4)} Wh/km over {shown(distance, 4)} km."


def _tables(data: xr.Dataset, title: str) -> list[RenderableType]:
    heads = ("", *map(str, data["mode"].values), "total", "of loss")
    table = number_table(f"{title}: energy in kJ", *heads, no_wrap=(True, False))
    lost = data["energy_lost"]
    whole = float(lost.sum())
    decimals = decimals_of(whole)
    _add_row(table, "entering", data["energy_in"], decimals)
    _add_row(table, "leaving", data["energy_out"], decimals, end_section=True)
    for name in lost["component"].values:
        row = lost.sel(component=name)
        share = percent(float(row.sum()) / whole) if whole else ""
        _add_row(table, str(name).replace("_", " "), row, decimals, share)
    _add_row(table, "lost", lost.sum("component"), decimals, style="bold", end_section=True)
    seconds = data["duration"]
    _add_row(table, "duration s", seconds, decimals_of(float(seconds.sum())))
    efficiencies = [*data["efficiency"].values, data["total_efficiency"].item()]
    table.add_row("efficiency", *("" if math.isnan(it) else percent(it, 3) for it in efficiencies))
    states = [_states_table(data, decimals)] if "state" in data.dims else []
    return [table, *states, Text(_in_other_units(data)), Text(_error_text(data, whole))]


def _states_table(data: xr.Dataset, decimals: int) -> Table:
    heads = ("", "entering", "leaving", "lost", "duration s", "efficiency")
    table = number_table("States: energy in kJ", *heads)
    of_time = decimals_of(float(data["duration"].sum()))
    for name in data["state"].values:
        own = data.sel(state=name)
        values = own["state_energy_in"], own["state_energy_out"], own["state_energy_lost"].sum()
        cells = [f"{float(it):z.{decimals}f}" for it in values]
        efficiency = float(own["state_efficiency"])
        cells += [f"{float(own['state_duration']):.{of_time}f}"]
        table.add_row(str(name), *cells, "" if math.isnan(efficiency) else percent(efficiency, 3))
    return table


def _add_row(
    table: Table, name: str, values: xr.DataArray, decimals: int, share: str = "", **style: Any
) -> None:
    cells = (f"{float(value):z.{decimals}f}" for value in (*values.values, values.sum()))
    table.add_row(name, *cells, share, **style)


def _error_text(data: xr.Dataset, lost: float) -> str:
    """How far the energy lost is off, and what lies outside."""
    error = float(data["interpolation_error"])
    spread = float(data["interpolation_standard_error"])
    scatter = "" if math.isnan(spread) or not spread else f" ± {shown(spread, 2)}"
    part = f" ({percent(error / lost, 2, signed=True)} of the energy lost)" if lost else ""
    largest, outside = float(data["largest_deviation"]), float(data["share_outside"])
    how = f", {data.attrs['points_outside']}" if outside else ""
    adds = "The error of interpolation is unknown"
    if not math.isnan(error):
        adds = f"Interpolation adds {shown(error, 3)}{scatter} kJ{part}; largest deviation of a "
        adds += f"point {percent(largest, 2)}"
    return (
        f"{adds} ({data.attrs['interpolation_error_method']}).\n{percent(outside)} of the "
        f"duration lies outside of the map{how}."
    )


def duty_rows(data: xr.Dataset) -> pd.DataFrame:
    """One row for each number: quantity, unit, mode, component, temperature, value."""
    import pandas as pd

    tables = [
        array.expand_dims(quantity=[name])
        .to_dataframe("value")
        .reset_index()
        .assign(unit=array.attrs["units"])
        for name, array in data.data_vars.items()
    ]
    columns = ["quantity", "unit", *map(str, data.dims), "value"]
    return pd.concat(tables, ignore_index=True)[columns]


def duty_json(data: xr.Dataset) -> str:
    """Attributes and rows as JSON; what does not exist is null."""
    rows = duty_rows(data).astype(object)
    content = {"attributes": data.attrs, "rows": rows.where(rows.notna(), None).to_dict("records")}
    return json.dumps(content, indent=2, allow_nan=False)


# Warming up as tables, for a terminal and for files.

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
            _tenths(float(one["settled_temperature"])),
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
    cycle = [Text(f"cycle: {data.attrs['cycle']}")] if "cycle" in data.attrs else []
    return titled(one_line(data.attrs["title"]), table, losses, Text(_summary(data)), *cycle)


def _summary(data: xr.Dataset) -> str:
    """Time constants and energies in words."""
    constants = data["time_constant"].values
    lost = float(data["energy_lost"][-1])
    settled = float(data["energy_lost_settled"])
    if math.isnan(settled):
        return f"No settled state is reached. Energy lost: {shown(lost)} kJ."
    texts = ", ".join(map(duration_text, constants[:_SHOWN_CONSTANTS]))
    lines = [
        f"time constants about the settled state: {texts}",
        f"energy lost: {shown(lost)} kJ; in the settled state from the start it would be "
        f"{shown(settled)} kJ"
        + (f" ({percent(lost / settled - 1, signed=True)} due to warming up)" if settled else ""),
    ]
    return "\n".join(lines)


def duration_text(seconds: float) -> str:
    """A time in the unit that suits it, ``"1.5 h"``; a dash if there is none."""
    if math.isnan(seconds):
        return MISSING
    unit, size = next(((unit, size) for unit, size in _UNITS if seconds >= 2 * size), _UNITS[-1])
    return f"{format_number(seconds / size, 3)} {unit}"


def _tenths(value: float) -> str:
    return MISSING if math.isnan(value) else f"{value:z.1f}"


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
