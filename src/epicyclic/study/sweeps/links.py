"""Keys of a sweep that follow from others by expressions."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from graphlib import CycleError, TopologicalSorter
from typing import Any

from pydantic_core import PydanticCustomError

from epicyclic.case.case import Case
from epicyclic.case.fields import is_whole_number, quantity_of
from epicyclic.case.keys import field_at, value_of
from epicyclic.case.parameters import is_continuous
from epicyclic.case.plain import value_at
from epicyclic.case.wording import one_line, path_of, sentence
from epicyclic.errors import InputError, Problem, one_problem
from epicyclic.study.sweeps.axes import coordinate_of, field_problem
from epicyclic.units import format_number, in_unit, one_of, pure_number, with_unit

# Expressions over the keys of a case: numbers with units, sums, products and some functions.
#
# They are read as a syntax tree of which only these parts are allowed; nothing is executed.


Value = Any
"""A float, or a pint quantity."""
Lookup = Callable[[str], Value]

_LONGEST = 500
_LARGEST_POWER = 20
_CASE = "case"
"""The function whose argument is a key and stands for its value in the case."""

FUNCTIONS: dict[str, Callable[..., Value]] = {
    "abs": abs,
    "min": min,
    "max": max,
    "round": lambda value: float(round(pure_number(value))),
    "floor": lambda value: float(math.floor(pure_number(value))),
    "ceil": lambda value: float(math.ceil(pure_number(value))),
    "sqrt": lambda value: value**0.5,
    "sin": lambda value: math.sin(pure_number(value)),
    "cos": lambda value: math.cos(pure_number(value)),
    "tan": lambda value: math.tan(pure_number(value)),
    "asin": lambda value: math.asin(pure_number(value)) * one_of("rad"),
    "acos": lambda value: math.acos(pure_number(value)) * one_of("rad"),
    "atan": lambda value: math.atan(pure_number(value)) * one_of("rad"),
}


def _power(base: Value, exponent: Value) -> Value:
    number = pure_number(exponent)
    if abs(number) > _LARGEST_POWER:
        raise ValueError(f"a power beyond {_LARGEST_POWER}")
    return base**number


_OPERATORS: dict[type[ast.AST], Callable[..., Value]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: _power,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}
_KNOWN = f"{', '.join([*FUNCTIONS, _CASE])}"


@dataclass(frozen=True, slots=True)
class Expression:
    """A tree of allowed parts."""

    tree: ast.expr
    keys: tuple[str, ...]  # Keys whose values it takes at a point.

    def value(self, at_point: Lookup, in_case: Lookup) -> Value:
        """Its value with those of keys at a point, and in the case.

        Raises
        ------
        ArithmeticError, TypeError, ValueError
            If there is none, or units do not fit.
        """
        result = _evaluate(self.tree, at_point, in_case)
        magnitude: Any = getattr(result, "magnitude", result)
        if isinstance(magnitude, complex) or not math.isfinite(magnitude):
            raise ValueError("is not a finite number")
        return result


@lru_cache(maxsize=256)
def parse_expression(text: str) -> Expression:
    """The expression written as `text`.

    Raises
    ------
    ValueError
        If it has parts that are not allowed.

    Examples
    --------
    >>> expression = parse_expression("round(2 * sun.teeth / case(sun.teeth))")
    >>> expression.keys
    ('sun.teeth',)
    >>> expression.value({"sun.teeth": 30.0}.get, {"sun.teeth": 25.0}.get)
    2.0
    """
    if len(text) > _LONGEST:
        raise ValueError(f"is longer than {_LONGEST} characters")
    try:
        tree = ast.parse(text.strip(), mode="eval").body
        keys = tuple(dict.fromkeys(_checked(tree)))
    except (SyntaxError, RecursionError, MemoryError):
        raise ValueError("is no expression") from None
    return Expression(tree, keys)


def _checked(node: ast.expr) -> Iterator[str]:
    """The keys of a tree; raises `ValueError` for parts that are not allowed."""
    if _key(node):
        yield _key(node)
    elif isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        yield from _checked(node.left)
        yield from _checked(node.right)
    elif isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
        yield from _checked(node.operand)
    elif isinstance(node, ast.Call):
        yield from _checked_call(node)
    elif isinstance(node, ast.Name):
        _unit(node.id)
    elif not (isinstance(node, ast.Constant) and type(node.value) in (int, float)):
        raise ValueError(f"has a part that is not allowed: {ast.unparse(node)}")


def _checked_call(node: ast.Call) -> Iterator[str]:
    name = node.func.id if isinstance(node.func, ast.Name) else ""
    if node.keywords or not node.args:
        raise ValueError(f"has a part that is not allowed: {ast.unparse(node)}")
    if name == _CASE:
        if len(node.args) != 1 or not _key(node.args[0]):
            raise ValueError(f"has {_CASE}() of something other than one key")
        return
    if name not in FUNCTIONS:
        raise ValueError(f"has an unknown function, {ast.unparse(node.func)}; known are {_KNOWN}")
    for argument in node.args:
        yield from _checked(argument)


def _key(node: ast.expr) -> str:
    """The dotted key that a part names: ``gears.normal_module``, ``'sets.a-b.teeth'``."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    names: list[str] = []
    while isinstance(node, ast.Attribute):
        names.append(node.attr)
        node = node.value
    if not names or not isinstance(node, ast.Name):
        return ""
    return ".".join([node.id, *reversed(names)])


def _unit(name: str) -> Value:
    if name == "pi":
        return math.pi
    try:
        return one_of(name)
    except Exception:  # pint's own errors have no common base
        raise ValueError(
            f"has a name that is neither a unit nor a key with its table, {name}"
        ) from None


def _evaluate(node: ast.expr, at_point: Lookup, in_case: Lookup) -> Value:
    key = _key(node)
    if key:
        return at_point(key)
    match node:
        case ast.BinOp():
            left = _evaluate(node.left, at_point, in_case)
            return _OPERATORS[type(node.op)](left, _evaluate(node.right, at_point, in_case))
        case ast.UnaryOp():
            return _OPERATORS[type(node.op)](_evaluate(node.operand, at_point, in_case))
        case ast.Call(func=ast.Name(id=name)) if name == _CASE:
            return in_case(_key(node.args[0]))
        case ast.Call(func=ast.Name(id=name)):
            return FUNCTIONS[name](*(_evaluate(it, at_point, in_case) for it in node.args))
        case ast.Name():
            return _unit(node.id)
        case ast.Constant(value=int() | float() as number):
            return float(number)
    raise AssertionError(ast.dump(node))


# Keys of a sweep that follow from others by expressions.

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
    return one_problem(key, f'"{one_line(text)}"', sentence(reason, capital=False), remedy)
