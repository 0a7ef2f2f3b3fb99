"""Types of arrays, and the numbers of several operating points at once.

A sweep solves its points in blocks: what differs from point to point is a column with one row for
each of them, `Points`, and takes the place of a number. A decision is one for the whole block;
where points part, `Apart` says which, and each part is solved by itself. Passes go on until all
points of a block agree, so which points share one matters within the tolerance of the passes:
blocks are cut by the numbers of the points, whoever solves them.
"""

from __future__ import annotations

import cmath
import ctypes
import dataclasses
import math
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cache, partial, reduce
from itertools import repeat
from types import MethodType, MethodWrapperType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.intp]


TINY = 1e-300  # In place of a divisor of 0.

# The allocator of most Linux systems gives memory of arrays back and asks for it again until it has
# met a larger one, of 32 MB at most; operations on the arrays of a block took twice as long.
np.empty(2**25 - 2**16, np.uint8)


def give_memory_back() -> None:
    """Give the system what the allocator kept, for what is no array."""
    with suppress(AttributeError, OSError, TypeError):  # other systems have no such function
        ctypes.CDLL(None).malloc_trim(0)


class Apart(Exception):  # noqa: N818 - no error: the points of a block part
    """A decision that is not the same for all points of a block."""

    def __init__(self, rows: BoolArray) -> None:
        self.rows = rows  # True for those of one side. Shape (points,).


class Alone(Exception):  # noqa: N818 - no error
    """Something that is only known how to do for one point at a time.

    With the number of points where that is done then; without it nothing more is done for a block.
    """


class Points(np.ndarray[Any, Any]):
    """One number for each point, shape (points, 1), or for each point and place, (points, n)."""

    def __bool__(self) -> bool:
        truth = np.asarray(self, dtype=bool)
        if truth.ndim and truth.shape[1:] != (1,):
            raise ValueError("the truth of several places has no meaning")
        if truth.all():
            return True
        if truth.any():
            raise Apart(truth[:, 0])
        return False

    def __complex__(self) -> complex:
        raise TypeError("several points are no number")

    def __float__(self) -> float:
        raise TypeError("several points are no number")

    def __hash__(self) -> int:  # type: ignore[override]  # arrays have none
        return id(self)


def of_points(values: Any) -> Points:
    """The values of several points, first axis, as `Points`."""
    return np.asarray(values, dtype=float).view(Points)


def points_in(values: Iterable[Any]) -> int:
    """How many points numbers are of; 0 of single ones."""
    return next((len(value) for value in values if isinstance(value, Points)), 0)


class _Either(NamedTuple):
    """A function of numbers that takes `Points`, too; of numbers `math` is the faster one."""

    single: Callable[..., float]
    several: Callable[..., Any]

    def __call__(self, *args: Any) -> float:
        try:
            return self.single(*args)
        except TypeError:
            found: float = self.several(*args)
            return found


sqrt = _Either(math.sqrt, np.sqrt)
cbrt = _Either(math.cbrt, np.cbrt)
exp = _Either(math.exp, np.exp)
log = _Either(math.log, np.log)
pow = _Either(math.pow, np.power)
isfinite = _Either(math.isfinite, np.isfinite)
phase = _Either(cmath.phase, np.angle)
hypot = _Either(math.hypot, lambda *sides: np.sqrt(sum(side * side for side in sides)))


def every(truth: Any) -> bool:
    """Whether something holds for all points."""
    return bool(np.asarray(truth).all()) if isinstance(truth, Points) else bool(truth)


def either(truth: Any, one: Any, two: Any) -> Any:
    """One number where something holds, else the other, point by point."""
    if isinstance(truth, Points):
        return np.where(truth, one, two).view(Points)
    return one if truth else two


def agreed(truth: Any) -> Any:
    """A truth as one where it is the same for all points."""
    return truth if isinstance(truth, Points) and truth.any() != truth.all() else bool(truth)


def larger(one: float, two: float) -> float:
    """The larger of two numbers, point by point."""
    several = isinstance(one, Points) or isinstance(two, Points)
    return np.maximum(one, two) if several else max(one, two)


def between(value: Any, low: float | None, high: float | None) -> Any:
    """`value`, an array or a number, held between limits."""
    if isinstance(value, np.ndarray):
        return np.clip(value, low, high)  # of a number it takes ten times as long as what follows
    value = value if low is None else max(value, low)
    return value if high is None else min(value, high)


def on_grid(axes: Any, values: Any, at: Iterable[FloatArray]) -> FloatArray:
    """A table over one or two rising axes: linear between its points, constant beyond them."""
    from scipy.interpolate import RegularGridInterpolator

    table = RegularGridInterpolator(axes, np.asarray(values))
    places = [np.clip(place, axis[0], axis[-1]) for place, axis in zip(at, axes, strict=True)]
    found: FloatArray = table(np.stack(places, axis=-1))
    return found


def largest(values: Iterable[float]) -> float:
    """Largest magnitude, point by point; 0 of none."""
    sizes = [*map(abs, values)]
    return reduce(larger, sizes) if Points in map(type, sizes) else max(sizes, default=0.0)


def _norm(values: Sequence[float], order: float) -> Any:
    most: Any = reduce(np.maximum if order > 0 else np.minimum, values)
    return most * sum((value / most) ** order for value in values) ** (1 / order)


norm = _Either(lambda values, order: float(np.linalg.norm([*map(float, values)], order)), _norm)
"""(Sum of the powers of positive numbers)^(1/order)."""
total = _Either(
    lambda values: float(values.sum()),
    lambda values: values.reshape(len(values), -1).sum(axis=1, keepdims=True),
)
"""Sum over all places."""
most = _Either(
    lambda values: float(values.max()), lambda values: values.max(axis=-1, keepdims=True)
)
"""Largest of all places."""
least = _Either(
    lambda values: float(values.min()), lambda values: values.min(axis=-1, keepdims=True)
)
"""Smallest of all places."""


def side_by_side(values: Iterable[Any]) -> FloatArray:
    """Numbers as an array, along its last axis; of `Points` the points are the first one."""
    values = list(values)
    if Points not in map(type, values):
        return np.array(values, dtype=float)
    table = np.empty((points_in(values), len(values)))
    for place, value in enumerate(values):
        table[:, place : place + 1] = value
    return table


def row_by_row(
    kernel: Callable[..., FloatArray], places: Sequence[FloatArray], *numbers: Iterable[Any]
) -> FloatArray:
    """A kernel over arrays of shape (points, n), the first of them whole, and rows of numbers."""
    rows = [np.ascontiguousarray(np.atleast_2d(values)) for values in places]
    for table in map(side_by_side, numbers):
        # a copy, which may be written to: a kernel is compiled apart for what may not
        rows.append(np.array(np.broadcast_to(table, (len(rows[0]), table.shape[-1])), order="C"))
    return kernel(*rows).reshape(places[0].shape).view(type(places[0]))


def apart(table: FloatArray) -> list[Any]:
    """The numbers that `side_by_side` put together."""
    if table.ndim == 1:
        numbers: list[Any] = table.tolist()
        return numbers
    return [table[:, place : place + 1].view(Points) for place in range(table.shape[1])]


# Points put together, and taken out again.


class Each(tuple[Any, ...]):
    """One object for each point."""

    __slots__ = ()


def joined(
    values: Sequence[Any],
    # What stands for what differs in more than numbers; None: `Apart` is raised.
    unlike: Callable[[Sequence[Any]], Any] | None = None,
) -> Any:
    """Objects of several points as one object, whose numbers are `Points`.

    Numbers that do not differ are `Points`, too: what shares a block must not matter. With `unlike`
    they stay what they are.
    """
    first: Any = values[0]
    cls: Any = type(first)
    own = partial(joined, unlike=unlike)
    if unlike is not None:
        if cls is np.ndarray:
            _alike([value.shape for value in values])
            return of_points(values)
        looked_for = hasattr(first, "parts")  # what comparing it would look for
        if not looked_for and all(value is first or value == first for value in values):
            return first
        kind = _kind(first)
        if any(_kind(value) != kind for value in values):
            return unlike(values)
    if cls is float:
        return of_points(values).reshape(-1, 1)
    if getattr(first, "pointwise", False):
        if hasattr(first, "parts"):
            return cls(*own([value.parts for value in values]))
        return cls(
            **{name: own([getattr(value, name) for value in values]) for name in _names(cls)}
        )
    if isinstance(first, Mapping):
        _alike(list(map(_kind, values)))
        return {key: own([value[key] for value in values]) for key in first}
    if isinstance(first, tuple):
        _alike(list(map(_kind, values)))
        columns = list(map(own, zip(*values, strict=True)))
        return cls(columns) if cls is tuple else cls(*columns)
    if unlike is not None:
        return unlike(values)
    _alike(values)
    return first


def part_of_each(values: Sequence[Any]) -> Each:
    """Parts of machines that are solved `one_by_one`; `Apart` is raised if they are others."""
    if not getattr(type(values[0]), "one_by_one", False):
        _alike(values)
    return Each(values)


def _kind(value: Any) -> Any:
    """What objects have in common that can be joined."""
    of = tuple(value) if isinstance(value, Mapping) else isinstance(value, tuple) and len(value)
    return type(value), of


def one_by_one(function: Callable[..., Any], *args: Any) -> Any:
    """A call; for each point where they have parts of their own, or are `Alone`, and joined."""
    parts = [part for arg in args for part in ((arg, *arg) if isinstance(arg, tuple) else (arg,))]
    count = next((len(part) for part in parts if isinstance(part, Each)), 0)
    try:
        if not count:
            return function(*args)
    except Alone as alone:
        if not alone.args:
            raise
        (count,) = alone.args
    return joined([function(*own) for own in taken(args, range(count))], Each)


def for_alike(truths: Sequence[Any], function: Callable[..., Any], *args: Any) -> Any:
    """A call as by `one_by_one`, made at once for those points for which the same truths hold."""
    sides = [np.asarray(truth)[:, 0] for truth in truths if isinstance(truth, Points)]
    if not sides:
        return one_by_one(function, *args)
    _, kinds = np.unique(sides, axis=1, return_inverse=True)
    places = [np.flatnonzero(kinds == kind) for kind in range(kinds.max() + 1)]
    found: dict[int, Any] = {}
    for rows, own in zip(places, taken(args, places), strict=True):
        try:
            answers = taken(one_by_one(function, *own), range(len(rows)))
        except Apart as parting:
            raise Apart(np.isin(np.arange(len(kinds)), rows[parting.rows])) from None
        found.update(zip(rows.tolist(), answers, strict=True))
    return joined([found[row] for row in range(len(kinds))], Each)


def _alike(values: Sequence[Any]) -> None:
    same = np.array([value is values[0] or value == values[0] for value in values])
    if not same.all():
        raise Apart(same)


def taken(value: Any, rows: Sequence[Any], *, final: bool = False) -> list[Any]:
    """What of an object belongs to one point, a number in `rows`, or to some, an array of them.

    If it is `final`, without what only a next pass would read.
    """
    found = _Taking(rows, final).of(value)
    return [value] * len(rows) if found is None else found


_PLAIN = {str, float, int, bool, type(None), np.ndarray}


@cache
def _names(cls: Hashable) -> tuple[str, ...]:
    fields: Any = cls
    return tuple(it.name for it in dataclasses.fields(fields) if it.init)


@dataclasses.dataclass(frozen=True)
class _Later:
    """A call with what belongs to some points, which is taken when single ones are."""

    call: Any  # A `partial`.
    rows: Any

    def __call__(self) -> Any:
        return taken(self.call, [self.rows], final=True)[0]()


class AtOnce(partial[Any]):
    """A call that answers for all points of a block."""


def itself(value: Any) -> Any:
    """The value."""
    return value


@dataclasses.dataclass
class _Once:
    """A call for all points of a block, made when somebody asks for one of them."""

    call: AtOnce
    rows: Sequence[int]
    found: Sequence[Any] | None = None

    def of(self, place: int) -> Any:
        """What belongs to the point at a place in `rows`."""
        if self.found is None:
            self.found = taken(self.call(), self.rows, final=True)
        return self.found[place]


@dataclasses.dataclass
class _Taking:
    """What of objects belongs to each of some points; None of one that is the same for all."""

    rows: Sequence[Any]
    final: bool = False
    found: dict[tuple[int, int], Any] = dataclasses.field(default_factory=dict)
    # Which places of the contact that is looked at carry load at each point; empty if all do.
    kept: Sequence[BoolArray] = ()

    def of(self, value: Any) -> list[Any] | None:
        cls = type(value)
        if cls in _PLAIN:
            return None
        if cls is Points:
            return self._numbers(value)
        if cls is dict:
            return self._made(lambda row: dict(zip(value, row, strict=True)), value.values())
        if cls is tuple or cls is list:
            return self._made(cls, value)
        if cls is Each:
            return [
                value[row] if isinstance(row, int) else Each(value[own] for own in row)
                for row in self.rows
            ]
        if cls is MethodType or cls is MethodWrapperType:
            owners = self.of(value.__self__)
            return None if owners is None else [getattr(it, value.__name__) for it in owners]
        if cls in (partial, AtOnce, _Later) and not self.final:
            call, rows = (value.call, value.rows) if cls is _Later else (value, None)
            own = self.rows if rows is None else [rows[row] for row in self.rows]
            return [_Later(call, row if np.ndim(row) else int(row)) for row in own]
        marked = getattr(cls, "pointwise", False) or hasattr(cls, "_fields")
        if cls not in (partial, AtOnce, _Later) and not marked:
            return None
        mark = id(value), id(self.kept)
        if mark not in self.found:  # with what it is of, so that no other gets its mark
            self.found[mark] = value, self.kept, self._objects(cls, value)
        found: list[Any] | None = self.found[mark][-1]
        return found

    def _made(self, make: Callable[[Any], Any], parts: Iterable[Any]) -> list[Any] | None:
        """Objects made of the parts that belong to each point."""
        parts = list(parts)
        columns = list(map(self.of, parts))
        if all(column is None for column in columns):
            return None
        filled = (
            repeat(part, len(self.rows)) if column is None else column
            for part, column in zip(parts, columns, strict=True)
        )
        return list(map(make, zip(*filled, strict=True)))

    def _numbers(self, value: Points) -> list[Any]:
        if not isinstance(self.rows[0], int):
            return [value[row] for row in self.rows]
        if value.shape[1:] == (1,):
            numbers: list[Any] = np.asarray(value)[self.rows, 0].tolist()
            return numbers
        own = list(np.asarray(value)[self.rows])
        if self.kept and self.kept[0].shape == own[0].shape:
            return [values[kept] for values, kept in zip(own, self.kept, strict=True)]
        return own

    def _objects(self, cls: Any, value: Any) -> list[Any] | None:
        if cls is _Later:
            return _Taking(value.rows[self.rows].tolist(), final=True).of(value.call)
        if cls is AtOnce:
            once = _Once(value, self.rows)
            return [partial(once.of, place) for place in range(len(self.rows))]
        before = self.kept
        for it in (value, *(value.args if cls is partial else ())):
            if isinstance(loaded := getattr(it, "loaded", None), Points):
                self._keep(np.asarray(loaded))
        if cls is partial:
            found = self._made(lambda row: partial(*row), (value.func, *value.args))
        elif hasattr(value, "parts"):
            found = self._made(lambda row: cls(*row), value.parts)
        elif isinstance(value, tuple):
            found = self._made(cls._make, value)
        elif hasattr(value, "loaded") and hasattr(value, "__dict__"):  # with what follows from it
            found = self._made(
                lambda row: _with_fields(cls, dict(zip(vars(value), row, strict=True))),
                map(self._of_each, vars(value).values()),
            )
        else:
            names = _names(cls)
            left: Mapping[str, Any] = {}
            if self.final and hasattr(value, "of_last_pass"):
                left = value.of_last_pass()
            found = self._made(
                lambda row: cls(**dict(zip(names, row, strict=True))),
                [left[name] if name in left else getattr(value, name) for name in names],
            )
        self.kept = before
        return found

    def _of_each(self, values: Any) -> Any:
        """What all points share of a contact of which each keeps other places."""
        if self.kept and type(values) is np.ndarray and values.shape == self.kept[0].shape:
            return np.broadcast_to(values, (max(self.rows) + 1, *values.shape)).view(Points)
        return values

    def _keep(self, loaded: BoolArray) -> None:
        self.kept = ()
        if isinstance(self.rows[0], int) and not loaded.all():
            self.kept = list(loaded[self.rows])


def _with_fields(cls: Any, fields: Mapping[str, Any]) -> Any:
    made = object.__new__(cls)
    vars(made).update(fields)
    return made
