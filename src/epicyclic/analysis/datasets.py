"""Variables of datasets: values in the units that users see, with label and unit."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.units import Quantity

Array = NDArray[np.float64] | NDArray[np.bool_]
Variable = tuple[tuple[str, ...], Array, dict[str, Any]]


def variable(
    dims: str | tuple[str, ...], values: Array | float, label: str, unit: Quantity
) -> Variable:
    """`values`, in SI, as a variable over `dims`, for the constructor of `xarray.Dataset`."""
    scale, offset = unit.scale_and_offset()
    attributes = {"long_name": label, "units": unit.display or "1"}
    return (
        (dims,) if isinstance(dims, str) else dims,
        np.asarray(values) * scale + offset,
        attributes,
    )
