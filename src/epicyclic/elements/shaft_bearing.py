"""A rolling bearing of a shaft, as a catalogue states it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from epicyclic.elements.base import LOAD_DEPENDENT, LOAD_INDEPENDENT, ElementResult, Loss, State
from epicyclic.elements.figures import figure
from epicyclic.losses.shaft_bearing import (
    BearingLoad,
    CatalogueBearing,
    friction_load,
    minimum_load,
)
from epicyclic.losses.skf_bearing import BearingModel, SkfModel
from epicyclic.units import NEWTON, NEWTON_METRE, NUMBER, RPM, format_number


@dataclass(frozen=True, slots=True, eq=False)
class ShaftBearingFigures:
    """What an engineer checks by eye on a shaft bearing; NaN where unknown or without motion."""

    radial_force: float = figure("radial force", NEWTON)
    axial_force: float = figure("axial force", NEWTON)
    friction_load: float = figure("load P1 that sets the friction", NEWTON)
    minimum_load: float = figure("minimum load (SKF)", NEWTON)
    speed: float = figure("speed difference of the rings", RPM)
    friction_torque: float = figure("friction torque", NEWTON_METRE)
    coefficient: float = figure("coefficient f1 of the load-dependent moment", NUMBER)


@dataclass(frozen=True, slots=True)
class ShaftBearing:
    """A rolling bearing between a shaft and the housing, or between two shafts."""

    key: str  # First part of the keys of its losses; `State.forces` has its load under this key.
    between: tuple[str, str]  # The bodies of its two rings.
    bearing: CatalogueBearing
    model: BearingModel  # `PalmgrenModel`, `SkfModel` or `TableModel`.
    # The load where the user gives it; None to take that of the state.
    force: BearingLoad | None = None
    minimum_load_factor: float | None = None  # k_r of SKF; None for the default of the type. [1]
    # Reference speed of a cylindrical roller bearing, for its minimum load. [rad/s]
    reference_speed: float | None = None

    figure_types: ClassVar = (("bearing", ShaftBearingFigures),)

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of its losses."""
        return self.model.terms

    def idle(self, state: State) -> None:
        """Nothing that would be worth keeping."""

    def loads(self, state: State) -> Mapping[str, float]:
        """The forces on it; nothing if the user gives them, or the model needs none. [N]"""
        if self.force is not None or not self.model.depends_on_load:
            return {}
        force = state.forces[self.key]
        return {"radial": force.radial, "axial": force.axial}

    def evaluate(self, state: State) -> ElementResult:
        """Losses, figures and flags in a state."""
        load = state.forces[self.key] if self.force is None else self.force
        speed = state.speeds[self.between[0]] - state.speeds[self.between[1]]
        oil = state.fluids.at(self.key)
        parts = self.model.parts(self.bearing, load, speed, oil)
        least = minimum_load(
            self.bearing,
            speed,
            oil.kinematic_viscosity,
            self.minimum_load_factor,
            self.reference_speed,
        )
        watts = sum(part.watts for part in parts)
        figures = ShaftBearingFigures(
            radial_force=load.radial,
            axial_force=load.axial,
            friction_load=friction_load(self.bearing, load),
            minimum_load=least,
            speed=abs(speed),
            friction_torque=watts / abs(speed) if speed != 0 else math.nan,
            coefficient=self.model.coefficient(self.bearing, load),
        )
        return ElementResult(
            losses={
                part.key: Loss(
                    LOAD_DEPENDENT if part.by_load else LOAD_INDEPENDENT,
                    part.watts,
                    part.method,
                    part.source,
                    brakes=((*self.between, 1.0),),
                    heat=((self.key, 1.0),),
                )
                for part in parts
            },
            figures={"bearing": figures},
            flags=self.model.flags(self.key, self.bearing, load, speed, oil),
            notes=self._notes(load, least, speed),
        )

    def _notes(self, load: BearingLoad, least: float, speed: float) -> tuple[str, ...]:
        if speed == 0:
            return ()
        notes = []
        carried = self._carried(load)
        if carried < least:
            notes.append(
                f"{self.key}: the load of {format_number(carried, 3)} N is below the minimum load "
                f"of {format_number(least, 3)} N (SKF, second hand). The rolling elements may "
                "slip; the loss is that of the actual load without slip."
            )
        if isinstance(self.model, SkfModel) and self.model.drag_is_estimated:
            notes.append(
                f"{self.key}: the drag variable V_M is an estimate, as SKF's diagram was not at "
                "hand; give drag_variable."
            )
        return tuple(notes)

    def _carried(self, load: BearingLoad) -> float:
        """What holds the rolling elements to the races. [N]"""
        if self.bearing.type in ("deep-groove", "tapered"):
            return math.hypot(load.radial, load.axial)
        return load.radial
