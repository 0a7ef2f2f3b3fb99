r"""The rim of a ring gear as an elastic ring under the forces of all planets.

The ring is a curved Timoshenko beam, free but for a torque that is held evenly along its outside.
With radial and tangential displacement u and v of its middle line and rotation psi of its sections,
all anticlockwise or outwards,

.. math::

   U = \frac R2\int EA\Big(\frac{u + v'}R\Big)^2 + kGA\Big(\frac{u' - v}R + \psi\Big)^2
       + EI\Big(\frac{\psi'}R\Big)^2\,\mathrm d\theta .

The waves cos(n theta), sin(n theta) are uncoupled, so that its influence function is a sum of
inverses of three by three matrices. Evenly spaced equal planets excite only waves whose number is
a multiple of theirs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from epicyclic.elasticity.tooth_plate import SHEAR_FACTOR
from epicyclic.geometry.contact_lines import ContactLines
from epicyclic.geometry.mesh import Mesh

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Rim:
    """The rim that carries the teeth of a ring gear."""

    thickness: float  # From root to outside. [m]
    loads: int = 1  # Planets that load it, taken as evenly spaced and equal.


@dataclass(frozen=True, slots=True)
class ElasticRing:
    """A circular ring of rectangular section."""

    radius: float  # Radius of its middle line. [m]
    thickness: float  # [m]
    width: float  # [m]
    modulus: float  # [Pa], [1]
    poisson_ratio: float  # [Pa], [1]

    @property
    def shear_stiffness(self) -> float:
        """k G A. [N]"""
        shear_modulus = self.modulus / (2 * (1 + self.poisson_ratio))
        return SHEAR_FACTOR * shear_modulus * self.thickness * self.width

    def influence(
        self,
        angle: FloatArray,  # From the force, anticlockwise. [rad]
        # Number of evenly spaced forces (outwards, anticlockwise) and moments (anticlockwise).
        loads: int,
    ) -> FloatArray:
        """Displacement (u, v, psi) at `angle` from one of `loads` equal forces (W, T, M).

        Waves shorter than the thickness of the ring are left out: they belong to the foundation
        of the tooth. One wave around the ring moves it as a whole, which its support prevents.

        Theory (E6).

        Returns
        -------
        ndarray, shape (..., 3, 3)
            [m/N], [1/N], [1/(N m)]
        """
        influence = np.broadcast_to(loads * self._even(), (*angle.shape, 3, 3)).copy()
        shortest = math.floor(2 * math.pi * self.radius / self.thickness)
        waves = np.arange(loads, shortest + 1, loads)
        for n in waves[waves > 1]:
            flexibility = loads * np.linalg.inv(self._stiffness(int(n)))
            cosine, sine = np.cos(n * angle), np.sin(n * angle)
            influence += cosine[..., None, None] * np.where(_EVEN, flexibility, 0.0)
            influence += sine[..., None, None] * np.where(_EVEN, 0.0, flexibility * _ODD_SIGN)
        return influence

    def _stiffness(self, n: int) -> FloatArray:
        """Stiffness of the waves u = U cos, v = V sin, psi = Psi sin of n theta. [N/m, N, N m]"""
        r = self.radius
        stretch = np.array([1.0, n, 0.0]) / r
        shear = np.array([-n / r, -1 / r, 1.0])
        bending = np.array([0.0, 0.0, n / r])
        area = self.thickness * self.width
        stiffness: FloatArray = (
            math.pi
            * r
            * (
                self.modulus * area * np.outer(stretch, stretch)
                + self.shear_stiffness * np.outer(shear, shear)
                + self.modulus * area * self.thickness**2 / 12 * np.outer(bending, bending)
            )
        )
        return stiffness

    def _even(self) -> FloatArray:
        """Flexibility of the even part: stretching by W, shear by T and M against the outside."""
        around = 2 * math.pi * self.radius
        flexibility = np.zeros((3, 3))
        area = self.thickness * self.width
        flexibility[0, 0] = self.radius**2 / (around * self.modulus * area)
        turn = np.array([-self.thickness / 2, 1.0])  # v and psi with the outside held
        sheared = 1 + self.thickness / (2 * self.radius)
        flexibility[1:, 1:] = np.outer(turn, turn) / (around * self.shear_stiffness * sheared**2)
        return flexibility


# (W, u) and (T, M; v, psi) go together with the cosine, the others with the sine
_EVEN = np.array([[True, False, False], [False, True, True], [False, True, True]])
_ODD_SIGN = np.array([[0.0, -1.0, -1.0], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])


def rim_coupling(
    mesh: Mesh,  # Its member 2 is the ring gear.
    lines: ContactLines,
    rim: Rim,
    modulus: float,  # [Pa], [1]
    poisson_ratio: float,  # [Pa], [1]
) -> FloatArray:
    """Deflection along the normal at each contact line under a unit force on each.

    The force of a line acts at its middle, in the plane of action; the tooth is rigid here.

    Theory (E7).

    Returns
    -------
    ndarray, shape (positions, lines, lines)
        [m/N]
    """
    gear = mesh.gear2
    ring = ElasticRing(
        gear.root_radius + rim.thickness / 2, rim.thickness, gear.face_width, modulus, poisson_ratio
    )
    rho1 = np.clip(lines.curvature1.mean(axis=2), mesh.path_start, mesh.path_end)
    rho2 = mesh.curvature2(rho1)
    # x from the axis of the ring to that of the pinion, y in the direction of the force
    alpha = mesh.operating_pressure_angle
    foot = gear.base_radius * np.array([math.cos(alpha), -math.sin(alpha)])
    direction = np.array([math.sin(alpha), math.cos(alpha)])
    x = foot[0] + rho2 * direction[0]
    y = foot[1] + rho2 * direction[1]
    tooth = np.arctan2(y, x) + gear.half_angles_at(rho2)
    radial = direction[0] * np.cos(tooth) + direction[1] * np.sin(tooth)
    tangential = direction[1] * np.cos(tooth) - direction[0] * np.sin(tooth)
    # torque about the axis is the base radius; what the tangential force leaves of it is a moment
    moment = gear.base_radius - tangential * ring.radius
    load = np.stack([radial, tangential, moment], axis=-1)
    angle = tooth[:, :, None] - tooth[:, None, :]
    influence = ring.influence(angle, rim.loads)
    transverse = np.einsum("mia,mijab,mjb->mij", load, influence, load)
    coupling: FloatArray = math.cos(gear.rack.base_helix_angle) ** 2 * transverse
    return coupling
