"""Temperatures of a result, and the ways of its heat."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from epicyclic.machine.element import OIL
from epicyclic.units import CELSIUS


@dataclass(frozen=True, slots=True)
class HeatWay:
    """Heat from one part to another.

    Attributes
    ----------
    key : str
        ``"sun-oil"``.
    hot, into : str
        Where it comes from and goes to.
    conductance : float
        NaN for a cooler of given power. [W/K]
    watts : float
        Negative if it flows the other way. [W]
    method, source : str
        How the conductance is found, and where that is printed.
    """

    key: str
    hot: str
    into: str
    conductance: float
    watts: float
    method: str
    source: str


@dataclass(frozen=True, slots=True)
class HeatBalance:
    """Temperatures that follow from the losses, and the ways of their heat.

    Attributes
    ----------
    model : str
        ``"flank"`` or ``"network"``.
    temperatures : mapping of str to float
        Temperatures of all nodes. [K]
    sources : mapping of str to float
        Heat that losses bring to each node. [W]
    ways : tuple of HeatWay
        Empty with ``"flank"``.
    given : mapping of str to float
        Temperatures that were given: of the oil inlet, the air, a coolant; of all oil with
        ``"flank"``. [K]
    residual : float
        Largest heat of a node that does not leave it, over all heat or the largest flow. [1]
    evaluations : int
        Evaluations of the losses, until temperatures and losses agreed.
    """

    model: str
    temperatures: Mapping[str, float]
    sources: Mapping[str, float]
    ways: tuple[HeatWay, ...]
    given: Mapping[str, float]
    residual: float
    evaluations: int

    @property
    def oil(self) -> float:
        """Temperature of the oil. [K]"""
        return {**self.given, **self.temperatures}[OIL]

    @property
    def brought(self) -> dict[str, float]:
        """Heat that losses bring to each node; what has no temperature of its own is oil. [W]"""
        heat = {node: self.sources.get(node, 0.0) for node in (*self.temperatures, OIL)}
        heat[OIL] = sum(self.sources.values()) - sum(heat[node] for node in heat if node != OIL)
        return heat

    @property
    def outlets(self) -> tuple[HeatWay, ...]:
        """The ways that lead out of the gearbox."""
        return tuple(way for way in self.ways if way.into not in self.temperatures)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and text, in the units stated beside them."""
        return {
            "model": self.model,
            "temperatures": {
                node: {"value": CELSIUS.to_display(value), "unit": CELSIUS.display}
                for node, value in self.temperatures.items()
            },
            "given": {
                node: {"value": CELSIUS.to_display(value), "unit": CELSIUS.display}
                for node, value in self.given.items()
            },
            "sources": dict(self.sources),
            "ways": {
                way.key: {
                    "from": way.hot,
                    "to": way.into,
                    "heat": way.watts,
                    "conductance": None if math.isnan(way.conductance) else way.conductance,
                    "method": way.method,
                    "source": way.source,
                }
                for way in self.ways
            },
            "residual": self.residual,
            "evaluations": self.evaluations,
        }
