"""Influence coefficients of a mesh.

The coefficients depend on geometry and materials only; every load is solved with the same ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from epicyclic.elasticity.rim import Rim, rim_coupling
from epicyclic.elasticity.threads import one_thread
from epicyclic.elasticity.tooth_plate import ToothPlate, tooth_plate
from epicyclic.errors import ConvergenceError
from epicyclic.geometry.contact_lines import ContactLines, contact_lines
from epicyclic.geometry.gear import Gear
from epicyclic.geometry.generation import default_tool
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.tools import Tool
from epicyclic.kernels.line_contact import equivalent_modulus, hertz_half_width

FloatArray = NDArray[np.float64]

FACE_TERMS_PER_HEIGHT = 2.5
"""Polynomials along a tooth for each tooth height in its length: shorter ones decay fast. [1]"""
FACE_TERMS_LIMITS = (8, 40)
KEPT_MESHES = 8
"""Meshes whose coefficients are kept: those of a few gear sets, as sweeps put cases of one set next
to each other. One takes 0.25 MB with the default resolution, and 120 MB with the largest."""


@dataclass(frozen=True, slots=True)
class GearBody:
    """What makes a gear yield beside its geometry."""

    modulus: float  # [Pa], [1]
    poisson_ratio: float  # [Pa], [1]
    tool: Tool | None = None  # The tool that leaves the root fillet; None for `default_tool`.
    rim: Rim | None = None  # Rim of a ring gear; None for a body that only yields under each tooth.

    @property
    def surface_compliance(self) -> float:
        """2 (1 - nu^2)/(pi E), of the local deflection. [m^2/N]"""
        return 2 * (1 - self.poisson_ratio**2) / (math.pi * self.modulus)


@dataclass(frozen=True, slots=True, eq=False)
class MeshCompliance:
    """Influence coefficients of all contact lines of a mesh at all mesh positions."""

    lines: ContactLines
    # Approach at one segment under unit force on another of its line, both teeth. [m/N]
    influence: FloatArray
    coupling: FloatArray  # Approach at one line under unit force on another, from the rim. [m/N]
    local_a: FloatArray  # A of the local deflection q (A - B ln(q)/2), q in N/m. [m^2/N]
    local_b: float  # B of it. [m^2/N]


@lru_cache(maxsize=KEPT_MESHES)
def mesh_compliance(
    mesh: Mesh,
    body1: GearBody,
    body2: GearBody,
    positions: int,  # As for `contact_lines`.
    segments: int,  # As for `contact_lines`.
) -> MeshCompliance:
    """Influence coefficients of `mesh`, shared by all loads.

    Theory (E4).

    Raises
    ------
    ConvergenceError
        If the stiffness of a tooth cannot be inverted.
    ValueError
        If no tool generates a tooth.
    """
    with one_thread():
        return _coefficients(mesh, body1, body2, contact_lines(mesh, positions, segments))


def _coefficients(
    mesh: Mesh, body1: GearBody, body2: GearBody, lines: ContactLines
) -> MeshCompliance:
    shape = lines.length.shape
    influence = np.zeros((*shape, shape[-1]))
    # lines that are not in contact lie beyond the path of contact: any place on it serves for them
    rho1 = np.clip(lines.curvature1, mesh.path_start, mesh.path_end)
    modulus = equivalent_modulus(
        body1.modulus, body1.poisson_ratio, body2.modulus, body2.poisson_ratio
    )
    log_width = np.log(hertz_half_width(np.ones(shape), mesh.equivalent_radius(rho1), modulus))
    local_a = np.zeros(shape)
    members = ((mesh.gear1, body1, rho1), (mesh.gear2, body2, mesh.curvature2(rho1)))
    for gear, body, curvature in members:
        plate = _plate(gear, body)
        overhang = (gear.face_width - mesh.face_width) / 2
        face = (lines.face_position + overhang) / gear.face_width
        amplitudes = plate.amplitudes(curvature.ravel(), face.ravel()).reshape(*shape, -1)
        influence += amplitudes @ amplitudes.swapaxes(-1, -2)
        nu = body.poisson_ratio
        depth = plate.depth(curvature.ravel()).reshape(shape)
        local_a += body.surface_compliance * (np.log(2 * depth) - log_width - nu / (2 * (1 - nu)))
    local_b = body1.surface_compliance + body2.surface_compliance
    coupling = np.zeros((*shape[:2], shape[1]))
    if body2.rim is not None:
        coupling += rim_coupling(mesh, lines, body2.rim, body2.modulus, body2.poisson_ratio)
    for array in (influence, coupling, local_a):
        array.flags.writeable = False
    return MeshCompliance(lines, influence, coupling, local_a, local_b)


def _plate(gear: Gear, body: GearBody) -> ToothPlate:
    depth = abs(gear.tip_radius - gear.root_radius)
    terms = round(FACE_TERMS_PER_HEIGHT * gear.face_width / depth)
    low, high = FACE_TERMS_LIMITS
    try:
        return tooth_plate(
            gear,
            body.modulus,
            body.poisson_ratio,
            min(max(terms, low), high),
            default_tool(gear) if body.tool is None else body.tool,
        )
    except np.linalg.LinAlgError as error:
        raise ConvergenceError(
            f"the stiffness of a tooth of the {gear.name} cannot be inverted; use "
            'models.load_distribution = "uniform".'
        ) from error
