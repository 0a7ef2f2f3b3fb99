"""How hot a gearbox gets, and which cooling, flow or power leads to a temperature of its oil."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pydantic_core import PydanticCustomError

from epicyclic.build.machine import oil_medium
from epicyclic.case.case import Case
from epicyclic.dataclass import dataclass, field
from epicyclic.errors import ConvergenceError, InputError, one_problem
from epicyclic.machine.element import LOAD_DEPENDENT
from epicyclic.machine.heat import COLDEST, HOTTEST
from epicyclic.messages import refused, written
from epicyclic.result.result import HeatBalance, Result
from epicyclic.schema.fields import quantity_of
from epicyclic.study.load import CaseSource, as_case
from epicyclic.study.solve import solve
from epicyclic.units import (
    CELSIUS,
    NEWTON_METRE,
    Power,
    Quantity,
    Temperature,
    VolumeFlow,
    celsius_text,
)

NETWORK = {"models.temperatures": "network"}
TEMPERATURE = "oil temperature"  # What ranges of formulas call the temperature of a contact.
ROLES = {"friction": "sliding", "rolling": "rolling", "bearing": "mechanical"}
"""Models whose oil is held in their range, with the losses that they compute."""
CLOSE = 1e-5  # Difference to the wanted temperature that counts as none. [K]
STILL = 1e-3  # Change of a temperature below which more of a quantity has no effect. [K]
EXPECTED = 8  # Settled states that a search mostly takes. [1]
MOST_STEPS, STEP = 6, 4.0
"""In search of a temperature on the other side of the wanted one: how many, how far. [1]"""


def heat_balance(case: CaseSource) -> HeatBalance:
    """Temperatures of all parts of a gearbox, and the heat paths.

    Parameters
    ----------
    case : PlanetaryCase, GearPairCase or TrainCase
        The network of all parts is solved, whatever its ``models.temperatures`` is.

    Raises
    ------
    InputError
        If the case has no oil, or the heat has no path out.
    ConvergenceError
        If losses and heat flows do not balance: thermal runaway, or losses that jump.

    Examples
    --------
    >>> import epicyclic as ep
    >>> case = ep.load_case("talbot-2012-pair", {
    ...     "operation.torque": "100 N*m", "operation.speed": "2000 rpm",
    ...     "thermal.oil_flow": "2 l/min"})
    >>> heat = ep.heat_balance(case)
    >>> heat.temperatures["pinion"] > heat.oil > heat.given["oil_inlet"]
    True
    """
    found = solve(with_network(as_case(case))).heat
    assert found is not None
    return found


def with_network(case: Case) -> Case:
    """The case with the network of its parts. Raises `InputError` if it has no oil."""
    check_oil(case)
    return case.updated(NETWORK)


def check_oil(case: Case) -> None:
    """Raise `InputError` for a train whose losses are all given, and none of its oil."""
    if case.lubricant is None:
        allowed = "is missing; the heat needs it, and operation.oil_inlet_temperature."
        raise one_problem("lubricant", "", allowed, "Add both.", case.source)


def hottest(heat: HeatBalance) -> str:
    """The hottest part."""
    return max(heat.temperatures, key=lambda node: heat.temperatures[node])


def takes_minutes(result: Result) -> bool:
    """True if the contacts of a mesh are solved, so that another solution takes minutes."""
    return "ehl-direct" in result.models.values()


@dataclass(frozen=True, slots=True)
class BeyondRange:
    """Meshes with oil hotter than the range of their formulas, and held at its limit."""

    share: float  # Share of the load-dependent loss. [1]
    low: float  # The range. [degC]
    high: float  # The range. [degC]


def beyond_range(case: Case, result: Result) -> BeyondRange | None:
    """The part of the loss whose oil is too hot for its formula; None if none is. Theory (F5)."""
    hot = [
        flag
        for flag in result.flags
        if flag.quantity == TEMPERATURE
        and flag.use.role in ROLES
        and flag.high is not None
        and flag.found_high > flag.high
    ]
    loss_of = result.losses_of()
    watts = sum(flag.share * loss_of(flag.use) for flag in hot)
    if not watts or case.models.oil_beyond_range != "held":
        return None
    low, high = hot[0].low, hot[0].high
    assert low is not None
    assert high is not None
    loaded = sum(term.watts for term in result.terms if term.group == LOAD_DEPENDENT)
    return BeyondRange(watts / loaded, low, high)


@dataclass(frozen=True, slots=True)
class Found:
    """A value with which the oil has a wanted temperature.

    Attributes
    ----------
    key : str
        Key of the case.
    value : float
        In SI.
    unit : Quantity
        How it is shown.
    temperature : float
        Temperature of the oil, as wanted. [K]
    case : Case
        With the value.
    result : Result
        Result of that case.
    """

    key: str
    value: float
    unit: Quantity
    temperature: float
    case: Case
    result: Result

    def to_dict(self) -> dict[str, Any]:
        """What was found and for which temperature, in the units stated beside them."""
        return {
            "key": self.key,
            "value": self.unit.to_display(self.value),
            "unit": self.unit.display,
            "oil_temperature": {
                "value": CELSIUS.to_display(self.temperature),
                "unit": CELSIUS.display,
            },
        }


@dataclass(frozen=True, slots=True)
class _Search:
    """One quantity as a number from 0 upwards."""

    key: str
    unit: Quantity
    value: Callable[[float], float]  # The quantity of a number.
    scale: float  # The number where the temperature is guessed to be the wanted one.
    warms: bool  # True if larger numbers make the oil hotter.
    start: float | None = None  # Temperature of the oil at 0 where no case can have it. [K]
    # Keys that the quantity replaces.
    changes: Mapping[str, None] = field(default_factory=dict[str, None])


def solve_for(
    case: Case,
    quantity: str,  # A key of `QUANTITIES`.
    temperature: str | float,  # Of the oil: text with a unit, or in kelvin.
    *,
    progress: Callable[[int, int], object] | None = None,
) -> Found:
    """The cooling, flow or power with which the oil has a temperature, as `epicyclic.solve_for`."""
    if quantity not in QUANTITIES:
        allowed = f"must be one of {', '.join(QUANTITIES)}."
        raise one_problem("quantity", written(quantity), allowed, "Give one of them.")
    target = _temperature(temperature)
    check_oil(case)
    search = QUANTITIES[quantity](case, target)
    tried: dict[float, Found | None] = {}

    def excess(number: float) -> float:
        if not number and search.start is not None:
            return search.start - target
        if number not in tried:
            tried[number] = _attempt(case, search, number, target)
            if progress is not None:
                progress(len(tried), max(EXPECTED, len(tried) + 1))
        found = tried[number]
        if found is None:
            return (HOTTEST if search.warms or number < search.scale else COLDEST) - target
        over = _oil(found.result) - target
        return 0.0 if abs(over) <= CLOSE else over

    from scipy.optimize import brentq

    ends = _bracket(excess, search, target)
    number = brentq(excess, *ends, xtol=1e-12 * search.scale, rtol=1e-14)
    found = tried.get(number)
    if found is None or abs(_oil(found.result) - target) > 10 * CLOSE:
        raise ConvergenceError(
            f"no {search.key} gives an oil temperature of {celsius_text(target)}: the temperature "
            f"jumps near {search.unit.text(search.value(number))}."
        )
    return found


def _oil(result: Result) -> float:
    assert result.heat is not None
    return result.heat.oil


def _temperature(given: str | float) -> float:
    """A temperature given as text or in kelvin. [K]"""
    try:
        return _unit(Temperature).parse(f"{given} K" if isinstance(given, int | float) else given)
    except PydanticCustomError as error:
        raise InputError([refused(error, "oil temperature to reach", written(given))]) from None


def _attempt(base: Case, search: _Search, number: float, target: float) -> Found | None:
    """The result at a number; None if the gearbox runs away there."""
    value = search.value(number)
    case = base.updated({search.key: search.unit.exact_text(value), **NETWORK, **search.changes})
    try:
        return Found(search.key, value, search.unit, target, case, solve(case))
    except ConvergenceError:
        return None


def _bracket(
    excess: Callable[[float], float], search: _Search, target: float
) -> tuple[float, float]:
    """Numbers on both sides of the wanted temperature."""
    before, number = 0.0, search.scale
    over = excess(before)
    for _ in range(MOST_STEPS):
        next_over = excess(number)
        if over * next_over <= 0 and (over or search.start is None):  # oil is never at its inlet
            return before, number
        if abs(next_over) > abs(over) - STILL:
            break
        before, over, number = number, next_over, STEP * number
    ends = (
        f"{_limit(search, at)} it is at {celsius_text(excess(at) + target, 4)}"
        for at in (0.0, before or number)
    )
    wanted, allowed = f"oil at {celsius_text(target)}", f"cannot be reached: {', '.join(ends)}."
    remedy = "Choose another temperature, or change other heat paths in [thermal]."
    raise one_problem(wanted, "", allowed, remedy)


def _limit(search: _Search, number: float) -> str:
    if not number and search.start is not None:
        return f"with unlimited {search.key}"
    return f"with {search.key} = {search.unit.text(search.value(number), 4)}"


def _unit(kind: Any) -> Quantity:
    unit = quantity_of(kind)
    assert unit is not None
    return unit


def _losses(base: Case) -> float:
    """About what is lost. [W]"""
    return solve(base.updated({"models.temperatures": "inlet"})).total or 1.0


def _oil_flow(base: Case, target: float) -> _Search:
    """The number is one over the flow: the temperature is about proportional to it."""
    assert base.lubricant is not None
    inlet = base.operation.oil_inlet_temperature
    assert inlet is not None
    oil = oil_medium(base.lubricant.oil, target)
    rise = max(target - inlet, 1.0)
    return _Search(
        "thermal.oil_flow",
        _unit(VolumeFlow),
        lambda number: 1 / number,
        scale=oil.density * oil.heat_capacity * rise / _losses(base),
        warms=True,
        start=inlet,
        changes={"thermal.oil_outlet_temperature": None},
    )


def _input_power(base: Case, _: float) -> _Search:
    torque = base.operation.torque
    sign = -1.0 if torque < 0 else 1.0
    return _Search(
        "operation.torque", NEWTON_METRE, sign.__mul__, scale=abs(torque) or 100.0, warms=True
    )


QUANTITIES: Mapping[str, Callable[[Case, float], _Search]] = {
    "cooler_power": lambda base, _: _Search(
        "thermal.cooler_power", _unit(Power), float, _losses(base), warms=False
    ),
    "oil_flow": _oil_flow,
    "input_power": _input_power,
}
"""What `solve_for` finds."""
