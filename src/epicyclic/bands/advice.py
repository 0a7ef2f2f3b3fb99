"""What limits the trust in a result, and what would raise it most."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import sqrt

import numpy as np

from epicyclic import library
from epicyclic.analysis.compare import compare_friction, recommended
from epicyclic.bands.known import Known
from epicyclic.builders.build import layout_of
from epicyclic.case.case import Case
from epicyclic.case.uncertain_values import MODEL_FORM
from epicyclic.errors import ConvergenceError
from epicyclic.losses.validity import range_text
from epicyclic.results.result import Result
from epicyclic.units import known_text, percent

LEAST = 0.02
"""Share in the variance of the total from which a value is said to limit the trust. [1]"""
CONCERNED = 0.05
"""Part of the total loss from which a warning matters. [1]"""


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
        found.append(Limit(_called(known, driver), "; ".join(advice), known.width * sqrt(share)))
    return found


def measurements_of(known: Known) -> list[Measurement]:
    """What could be measured, that which narrows the band most first. Theory (U12)."""
    found = [
        Measurement(_called(known, driver), True, known.width * sqrt(1 - share))
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


def _called(known: Known, driver: str) -> str:
    return " + ".join(known.names[key] for key in _keys(driver))


def _left(known: Known, name: str, uncertainty: float) -> float:
    """Part of the variance of the total that is left once a part of the loss is measured."""
    part, total = known.draws[name], known.draws["total"]
    sound = np.isfinite(part) & np.isfinite(total)
    (own, both), (_, whole) = np.cov(part[sound], total[sound])
    error = uncertainty * known.nominal[name]
    spread = own + error**2
    return float(np.clip(1 - both**2 / spread / whole, 0.0, 1.0)) if spread and whole else 1.0


def model_remarks(case: Case, result: Result, *, brief: bool = False) -> list[str]:
    """Which warnings matter, in watts, and which friction model suits the oil and the range.

    With `brief` only what takes a fraction of a second.
    """
    return [*_warnings(result), *_friction(case, brief)]


def _warnings(result: Result) -> Iterator[str]:
    flags = sorted(result.flags_with_loss, key=lambda pair: -np.nan_to_num(pair[0], nan=np.inf))
    told = [
        f"{range_text(group)} ({known_text(watts)})"
        for watts, group in flags
        if watts >= CONCERNED * result.total
    ]
    if told:
        yield f"Warnings that matter, with the loss that they concern: {'; '.join(told)}."
    elif flags:
        yield f"No warning concerns more than {percent(CONCERNED, 0)} of the loss."


def _friction(case: Case, brief: bool) -> Iterator[str]:
    quick = case.kind != "train" and case.models.temperatures == "inlet"
    if not layout_of(case).meshes or not case.operation.torque or (brief and not quick):
        return
    try:
        best, why = recommended(compare_friction(case, brief=True))
    except ConvergenceError:  # of a model that is not that of the case
        return
    does = "suits" if best.chosen else "would suit better than that of the case"
    yield f"Friction: {best.name} {does}: {why}."
