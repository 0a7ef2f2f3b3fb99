"""Losses of a planetary gear set: both meshes and the bearing of every planet, and the drags."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from epicyclic.analysis.figures import BearingFigures, MeshFigures
from epicyclic.analysis.load_sharing import SHARING_METHODS, planet_shares
from epicyclic.analysis.models import resolve_models
from epicyclic.analysis.notes import contact_notes, fluid_notes, general_notes, load_notes
from epicyclic.analysis.parts import (
    Body,
    Fluids,
    MeshDuty,
    Part,
    drag_part,
    fluids_of,
    loss_terms,
    solve_mesh,
    used_sources,
)
from epicyclic.analysis.planet_bearing import planet_bearing, solve_bearing
from epicyclic.analysis.planet_load import PlanetLoad, planet_load, tilt_planet
from epicyclic.analysis.pockets import MeshFlow, mesh_flows
from epicyclic.analysis.result import LOAD_INDEPENDENT, LossTerm, Result
from epicyclic.case import build
from epicyclic.case.case import PlanetaryCase
from epicyclic.case.model_tables import LoadSharing
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.tools import Tool
from epicyclic.kinematics import (
    MEMBERS,
    PowerFlow,
    lossless_torques,
    planet_speed,
    planetary_power_flow,
    planetary_speeds,
)
from epicyclic.losses.load_distribution import LOAD_DISTRIBUTIONS
from epicyclic.losses.validity import ModelUse, ValidityFlag
from epicyclic.losses.viscous import (
    VISCOUS_METHOD,
    VISCOUS_SOURCE,
    bearing_viscous_loss,
    viscous_flags,
)
from epicyclic.lubricant.properties import MixtureState, OilState
from epicyclic.pocketing.table import FlowTables

__all__ = ["most_loaded_duties", "planetary_duties", "solve_planetary"]


def solve_planetary(case: PlanetaryCase, flow_tables: FlowTables) -> Result:
    """The losses of a planetary gear set."""
    fluids = fluids_of(case)
    speeds = member_speeds(case)
    shares = _shares(case)
    # every planet has the same flows: they do not depend on the load
    duties = planetary_duties(case, shares[0])
    flows = mesh_flows(case, duties, fluids.mixture, flow_tables)
    branches = [
        _solve_branch(case, share, shares.count(share), fluids, flows, speeds)
        for share in sorted(set(shares), reverse=True)
    ]
    drag_parts, drag_flags = _drag_parts(case, speeds, fluids.mixture)
    thrust, thrust_flags = _thrust_bearing(case, speeds, fluids.oil)
    parts = drag_parts | _sum_parts(branches) | {"thrust_bearing_viscous": thrust}
    terms = loss_terms(parts, case.losses)
    most_loaded = branches[0]
    flow = _power_flow(case, speeds, terms)
    angles = build.planet_angles(case.sun, case.planet, case.ring)
    distribution = LOAD_DISTRIBUTIONS[case.models.load_distribution]
    sharing, sharing_source = SHARING_METHODS[case.load_sharing.method]
    return Result(
        title=case.title,
        kind=case.kind,
        terms=terms,
        flow=flow,
        meshes=most_loaded.meshes,
        bearing=most_loaded.bearing,
        fluid=fluids.figures,
        models=resolve_models(case),
        flags=fluids.flags + _widest_flags(branches) + drag_flags + thrust_flags,
        notes=(
            *general_notes(terms, flow.input_power, flow.efficiency),
            *fluid_notes(case),
            *load_notes(case),
            *contact_notes(most_loaded.meshes),
            *most_loaded.notes,
            *_planet_notes(case, angles),
            *_share_notes(case.load_sharing, shares),
            *_ring_notes(case, speeds),
        ),
        load_methods={"load_distribution": distribution.title, "load_sharing": sharing},
        load_sources={"load_distribution": distribution.source, "load_sharing": sharing_source},
        sources=used_sources(terms, distribution.source, sharing_source),
        inputs=case.inputs(),
        planet_angles=angles,
        planet_shares=shares,
    )


def _power_flow(
    case: PlanetaryCase, speeds: Mapping[str, float], terms: Sequence[LossTerm]
) -> PowerFlow:
    drags = _housing_drags(case, terms)
    return planetary_power_flow(
        case.sun.teeth,
        case.ring.teeth,
        speeds,
        case.operation.input,
        _held_member(case),
        case.operation.torque,
        sum(term.watts for term in terms) - sum(drags.values()),
        drags,
    )


def most_loaded_duties(case: PlanetaryCase) -> tuple[MeshDuty, MeshDuty]:
    """Both meshes of the planet that carries most, misaligned if the case asks for its tilt."""
    duties, _ = _tilted(case, planetary_duties(case, max(_shares(case))), member_speeds(case))
    return duties


def _shares(case: PlanetaryCase) -> tuple[float, ...]:
    return planet_shares(case, planetary_duties(case, 1 / case.planet.count), planet_bearing(case))


def planetary_duties(case: PlanetaryCase, share: float) -> tuple[MeshDuty, MeshDuty]:
    """Both meshes of a planet with `share` of the torque, and their speeds relative to the carrier.

    Theory (K4).
    """
    sun_mesh, ring_mesh = build.planetary_meshes(case.gears, case.sun, case.planet, case.ring)
    speeds = member_speeds(case)
    branch_torque = share * _lossless(case)["sun"]
    planet_torque = branch_torque * case.planet.teeth / case.sun.teeth
    sun_speed = speeds["sun"] - speeds["carrier"]
    own_speed = planet_speed(case.sun.teeth, case.planet.teeth, speeds)
    drives1 = branch_torque * sun_speed >= 0
    sun, planet, ring = _tools(case, sun_mesh, ring_mesh)
    return (
        MeshDuty(
            key="sun_mesh",
            mesh=sun_mesh,
            gears=(case.sun, case.planet),
            torque1=branch_torque,
            speed1=sun_speed,
            drives1=drives1,
            tools=(sun, planet),
            misalignment=case.sun_mesh.misalignment,
        ),
        MeshDuty(
            key="ring_mesh",
            mesh=ring_mesh,
            gears=(case.planet, case.ring),
            torque1=planet_torque,
            speed1=own_speed,
            drives1=drives1,
            tools=(planet, ring),
            misalignment=case.ring_mesh.misalignment,
        ),
    )


def _tools(case: PlanetaryCase, sun_mesh: Mesh, ring_mesh: Mesh) -> tuple[Tool, Tool, Tool]:
    """The tools of sun, planet and ring; the planet serves the mate that reaches deeper."""
    planet = min(sun_mesh.radius2_at_end, ring_mesh.radius1_at_start)
    return (
        build.fitted_tool(sun_mesh.gear1, case.sun, sun_mesh.radius1_at_start),
        build.fitted_tool(sun_mesh.gear2, case.planet, planet),
        build.fitted_tool(ring_mesh.gear2, case.ring, ring_mesh.radius2_at_end),
    )


def member_speeds(case: PlanetaryCase) -> dict[str, float]:
    """Speeds of sun, ring and carrier. [rad/s]"""
    operation = case.operation
    held_speed = 0.0 if operation.second_speed is None else operation.second_speed
    given = {operation.input: operation.speed, _held_member(case): held_speed}
    return planetary_speeds(case.sun.teeth, case.ring.teeth, given)


def _held_member(case: PlanetaryCase) -> str:
    """The fixed member, or the second driven one."""
    held = case.operation.fixed or case.operation.second_input
    assert held is not None
    return held


def _lossless(case: PlanetaryCase) -> dict[str, float]:
    operation = case.operation
    return lossless_torques(case.sun.teeth, case.ring.teeth, operation.input, operation.torque)


# --- planets --------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Branch:
    """Losses of all planets that carry one and the same share, and the figures of one of them."""

    parts: dict[str, Part]
    meshes: dict[str, MeshFigures]
    bearing: BearingFigures | None
    flags: tuple[ValidityFlag, ...]
    notes: tuple[str, ...]


def _solve_branch(
    case: PlanetaryCase,
    share: float,
    count: int,
    fluids: Fluids,
    flows: Mapping[str, MeshFlow],
    speeds: Mapping[str, float],
) -> _Branch:
    duties, load = _tilted(case, planetary_duties(case, share), speeds)
    meshes = {duty.key: solve_mesh(case, duty, fluids, flows[duty.key], count) for duty in duties}
    speed = planet_speed(case.sun.teeth, case.planet.teeth, speeds)
    bearing = solve_bearing(case, load, count, fluids.oil, speed)
    parts, flags = dict(bearing.parts), bearing.flags
    for mesh in meshes.values():
        parts |= mesh.parts
        flags = mesh.flags + flags
    figures = {key: mesh.figures for key, mesh in meshes.items()}
    notes = tuple(note for mesh in meshes.values() for note in mesh.notes)
    return _Branch(parts, figures, bearing.figures, flags, notes)


def _tilted(
    case: PlanetaryCase, duties: tuple[MeshDuty, MeshDuty], speeds: Mapping[str, float]
) -> tuple[tuple[MeshDuty, MeshDuty], PlanetLoad]:
    """The duties of a planet, misaligned by its tilt if the case asks for it, and its load."""
    centrifugal, bearing = _centrifugal(case, speeds), planet_bearing(case)
    if case.models.planet_tilt == "left-out" or bearing is None or duties[0].torque1 == 0:
        return duties, planet_load(duties, centrifugal)
    return tilt_planet(duties, bearing, centrifugal, case.numerics)


def _sum_parts(branches: Sequence[_Branch]) -> dict[str, Part]:
    """The losses of all planets together."""
    return {
        name: replace(part, watts=sum(branch.parts[name].watts for branch in branches))
        for name, part in branches[0].parts.items()
    }


def _widest_flags(branches: Sequence[_Branch]) -> tuple[ValidityFlag, ...]:
    """For each model and quantity the flag of the most loaded planet that raises one."""
    flags: dict[tuple[ModelUse, str, str], ValidityFlag] = {}
    for branch in branches:
        for flag in branch.flags:
            flags.setdefault((flag.use, flag.quantity, flag.source), flag)
    return tuple(flags.values())


def _centrifugal(case: PlanetaryCase, speeds: Mapping[str, float]) -> float:
    """Centrifugal force of one planet. Theory (B3). [N]"""
    if case.planet.mass is None:
        return 0.0
    return case.planet.mass * case.gears.center_distance * speeds["carrier"] ** 2


# --- drag and thrust bearing ----------------------------------------------------------------------


def _drag_parts(
    case: PlanetaryCase, speeds: Mapping[str, float], mixture: MixtureState
) -> tuple[dict[str, Part], tuple[ValidityFlag, ...]]:
    sun = build.gear("sun", case.sun, case.gears)
    ring = build.gear("ring", case.ring, case.gears)
    discs = {
        "sun": (sun.tip_radius, sun.face_width),
        "ring": (build.outside_radius(ring, case.ring), ring.face_width),
    }
    if case.carrier is not None:
        discs["carrier"] = (case.carrier.outer_diameter / 2, case.carrier.width)
    parts = {"carrier_drag": Part(LOAD_INDEPENDENT, left_out="the case has no [carrier]")}
    flags: tuple[ValidityFlag, ...] = ()
    for name, (radius, width) in discs.items():
        body = Body(name, radius, width, speeds[name])
        parts[f"{name}_drag"], found = drag_part((body,), mixture)
        flags += found
    return parts, flags


def _housing_drags(case: PlanetaryCase, terms: Iterable[LossTerm]) -> dict[str, float]:
    """Power that each member loses to the housing: its own drag, and that of a thrust bearing."""
    watts = {term.name: term.watts for term in terms}
    drags = {name: watts[f"{name}_drag"] for name in MEMBERS}
    if case.thrust_bearing is not None:
        one, two = case.thrust_bearing.between.split("-")
        if two == "housing":
            drags[one] += watts["thrust_bearing_viscous"]
    return drags


def _thrust_bearing(
    case: PlanetaryCase, speeds: Mapping[str, float], oil: OilState
) -> tuple[Part, tuple[ValidityFlag, ...]]:
    """Viscous loss of all thrust bearings. Theory (V2)."""
    bearing = case.thrust_bearing
    if bearing is None:
        return Part(LOAD_INDEPENDENT, left_out="the case has no [thrust_bearing]"), ()
    absolute = {**speeds, "housing": 0.0}
    one, two = bearing.between.split("-")
    speed = absolute[one] - absolute[two]
    loss = bearing_viscous_loss(
        bearing.viscous_factor, oil.kinematic_viscosity, speed, bearing.mean_diameter
    )
    part = Part(LOAD_INDEPENDENT, bearing.count * loss, VISCOUS_METHOD, VISCOUS_SOURCE)
    return part, viscous_flags("thrust bearing", speed, bearing.mean_diameter)


# --- notes ----------------------------------------------------------------------------------------


def _planet_notes(case: PlanetaryCase, angles: tuple[float, ...]) -> tuple[str, ...]:
    count, teeth = case.planet.count, case.sun.teeth + case.ring.teeth
    if case.planet.angles is not None or teeth % count == 0:
        return ()
    placed = ", ".join(f"{math.degrees(angle):.4f}" for angle in angles)
    return (
        f"{count} planets cannot be equally spaced, because ({case.sun.teeth} + "
        f"{case.ring.teeth})/{count} is no integer; they stand at {placed} deg.",
    )


def _share_notes(sharing: LoadSharing, shares: tuple[float, ...]) -> tuple[str, ...]:
    notes = []
    if len(set(shares)) > 1:
        most = shares.index(max(shares)) + 1
        notes.append(f"Meshes and bearing are those of planet {most}, the most loaded one.")
    notes += [
        f"load_sharing.{key} has no effect with load_sharing.method = {sharing.method}."
        for key in sharing.idle_keys()
    ]
    return tuple(notes)


def _ring_notes(case: PlanetaryCase, speeds: Mapping[str, float]) -> tuple[str, ...]:
    if case.ring.rim_thickness is not None or speeds["ring"] == 0:
        return ()
    return (
        "ring.rim_thickness is not given: the drag of the turning ring is that of a rim of "
        f"{build.DEFAULT_RIM_THICKNESS:g} normal modules.",
    )
