"""Flows through the pockets of a mesh that differ in one number only.

Viscosity takes no part in the flow. For given pockets, share of oil and resolution its equations
hold speed, density and ambient pressure in one number, so that one curve over it serves all speeds
and temperatures.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.errors import ConvergenceError
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.tools import Tool
from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.fluid import NETWORK_MODELS, PocketFlow, PocketModel, pocket_flow
from epicyclic.pocketing.geometry import PocketGeometry, pocket_geometry
from epicyclic.pocketing.network import void_number
from epicyclic.units import BAR, METRE_PER_SECOND, NUMBER, WATT, Quantity

Floats = NDArray[np.float64]

LEAST_NUMBER = 1e-3
"""Number below which the scaled figures are those at it: there the fluid is incompressible to 1e-6,
and at next to no speed pressures drown in rounding. [1/m]"""


@dataclass(frozen=True, slots=True)
class FlowFigures:
    """What a result reports of the flow through the pockets of a mesh."""

    power: float  # [W]
    difference: float  # Difference of the power from the energy balance, relative. [1]
    pressure_max: float  # Above ambient. [Pa]
    pressure_min: float  # Above ambient. [Pa]
    speed_max: float  # [m/s]
    periods: int = 0  # Mesh periods until the flow repeated.
    periodic: bool = True  # False if it did not.
    # Number of flows in the table that these figures were read from; zero for the flow itself.
    nodes: int = 0
    # Largest error of the power in that table, relative, measured at flows left out of it; NaN for
    # the flow itself. [1]
    error: float = math.nan
    file: str = ""  # Name of the file that holds this table; empty if there is none.


FLOW_NUMBERS: dict[str, tuple[str, Quantity]] = {
    "power": ("pocketing loss of one mesh", WATT),
    "pressure_max": ("highest pressure in the pockets, above ambient", BAR),
    "pressure_min": ("lowest pressure in the pockets, above ambient", BAR),
    "speed_max": ("fastest flow out of or into a pocket", METRE_PER_SECOND),
    "difference": ("pocketing loss: error of its energy balance", NUMBER),
}
"""Label and quantity of the numbers of `FlowFigures`."""


@dataclass(frozen=True, slots=True)
class FlowFamily:
    """All flows through the same pockets. Attributes as for `pocket_geometry` and `pocket_flow`.

    The share of oil is 1 for the models in which it enters through the density alone.
    """

    mesh: Mesh
    tools: tuple[Tool | None, Tool | None]
    drives1: bool
    oil_fraction: float
    model: PocketModel
    slices: int
    steps: int
    end_length: float

    @property
    def geometry(self) -> PocketGeometry:
        """The pockets."""
        return pocket_geometry(self.mesh, self.tools, self.drives1)

    def flow(self, speed: float, mixture: MixtureState, pressure: float) -> PocketFlow:
        """The flow itself. Parameters as for `pocket_flow`."""
        return pocket_flow(
            self.geometry,
            speed,
            mixture,
            pressure,
            self.model,
            self.slices,
            self.steps,
            self.end_length,
        )

    @staticmethod
    def number(speed: float, mixture: MixtureState, pressure: float) -> float:
        """Speed over the root of pressure over density, held at the least. Theory (Q21). [1/m]"""
        return max(speed * math.sqrt(mixture.density / pressure), LEAST_NUMBER)

    def scales(self, number: float) -> bool:
        """Whether the flow at a number is another one times density and powers of the speed."""
        if self.model == "incompressible":
            size = (self.slices, self.steps, self.end_length)
            return number <= void_number(self.geometry, *size)
        return self.model in NETWORK_MODELS

    def figures(self, speed: float, mixture: MixtureState, pressure: float) -> FlowFigures:
        """Figures of the flow itself. Parameters as for `pocket_flow`."""
        if self.number(speed, mixture, pressure) == LEAST_NUMBER:
            scaled = self.scaled(LEAST_NUMBER)
            if np.isfinite(scaled).all():
                return from_scaled(scaled, speed, mixture.density)
        return flow_figures(self.flow(speed, mixture, pressure))

    def scaled(self, number: float) -> Floats:
        """Scaled figures of the flow at a number; NaN if it does not repeat or is not found."""
        try:
            # not kept: only its figures are needed again
            flow = pocket_flow.__wrapped__(
                self.geometry,
                number,
                MixtureState(self.oil_fraction, 1.0, 0.0),
                1.0,
                self.model,
                self.slices,
                self.steps,
                self.end_length,
            )
        except ConvergenceError:
            return np.full(5, math.nan)
        if not flow.periodic:
            return np.full(5, math.nan)
        return scaled_figures(flow_figures(flow), number, 1.0)


def flow_figures(flow: PocketFlow) -> FlowFigures:
    """The figures of a flow."""
    return FlowFigures(
        power=flow.power,
        difference=flow.difference,
        pressure_max=float(flow.pressure.max()),
        pressure_min=float(flow.pressure.min()),
        speed_max=flow.speed_max,
        periods=flow.periods,
        periodic=flow.periodic,
    )


def scaled_figures(figures: FlowFigures, speed: float, density: float) -> Floats:
    """Power, difference, pressures and speed as functions of the number alone. Theory (Q22)."""
    head = density * speed**2
    return np.array(
        [
            figures.power / (head * speed),
            figures.difference,
            figures.pressure_max / head,
            figures.pressure_min / head,
            figures.speed_max / speed,
        ]
    )


def from_scaled(
    scaled: Floats, speed: float, density: float, nodes: int = 0, error: float = math.nan
) -> FlowFigures:
    """The reverse of `scaled_figures`."""
    power, difference, highest, lowest, fastest = map(float, scaled)
    head = density * speed**2
    return FlowFigures(
        power=power * head * speed,
        difference=difference,
        pressure_max=highest * head,
        pressure_min=lowest * head,
        speed_max=fastest * speed,
        nodes=nodes,
        error=error,
    )
