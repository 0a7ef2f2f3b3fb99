"""A loaded mesh in tables: position by position, and its extremes with where they occur."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import xarray as xr
from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from epicyclic.report.shown import MISSING, shown
from epicyclic.report.tables import plain_table
from epicyclic.units import unit_text

_OVER_PERIOD = ("transmission_error", "mesh_stiffness")
_EXTREMES = (
    "line_load",
    "hertz_pressure",
    "sliding_speed",
    "film_ratio",
    "friction_power",
    "flash_temperature",
)
_SMALLEST = ("film_ratio",)
"""Figures whose smallest value matters."""


def mesh_tables(meshes: dict[str, xr.Dataset]) -> RenderableType:
    """All meshes, one after the other, as `epicyclic.mesh_details` returns them."""
    parts: list[RenderableType] = []
    for mesh in meshes.values():
        title = Text(str(mesh.attrs["title"]), style="bold")
        parts += [title, _over_period(mesh), _figures(mesh)]
    notes = dict.fromkeys(line for mesh in meshes.values() for line in _notes(mesh))
    parts += [Text(f"• {note}") for note in notes]
    if any(mesh["transmission_error"].isnull().all() for mesh in meshes.values()):
        parts.append(
            Text(f'"{MISSING}": this load distribution knows no deflection; compliance does.')
        )
    if any(mesh["film_ratio"].isnull().all() for mesh in meshes.values()):
        parts.append(Text(f'"{MISSING}": without motion there is no film and no friction power.'))
    return Group(*(Padding(part, (0, 0, 1, 0)) for part in parts))


def _notes(mesh: xr.Dataset) -> list[str]:
    return str(mesh.attrs["notes"]).splitlines()


def _over_period(mesh: xr.Dataset) -> Table:
    """Position by position: deflection, stiffness, the load of every tooth pair."""
    table = plain_table("Over one base pitch")
    lines = mesh["contact_line"].to_numpy()
    names = ("roll_angle", *_OVER_PERIOD)
    for name, short in zip(names, ("roll angle", "TE", "stiffness"), strict=True):
        table.add_column(f"{short}\n{_unit(mesh, name)}", justify="right")
    for line in lines:
        table.add_column(f"pair {line + 1}\n{_unit(mesh, 'pair_load')}", justify="right")
    table.add_column(f"line load\n{_unit(mesh, 'line_load')}", justify="right")
    table.add_column(f"pressure\n{_unit(mesh, 'hertz_pressure')}", justify="right")
    for position in range(mesh.sizes["mesh_position"]):
        here = mesh.isel(mesh_position=position)
        cells = [float(here[name]) for name in names]
        cells += [float(here["pair_load"].sel(contact_line=line)) for line in lines]
        cells += [float(here[name].max()) for name in ("line_load", "hertz_pressure")]
        table.add_row(*(shown(cell) for cell in cells))
    return table


def _figures(mesh: xr.Dataset) -> Table:
    """Means over the period, and extremes with the place where they occur."""
    table = plain_table("Figures")
    for column in ("", "value", "unit", "at"):
        table.add_column(column, justify="right" if column == "value" else "left")
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
    span = float(error.max() - error.min())
    yield "transmission error, peak to peak", span, _OVER_PERIOD[0]
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
