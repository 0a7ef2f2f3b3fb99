"""Nodes that heat flows between, and the temperatures at which they settle.

A link takes heat from its hot node in proportion to the difference of two temperatures and brings
it to a third node, which mostly is the cold one. Oil that a jet throws on a gear is the exception:
it arrives with the temperature of the inlet, and leaves with its heat for the oil of the gearbox.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Link:
    """A way for heat."""

    key: str  # ``"sun-oil"``.
    hot: str  # Nodes whose temperatures drive the heat.
    cold: str  # Nodes whose temperatures drive the heat.
    conductance: float  # Heat over the difference of the two temperatures. [W/K]
    method: str = ""  # How the conductance is found, and where that is printed.
    source: str = ""  # How the conductance is found, and where that is printed.
    into: str = ""  # Node that the heat goes to; empty for `cold`.

    @property
    def target(self) -> str:
        """The node that the heat goes to."""
        return self.into or self.cold


@dataclass(frozen=True)
class Network:
    """Nodes of unknown temperature, nodes of given temperature, and links between them."""

    nodes: tuple[str, ...]  # Nodes of unknown temperature.
    given: Mapping[str, float]  # Nodes of given temperature. [K]
    links: tuple[Link, ...]

    def steady(
        self,
        heat: Mapping[str, float],  # That arises at each node. [W]
    ) -> dict[str, float]:
        """Temperatures at which the heat that arises leaves again. Theory (W26).

        Returns
        -------
        dict of str to float
            Of the nodes of unknown temperature. [K]

        Raises
        ------
        LinAlgError
            If the heat of a node has no way to a node of given temperature: see `cut_off`.
        """
        matrix, known = self.system()
        found = np.linalg.solve(matrix, known + self.sources(heat))
        found += np.linalg.solve(matrix, known + self.sources(heat) - matrix @ found)
        return dict(zip(self.nodes, map(float, found), strict=True))

    def system(self) -> tuple[FloatArray, FloatArray]:
        """Matrix A and vector b of C dT/dt = q + b - A T. Theory (W25)."""
        place = {node: index for index, node in enumerate(self.nodes)}
        matrix = np.zeros((len(self.nodes), len(self.nodes)))
        known = np.zeros(len(self.nodes))
        for link in self.links:
            for node, taken in ((link.hot, 1.0), (link.target, -1.0)):
                if node not in place:
                    continue
                row, conductance = place[node], taken * link.conductance
                for driver, sign in ((link.hot, 1.0), (link.cold, -1.0)):
                    if driver in place:
                        matrix[row, place[driver]] += sign * conductance
                    else:
                        known[row] -= sign * conductance * self.given[driver]
        return matrix, known

    def sources(self, heat: Mapping[str, float]) -> FloatArray:
        """Heat that arises at the nodes of unknown temperature, in their order. [W]"""
        return np.array([heat.get(node, 0.0) for node in self.nodes])

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
        matrix, known = self.system()
        found = np.array([temperatures[node] for node in self.nodes])
        left = self.sources(heat) + known - matrix @ found
        return dict(zip(self.nodes, map(float, left), strict=True))

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
