"""Tables of a case file on the parts beside the gears: bearings and carrier."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from epicyclic.case.schema import NamedMaterial, Roughness, ShortLength, Table
from epicyclic.units import Length, Number, SmallLength, as_stated


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
