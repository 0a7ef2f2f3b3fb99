"""Tables of a case file on gears, their flanks and meshes."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from epicyclic.case.tables.base import (
    FLANGE_GAP,
    SHROUD_GAP,
    Gap,
    NamedMaterial,
    Roughness,
    ShortLength,
    ThicknessFit,
)
from epicyclic.gears.flanks import ReliefShape
from epicyclic.gears.stated import THICKNESS
from epicyclic.schema.fields import Table, option
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
TipAlteration = Literal["keep-clearance", "none"]
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
    tip_alteration: TipAlteration = option(
        "Gears without tip_diameter: keep-clearance shortens them where profile shifts would take "
        "tip clearance (DIN 3960); none does not.",
        "keep-clearance",
    )
    basic_rack: RackName | None = option(
        "A profile of ISO 53 instead of both coefficients and of the tool tip radius."
    )


class Gears(SharedGears):
    """Values common to all gears."""

    EXACTLY_ONE = (
        ("normal_module", "transverse_module"),
        ("normal_pressure_angle", "transverse_pressure_angle"),
    )

    transverse_pressure_angle: (
        Annotated[float, Quantity("an angle", "rad", "deg", low=10.0, high=40.0)] | None
    ) = option("alpha_t at the reference circle.")
    helix_angle: HelixAngle = Field(description="beta at the reference circle, magnitude.")
    center_distance: Length | None = option("Of every mesh. Default: from the profile shifts, x.")


class TopographyTable(Table):
    """Measured deviations of a flank, positive where material is missing."""

    diameter: tuple[Length, ...] = Field(description="Two or more, increasing.")
    face_position: tuple[ShortLength, ...] = Field(
        description="Two or more, increasing, from the end of the face where contact begins."
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


def _with_positive_teeth(table: Any) -> Any:
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


def _internal_if_negative(table: Any) -> Any:
    """The same of a gear that need not be a ring, which negative teeth make it."""
    positive = _with_positive_teeth(table)
    return positive if positive is table else positive | {"internal": True}


class Teeth(Table):
    """A gear of which only the number of teeth matters."""

    teeth: int = Field(ge=LEAST_TEETH, le=MOST_TEETH, description="Number of teeth.")


class GivenRing(Teeth):
    """The ring of a set of given efficiency."""

    _sign = model_validator(mode="before")(_with_positive_teeth)

    teeth: int = RING_TEETH


class GivenGear(Teeth):
    """A gear of a pair of given efficiency."""

    _sign = model_validator(mode="before")(_internal_if_negative)

    teeth: int = RING_TEETH
    internal: bool = option("true: a ring gear around the pinion.", False)


class GearTable(Teeth):
    """One gear."""

    STAND_INS: ClassVar[dict[str, object]] = {"roughness": "1 um"} | dict.fromkeys(
        ("material", "tool_tip_radius", "micro_geometry", "shroud_gap", "flange_gap")
    )
    AT_MOST_ONE: ClassVar[tuple[tuple[str, ...], ...]] = (
        THICKNESS,
        ("tooth_thickness_allowance", "tooth_thickness_fit"),
    )

    face_width: Length
    tip_diameter: Length | None = option(
        "Inner diameter of a ring. Default: from addendum_coefficient and tip_alteration."
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
    shroud_gap: Gap | None = SHROUD_GAP
    flange_gap: Gap | None = FLANGE_GAP
    micro_geometry: MicroGeometryTable | None = option(
        "Modifications and deviations of the flanks."
    )

    @property
    def states_thickness(self) -> bool:
        """True if it says how thick its teeth are."""
        first = (choice.split("+")[0] for choice in THICKNESS)
        return any(getattr(self, key) is not None for key in first)

    @property
    def is_ring(self) -> bool:
        """True for a gear with internal teeth: a ring, and another one that is said to be."""
        return isinstance(self, GivenRing) or (isinstance(self, GivenGear) and self.internal)


class _WithRim(Table):
    """The rim that a gear has if it is a ring."""

    STAND_INS: ClassVar[dict[str, object]] = GearTable.STAND_INS | {"rim_thickness": None}

    rim_thickness: Length | None = option(
        "Root circle to outside. Default: 3 normal modules (estimate) for the drag, and a rim that "
        "is supported on its outside and does not bend."
    )


class PairGear(_WithRim, GivenGear, GearTable):
    """The gear that meets the pinion."""


class Planet(GearTable):
    """The planets, which are identical."""

    STAND_INS = GearTable.STAND_INS | dict.fromkeys(("angles", "mass", "micro_geometry_ring_side"))

    count: int = Field(ge=1, le=99, description="Number of planets.")
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


class Ring(_WithRim, GivenRing, GearTable):
    """The ring gear."""


class SetMesh(Table):
    """Misalignment and backlash of a mesh."""

    STAND_INS: ClassVar[dict[str, object]] = {"misalignment": None}

    misalignment: Deviation = option(
        "F_beta_x over the common face width, in the plane of action; positive: the flanks open "
        "towards the end where contact ends.",
        "0 um",
    )
    normal_backlash: ShortLength | None = option(
        "j_bn, used to find a profile shift or centre distance that is left out. Default: "
        "none, as for the profile shifts of ISO 21771."
    )
