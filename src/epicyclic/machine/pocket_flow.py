"""Flow through the pockets of meshes: solved, or read from tables of solved flows."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from epicyclic.arrays import Alone, Points, agreed, larger, one_by_one
from epicyclic.dataclass import dataclass, field, replace
from epicyclic.gears.mesh import with_faces
from epicyclic.losses.pocket_flow import (
    NETWORK_MODELS,
    POCKETING_MODELS,
    PocketFlow,
    PocketModel,
    sound_speed,
)
from epicyclic.losses.pocket_tables import (
    LEAST_NUMBER,
    FlowFamily,
    FlowFigures,
    FlowTables,
    KnownFlows,
    kept_figures,
    stored_table,
)
from epicyclic.losses.ranges import Range
from epicyclic.machine.element import Fluids, Note
from epicyclic.oil.oil import MixtureState
from epicyclic.units import BAR, DEGREE, METRE_PER_SECOND, MILLIMETRE, WATT, format_number, percent

if TYPE_CHECKING:
    from epicyclic.machine.gear_mesh import MeshDuty

POCKETING_SOURCE = "D. C. Talbot, PhD dissertation, Ohio State (2012), chapter 4"
STUDY_SOURCE = "Talbot (2012), section 4.4"
STUDY_RANGES = (
    Range("transverse_module", "transverse module", 1.786, 2.174, MILLIMETRE, STUDY_SOURCE),
    Range("face_width", "face width", 15.0, 35.0, MILLIMETRE, STUDY_SOURCE),
    Range("helix_angle", "helix angle", 0.0, 35.0, DEGREE, STUDY_SOURCE),
    Range("pitch_line_speed", "pitch line speed", 0.0, 26.2, METRE_PER_SECOND, STUDY_SOURCE),
)
"""Ranges of the parametric study: modules of Figure 4.13, face widths and helix angles of Figure
4.9, and 10000 rpm on a pitch circle of 50 mm."""
LARGEST_MACH = 0.5  # Fastest flow over the speed of sound above which waves matter. [1]
_EDGE = 1e-3  # By how much a value may leave a range that is printed with three or four digits. [1]
_AT_VOID = 1e-3  # Pressures nearer than this to that of a void are it. [1]
_ROUNDING = 1e-9  # What is left of a difference of pressures that are equal, over either. [1]

FlowRequest = tuple[FlowFamily, float, MixtureState, float]
"""A flow: its family, then as for `FlowFamily.flow`."""


@dataclass(frozen=True, slots=True)
class PocketSettings:
    """How the flow through the pockets of a mesh is found."""

    pointwise = True

    include: bool  # False if the loss is left out, so that nobody asks for the flow.
    oil_fraction: float  # Oil share by volume at ambient pressure. [1]
    model: PocketModel
    void_pressure: float  # Absolute pressure of a void in an incompressible mixture. [Pa]
    slices: int  # Resolution: across the face, in one pitch.
    steps: int  # Resolution: across the face, in one pitch.
    end_length: float  # Length of the control volumes at the ends of the face. [normal modules]
    file: Path | None = None  # File of a stored table.
    # Tables that the points of a sweep share.
    tables: FlowTables = field(default_factory=dict, hash=False, compare=False)
    fed: float = 0.0  # Oil that is fed into the mesh of one planet as the teeth mesh. [m^3/s]
    # Whether the gears may be named in any order: the smaller one is then gear 1 of the pockets.
    any_order: bool = False


@dataclass(frozen=True, slots=True)
class MeshFlow:
    """Flow through the pockets of a mesh."""

    pointwise = True

    # None without motion, and where the case leaves the loss out.
    figures: FlowFigures | None = None
    left_out: str = ""  # Why there can be no such loss; empty if there can.


def oil_in_mesh(duty: MeshDuty) -> float:
    """Share of oil in the pockets of a mesh: around it, and fed into it. Theory (N9)."""
    settings, mesh = duty.gears.models.pockets, duty.gears.mesh
    # volume of all tooth spaces of each gear, half of the ring that the teeth stand in [m^3]
    one, two = (
        math.pi * abs(gear.tip_radius**2 - gear.root_radius**2) * gear.face_width / 2
        for gear in (mesh.gear1, mesh.gear2)
    )
    passing = abs(duty.speed1) / (2 * math.pi) * (one + mesh.gear1.teeth / mesh.gear2.teeth * two)
    if not settings.fed or not passing:
        return settings.oil_fraction
    return -larger(-1.0, -settings.oil_fraction - settings.fed / passing)


def flow_family(duty: MeshDuty) -> FlowFamily:
    """The flows that that of a mesh belongs to."""
    settings, tools, drives1 = duty.gears.models.pockets, duty.gears.tools, agreed(duty.drives1)
    # what reaches beyond the common face is no part of the pockets
    mesh = with_faces(duty.gears.mesh, duty.gears.mesh.face_width)
    # time steps follow a tooth of gear 1 of the pockets; of equal gears it is the one that drives
    one, two = (
        (it.teeth, it.tip_radius, it.root_radius, it.thickness_half_angle)
        for it in (mesh.gear1, mesh.gear2)
    )
    sizes = ((a, b) for a, b in zip(one, two, strict=True) if not math.isclose(a, b))
    larger = next((a > b for a, b in sizes), not drives1)
    if settings.any_order and not mesh.internal and larger:
        mesh = replace(mesh, gear1=mesh.gear2, gear2=mesh.gear1)
        tools, drives1 = tools[::-1], not drives1
    return FlowFamily(
        mesh=mesh,
        tools=tools,
        drives1=drives1,
        oil_fraction=1.0 if settings.model in NETWORK_MODELS else oil_in_mesh(duty),
        model=settings.model,
        slices=settings.slices,
        steps=settings.steps,
        end_length=settings.end_length,
    )


def solve_pockets(duty: MeshDuty, fluids: Fluids) -> PocketFlow | None:
    """Flow through the pockets of a mesh; None without motion.

    Raises `ConvergenceError` if the flow is not found. Raises `ValueError` if a tooth has no
    outline.
    """
    if duty.speed1 == 0:
        return None
    family, speed, mixture, pressure = flow_request(duty, fluids)
    return family.flow(speed, mixture, pressure)


def flow_numbers(duties: Sequence[MeshDuty], fluids: Fluids) -> Iterator[tuple[FlowFamily, float]]:
    """Family and number of the flow of each mesh, as `flow_requests` has them."""
    for request in flow_requests(duties, fluids):
        yield request[0], FlowFamily.number(*request[1:])


def flow_requests(duties: Sequence[MeshDuty], fluids: Fluids) -> Iterator[FlowRequest]:
    """The flow of each mesh whose loss is included.

    Those that a stored table holds are left out, and those that another flow gives by scaling.
    Raises `InputError` if that table was made for other pockets.
    """
    for duty in duties:
        if duty.gears.models.pockets.include and duty.speed1 != 0:
            request = flow_request(duty, fluids)
            stored = _stored_figures(duty.gears.models.pockets, request)
            if stored is None and not request[0].scales(*request[1:]):
                yield request


def mesh_flows(
    duties: Sequence[MeshDuty],
    fluids: Fluids,
    known: KnownFlows,  # Those solved before.
) -> tuple[dict[str, MeshFlow], KnownFlows]:
    """Flow through the pockets of each mesh, by its key, and all that are known then.

    Read from the stored table of its settings, else scaled from another flow where that can be,
    else from the tables of a sweep or the known flows, where they have it. Raises
    `ConvergenceError` if a flow is not found. Raises `InputError` if the stored table was made for
    other pockets.
    """
    flows: dict[str, MeshFlow] = {duty.gears.key: MeshFlow() for duty in duties}
    wanted: dict[str, FlowRequest] = {}
    for duty in duties:
        if duty.gears.models.pockets.include and duty.speed1 != 0:
            request = flow_request(duty, fluids)
            figures = _stored_figures(duty.gears.models.pockets, request)
            if figures is None:
                wanted[duty.gears.key] = request
            flows[duty.gears.key] = MeshFlow(figures)
    _begin(tuple(family for family, *_ in wanted.values() if family.model in NETWORK_MODELS))
    direct: dict[str, FlowRequest] = {}
    tables = {duty.gears.key: duty.gears.models.pockets.tables for duty in duties}
    for key, request in wanted.items():
        figures = None
        if not request[0].scales(*request[1:]):
            figures = one_by_one(_found_before, *request, tables[key], known)
            if isinstance(request[1], Points) and not isinstance(figures, FlowFigures):
                raise Alone(len(request[1]))  # one solved at a time goes on from those known
        if figures is None:
            direct[key] = request
        flows[key] = MeshFlow(figures)
    requests = tuple(direct.values())
    # threads would cost more where all flows scale
    scaled = all(it[0].scales(*it[1:]) for it in requests)
    found = map(_solve, requests) if scaled else _solve_all(requests)
    solved = dict(zip(direct, found, strict=True))
    for key, flow in solved.items():
        if flow.figures is not None:
            known = known.with_flow(*direct[key], flow.figures)
    return flows | solved, known


def _found_before(
    family: FlowFamily, speed: float, mixture: MixtureState, pressure: float, tables: FlowTables,
    known: KnownFlows,
) -> FlowFigures | None:  # fmt: skip
    """Figures from a table, or between known flows; scaled at those of several points that do."""
    if isinstance(speed, Points):
        raise Alone(len(speed))
    at = speed, mixture, pressure
    figures = family.figures(*at) if family.scales(*at) else None
    if figures is None and family in tables:
        figures = tables[family].figures(*at)
    return known.figures(family, *at) if figures is None else figures


def flow_request(duty: MeshDuty, fluids: Fluids) -> FlowRequest:
    """The flow through the pockets of a mesh: family, and as for `FlowFamily.flow`."""
    settings, family = duty.gears.models.pockets, flow_family(duty)
    lowest = settings.void_pressure if settings.model == "incompressible" else 0.0
    mixture = fluids.mixed(oil_in_mesh(duty))
    speed = abs(duty.speed1)
    if family.mesh.gear1.name != duty.gears.mesh.gear1.name:  # gear 2 is gear 1 of the pockets
        speed /= duty.gears.mesh.ratio
    return family, speed, mixture, fluids.pressure - lowest


def _stored_figures(settings: PocketSettings, request: FlowRequest) -> FlowFigures | None:
    """From the stored table; None if there is none, or it does not hold the flow."""
    if settings.file is None:
        return None
    if isinstance(request[1], Points):
        raise Alone
    return stored_table(settings.file, request[0]).figures(*request[1:])


@lru_cache(maxsize=64)
def _begin(families: tuple[FlowFamily, ...]) -> None:
    """The flows from which others scale, all at once: their kernels release the interpreter."""
    if len(families) > 1:
        with ThreadPoolExecutor(len(families)) as pool:
            for family in families:  # what is wrong with one is told where its flow is asked for
                pool.submit(kept_figures, family, LEAST_NUMBER)


@lru_cache(maxsize=256)
def _solve_all(requests: tuple[FlowRequest, ...]) -> tuple[MeshFlow, ...]:
    """All flows at once: their kernels release the interpreter."""
    with ThreadPoolExecutor(len(requests)) as pool:
        return tuple(pool.map(_solve, requests))


def _solve(request: FlowRequest) -> MeshFlow:
    family, speed, mixture, pressure = request
    try:
        return MeshFlow(family.figures(speed, mixture, pressure))
    except ValueError as error:
        return MeshFlow(left_out=f"the tooth has no outline: {error}")


def pocketing_method(model: str, figures: FlowFigures | None) -> str:
    """How the loss was found, in words."""
    method = POCKETING_MODELS[model]
    if figures is None or not figures.nodes:
        return method
    if isinstance(figures.error, Points):
        raise Alone(len(figures.error))
    error = percent(figures.error, 2)
    if figures.file:
        return f"{method}, table {figures.file}, interpolated within {error}"
    return f"{method}, interpolated between {figures.nodes} flows within {error}"


def pocket_notes(
    duty: MeshDuty, figures: FlowFigures | None, fluids: Fluids, count: int, least: float = 0.0
) -> tuple[str, ...]:
    """What a user must know about the flow, with the watts that `count` such meshes lose by it.

    Of a loss below `least` watts only whether it was found.
    """
    if figures is None:
        return ()
    settings, name = duty.gears.models.pockets, duty.gears.mesh.name
    watts = count * figures.power
    lost = f"the pockets lose {WATT.text(watts, 3)}"
    notes = []
    if not figures.periodic:
        notes.append(
            f"The flow through the pockets of the {name} is not periodic over mesh periods; its "
            f"loss is the mean of {figures.periods // 2} periods."
        )
    if settings.file is not None and not figures.file:
        notes.append(
            f"models.pocketing_table does not cover the flow through the pockets of the {name} at "
            "this speed, oil density and pressure, so the flow was computed without the table."
        )
    if watts < least:
        return tuple(map(Note, notes))
    lowest, near = fluids.pressure + figures.pressure_min, _AT_VOID * settings.void_pressure
    near = max(near, _ROUNDING * fluids.pressure)
    if lowest < -near:
        notes.append(
            f"The pressure in the pockets of the {name} falls to {BAR.text(lowest, 3)} absolute, "
            f"which is impossible for a fluid ({lost}); models.pocketing = {settings.model} is "
            "meant for lower speeds."
        )
    elif settings.model == "incompressible" and lowest <= settings.void_pressure + near:
        notes.append(
            f"The pockets of the {name} open faster than they fill and contain voids at "
            f"models.pocket_void_pressure ({lost})."
        )
    sound = sound_speed(fluids.mixed(oil_in_mesh(duty)), fluids.pressure)
    # waves matter to a model without them, or without choking
    if settings.model != "isentropic" and figures.speed_max > LARGEST_MACH * sound:
        notes.append(
            f"The flow out of the pockets of the {name} reaches "
            f"{format_number(figures.speed_max / sound, 3)} times the speed of sound of a "
            f"homogeneous mixture, {METRE_PER_SECOND.text(sound, 3)} ({lost}). The loss lies "
            "between those of models.pocketing = incompressible and isentropic; epicyclic "
            "pockets shows both."
        )
    mesh = duty.gears.mesh
    studied = {
        "transverse_module": mesh.gear1.rack.transverse_module,
        "face_width": mesh.face_width,
        "helix_angle": abs(mesh.gear1.rack.helix_angle),
        "pitch_line_speed": abs(duty.speed1) * mesh.operating_radius1,
    }
    left = []
    for limit in STUDY_RANGES:
        value, (low, high) = studied[limit.name], limit.limits()
        if not (low or 0.0) * (1 - _EDGE) <= value <= (high or math.inf) * (1 + _EDGE):
            left.append(
                f"{limit.label} {limit.unit.text(value, 3)} "
                f"({format_number(limit.low or 0.0)} to {format_number(limit.high or 0.0)})"
            )
    if left:
        notes.append(
            f"The {name} lies outside the study of {STUDY_SOURCE}: {', '.join(left)}. "
            f"No other values of the model were published; {lost}."
        )
    return tuple(Note(note, watts) for note in notes)
