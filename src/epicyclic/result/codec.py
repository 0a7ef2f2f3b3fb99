"""Dataclasses as plain numbers and text, as JSON has them, and read back with checks.

The fields say how: `stored` gives a field another key, a unit, or an attribute that becomes the
key of its items. Of a class with labelled figures only these are kept.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from epicyclic.machine.element import displayed
from epicyclic.units import Quantity


def stored(*, key: str = "", unit: Quantity | None = None, index: str = "") -> dict[str, Any]:
    """Metadata of a field: its place in the JSON form."""
    return {"key": key, "unit": unit, "index": index}


def plain(value: Any, unit: Quantity | None = None, index: str = "") -> Any:
    """`value` as plain numbers and text, those of a `unit` with it; None for every NaN."""
    if dataclasses.is_dataclass(value):
        return {key: _plain_field(value, it) for key, it in _fields(type(value))}
    if isinstance(value, Mapping):
        return {name: plain(item, unit) for name, item in value.items()}
    if isinstance(value, list | tuple):
        if index:
            named = ((getattr(item, index), plain(item)) for item in value)
            return {name: {k: v for k, v in item.items() if k != index} for name, item in named}
        numbers = [plain(_shown(item, unit)) for item in value]
        return {"value": numbers, "unit": unit.display or "1"} if unit else numbers
    if isinstance(value, float):
        number = _number(_shown(value, unit))
        return {"value": number, "unit": unit.display or "1"} if unit else number
    return value


def _fields(kind: Any) -> Iterator[tuple[str, dataclasses.Field[Any]]]:
    """The fields that are kept, by their keys."""
    fields = dataclasses.fields(kind)
    labelled = [it for it in fields if "label" in it.metadata]
    for it in labelled or fields:
        yield it.metadata.get("key") or it.name, it


def _shown(value: Any, unit: Quantity | None) -> Any:
    return unit.to_display(value) if unit and unit.si != unit.display else value


def _plain_field(owner: Any, it: dataclasses.Field[Any]) -> Any:
    unit: Quantity | None = it.metadata.get("unit")
    if unit is not None and "label" in it.metadata:
        return {"value": _number(displayed(owner, it)), "unit": unit.display or "1"}
    return plain(getattr(owner, it.name), unit, it.metadata.get("index", ""))


def _number(value: float) -> float | None:
    return None if math.isnan(value) else value + 0.0  # no -0.0


class Reader:
    """Makes dataclasses of what `plain` made of them, and notes what cannot be."""

    def __init__(self) -> None:
        self.problems: list[tuple[str, str]] = []  # Places and what is wrong there.

    def read(
        self, kind: Any, data: Any, place: str, unit: Quantity | None = None, index: str = ""
    ) -> Any:
        """`data` as a value of the type `kind`."""
        origin, inner = get_origin(kind), get_args(kind)
        if origin in (Union, UnionType):
            if data is None and NoneType in inner:
                return None
            return self.read(_nearest(inner, data), data, place, unit, index)
        if origin is Literal:
            *names, last = map(repr, inner)
            expected = f"{', '.join(names)} or {last}" if names else last
            return data if data in inner else self.refuse(place, f"Input should be {expected}")
        if isinstance(kind, type) and dataclasses.is_dataclass(kind):
            kinds = tuple(kind.__subclasses__()) or (kind,)  # a base stands for its classes
            nearest = _nearest(kinds, data)
            if len(kinds) > 1 and not {key for key, _ in _fields(nearest)} & {*data}:
                return self.refuse(place, "has none of the figures that are known here")
            return self._object(nearest, data, place)
        if origin is tuple and index and isinstance(data, dict):
            items = {name: {index: name, **it} for name, it in data.items() if isinstance(it, dict)}
            return tuple(self.read(inner[0], it, f"{place}.{name}") for name, it in items.items())
        if unit is not None and (kind is float or origin is tuple):
            return self._measure(kind, data, place, unit)
        if origin is tuple and isinstance(data, list):
            return tuple(self.read(inner[0], it, f"{place}.{n}") for n, it in enumerate(data))
        if origin is not None and issubclass(origin, Mapping) and isinstance(data, dict):
            return {
                name: self.read(inner[1], it, f"{place}.{name}", unit) for name, it in data.items()
            }
        return self._simple(origin or kind, data, place)

    def refuse(self, place: str, what: str) -> None:
        """Note a problem."""
        self.problems.append((place, what))

    def _simple(self, kind: Any, data: Any, place: str) -> Any:
        if kind is Any:
            return data
        if kind is float and isinstance(data, int | float) and not isinstance(data, bool):
            if math.isfinite(data):
                return float(data)
            return self.refuse(place, "Input should be a finite number")
        if kind in (str, bool, int) and type(data) is kind:
            return data
        names = {float: "number", str: "string", bool: "boolean", int: "integer", tuple: "tuple"}
        return self.refuse(place, f"Input should be a valid {names.get(kind, 'dictionary')}")

    def _object(self, kind: Any, data: Any, place: str) -> Any:
        if not isinstance(data, dict):
            return self.refuse(place, "Input should be a valid dictionary")
        types, before = get_type_hints(kind), len(self.problems)
        found: dict[str, Any] = {}
        for key, it in _fields(kind):
            unit, index = it.metadata.get("unit"), it.metadata.get("index", "")
            if key in data:
                of = types[it.name]
                lacks = data[key] is None and of is float and unit is None
                at = f"{place}.{key}"
                found[it.name] = math.nan if lacks else self.read(of, data[key], at, unit, index)
            elif "label" not in it.metadata and it.default is dataclasses.MISSING:
                self.refuse(f"{place}.{key}", "Field required")
        for it in dataclasses.fields(kind):
            if "label" in it.metadata or dict(_fields(kind)).get(it.name) is None:
                found.setdefault(it.name, math.nan if types[it.name] is float else None)
        return kind(**found) if len(self.problems) == before else None

    def _measure(self, kind: Any, data: Any, place: str, unit: Quantity) -> Any:
        """What is stated with its unit: a number, NaN if there is none, or several."""
        if not isinstance(data, dict):
            return self.refuse(place, "Input should be a valid dictionary")
        for key in {"value", "unit"} - data.keys():
            return self.refuse(f"{place}.{key}", "Field required")
        if data["unit"] != (unit.display or "1"):
            return self.refuse(f"{place}.unit", f"Input should be {unit.display or '1'!r}")
        if kind is float and data["value"] is None:
            return math.nan
        found = self.read(kind, data["value"], f"{place}.value")
        if isinstance(found, tuple):
            return tuple(unit.from_display(it) for it in found if it is not None)
        return None if found is None else unit.from_display(found)


def _nearest(kinds: tuple[Any, ...], data: Any) -> Any:
    """Of several types that whose keys are most like those of `data`."""
    several = [kind for kind in kinds if kind is not NoneType]
    if len(several) == 1 or not isinstance(data, dict):
        return several[0]
    return min(several, key=lambda kind: len({key for key, _ in _fields(kind)} ^ data.keys()))
