"""Maps as MATLAB scripts of breakpoints and tables, for blocks of Simscape and Simulink.

Names and order are those of the blocks of Powertrain Blockset that look up an efficiency over
torque, speed and temperature (MathWorks, reference page of the Gearbox block: eta_tbl over
Trq_bpts, omega_bpts and Temp_bpts); they take efficiencies above 0 and up to 1, temperatures in K.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from epicyclic.case.operating import STATE
from epicyclic.maps.tables import stated
from epicyclic.units import CELSIUS, RPM, format_number

if TYPE_CHECKING:
    import xarray as xr

_BREAKPOINTS = {"torque": "Trq_bpts", "speed": "omega_bpts", "temperature": "Temp_bpts"}
_LEAST_EFFICIENCY = 1e-3
"""Stands for none: where the loss takes all of the power, and where there is no power."""
_DIGITS = 10
_NUMBERS_PER_LINE = 8


def write_simscape(data: xr.Dataset, path: Path) -> None:
    """Vectors Trq_bpts, omega_bpts, Temp_bpts; tables torque_loss_tbl, power_loss_tbl, eta_tbl."""
    path.write_text("\n".join(_script(data)) + "\n", encoding="utf-8")


def _script(data: xr.Dataset) -> Iterator[str]:
    order = tuple(name for name in (*_BREAKPOINTS, STATE) if name in data["torque_loss"].dims)
    yield from (f"% {name}: {text}" for name, text in stated(data, order).items())
    rpm, _ = RPM.scale_and_offset()
    _, zero = CELSIUS.scale_and_offset()
    yield from _vector("Trq_bpts", data["torque"].values, "N*m")
    yield from _vector("omega_bpts", data["speed"].values / rpm, "rad/s")
    if "temperature" in order:
        yield from _vector("Temp_bpts", data["temperature"].values - zero, "K")
    if STATE in order:
        names = (str(name).replace("'", "''") for name in data[STATE].values)
        quoted = ", ".join(f"'{name}'" for name in names)
        yield f"state_names = {{{quoted}}};"
        yield from _vector("ratio", data["ratio"].values.ravel(), "of each state, in over out")
    efficiency = data["efficiency"].fillna(0).clip(_LEAST_EFFICIENCY, 1)
    shaft = data["torque_loss"]
    yield from _table("torque_loss_tbl", shaft, order, "N*m, at the reference shaft")
    yield from _table("power_loss_tbl", data["total"], order, "W")
    about = f"1; {format_number(_LEAST_EFFICIENCY)} where no power is passed on"
    yield from _table("eta_tbl", efficiency, order, about)


def _vector(name: str, values: Iterable[float], about: str) -> Iterator[str]:
    yield f"{name} = [{' '.join(format_number(value, _DIGITS) for value in values)}]; % {about}"


def _table(name: str, array: xr.DataArray, order: tuple[str, ...], about: str) -> Iterator[str]:
    """Lines that set a table over the axes `order`, the first fastest."""
    chosen = array.isel({axis: 0 for axis in array.dims if axis not in order}).transpose(*order)
    sizes = " ".join(str(chosen.sizes[axis]) for axis in order)
    over = ", ".join(_BREAKPOINTS.get(axis, "state_names") for axis in order)
    numbers = [format_number(value, _DIGITS) for value in chosen.values.ravel(order="F")]
    yield f"{name} = reshape([ ... % over {over}: {about}"
    for start in range(0, len(numbers), _NUMBERS_PER_LINE):
        yield f"    {' '.join(numbers[start : start + _NUMBERS_PER_LINE])} ..."
    yield f"], [{sizes}]);"
