"""What limits the trust in a result, and what would raise it most."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from epicyclic import library
from epicyclic.arrays import FloatArray
from epicyclic.case.case import Case
from epicyclic.case.tables.uncertainty import MODEL_FORM
from epicyclic.dataclass import dataclass
from epicyclic.errors import ConvergenceError
from epicyclic.losses.ranges import range_text
from epicyclic.result.result import Result
from epicyclic.study.friction import (
    MOSTLY,
    STANDARD,
    compare_friction,
    recommended,
    standard_beside,
)
from epicyclic.units import known_text, percent

if TYPE_CHECKING:
    import xarray as xr


MOST_DRIVERS = 3  # Inputs and models that are named after a band.
LEAST_SHARE = 0.005  # Of the band, of a cause that is named. [1]


@dataclass(frozen=True, slots=True)
class Known:
    """The band of a result, what makes it, and what to know of it."""

    unit: str  # Unit of the total and its parts.
    nominal: Mapping[str, float]  # Results of the case.
    ends: Mapping[str, tuple[float, float]]  # Ends of the symmetric 95 % interval of each result.
    draws: Mapping[str, FloatArray]  # What each result may be.
    shares: Mapping[str, float]  # Shares of drivers in the variance of the total, each alone. [1]
    names: Mapping[str, str]  # What each input is called, and how to know it better.
    advice: Mapping[str, str]  # What each input is called, and how to know it better.
    remarks: tuple[str, ...]  # Sentences on warnings and models.

    @property
    def width(self) -> float:
        """Width of the band of the total."""
        low, high = self.ends["total"]
        return high - low

    @property
    def drivers(self) -> list[tuple[str, float]]:
        """Drivers with their shares, the largest first."""
        return sorted(self.shares.items(), key=lambda item: -item[1])


def known_of(data: xr.Dataset) -> Known:
    """What a dataset of `uncertainty`, of a case or cycle or kept with a result, says."""
    results = [str(name) for name in data["result"].values]
    inputs = [str(key) for key in data["input"].values]
    own = data["first_order"].sel(sum="total").clip(0.0, 1.0).fillna(0.0)
    ends = zip(data["low"].values.tolist(), data["high"].values.tolist(), strict=True)
    return Known(
        unit=unit_of(data),
        nominal=dict(zip(results, data["nominal"].values.tolist(), strict=True)),
        ends=dict(zip(results, ends, strict=True)),
        draws=dict(zip(results, data["value"].values, strict=True)),
        shares=dict(zip(map(str, own["driver"].values), own.values.tolist(), strict=True)),
        names=dict(zip(inputs, map(str, data["input_name"].values), strict=True)),
        advice=dict(zip(inputs, map(str, data["input_advice"].values), strict=True)),
        remarks=tuple(str(data.attrs["remarks"]).splitlines()),
    )


def unit_of(data: xr.Dataset, result: str = "total") -> str:
    """Unit of a result of such a dataset: of losses, of energies lost, of the efficiency."""
    return str(data["unit"].sel(result=result).values)


def mean_shares(data: xr.Dataset) -> xr.DataArray:
    """Shares of the variance of the total loss over a map, the mean where the loss is, in order."""
    shares, weights = data["first_order"], data["total"].fillna(0.0)
    mean = (shares.fillna(0.0) * weights).sum(weights.dims) / weights.sum()
    return mean.sortby(-mean)


_KEY = re.compile(r"[\w.-]+\.[\w.-]+")
_OF_ALL = ("sets", "gears", "operation", "models")  # Tables that the name of a key needs not.
LEAST = 0.02
"""Share in the variance of the total from which a value is said to limit the trust. [1]"""
CONCERNED = 0.05  # Part of the total loss from which a warning matters. [1]


@dataclass(frozen=True, slots=True)
class Limit:
    """A value, or several that are correlated, that the band is due to."""

    name: str
    advice: str  # What to do about it.
    width: float  # Width of the band that it makes alone, in the unit of the total.


@dataclass(frozen=True, slots=True)
class Measurement:
    """Something that could be measured."""

    name: str
    is_input: bool  # False for a part of the loss.
    width: float  # Width of the band that is left once it is known, in the unit of the total.


def limits_of(known: Known) -> list[Limit]:
    """What makes the band, the most important first.

    The band that a value makes alone is that of the total times the root of its share.
    """
    found = []
    for driver, share in known.drivers:
        if share < LEAST:
            break
        advice = dict.fromkeys(known.advice[key] for key in _keys(driver))
        found.append(Limit(called(known, driver), "; ".join(advice), known.width * sqrt(share)))
    return found


def measurements_of(known: Known) -> list[Measurement]:
    """What could be measured, that which narrows the band most first. Theory (U12)."""
    found = [
        Measurement(called(known, driver), True, known.width * sqrt(1 - share))
        for driver, share in known.shares.items()
        if not driver.startswith(MODEL_FORM)
    ]
    for entry in library.uncertainty_table()["measurements"]:
        left = _left(known, entry["result"], entry["uncertainty"])
        name = f"{entry['name']} (u {percent(entry['uncertainty'], 0)})"
        found.append(Measurement(name, False, known.width * sqrt(left)))
    return sorted(found, key=lambda it: it.width)


def _keys(driver: str) -> list[str]:
    """Keys of one value, or of several that are correlated."""
    return driver.split(" + ")


def called(known: Known, driver: str) -> str:
    """The name of one value, or of several that are correlated."""
    return " + ".join(known.names[key] for key in _keys(driver))


def in_few_words(name: str) -> str:
    """The name of an input, ``"roughness of S sun"`` where that is its key."""
    if not _KEY.fullmatch(name):
        return name
    *owners, last = name.replace("_", " ").split(".")
    owner = ": ".join(one for one in owners if one not in _OF_ALL)
    whole = f"number of {owner}s" if last == "count" else f"{last} of {owner}"
    return whole if owner else last


def main_causes(known: Known) -> str:
    """What makes most of a band, with its shares."""
    return ", ".join(
        f"{in_few_words(called(known, driver))} {percent(share, 0)}"
        for driver, share in known.drivers[:MOST_DRIVERS]
        if share >= LEAST_SHARE
    )


def _left(known: Known, name: str, uncertainty: float) -> float:
    """Part of the variance of the total that is left once a part of the loss is measured."""
    part, total = known.draws[name], known.draws["total"]
    sound = np.isfinite(part) & np.isfinite(total)
    (own, both), (_, whole) = np.cov(part[sound], total[sound])
    spread = own + (uncertainty * known.nominal[name]) ** 2
    return float(np.clip(1 - both**2 / spread / whole, 0.0, 1.0)) if spread and whole else 1.0


BETTER = "would suit this case better"  # What is said of a friction model that is not chosen.


def is_on_first_screen(remark: str) -> bool:
    """True for another model that suits better, and for what the standard gives."""
    return BETTER in remark or remark.startswith(STANDARD)


def model_remarks(case: Case, result: Result, *, brief: bool = False) -> list[str]:
    """Which warnings matter, in watts, and which friction model suits the oil and the range.

    With `brief` only what takes a fraction of a second.
    """
    return [*_warnings(result), *_friction(case, result, brief)]


def _warnings(result: Result) -> Iterator[str]:
    flags = sorted(result.flags_with_loss, key=lambda pair: -np.nan_to_num(pair[0], nan=np.inf))
    told = [
        f"{range_text(group)} ({known_text(watts)})"
        for watts, group in flags
        if watts >= CONCERNED * result.total
    ]
    if told:
        yield f"Important warnings, with the affected loss: {'; '.join(told)}."
    elif flags:
        yield f"No warning affects more than {percent(CONCERNED, 0)} of the loss."


def _friction(case: Case, result: Result, brief: bool) -> Iterator[str]:
    quick = case.models.temperatures == "inlet"
    slides = any(term.watts for term in result.terms if term.name.endswith("sliding"))
    if not slides or not case.operation.torque or (brief and not quick):
        return
    try:
        rows = compare_friction(case, brief=True)
    except ConvergenceError:  # of a model that is not that of the case
        return
    best, why = recommended(rows)
    does = "is suitable" if best.chosen else BETTER
    if best.chosen and best.outside > MOSTLY:
        does = "is only the nearest, because no model covers most of the loss"
    yield f"Friction: {best.name} {does}; {why}."
    beside = standard_beside(rows, result)
    if beside:
        yield beside
