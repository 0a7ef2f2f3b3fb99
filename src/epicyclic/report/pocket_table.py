"""The pockets of the meshes in tables: power and its balance, extremes with their place."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from rich.console import Group, RenderableType
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from epicyclic.report.shown import error_text, shown
from epicyclic.report.tables import plain_table
from epicyclic.results.result import of_gear
from epicyclic.units import unit_text

FloatArray = NDArray[np.float64]

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
_EXTREMES = (
    ("highest pressure", "pressure", np.nanargmax),
    ("lowest pressure", "pressure", np.nanargmin),
    ("fastest, along the face", "axial_speed", None),
    ("fastest, contact side", "contact_gap_speed", None),
    ("fastest, backlash side", "backlash_gap_speed", None),
    ("smallest section", "end_area", np.nanargmin),
    ("smallest backlash-side gap", "backlash_gap", np.nanargmin),
)
"""What to call them, variables, what picks them; None: the largest without its sign."""


def pocket_tables(meshes: dict[str, xr.Dataset]) -> RenderableType:
    """All meshes, one after the other, as `epicyclic.pocket_details` returns them."""
    parts: list[RenderableType] = []
    for mesh in meshes.values():
        title = Text(str(mesh.attrs["title"]), style="bold")
        parts += [title, _balance(mesh), _extremes(mesh)]
    models = dict.fromkeys(f"Model: {mesh.attrs['model']}." for mesh in meshes.values())
    notes = dict.fromkeys(
        line for mesh in meshes.values() for line in str(mesh.attrs["notes"]).splitlines()
    )
    parts.append(Text("\n".join(f"• {line}" for line in (*models, *notes))))
    return Group(*(Padding(part, (0, 0, 1, 0)) for part in parts))


def _balance(mesh: xr.Dataset) -> Table:
    table = _table("Figures", "", "value", "unit")
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
    table = _table("Extremes", "", "value", "unit", "pocket of", "roll angle", "across the face")
    for label, name, pick in _EXTREMES:
        values = mesh[name].to_numpy()
        index = _place(np.abs(values), np.nanargmax) if pick is None else _place(values, pick)
        table.add_row(label, *_at(mesh, name, index))
    return table


def _place(values: FloatArray, pick: Callable[[FloatArray], Any]) -> tuple[int, ...]:
    return tuple(map(int, np.unravel_index(int(pick(values)), values.shape)))


def _at(mesh: xr.Dataset, name: str, index: tuple[int, ...]) -> Iterator[str]:
    """Value, unit and place of one element."""
    kind, step, place = index
    position = f"{mesh[name].dims[-1]}_position"
    yield shown(float(mesh[name].to_numpy()[index]))
    yield _unit(mesh, name)
    yield f"tooth {of_gear(mesh['tooth'].to_numpy()[kind])}"
    yield f"{shown(float(mesh['roll_angle'][kind, step]), 3)} {_unit(mesh, 'roll_angle')}"
    yield f"{shown(float(mesh[position][place]), 3)} {_unit(mesh, position)}"


def _table(title: str, *columns: str) -> Table:
    table = plain_table(title)
    for column in columns:
        table.add_column(column, justify="right" if column == "value" else "left")
    return table


def _unit(mesh: xr.Dataset, name: str) -> str:
    return unit_text(str(mesh[name].attrs["units"]))
