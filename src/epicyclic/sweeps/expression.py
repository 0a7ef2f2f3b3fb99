"""Expressions over the keys of a case: numbers with units, sums, products and some functions.

They are read as a syntax tree of which only these parts are allowed; nothing is executed.
"""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from epicyclic.units import one_of, pure_number

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
