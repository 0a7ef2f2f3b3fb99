"""A gear set of a case with the models that it chooses, and the oil around it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import cast

from epicyclic import library
from epicyclic.case.case import Case, GearPairCase, PlanetaryCase, TrainCase
from epicyclic.case.rules import oil_model_of
from epicyclic.case.tables.elements import Carrier, PlanetBearing, PlanetPin, ThrustBearing
from epicyclic.case.tables.models import (
    ContactSolver,
    FrictionTable,
    LoadSharing,
    LossOption,
    Numerics,
    PlanetaryModels,
)
from epicyclic.case.tables.operation import (
    OWN_SHARE_KEY,
    SHARE_KEY,
    WETTING,
    Lubricant,
    LubricationTable,
    Surroundings,
    ThermalTable,
)
from epicyclic.case.train_tables import ComputedSet, ListedSet
from epicyclic.contact.fitted_models import OilModel
from epicyclic.contact.temperatures import Solid
from epicyclic.dataclass import dataclass, replace
from epicyclic.errors import InputError, Problem
from epicyclic.gears.gearing import Gearing
from epicyclic.gears.stated import StatedMaterial
from epicyclic.kernels.line_contact import equivalent_modulus
from epicyclic.losses.friction import (
    CONTAINS_ROLLING,
    FRICTION_MODELS,
    TALBOT_FLUID,
    FrictionMap,
    FrictionModel,
    FrictionSettings,
    friction_model,
)
from epicyclic.losses.mixed_lubrication import Surfaces
from epicyclic.losses.planet_bearing import FITTED_OR_PALMGREN
from epicyclic.losses.pocket_flow import LEAST_OIL, PocketModel
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.losses.ranges import FITTED_QUANTITIES
from epicyclic.losses.reliability import RELIABILITY, reliability
from epicyclic.losses.rolling import (
    CONTAINED,
    ROLLING_MODELS,
    FittedFriction,
    FittedOrGoksem,
    FittedOrSchlenk,
    FittedRolling,
    RollingModel,
)
from epicyclic.losses.windage import LAMINAR_RIMS
from epicyclic.machine.element import Fluids, fluids_at
from epicyclic.machine.gear_mesh import MeshModels
from epicyclic.machine.gear_set import LossChoice
from epicyclic.machine.pocket_flow import PocketSettings
from epicyclic.registry import load, offered

ONLY_WITH: dict[tuple[str, str], tuple[tuple[str, ...], tuple[str, ...]]] = {
    ("models", "constant_friction"): (("friction",), ("constant",)),
    ("models", "fluid_friction"): (("friction",), ("matsumoto", "doleschel")),
    ("models", "application_factor"): (("friction",), ("niemann-winter",)),
    ("models", "boundary_friction"): (("friction",), ("mixed-lub", "matsumoto", "ehl-direct")),
    ("models", "running_in"): (("friction",), ("mixed-lubrication",)),
    ("models", "running_in_factor"): (("friction",), ("mixed-lubrication",)),
    ("models", "profile_cutoff"): (("friction",), ("mixed-lubrication",)),
    ("models", "hurst_exponent"): (("friction",), ("mixed-lubrication",)),
    ("models", "mesh_load_factor"): (("friction",), ("niemann-winter",)),
    ("models", "fitted_form"): (("friction", "rolling", "bearing"), ("fitted",)),
    ("models", "oil_beyond_range"): (("friction", "rolling", "bearing"), ("mixed-ehl",)),
    ("models", "pocket_void_pressure"): (("pocketing",), ("incompressible",)),
    ("contact_solver", ""): (("friction",), ("ehl-direct",)),
    ("thermal", ""): (("temperatures",), ("flank", "network")),
}
"""Keys, and tables, that have an effect only if the names of some models contain some words."""
GENERAL = {
    "friction": "mixed-lubrication",
    "rolling": "goksem-hargreaves",
    "drag": "diab-ville-velex",
}
"""What ``auto`` stands for with the preset ``general``."""


@dataclass(frozen=True, eq=False)
class SetCase:
    """A gear set with its tables, and those of the case that it is part of.

    The models that it chooses are found once, when they are first asked for.
    """

    gearing: Gearing
    models: PlanetaryModels  # Those of a pair with the defaults of what planets need.
    numerics: Numerics
    losses: Mapping[str, LossOption]  # In the order in which they are shown.
    sharing: LoadSharing | None  # None without planets.
    # By the body of the planets.
    bearings: Mapping[str, PlanetBearing | PlanetPin | None]
    carrier: Carrier | None
    thrust_bearing: ThrustBearing | None
    lubrication: LubricationTable | None
    lubricant: Lubricant
    surroundings: Surroundings
    thermal: ThermalTable
    friction_table: FrictionTable | None
    contact_solver: ContactSolver
    folder: Path  # Where the files lie that it names.
    found: tuple[str, ...]  # Notes on what its tables leave out.
    # The oil of the housing above the axes of bodies, where the set dips into it. [m]
    oil_heights: Mapping[str, float]

    @cached_property
    def oil_model(self) -> OilModel | None:
        """The fitted models that it names, or those built in for its oil; None without either."""
        return oil_model_of(self.models, self.folder, self.lubricant.oil)

    @cached_property
    def chosen(self) -> dict[str, str]:
        """Its models by key, ``auto`` replaced by what it stands for."""
        models, table = self.models, self.lubrication
        pocketing: str = models.pocketing
        drag: str = models.drag
        if drag == "auto":
            drag = GENERAL["drag"] if models.preset == "general" else LAMINAR_RIMS
        if pocketing == "auto":
            pocketing = "isentropic" if oil_share(self).share < LEAST_OIL else "incompressible"
        found: dict[str, str] = {
            "friction": self._model("friction", FittedOrSchlenk.name, "schlenk"),
            "rolling": self._model("rolling", FittedOrGoksem.name, "goksem-hargreaves"),
            "load_distribution": models.load_distribution,
            "mesh": models.mesh,
            "pocketing": pocketing,
            "drag": drag,
        }
        if table is not None:
            found["lubrication"] = table.method
            if table.method == "dip":
                found["churning"] = table.churning
        if self.bearings:
            found["bearing"] = ", ".join(dict.fromkeys(map(self.bearing_model, self.bearings)))
            found["bearing_viscous"] = models.bearing_viscous
        return found

    def bearing_model(self, body: str) -> str:
        """The model of the loss of the bearing of a planet."""
        bearing = self.bearings[body]
        if isinstance(bearing, PlanetPin):
            return "reynolds"
        plain = bearing is None or (bearing.cage == "caged" and bearing.type != "spherical")
        if self.models.bearing == "auto" and not plain:
            return "palmgren"
        return self._model("bearing", FITTED_OR_PALMGREN, "palmgren")

    def _model(self, role: str, fitted: str, formula: str) -> str:
        """As stated, or the regressions for the own fluid, what was fitted for it, or a formula."""
        stated: str = getattr(self.models, role)
        if stated != "auto":
            return stated
        if role == "rolling" and self._model("friction", FittedOrSchlenk.name, "schlenk") in (
            CONTAINS_ROLLING
        ):
            return CONTAINED.name
        if role in GENERAL and self.models.preset == "general":
            return GENERAL[role]
        if self.lubricant.oil.friction_regression == TALBOT_FLUID.key:
            return "mixed-ehl"
        known = self.oil_model
        return formula if known is None or FITTED_QUANTITIES[role] not in known.fits else fitted

    @cached_property
    def friction(self) -> FrictionModel:
        """Its friction model."""
        name, models, table = self.chosen["friction"], self.models, self.friction_table
        if name in (FittedFriction.name, FittedOrSchlenk.name):
            assert self.oil_model is not None  # was checked
            fitted = FittedFriction(self.oil_model, models.fitted_form)
            return fitted if name == FittedFriction.name else FittedOrSchlenk(fitted)
        if name in FRICTION_MODELS:
            settings = FrictionSettings(
                constant=models.constant_friction,
                boundary=models.boundary_friction,
                fluid=models.fluid_friction,
                table=None
                if table is None
                else FrictionMap(tuple(table.axes().items()), table.friction),
                oil_held=models.oil_beyond_range == "held",
                load_factor=models.application_factor * models.mesh_load_factor,
                surfaces=Surfaces(
                    running_in=models.running_in_factor if models.running_in == "run-in" else 1.0,
                    cutoff=models.profile_cutoff,
                    hurst_exponent=models.hurst_exponent,
                ),
            )
            return friction_model(name, settings)
        if name not in offered("friction_models"):
            allowed = "belongs to a plug-in that is not installed."
            raise InputError([Problem("models.friction", name, allowed, "Choose another model.")])
        model: FrictionModel = load("friction_models", name)(self)
        return model

    @cached_property
    def rolling(self) -> RollingModel:
        """Its model of the rolling loss. Theory (R11)."""
        name = self.chosen["rolling"]
        if name in (FittedRolling.name, FittedOrGoksem.name):
            fitted = self.fitted_rolling("rolling_loss")
            return fitted if name == FittedRolling.name else FittedOrGoksem(fitted)
        if name == CONTAINED.name:
            return CONTAINED
        return replace(ROLLING_MODELS[name], oil_held=self.models.oil_beyond_range == "held")

    def fitted_rolling(self, quantity: str) -> FittedRolling:
        """The fitted rolling loss of its teeth or of its bearings."""
        assert self.oil_model is not None  # was checked
        return FittedRolling(self.oil_model, self.models.fitted_form, quantity)


def set_cases(case: Case) -> dict[str, SetCase]:
    """Every set of a case whose losses are computed, by its name; that of a single set is empty."""
    if isinstance(case, TrainCase):
        tables: dict[str, PlanetaryCase | GearPairCase | ComputedSet] = dict(case.computed_sets)
    else:
        tables = {"": case}
    sets = {}
    for name, table in tables.items():
        gearing, parts = case.gearings[name], vars(table)
        bearing, own = parts.get("planet_bearing"), parts.get("planet_bearings", {})
        bearing = bearing or parts.get("planet_pin")
        losses = dict(table.losses)
        if isinstance(table, ListedSet):
            losses = {term: losses.get(term, LossOption()) for term in gearing.terms}
        models = table.models
        if not isinstance(models, PlanetaryModels):
            models = PlanetaryModels.model_construct(**dict(models))
        temperatures = case.models.temperatures  # those of a train hold for all its sets
        if models.temperatures != temperatures:
            models = models.model_copy(update={"temperatures": temperatures})
        assert case.lubricant is not None
        sets[name] = SetCase(
            gearing,
            models,
            table.numerics,
            losses,
            parts.get("load_sharing") if gearing.count else None,
            {body: own.get(body, bearing) for body in gearing.planets},
            parts.get("carrier"),
            parts.get("thrust_bearing"),
            table.lubrication,
            case.lubricant,
            case.surroundings,
            case.thermal,
            case.friction_table,
            case.contact_solver,
            case.folder,
            () if name else tuple(map(str, case.found)),
            case.oil_heights.get(name, {}),
        )
    return sets


# What follows from how oil gets to the gears: the share of oil around them.


_BAND = 1.96
"""Half the width of a band of 95 %, in standard deviations of a normal distribution. [1]"""


@dataclass(frozen=True, slots=True)
class OilShare:
    """The share of oil by volume around gears."""

    share: float  # [1]
    source: str  # Where it is from; of a given one the key.
    grade: str = "given"  # ``"given"``, ``"read"`` or ``"estimate"``.
    # Two thirds of all gearboxes lie within this factor, either way; 1 for a given share. [1]
    factor: float = 1.0

    @property
    def band(self) -> tuple[float, float]:
        """95 % of all gearboxes."""
        width = self.factor**_BAND
        return self.share / width, min(1.0, self.share * width)


def oil_share(case: Case | SetCase) -> OilShare:
    """The share of oil around the gears of a case. Theory (N1)."""
    table = case.lubrication
    if table is None:
        return OilShare(case.surroundings.oil_air_ratio, SHARE_KEY)
    if table.oil_share is not None:
        return OilShare(table.oil_share, OWN_SHARE_KEY)
    known = library.named("lubrication")[table.method]
    share = min(1.0, table.oil_share_factor * known["oil_share"])
    return OilShare(share, known["source"], known["grade"], known["lognormal_factor"])


def with_lubrication(
    thermal: ThermalTable,
    table: LubricationTable | None,
    flow: float | None,  # Oil that is brought to all gears. [m^3/s]
) -> ThermalTable:
    """The table [thermal] with what [lubrication] says of the oil, where it says nothing itself."""
    if table is None:
        return thermal
    found: dict[str, object] = {}
    if "lubrication" not in thermal.model_fields_set:
        found["lubrication"] = WETTING[table.method][0]
    if thermal.oil_flow is None and thermal.oil_outlet_temperature is None:
        found["oil_flow"] = flow
    if thermal.oil_volume is None:
        found["oil_volume"] = table.oil_volume
    return thermal.model_copy(update=found)


# The models that a set chooses, ready for its elements.


def standing_of(case: SetCase) -> dict[str, str]:
    """The models of friction, rolling loss and bearings, and how well each is known to be right."""
    models, form = dict(case.chosen), case.models.fitted_form
    if models["mesh"] == "loss-factor":
        del models["rolling"]
    uses_fits = any("fitted" in models.get(role, "") for role in FITTED_QUANTITIES)
    fitted = case.oil_model if uses_fits else None
    return {
        role: "; ".join(
            f"{name}: {reliability(role, name, fitted, form)}" for name in models[role].split(", ")
        )
        for role in RELIABILITY
        if role in models
    }


def contact_modulus(one: StatedMaterial, other: StatedMaterial) -> float:
    """Equivalent modulus E_eq of a contact of two materials. [Pa]"""
    return equivalent_modulus(
        one.elastic_modulus, one.poisson_ratio, other.elastic_modulus, other.poisson_ratio
    )


def solid_of(
    material: StatedMaterial,
    conductivity: float | None = None,  # Instead of its own. [W/(m K)]
    heat_capacity: float | None = None,  # Instead of its own. [J/(kg K)]
) -> Solid:
    """What heat sees of a material."""
    return Solid(
        material.thermal_conductivity if conductivity is None else conductivity,
        material.heat_capacity if heat_capacity is None else heat_capacity,
        material.density,
    )


def fluids_of(
    case: Case,
    temperature: float | None = None,  # Of the oil; by default that of the inlet. [K]
) -> Fluids:
    """Oil and mixture at a temperature, which only given losses can do without."""
    if temperature is None:
        temperature = case.operation.oil_inlet_temperature
    assert case.lubricant is not None
    assert temperature is not None
    return fluids_at(
        case.lubricant.oil,
        temperature,
        oil_air_ratio=oil_share(case).share,
        pressure=case.surroundings.pressure,
        pressure_viscosity_factor=case.lubricant.pressure_viscosity_factor,
    )


def mesh_models(
    case: SetCase, choices: Mapping[str, LossChoice], flow_tables: FlowTables
) -> dict[str, MeshModels]:
    """How the losses of each mesh of a set are computed, by the key of the mesh."""
    models, numerics, planets = case.models, case.numerics, case.gearing.count
    keys = [mesh.key for mesh in case.gearing.meshes]
    fed, table = 0.0, case.lubrication
    if table is not None and table.oil_share is None and table.oil_flow is not None:
        jet_in = table.method == "jet" and table.nozzle_side == "in-mesh"
        if table.method == "flow" or jet_in:
            fed = table.oil_flow / (len(keys) * (planets or 1))
    file, friction, rolling = models.pocketing_table, case.friction, case.rolling
    return {
        key: MeshModels(
            friction=friction,
            rolling=rolling,
            by_loss_factor=models.mesh == "loss-factor",
            load_distribution=models.load_distribution,
            positions=numerics.mesh_positions,
            segments=numerics.contact_segments,
            pockets=PocketSettings(
                include=choices[f"{key}_pocketing"].include,
                oil_fraction=oil_share(case).share,
                model=cast(PocketModel, case.chosen["pocketing"]),
                void_pressure=models.pocket_void_pressure,
                slices=numerics.pocket_slices,
                steps=numerics.pocket_steps,
                end_length=models.pocket_end_length,
                file=None if file is None else case.folder / file,
                tables=flow_tables,
                fed=fed,
                any_order=not planets,
            ),
        )
        for key in keys
    }
