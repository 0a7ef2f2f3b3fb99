"""Names of what a sweep varies: without dots, and the keys with their dots beside them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any

import xarray as xr

from epicyclic.study.operating import CASE_KEY, axis_name, key_of


def _by_key(isel: Callable[..., Any]) -> Callable[..., Any]:
    """A method `isel` to which dimensions may also be named by their keys."""

    @wraps(isel)
    def chosen(
        data: Any, indexers: Mapping[str, Any] | None = None, *options: Any, **named: Any
    ) -> Any:
        dims = {array.attrs.get(CASE_KEY): name for name, array in data.coords.variables.items()}
        given = {**(indexers or {}), **named}
        return isel(data, None, *options, **{dims.get(key, key): it for key, it in given.items()})

    return chosen


class SweepArray(xr.DataArray):
    """A variable of a sweep."""

    __slots__ = ()
    isel = _by_key(xr.DataArray.isel)


class SweepData(xr.Dataset):
    """What `sweep` returns."""

    __slots__ = ()
    isel = _by_key(xr.Dataset.isel)

    def __getitem__(self, key: Any) -> Any:
        """A variable or a part, as of any dataset."""
        found = super().__getitem__(key)
        return SweepArray(found) if isinstance(found, xr.DataArray) else found


def with_plain_names(data: xr.Dataset) -> SweepData:
    """A sweep whose dimensions have no dots; those of files of earlier versions had.

    A key that is also the name of a result is called ``"sun_mesh_misalignment_given"``.
    """
    arrays = data.coords.items()
    names = {key_of(array): str(name) for name, array in arrays if CASE_KEY in array.attrs}
    added = {}
    for key in (str(name) for name in data.coords if "." in str(name)):
        if key not in names:
            name = axis_name(key)
            name = f"{name}_given" if name in data else name
            while name in data or name in added:
                name += "_"
            names[key] = name
            old = data[key]
            added[name] = (old.dims, old.values, old.attrs | {CASE_KEY: key})
    renamed = {str(dim): names[str(dim)] for dim in data.dims if dim in names}
    data = data.assign_coords(added).swap_dims(renamed)
    return SweepData(data.variables, attrs=data.attrs).set_coords(list(data.coords))
