"""What a calibration found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from epicyclic.measurement.identifiability import Combination

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class FittedParameter:
    """A calibrated value of a key, with its confidence interval.

    Attributes
    ----------
    key, unit : str
    start, value : float
        In the case, and calibrated; in `unit`.
    standard_error, low, high : float
        Standard error of the linearised model, and the confidence interval, in `unit`; NaN if they
        do not exist.
    at_bound : bool
        True if it ended at a bound of the schema.
    profiled : bool
        True if the interval follows from the profile of the likelihood.
    uncertainty : float
        Standard uncertainty of a normal distribution, cut off at the bounds, that has the interval;
        NaN if there is none. In `unit`.
    """

    key: str
    unit: str
    start: float
    value: float
    standard_error: float
    low: float
    high: float
    at_bound: bool
    profiled: bool
    uncertainty: float


@dataclass(frozen=True, slots=True, eq=False)
class Fit:
    """What a calibration found.

    Attributes
    ----------
    parameters : tuple of FittedParameter
    settings : mapping of str to object
        The calibrated values as a case file has them.
    confidence : float
        Confidence of the intervals. [1]
    correlation : ndarray, shape (p, p)
        Correlation of the parameters; NaN where it does not exist.
    points, degrees_of_freedom : int
        Points used, and these less the parameters.
    chi_squared : float
        Sum of squared deviations over uncertainties; NaN without uncertainties. [1]
    widening : float
        Factor by which the intervals are wider than the uncertainties alone make them. [1]
    discrepancy : float
        Standard deviation of the error of the model at these points, beyond the uncertainties of
        the measurements, or with these where none are stated; root mean square. [W]
    combinations : tuple of Combination
        What the points know least about, first; as found before the fit.
    evaluations : int
        Computed points.
    warnings : tuple of str
        What to know before using the values.
    """

    parameters: tuple[FittedParameter, ...]
    settings: Mapping[str, Any]
    confidence: float
    correlation: FloatArray
    points: int
    degrees_of_freedom: int
    chi_squared: float
    widening: float
    discrepancy: float
    combinations: tuple[Combination, ...]
    evaluations: int
    warnings: tuple[str, ...]
