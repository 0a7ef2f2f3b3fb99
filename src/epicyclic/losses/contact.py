"""Loaded contact of a mesh: load along its contact lines, local conditions at every point."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property, lru_cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from epicyclic.arrays import BoolArray, Each, FloatArray, IntArray, Points, of_points
from epicyclic.contact.elastic_teeth import (
    UNMODIFIED,
    GearBody,
    LoadedMesh,
    load_mesh_elastically,
    load_meshes_next_to,
)
from epicyclic.contact.line_contact import Flanks, LineContacts
from epicyclic.dataclass import dataclass, replace
from epicyclic.gears.flanks import ContactLines, FlankDeviations, contact_lines
from epicyclic.gears.mesh import Mesh
from epicyclic.oil.oil import OilState

if TYPE_CHECKING:
    from epicyclic.losses.friction import FrictionModel


# Local conditions at every point of the contact lines of a loaded, turning mesh.
#
# Surface speeds across the contact line are omega times the *transverse* radius of curvature: the
# sliding velocity is perpendicular to the plane of action. Curvatures are those of the normal
# section of the helicoid, rho_n = rho_t/cos(beta_b).


@dataclass(frozen=True, eq=False)
class MeshContact(LineContacts):
    """A mesh under load and in motion, point by point.

    Arrays have shape (n,), one entry for each loaded segment of each contact line at each mesh
    position.

    Attributes
    ----------
    flanks : Flanks
    oil : OilState
    mesh : Mesh
    force : float
        Force of the mesh in the transverse plane, tangent to the base circles. [N]
    speed1, speed2 : float
        Angular speeds of the members relative to the carrier, magnitudes. [rad/s]
    weight : ndarray
        Length of each segment times the weight of its mesh position: sums over it are averages
        over the mesh period. [m]
    path : ndarray
        Position on the path of contact from the pitch point, towards the tip of member 1. [m]
    around : OilState or None
        Oil around the gears, where its temperature is not that of the flanks.
    """

    pointwise = True

    flanks: Flanks[float]
    oil: OilState
    mesh: Mesh
    force: float
    speed1: float
    speed2: float
    weight: FloatArray
    path: FloatArray
    around: OilState | None = None

    @property
    def loaded(self) -> BoolArray:
        """Which segments carry load: all but of several points, which touch in different places."""
        return self.line_load > 0

    def seen_by(self, model: FrictionModel) -> MeshContact:
        """The contact with the oil at the temperature that a friction model was made for."""
        if self.around is None or not model.takes_oil_temperature:
            return self
        return replace(self, oil=self.around)

    @cached_property
    def pitch_line_speed(self) -> float:
        """Speed of the operating circles relative to the carrier. Theory (C15). [m/s]"""
        return self.speed1 * self.mesh.operating_radius1

    @cached_property
    def input_power(self) -> float:
        """Power through the mesh, relative to the carrier. Theory (C15). [W]"""
        return self.force * self.speed1 * self.mesh.gear1.base_radius


class _Touching(NamedTuple):
    """What of the contact lines can carry load, whatever the load is, each of shape (n,)."""

    place: IntArray  # Among all segments.
    curvature1: FloatArray  # Transverse, of member 1 and member 2. [m]
    curvature2: FloatArray
    radius: FloatArray  # The others as of `MeshContact`.
    weight: FloatArray
    path: FloatArray


@lru_cache(maxsize=64)
def _touching(mesh: Mesh, lines: ContactLines) -> _Touching:
    place = np.flatnonzero(lines.length > 0)
    rho1, rho2 = lines.curvature1.ravel()[place], lines.curvature2.ravel()[place]
    weight = (lines.weight[:, None, None] * lines.length).ravel()[place]
    found = (place, rho1, rho2, mesh.equivalent_radius(rho1), weight, rho1 - mesh.pitch_point)
    for values in found:
        values.flags.writeable = False
    return _Touching(*found)


def mesh_contact(
    mesh: Mesh,
    lines: ContactLines,  # Of the mesh.
    line_load: FloatArray,  # Load per length of each segment. [N/m]
    *,
    force: float,  # Transverse force along the line of action, positive. [N]
    speed1: float,  # Angular speed of member 1 relative to the carrier, positive. [rad/s]
    oil: OilState,  # At the contacts.
    flanks: Flanks[float],  # The surfaces.
    around: OilState | None = None,  # Oil around the gears, if its temperature differs.
) -> MeshContact:
    """Conditions at the loaded segments of `lines`. Theory (C2)."""
    touching = _touching(mesh, lines)
    if isinstance(line_load, Points):
        load = line_load.reshape(len(line_load), -1).take(touching.place, axis=1)  # row by row
        touching = touching._replace(weight=touching.weight * (load > 0))
    else:
        load = line_load.ravel()[touching.place]
    loaded = load > 0
    if not isinstance(load, Points) and not loaded.all():
        kept: list[Any] = [values[loaded] for values in touching]
        touching, load = _Touching(*kept), load[loaded]
    speed2 = speed1 / mesh.ratio
    u1, u2 = speed1 * touching.curvature1, speed2 * touching.curvature2
    return MeshContact(
        mesh=mesh,
        oil=oil,
        flanks=flanks,
        force=force,
        speed1=speed1,
        speed2=speed2,
        weight=touching.weight,
        line_load=load,
        path=touching.path,
        radius=touching.radius,
        rolling_speed=(u1 + u2) / 2,
        sliding_speed=u1 - u2,
        around=around,
    )


# Load along the contact lines.
#
# Two simple models share the load in proportion to a stiffness per length k along the contact
# lines,
#
# .. math:: W'(x) = F_n\, k(x) \Big/ \int k\,\mathrm{d}l ,
#
# which balances the force exactly at every mesh position; ``compliance`` solves the contact of
# elastic teeth (`epicyclic.contact.elastic_teeth`).


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
    """Stiffness cos[b0 (xi - xi_m)] along the path of contact, xi in base pitches. Theory (D4).

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
    """Contact lines, and the line load on them for a unit transverse force. Theory (D2).

    That is W'/F_bt; the normal force F_bt/cos(beta_b) is its integral along the lines. [1/m]
    """
    lines = contact_lines(mesh, positions, segments)
    stiffness = STIFFNESS_SHAPES[name](mesh, lines)
    total = (stiffness * lines.length).sum(axis=(1, 2))[:, None, None]
    shape = stiffness / (total * math.cos(mesh.gear1.rack.base_helix_angle))
    shape.flags.writeable = False
    return lines, shape


def _in_proportion(name: str, load: MeshLoad, positions: int, segments: int) -> LineLoads:
    lines, shape = load_shape(load.mesh, name, positions, segments)
    force: Any = load.force
    if isinstance(force, Points):
        force = force[..., None, None]
    return LineLoads(lines, force * shape)


def _elastic(load: Any, positions: int, segments: int) -> LineLoads:
    """The loads of a point or of several; without known ones, each from those of the one before."""
    several, loaded = isinstance(load.force, Points), load.last
    forces = load.force[:, 0].tolist() if several else [load.force]
    if loaded is None:
        start = load.mesh, *load.bodies, positions, segments, forces[0], load.deviations
        loaded = load_mesh_elastically(*start)
    if several or load.last is not None:
        last = loaded if isinstance(loaded, Each) else [loaded]
        found = load_meshes_next_to(last, forces, load.deviations)
        loaded = Each(found) if several else found[0]
    first = loaded[0] if several else loaded
    line_load = of_points([one.line_load for one in loaded]) if several else loaded.line_load
    return LineLoads(first.compliance.lines, line_load, loaded)


LOAD_DISTRIBUTIONS: dict[str, LoadDistribution] = {
    "uniform": LoadDistribution(
        "uniform along all contact lines", "", partial(_in_proportion, "uniform")
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
