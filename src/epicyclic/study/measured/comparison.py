"""What a comparison of measured with computed losses comes to."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic_core import to_jsonable_python

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.build.result import NOT_INCLUDED
from epicyclic.case.case import Case
from epicyclic.case.tables.models import LoadDependent
from epicyclic.case.tables.uncertainty import MODEL_FORM, model_forms
from epicyclic.dataclass import asdict, dataclass
from epicyclic.errors import first_of
from epicyclic.losses.ranges import OUT_OF_RANGE
from epicyclic.result.result import versions
from epicyclic.study.bands.inputs import factors_of_kind
from epicyclic.study.measured.intervals import Fit, FittedParameter
from epicyclic.study.measured.residuals import Computed
from epicyclic.study.measured.table import STATED_BY, Measurements
from epicyclic.study.operating import OPERATING, shaft_power
from epicyclic.units import CELSIUS, format_number

if TYPE_CHECKING:
    import pandas as pd


SHRUNK = 1 - 1e-6
"""Factor of coefficients of correlation, so that rounding leaves their matrix possible. [1]"""
ABOVE = 1.01  # Loss over the power at the input: what a loss equal to it may scatter. [1]
DIGITS = 8  # Decimals of coefficients of correlation.


def calibrated_case(case: Case, fit: Fit) -> Case:
    """The case with the fitted values and what the fit says about them.

    Where the factors of all losses of a kind were fitted, their model has no other error.
    """
    own = case.given().get("uncertainty", {})
    fitted = {item.key for item in fit.parameters}
    kept = {key: _without(table, fitted) for key, table in own.items() if key not in fitted}
    known = uncertainty_tables(fit)
    factors = {kind: factors_of_kind(case, kind).keys() for kind in model_forms()}
    settled = {
        f"{MODEL_FORM}{kind}": {"exact": True}
        for kind, keys in factors.items()
        if keys and known.keys() >= keys
    }
    return case.updated({**fit.settings, "uncertainty": (settled | kept | known) or None})


def uncertainty_tables(fit: Fit) -> dict[str, dict[str, Any]]:
    """Entries of [uncertainty] for the fitted values that have an interval. Theory (X8).

    Normal, with their correlations; of a value at its bound the half that lies within.
    """
    known = [i for i, item in enumerate(fit.parameters) if math.isfinite(item.uncertainty)]
    tables = {fit.parameters[i].key: _distribution(fit.parameters[i]) for i in known}
    for i, j in itertools.combinations(known, 2):
        coefficient = round(SHRUNK * float(fit.correlation[i, j]), DIGITS)
        if np.isfinite(coefficient):
            entry = tables[fit.parameters[j].key].setdefault("correlated", {})
            entry[fit.parameters[i].key] = coefficient
    return tables


def _distribution(item: FittedParameter) -> dict[str, Any]:
    """What [uncertainty] says of a value; that of a model is a factor on its losses."""
    if item.key.startswith(MODEL_FORM):
        return {"lognormal_factor": float(f"{math.exp(item.uncertainty / item.value):.6g}")}
    number = float(f"{item.uncertainty:.6g}")
    unit = "K" if item.unit == CELSIUS.display else item.unit
    return {"normal": f"{number!r} {unit}" if unit else number}


def _without(table: dict[str, Any], keys: Collection[str]) -> dict[str, Any]:
    """What a case states of another key, without correlations with `keys`."""
    left = {key: value for key, value in table.get("correlated", {}).items() if key not in keys}
    others = {key: value for key, value in table.items() if key != "correlated"}
    return others | ({"correlated": left} if left else {})


AS_GIVEN, CALIBRATED = "as given", "CALIBRATED"  # State of the case behind computed losses.
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
    near = near_values(table.labels[group])
    labels, values = np.array(near), list(dict.fromkeys(near))
    for state, computed in states.items():
        for name, members in sets.items():
            yield _errors(table, computed, members, (state, name, ""))
            parts = {value: members & (labels == value) for value in values}
            parts = {value: part for value, part in parts.items() if part.any()}
            for value, part in parts.items() if len(parts) > 1 else ():
                yield _errors(table, computed, part, (state, name, f"{group} {value}"))


NEAR, NEAR_OF_ALL = 0.02, 0.01
"""Values that a rig meant to be the same differ by less than this, over themselves, or over the
range of all. [1]"""


def near_values(cells: Sequence[str]) -> tuple[str, ...]:
    """Labels as they are; of real numbers that hardly repeat, means of those near each other."""
    distinct = sorted(set(cells))
    try:
        numbers = np.sort([float(cell) for cell in distinct])
    except ValueError:
        return tuple(cells)
    if 2 * len(distinct) <= len(cells) or not np.isfinite(numbers).all():
        return tuple(cells)
    groups = [[numbers[0]]]
    for number in numbers[1:]:
        first = groups[-1][0]
        if number - first <= max(NEAR * abs(first), NEAR_OF_ALL * (numbers[-1] - numbers[0])):
            groups[-1].append(number)
        else:
            groups.append([number])
    means = {
        number: format_number(float(np.mean(group)), 4 if len(group) > 1 else 6)
        for group in groups
        for number in group
    }
    return tuple(means[float(cell)] for cell in cells)


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


# A fit never passes for a prediction: what it touched is named ``calibrated`` everywhere, and its
# errors are given apart for the points it used and for those held out.


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredComparison:
    """Measured and computed losses of one case.

    Attributes
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
        As it was given.
    measured : Measurements
    computed : ndarray, shape (n,)
        With the case as given; NaN where a point failed. [W]
    calibrated : ndarray, shape (n,), or None
        With the fitted values. [W]
    held_out : ndarray of bool, shape (n,)
        Points excluded from the fit.
    load_dependent : {"computed", "as-tested"}
        Definition of the computed load-dependent losses.
    group : str
        Column by whose values the errors are given.
    errors : tuple of ErrorFigures
    fit : Fit or None
    notes : tuple of str
        What to know: failed points, models outside their ranges.
    """

    case: Case
    measured: Measurements
    computed: FloatArray
    calibrated: FloatArray | None
    held_out: BoolArray
    load_dependent: LoadDependent
    group: str
    errors: tuple[ErrorFigures, ...]
    fit: Fit | None
    notes: tuple[str, ...]

    @property
    def states(self) -> dict[str, FloatArray]:
        """Computed losses by the state of the case. [W]"""
        given = {AS_GIVEN: self.computed}
        return given if self.calibrated is None else given | {CALIBRATED: self.calibrated}

    @property
    def calibrated_case(self) -> Case | None:
        """The case with the fitted values and their uncertainties; None without a fit."""
        return None if self.fit is None else calibrated_case(self.case, self.fit)

    def table(self) -> pd.DataFrame:
        """One row for each measurement, units in the column names."""
        import pandas as pd

        own = {*OPERATING, "loss", "uncertainty", "component"}
        conditions = {
            f"{name} [{OPERATING[name].unit}]": values
            for name, values in self.measured.conditions.items()
        }
        columns: dict[str, Any] = {"line": self.measured.lines} | conditions
        columns |= {
            name: list(text) for name, text in self.measured.labels.items() if name not in own
        }
        columns |= {"component": self.measured.component, "measured [W]": self.measured.loss}
        if self.measured.uncertainty is not None:
            columns["uncertainty [W]"] = self.measured.uncertainty
        for state, computed in self.states.items():
            name = "computed" if state == AS_GIVEN else state
            columns |= {f"{name} [W]": computed, f"{name} less measured [W]": self.residuals(state)}
            if self.measured.uncertainty is not None:
                columns[f"{name} less measured, over uncertainty"] = self.normalised(state)
        if self.calibrated is not None:
            columns["held out"] = self.held_out
        return pd.DataFrame(columns)

    def residuals(self, state: str) -> FloatArray:
        """Computed less measured losses of one of the `states`, shape (n,). [W]"""
        return self.states[state] - self.measured.loss

    def normalised(self, state: str) -> FloatArray:
        """The same over the uncertainty of the measurement; NaN without uncertainties. [1]"""
        sigma = self.measured.uncertainty
        return self.residuals(state) / (math.nan if sigma is None else sigma)

    def to_dict(self) -> dict[str, Any]:
        """Everything as plain numbers and text; None stands for NaN."""
        content = {
            "title": self.case.title,
            "measurements": self.measured.source,
            "load_dependent": self.load_dependent,
            "points": self.table().to_dict(orient="records"),
            "errors": [asdict(row) for row in self.errors],
            "error_units": {"bias": "W", "rms": "W", "largest": "W", "others": "1"},
            "fit": None if self.fit is None else _fit_dict(self.fit),
            "notes": list(self.notes),
            "case": self.case.inputs(),
            "versions": versions(),
        }
        clean: dict[str, Any] = to_jsonable_python(content, inf_nan_mode="null")
        return clean

    def to_json(self) -> str:
        """`to_dict` as indented JSON text."""
        return json.dumps(self.to_dict(), indent=2, allow_nan=False, ensure_ascii=False)


def notes_on(table: Measurements, computed: Computed) -> Iterator[str]:
    """What to know of a comparison: columns, failed points, what is not included, ranges."""
    read, *others = (name for name in STATED_BY if name in table.labels)
    if others:
        yield f"the losses are those of the column {read}; not used: {', '.join(others)}."
    failed = [
        (line, text) for line, text in zip(table.lines, computed.messages, strict=True) if text
    ]
    if failed:
        line, reason = failed[0]
        yield f"{len(failed)} of {len(table)} points could not be computed; line {line}: {reason}"
    warned = [text.split(" | ") for text in computed.warnings]
    yield from dict.fromkeys(it for its in warned for it in its if it.startswith(NOT_INCLUDED))
    outside = (any(it.startswith(OUT_OF_RANGE) for it in its) for its in warned)
    if flagged := [*itertools.compress(table.lines, outside)]:
        yield (
            f"{len(flagged)} of {len(table)} points use a model outside its range, the first in "
            f"line {flagged[0]}; 'epicyclic run' at its conditions names the model."
        )
    power = np.abs(shaft_power(table.conditions["torque"], table.conditions["speed"]))
    for wrong, what, remedy in (
        (table.loss < 0, "are negative", "they scatter about zero, correct their sign or the zeros "
         "of the torques"),
        ((table.loss > ABOVE * power) & (power > 0), "exceed the power at the input", "the output "
         "is driven too, correct their unit"),
    ):  # fmt: skip
        rows = np.flatnonzero(wrong)
        shown = [f"{table.loss[row]:.6g} W in line {table.lines[row]}" for row in rows]
        if shown:
            yield f"measured losses {what}: {first_of(shown)}. Unless {remedy}."


def _fit_dict(fit: Fit) -> dict[str, Any]:
    return {
        "state": CALIBRATED,
        "parameters": [asdict(item) for item in fit.parameters],
        "confidence": fit.confidence,
        "correlation": fit.correlation.tolist(),
        "points": fit.points,
        "degrees_of_freedom": fit.degrees_of_freedom,
        "chi_squared": fit.chi_squared,
        "widening": fit.widening,
        "discrepancy": fit.discrepancy,
        "combinations": [asdict(one) for one in fit.combinations],
        "uncertainty": uncertainty_tables(fit),
        "evaluations": fit.evaluations,
        "warnings": list(fit.warnings),
    }
