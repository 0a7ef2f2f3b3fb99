"""Tables of a case file on how it is computed: models, their settings, resolution, losses."""

from __future__ import annotations

from dataclasses import fields
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from epicyclic.case.tables.base import Stress
from epicyclic.errors import Problem
from epicyclic.gears.flanks import HURST_EXPONENT, RUNNING_IN
from epicyclic.messages import value_at
from epicyclic.oil.oil import Conductivity, HeatCapacity
from epicyclic.oil.rheology import (
    DEFAULT,
    PRESETS,
    PRESSURE_LAWS,
    SHEAR_LAWS,
    SLOPE_RATIO,
    TRANSITION,
    Assumptions,
    OilLaws,
    PressureLaw,
    ReeEyring,
)
from epicyclic.schema.fields import PointsTable, Table, ValuesOrRows, option
from epicyclic.units import (
    Deviation,
    HertzPressure,
    Number,
    PressureViscosity,
    Quantity,
    SmallLength,
    Speed,
    Stiffness,
)

# Keys that choose how an oil behaves in a line contact.

LoadPressure = Annotated[
    float, Quantity("a pressure", "Pa", "GPa", low=0.0, high=100.0, open_low=True)
]

PRESSURE_NAMES: dict[type[PressureLaw], Any] = {law: name for name, law in PRESSURE_LAWS.items()}
USUAL = PRESETS[DEFAULT]
LoadDependent = Literal["computed", "as-tested"]
"""What load-dependent losses are; `study.sweeps.run` says how a rig forms them."""
COMPUTED: LoadDependent = "computed"
AS_TESTED: LoadDependent = "as-tested"
PresetName = Literal["usual", "as-published"]
PRESET = (
    "Assumptions for keys that are not given; as-published: those made before the comparison "
    "with the dissertation."
)
"""What the key says."""


def film_text(assumed: Assumptions) -> str:
    """The film of touching as a file has it."""
    return f"{assumed.film * 1e9:g} nm"


def behaviour_of(preset: object) -> dict[str, object]:
    """Keys of `OilBehaviour` that a preset sets; none for a name that there is not."""
    assumed = PRESETS.get(str(preset))
    if assumed is None:
        return {}
    law = PRESSURE_NAMES[assumed.pressure_law]
    return {"pressure_law": law, "eyring_stress": f"{assumed.eyring_stress * 1e-6:g} MPa"}


HeatingModel = Literal["isothermal", "inlet-and-film"]
HEATING = "With or without thinner inlet film, flash and film temperature."  # What the key says.
NEEDED = {"limiting-stress": ("shear_stress",), "carreau": ("shear_stress", "shear_exponent")}
"""Keys without which a law cannot be used."""
OF_TWO_SLOPES = ("second_slope", "slope_ratio", "transition_pressure")
"""Keys of that law, which has a default for each."""
KEYS = {"stress": "shear_stress", "slope": "shear_stress_slope", "exponent": "shear_exponent"}
"""Keys that hold the constants of a law of shear."""


class OilBehaviour(Table):
    """Viscosity under pressure and under shear."""

    pressure_law: Literal["roelands", "barus", "two-slope"] = option(
        "Law of the viscosity under pressure.", PRESSURE_NAMES[USUAL.pressure_law]
    )
    slope_ratio: Number = option(
        "For two-slope: slope at high over that at ambient pressure (estimate).",
        SLOPE_RATIO,
        gt=0.0,
        le=1.0,
    )
    second_slope: PressureViscosity | None = option(
        "For two-slope: slope at high pressure, instead of slope_ratio."
    )
    transition_pressure: LoadPressure = option(
        "For two-slope: where the slopes meet (estimate).", f"{TRANSITION * 1e-9:g} GPa"
    )
    eyring_stress: Stress = option(
        "For the default law: stress above which the oil thins (estimate; mineral oils 2 to 10 "
        "MPa).",
        f"{USUAL.eyring_stress * 1e-6:g} MPa",
    )
    shear_law: Literal["ree-eyring", "newtonian", "limiting-stress", "carreau"] = option(
        "Law of the viscosity under shear.", "ree-eyring"
    )
    shear_stress: Stress | None = option("For limiting-stress and carreau: the stress of the law.")
    shear_stress_slope: Number = option(
        "For ree-eyring and limiting-stress: rise of the stress with the pressure.",
        0.0,
        ge=0.0,
        le=1.0,
    )
    shear_exponent: Number | None = option("For carreau: exponent n.", gt=0.0, le=1.0)


def law_problems(section: str, table: OilBehaviour) -> list[Problem]:
    """Each law has the keys that it needs, and no others are given."""
    chosen = (table.pressure_law, table.shear_law)
    needed = {key: law for law in chosen for key in NEEDED.get(law, ())}
    problems = []
    for key in sorted({key for keys in NEEDED.values() for key in keys}):
        given = getattr(table, key) is not None
        if key in needed and not given:
            allowed = f"is missing, but {needed[key]} needs it."
            problems.append(Problem(f"{section}.{key}", "", allowed, "Give it."))
        elif given and key not in needed:
            laws = " and ".join(law for law, keys in NEEDED.items() if key in keys)
            remedy = "Choose such a law, or leave it out."
            problems.append(Problem(f"{section}.{key}", "", f"applies to {laws} only.", remedy))
    return problems + [
        Problem(f"{section}.{key}", "", "applies to two-slope only.", "Choose it, or leave it out.")
        for key in OF_TWO_SLOPES
        if table.pressure_law != "two-slope" and getattr(table, key) != getattr(_USUAL_OIL, key)
    ]


_USUAL_OIL = OilBehaviour()


def oil_laws(table: OilBehaviour) -> OilLaws:
    """The laws that a table without problems chooses."""
    law, keys = SHEAR_LAWS[table.shear_law], ["eyring_stress", "shear_stress_slope"]
    if law is not ReeEyring:
        keys = [KEYS[field.name] for field in fields(law)]
    return OilLaws(
        PRESSURE_LAWS[table.pressure_law],
        law(*(getattr(table, key) for key in keys)),
        table.second_slope,
        table.slope_ratio,
        table.transition_pressure,
    )


_VoidPressure = Annotated[float, Quantity("a pressure", "Pa", "bar", low=0.0, high=1.0)]
_PinStiffness = Annotated[
    float, Quantity("a stiffness", "N/m", "N/um", low=0.0, high=1e7, open_low=True)
]


class LoadSharing(Table):
    """How the planets share the load."""

    method: Literal["equal", "mesh-load-factor", "closed-form", "direct"] = option(
        "mesh-load-factor: one planet carries more; closed-form, direct: from position_errors "
        "and stiffness.",
        "equal",
    )
    mesh_load_factor: Number = option(
        "K_gamma: load of the most loaded planet over the mean, at most planet.count.",
        1.0,
        ge=1,
        le=24,
    )
    position_errors: tuple[Deviation, ...] | None = option(
        "Tangential position error of each planet pin, against the direction in which a "
        "positive torque of the sun pushes it. A positive error loads its planet more."
    )
    floating_member: Literal["sun", "ring", "carrier", "none"] = option(
        "The member that can move in the transverse plane.", "sun"
    )
    support_stiffness: Stiffness = option("Radial, of the floating member; 0: it floats.", "0 N/um")
    pin_stiffness: _PinStiffness | None = option(
        "Radial stiffness of one planet pin in the carrier, in series with the planet bearing. "
        "Default: rigid."
    )


FrictionName = Literal[
    "auto",
    "mixed-lubrication",
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


class FrictionTable(PointsTable):
    """A user's coefficients of friction against one or two quantities of the contact.

    Between the points linear, beyond them constant.
    """

    AXES: ClassVar = ("slide_to_roll_ratio", "film_ratio", "hertz_pressure", "rolling_speed")

    slide_to_roll_ratio: tuple[Number, ...] | None = None
    film_ratio: tuple[Number, ...] | None = None
    hertz_pressure: tuple[HertzPressure, ...] | None = None
    rolling_speed: tuple[Speed, ...] | None = None
    friction: ValuesOrRows[Coefficient] = Field(
        description="One value or one row for each value of the first axis."
    )


class ContactSolver(OilBehaviour):
    """How the contacts of a mesh are solved for friction = ehl-direct."""

    preset: PresetName = option(PRESET, DEFAULT)
    heating: HeatingModel = option(HEATING, "isothermal")
    solid_conductivity: Conductivity | None = option(
        "With heating. Default: that of the material of each gear."
    )
    solid_heat_capacity: HeatCapacity | None = option(
        "With heating. Default: that of the material of each gear."
    )
    asperity_film: SmallLength = option(
        "Film thickness below which flanks touch (estimate).", film_text(USUAL)
    )
    correlation_length: SmallLength = option("That of both flanks' roughness (estimate).", "20 um")
    seed: int = option("Seed of the generated profiles.", 1, ge=0)
    error: Number = option("Target for the mean error at contacts not solved.", 0.05, gt=0, le=1)
    most_contacts: int = option("Solved for one mesh at most.", 48, ge=12, le=5000)

    @model_validator(mode="before")
    @classmethod
    def _assume(cls, keys: Any) -> Any:
        """Fill in what the preset says of keys that are not given."""
        preset = value_at(keys, ("preset",))
        if not isinstance(preset, str) or preset not in PRESETS:
            return keys
        return {**behaviour_of(preset), "asperity_film": film_text(PRESETS[preset]), **keys}


TemperatureModel = Literal["inlet", "flank", "network"]


class GearPairModels(Table):
    """Methods of computation."""

    preset: Literal["general", "talbot-2012"] = option(
        "What auto stands for: general: models for any oil; talbot-2012: the regressions of that "
        "study for its fluid, for others fits to simulated contacts where there are some, else "
        "formulas.",
        "general",
    )
    friction: FrictionName = option(
        "auto: mixed-lubrication, or that of the preset; ehl-direct: the contacts of the mesh "
        "solved.",
        "auto",
    )
    constant_friction: Number = option("For friction = constant.", 0.04, ge=0, le=1)
    boundary_friction: Number | None = option(
        "Of dry contact (estimate; an oil's own is measured). Default: by the additives of the oil "
        "for mixed-lubrication, 0.10 for matsumoto and doleschel, 0.12 for ehl-direct.",
        ge=0,
        le=1,
    )
    running_in: Literal["run-in", "as-made"] = option(
        "State of the flanks for mixed-lubrication. as-made: also of flanks whose roughness was "
        "measured after running.",
        "run-in",
    )
    running_in_factor: Number = option(
        "Roughness after running-in over that as made (estimate).", RUNNING_IN, gt=0, le=1
    )
    profile_cutoff: SmallLength | None = option(
        "Of the profiles whose roughness is stated. Default: as ISO 21920-3 has it for their "
        "roughness, some 0.8 mm for Ra 0.45 um."
    )
    hurst_exponent: Number = option(
        "Of the profile: how its roughness grows with the length seen (estimate; machined "
        "steel 0.3 to 0.8).",
        HURST_EXPONENT,
        ge=0,
        le=1,
    )
    fluid_friction: Number = option(
        "Of separated contact, for matsumoto and doleschel (estimate, as above).", 0.02, ge=0, le=1
    )
    application_factor: LoadFactor = option(
        "K_A, in the load of the formula niemann-winter only.", 1.0
    )
    mesh_load_factor: LoadFactor = option(
        "K_gamma, likewise; the load of the planets is set by load_sharing.", 1.0
    )
    rolling: Literal[
        "auto",
        "mixed-ehl",
        "mixed-ehl+pairing",
        "goksem-hargreaves",
        "fitted",
        "fitted-or-goksem-hargreaves",
    ] = option(
        "auto: none with schlenk and niemann-winter, which contain it; else goksem-hargreaves, or "
        "that of the preset.",
        "auto",
    )
    oil_model: str | None = option(
        "For fitted and auto: a file of 'epicyclic oil characterise', relative to the folder "
        "of the case. Default: the models built in for the oil."
    )
    fitted_form: Literal["structured", "regression"] = option(
        "For fitted: the form of the model in the file.", "structured"
    )
    load_distribution: Literal["uniform", "minimum-energy", "compliance"] = option(
        "Along the contact lines: uniform, by stiffness, or from elastic teeth.", "compliance"
    )
    mesh_loads: Literal["with-losses", "without-losses"] = option(
        "Loads of the teeth: from the torques in balance with all losses, or from those of the "
        "set without its own losses at the given torque, as in the source.",
        "with-losses",
    )
    load_dependent: LoadDependent = option(
        "Definition of the load-dependent loss: the sum of the load-dependent terms, or, as on "
        "a test rig, the increase of the total due to torque.",
        COMPUTED,
    )
    mesh: Literal["local", "loss-factor"] = option(
        "local: along the contact lines; loss-factor: mean friction times Ohlendorf's.", "local"
    )
    pocketing: Literal[
        "auto", "incompressible", "isentropic", "mean-density", "central-differences", "talbot-2012"
    ] = option(
        "Fluid in the pockets: incompressible: mixture of constant density above the pressure of "
        "a void; isentropic, mean-density: compressible mixture; auto: incompressible, isentropic "
        "with less oil than 0.005; central-differences: mean-density with the convective term of "
        "the source, for low speed; talbot-2012: for comparison with that study.",
        "auto",
    )
    pocket_void_pressure: _VoidPressure = option(
        "Absolute pressure of a void in the pockets, for pocketing = incompressible.", "0.01 bar"
    )
    pocketing_table: str | None = option(
        "File of 'epicyclic pockets table', relative to the folder of the case, with the flow "
        "through the pockets."
    )
    pocket_end_length: Number = option(
        "Of the control volumes at the ends of the face, in normal modules.", 1.0, ge=0.1, le=10
    )
    drag: Literal[
        "auto",
        "diab-ville-velex",
        "anderson-loewenthal",
        "theodorsen-regier",
        "seetharaman-kahraman",
    ] = option(
        "Of rims, faces and teeth in air, mist or mixture. diab-ville-velex: laminar to turbulent, "
        "with windage of the teeth; anderson-loewenthal: gears in much air and little oil; "
        "theodorsen-regier: smooth bodies; seetharaman-kahraman: laminar rims. auto: "
        "diab-ville-velex, or seetharaman-kahraman with the preset talbot-2012.",
        "auto",
    )
    temperatures: TemperatureModel = option(
        "inlet: all parts are at the oil inlet temperature; flank: gears are heated by their "
        "own meshes; network: heat flows between all parts, the oil and the surroundings.",
        "inlet",
    )
    oil_beyond_range: Literal["held", "extrapolated"] = option(
        "Viscosity and pressure-viscosity coefficient outside the range of the mixed-EHL "
        "regressions: held at the limit of the range, or extrapolated.",
        "held",
    )


OF_ROUGH_FLANKS = ("running_in_factor", "hurst_exponent")
"""Uncertain keys of the friction mixed-lubrication."""


def has_rough_flanks(models: GearPairModels) -> bool:
    """Whether the friction is mixed-lubrication."""
    general = models.friction == "auto" and models.preset == "general"
    return general or models.friction == "mixed-lubrication"


class PlanetaryModels(GearPairModels):
    """Which method computes what, with the planet bearing."""

    bearing: Literal[
        "auto", "mixed-ehl", "palmgren", "fitted", "fitted-or-palmgren", "full-complement"
    ] = option(
        "auto: for caged rollers mixed-ehl with the fluid it was made for and "
        "fitted-or-palmgren with an oil that has fitted models, else palmgren. full-complement: "
        "mixed-ehl, and the sliding of rollers without a cage.",
        "auto",
    )
    bearing_viscous: Literal["harris"] = "harris"
    planet_tilt: Literal["left-out", "coupled"] = option(
        "coupled: the planet tilts in its bearing and misaligns its meshes.", "left-out"
    )


# no check across tables depends on any other of these keys
GearPairModels.STAND_INS = PlanetaryModels.STAND_INS = dict.fromkeys(
    PlanetaryModels.model_fields.keys() - {"friction", "bearing"}
)


class Numerics(Table):
    """Numerical resolution."""

    mesh_positions: int = Field(default=20, ge=4, le=1000)
    contact_segments: int = Field(default=20, ge=2, le=1000)
    bearing_slices: int = option("Slices along each roller.", 20, ge=3, le=500)
    pocket_slices: int = option("Least number across the face.", 24, ge=3, le=200)
    pocket_steps: int = option("Time steps of the pocket flow in one pitch.", 32, ge=8, le=1000)
    pocket_interpolation: Number = option(
        "Largest error of interpolated pocketing losses in sweeps; 0: no interpolation.",
        0.002,
        ge=0,
        le=0.1,
    )


class LossOption(Table):
    """Options of one loss term."""

    include: bool = option("false leaves the term out.", True)
    factor: Number = option("Multiplies the term.", 1.0, ge=0, le=100)


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
    planets_drag: LossOption = _AS_COMPUTED
    thrust_bearing_viscous: LossOption = _AS_COMPUTED


class GearPairLosses(Table):
    """Options of each loss term."""

    mesh_sliding: LossOption = _AS_COMPUTED
    mesh_rolling: LossOption = _AS_COMPUTED
    mesh_pocketing: LossOption = _AS_COMPUTED
    drag: LossOption = _AS_COMPUTED
