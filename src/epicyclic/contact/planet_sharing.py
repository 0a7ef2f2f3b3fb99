"""How the planets of a gear set share the load.

Sun, ring and carrier are rigid; each planet is one elastic branch between them: both meshes and its
bearing in series. The position of a planet and the displacements of the members that can give way
close or open its branch. Directions lie in the transverse plane, forces along the lines of action.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.dataclass import dataclass
from epicyclic.errors import ConvergenceError

ROUNDING = 1e-9
"""Share of the mean branch force below which a force or its imbalance is rounding. [1]"""
LIGHT = 1e-6
"""Load over what would close all branches below which the shares are those of this load: the
lighter the load, the less they change. [1]"""


@dataclass(frozen=True, slots=True, eq=False)
class Branches:
    """The elastic branches of all planets."""

    angles: FloatArray  # Positions of the planets. [rad]
    compliance: float  # C of one branch, along the line of action. [m/N]
    # g, by which a branch is closed before the others, along the line of action. [m]
    lead: FloatArray


def branch_directions(
    angles: FloatArray,  # Positions of the planets. [rad]
    sun_pressure_angle: float,  # Operating pressure angles of both meshes. [rad]
    ring_pressure_angle: float,  # Operating pressure angles of both meshes. [rad]
) -> dict[str, FloatArray]:
    """How much a displacement of a member in x and y closes each branch. Theory (S2).

    Each has the shape (planets, 2).
    """
    outward = np.column_stack((np.cos(angles), np.sin(angles)))
    along = np.column_stack((-np.sin(angles), np.cos(angles)))
    sun = along * math.cos(sun_pressure_angle) + outward * math.sin(sun_pressure_angle)
    ring = along * math.cos(ring_pressure_angle) - outward * math.sin(ring_pressure_angle)
    return {"sun": sun, "ring": ring, "carrier": -(sun + ring)}


def solve_branch_forces(
    force: float,  # Sum of all branch forces, positive. [N]
    branches: Branches,
    directions: Mapping[str, FloatArray],  # As from `branch_directions`.
    # Stiffness of the support of every member that can give way; 0 if it floats. [N/m]
    supports: Mapping[str, float],
) -> FloatArray:
    """Forces of all branches, none negative, in balance with `force` and the supports.

    Theory (S3), (S4). [N] Raises `ConvergenceError` if no forces balance.
    """
    loose = [name for name in directions if name in supports]
    nothing = np.zeros((len(branches.angles), 0))
    displacement = np.hstack([nothing, *(directions[name] for name in loose)])
    stiffness = np.repeat([supports[name] for name in loose], 2)
    loaded = np.ones(len(branches.angles), dtype=bool)
    softest = branches.compliance + max((1 / one for one in stiffness if one), default=0.0)
    least = max(force, LIGHT * float(np.ptp(branches.lead)) / softest)
    slack = ROUNDING * least / len(loaded)
    forces = _balance(least, branches, displacement, stiffness, loaded)
    if (forces < -slack).any():
        loaded = _loaded(least, branches, displacement, stiffness)
        forces = _balance(least, branches, displacement, stiffness, loaded)
    return np.where(forces < slack, 0.0, forces) * (force / least)


def _balance(
    force: float,
    branches: Branches,
    displacement: FloatArray,
    stiffness: FloatArray,
    loaded: BoolArray,
) -> FloatArray:
    """Forces with the branches `loaded` in contact.

    Unknowns are the forces, the common approach and the displacements, the latter two over C.
    """
    active = np.hstack([np.ones((loaded.sum(), 1)), displacement[loaded]])
    count = len(active)
    support = np.diag([0.0, *(stiffness * branches.compliance)])
    matrix = np.block([[np.eye(count), -active], [active.T, support]])
    lead = branches.lead[loaded]
    right = np.zeros(len(matrix))
    right[:count] = (lead - lead.mean()) / branches.compliance  # what is common is an approach
    right[count] = force
    unknowns = np.linalg.lstsq(matrix, right, rcond=None)[0]
    if np.abs(matrix @ unknowns - right).max() > ROUNDING * np.abs(right).max():
        raise _gives_way()
    forces = np.zeros(len(loaded))
    forces[loaded] = unknowns[:count]
    return forces


def _loaded(
    force: float, branches: Branches, displacement: FloatArray, stiffness: FloatArray
) -> BoolArray:
    """Which branches are in contact.

    Of all forces that balance, those of (S3) and (S4) have the least energy of branches and
    supports. With the part that (S4) leaves free as unknown, that is a problem of least distance:
    C. L. Lawson, R. J. Hanson, Solving Least Squares Problems (1974), chapter 23, section 4.
    """
    from scipy.linalg import null_space
    from scipy.optimize import nnls

    number = len(branches.lead)
    # in units of the free approach: C F/g - g/g and the root of C times support over g
    reach = max(float(np.ptp(branches.lead)), branches.compliance * force)
    lead = (branches.lead - branches.lead.max()) / reach
    roots = np.sqrt(stiffness * branches.compliance)
    balance = np.block(
        [[np.ones((1, number)), np.zeros((1, len(roots)))], [displacement.T, np.diag(roots)]]
    )
    right = np.array([branches.compliance * force / reach, *np.zeros(len(roots))])
    right -= balance[:, :number] @ lead
    nearest = np.linalg.pinv(balance) @ right
    free = null_space(balance)
    # no force is negative: free @ x >= bounds
    rows = np.vstack([free[:number].T, -(nearest[:number] + lead)])
    target = np.zeros(len(rows))
    target[-1] = 1.0
    multipliers, distance = nnls(rows, target)
    if distance <= ROUNDING:
        raise _gives_way()
    found: BoolArray = multipliers <= 0.0
    return found


def _gives_way() -> ConvergenceError:
    return ConvergenceError(
        "the planet loads have no equilibrium: the gear set is not held by this support of its "
        "members. Support the floating member, or use more planets."
    )


def closed_form_branch_forces(
    force: float,  # Sum of all branch forces. [N]
    branches: Branches,
    *,
    floating: bool,  # True if one central member floats.
) -> FloatArray:
    """Forces of equally spaced branches that all stay loaded. Theory (S5).

    Other members than the one that may float are rigid. Can be negative: the form does not hold
    there.

    [N]
    """
    n = len(branches.angles)
    between = branches.angles[:, None] - branches.angles[None, :]
    spread = np.eye(n) - 1 / n
    if floating:
        spread -= 2 / n * np.cos(between)
    return force / n + spread @ branches.lead / branches.compliance


def mesh_load_factor_shares(count: int, factor: float) -> tuple[float, ...]:
    """One planet carries `factor` times the mean, the others share the rest. Theory (S1)."""
    if count == 1:
        return (1.0,)
    rest = (count - factor) / (count * (count - 1))
    return (factor / count, *([rest] * (count - 1)))
