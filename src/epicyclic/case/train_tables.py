"""Tables of a case file on trains: sets, shafts, states, operation."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, GetJsonSchemaHandler
from pydantic_core import CoreSchema

from epicyclic import units
from epicyclic.case import gear_tables
from epicyclic.case.tables.elements import (
    Carrier,
    FromDigits,
    PlanetBearing,
    PlanetPin,
    Position,
    ThrustBearing,
)
from epicyclic.case.tables.models import (
    GearPairLosses,
    GearPairModels,
    LoadSharing,
    LossOption,
    Numerics,
    PlanetaryLosses,
    PlanetaryModels,
)
from epicyclic.case.tables.operation import ANY_OPERATION, LUBRICATION, LubricationTable
from epicyclic.schema.fields import Table, option

Efficiency = Annotated[units.Number, Field(gt=0, le=1)]


class GivenPlanet(Table):
    """The planets of a set of given efficiency."""

    teeth: int | None = option("Default: half the difference of ring and sun.", ge=5, le=2000)
    count: int = option("Number of planets.", 3, ge=1, le=99)


class GivenListedGear(gear_tables.GivenGear):
    """A gear of a listed set of given efficiency."""

    body: str | None = option("Gears with the same body turn together. Default: its own.")
    planet: bool | None = option(
        "true: the gear is on the carrier. Default: as the meshes and shafts suggest."
    )


class PlanetarySet(Table):
    """A planetary set whose losses are computed: the tables of a planetary case."""

    gears: gear_tables.Gears
    sun: gear_tables.GearTable
    planet: gear_tables.Planet
    ring: gear_tables.Ring
    sun_mesh: gear_tables.SetMesh = gear_tables.SetMesh()
    ring_mesh: gear_tables.SetMesh = gear_tables.SetMesh()
    planet_bearing: PlanetBearing | None = None
    planet_pin: PlanetPin | None = None
    load_sharing: LoadSharing = LoadSharing()
    carrier: Carrier | None = None
    thrust_bearing: ThrustBearing | None = None
    hand: Literal["right", "left"] = option(
        "Hand of the helix of the sun, for the forces on shaft bearings.", "right"
    )
    lubrication: LubricationTable | None = LUBRICATION
    models: PlanetaryModels = PlanetaryModels()
    numerics: Numerics = Numerics()
    losses: PlanetaryLosses = PlanetaryLosses()


class GivenPlanetarySet(Table):
    """A planetary set of given efficiency."""

    EXACTLY_ONE = (("efficiency", "mesh_efficiency"),)

    sun: gear_tables.Teeth
    ring: gear_tables.GivenRing
    planet: GivenPlanet = GivenPlanet()
    efficiency: Efficiency | None = option("Efficiency from sun to ring with the carrier at rest.")
    mesh_efficiency: Efficiency | None = option(
        "Efficiency of each of the two meshes with the carrier at rest."
    )


class PairSet(Table):
    """A gear pair whose losses are computed: the tables of a case of a pair."""

    gears: gear_tables.Gears
    pinion: gear_tables.GearTable
    gear: gear_tables.PairGear
    mesh: gear_tables.SetMesh = gear_tables.SetMesh()
    direction: units.Angle = option(
        "From the axis of the pinion to that of the gear, for the forces on shaft bearings.",
        "0 deg",
    )
    hand: Literal["right", "left"] = option("Helix of the pinion, likewise.", "right")
    lubrication: LubricationTable | None = LUBRICATION
    models: GearPairModels = GearPairModels()
    numerics: Numerics = Numerics()
    losses: GearPairLosses = GearPairLosses()


class GivenPair(Table):
    """A gear pair of given efficiency."""

    pinion: gear_tables.Teeth
    gear: gear_tables.GivenGear
    efficiency: Efficiency


class ListedGear(GivenListedGear, gear_tables.PairGear):
    """A gear of a listed set whose losses are computed."""

    normal_module: units.Length | None = option("Default: of [gears].")
    transverse_module: units.Length | None = option("Default: of [gears].")
    normal_pressure_angle: gear_tables.PressureAngle | None = option("Default: of [gears].")
    transverse_pressure_angle: gear_tables.PressureAngle | None = option("Default: of [gears].")
    helix_angle: units.HelixAngle | None = option("Default: of [gears].")
    hand: Literal["right", "left"] | None = option(
        "Hand of the helix. Default: right for the first gear, the others as their mates "
        "require, the same for gears of one body."
    )
    mass: units.Mass | None = option(
        "Mass of one planet with its rollers, given at one of the gears of its body; its "
        "centrifugal force loads the planet bearing. Default: from its dimensions."
    )
    axial_position: Position | None = option(
        "Distance of the middle of its face from the middle of the planet bearing. Default: "
        "gears of one body side by side, in the order of meshes."
    )


class ListedMesh(gear_tables.SetMesh):
    """What belongs to one mesh of a listed set, ``[sets.NAME.mesh.GEAR-GEAR]``."""

    center_distance: units.Length | None = option(
        "Default: the one in [gears], that of another mesh of the same planet with a central "
        "gear, or from the profile shifts, x."
    )
    direction: units.Angle = option(
        "For fixed axes: direction from the axis of the first gear of the pair to that of the "
        "second, for the forces on shaft bearings.",
        "0 deg",
    )


class GivenMesh(Table):
    """One mesh of a listed set of given efficiency, ``[sets.NAME.mesh.GEAR-GEAR]``."""

    efficiency: Efficiency = Field(description="With the carrier at rest.")


MeshPair = tuple[str, str]


class _Listed(Table):
    """A set whose gears and meshes are listed."""

    planets: int | None = option("Number of planets of each kind; none: fixed axes.", ge=1, le=99)
    meshes: tuple[MeshPair, ...] = Field(min_length=1, description="Pairs of gears.")

    @classmethod
    def __get_pydantic_json_schema__(
        cls, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """In a file the tables of the gears stand in ``gears``, beside what all gears share."""
        found = handler.resolve_ref_schema(handler(schema))
        properties = found["properties"]
        members = properties.pop("members")
        shared = properties.get("gears")
        known = handler.resolve_ref_schema(shared)["properties"] if shared is not None else {}
        properties["gears"] = {
            "type": "object",
            "properties": known,
            "additionalProperties": members["additionalProperties"],
        }
        found["required"] = ["meshes", "gears"]
        return found


class ListedSet(_Listed):
    """A set whose gears and meshes are listed, with computed losses."""

    gears: gear_tables.SharedGears = gear_tables.SharedGears()
    members: dict[str, ListedGear]
    mesh: dict[str, ListedMesh] = Field(default={})
    planet_bearing: PlanetBearing | None = option(
        "Bearing of every planet that planet_bearings does not name."
    )
    planet_bearings: dict[str, PlanetBearing] = option("Bearings by the body of the planet.", {})
    planet_pin: PlanetPin | None = option("Plain pin of planets without such a bearing.")
    load_sharing: LoadSharing = LoadSharing()
    carrier: Carrier | None = None
    lubrication: LubricationTable | None = LUBRICATION
    models: PlanetaryModels = PlanetaryModels()
    numerics: Numerics = Numerics()
    losses: dict[str, LossOption] = Field(default={})


class GivenListedSet(_Listed):
    """A set whose gears and meshes are listed, with given efficiencies."""

    members: dict[str, GivenListedGear]
    mesh_efficiency: Efficiency = Field(description="That of every mesh, carrier at rest.")
    mesh: dict[str, GivenMesh] = Field(default={})


ComputedSet = PlanetarySet | PairSet | ListedSet
SetTable = PlanetarySet | PairSet | ListedSet | GivenPlanetarySet | GivenPair | GivenListedSet


GIVEN = ("efficiency", "mesh_efficiency")
"""Keys with which no loss of a set is computed."""


def form_of_set(raw: dict[str, Any]) -> tuple[type[Table] | None, dict[str, Any]]:
    """The form of a set, None if it has no gears yet, and its tables in that form."""
    given = any(key in raw for key in GIVEN)
    gears = raw.get("gears")
    listed = isinstance(gears, dict) and any(isinstance(item, dict) for item in gears.values())
    if "meshes" in raw or listed:
        return (GivenListedSet if given else ListedSet), all_gears_to_members(raw, given=given)
    if "pinion" in raw or "gear" in raw:
        return (GivenPair, _teeth_only(raw)) if given else (PairSet, raw)
    if {"sun", "ring", "planet"} & raw.keys():
        return (GivenPlanetarySet, _teeth_only(raw)) if given else (PlanetarySet, raw)
    return None, raw


def all_gears_to_members(raw: dict[str, Any], *, given: bool) -> dict[str, Any]:
    """The tables of a listed set with those of its gears apart from what all gears share."""
    gears = raw.get("gears", {})
    if not isinstance(gears, dict):
        return raw
    shared = {
        key: item for key, item in gears.items() if key in gear_tables.SharedGears.model_fields
    }
    members = {key: item for key, item in gears.items() if key not in shared}
    split = {key: value for key, value in raw.items() if key != "gears"} | {"members": members}
    if given:
        known = GivenListedSet.model_fields.keys() | {"members"}
        idle = ListedGear.model_fields.keys() - {"teeth", "internal", "body", "planet"}
        split["members"] = {
            name: _without_keys(gear, idle) if isinstance(gear, dict) else gear
            for name, gear in members.items()
        }
        if isinstance(split.get("mesh"), dict):
            computed = ListedMesh.model_fields.keys()
            split["mesh"] = {
                name: _without_keys(mesh, computed) if isinstance(mesh, dict) else mesh
                for name, mesh in split["mesh"].items()
                if not isinstance(mesh, dict) or mesh.keys() - computed
            }
        return _without_keys(split, ListedSet.model_fields.keys() - known)
    return split | {"gears": shared}


def _without_keys(table: Mapping[str, Any], keys: Collection[str]) -> dict[str, Any]:
    return {key: value for key, value in table.items() if key not in keys}


def _teeth_only(raw: dict[str, Any]) -> dict[str, Any]:
    """The tables of a set without those that do not matter with a given efficiency."""
    computed = PlanetarySet.model_fields.keys() | PairSet.model_fields.keys()
    kept = _without_keys(raw, computed - {"sun", "ring", "planet", "pinion", "gear", *GIVEN})
    form = GivenPair if "pinion" in raw or "gear" in raw else GivenPlanetarySet
    for name in ("sun", "ring", "planet", "pinion", "gear"):
        table = kept.get(name)
        if isinstance(table, dict) and name in form.model_fields:
            annotation = form.model_fields[name].annotation
            assert annotation is not None
            idle = ListedGear.model_fields.keys() - {*annotation.model_fields, "internal"}
            kept[name] = _without_keys(table, idle)
    return kept


class StateTable(Table):
    """Closed brakes and clutches of a train."""

    fixed: tuple[str, ...] = option("Shafts that brakes hold.", ())
    joined: tuple[tuple[str, ...], ...] = option("Groups of shafts that clutches join.", ())


StateName = Annotated[str, FromDigits]  # It may be a bare number.


class TrainOperation(Table):
    """How the train runs."""

    STAND_INS: ClassVar[dict[str, object]] = ANY_OPERATION | {"oil_inlet_temperature": None}

    state: StateName | None = option("One of [states].")
    input: str = Field(description="The shaft to which torque and speed belong.")
    output: str = Field(description="The shaft whose torque balances.")
    torque: units.Torque = Field(
        description="Torque on the input shaft; negative: coasting, power flows back through it."
    )
    speed: units.RotationalSpeed = Field(description="Speed of the input shaft.")
    oil_inlet_temperature: units.Temperature | None = option(
        "Oil temperature at the inlet; needed for computed losses."
    )
    speeds: dict[str, units.RotationalSpeed] = option(
        "Speeds of further driven shafts, if the train has more degrees of freedom.", {}
    )
    torques: dict[str, units.Torque] = option(
        "External torques on further shafts, such as a power take-off.", {}
    )
