"""Ranges in which models were made, and the flag raised when a result leaves one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.units import Quantity, format_number

__all__ = ["Range", "ValidityFlag", "check_ranges", "describe_flags"]

FloatArray = NDArray[np.float64]

SMALLEST_SHOWN_SHARE = 0.01

GIGAPASCAL = Quantity("a pressure", "Pa", "GPa")
MILLIMETRE = Quantity("a length", "m", "mm")
MICROMETRE = Quantity("a length", "m", "um")
MILLIPASCAL_SECOND = Quantity("a viscosity", "Pa*s", "mPa*s")
METRE_PER_SECOND = Quantity("a speed", "m/s", "m/s")
CELSIUS = Quantity("a temperature", "K", "degC")
NUMBER = Quantity("a number", "", "")


@dataclass(frozen=True, slots=True)
class Range:
    """Range of one quantity in which a model was made.

    Attributes
    ----------
    name : str
        Name of the quantity among the values handed to `check_ranges`.
    label : str
        The same in words.
    low, high : float
        In the display unit of `unit`.
    unit : Quantity
    source : str
        Where the range is printed.
    """

    name: str
    label: str
    low: float
    high: float
    unit: Quantity
    source: str


@dataclass(frozen=True, slots=True)
class ValidityFlag:
    """A model used outside the range in which it was made.

    Attributes
    ----------
    model : str
        The model and where it was used.
    quantity : str
    found_low, found_high, low, high : float
        Values found and the range left, in `unit`.
    unit : str
    share : float
        Part of the loss, or of the contact, that lies outside. [1]
    source : str
    """

    model: str
    quantity: str
    found_low: float
    found_high: float
    low: float
    high: float
    unit: str
    share: float
    source: str


def describe_flags(flags: Iterable[ValidityFlag]) -> tuple[str, ...]:
    """One sentence for each quantity and range left, naming every model that left it."""
    groups: dict[tuple[str, str, float, float, str], list[ValidityFlag]] = {}
    for flag in flags:
        key = (flag.quantity, flag.unit, flag.low, flag.high, flag.source)
        groups.setdefault(key, []).append(flag)
    return tuple(_sentence(group) for group in groups.values())


def _sentence(group: list[ValidityFlag]) -> str:
    first = group[0]
    low = format_number(min(flag.found_low for flag in group), 3)
    high = format_number(max(flag.found_high for flag in group), 3)
    found = low if low == high else f"{low} to {high}"
    unit = f" {first.unit}" if first.unit else ""
    models = ", ".join(f"{flag.model} {_percent(flag.share)}" for flag in group)
    return (
        f"Out of range, extrapolated: {first.quantity} {found}{unit}; range "
        f"{format_number(first.low)} to {format_number(first.high)}{unit} ({first.source}). "
        f"Share of the loss: {models}."
    )


def _percent(share: float) -> str:
    return f"{share:.0%}" if share >= SMALLEST_SHOWN_SHARE else "under 1%"


def check_ranges(
    model: str,
    ranges: Iterable[Range],
    values: Mapping[str, FloatArray | float],
    weight: FloatArray | float = 1.0,
) -> tuple[ValidityFlag, ...]:
    """Flags for every quantity that leaves its range; `weight` is the loss at each value.

    Theory (P8).
    """
    flags = []
    for item in ranges:
        value = np.atleast_1d(np.asarray(values[item.name], dtype=float))
        scale, offset = _display(item.unit)
        shown = value * scale + offset
        slack = 1e-9 * max(abs(item.low), abs(item.high))
        outside = (shown < item.low - slack) | (shown > item.high + slack)
        if not outside.any():
            continue
        weights = np.broadcast_to(np.asarray(weight, dtype=float), value.shape)
        total = float(weights.sum())
        share = float(weights[outside].sum()) / total if total > 0 else 1.0
        flags.append(
            ValidityFlag(
                model, item.label, float(shown.min()), float(shown.max()),
                item.low, item.high, item.unit.display, share, item.source,
            )
        )  # fmt: skip
    return tuple(flags)


def _display(unit: Quantity) -> tuple[float, float]:
    """Scale and offset from SI to the display unit."""
    if not unit.si:
        return 1.0, 0.0
    zero = unit.to_display(0.0)
    return unit.to_display(1.0) - zero, zero
