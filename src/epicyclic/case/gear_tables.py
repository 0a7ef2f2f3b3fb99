"""Tables of a case file on gears, their flanks and meshes, and what these state of teeth."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from epicyclic.case.fields import millimetres
from epicyclic.case.tables.base import (
    NamedMaterial,
    Roughness,
    ShortLength,
    Table,
    ThicknessFit,
    option,
)
from epicyclic.errors import Problem
from epicyclic.gears import measures
from epicyclic.gears.flanks import (
    FlankDeviations,
    MicroGeometry,
    Relief,
    Topography,
    active_profile,
)
from epicyclic.gears.gear import (
    BasicRack,
    Gear,
    half_angle_from_profile_shift,
    half_angle_from_thickness,
)
from epicyclic.gears.measures import LARGEST_FIT, FlankTolerances, fit_allowances, flank_tolerances
from epicyclic.gears.mesh import Mesh
from epicyclic.units import (
    Angle,
    Deviation,
    HelixAngle,
    Length,
    Mass,
    Number,
    Quantity,
    SmallLength,
)

PressureAngle = Annotated[float, Quantity("an angle", "rad", "deg", low=10.0, high=35.0)]
RackName = Literal["iso-53-a", "iso-53-b", "iso-53-c", "iso-53-d"]


class SharedGears(Table):
    """What all gears of a set share; in a listed set beside the tables of its gears."""

    AT_MOST_ONE = (("basic_rack", "addendum_coefficient"), ("basic_rack", "dedendum_coefficient"))

    normal_module: Length | None = option("m_n.")
    transverse_module: Length | None = option("m_t = m_n/cos(beta).")
    normal_pressure_angle: PressureAngle | None = option("alpha_n at the reference circle.")
    transverse_pressure_angle: PressureAngle | None = option("alpha_t at the reference circle.")
    helix_angle: HelixAngle | None = option("beta at the reference circle, magnitude.")
    center_distance: Length | None = option("Centre distance of every mesh.")
    addendum_coefficient: Number = option(
        "h_aP/m_n, for gears without tip_diameter. ISO 53, profile A.", 1.0, gt=0, le=3
    )
    dedendum_coefficient: Number = option(
        "h_fP/m_n, for gears without root_diameter. ISO 53, profile A.", 1.25, gt=0, le=4
    )
    basic_rack: RackName | None = option(
        "A profile of ISO 53 instead of both coefficients and of the tool tip radius."
    )


class Gears(SharedGears):
    """What all gears share."""

    EXACTLY_ONE = (
        ("normal_module", "transverse_module"),
        ("normal_pressure_angle", "transverse_pressure_angle"),
    )

    transverse_pressure_angle: (
        Annotated[float, Quantity("an angle", "rad", "deg", low=10.0, high=40.0)] | None
    ) = option("alpha_t at the reference circle.")
    helix_angle: HelixAngle = Field(description="beta at the reference circle, magnitude.")
    center_distance: Length | None = option("Of every mesh. Default: from the profile shifts, x.")

    @property
    def distance(self) -> float:
        """The centre distance, as given or found; see `epicyclic.case.sizing`. [m]"""
        assert self.center_distance is not None
        return self.center_distance


ReliefShape = Literal["linear", "parabolic"]


class TopographyTable(Table):
    """Measured deviations of a flank, positive where material is missing."""

    diameter: tuple[Length, ...] = Field(description="Two or more, rising.")
    face_position: tuple[ShortLength, ...] = Field(
        description="Two or more, rising, from the end of the face where contact begins."
    )
    deviation: tuple[tuple[Deviation, ...], ...] = Field(
        description="One row for each diameter, with one value for each face position."
    )


class MicroGeometryTable(Table):
    """Modifications and deviations of the working flanks, positive where material is missing."""

    tip_relief: SmallLength = option("Relief at the tip.", "0 um")
    tip_relief_roll_length: Length | None = option(
        "Roll length from the tip to the start of the relief."
    )
    tip_relief_diameter: Length | None = option(
        "Diameter where the relief starts, instead of the roll length."
    )
    tip_relief_shape: ReliefShape = "linear"
    root_relief: SmallLength = option("Relief at the start of the active profile.", "0 um")
    root_relief_roll_length: Length | None = option(
        "Roll length from the start of the active profile."
    )
    root_relief_diameter: Length | None = option(
        "Diameter where the relief starts, instead of the roll length."
    )
    root_relief_shape: ReliefShape = "linear"
    profile_crown: Deviation = option("Height of the parabola over the active profile.", "0 um")
    profile_slope: Deviation = option("Positive: material is removed at the tip.", "0 um")
    lead_crown: Deviation = option("Height of the parabola over the face width.", "0 um")
    lead_slope: Deviation = option(
        "Positive: material is removed at the end where contact ends.", "0 um"
    )
    end_relief: SmallLength = option("Relief at both ends of the face.", "0 um")
    end_relief_length: Length | None = option("Length of the relief from each end.")
    end_relief_shape: ReliefShape = "linear"
    topography: TopographyTable | None = option("Deviations over the flank, added to the others.")


LEAST_TEETH, MOST_TEETH = 5, 2000
RING_TEETH: Any = Field(
    ge=LEAST_TEETH,
    le=MOST_TEETH,
    description="Number of teeth; it may be negative for a ring, as in ISO 21771 and DIN 3960.",
    json_schema_extra={
        "minimum": -MOST_TEETH,
        "not": {"exclusiveMinimum": -LEAST_TEETH, "exclusiveMaximum": LEAST_TEETH},
    },
)


class GearTable(Table):
    """One gear."""

    STAND_INS: ClassVar[dict[str, object]] = {
        "roughness": "1 um",
        "material": None,
        "tool_tip_radius": None,
        "micro_geometry": None,
    }
    THICKNESS: ClassVar[tuple[str, ...]] = (
        "tooth_thickness+thickness_diameter",
        "span_measurement+teeth_in_span",
        "dimension_over_pins+measuring_pin_diameter",
        "profile_shift_coefficient",
    )
    AT_MOST_ONE: ClassVar[tuple[tuple[str, ...], ...]] = (
        THICKNESS,
        ("tooth_thickness_allowance", "tooth_thickness_fit"),
    )

    teeth: int = Field(ge=LEAST_TEETH, le=MOST_TEETH, description="Number of teeth.")
    face_width: Length
    tip_diameter: Length | None = option(
        "Inner diameter of a ring. Default: from addendum_coefficient."
    )
    root_diameter: Length | None = option("Default: from dedendum_coefficient.")
    tip_chamfer: ShortLength = option(
        "Radial height of the 45 degree chamfers of the tip corners.", "0 mm"
    )
    tooth_thickness: Length | None = option("Transverse arc thickness at thickness_diameter.")
    thickness_diameter: Length | None = None
    span_measurement: Length | None = option("W_k, base tangent length over teeth_in_span teeth.")
    teeth_in_span: int | None = option("k.", ge=1, le=2000)
    dimension_over_pins: Length | None = option("M_d over two balls, or between them in a ring.")
    measuring_pin_diameter: Length | None = option("D_M of the balls, or of pins for a spur gear.")
    tooth_thickness_allowance: (
        Annotated[tuple[Deviation, ...], Field(min_length=2, max_length=2)] | None
    ) = option(
        "Upper and lower allowance, A_sne and A_sni of DIN 3967, negative; the teeth are made "
        "thinner by their mean."
    )
    tooth_thickness_fit: ThicknessFit | None = option(
        'Both from a series of DIN 3967, as in "27cd": tolerance 21 to 30, allowance a to h.'
    )
    profile_shift_coefficient: Number | None = option(
        "x; positive thickens the teeth, on a ring too. Default: the value that fits the mate "
        "and the centre distance.",
        ge=-3,
        le=5,
    )
    roughness: Roughness = Field(
        description='rms roughness Rq of the flanks, also as "Ra 0.4 um" or "Rz 3 um", or a finish.'
    )
    material: NamedMaterial = option("A name or a table.", "steel")
    accuracy_class: int | None = option(
        "Flank tolerance class of ISO 1328-1:2013, for the uncertainty of the slopes.", ge=1, le=11
    )
    tool_tip_radius: ShortLength | None = option(
        "Tip radius of the cutting tool, which forms the root fillet. Default: 0.38 m_n (rack) "
        "or 0.2 m_n (shaper), or less where the mate needs a longer involute."
    )
    micro_geometry: MicroGeometryTable | None = option(
        "Modifications and deviations of the flanks."
    )

    @property
    def states_thickness(self) -> bool:
        """True if it says how thick its teeth are."""
        first = (choice.split("+")[0] for choice in GearTable.THICKNESS)
        return any(getattr(self, key) is not None for key in first)


def with_positive_teeth(table: Any) -> Any:
    """The keys of a gear that may be a ring, with the magnitudes of numbers that mark it as one.

    ISO 21771 gives rings negative numbers of teeth, DIN 3960 negative diameters too. The sign of
    their profile shift is that of this program; see the page on geometry.
    """
    teeth = table.get("teeth") if isinstance(table, dict) else None
    is_negative = isinstance(teeth, int) and teeth <= -LEAST_TEETH
    if not is_negative or table.get("internal") is False:
        return table
    positive = dict(table) | {"teeth": -table["teeth"]}
    for key in ("tip_diameter", "root_diameter", "thickness_diameter", "dimension_over_pins"):
        if isinstance(table.get(key), str):
            positive[key] = table[key].strip().removeprefix("-")
    return positive


def internal_if_negative(table: Any) -> Any:
    """The same of a gear that need not be a ring, which negative teeth make it."""
    positive = with_positive_teeth(table)
    return positive if positive is table else positive | {"internal": True}


_RimThickness = Annotated[
    Length | None,
    Field(
        description="Root circle to outside. Default: 3 normal modules (estimate) for the drag, "
        "and a rim that is supported on its outside and does not bend."
    ),
]


class PairGear(GearTable):
    """The gear that meets the pinion."""

    STAND_INS = GearTable.STAND_INS | {"rim_thickness": None}
    _sign = model_validator(mode="before")(internal_if_negative)

    teeth: int = RING_TEETH
    internal: bool = option("true: a ring gear around the pinion.", False)
    rim_thickness: _RimThickness = None


class Planet(GearTable):
    """The planets, which are identical."""

    STAND_INS = GearTable.STAND_INS | {
        "angles": None,
        "mass": None,
        "micro_geometry_ring_side": None,
    }

    count: int = Field(ge=1, le=24, description="Number of planets.")
    angles: tuple[Angle, ...] | None = option(
        "Position of each planet on the carrier. Default: the admissible positions nearest to "
        "equal spacing."
    )
    mass: Mass | None = option(
        "Mass of one planet with its rollers; its centrifugal force loads the planet bearing. "
        "Default: from the dimensions of gear and rollers and the density of their materials."
    )
    micro_geometry_ring_side: MicroGeometryTable | None = option(
        "For the flanks that mesh with the ring. Default: micro_geometry, for both sides."
    )


class Ring(GearTable):
    """The ring gear."""

    STAND_INS = GearTable.STAND_INS | {"rim_thickness": None}
    _sign = model_validator(mode="before")(with_positive_teeth)

    teeth: int = RING_TEETH
    rim_thickness: _RimThickness = None


class MeshTable(Table):
    """What belongs to a mesh and to none of its gears."""

    STAND_INS: ClassVar[dict[str, object]] = {"misalignment": None}

    misalignment: Deviation = option(
        "F_beta_x over the common face width, in the plane of action; positive: the flanks open "
        "towards the end where contact ends.",
        "0 um",
    )


class SetMesh(MeshTable):
    """A mesh whose gears or centre distance may be found from it."""

    normal_backlash: ShortLength | None = option(
        "j_bn, used to find a profile shift or centre distance that is left out. Default: "
        "none, as for the profile shifts of ISO 21771."
    )


# How thick the teeth of a gear are, in each of the ways in which a case can state it.

DIGITS = 4  # Decimals of the profile shifts that messages propose: 0.1 um at a module of 1.5 mm.


def half_angle(table: GearTable, rack: BasicRack, *, internal: bool) -> float:
    """Half angle at the reference circle of the teeth that a table states.

    Raises `ValueError` if the thickness is stated inside the base circle.
    """
    teeth = table.teeth
    half = _stated(table, rack, internal=internal)
    excess = 2 * allowance_shift(table, rack) * rack.normal_module
    return half + excess * math.tan(rack.transverse_pressure_angle) / (
        teeth * rack.transverse_module
    )


def _stated(table: GearTable, rack: BasicRack, *, internal: bool) -> float:
    teeth = table.teeth
    if table.profile_shift_coefficient is not None:
        return half_angle_from_profile_shift(rack, teeth, table.profile_shift_coefficient)
    if table.span_measurement is not None:
        assert table.teeth_in_span is not None
        return measures.half_angle_from_span(
            rack, teeth, internal, table.span_measurement, table.teeth_in_span
        )
    if table.dimension_over_pins is not None:
        assert table.measuring_pin_diameter is not None
        return measures.half_angle_from_pins(
            rack, teeth, internal, table.dimension_over_pins, table.measuring_pin_diameter
        )
    assert table.tooth_thickness is not None
    assert table.thickness_diameter is not None
    return half_angle_from_thickness(
        rack, teeth, internal, table.tooth_thickness, table.thickness_diameter / 2
    )


def allowances(table: GearTable, rack: BasicRack) -> tuple[float, float] | None:
    """Upper and lower allowance of the tooth thickness, A_sne and A_sni. [m]"""
    if table.tooth_thickness_fit is not None:
        diameter = min(table.teeth * rack.transverse_module, LARGEST_FIT)
        return fit_allowances(table.tooth_thickness_fit, diameter)
    if table.tooth_thickness_allowance is None:
        return None
    upper, lower = table.tooth_thickness_allowance
    return upper, lower


def allowance_shift(table: GearTable, rack: BasicRack) -> float:
    """Profile shift of the mean tooth-thickness allowance. DIN 3960. Theory (G52). [1]"""
    stated = allowances(table, rack)
    return (
        0.0
        if stated is None
        else sum(stated) / (4 * rack.normal_module * math.tan(rack.normal_pressure_angle))
    )


def thickness_key(key: str, table: GearTable) -> str:
    """The key that states how thick the teeth are, of the gear whose table stands at `key`."""
    keys = ("span_measurement", "dimension_over_pins", "tooth_thickness")
    stated = (key for key in keys if getattr(table, key) is not None)
    return f"{key}.{next(stated, 'profile_shift_coefficient')}"


def fitting(gear: Gear, key: str, table: GearTable, over: float) -> str:
    """What a table states of teeth that are thinner by the profile shift `over`, rounded down."""
    rack, key = gear.rack, thickness_key(key, table)
    arc = 2 * over * rack.normal_module * math.tan(rack.transverse_pressure_angle)
    if table.span_measurement is not None:
        normal = math.sin(rack.normal_pressure_angle)
        change = 2 * over * rack.normal_module * normal * (-1 if gear.internal else 1)
        return _length(key, table.span_measurement - change, up=gear.internal)
    if table.dimension_over_pins is not None and table.measuring_pin_diameter is not None:
        half = gear.thickness_half_angle - arc / (2 * gear.reference_radius)
        thin = replace(gear, thickness_half_angle=half)
        change = measures.dimension_over_pins(thin, table.measuring_pin_diameter)
        change -= measures.dimension_over_pins(gear, table.measuring_pin_diameter)
        return _length(key, table.dimension_over_pins + change, up=gear.internal)
    if table.tooth_thickness is not None and table.thickness_diameter is not None:
        thinner = arc * table.thickness_diameter / (2 * gear.reference_radius)
        return _length(key, table.tooth_thickness - thinner, up=False)
    step = 10.0**-DIGITS
    nominal = gear.profile_shift_coefficient - allowance_shift(table, rack)
    return f"{key} = {math.floor((nominal - over) / step) * step:.{DIGITS}f}"


def _length(key: str, value: float, *, up: bool) -> str:
    """A key with its length, rounded to a micrometre towards thinner teeth."""
    step = math.ceil if up else math.floor
    return f'{key} = "{step(value * 1e6) / 1e3:.3f} mm"'


def tolerances_of(gear: Gear, table: GearTable) -> FlankTolerances | None:
    """Tolerances of the flanks of a gear by its class."""
    if table.accuracy_class is None:
        return None
    return flank_tolerances(
        table.accuracy_class, gear.rack.normal_module, 2 * gear.reference_radius, gear.face_width
    )


def check_fit(gear: Gear, key: str, table: GearTable) -> Problem | None:
    """DIN 3967 has no allowances for larger gears."""
    if table.tooth_thickness_fit is None or 2 * gear.reference_radius <= LARGEST_FIT:
        return None
    allowed = f"applies to reference diameters up to {millimetres(LARGEST_FIT)}, and this gear has "
    allowed += f"{millimetres(2 * gear.reference_radius)}."
    remedy = "Give tooth_thickness_allowance."
    return Problem(f"{key}.tooth_thickness_fit", f'"{table.tooth_thickness_fit}"', allowed, remedy)


def check_measure(gear: Gear, key: str, table: GearTable) -> Problem | None:
    """A span or balls must touch the flanks."""
    if table.span_measurement is not None:
        if gear.internal and gear.rack.helix_angle > 0:
            place = f"{key}.span_measurement"
            reason = "cannot be measured on a helical ring gear."
            advice = "Give dimension_over_pins with measuring_pin_diameter."
            return Problem(place, millimetres(table.span_measurement), reason, advice)
        radius = measures.span_contact_radius(gear, table.span_measurement)
        remedy = f"Over {measures.usual_span_teeth(gear)} teeth it would touch mid-flank."
        what = "span_measurement"
    elif table.dimension_over_pins is not None and table.measuring_pin_diameter is not None:
        radius = measures.pin_contact_radius(gear, table.measuring_pin_diameter)
        usual = millimetres(measures.usual_pin(gear.rack))
        remedy = f"A usual measuring_pin_diameter is {usual}."
        what = "dimension_over_pins"
    else:
        return None
    low, high = sorted((gear.root_radius, gear.tip_radius))
    if low < radius < high:
        return None
    value = getattr(table, what)
    shown = millimetres(value)
    allowed = f"touches at diameter {millimetres(2 * radius)}, beyond the flanks, which reach from "
    allowed += f"{millimetres(2 * low)} to {millimetres(2 * high)}."
    return Problem(f"{key}.{what}", shown, allowed, f"Check it, tooth number and module. {remedy}")


# From the tables of a case to the deviations of its flanks.

Tables = tuple[GearTable, GearTable]


def micro_geometries(table: GearTable) -> tuple[MicroGeometryTable, ...]:
    """The tables of micro-geometry that a gear has."""
    ring_side = table.micro_geometry_ring_side if isinstance(table, Planet) else None
    return tuple(one for one in (table.micro_geometry, ring_side) if one is not None)


@lru_cache(maxsize=256)
def flank_deviations(mesh: Mesh, tables: Tables, misalignment: float) -> FlankDeviations:
    """The deviations of both working flanks of a mesh."""
    one, two = (_of_member(mesh, member, tables[member - 1]) for member in (1, 2))
    return FlankDeviations(one, two, misalignment)


def working_flank(member: int, table: GearTable) -> MicroGeometryTable | None:
    """The table of the flank of a member of a mesh that works in it.

    A planet's other flank works against the ring, where the planet is member 1.
    """
    if member == 1 and isinstance(table, Planet) and table.micro_geometry_ring_side is not None:
        return table.micro_geometry_ring_side
    return table.micro_geometry


def _of_member(mesh: Mesh, member: int, table: GearTable) -> MicroGeometry:
    flank = working_flank(member, table)
    if flank is None:
        return MicroGeometry()
    gear = (mesh.gear1, mesh.gear2)[member - 1]
    root, tip = active_profile(mesh, member)
    return MicroGeometry(
        tip_relief=_profile_relief(gear, tip, flank, "tip_relief"),
        root_relief=_profile_relief(gear, root, flank, "root_relief"),
        end_relief=None
        if flank.end_relief == 0 or flank.end_relief_length is None
        else Relief(flank.end_relief, flank.end_relief_length, flank.end_relief_shape),
        profile_crown=flank.profile_crown,
        profile_slope=flank.profile_slope,
        lead_crown=flank.lead_crown,
        lead_slope=flank.lead_slope,
        topography=None if flank.topography is None else _topography(gear, flank.topography),
    )


def _profile_relief(gear: Gear, end: float, flank: MicroGeometryTable, key: str) -> Relief | None:
    amount: float = getattr(flank, key)
    roll_length: float | None = getattr(flank, f"{key}_roll_length")
    diameter: float | None = getattr(flank, f"{key}_diameter")
    if diameter is not None:
        roll_length = abs(roll_length_at(gear, diameter / 2) - end)
    if amount == 0 or roll_length is None:
        return None
    return Relief(amount, roll_length, getattr(flank, f"{key}_shape"))


def roll_length_at(gear: Gear, radius: float) -> float:
    """Transverse radius of curvature of the involute at `radius`; 0 inside the base circle. [m]"""
    return math.sqrt(max(0.0, radius**2 - gear.base_radius**2))


def _topography(gear: Gear, table: TopographyTable) -> Topography:
    return Topography(
        tuple(roll_length_at(gear, diameter / 2) for diameter in table.diameter),
        table.face_position,
        table.deviation,
    )
