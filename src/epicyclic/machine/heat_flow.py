"""Nodes between which heat flows: temperatures at which they settle, and how they get there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from epicyclic.arrays import FloatArray, apart, side_by_side
from epicyclic.dataclass import dataclass
from epicyclic.errors import ConvergenceError

# Nodes that heat flows between, and the temperatures at which they settle.
#
# A link takes heat from its hot node in proportion to the difference of two temperatures and brings
# it to a third node, which mostly is the cold one. Oil that a jet throws on a gear is the
# exception: it arrives with the temperature of the inlet, and leaves with its heat for the oil of
# the gearbox.


@dataclass(frozen=True, slots=True)
class Link:
    """A path of heat."""

    pointwise = True

    key: str  # ``"sun-oil"``.
    hot: str  # Node from which the heat comes where it is the warmer one.
    cold: str  # The other node whose temperature drives the heat.
    conductance: float  # Heat over the difference of the two temperatures. [W/K]
    method: str = ""  # How the conductance is found.
    source: str = ""  # Where that is printed.
    into: str = ""  # Node that the heat goes to; empty for `cold`.

    @property
    def target(self) -> str:
        """The node that the heat goes to."""
        return self.into or self.cold


@dataclass(frozen=True)
class Network:
    """Nodes of unknown temperature, nodes of given temperature, and links between them.

    Of one point, or of several: arrays have the points first.
    """

    nodes: tuple[str, ...]  # Nodes of unknown temperature.
    given: Mapping[str, float]  # Nodes of given temperature. [K]
    links: tuple[Link, ...]

    def steady(
        self,
        heat: Mapping[str, float],  # That arises at each node. [W]
    ) -> dict[str, float]:
        """Temperatures at which the heat that arises leaves again. Theory (W26).

        Of the nodes of unknown temperature. [K] Raises `LinAlgError` if the heat of a node has no
        way to a node of given temperature: see `cut_off`.
        """
        matrix, known = self.system
        brought = (known + self.sources(heat))[..., None]
        found: Any = np.linalg.solve(matrix, brought)
        found += np.linalg.solve(matrix, brought - matrix @ found)
        return dict(zip(self.nodes, apart(found[..., 0]), strict=True))

    @cached_property
    def system(self) -> tuple[FloatArray, FloatArray]:
        """Matrix A and vector b of C dT/dt = q + b - A T. Theory (W25)."""
        place = {node: index for index, node in enumerate(self.nodes)}
        conductances = side_by_side(link.conductance for link in self.links)
        given = dict(zip(self.given, side_by_side(self.given.values()).T, strict=True))
        matrix = np.zeros((*conductances.shape[:-1], len(self.nodes), len(self.nodes)))
        known = np.zeros(matrix.shape[:-1])
        for link, own in zip(self.links, conductances.T, strict=True):
            for node, taken in ((link.hot, 1.0), (link.target, -1.0)):
                if node not in place:
                    continue
                row, conductance = place[node], taken * own
                for driver, sign in ((link.hot, 1.0), (link.cold, -1.0)):
                    if driver in place:
                        matrix[..., row, place[driver]] += sign * conductance
                    else:
                        known[..., row] -= sign * conductance * given[driver]
        return matrix, known

    def sources(self, heat: Mapping[str, float]) -> FloatArray:
        """Heat that arises at the nodes of unknown temperature, in their order. [W]"""
        return side_by_side(heat.get(node, 0.0) for node in self.nodes)

    def flows(self, temperatures: Mapping[str, float]) -> dict[str, float]:
        """Heat through every link. [W]"""
        known = {**self.given, **temperatures}
        return {
            link.key: link.conductance * (known[link.hot] - known[link.cold]) for link in self.links
        }

    def residuals(
        self, temperatures: Mapping[str, float], heat: Mapping[str, float]
    ) -> dict[str, float]:
        """Heat that arises at each node less the heat that leaves it. [W]"""
        matrix, known = self.system
        found = side_by_side(temperatures[node] for node in self.nodes)
        left = self.sources(heat) + known - (matrix @ found[..., None])[..., 0]
        return dict(zip(self.nodes, apart(left), strict=True))

    def cut_off(self) -> tuple[str, ...]:
        """Nodes from which no heat reaches a node of given temperature."""
        reached = set(self.given)
        links = [link for link in self.links if link.conductance > 0]
        grows = True
        while grows:
            found = {
                link.hot for link in links if link.cold in reached or link.target in reached
            } | {link.cold for link in links if link.hot in reached and not link.into}
            grows = not found <= reached
            reached |= found
        return tuple(node for node in self.nodes if node not in reached)


# How temperatures get to where they settle: heat that arises, flows and is stored over time.
#
# Losses and conductances are curves over temperature. Each is read at the temperature of nodes of
# its own: the loss of a mesh at the mean of its two gears, drag at that of the oil.

TOLERANCE = 1e-6  # Largest error of the temperatures in each step of the integration. [K]
LEAST_RELATIVE = 1e-12  # No tolerance beside that. [1]


@dataclass(frozen=True, slots=True)
class Source:
    """A part of a loss that heats one node."""

    term: str  # The loss.
    into: str  # The node.
    at: tuple[str, ...]  # Nodes at whose mean temperature the loss arises.


@dataclass(frozen=True, slots=True)
class Curves:
    """Quantities over temperature; beyond the last knots they stay as they are there."""

    knots: FloatArray  # Rising. [K]
    # Coefficients of the powers of the distance from the knot below, the highest first.
    coefficients: FloatArray
    # With which the temperatures of the nodes make the one of each quantity. [1]
    weights: FloatArray

    def read(self, temperatures: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values, and their slopes over the temperature of each. Theory (W36)."""
        own = self.weights @ temperatures
        held = np.clip(own, self.knots[0], self.knots[-1])
        below = np.clip(np.searchsorted(self.knots, held) - 1, 0, self.knots.size - 2)
        step = held - self.knots[below]
        c3, c2, c1, c0 = self.coefficients[:, below, np.arange(own.size)]
        slopes = (3 * c3 * step + 2 * c2) * step + c1
        return ((c3 * step + c2) * step + c1) * step + c0, np.where(held == own, slopes, 0.0)


@dataclass(frozen=True, slots=True)
class Course:
    """Temperatures over time, and the energies that make them."""

    times: FloatArray  # [s]
    temperatures: FloatArray  # [K]
    gained: FloatArray  # Energy that arose. [J]
    given_off: FloatArray  # Energy that left for nodes of given temperature. [J]


class _PathMatrices(NamedTuple):
    """Where heat comes from and goes to, as matrices."""

    into: FloatArray  # From sources to nodes.
    drives: FloatArray  # From temperatures of nodes to differences along links, ...
    known: FloatArray  # ... and the part of given temperatures. [K]
    moves: FloatArray  # From flows to nodes.
    leaves: FloatArray  # From flows to all nodes of given temperature.
    taken: FloatArray  # From nodes by a cooler. [W]
    inertia: FloatArray  # [J/K]


@dataclass(frozen=True)
class Transient:
    """Nodes that store heat. Theory (W32)."""

    capacities: Mapping[str, float]  # Capacities of the nodes, in their order. [J/K]
    given: Mapping[str, float]  # Nodes of given temperature. [K]
    sources: Sequence[Source]
    heat: Curves  # Heat of each source. [W]
    links: Sequence[Link]  # Their own conductances do not matter.
    conductance: Curves  # Conductance of each link. [W/K]
    taken: Mapping[str, float]  # Heat that leaves nodes at all times: that of a cooler. [W]

    @cached_property
    def _paths(self) -> _PathMatrices:
        place = {node: index for index, node in enumerate(self.capacities)}
        nodes, links = len(place), len(self.links)
        paths = _PathMatrices(
            into=np.zeros((nodes, len(self.sources))),
            drives=np.zeros((links, nodes)),
            known=np.zeros(links),
            moves=np.zeros((nodes, links)),
            leaves=np.zeros(links),
            taken=np.array([self.taken.get(node, 0.0) for node in place]),
            inertia=np.array(list(self.capacities.values())),
        )
        for column, source in enumerate(self.sources):
            paths.into[place[source.into], column] = 1.0
        for row, link in enumerate(self.links):
            for node, sign in ((link.hot, 1.0), (link.cold, -1.0)):
                if node in place:
                    paths.drives[row, place[node]] += sign
                else:
                    paths.known[row] += sign * self.given[node]
            for node, sign in ((link.hot, -1.0), (link.target, 1.0)):
                if node in place:
                    paths.moves[place[node], row] += sign
                else:
                    paths.leaves[row] += sign
        return paths

    def rates(self, temperatures: FloatArray) -> tuple[FloatArray, float, float]:
        """Rise of the temperatures [K/s], heat that arises and heat that leaves [W]."""
        paths = self._paths
        heat, _ = self.heat.read(temperatures)
        conductance, _ = self.conductance.read(temperatures)
        flows = conductance * (paths.drives @ temperatures + paths.known)
        stored = paths.into @ heat - paths.taken + paths.moves @ flows
        left = float(paths.leaves @ flows + paths.taken.sum())
        return stored / paths.inertia, float(heat.sum()), left

    def slopes(self, temperatures: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """What `rates` gives, over each of the temperatures."""
        paths = self._paths
        _, slope = self.heat.read(temperatures)
        heat = slope[:, None] * self.heat.weights
        conductance, slope = self.conductance.read(temperatures)
        driven = paths.drives @ temperatures + paths.known
        flows = conductance[:, None] * paths.drives
        flows += (slope * driven)[:, None] * self.conductance.weights
        stored = paths.into @ heat + paths.moves @ flows
        return stored / paths.inertia[:, None], heat.sum(axis=0), paths.leaves @ flows

    def integrate(
        self,
        start: FloatArray,  # [K]
        times: FloatArray,  # Rising. [s]
        tolerance: float = TOLERANCE,  # Error of the temperatures in each step. [K]
    ) -> Course:
        """The course from temperatures `start` at the first of `times`. Theory (W32).

        Raises `ConvergenceError` if the integration does not reach the end.
        """
        from scipy.integrate import solve_ivp

        count = start.size

        def rates(_: float, values: FloatArray) -> FloatArray:
            rise, gained, left = self.rates(values[:count])
            return np.append(rise, [gained, left])

        def slopes(_: float, values: FloatArray) -> FloatArray:
            found = np.zeros((count + 2, count + 2))
            found[:count, :count], found[count, :count], found[-1, :count] = self.slopes(
                values[:count]
            )
            return found

        done = solve_ivp(
            rates,
            (times[0], times[-1]),
            np.append(start, [0.0, 0.0]),
            method="Radau",
            t_eval=times,
            jac=slopes,
            rtol=LEAST_RELATIVE,
            atol=np.append(np.full(count, tolerance), 2 * [tolerance * self._paths.inertia.sum()]),
        )
        if not done.success:
            raise ConvergenceError(
                f"the temperatures could not be integrated to the end: {done.message}"
            )
        return Course(done.t, done.y[:count], done.y[count], done.y[-1])

    def settled(self, guess: FloatArray) -> FloatArray | None:
        """Temperatures that stay as they are; None if there are none near the guess. [K]"""
        from scipy.optimize import root

        done = root(
            lambda values: self.rates(values)[0], guess, jac=lambda values: self.slopes(values)[0]
        )
        return done.x if done.success else None

    def time_constants(self, temperatures: FloatArray) -> FloatArray:
        """Time constants of small changes about some temperatures, slowest first. Theory (W38). [s]

        Infinite where they grow.
        """
        rise, _, _ = self.slopes(temperatures)
        rates = -np.linalg.eigvals(rise).real
        with np.errstate(divide="ignore"):
            return np.sort(np.where(rates > 0, 1 / rates, np.inf))[::-1]
