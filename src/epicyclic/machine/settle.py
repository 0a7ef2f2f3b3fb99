"""Temperatures and losses that agree with each other."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from epicyclic.elements.base import OIL, Loss
from epicyclic.elements.fluids import Fluids
from epicyclic.errors import ConvergenceError
from epicyclic.machine.machine import Machine, Operation
from epicyclic.machine.solve import Solution, solve_machine, start_of
from epicyclic.thermal.network import Link
from epicyclic.units import CELSIUS

FloatArray = NDArray[np.float64]

AGREEMENT = 3e-5
"""Change of a temperature from one pass to the next at which losses and heat agree. [K]"""
QUICK = 0.15
"""A step of the temperatures over the one before, up to which plain repetition is as quick. [1]"""
MOST_PASSES = 40
SCATTERING_FROM, SCATTER = 15, 0.02
"""Passes after which a larger change is agreement [K]: that of the losses of a flow through pockets
that does not repeat, which scatter."""
COLDEST, HOTTEST = 200.0, 770.0
"""Between which losses are computed; beyond them no gearbox is left to compute. [K]"""


@dataclass(frozen=True, slots=True)
class Answer:
    """What the heat of the losses leads to."""

    temperatures: Mapping[str, float]  # Temperatures of all nodes. [K]
    links: tuple[Link, ...] = ()  # Ways of the heat; empty where temperatures follow from formulas.
    flows: Mapping[str, float] | None = None  # Heat through every link. [W]
    # Temperatures of nodes that are given. [K]
    given: Mapping[str, float] = field(default_factory=dict[str, float])
    # Largest heat of a node that does not leave it, over all heat or the largest flow. [1]
    residual: float = 0.0


class ThermalModel(Protocol):
    """How temperatures follow from losses."""

    @property
    def start(self) -> Mapping[str, float]:
        """Temperatures of all nodes to start from. [K]"""

    def fluids(self, temperatures: Mapping[str, float]) -> Fluids:
        """Oil and mixture at the temperatures of the nodes that they meet."""

    def answer(self, temperatures: Mapping[str, float], solution: Solution) -> Answer:
        """Temperatures that the losses of a solution lead to."""


@dataclass(frozen=True, slots=True)
class Settled:
    """A machine whose temperatures and losses agree."""

    solution: Solution
    answer: Answer
    evaluations: int  # Evaluations of the losses.
    change: float = 0.0  # Largest change of a temperature in the last of them. [K]


def isothermal(solution: Solution) -> Settled:
    """A solution at temperatures that nothing was asked about."""
    return Settled(solution, Answer({}), 1)


def heat_of(solution: Solution) -> dict[str, float]:
    """Heat that the losses bring to each thermal node. [W]"""
    heat: dict[str, float] = {}
    for loss in _losses(solution):
        for node, share in loss.heat:
            heat[node] = heat.get(node, 0.0) + share * loss.watts
    return heat


def _losses(solution: Solution) -> list[Loss]:
    own = [loss for result in solution.results.values() for loss in result.losses.values()]
    return [*own, *solution.given.values()]


def settle(machine: Machine, operation: Operation, model: ThermalModel) -> Settled:
    """Temperatures and losses that agree. Theory (W27).

    Plain repetition of losses and temperatures as long as that is quick, as where nothing but the
    gears gets warm; else Broyden's method on the temperatures.

    Raises
    ------
    ConvergenceError
        If there is no equilibrium, or only one that no gearbox survives.
    """
    nodes = tuple(model.start)
    unheated = start_of(machine, operation)
    found: list[tuple[Solution, Answer]] = []
    steps: list[float] = []

    def change(values: FloatArray) -> FloatArray:
        at = dict(zip(nodes, map(float, np.clip(values, COLDEST, HOTTEST)), strict=True))
        with np.errstate(invalid="warn"):
            solution = solve_machine(machine, operation, model.fluids(at), unheated)
            answer = model.answer(at, solution)
        found.append((solution, answer))
        step: FloatArray = np.array([answer.temperatures[node] for node in nodes]) - values
        steps.append(float(np.abs(step).max()))
        return step

    def left(_: FloatArray) -> float:
        return steps[-1] / (AGREEMENT if len(steps) <= SCATTERING_FROM else SCATTER)

    at = np.array([model.start[node] for node in nodes])
    for _ in range(2):
        at = at + change(at)
    while AGREEMENT < steps[-1] <= QUICK * steps[-2]:
        at = at + change(at)
    if not steps[-1] <= AGREEMENT:
        _by_secants(change, at, left, found)
    solution, answer = found[-1]
    temperatures = answer.temperatures.values()
    if min(temperatures) < COLDEST or max(temperatures) > HOTTEST:
        raise _no_equilibrium(found)
    return Settled(solution, answer, len(found), steps[-1])


def _by_secants(
    change: Callable[[FloatArray], FloatArray],
    start: FloatArray,
    left: Callable[[FloatArray], float],
    found: list[tuple[Solution, Answer]],
) -> None:
    """Broyden's method from temperatures on."""
    from scipy.optimize import NoConvergence, broyden1  # takes a sixth of a second

    try:
        with np.errstate(invalid="ignore"):  # its first check divides infinity by infinity
            broyden1(
                change, start, alpha=1.0, f_tol=1.0, tol_norm=left, maxiter=MOST_PASSES,
                line_search=None,
            )  # fmt: skip
    except NoConvergence:
        raise _no_equilibrium(found) from None


def _no_equilibrium(found: list[tuple[Solution, Answer]]) -> ConvergenceError:
    """What to say of temperatures beyond all bounds, or that do not settle."""
    for _, answer in found:  # the first to leave the bounds tells on which side they are left
        coldest, hottest = (end(answer.temperatures.values()) for end in (min, max))
        if coldest < COLDEST:
            return _overcooled(answer.temperatures)
        if hottest > HOTTEST:
            break
    return _runaway(found[-1][1].temperatures, found)


def _overcooled(temperatures: Mapping[str, float]) -> ConvergenceError:
    coldest = min(temperatures, key=lambda node: temperatures[node])
    return ConvergenceError(
        f"more heat is taken away than arises: the {coldest.replace('_', ' ')} would be colder "
        f"than {CELSIUS.text(COLDEST, 4)}, down to which losses are computed. Give a smaller "
        "thermal.cooler_power, or thermal.cooler_conductance, which takes no more than there is."
    )


def _runaway(
    temperatures: Mapping[str, float], found: list[tuple[Solution, Answer]]
) -> ConvergenceError:
    hottest = max(temperatures, key=lambda node: temperatures[node])
    reached = f"{hottest.replace('_', ' ')} {CELSIUS.text(temperatures[hottest], 4)}"
    if OIL in temperatures and hottest != OIL:
        reached += f", oil {CELSIUS.text(temperatures[OIL], 4)}"
    return ConvergenceError(
        "the gearbox runs away: its heat would leave only beyond "
        f"{CELSIUS.text(HOTTEST, 4)}, up to which losses are computed. After {len(found)} passes "
        f"the temperatures are: {reached}. Take more heat away (thermal.oil_flow, "
        "thermal.cooler_conductance, a larger [thermal.housing]), or pass less power."
    )
