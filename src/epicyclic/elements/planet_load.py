"""The load of a planet on its bearing, and how the planet tilts under it.

Axes: t along the circle of the planets, in the sense in which both meshes push the planet; r
outward from the centre of the set; y along the planet's axis, from the middle of its face towards
the end where contact ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from epicyclic.analysis.parts import MeshDuty, elastic_loads
from epicyclic.case.model_tables import Numerics
from epicyclic.errors import ConvergenceError
from epicyclic.losses.planet_bearing import RollerBearing, roller_loads

__all__ = ["PlanetLoad", "planet_load", "tilt_planet"]

FloatArray = NDArray[np.float64]
Duties = tuple[MeshDuty, MeshDuty]

_OUTWARD = (1, -1)
"""Senses along r in which the sun and the ring push a planet."""
TILT_TOLERANCE = 1e-6
"""Imbalance over the tilt at which the latter counts as found. [1]"""
SMALL_TILT = 1e-6
"""A tilt as small as this counts as that size in `TILT_TOLERANCE`: 0.02 um across 20 mm. [rad]"""


@dataclass(frozen=True, slots=True)
class PlanetLoad:
    """Load of one planet on its bearing, x along the radial force.

    Attributes
    ----------
    force : float
        Radial. [N]
    moment_x, moment_y : float
        Tilting moments in the planes of the axis and x, and of the axis and y. [N m]
    """

    force: float
    moment_x: float
    moment_y: float


def planet_load(
    duties: Duties, centrifugal: float, mesh_moments: tuple[float, float] = (0.0, 0.0)
) -> PlanetLoad:
    """Load on the bearing of a planet from both meshes and the centrifugal force.

    Theory (B1), (B2), (B17).

    Talbot (2012), Eq. 3.7 and 3.8, for equal or unequal pressure angles: the tangential forces
    add, the radial ones cancel or not, the axial ones form a couple in the plane of the axes.

    Parameters
    ----------
    duties : tuple of MeshDuty
    centrifugal : float
        [N]
    mesh_moments : tuple of float
        Of the forces of both meshes about the middle of the face. [N m]
    """
    moment = np.zeros(2)  # along t and r
    for duty, outward, own in zip(duties, _OUTWARD, mesh_moments, strict=True):
        mesh = duty.mesh
        planet_radius = mesh.operating_radius2 if outward > 0 else mesh.operating_radius1
        tangential = abs(duty.torque1) / mesh.operating_radius1
        moment += own * _direction(duty, outward)
        moment[1] += tangential * mesh.operating_helix_tangent * planet_radius
    force = _radial_force(duties, centrifugal)
    along, across = _axes(force)
    return PlanetLoad(math.hypot(*force), float(moment @ along), float(moment @ across))


def _radial_force(duties: Duties, centrifugal: float) -> FloatArray:
    """Force of both meshes and of rotation on the planet, along t and r. [N]"""
    force = np.array([0.0, centrifugal])
    for duty, outward in zip(duties, _OUTWARD, strict=True):
        force += abs(duty.torque1) / duty.mesh.gear1.base_radius * _direction(duty, outward)
    return force


def _direction(duty: MeshDuty, outward: int) -> FloatArray:
    """Of the force of a mesh on the planet: `outward` 1 from the sun, -1 from the ring."""
    angle = duty.mesh.operating_pressure_angle
    return np.array([math.cos(angle), outward * math.sin(angle)])


def _axes(force: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Unit vectors along the radial force and at right angles to it, in t and r."""
    turn = math.atan2(force[1], force[0])
    along = np.array([math.cos(turn), math.sin(turn)])
    return along, np.array([-along[1], along[0]])


def tilt_planet(
    duties: Duties, bearing: RollerBearing, centrifugal: float, numerics: Numerics
) -> tuple[Duties, PlanetLoad]:
    """Duties misaligned by the tilt of the planet in its bearing, and the load that belongs to it.

    Theory (B17), (B18).

    The tilt opens one end of each mesh, the load moves to the other end, and its moment tilts the
    planet back. Carrier and pin are rigid; the bearing stands under the middle of the face.

    Raises
    ------
    ConvergenceError
        If no tilt is found at which bearing and meshes are in balance.
    """
    from scipy.optimize import root

    tilt = _tilt_under(planet_load(duties, centrifugal), duties, bearing, centrifugal)
    scale = max(math.hypot(*tilt), SMALL_TILT)

    def imbalance(scaled: FloatArray) -> FloatArray:
        load = _load_at(scaled * scale, duties, centrifugal, numerics)
        answer = _tilt_under(load, duties, bearing, centrifugal)
        residual: FloatArray = scaled - answer / scale
        return residual

    found = root(imbalance, tilt / scale, method="hybr")
    if np.abs(found.fun).max() > TILT_TOLERANCE:
        raise ConvergenceError(
            "no tilt of the planet was found at which its bearing and its meshes are in balance; "
            'use models.planet_tilt = "left-out".'
        )
    tilt = found.x * scale
    return _misaligned(duties, tilt), _load_at(tilt, duties, centrifugal, numerics)


def _misaligned(duties: Duties, tilt: FloatArray) -> Duties:
    """Misalignments of both meshes with a planet tilted by `tilt` in t and r. Theory (B18)."""
    sun, ring = (
        replace(
            duty,
            misalignment=duty.misalignment
            + duty.mesh.face_width * float(tilt @ _direction(duty, outward)),
        )
        for duty, outward in zip(duties, _OUTWARD, strict=True)
    )
    return sun, ring


def _load_at(
    tilt: FloatArray, duties: Duties, centrifugal: float, numerics: Numerics
) -> PlanetLoad:
    """Load of a planet tilted by `tilt`."""
    sun, ring = (_mesh_moment(duty, numerics) for duty in _misaligned(duties, tilt))
    return planet_load(duties, centrifugal, (sun, ring))


def _mesh_moment(duty: MeshDuty, numerics: Numerics) -> float:
    """Moment of the transverse force of a mesh about the middle of its face. Theory (B17). [N m]"""
    loaded = elastic_loads(duty, numerics)
    height = loaded.lines.face_position - duty.mesh.face_width / 2
    moments = (loaded.line_load * loaded.lines.length * height).sum(axis=(1, 2))
    return loaded.mean(moments) * math.cos(duty.mesh.gear1.rack.base_helix_angle)


def _tilt_under(
    load: PlanetLoad, duties: Duties, bearing: RollerBearing, centrifugal: float
) -> FloatArray:
    """Tilt of the planet under `load`, in t and r. [rad]"""
    loads = roller_loads(bearing, load.force, 0.0, load.moment_x, load.moment_y)
    along, across = _axes(_radial_force(duties, centrifugal))
    tilt: FloatArray = loads.displacement[2] * along + loads.displacement[3] * across
    return tilt
