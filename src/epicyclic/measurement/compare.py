"""Measured losses beside computed ones, with or without a fit of uncertain inputs.

A fit never passes for a prediction: what it touched is named ``calibrated`` everywhere, and its
errors are given apart for the points it used and for those held out.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.builders.notes import NOT_INCLUDED
from epicyclic.case.case import Case
from epicyclic.case.operating import OPERATING
from epicyclic.case.parameters import make_parameters
from epicyclic.errors import InputError, Problem
from epicyclic.losses.validity import OUT_OF_RANGE
from epicyclic.measurement.calibrated import calibrated_case, uncertainty_tables
from epicyclic.measurement.deviations import AS_GIVEN, CALIBRATED, ErrorFigures, all_errors
from epicyclic.measurement.files import read_frame, read_grid
from epicyclic.measurement.fit import Tell, fit_parameters
from epicyclic.measurement.fit_result import Fit
from epicyclic.measurement.identifiability import reaches
from epicyclic.measurement.model import Computed, MeasuredPoints
from epicyclic.measurement.table import (
    LOAD_DEPENDENT,
    Measurements,
    parse_measurements,
    parts_of,
)
from epicyclic.results.result import versions
from epicyclic.sweeps.runner import Progress, Runner
from epicyclic.sweeps.unloaded import AS_TESTED, COMPUTED, LoadDependent

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["MeasuredComparison", "compare_measured"]

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

_GROUPS = ("temperature", "state", "speed")
_OUTLET = "thermal.oil_outlet_temperature"
_EQUATION = re.compile(r"(?P<column>[^=]+)=(?P<value>.*)")


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


def compare_measured(
    case: Case,
    measured: str | Path | pd.DataFrame,
    *,
    component: str = "total",
    load_dependent: LoadDependent = COMPUTED,
    group: str | None = None,
    fit: Iterable[str] = (),
    hold_out: str | float | None = None,
    seed: int = 0,
    confidence: float = 0.95,
    jobs: int | None = None,
    dask: str | None = None,
    journal: str | Path | None = None,
    progress: Progress | None = None,
    tell: Tell = lambda text: None,
) -> MeasuredComparison:
    """Compare measured losses with those of a case, and fit uncertain inputs if asked to.

    Parameters
    ----------
    case : PlanetaryCase or GearPairCase
        Everything that the table does not state.
    measured : str, Path or pandas.DataFrame
        CSV, Excel or Parquet file, or a table: columns ``speed``, ``torque``, ``temperature`` and
        ``loss`` with units, ``"speed [rpm]"``; optionally ``uncertainty``, ``component``, of a
        train with states ``state``, any dotted key of the case, and labels. A train whose losses
        are all given needs no temperature.
    component : str, optional
        The loss that was measured, where no column says so: a term, terms joined by ``+``,
        ``"load_dependent"``, ``"load_independent"`` or ``"total"``.
    load_dependent : {"computed", "as-tested"}, optional
        What load-dependent losses are: the sum of those that depend on the load, or, as a test rig
        finds them, the total loss less that without torque at the same speed and oil inlet
        temperature, each at its own temperatures.
    group : str, optional
        Column by whose values the errors are given. Default: the temperature, else the state, else
        the speed.
    fit : iterable of str, optional
        Keys of the case to be fitted, from their values there and within the range of the schema.
    hold_out : str or float, optional
        Points that the fit must not see: ``"COLUMN=VALUE"``, or a share of all points, drawn with
        `seed`.
    seed : int, optional
    confidence : float, optional
        Confidence of the intervals of fitted values. [1]
    jobs, dask, progress
        As for `sweep`; the progress starts again with every round of a fit.
    journal : str or Path, optional
        Folder that keeps finished points, those of each round in a file.
    tell : callable, optional
        Called with a sentence on how the fit gets on, in every round.

    Returns
    -------
    MeasuredComparison

    Raises
    ------
    InputError
        With every mistake in the table, or if the fit cannot be made.
    ConvergenceError
        If the fit does not converge.
    """
    import pandas as pd

    runner = Runner(jobs, dask, journal=journal, progress=progress)
    grid = read_frame(measured) if isinstance(measured, pd.DataFrame) else read_grid(Path(measured))
    table = parse_measurements(grid, case, component)
    keys = tuple(dict.fromkeys(fit))
    group = group or next(name for name in _GROUPS if name in table.labels)
    varied = {key for change in table.changes for key in change}
    problems = [
        *_option_problems(table, keys, group, hold_out, confidence),
        *_tested_problems(case, table, load_dependent),
    ]
    if problems:
        raise InputError(problems, "the comparison")
    parameters = make_parameters(case, keys, varied)
    held_out = _held_out(table, hold_out, seed)
    # what is uncertain changes no loss, and takes time to be checked at every point
    plain = case.updated({"uncertainty": None}) if case.uncertainty else case
    points = MeasuredPoints(plain, table, runner, load_dependent)
    (given,) = points.compute({})
    _check_any(given)
    found = calibrated = None
    if parameters:
        used = np.isfinite(given.loss) & ~held_out
        reach = reaches(case, parameters)
        found = fit_parameters(points, parameters, used, confidence, reach, tell)
        (calibrated,) = points.compute(found.settings)
    states = {AS_GIVEN: given.loss}
    if calibrated is not None:
        states[CALIBRATED] = calibrated.loss
    return MeasuredComparison(
        case=case,
        measured=table,
        computed=given.loss,
        calibrated=None if calibrated is None else calibrated.loss,
        held_out=held_out,
        load_dependent=load_dependent,
        group=group,
        errors=tuple(all_errors(table, states, held_out, group)),
        fit=found,
        notes=tuple(_notes(table, given if calibrated is None else calibrated)),
    )


def _option_problems(
    table: Measurements,
    keys: tuple[str, ...],
    group: str,
    hold_out: str | float | None,
    confidence: float,
) -> Iterator[Problem]:
    known = ", ".join(table.labels)
    if group not in table.labels:
        yield Problem("group", group, "is not a column.", f"Columns are {known}.")
    if hold_out is not None and not keys:
        allowed = "keeps points from a fit, and there is none."
        yield Problem("hold_out", str(hold_out), allowed, "Name the keys to fit.")
    if not 0 < confidence < 1:
        yield Problem("confidence", f"{confidence:g}", "must be > 0 and < 1.", "Give 0.95.")


def _tested_problems(case: Case, table: Measurements, load_dependent: str) -> Iterator[Problem]:
    if load_dependent == COMPUTED:
        return
    key = "load_dependent"
    if load_dependent != AS_TESTED:
        allowed = f"is neither {COMPUTED} nor {AS_TESTED}."
        yield Problem(key, load_dependent, allowed, f"Give {AS_TESTED}.")
    if not any(LOAD_DEPENDENT in parts_of(component) for component in table.component):
        allowed = "is about load-dependent losses, and none was measured."
        yield Problem(key, load_dependent, allowed, f"Name the component {LOAD_DEPENDENT}.")
    outlets = [case.thermal.oil_outlet_temperature, *(row.get(_OUTLET) for row in table.changes)]
    if any(outlet is not None for outlet in outlets):
        allowed = "is not known without torque, where less oil would follow from the same."
        yield Problem(_OUTLET, "", allowed, "Give thermal.oil_flow in its place.")


def _held_out(table: Measurements, hold_out: str | float | None, seed: int) -> BoolArray:
    """Which points the fit must not see."""
    count = len(table)
    if hold_out is None:
        return np.zeros(count, dtype=bool)
    share = _share(hold_out)
    if share is not None:
        chosen = np.zeros(count, dtype=bool)
        drawn = np.random.default_rng(seed).permutation(count)[: round(share * count)]
        chosen[drawn] = True
        return chosen
    match = _EQUATION.fullmatch(str(hold_out))
    column = match["column"].strip() if match else ""
    if match is None or column not in table.labels:
        allowed = "must be COLUMN=VALUE, or a share between 0 and 1."
        remedy = f"Columns are {', '.join(table.labels)}."
        raise InputError([Problem("hold_out", str(hold_out), allowed, remedy)], "the comparison")
    wanted = match["value"].strip()
    chosen = np.array([_same(cell, wanted) for cell in table.labels[column]])
    if not chosen.any():
        values = ", ".join(dict.fromkeys(table.labels[column]))
        allowed = f"holds for no row; {column} has {values[:200]}."
        raise InputError(
            [Problem("hold_out", str(hold_out), allowed, "Name one of them.")], "the comparison"
        )
    return chosen


def _share(hold_out: str | float) -> float | None:
    try:
        share = float(hold_out)
    except ValueError:
        return None
    return share if 0 < share < 1 else None


def _same(cell: str, wanted: str) -> bool:
    """Equal as text or as numbers."""
    try:
        return cell == wanted or float(cell) == float(wanted)
    except ValueError:
        return False


def _check_any(given: Computed) -> None:
    if not np.isfinite(given.loss).any():
        reason = next(message for message in given.messages if message)
        problem = Problem("measurements", "", f"no point can be computed: {reason}", "")
        raise InputError([problem], "the comparison")


def _notes(table: Measurements, computed: Computed) -> Iterator[str]:
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
