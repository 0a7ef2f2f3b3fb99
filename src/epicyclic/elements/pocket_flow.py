"""Pocketing loss of the meshes of a case: solved, or read from a table of solved flows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from epicyclic.case.case import Case
from epicyclic.case.model_tables import LossOption
from epicyclic.geometry.mesh import Mesh
from epicyclic.lubricant.properties import MixtureState
from epicyclic.pocketing.fluid import POCKETING_MODELS, PocketFlow
from epicyclic.pocketing.similarity import FlowFamily, FlowFigures
from epicyclic.pocketing.stored import stored_table
from epicyclic.pocketing.table import FlowTables

if TYPE_CHECKING:
    from epicyclic.analysis.parts import MeshDuty

__all__ = [
    "POCKETING_SOURCE",
    "MeshFlow",
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


def flow_family(case: Case, duty: MeshDuty) -> FlowFamily:
    """The flows that that of a mesh belongs to."""
    return FlowFamily(
        mesh=duty.mesh,
        tools=duty.tools,
        drives1=duty.drives1,
        oil_fraction=case.surroundings.oil_air_ratio,
        model=case.models.pocketing,
        slices=case.numerics.pocket_slices,
        steps=case.numerics.pocket_steps,
        end_length=case.models.pocket_end_length,
    )


def solve_pockets(case: Case, duty: MeshDuty, mixture: MixtureState) -> PocketFlow | None:
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
    return flow_family(case, duty).flow(abs(duty.speed1), mixture, case.surroundings.pressure)


def flow_numbers(
    case: Case, duties: Sequence[MeshDuty], mixture: MixtureState
) -> Iterator[tuple[FlowFamily, float]]:
    """Family and number of the flow of each mesh whose loss the case includes.

    Those that ``models.pocketing_table`` holds are left out.

    Raises
    ------
    InputError
        If that table was made for other pockets.
    """
    for duty in duties:
        if _included(case, duty) and duty.speed1 != 0:
            request = _request(case, duty, mixture)
            if _stored_figures(case, request) is None:
                yield request[0], FlowFamily.number(*request[1:])


def mesh_flows(
    case: Case, duties: Sequence[MeshDuty], mixture: MixtureState, tables: FlowTables
) -> dict[str, MeshFlow]:
    """Flow through the pockets of each mesh, by its key.

    Read from ``models.pocketing_table``, else from `tables`, where they have it.

    Raises
    ------
    ConvergenceError
        If a flow is not found.
    InputError
        If the table of the case was made for other pockets.
    """
    flows: dict[str, MeshFlow] = {duty.key: MeshFlow() for duty in duties}
    direct: dict[str, _Request] = {}
    for duty in duties:
        if not _included(case, duty) or duty.speed1 == 0:
            continue
        request = _request(case, duty, mixture)
        figures = _stored_figures(case, request)
        if figures is None and request[0] in tables:
            figures = tables[request[0]].figures(*request[1:])
        if figures is None:
            direct[duty.key] = request
        else:
            flows[duty.key] = MeshFlow(figures)
    return flows | dict(zip(direct, _solve_all(tuple(direct.values())), strict=True))


def _request(case: Case, duty: MeshDuty, mixture: MixtureState) -> _Request:
    return flow_family(case, duty), abs(duty.speed1), mixture, case.surroundings.pressure


def _stored_figures(case: Case, request: _Request) -> FlowFigures | None:
    """From the table that the case names; None if it names none, or the table does not hold it."""
    file = case.models.pocketing_table
    if file is None:
        return None
    return stored_table(case.folder / file, request[0]).figures(*request[1:])


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


def _included(case: Case, duty: MeshDuty) -> bool:
    option: LossOption = getattr(case.losses, f"{duty.key}_pocketing")
    return option.include


def pocketing_method(case: Case, figures: FlowFigures | None) -> str:
    """How the loss was found, in words."""
    method = POCKETING_MODELS[case.models.pocketing]
    if figures is None or not figures.nodes:
        return method
    if figures.file:
        return f"{method}, table {figures.file}, interpolated within {figures.error:.2%}"
    return f"{method}, interpolated between {figures.nodes} flows within {figures.error:.2%}"


def pocket_notes(case: Case, mesh: Mesh, figures: FlowFigures | None) -> tuple[str, ...]:
    """What a user must know about the flow."""
    if figures is None:
        return ()
    notes = []
    if not figures.periodic:
        notes.append(
            f"The flow through the pockets of the {mesh.name} does not repeat from one mesh period "
            f"to the next; its loss is the mean of {figures.periods // 2} periods."
        )
    if figures.pressure_min < -case.surroundings.pressure:
        notes.append(
            f"The pressure in the pockets of the {mesh.name} falls below zero, where the "
            "fluid would cavitate: models.pocketing = incompressible is meant for lower speeds."
        )
    return tuple(notes)


def stored_note(case: Case, mesh: Mesh, figures: FlowFigures | None) -> tuple[str, ...]:
    """That the flow is not in the table that the case names."""
    if case.models.pocketing_table is None or figures is None or figures.file:
        return ()
    return (
        f"models.pocketing_table does not hold the flow through the pockets of the {mesh.name} "
        "at this speed, oil density and pressure: it was found without the table.",
    )
