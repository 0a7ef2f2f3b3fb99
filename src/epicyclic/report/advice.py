"""What limits the trust in a result, in sentences."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from epicyclic.bands.advice import limits_of, measurements_of
from epicyclic.results.result import Result
from epicyclic.units import format_number

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["advice_texts", "result_json"]

FEW = 2
"""Limits that a short list names."""
WORTH = 0.98
"""Part of the band above which a measurement is not worth while. [1]"""


def advice_texts(data: xr.Dataset, *, brief: bool = False) -> Iterator[str]:
    """Sentences on limits, on the measurement that helps most, and on models, in this order.

    Parameters
    ----------
    data : xarray.Dataset
        As `epicyclic.uncertainty` returns it of a case or cycle, or as it is kept with a result.
    brief : bool
        Only the most important ones.
    """
    unit = str(data["unit"].sel(result="total").values)
    for limit in limits_of(data)[: FEW if brief else None]:
        yield f"{limit.name}: {format_number(limit.width, 3)} {unit} of the band; {limit.advice}."
    yield from _measurements(data, unit)
    remarks = str(data.attrs["remarks"]).splitlines()
    if remarks:
        yield from [" ".join(remarks)] if brief else remarks


def _measurements(data: xr.Dataset, unit: str) -> Iterator[str]:
    """The part of the loss, and the input, whose measurement narrows the band most."""
    total = data.sel(result="total")
    whole = float(total["high"] - total["low"])
    found = [it for it in measurements_of(data) if it.width < WORTH * whole]
    best = [next((it for it in found if it.is_input is own), None) for own in (False, True)]
    parts = [f"{it.name} to {format_number(it.width, 3)} {unit}" for it in best if it is not None]
    if parts:
        before = f"{format_number(whole, 3)} {unit}"
        lead = "" if best[0] is not None else "of the inputs "
        text = "; of the inputs ".join(parts)
        yield f"Measured, this would narrow the band of {before} most: {lead}{text}."


def result_json(result: Result, data: xr.Dataset | None) -> str:
    """A result as JSON with its band and what limits the trust in it, unless all is exact."""
    content = result.to_dict() | ({} if data is None else _known(data))
    return json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False)


def _known(data: xr.Dataset) -> dict[str, Any]:
    ends = {
        name: [float(data[end].sel(result=name)) for end in ("low", "high")]
        for name in ("total", "efficiency")
    }
    shares = data["first_order"].sel(sum="total").to_series().sort_values(ascending=False)
    return {
        "band": {
            **{name: own if math.isfinite(own[0]) else None for name, own in ends.items()},
            "shares": {str(key): float(share) for key, share in shares.items()},
        },
        "advice": {
            "limits": [
                {"name": it.name, "width": it.width, "advice": it.advice} for it in limits_of(data)
            ],
            "measurements": [{"name": it.name, "width": it.width} for it in measurements_of(data)],
            "remarks": str(data.attrs["remarks"]).splitlines(),
            "unit": str(data["unit"].sel(result="total").values),
        },
    }
