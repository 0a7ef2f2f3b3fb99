"""What a sweep varies: axes of keys and values, points, and keys that follow from others."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from graphlib import CycleError, TopologicalSorter
from itertools import islice
from numbers import Integral, Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from pydantic_core import PydanticCustomError

from epicyclic.case.case import Case
from epicyclic.case.keys import field_at, known_keys, value_of
from epicyclic.dataclass import asdict, dataclass, replace
from epicyclic.errors import InputError, Problem, first_of, one_problem, raise_any
from epicyclic.messages import did_you_mean, one_line, path_of, refused, sentence, value_at, written
from epicyclic.schema.fields import (
    all_keys,
    entry_of,
    is_continuous,
    is_named,
    is_text,
    quantity_of,
    table_of,
)
from epicyclic.schema.read import parse_value, plain
from epicyclic.study.operating import AXES, STATE, STATE_KEY
from epicyclic.study.table_file import HEADER, read_grid
from epicyclic.units import Quantity, format_number, in_unit, one_of, pure_number, with_unit

if TYPE_CHECKING:
    import pandas as pd


MOST_POINTS = 1_000_000  # Rows of more points do not fit into memory.
ROW = "row"  # Dimension of a table of points, which counts its rows from 1.
_LARGEST_WHOLE = 2**53  # Larger whole numbers are no exact coordinates.


@dataclass(frozen=True, slots=True)
class Axis:
    """One dimension of a sweep: a key and its values."""

    key: str  # Dotted key of the case, or `ROW`.
    values: tuple[Any, ...]  # As a case file has them.
    coordinate: tuple[float | str, ...]  # The same as numbers in `unit`, or as names.
    unit: str  # Display unit; ``"1"`` for pure numbers, empty for names.
    together: tuple[Axis, ...] = ()  # Other keys, whose values change with these.

    @property
    def keys(self) -> tuple[Axis, ...]:
        """All that changes along it, each by itself."""
        return self.together if self.key == ROW else (replace(self, together=()), *self.together)

    def describe(self) -> dict[str, Any]:
        """As JSON holds it."""
        content = asdict(self)
        together = [axis.describe() for axis in self.together]
        del content["together"]
        return content | ({"together": together} if together else {})

    @classmethod
    def again(cls, content: Mapping[str, Any]) -> Self:
        """The axis that `describe` described."""
        return cls(
            content["key"],
            tuple(content["values"]),
            tuple(content["coordinate"]),
            content["unit"],
            tuple(map(cls.again, content.get("together", ()))),
        )


def listed(values: Any) -> list[Any]:
    """`values` as a list; anything that is one value by itself as a list of it."""
    if isinstance(values, str | Mapping):
        return [values]
    try:
        return list(islice(values, MOST_POINTS + 1))
    except TypeError:
        return [values]


def too_many(key: str, count: int) -> Problem:
    """What is wrong with that many points."""
    allowed = f"must have {MOST_POINTS} points or fewer, not {count}."
    return Problem(key, "", allowed, "Give fewer values.")


def make_axis(
    case: Case, key: str, values: list[Any], *, repeated: bool = False
) -> tuple[Axis | None, list[Problem]]:
    """The axis of one key, and what is wrong with it; values may be `repeated` beside others."""
    field = field_at(case, key)
    unsuitable = field_problem(case, key)
    if field is None or unsuitable is not None:
        return None, [unsuitable] if unsuitable else []
    if not values:
        return None, [Problem(key, "", "has no values.", "Give at least one.")]
    quantity = quantity_of(*field)
    if is_text(field[0]):  # a name may be a bare number
        values = [str(value) if isinstance(value, Integral) else value for value in values]
    coordinate: list[float | str] = []
    problems = []
    for value in values:
        try:
            coordinate.append(coordinate_of(value, quantity))
        except PydanticCustomError as error:
            problems.append(refused(error, key, written(value)))
    if not problems and not repeated and len(set(coordinate)) < len(coordinate):
        problems.append(Problem(key, "", "has the same value twice.", "Give each value once."))
    if problems:
        return None, _one_for_alike(problems)
    unit = unit_of(case, key)
    if any(isinstance(item, str) for item in coordinate):
        coordinate, unit = [str(item) for item in coordinate], ""
    return Axis(key, tuple(map(plain, values)), tuple(coordinate), unit), []


def unit_of(case: Case, key: str) -> str:
    """Display unit of a key that holds a number."""
    field = field_at(case, key)
    quantity = None if field is None else quantity_of(*field)
    return "1" if quantity is None else quantity.display


def make_group(case: Case, group: Mapping[str, list[Any]]) -> tuple[Axis | None, list[Problem]]:
    """The axis of keys whose values change together, named after the first; its problems."""
    axes, problems = _columns(case, group, first=True)
    if problems:
        return None, problems
    leading, *others = axes
    return replace(leading, together=tuple(others)), []


def make_rows(case: Case, columns: Mapping[str, list[Any]]) -> tuple[Axis | None, list[Problem]]:
    """The axis of a table of points, by its columns; its problems."""
    axes, problems = _columns(case, columns)
    if problems:
        return None, problems
    numbers = tuple(range(1, 1 + len(axes[0].values)))
    return Axis(ROW, numbers, numbers, "1", tuple(axes)), []


def _columns(
    case: Case, columns: Mapping[str, list[Any]], *, first: bool = False
) -> tuple[list[Axis], list[Problem]]:
    """Keys with as many values each; the `first` one has no value twice."""
    if not columns:
        return [], [Problem("", "", "names no keys.", "Give keys and their values.")]
    known = len(known_keys(case))
    if len(columns) > known:
        allowed = f"names {len(columns)} keys; a case of this kind has {known}."
        return [], [Problem("", "", allowed, "Give a table with one column for each key.")]
    axes: list[Axis] = []
    problems: list[Problem] = []
    leading, *_ = columns
    for key, values in columns.items():
        axis, found = make_axis(case, key, values, repeated=not first or key != leading)
        problems += found
        axes += [axis] if axis is not None else []
    count = len(columns[leading])
    for key, values in columns.items():
        if values and len(values) != count:
            allowed = f"has {len(values)} values, but {leading} has {count}; they vary together."
            problems.append(Problem(key, "", allowed, "Give each the same number of values."))
    return axes, problems


def field_problem(case: Case, key: str) -> Problem | None:
    """Why a key cannot be varied: there is none, or it holds several values."""
    field = field_at(case, key)
    if field is None:
        remedy = did_you_mean(key, known_keys(case)) or "See 'epicyclic init' for the keys."
        return Problem(key, "", "is not a known key.", remedy)
    annotation, metadata = field
    if entry_of(annotation):
        allowed = "is a list; a sweep varies keys that hold one value."
        return Problem(key, "", allowed, "Set it in the case, and run a sweep for each list.")
    table = table_of(annotation)
    if table is None or is_named(metadata):
        return None
    allowed = "is a table; a sweep varies keys that hold one value."
    return Problem(key, "", allowed, f"Vary keys of it, such as {key}.{all_keys(table)[0]}.")


def _one_for_alike(problems: Sequence[Problem]) -> list[Problem]:
    """One problem for all values that have the same."""
    alike: dict[str, list[Problem]] = {}
    for problem in problems:
        alike.setdefault(problem.allowed, []).append(problem)
    return [
        replace(first, value=f"{first.value} and {len(others)} more") if others else first
        for first, *others in alike.values()
    ]


def coordinate_of(value: Any, quantity: Quantity | None) -> float | str:
    """A value of a key as a number in its display unit, or as a name."""
    if quantity is not None:
        return quantity.to_display(quantity.parse(value))
    if isinstance(value, bool | np.bool):
        return str(bool(value)).lower()
    if isinstance(value, str):
        return value
    if isinstance(value, Integral):
        whole = int(value)
        if abs(whole) <= _LARGEST_WHOLE:
            return whole
    elif isinstance(value, Real):
        return float(value) + 0.0  # no zero below zero
    raise PydanticCustomError(
        "axis", "is not a value of one key", {"remedy": "give numbers, text or names"}
    )


def columns_of(points: str | Path | pd.DataFrame) -> dict[str, list[Any]]:
    """Keys of a table of points with their values, as a case file has them.

    Units stand in the header, ``gears.normal_module [mm]``, or with the values. Raises `InputError`
    if the table cannot be read, a cell is empty, or a key has two columns.
    """
    grid = read_grid(points, most=MOST_POINTS, fewer="Give fewer points, or several tables.")
    columns: dict[str, list[Any]] = {}
    problems = []
    for place, header in enumerate(grid.header):
        match = HEADER.fullmatch(header)
        name, unit = (match["name"], match["unit"] or "") if match else (header, "")
        key = {**AXES, STATE: STATE_KEY}.get(name, name)
        if key in columns:
            problems.append(Problem(key, "", "has two columns.", "Keep one of them."))
        empty = [str(line) for line, cells in grid.rows if not cells[place]]
        if empty:
            allowed = f"has no value in line {first_of(empty)}."
            problems.append(Problem(key, "", allowed, "Give every point a value."))
        columns[key] = [_value(cells[place], unit) for _, cells in grid.rows]
    raise_any(problems, grid.source)
    return columns


def _value(cell: str, unit: str) -> Any:
    """A cell as a case file has it, a bare number with the unit of its column."""
    value = parse_value(cell)
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return f"{value!r} {unit}" if unit not in ("", "1") and is_number else value


# Expressions over the keys of a case: numbers with units, sums, products and some functions.
#
# They are read as a syntax tree of which only these parts are allowed; nothing is executed.


Value = Any  # A float, or a pint quantity.
Lookup = Callable[[str], Value]

_LONGEST = 500
_LARGEST_POWER = 20
_CASE = "case"  # The function whose argument is a key and stands for its value in the case.

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
_KNOWN = ", ".join([*FUNCTIONS, _CASE])


@dataclass(frozen=True, slots=True)
class Expression:
    """A tree of allowed parts."""

    tree: ast.expr
    keys: tuple[str, ...]  # Keys whose values it takes at a point.

    def value(self, at_point: Lookup, in_case: Lookup) -> Value:
        """Its value with those of keys at a point, and in the case.

        Raises `ArithmeticError`, `TypeError`, `ValueError` if there is none, or units do not fit.
        """
        result = _evaluate(self.tree, at_point, in_case)
        magnitude: Any = getattr(result, "magnitude", result)
        if isinstance(magnitude, complex) or not math.isfinite(magnitude):
            raise ValueError("is not a finite number")
        return result


@lru_cache(maxsize=256)
def parse_expression(text: str) -> Expression:
    """The expression written as `text`.

    Raises `ValueError` if it has parts that are not allowed.

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
        raise ValueError("is not an expression") from None
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
            raise ValueError(f"has {_CASE}() with something other than one key")
        return
    if name not in FUNCTIONS:
        raise ValueError(
            f"has an unknown function, {ast.unparse(node.func)}; the functions are {_KNOWN}"
        )
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
_WHOLE = 1e-9  # A result that is nearer to a whole number is that number.


@dataclass(frozen=True, slots=True)
class Point:
    """A point of a sweep: values of varied keys, and those that follow."""

    case: Case
    changes: Mapping[str, Any]  # Varied keys with their values.
    links: Links  # Keys with the expressions that they follow.

    def followed(self) -> dict[str, Any]:
        """All keys that change, with their values as a case file has them.

        Raises `InputError` if an expression has no value, or one that its key cannot have.
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
            stated = value_at(self.case.given(), path_of(name)) is not None
            if not stated and name in {found.key for found in self.case.found}:
                raise ValueError(
                    f"uses {name}, which the case leaves out and which follows from other keys"
                )
            return self._in_case(name)

        try:
            return self._allowed(key, parse_expression(text).value(at_point, self._in_case))
        except ZeroDivisionError:
            raise _no_value(key, text, "divides by zero") from None
        except (ArithmeticError, TypeError, ValueError) as error:  # also what quantities refuse
            raise _no_value(key, text, str(error)) from None

    def coordinate(self, key: str) -> float | str | None:
        """The value of a linked key in its display unit; None if it has none here."""
        try:
            return coordinate_of(self.value(key), quantity_of(*known_field(self.case, key)))
        except (InputError, PydanticCustomError):
            return None

    def _in_case(self, key: str) -> Any:
        value = value_of(self.case, key)
        quantity = quantity_of(*known_field(self.case, key))
        if value is None:
            raise ValueError(f"uses {key}, which has no value in the case")
        return _plain_number(key, value) if quantity is None else with_unit(value, quantity.si)

    def _number(self, key: str, value: Any) -> Any:
        """A value as a case file has it as a number, with its unit."""
        quantity = quantity_of(*known_field(self.case, key))
        if quantity is None:
            return _plain_number(key, value)
        return with_unit(quantity.parse(value), quantity.si)

    def _allowed(self, key: str, value: Any) -> Any:
        annotation, metadata = known_field(self.case, key)
        quantity = quantity_of(annotation, metadata)
        if quantity is not None:
            # radians count as numbers, so that a power over a speed is a torque
            text = quantity.exact_text(in_unit(value, quantity.si))
            quantity.parse(text)
            return text
        number = in_unit(value, "")
        if annotation is not int:
            return number
        if abs(number - round(number)) > _WHOLE:
            shown = format_number(number, 6)
            raise ValueError(f"gives {shown}, but {key} is a whole number; use round()")
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
        problems.append(Problem("link", "", f"is circular: {ring}.", "Remove one of them."))
    return problems


def _problem_of(case: Case, key: str, text: str, varied: set[str]) -> Problem | None:
    unsuitable = field_problem(case, key)
    if unsuitable is not None:
        return unsuitable
    if key in varied:
        return Problem(key, "", "is both varied and linked.", "Either vary or link it.")
    field = known_field(case, key)
    if field[0] is not int and not is_continuous(field, quantity_of(*field)):
        remedy = "Link numbers only; vary this key together with others."
        return Problem(key, "", "is not a number.", remedy)
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


def known_field(case: Case, key: str) -> tuple[Any, tuple[Any, ...]]:
    """Annotation and metadata of a key; raises `ValueError` if there is no such key."""
    field = field_at(case, key)
    if field is None:
        raise ValueError(f"uses {key}, which is not a known key")
    return field


def _plain_number(key: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(f"uses {key}, which is not a number")
    return float(value)


def _no_value(key: str, text: str, reason: str) -> InputError:
    remedy = "Correct the expression."
    return one_problem(key, f'"{one_line(text)}"', sentence(reason, capital=False), remedy)
