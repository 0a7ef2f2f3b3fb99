"""Where models hold: ranges, flags for what leaves them, and what every loss model states."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property, partial
from typing import Any, Generic, Literal, NamedTuple, Protocol, TypeVar, cast

import numpy as np

from epicyclic.arrays import BoolArray, Each, FloatArray, Points, between, side_by_side
from epicyclic.dataclass import dataclass, replace
from epicyclic.units import WATT, Quantity, format_number, known_text, percent, unit_text

BearingType = Literal[
    "deep-groove",
    "cylindrical",
    "tapered",
    "needle",
    "angular-contact",
    "spherical",
    "thrust-ball",
    "thrust-roller",
]
"""Kinds of rolling bearings: a model holds for some of them."""
Cage = Literal["caged", "full-complement"]


def takes_no_axial_force(kind: str, designation: str | None) -> bool:
    """True of bearings that carry no axial force: needles, and those with ribs on one ring only."""
    name = (designation or "").upper()  # NU 208, N 208, NN 3010; not NJ, NUP, NCF
    return kind == "needle" or (name[:1] == "N" and name.lstrip("NU .-")[:1].isdigit())


# Ranges in which models were made: values held in them, and flags for what leaves them.


Real = TypeVar("Real", float, FloatArray)
Item = TypeVar("Item")

SMALLEST_SHOWN_SHARE = 0.01
SMALLEST_APART = 0.01
"""Part of the total loss below which a range left shares a sentence with others. [1]"""
OUT_OF_RANGE = "Out of range"  # Begins what `describe_flags` says of a flag.
OF_THIS_PACKAGE = "limit of this package; none is printed"
"""Source of a range that no publication states."""


@dataclass(frozen=True, eq=False)
class Range:
    """Range of one quantity in which a model was made."""

    name: str  # Name of the quantity among the values handed to `check_ranges`.
    label: str  # The same in words.
    low: float | None  # In the display unit of `unit`; None where there is no such limit.
    high: float | None  # In the display unit of `unit`; None where there is no such limit.
    unit: Quantity
    source: str  # Where the range is printed.
    # From the conditions to the quantity, where these have no attribute `name`.
    of: Callable[[Any], FloatArray | float] | None = None

    def limits(self) -> tuple[float | None, float | None]:
        """`low` and `high` in SI."""
        scale, offset = self.unit.scale_and_offset()
        low = None if self.low is None else (self.low - offset) / scale
        high = None if self.high is None else (self.high - offset) / scale
        return low, high

    @cached_property
    def bounds(self) -> tuple[float, float]:
        """`limits`, infinite where there is none, with room for rounding."""
        slack = 1e-9 * max(abs(limit) for limit in (self.low, self.high) if limit is not None)
        scale, offset = self.unit.scale_and_offset()
        low = -math.inf if self.low is None else (self.low - slack - offset) / scale
        high = math.inf if self.high is None else (self.high + slack - offset) / scale
        return low, high


class RegressionFluid(NamedTuple):
    """The fluid of the simulations behind a regression."""

    key: str  # What an oil states as its `friction_regression` if it is this fluid.
    title: str


class LossModel(Protocol):
    """What every model of friction or rolling loss states."""

    @property
    def name(self) -> str:
        """Under which a case chooses it."""

    @property
    def title(self) -> str:
        """For reports."""

    @property
    def source(self) -> str:
        """Where it is printed."""

    @property
    def made_for(self) -> RegressionFluid | None:
        """The fluid that it was made for, if it holds for no other."""

    @property
    def ranges(self) -> tuple[Range, ...]:
        """Where the model was made; leaving it is flagged."""

    def flags(self, role: str, contact: Any, loss: FloatArray) -> tuple[ValidityFlag, ...]:
        """What leaves the ranges in a mesh with some loss at each point, for a role as `ModelUse`
        has it.
        """


class RangeFlags:
    """The flags of a model that is used wherever it is asked, also beyond its ranges."""

    __slots__ = ()

    def flags(
        self: LossModel, role: str, contact: Any, loss: FloatArray
    ) -> tuple[ValidityFlag, ...]:
        """See `LossModel`."""
        use = ModelUse(role, self.name, contact.mesh.name)
        return check_contacts(use, self.ranges, contact, loss)


@dataclass(frozen=True, slots=True, kw_only=True)
class Formula(RangeFlags):
    """A `LossModel` that is a formula: its entry in the table of its kind."""

    name: str
    title: str
    source: str
    reliability: str  # How well it is known to be right, and against what, as a phrase.
    ranges: tuple[Range, ...] = ()
    made_for: RegressionFluid | None = None
    several: bool = True  # Whether contacts may be those of several points.


@dataclass(frozen=True, slots=True)
class ModelUse:
    """A model and what it was used for.

    Attributes
    ----------
    role : str
        Key of the case under which the model is chosen: ``"friction"``.
    model : str
        Its name there: ``"mixed-ehl"``.
    where : str
        ``"sun mesh"``.
    instead : str
        The model that takes over outside the range; empty if the model goes on there itself.
    """

    role: str
    model: str
    where: str
    instead: str = ""

    def __str__(self) -> str:
        instead = f"; {self.instead} is used instead" if self.instead else ""
        return f"{self.role.replace('_', ' ')} {self.model} ({self.where}{instead})"


@dataclass(frozen=True, slots=True)
class ValidityFlag:
    """A model used outside the range in which it was made.

    Attributes
    ----------
    use : ModelUse
        The model and where it was used.
    quantity : str
    found_low, found_high : float
        Values found, in `unit`.
    low, high : float or None
        The range left, in `unit`.
    unit : str
    share : float
        Part of the loss, or of the contact, that lies outside. [1]
    source : str
    watts : float or None
        Loss that it concerns, where that is not `share` of a term. [W]
    could_be : float
        What that loss would be by the law that holds there; 0 if nobody says. [W]
    """

    use: ModelUse
    quantity: str
    found_low: float
    found_high: float
    low: float | None
    high: float | None
    unit: str
    share: float
    source: str
    watts: float | None = None
    could_be: float = 0.0


class Sought(Generic[Item]):
    """What is looked for when somebody reads it.

    Most answers of an element are steps on the way to the last one, of which alone anybody does.
    """

    pointwise = True

    __slots__ = ("_looks",)

    def __init__(self, *looks: Callable[[], Iterable[Item]]) -> None:
        self._looks = looks

    @property
    def parts(self) -> tuple[Callable[[], Iterable[Item]], ...]:
        """What it is made of."""
        return self._looks

    def __iter__(self) -> Iterator[Item]:
        for look in self._looks:
            yield from look()


class Flags(Sought[ValidityFlag]):
    __slots__ = ()

    def __add__(self, other: Flags | tuple[ValidityFlag, ...]) -> Flags:
        return Flags(*self._looks, other.__iter__)

    def __radd__(self, other: tuple[ValidityFlag, ...]) -> Flags:
        return Flags(other.__iter__, *self._looks)


SomeFlags = Flags | tuple[ValidityFlag, ...]


def held_in_range(value: Real, item: Range) -> Real:
    """`value`, in SI, or the limit of `item` that it leaves. Theory (F5)."""
    return cast(Real, between(value, *item.limits()))


def describe_flags(
    flags: Iterable[ValidityFlag],
    # Loss that a model was used for; NaN if it is not known. [W]
    loss_of: Callable[[ModelUse], float] = lambda use: math.nan,
    # Total loss; what concerns less than `SMALLEST_APART` of it shares one sentence. [W]
    total: float = math.nan,
) -> tuple[str, ...]:
    """One sentence for each quantity and range left, those that concern most of the loss first."""
    concerned = flags_with_loss(flags, loss_of)
    small = [pair for pair in concerned if what_it_may_be(*pair) < SMALLEST_APART * total]
    large = [pair for pair in concerned if pair not in small]
    large.sort(key=lambda pair: -what_it_may_be(*pair))
    sentences = [_sentence(watts, group) for watts, group in large]
    if len(small) == 1:
        sentences.append(_sentence(*small[0]))
    elif small:
        ranges = "; ".join(range_text(group) for _, group in small)
        watts = max(what_it_may_be(*pair) for pair in small)
        sentences.append(f"{OUT_OF_RANGE}, each for at most {WATT.text(watts, 2)}: {ranges}.")
    return tuple(sentences)


def flags_with_loss(
    flags: Iterable[ValidityFlag], loss_of: Callable[[ModelUse], float]
) -> list[tuple[float, list[ValidityFlag]]]:
    """Flags of one quantity and range together, with the loss that they concern; NaN if unknown.

    Parameters as for `describe_flags`.
    """
    groups: dict[tuple[object, ...], list[ValidityFlag]] = {}
    for flag in flags:
        key = (flag.quantity, flag.unit, flag.low, flag.high, flag.source)
        groups.setdefault(key, []).append(flag)
    return [
        (
            sum(
                flag.share * loss_of(flag.use) if flag.watts is None else flag.watts
                for flag in group
            ),
            group,
        )
        for group in groups.values()
    ]


def what_it_may_be(watts: float, group: Iterable[ValidityFlag]) -> float:
    """What a range left may mean: the loss concerned, or what it would be; infinite if unknown."""
    return math.inf if math.isnan(watts) else max(watts, sum(flag.could_be for flag in group))


MOST_LEFT = 10.0  # How many times a limit may be exceeded to weigh a warning by it. [1]


def weight_of(watts: float, group: Iterable[ValidityFlag]) -> float:
    """What a range left may mean, to order warnings: nobody knows the law beyond it. [W]

    Where no law is known, a loss is taken to be wrong by as much as the limit is exceeded.
    """
    group = list(group)
    return max(what_it_may_be(watts, group), watts * min(MOST_LEFT, max(map(_left_by, group))))


def _left_by(flag: ValidityFlag) -> float:
    """How many times a flag exceeds its limit, 1 or more."""
    above = flag.found_high / flag.high if flag.high else 1.0
    below = flag.low / flag.found_low if flag.low and flag.found_low > 0 else 1.0
    return max(above, below, 1.0)


def concern_text(watts: float, group: Iterable[ValidityFlag]) -> str:
    """The loss that a range left concerns, ``"26.5 W, which could be 683 W"``."""
    most = what_it_may_be(watts, group)
    return known_text(watts) + (f", which could be {known_text(most)}" if most > watts else "")


def _sentence(watts: float, group: list[ValidityFlag]) -> str:
    models = ", ".join(f"{flag.use} {share_text(flag.share)}" for flag in group)
    size = "" if math.isnan(watts) else f"; {concern_text(watts, group)} in all"
    return f"{range_left(group)} Share of the loss: {models}{size}."


def range_left(group: Sequence[ValidityFlag]) -> str:
    """A sentence for one or more flags of one quantity and range."""
    return f"{OUT_OF_RANGE}: {range_text(group)} ({group[0].source})."


def range_text(group: Sequence[ValidityFlag]) -> str:
    """What was found, and the range."""
    return f"{group[0].quantity} {found_text(group)}, range {limits_text(group[0])}"


def found_text(group: Sequence[ValidityFlag]) -> str:
    """What was found by all flags of one quantity."""
    low, high = (min(flag.found_low for flag in group), max(flag.found_high for flag in group))
    texts = format_number(low, 3), format_number(high, 3)
    return (texts[0] if texts[0] == texts[1] else " to ".join(texts)) + _unit(group[0])


def limits_text(flag: ValidityFlag) -> str:
    """The range that it leaves."""
    if flag.high is None:
        return f"from {format_number(flag.low or 0.0)}{_unit(flag)}"
    if flag.low is None:
        return f"up to {format_number(flag.high)}{_unit(flag)}"
    low, high = format_number(flag.low), format_number(flag.high)
    return (low if low == high else f"{low} to {high}") + _unit(flag)


def _unit(flag: ValidityFlag) -> str:
    return f" {unit_text(flag.unit)}" if flag.unit else ""


def share_text(share: float) -> str:
    """A share of the loss in whole percent."""
    return percent(share, 0) if share >= SMALLEST_SHOWN_SHARE else "under 1 %"


def check_ranges(
    use: ModelUse,
    ranges: Iterable[Range],
    # The quantities, in SI, by the names of their ranges.
    values: Mapping[str, FloatArray | float],
    weight: FloatArray | float = 1.0,  # The loss at each value.
    part: float = 1.0,  # Part of the whole loss that the model is asked for here. [1]
    watts: float | None = None,  # As of `ValidityFlag`. [W]
    could_be: float = 0.0,  # As of `ValidityFlag`. [W]
) -> tuple[ValidityFlag, ...]:
    """Flags for every quantity that leaves its range. Theory (P8)."""
    left = (_flags(use, item, values[item.name], weight, part) for item in ranges)
    flags = (flag for own in left for flag in own if flag)
    return tuple(replace(flag, watts=watts, could_be=could_be) for flag in flags)


def check_contacts(
    use: ModelUse, ranges: Iterable[Range], contacts: Any, weight: FloatArray, part: float = 1.0
) -> tuple[ValidityFlag, ...]:
    """`check_ranges` of line contacts; local quantities count with the loss where they occur.

    Of the contacts of several points an `Each` of what belongs to each of them.
    """
    several = isinstance(weight, Points)
    loaded = np.asarray(contacts.loaded) if several else np.ones((1, weight.size), dtype=bool)
    found: list[list[ValidityFlag]] = [[] for _ in loaded]
    for item in ranges:
        values = getattr(contacts, item.name) if item.of is None else item.of(contacts)
        values = side_by_side(values) if isinstance(values, tuple) else values  # of both flanks
        local = np.shape(values)[-1:] == loaded.shape[-1:]
        flags = _flags(use, item, values, weight if local else 1.0, part, loaded if local else True)
        # one flag may be that of all points; there is none where all keep the range
        for own, flag in zip(found, flags * (len(found) if len(flags) == 1 else 1), strict=False):
            own += [flag] if flag else []
    return Each(map(tuple, found)) if several else tuple(found[0])


def _flags(
    use: ModelUse,
    item: Range,
    values: FloatArray | float,  # Of each point, shape (points, n); (n,) or a number of one.
    weight: FloatArray | float,
    part: float,
    held: BoolArray | bool = True,  # Which values there are.
) -> list[ValidityFlag | None]:
    """The flag of a quantity at each point, None where it keeps its range; nothing if all do."""
    low, high = item.bounds
    if isinstance(values, float) and low <= values <= high:
        return []
    values = np.atleast_2d(np.asarray(values, dtype=float))
    outside: BoolArray = ((values < low) | (values > high)) & held
    if not outside.any():
        return []
    values, weights = (np.broadcast_to(it, outside.shape) for it in (values, np.asarray(weight)))
    whole = np.where(held, weights, 0.0).sum(axis=1)  # its own `where` takes four times as long
    with np.errstate(invalid="ignore"):
        share = np.where(outside, weights, 0.0).sum(axis=1) / whole
    share = np.where(whole > 0, np.minimum(share, 1.0), 1.0)
    scale, offset = item.unit.scale_and_offset()
    least = np.where(held, values, np.inf).min(axis=1, initial=np.inf) * scale + offset
    most = np.where(held, values, -np.inf).max(axis=1, initial=-np.inf) * scale + offset
    made = partial(ValidityFlag, use, item.label)
    ends = item.low, item.high, item.unit.display
    left = np.atleast_1d(outside.any(axis=1))
    rows = zip(left, least.tolist(), most.tolist(), share.tolist(), strict=True)
    return [
        made(low, high, *ends, part * beyond, item.source) if outside else None
        for outside, low, high, beyond in rows
    ]


FITTED_QUANTITIES = {
    "friction": "friction",
    "rolling": "rolling_loss",
    "bearing": "bearing_rolling_loss",
}
"""Which quantity of the fits of an oil each role takes."""
