"""What a comparison of measured with computed losses comes to: errors, notes, tables.

A fit never passes for a prediction: what it touched is named ``calibrated`` everywhere, and its
errors are given apart for the points it used and for those held out.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.builders.notes import NOT_INCLUDED
from epicyclic.case.case import Case
from epicyclic.case.operating import OPERATING
from epicyclic.losses.validity import OUT_OF_RANGE
from epicyclic.measurement.calibrated import calibrated_case, uncertainty_tables
from epicyclic.measurement.deviations import AS_GIVEN, CALIBRATED, ErrorFigures
from epicyclic.measurement.fit_result import Fit
from epicyclic.measurement.model import Computed
from epicyclic.measurement.table import Measurements
from epicyclic.results.result import versions
from epicyclic.sweeps.unloaded import LoadDependent

if TYPE_CHECKING:
    import pandas as pd

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredComparison:
    """Measured and computed losses of one case.

    Attributes
    ----------
    case : PlanetaryCase or GearPairCase
        As it was given.
    measured : Measurements
    computed : ndarray, shape (n,)
        With the case as given; NaN where a point failed. [W]
    calibrated : ndarray, shape (n,), or None
        With the fitted values. [W]
    held_out : ndarray of bool, shape (n,)
        Points that the fit did not see.
    load_dependent : {"computed", "as-tested"}
        What computed load-dependent losses are.
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

        own = {"loss", "uncertainty", "component"}
        labels = {
            name: list(text) for name, text in self.measured.labels.items() if name not in own
        }
        conditions = {
            f"{name} [{OPERATING[name].unit}]": values
            for name, values in self.measured.conditions.items()
        }
        columns: dict[str, Any] = {"line": self.measured.lines} | conditions
        columns |= {name: text for name, text in labels.items() if name not in OPERATING}
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
        clean: dict[str, Any] = _without_nan(content)
        return clean

    def to_json(self) -> str:
        """`to_dict` as indented JSON text."""
        return json.dumps(self.to_dict(), indent=2, allow_nan=False, ensure_ascii=False)


def notes_on(table: Measurements, computed: Computed) -> Iterator[str]:
    """What to know of a comparison: failed points, what is not included, ranges."""
    failed = [
        (line, text) for line, text in zip(table.lines, computed.messages, strict=True) if text
    ]
    if failed:
        line, reason = failed[0]
        yield f"{len(failed)} of {len(table)} points could not be computed; line {line}: {reason}"
    warned = {
        line: text.split(" | ")
        for line, text in zip(table.lines, computed.warnings, strict=True)
        if text
    }
    missing = (note for notes in warned.values() for note in notes if note.startswith(NOT_INCLUDED))
    yield from dict.fromkeys(missing)
    flagged = [line for line, notes in warned.items() if any(map(_is_flag, notes))]
    if flagged:
        yield (
            f"{len(flagged)} of {len(table)} points use a model outside its range, the first in "
            f"line {flagged[0]}; 'epicyclic run' at its conditions names the model."
        )
    if (table.loss < 0).any():
        yield "some measured losses are negative."


def _is_flag(note: str) -> bool:
    return note.startswith(OUT_OF_RANGE)


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


def _without_nan(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_nan(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_without_nan(item) for item in value]
    if isinstance(value, float):
        return None if not math.isfinite(value) else value
    return value
