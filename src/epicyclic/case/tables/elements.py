"""Tables of a case file on bearings, the carrier, seals and losses that the user tabulates."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import Field, Tag

from epicyclic.case.fields import did_you_mean, millimetres, written
from epicyclic.case.tables.base import (
    VALUES_OR_ROWS,
    NamedMaterial,
    PointsTable,
    Roughness,
    ShortLength,
    Table,
    option,
)
from epicyclic.errors import InputError, Problem, raise_any
from epicyclic.gears.gear import HOUSING
from epicyclic.units import Length, Number, Quantity, SmallLength, Temperature

if TYPE_CHECKING:
    from epicyclic.losses.loss_table import LossTable


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
    cage: Literal["caged", "full-complement"] = "caged"
    palmgren_coefficient: Number | None = option(
        "f1 of the palmgren method. Default: 0.0003 caged, 0.00055 full complement.", gt=0, le=0.05
    )
    crown_drop: SmallLength = option("Drop of the profile at the roller's end (estimate).", "3 um")
    crown_length_fraction: Number = option(
        "Length of the crowned part at each end.", 0.2, ge=0, le=0.5
    )
    row_gap: ShortLength = option("Axial gap between the rollers of neighbouring rows.", "0 mm")
    material: NamedMaterial = option("Material of rollers and races.", "steel")


class Carrier(Table):
    """The planet carrier as a disc, for its drag."""

    outer_diameter: Length
    width: Length


class ThrustBearing(Table):
    """A thrust bearing that carries negligible load, for its viscous loss."""

    mean_diameter: Length
    between: Literal[
        "sun-carrier", "sun-ring", "ring-carrier", "sun-housing", "carrier-housing"
    ] = option("The two parts whose speeds differ.", "carrier-housing")
    viscous_factor: Number = option("f0 (Harris).", 3.5, ge=0, le=100)
    count: int = Field(default=1, ge=1, le=10)


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

    speed: tuple[SpeedDifference, ...] | None = option(
        "Magnitudes of the speed difference, rising."
    )
    temperature: tuple[Temperature, ...] | None = option("Temperatures of the oil, rising.")
    radial_force: tuple[Force, ...] | None = option("On a bearing, rising.")
    torque: Torques | None = option(
        "Friction torque, with one value or one row for each value of the first axis."
    )
    power: Powers | None = option("Power loss instead of the torque; it needs the axis speed.")
    file: str | None = option(
        "CSV file in the folder of the case, with units in the header: speed [rpm],torque [N*m].",
        max_length=1000,
    )

    @property
    def quantity(self) -> Literal["torque", "power"]:
        """Which of the two it holds."""
        return "torque" if self.torque is not None else "power"


class DragTable(LossTableTable):
    """Drag of a clutch, a brake, a pump or another part, from a table."""

    between: tuple[str, str] = Field(
        description='The two shafts whose speeds differ; one of them may be "housing".'
    )


class BearingSealTable(Table):
    """Contact seals of a bearing after SKF, both together: K_S1 d_s^beta + K_S2."""

    counterface_diameter: Length = Field(description="d_s, the diameter on which the lips run.")
    factor: Number = Field(ge=0, le=10, description="K_S1, for mm and N mm.")
    exponent: Number = Field(ge=0, le=4, description="beta.")
    constant: DragTorque = option("K_S2.", "0 N*m")


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
    against: str = option("The body that holds its outer ring.", "housing")
    type: Literal["deep-groove", "cylindrical", "tapered", "needle"]
    bore: Length
    outside_diameter: Length
    width: Length | None = option("Needed for the drag of rollers in an oil bath.")
    cage: Literal["caged", "full-complement"] = option(
        "full-complement: cylindrical and needle rollers only.", "caged"
    )
    model: Literal["palmgren", "harris", "skf-2018", "table"] = option(
        "skf-2018 needs series; harris needs static_load_rating for ball bearings.", "palmgren"
    )
    series: str | None = option("For skf-2018: 62, 160; 2, 10, 22; 302, 320X; ...", max_length=20)
    dynamic_load_rating: LoadRating | None = option(
        "C, for the minimum load of tapered and needle roller bearings."
    )
    static_load_rating: LoadRating | None = option(
        "C0, for ball bearings with harris and skf-2018."
    )
    contact_angle: ContactAngle | None = option(
        "Contact angle of a tapered roller bearing, instead of axial_factor."
    )
    axial_factor: Number | None = option(
        "Y of a tapered roller bearing, 0.4 cot of the angle.", gt=0, le=10
    )
    position: Position | None = option("Along the shaft, for its reactions to the gear forces.")
    locating: bool = option("true: the bearing takes axial force.", False)
    axial_sense: Literal["both", "positive", "negative"] = option(
        "Direction along the axis in which a locating bearing holds the shaft.", "both"
    )
    radial_force: Force | None = option("Radial force instead of the reaction to the gear forces.")
    axial_force: Force | None = option(
        "Axial force in addition to radial_force. Default: none if radial_force is given."
    )
    viscous_factor: Number | None = option(
        "f0 of palmgren and harris. Default: deep-groove 2, cylindrical 3 or 7.5 (full "
        "complement), tapered 6, needle 12.",
        ge=0,
        le=100,
    )
    palmgren_coefficient: Number | None = option(
        "f1 of palmgren. Default: 0.0003, full complement 0.00055, tapered 0.0004, needle 0.0005 "
        "(estimate).",
        gt=0,
        le=0.05,
    )
    flange_coefficient: Number | None = option(
        "f_f of cylindrical rollers under axial force. Default: 0.002 caged, 0.003 full "
        "complement.",
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
    reference_speed: ReferenceSpeed | None = option("For the minimum load of cylindrical rollers.")
    table: LossTableTable | None = option("Loss table for model = table.")


class SealTable(Table):
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


# What contradicts itself, or is missing, in one of these tables; keys are relative to the table.

_DRAG_AXES = ("speed", "temperature")  # Axes of the tables of parts that carry no load.


def bearing_problems(table: ShaftBearingTable) -> list[Problem]:
    """What contradicts itself, or is missing, in the table of a bearing."""
    from epicyclic.losses.shaft_bearing import bearing_types  # cases without bearings need it not

    problems = _size_problems(table) + _force_problems(table)
    if table.type not in bearing_types(table.model):
        reason = f"has no constants for {table.type} roller bearings."
        remedy = 'Choose model = "palmgren" or "table".'
        return [*problems, Problem("model", written(table.model), reason, remedy)]
    if table.model == "table":
        return problems + _own_table_problems(table, LossTableTable.AXES)
    problems += _own_table_problems(table, LossTableTable.AXES)
    if table.model == "skf-2018":
        problems += _skf_problems(table)
    if (
        table.type == "deep-groove"
        and table.model in ("harris", "skf-2018")
        and table.static_load_rating is None
    ):
        reason = f"is missing; the model {table.model} needs it for ball bearings."
        problems.append(Problem("static_load_rating", "", reason, "Add C0 from the catalogue."))
    return problems


def _size_problems(table: ShaftBearingTable) -> list[Problem]:
    from epicyclic.losses.shaft_bearing import DEFAULT_VISCOUS_FACTORS

    problems = []
    if table.bore >= table.outside_diameter:
        reason = f"must be less than outside_diameter, {millimetres(table.outside_diameter)}."
        problems.append(Problem("bore", millimetres(table.bore), reason, "Correct one of the two."))
    if (table.type, table.cage) not in DEFAULT_VISCOUS_FACTORS:
        reason = f"is not made as a {table.type} bearing."
        remedy = 'Write cage = "caged", or choose cylindrical or needle rollers.'
        problems.append(Problem("cage", written(table.cage), reason, remedy))
    angles = [key for key in ("axial_factor", "contact_angle") if getattr(table, key) is not None]
    if table.type == "tapered" and table.model != "table" and len(angles) != 1:
        reason = "is missing; give axial_factor or contact_angle."
        if angles:
            reason = "is given together with contact_angle; each follows from the other."
        remedy = "Delete one." if angles else "Add Y from the catalogue, or the contact angle."
        problems.append(Problem("axial_factor", "", reason, remedy))
    if table.type != "tapered":
        problems += [
            Problem(key, "", "belongs to tapered roller bearings.", "Delete it.") for key in angles
        ]
    return problems


def _force_problems(table: ShaftBearingTable) -> list[Problem]:
    problems = _same_body_problems({"shaft": table.shaft, "against": table.against})
    if table.axial_force is not None and table.radial_force is None:
        remedy = 'Add radial_force = "0 N" if there is none.'
        problems.append(Problem("radial_force", "", "is missing with axial_force.", remedy))
    if table.type == "needle":
        reason = "is not possible with a needle roller bearing, which carries no axial force."
        remedy = "Locate the shaft by another bearing."
        if table.locating:
            problems.append(Problem("locating", "true", reason, remedy))
        if table.axial_force:
            problems.append(Problem("axial_force", f"{table.axial_force:g} N", reason, remedy))
    return problems


def _skf_problems(table: ShaftBearingTable) -> list[Problem]:
    from epicyclic.losses.shaft_bearing import skf_series

    problems = []
    known = skf_series(table.type)
    needs_series = table.cage == "caged"
    choice = ", ".join(known)
    if needs_series and table.series is None:
        remedy = f"Give one of {choice}."
        problems.append(
            Problem("series", "", f"is missing; SKF lists the series {choice}.", remedy)
        )
    elif needs_series and table.series not in known:
        remedy = did_you_mean(table.series or "", known) or 'Or choose model = "palmgren".'
        reason = f"is not in the table; the series of {table.type} bearings are {choice}."
        problems.append(Problem("series", written(table.series), reason, remedy))
    if table.oil_level > 0 and table.type != "deep-groove" and table.width is None:
        reason = "is missing; the drag of rollers in an oil bath needs it."
        problems.append(Problem("width", "", reason, "Add B from the catalogue."))
    return problems


def seal_problems(table: SealTable) -> list[Problem]:
    """What contradicts itself, or is missing, in the table of a seal."""
    bodies = {"shaft": table.shaft, "against": table.against}
    return _same_body_problems(bodies) + _own_table_problems(table, _DRAG_AXES)


def drag_problems(table: DragTable) -> list[Problem]:
    """What contradicts itself, or is missing, in the table of a drag."""
    first, second = table.between
    problems = _same_body_problems({"between[0]": first, "between[1]": second})
    return problems + loss_table_problems(table, _DRAG_AXES)


def _same_body_problems(bodies: Mapping[str, str]) -> list[Problem]:
    (_, first), (key, second) = bodies.items()
    if first != second:
        return []
    reason = "names the same body twice, so there is no relative motion."
    return [Problem(key, written(second), reason, f'Name another shaft, or "{HOUSING}".')]


def _own_table_problems(
    table: ShaftBearingTable | SealTable, axes: Collection[str]
) -> list[Problem]:
    """Problems of the loss table of an element, and of one that is missing or idle."""
    if table.model != "table":
        idle = Problem("table", "", 'belongs to model = "table".', "Delete it, or choose that.")
        return [] if table.table is None else [idle]
    if table.table is None:
        reason = "needs a table of friction torque or power."
        return [Problem("model", '"table"', reason, "Add table, or choose another model.")]
    return [
        Problem(f"table.{found.key}".rstrip("."), found.value, found.allowed, found.remedy)
        for found in loss_table_problems(table.table, axes)
    ]


def loss_table_problems(table: LossTableTable, axes: Collection[str]) -> list[Problem]:
    """What contradicts itself in a table of torque or power that may have `axes`."""
    contents = [key for key in ("torque", "power", "file") if getattr(table, key) is not None]
    if len(contents) != 1:
        reason = "must have exactly one of torque, power and file."
        given = " and ".join(contents)
        return [Problem(contents[0] if contents else "", given, reason, "Give one of them.")]
    given_axes = table.axes()
    problems = [
        Problem(name, "", "is not a valid axis here: only bearings carry a load.", "Delete it.")
        for name in given_axes
        if name not in axes
    ]
    if contents == ["file"]:
        problems += [
            Problem(name, "", "is given together with file, which has its own axes.", "Delete it.")
            for name in given_axes
        ]
        return problems
    from epicyclic.losses.loss_table import table_problems

    values = getattr(table, table.quantity)
    return problems or table_problems(table.quantity, given_axes, values)


class ElementTables(Table):
    """Elements that a train adds, each kind by the names of its tables: ``[bearings.NAME]``."""

    bearings: dict[str, ShaftBearingTable] = Field(default={})
    seals: dict[str, SealTable] = Field(default={})
    drags: dict[str, DragTable] = Field(default={})


ELEMENT_CHECKS: Mapping[str, Callable[[Any], list[Problem]]] = {
    "bearings": bearing_problems,
    "seals": seal_problems,
    "drags": drag_problems,
}
"""By kind: the problems of a table that need no other table."""


# How they stand in a train.


def bodies_of(table: Table) -> dict[str, str]:
    """The two bodies that a part is between, by their keys."""
    keys = dict(table)
    if "between" in keys:
        return {f"between[{number}]": body for number, body in enumerate(keys["between"])}
    return {key: keys[key] for key in ("shaft", "against")}


def placing_problems(table: Table, shafts: Mapping[str, str], folder: Path) -> list[Problem]:
    """Why a part that is sound by itself cannot be in a train: unknown shafts, a bad file."""
    try:
        between(table, shafts)
        points_of(table, folder)
    except InputError as error:
        return list(error.problems)
    return []


def between(
    table: Table,
    shafts: Mapping[str, str],  # The bodies beside the housing, by all their names.
) -> tuple[str, str]:
    """The bodies that a part is between; raises `InputError` for unknown ones."""
    names = bodies_of(table)
    known = {**shafts, HOUSING: HOUSING}
    raise_any(
        Problem(
            key,
            written(body),
            f"is not a shaft; the shafts are {', '.join(dict.fromkeys(known.values()))}.",
            did_you_mean(body, known) or "Check the name.",
        )
        for key, body in names.items()
        if body not in known
    )
    first, second = (known[name] for name in names.values())
    if first == second:
        reason = f"is the same shaft, {first}, under another name, so there is no relative motion."
        key, name = list(names.items())[1]
        raise InputError([Problem(key, written(name), reason, "Name another shaft.")])
    return first, second


def points_of(table: Table, folder: Path) -> LossTable | None:
    """The torque or power that a part states as a table; raises `InputError` for a bad file."""
    if isinstance(table, DragTable):
        return _loss_table(table, folder, "", _DRAG_AXES)
    assert isinstance(table, ShaftBearingTable | SealTable)
    if table.table is None:
        return None
    is_bearing = isinstance(table, ShaftBearingTable)
    axes = LossTableTable.AXES if is_bearing else _DRAG_AXES
    return _loss_table(table.table, folder, "table.", axes)


def _loss_table(
    table: LossTableTable, folder: Path, prefix: str, axes: Collection[str]
) -> LossTable:
    from epicyclic.losses.loss_table import LossTable, read_loss_table

    if table.file is None:
        points = {name: np.asarray(given) for name, given in table.axes().items()}
        values = np.asarray(getattr(table, table.quantity), dtype=float)
        return LossTable(table.quantity, points, values)
    try:
        found = read_loss_table(folder / table.file)
    except InputError as error:
        raise InputError(
            Problem(
                f"{prefix}file",
                written(table.file),
                " ".join(part for part in (one.key, one.value, one.allowed) if part),
                one.remedy,
            )
            for one in error.problems
        ) from None
    if not set(found.names) <= set(axes):
        reason = f"may only have the axes {' and '.join(axes)}."
        remedy = "Delete the column radial_force."
        raise InputError([Problem(f"{prefix}file", written(table.file), reason, remedy)])
    return found
