"""Variants of a mesh as the pocketing study compares them. Talbot (2012), section 4.4."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from epicyclic.builders.models import fluids_of
from epicyclic.case.case import Case
from epicyclic.elements.gear_mesh import MeshDuty
from epicyclic.elements.pocket_flow import flow_request, oil_in_mesh
from epicyclic.errors import InputError, Problem
from epicyclic.geometry.cutting import mated_tools
from epicyclic.geometry.gear import BasicRack, Gear, half_angle_from_thickness
from epicyclic.geometry.mesh import Mesh
from epicyclic.lubricant.properties import mixture_state
from epicyclic.pocketing.fluid import NETWORK_MODELS, PocketFlow

ROUNDING = 1e-9
"""What is less negative is left over from rounding. [m] or [1]"""


FEWEST_TEETH = 5


@dataclass(frozen=True, slots=True)
class PocketVariant:
    """A mesh that keeps what is not listed here: centre distance, pressure angle, oil, air."""

    # The transverse section stays as it is, but for the fillets, which a tool of the same rounding
    # over the normal module leaves. [rad]
    helix_angle: float
    face_width: float  # Face width of both gears. [m]
    oil_fraction: float  # [1]
    # At the operating circles; both teeth are made thinner or thicker by half of the change. [m]
    backlash: float
    # The transverse module follows: pitch diameters stay, but for the ratio that whole teeth allow;
    # addendum and dedendum at the operating circles go with the module, the backlash stays.
    teeth: tuple[int, int]
    speed: float  # Speed of member 1 against the line of centres. [rad/s]


def base_variant(case: Case, duty: MeshDuty) -> PocketVariant:
    """The mesh as the case has it."""
    mesh = duty.mesh
    return PocketVariant(
        helix_angle=mesh.gear1.rack.helix_angle,
        face_width=mesh.face_width,
        oil_fraction=oil_in_mesh(duty),
        backlash=mesh.backlash,
        teeth=(mesh.gear1.teeth, mesh.gear2.teeth),
        speed=abs(duty.speed1),
    )


def transverse_module(mesh: Mesh, teeth: tuple[int, int]) -> float:
    """Module that these teeth have at the same centre distance and pressure angles. [m]"""
    old = mesh.gear2.teeth + mesh.side * mesh.gear1.teeth
    new = teeth[1] + mesh.side * teeth[0]
    return mesh.gear1.rack.transverse_module * old / new


def teeth_for_module(mesh: Mesh, modules: Sequence[float]) -> dict[float, tuple[int, int]]:
    """Whole teeth whose transverse modules come nearest to `modules`, by their modules.

    Raises
    ------
    ValueError
        If a module leaves fewer teeth than a gear can have, or a ring no more than its mate.
    """
    found = {}
    for module in modules:
        ratio = mesh.gear1.rack.transverse_module / module
        teeth = (round(mesh.gear1.teeth * ratio), round(mesh.gear2.teeth * ratio))
        if min(teeth) < FEWEST_TEETH or (mesh.internal and teeth[1] <= teeth[0]):
            raise ValueError(f"{1e3 * module:.4g} mm leaves {teeth[0]} and {teeth[1]} teeth")
        found[transverse_module(mesh, teeth)] = teeth
    return found


def varied_duty(duty: MeshDuty, variant: PocketVariant) -> MeshDuty:
    """The duty with the mesh, tools and speed of `variant`.

    Raises
    ------
    ValueError
        If such gears do not mesh or cannot be cut.
    """
    mesh = _varied_mesh(duty.mesh, variant)
    for what, value in (
        ("backlash", mesh.backlash),
        ("tip clearance of member 1", mesh.tip_clearance1),
        ("tip clearance of member 2", mesh.tip_clearance2),
        ("transverse contact ratio", mesh.transverse_contact_ratio),
    ):
        if value < -ROUNDING:
            raise ValueError(f"the {what} is negative")
    tools = mated_tools(mesh, duty.gears.roundings)
    return replace(duty, gears=replace(duty.gears, mesh=mesh, tools=tools), speed1=variant.speed)


def solve_variant(case: Case, duty: MeshDuty, variant: PocketVariant) -> PocketFlow:
    """Flow through the pockets of a variant.

    Raises
    ------
    InputError
        If such gears do not mesh or cannot be cut.
    ConvergenceError
        If the flow is not found.
    """
    fluids = fluids_of(case)
    mixture = mixture_state(fluids.oil, variant.oil_fraction, fluids.pressure)
    try:
        varied = varied_duty(duty, variant)
        family, speed, _, pressure = flow_request(varied, fluids)
        if family.model not in NETWORK_MODELS:
            family = replace(family, oil_fraction=variant.oil_fraction)
        return family.flow(speed, mixture, pressure)
    except ValueError as error:
        problem = Problem(duty.key, "", f"cannot be so: {error}.", "Vary over a smaller range.")
        raise InputError([problem], "the study") from None


def _varied_mesh(mesh: Mesh, variant: PocketVariant) -> Mesh:
    one, two = mesh.gear1, mesh.gear2
    z1, z2 = variant.teeth
    module = transverse_module(mesh, variant.teeth)
    rack = BasicRack(module, one.rack.transverse_pressure_angle, variant.helix_angle)
    operating1 = mesh.center_distance * z1 / (z2 + mesh.side * z1)
    pitch = 2 * math.pi * operating1 / z1
    pitch_before = 2 * math.pi * mesh.operating_radius1 / one.teeth

    def varied(gear: Gear, teeth: int, radius_before: float, radius: float) -> Gear:
        filled = (gear.thickness_at(radius_before) + mesh.backlash / 2) / pitch_before
        thickness = filled * pitch - variant.backlash / 2
        scale = module / gear.rack.transverse_module
        return replace(
            gear,
            rack=rack,
            teeth=teeth,
            thickness_half_angle=half_angle_from_thickness(
                rack, teeth, gear.internal, thickness, radius
            ),
            tip_radius=radius + scale * (gear.tip_radius - radius_before),
            root_radius=radius + scale * (gear.root_radius - radius_before),
            face_width=variant.face_width,
            tip_chamfer=scale * gear.tip_chamfer,
        )

    return replace(
        mesh,
        gear1=varied(one, z1, mesh.operating_radius1, operating1),
        gear2=varied(two, z2, mesh.operating_radius2, operating1 * z2 / z1),
    )
