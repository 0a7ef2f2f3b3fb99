"""Elements on shafts: rolling bearings, lip seals, and losses that the user tabulates."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from typing import ClassVar, Literal, get_args

from epicyclic.arrays import Each, joined
from epicyclic.dataclass import dataclass, replace
from epicyclic.losses.designations import RATING_BAND
from epicyclic.losses.drag import RPM as ONE_RPM
from epicyclic.losses.houpert import BallModel
from epicyclic.losses.loss_table import LossTable
from epicyclic.losses.ranges import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.losses.shaft_bearing import (
    TAPERED_ERRORS,
    BearingLoad,
    CatalogueBearing,
    PalmgrenModel,
    TableModel,
    friction_load,
    limit_text,
    limiting_speed,
    minimum_load,
    thermal_excess,
    thermal_speed_rating,
)
from epicyclic.losses.skf_2018 import SkfModel
from epicyclic.losses.zhou_hoeprich import RollerModel
from epicyclic.machine.element import (
    LOAD_DEPENDENT,
    LOAD_INDEPENDENT,
    ElementResult,
    Loss,
    Note,
    PartFigures,
    State,
    figure,
)
from epicyclic.units import (
    METRE_PER_SECOND,
    NEWTON,
    NEWTON_METRE,
    NUMBER,
    RPM,
    WATT,
    format_number,
    percent,
)


class ShaftPart(ABC):
    """An element whose formulas take single numbers; torques and forces need not matter to it."""

    __slots__ = ()

    several: ClassVar = True

    def loads(self, state: State, last: ElementResult | None = None) -> Mapping[str, float]:
        """Nothing."""
        return {}

    def evaluate(self, state: State, last: ElementResult | None = None) -> ElementResult:
        """Losses, figures and flags in a state; of several points for one after the other."""
        if not state.each:
            return self.answer(state)
        found = [self.answer(own) for own in state.each]
        # equal notes may concern different losses
        whole: ElementResult = joined(found, Each)
        return replace(whole, notes=Each(own.notes for own in found))

    @abstractmethod
    def answer(self, state: State) -> ElementResult:
        """Losses, figures and flags in the state of one point."""


# A loss between two bodies that the user gives as a table: clutch, brake, pump or other drag.


@dataclass(frozen=True, eq=False)
class TableLossFigures(PartFigures):
    """Speed and torque of a loss from a table; the torque is NaN at rest."""

    speed: float = figure("speed difference", RPM)
    friction_torque: float = figure("drag torque", NEWTON_METRE)


@dataclass(frozen=True, slots=True)
class TableLoss(ShaftPart):
    """Drag between two bodies over their speed difference and the oil temperature."""

    key: str  # First part of the key of its loss.
    between: tuple[str, str]  # The two bodies, one of which may be `HOUSING`.
    table: LossTable  # Over speed and temperature.

    terms: ClassVar = ("drag",)
    figure_types: ClassVar = (("drag", TableLossFigures),)

    def answer(self, state: State) -> ElementResult:
        """See `ShaftPart`."""
        speed = state.speeds[self.between[0]] - state.speeds[self.between[1]]
        at = {"speed": speed, "temperature": state.fluids.oil.temperature}
        watts, source = self.table.loss(**at), self.table.source
        brakes = ((*self.between, 1.0),)
        torque = watts / abs(speed) if speed != 0 else math.nan
        return ElementResult(
            losses={"drag": Loss(LOAD_INDEPENDENT, watts, "loss table", source, brakes=brakes)},
            figures={"drag": TableLossFigures(speed=abs(speed), friction_torque=torque)},
            flags=self.table.flags(ModelUse("drag", "table", self.key), **at),
        )


# A radial lip seal on a shaft: ISO/TR 14179-1, ISO/TR 14179-2, Linke, or a table of the user.

SealFormula = Literal["iso-14179-1-viton", "iso-14179-1-buna-n", "iso-14179-2", "linke"]

SEAL_METHODS: Mapping[SealFormula, tuple[str, str]] = {
    "iso-14179-1-viton": ("lip seal of Viton after ISO/TR 14179-1", "ISO/TR 14179-1:2001"),
    "iso-14179-1-buna-n": ("lip seal of Buna N after ISO/TR 14179-1", "ISO/TR 14179-1:2001"),
    "iso-14179-2": ("lip seal after ISO/TR 14179-2", "ISO/TR 14179-2:2001"),
    "linke": ("lip seal after Linke", "H. Linke, Stirnradverzahnung, second hand"),
}
"""What each formula is, and its source."""

TORQUE_PER_DIAMETER: Mapping[str, float] = {"iso-14179-1-viton": 3.736, "iso-14179-1-buna-n": 2.429}
"""Friction torque over shaft diameter, ISO/TR 14179-1. [N]"""

_KELVIN = 273.15  # 0 degC in kelvin.
_LIMIT = "usual limit of the material, DIN 3760, general knowledge"
_VITON = Range("lip_speed", "speed of the shaft at the seal", None, 38.0, METRE_PER_SECOND, _LIMIT)
_RANGES: Mapping[SealFormula, tuple[Range, ...]] = {
    "iso-14179-1-viton": (_VITON,),
    "iso-14179-1-buna-n": (replace(_VITON, high=14.0),),
    "iso-14179-2": (_VITON,),  # which stands the highest speed of all materials of lips
    "linke": (
        _VITON,
        Range(
            "bracket", "factor of temperature and viscosity of Linke's seal formula",
            0.0, None, NUMBER, "it has no meaning below zero; held at zero",
        ),
    ),
}  # fmt: skip


def seal_loss(
    # ``"iso-14179-1-viton"``, ``"iso-14179-1-buna-n"``, ``"iso-14179-2"`` or ``"linke"``.
    formula: SealFormula,
    diameter: float,  # Diameter of the shaft under the lip. [m]
    speed: float,  # Speed of the shaft against the seal. [rad/s]
    temperature: float,  # Temperature of the oil; only Linke. [K]
    # Kinematic viscosity of the oil at 40 degC, more than 0.2 mm^2/s; only Linke. [m^2/s]
    viscosity_40: float,
) -> float:
    """Friction loss of one lip seal. Theory (J14), (J15), (J16). [W]

    Examples
    --------
    A shaft of 40 mm at 3000 rpm, in oil of VG 100 at 60 degC:

    >>> round(seal_loss("iso-14179-2", 0.040, 100 * math.pi, 333.15, 100e-6), 1)
    36.9
    """
    if formula in TORQUE_PER_DIAMETER:
        return TORQUE_PER_DIAMETER[formula] * diameter * abs(speed)
    group = (diameter * 1e3) ** 2 * abs(speed) / ONE_RPM
    if formula == "iso-14179-2":
        return 7.69e-6 * group
    return 1e-7 * max(0.0, linke_bracket(temperature, viscosity_40)) * group


def linke_bracket(temperature: float, viscosity_40: float) -> float:
    """145 - 1.6 theta + 350 lg lg(nu40 + 0.8), in degC and mm^2/s; may be negative. [1]

    Parameters as for `seal_loss`.
    """
    grade = math.log10(math.log10(viscosity_40 * 1e6 + 0.8))
    return 145 - 1.6 * (temperature - _KELVIN) + 350 * grade


def seal_losses(
    diameter: float, speed: float, temperature: float, viscosity_40: float
) -> dict[SealFormula, float]:
    """The loss after every formula: how far they spread. Parameters as for `seal_loss`. [W]"""
    return {
        formula: seal_loss(formula, diameter, speed, temperature, viscosity_40)
        for formula in get_args(SealFormula)
    }


def seal_flags(
    formula: SealFormula,
    where: str,
    diameter: float,
    speed: float,
    temperature: float,
    viscosity_40: float,
) -> tuple[ValidityFlag, ...]:
    """Flags of `seal_loss` for the seal called `where`; none at rest."""
    if speed == 0:
        return ()
    bracket = linke_bracket(temperature, viscosity_40)
    values = {"lip_speed": abs(speed) * diameter / 2, "bracket": bracket}
    return check_ranges(ModelUse("seal", formula, where), _RANGES[formula], values)


@dataclass(frozen=True, eq=False)
class SealFigures(PartFigures):
    """What an engineer checks by eye on a seal, and how far the formulas spread; NaN at rest."""

    speed: float = figure("speed difference at the seal", RPM)
    lip_speed: float = figure("speed of the shaft at the lip", METRE_PER_SECOND)
    friction_torque: float = figure("friction torque", NEWTON_METRE)
    iso_14179_1_viton: float = figure("loss after ISO/TR 14179-1, Viton", WATT)
    iso_14179_1_buna_n: float = figure("loss after ISO/TR 14179-1, Buna N", WATT)
    iso_14179_2: float = figure("loss after ISO/TR 14179-2", WATT)
    linke: float = figure("loss after Linke", WATT)


@dataclass(frozen=True, slots=True)
class Seal(ShaftPart):
    """A radial lip seal between a shaft and the housing, or between two shafts."""

    key: str  # First part of the key of its loss.
    between: tuple[str, str]  # The shaft that runs under the lip, and the body that holds the seal.
    diameter: float  # Diameter of the shaft under the lip. [m]
    model: SealFormula | LossTable  # A formula of `seal_loss`, or a table of the user.
    viscosity_40: float  # Kinematic viscosity of the oil at 40 degC. [m^2/s]

    terms: ClassVar = ("friction",)
    figure_types: ClassVar = (("seal", SealFigures),)

    def answer(self, state: State) -> ElementResult:
        """See `ShaftPart`."""
        speed = state.speeds[self.between[0]] - state.speeds[self.between[1]]
        temperature = state.fluids.oil.temperature
        if isinstance(self.model, LossTable):
            watts = self.model.loss(speed=speed, temperature=temperature)
            method, source = "loss table", self.model.source
            use = ModelUse("seal", "table", self.key)
            flags = self.model.flags(use, speed=speed, temperature=temperature)
        else:
            at = (self.diameter, speed, temperature, self.viscosity_40)
            watts = seal_loss(self.model, *at)
            method, source = SEAL_METHODS[self.model]
            flags = seal_flags(self.model, self.key, *at)
        loss = Loss(LOAD_INDEPENDENT, watts, method, source, brakes=((*self.between, 1.0),))
        return ElementResult(
            losses={"friction": loss},
            figures={"seal": self._figures(watts, speed, temperature)},
            flags=flags,
        )

    def _figures(self, watts: float, speed: float, temperature: float) -> SealFigures:
        spread = seal_losses(self.diameter, speed, temperature, self.viscosity_40)
        return SealFigures(
            speed=abs(speed),
            lip_speed=abs(speed) * self.diameter / 2,
            friction_torque=watts / abs(speed) if speed != 0 else math.nan,
            **{formula.replace("-", "_"): loss for formula, loss in spread.items()},
        )


# A rolling bearing of a shaft, as a catalogue states it.


BearingModel = PalmgrenModel | SkfModel | RollerModel | BallModel | TableModel
"""How the friction of a bearing is computed."""


@dataclass(frozen=True, eq=False)
class ShaftBearingFigures(PartFigures):
    """What an engineer checks by eye on a shaft bearing; NaN where unknown or without motion."""

    radial_force: float = figure("radial force", NEWTON)
    axial_force: float = figure("axial force", NEWTON)
    friction_load: float = figure("load P1 for the friction moment", NEWTON)
    minimum_load: float = figure("minimum load (SKF)", NEWTON)
    speed: float = figure("speed difference of the rings", RPM)
    friction_torque: float = figure("friction torque", NEWTON_METRE)
    coefficient: float = figure("coefficient f1 of the load-dependent moment", NUMBER)


@dataclass(frozen=True, slots=True)
class ShaftBearing(ShaftPart):
    """A rolling bearing between a shaft and the housing, or between two shafts."""

    key: str  # First part of the keys of its losses; `State.forces` has its load under this key.
    between: tuple[str, str]  # The bodies of its two rings.
    bearing: CatalogueBearing
    model: BearingModel
    # The load where the user gives it; None to take that of the state.
    force: BearingLoad | None = None
    minimum_load_factor: float | None = None  # k_r of SKF; None for the default of the type. [1]
    # Reference speed of a cylindrical roller bearing, for its minimum load. [rad/s]
    reference_speed: float | None = None
    limiting_speed: float | None = None  # None for that of the type. [rad/s]
    assumed: str = ""  # Of its axial force, where nobody states which bearing takes it.
    lacks: tuple[str, ...] = ()  # What its force and its loss leave out.
    idle: tuple[str, ...] = ()  # Keys that are stated and not used by its model.

    figure_types: ClassVar = (("bearing", ShaftBearingFigures),)

    @property
    def terms(self) -> tuple[str, ...]:
        """Names of its losses."""
        return self.model.terms

    def loads(self, state: State, last: ElementResult | None = None) -> Mapping[str, float]:
        """The forces on it; nothing if the user gives them, or the model needs none. [N]"""
        if self.force is not None or not self.model.depends_on_load:
            return {}
        force = state.forces[self.key]
        return {"radial": force.radial, "axial": force.axial}

    def answer(self, state: State) -> ElementResult:
        """See `ShaftPart`."""
        load = state.forces[self.key] if self.force is None else self.force
        speed = state.speeds[self.between[0]] - state.speeds[self.between[1]]
        oil = state.fluids.at(self.key)
        parts = self.model.parts(self.bearing, load, speed, oil)
        stated = self.minimum_load_factor, self.reference_speed
        least = minimum_load(self.bearing, speed, oil.kinematic_viscosity, *stated)
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
            notes=tuple(self._notes(load, least, speed, watts)),
        )

    def _notes(self, load: BearingLoad, least: float, speed: float, watts: float) -> Iterator[str]:
        if speed == 0:
            return
        if self.idle:
            told = f"the model {self.model.name} does not use {', '.join(self.idle)}."
            yield Note(f"{self.key}: {told}", watts)
        for lack in self.lacks:
            yield f"{self.key}: {lack}"  # nobody knows how many watts it means
        # what holds the rolling elements to the races [N]
        both = self.bearing.type in ("deep-groove", "tapered", "spherical")
        carried = math.hypot(load.radial, load.axial) if both else load.radial
        if carried < least:
            text = (
                f"{self.key}: the load of {format_number(carried, 3)} N is below the minimum load "
                f"of {format_number(least, 3)} N (SKF, second hand). The rolling elements may "
                "slip; the loss is that of the actual load without slip."
            )
            yield Note(text, watts)
        stated = self.reference_speed
        if abs(speed) > stated if stated else thermal_excess(self.bearing, abs(speed)) > 0:
            rating = stated or thermal_speed_rating(self.bearing)
            whose = "" if self.reference_speed else ", an estimate after ISO 15312"
            text = (
                f"{self.key}: {RPM.text(abs(speed), 4)} exceed the thermal reference speed of "
                f"{RPM.text(rating, 2)}{whose}. Above it a bearing in an oil bath overheats "
                "without cooling; give the reference_speed of the catalogue, and check the "
                "limiting speed."
            )
            yield Note(text, watts)
        limit = self.limiting_speed or limiting_speed(self.bearing)
        if abs(speed) > limit:
            told = limit_text(speed, limit, self.limiting_speed is not None)
            yield Note(f"{self.key}: {told}", watts)
        if self.assumed and load.axial > 0:
            yield Note(f"{self.key}: {self.assumed}", watts)
        if self.bearing.estimated:
            own = self.bearing
            text = (
                f"{self.key}: the load ratings of {own.estimated} are estimates after ISO 281 and "
                f"ISO 76, C {format_number(own.dynamic_load_rating / 1e3, 3)} kN and C0 "
                f"{format_number(own.static_load_rating / 1e3, 3)} kN, each "
                f"±{percent(RATING_BAND, 0)}; limits follow from them, and the friction of balls "
                "with harris and skf-2018. Give those of the catalogue."
            )
            rated = self.model.name in ("harris", "skf-2018") and self.bearing.type != "tapered"
            yield Note(text, watts if rated else 0.0)
        best, error = TAPERED_ERRORS["zhou-hoeprich"], TAPERED_ERRORS.get(self.model.name, 0.0)
        if self.bearing.type == "tapered" and error > best:
            text = (
                f"{self.key}: {WATT.text(watts, 3)} after {self.model.name}, whose mean error on "
                f"a set of measured tapered bearings reaches {percent(error, 0)}; give the width "
                f"of the bearing to use zhou-hoeprich, with at most {percent(best, 0)}."
            )
            yield Note(text, watts)
        skf = getattr(self.model, "skf", self.model)
        if isinstance(skf, SkfModel) and skf.drag_is_estimated:
            text = (
                f"{self.key}: the drag variable V_M is an estimate, because SKF's diagram was "
                "not available; give drag_variable."
            )
            yield Note(text)
