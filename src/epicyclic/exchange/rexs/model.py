"""What a REXS file holds, whichever form it has: components, their attributes and relations."""

from __future__ import annotations

import base64
import binascii
import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from epicyclic.case.wording import one_line
from epicyclic.errors import InputError, Problem
from epicyclic.exchange.rexs.vocabulary import term, types_of, unit_of

_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_CODES = {"float64": "<f8", "float32": "<f4", "int32": "<i4"}


class _KindError(ValueError):
    """A value of another type than the attribute needs."""


def refuse(allowed: str, remedy: str = "Correct the file.") -> InputError:
    """The error of a file that cannot be used as a whole."""
    return InputError([Problem("", "", f"the file {allowed}", remedy)])


@dataclass(frozen=True, slots=True)
class Coded:
    """An array as bytes in base64, little-endian."""

    code: str
    text: str

    def numbers(self) -> tuple[float, ...]:
        """The numbers; ValueError if there are none."""
        kind = _CODES.get(self.code)
        if kind is None:
            raise ValueError("is an array of unknown code")
        try:
            content = base64.b64decode("".join(self.text.split()), validate=True)
            return tuple(np.frombuffer(content, kind).astype(float).tolist())
        except (binascii.Error, ValueError):
            raise ValueError("is not an array in base64") from None


@dataclass(frozen=True, slots=True)
class Attribute:
    """One attribute as the file has it: `value` is text, a number, true, an array or nothing."""

    id: str
    unit: str | None
    value: Any

    def number(self) -> float:
        """The value as a number; ValueError with what is wrong if it is none."""
        return _number(self.value)

    def numbers(self) -> tuple[float, ...]:
        """The value as an array of numbers; ValueError with what is wrong if it is none."""
        if isinstance(self.value, Coded):
            return self.value.numbers()
        if not isinstance(self.value, tuple):
            raise _KindError("is not an array")
        return tuple(map(_number, self.value))

    def flags(self) -> tuple[bool, ...]:
        """The value, or those of an array, as true or false; ValueError if it is neither."""
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        known = {"true": True, "false": False}
        flags = tuple(known[text] for text in map(str.lower, map(str, values)) if text in known)
        if len(flags) < len(values) or not flags:
            raise ValueError("is neither true nor false")
        return flags

    def flag(self) -> bool:
        """The value as true or false, all of an array; ValueError if it is neither."""
        return all(self.flags())

    def text(self) -> str:
        """The value as one line of text."""
        return one_line(str(self.value).strip())


def _number(value: Any) -> float:
    if isinstance(value, str):
        if _NUMBER.fullmatch(value.strip()) is None:
            raise ValueError("is not a finite number")
        value = float(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise _KindError("is not a number")
    try:
        number = float(value)
    except OverflowError:  # a whole number of hundreds of digits
        number = math.inf
    if not math.isfinite(number):
        raise ValueError("is not a finite number")
    return number


@dataclass(frozen=True, slots=True)
class Component:
    """A machine part, a stage, a load or a property, with its attributes by id."""

    id: int
    type: str
    name: str = ""
    attributes: Mapping[str, Attribute] = field(default_factory=dict)

    def __str__(self) -> str:
        name = f' "{one_line(self.name)}"' if self.name.strip() else ""
        return f"{self.type} {self.id}{name}"

    def get(self, name: str) -> Attribute | None:
        """The attribute with the newest id `name`, under any id that it has had."""
        known = term(name)
        for candidate in known.ids:
            found = self.attributes.get(candidate)
            if found is not None and found.value not in (None, "", ()):
                return found if found.unit else replace(found, unit=known.unit)
        return None

    def amount(self, name: str) -> tuple[float, str] | None:
        """Number and unit, of this package, of an attribute; None if it is not given.

        Raises
        ------
        ValueError
            If it is not a finite number, or its unit is not known.
        """
        found = self.get(name)
        return None if found is None else (found.number(), checked_unit(found))


def checked_unit(attribute: Attribute) -> str:
    """The unit of this package for that of an attribute; ValueError if it is not known."""
    unit = unit_of(attribute.unit or "none")
    if unit is None:
        raise ValueError(f"has the unit {one_line(str(attribute.unit))}, which is not one of REXS")
    return unit


@dataclass(frozen=True, slots=True)
class Relation:
    """A relation between components; a component has one or several roles in it."""

    id: int
    type: str
    refs: tuple[tuple[str, int], ...]
    order: int | None = None

    def partners(self, role: str) -> Iterator[int]:
        """Ids of the components with `role`."""
        return (component for name, component in self.refs if name == role)


@dataclass(frozen=True, slots=True)
class Model:
    """The content of a file."""

    version: str
    components: Mapping[int, Component]
    relations: tuple[Relation, ...]
    # For each load case the components with the attributes that it changes.
    load_cases: Mapping[int, Mapping[int, Component]] = field(default_factory=dict)

    def of_type(self, component_type: str) -> list[Component]:
        """The components of a type, in the order of the file."""
        types = types_of(component_type)
        return [item for item in self.components.values() if item.type in types]

    def partners(
        self, component: int, relation_type: str, own_role: str, other_role: str, *types: str
    ) -> list[Component]:
        """Components that stand in a relation to a component; of some types only, if given."""
        wanted = {name for one in types for name in types_of(one)}
        relations = [
            relation
            for relation in self.relations
            if relation.type == relation_type and component in relation.partners(own_role)
        ]
        relations.sort(key=lambda relation: relation.order or 0)
        found = [
            self.components[other]
            for relation in relations
            for other in relation.partners(other_role)
        ]
        return [item for item in found if not wanted or item.type in wanted]

    def with_load_case(self, load_case: int) -> Model:
        """The model with the attributes that a load case changes."""
        components = dict(self.components)
        for number, changed in self.load_cases[load_case].items():
            own = components[number]
            components[number] = replace(own, attributes={**own.attributes, **changed.attributes})
        return replace(self, components=components)
