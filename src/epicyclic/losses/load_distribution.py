r"""Load along the contact lines.

Two simple models share the load in proportion to a stiffness per length k along the contact lines,

.. math:: W'(x) = F_n\, k(x) \Big/ \int k\,\mathrm{d}l ,

which balances the force exactly at every mesh position; ``compliance`` solves the contact of
elastic teeth (`epicyclic.elasticity`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from epicyclic.elasticity.loaded_mesh import (
    UNMODIFIED,
    LoadedMesh,
    load_mesh_elastically,
    load_mesh_next_to,
)
from epicyclic.elasticity.mesh_compliance import GearBody
from epicyclic.geometry.contact_lines import ContactLines, contact_lines
from epicyclic.geometry.mesh import Mesh
from epicyclic.geometry.micro_geometry import FlankDeviations

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class MeshLoad:
    """A mesh and the force on it."""

    mesh: Mesh
    force: float  # Transverse, tangent to the base circles. [N]
    bodies: tuple[GearBody, GearBody]  # Both members.
    deviations: FlankDeviations = UNMODIFIED
    # The same mesh under nearly the same load, from where a solution is found sooner.
    last: LoadedMesh | None = None


@dataclass(frozen=True, slots=True, eq=False)
class LineLoads:
    """Contact lines and the load on them."""

    lines: ContactLines
    line_load: FloatArray  # [N/m]
    elastic: LoadedMesh | None = None  # Approach and stiffness, from a model that knows them.


@dataclass(frozen=True, slots=True)
class LoadDistribution:
    """A model of the load along the contact lines."""

    title: str
    source: str
    # From a `MeshLoad`, mesh positions and contact segments to `LineLoads`.
    distribute: Callable[[MeshLoad, int, int], LineLoads]
    takes_deviations: bool = False  # False if micro-geometry and misalignment do not matter to it.


def _uniform(mesh: Mesh, lines: ContactLines) -> FloatArray:
    """Constant stiffness: the load per length is the same everywhere on all lines. Theory (D3)."""
    return np.ones_like(lines.length)


def _minimum_energy(mesh: Mesh, lines: ContactLines) -> FloatArray:
    """Stiffness cos[b0 (xi - xi_m)] along the path of contact, xi in base pitches.

    Theory (D4).

    Sanchez, Pleguezuelos, Pedrero, Mech. Mach. Theory 109 (2017) 231: b0 = [(1.11 +
    epsilon_alpha/2)^2/2 - 1.17]^-1/2, for 1 <= epsilon_alpha <= 2; beyond, the value at the limit
    is held. A fit for external teeth, taken over for internal ones.
    """
    ratio = min(max(mesh.transverse_contact_ratio, 1.0), 2.0)
    b0 = ((1.11 + ratio / 2) ** 2 / 2 - 1.17) ** -0.5
    middle = (mesh.path_start + mesh.path_end) / 2
    xi = (lines.curvature1 - middle) / mesh.gear1.rack.transverse_base_pitch
    stretch = ratio / mesh.transverse_contact_ratio
    stiffness: FloatArray = np.cos(b0 * xi * stretch)
    return stiffness


STIFFNESS_SHAPES: dict[str, Callable[[Mesh, ContactLines], FloatArray]] = {
    "uniform": _uniform,
    "minimum-energy": _minimum_energy,
}
"""k of the simple models."""


@lru_cache(maxsize=64)
def load_shape(
    mesh: Mesh,
    name: str,  # A key of `STIFFNESS_SHAPES`.
    positions: int,  # As for `contact_lines`.
    segments: int,  # As for `contact_lines`.
) -> tuple[ContactLines, FloatArray]:
    """Contact lines, and the line load on them for a unit transverse force.

    Theory (D2).

    Returns
    -------
    lines : ContactLines
    shape : ndarray, shape (positions, lines, segments)
        W'/F_bt; the normal force F_bt/cos(beta_b) is its integral along the lines. [1/m]
    """
    lines = contact_lines(mesh, positions, segments)
    stiffness = STIFFNESS_SHAPES[name](mesh, lines)
    total = (stiffness * lines.length).sum(axis=(1, 2))[:, None, None]
    shape = stiffness / (total * math.cos(mesh.gear1.rack.base_helix_angle))
    shape.flags.writeable = False
    return lines, shape


def _in_proportion(name: str, load: MeshLoad, positions: int, segments: int) -> LineLoads:
    lines, shape = load_shape(load.mesh, name, positions, segments)
    return LineLoads(lines, load.force * shape)


def _elastic(load: MeshLoad, positions: int, segments: int) -> LineLoads:
    rest = (*load.bodies, positions, segments, load.force, load.deviations)
    if load.last is None:
        loaded = load_mesh_elastically(load.mesh, *rest)
    else:
        loaded = load_mesh_next_to(load.last, *rest)
    return LineLoads(loaded.lines, loaded.line_load, loaded)


LOAD_DISTRIBUTIONS: dict[str, LoadDistribution] = {
    "uniform": LoadDistribution(
        "even along all contact lines", "", partial(_in_proportion, "uniform")
    ),
    "minimum-energy": LoadDistribution(
        "stiffness along the path of contact from minimum energy",
        "M. B. Sanchez, M. Pleguezuelos, J. I. Pedrero, Mech. Mach. Theory 109 (2017) 231",
        partial(_in_proportion, "minimum-energy"),
    ),
    "compliance": LoadDistribution(
        "contact of elastic teeth: plates on elastic foundations, Hertzian flanks",
        "T. F. Conry, A. Seireg, J. Eng. Ind. 95 (1973) 1115; C. Weber, K. Banaschek, "
        "Schriftenreihe Antriebstechnik 11 (1953); R. W. Cornell, J. Mech. Des. 103 (1981) 447",
        _elastic,
        takes_deviations=True,
    ),
}
