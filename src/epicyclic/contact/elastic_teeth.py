"""Elastic teeth: plates on foundations, ring rims, and the load that they put on contact lines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from threadpoolctl import ThreadpoolController

from epicyclic.arrays import BoolArray, FloatArray
from epicyclic.dataclass import dataclass
from epicyclic.errors import ConvergenceError
from epicyclic.gears.cutting import Tool, default_tool, tooth_outline
from epicyclic.gears.flanks import ContactLines, FlankDeviations, contact_lines
from epicyclic.gears.gear import Gear
from epicyclic.gears.mesh import Mesh
from epicyclic.kernels.contact_load import solve_points
from epicyclic.kernels.line_contact import equivalent_modulus, hertz_half_width

# Linear algebra on one thread.
#
# The matrices here are small: threads cost more than they save. More than one would also round
# differently, so that a sweep in many processes would not give the bits of one process.


def one_thread() -> AbstractContextManager[object]:
    """A context in which matrix products and decompositions use one thread."""
    blas = ThreadpoolController().select(user_api="blas")  # of those that are loaded by now
    if all(library.num_threads == 1 for library in blas.lib_controllers):
        return nullcontext()  # as in workers: to set limits takes a tenth of a solution
    context: AbstractContextManager[object] = blas.limit(limits=1)
    return context


# A gear tooth as a tapered plate on an elastic foundation (Rayleigh-Ritz).
#
# The middle surface of the tooth is a rectangle, height s above the root section times length y
# along the tooth. The plate is of Mindlin's kind, with shear deformation: deflection w and
# rotations theta_s and theta_y are products of Legendre polynomials. Its strain energy is (R. D.
# Mindlin, J. Appl. Mech. 18 (1951) 31)
#
# .. math::
#
#    U = \tfrac12\int D\left[\theta_{s,s}^2 + \theta_{y,y}^2 + 2\nu\,\theta_{s,s}\theta_{y,y}
#        + \tfrac{1-\nu}{2}(\theta_{s,y} + \theta_{y,s})^2\right]
#        + k G t\left[(w_{,s} - \theta_s)^2 + (w_{,y} - \theta_y)^2\right]\mathrm ds\,\mathrm dy ,
#
# with D = E t^3/[12 (1 - nu^2)], k = 5/6, and t(s) the thickness of the tooth in its normal
# section. The root section rests on springs against rotation and deflection per length, from the
# deformation of an elastic half-plane under the moment and the shear force of the tooth (C. Weber,
# 1949; R. W. Cornell, J. Mech. Des. 103 (1981) 447). Because the thickness does not change along
# the tooth, the stiffness matrix is a sum of Kronecker products of one-dimensional integrals, and
# deflections even along it are uncoupled from odd ones. No force acts on theta_y: with it first,
# the Cholesky factor of the stiffness under load is the last block of the whole factor.

SHEAR_FACTOR = 5 / 6  # k of Mindlin's plate for a rectangular section. [1]
ROOT_TANGENT = math.radians(30.0)
"""The root section is where the fillet is inclined so to the tooth's middle line. ISO 6336-3."""
HEIGHT_TERMS = 6  # Polynomials over the height of the tooth.
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
    # Inverses of the Cholesky factors of the stiffness in w and theta_s, even and odd along the
    # tooth: compliances are products of them.
    half_inverses: tuple[FloatArray, FloatArray]
    face_terms: int  # Polynomials along the tooth.

    def influence(
        self,
        # Of points on contact lines, shape (positions, lines, segments):
        curvature: FloatArray,  # Transverse radius of curvature of the involute. [m]
        face_position: FloatArray,  # Position across the face width of the gear, 0 to 1.
    ) -> tuple[FloatArray, FloatArray]:
        """Approach at each point of a line under a unit normal force at another one of that line.

        The force acts along the common normal; in the section of the tooth it bends the plate by
        its part across the middle line and, acting beside that line, by the moment of the rest.

        Also how deep the middle line lies along the normal. Theory (E3). [m/N], [m]
        """
        gear = self.gear
        radius = np.hypot(gear.base_radius, curvature)
        half_angle = gear.half_angles_at(curvature)
        height = gear.side * (radius * np.cos(half_angle) - gear.root_radius) - self.root_offset
        transverse = np.arctan2(curvature, gear.base_radius) - gear.side * half_angle
        inclination = np.arctan(np.tan(transverse) * math.cos(gear.rack.helix_angle))
        thickness = np.interp(height, self.section_height, self.section_thickness)
        s = np.clip(2 * height / self.height - 1, -1.0, 1.0)
        over_height = legendre.legvander(s, HEIGHT_TERMS - 1)
        along = legendre.legvander(2 * face_position - 1, self.face_terms - 1)
        force, moment = np.cos(inclination), -np.sin(inclination) * thickness / 2
        loads = np.concatenate([over_height * it[..., None] for it in (force, moment)], axis=-1)
        influence = np.zeros((*curvature.shape, curvature.shape[-1]))
        for m in range(len(influence)):  # arrays of all positions would not fit into fast memory
            for parity, inverse in enumerate(self.half_inverses):
                load = loads[m][..., None] * along[m][..., None, parity::2]
                amplitude = load.reshape(-1, len(inverse)) @ inverse.T
                amplitude = amplitude.reshape(*curvature.shape[1:], -1)
                influence[m] += amplitude @ amplitude.swapaxes(-1, -2)
        return influence, thickness / (2 * force)


@lru_cache(maxsize=64)
def tooth_plate(
    gear: Gear,
    elastic_modulus: float,  # [Pa]
    poisson_ratio: float,  # [1]
    face_terms: int,  # Polynomials along the tooth: more for teeth long against their height.
    tool: Tool,  # The tool that leaves the root fillet.
) -> ToothPlate:
    """The plate of one tooth of `gear`."""
    outline = tooth_outline(gear, tool)
    flank = slice(outline.joints[0], outline.joints[2] + 1)
    along = gear.side * (outline.radius * np.cos(outline.half_angle) - gear.root_radius)
    across = outline.radius * np.sin(outline.half_angle) * math.cos(gear.rack.helix_angle)
    height, half = along[flank], across[flank]
    steep = np.arctan2(-np.gradient(half), np.gradient(height)) > ROOT_TANGENT
    start = int(np.argmin(steep)) if steep[0] else 0
    offset, thickness = float(height[start]), 2 * half[start:]
    height = height[start:] - height[start]
    length = gear.face_width / math.cos(gear.rack.helix_angle)
    stiffness = _stiffness(height, thickness, length, elastic_modulus, poisson_ratio, face_terms)
    # scaled to a unit diagonal: deflections and rotations differ by orders of magnitude
    scale = 1 / np.sqrt(np.diag(stiffness))
    numbers = np.arange(len(scale)).reshape(3, HEIGHT_TERMS, face_terms)
    inverses = []
    for parity in (0, 1):
        free, loaded = numbers[2, :, 1 - parity :: 2].ravel(), numbers[:2, :, parity::2].ravel()
        order = np.concatenate([free, loaded])
        part = scale[order, None] * stiffness[np.ix_(order, order)] * scale[order]
        factor = np.linalg.cholesky(part)[len(free) :, len(free) :]
        inverses.append(np.linalg.inv(factor) * scale[loaded])
    for array in (height, thickness, *inverses):
        array.flags.writeable = False
    even, odd = inverses
    return ToothPlate(gear, float(height[-1]), height, thickness, offset, (even, odd), face_terms)


_gauss = lru_cache(maxsize=64)(legendre.leggauss)


def _stiffness(
    height: FloatArray,
    thickness: FloatArray,
    length: float,
    elastic_modulus: float,
    poisson_ratio: float,
    face_terms: int,
) -> FloatArray:
    """Stiffness matrix in (w, theta_s, theta_y), height by face terms each. Theory (E1), (E2)."""
    nu = poisson_ratio
    top = float(height[-1])
    points, weights = _gauss(HEIGHT_TERMS + QUADRATURE_MARGIN)
    t = np.interp((points + 1) / 2 * top, height, thickness)
    v = legendre.legvander(points, HEIGHT_TERMS - 1)
    slopes = legendre.legval(points, legendre.legder(np.eye(HEIGHT_TERMS)))
    dv = np.ascontiguousarray(slopes.T) * 2 / top
    bending = weights * top / 2 * elastic_modulus * t**3 / (12 * (1 - nu**2))
    shear = weights * top / 2 * SHEAR_FACTOR * elastic_modulus / (2 * (1 + nu)) * t

    points, weights = _gauss(face_terms)
    y = legendre.legvander(points, face_terms - 1)
    slopes = legendre.legval(points, legendre.legder(np.eye(face_terms)))
    dy = np.ascontiguousarray(slopes.T) * 2 / length
    across = weights * length / 2
    yy, dydy = _integral(y, y, across), _integral(dy, dy, across)
    ydy = _integral(y, dy, across)
    twist = bending * (1 - nu) / 2
    n = HEIGHT_TERMS * face_terms
    stiffness = np.zeros((3 * n, 3 * n))
    w, s, r = slice(0, n), slice(n, 2 * n), slice(2 * n, 3 * n)
    stiffness[w, w] = np.kron(_integral(dv, dv, shear), yy)
    stiffness[w, w] += np.kron(_integral(v, v, shear), dydy)
    stiffness[s, s] = np.kron(_integral(dv, dv, bending) + _integral(v, v, shear), yy)
    stiffness[s, s] += np.kron(_integral(v, v, twist), dydy)
    stiffness[r, r] = np.kron(_integral(v, v, bending), dydy)
    stiffness[r, r] += np.kron(_integral(dv, dv, twist) + _integral(v, v, shear), yy)
    stiffness[s, w] = -np.kron(_integral(v, dv, shear), yy)
    stiffness[r, w] = -np.kron(_integral(v, v, shear), ydy)
    stiffness[r, s] = np.kron(_integral(v, dv, bending * nu), ydy.T)
    stiffness[r, s] += np.kron(_integral(dv, v, twist), ydy)
    # the springs under the root section
    root = float(thickness[0])
    rotation = ROTATION_CONSTANT * (1 - nu**2) / (elastic_modulus * root**2)
    coupling = (1 - nu - 2 * nu**2) / (elastic_modulus * root)
    deflection = DEFLECTION_CONSTANT * (1 - nu**2) / elastic_modulus
    springs = np.linalg.inv(np.array([[deflection, coupling], [coupling, rotation]]))
    at_root = legendre.legvander(-1.0, HEIGHT_TERMS - 1)
    line = np.kron(np.outer(at_root, at_root), yy)
    stiffness[w, w] += springs[0, 0] * line
    stiffness[s, s] += springs[1, 1] * line
    stiffness[s, w] += springs[1, 0] * line
    # the foundation does not twist the root section along the tooth: theta_y follows w there
    stiffness[r, r] += line / rotation
    for row, column in ((s, w), (r, w), (r, s)):
        stiffness[column, row] = stiffness[row, column].T
    return stiffness


def _integral(a: NDArray[Any], b: NDArray[Any], weights: FloatArray) -> FloatArray:
    """Integrals of products of the columns of `a` and `b`, values at Gauss points."""
    integral: FloatArray = a.T @ (weights[:, None] * b)
    return integral


# The rim of a ring gear as an elastic ring under the forces of all planets.
#
# The ring is a curved Timoshenko beam, free but for a torque that is held evenly along its outside.
# With radial and tangential displacement u and v of its middle line and rotation psi of its
# sections, all anticlockwise or outwards,
#
# .. math::
#
#    U = \frac R2\int EA\Big(\frac{u + v'}R\Big)^2 + kGA\Big(\frac{u' - v}R + \psi\Big)^2
#        + EI\Big(\frac{\psi'}R\Big)^2\,\mathrm d\theta .
#
# The waves cos(n theta), sin(n theta) are uncoupled, so that its influence function is a sum of
# inverses of three by three matrices. Evenly spaced equal planets excite only waves whose number is
# a multiple of theirs.


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
    modulus: float  # [Pa]
    poisson_ratio: float  # [1]

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

        Theory (E6). [m/N], [1/N], [1/(N m)]
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
        stiffness = self.modulus * area * np.outer(stretch, stretch)
        stiffness += self.shear_stiffness * np.outer(shear, shear)
        stiffness += self.modulus * area * self.thickness**2 / 12 * np.outer(bending, bending)
        return math.pi * r * stiffness

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
    modulus: float,  # [Pa]
    poisson_ratio: float,  # [1]
) -> FloatArray:
    """Deflection along the normal at each contact line under a unit force on each. Theory (E7).

    The force of a line acts at its middle, in the plane of action; the tooth is rigid here.

    [m/N]
    """
    gear = mesh.gear2
    ring = ElasticRing(
        gear.root_radius + rim.thickness / 2, rim.thickness, gear.face_width, modulus, poisson_ratio
    )
    rho2 = mesh.curvature2(np.clip(lines.curvature1.mean(axis=2), mesh.path_start, mesh.path_end))
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
    load = np.stack([radial, tangential, gear.base_radius - tangential * ring.radius], axis=-1)
    angle = tooth[:, :, None] - tooth[:, None, :]
    transverse = np.einsum("mia,mijab,mjb->mij", load, ring.influence(angle, rim.loads), load)
    coupling: FloatArray = math.cos(gear.rack.base_helix_angle) ** 2 * transverse
    return coupling


# Influence coefficients of a mesh.
#
# The coefficients depend on geometry and materials only; every load is solved with the same ones.

FACE_TERMS_PER_HEIGHT = 2.5
"""Polynomials along a tooth for each tooth height in its length: shorter ones decay fast. [1]"""
FACE_TERMS_LIMITS = (8, 40)
KEPT_MESHES = 8
"""Meshes whose coefficients are kept: those of a few gear sets, as sweeps put cases of one set next
to each other. One takes 0.25 MB with the default resolution, and 120 MB with the largest."""


@dataclass(frozen=True, slots=True)
class GearBody:
    """What makes a gear yield beside its geometry."""

    modulus: float  # [Pa]
    poisson_ratio: float  # [1]
    tool: Tool | None = None  # The tool that leaves the root fillet; None for `default_tool`.
    rim: Rim | None = None  # Rim of a ring gear; None for a body that only yields under each tooth.


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
    """Influence coefficients of `mesh`, shared by all loads. Theory (E4).

    Raises `ConvergenceError` if the stiffness of a tooth cannot be inverted. Raises `ValueError` if
    no tool generates a tooth.
    """
    lines = contact_lines(mesh, positions, segments)
    shape = lines.length.shape
    influence = np.zeros((*shape, shape[-1]))
    # lines that are not in contact lie beyond the path of contact: any place on it serves for them
    rho1 = np.clip(lines.curvature1, mesh.path_start, mesh.path_end)
    modulus = equivalent_modulus(
        body1.modulus, body1.poisson_ratio, body2.modulus, body2.poisson_ratio
    )
    log_width = np.log(hertz_half_width(np.ones(shape), mesh.equivalent_radius(rho1), modulus))
    local_a, local_b = np.zeros(shape), 0.0
    members = ((mesh.gear1, body1, rho1), (mesh.gear2, body2, mesh.curvature2(rho1)))
    for gear, body, curvature in members:
        overhang = (gear.face_width - mesh.face_width) / 2
        face = (lines.face_position + overhang) / gear.face_width
        with one_thread():
            own, depth = _plate(gear, body).influence(curvature, face)
        influence += own
        nu = body.poisson_ratio
        local = 2 * (1 - nu**2) / (math.pi * body.modulus)
        local_a += local * (np.log(2 * depth) - log_width - nu / (2 * (1 - nu)))
        local_b += local
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
    terms = min(max(terms, low), high)
    tool = default_tool(gear) if body.tool is None else body.tool
    try:
        return tooth_plate(gear, body.modulus, body.poisson_ratio, terms, tool)
    except np.linalg.LinAlgError as error:
        raise ConvergenceError(
            f"the stiffness of a tooth of the {gear.name} cannot be inverted; use "
            'models.load_distribution = "uniform".'
        ) from error


# The load that elastic teeth put on the contact lines of a mesh, and what follows from it.

TOLERANCE = 1e-9
"""Gap or penetration that may remain, over the approach; error of the balance, over the force."""
STEPS_PER_SEGMENT = 10
"""Most steps of the careful method for each segment: one may leave or join in a step."""
KEPT_LOADS = 256
"""Solutions that are kept: one for each torque, mesh and set of flanks, for all speeds and
temperatures. One takes 20 kB with the default resolution."""
UNMODIFIED = FlankDeviations()


@dataclass(frozen=True, slots=True, eq=False)
class LoadedMesh:
    """A mesh under load.

    Attributes
    ----------
    mesh : Mesh
    compliance : MeshCompliance
    force : float
        Transverse, tangent to the base circles. [N]
    line_load : ndarray, shape (positions, lines, segments)
        [N/m]
    normal_approach : ndarray, shape (positions,)
        Approach of the gears along the common normal of the flanks, from where flanks without
        deviations touch unloaded. [m]
    normal_stiffness : ndarray, shape (positions,)
        Slope of the normal force over the normal approach, at this load or as loads so near that
        this one is foreseen by them have it: some 1e-5 off at most. [N/m]
    rise : ndarray, shape (positions, lines, segments)
        Rise of the force on each segment with the normal force of the mesh. [1]
    """

    mesh: Mesh
    compliance: MeshCompliance
    force: float
    line_load: FloatArray
    normal_approach: FloatArray
    normal_stiffness: FloatArray
    rise: FloatArray

    @property
    def pattern(self) -> BoolArray:
        """Which segments carry load, shape (positions, lines, segments)."""
        return self.line_load > 0

    @property
    def pair_force(self) -> FloatArray:
        """Normal force on each pair of teeth, shape (positions, lines). [N]"""
        force: FloatArray = (self.line_load * self.compliance.lines.length).sum(axis=2)
        return force

    @property
    def transmission_error(self) -> FloatArray:
        """Loaded transmission error along the path of contact, in the transverse plane of action.

        Lag of the driven member against the motion of rigid flanks without deviations, as an arc on
        the base circle: the normal approach over cos(beta_b). Theory (E8). [m]
        """
        return self.normal_approach / math.cos(self.mesh.gear1.rack.base_helix_angle)

    @property
    def transmission_error_range(self) -> float:
        """From its least to its largest value over the mesh period (peak to peak). [m]"""
        return float(np.ptp(self.transmission_error))

    @property
    def secant_stiffness(self) -> FloatArray:
        """Transverse force over transmission error: deviations lower it. Theory (E9). [N/m]"""
        return self.force / self.transmission_error

    @property
    def tangent_stiffness(self) -> FloatArray:
        """Slope of the transverse force over the transmission error. Theory (E9). [N/m]"""
        return self.normal_stiffness * math.cos(self.mesh.gear1.rack.base_helix_angle) ** 2

    def mean(self, over_period: FloatArray) -> float:
        """Mean over the mesh period of a figure of shape (positions,)."""
        return float(over_period @ self.compliance.lines.weight)


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
    the first and the last contact of a tooth beyond the ends of the path is left out. Raises
    `ConvergenceError` if no loads are found that satisfy all conditions of the contact.
    """
    compliance = mesh_compliance(mesh, body1, body2, positions, segments)
    shape, unknown = (1, *compliance.lines.length.shape), np.full((1, positions), np.nan)
    start = np.ones(shape), unknown, unknown, np.zeros(shape)
    return _loaded(mesh, compliance, [force], deviations, [force], start)[0]


def load_meshes_next_to(
    last: Sequence[LoadedMesh], forces: Sequence[float], deviations: FlankDeviations = UNMODIFIED
) -> list[LoadedMesh]:
    """A mesh under several loads, each near that of its `last`, or all near the one.

    That saves most of the work. Parameters as for `load_mesh_elastically`, which has the same
    solutions but for its tolerance.
    """
    parts = "line_load", "normal_approach", "normal_stiffness", "rise"
    start: Any = tuple(np.array([getattr(each, part) for each in last]) for part in parts)
    one, before = last[0], [each.force for each in last]
    return _loaded(one.mesh, one.compliance, forces, deviations, before, start)


def _loaded(
    mesh: Mesh,
    compliance: MeshCompliance,
    forces: Sequence[float],
    deviations: FlankDeviations,
    last: Sequence[float],  # Transverse forces of the solutions to start from. [N]
    start: tuple[FloatArray, FloatArray, FloatArray, FloatArray],  # As of `solve_points`.
) -> list[LoadedMesh]:
    """The mesh under transverse `forces`."""
    lines, slope = compliance.lines, math.cos(mesh.gear1.rack.base_helix_angle)
    normal = np.array(forces) / slope
    coupled = compliance.influence, compliance.coupling, deviations.separation(mesh, lines)
    teeth = *coupled, lines.length, compliance.local_a, compliance.local_b
    order, known = np.argsort(normal, kind="stable"), (np.array(last) / slope, *start)
    most = STEPS_PER_SEGMENT * lines.length[0].size
    *found, iterations = solve_points(normal, order, teeth, known, TOLERANCE, most)
    if iterations.min() < 0:
        lost = normal[iterations.min(axis=1) < 0][0]
        raise ConvergenceError(
            f"the load distribution of the {mesh.name} was not found at {lost:.4g} N; use "
            'models.load_distribution = "uniform".'
        )
    for array in found:
        array.flags.writeable = False
    return [LoadedMesh(mesh, compliance, *one) for one in zip(forces, *found, strict=True)]
