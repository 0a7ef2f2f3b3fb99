"""Two gears in mesh: load along the contact lines, sliding, rolling and pocketing loss."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from epicyclic.arrays import (
    TINY,
    Alone,
    AtOnce,
    Each,
    FloatArray,
    Points,
    either,
    itself,
    joined,
    larger,
    largest,
    least,
    most,
    one_by_one,
    total,
)
from epicyclic.contact.elastic_teeth import UNMODIFIED, GearBody, LoadedMesh, load_mesh_elastically
from epicyclic.contact.line_contact import Flanks
from epicyclic.contact.temperatures import Solid
from epicyclic.dataclass import dataclass, fields, replace
from epicyclic.gears.cutting import Tool
from epicyclic.gears.flanks import FlankDeviations
from epicyclic.gears.mesh import Mesh
from epicyclic.losses.contact import (
    LOAD_DISTRIBUTIONS,
    LineLoads,
    MeshContact,
    MeshLoad,
    mesh_contact,
)
from epicyclic.losses.friction import CONTAINS_ROLLING, FrictionModel
from epicyclic.losses.mesh import (
    MeshLoss,
    flash_temperatures,
    heat_share1,
    local_loss,
    loss_factor_loss,
    loss_factor_notes,
    mean_friction,
    ohlendorf_loss_factor,
)
from epicyclic.losses.pocket_tables import FLOW_NUMBERS, FlowFigures
from epicyclic.losses.ranges import SMALLEST_SHOWN_SHARE, Sought
from epicyclic.losses.rolling import CONTAINED, RollingModel
from epicyclic.machine.element import (
    LOAD_DEPENDENT,
    LOAD_INDEPENDENT,
    ElementResult,
    Extremes,
    Figures,
    Fluids,
    Loss,
    Note,
    figure,
)
from epicyclic.machine.pocket_flow import (
    POCKETING_SOURCE,
    MeshFlow,
    PocketSettings,
    pocket_notes,
    pocketing_method,
)
from epicyclic.oil.oil import OilState
from epicyclic.units import (
    CELSIUS,
    DEGREE,
    GIGAPASCAL,
    KELVIN,
    METRE_PER_SECOND,
    MICROMETRE,
    MILLIMETRE,
    NEWTON_PER_MM,
    NEWTON_PER_UM,
    NUMBER,
    WATT,
)

PEAK_SHARE = 0.01
"""Part of the contact that the largest line load and pressure of a mesh leave out. [1]"""
MOSTLY_ENOUGH = 0.1  # Of the points that carry most, among which is where that share ends. [1]
NOWHERE = 1e300  # Film ratio of what does not touch. [1]
OHLENDORF_SOURCE = "loss factor: H. Ohlendorf, Diss. TH Muenchen (1958)"


@dataclass(frozen=True, slots=True)
class MeshModels:
    """How the losses of a mesh are computed."""

    pointwise = True

    friction: FrictionModel
    rolling: RollingModel
    # True for mean friction times Ohlendorf's loss factor, without rolling loss.
    by_loss_factor: bool
    load_distribution: str  # A key of `LOAD_DISTRIBUTIONS`.
    positions: int  # Of the mesh in one period that are solved.
    segments: int  # Of a contact line.
    pockets: PocketSettings

    @property
    def several(self) -> bool:
        """Whether they take several operating points at once."""
        models = self.friction, self.rolling
        return not self.by_loss_factor and all(getattr(it, "several", False) for it in models)


@dataclass(frozen=True, slots=True)
class GearMesh:
    """Two gears in mesh, each on a body, seen from a carrier."""

    pointwise = True

    key: str  # ``"sun_mesh"``: first word of its losses.
    mesh: Mesh
    bodies: tuple[str, str]  # The bodies of gear 1 and gear 2.
    tools: tuple[Tool, Tool]  # The tools that cut both gears.
    roundings: tuple[float | None, float | None]  # Tip rounding of both tools, where stated. [m]
    flanks: Flanks[float]  # Roughness of both flanks, equivalent modulus.
    solids: tuple[GearBody, GearBody]  # What makes both gears yield.
    deviations: FlankDeviations  # Micro-geometry of both flanks, and misalignment.
    models: MeshModels
    materials: tuple[Solid, Solid]  # Materials of both gears.
    nodes: tuple[str, str]  # The thermal nodes of both gears.


@dataclass(frozen=True, slots=True)
class MeshDuty:
    """A mesh and what it has to do, relative to the carrier, for one planet."""

    pointwise = True

    gears: GearMesh
    torque1: float  # That gear 1 brings into the mesh. [N m]
    speed1: float  # Speed of gear 1 against the carrier. [rad/s]
    drives1: bool  # True if power flows from gear 1 to gear 2 or no power flows.

    @property
    def force(self) -> float:
        """Along the transverse line of action. Theory (D1). [N]"""
        return abs(self.torque1) / self.gears.mesh.gear1.base_radius

    @property
    def deviations(self) -> FlankDeviations:
        """Of the flanks in contact: with the power reversed, those behind."""
        own = self.gears.deviations
        return own if self.drives1 else replace(own, mirrored=True)

    def misaligned(self, by: float) -> MeshDuty:
        """The same with a further misalignment, along y of the contact lines, in metres."""
        deviations = self.gears.deviations
        by = -by if self.deviations.mirrored else by
        tilted = replace(deviations, misalignment=deviations.misalignment + by)
        return replace(self, gears=replace(self.gears, deviations=tilted))


@dataclass(frozen=True, slots=True, eq=False)
class MeshFigures:
    """What an engineer checks by eye on a mesh; NaN where there is no load or no motion.

    The largest line load and pressure leave out the 1 % of the contact that carries most: in the
    corners of a helical face without end relief the load has no bound, and its largest value would
    be that of the resolution.

    Transmission error and stiffness, in the transverse plane of action, are those of elastic teeth
    and NaN with another load distribution.

    `flattening` is the half-width of the contact that is pressed with `hertz_pressure_max` over its
    radius, `resistance` the loss over what the load could resist with at the speeds of both flanks,
    a mean coefficient of friction: numbers above 1 cannot be.
    """

    pointwise = True

    seen: Callable[[], MeshContact | None]  # The contact.
    flattening: float
    resistance: float
    pressure_angle: float = figure("operating pressure angle, transverse", DEGREE)
    transverse_contact_ratio: float = figure("transverse contact ratio", NUMBER)
    overlap_ratio: float = figure("overlap ratio", NUMBER)
    backlash: float = figure("circumferential backlash", MILLIMETRE)
    misalignment: float = figure("misalignment, with tilt of the planet if coupled", MICROMETRE)
    pitch_line_speed: float = figure("pitch-line speed, relative to carrier", METRE_PER_SECOND)
    sliding_speed_max: float = figure("largest sliding speed", METRE_PER_SECOND)
    line_load_max: float = figure("line load exceeded on 1 % of the contact", NEWTON_PER_MM)
    hertz_pressure_max: float = figure("Hertz pressure exceeded on 1 % of the contact", GIGAPASCAL)
    contact_share: float = figure("loaded share of the contact lines", NUMBER)
    film_ratio_min: float = figure("smallest film ratio", NUMBER)
    film_ratio_max: float = figure("largest film ratio", NUMBER)
    friction_mean: float = figure("mean coefficient of friction", NUMBER)
    loss_factor: float = figure("loss factor H_V (Ohlendorf)", NUMBER)
    transmission_error_range: float = figure("loaded transmission error, peak to peak", MICROMETRE)
    mesh_stiffness: float = figure("mean mesh stiffness at this load", NEWTON_PER_UM)
    pocket_pressure_max: float = figure(*FLOW_NUMBERS["pressure_max"])
    pocket_pressure_min: float = figure(*FLOW_NUMBERS["pressure_min"])
    pocket_speed_max: float = figure(*FLOW_NUMBERS["speed_max"])
    pocket_power_difference: float = figure(*FLOW_NUMBERS["difference"])
    pocket_interpolation_error: float = figure(
        "largest interpolation error of the pocketing loss", NUMBER
    )
    contact_temperature: float = figure("oil temperature at the contact inlet", CELSIUS)
    flash_temperature_mean: float = figure("mean flash temperature, weighted by load", KELVIN)
    flash_temperature_max: float = figure("largest flash temperature", KELVIN)

    @property
    def contact(self) -> MeshContact | None:
        """Conditions along the contact lines; None without load or motion."""
        return self.seen()


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshResult(ElementResult):
    """Losses, figures and flags of one mesh, and what the next pass goes on from."""

    elastic: LoadedMesh | None  # The teeth under load, if they are elastic.
    friction: FrictionModel  # With what it has solved.


def distribute_load(duty: MeshDuty, last: LoadedMesh | None = None) -> LineLoads:
    """Contact lines of a mesh and the load on them under the torque of its duty.

    `last`, the mesh under nearly that torque, saves work.
    """
    own, models = duty.gears.deviations, duty.gears.models
    distribution = LOAD_DISTRIBUTIONS[models.load_distribution]
    deviations = own if own == UNMODIFIED else duty.deviations  # alike on both flanks
    load = MeshLoad(duty.gears.mesh, duty.force, duty.gears.solids, deviations, last)
    return distribution.distribute(load, models.positions, models.segments)


def elastic_loads(duty: MeshDuty) -> LoadedMesh:
    """The mesh under the torque of its duty with elastic teeth, whatever distributes the load."""
    if isinstance(duty.force, Points):
        raise Alone
    mesh, solids, models = duty.gears.mesh, duty.gears.solids, duty.gears.models
    size = models.positions, models.segments
    return load_mesh_elastically(mesh, *solids, *size, duty.force, duty.deviations)


def load_mesh(duty: MeshDuty, oil: OilState, around: OilState | None = None) -> MeshContact | None:
    """Conditions along the contact lines; None without load or motion."""
    if duty.torque1 == 0 or duty.speed1 == 0:
        return None
    return contact_under(duty, distribute_load(duty), oil, around)


def contact_under(
    duty: MeshDuty,
    loads: LineLoads,
    oil: OilState,  # At the temperature of the flanks.
    around: OilState | None = None,  # Around the gears, if that differs.
) -> MeshContact:
    """Conditions along the contact lines under `loads`, at standstill too."""
    return mesh_contact(
        duty.gears.mesh,
        loads.lines,
        loads.line_load,
        force=duty.force,
        speed1=abs(duty.speed1),
        oil=oil,
        flanks=duty.gears.flanks,
        around=around,
    )


def solve_mesh(
    duty: MeshDuty,
    fluids: Fluids,
    flow: MeshFlow,
    count: int,
    oil: OilState,
    last: MeshResult | None = None,
    loaded: LoadedMesh | None = None,
) -> MeshResult:
    """Losses and figures of one mesh of `count` in parallel, with `oil` on its flanks.

    `last`, the result under nearly this torque, saves work; so do the teeth `loaded` by it at
    another temperature.
    """
    key, models = duty.gears.key, duty.gears.models
    friction = models.friction if last is None else last.friction
    rolling = models.rolling
    loads = None
    if duty.torque1 != 0 and duty.speed1 != 0:
        loads = distribute_load(duty, loaded if last is None else last.elastic)
    contact = None if loads is None else contact_under(duty, loads, oil, fluids.oil)
    loss = MeshLoss(0.0, 0.0)
    if contact is not None:
        friction = friction.solved_for(contact)
        if models.by_loss_factor:
            loss = loss_factor_loss(contact, friction)
        else:
            loss = local_loss(contact, friction, rolling)
    share1 = 0.5 if contact is None else heat_share1(contact, loss.heat, duty.gears.materials)
    method, source = friction.title, friction.source
    node1, node2 = duty.gears.nodes
    watts, halves = count * loss.rolling, ((node1, 0.5), (node2, 0.5))
    rolling_loss = Loss(LOAD_DEPENDENT, watts, rolling.title, rolling.source, heat=halves)
    if models.by_loss_factor:
        method, source = f"{method} times the loss factor", f"{source}; {OHLENDORF_SOURCE}"
        rolling_loss = Loss(LOAD_DEPENDENT, left_out="the loss-factor method has no rolling loss")
    elif rolling is CONTAINED:
        rolling_loss = Loss(
            LOAD_DEPENDENT,
            left_out=f"contained in the friction {friction.name}, which was fitted to the whole "
            "load-dependent loss of gear tests",
        )
    pocketing = Loss(LOAD_INDEPENDENT, left_out=flow.left_out)
    if not flow.left_out:
        watts = 0.0 if flow.figures is None else count * flow.figures.power
        model = one_by_one(pocketing_method, models.pockets.model, flow.figures)
        pocketing = Loss(LOAD_INDEPENDENT, watts, model, POCKETING_SOURCE)
    watts, heat = count * loss.sliding, ((node1, share1), (node2, 1 - share1))
    losses = {
        f"{key}_sliding": Loss(LOAD_DEPENDENT, watts, method, source, heat=heat),
        f"{key}_rolling": rolling_loss,
        f"{key}_pocketing": pocketing,
    }
    elastic = None if loads is None else loads.elastic
    figures = AtOnce(_mesh_figures, duty, contact, loss, elastic, flow.figures)
    return MeshResult(
        losses=losses,
        figures=Figures({key: figures}),
        extremes=Figures({key: AtOnce(_mesh_extremes, duty, contact, loss, flow.figures)}),
        flags=loss.flags,
        notes=Sought(partial(_mesh_notes, duty, flow, fluids, count, losses, friction)),
        elastic=elastic,
        friction=friction,
    )


def _mesh_notes(
    duty: MeshDuty,
    flow: MeshFlow,
    fluids: Fluids,
    count: int,
    losses: Mapping[str, Loss],
    friction: FrictionModel,
) -> tuple[str, ...]:
    least = SMALLEST_SHOWN_SHARE * sum(term.watts for term in losses.values())
    notes = pocket_notes(duty, flow.figures, fluids, count, least)
    if duty.gears.models.by_loss_factor:
        notes += tuple(map(Note, loss_factor_notes(duty.gears.mesh)))
    elif duty.gears.models.rolling is not CONTAINED and friction.name in CONTAINS_ROLLING:
        notes += (
            f"The rolling loss of the {duty.gears.mesh.name}, "
            f"{WATT.text(losses[f'{duty.gears.key}_rolling'].watts, 3)}, counts twice: the "
            f"friction {friction.name} was fitted to the whole load-dependent loss of gear tests. "
            "models.rolling = auto adds none to it.",
        )
    return notes + friction.remarks


def _exceeded(values: FloatArray, weight: FloatArray, *others: FloatArray) -> list[float]:
    """What `PEAK_SHARE` of the contact exceeds, and the others there. Theory (D5)."""
    values, weight, *beside = map(np.atleast_2d, (values, weight, *others))
    rows = np.arange(len(values))[:, None]
    limit = PEAK_SHARE * weight.sum(axis=1, keepdims=True)
    for share in (MOSTLY_ENOUGH, 1.0):  # of all: to sort them takes several times as long
        most = math.ceil(share * values.shape[1])
        order = np.argpartition(values, -most)[:, -most:]
        order = order[rows, np.argsort(-values[rows, order])]
        above = np.cumsum(weight[rows, order], axis=1)
        if (above[:, -1:] > limit).all():
            break
    place = order[rows, np.minimum((above <= limit).sum(axis=1, keepdims=True), most - 1)]
    return [total(it[rows, place]) for it in (values, *beside)]


def _mesh_extremes(
    duty: MeshDuty, contact: MeshContact | None, loss: MeshLoss, flow: FlowFigures | None
) -> Extremes:
    error = math.nan if flow is None else flow.error
    if contact is None:
        return Extremes(math.nan, 0.0, 0.0, math.nan, error)
    speed = contact.rolling_speed + np.abs(contact.sliding_speed)
    resisted = total(contact.line_load * contact.weight * speed)
    return Extremes(
        pressure=most(contact.hertz_pressure),
        flattening=most(contact.hertz_half_width / contact.radius),
        resistance=either(
            resisted > 0, (loss.sliding + loss.rolling) / larger(resisted, TINY), 0.0
        ),
        share=total(contact.weight) / duty.gears.mesh.mean_contact_length,
        flow_error=error,
    )


def _mesh_figures(
    duty: MeshDuty,
    contact: MeshContact | None,
    loss: MeshLoss,
    elastic: LoadedMesh | Each | None,
    flow: FlowFigures | None,
) -> MeshFigures:
    mesh = duty.gears.mesh
    speed1 = abs(duty.speed1)
    sliding = largest(
        speed1 * rho1 - speed1 / mesh.ratio * mesh.curvature2(rho1)
        for rho1 in (mesh.path_start, mesh.path_end)
    )
    extremes = _mesh_extremes(duty, contact, loss, flow)
    found: dict[str, Any] = {"flattening": 0.0}
    if contact is not None:
        line_load, weight, loaded = contact.line_load, contact.weight, contact.line_load > 0
        flash = flash_temperatures(contact, loss.friction, duty.gears.materials) * loaded
        load, film = line_load * weight, contact.film_ratio * loaded
        flattened = contact.hertz_half_width / contact.radius
        # flattest where it is pressed most, too
        pressed, flattening = _exceeded(contact.hertz_pressure, weight, flattened)
        found = {
            "contact_temperature": contact.oil.temperature,
            "flash_temperature_mean": total(flash * load) / total(load),
            "flash_temperature_max": most(flash),
            "film_ratio_min": least(film + NOWHERE * ~loaded),
            "film_ratio_max": most(film),
            "friction_mean": mean_friction(contact, loss.friction),
            "line_load_max": _exceeded(line_load, weight)[0],
            "hertz_pressure_max": pressed,
            "flattening": flattening,
        }
    if elastic is not None:
        of_each = [
            {
                "transmission_error_range": one.transmission_error_range,
                "mesh_stiffness": one.mean(one.tangent_stiffness),
            }
            for one in (elastic if isinstance(elastic, Each) else [elastic])
        ]
        found |= joined(of_each) if isinstance(elastic, Each) else of_each[0]
    if flow is not None:
        found |= {
            "pocket_pressure_max": flow.pressure_max,
            "pocket_pressure_min": flow.pressure_min,
            "pocket_speed_max": flow.speed_max,
            "pocket_power_difference": flow.difference,
        }
    unknown: dict[str, Any] = dict.fromkeys((it.name for it in fields(MeshFigures)), math.nan)
    return MeshFigures(
        **unknown | found | {
            "seen": AtOnce(itself, contact),
            "resistance": extremes.resistance,
            "contact_share": extremes.share,
            "pocket_interpolation_error": extremes.flow_error,
            "pressure_angle": mesh.operating_pressure_angle,
            "transverse_contact_ratio": mesh.transverse_contact_ratio,
            "overlap_ratio": mesh.overlap_ratio,
            "backlash": mesh.backlash,
            "misalignment": duty.gears.deviations.misalignment,
            "pitch_line_speed": speed1 * mesh.operating_radius1,
            "sliding_speed_max": sliding,
            "loss_factor": ohlendorf_loss_factor(mesh),
        }
    )  # fmt: skip
