"""Bulk temperatures of gears from their own meshes, with the oil at its inlet temperature."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from epicyclic.elements.base import OIL
from epicyclic.elements.figures import MeshFigures
from epicyclic.elements.fluids import Fluids
from epicyclic.elements.gear_mesh import GearMesh
from epicyclic.elements.gear_set import GearSet
from epicyclic.machine.machine import Machine
from epicyclic.machine.settle import Answer
from epicyclic.machine.solve import Solution
from epicyclic.thermal.bulk import bulk_rise_of_flash, bulk_rise_of_loss

BulkMethod = Literal["iso-6336-20", "iso-6336-22"]


@dataclass(frozen=True, slots=True)
class _Side:
    """A mesh that warms a gear."""

    element: str  # Key of its set.
    mesh: GearMesh
    mates: int  # Gears that the gear meets in it.
    parallel: int  # How many of this mesh the set has.


@dataclass(frozen=True, slots=True)
class FlankModel:
    """Gears warmer than the oil by what their meshes do to them; nothing else is."""

    machine: Machine
    oil: float  # Temperature of the oil. [K]
    method: BulkMethod  # One of `BULK_METHODS`.
    lubrication_factors: Mapping[str, float]  # X_S of each set, by its key. [1]
    # Oil and mixture at the temperatures of all nodes.
    fluids_at: Callable[[Mapping[str, float]], Fluids]

    @property
    def start(self) -> Mapping[str, float]:
        """All gears as warm as the oil. [K]"""
        return dict.fromkeys(_sides(self.machine), self.oil)

    def fluids(self, temperatures: Mapping[str, float]) -> Fluids:
        """Oil and mixture at the temperatures of the nodes that they meet."""
        return self.fluids_at(temperatures)

    def answer(self, temperatures: Mapping[str, float], solution: Solution) -> Answer:
        """Bulk temperatures of all gears."""
        rise = BULK_METHODS[self.method]
        return Answer(
            {
                node: self.oil + rise(sides, solution, self.lubrication_factors[sides[0].element])
                for node, sides in _sides(self.machine).items()
            },
            given={OIL: self.oil},
        )


def _sides(machine: Machine) -> dict[str, list[_Side]]:
    """The meshes of every gear, by its thermal node."""
    found: dict[str, list[_Side]] = {}
    for own in machine.elements:
        if isinstance(own, GearSet):
            planets = {planet.nodes[0] for planet in own.planets}
            for mesh in own.meshes:
                for node in mesh.nodes:
                    mates = 1 if node in planets else own.count
                    found.setdefault(node, []).append(_Side(own.key, mesh, mates, own.count))
    return found


def _rise_of_flash(sides: list[_Side], solution: Solution, lubrication_factor: float) -> float:
    """ISO/TS 6336-20 with the mean flash temperature of its loaded meshes. Theory (W7)."""
    loaded = [(side, flash) for side, flash in _flashes(sides, solution) if not math.isnan(flash)]
    if not loaded:
        return 0.0
    mean = sum(flash for _, flash in loaded) / len(loaded)
    mates = sum(side.mates for side, _ in loaded)
    return bulk_rise_of_flash(mean, lubrication_factor, mates)


def _flashes(sides: list[_Side], solution: Solution) -> Iterator[tuple[_Side, float]]:
    for side in sides:
        figures = solution.results[side.element].figures[side.mesh.key]
        assert isinstance(figures, MeshFigures)
        yield side, figures.flash_temperature_mean


def _rise_of_loss(sides: list[_Side], solution: Solution, lubrication_factor: float) -> float:
    """ISO/TS 6336-22 from the loss of one mesh, the mean of those of a gear. Theory (W4)."""
    rises = []
    for side in sides:
        losses = solution.results[side.element].losses
        watts = losses[f"{side.mesh.key}_sliding"].watts / side.parallel
        geometry = side.mesh.mesh
        rises.append(
            bulk_rise_of_loss(
                watts, geometry.center_distance, geometry.face_width, lubrication_factor
            )
        )
    return sum(rises) / len(rises)


BULK_METHODS: Mapping[str, Callable[[list[_Side], Solution, float], float]] = {
    "iso-6336-20": _rise_of_flash,
    "iso-6336-22": _rise_of_loss,
}
"""How much warmer than the oil a gear is."""
