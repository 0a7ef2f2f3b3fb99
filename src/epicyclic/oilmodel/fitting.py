"""Fits of all forms of a quantity, with errors at contacts that they had not seen."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact import CONDITIONS, LineContacts
from epicyclic.oilmodel.model import (
    FORMS,
    REGIMES,
    FitError,
    FittedForm,
    Form,
    QuantityFit,
    check_resistance,
)
from epicyclic.oilmodel.nearby import NearbySimulations
from epicyclic.oilmodel.regressions import Regression
from epicyclic.oilmodel.structured import Structured

FloatArray = NDArray[np.float64]

BEYOND = 3
"""Mean distances of the values of a condition by which its domain goes beyond them. [1]"""
FOLDS = 10
"""Parts of the contacts, each of which is predicted from the others."""
DIGITS = 12
"""Significant digits of coefficients and errors in a file: what is beyond them is rounding."""


def fit_quantity(
    quantity: str,  # A key of `FORMS`.
    unit: str,
    states: LineContacts,
    target: FloatArray,  # Simulated values above zero, and what each counts in the sum of squares.
    weight: FloatArray,  # Simulated values above zero, and what each counts in the sum of squares.
) -> QuantityFit:
    """Every form of a quantity. Theory (O8).

    Raises
    ------
    ValueError
        If no form can be fitted, with the reason.
    """
    fitted, left_out = [], {}
    domain = {name: _limits(getattr(states, name)) for name in CONDITIONS}
    for name, form in FORMS[quantity].items():
        try:
            coefficients = form.fit(states, target, weight)
            if isinstance(form, Regression):
                modulus = states.flanks.equivalent_modulus
                check_resistance(quantity, form, coefficients.tolist(), domain, modulus)
            alone, corrected = _cross_validated(form, states, target, weight)
            nearby = None
            if corrected.mean() < alone.mean():
                nearby = _nearby(form, coefficients, states, target, weight)
        except (ValueError, np.linalg.LinAlgError) as error:
            left_out[name] = str(error)
            continue
        fitted.append(
            FittedForm(
                form=name,
                coefficients=tuple(map(_rounded, coefficients)),
                errors=_errors_of(alone if nearby is None else corrected, states.film_ratio),
                nearby=nearby,
            )
        )
    if not fitted:
        raise ValueError("; ".join(f"{name}: {reason}" for name, reason in left_out.items()))
    return QuantityFit(
        unit=unit,
        contacts=target.size,
        domain=domain,
        forms=tuple(fitted),
        left_out=left_out,
    )


def _cross_validated(
    form: Form, states: LineContacts, target: FloatArray, weight: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """|computed/simulated - 1| at each contact, fitted without its part: the form, and corrected.

    Regressions are as they are published: nothing corrects them.
    """
    part = np.random.default_rng(0).permutation(target.size) % FOLDS
    alone, corrected = np.empty(target.size), np.empty(target.size)
    for number in range(FOLDS):
        unseen = part == number
        if not unseen.any():
            continue
        seen = (states.taken(~unseen), target[~unseen], weight[~unseen])
        coefficients = form.fit(*seen)
        there = states.taken(unseen)
        alone[unseen] = corrected[unseen] = form.value(there, coefficients)
        if isinstance(form, Structured):
            corrected[unseen] *= _nearby(form, coefficients, *seen).factor(there)
    return np.abs(alone / target - 1), np.abs(corrected / target - 1)


def _nearby(
    form: Form,
    coefficients: FloatArray,
    states: LineContacts,
    target: FloatArray,
    weight: FloatArray,
) -> NearbySimulations:
    excess = np.log(target / form.value(states, coefficients))
    return NearbySimulations.of(states, excess, weight)


def _errors_of(error: FloatArray, film_ratio: FloatArray) -> tuple[FitError, ...]:
    """Errors in every range of film ratios that has contacts."""
    found = []
    for name, (low, high) in REGIMES.items():
        here = error[(film_ratio > low) & (film_ratio <= high)]
        if here.size:
            found.append(
                FitError(
                    regime=name,
                    contacts=here.size,
                    median=_rounded(np.median(here)),
                    largest_of_90_percent=_rounded(np.quantile(here, 0.9)),
                )
            )
    return tuple(found)


def _limits(values: FloatArray) -> tuple[float, float]:
    """What the values span, and some of their distances more: a design fills its range."""
    low, high = float(values.min()), float(values.max())
    beyond = min(BEYOND * (high - low) / values.size, low / 2)
    return _rounded(low - beyond), _rounded(high + beyond)


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
