"""The operating point, as maps, cycles, measurements and their figures call its parts."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass
from epicyclic.units import CELSIUS, NEWTON_METRE, RPM, Quantity, torque_text, unit_text

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, slots=True)
class OperatingValue:
    """A part of the operating point: its key in a case, its name in print, its quantity."""

    key: str
    label: str
    quantity: Quantity

    @property
    def unit(self) -> str:
        """Unit of columns and axes."""
        return self.quantity.display

    def text(self, value: float) -> str:
        """A `value` in that unit, as a case file has it."""
        return f"{value!r} {self.unit}"


OPERATING = {
    "speed": OperatingValue("operation.speed", "speed", RPM),
    "torque": OperatingValue("operation.torque", "torque", NEWTON_METRE),
    "temperature": OperatingValue("operation.oil_inlet_temperature", "oil temperature", CELSIUS),
}
"""By the name of the axis of a map and of the column of a table."""
AXES = {name: part.key for name, part in OPERATING.items()}
"""Key of each; a train whose losses are all given has no temperature."""
PLANE = ("speed", "torque")  # Axes of the tables and pictures of a map.
STATE, STATE_KEY = "state", "operation.state"
"""Axis, column and key of the states of a train that has any."""
CASE_KEY = "case_key"  # Attribute of a coordinate: the key that it varies.
NAMES = {key: name for name, key in AXES.items()} | {STATE_KEY: STATE}
"""The same by its key."""


def shaft_power(torque: FloatArray, speed: FloatArray) -> FloatArray:
    """Power in W of a torque in N m at a speed in rpm."""
    to_rpm, _ = RPM.scale_and_offset()
    return torque * speed / to_rpm


def axis_name(key: str) -> str:
    """Name of the dimension of a key: ``"speed"``, ``"planet_count"`` for ``"planet.count"``."""
    return NAMES.get(key, re.sub(r"\W", "_", key))


def key_of(array: xr.DataArray) -> str:
    """The key that a coordinate of a map or sweep varies; its name if it is none of a case."""
    return str(array.attrs.get(CASE_KEY, array.name))


def operating_line(operation: Mapping[str, Any]) -> str:
    """The operating point, the table ``operation`` of a case, in one line; without varied keys."""
    words = [RPM.text(RPM.parse(operation["speed"]))] if "speed" in operation else []
    if "torque" in operation:
        words.append(torque_text(NEWTON_METRE.parse(operation["torque"])))
    if {"input", "output"} <= operation.keys():
        words.insert(0, f"{operation['input']} to {operation['output']}")
    elif "input" in operation:
        words.insert(0, f"input {operation['input']}")
    if operation.get("state"):
        words.insert(0, f"state {operation['state']}")
    if operation.get("fixed"):
        words.append(f"{operation['fixed']} fixed")
    if "oil_inlet_temperature" in operation:
        words.append(f"oil at {CELSIUS.text(CELSIUS.parse(operation['oil_inlet_temperature']))}")
    return unit_text(", ".join(words))
