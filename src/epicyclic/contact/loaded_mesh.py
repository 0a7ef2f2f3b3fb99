"""The load that elastic teeth put on the contact lines of a mesh, and what follows from it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact.elastic_teeth import GearBody, MeshCompliance, mesh_compliance, one_thread
from epicyclic.errors import ConvergenceError
from epicyclic.gears.flanks import ContactLines, FlankDeviations, contact_lines
from epicyclic.gears.mesh import Mesh
from epicyclic.kernels.contact_load import solve_all_positions

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-9
"""Gap or penetration that may remain, over the approach; error of the balance, over the force."""
STEPS_PER_SEGMENT = 10
"""Most steps of the careful method for each segment: one may leave or join in a step."""
KEPT_LOADS = 256
"""Solutions that are kept: one for each torque, mesh and set of flanks, for all speeds and
temperatures. One takes 10 kB with the default resolution."""
UNMODIFIED = FlankDeviations()


@dataclass(frozen=True, slots=True, eq=False)
class LoadedMesh:
    """A mesh under load.

    Attributes
    ----------
    mesh : Mesh
    lines : ContactLines
    force : float
        Transverse, tangent to the base circles. [N]
    line_load : ndarray, shape (positions, lines, segments)
        [N/m]
    normal_approach : ndarray, shape (positions,)
        Approach of the gears along the common normal of the flanks, from where flanks without
        deviations touch unloaded. [m]
    normal_stiffness : ndarray, shape (positions,)
        Slope of the normal force over the normal approach, at this load. [N/m]
    """

    mesh: Mesh
    lines: ContactLines
    force: float
    line_load: FloatArray
    normal_approach: FloatArray
    normal_stiffness: FloatArray

    @property
    def pattern(self) -> NDArray[np.bool_]:
        """Which segments carry load, shape (positions, lines, segments)."""
        carrying: NDArray[np.bool_] = self.line_load > 0
        return carrying

    @property
    def pair_force(self) -> FloatArray:
        """Normal force on each pair of teeth, shape (positions, lines). [N]"""
        force: FloatArray = (self.line_load * self.lines.length).sum(axis=2)
        return force

    @property
    def transmission_error(self) -> FloatArray:
        """Loaded transmission error along the path of contact, in the transverse plane of action.

        Lag of the driven member against the motion of rigid flanks without deviations, as an arc on
        the base circle: the normal approach over cos(beta_b). Theory (E8). [m]
        """
        error: FloatArray = self.normal_approach / self._cosine
        return error

    @property
    def transmission_error_range(self) -> float:
        """From its least to its largest value over the mesh period (peak to peak). [m]"""
        return float(np.ptp(self.transmission_error))

    @property
    def secant_stiffness(self) -> FloatArray:
        """Transverse force over transmission error: deviations lower it. Theory (E9). [N/m]"""
        stiffness: FloatArray = self.force / self.transmission_error
        return stiffness

    @property
    def tangent_stiffness(self) -> FloatArray:
        """Slope of the transverse force over the transmission error. Theory (E9). [N/m]"""
        stiffness: FloatArray = self.normal_stiffness * self._cosine**2
        return stiffness

    def mean(self, over_period: FloatArray) -> float:
        """Mean over the mesh period of a figure of shape (positions,)."""
        return float(over_period @ self.lines.weight)

    @property
    def _cosine(self) -> float:
        return math.cos(self.mesh.gear1.rack.base_helix_angle)


@lru_cache(maxsize=KEPT_LOADS)
def load_mesh_elastically(
    mesh: Mesh,  # As for `mesh_compliance`.
    body1: GearBody,  # As for `mesh_compliance`.
    body2: GearBody,  # As for `mesh_compliance`.
    positions: int,  # As for `mesh_compliance`.
    segments: int,  # As for `mesh_compliance`.
    force: float,  # Positive. [N]
    deviations: FlankDeviations = UNMODIFIED,  # Micro-geometry of both members, and misalignment.
) -> LoadedMesh:
    """Line loads of all segments under the transverse `force` of the mesh.

    Contact is looked for on the contact lines of rigid flanks: that deflection and relief may move
    the first and the last contact of a tooth beyond the ends of the path is left out.

    Raises
    ------
    ConvergenceError
        If no loads are found that satisfy all conditions of the contact.
    """
    compliance = mesh_compliance(mesh, body1, body2, positions, segments)
    separation = _separation(mesh, deviations, positions, segments)
    return _loaded(mesh, compliance, force, separation, compliance.lines.length)


def load_mesh_next_to(
    last: LoadedMesh,  # With the same `positions` and `segments`.
    # body1, body2, positions, segments, force, deviations: As for `load_mesh_elastically`, which
    # has the same solution but for its tolerance.
    body1: GearBody,
    body2: GearBody,
    positions: int,
    segments: int,
    force: float,
    deviations: FlankDeviations = UNMODIFIED,
) -> LoadedMesh:
    """The mesh of `last` under nearly the same load, which saves most of the work."""
    compliance = mesh_compliance(last.mesh, body1, body2, positions, segments)
    separation = _separation(last.mesh, deviations, positions, segments)
    return _loaded(last.mesh, compliance, force, separation, last.line_load * last.lines.length)


@lru_cache(maxsize=64)
def _separation(
    mesh: Mesh, deviations: FlankDeviations, positions: int, segments: int
) -> FloatArray:
    """Gap of the unloaded flanks on all segments, shape (positions, lines, segments). [m]"""
    separation = deviations.separation(mesh, contact_lines(mesh, positions, segments))
    separation.flags.writeable = False
    return separation


def _loaded(
    mesh: Mesh,
    compliance: MeshCompliance,
    force: float,
    separation: FloatArray,
    start: FloatArray,
) -> LoadedMesh:
    """The mesh under the transverse `force`, from the normal forces `start` of the segments."""
    lines = compliance.lines
    normal = force / math.cos(mesh.gear1.rack.base_helix_angle)
    with one_thread():
        forces, approach, stiffness, iterations = solve_all_positions(
            normal,
            compliance.influence,
            compliance.coupling,
            separation,
            lines.length,
            compliance.local_a,
            compliance.local_b,
            start,
            TOLERANCE,
            STEPS_PER_SEGMENT * lines.length[0].size,
        )
    if iterations.min() < 0:
        raise ConvergenceError(
            f"the load distribution of the {mesh.name} was not found at {normal:.4g} N; use "
            'models.load_distribution = "uniform".'
        )
    line_load = np.divide(forces, lines.length, out=np.zeros_like(forces), where=lines.length > 0)
    for array in (line_load, approach, stiffness):
        array.flags.writeable = False
    return LoadedMesh(mesh, lines, force, line_load, approach, stiffness)
