"""Tables of a case file on bearings, the carrier, seals and losses that the user tabulates."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field, Tag

from epicyclic.case.tables.base import (
    VALUES_OR_ROWS,
    NamedMaterial,
    PointsTable,
    Roughness,
    ShortLength,
    Table,
)
from epicyclic.units import Length, Number, Quantity, SmallLength, Temperature, as_stated

# Tables of a case file on the parts beside the gears: bearings and carrier.


class PlanetBearing(Table):
    """The roller bearing between planet and pin."""

    STAND_INS: ClassVar[dict[str, object]] = {
        "rows": 1,
        "roller_length": "1 mm",
        "roller_roughness": "1 um",
        "race_roughness": "1 um",
        "viscous_factor": None,
        "cage": None,
        "palmgren_coefficient": None,
        "crown_drop": None,
        "crown_length_fraction": None,
        "row_gap": None,
        "material": None,
    }

    rows: int = Field(ge=1, le=4)
    rollers_per_row: int = Field(ge=3, le=200)
    roller_diameter: Length
    roller_length: Length = Field(description="Effective length of one roller.")
    pin_diameter: Length = Field(description="Inner race. The bore follows.")
    diametral_clearance: SmallLength
    roller_roughness: Roughness
    race_roughness: Roughness
    viscous_factor: Number | None = Field(
        default=None,
        ge=0,
        le=100,
        description="f0 of the viscous loss, of the whole bearing: caged cylindrical 2.2-4 a row, "
        "needle up to 12. Default: 3 a row.",
    )
    cage: Literal["caged", "full-complement"] = "caged"
    palmgren_coefficient: Number | None = Field(
        default=None,
        gt=0,
        le=0.05,
        description="f1 of the method palmgren. Default: 0.0003 caged, 0.00055 full complement.",
    )
    crown_drop: SmallLength = Field(
        default=as_stated("3 um"), description="Drop of the profile at the roller's end (estimate)."
    )
    crown_length_fraction: Number = Field(
        default=0.2, ge=0, le=0.5, description="Crowned part of the length, at each end."
    )
    row_gap: ShortLength = Field(
        default=as_stated("0 mm"), description="Axial gap between the rollers of neighbouring rows."
    )
    material: NamedMaterial = Field(default=as_stated("steel"), description="Of rollers and races.")


class Carrier(Table):
    """The planet carrier as a disc, for its drag."""

    outer_diameter: Length
    width: Length


class ThrustBearing(Table):
    """A thrust bearing that carries no load worth counting, for its viscous loss."""

    mean_diameter: Length
    between: Literal[
        "sun-carrier", "sun-ring", "ring-carrier", "sun-housing", "carrier-housing"
    ] = Field(default="carrier-housing", description="The two parts whose speeds differ.")
    viscous_factor: Number = Field(default=3.5, ge=0, le=100, description="f0 (Harris).")
    count: int = Field(default=1, ge=1, le=10)


# Tables of a case file on shaft bearings, seals and losses that the user tabulates.


Force = Annotated[float, Quantity("a force", "N", "N", low=0.0, high=1e9)]
LoadRating = Annotated[float, Quantity("a load rating", "N", "N", low=0.0, high=1e9, open_low=True)]
Position = Annotated[float, Quantity("a position", "m", "mm", low=-1e5, high=1e5)]
ContactAngle = Annotated[
    float, Quantity("a contact angle", "rad", "deg", low=0.0, high=45.0, open_low=True)
]
SpeedDifference = Annotated[
    float, Quantity("a speed difference", "rad/s", "rpm", low=0.0, high=1e6)
]
ReferenceSpeed = Annotated[
    float, Quantity("a speed rating", "rad/s", "rpm", low=0.0, high=1e6, open_low=True)
]
DragTorque = Annotated[float, Quantity("a drag torque", "N*m", "N*m", low=0.0, high=1e9)]
LostPower = Annotated[float, Quantity("a power loss", "W", "W", low=0.0, high=1e9)]


Torques = Annotated[
    Annotated[tuple[DragTorque, ...], Tag("values")]
    | Annotated[tuple[tuple[DragTorque, ...], ...], Tag("rows")],
    VALUES_OR_ROWS,
]
Powers = Annotated[
    Annotated[tuple[LostPower, ...], Tag("values")]
    | Annotated[tuple[tuple[LostPower, ...], ...], Tag("rows")],
    VALUES_OR_ROWS,
]


class LossTableTable(PointsTable):
    """Friction torque or power over one or two quantities, or a CSV file of them.

    Between the points linear, beyond them constant and flagged.
    """

    AXES: ClassVar = ("speed", "temperature", "radial_force")

    speed: tuple[SpeedDifference, ...] | None = Field(
        default=None, description="Magnitudes of the speed difference, rising."
    )
    temperature: tuple[Temperature, ...] | None = Field(
        default=None, description="Of the oil, rising."
    )
    radial_force: tuple[Force, ...] | None = Field(
        default=None, description="On a bearing, rising."
    )
    torque: Torques | None = Field(
        default=None,
        description="Friction torque: one value, or one row, for each value of the first axis.",
    )
    power: Powers | None = Field(
        default=None, description="Power lost instead of the torque; needs the axis speed."
    )
    file: str | None = Field(
        default=None,
        max_length=1000,
        description="CSV file beside the case, its columns with units: speed [rpm],torque [N*m].",
    )


class DragTable(LossTableTable):
    """Drag of a clutch, a brake, a pump or another part, from a table."""

    between: tuple[str, str] = Field(
        description='The two shafts whose speeds differ; one of them may be "housing".'
    )


class BearingSealTable(Table):
    """Contact seals of a bearing after SKF, both together: K_S1 d_s^beta + K_S2."""

    counterface_diameter: Length = Field(description="d_s, on which the lips run.")
    factor: Number = Field(ge=0, le=10, description="K_S1, for mm and N mm.")
    exponent: Number = Field(ge=0, le=4, description="beta.")
    constant: DragTorque = Field(default=as_stated("0 N*m"), description="K_S2.")


class ShaftBearingTable(Table):
    """A rolling bearing of a shaft."""

    STAND_INS: ClassVar[dict[str, object]] = {
        "position": None,
        "width": None,
        "viscous_factor": None,
        "palmgren_coefficient": None,
        "flange_coefficient": None,
        "oil_level": None,
        "drag_variable": None,
        "sliding_friction": None,
        "minimum_load_factor": None,
        "reference_speed": None,
    }

    shaft: str = Field(description="The shaft in its bore.")
    against: str = Field(default="housing", description="The body that holds its outer ring.")
    type: Literal["deep-groove", "cylindrical", "tapered", "needle"]
    bore: Length
    outside_diameter: Length
    width: Length | None = Field(
        default=None, description="Needed for the drag of rollers in an oil bath."
    )
    cage: Literal["caged", "full-complement"] = Field(
        default="caged", description="full-complement: cylindrical and needle rollers only."
    )
    model: Literal["palmgren", "harris", "skf-2018", "table"] = Field(
        default="palmgren",
        description="skf-2018: needs series; harris: of ball bearings, static_load_rating.",
    )
    series: str | None = Field(
        default=None, max_length=20, description="For skf-2018: 62, 160; 2, 10, 22; 302, 320X; ..."
    )
    dynamic_load_rating: LoadRating | None = Field(
        default=None, description="C, for the minimum load of tapered and needle rollers."
    )
    static_load_rating: LoadRating | None = Field(
        default=None, description="C0, for ball bearings with harris and skf-2018."
    )
    contact_angle: ContactAngle | None = Field(
        default=None, description="Of a tapered roller bearing, instead of axial_factor."
    )
    axial_factor: Number | None = Field(
        default=None,
        gt=0,
        le=10,
        description="Y of a tapered roller bearing, 0.4 cot of the angle.",
    )
    position: Position | None = Field(
        default=None, description="Along the shaft; for its reactions from the gear forces."
    )
    locating: bool = Field(default=False, description="True if it takes axial force.")
    axial_sense: Literal["both", "positive", "negative"] = Field(
        default="both",
        description="In which sense of the shaft's axis a locating bearing holds the shaft.",
    )
    radial_force: Force | None = Field(
        default=None, description="Instead of the reaction to the gear forces."
    )
    axial_force: Force | None = Field(
        default=None, description="Beside radial_force. Default: none if radial_force is given."
    )
    viscous_factor: Number | None = Field(
        default=None,
        ge=0,
        le=100,
        description="f0 of palmgren and harris. Default: deep-groove 2, cylindrical 3 or 7.5 "
        "(full complement), tapered 6, needle 12.",
    )
    palmgren_coefficient: Number | None = Field(
        default=None,
        gt=0,
        le=0.05,
        description="f1 of palmgren. Default: 0.0003, full complement 0.00055, tapered 0.0004, "
        "needle 0.0005 (estimate).",
    )
    flange_coefficient: Number | None = Field(
        default=None,
        ge=0,
        le=0.05,
        description="f_f of cylindrical rollers under axial force. Default: 0.002 caged, "
        "0.003 full complement.",
    )
    lubrication: Literal["jet", "oil-bath", "grease", "oil-air"] = Field(
        default="jet", description="For skf-2018: how soon the contacts starve."
    )
    oil_level: ShortLength = Field(
        default=as_stated("0 mm"),
        description="Above the lowest point of the outer raceway, for skf-2018; 0: no bath.",
    )
    drag_variable: Number | None = Field(
        default=None,
        ge=0,
        le=0.01,
        description="V_M of skf-2018 at this oil level. Default: 0.0012 times the immersed share "
        "(estimate).",
    )
    sliding_friction: Number | None = Field(
        default=None,
        ge=0,
        le=0.5,
        description="mu_EHL of skf-2018. Default: 0.02 cylindrical, 0.002 tapered; balls by the "
        "oil: 0.05 mineral, 0.10 ATF, 0.04 others.",
    )
    seal: BearingSealTable | None = Field(
        default=None, description="Contact seals of the bearing, for skf-2018."
    )
    minimum_load_factor: Number | None = Field(
        default=None,
        gt=0,
        le=10,
        description="k_r of the product table. Default: 0.025 deep-groove, 0.15 cylindrical.",
    )
    reference_speed: ReferenceSpeed | None = Field(
        default=None, description="Of cylindrical rollers, for the minimum load."
    )
    table: LossTableTable | None = Field(default=None, description="For model = table.")


class SealTable(Table):
    """A radial lip seal on a shaft."""

    shaft: str = Field(description="The shaft under the lip.")
    against: str = Field(default="housing", description="The body that holds the seal.")
    diameter: Length = Field(description="Of the shaft under the lip.")
    model: Literal["iso-14179-1-viton", "iso-14179-1-buna-n", "iso-14179-2", "linke", "table"] = (
        Field(
            default="iso-14179-2",
            description="The formulas differ by a factor of 2 and more; the figures show all.",
        )
    )
    table: LossTableTable | None = Field(default=None, description="For model = table.")
