"""Tables of a case file on bearings, the carrier, seals and losses that the user tabulates."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from epicyclic.case.tables.base import (
    FLANGE_GAP,
    SHROUD_GAP,
    Gap,
    NamedMaterial,
    Roughness,
    ShortLength,
)
from epicyclic.errors import InputError, Problem, one_problem, raise_any
from epicyclic.gears.gear import HOUSING
from epicyclic.losses.ranges import BearingType, Cage, takes_no_axial_force
from epicyclic.messages import did_you_mean, millimetres, written
from epicyclic.schema.fields import PointsTable, Table, ValuesOrRows, option
from epicyclic.units import Length, Number, Play, Quantity, SmallLength, Temperature, VolumeFlow

if TYPE_CHECKING:
    from epicyclic.losses.loss_table import LossTable


def _known(kind: str, text: str) -> str:
    """A designation that is one of a kind of bearings."""
    from epicyclic.losses import designations  # cases without one need it not

    try:
        designations.CHECKS[kind](text)
    except KeyError as error:
        raise PydanticCustomError("preset", error.args[0], {"remedy": error.args[1]}) from None
    return text


def _filled(kind: str, raw: Any) -> Any:
    """A table with the keys that its designation gives; those of the user go first."""
    if not isinstance(raw, dict) or not raw.get("designation"):
        return raw
    from epicyclic.losses import designations

    return designations.KEYS[kind](raw) | raw


FromDigits = BeforeValidator(lambda it: str(it) if type(it) is int else it)  # 6208 without quotes
_Designation = Annotated[str, Field(max_length=40), FromDigits]
ShaftDesignation = Annotated[_Designation, AfterValidator(partial(_known, "shaft"))]
PlanetDesignation = Annotated[_Designation, AfterValidator(partial(_known, "planet"))]
ThrustDesignation = Annotated[_Designation, AfterValidator(partial(_known, "thrust"))]
ReferenceSpeed = Annotated[
    float, Quantity("a speed rating", "rad/s", "rpm", low=0.0, high=1e6, open_low=True)
]


class PlanetBearing(Table):
    """The roller bearing between planet and pin."""

    STAND_INS: ClassVar[dict[str, object]] = {
        "rows": 1, "roller_length": "1 mm", "roller_roughness": "1 um", "race_roughness": "1 um",
        "viscous_factor": None, "cage": None, "palmgren_coefficient": None, "crown_drop": None,
        "crown_length_fraction": None, "row_gap": None, "material": None,
    }  # fmt: skip

    designation: PlanetDesignation | None = option(
        "NU 2210, SL18 5010, 22220, NKI 40/30, K 40x48x20: the rollers that fit into the sizes of "
        "the ISO plans, with normal clearance and ground races, where they are not given."
    )
    type: Literal["needle", "cylindrical", "spherical"] = option(
        "spherical: aligns itself, so that it takes no couple of the meshes.", "cylindrical"
    )
    rows: int = Field(ge=1, le=4)
    rollers_per_row: int = Field(ge=3, le=200)
    roller_diameter: Length
    roller_length: Length = Field(description="Effective length of one roller.")
    pin_diameter: Length = Field(description="The inner race. The bore follows from it.")
    diametral_clearance: SmallLength
    roller_roughness: Roughness
    race_roughness: Roughness
    viscous_factor: Number | None = option(
        "f0 of the viscous loss of the whole bearing: 2.2-4 per row for caged cylindrical "
        "rollers, up to 12 for needles. Default: 3 per row.",
        ge=0,
        le=100,
    )
    cage: Cage = "caged"
    palmgren_coefficient: Number | None = option(
        "f1 of the palmgren method. Default: 0.0003 caged, 0.00055 full complement, 0.00025 "
        "spherical.",
        gt=0,
        le=0.05,
    )
    crown_drop: SmallLength = option("Drop of the profile at the roller's end (estimate).", "3 um")
    crown_length_fraction: Number = option(
        "Length of the crowned part at each end.", 0.2, ge=0, le=0.5
    )
    row_gap: ShortLength = option("Axial gap between the rollers of neighbouring rows.", "0 mm")
    limiting_speed: ReferenceSpeed | None = option("Of the catalogue. Default: that of its type.")
    material: NamedMaterial = option("Material of rollers and races.", "steel")

    _fill = model_validator(mode="before")(lambda raw: _filled("planet", raw))


class PlanetPin(Table):
    """The plain pin on which a planet turns, a journal bearing."""

    pin_diameter: Length
    length: Length = Field(description="Of the bore that runs on the pin.")
    diametral_clearance: Play
    pin_roughness: Roughness
    bore_roughness: Roughness
    boundary_friction: Number | None = option(
        "Of asperities in mixed friction. Default: that of the oil.", gt=0, le=1
    )
    oil_flow: VolumeFlow = option("Oil supplied to one pin, which carries heat away.", "0 l/min")
    material: NamedMaterial = option("Material of the pin.", "steel")


class Carrier(Table):
    """The planet carrier, for its drag: a closed disc, or plates with planets between them."""

    outer_diameter: Length
    width: Length
    open_width: ShortLength = option(
        "Part of the width over which the planets stand in the flow between two plates.", "0 mm"
    )
    shroud_gap: Gap | None = SHROUD_GAP
    flange_gap: Gap | None = FLANGE_GAP


class ThrustBearing(Table):
    """A thrust bearing that carries negligible load, for its viscous loss."""

    designation: ThrustDesignation | None = option(
        "51108, ...: mean diameter by ISO 104, f0 of its kind."
    )

    mean_diameter: Length
    between: Literal[
        "sun-carrier", "sun-ring", "ring-carrier", "sun-housing", "carrier-housing"
    ] = option("The two parts whose speeds differ.", "carrier-housing")
    viscous_factor: Number = option("f0 (Harris).", 3.5, ge=0, le=100)
    count: int = Field(default=1, ge=1, le=10)

    _fill = model_validator(mode="before")(lambda raw: _filled("thrust", raw))


Force = Annotated[float, Quantity("a force", "N", "N", low=0.0, high=1e9)]
LoadRating = Annotated[float, Quantity("a load rating", "N", "N", low=0.0, high=1e9, open_low=True)]
Position = Annotated[float, Quantity("a position", "m", "mm", low=-1e5, high=1e5)]
ContactAngle = Annotated[
    float, Quantity("a contact angle", "rad", "deg", low=0.0, high=45.0, open_low=True)
]
SpeedDifference = Annotated[
    float, Quantity("a speed difference", "rad/s", "rpm", low=0.0, high=1e6)
]
DragTorque = Annotated[float, Quantity("a drag torque", "N*m", "N*m", low=0.0, high=1e9)]
LostPower = Annotated[float, Quantity("a power loss", "W", "W", low=0.0, high=1e9)]


class LossTableTable(PointsTable):
    """Friction torque or power over one or two quantities, or a CSV file of them.

    Between the points linear, beyond them constant and flagged.
    """

    AXES: ClassVar = ("speed", "temperature", "radial_force")

    speed: tuple[SpeedDifference, ...] | None = option(
        "Magnitudes of the speed difference, increasing."
    )
    temperature: tuple[Temperature, ...] | None = option("Temperatures of the oil, increasing.")
    radial_force: tuple[Force, ...] | None = option("On a bearing, increasing.")
    torque: ValuesOrRows[DragTorque] | None = option(
        "Friction torque, with one value or one row for each value of the first axis."
    )
    power: ValuesOrRows[LostPower] | None = option(
        "Power loss instead of the torque; it needs the axis speed."
    )
    file: str | None = option(
        "CSV file in the folder of the case, with units in the header: speed [rpm],torque [N*m].",
        max_length=1000,
    )

    @property
    def quantity(self) -> Literal["torque", "power"]:
        """Which of the two it holds."""
        return "torque" if self.torque is not None else "power"


class ElementTable(Table):
    """An element of a train: what it is between, and what contradicts itself in its table."""

    TABLE_AXES: ClassVar[tuple[str, ...]] = ("speed", "temperature")
    """Those that a table of its loss may have; only bearings carry a load."""

    @property
    def bodies(self) -> dict[str, str]:
        """The two bodies that it is between, by their keys: it states both, or a shaft."""
        if (both := getattr(self, "between", None)) is not None:
            return {f"between[{number}]": body for number, body in enumerate(both)}
        return {key: getattr(self, key) for key in ("shaft", "against")}

    def problems(self) -> Iterator[Problem]:
        """What contradicts itself, or is missing; keys are relative to the table."""
        (own, first), (key, second) = self.bodies.items()
        if first == second:
            reason = "names the same body twice, so there is no relative motion."
            key, other = (own, "a") if first == HOUSING else (key, "another")
            yield Problem(key, written(second), reason, f"Name {other} shaft.")

    def points(self, folder: Path) -> LossTable | None:
        """Its torque or power if it states a table; raises `InputError` for a bad file."""
        own = getattr(self, "table", None)
        return None if own is None else _loss_table(own, folder, "table.", self.TABLE_AXES)


class DragTable(ElementTable, LossTableTable):
    """Drag of a clutch, a brake, a pump or another part, from a table."""

    between: tuple[str, str] = Field(
        description='The two shafts whose speeds differ; one of them may be "housing".'
    )

    def problems(self) -> Iterator[Problem]:
        yield from super().problems()
        yield from loss_table_problems(self, self.TABLE_AXES)

    def points(self, folder: Path) -> LossTable:
        return _loss_table(self, folder, "", self.TABLE_AXES)


class ClutchTable(ElementTable):
    """An open wet clutch, brake or synchronizer: drag of the oil between its faces."""

    between: tuple[str, str] = Field(
        description='The two shafts that it joins when closed; one of them may be "housing".'
    )
    gaps: int = Field(ge=1, le=200, description="Gaps between faces: twice the lined plates.")
    inner_diameter: Length = Field(description="Of the faces; of a cone at its thin end.")
    outer_diameter: Length
    gap: Gap = Field(description="Clearance of one gap when open, grooves spread over the face.")
    cone_angle: ContactAngle | None = option(
        "Half angle of the cone of a synchronizer. Default: flat plates."
    )
    oil_flow: VolumeFlow | None = option(
        "Oil to all gaps together. Default: as much as fills them, which drags most."
    )

    def problems(self) -> Iterator[Problem]:
        yield from super().problems()
        if self.inner_diameter >= self.outer_diameter:
            reason = f"must be less than outer_diameter, {millimetres(self.outer_diameter)}."
            shown = millimetres(self.inner_diameter)
            yield Problem("inner_diameter", shown, reason, "Correct one of the two.")


class BearingSealTable(Table):
    """Contact seals of a bearing after SKF, both together: K_S1 d_s^beta + K_S2."""

    counterface_diameter: Length = Field(description="d_s, the diameter on which the lips run.")
    factor: Number = Field(ge=0, le=10, description="K_S1, for mm and N mm.")
    exponent: Number = Field(ge=0, le=4, description="beta.")
    constant: DragTorque = option("K_S2.", "0 N*m")


_OF_TAPERED = ("rollers", "roller_diameter", "roller_length", "rib_height", "rib_roughness")
_OF_OTHERS = {"cylindrical": 3, "thrust-roller": 3, "deep-groove": 2, "thrust-ball": 2}  # of these
# Diameter of rolling elements over half of D - d: below that of any, and the least where it is not
# stated; needles have 0.2 to 0.4, others 0.5 to 0.75 (estimates by catalogues, `ELEMENTS`). [1]
_FINEST, _SLIMMEST = 0.1, 0.2
_THINNEST, _THICKEST = 1.03, 6.0  # D over d: thin sections have 1.04, a 633 4.3 (catalogues). [1]


class ShaftBearingTable(ElementTable):
    """A rolling bearing of a shaft."""

    TABLE_AXES = LossTableTable.AXES

    shaft: str = Field(description="The shaft in its bore.")
    against: str = option("The body that holds its outer ring.", "housing")
    designation: ShaftDesignation | None = option(
        "6208, NU 2210, 32006, NKI 40/30, ...: type and sizes by the ISO plans and estimated load "
        "ratings, where they are not given."
    )
    type: BearingType = Field(
        description="thrust-ball, thrust-roller: need axial_force, take no radial one."
    )
    bore: Length
    outside_diameter: Length
    width: Length | None = option("Needed for the drag of rollers in an oil bath.")
    cage: Cage = option("full-complement: cylindrical and needle rollers only.", "caged")
    model: Literal[
        "auto", "houpert", "zhou-hoeprich", "palmgren", "harris", "skf-2018", "table"
    ] = option(
        "auto: balls houpert; thrust rollers, and with width tapered or caged cylindrical ones, "
        "zhou-hoeprich; else palmgren. skf-2018: needs series.",
        "auto",
    )
    rollers: int | None = option("Rollers or balls. Default: as many as fit.", ge=4, le=200)
    roller_diameter: Length | None = option(
        "Mean. Default: tapered 0.26 (D - d), cylindrical 0.275, balls 0.3, thrust 0.37 or 0.29."
    )
    roller_length: Length | None = option("Default: tapered 0.7, cylindrical 0.65 width.")
    rib_height: Length | None = option("Of the contact on the rib. Default: 0.03 (D - d).")
    rib_roughness: Roughness | None = option("Rms, rib and roller ends. Default: 0.24 um.")
    series: str | None = option("For skf-2018: 62, 160; 2, 10, 22; 302, 320X; ...", max_length=20)
    dynamic_load_rating: LoadRating | None = option("C, for the life and the least load.")
    static_load_rating: LoadRating | None = option(
        "C0, for ball bearings with harris and skf-2018."
    )
    contact_angle: ContactAngle | None = option(
        "Contact angle of a tapered roller bearing, instead of axial_factor, or of angular contact "
        "balls."
    )
    axial_factor: Number | None = option(
        "Y of a tapered roller bearing, 0.4 cot of the angle.", gt=0, le=10
    )
    position: Position | None = option("Along the shaft, for its reactions to the gear forces.")
    locating: bool = option("true: the bearing takes axial force.", False)
    axial_sense: Literal["both", "positive", "negative"] = option(
        "Direction along the axis in which a locating, tapered or angular contact bearing holds "
        "the shaft.",
        "both",
    )
    arrangement: Literal["X", "O"] | None = option(
        "Of two tapered or angular contact bearings, instead of axial_sense. Default: X."
    )
    preload: Force | None = option("Axial preload of such a pair.")
    preload_displacement: ShortLength | None = option("The same as the approach of its rings.")
    radial_force: Force | None = option("Radial force instead of the reaction to the gear forces.")
    axial_force: Force | None = option(
        "Axial force in addition to radial_force. Default: none if radial_force is given."
    )
    viscous_factor: Number | None = option(
        "f0 of palmgren and harris. Default: deep-groove 2, angular-contact 3.3, cylindrical 3 or "
        "7.5 (full complement), tapered 6, needle 12, spherical 4, thrust-ball 1.5, thrust-roller "
        "3.5 (needles 5).",
        ge=0,
        le=100,
    )
    palmgren_coefficient: Number | None = option(
        "f1 of palmgren. Default: 0.0003, full complement 0.00055, tapered 0.0004, angular-contact "
        "0.0005, needle 0.0005 (estimate), spherical 0.00025, thrust-ball 0.0004, thrust-roller "
        "0.0015.",
        gt=0,
        le=0.05,
    )
    flange_coefficient: Number | None = option(
        "f_f of cylindrical rollers under axial force. Default: 0.002, full complement 0.003.",
        ge=0,
        le=0.05,
    )
    lubrication: Literal["jet", "oil-bath", "grease", "oil-air"] = option(
        "For skf-2018: replenishment and starvation constant.", "jet"
    )
    oil_level: ShortLength = option(
        "Level above the lowest point of the outer raceway, for skf-2018; 0: no bath.", "0 mm"
    )
    drag_variable: Number | None = option(
        "V_M of skf-2018 at this oil level. Default: 0.0012 times the immersed share (estimate).",
        ge=0,
        le=0.01,
    )
    sliding_friction: Number | None = option(
        "mu_EHL of skf-2018. Default: 0.02 cylindrical, 0.002 tapered; ball bearings by oil: "
        "0.05 mineral, 0.10 ATF, 0.04 others.",
        ge=0,
        le=0.5,
    )
    seal: BearingSealTable | None = option("Contact seals of the bearing, for skf-2018.")
    minimum_load_factor: Number | None = option(
        "k_r of the product table. Default: 0.025 deep-groove, 0.15 cylindrical.", gt=0, le=10
    )
    reference_speed: ReferenceSpeed | None = option(
        "Of the catalogue; for the minimum load of cylindrical rollers, and a note above it."
    )
    limiting_speed: ReferenceSpeed | None = option("Of the catalogue. Default: that of its type.")
    table: LossTableTable | None = option("Loss table for model = table.")

    _fill = model_validator(mode="before")(lambda raw: _filled("shaft", raw))

    @property
    def is_angular(self) -> bool:
        """True if radial force induces an axial one in the bearing."""
        return self.type in ("tapered", "angular-contact")

    def problems(self) -> Iterator[Problem]:
        # cases without bearings need it not
        from epicyclic.losses.designations import unlike
        from epicyclic.losses.shaft_bearing import TYPE_CONSTANTS, bearing_types

        kind, model = self.type, self.model
        yield from (differing := [*unlike("shaft", self)])
        if any(it.key == "designation" for it in differing):  # other sizes belong to its type
            return
        if self.bore >= self.outside_diameter:
            reason = f"must be less than outside_diameter, {millimetres(self.outside_diameter)}."
            yield Problem("bore", millimetres(self.bore), reason, "Correct one of the two.")
        elif not _THINNEST < self.outside_diameter / self.bore < _THICKEST:
            shown = millimetres(self.outside_diameter)
            reason = f"must be {_THINNEST:g} to {_THICKEST:g} times the bore."
            yield Problem("outside_diameter", shown, reason, "Correct one of the two.")
        if (kind, self.cage) not in TYPE_CONSTANTS:
            remedy = 'Write cage = "caged", or choose cylindrical or needle rollers.'
            yield Problem("cage", written(self.cage), f"is not made for {kind} bearings.", remedy)
        yield from _angle_problems(self)
        yield from _pair_problems(self)
        yield from super().problems()
        yield from _force_problems(self)
        if kind not in bearing_types(model):
            reason = f"has no constants for {kind} bearings."
            yield Problem("model", written(model), reason, 'Choose model = "palmgren" or "table".')
            return
        yield from _own_table_problems(self)
        yield from _roller_problems(self)
        if model == "skf-2018":
            yield from _skf_problems(self)
        rated = kind not in bearing_types("houpert") or (self.designation and kind != "thrust-ball")
        if model in ("harris", "skf-2018") and not (rated or self.static_load_rating):
            reason = f"is missing; the model {model} needs it for ball bearings."
            yield Problem("static_load_rating", "", reason, "Add C0 from the catalogue.")


class SealTable(ElementTable):
    """A radial lip seal on a shaft."""

    shaft: str = Field(description="The shaft under the lip.")
    against: str = option("The body that holds the seal.", "housing")
    diameter: Length = Field(description="Diameter of the shaft under the lip.")
    model: Literal["iso-14179-1-viton", "iso-14179-1-buna-n", "iso-14179-2", "linke", "table"] = (
        option(
            "The formulas differ by a factor of 2 and more; the figures show all.", "iso-14179-2"
        )
    )
    table: LossTableTable | None = option("Loss table for model = table.")

    def problems(self) -> Iterator[Problem]:
        yield from super().problems()
        yield from _own_table_problems(self)


# What contradicts itself, or is missing, in one of these tables; keys are relative to the table.


def _angle_problems(table: ShaftBearingTable) -> Iterator[Problem]:
    """The contact angle of tapered rollers and angular contact balls, stated once."""
    angles = [key for key in ("axial_factor", "contact_angle") if getattr(table, key) is not None]
    if table.type == "angular-contact":
        for key in ("axial_factor", *_OF_TAPERED[2:]):
            if getattr(table, key) is not None:
                yield Problem(key, "", "belongs to tapered roller bearings.", "Delete it.")
        if table.contact_angle is None:
            reason, remedy = "is missing.", 'Add that of the catalogue: "40 deg" of 72 B and 73 B.'
            yield Problem("contact_angle", "", reason, remedy)
    elif table.type != "tapered":
        foreign = _OF_TAPERED[_OF_OTHERS.get(table.type, 0) :]
        for key in [*angles, *(key for key in foreign if getattr(table, key) is not None)]:
            yield Problem(key, "", "belongs to tapered roller bearings.", "Delete it.")
    elif table.model != "table" and not angles:
        reason = "is missing; give axial_factor or contact_angle."
        remedy = "Add Y from the catalogue, or the contact angle."
        yield Problem("axial_factor", "", reason, remedy)
    elif table.model != "table" and len(angles) == 2:
        reason = "is given together with contact_angle; each follows from the other."
        yield Problem("axial_factor", "", reason, "Delete one.")


def _roller_problems(table: ShaftBearingTable) -> Iterator[Problem]:
    """What rolling and drag of rollers cannot be computed with."""
    wanted, thrust = table.model == "zhou-hoeprich", table.type == "thrust-roller"
    if wanted and not thrust and table.width is table.roller_length is None:
        reason = "is missing; it tells how long the rollers are."
        yield Problem("width", "", reason, "Add B from the catalogue, or roller_length.")
    bathed = table.model == "skf-2018" or table.roller_length is not None or thrust
    if bathed and table.oil_level > 0 and table.type != "deep-groove" and table.width is None:
        reason = "is missing; the drag of rollers in an oil bath needs it."
        yield Problem("width", "", reason, "Add B from the catalogue.")
    if wanted and table.cage == "full-complement":
        reason = "is not covered by zhou-hoeprich: rollers that touch rub on each other."
        remedy = 'Choose model = "palmgren" or "skf-2018".'
        yield Problem("cage", written(table.cage), reason, remedy)
    room = (table.outside_diameter - table.bore) / 2
    if room <= 0:
        return
    diameter = table.roller_diameter or _SLIMMEST * room
    if not _FINEST * room < diameter < room:
        ends = " and ".join(map(millimetres, (_FINEST * room, room)))
        reason = f"must be between {ends}, the height of the ring."
        yield Problem("roller_diameter", millimetres(diameter), reason, "Correct it.")
    elif table.rollers is not None:
        most = int(math.pi / math.asin(2 * diameter / (table.outside_diameter + table.bore)))
        if table.rollers > most:
            reason = f"must be at most {most}, which touch each other."
            yield Problem("rollers", f"{table.rollers}", reason, "Correct it or roller_diameter.")
    longest = room if thrust else table.width or math.inf
    if table.roller_length is not None and table.roller_length > longest:
        reason = f"must be at most {millimetres(longest)}, as there is room in the bearing."
        yield Problem("roller_length", millimetres(table.roller_length), reason, "Correct it.")


def _pair_problems(table: ShaftBearingTable) -> Iterator[Problem]:
    """What of a pair of bearings with contact angles is out of place, or stated twice."""
    if not table.is_angular or table.radial_force is not None:
        for key in ("arrangement", "preload", "preload_displacement"):
            if getattr(table, key) is not None:
                reason = "belongs to tapered and angular contact bearings without radial_force."
                yield Problem(key, "", reason, "Delete it.")
    elif table.arrangement and table.axial_sense != "both":
        reason = "is given together with axial_sense; each follows from the other."
        yield Problem("arrangement", written(table.arrangement), reason, "Delete one.")


def _force_problems(table: ShaftBearingTable) -> Iterator[Problem]:
    if table.type.startswith("thrust"):
        if table.axial_force is None and table.model != "table":
            remedy = 'Add that of the gears on its shaft: "2 kN".'
            yield Problem("axial_force", "", "is missing of a thrust bearing.", remedy)
        for key in ("radial_force", "position", "locating"):
            if getattr(table, key):
                reason = "is not possible with a thrust bearing, which carries no radial force."
                yield Problem(key, "", reason, "Delete it.")
        return
    if table.axial_force is not None and table.radial_force is None:
        remedy = 'Add radial_force = "0 N" if there is none.'
        yield Problem("radial_force", "", "is missing, but axial_force is given.", remedy)
    for key, shown in {"locating": "true", "axial_force": f"{table.axial_force or 0:g} N"}.items():
        if getattr(table, key) and takes_no_axial_force(table.type, table.designation):
            kind = table.designation or "a needle roller bearing"
            reason = f"is not possible with {kind}, which carries no axial force."
            yield Problem(key, shown, reason, "Locate the shaft by another bearing.")


def _skf_problems(table: ShaftBearingTable) -> Iterator[Problem]:
    from epicyclic.losses.skf_2018 import skf_series

    known = skf_series(table.type)
    choice = ", ".join(known)
    if table.cage == "caged" and table.series is None:
        reason = f"is missing; SKF lists the series {choice}."
        yield Problem("series", "", reason, f"Give one of {choice}.")
    elif table.cage == "caged" and table.series not in known:
        remedy = did_you_mean(table.series or "", known) or 'Or choose model = "palmgren".'
        reason = f"is not in the table; the series of {table.type} bearings are {choice}."
        yield Problem("series", written(table.series), reason, remedy)


def _own_table_problems(table: ShaftBearingTable | SealTable) -> Iterator[Problem]:
    """Problems of the loss table of an element, and of one that is missing or idle."""
    if table.model == "table" and table.table is None:
        reason = "needs a table of friction torque or power."
        yield Problem("model", '"table"', reason, "Add table, or choose another model.")
    elif table.model == "table" and table.table is not None:
        for found in loss_table_problems(table.table, table.TABLE_AXES):
            yield replace(found, key=f"table.{found.key}".rstrip("."))
    elif table.table is not None:
        yield Problem("table", "", 'belongs to model = "table".', "Delete it, or choose that.")


def loss_table_problems(table: LossTableTable, axes: Collection[str]) -> Iterator[Problem]:
    """What contradicts itself in a table of torque or power that may have `axes`."""
    from epicyclic.losses.loss_table import table_problems

    contents = [key for key in ("torque", "power", "file") if getattr(table, key) is not None]
    given = table.axes()
    foreign = [name for name in given if name not in axes]
    if len(contents) != 1:
        reason = "must have exactly one of torque, power and file."
        key = contents[0] if contents else ""
        yield Problem(key, " and ".join(contents), reason, "Give one of them.")
        return
    for name in foreign:
        reason = "is not a valid axis here: only bearings carry a load."
        yield Problem(name, "", reason, "Delete it.")
    if contents == ["file"]:
        for name in given:
            reason = "is given together with file, which has its own axes."
            yield Problem(name, "", reason, "Delete it.")
    elif not foreign:
        yield from table_problems(table.quantity, given, getattr(table, table.quantity))


class ElementTables(Table):
    """Elements that a train adds, each kind by the names of its tables: ``[bearings.NAME]``."""

    bearings: dict[str, ShaftBearingTable] = Field(default={})
    seals: dict[str, SealTable] = Field(default={})
    clutches: dict[str, ClutchTable] = Field(default={})
    drags: dict[str, DragTable] = Field(default={})


# How they stand in a train.


def between(
    table: ElementTable,
    shafts: Mapping[str, str],  # The bodies beside the housing, by all their names.
) -> tuple[str, str]:
    """The bodies that a part is between; raises `InputError` for unknown ones."""
    names = table.bodies
    known = {**shafts, HOUSING: HOUSING}
    reason = f"is not a shaft; the shafts are {', '.join(dict.fromkeys(known.values()))}."
    raise_any(
        Problem(key, written(body), reason, did_you_mean(body, known) or "Check the name.")
        for key, body in names.items()
        if body not in known
    )
    first, second = (known[name] for name in names.values())
    if first == second:
        reason = f"is the same shaft, {first}, under another name, so there is no relative motion."
        key, name = list(names.items())[1]
        raise one_problem(key, written(name), reason, "Name another shaft.")
    return first, second


def _loss_table(own: LossTableTable, folder: Path, prefix: str, axes: Collection[str]) -> LossTable:
    from epicyclic.losses.loss_table import LossTable, read_loss_table

    if own.file is None:
        points = {name: np.asarray(given) for name, given in own.axes().items()}
        return LossTable(own.quantity, points, np.asarray(getattr(own, own.quantity), dtype=float))
    key, shown = f"{prefix}file", written(own.file)
    try:
        found = read_loss_table(folder / own.file)
    except InputError as error:
        whole = [
            (" ".join(part for part in (one.key, one.value, one.allowed) if part), one.remedy)
            for one in error.problems
        ]
        raise InputError(Problem(key, shown, *what) for what in whole) from None
    if not set(found.names) <= set(axes):
        reason = f"may only have the axes {' and '.join(axes)}."
        raise one_problem(key, shown, reason, "Delete the column radial_force.")
    return found
