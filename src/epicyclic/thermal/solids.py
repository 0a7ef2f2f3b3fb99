"""Solids that store and conduct heat."""

from __future__ import annotations

from dataclasses import dataclass

from epicyclic.thermal.flash import effusivity


@dataclass(frozen=True, slots=True)
class Solid:
    """What a body is made of."""

    conductivity: float  # [W/(m K)]
    heat_capacity: float  # [J/(kg K)]
    density: float  # [kg/m^3]

    @property
    def effusivity(self) -> float:
        """sqrt(k rho c), as a surface takes up the heat of a contact. [W s^0.5/(m^2 K)]"""
        return effusivity(self.conductivity, self.heat_capacity, self.density)
