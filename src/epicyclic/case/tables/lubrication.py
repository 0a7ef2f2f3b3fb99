"""The table [lubrication]: how oil gets to the gears."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from epicyclic.case.tables.base import Table
from epicyclic.losses.drag import ChurningModel, NozzleSide
from epicyclic.units import Length, Number, Quantity, Speed, VolumeFlow, as_stated

Method = Literal["jet", "spray", "flow", "drained", "dip", "submerged"]
_Sump = Annotated[float, Quantity("a volume", "m^3", "l", low=0.0, high=1e6, open_low=True)]
_Level = Annotated[float, Quantity("a height", "m", "mm", low=-1e5, high=1e5)]


class LubricationTable(Table):
    """How oil gets to the gears: gives the share of oil around them, and their churning."""

    STAND_INS: ClassVar[dict[str, object]] = {
        "jet_speed": None,
        "nozzle_side": None,
        "churning": None,
        "oil_share_factor": None,
    }

    method: Method = Field(
        description="drained: mist only; flow: oil fed through shafts or carrier; dip: some of the "
        "gears reach into the sump."
    )
    oil_flow: VolumeFlow | None = Field(
        default=None, description="That jet, spray or flow brings to the gears of one set."
    )
    jet_speed: Speed = Field(
        default=as_stated("0 m/s"),
        description="Of the oil of jets, along the teeth; 0: not known, or across.",
    )
    nozzle_side: NozzleSide = Field(
        default="in-mesh",
        description="Jets with the teeth as they mesh, against them as they part, or radial.",
    )
    oil_level: _Level | None = Field(
        default=None,
        description="With dip: oil at rest above the axis of the set, or both axes of a pair; "
        "negative: below.",
    )
    immersion: dict[str, Length] = Field(
        default={},
        description="With dip, instead of oil_level: depth of the lowest point of each gear, or of "
        "the carrier, below the oil at rest.",
    )
    oil_volume: _Sump | None = Field(
        default=None, description="With dip: in the sump. Default: thermal.oil_volume."
    )
    churning: ChurningModel = Field(default="changenet-velex", description="With dip.")
    oil_share: Number | None = Field(
        default=None,
        ge=0,
        le=1,
        description="Share of oil by volume around the gears, where it is known. Default: an "
        "estimate by method.",
    )
    oil_share_factor: Number = Field(
        default=1.0,
        gt=0,
        le=100,
        description="Multiplies that estimate, at most to 1.",
    )

    def __hash__(self) -> int:  # a table of names cannot be hashed
        return hash((self.method, self.oil_flow, self.oil_level, self.oil_share_factor))


LUBRICATION: Any = Field(
    default=None, description="With it surroundings.oil_air_ratio has no effect."
)
"""The field of a case."""
