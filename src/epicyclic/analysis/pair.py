"""Losses of a gear pair on parallel axes."""

from __future__ import annotations

from epicyclic.analysis.parts import (
    MeshDuty,
    Part,
    fluid_notes,
    fluids_of,
    general_notes,
    loss_terms,
    resolve_models,
    solve_mesh,
    used_sources,
)
from epicyclic.analysis.planetary import DRAG_METHOD, DRAG_SOURCE
from epicyclic.analysis.result import Result
from epicyclic.case import build
from epicyclic.case.case import GearPairCase
from epicyclic.kinematics import pair_power_flow
from epicyclic.losses.viscous import disc_drag_loss
from epicyclic.lubricant.properties import MixtureState

__all__ = ["pair_duty", "solve_pair"]


def solve_pair(case: GearPairCase) -> Result:
    """The losses of a gear pair."""
    fluids = fluids_of(case)
    duty = pair_duty(case)
    mesh = solve_mesh(case, duty, fluids.oil, 1)
    drag = Part(_drag(case, duty, fluids.mixture), DRAG_METHOD, DRAG_SOURCE)
    terms = loss_terms(mesh.parts | {"drag": drag}, case.losses)
    flow = pair_power_flow(
        duty.mesh.ratio,
        duty.mesh.internal,
        duty.torque1,
        duty.speed1,
        sum(term.watts for term in terms),
    )
    return Result(
        title=case.title,
        kind=case.kind,
        terms=terms,
        flow=flow,
        meshes={duty.key: mesh.figures},
        bearing=None,
        fluid=fluids.figures,
        models=resolve_models(case),
        flags=fluids.flags + mesh.flags,
        notes=general_notes(terms, flow.input_power, flow.efficiency) + fluid_notes(case),
        sources=used_sources(terms),
        inputs=case.inputs(),
    )


def pair_duty(case: GearPairCase) -> MeshDuty:
    """The mesh of the pair with its torque and speed."""
    mesh = build.pair_mesh(case.gears, case.pinion, case.gear)
    operation = case.operation
    return MeshDuty("mesh", mesh, (case.pinion, case.gear), operation.torque, operation.speed)


def _drag(case: GearPairCase, duty: MeshDuty, mixture: MixtureState) -> float:
    mesh = duty.mesh
    bodies = (
        (mesh.gear1, case.pinion, duty.speed1),
        (mesh.gear2, case.gear, duty.speed1 / mesh.ratio),
    )
    return sum(
        disc_drag_loss(build.outside_radius(gear, table), gear.face_width, speed, mixture)
        for gear, table, speed in bodies
    )
