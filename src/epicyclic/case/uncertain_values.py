"""How well the values of a case are known: what it states itself, and what is assumed otherwise."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from functools import cache
from typing import Any, Literal

from pydantic_core import PydanticCustomError

from epicyclic import library
from epicyclic.case.base import CaseTable, owner_without_keys
from epicyclic.case.fields import field_at, known_keys, quantity_of, value_of
from epicyclic.case.messages import did_you_mean, dotted, path_of, refused, written
from epicyclic.case.parameters import Parameter, parameter_of
from epicyclic.case.read import value_at
from epicyclic.case.slopes import slope_limit
from epicyclic.case.tables.lubrication import FACTOR_KEY, SHARE_KEY
from epicyclic.case.tables.uncertainty import DistributionTable
from epicyclic.errors import Problem
from epicyclic.units import CELSIUS, MICROMETRE, Quantity, format_number

MODEL_FORM = "model_form."
"""What keys of [uncertainty] begin with that are no keys of the case, but kinds of losses."""
_MICROMETRE = 1e-6
Kind = Literal["normal", "uniform", "lognormal"]


@dataclass(frozen=True, slots=True)
class UncertainValue:
    """A key of the case, or a kind of losses, with the distribution of its value."""

    key: str  # Dotted key of the case, or ``"model_form.sliding"``.
    unit: str  # Unit of all values here; empty for pure numbers.
    value: float  # That of the case; 1 for the factor of a model.
    kind: Kind  # ``"normal"``, ``"uniform"`` or ``"lognormal"``.
    # Standard uncertainty; the two limits; or the factor of one standard deviation.
    spread: tuple[float, ...]
    low: float = -math.inf  # Beyond which the case has no values.
    high: float = math.inf  # Beyond which the case has no values.
    source: str = ""  # Where the distribution is from.
    # Coefficients of correlation with other keys.
    correlated: Mapping[str, float] = field(default_factory=dict[str, float], hash=False)

    @property
    def is_model_form(self) -> bool:
        """True for the factor of a model, which is no input."""
        return self.key.startswith(MODEL_FORM)

    @property
    def kind_of_loss(self) -> str:
        """Losses that the factor of a model multiplies, ``"sliding"``."""
        return self.key.removeprefix(MODEL_FORM)

    @property
    def text(self) -> str:
        """The distribution in words: ``"normal, 0.05 um"``."""
        unit = f" {self.unit}".rstrip()
        if self.kind == "normal":
            difference = " K" if self.unit == CELSIUS.display else unit
            return f"normal, {format_number(self.spread[0], 4)}{difference}"
        if self.kind == "lognormal":
            return f"lognormal, factor {format_number(self.spread[0], 4)}"
        low, high = (format_number(limit, 4) for limit in self.spread)
        return f"uniform, {low} to {high}{unit}"

    def stated(self, number: float) -> Any:
        """A value of the key as a case file has it."""
        return f"{number!r} {self.unit}" if self.unit else number


@dataclass(frozen=True, slots=True)
class Assumption:
    """A distribution that is assumed where a case states none."""

    keys: tuple[str, ...]  # Patterns of keys.
    table: DistributionTable
    source: str

    def holds_for(self, key: str) -> bool:
        """Whether a key is one of those."""
        return any(fnmatchcase(key, pattern) for pattern in self.keys)


_ABOUT = ("keys", "source", "name", "advice")


def remedy_for(key: str) -> tuple[str, str]:
    """What a value is called where it limits the trust in a result, and what to do then."""
    table = library.uncertainty_table()
    for entry in (*table["inputs"], *table["elsewhere"]):
        if any(fnmatchcase(key, pattern) for pattern in entry["keys"]):
            return entry["name"].format(key=key), entry["advice"].format(key=key)
    for entry in table["model_form"]:
        if key == f"{MODEL_FORM}{entry['kind']}":
            return entry["name"], entry["advice"]
    return key, "state it better in [uncertainty], once it is measured"


@cache
def _assumptions() -> tuple[Assumption, ...]:
    return tuple(
        Assumption(
            tuple(entry["keys"]),
            DistributionTable.model_validate(
                {key: value for key, value in entry.items() if key not in _ABOUT}
            ),
            entry["source"],
        )
        for entry in library.uncertainty_table()["inputs"]
    )


@cache
def _model_forms() -> dict[str, tuple[float, str]]:
    """Factor of one standard deviation of each kind of losses, and its source."""
    return {
        entry["kind"]: (entry["lognormal_factor"], entry["source"])
        for entry in library.uncertainty_table()["model_form"]
    }


def model_form_of(term: str, method: str = "") -> str:
    """The kind of losses that share the error of a model, of a loss: ``"sliding"``."""
    for entry in library.uncertainty_table()["model_form"]:
        known = any(fnmatchcase(term, pattern) for pattern in entry["terms"])
        if known and fnmatchcase(method, entry.get("method", "*")):
            return str(entry["kind"])
    return "other"


def uncertain_values(
    case: CaseTable,
    kinds: tuple[str, ...] = (),  # Kinds of losses that it has, see `model_form_of`.
) -> tuple[tuple[UncertainValue, ...], list[Problem]]:
    """All that is uncertain in a case, and what is wrong with its table [uncertainty]."""
    known = set(known_keys(case))
    found, problems = _stated(case)
    own = _own_tables(case)
    for key in sorted(known - own.keys()):
        found[key] = _assumed(case, key)
    for kind in kinds:
        key = f"{MODEL_FORM}{kind}"
        if key not in own and kind in _model_forms():
            factor, source = _model_forms()[kind]
            found[key] = UncertainValue(key, "", 1.0, "lognormal", (factor,), 0.0, source=source)
    values = tuple(
        value
        for key, value in found.items()
        if value is not None and (key.removeprefix(MODEL_FORM) in kinds or key in known)
    )
    return values, problems


def _own_tables(case: CaseTable) -> Mapping[str, DistributionTable]:
    return getattr(case, "uncertainty", {})


def _stated(case: CaseTable) -> tuple[dict[str, UncertainValue | None], list[Problem]]:
    """What a case states itself, None for what is exact, and what is wrong with that."""
    found: dict[str, UncertainValue | None] = {}
    problems: list[Problem] = []
    own = _own_tables(case)
    for key, table in own.items():
        result = _model_form(key, table) if key.startswith(MODEL_FORM) else _own(case, key, table)
        if isinstance(result, Problem):
            problems.append(result)
        else:
            found[key] = result
    return found, problems + list(_correlation_problems(own))


def _own(case: CaseTable, key: str, table: DistributionTable) -> UncertainValue | Problem | None:
    """What the case states of one of its keys; None if it is exact."""
    parameter = parameter_of(case, key)
    if isinstance(parameter, Problem):
        return replace(parameter, key=_name(key))
    if problem := owner_without_keys(case.given(), key):
        return replace(problem, key=_name(key), value=_given(table))
    if not _has_effect(case, key):
        allowed = "has no effect: another key decides the share of oil."
        remedy = f"State {FACTOR_KEY}, or lubrication.oil_share where it is given."
        return Problem(_name(key), _given(table), allowed, remedy)
    if table.exact:
        return None
    return _made(case, parameter, table, "given by the case")


def _assumed(case: CaseTable, key: str) -> UncertainValue | None:
    if not _has_effect(case, key):
        return None
    if key.endswith(FACTOR_KEY):
        return _assumed_factor(case, key)
    limit = slope_limit(case, key)
    if limit is not None:
        return _assumed_slope(case, key, limit)
    for assumption in _assumptions():
        if assumption.holds_for(key):
            parameter = parameter_of(case, key)
            if isinstance(parameter, Problem):
                return None
            made = _made(case, parameter, assumption.table, assumption.source)
            return made if isinstance(made, UncertainValue) else None
    return None


def _assumed_slope(case: CaseTable, key: str, limit: float) -> UncertainValue:
    """The slope of a flank, anywhere within its tolerance."""
    value = (value_of(case, key) or 0.0) / _MICROMETRE
    spread = limit / _MICROMETRE
    source = "tolerance of the accuracy class, ISO 1328-1:2013; all values within it alike"
    return UncertainValue(
        key, MICROMETRE.display, value, "uniform", (value - spread, value + spread), source=source
    )


def _assumed_factor(case: CaseTable, key: str) -> UncertainValue | None:
    """How well the share of oil is known that follows from a method."""
    method = library.lubrication_methods()[value_of(case, key.rpartition(".")[0]).method]
    factor, source = method["lognormal_factor"], method["source"]
    parameter = parameter_of(case, key)
    assert isinstance(parameter, Parameter)
    made = _made(case, parameter, DistributionTable(lognormal_factor=factor), source)
    return made if isinstance(made, UncertainValue) else None


def _has_effect(case: CaseTable, key: str) -> bool:
    """False for keys of the oil around gears that others decide, or that a set shares."""
    if key == SHARE_KEY:
        return case.lubrication is None
    owner, found, _ = key.rpartition("lubrication.")
    if not found or owner.endswith("thermal."):
        return True
    table = f"{owner}lubrication"
    stated = value_at(case.given(), path_of(table)) is not None
    known = key.endswith(FACTOR_KEY) and value_of(case, f"{table}.oil_share") is not None
    return stated and not known


def _made(
    case: CaseTable, parameter: Parameter, table: DistributionTable, source: str
) -> UncertainValue | Problem:
    field_ = field_at(case, parameter.key)
    quantity = None if field_ is None else quantity_of(*field_)
    try:
        kind, spread = _spread(table, parameter.start, quantity)
    except PydanticCustomError as error:
        return refused(error, _name(parameter.key), _given(table))
    problem = _impossible(parameter, kind, spread)
    if problem is not None:
        return replace(problem, value=_given(table))
    low, high = parameter.low, parameter.high
    return UncertainValue(
        parameter.key, parameter.unit, parameter.start, kind, spread, low, high, source,
        dict(table.correlated),
    )  # fmt: skip


def _spread(
    table: DistributionTable, value: float, quantity: Quantity | None
) -> tuple[Kind, tuple[float, ...]]:
    if table.normal is not None:
        return "normal", (_difference(table.normal, value, quantity),)
    if table.lognormal_factor is not None:
        return "lognormal", (table.lognormal_factor,)
    if table.tolerance is not None:
        low, high = (_difference(limit, value, quantity) for limit in table.tolerance)
        return "uniform", (value + low, value + high)
    assert table.uniform is not None
    one, other = (_absolute(limit, quantity) for limit in table.uniform)
    return "uniform", (one, other)


def _difference(stated: str | float, value: float, quantity: Quantity | None) -> float:
    """A deviation from a value, in the display unit."""
    if isinstance(stated, str) and stated.strip().endswith("%"):
        return _number(stated.strip().removesuffix("%")) / 100 * abs(value)
    if quantity is None:
        return _number(stated)
    scale, offset = quantity.scale_and_offset()
    unit = quantity.si if offset else quantity.display
    free = replace(quantity, noun=f"a deviation of {quantity.noun}", display=unit, low=None,
                   high=None)  # fmt: skip
    return free.parse(stated) * scale


def _absolute(stated: str | float, quantity: Quantity | None) -> float:
    return _number(stated) if quantity is None else quantity.to_display(quantity.parse(stated))


def _number(stated: str | float) -> float:
    try:
        return float(stated)
    except ValueError:
        raise PydanticCustomError(
            "number",
            "{what} is not a number; it must be a number, or a percentage of the value",
            {"what": written(stated), "remedy": 'for example "12 %"'},
        ) from None


def _impossible(parameter: Parameter, kind: Kind, spread: tuple[float, ...]) -> Problem | None:
    name, unit = _name(parameter.key), f" {parameter.unit}".rstrip()
    if kind == "normal" and spread[0] <= 0:
        return Problem(name, "", "must have a standard uncertainty above 0.", "Or exact = true.")
    if kind == "lognormal" and parameter.start <= 0:
        allowed = f"is for values above 0, not {parameter.start:g}{unit}."
        return Problem(name, "", allowed, "Take normal or uniform.")
    if kind != "uniform":
        return None
    low, high = spread
    if low >= high:
        return Problem(name, "", "must have the lower limit first.", "Exchange the limits.")
    if high <= parameter.low or low >= parameter.high:
        allowed = f"lies outside of what the key can hold, {parameter.low:g} to {parameter.high:g}."
        return Problem(name, "", allowed, "Correct the limits.")
    return None


def _model_form(key: str, table: DistributionTable) -> UncertainValue | Problem | None:
    kinds = _model_forms()
    kind = key.removeprefix(MODEL_FORM)
    if kind not in kinds:
        remedy = did_you_mean(kind, list(kinds)) or f"There are {', '.join(kinds)}."
        return Problem(_name(key), "", "is not a kind of loss.", remedy)
    if table.exact:
        return None
    if table.lognormal_factor is None:
        allowed = "needs lognormal_factor: the error of a model is a factor of its losses."
        return Problem(_name(key), _given(table), allowed, "Give it, or exact = true.")
    return UncertainValue(
        key, "", 1.0, "lognormal", (table.lognormal_factor,), 0.0, source="given by the case",
        correlated=dict(table.correlated),
    )  # fmt: skip


def _correlation_problems(own: Mapping[str, DistributionTable]) -> Iterator[Problem]:
    for key, table in own.items():
        for other, coefficient in table.correlated.items():
            name = f"{_name(key)}.correlated.{dotted([other])}"
            if other not in own or other == key:
                allowed = "is not another key of [uncertainty]."
                yield Problem(name, f"{coefficient:g}", allowed, "Name one that has a table there.")
            elif not -1 < coefficient < 1:
                allowed = "must be a number > -1 and < 1."
                yield Problem(name, f"{coefficient:g}", allowed, "Give such a coefficient.")


def _name(key: str) -> str:
    return f"uncertainty.{dotted([key])}"


def _given(table: DistributionTable) -> str:
    stated = table.model_dump(exclude_defaults=True)
    return ", ".join(f"{key} = {written(value)}" for key, value in stated.items())


def check_uncertainty(case: CaseTable) -> list[Problem]:
    """What is wrong with the table [uncertainty] of a case."""
    return _stated(case)[1]
