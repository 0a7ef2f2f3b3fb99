"""Keys of a case that hold a continuous number: their values and bounds."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Any

from annotated_types import Gt

from epicyclic.case.base import CaseTable
from epicyclic.case.fields import (
    bounds_of,
    field_at,
    is_array,
    is_whole_number,
    known_keys,
    quantity_of,
    table_of,
    value_of,
)
from epicyclic.case.messages import did_you_mean
from epicyclic.errors import Problem, raise_any
from epicyclic.units import Quantity

OFF_OPEN_BOUND = 1e-6
"""Distance kept from a bound that is no value itself, over that of the start value. [1]"""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A key of the case that is fitted."""

    key: str  # Dotted key of the case.
    unit: str  # Display unit; empty for pure numbers.
    start: float  # Value in the case, and bounds of the schema, in `unit`.
    low: float  # Value in the case, and bounds of the schema, in `unit`.
    high: float  # Value in the case, and bounds of the schema, in `unit`.

    @property
    def ends(self) -> tuple[float, float]:
        """The bounds over the start value, rising. [1]"""
        one, other = sorted((self.low / self.start, self.high / self.start))
        return one, other

    def value(self, scaled: float) -> Any:
        """The value at `scaled`, the ratio to the start value, as a case file has it."""
        number = min(max(scaled * self.start, self.low), self.high)
        return f"{number!r} {self.unit}" if self.unit else number


def make_parameters(
    case: CaseTable, keys: Iterable[str], varied: Iterable[str]
) -> tuple[Parameter, ...]:
    """The keys to be fitted, checked; `varied` are those that the table sets itself.

    Raises
    ------
    InputError
        For keys that are unknown, hold no number, or have no start value.
    """
    found = [_not_zero(parameter_of(case, key, set(varied))) for key in keys]
    problems = [item for item in found if isinstance(item, Problem)]
    raise_any(problems, "the fit")
    return tuple(item for item in found if isinstance(item, Parameter))


def _not_zero(item: Parameter | Problem) -> Parameter | Problem:
    """The same unless it has no start value to be scaled by."""
    if isinstance(item, Problem) or item.start != 0:
        return item
    return _no_start(item.key, "is 0 in the case")


def _no_start(key: str, what: str) -> Problem:
    allowed = f"{what}; it must have one to vary about."
    return Problem(key, "", allowed, f'Add --set "{key}=...".')


def parameter_of(case: CaseTable, key: str, varied: Collection[str] = ()) -> Parameter | Problem:
    """A key that holds a number, or why it cannot be varied continuously."""
    field = field_at(case, key)
    if field is None:
        remedy = did_you_mean(key, known_keys(case)) or "See 'epicyclic init' for keys."
        return Problem(key, "", "is not a known key.", remedy)
    quantity = quantity_of(*field)
    if not is_continuous(field, quantity):
        return Problem(key, "", "holds no continuous number.", "Fit a key that does.")
    if key in varied:
        return Problem(key, "", "is given by a column of the table.", "Fit another key.")
    start = _start(case, key, quantity)
    if start is None:
        return _no_start(key, "has no value in the case")
    low, high, is_open = _bounds(quantity, field)
    if is_open:
        low += OFF_OPEN_BOUND * (start - low)
    return Parameter(key, "" if quantity is None else quantity.display, start, low, high)


def is_continuous(field: tuple[Any, tuple[Any, ...]], quantity: Quantity | None) -> bool:
    """True for keys that hold a number which does not count."""
    annotation = field[0]
    if is_array(annotation) or is_whole_number(annotation) or table_of(annotation) is not None:
        return False
    return quantity is not None or float in _plain_types(annotation)


def _plain_types(annotation: Any) -> set[Any]:
    """The types of an annotation without its metadata."""
    inner = getattr(annotation, "__origin__", annotation)  # Annotated[float, ...] has float
    parts = getattr(annotation, "__args__", ()) if inner is not float else ()
    return {inner}.union(*map(_plain_types, parts))


def _bounds(
    quantity: Quantity | None, field: tuple[Any, tuple[Any, ...]]
) -> tuple[float, float, bool]:
    """Bounds of the schema, in the display unit, and whether the lower one itself is left out."""
    if quantity is not None:
        low, high, is_open = quantity.low, quantity.high, quantity.open_low
    else:
        lower, upper = bounds_of(*field)
        is_open = isinstance(lower, Gt)
        limit: Any = lower.gt if isinstance(lower, Gt) else lower and lower.ge
        top: Any = upper and upper.le
        low, high = limit, top
    return (
        -math.inf if low is None else float(low),
        math.inf if high is None else float(high),
        is_open,
    )


def _start(case: CaseTable, key: str, quantity: Quantity | None) -> float | None:
    value = value_of(case, key)
    if value is None:
        return None
    return float(value) if quantity is None else quantity.to_display(value)
