"""What a stored map tells of its case, without solving it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from epicyclic.case.case import Case, load_case
from epicyclic.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["map_case", "map_inputs"]


def map_inputs(data: xr.Dataset) -> dict[str, Any]:
    """The inputs of a map, as a case file has them."""
    inputs: dict[str, Any] = json.loads(data.attrs["case"])
    return inputs


def map_case(data: xr.Dataset) -> Case | None:
    """The case of a map; None if it is none of this version."""
    try:
        return load_case(map_inputs(data))
    except InputError:
        return None
