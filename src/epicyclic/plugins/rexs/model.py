"""What a REXS file holds, and the ids, units and versions of REXS."""

from __future__ import annotations

import base64
import binascii
import math
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

import numpy as np

from epicyclic.arrays import FloatArray
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import Problem, one_problem, raise_any
from epicyclic.files import refuse
from epicyclic.messages import one_line
from epicyclic.units import Quantity

if TYPE_CHECKING:
    from epicyclic.plugins.rexs.files import Content

CUSTOM = "custom_epicyclic_"  # Start of the ids of attributes that the standard does not have.


@dataclass(frozen=True, slots=True)
class Term:
    """An attribute of the standard."""

    id: str  # As in the newest version.
    type: str  # Value type, ``"floating_point"``.
    unit: str  # Name of the unit in REXS; ``"none"`` for pure numbers and text.
    ids: Mapping[str, str]  # All that it has had, the newest first, with the version of each.


@cache
def vocabulary() -> dict[str, Any]:
    """What this package uses of REXS: versions, names of units, ids."""
    text = resources.files(__package__).joinpath("vocabulary.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


@cache
def term(name: str) -> Term:
    """The attribute with the newest id `name`; KeyError if it is not in use here."""
    entry = vocabulary()["attributes"][name]
    ids = {name: entry["since"]}
    ids |= {item["id"]: item["since"] for item in reversed(entry.get("former", ()))}
    return Term(name, entry["type"], entry.get("unit", "none"), ids)


def versions() -> tuple[str, ...]:
    """The versions that can be read, the newest last."""
    return tuple(vocabulary()["versions"])


def id_in(name: str, version: str) -> str | None:
    """The id of attribute `name` in a version of the standard; None if it was not there yet."""
    there = versions()[: versions().index(version) + 1]
    return next((found for found, since in term(name).ids.items() if since in there), None)


def types_of(component_type: str) -> tuple[str, ...]:
    """Every name that a type of component has had."""
    entry = vocabulary()["components"].get(component_type, {})
    return (component_type, *entry.get("former", ()))


def unit_of(name: str) -> str | None:
    """The unit of this package for a unit of REXS; None if it is not known."""
    unit: str | None = vocabulary()["units"].get(name)
    return unit


def rexs_unit(unit: str) -> str:
    """The unit of REXS in which a number with a unit of this package is written."""
    data = vocabulary()
    names: dict[str, str] = {here: name for name, here in data["units"].items()}
    names |= data["written"]
    return names[unit]


def written(value: float, unit: str, name: str) -> float:
    """A number in a unit of this package, as one in a unit of REXS of that `name`."""
    here = vocabulary()["units"][name]
    return value if unit == here else Quantity("a number", here, here).parse(f"{value!r} {unit}")


# What a REXS file holds, whichever form it has: components, their attributes and relations.


_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_CODES = {"float64": "<f8", "float32": "<f4", "int32": "<i4"}


@dataclass(frozen=True, slots=True)
class Coded:
    """An array as bytes in base64, little-endian."""

    code: str
    text: str

    def numbers(self) -> tuple[float, ...]:
        """The numbers; ValueError if there are none."""
        kind = _CODES.get(self.code)
        if kind is None:
            raise ValueError("is an array of unknown encoding")
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
        if isinstance(self.value, tuple):
            return tuple(map(_number, self.value))
        raise ValueError("is not an array")

    def flags(self) -> tuple[bool, ...]:
        """The value, or those of an array, as true or false; ValueError if it is neither."""
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        known = {"true": True, "false": False}
        flags = tuple(known[text] for text in map(str.lower, map(str, values)) if text in known)
        if len(flags) < len(values) or not flags:
            raise ValueError("is neither true nor false")
        return flags

    def text(self) -> str:
        """The value as one line of text."""
        return one_line(str(self.value).strip())


def _number(value: Any) -> float:
    if isinstance(value, str):
        if _NUMBER.fullmatch(value.strip()) is None:
            raise ValueError("is not a finite number")
        value = float(value)
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not is_number:
        raise ValueError("is not a number")
    try:
        number = float(value)
    except OverflowError:  # a whole number of hundreds of digits
        number = math.inf
    if not math.isfinite(number):
        raise ValueError("is not a finite number")
    return number


@dataclass(frozen=True, slots=True)
class Component:
    """A machine part, a stage, a load or a property, with its attributes."""

    id: int  # Until `build_model` has checked it: as the file has it.
    type: str
    name: str = ""
    attributes: tuple[Attribute, ...] = ()

    def __str__(self) -> str:
        name = f' "{one_line(self.name)}"' if self.name.strip() else ""
        return f"{self.type} {self.id}{name}"

    def get(self, name: str) -> Attribute | None:
        """The attribute with the newest id `name`, under any id that it has had."""
        known = term(name)
        for candidate in known.ids:
            for found in self.attributes:
                if found.id == candidate and found.value not in (None, "", ()):
                    return found if found.unit else replace(found, unit=known.unit)
        return None

    def is_true(self, name: str) -> bool:
        """True if an attribute is given as true."""
        found = self.get(name)
        return found is not None and found.text().lower() == "true"

    def number(self, name: str) -> float:
        """The number of an attribute; 0 without one, and without one that can be read."""
        found = self.get(name)
        try:
            return 0.0 if found is None else found.number()
        except ValueError:  # told when it is read
            return 0.0

    def amount(self, name: str) -> tuple[float, str] | None:
        """Number and unit, of this package, of an attribute; None if it is not given.

        Raises `ValueError` if it is not a finite number, or its unit is not known.
        """
        found = self.get(name)
        return None if found is None else (found.number(), checked_unit(found))

    def changed(self, attributes: Iterable[Attribute]) -> Component:
        """The component with these attributes, in place of those with the same ids."""
        every = {attribute.id: attribute for attribute in (*self.attributes, *attributes)}
        return replace(self, attributes=tuple(every.values()))


def checked_unit(attribute: Attribute) -> str:
    """The unit of this package for that of an attribute; ValueError if it is not known."""
    unit = unit_of(attribute.unit or "none")
    if unit is None:
        raise ValueError(f"has the unit {one_line(str(attribute.unit))}, which REXS does not have")
    return unit


@dataclass(frozen=True, slots=True)
class Relation:
    """A relation between components; a component has one or several roles in it."""

    id: int  # Until `build_model` has checked them: this and the others as the file has them.
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

    def partners_of(self, owners: Iterable[Component], *wanted: str) -> list[Component]:
        """The `partners` of several components, one after the other."""
        return [item for owner in owners for item in self.partners(owner.id, *wanted)]

    def place(self, part: Component) -> tuple[int | None, FloatArray] | None:
        """In whose axes a part is placed, None for those of the gear unit, and where. [mm]"""
        reference, point = part.get("reference_component_for_position"), vector(part, _PLACE)
        try:
            number = None if reference is None else int(reference.number())
        except ValueError:
            return None
        owner = None if number is None else self.components.get(number)
        if point is None or (number is not None and owner is None):
            return None
        return (None if owner is None or owner.type == "gear_unit" else owner.id), point

    def axis(self, parts: Iterable[Component], ways: Iterable[FloatArray] = ()) -> FloatArray:
        """Direction of parts: as they state it, as the ways between them lie, of the gear unit."""
        units = self.of_type("gear_unit")
        unit = unit_vector(vector(units[0], "u_axis_vector") if units else None)
        stated = (vector(part, "u_axis_vector") for part in parts)
        vectors = (unit_vector(way) for found in (stated, ways) for way in found)
        found = next((it for it in vectors if it is not None), unit)
        if found is None:
            return USUAL_AXIS
        senses = [
            it for it in (unit, USUAL_AXIS) if it is not None and abs(found @ it) > 1 - ROUNDED
        ]
        return senses[0] if senses else found  # they tell the sense of an axis that is theirs

    @property
    def known_load_cases(self) -> str:
        """The first load cases of the file."""
        return ", ".join(map(str, list(self.load_cases)[:12]))

    def with_load_case(self, load_case: int) -> Model:
        """The model with the attributes that a load case changes; InputError if there is none."""
        if load_case not in self.load_cases:
            remedy = f"It has {self.known_load_cases or 'none'}."
            raise one_problem("--load-case", str(load_case), "is not in the file.", remedy)
        components = dict(self.components)
        for number, changed in self.load_cases[load_case].items():
            components[number] = components[number].changed(changed.attributes)
        return replace(self, components=components)


# Where parts stand.


USUAL_AXIS: FloatArray = np.array([1.0, 0.0, 0.0])
"""Axis of a gear unit that states none."""

_PLACE = "support_vector"
_SHORTEST, _FARTHEST = 1e-6, 1e8
"""Bounds of the length of an axis vector and of the coordinates of parts. [mm]"""
ROUNDED = 1e-9  # Of the product of two unit vectors that are one. [1]
IN_MILLIMETRES = {"mm": 1.0, "um": 1e-3}


def vector(part: Component, name: str) -> FloatArray | None:
    """Three numbers of a part; of a place in mm. None if it has none, or too large ones."""
    found = part.get(name)
    try:
        numbers = found.numbers() if found is not None else ()
        scale = IN_MILLIMETRES[checked_unit(found)] if name == _PLACE and found else 1.0
    except (KeyError, ValueError):
        return None
    is_place = len(numbers) == 3 and max(map(abs, numbers)) < _FARTHEST
    return scale * np.array(numbers) if is_place else None


def unit_vector(way: FloatArray | None) -> FloatArray | None:
    """A way over its length; None if it has none."""
    length = 0.0 if way is None else float(np.linalg.norm(way))
    return way / length if way is not None and length > _SHORTEST else None


def check_places(model: Model) -> Iterator[Problem]:
    """A problem for each place whose unit is no length."""
    for part in model.components.values():
        found = part.get(_PLACE)
        unit = "" if found is None else str(found.unit)
        if found is not None and unit_of(unit) not in IN_MILLIMETRES:
            place, allowed = f"{found.id} of {part}", "must be in mm or mum."
            yield Problem(place, f"a vector in {one_line(unit)}", allowed, "Correct the file.")


# The parts of a REXS file as its form gives them, and the model they make.


_SHOWN = 20  # Problems of one file that are told.

_ID = re.compile(r"[0-9]{1,9}")


def build_model(content: Content) -> Model:
    """The model of a file.

    Raises `InputError` if the version is not known, ids are no numbers or stand twice, or
    relations lead nowhere.
    """
    version = _version(content.version())
    problems: list[Problem] = []
    components = _components(content.components(), problems)
    relations = tuple(_relations(content.relations(), components, problems))
    load_cases: dict[int, Mapping[int, Component]] = {}
    for number, changed in content.load_cases():
        key = _id(number, "load_case", load_cases, problems)
        changes = _components(changed, problems)
        problems += [
            _problem(f"load_case {number}", f"changes component {other}, which does not exist.")
            for other in changes.keys() - components.keys()
        ]
        if key is not None:
            load_cases[key] = changes
    raise_any(problems[:_SHOWN])
    return Model(version, components, relations, load_cases)


def _version(text: str) -> str:
    known = versions()
    version = {"2.0": "2.0.0"}.get(text, text)
    if version not in known:
        refuse(
            f'is REXS of version "{one_line(text)}"; versions {known[0]} to {known[-1]} are read.',
            "Export it in one of these versions.",
        )
    return version


def _components(raw: Iterable[Component], problems: list[Problem]) -> dict[int, Component]:
    components: dict[int, Component] = {}
    for item in raw:
        number = _id(item.id, "component", components, problems)
        ids: set[str] = set()
        for attribute in item.attributes:
            if attribute.id in ids:
                what = f"has the attribute {one_line(attribute.id)} twice."
                problems.append(_problem(f"component {one_line(str(item.id))}", what))
            ids.add(attribute.id)
        if number is not None:
            components[number] = replace(item, id=number)
    return components


def _relations(
    raw: Iterable[Relation], components: Mapping[int, Component], problems: list[Problem]
) -> Iterator[Relation]:
    seen: dict[int, None] = {}
    for item in raw:
        number = _id(item.id, "relation", seen, problems)
        refs: list[tuple[str, int]] = []
        for role, other in item.refs:
            component = _whole(other)
            if component is not None and component in components:
                refs.append((role, component))
            else:
                what = f"refers to component {one_line(str(other))}, which does not exist."
                problems.append(_problem(f"relation {one_line(str(item.id))}", what))
        if number is not None:
            seen[number] = None
            yield replace(item, id=number, refs=tuple(refs), order=_whole(item.order))


def _id(given: Any, noun: str, known: Mapping[int, Any], problems: list[Problem]) -> int | None:
    number = _whole(given)
    if number is None:
        problems.append(_problem(f"{noun} {one_line(str(given))}", "has no integer id."))
    elif number in known:
        problems.append(_problem(f"{noun} {number}", "appears twice."))
    return number


def _whole(given: Any) -> int | None:
    if isinstance(given, str) and _ID.fullmatch(given.strip()):
        return int(given)
    is_whole = isinstance(given, int) and not isinstance(given, bool)
    return given if is_whole and abs(given) < 10**9 else None


def _problem(what: str, allowed: str) -> Problem:
    return Problem(what, "", allowed, "Correct the file.")
