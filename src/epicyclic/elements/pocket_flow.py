"""Flow through the pockets of meshes: solved, or read from tables of solved flows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from epicyclic.elements.fluids import Fluids
from epicyclic.geometry.mesh import Mesh
from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.fluid import POCKETING_MODELS, PocketFlow, PocketModel
from epicyclic.pocketing.memory import FlowMemory
from epicyclic.pocketing.similarity import FlowFamily, FlowFigures
from epicyclic.pocketing.stored import stored_table
from epicyclic.pocketing.table import FlowTables

if TYPE_CHECKING:
    from epicyclic.elements.gear_mesh import MeshDuty

__all__ = [
    "POCKETING_SOURCE",
    "MeshFlow",
    "PocketSettings",
    "flow_family",
    "flow_numbers",
    "mesh_flows",
    "pocket_notes",
    "pocketing_method",
    "solve_pockets",
    "stored_note",
]

POCKETING_SOURCE = "D. C. Talbot, PhD dissertation, Ohio State (2012), chapter 4"

_Request = tuple[FlowFamily, float, MixtureState, float]


@dataclass(frozen=True, slots=True)
class PocketSettings:
    """How the flow through the pockets of a mesh is found.

    Attributes
    ----------
    include : bool
        False if the loss is left out, so that nobody asks for the flow.
    oil_fraction : float
        Oil share by volume at ambient pressure. [1]
    model : PocketModel
    slices, steps : int
        Resolution: across the face, in one pitch.
    end_length : float
        Of the control volumes at the ends of the face. [normal modules]
    file : Path or None
        Of a stored table.
    tables : mapping of FlowFamily to FlowTable
        Tables that the points of a sweep share.
    memory : FlowMemory or None
        Flows of this very case at other temperatures, while they settle.
    """

    include: bool
    oil_fraction: float
    model: PocketModel
    slices: int
    steps: int
    end_length: float
    file: Path | None = None
    tables: FlowTables = field(default_factory=dict, hash=False, compare=False)
    memory: FlowMemory | None = field(default=None, hash=False, compare=False)


@dataclass(frozen=True, slots=True)
class MeshFlow:
    """Flow through the pockets of a mesh.

    Attributes
    ----------
    figures : FlowFigures or None
        None without motion, and where the case leaves the loss out.
    left_out : str
        Why there can be no such loss; empty if there can.
    """

    figures: FlowFigures | None = None
    left_out: str = ""


def flow_family(duty: MeshDuty) -> FlowFamily:
    """The flows that that of a mesh belongs to."""
    settings = duty.models.pockets
    return FlowFamily(
        mesh=duty.mesh,
        tools=duty.tools,
        drives1=duty.drives1,
        oil_fraction=settings.oil_fraction,
        model=settings.model,
        slices=settings.slices,
        steps=settings.steps,
        end_length=settings.end_length,
    )


def solve_pockets(duty: MeshDuty, fluids: Fluids) -> PocketFlow | None:
    """Flow through the pockets of a mesh; None without motion.

    Raises
    ------
    ConvergenceError
        If the flow is not found.
    ValueError
        If a tooth has no outline.
    """
    if duty.speed1 == 0:
        return None
    return flow_family(duty).flow(abs(duty.speed1), fluids.mixture, fluids.pressure)


def flow_numbers(duties: Sequence[MeshDuty], fluids: Fluids) -> Iterator[tuple[FlowFamily, float]]:
    """Family and number of the flow of each mesh whose loss is included.

    Those that a stored table holds are left out.

    Raises
    ------
    InputError
        If that table was made for other pockets.
    """
    for duty in duties:
        if duty.models.pockets.include and duty.speed1 != 0:
            request = _request(duty, fluids)
            if _stored_figures(duty.models.pockets, request) is None:
                yield request[0], FlowFamily.number(*request[1:])


def mesh_flows(duties: Sequence[MeshDuty], fluids: Fluids) -> Mapping[str, MeshFlow]:
    """Flow through the pockets of each mesh, by its key.

    Read from the stored table of its settings, else from the tables of a sweep, where they have it.

    Raises
    ------
    ConvergenceError
        If a flow is not found.
    InputError
        If the stored table was made for other pockets.
    """
    flows: dict[str, MeshFlow] = {duty.key: MeshFlow() for duty in duties}
    direct: dict[str, _Request] = {}
    for duty in duties:
        settings = duty.models.pockets
        if not settings.include or duty.speed1 == 0:
            continue
        request = _request(duty, fluids)
        figures = _stored_figures(settings, request)
        if figures is None and request[0] in settings.tables:
            figures = settings.tables[request[0]].figures(*request[1:])
        if figures is None and settings.memory is not None:
            figures = settings.memory.figures(*request)
        if figures is None:
            direct[duty.key] = request
        else:
            flows[duty.key] = MeshFlow(figures)
    solved = dict(zip(direct, _solve_all(tuple(direct.values())), strict=True))
    for duty in duties:
        memory = duty.models.pockets.memory
        figures = solved[duty.key].figures if duty.key in solved else None
        if memory is not None and figures is not None:
            memory.add(*direct[duty.key], figures)
    return flows | solved


def _request(duty: MeshDuty, fluids: Fluids) -> _Request:
    return flow_family(duty), abs(duty.speed1), fluids.mixture, fluids.pressure


def _stored_figures(settings: PocketSettings, request: _Request) -> FlowFigures | None:
    """From the stored table; None if there is none, or it does not hold the flow."""
    if settings.file is None:
        return None
    return stored_table(settings.file, request[0]).figures(*request[1:])


@lru_cache(maxsize=256)
def _solve_all(requests: tuple[_Request, ...]) -> tuple[MeshFlow, ...]:
    """All flows at once: their kernels release the interpreter."""
    if len(requests) < 2:
        return tuple(map(_solve, requests))
    with ThreadPoolExecutor(len(requests)) as pool:
        return tuple(pool.map(_solve, requests))


def _solve(request: _Request) -> MeshFlow:
    family, speed, mixture, pressure = request
    try:
        return MeshFlow(family.figures(speed, mixture, pressure))
    except ValueError as error:
        return MeshFlow(left_out=f"no tooth outline: {error}")


def pocketing_method(model: PocketModel, figures: FlowFigures | None) -> str:
    """How the loss was found, in words."""
    method = POCKETING_MODELS[model]
    if figures is None or not figures.nodes:
        return method
    if figures.file:
        return f"{method}, table {figures.file}, interpolated within {figures.error:.2%}"
    return f"{method}, interpolated between {figures.nodes} flows within {figures.error:.2%}"


def pocket_notes(mesh: Mesh, figures: FlowFigures | None, ambient: float) -> tuple[str, ...]:
    """What a user must know about the flow."""
    if figures is None:
        return ()
    notes = []
    if not figures.periodic:
        notes.append(
            f"The flow through the pockets of the {mesh.name} does not repeat from one mesh period "
            f"to the next; its loss is the mean of {figures.periods // 2} periods."
        )
    if figures.pressure_min < -ambient:
        notes.append(
            f"The pressure in the pockets of the {mesh.name} falls below zero, where the "
            "fluid would cavitate: models.pocketing = incompressible is meant for lower speeds."
        )
    return tuple(notes)


def stored_note(
    settings: PocketSettings, mesh: Mesh, figures: FlowFigures | None
) -> tuple[str, ...]:
    """That the flow is not in the stored table."""
    if settings.file is None or figures is None or figures.file:
        return ()
    return (
        f"models.pocketing_table does not hold the flow through the pockets of the {mesh.name} "
        "at this speed, oil density and pressure: it was found without the table.",
    )
