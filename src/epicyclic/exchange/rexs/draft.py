"""A case in the making: what a file gives, with its origin, and what it lacks."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from epicyclic.case.plain import with_value
from epicyclic.case.wording import key_parts, path_of
from epicyclic.errors import Problem
from epicyclic.exchange.rexs.model import Attribute, Component
from epicyclic.exchange.rexs.vocabulary import term
from epicyclic.units import format_number

DIGITS = 15
"""Significant digits that a number has in REXS at most."""

SAME = 1e-9
"""Relative difference up to which numbers of a file are the same."""


class Amount(NamedTuple):
    """A number of a file, its unit in this package, and where it stands."""

    number: float
    unit: str
    origin: str

    @property
    def text(self) -> Any:
        """As a case file has it."""
        return amount_text(self.number, self.unit)


@dataclass(frozen=True, slots=True)
class Lack:
    """A key of the case for which the file has no value.

    Attributes
    ----------
    key : str
        Dotted key of the case.
    attribute : str
        REXS id of what is lacking, and the component that should have it.
    needed : bool
        True if there is no case without it.
    instead : str
        What happens without it, or what to do.
    """

    key: str
    attribute: str
    needed: bool
    instead: str

    def explains(self, problem: Problem) -> bool:
        """True if a problem of a case is that this key, or its whole table, is missing."""
        path, own = path_of(problem.key), path_of(self.key)
        is_alternative = own[:-1] == path[:-1] and str(own[-1]) in problem.allowed
        return own == path or own[:-1] == path or is_alternative

    def __str__(self) -> str:
        return f"The file has no {self.attribute}. {self.instead}".rstrip()


def amount_text(number: float, unit: str) -> Any:
    """A number as a case file has it: with its unit, or bare without one."""
    text = format_number(number + 0.0, DIGITS)
    return f"{text} {unit}" if unit else float(text)


def at(components: Sequence[Component]) -> str:
    """Where a value stands, in words."""
    more = f" and {len(components) - 1} more" if len(components) > 1 else ""
    return f"{components[0]}{more}"


@dataclass(slots=True)
class Draft:
    """What is known of a case."""

    tables: dict[str, Any]  # The tables of the case, complete or not.
    origins: dict[str, str] = field(default_factory=dict)  # Where the value of each key comes from.
    lacks: dict[str, Lack] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)  # What the user should know.
    problems: list[Problem] = field(default_factory=list)  # Values that cannot be read.

    def give(self, key: str, value: Any, origin: str) -> None:
        """Set a key."""
        self.tables = with_value(self.tables, key_parts(key), value)
        self.origins[key] = origin

    def lack(
        self, key: str, attribute: str, components: Sequence[Component], instead: str = ""
    ) -> None:
        """Note that the file has no value for a key; without `instead` the case needs one."""
        where = f"{attribute} of {at(components)}" if components else attribute
        self.lacks[key] = Lack(key, where, not instead, instead)

    def need(self, key: str, attribute: str, components: Sequence[Component], hint: str) -> None:
        """Note that the file has no value for a key that the case needs, with a hint."""
        self.lack(key, attribute, components)
        self.lacks[key] = replace(self.lacks[key], instead=hint)

    def read(self, attribute: str, components: Sequence[Component], key: str = "") -> Amount | None:
        """An attribute that `components` have in common.

        None if none has it; if it cannot be read, or if they differ, that is a problem.
        """
        found: list[tuple[float, str, Attribute, Component]] = []
        for component in components:
            raw = component.get(attribute)
            if raw is None:
                continue
            try:
                amount = component.amount(attribute)
            except ValueError as error:
                self.wrong(key, raw, component, str(error))
                return None
            assert amount is not None
            found.append((*amount, raw, component))
        if not found:
            return None
        number, unit, raw, component = found[0]
        for other, other_unit, _, where in found[1:]:
            if other_unit != unit or not math.isclose(other, number, rel_tol=SAME, abs_tol=1e-12):
                self.wrong(key, raw, component, f"is another one in {where}; they must be alike")
                return None
        return Amount(number, unit, f"{raw.id} of {at([item[3] for item in found])}")

    def take(
        self,
        key: str,
        attribute: str,
        components: Sequence[Component],
        instead: str | None = "",
        change: Callable[[float], float] = lambda number: number,
    ) -> float | None:
        """Set `key` from an attribute, or note that it is lacking.

        Returns the number as the file has it, None if there is none. With `instead` None nothing
        is noted.
        """
        found = self.read(attribute, components, key)
        if found is None:
            if instead is not None:
                self.lack(key, attribute, components, instead)
            return None
        value = amount_text(change(found.number), found.unit)
        if term(attribute).type == "integer" and found.number.is_integer():
            value = int(change(found.number))
        self.give(key, value, found.origin)
        return found.number

    def adopt(self, other: Draft, name: str) -> None:
        """Take over what is known of the set called `name`."""
        place = f"sets.{name}."
        self.tables = with_value(self.tables, ["sets", name], other.tables)
        self.origins |= {f"{place}{key}": origin for key, origin in other.origins.items()}
        for key, lack in other.lacks.items():
            self.lacks[f"{place}{key}"] = replace(lack, key=f"{place}{key}")
        self.notes += [f"{name}: {note}" for note in other.notes]
        self.problems += other.problems

    def wrong(self, key: str, attribute: Attribute, component: Component, what: str) -> None:
        """Note a value that cannot be read."""
        place = f"{attribute.id} of {component}"
        self.problems.append(
            Problem(
                place,
                f'"{attribute.text()}"',
                f"{what}.",
                "Correct the file." + (f" It is for {key}." if key else ""),
            )
        )
