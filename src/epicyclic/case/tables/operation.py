"""Tables of a case file on how it runs: operating point, oil, surroundings."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from epicyclic.case.tables.base import NamedOil, Table, option
from epicyclic.units import Number, Pressure, RotationalSpeed, Temperature, Torque

Member = Literal["sun", "ring", "carrier"]


_ANY_OPERATION: dict[str, object] = {
    "torque": "0 N*m",
    "speed": "0 rpm",
    "oil_inlet_temperature": "40 degC",
}


class PlanetaryOperation(Table):
    """How the gear set runs."""

    STAND_INS = _ANY_OPERATION
    EXACTLY_ONE = (("fixed", "second_input+second_speed"),)

    input: Member = Field(description="The member to which torque and speed belong.")
    fixed: Member | None = option(None, "The member held still; the third one is the output.")
    second_input: Member | None = option(None, "Instead of fixed: a second member of given speed.")
    second_speed: RotationalSpeed | None = option(
        None, "Speed of the second member; same sign = same sense of rotation."
    )
    torque: Torque = Field(
        description="On the input member; negative = coasting, power flows back through it."
    )
    speed: RotationalSpeed = Field(description="Of the input member.")
    oil_inlet_temperature: Temperature = Field(description="Oil temperature at all contacts.")


class GearPairOperation(Table):
    """How the gear pair runs."""

    STAND_INS = _ANY_OPERATION

    torque: Torque = Field(description="On the pinion; negative = coasting.")
    speed: RotationalSpeed = Field(description="Of the pinion.")
    oil_inlet_temperature: Temperature = Field(description="Oil temperature at all contacts.")


class Lubricant(Table):
    """The oil."""

    STAND_INS: ClassVar[dict[str, object]] = {"pressure_viscosity_factor": None}

    oil: NamedOil = Field(
        description="A name of the oil library (epicyclic oils), a table of properties, or in "
        'short { iso_vg = 220, kind = "mineral" }.'
    )
    pressure_viscosity_factor: Number = option(
        1.0, "Multiplies the pressure-viscosity coefficient of the oil.", ge=0.1, le=10
    )


class Surroundings(Table):
    """What surrounds the gears."""

    oil_air_ratio: Number = option(0.05, "Oil share by volume at ambient pressure.", ge=0, le=1)
    pressure: Pressure = option("1.01325 bar", "Ambient pressure.")
