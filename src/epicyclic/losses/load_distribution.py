r"""Load along the contact lines.

The simple models share the load in proportion to a stiffness per length k along the contact lines,

.. math:: W'(x) = F_n\, k(x) \Big/ \int k\,\mathrm{d}l ,

which balances the force exactly at every mesh position; ``compliance`` solves the contact of
elastic teeth (`epicyclic.elasticity`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from epicyclic.elasticity.mesh_compliance import Elastic, load_mesh_elastically
from epicyclic.geometry.contact_lines import ContactLines, contact_lines
from epicyclic.geometry.mesh import Mesh

__all__ = ["LOAD_DISTRIBUTIONS", "distribute_load", "load_shape"]

FloatArray = NDArray[np.float64]


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


def distribute_load(
    mesh: Mesh,
    model: str,
    force: float,
    elastic: tuple[Elastic, Elastic],
    positions: int,
    segments: int,
) -> tuple[ContactLines, FloatArray]:
    """Contact lines of `mesh` and the load on them.

    Parameters
    ----------
    mesh : Mesh
    model : str
        ``"compliance"``, or a key of `LOAD_DISTRIBUTIONS`.
    force : float
        Transverse, tangent to the base circles. [N]
    elastic : tuple of Elastic
        Materials of both members.
    positions, segments : int
        As for `contact_lines`.

    Returns
    -------
    lines : ContactLines
    line_load : ndarray, shape (positions, lines, segments)
        [N/m]
    """
    if model == "compliance":
        loaded = load_mesh_elastically(mesh, *elastic, positions, segments, force)
        return loaded.lines, loaded.line_load
    lines, shape = load_shape(mesh, model, positions, segments)
    return lines, force * shape


LOAD_DISTRIBUTIONS: dict[str, Callable[[Mesh, ContactLines], FloatArray]] = {
    "uniform": _uniform,
    "minimum-energy": _minimum_energy,
}


@lru_cache(maxsize=64)
def load_shape(
    mesh: Mesh, model: str, positions: int, segments: int
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
    stiffness = LOAD_DISTRIBUTIONS[model](mesh, lines)
    total = (stiffness * lines.length).sum(axis=(1, 2))[:, None, None]
    shape = stiffness / (total * math.cos(mesh.gear1.rack.base_helix_angle))
    shape.flags.writeable = False
    return lines, shape
