"""Checks of what a file holds, so that reports and plots can rely on it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from epicyclic.errors import Problem
from epicyclic.study.operating import AXES

if TYPE_CHECKING:
    import xarray as xr

RUN_AGAIN = (
    "Write it again: epicyclic run CASE --save FILE.nc, or epicyclic map CASE ... -o FILE.nc."
)
MOST_TEETH = 5000
LARGEST_VALUE = 1e12
"""No number of a gear set is larger, in the units that users see."""
_ROUNDING = 1e-9
_LIMITS = {
    "total": (0.0, LARGEST_VALUE),
    "torque_loss": (0.0, LARGEST_VALUE),
    "efficiency": (-LARGEST_VALUE, 1.0 + _ROUNDING),
}
"""Limits of numbers that have others than these in a map or a sweep."""

_MESH = ("mesh_position", "contact_line", "segment")
_POCKET = ("tooth", "roll")
_Needed = Mapping[tuple[str, ...], str]

_NEEDED: dict[str, _Needed] = {
    "meshes": {
        _MESH[:1]: "roll_angle weight transmission_error mesh_stiffness",
        _MESH[:2]: "pair_load",
        _MESH: "path_position face_position line_load hertz_pressure sliding_speed film_ratio "
        "friction_coefficient friction_power",
    },
    "gears": {
        ("place",): "center_x center_y direction",
        (): "reference_diameter base_diameter tip_diameter root_diameter outside_diameter",
    },
    "views": {
        ("gear",): "center_x center_y direction operating_radius",
        ("end",): "path_x path_y",
        (): "pressure_angle",
    },
    "bearings": {
        ("roller",): "azimuth",
        ("row", "slice"): "axial_position",
        ("row", "roller"): "load",
        ("row", "roller", "slice"): "line_load pressure",
    },
    "pockets": {
        _POCKET: "roll_angle volume",
        (*_POCKET, "slice"): "pressure contact_gap_speed backlash_gap_speed",
        (*_POCKET, "station"): "end_area contact_gap backlash_gap axial_speed",
        ("mesh_position",): "period_angle instant_power",
        ("slice",): "slice_position",
        ("station",): "station_position",
        (): "power",
    },
    "uncertainty": {
        ("result",): "nominal mean standard_uncertainty expanded_uncertainty low high shortest_low "
        "shortest_high",
        ("input", "result"): "contribution",
        ("sum", "driver"): "first_order",
        ("result", "sample"): "value",
        ("input",): "input_value input_uncertainty cut_off",
    },
}
"""Numbers that plots read in each group, by their dimensions."""
_ATTRIBUTES: dict[str, tuple[tuple[str, type], ...]] = {
    "meshes": (("title", str), ("pitch_angle_deg", float)),
    "gears": (("name", str),),
    "uncertainty": (("title", str), ("grouping", str), ("left_out", str), ("remarks", str)),
}
_UNCERTAINTY_TEXTS = {
    "result": ("result", "unit"),
    "input": (
        "input",
        "input_unit",
        "input_name",
        "input_advice",
        "distribution",
        "distribution_source",
    ),
    "driver": ("driver",),
    "sum": ("sum",),
}
"""Limits of uncertain inputs, by their dimension."""
_MAY_LACK = {"meshes", "pockets", "uncertainty"}
"""Groups with NaN where nothing touches, or no pocket is; but places are known everywhere."""
_PLACES = {
    "roll_angle",
    "weight",
    "path_position",
    "face_position",
    "slice_position",
    "station_position",
    "period_angle",
}
_MAP_NUMBERS = ("torque_loss", "total", "efficiency")
_MAP_TEXTS = ("status", "message", "warnings")


def field_problems(path: str, data: xr.Dataset) -> Iterator[Problem]:
    """What plots would miss in one field of a result."""
    group = path.partition("/")[0]
    if group not in _NEEDED:
        return  # of a later version
    for dims, names in _NEEDED[group].items():
        for variable in names.split():
            yield from _number_problems(f"{path}/{variable}", data, variable, dims)
            if group not in _MAY_LACK or variable in _PLACES:
                yield from _value_problems(f"{path}/{variable}", data, variable)
    yield from _label_problems(path, data)
    for attribute, kind in _ATTRIBUTES.get(group, ()):
        if not isinstance(data.attrs.get(attribute), kind):
            yield Problem(f"{path}/{attribute}", "", "is missing.", RUN_AGAIN)
    if group == "gears":
        yield from _gear_problems(path, data)
    if group == "uncertainty":
        yield from _uncertainty_problems(path, data)


def map_problems(data: xr.Dataset) -> Iterator[Problem]:
    """What plots and reports would miss in a loss map."""
    dims = data["torque_loss"].dims
    for axis in AXES:
        if axis == "temperature" and axis not in data.coords:
            continue  # a train whose losses are all given has no oil
        if axis not in dims:
            yield Problem(axis, "", "is no axis of the map.", RUN_AGAIN)
        else:
            yield from _number_problems(axis, data, axis, (axis,))
    for name in _MAP_NUMBERS:
        yield from _number_problems(name, data, name, tuple(map(str, dims)))
    for name in _MAP_TEXTS:
        if name not in data or data[name].dtype.kind not in "OU":
            yield Problem(name, "", "must be text for every point.", RUN_AGAIN)
    yield from _label_problems("", data)


def sweep_problems(data: xr.Dataset) -> Iterator[Problem]:
    """What plots would miss in a sweep."""
    dims = tuple(map(str, data["total"].dims))
    for dim in dims:
        if dim not in data.coords or data[dim].dtype.kind not in "fiuOU":
            yield Problem(dim, "", "must be numbers or names.", RUN_AGAIN)
    for name in ("total", "efficiency"):
        yield from _number_problems(name, data, name, dims)
    yield from _label_problems("", data)


def _number_problems(
    place: str, data: xr.Dataset, name: str, dims: tuple[str, ...]
) -> Iterator[Problem]:
    if name not in data.variables:
        yield Problem(place, "", "is missing.", RUN_AGAIN)
        return
    array = data[name]
    if array.dtype.kind != "f" or set(array.dims) != set(dims) or not array.size:
        over = f"over {', '.join(dims)}" if dims else "alone"
        yield Problem(place, "", f"must be numbers {over}.", RUN_AGAIN)
        return
    low, high = _LIMITS.get(name, (-LARGEST_VALUE, LARGEST_VALUE))
    values = array.to_numpy()
    if (values > high).any():
        yield Problem(place, "", f"must not exceed {high:g}.", RUN_AGAIN)
    if (values < low).any():
        yield Problem(place, "", f"must not be below {low:g}.", RUN_AGAIN)


def _value_problems(place: str, data: xr.Dataset, name: str) -> Iterator[Problem]:
    """Where numbers are known everywhere; diameters and radii are lengths."""
    if name not in data.variables or data[name].dtype.kind != "f":
        return
    values = data[name].to_numpy()
    if np.isnan(values).any():
        yield Problem(place, "", "must not lack values.", RUN_AGAIN)
    if name.endswith(("diameter", "radius")) and (values <= 0).any():
        yield Problem(place, "", "must be positive.", RUN_AGAIN)


def _label_problems(path: str, data: xr.Dataset) -> Iterator[Problem]:
    for name, array in data.variables.items():
        labels = (array.attrs.get("long_name"), array.attrs.get("units"))
        if array.dtype.kind == "f" and not all(isinstance(label, str) for label in labels):
            yield Problem(f"{path}/{name}", "", "has no label or no unit.", RUN_AGAIN)


def _gear_problems(path: str, data: xr.Dataset) -> Iterator[Problem]:
    """Teeth are counted, and drawn one by one."""
    teeth, internal = (data.attrs.get(name) for name in ("teeth", "internal"))
    if internal not in (0, 1):
        yield Problem(f"{path}/internal", str(internal), "must be 0 or 1.", RUN_AGAIN)
    if not isinstance(teeth, int | np.integer) or not 1 <= teeth <= MOST_TEETH:
        allowed = f"must be a whole number from 1 to {MOST_TEETH}."
        yield Problem(f"{path}/teeth", str(teeth), allowed, RUN_AGAIN)
    for name in ("x", "y"):
        if name in data:
            yield from _number_problems(f"{path}/{name}", data, name, ("point",))
            yield from _value_problems(f"{path}/{name}", data, name)


def _uncertainty_problems(path: str, data: xr.Dataset) -> Iterator[Problem]:
    """Names are text, all that tables look for among them."""
    for dim, names in _UNCERTAINTY_TEXTS.items():
        for name in names:
            if name not in data.variables or data[name].dims != (dim,):
                yield Problem(f"{path}/{name}", "", f"is missing for every {dim}.", RUN_AGAIN)
            elif data[name].dtype.kind not in "OU":
                yield Problem(f"{path}/{name}", "", "must be text.", RUN_AGAIN)
    known = data["result"].values if "result" in data.variables else ()
    needed = {"total", "efficiency", "load_dependent", "load_independent"}
    lacking = needed - set(map(str, known))
    if lacking:
        yield Problem(f"{path}/result", "", f"lacks {', '.join(sorted(lacking))}.", RUN_AGAIN)
    if not isinstance(data.attrs.get("failed"), int | np.integer):
        yield Problem(f"{path}/failed", "", "must be a number.", RUN_AGAIN)
