"""How the planets of a gear set share the load.

Sun, ring and carrier are rigid; each planet is one elastic branch between them: both meshes and its
bearing in series. The position of a planet and the displacements of the members that can give way
close or open its branch. Directions lie in the transverse plane, forces along the lines of action.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.errors import ConvergenceError

__all__ = [
    "Branches",
    "branch_directions",
    "closed_form_branch_forces",
    "mesh_load_factor_shares",
    "solve_branch_forces",
]

FloatArray = NDArray[np.float64]

ROUNDING = 1e-9
"""Share of the mean branch force below which a force or its imbalance is rounding. [1]"""


@dataclass(frozen=True, slots=True, eq=False)
class Branches:
    """The elastic branches of all planets.

    Attributes
    ----------
    angles : ndarray, shape (planets,)
        Positions of the planets. [rad]
    compliance : float
        C of one branch, along the line of action. [m/N]
    lead : ndarray, shape (planets,)
        g, by which a branch is closed before the others, along the line of action. [m]
    """

    angles: FloatArray
    compliance: float
    lead: FloatArray


def branch_directions(
    angles: FloatArray, sun_pressure_angle: float, ring_pressure_angle: float
) -> dict[str, FloatArray]:
    """How much a displacement of a member in x and y closes each branch. Theory (S2).

    Parameters
    ----------
    angles : ndarray, shape (planets,)
        Positions of the planets. [rad]
    sun_pressure_angle, ring_pressure_angle : float
        Operating pressure angles of both meshes. [rad]

    Returns
    -------
    dict of str to ndarray, shape (planets, 2)
    """
    outward = np.column_stack((np.cos(angles), np.sin(angles)))
    along = np.column_stack((-np.sin(angles), np.cos(angles)))
    sun = along * math.cos(sun_pressure_angle) + outward * math.sin(sun_pressure_angle)
    ring = along * math.cos(ring_pressure_angle) - outward * math.sin(ring_pressure_angle)
    return {"sun": sun, "ring": ring, "carrier": -(sun + ring)}


def solve_branch_forces(
    force: float,
    branches: Branches,
    directions: Mapping[str, FloatArray],
    supports: Mapping[str, float],
) -> FloatArray:
    """Forces of all branches, none negative, in balance with `force` and the supports.

    Theory (S3), (S4).

    Parameters
    ----------
    force : float
        Sum of all branch forces, positive. [N]
    branches : Branches
    directions : mapping of str to ndarray, shape (planets, 2)
        As from `branch_directions`.
    supports : mapping of str to float
        Stiffness of the support of every member that can give way; 0 if it floats. [N/m]

    Returns
    -------
    ndarray, shape (planets,)
        [N]

    Raises
    ------
    ConvergenceError
        If no forces balance, or the set of loaded branches does not settle.
    """
    loose = [name for name in directions if name in supports]
    if loose:
        displacement = np.hstack([directions[name] for name in loose])
    else:
        displacement = np.zeros((len(branches.angles), 0))
    stiffness = np.repeat([supports[name] for name in loose], 2)
    loaded = np.ones(len(branches.angles), dtype=bool)
    for _ in range(2 * len(loaded) ** 2):
        forces, closing = _balance(force, branches, displacement, stiffness, loaded)
        slack = ROUNDING * force / len(loaded)
        if (forces[loaded] < -slack).any():
            loaded[int(forces.argmin())] = False
        elif (closing[~loaded] > ROUNDING * branches.compliance * force).any():
            loaded[int(np.where(loaded, -np.inf, closing).argmax())] = True
        else:
            return np.where(np.abs(forces) < slack, 0.0, forces)
    raise ConvergenceError(
        "the planets that carry load were not found; use load_sharing.method 'closed-form'."
    )


def _balance(
    force: float,
    branches: Branches,
    displacement: FloatArray,
    stiffness: FloatArray,
    loaded: NDArray[np.bool_],
) -> tuple[FloatArray, FloatArray]:
    """Forces with the branches `loaded` in contact, and how far every branch is closed.

    Unknowns are the forces, the common approach and the displacements, the latter two over C.
    """
    give = np.hstack([np.ones((len(loaded), 1)), displacement])
    active = give[loaded]
    count = len(active)
    support = np.diag([0.0, *(stiffness * branches.compliance)])
    matrix = np.block([[np.eye(count), -active], [active.T, support]])
    right = np.zeros(len(matrix))
    right[:count] = branches.lead[loaded] / branches.compliance
    right[count] = force
    unknowns = np.linalg.lstsq(matrix, right, rcond=None)[0]
    if np.abs(matrix @ unknowns - right).max() > ROUNDING * force:
        raise ConvergenceError(
            "no planet loads balance: with this support of the members the gear set gives way; "
            "support the floating member, or use more planets."
        )
    forces = np.zeros(len(loaded))
    forces[loaded] = unknowns[:count]
    return forces, branches.lead + branches.compliance * (give @ unknowns[count:])


def closed_form_branch_forces(force: float, branches: Branches, *, floating: bool) -> FloatArray:
    """Forces of equally spaced branches that all stay loaded. Theory (S5).

    Other members than the one that may float are rigid. Can be negative: the form does not hold
    there.

    Parameters
    ----------
    force : float
        Sum of all branch forces. [N]
    branches : Branches
    floating : bool
        True if one central member floats.

    Returns
    -------
    ndarray, shape (planets,)
        [N]
    """
    n = len(branches.angles)
    between = branches.angles[:, None] - branches.angles[None, :]
    spread = np.eye(n) - 1 / n
    if floating:
        spread -= 2 / n * np.cos(between)
    forces: FloatArray = force / n + spread @ branches.lead / branches.compliance
    return forces


def mesh_load_factor_shares(count: int, factor: float) -> tuple[float, ...]:
    """One planet carries `factor` times the mean, the others share the rest. Theory (S1)."""
    if count == 1:
        return (1.0,)
    rest = (count - factor) / (count * (count - 1))
    return (factor / count, *([rest] * (count - 1)))
