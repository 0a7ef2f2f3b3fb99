"""The parts of a REXS file as its form gives them, and the model they make."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, Protocol

from epicyclic.case.wording import one_line
from epicyclic.errors import Problem, raise_any
from epicyclic.exchange.rexs.model import Attribute, Component, Model, Relation, refuse
from epicyclic.exchange.rexs.vocabulary import versions

_SHOWN = 20
"""Problems of one file that are told."""

_ID = re.compile(r"[0-9]{1,9}")


class RawComponent(NamedTuple):
    """A component with its id as written."""

    id: Any
    type: str
    name: str
    attributes: tuple[Attribute, ...]


class RawRelation(NamedTuple):
    """A relation with ids as written."""

    id: Any
    type: str
    order: Any
    refs: tuple[tuple[str, Any], ...]


class Content(Protocol):
    """A file in one of its forms; what it does not understand stays as it is."""

    def version(self) -> str: ...

    def components(self) -> Iterable[RawComponent]: ...

    def relations(self) -> Iterable[RawRelation]: ...

    def load_cases(self) -> Iterable[tuple[Any, Iterable[RawComponent]]]: ...

    def set_attribute(self, component: int, attribute: Attribute) -> None:
        """Give a component an attribute, in place of one with the same id."""

    def add(self, part: Component | Relation) -> None:
        """Append a component or a relation."""

    def to_bytes(self) -> bytes: ...


def build_model(content: Content) -> Model:
    """The model of a file.

    Raises
    ------
    InputError
        If the version is not known, ids are no numbers or stand twice, or relations lead nowhere.
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
            _problem(f"load_case {number}", f"changes component {other}, which is not there.")
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
        raise refuse(
            f'is REXS of version "{one_line(text)}"; versions {known[0]} to {known[-1]} are read.',
            "Export it in one of these versions.",
        )
    return version


def _components(raw: Iterable[RawComponent], problems: list[Problem]) -> dict[int, Component]:
    components: dict[int, Component] = {}
    for item in raw:
        number = _id(item.id, "component", components, problems)
        attributes: dict[str, Attribute] = {}
        for attribute in item.attributes:
            if attribute.id in attributes:
                what = f"has the attribute {one_line(attribute.id)} twice."
                problems.append(_problem(f"component {one_line(str(item.id))}", what))
            attributes[attribute.id] = attribute
        if number is not None:
            components[number] = Component(number, item.type, item.name, attributes)
    return components


def _relations(
    raw: Iterable[RawRelation], components: Mapping[int, Component], problems: list[Problem]
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
                what = f"leads to component {one_line(str(other))}, which is not there."
                problems.append(_problem(f"relation {one_line(str(item.id))}", what))
        if number is not None:
            seen[number] = None
            yield Relation(number, item.type, tuple(refs), _whole(item.order))


def _id(given: Any, noun: str, known: Mapping[int, Any], problems: list[Problem]) -> int | None:
    number = _whole(given)
    if number is None:
        problems.append(_problem(f"{noun} {one_line(str(given))}", "has no whole number as id."))
    elif number in known:
        problems.append(_problem(f"{noun} {number}", "is there twice."))
    return number


def _whole(given: Any) -> int | None:
    if isinstance(given, str) and _ID.fullmatch(given.strip()):
        return int(given)
    is_whole = isinstance(given, int) and not isinstance(given, bool)
    return given if is_whole and abs(given) < 10**9 else None


def _problem(what: str, allowed: str) -> Problem:
    return Problem(what, "", allowed, "Correct the file.")
