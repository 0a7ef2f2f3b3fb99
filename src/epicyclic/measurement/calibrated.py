"""A calibrated case: fitted values, and how well they are known, as its table [uncertainty]."""

from __future__ import annotations

import itertools
import math
from collections import defaultdict
from collections.abc import Collection, Iterator
from typing import Any

import numpy as np

from epicyclic.case.case import Case
from epicyclic.case.uncertain_values import MODEL_FORM, model_form_of
from epicyclic.measurement.fit_result import Fit, FittedParameter
from epicyclic.units import CELSIUS

SHRUNK = 1 - 1e-6
"""Factor of coefficients of correlation, so that rounding leaves their matrix possible. [1]"""
DIGITS = 8
"""Decimals of coefficients of correlation."""


def calibrated_case(case: Case, fit: Fit) -> Case:
    """The case with the fitted values and what the fit says about them.

    Where the factors of all losses of a kind were fitted, their model has no other error.
    """
    own = case.given().get("uncertainty", {})
    fitted = {item.key for item in fit.parameters}
    kept = {key: _without(table, fitted) for key, table in own.items() if key not in fitted}
    known = uncertainty_tables(fit)
    settled = {f"{MODEL_FORM}{kind}": {"exact": True} for kind in _settled(case, known.keys())}
    return case.updated({**fit.settings, "uncertainty": (settled | kept | known) or None})


def _settled(case: Case, keys: Collection[str]) -> Iterator[str]:
    """Kinds of losses whose factors are all among some keys."""
    factors: dict[str, set[str]] = defaultdict(set)
    losses = getattr(case, "losses", None)
    for term in type(losses).model_fields if losses is not None else ():
        if getattr(losses, term).include:
            factors[model_form_of(term)].add(f"losses.{term}.factor")
    return (kind for kind, wanted in factors.items() if wanted.issubset(keys))


def uncertainty_tables(fit: Fit) -> dict[str, dict[str, Any]]:
    """Entries of [uncertainty] for the fitted values that have an interval. Theory (X8).

    Normal, with their correlations; of a value at its bound the half that lies within.
    """
    known = [i for i, item in enumerate(fit.parameters) if math.isfinite(item.uncertainty)]
    tables = {fit.parameters[i].key: {"normal": _stated(fit.parameters[i])} for i in known}
    for i, j in itertools.combinations(known, 2):
        coefficient = round(SHRUNK * float(fit.correlation[i, j]), DIGITS)
        if np.isfinite(coefficient):
            entry = tables[fit.parameters[j].key].setdefault("correlated", {})
            entry[fit.parameters[i].key] = coefficient
    return tables


def _stated(item: FittedParameter) -> Any:
    """A standard uncertainty as a case file has it."""
    number = float(f"{item.uncertainty:.6g}")
    unit = "K" if item.unit == CELSIUS.display else item.unit
    return f"{number!r} {unit}" if unit else number


def _without(table: dict[str, Any], keys: Collection[str]) -> dict[str, Any]:
    """What a case states of another key, without correlations with `keys`."""
    left = {key: value for key, value in table.get("correlated", {}).items() if key not in keys}
    others = {key: value for key, value in table.items() if key != "correlated"}
    return others | ({"correlated": left} if left else {})
