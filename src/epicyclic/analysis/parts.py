"""The parts that planetary sets and gear pairs share: fluids, one mesh, the list of loss terms."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from epicyclic.analysis.figures import FluidFigures, MeshFigures
from epicyclic.analysis.models import friction_of, resolve_models, rolling_of
from epicyclic.analysis.pockets import (
    POCKETING_SOURCE,
    MeshFlow,
    pocket_notes,
    pocketing_method,
    stored_note,
)
from epicyclic.analysis.result import LOAD_DEPENDENT, LOAD_INDEPENDENT, LossTerm
from epicyclic.case import flanks
from epicyclic.case.case import Case
from epicyclic.case.gear_tables import GearTable
from epicyclic.case.model_tables import GearPairModels, LossOption, Numerics
from epicyclic.elasticity.loaded_mesh import LoadedMesh, load_mesh_elastically
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.tools import Tool
from epicyclic.kernels.line_contact import equivalent_modulus
from epicyclic.losses.contact import Flanks, MeshContact, mesh_contact
from epicyclic.losses.direct import EhlDirect
from epicyclic.losses.load_distribution import LOAD_DISTRIBUTIONS, LineLoads, MeshLoad
from epicyclic.losses.mesh import MeshLoss, local_loss, loss_factor_loss, ohlendorf_loss_factor
from epicyclic.losses.validity import ModelUse, Range, ValidityFlag, check_ranges
from epicyclic.losses.viscous import DRAG_METHOD, DRAG_SOURCE, disc_drag, disc_drag_flags
from epicyclic.lubricant.oil import Oil
from epicyclic.lubricant.properties import (
    MixtureState,
    OilState,
    extrapolated_viscosity,
    mixture_state,
    oil_state,
)
from epicyclic.pocketing.similarity import FlowFigures
from epicyclic.units import CELSIUS, SQUARE_MM_PER_SECOND

__all__ = [
    "Body",
    "Fluids",
    "MeshDuty",
    "MeshOutcome",
    "Part",
    "contact_under",
    "distribute_load",
    "drag_part",
    "elastic_loads",
    "fluids_of",
    "load_mesh",
    "loss_terms",
    "oil_at",
    "oil_flags",
    "solve_mesh",
    "used_sources",
]

FloatArray = NDArray[np.float64]

PEAK_SHARE = 0.01
"""Part of the contact that the largest line load and pressure of a mesh leave out. [1]"""
OHLENDORF_SOURCE = "loss factor: H. Ohlendorf, Diss. TH Muenchen (1958)"

_VISCOSITY = Range(
    "kinematic_viscosity",
    "kinematic viscosity",
    2.0,
    2e7,
    SQUARE_MM_PER_SECOND,
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
    """A loss before the user's options: watts and where they come from, or why it is missing.

    Attributes
    ----------
    group : str
        `LOAD_DEPENDENT` or `LOAD_INDEPENDENT`.
    watts : float
        [W]
    method, source : str
        The model and where it is printed.
    left_out : str
        Why there is no such loss; empty if there is.
    """

    group: str
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
    drives1 : bool
        True if power flows from member 1 to member 2 or no power flows.
    tools : tuple of Tool
        The tools that cut both members.
    misalignment : float
        F_beta_x. [m]
    """

    key: str
    mesh: Mesh
    gears: tuple[GearTable, GearTable]
    torque1: float
    speed1: float
    drives1: bool
    tools: tuple[Tool, Tool]
    misalignment: float = 0.0


@dataclass(frozen=True, slots=True)
class MeshOutcome:
    """Losses, figures and flags of one mesh."""

    parts: dict[str, Part]
    figures: MeshFigures
    flags: tuple[ValidityFlag, ...]
    notes: tuple[str, ...]


def oil_at(case: Case, temperature: float) -> OilState:
    """Properties of the oil of a case at `temperature` in kelvin, with the factor of the case."""
    state = oil_state(case.lubricant.oil, temperature)
    factor = case.lubricant.pressure_viscosity_factor
    return replace(state, pressure_viscosity=factor * state.pressure_viscosity)


def fluids_of(case: Case) -> Fluids:
    """Oil and mixture at the oil inlet temperature."""
    temperature = case.operation.oil_inlet_temperature
    oil = oil_at(case, temperature)
    mixture = mixture_state(oil, case.surroundings.oil_air_ratio, case.surroundings.pressure)
    return Fluids(oil, mixture, oil_flags(case.lubricant.oil, temperature))


def oil_flags(oil: Oil, temperature: float) -> tuple[ValidityFlag, ...]:
    """Where properties of an oil at a temperature leave the data behind them."""
    viscosity = extrapolated_viscosity(oil, temperature)
    return check_ranges(
        ModelUse("oil", oil.name, "properties"),
        (_temperature_range(oil), _VISCOSITY),
        {"temperature": temperature, "kinematic_viscosity": viscosity},
    )


def _temperature_range(oil: Oil) -> Range:
    low, high = (CELSIUS.to_display(limit) for limit in oil.temperature_range)
    return Range("temperature", "temperature", low, high, CELSIUS, "data of this oil")


def distribute_load(duty: MeshDuty, models: GearPairModels, numerics: Numerics) -> LineLoads:
    """Contact lines of a mesh and the load on them under the torque of its duty."""
    model = LOAD_DISTRIBUTIONS[models.load_distribution]
    return model.distribute(_mesh_load(duty), numerics.mesh_positions, numerics.contact_segments)


def elastic_loads(duty: MeshDuty, numerics: Numerics) -> LoadedMesh:
    """The mesh under the torque of its duty with elastic teeth, whatever distributes the load."""
    load = _mesh_load(duty)
    return load_mesh_elastically(
        load.mesh,
        *load.bodies,
        numerics.mesh_positions,
        numerics.contact_segments,
        load.force,
        load.deviations,
    )


def _mesh_load(duty: MeshDuty) -> MeshLoad:
    """Force, bodies and flanks of a mesh. Theory (D1)."""
    return MeshLoad(
        duty.mesh,
        abs(duty.torque1) / duty.mesh.gear1.base_radius,
        flanks.gear_bodies(duty.mesh, duty.gears),
        flanks.flank_deviations(duty.mesh, duty.gears, duty.misalignment),
    )


def load_mesh(
    duty: MeshDuty, models: GearPairModels, numerics: Numerics, oil: OilState
) -> MeshContact | None:
    """Conditions along the contact lines; None without load or motion."""
    if duty.torque1 == 0 or duty.speed1 == 0:
        return None
    return contact_under(duty, distribute_load(duty, models, numerics), oil)


def contact_under(duty: MeshDuty, loads: LineLoads, oil: OilState) -> MeshContact:
    """Conditions along the contact lines under `loads`, at standstill too."""
    return mesh_contact(
        duty.mesh,
        loads.lines,
        loads.line_load,
        force=abs(duty.torque1) / duty.mesh.gear1.base_radius,
        speed1=abs(duty.speed1),
        oil=oil,
        flanks=_flanks(*duty.gears),
    )


def _flanks(one: GearTable, two: GearTable) -> Flanks:
    modulus = equivalent_modulus(
        one.material.elastic_modulus,
        one.material.poisson_ratio,
        two.material.elastic_modulus,
        two.material.poisson_ratio,
    )
    return Flanks(modulus, one.roughness, two.roughness)


def solve_mesh(
    case: Case, duty: MeshDuty, fluids: Fluids, flow: MeshFlow, count: int
) -> MeshOutcome:
    """Losses and figures of one mesh, `count` of which work in parallel."""
    models = resolve_models(case)
    friction, rolling = friction_of(case), rolling_of(case)
    quick = models["mesh"] == "loss-factor"
    contact = load_mesh(duty, case.models, case.numerics, fluids.oil)
    elastic = None
    if contact is not None:
        elastic = distribute_load(duty, case.models, case.numerics).elastic
    if contact is None:
        loss = MeshLoss(0.0, 0.0, math.nan)
    elif quick:
        loss = loss_factor_loss(contact, friction)
    else:
        loss = local_loss(contact, friction, rolling)
    method, source = friction.title, friction.source
    rolling_part = Part(LOAD_DEPENDENT, count * loss.rolling, rolling.title, rolling.source)
    if quick:
        method, source = f"{method} times the loss factor", f"{source}; {OHLENDORF_SOURCE}"
        rolling_part = Part(LOAD_DEPENDENT, left_out="the loss-factor method has no rolling loss")
    parts = {
        f"{duty.key}_sliding": Part(LOAD_DEPENDENT, count * loss.sliding, method, source),
        f"{duty.key}_rolling": rolling_part,
        f"{duty.key}_pocketing": _pocketing(case, flow, count),
    }
    figures = _mesh_figures(duty, contact, loss.mean_friction, elastic, flow.figures)
    notes = pocket_notes(case, duty.mesh, flow.figures)
    notes += stored_note(case, duty.mesh, flow.figures)
    if contact is not None and isinstance(friction, EhlDirect):
        notes += friction.remarks(contact)
    return MeshOutcome(parts, figures, loss.flags, notes)


def _pocketing(case: Case, flow: MeshFlow, count: int) -> Part:
    """Pocketing loss of `count` meshes."""
    if flow.left_out:
        return Part(LOAD_INDEPENDENT, left_out=flow.left_out)
    watts = 0.0 if flow.figures is None else count * flow.figures.power
    method = pocketing_method(case, flow.figures)
    return Part(LOAD_INDEPENDENT, watts, method, POCKETING_SOURCE)


def _largest(values: FloatArray, weight: FloatArray) -> float:
    """The value that `PEAK_SHARE` of the contact exceeds. Theory (D5)."""
    order = np.argsort(values)
    below = np.cumsum(weight[order])
    return float(values[order][np.searchsorted(below, (1 - PEAK_SHARE) * below[-1])])


def _mesh_figures(
    duty: MeshDuty,
    contact: MeshContact | None,
    friction_mean: float,
    elastic: LoadedMesh | None,
    flow: FlowFigures | None,
) -> MeshFigures:
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
        misalignment=duty.misalignment,
        pitch_line_speed=speed1 * mesh.operating_radius1,
        sliding_speed_max=sliding,
        line_load_max=(
            math.nan if contact is None else _largest(contact.line_load, contact.weight)
        ),
        hertz_pressure_max=(
            math.nan if contact is None else _largest(contact.hertz_pressure, contact.weight)
        ),
        contact_share=(
            math.nan if contact is None else float(contact.weight.sum()) / mesh.mean_contact_length
        ),
        film_ratio_min=math.nan if contact is None else float(contact.film_ratio.min()),
        film_ratio_max=math.nan if contact is None else float(contact.film_ratio.max()),
        friction_mean=friction_mean,
        loss_factor=ohlendorf_loss_factor(mesh),
        transmission_error_range=math.nan if elastic is None else elastic.transmission_error_range,
        mesh_stiffness=math.nan if elastic is None else elastic.mean(elastic.tangent_stiffness),
        pocket_pressure_max=math.nan if flow is None else flow.pressure_max,
        pocket_pressure_min=math.nan if flow is None else flow.pressure_min,
        pocket_speed_max=math.nan if flow is None else flow.speed_max,
        pocket_power_difference=math.nan if flow is None else flow.difference,
        pocket_interpolation_error=math.nan if flow is None else flow.error,
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
    reason = part.left_out or ("" if option.include else "left out by the case")
    if reason:
        return LossTerm(name, 0.0, part.group, "", "", left_out=reason)
    watts = option.factor * part.watts
    return LossTerm(name, watts, part.group, part.method, part.source, factor=option.factor)


@dataclass(frozen=True, slots=True)
class Body:
    """A body that turns in the mixture, as a disc.

    Attributes
    ----------
    where : str
    radius, width : float
        [m]
    speed : float
        Against the housing. [rad/s]
    """

    where: str
    radius: float
    width: float
    speed: float


def drag_part(
    bodies: Iterable[Body], mixture: MixtureState
) -> tuple[Part, tuple[ValidityFlag, ...]]:
    """The drag of `bodies` together, and its flags."""
    watts = 0.0
    flags: tuple[ValidityFlag, ...] = ()
    for body in bodies:
        drag = disc_drag(body.radius, body.width, body.speed, mixture)
        watts += drag.total
        flags += disc_drag_flags(body.where, body.radius, drag, body.speed, mixture)
    return Part(LOAD_INDEPENDENT, watts, DRAG_METHOD, DRAG_SOURCE), flags


def used_sources(terms: Iterable[LossTerm], *more: str) -> tuple[str, ...]:
    """Sources of the terms that are included, each once, in order, and `more`."""
    sources = [term.source for term in terms if not term.left_out]
    return tuple(dict.fromkeys(source for source in (*sources, *more) if source))
