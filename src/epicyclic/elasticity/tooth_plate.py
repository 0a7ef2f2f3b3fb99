r"""A gear tooth as a tapered plate on an elastic foundation (Rayleigh-Ritz).

The middle surface of the tooth is a rectangle, height s above the root section times length y
along the tooth. The plate is of Mindlin's kind, with shear deformation: deflection w and rotations
theta_s and theta_y are products of Legendre polynomials. Its strain energy is (R. D. Mindlin,
J. Appl. Mech. 18 (1951) 31)

.. math::

   U = \tfrac12\int D\left[\theta_{s,s}^2 + \theta_{y,y}^2 + 2\nu\,\theta_{s,s}\theta_{y,y}
       + \tfrac{1-\nu}{2}(\theta_{s,y} + \theta_{y,s})^2\right]
       + k G t\left[(w_{,s} - \theta_s)^2 + (w_{,y} - \theta_y)^2\right]\mathrm ds\,\mathrm dy ,

with D = E t^3/[12 (1 - nu^2)], k = 5/6, and t(s) the thickness of the tooth in its normal section.
The root section rests on springs against rotation and deflection per length, from the deformation
of an elastic half-plane under the moment and the shear force of the tooth (C. Weber, 1949; R. W.
Cornell, J. Mech. Des. 103 (1981) 447). Because the thickness does not change along the tooth, the
stiffness matrix is a sum of Kronecker products of one-dimensional integrals.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from epicyclic.geometry.gear import Gear
from epicyclic.geometry.outline import tooth_outline
from epicyclic.geometry.tools import Tool

FloatArray = NDArray[np.float64]

SHEAR_FACTOR = 5 / 6
"""k of Mindlin's plate for a rectangular section. [1]"""
ROOT_TANGENT = math.radians(30.0)
"""The root section is where the fillet is inclined so to the tooth's middle line. ISO 6336-3."""
HEIGHT_TERMS = 6
"""Polynomials over the height of the tooth."""
QUADRATURE_MARGIN = 18
"""Gauss points over the height beyond the number of polynomials: the thickness is no polynomial."""
ROTATION_CONSTANT = 16.67 / math.pi
"""Rotation of a half-plane under a moment on a strip: theta = 16.67 (1-nu^2) m/(pi E h^2). Cornell
(1981), plane strain. [1]"""
DEFLECTION_CONSTANT = 1.534
"""Its deflection under a shear force: 1.534 (1 - nu^2) v/E. Cornell (1981), plane strain. [1]"""


@dataclass(frozen=True, slots=True, eq=False)
class ToothPlate:
    """Compliance of one tooth, ready to be evaluated anywhere on its flank."""

    gear: Gear
    height: float  # From root section to tip. [m]
    # Thickness of the tooth over the height above the root section. [m]
    section_height: FloatArray
    section_thickness: FloatArray
    root_offset: float  # Height of the root section above the root circle. [m]
    # Inverse of the Cholesky factor of the stiffness matrix: compliances are products of it.
    half_inverse: FloatArray
    face_terms: int  # Polynomials along the tooth.

    def depth(self, curvature: FloatArray) -> FloatArray:
        """Distance from points of the flank to the tooth's middle line, along the normal. [m]"""
        height, inclination = self._place(curvature)
        thickness = np.interp(height, self.section_height, self.section_thickness)
        depth: FloatArray = thickness / (2 * np.cos(inclination))
        return depth

    def amplitudes(
        self,
        curvature: FloatArray,  # Transverse radius of curvature of the involute at each point. [m]
        face_position: FloatArray,  # Position across the face width of the gear, 0 to 1.
    ) -> FloatArray:
        """Amplitudes a_i of unit normal forces at points of the flank: their compliance is a_i a_j.

        The force acts along the common normal; in the section of the tooth it bends the plate by
        its part across the middle line and, acting beside that line, by the moment of the rest.

        Theory (E3).

        Returns
        -------
        ndarray, shape (n, 3 terms)
            [m^0.5 N^-0.5]
        """
        height, inclination = self._place(curvature)
        thickness = np.interp(height, self.section_height, self.section_thickness)
        s = np.clip(2 * height / self.height - 1, -1.0, 1.0)
        over_height = _polynomials(s, HEIGHT_TERMS)
        along = _polynomials(2 * face_position - 1, self.face_terms)
        shape = (over_height[:, :, None] * along[:, None, :]).reshape(len(height), -1)
        load = np.zeros((len(height), self.half_inverse.shape[0]))
        terms = shape.shape[1]
        load[:, :terms] = shape * np.cos(inclination)[:, None]
        load[:, terms : 2 * terms] = -shape * (np.sin(inclination) * thickness / 2)[:, None]
        amplitudes: FloatArray = load @ self.half_inverse.T
        return amplitudes

    def _place(self, curvature: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Height above the root section, and inclination of the normal force to the plate."""
        gear = self.gear
        radius = np.hypot(gear.base_radius, curvature)
        pressure_angle = np.arctan2(curvature, gear.base_radius)
        half_angle = gear.half_angles_at(curvature)
        outward = -1.0 if gear.internal else 1.0
        height = outward * (radius * np.cos(half_angle) - gear.root_radius) - self.root_offset
        transverse = pressure_angle - outward * half_angle
        inclination = np.arctan(np.tan(transverse) * math.cos(gear.rack.helix_angle))
        return height, inclination


@lru_cache(maxsize=64)
def tooth_plate(
    gear: Gear,
    elastic_modulus: float,  # [Pa], [1]
    poisson_ratio: float,  # [Pa], [1]
    face_terms: int,  # Polynomials along the tooth: more for teeth long against their height.
    tool: Tool,  # The tool that leaves the root fillet.
) -> ToothPlate:
    """The plate of one tooth of `gear`."""
    height, thickness, offset = _section(gear, tool)
    length = gear.face_width / math.cos(gear.rack.helix_angle)
    stiffness = _stiffness(height, thickness, length, elastic_modulus, poisson_ratio, face_terms)
    # scaled to a unit diagonal: deflections and rotations differ by orders of magnitude
    scale = 1 / np.sqrt(np.diag(stiffness))
    factor = np.linalg.cholesky(scale[:, None] * stiffness * scale)
    half_inverse = np.linalg.inv(factor) * scale
    for array in (height, thickness, half_inverse):
        array.flags.writeable = False
    return ToothPlate(gear, float(height[-1]), height, thickness, offset, half_inverse, face_terms)


def _section(gear: Gear, tool: Tool) -> tuple[FloatArray, FloatArray, float]:
    """Thickness in the normal section over the height above the root section, and its offset."""
    outline = tooth_outline(gear, tool)
    outward = -1.0 if gear.internal else 1.0
    flank = slice(outline.joints[0], outline.joints[2] + 1)
    along = outward * (outline.radius * np.cos(outline.half_angle) - gear.root_radius)
    across = outline.radius * np.sin(outline.half_angle) * math.cos(gear.rack.helix_angle)
    height, half = along[flank], across[flank]
    inclination = np.arctan2(-np.gradient(half), np.gradient(height))
    steep = inclination > ROOT_TANGENT
    start = int(np.argmin(steep)) if steep[0] else 0
    return height[start:] - height[start], 2 * half[start:], float(height[start])


def _stiffness(
    height: FloatArray,
    thickness: FloatArray,
    length: float,
    elastic_modulus: float,
    poisson_ratio: float,
    face_terms: int,
) -> FloatArray:
    """Stiffness matrix in (w, theta_s, theta_y), each of height by face terms. Theory (E1)."""
    nu = poisson_ratio
    top = float(height[-1])
    points, weights = _gauss(HEIGHT_TERMS + QUADRATURE_MARGIN)
    t = np.interp((points + 1) / 2 * top, height, thickness)
    v = _polynomials(points, HEIGHT_TERMS)
    dv = _derivatives(points, HEIGHT_TERMS) * 2 / top
    bending = weights * top / 2 * elastic_modulus * t**3 / (12 * (1 - nu**2))
    shear = weights * top / 2 * SHEAR_FACTOR * elastic_modulus / (2 * (1 + nu)) * t

    points, weights = _gauss(face_terms)
    y = _polynomials(points, face_terms)
    dy = _derivatives(points, face_terms) * 2 / length
    across = weights * length / 2
    yy, dydy = _integral(y, y, across), _integral(dy, dy, across)
    ydy = _integral(y, dy, across)
    twist = bending * (1 - nu) / 2
    n = HEIGHT_TERMS * face_terms
    stiffness = np.zeros((3 * n, 3 * n))
    w, s, r = slice(0, n), slice(n, 2 * n), slice(2 * n, 3 * n)
    stiffness[w, w] = _kron(_integral(dv, dv, shear), yy)
    stiffness[w, w] += _kron(_integral(v, v, shear), dydy)
    stiffness[s, s] = _kron(_integral(dv, dv, bending) + _integral(v, v, shear), yy)
    stiffness[s, s] += _kron(_integral(v, v, twist), dydy)
    stiffness[r, r] = _kron(_integral(v, v, bending), dydy)
    stiffness[r, r] += _kron(_integral(dv, dv, twist) + _integral(v, v, shear), yy)
    stiffness[s, w] = -_kron(_integral(v, dv, shear), yy)
    stiffness[r, w] = -_kron(_integral(v, v, shear), ydy)
    stiffness[r, s] = _kron(_integral(v, dv, bending * nu), ydy.T)
    stiffness[r, s] += _kron(_integral(dv, v, twist), ydy)
    _add_foundation(stiffness, yy, float(thickness[0]), elastic_modulus, nu)
    for row, column in ((s, w), (r, w), (r, s)):
        stiffness[column, row] = stiffness[row, column].T
    return stiffness


def _add_foundation(
    stiffness: FloatArray, yy: FloatArray, root: float, elastic_modulus: float, nu: float
) -> None:
    """Add the springs under the root section of thickness `root`. Theory (E2)."""
    n = HEIGHT_TERMS * len(yy)
    rotation = ROTATION_CONSTANT * (1 - nu**2) / (elastic_modulus * root**2)
    coupling = (1 - nu - 2 * nu**2) / (elastic_modulus * root)
    deflection = DEFLECTION_CONSTANT * (1 - nu**2) / elastic_modulus
    springs = np.linalg.inv(np.array([[deflection, coupling], [coupling, rotation]]))
    at_root = _polynomials(np.array([-1.0]), HEIGHT_TERMS)[0]
    line = _kron(np.outer(at_root, at_root), yy)
    stiffness[:n, :n] += springs[0, 0] * line
    stiffness[n : 2 * n, n : 2 * n] += springs[1, 1] * line
    stiffness[n : 2 * n, :n] += springs[1, 0] * line
    # the foundation does not twist the root section along the tooth: theta_y follows w there
    stiffness[2 * n :, 2 * n :] += line / rotation


def _integral(a: FloatArray, b: FloatArray, weights: FloatArray) -> FloatArray:
    """Integrals of products of the columns of `a` and `b`, values at Gauss points."""
    integral: FloatArray = a.T @ (weights[:, None] * b)
    return integral


def _kron(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.kron(a, b), dtype=np.float64)


def _gauss(count: int) -> tuple[FloatArray, FloatArray]:
    """Points and weights of Gauss's quadrature over -1 to 1."""
    points, weights = legendre.leggauss(count)
    return np.asarray(points, dtype=np.float64), np.asarray(weights, dtype=np.float64)


def _polynomials(points: FloatArray, terms: int) -> FloatArray:
    """Legendre polynomials, shape (points, terms)."""
    return np.asarray(legendre.legvander(points, terms - 1), dtype=np.float64)


def _derivatives(points: FloatArray, terms: int) -> FloatArray:
    """Derivatives of the Legendre polynomials, shape (points, terms)."""
    derivatives = np.zeros((len(points), terms))
    for term in range(1, terms):
        coefficients = np.zeros(term + 1)
        coefficients[term] = 1.0
        derivatives[:, term] = legendre.legval(points, legendre.legder(coefficients))
    return derivatives
