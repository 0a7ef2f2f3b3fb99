"""What follows from how oil gets to the gears: the share of oil around them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from epicyclic import library
from epicyclic.case.tables.operation import (
    OWN_SHARE_KEY,
    SHARE_KEY,
    WETTING,
    LubricationTable,
    Surroundings,
    ThermalTable,
)

_BAND = 1.96
"""Half the width of a band of 95 %, in standard deviations of a normal distribution. [1]"""


class Lubricated(Protocol):
    """A case, or a set of a train."""

    @property
    def lubrication(self) -> LubricationTable | None:
        """How oil gets to its gears, if it says so."""

    @property
    def surroundings(self) -> Surroundings:
        """What surrounds them."""


@dataclass(frozen=True, slots=True)
class OilShare:
    """The share of oil by volume around gears."""

    share: float  # [1]
    source: str  # Where it is from; of a given one the key.
    grade: str = "given"  # ``"given"``, ``"read"`` or ``"estimate"``.
    # Two thirds of all gearboxes lie within this factor, either way; 1 for a given share. [1]
    factor: float = 1.0

    @property
    def band(self) -> tuple[float, float]:
        """95 % of all gearboxes."""
        width = self.factor**_BAND
        return self.share / width, min(1.0, self.share * width)


def oil_share(case: Lubricated) -> OilShare:
    """The share of oil around the gears of a case. Theory (N1)."""
    table = case.lubrication
    if table is None:
        return OilShare(case.surroundings.oil_air_ratio, SHARE_KEY)
    if table.oil_share is not None:
        return OilShare(table.oil_share, OWN_SHARE_KEY)
    known = library.lubrication_methods()[table.method]
    share = min(1.0, table.oil_share_factor * known["oil_share"])
    return OilShare(share, known["source"], known["grade"], known["lognormal_factor"])


def with_lubrication(
    thermal: ThermalTable,
    table: LubricationTable | None,
    flow: float | None,  # Oil that is brought to all gears. [m^3/s]
) -> ThermalTable:
    """The table [thermal] with what [lubrication] says of the oil, where it says nothing itself."""
    if table is None:
        return thermal
    found: dict[str, object] = {}
    if "lubrication" not in thermal.model_fields_set:
        found["lubrication"] = WETTING[table.method][0]
    if thermal.oil_flow is None and thermal.oil_outlet_temperature is None:
        found["oil_flow"] = flow
    if thermal.oil_volume is None:
        found["oil_volume"] = table.oil_volume
    return thermal.model_copy(update=found)
