"""A gear set of a case with the models that it chooses, and the oil around it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from epicyclic import library
from epicyclic.case.case import Case, GearPairCase, PlanetaryCase, TrainCase
from epicyclic.case.gearing import Gearing
from epicyclic.case.tables.base import Material
from epicyclic.case.tables.elements import Carrier, PlanetBearing, ThrustBearing
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
from epicyclic.contact.fitted_models import OilModel, builtin_model, read_oil_model
from epicyclic.contact.temperatures import Solid
from epicyclic.errors import InputError, Problem
from epicyclic.kernels.line_contact import equivalent_modulus
from epicyclic.losses.friction import (
    DRY_FRICTION,
    FRICTION_MODELS,
    TALBOT_FLUID,
    FrictionMap,
    FrictionModel,
    FrictionSettings,
    friction_model,
)
from epicyclic.losses.planet_bearing import FITTED_OR_PALMGREN
from epicyclic.losses.pocket_flow import PocketModel, automatic_pocketing
from epicyclic.losses.pocket_tables import FlowTables
from epicyclic.losses.ranges import FITTED_QUANTITIES
from epicyclic.losses.reliability import RELIABILITY, reliability
from epicyclic.losses.rolling import (
    ROLLING_MODELS,
    FittedFriction,
    FittedOrGoksem,
    FittedOrSchlenk,
    FittedRolling,
    RollingModel,
)
from epicyclic.machine.element import Fluids, fluids_at
from epicyclic.machine.gear_mesh import MeshModels
from epicyclic.machine.gear_set import LossChoice
from epicyclic.machine.pocket_flow import PocketSettings
from epicyclic.registry import load, offered

# A gear set with computed losses as the builders see it, whichever case it is part of.


@dataclass(frozen=True, slots=True)
class SetCase:
    """A gear set with its tables, and those of the case that it is part of."""

    gearing: Gearing
    models: PlanetaryModels  # Those of a pair with the defaults of what planets need.
    numerics: Numerics
    losses: Mapping[str, LossOption]  # In the order in which they are shown.
    sharing: LoadSharing | None  # None without planets.
    bearings: Mapping[str, PlanetBearing | None]  # By the body of the planets.
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


def set_cases(
    case: Case,
    sets: Iterable[str],  # Names; that of a single set is empty.
) -> Iterator[tuple[str, SetCase]]:
    """Name and case of each of some sets whose losses are computed."""
    if not isinstance(case, TrainCase):
        yield "", _set_case(case, case, case.gearings[""], tuple(map(str, case.found)))
        return
    tables = dict(case.computed_sets)
    for name in sets:
        yield name, _set_case(case, tables[name], case.gearings[name], ())


def _set_case(
    case: Case,
    table: PlanetaryCase | GearPairCase | ComputedSet,
    gearing: Gearing,
    found: tuple[str, ...],
) -> SetCase:
    parts = vars(table)
    bearing, own = parts.get("planet_bearing"), parts.get("planet_bearings", {})
    losses = dict(table.losses)
    if isinstance(table, ListedSet):
        losses = {name: losses.get(name, LossOption()) for name in gearing.terms}
    models = table.models
    if not isinstance(models, PlanetaryModels):
        models = PlanetaryModels.model_construct(**dict(models))
    if models.temperatures != case.models.temperatures:  # those of a train hold for all its sets
        models = models.model_copy(update={"temperatures": case.models.temperatures})
    assert case.lubricant is not None
    return SetCase(
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
        found,
    )


# What follows from how oil gets to the gears: the share of oil around them.


_BAND = 1.96
"""Half the width of a band of 95 %, in standard deviations of a normal distribution. [1]"""


class Lubricated(Protocol):
    """A case, or a set of a train."""

    @property
    def lubrication(self) -> LubricationTable | None:
        """How oil gets to its gears, if it says so."""

    @property
    def surroundings(self) -> Surroundings:
        """What surrounds them."""


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


def oil_share(case: Lubricated) -> OilShare:
    """The share of oil around the gears of a case. Theory (N1)."""
    table = case.lubrication
    if table is None:
        return OilShare(case.surroundings.oil_air_ratio, SHARE_KEY)
    if table.oil_share is not None:
        return OilShare(table.oil_share, OWN_SHARE_KEY)
    known = library.lubrication_methods()[table.method]
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


# The models that a case chooses, ready for its elements.


def resolve_models(case: SetCase) -> dict[str, str]:
    """The models of a case by key, ``auto`` replaced by what it stands for."""
    found: dict[str, str] = {
        "friction": _friction_name(case),
        "rolling": _rolling_name(case),
        "load_distribution": case.models.load_distribution,
        "mesh": case.models.mesh,
        "pocketing": pocketing_of(case),
        "drag": case.models.drag,
    }
    if case.lubrication is not None:
        found["lubrication"] = case.lubrication.method
        if case.lubrication.method == "dip":
            found["churning"] = case.lubrication.churning
    if case.bearings:
        models = dict.fromkeys(bearing_model(case, it) for it in case.bearings.values())
        found["bearing"] = ", ".join(models)
        found["bearing_viscous"] = case.models.bearing_viscous
    return found


def bearing_model(case: SetCase, bearing: PlanetBearing | None) -> str:
    """The model of the loss of a planet bearing, ``auto`` replaced by what it stands for."""
    if case.models.bearing != "auto":
        return case.models.bearing
    if bearing is not None and bearing.cage != "caged":
        return "palmgren"
    return _automatic(case, "bearing_rolling_loss", FITTED_OR_PALMGREN, "palmgren")


def _friction_name(case: SetCase) -> str:
    chosen = case.models.friction
    if chosen != "auto":
        return chosen
    return _automatic(case, "friction", FittedOrSchlenk.name, "schlenk")


def _rolling_name(case: SetCase) -> str:
    chosen = case.models.rolling
    if chosen != "auto":
        return chosen
    return _automatic(case, "rolling_loss", FittedOrGoksem.name, "goksem-hargreaves")


def _automatic(case: SetCase, quantity: str, fitted: str, formula: str) -> str:
    """The regressions of mixed EHL for their fluid, what was fitted for another, or a formula."""
    if case.lubricant.oil.friction_regression == TALBOT_FLUID.key:
        return "mixed-ehl"
    model = fitted_oil_model(case)
    return formula if model is None or quantity not in model.fits else fitted


def standing_of(case: SetCase) -> dict[str, str]:
    """The models of friction, rolling loss and bearings, and how well each is known to be right."""
    models, form = resolve_models(case), case.models.fitted_form
    if models["mesh"] == "loss-factor":
        del models["rolling"]
    uses_fits = any("fitted" in models.get(role, "") for role in FITTED_QUANTITIES)
    fitted = fitted_oil_model(case) if uses_fits else None
    return {
        role: "; ".join(
            f"{name}: {reliability(role, name, fitted, form)}" for name in models[role].split(", ")
        )
        for role in RELIABILITY
        if role in models
    }


def friction_settings(case: SetCase) -> FrictionSettings:
    """The numbers that friction models take from the case."""
    table, boundary = case.friction_table, case.models.boundary_friction
    return FrictionSettings(
        constant=case.models.constant_friction,
        boundary=DRY_FRICTION if boundary is None else boundary,
        fluid=case.models.fluid_friction,
        table=None if table is None else FrictionMap(tuple(table.axes().items()), table.friction),
        oil_held=case.models.oil_beyond_range == "held",
        load_factor=case.models.application_factor * case.models.mesh_load_factor,
    )


def friction_of(case: SetCase) -> FrictionModel:
    """The friction model of a case."""
    name = _friction_name(case)
    if name in (FittedFriction.name, FittedOrSchlenk.name):
        fitted = FittedFriction(_given_oil_model(case), case.models.fitted_form)
        return fitted if name == FittedFriction.name else FittedOrSchlenk(fitted)
    if name in FRICTION_MODELS:
        return friction_model(name, friction_settings(case))
    if name not in offered("friction_models"):
        allowed = "belongs to a plug-in that is not installed."
        problem = Problem("models.friction", name, allowed, "Choose another model.")
        raise InputError([problem])
    model: FrictionModel = load("friction_models", name)(case)
    return model


def contact_modulus(one: Material, other: Material) -> float:
    """Equivalent modulus E_eq of a contact of two materials. [Pa]"""
    return equivalent_modulus(
        one.elastic_modulus, one.poisson_ratio, other.elastic_modulus, other.poisson_ratio
    )


def solid_of(
    material: Material,
    conductivity: float | None = None,  # Instead of its own. [W/(m K)]
    heat_capacity: float | None = None,  # Instead of its own. [J/(kg K)]
) -> Solid:
    """What heat sees of a material."""
    return Solid(
        material.thermal_conductivity if conductivity is None else conductivity,
        material.heat_capacity if heat_capacity is None else heat_capacity,
        material.density,
    )


def rolling_of(case: SetCase) -> RollingModel:
    """The rolling-loss model of a case."""
    name = _rolling_name(case)
    if name in (FittedRolling.name, FittedOrGoksem.name):
        fitted = fitted_rolling(case, "rolling_loss")
        return fitted if name == FittedRolling.name else FittedOrGoksem(fitted)
    return replace(ROLLING_MODELS[name], oil_held=case.models.oil_beyond_range == "held")


def fitted_rolling(case: SetCase, quantity: str) -> FittedRolling:
    """The fitted rolling loss of the teeth or of the bearings of a case."""
    return FittedRolling(_given_oil_model(case), case.models.fitted_form, quantity)


def fitted_oil_model(case: SetCase) -> OilModel | None:
    """The fitted models that the case names, or those built in for its oil; None without either."""
    if case.models.oil_model is not None:
        return read_oil_model(case.folder / case.models.oil_model)
    return builtin_model(case.lubricant.oil)


def _given_oil_model(case: SetCase) -> OilModel:
    """The fitted models of a case that asks for them, and was checked to have them."""
    model = fitted_oil_model(case)
    assert model is not None
    return model


def fluids_of(case: Case) -> Fluids:
    """Oil and mixture at the oil inlet temperature, which only given losses can do without."""
    assert case.lubricant is not None
    assert case.operation.oil_inlet_temperature is not None
    return fluids_at(
        case.lubricant.oil,
        case.operation.oil_inlet_temperature,
        oil_air_ratio=oil_share(case).share,
        pressure=case.surroundings.pressure,
        pressure_viscosity_factor=case.lubricant.pressure_viscosity_factor,
    )


def loss_choices(case: SetCase) -> dict[str, LossChoice]:
    """What becomes of each loss of a case, in the order in which they are shown."""
    options = case.losses.items()
    return {name: LossChoice(option.include, option.factor) for name, option in options}


def pocketing_of(case: SetCase) -> PocketModel:
    """The model of the flow through the pockets, ``auto`` replaced by what it stands for."""
    chosen = case.models.pocketing
    return automatic_pocketing(oil_share(case).share) if chosen == "auto" else chosen


def mesh_models(case: SetCase, flow_tables: FlowTables) -> dict[str, MeshModels]:
    """How the losses of each mesh of a case are computed, by the key of the mesh."""
    choices, friction, rolling = loss_choices(case), friction_of(case), rolling_of(case)
    pocketing = pocketing_of(case)
    file = case.models.pocketing_table
    meshes = tuple(_before("_pocketing", choices))
    planets = case.gearing.count
    fed = _fed(case) / (len(meshes) * (planets or 1))
    return {
        key: MeshModels(
            friction=friction,
            rolling=rolling,
            by_loss_factor=case.models.mesh == "loss-factor",
            load_distribution=case.models.load_distribution,
            positions=case.numerics.mesh_positions,
            segments=case.numerics.contact_segments,
            pockets=PocketSettings(
                include=choices[f"{key}_pocketing"].include,
                oil_fraction=oil_share(case).share,
                model=pocketing,
                void_pressure=case.models.pocket_void_pressure,
                slices=case.numerics.pocket_slices,
                steps=case.numerics.pocket_steps,
                end_length=case.models.pocket_end_length,
                file=None if file is None else case.folder / file,
                tables=flow_tables,
                fed=fed,
                any_order=not planets,
            ),
        )
        for key in meshes
    }


def _fed(case: SetCase) -> float:
    """Oil that goes into the meshes of a set as the teeth mesh. [m^3/s]"""
    table = case.lubrication
    if table is None or table.oil_share is not None or table.oil_flow is None:
        return 0.0
    into = table.method == "flow" or (table.method == "jet" and table.nozzle_side == "in-mesh")
    return table.oil_flow if into else 0.0


def _before(ending: str, names: Iterable[str]) -> Iterator[str]:
    """What stands before an `ending`, of all names that have it."""
    return (name.removesuffix(ending) for name in names if name.endswith(ending))
