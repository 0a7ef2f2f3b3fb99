"""Losses and ways of the heat of some operating points over temperature, to integrate over time.

The machine is solved with all of its parts equally hot, at a few temperatures. Over time each loss
is then read at the temperature of its own parts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from epicyclic.builders.build import build
from epicyclic.builders.temperatures import term_nodes
from epicyclic.case.case import Case
from epicyclic.elements.base import OIL, joined_key
from epicyclic.machine.heat_network import AMBIENT, NetworkModel
from epicyclic.machine.machine import Machine
from epicyclic.machine.solve import Solution, solve_machine
from epicyclic.pocketing.table import FlowTables
from epicyclic.thermal.network import Link
from epicyclic.thermal.transient import Curves, Source, Transient

Array = NDArray[np.float64]

SPACING = 10.0
"""Between the temperatures at which losses are solved: with 20 K a train ended 0.12 K from its
settled temperatures. [K]"""
WAYS = 4
"""Temperatures from one of these to the next at which conductances are computed: free convection
starts steeply, and they cost little."""


@dataclass(frozen=True, slots=True)
class HeatSample:
    """What one solution tells, with all parts equally hot."""

    heat: Mapping[Source, float]  # [W]
    # Ways of the heat by their keys, at temperatures from this one to the next.
    links: tuple[Mapping[str, Link], ...]
    given: Mapping[str, float]  # Temperatures that are given. [K]


def heat_samples(
    case: Case,  # Whose temperatures follow from a network.
    points: Sequence[Mapping[str, Any]],  # Keys of the case that each point changes.
    knots: Sequence[float],  # Temperatures. [K]
    flow_tables: FlowTables,  # Tables of flows through pockets.
    told: Callable[[], None],  # Called after each.
) -> list[list[HeatSample]]:
    """Samples of operating points at some temperatures.

    Returns
    -------
    list of list of HeatSample
        For each temperature one of every point.
    """
    machines = [build(case.updated(changes), flow_tables) for changes in points]
    samples: list[list[HeatSample]] = [[] for _ in knots]
    for row, knot in zip(samples, knots, strict=True):
        for built in machines:  # next to each other if they differ in torque only
            model = built.thermal
            assert isinstance(model, NetworkModel)
            even = dict.fromkeys(model.nodes, knot)
            solution = solve_machine(built.machine, built.operation, model.fluids(even))
            networks = [model.network(value, solution) for value in _between([knot])]
            links = tuple({link.key: link for link in one.links} for one in networks)
            heat = _heat(built.machine, solution, model.nodes)
            row.append(HeatSample(heat, links, networks[0].given))
            told()
    return samples


def _between(knots: Sequence[float]) -> Array:
    """Temperatures at which conductances are computed. [K]"""
    steps = SPACING / WAYS * np.arange(WAYS)
    return np.concatenate([knot + steps for knot in knots])


def _heat(machine: Machine, solution: Solution, nodes: Sequence[str]) -> dict[Source, float]:
    """Heat of every loss that is there, by what it heats."""
    own = [
        (key, name, loss)
        for key, result in solution.results.items()
        for name, loss in result.losses.items()
        if not loss.left_out
    ]
    given = [("", key, loss) for key, loss in solution.given.items()]
    at = term_nodes(machine)
    found: dict[Source, float] = {}
    for key, name, loss in (*given, *own):
        for node, share in loss.heat:
            into = node if node in nodes else OIL
            source = Source(joined_key(key, name), into, at.get((key, name), (OIL,)))
            found[source] = found.get(source, 0.0) + share * loss.watts
    return found


class HeatTables:
    """Curves over temperature of the heat and the ways of every operating point. Theory (W36).

    Parameters
    ----------
    model : NetworkModel
    knots : sequence of float
        Temperatures, rising. [K]
    samples : sequence of sequence of HeatSample
        For each temperature one of every point.
    """

    def __init__(
        self,
        model: NetworkModel,
        knots: Sequence[float],
        samples: Sequence[Sequence[HeatSample]],
    ) -> None:
        every = [sample for row in samples for sample in row]
        self.capacities = model.capacities()
        self.taken = {OIL: model.settings.cooler_power}
        self.given = {node: value for sample in every for node, value in sample.given.items()}
        self.knots = np.array(knots)
        self.sources = tuple(dict.fromkeys(source for sample in every for source in sample.heat))
        links = {key: it for sample in every for ways in sample.links for key, it in ways.items()}
        self.links = tuple(links.values())
        self.terms = tuple(dict.fromkeys(source.term for source in self.sources))
        heat = [[[one.heat.get(it, 0.0) for it in self.sources] for one in row] for row in samples]
        ways = [
            [[_conductance(one.links[step], key) for key in links] for one in row]
            for row in samples
            for step in range(WAYS)
        ]
        self._between = _between(knots)
        self._heat = _coefficients(self.knots, heat)
        self._ways = _coefficients(self._between, ways)
        self._heat_at = self._weights([source.at for source in self.sources])
        # what leaves the housing depends on its temperature, all other ways on the oil's
        own = [(link.hot,) if link.cold == AMBIENT else (OIL,) for link in self.links]
        self._ways_at = self._weights(own)

    def transient(
        self,
        heating: Array,  # With which the heat, and the conductances, of the points are added up.
        flowing: Array,  # With which the heat, and the conductances, of the points are added up.
    ) -> Transient:
        """The gearbox at a mixture of the points."""
        return Transient(
            self.capacities, self.given, self.sources, self.heat(heating), self.links,
            Curves(self._between, self._ways @ flowing, self._ways_at), self.taken,
        )  # fmt: skip

    def heat(self, heating: Array) -> Curves:
        """Curves of the heat of every source."""
        return Curves(self.knots, self._heat @ heating, self._heat_at)

    def losses(self, heat: Array) -> Array:
        """Every loss from the heat of every source. [W]"""
        place = {term: index for index, term in enumerate(self.terms)}
        into = [place[source.term] for source in self.sources]
        return np.array(np.bincount(into, heat, len(place)), float)

    def _weights(self, at: Sequence[Sequence[str]]) -> Array:
        place = {node: index for index, node in enumerate(self.capacities)}
        found = np.zeros((len(at), len(place)))
        for row, nodes in enumerate(at):
            for node in nodes:
                found[row, place[node]] += 1 / len(nodes)
        return found


def _conductance(links: Mapping[str, Link], key: str) -> float:
    return links[key].conductance if key in links else 0.0


def _coefficients(knots: Array, values: Sequence[Sequence[Sequence[float]]]) -> Array:
    """Monotone cubic curves over the first axis of `values`; the second one comes last."""
    found: Array = PchipInterpolator(knots, np.array(values)).c.swapaxes(2, 3)
    return found
