"""Tables of a case file on how it is computed: models, their settings, resolution, losses."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, Tag, model_validator

from epicyclic.case.oil_laws import (
    HEATING,
    PRESET,
    USUAL,
    HeatingModel,
    OilBehaviour,
    PresetName,
    behaviour_of,
    film_text,
)
from epicyclic.case.plain import value_at
from epicyclic.case.schema import VALUES_OR_ROWS, PointsTable, Table
from epicyclic.oil.oil import Conductivity, HeatCapacity
from epicyclic.oil.rheology import DEFAULT, PRESETS
from epicyclic.units import (
    Deviation,
    HertzPressure,
    Number,
    Quantity,
    SmallLength,
    Speed,
    Stiffness,
    as_stated,
)

_VoidPressure = Annotated[float, Quantity("a pressure", "Pa", "bar", low=0.0, high=1.0)]
_PinStiffness = Annotated[
    float, Quantity("a stiffness", "N/m", "N/um", low=0.0, high=1e7, open_low=True)
]


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
        default=as_stated("0 N/um"), description="Radial, of the floating member; 0: it floats."
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
        if not self.model_fields_set:
            return ()
        fields = type(self).model_fields
        defaults = type(self)()
        return tuple(
            key for key in fields if key in idle and getattr(self, key) != getattr(defaults, key)
        )


FrictionName = Literal[
    "auto",
    "mixed-ehl",
    "mixed-ehl+pairing",
    "schlenk",
    "niemann-winter",
    "benedict-kelley",
    "matsumoto",
    "doleschel",
    "xu-2007",
    "constant",
    "table",
    "fitted",
    "fitted-or-schlenk",
    "ehl-direct",
]


Coefficient = Annotated[Number, Field(ge=0, le=1)]
LoadFactor = Annotated[Number, Field(ge=1, le=10)]


Coefficients = Annotated[
    Annotated[tuple[Coefficient, ...], Tag("values")]
    | Annotated[tuple[tuple[Coefficient, ...], ...], Tag("rows")],
    VALUES_OR_ROWS,
]


class FrictionTable(PointsTable):
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

    def shape(self) -> tuple[int, ...]:
        """Shape of `friction`; -1 for rows of unequal length."""
        lengths = {len(row) for row in self.friction if isinstance(row, tuple)}
        if not lengths:
            return (len(self.friction),)
        return (len(self.friction), lengths.pop() if len(lengths) == 1 else -1)


class ContactSolver(OilBehaviour):
    """How the contacts of a mesh are solved for friction = ehl-direct."""

    preset: PresetName = Field(default=DEFAULT, description=PRESET)
    heating: HeatingModel = Field(default="isothermal", description=HEATING)
    solid_conductivity: Conductivity | None = Field(
        default=None, description="With heating. Default: that of the material of each gear."
    )
    solid_heat_capacity: HeatCapacity | None = Field(
        default=None, description="With heating. Default: that of the material of each gear."
    )
    asperity_film: SmallLength = Field(
        default=as_stated(film_text(USUAL)),
        description="Film below which flanks touch (estimate).",
    )
    correlation_length: SmallLength = Field(
        default=as_stated("20 um"), description="Of the roughness of both flanks (estimate)."
    )
    seed: int = Field(default=1, ge=0, description="Of the generated profiles.")
    error: Number = Field(
        default=0.05, gt=0, le=1, description="Mean error wanted at contacts that take no part."
    )
    most_contacts: int = Field(
        default=48, ge=12, le=5000, description="Solved for one mesh at most."
    )

    @model_validator(mode="before")
    @classmethod
    def _assume(cls, keys: Any) -> Any:
        """Fill in what the preset says of keys that are not given."""
        preset = value_at(keys, ("preset",))
        if preset not in PRESETS:
            return keys
        film = film_text(PRESETS[preset])
        return {**behaviour_of(preset), "asperity_film": film, **keys}


TemperatureModel = Literal["inlet", "flank", "network"]


class GearPairModels(Table):
    """Which method computes what."""

    STAND_INS: ClassVar[dict[str, object]] = {
        "constant_friction": None,
        "boundary_friction": None,
        "fluid_friction": None,
        "application_factor": None,
        "mesh_load_factor": None,
        "rolling": None,
        "oil_model": None,
        "fitted_form": None,
        "load_distribution": None,
        "mesh_loads": None,
        "load_dependent": None,
        "mesh": None,
        "pocketing": None,
        "pocket_void_pressure": None,
        "pocketing_table": None,
        "pocket_end_length": None,
        "drag": None,
        "temperatures": None,
        "oil_beyond_range": None,
        "bearing_viscous": None,
        "planet_tilt": None,
    }

    friction: FrictionName = Field(
        default="auto",
        description="auto: mixed-ehl for the fluid it was made for, fitted-or-schlenk for an oil "
        "with fitted models, else schlenk; ehl-direct: the contacts of the mesh solved.",
    )
    constant_friction: Number = Field(
        default=0.04, ge=0, le=1, description="For friction = constant."
    )
    boundary_friction: Number | None = Field(
        default=None,
        ge=0,
        le=1,
        description="Of dry contact (estimate; an oil's own is measured). Default: 0.10 for "
        "matsumoto and doleschel, 0.12 for ehl-direct.",
    )
    fluid_friction: Number = Field(
        default=0.02,
        ge=0,
        le=1,
        description="Of separated contact, for matsumoto and doleschel (estimate, as above).",
    )
    application_factor: LoadFactor = Field(
        default=1.0, description="K_A, in the load of the formula niemann-winter only."
    )
    mesh_load_factor: LoadFactor = Field(
        default=1.0,
        description="K_gamma, in the same place; what planets carry is up to load_sharing.",
    )
    rolling: Literal[
        "auto",
        "mixed-ehl",
        "mixed-ehl+pairing",
        "goksem-hargreaves",
        "fitted",
        "fitted-or-goksem-hargreaves",
    ] = Field(
        default="auto",
        description="auto: mixed-ehl for the fluid it was made for, fitted-or-goksem-hargreaves "
        "for an oil with fitted models, else goksem-hargreaves.",
    )
    oil_model: str | None = Field(
        default=None,
        description="For fitted and auto: a file of 'epicyclic oil characterise', from the folder "
        "of the case. Default: the models built in for the oil.",
    )
    fitted_form: Literal["structured", "regression"] = Field(
        default="structured", description="For fitted: which form of the file."
    )
    load_distribution: Literal["uniform", "minimum-energy", "compliance"] = Field(
        default="compliance",
        description="Along the contact lines: even, after a stiffness, or from elastic teeth.",
    )
    mesh_loads: Literal["with-losses", "without-losses"] = Field(
        default="with-losses",
        description="What the teeth carry: the torques in balance with all losses; or those of the "
        "set without its own losses, at the given torque, as in the source.",
    )
    load_dependent: Literal["computed", "as-tested"] = Field(
        default="computed",
        description="Which loss counts as load-dependent: each by its kind; or, as on a test rig, "
        "what torque adds to the total.",
    )
    mesh: Literal["local", "loss-factor"] = Field(
        default="local",
        description="local: along the contact lines; loss-factor: mean friction times Ohlendorf's.",
    )
    pocketing: Literal[
        "auto",
        "incompressible",
        "isentropic",
        "mean-density",
        "central-differences",
        "talbot-2012",
    ] = Field(
        default="auto",
        description="Fluid in the pockets: incompressible: mixture of constant density above the "
        "pressure of a void; isentropic, mean-density: compressible mixture; auto: incompressible, "
        "isentropic with less oil than 0.005; central-differences: mean-density with the "
        "convective term of the source, for low speed; talbot-2012: for comparison with that "
        "study.",
    )
    pocket_void_pressure: _VoidPressure = Field(
        default=as_stated("0.01 bar"),
        description="Absolute pressure of a void in the pockets, for pocketing = incompressible.",
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
    temperatures: TemperatureModel = Field(
        default="inlet",
        description="inlet: everything at the oil inlet temperature; flank: gears warmed by their "
        "own meshes; network: heat flows between all parts, the oil and the surroundings.",
    )
    oil_beyond_range: Literal["held", "extrapolated"] = Field(
        default="held",
        description="Viscosity and pressure-viscosity outside the range of the mixed-EHL "
        "regressions: held at its limit, or the formula continued.",
    )


class PlanetaryModels(GearPairModels):
    """Which method computes what, with the planet bearing."""

    bearing: Literal["auto", "mixed-ehl", "palmgren", "fitted", "fitted-or-palmgren"] = Field(
        default="auto",
        description="auto: of caged rollers mixed-ehl for the fluid it was made for and "
        "fitted-or-palmgren for an oil with fitted models, else palmgren.",
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
