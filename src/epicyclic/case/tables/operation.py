"""Tables of a case file on how it runs: operating point, oil, heat; and their checks."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from epicyclic.case.tables.base import NamedOil
from epicyclic.errors import Problem
from epicyclic.messages import did_you_mean
from epicyclic.schema.fields import Table, option
from epicyclic.units import (
    CELSIUS,
    LITRE,
    Angle,
    Area,
    BodyCapacity,
    Conductance,
    HeatTransfer,
    Length,
    Mass,
    Number,
    Power,
    Pressure,
    Quantity,
    RotationalSpeed,
    Speed,
    Temperature,
    Torque,
    Volume,
    VolumeFlow,
)

Member = Literal["sun", "ring", "carrier"]

ANY_OPERATION: dict[str, object] = {
    "torque": "0 N*m",
    "speed": "0 rpm",
    "oil_inlet_temperature": "40 degC",
}


class PlanetaryOperation(Table):
    """How the gear set runs."""

    STAND_INS = ANY_OPERATION
    EXACTLY_ONE = (("fixed", "second_input+second_speed"),)

    input: Member = Field(description="The member to which torque and speed belong.")
    fixed: Member | None = option("The member that is held; the third one is the output.")
    second_input: Member | None = option("Instead of fixed: a second member with a given speed.")
    second_speed: RotationalSpeed | None = option(
        "Speed of the second member; equal signs mean the same sense of rotation."
    )
    torque: Torque = Field(
        description="Torque on the input member; negative: coasting, power flows back through it."
    )
    speed: RotationalSpeed = Field(description="Speed of the input member.")
    oil_inlet_temperature: Temperature = Field(description="Oil temperature at the inlet.")


class GearPairOperation(Table):
    """How the gear pair runs."""

    STAND_INS = ANY_OPERATION

    torque: Torque = Field(description="Torque on the pinion; negative: coasting.")
    speed: RotationalSpeed = Field(description="Speed of the pinion.")
    oil_inlet_temperature: Temperature = Field(description="Oil temperature at the inlet.")


class Lubricant(Table):
    """The oil."""

    STAND_INS: ClassVar[dict[str, object]] = {"pressure_viscosity_factor": None}

    oil: NamedOil = Field(
        description="A name of the oil library (epicyclic oils), a table of properties, or in "
        'short { iso_vg = 220, kind = "mineral" }.'
    )
    pressure_viscosity_factor: Number = option(
        "Multiplies the pressure-viscosity coefficient of the oil.", 1.0, ge=0.1, le=10
    )


class Surroundings(Table):
    """What surrounds the gears."""

    oil_air_ratio: Number = option("Share of oil by volume at ambient pressure.", 0.05, ge=0, le=1)
    pressure: Pressure = option("Ambient pressure.", "1.01325 bar")


# Tables of a case file on heat: how gears are wetted, where heat leaves, what stores it.


class HousingTable(Table):
    """The housing as ISO/TR 14179 sees it."""

    method: Literal["iso-14179-2", "iso-14179-1"] = option(
        "iso-14179-2: convection and radiation from shape and air; iso-14179-1: coefficient times "
        "area.",
        "iso-14179-2",
    )
    area: Area = Field(description="Outer surface without fins.")
    inner_area: Area | None = option("Inner surface wetted by oil. Default: area.")
    height: Length | None = option("Default: the height of a cube of this area.")
    length: Length | None = option("Length along the air flow. Default: height.")
    air_speed: Speed = option("Speed of the air past the housing; 0: free convection.", "0 m/s")
    emissivity: Number = option("0.9 painted, 0.15 to 0.25 bare aluminium.", 0.9, ge=0, le=1)
    fin_factor: Number = option(
        "Factor on the convection for area and efficiency of fins.", 1.0, ge=1, le=20
    )
    inner_coefficient: HeatTransfer = option("From the oil to the wall (splash).", "200 W/(m^2*K)")
    coefficient: HeatTransfer = option(
        "k of iso-14179-1, oil to air: 10-14 in small rooms, 17-20 in large ones, 19-24 outdoors.",
        "15 W/(m^2*K)",
    )
    foundation: Conductance = option("To the foundation, at ambient temperature.", "0 W/K")
    mass: Mass | None = option("Mass of the housing, for warming up.")
    heat_capacity_ratio: Number = option(
        "Specific heat of its material over that of steel: 1.95 for aluminium.", 1.0, gt=0, le=10
    )


class ConductanceTable(Table):
    """One heat path, as 'epicyclic heat' names it."""

    value: Conductance | None = option("Instead of the computed one.")
    scale: Number = option("Multiplies it.", 1.0, ge=0, le=1000)


class CapacityTable(Table):
    """What one part stores, for warming up; parts as 'epicyclic warm-up' names them."""

    value: BodyCapacity | None = option("Instead of the computed one.")
    scale: Number = option("Multiplies it.", 1.0, gt=0, le=1000)


class ThermalTable(Table):
    """Generation and removal of heat, for models.temperatures other than inlet."""

    REPLACING = (("oil_flow", "oil_outlet_temperature"),)

    lubrication: Literal["spray", "dip", "spray-and-dip", "submerged"] = option(
        "How the oil reaches the gears.", "spray"
    )
    bulk: Literal["iso-6336-20", "iso-6336-22"] = option(
        "For flank; iso-6336-20: from the flash temperature of the meshes of each gear; "
        "iso-6336-22: from their loss, equal for both gears.",
        "iso-6336-20",
    )
    oil_flow: VolumeFlow | None = option("Flow of the oil through a tank or cooler and back.")
    oil_outlet_temperature: Temperature | None = option(
        "Measured temperature of the leaving oil, instead of oil_flow, which follows from it."
    )
    jet_effectiveness: Number = option(
        "Share of the temperature difference that oil on a gear takes up (estimate: 0.25 to 1).",
        0.5,
        ge=0,
        le=1,
    )
    jet_shares: dict[str, Number] = option(
        "Shares of the oil from jets that reach a gear, pin or bearing; the others get the rest. "
        "Default: in proportion to their heat.",
        {},
    )
    bath_share: Number = option(
        "Immersed share of the surface of a gear, with dip (estimate).", 0.3, gt=0, le=1
    )
    ambient_temperature: Temperature = option("Air around the housing.", "20 degC")
    cooler_power: Power = option("Heat that a cooler removes from the oil.", "0 W")
    cooler_conductance: Conductance = option("From the oil in the sump to the coolant.", "0 W/K")
    coolant_temperature: Temperature = option("That of the cooler in the sump.", "40 degC")
    press_fit: HeatTransfer = option(
        "Contact conductance of press fits and splines (1000 to 5000).", "2000 W/(m^2*K)"
    )
    shaft_conductance: Conductance = option(
        "Along a shaft from each gear or bearing on it, in trains (estimate).", "1 W/K"
    )
    conductances: dict[str, ConductanceTable] = option(
        "Changes to single heat paths, by their names.", {}
    )
    capacities: dict[str, CapacityTable] = option(
        "Changes to the heat capacities of single parts, by their names.", {}
    )
    oil_volume: Volume | None = option("Oil volume in the gearbox, for warming up.")
    housing: HousingTable | None = option("Default: no heat leaves through it.")

    def __hash__(self) -> int:  # the tables of names cannot be hashed
        return hash((self.lubrication, self.oil_flow, self.ambient_temperature, self.housing))


ROUNDING = 1e-9  # Rounding of shares that add up to 1. [1]


def check_thermal(thermal: ThermalTable) -> list[Problem]:
    """What [thermal] states twice, or more of than there is."""
    problems = []
    if thermal.oil_flow is not None and thermal.oil_outlet_temperature is not None:
        key = "thermal.oil_flow, thermal.oil_outlet_temperature"
        allowed = "determine each other through the heat that the oil carries away."
        problems.append(Problem(key, "", allowed, "Give one of them."))
    for name, share in thermal.jet_shares.items():
        if not 0 <= share <= 1:
            allowed = "must be a number >= 0 and <= 1."
            remedy = "Give the share of the oil flow that reaches it."
            problems.append(Problem(f"thermal.jet_shares.{name}", f"{share:g}", allowed, remedy))
    whole = sum(thermal.jet_shares.values())
    if not problems and whole > 1 + ROUNDING:
        allowed = f"add up to {whole:g}, which exceeds the whole oil flow."
        remedy = f"Divide each by {whole:g}, or leave some out."
        problems.append(Problem("thermal.jet_shares", "", allowed, remedy))
    return problems


def check_outlet(thermal: ThermalTable, inlet: float | None) -> Iterator[Problem]:
    """The oil must leave warmer than it comes."""
    outlet = thermal.oil_outlet_temperature
    if outlet is not None and inlet is not None and outlet <= inlet:
        allowed = f"must be above operation.oil_inlet_temperature, {CELSIUS.text(inlet)}: the oil "
        allowed += "carries the heat of the losses away."
        remedy = "Correct one of them, or give thermal.oil_flow."
        yield Problem("thermal.oil_outlet_temperature", CELSIUS.text(outlet), allowed, remedy)


def check_ways_out(
    thermal: ThermalTable, temperatures: str, oil: LubricationTable | None
) -> Iterator[Problem]:
    """A network needs a way for the heat to leave."""
    flow = oil.oil_flow if thermal.oil_flow is None and oil else thermal.oil_flow
    ways = (thermal.oil_outlet_temperature, thermal.housing, thermal.cooler_conductance)
    if temperatures == "network" and not flow and not any(ways):
        allowed = 'leaves no path out for the heat, which models.temperatures = "network" needs.'
        remedy = "Give thermal.oil_flow or thermal.oil_outlet_temperature, [thermal.housing] with "
        remedy += "its area, or thermal.cooler_conductance."
        yield Problem("thermal", "", allowed, remedy)


Method = Literal["jet", "spray", "flow", "drained", "dip", "submerged", "grease"]
SHARE_KEY = "surroundings.oil_air_ratio"
OWN_SHARE_KEY = "lubrication.oil_share"
FACTOR_KEY = "lubrication.oil_share_factor"
"""The keys that say how uncertain the share of oil is: given, or as the method has it."""
WETTING: Mapping[Method, tuple[str, ...]] = {
    "jet": ("spray", "spray-and-dip"),
    "spray": ("spray", "spray-and-dip"),
    "flow": ("spray", "spray-and-dip"),
    "drained": ("spray",),
    "dip": ("dip", "spray-and-dip"),
    "submerged": ("submerged",),
    "grease": ("spray",),
}
"""What thermal.lubrication is with each method if it is not given, and what else it may be."""
_Sump = Annotated[float, Quantity("a volume", "m^3", "l", low=0.0, high=1e6, open_low=True)]
_Level = Annotated[float, Quantity("a height", "m", "mm", low=-1e5, high=1e5)]


class LubricationTable(Table):
    """Oil supply of the gears: gives the share of oil around them, and their churning."""

    REPLACING = (("oil_level", "immersion"), ("oil_share", "oil_share_factor"))
    STAND_INS: ClassVar[dict[str, object]] = dict.fromkeys(
        ("jet_speed", "nozzle_side", "churning", "oil_share_factor")
    )

    method: Method = Field(
        description="drained: mist only; flow: oil fed through shafts or carrier; dip: some of "
        "the gears dip into the sump; grease: lubricant.oil is its base oil."
    )
    oil_flow: VolumeFlow | None = option("From jet, spray or flow to the gears of one set.")
    jet_speed: Speed = option(
        "Speed of the jets in the direction of the teeth; 0: unknown, or across.", "0 m/s"
    )
    nozzle_side: Literal["in-mesh", "out-of-mesh", "radial"] = option(
        "Jets into the mesh with the teeth, out of it against them, or radial.", "in-mesh"
    )
    oil_level: _Level | None = option(
        "With dip: level at rest above the axis of the set or both axes of a pair; negative: below."
    )
    immersion: dict[str, Length] = option(
        "With dip, instead of oil_level: depth of the lowest point of each gear, or of the "
        "carrier, below the level of the oil at rest.",
        {},
    )
    oil_volume: _Sump | None = option("With dip: oil in the sump. Default: thermal.oil_volume.")
    churning: Literal["changenet-velex", "iso-14179-1"] = option("With dip.", "changenet-velex")
    oil_share: Number | None = option(
        "Share of oil by volume around the gears, if known. Default: an estimate by method.",
        ge=0,
        le=1,
    )
    oil_share_factor: Number = option("Factor on that estimate, at most to 1.", 1.0, gt=0, le=100)

    def __hash__(self) -> int:  # a table of names cannot be hashed
        return hash((self.method, self.oil_flow, self.oil_level, self.oil_share_factor))


class HousingLevel(Table):
    """One level of oil at rest for all sets of a train that dip and state none of their own."""

    EXACTLY_ONE = (("oil_level", "oil_depth+bottom"),)

    oil_level: _Level | None = option("Above the axis of shaft; negative: below.")
    oil_depth: Length | None = option("Instead: above the lowest point inside the housing.")
    bottom: Length | None = option("With oil_depth: how far that point lies below the axis.")
    shaft: str | None = option("The shaft from which they count. Default: operation.input.")
    tilt: Angle = option(
        "Turns the gearbox about its shafts, in the sense of direction, over a level oil.", "0 deg"
    )

    @property
    def height(self) -> float:
        """The level above the axis of the shaft. [m]"""
        if self.oil_level is not None:
            return self.oil_level
        assert self.oil_depth is not None
        assert self.bottom is not None
        return self.oil_depth - self.bottom


LUBRICATION: Any = option("If given, surroundings.oil_air_ratio has no effect.")
"""The field of a case."""

_EVERY = {"method", "oil_share", "oil_share_factor"}
_KEYS: Mapping[Method, Collection[str]] = {
    "jet": ("oil_flow", "jet_speed", "nozzle_side"),
    "spray": ("oil_flow",),
    "flow": ("oil_flow",),
    "drained": (),
    "dip": ("oil_level", "immersion", "oil_volume", "churning"),
    "submerged": (),
    "grease": (),
}
"""Keys that have an effect with each method."""


def check_lubrication(table: LubricationTable) -> Iterator[Problem]:
    """Keys that another method needs, and those that its own one lacks."""
    method, given = table.method, _stated(table)
    for key in sorted(given - _EVERY - set(_KEYS[method])):
        users = [f'"{name}"' for name, keys in _KEYS.items() if key in keys]
        allowed = f'has no effect with method = "{method}"; it belongs to {" or ".join(users)}.'
        yield Problem(f"lubrication.{key}", "", allowed, "Remove it, or change method.")
    if method == "jet" and table.oil_flow is None:
        for key in sorted(given & {"jet_speed", "nozzle_side"}):
            allowed = "has no effect without oil_flow, the flow of the jets."
            remedy = 'Give that, as oil_flow = "2 l/min", or remove this key.'
            yield Problem(f"lubrication.{key}", "", allowed, remedy)
    if method == "flow" and table.oil_flow is None:
        allowed = 'is missing, but method = "flow" needs it.'
        yield Problem("lubrication.oil_flow", "", allowed, 'Give it, as "2 l/min".')
    if table.oil_share is not None and "oil_share_factor" in given:
        key = "lubrication.oil_share, lubrication.oil_share_factor"
        allowed = "exclude each other, because the factor applies to the estimate of the method."
        yield Problem(key, "", allowed, "Give one of them.")
    if table.oil_level is not None and table.immersion:
        key = "lubrication.oil_level, lubrication.immersion"
        yield Problem(key, "", "state the same thing twice.", "Give one of them.")


def needs_level(table: LubricationTable) -> bool:
    """Whether its set dips, and nothing in the table says how deep."""
    return table.method == "dip" and table.oil_level is None and not table.immersion


def check_level(table: LubricationTable) -> Iterator[Problem]:
    """Dipping needs to know how deep."""
    if needs_level(table):
        allowed = 'is missing, but method = "dip" needs it, or immersion.'
        remedy = 'Give it from the axis of the set, as "-30 mm", or immersion = { sun = "5 mm" }.'
        yield Problem("lubrication.oil_level", "", allowed, remedy)


def _stated(table: LubricationTable) -> set[str]:
    """Keys that were given other values than their defaults."""
    usual = LubricationTable(method=table.method)
    return {key for key in table.model_fields_set if getattr(table, key) != getattr(usual, key)}


def check_sump(table: LubricationTable, thermal: ThermalTable) -> Iterator[Problem]:
    """Dipping needs the volume of the oil, once."""
    own, other = table.oil_volume, thermal.oil_volume or None
    if table.method != "dip":
        return
    if own is None and other is None:
        allowed = 'is missing, but method = "dip" needs it.'
        yield Problem("lubrication.oil_volume", "", allowed, 'Give it, as "1.5 l".')
    elif own is not None and other is not None and own != other:
        key, shown = "lubrication.oil_volume, thermal.oil_volume", map(LITRE.text, (own, other))
        reason = "are the same volume, but differ."
        yield Problem(key, ", ".join(shown), reason, "Give one of them.")


def check_wetting(table: LubricationTable, thermal: ThermalTable) -> Iterator[Problem]:
    """The temperatures must see the oil as the losses do."""
    wetting = WETTING[table.method]
    if "lubrication" in thermal.model_fields_set and thermal.lubrication not in wetting:
        fitting = " or ".join(f'"{name}"' for name in wetting)
        allowed = f'contradicts lubrication.method = "{table.method}", which implies {fitting}.'
        remedy = "Remove it, because it follows from the method."
        yield Problem("thermal.lubrication", f'"{thermal.lubrication}"', allowed, remedy)


def check_immersion(table: LubricationTable, parts: Collection[str]) -> Iterator[Problem]:
    """Depths of parts that can churn."""
    for name in table.immersion:
        if name not in parts:
            allowed = f"is not a part whose churning is computed; these are {', '.join(parts)}."
            remedy = did_you_mean(name, parts) or "Name one of these; planets are left out."
            yield Problem(f"lubrication.immersion.{name}", "", allowed, remedy)
