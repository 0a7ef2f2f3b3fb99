"""A loss between two bodies that the user gives as a table: clutch, brake, pump or other drag."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from epicyclic.elements.base import LOAD_INDEPENDENT, ElementResult, Loss, State
from epicyclic.elements.figures import figure
from epicyclic.losses.loss_table import LossTable
from epicyclic.losses.validity import ModelUse
from epicyclic.units import NEWTON_METRE, RPM


@dataclass(frozen=True, slots=True, eq=False)
class TableLossFigures:
    """Speed and torque of a loss from a table; the torque is NaN at rest."""

    speed: float = figure("speed difference", RPM)
    friction_torque: float = figure("drag torque", NEWTON_METRE)


@dataclass(frozen=True, slots=True)
class TableLoss:
    """Drag between two bodies over their speed difference and the oil temperature."""

    key: str  # First part of the key of its loss.
    between: tuple[str, str]  # The two bodies, one of which may be `HOUSING`.
    table: LossTable  # Over speed and temperature.

    terms: ClassVar = ("drag",)
    figure_types: ClassVar = (("drag", TableLossFigures),)

    def idle(self, state: State) -> None:
        """Nothing that would be worth keeping."""

    def loads(self, state: State) -> Mapping[str, float]:
        """Nothing: torques and forces do not matter."""
        return {}

    def evaluate(self, state: State) -> ElementResult:
        """Loss, figures and flags in a state."""
        speed = state.speeds[self.between[0]] - state.speeds[self.between[1]]
        temperature = state.fluids.oil.temperature
        watts = self.table.loss(speed=speed, temperature=temperature)
        loss = Loss(
            LOAD_INDEPENDENT,
            watts,
            "loss table",
            self.table.source,
            brakes=((*self.between, 1.0),),
        )
        figures = TableLossFigures(
            speed=abs(speed), friction_torque=watts / abs(speed) if speed != 0 else math.nan
        )
        use = ModelUse("drag", "table", self.key)
        return ElementResult(
            losses={"drag": loss},
            figures={"drag": figures},
            flags=self.table.flags(use, speed=speed, temperature=temperature),
        )
