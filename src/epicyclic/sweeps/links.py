"""Keys of a sweep that follow from others by expressions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from graphlib import CycleError, TopologicalSorter
from typing import Any

from pydantic_core import PydanticCustomError

from epicyclic.case.case import Case
from epicyclic.case.fields import is_whole_number, quantity_of
from epicyclic.case.keys import field_at, value_of
from epicyclic.case.parameters import is_continuous
from epicyclic.case.plain import value_at
from epicyclic.case.wording import one_line, path_of, sentence
from epicyclic.errors import InputError, Problem
from epicyclic.sweeps.axes import coordinate_of, field_problem
from epicyclic.sweeps.expression import parse_expression
from epicyclic.units import format_number, in_unit, with_unit

Links = Mapping[str, str]
_WHOLE = 1e-9
"""A result that is nearer to a whole number is that number."""


@dataclass(frozen=True, slots=True)
class Point:
    """A point of a sweep: values of varied keys, and those that follow."""

    case: Case
    changes: Mapping[str, Any]  # Varied keys with their values.
    links: Links  # Keys with the expressions that they follow.

    def followed(self) -> dict[str, Any]:
        """All keys that change, with their values as a case file has them.

        Raises
        ------
        InputError
            If an expression has no value, or one that its key cannot have.
        """
        return {**self.changes, **{key: self.value(key) for key in self.links}}

    def value(self, key: str) -> Any:
        """What a linked key has here."""
        text = self.links[key]

        def at_point(name: str) -> Any:
            if name == key:  # as in an assignment: what it was before
                return self._in_case(name)
            if name in self.links:
                return self._number(name, self.value(name))
            if name in self.changes:
                return self._number(name, self.changes[name])
            if _is_found(self.case, name):
                raise ValueError(
                    f"takes {name}, which the case leaves out and which follows from other keys"
                )
            return self._in_case(name)

        try:
            return self._allowed(key, parse_expression(text).value(at_point, self._in_case))
        except ZeroDivisionError:
            raise _no_value(key, text, "divides by zero") from None
        except (ArithmeticError, TypeError, ValueError) as error:
            raise _no_value(key, text, str(error)) from None

    def coordinate(self, key: str) -> float | str | None:
        """The value of a linked key in its display unit; None if it has none here."""
        try:
            return coordinate_of(self.value(key), quantity_of(*_field(self.case, key)))
        except (InputError, PydanticCustomError):
            return None

    def _in_case(self, key: str) -> Any:
        value = value_of(self.case, key)
        quantity = quantity_of(*_field(self.case, key))
        if value is None:
            raise ValueError(f"takes {key}, which has no value in the case")
        if quantity is not None:
            return with_unit(value, quantity.si)
        return _plain_number(key, value)

    def _number(self, key: str, value: Any) -> Any:
        """A value as a case file has it as a number, with its unit."""
        quantity = quantity_of(*_field(self.case, key))
        if quantity is None:
            return _plain_number(key, value)
        try:
            return with_unit(quantity.parse(value), quantity.si)
        except PydanticCustomError as error:
            raise ValueError(error.message()) from None

    def _allowed(self, key: str, value: Any) -> Any:
        annotation, metadata = _field(self.case, key)
        quantity = quantity_of(annotation, metadata)
        if quantity is not None:
            try:
                # radians count as numbers, so that a power over a speed is a torque
                text = quantity.exact_text(in_unit(value, quantity.si))
                quantity.parse(text)
            except PydanticCustomError as error:
                raise ValueError(error.message()) from None
            return text
        number = in_unit(value, "")
        if not is_whole_number(annotation):
            return number
        if abs(number - round(number)) > _WHOLE:
            shown = format_number(number, 6)
            raise ValueError(f"gives {shown}, and {key} is a whole number: use round()")
        return round(number)


def check_links(case: Case, links: Links, varied: set[str]) -> list[Problem]:
    """What is wrong with expressions wherever they are evaluated."""
    problems = []
    behind: dict[str, set[str]] = {}
    for key, text in links.items():
        problem = _problem_of(case, key, text, varied)
        if problem is None:
            behind[key] = {*parse_expression(text).keys} - {key}
        else:
            problems.append(problem)
    try:
        TopologicalSorter(behind).prepare()
    except CycleError as error:
        ring = " follows from ".join(reversed(error.args[1]))
        problems.append(Problem("link", "", f"goes in a circle: {ring}.", "Leave one out."))
    return problems


def _problem_of(case: Case, key: str, text: str, varied: set[str]) -> Problem | None:
    unsuitable = field_problem(case, key)
    if unsuitable is not None:
        return unsuitable
    if key in varied:
        return Problem(key, "", "is varied and linked.", "Do one of the two.")
    if not _is_number(case, key):
        return Problem(key, "", "holds no number.", "Link keys that do; vary this one together.")
    try:
        named = parse_expression(text).keys
    except ValueError as error:
        remedy = 'For example "round(sun.teeth * case(gears.normal_module) / gears.normal_module)".'
        return Problem(key, f'"{one_line(text)}"', f"{error}.", remedy)
    unknown = (found for name in named if (found := field_problem(case, name)) is not None)
    return next(
        (replace(it, allowed=f"{it.allowed[:-1]} (in the link of {key}).") for it in unknown), None
    )


def keys_behind(key: str, links: Links) -> set[str]:
    """The keys that a linked one follows, directly or through others."""
    direct = {*parse_expression(links[key]).keys} - {key}
    return direct.union(*(keys_behind(name, links) for name in direct if name in links))


def _field(case: Case, key: str) -> tuple[Any, tuple[Any, ...]]:
    field = field_at(case, key)
    if field is None:
        raise ValueError(f"takes {key}, which is not a known key")
    return field


def _is_number(case: Case, key: str) -> bool:
    field = _field(case, key)
    return is_whole_number(field[0]) or is_continuous(field, quantity_of(*field))


def _is_found(case: Case, key: str) -> bool:
    """A key that the case leaves out, whose value follows from others."""
    stated = value_at(case.given(), path_of(key)) is not None
    return not stated and key in {found.key for found in case.found}


def _plain_number(key: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"takes {key}, which is not a number")
    return float(value)


def _no_value(key: str, text: str, reason: str) -> InputError:
    remedy = "Correct the expression."
    return InputError(
        [Problem(key, f'"{one_line(text)}"', sentence(reason, capital=False), remedy)]
    )
