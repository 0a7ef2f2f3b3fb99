"""The tables and keys of a case file.

Each class is one table; field descriptions become the JSON Schema and the commented template.
Values are SI after validation. Checks across keys and tables live in `epicyclic.case.checks`.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from typing import Annotated, Any, ClassVar, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetJsonSchemaHandler,
    Tag,
)
from pydantic_core import CoreSchema, PydanticCustomError

from epicyclic import library
from epicyclic.case.fields import Named
from epicyclic.case.nearest import did_you_mean
from epicyclic.lubricant.oil import Oil
from epicyclic.units import (
    Angle,
    Density,
    Deviation,
    HelixAngle,
    HertzPressure,
    Length,
    Mass,
    Modulus,
    Number,
    Pressure,
    Quantity,
    RotationalSpeed,
    SmallLength,
    Speed,
    Stiffness,
    Temperature,
    Torque,
)

Member = Literal["sun", "ring", "carrier"]


class Table(BaseModel):
    """Base of all tables: immutable, no unknown keys.

    ``EXACTLY_ONE`` lists groups of alternatives of which a file gives exactly one; an alternative
    of several keys, joined by ``+``, needs all of them.

    ``STAND_INS`` are keys on which no check across tables depends. If such a key cannot be used,
    the checks go on with the value given here (None: with the default).
    """

    model_config = ConfigDict(
        frozen=True, extra="forbid", validate_default=True, allow_inf_nan=False
    )
    EXACTLY_ONE: ClassVar[tuple[tuple[str, ...], ...]] = ()
    STAND_INS: ClassVar[dict[str, object]] = {}


def _as_text(default: str) -> Any:
    """A default as a case file would state it; it is read like any other value."""
    return default


def _no_preset(noun: str, name: str, known: Iterable[str], allowed: str) -> PydanticCustomError:
    nearest = did_you_mean(name, known)
    return PydanticCustomError(
        "preset",
        "no such {noun}; it must be {allowed}",
        {"noun": noun, "allowed": allowed, "remedy": nearest or "Check the name"},
    )


class _Roughness(Quantity):
    """A length, or the name of a built-in finish."""

    def parse(self, value: object) -> float:
        finishes = library.finishes()
        if isinstance(value, str) and value in finishes:
            value = finishes[value]["roughness"]
        elif isinstance(value, str) and value[:1].isalpha():
            raise _no_preset("finish", value, finishes, self.describe())
        return super().parse(value)

    def describe(self) -> str:
        finishes = ", ".join(library.finishes())
        return f"{super().describe()}, or one of the finishes {finishes}"

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        length = super().__get_pydantic_json_schema__(schema, handler)
        return {"anyOf": [length, {"enum": list(library.finishes())}]}


Roughness = Annotated[
    float, _Roughness("an rms roughness", "m", "um", low=0.0, high=100.0, open_low=True)
]
_PinStiffness = Annotated[
    float, Quantity("a stiffness", "N/m", "N/um", low=0.0, high=1e7, open_low=True)
]
_ShortLength = Annotated[float, Quantity("a length", "m", "mm", low=0.0, high=1e5)]


class Material(Table):
    """Elastic constants of a solid."""

    title: str = "material of the case"
    elastic_modulus: Modulus
    poisson_ratio: Number = Field(default=0.3, ge=0.0, le=0.5)
    density: Density = Field(default=_as_text("7850 kg/m^3"))
    source: str = ""


@cache
def _material(name: str) -> Material:
    return Material.model_validate(library.materials()[name])


@cache
def _oil(name: str) -> Oil:
    return Oil.model_validate(library.oil_table(name))


_MATERIALS = Named(
    lambda: tuple(library.materials()),
    lambda: f"a table of properties or one of {', '.join(library.materials())}",
)
_OILS = Named(
    library.oil_names,
    lambda: "a table of properties or a name of the oil library (epicyclic oils)",
)


def _named_material(value: object) -> object:
    """The built-in material if `value` is a name; anything else goes on to be checked."""
    if not isinstance(value, str):
        return value
    if value not in _MATERIALS.names():
        raise _no_preset("material", value, _MATERIALS.names(), _MATERIALS.allowed())
    return _material(value)


def _named_oil(value: object) -> object:
    """The built-in oil if `value` is a name; anything else goes on to be checked."""
    if not isinstance(value, str):
        return value
    if value not in _OILS.names():
        raise _no_preset("oil", value, _OILS.names(), _OILS.allowed())
    return _oil(value)


NamedMaterial = Annotated[Material, BeforeValidator(_named_material), _MATERIALS]
NamedOil = Annotated[Oil, BeforeValidator(_named_oil), _OILS]


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
    fixed: Member | None = Field(
        default=None, description="The member held still; the third one is the output."
    )
    second_input: Member | None = Field(
        default=None, description="Instead of fixed: a second member of given speed."
    )
    second_speed: RotationalSpeed | None = Field(
        default=None, description="Speed of the second member; same sign = same sense of rotation."
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


class Gears(Table):
    """What all gears share."""

    EXACTLY_ONE = (
        ("normal_module", "transverse_module"),
        ("normal_pressure_angle", "transverse_pressure_angle"),
    )

    normal_module: Length | None = Field(default=None, description="m_n.")
    transverse_module: Length | None = Field(default=None, description="m_t = m_n/cos(beta).")
    normal_pressure_angle: (
        Annotated[float, Quantity("an angle", "rad", "deg", low=10.0, high=35.0)] | None
    ) = Field(default=None, description="alpha_n at the reference circle.")
    transverse_pressure_angle: (
        Annotated[float, Quantity("an angle", "rad", "deg", low=10.0, high=40.0)] | None
    ) = Field(default=None, description="alpha_t at the reference circle.")
    helix_angle: HelixAngle = Field(description="beta at the reference circle, magnitude.")
    center_distance: Length = Field(description="Of every mesh.")
    addendum_coefficient: Number = Field(
        default=1.0,
        gt=0,
        le=3,
        description="h_aP/m_n, for gears without tip_diameter. ISO 53, profile A.",
    )
    dedendum_coefficient: Number = Field(
        default=1.25,
        gt=0,
        le=4,
        description="h_fP/m_n, for gears without root_diameter. ISO 53, profile A.",
    )


ReliefShape = Literal["linear", "parabolic"]


class TopographyTable(Table):
    """Measured deviations of a flank, positive where material is missing."""

    diameter: tuple[Length, ...] = Field(description="Two or more, rising.")
    face_position: tuple[_ShortLength, ...] = Field(
        description="Two or more, rising, from the end of the face where contact begins."
    )
    deviation: tuple[tuple[Deviation, ...], ...] = Field(
        description="One row for each diameter, with one value for each face position."
    )


class MicroGeometryTable(Table):
    """Modifications and deviations of the working flanks, positive where material is missing."""

    tip_relief: SmallLength = Field(default=_as_text("0 um"), description="At the tip.")
    tip_relief_roll_length: Length | None = Field(
        default=None, description="Roll length from the tip to the start of the relief."
    )
    tip_relief_diameter: Length | None = Field(
        default=None, description="Instead of it: the diameter where the relief starts."
    )
    tip_relief_shape: ReliefShape = "linear"
    root_relief: SmallLength = Field(
        default=_as_text("0 um"), description="At the start of the active profile."
    )
    root_relief_roll_length: Length | None = Field(
        default=None, description="Roll length from the start of the active profile."
    )
    root_relief_diameter: Length | None = Field(
        default=None, description="Instead of it: the diameter where the relief starts."
    )
    root_relief_shape: ReliefShape = "linear"
    profile_crown: Deviation = Field(
        default=_as_text("0 um"), description="Parabola over the active profile."
    )
    profile_slope: Deviation = Field(
        default=_as_text("0 um"), description="Positive: material is missing at the tip."
    )
    lead_crown: Deviation = Field(
        default=_as_text("0 um"), description="Parabola over the face width of the gear."
    )
    lead_slope: Deviation = Field(
        default=_as_text("0 um"),
        description="Positive: material is missing at the end where contact ends.",
    )
    end_relief: SmallLength = Field(default=_as_text("0 um"), description="At both ends.")
    end_relief_length: Length | None = Field(default=None, description="From each end.")
    end_relief_shape: ReliefShape = "linear"
    topography: TopographyTable | None = Field(
        default=None, description="Deviations over the flank, added to the others."
    )


class GearTable(Table):
    """One gear."""

    STAND_INS: ClassVar[dict[str, object]] = {
        "roughness": "1 um",
        "material": None,
        "tool_tip_radius": None,
        "micro_geometry": None,
    }
    EXACTLY_ONE = (("tooth_thickness+thickness_diameter", "profile_shift_coefficient"),)

    teeth: int = Field(ge=5, le=2000, description="Number of teeth.")
    face_width: Length
    tip_diameter: Length | None = Field(
        default=None, description="Inner diameter of a ring. Default: from addendum_coefficient."
    )
    root_diameter: Length | None = Field(
        default=None, description="Default: from dedendum_coefficient."
    )
    tip_chamfer: _ShortLength = Field(
        default=_as_text("0 mm"),
        description="Radial height of the 45 degree chamfers of the tip corners.",
    )
    tooth_thickness: Length | None = Field(
        default=None, description="Transverse arc thickness at thickness_diameter."
    )
    thickness_diameter: Length | None = None
    profile_shift_coefficient: Number | None = Field(
        default=None, ge=-3, le=5, description="x; positive thickens the teeth, on a ring too."
    )
    roughness: Roughness = Field(description="rms roughness Rq of the flanks, or a finish.")
    material: NamedMaterial = Field(default=_as_text("steel"), description="A name or a table.")
    tool_tip_radius: _ShortLength | None = Field(
        default=None,
        description="Rounding of the cutting tool's tip, which leaves the root fillet. Default: "
        "0.38 m_n (rack) or 0.2 m_n (shaper), or less where the mate needs the involute.",
    )
    micro_geometry: MicroGeometryTable | None = Field(
        default=None, description="Modifications and deviations of the flanks."
    )


_RimThickness = Annotated[
    Length | None,
    Field(
        description="From root to outside. Default: 3 normal modules (estimate) for the drag, and "
        "a rim that is held on its outside and does not bend."
    ),
]


class PairGear(GearTable):
    """The gear that meets the pinion."""

    STAND_INS = GearTable.STAND_INS | {"rim_thickness": None}

    internal: bool = Field(default=False, description="true: a ring gear around the pinion.")
    rim_thickness: _RimThickness = None


class Planet(GearTable):
    """The planets, all alike."""

    STAND_INS = GearTable.STAND_INS | {
        "angles": None,
        "mass": None,
        "micro_geometry_ring_side": None,
    }

    count: int = Field(ge=1, le=24, description="Number of planets.")
    angles: tuple[Angle, ...] | None = Field(
        default=None,
        description="Position of each planet on the carrier. Default: the admissible positions "
        "nearest to equal spacing.",
    )
    mass: Mass | None = Field(
        default=None,
        description="Of one planet with its rollers. If given, its centrifugal force loads the "
        "planet bearing.",
    )
    micro_geometry_ring_side: MicroGeometryTable | None = Field(
        default=None,
        description="Of the flanks that work against the ring. Default: micro_geometry holds on "
        "both sides.",
    )


class Ring(GearTable):
    """The ring gear."""

    STAND_INS = GearTable.STAND_INS | {"rim_thickness": None}

    rim_thickness: _RimThickness = None


class MeshTable(Table):
    """What belongs to a mesh and to none of its gears."""

    STAND_INS: ClassVar[dict[str, object]] = {"misalignment": None}

    misalignment: Deviation = Field(
        default=_as_text("0 um"),
        description="F_beta_x over the common face width, in the plane of action; positive: the "
        "flanks open towards the end where contact ends.",
    )


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
        default=_as_text("3 um"), description="Drop of the profile at the roller's end (estimate)."
    )
    crown_length_fraction: Number = Field(
        default=0.2, ge=0, le=0.5, description="Crowned part of the length, at each end."
    )
    row_gap: _ShortLength = Field(
        default=_as_text("0 mm"), description="Axial gap between the rollers of neighbouring rows."
    )
    material: NamedMaterial = Field(default=_as_text("steel"), description="Of rollers and races.")


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


class LoadSharing(Table):
    """How the planets share the load."""

    method: Literal["equal", "mesh-load-factor", "closed-form", "direct"] = Field(
        default="equal",
        description="mesh-load-factor: one planet takes more; closed-form, direct: from "
        "position_errors and stiffness.",
    )
    mesh_load_factor: Number = Field(
        default=1.0,
        ge=1,
        le=24,
        description="K_gamma: load of the most loaded planet over the mean, at most planet.count.",
    )
    position_errors: tuple[Deviation, ...] | None = Field(
        default=None,
        description="Of each planet pin, against the sense in which a positive torque of the sun "
        "pushes it: a positive error loads its planet more.",
    )
    floating_member: Literal["sun", "ring", "carrier", "none"] = Field(
        default="sun", description="The member that gives way in the transverse plane."
    )
    support_stiffness: Stiffness = Field(
        default=_as_text("0 N/um"), description="Radial, of the floating member; 0: it floats."
    )
    pin_stiffness: _PinStiffness | None = Field(
        default=None,
        description="Radial, of one planet pin in the carrier, in series with the planet bearing. "
        "Default: rigid.",
    )

    def idle_keys(self) -> tuple[str, ...]:
        """Keys that are given other than by default and do not matter to the method."""
        elastic = ("position_errors", "floating_member", "support_stiffness", "pin_stiffness")
        needed = {
            "equal": (),
            "mesh-load-factor": ("mesh_load_factor",),
            "closed-form": elastic,
            "direct": elastic,
        }[self.method]
        idle = [key for key in (*elastic, "mesh_load_factor") if key not in needed]
        if self.method in ("closed-form", "direct") and self.floating_member == "none":
            idle.append("support_stiffness")
        fields = type(self).model_fields
        defaults = type(self)()
        return tuple(
            key for key in fields if key in idle and getattr(self, key) != getattr(defaults, key)
        )


class Lubricant(Table):
    """The oil."""

    STAND_INS: ClassVar[dict[str, object]] = {"pressure_viscosity_factor": None}

    oil: NamedOil = Field(
        description="A name of the oil library (epicyclic oils) or a table of properties."
    )
    pressure_viscosity_factor: Number = Field(
        default=1.0,
        ge=0.1,
        le=10,
        description="Multiplies the pressure-viscosity coefficient of the oil.",
    )


class Surroundings(Table):
    """What surrounds the gears."""

    oil_air_ratio: Number = Field(
        default=0.05, ge=0, le=1, description="Oil share by volume at ambient pressure."
    )
    pressure: Pressure = Field(default=_as_text("1.01325 bar"), description="Ambient pressure.")


FrictionName = Literal[
    "auto",
    "mixed-ehl",
    "schlenk",
    "niemann-winter",
    "benedict-kelley",
    "matsumoto",
    "doleschel",
    "xu-2007",
    "constant",
    "table",
    "fitted",
    "ehl-direct",
]


Coefficient = Annotated[Number, Field(ge=0, le=1)]


def _values_or_rows(value: object) -> str:
    """Which of its two forms a list of coefficients has."""
    rows = isinstance(value, list | tuple) and any(isinstance(row, list | tuple) for row in value)
    return "rows" if rows else "values"


Coefficients = Annotated[
    Annotated[tuple[Coefficient, ...], Tag("values")]
    | Annotated[tuple[tuple[Coefficient, ...], ...], Tag("rows")],
    Discriminator(_values_or_rows),
]


class FrictionTable(Table):
    """A user's coefficients of friction against one or two quantities of the contact.

    Between the points linear, beyond them constant.
    """

    AXES: ClassVar = ("slide_to_roll_ratio", "film_ratio", "hertz_pressure", "rolling_speed")

    slide_to_roll_ratio: tuple[Number, ...] | None = None
    film_ratio: tuple[Number, ...] | None = None
    hertz_pressure: tuple[HertzPressure, ...] | None = None
    rolling_speed: tuple[Speed, ...] | None = None
    friction: Coefficients = Field(
        description="One value, or one row, for each value of the first axis."
    )

    def axes(self) -> dict[str, tuple[float, ...]]:
        """The axes given, by name."""
        given = {name: getattr(self, name) for name in self.AXES}
        return {name: points for name, points in given.items() if points is not None}

    def shape(self) -> tuple[int, ...]:
        """Shape of `friction`; -1 for rows of unequal length."""
        lengths = {len(row) for row in self.friction if isinstance(row, tuple)}
        if not lengths:
            return (len(self.friction),)
        return (len(self.friction), lengths.pop() if len(lengths) == 1 else -1)


Stress = Annotated[float, Quantity("a stress", "Pa", "MPa", low=0.0, high=1e6, open_low=True)]


class ContactSolver(Table):
    """How the contacts of a mesh are solved for friction = ehl-direct."""

    eyring_stress: Stress = Field(
        default=_as_text("5 MPa"),
        description="Stress beyond which the oil thins (estimate; mineral oils 2 to 10 MPa).",
    )
    correlation_length: SmallLength = Field(
        default=_as_text("20 um"), description="Of the roughness of both flanks (estimate)."
    )
    seed: int = Field(default=1, ge=0, description="Of the generated profiles.")
    error: Number = Field(
        default=0.05, gt=0, le=1, description="Mean error wanted at contacts that take no part."
    )
    most_contacts: int = Field(
        default=48, ge=12, le=5000, description="Solved for one mesh at most."
    )


class GearPairModels(Table):
    """Which method computes what."""

    STAND_INS: ClassVar[dict[str, object]] = {
        "constant_friction": None,
        "boundary_friction": None,
        "fluid_friction": None,
        "rolling": None,
        "oil_model": None,
        "fitted_form": None,
        "load_distribution": None,
        "mesh": None,
        "pocketing": None,
        "pocketing_table": None,
        "pocket_end_length": None,
        "drag": None,
        "bearing_viscous": None,
        "planet_tilt": None,
    }

    friction: FrictionName = Field(
        default="auto",
        description="auto: mixed-ehl for the fluid it was made for, else schlenk; ehl-direct: the "
        "contacts of the mesh solved.",
    )
    constant_friction: Number = Field(
        default=0.04, ge=0, le=1, description="For friction = constant."
    )
    boundary_friction: Number = Field(
        default=0.10,
        ge=0,
        le=1,
        description="Of dry contact, for matsumoto and doleschel (estimate; an oil's own is "
        "measured).",
    )
    fluid_friction: Number = Field(
        default=0.02,
        ge=0,
        le=1,
        description="Of separated contact, for matsumoto and doleschel (estimate, as above).",
    )
    rolling: Literal["auto", "mixed-ehl", "goksem-hargreaves", "fitted"] = Field(
        default="auto",
        description="auto: mixed-ehl for the fluid it was made for, else goksem-hargreaves.",
    )
    oil_model: str | None = Field(
        default=None,
        description="For fitted: the file of 'epicyclic oil characterise', from the folder of the "
        "case.",
    )
    fitted_form: Literal["structured", "regression"] = Field(
        default="structured", description="For fitted: which form of the file."
    )
    load_distribution: Literal["uniform", "minimum-energy", "compliance"] = Field(
        default="compliance",
        description="Along the contact lines: even, after a stiffness, or from elastic teeth.",
    )
    mesh: Literal["local", "loss-factor"] = Field(
        default="local",
        description="local: along the contact lines; loss-factor: mean friction times Ohlendorf's.",
    )
    pocketing: Literal["isentropic", "mean-density", "incompressible", "central-differences"] = (
        Field(
            default="mean-density",
            description="Fluid in the pockets: isentropic and mean-density: compressible mixture; "
            "incompressible: mixture of constant density; central-differences: mean-density with "
            "the convective term of the source, for low speed.",
        )
    )
    pocketing_table: str | None = Field(
        default=None,
        description="Read the flow through the pockets from this file of 'epicyclic "
        "pockets-table', from the folder of the case.",
    )
    pocket_end_length: Number = Field(
        default=1.0,
        ge=0.1,
        le=10,
        description="Of the control volumes at the ends of the face, in normal modules.",
    )
    drag: Literal["seetharaman-kahraman"] = "seetharaman-kahraman"


class PlanetaryModels(GearPairModels):
    """Which method computes what, with the planet bearing."""

    bearing: Literal["auto", "mixed-ehl", "palmgren", "fitted"] = Field(
        default="auto", description="auto: mixed-ehl for the fluid it was made for, else palmgren."
    )
    bearing_viscous: Literal["harris"] = "harris"
    planet_tilt: Literal["left-out", "coupled"] = Field(
        default="left-out",
        description="coupled: the planet tilts in its bearing and misaligns its meshes.",
    )


class Numerics(Table):
    """Resolution."""

    mesh_positions: int = Field(default=20, ge=4, le=1000)
    contact_segments: int = Field(default=20, ge=2, le=1000)
    bearing_slices: int = Field(default=20, ge=3, le=500, description="On each roller.")
    pocket_slices: int = Field(
        default=24, ge=3, le=200, description="Of the pockets, across the face; at least."
    )
    pocket_steps: int = Field(
        default=32, ge=8, le=1000, description="Time steps of the pocket flow in one pitch."
    )
    pocket_interpolation: Number = Field(
        default=0.002,
        ge=0,
        le=0.1,
        description="Largest error of pocketing losses that sweeps interpolate; 0 solves each.",
    )


class LossOption(Table):
    """What becomes of one loss term."""

    include: bool = Field(default=True, description="false leaves the term out.")
    factor: Number = Field(default=1.0, ge=0, le=100, description="Multiplies the term.")


_AS_COMPUTED = LossOption()


class PlanetaryLosses(Table):
    """Options of each loss term."""

    sun_mesh_sliding: LossOption = _AS_COMPUTED
    sun_mesh_rolling: LossOption = _AS_COMPUTED
    ring_mesh_sliding: LossOption = _AS_COMPUTED
    ring_mesh_rolling: LossOption = _AS_COMPUTED
    planet_bearing_mechanical: LossOption = _AS_COMPUTED
    planet_bearing_viscous: LossOption = _AS_COMPUTED
    sun_mesh_pocketing: LossOption = _AS_COMPUTED
    ring_mesh_pocketing: LossOption = _AS_COMPUTED
    sun_drag: LossOption = _AS_COMPUTED
    ring_drag: LossOption = _AS_COMPUTED
    carrier_drag: LossOption = _AS_COMPUTED
    thrust_bearing_viscous: LossOption = _AS_COMPUTED


class GearPairLosses(Table):
    """Options of each loss term."""

    mesh_sliding: LossOption = _AS_COMPUTED
    mesh_rolling: LossOption = _AS_COMPUTED
    mesh_pocketing: LossOption = _AS_COMPUTED
    drag: LossOption = _AS_COMPUTED
