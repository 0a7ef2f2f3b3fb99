"""Tables of a case file on heat, and their checks."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from epicyclic.case.tables.base import Table, option
from epicyclic.errors import Problem
from epicyclic.units import (
    CELSIUS,
    Area,
    BodyCapacity,
    Conductance,
    HeatTransfer,
    Length,
    Mass,
    Number,
    Power,
    Speed,
    Temperature,
    Volume,
    VolumeFlow,
)

# Tables of a case file on heat: how gears are wetted, where heat leaves, what stores it.


class HousingTable(Table):
    """The housing as ISO/TR 14179 sees it."""

    method: Literal["iso-14179-2", "iso-14179-1"] = option(
        "iso-14179-2",
        "iso-14179-2: convection and radiation from shape and air; iso-14179-1: coefficient times "
        "area.",
    )
    area: Area = Field(description="Outside, without fins.")
    inner_area: Area | None = option(None, "Wetted by oil. Default: area.")
    height: Length | None = option(None, "Default: that of a cube of the same area.")
    length: Length | None = option(None, "Along the air. Default: height.")
    air_speed: Speed = option("0 m/s", "Of the air past it; 0: free convection.")
    emissivity: Number = option(0.9, "0.9 painted, 0.15 to 0.25 bare aluminium.", ge=0, le=1)
    fin_factor: Number = option(
        1.0, "Multiplies the convection: area and effect of fins.", ge=1, le=20
    )
    inner_coefficient: HeatTransfer = option("200 W/(m^2*K)", "From the oil to the wall (splash).")
    coefficient: HeatTransfer = option(
        "15 W/(m^2*K)",
        "k of iso-14179-1, oil to air: 10-14 in small rooms, 17-20 in large ones, 19-24 outdoors.",
    )
    foundation: Conductance = option("0 W/K", "To what it stands on, at ambient temperature.")
    mass: Mass | None = option(None, "For warming up.")
    heat_capacity_ratio: Number = option(
        1.0, "Of its material over that of steel, by mass: aluminium 1.95.", gt=0, le=10
    )


class ConductanceTable(Table):
    """One way of the heat, as 'epicyclic heat' names it."""

    value: Conductance | None = option(None, "Instead of the computed one.")
    scale: Number = option(1.0, "Multiplies it.", ge=0, le=1000)


class CapacityTable(Table):
    """What one part stores, for warming up; parts as 'epicyclic warm-up' names them."""

    value: BodyCapacity | None = option(None, "Instead of the computed one.")
    scale: Number = option(1.0, "Multiplies it.", gt=0, le=1000)


class ThermalTable(Table):
    """How heat arises and leaves, for models.temperatures other than inlet."""

    lubrication: Literal["spray", "dip", "spray-and-dip", "submerged"] = option(
        "spray", "How oil gets to the gears."
    )
    bulk: Literal["iso-6336-20", "iso-6336-22"] = option(
        "iso-6336-20",
        "For flank: iso-6336-20: from the flash temperature of each gear's meshes; iso-6336-22: "
        "from their loss, both gears alike.",
    )
    oil_flow: VolumeFlow | None = option(
        None, "Of all oil that leaves for a tank or cooler and comes back."
    )
    oil_outlet_temperature: Temperature | None = option(
        None, "Instead of oil_flow, where it was measured: the flow follows."
    )
    jet_effectiveness: Number = option(
        0.5,
        "How far oil thrown on a gear reaches the temperature of the gear (estimate: 0.25 to 1).",
        ge=0,
        le=1,
    )
    jet_shares: dict[str, Number] = option(
        {},
        "Share of oil_flow that meets a gear, pin or bearing; what is left meets the others. "
        "Default: as much as its heat demands.",
    )
    bath_share: Number = option(
        0.3, "Share of the surfaces of a gear that dips into oil (estimate), with dip.", gt=0, le=1
    )
    ambient_temperature: Temperature = option("20 degC", "Of the air around the housing.")
    cooler_power: Power = option("0 W", "That a cooler takes from the oil.")
    cooler_conductance: Conductance = option("0 W/K", "Of a cooler in the sump, to its coolant.")
    coolant_temperature: Temperature = option("40 degC", "Of that coolant.")
    press_fit: HeatTransfer = option(
        "2000 W/(m^2*K)", "Contact conductance of press fits and splines (1000 to 5000)."
    )
    shaft_conductance: Conductance = option(
        "1 W/K", "Along a shaft, from each gear or bearing on it: trains (estimate)."
    )
    conductances: dict[str, ConductanceTable] = option(
        {}, "Changes to single ways of the heat, by their names."
    )
    capacities: dict[str, CapacityTable] = option(
        {}, "Changes to the heat capacities of single parts, by their names."
    )
    oil_volume: Volume | None = option(None, "For warming up.")
    housing: HousingTable | None = option(None, "Default: no heat leaves through it.")

    def __hash__(self) -> int:  # the tables of names cannot be hashed
        return hash((self.lubrication, self.oil_flow, self.ambient_temperature, self.housing))


# Checks of what a case states about heat.


ROUNDING = 1e-9
"""Rounding of shares that add up to 1. [1]"""


def check_thermal(thermal: ThermalTable) -> list[Problem]:
    """What [thermal] states twice, or more of than there is."""
    problems = []
    if thermal.oil_flow is not None and thermal.oil_outlet_temperature is not None:
        key = "thermal.oil_flow, thermal.oil_outlet_temperature"
        allowed = "determine each other, by the heat that the oil takes along."
        problems.append(Problem(key, "", allowed, "Give one of them."))
    for name, share in thermal.jet_shares.items():
        if not 0 <= share <= 1:
            allowed = "must be a number >= 0 and <= 1."
            remedy = "Give the part of the oil flow that meets it."
            problems.append(Problem(f"thermal.jet_shares.{name}", f"{share:g}", allowed, remedy))
    whole = sum(thermal.jet_shares.values())
    if not problems and whole > 1 + ROUNDING:
        allowed = f"add up to {whole:g}, more than all of the oil."
        remedy = f"Divide each by {whole:g}, or leave some out."
        problems.append(Problem("thermal.jet_shares", "", allowed, remedy))
    return problems


def check_outlet(thermal: ThermalTable, inlet: float | None) -> list[Problem]:
    """The oil must leave warmer than it comes."""
    outlet = thermal.oil_outlet_temperature
    if outlet is None or inlet is None or outlet > inlet:
        return []
    allowed = f"must be above operation.oil_inlet_temperature, {CELSIUS.text(inlet)}: the oil "
    allowed += "takes the heat of the losses along."
    remedy = "Correct one of them, or give thermal.oil_flow."
    return [Problem("thermal.oil_outlet_temperature", CELSIUS.text(outlet), allowed, remedy)]


def check_ways_out(
    thermal: ThermalTable,
    temperatures: str,
    flow: float | None,  # Oil that [lubrication] brings to the gears. [m^3/s]
) -> list[Problem]:
    """A network needs a way for the heat to leave."""
    ways = (
        flow if thermal.oil_flow is None else thermal.oil_flow,
        thermal.oil_outlet_temperature,
        thermal.housing,
        thermal.cooler_conductance,
    )
    if temperatures != "network" or any(ways):
        return []
    allowed = 'leaves no way out for the heat, which models.temperatures = "network" follows.'
    remedy = "Give thermal.oil_flow or thermal.oil_outlet_temperature, [thermal.housing] with its "
    remedy += "area, or thermal.cooler_conductance."
    return [Problem("thermal", "", allowed, remedy)]
