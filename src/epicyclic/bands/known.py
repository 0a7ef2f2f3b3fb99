"""How well a result is known: what sentences about it need, however it was found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from numpy.typing import NDArray

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr


@dataclass(frozen=True, slots=True)
class Known:
    """The band of a result, what makes it, and what to know of it."""

    unit: str  # Unit of the total and its parts.
    nominal: Mapping[str, float]  # Results of the case.
    ends: Mapping[str, tuple[float, float]]  # Ends of the symmetric 95 % interval of each result.
    draws: Mapping[str, NDArray[np.float64]]  # What each result may be.
    shares: Mapping[str, float]  # Shares of drivers in the variance of the total, each alone. [1]
    names: Mapping[str, str]  # What each input is called, and how to know it better.
    advice: Mapping[str, str]  # What each input is called, and how to know it better.
    remarks: tuple[str, ...]  # Sentences on warnings and models.

    @property
    def width(self) -> float:
        """Width of the band of the total."""
        low, high = self.ends["total"]
        return high - low

    @property
    def drivers(self) -> list[tuple[str, float]]:
        """Drivers with their shares, the largest first."""
        return sorted(self.shares.items(), key=lambda item: -item[1])


def known_of(data: xr.Dataset) -> Known:
    """What a dataset of `uncertainty`, of a case or cycle or kept with a result, says."""
    results = [str(name) for name in data["result"].values]
    inputs = [str(key) for key in data["input"].values]
    own = data["first_order"].sel(sum="total").clip(0.0, 1.0)
    ends = zip(data["low"].values.tolist(), data["high"].values.tolist(), strict=True)
    return Known(
        unit=str(data["unit"].sel(result="total").values),
        nominal=dict(zip(results, data["nominal"].values.tolist(), strict=True)),
        ends=dict(zip(results, ends, strict=True)),
        draws=dict(zip(results, data["value"].values, strict=True)),
        shares=dict(zip(map(str, own["driver"].values), own.values.tolist(), strict=True)),
        names=dict(zip(inputs, map(str, data["input_name"].values), strict=True)),
        advice=dict(zip(inputs, map(str, data["input_advice"].values), strict=True)),
        remarks=tuple(str(data.attrs["remarks"]).splitlines()),
    )
