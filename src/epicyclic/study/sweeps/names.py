"""Names of what a sweep varies: without dots, and the keys with their dots beside them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

import xarray as xr
from xarray.core.types import ErrorOptionsWithWarn

from epicyclic.study.operating import CASE_KEY, axis_name, key_of


class SweepArray(xr.DataArray):  # type: ignore[no-untyped-call]
    """A variable of a sweep."""

    __slots__ = ()

    def isel(
        self,
        indexers: Mapping[Any, Any] | None = None,
        drop: bool = False,
        missing_dims: ErrorOptionsWithWarn = "raise",
        **names: Any,
    ) -> Self:
        """As of any array; dimensions may be named by their keys."""
        return super().isel(_by_dimension(self, {**(indexers or {}), **names}), drop, missing_dims)


class SweepData(xr.Dataset):  # type: ignore[no-untyped-call]
    """What `sweep` returns."""

    __slots__ = ()

    def __getitem__(self, key: Any) -> Any:
        """A variable or a part, as of any dataset."""
        found = super().__getitem__(key)
        return SweepArray(found) if isinstance(found, xr.DataArray) else found

    def isel(
        self,
        indexers: Mapping[Any, Any] | None = None,
        drop: bool = False,
        missing_dims: ErrorOptionsWithWarn = "raise",
        **names: Any,
    ) -> Self:
        """As of any dataset; dimensions may be named by their keys."""
        return super().isel(_by_dimension(self, {**(indexers or {}), **names}), drop, missing_dims)


def _by_dimension(data: xr.DataArray | xr.Dataset, given: dict[Any, Any]) -> dict[Any, Any]:
    dims = {array.attrs.get(CASE_KEY): name for name, array in data.coords.variables.items()}
    return {dims.get(name, name): value for name, value in given.items()}


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
