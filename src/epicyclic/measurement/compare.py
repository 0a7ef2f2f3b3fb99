"""Measured losses beside computed ones, with or without a fit of uncertain inputs.

A fit never passes for a prediction: what it touched is named ``calibrated`` everywhere, and its
errors are given apart for the points it used and for those held out.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from epicyclic.case.case import Case
from epicyclic.case.parameters import make_parameters
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.measurement.comparison import MeasuredComparison
from epicyclic.measurement.files import read_frame, read_grid
from epicyclic.measurement.fit import Tell, fit_parameters
from epicyclic.measurement.identifiability import reaches
from epicyclic.measurement.question import ask, check_any
from epicyclic.measurement.table import Measurements
from epicyclic.sweeps.runner import Progress, Runner
from epicyclic.sweeps.unloaded import COMPUTED, LoadDependent

if TYPE_CHECKING:
    import pandas as pd

BoolArray = NDArray[np.bool_]

_EQUATION = re.compile(r"(?P<column>[^=]+)=(?P<value>.*)")


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
    question = ask(case, grid, component, load_dependent, group)
    table = question.table
    keys = tuple(dict.fromkeys(fit))
    varied = {key for change in table.changes for key in change}
    problems = [*question.problems(), *_fit_problems(keys, hold_out, confidence)]
    raise_any(problems, "the comparison")
    parameters = make_parameters(case, keys, varied)
    held_out = _held_out(table, hold_out, seed)
    points = question.points(runner)
    (given,) = points.compute({})
    check_any(given)
    if not parameters:
        return question.answer(given, held_out)
    used = np.isfinite(given.loss) & ~held_out
    reach = reaches(case, parameters)
    found = fit_parameters(points, parameters, used, confidence, reach, tell)
    (calibrated,) = points.compute(found.settings)
    return question.answer(given, held_out, calibrated, found)


def _fit_problems(
    keys: tuple[str, ...], hold_out: str | float | None, confidence: float
) -> Iterator[Problem]:
    if hold_out is not None and not keys:
        allowed = "keeps points from a fit, and there is none."
        yield Problem("hold_out", str(hold_out), allowed, "Name the keys to fit.")
    if not 0 < confidence < 1:
        yield Problem("confidence", f"{confidence:g}", "must be > 0 and < 1.", "Give 0.95.")


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
