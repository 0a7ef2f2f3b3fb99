"""Maps as tables of points: NetCDF, CSV, Parquet."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from epicyclic.case.wording import one_line
from epicyclic.sweeps.dataset import to_table

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["statements", "write_csv", "write_netcdf", "write_parquet"]

_STATED = (
    "title",
    "source",
    "reference_shaft",
    "output_shaft",
    "sign_convention",
    "torque_loss_definition",
    "zero_speed",
    "zero_torque",
    "conventions",
)
_LONGEST_STATEMENT = 1000


def statements(data: xr.Dataset) -> dict[str, str]:
    """What a reader of a map must know, each on one line."""
    return {
        name.replace("_", " "): one_line(str(data.attrs.get(name, "")), _LONGEST_STATEMENT)
        for name in _STATED
    }


def write_netcdf(data: xr.Dataset, path: Path) -> None:
    """All variables, units and attributes."""
    data.to_netcdf(path, engine="netcdf4")


def write_csv(data: xr.Dataset, path: Path) -> None:
    """One row a point, after lines that begin with ``#``."""
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines(f"# {name}: {text}\n" for name, text in statements(data).items())
        to_table(data).to_csv(file, index=False, lineterminator="\n")


def write_parquet(data: xr.Dataset, path: Path) -> None:
    """One row a point; the attributes of the map are those of the table."""
    to_table(data).to_parquet(path, index=False)
