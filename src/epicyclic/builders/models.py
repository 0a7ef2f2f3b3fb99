"""The models that a case chooses, ready for its elements."""

from __future__ import annotations

import numpy as np

from epicyclic.case.case import Case, PlanetaryCase
from epicyclic.case.model_tables import LossOption
from epicyclic.case.oil_laws import oil_laws
from epicyclic.ehl.heating import effusivity
from epicyclic.ehl.rough import AsperityContact
from epicyclic.elements.fluids import Fluids, fluids_at
from epicyclic.elements.gear_mesh import MeshModels
from epicyclic.elements.gear_set import LossChoice
from epicyclic.elements.pocket_flow import PocketSettings
from epicyclic.losses.direct import DirectSettings, EhlDirect
from epicyclic.losses.fitted import FittedFriction, FittedRolling
from epicyclic.losses.friction import FrictionModel, FrictionSettings, friction_model
from epicyclic.losses.friction.user import FrictionMap
from epicyclic.losses.mixed_ehl_groups import TALBOT_FLUID
from epicyclic.losses.rolling import ROLLING_MODELS, RollingModel
from epicyclic.oilmodel.model import OilModel, read_oil_model
from epicyclic.pocketing.table import FlowTables

__all__ = [
    "fitted_oil_model",
    "fitted_rolling",
    "fluids_of",
    "friction_of",
    "friction_settings",
    "loss_choices",
    "mesh_models",
    "resolve_models",
    "rolling_of",
]


def resolve_models(case: Case) -> dict[str, str]:
    """The models of a case by key, ``auto`` replaced by what it stands for."""
    own = case.lubricant.oil.friction_regression == TALBOT_FLUID.key
    models = case.models
    automatic = {
        "friction": "mixed-ehl" if own else "schlenk",
        "rolling": "mixed-ehl" if own else "goksem-hargreaves",
    }
    keys = ["friction", "rolling", "load_distribution", "mesh", "pocketing", "drag"]
    if isinstance(case, PlanetaryCase):
        bearing = case.planet_bearing
        caged = bearing is None or bearing.cage == "caged"
        automatic["bearing"] = "mixed-ehl" if own and caged else "palmgren"
        keys += ["bearing", "bearing_viscous"]
    chosen = {key: str(getattr(models, key)) for key in keys}
    return {key: automatic[key] if choice == "auto" else choice for key, choice in chosen.items()}


def friction_settings(case: Case) -> FrictionSettings:
    """The numbers that friction models take from the case."""
    table = case.friction_table
    return FrictionSettings(
        constant=case.models.constant_friction,
        boundary=case.models.boundary_friction,
        fluid=case.models.fluid_friction,
        table=None if table is None else FrictionMap(tuple(table.axes().items()), table.friction),
    )


def friction_of(case: Case) -> FrictionModel:
    """The friction model of a case."""
    name = resolve_models(case)["friction"]
    if name == FittedFriction.name:
        return FittedFriction(fitted_oil_model(case), case.models.fitted_form)
    if name == EhlDirect.name:
        return EhlDirect(_direct_settings(case))
    return friction_model(name, friction_settings(case))


def _direct_settings(case: Case) -> DirectSettings:
    solver = case.contact_solver
    carried = None
    if solver.heating != "isothermal":
        gears = (
            (case.sun, case.planet, case.ring)
            if isinstance(case, PlanetaryCase)
            else (case.pinion, case.gear)
        )
        density = float(np.mean([gear.material.density for gear in gears]))
        carried = effusivity(solver.solid_conductivity, solver.solid_heat_capacity, density)
    return DirectSettings(
        laws=oil_laws(solver),
        asperities=AsperityContact(solver.asperity_film, case.models.boundary_friction),
        effusivity=carried,
        correlation_length=solver.correlation_length,
        seed=solver.seed,
        error=solver.error,
        most_contacts=solver.most_contacts,
    )


def rolling_of(case: Case) -> RollingModel:
    """The rolling-loss model of a case."""
    name = resolve_models(case)["rolling"]
    if name == FittedRolling.name:
        return fitted_rolling(case, "rolling_loss")
    return ROLLING_MODELS[name]


def fitted_rolling(case: Case, quantity: str) -> FittedRolling:
    """The fitted rolling loss of the teeth or of the bearings of a case."""
    return FittedRolling(fitted_oil_model(case), case.models.fitted_form, quantity)


def fitted_oil_model(case: Case) -> OilModel:
    """The file of fitted models that the case names, and was checked to have."""
    assert case.models.oil_model is not None
    return read_oil_model(case.folder / case.models.oil_model)


def fluids_of(case: Case) -> Fluids:
    """Oil and mixture at the oil inlet temperature."""
    return fluids_at(
        case.lubricant.oil,
        case.operation.oil_inlet_temperature,
        oil_air_ratio=case.surroundings.oil_air_ratio,
        pressure=case.surroundings.pressure,
        pressure_viscosity_factor=case.lubricant.pressure_viscosity_factor,
    )


def loss_choices(case: Case) -> dict[str, LossChoice]:
    """What becomes of each loss of a case, in the order in which they are shown."""
    options = case.losses
    found: dict[str, LossOption] = {
        name: getattr(options, name) for name in type(options).model_fields
    }
    return {name: LossChoice(option.include, option.factor) for name, option in found.items()}


def mesh_models(case: Case, flow_tables: FlowTables) -> dict[str, MeshModels]:
    """How the losses of each mesh of a case are computed, by the key of the mesh."""
    choices, friction, rolling = loss_choices(case), friction_of(case), rolling_of(case)
    file = case.models.pocketing_table
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
                oil_fraction=case.surroundings.oil_air_ratio,
                model=case.models.pocketing,
                slices=case.numerics.pocket_slices,
                steps=case.numerics.pocket_steps,
                end_length=case.models.pocket_end_length,
                file=None if file is None else case.folder / file,
                tables=flow_tables,
            ),
        )
        for key in (name.removesuffix("_pocketing") for name in choices if "_pocketing" in name)
    }
