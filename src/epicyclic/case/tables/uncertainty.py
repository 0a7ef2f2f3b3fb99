"""The table [uncertainty]: how uncertain values are, and its checks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic_core import PydanticCustomError

from epicyclic import library
from epicyclic.case.keys import Parameter, field_at, owner_without_keys, parameter_of, value_of
from epicyclic.case.tables.models import OF_ROUGH_FLANKS, has_rough_flanks
from epicyclic.case.tables.operation import FACTOR_KEY, SHARE_KEY
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.errors import Problem
from epicyclic.messages import did_you_mean, dotted, path_of, refused, value_at, written
from epicyclic.schema.fields import Table, option, quantity_of
from epicyclic.units import CELSIUS, Number, Quantity, format_number, unit_text

if TYPE_CHECKING:
    from epicyclic.case.case import CaseTable


Stated = str | Number
"""A value of the key as a case file has it, or a percentage of it; its unit is that of the key."""


class DistributionTable(Table):
    """Uncertainty of one value: by one of the keys down to `exact`."""

    EXACTLY_ONE: ClassVar[tuple[tuple[str, ...], ...]] = (
        ("normal", "uniform", "tolerance", "lognormal_factor", "exact"),
    )

    normal: Stated | None = option('Standard uncertainty about the value, "0.05 um" or "12 %".')
    uniform: tuple[Stated, Stated] | None = option("Limits between equally likely values.")
    tolerance: tuple[Stated, Stated] | None = option(
        "Limits as deviations from the value, between which all values are equally likely."
    )
    lognormal_factor: Number | None = option(
        "Two thirds of all values lie between value / factor and value * factor.", gt=1
    )
    exact: bool | None = option("true: the value is exact, against the default.")
    correlated: dict[str, Number] = option(
        "Coefficients of correlation with other keys of this table, -1 to 1.", {}
    )

    def __hash__(self) -> int:  # a table of names cannot be hashed
        return hash((self.normal, self.uniform, self.tolerance, self.lognormal_factor))


UNCERTAINTY: Any = option(
    "Uncertainty of values, by their keys, and of models, by model_form.KIND.", {}
)
"""The field of a case."""

MODEL_FORM = "model_form."
"""What keys of [uncertainty] begin with that are no keys of the case, but kinds of losses."""

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
    def remark(self) -> str:
        """Limits that leave out the value of the case: a slip, but for tolerances off zero."""
        if self.kind != "uniform" or self.spread[0] <= self.value <= self.spread[1]:
            return ""
        limits, unit = self.text.partition(" ")[2], f" {unit_text(self.unit)}".rstrip()
        return f"the limits {limits} leave out the value of the case, {self.value:g}{unit}"

    @property
    def text(self) -> str:
        """The distribution in words: ``"normal, 0.05 µm"``."""
        unit = f" {unit_text(self.unit)}".rstrip()
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


@cache
def model_forms() -> dict[str, tuple[float, str]]:
    """Factor of one standard deviation of each kind of losses, and its source."""
    return {
        entry["kind"]: (entry["lognormal_factor"], entry["source"])
        for entry in library.uncertainty_table()["model_form"]
    }


def stated_values(case: CaseTable) -> tuple[dict[str, UncertainValue | None], list[Problem]]:
    """What a case states itself, None for what is exact, and what is wrong with that."""
    found: dict[str, UncertainValue | None] = {}
    problems: list[Problem] = []
    own = getattr(case, "uncertainty", {})
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
        # only mixed lubrication takes it from the oil: it stays while other models are tried
        of_oil = key.endswith("models.boundary_friction") and field_at(case, key) is not None
        return None if of_oil else replace(parameter, key=_name(key))
    if problem := owner_without_keys(case.given(), key):
        return replace(problem, key=_name(key), value=_given(table))
    if not has_effect(case, key):
        if key.rpartition(".")[2] in OF_ROUGH_FLANKS:
            return None  # stays while other models are tried
        allowed = "has no effect, because another key sets the share of oil."
        remedy = f"State {FACTOR_KEY}, or lubrication.oil_share where it is given."
        return Problem(_name(key), _given(table), allowed, remedy)
    return None if table.exact else made_value(case, parameter, table, "given by the case")


def has_effect(case: CaseTable, key: str) -> bool:
    """False for keys of models that are not used, and of oil that others decide or a set shares."""
    table, _, name = key.rpartition(".")
    if name in OF_ROUGH_FLANKS:
        models = value_of(case, table)
        run_in = name != "running_in_factor" or models.running_in == "run-in"
        return run_in and has_rough_flanks(models)
    if key == SHARE_KEY:
        return case.lubrication is None
    owner, found, _ = key.rpartition("lubrication.")
    if not found or owner.endswith("thermal."):
        return True
    table = f"{owner}lubrication"
    stated = value_at(case.given(), path_of(table)) is not None
    known = key.endswith(FACTOR_KEY) and value_of(case, f"{table}.oil_share") is not None
    return stated and not known


def made_value(
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
    if (limits := table.uniform) is None:
        raise PydanticCustomError("exact", "must be true, or left out", {"remedy": "Delete it"})
    if quantity is None:
        return "uniform", (_number(limits[0]), _number(limits[1]))
    return "uniform", tuple(quantity.to_display(quantity.parse(limit)) for limit in limits)


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


def _number(stated: str | float) -> float:
    with suppress(ValueError):
        if math.isfinite(number := float(stated)):
            return number
    raise PydanticCustomError(
        "number",
        "{what} is not a number; it must be a number, or a percentage of the value",
        {"what": written(stated), "remedy": 'for example "12 %"'},
    )


def _impossible(parameter: Parameter, kind: Kind, spread: tuple[float, ...]) -> Problem | None:
    name, unit = _name(parameter.key), f" {parameter.unit}".rstrip()
    if kind == "normal" and spread[0] <= 0:
        remedy = "Give a larger one, or exact = true."
        return Problem(name, "", "must have a standard uncertainty above 0.", remedy)
    if kind == "lognormal" and parameter.start <= 0:
        allowed = f"applies to values above 0, not {parameter.start:g}{unit}."
        return Problem(name, "", allowed, "Use normal or uniform.")
    if kind != "uniform":
        return None
    low, high = spread
    if low >= high:
        return Problem(name, "", "must give the lower limit, then a higher one.", "Correct them.")
    if high <= parameter.low or low >= parameter.high:
        allowed = f"lies outside the range of this key, {parameter.low:g} to {parameter.high:g}."
        return Problem(name, "", allowed, "Correct the limits.")
    return None


def _model_form(key: str, table: DistributionTable) -> UncertainValue | Problem | None:
    kinds = model_forms()
    kind = key.removeprefix(MODEL_FORM)
    if kind not in kinds:
        remedy = did_you_mean(kind, list(kinds)) or f"There are {', '.join(kinds)}."
        return Problem(_name(key), "", "is not a kind of loss.", remedy)
    if table.exact:
        return None
    if table.lognormal_factor is None:
        allowed = "needs lognormal_factor, because the error of a model is a factor on its losses."
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
                yield Problem(name, f"{coefficient:g}", allowed, "Correct it.")


def _name(key: str) -> str:
    return f"uncertainty.{dotted([key])}"


def _given(table: DistributionTable) -> str:
    stated = table.model_dump(exclude_defaults=True)
    return ", ".join(f"{key} = {written(value)}" for key, value in stated.items())
