"""Ids, units and versions of REXS, from the one file that has them."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from epicyclic.units import Quantity

CUSTOM = "custom_epicyclic_"
"""Start of the ids of attributes that the standard does not have."""


@dataclass(frozen=True, slots=True)
class Term:
    """An attribute of the standard."""

    id: str  # As in the newest version.
    type: str  # Value type, ``"floating_point"``.
    unit: str  # Name of the unit in REXS; ``"none"`` for pure numbers and text.
    former: tuple[tuple[str, str], ...]  # Earlier ids, each with the version that brought it.
    since: str  # The version that brought `id`.

    @property
    def ids(self) -> tuple[str, ...]:
        """Every id that the attribute has had, the newest first."""
        return (self.id, *(name for name, _ in reversed(self.former)))


@cache
def _file() -> dict[str, Any]:
    text = resources.files(__package__).joinpath("vocabulary.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


@cache
def term(name: str) -> Term:
    """The attribute with the newest id `name`; KeyError if it is not in use here."""
    entry = _file()["attributes"][name]
    former = tuple((item["id"], item["since"]) for item in entry.get("former", ()))
    return Term(name, entry["type"], entry.get("unit", "none"), former, entry["since"])


def versions() -> tuple[str, ...]:
    """The versions that can be read, the newest last."""
    return tuple(_file()["versions"])


def id_in(name: str, version: str) -> str | None:
    """The id of attribute `name` in a version of the standard; None if it was not there yet."""
    known = term(name)
    order = versions().index(version)
    found = None
    for candidate, since in (*known.former, (known.id, known.since)):
        if versions().index(since) <= order:
            found = candidate
    return found


def types_of(component_type: str) -> tuple[str, ...]:
    """Every name that a type of component has had."""
    entry = _file()["components"].get(component_type, {})
    return (component_type, *entry.get("former", ()))


def unit_of(name: str) -> str | None:
    """The unit of this package for a unit of REXS; None if it is not known."""
    unit: str | None = _file()["units"].get(name)
    return unit


def rexs_unit(unit: str) -> str:
    """The unit of REXS in which a number with a unit of this package is written."""
    data = _file()
    if unit in data["written"]:
        return str(data["written"][unit])
    names: list[str] = [name for name, here in data["units"].items() if here == unit]
    return names[-1]


def written(value: float, unit: str, name: str) -> float:
    """A number in a unit of this package, as one in a unit of REXS of that `name`."""
    here = _file()["units"][name]
    return value if unit == here else Quantity("a number", here, here).parse(f"{value!r} {unit}")


def oil_kind(text: str) -> str | None:
    """The kind of oil that a text of a file names; None if it names none."""
    kind: str | None = _file()["oil_kinds"].get(text)
    return kind
