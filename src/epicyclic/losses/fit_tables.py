"""Fitted quantities of one mesh or bearing at one speed, as tables.

With one oil and one pair of surfaces, radius, speeds and slip of a contact of flanks follow from
its place on the path of contact, those of a roller from its race. What is left is the pressure,
which changes from pass to pass and from one operating point to the next: a fit is evaluated once
for all of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from epicyclic.contact import Flanks, LineContacts
from epicyclic.geometry.mesh import Mesh
from epicyclic.kernels.cubic_tables import along_path, over_pressure
from epicyclic.kernels.line_contact import line_load_at_pressure
from epicyclic.losses.contact import MeshContact
from epicyclic.lubricant.properties import OilState
from epicyclic.oilmodel.model import OilModel

FloatArray = NDArray[np.float64]

POINTS, PRESSURES = 48, 32
"""Points on each side of the pitch point, and of the pressure: losses are off by some 1e-5."""
RACE_PRESSURES = 64
"""Points of the pressure at the race of a bearing."""
LEAST_SLIP = 0.01
"""Slip at which points stop to crowd: fits change with the slip over its logarithm above. [1]"""
NO_SLIP = 1e-300
"""Sliding speed at the pitch point, of which only the sign counts. [m/s]"""


@dataclass(frozen=True, slots=True)
class _Motion:
    """How the flanks of a mesh move at places on its path. Attributes as of `MeshContact`."""

    mesh: Mesh
    speed1: float
    speed2: float

    def _speeds(self, path: FloatArray) -> tuple[FloatArray, FloatArray]:
        curvature1 = self.mesh.pitch_point + path
        return self.speed1 * curvature1, self.speed2 * self.mesh.curvature2(curvature1)

    def rolling(self, path: FloatArray) -> FloatArray:
        """u_r. [m/s]"""
        one, two = self._speeds(path)
        return (one + two) / 2

    def sliding(self, path: FloatArray) -> FloatArray:
        """u_s. [m/s]"""
        one, two = self._speeds(path)
        return one - two

    def radius(self, path: FloatArray) -> FloatArray:
        """Equivalent radius. [m]"""
        return self.mesh.equivalent_radius(self.mesh.pitch_point + path)


@dataclass(frozen=True, eq=False)
class RaceContacts(LineContacts):
    """Rollers on the races of a bearing: under the same loads on each of them, without slip."""

    oil: OilState
    races: tuple[float, ...]  # Equivalent radius at each. [m]
    speed: float  # Rolling speed. [m/s]


def tabulated(
    model: OilModel,
    quantity: str,  # As for its `value`.
    form: str,  # As for its `value`.
    contacts: MeshContact | RaceContacts,  # n of them.
) -> FloatArray:
    """`OilModel.value` at every contact of a mesh or bearing, interpolated. Theory (O16).

    Returns
    -------
    ndarray, shape (n,)
    """
    pressure = np.clip(contacts.hertz_pressure, *model.fits[quantity].domain["hertz_pressure"])
    fit = model, quantity, form
    if isinstance(contacts, MeshContact):
        motion = _Motion(contacts.mesh, contacts.speed1, contacts.speed2)
        return along_path(
            contacts.path, pressure, *_path_table(*fit, motion, contacts.flanks, contacts.oil)
        )
    return np.concatenate(
        [
            over_pressure(
                own, *_race_table(*fit, race, contacts.speed, contacts.flanks, contacts.oil)
            )
            for race, own in zip(
                contacts.races, np.split(pressure, len(contacts.races)), strict=True
            )
        ]
    )


@lru_cache(maxsize=64)
def _race_table(
    model: OilModel,
    quantity: str,
    form: str,
    radius: float,
    speed: float,
    flanks: Flanks[float],
    oil: OilState,
) -> tuple[FloatArray, FloatArray]:
    """Arguments of `over_pressure`: lowest and highest pressure, and what lies between them."""
    pressures = np.geomspace(*model.fits[quantity].domain["hertz_pressure"], RACE_PRESSURES)
    radii = np.full_like(pressures, radius)
    contacts = LineContacts(
        line_load=line_load_at_pressure(pressures, radii, flanks.equivalent_modulus),
        radius=radii,
        rolling_speed=np.full_like(pressures, speed),
        sliding_speed=np.zeros_like(pressures),
        flanks=flanks,
        oil=oil,
    )
    return pressures[[0, -1]], model.value(quantity, contacts, form)


@lru_cache(maxsize=64)
def _path_table(
    model: OilModel,
    quantity: str,
    form: str,
    motion: _Motion,
    flanks: Flanks[float],
    oil: OilState,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Arguments of `along_path`: ends, crowding, lowest and highest pressure, values."""
    path = np.array([motion.mesh.path_start, motion.mesh.path_end]) - motion.mesh.pitch_point
    ends = np.array([min(path[0], 0.0), max(path[1], 0.0)])
    slip = np.abs(motion.sliding(ends)) / motion.rolling(ends)
    crowding = np.log1p(np.maximum(slip, LEAST_SLIP) / LEAST_SLIP)
    outwards = np.linspace(0.0, crowding, POINTS)
    places = ends * np.expm1(outwards) / np.expm1(crowding)
    # nothing slides at the pitch point, but each side has its sign there too
    sliding = motion.sliding(places) + NO_SLIP * np.sign(motion.sliding(ends))
    pressures = np.geomspace(*model.fits[quantity].domain["hertz_pressure"], PRESSURES)
    place, pressure = (grid.ravel() for grid in np.meshgrid(places.T, pressures, indexing="ij"))
    radius = motion.radius(place)
    contacts = LineContacts(
        line_load=line_load_at_pressure(pressure, radius, flanks.equivalent_modulus),
        radius=radius,
        rolling_speed=motion.rolling(place),
        sliding_speed=np.repeat(sliding.T, PRESSURES),
        flanks=flanks,
        oil=oil,
    )
    values = model.value(quantity, contacts, form).reshape(2, POINTS, PRESSURES)
    return ends, crowding, pressures[[0, -1]], values
