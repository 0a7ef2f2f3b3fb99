"""Influence coefficients of a mesh, and the load that elastic teeth put on their contact lines.

The coefficients depend on geometry and materials only; every load is solved with the same ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from epicyclic.elasticity.tooth_plate import ToothPlate, tooth_plate
from epicyclic.errors import ConvergenceError
from epicyclic.geometry.contact_lines import ContactLines, contact_lines
from epicyclic.geometry.gear import Gear
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.outline import default_tool
from epicyclic.kernels.contact_load import solve_contact_loads
from epicyclic.kernels.line_contact import equivalent_modulus

__all__ = ["Elastic", "LoadedMesh", "MeshCompliance", "load_mesh_elastically", "mesh_compliance"]

FloatArray = NDArray[np.float64]

FACE_TERMS_PER_HEIGHT = 2.5
"""Polynomials along a tooth for each tooth height in its length: shorter ones decay fast. [1]"""
FACE_TERMS_LIMITS = (8, 40)
TOLERANCE = 1e-9
MAX_ITERATIONS = 60


@dataclass(frozen=True, slots=True)
class Elastic:
    """Elastic constants of a gear: modulus [Pa] and Poisson's ratio [1]."""

    modulus: float
    poisson_ratio: float

    @property
    def surface_compliance(self) -> float:
        """2 (1 - nu^2)/(pi E), of the local deflection. [m^2/N]"""
        return 2 * (1 - self.poisson_ratio**2) / (math.pi * self.modulus)


@dataclass(frozen=True, slots=True, eq=False)
class MeshCompliance:
    """Influence coefficients of all contact lines of a mesh at all mesh positions.

    Attributes
    ----------
    lines : ContactLines
    influence : ndarray, shape (positions, lines, segments, segments)
        Approach at one segment under unit force on another, both teeth. [m/N]
    local_a : ndarray, shape (positions, lines, segments)
        A of the local deflection q (A - B ln(q)/2), q in N/m. [m^2/N]
    local_b : float
        B of it. [m^2/N]
    """

    lines: ContactLines
    influence: FloatArray
    local_a: FloatArray
    local_b: float


@dataclass(frozen=True, slots=True, eq=False)
class LoadedMesh:
    """A mesh under load.

    Attributes
    ----------
    lines : ContactLines
    line_load : ndarray, shape (positions, lines, segments)
        [N/m]
    approach : ndarray, shape (positions,)
        Of the gears along the common normal: the loaded transmission error. [m]
    """

    lines: ContactLines
    line_load: FloatArray
    approach: FloatArray


@lru_cache(maxsize=32)
def mesh_compliance(
    mesh: Mesh, elastic1: Elastic, elastic2: Elastic, positions: int, segments: int
) -> MeshCompliance:
    """Influence coefficients of `mesh`, shared by all loads.

    Theory (E4).

    Parameters
    ----------
    mesh : Mesh
    elastic1, elastic2 : Elastic
        Materials of both members.
    positions, segments : int
        As for `contact_lines`.
    """
    lines = contact_lines(mesh, positions, segments)
    shape = lines.length.shape
    influence = np.zeros((*shape, segments))
    beta_b = mesh.gear1.rack.base_helix_angle
    # lines that are not in contact lie beyond the path of contact: any place on it serves for them
    rho1 = np.clip(lines.curvature1, mesh.path_start, mesh.path_end)
    rho2 = mesh.line_of_action - mesh.side * rho1
    radius = rho1 * rho2 / ((rho2 + mesh.side * rho1) * math.cos(beta_b))
    modulus = equivalent_modulus(
        elastic1.modulus, elastic1.poisson_ratio, elastic2.modulus, elastic2.poisson_ratio
    )
    log_width = 0.5 * np.log(8 * radius / (math.pi * modulus))
    local_a = np.zeros(shape)
    members = ((mesh.gear1, elastic1, rho1), (mesh.gear2, elastic2, rho2))
    for gear, elastic, curvature in members:
        plate = _plate(gear, elastic)
        overhang = (gear.face_width - mesh.face_width) / 2
        face = (lines.face_position + overhang) / gear.face_width
        amplitudes = plate.amplitudes(curvature.ravel(), face.ravel()).reshape(*shape, -1)
        influence += amplitudes @ amplitudes.swapaxes(-1, -2)
        nu = elastic.poisson_ratio
        depth = plate.depth(curvature.ravel()).reshape(shape)
        local_a += elastic.surface_compliance * (
            np.log(2 * depth) - log_width - nu / (2 * (1 - nu))
        )
    local_b = elastic1.surface_compliance + elastic2.surface_compliance
    for array in (influence, local_a):
        array.flags.writeable = False
    return MeshCompliance(lines, influence, local_a, local_b)


def _plate(gear: Gear, elastic: Elastic) -> ToothPlate:
    depth = abs(gear.tip_radius - gear.root_radius)
    terms = round(FACE_TERMS_PER_HEIGHT * gear.face_width / depth)
    low, high = FACE_TERMS_LIMITS
    return tooth_plate(
        gear,
        elastic.modulus,
        elastic.poisson_ratio,
        min(max(terms, low), high),
        default_tool(gear),
    )


@lru_cache(maxsize=256)
def load_mesh_elastically(
    mesh: Mesh,
    elastic1: Elastic,
    elastic2: Elastic,
    positions: int,
    segments: int,
    force: float,
) -> LoadedMesh:
    """Line loads of all segments under the transverse `force` of the mesh.

    Other parameters as for `mesh_compliance`.

    Raises
    ------
    ConvergenceError
        If the set of loaded segments does not settle.
    """
    compliance = mesh_compliance(mesh, elastic1, elastic2, positions, segments)
    lines = compliance.lines
    normal = force / math.cos(mesh.gear1.rack.base_helix_angle)
    line_load = np.zeros(lines.length.shape)
    approach = np.empty(len(lines.position))
    for m in range(len(lines.position)):
        forces, approach[m], iterations = solve_contact_loads(
            normal,
            compliance.influence[m],
            lines.length[m],
            compliance.local_a[m],
            compliance.local_b,
            TOLERANCE,
            MAX_ITERATIONS,
        )
        if iterations < 0:
            raise ConvergenceError(
                f"the load distribution of the {mesh.name} was not found at "
                f"{normal:.4g} N; use the load distribution 'uniform'."
            )
        np.divide(forces, lines.length[m], out=line_load[m], where=lines.length[m] > 0)
    line_load.flags.writeable = False
    approach.flags.writeable = False
    return LoadedMesh(lines, line_load, approach)
