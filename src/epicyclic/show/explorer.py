"""The explorer of a map or a sweep: its numbers, as the script of the page reads them."""

from __future__ import annotations

import base64
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.colors import to_hex

from epicyclic.show.page import Explorer, Item, Listing
from epicyclic.show.plots.loss_map import BEST_EFFICIENCY, EFFICIENCIES, LEAST_EFFICIENCY
from epicyclic.show.plots.style import COLOUR_MAP
from epicyclic.study.operating import OPERATING, PLANE, key_of
from epicyclic.units import WATT, unit_text

EXPLORER_LEAD = (
    "Move a slider with the mouse or the arrow keys, or click into a picture. Dots are computed "
    "points. Between them every number is interpolated linearly, and the efficiency follows from "
    "the interpolated powers. Names and whole numbers are not interpolated."
)

MOST_VALUES = 1_500_000  # That a page holds: 8 MB.
SHADES = 64  # Shades of the map.
SUMS = ("load_dependent", "load_independent", "total", "torque_loss", "input_power", "efficiency")
"""Below the losses."""
MAIN = ("total", "input_power", "efficiency")  # Without which there is nothing to explore.


def explorer_items(
    # A loss map or a sweep. If not all of its numbers fit into a page, the figures of the parts are
    # left out, then the single losses, then the explorer; the page says so.
    data: xr.Dataset,
) -> tuple[Item, ...]:
    """Sliders over all axes, losses at a point, a curve and a map; none without a varied axis."""
    axes = [str(dim) for dim in data["total"].dims if data.sizes[dim] > 1]
    if not axes:
        return ()
    at_rest = data.isel({dim: 0 for dim in data["total"].dims if dim not in axes})
    groups = _groups(at_rest)
    if "total" not in groups:
        return ()
    losses = {name: group for name, group in groups.items() if group != "figure"}
    main = {name: group for name, group in groups.items() if name in MAIN}
    room = MOST_VALUES // at_rest["total"].size
    for some in (groups, losses, main):
        if len(some) <= room:
            left_out = len(groups) - len(some)
            note = f"{left_out} further results are left out, because they are too many for a page."
            explorer = Explorer(_contents(at_rest, axes, some))
            return (explorer, *((Listing((note,)),) if left_out else ()))
    text = (
        f"{at_rest['total'].size} points are too many for an explorer within a page; the limit is "
        f"{MOST_VALUES // len(main)}. Vary fewer values, or fewer keys."
    )
    return (Listing((text,)),)


def _groups(data: xr.Dataset) -> dict[str, str]:
    """The results with numbers, and where each stands in the table: losses, sums, figures."""
    names = [str(name) for name in data.data_vars]
    first_sum = names.index(SUMS[0]) if SUMS[0] in names else 0
    groups: dict[str, list[str]] = {"loss": [], "sum": [], "figure": []}
    for place, name in enumerate(names):
        array = data[name]
        if array.dtype.kind != "f" or set(array.dims) != set(data["total"].dims):
            continue
        if not np.isfinite(array.values).any():
            continue
        is_loss = place < first_sum and array.attrs.get("units") == WATT.display
        groups["loss" if is_loss else "sum" if name in SUMS else "figure"].append(name)
    groups["sum"].sort(key=SUMS.index)
    return {name: group for group, own in groups.items() for name in own}


def _contents(data: xr.Dataset, axes: list[str], groups: dict[str, str]) -> dict[str, Any]:
    """Axes, results, and the values of all results, one after the other, packed."""
    values = [data[name].transpose(*axes).to_numpy().ravel() for name in groups]
    packed = np.concatenate(values).astype("<f4").tobytes()
    return {
        "axes": [_axis(data, name) for name in axes],
        "start": _start(data["total"].transpose(*axes)),
        "results": [_result(data[name], group) for name, group in groups.items()],
        "values": base64.b64encode(packed).decode(),
        "colours": [to_hex(one) for one in mpl.colormaps[COLOUR_MAP](np.linspace(0, 1, SHADES))],
        "efficiency": {"least": LEAST_EFFICIENCY, "best": BEST_EFFICIENCY, "ticks": EFFICIENCIES},
    }


def _axis(data: xr.Dataset, name: str) -> dict[str, Any]:
    """An axis with its values; between whole numbers and names there is nothing."""
    axis = data[name]
    unit = str(axis.attrs.get("units", "1"))
    return {
        "name": name,
        "label": _label(data, name),
        "unit": unit_text(unit),
        "key": key_of(axis),
        "stated": "" if unit == "1" else unit,
        "values": axis.values.tolist(),
        "continuous": axis.dtype.kind == "f" and bool((np.diff(axis.values) > 0).all()),
    }


def _start(total: xr.DataArray) -> list[int]:
    """Where to begin: indices of the solved point next to three quarters of every axis."""
    wanted = [_three_quarters(total[dim].to_numpy()) for dim in total.dims]
    solved = np.argwhere(np.isfinite(total.to_numpy()))
    start: list[int] = solved[np.abs(solved - wanted).sum(axis=1).argmin()].tolist()
    return start


def _three_quarters(axis: Any) -> int:
    """Index of the value nearest to three quarters of a numeric axis, 0 of names."""
    if axis.dtype.kind not in "fiu":
        return 0
    return int(np.abs(axis - (0.25 * axis.min() + 0.75 * axis.max())).argmin())


def _label(data: xr.Dataset, name: str) -> str:
    """``"speed of the sun"`` of a map, the key of a sweep."""
    shaft = data.attrs.get("reference_shaft")
    if shaft and name in PLANE:
        return f"{name} {'of' if name == PLANE[0] else 'on'} the {shaft}"
    if name in OPERATING:
        return OPERATING[name].label
    return str(data[name].attrs.get("long_name", name))


def _result(values: xr.DataArray, group: str) -> dict[str, str]:
    return {
        "name": str(values.name),
        "label": str(values.attrs["long_name"]),
        "unit": unit_text(str(values.attrs["units"])),
        "group": group,
    }
