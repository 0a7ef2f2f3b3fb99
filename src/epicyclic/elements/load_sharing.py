"""The share of the load that each planet of a case carries."""

from __future__ import annotations

import math

import numpy as np

from epicyclic.analysis.parts import MeshDuty, elastic_loads
from epicyclic.case import build
from epicyclic.case.case import PlanetaryCase
from epicyclic.case.model_tables import Numerics
from epicyclic.elasticity.planet_sharing import (
    Branches,
    branch_directions,
    closed_form_branch_forces,
    mesh_load_factor_shares,
    solve_branch_forces,
)
from epicyclic.errors import ConvergenceError
from epicyclic.losses.planet_bearing import RollerBearing, radial_stiffness

__all__ = ["SHARING_METHODS", "planet_shares"]

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


def planet_shares(
    case: PlanetaryCase, duties: tuple[MeshDuty, MeshDuty], bearing: RollerBearing | None
) -> tuple[float, ...]:
    """Share of the sun's torque that each planet carries; their sum is 1. Theory (S1).

    Parameters
    ----------
    case : PlanetaryCase
    duties : tuple of MeshDuty
        Of both meshes of a planet under the mean load.
    bearing : RollerBearing or None
        Of one planet; None: rigid.

    Raises
    ------
    ConvergenceError
        If no loads of the planets balance, or the closed form does not hold.
    """
    count, sharing = case.planet.count, case.load_sharing
    if sharing.method == "mesh-load-factor":
        return mesh_load_factor_shares(count, sharing.mesh_load_factor)
    if sharing.method == "equal" or duties[0].torque1 == 0:
        return (1 / count,) * count
    branches = _branches(case, duties, bearing)
    floats = sharing.floating_member != "none"
    force = count * _mesh_force(duties[0])
    if sharing.method == "closed-form":
        forces = closed_form_branch_forces(force, branches, floating=floats)
        if forces.min() < 0:
            raise ConvergenceError(
                "a planet loses contact, which the closed form of load sharing cannot show; "
                "use load_sharing.method 'direct'."
            )
    else:
        directions = branch_directions(
            branches.angles, *(duty.mesh.operating_pressure_angle for duty in duties)
        )
        supports: dict[str, float] = (
            {sharing.floating_member: sharing.support_stiffness} if floats else {}
        )
        forces = solve_branch_forces(force, branches, directions, supports)
    return tuple(float(share) for share in np.round(forces / forces.sum(), SHARE_DIGITS))


def _branches(
    case: PlanetaryCase, duties: tuple[MeshDuty, MeshDuty], bearing: RollerBearing | None
) -> Branches:
    """The branches of all planets. Theory (S6)."""
    sun_mesh = duties[0]
    angles = np.array(build.planet_angles(case.sun, case.planet, case.ring))
    # the branch force reaches the pin through both meshes
    through_pin = sum(math.cos(duty.mesh.operating_pressure_angle) for duty in duties)
    pin_force = through_pin * _mesh_force(sun_mesh)
    pin_compliance = 0.0 if bearing is None else 1 / radial_stiffness(bearing, pin_force)
    if case.load_sharing.pin_stiffness is not None:
        pin_compliance += 1 / case.load_sharing.pin_stiffness
    compliance = sum(_mesh_compliance(duty, case.numerics) for duty in duties)
    errors = np.array(case.load_sharing.position_errors or np.zeros(case.planet.count))
    return Branches(
        angles,
        compliance + through_pin**2 * pin_compliance,
        math.copysign(through_pin, sun_mesh.torque1) * errors,
    )


def _mesh_force(duty: MeshDuty) -> float:
    """Along the transverse line of action. [N]"""
    return abs(duty.torque1) / duty.mesh.gear1.base_radius


def _mesh_compliance(duty: MeshDuty, numerics: Numerics) -> float:
    """Slope of the transmission error over the force, mean of the mesh period. [m/N]"""
    loaded = elastic_loads(duty, numerics)
    return loaded.mean(1 / loaded.tangent_stiffness)
