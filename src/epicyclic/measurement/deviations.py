"""How far computed losses are from measured ones, by set of points and by group."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.measurement.table import Measurements

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

AS_GIVEN, CALIBRATED = "as given", "CALIBRATED"
"""State of the case behind computed losses."""
ALL, USED, HELD_OUT = "all points", "fitted points", "held-out points"


@dataclass(frozen=True, slots=True)
class ErrorFigures:
    """How far computed losses are from measured ones, in one set of points.

    Errors are computed less measured; relative ones are over the measured loss, of points where
    that is positive.

    Attributes
    ----------
    state : str
        ``"as given"`` or ``"CALIBRATED"``.
    points : str
        Which points: all, those of the fit, or those held out from it.
    group : str
        The group within these, such as ``"temperature 40"``; empty for all of them.
    count : int
        How many of them could be computed.
    bias, rms : float
        Mean error, and root of the mean squared error. [W]
    relative_bias, mean_percentage : float
        Mean relative error, and mean of its magnitude. [1]
    largest, relative_largest : float
        Error of largest magnitude [W], and relative error of largest magnitude [1].
    largest_line : int
        Line of the error of largest magnitude.
    chi_squared : float
        Sum of squared errors over uncertainties; NaN without uncertainties. [1]
    """

    state: str
    points: str
    group: str
    count: int
    bias: float
    rms: float
    relative_bias: float
    mean_percentage: float
    largest: float
    relative_largest: float
    largest_line: int
    chi_squared: float


def all_errors(
    table: Measurements, states: Mapping[str, FloatArray], held_out: BoolArray, group: str
) -> Iterator[ErrorFigures]:
    """Errors of every state and set of points, then of the groups within the set."""
    sets = {ALL: np.ones(len(table), dtype=bool)}
    if CALIBRATED in states:
        sets = {USED: ~held_out} | ({HELD_OUT: held_out} if held_out.any() else {})
    labels = np.array(table.labels[group])
    values = list(dict.fromkeys(table.labels[group]))
    for state, computed in states.items():
        for name, members in sets.items():
            yield _errors(table, computed, members, (state, name, ""))
            parts = {value: members & (labels == value) for value in values}
            parts = {value: part for value, part in parts.items() if part.any()}
            for value, part in parts.items() if len(parts) > 1 else ():
                yield _errors(table, computed, part, (state, name, f"{group} {value}"))


def _errors(
    table: Measurements, computed: FloatArray, members: BoolArray, names: tuple[str, str, str]
) -> ErrorFigures:
    kept = np.flatnonzero(members & np.isfinite(computed))
    error, measured = (computed - table.loss)[kept], table.loss[kept]
    if kept.size == 0:
        none = math.nan
        return ErrorFigures(*names, 0, none, none, none, none, none, none, 0, none)
    positive = measured > 0
    relative = error[positive] / measured[positive] if positive.any() else np.array([math.nan])
    worst = int(np.argmax(np.abs(error)))
    sigma = None if table.uncertainty is None else table.uncertainty[kept]
    return ErrorFigures(
        *names,
        count=kept.size,
        bias=float(error.mean()),
        rms=float(np.sqrt(np.mean(error**2))),
        relative_bias=float(relative.mean()),
        mean_percentage=float(np.abs(relative).mean()),
        largest=float(error[worst]),
        relative_largest=float(relative[np.argmax(np.abs(relative))]),
        largest_line=table.lines[kept[worst]],
        chi_squared=math.nan if sigma is None else float(np.sum((error / sigma) ** 2)),
    )
