"""The parts that planetary sets and gear pairs share: fluids, one mesh, the list of loss terms."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from pydantic import BaseModel

from epicyclic.analysis.result import (
    LOAD_DEPENDENT,
    LOAD_INDEPENDENT,
    FluidFigures,
    LossTerm,
    MeshFigures,
)
from epicyclic.case.case import Case, PlanetaryCase
from epicyclic.case.schema import GearPairModels, GearTable, LossOption, Numerics
from epicyclic.elasticity.mesh_compliance import Elastic
from epicyclic.geometry.mesh import Mesh
from epicyclic.kernels.line_contact import equivalent_modulus
from epicyclic.losses.contact import Flanks, MeshContact, mesh_contact
from epicyclic.losses.friction import FrictionSettings, friction_model
from epicyclic.losses.friction.user import FrictionMap
from epicyclic.losses.load_distribution import distribute_load
from epicyclic.losses.mesh import MeshLoss, local_loss, loss_factor_loss, ohlendorf_loss_factor
from epicyclic.losses.rolling import ROLLING_MODELS
from epicyclic.losses.validity import CELSIUS, Range, ValidityFlag, check_ranges
from epicyclic.lubricant.oil import Oil
from epicyclic.lubricant.properties import MixtureState, OilState, mixture_state, oil_state
from epicyclic.units import Quantity

__all__ = [
    "Fluids",
    "MeshDuty",
    "MeshOutcome",
    "Part",
    "elastic_constants",
    "fluid_notes",
    "fluids_of",
    "friction_settings",
    "general_notes",
    "load_mesh",
    "loss_terms",
    "resolve_models",
    "solve_mesh",
    "used_sources",
]

NO_POCKETING = "pocketing is not modelled yet"
OHLENDORF_SOURCE = "loss factor: H. Ohlendorf, Diss. TH Muenchen (1958)"
LOAD_DEPENDENT_WORDS = ("sliding", "rolling", "mechanical")
"""Last words of the names of load-dependent terms."""

_VISCOSITY = Range(
    "kinematic_viscosity",
    "kinematic viscosity",
    2.0,
    2e7,
    Quantity("a viscosity", "m^2/s", "mm^2/s"),
    "ASTM D341, form for 2 mm^2/s and more",
)


@dataclass(frozen=True, slots=True)
class Fluids:
    """The oil, its mixture with air, and flags on both."""

    oil: OilState
    mixture: MixtureState
    flags: tuple[ValidityFlag, ...]

    @property
    def figures(self) -> FluidFigures:
        """The properties for the user."""
        return FluidFigures(
            kinematic_viscosity=self.oil.kinematic_viscosity,
            dynamic_viscosity=self.oil.dynamic_viscosity,
            density=self.oil.density,
            pressure_viscosity=self.oil.pressure_viscosity,
            mixture_density=self.mixture.density,
            mixture_viscosity=self.mixture.dynamic_viscosity,
        )


@dataclass(frozen=True, slots=True)
class Part:
    """A loss before the user's options: watts and where they come from, or why it is missing."""

    watts: float = 0.0
    method: str = ""
    source: str = ""
    left_out: str = ""


@dataclass(frozen=True, slots=True)
class MeshDuty:
    """A mesh and what it has to do, relative to the carrier, for one planet.

    Attributes
    ----------
    key : str
        ``"sun_mesh"``, ``"ring_mesh"`` or ``"mesh"``: first word of its loss terms.
    mesh : Mesh
    gears : tuple of GearTable
        Surfaces and materials of both members.
    torque1 : float
        On member 1. [N m]
    speed1 : float
        Of member 1. [rad/s]
    """

    key: str
    mesh: Mesh
    gears: tuple[GearTable, GearTable]
    torque1: float
    speed1: float


@dataclass(frozen=True, slots=True)
class MeshOutcome:
    """Losses, figures and flags of one mesh."""

    parts: dict[str, Part]
    figures: MeshFigures
    flags: tuple[ValidityFlag, ...]


def resolve_models(case: Case) -> dict[str, str]:
    """The models of a case by key, ``auto`` replaced by what it stands for."""
    own = case.lubricant.oil.friction_regression is not None
    models = case.models
    automatic = {
        "friction": "mixed-ehl" if own else "schlenk",
        "rolling": "mixed-ehl" if own else "goksem-hargreaves",
    }
    keys = ["friction", "rolling", "load_distribution", "mesh", "drag"]
    if isinstance(case, PlanetaryCase):
        bearing = case.planet_bearing
        caged = bearing is None or bearing.cage == "caged"
        automatic["bearing"] = "mixed-ehl" if own and caged else "palmgren"
        keys += ["bearing", "bearing_viscous"]
    chosen = {key: str(getattr(models, key)) for key in keys}
    return {key: automatic[key] if choice == "auto" else choice for key, choice in chosen.items()}


def fluids_of(case: Case) -> Fluids:
    """Oil and mixture at the oil inlet temperature."""
    temperature = case.operation.oil_inlet_temperature
    oil = oil_state(case.lubricant.oil, temperature)
    mixture = mixture_state(oil, case.surroundings.oil_air_ratio, case.surroundings.pressure)
    flags = check_ranges(
        f"oil {case.lubricant.oil.name}",
        (_temperature_range(case.lubricant.oil), _VISCOSITY),
        {"temperature": temperature, "kinematic_viscosity": oil.kinematic_viscosity},
    )
    return Fluids(oil, mixture, flags)


def _temperature_range(oil: Oil) -> Range:
    low, high = (CELSIUS.to_display(limit) for limit in oil.temperature_range)
    return Range("temperature", "temperature", low, high, CELSIUS, "data of this oil")


def friction_settings(case: Case) -> FrictionSettings:
    """The numbers that friction models take from the case."""
    table = case.friction_table
    return FrictionSettings(
        constant=case.models.constant_friction,
        boundary=case.models.boundary_friction,
        fluid=case.models.fluid_friction,
        table=None if table is None else FrictionMap(tuple(table.axes().items()), table.friction),
    )


def load_mesh(
    duty: MeshDuty, models: GearPairModels, numerics: Numerics, oil: OilState
) -> MeshContact | None:
    """Conditions along the contact lines; None without load or motion. Theory (D1)."""
    if duty.torque1 == 0 or duty.speed1 == 0:
        return None
    force = abs(duty.torque1) / duty.mesh.gear1.base_radius
    one, two = (elastic_constants(gear) for gear in duty.gears)
    lines, line_load = distribute_load(
        duty.mesh,
        models.load_distribution,
        force,
        (one, two),
        numerics.mesh_positions,
        numerics.contact_segments,
    )
    return mesh_contact(
        duty.mesh,
        lines,
        line_load,
        force=force,
        speed1=abs(duty.speed1),
        oil=oil,
        flanks=_flanks(*duty.gears),
    )


def elastic_constants(gear: GearTable) -> Elastic:
    """Those of the gear's material."""
    return Elastic(gear.material.elastic_modulus, gear.material.poisson_ratio)


def _flanks(one: GearTable, two: GearTable) -> Flanks:
    modulus = equivalent_modulus(
        one.material.elastic_modulus,
        one.material.poisson_ratio,
        two.material.elastic_modulus,
        two.material.poisson_ratio,
    )
    return Flanks(modulus, one.roughness, two.roughness)


def solve_mesh(case: Case, duty: MeshDuty, oil: OilState, count: int) -> MeshOutcome:
    """Losses and figures of one mesh, `count` of which work in parallel."""
    models = resolve_models(case)
    friction = friction_model(models["friction"], friction_settings(case))
    rolling = ROLLING_MODELS[models["rolling"]]
    quick = models["mesh"] == "loss-factor"
    contact = load_mesh(duty, case.models, case.numerics, oil)
    if contact is None:
        loss = MeshLoss(0.0, 0.0, math.nan)
    elif quick:
        loss = loss_factor_loss(contact, friction)
    else:
        loss = local_loss(contact, friction, rolling)
    parts = {
        f"{duty.key}_sliding": Part(count * loss.sliding, friction.title, friction.source),
        f"{duty.key}_rolling": Part(count * loss.rolling, rolling.title, rolling.source),
        f"{duty.key}_pocketing": Part(left_out=NO_POCKETING),
    }
    if quick:
        parts |= {
            f"{duty.key}_sliding": Part(
                count * loss.sliding,
                f"{friction.title} times the loss factor",
                f"{friction.source}; {OHLENDORF_SOURCE}",
            ),
            f"{duty.key}_rolling": Part(left_out="the loss-factor method has no rolling loss"),
        }
    return MeshOutcome(parts, _mesh_figures(duty, contact, loss.mean_friction), loss.flags)


def _mesh_figures(duty: MeshDuty, contact: MeshContact | None, friction_mean: float) -> MeshFigures:
    mesh = duty.mesh
    speed1 = abs(duty.speed1)
    sliding = max(
        abs(speed1 * rho1 - speed1 / mesh.ratio * mesh.curvature2(rho1))
        for rho1 in (mesh.path_start, mesh.path_end)
    )
    return MeshFigures(
        pressure_angle=mesh.operating_pressure_angle,
        transverse_contact_ratio=mesh.transverse_contact_ratio,
        overlap_ratio=mesh.overlap_ratio,
        backlash=mesh.backlash,
        pitch_line_speed=speed1 * mesh.operating_radius1,
        sliding_speed_max=sliding,
        line_load_max=math.nan if contact is None else float(contact.line_load.max()),
        hertz_pressure_max=math.nan if contact is None else float(contact.hertz_pressure.max()),
        film_ratio_min=math.nan if contact is None else float(contact.film_ratio.min()),
        film_ratio_max=math.nan if contact is None else float(contact.film_ratio.max()),
        friction_mean=friction_mean,
        loss_factor=ohlendorf_loss_factor(mesh),
        contact=contact,
    )


def loss_terms(parts: Mapping[str, Part], options: BaseModel) -> tuple[LossTerm, ...]:
    """The parts in the order of the case's options, with the user's include and factor."""
    terms = []
    for name in type(options).model_fields:
        part, option = parts[name], getattr(options, name)
        terms.append(_term(name, part, option))
    return tuple(terms)


def _term(name: str, part: Part, option: LossOption) -> LossTerm:
    """One loss term with the user's options. Theory (P4)."""
    loaded = name.rpartition("_")[2] in LOAD_DEPENDENT_WORDS
    group = LOAD_DEPENDENT if loaded else LOAD_INDEPENDENT
    reason = part.left_out or ("" if option.include else "left out by the case")
    if reason:
        return LossTerm(name, 0.0, group, "", "", left_out=reason)
    watts = option.factor * part.watts
    return LossTerm(name, watts, group, part.method, part.source, factor=option.factor)


def fluid_notes(case: Case) -> tuple[str, ...]:
    """A note for every regression that was made for another oil than that of the case."""
    oil = case.lubricant.oil
    models = resolve_models(case)
    notes = []
    if oil.friction_regression is None:
        keys = [key for key in ("friction", "rolling", "bearing") if models.get(key) == "mixed-ehl"]
        notes += [
            f"models.{key}: the mixed-EHL regression was made for the oil atf-talbot-2012, not for "
            f"{oil.name}."
            for key in keys
        ]
    if models["friction"] == "xu-2007" and oil.name != "75w-90-gear-oil":
        notes.append(
            f"models.friction: the regression xu-2007 was made for a 75W-90 gear oil, not for "
            f"{oil.name}; it knows no mixed lubrication."
        )
    return tuple(notes)


def used_sources(terms: Iterable[LossTerm], *more: str) -> tuple[str, ...]:
    """Sources of the terms that are included, each once, in order, and `more`."""
    sources = [term.source for term in terms if not term.left_out and term.source]
    return tuple(dict.fromkeys([*sources, *more]))


def general_notes(
    terms: Iterable[LossTerm], input_power: float, efficiency: float | None
) -> tuple[str, ...]:
    """Notes on what is missing, what is scaled, and on efficiency near zero load."""
    notes = []
    missing: dict[str, list[str]] = {}
    for term in terms:
        if term.left_out:
            missing.setdefault(term.left_out, []).append(term.name)
        elif term.factor != 1.0:
            notes.append(f"{term.name} is multiplied by {term.factor:g}.")
    notes += [f"Not included: {', '.join(names)} ({reason})." for reason, names in missing.items()]
    if efficiency == 0.0 and input_power > 0:
        notes.append(
            "The losses exceed the power passed on: no power leaves, and the output must be driven."
        )
    return tuple(notes)
