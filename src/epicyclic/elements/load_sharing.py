"""The share of the load that each planet of a set carries."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from epicyclic.elasticity.planet_sharing import (
    Branches,
    branch_directions,
    closed_form_branch_forces,
    mesh_load_factor_shares,
    solve_branch_forces,
)
from epicyclic.elements.gear_mesh import MeshDuty, elastic_loads
from epicyclic.losses.planet_bearing import RollerBearing, radial_stiffness

SHARE_DIGITS = 12
"""Decimals of a share, so that planets that carry alike are solved once. [1]"""
SHARING_METHODS = {
    "equal": ("equal loads", ""),
    "mesh-load-factor": ("one planet overloaded by a given factor", "ISO 6336-1"),
    "closed-form": (
        "closed form for equally spaced planets",
        "T. Ligata, A. Kahraman, A. Singh, J. Mech. Des. 131 (2009) 021007",
    ),
    "direct": (
        "elastic branches between rigid members",
        "T. Ligata, A. Kahraman, A. Singh, J. Mech. Des. 131 (2009) 021007",
    ),
}
"""What each method of load sharing is, and its source."""


@dataclass(frozen=True, slots=True)
class LoadSharing:
    """How the planets of a set share the load."""

    # A key of `SHARING_METHODS`; the last two are for a sun, a ring and planets between them.
    method: str
    mesh_load_factor: float  # K_gamma: load of the most loaded planet over the mean. [1]
    angles: tuple[float, ...]  # Positions of the planets. [rad]
    # Error of each pin, against the sense in which a positive torque of the sun pushes it. [m]
    position_errors: tuple[float, ...]
    floating_member: str  # The member that gives way, or ``"none"``.
    support_stiffness: float  # Radial, of that member. [N/m]
    pin_stiffness: float | None  # Radial, of one pin; None: rigid. [N/m]

    @property
    def count(self) -> int:
        """Number of planets."""
        return len(self.angles)

    @property
    def whatever_the_load(self) -> bool:
        """True if the shares do not depend on the load."""
        return self.method in ("equal", "mesh-load-factor") or self.count == 1


def planet_shares(
    sharing: LoadSharing,
    # The meshes of a planet under the mean load, that of the sun first.
    duties: tuple[MeshDuty, ...],
    bearing: RollerBearing | None,  # Bearing of one planet; None: rigid.
) -> tuple[float, ...]:
    """Share of the load that each planet carries; their sum is 1. Theory (S1).

    The closed form holds while all planets carry; where one does not, (S3) and (S4) are solved.

    Raises
    ------
    ConvergenceError
        If no loads of the planets balance.
    """
    count = sharing.count
    if sharing.method == "mesh-load-factor":
        return mesh_load_factor_shares(count, sharing.mesh_load_factor)
    idle = not all(duty.torque1 for duty in duties)
    if sharing.whatever_the_load or idle:
        return (1 / count,) * count
    branches = _branches(sharing, duties, bearing)
    floats = sharing.floating_member != "none"
    force = count * duties[0].force
    if sharing.method == "closed-form":
        forces = closed_form_branch_forces(force, branches, floating=floats)
    if sharing.method == "direct" or forces.min() < 0:
        sun_mesh, ring_mesh = duties
        directions = branch_directions(
            branches.angles,
            sun_mesh.mesh.operating_pressure_angle,
            ring_mesh.mesh.operating_pressure_angle,
        )
        supports: dict[str, float] = (
            {sharing.floating_member: sharing.support_stiffness} if floats else {}
        )
        forces = solve_branch_forces(force, branches, directions, supports)
    return tuple(float(share) for share in np.round(forces / forces.sum(), SHARE_DIGITS))


def _branches(
    sharing: LoadSharing, duties: tuple[MeshDuty, ...], bearing: RollerBearing | None
) -> Branches:
    """The branches of all planets. Theory (S6)."""
    sun_mesh = duties[0]
    # the branch force reaches the pin through both meshes
    through_pin = sum(math.cos(duty.mesh.operating_pressure_angle) for duty in duties)
    pin_force = through_pin * sun_mesh.force
    pin_compliance = 0.0 if bearing is None else 1 / radial_stiffness(bearing, pin_force)
    if sharing.pin_stiffness is not None:
        pin_compliance += 1 / sharing.pin_stiffness
    compliance = sum(_mesh_compliance(duty) for duty in duties)
    errors = np.array(sharing.position_errors or np.zeros(sharing.count))
    return Branches(
        np.array(sharing.angles),
        compliance + through_pin**2 * pin_compliance,
        math.copysign(through_pin, sun_mesh.torque1) * errors,
    )


def _mesh_compliance(duty: MeshDuty) -> float:
    """Slope of the transmission error over the force, mean of the mesh period. [m/N]"""
    loaded = elastic_loads(duty)
    return loaded.mean(1 / loaded.tangent_stiffness)
