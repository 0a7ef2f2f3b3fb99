"""Losses of a gear pair on parallel axes."""

from __future__ import annotations

from epicyclic.analysis.models import resolve_models
from epicyclic.analysis.notes import contact_notes, fluid_notes, general_notes, load_notes
from epicyclic.analysis.parts import (
    Body,
    MeshDuty,
    drag_part,
    fluids_of,
    loss_terms,
    solve_mesh,
    used_sources,
)
from epicyclic.analysis.pockets import mesh_flows
from epicyclic.analysis.result import Result
from epicyclic.case import build
from epicyclic.case.case import GearPairCase
from epicyclic.kinematics import pair_power_flow
from epicyclic.losses.load_distribution import LOAD_DISTRIBUTIONS
from epicyclic.pocketing.table import FlowTables

__all__ = ["pair_duty", "solve_pair"]


def solve_pair(case: GearPairCase, flow_tables: FlowTables) -> Result:
    """The losses of a gear pair."""
    fluids = fluids_of(case)
    duty = pair_duty(case)
    flows = mesh_flows(case, (duty,), fluids.mixture, flow_tables)
    mesh = solve_mesh(case, duty, fluids, flows[duty.key], 1)
    drag, drag_flags = drag_part(_bodies(case, duty), fluids.mixture)
    terms = loss_terms(mesh.parts | {"drag": drag}, case.losses)
    distribution = LOAD_DISTRIBUTIONS[case.models.load_distribution]
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
        flags=fluids.flags + mesh.flags + drag_flags,
        notes=(
            *general_notes(terms, flow.input_power, flow.efficiency),
            *fluid_notes(case),
            *load_notes(case),
            *contact_notes({duty.key: mesh.figures}),
            *mesh.notes,
        ),
        load_methods={"load_distribution": distribution.title},
        load_sources={"load_distribution": distribution.source},
        sources=used_sources(terms, distribution.source),
        inputs=case.inputs(),
    )


def pair_duty(case: GearPairCase) -> MeshDuty:
    """The mesh of the pair with its torque and speed."""
    mesh = build.pair_mesh(case.gears, case.pinion, case.gear)
    operation = case.operation
    return MeshDuty(
        key="mesh",
        mesh=mesh,
        gears=(case.pinion, case.gear),
        torque1=operation.torque,
        speed1=operation.speed,
        drives1=operation.torque * operation.speed >= 0,
        tools=(
            build.fitted_tool(mesh.gear1, case.pinion, mesh.radius1_at_start),
            build.fitted_tool(mesh.gear2, case.gear, mesh.radius2_at_end),
        ),
        misalignment=case.mesh.misalignment,
    )


def _bodies(case: GearPairCase, duty: MeshDuty) -> tuple[Body, Body]:
    gear1, gear2 = duty.mesh.gear1, duty.mesh.gear2
    radius1 = build.outside_radius(gear1, case.pinion)
    radius2 = build.outside_radius(gear2, case.gear)
    return (
        Body("pinion", radius1, gear1.face_width, duty.speed1),
        Body("gear", radius2, gear2.face_width, duty.speed1 / duty.mesh.ratio),
    )
